/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Thermal properties by calls and in files: what is refused and what is said about it, scenes
   without a solution, wavelengths. */
#include <math.h>
#include <string.h>

#include "support/support.h"

static hr2d_status add(hr2d_scene *scene, const double at[4], hr2d_heat given, double value,
                       const double *emissivity, size_t bands) {
  const hr2d_patch patch = test_patch(at[0], at[1], at[2], at[3]);
  hr2d_thermal t = HR2D_THERMAL_INIT;
  t.given = given;
  t.value = value;
  t.emissivity = emissivity;
  t.emissivity_bands = bands;
  return hr2d_scene_add_thermal(scene, &patch, &t, NULL);
}

static const double side[4][4] = {{0, 0, 1, 0}, {1, 0, 1, 1}, {1, 1, 0, 1}, {0, 1, 0, 0}};

#define ONE                                                                                    \
  &(const double) {                                                                            \
    1                                                                                          \
  }

START_TEST(wrong_properties_are_refused) {
  const struct {
    hr2d_heat given;
    double value;
    double emissivity[2];
    size_t bands;
    hr2d_status status;
    const char *phrase;
  } wrong[] = {
      {HR2D_HEAT_NONE, 0, {1}, 1, HR2D_EINVAL, "neither"},
      {(hr2d_heat)7, 0, {1}, 1, HR2D_EINVAL, "neither"},
      {HR2D_HEAT_TEMPERATURE, -20, {1}, 1, HR2D_ESCENE, "in kelvin"},
      {HR2D_HEAT_TEMPERATURE, NAN, {1}, 1, HR2D_ESCENE, "not finite"},
      {HR2D_HEAT_TEMPERATURE, 1e80, {1}, 1, HR2D_ESCENE, "too large"},
      {HR2D_HEAT_FLUX, INFINITY, {1}, 1, HR2D_ESCENE, "not finite"},
      {HR2D_HEAT_FLUX, 1, {0}, 1, HR2D_ESCENE, "emissivity is 0"},
      {HR2D_HEAT_FLUX, 1, {1.1}, 1, HR2D_ESCENE, "between 0 and 1"},
      {HR2D_HEAT_TEMPERATURE, 1, {NAN}, 1, HR2D_ESCENE, "between 0 and 1"},
      {HR2D_HEAT_TEMPERATURE, 1, {1, 1}, 2, HR2D_ESCENE, "no wavelengths"},
  };
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    ck_assert_int_eq(add(scene, side[0], wrong[k].given, wrong[k].value, wrong[k].emissivity,
                         wrong[k].bands),
                     wrong[k].status);
    test_expect_message(scene, wrong[k].phrase);
  }
  ck_assert_int_eq(add(scene, side[0], HR2D_HEAT_FLUX, 1, NULL, 1), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_scene_patches(scene), 0);
  hr2d_patch patch = test_patch(0, 0, 1, 0);
  hr2d_thermal t;
  memset(&t, 255, sizeof t);
  hr2d_thermal_init(&t, sizeof t);
  t.given = HR2D_HEAT_FLUX;
  patch.emission = ONE;
  patch.emission_bands = 1;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_EINVAL);
  patch.emission_bands = 0;
  t.struct_size = 0;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, NULL, NULL), HR2D_EINVAL);
  t.struct_size = sizeof t;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_OK);
  test_commit(scene);
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, NULL, 0), HR2D_ESTATE);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(what_was_given_is_returned) {
  const double e[] = {.25, .5};
  hr2d_scene *scene = test_new_scene(NULL);
  double value;
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, (const double[]){3}, 1), HR2D_OK);
  ck_assert_int_eq(add(scene, side[0], HR2D_HEAT_TEMPERATURE, 900, e, 2), HR2D_OK);
  ck_assert_int_eq(add(scene, side[1], HR2D_HEAT_TEMPERATURE, 300, e, 1), HR2D_OK);
  test_add_black(scene, side[2]);
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, (const double[]){4}, 1), HR2D_ESTATE);
  test_commit(scene);
  ck_assert_uint_eq(hr2d_scene_bands(scene), 2);
  ck_assert_int_eq(hr2d_scene_heat(scene, 0, &value), HR2D_HEAT_TEMPERATURE);
  ck_assert_double_eq(value, 900);
  ck_assert_double_eq(hr2d_scene_emissivity(scene, 0, 1), .5);
  ck_assert_double_eq(hr2d_scene_emissivity(scene, 1, 1), .25);
  ck_assert_double_eq(hr2d_scene_reflectance(scene, 0, 0), .75);
  const double part = hr2d_black_body_part(900, 0, 3);
  ck_assert_double_eq(hr2d_scene_emission(scene, 0, 0), .25 * (part * hr2d_black_body(900)));
  ck_assert_double_eq_tol(hr2d_scene_emission(scene, 0, 1) / hr2d_black_body(900),
                          .5 * (1 - part), 1e-15);
  ck_assert_int_eq(hr2d_scene_heat(scene, 2, &value), HR2D_HEAT_NONE);
  ck_assert_double_nan(value);
  ck_assert_double_nan(hr2d_scene_emissivity(scene, 2, 0));
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(wrong_wavelengths_are_refused) {
  const double wrong[][2] = {{0, 1}, {-1, 1}, {2, 2}, {3, 2}, {1, INFINITY}, {NAN, 1}};
  static double many[HR2D_MAX_WAVELENGTHS + 1];
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < 6; k++)
    ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, wrong[k], 2), HR2D_ESCENE);
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, NULL, 2), HR2D_EINVAL);
  for (size_t k = 0; k <= HR2D_MAX_WAVELENGTHS; k++) many[k] = (double)(k + 1);
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, many, HR2D_MAX_WAVELENGTHS + 1),
                   HR2D_ESCENE);
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, many, HR2D_MAX_WAVELENGTHS), HR2D_OK);
  /* Other arrays must have as many bands. */
  const double three[3] = {1, 1, 1};
  hr2d_patch patch = test_patch(0, 0, 1, 0);
  patch.emission = three;
  patch.emission_bands = 3;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  test_expect_message(scene, "3 bands where its wavelengths make 512");
  hr2d_scene_destroy(scene);
  scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  ck_assert_int_eq(add(scene, side[1], HR2D_HEAT_TEMPERATURE, 1, NULL, 0), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  test_expect_message(scene, "without wavelengths");
  hr2d_scene_destroy(scene);
}
END_TEST

