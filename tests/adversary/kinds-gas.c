/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kinds of scenes full of gas.  Rooms are about 4 by 3. */
#include <math.h>

#include "adversary/kinds.h"

/* A convex room in some bands. */
static void room(adv_scene *scene, adv_random *r, double low, double high) {
  scene->bands = (size_t)adv_int(r, 1, 3);
  adv_convex(scene, r, adv_int(r, 3, 6), 2, 0);
  adv_paint(scene, r, 0.9);
  adv_fill_gas(scene, r, low, high, 0);
}

static void thin(adv_scene *scene, adv_random *r) {
  room(scene, r, 1e-10, 1e-2);
}

static void thick(adv_scene *scene, adv_random *r) {
  room(scene, r, 3, 300);
}

/* A wedge, of which walls meet at a small angle. */
static void corner(adv_scene *scene, adv_random *r) {
  const double height = 4 * adv_real(r, 0.02, 0.5), x = adv_real(r, 0, 4);
  const double at[3][2] = {{0, 0}, {4, 0}, {x, height}};
  adv_ring(scene, at, 3);
  scene->closed = 1;
  adv_paint(scene, r, 0.9);
  adv_fill_gas(scene, r, 0.03, 30, 0);
}

static void slit(adv_scene *scene, adv_random *r) {
  adv_box(scene, 0, 0, 4, 4 * adv_real(r, 0.003, 0.05));
  scene->closed = 1;
  adv_paint(scene, r, 0.9);
  adv_fill_gas(scene, r, 0.03, 100, 0);
}

/* Screens in a room, some of them panes. */
static void obstacles(adv_scene *scene, adv_random *r) {
  double w, h;
  scene->bands = (size_t)adv_int(r, 1, 2);
  adv_room(scene, r, &w, &h);
  adv_screens(scene, r, adv_int(r, 1, 3), (const double[4]){0, 0, w, h}, 0.25, 1.5);
  adv_paint(scene, r, 0.8);
  for (size_t k = 4; k + 1 < scene->count; k += 2)
    if (adv_chance(r, 0.3)) adv_pane(scene, r, k, 0.8);
  adv_fill_gas(scene, r, 0.01, 10, 0);
}

/* Gas of given heat, mostly none, in a room with a screen perhaps. */
static void heated(adv_scene *scene, adv_random *r) {
  double w, h;
  adv_room(scene, r, &w, &h);
  adv_screens(scene, r, adv_int(r, 0, 1), (const double[4]){0, 0, w, h}, 0.25, 1.5);
  adv_paint(scene, r, 0.8);
  adv_fill_gas(scene, r, 0.01, 10, 1);
  if (adv_chance(r, 0.6)) scene->hot[0] = 0;
}

/* A round room of so many patches that clusters exchange for them. */
static void many(adv_scene *scene, adv_random *r) {
  enum { MOST = 290 };
  double corner[MOST][2];
  const int corners = adv_int(r, 258, MOST);
  const double squeeze = adv_real(r, 0.3, 1);
  for (int k = 0; k < corners; k++) {
    const double angle = 2 * 3.14159265358979323846 * (k + adv_real(r, 0, 0.5)) / corners;
    corner[k][0] = 2 * cos(angle);
    corner[k][1] = 2 * squeeze * sin(angle);
  }
  adv_ring(scene, (const double(*)[2])corner, (size_t)corners);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
  adv_fill_gas(scene, r, 0.01, 10, 0);
}

/* A part with a border of its own, which may reach into walls, in a room with a screen perhaps.
 */
static void parted(adv_scene *scene, adv_random *r) {
  double w, h;
  scene->bands = (size_t)adv_int(r, 1, 2);
  adv_room(scene, r, &w, &h);
  adv_screens(scene, r, adv_int(r, 0, 1), (const double[4]){0, 0, w, h}, 0.25, 1.5);
  adv_paint(scene, r, 0.8);
  adv_fill_gas(scene, r, 0.01, 10, 0);
  adv_part_gas(scene, r, (const double[4]){-0.2 * w, -0.2 * h, 1.2 * w, 1.2 * h});
}

/* Two-sided screens in the open. */
static void open_gas(adv_scene *scene, adv_random *r) {
  scene->bands = (size_t)adv_int(r, 1, 2);
  adv_screens(scene, r, adv_int(r, 2, 4), (const double[4]){0, 0, 4, 3}, 0.5, 2);
  adv_paint(scene, r, 0.8);
  adv_fill_gas(scene, r, 0.01, 10, 0);
}

const adv_kind adv_gases[] = {
    {"gas-thin", thin, "convex rooms in thin gas, of several absorptions"},
    {"gas-thick", thick, "the same in thick gas"},
    {"gas-corner", corner, "wedges in gas"},
    {"gas-slit", slit, "slits in gas"},
    {"gas-obstacles", obstacles, "screens and panes in a room with gas"},
    {"gas-heated", heated, "gas of given heat, which finds its temperature"},
    {"gas-many", many, "round rooms of more than 256 patches, with clusters in gas"},
    {"gas-parted", parted, "two gases with a border between them"},
    {"gas-open", open_gas, "screens in gas without walls around it"},
    {NULL, NULL, NULL}};
