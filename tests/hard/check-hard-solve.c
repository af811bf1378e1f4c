/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard cases of the solve, in which textbook code stalls, diverges or is silently wrong:
   reflectances up to 1 − 1e-15, scenes that absorb hardly anything, rows above 1, light of
   any size. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/hard-rooms.h"
#include "support/hard.h"
#include "support/support.h"

/* Takes over the scene. */
static test_links linked(hr2d_scene *scene, unsigned order, double epsilon) {
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, order), HR2D_OK);
  test_refine(&t, epsilon, HR2D_DEFAULT_MAX_LEVEL);
  return t;
}

/* Σ over patches; 1 − ρ is exact for ρ ≥ ½. */
typedef struct totals {
  double emitted, absorbed, radiosity;
  double net;   /* what leaves walls less what falls on them */
  double worst; /* |B/mean − 1| */
} totals;

static totals sum_up(const hard_room *room, const hr2d_scene *scene, const hr2d_solution *s) {
  totals sum = {0, 0, 0, 0, 0};
  double length = 0;
  for (size_t k = 0; k < room->walls; k++) {
    const double a = hr2d_scene_length(scene, k);
    length += a;
    sum.emitted += a * room->wall[k][4];
    sum.absorbed += a * (1 - room->wall[k][5]) * hr2d_solution_irradiance(s, k, 0);
    sum.net += a * hr2d_solution_net_flux(s, k, 0);
    sum.radiosity += a * hr2d_solution_average(s, k, 0);
  }
  for (size_t k = 0; k < room->walls; k++)
    sum.worst =
        fmax(sum.worst, fabs(hr2d_solution_average(s, k, 0) * length / sum.radiosity - 1));
  return sum;
}

/* With one ρ everywhere ∫B = ∫E/(1−ρ).  Returns the relative error. */
static double check_total(const hard_room *room, const hr2d_scene *scene,
                          const hr2d_solution *s) {
  const double loss = 1 - room->wall[0][5];
  const totals sum = sum_up(room, scene, s);
  const double error = fabs(sum.radiosity * loss / sum.emitted - 1);
  ck_assert_msg(error <= 1e-14, "%s, 1 - rho = %g: total off by %g", room->name, loss, error);
  ck_assert_double_eq_tol(sum.absorbed / sum.emitted, 1, 1e-14);
  ck_assert_double_eq_tol(sum.net / sum.emitted, 0, 1e-14);
  const hr2d_power power = hr2d_solution_power(s, 0);
  ck_assert_double_eq_tol(power.absorbed / sum.emitted, 1, 1e-14);
  ck_assert_double_eq(power.escaped, 0);
  return error;
}

/* In rooms without narrow corners B varies by at most a multiple of 1 − ρ, the part that one
   reflection absorbs. */
static double check_room(hard_room (*make)(double rho), int k, unsigned order) {
  const hard_room room = make(1 - pow(10, -k));
  test_links t = linked(hard_scene(&room), order, 0.5);
  hr2d_solution *solution = test_solve(&t, 1);
  const double error = check_total(&room, t.scene, solution);
  ck_assert_double_le(sum_up(&room, t.scene, solution).worst,
                      8 * (double)room.walls * (1 - room.wall[0][5]) + 1e-13);
  ck_assert_uint_lt(hr2d_solution_work(solution).iterations, 40);
  ck_assert_double_le(hr2d_solution_residual(solution), 1e-14);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  return error;
}

static hard_room (*const rooms[])(double rho) = {hard_square, hard_l_shape, hard_with_occluder,
                                                 hard_circle};

static int some_rooms(void) {
  return test_multiplier() < 0.1 ? 3 : 4;
}

