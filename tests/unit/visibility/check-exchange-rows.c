/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sparse exchange areas: the same as in the matrix, from whichever end they are looked at, and
   in thousands of small scenes the pairs that see each other are those of brute force in exact
   arithmetic.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "independent/exact-sights.h"
#include "support/grid-plans.h"
#include "support/plane.h"
#include "support/support.h"

static hr2d_exchange_rows *rows_of(const hr2d_scene *scene, unsigned threads,
                                   hr2d_matrix_counts *counts) {
  hr2d_exchange_rows *rows = NULL;
  hr2d_matrix_options options = HR2D_MATRIX_OPTIONS_INIT;
  options.threads = threads;
  ck_assert_int_eq(hr2d_exchange_rows_create(scene, &options, &rows, counts), HR2D_OK);
  return rows;
}

/* To be freed. */
static double *matrix_of(const hr2d_scene *scene, hr2d_matrix_counts *counts) {
  const size_t n = hr2d_scene_patches(scene);
  double *area = malloc(n * n * sizeof *area);
  ck_assert_ptr_nonnull(area);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, counts), HR2D_OK);
  return area;
}

/* Spreads rows out, as a reader of the arrays would. */
static double *spread(const hr2d_exchange_rows *rows, size_t n) {
  const uint64_t *start = hr2d_exchange_rows_start(rows);
  const uint32_t *column = hr2d_exchange_rows_column(rows);
  const double *value = hr2d_exchange_rows_area(rows);
  double *area = calloc(n * n, sizeof *area);
  ck_assert_ptr_nonnull(area);
  ck_assert_uint_eq(start[0], 0);
  ck_assert_uint_eq(start[n], hr2d_exchange_rows_entries(rows));
  for (size_t i = 0; i < n; i++)
    for (uint64_t k = start[i]; k < start[i + 1]; k++) {
      ck_assert(k == start[i] || column[k] > column[k - 1]);
      ck_assert(value[k] > 0 && column[k] < n && column[k] != i);
      area[i * n + column[k]] = value[k];
    }
  return area;
}

typedef struct reader {
  size_t n, rows;
  double *area;
  int stop_at;
} reader;

static hr2d_status read_row(void *ctx, const hr2d_exchange_row *row) {
  reader *r = ctx;
  ck_assert_uint_eq(row->struct_size, sizeof *row);
  ck_assert_uint_lt(row->patch, r->n);
  for (size_t k = 0; k < row->count; k++) {
    ck_assert(k == 0 || row->column[k] > row->column[k - 1]);
    r->area[row->patch * r->n + row->column[k]] = row->area[k];
  }
  return ++r->rows == (size_t)r->stop_at ? (hr2d_status)77 : HR2D_OK;
}

/* To be freed. */
static double *visited(const hr2d_scene *scene, unsigned threads, hr2d_matrix_counts *counts) {
  reader r = {.n = hr2d_scene_patches(scene)};
  hr2d_matrix_options options = HR2D_MATRIX_OPTIONS_INIT;
  options.threads = threads;
  r.area = calloc(r.n * r.n, sizeof *r.area);
  ck_assert_ptr_nonnull(r.area);
  ck_assert_int_eq(hr2d_exchange_rows_visit(scene, &options, read_row, &r, counts), HR2D_OK);
  ck_assert_uint_eq(r.rows, r.n);
  return r.area;
}

static void check_counts(const hr2d_matrix_counts *one, const hr2d_matrix_counts *other) {
  ck_assert_uint_eq(one->exchange_areas, other->exchange_areas);
  ck_assert_uint_eq(one->partial_pairs, other->partial_pairs);
}

