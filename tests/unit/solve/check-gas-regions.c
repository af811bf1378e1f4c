/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gases with borders: against the equations of a slab, the same gas in one piece, balances, and
   what is refused. */
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sf_expint.h>
#include <math.h>
#include <string.h>

#include "support/support.h"

enum { PATCHES = 6, MOST_CORNERS = 5, CASES = 10 };

static void add_wall(hr2d_scene *scene, hr2d_point a, hr2d_point b, double emission,
                     double rho) {
  hr2d_patch p = HR2D_PATCH_INIT;
  p.a = a;
  p.b = b;
  p.emission = &emission;
  p.reflectance = &rho;
  p.emission_bands = p.reflectance_bands = 1;
  ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
}

/* Exchange of layers of equal depth d between black plates, per length: with E₃ of depths. */
static double slab_exchange(double d, size_t k, size_t l) {
  const double b = d * ((double)(l > k ? l - k : k - l) - 1);
  return 2 * (gsl_sf_expint_En(3, b) - 2 * gsl_sf_expint_En(3, b + d) +
              gsl_sf_expint_En(3, b + 2 * d));
}

/* The flux through so many layers in equilibrium, of the depth 1 together, by their own
   equations. */
static double slab_flux(size_t layers) {
  const double d = 1. / (double)layers;
  gsl_matrix *m = gsl_matrix_alloc(layers, layers);
  gsl_vector *right = gsl_vector_alloc(layers), *e = gsl_vector_alloc(layers);
  gsl_permutation *p = gsl_permutation_alloc(layers);
  int sign;
  double flux = 2 * gsl_sf_expint_En(3, 1);
  for (size_t k = 0; k < layers; k++) {
    const double x = d * (double)k;
    const double hot = 2 * (gsl_sf_expint_En(3, x) - gsl_sf_expint_En(3, x + d));
    const double cold = 2 * (gsl_sf_expint_En(3, 1 - x - d) - gsl_sf_expint_En(3, 1 - x));
    double all = hot + cold;
    for (size_t l = 0; l < layers; l++) {
      if (l != k) all += slab_exchange(d, k, l);
      gsl_matrix_set(m, k, l, l == k ? 0 : -slab_exchange(d, k, l));
    }
    gsl_matrix_set(m, k, k, all);
    gsl_vector_set(right, k, hot);
  }
  gsl_linalg_LU_decomp(m, p, &sign);
  gsl_linalg_LU_solve(m, p, right, e);
  for (size_t k = 0; k < layers; k++) {
    const double x = d * (double)k;
    flux += gsl_vector_get(e, k) * 2 *
            (gsl_sf_expint_En(3, 1 - x - d) - gsl_sf_expint_En(3, 1 - x));
  }
  gsl_matrix_free(m);
  gsl_vector_free(right);
  gsl_vector_free(e);
  gsl_permutation_free(p);
  return flux;
}

/* The same of a room that is so wide that its side walls do not count. */
static double room_flux(size_t layers) {
  const double wide = 1e5, kappa = 1;
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_account account;
  add_wall(scene, (hr2d_point){0, 0}, (hr2d_point){wide, 0}, 0, 0);
  add_wall(scene, (hr2d_point){wide, 0}, (hr2d_point){wide, 1}, 0, 1);
  add_wall(scene, (hr2d_point){wide, 1}, (hr2d_point){0, 1}, 1, 0);
  add_wall(scene, (hr2d_point){0, 1}, (hr2d_point){0, 0}, 0, 1);
  for (size_t k = 0; k < layers; k++) {
    const double low = (double)k / (double)layers, high = (double)(k + 1) / (double)layers;
    const hr2d_point border[] = {{0, low}, {wide, low}, {wide, high}, {0, high}};
    hr2d_gas gas = HR2D_GAS_INIT;
    gas.absorption = &kappa;
    gas.absorption_bands = 1;
    gas.given = HR2D_HEAT_FLUX;
    gas.border = border;
    gas.border_points = 4;
    ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
  }
  test_commit(scene);
  hr2d_solution *s = test_solve_to(scene, 1e-7, 1, &account);
  const double flux = hr2d_solution_irradiance(s, 0, 0);
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
  return flux;
}

/* Layers in equilibrium are as their own equations say, and converge like the square of their
   number to the slab of Heaslet and Warming (1965), whose table has 0.5532. */
