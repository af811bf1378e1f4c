/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Enclosures hold what is known of rooms, and what solves with ten digits find. */
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "enclosure/enclosure-sweep.h"
#include "mesh/admissibility.h"
#include "support/radiosity-scenes.h"
#include "support/room-plans.h"
#include "support/support.h"

static hr2d_enclosure *enclose(const hr2d_scene *scene, double gap, uint64_t max_links,
                               hr2d_enclosure_account *account) {
  hr2d_enclose_options options = HR2D_ENCLOSE_OPTIONS_INIT;
  hr2d_enclosure *e;
  options.gap = gap;
  options.max_links = max_links;
  const hr2d_status status = hr2d_enclose(scene, &options, &e, account);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s", account->reason);
  ck_assert_ptr_nonnull(e);
  ck_assert_int_eq(status == HR2D_OK, account->gap <= gap);
  ck_assert_int_eq(status == HR2D_OK, !*account->reason);
  ck_assert_uint_le(account->links, max_links ? max_links : HR2D_DEFAULT_ENCLOSURE_LINKS);
  return e;
}

/* Asserts that a value is between the ends of an average. */
static void expect_b(const hr2d_enclosure *e, size_t patch, double value, double off) {
  const double low = hr2d_enclosure_lower(e, patch, 0),
               high = hr2d_enclosure_upper(e, patch, 0);
  ck_assert_msg(low <= value + off && value <= high + off,
                "B of patch %zu is %.17g, not from %.17g to %.17g", patch, value, low, high);
}

static void expect_h(const hr2d_enclosure *e, size_t patch, double value, double off) {
  const double low = hr2d_enclosure_lower_irradiance(e, patch, 0),
               high = hr2d_enclosure_upper_irradiance(e, patch, 0);
  ck_assert_msg(low <= value + off && value <= high + off,
                "H of patch %zu is %.17g, not from %.17g to %.17g", patch, value, low, high);
}

/* A closed room with E = 1 − ρ has B = H = 1. */
START_TEST(furnaces) {
  randoms r = randoms_stream(test_seed(), _i);
  plan p = {0};
  plan_classes[_i].draw(&r, 4, &p);
  const test_paint paint = {.r = &r, .reflectance = 0.8, .isothermal = 1};
  hr2d_scene *scene = test_painted_scene(&p, &paint);
  hr2d_enclosure_account account;
  hr2d_enclosure *e = enclose(scene, 0.05, 5000, &account);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    expect_b(e, k, 1, 0);
    expect_h(e, k, 1, 0);
  }
  hr2d_enclosure_destroy(e);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

