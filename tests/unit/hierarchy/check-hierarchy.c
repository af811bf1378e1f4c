/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hierarchies: invariants of the trees after any refinement, and the search from a point to
   its leaf. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

static hr2d_hierarchy *hierarchy_on(const hr2d_scene *scene) {
  hr2d_hierarchy *hierarchy = NULL;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &hierarchy), HR2D_OK);
  return hierarchy;
}

static hr2d_linkset *links_on(hr2d_hierarchy *hierarchy, const hr2d_oracle *oracle,
                              const hr2d_policy *policy) {
  hr2d_linkset *links = NULL;
  ck_assert_int_eq(hr2d_linkset_create(hierarchy, oracle, NULL, policy, NULL, &links), HR2D_OK);
  return links;
}

static hr2d_status refine(hr2d_linkset *links, double epsilon, unsigned max_level) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  options.max_level = max_level;
  return hr2d_refine(links, &options);
}

static void check_same_point(hr2d_point p, hr2d_point q) {
  ck_assert_mem_eq(&p, &q, sizeof p);
}

/* A centre is the rounded mean of the ends. */
static void check_centre(const hr2d_element *e) {
  ck_assert_double_eq(2 * e->centre.x, e->a.x + e->b.x);
  ck_assert_double_eq(2 * e->centre.y, e->a.y + e->b.y);
}

static void check_root(const hr2d_hierarchy *h, uint32_t k) {
  const hr2d_scene *scene = hr2d_hierarchy_scene(h);
  const double unit = hr2d_scene_unit(scene);
  const hr2d_segment s = hr2d_scene_segment(scene, k);
  const hr2d_element *e = &hr2d_hierarchy_elements(h)[k];
  ck_assert_double_eq(e->a.x * unit, s.a.x);
  ck_assert_double_eq(e->a.y * unit, s.a.y);
  ck_assert_double_eq(e->b.x * unit, s.b.x);
  ck_assert_double_eq(e->b.y * unit, s.b.y);
  ck_assert_double_eq(e->length * unit, hr2d_scene_length(scene, k));
  ck_assert_uint_eq(e->patch, k);
  ck_assert_uint_eq(hr2d_element_parent(h, k), k);
  ck_assert_uint_eq(hr2d_element_level(h, k), 0);
}

static void check_children(const hr2d_hierarchy *h, uint32_t k) {
  const hr2d_element *element = hr2d_hierarchy_elements(h), *e = &element[k];
  ck_assert_uint_gt(e->child, k);
  ck_assert_uint_lt(e->child + 1, hr2d_hierarchy_count(h).elements);
  const hr2d_element *left = &element[e->child], *right = left + 1;
  check_same_point(left->a, e->a);
  check_same_point(left->b, e->centre);
  check_same_point(right->a, e->centre);
  check_same_point(right->b, e->b);
  for (uint32_t c = 0; c < 2; c++) {
    ck_assert_double_eq(left[c].length, e->length / 2);
    ck_assert_uint_eq(left[c].patch, e->patch);
    ck_assert_uint_eq(hr2d_element_parent(h, e->child + c), k);
    ck_assert_uint_eq(hr2d_element_level(h, e->child + c), hr2d_element_level(h, k) + 1);
  }
}

static void check_trees(const hr2d_hierarchy *h) {
  const hr2d_hierarchy_counts counts = hr2d_hierarchy_count(h);
  const size_t roots = hr2d_scene_patches(hr2d_hierarchy_scene(h));
  const hr2d_element *element = hr2d_hierarchy_elements(h);
  uint64_t leaves = 0, children = 0;
  unsigned levels = 0;
  for (uint32_t k = 0; k < counts.elements; k++) {
    if (k < roots)
      check_root(h, k);
    else
      ck_assert_uint_lt(hr2d_element_parent(h, k), k);
    check_centre(&element[k]);
    leaves += !element[k].child;
    if (element[k].child) {
      check_children(h, k);
      children += 2;
    }
    if (hr2d_element_level(h, k) > levels) levels = hr2d_element_level(h, k);
  }
  ck_assert_uint_eq(leaves, counts.leaves);
  ck_assert_uint_eq(levels, counts.levels);
  ck_assert_uint_eq(roots + children, counts.elements);
}

