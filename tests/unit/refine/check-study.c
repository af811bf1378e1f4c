/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies: rows against the reference table, and fits against data whose law is known,
   with data of another law as a control. */
#include <gsl/gsl_multifit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

enum { MOST_ROWS = 16 };

/* One row's links may be this many; a multiplier of 0.01 still leaves several rows. */
static double max_links(void) {
  return 2e7 * test_multiplier() + 20000;
}

/* Runs the rows of one scene and one algorithm at once and compares. */
static size_t check_group(const test_table *table, size_t first, size_t count) {
  const double max = max_links();
  double epsilon[MOST_ROWS];
  hr2d_study_row rows[MOST_ROWS];
  size_t chosen = 0, done = 77;
  while (chosen < count && test_number(table, first + chosen, "L") <= max) {
    epsilon[chosen] = test_number(table, first + chosen, "eps");
    chosen++;
  }
  test_links t = test_make_links(test_named_scene(test_cell(table, first, "scene")), NULL, NULL,
                                 hr2d_policy_find(test_cell(table, first, "algorithm")), NULL);
  ck_assert_int_eq(hr2d_study_run(t.links, NULL, epsilon, chosen, rows, &done), HR2D_OK);
  ck_assert_uint_eq(done, chosen);
  for (size_t k = 0; k < chosen; k++) {
    const hr2d_refine_counts *c = &rows[k].counts;
    const size_t row = first + k;
    ck_assert_double_eq(rows[k].epsilon, epsilon[k]);
    ck_assert_double_ge(rows[k].seconds, 0);
    ck_assert_uint_eq(c->elements, (uint64_t)test_number(table, row, "N_nodes"));
    ck_assert_uint_eq(c->leaves, (uint64_t)test_number(table, row, "N_leaves"));
    ck_assert_uint_eq(c->links, (uint64_t)test_number(table, row, "L"));
    ck_assert_uint_eq(c->oracle_calls, (uint64_t)test_number(table, row, "visited_pairs"));
    ck_assert_uint_eq(c->levels, (uint64_t)test_number(table, row, "max_level"));
    ck_assert_uint_eq(c->limited_links, 0);
  }
  /* The set's own hierarchy has not grown, and the set is still empty. */
  ck_assert_uint_eq(hr2d_hierarchy_count(t.hierarchy).elements, 2);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 0);
  ck_assert_str_eq(hr2d_linkset_message(t.links), "");
  test_free_links(&t);
  return chosen;
}

START_TEST(rows_are_those_of_the_reference) {
  test_table table = test_read_table("counts_maxAr_pow2.csv");
  size_t checked = 0;
  for (size_t row = 1; row < table.rows;) {
    size_t count = 1;
    while (row + count < table.rows &&
           strcmp(test_cell(&table, row, "scene"), test_cell(&table, row + count, "scene")) ==
               0 &&
           strcmp(test_cell(&table, row, "algorithm"),
                  test_cell(&table, row + count, "algorithm")) == 0)
      count++;
    ck_assert_uint_le(count, MOST_ROWS);
    checked += check_group(&table, row, count);
    row += count;
  }
  ck_assert_uint_ge(checked, 40);
  test_free_table(&table);
}
END_TEST

