/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes on a grid. */
#include "adversary/scene.h"

#include <math.h>
#include <string.h>

void adv_clear(adv_scene *scene, int exponent) {
  memset(scene, 0, sizeof *scene);
  scene->bands = 1;
  scene->exponent = exponent;
  scene->gain = 1;
}

static int64_t on_grid(const adv_scene *scene, double x) {
  return llround(ldexp(x, -scene->exponent));
}

void adv_wall(adv_scene *scene, double ax, double ay, double bx, double by) {
  adv_patch p = {.x = {on_grid(scene, ax), on_grid(scene, bx)},
                 .y = {on_grid(scene, ay), on_grid(scene, by)}};
  if (scene->count == ADV_PATCHES || (p.x[0] == p.x[1] && p.y[0] == p.y[1])) return;
  scene->patch[scene->count++] = p;
}

void adv_screen(adv_scene *scene, double ax, double ay, double bx, double by) {
  adv_wall(scene, ax, ay, bx, by);
  adv_wall(scene, bx, by, ax, ay);
}

void adv_ring(adv_scene *scene, const double (*corner)[2], size_t count) {
  for (size_t k = 0; k < count; k++) {
    const double *a = corner[k], *b = corner[(k + 1) % count];
    adv_wall(scene, a[0], a[1], b[0], b[1]);
  }
}

