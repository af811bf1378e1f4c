/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches of very different lengths: powers are balanced, and a solve ends with a solution or a
   status that says why not.  HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change
   the scenes. */
#include <math.h>

#include "solve/equation.h"
#include "support/support.h"

static void check_power(const hr2d_solution *solution, const char *what, double ratio) {
  const hr2d_power p = hr2d_solution_power(solution, 0);
  const double in = p.emitted + p.received;
  ck_assert_msg(fabs(p.absorbed + p.escaped - in) <= 1e-12 * in && p.escaped >= -1e-12 * in &&
                    p.absorbed >= 0,
                "%s, ratio %g: emitted %g + received %g, absorbed %g + escaped %g", what, ratio,
                p.emitted, p.received, p.absorbed, p.escaped);
}

static void check_scene(hr2d_scene *scene, const char *what, double ratio) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-6;
  hr2d_solution *solution = NULL;
  hr2d_account account;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
  ck_assert_msg(status == HR2D_OK || (status == HR2D_EACCURACY && solution),
                "%s, ratio %g: %s, %s", what, ratio, hr2d_strerror(status), account.reason);
  check_power(solution, what, ratio);
  hr2d_solution_destroy(solution);
  for (unsigned order = 1; order <= 4; order += 3) {
    test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
    ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, order), HR2D_OK);
    test_refine(&t, 0.5, 8);
    solution = test_solve(&t, 1);
    check_power(solution, what, ratio);
    hr2d_solution_destroy(solution);
    hr2d_linkset_destroy(t.links);
    hr2d_hierarchy_destroy(t.hierarchy);
  }
  hr2d_scene_destroy(scene);
}

/* Plates with no more than a rounding between them are refused. */
static void check_plates(double length, double height, double offset) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_segment floor = {{-0.5 * length, 0}, {0.5 * length, 0}};
  const hr2d_segment plate = {{offset + 1, height}, {offset, height}};
  ck_assert_int_eq(test_add_patch(scene, floor, 1, 0.5, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(test_add_patch(scene, plate, 0, 0.9, HR2D_SIDES_FRONT), HR2D_OK);
  const hr2d_status status = hr2d_scene_commit(scene);
  if (!status) {
    check_scene(scene, "plate", length);
    return;
  }
  ck_assert_int_eq(status, HR2D_ESCENE);
  test_expect_message(scene, "no more than a rounding");
  hr2d_scene_destroy(scene);
}

START_TEST(a_lamp_under_a_long_ceiling) {
  for (double ratio = 1; ratio < 1e100; ratio *= 1e15) {
    const double half = 0.5 * ratio;
    const double patch[][6] = {{0, 0, 1, 0, 1, 0.5}, {half, 1, -half, 1, 0, 0.9}};
    check_scene(test_scene(patch, 2), "lamp", ratio);
  }
}
END_TEST

/* Both long patches have most of the light, and send it to and fro. */
START_TEST(a_lamp_between_long_plates) {
  for (double ratio = 1e5; ratio < 1e100; ratio *= 1e35) {
    const double half = 0.5 * ratio;
    const double patch[][6] = {{0, 0, 1, 0, 1, 0.5},
                               {1, -1, 0, -1, 0, 0.5},
                               {2 * half, half, -half, half, 0, 0.9},
                               {-half, -half, 2 * half, -half, 0, 0.9}};
    check_scene(test_scene(patch, 4), "plates", ratio);
  }
}
END_TEST

/* A plate of 1e-9 over a floor of 1e9 is the case of 1e18. */
START_TEST(a_plate_above_a_long_floor) {
  for (double length = 1; length < 1e22; length *= 1e6)
    for (double height = fmax(1e-2, 1e-14 * length); height <= length; height *= 1e5) {
      check_plates(length, height, 0);
      if (length < 1e15) check_plates(length, height, 0.25 * length);
    }
}
END_TEST

/* Negative control: the norm ∫B² alone leaves half of the light where it is. */
START_TEST(power_is_lost_without_its_norm) {
  const double patch[][6] = {{0, 0, 1, 0, 1, 0.5}, {5e39, 1, -5e39, 1, 0, 0.5}};
  test_links t = test_make_links(test_scene(patch, 2), NULL, NULL, NULL, NULL);
  test_refine(&t, 0.5, HR2D_DEFAULT_MAX_LEVEL);
  const hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2di_equation eq;
  ck_assert_int_eq(
      hr2di_equation_init(&eq, t.links, t.scene, &(hr2di_equation_how){0}, &options), HR2D_OK);
  ck_assert_int_eq(hr2di_equation_solve(&eq), HR2D_OK);
  hr2di_transport_pull(&eq.transport, eq.radiosity);
  ck_assert_double_eq(eq.transport.up[1], 0);
  ck_assert_int_eq(hr2di_equation_settle_power(&eq), HR2D_OK);
  hr2di_transport_pull(&eq.transport, eq.radiosity);
  ck_assert_double_eq_tol(eq.transport.up[1] * 1e40, 0.5, 1e-13);
  hr2di_equation_clear(&eq);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("lengths") {
  ADD_TESTS("power", a_lamp_under_a_long_ceiling, a_lamp_between_long_plates,
            a_plate_above_a_long_floor, power_is_lost_without_its_norm);
}
