/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/symmetric-scenes.h"

#include <math.h>

/* A patch: its ends, E and ρ. */
typedef struct patch {
  double ax, ay, bx, by, emission, reflectance;
  hr2d_sides sides;
} patch;

static hr2d_point turned(hr2d_point p, double angle) {
  return (hr2d_point){cos(angle) * p.x - sin(angle) * p.y, sin(angle) * p.x + cos(angle) * p.y};
}

static hr2d_status add(hr2d_scene *scene, const patch *p, double angle) {
  hr2d_patch made = HR2D_PATCH_INIT;
  made.a = (hr2d_point){p->ax, p->ay};
  made.b = (hr2d_point){p->bx, p->by};
  if (angle != 0) {
    made.a = turned(made.a, angle);
    made.b = turned(made.b, angle);
  }
  made.emission = &p->emission;
  made.reflectance = &p->reflectance;
  made.emission_bands = made.reflectance_bands = 1;
  made.sides = p->sides;
  return hr2d_scene_add(scene, &made, NULL);
}

static hr2d_status add_all(hr2d_scene *scene, const patch *p, size_t count, double angle) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status; k++) status = add(scene, &p[k], angle);
  return status;
}

#define ADD(scene, list, angle) add_all(scene, list, sizeof(list) / sizeof *(list), angle)

static hr2d_status add_mirror(hr2d_scene *scene, double x, double y, double angle) {
  const hr2d_point from = {0, 0}, to = turned((hr2d_point){x, y}, angle);
  return hr2d_scene_add_mirror(scene, (hr2d_segment){from, to});
}

static hr2d_status set_background(hr2d_scene *scene, double light) {
  return hr2d_scene_set_background(scene, &light, 1);
}

/* The post is nearly as high as the room, so that walls hide their images in part. */
static hr2d_status half(hr2d_scene *scene, double angle) {
  static const patch room[] = {{0, 0, 2, 0, 0, .5, HR2D_SIDES_FRONT},
                               {2, 0, 2, 3, 1, .1, HR2D_SIDES_FRONT},
                               {2, 3, 0, 3, 0, .8, HR2D_SIDES_FRONT},
                               {.7, .3, .9, 2.1, 0, .6, HR2D_SIDES_BOTH}};
  const hr2d_status status = ADD(scene, room, angle);
  return status ? status : add_mirror(scene, 0, 3, angle);
}

static hr2d_status add_block(hr2d_scene *scene, double x, double y, double size, double turn,
                             const double *emission, const double *reflectance) {
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < 4 && !status; k++) {
    const double from = turn - 0.5 * k * 3.14159265358979323846;
    const double to = turn - 0.5 * (k + 1) * 3.14159265358979323846;
    hr2d_patch p = HR2D_PATCH_INIT;
    p.a = (hr2d_point){x + size * cos(from), y + size * sin(from)};
    p.b = (hr2d_point){x + size * cos(to), y + size * sin(to)};
    p.emission = emission;
    p.reflectance = reflectance;
    p.emission_bands = emission ? 2 : 0;
    p.reflectance_bands = 2;
    status = hr2d_scene_add(scene, &p, NULL);
  }
  return status;
}

static hr2d_status quarter(hr2d_scene *scene) {
  static const double light[] = {1, .1}, part[] = {.8, .3}, sky[] = {.2, .5};
  hr2d_status status = hr2d_scene_set_background(scene, sky, 2);
  for (int k = 0; k < 6 && !status; k++)
    status = add_block(scene, .7 + k % 3, .6 + k / 3, .3, .4 * k, k ? NULL : light, part);
  if (!status) status = add_mirror(scene, 1, 0, 0);
  return status ? status : add_mirror(scene, 0, 1, 0);
}

enum { ONE, OTHER };

static const patch plate[] = {[ONE] = {0, 0, 1, 0, 1, .5, HR2D_SIDES_FRONT},
                              [OTHER] = {1, 1, 0, 1, 0, .7, HR2D_SIDES_FRONT}};

static hr2d_status plates(hr2d_scene *scene) {
  const hr2d_status status = ADD(scene, plate, 0);
  return status ? status : hr2d_scene_set_period(scene, (hr2d_point){1, 0});
}

/* F = 1, so that B₁ = E + ρ₁B₂ and B₂ = ρ₂B₁. */
void symmetric_plates_answer(double answer[2]) {
  answer[0] = plate[ONE].emission / (1 - plate[ONE].reflectance * plate[OTHER].reflectance);
  answer[1] = plate[OTHER].reflectance * answer[0];
}

static hr2d_status streets(hr2d_scene *scene) {
  static const patch house[] = {{0, 0, 12, 0, 0, 0, HR2D_SIDES_FRONT},
                                {12, 0, 12, 9, 0, .4, HR2D_SIDES_FRONT},
                                {12, 9, 20, 9, 0, .2, HR2D_SIDES_FRONT},
                                {20, 9, 20, 0, .3, .6, HR2D_SIDES_FRONT}};
  hr2d_status status = ADD(scene, house, 0);
  if (!status) status = set_background(scene, 1);
  return status ? status : hr2d_scene_set_period(scene, (hr2d_point){20, 0});
}

