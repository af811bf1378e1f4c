/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temperatures and heat beside closed forms: equilibrium, insulated walls, enclosures of two
   surfaces, crossed strings, symmetry, superposition; and the errors that are claimed. */
#include <math.h>
#include <string.h>

#include "support/support.h"

#define SIGMA HR2D_STEFAN_BOLTZMANN

enum { MOST = 16 };

/* ax ay bx by, what is given, its value, ε */
typedef struct wall {
  double at[4];
  hr2d_heat given;
  double value, emissivity;
} wall;

#define T HR2D_HEAT_TEMPERATURE
#define Q HR2D_HEAT_FLUX

static hr2d_scene *make(const wall *w, size_t count) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < count; k++) {
    const hr2d_patch patch = test_patch(w[k].at[0], w[k].at[1], w[k].at[2], w[k].at[3]);
    hr2d_thermal t = HR2D_THERMAL_INIT;
    t.given = w[k].given;
    t.value = w[k].value;
    t.emissivity = &w[k].emissivity;
    t.emissivity_bands = 1;
    ck_assert_msg(!hr2d_scene_add_thermal(scene, &patch, &t, NULL), "%s",
                  hr2d_scene_message(scene));
  }
  test_commit(scene);
  return scene;
}

/* What a solve for a target finds. */
typedef struct found {
  hr2d_scene *scene;
  hr2d_solution *solution;
  hr2d_account account;
  double kelvin[MOST], estimate[MOST], bound[MOST];
  double heat[MOST], heat_estimate[MOST], heat_bound[MOST];
  unsigned char state[MOST];
} found;

static hr2d_temperatures arrays(found *f) {
  return (hr2d_temperatures){
      sizeof(hr2d_temperatures), f->kelvin,     f->estimate, f->bound, f->heat,
      f->heat_estimate,          f->heat_bound, f->state};
}

static found find(const wall *w, size_t count, double target) {
  found f = {.scene = make(w, count)};
  hr2d_target how = HR2D_TARGET_INIT;
  how.error = target;
  const hr2d_status status = hr2d_solve_to(f.scene, &how, &f.solution, &f.account);
  ck_assert_msg(!status || status == HR2D_EACCURACY, "%s", f.account.reason);
  ck_assert_ptr_nonnull(f.solution);
  const hr2d_temperatures to = arrays(&f);
  ck_assert_int_eq(hr2d_solution_temperatures(f.solution, &how, &f.account, &to), HR2D_OK);
  return f;
}

static void end(found *f) {
  hr2d_solution_destroy(f->solution);
  hr2d_scene_destroy(f->scene);
}

static double fourth(double kelvin) {
  return pow(kelvin, 4);
}

static void close_to(double value, double expected, double relative) {
  ck_assert_msg(fabs(value - expected) <= relative * fabs(expected), "%.17g is not %.17g",
                value, expected);
}

/* Of a room of one temperature insulated walls have this temperature, whatever the
   emissivities, and no heat flows. */
START_TEST(one_source_heats_all_insulated_walls) {
  const wall room[] = {{{0, 0, 3, 0}, T, 1234, .1},
                       {{3, 0, 4, 2}, Q, 0, .5},
                       {{4, 2, 2, 1.5}, Q, 0, 1},
                       {{2, 1.5, 0, 3}, Q, 0, 1e-3},
                       {{0, 3, 0, 0}, Q, 0, .7}};
  found f = find(room, 5, 1e-9);
  double t[3] = {0, .3, 1}, kelvin[3];
  for (size_t k = 0; k < 5; k++) {
    ck_assert_int_eq(f.state[k], k ? HR2D_TEMPERATURE_FOUND : HR2D_TEMPERATURE_GIVEN);
    close_to(f.kelvin[k], 1234, 1e-13);
    ck_assert_double_le(fabs(f.heat[k]), 1e-9);
    ck_assert_int_eq(hr2d_solution_gather_temperature(f.solution, k, t, 3, kelvin), HR2D_OK);
    for (int q = 0; q < 3; q++) close_to(kelvin[q], 1234, 1e-12);
  }
  end(&f);
}
END_TEST

