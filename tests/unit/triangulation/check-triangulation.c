/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangulations of walls against the checker and against exact tests of all pairs. */
#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "geometry/predicates.h"
#include "support/support.h"
#include "support/triangulation-fault.h"
#include "triangulation/triangulation.h"

enum { MOST = 64 };

static hr2d_status build(hr2di_triangulation *t, const hr2d_segment *wall, size_t count,
                         hr2di_conflict *conflict) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  return hr2di_triangulation_init(t, &alloc, wall, count, sizeof *wall, HR2DI_UNITS, conflict,
                                  NULL);
}

static int sign(hr2d_point a, hr2d_point b, hr2d_point c) {
  return hr2d_orientation(a, b, c);
}

/* The insides of two segments have a point in common; *together: a stretch. */
static int conflict_of(const hr2d_segment *i, const hr2d_segment *j, int *together) {
  const int ca = sign(i->a, i->b, j->a), cb = sign(i->a, i->b, j->b);
  const int ac = sign(j->a, j->b, i->a), bc = sign(j->a, j->b, i->b);
  *together = 0;
  if (ca || cb || ac || bc) return ca * cb < 0 && ac * bc < 0;
  const double x = fmax(fmin(i->a.x, i->b.x), fmin(j->a.x, j->b.x)),
               y = fmax(fmin(i->a.y, i->b.y), fmin(j->a.y, j->b.y));
  const double u = fmin(fmax(i->a.x, i->b.x), fmax(j->a.x, j->b.x)),
               v = fmin(fmax(i->a.y, i->b.y), fmax(j->a.y, j->b.y));
  *together = (x < u && y <= v) || (x <= u && y < v);
  return *together;
}

static int is_point(const hr2d_segment *s) {
  return s->a.x == s->b.x && s->a.y == s->b.y;
}

/* Small scenes on a lattice: of every kind of touching, some with conflicts. */
typedef struct lattice {
  hr2d_segment wall[MOST]; /* of whole numbers */
  size_t count;
} lattice;

static void draw_lattice(randoms *r, lattice *l) {
  const int size = 2 + random_below(r, 8);
  l->count = 1 + (size_t)random_below(r, 12);
  for (size_t k = 0; k < l->count; k++) do {
      l->wall[k].a = (hr2d_point){random_below(r, size), random_below(r, size)};
      l->wall[k].b = (hr2d_point){random_below(r, size), random_below(r, size)};
    } while (is_point(&l->wall[k]));
}

static int has_conflict(const lattice *l) {
  int together;
  for (size_t i = 0; i < l->count; i++)
    for (size_t j = 0; j < i; j++)
      if (conflict_of(&l->wall[i], &l->wall[j], &together)) return 1;
  return 0;
}

/* Leaves walls out until no two are in conflict. */
static void clear_conflicts(lattice *l) {
  int together;
  size_t kept = 0;
  for (size_t i = 0; i < l->count; i++) {
    size_t j = 0;
    while (j < kept && !conflict_of(&l->wall[i], &l->wall[j], &together)) j++;
    if (j == kept) l->wall[kept++] = l->wall[i];
  }
  l->count = kept;
}

static void assert_names_conflict(const lattice *l, const hr2di_conflict *conflict) {
  int together;
  ck_assert(conflict->wall[0] < conflict->wall[1]);
  ck_assert(conflict_of(&l->wall[conflict->wall[0]], &l->wall[conflict->wall[1]], &together));
  ck_assert_int_eq(together, conflict->together);
}

static void assert_whole(const hr2di_triangulation *t, const hr2d_segment *wall, double off) {
  const char *fault = triangulation_fault(t, wall, sizeof *wall, off);
  ck_assert_msg(!fault, "%s", fault);
}

