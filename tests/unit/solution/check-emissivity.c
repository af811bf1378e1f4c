/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Emissivities that depend on temperature, beside scalar equations that GSL solves, and beside
   scenes with the numbers that they have in the end. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>
#include <math.h>
#include <string.h>

#include "support/support.h"

#define SIGMA HR2D_STEFAN_BOLTZMANN
#define T     HR2D_HEAT_TEMPERATURE
#define Q     HR2D_HEAT_FLUX

enum { MOST = 8 };

static const double wavelength = 5;

/* ε = at + by·T, the second band with half of the rise. */
typedef struct line {
  double at, by;
} line;

static double linear(void *ctx, double kelvin, size_t band) {
  const line *l = ctx;
  return l->at + l->by * kelvin / (double)(1 + band);
}

static double nonsense(void *ctx, double kelvin, size_t band) {
  (void)band;
  return kelvin > *(double *)ctx ? NAN : 0.5;
}

typedef struct wall {
  double at[4];
  hr2d_heat given;
  double value;
  hr2d_emissivity_fn of;
  void *ctx;
  double e;
} wall;

static hr2d_thermal thermal_of(const wall *w) {
  hr2d_thermal t = HR2D_THERMAL_INIT;
  t.given = w->given;
  t.value = w->value;
  t.emissivity_of = w->of;
  t.emissivity_ctx = w->ctx;
  t.emissivity = w->of ? NULL : &w->e;
  t.emissivity_bands = w->of ? 0 : 1;
  return t;
}

static hr2d_scene *make(const wall *w, size_t count, size_t wavelengths) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, &wavelength, wavelengths), HR2D_OK);
  for (size_t k = 0; k < count; k++) {
    const hr2d_patch patch = test_patch(w[k].at[0], w[k].at[1], w[k].at[2], w[k].at[3]);
    const hr2d_thermal t = thermal_of(&w[k]);
    ck_assert_msg(!hr2d_scene_add_thermal(scene, &patch, &t, NULL), "%s",
                  hr2d_scene_message(scene));
  }
  test_commit(scene);
  return scene;
}

typedef struct found {
  hr2d_scene *scene;
  hr2d_solution *solution;
  hr2d_account account;
  double kelvin[MOST], bound[MOST], heat[MOST];
  unsigned char state[MOST];
} found;

static found find_in(hr2d_scene *scene, double target) {
  found f = {.scene = scene};
  hr2d_target how = HR2D_TARGET_INIT;
  how.error = target;
  const hr2d_status status = hr2d_solve_to(f.scene, &how, &f.solution, &f.account);
  ck_assert_msg(!status, "%s: %s", hr2d_strerror(status), f.account.reason);
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  to.kelvin = f.kelvin;
  to.bound = f.bound;
  to.heat = f.heat;
  to.state = f.state;
  ck_assert_int_eq(hr2d_solution_temperatures(f.solution, &how, &f.account, &to), HR2D_OK);
  return f;
}

static found find(const wall *w, size_t count, size_t wavelengths, double target) {
  return find_in(make(w, count, wavelengths), target);
}

static void end(found *f) {
  hr2d_solution_destroy(f->solution);
  hr2d_scene_destroy(f->scene);
}

static void close_to(double value, double expected, double relative) {
  ck_assert_msg(fabs(value - expected) <= relative * fabs(expected), "%.17g is not %.17g",
                value, expected);
}

/* Σ ε_b(T)(f_b(T)σT⁴ − f_b(400)σ400⁴) − q of a convex body in a black room of 400 K. */
typedef struct body {
  line e;
  double q;
  size_t bands;
} body;

static double balance(double kelvin, void *of) {
  const body *b = of;
  double sum = -b->q;
  for (size_t k = 0; k < b->bands; k++) {
    const double from = k ? wavelength : 0, to = k + 1 < b->bands ? wavelength : INFINITY;
    line e = b->e;
    sum += linear(&e, kelvin, k) *
           (hr2d_black_body_part(kelvin, from, to) * hr2d_black_body(kelvin) -
            hr2d_black_body_part(400, from, to) * hr2d_black_body(400));
  }
  return sum;
}

