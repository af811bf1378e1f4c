/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of the sky: setting them, and their values. */
#include "scene/sky.h"

#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"

static double value_of(const hr2di_sky *sky, size_t row, size_t band) {
  return sky->value[row * sky->bands + (sky->bands == 1 ? 0 : band)];
}

double hr2di_sky_beyond(const hr2d_scene *scene, size_t row, size_t band) {
  const hr2di_sky *sky = &scene->sky;
  return value_of(sky, row, band) -
         (row % sky->terms == 0 ? hr2d_scene_background(scene, band) : 0);
}

/* How far a piece may be from its mean: |φ_l| ≤ √(2l + 1). */
static double spread_of(const hr2di_sky *sky, size_t piece, size_t band) {
  double sum = 0;
  for (size_t l = 1; l < sky->terms; l++)
    sum += sqrt(2 * (double)l + 1) * fabs(value_of(sky, piece * sky->terms + l, band));
  return sum;
}

double hr2di_sky_max(const hr2d_scene *scene, size_t band) {
  const hr2di_sky *sky = &scene->sky;
  double max = hr2d_scene_background(scene, band);
  for (size_t k = 0; k < sky->pieces; k++)
    max = fmax(max, value_of(sky, k * sky->terms, band) + spread_of(sky, k, band));
  return max;
}

double hr2di_sky_min(const hr2d_scene *scene, size_t band) {
  const hr2di_sky *sky = &scene->sky;
  double min = hr2d_scene_background(scene, band);
  for (size_t k = 0; k < sky->pieces; k++)
    min = fmin(min, value_of(sky, k * sky->terms, band) - spread_of(sky, k, band));
  return fmax(min, 0);
}

static int is_piece(hr2d_sky_piece p) {
  return isfinite(p.from) && isfinite(p.to) && p.from < p.to && p.to - p.from <= 360;
}

/* Degrees: so much of an arc may be shared, as bearings are sums that were rounded. */
#define ROUND 1e-11

/* How much of q is in p after its beginning. */
static double common(hr2d_sky_piece p, hr2d_sky_piece q) {
  return fmin(p.to - p.from - hr2di_sky_turned(q.from - p.from), q.to - q.from);
}

/* Whether two pieces share an arc: one of them begins inside the other. */
static int overlap(hr2d_sky_piece p, hr2d_sky_piece q) {
  return common(p, q) > ROUND || common(q, p) > ROUND;
}

static hr2d_status check_pieces(hr2d_scene *scene, const hr2d_sky_piece *piece, size_t pieces) {
  if (pieces > HR2DI_SKY_PIECES)
    return hr2di_message_fail(&scene->message, HR2D_ESCENE, "sky: %zu pieces are more than %d",
                              pieces, (int)HR2DI_SKY_PIECES);
  for (size_t k = 0; k < pieces; k++) {
    if (!is_piece(piece[k]))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "sky: from %g to %g degrees is no piece of the sky",
                                piece[k].from, piece[k].to);
    for (size_t m = 0; m < k; m++)
      if (overlap(piece[m], piece[k]))
        return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                  "sky: the pieces from %g and from %g degrees overlap",
                                  piece[m].from, piece[k].from);
  }
  return HR2D_OK;
}

hr2d_status hr2di_scene_check_sky(hr2d_scene *scene, const hr2di_sky *sky) {
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE, "a committed scene takes no sky");
  if (sky->pieces && (!sky->piece || !sky->value || !sky->bands))
    return hr2di_message_fail(&scene->message, HR2D_EINVAL, "sky: pieces without values");
  for (size_t k = 0; k < hr2di_sky_rows(sky) * sky->bands; k++) {
    const int mean = k / sky->bands % sky->terms == 0;
    if ((mean && !(sky->value[k] >= 0)) || !isfinite(sky->value[k]))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "sky: radiosity %g is not a number of 0 or more",
                                sky->value[k]);
  }
  return check_pieces(scene, sky->piece, sky->pieces);
}