/* Small scenes on a lattice: of every kind of touching, some with conflicts. */
START_TEST(lattices_are_triangulated_exactly) {
  randoms r = randoms_stream(test_seed(), 1);
  int refused = 0, whole = 0;
  for (int round = 0; round < test_count(300000); round++) {
    lattice l;
    hr2di_triangulation t;
    hr2di_conflict conflict;
    draw_lattice(&r, &l);
    if (random_below(&r, 2)) clear_conflicts(&l);
    const int expected = has_conflict(&l);
    ck_assert_int_eq(build(&t, l.wall, l.count, &conflict), expected ? HR2D_ESCENE : HR2D_OK);
    if (expected) assert_names_conflict(&l, &conflict);
    if (!expected || conflict.together) assert_whole(&t, l.wall, 0);
    *(expected ? &refused : &whole) += 1;
    hr2di_triangulation_clear(&t);
  }
  ck_assert(refused > 0 && whole > 0);
}
END_TEST

static double largest_of(const hr2d_segment *wall, size_t count) {
  double max = 0;
  for (size_t k = 0; k < count; k++)
    max = fmax(max, fmax(fmax(fabs(wall[k].a.x), fabs(wall[k].a.y)),
                         fmax(fabs(wall[k].b.x), fabs(wall[k].b.y))));
  return max;
}

/* z -> (u + iv)z + (x + iy) */
typedef struct motion {
  double u, v, x, y;
} motion;

static motion draw_motion(randoms *r) {
  const double size = random_below(r, 2) ? 1 : random_power(r, -40, 40);
  const double turn = random_below(r, 3) ? random_between(r, 0, 6.28) : 0;
  const double far = random_below(r, 2) ? size * random_power(r, 0, 7) : 0;
  return (motion){size * cos(turn), size * sin(turn), random_between(r, -far, far),
                  random_between(r, -far, far)};
}

static hr2d_point moved(motion m, hr2d_point p) {
  return (hr2d_point){m.u * p.x - m.v * p.y + m.x, m.v * p.x + m.u * p.y + m.y};
}

/* Moves all walls and adds up to 0.5 units in the last place of the largest coordinate to each
   coordinate, so that ends alike differ by up to 2 units or so. */
static void move_and_jitter(randoms *r, motion by, const lattice *l, hr2d_segment *wall) {
  for (size_t k = 0; k < l->count; k++)
    wall[k] = (hr2d_segment){moved(by, l->wall[k].a), moved(by, l->wall[k].b)};
  const double ulp = 0x1p-53 * largest_of(wall, l->count);
  for (size_t k = 0; k < l->count; k++) {
    double *x[] = {&wall[k].a.x, &wall[k].a.y, &wall[k].b.x, &wall[k].b.y};
    for (int i = 0; i < 4; i++) *x[i] += random_between(r, -ulp, ulp);
  }
}

/* The walls run through the same vertices. */
static void assert_same_paths(const hr2di_triangulation *exact, const hr2di_triangulation *t) {
  uint32_t like[2 * MOST];
  ck_assert_uint_eq(exact->vertices, t->vertices);
  ck_assert_uint_eq(exact->edges, t->edges);
  for (size_t v = 0; v < exact->vertices; v++) like[v] = UINT32_MAX;
  for (size_t k = 0; k < t->edges; k++) {
    const hr2di_wall_edge *e = &exact->edge[k], *f = &t->edge[k];
    ck_assert_uint_eq(e->wall, f->wall);
    if (like[e->from] == UINT32_MAX) like[e->from] = f->from;
    if (like[e->to] == UINT32_MAX) like[e->to] = f->to;
    ck_assert(like[e->from] == f->from && like[e->to] == f->to);
  }
}

/* Lattices that were turned, moved far away, made large or small, and jittered have the walls
   and the conflicts of the lattice. */
