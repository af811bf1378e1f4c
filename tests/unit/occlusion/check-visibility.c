/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas around occluders against brute force, closed forms and each other.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the pairs. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "independent/brute-visibility.h"
#include "support/plane.h"
#include "support/support.h"
#include "support/visibility-cases.h"

/* The required accuracy, relative to the shorter patch. */
#define BAR 1e-11
/* The measured accuracy, relative to the longest length.  Points within four ulps of a line
   count as lying on it, and lines may meet at shallow angles. */
#define ROUNDINGS 0x1p-46

static double shorter(const occluded_pair *p) {
  return fmin(plane_length(p->i), plane_length(p->j));
}

static double longest(const occluded_pair *p) {
  double max = fmax(plane_length(p->i), plane_length(p->j));
  max = fmax(max, hypot(p->i.a.x - p->j.a.x, p->i.a.y - p->j.a.y));
  for (size_t k = 0; k < p->count; k++) max = fmax(max, plane_length(p->occluder[k]));
  return max;
}

static double area_of(const occluded_pair *p) {
  return exchange_among(p->i, p->j, p->occluder, p->count);
}

static double strings_of(const occluded_pair *p) {
  return brute_strings(&p->i, &p->j, p->occluder, p->count);
}

/* The pairs of a class that a test draws, the same for the same test. */
typedef struct draws {
  const occluded_class *class;
  randoms r;
  int left;
  occluded_pair pair;
  double worst; /* of the errors that the test measures */
  occluded_pair at;
} draws;

static draws start(int class, int test, int count) {
  return (draws){.class = &occluded_classes[class],
                 .r = randoms_stream(test_seed(), 100 * test + class),
                 .left = test_count(count)};
}

static int draw(draws *d) {
  if (d->left-- <= 0) return 0;
  draw_occluded(d->class, &d->r, &d->pair);
  return 1;
}

static void note(draws *d, double error) {
  if (error <= d->worst) return;
  d->worst = error;
  d->at = d->pair;
}

static void finish(const draws *d, const char *what, double bar) {
  printf("%-18s %-24s worst %.2e\n", d->class->name, what, d->worst);
  if (d->worst <= bar) return;
  print_occluded(&d->at);
  ck_abort_msg("%s: %s: %g is above %g", d->class->name, what, d->worst, bar);
}

/* The references against each other.  Two of them share the view from a point, but not the
   sum over points; the lines share nothing. */
START_TEST(references_agree) {
  draws d = start(_i, 0, 100);
  double sigmas = 0;
  while (draw(&d)) {
    const occluded_pair *p = &d.pair;
    double estimate, sigma;
    const double area = strings_of(p);
    const double q = brute_quadrature(&p->i, &p->j, p->occluder, p->count, &estimate);
    const double back = brute_strings(&p->j, &p->i, p->occluder, p->count);
    const double lines = brute_lines(&p->i, &p->j, p->occluder, p->count, &d.r, 20000, &sigma);
    note(&d, fmax(fmax(fabs(q - area), estimate / 100), fabs(back - area)) / shorter(p));
    sigmas = fmax(sigmas, fabs(lines - area) / sigma);
  }
  ck_assert_double_lt(sigmas, 6);
  finish(&d, "reference, to reference", 1e-14);
}
END_TEST

START_TEST(agrees_with_quadrature) {
  draws d = start(_i, 1, 60);
  while (draw(&d)) {
    const occluded_pair *p = &d.pair;
    const double brute = brute_quadrature(&p->i, &p->j, p->occluder, p->count, NULL);
    note(&d, fabs(area_of(p) - brute) / shorter(p));
  }
  finish(&d, "to quadrature", BAR);
}
END_TEST

START_TEST(agrees_with_strings) {
  draws d = start(_i, 2, 2000), e = d;
  while (draw(&d)) {
    const double area = area_of(&d.pair), error = fabs(area - strings_of(&d.pair));
    ck_assert_double_ge(area, 0);
    note(&d, error / longest(&d.pair));
    e.pair = d.pair;
    note(&e, error / shorter(&d.pair));
  }
  finish(&e, "to strings, shorter", BAR);
  finish(&d, "to strings, longest", ROUNDINGS);
}
END_TEST

