/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cost/pieces.h"

#include <math.h>
#include <stdlib.h>

#include "cost/box.h"

static double longest_patch(const hr2d_scene *scene) {
  double longest = 0;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    longest = fmax(longest, hr2d_scene_length(scene, k));
  return longest;
}

static void divide(pieces *p, const hr2d_scene *whole, double length) {
  const double longest = longest_patch(whole);
  const size_t patches = hr2d_scene_patches(whole);
  for (size_t k = 0; k < patches; k++) {
    const double count = ceil(hr2d_scene_length(whole, k) / (length * longest) - 1e-9);
    p->first[k + 1] = p->first[k] + (size_t)fmin(PIECES_MOST, fmax(1, count));
  }
  p->count = p->first[patches];
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

static hr2d_status add(pieces *p, hr2d_point a, hr2d_point b) {
  hr2d_patch piece = HR2D_PATCH_INIT;
  piece.a = a;
  piece.b = b;
  return hr2d_scene_add(p->scene, &piece, NULL);
}

static hr2d_status add_patch(pieces *p, hr2d_segment s, size_t count) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; !status && k < count; k++)
    status = add(p, between(s, k, count), between(s, k + 1, count));
  return status;
}

static hr2d_status repeat(hr2d_scene *scene, const hr2d_scene *whole) {
  hr2d_status status = hr2d_scene_set_period(scene, hr2d_scene_period(whole));
  for (size_t k = 0; !status && k < hr2d_scene_mirrors(whole); k++)
    status = hr2d_scene_add_mirror(scene, hr2d_scene_mirror(whole, k));
  return status;
}

/* Between mirrors and the ends of a cell there are no sides. */
static hr2d_status add_box(pieces *p, const hr2d_scene *whole) {
  const box b = box_around(whole);
  hr2d_point corner[5];
  for (int k = 0; k < 5; k++) {
    const double x = k % 4 == 1 || k % 4 == 2 ? b.high[0] : b.low[0];
    const double y = k % 4 == 2 || k % 4 == 3 ? b.high[1] : b.low[1];
    corner[k] = (hr2d_point){x * b.axis.x - y * b.axis.y, x * b.axis.y + y * b.axis.x};
  }
  const int open[] = {b.open_low[1], b.open_high[0], b.open_high[1], b.open_low[0]};
  hr2d_status status = HR2D_OK;
  for (int k = 0; !status && k < 4; k++) {
    if (open[k]) continue;
    status = add(p, corner[k], corner[k + 1]);
    p->count++;
  }
  return status;
}

hr2d_status pieces_make(pieces *p, const hr2d_scene *whole, double length) {
  const size_t patches = hr2d_scene_patches(whole);
  *p = (pieces){.first = calloc(patches + 1, sizeof *p->first)};
  if (!p->first) return HR2D_ENOMEM;
  divide(p, whole, length);
  hr2d_status status = hr2d_scene_create(NULL, &p->scene);
  for (size_t k = 0; !status && k < patches; k++)
    status = add_patch(p, hr2d_scene_segment(whole, k), p->first[k + 1] - p->first[k]);
  if (!status) status = repeat(p->scene, whole);
  if (!status && hr2d_scene_effect(whole, HR2D_EFFECT_BACKGROUND, NULL))
    status = add_box(p, whole);
  return status ? status : hr2d_scene_commit(p->scene);
}

void pieces_clear(pieces *p) {
  free(p->first);
  hr2d_scene_destroy(p->scene);
}