START_TEST(roundings_change_nothing) {
  randoms r = randoms_stream(test_seed(), 3);
  int refused = 0, whole = 0;
  for (int round = 0; round < test_count(200000); round++) {
    lattice l;
    hr2d_segment wall[MOST];
    hr2di_triangulation exact, t;
    hr2di_conflict conflict, jittered;
    draw_lattice(&r, &l);
    if (random_below(&r, 4)) clear_conflicts(&l);
    move_and_jitter(&r, draw_motion(&r), &l, wall);
    const hr2d_status expected = build(&exact, l.wall, l.count, &conflict);
    const hr2d_status status = build(&t, wall, l.count, &jittered);
    ck_assert_msg(status == expected, "round %d: %d is not %d", round, status, expected);
    if (status) assert_names_conflict(&l, &jittered);
    if (!status || jittered.together) {
      assert_whole(&t, wall, 4 * 0x1p-52 * largest_of(wall, l.count));
      assert_same_paths(&exact, &t);
    }
    *(status ? &refused : &whole) += 1;
    hr2di_triangulation_clear(&exact);
    hr2di_triangulation_clear(&t);
  }
  ck_assert(refused > 0 && whole > 0);
}
END_TEST

/* Small squares on a grid, turned by chance. */
static size_t draw_squares(randoms *r, hr2d_segment *wall, size_t side) {
  size_t n = 0;
  for (size_t i = 0; i < side; i++)
    for (size_t j = 0; j < side; j++) {
      const double turn = random_between(r, 0, 6.28), size = random_between(r, 0.1, 0.49);
      hr2d_point p[4];
      for (int k = 0; k < 4; k++)
        p[k] = (hr2d_point){(double)i + size * cos(turn + k * 1.5707963267948966),
                            (double)j + size * sin(turn + k * 1.5707963267948966)};
      for (int k = 0; k < 4; k++) wall[n++] = (hr2d_segment){p[k], p[(k + 1) % 4]};
    }
  return n;
}

enum { SIDE = 40, SQUARES = 4 * SIDE * SIDE };

START_TEST(squares_are_triangulated) {
  randoms r = randoms_stream(test_seed(), 2);
  static hr2d_segment wall[SQUARES];
  for (int round = 0; round < test_count(20); round++) {
    hr2di_triangulation t;
    hr2di_conflict conflict;
    ck_assert_int_eq(build(&t, wall, draw_squares(&r, wall, SIDE), &conflict), HR2D_OK);
    assert_whole(&t, wall, 0);
    ck_assert_uint_eq(t.vertices, SQUARES + 4);
    ck_assert_uint_eq(t.edges, SQUARES);
    hr2di_triangulation_clear(&t);
  }
}
END_TEST

/* Where a wall gets a vertex: at ends of other walls that were computed to lie on it. */
typedef struct foot {
  size_t wall; /* on which it is meant to lie */
  size_t end;  /* 2·wall + which */
} foot;

static hr2d_point on(const hr2d_segment *s, double t) {
  return (hr2d_point){s->a.x + t * (s->b.x - s->a.x), s->a.y + t * (s->b.y - s->a.y)};
}

static hr2d_point end_of(const hr2d_segment *wall, size_t end) {
  return end % 2 ? wall[end / 2].b : wall[end / 2].a;
}

static double distance(hr2d_point p, const hr2d_segment *s) {
  return fabs(hr2di_orient(s->a, s->b, p)) / hypot(s->b.x - s->a.x, s->b.y - s->a.y);
}

/* They cross, and no end is so near to the other wall that it may be meant to lie on it. */
static int surely_cross(const hr2d_segment *i, const hr2d_segment *j) {
  const hr2d_segment both[2] = {*i, *j};
  const double reach = 4 * 0x1p-52 * largest_of(both, 2);
  int together;
  return conflict_of(i, j, &together) && distance(i->a, j) > reach &&
         distance(i->b, j) > reach && distance(j->a, i) > reach && distance(j->b, i) > reach;
}

