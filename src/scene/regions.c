/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/regions.h"

#include <math.h>

#include "base/alloc.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* Knots nearer to each other, in terms of the scene, count as one: the depth is off by that
   times what its derivative jumps by, along lines that are as rare. */
#define SAME_KNOT 0x1p-44

/* Borders that reach no farther between two elements count as touching their hull. */
#define TOUCHES 0x1p-50

static hr2d_status add_border(hr2d_scene *scene, hr2di_regions *r, hr2d_segment at,
                              size_t gas) {
  if (hr2di_alloc_reserve(&scene->alloc, &r->border, &r->border_capacity, r->borders + 1,
                          sizeof *r->border))
    return HR2D_ENOMEM;
  r->border[r->borders++] = (hr2di_border){at, gas};
  return HR2D_OK;
}

static hr2d_status add_knot(hr2d_scene *scene, hr2di_regions *r, hr2d_point at,
                            hr2di_watch *watch) {
  for (size_t k = 0; k < r->knots; k++)
    if (fabs(r->knot[k].x - at.x) <= SAME_KNOT && fabs(r->knot[k].y - at.y) <= SAME_KNOT)
      return HR2D_OK;
  if (hr2di_alloc_reserve(&scene->alloc, &r->knot, &r->knot_capacity, r->knots + 1,
                          sizeof *r->knot))
    return HR2D_ENOMEM;
  r->knot[r->knots++] = at;
  return hr2di_watch_work(watch, 1 + r->knots / 8);
}

static hr2d_point scaled(const hr2d_scene *scene, hr2d_point at) {
  return (hr2d_point){ldexp(at.x, -scene->exponent), ldexp(at.y, -scene->exponent)};
}

static hr2d_status add_gas(hr2d_scene *scene, hr2di_regions *r, size_t gas,
                           hr2di_watch *watch) {
  const hr2di_gas *g = scene->gases.gas[gas];
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < g->border_points && !status; k++) {
    const size_t next = k + 1 < g->border_points ? k + 1 : 0;
    const hr2d_segment at = {scaled(scene, hr2di_gas_border(g, k)),
                             scaled(scene, hr2di_gas_border(g, next))};
    if (hr2di_point_same(at.a, at.b)) continue;
    status = add_border(scene, r, at, gas);
    if (!status) status = add_knot(scene, r, at.a, watch);
  }
  return status;
}

/* Where two segments cross properly. */
static int crossing_of(hr2d_segment p, hr2d_segment q, hr2d_point *at) {
  const hr2d_point u = hr2di_point_minus(p.b, p.a), v = hr2di_point_minus(q.b, q.a);
  const hr2d_point w = hr2di_point_minus(q.a, p.a);
  const double turn = hr2di_point_cross(u, v);
  if (turn == 0) return 0;
  const double s = hr2di_point_cross(w, v) / turn, t = hr2di_point_cross(w, u) / turn;
  if (!(s > 0 && s < 1 && t > 0 && t < 1)) return 0;
  *at = hr2di_point_at(p, s);
  return 1;
}

static hr2d_status add_crossings(hr2d_scene *scene, hr2di_regions *r, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < r->borders && !status; k++) {
    status = hr2di_watch_work(watch, 1 + k / 8);
    for (size_t m = 0; m < k && !status; m++) {
      hr2d_point at;
      if (crossing_of(r->border[k].at, r->border[m].at, &at))
        status = add_knot(scene, r, at, watch);
    }
  }
  return status;
}

static int has_borders(const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->gases.count; k++)
    if (scene->gases.gas[k]->border_points) return 1;
  return 0;
}

hr2d_status hr2di_regions_make(hr2d_scene *scene, hr2di_watch *watch) {
  if (!has_borders(scene) || !hr2di_scene_has_gas(scene)) return HR2D_OK;
  if (scene->symmetry.motion)
    return hr2di_message_fail(&scene->message, HR2D_EUNSUPPORTED,
                              "a gas has a border, which mirrors and periods do not repeat in "
                              "this version: draw the whole scene");
  hr2di_regions *r = hr2di_alloc_zero(&scene->alloc, 1, sizeof *r);
  scene->regions = r;
  hr2d_status status = r ? HR2D_OK : HR2D_ENOMEM;
  if (r) r->around = hr2di_scene_gas_around(scene);
  for (size_t k = 0; k < scene->gases.count && !status; k++)
    status = add_gas(scene, r, k, watch);
  if (!status) status = add_crossings(scene, r, watch);
  return status;
}

