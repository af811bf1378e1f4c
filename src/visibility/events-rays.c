/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rays through vertices, by walks in the tree of boxes.  Signs are exact; the distances that
   order the walls which a ray meets are rounded. */
#include <math.h>

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "geometry/predicates.h"
#include "occlusion/wall-tree.h"
#include "scene/scene-impl.h"
#include "visibility/events-impl.h"

/* Coordinates lie in [-2,2]: what is so near to the inside of a wall lies on it, and
   rounding in the tests of boxes is below that. */
#define TOUCH 0x1p-50
#define SLACK 0x1p-46

/* So near to its end, as a fraction, a wall is not told from the one that it ends on. */
#define FOOT 1e-12

/* Boxes between two declarations of work. */
enum { TURNS = 16 };

static void index_ends(hr2di_vertices *t) {
  const hr2di_walls *w = t->walls;
  for (size_t k = 0; k < w->walls; k++) {
    t->point[w->wall[k].vertex[0]] = w->wall[k].at.a;
    t->point[w->wall[k].vertex[1]] = w->wall[k].at.b;
    for (int e = 0; e < 2; e++) t->first[w->wall[k].vertex[e]]++;
  }
  for (size_t v = 1; v <= w->vertices; v++) t->first[v] += t->first[v - 1];
  for (size_t k = w->walls; k-- > 0;)
    for (int e = 0; e < 2; e++) t->wall[--t->first[w->wall[k].vertex[e]]] = (uint32_t)k;
}

static void index_runs(hr2di_vertices *t) {
  for (size_t k = 0; k < 2 * t->walls->walls; k++) t->run[k] = HR2DI_EVENTS_NO_RUN;
  for (size_t r = 0; r < t->scene->runs.runs; r++) {
    const uint32_t patch = t->scene->runs.patch[t->scene->runs.run[r].first];
    const uint32_t wall = t->walls->of_segment[patch];
    const hr2d_segment s = t->scene->patch[patch].scaled, w = t->walls->wall[wall].at;
    const double along = (s.b.x - s.a.x) * (w.b.x - w.a.x) + (s.b.y - s.a.y) * (w.b.y - w.a.y);
    t->run[2 * wall + (along > 0)] = (uint32_t)r;
  }
}

hr2d_status hr2di_vertices_init(hr2di_vertices *t, const hr2d_scene *scene,
                                const hr2d_allocator *alloc, hr2di_watch *watch) {
  const hr2di_walls *walls = &scene->walls;
  *t = (hr2di_vertices){.alloc = *alloc, .scene = scene, .walls = walls, .watch = watch};
  t->blocker = HR2DI_NO_WALL;
  t->point = hr2di_alloc(alloc, walls->vertices, sizeof *t->point);
  t->first = hr2di_alloc_zero(alloc, walls->vertices + 1, sizeof *t->first);
  t->wall = hr2di_alloc(alloc, 2 * walls->walls, sizeof *t->wall);
  t->run = hr2di_alloc(alloc, 2 * walls->walls, sizeof *t->run);
  if (!t->point || !t->first || !t->wall || !t->run) return HR2D_ENOMEM;
  index_ends(t);
  index_runs(t);
  return hr2di_watch_work(watch, walls->walls);
}

void hr2di_vertices_clear(hr2di_vertices *t) {
  hr2di_alloc_free(&t->alloc, t->point);
  hr2di_alloc_free(&t->alloc, t->first);
  hr2di_alloc_free(&t->alloc, t->wall);
  hr2di_alloc_free(&t->alloc, t->run);
}

/* From v through u. */
typedef struct ray {
  const hr2di_origin *v;
  hr2d_point from, at;
  uint32_t u;
  double dx, dy;
} ray;

/* Distance beyond u, up to a factor. */
static double beyond(const ray *r, double x, double y) {
  return r->dx * (x - r->at.x) + r->dy * (y - r->at.y);
}

