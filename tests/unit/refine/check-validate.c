/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The validator of link sets: it accepts every refinement, names each kind of damage, and
   agrees with a count over all pairs of leaves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/exchange-area.h"
#include "geometry/predicates.h"
#include "links/linkset-impl.h"
#include "support/support.h"

/* Dyadic scenes: all midpoints lie on their patch, to the last bit. */
static const double clipped[][6] = {{0, 0, 1, 0, 1, .5}, {1.5, -.75, 2, 1, 0, .5}};
static const double tee[][6] = {{0, 0, 1, 0, 1, .5}, {.5, 1, .5, 0, 0, .5}};
static const double spokes[][6] = {{0, 0, 1, 0, 1, .5},   {1, 0, 0, 0, 1, .5},
                                   {0, 0, -1, 1, 1, .5},  {-1, 1, 0, 0, 1, .5},
                                   {0, 0, -1, -1, 1, .5}, {-1, -1, 0, 0, 1, .5}};
static const double unequal[][6] = {{0, 0, 4, 0, 1, .5}, {1.25, .5, 1, .5, 0, .5}};
static const double apart[][6] = {{0, 0, 1, 0, 1, .5}, {1, 0, 0, 0, 0, .5}};

enum { SCENES = 9 };

static hr2d_scene *scene_number(size_t k) {
  static const char *const named[] = {"par0.1", "orth1", "orth_touch_rho0.7", "square_rho0.9"};
  if (k < 4) return test_named_scene(named[k]);
  if (k == 4) return test_scene(clipped, 2);
  if (k == 5) return test_scene(tee, 2);
  if (k == 6) return test_scene(spokes, 6);
  if (k == 7) return test_scene(unequal, 2);
  return test_scene(apart, 2);
}

static void check_valid(const test_links *t) {
  const hr2d_status status = hr2d_linkset_validate(t->links);
  ck_assert_msg(status == HR2D_OK, "%s: %s", hr2d_strerror(status),
                hr2d_linkset_message(t->links));
}

static void check_refused(const test_links *t, const char *phrase) {
  ck_assert_int_eq(hr2d_linkset_validate(t->links), HR2D_EINVAL);
  ck_assert_msg(strstr(hr2d_linkset_message(t->links), phrase) != NULL, "\"%s\" is not in: %s",
                phrase, hr2d_linkset_message(t->links));
}

static test_links refined(hr2d_scene *scene, const hr2d_oracle *oracle,
                          const hr2d_policy *policy, const hr2d_refine_options *options) {
  test_links t = test_make_links(scene, oracle, NULL, policy, NULL);
  ck_assert_int_eq(hr2d_refine(t.links, options), HR2D_OK);
  return t;
}

START_TEST(refinements_are_valid) {
  const hr2d_oracle *const oracle[] = {hr2d_oracle_size(), hr2d_oracle_size2(),
                                       hr2d_oracle_bf()};
  const hr2d_policy *const policy[] = {hr2d_policy_original(), hr2d_policy_modified()};
  const double epsilon[] = {1, 0.1, test_multiplier() < 0.5 ? 0.05 : 0.017};
  const unsigned level[] = {HR2D_DEFAULT_MAX_LEVEL, 4, 0};
  uint64_t links = 0, sets = 0;
  for (int k = 0; k < SCENES * 3 * 2 * 3 * 3 * 2; k++, sets++) {
    const int o = k / SCENES, p = o / 3, e = p / 2, l = e / 3;
    const double eps = epsilon[e % 3] * (o % 3 == 1 ? epsilon[e % 3] : 1);
    hr2d_refine_options options = test_options(eps, level[l % 3]);
    options.ordered = l / 3;
    test_links t =
        refined(scene_number((size_t)(k % SCENES)), oracle[o % 3], policy[p % 2], &options);
    check_valid(&t);
    ck_assert_str_eq(hr2d_linkset_message(t.links), "");
    links += hr2d_linkset_size(t.links);
    test_free_links(&t);
  }
  printf("%llu links in %llu sets\n", (unsigned long long)links, (unsigned long long)sets);
  ck_assert_uint_gt(links, 500 * sets);
}
END_TEST

