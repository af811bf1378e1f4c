/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One class of lines: its measure against strings of many digits, and what is left of it when
   an end is moved against the definition, by all pairs of points.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the classes. */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "beams/line-class-list.h"
#include "beams/line-class.h"
#include "independent/mpfr-exchange.h"
#include "support/plane.h"
#include "support/support.h"
#include "support/visibility-cases.h"

enum { MOST = 40, PARTS = 8 };

/* The points that the lines of a class leave on their left and on their right: a and d, b and c
   first, then ends of what is in the way. */
typedef struct definition {
  hr2d_point left[MOST], right[MOST];
  int lefts, rights;
} definition;

/* A class found by the definition. */
typedef struct found {
  hr2d_point left[MOST], right[MOST];
  hr2di_line_class line_class;
} found;

/* Whether the line from p to q has all points of the sets on their sides. */
static int separates(const definition *d, hr2d_point p, hr2d_point q) {
  for (int k = 0; k < d->lefts; k++)
    if (hr2d_orientation(p, q, d->left[k]) < 0) return 0;
  for (int k = 0; k < d->rights; k++)
    if (hr2d_orientation(p, q, d->right[k]) > 0) return 0;
  return 1;
}

/* Whether the segment pq is shorter than rs, for segments of one line. */
static int shorter(hr2d_point p, hr2d_point q, hr2d_point r, hr2d_point s) {
  return fabs(q.x - p.x) + fabs(q.y - p.y) < fabs(s.x - r.x) + fabs(s.y - r.y);
}

/* The tangents, each with the contacts that are nearest to each other; 0 if there is none. */
static int tangents(const definition *d, int contact[2][2]) {
  int count[2] = {0, 0};
  for (int l = 0; l < d->lefts; l++)
    for (int r = 0; r < d->rights; r++)
      for (int kind = 0; kind < 2; kind++) {
        const hr2d_point p = d->left[l], q = d->right[r];
        if (plane_same(p, q) || !(kind ? separates(d, q, p) : separates(d, p, q))) continue;
        if (count[kind]++ &&
            !shorter(p, q, d->left[contact[kind][0]], d->right[contact[kind][1]]))
          continue;
        contact[kind][0] = l;
        contact[kind][1] = r;
      }
  return count[0] > 0 && count[1] > 0;
}

/* The hull of `point` from one of its points to another, seen from the side `hand`: 1 for a
   chain that turns left. */
static size_t hull(const hr2d_point *point, int count, hr2d_point from, hr2d_point to, int hand,
                   hr2d_point *chain) {
  size_t n = 0;
  for (chain[n++] = from; !plane_same(chain[n - 1], to); n++) {
    const hr2d_point last = chain[n - 1];
    hr2d_point next = to;
    for (int k = 0; k < count; k++) {
      const int side = hand * hr2d_orientation(last, next, point[k]);
      if (plane_same(point[k], last)) continue;
      if (side < 0 ||
          (side == 0 && !plane_same(next, to) && shorter(last, next, last, point[k])))
        next = point[k];
    }
    ck_assert_uint_lt(n, MOST);
    chain[n] = next;
  }
  return n;
}

static unsigned ends_of(const definition *d, const found *f) {
  const hr2di_line_class *s = &f->line_class;
  return (plane_same(s->left[0], d->left[0]) ? HR2DI_LINE_CLASS_A : 0u) |
         (plane_same(s->right[0], d->right[0]) ? HR2DI_LINE_CLASS_B : 0u) |
         (plane_same(s->right[s->rights - 1], d->right[1]) ? HR2DI_LINE_CLASS_C : 0u) |
         (plane_same(s->left[s->lefts - 1], d->left[1]) ? HR2DI_LINE_CLASS_D : 0u);
}

