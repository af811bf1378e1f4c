/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Radiosity against reference values, and the laws that every solution obeys. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

static test_links refined(hr2d_scene *scene, double epsilon) {
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  test_refine(&t, epsilon, HR2D_DEFAULT_MAX_LEVEL);
  return t;
}

/* The largest relative error of patch averages, of a scene whose rows begin at `row`. */
static double average_error(const test_table *table, size_t row, double epsilon, int closure) {
  test_links t = refined(test_named_scene(test_cell(table, row, "scene")), epsilon);
  hr2d_solution *solution = test_solve(&t, closure);
  const double worst = test_average_error(&t, solution, table, row);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  return worst;
}

/* The error of averages falls like ε². */
static void check_convergence(int closure, double largest) {
  test_table table = test_read_table("radiosity_fine.csv");
  const double finest = test_multiplier() < 0.1 ? 1. / 16 : 1. / 64;
  const char *last = "";
  printf("relative error of averages, closure %s\n%-22s", closure ? "on" : "off", "epsilon");
  for (double e = 1. / 4; e >= finest; e /= 2) printf(" 1/%-7g", 1 / e);
  printf(" order\n");
  for (size_t row = 1; row < table.rows; row++) {
    const char *name = test_cell(&table, row, "scene");
    if (strcmp(name, last) == 0 || strncmp(name, "occ", 3) == 0 || strstr(name, "furnace"))
      continue;
    last = name;
    printf("%-22s", name);
    double before = 0, error = 0, first = 0;
    for (double e = 1. / 4; e >= finest; e /= 2) {
      before = error;
      error = average_error(&table, row, e, closure);
      if (first == 0) first = error;
      printf(" %.2e", error);
    }
    const double steps = log2(0.25 / finest), order = log2(first / error) / steps;
    printf(" %5.2f\n", order);
    ck_assert_double_lt(error, before);
    ck_assert_double_gt(order, 1.8);
    ck_assert_double_lt(error, largest);
  }
  test_free_table(&table);
}

START_TEST(averages_converge) {
  check_convergence(1, test_multiplier() < 0.1 ? 1e-4 : 5e-6);
}
END_TEST

START_TEST(averages_converge_without_closure) {
  check_convergence(0, 1e-3);
}
END_TEST

