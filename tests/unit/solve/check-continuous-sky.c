/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Continuous skies against integrals over elevation and azimuth in space.  The latter know
   nothing of a section: the irradiance of a plane, open or beside walls that are long, is
   ∫∫ L (n·ω) cos γ dγ dα over what is not hidden. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

#include "support/support.h"

#define PI     3.14159265358979323846
#define DEGREE (PI / 180)

/* A plane of the section, looking at the sky from between two walls that stand along it. */
typedef struct look {
  hr2d_sky sky;
  double tilt;    /* of the normal towards the scene's +x, below 90 degrees */
  double wall[2]; /* tan of the elevation of the walls across +x and −x */
  double azimuth; /* from +x, of the integral over elevations */
  double power;   /* of a wrong weight cos β, for negative controls; 0 */
  gsl_integration_workspace *space[3];
} look;

static look look_at(hr2d_sky sky) {
  look l = {.sky = sky};
  gsl_set_error_handler_off();
  for (int k = 0; k < 3; k++) l.space[k] = gsl_integration_workspace_alloc(2000);
  return l;
}

static void look_end(look *l) {
  for (int k = 0; k < 3; k++) gsl_integration_workspace_free(l->space[k]);
}

static double vary(double (*f)(double, void *), look *l, int level, double from, double to,
                   double tolerance) {
  gsl_function g = {f, l};
  double value, error;
  if (!(to > from)) return 0;
  gsl_integration_qags(&g, from, to, 1e-15, tolerance, 2000, l->space[level], &value, &error);
  return value;
}

/* From one to the other with a break between them, if it is. */
static double vary_with(double (*f)(double, void *), look *l, int level, double from, double to,
                        double between, double tolerance) {
  if (!(between > from && between < to)) return vary(f, l, level, from, to, tolerance);
  return vary(f, l, level, from, between, tolerance) +
         vary(f, l, level, between, to, tolerance);
}

/* Relative radiance, as the standard has it. */
static double radiance(const hr2d_sky *s, double elevation, double azimuth) {
  const double sun = s->sun_elevation * DEGREE,
               turn = (s->sun_azimuth - s->section_azimuth) * DEGREE - azimuth;
  const double half = sin(0.5 * turn), rise = sin(0.5 * (elevation - sun));
  const double chi =
      2 * asin(fmin(sqrt(rise * rise + cos(elevation) * cos(sun) * half * half), 1));
  const double up = sin(elevation);
  const double gradation = 1 + s->g * up + (s->a != 0 ? s->a * exp(s->b / up) : 0);
  return gradation *
         (1 + s->c * (exp(s->d * chi) - exp(s->d * PI / 2)) + s->e * cos(chi) * cos(chi));
}

/* The azimuth is measured from the scene's +x. */
static double over_elevation(double elevation, void *ctx) {
  const look *l = ctx;
  const double tilt = l->tilt * DEGREE, out = cos(elevation) * cos(l->azimuth);
  const double along = cos(elevation) * sin(l->azimuth);
  const double part = sin(elevation) * cos(tilt) + out * sin(tilt);
  const double wrong = l->power == 0 ? 1 : pow(1 - along * along, 0.5 * l->power);
  return radiance(&l->sky, elevation, l->azimuth) * part * cos(elevation) * wrong;
}

/* From the plane, or the wall. */
static double over_azimuth(double azimuth, void *ctx) {
  look *l = ctx;
  const double across = cos(azimuth), tilt = tan(l->tilt * DEGREE);
  const double plane = atan(-tilt * across),
               wall = atan(fmax(across * l->wall[0], -across * l->wall[1]));
  l->azimuth = azimuth;
  return vary_with(over_elevation, l, 0, fmax(fmax(plane, wall), 0), PI / 2,
                   l->sky.sun_elevation * DEGREE, 1e-13);
}

/* Relative H of the plane. */
static double hemisphere(look *l) {
  const double sun = remainder(l->sky.sun_azimuth - l->sky.section_azimuth, 360) * DEGREE;
  double from = -PI, sum = 0;
  for (int k = -1; k <= 2; k++) {
    const double to = k < 2 ? 0.5 * PI * k : PI;
    sum += vary_with(over_azimuth, l, 1, from, to, sun, 1e-12);
    from = to;
  }
  return sum;
}