START_TEST(refinements_by_the_exact_oracle_are_valid) {
  const hr2d_oracle *const oracle = hr2d_oracle_find("l1");
  ck_assert_ptr_nonnull(oracle);
  for (size_t k = 0; k < 2 * SCENES; k++)
    for (double epsilon = 0.1; epsilon > 1e-5; epsilon /= 10) {
      const hr2d_refine_options options = test_options(epsilon, 12);
      test_links t = refined(scene_number(k / 2), oracle,
                             k % 2 ? hr2d_policy_modified() : hr2d_policy_original(), &options);
      check_valid(&t);
      test_free_links(&t);
    }
}
END_TEST

START_TEST(multigrid_steps_are_valid) {
  for (size_t k = 0; k < SCENES; k++) {
    test_links t = test_make_links(scene_number(k), NULL, NULL, NULL, NULL);
    hr2d_refine_options options = test_options(2, 10);
    for (; options.epsilon > 0.02; options.epsilon /= 1.7) {
      ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
      check_valid(&t);
    }
    test_free_links(&t);
  }
}
END_TEST

START_TEST(deep_and_lopsided_sets_are_valid) {
  /* Level 60 at a corner: 2^-120 of the product of the patches. */
  const hr2d_refine_options deep = test_options(0.5, 60);
  test_links t = refined(scene_number(2), NULL, NULL, &deep);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).levels, 60);
  check_valid(&t);
  hr2di_store *store = &t.links->store;
  store->count--;
  check_refused(&t, "see each other, but no link joins them");
  store->count++;
  test_free_links(&t);
  /* A hierarchy that another set has refined further. */
  const hr2d_refine_options coarse = test_options(0.5, 4), fine = test_options(0.02, 6);
  t = refined(scene_number(3), NULL, NULL, &coarse);
  test_links other = {t.scene, t.hierarchy, NULL};
  ck_assert_int_eq(hr2d_linkset_create(t.hierarchy, NULL, NULL, NULL, NULL, &other.links),
                   HR2D_OK);
  ck_assert_int_eq(hr2d_refine(other.links, &fine), HR2D_OK);
  check_valid(&other);
  check_valid(&t);
  hr2d_linkset_destroy(other.links);
  test_free_links(&t);
}
END_TEST

/* A turn and a shift leave midpoints an ulp beside their patch. */
static hr2d_scene *turned(const double (*patch)[6], size_t count, double angle, double shift) {
  double moved[6][6];
  for (size_t k = 0; k < count; k++) {
    memcpy(moved[k], patch[k], sizeof moved[k]);
    for (int end = 0; end < 4; end += 2) {
      const double x = patch[k][end], y = patch[k][end + 1];
      moved[k][end] = cos(angle) * x - sin(angle) * y + shift;
      moved[k][end + 1] = sin(angle) * x + cos(angle) * y - shift;
    }
  }
  return test_scene((const double(*)[6])moved, count);
}

START_TEST(rounded_midpoints_are_forgiven) {
  unsigned long state = test_seed();
  const double shift[] = {0, 1, 1e6, 1e12};
  for (int k = 0; k < (int)test_rounds(400, 40); k++) {
    const double angle = 6.3 * test_random(&state), by = shift[k % 4];
    double cut[2][6];
    memcpy(cut, clipped, sizeof cut);
    cut[1][1] = -1.5 * test_random(&state);
    if (k % 2 == 0) { /* all but in one line, so that many signs are rounding alone */
      cut[1][3] = pow(2, -60 * test_random(&state));
      cut[1][1] = -cut[1][3] * pow(2, -50 * test_random(&state));
    }
    hr2d_scene *scene = k % 8 < 4 ? turned((const double(*)[6])cut, 2, angle, by)
                                  : turned(spokes, 6, angle, by);
    test_links t = test_make_links(
        scene, NULL, NULL, k % 3 ? hr2d_policy_original() : hr2d_policy_modified(), NULL);
    hr2d_refine_options options = test_options(1, 10);
    for (; options.epsilon > 0.04; options.epsilon *= 0.3 + 0.2 * test_random(&state)) {
      ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
      check_valid(&t);
    }
    test_free_links(&t);
  }
}
END_TEST

