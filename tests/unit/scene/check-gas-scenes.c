/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gases that are given and read, those that are refused, and the calls that do not go through
   gas: none of them computes without it. */
#include <math.h>
#include <string.h>

#include "support/scene-files.h"
#include "support/support.h"

/* A square room in gas, not committed. */
static hr2d_scene *draw_room(const hr2d_gas *gas) {
  static const hr2d_point corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < 4; k++)
    ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){corner[k], corner[(k + 1) % 4]},
                                    k == 0, 0.5, HR2D_SIDES_FRONT),
                     HR2D_OK);
  if (gas) ck_assert_int_eq(hr2d_scene_add_gas(scene, gas, NULL), HR2D_OK);
  return scene;
}

static hr2d_gas gas_of(const double *kappa, size_t bands) {
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = kappa;
  gas.absorption_bands = bands;
  return gas;
}

START_TEST(the_effect_has_its_reason) {
  const double quarter = 0.25;
  const hr2d_gas gas = gas_of(&quarter, 1), none = HR2D_GAS_INIT;
  const char *reason;
  hr2d_scene *scene = draw_room(&gas);
  ck_assert_uint_eq(hr2d_scene_gases(scene), 1);
  test_commit(scene);
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_MEDIUM, &reason), 1);
  ck_assert_str_eq(reason, "the gas absorbs 0.25 per length");
  ck_assert(hr2d_scene_absorption(scene, 0, 0) == 0.25);
  ck_assert(isnan(hr2d_scene_absorption(scene, 1, 0)));
  ck_assert(isnan(hr2d_scene_absorption(scene, 0, 1)));
  hr2d_scene_destroy(scene);
  const hr2d_gas *const thin[] = {&none, NULL};
  for (size_t k = 0; k < 2; k++) {
    scene = draw_room(thin[k]);
    test_commit(scene);
    ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_MEDIUM, &reason), 0);
    ck_assert_str_eq(reason, "no gas absorbs");
    ck_assert_uint_eq(hr2d_scene_gases(scene), 1 - k);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Gas that emits lights patches that nothing else does. */
START_TEST(hot_gas_is_light) {
  const double one = 1;
  for (int hot = 0; hot < 2; hot++) {
    hr2d_scene *scene = test_new_scene(NULL);
    hr2d_gas gas = gas_of(&one, 1);
    const char *reason;
    gas.emission = &one;
    gas.emission_bands = (size_t)hot;
    const double at[] = {0, 0, 1, 0}, other[] = {1, 1, 0, 1};
    test_add_black(scene, at);
    test_add_black(scene, other);
    ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
    test_commit(scene);
    ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_EMISSION, &reason), hot);
    ck_assert_str_eq(reason, hot ? "the gas emits" : "no patch emits");
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* What is wrong with a gas. */
static void expect_refusal(const hr2d_gas *gas, hr2d_status status, const char *phrase) {
  hr2d_scene *scene = draw_room(NULL);
  ck_assert_int_eq(hr2d_scene_add_gas(scene, gas, NULL), status);
  test_expect_message(scene, phrase);
  ck_assert_uint_eq(hr2d_scene_gases(scene), 0);
  hr2d_scene_destroy(scene);
}

