/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes with mirrors, and scenes that repeat for ever.  Mirrors stand on x = 0 and y = 0
   before copies are turned. */
#include <math.h>

#include "adversary/kinds.h"

static void on_left(adv_scene *scene, double x) {
  adv_mirror(scene, x, 0, x, adv_chance(&(adv_random){scene->count}, 0.5) ? 3 : -2);
}

/* A distance from 1 down to some steps of a fine grid. */
static double tiny(adv_random *r) {
  return ldexp(adv_real(r, 1, 2), -adv_int(r, 1, 32));
}

static void fine(adv_scene *scene) {
  scene->exponent = -36;
}

/* What may stand on a mirror at x = 0, or near it, from y = low to high. */
static void at_mirror(adv_scene *scene, adv_random *r, double low, double high) {
  const double y = adv_real(r, low, high - 0.3), to = adv_real(r, y + 0.1, high);
  switch (adv_int(r, 0, 6)) {
  case 0: /* its end on the mirror */
    adv_screen(scene, 0, y, adv_real(r, 0.1, 1), to);
    break;
  case 1: /* beside it */
    adv_screen(scene, tiny(r), y, adv_real(r, 0.1, 1), to);
    break;
  case 2: /* a slit between it and its image */
    y > low ? adv_screen(scene, tiny(r), y, scene->exponent < -20 ? tiny(r) : 0.25, to)
            : (void)0;
    break;
  case 3: /* on it */
    adv_wall(scene, 0, to, 0, y);
    break;
  case 4: /* nearly along it, from a foot */
    adv_screen(scene, 0, y, tiny(r), to);
    break;
  case 5: { /* a plate along it */
    const double gap = tiny(r);
    adv_screen(scene, gap, y, gap, to);
    break;
  }
  default:
    break;
  }
}

/* A room less its left wall, which is the mirror. */
static void half(adv_scene *scene, adv_random *r) {
  const double w = adv_int(r, 4, 16) / 4.0, h = adv_int(r, 8, 16) / 4.0;
  if (adv_chance(r, 0.5)) fine(scene);
  adv_wall(scene, 0, 0, w, 0);
  if (adv_chance(r, 0.3)) { /* a roof; its image makes it a gable */
    adv_wall(scene, w, 0, w, h / 2);
    adv_wall(scene, w, h / 2, 0, adv_real(r, h / 4, h));
    at_mirror(scene, r, 0, h / 4);
  } else {
    adv_wall(scene, w, 0, w, h);
    adv_wall(scene, w, h, 0, h);
    at_mirror(scene, r, 0, h);
  }
  scene->closed = 1;
  on_left(scene, 0);
  adv_paint(scene, r, 0.95);
}

/* A wedge of a room, whose mirror its floor meets at a small angle. */
static void nearly_along(adv_scene *scene, adv_random *r) {
  const double x = tiny(r);
  fine(scene);
  adv_wall(scene, 0, 0, x, 2);
  adv_wall(scene, x, 2, adv_chance(r, 0.5) ? 0 : x / 2, 2);
  if (scene->patch[1].x[1] > 0) adv_wall(scene, x / 2, 2, 0, 2);
  scene->closed = 1;
  on_left(scene, 0);
  adv_paint(scene, r, 0.9);
}

/* A quarter of a room about the origin, at which it is filled, open or a sliver. */
static void quarter(adv_scene *scene, adv_random *r) {
  const double w = adv_int(r, 4, 16) / 4.0, h = adv_int(r, 4, 16) / 4.0;
  if (adv_chance(r, 0.5)) fine(scene);
  adv_wall(scene, w, 0, w, h);
  adv_wall(scene, w, h, 0, h);
  switch (adv_int(r, 0, 3)) {
  case 0:
    adv_wall(scene, 0, h / 2, w / 2, 0);
    break;
  case 1:
    adv_wall(scene, 0, tiny(r) * h, tiny(r) * w, 0);
    break;
  case 2:
    adv_screen(scene, 0, 0, w / 2, adv_real(r, 0, h / 2));
    break;
  default:
    at_mirror(scene, r, h / 4, h);
    break;
  }
  scene->closed = 1;
  on_left(scene, 0);
  adv_mirror(scene, 1, 0, 2, 0);
  adv_paint(scene, r, 0.9);
}