static int line_meets_box(const ray *r, const hr2di_box *box) {
  const double x = 0.5 * (box->x0 + box->x1) - r->at.x, y = 0.5 * (box->y0 + box->y1) - r->at.y;
  const double half_x = 0.5 * (box->x1 - box->x0), half_y = 0.5 * (box->y1 - box->y0);
  return fabs(r->dx * y - r->dy * x) <= fabs(r->dx) * half_y + fabs(r->dy) * half_x + SLACK;
}

static int ends_at(const hr2di_wall *w, uint32_t vertex) {
  return w->vertex[0] == vertex || w->vertex[1] == vertex;
}

/* Whether light passes u on one side, as far as the walls that end there go; none if one
   of them runs along the ray. */
static int grazes(const hr2di_vertices *t, const ray *r) {
  int left = 0, right = 0;
  for (uint32_t k = t->first[r->u]; k < t->first[r->u + 1]; k++) {
    if (hr2di_watch_work(t->watch, 1)) return 0;
    const hr2di_wall *w = &t->walls->wall[t->wall[k]];
    const hr2d_point other = w->vertex[0] == r->u ? w->at.b : w->at.a;
    const int side = hr2di_orient_sign(r->from, r->at, other);
    if (side > 0) left = 1;
    if (side < 0) right = 1;
    if ((left && right) || (side == 0 && beyond(r, other.x, other.y) > 0)) return 0;
  }
  return 1;
}

static int is_foot(const hr2di_vertices *t, uint32_t vertex) {
  return t->walls->host[vertex] != HR2DI_NO_WALL;
}

/* An end of a wall that lies on the line: strictly between v and u, and no foot. */
static int end_blocks(const hr2di_vertices *t, const ray *r, const hr2di_wall *w, int end) {
  const hr2d_point p = end ? w->at.b : w->at.a;
  return !is_foot(t, w->vertex[end]) && beyond(r, p.x, p.y) < 0 &&
         r->dx * (p.x - r->from.x) + r->dy * (p.y - r->from.y) > 0;
}

static int touches(hr2d_segment w, hr2d_point p) {
  const double dx = w.b.x - w.a.x, dy = w.b.y - w.a.y, square = dx * dx + dy * dy;
  const double along = (p.x - w.a.x) * dx + (p.y - w.a.y) * dy;
  const double across = hr2di_orient(w.a, w.b, p);
  return across * across <= TOUCH * TOUCH * square && along > 0 && along < square;
}

/* Whether a wall meets the open segment from v to u. */
static int wall_blocks(const hr2di_vertices *t, const ray *r, uint32_t wall) {
  const hr2di_wall *w = &t->walls->wall[wall];
  if (wall == r->v->host || ends_at(w, r->u) ||
      (r->v->vertex != HR2DI_NO_VERTEX && ends_at(w, r->v->vertex)))
    return 0;
  const int a = hr2di_orient_sign(r->from, r->at, w->at.a),
            b = hr2di_orient_sign(r->from, r->at, w->at.b);
  if (a * b > 0) return 0;
  if (a == 0 || b == 0)
    return (a == 0 && end_blocks(t, r, w, 0)) || (b == 0 && end_blocks(t, r, w, 1));
  return hr2di_orient_sign(w->at.a, w->at.b, r->from) *
                 hr2di_orient_sign(w->at.a, w->at.b, r->at) <
             0 &&
         !(r->v->host != HR2DI_NO_WALL && touches(w->at, r->from));
}

static int is_blocked(hr2di_vertices *t, const ray *r) {
  if (t->blocker != HR2DI_NO_WALL && wall_blocks(t, r, t->blocker)) return 1;
  const double x0 = fmin(r->from.x, r->at.x), x1 = fmax(r->from.x, r->at.x);
  const double y0 = fmin(r->from.y, r->at.y), y1 = fmax(r->from.y, r->at.y);
  uint32_t stack[HR2DI_BOX_DEPTH], count = 0;
  stack[count++] = 0;
  for (size_t turn = 1; count > 0; turn++) {
    const hr2di_box *box = &t->walls->box[stack[--count]];
    if (turn % TURNS == 0 && hr2di_watch_work(t->watch, TURNS / 4)) return 1;
    if (box->x0 > x1 || box->x1 < x0 || box->y0 > y1 || box->y1 < y0 || !line_meets_box(r, box))
      continue;
    if (box->wall == HR2DI_NO_WALL) {
      stack[count++] = box->below;
      stack[count++] = box->below + 1;
    } else if (wall_blocks(t, r, box->wall)) {
      t->blocker = box->wall;
      return 1;
    }
  }
  return 0;
}