START_TEST(a_new_hierarchy_is_its_roots) {
  hr2d_scene *scene = test_named_scene("square_rho0.9");
  hr2d_hierarchy *h = hierarchy_on(scene);
  const hr2d_hierarchy_counts counts = hr2d_hierarchy_count(h);
  ck_assert_uint_eq(counts.elements, 4);
  ck_assert_uint_eq(counts.leaves, 4);
  ck_assert_uint_eq(counts.levels, 0);
  ck_assert_ptr_eq(hr2d_hierarchy_scene(h), scene);
  check_trees(h);
  for (size_t k = 0; k < 4; k++) {
    ck_assert_uint_eq(hr2d_hierarchy_elements(h)[k].child, 0);
    for (double t = 0; t <= 1; t += 0.25) ck_assert_uint_eq(hr2d_hierarchy_leaf(h, k, t), k);
  }
  hr2d_hierarchy_destroy(h);
  hr2d_hierarchy_destroy(NULL);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(a_scene_must_be_committed) {
  hr2d_scene *scene = NULL;
  hr2d_hierarchy *h = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_ESTATE);
  hr2d_patch patch = HR2D_PATCH_INIT;
  patch.b.x = 1;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_ESTATE);
  ck_assert_ptr_null(h);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  h = hierarchy_on(scene);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A room of odd lengths, far from the origin and at a scale of its own. */
static hr2d_scene *odd_room(double scale) {
  double p[5][6] = {{10.1, 7, 11.7, 7.3, 1, .5},
                    {11.7, 7.3, 11.9, 9, 0, .5},
                    {11.9, 9, 11, 9.1, 0, .5},
                    {11, 9.1, 10, 8.7, 0, .5},
                    {10, 8.7, 10.1, 7, 0, .5}};
  for (int k = 0; k < 20; k++) p[k / 4][k % 4] *= scale;
  return test_scene((const double(*)[6])p, 5);
}