static int runs_through(const hr2di_triangulation *t, size_t wall, hr2d_point p, double off) {
  for (uint32_t k = t->edge_of[wall]; k + 1 < t->edge_of[wall + 1]; k++) {
    const hr2d_point q = t->at[t->edge[k].to];
    if (fabs(q.x - p.x) <= off && fabs(q.y - p.y) <= off) return 1;
  }
  return 0;
}

/* Walls from feet on walls to anywhere, each left out if it crosses others. */
START_TEST(rounded_feet_are_joined) {
  randoms r = randoms_stream(test_seed(), 4);
  size_t feet = 0;
  for (int round = 0; round < test_count(20000); round++) {
    hr2d_segment wall[MOST];
    foot at[2 * MOST];
    size_t count = 0, made = 0;
    const double far = random_below(&r, 2) ? random_power(&r, 0, 4) : 0;
    while (count < 3 + (size_t)random_below(&r, MOST - 3)) {
      hr2d_segment s = {{far + random_unit(&r), random_unit(&r)},
                        {far + random_unit(&r), random_unit(&r)}};
      const size_t before = made, host = count ? (size_t)random_below(&r, (int)count) : 0,
                   other = count ? (size_t)random_below(&r, (int)count) : 0;
      if (count > 0) at[made++] = (foot){host, 2 * count};
      if (count > 0) s.a = on(&wall[host], random_unit(&r));
      if (count > 1 && other != host && random_below(&r, 2)) {
        s.b = on(&wall[other], random_unit(&r));
        at[made++] = (foot){other, 2 * count + 1};
      }
      int crosses = hypot(s.b.x - s.a.x, s.b.y - s.a.y) < 0.01;
      for (size_t k = 0; k < count; k++) crosses |= surely_cross(&s, &wall[k]);
      if (crosses)
        made = before;
      else
        wall[count++] = s;
      if (crosses && count > 0 && random_below(&r, 50) == 0) break;
    }
    hr2di_triangulation t;
    hr2di_conflict conflict;
    ck_assert_msg(build(&t, wall, count, &conflict) == HR2D_OK, "round %d: %u and %u %s", round,
                  conflict.wall[0], conflict.wall[1], conflict.together ? "lie" : "cross");
    const double off = 4 * 0x1p-52 * largest_of(wall, count);
    assert_whole(&t, wall, off);
    for (size_t k = 0; k < made; k++) {
      const hr2d_point p = end_of(wall, at[k].end);
      ck_assert_msg(runs_through(&t, at[k].wall, p, off), "round %d: foot %zu", round, k);
    }
    feet += made;
    hr2di_triangulation_clear(&t);
  }
  ck_assert(feet > 0);
}
END_TEST

/* No roundings join what is small but exact: a square of 2^-60 at the origin. */
START_TEST(tiny_walls_keep_their_shape) {
  const double h = 0x1p-60;
  const hr2d_segment wall[] = {{{0, 0}, {h, 0}},  {{h, 0}, {h, h}},  {{h, h}, {0, h}},
                               {{0, h}, {0, 0}},  {{-1, 0}, {0, 0}}, {{h, h}, {1, 1}},
                               {{-1, 1}, {0, h}}, {{0, 0}, {0, -1}}};
  hr2di_triangulation t;
  hr2di_conflict conflict;
  ck_assert_int_eq(build(&t, wall, 8, &conflict), HR2D_OK);
  assert_whole(&t, wall, 0);
  ck_assert_uint_eq(t.vertices, 8 + 4);
  hr2di_triangulation_clear(&t);
}
END_TEST

/* A point, the same point twice, a point on a wall, and one wall alone. */
START_TEST(points_have_no_edges) {
  const hr2d_segment wall[] = {{{2, 1}, {2, 1}}, {{2, 1}, {2, 1}}, {{0, 0}, {4, 2}}};
  hr2di_triangulation t;
  hr2di_conflict conflict;
  for (size_t first = 0; first < 3; first++)
    for (size_t count = 1; first + count <= 3; count++) {
      ck_assert_int_eq(build(&t, wall + first, count, &conflict), HR2D_OK);
      assert_whole(&t, wall + first, 0);
      ck_assert_uint_eq(t.edges, first + count < 3 ? 0 : count == 1 ? 1 : 2);
      hr2di_triangulation_clear(&t);
    }
}
END_TEST

