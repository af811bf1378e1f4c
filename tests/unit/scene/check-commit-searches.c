/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What commit finds without asking all pairs, against all pairs: which patches first see each
   other in part, which something stands between, and which no light reaches.

   Scenes have integer coordinates, so that every sign is exact and what is visible at all is
   more than a rounding.  HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER change them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene-impl.h"
#include "support/lattice-scenes.h"
#include "support/support.h"

enum { MOST = 40 };

/* An area that is not rounding: on these lattices, areas are 0 or above 1e-8. */
#define SURE 1e-10

typedef struct drawing {
  hr2d_segment s[MOST];
  int lit[MOST];
  size_t count;
} drawing;

static void draw(drawing *d, long long ax, long long ay, long long bx, long long by) {
  if (d->count == MOST || (ax == bx && ay == by)) return;
  d->s[d->count++] = (hr2d_segment){{(double)ax, (double)ay}, {(double)bx, (double)by}};
}

static hr2d_segment turned(hr2d_segment s) {
  return (hr2d_segment){s.b, s.a};
}

static void draw_any(unsigned long *state, drawing *d, long long size) {
  lattice p[MOST];
  const size_t count = (size_t)(2 + lattice_random(state, 10));
  lattice_draw(state, p, count, size, 1 + lattice_random(state, size));
  for (size_t k = 0; k < count; k++) draw(d, p[k].ax, p[k].ay, p[k].bx, p[k].by);
}

/* Walls in pieces, with gaps, some of them turned and some with two fronts. */
static void draw_pieces(unsigned long *state, drawing *d, long long size) {
  for (long long walls = 1 + lattice_random(state, 5); walls > 0; walls--) {
    const long long x = lattice_random(state, size), y = lattice_random(state, size),
                    dx = lattice_random(state, 5) - 2, dy = lattice_random(state, 5) - 2;
    for (long long k = lattice_random(state, 6); k >= 0; k--) {
      if (lattice_random(state, 5) == 0) continue;
      const size_t before = d->count;
      draw(d, x + k * dx, y + k * dy, x + (k + 1) * dx, y + (k + 1) * dy);
      if (d->count == before) continue;
      if (lattice_random(state, 4) == 0) d->s[before] = turned(d->s[before]);
      if (lattice_random(state, 6) == 0 && d->count < MOST)
        d->s[d->count++] = turned(d->s[before]);
    }
  }
}

/* Convex outlines, from the inside, from the outside, or both. */
static void draw_bodies(unsigned long *state, drawing *d, long long size) {
  static const int step[8][2] = {{2, 0},  {1, 1},   {0, 2},  {-1, 1},
                                 {-2, 0}, {-1, -1}, {0, -2}, {1, -1}};
  for (long long bodies = 1 + lattice_random(state, 3); bodies > 0; bodies--) {
    const long long stretch = 1 + lattice_random(state, 3), fronts = lattice_random(state, 5);
    long long x = 2 * lattice_random(state, size), y = 2 * lattice_random(state, size);
    for (int k = 0; k < 8; k++) {
      const long long nx = x + stretch * step[k][0], ny = y + stretch * step[k][1];
      if (fronts != 0) draw(d, x, y, nx, ny);
      if (fronts <= 1) draw(d, nx, ny, x, y);
      x = nx, y = ny;
    }
  }
}

/* A room, and something in it. */
static void draw_room(unsigned long *state, drawing *d, long long size) {
  const long long m = -2, p = size + 2;
  draw(d, m, m, p, m);
  draw(d, p, m, p, p);
  draw(d, p, p, m, p);
  draw(d, m, p, m, m);
  lattice q[MOST];
  const size_t count = (size_t)lattice_random(state, 8);
  lattice_draw(state, q, count, size, 1 + lattice_random(state, size));
  for (size_t k = 0; k < count; k++)
    if (llabs(2 * q[k].bx - size) <= size + 4 && llabs(2 * q[k].by - size) <= size + 4)
      draw(d, q[k].ax, q[k].ay, q[k].bx, q[k].by);
}

static void drop(drawing *d, size_t k) {
  d->count--;
  memmove(d->s + k, d->s + k + 1, (d->count - k) * sizeof *d->s);
}

/* NULL if the patches cannot be committed. */
static hr2d_scene *commit(const drawing *d, size_t pair[2]) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < d->count; k++) {
    const double emission = d->lit[k], reflectance = .5;
    const hr2d_patch patch = {.a = d->s[k].a,
                              .b = d->s[k].b,
                              .emission = &emission,
                              .emission_bands = 1,
                              .reflectance = &reflectance,
                              .reflectance_bands = 1};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  if (hr2d_scene_commit(scene) == HR2D_OK) return scene;
  lattice_named_pair(hr2d_scene_message(scene), &pair[0], &pair[1]);
  hr2d_scene_destroy(scene);
  return NULL;
}

