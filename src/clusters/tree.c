/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the root down patches are parted, from the leaves up clusters are measured.

   A cluster is parted, where that can be done, into two groups of normals of which each is
   within a quarter turn; else into patches as long as half of it and shorter ones; else in
   the middle of its longer side. */
#include "clusters/tree.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/orient-sign.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* No cluster is deeper: the first two ways of parting leave these many levels to the last,
   which halves. */
enum { PARTED = 32, DEPTH = 80 };

#define COS_EIGHTH 0.70710678118654752

typedef struct item {
  double key;
  uint32_t patch;
} item;

typedef struct task {
  uint32_t cluster;
  unsigned depth;
} task;

typedef struct maker {
  hr2di_cluster_tree *tree;
  const hr2d_scene *scene;
  item *item;
  task task[DEPTH];
  size_t tasks;
  hr2di_watch *watch;
} maker;

static hr2d_segment segment(const maker *m, uint32_t patch) {
  return m->scene->patch[patch].scaled;
}

/* The unit vector from its start to its end. */
static hr2d_point direction(const maker *m, uint32_t patch) {
  const hr2d_segment s = segment(m, patch);
  const double length = m->scene->patch[patch].length;
  return (hr2d_point){(s.b.x - s.a.x) / length, (s.b.y - s.a.y) / length};
}

/* Along which wall a patch lies, and which way it points there. */
static uint32_t run_of(const maker *m, uint32_t patch) {
  const uint32_t wall = m->scene->walls.of_segment[patch];
  const hr2d_segment w = m->scene->walls.wall[wall].at, s = segment(m, patch);
  const int forward = w.a.x != w.b.x ? s.a.x < s.b.x : s.a.y < s.b.y;
  return 2 * wall + (uint32_t)forward;
}

static void widen(hr2di_extent *e, hr2d_point u, hr2d_point p) {
  const double along = hr2di_point_dot(u, p), across = hr2di_point_cross(u, p);
  e->u0 = fmin(e->u0, along);
  e->u1 = fmax(e->u1, along);
  e->v0 = fmin(e->v0, across);
  e->v1 = fmax(e->v1, across);
}

static const hr2di_extent nothing = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};

void hr2di_cluster_corners(const hr2di_cluster *c, const hr2di_extent *e,
                           hr2d_point corner[4]) {
  const double u[] = {e->u0, e->u1, e->u1, e->u0}, v[] = {e->v0, e->v0, e->v1, e->v1};
  for (int k = 0; k < 4; k++) {
    corner[k].x = u[k] * c->u.x - v[k] * c->u.y;
    corner[k].y = u[k] * c->u.y + v[k] * c->u.x;
  }
}

hr2di_extent hr2di_cluster_extent_of(const hr2di_cluster *c, const hr2di_cluster *other,
                                     const hr2di_extent *extent) {
  hr2d_point corner[4];
  hr2di_extent e = nothing;
  hr2di_cluster_corners(other, extent, corner);
  for (int k = 0; k < 4; k++) widen(&e, c->u, corner[k]);
  return e;
}

/* A cone of directions about `axis`; 0 if it is not within a quarter turn to either side. */
static int find_cone(const maker *m, const item *items, size_t count, hr2d_point *axis,
                     double *cosine, double *sine) {
  hr2d_point sum = {0, 0};
  for (size_t k = 0; k < count; k++) {
    const hr2d_point d = direction(m, items[k].patch);
    sum.x += d.x;
    sum.y += d.y;
  }
  const double length = hypot(sum.x, sum.y);
  *cosine = -1;
  *sine = 1;
  if (!(length > 0)) return 0;
  *axis = (hr2d_point){sum.x / length, sum.y / length};
  double min = 1, max = 0;
  for (size_t k = 0; k < count; k++) {
    const hr2d_point d = direction(m, items[k].patch);
    min = fmin(min, hr2di_point_dot(*axis, d));
    max = fmax(max, fabs(hr2di_point_cross(*axis, d)));
  }
  *cosine = min;
  if (min > 0) *sine = max;
  return min > 0;
}

