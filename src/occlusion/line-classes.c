/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Classes of lines.

   A line from i to j that meets no barrier leaves each on its right or on its left, and
   joined ones on the same side.  So the lines fall into classes, each with a corridor
   between the hulls of what is on its right and on its left; the classes are disjoint and
   their measures add up.  An island is tried on either side of every class that is left
   of the earlier ones, and whether lines remain is decided exactly: no more classes are
   looked at than there are. */
#include "occlusion/line-classes.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "base/union-find.h"
#include "geometry/orient-sign.h"

enum { TO_RIGHT = 1, TO_LEFT = 2, NEITHER = 3 };

/* Walls between two declarations of work. */
enum { SOME = 8 };

/* A class put off: its chains lie on the stack, one behind the other. */
typedef struct hr2di_put_off {
  size_t right, left; /* counts of points */
  size_t island;      /* the next to be tried */
} hr2di_put_off;

void hr2di_classes_init(hr2di_classes *c, const hr2di_walls *walls, const hr2d_allocator *alloc,
                        hr2di_watch *watch) {
  *c = (hr2di_classes){.walls = walls, .alloc = *alloc, .watch = watch};
  c->right.watch = c->left.watch = c->wider_right.watch = c->wider_left.watch = watch;
  c->right.hand = HR2DI_RIGHT;
  c->left.hand = HR2DI_LEFT;
  c->wider_right.hand = HR2DI_RIGHT;
  c->wider_left.hand = HR2DI_LEFT;
}

void hr2di_classes_clear(hr2di_classes *c) {
  void *const held[] = {c->barrier,
                        c->parent,
                        c->island,
                        c->point,
                        c->joint,
                        c->joint_of,
                        c->right.point,
                        c->left.point,
                        c->wider_right.point,
                        c->wider_left.point,
                        c->stack,
                        c->put_off};
  for (size_t k = 0; k < sizeof held / sizeof *held; k++) hr2di_alloc_free(&c->alloc, held[k]);
}

/* The hand of both is that of the root. */
static void join(hr2di_classes *c, uint32_t i, uint32_t j) {
  const uint32_t other = hr2di_union_join(c->parent, i, j);
  c->barrier[c->parent[other]].hand |= c->barrier[other].hand;
}

/* The barrier meets the side p→q of the shaft: it cuts it, or ends where it begins or
   ends.  Not every touch is noticed; what is not is found out with the class. */
static int meets_side(const hr2di_pair_lines *f, const hr2di_obstacle *o,
                      hr2di_incident_point p, hr2di_incident_point q) {
  const hr2di_incident_point a = o->end[0], b = o->end[1];
  if (hr2di_incident_same(f, a, p) || hr2di_incident_same(f, b, p) ||
      hr2di_incident_same(f, a, q) || hr2di_incident_same(f, b, q))
    return 1;
  if (hr2di_incident_same(f, p, q)) return 0;
  return hr2di_orient_incident(f, p, q, a) * hr2di_orient_incident(f, p, q, b) < 0 &&
         hr2di_orient_incident(f, a, b, p) * hr2di_orient_incident(f, a, b, q) <= 0;
}

static int between_sides(const hr2di_shaft *s, hr2di_incident_point p) {
  return hr2di_orient_incident(&s->frame, s->b, s->c, p) >= 0 &&
         hr2di_orient_incident(&s->frame, s->d, s->a, p) >= 0;
}

/* Joins barrier k with an earlier one of the same vertex, and with the one on which the
   vertex lies.  What other shafts left in `joint` and `joint_of` is known by its not
   fitting. */
static void join_at(hr2di_classes *c, uint32_t k, uint32_t vertex) {
  const uint32_t other = c->joint[vertex];
  const uint32_t *end = other < k ? c->walls->wall[c->barrier[other].wall].vertex : NULL;
  if (end && (end[0] == vertex || end[1] == vertex))
    join(c, other, k);
  else
    c->joint[vertex] = k;
  const uint32_t host = c->walls->host[vertex];
  if (host == HR2DI_NO_WALL) return;
  const uint32_t at = c->joint_of[host];
  if (at < c->barriers && c->barrier[at].wall == host) join(c, at, k);
}

/* A joint counts only within the shaft: outside of it something may pass between. */
static hr2d_status join_all(hr2di_classes *c, const hr2di_shaft *shaft) {
  const hr2d_status status = hr2di_watch_work(c->watch, c->barriers / 2);
  for (uint32_t k = 0; k < c->barriers && !status; k++)
    for (int e = 0; e < 2; e++) {
      const hr2di_barrier *b = &c->barrier[k];
      if ((b->at.whole & (1u << e)) && between_sides(shaft, b->at.end[e]))
        join_at(c, k, c->walls->wall[b->wall].vertex[e]);
    }
  return status;
}

