/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What one does without a hierarchy: patches in equal pieces, one number on each, and the view
   factors of all pieces that see each other, as hr2d_exchange_rows_create() finds them.

   With S the exchange areas, B = E + ρ/A S B.  For B = E + R z, R = √(ρ/A), that is
   (I − R S R) z = R S E, which is symmetric, and positive definite where some light is lost:
   conjugate gradients. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/scene.h"
#include "cost/cost.h"
#include "cost/pace.h"
#include "cost/pieces.h"
#include "output/clock.h"

/* The error of constants falls like the square of their length in longest patches, if not
   more slowly; that of the iteration is to be less. */
#define TOLERANCE 1e-4

enum {
  MOST_ITERATIONS = 100000,
  VECTORS = 6,
  ENTRY_BYTES = 18 /* while rows are made */
};

typedef struct factors {
  cost *cost;
  double length; /* of pieces, in longest patches */
  pieces pieces;
  hr2d_exchange_rows *rows;
  size_t patches, bands;
  double *b; /* pieces × bands: the solution */
  double *room;
  double *scale, *z, *residual, *direction, *image, *field; /* of one band, in `room` */
} factors;

static void clear(factors *f) {
  pieces_clear(&f->pieces);
  hr2d_exchange_rows_destroy(f->rows);
  free(f->b);
  free(f->room);
}

static hr2d_status make_room(factors *f) {
  const size_t n = f->pieces.count;
  f->b = calloc(n, f->bands * sizeof *f->b);
  f->room = calloc(n, VECTORS * sizeof *f->room);
  if (!f->b || !f->room) return HR2D_ENOMEM;
  f->scale = f->room;
  f->z = f->room + n;
  f->residual = f->room + 2 * n;
  f->direction = f->room + 3 * n;
  f->image = f->room + 4 * n;
  f->field = f->room + 5 * n;
  return HR2D_OK;
}

/* E of a band into `field`, and R. */
static void set_band(factors *f, size_t band) {
  const hr2d_scene *whole = f->cost->scene;
  size_t i = 0;
  for (size_t k = 0; k < f->patches; k++)
    for (; i < f->pieces.first[k + 1]; i++) {
      f->scale[i] =
          sqrt(hr2d_scene_reflectance(whole, k, band) / hr2d_scene_length(f->pieces.scene, i));
      f->field[i] = hr2d_scene_emission(whole, k, band);
    }
  for (; i < f->pieces.count; i++) {
    f->scale[i] = 0;
    f->field[i] = hr2d_scene_background(whole, band);
  }
}

/* image = R S field */
static void exchange(factors *f) {
  const uint64_t *start = hr2d_exchange_rows_start(f->rows);
  const uint32_t *column = hr2d_exchange_rows_column(f->rows);
  const double *area = hr2d_exchange_rows_area(f->rows);
  for (size_t i = 0; i < f->pieces.count; i++) {
    double even = 0, odd = 0;
    uint64_t k = start[i];
    for (; k + 1 < start[i + 1]; k += 2) {
      even += area[k] * f->field[column[k]];
      odd += area[k + 1] * f->field[column[k + 1]];
    }
    if (k < start[i + 1]) even += area[k] * f->field[column[k]];
    f->image[i] = f->scale[i] * (even + odd);
  }
}

static double dot(const factors *f, const double *u, const double *v) {
  double sum = 0;
  for (size_t k = 0; k < f->pieces.count; k++) sum += u[k] * v[k];
  return sum;
}

/* From E in `field` to z. */
static hr2d_status iterate(factors *f) {
  const size_t n = f->pieces.count;
  exchange(f);
  memset(f->z, 0, n * sizeof *f->z);
  memcpy(f->residual, f->image, n * sizeof *f->residual);
  memcpy(f->direction, f->image, n * sizeof *f->direction);
  const double first = dot(f, f->residual, f->residual),
               enough = first * pow(TOLERANCE * f->length * f->length, 2);
  double rest = first;
  for (int step = 0; rest > enough; step++) {
    for (size_t k = 0; k < n; k++) f->field[k] = f->scale[k] * f->direction[k];
    exchange(f);
    for (size_t k = 0; k < n; k++) f->image[k] = f->direction[k] - f->image[k];
    const double curvature = dot(f, f->direction, f->image);
    if (!(curvature > 0) || step == MOST_ITERATIONS) return HR2D_ENO_SOLUTION;
    const double step_length = rest / curvature, before = rest;
    for (size_t k = 0; k < n; k++) {
      f->z[k] += step_length * f->direction[k];
      f->residual[k] -= step_length * f->image[k];
    }
    rest = dot(f, f->residual, f->residual);
    for (size_t k = 0; k < n; k++)
      f->direction[k] = f->residual[k] + rest / before * f->direction[k];
  }
  return HR2D_OK;
}