START_TEST(wrong_gases_are_refused) {
  const double good[] = {1, 1, 1}, minus = -1, huge = INFINITY, nothing = NAN;
  hr2d_gas g = gas_of(good, 1);
  g.struct_size = 0;
  expect_refusal(&g, HR2D_EINVAL, "struct_size");
  expect_refusal(NULL, HR2D_EINVAL, "struct_size");
  g = gas_of(NULL, 1);
  expect_refusal(&g, HR2D_EINVAL, "no values");
  const double *const bad[] = {&minus, &huge, &nothing};
  for (size_t k = 0; k < 3; k++) {
    g = gas_of(bad[k], 1);
    expect_refusal(&g, HR2D_ESCENE, "the absorption is");
    g = gas_of(good, 1);
    g.emission = bad[k];
    g.emission_bands = 1;
    expect_refusal(&g, HR2D_ESCENE, "the emission is");
    g = gas_of(good, 1);
    g.given = HR2D_HEAT_TEMPERATURE;
    g.value = *bad[k];
    expect_refusal(&g, HR2D_ESCENE, "temperature is");
  }
  g = gas_of(good, 2);
  g.emission = good;
  g.emission_bands = 3;
  expect_refusal(&g, HR2D_ESCENE, "differ in their bands");
  g = gas_of(good, 1);
  g.section = (hr2d_section)7;
  expect_refusal(&g, HR2D_EINVAL, "section");
  g = gas_of(good, 1);
  g.given = (hr2d_heat)7;
  expect_refusal(&g, HR2D_EINVAL, "hr2d_heat");
  g = gas_of(good, 1);
  g.given = HR2D_HEAT_TEMPERATURE;
  g.value = 300;
  g.emission = good;
  g.emission_bands = 1;
  expect_refusal(&g, HR2D_EINVAL, "emission follows");
  g.emission_bands = 0;
  g.given = HR2D_HEAT_FLUX;
  g.value = NAN;
  expect_refusal(&g, HR2D_ESCENE, "heat is not finite");
}
END_TEST

START_TEST(a_scene_has_one_gas) {
  const double one = 1;
  const hr2d_gas gas = gas_of(&one, 1);
  hr2d_scene *scene = draw_room(&gas);
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_EUNSUPPORTED);
  test_commit(scene);
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_ESTATE);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Scenes that commit refuses with gas, and takes without. */
static void expect_commit(hr2d_scene *scene, hr2d_status status, const char *phrase) {
  ck_assert_int_eq(hr2d_scene_commit(scene), status);
  if (status) test_expect_message(scene, phrase);
  hr2d_scene_destroy(scene);
}

START_TEST(some_scenes_have_no_gas) {
  const double one[] = {1, 1}, two[] = {1, 2}, zero[] = {0, 1};
  const hr2d_gas cold = gas_of(one, 1), uneven = gas_of(two, 2), partly = gas_of(zero, 2),
                 even = gas_of(one, 2);
  for (int has = 0; has < 2; has++) {
    const hr2d_status status = has ? HR2D_EUNSUPPORTED : HR2D_OK;
    const hr2d_gas *gas = has ? &cold : NULL;
    hr2d_scene *scene = draw_room(gas);
    ck_assert_int_eq(hr2d_scene_set_background(scene, one, 1), HR2D_OK);
    expect_commit(scene, status, "light from a background, a sky or a sun does not go");
    scene = draw_room(gas);
    const hr2d_sun sun = {.direction = {0, -1}, .irradiance = 1};
    ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
    expect_commit(scene, status, "does not go through gas");
    scene = test_new_scene(NULL); /* long rows see images without end */
    ck_assert_int_eq(
        test_add_patch(scene, (hr2d_segment){{0, 0}, {1, 0}}, 1, 0.5, HR2D_SIDES_FRONT),
        HR2D_OK);
    ck_assert_int_eq(
        test_add_patch(scene, (hr2d_segment){{1, 1}, {0, 1}}, 1, 0.5, HR2D_SIDES_FRONT),
        HR2D_OK);
    if (gas) ck_assert_int_eq(hr2d_scene_add_gas(scene, gas, NULL), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
    expect_commit(scene, status, "images that are cut off");
  }
  expect_commit(draw_room(&uneven), HR2D_OK, "");
  for (size_t band = 0; band < 2; band++) { /* light from outside where nothing absorbs */
    double light[2] = {0, 0};
    light[band] = 1;
    hr2d_scene *scene = draw_room(&partly);
    ck_assert_int_eq(hr2d_scene_set_background(scene, light, 2), HR2D_OK);
    expect_commit(scene, band ? HR2D_EUNSUPPORTED : HR2D_OK, "does not go through gas");
  }
  expect_commit(draw_room(&even), HR2D_OK, "");
  hr2d_gas heated = even;
  heated.given = HR2D_HEAT_FLUX;
  expect_commit(draw_room(&heated), HR2D_EUNSUPPORTED, "its heat is given in several bands");
  heated.absorption_bands = 1;
  expect_commit(draw_room(&heated), HR2D_OK, "");
  const double vast = 1e308;
  const hr2d_gas thick = gas_of(&vast, 1);
  hr2d_scene *scene = draw_room(&thick);
  ck_assert_int_eq(
      test_add_patch(scene, (hr2d_segment){{9, 9}, {9, 40}}, 0, 0, HR2D_SIDES_FRONT), HR2D_OK);
  expect_commit(scene, HR2D_ESCENE, "beyond a double");
}
END_TEST

/* E_g of a temperature, per band. */
START_TEST(temperatures_follow_the_black_body) {
  const double one = 1, wavelength[] = {2, 5};
  hr2d_gas gas = gas_of(&one, 1);
  gas.given = HR2D_HEAT_TEMPERATURE;
  gas.value = 1500;
  for (size_t bands = 1; bands <= 3; bands += 2) {
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, wavelength, bands - 1), HR2D_OK);
    const double at[] = {0, 0, 1, 0}, other[] = {1, 1, 0, 1};
    test_add_black(scene, at);
    test_add_black(scene, other);
    ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
    test_commit(scene);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *s;
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &s, NULL), HR2D_OK);
    double sum = 0;
    for (size_t b = 0; b < bands; b++) {
      double emission, heat;
      ck_assert_int_eq(hr2d_solution_gas(s, 0, b, &emission, &heat), HR2D_OK);
      const double part = hr2d_black_body_part(1500, b ? wavelength[b - 1] : 0,
                                               b + 1 < bands ? wavelength[b] : INFINITY);
      ck_assert_double_eq_tol(emission / (part * hr2d_black_body(1500)), 1, 1e-15);
      ck_assert_double_gt(heat, 0);
      sum += emission;
    }
    ck_assert_double_eq_tol(sum / hr2d_black_body(1500), 1, 1e-14);
    ck_assert_int_eq(hr2d_solution_gas(s, 1, 0, NULL, NULL), HR2D_EINVAL);
    ck_assert_int_eq(hr2d_solution_gas(s, 0, bands, NULL, NULL), HR2D_EINVAL);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