/* Negative control: brute force notices a shift by a billionth. */
START_TEST(a_shift_is_noticed) {
  draws d = start(0, 3, 500);
  int partly = 0, noticed = 0;
  while (draw(&d)) {
    occluded_pair p = d.pair;
    const double area = area_of(&p);
    if (area == 0 || area == hr2d_exchange_area(&p.i, &p.j)) continue;
    partly++;
    for (size_t k = 0; k < p.count; k++) {
      p.occluder[k].a.x += 1e-9, p.occluder[k].a.y += 1e-9;
      p.occluder[k].b.x += 1e-9, p.occluder[k].b.y += 1e-9;
    }
    noticed += fabs(area - strings_of(&p)) > BAR * shorter(&p);
  }
  printf("a shift by 1e-9 is noticed in %d of %d\n", noticed, partly);
  ck_assert_int_gt(2 * noticed, partly);
}
END_TEST

START_TEST(swapping_changes_no_bit) {
  draws d = start(_i, 4, 5000);
  while (draw(&d)) {
    const occluded_pair *p = &d.pair;
    note(&d, fabs(area_of(p) - exchange_among(p->j, p->i, p->occluder, p->count)));
  }
  finish(&d, "swap", 0);
}
END_TEST

START_TEST(powers_of_two_change_no_bit) {
  draws d = start(_i, 5, 2000);
  while (draw(&d)) {
    const int exponent = random_below(&d.r, 661) - 330;
    if (d.pair.count == 0) continue; /* that is hr2d_exchange_area() */
    const similarity s = {.u = ldexp(1, exponent)};
    const occluded_pair p = similar_pair(s, &d.pair);
    note(&d, fabs(ldexp(area_of(&p), -exponent) - area_of(&d.pair)));
  }
  finish(&d, "scale by 2^k", 0);
}
END_TEST

/* Whether rounding may push an occluder from the line of a patch to its front. */
static int lies_along(hr2d_segment w, hr2d_segment i) {
  return hr2d_orientation(i.a, i.b, w.a) == 0 && hr2d_orientation(i.a, i.b, w.b) == 0;
}

START_TEST(moving_changes_little) {
  draws d = start(_i, 6, 2000);
  while (draw(&d)) {
    const double angle = random_between(&d.r, 0, 6.3);
    const similarity s = {cos(angle), sin(angle), random_between(&d.r, -1, 1),
                          random_between(&d.r, -1, 1)};
    const occluded_pair p = similar_pair(s, &d.pair);
    size_t k = 0;
    while (k < p.count && !lies_along(d.pair.occluder[k], d.pair.i) &&
           !lies_along(d.pair.occluder[k], d.pair.j))
      k++;
    if (k < p.count) continue;
    /* The rounded pair is another one, the more so the flatter an occluder's angle. */
    const double other = fabs(strings_of(&p) - strings_of(&d.pair));
    const double change = fabs(area_of(&p) - area_of(&d.pair));
    ck_assert_double_lt(other, 1e-12 * longest(&p));
    note(&d, (change - other) / longest(&d.pair));
  }
  finish(&d, "turn and move", 1e-14);
}
END_TEST

/* In any order, either way round, one more or one less. */
START_TEST(occluders_are_a_set) {
  draws d = start(_i, 7, 2000);
  while (draw(&d)) {
    occluded_pair p = d.pair;
    const double area = area_of(&p);
    for (size_t k = 0; k < p.count; k++) {
      const size_t m = (size_t)random_below(&d.r, (int)p.count);
      const hr2d_segment w = p.occluder[k];
      p.occluder[k] = p.occluder[m];
      p.occluder[m] = (hr2d_segment){w.b, w.a};
    }
    note(&d, fabs(area_of(&p) - area) / longest(&p));
  }
  finish(&d, "order", 1e-15);
}
END_TEST

START_TEST(more_occluders_hide_more) {
  draws d = start(_i, 8, 500);
  while (draw(&d)) {
    occluded_pair p = d.pair;
    double before = hr2d_exchange_area(&p.i, &p.j);
    for (p.count = 0; p.count <= d.pair.count; p.count++) {
      const double area = area_of(&p);
      note(&d, (area - before) / shorter(&p));
      before = area;
    }
  }
  finish(&d, "one occluder more", 1e-15);
}
END_TEST

/* Whether p counts as lying on the line of s, but does not. */
static int counts_as_on(hr2d_segment s, hr2d_point p, double max) {
  const double x = s.b.x - s.a.x, y = s.b.y - s.a.y;
  const double off = fabs(x * (p.y - s.a.y) - y * (p.x - s.a.x)) / hypot(x, y);
  return off < 0x1p-48 * max && hr2d_orientation(s.a, s.b, p) != 0;
}

