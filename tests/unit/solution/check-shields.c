/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Radiation shields: closed forms of textbooks, the pane that a shield is, the heat balance of
   several bands, and what is refused. */
#include <hr2d/symmetry.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"
#include "support/tape.h"

static void add(hr2d_scene *scene, hr2d_segment at, hr2d_heat given, double value,
                const double *emissivity, size_t bands) {
  hr2d_patch p = HR2D_PATCH_INIT;
  hr2d_thermal t = HR2D_THERMAL_INIT;
  p.a = at.a;
  p.b = at.b;
  t.given = given;
  t.value = value;
  t.emissivity = emissivity;
  t.emissivity_bands = bands;
  ck_assert_msg(hr2d_scene_add_thermal(scene, &p, &t, NULL) == HR2D_OK, "%s",
                hr2d_scene_message(scene));
}

static void add_grey(hr2d_scene *scene, hr2d_segment at, hr2d_heat given, double value,
                     double emissivity) {
  add(scene, at, given, value, &emissivity, 1);
}

static hr2d_solution *solve_to(hr2d_scene *scene, double error, hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s: %s", hr2d_strerror(status),
                hr2d_scene_message(scene));
  ck_assert_ptr_nonnull(solution);
  return solution;
}

/* Plates without ends: 1000 K, n shields of .1, 300 K. */
static hr2d_scene *plates(int shields, hr2d_heat given) {
  hr2d_scene *scene = test_new_scene(NULL);
  const double x = shields + 1;
  add_grey(scene, (hr2d_segment){{0, 1}, {0, 0}}, HR2D_HEAT_TEMPERATURE, 1000, .8);
  add_grey(scene, (hr2d_segment){{x, 0}, {x, 1}}, HR2D_HEAT_TEMPERATURE, 300, .8);
  for (int k = 1; k <= shields; k++) {
    add_grey(scene, (hr2d_segment){{k, 0}, {k, 1}}, given, 0, .1);
    add_grey(scene, (hr2d_segment){{k, 1}, {k, 0}}, given, 0, .1);
  }
  for (int k = 0; k < 2; k++)
    ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{0, k}, {1, k}}), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* q = σ(T₁⁴ − T₂⁴)/Σ(1/ε + 1/ε′ − 1), and σT⁴ of the shields on a line of the sums. */
START_TEST(series_of_shields_have_their_closed_form) {
  const int shields = _i;
  hr2d_scene *scene = plates(shields, HR2D_HEAT_SHIELD);
  hr2d_solution *s = solve_to(scene, 1e-7, NULL);
  double kelvin[10];
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  to.kelvin = kelvin;
  ck_assert_int_eq(hr2d_solution_temperatures(s, NULL, NULL, &to), HR2D_OK);
  const double hot = hr2d_black_body(1000), cold = hr2d_black_body(300);
  const double end = 1 / .8 + 1 / .1 - 1, between = 2 / .1 - 1;
  const double sum = shields ? 2 * end + (shields - 1) * between : 2 / .8 - 1;
  const double q = (hot - cold) / sum;
  if (shields == 1) ck_assert_double_eq_tol(q, 2743.6314, 5e-5);
  ck_assert_double_eq_tol(hr2d_solution_net_flux(s, 0, 0), q, 1e-6 * q);
  for (int k = 0; k < shields; k++) {
    const double black = hot - q * (end + k * between);
    const size_t side = 2 + 2 * (size_t)k;
    ck_assert_double_eq_tol(hr2d_black_body(kelvin[side]), black, 1e-6 * black);
    ck_assert(kelvin[side] == kelvin[side + 1]);
    ck_assert_double_eq_tol(hr2d_solution_net_flux(s, side + 1, 0), q, 1e-6 * q);
  }
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The control: with a flux of 0 on each side no heat goes through. */
START_TEST(two_insulated_sides_are_no_shield) {
  hr2d_scene *scene = plates(1, HR2D_HEAT_FLUX);
  hr2d_solution *s = solve_to(scene, 1e-7, NULL);
  ck_assert_double_eq_tol(hr2d_solution_net_flux(s, 0, 0), 0, 1e-3);
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Two rooms, and a shield of .3 and .8 between them. */
static hr2d_scene *rooms(size_t wavelengths, const double *front, const double *back) {
  static const double wavelength[] = {2, 4, 8};
  const double wall = .6;
  hr2d_scene *scene = test_new_scene(NULL);
  const size_t bands = wavelengths + 1;
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, wavelength, wavelengths), HR2D_OK);
  static const hr2d_segment at[] = {{{0, 1}, {0, 0}}, {{0, 0}, {1, 0}}, {{1, 1}, {0, 1}},
                                    {{1, 0}, {2, 0}}, {{2, 0}, {2, 1}}, {{2, 1}, {1, 1}}};
  for (int k = 0; k < 6; k++)
    add(scene, at[k], HR2D_HEAT_TEMPERATURE, k == 0 ? 1200 : k < 3 ? 400 : 300, &wall, 1);
  add(scene, (hr2d_segment){{1, 0}, {1, 1}}, HR2D_HEAT_SHIELD, 0, front, bands);
  add(scene, (hr2d_segment){{1, 1}, {1, 0}}, HR2D_HEAT_SHIELD, 0, back, bands);
  test_commit(scene);
  return scene;
}