/* In a room of one temperature no band has a net flux, whatever ε is in each. */
START_TEST(each_band_is_in_equilibrium) {
  hr2d_scene *scene = test_new_scene(NULL);
  const double at[] = {2, 5, 12};
  randoms r = randoms_stream(test_seed(), 0);
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, at, 3), HR2D_OK);
  for (int k = 0; k < 4; k++) {
    double e[4];
    for (int b = 0; b < 4; b++) e[b] = random_between(&r, .01, 1);
    ck_assert_int_eq(add(scene, side[k], HR2D_HEAT_TEMPERATURE, 1000, e, 4), HR2D_OK);
  }
  test_commit(scene);
  hr2d_solution *solution;
  double sum = 0;
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, NULL), HR2D_OK);
  for (size_t b = 0; b < 4; b++) {
    const double h = hr2d_solution_irradiance(solution, 2, b);
    const double part = hr2d_black_body_part(1000, b ? at[b - 1] : 0, b < 3 ? at[b] : INFINITY);
    ck_assert_double_eq_tol(h / hr2d_black_body(1000), part, 1e-12);
    sum += h;
  }
  ck_assert_double_eq_tol(sum / hr2d_black_body(1000), 1, 1e-12);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_scene *square(const hr2d_heat given[4], const double value[4], double emissivity) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < 4; k++)
    ck_assert_int_eq(add(scene, side[k], given[k], value[k], &emissivity, 1), HR2D_OK);
  test_commit(scene);
  return scene;
}

#define T HR2D_HEAT_TEMPERATURE
#define Q HR2D_HEAT_FLUX