/* An occluder of which an end counts as lying on the line of i or j may be left out. */
static int has_doubtful_end(const occluded_pair *p, double max) {
  for (size_t k = 0; k < p->count; k++) {
    const hr2d_segment w = p->occluder[k];
    if (counts_as_on(p->i, w.a, max) || counts_as_on(p->i, w.b, max) ||
        counts_as_on(p->j, w.a, max) || counts_as_on(p->j, w.b, max))
      return 1;
  }
  return 0;
}

START_TEST(cutting_changes_nothing) {
  draws d = start(_i, 9, 2000);
  while (draw(&d)) {
    occluded_pair p = d.pair;
    if (p.count == 0 || 2 * p.count > MOST_OCCLUDERS) continue;
    for (size_t k = d.pair.count; k-- > 0;) {
      const hr2d_segment w = d.pair.occluder[k];
      const hr2d_point middle = {(w.a.x + w.b.x) / 2, (w.a.y + w.b.y) / 2};
      p.occluder[k].b = middle;
      p.occluder[p.count++] = (hr2d_segment){middle, w.b};
    }
    if (has_doubtful_end(&p, fmax(4, longest(&p)))) continue;
    note(&d, fabs(area_of(&p) - area_of(&d.pair)) / longest(&p));
  }
  finish(&d, "cut in halves", 1e-15);
}
END_TEST

static double off_by(randoms *r, double x, double max) {
  return random_below(r, 2) ? x + random_between(r, -max, max) : x;
}

static hr2d_segment segment_off_by(randoms *r, hr2d_segment s, double max) {
  return (hr2d_segment){{off_by(r, s.a.x, max), off_by(r, s.a.y, max)},
                        {off_by(r, s.b.x, max), off_by(r, s.b.y, max)}};
}

/* Ends that should meet, or lie on others, miss them by anything down to an ulp. */
START_TEST(ends_that_miss_by_little_cost_little) {
  draws d = start(_i, 10, 3000);
  int tried = 0;
  while (draw(&d)) {
    occluded_pair *p = &d.pair;
    const double by = random_power(&d.r, -16, -10);
    p->i = segment_off_by(&d.r, p->i, by);
    p->j = segment_off_by(&d.r, p->j, by);
    for (size_t k = 0; k < p->count; k++)
      p->occluder[k] = segment_off_by(&d.r, p->occluder[k], by);
    if (has_doubtful_end(p, fmax(4, longest(p)))) continue;
    tried++;
    note(&d, fabs(area_of(p) - strings_of(p)) / longest(p));
  }
  ck_assert_int_gt(tried, 0);
  finish(&d, "ends that miss", ROUNDINGS);
}
END_TEST

/* Exact copies in other positions: (p + qi)/4 rounds nothing on short coordinates. */
static const similarity turns[] = {
    {.u = 1}, {.u = .75, .v = 1}, {.u = -.5, .v = .75}, {.v = -1}, {.u = 1.25, .v = -.5}};
enum { TURNS = sizeof turns / sizeof *turns };

static const hr2d_segment ground = {{0, 0}, {1, 0}}, roof = {{1, 1}, {0, 1}};

static double area_turned(int turn, hr2d_segment i, hr2d_segment j,
                          const hr2d_segment *occluder, size_t count) {
  hr2d_segment turned[MOST_OCCLUDERS];
  for (size_t k = 0; k < count; k++) turned[k] = similar_segment(turns[turn], occluder[k]);
  return exchange_among(similar_segment(turns[turn], i), similar_segment(turns[turn], j),
                        turned, count);
}

/* Crossed strings past either end e of the occluder: |ae| + |ec| for both strings that
   cross, less |ad| = 1 and the string b e c, is 2·|ae| − 1 when divided by two and added. */
START_TEST(blk1) {
  const hr2d_segment w = {{0.3, 0.5}, {0.7, 0.5}};
  const double by_strings = 2 * sqrt(0.3 * 0.3 + 0.5 * 0.5) - 1;
  ck_assert_double_eq_tol(by_strings, 0.16619037896906, 1e-14);
  ck_assert_double_eq_tol(brute_quadrature(&ground, &roof, &w, 1, NULL), by_strings, 1e-15);
  ck_assert_double_eq_tol(exchange_among(ground, roof, &w, 1), by_strings, 1e-15);
}
END_TEST

