/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks that are integrated over directions, against the same integral in long double by
   another rule, and against what the rows of a closed room must be. */
#include <gsl/gsl_math.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "blocks/block.h"
#include "independent/lines-block.h"
#include "support/block-stage.h"
#include "support/pair-kinds.h"
#include "support/support.h"

/* The largest error of a block in terms of its norm.  Where φ_l is steep, at the ends of an
   element, the rounding of places counts l(l+1)/2 times. */
static double bound_of(size_t order) {
  return order <= 8 ? 4e-15 : 1e-14;
}

enum { MOST_ORDER = 16, SQUARE = MOST_ORDER * MOST_ORDER };

/* The block of the leading orders is the leading part of the block. */
static double error_of(const double *block, const long double *expected, size_t order) {
  long double error = 0, norm = 0;
  for (size_t l = 0; l < order; l++)
    for (size_t m = 0; m < order; m++) {
      const long double value = expected[l * MOST_ORDER + m];
      const long double off = (long double)block[l * order + m] - value;
      error += off * off;
      norm += value * value;
    }
  return norm > 0 ? (double)sqrtl(error / norm) : error > 0 ? INFINITY : 0;
}

/* The worst error at each order; 0 if the scene is refused. */
static int compare(const pair_kind *k, const occluded_pair *p, double *worst) {
  block_stage s;
  double block[SQUARE];
  long double expected[SQUARE];
  if (!block_stage_set(&s, p)) return 0;
  lines_block(&s.i, &s.j, s.occluder, s.count, MOST_ORDER, k->steps, expected);
  for (size_t order = 1; order <= MOST_ORDER; order++) {
    if (block_stage_make(&s, order, 0, block)) block_stage_lines(&s, order, block);
    const double error = error_of(block, expected, order);
    if (error > fmax(bound_of(order), worst[order]) && getenv("HR2D_TEST_VERBOSE")) {
      printf("%s: %.2g at order %zu\n", k->name, error, order);
      print_occluded(p);
    }
    worst[order] = fmax(worst[order], error);
  }
  block_stage_end(&s);
  return 1;
}

START_TEST(blocks_are_exact) {
  const pair_kind *k = &pair_kinds[_i];
  double worst[MOST_ORDER + 1] = {0};
  randoms r = randoms_stream(test_seed(), _i);
  int pairs = 0;
  for (int n = 0; n < test_count(30); n++) {
    const occluded_pair p = k->draw(&r);
    pairs += compare(k, &p, worst);
  }
  printf("  %-26s%3d pairs, worst of orders 1, 2, 3, 4, 7, 8, 15, 16", k->name, pairs);
  const size_t shown[] = {1, 2, 3, 4, 7, 8, 15, 16};
  for (size_t n = 0; n < 8; n++) printf(" %.0e", worst[shown[n]]);
  printf("\n");
  ck_assert_int_gt(pairs, 0);
  for (size_t n = 1; n <= MOST_ORDER; n++) ck_assert_double_lt(worst[n], bound_of(n));
}
END_TEST

/* A room with a box, a screen, a wall that touches another one, and a niche; its walls are
   divided towards their ends and at random places. */