static double root_of(const body *b) {
  body copy = *b;
  gsl_root_fsolver *s = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  gsl_function f = {balance, &copy};
  gsl_root_fsolver_set(s, &f, 1, 4000);
  for (int k = 0; k < 200; k++) {
    gsl_root_fsolver_iterate(s);
    if (gsl_root_test_interval(gsl_root_fsolver_x_lower(s), gsl_root_fsolver_x_upper(s), 0,
                               1e-14) == GSL_SUCCESS)
      break;
  }
  const double root = gsl_root_fsolver_root(s);
  gsl_root_fsolver_free(s);
  return root;
}

static void put_body(wall *w, body *b) {
  static const double at[8][4] = {{0, 0, 3, 0}, {3, 0, 3, 3}, {3, 3, 0, 3}, {0, 3, 0, 0},
                                  {1, 1, 1, 2}, {1, 2, 2, 2}, {2, 2, 2, 1}, {2, 1, 1, 1}};
  for (int k = 0; k < 8; k++) {
    w[k] = k < 4 ? (wall){{0}, T, 400, NULL, NULL, 1} : (wall){{0}, Q, b->q, linear, &b->e, 0};
    memcpy(w[k].at, at[k], sizeof at[k]);
  }
}

START_TEST(a_body_has_the_root_of_a_scalar_equation) {
  body bodies[] = {{{.1, 2e-4}, 5000, 1}, {{.9, -2e-4}, 5000, 1}, {{.2, 1e-4}, -100, 1},
                   {{.5, 0}, 1, 1},       {{.1, 2e-4}, 5000, 2},  {{.9, -2e-4}, 9000, 2},
                   {{.2, 1e-4}, -100, 2}, {{.3, 1e-5}, 0, 2}};
  for (size_t m = 0; m < sizeof bodies / sizeof *bodies; m++) {
    wall w[8];
    double t[2] = {.2, .9}, at[2];
    put_body(w, &bodies[m]);
    const double expected = root_of(&bodies[m]);
    found f = find(w, 8, bodies[m].bands - 1, 1e-9);
    for (size_t k = 4; k < 8; k++) {
      ck_assert_int_eq(f.state[k], HR2D_TEMPERATURE_FOUND);
      close_to(f.kelvin[k], expected, 1e-9);
      ck_assert_double_le(fabs(f.kelvin[k] - expected), f.bound[k] + 1e-12 * expected);
      ck_assert_int_eq(hr2d_solution_gather_temperature(f.solution, k, t, 2, at), HR2D_OK);
      for (int q = 0; q < 2; q++) close_to(at[q], expected, 1e-8);
    }
    end(&f);
    /* The control: with the ε of 400 K it is another one. */
    const body other = {{bodies[m].e.at + 400 * bodies[m].e.by, 0}, bodies[m].q, 1};
    if (bodies[m].bands == 1 && bodies[m].e.by != 0)
      ck_assert_double_gt(fabs(root_of(&other) - expected), 1e-3);
  }
}
END_TEST

/* A room in which much is reflected. */
static void put_room(wall *w, line *e) {
  w[0] = (wall){{0, 0, 4, 0}, T, 1500, linear, e, 0};
  w[1] = (wall){{4, 0, 4.5, 3}, Q, 0, linear, e, 0};
  w[2] = (wall){{4.5, 3, 0, 3}, T, 500, NULL, NULL, .3};
  w[3] = (wall){{0, 3, 0, 0}, Q, -2000, linear, e, 0};
}

/* Numbers in the place of a function that has the same value everywhere. */
START_TEST(a_constant_function_is_a_number) {
  for (size_t wavelengths = 0; wavelengths < 2; wavelengths++) {
    line e = {.25, 0};
    wall w[4];
    put_room(w, &e);
    found f = find(w, 4, wavelengths, 1e-9);
    for (int k = 0; k < 4; k++)
      if (w[k].of)
        w[k] = (wall){{w[k].at[0], w[k].at[1], w[k].at[2], w[k].at[3]},
                      w[k].given,
                      w[k].value,
                      NULL,
                      NULL,
                      .25};
    found g = find(w, 4, wavelengths, 1e-9);
    for (int k = 0; k < 4; k++) {
      close_to(f.kelvin[k], g.kelvin[k], 1e-12);
      ck_assert_double_le(fabs(f.heat[k] - g.heat[k]), 1e-12 * fabs(g.heat[0]));
    }
    end(&f);
    end(&g);
  }
}
END_TEST