static int find(const definition *d, found *f) {
  int contact[2][2];
  if (!tangents(d, contact)) return 0;
  const hr2d_point l0 = d->left[contact[0][0]], r1 = d->right[contact[0][1]];
  const hr2d_point l1 = d->left[contact[1][0]], r0 = d->right[contact[1][1]];
  /* The hulls touch: one line is left, which has no measure. */
  if (hr2d_orientation(l0, r1, l1) == 0 && hr2d_orientation(l0, r1, r0) == 0) return 0;
  f->line_class = (hr2di_line_class){.left = f->left, .right = f->right};
  f->line_class.lefts = hull(d->left, d->lefts, l0, l1, 1, f->left);
  f->line_class.rights = hull(d->right, d->rights, r0, r1, -1, f->right);
  f->line_class.ends = ends_of(d, f);
  return 1;
}

static void add_distance(mpfr_t sum, hr2d_point p, hr2d_point q, int sign) {
  mpfr_t distance;
  mpfr_init(distance);
  mpfr_distance(distance, p, q);
  (sign > 0 ? mpfr_add : mpfr_sub)(sum, sum, distance, MPFR_RNDN);
  mpfr_clear(distance);
}

/* Crossed minus uncrossed strings, halved. */
static void strings(mpfr_t area, const hr2di_line_class *s) {
  mpfr_init2(area, 300);
  mpfr_set_zero(area, 1);
  add_distance(area, s->left[0], s->right[s->rights - 1], 1);
  add_distance(area, s->right[0], s->left[s->lefts - 1], 1);
  for (size_t k = 1; k < s->lefts; k++) add_distance(area, s->left[k - 1], s->left[k], -1);
  for (size_t k = 1; k < s->rights; k++) add_distance(area, s->right[k - 1], s->right[k], -1);
  mpfr_div_2ui(area, area, 1, MPFR_RNDN);
}

static double strings_of(const hr2di_line_class *s) {
  mpfr_t area;
  strings(area, s);
  const double value = mpfr_get_d(area, MPFR_RNDN);
  mpfr_clear(area);
  return value;
}

/* Two segments on a grid that face each other, perhaps in part, and points between them; a line
   from one to the other says on which side each of these is.  All ends of PARTS equal parts of
   the segments are on the grid. */
typedef struct scene {
  hr2d_segment i, j;
  definition d;
} scene;

static hr2d_point grid(randoms *r, int width, int from, int height) {
  return (hr2d_point){random_below(r, width + 1), from + random_below(r, height + 1)};
}

static hr2d_segment stretched(hr2d_point a, hr2d_point b) {
  return (hr2d_segment){{PARTS * a.x, PARTS * a.y}, {PARTS * b.x, PARTS * b.y}};
}

static void draw_segments(randoms *r, int width, scene *s) {
  do {
    s->i = stretched(grid(r, width, 0, 1), grid(r, width, 0, 1));
    s->j = stretched(grid(r, width, 4, 2), grid(r, width, 4, 2));
  } while (!(hr2d_exchange_area(&s->i, &s->j) > 0));
}

static void draw_scene(randoms *r, scene *s) {
  const int width = 2 + random_below(r, 8), points = random_below(r, 12);
  draw_segments(r, width, s);
  s->d = (definition){{s->i.a, s->j.b}, {s->i.b, s->j.a}, 2, 2};
  hr2d_point p, q;
  do {
    p = plane_along(s->i, random_unit(r));
    q = plane_along(s->j, random_unit(r));
  } while (plane_det(s->i.a, s->i.b, q) <= 0 || plane_det(s->j.a, s->j.b, p) <= 0);
  for (int k = 0; k < points; k++) {
    const hr2d_point v = grid(r, PARTS * width, PARTS, 3 * PARTS);
    if (plane_det(p, q, v) > 0)
      s->d.left[s->d.lefts++] = v;
    else
      s->d.right[s->d.rights++] = v;
  }
}

static hr2d_segment part(hr2d_segment s, int first, int last) {
  return (hr2d_segment){plane_along(s, (double)first / PARTS),
                        plane_along(s, (double)last / PARTS)};
}

