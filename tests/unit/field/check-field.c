/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light at points between patches: furnaces, lamps in black rooms, and what a sweep over
   all directions sees past anything in the way.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change scenes and points. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field-stage.h"
#include "support/grid-plans.h"
#include "support/support.h"

#define PI 3.14159265358979323846

static field_sample at(const field_stage *s, double x, double y) {
  return field_sample_at(s->solution, x, y);
}

/* A point in the box around the walls, or in one that is larger. */
static hr2d_point draw_point(randoms *r, const field_stage *s, double larger) {
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL}, x[2];
  for (size_t k = 0; k < s->all.count; k++)
    for (int c = 0; c < 4; c++) {
      low[c % 2] = fmin(low[c % 2], s->at[k][c]);
      high[c % 2] = fmax(high[c % 2], s->at[k][c]);
    }
  for (int c = 0; c < 2; c++) {
    const double spare = larger * (high[c] - low[c]);
    x[c] = random_between(r, low[c] - spare, high[c] + spare);
  }
  return (hr2d_point){x[0], x[1]};
}

static hr2d_scene *draw_scene(randoms *r, int kind, const test_paint *paint) {
  plan p = {0};
  if (kind < plan_class_count)
    plan_classes[kind].draw(r, 8, &p);
  else
    p = grid_plan(r, kind % 2);
  hr2d_scene *scene = test_painted_scene(&p, paint);
  plan_free(&p);
  return scene;
}

static const double square[][6] = {
    {0, 0, 1, 0, 1, 0}, {1, 0, 1, 1, 2, 0}, {1, 1, 0, 1, 3, 0}, {0, 1, 0, 0, 4, 0}};

/* A regular polygon with one lamp: M is its angle over 2π, and Φ that of two directions. */
START_TEST(lamp_of_a_convex_black_room) {
  randoms r = randoms_stream(test_seed(), 1);
  for (int turn = test_count(100); turn > 0; turn--) {
    double at_patch[12][6];
    const int n = 3 + random_below(&r, 10), lamp = random_below(&r, n);
    const double begin = random_unit(&r);
    for (int k = 0; k < n; k++)
      for (int end = 0; end < 2; end++) {
        const double angle = begin + 2 * PI * ((k + end) % n) / n;
        at_patch[k][2 * end] = cos(angle);
        at_patch[k][2 * end + 1] = sin(angle);
      }
    for (int k = 0; k < n; k++) at_patch[k][4] = k == lamp, at_patch[k][5] = 0;
    field_stage s = field_stage_flat(test_scene((const double(*)[6])at_patch, (size_t)n));
    for (int k = 0; k < 20; k++) {
      const double far = 0.49 * sqrt(random_unit(&r)), angle = 2 * PI * random_unit(&r);
      const double x = far * cos(angle), y = far * sin(angle), *lit = at_patch[lamp];
      const long double ax = lit[0] - (long double)x, ay = lit[1] - (long double)y,
                        bx = lit[2] - (long double)x, by = lit[3] - (long double)y;
      const double seen = (double)atan2l(ax * by - ay * bx, ax * bx + ay * by);
      const double mid_x = (double)(by / hypotl(bx, by) - ay / hypotl(ax, ay)) / 2,
                   mid_y = (double)(ax / hypotl(ax, ay) - bx / hypotl(bx, by)) / 2;
      const field_sample f = at(&s, x, y);
      ck_assert_int_eq(f.place, HR2D_PLACE_BETWEEN);
      ck_assert_double_eq_tol(f.mean, seen / (2 * PI), 1e-15);
      ck_assert_double_eq_tol(f.flux[0], mid_x, 1e-15);
      ck_assert_double_eq_tol(f.flux[1], mid_y, 1e-15);
      ck_assert_double_eq(f.sky, 0);
      ck_assert_double_eq(f.back, 0);
    }
    field_stage_clear(&s);
  }
}
END_TEST

