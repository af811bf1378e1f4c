/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Radiosity of order p: reference values, furnaces, and properties that hold at every p; the
   fall of the error with p, and the growth of links with elements. */
#include <gsl/gsl_fit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/admissibility.h"
#include "mesh/mesh-grading.h"
#include "support/radiosity-scenes.h"
#include "support/support.h"

static radiosity_scenes reference;

static const radiosity_scene *named(const char *name) {
  const char *path = test_data_path("radiosity_fine.csv");
  if (reference.count == 0) ck_assert_int_eq(radiosity_scenes_read(path, &reference), 0);
  const radiosity_scene *scene = radiosity_scenes_find(&reference, name);
  ck_assert_msg(scene != NULL, "%s has no scene %s", path, name);
  return scene;
}

/* Links by the size oracle, which makes its own elements. */
static test_links refined(hr2d_scene *scene, unsigned order, double epsilon,
                          unsigned max_level) {
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, order), HR2D_OK);
  test_refine(&t, epsilon, max_level);
  return t;
}

/* Links between elements that are as large as B is smooth, and end where something comes into
   view. */
static test_links graded(hr2d_scene *scene, unsigned order, double target) {
  test_links t = test_make_links(scene, hr2di_admissibility_oracle(), NULL,
                                 hr2di_admissibility_fixed_leaves(), NULL);
  hr2di_events events;
  const hr2di_grading grading = {.target = target, .order = order, .events = &events};
  hr2di_survey survey;
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, order), HR2D_OK);
  ck_assert_int_eq(hr2di_events_init(&events, scene, &t.hierarchy->alloc, 1, 1000, NULL, NULL),
                   HR2D_OK);
  ck_assert_int_eq(hr2di_grading_apply(t.hierarchy, &grading, &survey), HR2D_OK);
  hr2di_events_clear(&events);
  test_refine(&t, 0.5, 60000);
  return t;
}

/* The least-squares slope of log y on x. */
static double slope_of_log(const double *x, const double *y, size_t count) {
  double log_y[64], c0, slope, c00, c01, c11, sum;
  for (size_t k = 0; k < count; k++) log_y[k] = log(y[k]);
  gsl_fit_linear(x, 1, log_y, 1, count, &c0, &slope, &c00, &c01, &c11, &sum);
  return slope;
}

static double slope_of_logs(const double *x, const double *y, size_t count) {
  double log_x[64];
  for (size_t k = 0; k < count; k++) log_x[k] = log(x[k]);
  return slope_of_log(log_x, y, count);
}

static double error_of(const char *name, test_links *t) {
  hr2d_solution *solution = test_solve(t, 1);
  const double error = radiosity_average_error(named(name), solution);
  hr2d_solution_destroy(solution);
  test_free_links(t);
  return error;
}

START_TEST(orders_are_checked) {
  test_links t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  ck_assert_uint_eq(hr2d_hierarchy_order(t.hierarchy), 1);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, 0), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, HR2D_MAX_ORDER + 1), HR2D_EINVAL);
  ck_assert_uint_eq(hr2d_hierarchy_order(t.hierarchy), 1);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, HR2D_MAX_ORDER), HR2D_OK);
  ck_assert_uint_eq(hr2d_hierarchy_order(t.hierarchy), HR2D_MAX_ORDER);
  test_refine(&t, 0.5, 24);
  hr2d_solution *solution = test_solve(&t, 1);
  ck_assert_double_lt(radiosity_average_error(named("par_d0.1_rho0.5"), solution), 1e-13);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}
END_TEST

static void same_bits(const hr2d_solution *one, const hr2d_solution *other,
                      const hr2d_hierarchy *hierarchy, size_t bands) {
  for (uint32_t e = 0; e < hr2d_hierarchy_count(hierarchy).elements; e++)
    for (size_t b = 0; b < bands; b++)
      ck_assert_double_eq(hr2d_solution_element(one, e, b), hr2d_solution_element(other, e, b));
}

