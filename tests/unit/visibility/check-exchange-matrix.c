/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrix of all exchange areas of a scene: rows of closed rooms sum to the length of the
   patch, with any obstacles, and entries equal the exchange areas of the pairs.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the rooms. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "independent/brute-visibility.h"
#include "support/room-plans.h"
#include "support/support.h"

#define ROW_BAR 1e-13

/* A committed scene. */
static hr2d_scene *scene_of(const plan *p, const hr2d_allocator *hooks) {
  hr2d_scene *scene = test_new_scene(hooks);
  for (size_t k = 0; k < p->walls; k++) {
    const hr2d_patch patch = {.a = p->wall[k].a, .b = p->wall[k].b, .sides = p->sides[k]};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  if (p->crossing) ck_assert_int_eq(hr2d_scene_split_crossings(scene, NULL), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* To be freed. */
static double *matrix_of(const hr2d_scene *scene, hr2d_matrix_counts *counts) {
  const size_t n = hr2d_scene_patches(scene);
  double *area = malloc(n * n * sizeof *area);
  ck_assert_ptr_nonnull(area);
  for (size_t k = 0; k < n * n; k++) area[k] = NAN;
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, counts), HR2D_OK);
  return area;
}

static void print_plan(const plan *p) {
  for (size_t k = 0; k < p->walls; k++) {
    const hr2d_segment s = p->wall[k];
    fprintf(stderr, "  {{%a, %a}, {%a, %a}}, %s\n", s.a.x, s.a.y, s.b.x, s.b.y,
            p->sides[k] == HR2D_SIDES_BOTH ? "both" : "front");
  }
}

static void check_entries(const double *area, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      ck_assert_msg(area[i * n + j] >= 0, "(%zu, %zu) is %g", i, j, area[i * n + j]);
      ck_assert_msg(area[i * n + j] == area[j * n + i], "(%zu, %zu)", i, j);
    }
}

/* The largest |Σ AF − A|/A, beyond what `rounding` of the coordinates may do. */
static double worst_row(const hr2d_scene *scene, const double *area, double rounding,
                        size_t *row) {
  const size_t n = hr2d_scene_patches(scene);
  double worst = 0;
  for (size_t i = 0; i < n; i++) {
    const long double length = hr2d_scene_length(scene, i);
    long double sum = 0;
    for (size_t j = 0; j < n; j++) sum += area[i * n + j] / length;
    const double error = (double)(fabsl(sum - 1) - rounding / length);
    if (error <= worst) continue;
    worst = error;
    *row = i;
  }
  return worst;
}

/* Positions that remove the advantages of a plan's own coordinates: round numbers, the axes,
   the origin, a scale of about 1. */
static similarity position(randoms *r, int kind, const plan *p) {
  const double angle = random_between(r, 0, 6.3),
               size = 1 / fabs(p->wall[0].b.x - p->wall[0].a.x);
  switch (kind) {
  case 0:
    return (similarity){.u = 1};
  case 1:
    return (similarity){.u = 1 + random_below(r, 7), .v = 1 + random_below(r, 7)};
  case 2:
    return (similarity){.u = cos(angle), .v = sin(angle)};
  case 3:
    return (similarity){size * cos(angle), size * sin(angle), 1000, -700};
  case 4:
    return (similarity){.u = 1e100 * cos(angle), .v = 1e100 * sin(angle)};
  default:
    return (similarity){.u = 1e-100, .v = 0};
  }
}

enum { POSITIONS = 6, OFFSET = 3 };

typedef struct rooms {
  randoms r;
  plan plan;
  int size, kind;
} rooms;

static void draw_room(rooms *s, const plan_class *class, int k) {
  s->plan = (plan){.walls = 0};
  s->size = (int)random_power(&s->r, 0, 1.8);
  s->kind = k % POSITIONS;
  class->draw(&s->r, s->size, &s->plan);
  plan_transform(&s->plan, position(&s->r, s->kind, &s->plan));
}

START_TEST(rows_sum_to_one) {
  const plan_class *class = &plan_classes[_i];
  rooms s = {.r = randoms_stream(test_seed(), 100 + _i)};
  double worst = 0;
  size_t patches = 0;
  for (int k = 0; k < test_count(10 * POSITIONS); k++) {
    draw_room(&s, class, k);
    hr2d_scene *scene = scene_of(&s.plan, NULL);
    const size_t n = hr2d_scene_patches(scene);
    double *area = matrix_of(scene, NULL);
    check_entries(area, n);
    size_t row = 0;
    /* A thousand lengths off the origin a rounding is more than the bar. */
    const double rounding = s.kind == OFFSET ? 4 * 1000 * DBL_EPSILON : 0;
    const double error = worst_row(scene, area, rounding, &row);
    if (error > worst) worst = error;
    patches = n > patches ? n : patches;
    if (!(error <= ROW_BAR)) {
      print_plan(&s.plan);
      ck_abort_msg("%s: room %d, position %d: row %zu of %zu is off by %g", class->name, k,
                   s.kind, row, n, error);
    }
    free(area);
    hr2d_scene_destroy(scene);
    plan_free(&s.plan);
  }
  printf("%-16s up to %4zu patches, worst row %.2e\n", class->name, patches, worst);
}
END_TEST

