/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is seen past the ends of a period: at points, on patches and in the solution.  Against
   closed forms and against sums over 20,000 periods. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define PI 3.14159265358979323846

typedef struct stage {
  hr2d_scene *scene;
  hr2d_solution *solution;
  hr2d_account account;
} stage;

static void add(hr2d_scene *scene, hr2d_point a, hr2d_point b, double emission, double rho,
                hr2d_sides sides) {
  ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){a, b}, emission, rho, sides), HR2D_OK);
}

static stage solve(hr2d_scene *scene, double error) {
  stage s = {.scene = scene};
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = error;
  test_commit(scene);
  const hr2d_status status = hr2d_solve_to(scene, &target, &s.solution, &s.account);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s", s.account.reason);
  return s;
}

static void end(stage *s) {
  hr2d_solution_destroy(s->solution);
  hr2d_scene_destroy(s->scene);
}

typedef struct light {
  double mean, flux[2], error, sky, back, cut_off;
  unsigned char place;
} light;

static light light_at(const stage *s, double x, double y) {
  light l;
  double *none =
      calloc(hr2d_scene_patches(s->scene) * hr2d_scene_bands(s->scene), sizeof *none);
  const hr2d_point at = {x, y};
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  options.patch_error = none;
  const hr2d_field_values values = {.struct_size = sizeof values,
                                    .mean = &l.mean,
                                    .flux = l.flux,
                                    .error = &l.error,
                                    .sky = &l.sky,
                                    .back = &l.back,
                                    .place = &l.place,
                                    .cut_off = &l.cut_off};
  ck_assert_int_eq(hr2d_field_at(s->solution, &at, 1, &options, &values), HR2D_OK);
  free(none);
  return l;
}

/* Two plates with a gap of 1, and patches of length 1. */
static hr2d_scene *plates(void) {
  hr2d_scene *scene = test_new_scene(NULL);
  add(scene, (hr2d_point){0, 0}, (hr2d_point){1, 0}, 1, .5, HR2D_SIDES_FRONT);
  add(scene, (hr2d_point){1, 1}, (hr2d_point){0, 1}, 0, .7, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
  return scene;
}

/* M = (B₁ + B₂)/2 and Φ = B₂ − B₁ across, everywhere. */
START_TEST(between_plates_light_is_the_same_everywhere) {
  static const double at[][2] = {{.5, .5}, {.1, .9}, {.77, .01}, {7.3, .5}, {-1000.25, .3}};
  stage s = solve(plates(), 1e-6);
  const double b[2] = {1 / .65, .7 / .65};
  for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
    const light l = light_at(&s, at[k][0], at[k][1]);
    ck_assert_double_gt(l.cut_off, 1e-3);
    ck_assert_double_eq_tol(l.mean, (b[0] + b[1]) / 2, 2e-6);
    ck_assert_double_eq_tol(l.flux[0], 0, 5e-6);
    ck_assert_double_eq_tol(l.flux[1], b[1] - b[0], 5e-6);
    /* What is past the ends is worth a thousand times as much. */
    ck_assert_double_gt(l.cut_off * b[1], 1e3 * fabs(l.mean - (b[0] + b[1]) / 2));
  }
  end(&s);
}
END_TEST

START_TEST(plates_light_each_other_at_points) {
  stage s = solve(plates(), 1e-6);
  static const double t[] = {0, .1, .5, 1};
  double h[4];
  for (size_t k = 0; k < 2; k++) {
    ck_assert_int_eq(hr2d_solution_gather_irradiance(s.solution, k, t, 4, h), HR2D_OK);
    for (int m = 0; m < 4; m++) ck_assert_double_eq_tol(h[m], (k ? 1 : .7) / .65, 2e-6);
  }
  end(&s);
}
END_TEST

/* Horizontal panels from x = 0 to .5 at a height of 1 above ground, under a sky of 1.  What the
   ground and the panels send to each other is the same, and all of the sides below is seen from
   the ground: H there is 1 less the part of the panels. */
