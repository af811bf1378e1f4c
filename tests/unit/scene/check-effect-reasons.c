/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which effects a scene calls for, and the reasons it gives: on examples, and occlusion against
   lines drawn one by one between patches with integer coordinates. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/lattice-scenes.h"
#include "support/order.h"
#include "support/support.h"

typedef struct example {
  double patch[5][6]; /* with E and rho; of length 0 behind the last */
  hr2d_effect effect;
  int on;
  const char *reason;
} example;

static const example examples[] = {
    {{{0, 0, 1, 0}, {1, 1, 0, 1}, {.3, .5, .7, .5}},
     HR2D_EFFECT_OCCLUSION,
     1,
     "patch 2 can stand between patch 0 and patch 1"},
    {{{0, 0, 1, 0}, {1, 1, 0, 1}, {.3, 1.5, .7, 1.5}},
     HR2D_EFFECT_OCCLUSION,
     0,
     "nothing can stand between patches that see each other"},
    {{{0, 0, 1, 0}, {0, 1, 1, 1}, {.3, .5, .7, .5}},
     HR2D_EFFECT_OCCLUSION,
     0,
     "nothing can stand between patches that see each other"},
    {{{0, 0, 1, 0}, {1, 1, 0, 1}}, HR2D_EFFECT_OCCLUSION, 0, "nothing can stand between"},
    /* Along an edge of the shaft nothing is blocked; an ulp within it is. */
    {{{0, 0, 1, 0}, {1, 1, 0, 1}, {1, .2, 1, .6}},
     HR2D_EFFECT_OCCLUSION,
     0,
     "nothing can stand between"},
    {{{0, 0, 1, 0}, {1, 1, 0, 1}, {1, .2, 1 - DBL_EPSILON / 2, .6}},
     HR2D_EFFECT_OCCLUSION,
     1,
     "patch 2"},
    /* Junctions: one patch begins or ends within the other. */
    {{{0, 0, 4, 0}, {2, 0, 2, 3}, {1, .5, 1.5, 1}},
     HR2D_EFFECT_OCCLUSION,
     1,
     "patch 2 can stand between patch 0 and patch 1"},
    {{{0, 0, 4, 0}, {2, 3, 2, 0}, {2.5, 1, 3, .5}},
     HR2D_EFFECT_OCCLUSION,
     1,
     "patch 2 can stand between patch 0 and patch 1"},
    {{{2, 0, 2, 3}, {0, 0, 4, 0}, {1, .5, 1.5, 1}},
     HR2D_EFFECT_OCCLUSION,
     1,
     "patch 2 can stand between patch 0 and patch 1"},
    {{{2, 3, 2, 0}, {0, 0, 4, 0}, {2.5, 1, 3, .5}},
     HR2D_EFFECT_OCCLUSION,
     1,
     "patch 2 can stand between patch 0 and patch 1"},
    {{{0, 0, 1, 0, 1, 0}, {1, 1, 0, 1, 0, 0}},
     HR2D_EFFECT_INTERREFLECTION,
     0,
     "every reflectance is 0"},
    {{{0, 0, 1, 0, 1, 0}, {1, 1, 0, 1, 0, 1e-9}, {0, 2, 1, 2, 0, 1}},
     HR2D_EFFECT_INTERREFLECTION,
     1,
     "patch 1 reflects"},
    {{{0, 0, 1, 0, 0, .5}, {1, 1, 0, 1, 0, .5}}, HR2D_EFFECT_EMISSION, 0, "no patch emits"},
    {{{0, 0, 1, 0}, {1, 1, 0, 1, 1e-300}}, HR2D_EFFECT_EMISSION, 1, "patch 1 emits"},
    {{{0, 0, 1, 0}, {1, 1, 0, 1}}, HR2D_EFFECT_BANDS, 0, "one band"},
    {{{0, 0, 1, 0}, {1, 1, 0, 1}},
     HR2D_EFFECT_TWO_SIDED,
     0,
     "no two patches stand back to back"},
    {{{0, 0, 1, 0}, {2, 0, 3, 0}, {1, 0, 0, 0}},
     HR2D_EFFECT_TWO_SIDED,
     1,
     "patch 0 and patch 2 stand back to back"},
    {{{0, 0, 1, 0}, {1, 1, 0, 1}}, HR2D_EFFECT_FACING, 0, "wholly or not at all"},
    {{{0, 0, 1, 0}, {0, 1, 1, 1}}, HR2D_EFFECT_FACING, 0, "wholly or not at all"},
    {{{0, 0, 1, 0}, {2, -1, 2, 1}},
     HR2D_EFFECT_FACING,
     1,
     "patch 0 and patch 1 see each other in part"},
    {{{0, 0, 1, 0}, {.5, 0, .5, 1}}, HR2D_EFFECT_FACING, 1, "patch 0 and patch 1"},
    {{{0, 0, 1, 0}, {1, 0, 1, 1}}, HR2D_EFFECT_CORNER, 1, "patch 0 and patch 1 touch"},
    {{{0, 0, 1, 0}, {.5, 0, .5, 1}}, HR2D_EFFECT_CORNER, 1, "patch 0 and patch 1 touch"},
    {{{0, 0, 1, 0}, {1, DBL_EPSILON, 1, 1}}, HR2D_EFFECT_CORNER, 0, "do not touch"},
    /* They touch, but see nothing of each other. */
    {{{0, 0, 1, 0}, {1, 0, 2, 0}}, HR2D_EFFECT_CORNER, 0, "do not touch"},
    {{{0, 0, 1, 0}, {1, 0, 1, -1}}, HR2D_EFFECT_CORNER, 0, "do not touch"},
};