START_TEST(copies_are_named) {
  const hr2d_segment wall[] = {
      {{0, 0}, {1, 0}}, {{3, 1}, {1, 2}}, {{0, 2}, {1, 3}}, {{1, 2}, {3, 1}}, {{3, 1}, {1, 2}}};
  hr2di_triangulation t;
  hr2di_conflict conflict;
  ck_assert_int_eq(build(&t, wall, 5, &conflict), HR2D_ESCENE);
  ck_assert(conflict.together && conflict.wall[0] == 1 && conflict.wall[1] >= 3);
  assert_whole(&t, wall, 0);
  ck_assert_uint_eq(t.edges, 5);
  uint32_t ring = 1;
  for (int k = 0; k < 3; k++) ring = t.edge[ring].same;
  ck_assert_uint_eq(ring, 1);
  ck_assert(t.edge[1].same != 1);
  hr2di_triangulation_clear(&t);
}
END_TEST

/* The pieces of a wall that is cut have later numbers than the walls behind it. */
START_TEST(triangles_know_the_min_of_a_ring) {
  const hr2d_segment wall[] = {
      {{0, 0}, {4, 0}}, {{1, 1}, {1, 0x1p-52}}, {{4, 0}, {1, 0x1p-52}}};
  hr2di_triangulation t;
  hr2di_conflict conflict;
  ck_assert_int_eq(build(&t, wall, 3, &conflict), HR2D_ESCENE);
  ck_assert(conflict.together && conflict.wall[0] == 0 && conflict.wall[1] == 2);
  assert_whole(&t, wall, 0x1p-52);
  ck_assert_uint_eq(t.edge[1].same, 3);
  hr2di_triangulation_clear(&t);
}
END_TEST

/* Half-edges would have no numbers: refused before the walls are looked at. */
START_TEST(too_many_walls_are_refused) {
  const hr2d_segment wall = {{0, 0}, {1, 0}};
  hr2di_triangulation t;
  hr2di_conflict conflict;
  ck_assert_int_eq(build(&t, &wall, (size_t)1 << 28, &conflict), HR2D_ENOMEM);
  hr2di_triangulation_clear(&t);
}
END_TEST

/* A scene in which everything happens: lattices side by side, moved and jittered. */
static size_t draw_all_kinds(randoms *r, hr2d_segment *wall, size_t lattices) {
  lattice all = {.count = 0};
  size_t count = 0;
  for (size_t k = 0; k < lattices; k++) {
    draw_lattice(r, &all);
    clear_conflicts(&all);
    move_and_jitter(r, (motion){0.8, 0.6, 20 * (double)k, 20 * (double)(k % 7)}, &all,
                    wall + count);
    count += all.count;
  }
  return count;
}

/* Each allocation fails in turn, once and from then on. */
START_TEST(memory_may_run_out) {
  randoms r = randoms_stream(test_seed(), 5);
  hr2d_segment wall[20 * 12];
  const size_t count = draw_all_kinds(&r, wall, 20);
  hr2d_status status = HR2D_ENOMEM;
  for (long k = 0; status == HR2D_ENOMEM; k++) {
    test_memory memory = {.until_failure = k, .for_good = _i};
    const hr2d_allocator hooks = test_hooks(&memory);
    hr2di_triangulation t;
    hr2di_conflict conflict;
    status = hr2di_triangulation_init(&t, &hooks, wall, count, sizeof *wall, HR2DI_UNITS,
                                      &conflict, NULL);
    ck_assert_int_eq(status, memory.failures ? HR2D_ENOMEM : HR2D_OK);
    hr2di_triangulation_clear(&t);
    ck_assert_int_eq(memory.live, 0);
    ck_assert(status == HR2D_ENOMEM || k > 20);
  }
}
END_TEST