static hr2d_scene *furnished_room(void) {
  static const hr2d_segment wall[] = {
      {{0, 0}, {3, 0}},         {{3, 0}, {3, 2}},         {{3, 2}, {1.7, 2}},
      {{1.7, 2}, {1.6, 2.5}},   {{1.6, 2.5}, {1.5, 2}},   {{1.5, 2}, {0, 2.1}},
      {{0, 2.1}, {0, 0}},       {{1, 0.5}, {1, 0.8}},     {{1, 0.8}, {1.4, 0.9}},
      {{1.4, 0.9}, {1.3, 0.5}}, {{1.3, 0.5}, {1, 0.5}},   {{2, 0.3}, {2.2, 1.4}},
      {{2.2, 1.4}, {2, 0.3}},   {{3, 0.75}, {2.5, 0.75}}, {{2.5, 0.75}, {3, 0.75}},
  };
  const double half = 0.5;
  hr2d_scene *scene;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < sizeof wall / sizeof *wall; k++) {
    const hr2d_patch patch = {.a = wall[k].a,
                              .b = wall[k].b,
                              .emission = &half,
                              .emission_bands = 1,
                              .reflectance = &half,
                              .reflectance_bands = 1};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

static uint32_t halve(hr2d_hierarchy *h, uint32_t e) {
  ck_assert_int_eq(hr2di_hierarchy_reserve(h), HR2D_OK);
  return hr2di_element_halve(h, e);
}

static void divide_walls(hr2d_hierarchy *h, randoms *r) {
  const size_t patches = hr2d_scene_patches(h->scene);
  for (size_t k = 0; k < patches; k++)
    for (double t = 0; t <= 1; t++)
      for (int level = random_below(r, 5); level > 0; level--)
        halve(h, hr2d_hierarchy_leaf(h, k, t));
  for (size_t k = 0; k < 2 * patches; k++) {
    const uint32_t e = hr2d_hierarchy_leaf(h, k / 2, random_unit(r));
    const hr2d_element *at = &h->element[e];
    const double part = random_between(r, 0.2, 0.8);
    const hr2d_point cut = {at->a.x + part * (at->b.x - at->a.x),
                            at->a.y + part * (at->b.y - at->a.y)};
    ck_assert_int_eq(hr2di_hierarchy_reserve(h), HR2D_OK);
    hr2di_element_divide(h, e, part, cut);
  }
}

/* The block of two leaves over their lines, however distant they are. */
static void add_lines(hr2di_integrator *w, hr2d_pair both, double *block) {
  hr2di_line_frame frame;
  hr2di_vertex end[4];
  memset(block, 0, w->order * w->order * sizeof *block);
  hr2di_line_frame_init(&frame, w->hierarchy, both);
  ck_assert(hr2di_line_ends(&frame, end, end + 2));
  ck_assert_int_eq(hr2di_block_of_vertices(w, &frame, end, 2, 2, block), HR2D_OK);
  hr2di_moments_end(&w->moments, block);
}

/* Adds what a leaf exchanges with all others of the order of 1 to its row: Σ C_l0. */
static void add_row(hr2di_integrator *w, uint32_t leaf, double *row) {
  const hr2d_hierarchy *h = w->hierarchy;
  double block[SQUARE], turned[SQUARE];
  for (uint32_t e = 0; e < h->elements; e++) {
    if (h->element[e].child || h->element[e].patch == h->element[leaf].patch) continue;
    const hr2d_pair both = {leaf, e}, swap = {e, leaf};
    int distant, other;
    ck_assert_int_eq(hr2di_block(w, both, 0, block, &distant), HR2D_OK);
    ck_assert_int_eq(hr2di_block(w, swap, 0, turned, &other), HR2D_OK);
    ck_assert_int_eq(distant, other);
    for (size_t l = 0; l < w->order; l++)
      for (size_t m = 0; m < w->order; m++)
        ck_assert_double_eq(block[l * w->order + m], turned[m * w->order + l]);
    if (distant) add_lines(w, both, block);
    for (size_t l = 0; l < w->order; l++) row[l] += block[l * w->order];
  }
}

/* In a closed room every point sees patches all around: Σ ∫∫ G V φ_l φ_0 = ∫ φ_l.  The blocks
   of swapped pairs are transposed bit for bit. */
START_TEST(rows_of_closed_rooms_are_full) {
  randoms r = randoms_stream(test_seed(), 77);
  const size_t order = 1 + (size_t)_i;
  hr2d_scene *scene = furnished_room();
  hr2d_hierarchy *h;
  hr2di_integrator w;
  double worst = 0;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  divide_walls(h, &r);
  ck_assert_int_eq(hr2di_integrator_init(&w, h, &h->alloc, order, NULL, NULL), HR2D_OK);
  for (uint32_t e = (uint32_t)(_i % 3); e < h->elements; e += 3) {
    double row[MOST_ORDER] = {0};
    if (h->element[e].child) continue;
    add_row(&w, e, row);
    row[0] -= h->element[e].length;
    for (size_t l = 0; l < order; l++)
      worst = fmax(worst, fabs(row[l]) / sqrt(2.0 * (double)l + 1) / h->element[e].length);
  }
  printf("  order %zu: rows of %zu elements off by at most %.1e\n", order, h->elements, worst);
  ck_assert_double_lt(worst, 4e-15);
  hr2di_integrator_clear(&w);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A room of this many walls, two of them short; none is where coordinates are round. */
enum { SHORT_WALLS = 6 };

static hr2d_scene *room_with_short_walls(void) {
  static const double wall[SHORT_WALLS][6] = {
      {0.1, 0.1, 1.3, 0.2},          {1.3, 0.2, 1.30002, 0.20003}, {1.30002, 0.20003, 1.1, 1.2},
      {1.1, 1.2, 1.0999, 1.2000007}, {1.0999, 1.2000007, 0, 0.9},  {0, 0.9, 0.1, 0.1}};
  return test_scene(wall, SHORT_WALLS);
}

/* Σ AF of a leaf with all leaves of other patches, as the blocks of links have it, less its
   length, relative to that. */
static double row_lacks(hr2di_integrator *w, uint32_t leaf) {
  const hr2d_hierarchy *h = w->hierarchy;
  double block[SQUARE], sum = -h->element[leaf].length;
  for (uint32_t e = 0; e < h->elements; e++) {
    int distant;
    if (h->element[e].child || h->element[e].patch == h->element[leaf].patch) continue;
    ck_assert_int_eq(hr2di_block(w, (hr2d_pair){leaf, e}, 0, block, &distant), HR2D_OK);
    sum += block[0];
  }
  return fabs(sum) / h->element[leaf].length;
}

/* Elements have their places on their patches, whatever the digits of coordinates: a leaf of
   2^-25 of a wall of 4e-5 is 1e-12 long, and its coordinates are off by 1e-4 of that.  The
   first coefficients of distant pairs are exact at order 2, too. */
START_TEST(rows_of_small_elements_are_full) {
  const int levels[] = {4, 12, 25};
  hr2d_scene *scene = room_with_short_walls();
  for (int k = 0; k < 3; k++) {
    hr2d_hierarchy *h;
    hr2di_integrator w;
    double worst = 0;
    ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
    for (size_t p = 0; p < SHORT_WALLS; p++)
      for (double t = 0; t <= 1; t++)
        for (int level = 0; level < levels[k]; level++) halve(h, hr2d_hierarchy_leaf(h, p, t));
    ck_assert_int_eq(hr2di_integrator_init(&w, h, &h->alloc, 2, NULL, NULL), HR2D_OK);
    for (uint32_t e = 0; e < h->elements; e++)
      if (!h->element[e].child) worst = fmax(worst, row_lacks(&w, e));
    printf("  %d levels: rows of %zu elements off by at most %.1e\n", levels[k], h->elements,
           worst);
    ck_assert_double_lt(worst, 1e-14);
    hr2di_integrator_clear(&w);
    hr2d_hierarchy_destroy(h);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Negative control: a vertex that is moved by 1e-13 is noticed. */
START_TEST(moved_vertices_are_noticed) {
  occluded_pair p = {.i = {{0, 0}, {1, 0}},
                     .j = {{1, 1}, {0, 1}},
                     .occluder = {{{0.3, 0.4}, {0.6, 0.5}}},
                     .count = 1};
  const pair_kind exact = {"moved", NULL, 16};
  double worst[2][MOST_ORDER + 1] = {{0}};
  block_stage s;
  double block[SQUARE];
  long double expected[SQUARE];
  ck_assert(compare(&exact, &p, worst[0]));
  lines_block(&p.i, &p.j, p.occluder, p.count, MOST_ORDER, exact.steps, expected);
  p.occluder[0].a.x += 1e-13;
  ck_assert(block_stage_set(&s, &p));
  for (size_t order = 1; order <= MOST_ORDER; order++) {
    block_stage_make(&s, order, 0, block);
    worst[1][order] = error_of(block, expected, order);
    ck_assert_double_lt(worst[0][order], bound_of(order));
    ck_assert_double_gt(worst[1][order], bound_of(order));
  }
  block_stage_end(&s);
}
END_TEST

TEST_SUITE("directions") {
  REPEAT_TESTS((int)pair_kind_count, "directions", blocks_are_exact);
  REPEAT_TESTS(MOST_ORDER, "directions", rows_of_closed_rooms_are_full);
  ADD_TESTS("directions", rows_of_small_elements_are_full, moved_vertices_are_noticed);
}