/* Moves one of the ends of the definition, and of the line class. */
static int move(definition *d, hr2di_line_class_end end, hr2d_point x,
                const hr2di_line_class *s, hr2d_point *room, hr2di_line_class *child) {
  switch (end) {
  case HR2DI_LINE_CLASS_A:
    d->left[0] = x;
    break;
  case HR2DI_LINE_CLASS_B:
    d->right[0] = x;
    break;
  case HR2DI_LINE_CLASS_C:
    d->right[1] = x;
    break;
  default:
    d->left[1] = x;
  }
  return hr2di_line_class_restrict(s, end, x, room, child);
}

/* Lines that come from behind may separate the same points. */
static int faces(const definition *d) {
  const hr2d_segment near = {d->left[0], d->right[0]}, far = {d->right[1], d->left[1]};
  return hr2d_exchange_area(&near, &far) > 0;
}

typedef struct tally {
  int moved, empty, clear;
  double worst;
} tally;

/* Moves all four ends, in any order, and compares at each step. */
static void narrow(randoms *r, scene *s, const found *f, tally *count) {
  const hr2d_segment i = part(s->i, random_below(r, 4), 4 + random_below(r, 5));
  const hr2d_segment j = part(s->j, random_below(r, 4), 4 + random_below(r, 5));
  const struct {
    hr2di_line_class_end end;
    hr2d_point x;
  } moves[] = {{HR2DI_LINE_CLASS_A, i.a},
               {HR2DI_LINE_CLASS_B, i.b},
               {HR2DI_LINE_CLASS_C, j.a},
               {HR2DI_LINE_CLASS_D, j.b}};
  hr2d_point room[4][2 * MOST];
  hr2di_line_class line_class = f->line_class;
  const int start = random_below(r, 4), step = random_below(r, 2) ? 1 : 3;
  for (int k = 0; k < 4; k++) {
    const int m = (start + k * step) % 4;
    hr2di_line_class child;
    found expected;
    const int lines = move(&s->d, moves[m].end, moves[m].x, &line_class, room[k], &child);
    const double area =
        faces(&s->d) && find(&s->d, &expected) ? strings_of(&expected.line_class) : 0;
    count->moved++;
    if (!lines) {
      count->empty++;
      ck_assert_double_le(fabs(area), 1e-13);
      return;
    }
    ck_assert_double_gt(area, 1e-13);
    const double error = fabs(hr2di_line_class_area(&child) - area);
    count->worst = fmax(count->worst, error);
    ck_assert_double_le(error, 1e-13);
    if (hr2di_line_class_clear(&child)) {
      const hr2d_segment near = {s->d.left[0], s->d.right[0]};
      const hr2d_segment far = {s->d.right[1], s->d.left[1]};
      count->clear++;
      ck_assert_double_le(fabs(hr2d_exchange_area(&near, &far) - area), 1e-13);
    }
    line_class = child;
  }
}

START_TEST(moved_ends_leave_what_the_definition_says) {
  randoms r = randoms_stream(test_seed(), 1);
  tally count = {0};
  for (int k = test_count(100000); k > 0; k--) {
    scene s;
    found f;
    draw_scene(&r, &s);
    if (find(&s.d, &f)) narrow(&r, &s, &f, &count);
  }
  printf("%d moves, %d leave nothing, %d a clear view, worst error %.1e\n", count.moved,
         count.empty, count.clear, count.worst);
  ck_assert_int_gt(count.empty, count.moved / 100);
  ck_assert_int_gt(count.clear, count.moved / 100);
}
END_TEST

/* A point of the line of s outside of s, where a wall in line with it may end. */
static hr2d_point in_line(randoms *r, hr2d_segment s) {
  const double off = (double)(1 + random_below(r, 3 * PARTS)) / PARTS;
  return plane_along(s, random_below(r, 2) ? 1 + off : -off);
}

