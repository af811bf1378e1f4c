/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Segments to walls: vertices, runs on one line, joints. */
#include "occlusion/walls.h"

#include "base/alloc.h"
#include "base/sort.h"
#include "base/union-find.h"
#include "geometry/orient-sign.h"
#include "geometry/predicates.h"
#include "occlusion/wall-bodies.h"
#include "occlusion/wall-tree.h"

/* Runs are looked for at vertices where at most so many segments meet; where more do,
   they stay as they are, which costs nothing but time. */
enum { MOST_MEETING = 16 };

/* An end of a segment. */
typedef struct tip {
  hr2d_point point;
  uint32_t segment;
  uint32_t which; /* 0 or 1 */
} tip;

/* Unions of segments; the root of each has the outermost ends found so far. */
typedef struct runs {
  const hr2d_segment *segment;
  size_t count;
  uint32_t *parent;
  hr2d_segment *span; /* its lesser end first */
  tip *tip;           /* 2·count, sorted by point */
  uint32_t *vertex;   /* of each end of each segment: 2·segment + which */
} runs;

static int less(hr2d_point p, hr2d_point q) {
  return p.x != q.x ? p.x < q.x : p.y < q.y;
}

static int by_point(const void *left, const void *right) {
  const tip *l = left, *r = right;
  if (less(l->point, r->point)) return -1;
  if (less(r->point, l->point)) return 1;
  const uint32_t p = 2 * l->segment + l->which, q = 2 * r->segment + r->which;
  return (p > q) - (p < q);
}

static void unite(runs *r, uint32_t i, uint32_t j) {
  j = hr2di_union_join(r->parent, i, j);
  i = r->parent[j];
  if (i == j) return;
  if (less(r->span[j].a, r->span[i].a)) r->span[i].a = r->span[j].a;
  if (less(r->span[i].b, r->span[j].b)) r->span[i].b = r->span[j].b;
}

/* Both ends of t lie on the line of s; exact, and so transitive.  A point has no line. */
static int on_line(hr2d_segment s, hr2d_segment t) {
  return !hr2di_point_same(s.a, s.b) && !hr2di_point_same(t.a, t.b) &&
         hr2di_orient_sign(s.a, s.b, t.a) == 0 && hr2di_orient_sign(s.a, s.b, t.b) == 0;
}

/* Unites segments on one line that meet in a vertex. */
static void unite_at(runs *r, const tip *first, size_t count) {
  if (count > MOST_MEETING) return;
  for (size_t k = 0; k < count; k++)
    for (size_t m = k + 1; m < count; m++) {
      const uint32_t i = first[k].segment, j = first[m].segment;
      if (on_line(r->segment[i], r->segment[j])) unite(r, i, j);
    }
}

/* Numbers the vertices; *count is their number. */
static hr2d_status find_runs(runs *r, size_t *count, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < r->count && !status; k++) {
    const hr2d_segment s = r->segment[k];
    status = hr2di_watch_work(watch, 1);
    r->parent[k] = (uint32_t)k;
    r->span[k] = less(s.a, s.b) ? s : (hr2d_segment){s.b, s.a};
    r->tip[2 * k] = (tip){s.a, (uint32_t)k, 0};
    r->tip[2 * k + 1] = (tip){s.b, (uint32_t)k, 1};
  }
  if (!status) status = hr2di_sort(r->tip, 2 * r->count, sizeof *r->tip, by_point, watch);
  size_t vertices = 0;
  for (size_t first = 0, last; first < 2 * r->count && !status; first = last, vertices++) {
    status = hr2di_watch_work(watch, 1);
    for (last = first;
         last < 2 * r->count && hr2di_point_same(r->tip[last].point, r->tip[first].point);
         last++)
      r->vertex[2 * r->tip[last].segment + r->tip[last].which] = (uint32_t)vertices;
    if (last - first <= MOST_MEETING)
      status = hr2di_watch_work(watch, (last - first) * (last - first) / 2);
    unite_at(r, r->tip + first, last - first);
  }
  *count = vertices;
  return status;
}