/* With the numbers that the function has at the temperatures that are found, these are found
   again. */
START_TEST(the_numbers_at_the_end_have_the_same_temperatures) {
  line lines[] = {{.1, 2e-4}, {.05, 4e-4}, {.8, -2e-4}};
  for (int m = 0; m < 3; m++) {
    wall w[4];
    put_room(w, &lines[m]);
    found f = find(w, 4, 1, 1e-9);
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, &wavelength, 1), HR2D_OK);
    for (int k = 0; k < 4; k++) {
      const hr2d_patch patch = test_patch(w[k].at[0], w[k].at[1], w[k].at[2], w[k].at[3]);
      hr2d_thermal t = thermal_of(&w[k]);
      double e[2];
      for (size_t b = 0; b < 2; b++)
        e[b] = hr2d_scene_emissivity_at(f.scene, (size_t)k, b, f.kelvin[k]);
      t.emissivity_of = NULL;
      t.emissivity = e;
      t.emissivity_bands = 2;
      ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_OK);
    }
    test_commit(scene);
    found g = find_in(scene, 1e-9);
    for (int k = 0; k < 4; k++) {
      close_to(f.kelvin[k], g.kelvin[k], 1e-10);
      for (size_t b = 0; b < 2; b++)
        close_to(hr2d_solution_average(f.solution, (size_t)k, b),
                 hr2d_solution_average(g.solution, (size_t)k, b), 1e-9);
    }
    /* The control: ε is not that of the other wall. */
    ck_assert_double_gt(
        fabs(linear(&lines[m], f.kelvin[1], 0) - linear(&lines[m], f.kelvin[3], 0)), 1e-4);
    end(&f);
    end(&g);
  }
}
END_TEST

START_TEST(a_table_of_a_line_is_the_line) {
  line e = {.1, 2e-4};
  const double kelvin[] = {0, 700, 4000};
  const double one[] = {.1, .24, .9}, two[] = {.1, .1, .24, .17, .9, .5};
  for (size_t wavelengths = 0; wavelengths < 2; wavelengths++) {
    wall w[4];
    put_room(w, &e);
    found f = find(w, 4, wavelengths, 1e-9);
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, &wavelength, wavelengths), HR2D_OK);
    for (int k = 0; k < 4; k++) {
      const hr2d_patch patch = test_patch(w[k].at[0], w[k].at[1], w[k].at[2], w[k].at[3]);
      hr2d_thermal t = thermal_of(&w[k]);
      if (w[k].of) {
        t.emissivity_of = NULL;
        t.emissivity = wavelengths ? two : one;
        t.emissivity_bands = wavelengths + 1;
        t.kelvin = kelvin;
        t.kelvins = 3;
      }
      ck_assert_msg(!hr2d_scene_add_thermal(scene, &patch, &t, NULL), "%s",
                    hr2d_scene_message(scene));
    }
    test_commit(scene);
    found g = find_in(scene, 1e-9);
    for (int k = 0; k < 4; k++) close_to(f.kelvin[k], g.kelvin[k], 1e-10);
    ck_assert_double_eq(hr2d_scene_emissivity_at(scene, 1, 0, 9999), .9);
    ck_assert_double_eq(hr2d_scene_emissivity_at(scene, 1, 0, 0), .1);
    close_to(hr2d_scene_emissivity_at(scene, 1, 0, 350), .17, 1e-15);
    close_to(hr2d_scene_emissivity(scene, 0, 0), .1 + 2e-4 * 1500, 1e-15);
    ck_assert_double_nan(hr2d_scene_emissivity(scene, 1, 0));
    end(&f);
    end(&g);
  }
}
END_TEST

