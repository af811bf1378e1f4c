/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed rooms of ordinary proportions. */
#include <math.h>

#include "adversary/kinds.h"

#define PI 3.14159265358979323846

static void convex(adv_scene *scene, adv_random *r) {
  adv_convex(scene, r, adv_int(r, 3, 8), 2, 0);
  adv_paint(scene, r, 0.95);
}

static void round_room(adv_scene *scene, adv_random *r) {
  adv_convex(scene, r, adv_int(r, 12, 32), 2, 0);
  adv_paint(scene, r, 0.8);
}

static void star(adv_scene *scene, adv_random *r) {
  double corner[16][2];
  int n = 2 * adv_int(r, 3, 6);
  for (int k = 0; k < n; k++) {
    double radius = k % 2 ? adv_real(r, 0.5, 1) : adv_real(r, 1.2, 2.5);
    corner[k][0] = radius * cos(2 * PI * k / n);
    corner[k][1] = radius * sin(2 * PI * k / n);
  }
  adv_ring(scene, (const double(*)[2])corner, (size_t)n);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* A plan of right angles on lines 0, 1, 2, … that are put to random places. */
static void plan(adv_scene *scene, adv_random *r, const int (*corner)[2], size_t count) {
  double place[2][16] = {{0}}, moved[32][2];
  for (int axis = 0; axis < 2; axis++)
    for (int k = 1; k < 16; k++) place[axis][k] = place[axis][k - 1] + adv_int(r, 2, 12) / 8.0;
  for (size_t k = 0; k < count; k++)
    for (int axis = 0; axis < 2; axis++) moved[k][axis] = place[axis][corner[k][axis]];
  adv_ring(scene, (const double(*)[2])moved, count);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

static void comb(adv_scene *scene, adv_random *r) {
  int teeth = adv_int(r, 1, 4), corner[32][2] = {{0, 0}, {2 * teeth + 1, 0}};
  size_t n = 2;
  corner[n][0] = 2 * teeth + 1, corner[n++][1] = 1;
  for (int k = teeth; k > 0; k--) {
    const int tooth[4][2] = {{2 * k, 1}, {2 * k, 2}, {2 * k - 1, 2}, {2 * k - 1, 1}};
    for (int c = 0; c < 4; c++, n++) corner[n][0] = tooth[c][0], corner[n][1] = tooth[c][1];
  }
  corner[n][0] = 0, corner[n++][1] = 1;
  plan(scene, r, (const int(*)[2])corner, n);
}

static void spiral(adv_scene *scene, adv_random *r) {
  static const int bend[][2] = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {0, 1}};
  static const int hook[][2] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 2}, {2, 2}, {2, 1}, {0, 1}};
  static const int whole[][2] = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 2}, {4, 2}, {4, 4},
                                 {3, 4}, {3, 3}, {1, 3}, {1, 5}, {5, 5}, {5, 1}, {0, 1}};
  switch (adv_int(r, 0, 3)) {
  case 0:
    plan(scene, r, bend, sizeof bend / sizeof *bend);
    break;
  case 1:
    plan(scene, r, whole, sizeof whole / sizeof *whole);
    break;
  default:
    plan(scene, r, hook, sizeof hook / sizeof *hook);
  }
}

static void screens(adv_scene *scene, adv_random *r) {
  double w, h;
  adv_room(scene, r, &w, &h);
  adv_screens(scene, r, adv_int(r, 1, 3), (const double[4]){0, 0, w, h}, 0.25, 2);
  adv_paint(scene, r, 0.8);
}

/* Partitions that stand on the floor or hang from the ceiling. */
static void junctions(adv_scene *scene, adv_random *r) {
  double w, h;
  adv_room(scene, r, &w, &h);
  int n = adv_int(r, 1, 2);
  for (int k = 1; k <= n; k++) {
    double x = w * (k + adv_real(r, -0.3, 0.3)) / (n + 1), y = h * adv_real(r, 0.1, 0.9);
    if (adv_chance(r, 0.5))
      adv_screen(scene, x, 0, x, y);
    else
      adv_screen(scene, x, y, x, h);
  }
  adv_paint(scene, r, 0.8);
}