static hr2d_status no_exchange_row(void *ctx, const hr2d_exchange_row *row) {
  (void)ctx, (void)row;
  return HR2D_OK;
}

static hr2d_status no_field_row(void *ctx, const hr2d_field_row *row) {
  (void)ctx, (void)row;
  return HR2D_OK;
}

static hr2d_status no_near(void *ctx, const hr2d_pair *pair, size_t count) {
  (void)ctx, (void)pair, (void)count;
  return HR2D_OK;
}

static hr2d_status no_bytes(void *ctx, const void *bytes, size_t size) {
  (void)ctx, (void)bytes, (void)size;
  return HR2D_OK;
}

static hr2d_status no_state(void *ctx, void *bytes, size_t size) {
  (void)ctx;
  memset(bytes, 0, size);
  return HR2D_OK;
}

/* Calls on a scene. */
static void expect_scene(const hr2d_scene *scene, hr2d_status status) {
  double area[16];
  hr2d_exchange_rows *rows = NULL;
  hr2d_enclosure *enclosure = NULL;
  hr2d_clusters *clusters = NULL;
  hr2d_operator *op = NULL;
  hr2d_prediction prediction;
  const hr2d_point at = {0.5, 0.5};
  hr2d_target target = HR2D_TARGET_INIT;
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), status);
  ck_assert_int_eq(hr2d_exchange_rows_create(scene, NULL, &rows, NULL), status);
  ck_assert_int_eq(hr2d_exchange_rows_visit(scene, NULL, no_exchange_row, NULL, NULL), status);
  ck_assert_int_eq(hr2d_field_rows_visit(scene, &at, NULL, 1, NULL, no_field_row, NULL),
                   status);
  ck_assert_int_eq(hr2d_clusters_create(scene, NULL, no_near, NULL, &clusters), status);
  ck_assert_int_eq(hr2d_predict(scene, &target, &prediction), status);
  ck_assert_int_eq(hr2d_operator_create(scene, NULL, &op, NULL), status);
  ck_assert_int_eq(hr2d_state_write_scene(scene, no_bytes, NULL), status);
  hr2d_enclose_options how = HR2D_ENCLOSE_OPTIONS_INIT;
  how.gap = 0.1;
  ck_assert_int_eq(hr2d_enclose(scene, &how, &enclosure, NULL), status);
  hr2d_exchange_rows_destroy(rows);
  hr2d_clusters_destroy(clusters);
  hr2d_operator_destroy(op);
  hr2d_enclosure_destroy(enclosure);
}