START_TEST(rows_before_a_failure_are_kept) {
  const double epsilon[] = {1, 0.25, 1. / 16, 1. / 64, 1. / 256};
  const uint64_t links[] = {46, 958, 15244};
  hr2d_study_row rows[5];
  memset(rows, 0x55, sizeof rows);
  const hr2d_study_row untouched = rows[4];
  test_links t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.max_links = 20000;
  options.epsilon = NAN; /* is not used */
  size_t done = 77;
  ck_assert_int_eq(hr2d_study_run(t.links, &options, epsilon, 5, rows, &done), HR2D_EMAX_LINKS);
  ck_assert_uint_eq(done, 3);
  for (size_t k = 0; k < done; k++) {
    ck_assert_double_eq(rows[k].epsilon, epsilon[k]);
    ck_assert_uint_eq(rows[k].counts.links, links[k]);
  }
  ck_assert_mem_eq(&rows[4], &untouched, sizeof untouched);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "at epsilon 0.015625: "));
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "20000 links"));
  /* In the first row, and in the middle; without asking how many are done. */
  const double bad[] = {1, NAN, 1};
  ck_assert_int_eq(hr2d_study_run(t.links, NULL, bad + 1, 2, rows, &done), HR2D_EINVAL);
  ck_assert_uint_eq(done, 0);
  ck_assert_int_eq(hr2d_study_run(t.links, NULL, bad, 3, rows, NULL), HR2D_EINVAL);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "epsilon"));
  /* Nothing to do is no failure. */
  ck_assert_int_eq(hr2d_study_run(t.links, NULL, NULL, 0, NULL, &done), HR2D_OK);
  ck_assert_uint_eq(done, 0);
  ck_assert_uint_eq(hr2d_hierarchy_count(t.hierarchy).elements, 2);
  test_free_links(&t);
}
END_TEST

typedef struct witness {
  int destroyed;
  size_t calls;
} witness;

static hr2d_status estimate(void *ctx, const hr2d_batch *batch, double *error) {
  ((witness *)ctx)->calls++;
  return hr2d_oracle_size()->estimate(NULL, batch, error);
}

static hr2d_status split(void *ctx, const hr2d_batch *batch, unsigned char *out) {
  ((witness *)ctx)->calls++;
  return hr2d_policy_modified()->preferred_subdivision(NULL, batch, out);
}

static void note_destroy(void *ctx) {
  ((witness *)ctx)->destroyed++;
}

