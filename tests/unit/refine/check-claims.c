/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A refinement in parts: rows, and pairs that are claimed, add up to the whole, and a part
   costs its part of the work. */
#include <stdlib.h>
#include <string.h>

#include "hierarchy/hierarchy-impl.h"
#include "support/slow-scenes.h"
#include "support/support.h"

enum { PATCHES = 60, PARTS = 4, MOST_LINKS = 1 << 20 };

static test_links make(slow_kind kind) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(slow_add(scene, kind, PATCHES), HR2D_OK);
  test_commit(scene);
  return test_make_links(scene, NULL, NULL, NULL, NULL);
}

/* A share of the pairs: by the half of its patch in which the first element lies, and by the
   number of the patch. */
typedef struct share {
  unsigned wanted;
  uint64_t asked;
  hr2d_status fails;
} share;

/* A link by the places of its elements, which have other numbers in each part. */
typedef struct placed {
  hr2d_segment first, second;
  double area;
} placed;

typedef struct collected {
  const hr2d_hierarchy *of;
  placed *link;
  size_t count;
  const share *by; /* NULL: takes all */
} collected;

static hr2d_segment place(const hr2d_hierarchy *h, uint32_t element) {
  return (hr2d_segment){h->element[element].a, h->element[element].b};
}

/* Of links of whole patches, which all shares have, the first half takes them. */
static int is_mine(const collected *c, uint32_t first) {
  const uint32_t patch = c->of->element[first].patch;
  return !c->by || first != patch || c->by->wanted == 2 * (patch % 2);
}

static hr2d_status collect(void *ctx, const hr2d_link *link, size_t count) {
  collected *c = ctx;
  ck_assert_uint_le(c->count + count, MOST_LINKS);
  for (size_t k = 0; k < count; k++)
    if (is_mine(c, link[k].pair.first))
      c->link[c->count++] = (placed){place(c->of, link[k].pair.first),
                                     place(c->of, link[k].pair.second), link[k].exchange_area};
  return HR2D_OK;
}

static hr2d_refine_counts visit(slow_kind kind, const hr2d_refine_options *options,
                                collected *c) {
  test_links t = make(kind);
  hr2d_refine_counts counts;
  c->of = t.hierarchy;
  ck_assert_int_eq(hr2d_refine_visit(t.links, options, collect, c, &counts), HR2D_OK);
  test_free_links(&t);
  return counts;
}

static collected collected_none(void) {
  return (collected){.link = calloc(MOST_LINKS, sizeof(placed))};
}

static void add(hr2d_refine_counts *sum, const hr2d_refine_counts *part) {
  sum->links += part->links;
  sum->limited_links += part->limited_links;
  sum->oracle_calls += part->oracle_calls;
  sum->facing_tests += part->facing_tests;
  sum->visibility_tests += part->visibility_tests;
  sum->exchange_areas += part->exchange_areas;
  sum->partial_links += part->partial_links;
  sum->blocked_pairs += part->blocked_pairs;
  sum->dark_pairs += part->dark_pairs;
}

static int same_work(const hr2d_refine_counts *sum, const hr2d_refine_counts *whole) {
  return sum->links == whole->links && sum->limited_links == whole->limited_links &&
         sum->oracle_calls == whole->oracle_calls && sum->facing_tests == whole->facing_tests &&
         sum->visibility_tests == whole->visibility_tests &&
         sum->exchange_areas == whole->exchange_areas &&
         sum->partial_links == whole->partial_links &&
         sum->blocked_pairs == whole->blocked_pairs && sum->dark_pairs == whole->dark_pairs;
}