START_TEST(effects_have_reasons) {
  for (size_t k = 0; k < sizeof examples / sizeof *examples; k++) {
    const example *x = &examples[k];
    size_t count = 0;
    while (count < 5 && (x->patch[count][0] != x->patch[count][2] ||
                         x->patch[count][1] != x->patch[count][3]))
      count++;
    hr2d_scene *scene = test_scene(x->patch, count);
    const char *reason = NULL;
    ck_assert_msg(hr2d_scene_effect(scene, x->effect, &reason) == x->on, "%zu: %s is %d", k,
                  hr2d_effect_name(x->effect), !x->on);
    ck_assert_msg(strstr(reason, x->reason) != NULL, "\"%s\" is not in \"%s\"", x->reason,
                  reason);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(effects_have_names) {
  const char *const name[] = {"occlusion", "interreflection", "emission", "bands", "two-sided",
                              "facing",    "background",      "corner",   "panes", "medium"};
  ck_assert_uint_eq(sizeof name / sizeof *name, HR2D_EFFECT_COUNT);
  hr2d_scene *scene = test_named_scene("par1");
  for (int k = 0; k < HR2D_EFFECT_COUNT; k++) {
    ck_assert_str_eq(hr2d_effect_name((hr2d_effect)k), name[k]);
    const char *reason = NULL;
    hr2d_scene_effect(scene, (hr2d_effect)k, &reason);
    ck_assert_str_ne(reason, "");
  }
  ck_assert_ptr_null(hr2d_effect_name(HR2D_EFFECT_COUNT));
  ck_assert_ptr_null(hr2d_effect_name((hr2d_effect)-1));
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_COUNT, NULL), 0);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(tiny_occluders_are_found) {
  for (int exponent = 0; exponent >= -1000; exponent -= 50) {
    const double s = ldexp(1, exponent);
    /* A floor, a wall with its foot below, and what hides the edge where they would meet. */
    const double clipped[][4] = {{0, 0, 16 * s, 0},
                                 {24 * s, -4 * s, 24 * s, 16 * s},
                                 {21 * s, 1 * s, 23 * s, 3 * s},
                                 {50, 0, 60, 0}};
    hr2d_scene *scene = test_open_scene(clipped, 4);
    ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_FACING, NULL), 1);
    ck_assert_msg(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL) == 1, "at 2^%d",
                  exponent);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Lines drawn between two patches, from the middles of equal parts, by integers: how
   many of those on which the patches see each other's fronts pass strictly through w. */
static size_t blocked_lines(const lattice *i, const lattice *j, const lattice *w, int parts) {
  const long long m = 2 * parts;
  size_t blocked = 0;
  for (int s = 0; s < parts; s++)
    for (int t = 0; t < parts; t++) {
      const long long xx = m * i->ax + (i->bx - i->ax) * (2 * s + 1),
                      xy = m * i->ay + (i->by - i->ay) * (2 * s + 1),
                      yx = m * j->ax + (j->bx - j->ax) * (2 * t + 1),
                      yy = m * j->ay + (j->by - j->ay) * (2 * t + 1);
      if (lattice_side(m * i->ax, m * i->ay, m * i->bx, m * i->by, yx, yy) <= 0 ||
          lattice_side(m * j->ax, m * j->ay, m * j->bx, m * j->by, xx, xy) <= 0)
        continue;
      blocked += lattice_side(xx, xy, yx, yy, m * w->ax, m * w->ay) *
                         lattice_side(xx, xy, yx, yy, m * w->bx, m * w->by) <
                     0 &&
                 lattice_side(m * w->ax, m * w->ay, m * w->bx, m * w->by, xx, xy) *
                         lattice_side(m * w->ax, m * w->ay, m * w->bx, m * w->by, yx, yy) <
                     0;
    }
  return blocked;
}