/* Free screens before a mirror, or before two that are perpendicular. */
static void soup(adv_scene *scene, adv_random *r) {
  if (adv_chance(r, 0.5)) fine(scene);
  at_mirror(scene, r, 0.5, 4);
  adv_screens(scene, r, adv_int(r, 2, 4), (const double[4]){0, 0, 4, 4}, 0.1, 3);
  on_left(scene, 0);
  if (adv_chance(r, 0.5)) adv_mirror(scene, 3, 0, 7, 0);
  adv_paint(scene, r, 0.9);
  if (adv_chance(r, 0.5)) scene->background[0] = adv_int(r, 1, 16) / 16.0;
}

/* Between two mirrors, whose distance may be small or large beside what stands there. */
static void hall(adv_scene *scene, adv_random *r) {
  const double w = ldexp(adv_real(r, 1, 2), adv_int(r, -3, 6)), h = adv_real(r, 0.5, 3);
  const double edge = rint(ldexp(w, 16)) * 0x1p-16;
  const int low = adv_chance(r, 0.8);
  if (low) adv_wall(scene, 0, 0, edge, 0);
  if (adv_chance(r, 0.6)) adv_wall(scene, edge, h, adv_chance(r, 0.5) ? 0 : edge / 2, h);
  adv_screens(scene, r, adv_int(r, low ? 0 : 1, 2),
              (const double[4]){0, h / 8, edge, h - h / 8}, fmin(w, h) / 8, fmin(w, h));
  if (!scene->count) adv_wall(scene, 0, 0, edge, 0);
  on_left(scene, 0);
  on_left(scene, edge);
  if (adv_chance(r, 0.3)) adv_mirror(scene, -1, -0.5, 3, -0.5);
  adv_paint(scene, r, 0.8);
  if (adv_chance(r, 0.5)) scene->background[0] = 1;
}

/* A direction and length in which a scene repeats. */
static void repeat(adv_scene *scene, double x, double y) {
  const double step = ldexp(1, -scene->exponent);
  scene->period[0] = llround(x * step);
  scene->period[1] = llround(y * step);
}

/* Houses along streets. */
static void town(adv_scene *scene, adv_random *r) {
  const double wide = adv_real(r, 0.3, 2), high = adv_real(r, 0.2, 3),
               roof = adv_real(r, 0.3, 2);
  adv_wall(scene, 0, 0, wide, 0);
  adv_wall(scene, wide, 0, wide, high);
  adv_wall(scene, wide, high, wide + roof, high);
  adv_wall(scene, wide + roof, high, wide + roof, 0);
  if (adv_chance(r, 0.3)) adv_screen(scene, wide / 4, high / 2, wide / 2, high / 4);
  repeat(scene, wide + roof, 0);
  adv_paint(scene, r, 0.7);
  scene->background[0] = 1;
}

/* Panels, that may be longer than their period, over a ground that may be none. */
static void array(adv_scene *scene, adv_random *r) {
  const double tilt = adv_real(r, 0.1, 1.5),
               period = ldexp(adv_real(r, 1, 2), adv_int(r, -2, 2));
  const double x = cos(tilt), y = 0.25 + sin(tilt), slope = adv_chance(r, 0.3) ? period / 4 : 0;
  if (adv_chance(r, 0.7)) adv_wall(scene, 0, 0, period, slope);
  adv_screen(scene, 0, 0.25, x, y);
  if (slope > 0 && scene->count == 3 && adv_chance(r, 0.5))
    adv_screen(scene, 0, 0.5, x, y + 0.25);
  repeat(scene, period, slope);
  adv_paint(scene, r, 0.8);
  scene->background[0] = adv_int(r, 0, 1);
}

/* Endless plates, flat, in steps or in waves, which see each other for ever. */
static void plates(adv_scene *scene, adv_random *r) {
  const double period = ldexp(adv_real(r, 1, 2), adv_int(r, -2, 2));
  const double wave = adv_chance(r, 0.5) ? 0 : adv_real(r, 0.02, 0.4), middle = period / 2;
  adv_wall(scene, 0, 0, middle, wave);
  adv_wall(scene, middle, wave, period, 0);
  if (adv_chance(r, 0.8)) {
    adv_wall(scene, period, 1, middle / 2, 1 - wave / 3);
    adv_wall(scene, middle / 2, 1 - wave / 3, 0, 1);
  }
  repeat(scene, period, 0);
  adv_paint(scene, r, 0.8);
  if (adv_chance(r, 0.5)) scene->background[0] = 1;
}

