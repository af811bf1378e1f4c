/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/slow-scenes.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const names[SLOW_KINDS] = {"squares", "spokes", "comb",    "city",
                                              "round",   "soup",   "mirrors", "periods",
                                              "slivers", "star",   "fans"};

const char *slow_name(slow_kind kind) {
  return names[kind];
}

typedef struct adder {
  hr2d_scene *scene;
  hr2d_status status;
  uint64_t random;
} adder;

static double draw(adder *a) {
  a->random = a->random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(a->random >> 11) * 0x1p-53;
}

static void put(adder *a, double ax, double ay, double bx, double by, double emission,
                hr2d_sides sides) {
  const double rho = 0.5;
  const hr2d_patch patch = {.a = {ax, ay},
                            .b = {bx, by},
                            .emission = &emission,
                            .emission_bands = emission > 0,
                            .reflectance = &rho,
                            .reflectance_bands = 1,
                            .sides = sides};
  if (!a->status) a->status = hr2d_scene_add(a->scene, &patch, NULL);
}

static void put_room(adder *a, double size) {
  put(a, 0, 0, size, 0, 0, HR2D_SIDES_FRONT);
  put(a, size, 0, size, size, 0, HR2D_SIDES_FRONT);
  put(a, size, size, 0, size, 1, HR2D_SIDES_FRONT);
  put(a, 0, size, 0, 0, 0, HR2D_SIDES_FRONT);
}

/* A grid of cells, each with something small at a place of its own. */
static void put_squares(adder *a, size_t count) {
  const size_t across = (size_t)ceil(sqrt((double)count / 4));
  put_room(a, (double)across);
  for (size_t k = 0; 4 * k < count; k++) {
    const double x = (double)(k % across) + 0.1 + 0.4 * draw(a);
    const double y = (double)(k / across) + 0.1 + 0.4 * draw(a), s = 0.1 + 0.3 * draw(a);
    put(a, x, y, x, y + s, 0, HR2D_SIDES_FRONT);
    put(a, x, y + s, x + s, y + s, 0, HR2D_SIDES_FRONT);
    put(a, x + s, y + s, x + s, y, 0, HR2D_SIDES_FRONT);
    put(a, x + s, y, x, y, 0, HR2D_SIDES_FRONT);
  }
}

static void put_spokes(adder *a, size_t count) {
  const double pi = 3.14159265358979323846;
  put_room(a, 4);
  for (size_t k = 0; 2 * k < count; k++) {
    const double angle = 4 * pi * ((double)k + 0.3) / (double)count;
    put(a, 2 + 0.2 * cos(angle), 2 + 0.2 * sin(angle), 2 + 1.5 * cos(angle),
        2 + 1.5 * sin(angle), 0, HR2D_SIDES_BOTH);
  }
}

static void put_comb(adder *a, size_t count) {
  const size_t teeth = count / 4 + 1;
  const double pitch = 1.0 / (double)teeth;
  for (size_t k = 0; k < teeth; k++) {
    const double x = (double)k * pitch, y = 0.02 + 0.1 * draw(a), half = pitch / 2;
    put(a, x, 0, x + half, 0, 0, HR2D_SIDES_FRONT);
    put(a, x + half, 0, x + half, y, 0, HR2D_SIDES_FRONT);
    put(a, x + half, y, x + pitch, y, 0, HR2D_SIDES_FRONT);
    put(a, x + pitch, y, x + pitch, 0, 0, HR2D_SIDES_FRONT);
  }
  put(a, 0.7, 0.5, 0.3, 0.5, 1, HR2D_SIDES_FRONT);
}

static void put_sky(adder *a) {
  const double sky = 1;
  if (!a->status) a->status = hr2d_scene_set_background(a->scene, &sky, 1);
}

static void put_city(adder *a, size_t count) {
  const size_t houses = count / 4 + 1;
  for (size_t k = 0; k < houses; k++) {
    const double x = 20 * (double)k, y = 5 + 40 * draw(a);
    put(a, x, 0, x + 8, 0, 0, HR2D_SIDES_FRONT);
    put(a, x + 8, 0, x + 8, y, 0, HR2D_SIDES_FRONT);
    put(a, x + 8, y, x + 20, y, 0, HR2D_SIDES_FRONT);
    put(a, x + 20, y, x + 20, 0, 0, HR2D_SIDES_FRONT);
  }
  put_sky(a);
}

static void put_round(adder *a, size_t count) {
  const double pi = 3.14159265358979323846;
  for (size_t k = 0; k < count; k++) {
    const double from = 2 * pi * (double)k / (double)count;
    const double to = 2 * pi * (double)((k + 1) % count) / (double)count;
    put(a, cos(from), sin(from), cos(to), sin(to), k == 0, HR2D_SIDES_FRONT);
  }
}

/* Two-sided walls have a cell each, so many in a row. */
static size_t cells_across(size_t count) {
  return (size_t)ceil(sqrt((double)count / 2));
}

static void put_walls(adder *a, size_t count) {
  const size_t across = cells_across(count);
  for (size_t k = 0; 2 * k < count; k++) {
    const double x = (double)(k % across) + 0.5, y = (double)(k / across) + 0.5;
    const double angle = 6.28 * draw(a), half = 0.1 + 0.35 * draw(a);
    const double dx = half * cos(angle), dy = half * sin(angle);
    put(a, x - dx, y - dy, x + dx, y + dy, 0, HR2D_SIDES_BOTH);
  }
}

static void put_soup(adder *a, size_t count) {
  put_room(a, (double)cells_across(count));
  put_walls(a, count);
}