/* Draws until something is left when of each two patches that cross one is dropped. */
static hr2d_scene *draw_scene(unsigned long *state, drawing *d) {
  void (*const kind[])(unsigned long *, drawing *, long long) = {draw_any, draw_pieces,
                                                                 draw_bodies, draw_room};
  for (;;) {
    size_t pair[2];
    hr2d_scene *scene;
    *d = (drawing){0};
    const long long lamps = 1 + lattice_random(state, 5);
    for (size_t k = 0; k < MOST; k++)
      d->lit[k] = lamps == 1 ? k == 0 : lattice_random(state, lamps) == 0;
    kind[lattice_random(state, 4)](state, d, 2 + lattice_random(state, 8));
    while (d->count > 0) {
      if ((scene = commit(d, pair))) return scene;
      drop(d, pair[1]);
    }
  }
}

static int side_of(const hr2d_segment *s, hr2d_point p) {
  return lattice_side((long long)s->a.x, (long long)s->a.y, (long long)s->b.x,
                      (long long)s->b.y, (long long)p.x, (long long)p.y);
}

static int in_part(const hr2d_segment *i, const hr2d_segment *j) {
  const int c = side_of(i, j->a), d = side_of(i, j->b), a = side_of(j, i->a),
            b = side_of(j, i->b);
  return (c > 0 || d > 0) && (a > 0 || b > 0) && (c < 0 || d < 0 || a < 0 || b < 0);
}

/* Writes the first pair that sees each other in part, or "". */
static void expect_facing(const drawing *d, char *text, size_t size) {
  *text = '\0';
  for (size_t i = 0; i < d->count; i++)
    for (size_t j = i + 1; j < d->count; j++)
      if (in_part(&d->s[i], &d->s[j])) {
        snprintf(text, size, "patch %zu and patch %zu see each other in part", i, j);
        return;
      }
}

START_TEST(first_pairs_that_see_each_other_in_part) {
  unsigned long state = test_seed() + 21;
  size_t none = 0, first = 0, later = 0;
  for (int k = test_count(20000); k > 0; k--) {
    drawing d;
    char expected[120];
    const char *reason;
    hr2d_scene *scene = draw_scene(&state, &d);
    expect_facing(&d, expected, sizeof expected);
    ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_FACING, &reason), *expected != '\0');
    if (*expected) ck_assert_str_eq(reason, expected);
    none += *expected == '\0';
    first += strncmp(expected, "patch 0 ", 8) == 0;
    later += *expected && strncmp(expected, "patch 0 ", 8) != 0;
    hr2d_scene_destroy(scene);
  }
  printf("patch 0 is one of the pair in %zu scenes, not in %zu, no pair in %zu\n", first, later,
         none);
  ck_assert(none > 0 && first > 0 && later > 0);
}
END_TEST

static double seen(const drawing *d, size_t i, size_t j) {
  double area;
  ck_assert_int_eq(hr2d_exchange_area_occluded(&d->s[i], &d->s[j], d->s, d->count, NULL, &area),
                   HR2D_OK);
  return area;
}

/* The first pair that exchanges less than it would without the others. */
static int find_occluded(const drawing *d, size_t *i, size_t *j) {
  for (*i = 0; *i < d->count; ++*i)
    for (*j = *i + 1; *j < d->count; ++*j)
      if (hr2d_exchange_area(&d->s[*i], &d->s[*j]) > seen(d, *i, *j) + SURE) return 1;
  return 0;
}

/* Whether a patch hides some of two others from each other. */
static int stands_between(const drawing *d, size_t w, size_t i, size_t j) {
  double area;
  ck_assert(w < d->count && i < j && j < d->count && w != i && w != j);
  ck_assert_int_eq(hr2d_exchange_area_occluded(&d->s[i], &d->s[j], &d->s[w], 1, NULL, &area),
                   HR2D_OK);
  return hr2d_exchange_area(&d->s[i], &d->s[j]) > area + SURE;
}