/* What touches the shaft of the two unit patches from outside, lies along a patch, is
   behind one, or has no length. */
START_TEST(what_is_not_in_the_way_changes_no_bit) {
  const hr2d_segment aside[] = {
      {{0, .25}, {0, .75}}, {{0, -1}, {0, 2}},       {{-1, .5}, {0, .5}},
      {{1, .5}, {2, .75}},  {{1, 0}, {1, 1}},        {{0, 0}, {-1, 1}},
      {{1, 1}, {2, .5}},    {{0, 0}, {1, 0}},        {{1, 0}, {0, 0}},
      {{.25, 0}, {.5, 0}},  {{-1, 0}, {.5, 0}},      {{-1, 1}, {2, 1}},
      {{.25, 0}, {.5, -1}}, {{.5, 1}, {.25, 2}},     {{.75, 1}, {.75, 1.5}},
      {{0, 0}, {-1, -1}},   {{-1, .25}, {-.5, .75}}, {{-2, -.5}, {3, -.25}}};
  const size_t count = sizeof aside / sizeof *aside;
  for (int turn = 0; turn < TURNS; turn++) {
    const hr2d_segment i = similar_segment(turns[turn], ground);
    const hr2d_segment j = similar_segment(turns[turn], roof);
    const double clear = hr2d_exchange_area(&i, &j);
    for (size_t k = 0; k < count; k++)
      for (size_t m = k; m <= count; m += count - k) {
        const double area = m == k ? area_turned(turn, ground, roof, aside + k, 1)
                                   : area_turned(turn, ground, roof, aside,
                                                 k < MOST_OCCLUDERS ? k : MOST_OCCLUDERS);
        ck_assert_msg(area == clear, "turn %d: occluder %zu: %a is not %a", turn, k, area,
                      clear);
      }
    /* Negative control: the same a little further in. */
    const hr2d_segment inside[] = {{{0x1p-20, .25}, {0x1p-20, .75}},
                                   {{-1, .5}, {0x1p-20, .5}},
                                   {{.25, 0x1p-20}, {.5, 0x1p-20}}};
    for (size_t k = 0; k < 3; k++)
      ck_assert(area_turned(turn, ground, roof, inside + k, 1) < clear);
  }
}
END_TEST

START_TEST(points_and_nothing_hide_nothing) {
  const hr2d_segment point = {{.5, .5}, {.5, .5}};
  const double clear = hr2d_exchange_area(&ground, &roof);
  ck_assert_double_eq(exchange_among(ground, roof, NULL, 0), clear);
  ck_assert_double_eq_tol(exchange_among(ground, roof, &point, 1), clear, 1e-15);
  /* A point between two walls does not join them to a straight one. */
  const hr2d_segment bent[] = {{{.25, .5}, {.5, .5}}, point, {{.5, .5}, {.5, .75}}};
  const hr2d_segment plain[] = {bent[0], bent[2]};
  ck_assert_double_eq_tol(exchange_among(ground, roof, bent, 3),
                          exchange_among(ground, roof, plain, 2), 1e-15);
}
END_TEST

typedef struct barrier {
  const char *name;
  hr2d_segment occluder[8];
  size_t count;
} barrier;

