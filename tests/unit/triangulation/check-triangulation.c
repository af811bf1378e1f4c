/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangulations of walls against the checker and against exact tests of all pairs. */
#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "support/support.h"
#include "triangulation/check.h"
#include "triangulation/triangulation.h"

enum { MOST = 64 };

static hr2d_status build(hr2di_triangulation *t, const hr2d_segment *wall, size_t count,
                         hr2di_conflict *conflict) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  return hr2di_triangulation_init(t, &alloc, wall, count, sizeof *wall, conflict, NULL);
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
  const char *fault = hr2di_triangulation_fault(t, wall, sizeof *wall, off);
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
  double most = 0;
  for (size_t k = 0; k < count; k++)
    most = fmax(most, fmax(fmax(fabs(wall[k].a.x), fabs(wall[k].a.y)),
                           fmax(fabs(wall[k].b.x), fabs(wall[k].b.y))));
  return most;
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
if(exact->edges!=t->edges){for(int q=0;q<2;q++){const hr2di_triangulation*z=q?t:exact;for(size_t k=0;k<z->edges;k++)printf("w%u: %u(%.17g,%.17g)->%u(%.17g,%.17g) same %u\n",z->edge[k].wall,z->edge[k].from,z->at[z->edge[k].from].x,z->at[z->edge[k].from].y,z->edge[k].to,z->at[z->edge[k].to].x,z->at[z->edge[k].to].y,z->edge[k].same);}}
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
      const double turn = random_between(r, 0, 6.28), size = random_between(r, 0.1, 0.6);
      hr2d_point p[4];
      for (int k = 0; k < 4; k++)
        p[k] = (hr2d_point){(double)i + size * cos(turn + k * 1.5707963267948966),
                            (double)j + size * sin(turn + k * 1.5707963267948966)};
      for (int k = 0; k < 4; k++) wall[n++] = (hr2d_segment){p[k], p[(k + 1) % 4]};
    }
  return n;
}

START_TEST(squares_are_triangulated) {
  randoms r = randoms_stream(test_seed(), 2);
  enum { SIDE = 60 };
  hr2d_segment *wall = malloc(4 * SIDE * SIDE * sizeof *wall);
  ck_assert(wall != NULL);
  for (int round = 0; round < test_count(20); round++) {
    const size_t count = draw_squares(&r, wall, SIDE);
    hr2di_triangulation t;
    hr2di_conflict conflict;
    const hr2d_status status = build(&t, wall, count, &conflict);
    if (status == HR2D_OK) {
      const char *fault = hr2di_triangulation_fault(&t, wall, sizeof *wall, 0);
      ck_assert_msg(!fault, "%s", fault);
    }
    hr2di_triangulation_clear(&t);
  }
  free(wall);
}
END_TEST

TEST_SUITE("triangulation") {
  ADD_TESTS("triangulation", lattices_are_triangulated_exactly, roundings_change_nothing,
            squares_are_triangulated);
}
