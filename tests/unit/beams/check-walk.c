/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams among the walls of small scenes on grids, full of T-junctions, triple points and walls
   on one line: against the exchange area of each pair of sides around all walls.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/alloc.h"
#include "beams/walk.h"
#include "support/lattice-scenes.h"
#include "support/plane.h"
#include "support/support.h"

enum { MOST = 40, SIDES = 1000 };

/* Walls that neither cross nor overlap, and their triangulation. */
typedef struct scene {
  hr2d_segment wall[MOST];
  size_t walls;
  hr2di_triangulation t;
  size_t sides;
} scene;

static void drop(scene *s, uint32_t wall) {
  s->walls--;
  memmove(s->wall + wall, s->wall + wall + 1, (s->walls - wall) * sizeof *s->wall);
}

static void close_scene(scene *s) {
  hr2di_triangulation_clear(&s->t);
}

static void triangulate(scene *s) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2di_conflict conflict;
  while (hr2di_triangulation_init(&s->t, &alloc, s->wall, s->walls, sizeof *s->wall,
                                  HR2DI_UNITS, &conflict, NULL)) {
    close_scene(s);
    drop(s, conflict.wall[1]);
  }
  s->sides = 2 * s->t.edges;
  ck_assert_uint_le(s->sides, SIDES);
}

/* Walls on a grid, in a closed room or under the open sky. */
static void draw_scene(unsigned long *state, int room, scene *s) {
  lattice p[MOST];
  const int size = 2 + (int)lattice_random(state, 7),
            count = 1 + (int)lattice_random(state, 24);
  const hr2d_point corner[] = {{-2, -2}, {size + 2, -2}, {size + 2, size + 2}, {-2, size + 2}};
  s->walls = 0;
  for (int k = 0; k < 4 && room; k++)
    s->wall[s->walls++] = (hr2d_segment){corner[k], corner[(k + 1) % 4]};
  lattice_draw(state, p, (size_t)count, size, 1 + lattice_random(state, size));
  for (int k = 0; k < count; k++) {
    const hr2d_segment w = {{(double)p[k].ax, (double)p[k].ay},
                            {(double)p[k].bx, (double)p[k].by}};
    const int inside =
        fabs(w.b.x - size / 2.) <= size / 2. + 2 && fabs(w.b.y - size / 2.) <= size / 2. + 2;
    if (inside && !plane_same(w.a, w.b)) s->wall[s->walls++] = w;
  }
  triangulate(s);
}

/* The sum of all line classes from one side, and how many there are, for each side. */
typedef struct view {
  double area[SIDES];
  int classes[SIDES];
  uint64_t print[SIDES]; /* a sum of hashes of line classes, the same from both ends */
} view;

static uint64_t hash(hr2d_point p, uint64_t place) {
  const double key[] = {p.x, p.y, (double)place};
  uint64_t bits[3], h = 14695981039346656037u;
  memcpy(bits, key, sizeof bits);
  for (int k = 0; k < 3; k++) h = (h ^ (bits[k] >> 7) ^ bits[k]) * 1099511628211u * 31;
  return h;
}

static hr2d_status take(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  view *v = ctx;
  const double area = hr2di_line_class_area(s);
  uint64_t print = 0;
  for (size_t k = 0; k < s->lefts; k++) print += hash(s->left[k], 0) + hash(s->left[k], k);
  for (size_t k = 0; k < s->rights; k++)
    print += hash(s->right[k], 0) + hash(s->right[k], s->rights - 1 - k);
  ck_assert_double_gt(area, 0);
  v->area[j] += area;
  v->classes[j]++;
  v->print[j] += print;
  return HR2D_OK;
}

/* The same with the hash of the line class as it is seen from j. */
static hr2d_status take_turned(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  hr2d_point room[2 * MOST];
  hr2di_line_class turned;
  hr2di_line_class_turn(s, room, &turned);
  return take(ctx, &turned, j);
}

static hr2di_walk walk_of(const scene *s, const unsigned char *wanted, hr2di_line_class_fn fn) {
  return (hr2di_walk){
      .in = &s->t, .wanted = wanted, .take = fn, .alloc = hr2di_alloc_default()};
}