static hr2d_scene *panels(hr2d_sides sides, int pieces, double turn) {
  const double one = 1, c = cos(turn), s = sin(turn);
  const double h = -180 / PI * turn; /* the bearing of what was north */
  const hr2d_sky_piece piece[] = {{h - 90, h - 30}, {h - 30, h + 50}, {h + 50, h + 90}};
  const double value[] = {1, 1, 1};
  hr2d_scene *scene = test_new_scene(NULL);
  add(scene, (hr2d_point){0, 0}, (hr2d_point){c, s}, 0, 0, HR2D_SIDES_FRONT);
  add(scene, (hr2d_point){-s, c}, (hr2d_point){.5 * c - s, .5 * s + c}, 0, 0, sides);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){c, s}), HR2D_OK);
  if (pieces)
    ck_assert_int_eq(hr2d_scene_set_sky(scene, piece, 3, value, 1), HR2D_OK);
  else
    ck_assert_int_eq(hr2d_scene_set_background(scene, &one, 1), HR2D_OK);
  return scene;
}

/* ∫ of what shows through the gaps, from a point below the panels: of angles, or of sines over
   2.  Gaps beyond the last ones are so far that their angles are .5 height/distance². */
static double gaps(double x, double height, int sines) {
  enum { MANY = 20000 };
  double sum = 0;
  for (int k = -MANY; k < MANY; k++) {
    const double from = k + .5 - x, to = k + 1 - x;
    sum += sines ? (to / hypot(to, height) - from / hypot(from, height)) / 2
                 : (atan2(to, height) - atan2(from, height)) / (2 * PI);
  }
  const double right = MANY + .25 - x, left = MANY - .25 + x;
  return sines ? sum : sum + .5 * height * (1 / right + 1 / left) / (2 * PI);
}

START_TEST(the_sky_shows_between_panels) {
  const hr2d_sides sides = _i % 2 ? HR2D_SIDES_FRONT : HR2D_SIDES_BOTH;
  const double turn = _i / 2 % 2 * .7;
  const int pieces = _i / 4;
  stage s = solve(panels(sides, pieces, turn), 1e-6);
  ck_assert_double_gt(hr2d_scene_cut_off(s.scene), 1e-3);
  ck_assert_double_eq_tol(hr2d_solution_irradiance(s.solution, 0, 0), .5, 1e-7);
  ck_assert_double_eq_tol(hr2d_solution_irradiance(s.solution, 1, 0), 1, 1e-12);
  static const double at[][2] = {{.5, .5}, {.1, .9}, {.77, .01}, {17.3, .5}};
  for (size_t k = 0; k < 4; k++) {
    const double x = at[k][0], y = at[k][1];
    const light l = light_at(&s, x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn));
    const double exact = gaps(x - floor(x), 1 - y, 0);
    ck_assert_double_eq_tol(l.mean, exact, 2e-6);
    ck_assert_double_eq_tol(l.sky, exact, 2e-6);
    ck_assert_double_gt(l.cut_off, 1e-3);
    if (sides == HR2D_SIDES_BOTH) ck_assert_double_eq_tol(l.back, 0, 4e-6);
  }
  static const double t[] = {.1, .5, .9};
  double h[3];
  ck_assert_int_eq(hr2d_solution_gather_irradiance(s.solution, 0, t, 3, h), HR2D_OK);
  for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(h[k], gaps(t[k], 1, 1), 1e-6);
  end(&s);
}
END_TEST

/* Without a target, at order 1: closure must not make fronts of the sky. */
START_TEST(the_sky_shows_without_a_target) {
  hr2d_scene *scene = panels(_i ? HR2D_SIDES_FRONT : HR2D_SIDES_BOTH, 0, 0);
  test_commit(scene);
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(links, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(links, NULL, &solution), HR2D_OK);
  ck_assert_double_eq_tol(hr2d_solution_irradiance(solution, 0, 0), .5, 1e-6);
  const size_t elements = hr2d_hierarchy_count(hierarchy).elements;
  double *front = calloc(elements, sizeof *front), *back = calloc(elements, sizeof *back);
  ck_assert_int_eq(hr2d_leaf_sums(hierarchy, 0, 1, front, back), HR2D_OK);
  const hr2d_element *e = hr2d_hierarchy_elements(hierarchy);
  double sum[2] = {0, 0};
  for (size_t k = 0; k < elements; k++)
    if (e[k].patch == 0 && !e[k].child) {
      sum[0] += front[k] * e[k].length / e[0].length;
      sum[1] += back[k] * e[k].length / e[0].length;
    }
  ck_assert_double_eq_tol(sum[0], _i ? 0 : .5, 1e-6);
  ck_assert_double_eq_tol(sum[1], _i ? .5 : 0, 1e-6);
  free(front);
  free(back);
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A piece that ends a degree above the horizon, where patches see it past the ends only. */
START_TEST(low_edges_of_the_sky_are_refused) {
  const hr2d_sky_piece piece = {-89, 89};
  const double value = 1;
  hr2d_scene *scene = panels(HR2D_SIDES_BOTH, 1, 0);
  ck_assert_int_eq(hr2d_scene_set_sky(scene, &piece, 1, &value, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_EUNSUPPORTED);
  ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), "-89 degrees"));
  hr2d_scene_destroy(scene);
}
END_TEST