/* Entries, not only their sums: by strings where the room is small, by the pair's own
   function everywhere. */
START_TEST(entries_are_those_of_pairs) {
  const plan_class *class = &plan_classes[_i];
  rooms s = {.r = randoms_stream(test_seed(), 200 + _i)};
  double worst = 0, worst_pair = 0;
  for (int k = 0; k < test_count(2 * POSITIONS); k++) {
    draw_room(&s, class, k);
    hr2d_scene *scene = scene_of(&s.plan, NULL);
    const size_t n = hr2d_scene_patches(scene);
    double *area = matrix_of(scene, NULL), extent = 0;
    hr2d_segment *all = malloc(n * sizeof *all);
    ck_assert_ptr_nonnull(all);
    for (size_t m = 0; m < n; m++) {
      all[m] = hr2d_scene_segment(scene, m);
      extent = fmax(extent, hypot(all[m].a.x, all[m].a.y));
    }
    for (int pairs = 0; pairs < 200; pairs++) {
      const size_t i = (size_t)(random_bits(&s.r) % n), j = (size_t)(random_bits(&s.r) % n);
      const double entry = area[i * n + j];
      double other;
      ck_assert_int_eq(hr2d_exchange_area_occluded(&all[i], &all[j], all, n, NULL, &other),
                       HR2D_OK);
      worst_pair = fmax(worst_pair, fabs(entry - other) / extent);
      if (pairs > 20 && (n > 60 || s.kind > 3)) continue;
      if (n > 120) continue;
      other = brute_strings(&all[i], &all[j], all, n);
      worst = fmax(worst, fabs(entry - other) / extent);
    }
    free(all);
    free(area);
    hr2d_scene_destroy(scene);
    plan_free(&s.plan);
  }
  printf("%-16s to strings %.2e, to pairs %.2e\n", class->name, worst, worst_pair);
  ck_assert_double_lt(worst, 1e-15);
  ck_assert_double_lt(worst_pair, 1e-15);
}
END_TEST

/* A room divided by `walls` that share vertices or end on each other: floor and ceiling,
   patches 0 and 2, do not see each other; and do without any one of `needed`. */
typedef struct division {
  const char *name;
  hr2d_segment wall[6];
  size_t walls, needed;
} division;

static const division divisions[] = {
    {"one wall", {{{0, 4}, {8, 4}}}, 1, 1},
    {"two walls", {{{0, 4}, {3, 5}}, {{3, 5}, {8, 2}}}, 2, 2},
    {"three walls", {{{0, 1}, {2, 7}}, {{5, 2}, {2, 7}}, {{5, 2}, {8, 7}}}, 3, 3},
    {"on each other", {{{0, 4}, {4, 4}}, {{4, 2}, {4, 6}}, {{4, 5}, {8, 5}}}, 3, 3},
    {"corner to corner", {{{0, 0}, {4, 4}}, {{4, 4}, {8, 8}}}, 2, 2},
    {"spikes", {{{0, 4}, {4, 4}}, {{4, 4}, {8, 4}}, {{4, 4}, {2, 2}}, {{4, 4}, {5, 7}}}, 4, 2}};
enum { DIVISIONS = sizeof divisions / sizeof *divisions };

static double floor_to_ceiling(const division *d, size_t without, similarity s) {
  plan p = {.walls = 0};
  const hr2d_point corner[] = {{0, 0}, {8, 0}, {8, 8}, {0, 8}};
  for (int k = 0; k < 4; k++) plan_add(&p, corner[k], corner[(k + 1) % 4], HR2D_SIDES_FRONT);
  for (size_t k = 0; k < d->walls; k++)
    if (k != without) plan_add(&p, d->wall[k].a, d->wall[k].b, HR2D_SIDES_BOTH);
  plan_transform(&p, s);
  hr2d_scene *scene = scene_of(&p, NULL);
  double *area = matrix_of(scene, NULL);
  const double between = area[2];
  free(area);
  hr2d_scene_destroy(scene);
  plan_free(&p);
  return between;
}

START_TEST(partitions_are_tight) {
  const division *d = &divisions[_i];
  for (int turn = 0; turn < 6; turn++) {
    const similarity s = {.u = 3 - turn, .v = turn, .x = 5 * turn, .y = -turn};
    ck_assert_msg(floor_to_ceiling(d, d->walls, s) == 0, "%s leaks", d->name);
    for (size_t k = 0; k < d->needed; k++)
      ck_assert_msg(floor_to_ceiling(d, k, s) > 0, "%s is tight without wall %zu", d->name, k);
  }
}
END_TEST

