/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where patches may lie: which pairs cross or lie on one another, judged by integer arithmetic,
   and which lengths, scales and offsets a scene may have. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/lattice-scenes.h"
#include "support/support.h"

typedef struct meeting {
  double patch[2][4];
  const char *what; /* NULL where nothing is wrong */
} meeting;

static const meeting meetings[] = {
    {{{0, 0, 2, 2}, {0, 2, 2, 0}}, "cross"},
    {{{0, 0, 2, 2}, {2, 0, 0, 2}}, "cross"},
    {{{0, 0, 4, 0}, {3, 1, 3, -1}}, "cross"},
    {{{1, 0, 2, 0}, {0, 0, 3, 0}}, "lies on"},
    {{{0, 0, 2, 0}, {0, 0, 2, 0}}, "is a copy of"},
    {{{0, 0, 2, 0}, {1, 0, 3, 0}}, "lie on one another"},
    {{{0, 2, 0, 0}, {0, 1, 0, -1}}, "lie on one another"},
    {{{0, 0, 3, 6}, {1, 2, 4, 8}}, "lie on one another"},
    {{{0, 0, 3, 6}, {0, 0, 1, 2}}, "lies on"},  /* with a common end */
    {{{0, 0, 2, 0}, {2, 0, 0, 0}}, NULL},       /* back to back */
    {{{0, 0, 2, 0}, {3, 0, 1, 0}}, NULL},       /* back to back in part */
    {{{0, 0, 3, 6}, {2, 4, 1, 2}}, NULL},       /* back to back, one within the other */
    {{{0, 0, 2, 0}, {2, 0, 3, 5}}, NULL},       /* a corner */
    {{{0, 0, 2, 0}, {1, 0, 1, 1}}, NULL},       /* a junction */
    {{{0, 0, 3, 6}, {1, 2, 5, 1}}, NULL},       /* a junction */
    {{{0, 0, 2, 0}, {2, 0, 4, 0}}, NULL},       /* neighbours on a line */
    {{{0, 0, 2, 0}, {3, 0, 5, 0}}, NULL},       /* with a gap */
    {{{0, 0, 2, 0}, {0, 1, 2, 1}}, NULL},       /* parallel */
    {{{0, 0, 2, 2}, {2, 0, 1.25, 0.75}}, NULL}, /* towards each other */
};