/* Kirchhoff's law holds for doubles: also with an ε that 1 − ε rounds away nearly. */
START_TEST(a_room_of_one_temperature_is_in_equilibrium) {
  const wall room[] = {{{0, 0, 1, 0}, T, 300, 1e-12},
                       {{1, 0, .2, .9}, T, 300, 1e-3},
                       {{.2, .9, 0, 0}, T, 300, 1. / 3}};
  found f = find(room, 3, 1e-9);
  for (size_t k = 0; k < 3; k++)
    close_to(hr2d_solution_irradiance(f.solution, k, 0), SIGMA * fourth(300), 1e-12);
  end(&f);
}
END_TEST

/* A black outer square of T₂ sends σT₂⁴ to all of an inner one, convex, of ε₁: the enclosure of
   two surfaces with ε₂ = 1 has no error of uniform radiosity.  q₁ = ε₁σ(T₁⁴ − T₂⁴). */
START_TEST(two_surfaces_exchange_as_the_formula_says) {
  wall w[8] = {{{0, 0, 3, 0}, T, 400, 1},  {{3, 0, 3, 3}, T, 400, 1},
               {{3, 3, 0, 3}, T, 400, 1},  {{0, 3, 0, 0}, T, 400, 1},
               {{1, 1, 1, 2}, T, 900, .3}, {{1, 2, 2, 2}, T, 900, .3},
               {{2, 2, 2, 1}, T, 900, .3}, {{2, 1, 1, 1}, T, 900, .3}};
  const double q = .3 * SIGMA * (fourth(900) - fourth(400));
  found f = find(w, 8, 1e-9);
  double given = 0, taken = 0;
  for (size_t k = 4; k < 8; k++) close_to(f.heat[k], q, 1e-9);
  for (size_t k = 0; k < 8; k++) *(k < 4 ? &taken : &given) += f.heat[k];
  close_to(taken, -given, 1e-12);
  end(&f);
  /* The other way round: the flux is given, and T₁ = (T₂⁴ + q/(ε₁σ))^¼. */
  for (size_t k = 4; k < 8; k++) w[k] = (wall){{0}, Q, q, .3};
  const wall copy[4] = {{{1, 1, 1, 2}, Q, q, .3},
                        {{1, 2, 2, 2}, Q, q, .3},
                        {{2, 2, 2, 1}, Q, q, .3},
                        {{2, 1, 1, 1}, Q, q, .3}};
  memcpy(w + 4, copy, sizeof copy);
  f = find(w, 8, 1e-9);
  for (size_t k = 4; k < 8; k++) {
    close_to(f.kelvin[k], 900, 1e-9);
    close_to(f.heat[k], q, 1e-15);
  }
  end(&f);
}
END_TEST

/* Three black surfaces: Q_i = Σ AF_ij σ(T_i⁴ − T_j⁴), with AF_ij = (A_i + A_j − A_k)/2 by
   crossed strings. */
START_TEST(a_triangle_exchanges_by_crossed_strings) {
  const wall w[] = {
      {{0, 0, 3, 0}, T, 500, 1}, {{3, 0, 0, 4}, T, 800, 1}, {{0, 4, 0, 0}, T, 1100, 1}};
  const double a[] = {3, 5, 4};
  found f = find(w, 3, 1e-9);
  for (int i = 0; i < 3; i++) {
    double heat = 0;
    for (int j = 0; j < 3; j++)
      if (j != i)
        heat += (a[i] + a[j] - a[3 - i - j]) / 2 * SIGMA *
                (fourth(w[i].value) - fourth(w[j].value));
    close_to(f.heat[i], heat, 1e-12);
    ck_assert_double_le(fabs(f.heat[i] - heat), f.heat_bound[i]);
  }
  end(&f);
}
END_TEST

/* Between two black plates insulated side walls have in their middle, and on average, the mean
   of T⁴: turning the room by 180° exchanges the plates.  So has a shield there. */
