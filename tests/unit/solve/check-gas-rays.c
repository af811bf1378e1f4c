/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gases with borders against integrals over rays, which are followed by clipping convex
   polygons. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

#include "support/support.h"

enum { WALLS = 4, CORNERS = 5, GASES = 3, MOST_BREAKS = 32 };

static const hr2d_point room[WALLS] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};

/* Convex, counter-clockwise and apart from each other; the second one reaches into walls. */
static const hr2d_point flame[CORNERS] = {
    {0.3, 0.1}, {0.8, 0.15}, {0.9, 0.5}, {0.5, 0.65}, {0.2, 0.5}};
static const hr2d_point smoke[4] = {{-1, 0.8}, {3, 0.7}, {3, 2}, {-1, 2}};

/* The first gas is around the others. */
typedef struct gases {
  double kappa[GASES], emission[GASES];
  hr2d_section section;
} gases;

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

static hr2d_status add_gas(hr2d_scene *scene, double kappa, double emission,
                           hr2d_section section, const hr2d_point *border, size_t points) {
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = &kappa;
  gas.emission = &emission;
  gas.absorption_bands = gas.emission_bands = 1;
  gas.section = section;
  gas.border = border;
  gas.border_points = points;
  return hr2d_scene_add_gas(scene, &gas, NULL);
}