enum { FRONT = 6, BACK = 7, PATCHES = 8 };

/* ρ = 1 − τ, τ = εε′/(ε + ε′), and T at points from H of both sides. */
START_TEST(a_shield_in_one_band_is_a_pane) {
  const double f = .3, b = .8, at[] = {.2, .7}, turned[] = {.8, .3};
  double kelvin[2], h[2], other[2];
  hr2d_scene *scene = rooms(0, &f, &b);
  ck_assert_double_eq_tol(hr2d_scene_transmittance(scene, FRONT, 0), f * b / (f + b), 1e-16);
  ck_assert(hr2d_scene_reflectance(scene, BACK, 0) ==
            1 - hr2d_scene_transmittance(scene, BACK, 0));
  ck_assert_int_eq(hr2d_scene_heat(scene, FRONT, NULL), HR2D_HEAT_SHIELD);
  hr2d_solution *s = solve_to(scene, 1e-9, NULL);
  ck_assert_double_eq_tol(
      hr2d_solution_net_flux(s, FRONT, 0) / hr2d_solution_net_flux(s, BACK, 0), -1, 1e-12);
  ck_assert_int_eq(hr2d_solution_gather_temperature(s, FRONT, at, 2, kelvin), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_gather_irradiance(s, FRONT, at, 2, h), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_gather_irradiance(s, BACK, turned, 2, other), HR2D_OK);
  for (int k = 0; k < 2; k++)
    ck_assert_double_eq_tol(hr2d_black_body(kelvin[k]), (f * h[k] + b * other[k]) / (f + b),
                            1e-11 * h[k]);
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Grey in three bands it is what it is in one, cut into pieces so short that T along it does
   not matter: its balance there is that of averages. */
static void read_shield(hr2d_scene *scene, double kelvin[PATCHES], double heat[PATCHES],
                        double bound[PATCHES]) {
  hr2d_account account;
  hr2d_solution *s = solve_to(scene, 1e-8, &account);
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  to.kelvin = kelvin;
  to.heat = heat;
  to.bound = bound;
  ck_assert_int_eq(hr2d_solution_temperatures(s, NULL, &account, &to), HR2D_OK);
  hr2d_solution_destroy(s);
}

START_TEST(bands_share_one_temperature) {
  static const double grey[] = {.3, .3, .3, .3}, other[] = {.8, .8, .8, .8},
                      steep[] = {.1, .3, .6, .9}, flat[] = {.5, .5, .5, .4};
  double kelvin[3][PATCHES], heat[3][PATCHES], bound[3][PATCHES];
  for (int k = 0; k < 3; k++) {
    hr2d_scene *scene = k < 2 ? rooms(k ? 3 : 0, grey, other) : rooms(3, steep, flat);
    read_shield(scene, kelvin[k], heat[k], bound[k]);
    ck_assert(kelvin[k][FRONT] == kelvin[k][BACK]);
    ck_assert_double_eq_tol(heat[k][FRONT] + heat[k][BACK], 0, 1e-6 * fabs(heat[k][BACK]));
    hr2d_scene_destroy(scene);
  }
  /* One band has T from point to point, four have one of the whole sheet. */
  ck_assert_double_eq_tol(heat[1][BACK], heat[0][BACK], .01 * heat[0][BACK]);
  ck_assert_double_eq_tol(kelvin[1][BACK], kelvin[0][BACK], .01 * kelvin[0][BACK]);
  ck_assert_double_ge(fabs(heat[2][BACK] - heat[1][BACK]), .01 * heat[1][BACK]);
}
END_TEST

/* Where nothing depends on the place, bands change nothing: a sheet between plates without
   ends. */
START_TEST(grey_bands_are_one_band) {
  static const double wavelength[] = {3, 6};
  double heat[2];
  for (int k = 0; k < 2; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    if (k) ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, wavelength, 2), HR2D_OK);
    add_grey(scene, (hr2d_segment){{0, 1}, {0, 0}}, HR2D_HEAT_TEMPERATURE, 1000, .8);
    add_grey(scene, (hr2d_segment){{2, 0}, {2, 1}}, HR2D_HEAT_TEMPERATURE, 300, .8);
    add_grey(scene, (hr2d_segment){{1, 0}, {1, 1}}, HR2D_HEAT_SHIELD, 0, .1);
    add_grey(scene, (hr2d_segment){{1, 1}, {1, 0}}, HR2D_HEAT_SHIELD, 0, .4);
    for (int m = 0; m < 2; m++)
      ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{0, m}, {1, m}}), HR2D_OK);
    test_commit(scene);
    hr2d_solution *s = solve_to(scene, 1e-6, NULL);
    heat[k] = 0;
    for (size_t b = 0; b < hr2d_scene_bands(scene); b++)
      heat[k] += hr2d_solution_net_flux(s, 3, b);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  const double q = (hr2d_black_body(1000) - hr2d_black_body(300)) /
                   (1 / .8 + 1 / .1 - 1 + 1 / .4 + 1 / .8 - 1);
  ck_assert_double_eq_tol(heat[0], q, 1e-5 * q);
  ck_assert_double_eq_tol(heat[1], q, 1e-5 * q);
}
END_TEST

