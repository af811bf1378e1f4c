/* SPDX-License-Identifier: GPL-3.0-or-later */
/* View factors of points between patches: against the sweep, and against M and Φ. */
#include <math.h>
#include <stdlib.h>

#include "support/field-stage.h"
#include "support/grid-plans.h"
#include "support/support.h"

#define PI 3.14159265358979323846

enum { MOST = 4000 };

/* A row of a point, as it was shown. */
typedef struct kept {
  size_t calls, stop_at, patches;
  int with_factors;
  double share[MOST], factor[MOST];
  hr2d_field_row row;
} kept;

static hr2d_status take(void *ctx, const hr2d_field_row *row) {
  kept *k = ctx;
  ck_assert_uint_eq(row->struct_size, sizeof *row);
  ck_assert_uint_eq(row->point, k->calls);
  ck_assert_int_eq(row->factor != NULL, row->count > 0 && k->with_factors);
  double shares = row->sky + row->back, factors = row->sky_factor + row->back_factor;
  for (size_t p = 0; p < k->patches; p++) k->share[p] = k->factor[p] = 0;
  for (size_t p = 0; p < row->count; p++) {
    ck_assert(p == 0 || row->patch[p - 1] < row->patch[p]);
    ck_assert_double_gt(row->share[p], 0);
    shares += k->share[row->patch[p]] = row->share[p];
    if (row->factor) factors += k->factor[row->patch[p]] = row->factor[p];
  }
  ck_assert_double_eq_tol(shares, 1, 1e-14);
  if (k->with_factors) ck_assert_double_eq_tol(factors, 1, 1e-14);
  k->row = *row;
  return ++k->calls == k->stop_at ? (hr2d_status)77 : HR2D_OK;
}

/* ½ ∫ n·ω dω over a span, in front of the normal at an angle. */
static real factor_of(sweep_span p, real normal) {
  real sum = 0;
  for (int turn = -1; turn <= 1; turn++) {
    const real low = fmaxl(p.low - normal + 2 * turn * (real)PI, -(real)PI / 2),
               high = fminl(p.high - normal + 2 * turn * (real)PI, (real)PI / 2);
    if (high > low) sum += (sinl(high) - sinl(low)) / 2;
  }
  return sum;
}

/* The largest difference of a row from what the sweep sees. */
static double distance(const field_stage *s, hr2d_point x, double normal, const kept *k) {
  static real share[MOST], factor[MOST];
  real sky[2] = {0}, back[2] = {0};
  double worst = 0;
  const size_t n = s->all.count, count = open_sweep(&s->all, (spot){x.x, x.y}, s->span);
  for (size_t p = 0; p < n; p++) share[p] = factor[p] = 0;
  for (size_t p = 0; p < count; p++) {
    const sweep_span at = s->span[p];
    const real part = (at.high - at.low) / (2 * (real)PI), f = factor_of(at, normal);
    if (at.seen == SWEEP_SKY || at.seen == SWEEP_BACK) {
      real *to = at.seen == SWEEP_SKY ? sky : back;
      to[0] += part, to[1] += f;
    } else {
      share[at.seen] += part, factor[at.seen] += f;
    }
  }
  for (size_t p = 0; p < n; p++)
    worst = fmax(worst,
                 (double)fmaxl(fabsl(share[p] - k->share[p]), fabsl(factor[p] - k->factor[p])));
  worst = fmax(worst, (double)fmaxl(fabsl(sky[0] - k->row.sky), fabsl(back[0] - k->row.back)));
  return fmax(worst, (double)fmaxl(fabsl(sky[1] - k->row.sky_factor),
                                   fabsl(back[1] - k->row.back_factor)));
}

static field_stage draw_stage(randoms *r, int kind) {
  plan p = {0};
  const test_paint paint = {.r = r, .emission = 1, .background = kind % 2};
  if (kind < plan_class_count)
    plan_classes[kind].draw(r, 8, &p);
  else
    p = grid_plan(r, kind % 2);
  field_stage s = field_stage_flat(test_painted_scene(&p, &paint));
  plan_free(&p);
  ck_assert_uint_le(s.all.count, MOST);
  return s;
}

/* Against the sweep, and with the M and the n·Φ = H(n) − H(−n) of the other call. */
START_TEST(rows_of_random_scenes) {
  randoms r = randoms_stream(test_seed(), _i);
  field_stage s = draw_stage(&r, _i);
  static kept k;
  k = (kept){.patches = s.all.count, .with_factors = 1};
  const hr2d_segment first = hr2d_scene_segment(s.t.scene, 0);
  for (int turn = test_count(100); turn > 0; turn--) {
    const double angle = random_between(&r, -PI, PI);
    const hr2d_point x = {first.a.x + random_between(&r, -1, 1),
                          first.a.y + random_between(&r, -1, 1)};
    const hr2d_point normal = {3 * cos(angle), 3 * sin(angle)}, away = {-normal.x, -normal.y};
    if (open_sweep_clearance(&s.all, (spot){x.x, x.y}) < 1e-9) continue;
    double mean = 0, ahead = 0, behind = 0, max = 0;
    k.calls = 0;
    ck_assert_int_eq(hr2d_field_rows_visit(s.t.scene, &x, &normal, 1, NULL, take, &k), HR2D_OK);
    ck_assert_double_le(distance(&s, x, angle, &k), 1e-13);
    for (size_t p = 0; p < s.all.count; p++) {
      const double b = hr2d_solution_average(s.solution, p, 0);
      mean += k.share[p] * b;
      ahead += k.factor[p] * b;
      max = fmax(max, b);
    }
    mean += k.row.sky * hr2d_scene_background(s.t.scene, 0);
    ahead += k.row.sky_factor * hr2d_scene_background(s.t.scene, 0);
    k.calls = 0;
    ck_assert_int_eq(hr2d_field_rows_visit(s.t.scene, &x, &away, 1, NULL, take, &k), HR2D_OK);
    for (size_t p = 0; p < s.all.count; p++)
      behind += k.factor[p] * hr2d_solution_average(s.solution, p, 0);
    behind += k.row.sky_factor * hr2d_scene_background(s.t.scene, 0);
    const field_sample f = field_sample_at(s.solution, x.x, x.y);
    ck_assert_int_eq(f.place, k.row.place);
    if (f.place == HR2D_PLACE_OUTSIDE) continue;
    ck_assert_double_eq_tol(f.mean, mean, 1e-13);
    ck_assert_double_eq_tol((f.flux[0] * normal.x + f.flux[1] * normal.y) / 3, ahead - behind,
                            1e-13);
  }
  field_stage_clear(&s);
}
END_TEST