static void expect_oracles(hr2d_scene *scene, int has_gas) {
  static const char *const name[] = {"size", "size2", "bf", "l1", "l1-grid", "bounds"};
  const hr2d_refine_options options = test_epsilon(0.5);
  for (size_t k = 0; k < 6; k++) {
    hr2d_hierarchy *h;
    hr2d_linkset *links;
    ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
    ck_assert_int_eq(
        hr2d_linkset_create(h, hr2d_oracle_find(name[k]), NULL, NULL, NULL, &links), HR2D_OK);
    const hr2d_status status = has_gas && k > 2 ? HR2D_EUNSUPPORTED : HR2D_OK;
    ck_assert_int_eq(hr2d_refine(links, &options), status);
    if (status) ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(links), "through gas"));
    hr2d_linkset_destroy(links);
    hr2d_hierarchy_destroy(h);
  }
}

static void expect_state(const hr2d_scene *scene, hr2d_status status) {
  hr2d_hierarchy *h;
  hr2d_linkset *links;
  hr2d_solution *s;
  double front[4];
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(h, NULL, NULL, NULL, NULL, &links), HR2D_OK);
  ck_assert_int_eq(hr2d_state_read(links, no_state, NULL, &s), status ? status : HR2D_ESYNTAX);
  ck_assert_int_eq(hr2d_leaf_sums(h, 0, 4, front, NULL), status);
  const hr2d_refine_options options = test_epsilon(1);
  ck_assert_int_eq(hr2d_refine(links, &options), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(links, NULL, &s), HR2D_OK);
  ck_assert_int_eq(hr2d_state_write(s, no_bytes, NULL), status);
  hr2d_solution_destroy(s);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(h);
}

/* Each of these computes with what gas changes, and does not know gas: it says so, and does
   what it does in a scene without. */