START_TEST(totals_of_bright_rooms) {
  double worst = 0;
  for (int r = 0; r < some_rooms(); r++)
    for (int k = 1; k <= 15; k++)
      for (unsigned order = 1; order <= 4; order += 3)
        worst = fmax(worst, check_room(rooms[r], k, order));
  printf("largest relative error of a total %.1e\n", worst);
  /* Negative control: sweeps with strings creep, sweeps with midpoints run away. */
  for (int k = 3; k <= 15; k += 4) {
    const hard_room room = hard_square(1 - pow(10, -k));
    const unsigned limit = k == 3 ? 100000 : 2000;
    const hard_sweeps slow = hard_gauss_seidel(&room, HARD_STRINGS, 8, limit);
    const double off = fabs(slow.total * pow(10, -k) - 1);
    ck_assert_msg(k == 3 ? slow.count > 1000 : off > 0.9, "%u sweeps, off by %g", slow.count,
                  off);
    hard_case("solve", hard_format("square room, ρ = 1 − 1e-%d", k).text,
              hard_format("Gauss-Seidel: ∫B off by %.0e after %u sweeps", off, slow.count),
              hard_format("off by %.0e", check_room(hard_square, k, 1)));
  }
  const hard_room room = hard_square(1 - 1e-3);
  const hard_sweeps wild = hard_gauss_seidel(&room, HARD_MIDPOINTS, 8, 20000);
  ck_assert(!wild.finite || wild.total > 1e6);
  hard_case("solve", "the same, form factors of midpoints, ρ = 0.999",
            hard_format("diverges: ∫B = %.0e after %u sweeps", wild.total, wild.count),
            hard_format("off by %.0e", check_room(hard_square, 3, 1)));
}
END_TEST

START_TEST(targets_in_bright_rooms) {
  for (int r = 0; r < some_rooms(); r++)
    for (int k = 1; k <= 15; k += test_multiplier() < 1 ? 7 : 2) {
      const hard_room room = rooms[r](1 - pow(10, -k));
      hr2d_scene *scene = hard_scene(&room);
      hr2d_solution *solution;
      hr2d_account account;
      ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, &account), HR2D_OK);
      const double error = check_total(&room, scene, solution);
      ck_assert_double_le(account.average.estimate, 5e-7);
      ck_assert_double_ge(account.average.bound, error);
      hr2d_solution_destroy(solution);
      hr2d_scene_destroy(scene);
    }
}
END_TEST

START_TEST(any_reflectances_balance) {
  unsigned long state = test_seed();
  const int rounds = (int)test_rounds(60, 4);
  for (int round = 0; round < rounds; round++) {
    hard_room room = rooms[round % 3](0);
    for (size_t k = 0; k < room.walls; k++) {
      room.wall[k][4] = pow(10, 20 * test_random(&state) - 10);
      const double draw = test_random(&state);
      room.wall[k][5] = draw < .2 ? 1 : draw < .4 ? 0 : 1 - pow(10, -16 * test_random(&state));
    }
    room.wall[0][5] = 1 - pow(10, -16 * test_random(&state));
    if (room.wall[0][5] == 1) continue;
    test_links t = linked(hard_scene(&room), 1 + 3 * (unsigned)(round & 1), 0.5);
    hr2d_solution *solution = test_solve(&t, 1);
    const totals sum = sum_up(&room, t.scene, solution);
    ck_assert_double_eq_tol(sum.absorbed / sum.emitted, 1, 1e-14);
    for (size_t k = 0; k < room.walls; k++)
      ck_assert_double_ge(hr2d_solution_average(solution, k, 0), 0);
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
}
END_TEST

/* A square whose left wall has a gap of a length in its middle, or a black plug in it; ρ = 1
   elsewhere. */
static hard_room gap_room(double gap, int plugged) {
  const double corner[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, .5 + gap}, {0, .5}};
  hard_room room = hard_polygon("gap", corner, 6, 0, 1);
  if (plugged)
    room.wall[4][5] = 0;
  else
    memcpy(room.wall[4], room.wall[5], sizeof room.wall[4]);
  room.walls -= !plugged;
  return room;
}

