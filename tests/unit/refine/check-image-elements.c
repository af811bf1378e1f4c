/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elements of images: counts, visits and refinements have the same, for any number of threads,
   and budgets know of them. */
#include <hr2d/symmetry.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

enum { KINDS = 3 };

/* Half of a room with a shelf; plates that repeat for ever; a quarter of a room. */
static test_links make(int kind) {
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_patch(scene, (hr2d_segment){{0, 0}, {2, 0}}, 1, .5, HR2D_SIDES_FRONT);
  if (kind == 1) {
    test_add_patch(scene, (hr2d_segment){{2, 1}, {.5, 1.1}}, 0, .5, HR2D_SIDES_BOTH);
    ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){2, 0}), HR2D_OK);
  } else {
    test_add_patch(scene, (hr2d_segment){{2, 0}, {2, 3}}, 0, .7, HR2D_SIDES_FRONT);
    test_add_patch(scene, (hr2d_segment){{.4, 1}, {1, 1.2}}, 0, .7, HR2D_SIDES_BOTH);
    hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 0}, {0, 1}});
  }
  if (kind == 2) hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 3}, {2, 3}});
  test_commit(scene);
  return test_make_links(scene, NULL, NULL, NULL, NULL);
}

static hr2d_status count_visited(void *ctx, const hr2d_link *links, size_t count) {
  (void)links;
  *(uint64_t *)ctx += count;
  return HR2D_OK;
}

START_TEST(counts_and_visits_have_the_elements_of_images) {
  test_links stored = make(_i), seen = make(_i);
  hr2d_refine_options options = test_options(0.2, 9);
  hr2d_refine_counts visited;
  uint64_t links = 0;
  ck_assert_int_eq(hr2d_refine(stored.links, &options), HR2D_OK);
  const hr2d_refine_counts made = hr2d_linkset_counts(stored.links);
  ck_assert_uint_gt(made.elements, 100);
  ck_assert_int_eq(hr2d_refine_visit(seen.links, &options, count_visited, &links, &visited),
                   HR2D_OK);
  ck_assert_uint_eq(links, made.links);
  ck_assert_uint_eq(visited.elements, made.elements);
  for (options.threads = 1; options.threads <= 3; options.threads++) {
    test_links counted = make(_i);
    hr2d_refine_counts counts;
    ck_assert_int_eq(hr2d_refine_count(counted.links, &options, &counts), HR2D_OK);
    ck_assert_uint_eq(counts.elements, made.elements);
    ck_assert_uint_eq(counts.leaves, made.leaves);
    ck_assert_uint_eq(counts.links, made.links);
    ck_assert_uint_eq(hr2d_hierarchy_count(counted.hierarchy).elements, made.elements);
    test_free_links(&counted);
  }
  test_free_links(&stored);
  test_free_links(&seen);
}
END_TEST

/* Nothing is written behind the counts of the patches that were given. */
START_TEST(rows_are_those_of_the_cell) {
  hr2d_row_counts row[2][16], before;
  memset(row, 77, sizeof row);
  before = row[0][15];
  hr2d_refine_options options = test_options(0.5, 6);
  for (int stored = 0; stored < 2; stored++) {
    test_links t = make(_i);
    const size_t patches = hr2d_scene_patches(t.scene);
    hr2d_refine_counts counts;
    options.row_counts = row[stored];
    if (stored)
      ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    else
      ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_OK);
    for (size_t k = patches; k < 16; k++)
      ck_assert_int_eq(memcmp(&row[stored][k], &before, sizeof before), 0);
    test_free_links(&t);
  }
  ck_assert_int_eq(memcmp(row[0], row[1], sizeof row[0]), 0);
}
END_TEST

static hr2d_status within(int kind, hr2d_refine_options options, int how,
                          hr2d_hierarchy_counts *left) {
  test_links t = make(kind);
  hr2d_refine_counts counts;
  uint64_t links = 0;
  const hr2d_status status =
      how == 0   ? hr2d_refine(t.links, &options)
      : how == 1 ? hr2d_refine_count(t.links, &options, &counts)
                 : hr2d_refine_visit(t.links, &options, count_visited, &links, &counts);
  *left = hr2d_hierarchy_count(t.hierarchy);
  if (status) ck_assert_str_ne(hr2d_linkset_message(t.links), "");
  test_free_links(&t);
  return status;
}

