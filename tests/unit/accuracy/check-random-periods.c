/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random cells: floors, at times ceilings, and segments that may reach over the end of their
   cell.  Four cells of one period each are the same scene, cut off four times as far away: the
   answers differ by no more than both bounds, in averages, at points of patches, also at
   tips, and at points between them. */
#include <math.h>

#include "support/support.h"

enum { PATCHES = 12, STEPS = 3, POINTS = 5 };
static const double places[POINTS] = {0, 1, 1e-4, .3, .71};
static const double between[POINTS][2] = {{.1, .1}, {.3, .9}, {.5, .5}, {.7, .2}, {.9, .7}};

typedef struct cell {
  double at[PATCHES][6]; /* ax ay bx by E ρ */
  size_t count;
  double step, high, background;
} cell;

static int side_of(const double *s, double x, double y) {
  const double d = (s[2] - s[0]) * (y - s[1]) - (s[3] - s[1]) * (x - s[0]);
  return (d > 1e-3) - (d < -1e-3);
}

/* Whether segments meet, or nearly. */
static int meet(const double *p, const double *q) {
  return side_of(p, q[0], q[1]) * side_of(p, q[2], q[3]) <= 0 &&
         side_of(q, p[0], p[1]) * side_of(q, p[2], p[3]) <= 0;
}

static int is_free(const cell *c, const double *p) {
  for (size_t j = 0; j <= c->count; j++)
    for (int k = -STEPS; k <= STEPS; k++) {
      const double *q = j < c->count ? c->at[j] : p;
      const double moved[4] = {q[0] + k * c->step, q[1], q[2] + k * c->step, q[3]};
      if ((j < c->count || k) && meet(p, moved)) return 0;
    }
  return 1;
}

static void add(cell *c, randoms *r, double ax, double ay, double bx, double by) {
  const double patch[6] = {ax, ay, bx, by, random_unit(r), .9 * random_unit(r)};
  for (int k = 0; k < 6; k++) c->at[c->count][k] = patch[k];
  c->count++;
}

static cell draw(randoms *r) {
  cell c = {.step = random_between(r, .8, 2.3), .high = random_between(r, .7, 2.7)};
  c.background = random_below(r, 2) ? random_unit(r) : 0;
  add(&c, r, 0, 0, c.step, 0);
  if (random_below(r, 2)) add(&c, r, c.step, c.high, 0, c.high);
  for (int tries = 0; tries < 100 && c.count < 7; tries++) {
    const double x = c.step * random_unit(r), y = random_between(r, .1, c.high - .1);
    const double angle = random_between(r, 0, 6.28), size = random_between(r, .2, 1);
    const double s[4] = {x, y, x + size * cos(angle), y + size * sin(angle)};
    if (s[3] < .05 || s[3] > c.high - .05 || !is_free(&c, s)) continue;
    add(&c, r, s[0], s[1], s[2], s[3]);
    add(&c, r, s[2], s[3], s[0], s[1]);
  }
  return c;
}

typedef struct answer {
  double b[PATCHES], h[PATCHES];
  double at[PATCHES][POINTS], max;    /* H at points, and the largest */
  double mean[POINTS], error[POINTS]; /* M between the patches; NaN for none */
  hr2d_account account;
} answer;

static void look_between(const cell *c, const hr2d_solution *solution, answer *a) {
  double off[4 * PATCHES];
  hr2d_point at[POINTS];
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  double b = 0;
  for (size_t k = 0; k < c->count; k++) b = fmax(b, c->at[k][4] + c->at[k][5] * a->max);
  for (size_t k = 0; k < 4 * PATCHES; k++) off[k] = a->account.sup.bound * b;
  for (int m = 0; m < POINTS; m++)
    at[m] = (hr2d_point){c->step * between[m][0], c->high * between[m][1]};
  options.patch_error = off;
  values.mean = a->mean;
  values.error = a->error;
  ck_assert_int_eq(hr2d_field_at(solution, at, POINTS, &options, &values), HR2D_OK);
}

static answer solve(const cell *c, int cells, double error) {
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_solution *solution;
  hr2d_target target = HR2D_TARGET_INIT;
  answer a = {.max = 0};
  target.error = error;
  target.points = 1;
  for (int m = 0; m < cells; m++)
    for (size_t k = 0; k < c->count; k++) {
      const double *p = c->at[k], x = m * c->step;
      test_add_patch(scene, (hr2d_segment){{p[0] + x, p[1]}, {p[2] + x, p[3]}}, p[4], p[5],
                     HR2D_SIDES_FRONT);
    }
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){cells * c->step, 0}), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &c->background, 1), HR2D_OK);
  test_commit(scene);
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &a.account);
  ck_assert(!status || status == HR2D_EACCURACY);
  for (size_t k = 0; k < c->count; k++) {
    a.b[k] = hr2d_solution_average(solution, k, 0);
    a.h[k] = hr2d_solution_irradiance(solution, k, 0);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, k, places, POINTS, a.at[k]),
                     HR2D_OK);
    for (int m = 0; m < POINTS; m++) a.max = fmax(a.max, a.at[k][m]);
  }
  look_between(c, solution, &a);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return a;
}

static void expect_points(size_t k, size_t p, const answer *one, const answer *four) {
  const double of_one = one->account.irradiance_sup.bound * one->max,
               of_four = four->account.irradiance_sup.bound * four->max;
  for (int m = 0; m < POINTS; m++)
    ck_assert_msg(fabs(one->at[p][m] - four->at[p][m]) <= of_one + of_four,
                  "cell %zu, patch %zu at %g: H %g and %g, bounds of %g and %g", k, p,
                  places[m], one->at[p][m], four->at[p][m], of_one, of_four);
}

static void expect_between(size_t k, const answer *one, const answer *four) {
  for (int m = 0; m < POINTS; m++)
    ck_assert_msg(!(fabs(one->mean[m] - four->mean[m]) > one->error[m] + four->error[m]),
                  "cell %zu, point %d: M %g and %g, bounds of %g and %g", k, m, one->mean[m],
                  four->mean[m], one->error[m], four->error[m]);
}

START_TEST(cut_off_images_are_in_the_bound) {
  const size_t rounds = test_rounds(40, 2);
  for (size_t k = 0; k < rounds; k++) {
    randoms r = randoms_stream(test_seed(), (int)k);
    const cell c = draw(&r);
    const answer one = solve(&c, 1, 1e-4), four = solve(&c, 4, 1e-5);
    const double of_b = one.account.average.bound + four.account.average.bound;
    const double of_h = one.account.irradiance.bound + four.account.irradiance.bound;
    for (size_t p = 0; p < c.count; p++) {
      const double b = fabs(one.b[p] - four.b[p]), h = fabs(one.h[p] - four.h[p]);
      ck_assert_msg(b <= of_b * four.b[p] && h <= of_h * four.h[p],
                    "cell %zu, patch %zu: B %g off, bounds of %g; H %g off, bounds of %g", k, p,
                    b / four.b[p], of_b, h / four.h[p], of_h);
      expect_points(k, p, &one, &four);
    }
    expect_between(k, &one, &four);
  }
}
END_TEST

TEST_SUITE("random periods") {
  ADD_TESTS("cells", cut_off_images_are_in_the_bound);
}
