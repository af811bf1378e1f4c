/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "many.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

static hr2d_status add(hr2d_scene *scene, hr2d_point a, hr2d_point b, double emission,
                       hr2d_sides sides) {
  const double rho = 0.5;
  const hr2d_patch patch = {.a = a,
                            .b = b,
                            .emission = &emission,
                            .emission_bands = 1,
                            .reflectance = &rho,
                            .reflectance_bands = 1,
                            .sides = sides};
  return hr2d_scene_add(scene, &patch, NULL);
}

/* A ring of points, counter-clockwise with the front inside, or outside. */
static hr2d_status add_ring(hr2d_scene *scene, const hr2d_point *at, size_t count, int outside,
                            double first) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status; k++) {
    const hr2d_point p = at[k], q = at[(k + 1) % count];
    status = add(scene, outside ? q : p, outside ? p : q, k == 0 ? first : 0, HR2D_SIDES_FRONT);
  }
  return status;
}

static hr2d_status add_box(hr2d_scene *scene, double x, double y, double size, int outside,
                           double first) {
  const hr2d_point at[] = {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
  return add_ring(scene, at, 4, outside, first);
}

static hr2d_scene *commit(hr2d_scene *scene, hr2d_status status) {
  if (!status) status = hr2d_scene_commit(scene);
  if (!status) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

/* A polygon in a circle. */
static hr2d_scene *make_round(size_t patches) {
  hr2d_scene *scene = NULL;
  hr2d_point *at = malloc(patches * sizeof *at);
  if (!at || hr2d_scene_create(NULL, &scene)) return NULL;
  for (size_t k = 0; k < patches; k++) {
    const double angle = 2 * PI * (double)k / (double)patches;
    at[k] = (hr2d_point){cos(angle), sin(angle)};
  }
  const hr2d_status status = add_ring(scene, at, patches, 0, 1);
  free(at);
  return commit(scene, status);
}

static size_t side_of(size_t things) {
  const size_t side = (size_t)ceil(sqrt((double)things));
  return side > 0 ? side : 1;
}

/* Squares in a square room, a grid of cells with one in each. */
static hr2d_scene *make_squares(size_t patches) {
  const size_t squares = patches / 4 - 1, side = side_of(squares);
  const double cell = 1 / (double)side;
  hr2d_scene *scene = NULL;
  if (hr2d_scene_create(NULL, &scene)) return NULL;
  hr2d_status status = add_box(scene, 0, 0, 1, 0, 1);
  for (size_t k = 0; k < squares && !status; k++)
    status = add_box(scene, cell * ((double)(k % side) + 0.3),
                     cell * ((double)(k / side) + 0.3), 0.4 * cell, 1, 0);
  return commit(scene, status);
}

/* Two-sided walls in a square room, each anywhere in its own cell. */
static hr2d_scene *make_walls(size_t patches) {
  const size_t walls = (patches - 4) / 2, side = side_of(walls);
  const double cell = 1 / (double)side;
  randoms state = {20240229};
  hr2d_scene *scene = NULL;
  if (hr2d_scene_create(NULL, &scene)) return NULL;
  hr2d_status status = add_box(scene, 0, 0, 1, 0, 1);
  for (size_t k = 0; k < walls && !status; k++) {
    const double x = cell * (double)(k % side), y = cell * (double)(k / side);
    const double u[] = {random_unit(&state), random_unit(&state), random_unit(&state),
                        random_unit(&state)};
    const hr2d_point a = {x + cell * (0.05 + 0.9 * u[0]), y + cell * (0.05 + 0.9 * u[1])};
    const hr2d_point b = {x + cell * (0.05 + 0.9 * u[2]), y + cell * (0.05 + 0.9 * u[3])};
    status = add(scene, a, b, 0, HR2D_SIDES_BOTH);
  }
  return commit(scene, status);
}

static hr2d_point turned(double x, double y, double radius, double angle) {
  return (hr2d_point){x + radius * cos(angle), y + radius * sin(angle)};
}

many_bed many_bed_of(size_t count, size_t corners) {
  return (many_bed){count, corners, 0, {20240301}};
}

int many_bed_next(many_bed *bed, hr2d_point *at) {
  const size_t side = side_of(bed->count), k = bed->next++;
  const double cell = 1 / (double)side;
  if (k >= bed->count) return 0;
  const double radius = cell * (0.1 + 0.2 * random_unit(&bed->state)), free = cell - 2 * radius;
  const double x = cell * (double)(k % side) + radius + free * random_unit(&bed->state);
  const double y = cell * (double)(k / side) + radius + free * random_unit(&bed->state);
  const double angle = 2 * PI * random_unit(&bed->state);
  for (size_t c = 0; c < bed->corners; c++)
    at[c] = turned(x, y, radius, angle + 2 * PI * (double)c / (double)bed->corners);
  return 1;
}

/* With their fronts outside in a square room with one bright wall. */
static hr2d_scene *make_polygons(size_t count, size_t corners) {
  hr2d_point at[MANY_CORNERS];
  many_bed bed = many_bed_of(count, corners);
  hr2d_scene *scene = NULL;
  if (hr2d_scene_create(NULL, &scene)) return NULL;
  hr2d_status status = add_box(scene, 0, 0, 1, 0, 1);
  while (!status && many_bed_next(&bed, at)) status = add_ring(scene, at, bed.corners, 1, 0);
  return commit(scene, status);
}

hr2d_scene *many_random_squares(size_t squares) {
  return make_polygons(squares, 4);
}

hr2d_scene *many_fibres(size_t fibres) {
  return make_polygons(fibres, 16);
}

/* Light comes from the right side of each. */
hr2d_scene *many_row(size_t squares) {
  hr2d_scene *scene = NULL;
  if (hr2d_scene_create(NULL, &scene)) return NULL;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < squares && !status; k++) {
    const double x = 2 * (double)k;
    const hr2d_point at[] = {{x + 1, 0}, {x + 1, 1}, {x, 1}, {x, 0}};
    status = add_ring(scene, at, 4, 1, 1);
  }
  return commit(scene, status);
}

hr2d_scene *many_round(size_t patches) {
  return make_round(patches);
}

const many_kind many_kinds[] = {
    {"round room", make_round},
    {"squares in a room", make_squares},
    {"walls in a room", make_walls},
};
const size_t many_kind_count = sizeof many_kinds / sizeof *many_kinds;