/* E = 1 − ρ: B is 1 everywhere. */
START_TEST(furnaces) {
  randoms r = randoms_stream(test_seed(), 2 + _i);
  const test_paint paint = {.r = &r, .reflectance = 0.9, .isothermal = 1};
  field_stage s = field_stage_of(draw_scene(&r, _i, &paint), 0.5, 1 + (unsigned)_i % 4);
  int inside = 0;
  for (int k = test_count(200); k > 0 || inside == 0; k--) {
    ck_assert_int_gt(k, -1000);
    const hr2d_point x = draw_point(&r, &s, 0);
    const field_sample f = at(&s, x.x, x.y);
    if (f.place == HR2D_PLACE_OUTSIDE) continue;
    inside++;
    ck_assert_double_eq_tol(f.mean, 1, 1e-13);
    ck_assert_double_le(hypot(f.flux[0], f.flux[1]), 1e-13);
    ck_assert_double_eq(f.back, 0);
  }
  field_stage_clear(&s);
}
END_TEST

/* Past whatever stands in the way, also from outside, against the sweep. */
START_TEST(black_scenes) {
  randoms r = randoms_stream(test_seed(), 40 + _i);
  const test_paint paint = {.r = &r, .emission = 1, .background = _i % 3 == 0 ? 0.7 : 0};
  field_stage s = field_stage_flat(draw_scene(&r, _i, &paint));
  double worst = 0;
  for (int k = test_count(500); k > 0; k--) {
    const hr2d_point x = draw_point(&r, &s, k % 4 == 0 ? 0.3 : 0);
    if (open_sweep_clearance(&s.all, (spot){x.x, x.y}) < 1e-9) continue;
    const field_sample f = at(&s, x.x, x.y), g = field_sample_sweep(&s, x.x, x.y);
    worst = fmax(worst, field_sample_distance(&f, &g, 1));
    ck_assert_msg(field_sample_distance(&f, &g, 1) <= 1e-12 && f.place == g.place,
                  "at %.17g %.17g: M %.17g, not %.17g; sky %g %g; back %g %g", x.x, x.y, f.mean,
                  g.mean, f.sky, g.sky, f.back, g.back);
  }
  if (getenv("HR2D_TEST_VERBOSE")) fprintf(stderr, "%d: %.2g\n", _i, worst);
  field_stage_clear(&s);
}
END_TEST

/* Negative control: a point that is off by 1e-9, and one that is on the wrong side of a wall.
 */
START_TEST(other_points_are_told_apart) {
  field_stage s = field_stage_flat(test_scene(square, 4));
  const field_sample f = at(&s, 0.3, 0.4), g = field_sample_sweep(&s, 0.3 + 1e-9, 0.4),
                     h = field_sample_sweep(&s, -0.3, 0.4);
  ck_assert_double_gt(field_sample_distance(&f, &g, 4), 1e-11);
  ck_assert_double_eq(field_sample_distance(&f, &h, 4), HUGE_VAL);
  field_stage_clear(&s);
}
END_TEST

/* From far away, and from places where the border of the plane's box may be. */
START_TEST(points_far_outside) {
  field_stage s = field_stage_flat(test_scene(
      (const double[][6]){{1, 0, 0, 0, 3, 0}, {0, 0, 0, 1, 1, 0}, {5, 5, 5, 4, 2, 0}}, 3));
  for (int j = -16; j <= 16; j++)
    for (int k = -16; k <= 16; k++) {
      const double x = 2.5 + 2.5 * j, y = 2.5 + 2.5 * k;
      if (open_sweep_clearance(&s.all, (spot){x, y}) < 1e-9) continue;
      const field_sample f = at(&s, x, y), g = field_sample_sweep(&s, x, y);
      ck_assert_msg(field_sample_distance(&f, &g, 3) <= 1e-14, "at %g %g: M %g, not %g", x, y,
                    f.mean, g.mean);
      ck_assert_double_le(field_sample_distance(&f, &g, 3), 1e-14);
    }
  const field_sample far = at(&s, 1e6, -1e6), sweep = field_sample_sweep(&s, 1e6, -1e6);
  ck_assert_double_eq_tol(far.mean, sweep.mean, 1e-14);
  ck_assert_double_gt(far.mean, 0);
  const field_sample away = at(&s, 1e300, -1e300);
  ck_assert_double_eq(away.sky, 1);
  ck_assert_int_eq(away.place, HR2D_PLACE_OUTSIDE);
  field_stage_clear(&s);
}
END_TEST

/* ∫ B dω over a span by Gauss's rule on parts, which end where leaves do. */
static const double gauss_at[] = {-0.9061798459386640, -0.5384693101056831, 0,
                                  0.5384693101056831, 0.9061798459386640};
static const double gauss_weight[] = {0.2369268850561891, 0.4786286704993665,
                                      0.5688888888888889, 0.4786286704993665,
                                      0.2369268850561891};