START_TEST(hardly_a_way_out) {
  for (int k = 1; k <= 12; k++) {
    const double gap = .5 + pow(10, -k) - .5; /* the gap between the rounded coordinates */
    const hard_room plugged = gap_room(gap, 1), open = gap_room(gap, 0);
    test_links t = linked(hard_scene(&plugged), 12, 0.4),
               u = linked(hard_scene(&open), 12, 0.4);
    hr2d_solution *exact = test_solve(&t, 1), *leaking = test_solve(&u, 1);
    /* All emitted power is absorbed by the plug, or escapes through the gap. */
    ck_assert_double_eq_tol(hr2d_solution_irradiance(exact, 4, 0) * gap, 1, 1e-14);
    ck_assert_double_eq_tol(hr2d_solution_power(leaking, 0).escaped, 1, 1e-13);
    /* Rounding of exchange areas may lose 2⁻⁵² of the 4 walls; the part `gap` escapes. */
    const double off =
        fabs(hr2d_solution_average(leaking, 0, 0) / hr2d_solution_average(exact, 0, 0) - 1);
    ck_assert_msg(off <= 1e-10 + 8 * DBL_EPSILON / gap, "gap %g: off by %g", gap, off);
    if (k % 4 == 0) {
      const hard_sweeps slow = hard_gauss_seidel(&plugged, HARD_STRINGS, 8, 2000);
      const double lost = fabs(slow.total / (4 * hr2d_solution_average(exact, 0, 0)) - 1);
      ck_assert_double_gt(lost, 0.1);
      hard_case("solve", hard_format("ρ = 1 but on 1e-%d of a wall, which is black", k).text,
                hard_format("Gauss-Seidel: off by %.0e after %u sweeps", lost, slow.count),
                hard_format("absorbed off by %.0e",
                            fabs(hr2d_solution_irradiance(exact, 4, 0) * gap - 1)));
    }
    hr2d_solution_destroy(exact);
    hr2d_solution_destroy(leaking);
    test_free_links(&t);
    test_free_links(&u);
  }
}
END_TEST

/* What hr2d_solve_to() says of a leak it cannot know well is true. */
START_TEST(leaks_have_honest_bounds) {
  for (int k = 3; k <= 12; k += 3) {
    const double gap = .5 + pow(10, -k) - .5;
    const hard_room plugged = gap_room(gap, 1), open = gap_room(gap, 0);
    hr2d_scene *one = hard_scene(&plugged), *other = hard_scene(&open);
    hr2d_solution *exact, *leaking;
    hr2d_account account;
    ck_assert_int_eq(hr2d_solve_to(one, NULL, &exact, NULL), HR2D_OK);
    const hr2d_status status = hr2d_solve_to(other, NULL, &leaking, &account);
    const int reached = account.average.estimate <= 0.5 * HR2D_DEFAULT_ERROR ||
                        account.average.bound <= HR2D_DEFAULT_ERROR;
    ck_assert_int_eq(status, reached ? HR2D_OK : HR2D_EACCURACY);
    ck_assert(k == 3 ? reached : k < 12 || !reached);
    const double off =
        fabs(hr2d_solution_average(leaking, 0, 0) / hr2d_solution_average(exact, 0, 0) - 1);
    ck_assert_msg(off <= account.average.bound && off <= 4 * account.average.estimate + 1e-6,
                  "gap %g: off by %g, told %g and %g", gap, off, account.average.estimate,
                  account.average.bound);
    hr2d_solution_destroy(exact);
    hr2d_solution_destroy(leaking);
    hr2d_scene_destroy(one);
    hr2d_scene_destroy(other);
  }
}
END_TEST

static void check_none(const hard_room *room, const char *who) {
  test_links t = linked(hard_scene(room), 1, 0.5);
  hr2d_solution *solution = NULL;
  ck_assert_int_eq(hr2d_solve(t.links, NULL, &solution), HR2D_ENO_SOLUTION);
  ck_assert_ptr_null(solution);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), who));
  hr2d_account account;
  ck_assert_int_eq(hr2d_solve_to(t.scene, NULL, &solution, &account), HR2D_ENO_SOLUTION);
  ck_assert_ptr_null(solution);
  ck_assert_ptr_nonnull(strstr(account.reason, who));
  test_free_links(&t);
}

START_TEST(nothing_absorbs) {
  const hard_room square = hard_square(1), circle = hard_circle(1);
  check_none(&square, "patch 0 emits");
  check_none(&circle, "patch 7 emits");
  const hard_sweeps growing = hard_gauss_seidel(&square, HARD_STRINGS, 8, 2000);
  ck_assert(growing.finite && growing.total > 100);
  hard_case("solve", "closed, ρ = 1, lit: there is no solution",
            hard_format("Gauss-Seidel: ∫B = %.0f after %u sweeps, and growing", growing.total,
                        growing.count),
            hard_format("HR2D_ENO_SOLUTION names the patch"));
  /* A closed room of ρ = 1 in the box: dark it is fine, and lit not. */
  hard_room room = hard_square(.5);
  const double inner[][2] = {{.4, .4}, {.6, .4}, {.6, .6}, {.4, .6}};
  const hard_room closed = hard_polygon("", inner, 4, 0, 1);
  memcpy(room.wall[4], closed.wall, 4 * sizeof *closed.wall);
  room.walls = 8;
  check_none(&room, "patch 4 emits");
  room.wall[4][4] = 0;
  test_links t = linked(hard_scene(&room), 1, 0.5);
  hr2d_solution *solution = test_solve(&t, 1);
  for (size_t k = 4; k < 8; k++) ck_assert_double_eq(hr2d_solution_average(solution, k, 0), 0);
  ck_assert_double_gt(hr2d_solution_average(solution, 2, 0), 0);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}