static void refuse(hr2d_scene *scene, hr2d_status status, const char *phrase) {
  ck_assert_int_eq(hr2d_scene_commit(scene), status);
  test_expect_message(scene, phrase);
  hr2d_scene_destroy(scene);
}

START_TEST(sheets_that_are_no_shields_are_refused) {
  const hr2d_segment front = {{1, 0}, {1, 1}}, back = {{1, 1}, {1, 0}};
  hr2d_scene *scene = test_new_scene(NULL);
  add_grey(scene, front, HR2D_HEAT_SHIELD, 0, .5);
  refuse(scene, HR2D_ESCENE, "is a side of a shield");
  scene = test_new_scene(NULL);
  add_grey(scene, front, HR2D_HEAT_SHIELD, 0, .5);
  add_grey(scene, back, HR2D_HEAT_TEMPERATURE, 300, .5);
  refuse(scene, HR2D_ESCENE, "is a side of a shield");

  scene = test_new_scene(NULL);
  hr2d_patch p = HR2D_PATCH_INIT;
  p.b.x = 1;
  const double half = .5, none = 0, table[] = {.1, .2}, kelvins[] = {300, 900};
  hr2d_thermal t = HR2D_THERMAL_INIT;
  t.given = HR2D_HEAT_SHIELD;
  t.value = 3;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &p, &t, NULL), HR2D_EINVAL);
  t.value = 0;
  t.emissivity = &none;
  t.emissivity_bands = 1;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &p, &t, NULL), HR2D_ESCENE);
  t.emissivity = table;
  t.kelvin = kelvins;
  t.kelvins = 2;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &p, &t, NULL), HR2D_EUNSUPPORTED);
  t = (hr2d_thermal)HR2D_THERMAL_INIT;
  t.given = HR2D_HEAT_SHIELD;
  p.transmittance = &half;
  p.transmittance_bands = 1;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &p, &t, NULL), HR2D_ESCENE);
  hr2d_scene_destroy(scene);
}
END_TEST