/* For an irradiance of 1 of a horizontal surface. */
static double scale_of(look *l) {
  look open = *l;
  open.tilt = open.wall[0] = open.wall[1] = open.power = 0;
  return 1 / hemisphere(&open);
}

static hr2d_sky cie(int type, double elevation, double azimuth) {
  hr2d_sky sky = HR2D_SKY_INIT;
  sky.irradiance = 1;
  sky.sun_elevation = elevation;
  sky.sun_azimuth = azimuth;
  sky.section_azimuth = 90;
  ck_assert_int_eq(hr2d_sky_cie(type, &sky), HR2D_OK);
  return sky;
}

/* Beside an edge of a disc or a band H goes on like x^1.5: not every target is reached. */
static hr2d_solution *solve(hr2d_scene *scene, double error, hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  test_commit(scene);
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
  ck_assert(!status || (status == HR2D_EACCURACY && error < 2e-8));
  return solution;
}

static void set_sky(hr2d_scene *scene, hr2d_sky sky) {
  ck_assert_msg(!hr2d_scene_set_continuous_sky(scene, &sky, 1), "%s",
                hr2d_scene_message(scene));
}

/* H of a panel whose normal leans towards +x by `tilt`: its average, and at a point. */
static void open_panel(hr2d_sky sky, double tilt, double *average, double *at) {
  const double t = .3, angle = -tilt * DEGREE;
  const hr2d_segment panel = {{0, 0}, {cos(angle), sin(angle)}};
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_account account;
  ck_assert_int_eq(test_add_patch(scene, panel, 0, 0, HR2D_SIDES_FRONT), HR2D_OK);
  set_sky(scene, sky);
  hr2d_solution *solution = solve(scene, 1e-9, &account);
  *average = hr2d_solution_irradiance(solution, 0, 0);
  ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, 0, &t, 1, at), HR2D_OK);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}

static const double suns[][2] = {{35, 40}, {5, 170}, {62, 270}, {20, 0}};

/* What a plane gets does not depend on the section in which it is looked at. */
START_TEST(open_planes_are_hemispheres) {
  static const double tilt[] = {0, 30, -55, 85};
  const double *sun = suns[_i % 4];
  look l = look_at(cie(_i + 1, sun[0], sun[1]));
  const double scale = scale_of(&l);
  for (size_t k = 0; k < sizeof tilt / sizeof *tilt; k++) {
    double average, at;
    open_panel(l.sky, tilt[k], &average, &at);
    l.tilt = tilt[k];
    l.power = 0;
    const double h = scale * hemisphere(&l);
    ck_assert_double_eq_tol(average, h, 1e-10);
    ck_assert_double_eq_tol(at, h, 1e-10);
    for (int wrong = -1; wrong <= 1; wrong += 2) {
      l.power = wrong; /* cos β or cos³β, made 1 again at tilt 0 */
      look level = l;
      level.tilt = 0;
      const double other = hemisphere(&l) / hemisphere(&level);
      if (tilt[k] != 0 && _i != 4) ck_assert_double_gt(fabs(other - h), 1e-7);
    }
  }
  look_end(&l);
}
END_TEST

/* A street of walls of 1 and 1.7 along both sides of a ground from 0 to 2, all black. */
static const double wide = 2, high[2] = {1.7, 1};

static hr2d_scene *street(double rho) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_segment part[] = {
      {{0, 0}, {wide, 0}}, {{wide, 0}, {wide, high[0]}}, {{0, high[1]}, {0, 0}}};
  for (int k = 0; k < 3; k++)
    ck_assert_int_eq(test_add_patch(scene, part[k], 0, rho, HR2D_SIDES_FRONT), HR2D_OK);
  return scene;
}

static double over_ground(double x, void *ctx) {
  look *l = ctx;
  l->wall[0] = high[0] / (wide - x);
  l->wall[1] = high[1] / x;
  return hemisphere(l);
}

/* A few types, as one integral in three variables takes seconds. */
static const int in_street[] = {1, 4, 12, 15};