/* Fractions [*from, *to] of a patch before a line; 0 if there are none. */
static int clip(const lattice *p, const lattice *line, double *from, double *to) {
  const double dx = (double)(line->bx - line->ax), dy = (double)(line->by - line->ay);
  const double a = dx * (double)(p->ay - line->ay) - dy * (double)(p->ax - line->ax),
               b = dx * (double)(p->by - line->ay) - dy * (double)(p->bx - line->ax);
  *from = a < 0 ? a / (a - b) : 0;
  *to = b < 0 ? a / (a - b) : 1;
  return a > 0 || b > 0;
}

/* How much of w lies inside the hull of the parts of i and j that see each other: the
   fraction that is left of all sides (Cyrus & Beck).  On a lattice of 10 points a
   fraction that is not 0 is above 1e-8. */
static double fraction_inside(const lattice *i, const lattice *j, const lattice *w) {
  double f[2], g[2], from = 0, to = 1;
  if (!clip(i, j, &f[0], &f[1]) || !clip(j, i, &g[0], &g[1])) return 0;
  double corner[5][2];
  for (int k = 0; k < 2; k++) {
    corner[k][0] = (double)i->ax + f[k] * (double)(i->bx - i->ax);
    corner[k][1] = (double)i->ay + f[k] * (double)(i->by - i->ay);
    corner[2 + k][0] = (double)j->ax + g[k] * (double)(j->bx - j->ax);
    corner[2 + k][1] = (double)j->ay + g[k] * (double)(j->by - j->ay);
  }
  memcpy(corner[4], corner[0], sizeof corner[4]);
  for (int k = 0; k < 4; k++) {
    const double dx = corner[k + 1][0] - corner[k][0], dy = corner[k + 1][1] - corner[k][1];
    if (hypot(dx, dy) < 1e-9) continue;
    const double a = dx * ((double)w->ay - corner[k][1]) - dy * ((double)w->ax - corner[k][0]),
                 b = dx * ((double)w->by - corner[k][1]) - dy * ((double)w->bx - corner[k][0]);
    if (a < 1e-9 && b < 1e-9) return 0;
    if (a < 0) from = fmax(from, a / (a - b));
    if (b < 0) to = fmin(to, a / (a - b));
  }
  return to - from > 1e-9 ? to - from : 0;
}

/* The first triple of the patches that the sentence names. */
static void read_triple(const char *reason, size_t *w, size_t *i, size_t *j) {
  ck_assert_int_eq(
      sscanf(reason, "patch %zu can stand between patch %zu and patch %zu", w, i, j), 3);
}

static void check_occlusion(const lattice *p, size_t n, const hr2d_scene *scene,
                            size_t *occluded, size_t *drawn) {
  int inside = 0;
  const char *reason = NULL;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++)
      for (size_t w = 0; w < n; w++) {
        if (w == i || w == j) continue;
        const int here = fraction_inside(&p[i], &p[j], &p[w]) > 0;
        inside |= here;
        if (blocked_lines(&p[i], &p[j], &p[w], 6) > 0) ck_assert(here);
      }
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, &reason), inside);
  if (!inside) return;
  size_t w, i, j;
  read_triple(reason, &w, &i, &j);
  ck_assert_double_gt(fraction_inside(&p[i], &p[j], &p[w]), 0);
  *occluded += 1;
  *drawn += blocked_lines(&p[i], &p[j], &p[w], 48) > 0;
}

START_TEST(occlusion_is_what_lines_find) {
  unsigned long state = test_seed();
  size_t clear = 0, occluded = 0, drawn = 0, min = test_rounds(1000, 10);
  while (clear < min || occluded < min) {
    lattice p[5];
    const size_t n = 3 + (size_t)lattice_random(&state, 3);
    lattice_draw(&state, p, n, 4 + lattice_random(&state, 6), 1 + lattice_random(&state, 5));
    hr2d_scene *scene = lattice_scene(p, n, 0);
    if (hr2d_scene_commit(scene) == HR2D_OK) {
      const size_t before = occluded;
      check_occlusion(p, n, scene, &occluded, &drawn);
      clear += occluded == before;
    }
    hr2d_scene_destroy(scene);
  }
  printf("%zu scenes with occlusion, %zu without; lines found %zu\n", occluded, clear, drawn);
  /* The lines miss slivers that fall between 48 × 48 of them. */
  ck_assert_uint_ge(10 * drawn, 9 * occluded);
}
END_TEST

