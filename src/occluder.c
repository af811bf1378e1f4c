/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Search for an occluder: a patch that meets the inside of the shaft of two others. */
#include "occluder.h"

#include <math.h>

#include "alloc.h"
#include "predicates.h"
#include "scene-impl.h"

/* The shaft of a facing pair a→b, c→d: all that is strictly left of the lines ab
   and cd and of the sides b→c and d→a.  Where one patch reaches behind the other,
   the side at that end runs along a patch's line and falls away. */
typedef struct shaft {
  hr2d_point a, b, c, d;
  double A, B, C, D; /* orient abc, abd, cda, cdb */
} shaft;

static int same(hr2d_point p, hr2d_point q) {
  return p.x == q.x && p.y == q.y;
}

static int outside(hr2d_point from, hr2d_point to, const hr2d_segment *w) {
  return hr2d_orientation(from, to, w->a) <= 0 && hr2d_orientation(from, to, w->b) <= 0;
}

/* The side of w's line on which the end e of a patch lies; or, if e is behind the
   other patch's line by `behind` < 0 and the patch's other end f before it by
   `before` > 0, the side of the point of the patch on that line: the sign of
   orient(w,e)·before − orient(w,f)·behind, compared as ratios lest it underflow. */
static int clipped_side(const hr2d_segment *w, hr2d_point e, double behind, hr2d_point f,
                        double before) {
  const int at_e = hr2d_orientation(w->a, w->b, e), at_f = hr2d_orientation(w->a, w->b, f);
  if (behind >= 0 || at_e == at_f || at_f == 0) return at_e;
  if (at_e == 0) return at_f;
  const double ratio = fabs(hr2di_orient(w->a, w->b, e) / hr2di_orient(w->a, w->b, f));
  const double limit = fabs(behind / before);
  return ratio > limit ? at_e : ratio < limit ? at_f : 0;
}

/* Separating lines: those of the shaft's sides, then the occluder's own. */
static int reaches_into(const shaft *s, const hr2d_segment *w) {
  if (outside(s->a, s->b, w) || outside(s->c, s->d, w)) return 0;
  if (s->A >= 0 && s->D >= 0 && !same(s->b, s->c) && outside(s->b, s->c, w)) return 0;
  if (s->B >= 0 && s->C >= 0 && !same(s->d, s->a) && outside(s->d, s->a, w)) return 0;
  const int side[] = {
      clipped_side(w, s->a, s->C, s->b, s->D), clipped_side(w, s->b, s->D, s->a, s->C),
      clipped_side(w, s->c, s->A, s->d, s->B), clipped_side(w, s->d, s->B, s->c, s->A)};
  int left = 0, right = 0;
  for (int k = 0; k < 4; k++) {
    left |= side[k] > 0;
    right |= side[k] < 0;
  }
  return left && right;
}

/* A patch with the whole scene on one side of its line can stand between nothing. */
static int on_hull(const hr2d_scene *scene, size_t k) {
  const hr2d_segment w = scene->patch[k].scaled;
  int left = 0, right = 0;
  for (size_t m = 0; m < scene->patches; m++) {
    const hr2d_segment s = scene->patch[m].scaled;
    const int at_a = hr2d_orientation(w.a, w.b, s.a), at_b = hr2d_orientation(w.a, w.b, s.b);
    left |= at_a > 0 || at_b > 0;
    right |= at_a < 0 || at_b < 0;
    if (left && right) return 0;
  }
  return 1;
}

/* The first of the inner patches that reaches into the shaft of i and j, or `count`. */
static size_t find_for_pair(const hr2d_scene *scene, const size_t *inner, size_t count,
                            size_t i, size_t j) {
  const hr2d_segment *s = &scene->patch[i].scaled, *t = &scene->patch[j].scaled;
  if (hr2di_face(s, t) == HR2DI_FACING_NONE) return count;
  const shaft between = {.a = s->a,
                         .b = s->b,
                         .c = t->a,
                         .d = t->b,
                         .A = hr2di_orient(s->a, s->b, t->a),
                         .B = hr2di_orient(s->a, s->b, t->b),
                         .C = hr2di_orient(t->a, t->b, s->a),
                         .D = hr2di_orient(t->a, t->b, s->b)};
  size_t k = 0;
  while (k < count && (inner[k] == i || inner[k] == j ||
                       !reaches_into(&between, &scene->patch[inner[k]].scaled)))
    k++;
  return k;
}

hr2d_status hr2di_find_occluder(hr2d_scene *scene, hr2di_occlusion *found) {
  const size_t n = scene->patches;
  *found = (hr2di_occlusion){0};
  size_t *inner = hr2di_alloc(&scene->alloc, n, sizeof *inner), count = 0;
  if (!inner) return hr2di_fail(&scene->message, HR2D_ENOMEM, "out of memory for the analysis");
  for (size_t k = 0; k < n; k++)
    if (!on_hull(scene, k)) inner[count++] = k;
  for (size_t i = 0; count > 0 && i < n && !found->exists; i++)
    for (size_t j = i + 1; j < n && !found->exists; j++) {
      const size_t k = find_for_pair(scene, inner, count, i, j);
      if (k < count) *found = (hr2di_occlusion){1, i, j, inner[k]};
    }
  hr2di_free(&scene->alloc, inner);
  return HR2D_OK;
}