static hr2d_scene *draw(const gases *g, double rho) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < WALLS; k++)
    add_wall(scene, room[k], room[(k + 1) % WALLS], k == 1 ? 0.5 : 0, rho);
  ck_assert_int_eq(add_gas(scene, g->kappa[0], g->emission[0], g->section, NULL, 0), HR2D_OK);
  ck_assert_int_eq(add_gas(scene, g->kappa[1], g->emission[1], g->section, flame, CORNERS),
                   HR2D_OK);
  ck_assert_int_eq(add_gas(scene, g->kappa[2], g->emission[2], g->section, smoke, 4), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* T of their own: e^−x, or (4/π)∫cos²β e^(−x/cos β) dβ, with points that crowd at π/2. */
static double passes(hr2d_section section, double x) {
  enum { POINTS = 64 };
  double sum = 0;
  if (section == HR2D_SECTION_FLAT) return exp(-x);
  gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(POINTS);
  for (size_t k = 0; k < POINTS; k++) {
    double u, w;
    gsl_integration_glfixed_point(0, 1, k, &u, &w, table);
    const double beta = (1 - pow(1 - u, 4)) * M_PI_2, c = sin(M_PI_2 - beta);
    sum += w * 4 * pow(1 - u, 3) * M_PI_2 * c * c * exp(-x / c);
  }
  gsl_integration_glfixed_table_free(table);
  return 4 / M_PI * sum;
}

/* The part of a ray within a convex polygon (Cyrus and Beck 1978). */
static int clip(const hr2d_point *border, size_t points, hr2d_point from, hr2d_point e,
                double *in, double *out) {
  for (size_t k = 0; k < points; k++) {
    const hr2d_point a = border[k], b = border[(k + 1) % points];
    const double ux = b.x - a.x, uy = b.y - a.y;
    const double inside = ux * (from.y - a.y) - uy * (from.x - a.x), rate = ux * e.y - uy * e.x;
    if (rate > 0)
      *in = fmax(*in, -inside / rate);
    else if (rate < 0)
      *out = fmin(*out, -inside / rate);
    else if (inside < 0)
      return 0;
  }
  return *in < *out;
}

/* What comes from a direction of length 1: B of the wall, through all gases, and theirs. */
static double light_from(const gases *g, hr2d_point from, hr2d_point e) {
  double in = 0, end = HUGE_VAL, part[2][2];
  int which[2] = {1, 2}, count = 0;
  clip(room, WALLS, from, e, &in, &end);
  for (int k = 0; k < 2; k++) {
    double a = 0, b = end;
    if (!clip(k ? smoke : flame, k ? 4 : CORNERS, from, e, &a, &b)) continue;
    part[count][0] = a;
    part[count][1] = b;
    which[count++] = k + 1;
  }
  if (count == 2 && part[1][0] < part[0][0]) {
    const double kept[] = {part[0][0], part[0][1]};
    memcpy(part[0], part[1], sizeof kept);
    memcpy(part[1], kept, sizeof kept);
    which[0] = 2;
    which[1] = 1;
  }
  double depth = 0, at = 0, light = 0, before = 1;
  for (int k = 0; k <= 2 * count; k++) {
    const int gas = k % 2 ? which[k / 2] : 0;
    const double to = k == 2 * count ? end : part[k / 2][k % 2];
    depth += g->kappa[gas] * (to - at);
    const double now = passes(g->section, depth);
    light += g->emission[gas] * (before - now);
    before = now;
    at = to;
  }
  return light + (from.x + end * e.x > 2 - 1e-12 ? before * 0.5 : 0);
}

typedef struct view {
  const gases *g;
  hr2d_point x;
} view;

static double beam(double theta, void *params) { /* of a point on the floor */
  const view *v = params;
  return 0.5 * sin(theta) * light_from(v->g, v->x, (hr2d_point){cos(theta), sin(theta)});
}

static int by_size(const void *p, const void *q) {
  const double a = *(const double *)p, b = *(const double *)q;
  return (a > b) - (a < b);
}

/* H at a point of the floor, with an integral that ends at all corners. */
static double irradiance_at(const gases *g, double x) {
  double at[MOST_BREAKS], result, error;
  size_t count = 0;
  view v = {g, {x, 0}};
  at[count++] = 0;
  at[count++] = M_PI;
  const hr2d_point *of[] = {room, flame, smoke};
  const size_t points[] = {WALLS, CORNERS, 4};
  for (size_t k = 0; k < 3; k++)
    for (size_t m = 0; m < points[k]; m++)
      if (of[k][m].y > 0) at[count++] = atan2(of[k][m].y, of[k][m].x - x);
  at[count++] = atan2(0.8 - 0.025, -x); /* where the smoke meets the walls */
  at[count++] = atan2(0.8 - 0.075, 2 - x);
  qsort(at, count, sizeof *at, by_size);
  gsl_integration_workspace *w = gsl_integration_workspace_alloc(400);
  gsl_function f = {beam, &v};
  double sum = 0;
  for (size_t k = 0; k + 1 < count; k++) {
    if (!(at[k + 1] > at[k])) continue;
    ck_assert_int_eq(
        gsl_integration_qag(&f, at[k], at[k + 1], 1e-13, 1e-12, 400, 6, w, &result, &error), 0);
    sum += result;
  }
  gsl_integration_workspace_free(w);
  return sum;
}

static double along_floor(double x, void *params) {
  return irradiance_at(params, x);
}

/* The average of H over the floor; its slope jumps where borders are seen end on. */
static double average_of(gases *g) {
  double at[MOST_BREAKS] = {0, 2}, result, error, sum = 0;
  size_t count = 2;
  for (size_t k = 0; k < CORNERS; k++) {
    const hr2d_point a = flame[k], b = flame[(k + 1) % CORNERS];
    const double x = a.x - a.y * (b.x - a.x) / (b.y - a.y);
    if (x > 0 && x < 2) at[count++] = x;
  }
  qsort(at, count, sizeof *at, by_size);
  gsl_integration_workspace *w = gsl_integration_workspace_alloc(100);
  gsl_function f = {along_floor, g};
  for (size_t k = 0; k + 1 < count; k++) {
    ck_assert_int_eq(
        gsl_integration_qag(&f, at[k], at[k + 1], 1e-10, 1e-9, 100, 2, w, &result, &error), 0);
    sum += result;
  }
  gsl_integration_workspace_free(w);
  return sum / 2;
}

static gases cases[] = {{{0.2, 2, 0.7}, {0.5, 5, 1}, HR2D_SECTION_LONG},
                        {{0, 2, 0.7}, {0, 5, 0}, HR2D_SECTION_FLAT},
                        {{0.2, 30, 4}, {0.1, 1, 2}, HR2D_SECTION_FLAT},
                        {{1e-9, 1e-8, 3e-9}, {1, 2, 3}, HR2D_SECTION_LONG}};
enum { CASES = sizeof cases / sizeof *cases };

/* H at points of the floor of a black room, and its average. */
START_TEST(rays_through_gases_make_H) {
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  double at_points = 0, of_average = 0, differs = 0;
  for (size_t n = 0; n < CASES; n++) {
    hr2d_account account;
    hr2d_scene *scene = draw(&cases[n], 0);
    hr2d_solution *s = test_solve_to(scene, 1e-9, 1, &account);
    const double at[] = {0.13, 0.37, 0.62, 0.95};
    double value[4];
    ck_assert_int_eq(hr2d_solution_gather_irradiance(s, 0, at, 4, value), HR2D_OK);
    for (size_t k = 0; k < 4; k++) {
      const double right = irradiance_at(&cases[n], 2 * at[k]);
      at_points = fmax(at_points, fabs(value[k] / right - 1));
    }
    const double average = hr2d_solution_irradiance(s, 0, 0);
    of_average = fmax(of_average, fabs(average / average_of(&cases[n]) - 1));
    gases other = cases[n];
    other.kappa[1] *= 1.001;
    differs = fmax(differs, fabs(average / average_of(&other) - 1));
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  printf("H is off by at most %.1e at points, and %.1e in averages; by %.1e in other gas\n",
         at_points, of_average, differs);
  ck_assert_double_lt(at_points, 1e-10);
  ck_assert_double_lt(of_average, 2e-9);
  ck_assert_double_gt(differs, 1e-5); /* negative control */
  gsl_set_error_handler(handler);
}
END_TEST

/* Light of a direction, for the mean and the flux of a point inside. */
typedef struct around {
  const gases *g;
  hr2d_point x;
  int part; /* of the flux; or −1: the mean */
} around;

static double ray(double theta, void *params) {
  const around *a = params;
  const hr2d_point e = {cos(theta), sin(theta)};
  const double light = light_from(a->g, a->x, e);
  return a->part < 0 ? light / (2 * M_PI) : 0.5 * light * (a->part ? e.y : e.x);
}

static double around_point(const gases *g, hr2d_point x, int part) {
  double at[MOST_BREAKS] = {-M_PI, M_PI}, result, error, sum = 0;
  size_t count = 2;
  around a = {g, x, part};
  const hr2d_point *of[] = {room, flame, smoke};
  const size_t points[] = {WALLS, CORNERS, 4};
  for (size_t k = 0; k < 3; k++)
    for (size_t m = 0; m < points[k]; m++)
      at[count++] = atan2(of[k][m].y - x.y, of[k][m].x - x.x);
  at[count++] = atan2(0.775 - x.y, -x.x);
  at[count++] = atan2(0.725 - x.y, 2 - x.x);
  qsort(at, count, sizeof *at, by_size);
  gsl_integration_workspace *w = gsl_integration_workspace_alloc(400);
  gsl_function f = {ray, &a};
  for (size_t k = 0; k + 1 < count; k++) {
    if (!(at[k + 1] > at[k])) continue;
    ck_assert_int_eq(
        gsl_integration_qag(&f, at[k], at[k + 1], 1e-13, 1e-12, 400, 6, w, &result, &error), 0);
    sum += result;
  }
  gsl_integration_workspace_free(w);
  return sum;
}

/* M has e^−x in a flat section, as the flux has. */
START_TEST(points_inside_see_all_gases) {
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  const hr2d_point at[] = {{0.5, 0.4}, {1.4, 0.2}, {1.1, 0.9}, {0.85, 0.55}};
  double worst = 0;
  for (size_t n = 0; n < CASES; n++) {
    hr2d_account account;
    hr2d_scene *scene = draw(&cases[n], 0);
    hr2d_solution *s = test_solve_to(scene, 1e-6, 1, &account);
    double mean[4], flux[8];
    hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
    values.mean = mean;
    values.flux = flux;
    ck_assert_int_eq(hr2d_field_at(s, at, 4, NULL, &values), HR2D_OK);
    for (size_t k = 0; k < 4; k++) {
      const double scale = around_point(&cases[n], at[k], -1);
      if (cases[n].section == HR2D_SECTION_FLAT) worst = fmax(worst, fabs(mean[k] / scale - 1));
      for (int m = 0; m < 2; m++)
        worst = fmax(worst,
                     fabs(flux[2 * k + (size_t)m] - around_point(&cases[n], at[k], m)) / scale);
    }
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  printf("M and fluxes are off by at most %.1e\n", worst);
  ck_assert_double_lt(worst, 1e-11);
  gsl_set_error_handler(handler);
}
END_TEST

/* What a gas gives less what it gives when it is cold is its emission: thin gas has 4κ, or πκ,
   times its area. */
START_TEST(thin_gas_emits_by_its_volume) {
  double area[GASES] = {0, 0, 0.5}; /* of the smoke, which is 0.225 to 0.275 high */
  for (size_t k = 0; k < CORNERS; k++) {
    const hr2d_point a = flame[k], b = flame[(k + 1) % CORNERS];
    area[1] += 0.5 * (a.x * b.y - a.y * b.x);
  }
  for (size_t n = 0; n < 4; n++) {
    const size_t gas = 1 + n % 2;
    gases g = {{0, 1e-9, 1e-9}, {0, 0, 0}, n < 2 ? HR2D_SECTION_FLAT : HR2D_SECTION_LONG};
    double heat[2];
    for (int hot = 0; hot < 2; hot++) {
      hr2d_account account;
      g.emission[gas] = hot;
      hr2d_scene *scene = draw(&g, 0);
      hr2d_solution *s = test_solve_to(scene, 1e-3, 1, &account);
      ck_assert_int_eq(hr2d_solution_gas(s, gas, 0, NULL, &heat[hot]), HR2D_OK);
      hr2d_solution_destroy(s);
      hr2d_scene_destroy(scene);
    }
    const double whole = (n < 2 ? M_PI : 4) * 1e-9 * area[gas];
    ck_assert_double_eq_tol((heat[1] - heat[0]) / whole, 1, 1e-8);
  }
}
END_TEST

TEST_SUITE("gas rays") {
  ADD_TESTS("rays", rays_through_gases_make_H, points_inside_see_all_gases,
            thin_gas_emits_by_its_volume);
}