/* Each separates floor and roof by segments that share vertices or end on each other. */
static const barrier barriers[] = {
    {"one wall", {{{-1, .5}, {2, .5}}}, 1},
    {"two walls", {{{-1, .5}, {.375, .25}}, {{.375, .25}, {2, .75}}}, 2},
    {"from side to side", {{{0, .5}, {.5, .25}}, {{.5, .25}, {1, .5}}}, 2},
    {"a zigzag",
     {{{-1, .5}, {.25, .75}},
      {{.25, .75}, {.5, .25}},
      {{.75, .875}, {.5, .25}},
      {{.75, .875}, {1.5, .125}}},
     4},
    {"spikes",
     {{{-1, .5}, {.5, .5}}, {{.5, .5}, {.5, .75}}, {{.5, .5}, {.25, .25}}, {{.5, .5}, {2, .5}}},
     4},
    {"a tent", {{{0, 0}, {.5, .25}}, {{.5, .25}, {1, 0}}}, 2},
    {"an awning", {{{0, 1}, {.125, .25}}, {{.125, .25}, {1, 1}}}, 2},
    {"a diagonal", {{{0, 0}, {1, 1}}}, 1},
    {"a cross", {{{0, 0}, {.5, .5}}, {{.25, .75}, {.75, .25}}, {{.5, .5}, {1, 1}}}, 3},
    {"a wall that ends on another",
     {{{-1, .5}, {.5, .5}}, {{.5, .25}, {.5, .75}}, {{.5, .375}, {2, .375}}},
     3},
    {"ends on ends' way",
     {{{-1, .25}, {.75, .5}},
      {{.4375, .25}, {.3125, .75}},
      {{.3125, .75}, {2, .5}},
      {{.375, .5}, {.4375, .25}},
      {{-.125, .375}, {.375, .5}}},
     5},
    {"crossing walls",
     {{{-1, .25}, {.75, .5}}, {{.25, .625}, {2, .25}}, {{.25, .625}, {.5, .25}}},
     3},
    {"overlapping walls", {{{-1, .5}, {.625, .5}}, {{.375, .5}, {2, .5}}}, 2},
    {"corners at the patches",
     {{{0, 0}, {.25, .5}}, {{.25, .5}, {1, 1}}, {{.25, .5}, {1, 0}}},
     3}};
enum { BARRIERS = sizeof barriers / sizeof *barriers };

START_TEST(touching_occluders_do_not_leak) {
  const barrier *b = &barriers[_i];
  for (int turn = 0; turn < TURNS; turn++) {
    const double area = area_turned(turn, ground, roof, b->occluder, b->count);
    ck_assert_msg(area == 0, "%s, turn %d: %g passes", b->name, turn, area);
  }
  /* Negative control: light passes where one is missing, and where the end of one is. */
  int open = 0;
  for (size_t k = 0; k < b->count; k++) {
    hr2d_segment left[8];
    for (size_t m = 0; m < b->count; m++) left[m] = b->occluder[m];
    left[k] = b->occluder[b->count - 1];
    open += exchange_among(ground, roof, left, b->count - 1) > 0;
  }
  ck_assert_int_gt(open, 0);
}
END_TEST

/* Lines through a slit of width w at an angle φ to its normal have the measure
   w·cosφ dφ / 2. */
static double slit_area(hr2d_segment i, hr2d_segment j, hr2d_point at, hr2d_point along) {
  const double w = hypot(along.x, along.y);
  double low = -1, high = 1;
  for (int k = 0; k < 2; k++) {
    const hr2d_segment s = k ? j : i;
    const double sign = k ? 1 : -1;
    double ends[2];
    for (int e = 0; e < 2; e++) {
      const hr2d_point p = e ? s.b : s.a;
      const double x = p.x - at.x, y = p.y - at.y;
      ends[e] = sign * (x * along.x + y * along.y) / (w * hypot(x, y));
    }
    low = fmax(low, fmin(ends[0], ends[1]));
    high = fmin(high, fmax(ends[0], ends[1]));
  }
  return high > low ? w * (high - low) / 2 : 0;
}

START_TEST(slits_have_their_width) {
  if (!test_has_long_double()) return;
  randoms r = randoms_stream(test_seed(), 5000);
  double worst = 0;
  for (int k = test_count(3000), seen = 0; k > 0 || !seen; k--) {
    const double width = k % 2 ? 1e-12 : random_power(&r, -12, -7);
    const hr2d_segment i = {{random_between(&r, -.5, .2), random_between(&r, 0, .2)},
                            {random_between(&r, .5, 1.2), random_between(&r, 0, .2)}};
    const hr2d_segment j = {{random_between(&r, .5, 1.2), random_between(&r, .8, 1)},
                            {random_between(&r, -.5, .2), random_between(&r, .8, 1)}};
    const double x = random_between(&r, .25, .75), slope = random_between(&r, -.1, .1);
    const hr2d_segment screen[] = {
        {{-3, .5 - 3 * slope}, {x, .5 + x * slope}},
        {{x + width, .5 + (x + width) * slope}, {3, .5 + 3 * slope}}};
    const hr2d_point gap = {screen[1].a.x - screen[0].b.x, screen[1].a.y - screen[0].b.y};
    const hr2d_point middle = {screen[0].b.x + gap.x / 2, screen[0].b.y + gap.y / 2};
    const double expected = slit_area(i, j, middle, gap);
    if (expected == 0) continue;
    seen++;
    const double area = exchange_among(i, j, screen, 2);
    worst = fmax(worst, fabs(area - expected) / expected);
    const double brute = brute_quadrature(&i, &j, screen, 2, NULL);
    ck_assert_double_lt(fabs(brute - expected), 1e-5 * expected);
  }
  printf("slits of 1e-12 to 1e-7: worst relative error %.2e\n", worst);
  ck_assert_double_lt(worst, 1e-3);
}
END_TEST