START_TEST(streets_hide_what_they_hide_in_space) {
  const double *sun = suns[_i % 4];
  look l = look_at(cie(in_street[_i], sun[0], sun[1]));
  const double scale = scale_of(&l);
  hr2d_scene *scene = street(0);
  hr2d_account account;
  set_sky(scene, l.sky);
  hr2d_solution *solution = solve(scene, 1e-11, &account);
  for (int k = 0; k < 5; k++) {
    const double t = (k + .37) / 5;
    double at;
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, 0, &t, 1, &at), HR2D_OK);
    ck_assert_double_eq_tol(at, scale * over_ground(t * wide, &l), 1e-10);
  }
  const double mean = scale / wide * vary(over_ground, &l, 2, 0, wide, 1e-11);
  ck_assert_double_eq_tol(hr2d_solution_irradiance(solution, 0, 0), mean, 1e-10);
  ck_assert_double_lt(account.irradiance.bound, 1e-9);
  l.power = 1;
  ck_assert_double_gt(fabs(scale * over_ground(1, &l) - mean), 1e-3);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  look_end(&l);
}
END_TEST

/* A uniform sky is the piece of the dome of the same radiosity, interreflection and all. */
START_TEST(a_uniform_sky_is_a_dome) {
  static const hr2d_sky_piece dome = {-90, 90};
  const double one = 1;
  double h[2][3];
  for (int kind = 0; kind < 2; kind++) {
    hr2d_scene *scene = street(.6);
    hr2d_account account;
    if (kind)
      set_sky(scene, cie(5, 30, 0));
    else
      ck_assert_int_eq(hr2d_scene_set_sky(scene, &dome, 1, &one, 1), HR2D_OK);
    hr2d_solution *solution = solve(scene, 1e-11, &account);
    for (size_t k = 0; k < 3; k++) h[kind][k] = hr2d_solution_irradiance(solution, k, 0);
    ck_assert_double_eq_tol(hr2d_scene_sky(scene, 17, 0), 1, 1e-14);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  for (size_t k = 0; k < 3; k++) ck_assert_double_eq_tol(h[1][k], h[0][k], 1e-13);
}
END_TEST

/* The disc is a sun of many directions, and the band lights vertical planes from all around. */
START_TEST(discs_and_bands_have_closed_forms) {
  for (int k = 0; k < 4; k++) {
    hr2d_sky sky = HR2D_SKY_INIT;
    double average, at;
    sky.sun_elevation = 50 - k;
    sky.sun_azimuth = 30 * k;
    sky.section_azimuth = 75;
    sky.disc_irradiance = 3;
    sky.disc_radius = 2.5 + 4 * k;
    const double turn = (sky.sun_azimuth - sky.section_azimuth) * DEGREE,
                 rise = sky.sun_elevation * DEGREE;
    for (int tilt = -20; tilt <= 20; tilt += 20) {
      open_panel(sky, tilt, &average, &at);
      const double cosine =
          sin(rise) * cos(tilt * DEGREE) + cos(rise) * cos(turn) * sin(tilt * DEGREE);
      ck_assert_double_eq_tol(average, 3 * cosine, 1e-11);
      ck_assert_double_eq_tol(at, 3 * cosine, 1e-11);
    }
    sky.disc_irradiance = 0;
    sky.horizon_irradiance = 2;
    sky.horizon_height = 1.5 + 20 * k;
    open_panel(sky, k % 2 ? 90 : -90, &average, &at);
    ck_assert_double_eq_tol(average, 2, 1e-11);
    const double top = sky.horizon_height * DEGREE;
    open_panel(sky, 0, &average, &at);
    ck_assert_double_eq_tol(at, 2 * PI * sin(top) * sin(top) / (top + sin(top) * cos(top)),
                            1e-11);
  }
}
END_TEST

/* M and Φ of a point: Φ·n is H(n) − H(−n) of planes, and M is that of hr2d_scene_sky(). */
START_TEST(fields_are_those_of_planes) {
  look l = look_at(cie(12, 35, 40));
  const double scale = scale_of(&l);
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_account account;
  const hr2d_point at = {3, 4};
  double mean, flux[2], sum = 0;
  enum { STEPS = 20000 };
  test_add_black(scene, (const double[]){0, -1e-3, 1e-12, -1e-3});
  set_sky(scene, l.sky);
  hr2d_solution *solution = solve(scene, 1e-3, &account);
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  values.mean = &mean;
  values.flux = flux;
  ck_assert_int_eq(hr2d_field_at(solution, &at, 1, NULL, &values), HR2D_OK);
  for (int k = 0; k < STEPS; k++)
    sum += hr2d_scene_sky(scene, -90 + 180 * (k + .5) / STEPS, 0) / (2 * STEPS);
  ck_assert_double_eq_tol(mean, sum, 1e-7);
  l.tilt = 30;
  const double front = scale * hemisphere(&l);
  double h, back;
  open_panel(l.sky, 30 - 180, &back, &h);
  ck_assert_double_eq_tol(flux[1], 1, 1e-10);
  ck_assert_double_eq_tol(.5 * flux[0] + sqrt(.75) * flux[1], front - back, 1e-10);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  look_end(&l);
}
END_TEST

/* The model in the form of the paper, with some of its coefficients. */
static double by_perez(const double *x, double elevation, double chi) {
  return (1 + x[0] * exp(x[1] / sin(elevation))) *
         (1 + x[2] * exp(x[3] * chi) + x[4] * cos(chi) * cos(chi));
}

START_TEST(perez_has_its_coefficients) {
  /* ε, Δ, γ_s; a to e by hand from table 1. */
  const double z1 = 60 * DEGREE, z2 = 40 * DEGREE, z3 = 50 * DEGREE;
  const struct {
    double clearness, brightness, elevation, x[5];
  } row[] = {
      {1.03,
       .3,
       30,
       {1.3525 - .2576 * z1 + .3 * (-.269 - 1.4366 * z1),
        -.767 + .0007 * z1 + .3 * (1.2734 - .1233 * z1),
        exp(pow(.3 * (2.8 + .6004 * z1), 1.2375)) - 1,
        -exp(.3 * (1.8734 + .6297 * z1)) + .9738 + .3 * .2809,
        .0356 - .1246 * z1 + .3 * (-.5718 + .9938 * z1)}},
      {2.1,
       .25,
       50,
       {-.6 - .3566 * z2 + .25 * (-2.5 + 2.325 * z2),
        .2937 + .0496 * z2 + .25 * (-5.6812 + 1.8415 * z2),
        21 - 4.7656 * z2 + .25 * (-21.5906 + 7.2492 * z2),
        -3.5 - .1554 * z2 + .25 * (1.4062 + .3988 * z2),
        .0032 + .0766 * z2 + .25 * (-.0656 - .1294 * z2)}},
      {9,
       .1,
       40,
       {-1.05 + .0289 * z3 + .1 * (.426 + .359 * z3),
        -.325 + .1156 * z3 + .1 * (.7781 + .0025 * z3),
        31.0625 - 14.5 * z3 + .1 * (-46.1148 + 55.375 * z3),
        -7.2312 + .405 * z3 + .1 * (13.35 + .6234 * z3),
        1.5 - .6426 * z3 + .1 * (1.8564 + .5636 * z3)}},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    hr2d_sky sky = HR2D_SKY_INIT;
    sky.irradiance = 5;
    sky.sun_elevation = row[k].elevation;
    ck_assert_int_eq(hr2d_sky_perez(row[k].clearness, row[k].brightness, &sky), HR2D_OK);
    const double zenith = hr2d_sky_radiance(&sky, 90, 0),
                 model = by_perez(row[k].x, PI / 2, (90 - row[k].elevation) * DEGREE);
    for (int turn = 0; turn < 2; turn++)
      for (double up = 5; up < 90; up += 17) {
        const double chi = (turn ? 180 - up - row[k].elevation : fabs(up - row[k].elevation));
        ck_assert_double_eq_tol(hr2d_sky_radiance(&sky, up, 180 * turn) / zenith,
                                by_perez(row[k].x, up * DEGREE, chi * DEGREE) / model, 1e-12);
      }
    look l = look_at(sky);
    ck_assert_double_eq_tol(5 * scale_of(&l) * radiance(&l.sky, PI / 2, 0), zenith, 1e-10);
    look_end(&l);
  }
}
END_TEST

/* (D + I)/D = 5 at Z = 60°: (5 + κ)/(1 + κ) with κ = 1.041 Z³. */
START_TEST(clearness_is_that_of_irradiances) {
  const double z = PI / 3, kappa = 1.041 * z * z * z;
  double delta;
  ck_assert_double_eq_tol(hr2d_sky_clearness(100, 400, 1361, 30, &delta),
                          (5 + kappa) / (1 + kappa), 1e-14);
  ck_assert_double_eq_tol(delta, 100. / 1361 / (.5 + .15 * pow(93.885 - 60, -1.253)), 1e-14);
  ck_assert_double_nan(hr2d_sky_clearness(0, 400, 1361, 30, &delta));
  ck_assert_double_nan(delta);
}
END_TEST

/* The errors that are told hold beside a far smaller one, and a coarse sky is off by no more
   than its tolerance. */
START_TEST(targets_and_tolerances_hold) {
  double best[3];
  for (int k = 0; k < 6; k++) {
    hr2d_scene *scene = street(.5);
    hr2d_account account;
    hr2d_sky sky = cie(13, 35, 100);
    sky.disc_irradiance = .5;
    sky.disc_radius = 5;
    sky.horizon_irradiance = .1;
    sky.horizon_height = 6.5;
    sky.tolerance = k == 5 ? 1e-4 : 0;
    set_sky(scene, sky);
    ck_assert_uint_gt(hr2d_scene_sky_pieces(scene), 4);
    hr2d_solution *solution =
        solve(scene, k == 0 || k == 5 ? 1e-11 : pow(10, -2 * k), &account);
    for (size_t m = 0; m < 3; m++) {
      const double h = hr2d_solution_irradiance(solution, m, 0);
      if (k == 0) best[m] = h;
      const double off = fabs(h / best[m] - 1);
      if (k == 5)
        ck_assert_double_le(off, 5e-4);
      else
        ck_assert_double_le(off, account.irradiance.bound + 1e-11);
    }
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Each band as alone; pieces are shared. */
START_TEST(bands_have_their_skies) {
  hr2d_sky sky[3] = {cie(1, 0, 0), cie(12, 35, 40), cie(15, 60, 200)};
  hr2d_scene *all = street(.5);
  hr2d_account account;
  sky[1].irradiance = 100;
  ck_assert_int_eq(hr2d_scene_set_continuous_sky(all, sky, 3), HR2D_OK);
  hr2d_solution *of_all = solve(all, 1e-10, &account);
  for (size_t b = 0; b < 3; b++) {
    hr2d_scene *scene = street(.5);
    set_sky(scene, sky[b]);
    hr2d_solution *solution = solve(scene, 1e-10, &account);
    for (size_t k = 0; k < 3; k++)
      ck_assert_double_eq_tol(hr2d_solution_irradiance(of_all, k, b),
                              hr2d_solution_irradiance(solution, k, 0),
                              1e-9 * sky[b].irradiance);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  hr2d_solution_destroy(of_all);
  hr2d_scene_destroy(all);
}
END_TEST

/* Under a period whose images are cut off, only a sky that is constant at the horizon. */
START_TEST(skies_past_images_are_refused) {
  for (int k = 0; k < 3; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    const hr2d_segment ground = {{0, 0}, {1, 0}}, plate = {{.2, .5}, {.4, .5}};
    ck_assert_int_eq(test_add_patch(scene, ground, 0, .5, HR2D_SIDES_FRONT), HR2D_OK);
    ck_assert_int_eq(test_add_patch(scene, plate, 0, .5, HR2D_SIDES_BOTH), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
    set_sky(scene, cie(k == 0 ? 12 : k == 1 ? 1 : 5, 35, 40));
    ck_assert_int_eq(hr2d_scene_commit(scene), k == 0 ? HR2D_EUNSUPPORTED : HR2D_OK);
    if (k == 0)
      ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), "continuous sky varies"));
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A mirror along +y needs the sun in the plane of it, or none. */
START_TEST(mirrors_need_symmetric_skies) {
  static const hr2d_segment mirror = {{1, 0}, {1, 1}}, half = {{0, 0}, {1, 0}},
                            whole = {{0, 0}, {2, 0}};
  for (int k = 0; k < 2; k++) {
    double h[2];
    for (int halves = 0; halves < 2; halves++) {
      hr2d_scene *scene = test_new_scene(NULL);
      hr2d_account account;
      const hr2d_segment wall = {{0, 2}, {0, 0}}, other = {{2, 0}, {2, 2}};
      test_add_patch(scene, halves ? half : whole, 0, .5, HR2D_SIDES_FRONT);
      test_add_patch(scene, wall, 0, .5, HR2D_SIDES_FRONT);
      if (!halves) test_add_patch(scene, other, 0, .5, HR2D_SIDES_FRONT);
      if (halves) ck_assert_int_eq(hr2d_scene_add_mirror(scene, mirror), HR2D_OK);
      set_sky(scene, cie(12, 35, k ? 40 : 0)); /* +x is in the azimuth 90 */
      if (k && halves) {
        ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
        h[1] = h[0];
      } else {
        hr2d_solution *solution = solve(scene, 1e-9, &account);
        h[halves] = hr2d_solution_irradiance(solution, 0, 0);
        hr2d_solution_destroy(solution);
      }
      hr2d_scene_destroy(scene);
    }
    ck_assert_double_eq_tol(h[1], h[0], 1e-8);
  }
}
END_TEST

/* An operator keeps it. */
START_TEST(operators_keep_the_sky) {
  hr2d_scene *scene = street(.5);
  hr2d_operator *op = NULL;
  hr2d_solution *solution = NULL, *own;
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_light light = HR2D_LIGHT_INIT;
  hr2d_account account;
  static const double value[720] = {1}, emission[3] = {2, 2, 2};
  set_sky(scene, cie(12, 35, 40));
  own = solve(scene, 1e-8, &account);
  target.error = 1e-8;
  ck_assert_int_eq(hr2d_operator_create(scene, &target, &op, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_operator_solve(op, NULL, NULL, &solution, NULL), HR2D_OK);
  ck_assert_double_eq_tol(hr2d_solution_average(solution, 0, 0),
                          hr2d_solution_average(own, 0, 0), 1e-8);
  hr2d_solution_destroy(solution);
  solution = NULL;
  light.sky.value = value;
  ck_assert_int_eq(hr2d_operator_solve(op, &light, NULL, &solution, NULL), HR2D_EINVAL);
  light.sky.value = NULL;
  light.emission.value = emission;
  ck_assert_int_eq(hr2d_operator_solve(op, &light, NULL, &solution, NULL), HR2D_OK);
  ck_assert_double_gt(hr2d_solution_average(solution, 0, 0), 2);
  hr2d_solution_destroy(solution);
  hr2d_solution_destroy(own);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(what_is_no_sky_is_refused) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_sky good = cie(12, 35, 40);
  hr2d_sky bad[9], copy = good;
  for (int k = 0; k < 9; k++) bad[k] = good;
  bad[0].irradiance = -1;
  bad[1].sun_elevation = 91;
  bad[2].sun_azimuth = NAN;
  bad[3].disc_irradiance = 1;
  bad[4].horizon_irradiance = 1;
  bad[5].b = .1;
  bad[6].a = -1.5;
  bad[7].c = -5;
  bad[8].tolerance = 1e-15;
  for (int k = 0; k < 9; k++) {
    ck_assert_int_eq(hr2d_scene_set_continuous_sky(scene, &bad[k], 1), HR2D_ESCENE);
    ck_assert_double_nan(hr2d_sky_radiance(&bad[k], 45, 0));
  }
  ck_assert_uint_eq(hr2d_scene_sky_pieces(scene), 0);
  ck_assert_int_eq(hr2d_scene_set_continuous_sky(scene, NULL, 1), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_scene_set_continuous_sky(scene, &good, 1), HR2D_OK);
  ck_assert_uint_gt(hr2d_scene_sky_pieces(scene), 1);
  ck_assert_int_eq(hr2d_scene_set_continuous_sky(scene, NULL, 0), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_sky_pieces(scene), 0);
  ck_assert_int_eq(hr2d_sky_cie(0, &copy), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_sky_cie(17, &copy), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_sky_perez(.9, .1, &copy), HR2D_EINVAL);
  copy.sun_elevation = 80; /* b = .2782 − .1812 Z > 0 for Δ = 0 */
  ck_assert_int_eq(hr2d_sky_perez(1.3, 0, &copy), HR2D_ESCENE);
  ck_assert_double_eq(copy.c, good.c);
  ck_assert_double_nan(hr2d_sky_radiance(&good, 91, 0));
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("continuous sky") {
  REPEAT_TESTS(16, "space", open_planes_are_hemispheres);
  REPEAT_TESTS(4, "space", streets_hide_what_they_hide_in_space);
  ADD_TESTS("forms", a_uniform_sky_is_a_dome, discs_and_bands_have_closed_forms,
            fields_are_those_of_planes);
  ADD_TESTS("models", perez_has_its_coefficients, clearness_is_that_of_irradiances);
  ADD_TESTS("solve", targets_and_tolerances_hold, bands_have_their_skies);
  ADD_TESTS("scenes", skies_past_images_are_refused, mirrors_need_symmetric_skies,
            operators_keep_the_sky);
  ADD_TESTS("calls", what_is_no_sky_is_refused);
}