START_TEST(between_two_plates_is_the_mean_of_the_fourth_powers) {
  const double middle = pow((fourth(400) + fourth(1000)) / 2, .25);
  const wall w[] = {{{0, 0, 0, -1}, T, 400, 1},
                    {{0, -1, 2, -1}, Q, 0, .4},
                    {{2, -1, 2, 0}, T, 1000, 1},
                    {{2, 0, 0, 0}, Q, 0, .9}};
  found f = find(w, 4, 1e-10);
  const double half = .5;
  double kelvin;
  for (size_t k = 1; k < 4; k += 2) {
    close_to(f.kelvin[k], middle, 1e-9);
    ck_assert_int_eq(hr2d_solution_gather_temperature(f.solution, k, &half, 1, &kelvin),
                     HR2D_OK);
    close_to(kelvin, middle, 1e-9);
  }
  end(&f);
  /* A shield of that temperature: its sides give and take the same heat, to no sum. */
  const wall s[] = {{{0, 0, 0, -1}, T, 400, .6},    {{0, -1, 1, -1}, Q, 0, 1},
                    {{1, -1, 2, -1}, Q, 0, 1},      {{2, -1, 2, 0}, T, 1000, .6},
                    {{2, 0, 1, 0}, Q, 0, 1},        {{1, 0, 0, 0}, Q, 0, 1},
                    {{1, -1, 1, 0}, T, middle, .2}, {{1, 0, 1, -1}, T, middle, .2}};
  f = find(s, 8, 1e-10);
  close_to(f.heat[6], -f.heat[7], 1e-9);
  close_to(f.heat[0], -f.heat[3], 1e-9);
  ck_assert_double_gt(f.heat[6], 0);
  end(&f);
}
END_TEST

/* B is linear in the fluxes, so that a negative flux follows from a positive one. */
START_TEST(a_negative_flux_follows_by_superposition) {
  double b[3][4];
  for (int sign = -1; sign <= 1; sign++) {
    const wall w[] = {{{0, 0, 2, 0}, T, 900, .8},
                      {{2, 0, 2, 1}, Q, 0, .4},
                      {{2, 1, 0, 1.5}, Q, sign * 9000., .5},
                      {{0, 1.5, 0, 0}, Q, 0, .9}};
    found f = find(w, 4, 1e-11);
    for (size_t k = 0; k < 4; k++) b[sign + 1][k] = hr2d_solution_average(f.solution, k, 0);
    close_to(f.heat[2], sign * 9000 * hr2d_scene_length(f.scene, 2), 1e-15);
    if (sign) close_to(f.heat[0], -f.heat[2], 1e-11);
    end(&f);
  }
  for (size_t k = 0; k < 4; k++) close_to(b[0][k], 2 * b[1][k] - b[2][k], 1e-10);
}
END_TEST