START_TEST(furnace_is_exact) {
  for (double epsilon = 1; epsilon >= 1. / 64; epsilon /= 2) {
    test_links t = refined(test_named_scene("square_furnace_rho0.9"), epsilon);
    hr2d_solution *solution = test_solve_by(&t, NULL);
    for (uint32_t e = 0; e < hr2d_hierarchy_count(t.hierarchy).elements; e++)
      ck_assert_double_eq_tol(hr2d_solution_element(solution, e, 0), 1, 1e-13);
    /* Negative control: without closure the rows are off. */
    hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
    options.closure = HR2D_CLOSURE_OFF;
    hr2d_solution *open = test_solve_by(&t, &options);
    ck_assert_double_gt(fabs(hr2d_solution_average(open, 0, 0) - 1), 1e-7);
    hr2d_solution_destroy(open);
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
}
END_TEST

/* A convex room of n walls with random corners on a circle; some walls may be missing. */
static hr2d_scene *random_room(unsigned long *state, size_t n, double rho, int open) {
  double angle[16], patch[16][6];
  for (size_t k = 0; k < n; k++)
    angle[k] = 6.283185307179586 * ((double)k + 0.9 * test_random(state)) / (double)n;
  size_t walls = 0;
  for (size_t k = 0; k < n; k++) {
    if (open && k == 1) continue;
    const double from = angle[k], to = angle[(k + 1) % n];
    const double wall[6] = {cos(from), sin(from),          cos(to),
                            sin(to),   test_random(state), rho * test_random(state)};
    memcpy(patch[walls++], wall, sizeof wall);
  }
  return test_scene((const double(*)[6])patch, walls);
}

START_TEST(power_is_balanced) {
  unsigned long state = test_seed();
  for (int round = 0; round < 20; round++) {
    const int open = round % 2;
    const size_t walls = 3 + (size_t)(8 * test_random(&state));
    test_links t = refined(random_room(&state, walls, 0.9, open), 0.2);
    for (int closure = 0; closure < 2; closure++) {
      hr2d_solution *solution = test_solve(&t, closure);
      const hr2d_power p = hr2d_solution_power(solution, 0);
      ck_assert_double_gt(p.emitted, 0);
      ck_assert_double_eq_tol((p.absorbed + p.escaped) / p.emitted, 1, 1e-13);
      if (open) ck_assert_double_gt(p.escaped, 1e-3 * p.emitted);
      if (!open && closure) ck_assert_double_eq_tol(p.escaped / p.emitted, 0, 1e-13);
      ck_assert_double_lt(hr2d_solution_residual(solution), 1e-14);
      hr2d_solution_destroy(solution);
    }
    test_free_links(&t);
  }
}
END_TEST

START_TEST(total_of_a_closed_room) {
  /* With the same ρ everywhere ∫B = ∫E/(1−ρ). */
  const double rho[] = {0.5, 0.99, 0.999, 0.999999};
  for (size_t k = 0; k < 4; k++) {
    char name[64];
    snprintf(name, sizeof name, "square_rho%.7g", rho[k]);
    test_links t = refined(test_named_scene(name), 0.25);
    hr2d_solution *solution = test_solve_by(&t, NULL);
    double total = 0;
    for (size_t p = 0; p < 4; p++) total += hr2d_solution_average(solution, p, 0);
    /* Rounding is amplified by 1/(1−ρ). */
    ck_assert_double_eq_tol(total * (1 - rho[k]), 1, 1e-14 / (1 - rho[k]));
    ck_assert_uint_lt(hr2d_solution_work(solution).gathers, 60);
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(no_light_has_nowhere_to_go) {
  test_links t = refined(test_named_scene("square_rho1"), 0.5);
  hr2d_solution *solution = NULL;
  ck_assert_int_eq(hr2d_solve(t.links, NULL, &solution), HR2D_ENO_SOLUTION);
  ck_assert_ptr_null(solution);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "patch 0 emits"));
  test_free_links(&t);
  /* Open, or with one absorbing wall, all is well; and without light too. */
  const double open[][6] = {{0, 0, 1, 0, 1, 1}, {1, 0, 1, 1, 0, 1}, {1, 1, 0, 1, 0, 1}};
  const double absorbing[][6] = {
      {0, 0, 1, 0, 1, 1}, {1, 0, 1, 1, 0, 1}, {1, 1, 0, 1, 0, 1}, {0, 1, 0, 0, 0, .5}};
  const double dark[][6] = {
      {0, 0, 1, 0, 0, 1}, {1, 0, 1, 1, 0, 1}, {1, 1, 0, 1, 0, 1}, {0, 1, 0, 0, 0, 1}};
  test_links fine[] = {refined(test_scene(open, 3), 0.1),
                       refined(test_scene(absorbing, 4), 0.1),
                       refined(test_scene(dark, 4), 0.1)};
  for (size_t k = 0; k < 3; k++) {
    solution = test_solve_by(&fine[k], NULL);
    const hr2d_power p = hr2d_solution_power(solution, 0);
    ck_assert_double_eq_tol(p.absorbed + p.escaped, p.emitted, 1e-13);
    ck_assert_double_eq_tol(k == 0 ? p.escaped : p.absorbed, k == 2 ? 0 : 1, 1e-13);
    hr2d_solution_destroy(solution);
    test_free_links(&fine[k]);
  }
}
END_TEST

START_TEST(disconnected_parts_do_not_mix) {
  /* A lit corner, a dark corner behind its back, and a lit patch that sees nothing. */
  const double scene[][6] = {{0, 0, 1, 0, 1, .5},
                             {0, 1, 0, 0, 0, .5},
                             {-1, -1, -2, -1, 0, .9},
                             {-1, -2, -1, -1, 0, .9},
                             {3, 0, 2, 0, 7, .3}};
  test_links t = refined(test_scene(scene, 5), 0.1);
  hr2d_solution *solution = test_solve_by(&t, NULL);
  ck_assert_double_eq(hr2d_solution_average(solution, 4, 0), 7);
  ck_assert_double_gt(hr2d_solution_average(solution, 1, 0), 0);
  ck_assert_double_eq(hr2d_solution_average(solution, 2, 0), 0);
  ck_assert_double_eq(hr2d_solution_average(solution, 3, 0), 0);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}
END_TEST

START_TEST(black_scenes_are_not_iterated) {
  test_links t = refined(test_named_scene("par_d1_rho0"), 0.01);
  hr2d_solution *solution = test_solve_by(&t, NULL);
  ck_assert_uint_eq(hr2d_solution_work(solution).gathers, 1);
  ck_assert_double_eq(hr2d_solution_average(solution, 0, 0), 1);
  ck_assert_double_eq(hr2d_solution_average(solution, 1, 0), 0);
  /* What the ceiling absorbs is the floor's view factor, √2 − 1. */
  ck_assert_double_eq_tol(hr2d_solution_power(solution, 0).absorbed, sqrt(2) - 1, 1e-14);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}
END_TEST

/* The leaves of coplanar patches are off their common line by rounding, and still
   exchange nothing: three fins, each with two sides, light each other a little. */
START_TEST(backs_stay_apart) {
  double fin[6][6];
  for (size_t k = 0; k < 3; k++) {
    const double x = cos(2.1 * (double)k + 0.4), y = sin(2.1 * (double)k + 0.4);
    const double front[6] = {0, 0, x, y, k == 0, .5}, back[6] = {x, y, 0, 0, 0, .5};
    memcpy(fin[2 * k], front, sizeof front);
    memcpy(fin[2 * k + 1], back, sizeof back);
  }
  double average[2][6];
  for (int closure = 0; closure < 2; closure++) {
    test_links t = refined(test_scene((const double(*)[6])fin, 6), 0.02);
    hr2d_solution *solution = test_solve(&t, closure);
    for (size_t k = 0; k < 6; k++) average[closure][k] = hr2d_solution_average(solution, k, 0);
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
  for (size_t k = 0; k < 6; k++)
    ck_assert(fabs(average[0][k] - average[1][k]) <= 1e-4 * average[0][k]);
}
END_TEST

/* Bands of a scene are the grey scenes one by one. */
START_TEST(bands_are_independent) {
  const double emission[2][3] = {{1, 0.25, 3}, {0, 0, 0.5}};
  const double reflectance[2][3] = {{.5, .9, 0}, {.25, .9, 1}};
  const hr2d_segment wall[] = {{{0, 0}, {1, 0}}, {{1, .5}, {0, .5}}};
  hr2d_scene *scene = test_coloured_scene(wall, emission, reflectance, 2);
  test_links colour = refined(scene, 0.05);
  hr2d_solution *all = test_solve_by(&colour, NULL);
  for (size_t b = 0; b < 3; b++) {
    const double grey[][6] = {{0, 0, 1, 0, emission[0][b], reflectance[0][b]},
                              {1, .5, 0, .5, emission[1][b], reflectance[1][b]}};
    test_links t = refined(test_scene(grey, 2), 0.05);
    hr2d_solution *one = test_solve_by(&t, NULL);
    for (uint32_t e = 0; e < hr2d_hierarchy_count(t.hierarchy).elements; e++) {
      const double expected = hr2d_solution_element(one, e, 0);
      ck_assert_double_eq_tol(hr2d_solution_element(all, e, b), expected, 1e-14 * expected);
    }
    hr2d_solution_destroy(one);
    test_free_links(&t);
  }
  hr2d_solution_destroy(all);
  test_free_links(&colour);
}
END_TEST

START_TEST(threads_leave_no_trace) {
  test_links t = refined(test_named_scene("square_rho0.9"), 1. / 64);
  ck_assert_uint_gt(hr2d_linkset_size(t.links), 600000); /* enough for several threads */
  hr2d_solution *solution[3];
  for (unsigned k = 0; k < 3; k++) {
    hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
    options.threads = (unsigned[]){1, 2, 5}[k];
    solution[k] = test_solve_by(&t, &options);
  }
  for (uint32_t e = 0; e < hr2d_hierarchy_count(t.hierarchy).elements; e++)
    for (size_t k = 1; k < 3; k++)
      ck_assert_double_eq(hr2d_solution_element(solution[0], e, 0),
                          hr2d_solution_element(solution[k], e, 0));
  for (size_t k = 0; k < 3; k++) hr2d_solution_destroy(solution[k]);
  test_free_links(&t);
}
END_TEST

START_TEST(warm_start_saves_gathers) {
  test_links t = test_make_links(test_named_scene("square_rho0.9"), NULL, NULL, NULL, NULL);
  hr2d_solution *before = NULL, *warm = NULL, *cold = NULL;
  for (double epsilon = 0.5; epsilon >= 1. / 32; epsilon /= 2) {
    const hr2d_refine_options options = test_epsilon(epsilon);
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    hr2d_solve_options start = HR2D_SOLVE_OPTIONS_INIT;
    start.tolerance = 1e-6;
    start.start = before;
    warm = test_solve_by(&t, &start);
    hr2d_solution_destroy(before);
    before = warm;
  }
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.tolerance = 1e-6;
  cold = test_solve_by(&t, &options);
  ck_assert_uint_lt(hr2d_solution_work(warm).gathers, hr2d_solution_work(cold).gathers);
  for (size_t k = 0; k < 4; k++)
    ck_assert_double_eq_tol(hr2d_solution_average(warm, k, 0),
                            hr2d_solution_average(cold, k, 0), 1e-4);
  hr2d_solution_destroy(warm);
  hr2d_solution_destroy(cold);
  test_free_links(&t);
}
END_TEST

START_TEST(directed_links_give_the_same_light) {
  /* Both orders of each pair are the same links once more: the same equation. */
  test_links once = test_make_links(test_named_scene("square_rho0.9"), NULL, NULL,
                                    hr2d_policy_modified(), NULL);
  test_links both = test_make_links(test_named_scene("square_rho0.9"), NULL, NULL,
                                    hr2d_policy_modified(), NULL);
  hr2d_refine_options options = test_epsilon(0.1);
  ck_assert_int_eq(hr2d_refine(once.links, &options), HR2D_OK);
  options.ordered = 1;
  ck_assert_int_eq(hr2d_refine(both.links, &options), HR2D_OK);
  hr2d_solution *first = test_solve_by(&once, NULL), *second = test_solve_by(&both, NULL);
  for (size_t k = 0; k < 4; k++)
    ck_assert_double_eq_tol(hr2d_solution_average(first, k, 0),
                            hr2d_solution_average(second, k, 0), 1e-12);
  hr2d_solution_destroy(first);
  hr2d_solution_destroy(second);
  test_free_links(&once);
  test_free_links(&both);
}
END_TEST

START_TEST(brightness_weighting_converges) {
  test_table table = test_read_table("radiosity_fine.csv");
  test_links t =
      test_make_links(test_named_scene("square_rho0.9"), hr2d_oracle_bf(), NULL, NULL, NULL);
  hr2d_solution *solution = NULL;
  const double finest = test_multiplier() < 0.1 ? 1e-3 : 1e-4;
  for (double epsilon = 0.1; epsilon >= finest; epsilon /= 4) {
    hr2d_refine_options options = test_epsilon(epsilon);
    options.max_level = 12;
    options.brightness = solution;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    hr2d_solution_destroy(solution);
    solution = test_solve_by(&t, NULL);
  }
  for (size_t row = 1; row < table.rows; row++)
    for (size_t k = 0; k < 4; k++)
      if (strcmp(test_cell(&table, row, "scene"), "square_rho0.9") == 0 &&
          strcmp(test_cell(&table, row, "patch"),
                 (const char *[]){"bottom", "right", "top", "left"}[k]) == 0)
        ck_assert_double_eq_tol(hr2d_solution_average(solution, k, 0),
                                test_number(&table, row, "avgB"), 1e-4);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  test_free_table(&table);
}
END_TEST

START_TEST(points_lie_between_leaves) {
  test_table table = test_read_table("radiosity_fine.csv");
  test_links t = refined(test_named_scene("par_d0.1_rho0.5"), 1. / 64);
  hr2d_solution *solution = test_solve_by(&t, NULL);
  for (size_t k = 0; k < 2; k++) {
    ck_assert_str_eq(test_cell(&table, 1 + k, "scene"), "par_d0.1_rho0.5");
    ck_assert_double_eq_tol(hr2d_solution_at(solution, k, 0.25, 0),
                            test_number(&table, 1 + k, "B_quarter"), 1e-5);
    ck_assert_double_eq_tol(hr2d_solution_at(solution, k, 0.5, 0),
                            test_number(&table, 1 + k, "B_half"), 1e-5);
    /* Inside a leaf, and at the ends, it is the leaf's own. */
    const double t_inside[] = {0, 0.3, 1};
    for (int m = 0; m < 3; m++) {
      const uint32_t leaf =
          hr2d_hierarchy_leaf(t.hierarchy, k, m == 2 ? 1 - 1e-9 : t_inside[m]);
      ck_assert_double_eq(hr2d_solution_at(solution, k, t_inside[m], 0),
                          hr2d_solution_element(solution, leaf, 0));
    }
  }
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  test_free_table(&table);
}
END_TEST

static hr2d_status stop_solve(void *ctx, const hr2d_progress *progress) {
  int *calls = ctx;
  ck_assert(!strcmp(progress->phase, "rows") || !strcmp(progress->phase, "solve"));
  return ++*calls == 3 ? HR2D_STOPPED : HR2D_OK;
}

START_TEST(solves_end_early) {
  test_links t = test_make_links(test_named_scene("square_rho0.9"), NULL, NULL, NULL, NULL);
  hr2d_solution *solution = NULL;
  ck_assert_int_eq(hr2d_solve(t.links, NULL, &solution), HR2D_ESTATE);
  const hr2d_refine_options refine = test_epsilon(0.1);
  ck_assert_int_eq(hr2d_refine(t.links, &refine), HR2D_OK);
  int calls = 0;
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.progress = stop_solve;
  options.progress_ctx = &calls;
  ck_assert_int_eq(hr2d_solve(t.links, &options, &solution), HR2D_STOPPED);
  options = (hr2d_solve_options)HR2D_SOLVE_OPTIONS_INIT;
  options.max_iterations = 2;
  ck_assert_int_eq(hr2d_solve(t.links, &options, &solution), HR2D_ENOT_CONVERGED);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "residual"));
  options.tolerance = NAN;
  ck_assert_int_eq(hr2d_solve(t.links, &options, &solution), HR2D_EINVAL);
  ck_assert_ptr_null(solution);
  test_free_links(&t);
}
END_TEST