/* Order 1 is the paper's algorithm bit for bit, also after another order. */
START_TEST(order_one_is_as_it_was) {
  const char *scene[] = {"par0.1", "square_rho0.9", "occ_square_walls0.5_occ0.5"};
  for (size_t k = 0; k < 3; k++) {
    test_links t = test_make_links(test_named_scene(scene[k]), NULL, NULL, NULL, NULL);
    test_refine(&t, 0.2, 10);
    for (int closure = 0; closure < 2; closure++) {
      hr2d_solution *never = test_solve(&t, closure);
      ck_assert_uint_eq(hr2d_solution_work(never).kernels, 0);
      ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, 3), HR2D_OK);
      hr2d_solution *third = test_solve(&t, closure);
      ck_assert(closure || hr2d_solution_work(third).kernels > 0);
      ck_assert_double_ne(hr2d_solution_average(third, 0, 0),
                          hr2d_solution_average(never, 0, 0));
      ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, 1), HR2D_OK);
      hr2d_solution *again = test_solve(&t, closure);
      same_bits(never, again, t.hierarchy, 1);
      hr2d_solution_destroy(again);
      hr2d_solution_destroy(third);
      hr2d_solution_destroy(never);
      ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, 1), HR2D_OK);
    }
    test_free_links(&t);
  }
}
END_TEST

static hr2d_scene *furnace(double rho) {
  const double e = 1 - rho;
  const double wall[4][6] = {
      {0, 0, 1, 0, e, rho}, {1, 0, 1, 1, e, rho}, {1, 1, 0, 1, e, rho}, {0, 1, 0, 0, e, rho}};
  return test_scene(wall, 4);
}

/* max |B − 1| over elements, and over points. */
static double furnace_error(const test_links *t, int closure) {
  hr2d_solution *solution = test_solve(t, closure);
  double worst = 0;
  for (uint32_t e = 0; e < hr2d_hierarchy_count(t->hierarchy).elements; e++)
    worst = fmax(worst, fabs(hr2d_solution_element(solution, e, 0) - 1));
  for (size_t k = 0; k < hr2d_scene_patches(t->scene); k++)
    for (double at = 0; at <= 1; at += 1. / 64)
      worst = fmax(worst, fabs(hr2d_solution_at(solution, k, at, 0) - 1));
  hr2d_solution_destroy(solution);
  return worst;
}

/* Rows sum to 1 within the accuracy of the order.  This is checked without closure, which
   would hide wrong blocks. */
START_TEST(rows_before_closure) {
  double order[16], error[16];
  size_t count = 0;
  test_links t = graded(furnace(0.9), 8, 1e-9);
  for (unsigned p = 1; p <= 12; p++) {
    ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, p), HR2D_OK);
    const double e = furnace_error(&t, 0);
    printf("order %2u: max |B - 1| %.1e\n", p, e);
    if (p == 1 || e < 1e-12) continue;
    order[count] = p;
    error[count++] = e;
  }
  ck_assert_uint_ge(count, 5);
  ck_assert_double_lt(error[count - 1], 1e-8);
  /* A row misses 3.3^−p, and more often than not less. */
  ck_assert_double_lt(slope_of_log(order, error, count), -log(3.3));
  test_free_links(&t);
}
END_TEST

START_TEST(furnace_with_closure) {
  const double rho[] = {0.9, 0.999};
  for (size_t k = 0; k < 2; k++)
    for (unsigned p = 1; p <= 16; p++) {
      test_links fine = graded(furnace(rho[k]), p, 1e-6);
      test_links coarse = refined(furnace(rho[k]), p, 0.7, 6);
      const double error = fmax(furnace_error(&fine, 1), furnace_error(&coarse, 1));
      printf("rho %g, order %2u: max |B - 1| %.1e\n", rho[k], p, error);
      /* Rounding is amplified by 1/(1−ρ). */
      ck_assert_double_lt(error, 1e-14 / (1 - rho[k]));
      test_free_links(&fine);
      test_free_links(&coarse);
    }
}
END_TEST

/* Averages converge like 3.3^−2p where elements are graded; 1e-13 is rounding. */
static void check_orders(const char *name, test_links (*make)(const char *, unsigned),
                         double slope) {
  double order[16], error[16];
  size_t count = 0;
  printf("%s:", name);
  for (unsigned p = 1; p <= 12; p++) {
    test_links t = make(name, p);
    const double e = error_of(name, &t);
    printf(" %.0e", e);
    if (e < 1e-12) break;
    order[count] = p;
    error[count++] = e;
  }
  const double measured = slope_of_log(order, error, count);
  printf(", slope %.2f\n", measured);
  ck_assert_uint_ge(count, 3);
  ck_assert_double_lt(error[count - 1], 1e-9);
  ck_assert_double_lt(measured, slope);
}