/* The answer is that of E and ρ, bit for bit. */
START_TEST(emission_and_reflectance_say_the_same) {
  const wall w[] = {{{0, 0, 2, 0}, T, 900, .8},
                    {{2, 0, 2, 1}, Q, 700, .4},
                    {{2, 1, 0, 1.5}, T, 600, .3},
                    {{0, 1.5, 0, 0}, Q, 0, .9}};
  found f = find(w, 4, 1e-7);
  hr2d_scene *plain = test_new_scene(NULL);
  for (size_t k = 0; k < 4; k++) {
    const double rho = w[k].given == Q ? 1 : 1 - w[k].emissivity;
    const double e = w[k].given == Q ? w[k].value : (1 - rho) * hr2d_black_body(w[k].value);
    const hr2d_segment at = {{w[k].at[0], w[k].at[1]}, {w[k].at[2], w[k].at[3]}};
    ck_assert_int_eq(test_add_patch(plain, at, e, rho, HR2D_SIDES_FRONT), HR2D_OK);
    ck_assert_double_eq(hr2d_scene_emission(f.scene, k, 0), e);
    ck_assert_double_eq(hr2d_scene_reflectance(f.scene, k, 0), rho);
  }
  test_commit(plain);
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  hr2d_account account;
  how.error = 1e-7;
  ck_assert_int_eq(hr2d_solve_to(plain, &how, &solution, &account), HR2D_OK);
  ck_assert_uint_eq(account.links, f.account.links);
  ck_assert_double_eq(account.irradiance.bound, f.account.irradiance.bound);
  for (size_t k = 0; k < 4; k++) {
    ck_assert_double_eq(hr2d_solution_average(solution, k, 0),
                        hr2d_solution_average(f.solution, k, 0));
    ck_assert_double_eq(hr2d_solution_irradiance(solution, k, 0),
                        hr2d_solution_irradiance(f.solution, k, 0));
  }
  /* The plain scene knows no temperature, but the heat. */
  found g = {.solution = solution};
  const hr2d_temperatures to = arrays(&g);
  ck_assert_int_eq(hr2d_solution_temperatures(solution, NULL, NULL, &to), HR2D_OK);
  for (size_t k = 0; k < 4; k++) {
    ck_assert_int_eq(g.state[k], HR2D_TEMPERATURE_NONE);
    ck_assert_double_nan(g.kelvin[k]);
    ck_assert_int_eq(isnan(g.heat_bound[k]) != 0, w[k].given == T);
    ck_assert_double_eq(g.heat[k], f.heat[k]);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(plain);
  end(&f);
}
END_TEST

static void draw(randoms *r, wall *w) {
  const double x = random_between(r, .3, 3), y = random_between(r, .3, 3);
  const double at[4][4] = {{0, 0, 2, 0}, {2, 0, x, y}, {x, y, 0, 1}, {0, 1, 0, 0}};
  for (int k = 0; k < 4; k++) {
    memcpy(w[k].at, at[k], sizeof at[k]);
    w[k].given = k == 0 || random_below(r, 2) ? T : Q;
    w[k].value = w[k].given == T ? random_between(r, 200, 1500) : random_between(r, -50, 500);
    w[k].emissivity = random_between(r, .05, 1);
  }
}

/* Of coarse solves, beside a fine one.  *missed counts errors above a thousandth of the bound.
 */
static void check_bounds(const wall *w, int *missed) {
  found fine = find(w, 4, 1e-11), coarse = find(w, 4, 1e-3);
  for (size_t k = 0; k < 4; k++) {
    const double off = fabs(coarse.kelvin[k] - fine.kelvin[k]);
    const double heat = fabs(coarse.heat[k] - fine.heat[k]);
    if (fine.state[k] == HR2D_TEMPERATURE_FOUND)
      ck_assert_msg(off <= coarse.bound[k] + fine.bound[k], "T %g off %g above %g",
                    fine.kelvin[k], off, coarse.bound[k]);
    ck_assert_msg(heat <= coarse.heat_bound[k] + fine.heat_bound[k], "heat %g off %g above %g",
                  fine.heat[k], heat, coarse.heat_bound[k]);
    ck_assert_double_le(coarse.heat_estimate[k], coarse.heat_bound[k]);
    if (fine.state[k] == HR2D_TEMPERATURE_FOUND) *missed += off > 1e-3 * coarse.bound[k];
  }
  end(&fine);
  end(&coarse);
}

START_TEST(bounds_of_temperature_and_heat_hold) {
  randoms r = randoms_stream(test_seed(), 0);
  const size_t rooms = test_rounds(100, 12);
  int missed = 0;
  for (size_t k = 0; k < rooms; k++) {
    wall w[4];
    draw(&r, w);
    check_bounds(w, &missed);
  }
  ck_assert_int_gt(missed, 0); /* the control: the bound is not idle */
}
END_TEST

/* The control of the closed forms: a temperature that is 1e-6 off is noticed. */
START_TEST(a_wrong_temperature_is_noticed) {
  const wall w[] = {{{0, 0, 3, 0}, T, 500, 1},
                    {{3, 0, 0, 4}, T, 500 * (1 + 1e-6), 1},
                    {{0, 4, 0, 0}, Q, 0, 1}};
  found f = find(w, 3, 1e-9);
  ck_assert_double_gt(fabs(f.kelvin[2] - 500), 1e3 * f.bound[2]);
  ck_assert_double_gt(f.heat[1], f.heat_bound[1]);
  end(&f);
}
END_TEST

TEST_SUITE("temperatures") {
  ADD_TESTS("closed forms", one_source_heats_all_insulated_walls,
            a_room_of_one_temperature_is_in_equilibrium,
            two_surfaces_exchange_as_the_formula_says, a_triangle_exchanges_by_crossed_strings,
            between_two_plates_is_the_mean_of_the_fourth_powers,
            a_negative_flux_follows_by_superposition, a_wrong_temperature_is_noticed);
  ADD_TESTS("other", emission_and_reflectance_say_the_same,
            bounds_of_temperature_and_heat_hold);
}