static int is_on(hr2d_segment s, hr2d_point v) {
  const hr2d_point u = {s.b.x - s.a.x, s.b.y - s.a.y};
  const double at = (v.x - s.a.x) * u.x + (v.y - s.a.y) * u.y;
  return plane_det(s.a, s.b, v) == 0 && at >= 0 && at <= u.x * u.x + u.y * u.y;
}

static hr2d_point rounded(randoms *r, similarity turn, hr2d_point v) {
  const hr2d_point p = similar_point(turn, v);
  return (hr2d_point){random_nudge(r, p.x, 1), random_nudge(r, p.y, 1)};
}

/* Whether points behind the first two, the ends of i and j, can be touched: lines between i and
   j touch what is in front of both. */
static int in_front(const hr2d_point *point, int count, hr2d_segment i, hr2d_segment j) {
  int front = 1;
  for (int k = 2; k < count; k++)
    front &=
        hr2d_orientation(i.a, i.b, point[k]) > 0 && hr2d_orientation(j.a, j.b, point[k]) > 0;
  return front;
}

/* Adds points in line with i and j, turns all and moves each point by a rounding.  Returns 0 if
   a point is then behind i or j, or was on one of them. */
static int round_scene(randoms *r, similarity turn, scene *s) {
  int apart = 1;
  for (int k = random_below(r, 5); k > 0; k--) {
    const hr2d_point v = in_line(r, random_below(r, 2) ? s->i : s->j);
    if (random_below(r, 2))
      s->d.left[s->d.lefts++] = v;
    else
      s->d.right[s->d.rights++] = v;
  }
  for (int side = 0; side < 2; side++) {
    hr2d_point *point = side ? s->d.right : s->d.left;
    for (int k = 0; k < (side ? s->d.rights : s->d.lefts); k++) {
      apart &= k < 2 || !(is_on(s->i, point[k]) || is_on(s->j, point[k]));
      point[k] = rounded(r, turn, point[k]);
    }
  }
  s->i = (hr2d_segment){s->d.left[0], s->d.right[0]};
  s->j = (hr2d_segment){s->d.right[1], s->d.left[1]};
  return apart && in_front(s->d.left, s->d.lefts, s->i, s->j) &&
         in_front(s->d.right, s->d.rights, s->i, s->j);
}

/* The area of what is left when an end is moved. */
static double area_of_part(const hr2di_line_class *s, hr2di_line_class_end end, hr2d_point x) {
  hr2d_point room[2 * MOST];
  hr2di_line_class child;
  return hr2di_line_class_restrict(s, end, x, room, &child) ? hr2di_line_class_area(&child) : 0;
}

/* All points of a line class may lie within roundings of the line of i or j, and the point
   where that is cut does, too. */
START_TEST(parts_add_up_within_roundings) {
  randoms r = randoms_stream(test_seed(), 4);
  int thin = 0, count = 0;
  double worst = 0;
  for (size_t k = test_rounds(300000, 20000); k > 0; k--) {
    scene s;
    found f;
    const double angle = random_between(&r, 0, 6.3);
    const similarity turn = {.u = cos(angle), .v = sin(angle)};
    draw_scene(&r, &s);
    const int far = random_below(&r, 2);
    const hr2d_point x =
        plane_along(far ? s.j : s.i, (double)(1 + random_below(&r, PARTS - 1)) / PARTS);
    if (!round_scene(&r, turn, &s) || !find(&s.d, &f)) continue;
    const hr2d_point at = rounded(&r, turn, x);
    const double whole = hr2di_line_class_area(&f.line_class);
    const double first =
        area_of_part(&f.line_class, far ? HR2DI_LINE_CLASS_C : HR2DI_LINE_CLASS_A, at);
    const double second =
        area_of_part(&f.line_class, far ? HR2DI_LINE_CLASS_D : HR2DI_LINE_CLASS_B, at);
    worst = fmax(worst, fabs(first + second - whole));
    thin += whole < 1e-12;
    count++;
    ck_assert_msg(fabs(first + second - whole) <= 1e-12, "%g and %g of %g", first, second,
                  whole);
  }
  printf("%d sights, %d thin ones, parts off by %.1e\n", count, thin, worst);
  ck_assert_int_gt(thin, 0);
}
END_TEST