/* A street with houses; all is white in a sky of 1.  Patches see nothing past the next street,
   but points above the roofs do. */
static hr2d_scene *street(double rho, double background) {
  static const double at[][2] = {{0, 0}, {12, 0}, {12, 9}, {20, 9}, {20, 0}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < 4; k++)
    add(scene, (hr2d_point){at[k][0], at[k][1]}, (hr2d_point){at[k + 1][0], at[k + 1][1]},
        1 - rho, rho, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){20, 0}), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &background, 1), HR2D_OK);
  return scene;
}

START_TEST(above_streets_a_furnace_is_a_furnace) {
  static const double at[][2] = {{5, .1}, {5, 8.99}, {5, 9.01}, {13, 9.01},
                                 {5, 12}, {25, 15},  {-133, 30}};
  stage s = solve(street(.6, 1), 1e-8);
  ck_assert(hr2d_scene_cut_off(s.scene) == 0);
  for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
    const light l = light_at(&s, at[k][0], at[k][1]);
    ck_assert_double_eq_tol(l.mean, 1, 3e-6);
    if (at[k][1] > 9) ck_assert_double_eq_tol(l.back, 0, 3e-6);
    ck_assert_double_eq_tol(l.flux[0], 0, 2e-5);
    ck_assert_double_eq_tol(l.flux[1], 0, 2e-5);
    if (at[k][1] > 9) ck_assert_double_eq_tol(l.sky, .5, 1e-14);
    ck_assert(l.cut_off > 0 || at[k][1] < 9);
  }
  /* From too far for a series the light past the ends is about that of the last images. */
  const light far = light_at(&s, 5, 1000);
  ck_assert_double_eq_tol(far.mean, 1, 1e-12);
  ck_assert_double_ge(far.error, far.cut_off);
  end(&s);
}
END_TEST

/* Under a dark sky half of all directions are dark above the roofs, and the rest is what houses
   and streets send upwards: the mean over a period does not depend on the height. */
START_TEST(what_goes_up_is_the_same_at_every_height) {
  enum { POINTS = 400 };
  stage s = solve(street(.6, 0), 1e-8);
  double mean[2] = {0, 0}, up[2] = {0, 0};
  for (int h = 0; h < 2; h++)
    for (int k = 0; k < POINTS; k++) {
      const light l = light_at(&s, 20 * (k + .5) / POINTS, h ? 30 : 15);
      mean[h] += l.mean / POINTS;
      up[h] -= l.flux[1] / POINTS;
    }
  ck_assert_double_eq_tol(mean[0], mean[1], 2e-5);
  ck_assert_double_eq_tol(up[0], up[1], 2e-5);
  ck_assert_double_eq_tol(20 * up[1], hr2d_solution_power(s.solution, 0).escaped, 20 * 2e-5);
  end(&s);
}
END_TEST

/* From above raised panels the ground shows in gaps here and there, with no series: what is
   past the ends is between nothing and the most, and right where all is the same. */
START_TEST(gaps_far_away_have_bounds) {
  hr2d_scene *scene = test_new_scene(NULL);
  add(scene, (hr2d_point){0, 0}, (hr2d_point){1, 0}, 1, 0, HR2D_SIDES_FRONT);
  add(scene, (hr2d_point){0, 1}, (hr2d_point){.5, 1}, _i ? 0 : 1, 0, HR2D_SIDES_BOTH);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
  stage s = solve(scene, 1e-6);
  const light l = light_at(&s, .3, 1.7);
  ck_assert_double_gt(l.cut_off, .01);
  if (!_i) ck_assert_double_eq_tol(l.mean, .5, 1e-12);
  /* Half of what is past the ends is panels, half ground. */
  if (_i) ck_assert_double_eq_tol(l.error, l.cut_off, 1e-12);
  ck_assert_double_ge(l.error, l.cut_off);
  end(&s);
}
END_TEST

