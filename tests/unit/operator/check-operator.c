/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other light on a kept operator: against fresh solves of scenes that have it, against closed
   rooms in equilibrium, by superposition and reciprocity; what is not valid; stops. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

enum { MOST = 16 };

/* A room with a screen in it, in one of several surroundings. */
typedef enum surroundings { CLOSED, OPEN, MIRRORED, PERIODIC, SUNNY, KINDS } surroundings;

/* The walls: ax ay bx by; the last two are the sides of a screen. */
static const double wall[][4] = {{0, 0, 2, 0}, {2, 0, 2, 1},    {2, 1, 0, 1},
                                 {0, 1, 0, 0}, {.7, .1, 1, .6}, {1, .6, .7, .1}};
enum { WALLS = sizeof wall / sizeof *wall };

/* Emission and reflectance of each wall in each of up to two bands. */
typedef struct paint {
  double emission[WALLS * 2], reflectance[WALLS * 2], background[2];
} paint;

static void draw(paint *p, randoms *r) {
  for (int k = 0; k < WALLS * 2; k++) {
    p->emission[k] = random_below(r, 2) ? random_unit(r) : 0;
    p->reflectance[k] = random_between(r, 0, 0.9);
  }
  p->emission[0] = 1;
  p->background[0] = random_between(r, 0.1, 1);
  p->background[1] = random_between(r, 0.1, 1);
}

/* Open, periodic and sunny scenes lack the ceiling, and mirrored ones the left wall. */
static int is_there(surroundings kind, int k) {
  if (kind == MIRRORED) return k != 3;
  return kind == CLOSED || (k != 2 && (kind != PERIODIC || (k != 1 && k != 3)));
}

static int walls_of(surroundings kind) {
  int count = 0;
  for (int k = 0; k < WALLS; k++) count += is_there(kind, k);
  return count;
}

static hr2d_scene *make(surroundings kind, const paint *p, size_t bands) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0, at = 0; k < WALLS; k++) {
    if (!is_there(kind, k)) continue;
    hr2d_patch patch = test_patch(wall[k][0], wall[k][1], wall[k][2], wall[k][3]);
    patch.emission = p->emission + (size_t)at * bands;
    patch.reflectance = p->reflectance + (size_t)at++ * bands;
    patch.emission_bands = patch.reflectance_bands = bands;
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  const hr2d_segment mirror = {{0, 0}, {0, 1}};
  const hr2d_sun sun = {{-1, -2}, 0.5};
  if (kind == OPEN || kind == PERIODIC || kind == SUNNY)
    ck_assert_int_eq(hr2d_scene_set_background(scene, p->background, bands), HR2D_OK);
  if (kind == MIRRORED) ck_assert_int_eq(hr2d_scene_add_mirror(scene, mirror), HR2D_OK);
  if (kind == PERIODIC)
    ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){2, 0}), HR2D_OK);
  if (kind == SUNNY) ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  test_commit(scene);
  return scene;
}

static hr2d_operator *operate(const hr2d_scene *scene, double error) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_operator *op = NULL;
  target.error = error;
  const hr2d_status status = hr2d_operator_create(scene, &target, &op, NULL);
  ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
  ck_assert_ptr_nonnull(op);
  return op;
}

static hr2d_light light_of(surroundings kind, const paint *p) {
  hr2d_light light = HR2D_LIGHT_INIT;
  light.emission.value = p->emission;
  light.reflectance.value = p->reflectance;
  if (kind == OPEN || kind == PERIODIC || kind == SUNNY) light.background.value = p->background;
  return light;
}

static hr2d_solution *solve(hr2d_operator *op, const hr2d_light *light, hr2d_account *account) {
  hr2d_solution *solution = NULL;
  const hr2d_status status = hr2d_operator_solve(op, light, NULL, &solution, account);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s", hr2d_operator_message(op));
  ck_assert_ptr_nonnull(solution);
  return solution;
}

/* The largest differences of averages of B and H, as parts of averages that are no less than
   the floor. */
static double distance(const hr2d_solution *s, const hr2d_solution *is, int walls,
                       size_t bands) {
  double worst = 0;
  for (size_t b = 0; b < bands; b++)
    for (int h = 0; h < 2; h++) {
      double (*const value)(const hr2d_solution *, size_t, size_t) =
          h ? hr2d_solution_irradiance : hr2d_solution_average;
      double max = 0;
      for (int k = 0; k < walls; k++) max = fmax(max, value(is, (size_t)k, b));
      for (int k = 0; k < walls; k++) {
        const double v = value(is, (size_t)k, b);
        worst = fmax(worst, fabs(value(s, (size_t)k, b) - v) / fmax(v, HR2D_FLOOR * max));
      }
    }
  return worst;
}

