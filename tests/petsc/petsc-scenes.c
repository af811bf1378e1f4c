/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Few patches, which are cut, and many, which are not; rooms and open scenes, with and without
   walls in the way; what is nearly lossless, dark, coloured, directed. */
#include "petsc/petsc-scenes.h"

#include <math.h>
#include <string.h>

#include "support/symmetric-scenes.h"

static hr2d_status add(hr2d_scene *scene, double ax, double ay, double bx, double by,
                       const double *emission, const double *reflectance, size_t bands) {
  hr2d_patch patch = HR2D_PATCH_INIT;
  patch.a = (hr2d_point){ax, ay};
  patch.b = (hr2d_point){bx, by};
  patch.emission = emission;
  patch.emission_bands = emission ? bands : 0;
  patch.reflectance = reflectance;
  patch.reflectance_bands = bands;
  return hr2d_scene_add(scene, &patch, NULL);
}

/* A square around a centre, seen from the inside if `size` is positive, else from the outside.
 */
static hr2d_status add_square(hr2d_scene *scene, double x, double y, double size, double turn,
                              const double *emission, const double *reflectance, size_t bands) {
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < 4 && !status; k++) {
    const double from = turn + 0.5 * k * 3.14159265358979323846, step = size > 0 ? 0.5 : -0.5;
    const double to = from + step * 3.14159265358979323846, r = fabs(size);
    status = add(scene, x + r * cos(from), y + r * sin(from), x + r * cos(to), y + r * sin(to),
                 k == 0 ? emission : NULL, reflectance, bands);
  }
  return status;
}

static const double one = 1, half_of = 0.5, nearly_all = 1 - 0x1p-40;

static hr2d_status plates(hr2d_scene *scene) {
  const hr2d_status status = add(scene, 0, 0, 1, 0, &one, &half_of, 1);
  return status ? status : add(scene, 1, 0.1, 0, 0.1, NULL, &half_of, 1);
}

/* Corners, and light that is nearly never lost. */
static hr2d_status bright_room(hr2d_scene *scene) {
  return add_square(scene, 0.3, 0.2, 1, 0.1, &one, &nearly_all, 1);
}

static hr2d_status round_room(hr2d_scene *scene) {
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < 90 && !status; k++) {
    const double from = 2 * 3.14159265358979323846 * k / 90;
    const double to = 2 * 3.14159265358979323846 * (k == 89 ? 0 : k + 1) / 90;
    status =
        add(scene, cos(from), sin(from), cos(to), sin(to), k % 9 ? NULL : &one, &half_of, 1);
  }
  return status;
}

/* Blocks in the open, in three bands, under a sky. */
static hr2d_status blocks(hr2d_scene *scene) {
  static const double light[] = {1, 0, 1e-3}, part[] = {0.8, 0.3, 0}, sky[] = {0.2, 1, 0.5};
  hr2d_status status = hr2d_scene_set_background(scene, sky, 3);
  for (int k = 0; k < 16 && !status; k++)
    status = add_square(scene, k % 4, k / 4, -0.3, 0.4 * k, k % 5 ? NULL : light, part, 3);
  return status;
}

/* Blocks in a room, of which one stands in a dark room of its own. */
static hr2d_status full_room(hr2d_scene *scene) {
  hr2d_status status = add_square(scene, 1.5, 1.5, 4, 0.3, &one, &half_of, 1);
  for (int k = 0; k < 9 && !status; k++)
    status = add_square(scene, k % 3, k / 3 + 0.5, -0.3, 0.7 * k, NULL, &half_of, 1);
  return status ? status : add_square(scene, 20, 0, 1, 0, NULL, &half_of, 1);
}

/* Blocks above a floor, whose row is most of all: it is cut. */
static hr2d_status floor_of_blocks(hr2d_scene *scene) {
  hr2d_status status = add(scene, -1, -1, 8, -1, &one, &half_of, 1);
  for (int k = 0; k < 8 && !status; k++)
    status = add_square(scene, k, 0.2 * (k % 3), -0.3, 0.7 * k, NULL, &half_of, 1);
  return status;
}

/* Two rooms that know nothing of each other. */
static hr2d_status two_rooms(hr2d_scene *scene) {
  const hr2d_status status = add_square(scene, 0, 0, 1, 0.2, &one, &nearly_all, 1);
  return status ? status : add_square(scene, 5, 0, 1, 0.3, &half_of, &half_of, 1);
}

/* The same where one is much darker than the other. */
static hr2d_status dim_room(hr2d_scene *scene) {
  static const double dim = 1e-18;
  const hr2d_status status = add_square(scene, 0, 0, 1, 0.2, &one, &half_of, 1);
  return status ? status : add_square(scene, 5, 0, 1, 0.3, &dim, &half_of, 1);
}

/* A plate of 1 beside one of 1e-6. */
static hr2d_status short_plate(hr2d_scene *scene) {
  hr2d_status status = add(scene, 0, 0, 1, 0, &one, &half_of, 1);
  if (!status) status = add(scene, 1, 0.5, 0, 0.5, NULL, &half_of, 1);
  return status ? status : add(scene, 0.5, 1e-6, 0.500001, 1e-6, NULL, &half_of, 1);
}