/* What a ray meets first beyond u. */
typedef struct hit {
  double distance;
  uint32_t wall;     /* HR2DI_NO_WALL for a vertex, or nothing */
  uint32_t near_end; /* the vertex that the wall is met at, within rounding */
} hit;

static void meet_end(const hr2di_vertices *t, const ray *r, const hr2di_wall *w, int end,
                     hit *h) {
  const hr2d_point p = end ? w->at.b : w->at.a;
  const double distance = beyond(r, p.x, p.y);
  if (is_foot(t, w->vertex[end]) || distance <= 0 || distance > h->distance) return;
  *h = (hit){distance, HR2DI_NO_WALL, HR2DI_NO_VERTEX};
}

static void meet_wall(const hr2di_vertices *t, const ray *r, uint32_t wall, hit *h) {
  const hr2di_wall *w = &t->walls->wall[wall];
  const hr2d_point a = w->at.a, b = w->at.b;
  if (ends_at(w, r->u)) return;
  const int at_a = hr2di_orient_sign(r->from, r->at, a),
            at_b = hr2di_orient_sign(r->from, r->at, b);
  if (at_a * at_b > 0) return;
  if (at_a == 0) meet_end(t, r, w, 0, h);
  if (at_b == 0) meet_end(t, r, w, 1, h);
  /* With a on the left, u lies to the right of a→b if the ray is still to meet it. */
  if (at_a * at_b == 0 || hr2di_orient_sign(a, b, r->at) != -at_a) return;
  const double from_a = fabs(r->dx * (a.y - r->at.y) - r->dy * (a.x - r->at.x));
  const double from_b = fabs(r->dx * (b.y - r->at.y) - r->dy * (b.x - r->at.x));
  const double f = from_a + from_b > 0 ? from_a / (from_a + from_b) : 0.5;
  const double distance = beyond(r, a.x + f * (b.x - a.x), a.y + f * (b.y - a.y));
  if (distance >= h->distance) return;
  *h = (hit){distance, wall, HR2DI_NO_VERTEX};
  if (f < FOOT) h->near_end = w->vertex[0];
  if (f > 1 - FOOT) h->near_end = w->vertex[1];
}

/* Whether a box is beyond u, and nearer than what was met. */
static int is_ahead(const ray *r, const hr2di_box *box, double limit) {
  const double x = 0.5 * (box->x0 + box->x1), y = 0.5 * (box->y0 + box->y1);
  const double reach =
      0.5 * (fabs(r->dx) * (box->x1 - box->x0) + fabs(r->dy) * (box->y1 - box->y0)) + SLACK;
  const double distance = beyond(r, x, y);
  return distance + reach >= 0 && distance - reach <= limit;
}

static double box_distance(const ray *r, const hr2di_box *box) {
  return beyond(r, 0.5 * (box->x0 + box->x1), 0.5 * (box->y0 + box->y1));
}

static hit first_hit(const hr2di_vertices *t, const ray *r) {
  hit h = {HUGE_VAL, HR2DI_NO_WALL, HR2DI_NO_VERTEX};
  const hr2di_box *boxes = t->walls->box;
  uint32_t stack[HR2DI_BOX_DEPTH], count = 0;
  stack[count++] = 0;
  for (size_t turn = 1; count > 0; turn++) {
    const hr2di_box *box = &boxes[stack[--count]];
    if (turn % TURNS == 0 && hr2di_watch_work(t->watch, TURNS / 4)) break;
    if (!is_ahead(r, box, h.distance) || !line_meets_box(r, box)) continue;
    if (box->wall != HR2DI_NO_WALL) {
      meet_wall(t, r, box->wall, &h);
      continue;
    }
    const uint32_t second =
        box_distance(r, &boxes[box->below]) > box_distance(r, &boxes[box->below + 1]);
    stack[count++] = box->below + 1 - second;
    stack[count++] = box->below + second;
  }
  return h;
}