hr2d_status hr2di_scene_copy_sky(hr2d_scene *scene, const hr2di_sky *from) {
  const hr2d_status status = hr2di_scene_check_sky(scene, from);
  if (status) return status;
  const hr2d_allocator *alloc = &scene->alloc;
  const size_t pieces = from->pieces, rows = hr2di_sky_rows(from);
  hr2di_sky sky = {.pieces = pieces, .terms = from->terms, .bands = from->bands};
  sky.piece = hr2di_alloc(alloc, pieces, sizeof *sky.piece);
  sky.value = hr2di_alloc(alloc, rows, sky.bands * sizeof *sky.value);
  if (from->goes_on) sky.goes_on = hr2di_alloc(alloc, pieces, sizeof *sky.goes_on);
  if (!sky.piece || !sky.value || (from->goes_on && !sky.goes_on)) {
    hr2di_sky_clear(&sky, alloc);
    return hr2di_message_fail(&scene->message, HR2D_ENOMEM, "out of memory for the sky");
  }
  for (size_t k = 0; k < pieces; k++) sky.piece[k] = from->piece[k];
  for (size_t k = 0; k < pieces && from->goes_on; k++) sky.goes_on[k] = from->goes_on[k];
  for (size_t k = 0; k < rows * sky.bands; k++) sky.value[k] = from->value[k];
  hr2di_scene_take_sky(scene, &sky);
  return HR2D_OK;
}

hr2d_status hr2d_scene_set_sky(hr2d_scene *scene, const hr2d_sky_piece *piece, size_t pieces,
                               const double *value, size_t bands) {
  if (!scene) return HR2D_EINVAL;
  const hr2di_sky sky = {.piece = (hr2d_sky_piece *)(uintptr_t)piece,
                         .value = (double *)(uintptr_t)value,
                         .pieces = pieces,
                         .terms = 1,
                         .bands = bands};
  return hr2di_scene_copy_sky(scene, &sky);
}

size_t hr2di_sky_piece_at(const hr2di_sky *sky, double bearing) {
  size_t k = 0;
  while (k < sky->pieces && !(hr2di_sky_turned(bearing - sky->piece[k].from) <
                              sky->piece[k].to - sky->piece[k].from))
    k++;
  return k;
}

int hr2di_sky_edge(const hr2d_scene *scene, size_t k, double *bearing) {
  const hr2di_sky *sky = &scene->sky;
  const size_t piece = k / 2;
  *bearing = k % 2 ? sky->piece[piece].to : sky->piece[piece].from;
  if (!sky->goes_on) return 1;
  return k % 2 ? piece + 1 == sky->pieces : !sky->goes_on[piece];
}

/* A polynomial may be a rounding below 0. */
static double seen_at(const hr2d_scene *scene, size_t piece, double bearing, size_t band) {
  const hr2di_sky *sky = &scene->sky;
  double phi[HR2DI_SKY_TERMS], sum = 0;
  if (piece == sky->pieces) return hr2d_scene_background(scene, band);
  hr2di_sky_terms_at(sky, piece, bearing, phi);
  for (size_t l = 0; l < sky->terms; l++)
    sum += phi[l] * value_of(sky, piece * sky->terms + l, band);
  return fmax(sum, 0);
}

double hr2d_scene_sky(const hr2d_scene *scene, double bearing, size_t band) {
  if (!hr2di_scene_has_band(scene, band)) return NAN;
  return seen_at(scene, hr2di_sky_piece_at(&scene->sky, bearing), bearing, band);
}

size_t hr2d_scene_sky_pieces(const hr2d_scene *scene) {
  if (!scene) return 0;
  return scene->sky.pieces;
}

double hr2di_sky_jump(const hr2d_scene *scene, double bearing, const double *max) {
  const double at[2] = {bearing - 2 * ROUND, bearing + 2 * ROUND};
  const size_t before = hr2di_sky_piece_at(&scene->sky, at[0]),
               after = hr2di_sky_piece_at(&scene->sky, at[1]);
  double jump = 0;
  for (size_t b = 0; b < scene->bands && before != after; b++)
    if (max[b] > 0)
      jump =
          fmax(jump, fabs(seen_at(scene, after, at[1], b) - seen_at(scene, before, at[0], b)) /
                         max[b]);
  return jump;
}
