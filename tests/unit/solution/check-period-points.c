/* SPDX-License-Identifier: GPL-3.0-or-later */
/* B and H at points under periods, past whose images some see for ever, where they are known:
   rows of solar panels, which see the sky between two angles, and endless plates, whose light
   is a Fourier series.  From points of the plane on a patch the field has the same H. */
#include <gsl/gsl_sf_bessel.h>
#include <math.h>

#include "support/support.h"
#include "support/symmetric-scenes.h"

static const double pi = 3.14159265358979323846;

/* Panels of length `size` over ground, which rise by an angle from their lower ends. */
typedef struct row {
  double step, size, angle, high;
} row;

static row draw_row(randoms *r) {
  return (row){.step = random_between(r, 3, 9),
               .size = random_between(r, 1, 2.5),
               .angle = random_between(r, 10, 60) * (pi / 180),
               .high = random_between(r, .3, 2)};
}

static hr2d_scene *make_row(const row *p) {
  const double sky = 1;
  const hr2d_point low = {0, p->high},
                   top = {p->size * cos(p->angle), p->high + p->size * sin(p->angle)};
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_patch(scene, (hr2d_segment){low, top}, 0, 0, HR2D_SIDES_BOTH);
  test_add_patch(scene, (hr2d_segment){{0, 0}, {p->step, 0}}, 0, 0, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){p->step, 0}), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* A panel sees the sky from its own direction to the top of the row before it, which is ψ above
   the horizon. */
static double row_irradiance(const row *p, double t) {
  const double x = t * p->size * cos(p->angle), y = t * p->size * sin(p->angle);
  const double psi = atan2(p->size * sin(p->angle) - y, x + p->step - p->size * cos(p->angle));
  return 0.5 * (1 + cos(p->angle + psi));
}

enum { POINTS = 9 };
static const double places[POINTS] = {1e-6, .05, .15, .3, .5, .7, .85, .95, 1 - 1e-6};

/* H of a black patch, from the field on it: n·Φ = H.  *error: what M may be off by images that
   are cut off, π times as much of Φ. */
static double field_irradiance(const hr2d_solution *solution, hr2d_segment at, double t,
                               double *error) {
  const hr2d_point d = {at.b.x - at.a.x, at.b.y - at.a.y};
  const hr2d_point x = {at.a.x + t * d.x, at.a.y + t * d.y};
  double flux[2];
  const double none[3] = {0}; /* B of black patches is known */
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  options.patch_error = none;
  values.flux = flux;
  values.error = error;
  ck_assert_int_eq(hr2d_field_at(solution, &x, 1, &options, &values), HR2D_OK);
  return (d.x * flux[1] - d.y * flux[0]) / hypot(d.x, d.y);
}

START_TEST(rows_of_panels) {
  const size_t rounds = test_some(100, 5);
  double worst = 0;
  for (size_t k = 0; k < rounds; k++) {
    randoms r = randoms_stream(test_seed(), (int)k);
    const row p = draw_row(&r);
    hr2d_scene *scene = make_row(&p);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *solution;
    hr2d_account account;
    double h[POINTS];
    target.norm = k % 2 ? HR2D_NORM_SUP : HR2D_NORM_AVERAGE;
    target.error = 1e-6;
    target.points = 1;
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
    ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, 0, places, POINTS, h), HR2D_OK);
    for (int m = 0; m < POINTS; m++) {
      const double right = row_irradiance(&p, places[m]);
      ck_assert_msg(fabs(h[m] - right) <= account.irradiance_sup.bound + 1e-15,
                    "row %zu: H %.17g at %g, not %.17g, bound %g", k, h[m], places[m], right,
                    account.irradiance_sup.bound);
      double error;
      const double seen =
          field_irradiance(solution, hr2d_scene_segment(scene, 0), places[m], &error);
      /* On a wall the field is that of points some 1e-12 before it (field.h). */
      const double beside = 1e-12 / fmin(places[m], 1 - places[m]);
      ck_assert_msg(fabs(seen - right) <= pi * error + beside,
                    "row %zu: the field has H %.17g at %g, not %.17g, error %g", k, seen,
                    places[m], right, error);
      worst = fmax(worst, fabs(hr2d_solution_irradiance_at(solution, 0, places[m], 0) - right));
    }
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  /* The polynomials of leaves are far off: the test tells them apart. */
  ck_assert_double_gt(worst, 1e-3);
}
END_TEST

/* Two plates, `apart` from each other; the lamp is a part of the lower one. */
typedef struct plates {
  double step, apart, lamp, below, above; /* ρ of both */
} plates;

static plates draw_plates(randoms *r) {
  plates p = {.step = random_between(r, .5, 2)};
  p.apart = p.step * random_between(r, .3, 1.2);
  p.lamp = p.step * random_between(r, .2, .8);
  p.below = random_between(r, .1, .8);
  p.above = random_between(r, .1, .8);
  return p;
}

static hr2d_scene *make_plates(const plates *p) {
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_patch(scene, (hr2d_segment){{0, 0}, {p->lamp, 0}}, 1, p->below, HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{p->lamp, 0}, {p->step, 0}}, 0, p->below,
                 HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{p->step, p->apart}, {0, p->apart}}, 0, p->above,
                 HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){p->step, 0}), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* H above x on the upper plate.  The kernel ½ d²/(d² + x²)^(3/2) has the Fourier transform
   q K₁(q) at q = 2πnd/D, so that coefficient n of B below is E_n/(1 − ρρ'(q K₁(q))²). */
static double plates_irradiance(const plates *p, double x) {
  const double both = p->below * p->above;
  double sum = p->lamp / p->step / (1 - both);
  for (int n = 1; n < 200; n++) {
    const double q = 2 * pi * n * p->apart / p->step;
    if (q > 600) break;
    const double kernel = q * gsl_sf_bessel_K1(q);
    const double e = 2 / (n * pi) * sin(n * pi * p->lamp / p->step);
    sum += kernel * e / (1 - both * kernel * kernel) *
           cos(2 * pi * n * (x - p->lamp / 2) / p->step);
  }
  return sum;
}

START_TEST(endless_plates) {
  const size_t rounds = test_some(300, 10);
  for (size_t k = 0; k < rounds; k++) {
    randoms r = randoms_stream(test_seed(), (int)k);
    const plates p = draw_plates(&r);
    hr2d_scene *scene = make_plates(&p);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *solution;
    hr2d_account account;
    double h[POINTS], b[POINTS];
    target.norm = k % 2 ? HR2D_NORM_SUP : HR2D_NORM_AVERAGE;
    target.error = k % 3 ? 1e-6 : 1e-4;
    target.points = 1;
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
    ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, 2, places, POINTS, h), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather(solution, 2, places, POINTS, b), HR2D_OK);
    const double brightest = 1 + p.below * plates_irradiance(&p, p.lamp / 2),
                 max = plates_irradiance(&p, p.lamp / 2);
    for (int m = 0; m < POINTS; m++) {
      const double right = plates_irradiance(&p, p.step * (1 - places[m]));
      ck_assert_msg(fabs(h[m] - right) <= account.irradiance_sup.bound * max + 1e-14,
                    "plates %zu: H %.17g at %g, not %.17g, bound %g", k, h[m], places[m], right,
                    account.irradiance_sup.bound);
      ck_assert_msg(fabs(b[m] - p.above * right) <= account.sup.bound * brightest + 1e-14,
                    "plates %zu: B %.17g at %g, not %.17g, bound %g", k, b[m], places[m],
                    p.above * right, account.sup.bound);
    }
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("points under periods") {
  ADD_TESTS("points", rows_of_panels, endless_plates);
}
