/* SPDX-License-Identifier: GPL-3.0-or-later */
/* 0 is the default of every option: no options, a struct of zeros with its size, the macro and
   the function of a struct ask for the same, bit for bit.  What 0 means otherwise has a name.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

/* The ways to ask for the defaults. */
enum { NOTHING, ZEROS, MACRO, FUNCTION, WAYS };

/* Fills `options`, whose macro gives `macro`; NULL for NOTHING. */
#define ASK(way, type, init, macro, options)                                                   \
  (memset(&(options), (way) == FUNCTION ? 0xff : 0, sizeof(options)),                          \
   (way) == FUNCTION                                                                           \
       ? init(&(options), sizeof(type))                                                        \
       : (void)((options) = (way) == MACRO ? (macro) : (type){.struct_size = sizeof(type)}),   \
   (way) == NOTHING ? NULL : &(options))

static hr2d_scene *room(void) {
  return test_named_scene("occ_square_walls0.5_occ0.5");
}

static test_links refined(int way) {
  const hr2d_refine_options macro = HR2D_REFINE_OPTIONS_INIT;
  hr2d_refine_options options;
  test_links t = test_make_links(room(), NULL, NULL, NULL, NULL);
  const hr2d_refine_options *asked =
      ASK(way, hr2d_refine_options, hr2d_refine_options_init, macro, options);
  ck_assert_int_eq(hr2d_refine(t.links, asked), HR2D_OK);
  return t;
}

static void check_same_links(const hr2d_linkset *a, const hr2d_linkset *b) {
  ck_assert_uint_eq(hr2d_linkset_size(a), hr2d_linkset_size(b));
  for (uint64_t k = 0; k < hr2d_linkset_size(a); k++) {
    const hr2d_link l = hr2d_linkset_get(a, k), m = hr2d_linkset_get(b, k);
    ck_assert_uint_eq(l.pair.first, m.pair.first);
    ck_assert_uint_eq(l.pair.second, m.pair.second);
    ck_assert_double_eq(l.exchange_area, m.exchange_area);
  }
}

START_TEST(refinements_are_the_same) {
  test_links none = refined(NOTHING);
  ck_assert_double_eq(hr2d_linkset_epsilon(none.links), HR2D_DEFAULT_EPSILON);
  for (int way = ZEROS; way < WAYS; way++) {
    test_links t = refined(way);
    check_same_links(none.links, t.links);
    ck_assert_double_eq(hr2d_linkset_epsilon(t.links), HR2D_DEFAULT_EPSILON);
    test_free_links(&t);
  }
  /* What the defaults are. */
  test_links named = test_make_links(room(), NULL, NULL, NULL, NULL);
  test_refine(&named, 0.1, 24);
  check_same_links(none.links, named.links);
  test_free_links(&named);
  test_free_links(&none);
}
END_TEST

static hr2d_solution *solved(const test_links *t, int way) {
  const hr2d_solve_options macro = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solve_options options;
  return test_solve_by(t,
                       ASK(way, hr2d_solve_options, hr2d_solve_options_init, macro, options));
}

static int differ(const hr2d_solution *a, const hr2d_solution *b) {
  int different = 0;
  for (size_t p = 0; p < 4; p++)
    different += hr2d_solution_average(a, p, 0) != hr2d_solution_average(b, p, 0) ||
                 hr2d_solution_irradiance(a, p, 0) != hr2d_solution_irradiance(b, p, 0);
  return different;
}

START_TEST(solves_are_the_same) {
  test_links t = refined(NOTHING);
  hr2d_solution *none = solved(&t, NOTHING);
  for (int way = ZEROS; way < WAYS; way++) {
    hr2d_solution *solution = solved(&t, way);
    ck_assert_int_eq(differ(none, solution), 0);
    ck_assert_uint_eq(hr2d_solution_work(none).gathers, hr2d_solution_work(solution).gathers);
    hr2d_solution_destroy(solution);
  }
  hr2d_solve_options named = HR2D_SOLVE_OPTIONS_INIT;
  named.tolerance = 1e-15;
  named.max_iterations = 10000;
  named.threads = 1;
  named.closure = HR2D_CLOSURE_ON;
  hr2d_solution *solution = test_solve_by(&t, &named);
  ck_assert_int_eq(differ(none, solution), 0);
  hr2d_solution_destroy(solution);
  /* Negative controls: options count. */
  named.closure = HR2D_CLOSURE_OFF;
  solution = test_solve_by(&t, &named);
  ck_assert_int_gt(differ(none, solution), 0);
  hr2d_solution_destroy(solution);
  named.closure = HR2D_CLOSURE_DEFAULT;
  named.max_iterations = 1;
  ck_assert_int_eq(hr2d_solve(t.links, &named, &solution), HR2D_ENOT_CONVERGED);
  hr2d_solution_destroy(none);
  test_free_links(&t);
}
END_TEST