static void put_mirrors(adder *a, size_t count) {
  const hr2d_segment line[2] = {{{0, 0}, {0, 1}}, {{0, 0}, {1, 0}}};
  put_walls(a, count);
  put_sky(a);
  for (size_t k = 0; k < 2 && !a->status; k++)
    a->status = hr2d_scene_add_mirror(a->scene, line[k]);
}

static void put_periods(adder *a, size_t count) {
  const double across = (double)cells_across(count);
  put_walls(a, count);
  put(a, 0, 0, across, 0, 0, HR2D_SIDES_FRONT);
  put_sky(a);
  if (!a->status) a->status = hr2d_scene_set_period(a->scene, (hr2d_point){across, 0});
}

/* Each is near to two others on each side: nearer than a twentieth of the plates, and than a
   thousandth of the scene, for which there is a ground. */
static void put_slivers(adder *a, size_t count) {
  for (size_t k = 0; 2 * k < count; k++) {
    const double y = 0.02 * (double)k, shift = 0.01 * draw(a);
    put(a, shift, y, 1 + shift, y + 0.01 * draw(a), 0, HR2D_SIDES_BOTH);
  }
  put(a, -50, -1, 50, -1, 0, HR2D_SIDES_FRONT);
  put_sky(a);
}

/* Walls of length 1 from a point, between two angles. */
static void put_fan(adder *a, hr2d_point p, size_t walls, double from, double to) {
  for (size_t k = 0; k < walls; k++) {
    const double angle = from + (to - from) * (double)k / (double)walls;
    put(a, p.x, p.y, p.x + cos(angle), p.y + sin(angle), 0, HR2D_SIDES_BOTH);
  }
}

static void put_star(adder *a, size_t count) {
  put_fan(a, (hr2d_point){0, 0}, count / 2, 0, 2 * 3.14159265358979323846);
  put_sky(a);
}

static void put_fans(adder *a, size_t count) {
  enum { FANS = 10 };
  put(a, 0, 0, 2 * FANS, 0, 0, HR2D_SIDES_FRONT);
  for (size_t k = 0; k < FANS; k++)
    put_fan(a, (hr2d_point){.5 + 2 * (double)k, 0}, count / (2 * FANS), .5, 1.5);
  put_sky(a);
}

hr2d_status slow_add(hr2d_scene *scene, slow_kind kind, size_t count) {
  static void (*const put_kind[SLOW_KINDS])(adder *, size_t) = {
      put_squares, put_spokes,  put_comb,    put_city, put_round, put_soup,
      put_mirrors, put_periods, put_slivers, put_star, put_fans};
  adder a = {scene, HR2D_OK, 1};
  put_kind[kind](&a, count);
  return a.status;
}

hr2d_status slow_add_heated(hr2d_scene *scene) {
  static const double wavelength[] = {3, 8};
  static const struct {
    hr2d_segment at;
    hr2d_heat given;
    double value, e[3];
  } walls[] = {{{{0, 0}, {4, 0}}, HR2D_HEAT_TEMPERATURE, 1500, {.3, .5, .9}},
               {{{4, 0}, {4.5, 3}}, HR2D_HEAT_FLUX, 0, {.9, .5, .2}},
               {{{4.5, 3}, {0, 3}}, HR2D_HEAT_TEMPERATURE, 500, {.1, .5, .7}},
               {{{0, 3}, {0, 0}}, HR2D_HEAT_FLUX, -2000, {.4, .8, .9}},
               {{{2, 1}, {2, 2}}, HR2D_HEAT_FLUX, 300, {.7, .2, .4}},
               {{{2, 2}, {2, 1}}, HR2D_HEAT_FLUX, 0, {.6, .6, .1}}};
  hr2d_status status = hr2d_scene_set_wavelengths(scene, wavelength, 2);
  for (size_t k = 0; k < sizeof walls / sizeof *walls && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = walls[k].at.a;
    patch.b = walls[k].at.b;
    hr2d_thermal heat = HR2D_THERMAL_INIT;
    heat.given = walls[k].given;
    heat.value = walls[k].value;
    heat.emissivity = walls[k].e;
    heat.emissivity_bands = 3;
    status = hr2d_scene_add_thermal(scene, &patch, &heat, NULL);
  }
  return status;
}

hr2d_status slow_add_crossing(hr2d_scene *scene, size_t count) {
  adder a = {scene, HR2D_OK, 2};
  const double length = 3 / sqrt((double)count);
  for (size_t k = 0; k < count; k++) {
    const double x = draw(&a), y = draw(&a), angle = 6.28 * draw(&a);
    put(&a, x, y, x + length * cos(angle), y + length * sin(angle), 1, HR2D_SIDES_BOTH);
  }
  return a.status;
}

char *slow_text(const hr2d_scene *scene, size_t *size) {
  static const char head[] = "{\"type\": \"FeatureCollection\", \"features\": [";
  const size_t patches = hr2d_scene_patches(scene), room = sizeof head + 256 * patches + 8;
  char *text = malloc(room), *at = text;
  if (!text) return NULL;
  at += sprintf(at, "%s", head);
  for (size_t k = 0; k < patches; k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    at += sprintf(at,
                  "%s\n{\"type\": \"Feature\", \"properties\": {\"reflectance\": 0.5}, "
                  "\"geometry\": {\"type\": \"LineString\", \"coordinates\": "
                  "[[%.9g, %.9g], [%.9g, %.9g]]}}",
                  k ? "," : "", s.a.x, s.a.y, s.b.x, s.b.y);
  }
  at += sprintf(at, "]}\n");
  *size = (size_t)(at - text);
  return text;
}
