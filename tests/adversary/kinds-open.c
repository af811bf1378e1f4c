/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Open scenes: light leaves, or comes in from the background. */
#include <math.h>

#include "adversary/kinds.h"

#define PI 3.14159265358979323846

/* Two patches that touch. */
static void wedge(adv_scene *scene, adv_random *r) {
  double angle = adv_real(r, 0.05, 0.97) * PI, length = ldexp(1, -adv_int(r, 0, 8));
  adv_wall(scene, 0, 0, 2, 0);
  adv_wall(scene, 2 * length * cos(angle), 2 * length * sin(angle), 0, 0);
  adv_paint(scene, r, 0.95);
}

/* Plates face each other over a thin gap. */
static void gap(adv_scene *scene, adv_random *r) {
  double wide = ldexp(adv_real(r, 1, 2), -adv_int(r, 2, 12)), shift = adv_real(r, 0, 1.5);
  adv_wall(scene, 0, 0, 2, 0);
  adv_wall(scene, 2 + shift, wide, shift, wide);
  if (adv_chance(r, 0.5)) adv_wall(scene, 0, wide, 0, 0);
  adv_paint(scene, r, 0.95);
}

/* Pieces on two lines that face each other. */
static void coplanar(adv_scene *scene, adv_random *r) {
  double x = 0;
  for (int n = adv_int(r, 1, 4); n > 0; n--) {
    double length = adv_real(r, 0.1, 1);
    adv_wall(scene, x, 0, x + length, 0);
    x += length + (adv_chance(r, 0.5) ? 0 : adv_real(r, 0.01, 0.5));
  }
  for (int n = adv_int(r, 1, 3); n > 0; n--) {
    double length = adv_real(r, 0.1, 1);
    adv_wall(scene, x, 1, x - length, 1);
    x -= length + (adv_chance(r, 0.5) ? 0 : adv_real(r, 0.01, 0.5));
  }
  adv_paint(scene, r, 0.9);
}

/* A street between houses under the sky. */
static void canyon(adv_scene *scene, adv_random *r) {
  double wide = adv_real(r, 0.5, 3), left = adv_real(r, 0.5, 4), right = adv_real(r, 0.5, 4);
  adv_wall(scene, 0, 0, wide, 0);
  adv_wall(scene, wide, 0, wide, right);
  adv_wall(scene, 0, left, 0, 0);
  if (adv_chance(r, 0.5)) {
    adv_wall(scene, wide, right, wide + 2, right);
    adv_wall(scene, -2, left, 0, left);
  }
  if (adv_chance(r, 0.3)) adv_screen(scene, wide / 4, 0.25, wide / 2, 0.25);
  adv_paint(scene, r, 0.7);
  scene->background[0] = 1;
}

/* Tilted panels over the ground, under the sky. */
static void panels(adv_scene *scene, adv_random *r) {
  int n = adv_int(r, 1, 4);
  double tilt = adv_real(r, 0.2, 1), clearance = adv_real(r, 0.02, 0.5);
  adv_wall(scene, -2, 0, 2 * n, 0);
  for (int k = 0; k < n; k++)
    adv_screen(scene, 2 * k - 1, clearance, 2 * k - 1 + cos(tilt), clearance + sin(tilt));
  adv_paint(scene, r, 0.5);
  for (size_t k = 0; k < scene->count; k++) {
    scene->patch[k].emission[0] = 0;
    if (k && adv_chance(r, 0.7)) adv_reflect(&scene->patch[k], 0);
  }
  scene->background[0] = 1;
}

static void soup(adv_scene *scene, adv_random *r) {
  adv_screens(scene, r, adv_int(r, 2, 6), (const double[4]){0, 0, 4, 4}, 0.1, 3);
  adv_paint(scene, r, 0.9);
}

static void soup_under_sky(adv_scene *scene, adv_random *r) {
  soup(scene, r);
  scene->background[0] = adv_int(r, 1, 64) / 64.0;
}

/* Obstacles without a room. */
static void squares_outside(adv_scene *scene, adv_random *r) {
  for (int k = adv_int(r, 2, 4); k > 0; k--) {
    double x = 2 * k + adv_real(r, 0, 0.9), y = adv_real(r, 0, 1), size = adv_real(r, 0.2, 1);
    adv_box(scene, x + size, y, x, y + size);
  }
  adv_paint(scene, r, 0.8);
  if (adv_chance(r, 0.5)) scene->background[0] = 1;
}

/* A patch of 2^-10 and one of 4, far from each other. */
static void far_apart(adv_scene *scene, adv_random *r) {
  double small = ldexp(1, -adv_int(r, 0, 10)), away = ldexp(1, adv_int(r, 0, 6));
  adv_wall(scene, 0, 0, 4, 0);
  adv_wall(scene, away + small, 1, away, 1 + small * adv_real(r, 0, 1));
  if (adv_chance(r, 0.5)) adv_screen(scene, away / 2, 0.25, away / 2, 0.75);
  adv_paint(scene, r, 0.9);
}

/* A room with a window, under a sky of two bands, of which one is dark. */
static void window(adv_scene *scene, adv_random *r) {
  double sill = adv_real(r, 0.2, 1), head = sill + ldexp(adv_real(r, 1, 2), -adv_int(r, 0, 8));
  const double corner[6][2] = {{4, head}, {4, 3}, {0, 3}, {0, 0}, {4, 0}, {4, sill}};
  for (int k = 0; k < 5; k++)
    adv_wall(scene, corner[k][0], corner[k][1], corner[k + 1][0], corner[k + 1][1]);
  scene->bands = 2;
  adv_paint(scene, r, 0.8);
  for (size_t k = 0; k < scene->count; k++)
    scene->patch[k].emission[0] = scene->patch[k].emission[1] = 0;
  scene->background[0] = 1;
}

const adv_kind adv_open[] = {{"wedge", wedge, "two patches that touch"},
                             {"gap", gap, "plates over a thin gap"},
                             {"coplanar", coplanar, "pieces on two lines"},
                             {"canyon", canyon, "a street under the sky"},
                             {"panels", panels, "tilted panels over the ground"},
                             {"soup", soup, "free screens, no room"},
                             {"soup-sky", soup_under_sky, "free screens under the sky"},
                             {"outside", squares_outside, "squares without a room"},
                             {"far", far_apart, "patches of 2^-10 and 4, far apart"},
                             {"window", window, "a room with a window, a band without light"},
                             {NULL, NULL, NULL}};