START_TEST(enclosures_are_the_same) {
  const hr2d_enclose_options macro = HR2D_ENCLOSE_OPTIONS_INIT;
  hr2d_enclose_options options;
  hr2d_enclosure *e;
  hr2d_enclosure_account none, a;
  hr2d_scene *scene = room();
  hr2d_enclose(scene, NULL, &e, &none);
  hr2d_enclosure_destroy(e);
  for (int way = ZEROS; way < WAYS; way++) {
    hr2d_enclose(scene,
                 ASK(way, hr2d_enclose_options, hr2d_enclose_options_init, macro, options), &e,
                 &a);
    ck_assert_double_eq(a.gap, none.gap);
    ck_assert_uint_eq(a.links, none.links);
    hr2d_enclosure_destroy(e);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(matrices_are_the_same) {
  const hr2d_matrix_options macro = HR2D_MATRIX_OPTIONS_INIT;
  hr2d_matrix_options options;
  hr2d_scene *scene = room();
  const size_t bytes = hr2d_scene_patches(scene) * hr2d_scene_patches(scene) * sizeof(double);
  double *none = malloc(bytes), *area = malloc(bytes);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, none, NULL), HR2D_OK);
  for (int way = ZEROS; way < WAYS; way++) {
    memset(area, 0xff, bytes);
    ck_assert_int_eq(hr2d_exchange_matrix(scene,
                                          ASK(way, hr2d_matrix_options,
                                              hr2d_matrix_options_init, macro, options),
                                          area, NULL),
                     HR2D_OK);
    ck_assert_mem_eq(none, area, bytes);
  }
  free(none);
  free(area);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(targets_are_the_same) {
  const hr2d_target macro = HR2D_TARGET_INIT;
  hr2d_scene *scene = room();
  hr2d_solution *none = NULL, *solution = NULL;
  hr2d_account a, b;
  hr2d_prediction p, q;
  hr2d_error error, other;
  hr2d_target target;
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &none, &a), HR2D_OK);
  ck_assert_int_eq(hr2d_predict(scene, NULL, &p), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_error(none, NULL, &error, NULL), HR2D_OK);
  for (int way = ZEROS; way < WAYS; way++) {
    const hr2d_target *asked = ASK(way, hr2d_target, hr2d_target_init, macro, target);
    ck_assert_int_eq(hr2d_solve_to(scene, asked, &solution, &b), HR2D_OK);
    ck_assert_int_eq(differ(none, solution), 0);
    ck_assert_double_eq(a.average.bound, b.average.bound);
    ck_assert_double_eq(a.irradiance.bound, b.irradiance.bound);
    ck_assert_uint_eq(a.links, b.links);
    ck_assert_int_eq(hr2d_predict(scene, asked, &q), HR2D_OK);
    ck_assert_uint_eq(p.links, q.links);
    ck_assert_int_eq(hr2d_solution_error(solution, asked, &other, NULL), HR2D_OK);
    ck_assert_double_eq(error.estimate, other.estimate);
    ck_assert_double_eq(error.bound, other.bound);
    hr2d_solution_destroy(solution);
  }
  /* Negative control: a zero of one's own is asked for by its name. */
  hr2d_target_init(&target, sizeof target);
  target.error = HR2D_SMALLEST_ERROR;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &b), HR2D_OK);
  ck_assert_double_lt(b.average.estimate, 1e-3 * a.average.estimate);
  hr2d_solution_destroy(solution);
  hr2d_solution_destroy(none);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(patches_are_the_same) {
  const hr2d_patch zeros = {.emission_bands = 0};
  hr2d_patch macro = HR2D_PATCH_INIT, filled;
  memset(&filled, 0xff, sizeof filled);
  hr2d_patch_init(&filled);
  const hr2d_patch *patch[] = {&zeros, &macro, &filled};
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < 3; k++) {
    hr2d_patch p = *patch[k];
    p.b.x = 1;
    p.a.y = p.b.y = (double)k;
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  test_commit(scene);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 3);
  for (size_t k = 0; k < 3; k++) {
    ck_assert_double_eq(hr2d_scene_emission(scene, k, 0), 0);
    ck_assert_double_eq(hr2d_scene_reflectance(scene, k, 0), 0);
    ck_assert_double_eq(hr2d_scene_length(scene, k), 1);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* A caller's struct that is older or newer than the library's: its own size counts. */
START_TEST(functions_touch_what_is_there) {
  unsigned char bytes[sizeof(hr2d_target) + 16];
  void *start = bytes;
  const size_t sizes[] = {
      0, 4, sizeof(size_t), offsetof(hr2d_target, norm), sizeof(hr2d_target), sizeof bytes - 1};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
    size_t size = 0;
    memset(bytes, 0xff, sizeof bytes);
    hr2d_target_init(start, sizes[k]);
    for (size_t m = 0; m < sizeof bytes; m++)
      if (m >= sizeof size || sizes[k] < sizeof size)
        ck_assert_uint_eq(bytes[m], m < sizes[k] ? 0 : 0xff);
    memcpy(&size, bytes, sizeof size);
    if (sizes[k] >= sizeof size) ck_assert_uint_eq(size, sizes[k]);
  }
}
END_TEST