/* Two screens with a slit each, from x to x + w below and from 2x + dx to 2x + dx + w above.
   The lines from (0,0) to the upper slit's left edge pass the lower one at its left edge
   if dx = 0, and those from the right of (0,0) further left. */
static double past_two_screens(int turn, double x, double w, double dx) {
  const hr2d_segment screen[] = {{{-4, .25}, {x, .25}},
                                 {{x + w, .25}, {4, .25}},
                                 {{-4, .5}, {2 * (x + w) + dx, .5}},
                                 {{2 * (x + w) + dx + w, .5}, {4, .5}}};
  const hr2d_segment wide = {{4, 1}, {-4, 1}};
  return area_turned(turn, ground, wide, screen, 4);
}

START_TEST(zero_is_decided_exactly) {
  for (int turn = 0; turn < TURNS; turn++) {
    const double x = .25, w = 0x1p-20;
    ck_assert_double_eq(past_two_screens(turn, x, w, 0), 0);
    ck_assert_double_eq(past_two_screens(turn, x, w, 0x1p-40), 0);
    ck_assert_double_gt(past_two_screens(turn, x, w, -0x1p-40), 0);
    ck_assert_double_gt(past_two_screens(turn, x, w, -0x1p-30), 0);
    /* Slits of 2^-40 above each other: w²/(2·¼), far below the rounding of the strings. */
    const double narrow = past_two_screens(turn, x, 0x1p-40, -x - 0x1p-40);
    ck_assert_double_gt(narrow, 0);
    ck_assert_double_lt(narrow, 1e-15);
  }
}
END_TEST

/* Walls that hug the line of a patch within roundings, in front of it. */
static const occluded_pair hugging[] = {
    /* An end that counts as lying on the line of j between two that do not. */
    {.i = {{-1.3070735955848993, -0.22558128325631216}, {0, 0}},
     .j = {{-0.71899143097594298, 1.2219184102378393},
           {-0.70502692282329849, 1.1560689303904306}},
     .occluder = {{{-0.44362619811234333, -0.076563222908285863},
                   {-0.53425798439071059, 0.35080993759516338}},
                  {{-0.53425798439071082, 0.35080993759516327},
                   {-0.60571463927719005, 0.68776298345086617}},
                  {{-0.60571463927718994, 0.68776298345086617},
                   {-0.70502692282324875, 1.1560689303901979}}},
     .count = 3},
    /* The end of i and that of j are close by on the line of j, which they point along. */
    {.i = {{-1.6275421507764232, -0.32473335847810003},
           {-0.65140439614916157, -0.9761377546272616}},
     .j = {{-0.65071482578911999, -0.97510442469135628},
           {-0.11574022284117826, -0.17343819279101627}},
     .occluder = {{{-0.18401433086024954, -0.27574781012686317},
                   {-0.40048672283871245, -0.6001344367658753}}},
     .count = 1},
    /* A wedge of 1e-12, and a wall that ends on i: an ulp above it, as flat as that. */
    {.i = {{0.060466659114480986, 0.693099237443908},
           {0.16706901709935748, 0.77745647278763585}},
     .j = {{0.16706901709935748, 0.77745647278763585},
           {0.056301919673949541, 0.68980357014572102}},
     .occluder = {{{0.045023148529351381, 0.68087838340663354},
                   {0.14857689487386272, 0.76282317258613053}}},
     .count = 1},
    /* A wedge of 5e-15, and an end that counts as lying on both of its sides. */
    {.i = {{0.40921330233630865, 0.51801319595957573},
           {0.454152449350265, 0.54138522415613977}},
     .j = {{0.454152449350265, 0.54138522415613977},
           {0.10502968267509237, 0.35981286043818267}},
     .occluder = {{{0.36591414866352745, 0.49549409829594815},
                   {0.4462127149263066, 0.5372559135403345}}},
     .count = 1}};

