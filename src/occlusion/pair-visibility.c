/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas past walls: the walls in the way of a pair, and the pair cut up where
   they are many. */
#include "occlusion/pair-visibility.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "occlusion/wall-bodies.h"
#include "occlusion/wall-tree.h"

/* The classes of many islands cost more than those of both halves of a segment, which
   each see fewer islands; but no cut helps where they all are seen from everywhere. */
enum { MOST_ISLANDS = 8, MOST_CUTS = 24 };

/* Tests between two declarations of work; a test takes some 0.05 µs. */
enum { TESTS = 16 };

/* Declares work at the start of a loop over tests, and then before every TESTS of them. */
static inline hr2d_status declare(const hr2di_visibility *s, size_t test) {
  return test % TESTS == 0 ? hr2di_watch_work(s->watch, test ? TESTS / 2 : 2) : HR2D_OK;
}

void hr2di_visibility_init(hr2di_visibility *sight, const hr2di_walls *walls,
                           const hr2d_allocator *alloc, hr2di_watch *watch) {
  *sight = (hr2di_visibility){.walls = walls, .alloc = *alloc, .watch = watch};
  hr2di_classes_init(&sight->classes, walls, alloc, watch);
}

void hr2di_visibility_clear(hr2di_visibility *sight) {
  hr2di_classes_clear(&sight->classes);
  hr2di_alloc_free(&sight->alloc, sight->list.wall);
}

/* Whether the body of a wall in the way cuts the shaft in two: it is in front of i and j
   and reaches either side.  Bodies share slots; one that is forgotten is noticed later,
   when the pair is integrated. */
static int body_cuts(hr2di_visibility *s, const hr2di_shaft *shaft, uint32_t wall,
                     const hr2di_obstacle *o) {
  const uint32_t number = s->walls->body_of[wall];
  hr2di_reach *reach = &s->reach[number % HR2DI_REACHES];
  if (reach->look != s->looks || reach->body != number)
    *reach = (hr2di_reach){s->looks, number, 0};
  reach->beyond |= (o->right ? 1U : 0U) | (o->left ? 2U : 0U);
  if (reach->beyond != 3) return 0;
  const hr2d_segment *chord = s->walls->body[number].chord;
  return hr2di_shaft_has_in_front(shaft, chord[0].a.x, chord[0].b.x, chord[1].a.y,
                                  chord[1].b.y);
}

/* Tests a wall and appends it if it is in the way.  *view is what it was, or worse. */
static hr2d_status test(hr2di_visibility *s, const hr2di_shaft *shaft, uint32_t wall,
                        hr2di_wall_list *found, hr2di_visibility_class *view) {
  hr2di_obstacle obstacle;
  hr2di_in_way way = hr2di_shaft_test(shaft, s->walls->wall[wall].at, &obstacle);
  s->tests++;
  if (way == HR2DI_ASIDE) return HR2D_OK;
  if (way == HR2DI_INSIDE && (obstacle.right || obstacle.left) &&
      body_cuts(s, shaft, wall, &obstacle))
    way = HR2DI_ACROSS;
  *view = way == HR2DI_ACROSS ? HR2DI_BLOCKED : HR2DI_PARTIAL;
  s->last = wall;
  if (way == HR2DI_ACROSS) return HR2D_OK;
  if (hr2di_alloc_reserve(&s->alloc, &found->wall, &found->capacity, found->count + 1,
                          sizeof *found->wall))
    return HR2D_ENOMEM;
  found->wall[found->count++] = wall;
  return HR2D_OK;
}

static uint32_t first_wall(const hr2di_walls *walls, const hr2di_box *box) {
  while (box->wall == HR2DI_NO_WALL) box = &walls->box[box->below];
  return box->wall;
}

/* Whether a body whose walls a box holds cuts the shaft in two. */
static int body_across(hr2di_visibility *s, const hr2di_shaft *shaft, const hr2di_box *box) {
  if (box->body == HR2DI_NO_BODY ||
      !hr2di_shaft_has_in_front(shaft, box->x0, box->x1, box->y0, box->y1))
    return 0;
  const double dx = (shaft->c.at.x + shaft->d.at.x) - (shaft->a.at.x + shaft->b.at.x);
  const double dy = (shaft->c.at.y + shaft->d.at.y) - (shaft->a.at.y + shaft->b.at.y);
  const hr2d_segment chord = hr2di_body_chord_across(&s->walls->body[box->body], dx, dy);
  hr2di_obstacle obstacle;
  s->tests++;
  return hr2di_shaft_test(shaft, chord, &obstacle) == HR2DI_ACROSS;
}

