/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sides are signs of given points, with what counts as lying on the line of i or of j. */
#include "occlusion/clipped-occluders.h"

#include <stddef.h>

/* The end of s that is behind the line of `by`; NULL if there is none. */
static hr2d_point *end_behind(hr2d_segment *s, hr2d_segment by) {
  if (hr2di_orient_sign(by.a, by.b, s->a) < 0) return &s->a;
  return hr2di_orient_sign(by.a, by.b, s->b) < 0 ? &s->b : NULL;
}

int hr2di_opening_init(hr2di_opening *o, hr2di_facing facing, hr2d_segment i, hr2d_segment j) {
  *o = (hr2di_opening){{hr2di_axis_of(i), hr2di_axis_of(j)}, {i, j}, {1, 1}};
  if (facing == HR2DI_FACING_NONE) return 0;
  hr2d_point *of_i = end_behind(&o->part[0], j), *of_j = end_behind(&o->part[1], i);
  o->hands[0] = of_i != &o->part[0].b && of_j != &o->part[1].a;
  o->hands[1] = of_i != &o->part[0].a && of_j != &o->part[1].b;
  if (of_i) *of_i = hr2di_line_crossing_at(i, j.a, j.b);
  /* If both have one, they cross. */
  if (of_j) *of_j = of_i ? *of_i : hr2di_line_crossing_at(j, i.a, i.b);
  return !hr2di_point_same(o->part[0].a, o->part[0].b) &&
         !hr2di_point_same(o->part[1].a, o->part[1].b);
}

int hr2di_opening_foot(const hr2di_opening *o, int line, hr2d_point p) {
  const hr2di_axis *axis = &o->line[line];
  const hr2d_segment part = o->part[line];
  return hr2di_axis_front(axis, p) == 0 && hr2di_axis_order(axis, part.a, p) > 0 &&
         hr2di_axis_order(axis, p, part.b) > 0;
}

/* An end of what is in front: where the occluder begins or ends, or meets a line. */
typedef struct limit {
  double at; /* along the occluder, from 0 to 1 */
  int line;  /* which one it meets there, or −1 */
  int own;   /* it is an end of the occluder */
} limit;

/* What is in front of both lines, from low to high; 0 if nothing is. */
static int find_limits(const hr2di_opening *o, hr2d_segment w, limit *low, limit *high) {
  *low = (limit){0, -1, 1};
  *high = (limit){1, -1, 1};
  for (int k = 0; k < 2; k++) {
    const hr2di_axis *line = &o->line[k];
    const int a = hr2di_axis_front(line, w.a), b = hr2di_axis_front(line, w.b);
    if (a <= 0 && b <= 0) return 0;
    if (a > 0 && b > 0) continue;
    const int own = a == 0 || b == 0;
    const double at = own ? b == 0 : hr2di_line_crossing(line->a, line->b, w.a, w.b);
    if (a <= 0 && (low->line < 0 || at > low->at)) *low = (limit){at, k, own};
    if (b <= 0 && (high->line < 0 || at < high->at)) *high = (limit){at, k, own};
  }
  return low->at < high->at;
}

/* Whether w is on one side of p and q, which is 1 for the left, or on their line. */
static int is_beside(hr2d_point p, hr2d_point q, hr2d_segment w, int side) {
  return !hr2di_point_same(p, q) && side * hr2di_orient_sign(p, q, w.a) >= 0 &&
         side * hr2di_orient_sign(p, q, w.b) >= 0;
}

/* Whether a line that separates them shows that w has nothing inside the hull of the two parts.
   No rounded point is asked: the side of the hull that ends in one is the line of i or j. */
static int is_aside(const hr2di_opening *o, hr2d_segment w) {
  const hr2d_point a = o->line[0].a, b = o->line[0].b, c = o->line[1].a, d = o->line[1].b;
  if (o->hands[0] && is_beside(b, c, w, -1)) return 1;
  if (o->hands[1] && is_beside(a, d, w, 1)) return 1;
  const hr2d_point corner[] = {a, b, c, d};
  int left = 0, right = 0;
  for (int k = 0; k < 4; k++) {
    const int side = hr2di_orient_sign(w.a, w.b, corner[k]);
    left |= side > 0;
    right |= side < 0;
  }
  return !left || !right;
}

/* Adds the end of a screen where w, which leads to the front from p to q, begins. */
static void add_end(hr2di_clipped_occluder *s, const hr2di_opening *o, const limit *from,
                    hr2d_point p, hr2d_point q) {
  hr2d_point at = p;
  if (from->line >= 0) {
    const hr2di_axis *line = &o->line[from->line];
    const hr2d_segment part = o->part[from->line];
    if (!from->own) at = hr2di_line_crossing_at((hr2d_segment){line->a, line->b}, p, q);
    const int before = from->own ? hr2di_axis_order(line, at, part.a) >= 0
                                 : hr2di_orient_sign(p, q, part.a) <= 0,
              behind = from->own ? hr2di_axis_order(line, part.b, at) >= 0
                                 : hr2di_orient_sign(p, q, part.b) >= 0;
    if (before || hr2di_point_same(at, part.a))
      s->joins |= from->line ? HR2DI_JOINS_RIGHT : HR2DI_JOINS_LEFT;
    if (behind || hr2di_point_same(at, part.b))
      s->joins |= from->line ? HR2DI_JOINS_LEFT : HR2DI_JOINS_RIGHT;
    if (before || behind) return;
  }
  s->at[s->points++] = at;
}

int hr2di_clipped_occluder_of(hr2di_clipped_occluder *s, const hr2di_opening *o,
                              hr2d_segment w) {
  limit low, high;
  *s = (hr2di_clipped_occluder){.points = 0};
  if (!find_limits(o, w, &low, &high) || is_aside(o, w)) return 0;
  add_end(s, o, &low, w.a, w.b);
  add_end(s, o, &high, w.b, w.a);
  return 1;
}
