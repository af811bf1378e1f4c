/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cost/box.h"

#include <math.h>

/* Light that runs far, in the gap between patches and the box, is known by images that are
   extrapolated, of which many pieces have few. */
#define CLOSE 1e-3

static hr2d_point direction_of(hr2d_segment s) {
  const double length = hypot(s.b.x - s.a.x, s.b.y - s.a.y);
  return (hr2d_point){(s.b.x - s.a.x) / length, (s.b.y - s.a.y) / length};
}

/* Along the period, or else a mirror. */
static hr2d_point axis_of(const hr2d_scene *scene) {
  const hr2d_point d = hr2d_scene_period(scene);
  if (d.x != 0 || d.y != 0) return direction_of((hr2d_segment){{0, 0}, d});
  return hr2d_scene_mirrors(scene) ? direction_of(hr2d_scene_mirror(scene, 0))
                                   : (hr2d_point){1, 0};
}

static double coordinate(const box *b, hr2d_point p, int which) {
  return which ? p.y * b->axis.x - p.x * b->axis.y : p.x * b->axis.x + p.y * b->axis.y;
}

static void take(box *b, hr2d_point p) {
  for (int k = 0; k < 2; k++) {
    b->low[k] = fmin(b->low[k], coordinate(b, p, k));
    b->high[k] = fmax(b->high[k], coordinate(b, p, k));
  }
}

/* All patches are on one side of a mirror; the box ends at it. */
static void end_at_mirror(box *b, hr2d_segment line) {
  const hr2d_point d = direction_of(line);
  const int which = fabs(d.x * b->axis.x + d.y * b->axis.y) > 0.5;
  const double at = coordinate(b, line.a, which);
  const int low = 2 * at < b->low[which] + b->high[which];
  *(low ? &b->low[which] : &b->high[which]) = at;
  *(low ? &b->open_low[which] : &b->open_high[which]) = 1;
}

/* A period long; half of it, beside a mirror that turns it round. */
static void end_at_period(box *b, hr2d_point period) {
  const double size = hypot(period.x, period.y);
  if (b->open_low[0]) {
    b->high[0] = b->low[0] + .5 * size;
  } else if (b->open_high[0]) {
    b->low[0] = b->high[0] - .5 * size;
  } else {
    b->low[0] = .5 * (b->low[0] + b->high[0] - size);
    b->high[0] = b->low[0] + size;
  }
  b->open_low[0] = b->open_high[0] = 1;
}

box box_around(const hr2d_scene *scene) {
  box b = {axis_of(scene), {INFINITY, INFINITY}, {-INFINITY, -INFINITY}, {0, 0}, {0, 0}};
  const hr2d_point period = hr2d_scene_period(scene);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    take(&b, hr2d_scene_segment(scene, k).a);
    take(&b, hr2d_scene_segment(scene, k).b);
  }
  for (size_t k = 0; k < hr2d_scene_mirrors(scene); k++)
    end_at_mirror(&b, hr2d_scene_mirror(scene, k));
  if (period.x != 0 || period.y != 0) end_at_period(&b, period);
  const int endless = (b.open_low[0] && b.open_high[0]) || (b.open_low[1] && b.open_high[1]);
  const double off = (endless ? CLOSE : 1) * fmax(b.high[0] - b.low[0], b.high[1] - b.low[1]);
  for (int k = 0; k < 2; k++) {
    if (!b.open_low[k]) b.low[k] -= off;
    if (!b.open_high[k]) b.high[k] += off;
  }
  return b;
}