START_TEST(rows_matrix_and_visits_are_the_same) {
  randoms r = randoms_stream(test_seed(), 1 + _i);
  for (int k = test_count(1000); k > 0; k--) {
    plan p = grid_plan(&r, _i);
    hr2d_scene *scene = plan_try_scene(&p, NULL);
    ck_assert_ptr_nonnull(scene);
    const size_t n = hr2d_scene_patches(scene);
    hr2d_matrix_counts counts[3];
    hr2d_exchange_rows *rows = rows_of(scene, 1, &counts[0]);
    double *full = matrix_of(scene, &counts[1]), *held = spread(rows, n),
           *seen = visited(scene, 1, &counts[2]);
    if (memcmp(full, seen, n * n * sizeof *seen) != 0) plan_print(&p);
    ck_assert_mem_eq(full, held, n * n * sizeof *held);
    ck_assert_mem_eq(full, seen, n * n * sizeof *seen);
    check_counts(&counts[0], &counts[1]);
    check_counts(&counts[0], &counts[2]);
    ck_assert_uint_eq(2 * counts[0].exchange_areas, hr2d_exchange_rows_entries(rows));
    hr2d_exchange_rows_destroy(rows);
    free(full);
    free(held);
    free(seen);
    hr2d_scene_destroy(scene);
    plan_free(&p);
  }
}
END_TEST

/* Ends are integers: nothing is rounded.  Areas are compared with the search of one pair. */
START_TEST(seen_pairs_are_those_of_brute_force) {
  randoms r = randoms_stream(test_seed(), 10 + _i);
  size_t seen = 0, pairs = 0;
  double worst = 0, worst_row = 0;
  for (int k = test_count(5000); k > 0; k--) {
    plan p = grid_plan(&r, _i);
    hr2d_scene *scene = plan_try_scene(&p, NULL);
    ck_assert_ptr_nonnull(scene);
    const size_t n = hr2d_scene_patches(scene);
    hr2d_exchange_rows *rows = rows_of(scene, 1, NULL);
    double *area = spread(rows, n);
    hr2d_segment *at = malloc(n * sizeof *at);
    unsigned char *sees = malloc(n * n);
    ck_assert(at != NULL && sees != NULL);
    for (size_t i = 0; i < n; i++) at[i] = hr2d_scene_segment(scene, i);
    exact_sights(at, n, sees);
    for (size_t i = 0; i < n; i++) {
      double sum = 0;
      for (size_t j = 0; j < n; j++) sum += area[i * n + j];
      if (_i) worst_row = fmax(worst_row, fabs(sum / hr2d_scene_length(scene, i) - 1));
      for (size_t j = 0; j < i; j++) {
        double other;
        const int positive = area[i * n + j] > 0;
        if (positive != sees[i * n + j]) plan_print(&p);
        ck_assert_msg(positive == sees[i * n + j], "%zu %zu: %g, but %d", i, j, area[i * n + j],
                      sees[i * n + j]);
        seen += (size_t)positive;
        pairs++;
        if (random_below(&r, 16)) continue;
        ck_assert_int_eq(hr2d_exchange_area_occluded(&at[i], &at[j], at, n, NULL, &other),
                         HR2D_OK);
        worst = fmax(worst, fabs(area[i * n + j] - other));
      }
    }
    free(at);
    free(sees);
    free(area);
    hr2d_exchange_rows_destroy(rows);
    hr2d_scene_destroy(scene);
    plan_free(&p);
  }
  printf("%zu of %zu pairs see each other, worst difference %.1e, worst row %.1e\n", seen,
         pairs, worst, worst_row);
  ck_assert_double_le(worst, 1e-12); /* of coordinates of a hundred */
  ck_assert_double_le(worst_row, 1e-13);
}
END_TEST

static double largest_coordinate(const hr2d_scene *scene) {
  double largest = 0;
  for (size_t i = 0; i < hr2d_scene_patches(scene); i++) {
    const hr2d_segment s = hr2d_scene_segment(scene, i);
    largest = fmax(largest, fmax(fabs(s.a.x), fabs(s.a.y)));
  }
  return largest;
}

/* The worst row of a closed room, as a part of its bound. */
static double worst_row_of(const hr2d_scene *scene, const double *area) {
  const size_t n = hr2d_scene_patches(scene);
  const double min = 64 * DBL_EPSILON * largest_coordinate(scene);
  double worst = 0;
  for (size_t i = 0; i < n; i++) {
    const double length = hr2d_scene_length(scene, i);
    double sum = -length;
    for (size_t j = 0; j < n; j++) sum += area[i * n + j];
    worst = fmax(worst, fabs(sum) / (1e-13 * length + min));
  }
  return worst;
}

