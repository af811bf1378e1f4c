/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plain method: patches in equal pieces, the full matrix F of their view factors, and
   (I − ρF) B = E by LU decomposition. */
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/scene.h"
#include "cost/cost.h"
#include "cost/pace.h"
#include "output/clock.h"

enum { MOST_PIECES = 1 << 14 };

typedef struct dense {
  cost *cost;
  hr2d_scene *scene; /* of the pieces */
  size_t *first;     /* piece of each patch; patches + 1 */
  size_t patches, pieces, bands;
  double *area;   /* pieces × pieces */
  double *matrix; /* likewise, I − ρF and its factors */
  double *b;      /* pieces × bands */
  double *column; /* right-hand side, then solution, of one band */
  gsl_permutation *order;
} dense;

static void clear(dense *d) {
  gsl_permutation_free(d->order);
  free(d->first);
  free(d->area);
  free(d->matrix);
  free(d->b);
  free(d->column);
  hr2d_scene_destroy(d->scene);
}

/* The number of pieces of each patch.  No piece is longer than `length` longest patches. */
static void divide(dense *d, double length) {
  const hr2d_scene *scene = d->cost->scene;
  const double longest = scene_longest_patch(scene);
  for (size_t k = 0; k < d->patches; k++) {
    const double count = ceil(hr2d_scene_length(scene, k) / (length * longest) - 1e-9);
    d->first[k + 1] = d->first[k] + (size_t)fmin(MOST_PIECES, fmax(1, count));
  }
  d->pieces = d->first[d->patches];
}

/* The point is the same to the last bit from either end of the segment, so that the pieces of
   patches back to back also lie back to back. */
static hr2d_point between(hr2d_segment s, size_t k, size_t count) {
  if (s.b.x < s.a.x || (s.b.x == s.a.x && s.b.y < s.a.y))
    return between((hr2d_segment){s.b, s.a}, count - k, count);
  const double t = (double)k / (double)count;
  return k == count ? s.b
                    : (hr2d_point){s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
}

static hr2d_status add_pieces(dense *d, size_t patch) {
  const hr2d_segment s = hr2d_scene_segment(d->cost->scene, patch);
  const size_t count = d->first[patch + 1] - d->first[patch];
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; !status && k < count; k++) {
    hr2d_patch piece = HR2D_PATCH_INIT;
    piece.a = between(s, k, count);
    piece.b = between(s, k + 1, count);
    status = hr2d_scene_add(d->scene, &piece, NULL);
  }
  return status;
}

static hr2d_status make_scene(dense *d) {
  hr2d_status status = hr2d_scene_create(NULL, &d->scene);
  for (size_t k = 0; !status && k < d->patches; k++) status = add_pieces(d, k);
  return status ? status : hr2d_scene_commit(d->scene);
}

static hr2d_status make_room(dense *d) {
  const size_t n = d->pieces;
  d->area = calloc(n, n * sizeof *d->area);
  d->matrix = calloc(n, n * sizeof *d->matrix);
  d->b = calloc(n, d->bands * sizeof *d->b);
  d->column = malloc(n * sizeof *d->column);
  d->order = gsl_permutation_alloc(n);
  return d->area && d->matrix && d->b && d->column && d->order ? HR2D_OK : HR2D_ENOMEM;
}

/* Rows of I − ρF, and E. */
static void set_band(dense *d, size_t band) {
  const hr2d_scene *scene = d->cost->scene;
  const size_t n = d->pieces;
  for (size_t k = 0; k < d->patches; k++)
    for (size_t i = d->first[k]; i < d->first[k + 1]; i++) {
      const double scale =
          hr2d_scene_reflectance(scene, k, band) / hr2d_scene_length(d->scene, i);
      for (size_t j = 0; j < n; j++)
        d->matrix[i * n + j] = (i == j) - scale * d->area[i * n + j];
      d->column[i] = hr2d_scene_emission(scene, k, band);
    }
}

