/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What comes in from the background: nothing where a room is closed, and never less than
   nothing. */
#include <math.h>

#include "support/support.h"

static void set_background(hr2d_scene *scene, double light) {
  ck_assert_int_eq(hr2d_scene_set_background(scene, &light, 1), HR2D_OK);
}

/* A room of random walls, with a screen; one wall is missing if it is open. */
static hr2d_scene *draw_room(randoms *r, int open) {
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_point at[8];
  const int count = 3 + random_below(r, 5);
  for (int k = 0; k < count; k++) {
    const double angle = 6.28 * (k + random_between(r, 0, 0.9)) / count;
    at[k] = (hr2d_point){cos(angle), sin(angle)};
  }
  for (int k = open; k < count; k++)
    test_add_patch(scene, (hr2d_segment){at[k], at[(k + 1) % count]}, random_between(r, 0, 1),
                   random_between(r, 0, 0.9), HR2D_SIDES_FRONT);
  const double x = 0.25 * (at[0].x + at[1].x + at[2].x),
               y = 0.25 * (at[0].y + at[1].y + at[2].y);
  const hr2d_segment screen = {{x, y}, {x + 0.01, y + 0.02}};
  if (random_below(r, 2)) test_add_patch(scene, screen, 0, 0.5, HR2D_SIDES_BOTH);
  set_background(scene, 1);
  return scene;
}

static double min_of(const test_links *t, int closure) {
  hr2d_solution *solution = test_solve(t, closure);
  const hr2d_power p = hr2d_solution_power(solution, 0);
  ck_assert_double_eq_tol(p.absorbed + p.escaped, p.emitted + p.received, 1e-12);
  hr2d_solution_destroy(solution);
  return p.received;
}

static void check_room(randoms *r, int open) {
  hr2d_scene *scene = draw_room(r, open);
  if (hr2d_scene_commit(scene)) { /* the screen crosses a wall */
    hr2d_scene_destroy(scene);
    return;
  }
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  test_refine(&t, random_power(r, -1, 0), 6);
  for (unsigned order = 1; order <= 5; order++) {
    ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, order), HR2D_OK);
    for (int closure = 0; closure < 2; closure++) {
      const double received = min_of(&t, closure);
      ck_assert_msg(open ? received > 1e-3 : received == 0, "order %u, closure %d: %g", order,
                    closure, received);
    }
  }
  test_free_links(&t);
}

START_TEST(nothing_comes_into_closed_rooms) {
  randoms r = randoms_stream(test_seed(), 2);
  for (int k = test_count(200) + 10; k > 0; k--) check_room(&r, 0);
}
END_TEST

/* Negative control: without one wall it is bright. */
START_TEST(light_comes_into_open_rooms) {
  randoms r = randoms_stream(test_seed(), 3);
  for (int k = test_count(50) + 5; k > 0; k--) check_room(&r, 1);
}
END_TEST

/* All that comes in through a slit of a wall goes past the wall: where nothing else reflects, B
   is a rounding, of either sign, and no reason to refuse the scene. */
START_TEST(a_wall_beside_its_window_is_dark) {
  static const double from[] = {0.6457061767578125, 0.6267852783203125};
  const hr2d_segment wall[] = {{{4, from[0]}, {4, 3}},
                               {{4, 3}, {0, 3}},
                               {{0, 3}, {0, 0}},
                               {{0, 0}, {4, 0}},
                               {{4, 0}, {4, from[1]}}};
  for (int reflecting = 0; reflecting < 5; reflecting++) {
    hr2d_scene *scene = test_new_scene(NULL);
    for (int k = 0; k < 5; k++)
      test_add_patch(scene, wall[k], 0, k == reflecting ? 0.09375 : 0, HR2D_SIDES_FRONT);
    set_background(scene, 1);
    test_commit(scene);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *solution = NULL;
    target.error = 1e-9;
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, NULL);
    ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    const double b = hr2d_solution_average(solution, (size_t)reflecting, 0);
    if (wall[reflecting].a.x == 4 && wall[reflecting].b.x == 4)
      ck_assert_double_le(fabs(b), 1e-15);
    else
      ck_assert_double_gt(b, 1e-5);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A ground sees the back of a wall.  Links remember who sees backs, and later solves of other
   orders have the same bits as those of links that do not know yet. */
START_TEST(backs_are_remembered) {
  static const hr2d_segment patch[] = {{{0, 0}, {4, 0}}, {{2, 0}, {2, 1}}};
  double h[2][2];
  for (int again = 0; again < 2; again++) {
    hr2d_scene *scene = test_new_scene(NULL);
    for (int k = 0; k < 2; k++) test_add_patch(scene, patch[k], 0, 0.5, HR2D_SIDES_FRONT);
    set_background(scene, 1);
    test_commit(scene);
    test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
    test_refine(&t, 0.3, 4);
    for (unsigned order = again ? 2 : 4; order <= 4; order++) {
      ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, order), HR2D_OK);
      hr2d_solution *solution = test_solve(&t, 1);
      for (size_t k = 0; k < 2; k++) h[again][k] = hr2d_solution_irradiance(solution, k, 0);
      hr2d_solution_destroy(solution);
    }
    test_free_links(&t);
  }
  ck_assert(h[0][0] == h[1][0] && h[0][1] == h[1][1]);
  ck_assert_double_lt(h[0][0], 0.9); /* the back is dark */
  ck_assert_double_gt(h[0][0], 0.5);
}
END_TEST

TEST_SUITE("background") {
  ADD_TESTS("received", nothing_comes_into_closed_rooms, light_comes_into_open_rooms,
            a_wall_beside_its_window_is_dark, backs_are_remembered);
}
