/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Radiosity on the elements of a hierarchy. */
#ifndef HR2D_SRC_SOLUTION_IMPL_H
#define HR2D_SRC_SOLUTION_IMPL_H

#include <hr2d/solve.h>

struct hr2d_solution {
  hr2d_allocator alloc;
  const hr2d_hierarchy *hierarchy;
  size_t elements; /* of the hierarchy when this was solved */
  size_t bands;
  double *value;      /* elements × bands, averages of B */
  double *irradiance; /* likewise of H */
  hr2d_power *power;  /* per band */
  hr2d_solve_work work;
  double residual;
};

#endif