enum { REFUSAL = 77 };

typedef struct witness {
  unsigned long asks, stop_at;
} witness;

static hr2d_status ask(void *ctx, const hr2d_progress *progress) {
  witness *w = ctx;
  (void)progress;
  return ++w->asks == w->stop_at ? (hr2d_status)REFUSAL : HR2D_OK;
}

static hr2d_status watched(const hr2d_segment *wall, size_t count, witness *w, uint64_t span,
                           uint64_t *max) {
  test_memory memory = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&memory);
  hr2di_watch watch;
  hr2di_triangulation t;
  hr2di_conflict conflict;
  hr2di_watch_init(&watch, ask, w, "triangulation");
  watch.span = span;
  const hr2d_status status = hr2di_triangulation_init(&t, &hooks, wall, count, sizeof *wall,
                                                      HR2DI_UNITS, &conflict, &watch);
  hr2di_triangulation_clear(&t);
  ck_assert_int_eq(memory.live, 0);
  *max = watch.max;
  return status;
}

/* It can be stopped at each question, and questions are often enough. */
START_TEST(it_can_be_stopped) {
  randoms r = randoms_stream(test_seed(), 6);
  static hr2d_segment wall[SQUARES];
  const size_t count = draw_squares(&r, wall, SIDE);
  witness all = {0};
  uint64_t max;
  ck_assert_int_eq(watched(wall, count, &all, HR2DI_WATCH_SPAN, &max), HR2D_OK);
  ck_assert(max < 2 * HR2DI_WATCH_SPAN && all.asks > SQUARES / 1000);
  for (unsigned long k = 1; k <= all.asks; k++) {
    witness w = {.stop_at = k};
    ck_assert_int_eq(watched(wall, count, &w, HR2DI_WATCH_SPAN, &max), REFUSAL);
    ck_assert_uint_eq(w.asks, k);
  }
  hr2d_segment kinds[20 * 12];
  const size_t few = draw_all_kinds(&r, kinds, 20);
  witness every = {0};
  ck_assert_int_eq(watched(kinds, few, &every, 1, &max), HR2D_OK);
  for (unsigned long k = 1; k <= every.asks; k += 1 + k / 100) {
    witness w = {.stop_at = k};
    ck_assert_int_eq(watched(kinds, few, &w, 1, &max), REFUSAL);
  }
}
END_TEST

/* One thing that a triangulation may have wrong. */
static void corrupt(randoms *r, hr2di_triangulation *t, int kind) {
  hr2di_triangle *k = &t->triangle[random_below(r, (int)t->triangles)];
  hr2di_wall_edge *e = &t->edge[random_below(r, (int)t->edges)];
  const int side = random_below(r, 3);
  const uint32_t corner = k->corner[0];
  switch (kind) {
  case 0: /* a twin */
    while (k->across[0] < 0) k = &t->triangle[random_below(r, (int)t->triangles)];
    k->across[0] = k->across[0] >> 2 ? (k->across[0] & 3) : 4 + (k->across[0] & 3);
    break;
  case 1: /* orientation */
    k->corner[0] = k->corner[1];
    k->corner[1] = corner;
    break;
  case 2: /* the owner of an edge */
    e->wall = e->wall ? e->wall - 1 : e->wall + 1;
    break;
  case 3: /* a side of an edge */
    e->half_edge[side & 1] = e->half_edge[!(side & 1)];
    break;
  case 4: /* a wall that the triangle does not know */
    t->triangle[e->half_edge[0] >> 2].across[e->half_edge[0] & 3] = e->half_edge[1];
    t->triangle[e->half_edge[1] >> 2].across[e->half_edge[1] & 3] = e->half_edge[0];
    break;
  case 5: /* an end of an edge */
    e->to = e->to ? e->to - 1 : 1;
    break;
  case 6: /* a vertex that moved */
    t->at[e->from].x += 1;
    break;
  case 7: /* an edge that is missing */
    t->edges--;
    break;
  case 8: /* the sky inside */
    while (k->across[side] == HR2DI_SKY) k = &t->triangle[random_below(r, (int)t->triangles)];
    k->across[side] = HR2DI_SKY;
    break;
  case 9: /* where the sky begins */
    t->sky--;
    break;
  case 10: /* a pocket in the hull: the first vertex of the box among those of the walls */
    t->at[t->vertices - 5] = t->at[t->vertices - 4];
    break;
  default: /* a ring */
    e->same = e->same ? 0 : 1;
  }
}