void hr2di_regions_clear(hr2d_scene *scene) {
  if (scene->regions) {
    hr2di_alloc_free(&scene->alloc, scene->regions->border);
    hr2di_alloc_free(&scene->alloc, scene->regions->knot);
  }
  hr2di_alloc_free(&scene->alloc, scene->regions);
  scene->regions = NULL;
}

const hr2di_regions *hr2di_scene_regions(const hr2d_scene *scene) {
  return scene->regions && hr2di_scene_has_gas(scene) ? scene->regions : NULL;
}

/* Whether a ray to the right crosses a border. */
static int is_right_of(const hr2di_border *b, hr2d_point at) {
  const hr2d_point p = b->at.a, q = b->at.b;
  if ((p.y > at.y) == (q.y > at.y)) return 0;
  return at.x < p.x + (at.y - p.y) / (q.y - p.y) * (q.x - p.x);
}

size_t hr2di_regions_at(const hr2di_regions *r, hr2d_point at) {
  for (size_t k = r->borders; k > 0;) {
    const size_t gas = r->border[k - 1].gas;
    int inside = 0;
    for (; k > 0 && r->border[k - 1].gas == gas; k--)
      inside ^= is_right_of(&r->border[k - 1], at);
    if (inside) return gas;
  }
  return r->around;
}

/* Whether all corners are left of a line, or all right of it. */
static int is_apart(hr2d_segment line, const hr2d_point *corner, size_t corners, int *side) {
  const hr2d_point along = hr2di_point_unit(hr2di_point_minus(line.b, line.a));
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (size_t k = 0; k < corners; k++) {
    const double height = hr2di_point_cross(along, hr2di_point_minus(corner[k], line.a));
    least = fmin(least, height);
    most = fmax(most, height);
  }
  *side = least >= -TOUCHES ? 1 : most <= TOUCHES ? -1 : 0;
  return *side != 0;
}

/* Two convex sets are apart if a side of one of them parts them. */
int hr2di_border_meets_hull(hr2d_segment border, const hr2d_point corner[4]) {
  int side, other;
  if (is_apart(border, corner, 4, &side)) return 0;
  const hr2d_point end[] = {border.a, border.b};
  for (size_t k = 0; k < 4; k++)
    for (size_t m = 0; m < k; m++) {
      const hr2d_segment line = {corner[m], corner[k]};
      if (hr2di_point_same(line.a, line.b) || !is_apart(line, corner, 4, &side)) continue;
      if (is_apart(line, end, 2, &other) && other != side) return 0;
    }
  return 1;
}

int hr2di_regions_part(const hr2di_regions *r, hr2d_segment i, hr2d_segment j) {
  const hr2d_point corner[] = {i.a, i.b, j.a, j.b};
  for (size_t k = 0; k < r->borders; k++)
    if (hr2di_border_meets_hull(r->border[k].at, corner)) return 1;
  return 0;
}

hr2d_status hr2di_gas_path_init(hr2di_gas_path *path, const hr2di_regions *regions,
                                const hr2d_allocator *alloc) {
  const size_t pieces = (regions ? regions->borders : 0) + 1;
  path->pieces = 1;
  path->crossing = hr2di_alloc(alloc, pieces, sizeof *path->crossing);
  path->gas = hr2di_alloc(alloc, pieces, sizeof *path->gas);
  return path->crossing && path->gas ? HR2D_OK : HR2D_ENOMEM;
}

void hr2di_gas_path_clear(hr2di_gas_path *path, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, path->crossing);
  hr2di_alloc_free(alloc, path->gas);
  path->crossing = NULL;
  path->gas = NULL;
}

/* The part of the way at which a line crosses a border; NaN if it does not. */
static double crossing_at(const hr2di_border *border, hr2d_point from, hr2d_point way) {
  const hr2d_point a = hr2di_point_minus(border->at.a, from),
                   b = hr2di_point_minus(border->at.b, from);
  const double left = hr2di_point_cross(way, a), right = hr2di_point_cross(way, b);
  if ((left > 0) == (right > 0)) return NAN;
  const hr2d_point along = hr2di_point_minus(b, a);
  return hr2di_point_cross(a, along) / hr2di_point_cross(way, along);
}

static void insert(hr2di_gas_path *path, hr2di_crossing c) {
  size_t k = path->pieces++ - 1;
  for (; k > 0 && path->crossing[k - 1].at > c.at; k--)
    path->crossing[k] = path->crossing[k - 1];
  path->crossing[k] = c;
}