START_TEST(budgets_have_the_elements_of_images) {
  hr2d_hierarchy_counts all, left;
  ck_assert_int_eq(within(_i, test_options(0.2, 9), 0, &all), HR2D_OK);
  for (int how = 0; how < 3; how++) {
    hr2d_refine_options options = test_options(0.2, 9);
    options.max_elements = all.elements;
    ck_assert_int_eq(within(_i, options, how, &left), HR2D_OK);
    ck_assert_uint_eq(left.elements, all.elements);
    options.max_elements = all.elements - 1;
    ck_assert_int_eq(within(_i, options, how, &left), HR2D_EMAX_ELEMENTS);
    ck_assert_uint_lt(left.elements, all.elements / 2);
  }
}
END_TEST

/* What is held at once is within the budget, apart from what a move holds twice. */
START_TEST(bytes_have_the_elements_of_images) {
  int refused = 0;
  for (uint64_t bytes = 40000; bytes < 20000000; bytes += bytes / 8) {
    test_links t = make(_i);
    hr2d_refine_options options = test_options(_i == 1 ? 0.05 : 0.003, 12);
    options.max_bytes = bytes;
    const hr2d_status status = hr2d_refine(t.links, &options);
    const hr2d_hierarchy_counts n = hr2d_hierarchy_count(t.hierarchy);
    ck_assert(status == HR2D_OK || status == HR2D_EMAX_BYTES);
    if (!status) ck_assert_uint_le(70 * n.elements + 16 * hr2d_linkset_size(t.links), bytes);
    refused += status != HR2D_OK;
    test_free_links(&t);
  }
  ck_assert_int_gt(refused, 0);
}
END_TEST

/* Whether an element of a room with a mirror at x = 0, or of a row with a period of 2, stands
   where the image of another one does. */
static int is_image_of(const hr2d_element *e, const hr2d_element *of, int row, double unit) {
  const double x = of->centre.x * unit, there = e->centre.x * unit;
  const double periods = (there - x) / 2, off = row ? periods - rint(periods) : there + x;
  return fabs(off) <= 1e-12 && fabs(e->centre.y - of->centre.y) <= 1e-12;
}

START_TEST(originals_are_told) {
  test_links made = make(_i);
  hr2d_refine_options options = test_options(0.2, 9);
  ck_assert_int_eq(hr2d_refine(made.links, &options), HR2D_OK);
  const size_t elements = (size_t)hr2d_hierarchy_count(made.hierarchy).elements;
  const hr2d_element *e = hr2d_hierarchy_elements(made.hierarchy);
  const size_t cell = hr2d_scene_patches(made.scene);
  const size_t all = cell * hr2d_scene_images(made.scene);
  uint32_t *original = malloc(elements * sizeof *original);
  size_t moved = 0;
  ck_assert_int_eq(hr2d_hierarchy_originals(made.hierarchy, original), HR2D_OK);
  for (uint32_t k = 0; k < elements; k++) {
    const uint32_t patch = e[k].patch, of = original[k];
    ck_assert_uint_eq(e[of].patch, patch < all ? patch % cell : patch);
    ck_assert_uint_eq(hr2d_element_level(made.hierarchy, of),
                      hr2d_element_level(made.hierarchy, k));
    if (patch < cell || patch >= all) {
      ck_assert_uint_eq(of, k);
      continue;
    }
    ck_assert(is_image_of(&e[k], &e[of], _i == 1, hr2d_scene_unit(made.scene)));
    moved++;
  }
  ck_assert_uint_gt(moved, 50);
  free(original);
  test_free_links(&made);
}
END_TEST

TEST_SUITE("image-elements") {
  REPEAT_TESTS(KINDS, "all", counts_and_visits_have_the_elements_of_images);
  REPEAT_TESTS(KINDS, "rows", rows_are_those_of_the_cell);
  REPEAT_TESTS(2, "originals", originals_are_told);
  REPEAT_TESTS(KINDS, "budgets", budgets_have_the_elements_of_images);
  REPEAT_TESTS(KINDS, "bytes", bytes_have_the_elements_of_images);
}