static void walk_all(const scene *s, int once, hr2di_line_class_fn fn, view *views) {
  unsigned char wanted[SIDES];
  memset(wanted, 1, sizeof wanted);
  hr2di_walk w = walk_of(s, wanted, fn);
  w.once = once;
  memset(views, 0, s->sides * sizeof *views);
  for (uint32_t side = 0; side < s->sides; side++) {
    w.ctx = &views[side];
    ck_assert_int_eq(hr2di_walk_from(&w, side, NULL), HR2D_OK);
  }
  hr2di_walk_clear(&w);
}

static void print_scene(const scene *s) {
  for (size_t k = 0; k < s->walls; k++)
    fprintf(stderr, "  {{%g, %g}, {%g, %g}},\n", s->wall[k].a.x, s->wall[k].a.y, s->wall[k].b.x,
            s->wall[k].b.y);
}

/* Around all walls, by the library's search of one pair. */
static double expected(const scene *s, uint32_t i, uint32_t j) {
  const hr2d_segment near = hr2di_wall_side_at(&s->t, i), far = hr2di_wall_side_at(&s->t, j);
  double area;
  ck_assert_int_eq(hr2d_exchange_area_occluded(&near, &far, s->wall, s->walls, NULL, &area),
                   HR2D_OK);
  return area;
}

START_TEST(sights_add_up_to_pairs) {
  unsigned long state = test_seed() + 11;
  view *views = malloc(SIDES * sizeof *views);
  double worst = 0, worst_row = 0;
  size_t pairs = 0, seen = 0;
  for (int k = test_count(3000); k > 0; k--) {
    scene s;
    draw_scene(&state, _i, &s);
    walk_all(&s, 0, take, views);
    for (uint32_t i = 0; i < s.sides; i++) {
      const hr2d_segment at = hr2di_wall_side_at(&s.t, i);
      double row = 0;
      for (uint32_t j = 0; j < s.sides; j++) {
        const double area = views[i].area[j];
        row += area;
        pairs++;
        seen += area > 0;
        if (s.sides > 60 && j % 8) continue;
        const double other = expected(&s, i, j);
        worst = fmax(worst, fabs(area - other));
        if ((area > 0) != (other > 0)) print_scene(&s);
        ck_assert_msg((area > 0) == (other > 0), "%u %u: %g %g", i, j, area, other);
      }
      if (_i && i < 8 && !(i & 1)) /* the inside of the room */
        worst_row = fmax(worst_row, fabs(row / plane_length(at) - 1));
    }
    close_scene(&s);
  }
  free(views);
  printf("%zu of %zu pairs of sides see each other, worst difference %.1e, row %.1e\n", seen,
         pairs, worst, worst_row);
  ck_assert_double_le(worst, 1e-13);
  ck_assert_double_le(worst_row, 1e-13);
}
END_TEST

START_TEST(both_ends_find_the_same) {
  unsigned long state = test_seed() + 12;
  view *from = malloc(SIDES * sizeof *from), *back = malloc(SIDES * sizeof *back);
  long classes = 0;
  for (int k = test_count(3000); k > 0; k--) {
    scene s;
    draw_scene(&state, _i, &s);
    walk_all(&s, 0, take, from);
    walk_all(&s, 0, take_turned, back);
    for (uint32_t i = 0; i < s.sides; i++)
      for (uint32_t j = 0; j < s.sides; j++) {
        ck_assert_int_eq(from[i].classes[j], back[j].classes[i]);
        ck_assert(from[i].print[j] == back[j].print[i]);
        classes += from[i].classes[j];
      }
    close_scene(&s);
  }
  free(from);
  free(back);
  printf("%ld sights\n", classes);
  ck_assert_int_gt(classes, 0);
}
END_TEST

