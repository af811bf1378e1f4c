/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a sun lights: against rays to the sun in long double, and against formulas of rows of
   panels. */
#include <math.h>

#include "support/support.h"

typedef long double real;

enum { MOST = 40, POINTS = 60 };

typedef struct rows {
  hr2d_segment at[MOST];
  size_t count;
} rows;

static real cross(real ux, real uy, real vx, real vy) {
  return ux * vy - uy * vx;
}

/* Where the ray from x towards the sun meets a segment, as t along that and u along the ray in
   units of the direction; *near is how near it comes to missing or meeting it. */
static int meets(hr2d_segment s, real x, real y, hr2d_point d, real *near) {
  const real vx = (real)s.b.x - s.a.x, vy = (real)s.b.y - s.a.y;
  const real across = cross(vx, vy, d.x, d.y);
  const real t = cross(x - s.a.x, y - s.a.y, d.x, d.y) / across;
  const real u = cross(x - s.a.x, y - s.a.y, vx, vy) / across;
  if (u < -1e-12L) *near = fminl(*near, fminl(fabsl(t), fabsl(1 - t)));
  return across != 0 && t > 0 && t < 1 && u < -1e-12L;
}

static real cosine(hr2d_segment s, hr2d_point d) {
  const real vx = (real)s.b.x - s.a.x, vy = (real)s.b.y - s.a.y;
  return cross(d.x, d.y, vx, vy) /
         sqrtl((vx * vx + vy * vy) * ((real)d.x * d.x + (real)d.y * d.y));
}

/* H_sun of irradiance 1 at a point; *near as above. */
static real by_ray(const rows *r, size_t patch, real t, hr2d_point d, real *near) {
  const hr2d_segment s = r->at[patch];
  const real x = s.a.x + t * ((real)s.b.x - s.a.x), y = s.a.y + t * ((real)s.b.y - s.a.y);
  int hidden = 0;
  *near = 1;
  for (size_t k = 0; k < r->count; k++)
    if (k != patch) hidden |= meets(r->at[k], x, y, d, near);
  return hidden ? 0 : fmaxl(cosine(s, d), 0);
}

/* Segments in cells of a grid of their own: they do not cross. */
static rows draw(randoms *r) {
  rows all = {.count = 0};
  for (int k = 0; k < 25; k++) {
    const double x = k % 5, y = k / 5;
    if (random_below(r, 3) == 0) continue;
    all.at[all.count++] =
        (hr2d_segment){{x + random_between(r, .05, .95), y + random_between(r, .05, .95)},
                       {x + random_between(r, .05, .95), y + random_between(r, .05, .95)}};
  }
  all.at[all.count++] = (hr2d_segment){{-3, -0.5}, {9, -0.5}};
  return all;
}

