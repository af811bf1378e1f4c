/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random rooms and plates in gas, thin and thick, with corners, slits and obstacles, of given
   temperature and of given heat: what an account says at some targets against a solve to much
   less. */
#include <math.h>

#include "support/support.h"

enum { KINDS = 6 };

/* Adds a closed room, fronts inside. */
static void add_room(hr2d_scene *scene, randoms *r, const hr2d_point *corner, size_t count) {
  for (size_t k = 0; k < count; k++) {
    const double rho = random_below(r, 4) ? random_unit(r) : 0;
    const double emission = random_below(r, 2) ? random_unit(r) : 0;
    ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){corner[k], corner[(k + 1) % count]},
                                    emission, rho, HR2D_SIDES_FRONT),
                     HR2D_OK);
  }
}

static void add_kind(hr2d_scene *scene, randoms *r, int kind) {
  const double gap = random_power(r, -2.5, -0.3), x = random_between(r, 0.3, 1.5),
               y = random_between(r, 0.1, 0.9);
  const hr2d_point triangle[] = {{0, 0}, {1, 0}, {y, gap}},
                   slit[] = {{0, 0}, {1, 0}, {1, gap}, {0, gap}},
                   uneven[] = {{0, 0}, {1 + x, 0.1}, {1 + y, 1}, {-0.2, 0.7 + y}},
                   ell[] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                   box[] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  switch (kind) {
  case 0:
    add_room(scene, r, triangle, 3);
    return;
  case 1:
    add_room(scene, r, slit, 4);
    return;
  case 2:
    add_room(scene, r, uneven, 4);
    return;
  case 3:
    add_room(scene, r, ell, 6);
    return;
  case 4:
    add_room(scene, r, box, 4);
    ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){{x, y}, {x + 0.2, y + 0.03}}, 0,
                                    random_unit(r), HR2D_SIDES_BOTH),
                     HR2D_OK);
    return;
  default: /* two plates */
    ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){{0, 0}, {1, 0}}, 1, random_unit(r),
                                    HR2D_SIDES_FRONT),
                     HR2D_OK);
    ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){{1, gap}, {0, gap}}, 0,
                                    random_unit(r), HR2D_SIDES_FRONT),
                     HR2D_OK);
  }
}

static hr2d_scene *draw(int n) {
  randoms r = randoms_stream(test_seed(), n);
  hr2d_scene *scene = test_new_scene(NULL);
  const double kappa = random_power(&r, -4, 3), hot = random_below(&r, 3) * random_unit(&r);
  const int kind = n % KINDS, free = kind != KINDS - 1 && n / KINDS % 2;
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = &kappa;
  gas.absorption_bands = 1;
  gas.emission = &hot;
  gas.emission_bands = !free;
  gas.given = free ? HR2D_HEAT_FLUX : HR2D_HEAT_NONE;
  gas.value = free ? hot : 0;
  gas.section = (hr2d_section)random_below(&r, 2);
  add_kind(scene, &r, kind);
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
  test_commit(scene);
  return scene;
}

static hr2d_solution *solve_to(const hr2d_scene *scene, double error, hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  target.points = 1;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
  ck_assert_msg(!status || status == HR2D_EACCURACY, "%s: %s", hr2d_strerror(status),
                account->reason);
  return solution;
}

/* The largest error of H, or of B, relative to averages but to no less than the floor. */
static double worst_of(const hr2d_solution *s, const hr2d_solution *fine, size_t patches,
                       double (*of)(const hr2d_solution *, size_t, size_t)) {
  double largest = 0, worst = 0;
  for (size_t k = 0; k < patches; k++) largest = fmax(largest, of(fine, k, 0));
  for (size_t k = 0; k < patches && largest > 0; k++) {
    const double exact = of(fine, k, 0), off = fabs(of(s, k, 0) - exact) - 1e-10 * largest;
    worst = fmax(worst, off / fmax(exact, HR2D_FLOOR * largest));
  }
  return worst;
}

/* The largest error at points, relative to the largest value there; `of` gathers B or H. */
enum { POINTS = 23 };
typedef hr2d_status (*gather_fn)(const hr2d_solution *, size_t, const double *, size_t,
                                 double *);

static double worst_point_of(const hr2d_solution *s, const hr2d_solution *fine, size_t patches,
                             gather_fn of) {
  double t[POINTS], largest = 0, worst = 0;
  for (int k = 0; k < POINTS; k++)
    t[k] = k < 6    ? ldexp(1, -4 * k - 4)
           : k < 12 ? 1 - ldexp(1, -4 * (k - 6) - 4)
                    : (k - 11) / 12.;
  for (size_t p = 0; p < patches; p++) {
    double is[POINTS], right[POINTS];
    ck_assert_int_eq(of(s, p, t, POINTS, is), HR2D_OK);
    ck_assert_int_eq(of(fine, p, t, POINTS, right), HR2D_OK);
    for (int k = 0; k < POINTS; k++) {
      largest = fmax(largest, right[k]);
      worst = fmax(worst, fabs(is[k] - right[k]));
    }
  }
  return largest > 0 ? worst / largest : 0;
}