/* Patches all but in one line that face each other fully, in a scene that has a horizon
   elsewhere: further refinement loses nothing of them to rounding. */
START_TEST(multigrid_keeps_what_faces_fully) {
  unsigned long state = test_seed();
  int compared = 0;
  const int enough = (int)test_rounds(100, 21);
  for (int k = 0; k < 20000 && compared < enough; k++) {
    const double tiny = pow(2, -20 - 34 * test_random(&state));
    const double flat[][6] = {{0, 0, 1, 0, 1, .5},
                              {2.25, tiny, 1.25, tiny / 4, 0, .5},
                              {-1, 5, 0, 5, 0, .5},
                              {-2, 5.5, -2, 4.5, 0, .5}};
    const double angle = 6.3 * test_random(&state);
    test_links once = test_make_links(turned(flat, 4, angle, 0), NULL, NULL, NULL, NULL);
    const hr2d_segment i = hr2d_scene_segment(once.scene, 0);
    const hr2d_segment j = hr2d_scene_segment(once.scene, 1);
    if (hr2di_facing_of(&i, &j) != HR2DI_FACING_FULL) { /* the turn has seen to that */
      test_free_links(&once);
      continue;
    }
    compared++;
    test_links grid = test_make_links(turned(flat, 4, angle, 0), NULL, NULL, NULL, NULL);
    hr2d_refine_options options = test_options(1, 10);
    for (; options.epsilon > 0.05; options.epsilon /= 3) {
      ck_assert_int_eq(hr2d_refine(grid.links, &options), HR2D_OK);
      check_valid(&grid);
    }
    options.epsilon *= 3;
    ck_assert_int_eq(hr2d_refine(once.links, &options), HR2D_OK);
    ck_assert_uint_eq(hr2d_linkset_size(once.links), hr2d_linkset_size(grid.links));
    test_free_links(&once);
    test_free_links(&grid);
  }
  ck_assert_int_eq(compared, enough);
}
END_TEST

/* A link set's store, taken apart. */
static hr2d_link *copy_links(const test_links *t) {
  const hr2di_store *store = &t->links->store;
  hr2d_link *link = malloc((size_t)(store->count + 2) * sizeof *link);
  for (uint64_t k = 0; k < store->count; k++) link[k] = *hr2di_store_at(store, k);
  return link;
}

static void put_links(const test_links *t, const hr2d_link *link, uint64_t count) {
  hr2d_linkset *links = t->links;
  hr2di_store_clear(&links->store, &links->alloc);
  for (uint64_t k = 0; k < count; k++)
    ck_assert_int_eq(
        hr2di_store_add(&links->store, &links->alloc, &link[k].pair, &link[k].exchange_area, 1),
        HR2D_OK);
}

/* A link with the right exchange area, so that only its place can be wrong. */
static hr2d_link link_of(const test_links *t, uint32_t first, uint32_t second) {
  hr2d_link link = {{first, second}, 0};
  hr2di_exchange_areas(hr2d_hierarchy_elements(t->hierarchy), &link.pair, 1,
                       &link.exchange_area);
  return link;
}

static int is_below(const test_links *t, uint32_t element, uint32_t top) {
  while (element != top && hr2d_element_level(t->hierarchy, element) > 0)
    element = hr2d_element_parent(t->hierarchy, element);
  return element == top;
}