static hr2d_scene *scene_of(const rows *all, const hr2d_sun *sun, size_t suns) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < all->count; k++)
    ck_assert_int_eq(test_add_patch(scene, all->at[k], 0, .5, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_sun(scene, sun, suns), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* Points at which the library and a ray differ. */
static int differences(const hr2d_scene *scene, const rows *all, hr2d_point d, size_t band,
                       randoms *r) {
  int wrong = 0;
  for (size_t k = 0; k < all->count; k++)
    for (int n = 0; n < POINTS; n++) {
      const double t = random_between(r, 0, 1);
      real near;
      const real is = by_ray(all, k, t, d, &near);
      if (near < 1e-12L) continue;
      wrong += fabsl(hr2d_scene_sunlight_at(scene, k, t, band) - is) > 1e-14L;
    }
  return wrong;
}

static hr2d_point draw_direction(randoms *r) {
  static const hr2d_point special[] = {{0, -1}, {1, 0}, {-1, 0}, {0, 1}, {1, -1}, {-1e-9, -1}};
  if (random_below(r, 4) == 0) return special[random_below(r, 6)];
  return (hr2d_point){random_between(r, -1, 1), random_between(r, -1, 1)};
}

START_TEST(rays_to_the_sun_say_the_same) {
  randoms r = randoms_stream(test_seed(), 1);
  int suns = 0, told = 0;
  for (int k = test_count(300) + 20; k > 0; k--) {
    const rows all = draw(&r);
    const hr2d_sun sun[] = {{draw_direction(&r), 1}, {draw_direction(&r), 1}};
    hr2d_scene *scene = scene_of(&all, sun, 2);
    for (size_t b = 0; b < 2; b++) {
      ck_assert_int_eq(differences(scene, &all, sun[b].direction, b, &r), 0);
      /* Negative control: another sun is told apart. */
      const hr2d_point other = {-sun[b].direction.y - 0.3, sun[b].direction.x};
      told += differences(scene, &all, other, b, &r) > 0;
      suns++;
    }
    hr2d_scene_destroy(scene);
  }
  ck_assert_int_gt(told, 9 * suns / 10); /* but where both light nothing */
}
END_TEST

/* The average is the integral of the values: parts add up, whatever the sun. */
START_TEST(parts_add_up_to_averages) {
  randoms r = randoms_stream(test_seed(), 2);
  for (int k = test_count(100) + 10; k > 0; k--) {
    const rows all = draw(&r);
    const hr2d_sun sun = {draw_direction(&r), 3};
    hr2d_scene *scene = scene_of(&all, &sun, 1);
    for (size_t p = 0; p < all.count; p++) {
      double part[MOST][2], lit = 0, cut = random_between(&r, 0.1, 0.9);
      const size_t parts = hr2d_scene_sunlit_parts(scene, p, 0, part, MOST);
      for (size_t n = 0; n < parts; n++) {
        lit += part[n][1] - part[n][0];
        ck_assert_double_gt(part[n][1], part[n][0]);
        ck_assert(n == 0 || part[n][0] > part[n - 1][1]);
      }
      const double mean = hr2d_scene_sunlight(scene, p, 0);
      ck_assert_double_eq_tol(mean, 3 * lit * fmax((double)cosine(all.at[p], sun.direction), 0),
                              1e-14);
      ck_assert_double_eq_tol(mean,
                              cut * hr2d_scene_sunlight_over(scene, p, 0, cut, 0) +
                                  (1 - cut) * hr2d_scene_sunlight_over(scene, p, cut, 1, 0),
                              1e-14);
    }
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Rows of panels of width w and tilt β at a pitch p: the shaded part of a row behind another
   one is 1 − p tan α/(w (cos β tan α + sin β)), if that is positive, for a sun of profile angle
   α in front of the rows (Passias and Källbäck 1984). */
START_TEST(rows_shade_each_other_as_the_formula_says) {
  for (int k = 1; k < 12; k++)
    for (int m = 1; m < 8; m++) {
      const double beta = 0.1 * m, alpha = 0.11 * k, w = 2, p = 3;
      const rows two = {.at = {{{0, 0}, {w * cos(beta), w * sin(beta)}},
                               {{p, 0}, {p + w * cos(beta), w * sin(beta)}}},
                        .count = 2};
      const hr2d_sun sun = {{cos(alpha), -sin(alpha)}, 1000};
      hr2d_scene *scene = scene_of(&two, &sun, 1);
      const double formula = 1 - p * tan(alpha) / (w * (cos(beta) * tan(alpha) + sin(beta)));
      const double incidence = 1000 * sin(alpha + beta);
      ck_assert_double_eq_tol(hr2d_scene_sunlight(scene, 0, 0), incidence, 1e-11);
      ck_assert_double_eq_tol(hr2d_scene_sunlight(scene, 1, 0),
                              incidence * (1 - fmax(formula, 0)), 1e-10);
      hr2d_scene_destroy(scene);
    }
}
END_TEST

/* Light neither passes walls that meet nor stops at a vertex that it passes by. */
START_TEST(walls_that_meet_let_nothing_through) {
  randoms r = randoms_stream(test_seed(), 3);
  for (int k = test_count(200) + 20; k > 0; k--) {
    rows all = {.count = 12};
    const double turn = random_between(&r, 0, 7), size = random_power(&r, -3, 3);
    hr2d_point at[12];
    for (int n = 0; n < 12; n++)
      at[n] =
          (hr2d_point){size * (40 + cos(turn + .52 * n)), size * (17 + sin(turn + .52 * n))};
    for (int n = 0; n < 12; n++) all.at[n] = (hr2d_segment){at[n], at[(n + 1) % 12]};
    /* A screen before the sun: half of it lies on the line of the light through a corner. */
    const hr2d_sun sun = {{at[3].x - at[8].x, at[3].y - at[8].y}, 1};
    hr2d_scene *scene = scene_of(&all, &sun, 1);
    for (size_t p = 0; p < all.count; p++)
      ck_assert_double_eq(hr2d_scene_sunlight(scene, p, 0), 0);
    hr2d_scene_destroy(scene);
    all.count = 11; /* Negative control: a wall is missing. */
    const hr2d_sun in = {{-cos(turn + .52 * 11.5), -sin(turn + .52 * 11.5)}, 1};
    scene = scene_of(&all, &in, 1);
    double sum = 0;
    for (size_t p = 0; p < all.count; p++)
      sum += hr2d_scene_length(scene, p) * hr2d_scene_sunlight(scene, p, 0);
    const double gap =
        fabs(-in.direction.y * (at[0].x - at[11].x) + in.direction.x * (at[0].y - at[11].y));
    ck_assert_double_eq_tol(sum / gap, 1, 1e-11);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(what_is_no_sun_is_refused) {
  static const hr2d_sun bad[] = {{{0, 0}, 1},        {{NAN, 1}, 1}, {{1, INFINITY}, 1},
                                 {{1, 0}, INFINITY}, {{1, 0}, -1},  {{1, 0}, NAN}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
    ck_assert_int_eq(hr2d_scene_set_sun(scene, &bad[k], 1), HR2D_ESCENE);
  ck_assert_int_eq(hr2d_scene_set_sun(scene, NULL, 1), HR2D_EINVAL);
  const hr2d_sun night[] = {{{0, 0}, 0}, {{1, -1}, 2}}, three[3] = {{{0, -1}, 1}};
  ck_assert_int_eq(hr2d_scene_set_sun(scene, night, 2), HR2D_OK);
  ck_assert_int_eq(
      test_add_patch(scene, (hr2d_segment){{0, 0}, {1, 0}}, 0, .5, HR2D_SIDES_FRONT), HR2D_OK);
  const double light[] = {1, 2, 3};
  ck_assert_int_eq(hr2d_scene_set_background(scene, light, 3), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  test_expect_message(scene, "the sun has 2 bands where the patches have 3");
  ck_assert_int_eq(hr2d_scene_set_background(scene, NULL, 0), HR2D_OK);
  test_commit(scene);
  ck_assert_uint_eq(hr2d_scene_bands(scene), 2);
  ck_assert_double_eq(hr2d_scene_sunlight(scene, 0, 0), 0);
  ck_assert_double_eq_tol(hr2d_scene_sunlight(scene, 0, 1), sqrt(2), 1e-15);
  ck_assert_int_eq(hr2d_scene_set_sun(scene, three, 1), HR2D_ESTATE);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("sunlight") {
  ADD_TESTS("light", rays_to_the_sun_say_the_same, parts_add_up_to_averages,
            rows_shade_each_other_as_the_formula_says, walls_that_meet_let_nothing_through);
  ADD_TESTS("calls", what_is_no_sun_is_refused);
}