static int by_number(const void *left, const void *right) {
  const uint32_t l = *(const uint32_t *)left, r = *(const uint32_t *)right;
  return (l > r) - (l < r);
}

static hr2d_status sort(uint32_t *wall, size_t count, hr2di_watch *watch) {
  enum { SHORT = 24 };
  if (count > SHORT) return hr2di_sort(wall, count, sizeof *wall, by_number, watch);
  for (size_t k = 1; k < count; k++) {
    const uint32_t moved = wall[k];
    size_t m = k;
    for (; m > 0 && wall[m - 1] > moved; m--) wall[m] = wall[m - 1];
    wall[m] = moved;
  }
  return HR2D_OK;
}

/* How far the middle of a box is from that of a shaft, squared and four times. */
static double away(const hr2di_box *box, hr2d_point middle) {
  const double dx = box->x0 + box->x1 - 2 * middle.x, dy = box->y0 + box->y1 - 2 * middle.y;
  return dx * dx + dy * dy;
}

static hr2d_point middle_of(const hr2di_shaft *s) {
  return (hr2d_point){0.25 * ((s->a.at.x + s->b.at.x) + (s->c.at.x + s->d.at.x)),
                      0.25 * ((s->a.at.y + s->b.at.y) + (s->c.at.y + s->d.at.y))};
}

/* What is across is most likely in the middle: looked for there first it is found soon even
   where every box meets the shaft, as do those around a fan of walls that meet in a point. */
hr2d_status hr2di_visibility_collect(hr2di_visibility *s, const hr2di_shaft *shaft,
                                     hr2di_wall_list *found, hr2di_visibility_class *view) {
  const size_t before = found->count;
  const hr2d_point middle = middle_of(shaft);
  uint32_t stack[HR2DI_BOX_DEPTH], count = 0;
  size_t turn = 0;
  hr2d_status status = HR2D_OK;
  *view = HR2DI_CLEAR;
  s->looks++;
  stack[count++] = 0;
  while (count > 0 && !status && *view != HR2DI_BLOCKED) {
    const hr2di_box *box = &s->walls->box[stack[--count]];
    status = declare(s, turn++);
    if (status) break;
    if (box->wall != HR2DI_NO_WALL) {
      status = test(s, shaft, box->wall, found, view);
      continue;
    }
    s->tests++;
    if (!hr2di_shaft_meets_box(shaft, box->x0, box->x1, box->y0, box->y1)) continue;
    if (body_across(s, shaft, box)) {
      *view = HR2DI_BLOCKED;
      s->last = first_wall(s->walls, box);
    }
    const hr2di_box *below = &s->walls->box[box->below];
    const uint32_t nearer = away(&below[1], middle) <= away(&below[0], middle);
    stack[count++] = box->below + !nearer;
    stack[count++] = box->below + nearer;
  }
  if (*view == HR2DI_BLOCKED) found->count = before;
  if (!status && found->count > before + 1)
    status = sort(found->wall + before, found->count - before, s->watch);
  return status;
}

hr2d_status hr2di_visibility_shrink(hr2di_visibility *s, const hr2di_shaft *shaft,
                                    const hr2di_wall_list *from, size_t first, size_t count,
                                    hr2di_wall_list *found, hr2di_visibility_class *view) {
  const size_t before = found->count;
  hr2d_status status = HR2D_OK;
  *view = HR2DI_CLEAR;
  s->looks++;
  for (size_t k = 0; k < count && !status && *view != HR2DI_BLOCKED; k++) {
    status = declare(s, k);
    if (!status) status = test(s, shaft, from->wall[first + k], found, view);
  }
  if (*view == HR2DI_BLOCKED) found->count = before;
  return status;
}

/* A part of a pair, with its walls in s->list; those of the parts behind it come later. */
typedef struct part {
  hr2di_shaft shaft;
  size_t first, count;
  unsigned cuts;
} part;

static double square(hr2d_segment s) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  return dx * dx + dy * dy;
}

