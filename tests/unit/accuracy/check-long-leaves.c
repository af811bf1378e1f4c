/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The longest leaves are halved, of patches that reflect light, until Σh³ is small enough. */
#include <math.h>

#include "accuracy/long-leaves.h"
#include "support/support.h"

/* Long and short walls; the first one is black. */
static hr2d_scene *room(void) {
  const double patch[][6] = {
      {0, 0, 4, 0, 1, 0}, {4, 0, 4, 1, 0, .5}, {4, 1, 0.25, 1, 0, .5}, {0.25, 1, 0, 0, 0, .5}};
  return test_scene(patch, sizeof patch / sizeof *patch);
}

/* Σh³, and the longest and the shortest h, of leaves that may be divided. */
typedef struct sizes {
  double sum, most, least;
} sizes;

static sizes sizes_of(const hr2d_hierarchy *h) {
  sizes s = {0, 0, HUGE_VAL};
  for (size_t k = 0; k < h->elements; k++) {
    const hr2d_element *e = &h->element[k];
    if (e->child || e->patch == 0) continue;
    s.sum += e->length * e->length * e->length;
    s.most = fmax(s.most, e->length);
    s.least = fmin(s.least, e->length);
  }
  return s;
}

START_TEST(the_longest_leaves_are_halved) {
  hr2d_scene *scene = room();
  hr2d_hierarchy *h;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  const sizes before = sizes_of(h);
  ck_assert_int_eq(hr2di_long_leaves_halve(h, 0, 0, NULL), HR2D_OK);
  ck_assert_uint_eq(h->elements, 4);
  const unsigned times = (unsigned)_i + 1;
  ck_assert_int_eq(hr2di_long_leaves_halve(h, times, 0, NULL), HR2D_OK);
  const sizes after = sizes_of(h);
  ck_assert_double_le(after.sum, before.sum * pow(0.125, times));
  ck_assert_uint_eq(h->element[0].child, 0);
  /* No leaf is much shorter than others, but for those that were. */
  ck_assert(after.least == before.least || after.least > 0.49 * after.most);
  /* As few as that: with leaves twice as long more would be left. */
  ck_assert_double_gt(after.sum, before.sum * pow(0.125, times) / 16);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(limits_are_kept) {
  hr2d_scene *scene = room();
  hr2d_hierarchy *h;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  ck_assert_int_eq(hr2di_long_leaves_halve(h, 4, 20, NULL), HR2D_EMAX_ELEMENTS);
  ck_assert_uint_le(h->elements, 20);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("long leaves") {
  REPEAT_TESTS(4, "long leaves", the_longest_leaves_are_halved);
  ADD_TESTS("long leaves", limits_are_kept);
}