static void integrate(const field_stage *s, spot x, sweep_span p, int depth, real sum[3]) {
  real part[3] = {0};
  for (int side = 0; side < 2; side++)
    for (int q = 0; q < 5; q++) {
      const real size = (p.high - p.low) / 2;
      const real angle = p.low + size * (side + 0.5L * (1 + (real)gauss_at[q]));
      const real t = open_sweep_place(&s->all, p.seen, x, angle);
      const real b = hr2d_solution_at(s->solution, p.seen, (double)fminl(fmaxl(t, 0), 1), 0) *
                     size / 2 * (real)gauss_weight[q];
      part[0] += b;
      part[1] += b / 2 * cosl(angle);
      part[2] += b / 2 * sinl(angle);
    }
  if (depth > 0) {
    const real middle = p.low + (p.high - p.low) / 2;
    integrate(s, x, (sweep_span){p.low, middle, p.seen}, depth - 1, sum);
    integrate(s, x, (sweep_span){middle, p.high, p.seen}, depth - 1, sum);
    return;
  }
  for (int k = 0; k < 3; k++) sum[k] += part[k];
}

/* The ends of all leaves of a patch within a span, as angles. */
static size_t cut_span(const field_stage *s, spot x, sweep_span p, real *cut) {
  const hr2d_element *e = hr2d_hierarchy_elements(s->t.hierarchy);
  const double unit = hr2d_scene_unit(s->t.scene);
  const size_t count = hr2d_hierarchy_count(s->t.hierarchy).elements;
  size_t cuts = 0;
  cut[cuts++] = p.low;
  for (size_t k = 0; k < count; k++) {
    if (e[k].child || e[k].patch != p.seen) continue;
    const real angle = atan2l(unit * e[k].a.y - x.y, unit * e[k].a.x - x.x);
    if (p.low < angle && angle < p.high) cut[cuts++] = angle;
  }
  cut[cuts++] = p.high;
  for (size_t k = 1; k < cuts; k++) /* they are few */
    for (size_t j = k; j > 0 && cut[j] < cut[j - 1]; j--) {
      const real swap = cut[j];
      cut[j] = cut[j - 1];
      cut[j - 1] = swap;
    }
  return cuts;
}

/* Polynomials on leaves, far and near. */
START_TEST(polynomials_on_leaves) {
  randoms r = randoms_stream(test_seed(), 80 + _i);
  const test_paint paint = {.r = &r, .emission = 1, .reflectance = 0.8};
  const unsigned order = (unsigned[]){1, 2, 4, 8, 12}[_i];
  field_stage s = field_stage_of(draw_scene(&r, 3, &paint), 0.5, order);
  real cut[500];
  for (int k = test_count(50); k > 0; k--) {
    const hr2d_point at_point = draw_point(&r, &s, 0);
    const spot x = {at_point.x, at_point.y};
    if (open_sweep_clearance(&s.all, x) < 1e-3) continue;
    const field_sample f = at(&s, at_point.x, at_point.y);
    if (f.place == HR2D_PLACE_OUTSIDE) continue;
    real sum[3] = {0};
    const size_t spans = open_sweep(&s.all, x, s.span);
    for (size_t p = 0; p < spans; p++) {
      const size_t cuts = cut_span(&s, x, s.span[p], cut);
      for (size_t c = 1; c < cuts; c++)
        integrate(&s, x, (sweep_span){cut[c - 1], cut[c], s.span[p].seen}, 9, sum);
    }
    ck_assert_double_eq_tol(f.mean, (double)sum[0] / (2 * PI), 1e-10);
    ck_assert_double_eq_tol(f.flux[0], (double)sum[1], 1e-10);
    ck_assert_double_eq_tol(f.flux[1], (double)sum[2], 1e-10);
  }
  field_stage_clear(&s);
}
END_TEST

static void expect_limit(const field_stage *s, double x, double y, double beside_x,
                         double beside_y) {
  const field_sample f = at(s, x, y), g = at(s, beside_x, beside_y);
  ck_assert_int_eq(f.place, HR2D_PLACE_PATCH);
  ck_assert_int_eq(g.place, HR2D_PLACE_BETWEEN);
  ck_assert_double_eq_tol(f.mean, g.mean, 1e-8);
  ck_assert_double_eq_tol(f.flux[0], g.flux[0], 1e-8);
  ck_assert_double_eq_tol(f.flux[1], g.flux[1], 1e-8);
}

