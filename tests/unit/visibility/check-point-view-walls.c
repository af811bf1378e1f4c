/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view of a point among walls that meet in T-junctions, touch, lie on one line and are out
   of place by roundings, against the nearest patch in each direction.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/alloc.h"
#include "geometry/vector.h"
#include "independent/point-sweep.h"
#include "scene/scene-impl.h"
#include "support/grid-plans.h"
#include "support/plane.h"
#include "support/support.h"
#include "visibility/point-view.h"

static hr2di_point_viewer *viewer_of(const hr2d_scene *scene) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2di_point_viewer *viewer = NULL;
  ck_assert_int_eq(hr2di_point_viewer_create(scene, &alloc, NULL, &viewer), HR2D_OK);
  return viewer;
}

static hr2di_view_from look(hr2di_point_viewer *viewer, size_t patch, double t) {
  hr2di_view_from seen;
  ck_assert_int_eq(hr2di_view_at(viewer, patch, t, &seen), HR2D_OK);
  for (size_t k = 0; k < seen.count; k++) {
    const hr2di_visible_interval *g = &seen.interval[k];
    ck_assert(g->patch != patch && 0 <= g->from && g->from < g->to && g->to <= 1);
    ck_assert(k == 0 || g[-1].patch < g->patch ||
              (g[-1].patch == g->patch && g[-1].to <= g->from + 2 * DBL_EPSILON));
  }
  return seen;
}

/* A scene, and what the sweep takes of it. */
typedef struct stage {
  hr2d_scene *scene;
  hr2di_point_viewer *viewer;
  size_t n;
  double (*at)[4], size; /* the largest coordinate */
  sweep_span *span;
  double *sine; /* of each patch, then of backs and of the sky */
} stage;

static stage stage_of(hr2d_scene *scene) {
  stage s = {.scene = scene, .viewer = viewer_of(scene), .n = hr2d_scene_patches(scene)};
  s.at = malloc(s.n * sizeof *s.at);
  s.span = malloc((2 * s.n + 2) * sizeof *s.span);
  s.sine = malloc((s.n + 2) * sizeof *s.sine);
  ck_assert(s.at && s.span && s.sine);
  for (size_t k = 0; k < s.n; k++) {
    const hr2d_segment p = hr2d_scene_segment(scene, k);
    memcpy(s.at[k], (double[]){p.a.x, p.a.y, p.b.x, p.b.y}, sizeof *s.at);
    for (int c = 0; c < 4; c++) s.size = fmax(s.size, fabs(s.at[k][c]));
  }
  return s;
}

static void stage_clear(stage *s) {
  hr2di_point_viewer_destroy(s->viewer);
  hr2d_scene_destroy(s->scene);
  free(s->at);
  free(s->span);
  free(s->sine);
}

static void sweep(stage *s, size_t patch, real t, const real border[2]) {
  const sweep_patches all = {s->n, (const double(*)[4])s->at};
  const sweep_frame frame = sweep_frame_at(&all, patch, t);
  const size_t spans = sweep_all(&all, &frame, s->span);
  for (size_t k = 0; k < s->n + 2; k++) s->sine[k] = 0;
  for (size_t k = 0; k < spans; k++) {
    const size_t seen = s->span[k].seen;
    const size_t place = seen == SWEEP_BACK ? s->n : seen == SWEEP_SKY ? s->n + 1 : seen;
    const real low = fmaxl(s->span[k].low, border[0]), high = fminl(s->span[k].high, border[1]);
    if (low < high) s->sine[place] += (double)(cosl((low + high) / 2) * sinl((high - low) / 2));
  }
}

/* The largest difference to the sweep from t between two angles, which needs long doubles. */
static double compare_between(stage *s, const hr2di_view_from *seen, size_t patch, real t,
                              const real border[2]) {
  if (!test_has_long_double()) return 0;
  sweep(s, patch, t, border);
  double worst = fabs(seen->back - s->sine[s->n]);
  for (size_t k = 0; k < seen->count; k++)
    s->sine[seen->interval[k].patch] -= seen->interval[k].sine;
  for (size_t k = 0; k < s->n; k++) worst = fmax(worst, fabs(s->sine[k]));
  return worst;
}

static double compare(stage *s, const hr2di_view_from *seen, size_t patch, real t) {
  if (!test_has_long_double()) return 0;
  const double worst = compare_between(s, seen, patch, t, (real[]){-2, 2});
  return fmax(worst, fabs(seen->sky - s->sine[s->n + 1]));
}