/* Two black plates, 1 long, d apart: F = √(1 + d²) − d, and B has no range. */
START_TEST(plates) {
  const double d = 0.25, f = sqrt(1 + d * d) - d;
  const double at[][6] = {{0, 0, 1, 0, 2, 0}, {1, d, 0, d, 3, 0}};
  hr2d_scene *scene = test_scene(at, 2);
  hr2d_enclosure_account account;
  hr2d_enclosure *e = enclose(scene, 1e-12, 0, &account);
  ck_assert_uint_eq(account.links, 1);
  expect_h(e, 0, 3 * f, 0);
  expect_h(e, 1, 2 * f, 0);
  expect_b(e, 0, 2, 0);
  hr2d_enclosure_destroy(e);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Ground under an even sky, alone or below a black plate: H is what the plate leaves of it. */
START_TEST(skies) {
  const hr2d_segment plain = {{-1, 0}, {1, 0}}, plate = {{-5, 3}, {-6, 3}},
                     top = {{-6, 3}, {-5, 3}};
  const double light = 2;
  for (int covered = 0; covered < 2; covered++) {
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(hr2d_scene_set_background(scene, &light, 1), HR2D_OK);
    ck_assert_int_eq(test_add_patch(scene, plain, 0, 0.5, HR2D_SIDES_FRONT), HR2D_OK);
    for (int k = 0; k < 2 * covered; k++)
      ck_assert_int_eq(test_add_patch(scene, k ? top : plate, 0, 0, HR2D_SIDES_FRONT), HR2D_OK);
    test_commit(scene);
    const double h = light * (1 - covered * hr2d_exchange_area(&plain, &plate) / 2);
    hr2d_enclosure_account account;
    hr2d_enclosure *e = enclose(scene, 1e-3, 0, &account);
    ck_assert_double_le(account.gap, 1e-3);
    expect_h(e, 0, h, 0);
    expect_b(e, 0, h / 2, 0);
    hr2d_enclosure_destroy(e);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A plate that sees a black back before the sky: from 0 to all of it, and that is said. */
START_TEST(backs) {
  const hr2d_segment plain = {{-1, 0}, {1, 0}}, back = {{-1, 1}, {1, 1}};
  const double light = 1;
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &light, 1), HR2D_OK);
  ck_assert_int_eq(test_add_patch(scene, plain, 0, 0.5, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(test_add_patch(scene, back, 0, 0.5, HR2D_SIDES_FRONT), HR2D_OK);
  test_commit(scene);
  const hr2d_segment front = {{1, 1}, {-1, 1}};
  hr2d_enclosure_account account;
  hr2d_enclosure *e = enclose(scene, 1e-3, 1000, &account);
  expect_h(e, 0, 1 - hr2d_exchange_area(&plain, &front) / 2, 0);
  ck_assert_msg(strstr(account.reason, "back") != NULL, "%s", account.reason);
  hr2d_enclosure_destroy(e);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The averages of another solver, to the digits of its table. */
START_TEST(reference_table) {
  radiosity_scenes table;
  ck_assert_int_eq(radiosity_scenes_read(test_data_path("radiosity_fine.csv"), &table), 0);
  for (size_t k = 0; k < table.count; k++) {
    const radiosity_scene *s = &table.scene[k];
    hr2d_scene *scene = radiosity_scene_make(s, NULL);
    hr2d_enclosure_account account;
    hr2d_enclosure *e = enclose(scene, 1e-2, 100000, &account);
    ck_assert_double_lt(account.gap, 0.1);
    for (size_t p = 0; p < s->patches; p++) expect_b(e, p, s->average[p], 1e-8);
    hr2d_enclosure_destroy(e);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* No average of a solve is further outside than its own bound. */
static void expect_solution(const hr2d_scene *scene, const hr2d_enclosure *e, double target) {
  hr2d_target to = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  hr2d_account account;
  to.error = target;
  hr2d_solve_to(scene, &to, &solution, &account);
  ck_assert_ptr_nonnull(solution);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const double b = hr2d_solution_average(solution, k, 0),
                 h = hr2d_solution_irradiance(solution, k, 0);
    expect_b(e, k, b, account.average.bound * b);
    expect_h(e, k, h, account.irradiance.bound * h);
  }
  double average, irradiance;
  ck_assert_int_eq(hr2d_enclosure_error(e, solution, 0, &average, &irradiance), HR2D_OK);
  ck_assert_double_ge(average, 0);
  ck_assert_double_ge(irradiance, 0);
  hr2d_solution_destroy(solution);
}

START_TEST(random_rooms) {
  randoms r = randoms_stream(test_seed(), 100 + _i);
  for (int turn = test_count(3); turn > 0; turn--) {
    plan p = {0};
    plan_classes[_i].draw(&r, 3, &p);
    const test_paint paint = {.r = &r,
                              .reflectance = random_between(&r, 0.2, 0.9),
                              .emission = 1,
                              .background = turn % 2 ? 0 : 1};
    hr2d_scene *scene = test_painted_scene(&p, &paint);
    hr2d_enclosure_account account;
    hr2d_enclosure *e = enclose(scene, random_power(&r, -2.5, -0.5), 5000, &account);
    expect_solution(scene, e, 1e-6);
    hr2d_enclosure_destroy(e);
    hr2d_scene_destroy(scene);
    plan_free(&p);
  }
}
END_TEST

static const double corner_room[][6] = {
    {0, 0, 2, 0, 1, 0.5}, {2, 0, 2, 1, 0, 0.7}, {2, 1, 0, 1, 0, 0.3}, {0, 1, 0, 0, 0, 0.8}};

/* Ten times fewer links than the square of the gap would take. */
START_TEST(links_grow_like_one_over_the_gap) {
  hr2d_scene *scene = test_scene(corner_room, 4);
  hr2d_enclosure_account coarse, fine;
  hr2d_enclosure_destroy(enclose(scene, 3e-2, 0, &coarse));
  hr2d_enclosure *e = enclose(scene, 1e-3, 0, &fine);
  ck_assert_double_le(fine.gap, 1e-3);
  ck_assert_double_le((double)fine.links * fine.gap, 2 * (double)coarse.links * coarse.gap);
  expect_solution(scene, e, 1e-10);
  hr2d_enclosure_destroy(e);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_status refuse(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) error[k] = 1;
  return HR2D_OK;
}

/* Links between all leaves of a room, 32 for each patch. */
static void make_pairs(hr2di_enclosing *e, hr2d_scene *scene) {
  const hr2d_oracle leaves = {.struct_size = sizeof leaves,
                              .name = "leaves",
                              .flags = HR2D_ORACLE_SYMMETRIC,
                              .estimate = refuse};
  *e = (hr2di_enclosing){.scene = scene, .alloc = hr2di_alloc_default(), .bands = 1};
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &e->hierarchy), HR2D_OK);
  for (uint32_t k = 0; k < 4 * 31; k++)
    ck_assert_int_eq(hr2d_hierarchy_divide(e->hierarchy, k, 0.5, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(e->hierarchy, &leaves, NULL,
                                       hr2di_admissibility_fixed_leaves(), NULL, &e->links),
                   HR2D_OK);
  ck_assert_int_eq(hr2d_refine(e->links, NULL), HR2D_OK);
  e->count = hr2d_linkset_size(e->links);
  e->link = hr2di_alloc(&e->alloc, e->count, sizeof *e->link);
  hr2di_enclosed_links_make(e->links, NULL, 0, e->count, e->link);
}

/* Whether the upper end of a patch holds if all upper factors are multiplied by `part`. */
static int holds_with(double part, double right) {
  hr2d_scene *scene = test_scene(corner_room, 4);
  hr2di_enclosing e;
  make_pairs(&e, scene);
  for (size_t k = 0; k < e.count; k++) {
    e.link[k].area.upper *= part;
    for (int n = 0; n < 4; n++) e.link[k].factor[n / 2].at[n % 2].upper *= part;
  }
  ck_assert_int_eq(hr2di_enclosing_begin(&e), HR2D_OK);
  ck_assert_int_eq(hr2di_enclosing_sweep(&e), HR2D_OK);
  double max = 0;
  for (uint32_t k = 0; k < e.elements; k++)
    if (hr2di_enclosing_has(&e, k) && e.hierarchy->element[k].patch == 2)
      max += e.b[k].mean.upper / 32;
  hr2di_enclosing_forget(&e);
  hr2di_alloc_free(&e.alloc, e.link);
  hr2d_linkset_destroy(e.links);
  hr2d_hierarchy_destroy(e.hierarchy);
  hr2d_scene_destroy(scene);
  return right <= max;
}

START_TEST(lower_factors_are_noticed) {
  hr2d_scene *scene = test_scene(corner_room, 4);
  hr2d_solution *solution;
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, NULL), HR2D_OK);
  const double right = hr2d_solution_average(solution, 2, 0);
  ck_assert(holds_with(1, right));
  ck_assert(!holds_with(0.95, right));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A budget that is too small: what was reached is true, and the account says so. */
START_TEST(budgets) {
  hr2d_scene *scene = test_scene(corner_room, 4);
  hr2d_enclosure_account account;
  hr2d_enclosure *e = enclose(scene, 1e-6, 500, &account);
  ck_assert_double_gt(account.gap, 1e-6);
  ck_assert_ptr_nonnull(strstr(account.reason, "links leave a gap of"));
  expect_solution(scene, e, 1e-10);
  hr2d_enclosure_destroy(e);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Two bands are two scenes. */
START_TEST(bands) {
  const hr2d_segment at[] = {{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, {0, 0}}};
  const double emission[][3] = {{1, 0, 2}, {0, 1, 0}, {0, 0, 0}};
  const double reflectance[][3] = {{.5, .2, .9}, {.5, .5, .1}, {.8, .8, 0}};
  hr2d_scene *scene = test_coloured_scene(at, emission, reflectance, 3);
  hr2d_enclosure_account account;
  hr2d_enclosure *e = enclose(scene, 1e-2, 0, &account);
  hr2d_solution *solution;
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, NULL), HR2D_OK);
  for (size_t k = 0; k < 3; k++)
    for (size_t b = 0; b < 3; b++) {
      const double value = hr2d_solution_average(solution, k, b);
      ck_assert_double_le(hr2d_enclosure_lower(e, k, b), value * (1 + 1e-5));
      ck_assert_double_ge(hr2d_enclosure_upper(e, k, b), value * (1 - 1e-5));
    }
  hr2d_solution_destroy(solution);
  hr2d_enclosure_destroy(e);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Half of a room beside a mirror has the ends of the whole room. */
START_TEST(mirrors) {
  const double whole[][6] = {{-1, 0, 0, 0, 0, .5},    {0, 0, 1, 0, 0, .5},
                             {1, 0, 1, 1, 1, .6},     {1, 1, 0, 1, 0, .8},
                             {0, 1, -1, 1, 0, .8},    {-1, 1, -1, 0, 1, .6},
                             {.5, .5, .7, .6, 0, .7}, {-.7, .6, -.5, .5, 0, .7}};
  const int half[] = {1, 2, 3, 6};
  hr2d_scene *full = test_scene(whole, 8), *scene = test_new_scene(NULL);
  for (int k = 0; k < 4; k++) {
    const double *p = whole[half[k]];
    ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){{p[0], p[1]}, {p[2], p[3]}}, p[4],
                                    p[5], HR2D_SIDES_FRONT),
                     HR2D_OK);
  }
  const hr2d_segment line = {{0, 0}, {0, 1}};
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, line), HR2D_OK);
  test_commit(scene);
  hr2d_enclosure_account account;
  hr2d_enclosure *e = enclose(scene, 1e-2, 0, &account);
  ck_assert_double_le(account.gap, 1e-2);
  hr2d_solution *solution;
  ck_assert_int_eq(hr2d_solve_to(full, NULL, &solution, NULL), HR2D_OK);
  for (size_t k = 0; k < 4; k++)
    expect_b(e, k, hr2d_solution_average(solution, (size_t)half[k], 0), 1e-5);
  hr2d_solution_destroy(solution);
  hr2d_enclosure_destroy(e);
  hr2d_scene_destroy(scene);
  hr2d_scene_destroy(full);
}
END_TEST