/* Sets what follows from the patches of a cluster. */
static void measure(const maker *m, hr2di_cluster *c, const item *items) {
  const uint32_t count = hr2di_cluster_size(c);
  c->x0 = c->y0 = HUGE_VAL;
  c->x1 = c->y1 = -HUGE_VAL;
  c->tight = c->nested = nothing;
  c->run = run_of(m, items[0].patch);
  c->span = segment(m, items[0].patch);
  if (!find_cone(m, items, count, &c->u, &c->cosine, &c->sine)) c->u = (hr2d_point){1, 0};
  for (uint32_t k = 0; k < count; k++) {
    const hr2d_segment s = segment(m, items[k].patch);
    widen(&c->tight, c->u, s.a);
    widen(&c->tight, c->u, s.b);
    c->x0 = fmin(c->x0, fmin(s.a.x, s.b.x));
    c->x1 = fmax(c->x1, fmax(s.a.x, s.b.x));
    c->y0 = fmin(c->y0, fmin(s.a.y, s.b.y));
    c->y1 = fmax(c->y1, fmax(s.a.y, s.b.y));
    if (run_of(m, items[k].patch) != c->run) c->run = HR2DI_NO_RUN;
    if (hr2di_point_dot(c->u, s.a) < hr2di_point_dot(c->u, c->span.a)) c->span.a = s.a;
    if (hr2di_point_dot(c->u, s.b) > hr2di_point_dot(c->u, c->span.b)) c->span.b = s.b;
  }
}

static int by_key(const void *left, const void *right) {
  const item *l = left, *r = right;
  if (l->key != r->key) return l->key < r->key ? -1 : 1;
  return (l->patch > r->patch) - (l->patch < r->patch);
}

/* Sorts items with key 0 before those with key 1; how many have key 0.  In any order once the
   watch has stopped. */
static size_t part(const maker *m, item *items, size_t count) {
  size_t low = 0;
  for (size_t k = 0; k < count; k++) low += items[k].key == 0;
  if (low > 0 && low < count) hr2di_sort(items, count, sizeof *items, by_key, m->watch);
  return low;
}

/* Directions within a sixth of a turn of the first one's, and the others; 0 unless both
   groups then lie within an eighth of a turn about their axes. */
static size_t part_by_normal(const maker *m, item *items, size_t count) {
  const hr2d_point first = direction(m, items[0].patch);
  hr2d_point axis;
  double cosine, sine;
  for (size_t k = 0; k < count; k++)
    items[k].key = hr2di_point_dot(first, direction(m, items[k].patch)) < 0.5;
  const size_t low = part(m, items, count);
  if (low == 0 || low == count) return 0;
  find_cone(m, items, low, &axis, &cosine, &sine);
  if (cosine < COS_EIGHTH) return 0;
  find_cone(m, items + low, count - low, &axis, &cosine, &sine);
  return cosine < COS_EIGHTH ? 0 : low;
}

static size_t part_by_length(const maker *m, const hr2di_cluster *c, item *items,
                             size_t count) {
  const double size = hypot(c->x1 - c->x0, c->y1 - c->y0);
  for (size_t k = 0; k < count; k++)
    items[k].key = m->scene->patch[items[k].patch].length < size / 2;
  const size_t low = part(m, items, count);
  return low == count ? 0 : low;
}

static size_t part_by_place(const maker *m, const hr2di_cluster *c, item *items, size_t count) {
  const int along = c->tight.u1 - c->tight.u0 >= c->tight.v1 - c->tight.v0;
  for (size_t k = 0; k < count; k++) {
    const hr2d_segment s = segment(m, items[k].patch);
    const hr2d_point twice = {s.a.x + s.b.x, s.a.y + s.b.y};
    items[k].key = along ? hr2di_point_dot(c->u, twice) : hr2di_point_cross(c->u, twice);
  }
  hr2di_sort(items, count, sizeof *items, by_key, m->watch);
  return count / 2;
}

