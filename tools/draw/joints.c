/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ends of bands where patches meet, and the thickness at which bands do not overlap. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>

/* With more patches than this, pairs are not compared, and the bands are thin. */
enum { MOST_COMPARED = 2000 };

#define THICKEST 8.0
#define THINNEST 1.5
#define SLIM     0.07 /* of the shorter side of a scene that is filled */
#define TOUCH    0.05 /* two points that are closer are the same point */
#define TURN     6.283185307179586

static double distance(hr2d_point p, hr2d_point q) {
  return hypot(q.x - p.x, q.y - p.y);
}

double joints_distance(hr2d_point q, const stroke *s) {
  if (!(s->length > 0)) return distance(q, s->a);
  const double ux = (s->b.x - s->a.x) / s->length, uy = (s->b.y - s->a.y) / s->length;
  const double t = fmin(fmax((q.x - s->a.x) * ux + (q.y - s->a.y) * uy, 0), s->length);
  return distance(q, (hr2d_point){s->a.x + t * ux, s->a.y + t * uy});
}

/* The angle by which the direction p→u turns towards the front to become p→v. */
static double opening(const stroke *s, hr2d_point p, hr2d_point u, hr2d_point v) {
  const double ux = u.x - p.x, uy = u.y - p.y, vx = v.x - p.x, vy = v.y - p.y;
  const double side = ux * s->front.y - uy * s->front.x > 0 ? 1 : -1;
  const double angle = atan2(side * (ux * vy - uy * vx), ux * vx + uy * vy);
  return angle < 1e-6 ? angle + TURN : angle;
}

/* The smallest opening between stroke s and others at its end `at`; u is its other end. */
static double smallest(const picture *p, const stroke *s, hr2d_point at, hr2d_point u) {
  double min = TURN;
  for (size_t k = 0; k < hr2d_scene_patches(p->run->scene); k++) {
    const stroke *o = &p->strokes[k];
    if (o == s || joints_distance(at, o) > TOUCH) continue;
    if (distance(at, o->a) > TOUCH) min = fmin(min, opening(s, at, u, o->a));
    if (distance(at, o->b) > TOUCH) min = fmin(min, opening(s, at, u, o->b));
  }
  return min;
}

/* The bisector divides an opening below 180° between two neighbours. */
static double cut(const picture *p, const stroke *s, hr2d_point at, hr2d_point u) {
  const double angle = smallest(p, s, at, u);
  return angle < 0.5 * TURN ? fmin(p->band / tan(0.5 * angle), 0.5 * s->length) : 0;
}

/* The height of a point in front of a stroke; infinite if it is not in front of it. */
static double ahead(hr2d_point q, const stroke *s) {
  if (!(s->length > 0)) return INFINITY;
  const double dx = q.x - s->a.x, dy = q.y - s->a.y;
  const double along = (dx * (s->b.x - s->a.x) + dy * (s->b.y - s->a.y)) / s->length;
  const double height = dx * s->front.x + dy * s->front.y;
  return along < 0 || along > s->length || height < TOUCH ? INFINITY : height;
}

/* The narrowest gap between a patch and the end of another one in front of it. */
static double narrowest(const picture *p) {
  const size_t count = hr2d_scene_patches(p->run->scene);
  double min = INFINITY;
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < count; j++) {
      const stroke *s = &p->strokes[i], *o = &p->strokes[j];
      if (i == j || joints_distance(s->a, o) < TOUCH || joints_distance(s->b, o) < TOUCH)
        continue;
      min = fmin(min, fmin(ahead(o->a, s), ahead(o->b, s)));
    }
  return min;
}

static double choose_band(const picture *p) {
  const size_t count = hr2d_scene_patches(p->run->scene);
  if (count > MOST_COMPARED) return THINNEST;
  const double side = p->scale * fmin(p->size.x, p->size.y);
  const double thickest = p->filled && side > 0 ? fmin(THICKEST, SLIM * side) : THICKEST;
  return fmax(THINNEST, fmin(thickest, 0.4 * narrowest(p)));
}

static int is_twin(const stroke *s, const stroke *o) {
  return distance(s->a, o->b) < TOUCH && distance(s->b, o->a) < TOUCH;
}

void joints_make(picture *p) {
  const size_t count = hr2d_scene_patches(p->run->scene);
  p->band = p->coloured ? choose_band(p) : THINNEST;
  if (count > MOST_COMPARED) return;
  for (size_t k = 0; k < count; k++) {
    stroke *s = &p->strokes[k];
    s->cut_a = cut(p, s, s->a, s->b);
    s->cut_b = cut(p, s, s->b, s->a);
    for (size_t j = 0; j < count; j++)
      if (j != k && is_twin(s, &p->strokes[j])) s->twin = 1;
  }
}
#endif