/* Tilted black panels under a low sun, one cell with a period, or many towards the sun. */
static stage tilted(hr2d_sun sun, int repeats) {
  hr2d_scene *scene = test_new_scene(NULL);
  const int towards = sun.direction.x > 0 ? -1 : 1;
  for (int k = repeats ? 0 : -3; k < (repeats ? 1 : 330); k++)
    add(scene, (hr2d_point){towards * k, 1}, (hr2d_point){towards * k + .5, 1.02}, 0, 0,
        HR2D_SIDES_BOTH);
  if (repeats) ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  return solve(scene, 1e-3);
}

/* Far below the panels a sun shines past hundreds of them, or does not. */
START_TEST(suns_shine_past_the_last_images) {
  const hr2d_sun sun = {{_i ? -10 : 10, -1}, 7};
  stage one = tilted(sun, 1), many = tilted(sun, 0);
  const size_t half = hr2d_scene_images(one.scene) / 2;
  int lit = 0, count = 0;
  for (double x = .013; x < 1; x += .05, count++)
    for (double y = -25; y < -20; y += 2.3) {
      const light l = light_at(&one, x, y), m = light_at(&many, x, y);
      ck_assert_double_gt((1 - y) * 10, (double)half);
      ck_assert_int_eq(l.place, HR2D_PLACE_BETWEEN);
      ck_assert_double_eq_tol(l.mean, m.mean, 1e-12);
      ck_assert_double_eq_tol(l.flux[0], m.flux[0], 1e-12);
      ck_assert_double_eq_tol(l.flux[1], m.flux[1], 1e-12);
      lit += l.mean > 0;
    }
  ck_assert_int_gt(lit, 0);
  ck_assert_int_lt(lit, 3 * count);
  end(&one);
  end(&many);
}
END_TEST

/* A piece of the sky that reaches below the horizon is hidden by houses there, so that it is
   like one that does not: within the bound. */
START_TEST(edges_of_the_sky_past_the_ends_have_bounds) {
  const double value = 1;
  stage s[2];
  for (int k = 0; k < 2; k++) {
    const hr2d_sky_piece piece = {k ? -90 : -90.01, k ? 90 : 90.01};
    hr2d_scene *scene = street(.6, 0);
    ck_assert_int_eq(hr2d_scene_set_sky(scene, &piece, 1, &value, 1), HR2D_OK);
    s[k] = solve(scene, 1e-6);
  }
  for (double y = 9.7; y < 40; y *= 1.7) {
    const light low = light_at(&s[0], 4.2, y), right = light_at(&s[1], 4.2, y);
    ck_assert_int_eq(low.place, HR2D_PLACE_BETWEEN);
    ck_assert_double_le(fabs(low.mean - right.mean), low.error + right.error + 1e-6);
    ck_assert_double_gt(low.error, right.error);
    ck_assert_double_le(low.error, 2 * low.cut_off);
  }
  for (int k = 0; k < 2; k++) end(&s[k]);
}
END_TEST

/* A row of a point. */
typedef struct kept {
  double share[4], factor[4], sum, factors;
  hr2d_field_row row;
} kept;

static hr2d_status take(void *ctx, const hr2d_field_row *row) {
  kept *k = ctx;
  *k = (kept){
      .row = *row, .sum = row->sky + row->back, .factors = row->sky_factor + row->back_factor};
  for (size_t p = 0; p < row->count; p++) {
    ck_assert_uint_lt(row->patch[p], 4);
    k->sum += k->share[row->patch[p]] = row->share[p];
    k->factors += k->factor[row->patch[p]] = row->factor[p];
  }
  return HR2D_OK;
}

/* Rows sum to 1 and have the light that points have. */
START_TEST(rows_of_points_have_all_images) {
  static const double at[][2] = {{.5, .5}, {.1, .9}, {.77, .2}, {7.3, .5}, {.3, 1.7}};
  stage s = solve(_i == 2   ? street(.3, 2)
                  : _i == 1 ? panels(HR2D_SIDES_BOTH, 0, 0)
                            : plates(),
                  1e-6);
  const hr2d_point normal = {.6, .8}, away = {-.6, -.8};
  const double sky = _i == 2 ? 2 : _i;
  for (size_t k = 0; k < (_i ? 5 : 4); k++) {
    const hr2d_point x = {at[k][0] * (_i == 2 ? 20 : 1), at[k][1] * (_i == 2 ? 9 : 1)};
    const light l = light_at(&s, x.x, x.y);
    double h[2] = {0, 0}, mean = 0;
    for (int m = 0; m < 2; m++) {
      kept r;
      ck_assert_int_eq(
          hr2d_field_rows_visit(s.scene, &x, m ? &away : &normal, 1, NULL, take, &r), HR2D_OK);
      ck_assert_double_eq_tol(r.sum, 1, 2e-6);
      ck_assert_double_eq_tol(r.factors, 1, 2e-6);
      ck_assert_double_eq_tol(r.row.sky, l.sky, 1e-13);
      ck_assert_double_eq_tol(r.row.back, l.back, 1e-13);
      mean = sky * r.row.sky;
      h[m] = sky * r.row.sky_factor;
      for (size_t p = 0; p < hr2d_scene_patches(s.scene); p++) {
        mean += r.share[p] * hr2d_solution_average(s.solution, p, 0);
        h[m] += r.factor[p] * hr2d_solution_average(s.solution, p, 0);
      }
    }
    if (_i == 2) continue; /* B is not constant on its patches */
    ck_assert_double_eq_tol(mean, l.mean, 1e-7);
    ck_assert_double_eq_tol(h[0] - h[1], .6 * l.flux[0] + .8 * l.flux[1], 1e-6);
  }
  end(&s);
}
END_TEST