static hr2d_status reserve(hr2di_classes *c, size_t count) {
  const hr2d_allocator *alloc = &c->alloc;
  const size_t vertices = c->joint_capacity, walls = c->joint_of_capacity;
  if (hr2di_alloc_reserve(alloc, &c->barrier, &c->barrier_capacity, count,
                          sizeof *c->barrier) ||
      hr2di_alloc_reserve(alloc, &c->parent, &c->parent_capacity, count, sizeof *c->parent) ||
      hr2di_alloc_reserve(alloc, &c->island, &c->island_capacity, count, sizeof *c->island) ||
      hr2di_alloc_reserve(alloc, &c->point, &c->point_capacity, 2 * count, sizeof *c->point) ||
      hr2di_alloc_reserve(alloc, &c->joint, &c->joint_capacity, c->walls->vertices,
                          sizeof *c->joint) ||
      hr2di_alloc_reserve(alloc, &c->joint_of, &c->joint_of_capacity, c->walls->walls,
                          sizeof *c->joint_of))
    return HR2D_ENOMEM;
  for (size_t k = vertices; k < c->joint_capacity; k++) c->joint[k] = UINT32_MAX;
  for (size_t k = walls; k < c->joint_of_capacity; k++) c->joint_of[k] = UINT32_MAX;
  return HR2D_OK;
}

/* The width of points across the shaft. */
static double width_of(const hr2di_shaft *s, const hr2di_incident_point *point, size_t count) {
  const hr2d_point across = hr2di_shaft_across(s);
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (size_t k = 0; k < count; k++) {
    const double at = across.x * point[k].at.x + across.y * point[k].at.y;
    least = fmin(least, at);
    most = fmax(most, at);
  }
  return most - least;
}

/* The widest first: it leaves the fewest classes to what follows. */
static int by_width(const void *left, const void *right) {
  const hr2di_island *l = left, *r = right;
  if (l->width != r->width) return l->width > r->width ? -1 : 1;
  return (l->first > r->first) - (l->first < r->first);
}

/* The points of the barriers joined to k. */
static void put_points(hr2di_classes *c, uint32_t k) {
  for (uint32_t m = k; m < c->barriers; m++)
    if (hr2di_union_find(c->parent, m) == k) {
      c->point[c->points++] = c->barrier[m].at.end[0];
      c->point[c->points++] = c->barrier[m].at.end[1];
    }
}

/* The chains with all that has its side by itself, and the islands. */
static hr2d_status gather(hr2di_classes *c, const hr2di_shaft *s, unsigned known) {
  hr2d_status status = hr2di_chain_init(&c->right, &c->alloc, s->b, s->c);
  if (!status) status = hr2di_chain_init(&c->left, &c->alloc, s->a, s->d);
  c->points = c->islands = 0;
  for (uint32_t k = 0; k < c->barriers && !status; k++) {
    if (hr2di_union_find(c->parent, k) != k) continue;
    const size_t first = c->points;
    int grown;
    status = hr2di_watch_work(c->watch, 1 + (c->barriers - k) / 32);
    if (status) return status;
    put_points(c, k);
    const size_t count = c->points - first;
    if (c->barrier[k].hand == 0)
      c->island[c->islands++] =
          (hr2di_island){first, count, width_of(s, c->point + first, count)};
    else
      status = hr2di_chain_add(c->barrier[k].hand == TO_RIGHT ? &c->right : &c->left, &c->alloc,
                               &s->frame, known, c->point + first, count, &grown);
  }
  return status;
}

static hr2d_status begin(hr2di_classes *c, const hr2di_shaft *s) {
  const hr2d_status status = gather(c, s, HR2DI_ON_BOTH);
  if (status ||
      (hr2di_chain_sound(&s->frame, &c->right) && hr2di_chain_sound(&s->frame, &c->left)))
    return status;
  return gather(c, s, 0);
}

hr2d_status hr2di_classes_sort(hr2di_classes *c, const hr2di_shaft *shaft, const uint32_t *wall,
                               size_t count, int *passable) {
  if (reserve(c, count)) return HR2D_ENOMEM;
  c->barriers = 0;
  *passable = 0;
  for (size_t k = 0; k < count; k++) {
    hr2di_barrier b = {.wall = wall[k]};
    const hr2d_status asked = k % SOME == 0 ? hr2di_watch_work(c->watch, 2 * SOME) : HR2D_OK;
    if (asked) return asked;
    if (!hr2di_shaft_test(shaft, c->walls->wall[wall[k]].at, &b.at)) continue;
    if (b.at.right && meets_side(&shaft->frame, &b.at, shaft->b, shaft->c)) b.hand |= TO_RIGHT;
    if (b.at.left && meets_side(&shaft->frame, &b.at, shaft->a, shaft->d)) b.hand |= TO_LEFT;
    if (b.hand == NEITHER) return HR2D_OK;
    c->joint_of[wall[k]] = c->parent[c->barriers] = (uint32_t)c->barriers;
    c->barrier[c->barriers++] = b;
  }
  hr2d_status status = join_all(c, shaft);
  if (status) return status;
  for (uint32_t k = 0; k < c->barriers; k++)
    if (c->barrier[hr2di_union_find(c->parent, k)].hand == NEITHER) return HR2D_OK;
  status = begin(c, shaft);
  if (status) return status;
  /* Without islands there is one class, and the sum looks at it. */
  *passable = c->islands == 0 || hr2di_corridor_open(&shaft->frame, &c->right, &c->left);
  if (c->islands < 2) return hr2di_watch_status(c->watch);
  return hr2di_sort(c->island, c->islands, sizeof *c->island, by_width, c->watch);
}