static test_links graded_scene(const char *name, unsigned order) {
  return graded(radiosity_scene_make(named(name), NULL), order, 1e-13);
}

static test_links half_links(const char *name, unsigned order) {
  return refined(radiosity_scene_make(named(name), NULL), order, 0.5, 12);
}

START_TEST(error_falls_exponentially_with_the_order) {
  check_orders("par_d0.1_rho0.5", graded_scene, -2);
  check_orders("par_d1_rho0.5", graded_scene, -2);
  check_orders("orth_touch_rho0.7", graded_scene, -2);
  check_orders("square_rho0.9", graded_scene, -2);
}
END_TEST

START_TEST(error_falls_on_any_elements) {
  check_orders("par_d0.1_rho0.5", half_links, -1.5);
  check_orders("orth_touch_rho0.7", half_links, -1.5);
}
END_TEST

/* The negative control: with p fixed the error falls like a power of ε. */
START_TEST(error_falls_slowly_at_order_one) {
  double level[6], error[6];
  for (int k = 0; k < 6; k++) {
    test_links t = refined(test_named_scene("par_d0.1_rho0.5"), 1, ldexp(0.5, -k), 24);
    level[k] = ldexp(1, k);
    error[k] = error_of("par_d0.1_rho0.5", &t);
  }
  const double slope = slope_of_logs(level, error, 6);
  printf("order 1: error like epsilon^%.2f\n", -slope);
  ck_assert_double_gt(slope, -2.5);
  ck_assert_double_lt(slope, -1.5);
}
END_TEST

/* Halving all elements gains at least a factor 2^p, all else being equal. */
START_TEST(error_falls_with_size) {
  for (unsigned p = 2; p <= 4; p++) {
    double level[4], error[4];
    for (int k = 0; k < 4; k++) {
      test_links t = refined(test_named_scene("par_d0.1_rho0.5"), p, ldexp(1, -k), 24);
      level[k] = ldexp(1, k);
      error[k] = error_of("par_d0.1_rho0.5", &t);
    }
    const double slope = slope_of_logs(level, error, 4);
    printf("order %u: error like epsilon^%.2f\n", p, -slope);
    ck_assert_double_lt(slope, -2.0 * p + 1);
  }
}
END_TEST

static double links_slope(const double *n, const double *l, size_t count, const char *what) {
  const double slope = slope_of_logs(n, l, count);
  printf("%s: N %g to %g, L %g to %g, slope %.3f\n", what, n[0], n[count - 1], l[0],
         l[count - 1], slope);
  return slope;
}

static void count(test_links *t, double *n, double *l) {
  *n = (double)hr2d_hierarchy_count(t->hierarchy).elements;
  *l = (double)hr2d_linkset_size(t->links);
  test_free_links(t);
}

/* At fixed admissibility, links grow like elements, for every reason of growth: the depth at
   a corner, a narrow gap, the requested digits. */
START_TEST(links_grow_like_elements) {
  double n[32], l[32];
  size_t k = 0;
  for (double eta = 0.5; eta < 0.8; eta += 0.2) {
    k = 0;
    for (unsigned level = 4; level <= 24; level += 2, k++) {
      test_links t = refined(test_named_scene("orth_touch_rho0.7"), 4, eta, level);
      count(&t, &n[k], &l[k]);
    }
    ck_assert_double_eq_tol(links_slope(n, l, k, "touching corner, deeper"), 1, 0.15);
    k = 0;
    for (double d = 0.5; d > 1e-4; d /= 2, k++) {
      const double plates[2][6] = {{0, 0, 1, 0, 1, .5}, {1, d, 0, d, 0, .5}};
      test_links t = refined(test_scene(plates, 2), 4, eta, 24);
      count(&t, &n[k], &l[k]);
    }
    ck_assert_double_eq_tol(links_slope(n, l, k, "plates, nearer"), 1, 0.15);
  }
  k = 0;
  for (double target = 1e-3; target > 1e-14; target /= 10, k++) {
    const unsigned order = (unsigned)ceil(-log(target) / (2 * log(3.3)));
    test_links t = graded(test_named_scene("square_rho0.9"), order, target);
    count(&t, &n[k], &l[k]);
  }
  /* The coarsest links, where elements with children are near each other, are there already. */
  const double first[] = {n[0], l[0]};
  size_t more = 0;
  for (size_t i = 1; i < k; i++)
    if (n[i] > first[0]) n[more] = n[i] - first[0], l[more++] = l[i] - first[1];
  ck_assert_double_eq_tol(links_slope(n, l, more, "square, more digits"), 1, 0.15);
}
END_TEST

