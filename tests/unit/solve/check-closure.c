/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closure at order 1 loses no digits: averages with it and without it, against solutions to
   1e-11.  HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <math.h>
#include <string.h>

#include "hierarchy/hierarchy-impl.h"
#include "solve/equation.h"
#include "support/support.h"

/* Averages that are off by less than this are exact but for roundings and the reference. */
#define EXACT 2e-10

enum { CORNER, CONVEX, SCREENS, PLATES, SHORT_WALL, KINDS };

/* ε of each oracle. */
static const double coarsest[] = {0.1, 0.5, 0.4}, finest[] = {3e-4, 0.1, 0.1};

/* Half of the patches absorb all light. */
static void add(hr2d_scene *scene, randoms *r, hr2d_point a, hr2d_point b, hr2d_sides sides) {
  const double emission = random_below(r, 2) ? random_between(r, 0, 1) : 0;
  const double reflectance = random_below(r, 2) ? random_between(r, 0, 0.95) : 0;
  ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){a, b}, emission, reflectance, sides),
                   HR2D_OK);
}

static void add_polygon(hr2d_scene *scene, randoms *r, const hr2d_point *at, int count) {
  for (int k = 0; k < count; k++) add(scene, r, at[k], at[(k + 1) % count], HR2D_SIDES_FRONT);
}

static void add_convex(hr2d_scene *scene, randoms *r) {
  hr2d_point at[8];
  const int count = 3 + random_below(r, 5);
  for (int k = 0; k < count; k++) {
    const double angle = 6.28 * (k + random_between(r, 0, 0.9)) / count;
    at[k] = (hr2d_point){cos(angle), sin(angle)};
  }
  add_polygon(scene, r, at, count);
}

/* A screen stands on the floor or above it. */
static void add_screened_room(hr2d_scene *scene, randoms *r) {
  const double w = random_between(r, 1, 4), h = random_between(r, 1, 4);
  const int screens = 1 + random_below(r, 2);
  add_polygon(scene, r, (const hr2d_point[]){{0, 0}, {w, 0}, {w, h}, {0, h}}, 4);
  for (int k = 0; k < screens; k++) {
    const double x = w * (k + random_between(r, 0.2, 0.7)) / screens;
    const double y = random_below(r, 2) ? 0 : h * random_between(r, 0.1, 0.5);
    const hr2d_point top = {x + 0.2 * w / screens, y + 0.4 * h};
    add(scene, r, (hr2d_point){x, y}, top, HR2D_SIDES_BOTH);
  }
}

static hr2d_scene *draw(randoms *r, int kind) {
  hr2d_scene *scene = test_new_scene(NULL);
  const double open = kind == CORNER || kind == PLATES;
  const double size = random_power(r, -2, 0), angle = random_between(r, 0.05, 3);
  if (kind == CORNER) {
    add(scene, r, (hr2d_point){0, 0}, (hr2d_point){1, 0}, HR2D_SIDES_FRONT);
    add(scene, r, (hr2d_point){size * cos(angle), size * sin(angle)}, (hr2d_point){0, 0},
        HR2D_SIDES_FRONT);
  } else if (kind == PLATES) {
    add(scene, r, (hr2d_point){0, 0}, (hr2d_point){1, 0}, HR2D_SIDES_FRONT);
    add(scene, r, (hr2d_point){1.5, size}, (hr2d_point){0.2, size}, HR2D_SIDES_FRONT);
  } else if (kind == CONVEX) {
    add_convex(scene, r);
  } else if (kind == SCREENS) {
    add_screened_room(scene, r);
  } else {
    add_polygon(scene, r, (const hr2d_point[]){{0, 0}, {1, 0}, {1, size}, {1, 1}, {0, 1}}, 5);
  }
  if (open != 0) ck_assert_int_eq(hr2d_scene_set_background(scene, &open, 1), HR2D_OK);
  test_commit(scene);
  return scene;
}

static test_links draw_links(randoms *r, int kind) {
  static const char *const name[] = {"l1", "size", "size2"};
  const int oracle = random_below(r, 3);
  const double fine = log10(finest[oracle]), coarse = log10(coarsest[oracle]);
  test_links t =
      test_make_links(draw(r, kind), hr2d_oracle_find(name[oracle]), NULL,
                      hr2d_policy_find(random_below(r, 2) ? "original" : "modified"), NULL);
  test_refine(&t, random_power(r, fine, coarse), HR2D_DEFAULT_MAX_LEVEL);
  return t;
}

static double average_error(const hr2d_solution *solution, const hr2d_solution *reference,
                            size_t patches) {
  double worst = 0;
  for (size_t k = 0; k < patches; k++) {
    const double exact = hr2d_solution_average(reference, k, 0);
    if (exact > 0) worst = fmax(worst, fabs(hr2d_solution_average(solution, k, 0) / exact - 1));
  }
  return worst;
}

/* The error of B on leaves in the norm ∫B², with B of the reference integrated by two points.
 */