/* Turned, and every end moved by itself by an ulp: feet are in front of walls or behind them,
   walls are bent, corners are open.  Where commit accepts that, nothing is lost but
   roundings, and no area of the room on its grid is off by more. */
START_TEST(jittered_rooms_lose_nothing) {
  randoms r = randoms_stream(test_seed(), 20);
  int accepted = 0, count = 0;
  double worst = 0, worst_area = 0;
  for (int k = test_count(5000); k > 0; k--, count++) {
    plan p = grid_plan(&r, 1);
    const double angle = random_between(&r, 0, 6.3);
    hr2d_scene *grid = plan_try_scene(&p, NULL);
    plan_jitter(&r, &p, (similarity){.u = cos(angle), .v = sin(angle)});
    hr2d_scene *scene = plan_try_scene(&p, NULL);
    if (scene) {
      const size_t n = hr2d_scene_patches(scene);
      double *area = matrix_of(scene, NULL), *exact = matrix_of(grid, NULL), off = 0;
      const double rows = worst_row_of(scene, area);
      for (size_t m = 0; m < n * n; m++) off = fmax(off, fabs(area[m] - exact[m]));
      off /= 256 * DBL_EPSILON * largest_coordinate(scene);
      worst = fmax(worst, rows);
      worst_area = fmax(worst_area, off);
      if (rows > 1 || off > 1) plan_print(&p);
      ck_assert_msg(rows <= 1 && off <= 1, "rows %g, areas %g of their bounds", rows, off);
      free(area);
      free(exact);
      accepted++;
    }
    hr2d_scene_destroy(grid);
    hr2d_scene_destroy(scene);
    plan_free(&p);
  }
  printf("%d of %d rooms accepted, worst row %.2g of its bound, worst area %.2g\n", accepted,
         count, worst, worst_area);
  ck_assert_int_gt(accepted, count / 4);
}
END_TEST

/* Two walls that leave a common end at so flat an angle that both pass within roundings of
   the end of a third one: from there on they are one line.  The upper one hides the lower
   one. */
typedef struct flat_angle {
  hr2d_scene *scene;
  size_t ceiling, upper, lower; /* the first of the patches of two-sided walls */
  double *area;
} flat_angle;

static flat_angle open_flat_angle(int upper_first, hr2d_sides upper_sides, similarity turn) {
  enum { ULPS = 20 };
  const double off = ULPS * DBL_EPSILON;
  const hr2d_point corner[] = {{-.5, -.5}, {1.5, -.5}, {1.5, .5}, {-.5, .5}};
  const hr2d_segment upper = {{0, off}, {1, 0}}, lower = {{0, -off}, {1, 0}};
  flat_angle f = {.ceiling = 2, .upper = 4, .lower = 4};
  plan p = {.walls = 0};
  for (int k = 0; k < 4; k++) plan_add(&p, corner[k], corner[(k + 1) % 4], HR2D_SIDES_FRONT);
  if (upper_first) plan_add(&p, upper.a, upper.b, upper_sides);
  plan_add(&p, lower.a, lower.b, HR2D_SIDES_BOTH);
  if (!upper_first) plan_add(&p, upper.a, upper.b, upper_sides);
  *(upper_first ? &f.lower : &f.upper) += upper_first && upper_sides != HR2D_SIDES_BOTH ? 1 : 2;
  plan_add(&p, (hr2d_point){.875, 0}, (hr2d_point){.875, -.25}, HR2D_SIDES_BOTH);
  for (size_t k = 0; k < p.walls; k++) p.wall[k] = similar_segment(turn, p.wall[k]);
  f.scene = plan_try_scene(&p, NULL);
  ck_assert_ptr_nonnull(f.scene);
  f.area = matrix_of(f.scene, NULL);
  plan_free(&p);
  return f;
}

static double row_sum(const flat_angle *f, size_t row) {
  const size_t n = hr2d_scene_patches(f->scene);
  double sum = 0;
  for (size_t k = 0; k < n; k++) sum += f->area[row * n + k];
  return sum;
}