/* Points on two parabolas that nearly touch: chains of many points, and areas far below the
   roundings of strings. */
static void draw_slit(randoms *r, found *f) {
  const double bend = random_power(r, -6, 0), gap = random_power(r, -12, 0);
  const double turn = random_between(r, 0, 6.3), c = cos(turn), s = sin(turn);
  definition d = {.lefts = 2 + random_below(r, 12), .rights = 2 + random_below(r, 12)};
  for (int side = 0; side < 2; side++)
    for (int k = 0; k < (side ? d.rights : d.lefts); k++) {
      const double y = k == 0   ? 0
                       : k == 1 ? 1
                                : random_unit(r),
                   out = bend * (y - .5) * (y - .5);
      const double x = side ? gap + out : -out;
      (side ? d.right : d.left)[k] = (hr2d_point){c * x - s * y, s * x + c * y};
    }
  ck_assert(find(&d, f));
}

START_TEST(areas_are_those_of_strings) {
  randoms r = randoms_stream(test_seed(), 2);
  double worst = 0, min = 1;
  int long_chains = 0, naive = 0;
  for (int k = test_count(20000); k > 0; k--) {
    found f;
    mpfr_t exact;
    draw_slit(&r, &f);
    strings(exact, &f.line_class);
    const double area = hr2di_line_class_area(&f.line_class),
                 value = mpfr_get_d(exact, MPFR_RNDN);
    const double error = mpfr_relative_error(area, exact);
    worst = fmax(worst, error);
    min = fmin(min, area);
    long_chains += f.line_class.lefts > 2 || f.line_class.rights > 2;
    /* Negative control: strings in doubles lose the digits. */
    double sum = 0;
    for (size_t m = 1; m < f.line_class.lefts; m++)
      sum -= plane_distance(f.line_class.left[m - 1], f.line_class.left[m]);
    for (size_t m = 1; m < f.line_class.rights; m++)
      sum -= plane_distance(f.line_class.right[m - 1], f.line_class.right[m]);
    sum += plane_distance(f.line_class.left[0], f.line_class.right[f.line_class.rights - 1]) +
           plane_distance(f.line_class.right[0], f.line_class.left[f.line_class.lefts - 1]);
    naive += fabs(sum / 2 - value) > 1e-6 * value;
    mpfr_clear(exact);
  }
  printf("areas from %.1e on, %d of longer chains, worst relative error %.1e\n", min,
         long_chains, worst);
  ck_assert_double_le(worst, 8e-15);
  ck_assert_int_gt(long_chains, 0);
  ck_assert_int_gt(naive, 0);
}
END_TEST

/* Coordinates far below all others: determinants of which nothing is left but the last bits. */
START_TEST(areas_near_underflow) {
  const hr2d_point left[] = {{0x1.5cc0642ffd354p+2, -0x1.76daea0977e4cp+2},
                             {0x1.05904b23fde7fp+5, -0x1.19242f8719eb9p+5}};
  hr2d_point right[] = {{0, 0},
                        {0x1.2de506eece38ap+3, -0x1.a272f68f778b8p+3},
                        {0x1.ad69dbc59dd69p+4, -0x1.44bc3c0d19923p+5}};
  const hr2di_line_class s = {left, right, 2, 3, 15};
  const double expected = strings_of(&s);
  for (int e = -1074; e < -60; e++) {
    right[0].y = -ldexp(1, e);
    ck_assert_double_le(fabs(hr2di_line_class_area(&s) - expected), 1e-15);
  }
}
END_TEST