START_TEST(callbacks_are_used_and_not_destroyed) {
  const hr2d_oracle oracle = {.struct_size = sizeof oracle,
                              .name = "counting",
                              .flags = HR2D_ORACLE_SYMMETRIC,
                              .estimate = estimate,
                              .destroy = note_destroy};
  const hr2d_policy policy = {.struct_size = sizeof policy,
                              .name = "counting",
                              .preferred_subdivision = split,
                              .destroy = note_destroy};
  witness of_oracle = {0}, of_policy = {0};
  test_links t =
      test_make_links(test_named_scene("par1"), &oracle, &of_oracle, &policy, &of_policy);
  const double epsilon[] = {0.25, 1. / 16, NAN};
  hr2d_study_row rows[3];
  size_t done = 77;
  ck_assert_int_eq(hr2d_study_run(t.links, NULL, epsilon, 3, rows, &done), HR2D_EINVAL);
  ck_assert_uint_eq(done, 2);
  ck_assert_uint_eq(rows[0].counts.oracle_calls, 21);
  ck_assert_uint_eq(rows[1].counts.oracle_calls, 341);
  ck_assert_uint_gt(of_oracle.calls, 0);
  ck_assert_uint_gt(of_policy.calls, 0);
  ck_assert_int_eq(of_oracle.destroyed + of_policy.destroyed, 0);
  /* The set itself can still be filled. */
  ck_assert_int_eq(hr2d_refine(t.links, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_study_run(t.links, NULL, epsilon, 2, rows, &done), HR2D_ESTATE);
  ck_assert_uint_eq(done, 0);
  test_free_links(&t);
  ck_assert_int_eq(of_oracle.destroyed, 1);
  ck_assert_int_eq(of_policy.destroyed, 1);
}
END_TEST

START_TEST(options_are_respected) {
  test_links t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  const double epsilon[] = {0.25, 1. / 16};
  hr2d_study_row rows[2];
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.max_level = 6;
  ck_assert_int_eq(hr2d_study_run(t.links, &options, epsilon, 2, rows, NULL), HR2D_OK);
  ck_assert_uint_eq(rows[0].counts.links, 958);
  ck_assert_uint_eq(rows[0].counts.limited_links, 0);
  ck_assert_uint_eq(rows[1].counts.elements, 254);
  ck_assert_uint_gt(rows[1].counts.limited_links, 0);
  /* Both orders: twice the links of the table. */
  options.max_level = HR2D_DEFAULT_MAX_LEVEL;
  options.ordered = 1;
  ck_assert_int_eq(hr2d_study_run(t.links, &options, epsilon, 2, rows, NULL), HR2D_OK);
  ck_assert_uint_eq(rows[0].counts.links, 1916);
  ck_assert_uint_eq(rows[1].counts.links, 30488);
  /* An older caller: the members of its shorter struct are used. */
  options.struct_size = offsetof(hr2d_refine_options, ordered);
  ck_assert_int_eq(hr2d_study_run(t.links, &options, epsilon, 2, rows, NULL), HR2D_OK);
  ck_assert_uint_eq(rows[1].counts.links, 15244);
  test_free_links(&t);
}
END_TEST

static hr2d_study_row row_of(uint64_t elements, uint64_t links) {
  return (hr2d_study_row){.counts = {.elements = elements, .links = links}};
}

static void check_near(double value, double expected, double relative) {
  ck_assert_double_eq_tol(value, expected, relative * fabs(expected));
}

START_TEST(quadratic_data_is_recovered) {
  const uint64_t step[] = {1, 7, 1000, 1000003, 100000000}; /* up to N = 10⁹ */
  for (size_t s = 0; s < 5; s++) {
    hr2d_study_row rows[10];
    for (size_t k = 0; k < 10; k++) {
      const uint64_t n = step[s] * (k + 1);
      rows[k] = row_of(n, 11 + 5 * n + 3 * n * n);
    }
    hr2d_study_fit fit;
    ck_assert_int_eq(hr2d_study_fit_rows(rows, 10, &fit), HR2D_OK);
    check_near(fit.c, 3, 1e-10);
    /* L is exact to 2⁻⁵³ of its largest, 3N²: that much of the lower terms. */
    const double rounding = 64 * 0x1p-53 * 3 * pow((double)rows[9].counts.elements, 2);
    ck_assert_double_eq_tol(fit.a, 11, 11e-10 + rounding);
    ck_assert_double_eq_tol(fit.b, 5, 5e-10 + rounding / (double)rows[9].counts.elements);
    ck_assert_double_eq_tol(fit.r2, 1, 1e-14);
  }
}
END_TEST

START_TEST(all_coefficients_are_recovered) {
  /* All terms of one size: N up to 10⁹ and coefficients to match. */
  const double scale[] = {1e2, 1e5, 1e9};
  for (size_t s = 0; s < 3; s++) {
    hr2d_study_row rows[12];
    const double n = scale[s], m = 1e12;
    for (size_t k = 0; k < 12; k++) {
      const double x = (double)(k + 1) / 10;
      rows[k] = row_of((uint64_t)(n * (double)(k + 1) / 10 + 0.5),
                       (uint64_t)(m * (2 + 3 * x + 5 * x * x) + 0.5));
    }
    hr2d_study_fit fit;
    ck_assert_int_eq(hr2d_study_fit_rows(rows, 12, &fit), HR2D_OK);
    check_near(fit.a, 2 * m, 1e-10);
    check_near(fit.b, 3 * m / n, 1e-10);
    check_near(fit.c, 5 * m / (n * n), 1e-10);
  }
}
END_TEST

START_TEST(slopes_are_exponents) {
  for (int power = 1; power <= 3; power++) {
    hr2d_study_row rows[8];
    for (size_t k = 0; k < 8; k++) {
      const uint64_t n = 2 + 90 * k * k;
      rows[k] = row_of(n, 7 * (power > 1 ? n : 1) * (power > 2 ? n : 1) * n);
    }
    hr2d_study_fit fit;
    ck_assert_int_eq(hr2d_study_fit_rows(rows, 8, &fit), HR2D_OK);
    ck_assert_double_eq_tol(fit.slope, power, 1e-13);
    /* A cube is no quadratic polynomial. */
    if (power == 3) ck_assert_double_lt(fit.r2, 0.9999);
    if (power < 3) ck_assert_double_eq_tol(fit.r2, 1, 1e-14);
    /* Linear data has no quadratic part: a test of Θ(N²) must see the difference. */
    if (power == 1) {
      ck_assert_double_lt(fabs(fit.c) * 4412, 1e-12 * 7);
      check_near(fit.b, 7, 1e-12);
    }
    if (power == 2) check_near(fit.c, 7, 1e-12);
  }
}
END_TEST

START_TEST(noisy_data_is_fitted_as_by_gsl) {
  unsigned long state = test_seed();
  enum { COUNT = 30 };
  for (int round = 0; round < 20; round++) {
    hr2d_study_row rows[COUNT];
    const double n = pow(10, 2 + 6 * test_random(&state));
    gsl_matrix *powers = gsl_matrix_alloc(COUNT, 3), *covariance = gsl_matrix_alloc(3, 3);
    gsl_vector *links = gsl_vector_alloc(COUNT), *c = gsl_vector_alloc(3);
    gsl_multifit_linear_workspace *work = gsl_multifit_linear_alloc(COUNT, 3);
    double mean_x = 0, mean_y = 0, mean_l = 0, sxx = 0, sxy = 0, spread = 0, errors;
    for (size_t k = 0; k < COUNT; k++) {
      const double size = floor(n * (0.05 + test_random(&state)));
      const double value = (size + 0.2 * size * size / n) * (0.5 + test_random(&state));
      rows[k] = row_of((uint64_t)size, 1 + (uint64_t)value);
      const double x = size / n;
      for (size_t p = 0; p < 3; p++)
        gsl_matrix_set(powers, k, p, p == 0 ? 1 : p == 1 ? x : x * x);
      gsl_vector_set(links, k, (double)rows[k].counts.links);
      mean_x += log(size) / COUNT;
      mean_y += log((double)rows[k].counts.links) / COUNT;
      mean_l += (double)rows[k].counts.links / COUNT;
    }
    for (size_t k = 0; k < COUNT; k++) {
      const double x = log((double)rows[k].counts.elements) - mean_x;
      sxx += x * x;
      sxy += x * (log((double)rows[k].counts.links) - mean_y);
      spread += pow((double)rows[k].counts.links - mean_l, 2);
    }
    ck_assert_int_eq(gsl_multifit_linear(powers, links, c, covariance, &errors, work), 0);
    hr2d_study_fit fit;
    ck_assert_int_eq(hr2d_study_fit_rows(rows, COUNT, &fit), HR2D_OK);
    const double size =
        fabs(gsl_vector_get(c, 0)) + fabs(gsl_vector_get(c, 1)) + fabs(gsl_vector_get(c, 2));
    ck_assert_double_eq_tol(fit.a, gsl_vector_get(c, 0), 1e-9 * size);
    ck_assert_double_eq_tol(fit.b * n, gsl_vector_get(c, 1), 1e-9 * size);
    ck_assert_double_eq_tol(fit.c * n * n, gsl_vector_get(c, 2), 1e-9 * size);
    ck_assert_double_eq_tol(fit.r2, 1 - errors / spread, 1e-9);
    ck_assert_double_lt(fit.r2, 0.999);
    check_near(fit.slope, sxy / sxx, 1e-9);
    gsl_multifit_linear_free(work);
    gsl_matrix_free(powers);
    gsl_matrix_free(covariance);
    gsl_vector_free(links);
    gsl_vector_free(c);
  }
}
END_TEST

static void check_no_fit(const hr2d_study_row *rows, size_t count) {
  hr2d_study_fit fit, before;
  memset(&fit, 0x55, sizeof fit);
  before = fit;
  ck_assert_int_eq(hr2d_study_fit_rows(rows, count, &fit), HR2D_EINVAL);
  ck_assert_mem_eq(&fit, &before, sizeof fit);
}

START_TEST(too_few_sizes_are_refused) {
  const hr2d_study_row rows[] = {row_of(2, 1), row_of(14, 16), row_of(14, 17),
                                 row_of(2, 1), row_of(2, 2),   row_of(62, 256)};
  hr2d_study_fit fit;
  check_no_fit(NULL, 0);
  for (size_t count = 1; count < 6; count++) check_no_fit(rows, count);
  ck_assert_int_eq(hr2d_study_fit_rows(rows, 6, &fit), HR2D_OK);
}
END_TEST

START_TEST(three_rows_are_met_exactly) {
  const hr2d_study_row rows[] = {row_of(2, 1), row_of(14, 16), row_of(62, 256)};
  hr2d_study_fit fit;
  ck_assert_int_eq(hr2d_study_fit_rows(rows, 3, &fit), HR2D_OK);
  for (int k = 0; k < 3; k++) {
    const double n = (double)rows[k].counts.elements;
    check_near(fit.a + n * (fit.b + n * fit.c), (double)rows[k].counts.links, 1e-13);
  }
  ck_assert_double_eq_tol(fit.r2, 1, 1e-14);
}
END_TEST

START_TEST(rows_without_logarithm_are_refused) {
  for (int k = 0; k < 3; k++) {
    hr2d_study_row rows[] = {row_of(2, 1), row_of(14, 16), row_of(62, 256)};
    rows[k].counts.links = 0;
    check_no_fit(rows, 3);
  }
  const hr2d_study_row rows[] = {row_of(0, 1), row_of(14, 16), row_of(62, 256)};
  check_no_fit(rows, 3);
}
END_TEST

START_TEST(equal_links_are_met_exactly) {
  /* The mean of equal numbers may be an ulp off; that is no spread. */
  for (size_t count = 3; count < 30; count++) {
    hr2d_study_row rows[30];
    for (size_t k = 0; k < count; k++) rows[k] = row_of(2 + 3 * k, 46);
    hr2d_study_fit fit;
    ck_assert_int_eq(hr2d_study_fit_rows(rows, count, &fit), HR2D_OK);
    ck_assert_msg(fabs(fit.r2 - 1) < 1e-9, "r2 is %g for %zu rows", fit.r2, count);
    ck_assert_double_eq_tol(fit.slope, 0, 1e-14);
  }
}
END_TEST

/* The paper's theorem: L grows with the square of N. */
START_TEST(links_grow_quadratically) {
  test_links t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  const double epsilon[] = {1. / 16, 1. / 32, 1. / 64, 1. / 128, 1. / 256, 1. / 512};
  const size_t count = test_multiplier() < 0.1 ? 4 : 6;
  hr2d_study_row rows[6];
  hr2d_study_fit fit;
  ck_assert_int_eq(hr2d_study_run(t.links, NULL, epsilon, count, rows, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_study_fit_rows(rows, count, &fit), HR2D_OK);
  ck_assert_double_gt(fit.slope, 1.95);
  ck_assert_double_lt(fit.slope, 2.05);
  ck_assert_double_gt(fit.c, 0);
  /* At the fine end the quadratic term is nearly everything. */
  const double n = (double)rows[count - 1].counts.elements;
  check_near(fit.c * n * n, (double)rows[count - 1].counts.links, 0.05);
  ck_assert_double_gt(fit.r2, 0.9999);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("study") {
  ADD_TESTS("rows", rows_are_those_of_the_reference, rows_before_a_failure_are_kept,
            callbacks_are_used_and_not_destroyed, options_are_respected,
            links_grow_quadratically);
  ADD_TESTS("fits", quadratic_data_is_recovered, all_coefficients_are_recovered,
            slopes_are_exponents, noisy_data_is_fitted_as_by_gsl, too_few_sizes_are_refused,
            three_rows_are_met_exactly, rows_without_logarithm_are_refused,
            equal_links_are_met_exactly);
}