/* The links of ranges of rows, one after the other, are those of all rows, in their order. */
START_TEST(rows_add_up) {
  collected whole = collected_none(), parts = collected_none();
  hr2d_refine_options options = test_options(0.7, 5);
  options.ordered = _i / SLOW_KINDS;
  const slow_kind kind = (slow_kind)(_i % SLOW_KINDS);
  const hr2d_refine_counts all = visit(kind, &options, &whole);
  hr2d_refine_counts sum = {0}, last = {0};
  test_links t = make(kind);
  const size_t patches = hr2d_scene_patches(t.scene);
  test_free_links(&t);
  for (size_t k = 0; k < PARTS; k++) {
    options.row_from = patches * k / PARTS;
    options.row_to = patches * (k + 1) / PARTS;
    last = visit(kind, &options, &parts);
    add(&sum, &last);
  }
  ck_assert(same_work(&sum, &all));
  ck_assert_uint_eq(parts.count, whole.count);
  ck_assert_int_eq(memcmp(parts.link, whole.link, whole.count * sizeof *whole.link), 0);
  /* Negative control: a row twice. */
  options.row_from = options.row_to - 2;
  last = visit(kind, &options, &parts);
  add(&sum, &last);
  ck_assert(!same_work(&sum, &all) || last.oracle_calls == 0);
  printf("%s: %llu links, %llu tests of visibility\n", slow_name(kind),
         (unsigned long long)all.links, (unsigned long long)all.visibility_tests);
  free(whole.link);
  free(parts.link);
}
END_TEST

/* Rows that do not stand side by side: shares add up to the whole, in links, in counts, stored
   and on several threads. */
START_TEST(chosen_rows_add_up) {
  const slow_kind kind = (slow_kind)(_i % SLOW_KINDS);
  hr2d_refine_options options = test_options(0.7, 5);
  options.ordered = _i / SLOW_KINDS;
  collected whole = collected_none();
  const hr2d_refine_counts all = visit(kind, &options, &whole);
  hr2d_refine_counts stored = {0}, counted = {0};
  unsigned char rows[2 * PATCHES];
  for (size_t which = 0; which < PARTS; which++) {
    test_links t = make(kind);
    const size_t patches = hr2d_scene_patches(t.scene);
    for (size_t k = 0; k < patches; k++) rows[k] = k % PARTS == which;
    options.rows = rows;
    options.threads = 3;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    hr2d_refine_counts part = hr2d_linkset_counts(t.links);
    add(&stored, &part);
    const hr2d_element *element = hr2d_hierarchy_elements(t.hierarchy);
    for (uint64_t k = 0; k < hr2d_linkset_size(t.links); k++)
      ck_assert(rows[element[hr2d_linkset_get(t.links, k).pair.first].patch]);
    test_free_links(&t);
    t = make(kind);
    ck_assert_int_eq(hr2d_refine_count(t.links, &options, &part), HR2D_OK);
    add(&counted, &part);
    test_free_links(&t);
  }
  ck_assert(same_work(&stored, &all));
  ck_assert_uint_eq(counted.links, all.links);
  ck_assert_uint_eq(counted.oracle_calls, all.oracle_calls);
  ck_assert_uint_eq(counted.visibility_tests, all.visibility_tests);
  free(whole.link);
}
END_TEST

static void count_rows(slow_kind kind, hr2d_refine_options *options, hr2d_row_counts *row,
                       hr2d_refine_counts *counts, int stored) {
  test_links t = make(kind);
  options->row_counts = row;
  if (stored) {
    ck_assert_int_eq(hr2d_refine(t.links, options), HR2D_OK);
    *counts = hr2d_linkset_counts(t.links);
  } else {
    ck_assert_int_eq(hr2d_refine_count(t.links, options, counts), HR2D_OK);
  }
  options->row_counts = NULL;
  test_free_links(&t);
}

/* What is counted in a row is what the row alone takes, for any number of threads. */
START_TEST(each_row_is_counted) {
  const slow_kind kind = (slow_kind)_i;
  hr2d_refine_options options = test_options(0.7, 5);
  hr2d_row_counts row[2 * PATCHES], again[2 * PATCHES];
  hr2d_refine_counts all, part;
  test_links t = make(kind);
  const size_t patches = hr2d_scene_patches(t.scene);
  ck_assert_uint_le(patches, 2 * PATCHES);
  test_free_links(&t);
  count_rows(kind, &options, row, &all, 0);
  for (unsigned threads = 1; threads <= 3; threads++)
    for (int stored = 0; stored < 2; stored++) {
      options.threads = threads;
      memset(again, 255, sizeof again);
      count_rows(kind, &options, again, &part, stored);
      ck_assert_int_eq(memcmp(row, again, patches * sizeof *row), 0);
    }
  options.threads = 1;
  uint64_t links = 0, tests = 0;
  for (size_t k = 0; k < patches; k++) {
    links += row[k].links;
    tests += row[k].visibility_tests;
    if (k % 7) continue;
    options.row_from = k;
    options.row_to = k + 1;
    count_rows(kind, &options, again, &part, 0);
    ck_assert_uint_eq(part.links, row[k].links);
    ck_assert_uint_eq(part.visibility_tests, row[k].visibility_tests);
    ck_assert_int_eq(memcmp(&again[k], &row[k], sizeof *row), 0);
  }
  ck_assert_uint_eq(links, all.links);
  ck_assert_uint_eq(tests, all.visibility_tests);
}
END_TEST