static hr2d_status divide(maker *m, task t) {
  hr2di_cluster *c = &m->tree->cluster[t.cluster];
  item *items = m->item + c->first;
  const uint32_t count = hr2di_cluster_size(c);
  const hr2d_status status = hr2di_watch_work(m->watch, 2 + count);
  if (status) return status;
  measure(m, c, items);
  if (count == 1) return HR2D_OK;
  size_t low = 0;
  if (t.depth < PARTED && c->cosine < COS_EIGHTH) low = part_by_normal(m, items, count);
  if (t.depth < PARTED && low == 0) low = part_by_length(m, c, items, count);
  if (low == 0) low = part_by_place(m, c, items, count);
  c->child = (uint32_t)m->tree->clusters;
  m->tree->clusters += 2;
  const uint32_t middle = c->first + (uint32_t)low;
  m->tree->cluster[c->child] = (hr2di_cluster){.first = c->first, .last = middle};
  m->tree->cluster[c->child + 1] = (hr2di_cluster){.first = middle, .last = c->last};
  m->task[m->tasks++] = (task){c->child + 1, t.depth + 1};
  m->task[m->tasks++] = (task){c->child, t.depth + 1};
  return hr2di_watch_status(m->watch);
}

static void include(hr2di_extent *e, hr2di_extent more) {
  e->u0 = fmin(e->u0, more.u0);
  e->u1 = fmax(e->u1, more.u1);
  e->v0 = fmin(e->v0, more.v0);
  e->v1 = fmax(e->v1, more.v1);
}

static void nest(hr2di_cluster_tree *tree) {
  for (size_t k = tree->clusters; k-- > 0;) {
    hr2di_cluster *c = &tree->cluster[k];
    c->nested = c->tight;
    if (!c->child) continue;
    for (const hr2di_cluster *child = tree->cluster + c->child, *end = child + 2; child < end;
         child++)
      include(&c->nested, hr2di_cluster_extent_of(c, child, &child->nested));
  }
}

hr2d_status hr2di_cluster_tree_init(hr2di_cluster_tree *tree, const hr2d_scene *scene,
                                    const hr2d_allocator *alloc, hr2di_watch *watch) {
  const size_t n = scene->patches;
  *tree = (hr2di_cluster_tree){.alloc = *alloc};
  maker m = {.tree = tree, .scene = scene, .watch = watch};
  tree->cluster = hr2di_alloc(alloc, 2 * n, sizeof *tree->cluster);
  tree->patch = hr2di_alloc(alloc, n, sizeof *tree->patch);
  m.item = hr2di_alloc(alloc, n, sizeof *m.item);
  hr2d_status status = tree->cluster && tree->patch && m.item ? HR2D_OK : HR2D_ENOMEM;
  if (!status) {
    for (uint32_t k = 0; k < n; k++) m.item[k] = (item){0, k};
    tree->cluster[tree->clusters++] = (hr2di_cluster){.last = (uint32_t)n};
    m.task[m.tasks++] = (task){0, 0};
    while (m.tasks > 0 && !status) status = divide(&m, m.task[--m.tasks]);
    if (!status) status = hr2di_watch_work(watch, n);
    if (!status) nest(tree);
    for (uint32_t k = 0; k < n; k++) tree->patch[k] = m.item[k].patch;
  }
  hr2di_alloc_free(alloc, m.item);
  return status;
}

void hr2di_cluster_tree_clear(hr2di_cluster_tree *tree) {
  hr2di_alloc_free(&tree->alloc, tree->cluster);
  hr2di_alloc_free(&tree->alloc, tree->patch);
  *tree = (hr2di_cluster_tree){.alloc = tree->alloc};
}