/* No wall has a temperature, so that nothing tells that of the shield. */
START_TEST(some_wall_must_have_a_temperature) {
  static const hr2d_segment at[] = {
      {{0, 0}, {2, 0}}, {{2, 0}, {2, 1}}, {{2, 1}, {0, 1}}, {{0, 1}, {0, 0}}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < 4; k++)
    add_grey(scene, at[k], HR2D_HEAT_FLUX, k == 0 ? 100 : k == 2 ? -100 : 0, .5);
  add_grey(scene, (hr2d_segment){{.5, .5}, {1.5, .5}}, HR2D_HEAT_SHIELD, 0, .5);
  add_grey(scene, (hr2d_segment){{1.5, .5}, {.5, .5}}, HR2D_HEAT_SHIELD, 0, .5);
  test_commit(scene);
  hr2d_solution *solution = NULL;
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, NULL), HR2D_ENO_SOLUTION);
  hr2d_scene_destroy(scene);
}
END_TEST

/* What a file says. */
START_TEST(files_have_shields) {
  static const char text[] =
      "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":"
      "{\"name\":\"foil\",\"sides\":\"both\",\"shield\":true,\"emissivity\":0.1,"
      "\"back\":{\"emissivity\":0.4}},\"geometry\":{\"type\":\"LineString\",\"coordinates\":"
      "[[1,0],[1,1],[2,1]]}},{\"type\":\"Feature\",\"properties\":{\"temperature\":900},"
      "\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[0,2],[0,0]]}}]}";
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_msg(hr2d_scene_parse(scene, text, strlen(text)) == HR2D_OK, "%s",
                hr2d_scene_message(scene));
  test_commit(scene);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 5);
  ck_assert_str_eq(hr2d_scene_name(scene, 1), "foil/1 (back)");
  for (size_t k = 0; k < 4; k++) {
    ck_assert_int_eq(hr2d_scene_heat(scene, k, NULL), HR2D_HEAT_SHIELD);
    ck_assert(hr2d_scene_emissivity(scene, k, 0) == (k % 2 ? .4 : .1));
    ck_assert_uint_eq(hr2d_scene_other_side(scene, k), k ^ 1);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* A scene as bytes, and the state of a solve with the temperature of a sheet. */
START_TEST(bytes_keep_shields) {
  static const double steep[] = {.1, .3, .6, .9}, flat[] = {.5, .5, .5, .4};
  hr2d_scene *scene = rooms(3, steep, flat), *copy = test_new_scene(NULL);
  tape t = {.until_failure = -1}, state = {.until_failure = -1};
  ck_assert_int_eq(hr2d_state_write_scene(scene, tape_record, &t), HR2D_OK);
  ck_assert_int_eq(hr2d_state_read_scene(copy, tape_play, &t), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_heat(copy, BACK, NULL), HR2D_HEAT_SHIELD);
  test_links one = test_make_links(scene, NULL, NULL, NULL, NULL),
             other = test_make_links(copy, NULL, NULL, NULL, NULL);
  test_refine(&one, .3, 6);
  hr2d_solution *s = test_solve(&one, 1), *again = NULL;
  ck_assert_int_eq(hr2d_state_write(s, tape_record, &state), HR2D_OK);
  ck_assert_msg(hr2d_state_read(other.links, tape_play, &state, &again) == HR2D_OK, "%s",
                hr2d_linkset_message(other.links));
  double kelvin[2];
  const double middle = .5;
  ck_assert_int_eq(hr2d_solution_gather_temperature(s, FRONT, &middle, 1, &kelvin[0]), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_gather_temperature(again, BACK, &middle, 1, &kelvin[1]),
                   HR2D_OK);
  ck_assert(kelvin[0] == kelvin[1] && kelvin[0] > 300);
  hr2d_solution_destroy(s);
  hr2d_solution_destroy(again);
  test_free_links(&one);
  test_free_links(&other);
  free(t.byte);
  free(state.byte);
}
END_TEST

TEST_SUITE("shields") {
  REPEAT_TESTS(4, "closed forms", series_of_shields_have_their_closed_form);
  ADD_TESTS("shields", two_insulated_sides_are_no_shield, a_shield_in_one_band_is_a_pane,
            bands_share_one_temperature, grey_bands_are_one_band,
            sheets_that_are_no_shields_are_refused, some_wall_must_have_a_temperature,
            files_have_shields, bytes_keep_shields);
}