/* Blocks in rows, and between plates at times. */
static void bed(adv_scene *scene, adv_random *r) {
  for (int k = adv_int(r, 1, 3); k > 0; k--) {
    double x = adv_real(r, 0, 0.9), y = k + adv_real(r, 0, 0.3), size = adv_real(r, 0.1, 0.6);
    adv_box(scene, x + size, y, x, y + size);
  }
  if (adv_chance(r, 0.5)) adv_wall(scene, 0, 0.5, 1.5, 0.5);
  repeat(scene, 1.5, 0);
  adv_paint(scene, r, 0.8);
}

/* A period and a mirror, along it or across. */
static void mirrored_row(adv_scene *scene, adv_random *r) {
  const double period = adv_real(r, 1, 3), across = floor(ldexp(period, 15)) * 0x1p-15;
  if (adv_chance(r, 0.5)) {
    adv_wall(scene, 0.25, adv_real(r, 0.5, 1), 0.25, 0);
    adv_screens(scene, r, adv_int(r, 1, 3), (const double[4]){0.3, 0, 4, across}, 0.1, 2);
    on_left(scene, 0);
    repeat(scene, 0, across);
  } else {
    adv_wall(scene, 0, 0, across / 2, 0);
    adv_screens(scene, r, adv_int(r, 1, 2), (const double[4]){0, 0.1, across / 2, 2}, 0.1, 2);
    on_left(scene, 0);
    repeat(scene, across, 0);
  }
  adv_paint(scene, r, 0.8);
  if (adv_chance(r, 0.5)) scene->background[0] = 1;
}

static void darken(adv_scene *scene) {
  for (size_t k = 0; k < scene->count; k++) scene->patch[k].emission[0] = 0;
}

/* Rows under a sun of any direction, or under pieces of sky. */
static void day_row(adv_scene *scene, adv_random *r) {
  town(scene, r);
  darken(scene);
  scene->background[0] = adv_int(r, 0, 1);
  if (adv_chance(r, 0.7))
    scene->sun[0] = (adv_sun){adv_int(r, -12, 12), -adv_int(r, 2, 12), 1};
  else
    scene->piece[scene->pieces++] = (adv_piece){adv_int(r, -90, 0), adv_int(r, 1, 90), {1}};
}

/* A court at noon: sun and sky are symmetric. */
static void noon(adv_scene *scene, adv_random *r) {
  const double wide = adv_real(r, 0.3, 2), high = adv_real(r, 0.3, 3);
  adv_wall(scene, 0, 0, wide, 0);
  adv_wall(scene, wide, 0, wide, high);
  at_mirror(scene, r, 0.1, high + 0.5);
  on_left(scene, 0);
  adv_paint(scene, r, 0.8);
  darken(scene);
  if (adv_chance(r, 0.7)) scene->sun[0] = (adv_sun){0, -1, 1};
  const int to = adv_int(r, 1, 90), from = adv_chance(r, 0.5) ? 0 : adv_int(r, 0, to - 1);
  if (from == 0 || !adv_has_sun(scene)) {
    scene->piece[scene->pieces++] = (adv_piece){from, to, {0.5}};
    scene->piece[scene->pieces++] = (adv_piece){-to, -from, {0.5}};
  }
  scene->background[0] = adv_int(r, 0, 2) / 4.0;
}

const adv_kind adv_symmetry[] = {
    {"half", half, "half of a room, and things at its mirror"},
    {"nearly", nearly_along, "half of a wedge at its mirror"},
    {"quarter", quarter, "a quarter of a room"},
    {"mirror-soup", soup, "free screens before one mirror or two"},
    {"hall", hall, "between two mirrors, and a third at times"},
    {"town", town, "equal streets under the sky"},
    {"array", array, "rows of panels, also across several periods"},
    {"plates", plates, "endless plates, flat or in waves"},
    {"bed", bed, "blocks in endless rows"},
    {"mirrored-row", mirrored_row, "a period and a mirror"},
    {"day-row", day_row, "streets under a sun or a piece of sky"},
    {"noon", noon, "half of a court under sun and sky"},
    {NULL, NULL, NULL}};