/* The checker notices each kind of damage. */
START_TEST(damage_is_noticed) {
  randoms r = randoms_stream(test_seed(), 7 + _i);
  hr2d_segment wall[4 * 25];
  for (int round = 0; round < 50; round++) {
    hr2di_triangulation t;
    hr2di_conflict conflict;
    ck_assert_int_eq(build(&t, wall, draw_squares(&r, wall, 5), &conflict), HR2D_OK);
    assert_whole(&t, wall, 0);
    corrupt(&r, &t, _i);
    const char *fault = triangulation_fault(&t, wall, sizeof *wall, 0);
    ck_assert_msg(fault != NULL, "damage %d is not noticed", _i);
    hr2di_triangulation_clear(&t);
  }
}
END_TEST

/* The pocket of a shallow dish of many walls is filled from all places at once: of the
   triangles behind one wall, across the longer side of each, there are few. */
START_TEST(pockets_are_shallow) {
  enum { WALLS = 4096 };
  static hr2d_segment wall[WALLS];
  hr2di_triangulation t;
  hr2di_conflict conflict;
  int deepest = 0;
  for (int k = 0; k < WALLS; k++) {
    const double x = k - WALLS / 2, y = x + 1;
    wall[k] = (hr2d_segment){{x, 0x1p-20 * x * x}, {y, 0x1p-20 * y * y}};
  }
  ck_assert_int_eq(build(&t, wall, WALLS, &conflict), HR2D_OK);
  assert_whole(&t, wall, 0);
  for (size_t k = 0; k < t.edges; k++) {
    int32_t h = t.edge[k].half_edge[0]; /* inside the dish */
    int crossed = 0;
    for (; t.triangle[h >> 2].corner[((h & 3) + 2) % 3] < t.sky; crossed++) {
      const hr2di_triangle *at = &t.triangle[h >> 2];
      const int right = ((h & 3) + 1) % 3, left = ((h & 3) + 2) % 3;
      const hr2d_point v = t.at[at->corner[left]], r = t.at[at->corner[right]],
                       l = t.at[at->corner[h & 3]];
      h = at->across[fabs(v.x - r.x) > fabs(v.x - l.x) ? right : left];
      ck_assert_int_ge(h, 0);
    }
    deepest = crossed > deepest ? crossed : deepest;
  }
  printf("at most %d triangles behind %d walls\n", deepest, WALLS);
  ck_assert_int_le(deepest, 24);
  hr2di_triangulation_clear(&t);
}
END_TEST

TEST_SUITE("triangulation") {
  ADD_TESTS("exact", lattices_are_triangulated_exactly, squares_are_triangulated,
            points_have_no_edges, copies_are_named, triangles_know_the_min_of_a_ring,
            pockets_are_shallow);
  ADD_TESTS("roundings", roundings_change_nothing, rounded_feet_are_joined,
            tiny_walls_keep_their_shape);
  ADD_TESTS("failures", too_many_walls_are_refused, it_can_be_stopped);
  REPEAT_TESTS(2, "memory", memory_may_run_out);
  REPEAT_TESTS(12, "checker", damage_is_noticed);
}