/* An account is of the error against the scene itself with that light, to more digits. */
START_TEST(other_light_is_that_of_a_scene_with_it) {
  const surroundings kind = (surroundings)_i;
  const int walls = walls_of(kind);
  randoms r = randoms_stream(test_seed(), 10 + _i);
  paint first, other;
  for (size_t round = 0; round < test_rounds(20, 2); round++) {
    const size_t bands = 1 + round % 2;
    const double error = random_power(&r, -8, -2);
    draw(&first, &r);
    draw(&other, &r);
    hr2d_scene *scene = make(kind, &first, bands), *fresh = make(kind, &other, bands);
    hr2d_operator *op = operate(scene, error);
    const hr2d_light light = light_of(kind, &other);
    hr2d_account account, exact;
    hr2d_solution *solution = solve(op, &light, &account), *is = NULL;
    hr2d_target finer = HR2D_TARGET_INIT;
    finer.error = fmax(1e-2 * error, 1e-11);
    hr2d_solve_to(fresh, &finer, &is, &exact);
    ck_assert_ptr_nonnull(is);
    const double off = distance(solution, is, walls, bands),
                 of_it = fmax(exact.average.bound, exact.irradiance.bound);
    ck_assert_double_le(off, fmax(account.average.bound, account.irradiance.bound) + of_it);
    /* A negative control: the light of the scene itself is another one. */
    hr2d_solution *own = solve(op, NULL, NULL);
    ck_assert_double_gt(distance(own, is, walls, bands), 1e-2);
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
  const surroundings kind = (surroundings)_i;
  randoms r = randoms_stream(test_seed(), 20 + _i);
  paint first, other;
  draw(&first, &r);
  draw(&other, &r);
  hr2d_scene *scene = make(kind, &first, 1);
  hr2d_operator *op = operate(scene, 1e-4);
  const hr2d_light light = light_of(kind, &other);
  hr2d_light twice = light;
  twice.emission.stride[1] = twice.reflectance.stride[1] = 1;
  twice.background.stride[2] = 1;
  twice.count = 2;
  hr2d_account a[2];
  hr2d_solution *s[2], *between;
  for (int k = 0; k < 2; k++) {
    s[k] = solve(op, &light, &a[k]);
    between = solve(op, k ? NULL : &twice, NULL);
    hr2d_solution_destroy(between);
    between = solve(op, NULL, NULL);
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
  paint first, other;
  for (size_t round = 0; round < test_rounds(100, 10); round++) {
    draw(&first, &r);
    draw(&other, &r);
    for (int k = 0; k < WALLS; k++) other.emission[k] = 1 - other.reflectance[k];
    hr2d_scene *scene = make(CLOSED, &first, 1);
    hr2d_operator *op = operate(scene, 1e-3);
    const hr2d_light light = light_of(CLOSED, &other);
    hr2d_account account;
    hr2d_solution *solution = solve(op, &light, &account);
    for (size_t k = 0; k < WALLS; k++) {
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
  const surroundings kind = (surroundings)_i;
  const int walls = walls_of(kind);
  randoms r = randoms_stream(test_seed(), 40 + _i);
  enum { LIGHTS = 5 };
  double emission[LIGHTS * WALLS], background[LIGHTS], sun[LIGHTS];
  paint first;
  draw(&first, &r);
  for (int k = 0; k < LIGHTS * walls; k++) emission[k] = random_unit(&r);
  for (int m = 0; m < LIGHTS; m++) background[m] = random_unit(&r), sun[m] = random_unit(&r);
  for (int k = 0; k < walls; k++)
    emission[4 * walls + k] = emission[k] + 2 * emission[walls + k];
  background[4] = background[0] + 2 * background[1];
  sun[4] = sun[0] + 2 * sun[1];
  hr2d_scene *scene = make(kind, &first, 1);
  hr2d_operator *op = operate(scene, 1e-11);
  hr2d_light light = HR2D_LIGHT_INIT;
  light.emission.value = emission;
  if (kind == OPEN || kind == PERIODIC || kind == SUNNY) light.background.value = background;
  if (kind == SUNNY) light.sun.value = sun;
  light.count = LIGHTS;
  light.no_error = 1;
  hr2d_solution *all = solve(op, &light, NULL);
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
    hr2d_solution *alone = solve(op, &one, NULL);
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
  const surroundings kind = (surroundings)_i;
  const size_t walls = (size_t)walls_of(kind);
  randoms r = randoms_stream(test_seed(), 50 + _i);
  paint first, other;
  draw(&first, &r);
  draw(&other, &r);
  hr2d_scene *scene = make(kind, &first, 1);
  hr2d_operator *op = operate(scene, 1e-11);
  double response[WALLS * WALLS], column[WALLS], unit[WALLS] = {0}, dark = 0;
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
  if (kind == OPEN || kind == PERIODIC || kind == SUNNY) light.background.value = &dark;
  if (kind == SUNNY) light.sun.value = &dark;
  hr2d_solution *solution = solve(op, &light, NULL);
  for (size_t i = 0; i < walls; i++)
    ck_assert_double_eq_tol(hr2d_solution_average(solution, i, 0), column[i],
                            1e-11 * column[i] + 1e-15);
  hr2d_solution_destroy(solution);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A warm start takes fewer gathers, and gives the same values. */
START_TEST(a_warm_start_is_shorter) {
  randoms r = randoms_stream(test_seed(), 60);
  paint first;
  draw(&first, &r);
  hr2d_scene *scene = make(CLOSED, &first, 1);
  hr2d_operator *op = operate(scene, 1e-9);
  hr2d_light light = light_of(CLOSED, &first);
  hr2d_solution *cold = solve(op, &light, NULL), *start, *warm = NULL;
  first.emission[0] *= 1 + 1e-7;
  start = solve(op, &light, NULL);
  ck_assert_int_eq(hr2d_operator_solve(op, &light, cold, &warm, NULL), HR2D_OK);
  ck_assert_double_le(distance(warm, start, WALLS, 1), 1e-9);
  ck_assert_uint_lt(hr2d_solution_work(warm).gathers, hr2d_solution_work(start).gathers);
  hr2d_solution_destroy(cold);
  hr2d_solution_destroy(warm);
  hr2d_operator_destroy(op); /* a solution may be read after it */
  ck_assert_double_gt(hr2d_solution_average(start, 0, 0), 0.5);
  const double middle = 0.5;
  double b;
  ck_assert_int_eq(hr2d_solution_gather(start, 0, &middle, 1, &b), HR2D_OK);
  ck_assert_double_gt(b, 0.5);
  hr2d_solution_destroy(start);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A lamp in the shade of a screen, where the scene had light elsewhere: the elements were not
   divided for it, and the account says so instead of a target that is missed in silence. */
START_TEST(elements_that_do_not_suffice_are_told) {
  paint first = {.emission = {1}, .reflectance = {.5, .5, .5, .5, 0, 0}}, other = first;
  for (int k = 0; k < WALLS; k++) other.emission[k] = k == 4;
  for (int k = 0; k < WALLS; k++) other.reflectance[k] = 0.95;
  first.reflectance[0] = first.reflectance[1] = 0; /* nothing to resolve there */
  hr2d_scene *scene = make(CLOSED, &first, 1);
  hr2d_operator *op = operate(scene, 1e-9);
  const hr2d_light light = light_of(CLOSED, &other);
  hr2d_solution *solution = NULL;
  hr2d_account account;
  ck_assert_int_eq(hr2d_operator_solve(op, &light, NULL, &solution, &account), HR2D_EACCURACY);
  ck_assert_ptr_nonnull(strstr(account.reason, "make an operator"));
  ck_assert_double_gt(account.average.estimate, 1e-9);
  ck_assert_double_lt(account.average.estimate, 1);
  hr2d_solution_destroy(solution);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

static void expect(hr2d_operator *op, const hr2d_light *light, const char *phrase) {
  hr2d_solution *solution = (hr2d_solution *)op;
  ck_assert_int_eq(hr2d_operator_solve(op, light, NULL, &solution, NULL), HR2D_EINVAL);
  ck_assert_ptr_null(solution);
  ck_assert_msg(strstr(hr2d_operator_message(op), phrase) != NULL, "%s",
                hr2d_operator_message(op));
}

START_TEST(values_that_are_not_valid_are_named) {
  const double nan[] = {1, NAN, 1, 1, 1, 1}, minus[] = {1, 1, 1, -1, 1, 1},
               many[] = {0, 0, 1.5, 0, 0, 0}, near[] = {1, 1.0000001, 1, 1, 1, 1}, one = 1;
  randoms r = randoms_stream(test_seed(), 70);
  paint first;
  draw(&first, &r);
  hr2d_scene *scene = make(CLOSED, &first, 1);
  hr2d_operator *op = operate(scene, 1e-2);
  hr2d_light light = HR2D_LIGHT_INIT;
  light.emission.value = nan;
  expect(op, &light, "light 0: emission of patch 1 is nan");
  light.emission.value = minus;
  expect(op, &light, "emission of patch 3 is -1: it must be at least 0");
  light.emission.value = NULL;
  light.reflectance.value = many;
  expect(op, &light, "reflectance of patch 2 is 1.5: it must be from 0 to 1");
  light.reflectance.value = NULL;
  light.temperature.value = minus;
  expect(op, &light, "temperature of patch 0 is 1: it has none");
  light.temperature.value = NULL;
  light.flux.value = minus;
  expect(op, &light, "flux of patch 0 is 1: it has none");
  light.flux.value = NULL;
  light.background.value = &one;
  expect(op, &light, "the background is 1: the scene has none");
  light.background.value = NULL;
  light.sun.value = &one;
  expect(op, &light, "the scene has no sun");
  light.sun.value = NULL;
  light.reflectance.value = near;
  expect(op, &light, "reflectance of patch 1 is 1.0000001:");
  hr2d_solution *own = solve(op, NULL, NULL); /* it can be used all the same */
  ck_assert_str_eq(hr2d_operator_message(op), "");
  hr2d_solution_destroy(own);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Light for which no elements were made, and which the scene cannot have. */
START_TEST(light_that_elements_do_not_know_is_refused) {
  static const hr2d_sky_piece piece[] = {{-50, -10}, {20, 60}}, even[] = {{-60, -20}, {20, 60}};
  const double same[] = {1, 1}, jumps[] = {.5, 2}, both[] = {2, 2}, dark[] = {0, 0}, one = 1;
  const double *const sky[] = {same, dark, both, jumps};
  const char *const why[] = {"does not change at the bearing", "has no light",
                             "under mirrors the pieces", NULL};
  const hr2d_segment mirror = {{0, 0}, {0, 1}},
                     wall_at[] = {{{.5, 0}, {4, 0}}, {{2, 1}, {1, 1}}};
  for (int k = 0; k < 4; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    for (int m = 0; m < 2; m++)
      ck_assert_int_eq(test_add_patch(scene, wall_at[m], 1 - m, .5, HR2D_SIDES_FRONT), HR2D_OK);
    if (k != 1) ck_assert_int_eq(hr2d_scene_set_background(scene, &one, 1), HR2D_OK);
    if (k == 2) ck_assert_int_eq(hr2d_scene_add_mirror(scene, mirror), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_set_sky(scene, k == 2 ? even : piece, 2, sky[k], 1), HR2D_OK);
    test_commit(scene);
    hr2d_operator *op = operate(scene, 1e-4);
    hr2d_light light = HR2D_LIGHT_INIT;
    light.sky.value = jumps;
    if (why[k])
      expect(op, &light, why[k]);
    else
      hr2d_solution_destroy(solve(op, &light, NULL));
    hr2d_operator_destroy(op);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A call from a callback of another one is refused, and harms nothing. */
typedef struct intruder {
  hr2d_operator *op;
  int refused;
} intruder;

static hr2d_status intrude(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  intruder *i = ctx;
  hr2d_solution *none = NULL;
  double response[WALLS];
  i->refused += hr2d_operator_solve(i->op, NULL, NULL, &none, NULL) == HR2D_ESTATE;
  i->refused += hr2d_operator_response(i->op, NULL, 0, 1, response) == HR2D_ESTATE;
  return HR2D_OK;
}

START_TEST(calls_from_callbacks_are_refused) {
  randoms r = randoms_stream(test_seed(), 90);
  paint first;
  draw(&first, &r);
  hr2d_scene *scene = make(CLOSED, &first, 1);
  hr2d_operator *op = operate(scene, 1e-4);
  intruder i = {op, 0};
  hr2d_solution *alone = solve(op, NULL, NULL);
  hr2d_scene_set_progress(scene, intrude, &i);
  hr2d_solution *disturbed = solve(op, NULL, NULL);
  hr2d_scene_set_progress(scene, NULL, NULL);
  ck_assert_int_gt(i.refused, 1);
  ck_assert_mem_eq(hr2d_solution_field(alone), hr2d_solution_field(disturbed),
                   hr2d_solution_field_size(alone) * sizeof(double));
  hr2d_solution_destroy(alone);
  hr2d_solution_destroy(disturbed);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

/* With ρ = 1 everywhere light that is sent has no solution; in the dark B = 0 has no gradient.
 */
START_TEST(a_gradient_without_an_adjoint_is_refused) {
  paint white = {.emission = {0}}, grey = white;
  for (int k = 0; k < WALLS; k++) white.reflectance[k] = 1;
  for (int k = 0; k < WALLS; k++) grey.reflectance[k] = 0.5;
  hr2d_scene *scene = make(CLOSED, &grey, 1);
  hr2d_operator *op = operate(scene, 1e-4);
  const hr2d_light light = light_of(CLOSED, &white);
  double emission[WALLS];
  const hr2d_values weights = {grey.reflectance, {0, 0, 0}};
  hr2d_gradient gradient = HR2D_GRADIENT_INIT;
  gradient.emission = emission;
  for (int k = 0; k < 2; k++) {
    hr2d_solution *dark = solve(op, k ? NULL : &light, NULL);
    ck_assert_int_eq(hr2d_operator_gradient(op, dark, &weights, NULL, &gradient),
                     k ? HR2D_OK : HR2D_ENO_SOLUTION);
    hr2d_solution_destroy(dark);
  }
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_status stop(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  int *left = ctx;
  return --*left < 0 ? HR2D_STOPPED : HR2D_OK;
}

START_TEST(a_stopped_solve_can_be_made_again) {
  randoms r = randoms_stream(test_seed(), 80);
  paint first;
  draw(&first, &r);
  hr2d_scene *scene = make(OPEN, &first, 1);
  hr2d_operator *op = operate(scene, 1e-6);
  hr2d_account before, after;
  hr2d_solution *whole = solve(op, NULL, &before), *again, *none = NULL;
  hr2d_operator_destroy(op);
  int stops = 0;
  hr2d_status status = HR2D_STOPPED;
  for (int k = 0; k < 100 && status;
       k++) { /* also while the account is made for the first time */
    int left = k;
    op = operate(scene, 1e-6);
    for (int twice = 0; twice < 2; twice++) {
      hr2d_scene_set_progress(scene, stop, &left);
      status = hr2d_operator_solve(op, NULL, NULL, &none, NULL);
      hr2d_scene_set_progress(scene, NULL, NULL);
      stops += status == HR2D_STOPPED;
      if (status == HR2D_STOPPED) ck_assert_ptr_null(none);
      hr2d_solution_destroy(none);
      left = k;
      again = solve(op, NULL, &after);
      ck_assert_mem_eq(hr2d_solution_field(whole), hr2d_solution_field(again),
                       hr2d_solution_field_size(whole) * sizeof(double));
      ck_assert_mem_eq(&before.average, &after.average, sizeof before.average);
      hr2d_solution_destroy(again);
    }
    hr2d_operator_destroy(op);
  }
  ck_assert_int_gt(stops, 6);
  hr2d_solution_destroy(whole);
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
      hr2d_patch patch = test_patch(wall[m][0], wall[m][1], wall[m][2], wall[m][3]);
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
  hr2d_operator *op = operate(scene[0], 1e-10);
  hr2d_light light = HR2D_LIGHT_INIT;
  const double kelvins[] = {kelvin[1], NAN, NAN, NAN}, fluxes[] = {NAN, flux[1], NAN, NAN};
  light.temperature.value = kelvins;
  light.flux.value = fluxes;
  solution = solve(op, &light, NULL);
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-10;
  ck_assert_int_eq(hr2d_solve_to(scene[1], &target, &is, NULL), HR2D_OK);
  ck_assert_double_le(distance(solution, is, 4, 1), 1e-9);
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

TEST_SUITE("operator") {
  REPEAT_TESTS(KINDS, "light", other_light_is_that_of_a_scene_with_it,
               the_same_light_has_the_same_bits, superposition_of_lights_at_once, responses);
  ADD_TESTS("laws", equilibrium, temperatures_and_fluxes);
  ADD_TESTS("calls", a_warm_start_is_shorter, elements_that_do_not_suffice_are_told,
            values_that_are_not_valid_are_named, light_that_elements_do_not_know_is_refused,
            calls_from_callbacks_are_refused, a_gradient_without_an_adjoint_is_refused,
            a_stopped_solve_can_be_made_again);
}