/* Turns of which no digit is lost. */
START_TEST(the_wall_in_front_hides_the_other) {
  static const similarity turns[] = {{1, 0, 0, 0}, {-1, 0, 0, 0}, {0, 1, 0, 0}, {0, -1, 0, 0}};
  const similarity turn = turns[_i & 3];
  for (int black = 0; black < 2; black++) {
    flat_angle f = open_flat_angle(_i >> 2, black ? HR2D_SIDES_FRONT : HR2D_SIDES_BOTH, turn);
    const size_t n = hr2d_scene_patches(f.scene);
    double *seen = visited(f.scene, 1, NULL);
    ck_assert_mem_eq(f.area, seen, n * n * sizeof *seen);
    ck_assert_double_le(f.area[f.ceiling * n + f.lower], 1e-14); /* through the open end */
    ck_assert_double_gt(f.area[f.ceiling * n + f.upper], .5);
    ck_assert_double_le(fabs(row_sum(&f, f.upper) - 1), 1e-14);
    if (black) {
      ck_assert_double_le(row_sum(&f, f.lower), 1e-14);
    } else {
      ck_assert_double_le(fabs(f.area[f.lower * n + f.upper + 1] - 1), 1e-14);
      for (size_t k = 0; k < n; k++)
        ck_assert_double_le(fabs(row_sum(&f, k) - hr2d_scene_length(f.scene, k)), 1e-14);
    }
    free(seen);
    free(f.area);
    hr2d_scene_destroy(f.scene);
  }
}
END_TEST

/* Walls with more patches than a block of rows has, behind obstacles. */
static plan draw_fine(randoms *r, int pieces) {
  plan p = {.walls = 0};
  const hr2d_point corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int k = 0; k < 4; k++)
    plan_add_pieces(&p, (hr2d_segment){corner[k], corner[(k + 1) % 4]}, pieces,
                    HR2D_SIDES_FRONT);
  for (int k = 0; k < 4; k++) {
    const double x = k % 2 * .5 + random_between(r, .1, .3);
    const double y = k / 2 * .5 + random_between(r, .1, .3);
    const hr2d_segment w = {{x, y},
                            {x + random_between(r, -.1, .1), y + random_between(r, -.1, .1)}};
    plan_add_pieces(&p, w, pieces / 2, HR2D_SIDES_BOTH);
  }
  /* A foot in the middle of the floor, and one between patches of a wall. */
  plan_add(&p, (hr2d_point){.4375, 0}, (hr2d_point){.46, .3}, HR2D_SIDES_BOTH);
  plan_add(&p, (hr2d_point){0, .5}, (hr2d_point){.2, .5}, HR2D_SIDES_BOTH);
  return p;
}

START_TEST(finely_cut_walls) {
  randoms r = randoms_stream(test_seed(), 30);
  double worst = 0, worst_row = 0;
  for (int k = test_count(30); k > 0; k--) {
    plan p = draw_fine(&r, 2 + random_below(&r, 200));
    hr2d_scene *scene = plan_try_scene(&p, NULL);
    ck_assert_ptr_nonnull(scene);
    const size_t n = hr2d_scene_patches(scene);
    double *area = matrix_of(scene, NULL), *seen = visited(scene, 2, NULL);
    hr2d_segment *at = malloc(n * sizeof *at);
    ck_assert_ptr_nonnull(at);
    for (size_t i = 0; i < n; i++) at[i] = hr2d_scene_segment(scene, i);
    for (size_t i = 0; i < n; i++) {
      double sum = 0;
      for (size_t j = 0; j < n; j++) {
        sum += area[i * n + j];
        ck_assert_double_le(fabs(area[i * n + j] - seen[i * n + j]), 1e-15);
      }
      worst_row = fmax(worst_row, fabs(sum / hr2d_scene_length(scene, i) - 1));
    }
    for (int m = 0; m < 300; m++) {
      const size_t i = (size_t)(random_bits(&r) % n), j = (size_t)(random_bits(&r) % n);
      double other;
      ck_assert_int_eq(hr2d_exchange_area_occluded(&at[i], &at[j], at, n, NULL, &other),
                       HR2D_OK);
      worst = fmax(worst, fabs(area[i * n + j] - other));
    }
    free(at);
    free(seen);
    free(area);
    hr2d_scene_destroy(scene);
    plan_free(&p);
  }
  printf("worst difference %.1e, worst row %.1e\n", worst, worst_row);
  ck_assert_double_le(worst, 1e-15);
  ck_assert_double_le(worst_row, 1e-13);
}
END_TEST