/* On a patch, with its own normal, the factors are those of its beams. */
static hr2d_status add_beam(void *ctx, const hr2d_beam *beam) {
  double *factor = ctx;
  if (beam->seen == HR2D_SEEN_FRONT) factor[beam->patch] += beam->factor;
  return HR2D_OK;
}

START_TEST(rows_on_a_patch) {
  hr2d_scene *scene = test_scene((const double[][6]){{0, 0, 2, 0, 1, 0},
                                                     {2, 0, 2, 1, 1, 0},
                                                     {2, 1, 0, 1, 1, 0},
                                                     {0, 1, 0, 0, 1, 0},
                                                     {1, .25, .5, .5, 1, 0}},
                                 5);
  static kept k;
  for (int turn = 1; turn < 8; turn++) {
    double factor[5] = {0};
    const hr2d_point x = {turn / 4.0, 0}, normal = {0, 1e-3};
    k = (kept){.patches = 5, .with_factors = 1};
    ck_assert_int_eq(hr2d_beams_visit(scene, 0, turn / 8.0, add_beam, factor), HR2D_OK);
    ck_assert_int_eq(hr2d_field_rows_visit(scene, &x, &normal, 1, NULL, take, &k), HR2D_OK);
    ck_assert_int_eq(k.row.place, HR2D_PLACE_PATCH);
    ck_assert_double_eq_tol(k.share[0], 0.5, 1e-12);
    for (int p = 0; p < 5; p++) ck_assert_double_eq_tol(k.factor[p], factor[p], 1e-12);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_status stop(void *ctx, const hr2d_progress *p) {
  (void)ctx;
  ck_assert_str_eq(p->phase, "field");
  return HR2D_STOPPED;
}

/* Many rounds, by each number of threads; stops and wrong arguments. */
START_TEST(statuses_and_threads) {
  randoms r = randoms_stream(test_seed(), 77);
  field_stage s = draw_stage(&r, 3);
  static hr2d_point x[MOST];
  static kept one, other;
  for (int k = 0; k < MOST; k++) x[k] = (hr2d_point){random_unit(&r), random_unit(&r)};
  hr2d_field_options o = HR2D_FIELD_OPTIONS_INIT;
  one = other = (kept){.patches = s.all.count};
  ck_assert_int_eq(hr2d_field_rows_visit(s.t.scene, x, NULL, MOST, &o, take, &one), HR2D_OK);
  o.threads = 3;
  ck_assert_int_eq(hr2d_field_rows_visit(s.t.scene, x, NULL, MOST, &o, take, &other), HR2D_OK);
  ck_assert_uint_eq(one.calls, MOST);
  ck_assert_mem_eq(one.share, other.share, sizeof one.share);
  one = (kept){.patches = s.all.count, .stop_at = 1500};
  ck_assert_int_eq(hr2d_field_rows_visit(s.t.scene, x, NULL, MOST, &o, take, &one), 77);
  ck_assert_uint_eq(one.calls, 1500);
  o.progress = stop;
  one = (kept){.patches = s.all.count};
  ck_assert_int_eq(hr2d_field_rows_visit(s.t.scene, x, NULL, MOST, &o, take, &one),
                   HR2D_STOPPED);
  const hr2d_point no_normal = {0, 0};
  ck_assert_int_eq(hr2d_field_rows_visit(s.t.scene, x, &no_normal, 1, NULL, take, &one),
                   HR2D_EINVAL);
  x[0].x = NAN;
  ck_assert_int_eq(hr2d_field_rows_visit(s.t.scene, x, NULL, 1, NULL, take, &one), HR2D_EINVAL);
  o.struct_size = 1;
  ck_assert_int_eq(hr2d_field_rows_visit(s.t.scene, x + 1, NULL, 1, &o, take, &one),
                   HR2D_EINVAL);
  hr2d_scene *open = test_open_scene((const double[][4]){{0, 0, 1, 0}}, 1);
  ck_assert_int_eq(hr2d_field_rows_visit(open, x + 1, NULL, 1, NULL, take, &one), HR2D_ESTATE);
  hr2d_scene_destroy(open);
  field_stage_clear(&s);
}
END_TEST

TEST_SUITE("field rows") {
  ADD_TESTS("field rows", rows_on_a_patch, statuses_and_threads);
  REPEAT_TESTS(plan_class_count + 4, "field rows", rows_of_random_scenes);
}