START_TEST(meetings_are_told_apart) {
  for (size_t k = 0; k < 4 * sizeof meetings / sizeof *meetings; k++) {
    const meeting *m = &meetings[k / 4];
    hr2d_scene *scene = test_new_scene(NULL);
    /* Both orders, and turned by a quarter. */
    for (size_t p = 0; p < 2; p++) {
      const double *c = m->patch[k & 1 ? 1 - p : p];
      test_add_black(scene, k & 2 ? (const double[]){-c[1], c[0], -c[3], c[2]} : c);
    }
    const hr2d_status status = hr2d_scene_commit(scene);
    ck_assert_int_eq(status, m->what ? HR2D_ESCENE : HR2D_OK);
    if (m->what) {
      test_expect_message(scene, m->what);
      test_expect_message(scene, "patch 0");
      test_expect_message(scene, "patch 1");
    } else {
      ck_assert_str_eq(hr2d_scene_message(scene), "");
    }
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* The conflict of p and q, in words that the message contains; NULL if there is none. */
static const char *collision(const lattice *p, const lattice *q) {
  const int a = lattice_side(p->ax, p->ay, p->bx, p->by, q->ax, q->ay),
            b = lattice_side(p->ax, p->ay, p->bx, p->by, q->bx, q->by),
            c = lattice_side(q->ax, q->ay, q->bx, q->by, p->ax, p->ay),
            d = lattice_side(q->ax, q->ay, q->bx, q->by, p->bx, p->by);
  if (a * b < 0 && c * d < 0) return "cross";
  if (a != 0 || b != 0) return NULL;
  /* The places of both ends of p and of q along p. */
  const long long ux = p->bx - p->ax, uy = p->by - p->ay;
  const long long end = ux * ux + uy * uy, from = ux * (q->ax - p->ax) + uy * (q->ay - p->ay),
                  to = ux * (q->bx - p->ax) + uy * (q->by - p->ay);
  if (to <= from || from >= end || to <= 0) return NULL;
  if (from == 0 && to == end) return "is a copy of";
  return (from >= 0 && to <= end) || (from <= 0 && to >= end) ? "lies on"
                                                              : "lie on one another";
}

START_TEST(collisions_are_those_of_integers) {
  unsigned long state = test_seed();
  const struct {
    size_t count;
    long long size, reach;
  } kind[] = {{2, 5, 4}, {6, 6, 2}, {40, 40, 3}, {3, 1 << 24, 1 << 24}, {25, 1 << 24, 1 << 22}};
  size_t fine = 0, wrong = 0;
  for (size_t round = 0; round < test_rounds(10000, 20); round++) {
    lattice p[40];
    const size_t n = kind[round % 5].count;
    lattice_draw(&state, p, n, kind[round % 5].size, kind[round % 5].reach);
    int collide = 0;
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < i; j++) collide |= collision(&p[i], &p[j]) != NULL;
    hr2d_scene *scene = lattice_scene(p, n, 0);
    ck_assert_int_eq(hr2d_scene_commit(scene), collide ? HR2D_ESCENE : HR2D_OK);
    if (collide) {
      size_t i, j;
      lattice_named_pair(hr2d_scene_message(scene), &i, &j);
      test_expect_message(scene, collision(&p[i], &p[j]));
    }
    *(collide ? &wrong : &fine) += 1;
    hr2d_scene_destroy(scene);
  }
  ck_assert_uint_gt(fine, 2);
  ck_assert_uint_gt(wrong, 2);
}
END_TEST

/* One patch ends beside a long one, or up to eight ulps before it or behind it.  It goes
   through if it does so by more than 2^-50 of the largest coordinate. */
START_TEST(a_rounding_decides) {
  if (!test_has_long_double()) return;
  unsigned long state = test_seed();
  size_t through = 0, refused = 0;
  for (size_t round = 0; round < 20000; round++) {
    const double p = 1 + (double)lattice_random(&state, 1000),
                 q = 1 + (double)lattice_random(&state, 1000);
    const double x = p * (0.01 + 0.98 * test_random(&state));
    double y = q * x / p;
    const int ulps = (int)lattice_random(&state, 17) - 8;
    for (int k = 0; k < abs(ulps); k++) y = nextafter(y, ulps * HUGE_VAL);
    /* p·y − q·x has 63 bits at most. */
    const long double depth =
        ((long double)p * y - (long double)q * x) / hypotl((long double)p, (long double)q);
    const long double rounding = 0x1p-50L * fmax(p, q);
    if (fabsl(depth - rounding) < 1e-6L * rounding) continue;
    hr2d_scene *scene = test_open_scene((const double[][4]){{0, 0, p, q}, {x, -1, x, y}}, 2);
    ck_assert_int_eq(hr2d_scene_commit(scene), depth > rounding ? HR2D_ESCENE : HR2D_OK);
    through += depth > 0;
    refused += depth > rounding;
    hr2d_scene_destroy(scene);
  }
  ck_assert_uint_gt(refused, 0);
  ck_assert_uint_gt(through, refused);
}
END_TEST

static const double room[][4] = {{0, 0, 1, 0}, {1, 0, 1, 1}, {1, 1, 0, 1}, {0, 1, 0, 0}};

START_TEST(scales_are_powers_of_two) {
  const double factor[] = {1,     0.75,   3,       1e300,        1e-300,
                           1e308, 1e-308, DBL_MIN, DBL_TRUE_MIN, DBL_MAX};
  for (size_t f = 0; f < sizeof factor / sizeof *factor; f++) {
    hr2d_scene *scene = test_new_scene(NULL);
    for (size_t k = 0; k < 4; k++) {
      double p[4];
      for (int c = 0; c < 4; c++) p[c] = room[k][c] * factor[f];
      test_add_black(scene, p);
      ck_assert_double_eq(hr2d_scene_length(scene, k), factor[f]);
    }
    test_commit(scene);
    const double unit = hr2d_scene_unit(scene);
    int exponent;
    ck_assert_double_eq(frexp(unit, &exponent), 0.5);
    ck_assert_double_ge(factor[f] / unit, 1);
    ck_assert_double_lt(factor[f] / unit, 2);
    for (size_t k = 0; k < 4; k++) {
      ck_assert_double_eq(hr2d_scene_length(scene, k), factor[f]);
      ck_assert_double_eq(hr2d_scene_segment(scene, k).b.x, room[k][2] * factor[f]);
    }
    ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL), 0);
    ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_CORNER, NULL), 1);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(lengths_are_those_of_hypot) {
  unsigned long state = test_seed();
  for (int round = 0; round < 200; round++) {
    double p[4];
    for (int c = 0; c < 4; c++)
      p[c] = ldexp(test_random(&state) - 0.5, (int)lattice_random(&state, 40) - 20);
    hr2d_scene *scene = test_open_scene((const double(*)[4])p, 1);
    ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
    const long double length = hypotl((long double)p[2] - p[0], (long double)p[3] - p[1]);
    ck_assert_double_eq_tol(hr2d_scene_length(scene, 0), (double)length,
                            2 * DBL_EPSILON * (double)length);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(scales_too_far_apart_are_refused) {
  hr2d_scene *scene =
      test_open_scene((const double[][4]){{0, 0, 1e300, 0}, {0, 1e-300, 1, 1}}, 2);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ERANGE);
  test_expect_message(scene, "patch 1: its coordinates are too small");
  hr2d_scene_destroy(scene);
  /* 0 is no scale, and what keeps all its bits is no loss. */
  scene = test_open_scene((const double[][4]){{0, 0, 0x1p+1023, 0}, {0, 0x1p-51, 1, 1}}, 2);
  test_commit(scene);
  hr2d_scene_destroy(scene);
  scene = test_open_scene((const double[][4]){{0, 0, 0x1p+1023, 0}, {0, 0x1p-52, 1, 1}}, 2);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ERANGE);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(lengths_beyond_a_double_are_refused) {
  hr2d_scene *scene = test_open_scene((const double[][4]){{-DBL_MAX, 0, DBL_MAX, 0}}, 1);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ERANGE);
  test_expect_message(scene, "patch 0");
  hr2d_scene_destroy(scene);
}
END_TEST