static hr2d_status solve_band(dense *d, size_t band) {
  const size_t n = d->pieces;
  gsl_matrix_view matrix = gsl_matrix_view_array(d->matrix, n, n);
  gsl_vector_view column = gsl_vector_view_array(d->column, n);
  int sign = 0;
  set_band(d, band);
  if (gsl_linalg_LU_decomp(&matrix.matrix, d->order, &sign) ||
      gsl_linalg_LU_svx(&matrix.matrix, d->order, &column.vector))
    return HR2D_ENO_SOLUTION;
  for (size_t i = 0; i < n; i++) d->b[i * d->bands + band] = d->column[i];
  return HR2D_OK;
}

static double average(const void *ctx, size_t patch, size_t band) {
  const dense *d = ctx;
  double sum = 0, length = 0;
  for (size_t i = d->first[patch]; i < d->first[patch + 1]; i++) {
    sum += hr2d_scene_length(d->scene, i) * d->b[i * d->bands + band];
    length += hr2d_scene_length(d->scene, i);
  }
  return sum / length;
}

static hr2d_status run(dense *d, double length) {
  hr2d_matrix_options how = HR2D_MATRIX_OPTIONS_INIT;
  how.threads = options_threads(d->cost->options);
  how.progress = progress_show;
  how.progress_ctx = &d->cost->line;
  d->first = calloc(d->patches + 1, sizeof *d->first);
  if (!d->first) return HR2D_ENOMEM;
  divide(d, length);
  hr2d_status status = make_scene(d);
  if (status && d->scene)
    snprintf(d->cost->message, sizeof d->cost->message, "%s", hr2d_scene_message(d->scene));
  if (!status) status = make_room(d);
  if (!status) status = hr2d_exchange_matrix(d->scene, &how, d->area, NULL);
  for (size_t b = 0; !status && b < d->bands; b++) status = solve_band(d, b);
  return status;
}

static hr2d_status time_row(cost *c, const cost_method *m, double length, cost_row *row) {
  double best = INFINITY;
  for (int k = 0, runs = 1; k < runs; k++) {
    dense d = {.cost = c,
               .patches = hr2d_scene_patches(c->scene),
               .bands = hr2d_scene_bands(c->scene)};
    const double start = clock_seconds();
    const hr2d_status status = run(&d, length);
    const double time = clock_seconds() - start;
    if (!k) runs = pace_repeats(time);
    best = fmin(best, time);
    const uint64_t n = d.pieces;
    if (!status)
      *row = (cost_row){
          m, length, 1, n, n * n, 2 * n * n * sizeof(double), best, cost_error(c, average, &d)};
    clear(&d);
    if (status) return status;
  }
  return HR2D_OK;
}

hr2d_status cost_dense(cost *c, const cost_method *m) {
  double length = m->first;
  pace p = pace_start(c->share);
  if (hr2d_scene_effect(c->scene, HR2D_EFFECT_BACKGROUND, NULL)) {
    snprintf(c->message, sizeof c->message, "a full matrix does not know the background");
    return HR2D_EUNSUPPORTED;
  }
  for (size_t k = 0; k < hr2d_scene_patches(c->scene); k++)
    if (hr2d_scene_bands(c->scene) > 1 &&
        hr2d_scene_heat(c->scene, k, NULL) == HR2D_HEAT_FLUX) {
      snprintf(c->message, sizeof c->message,
               "a full matrix does not know fluxes in several bands");
      return HR2D_EUNSUPPORTED;
    }
  while (pace_allows(&p) && length * MOST_PIECES >= 1) {
    cost_row row;
    const double start = clock_seconds();
    hr2d_status status = time_row(c, m, length, &row);
    if (!status) status = cost_add(c, &row);
    if (status) return status;
    pace_note(&p, row.seconds, clock_seconds() - start);
    length *= m->ratio;
  }
  return HR2D_OK;
}