START_TEST(walls_that_hug_a_line_are_seen) {
  const occluded_pair *p = &hugging[_i];
  const double area = area_of(p), expected = strings_of(p);
  printf("hugging: %.17g, strings %.17g\n", area, expected);
  ck_assert_double_eq_tol(area, expected, 1e-14);
}
END_TEST

/* A thousand occluders side by side: what passes is what passes each slit. */
START_TEST(a_thousand_slits_add_up) {
  enum { COUNT = 1000 };
  static hr2d_segment w[COUNT];
  randoms r = randoms_stream(test_seed(), 5001);
  double sum = 0;
  for (int k = 0; k < COUNT; k++) {
    const double from = k - (k > 0) * random_unit(&r) / 2;
    w[k] = (hr2d_segment){{from / COUNT, .5}, {(k + .25) / COUNT, .5}};
  }
  for (int k = 0; k < COUNT; k++) {
    const hr2d_point next = k + 1 < COUNT ? w[k + 1].a : (hr2d_point){2, .5};
    const hr2d_segment around[] = {{{-9, .5}, w[k].b}, {next, {9, .5}}};
    sum += brute_strings(&ground, &roof, around, 2);
  }
  const double area = exchange_among(ground, roof, w, COUNT);
  printf("a thousand slits: %.17g, error %.2e\n", area, fabs(area - sum));
  ck_assert_double_lt(fabs(area - sum), 1e-13);
}
END_TEST

/* No line passes between two spokes without crossing one: a fan hides what its hull does,
   and this has 48 corners. */
START_TEST(a_fan_of_a_thousand_hides_its_hull) {
  enum { COUNT = 1000, CORNERS = 48 };
  static hr2d_segment w[COUNT];
  hr2d_segment hull[CORNERS];
  randoms r = randoms_stream(test_seed(), 5002);
  const hr2d_point hub = {.4375, .5625};
  for (int k = 0; k < COUNT; k++) {
    const int inside = k >= CORNERS;
    const double angle = inside ? random_between(&r, 0, 6.28) : k * 6.283185307179586 / CORNERS;
    const double reach = inside ? random_between(&r, .05, .24) : .25;
    w[k] = (hr2d_segment){hub, {hub.x + reach * cos(angle), hub.y + reach * sin(angle)}};
  }
  for (int k = 0; k < CORNERS; k++) hull[k] = (hr2d_segment){w[k].b, w[(k + 1) % CORNERS].b};
  const double area = exchange_among(ground, roof, w, COUNT);
  const double expected = brute_strings(&ground, &roof, hull, CORNERS);
  printf("a fan of a thousand: %.17g, error %.2e\n", area, fabs(area - expected));
  ck_assert_double_lt(fabs(area - expected), 1e-13);
}
END_TEST

/* Many at once: by strings as far as these are affordable, by random lines beyond. */
START_TEST(crowds) {
  enum { MOST = 1000 };
  static hr2d_segment w[MOST];
  randoms r = randoms_stream(test_seed(), 5003);
  for (int size = 25; size <= MOST; size = size < 100 ? 2 * size : 10 * size)
    for (int k = test_count(4); k > 0; k--) {
      for (int m = 0; m < size; m++) {
        const double x = random_unit(&r), y = random_unit(&r), reach = random_between(&r, 0, 2);
        w[m] = (hr2d_segment){{x, y},
                              {x + reach * random_between(&r, -1, 1) / size,
                               y + reach * random_between(&r, -1, 1) / size}};
      }
      const double area = exchange_among(ground, roof, w, (size_t)size);
      double bar = 1e-13, expected;
      if (size <= 100)
        expected = brute_strings(&ground, &roof, w, (size_t)size);
      else {
        expected = brute_lines(&ground, &roof, w, (size_t)size, &r, 4000, &bar);
        bar *= 6;
      }
      ck_assert_msg(fabs(area - expected) <= bar, "%d occluders: %.17g is not %.17g", size,
                    area, expected);
    }
}
END_TEST

/* A segment of one ulp, and occluders that are large beside it: their rounding exceeds the
   whole exchange area. */