/* The largest error of M between places of two patches, as a part of its bound; what sees no
   light has none. */
static double worst_field_of(const hr2d_solution *s, const hr2d_solution *fine,
                             const hr2d_scene *scene, const hr2d_account *account,
                             const hr2d_account *of_fine) {
  const size_t patches = hr2d_scene_patches(scene);
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  double worst = 0;
  for (size_t k = 0; k < patches; k++) {
    const hr2d_segment p = hr2d_scene_segment(scene, k),
                       q = hr2d_scene_segment(scene, (k + 1) % patches);
    const hr2d_point at = {(2 * p.a.x + p.b.x + 3 * q.b.x) / 6,
                           (2 * p.a.y + p.b.y + 3 * q.b.y) / 6};
    double is, right, error, rest;
    options.account = account;
    values.mean = &is;
    values.error = &error;
    ck_assert_int_eq(hr2d_field_at(s, &at, 1, &options, &values), HR2D_OK);
    options.account = of_fine;
    values.mean = &right;
    values.error = &rest;
    ck_assert_int_eq(hr2d_field_at(fine, &at, 1, &options, &values), HR2D_OK);
    const double off = fabs(is - right) - rest;
    if (off > 0) worst = fmax(worst, off / error);
  }
  return worst;
}

START_TEST(bounds_hold_in_gas) {
  double worst = 0, point = 0, seen = 0;
  size_t solves = 0, reached = 0;
  for (int n = 0; n < test_count(600); n++) {
    hr2d_account account, of_fine;
    hr2d_scene *scene = draw(n);
    const size_t patches = hr2d_scene_patches(scene);
    hr2d_solution *fine = solve_to(scene, 1e-11, &account);
    of_fine = account;
    const double rest = fmax(account.average.estimate, account.irradiance.estimate);
    /* Corners of thick gas have fewer digits at points: what the truth is off counts. */
    const double b_off = account.sup.bound, h_off = account.irradiance_sup.bound;
    ck_assert_double_lt(rest, 1e-10);
    for (double error = 1e-2; error > 1e-9; error *= 1e-3) {
      hr2d_solution *s = solve_to(scene, error, &account);
      const double b = worst_of(s, fine, patches, hr2d_solution_average);
      const double h = worst_of(s, fine, patches, hr2d_solution_irradiance);
      ck_assert_msg(b <= account.average.bound, "%d to %g: B is off by %g, at most %g", n,
                    error, b, account.average.bound);
      ck_assert_msg(h <= account.irradiance.bound, "%d to %g: H is off by %g, at most %g", n,
                    error, h, account.irradiance.bound);
      const double pb = worst_point_of(s, fine, patches, hr2d_solution_gather) - b_off;
      const double ph =
          worst_point_of(s, fine, patches, hr2d_solution_gather_irradiance) - h_off;
      ck_assert_msg(pb <= account.sup.bound, "%d to %g: B at a point is off by %g, at most %g",
                    n, error, pb, account.sup.bound);
      ck_assert_msg(ph <= account.irradiance_sup.bound,
                    "%d to %g: H at a point is off by %g, at most %g", n, error, ph,
                    account.irradiance_sup.bound);
      const double field = worst_field_of(s, fine, scene, &account, &of_fine);
      ck_assert_msg(field <= 1, "%d to %g: M is off by %g of its bound", n, error, field);
      point = fmax(point, field);
      worst = fmax(worst, fmax(b / account.average.bound, h / account.irradiance.bound));
      point = fmax(point, fmax(pb / account.sup.bound, ph / account.irradiance_sup.bound));
      seen = fmax(seen, h);
      solves++;
      reached += fmax(account.average.estimate, account.irradiance.estimate) <= error;
      hr2d_solution_destroy(s);
    }
    hr2d_solution_destroy(fine);
    hr2d_scene_destroy(scene);
  }
  printf("errors are at most %.2f of their bounds, at points and in fields %.2f; %zu of %zu "
         "targets are "
         "reached\n",
         worst, point, reached, solves);
  ck_assert_uint_ge(100 * reached, 99 * solves);
  ck_assert_double_lt(worst, 1);
  ck_assert_double_gt(seen, 1e-5); /* negative control: there were errors to bound */
}
END_TEST

TEST_SUITE("gas bounds") {
  ADD_TESTS("bounds", bounds_hold_in_gas);
}