/* Screens that touch each other: a T, a zigzag, a cross. */
static void touching(adv_scene *scene, adv_random *r) {
  adv_box(scene, 0, 0, 4, 4);
  scene->closed = 1;
  double x = adv_real(r, 1.5, 2.5), y = adv_real(r, 1.5, 2.5);
  switch (adv_int(r, 0, 2)) {
  case 0:
    adv_screen(scene, 1, y, 3, y);
    adv_screen(scene, x, y, x + adv_real(r, -1, 1), adv_real(r, 3, 3.9));
    break;
  case 1:
    adv_screen(scene, 0.5, adv_real(r, 0.5, 3.5), x, y);
    adv_screen(scene, x, y, 3.5, adv_real(r, 0.5, 3.5));
    break;
  default:
    adv_screen(scene, x, y, x + 1, y);
    adv_screen(scene, x, y, x, y + 1);
    adv_screen(scene, x, y, x - 1, y - adv_real(r, 0, 1));
    if (adv_chance(r, 0.5)) adv_screen(scene, x, y, x, y - 1);
  }
  adv_paint(scene, r, 0.8);
}

/* Absorbers and their shadows: a lamp in the ceiling, a black table, black walls. */
static void absorbers(adv_scene *scene, adv_random *r) {
  double w = adv_int(r, 12, 20) / 4.0, lamp = adv_real(r, 0.5, w - 1);
  const double corner[6][2] = {{0, 0}, {w, 0}, {w, 3}, {lamp + 0.5, 3}, {lamp, 3}, {0, 3}};
  adv_ring(scene, corner, 6);
  double x = adv_real(r, 0.2, w - 1.2);
  adv_screen(scene, x, 1, x + 1, 1);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
  for (size_t k = 0; k < scene->count; k++) {
    scene->patch[k].emission[0] = k == 3;
    if (k > 5 || adv_chance(r, 0.5)) adv_reflect(&scene->patch[k], 0);
  }
}

static void black(adv_scene *scene, adv_random *r) {
  double w, h;
  adv_room(scene, r, &w, &h);
  adv_screens(scene, r, adv_int(r, 0, 3), (const double[4]){0, 0, w, h}, 0.25, 1.5);
  adv_paint(scene, r, 0);
}

/* A lit room, and a dark one behind a partition that stands on two walls. */
static void dark_next_door(adv_scene *scene, adv_random *r) {
  double w, h;
  adv_room(scene, r, &w, &h);
  double x = w * adv_real(r, 0.2, 0.8), y = adv_chance(r, 0.5) ? x : w * adv_real(r, 0.2, 0.8);
  adv_screen(scene, x, 0, y, h);
  adv_paint(scene, r, 0.8);
  for (size_t k = 0; k < scene->count; k++)
    scene->patch[k].emission[0] = k == (size_t)(w > 3 ? 3 : 1);
}

static void bands(adv_scene *scene, adv_random *r) {
  scene->bands = (size_t)adv_int(r, 2, 3);
  adv_convex(scene, r, adv_int(r, 4, 7), 2, 0); /* all around a box of 0.6 */
  const double box[4] = {-0.3, -0.3, 0.3, 0.3};
  if (adv_chance(r, 0.5)) adv_screens(scene, r, 1, box, 0.2, 0.5);
  adv_paint(scene, r, 0.9);
  for (size_t k = 0; k < scene->count; k++) scene->patch[k].emission[0] = 0;
}

