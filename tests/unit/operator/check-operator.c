/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other light on a kept operator: against fresh solves of scenes that have it, against tables
   and closed rooms in equilibrium, by superposition and reciprocity. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/radiosity-scenes.h"
#include "support/relit-rooms.h"
#include "support/support.h"

/* An account is of the error against the scene itself with that light, to more digits. */
START_TEST(other_light_is_that_of_a_scene_with_it) {
  const relit_kind kind = (relit_kind)_i;
  const int walls = relit_walls(kind);
  randoms r = randoms_stream(test_seed(), 10 + _i);
  relit_paint first, other;
  for (size_t round = 0; round < test_rounds(20, 2); round++) {
    const size_t bands = 1 + round % 2;
    const double error = random_power(&r, -8, -2);
    relit_draw(&first, &r);
    relit_draw(&other, &r);
    hr2d_scene *scene = relit_scene(kind, &first, bands),
               *fresh = relit_scene(kind, &other, bands);
    hr2d_operator *op = relit_operator(scene, error);
    const hr2d_light light = relit_light(kind, &other);
    hr2d_account account, exact;
    hr2d_solution *solution = relit_solve(op, &light, &account), *is = NULL;
    hr2d_target finer = HR2D_TARGET_INIT;
    finer.error = fmax(1e-2 * error, 1e-11);
    hr2d_solve_to(fresh, &finer, &is, &exact);
    ck_assert_ptr_nonnull(is);
    const double off = relit_distance(solution, is, walls, bands),
                 of_it = fmax(exact.average.bound, exact.irradiance.bound);
    ck_assert_double_le(off, fmax(account.average.bound, account.irradiance.bound) + of_it);
    /* A negative control: the light of the scene itself is another one. */
    hr2d_solution *own = relit_solve(op, NULL, NULL);
    ck_assert_double_gt(relit_distance(own, is, walls, bands), 1e-2);
    hr2d_solution_destroy(own);
    hr2d_solution_destroy(is);
    hr2d_solution_destroy(solution);
    hr2d_operator_destroy(op);
    hr2d_scene_destroy(fresh);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Nothing of a solve is left for the next one: not of its light, nor of its number of lights.
 */
START_TEST(the_same_light_has_the_same_bits) {
  const relit_kind kind = (relit_kind)_i;
  randoms r = randoms_stream(test_seed(), 20 + _i);
  relit_paint first, other;
  relit_draw(&first, &r);
  relit_draw(&other, &r);
  hr2d_scene *scene = relit_scene(kind, &first, 1);
  hr2d_operator *op = relit_operator(scene, 1e-4);
  const hr2d_light light = relit_light(kind, &other);
  hr2d_light twice = light;
  twice.emission.stride[1] = twice.reflectance.stride[1] = 1;
  twice.background.stride[2] = 1;
  twice.count = 2;
  hr2d_account a[2];
  hr2d_solution *s[2], *between;
  for (int k = 0; k < 2; k++) {
    s[k] = relit_solve(op, &light, &a[k]);
    between = relit_solve(op, k ? NULL : &twice, NULL);
    hr2d_solution_destroy(between);
    between = relit_solve(op, NULL, NULL);
    hr2d_solution_destroy(between);
  }
  const size_t size = hr2d_solution_field_size(s[0]);
  ck_assert_uint_eq(hr2d_solution_field_size(s[1]), size);
  ck_assert_mem_eq(hr2d_solution_field(s[0]), hr2d_solution_field(s[1]), size * sizeof(double));
  ck_assert_mem_eq(&a[0].average, &a[1].average, sizeof a[0].average);
  ck_assert_mem_eq(&a[0].irradiance, &a[1].irradiance, sizeof a[0].irradiance);
  for (int k = 0; k < 2; k++) hr2d_solution_destroy(s[k]);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

/* In a closed room with E = 1 − ρ everywhere B = H = 1, whatever ρ is. */
START_TEST(equilibrium) {
  randoms r = randoms_stream(test_seed(), 30);
  relit_paint first, other;
  for (size_t round = 0; round < test_rounds(100, 10); round++) {
    relit_draw(&first, &r);
    relit_draw(&other, &r);
    for (int k = 0; k < RELIT_WALLS; k++) other.emission[k] = 1 - other.reflectance[k];
    hr2d_scene *scene = relit_scene(RELIT_CLOSED, &first, 1);
    hr2d_operator *op = relit_operator(scene, 1e-3);
    const hr2d_light light = relit_light(RELIT_CLOSED, &other);
    hr2d_account account;
    hr2d_solution *solution = relit_solve(op, &light, &account);
    for (size_t k = 0; k < RELIT_WALLS; k++) {
      ck_assert_double_eq_tol(hr2d_solution_average(solution, k, 0), 1, 1e-12);
      ck_assert_double_eq_tol(hr2d_solution_irradiance(solution, k, 0), 1, 1e-12);
    }
    hr2d_solution_destroy(solution);
    hr2d_operator_destroy(op);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* B is linear in emissions and light from outside, and several lights at once are each of them
   alone. */
START_TEST(superposition_of_lights_at_once) {
  const relit_kind kind = (relit_kind)_i;
  const int walls = relit_walls(kind);
  randoms r = randoms_stream(test_seed(), 40 + _i);
  enum { LIGHTS = 5 };
  double emission[LIGHTS * RELIT_WALLS], background[LIGHTS], sun[LIGHTS];
  relit_paint first;
  relit_draw(&first, &r);
  for (int k = 0; k < LIGHTS * walls; k++) emission[k] = random_unit(&r);
  for (int m = 0; m < LIGHTS; m++) background[m] = random_unit(&r), sun[m] = random_unit(&r);
  for (int k = 0; k < walls; k++)
    emission[4 * walls + k] = emission[k] + 2 * emission[walls + k];
  background[4] = background[0] + 2 * background[1];
  sun[4] = sun[0] + 2 * sun[1];
  hr2d_scene *scene = relit_scene(kind, &first, 1);
  hr2d_operator *op = relit_operator(scene, 1e-11);
  hr2d_light light = HR2D_LIGHT_INIT;
  light.emission.value = emission;
  if (relit_has_sky(kind)) light.background.value = background;
  if (kind == RELIT_SUNNY) light.sun.value = sun;
  light.count = LIGHTS;
  light.no_error = 1;
  hr2d_solution *all = relit_solve(op, &light, NULL);
  for (size_t k = 0; k < (size_t)walls; k++) {
    const double b[] = {hr2d_solution_average(all, k, 0), hr2d_solution_average(all, k, 1),
                        hr2d_solution_average(all, k, 4)};
    ck_assert_double_eq_tol(b[0] + 2 * b[1], b[2], 1e-11 * b[2]);
  }
  for (size_t m = 0; m < LIGHTS; m++) {
    hr2d_light one = light;
    one.count = 1;
    one.emission.value = emission + m * (size_t)walls;
    if (one.background.value) one.background.value = background + m;
    if (one.sun.value) one.sun.value = sun + m;
    hr2d_solution *alone = relit_solve(op, &one, NULL);
    for (size_t k = 0; k < (size_t)walls; k++) {
      const double is = hr2d_solution_average(alone, k, 0);
      ck_assert_double_eq_tol(hr2d_solution_average(all, k, m), is, 1e-11 * is);
    }
    hr2d_solution_destroy(alone);
  }
  hr2d_solution_destroy(all);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A_i ρ_j ∂B_i/∂E_j is symmetric beside the diagonal, and its columns are solves. */
START_TEST(responses) {
  const relit_kind kind = (relit_kind)_i;
  const size_t walls = (size_t)relit_walls(kind);
  randoms r = randoms_stream(test_seed(), 50 + _i);
  relit_paint first, other;
  relit_draw(&first, &r);
  relit_draw(&other, &r);
  hr2d_scene *scene = relit_scene(kind, &first, 1);
  hr2d_operator *op = relit_operator(scene, 1e-11);
  double response[RELIT_WALLS * RELIT_WALLS], column[RELIT_WALLS], unit[RELIT_WALLS] = {0},
                                                                   dark = 0;
  hr2d_light light = HR2D_LIGHT_INIT;
  light.reflectance.value = other.reflectance;
  ck_assert_int_eq(hr2d_operator_response(op, &light, 0, walls, response), HR2D_OK);
  ck_assert_int_eq(hr2d_operator_response(op, &light, 1, 1, column), HR2D_OK);
  for (size_t i = 0; i < walls; i++) {
    ck_assert_double_eq(column[i], response[i * walls + 1]);
    for (size_t j = 0; j < i; j++) {
      const double ij = hr2d_scene_length(scene, i) * response[i * walls + j] *
                        other.reflectance[j],
                   ji = hr2d_scene_length(scene, j) * response[j * walls + i] *
                        other.reflectance[i];
      ck_assert_double_eq_tol(ij, ji, 1e-11 * fmax(ij, ji) + 1e-15);
    }
  }
  unit[1] = 1;
  light.emission.value = unit;
  if (relit_has_sky(kind)) light.background.value = &dark;
  if (kind == RELIT_SUNNY) light.sun.value = &dark;
  hr2d_solution *solution = relit_solve(op, &light, NULL);
  for (size_t i = 0; i < walls; i++)
    ck_assert_double_eq_tol(hr2d_solution_average(solution, i, 0), column[i],
                            1e-11 * column[i] + 1e-15);
  hr2d_solution_destroy(solution);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Temperatures of a wall, with a lamp and a heated wall in one band: those of a scene with
 * them. */
START_TEST(temperatures_and_fluxes) {
  const double kelvin[2] = {400, 700}, flux[2] = {50, -20};
  hr2d_scene *scene[2];
  hr2d_solution *is = NULL, *solution;
  for (int k = 0; k < 2; k++) {
    scene[k] = test_new_scene(NULL);
    for (int m = 0; m < 4; m++) {
      hr2d_patch patch =
          test_patch(relit_wall[m][0], relit_wall[m][1], relit_wall[m][2], relit_wall[m][3]);
      const double half = 0.5, emissivity = 0.8;
      hr2d_thermal t = HR2D_THERMAL_INIT;
      t.given = m == 0 ? HR2D_HEAT_TEMPERATURE : HR2D_HEAT_FLUX;
      t.value = m == 0 ? kelvin[k] : flux[k];
      t.emissivity = &emissivity;
      t.emissivity_bands = 1;
      if (m > 1) patch.reflectance = patch.emission = &half;
      if (m > 1) patch.reflectance_bands = patch.emission_bands = 1;
      ck_assert_int_eq(m > 1 ? hr2d_scene_add(scene[k], &patch, NULL)
                             : hr2d_scene_add_thermal(scene[k], &patch, &t, NULL),
                       HR2D_OK);
    }
    test_commit(scene[k]);
  }
  hr2d_operator *op = relit_operator(scene[0], 1e-10);
  hr2d_light light = HR2D_LIGHT_INIT;
  const double kelvins[] = {kelvin[1], NAN, NAN, NAN}, fluxes[] = {NAN, flux[1], NAN, NAN};
  light.temperature.value = kelvins;
  light.flux.value = fluxes;
  solution = relit_solve(op, &light, NULL);
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-10;
  ck_assert_int_eq(hr2d_solve_to(scene[1], &target, &is, NULL), HR2D_OK);
  ck_assert_double_le(relit_distance(solution, is, 4, 1), 1e-9);
  double found[2][4];
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  for (int k = 0; k < 2; k++) {
    to.kelvin = found[k];
    ck_assert_int_eq(hr2d_solution_temperatures(k ? is : solution, NULL, NULL, &to), HR2D_OK);
  }
  for (size_t k = 0; k < 2; k++) ck_assert_double_eq_tol(found[0][k], found[1][k], 1e-6);
  ck_assert_double_eq(found[0][0], kelvin[1]);
  hr2d_solution_destroy(solution);
  hr2d_solution_destroy(is);
  hr2d_operator_destroy(op);
  for (int k = 0; k < 2; k++) hr2d_scene_destroy(scene[k]);
}
END_TEST

/* Values of an independent Nyström method with two meshes, for light that the operator was not
   made for. */
START_TEST(known_radiosities) {
  radiosity_scenes table;
  double worst = 0;
  ck_assert_int_eq(radiosity_scenes_read(test_data_path("radiosity_fine.csv"), &table), 0);
  for (size_t k = 0; k < table.count; k++) {
    const radiosity_scene *is = &table.scene[k];
    radiosity_scene other = *is;
    double emission[RADIOSITY_MOST_PATCHES], reflectance[RADIOSITY_MOST_PATCHES];
    for (size_t m = 0; m < is->patches; m++) {
      emission[m] = is->patch[m][4];
      reflectance[m] = is->patch[m][5];
      other.patch[m][4] = 1 + (double)m;
      other.patch[m][5] = 0.9 - 0.1 * (double)m;
    }
    hr2d_scene *scene = radiosity_scene_make(&other, NULL);
    hr2d_operator *op = relit_operator(scene, 1e-12);
    hr2d_light light = HR2D_LIGHT_INIT;
    light.emission.value = emission;
    light.reflectance.value = reflectance;
    hr2d_account account;
    hr2d_solution *solution = relit_solve(op, &light, &account);
    const double error = radiosity_average_error(is, solution);
    ck_assert_msg(error <= account.average.bound + 2e-14, "%s: %g, at most %g", is->name, error,
                  account.average.bound);
    worst = fmax(worst, error);
    hr2d_solution_destroy(solution);
    hr2d_operator_destroy(op);
    hr2d_scene_destroy(scene);
  }
  printf("largest error of %zu scenes %.1e\n", table.count, worst);
  ck_assert_uint_ge(table.count, 6);
  ck_assert_double_le(worst, 1e-11);
}
END_TEST

/* Two rooms to nine digits.  Elements at the events that matter for the light of the scene
   alone do not suffice for all other light; those at all events are many more. */
START_TEST(elements_suffice_for_light_of_one_patch) {
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_account own, account;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_read(scene, test_scene_path("partition.geojson")), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-9;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &own), HR2D_OK);
  hr2d_solution_destroy(solution);
  hr2d_operator *op = relit_operator(scene, 1e-9);
  enum { LIGHTS = 4 };
  const size_t patches = hr2d_scene_patches(scene);
  double *emission = calloc(LIGHTS * patches, sizeof *emission);
  for (size_t k = 0; k < patches; k += LIGHTS) {
    hr2d_light light = HR2D_LIGHT_INIT;
    memset(emission, 0, LIGHTS * patches * sizeof *emission);
    for (size_t m = 0; m < LIGHTS; m++) emission[m * patches + (k + m) % patches] = 1;
    light.emission.value = emission;
    light.count = LIGHTS;
    ck_assert_int_eq(hr2d_operator_solve(op, &light, NULL, &solution, &account), HR2D_OK);
    ck_assert_double_le(account.average.estimate, 1e-9);
    hr2d_solution_destroy(solution);
  }
  ck_assert_uint_le(account.links, 2 * own.links);
  free(emission);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("operator") {
  REPEAT_TESTS(RELIT_KINDS, "light", other_light_is_that_of_a_scene_with_it,
               the_same_light_has_the_same_bits, superposition_of_lights_at_once, responses);
  ADD_TESTS("laws", equilibrium, temperatures_and_fluxes, known_radiosities);
  ADD_TESTS("elements", elements_suffice_for_light_of_one_patch);
}