static hr2d_status black_plates(hr2d_scene *scene) {
  static const double none = 0;
  const hr2d_status status = add(scene, 0, 0, 1, 0, &one, &none, 1);
  return status ? status : add(scene, 1, 0.1, 0, 0.1, NULL, &none, 1);
}

static hr2d_status half(hr2d_scene *scene) {
  return symmetric_add(scene, SYMMETRIC_HALF);
}

static hr2d_status quarter(hr2d_scene *scene) {
  return symmetric_add(scene, SYMMETRIC_QUARTER);
}

static hr2d_status endless_plates(hr2d_scene *scene) {
  return symmetric_add(scene, SYMMETRIC_PLATES);
}

static hr2d_status streets(hr2d_scene *scene) {
  return symmetric_add(scene, SYMMETRIC_STREETS);
}

static hr2d_status panels(hr2d_scene *scene) {
  return symmetric_add(scene, SYMMETRIC_PANELS);
}

static hr2d_status hall(hr2d_scene *scene) {
  return symmetric_add(scene, SYMMETRIC_HALL);
}

static hr2d_status row(hr2d_scene *scene) {
  return symmetric_add(scene, SYMMETRIC_ROW);
}

/* Half of a triangle, in which nothing is in the way. */
static hr2d_status half_triangle(hr2d_scene *scene) {
  hr2d_status status = add(scene, 0, 0, 2, 0, &one, &half_of, 1);
  if (!status) status = add(scene, 2, 0, 0, 3, NULL, &half_of, 1);
  return status ? status : hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 0}, {0, 1}});
}

static const petsc_case cases[] = {
    {"plates", plates, .epsilon = 0.02},
    {"plates, no closure", plates, .epsilon = 0.05, .closure = HR2D_CLOSURE_OFF},
    {"plates, modified", plates, .policy = hr2d_policy_modified, .epsilon = 0.05},
    {"plates, l1", plates, .oracle = hr2d_oracle_l1, .epsilon = 1e-4},
    {"plates, bf", plates, .oracle = hr2d_oracle_bf, .epsilon = 0.002},
    {"plates, ordered", plates, .epsilon = 0.05, .ordered = 1},
    {"plates, multigrid", plates, .epsilon = 0.025, .from = 0.4},
    {"plates, level 2", plates, .epsilon = 0.02, .max_level = 2},
    {"black plates", black_plates, .epsilon = 0.05},
    {"bright room", bright_room, .epsilon = 0.1},
    {"bright room, size2", bright_room, .oracle = hr2d_oracle_size2, .epsilon = 0.02},
    {"round room", round_room, .epsilon = 0.1},
    {"round room, bf", round_room, .oracle = hr2d_oracle_bf, .epsilon = 0.002},
    {"blocks", blocks, .epsilon = 0.2},
    {"blocks, no closure", blocks, .epsilon = 0.2, .closure = HR2D_CLOSURE_OFF},
    {"blocks, multigrid", blocks, .epsilon = 0.2, .from = 0.8},
    {"full room", full_room, .epsilon = 0.2},
    {"full room, bf", full_room, .oracle = hr2d_oracle_bf, .epsilon = 0.01},
    {"floor", floor_of_blocks, .epsilon = 0.2},
    {"floor, ordered", floor_of_blocks, .epsilon = 0.4, .ordered = 1},
    {"floor, multigrid", floor_of_blocks, .epsilon = 0.2, .from = 0.8},
    {"two rooms", two_rooms, .epsilon = 0.1},
    {"dim room", dim_room, .epsilon = 0.1},
    {"short plate", short_plate, .epsilon = 0.1},
    {"half triangle", half_triangle, .epsilon = 0.02},
    {"half triangle, ordered", half_triangle, .epsilon = 0.05, .ordered = 1},
    {"half triangle, multigrid", half_triangle, .epsilon = 0.025, .from = 0.4},
    {"half", half, .epsilon = 0.1},
    {"half, no closure", half, .epsilon = 0.2, .closure = HR2D_CLOSURE_OFF},
    {"half, ordered", half, .epsilon = 0.2, .ordered = 1},
    {"half, multigrid", half, .epsilon = 0.1, .from = 0.4},
    {"quarter", quarter, .epsilon = 0.3},
    {"endless plates", endless_plates, .epsilon = 0.1},
    {"streets", streets, .epsilon = 0.1},
    {"panels", panels, .epsilon = 0.2},
    {"hall", hall, .epsilon = 0.2},
    {"row", row, .epsilon = 0.5},
};

const petsc_case *petsc_case_at(size_t k) {
  return k < sizeof cases / sizeof *cases ? &cases[k] : NULL;
}

const petsc_case *petsc_case_named(const char *name) {
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
    if (!strcmp(cases[k].name, name)) return &cases[k];
  return NULL;
}

hr2d_scene *petsc_case_scene(const petsc_case *c, const hr2d_allocator *hooks) {
  hr2d_scene *scene = NULL;
  hr2d_status status = hr2d_scene_create(hooks, &scene);
  if (!status) status = c->add(scene);
  if (!status) status = hr2d_scene_commit(scene);
  if (!status) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}