static void expect_near(const plan *p, double error, double max, size_t patch, double t) {
  if (!(error <= max)) plan_print(p);
  ck_assert_msg(error <= max, "patch %zu at %a is off by %g", patch, t, error);
}

/* In closed rooms (1) and open scenes (0). */
START_TEST(walls_on_a_grid) {
  randoms r = randoms_stream(test_seed(), 1 + _i);
  double worst = 0, sum = 0;
  for (int k = test_count(1000); k > 0; k--) {
    plan p = grid_plan(&r, _i);
    stage s = stage_of(plan_try_scene(&p, NULL));
    for (int m = 0; m < 20; m++) {
      const size_t patch = (size_t)(random_bits(&r) % s.n);
      const double t = random_unit(&r);
      const hr2di_view_from seen = look(s.viewer, patch, t);
      const double error = compare(&s, &seen, patch, t);
      expect_near(&p, error, 1e-13, patch, t);
      worst = fmax(worst, error);
      if (_i) sum = fmax(sum, fabs(seen.front - 1));
    }
    stage_clear(&s);
    plan_free(&p);
  }
  printf("%s: to a sweep %.1e, sums %.1e\n", _i ? "closed" : "open", worst, sum);
  ck_assert_double_le(sum, 1e-14);
}
END_TEST

/* At ends and feet the view is that of points next to it, towards the middle. */
START_TEST(ends_and_feet) {
  static const double at[] = {0, .25, .5, .75, 1};
  randoms r = randoms_stream(test_seed(), 10 + _i);
  double worst = 0, sum = 0;
  for (int k = test_count(500); k > 0; k--) {
    plan p = grid_plan(&r, _i);
    stage s = stage_of(plan_try_scene(&p, NULL));
    for (int m = 0; m < 20; m++) {
      const size_t patch = (size_t)(random_bits(&r) % s.n);
      const double t = at[random_below(&r, 5)], step = t <= .5 ? 0x1p-40 : -0x1p-40;
      const hr2di_view_from seen = look(s.viewer, patch, t);
      const double error = compare(&s, &seen, patch, t + step);
      expect_near(&p, error, 1e-8, patch, t);
      worst = fmax(worst, error);
      if (_i) sum = fmax(sum, fabs(seen.front - 1));
    }
    stage_clear(&s);
    plan_free(&p);
  }
  printf("%s: to a sweep beside it %.1e, sums %.1e\n", _i ? "closed" : "open", worst, sum);
  ck_assert_double_le(sum, 1e-14);
}
END_TEST

/* Turned, far from the origin, and every end moved by itself by an ulp: what is seen changes by
   as much as from a point moved by some ulps, and sums stay 1 everywhere. */
START_TEST(jittered_rooms) {
  static const double end[] = {0, 0x1p-1074, 1e-300, 1e-20, 1e-16, 1e-15, 1 - 0x1p-53, 1};
  randoms r = randoms_stream(test_seed(), 20);
  double worst = 0, sum = 0;
  int accepted = 0, count = 0;
  for (int k = test_count(2000); k > 0; k--, count++) {
    plan p = grid_plan(&r, 1);
    const double angle = random_between(&r, 0, 6.3), far = k % 3 ? 0 : 1e4;
    plan_jitter(&r, &p, (similarity){cos(angle), sin(angle), far, -far});
    hr2d_scene *scene = plan_try_scene(&p, NULL);
    if (scene && !hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL)) {
      hr2d_scene_destroy(scene); /* nothing is moved there */
    } else if (scene) {
      stage s = stage_of(scene);
      for (int m = 0; m < 20; m++) {
        const size_t patch = (size_t)(random_bits(&r) % s.n);
        const double t = m % 2 ? random_between(&r, .001, .999) : end[random_below(&r, 8)];
        const hr2di_view_from seen = look(s.viewer, patch, t);
        const double error = fabs(seen.front - 1);
        expect_near(&p, error, 1e-14, patch, t);
        sum = fmax(sum, error);
        if (m % 2 == 0) continue;
        worst = fmax(worst, compare(&s, &seen, patch, t) / s.size);
        expect_near(&p, worst, 1e-13, patch, t);
      }
      stage_clear(&s);
      accepted++;
    }
    plan_free(&p);
  }
  printf("%d of %d rooms accepted, sums %.1e, to a sweep %.1e\n", accepted, count, sum, worst);
  ck_assert_int_gt(accepted, count / 4);
}
END_TEST