START_TEST(scale_changes_no_digit) {
  /* Scaled by a power of two, the answer keeps its bits. */
  const double patch[][6] = {{0, 0, 1, 0, 1, .7}, {0, 1, 0, 0, 0, .7}};
  test_links unit = refined(test_scene(patch, 2), 0.1);
  hr2d_solution *first = test_solve_by(&unit, NULL);
  const double factor[] = {0x1p+40, 0x1p-500, 0x1p+900};
  for (size_t f = 0; f < 3; f++) {
    double scaled[2][6];
    for (int k = 0; k < 12; k++)
      scaled[k / 6][k % 6] = patch[k / 6][k % 6] * (k % 6 < 4 ? factor[f] : 1);
    test_links t = refined(test_scene((const double(*)[6])scaled, 2), 0.1);
    hr2d_solution *second = test_solve_by(&t, NULL);
    for (uint32_t e = 0; e < hr2d_hierarchy_count(t.hierarchy).elements; e++)
      ck_assert_double_eq(hr2d_solution_element(first, e, 0),
                          hr2d_solution_element(second, e, 0));
    ck_assert_double_eq(hr2d_solution_power(first, 0).absorbed * factor[f],
                        hr2d_solution_power(second, 0).absorbed);
    hr2d_solution_destroy(second);
    test_free_links(&t);
  }
  hr2d_solution_destroy(first);
  test_free_links(&unit);
}
END_TEST