/* On patches and in corners the field is a limit. */
START_TEST(points_on_patches) {
  field_stage s = field_stage_flat(test_scene(square, 4));
  const double d = 1e-9;
  expect_limit(&s, 0.3, 0, 0.3, d);
  expect_limit(&s, 1, 0.7, 1 - d, 0.7);
  expect_limit(&s, 0, 0, d, d);
  expect_limit(&s, 1, 1, 1 - d, 1 - d);
  expect_limit(&s, 0.3, -1e-16, 0.3, d); /* a rounding behind it */
  /* Half of the light is that of the patch itself. */
  const field_sample f = at(&s, 0.5, 0);
  const double far = 2 * atan(0.5), beside = (PI - far) / 2;
  ck_assert_double_eq_tol(f.mean, (PI * 1 + far * 3 + beside * (2 + 4)) / (2 * PI), 1e-12);
  /* In the corner three quarters, along the line that halves it. */
  const field_sample g = at(&s, 1, 0);
  ck_assert_double_eq_tol(g.mean, (0.75 * PI * (1 + 2) + PI / 4 * (3 + 4)) / (2 * PI), 1e-12);
  field_stage_clear(&s);
}
END_TEST

/* A wall with two sides in a room: between equal sides the patch of the lower number counts; at
   its tip the point looks ahead, and sees nothing of it. */
START_TEST(points_on_walls_with_two_sides) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < 4; k++) {
    const hr2d_segment at_wall = {{square[k][0], square[k][1]}, {square[k][2], square[k][3]}};
    ck_assert_int_eq(test_add_patch(scene, at_wall, square[k][4], 0, HR2D_SIDES_FRONT),
                     HR2D_OK);
  }
  ck_assert_int_eq(
      test_add_patch(scene, (hr2d_segment){{0.5, 0.25}, {0.5, 0.75}}, 8, 0, HR2D_SIDES_BOTH),
      HR2D_OK);
  test_commit(scene);
  field_stage s = field_stage_flat(scene);
  const double d = 1e-9;
  expect_limit(&s, 0.5, 0.5, 0.5 - d, 0.5); /* a→b runs up: its front is on the left */
  expect_limit(&s, 0.5, 0.75, 0.5, 0.75 + d);
  expect_limit(&s, 0.5, 0.25, 0.5, 0.25 - d);
  field_stage_clear(&s);
}
END_TEST

/* Behind the walls of a room, and within an obstacle. */
START_TEST(places_without_light) {
  const double room[][6] = {{0, 0, 4, 0, 1, 0}, {4, 0, 4, 4, 1, 0}, {4, 4, 0, 4, 1, 0},
                            {0, 4, 0, 0, 1, 0}, {1, 1, 1, 2, 1, 0}, {1, 2, 2, 1, 1, 0},
                            {2, 1, 1, 1, 1, 0}};
  field_stage s = field_stage_flat(test_scene(room, 7));
  const field_sample inside = at(&s, 1.2, 1.2), outside = at(&s, -1, 2), open = at(&s, 3, 3);
  ck_assert_int_eq(inside.place, HR2D_PLACE_OUTSIDE);
  ck_assert_double_eq(inside.back, 1);
  ck_assert_int_eq(outside.place, HR2D_PLACE_OUTSIDE);
  ck_assert_double_eq_tol(outside.back, atan(2) / PI, 1e-15);
  ck_assert(isnan(inside.mean) && isnan(outside.mean) && isnan(outside.flux[1]));
  ck_assert_int_eq(open.place, HR2D_PLACE_BETWEEN);
  field_stage_clear(&s);
}
END_TEST

/* Errors of patches, by the parts of directions in which they are. */
START_TEST(errors_of_patches) {
  field_stage s = field_stage_flat(test_scene(square, 4));
  const double patch_error[4] = {1, 0, 0, 0};
  double error = 0;
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  const hr2d_point x = {0.5, 0.5};
  values.error = &error;
  ck_assert_int_eq(hr2d_field_at(s.solution, &x, 1, &options, &values), HR2D_OK);
  ck_assert(isnan(error));
  options.patch_error = patch_error;
  ck_assert_int_eq(hr2d_field_at(s.solution, &x, 1, &options, &values), HR2D_OK);
  ck_assert_double_eq_tol(error, 0.25, 1e-15);
  field_stage_clear(&s);
}
END_TEST