/* Fluxes alone have no level in a closed room, whether they sum to 0 or not. */
START_TEST(fluxes_alone_have_no_solution) {
  const double value[][4] = {{1, 1, 1, 1}, {1, -1, 1, -1}, {-1, -1, -1, -1}, {1, 0, 0, 0}};
  for (int k = 0; k < 4; k++) {
    hr2d_scene *scene = square((const hr2d_heat[]){Q, Q, Q, Q}, value[k], .5);
    hr2d_solution *solution = NULL;
    hr2d_account account;
    ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, &account), HR2D_ENO_SOLUTION);
    ck_assert_msg(strstr(account.reason, "no patch has a given temperature") != NULL, "%s",
                  account.reason);
    ck_assert_ptr_null(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

static hr2d_status solve(const hr2d_scene *scene, unsigned char state[4], char reason[160]) {
  hr2d_solution *solution = NULL;
  hr2d_account account;
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  const hr2d_status status = hr2d_solve_to(scene, NULL, &solution, &account);
  memcpy(reason, account.reason, sizeof account.reason);
  if (status) return status;
  to.state = state;
  ck_assert_int_eq(hr2d_solution_temperatures(solution, NULL, &account, &to), HR2D_OK);
  hr2d_solution_destroy(solution);
  return HR2D_OK;
}

/* 300 K send σT⁴ = 459 W/m².  A loss of 500 makes B negative; at ε = ½ a loss of more than half
   of H is too much, too. */
START_TEST(who_loses_too_much_is_named) {
  const double cold[4] = {300, -500, 0, 0}, much[4] = {300, -160, 0, 0},
               little[4] = {300, -50, 0, 0};
  const hr2d_heat given[4] = {T, Q, Q, Q};
  unsigned char state[4];
  char reason[160];
  hr2d_scene *scene = square(given, cold, .5);
  ck_assert_int_eq(solve(scene, state, reason), HR2D_ENO_SOLUTION);
  ck_assert_msg(strstr(reason, "patch 1 would send a negative radiosity") != NULL, "%s",
                reason);
  hr2d_scene_destroy(scene);
  scene = square(given, much, .5);
  ck_assert_int_eq(solve(scene, state, reason), HR2D_OK);
  ck_assert_int_eq(state[1], HR2D_TEMPERATURE_IMPOSSIBLE);
  ck_assert_int_eq(state[2], HR2D_TEMPERATURE_FOUND);
  hr2d_scene_destroy(scene);
  scene = square(given, little, .5);
  ck_assert_int_eq(solve(scene, state, reason), HR2D_OK);
  ck_assert_int_eq(state[1], HR2D_TEMPERATURE_FOUND);
  hr2d_scene_destroy(scene);
}
END_TEST

/* An insulated patch that sees nothing but the dark is not said to have 0 K. */
START_TEST(where_no_heat_arrives_nothing_is_known) {
  hr2d_scene *scene = test_new_scene(NULL);
  unsigned char state[4];
  char reason[160];
  ck_assert_int_eq(add(scene, side[0], T, 500, NULL, 0), HR2D_OK);
  ck_assert_int_eq(add(scene, side[2], Q, 0, NULL, 0), HR2D_OK);
  ck_assert_int_eq(add(scene, (const double[]){10, 0, 9, 0}, Q, 0, NULL, 0), HR2D_OK);
  test_commit(scene);
  ck_assert_int_eq(solve(scene, state, reason), HR2D_OK);
  ck_assert_int_eq(state[0], HR2D_TEMPERATURE_GIVEN);
  ck_assert_int_eq(state[1], HR2D_TEMPERATURE_FOUND);
  ck_assert_int_eq(state[2], HR2D_TEMPERATURE_UNLIT);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(the_call_checks_its_arguments) {
  hr2d_scene *scene =
      square((const hr2d_heat[]){T, Q, T, Q}, (const double[]){300, 0, 500, 0}, .5);
  hr2d_solution *solution;
  hr2d_account account;
  double bound[4], heat_bound[4];
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  hr2d_target target = HR2D_TARGET_INIT;
  const size_t important[] = {1, 1}, none[] = {4};
  target.important = important;
  target.important_count = 2;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &account), HR2D_OK);
  to.bound = bound;
  to.heat_bound = heat_bound;
  ck_assert_int_eq(hr2d_solution_temperatures(solution, &target, &account, &to), HR2D_OK);
  for (int k = 0; k < 4; k++) {
    ck_assert_int_eq(isnan(bound[k]) != 0, k != 1);
    ck_assert_int_eq(isnan(heat_bound[k]) != 0, k != 1);
  }
  ck_assert_int_eq(hr2d_solution_temperatures(solution, NULL, NULL, &to), HR2D_OK);
  for (int k = 0; k < 4; k++) ck_assert_int_eq(isnan(bound[k]) != 0, k % 2);
  account.irradiance = (hr2d_error){INFINITY, INFINITY};
  ck_assert_int_eq(hr2d_solution_temperatures(solution, NULL, &account, &to), HR2D_OK);
  for (int k = 0; k < 4; k++) ck_assert_int_eq(isinf(bound[k]) != 0, k % 2);
  target.important = none;
  target.important_count = 1;
  ck_assert_int_eq(hr2d_solution_temperatures(solution, &target, &account, &to), HR2D_EINVAL);
  target.important = NULL;
  ck_assert_int_eq(hr2d_solution_temperatures(solution, &target, &account, &to), HR2D_EINVAL);
  target.important_count = 0;
  target.floor = 2;
  ck_assert_int_eq(hr2d_solution_temperatures(solution, &target, &account, &to), HR2D_EINVAL);
  to.struct_size = 0;
  ck_assert_int_eq(hr2d_solution_temperatures(solution, NULL, &account, &to), HR2D_EINVAL);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Pieces of a patch keep what is given, and so do both sides. */
START_TEST(pieces_keep_what_is_given) {
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_patch patch = test_patch(0, 0, 2, 0);
  const double e = .25;
  hr2d_thermal t = HR2D_THERMAL_INIT;
  size_t cuts;
  double value;
  t.given = HR2D_HEAT_FLUX;
  t.value = -7;
  t.emissivity = &e;
  t.emissivity_bands = 1;
  patch.sides = HR2D_SIDES_BOTH;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_OK);
  ck_assert_int_eq(add(scene, (const double[]){1, -1, 1, 1}, T, 300, NULL, 0), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_split_crossings(scene, &cuts), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 6);
  for (size_t k = 0; k < 6; k++) {
    ck_assert_int_eq(hr2d_scene_heat(scene, k, &value), k < 4 ? Q : T);
    ck_assert_double_eq(value, k < 4 ? -7 : 300);
    ck_assert_double_eq(hr2d_scene_emissivity(scene, k, 0), k < 4 ? .25 : 1);
    ck_assert_double_eq(hr2d_scene_emission(scene, k, 0), k < 4 ? -7 : hr2d_black_body(300));
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Files. */

#define FILE_OF(hr2d, properties)                                                              \
  "{\"type\":\"FeatureCollection\",\"hr2d\":{" hr2d "},\"features\":[{\"type\":\"Feature\","   \
  "\"properties\":{" properties "},\"geometry\":{\"type\":\"LineString\",\"coordinates\":"     \
  "[[0,0],[1,0],[1,1]]}}]}"

static hr2d_status parse(hr2d_scene *scene, const char *text) {
  return hr2d_scene_parse(scene, text, strlen(text));
}

START_TEST(files_have_thermal_properties) {
  hr2d_scene *scene = test_new_scene(NULL);
  double value;
  ck_assert_int_eq(parse(scene, FILE_OF("", "\"temperature\":900,\"emissivity\":0.25")),
                   HR2D_OK);
  ck_assert_int_eq(parse(scene, FILE_OF("", "\"flux\":-3")), HR2D_OK);
  ck_assert_int_eq(parse(scene, FILE_OF("", "\"emission\":7,\"temperature\":900")), HR2D_OK);
  for (size_t k = 0; k < 2; k++) {
    ck_assert_int_eq(hr2d_scene_heat(scene, k, &value), HR2D_HEAT_TEMPERATURE);
    ck_assert_double_eq(value, 900);
    ck_assert_double_eq(hr2d_scene_emissivity(scene, k, 0), .25);
    ck_assert_double_eq(hr2d_scene_emission(scene, k, 0), .25 * hr2d_black_body(900));
    ck_assert_int_eq(hr2d_scene_heat(scene, 2 + k, &value), HR2D_HEAT_FLUX);
    ck_assert_double_eq(value, -3);
    ck_assert_int_eq(hr2d_scene_heat(scene, 4 + k, &value), HR2D_HEAT_NONE);
    ck_assert_double_eq(hr2d_scene_emission(scene, 4 + k, 0), 7);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(wrong_files_are_refused) {
  static const struct {
    const char *text, *phrase;
    hr2d_status status;
  } wrong[] = {
      {FILE_OF("", "\"temperature\":1,\"flux\":1"), "cannot both be given", HR2D_ESCENE},
      {FILE_OF("", "\"temperature\":1,\"reflectance\":0"), "write \"emissivity\"", HR2D_ESCENE},
      {FILE_OF("", "\"temperature\":\"20 °C\""), "must be a number", HR2D_ESYNTAX},
      {FILE_OF("", "\"flux\":[1]"), "must be a number", HR2D_ESYNTAX},
      {FILE_OF("", "\"temperature\":-5"), "in kelvin", HR2D_ESCENE},
      {FILE_OF("", "\"flux\":1,\"emissivity\":90"), "between 0 and 1", HR2D_ESCENE},
      {FILE_OF("\"wavelengths\":[3,2]", ""), "not above the one before", HR2D_ESCENE},
      {FILE_OF("\"background\":1,\"background_temperature\":300", ""), "cannot both",
       HR2D_ESCENE},
      {FILE_OF("\"background_temperature\":-1", ""), "0 K or more", HR2D_ESCENE},
      {FILE_OF("\"background_temperature\":1e99", ""), "0 K or more", HR2D_ESCENE},
      {FILE_OF("\"wavelengths\":[3]", "\"temperature\":1,\"emissivity\":[1,1,1]"),
       "another number of bands", HR2D_ESCENE},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(parse(scene, wrong[k].text), wrong[k].status);
    test_expect_message(scene, wrong[k].phrase);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A file that cannot be read leaves the wavelengths; one that can sets them, and those of a
   former file may be said again. */
START_TEST(files_have_wavelengths) {
  static const char good[] =
      FILE_OF("\"wavelengths\":[3],\"background_temperature\":300", "\"temperature\":900");
  hr2d_scene *scene = test_new_scene(NULL);
  const double own[] = {1, 2};
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, own, 2), HR2D_OK);
  ck_assert_int_eq(parse(scene, FILE_OF("\"wavelengths\":[3]", "\"temperature\":-1")),
                   HR2D_ESCENE);
  ck_assert_int_eq(add(scene, side[2], T, 900, (const double[]){1, 1, 1}, 3), HR2D_OK);
  ck_assert_int_eq(parse(scene, good), HR2D_ESTATE);
  hr2d_scene_destroy(scene);
  scene = test_new_scene(NULL);
  ck_assert_int_eq(parse(scene, good), HR2D_OK);
  ck_assert_int_eq(parse(scene, FILE_OF("\"wavelengths\":[4]", "\"temperature\":9")),
                   HR2D_ESTATE);
  test_add_black(scene, side[2]);
  test_commit(scene);
  ck_assert_uint_eq(hr2d_scene_bands(scene), 2);
  ck_assert_double_eq(hr2d_scene_background(scene, 0),
                      hr2d_black_body_part(300, 0, 3) * hr2d_black_body(300));
  ck_assert_double_eq(hr2d_scene_background(scene, 1),
                      hr2d_black_body_part(300, 3, INFINITY) * hr2d_black_body(300));
  hr2d_scene_destroy(scene);
  scene = test_new_scene(NULL);
  ck_assert_int_eq(parse(scene, good), HR2D_OK);
  ck_assert_int_eq(parse(scene, FILE_OF("\"wavelengths\":[3]", "\"emission\":1")), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 4);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A heater of power Q in a black room of temperature 500: the wall around it takes all of it.
 */
static hr2d_scene *heated_room(const char *heater) {
  hr2d_scene *scene = test_new_scene(NULL);
  char text[1024];
  snprintf(text, sizeof text,
           "{\"type\":\"FeatureCollection\",\"features\":["
           "{\"type\":\"Feature\",\"properties\":{\"temperature\":500},\"geometry\":"
           "{\"type\":\"LineString\",\"coordinates\":"
           "[[0,0],[4,0],[4,3],[0,3],[0,0]]}},%s]}",
           heater);
  ck_assert_msg(!parse(scene, text), "%s", hr2d_scene_message(scene));
  return scene;
}

#define HEATER(properties, points)                                                             \
  "{\"type\":\"Feature\",\"properties\":{\"heat\":700,\"emissivity\":0.5" properties           \
  "},\"geometry\":{\"type\":\"LineString\",\"coordinates\":" points "}}"

#define BOTH ",\"sides\":\"both\""

/* The heat of all patches from `first` on, and the largest flux among them. */
static double heat_from(hr2d_scene *scene, size_t first, double *flux) {
  hr2d_solution *solution = NULL;
  hr2d_temperatures t = HR2D_TEMPERATURES_INIT;
  double heat[16], sum = 0, other = 0;
  t.heat = heat;
  test_commit(scene);
  ck_assert_uint_le(hr2d_scene_patches(scene), 16);
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_temperatures(solution, NULL, NULL, &t), HR2D_OK);
  *flux = 0;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    double q;
    if (k < first) {
      other += heat[k];
      continue;
    }
    sum += heat[k];
    ck_assert_int_eq(hr2d_scene_heat(scene, k, &q), HR2D_HEAT_FLUX);
    *flux = fmax(*flux, q);
    ck_assert_double_eq_tol(hr2d_solution_net_power(solution, k, 0), heat[k], 1e-10);
    ck_assert_double_eq(hr2d_scene_emission(scene, k, 0), q);
  }
  ck_assert_double_eq_tol(sum + other, 0, 1e-2);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return sum;
}

/* All patches of a feature, and both sides, have the heat together, after moving and cutting,
   too. */
START_TEST(a_heater_gives_its_power) {
  double flux;
  hr2d_scene *scene = heated_room(HEATER("", "[[1,1],[1,2],[2,2],[2,1],[1,1]]"));
  ck_assert_double_eq_tol(heat_from(scene, 4, &flux), 700, 1e-10);
  ck_assert_double_eq_tol(flux, 700. / 4, 1e-12);

  scene = heated_room(HEATER(BOTH, "[[1,1],[3,1]]"));
  ck_assert_double_eq_tol(heat_from(scene, 4, &flux), 700, 1e-10);
  ck_assert_double_eq_tol(flux, 700. / 4, 1e-12);

  /* Its end is moved to a post, and it is cut where it crosses a bar: pieces share the heat. */
  hr2d_snap_report report;
  scene = heated_room(HEATER(BOTH, "[[1,0.01],[1,1]]"));
  ck_assert_int_eq(hr2d_scene_snap(scene, .02, &report), HR2D_OK);
  ck_assert_uint_eq(report.ends + report.feet, 1);
  const size_t walls = hr2d_scene_patches(scene) - 2;
  ck_assert_double_eq_tol(heat_from(scene, walls, &flux), 700, 1e-10);
  ck_assert_double_eq_tol(flux, 350, 1e-12);
  size_t cuts;
  scene = heated_room(HEATER(BOTH, "[[1,1],[3,1]]") "," HEATER(BOTH, "[[2.5,0.5],[2.5,2.5]]"));
  ck_assert_int_eq(hr2d_scene_split_crossings(scene, &cuts), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 12);
  ck_assert_double_eq_tol(heat_from(scene, 4, &flux), 1400, 1e-10);
  ck_assert_double_eq_tol(flux, 175, 1e-12);
}
END_TEST

/* A call has a patch, and its sides. */
START_TEST(powers_are_given_by_calls) {
  hr2d_scene *scene = test_new_scene(NULL);
  double q;
  ck_assert_int_eq(add(scene, side[0], HR2D_HEAT_POWER, NAN, ONE, 1), HR2D_ESCENE);
  test_expect_message(scene, "heat is not finite");
  ck_assert_int_eq(add(scene, side[0], HR2D_HEAT_POWER, 1, &(const double){0}, 1), HR2D_ESCENE);
  const double tiny[4] = {0, 0, 1e-300, 0};
  ck_assert_int_eq(add(scene, tiny, HR2D_HEAT_POWER, 1e10, ONE, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  test_expect_message(scene, "too short for its heat");
  hr2d_scene_destroy(scene);
  scene = test_new_scene(NULL);
  const double at[4] = {0, 0, 4, 0};
  ck_assert_int_eq(add(scene, at, HR2D_HEAT_POWER, -20, ONE, 1), HR2D_OK);
  ck_assert_int_eq(add(scene, side[2], HR2D_HEAT_POWER, 0, ONE, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_heat(scene, 0, &q), HR2D_HEAT_FLUX);
  ck_assert_double_eq(q, -5);
  ck_assert_double_eq(hr2d_scene_reflectance(scene, 0, 0), 1);
  ck_assert_int_eq(hr2d_scene_heat(scene, 1, &q), HR2D_HEAT_FLUX);
  ck_assert_double_eq(q, 0);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("thermal calls") {
  ADD_TESTS("calls", wrong_properties_are_refused, what_was_given_is_returned,
            wrong_wavelengths_are_refused, each_band_is_in_equilibrium,
            fluxes_alone_have_no_solution, who_loses_too_much_is_named,
            where_no_heat_arrives_nothing_is_known, the_call_checks_its_arguments,
            pieces_keep_what_is_given, a_heater_gives_its_power, powers_are_given_by_calls);
  ADD_TESTS("files", files_have_thermal_properties, wrong_files_are_refused,
            files_have_wavelengths);
}