START_TEST(once_is_once) {
  unsigned long state = test_seed() + 13;
  view *all = malloc(SIDES * sizeof *all), *once = malloc(SIDES * sizeof *once);
  long from_both = 0;
  for (int k = test_count(3000); k > 0; k--) {
    scene s;
    draw_scene(&state, _i, &s);
    walk_all(&s, 0, take, all);
    walk_all(&s, 1, take, once);
    for (uint32_t i = 0; i < s.sides; i++)
      for (uint32_t j = 0; j < i; j++) {
        ck_assert_int_eq(all[i].classes[j], once[i].classes[j] + once[j].classes[i]);
        from_both += once[i].classes[j] > 0 && once[j].classes[i] > 0;
        ck_assert_double_le(fabs(all[i].area[j] - once[i].area[j] - once[j].area[i]), 1e-13);
      }
    close_scene(&s);
  }
  free(all);
  free(once);
  printf("%ld pairs have sights from either side\n", from_both);
}
END_TEST

typedef struct narrowed {
  hr2d_segment part;
  double area;
} narrowed;

static hr2d_status take_part(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  narrowed *n = ctx;
  hr2d_point room[2][4 * MOST];
  hr2di_line_class half, child;
  (void)j;
  if (hr2di_line_class_restrict(s, HR2DI_LINE_CLASS_A, n->part.a, room[0], &half) &&
      hr2di_line_class_restrict(&half, HR2DI_LINE_CLASS_B, n->part.b, room[1], &child))
    n->area += hr2di_line_class_area(&child);
  return HR2D_OK;
}

/* Rows of parts sum to their lengths, and need fewer steps. */
START_TEST(parts_of_a_side) {
  unsigned long state = test_seed() + 14;
  double worst = 0;
  uint64_t whole = 0, parts = 0;
  for (int k = test_count(3000); k > 0; k--) {
    scene s;
    unsigned char wanted[SIDES];
    memset(wanted, 1, sizeof wanted);
    draw_scene(&state, 1, &s);
    narrowed n;
    hr2di_walk w = walk_of(&s, wanted, take_part);
    w.ctx = &n;
    for (uint32_t side = 0; side < 8; side += 2) {
      const hr2d_segment at = hr2di_wall_side_at(&s.t, side);
      n = (narrowed){{plane_along(at, .25), plane_along(at, .375)}, 0};
      w.steps = 0;
      ck_assert_int_eq(hr2di_walk_from(&w, side, NULL), HR2D_OK);
      const double expected_area = n.area;
      whole += w.steps;
      n.area = 0;
      w.steps = 0;
      ck_assert_int_eq(hr2di_walk_from(&w, side, &n.part), HR2D_OK);
      parts += w.steps;
      ck_assert_double_eq(n.area, expected_area);
      worst = fmax(worst, fabs(n.area / plane_length(n.part) - 1));
    }
    hr2di_walk_clear(&w);
    close_scene(&s);
  }
  printf("%llu steps for parts, %llu for whole sides, worst row %.1e\n",
         (unsigned long long)parts, (unsigned long long)whole, worst);
  ck_assert_double_le(worst, 1e-13);
  ck_assert_uint_lt(parts, whole);
}
END_TEST

/* The ends of a part are off its side by some roundings, which are large beside the width of a
   side that is nearly upright. */
START_TEST(parts_that_are_off_their_side) {
  for (int signs = 0; signs < 8; signs++) {
    const double tilt = signs & 1 ? 0x1p-50 : -0x1p-50, a = signs & 2 ? 0x1p-50 : -0x1p-50,
                 b = signs & 4 ? 0x1p-50 : -0x1p-50;
    const hr2d_point corner[] = {{0, 0}, {1 + tilt, 0}, {1 - tilt, 1}, {0, 1}};
    unsigned char wanted[SIDES];
    memset(wanted, 1, sizeof wanted);
    scene s = {.walls = 4};
    for (int k = 0; k < 4; k++) s.wall[k] = (hr2d_segment){corner[k], corner[(k + 1) % 4]};
    triangulate(&s);
    narrowed n = {{{1 + a, .25}, {1 + b, .5}}, 0};
    hr2di_walk w = walk_of(&s, wanted, take_part);
    w.ctx = &n;
    ck_assert_int_eq(hr2di_walk_from(&w, 2, &n.part), HR2D_OK);
    ck_assert_double_eq_tol(n.area, .25, 1e-14);
    hr2di_walk_clear(&w);
    close_scene(&s);
  }
}
END_TEST

/* Line classes that go on through the wall on which they end. */
typedef struct going_on {
  hr2di_walk further;
  double area; /* in which they end */
  double worst;
  long through;
} going_on;