START_TEST(trees_hold_together) {
  const double scale[] = {1, 1e-3, 3e200, 7e-300};
  const hr2d_policy *const policy[] = {hr2d_policy_original(), hr2d_policy_modified()};
  for (size_t k = 0; k < 8; k++) {
    hr2d_scene *scene = odd_room(scale[k / 2]);
    hr2d_hierarchy *h = hierarchy_on(scene);
    hr2d_linkset *links = links_on(h, NULL, policy[k % 2]);
    ck_assert_int_eq(refine(links, 0.3, 12), HR2D_OK);
    ck_assert_uint_gt(hr2d_hierarchy_count(h).elements, 300);
    ck_assert_uint_eq(hr2d_hierarchy_count(h).levels, 12);
    check_trees(h);
    hr2d_linkset_destroy(links);
    hr2d_hierarchy_destroy(h);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Where an element begins, as a fraction of its patch; exact up to level 52. */
static double start_of(const hr2d_hierarchy *h, uint32_t element) {
  double start = 0;
  while (hr2d_element_level(h, element) > 0) {
    const uint32_t parent = hr2d_element_parent(h, element);
    if (element != hr2d_hierarchy_elements(h)[parent].child)
      start += ldexp(1, -(int)hr2d_element_level(h, element));
    element = parent;
  }
  return start;
}

/* The leaf whose span [start, start + 2^-level) holds t; the last one holds 1. */
static uint32_t search_leaf(const hr2d_hierarchy *h, size_t patch, const double *start,
                            double t) {
  const hr2d_element *element = hr2d_hierarchy_elements(h);
  uint32_t found = UINT32_MAX;
  for (uint32_t k = 0; k < hr2d_hierarchy_count(h).elements; k++) {
    if (element[k].patch != patch || element[k].child) continue;
    const double end = start[k] + ldexp(1, -(int)hr2d_element_level(h, k));
    if (t < start[k] || (t >= end && !(t == 1 && end == 1))) continue;
    ck_assert_uint_eq(found, UINT32_MAX);
    found = k;
  }
  ck_assert_uint_ne(found, UINT32_MAX);
  return found;
}

START_TEST(points_are_in_their_leaves) {
  unsigned long state = test_seed();
  hr2d_scene *scene = odd_room(1);
  hr2d_hierarchy *h = hierarchy_on(scene);
  hr2d_linkset *links = links_on(h, NULL, NULL);
  ck_assert_int_eq(refine(links, 0.25, 20), HR2D_OK);
  const uint64_t n = hr2d_hierarchy_count(h).elements;
  double *start = calloc((size_t)n, sizeof *start);
  for (uint32_t k = 0; k < n; k++) start[k] = start_of(h, k);
  for (size_t round = 0; round < test_rounds(3000, 50); round++) {
    const size_t patch = round % 5;
    double t = test_random(&state);
    const int bits = (int)(21 * test_random(&state));
    if (round % 3 == 0) t = ldexp(floor(ldexp(t, bits)), -bits); /* often a border */
    if (round % 3 == 1) t = nextafter(ldexp(floor(ldexp(t, bits)), -bits), (double)(round % 2));
    if (round % 50 < 5) t = 1;
    if (round % 50 > 44) t = 0;
    const uint32_t leaf = hr2d_hierarchy_leaf(h, patch, t);
    ck_assert_uint_eq(leaf, search_leaf(h, patch, start, t));
    /* The point itself lies between the leaf's ends. */
    const hr2d_segment s = hr2d_scene_segment(scene, patch);
    const hr2d_element *e = &hr2d_hierarchy_elements(h)[leaf];
    const double x = (s.a.x + t * (s.b.x - s.a.x)) / hr2d_scene_unit(scene);
    ck_assert_double_le(fmin(e->a.x, e->b.x), x + 1e-15);
    ck_assert_double_ge(fmax(e->a.x, e->b.x), x - 1e-15);
  }
  free(start);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(every_leaf_holds_its_start_and_its_middle) {
  hr2d_scene *scene = test_named_scene("orth_touch_rho0.7");
  hr2d_hierarchy *h = hierarchy_on(scene);
  hr2d_linkset *links = links_on(h, NULL, NULL);
  ck_assert_int_eq(refine(links, 0.5, 50), HR2D_OK);
  ck_assert_uint_eq(hr2d_hierarchy_count(h).levels, 50);
  const hr2d_element *element = hr2d_hierarchy_elements(h);
  for (uint32_t k = 0; k < hr2d_hierarchy_count(h).elements; k++) {
    if (element[k].child) continue;
    const double start = start_of(h, k), width = ldexp(1, -(int)hr2d_element_level(h, k));
    ck_assert_uint_eq(hr2d_hierarchy_leaf(h, element[k].patch, start), k);
    ck_assert_uint_eq(hr2d_hierarchy_leaf(h, element[k].patch, start + width / 2), k);
    if (start + width < 1)
      ck_assert_uint_ne(hr2d_hierarchy_leaf(h, element[k].patch, start + width), k);
  }
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(hierarchies_of_a_scene_are_independent) {
  hr2d_scene *scene = test_named_scene("par0.1");
  hr2d_hierarchy *first = hierarchy_on(scene), *second = hierarchy_on(scene);
  hr2d_linkset *links = links_on(first, NULL, NULL);
  ck_assert_int_eq(refine(links, 0.25, 24), HR2D_OK);
  ck_assert_uint_eq(hr2d_hierarchy_count(first).elements, 254);
  ck_assert_uint_eq(hr2d_hierarchy_count(second).elements, 2);
  hr2d_linkset *others = links_on(second, NULL, NULL);
  ck_assert_int_eq(refine(others, 1, 24), HR2D_OK);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(first);
  ck_assert_uint_eq(hr2d_hierarchy_count(second).elements, 62);
  check_trees(second);
  hr2d_linkset_destroy(others);
  hr2d_hierarchy_destroy(second);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A link by its geometry, which does not depend on the numbers of elements. */
typedef struct span {
  double a[4], b[4], area;
} span;

static int compare_spans(const void *left, const void *right) {
  return memcmp(left, right, sizeof(span));
}

static span *sorted_spans(const hr2d_linkset *links) {
  const hr2d_element *element = hr2d_hierarchy_elements(hr2d_linkset_hierarchy(links));
  const uint64_t n = hr2d_linkset_size(links);
  span *spans = calloc((size_t)n + 1, sizeof *spans);
  for (uint64_t k = 0; k < n; k++) {
    const hr2d_link link = hr2d_linkset_get(links, k);
    const hr2d_element *i = &element[link.pair.first], *j = &element[link.pair.second];
    spans[k] = (span){
        {i->a.x, i->a.y, i->b.x, i->b.y}, {j->a.x, j->a.y, j->b.x, j->b.y}, link.exchange_area};
  }
  qsort(spans, (size_t)n, sizeof *spans, compare_spans);
  return spans;
}

static void check_as_if_alone(const hr2d_linkset *links, const hr2d_oracle *oracle,
                              const hr2d_policy *policy, double epsilon) {
  hr2d_hierarchy *h = hierarchy_on(hr2d_hierarchy_scene(hr2d_linkset_hierarchy(links)));
  hr2d_linkset *alone = links_on(h, oracle, policy);
  ck_assert_int_eq(refine(alone, epsilon, 10), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(links), hr2d_linkset_size(alone));
  span *here = sorted_spans(links), *there = sorted_spans(alone);
  ck_assert_mem_eq(here, there, (size_t)hr2d_linkset_size(links) * sizeof *here);
  free(here);
  free(there);
  ck_assert_uint_ge(hr2d_hierarchy_count(hr2d_linkset_hierarchy(links)).elements,
                    hr2d_hierarchy_count(h).elements);
  hr2d_linkset_destroy(alone);
  hr2d_hierarchy_destroy(h);
}

/* Two sets refine one hierarchy in turns; elements stay, and each set gets the links
   that it would get alone. */
START_TEST(link_sets_share_a_hierarchy) {
  hr2d_scene *scene = odd_room(1);
  hr2d_hierarchy *h = hierarchy_on(scene);
  const hr2d_oracle *const oracle[] = {hr2d_oracle_size(), hr2d_oracle_size2()};
  const hr2d_policy *const policy[] = {hr2d_policy_original(), hr2d_policy_modified()};
  hr2d_linkset *const links[] = {links_on(h, oracle[0], policy[0]),
                                 links_on(h, oracle[1], policy[1])};
  for (int turn = 0; turn < 4; turn++) {
    const int who = turn % 2;
    const double epsilon = (who ? 0.4 : 0.8) / (1 << turn / 2);
    const hr2d_hierarchy_counts before = hr2d_hierarchy_count(h);
    hr2d_element *old = malloc((size_t)before.elements * sizeof *old);
    memcpy(old, hr2d_hierarchy_elements(h), (size_t)before.elements * sizeof *old);
    ck_assert_int_eq(refine(links[who], epsilon, 10), HR2D_OK);
    const hr2d_element *element = hr2d_hierarchy_elements(h);
    for (uint64_t k = 0; k < before.elements; k++) {
      ck_assert(old[k].child == element[k].child || old[k].child == 0);
      old[k].child = element[k].child;
      ck_assert_mem_eq(&old[k], &element[k], sizeof *old);
    }
    free(old);
    check_trees(h);
    check_as_if_alone(links[who], oracle[who], policy[who], epsilon);
  }
  /* A refinement that fails takes back its own elements alone. */
  const hr2d_hierarchy_counts before = hr2d_hierarchy_count(h);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 0.01;
  options.max_elements = before.elements + 1000;
  for (int who = 0; who < 2; who++) {
    ck_assert_int_eq(hr2d_refine(links[who], &options), HR2D_EMAX_ELEMENTS);
    const hr2d_hierarchy_counts after = hr2d_hierarchy_count(h);
    ck_assert_uint_eq(after.elements, before.elements);
    ck_assert_uint_eq(after.leaves, before.leaves);
    ck_assert_uint_eq(after.levels, before.levels);
    check_trees(h);
  }
  hr2d_linkset_destroy(links[0]);
  hr2d_linkset_destroy(links[1]);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("hierarchy") {
  ADD_TESTS("trees", a_new_hierarchy_is_its_roots, a_scene_must_be_committed,
            trees_hold_together, hierarchies_of_a_scene_are_independent,
            link_sets_share_a_hierarchy);
  ADD_TESTS("leaves", points_are_in_their_leaves, every_leaf_holds_its_start_and_its_middle);
}