END_TEST

/* A square with E of each wall in each band, given as powers of two. */
static hr2d_scene *scaled_square(const int *exponent, size_t bands, const double *background,
                                 double rho) {
  const hard_room room = hard_square(rho);
  hr2d_scene *scene;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  if (background)
    ck_assert_int_eq(hr2d_scene_set_background(scene, background, bands), HR2D_OK);
  for (size_t k = 0; k < 4 - (background != NULL); k++) {
    double e[4] = {0};
    for (size_t b = 0; b < bands && exponent; b++)
      e[b] = ldexp(1 + .25 * (double)k, exponent[b]);
    hr2d_patch p = HR2D_PATCH_INIT;
    p.a = (hr2d_point){room.wall[k][0], room.wall[k][1]};
    p.b = (hr2d_point){room.wall[k][2], room.wall[k][3]};
    p.emission = e;
    p.emission_bands = bands;
    p.reflectance = &rho;
    p.reflectance_bands = 1;
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

/* Conjugate gradients as they stand in books, on E = (e, 0, 0, 0) in the square with one
   element per wall: stops where ‖r‖ ≤ 1e-12‖B‖, after none where squares overflow. */
static double textbook_conjugate_gradients(double e, double rho) {
  const double opposite = sqrt(2) - 1, beside = (1 - opposite) / 2;
  double b[4] = {e, 0, 0, 0}, y[4] = {e, 0, 0, 0}, r[4], p[4];
  for (int k = 0; k < 4; k++) {
    double sum = 0;
    for (int m = 0; m < 4; m++)
      sum += m == k ? 0 : (m ^ k) == 2 ? opposite * y[m] : beside * y[m];
    r[k] = p[k] = b[k] + rho * sum - y[k];
  }
  for (int step = 0; step < 100; step++) {
    double rr = 0, bb = 0, pq = 0, next = 0, q[4];
    for (int k = 0; k < 4; k++) rr += r[k] * r[k], bb += y[k] * y[k];
    if (sqrt(rr) <= 1e-12 * sqrt(bb)) break;
    for (int k = 0; k < 4; k++) {
      q[k] = p[k];
      for (int m = 0; m < 4; m++)
        q[k] -= rho * (m == k ? 0 : (m ^ k) == 2 ? opposite * p[m] : beside * p[m]);
      pq += p[k] * q[k];
    }
    for (int k = 0; k < 4; k++) y[k] += rr / pq * p[k], r[k] -= rr / pq * q[k];
    for (int k = 0; k < 4; k++) next += r[k] * r[k];
    for (int k = 0; k < 4; k++) p[k] = r[k] + next / rr * p[k];
  }
  return y[0] + y[1] + y[2] + y[3];
}

START_TEST(light_of_any_size) {
  const int one = 0, many[] = {1000, -1000, 0, -1020};
  for (unsigned order = 1; order <= 4; order += 3) {
    test_links t = linked(scaled_square(&one, 1, NULL, .9), order, 0.3);
    test_links u = linked(scaled_square(many, 4, NULL, .9), order, 0.3);
    hr2d_solution *plain = test_solve(&t, 1), *scaled = test_solve(&u, 1);
    for (size_t k = 0; k < 4; k++)
      for (size_t b = 0; b < 4; b++) {
        const double expected = ldexp(hr2d_solution_average(plain, k, 0), many[b]);
        ck_assert_double_eq_tol(hr2d_solution_average(scaled, k, b) / expected, 1, 4e-15);
      }
    hr2d_solution_destroy(plain);
    hr2d_solution_destroy(scaled);
    test_free_links(&t);
    test_free_links(&u);
  }
  const double book = textbook_conjugate_gradients(1e300, .9);
  ck_assert_double_eq_tol(textbook_conjugate_gradients(1, .9), 10, 1e-10);
  ck_assert(!(fabs(book / 1e301 - 1) < 0.5));
  hard_case("solve", "E = 1e300 beside bands of 1e-300 and 1",
            hard_format("conjugate gradients: ∫B = %.1e, not 1e+301, no error", book),
            hard_format("each band as if alone, to 4e-15"));
}
END_TEST

START_TEST(light_beyond_doubles) {
  const int huge = 1022, denormal = -1074;
  test_links t = linked(scaled_square(&huge, 1, NULL, .9), 1, 0.3);
  hr2d_solution *solution = NULL;
  ck_assert_int_eq(hr2d_solve(t.links, NULL, &solution), HR2D_ERANGE);
  ck_assert_ptr_null(solution);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "beyond"));
  ck_assert_int_eq(hr2d_solve_to(t.scene, NULL, &solution, NULL), HR2D_ERANGE);
  test_free_links(&t);
  /* Where light is denormal B is rounded once, at the end: here 10 and more quanta. */
  t = linked(scaled_square(&denormal, 1, NULL, .9), 1, 0.3);
  const int one = 0;
  test_links u = linked(scaled_square(&one, 1, NULL, .9), 1, 0.3);
  hr2d_solution *plain = test_solve(&u, 1);
  solution = test_solve(&t, 1);
  for (size_t k = 0; k < 4; k++) {
    const double quanta = 1 + .25 * (double)k; /* E itself is rounded to whole ones */
    ck_assert_double_ge(hr2d_solution_average(solution, k, 0), ldexp(5, denormal));
    ck_assert_double_le(hr2d_solution_average(solution, k, 0),
                        ldexp(hr2d_solution_average(plain, k, 0) + 10 * quanta, denormal));
  }
  hr2d_solution_destroy(plain);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  test_free_links(&u);
}
END_TEST

