/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of the sky: setting them, and their values. */
#include "scene/sky.h"

#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"

static double value_of(const hr2di_sky *sky, size_t piece, size_t band) {
  return sky->value[piece * sky->bands + (sky->bands == 1 ? 0 : band)];
}

double hr2di_sky_beyond(const hr2d_scene *scene, size_t piece, size_t band) {
  return value_of(&scene->sky, piece, band) - hr2d_scene_background(scene, band);
}

double hr2di_sky_max(const hr2d_scene *scene, size_t band) {
  double max = hr2d_scene_background(scene, band);
  for (size_t k = 0; k < scene->sky.pieces; k++)
    max = fmax(max, value_of(&scene->sky, k, band));
  return max;
}

double hr2di_sky_min(const hr2d_scene *scene, size_t band) {
  double min = hr2d_scene_background(scene, band);
  for (size_t k = 0; k < scene->sky.pieces; k++)
    min = fmin(min, value_of(&scene->sky, k, band));
  return min;
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

hr2d_status hr2di_scene_check_sky(hr2d_scene *scene, const hr2d_sky_piece *piece, size_t pieces,
                                  const double *value, size_t bands) {
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE, "a committed scene takes no sky");
  if (pieces && (!piece || !value || !bands))
    return hr2di_message_fail(&scene->message, HR2D_EINVAL, "sky: pieces without values");
  for (size_t k = 0; k < pieces * bands; k++)
    if (!(value[k] >= 0) || !isfinite(value[k]))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "sky: radiosity %g is not a number of 0 or more", value[k]);
  return check_pieces(scene, piece, pieces);
}

void hr2di_scene_take_sky(hr2d_scene *scene, const hr2di_sky *sky) {
  hr2di_sky_clear(&scene->sky, &scene->alloc);
  scene->sky = *sky;
}

hr2d_status hr2d_scene_set_sky(hr2d_scene *scene, const hr2d_sky_piece *piece, size_t pieces,
                               const double *value, size_t bands) {
  if (!scene) return HR2D_EINVAL;
  const hr2d_status status = hr2di_scene_check_sky(scene, piece, pieces, value, bands);
  if (status) return status;
  hr2di_sky sky = {.pieces = pieces, .bands = bands};
  sky.piece = hr2di_alloc(&scene->alloc, pieces, sizeof *sky.piece);
  sky.value = hr2di_alloc(&scene->alloc, pieces * bands, sizeof *sky.value);
  if (!sky.piece || !sky.value) {
    hr2di_sky_clear(&sky, &scene->alloc);
    return hr2di_message_fail(&scene->message, HR2D_ENOMEM, "out of memory for the sky");
  }
  for (size_t k = 0; k < pieces; k++) sky.piece[k] = piece[k];
  for (size_t k = 0; k < pieces * bands; k++) sky.value[k] = value[k];
  hr2di_scene_take_sky(scene, &sky);
  return HR2D_OK;
}

/* The piece in a direction; as many as there are pieces for the background. */
static size_t piece_at(const hr2di_sky *sky, double bearing) {
  size_t k = 0;
  while (k < sky->pieces && !(hr2di_sky_turned(bearing - sky->piece[k].from) <
                              sky->piece[k].to - sky->piece[k].from))
    k++;
  return k;
}

int hr2di_sky_has(const hr2d_scene *scene, size_t piece, double bearing) {
  return piece_at(&scene->sky, bearing) == piece;
}

static double seen_at(const hr2d_scene *scene, size_t piece, size_t band) {
  return piece < scene->sky.pieces ? value_of(&scene->sky, piece, band)
                                   : hr2d_scene_background(scene, band);
}

double hr2d_scene_sky(const hr2d_scene *scene, double bearing, size_t band) {
  if (!hr2di_scene_has_band(scene, band)) return NAN;
  return seen_at(scene, piece_at(&scene->sky, bearing), band);
}

size_t hr2d_scene_sky_pieces(const hr2d_scene *scene) {
  if (!scene) return 0;
  return scene->sky.pieces;
}

double hr2di_sky_jump(const hr2d_scene *scene, double bearing, const double *max) {
  const size_t before = piece_at(&scene->sky, bearing - 2 * ROUND),
               after = piece_at(&scene->sky, bearing + 2 * ROUND);
  double jump = 0;
  for (size_t b = 0; b < scene->bands && before != after; b++)
    if (max[b] > 0)
      jump = fmax(jump, fabs(seen_at(scene, after, b) - seen_at(scene, before, b)) / max[b]);
  return jump;
}