static hr2d_status add_area(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  going_on *g = ctx;
  (void)j;
  g->area += hr2di_line_class_area(s);
  return HR2D_OK;
}

static hr2d_status go_through(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  going_on *g = ctx;
  const hr2d_point *at = g->further.in->at;
  const hr2di_wall_edge *e = &g->further.in->edge[j >> 1];
  const double x = at[e->from].x + at[e->to].x, y = at[e->from].y + at[e->to].y;
  const hr2d_segment room = {at[g->further.in->edge[0].from], at[g->further.in->edge[2].from]};
  if (x == 2 * room.a.x || y == 2 * room.a.y || x == 2 * room.b.x || y == 2 * room.b.y)
    return HR2D_OK; /* behind the walls of the room is nothing */
  g->area = 0;
  const hr2d_status status = hr2di_walk_on(&g->further, j ^ 1, s);
  const double area = hr2di_line_class_area(s);
  g->worst = fmax(g->worst, fabs(g->area - area));
  g->through++;
  return status;
}

/* In a closed room no line is lost behind a wall. */
START_TEST(lines_go_on_through_walls) {
  unsigned long state = test_seed() + 15;
  going_on g = {.worst = 0};
  for (int k = test_count(3000); k > 0; k--) {
    scene s;
    unsigned char wanted[SIDES];
    memset(wanted, 1, sizeof wanted);
    draw_scene(&state, 1, &s);
    hr2di_walk w = walk_of(&s, wanted, go_through);
    g.further = walk_of(&s, wanted, add_area);
    w.ctx = g.further.ctx = &g;
    for (uint32_t side = 0; side < s.sides && s.t.edge_of[4] == 4; side++)
      ck_assert_int_eq(hr2di_walk_from(&w, side, NULL), HR2D_OK);
    hr2di_walk_clear(&w);
    hr2di_walk_clear(&g.further);
    close_scene(&s);
  }
  printf("%ld sights go through a wall, worst difference %.1e\n", g.through, g.worst);
  ck_assert_int_gt(g.through, 0);
  ck_assert_double_le(g.worst, 1e-13);
}
END_TEST

/* The triangles that all beams of an open row of squares enter. */
static uint64_t steps_in_row(size_t squares) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_segment *wall = malloc(4 * squares * sizeof *wall);
  unsigned char *wanted = calloc(8 * squares, 1);
  hr2di_triangulation t;
  hr2di_conflict conflict;
  for (size_t k = 0; k < 4 * squares; k++) {
    const double x = 2 * (double)(k / 4);
    const hr2d_point corner[] = {{x, 0}, {x, 1}, {x + 1, 1}, {x + 1, 0}};
    wall[k] = (hr2d_segment){corner[k % 4], corner[(k + 1) % 4]};
  }
  ck_assert_int_eq(hr2di_triangulation_init(&t, &alloc, wall, 4 * squares, sizeof *wall,
                                            HR2DI_UNITS, &conflict, NULL),
                   HR2D_OK);
  hr2di_walk w = {.in = &t, .wanted = wanted, .alloc = alloc};
  for (uint32_t side = 0; side < 2 * t.edges; side++)
    ck_assert_int_eq(hr2di_walk_from(&w, side, NULL), HR2D_OK);
  const uint64_t steps = w.steps;
  hr2di_walk_clear(&w);
  hr2di_triangulation_clear(&t);
  free(wall);
  free(wanted);
  return steps;
}

/* A beam that leaves the row walks no triangles around it: those are as many as squares. */
START_TEST(beams_end_at_the_hull) {
  const uint64_t few = steps_in_row(100), many = steps_in_row(1000);
  printf("%llu steps in a row of 100, %llu in one of 1000\n", (unsigned long long)few,
         (unsigned long long)many);
  ck_assert_uint_gt(few, 100);
  ck_assert_uint_le(many, 11 * few);
}
END_TEST

TEST_SUITE("walk") {
  REPEAT_TESTS(2, "open and closed", sights_add_up_to_pairs, both_ends_find_the_same,
               once_is_once);
  ADD_TESTS("walk", parts_of_a_side, parts_that_are_off_their_side, lines_go_on_through_walls,
            beams_end_at_the_hull);
}