START_TEST(layers_converge_to_a_slab) {
  double before = 0;
  for (size_t layers = 1; layers <= 8; layers *= 2) {
    const double flux = slab_flux(layers), error = flux - slab_flux(256);
    ck_assert_double_eq_tol(room_flux(layers), flux, 3e-5);
    if (layers > 2) ck_assert_double_eq_tol(before / error, 4, 0.6);
    before = error;
  }
  ck_assert_double_eq_tol(slab_flux(256), 0.5532, 3e-4);
  ck_assert_double_gt(slab_flux(1) - slab_flux(256), 0.05); /* one zone is a model */
}
END_TEST

/* A gas; without heat it has an emission. */
static hr2d_status add_gas(hr2d_scene *scene, double kappa, double emission, const double *heat,
                           hr2d_section section, const hr2d_point *border, size_t points) {
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = &kappa;
  gas.absorption_bands = 1;
  gas.emission = &emission;
  gas.emission_bands = heat == NULL;
  if (heat) gas.given = HR2D_HEAT_FLUX;
  if (heat) gas.value = *heat;
  gas.section = section;
  gas.border = border;
  gas.border_points = points;
  return hr2d_scene_add_gas(scene, &gas, NULL);
}

/* A room with an obstacle and a pane. */
static hr2d_scene *draw_room(randoms *r) {
  const hr2d_segment at[PATCHES] = {{{0, 0}, {3, 0}},     {{3, 0}, {3, 2}},
                                    {{3, 2}, {0, 2}},     {{0, 2}, {0, 0}},
                                    {{1, 0.6}, {2, 0.8}}, {{0.4, 1.2}, {1.2, 1.7}}};
  const double tau = 0.3 * random_unit(r);
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < PATCHES; k++) {
    const double emission = random_unit(r), rho = 0.7 * random_unit(r);
    hr2d_patch p = HR2D_PATCH_INIT;
    p.a = at[k].a;
    p.b = at[k].b;
    p.emission = &emission;
    p.reflectance = &rho;
    p.emission_bands = p.reflectance_bands = 1;
    p.sides = k >= 4 ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT;
    p.transmittance = &tau;
    p.transmittance_bands = k == 5;
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  return scene;
}

/* Any polygon, also one that crosses itself, walls and others. */
static size_t draw_border(randoms *r, hr2d_point *border) {
  const size_t points = 3 + random_below(r, MOST_CORNERS - 2);
  for (size_t k = 0; k < points; k++)
    border[k] = (hr2d_point){-0.5 + 4 * random_unit(r), -0.5 + 3 * random_unit(r)};
  return points;
}

static hr2d_scene *draw_pieces(int n, size_t pieces, double other) {
  randoms r = randoms_stream(test_seed(), n);
  const double kappa = random_power(&r, -3, 1.3), emission = random_unit(&r);
  const hr2d_section section = n % 3 ? HR2D_SECTION_LONG : HR2D_SECTION_FLAT;
  hr2d_scene *scene = draw_room(&r);
  ck_assert_int_eq(add_gas(scene, kappa, emission, NULL, section, NULL, 0), HR2D_OK);
  for (size_t k = 0; k < pieces; k++) {
    hr2d_point border[MOST_CORNERS];
    const size_t points = draw_border(&r, border);
    ck_assert_int_eq(
        add_gas(scene, kappa * (k ? 1 : other), emission, NULL, section, border, points),
        HR2D_OK);
  }
  test_commit(scene);
  return scene;
}

typedef struct values {
  double b[PATCHES], at[3], heat, inside;
} values;

static values solve(hr2d_scene *scene, double error) {
  const double t[] = {0.1, 0.52, 0.93};
  const hr2d_point inside = {0.9, 0.8};
  hr2d_field_values field = HR2D_FIELD_VALUES_INIT;
  hr2d_account account;
  values v = {.heat = 0};
  hr2d_solution *s = test_solve_to(scene, error, 1, &account);
  for (size_t k = 0; k < PATCHES; k++) v.b[k] = hr2d_solution_average(s, k, 0);
  ck_assert_int_eq(hr2d_solution_gather_irradiance(s, 1, t, 3, v.at), HR2D_OK);
  field.mean = &v.inside;
  ck_assert_int_eq(hr2d_field_at(s, &inside, 1, NULL, &field), HR2D_OK);
  for (size_t k = 0; k < hr2d_scene_gases(scene); k++) {
    double heat;
    ck_assert_int_eq(hr2d_solution_gas(s, k, 0, NULL, &heat), HR2D_OK);
    v.heat += heat;
  }
  const hr2d_power p = hr2d_solution_power(s, 0);
  ck_assert_double_le(fabs(p.emitted + p.received - p.absorbed - p.escaped),
                      fmax(1e-12, error) * (p.emitted + p.received));
  ck_assert_double_eq_tol(v.heat, p.received - p.escaped, 1e-12 * (p.emitted + p.received));
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
  return v;
}

