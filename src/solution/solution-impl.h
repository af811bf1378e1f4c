/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Radiosity on the elements of a hierarchy. */
#ifndef HR2D_SRC_SOLUTION_SOLUTION_IMPL_H
#define HR2D_SRC_SOLUTION_SOLUTION_IMPL_H

#include <hr2d/solve.h>

#include "hierarchy/hierarchy-impl.h"
#include "scene/symmetry.h"

struct hr2d_solution {
  hr2d_allocator alloc;
  const hr2d_linkset *links;
  const hr2d_hierarchy *hierarchy;
  hr2d_hierarchy *own_hierarchy; /* made by hr2d_solve_to(), destroyed with the solution */
  hr2d_linkset *own_links;       /* likewise */
  hr2d_scene *own_scene;         /* of frozen temperatures, or with the light of an operator's
                                    solve; destroyed with the solution; mostly NULL */
  void (*release)(void *kept);   /* ends the use of trees and links that an operator keeps; */
  void *kept;                    /* NULL: there is none */
  size_t elements;               /* of the hierarchy when this was solved */
  size_t order, bands;
  double *value;         /* elements × order × bands, Legendre coefficients of B */
  double *irradiance;    /* likewise of H */
  hr2d_power *power;     /* per band */
  double *power_cut_off; /* per band: what images that are cut off may make of it; NULL: none
                            are, or nobody knows */
  double *gas; /* of each gas E_g and heat of each band, see hr2di_solution_gas(); NULL: none */
  hr2d_solve_work work;
  double residual;
};

/* E_g and the heat of a gas in a band. */
static inline double *hr2di_solution_gas(const hr2d_solution *s, size_t gas, size_t band) {
  return s->gas + 2 * (gas * s->bands + band);
}

/* The largest |E_g| of all gases in a band; 0 without gas. */
double hr2di_solution_hottest(const hr2d_solution *s, size_t band);

/* The scene whose light the solution has: that of its hierarchy, or its own. */
static inline const hr2d_scene *hr2di_solution_scene(const hr2d_solution *solution) {
  return solution->own_scene ? solution->own_scene : solution->hierarchy->scene;
}

/* Whether a caller's indices are those of a patch and of a band. */
static inline int hr2di_solution_has(const hr2d_solution *solution, size_t patch, size_t band) {
  return solution && patch < solution->hierarchy->scene->patches && band < solution->bands;
}

/* Writes B of a solution to `field`: count × order × bands coefficients, on leaves of a
   hierarchy that has grown from its own, and at another order perhaps.  Returns HR2D_OK or the
   status of the watch. */
hr2d_status hr2di_solution_restrict(const hr2d_solution *from, const hr2d_hierarchy *hierarchy,
                                    const uint32_t *leaf, size_t count, size_t order,
                                    double *field, hr2di_watch *watch);

/* Sets, per point of a patch and band, what the checks of the extrapolation over a period leave
   of the H that is gathered there, one after the other, and then what of it is extrapolated;
   see scene/symmetry.h.  `ends` receives the form factor of what is past the ends, which is
   exact. */
enum { HR2DI_GATHER_PAST = HR2DI_TAIL_CHECKS + 1 };
hr2d_status hr2di_solution_gather_past(const hr2d_solution *solution, size_t patch,
                                       const double *t, size_t count, double *past,
                                       double *ends, hr2di_watch *watch);

/* hr2d_solution_gather() and hr2d_solution_gather_irradiance() with a watch. */
hr2d_status hr2di_solution_gather(const hr2d_solution *solution, size_t patch, const double *t,
                                  size_t count, double *value, hr2di_watch *watch);
hr2d_status hr2di_solution_gather_irradiance(const hr2d_solution *solution, size_t patch,
                                             const double *t, size_t count, double *value,
                                             hr2di_watch *watch);

#endif