START_TEST(pairs_with_something_between) {
  unsigned long state = test_seed() + 22;
  size_t occluded = 0, free = 0, later = 0, others = 0;
  for (int round = test_count(20000); round > 0; round--) {
    drawing d;
    const char *reason;
    size_t i = 0, j = 0, w, p, q;
    hr2d_scene *scene = draw_scene(&state, &d);
    const int expected = find_occluded(&d, &i, &j);
    ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, &reason), expected);
    if (expected) {
      ck_assert_int_eq(
          sscanf(reason, "patch %zu can stand between patch %zu and patch %zu", &w, &p, &q), 3);
      ck_assert(stands_between(&d, w, p, q));
      for (size_t k = 0; k < d.count && w != k; k++)
        others += k != p && k != q && !stands_between(&d, k, p, q);
    } else {
      ck_assert_str_eq(reason, "nothing can stand between patches that see each other");
    }
    occluded += expected != 0;
    later += expected && i > 0;
    free += !expected;
    hr2d_scene_destroy(scene);
  }
  printf("%zu scenes with occlusion, in %zu not of patch 0; %zu without; %zu patches are not "
         "what stands between\n",
         occluded, later, free, others);
  ck_assert(occluded > 0 && later > 0 && free > 0 && others > 0);
}
END_TEST

/* Marks what light reaches over pairs that exchange more than `min`, or, `around` = 0, would
   if nothing were in the way. */
static void spread(const drawing *d, double min, int around, int *lit) {
  size_t queue[MOST], count = 0;
  for (size_t k = 0; k < d->count; k++)
    if ((lit[k] = d->lit[k])) queue[count++] = k;
  for (size_t k = 0; k < count; k++)
    for (size_t j = 0; j < d->count; j++)
      if (!lit[j] && (around ? seen(d, queue[k], j)
                             : hr2d_exchange_area(&d->s[queue[k]], &d->s[j])) > min) {
        lit[j] = 1;
        queue[count++] = j;
      }
}

START_TEST(dark_patches) {
  unsigned long state = test_seed() + 23;
  size_t dark = 0, lit_over_others = 0, behind = 0;
  for (int round = test_count(20000); round > 0; round--) {
    drawing d;
    int lit[MOST], through[MOST];
    hr2d_scene *scene = draw_scene(&state, &d);
    spread(&d, SURE, 1, lit);
    spread(&d, SURE, 0, through);
    for (size_t k = 0; k < d.count; k++) {
      ck_assert_msg(hr2di_scene_lit(scene, k) == lit[k], "%zu of %zu", k, d.count);
      dark += !lit[k];
      lit_over_others += lit[k] && !d.lit[k];
      behind += lit[k] != through[k];
    }
    hr2d_scene_destroy(scene);
  }
  printf("%zu patches are dark, %zu of them behind others; %zu are lit by others\n", dark,
         behind, lit_over_others);
  ck_assert(dark > 0 && behind > 0 && lit_over_others > 0);
}
END_TEST

/* An ulp of 4: coordinates are below 64. */
static double off_by_an_ulp(unsigned long *state, double x) {
  return x + (lattice_random(state, 2) ? 0x1p-50 : -0x1p-50);
}

/* Coordinates that are off by about an ulp change nothing that is more than a rounding. */
START_TEST(roundings_hide_nothing) {
  unsigned long state = test_seed() + 24;
  size_t committed = 0, occluded = 0;
  for (int round = test_count(20000); round > 0; round--) {
    drawing d;
    size_t pair[2];
    int lit[MOST];
    hr2d_scene *exact = draw_scene(&state, &d);
    drawing off = d;
    for (size_t k = 0; k < d.count; k++) {
      off.s[k].a.x = off_by_an_ulp(&state, d.s[k].a.x);
      off.s[k].a.y = off_by_an_ulp(&state, d.s[k].a.y);
      off.s[k].b.x = off_by_an_ulp(&state, d.s[k].b.x);
      off.s[k].b.y = off_by_an_ulp(&state, d.s[k].b.y);
    }
    hr2d_scene *scene = commit(&off, pair);
    spread(&d, SURE, 1, lit);
    for (size_t k = 0; k < d.count && scene; k++)
      ck_assert(!lit[k] || hr2di_scene_lit(scene, k));
    const int in_way = hr2d_scene_effect(exact, HR2D_EFFECT_OCCLUSION, NULL);
    if (scene && in_way) ck_assert(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL));
    committed += scene != NULL;
    occluded += scene && in_way;
    hr2d_scene_destroy(exact);
    hr2d_scene_destroy(scene);
  }
  printf("%zu scenes, %zu with occlusion\n", committed, occluded);
  ck_assert(committed > 0 && occluded > 0);
}
END_TEST

TEST_SUITE("commit searches") {
  ADD_TESTS("searches", first_pairs_that_see_each_other_in_part, pairs_with_something_between,
            dark_patches, roundings_hide_nothing);
}