uint32_t hr2di_events_next_host(const hr2di_vertices *t, hr2d_point p, uint32_t *stack,
                                uint32_t *count) {
  for (size_t turn = 1; *count > 0; turn++) {
    const hr2di_box *box = &t->walls->box[stack[--*count]];
    if (turn % TURNS == 0 && hr2di_watch_work(t->watch, TURNS / 4)) break;
    if (p.x < box->x0 - TOUCH || p.x > box->x1 + TOUCH || p.y < box->y0 - TOUCH ||
        p.y > box->y1 + TOUCH)
      continue;
    if (box->wall == HR2DI_NO_WALL) {
      stack[(*count)++] = box->below;
      stack[(*count)++] = box->below + 1;
    } else if (touches(t->walls->wall[box->wall].at, p)) {
      return box->wall;
    }
  }
  return HR2DI_NO_WALL;
}

int hr2di_events_patch_across(const hr2di_vertices *t, uint32_t wall, unsigned side,
                              hr2d_point from, hr2d_point to, uint32_t *patch) {
  const uint32_t number = t->run[2 * wall + (side == HR2DI_EVENTS_LEFT)];
  if (number == HR2DI_EVENTS_NO_RUN) return 0;
  uint32_t low = t->scene->runs.run[number].first, high = t->scene->runs.run[number].last;
  const hr2di_patch *patches = t->scene->patch;
  const int start = hr2di_orient_sign(from, to, patches[t->scene->runs.patch[low]].scaled.a);
  /* The last patch that starts before the line. */
  while (high - low > 1) {
    const uint32_t middle = low + (high - low) / 2;
    if (hr2di_orient_sign(from, to, patches[t->scene->runs.patch[middle]].scaled.a) == start)
      low = middle;
    else
      high = middle;
  }
  *patch = t->scene->runs.patch[low];
  return start != 0 && hr2di_orient_sign(from, to, patches[*patch].scaled.b) == -start;
}

/* Whether there is something to see of v from u's side of its host.  Along the host it is
   the host's own horizon, which another wall that crosses it at v hides from its far end. */
static int shows(const hr2di_vertices *t, const hr2di_origin *v, uint32_t u) {
  if (v->host == HR2DI_NO_WALL) return 1;
  const hr2di_wall *w = &t->walls->wall[v->host];
  const int side = hr2di_orient_sign(w->at.a, w->at.b, t->point[u]);
  if (side == 0)
    return v->vertex == HR2DI_NO_VERTEX &&
           v->sides == (HR2DI_EVENTS_LEFT | HR2DI_EVENTS_RIGHT) && ends_at(w, u);
  return (v->sides & (side > 0 ? HR2DI_EVENTS_LEFT : HR2DI_EVENTS_RIGHT)) != 0;
}

int hr2di_origin_reaches(hr2di_vertices *t, const hr2di_origin *v, uint32_t u,
                         uint32_t *patch) {
  const hr2d_point at = t->point[u];
  const ray r = {v, v->at, at, u, at.x - v->at.x, at.y - v->at.y};
  if (!shows(t, v, u)) return 0;
  if (!grazes(t, &r) || is_blocked(t, &r)) return 0;
  const hit h = first_hit(t, &r);
  uint32_t wall = h.wall;
  if (wall == HR2DI_NO_WALL) return 0;
  if (h.near_end != HR2DI_NO_VERTEX && is_foot(t, h.near_end))
    wall = t->walls->host[h.near_end];
  const hr2d_segment w = t->walls->wall[wall].at;
  const int side = hr2di_orient_sign(w.a, w.b, at);
  if (side == 0) return 0;
  return hr2di_events_patch_across(t, wall, side > 0 ? HR2DI_EVENTS_LEFT : HR2DI_EVENTS_RIGHT,
                                   v->at, at, patch);
}