static void squares(adv_scene *scene, adv_random *r) {
  adv_box(scene, 0, 0, 6, 4);
  int n = adv_int(r, 1, 3);
  for (int k = 0; k < n; k++) {
    double x = 2 * k + adv_real(r, 0.1, 0.9), y = adv_real(r, 0.1, 2.9);
    double size = adv_real(r, 0.1, 1);
    adv_box(scene, x + size, y, x, y + size);
  }
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* More of them than a short solve can do with. */
static void crowd(adv_scene *scene, adv_random *r) {
  adv_box(scene, 0, 0, 6, 4);
  for (int k = adv_int(r, 4, 6) - 1; k >= 0; k--) {
    double x = 2 * (k % 3) + adv_real(r, 0.2, 1), y = 2 * (k / 3) + adv_real(r, 0.2, 1);
    double size = adv_real(r, 0.1, 0.8);
    adv_box(scene, x + size, y, x, y + size);
  }
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* A column in a round room. */
static void ring(adv_scene *scene, adv_random *r) {
  adv_convex(scene, r, adv_int(r, 4, 8), 3, 0);
  adv_convex(scene, r, adv_int(r, 3, 6), 0.9, 1);
  adv_paint(scene, r, 0.8);
}

/* Rooms in a row, with doors. */
static void enfilade(adv_scene *scene, adv_random *r) {
  int n = adv_int(r, 2, 4);
  adv_box(scene, 0, 0, 3 * n, 3);
  for (int k = 1; k < n; k++) {
    double y = adv_real(r, 0.2, 1.8);
    adv_screen(scene, 3 * k, 0, 3 * k, y);
    adv_screen(scene, 3 * k, y + adv_real(r, 0.1, 1), 3 * k, 3);
  }
  scene->closed = 1;
  adv_paint(scene, r, 0.7);
}

/* Walls of many pieces on one line. */
static void pieces(adv_scene *scene, adv_random *r) {
  const double corner[5][2] = {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 0}};
  for (int side = 0; side < 4; side++) {
    const double *a = corner[side], *b = corner[side + 1];
    double t = 0;
    for (int n = adv_int(r, 1, 6); n > 0; n--) {
      double u = n == 1 ? 1 : t + (1 - t) * adv_real(r, 0.02, 0.9);
      adv_wall(scene, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
               a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]));
      t = u;
    }
  }
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* One or two partitions through which light passes, and screens, some of them panes. */
static void panes(adv_scene *scene, adv_random *r) {
  double w, h;
  scene->bands = adv_chance(r, 0.3) ? 2 : 1;
  adv_room(scene, r, &w, &h);
  int n = adv_int(r, 1, 2);
  for (int k = 1; k <= n; k++) {
    double x = w * (k + adv_real(r, -0.2, 0.2)) / (n + 1);
    double y = adv_chance(r, 0.5) ? x : x + adv_real(r, -0.2, 0.2);
    adv_screen(scene, x, 0, y, adv_chance(r, 0.8) ? h : h / 2);
  }
  const size_t screens = scene->count;
  adv_screens(scene, r, adv_int(r, 0, 2), (const double[4]){0, 0, w, h}, 0.25, 1.5);
  adv_paint(scene, r, 0.9);
  for (size_t k = 4; k + 1 < scene->count; k += 2)
    if (k < screens || adv_chance(r, 0.5)) adv_pane(scene, r, k, adv_chance(r, 0.2) ? 1 : 0.95);
}

/* The same light with panes that absorb nothing, or let all of it through. */
static void frosted(adv_scene *scene, adv_random *r) {
  double w, h;
  adv_room(scene, r, &w, &h);
  double x = w * adv_real(r, 0.2, 0.8);
  adv_screen(scene, x, 0, x, h);
  adv_paint(scene, r, 0.9);
  double tau = adv_chance(r, 0.3) ? 1 : adv_int(r, 1, 63) / 64.0;
  for (size_t k = 4; k < 6; k++) {
    scene->patch[k].transmittance[0] = tau;
    scene->patch[k].reflectance[0] = 1 - tau;
    scene->patch[k].emission[0] = 0;
  }
  scene->patch[0].emission[0] = 1;
}

const adv_kind adv_rooms[] = {
    {"convex", convex, "convex rooms of 3 to 8 walls"},
    {"round", round_room, "rooms of 12 to 32 walls"},
    {"star", star, "stars"},
    {"comb", comb, "combs"},
    {"spiral", spiral, "bends, hooks and spirals"},
    {"screens", screens, "free screens in a room"},
    {"junctions", junctions, "partitions that stand on a wall (T-junctions)"},
    {"touching", touching, "screens that touch each other"},
    {"absorbers", absorbers, "a lamp, a black table, black walls, shadows"},
    {"black", black, "nothing reflects"},
    {"dark-next-door", dark_next_door, "a dark room behind a partition"},
    {"bands", bands, "two or three bands, the first one dark"},
    {"squares", squares, "one to three squares in a room"},
    {"crowd", crowd, "four to six squares in a room"},
    {"ring", ring, "a column in a round room"},
    {"enfilade", enfilade, "rooms in a row, with doors"},
    {"pieces", pieces, "walls of many pieces on one line"},
    {"panes", panes, "partitions and screens through which light passes"},
    {"frosted", frosted, "a partition that absorbs nothing"},
    {NULL, NULL, NULL}};
