/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "budget-scenes.h"

#include <math.h>
#include <stdlib.h>

#include "many.h"
#include "support/slow-scenes.h"

#define PI 3.14159265358979323846

static hr2d_status put(hr2d_scene *scene, double ax, double ay, double bx, double by,
                       double emission) {
  const double rho = .5;
  const hr2d_patch patch = {.a = {ax, ay},
                            .b = {bx, by},
                            .emission = &emission,
                            .emission_bands = emission > 0,
                            .reflectance = &rho,
                            .reflectance_bands = 1};
  return hr2d_scene_add(scene, &patch, NULL);
}

static hr2d_status put_box(hr2d_scene *scene, double x, double y, double s) {
  hr2d_status status = put(scene, x, y, x, y + s, 0);
  if (!status) status = put(scene, x, y + s, x + s, y + s, 0);
  if (!status) status = put(scene, x + s, y + s, x + s, y, 0);
  return status ? status : put(scene, x + s, y, x, y, 0);
}

#define SLOW(kind, KIND)                                                                       \
  static hr2d_status add_##kind(hr2d_scene *scene, size_t n) {                                 \
    return slow_add(scene, SLOW_##KIND, n);                                                    \
  }
SLOW(squares, SQUARES)
SLOW(spokes, SPOKES)
SLOW(comb, COMB)
SLOW(city, CITY)
SLOW(round, ROUND)
SLOW(soup, SOUP)
SLOW(mirrors, MIRRORS)
SLOW(periods, PERIODS)
SLOW(slivers, SLIVERS)
SLOW(star, STAR)
SLOW(fans, FANS)

/* Two plates, one bright, each of n/2 patches in a row. */
static hr2d_status add_plates(hr2d_scene *scene, size_t n) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; 2 * k < n && !status; k++) {
    const double x = 2 * (double)k / (double)n, w = 2 / (double)n;
    status = put(scene, x, 0, x + w, 0, 0);
    if (!status) status = put(scene, x + w, 1, x, 1, 1);
  }
  return status;
}

/* Rooms in a row, with a door of changing height in each wall. */
static hr2d_status add_partitions(hr2d_scene *scene, size_t n) {
  hr2d_status status = put(scene, 0, 3, 0, 0, 1);
  for (size_t k = 0; 4 * k < n && !status; k++) {
    const double x = 4 * (double)k, door = .5 + (double)(k % 7) / 4;
    status = put(scene, x, 0, x + 4, 0, 0);
    if (!status) status = put(scene, x + 4, 3, x, 3, 0);
    if (!status) status = put(scene, x + 4, door, x + 4, 3, 0);
    if (!status) status = put(scene, x + 4, 3, x + 4, door, 0);
  }
  return status;
}

/* Boxes in ten heaps that are far from each other, under the sky. */
static hr2d_status add_heaps(hr2d_scene *scene, size_t n) {
  enum { HEAPS = 10 };
  const size_t across = (size_t)ceil(sqrt((double)n / (4 * HEAPS)));
  const double sky = 1;
  hr2d_status status = hr2d_scene_set_background(scene, &sky, 1);
  for (size_t k = 0; 4 * k < n && !status; k++) {
    const size_t heap = k % HEAPS, at = k / HEAPS;
    const double x = 20 * (double)across * cos(2 * PI * (double)heap / HEAPS),
                 y = 20 * (double)across * sin(2 * PI * (double)heap / HEAPS);
    status = put_box(scene, x + (double)(at % across), y + (double)(at / across), .5);
  }
  return status;
}

static hr2d_status add_fibres(hr2d_scene *scene, size_t n) {
  enum { SIDES = 16 };
  many_bed bed = many_bed_of(n / SIDES, SIDES);
  hr2d_point at[MANY_CORNERS];
  hr2d_status status = put(scene, 2, 2, -1, 2, 1);
  while (!status && many_bed_next(&bed, at))
    for (size_t k = 0; k < SIDES && !status; k++) {
      const hr2d_point p = at[k], q = at[(k + 1) % SIDES];
      status = put(scene, q.x, q.y, p.x, p.y, 0);
    }
  return status;
}