START_TEST(nothing_is_computed_without_the_gas) {
  const double one = 1;
  const hr2d_gas gas = gas_of(&one, 1);
  for (int has = 0; has < 2; has++) {
    const hr2d_status status = has ? HR2D_EUNSUPPORTED : HR2D_OK;
    hr2d_scene *scene = draw_room(has ? &gas : NULL);
    test_commit(scene);
    expect_scene(scene, status);
    expect_oracles(scene, has);
    expect_state(scene, status);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

#define ROOM(medium)                                                                           \
  "{\"type\":\"FeatureCollection\",\"hr2d\":{\"medium\":" medium "},\"features\":[{\"type\":"  \
  "\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[0,0],"  \
  "[1,0],[1,1],[0,0]]]}}]}"

START_TEST(files_have_gas) {
  static const struct {
    const char *text;
    double absorption;
  } file[] = {{ROOM("0"), 0},
              {ROOM("0.5"), 0.5},
              {ROOM("{\"absorption\":2,\"temperature\":1500}"), 2},
              {ROOM("{\"absorption\":[3,3],\"emission\":[1,2],\"section\":\"flat\"}"), 3},
              {ROOM("{\"absorption\":1,\"section\":\"long\",\"emission\":4}"), 1},
              {ROOM("{\"absorption\":6,\"flux\":-0.5}"), 6}};
  for (size_t k = 0; k < sizeof file / sizeof *file; k++) {
    hr2d_scene *scene = file_parsed(file[k].text);
    test_commit(scene);
    ck_assert_uint_eq(hr2d_scene_gases(scene), 1);
    ck_assert_uint_eq(hr2d_scene_bands(scene), k == 3 ? 2 : 1);
    ck_assert(hr2d_scene_absorption(scene, 0, 0) == file[k].absorption);
    hr2d_scene_destroy(scene);
  }
  /* the last file that has one counts */
  hr2d_scene *scene = file_parsed(file[1].text);
  ck_assert_int_eq(file_parse(scene, ROOM("null")), HR2D_OK);
  ck_assert(hr2d_scene_absorption(scene, 0, 0) == 0.5);
  ck_assert_int_eq(file_parse(scene, ROOM("7")), HR2D_OK);
  ck_assert(hr2d_scene_absorption(scene, 0, 0) == 7);
  hr2d_scene_destroy(scene);
}
END_TEST

#define WEIGHTS(weights, more)                                                                 \
  "{\"type\":\"FeatureCollection\",\"hr2d\":{\"weights\":" weights more "},\"features\":[{"    \
  "\"type\":\"Feature\",\"properties\":{\"temperature\":1000},\"geometry\":{\"type\":"         \
  "\"Polygon\",\"coordinates\":[[[0,0],[1,0],[1,1],[0,0]]]}}]}"

START_TEST(files_have_weights) {
  hr2d_scene *scene = file_parsed(WEIGHTS(
      "[[0.5,-1e-4],[0,2e-4]]", ",\"medium\":{\"absorption\":[0,1,2],\"temperature\":900}"));
  test_commit(scene);
  const double black = hr2d_black_body(1000), part[] = {0.4, 0.4, 0.2};
  for (size_t b = 0; b < 3; b++)
    ck_assert_double_eq_tol(hr2d_scene_emission(scene, 0, b), part[b] * black, 1e-12 * black);
  hr2d_scene_destroy(scene);
  /* The same may be said again, and others if no temperature hangs on them. */
  scene = file_parsed(WEIGHTS("[[0.5,-1e-4],[0,2e-4]]", ""));
  ck_assert_int_eq(file_parse(scene, WEIGHTS("[[0.5,-1e-4],[0,2e-4]]", "")), HR2D_OK);
  ck_assert_int_eq(file_parse(scene, WEIGHTS("[[0.5,-1e-4],[0.1,1e-4]]", "")), HR2D_ESTATE);
  ck_assert_int_eq(file_parse(scene, WEIGHTS("[[0.5,-1e-4],[0,2e-4]]", "")), HR2D_OK);
  hr2d_scene_destroy(scene);
  static const struct {
    const char *text;
    hr2d_status status;
    const char *phrase;
  } bad[] = {
      {WEIGHTS("0.5", ""), HR2D_ESYNTAX, "must be an array of polynomials in T"},
      {WEIGHTS("[]", ""), HR2D_ESYNTAX, "must be an array of polynomials in T"},
      {WEIGHTS("[0.5]", ""), HR2D_ESYNTAX, "must be an array of polynomials in T"},
      {WEIGHTS("[[0.5],[0.1,0.2]]", ""), HR2D_ESYNTAX, "number 2 must be an array of numbers"},
      {WEIGHTS("[[0.5],[\"x\"]]", ""), HR2D_ESYNTAX, "number 2 has a string"},
      {WEIGHTS("[[2]]", ""), HR2D_ESCENE, "at 1000 K the weight of band 0 is -1"},
      {WEIGHTS("[[0.5]]", ",\"wavelengths\":[3]"), HR2D_ESCENE, "cannot both be given"},
      {WEIGHTS("[[0,1e-3]]", ",\"background_temperature\":1100"), HR2D_ESCENE,
       "background_temperature: at 1100 K the weight of band 0"}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    scene = test_new_scene(NULL);
    ck_assert_int_eq(file_parse(scene, bad[k].text), bad[k].status);
    test_expect_message(scene, bad[k].phrase);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("gas scenes") {
  ADD_TESTS("scene", the_effect_has_its_reason, hot_gas_is_light, wrong_gases_are_refused,
            a_scene_has_one_gas, some_scenes_have_no_gas, temperatures_follow_the_black_body,
            files_have_gas, files_have_weights);
  ADD_TESTS("refusals", nothing_is_computed_without_the_gas);
}