static hr2d_status take_share(void *ctx, const hr2d_batch *batch, unsigned char *claimed) {
  share *s = ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_element *e = &batch->elements[batch->pairs[k].first];
    const hr2d_element *patch = &batch->elements[e->patch];
    ck_assert_int_eq(claimed[k], 1);
    s->asked++;
    if (e == patch) continue; /* both halves have a part of it */
    const double x = e->centre.x - patch->centre.x, y = e->centre.y - patch->centre.y;
    const double along = x * (patch->b.x - patch->a.x) + y * (patch->b.y - patch->a.y);
    claimed[k] = (along > 0) + 2 * (e->patch % 2) == s->wanted;
  }
  return s->fails;
}

static int by_place(const void *left, const void *right) {
  return memcmp(left, right, sizeof(placed));
}

/* Every pair below the patches is claimed by one of four: together they make the same links. */
START_TEST(claims_add_up) {
  const slow_kind kind = (slow_kind)_i;
  collected whole = collected_none(), parts = collected_none();
  hr2d_refine_options options = test_options(0.3, 3);
  const hr2d_refine_counts all = visit(kind, &options, &whole);
  options.claim = take_share;
  for (unsigned k = 0; k < 4; k++) {
    share s = {.wanted = k};
    options.claim_ctx = &s;
    parts.by = &s;
    const hr2d_refine_counts part = visit(kind, &options, &parts);
    ck_assert_uint_gt(s.asked, 0);
    ck_assert_uint_lt(part.oracle_calls, all.oracle_calls);
    if (k == 0) ck_assert_uint_lt(parts.count, whole.count);
  }
  ck_assert_uint_eq(parts.count, whole.count);
  qsort(whole.link, whole.count, sizeof *whole.link, by_place);
  qsort(parts.link, parts.count, sizeof *parts.link, by_place);
  ck_assert_int_eq(memcmp(parts.link, whole.link, whole.count * sizeof *whole.link), 0);
  free(whole.link);
  free(parts.link);
}
END_TEST

static hr2d_status take_none(void *ctx, const hr2d_batch *batch, unsigned char *claimed) {
  (void)ctx;
  memset(claimed, 0, batch->count);
  return HR2D_OK;
}

START_TEST(what_is_not_claimed_costs_nothing) {
  test_links t = make(SLOW_SQUARES);
  hr2d_refine_options options = test_options(0.5, 5);
  options.claim = take_none;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  const hr2d_refine_counts n = hr2d_linkset_counts(t.links);
  ck_assert_uint_eq(n.links + n.oracle_calls + n.visibility_tests + n.facing_tests, 0);
  test_free_links(&t);
}
END_TEST

START_TEST(it_is_refused) {
  test_links t = make(SLOW_SQUARES);
  share s = {.fails = HR2D_ECALLBACK};
  hr2d_refine_options options = test_options(0.5, 5);
  options.row_from = 3;
  options.row_to = 2;
  test_refuse(&t, &options, HR2D_EINVAL, "rows 3 to 2");
  options.row_to = hr2d_scene_patches(t.scene) + 1;
  test_refuse(&t, &options, HR2D_EINVAL, "patches");
  options.row_from = options.row_to = 0;
  options.claim = take_share;
  options.claim_ctx = &s;
  test_refuse(&t, &options, HR2D_ECALLBACK, "claim");
  options.claim = NULL;
  options.row_from = options.row_to = 2; /* no rows at all */
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 0);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("claims") {
  REPEAT_TESTS(2 * SLOW_KINDS, "rows", rows_add_up, chosen_rows_add_up);
  REPEAT_TESTS(SLOW_KINDS, "parts", each_row_is_counted, claims_add_up);
  ADD_TESTS("ends", what_is_not_claimed_costs_nothing, it_is_refused);
}