START_TEST(background_of_any_size) {
  const double sizes[] = {1e-310, 1e-300, 1, 1e300};
  double first = 0;
  for (int k = 0; k < 4; k++) {
    test_links t = linked(scaled_square(NULL, 1, &sizes[k], .9), 1, 0.3);
    hr2d_solution *solution = test_solve(&t, 1);
    const double b = hr2d_solution_average(solution, 0, 0) / sizes[k];
    const hr2d_power p = hr2d_solution_power(solution, 0);
    if (k == 0) first = b;
    ck_assert_double_eq_tol(b / first, 1, 1e-12);
    ck_assert_double_eq_tol((p.absorbed + p.escaped) / p.received, 1, 1e-12);
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
}
END_TEST

/* A solve returns a solution, or a status that says why there is none. */
static void check_honest(const test_links *t, const hr2d_solve_options *options) {
  hr2d_solution *solution = NULL;
  const hr2d_status status = hr2d_solve(t->links, options, &solution);
  if (status) {
    ck_assert_int_eq(status, HR2D_ENOT_CONVERGED);
    ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t->links), "finer links"));
    return;
  }
  for (size_t k = 0; k < hr2d_scene_patches(t->scene); k++) {
    ck_assert(isfinite(hr2d_solution_average(solution, k, 0)));
    ck_assert_double_ge(hr2d_solution_average(solution, k, 0), 0);
  }
  ck_assert_double_le(hr2d_solution_residual(solution), 1e-12);
  hr2d_solution_destroy(solution);
}

START_TEST(rows_above_one) {
  int refused = 0, solved = 0;
  for (int k = 1; k <= 9; k += 4)
    for (int r = 0; r < 3; r++)
      for (int ordered = 0; ordered < 2; ordered++)
        for (unsigned order = 1; order <= 3; order++) {
          const hard_room room = rooms[r](1 - pow(10, -k));
          test_links t = test_make_links(hard_scene(&room), NULL, NULL, NULL, NULL);
          hr2d_hierarchy_set_order(t.hierarchy, order);
          hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
          refine.epsilon = order > 1 ? 1.5 : .5;
          refine.ordered = ordered;
          ck_assert_int_eq(hr2d_refine(t.links, &refine), HR2D_OK);
          hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
          options.closure = HR2D_CLOSURE_OFF;
          hr2d_solution *solution = NULL;
          const int fine = hr2d_solve(t.links, &options, &solution) == HR2D_OK;
          hr2d_solution_destroy(solution);
          refused += !fine;
          solved += fine;
          check_honest(&t, &options);
          options.closure = HR2D_CLOSURE_ON;
          check_honest(&t, &options);
          test_free_links(&t);
        }
  printf("%d refused, %d solved without closure\n", refused, solved);
  ck_assert_int_gt(refused, 5);
  ck_assert_int_gt(solved, 5);
  hard_case("solve", "links too coarse, so that rows exceed 1, and ρ near 1",
            hard_format("sweeps diverge; BiCGSTAB gives B < 0"),
            hard_format("HR2D_ENOT_CONVERGED in %d of %d; none with closure", refused,
                        refused + solved));
}
END_TEST