START_TEST(bounds_hold) {
  for (size_t wavelengths = 0; wavelengths < 2; wavelengths++) {
    line e = {.1, 3e-4};
    wall w[4];
    put_room(w, &e);
    found rough = find(w, 4, wavelengths, 1e-3), best = find(w, 4, wavelengths, 1e-9);
    for (int k = 1; k < 4; k += 2) {
      const double off = fabs(rough.kelvin[k] - best.kelvin[k]);
      ck_assert_double_le(off, rough.bound[k]);
      ck_assert_double_gt(off, 1e-6 * rough.bound[k]);
      ck_assert_double_le(best.bound[k], 1e-6 * best.kelvin[k]);
    }
    end(&rough);
    end(&best);
  }
}
END_TEST

START_TEST(functions_without_sense_end_calls) {
  double above = 600, never = 0;
  hr2d_solution *solution;
  hr2d_account account;
  wall w[4];
  line e = {.5, 0};
  put_room(w, &e);
  w[1].of = nonsense;
  w[1].ctx = &above;
  hr2d_scene *scene = make(w, 4, 1);
  hr2d_prediction prediction;
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, &account), HR2D_ECALLBACK);
  ck_assert_ptr_null(solution);
  ck_assert_str_ne(account.reason, "");
  ck_assert_int_eq(hr2d_predict(scene, NULL, &prediction), HR2D_ECALLBACK);
  hr2d_scene_destroy(scene);
  found f = find(w, 4, 0, 1e-6);
  ck_assert_double_nan(f.kelvin[1]);
  ck_assert(!isnan(f.kelvin[3]));
  ck_assert_double_nan(hr2d_scene_temperature(f.scene, 1, 1e5));
  end(&f);
  /* Of a given T at once. */
  const hr2d_patch patch = test_patch(0, 0, 1, 0);
  w[0].of = nonsense;
  w[0].ctx = &never;
  const hr2d_thermal t = thermal_of(&w[0]);
  scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_ECALLBACK);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 0);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A fall so steep that there may be several temperatures: one of them, or none is said. */
START_TEST(steep_falls_end) {
  const double kelvin[] = {900, 905}, e[] = {.9, .05};
  for (size_t wavelengths = 0; wavelengths < 2; wavelengths++) {
    hr2d_scene *scene = test_new_scene(NULL);
    const double at[3][4] = {{0, 0, 4, 0}, {4, 0, 0, 3}, {0, 3, 0, 0}};
    ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, &wavelength, wavelengths), HR2D_OK);
    for (int k = 0; k < 3; k++) {
      const hr2d_patch patch = test_patch(at[k][0], at[k][1], at[k][2], at[k][3]);
      hr2d_thermal t = HR2D_THERMAL_INIT;
      t.given = k ? Q : T;
      t.value = k ? 8000 : 700;
      t.emissivity = e;
      t.emissivity_bands = 1;
      t.kelvin = kelvin;
      t.kelvins = 2;
      ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_OK);
    }
    test_commit(scene);
    hr2d_solution *solution;
    const hr2d_status status = hr2d_solve_to(scene, NULL, &solution, NULL);
    ck_assert_msg(!status || status == HR2D_ENOT_CONVERGED || status == HR2D_EACCURACY, "%d",
                  status);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

static void refuse(hr2d_thermal t, hr2d_status status, const char *why) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_patch patch = test_patch(0, 0, 1, 0);
  t.given = Q;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), status);
  test_expect_message(scene, why);
  hr2d_scene_destroy(scene);
}

START_TEST(wrong_descriptions_are_refused) {
  const double e[] = {.1, .2, 1.1, 0}, rising[] = {1, 2, 3}, falling[] = {2, 1},
               below[] = {-1, 1};
  const hr2d_thermal none = HR2D_THERMAL_INIT;
  hr2d_thermal t = none;
  t.emissivity_of = linear;
  t.emissivity = e;
  t.emissivity_bands = 1;
  refuse(t, HR2D_EINVAL, "both values and a function");
  t.emissivity_of = NULL;
  t.kelvins = 2;
  refuse(t, HR2D_EINVAL, "a table has temperatures");
  t.kelvin = falling;
  refuse(t, HR2D_ESCENE, "must rise");
  t.kelvin = below;
  refuse(t, HR2D_ESCENE, "must rise");
  t.kelvin = rising;
  t.kelvins = 3;
  refuse(t, HR2D_ESCENE, "not between 0 and 1");
  t.emissivity = e + 3;
  t.kelvins = 1;
  refuse(t, HR2D_ESCENE, "emissivity is 0");
  t.kelvins = SIZE_MAX / 2;
  refuse(t, HR2D_ENOMEM, "too large");
  t.emissivity_bands = 0;
  t.kelvins = 1;
  refuse(t, HR2D_EINVAL, "a table has temperatures");
}
END_TEST