enum { MANY = 2000 };

typedef struct field_result {
  double mean[3 * MANY], flux[6 * MANY], sky[MANY];
  unsigned char place[MANY];
} field_result;

static hr2d_field_values values_of(field_result *f) {
  return (hr2d_field_values){.struct_size = sizeof(hr2d_field_values),
                             .mean = f->mean,
                             .flux = f->flux,
                             .sky = f->sky,
                             .place = f->place};
}

/* Bands, and the same bits for each number of threads. */
START_TEST(threads_and_bands) {
  const hr2d_segment wall[] = {
      {{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, {0, 1}}, {{0, 1}, {0, 0}}};
  const double e[][3] = {{1, 0, 2}, {0, 1, 0}, {0, 0, 0}, {1, 1, 1}},
               rho[][3] = {{.1, .2, .3}, {.5, .5, .5}, {0, .9, 0}, {.3, .2, .1}};
  field_stage s = field_stage_of(test_coloured_scene(wall, e, rho, 4), 0.3, 3);
  static hr2d_point x[MANY];
  static field_result one, other;
  randoms r = randoms_stream(test_seed(), 99);
  for (int k = 0; k < MANY; k++) x[k] = (hr2d_point){random_unit(&r), random_unit(&r)};
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = values_of(&one);
  ck_assert_int_eq(hr2d_field_at(s.solution, x, MANY, NULL, &values), HR2D_OK);
  for (unsigned threads = 2; threads < 9; threads += 3) {
    options.threads = threads;
    values = values_of(&other);
    ck_assert_int_eq(hr2d_field_at(s.solution, x, MANY, &options, &values), HR2D_OK);
    ck_assert_mem_eq(&one, &other, sizeof one);
  }
  /* No flux through a wall but that of its own net flux, near its middle. */
  ck_assert_double_gt(one.mean[0], 0);
  ck_assert(one.mean[0] != one.mean[1]);
  field_stage_clear(&s);
}
END_TEST

static hr2d_status stop(void *ctx, const hr2d_progress *p) {
  ck_assert_str_eq(p->phase, "field");
  ck_assert(p->fraction >= 0 && p->fraction <= 1);
  int *calls = ctx;
  return --*calls < 0 ? (hr2d_status)77 : HR2D_OK;
}

START_TEST(statuses_of_field_calls) {
  field_stage s = field_stage_flat(test_scene(square, 4));
  static hr2d_point x[MANY];
  static field_result one;
  for (int k = 0; k < MANY; k++) x[k] = (hr2d_point){(k + 0.5) / MANY, 0.5};
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = values_of(&one), none = HR2D_FIELD_VALUES_INIT;
  ck_assert_int_eq(hr2d_field_at(s.solution, x, 0, NULL, &values), HR2D_OK);
  ck_assert_int_eq(hr2d_field_at(s.solution, x, MANY, NULL, &none), HR2D_OK);
  int calls = 1;
  options.progress = stop;
  options.progress_ctx = &calls;
  ck_assert_int_eq(hr2d_field_at(s.solution, x, MANY, &options, &values), 77);
  options.struct_size = 0;
  ck_assert_int_eq(hr2d_field_at(s.solution, x, 1, &options, &values), HR2D_EINVAL);
  values.struct_size = 3;
  ck_assert_int_eq(hr2d_field_at(s.solution, x, 1, NULL, &values), HR2D_EINVAL);
  values.struct_size = sizeof values;
  x[1].y = NAN;
  ck_assert_int_eq(hr2d_field_at(s.solution, x, 2, NULL, &values), HR2D_EINVAL);
  x[1].y = HUGE_VAL;
  ck_assert_int_eq(hr2d_field_at(s.solution, x, 2, NULL, &values), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_field_at(s.solution, x, 1, NULL, &values), HR2D_OK);
  field_stage_clear(&s);
}
END_TEST

TEST_SUITE("field") {
  ADD_TESTS("field", lamp_of_a_convex_black_room, other_points_are_told_apart,
            points_far_outside, points_on_patches, points_on_walls_with_two_sides,
            places_without_light, errors_of_patches, threads_and_bands,
            statuses_of_field_calls);
  REPEAT_TESTS(plan_class_count, "field", furnaces);
  REPEAT_TESTS(plan_class_count + 8, "field", black_scenes);
  REPEAT_TESTS(5, "field", polynomials_on_leaves);
}