/* Squares of any direction in the cells of a lattice; some of their sides are missing. */
static plan draw_squares(randoms *r, int side, int open) {
  plan p = {.walls = 0};
  if (!open) plan_room(&p, side, side);
  for (int k = 0; k < side * side; k++) {
    const double angle = random_between(r, 0, 6.3), radius = random_between(r, .1, .45);
    const hr2d_point middle = {k % side + .5, k / side + .5};
    for (int m = 0; m < 4; m++) {
      const hr2d_point a = plane_polar(middle, radius, angle - m * acos(0)),
                       b = plane_polar(middle, radius, angle - (m + 1) % 4 * acos(0));
      if (!open || random_below(r, 4))
        plan_add(&p, a, b, open && random_below(r, 2) ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT);
    }
  }
  return p;
}

START_TEST(many_squares) {
  randoms r = randoms_stream(test_seed(), 30 + _i);
  plan p = draw_squares(&r, 10, _i);
  stage s = stage_of(plan_try_scene(&p, NULL));
  double worst = 0, backs = 0, sky = 0;
  for (int k = test_count(1000); k > 0; k--) {
    const size_t patch = (size_t)(random_bits(&r) % s.n);
    const double t = random_unit(&r);
    const hr2di_view_from seen = look(s.viewer, patch, t);
    worst = fmax(worst, compare(&s, &seen, patch, t));
    backs = fmax(backs, seen.back);
    sky = fmax(sky, seen.sky);
    ck_assert(_i || fabs(seen.front - 1) <= 1e-14);
  }
  printf("%zu patches, to a sweep %.1e, backs to %.2g, sky to %.2g\n", s.n, worst, backs, sky);
  ck_assert_double_le(worst, 1e-13);
  ck_assert(!_i || (backs > .1 && sky > .01));
  stage_clear(&s);
  plan_free(&p);
}
END_TEST

/* The sweep finds a patch that is a hair elsewhere. */
START_TEST(a_moved_patch_is_noticed) {
  randoms r = randoms_stream(test_seed(), 40);
  plan p = draw_squares(&r, 6, 0);
  stage s = stage_of(plan_try_scene(&p, NULL));
  int noticed = 0;
  for (size_t patch = 0; patch < s.n; patch++) {
    const hr2di_view_from seen = look(s.viewer, patch, .3);
    const size_t other = seen.interval[seen.count / 2].patch;
    s.at[other][0] += 1e-9;
    s.at[other][3] -= 1e-9;
    noticed += compare(&s, &seen, patch, .3) > 1e-13;
    s.at[other][0] -= 1e-9;
    s.at[other][3] += 1e-9;
  }
  ck_assert(!test_has_long_double() || (size_t)noticed > s.n * 3 / 4);
  stage_clear(&s);
  plan_free(&p);
}
END_TEST

/* Two patches with a corner in common and a foot beside it on both within roundings lie on one
   another up to the foot.  One of them hides the other there, which sees nothing but backs. */
START_TEST(a_rounding_behind_another) {
  const double rise = 0x1p-48;
  plan p = {.walls = 0};
  plan_room(&p, 3, 3);
  plan_add(&p, (hr2d_point){1, 1}, (hr2d_point){2, 1}, HR2D_SIDES_FRONT);
  plan_add(&p, (hr2d_point){1, 1}, (hr2d_point){2, 1 + rise}, HR2D_SIDES_FRONT);
  plan_add(&p, (hr2d_point){1.0625, 1 + .0625 * rise}, (hr2d_point){1.0625, 2},
           HR2D_SIDES_BOTH);
  stage s = stage_of(plan_try_scene(&p, NULL));
  for (int k = 0; k < 64; k++) {
    const hr2di_view_from one = look(s.viewer, 4, k / 64.);
    const double front = one.front, back = one.back;
    const hr2di_view_from other = look(s.viewer, 5, k / 64.);
    ck_assert_double_eq_tol(front + other.front, 1, 1e-14);
    ck_assert_double_le(fmin(front, other.front), 1e-14);
    ck_assert_double_eq_tol(back + other.back, 1, 1e-14);
    ck_assert(one.sky <= 1e-14 && other.sky <= 1e-14);
  }
  stage_clear(&s);
  plan_free(&p);
}
END_TEST