/* The paper's theorem, for comparison: L = Θ(N²) where ε falls and the scene stays. */
START_TEST(links_grow_like_squares_at_order_one) {
  double n[8], l[8];
  for (int k = 0; k < 6; k++) {
    test_links t = refined(test_named_scene("par0.1"), 1, ldexp(1, -k), 24);
    count(&t, &n[k], &l[k]);
  }
  ck_assert_double_gt(links_slope(n, l, 6, "plates, finer"), 1.85);
}
END_TEST

START_TEST(occluded_averages_converge) {
  const char *name = "occ_square_walls0.5_occ0.5";
  const unsigned order[] = {1, 4, 8};
  for (size_t k = 0; k < 3; k++) {
    double first = 0, error = 0;
    printf("order %u, no element ends at an event:", order[k]);
    for (double epsilon = 0.7; epsilon > 0.05; epsilon /= 2) {
      test_links t = refined(radiosity_scene_make(named(name), NULL), order[k], epsilon, 9);
      error = error_of(name, &t);
      if (first == 0) first = error;
      printf(" %.1e", error);
    }
    printf("\n");
    ck_assert_double_lt(error, 0.05 * first);
    ck_assert_double_lt(error, k == 0 ? 1e-3 : 1e-5);
  }
}
END_TEST

/* Each E and ρ alone gives the band. */
START_TEST(bands_are_independent) {
  enum { BANDS = 3 };
  const double emission[2][BANDS] = {{1, 0.25, 3}, {0, 0, 0.5}};
  const double reflectance[2][BANDS] = {{.5, .9, 0}, {.25, .9, 1}};
  const hr2d_segment wall[] = {{{0, 0}, {1, 0}}, {{1, .5}, {0, .5}}};
  hr2d_scene *scene = test_coloured_scene(wall, emission, reflectance, 2);
  test_links colour = refined(scene, 5, 0.5, 24);
  hr2d_solution *all = test_solve(&colour, 1);
  for (size_t b = 0; b < BANDS; b++) {
    const double grey[][6] = {{0, 0, 1, 0, emission[0][b], reflectance[0][b]},
                              {1, .5, 0, .5, emission[1][b], reflectance[1][b]}};
    test_links t = refined(test_scene(grey, 2), 5, 0.5, 24);
    hr2d_solution *one = test_solve(&t, 1);
    for (size_t k = 0; k < 2; k++)
      for (double at = 0; at <= 1; at += 0.07) {
        const double expected = hr2d_solution_at(one, k, at, 0);
        ck_assert_double_eq_tol(hr2d_solution_at(all, k, at, b), expected, 2e-14 * expected);
      }
    hr2d_solution_destroy(one);
    test_free_links(&t);
  }
  hr2d_solution_destroy(all);
  test_free_links(&colour);
}
END_TEST

/* Every ordered pair has its own link: the same equation. */
START_TEST(directed_links_give_the_same_light) {
  double average[2][4];
  for (int ordered = 0; ordered < 2; ordered++) {
    test_links t = test_make_links(test_named_scene("square_rho0.9"), NULL, NULL,
                                   hr2d_policy_modified(), NULL);
    ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, 6), HR2D_OK);
    hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
    options.epsilon = 0.7;
    options.max_level = 6;
    options.ordered = ordered;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    ck_assert_int_eq(hr2d_linkset_directed(t.links), ordered);
    for (int closure = 0; closure < 2; closure++) {
      hr2d_solution *solution = test_solve(&t, closure);
      ck_assert_double_lt(hr2d_solution_residual(solution), 1e-14);
      for (size_t k = 0; k < 4 && closure; k++)
        average[ordered][k] = hr2d_solution_average(solution, k, 0);
      hr2d_solution_destroy(solution);
    }
    test_free_links(&t);
  }
  for (size_t k = 0; k < 4; k++) ck_assert_double_eq_tol(average[0][k], average[1][k], 1e-12);
}
END_TEST