/* In a furnace B is 1 at the corners, too; at a corner of an open scene B equals its limit. */
START_TEST(corners_are_gathered_as_what_is_just_before) {
  const double at[] = {0, 0x1p-50, 1 - 0x1p-50, 1};
  double b[4];
  test_links room =
      test_make_links(test_named_scene("square_furnace_rho0.5"), NULL, NULL, NULL, NULL);
  test_refine(&room, 0.5, 8);
  hr2d_solution *solution = test_solve(&room, 1);
  for (size_t p = 0; p < 4; p++) {
    ck_assert_int_eq(hr2d_solution_gather(solution, p, at, 4, b), HR2D_OK);
    for (int k = 0; k < 4; k++) ck_assert_double_eq_tol(b[k], 1, 1e-12);
  }
  hr2d_solution_destroy(solution);
  test_free_links(&room);
  test_links corner =
      test_make_links(test_named_scene("orth_touch_rho0.7"), NULL, NULL, NULL, NULL);
  test_refine(&corner, 0.5, 8);
  solution = test_solve(&corner, 1);
  for (size_t p = 0; p < 2; p++) {
    ck_assert_int_eq(hr2d_solution_gather(solution, p, at, 4, b), HR2D_OK);
    ck_assert_double_eq_tol(b[0], b[1], 1e-12);
    ck_assert_double_eq_tol(b[3], b[2], 1e-12);
  }
  hr2d_solution_destroy(solution);
  test_free_links(&corner);
}
END_TEST

TEST_SUITE("solve") {
  ADD_TESTS("reference values", averages_converge, averages_converge_without_closure,
            points_lie_between_leaves, brightness_weighting_converges);
  ADD_TESTS("laws", furnace_is_exact, power_is_balanced, total_of_a_closed_room,
            no_light_has_nowhere_to_go, disconnected_parts_do_not_mix,
            black_scenes_are_not_iterated, backs_stay_apart, bands_are_independent,
            scale_changes_no_digit);
  ADD_TESTS("ways to solve", threads_leave_no_trace, warm_start_saves_gathers,
            directed_links_give_the_same_light, solves_end_early,
            corners_are_gathered_as_what_is_just_before);
}