static hr2d_status solve_band(factors *f, size_t band) {
  set_band(f, band);
  const hr2d_status status = iterate(f);
  set_band(f, band);
  for (size_t k = 0; k < f->pieces.count; k++)
    f->b[k * f->bands + band] = f->field[k] + f->scale[k] * f->z[k];
  return status;
}

static double average(const void *ctx, size_t patch, size_t band) {
  const factors *f = ctx;
  double sum = 0, length = 0;
  for (size_t i = f->pieces.first[patch]; i < f->pieces.first[patch + 1]; i++) {
    sum += hr2d_scene_length(f->pieces.scene, i) * f->b[i * f->bands + band];
    length += hr2d_scene_length(f->pieces.scene, i);
  }
  return sum / length;
}

static hr2d_status run(factors *f) {
  hr2d_matrix_options how = HR2D_MATRIX_OPTIONS_INIT;
  how.threads = options_threads(f->cost->options);
  how.progress = progress_show;
  how.progress_ctx = &f->cost->line;
  hr2d_status status = pieces_make(&f->pieces, f->cost->scene, f->length);
  if (status && f->pieces.scene)
    snprintf(f->cost->message, sizeof f->cost->message, "%s",
             hr2d_scene_message(f->pieces.scene));
  if (!status) status = make_room(f);
  if (!status) status = hr2d_exchange_rows_create(f->pieces.scene, &how, &f->rows, NULL);
  for (size_t b = 0; !status && b < f->bands; b++) status = solve_band(f, b);
  return status;
}

static void note(factors *f, const cost_method *m, double seconds, cost_row *row) {
  const uint64_t n = f->pieces.count, entries = hr2d_exchange_rows_entries(f->rows);
  *row = (cost_row){m,       f->length,
                    1,       n,
                    entries, ENTRY_BYTES * entries + n * (VECTORS + f->bands) * sizeof(double),
                    seconds, cost_error(f->cost, average, f)};
}

/* `images` receives the number of images of a piece. */
static hr2d_status time_row(cost *c, const cost_method *m, double length, cost_row *row,
                            size_t *images) {
  double best = INFINITY;
  for (int k = 0, runs = 1; k < runs; k++) {
    factors f = {.cost = c,
                 .length = length,
                 .patches = hr2d_scene_patches(c->scene),
                 .bands = hr2d_scene_bands(c->scene)};
    const double start = clock_seconds();
    const hr2d_status status = run(&f);
    const double time = clock_seconds() - start;
    if (!k) runs = pace_repeats(time);
    if (!status) best = fmin(best, time);
    if (!status) note(&f, m, best, row);
    if (!status) *images = hr2d_scene_images(f.pieces.scene);
    clear(&f);
    if (cost_keeps(c, status, k)) break;
    if (status) return status;
  }
  return HR2D_OK;
}

/* Pieces narrower than a degree are overlooked. */
static int has_sky(const hr2d_scene *scene, size_t band) {
  for (int bearing = -180; bearing < 180; bearing++)
    if (hr2d_scene_sky(scene, bearing, band) != hr2d_scene_background(scene, band)) return 1;
  return 0;
}

/* What the method does not know of the scene, or NULL. */
static const char *unknown(const hr2d_scene *scene) {
  const size_t bands = hr2d_scene_bands(scene);
  for (size_t b = 0; b < bands; b++)
    if (hr2d_scene_sun(scene, b).irradiance > 0 || has_sky(scene, b)) return "sun and sky";
  if (hr2d_scene_effect(scene, HR2D_EFFECT_PANES, NULL)) return "panes and shields";
  for (size_t k = 0; bands > 1 && k < hr2d_scene_patches(scene); k++)
    if (hr2d_scene_heat(scene, k, NULL) == HR2D_HEAT_FLUX) return "fluxes in several bands";
  return NULL;
}

hr2d_status cost_factors(cost *c, const cost_method *m) {
  double length = m->first;
  pace p = pace_start(c->share);
  const char *what = unknown(c->scene);
  if (what) {
    snprintf(c->message, sizeof c->message, "equal pieces do not know %s", what);
    return HR2D_EUNSUPPORTED;
  }
  cost_row row = {.bytes = 0};
  size_t max = 0, images = 0;
  /* Half as long pieces have four times as many entries.  Where images go on for ever, very
     many pieces have fewer of them, and what is extrapolated from few is not of their accuracy.
   */
  while (pace_allows(&p) && length * PIECES_MOST >= 1 && 4 * row.bytes <= COST_MOST_BYTES) {
    const double start = clock_seconds();
    hr2d_status status = time_row(c, m, length, &row, &images);
    if (!status && images < max) break;
    max = images;
    if (!status) status = cost_add(c, &row);
    if (status) return status;
    pace_note(&p, row.seconds, clock_seconds() - start);
    length *= m->ratio;
  }
  return HR2D_OK;
}