/* One wall per run. */
static hr2d_status make_walls(hr2di_walls *w, runs *r, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (uint32_t k = 0; k < r->count && !status; k++) {
    status = hr2di_watch_work(watch, 1);
    if (hr2di_union_find(r->parent, k) != k) continue;
    w->of_segment[k] = (uint32_t)w->walls;
    w->wall[w->walls++].at = r->span[k];
  }
  for (uint32_t k = 0; k < r->count && !status; k++) {
    status = hr2di_watch_work(watch, 1);
    const uint32_t wall = w->of_segment[hr2di_union_find(r->parent, k)];
    const hr2d_point end[] = {r->segment[k].a, r->segment[k].b};
    w->of_segment[k] = wall;
    for (int e = 0; e < 2; e++) {
      const uint32_t vertex = r->vertex[2 * k + (uint32_t)e];
      /* Both ends of a segment that is a point are one vertex. */
      if (hr2di_point_same(end[e], w->wall[wall].at.a)) w->wall[wall].vertex[0] = vertex;
      if (hr2di_point_same(end[e], w->wall[wall].at.b)) w->wall[wall].vertex[1] = vertex;
    }
  }
  return status;
}

/* p lies on the inside of a wall, but for rounding. */
static int touches(hr2d_segment w, hr2d_point p) {
  const double dx = w.b.x - w.a.x, dy = w.b.y - w.a.y, length = hypot(dx, dy);
  const double along = (p.x - w.a.x) * (dx / length) + (p.y - w.a.y) * (dy / length);
  return fabs(hr2di_orient(w.a, w.b, p)) <= HR2DI_TOUCH * length && along > 0 &&
         along < length && !hr2di_point_same(p, w.a) && !hr2di_point_same(p, w.b);
}

uint32_t hr2di_walls_host(const hr2di_walls *w, hr2d_point p, uint32_t but) {
  uint32_t stack[HR2DI_BOX_DEPTH], count = 0;
  stack[count++] = 0;
  while (count > 0) {
    const hr2di_box *box = &w->box[stack[--count]];
    if (p.x < box->x0 - HR2DI_TOUCH || p.x > box->x1 + HR2DI_TOUCH ||
        p.y < box->y0 - HR2DI_TOUCH || p.y > box->y1 + HR2DI_TOUCH)
      continue;
    if (box->wall == HR2DI_NO_WALL) {
      stack[count++] = box->below;
      stack[count++] = box->below + 1;
    } else if (box->wall != but && touches(w->wall[box->wall].at, p)) {
      return box->wall;
    }
  }
  return HR2DI_NO_WALL;
}

static hr2d_status reserve(hr2di_walls *w, runs *r, size_t count) {
  const hr2d_allocator *alloc = &w->alloc;
  if (count > UINT32_MAX / 4) return HR2D_ENOMEM;
  w->wall = hr2di_alloc(alloc, count, sizeof *w->wall);
  w->of_segment = hr2di_alloc(alloc, count, sizeof *w->of_segment);
  w->box = hr2di_alloc(alloc, 2 * count, sizeof *w->box);
  w->body = hr2di_alloc(alloc, count, sizeof *w->body);
  w->body_of = hr2di_alloc(alloc, count, sizeof *w->body_of);
  r->parent = hr2di_alloc(alloc, count, sizeof *r->parent);
  r->span = hr2di_alloc(alloc, count, sizeof *r->span);
  r->tip = hr2di_alloc(alloc, 2 * count, sizeof *r->tip);
  r->vertex = hr2di_alloc(alloc, 2 * count, sizeof *r->vertex);
  const int room = w->wall && w->of_segment && w->box && w->body && w->body_of && r->parent &&
                   r->span && r->tip && r->vertex;
  return room ? HR2D_OK : HR2D_ENOMEM;
}

hr2d_status hr2di_walls_init(hr2di_walls *walls, const hr2d_allocator *alloc,
                             const hr2d_segment *segment, size_t count, hr2di_watch *watch) {
  *walls = (hr2di_walls){.alloc = *alloc};
  runs r = {.segment = segment, .count = count};
  hr2d_status status = reserve(walls, &r, count);
  if (!status) status = find_runs(&r, &walls->vertices, watch);
  if (!status) status = make_walls(walls, &r, watch);
  if (!status) status = hr2di_wall_bodies_init(walls, watch);
  if (!status) status = hr2di_wall_tree_init(walls, watch);
  hr2di_alloc_free(alloc, r.parent);
  hr2di_alloc_free(alloc, r.span);
  hr2di_alloc_free(alloc, r.tip);
  hr2di_alloc_free(alloc, r.vertex);
  return status;
}

void hr2di_walls_clear(hr2di_walls *walls) {
  hr2di_alloc_free(&walls->alloc, walls->wall);
  hr2di_alloc_free(&walls->alloc, walls->of_segment);
  hr2di_alloc_free(&walls->alloc, walls->box);
  hr2di_alloc_free(&walls->alloc, walls->body);
  hr2di_alloc_free(&walls->alloc, walls->body_of);
}