/* Nothing in the way: the plain kernel for all pairs, and with occlusion forced no other bit.
 */
START_TEST(convex_rooms) {
  plan p = {.walls = 0};
  hr2d_matrix_counts counts, forced_counts;
  const hr2d_point corner[] = {{0, 0}, {3, 0}, {4, 2}, {1, 3}};
  for (int k = 0; k < 4; k++)
    plan_add_pieces(&p, (hr2d_segment){corner[k], corner[(k + 1) % 4]}, 8 << 2 * (k % 3),
                    HR2D_SIDES_FRONT);
  hr2d_scene *scene = plan_try_scene(&p, NULL), *forced = test_new_scene(NULL);
  for (size_t k = 0; k < p.walls; k++) {
    const hr2d_patch patch = {.a = p.wall[k].a, .b = p.wall[k].b, .sides = p.sides[k]};
    ck_assert_int_eq(hr2d_scene_add(forced, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_force(forced, HR2D_EFFECT_OCCLUSION), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(forced), HR2D_OK);
  const size_t n = hr2d_scene_patches(scene);
  double *area = visited(scene, 1, &counts), *other = visited(forced, 1, &forced_counts);
  ck_assert_mem_eq(area, other, n * n * sizeof *area);
  check_counts(&counts, &forced_counts);
  ck_assert_uint_eq(counts.visibility_tests, 0);
  ck_assert_uint_gt(forced_counts.visibility_tests, 0);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      const hr2d_segment s = hr2d_scene_segment(scene, i), t = hr2d_scene_segment(scene, j);
      ck_assert(i == j || area[i * n + j] == hr2d_exchange_area(&s, &t));
    }
  free(area);
  free(other);
  hr2d_scene_destroy(scene);
  hr2d_scene_destroy(forced);
  plan_free(&p);
}
END_TEST

static plan some_scene(int pieces) {
  randoms r = randoms_stream(test_seed(), 40);
  return draw_fine(&r, pieces);
}

START_TEST(threads_change_no_bit) {
  plan p = some_scene(150);
  hr2d_scene *scene = plan_try_scene(&p, NULL);
  const size_t n = hr2d_scene_patches(scene);
  hr2d_matrix_counts counts, others;
  hr2d_exchange_rows *one = rows_of(scene, 1, &counts);
  double *seen = visited(scene, 1, NULL);
  for (unsigned k = 0; k <= 6; k++) {
    const unsigned threads = k < 6 ? k : HR2D_ALL_THREADS;
    hr2d_exchange_rows *many = rows_of(scene, threads, &others);
    double *others_seen = visited(scene, threads, NULL);
    const size_t entries = (size_t)hr2d_exchange_rows_entries(one);
    ck_assert_uint_eq(hr2d_exchange_rows_entries(many), entries);
    ck_assert_mem_eq(hr2d_exchange_rows_start(one), hr2d_exchange_rows_start(many),
                     (n + 1) * sizeof(uint64_t));
    ck_assert_mem_eq(hr2d_exchange_rows_column(one), hr2d_exchange_rows_column(many),
                     entries * sizeof(uint32_t));
    ck_assert_mem_eq(hr2d_exchange_rows_area(one), hr2d_exchange_rows_area(many),
                     entries * sizeof(double));
    ck_assert_mem_eq(seen, others_seen, n * n * sizeof *seen);
    check_counts(&counts, &others);
    ck_assert_uint_eq(counts.visibility_tests, others.visibility_tests);
    hr2d_exchange_rows_destroy(many);
    free(others_seen);
  }
  hr2d_exchange_rows_destroy(one);
  free(seen);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

START_TEST(a_visitor_may_stop) {
  plan p = some_scene(20);
  hr2d_scene *scene = plan_try_scene(&p, NULL);
  const size_t n = hr2d_scene_patches(scene);
  reader r = {.n = n, .area = calloc(n * n, sizeof *r.area), .stop_at = 7};
  hr2d_matrix_counts counts = {.exchange_areas = 5};
  ck_assert_ptr_nonnull(r.area);
  ck_assert_int_eq(hr2d_exchange_rows_visit(scene, NULL, read_row, &r, &counts), 77);
  ck_assert_uint_eq(r.rows, 7);
  ck_assert_uint_eq(counts.exchange_areas, 5);
  free(r.area);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

static hr2d_status refuse(void *ctx, const hr2d_progress *progress) {
  ck_assert_str_eq(progress->phase, "factors");
  return --*(int *)ctx == 0 ? HR2D_STOPPED : HR2D_OK;
}

START_TEST(wrong_calls_leave_everything) {
  const hr2d_patch patch = {.b = {1, 0}};
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_exchange_rows *rows = NULL;
  hr2d_matrix_options options = HR2D_MATRIX_OPTIONS_INIT;
  reader r = {.n = 1};
  int asks = 1;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_exchange_rows_create(scene, NULL, &rows, NULL), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_exchange_rows_visit(scene, NULL, read_row, &r, NULL), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  options.struct_size = 1;
  ck_assert_int_eq(hr2d_exchange_rows_create(scene, &options, &rows, NULL), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_exchange_rows_visit(scene, &options, read_row, &r, NULL), HR2D_EINVAL);
  options = (hr2d_matrix_options){
      .struct_size = sizeof options, .threads = 1, .progress = refuse, .progress_ctx = &asks};
  ck_assert_int_eq(hr2d_exchange_rows_create(scene, &options, &rows, NULL), HR2D_STOPPED);
  ck_assert_ptr_null(rows);
  asks = 1;
  ck_assert_int_eq(hr2d_exchange_rows_visit(scene, &options, read_row, &r, NULL), HR2D_STOPPED);
  ck_assert_uint_eq(r.rows, 0);
  ck_assert_int_eq(hr2d_exchange_rows_create(scene, NULL, &rows, NULL), HR2D_OK);
  hr2d_scene_destroy(scene);
  ck_assert_uint_eq(hr2d_exchange_rows_entries(rows), 0);
  ck_assert_uint_eq(hr2d_exchange_rows_start(rows)[1], 0);
  hr2d_exchange_rows_destroy(rows);
  hr2d_exchange_rows_destroy(NULL);
}
END_TEST

/* Each allocation in turn, once and from then on. */
static void fail_one_by_one(int for_good, int visit) {
  test_memory f = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&f);
  plan p = some_scene(10);
  hr2d_scene *scene = plan_try_scene(&p, &hooks);
  const size_t n = hr2d_scene_patches(scene);
  const long live = f.live;
  long k = 0;
  for (int failed = 1; failed; k++) {
    hr2d_exchange_rows *rows = NULL;
    reader r = {.n = n, .area = calloc(n * n, sizeof *r.area)};
    f = (test_memory){.until_failure = k, .for_good = for_good, .live = live};
    const hr2d_status status = visit ? hr2d_exchange_rows_visit(scene, NULL, read_row, &r, NULL)
                                     : hr2d_exchange_rows_create(scene, NULL, &rows, NULL);
    failed = f.failures > 0;
    ck_assert_int_eq(status, failed ? HR2D_ENOMEM : HR2D_OK);
    if (failed) ck_assert_ptr_null(rows);
    hr2d_exchange_rows_destroy(rows);
    free(r.area);
    ck_assert_int_eq(f.live, live);
  }
  ck_assert_int_gt(k, 20);
  f.until_failure = -1;
  hr2d_scene_destroy(scene);
  ck_assert_int_eq(f.live, 0);
  plan_free(&p);
}

START_TEST(allocations_fail_one_by_one) {
  fail_one_by_one(_i & 1, _i >> 1);
}
END_TEST

TEST_SUITE("exchange rows") {
  REPEAT_TESTS(2, "scenes", rows_matrix_and_visits_are_the_same,
               seen_pairs_are_those_of_brute_force);
  REPEAT_TESTS(8, "scenes", the_wall_in_front_hides_the_other);
  ADD_TESTS("scenes", jittered_rooms_lose_nothing, finely_cut_walls, convex_rooms);
  ADD_TESTS("calls", threads_change_no_bit, a_visitor_may_stop, wrong_calls_leave_everything);
  REPEAT_TESTS(4, "calls", allocations_fail_one_by_one);
}