START_TEST(powers_of_two_change_no_bit) {
  const plan_class *class = &plan_classes[_i];
  rooms s = {.r = randoms_stream(test_seed(), 300 + _i)};
  for (int k = 0; k < test_count(10); k++) {
    draw_room(&s, class, k % 3);
    hr2d_scene *scene = scene_of(&s.plan, NULL);
    const size_t n = hr2d_scene_patches(scene);
    double *area = matrix_of(scene, NULL);
    hr2d_scene_destroy(scene);
    const int exponent = random_below(&s.r, 661) - 330;
    plan_transform(&s.plan, (similarity){.u = ldexp(1, exponent)});
    scene = scene_of(&s.plan, NULL);
    ck_assert_uint_eq(hr2d_scene_patches(scene), n);
    double *other = matrix_of(scene, NULL);
    for (size_t m = 0; m < n * n; m++) ck_assert(ldexp(other[m], -exponent) == area[m]);
    free(other);
    free(area);
    hr2d_scene_destroy(scene);
    plan_free(&s.plan);
  }
}
END_TEST

/* Spokes around a hub, each next to the last. */
START_TEST(a_fan) {
  plan p = {.walls = 0};
  const int spokes = test_count(300);
  plan_fan(&p, spokes);
  hr2d_scene *scene = scene_of(&p, NULL);
  hr2d_matrix_counts counts;
  double *area = matrix_of(scene, &counts);
  size_t row;
  const double error = worst_row(scene, area, 0, &row);
  const double n = (double)hr2d_scene_patches(scene), pairs = n * (n - 1) / 2;
  const double tests = (double)counts.visibility_tests / pairs;
  printf("a fan of %d: worst row %.2e, %.3g tests a pair\n", spokes, error, tests);
  check_entries(area, hr2d_scene_patches(scene));
  /* Every box meets every shaft in the hub: one of the spokes between must be found soon. */
  ck_assert_double_lt(tests, 64);
  ck_assert_double_le(error, ROW_BAR);
  free(area);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

START_TEST(many_screens) {
  plan p = {.walls = 0};
  const int screens = test_count(300);
  randoms r = randoms_stream(test_seed(), 400);
  plan_room(&p, 1, 1);
  for (int k = 0; k < screens; k++) {
    const double x = (k + random_between(&r, 0, .3)) / screens, y = random_between(&r, .4, .6);
    plan_add(&p, (hr2d_point){x, y}, (hr2d_point){x + .6 / screens, y + .3 / screens},
             HR2D_SIDES_BOTH);
  }
  hr2d_scene *scene = scene_of(&p, NULL);
  double *area = matrix_of(scene, NULL);
  size_t row;
  const double error = worst_row(scene, area, 0, &row);
  printf("%d screens: worst row %.2e\n", screens, error);
  check_entries(area, hr2d_scene_patches(scene));
  ck_assert_double_le(error, ROW_BAR);
  free(area);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

START_TEST(counts_tell_the_work) {
  plan p = {.walls = 0};
  hr2d_matrix_counts counts;
  plan_room(&p, 1, 1);
  hr2d_scene *scene = scene_of(&p, NULL);
  free(matrix_of(scene, &counts));
  ck_assert_uint_eq(counts.exchange_areas, 6);
  ck_assert_uint_eq(counts.partial_pairs, 0);
  ck_assert_uint_eq(counts.visibility_tests, 0);
  hr2d_scene_destroy(scene);
  /* A wall in the middle is in the way of all six. */
  plan_add(&p, (hr2d_point){.25, .5}, (hr2d_point){.75, .5}, HR2D_SIDES_BOTH);
  scene = scene_of(&p, NULL);
  free(matrix_of(scene, &counts));
  ck_assert_uint_eq(counts.partial_pairs, 6);
  ck_assert_uint_gt(counts.visibility_tests, 0);
  hr2d_scene_destroy(scene);
  plan_free(&p);
  /* From wall to wall: 0 and 2 are hidden from each other. */
  plan_room(&p, 1, 1);
  plan_add(&p, (hr2d_point){0, .5}, (hr2d_point){1, .5}, HR2D_SIDES_BOTH);
  scene = scene_of(&p, NULL);
  free(matrix_of(scene, &counts));
  ck_assert_uint_eq(counts.partial_pairs, 0);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

static plan some_room(void) {
  plan p = {.walls = 0};
  randoms r = randoms_stream(test_seed(), 500);
  for (int k = 0; k < plan_class_count; k++)
    if (!strcmp(plan_classes[k].name, "short walls")) plan_classes[k].draw(&r, 40, &p);
  return p;
}

START_TEST(threads_change_no_bit) {
  plan p = some_room();
  hr2d_scene *scene = scene_of(&p, NULL);
  const size_t n = hr2d_scene_patches(scene);
  hr2d_matrix_counts counts, others;
  double *one = matrix_of(scene, &counts), *many = malloc(n * n * sizeof *many);
  hr2d_matrix_options options = HR2D_MATRIX_OPTIONS_INIT;
  for (unsigned k = 0; k <= 6; k++) {
    options.threads = k < 6 ? k : HR2D_ALL_THREADS;
    memset(many, 0xff, n * n * sizeof *many);
    ck_assert_int_eq(hr2d_exchange_matrix(scene, &options, many, &others), HR2D_OK);
    ck_assert_mem_eq(one, many, n * n * sizeof *one);
    ck_assert_uint_eq(counts.exchange_areas, others.exchange_areas);
    ck_assert_uint_eq(counts.partial_pairs, others.partial_pairs);
    ck_assert_uint_eq(counts.visibility_tests, others.visibility_tests);
  }
  free(one);
  free(many);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

typedef struct reports {
  int calls, until_stop;
  double fraction;
} reports;

static hr2d_status report(void *ctx, const hr2d_progress *progress) {
  reports *r = ctx;
  ck_assert_str_eq(progress->phase, "factors");
  ck_assert_uint_eq(progress->struct_size, sizeof *progress);
  ck_assert(progress->fraction >= r->fraction && progress->fraction <= 1);
  r->fraction = progress->fraction;
  r->calls++;
  return r->calls == r->until_stop ? HR2D_STOPPED : HR2D_OK;
}

START_TEST(progress_is_told_and_may_stop) {
  plan p = some_room();
  hr2d_scene *scene = scene_of(&p, NULL);
  const size_t n = hr2d_scene_patches(scene);
  double *expected = matrix_of(scene, NULL), *area = malloc(n * n * sizeof *area);
  ck_assert_ptr_nonnull(area);
  reports r = {0};
  hr2d_matrix_options options = HR2D_MATRIX_OPTIONS_INIT;
  options.progress = report;
  options.progress_ctx = &r;
  ck_assert_int_eq(hr2d_exchange_matrix(scene, &options, area, NULL), HR2D_OK);
  ck_assert_int_ge(r.calls, 1);
  ck_assert_mem_eq(area, expected, n * n * sizeof *area);
  r = (reports){.until_stop = 1};
  ck_assert_int_eq(hr2d_exchange_matrix(scene, &options, area, NULL), HR2D_STOPPED);
  ck_assert_int_eq(r.calls, 1);
  free(area);
  free(expected);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

START_TEST(only_committed_scenes) {
  hr2d_scene *scene = NULL;
  double area[1];
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  const hr2d_patch patch = {.b = {1, 0}};
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
  ck_assert_double_eq(area[0], 0);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(allocations_fail_one_by_one) {
  test_memory f = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&f);
  plan p = some_room();
  hr2d_scene *scene = scene_of(&p, &hooks);
  const size_t n = hr2d_scene_patches(scene);
  double *expected = matrix_of(scene, NULL), *area = malloc(n * n * sizeof *area);
  ck_assert_ptr_nonnull(area);
  const long live = f.live;
  long k = 0;
  for (int failed = 1; failed; k++) {
    f = (test_memory){.until_failure = k, .for_good = _i, .live = live};
    const hr2d_status status = hr2d_exchange_matrix(scene, NULL, area, NULL);
    failed = f.failures > 0;
    ck_assert_int_eq(status, failed ? HR2D_ENOMEM : HR2D_OK);
    ck_assert_int_eq(f.live, live);
  }
  ck_assert_mem_eq(area, expected, n * n * sizeof *area);
  printf("%ld allocations failed\n", k - 1);
  ck_assert_int_gt(k, 5);
  f.until_failure = -1;
  free(area);
  free(expected);
  hr2d_scene_destroy(scene);
  ck_assert_int_eq(f.live, 0);
  plan_free(&p);
}
END_TEST

TEST_SUITE("exchange matrix") {
  REPEAT_TESTS(plan_class_count, "rooms", rows_sum_to_one, entries_are_those_of_pairs);
  REPEAT_TESTS(DIVISIONS, "rooms", partitions_are_tight);
  REPEAT_TESTS(plan_class_count, "rooms", powers_of_two_change_no_bit);
  ADD_TESTS("rooms", a_fan, many_screens);
  ADD_TESTS("calls", counts_tell_the_work, threads_change_no_bit, progress_is_told_and_may_stop,
            only_committed_scenes);
  REPEAT_TESTS(2, "calls", allocations_fail_one_by_one);
}