START_TEST(a_size_that_is_not_set_is_refused) {
  test_links t = refined(NOTHING);
  hr2d_scene *scene = room();
  hr2d_solution *solution = NULL;
  hr2d_study_row row;
  const double epsilon = 1;
  double area[64];
  const hr2d_refine_options refine = {.epsilon = 1};
  const hr2d_solve_options solve = {.tolerance = 1};
  const hr2d_matrix_options matrix = {.threads = 1};
  const hr2d_target target = {.error = 1};
  test_refuse(&t, &refine, HR2D_EINVAL, "struct_size");
  ck_assert_int_eq(hr2d_solve(t.links, &solve, &solution), HR2D_EINVAL);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "struct_size"));
  ck_assert_int_eq(hr2d_exchange_matrix(scene, &matrix, area, NULL), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, NULL), HR2D_EINVAL);
  test_links empty = test_make_links(scene, NULL, NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_study_run(empty.links, &refine, &epsilon, 1, &row, NULL), HR2D_EINVAL);
  test_free_links(&empty);
  test_free_links(&t);
}
END_TEST

/* ε = 0 and level 0 can still be had, also where ε is no option. */
START_TEST(zeros_have_names) {
  test_links t = test_make_links(room(), NULL, NULL, NULL, NULL);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  const double epsilon[] = {0, -1};
  hr2d_study_row row[2];
  size_t done = 0;
  options.max_level = 3;
  ck_assert_int_eq(hr2d_study_run(t.links, &options, epsilon, 2, row, &done), HR2D_EINVAL);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "epsilon -1"));
  ck_assert_uint_eq(done, 1);
  ck_assert_double_eq(row[0].epsilon, 0);
  options.epsilon = HR2D_EPSILON_ZERO;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_double_eq(hr2d_linkset_epsilon(t.links), 0);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), row[0].counts.links);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).levels, 3);
  test_free_links(&t);
  t = test_make_links(room(), NULL, NULL, NULL, NULL);
  options.max_level = HR2D_NO_SUBDIVISION;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).levels, 0);
  ck_assert_uint_eq(hr2d_hierarchy_count(t.hierarchy).elements,
                    hr2d_scene_patches(hr2d_hierarchy_scene(t.hierarchy)));
  test_free_links(&t);
}
END_TEST

START_TEST(all_threads_change_no_bit) {
  test_links t = refined(NOTHING), u = test_make_links(room(), NULL, NULL, NULL, NULL);
  hr2d_scene *scene = room();
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_refine_counts counts;
  hr2d_solution *one = NULL, *all = NULL;
  refine.threads = solve.threads = target.threads = HR2D_ALL_THREADS;
  ck_assert_int_eq(hr2d_refine_count(u.links, &refine, &counts), HR2D_OK);
  ck_assert_uint_eq(counts.links, hr2d_linkset_size(t.links));
  one = solved(&t, NOTHING);
  all = test_solve_by(&t, &solve);
  ck_assert_int_eq(differ(one, all), 0);
  hr2d_solution_destroy(one);
  hr2d_solution_destroy(all);
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &one, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &all, NULL), HR2D_OK);
  ck_assert_int_eq(differ(one, all), 0);
  hr2d_solution_destroy(one);
  hr2d_solution_destroy(all);
  hr2d_scene_destroy(scene);
  test_free_links(&t);
  test_free_links(&u);
}
END_TEST

START_TEST(constants_have_their_values) {
  double value = 7;
  ck_assert_int_eq(hr2d_constant("HR2D_FLOOR", &value), HR2D_OK);
  ck_assert_double_eq(value, HR2D_FLOOR);
  ck_assert_int_eq(hr2d_constant("HR2D_ALL_THREADS", &value), HR2D_OK);
  ck_assert(value > 0 && (unsigned)value == HR2D_ALL_THREADS);
  ck_assert_int_eq(hr2d_constant("HR2D_SMALLEST_ERROR", &value), HR2D_OK);
  ck_assert_double_eq(value, HR2D_SMALLEST_ERROR);
  ck_assert_int_eq(hr2d_constant("HR2D_EACCURACY", &value), HR2D_OK);
  ck_assert_double_eq(value, HR2D_EACCURACY);
  const char *const unknown[] = {"", "HR2D_", "HR2D_FLOO", "HR2D_FLOOR ", "hr2d_floor"};
  for (size_t k = 0; k < sizeof unknown / sizeof *unknown; k++) {
    value = 7;
    ck_assert_int_eq(hr2d_constant(unknown[k], &value), HR2D_EINVAL);
    ck_assert_double_eq(value, 7);
  }
}
END_TEST

TEST_SUITE("options") {
  ADD_TESTS("defaults", refinements_are_the_same, solves_are_the_same, enclosures_are_the_same,
            matrices_are_the_same, targets_are_the_same, patches_are_the_same);
  ADD_TESTS("bindings", functions_touch_what_is_there, a_size_that_is_not_set_is_refused,
            constants_have_their_values);
  ADD_TESTS("names", zeros_have_names, all_threads_change_no_bit);
}