#define FILE_OF(emissivity, more)                                                              \
  "{\"type\":\"FeatureCollection\"," more                                                      \
  "\"features\":[{\"type\":\"Feature\",\"properties\":"                                        \
  "{\"flux\":0,\"emissivity\":" emissivity "},\"geometry\":{\"type\":\"LineString\","          \
  "\"coordinates\":[[0,0],[1,0]]}}]}"

START_TEST(files_have_tables) {
  static const struct {
    const char *text;
    hr2d_status status;
    double at_450[2];
  } cases[] = {
      {FILE_OF("[[300,0.2],[600,0.6]]", ""), HR2D_OK, {.4, .4}},
      {FILE_OF("[[300,0.2]]", ""), HR2D_OK, {.2, .2}},
      {FILE_OF("[[300,0.2,0.5],[600,0.6,1]]", "\"hr2d\":{\"wavelengths\":[5]},"),
       HR2D_OK,
       {.4, .75}},
      {FILE_OF("[[300,0.2],[600,0.6]]", "\"hr2d\":{\"wavelengths\":[5]},"), HR2D_OK, {.4, .4}},
      {FILE_OF("[[300,0.2,0.5],[600,0.6,1]]", ""), HR2D_ESCENE, {0, 0}},
      {FILE_OF("[[300,0.2],[600]]", ""), HR2D_ESYNTAX, {0, 0}},
      {FILE_OF("[[300],[600]]", ""), HR2D_ESYNTAX, {0, 0}},
      {FILE_OF("[[]]", ""), HR2D_ESYNTAX, {0, 0}},
      {FILE_OF("[[300,0.2],0.6]", ""), HR2D_ESYNTAX, {0, 0}},
      {FILE_OF("[[300,\"0.2\"]]", ""), HR2D_ESYNTAX, {0, 0}},
      {FILE_OF("[[300,0.2],[300,0.6]]", ""), HR2D_ESCENE, {0, 0}},
      {FILE_OF("[[300,1.2]]", ""), HR2D_ESCENE, {0, 0}},
  };
  for (size_t m = 0; m < sizeof cases / sizeof *cases; m++) {
    hr2d_scene *scene = test_new_scene(NULL);
    const hr2d_status status = hr2d_scene_parse(scene, cases[m].text, strlen(cases[m].text));
    ck_assert_msg(status == cases[m].status, "%zu: %s", m, hr2d_scene_message(scene));
    for (size_t b = 0; b < 2 && !status; b++)
      close_to(hr2d_scene_emissivity_at(scene, 0, b, 450), cases[m].at_450[b], 1e-15);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

static hr2d_status drop(void *ctx, const void *bytes, size_t size) {
  (void)ctx;
  (void)bytes;
  (void)size;
  return HR2D_OK;
}

START_TEST(bytes_of_a_scene_have_no_functions) {
  line e = {.5, 0};
  wall w[4];
  put_room(w, &e);
  hr2d_scene *scene = make(w, 4, 0);
  ck_assert_int_eq(hr2d_state_write_scene(scene, drop, NULL), HR2D_EUNSUPPORTED);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("emissivity") {
  ADD_TESTS("closed forms", a_body_has_the_root_of_a_scalar_equation,
            a_constant_function_is_a_number, the_numbers_at_the_end_have_the_same_temperatures,
            a_table_of_a_line_is_the_line, bounds_hold);
  ADD_TESTS("calls", functions_without_sense_end_calls, steep_falls_end,
            wrong_descriptions_are_refused, files_have_tables,
            bytes_of_a_scene_have_no_functions);
}