static double leaf_error(const test_links *t, const hr2d_solution *solution,
                         const hr2d_solution *reference) {
  const hr2d_element *element = t->hierarchy->element;
  double error = 0, size = 0;
  for (uint32_t e = 0; e < t->hierarchy->elements; e++) {
    if (element[e].child) continue;
    const double part = element[e].length / element[element[e].patch].length;
    const double middle = hr2di_element_start(t->hierarchy, e) + 0.5 * part;
    const double at[] = {middle - part * 0.28867513, middle + part * 0.28867513};
    double value[2];
    ck_assert_int_eq(hr2d_solution_gather(reference, element[e].patch, at, 2, value), HR2D_OK);
    const double exact = 0.5 * (value[0] + value[1]);
    error += element[e].length * pow(hr2d_solution_element(solution, e, 0) - exact, 2);
    size += element[e].length * exact * exact;
  }
  return size > 0 ? sqrt(error / size) : 0;
}

static hr2d_solution *reference_of(const hr2d_scene *scene) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-11;
  hr2d_solution *reference = NULL;
  hr2d_account account;
  const hr2d_status status = hr2d_solve_to(scene, &target, &reference, &account);
  ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
  return reference;
}

typedef struct tally {
  int exact, lost, other, leaves;
  double averages, on_leaves; /* sums of ln(error with / error without) */
} tally;

static void compare(tally *sum, randoms *r, int kind) {
  test_links t = draw_links(r, kind);
  const size_t patches = hr2d_scene_patches(t.scene);
  hr2d_solution *reference = reference_of(t.scene);
  hr2d_solution *with = test_solve(&t, 1), *without = test_solve(&t, 0);
  const double closed = average_error(with, reference, patches);
  const double open = average_error(without, reference, patches);
  if (open < EXACT) {
    sum->exact++;
    sum->lost += closed >= EXACT;
  } else {
    sum->other++;
    sum->averages += log(fmax(closed, EXACT) / open);
  }
  if (t.hierarchy->elements < 500) {
    const double even = leaf_error(&t, without, reference);
    const double spread = leaf_error(&t, with, reference);
    sum->leaves += even > EXACT;
    if (even > EXACT) sum->on_leaves += log(fmax(spread, EXACT) / even);
  }
  hr2d_solution_destroy(with);
  hr2d_solution_destroy(without);
  hr2d_solution_destroy(reference);
  test_free_links(&t);
}

START_TEST(averages_lose_no_digits) {
  randoms r = randoms_stream(test_seed(), 1);
  tally sum = {0};
  const int cases = (int)test_rounds(1000, 200);
  for (int k = 0; k < cases; k++) compare(&sum, &r, k % KINDS);
  printf("%d scenes exact without closure, of these %d worse with it; elsewhere the error is "
         "%.3f times that without, on leaves %.3f times\n",
         sum.exact, sum.lost, exp(sum.averages / sum.other), exp(sum.on_leaves / sum.leaves));
  ck_assert_int_gt(sum.exact, cases / 5);
  ck_assert_int_eq(sum.lost, 0);
  ck_assert_double_lt(exp(sum.averages / sum.other), 0.8);
  ck_assert_double_lt(exp(sum.on_leaves / sum.leaves), 0.3);
}
END_TEST

/* B on leaves with exact rows as d·B on the diagonal makes them. */
static void solve_diagonally(hr2di_equation *eq, hr2d_linkset *links) {
  const hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  ck_assert_int_eq(hr2di_equation_init(eq, links, links->hierarchy->scene,
                                       &(hr2di_equation_how){0}, &options),
                   HR2D_OK);
  hr2di_transport *t = &eq->transport;
  for (size_t k = 0; k < eq->field; k++) eq->work[k] = 1;
  hr2di_transport_apply(t, eq->work, eq->b);
  ck_assert_ptr_nonnull(t->receive);
  for (size_t e = 0; e < t->elements; e++) t->receive[e] = 1;
  hr2di_transport_apply(t, eq->work, eq->y);
  for (size_t k = 0; k < eq->field; k++) t->closure[k] += eq->b[k] - eq->y[k];
  memset(eq->y, 0, eq->field * sizeof *eq->y);
  ck_assert_int_eq(hr2di_equation_solve(eq), HR2D_OK);
}

/* Negative control: the comparison sees the digits that a closure on the diagonal loses. */
START_TEST(diagonal_loses_digits) {
  hr2d_scene *scene = test_new_scene(NULL);
  const double sky = 1;
  const hr2d_segment shelf = {{0.0996, 0.0087}, {0, 0}}, floor = {{0, 0}, {1, 0}};
  ck_assert_int_eq(test_add_patch(scene, floor, 0, 0.5, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(test_add_patch(scene, shelf, 0, 0, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
  test_commit(scene);
  test_links t =
      test_make_links(scene, hr2d_oracle_l1(), NULL, hr2d_policy_find("modified"), NULL);
  test_refine(&t, 0.01, HR2D_DEFAULT_MAX_LEVEL);
  hr2d_solution *reference = reference_of(scene), *with = test_solve(&t, 1);
  hr2di_equation eq;
  solve_diagonally(&eq, t.links);
  hr2di_transport_pull(&eq.transport, eq.radiosity);
  const double exact = hr2d_solution_average(reference, 0, 0);
  ck_assert_double_gt(fabs(ldexp(eq.transport.up[0], eq.exponent[0]) / exact - 1), 1e-3);
  ck_assert_double_lt(average_error(with, reference, 2), 1e-13);
  hr2di_equation_clear(&eq);
  hr2d_solution_destroy(with);
  hr2d_solution_destroy(reference);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("closure") {
  ADD_TESTS("digits", averages_lose_no_digits, diagonal_loses_digits);
}