/* Nodes of a grid are what points are, within the tolerance, also far from the cell. */
START_TEST(grids_repeat_themselves) {
  enum { SIDE = 40 };
  static double mean[2][SIDE * SIDE];
  stage s = solve(street(.6, 0), 1e-6);
  for (int k = 0; k < 2; k++) {
    hr2d_field_grid grid = HR2D_FIELD_GRID_INIT;
    grid.low = (hr2d_point){k * 2000., 1};
    grid.high = (hr2d_point){k * 2000. + 40, 30};
    grid.columns = grid.rows = SIDE;
    grid.tolerance = k ? 0 : 1e-3;
    hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
    values.mean = mean[k];
    ck_assert_int_eq(hr2d_field_on_grid(s.solution, &grid, NULL, &values, NULL), HR2D_OK);
  }
  for (int k = 0; k < SIDE * SIDE; k++) {
    ck_assert(isnan(mean[0][k]) == isnan(mean[1][k]));
    if (!isnan(mean[0][k])) ck_assert_double_eq_tol(mean[0][k], mean[1][k], 1e-3);
  }
  end(&s);
}
END_TEST

/* From the tip of a panel that is nearly upright all of the far sky is behind it, on one side,
   or above its horizon, on the other.  With its slant H changes by little, also where the sky
   past some image begins at the horizon. */
START_TEST(slants_show_no_more_sky) {
  double former[2] = {0, 0};
  for (int k = 0; k < 120; k++) {
    const double one = 1, slant = .02 + 5e-4 * k, tip = 0;
    hr2d_scene *scene = test_new_scene(NULL);
    add(scene, (hr2d_point){0, 0}, (hr2d_point){1, 0}, 0, 0, HR2D_SIDES_FRONT);
    add(scene, (hr2d_point){.3, .5}, (hr2d_point){.3 + .4 * slant, .9}, 0, 0, HR2D_SIDES_BOTH);
    ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_set_background(scene, &one, 1), HR2D_OK);
    stage s = solve(scene, 1e-2);
    for (size_t side = 0; side < 2; side++) {
      double h;
      const double t = side ? 1 - tip : tip;
      ck_assert_int_eq(hr2d_solution_gather_irradiance(s.solution, 1 + side, &t, 1, &h),
                       HR2D_OK);
      ck_assert_msg(k == 0 || fabs(h - former[side]) < .01, "%g at %g, before %g", h, slant,
                    former[side]);
      former[side] = h;
    }
    end(&s);
  }
}
END_TEST

TEST_SUITE("past ends") {
  ADD_TESTS("plates", between_plates_light_is_the_same_everywhere,
            plates_light_each_other_at_points);
  REPEAT_TESTS(8, "panels", the_sky_shows_between_panels);
  REPEAT_TESTS(2, "order 1", the_sky_shows_without_a_target);
  ADD_TESTS("sky", low_edges_of_the_sky_are_refused, slants_show_no_more_sky);
  ADD_TESTS("streets", above_streets_a_furnace_is_a_furnace,
            what_goes_up_is_the_same_at_every_height, grids_repeat_themselves);
  REPEAT_TESTS(2, "gaps", gaps_far_away_have_bounds);
  REPEAT_TESTS(2, "suns", suns_shine_past_the_last_images);
  ADD_TESTS("edges", edges_of_the_sky_past_the_ends_have_bounds);
  REPEAT_TESTS(3, "rows", rows_of_points_have_all_images);
}