static hr2d_status copy(hr2di_chain *to, const hr2d_allocator *alloc,
                        const hr2di_incident_point *point, size_t count) {
  if (hr2di_alloc_reserve(alloc, &to->point, &to->capacity, count, sizeof *point))
    return HR2D_ENOMEM;
  memcpy(to->point, point, count * sizeof *point);
  to->count = count;
  return HR2D_OK;
}

/* The class with these chains is to be looked at later, from `island` on. */
static hr2d_status put_off(hr2di_classes *c, const hr2di_chain *right, const hr2di_chain *left,
                           size_t island) {
  if (hr2di_alloc_reserve(&c->alloc, &c->stack, &c->stack_capacity,
                          c->stacked + right->count + left->count, sizeof *c->stack) ||
      hr2di_alloc_reserve(&c->alloc, &c->put_off, &c->put_off_capacity, c->put_offs + 1,
                          sizeof *c->put_off))
    return HR2D_ENOMEM;
  memcpy(c->stack + c->stacked, right->point, right->count * sizeof *c->stack);
  memcpy(c->stack + c->stacked + right->count, left->point, left->count * sizeof *c->stack);
  c->stacked += right->count + left->count;
  c->put_off[c->put_offs++] = (hr2di_put_off){right->count, left->count, island};
  return HR2D_OK;
}

/* The class put off last becomes the one under way. */
static hr2d_status take_up(hr2di_classes *c, size_t *island) {
  const hr2di_put_off next = c->put_off[--c->put_offs];
  *island = next.island;
  c->stacked -= next.right + next.left;
  const hr2d_status status = copy(&c->right, &c->alloc, c->stack + c->stacked, next.right);
  return status ? status
                : copy(&c->left, &c->alloc, c->stack + c->stacked + next.right, next.left);
}

static void swap(hr2di_chain *p, hr2di_chain *q) {
  const hr2di_chain kept = *p;
  *p = *q;
  *q = kept;
}

static hr2d_status widen_knowing(hr2di_classes *c, const hr2di_shaft *shaft, unsigned known,
                                 hr2di_chain *wider, const hr2di_chain *chain, hr2di_island o,
                                 int *grown) {
  const hr2d_status status = copy(wider, &c->alloc, chain->point, chain->count);
  return status ? status
                : hr2di_chain_add(wider, &c->alloc, &shaft->frame, known, c->point + o.first,
                                  o.count, grown);
}

/* A chain with an island more; *inside if that is no more. */
static hr2d_status widen(hr2di_classes *c, const hr2di_shaft *shaft, hr2di_chain *wider,
                         const hr2di_chain *chain, hr2di_island o, int *inside) {
  int grown = 0;
  hr2d_status status = widen_knowing(c, shaft, HR2DI_ON_BOTH, wider, chain, o, &grown);
  if (!status && grown && !hr2di_chain_sound(&shaft->frame, wider))
    status = widen_knowing(c, shaft, 0, wider, chain, o, &grown);
  *inside = !grown;
  return status;
}

/* Leaves island k of the class under way on its right or on its left; where both can be,
   the class with the former is put off.  *open is 0 if neither can. */
static hr2d_status place(hr2di_classes *c, const hr2di_shaft *shaft, size_t k, int *open) {
  int inside;
  hr2d_status status = widen(c, shaft, &c->wider_right, &c->right, c->island[k], &inside);
  if (status || inside) return status;
  status = widen(c, shaft, &c->wider_left, &c->left, c->island[k], &inside);
  if (status || inside) return status;
  const int right = hr2di_corridor_open(&shaft->frame, &c->wider_right, &c->left);
  const int left = hr2di_corridor_open(&shaft->frame, &c->right, &c->wider_left);
  if (right && left) status = put_off(c, &c->wider_right, &c->left, k + 1);
  if (left)
    swap(&c->left, &c->wider_left);
  else if (right)
    swap(&c->right, &c->wider_right);
  *open = right || left;
  return status ? status : hr2di_watch_status(c->watch);
}

hr2d_status hr2di_classes_visit(hr2di_classes *c, const hr2di_shaft *shaft,
                                const hr2di_class_visitor *visitor, int *open) {
  hr2d_status status = HR2D_OK;
  size_t island = 0;
  c->put_offs = c->stacked = 0;
  *open = 0;
  for (;;) {
    int passable = 1, some = 0;
    while (island < c->islands && passable && !status)
      status = place(c, shaft, island++, &passable);
    if (status) return status;
    if (passable) status = visitor->visit(visitor->ctx, shaft, &c->right, &c->left, &some);
    *open |= some;
    if (status || c->put_offs == 0) return status ? status : hr2di_watch_status(c->watch);
    status = take_up(c, &island);
    if (status) return status;
  }
}