START_TEST(narrow_wedges_at_all_orders) {
  static const unsigned orders[] = {2, 3, 4, 8, 16, 32};
  for (double height = .1; height >= .001; height /= 10)
    for (int k = 0; k < 6; k++)
      for (double epsilon = HUGE_VAL; epsilon > 1; epsilon = epsilon > 2 ? 1.4 : 0) {
        /* Seconds each. */
        if (test_multiplier() < 1 && epsilon < 2 && orders[k] > 2000 * height) break;
        const double corner[][2] = {{0, 0}, {1, 0}, {.5, height}};
        const hard_room room = hard_polygon("wedge", corner, 3, 0, .999);
        test_links t = linked(hard_scene(&room), orders[k], epsilon);
        check_honest(&t, NULL);
        hr2d_solution *solution;
        if (!hr2d_solve(t.links, NULL, &solution)) {
          check_total(&room, t.scene, solution);
          hr2d_solution_destroy(solution);
        }
        test_free_links(&t);
      }
}
END_TEST

START_TEST(targets_in_narrow_wedges) {
  const double min = test_multiplier() < 0.1 ? .003 : 1e-4;
  for (double height = .3; height >= min; height /= 10)
    for (int k = 3; k <= 15; k += 4) {
      const double corner[][2] = {{0, 0}, {1, 0}, {1, height}};
      const hard_room room = hard_polygon("wedge", corner, 3, 0, 1 - pow(10, -k));
      hr2d_scene *scene = hard_scene(&room);
      hr2d_target target = HR2D_TARGET_INIT;
      target.error = 1e-2; /* a low order, which is the one that may fail */
      hr2d_solution *solution;
      hr2d_account account;
      const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
      ck_assert_msg(status == HR2D_OK, "height %g, k %d: %s", height, k, account.reason);
      check_total(&room, scene, solution);
      hr2d_solution_destroy(solution);
      hr2d_scene_destroy(scene);
    }
}
END_TEST

/* An oracle and a policy without sense. */
static hr2d_status senseless_estimate(void *ctx, const hr2d_batch *batch, double *error) {
  unsigned long *state = ctx;
  for (size_t k = 0; k < batch->count; k++)
    error[k] = test_random(state) < .6 ? 0 : test_random(state) < .1 ? HUGE_VAL : DBL_MAX;
  return HR2D_OK;
}

static hr2d_status senseless_split(void *ctx, const hr2d_batch *batch, unsigned char *split) {
  unsigned long *state = ctx;
  for (size_t k = 0; k < batch->count; k++) split[k] = (unsigned char)(3 * test_random(state));
  return HR2D_OK;
}