/* A city in the light of suns, each of which is a band of its own. */
static hr2d_status add_suns(hr2d_scene *scene, size_t n) {
  enum { SUNS = 200 };
  hr2d_sun sun[SUNS];
  for (size_t k = 0; k < SUNS; k++) {
    const double angle = PI * ((double)k + .5) / SUNS;
    sun[k] = (hr2d_sun){.direction = {cos(angle), -sin(angle)}, .irradiance = 1};
  }
  const hr2d_status status = hr2d_scene_set_sun(scene, sun, SUNS);
  return status ? status : slow_add(scene, SLOW_CITY, n);
}

static hr2d_status add_sky(hr2d_scene *scene, size_t n) {
  enum { PIECES = 24 };
  hr2d_sky_piece piece[PIECES];
  double value[PIECES];
  for (size_t k = 0; k < PIECES; k++) {
    piece[k] = (hr2d_sky_piece){270 + 180. / PIECES * (double)k,
                                270 + 180. / PIECES * (double)(k + 1)};
    value[k] = 1 + (double)k;
  }
  const hr2d_status status = slow_add(scene, SLOW_CITY, n);
  return status ? status : hr2d_scene_set_sky(scene, piece, PIECES, value, 1);
}

static hr2d_status add_bands(hr2d_scene *scene, size_t n) {
  enum { BANDS = 100 };
  double light[BANDS];
  for (size_t k = 0; k < BANDS; k++) light[k] = (double)(k + 1);
  const hr2d_status status = slow_add(scene, SLOW_SOUP, n);
  return status ? status : hr2d_scene_set_background(scene, light, BANDS);
}

/* Walls of given temperature and of given flux by turns. */
static hr2d_status add_thermal(hr2d_scene *scene, size_t n) {
  const double emissivity = .8;
  const size_t side = n / 4 + 1;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < 4 * side && !status; k++) {
    const double t = (double)(k % side), m = (double)side;
    const hr2d_segment all[] = {{{t, 0}, {t + 1, 0}},
                                {{m, t}, {m, t + 1}},
                                {{m - t, m}, {m - t - 1, m}},
                                {{0, m - t}, {0, m - t - 1}}};
    hr2d_patch patch = HR2D_PATCH_INIT;
    hr2d_thermal heat = HR2D_THERMAL_INIT;
    patch.a = all[k / side].a;
    patch.b = all[k / side].b;
    heat.given = k % 3 ? HR2D_HEAT_TEMPERATURE : HR2D_HEAT_FLUX;
    heat.value = k % 3 ? 300 + 200 * (double)(k / side) : 0;
    heat.emissivity = &emissivity;
    heat.emissivity_bands = 1;
    status = hr2d_scene_add_thermal(scene, &patch, &heat, NULL);
  }
  return status;
}

static hr2d_status add_room(hr2d_scene *scene, size_t n) {
  (void)n;
  return slow_add_heated(scene);
}

const budget_kind budget_kinds[BUDGET_KINDS] = {{"squares", 0, add_squares},
                                                {"spokes", 10000, add_spokes},
                                                {"comb", 0, add_comb},
                                                {"city", 0, add_city},
                                                {"round", 0, add_round},
                                                {"soup", 0, add_soup},
                                                {"mirrors", 25000, add_mirrors},
                                                {"periods", 0, add_periods},
                                                {"slivers", 0, add_slivers},
                                                {"star", 0, add_star},
                                                {"fans", 0, add_fans},
                                                {"plates", 0, add_plates},
                                                {"partitions", 0, add_partitions},
                                                {"heaps", 0, add_heaps},
                                                {"fibres", 0, add_fibres},
                                                {"suns", 2000, add_suns},
                                                {"sky", 10000, add_sky},
                                                {"bands", 10000, add_bands},
                                                {"thermal", 0, add_thermal},
                                                {"room", 0, add_room}};
