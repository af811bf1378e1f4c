/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threads that share the links of a gather above order 1 add up what one thread does, to the
   last bit. */
#include <stdlib.h>
#include <string.h>

#include "solve/transport.h"
#include "support/slow-scenes.h"
#include "support/support.h"

enum { PATCHES = 60, ORDER = 9, MOST_BANDS = 7 };

static test_links make(size_t bands, int directed) {
  hr2d_scene *from = NULL, *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &from), HR2D_OK);
  ck_assert_int_eq(slow_add(from, SLOW_SQUARES, PATCHES), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < hr2d_scene_patches(from); k++) {
    const hr2d_segment s = hr2d_scene_segment(from, k);
    double emission[MOST_BANDS], rho[MOST_BANDS];
    for (size_t b = 0; b < bands; b++) {
      emission[b] = (double)((k + b) % 5 == 0);
      rho[b] = 0.3 + 0.1 * (double)(b % 5);
    }
    const hr2d_patch patch = {.a = s.a,
                              .b = s.b,
                              .emission = emission,
                              .emission_bands = bands,
                              .reflectance = rho,
                              .reflectance_bands = bands,
                              .sides = HR2D_SIDES_FRONT};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  hr2d_scene_destroy(from);
  test_commit(scene);
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  hr2d_refine_options options = test_options(0.15, 4);
  options.ordered = directed;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, ORDER), HR2D_OK);
  return t;
}

/* How many slices there are depends on the links alone, and there is more than one. */
static void check_slices(const test_links *t, unsigned threads) {
  hr2di_transport transport, alone;
  ck_assert_int_eq(hr2di_transport_init(&transport, t->links, 0, threads, NULL), HR2D_OK);
  ck_assert_int_eq(hr2di_transport_init(&alone, t->links, 0, 1, NULL), HR2D_OK);
  ck_assert_uint_ge(transport.slices, 2);
  ck_assert_uint_eq(transport.slices, alone.slices);
  hr2di_transport_clear(&transport);
  hr2di_transport_clear(&alone);
}

START_TEST(threads_change_no_bit) {
  static const size_t numbers_of_bands[] = {1, 3, MOST_BANDS};
  const size_t bands = numbers_of_bands[_i / 2];
  test_links t = make(bands, _i % 2);
  static const unsigned threads[] = {1, 2, 3, 40};
  double *expected = NULL;
  size_t count = 0;
  for (int k = 0; k < 4; k++) {
    hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
    hr2d_solution *s = NULL;
    options.threads = threads[k];
    check_slices(&t, threads[k]);
    ck_assert_int_eq(hr2d_solve(t.links, &options, &s), HR2D_OK);
    count = (size_t)hr2d_hierarchy_count(t.hierarchy).elements * bands;
    double *found = malloc(count * sizeof *found);
    ck_assert_ptr_nonnull(found);
    for (size_t e = 0; e < count; e++)
      found[e] = hr2d_solution_element(s, (uint32_t)(e / bands), e % bands);
    hr2d_solution_destroy(s);
    if (!expected) {
      expected = found;
      continue;
    }
    ck_assert_int_eq(memcmp(found, expected, count * sizeof *found), 0);
    free(found);
  }
  double min = expected[0], max = expected[0];
  for (size_t e = 0; e < count; e++) {
    if (expected[e] < min) min = expected[e];
    if (expected[e] > max) max = expected[e];
  }
  printf("%llu links, %zu elements, B from %.3g to %.3g\n",
         (unsigned long long)hr2d_linkset_size(t.links), count / bands, min, max);
  ck_assert(max > min);
  free(expected);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("slices") {
  REPEAT_TESTS(6, "gather", threads_change_no_bit);
}