/* Rooms whose corners lie on a circle, or on a square, walls cut into pieces. */
START_TEST(convex_rooms_have_no_occlusion) {
  unsigned long state = test_seed();
  for (size_t round = 0; round < test_rounds(200, 10); round++) {
    double angle[12], p[12][4];
    const size_t n = 3 + (size_t)lattice_random(&state, 10);
    for (size_t k = 0; k < n; k++) angle[k] = 2 * acos(-1) * test_random(&state);
    qsort(angle, n, sizeof *angle, order_doubles);
    for (size_t k = 0; k < n; k++) {
      const double s = angle[k], t = angle[(k + 1) % n];
      memcpy(p[k], (double[]){cos(s), sin(s), cos(t), sin(t)}, sizeof p[k]);
    }
    hr2d_scene *scene = test_open_scene((const double(*)[4])p, n);
    test_commit(scene);
    const char *reason = NULL;
    ck_assert_msg(!hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, &reason), "%s", reason);
    ck_assert_msg(!hr2d_scene_effect(scene, HR2D_EFFECT_FACING, &reason), "%s", reason);
    hr2d_scene_destroy(scene);
  }
  const double cut[][4] = {{0, 0, 1. / 3, 0}, {1. / 3, 0, .9, 0}, {.9, 0, 1, 0}, {1, 0, 1, .1},
                           {1, .1, 1, 1},     {1, 1, .3, 1},      {.3, 1, 0, 1}, {0, 1, 0, 0}};
  hr2d_scene *scene = test_open_scene(cut, 8);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL), 0);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Two messages that differ at most in the places they name. */
static void check_same_pair(const char *one, const char *other) {
  size_t i, j, k, m;
  if (*one == '\0') {
    ck_assert_str_eq(other, "");
    return;
  }
  lattice_named_pair(one, &i, &j);
  lattice_named_pair(other, &k, &m);
  ck_assert_uint_eq(i, k);
  ck_assert_uint_eq(j, m);
  ck_assert_uint_eq(strcspn(one, "("), strcspn(other, "("));
  ck_assert_int_eq(strncmp(one, other, strcspn(one, "(")), 0);
}

START_TEST(powers_of_two_change_no_answer) {
  unsigned long state = test_seed();
  const int exponent[] = {-1074, -1000, -530, -40, 40, 530, 1000};
  for (size_t round = 0; round < test_rounds(500, 10); round++) {
    lattice p[5];
    const size_t n = 2 + (size_t)lattice_random(&state, 4);
    lattice_draw(&state, p, n, 9, 1 + lattice_random(&state, 5));
    hr2d_scene *scene = lattice_scene(p, n, 0);
    const hr2d_status status = hr2d_scene_commit(scene);
    for (size_t e = 0; e < sizeof exponent / sizeof *exponent; e++) {
      hr2d_scene *scaled = lattice_scene(p, n, exponent[e]);
      ck_assert_int_eq(hr2d_scene_commit(scaled), status);
      check_same_pair(hr2d_scene_message(scaled), hr2d_scene_message(scene));
      for (int k = 0; k < HR2D_EFFECT_COUNT && !status; k++) {
        const char *reason[2] = {NULL, NULL};
        ck_assert_int_eq(hr2d_scene_effect(scaled, (hr2d_effect)k, &reason[0]),
                         hr2d_scene_effect(scene, (hr2d_effect)k, &reason[1]));
        ck_assert_str_eq(reason[0], reason[1]);
      }
      if (!status)
        ck_assert_double_eq(hr2d_scene_unit(scaled),
                            ldexp(hr2d_scene_unit(scene), exponent[e]));
      hr2d_scene_destroy(scaled);
    }
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("effect reasons") {
  ADD_TESTS("reasons", effects_have_reasons, effects_have_names,
            powers_of_two_change_no_answer);
  ADD_TESTS("occlusion", occlusion_is_what_lines_find, tiny_occluders_are_found,
            convex_rooms_have_no_occlusion);
}
