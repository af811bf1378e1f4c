/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dense radiosity for comparison: uniform elements, one exchange area per pair of elements,
   and LU of the full matrix. */
#ifndef HR2D_BENCH_DENSE_H
#define HR2D_BENCH_DENSE_H

#include <hr2d/scene.h>

typedef enum dense_solver { DENSE_GSL, DENSE_LAPACK } dense_solver;

/* Whether the benchmarks were built with LAPACK; which one, for a headline. */
int dense_has(dense_solver solver);
const char *dense_name(dense_solver solver);

typedef struct dense_times {
  double matrix, solve; /* seconds */
} dense_times;

/* The averages of B over the patches of a scene without occluders, with `elements` on each
   patch.  0, or −1 for want of memory or of a solver. */
int dense_radiosity(const hr2d_scene *scene, size_t elements, dense_solver solver,
                    double *average, dense_times *times);

#endif