/* Of averages, which the target is for. */
static double distance(const values *v, const values *w) {
  double most = fabs(v->heat - w->heat) / 10;
  for (size_t k = 0; k < PATCHES; k++) most = fmax(most, fabs(v->b[k] - w->b[k]));
  return most;
}

static double distance_at_points(const values *v, const values *w) {
  double most = fabs(v->inside - w->inside);
  for (size_t k = 0; k < 3; k++) most = fmax(most, fabs(v->at[k] - w->at[k]));
  return most;
}

/* Borders within one gas change nothing, wherever they are. */
START_TEST(a_gas_in_pieces_is_one) {
  double worst = 0, at_points = 0, differs = 0;
  for (int n = 0; n < test_count(CASES); n++) {
    const values whole = solve(draw_pieces(n, 0, 1), 1e-7);
    const values pieces = solve(draw_pieces(n, 1 + (size_t)n % 2, 1), 1e-7);
    const values other = solve(draw_pieces(n, 1 + (size_t)n % 2, 1.5), 1e-3);
    worst = fmax(worst, distance(&whole, &pieces));
    at_points = fmax(at_points, distance_at_points(&whole, &pieces));
    differs = fmax(differs, distance(&whole, &other));
  }
  printf("pieces of a gas are off by at most %.1e, at points %.1e, of another gas by %.1e\n",
         worst, at_points, differs);
  ck_assert_double_lt(worst, 5e-7);
  ck_assert_double_lt(at_points, 5e-5);
  ck_assert_double_gt(differs, 1e-5); /* negative control */
}
END_TEST

/* Gases of the heats that others of given emission have are as hot as these. */
START_TEST(heat_and_emission_are_each_other) {
  for (int n = 0; n < test_count(CASES); n++) {
    double heat[3], emission[3], found;
    hr2d_account account;
    for (int given = 0; given < 2; given++) {
      randoms r = randoms_stream(test_seed(), 100 + n);
      const double kappa[] = {random_power(&r, -2, 0.7), random_power(&r, -2, 0.7),
                              random_power(&r, -2, 0.7)};
      hr2d_scene *scene = draw_room(&r);
      for (size_t k = 0; k < 3; k++) {
        const hr2d_point border[] = {{0.1 + 0.9 * (double)k, 0.1},
                                     {0.9 + 0.9 * (double)k, 0.3},
                                     {0.8 + 0.9 * (double)k, 1.8},
                                     {0.2 + 0.9 * (double)k, 1.5}};
        const double hot = random_unit(&r);
        const int is_free = given && (k == 2 || n % 2);
        if (!given) emission[k] = hot;
        ck_assert_int_eq(add_gas(scene, kappa[k], emission[k], is_free ? &heat[k] : NULL,
                                 HR2D_SECTION_LONG, border, 4),
                         HR2D_OK);
      }
      test_commit(scene);
      hr2d_solution *s = test_solve_to(scene, 1e-6, 1, &account);
      for (size_t k = 0; k < 3; k++) {
        ck_assert_int_eq(hr2d_solution_gas(s, k, 0, &found, given ? NULL : &heat[k]), HR2D_OK);
        ck_assert_double_eq_tol(found, emission[k], 1e-4);
      }
      hr2d_solution_destroy(s);
      hr2d_scene_destroy(scene);
    }
  }
}
END_TEST

/* Gases of one temperature are one in equilibrium. */
START_TEST(one_temperature_is_equilibrium) {
  for (int n = 0; n < test_count(CASES); n++) {
    randoms r = randoms_stream(test_seed(), 300 + n);
    hr2d_account account;
    hr2d_scene *scene = test_new_scene(NULL);
    const hr2d_point corner[] = {{0, 0}, {3, 0}, {3, 2}, {0, 2}};
    for (size_t k = 0; k < 4; k++) {
      const double rho = random_unit(&r);
      add_wall(scene, corner[k], corner[(k + 1) % 4], 1 - rho, rho);
    }
    for (size_t k = 0; k < 3; k++) {
      hr2d_point border[MOST_CORNERS];
      const size_t points = draw_border(&r, border);
      ck_assert_int_eq(
          add_gas(scene, random_power(&r, -3, 2), 1, NULL, HR2D_SECTION_LONG, border, points),
          HR2D_OK);
    }
    test_commit(scene);
    hr2d_solution *s = test_solve_to(scene, 1e-3, 1, &account);
    for (size_t k = 0; k < 4; k++)
      ck_assert_double_eq_tol(hr2d_solution_average(s, k, 0), 1, 1e-13);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

static hr2d_scene *square(int open) {
  const hr2d_point corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < 4 - (size_t)open; k++)
    add_wall(scene, corner[k], corner[(k + 1) % 4], 1, 0.5);
  return scene;
}

static void expect_solve(hr2d_scene *scene, hr2d_status right, const char *message) {
  hr2d_solution *s = NULL;
  hr2d_account account;
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &s, &account), right);
  ck_assert_msg(strstr(account.reason, message) != NULL, "\"%s\" is not in \"%s\"", message,
                account.reason);
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}