START_TEST(turned_round_it_is_the_same) {
  randoms r = randoms_stream(test_seed(), 3);
  for (int k = test_count(10000); k > 0; k--) {
    scene s;
    found f;
    hr2d_point room[2][2 * MOST];
    hr2di_line_class turned, back;
    draw_scene(&r, &s);
    if (!find(&s.d, &f)) continue;
    hr2di_line_class_turn(&f.line_class, room[0], &turned);
    hr2di_line_class_turn(&turned, room[1], &back);
    ck_assert_double_le(
        fabs(hr2di_line_class_area(&turned) - hr2di_line_class_area(&f.line_class)), 1e-13);
    ck_assert_int_eq(hr2di_line_class_clear(&turned), hr2di_line_class_clear(&f.line_class));
    ck_assert_uint_eq(back.ends, f.line_class.ends);
    ck_assert_mem_eq(back.left, f.line_class.left, f.line_class.lefts * sizeof *back.left);
    ck_assert_mem_eq(back.right, f.line_class.right, f.line_class.rights * sizeof *back.right);
  }
}
END_TEST

/* Blocks that end with a mark. */
enum { HEAD = 16, MARK = 0x5a };

static void check_mark(unsigned char *block) {
  size_t size;
  memcpy(&size, block, sizeof size);
  for (size_t k = 0; k < HEAD; k++) ck_assert_uint_eq(block[HEAD + size + k], MARK);
}

static void *marked_reallocate(void *ctx, void *old, size_t size) {
  (void)ctx;
  unsigned char *before = old ? (unsigned char *)old - HEAD : NULL;
  if (before) check_mark(before);
  unsigned char *block = realloc(before, size + 2 * HEAD);
  ck_assert_ptr_nonnull(block);
  memcpy(block, &size, sizeof size);
  memset(block + HEAD + size, MARK, HEAD);
  return block + HEAD;
}

static void *marked_allocate(void *ctx, size_t size) {
  return marked_reallocate(ctx, NULL, size);
}

static void marked_release(void *ctx, void *old) {
  (void)ctx;
  if (!old) return;
  check_mark((unsigned char *)old - HEAD);
  free((unsigned char *)old - HEAD);
}

/* The middles of two plates: each of four steps adds a point, from wherever the list has ended
   in its room. */
START_TEST(steps_stay_in_their_room) {
  static const hr2d_segment near = {{0, 0}, {1, 0}}, far = {{1, 1}, {0, 1}};
  static const hr2d_segment mid = {{0.25, 0}, {0.75, 0}}, of_far = {{0.75, 1}, {0.25, 1}};
  static const hr2d_point left[] = {{0.1, 0.5}}, right[] = {{0.9, 0.5}};
  const hr2d_allocator hooks = {
      .allocate = marked_allocate, .reallocate = marked_reallocate, .release = marked_release};
  for (size_t before = 0; before < 200; before++) {
    hr2di_line_class_list from = {.alloc = hooks}, to = {.alloc = hooks};
    const hr2di_line_class s = {left, right, 1, 1, 0};
    ck_assert_int_eq(hr2di_line_class_list_add(&from, &s, near, far), HR2D_OK);
    for (size_t k = 0; k < before; k++)
      ck_assert_int_eq(hr2di_line_class_list_add(&to, &s, near, far), HR2D_OK);
    ck_assert_int_eq(hr2di_line_class_list_restrict(&to, &from, 0, 1, mid, of_far, NULL),
                     HR2D_OK);
    ck_assert_uint_eq(to.count, before + 1);
    ck_assert_uint_ge(to.line_class[before].lefts + to.line_class[before].rights, 2);
    hr2di_line_class_list_clear(&from);
    hr2di_line_class_list_clear(&to);
  }
}
END_TEST

TEST_SUITE("sight") {
  ADD_TESTS("sight", moved_ends_leave_what_the_definition_says, parts_add_up_within_roundings,
            areas_are_those_of_strings, areas_near_underflow, turned_round_it_is_the_same,
            steps_stay_in_their_room);
}
