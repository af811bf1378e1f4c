/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dense.h"

#include <gsl/gsl_linalg.h>
#include <hr2d/geometry.h>
#include <stdlib.h>

#include "base/clock.h"

int dense_has(dense_solver solver) {
#ifdef BENCH_LAPACK
  (void)solver;
  return 1;
#else
  return solver == DENSE_GSL;
#endif
}

const char *dense_name(dense_solver solver) {
#ifdef BENCH_LAPACK
  if (solver == DENSE_LAPACK) return BENCH_LAPACK;
#endif
  return solver == DENSE_GSL ? "GSL" : "none";
}

#ifdef BENCH_LAPACK
void dgesv_(const int *n, const int *nrhs, double *a, const int *lda, int *ipiv, double *b,
            const int *ldb, int *info);

/* By columns: the transposed matrix. */
static int solve_lapack(double *matrix, double *b, size_t size) {
  const int n = (int)size, one = 1;
  int info = -1, *pivot = malloc(size * sizeof *pivot);
  if (pivot) dgesv_(&n, &one, matrix, &n, pivot, b, &n, &info);
  free(pivot);
  return info;
}
#endif

static int solve_gsl(double *matrix, double *b, size_t size) {
  int sign;
  gsl_permutation *pivot = gsl_permutation_alloc(size);
  gsl_matrix_view view = gsl_matrix_view_array(matrix, size, size);
  gsl_vector_view side = gsl_vector_view_array(b, size);
  const int failed = gsl_linalg_LU_decomp(&view.matrix, pivot, &sign) ||
                     gsl_linalg_LU_svx(&view.matrix, pivot, &side.vector);
  gsl_permutation_free(pivot);
  return failed;
}

static hr2d_segment element(const hr2d_scene *scene, size_t patch, size_t k, size_t elements) {
  const hr2d_segment s = hr2d_scene_segment(scene, patch);
  const double from = (double)k / (double)elements, to = (double)(k + 1) / (double)elements;
  const double x = s.b.x - s.a.x, y = s.b.y - s.a.y;
  return (hr2d_segment){{s.a.x + from * x, s.a.y + from * y}, {s.a.x + to * x, s.a.y + to * y}};
}

/* I − ρF, each exchange area serving both directions; transposed for columns first. */
static void fill(const hr2d_scene *scene, size_t elements, int by_columns, double *matrix,
                 double *b) {
  const size_t size = hr2d_scene_patches(scene) * elements;
  hr2d_segment *all = malloc(size * sizeof *all);
  if (!all) exit(EXIT_FAILURE);
  for (size_t i = 0; i < size; i++)
    all[i] = element(scene, i / elements, i % elements, elements);
  for (size_t i = 0; i < size; i++) {
    const size_t patch = i / elements;
    const double at_i = (double)elements * hr2d_scene_reflectance(scene, patch, 0) /
                        hr2d_scene_length(scene, patch);
    b[i] = hr2d_scene_emission(scene, patch, 0);
    matrix[i * size + i] = 1;
    for (size_t j = 0; j < i; j++) {
      const size_t other = j / elements;
      const double at_j = (double)elements * hr2d_scene_reflectance(scene, other, 0) /
                          hr2d_scene_length(scene, other);
      const double area = patch == other ? 0 : hr2d_exchange_area(&all[i], &all[j]);
      matrix[i * size + j] = -(by_columns ? at_j : at_i) * area;
      matrix[j * size + i] = -(by_columns ? at_i : at_j) * area;
    }
  }
  free(all);
}

int dense_radiosity(const hr2d_scene *scene, size_t elements, dense_solver solver,
                    double *average, dense_times *times) {
  const size_t patches = hr2d_scene_patches(scene), size = patches * elements;
  double *matrix = malloc(size * size * sizeof *matrix), *b = malloc(size * sizeof *b);
  int failed = !matrix || !b || !dense_has(solver);
  if (!failed) {
    const double start = hr2di_clock_now();
    fill(scene, elements, solver == DENSE_LAPACK, matrix, b);
    const double filled = hr2di_clock_now();
#ifdef BENCH_LAPACK
    failed =
        solver == DENSE_LAPACK ? solve_lapack(matrix, b, size) : solve_gsl(matrix, b, size);
#else
    failed = solve_gsl(matrix, b, size);
#endif
    *times = (dense_times){filled - start, hr2di_clock_now() - filled};
  }
  for (size_t k = 0; k < patches && !failed; k++) {
    average[k] = 0;
    for (size_t e = 0; e < elements; e++) average[k] += b[k * elements + e] / (double)elements;
  }
  free(matrix);
  free(b);
  return failed ? -1 : 0;
}