START_TEST(brightness_weighting_converges) {
  const char *name = "square_rho0.9";
  test_links t = test_make_links(radiosity_scene_make(named(name), NULL), hr2d_oracle_bf(),
                                 NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, 4), HR2D_OK);
  hr2d_solution *solution = NULL;
  double error = 0;
  for (double epsilon = 0.2; epsilon > 0.01; epsilon /= 3) {
    hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
    options.epsilon = epsilon;
    options.max_level = 10;
    options.brightness = solution;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    hr2d_solution_destroy(solution);
    solution = test_solve(&t, 1);
    error = radiosity_average_error(named(name), solution);
    printf("bf, order 4, epsilon %.3f: %.1e\n", epsilon, error);
  }
  ck_assert(hr2d_linkset_directed(t.links));
  ck_assert_double_lt(error, 1e-6);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}
END_TEST

static hr2d_solution *solve_from(const test_links *t, const hr2d_solution *start,
                                 unsigned threads) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *solution = NULL;
  options.tolerance = start ? 1e-9 : 1e-15;
  options.start = start;
  options.threads = threads;
  ck_assert_int_eq(hr2d_solve(t->links, &options, &solution), HR2D_OK);
  return solution;
}

/* A solution of another order, and on older elements, is a start that saves gathers, and the
   one that is closer saves more. */
START_TEST(warm_start_across_orders) {
  test_links t = refined(test_named_scene("square_rho0.9"), 6, 0.7, 5);
  hr2d_solution *sixth = solve_from(&t, NULL, 1);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, 2), HR2D_OK);
  hr2d_solution *second = solve_from(&t, sixth, 1);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, 6), HR2D_OK);
  hr2d_solution *again = solve_from(&t, sixth, 1);
  ck_assert_uint_eq(hr2d_solution_work(again).iterations, 0);
  hr2d_solution *up = solve_from(&t, second, 1);
  test_refine(&t, 0.5, 7);
  hr2d_solution *finer = solve_from(&t, sixth, 1);
  const uint64_t cold = hr2d_solution_work(sixth).iterations;
  printf("iterations: cold %d, from order 2 %d, from coarser elements %d\n", (int)cold,
         (int)hr2d_solution_work(up).iterations, (int)hr2d_solution_work(finer).iterations);
  ck_assert_uint_lt(hr2d_solution_work(second).iterations, cold);
  ck_assert_uint_lt(hr2d_solution_work(up).iterations, cold);
  ck_assert_uint_lt(hr2d_solution_work(finer).iterations, cold);
  for (size_t k = 0; k < 4; k++) {
    const double expected = hr2d_solution_average(sixth, k, 0);
    ck_assert_double_eq_tol(hr2d_solution_average(again, k, 0), expected, 1e-15 * expected);
    ck_assert_double_eq_tol(hr2d_solution_average(up, k, 0), expected, 1e-7);
    ck_assert_double_eq_tol(hr2d_solution_average(finer, k, 0), expected, 1e-4);
  }
  /* A solution keeps its order. */
  for (double at = 0.01; at < 1; at += 0.1)
    ck_assert_double_eq_tol(hr2d_solution_at(sixth, 1, at, 0),
                            hr2d_solution_at(again, 1, at, 0), 1e-14);
  hr2d_solution *all[] = {sixth, second, again, up, finer};
  for (size_t k = 0; k < 5; k++) hr2d_solution_destroy(all[k]);
  test_free_links(&t);
}
END_TEST

START_TEST(threads_leave_no_trace) {
  const char *scene[] = {"square_rho0.9", "occ_square_walls0.5_occ0.5", "square_rho0.9"};
  const double epsilon[] = {0.3, 0.5, test_multiplier() < 0.1 ? 0.1 : 1. / 64};
  const unsigned order[] = {7, 3, 2};
  for (size_t k = 0; k < 3; k++) {
    hr2d_solution *solution[3];
    test_links t[3];
    for (unsigned n = 0; n < 3; n++) {
      t[n] = refined(test_named_scene(scene[k]), order[k], epsilon[k], 16);
      solution[n] = solve_from(&t[n], NULL, 1u << n);
    }
    printf("%s: %llu links\n", scene[k], (unsigned long long)hr2d_linkset_size(t[0].links));
    for (unsigned n = 1; n < 3; n++) {
      same_bits(solution[0], solution[n], t[0].hierarchy, 1);
      ck_assert_uint_eq(hr2d_solution_work(solution[0]).kernels,
                        hr2d_solution_work(solution[n]).kernels);
      for (double at = 0; at <= 1; at += 0.03)
        ck_assert_double_eq(hr2d_solution_at(solution[0], 2, at, 0),
                            hr2d_solution_at(solution[n], 2, at, 0));
    }
    for (unsigned n = 0; n < 3; n++) {
      hr2d_solution_destroy(solution[n]);
      test_free_links(&t[n]);
    }
  }
}
END_TEST