/* The limit lies between 2^40 and 2^41 times the width of the scene.  A convex room, which
   has no occluders, has no limit. */
START_TEST(scenes_too_far_off_are_refused) {
  for (int e = 36; e < 50; e++) {
    double far[5][4] = {{0}, {0}, {0}, {0}, {.25, .25, .75, .75}};
    for (int k = 0; k < 16; k++) far[k / 4][k % 4] = room[k / 4][k % 4];
    for (int k = 0; k < 20; k++) far[k / 4][k % 4] += ldexp(1, e);
    hr2d_scene *convex = test_open_scene((const double(*)[4])far, 4);
    ck_assert_int_eq(hr2d_scene_commit(convex), HR2D_OK);
    hr2d_scene_destroy(convex);
    hr2d_scene *scene = test_open_scene((const double(*)[4])far, 5);
    ck_assert_int_eq(hr2d_scene_commit(scene), e > 40 ? HR2D_ERANGE : HR2D_OK);
    if (e > 40) test_expect_message(scene, "the scene is so far from the origin");
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Beside a patch of length 1 there may be patches so small that their determinants
   are no doubles.  They are judged like any others. */
START_TEST(tiny_parts_are_judged_like_others) {
  for (int exponent = 0; exponent >= -1000; exponent -= 50) {
    const double s = ldexp(1, exponent);
    const double plates[][4] = {{0, 0, s, s}, {0, s / 2, s, 1.5 * s}, {5, 0, 6, 0}};
    hr2d_scene *scene = test_open_scene(plates, 3);
    ck_assert_msg(hr2d_scene_commit(scene) == HR2D_OK, "at 2^%d: %s", exponent,
                  hr2d_scene_message(scene));
    ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_CORNER, NULL), 0);
    hr2d_scene_destroy(scene);
    const double crossing[][4] = {{0, 0, s, s}, {0, s, s, 0}, {5, 0, 6, 0}};
    scene = test_open_scene(crossing, 3);
    ck_assert_msg(hr2d_scene_commit(scene) == HR2D_ESCENE, "at 2^%d", exponent);
    ck_assert_msg(strstr(hr2d_scene_message(scene), "cross") != NULL, "at 2^%d: %s", exponent,
                  hr2d_scene_message(scene));
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("positions") {
  ADD_TESTS("meetings", meetings_are_told_apart, collisions_are_those_of_integers,
            a_rounding_decides, tiny_parts_are_judged_like_others);
  ADD_TESTS("scales", scales_are_powers_of_two, lengths_are_those_of_hypot,
            scales_too_far_apart_are_refused, lengths_beyond_a_double_are_refused,
            scenes_too_far_off_are_refused);
}