static void expect_refusal(hr2d_scene *scene, const char *phrase) {
  test_commit(scene);
  hr2d_enclosure *e = (hr2d_enclosure *)scene;
  hr2d_enclosure_account account;
  ck_assert_int_eq(hr2d_enclose(scene, NULL, &e, &account), HR2D_EUNSUPPORTED);
  ck_assert_ptr_null(e);
  ck_assert_msg(strstr(account.reason, phrase) != NULL, "%s", account.reason);
  ck_assert(isinf(account.gap));
  hr2d_scene_destroy(scene);
}

static hr2d_scene *ground(double reflectance) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_segment at[] = {{{0, 0}, {1, 0}}, {{1, 0.2}, {0, 1}}};
  for (int k = 0; k < 2; k++)
    ck_assert_int_eq(test_add_patch(scene, at[k], 1, reflectance, HR2D_SIDES_FRONT), HR2D_OK);
  return scene;
}

START_TEST(what_is_not_enclosed_is_refused) {
  expect_refusal(ground(1), "absorbs nothing");
  hr2d_scene *scene = ground(0.5);
  const hr2d_sun sun = {{0, -1}, 1};
  ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  expect_refusal(scene, "suns");
  scene = ground(0.5);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1.5, 0}), HR2D_OK);
  expect_refusal(scene, "for ever");
  scene = ground(0.5);
  const hr2d_sky_piece piece = {10, 20};
  const double value = 1;
  ck_assert_int_eq(hr2d_scene_set_sky(scene, &piece, 1, &value, 1), HR2D_OK);
  expect_refusal(scene, "sky in pieces");
  scene = ground(0.5);
  hr2d_patch patch = test_patch(3, 0, 3, 1);
  hr2d_thermal heat = HR2D_THERMAL_INIT;
  heat.given = HR2D_HEAT_FLUX;
  heat.value = 1;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &heat, NULL), HR2D_OK);
  expect_refusal(scene, "heat flux");
}
END_TEST