void hr2di_gas_path_trace(hr2di_gas_path *path, const hr2di_regions *r, hr2d_point from,
                          hr2d_point to) {
  const hr2d_point way = hr2di_point_minus(to, from);
  path->pieces = 1;
  for (size_t k = 0; k < r->borders; k++) {
    const double at = crossing_at(&r->border[k], from, way);
    if (at > 0 && at < 1) insert(path, (hr2di_crossing){at, k});
  }
  double before = 0;
  for (size_t k = 0; k < path->pieces; k++) {
    const double end = k + 1 < path->pieces ? path->crossing[k].at : 1;
    path->gas[k] =
        hr2di_regions_at(r, hr2di_point_at((hr2d_segment){from, to}, (before + end) / 2));
    before = end;
  }
}

hr2di_gas_walk hr2di_gas_walk_from(const hr2d_scene *scene, hr2d_point from, hr2d_point way) {
  return (hr2di_gas_walk){.regions = hr2di_scene_regions(scene),
                          .from = from,
                          .way = way,
                          .length = sqrt(hr2di_point_dot(way, way)),
                          .gas = HR2DI_NO_GAS};
}

/* The part of the way at which the next border is crossed; 1 if there is none. */
static double next_crossing(const hr2di_gas_walk *w) {
  double next = 1;
  for (size_t k = 0; k < w->regions->borders; k++) {
    const double at = crossing_at(&w->regions->border[k], w->from, w->way);
    if (at > w->at && at < next) next = at;
  }
  return next;
}

int hr2di_gas_walk_next(hr2di_gas_walk *w) {
  if (!w->regions) {
    const int first = w->at == 0;
    w->at = 1;
    w->gas = 0;
    w->piece = w->length;
    return first;
  }
  while (w->at < 1) {
    const double next = next_crossing(w), middle = (w->at + next) / 2;
    w->gas = hr2di_regions_at(
        w->regions, (hr2d_point){w->from.x + middle * w->way.x, w->from.y + middle * w->way.y});
    w->piece = (next - w->at) * w->length;
    w->at = next;
    if (w->gas != HR2DI_NO_GAS) return 1;
  }
  return 0;
}

/* The part of a segment, seen from x, behind which a knot is; NaN if it is behind none. */
static double part_behind(hr2d_point knot, hr2d_point x, hr2d_point start, hr2d_point along) {
  const hr2d_point ray = hr2di_point_minus(knot, x);
  const double t = -hr2di_point_cross(start, ray) / hr2di_point_cross(along, ray);
  const hr2d_point to = {start.x + t * along.x, start.y + t * along.y};
  const double before = hr2di_point_dot(to, ray);
  return before > 0 && hr2di_point_dot(ray, ray) < before ? t : NAN;
}

double hr2di_regions_cut(const hr2di_regions *r, hr2d_point x, hr2d_point start,
                         hr2d_point along, double after, double end) {
  const hr2d_point from = {x.x + start.x, x.y + start.y};
  double cut = end;
  for (size_t k = 0; k < r->knots; k++) {
    const double t = part_behind(r->knot[k], x, start, along);
    if (t > after && t < cut) cut = t;
  }
  for (size_t k = 0; k < r->borders; k++) {
    const double t = crossing_at(&r->border[k], from, along);
    if (t > after && t < cut) cut = t;
  }
  return cut;
}

/* How far along a ray the line of a border is. */
static double distance_to(const hr2di_border *border, hr2d_point from, hr2d_point ray) {
  const hr2d_point along = hr2di_point_minus(border->at.b, border->at.a);
  return hr2di_point_cross(hr2di_point_minus(border->at.a, from), along) /
         hr2di_point_cross(ray, along) * sqrt(hr2di_point_dot(ray, ray));
}

/* The distance has a pole where the ray is along the border: at a ratio of 2 it is three times
   as far from the middle of the panel as its ends are. */
int hr2di_regions_is_rough(const hr2di_regions *r, hr2d_point x, hr2d_point first,
                           hr2d_point last) {
  enum { MOST_RATIO = 2 };
  const hr2d_point middle = {(first.x + last.x) / 2, (first.y + last.y) / 2};
  for (size_t k = 0; k < r->borders; k++) {
    const double at = crossing_at(&r->border[k], x, middle);
    if (!(at > 0 && at < 1)) continue;
    const double one = distance_to(&r->border[k], x, first);
    const double other = distance_to(&r->border[k], x, last);
    if (!(one < MOST_RATIO * other && other < MOST_RATIO * one)) return 1;
  }
  return 0;
}