/* The first two elements that the message names; the patches here have no names. */
static hr2d_pair named_pair(const test_links *t) {
  hr2d_pair pair;
  unsigned patch;
  ck_assert_int_eq(sscanf(hr2d_linkset_message(t->links), "elements %u of patch %u and %u",
                          &pair.first, &patch, &pair.second),
                   3);
  return pair;
}

static void check_named(const test_links *t, hr2d_pair expected) {
  const hr2d_pair named = named_pair(t);
  ck_assert_msg(is_below(t, named.first, expected.first) &&
                    is_below(t, named.second, expected.second),
                "%u and %u are not part of: %s", expected.first, expected.second,
                hr2d_linkset_message(t->links));
}

/* Scenes whose patches see each other wholly, so that no damage can be harmless. */
static test_links small_set(size_t k) {
  hr2d_refine_options options = test_options(0.3, 5);
  options.ordered = k == 1;
  test_links t =
      refined(scene_number(k), NULL, k == 3 ? hr2d_policy_modified() : NULL, &options);
  check_valid(&t);
  return t;
}

START_TEST(missing_and_double_links_are_refused) {
  for (size_t s = 0; s < 4; s++) {
    test_links t = small_set(s);
    const uint64_t count = hr2d_linkset_size(t.links);
    hr2d_link *link = copy_links(&t);
    for (uint64_t k = 0; k < count; k++) {
      const hr2d_link taken = link[k], last = link[count - 1];
      link[k] = last;
      put_links(&t, link, count - 1);
      check_refused(&t, "see each other, but no link joins them");
      check_named(&t, taken.pair);
      link[k] = taken;
      link[count] = taken;
      put_links(&t, link, count + 1);
      check_refused(&t, "are linked twice");
      check_named(&t, taken.pair);
      if (!hr2d_linkset_directed(t.links)) {
        link[count] = link_of(&t, taken.pair.second, taken.pair.first);
        put_links(&t, link, count + 1);
        check_refused(&t, "are linked twice");
      } else {
        link[k] = link_of(&t, taken.pair.second, taken.pair.first);
        put_links(&t, link, count);
        check_refused(&t, "link");
        link[k] = taken;
      }
    }
    put_links(&t, link, count);
    check_valid(&t);
    put_links(&t, link, 0);
    check_refused(&t, "see each other, but no link joins them");
    free(link);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(links_above_and_below_others_are_refused) {
  size_t above = 0, below = 0;
  for (size_t s = 0; s < 4; s++) {
    test_links t = small_set(s);
    const hr2d_element *element = hr2d_hierarchy_elements(t.hierarchy);
    const uint64_t count = hr2d_linkset_size(t.links);
    hr2d_link *link = copy_links(&t);
    for (uint64_t k = 0; k < count; k++) {
      const hr2d_link taken = link[k];
      const uint32_t i = taken.pair.first, j = taken.pair.second;
      const uint32_t up = hr2d_element_parent(t.hierarchy, i);
      if (up != i) {
        link[k] = link_of(&t, up, j);
        put_links(&t, link, count);
        check_refused(&t, "are linked, and so are");
        link[k] = taken;
        above++;
      }
      if (element[j].child) {
        link[count] = link_of(&t, i, element[j].child + (uint32_t)(k % 2));
        put_links(&t, link, count + 1);
        check_refused(&t, "are linked, and so are");
        /* One half of it alone leaves the other uncovered. */
        link[k] = link[count];
        put_links(&t, link, count);
        check_refused(&t, "see each other, but no link joins them");
        link[k] = taken;
        below++;
      }
    }
    free(link);
    test_free_links(&t);
  }
  ck_assert_uint_gt(above, 100);
  ck_assert_uint_gt(below, 100);
}
END_TEST

START_TEST(wrong_exchange_areas_are_refused) {
  for (size_t s = 0; s < 8; s++) {
    test_links t = refined(
        scene_number(s), NULL, NULL,
        &(hr2d_refine_options){sizeof(hr2d_refine_options), .epsilon = 0.5, .max_level = 4});
    check_valid(&t);
    for (uint64_t k = 0; k < hr2d_linkset_size(t.links); k++) {
      hr2d_link *link = &t.links->store.open[k];
      const double right = link->exchange_area;
      const double wrong[] = {right + 1e-12, right - 1e-12,       nextafter(right, 2),
                              -right,        nextafter(right, 0), NAN,
                              HUGE_VAL};
      for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
        link->exchange_area = wrong[w];
        check_refused(&t, ", but their link says ");
        check_named(&t, link->pair);
      }
      link->exchange_area = right;
    }
    check_valid(&t);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(elements_of_other_patches_are_refused) {
  test_links t = small_set(3);
  const uint64_t count = hr2d_linkset_size(t.links);
  const uint32_t n = (uint32_t)hr2d_hierarchy_count(t.hierarchy).elements;
  const hr2d_element *element = hr2d_hierarchy_elements(t.hierarchy);
  hr2d_link *link = copy_links(&t);
  for (uint64_t k = 0; k < count; k += 7) {
    const hr2d_link taken = link[k];
    for (uint32_t e = 0; e < n; e += 3) {
      const int same = element[e].patch == element[taken.pair.second].patch;
      if (e == taken.pair.first) continue;
      link[k] = link_of(&t, e, taken.pair.second);
      put_links(&t, link, count);
      check_refused(&t, same ? "belong to the same patch" : "link");
    }
    link[k] = taken;
    link[k].pair.second = n;
    put_links(&t, link, count);
    check_refused(&t, "but there are only");
    link[k] = taken;
  }
  free(link);
  test_free_links(&t);
  /* Back to back, and behind the horizon. */
  t = refined(
      scene_number(6), NULL, NULL,
      &(hr2d_refine_options){sizeof(hr2d_refine_options), .epsilon = 0.5, .max_level = 3});
  link = copy_links(&t);
  link[hr2d_linkset_size(t.links)] = link_of(&t, 0, 1);
  put_links(&t, link, hr2d_linkset_size(t.links) + 1);
  check_refused(&t, "cannot see each other");
  check_named(&t, (hr2d_pair){0, 1});
  free(link);
  test_free_links(&t);
}
END_TEST

/* Whether two elements see each other, by signs alone. */
static int sees(const hr2d_element *i, const hr2d_element *j) {
  return (hr2d_orientation(i->a, i->b, j->a) > 0 || hr2d_orientation(i->a, i->b, j->b) > 0) &&
         (hr2d_orientation(j->a, j->b, i->a) > 0 || hr2d_orientation(j->a, j->b, i->b) > 0);
}

/* The same question answered by counting, for every two leaves, the links above them. */
static int is_valid_by_count(const test_links *t, const hr2d_link *link, uint64_t count) {
  const hr2d_element *element = hr2d_hierarchy_elements(t->hierarchy);
  const uint32_t n = (uint32_t)hr2d_hierarchy_count(t->hierarchy).elements;
  for (uint64_t k = 0; k < count; k++)
    if (!sees(&element[link[k].pair.first], &element[link[k].pair.second])) return 0;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) {
      if (element[i].child || element[j].child || element[i].patch >= element[j].patch)
        continue;
      int above = 0;
      for (uint64_t k = 0; k < count; k++)
        above += (is_below(t, i, link[k].pair.first) && is_below(t, j, link[k].pair.second)) ||
                 (is_below(t, j, link[k].pair.first) && is_below(t, i, link[k].pair.second));
      if (above > 1 || (above == 0 && sees(&element[i], &element[j]))) return 0;
    }
  return 1;
}

START_TEST(verdicts_are_those_of_counting) {
  unsigned long state = test_seed();
  int valid = 0, rounds = (int)test_rounds(2000, 100);
  for (int round = 0; round < rounds; round++) {
    const size_t s = (size_t)(round % (SCENES - 1));
    hr2d_refine_options options = test_options(2 * test_random(&state), s == 6 ? 2 : 3);
    test_links t =
        refined(scene_number(s), NULL,
                round % 3 ? hr2d_policy_original() : hr2d_policy_modified(), &options);
    uint64_t count = hr2d_linkset_size(t.links);
    const hr2d_element *element = hr2d_hierarchy_elements(t.hierarchy);
    hr2d_link *link = copy_links(&t);
    const uint64_t k = (uint64_t)(test_random(&state) * (double)count);
    const hr2d_pair p = link[k].pair;
    switch (round / SCENES % 6) {
    case 0:
      link[k] = link[--count];
      break;
    case 1:
      link[count++] = link[k];
      break;
    case 2:
      link[k] = link_of(&t, hr2d_element_parent(t.hierarchy, p.first), p.second);
      break;
    case 3:
      link[k] = link_of(&t, p.first, hr2d_element_parent(t.hierarchy, p.second));
      break;
    case 4: { /* between any two elements of different patches */
      const double n = (double)hr2d_hierarchy_count(t.hierarchy).elements;
      const uint32_t i = (uint32_t)(n * test_random(&state));
      const uint32_t j = (uint32_t)(n * test_random(&state));
      if (element[i].patch != element[j].patch) link[count++] = link_of(&t, i, j);
      break;
    }
    default: /* into two, which is as good if both see something */
      if (!element[p.first].child) break;
      link[k] = link_of(&t, element[p.first].child, p.second);
      link[count++] = link_of(&t, element[p.first].child + 1, p.second);
    }
    put_links(&t, link, count);
    const int expected = is_valid_by_count(&t, link, count);
    ck_assert_msg((hr2d_linkset_validate(t.links) == HR2D_OK) == expected,
                  "round %d: by counting %d, but: %s", round, expected,
                  hr2d_linkset_message(t.links));
    valid += expected;
    free(link);
    test_free_links(&t);
  }
  printf("%d of %d damaged sets are valid all the same\n", valid, rounds);
  ck_assert_int_gt(valid, rounds / 20);
  ck_assert_int_lt(valid, rounds / 2);
}
END_TEST

START_TEST(any_allocation_may_fail) {
  const hr2d_refine_options options = test_options(0.3, 5);
  test_links t = refined(scene_number(4), NULL, NULL, &options);
  const hr2d_allocator before = t.links->alloc;
  test_memory memory = {.until_failure = -1};
  t.links->alloc = test_hooks(&memory);
  long failing = 0;
  for (;; failing++) {
    memory.failures = 0;
    memory.until_failure = failing;
    const hr2d_status status = hr2d_linkset_validate(t.links);
    if (memory.failures == 0) {
      ck_assert_int_eq(status, HR2D_OK);
      break;
    }
    ck_assert_int_eq(status, HR2D_ENOMEM);
    ck_assert_str_eq(hr2d_linkset_message(t.links), "out of memory");
  }
  ck_assert_int_ge(failing, 4);
  t.links->alloc = before;
  test_free_links(&t);
}
END_TEST

TEST_SUITE("validate") {
  ADD_TESTS("valid sets", refinements_are_valid, refinements_by_the_exact_oracle_are_valid,
            multigrid_steps_are_valid, deep_and_lopsided_sets_are_valid,
            rounded_midpoints_are_forgiven, multigrid_keeps_what_faces_fully);
  ADD_TESTS("damaged sets", missing_and_double_links_are_refused,
            links_above_and_below_others_are_refused, wrong_exchange_areas_are_refused,
            elements_of_other_patches_are_refused, verdicts_are_those_of_counting,
            any_allocation_may_fail);
}
