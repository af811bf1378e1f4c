/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes under a sun, or under a sky in pieces. */
#include <math.h>

#include "adversary/kinds.h"

#define PI 3.14159265358979323846

/* Directions that are easy to say, along walls, and from one vertex to another: there shadows
   end where patches do. */
static void add_sun(adv_scene *scene, adv_random *r) {
  const int end = adv_int(r, 0, 1), other = adv_int(r, 0, 1);
  for (size_t band = 0; band < scene->bands; band++) {
    adv_sun *s = &scene->sun[band];
    *s = (adv_sun){adv_int(r, -12, 12), -adv_int(r, 1, 12), adv_int(r, 1, 64) / 64.0};
    if (!adv_chance(r, 0.4)) continue;
    const adv_patch *p = &scene->patch[adv_int(r, 0, (int)scene->count - 1)];
    const adv_patch *q = &scene->patch[adv_int(r, 0, (int)scene->count - 1)];
    const int64_t x = q->x[other] - p->x[end], y = q->y[other] - p->y[end];
    if (x || y) s->x = y > 0 ? -x : x, s->y = y > 0 ? -y : y;
  }
}

/* Up to four pieces that do not overlap, some with a common edge, in eighths of a degree. */
static void add_sky(adv_scene *scene, adv_random *r) {
  double from = adv_int(r, -8 * 120, 0) / 8.0, end = from + 360;
  for (int n = adv_int(r, 1, 4); n > 0 && from < end - 1; n--) {
    adv_piece *p = &scene->piece[scene->pieces++];
    const double max = fmin(adv_chance(r, 0.3) ? 4 : 120, end - from);
    p->from = from;
    p->to = from + adv_int(r, 1, (int)(8 * max)) / 8.0;
    for (size_t band = 0; band < scene->bands; band++)
      p->value[band] = adv_int(r, 0, 64) / 64.0;
    from = p->to + (adv_chance(r, 0.5) ? 0 : adv_int(r, 1, 8 * 20) / 8.0);
  }
}

/* No lamps: all light comes from outside. */
static void darken(adv_scene *scene) {
  for (size_t band = 0; band < scene->bands; band++)
    for (size_t k = 0; k < scene->count; k++) scene->patch[k].emission[band] = 0;
}

static void rows(adv_scene *scene, adv_random *r) {
  int n = adv_int(r, 1, 4);
  double tilt = adv_real(r, 0.1, 1.2),
         clearance = adv_chance(r, 0.2) ? 0 : adv_real(r, 0.02, 1);
  adv_wall(scene, -3, 0, 2 * n + 1, 0);
  for (int k = 0; k < n; k++)
    adv_screen(scene, 2 * k - 1, clearance, 2 * k - 1 + cos(tilt), clearance + sin(tilt));
  adv_paint(scene, r, 0.6);
  darken(scene);
}

static void rows_under_a_sun(adv_scene *scene, adv_random *r) {
  rows(scene, r);
  add_sun(scene, r);
}

static void rows_under_a_sky(adv_scene *scene, adv_random *r) {
  rows(scene, r);
  add_sky(scene, r);
  if (adv_chance(r, 0.5)) scene->background[0] = adv_int(r, 1, 16) / 16.0;
}

static void soup(adv_scene *scene, adv_random *r) {
  adv_screens(scene, r, adv_int(r, 2, 6), (const double[4]){0, 0, 4, 4}, 0.1, 3);
  adv_paint(scene, r, 0.9);
}

static void soup_under_a_sun(adv_scene *scene, adv_random *r) {
  soup(scene, r);
  add_sun(scene, r);
}

static void soup_under_a_sky(adv_scene *scene, adv_random *r) {
  soup(scene, r);
  add_sky(scene, r);
}

/* The sun falls through a window, narrow at times, on walls that send it on many times. */
static void sunny_room(adv_scene *scene, adv_random *r) {
  double sill = adv_real(r, 0.2, 1), head = sill + ldexp(adv_real(r, 1, 2), -adv_int(r, 0, 6));
  const double corner[6][2] = {{4, head}, {4, 3}, {0, 3}, {0, 0}, {4, 0}, {4, sill}};
  for (int k = 0; k < 5; k++)
    adv_wall(scene, corner[k][0], corner[k][1], corner[k + 1][0], corner[k + 1][1]);
  if (adv_chance(r, 0.5)) adv_screen(scene, 2, 0, 2, adv_real(r, 0.1, 2));
  adv_paint(scene, r, 0.95);
  darken(scene);
  add_sun(scene, r);
  scene->sun[0] = (adv_sun){-adv_int(r, 1, 12), -adv_int(r, 0, 12), 1};
  if (adv_chance(r, 0.3)) add_sky(scene, r);
}

/* A court or a street at noon, of two bands, with all that there is. */
static void court(adv_scene *scene, adv_random *r) {
  double wide = adv_real(r, 0.5, 3), left = adv_real(r, 0.3, 4), right = adv_real(r, 0.3, 4);
  scene->bands = 2;
  adv_wall(scene, 0, 0, wide, 0);
  adv_wall(scene, wide, 0, wide, right);
  adv_wall(scene, 0, left, 0, 0);
  if (adv_chance(r, 0.5)) adv_wall(scene, wide, right, wide + 2, right);
  if (adv_chance(r, 0.5)) adv_wall(scene, -2, left, 0, left);
  if (adv_chance(r, 0.3)) adv_screen(scene, wide / 4, 0.25, wide / 2, 0.25);
  adv_paint(scene, r, 0.8);
  add_sun(scene, r);
  add_sky(scene, r);
  scene->background[1] = adv_int(r, 0, 4) / 4.0;
}

/* Light along a plate, or nearly: on a roof of a ridge, teeth throw long shadows. */
static void low_sun(adv_scene *scene, adv_random *r) {
  double x = 0, slope = adv_chance(r, 0.5) ? 0 : ldexp(1, -adv_int(r, 3, 12));
  for (int n = adv_int(r, 1, 5); n > 0; n--) {
    double wide = adv_real(r, 0.2, 1), high = adv_real(r, 0.02, 0.4);
    adv_wall(scene, x, slope * x, x + wide, slope * (x + wide));
    x += wide;
    if (adv_chance(r, 0.7)) adv_screen(scene, x, slope * x, x, slope * x + high);
  }
  adv_paint(scene, r, 0.8);
  darken(scene);
  scene->sun[0] = (adv_sun){adv_chance(r, 0.5) ? 4096 : -4096, -adv_int(r, 0, 400), 1};
}

/* A closed room, of which sun and sky see the backs. */
static void shut_room(adv_scene *scene, adv_random *r) {
  double w, h;
  adv_room(scene, r, &w, &h);
  adv_screens(scene, r, adv_int(r, 0, 3), (const double[4]){0, 0, w, h}, 0.2, 2);
  adv_paint(scene, r, 0.9);
  add_sun(scene, r);
  add_sky(scene, r);
}

const adv_kind adv_day[] = {
    {"rows-sun", rows_under_a_sun, "rows of panels under a sun"},
    {"rows-sky", rows_under_a_sky, "rows of panels under pieces of sky"},
    {"soup-sun", soup_under_a_sun, "free screens under a sun"},
    {"soup-pieces", soup_under_a_sky, "free screens under pieces of sky"},
    {"sunny", sunny_room, "a room into which the sun falls"},
    {"court", court, "a street under a sun and pieces of sky, two bands"},
    {"low-sun", low_sun, "a ground with screens under a sun that is low"},
    {"shut", shut_room, "a closed room, with sun and sky outside"},
    {NULL, NULL, NULL}};