static hr2d_status panels(hr2d_scene *scene) {
  static const patch panel[] = {{0, 0, 2, 0, 0, .2, HR2D_SIDES_FRONT},
                                {.4, .7, 1.4, 1.3, 0, .3, HR2D_SIDES_BOTH}};
  hr2d_status status = ADD(scene, panel, 0);
  if (!status) status = set_background(scene, 1);
  return status ? status : hr2d_scene_set_period(scene, (hr2d_point){2, 0});
}

static hr2d_status hall(hr2d_scene *scene) {
  static const patch thing[] = {{0, 2, -1, 2, 1, .5, HR2D_SIDES_FRONT},
                                {-.8, .4, -.3, .9, 0, .7, HR2D_SIDES_BOTH}};
  hr2d_status status = ADD(scene, thing, 0);
  if (!status) status = add_mirror(scene, 0, 1, 0);
  if (!status) status = hr2d_scene_add_mirror(scene, (hr2d_segment){{-1, 0}, {-1, 1}});
  return status ? status : add_mirror(scene, 1, 0, 0);
}

static hr2d_status row(hr2d_scene *scene) {
  static const double light[] = {1, .1}, part[] = {.8, .3};
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < 8 && !status; k++)
    status = add_block(scene, k % 4, .6 + k / 4, .4, .3 * k, k % 3 ? NULL : light, part);
  if (!status) status = add_mirror(scene, 1, 0, 0);
  return status ? status : hr2d_scene_set_period(scene, (hr2d_point){4.25, 0});
}

/* Light comes down along the mirror. */
static hr2d_status sunny(hr2d_scene *scene) {
  static const patch house[] = {{0, 0, 3, 0, 0, .3, HR2D_SIDES_FRONT},
                                {1, 0, 1, 1.7, 0, .6, HR2D_SIDES_BOTH},
                                {.4, 2.2, 1.1, 2.5, 0, .5, HR2D_SIDES_BOTH}};
  static const hr2d_sun sun = {{0, -1}, 3};
  static const hr2d_sky_piece piece[] = {{-60, -20}, {-20, 20}, {20, 60}};
  static const double value[] = {2, 5, 2};
  hr2d_status status = ADD(scene, house, 0);
  if (!status) status = set_background(scene, .5);
  if (!status) status = hr2d_scene_set_sun(scene, &sun, 1);
  if (!status) status = hr2d_scene_set_sky(scene, piece, 3, value, 1);
  return status ? status : add_mirror(scene, 0, 1, 0);
}

static hr2d_status heated(hr2d_scene *scene) {
  static const double wavelength[] = {3, 8};
  static const double emissivity[][3] = {
      {.3, .5, .9}, {.9, .5, .2}, {.1, .5, .7}, {.7, .2, .4}};
  static const double value[] = {1500, 0, 500, -300};
  static const hr2d_segment at[] = {
      {{0, 0}, {4, 0}}, {{4, 0}, {4.5, 3}}, {{4.5, 3}, {0, 3}}, {{2, 1}, {2, 2}}};
  hr2d_status status = hr2d_scene_set_wavelengths(scene, wavelength, 2);
  for (size_t k = 0; k < 4 && !status; k++) {
    hr2d_patch p = HR2D_PATCH_INIT;
    hr2d_thermal heat = HR2D_THERMAL_INIT;
    p.a = at[k].a;
    p.b = at[k].b;
    heat.given = k % 2 ? HR2D_HEAT_FLUX : HR2D_HEAT_TEMPERATURE;
    heat.value = value[k];
    heat.emissivity = emissivity[k];
    heat.emissivity_bands = 3;
    status = hr2d_scene_add_thermal(scene, &p, &heat, NULL);
  }
  return status ? status : add_mirror(scene, 0, 1, 0);
}

hr2d_status symmetric_add(hr2d_scene *scene, symmetric_kind kind) {
  switch (kind) {
  case SYMMETRIC_HALF:
    return half(scene, 0);
  case SYMMETRIC_OBLIQUE:
    return half(scene, .7);
  case SYMMETRIC_QUARTER:
    return quarter(scene);
  case SYMMETRIC_PLATES:
    return plates(scene);
  case SYMMETRIC_STREETS:
    return streets(scene);
  case SYMMETRIC_PANELS:
    return panels(scene);
  case SYMMETRIC_HALL:
    return hall(scene);
  case SYMMETRIC_ROW:
    return row(scene);
  case SYMMETRIC_SUNNY:
    return sunny(scene);
  case SYMMETRIC_HEATED:
    return heated(scene);
  default:
    return HR2D_EINVAL;
  }
}