/* Three walls under a sky, with something in the way. */
static hr2d_scene *open_scene(double background) {
  const double wall[][6] = {
      {0, 0, 2, 0, 0, .6}, {2, 0, 2, 1, .3, .5}, {0, 1, 0, 0, 0, .8}, {.7, .4, 1.2, .5, 0, .2}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < 4; k++) {
    const hr2d_segment at = {{wall[k][0], wall[k][1]}, {wall[k][2], wall[k][3]}};
    const hr2d_sides sides = k == 3 ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT;
    ck_assert_int_eq(test_add_patch(scene, at, wall[k][4], wall[k][5], sides), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_set_background(scene, &background, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

/* At order 4 as at order 1 on elements that are fine: and with E = 1−ρ under a sky of 1 there
   is nothing to see. */
START_TEST(background_at_any_order) {
  test_links fine = refined(open_scene(1), 1, 1. / 32, 9);
  test_links high = refined(open_scene(1), 4, 0.25, 9);
  hr2d_solution *one = test_solve(&fine, 1), *four = test_solve(&high, 1);
  for (size_t k = 0; k < 5; k++) {
    const double expected = hr2d_solution_average(one, k, 0);
    printf("patch %zu: %.9f at order 1, %.9f at order 4\n", k, expected,
           hr2d_solution_average(four, k, 0));
    ck_assert_double_eq_tol(hr2d_solution_average(four, k, 0), expected, 1e-4 * expected);
  }
  const hr2d_power p = hr2d_solution_power(four, 0);
  ck_assert_double_eq_tol((p.absorbed + p.escaped) / (p.emitted + p.received), 1, 1e-13);
  ck_assert_double_eq_tol(p.received, hr2d_solution_power(one, 0).received, 1e-4 * p.received);
  hr2d_solution_destroy(one);
  hr2d_solution_destroy(four);
  test_free_links(&fine);
  test_free_links(&high);
}
END_TEST

/* With E = 1−ρ under a sky of 1 there is nothing to see. */
START_TEST(isothermal_under_a_sky) {
  const double rho = 0.7, e = 1 - rho, sky = 1;
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_segment wall[] = {{{0, 0}, {2, 0}}, {{2, 0}, {2, 1}}, {{.5, .3}, {1, .4}}};
  for (size_t k = 0; k < 3; k++)
    ck_assert_int_eq(test_add_patch(scene, wall[k], e, rho, HR2D_SIDES_BOTH), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  test_links t = graded(scene, 16, 1e-12);
  for (unsigned p = 1; p <= 16; p += 5) {
    ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, p), HR2D_OK);
    const double error = furnace_error(&t, 1);
    /* The sky is seen from the points of a rule of p + 6. */
    printf("order %u under a sky: max |B - 1| %.1e\n", p, error);
    ck_assert_double_lt(error, p == 1 ? 1e-13 : 10 * pow(3.3, -12.0 - p) + 2e-12);
  }
  test_free_links(&t);
}
END_TEST

#if SIZE_MAX == UINT32_MAX
/* With 32 bits 2^24 bands of 32 coefficients of 8 bytes are 0 bytes. */
START_TEST(bands_may_be_too_many) {
  const size_t bands = 1u << 24;
  double *emission = calloc(bands, sizeof *emission);
  hr2d_patch patch = {.a = {0, 0}, .b = {1, 0}, .emission = emission, .emission_bands = bands};
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  ck_assert_ptr_nonnull(emission);
  emission[0] = 1;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  patch = (hr2d_patch){.a = {1, 1}, .b = {0, 1}, .emission = emission, .emission_bands = 1};
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  test_links t = refined(scene, 32, 2, 1);
  ck_assert_int_eq(hr2d_solve(t.links, NULL, &solution), HR2D_ENOMEM);
  test_free_links(&t);
  free(emission);
}
END_TEST
#endif

/* A sequence of steps; each may fail once for lack of memory and must then succeed. */
typedef struct story {
  test_memory fault;
  test_links t;
  hr2d_solution *solution;
} story;

static int again(story *s, hr2d_status status) {
  if (status == HR2D_OK) return 0;
  ck_assert_msg(status == HR2D_ENOMEM && s->fault.failures > 0, "%s", hr2d_strerror(status));
  s->fault.until_failure = -1;
  s->fault.for_good = 0;
  return 1;
}

static void tell(story *s, const char *name, long until_failure, int for_good) {
  *s = (story){.fault = {.until_failure = -1}};
  const hr2d_allocator mine = test_hooks(&s->fault);
  s->t.scene = radiosity_scene_make(named(name), &mine);
  ck_assert_ptr_nonnull(s->t.scene);
  ck_assert_int_eq(hr2d_hierarchy_create(s->t.scene, &s->t.hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_set_order(s->t.hierarchy, 5), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(s->t.hierarchy, hr2di_admissibility_oracle(), NULL,
                                       hr2di_admissibility_fixed_leaves(), NULL, &s->t.links),
                   HR2D_OK);
  s->fault.until_failure = until_failure;
  s->fault.for_good = for_good;
  const hr2di_grading grading = {.target = 1e-4, .order = 5};
  hr2di_survey survey;
  if (again(s, hr2di_grading_apply(s->t.hierarchy, &grading, &survey)))
    ck_assert_int_eq(hr2di_grading_apply(s->t.hierarchy, &grading, &survey), HR2D_OK);
  const hr2d_refine_options refine = {
      .struct_size = sizeof refine, .epsilon = 0.5, .max_level = 60000, .threads = 1};
  if (again(s, hr2d_refine(s->t.links, &refine)))
    ck_assert_int_eq(hr2d_refine(s->t.links, &refine), HR2D_OK);
  if (again(s, hr2d_solve(s->t.links, NULL, &s->solution))) {
    ck_assert_ptr_null(s->solution);
    ck_assert_int_eq(hr2d_solve(s->t.links, NULL, &s->solution), HR2D_OK);
  }
}

static void end_story(story *s) {
  hr2d_solution_destroy(s->solution);
  test_free_links(&s->t);
  ck_assert_int_eq(s->fault.live, 0);
}

START_TEST(every_allocation_may_fail) {
  const char *scene[] = {"orth_touch_rho0.7", "occ_square_walls0.5_occ0.5"};
  for (size_t k = 0; k < 2; k++)
    for (int for_good = 0; for_good < 2; for_good++) {
      story ideal, s;
      tell(&ideal, scene[k], -1, 0);
      long failing = 0;
      for (int failed = 1; failed; failing++) {
        tell(&s, scene[k], failing, for_good);
        failed = s.fault.failures > 0;
        ck_assert_uint_eq(hr2d_linkset_size(s.t.links), hr2d_linkset_size(ideal.t.links));
        same_bits(s.solution, ideal.solution, ideal.t.hierarchy, 1);
        end_story(&s);
      }
      printf("%s, %s: %ld allocations failed\n", scene[k], for_good ? "for good" : "once",
             failing - 1);
      ck_assert_int_gt(failing, 20);
      end_story(&ideal);
    }
}
END_TEST

TEST_SUITE("order") {
  ADD_TESTS("same at every order", orders_are_checked, order_one_is_as_it_was,
            bands_are_independent, directed_links_give_the_same_light,
            brightness_weighting_converges, warm_start_across_orders, threads_leave_no_trace,
            background_at_any_order, isothermal_under_a_sky, every_allocation_may_fail);
#if SIZE_MAX == UINT32_MAX
  ADD_TESTS("same at every order", bands_may_be_too_many);
#endif
  ADD_TESTS("furnaces", rows_before_closure, furnace_with_closure);
  ADD_TESTS("convergence", error_falls_exponentially_with_the_order,
            error_falls_on_any_elements, error_falls_slowly_at_order_one, error_falls_with_size,
            occluded_averages_converge);
  ADD_TESTS("growth", links_grow_like_elements, links_grow_like_squares_at_order_one);
}