/* Halves the longer segment; 0 if that leaves no two. */
static int cut(const hr2di_shaft *shaft, hr2d_segment i[2], hr2d_segment j[2]) {
  i[0] = i[1] = (hr2d_segment){shaft->a.at, shaft->b.at};
  j[0] = j[1] = (hr2d_segment){shaft->c.at, shaft->d.at};
  hr2d_segment *half = square(i[0]) >= square(j[0]) ? i : j;
  const hr2d_segment whole = half[0];
  const hr2d_point middle = {0.5 * (whole.a.x + whole.b.x), 0.5 * (whole.a.y + whole.b.y)};
  half[0].b = half[1].a = middle;
  return square(half[0]) > 0 && square(half[1]) > 0;
}

/* Both halves of a part, onto the stack in its place. */
static hr2d_status cut_up(hr2di_visibility *s, part *stack, size_t *parts, int *done) {
  const part whole = stack[*parts - 1];
  hr2d_segment i[2], j[2];
  *done = 0;
  if (whole.cuts == MOST_CUTS || !cut(&whole.shaft, i, j)) return HR2D_OK;
  *done = 1;
  --*parts;
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < 2 && !status; k++) {
    part *half = &stack[*parts];
    hr2di_visibility_class view;
    half->cuts = whole.cuts + 1;
    half->first = s->list.count;
    if (!hr2di_shaft_part(&half->shaft, &whole.shaft, i[k], j[k])) continue;
    status = hr2di_visibility_shrink(s, &half->shaft, &s->list, whole.first, whole.count,
                                     &s->list, &view);
    half->count = s->list.count - half->first;
    if (view != HR2DI_BLOCKED) ++*parts;
  }
  return status;
}

/* One part: its classes and whether there is one, or its halves. */
static hr2d_status settle(hr2di_visibility *s, part *stack, size_t *parts,
                          const hr2di_class_visitor *visitor, int *open) {
  const part *top = &stack[*parts - 1];
  int passable, cut_done;
  if (top->count == 0) {
    *open = 1;
    --*parts;
    return visitor->visit(visitor->ctx, &top->shaft, NULL, NULL, open);
  }
  hr2d_status status =
      hr2di_classes_sort(&s->classes, &top->shaft, hr2di_wall_list_from(&s->list, top->first),
                         top->count, &passable);
  if (!status && passable && s->classes.islands > MOST_ISLANDS) {
    status = cut_up(s, stack, parts, &cut_done);
    if (status || cut_done) return status;
  }
  if (!status && passable)
    status = hr2di_classes_visit(&s->classes, &top->shaft, visitor, open);
  --*parts;
  return status;
}

/* Visits the classes of lines past the walls in the way; *open tells whether there is one. */
static hr2d_status visit(hr2di_visibility *s, const hr2di_shaft *shaft, const uint32_t *wall,
                         size_t count, const hr2di_class_visitor *visitor, int *open) {
  part stack[MOST_CUTS + 2];
  size_t parts = 1;
  hr2d_status status = HR2D_OK;
  *open = 0;
  s->list.count = 0;
  if (hr2di_alloc_reserve(&s->alloc, &s->list.wall, &s->list.capacity, count, sizeof *wall))
    return HR2D_ENOMEM;
  status = hr2di_watch_work(s->watch, 1 + count / 64);
  for (size_t k = 0; k < count; k++) s->list.wall[k] = wall[k];
  s->list.count = count;
  stack[0] = (part){*shaft, 0, count, 0};
  while (parts > 0 && !status) {
    int some_open = 0;
    const part *top = &stack[parts - 1];
    s->list.count = top->first + top->count;
    status = settle(s, stack, &parts, visitor, &some_open);
    *open |= some_open;
  }
  return status;
}

static hr2d_status add_area(void *ctx, const hr2di_shaft *shaft, const hr2di_chain *right,
                            const hr2di_chain *left, int *open) {
  const hr2d_segment i = {shaft->a.at, shaft->b.at}, j = {shaft->c.at, shaft->d.at};
  double some = 0, *const sum = ctx;
  *open = !right || hr2di_corridor_area(&shaft->frame, right, left, i, &some);
  *sum += right ? some : hr2d_exchange_area(&i, &j);
  return HR2D_OK;
}

hr2d_status hr2di_visibility_area(hr2di_visibility *sight, const hr2di_shaft *shaft,
                                  const uint32_t *wall, size_t count, double *area, int *open) {
  const hr2di_class_visitor visitor = {add_area, area};
  *area = 0;
  return visit(sight, shaft, wall, count, &visitor, open);
}