START_TEST(senseless_callbacks) {
  static const hr2d_policy policy = {.struct_size = sizeof policy,
                                     .name = "senseless",
                                     .preferred_subdivision = senseless_split};
  unsigned long state = test_seed();
  const int rounds = (int)test_rounds(100, 6);
  for (int round = 0; round < rounds; round++) {
    const hr2d_oracle oracle = {.struct_size = sizeof oracle,
                                .name = "senseless",
                                .flags = round % 2 ? HR2D_ORACLE_SYMMETRIC : 0,
                                .estimate = senseless_estimate};
    const hard_room room = rooms[round % 3](1 - pow(10, -(round % 12)));
    test_links t = test_make_links(hard_scene(&room), &oracle, &state, &policy, &state);
    hr2d_hierarchy_set_order(t.hierarchy, 1 + (unsigned)round % 5);
    test_refine(&t, .1, 12);
    hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
    options.closure = round % 3 ? HR2D_CLOSURE_ON : HR2D_CLOSURE_OFF;
    options.max_iterations = 2000;
    check_honest(&t, &options);
    hr2d_solution *solution = NULL;
    if (round % 2 && round % 12 > 0 && round % 5 == 0)
      if (!hr2d_solve(t.links, NULL, &solution)) check_total(&room, t.scene, solution);
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(options_at_their_ends) {
  const hard_room room = hard_square(1 - 1e-6);
  test_links t = linked(hard_scene(&room), 1, 0.3), u = linked(hard_scene(&room), 1, 0.3);
  hr2d_solution *solution = NULL;
  static const double refused[] = {-1, 9e-16, NAN, INFINITY};
  for (size_t k = 0; k < 4; k++) {
    hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
    options.tolerance = refused[k];
    ck_assert_int_eq(hr2d_solve(t.links, &options, &solution), HR2D_EINVAL);
    ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "tolerance"));
  }
  for (unsigned k = 1; k < 3; k++) {
    hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
    options.max_iterations = k;
    ck_assert_int_eq(hr2d_solve(t.links, &options, &solution), HR2D_ENOT_CONVERGED);
    ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "relative residual"));
    ck_assert_ptr_null(solution);
    options.tolerance = 1; /* all but nothing is asked: the balance alone */
    ck_assert_int_eq(hr2d_solve(t.links, &options, &solution), HR2D_OK);
    const totals sum = sum_up(&room, t.scene, solution);
    ck_assert_double_eq_tol(sum.absorbed / sum.emitted, 1, 1e-14);
    hr2d_solution_destroy(solution);
    solution = NULL;
  }
  /* A start from elsewhere is refused; from another light, another order and no closure it
     leaves no trace. */
  hr2d_solution *start = test_solve(&u, 1), *cold = test_solve(&t, 1);
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.start = start;
  ck_assert_int_eq(hr2d_solve(t.links, &options, &solution), HR2D_EINVAL);
  hr2d_solution_destroy(start);
  hr2d_hierarchy_set_order(t.hierarchy, 3);
  options.start = NULL;
  options.tolerance = 1;
  options.closure = HR2D_CLOSURE_OFF;
  ck_assert_int_eq(hr2d_solve(t.links, &options, &start), HR2D_OK);
  hr2d_hierarchy_set_order(t.hierarchy, 1);
  options = (hr2d_solve_options)HR2D_SOLVE_OPTIONS_INIT;
  options.start = start;
  ck_assert_int_eq(hr2d_solve(t.links, &options, &solution), HR2D_OK);
  for (size_t k = 0; k < 4; k++)
    ck_assert_double_eq_tol(
        hr2d_solution_average(solution, k, 0) / hr2d_solution_average(cold, k, 0), 1, 1e-13);
  hr2d_solution_destroy(start);
  hr2d_solution_destroy(cold);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  test_free_links(&u);
}
END_TEST