START_TEST(occluders_only_take) {
  static const hr2d_segment i = {{-0x1p+11, 0x1.bp+14}, {-0x1.0000000000001p+11, 0x1.bp+14}};
  static const hr2d_segment other[][4] = {
      {{{-0x1.8p+21, 0x1.bp+20}, {-0x1.d8p-7, -0x1.cp-11}},
       {{-0x1.ap+6, -0x1.ap+6}, {-0x1.a000000000001p+6, 0x1.ae6p+13}},
       {{-0x1.d800000000001p-7, 0x1.afffff2p+13}, {0, 0}},
       {{-0x1.dfd325bfdfdfdp+992, 0x1.373737373fdfdp+824}, {-0x1.ap+6, -0x1.ap+6}}},
      {{{-0x1.8p+21, 0x1.bp+20}, {-0x1p-6, -0x1p-6}},
       {{-0x1.ap+6, -0x1.ap+6}, {-0x1.ap+6, 0x1.f4p+9}},
       {{-0x1.a000000000001p+6, 0x1.ae6p+13}, {-0x1.0000000000001p-6, 0x1.affffp+13}},
       {{-0x1.ap+6, -0x1.ap+6}, {-0x1.8p+21, 0x1.bp+20}}},
  };
  for (size_t k = 0; k < sizeof other / sizeof *other; k++)
    for (size_t count = 1; count < 4; count++) {
      const hr2d_segment j = other[k][0];
      const double all = hr2d_exchange_area(&i, &j);
      ck_assert_double_gt(all, 0);
      ck_assert_double_le(exchange_among(i, j, other[k] + 1, count), all);
    }
}
END_TEST

START_TEST(what_is_not_finite_is_refused) {
  const double bad[] = {NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 3 * 12; k++) {
    hr2d_segment s[3] = {ground, roof, {{.3, .5}, {.7, .5}}};
    double *at[] = {&s[k / 12].a.x, &s[k / 12].a.y, &s[k / 12].b.x, &s[k / 12].b.y};
    *at[k / 3 % 4] = bad[k % 3];
    double area = -7;
    const size_t count = k < 24 && k % 2 ? 0 : 1;
    ck_assert_int_eq(hr2d_exchange_area_occluded(&s[0], &s[1], &s[2], count, NULL, &area),
                     HR2D_EINVAL);
  }
}
END_TEST

START_TEST(allocations_fail_one_by_one) {
  enum { COUNT = 200 };
  hr2d_segment w[COUNT];
  randoms r = randoms_stream(test_seed(), 5004);
  for (int k = 0; k < COUNT; k++) {
    const double x = random_unit(&r), y = random_unit(&r);
    w[k] = (hr2d_segment){{x, y}, {x + .01, y + .01 * random_unit(&r)}};
  }
  const double expected = exchange_among(ground, roof, w, COUNT);
  long k = 0;
  for (int failed = 1; failed; k++) {
    test_memory f = {.until_failure = k, .for_good = _i};
    const hr2d_allocator hooks = test_hooks(&f);
    double area = -7;
    const hr2d_status status =
        hr2d_exchange_area_occluded(&ground, &roof, w, COUNT, &hooks, &area);
    failed = f.failures > 0;
    ck_assert_int_eq(status, failed ? HR2D_ENOMEM : HR2D_OK);
    ck_assert_int_eq(f.live, 0);
    if (!failed) ck_assert_double_eq(area, expected);
  }
  printf("%ld allocations failed\n", k - 1);
  ck_assert_int_gt(k, 5);
}
END_TEST

TEST_SUITE("visibility") {
  REPEAT_TESTS(occluded_class_count, "classes", references_agree, agrees_with_quadrature,
               agrees_with_strings);
  ADD_TESTS("classes", a_shift_is_noticed);
  REPEAT_TESTS(occluded_class_count, "classes", swapping_changes_no_bit,
               powers_of_two_change_no_bit, moving_changes_little, occluders_are_a_set,
               more_occluders_hide_more, cutting_changes_nothing,
               ends_that_miss_by_little_cost_little);
  ADD_TESTS("cases", blk1, what_is_not_in_the_way_changes_no_bit,
            points_and_nothing_hide_nothing);
  REPEAT_TESTS(BARRIERS, "cases", touching_occluders_do_not_leak);
  ADD_TESTS("cases", slits_have_their_width, zero_is_decided_exactly);
  REPEAT_TESTS(4, "cases", walls_that_hug_a_line_are_seen);
  ADD_TESTS("cases", a_thousand_slits_add_up, a_fan_of_a_thousand_hides_its_hull, crowds);
  ADD_TESTS("refusals", occluders_only_take, what_is_not_finite_is_refused);
  REPEAT_TESTS(2, "refusals", allocations_fail_one_by_one);
}