START_TEST(wrong_arguments_are_refused) {
  hr2d_scene *scene = test_scene(corner_room, 4);
  hr2d_enclose_options options = HR2D_ENCLOSE_OPTIONS_INIT;
  hr2d_enclosure *e;
  options.gap = NAN;
  ck_assert_int_eq(hr2d_enclose(scene, &options, &e, NULL), HR2D_EINVAL);
  options.gap = -1;
  ck_assert_int_eq(hr2d_enclose(scene, &options, &e, NULL), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_enclose(scene, NULL, NULL, NULL), HR2D_EINVAL);
  hr2d_enclosure_account account;
  e = enclose(scene, 0.5, 0, &account);
  ck_assert(isnan(hr2d_enclosure_lower(e, 4, 0)) && isnan(hr2d_enclosure_upper(e, 0, 1)));
  ck_assert(isnan(hr2d_enclosure_lower_irradiance(NULL, 0, 0)));
  ck_assert_int_eq(hr2d_enclosure_error(e, NULL, 0, NULL, NULL), HR2D_EINVAL);
  hr2d_enclosure_destroy(e);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("enclosures") {
  REPEAT_TESTS(plan_class_count, "rooms", furnaces, random_rooms);
  ADD_TESTS("known", plates, skies, backs, reference_table, bands, mirrors);
  ADD_TESTS("calls", links_grow_like_one_over_the_gap, budgets, lower_factors_are_noticed,
            what_is_not_enclosed_is_refused, wrong_arguments_are_refused);
}