/* Whatever the viewer has seen before. */
START_TEST(the_same_bits_every_time) {
  randoms r = randoms_stream(test_seed(), 50);
  plan p = draw_squares(&r, 8, 1);
  hr2d_scene *scene = plan_try_scene(&p, NULL);
  hr2di_point_viewer *old = viewer_of(scene);
  for (int k = test_count(500); k > 0; k--) {
    const size_t patch = (size_t)(random_bits(&r) % hr2d_scene_patches(scene));
    const double t = random_unit(&r);
    hr2di_point_viewer *fresh = viewer_of(scene);
    const hr2di_view_from one = look(old, patch, t), other = look(fresh, patch, t);
    ck_assert_uint_eq(one.count, other.count);
    for (size_t g = 0; g < one.count; g++)
      ck_assert(one.interval[g].patch == other.interval[g].patch &&
                one.interval[g].from == other.interval[g].from &&
                one.interval[g].to == other.interval[g].to &&
                one.interval[g].sine == other.interval[g].sine);
    ck_assert(one.front == other.front && one.back == other.back && one.sky == other.sky);
    hr2di_point_viewer_destroy(fresh);
  }
  hr2di_point_viewer_destroy(old);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

/* A place in a direction from a point of a patch, in the units of the scene's own. */
static hr2d_point place_at(const stage *s, size_t patch, double t, double angle, double far) {
  const hr2d_segment at = s->scene->patch[patch].scaled;
  const hr2d_point from = hr2di_point_at(at, t), along = hr2di_point_minus(at.b, at.a);
  const double x = far * sin(angle), y = far * cos(angle);
  return (hr2d_point){from.x + x * along.x - y * along.y, from.y + x * along.y + y * along.x};
}

/* Between two rays: the sums over patches are those of the sweep between their angles. */
START_TEST(parts_of_views) {
  randoms r = randoms_stream(test_seed(), 50 + _i);
  double worst = 0, control = 0;
  for (int k = test_count(1000); k > 0; k--) {
    plan p = grid_plan(&r, _i);
    stage s = stage_of(plan_try_scene(&p, NULL));
    const int occluded = hr2d_scene_effect(s.scene, HR2D_EFFECT_OCCLUSION, NULL);
    for (int m = 0; m < 20 && occluded; m++) {
      const size_t patch = (size_t)(random_bits(&r) % s.n);
      const double t = random_unit(&r), wide = m % 2 ? 1e-4 : 1;
      const double right = random_between(&r, -1.5, 1.5),
                   left = right - wide * random_unit(&r) * (right + 1.5);
      const hr2d_point border[2] = {place_at(&s, patch, t, right, random_between(&r, .01, 3)),
                                    place_at(&s, patch, t, left, random_between(&r, .01, 3))};
      hr2di_view_from seen;
      ck_assert_int_eq(hr2di_view_between(s.viewer, patch, t, border, &seen), HR2D_OK);
      const double error = compare_between(&s, &seen, patch, t, (real[]){left, right});
      expect_near(&p, error, 1e-12, patch, t);
      worst = fmax(worst, error);
      control = fmax(control, compare_between(&s, &seen, patch, t, (real[]){left, right + .1}));
    }
    stage_clear(&s);
    plan_free(&p);
  }
  printf("%s: parts, to a sweep %.1e; a wider one %.1e\n", _i ? "closed" : "open", worst,
         control);
  ck_assert(!test_has_long_double() || control > 1e-3);
}
END_TEST

/* Where a place is behind the patch all of the view is seen. */
START_TEST(a_place_behind_is_no_border) {
  randoms r = randoms_stream(test_seed(), 60);
  plan p = draw_squares(&r, 4, 0);
  stage s = stage_of(plan_try_scene(&p, NULL));
  const hr2d_point border[2] = {place_at(&s, 0, .3, 2, 1), place_at(&s, 0, .3, 0, 1)};
  hr2di_view_from seen;
  ck_assert_int_eq(hr2di_view_between(s.viewer, 0, .3, border, &seen), HR2D_OK);
  ck_assert_double_eq_tol(seen.front, 1, 1e-14);
  stage_clear(&s);
  plan_free(&p);
}
END_TEST

TEST_SUITE("point view among walls") {
  REPEAT_TESTS(2, "sweep", walls_on_a_grid, ends_and_feet, many_squares, parts_of_views);
  ADD_TESTS("sweep", jittered_rooms, a_rounding_behind_another, a_moved_patch_is_noticed,
            a_place_behind_is_no_border);
  ADD_TESTS("calls", the_same_bits_every_time);
}