START_TEST(what_has_no_answer_is_refused) {
  const hr2d_point border[] = {{0.2, 0.2}, {0.8, 0.2}, {0.5, 0.8}};
  const hr2d_point outside[] = {{5, 5}, {6, 5}, {6, 6}};
  const hr2d_point bad[] = {{0.2, 0.2}, {NAN, 0.2}, {0.5, 0.8}};
  const double none = 0;
  const hr2d_section section = HR2D_SECTION_LONG;
  hr2d_scene *scene = square(0);
  ck_assert_int_eq(add_gas(scene, 1, 1, NULL, section, border, 2), HR2D_ESCENE);
  ck_assert_int_eq(add_gas(scene, 1, 1, NULL, section, NULL, 3), HR2D_EINVAL);
  ck_assert_int_eq(add_gas(scene, 1, 1, NULL, section, bad, 3), HR2D_ESCENE);
  ck_assert_int_eq(add_gas(scene, 1, 1, NULL, section, border, 3), HR2D_OK);
  ck_assert_int_eq(add_gas(scene, 1, 1, NULL, HR2D_SECTION_FLAT, border, 3), HR2D_ESCENE);
  ck_assert_int_eq(add_gas(scene, 1, 1, NULL, section, NULL, 0), HR2D_OK);
  ck_assert_int_eq(add_gas(scene, 1, 1, NULL, section, NULL, 0), HR2D_EUNSUPPORTED);
  ck_assert_uint_eq(hr2d_scene_gases(scene), 2);
  hr2d_scene_destroy(scene);

  scene = square(1);
  ck_assert_int_eq(add_gas(scene, 1, 1, NULL, section, border, 3), HR2D_OK);
  test_commit(scene);
  expect_solve(scene, HR2D_EUNSUPPORTED, "a gas has a border, and the scene is open");

  scene = square(0);
  ck_assert_int_eq(add_gas(scene, 1, 0, &none, section, outside, 3), HR2D_OK);
  test_commit(scene);
  expect_solve(scene, HR2D_ENO_SOLUTION, "no line between patches passes through it");

  scene = square(1);
  const hr2d_segment mirror = {{0, 0}, {0, 1}};
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, mirror), HR2D_OK);
  ck_assert_int_eq(add_gas(scene, 1, 1, NULL, section, border, 3), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_EUNSUPPORTED);
  test_expect_message(scene, "a gas has a border, which mirrors and periods do not repeat");
  hr2d_scene_destroy(scene);
}
END_TEST

/* Without absorption borders are nothing. */
START_TEST(clear_gas_changes_no_bit) {
  const hr2d_point border[] = {{0.2, 0.2}, {0.8, 0.2}, {0.5, 0.8}};
  hr2d_solution *s[2];
  hr2d_scene *scene[2] = {square(0), square(0)};
  hr2d_account account[2];
  ck_assert_int_eq(add_gas(scene[1], 0, 1, NULL, HR2D_SECTION_LONG, border, 3), HR2D_OK);
  for (size_t k = 0; k < 2; k++) {
    test_commit(scene[k]);
    s[k] = test_solve_to(scene[k], 1e-9, 1, &account[k]);
  }
  ck_assert(!memcmp(hr2d_solution_field(s[0]), hr2d_solution_field(s[1]),
                    hr2d_solution_field_size(s[0]) * sizeof(double)));
  for (size_t k = 0; k < 2; k++) {
    hr2d_solution_destroy(s[k]);
    hr2d_scene_destroy(scene[k]);
  }
}
END_TEST

TEST_SUITE("gas regions") {
  ADD_TESTS("slab", layers_converge_to_a_slab);
  ADD_TESTS("pieces", a_gas_in_pieces_is_one, heat_and_emission_are_each_other,
            one_temperature_is_equilibrium);
  ADD_TESTS("limits", what_has_no_answer_is_refused, clear_gas_changes_no_bit);
}