void adv_box(adv_scene *scene, double x0, double y0, double x1, double y1) {
  const double corner[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  adv_ring(scene, corner, 4);
}

static hr2d_point point(const adv_patch *p, int end) {
  return (hr2d_point){(double)p->x[end], (double)p->y[end]};
}

static int64_t smaller(int64_t a, int64_t b) {
  return a < b ? a : b;
}

static int64_t larger(int64_t a, int64_t b) {
  return a > b ? a : b;
}

static int ranges_meet(const int64_t *a, const int64_t *b) {
  return smaller(a[0], a[1]) <= larger(b[0], b[1]) && smaller(b[0], b[1]) <= larger(a[0], a[1]);
}

/* Closed segments have a common point: their boxes have one, and neither lies on one side of
   the line of the other. */
static int meet(const adv_patch *p, const adv_patch *q) {
  hr2d_point a = point(p, 0), b = point(p, 1), c = point(q, 0), d = point(q, 1);
  return ranges_meet(p->x, q->x) && ranges_meet(p->y, q->y) &&
         hr2d_orientation(a, b, c) * hr2d_orientation(a, b, d) <= 0 &&
         hr2d_orientation(c, d, a) * hr2d_orientation(c, d, b) <= 0;
}

int adv_free(const adv_scene *scene, double ax, double ay, double bx, double by) {
  adv_patch p = {.x = {on_grid(scene, ax), on_grid(scene, bx)},
                 .y = {on_grid(scene, ay), on_grid(scene, by)}};
  for (size_t k = 0; k < scene->count; k++)
    if (meet(&p, &scene->patch[k])) return 0;
  return 1;
}

void adv_mirror(adv_scene *scene, double ax, double ay, double bx, double by) {
  scene->mirror[scene->mirrors++] = (adv_line){{on_grid(scene, ax), on_grid(scene, bx)},
                                               {on_grid(scene, ay), on_grid(scene, by)}};
}

int adv_is_symmetric(const adv_scene *scene) {
  return scene->mirrors > 0 || scene->period[0] || scene->period[1];
}

/* Multiples of 1/64, so that 1 − ρ and sums of emissions are exact. */
void adv_paint(adv_scene *scene, adv_random *r, double max) {
  for (size_t band = 0; band < scene->bands; band++) {
    for (size_t k = 0; k < scene->count; k++) {
      adv_patch *p = &scene->patch[k];
      p->emission[band] = adv_chance(r, 0.6) ? 0 : adv_int(r, 1, 64) / 64.0;
      p->reflectance[band] = adv_chance(r, 0.15) ? 0 : floor(adv_real(r, 0, max) * 64) / 64;
    }
    scene->patch[adv_int(r, 0, (int)scene->count - 1)].emission[band] = 1;
  }
}

void adv_reflect(adv_patch *patch, double reflectance) {
  for (size_t band = 0; band < ADV_BANDS; band++) patch->reflectance[band] = reflectance;
}

void adv_pane(adv_scene *scene, adv_random *r, size_t front, double max) {
  for (size_t band = 0; band < scene->bands; band++) {
    double tau = adv_chance(r, 0.15) ? 0 : floor(adv_real(r, 0, max) * 64) / 64;
    for (size_t side = front; side < front + 2; side++) {
      scene->patch[side].transmittance[band] = tau;
      scene->patch[side].reflectance[band] = floor(adv_real(r, 0, max - tau) * 64) / 64;
    }
  }
}

int adv_is_pane(const adv_scene *scene, size_t patch) {
  for (size_t band = 0; band < scene->bands; band++)
    if (scene->patch[patch].transmittance[band] > 0) return 1;
  return 0;
}

double adv_scattered(const adv_patch *patch, size_t band) {
  return patch->reflectance[band] + patch->transmittance[band];
}

adv_extent adv_extent_of(const adv_scene *scene) {
  adv_extent e = {{INT64_MAX, INT64_MAX}, {INT64_MIN, INT64_MIN}};
  for (size_t k = 0; k < scene->count; k++)
    for (int end = 0; end < 2; end++) {
      const adv_patch *p = &scene->patch[k];
      e.low[0] = smaller(e.low[0], p->x[end]), e.high[0] = larger(e.high[0], p->x[end]);
      e.low[1] = smaller(e.low[1], p->y[end]), e.high[1] = larger(e.high[1], p->y[end]);
    }
  return e;
}

static int64_t magnitude(int64_t x) {
  return x < 0 ? -x : x;
}

int adv_bits(const adv_scene *scene) {
  adv_extent e = adv_extent_of(scene);
  int64_t max = larger(magnitude(scene->period[0]), magnitude(scene->period[1]));
  for (size_t k = 0; k < scene->mirrors; k++)
    for (int end = 0; end < 2; end++)
      max = larger(
          max, larger(magnitude(scene->mirror[k].x[end]), magnitude(scene->mirror[k].y[end])));
  for (size_t k = 0; k < scene->corners; k++)
    max = larger(max, larger(magnitude(scene->border[k][0]), magnitude(scene->border[k][1])));
  for (int axis = 0; axis < 2; axis++) max = larger(max, larger(-e.low[axis], e.high[axis]));
  int bits = 0;
  while (max >> bits) bits++;
  return bits;
}

double adv_length(const adv_scene *scene, size_t patch) {
  const adv_patch *p = &scene->patch[patch];
  return ldexp(hypot((double)(p->x[1] - p->x[0]), (double)(p->y[1] - p->y[0])),
               scene->exponent);
}

void adv_call_original(adv_scene *scene) {
  for (size_t k = 0; k < scene->count; k++) {
    scene->patch[k].source = (int)k;
    scene->patch[k].from = 0;
    scene->patch[k].to = 1;
  }
}

int adv_has_sun(const adv_scene *scene) {
  for (size_t band = 0; band < scene->bands; band++)
    if (scene->sun[band].irradiance > 0) return 1;
  return 0;
}

int adv_has_sky(const adv_scene *scene) {
  return scene->pieces > 0;
}

double adv_outside(const adv_scene *scene, size_t band) {
  double max = fmax(scene->background[band], scene->sun[band].irradiance);
  for (size_t k = 0; k < scene->pieces; k++) max = fmax(max, scene->piece[k].value[band]);
  if (scene->kappa[band] > 0 && !scene->heated) max = fmax(max, scene->hot[band]);
  return max;
}

static hr2d_status set_day(const adv_scene *scene, hr2d_scene *built) {
  hr2d_sun sun[ADV_BANDS];
  hr2d_sky_piece piece[ADV_PIECES];
  double value[ADV_PIECES * ADV_BANDS];
  hr2d_status status = HR2D_OK;
  for (size_t b = 0; b < scene->bands; b++)
    sun[b] = (hr2d_sun){{(double)scene->sun[b].x, (double)scene->sun[b].y},
                        scene->sun[b].irradiance};
  for (size_t k = 0; k < scene->pieces; k++) {
    piece[k] = (hr2d_sky_piece){scene->piece[k].from, scene->piece[k].to};
    for (size_t b = 0; b < scene->bands; b++)
      value[k * scene->bands + b] = scene->piece[k].value[b];
  }
  if (adv_has_sun(scene)) status = hr2d_scene_set_sun(built, sun, scene->bands);
  if (!status && scene->pieces)
    status = hr2d_scene_set_sky(built, piece, scene->pieces, value, scene->bands);
  return status;
}

void adv_fill_gas(adv_scene *scene, adv_random *r, double low, double high, int heated) {
  const int hot = adv_chance(r, 0.7);
  scene->flat = adv_chance(r, 0.3);
  scene->heated = heated;
  for (size_t b = 0; b < scene->bands; b++) {
    scene->kappa[b] = exp(adv_real(r, log(low), log(high)));
    if (b > 0 && adv_chance(r, 0.4)) scene->kappa[b] = adv_chance(r, 0.5) ? 0 : scene->kappa[0];
    scene->hot[b] = hot ? adv_int(r, 1, 64) / 64.0 : 0;
  }
}

void adv_part_gas(adv_scene *scene, adv_random *r, const double box[4]) {
  scene->corners = (size_t)adv_int(r, 3, ADV_CORNERS);
  scene->dark = adv_chance(r, 0.2) ? 0 : exp(adv_real(r, log(0.1), log(10)));
  scene->warm = adv_int(r, 0, 16) / 4.0;
  for (size_t k = 0; k < scene->corners; k++)
    for (int axis = 0; axis < 2; axis++)
      scene->border[k][axis] = on_grid(scene, adv_real(r, box[axis], box[axis + 2]));
}

int adv_has_gas(const adv_scene *scene) {
  for (size_t b = 0; b < scene->bands; b++)
    if (scene->kappa[b] > 0) return 1;
  return 0;
}

void adv_scale_gas(adv_scene *scene, double factor) {
  for (size_t b = 0; b < ADV_BANDS; b++) scene->kappa[b] /= factor;
  if (scene->heated) scene->hot[0] *= factor;
}

static hr2d_point on_scene(const adv_scene *scene, int64_t x, int64_t y) {
  return (hr2d_point){ldexp((double)x, scene->exponent), ldexp((double)y, scene->exponent)};
}

/* The gas within the border, like that around. */
static hr2d_status part_gas(const adv_scene *scene, hr2d_gas gas, hr2d_scene *built) {
  double kappa[ADV_BANDS], hot[ADV_BANDS];
  hr2d_point border[ADV_CORNERS];
  for (size_t b = 0; b < scene->bands; b++) {
    kappa[b] = scene->dark * scene->kappa[b];
    hot[b] = scene->warm * scene->hot[b];
  }
  for (size_t k = 0; k < scene->corners; k++)
    border[k] = on_scene(scene, scene->border[k][0], scene->border[k][1]);
  gas.absorption = kappa;
  gas.emission = hot;
  gas.border = border;
  gas.border_points = scene->corners;
  return hr2d_scene_add_gas(built, &gas, NULL);
}

static hr2d_status set_gas(const adv_scene *scene, hr2d_scene *built) {
  hr2d_gas gas = HR2D_GAS_INIT;
  if (!adv_has_gas(scene)) return HR2D_OK;
  gas.absorption = scene->kappa;
  gas.emission = scene->hot;
  gas.absorption_bands = scene->bands;
  gas.emission_bands = scene->heated ? 0 : scene->bands;
  gas.given = scene->heated ? HR2D_HEAT_FLUX : HR2D_HEAT_NONE;
  gas.value = scene->heated ? scene->hot[0] : 0;
  gas.section = scene->flat ? HR2D_SECTION_FLAT : HR2D_SECTION_LONG;
  const hr2d_status status = hr2d_scene_add_gas(built, &gas, NULL);
  return status || !scene->corners ? status : part_gas(scene, gas, built);
}

static hr2d_status set_symmetry(const adv_scene *scene, hr2d_scene *built) {
  hr2d_status status =
      hr2d_scene_set_period(built, on_scene(scene, scene->period[0], scene->period[1]));
  for (size_t k = 0; k < scene->mirrors && !status; k++) {
    const adv_line *m = &scene->mirror[k];
    status = hr2d_scene_add_mirror(built, (hr2d_segment){on_scene(scene, m->x[0], m->y[0]),
                                                         on_scene(scene, m->x[1], m->y[1])});
  }
  return status;
}

hr2d_status adv_build(const adv_scene *scene, hr2d_scene **built) {
  hr2d_status status = hr2d_scene_create(NULL, built);
  for (size_t k = 0; !status && k < scene->count; k++) {
    const adv_patch *p = &scene->patch[k];
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = on_scene(scene, p->x[0], p->y[0]);
    patch.b = on_scene(scene, p->x[1], p->y[1]);
    patch.emission = p->emission;
    patch.reflectance = p->reflectance;
    patch.emission_bands = patch.reflectance_bands = scene->bands;
    patch.transmittance = p->transmittance;
    patch.transmittance_bands = adv_is_pane(scene, k) ? scene->bands : 0;
    status = hr2d_scene_add(*built, &patch, NULL);
  }
  if (!status) status = hr2d_scene_set_background(*built, scene->background, scene->bands);
  if (!status) status = set_day(scene, *built);
  if (!status) status = set_symmetry(scene, *built);
  if (!status) status = set_gas(scene, *built);
  return status ? status : hr2d_scene_commit(*built);
}