START_TEST(targets_at_their_ends) {
  const hard_room room = hard_square(.9);
  hr2d_scene *scene = hard_scene(&room);
  const struct {
    double error, seconds;
    hr2d_status status;
    int solved;
  } cases[] = {{1e-300, 0, HR2D_EACCURACY, 1},
               {0, 0, HR2D_OK, 1},
               {HR2D_SMALLEST_ERROR, 0, HR2D_OK, 1},
               {HUGE_VAL, 0, HR2D_OK, 1},
               {NAN, 0, HR2D_EINVAL, 0},
               {-1, 0, HR2D_EINVAL, 0},
               {1e-6, NAN, HR2D_EINVAL, 0},
               {1e-6, -1, HR2D_EINVAL, 0},
               {1e-6, HUGE_VAL, HR2D_OK, 1},
               {1e-6, 5e-324, HR2D_EACCURACY, 1}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    hr2d_target target = HR2D_TARGET_INIT;
    target.error = cases[k].error;
    target.seconds = cases[k].seconds;
    hr2d_solution *solution;
    hr2d_account account;
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
    ck_assert_msg(status == cases[k].status && (solution != NULL) == cases[k].solved,
                  "error %g, seconds %g: status %d", target.error, target.seconds, status);
    if (solution && isfinite(account.average.bound)) check_total(&room, scene, solution);
    if (status == HR2D_EACCURACY) ck_assert_int_gt((int)strlen(account.reason), 0);
    hr2d_solution_destroy(solution);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Convex rooms with narrow corners and gaps. */
typedef struct nasty_shape {
  const char *name;
  size_t corners;
  double corner[6][2];
} nasty_shape;

static const nasty_shape nasty_shapes[] = {
    {"wedge 1:4", 3, {{0, 0}, {1, 0}, {.5, .25}}},
    {"wedge 1:10", 3, {{0, 0}, {1, 0}, {.5, .1}}},
    {"needle 1:10", 3, {{0, 0}, {1, 0}, {1, .1}}},
    {"needle 1:20", 3, {{0, 0}, {1, 0}, {1, .05}}},
    {"corridor 1:20", 4, {{0, 0}, {1, 0}, {1, .05}, {0, .05}}},
    {"corridor 1:100", 4, {{0, 0}, {1, 0}, {1, .01}, {0, .01}}},
    {"rhombus 1:10", 4, {{0, 0}, {.5, -.05}, {1, 0}, {.5, .05}}},
    {"cut wedge", 4, {{0, 0}, {1, 0}, {1, .02}, {0, .1}}},
    {"tiny wall", 5, {{0, 0}, {1, 0}, {1, 1}, {1e-3, 1}, {0, .999}}},
    {"blunt corners", 5, {{0, 0}, {.5, -.01}, {1, 0}, {1, 1}, {0, 1}}},
};

enum { NASTY_SHAPES = sizeof nasty_shapes / sizeof *nasty_shapes, NASTY_PAINTS = 3 };

/* ρ = 0.999 everywhere; beside it one black wall; or walls of all kinds. */
static hard_room nasty_room(int k, int paint) {
  const nasty_shape *s = &nasty_shapes[k];
  hard_room room = hard_polygon(s->name, s->corner, s->corners, 0, .999);
  static const double mixed[] = {.999, .3, .9, 1, .7, .99};
  if (paint == 1) room.wall[1][5] = 0;
  for (size_t w = 0; w < room.walls && paint == 2; w++) room.wall[w][5] = mixed[w];
  return room;
}

START_TEST(nasty_rooms_agree_with_another_method) {
  if (!test_has_long_double()) return;
  const int levels = test_multiplier() < 1 ? 3 : 4;
  double worst = 0;
  for (int k = 0; k < NASTY_SHAPES * NASTY_PAINTS; k++) {
    if (test_multiplier() < 1 && k % NASTY_PAINTS != k / NASTY_PAINTS % NASTY_PAINTS) continue;
    const hard_room room = nasty_room(k / NASTY_PAINTS, k % NASTY_PAINTS);
    double average[4][HARD_WALLS];
    for (int m = 0; m < levels; m++) hard_averages(&room, (size_t)1 << m, average[m]);
    hr2d_scene *scene = hard_scene(&room);
    hr2d_solution *solution;
    hr2d_account account;
    const hr2d_status status = hr2d_solve_to(scene, NULL, &solution, &account);
    ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s: status %d", room.name,
                  status);
    double error = 0, doubt = 0;
    for (size_t w = 0; w < room.walls; w++) {
      /* Extrapolation removes errors of orders 2 and 4.  The remaining error is less than
         the last change by extrapolation. */
      for (int order = 1; order < 3; order++)
        for (int m = levels - 1; m >= order; m--)
          average[m][w] += (average[m][w] - average[m - 1][w]) / (order == 1 ? 3 : 15);
      const double reference = average[levels - 1][w];
      error = fmax(error, fabs(hr2d_solution_average(solution, w, 0) / reference - 1));
      doubt = fmax(doubt, fabs(average[levels - 2][w] / reference - 1));
    }
    printf("%-15s paint %d: off %.1e, estimate %.1e, bound %.1e, doubt %.1e%s\n", room.name,
           k % NASTY_PAINTS, error, account.average.estimate, account.average.bound, doubt,
           status ? ", not reached" : "");
    ck_assert_double_le(error, account.average.bound + doubt);
    ck_assert_double_le(error, 2 * account.average.estimate + doubt + 1e-12);
    worst = fmax(worst, error - doubt);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  ck_assert_double_le(worst, 1e-6);
}
END_TEST

TEST_SUITE("hard cases of the solve") {
  ADD_TESTS("balance", totals_of_bright_rooms, targets_in_bright_rooms,
            any_reflectances_balance, hardly_a_way_out, leaks_have_honest_bounds,
            nothing_absorbs);
  ADD_TESTS("range", light_of_any_size, light_beyond_doubles, background_of_any_size);
  ADD_TESTS("rows", rows_above_one, narrow_wedges_at_all_orders, targets_in_narrow_wedges,
            senseless_callbacks);
  ADD_TESTS("ends", options_at_their_ends, targets_at_their_ends);
  ADD_TESTS("another method", nasty_rooms_agree_with_another_method);
}
