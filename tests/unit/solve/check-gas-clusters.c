/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms full of gas with many patches: walls in many pieces are what they are as one patch
   each, which clusters take no part in. */
#include <math.h>

#include "base/pi.h"
#include "support/support.h"

enum { WALLS = 9, PIECES = 700 };

typedef struct room {
  size_t walls; /* and behind these both sides of a screen, or none */
  hr2d_segment at[WALLS];
  double emission[WALLS], reflectance[WALLS], kappa, gas;
  int screen, open, free;
  hr2d_section section;
} room;

/* Corners of a convex room on a circle, counterclockwise. */
static room draw_room(int n) {
  randoms draws = randoms_stream(test_seed(), n);
  room r = {.walls = 3 + random_below(&draws, 6), .screen = n % 2, .open = n % 3 == 1};
  for (size_t k = 0; k < r.walls; k++) {
    const double step = 2 * HR2DI_PI / (double)r.walls;
    const double from = step * ((double)k + 0.4),
                 to = step * ((double)((k + 1) % r.walls) + 0.4);
    r.at[k] = (hr2d_segment){{cos(from), sin(from)}, {cos(to), sin(to)}};
  }
  r.at[r.walls] = (hr2d_segment){{-0.1, 0.05}, {0.2, 0.15}};
  for (size_t k = 0; k <= r.walls; k++) {
    r.emission[k] = random_below(&draws, 3) ? random_unit(&draws) : 0;
    r.reflectance[k] = 0.9 * random_unit(&draws);
  }
  r.emission[0] = 1;
  r.kappa = random_power(&draws, -6, 1);
  r.free = !r.open && n % 4 == 3;
  r.gas = random_unit(&draws);
  r.section = n % 5 ? HR2D_SECTION_LONG : HR2D_SECTION_FLAT;
  return r;
}

/* Each wall in so many pieces. */
static hr2d_scene *draw(const room *r, size_t pieces) {
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_gas gas = HR2D_GAS_INIT;
  for (size_t k = r->open ? 1 : 0; k < r->walls + (r->screen != 0); k++)
    for (size_t m = 0; m < pieces; m++) {
      const hr2d_point a = r->at[k].a, b = r->at[k].b;
      const double from = (double)m / (double)pieces, to = (double)(m + 1) / (double)pieces;
      const hr2d_segment at = {{a.x + from * (b.x - a.x), a.y + from * (b.y - a.y)},
                               {a.x + to * (b.x - a.x), a.y + to * (b.y - a.y)}};
      ck_assert_int_eq(test_add_patch(scene, at, r->emission[k], r->reflectance[k],
                                      k < r->walls ? HR2D_SIDES_FRONT : HR2D_SIDES_BOTH),
                       HR2D_OK);
    }
  gas.absorption = &r->kappa;
  gas.absorption_bands = 1;
  gas.section = r->section;
  if (r->free) {
    gas.given = HR2D_HEAT_FLUX;
    gas.value = r->gas;
  } else {
    gas.emission = &r->gas;
    gas.emission_bands = 1;
  }
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* How far walls are off, as a part of the bound; a wall is off by no more than a piece may be.
 */
static double worst_wall(const hr2d_solution *whole, const hr2d_solution *parts, size_t walls,
                         size_t pieces, double bound) {
  double worst = 0;
  for (size_t k = 0; k < walls; k++) {
    double sum = 0, max = 0;
    for (size_t m = 0; m < pieces; m++) {
      const double h = hr2d_solution_irradiance(parts, k * pieces + m, 0);
      sum += h / (double)pieces;
      max = fmax(max, h);
    }
    worst = fmax(worst, fabs(sum - hr2d_solution_irradiance(whole, k, 0)) / (bound * max));
  }
  return worst;
}

START_TEST(walls_in_pieces_are_walls) {
  double worst = 0, saved = 1, control = 0;
  for (int n = 0; n < test_count(40); n++) {
    const room r = draw_room(n);
    room other = r;
    other.kappa *= 1.001;
    hr2d_account account;
    hr2d_scene *one = draw(&r, 1);
    /* both sides of a screen are patches: front, then back */
    const size_t walls = r.walls - (r.open != 0), pieces = PIECES / r.walls;
    hr2d_solution *whole = test_solve_to(one, 1e-11, 1, &account);
    hr2d_scene *many = draw(&r, pieces), *wrong = draw(&other, 1);
    hr2d_solution *control_of = test_solve_to(wrong, 1e-11, 1, &account);
    for (double error = 1e-2; error > 1e-8; error *= 1e-2) {
      hr2d_solution *parts = test_solve_to(many, error, 1, &account);
      const double off = worst_wall(whole, parts, walls, pieces, account.irradiance.bound);
      ck_assert_msg(off <= 1, "room %d to %g: %g of the bound", n, error, off);
      worst = fmax(worst, off);
      control =
          fmax(control, worst_wall(control_of, parts, walls, pieces, account.irradiance.bound));
      saved = fmin(saved, (double)account.links / (double)(walls * pieces) /
                              (double)(walls * pieces) * 2);
      hr2d_solution_destroy(parts);
    }
    hr2d_solution_destroy(control_of);
    hr2d_scene_destroy(wrong);
    hr2d_solution_destroy(whole);
    hr2d_scene_destroy(one);
    hr2d_scene_destroy(many);
  }
  printf("walls are off by at most %.1e of the bound, in other gas by %.1e; links are down to "
         "%.2f of all pairs\n",
         worst, control, saved);
  ck_assert_double_gt(control, 1);
  ck_assert_double_lt(saved, 0.25); /* clusters were there */
}
END_TEST

TEST_SUITE("gas clusters") {
  ADD_TESTS("clusters", walls_in_pieces_are_walls);
}
