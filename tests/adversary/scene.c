/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes on a grid. */
#include "adversary/scene.h"

#include <math.h>
#include <stdio.h>
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

/* Multiples of 1/64, so that 1 − ρ and sums of emissions are exact. */
void adv_paint(adv_scene *scene, adv_random *r, double most) {
  for (size_t band = 0; band < scene->bands; band++) {
    for (size_t k = 0; k < scene->count; k++) {
      adv_patch *p = &scene->patch[k];
      p->emission[band] = adv_chance(r, 0.6) ? 0 : adv_int(r, 1, 64) / 64.0;
      p->reflectance[band] = adv_chance(r, 0.15) ? 0 : floor(adv_real(r, 0, most) * 64) / 64;
    }
    scene->patch[adv_int(r, 0, (int)scene->count - 1)].emission[band] = 1;
  }
}

void adv_reflect(adv_patch *patch, double reflectance) {
  for (size_t band = 0; band < ADV_BANDS; band++) patch->reflectance[band] = reflectance;
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

int adv_bits(const adv_scene *scene) {
  adv_extent e = adv_extent_of(scene);
  int64_t most = 0;
  for (int axis = 0; axis < 2; axis++) most = larger(most, larger(-e.low[axis], e.high[axis]));
  int bits = 0;
  while (most >> bits) bits++;
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
  double most = fmax(scene->background[band], scene->sun[band].irradiance);
  for (size_t k = 0; k < scene->pieces; k++) most = fmax(most, scene->piece[k].value[band]);
  return most;
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

hr2d_status adv_build(const adv_scene *scene, hr2d_scene **built) {
  hr2d_status status = hr2d_scene_create(NULL, built);
  for (size_t k = 0; !status && k < scene->count; k++) {
    const adv_patch *p = &scene->patch[k];
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a.x = ldexp((double)p->x[0], scene->exponent);
    patch.a.y = ldexp((double)p->y[0], scene->exponent);
    patch.b.x = ldexp((double)p->x[1], scene->exponent);
    patch.b.y = ldexp((double)p->y[1], scene->exponent);
    patch.emission = p->emission;
    patch.reflectance = p->reflectance;
    patch.emission_bands = patch.reflectance_bands = scene->bands;
    status = hr2d_scene_add(*built, &patch, NULL);
  }
  if (!status) status = hr2d_scene_set_background(*built, scene->background, scene->bands);
  if (!status) status = set_day(scene, *built);
  return status ? status : hr2d_scene_commit(*built);
}

static void write_values(FILE *file, const char *name, const double *value, size_t count) {
  fprintf(file, "\"%s\": [", name);
  for (size_t k = 0; k < count; k++) fprintf(file, "%s%.17g", k ? ", " : "", value[k]);
  fprintf(file, "]");
}

static void write_patch(FILE *file, const adv_scene *scene, size_t k) {
  const adv_patch *p = &scene->patch[k];
  fprintf(file, "%s\n{\"type\": \"Feature\", \"properties\": {\"name\": \"", k ? "," : "");
  if (p->source < 0)
    fprintf(file, "%zu added\", ", k);
  else if (p->from == 0 && p->to == 1)
    fprintf(file, "p%d\", ", p->source);
  else
    fprintf(file, "p%d from %.17g to %.17g\", ", p->source, p->from, p->to);
  write_values(file, "emission", p->emission, scene->bands);
  fprintf(file, ", ");
  write_values(file, "reflectance", p->reflectance, scene->bands);
  fprintf(file, "}, \"geometry\": {\"type\": \"LineString\", \"coordinates\": [");
  for (int end = 0; end < 2; end++)
    fprintf(file, "%s[%.17g, %.17g]", end ? ", " : "",
            ldexp((double)p->x[end], scene->exponent),
            ldexp((double)p->y[end], scene->exponent));
  fprintf(file, "]}}");
}

static void write_day(FILE *file, const adv_scene *scene) {
  if (adv_has_sun(scene)) {
    double irradiance[ADV_BANDS];
    fprintf(file, ", \"sun\": {\"direction\": [");
    for (size_t b = 0; b < scene->bands; b++) {
      irradiance[b] = scene->sun[b].irradiance;
      fprintf(file, "%s[%lld, %lld]", b ? ", " : "", (long long)scene->sun[b].x,
              (long long)scene->sun[b].y);
    }
    fprintf(file, "], ");
    write_values(file, "irradiance", irradiance, scene->bands);
    fprintf(file, "}");
  }
  for (size_t k = 0; k < scene->pieces; k++) {
    const adv_piece *p = &scene->piece[k];
    fprintf(file, "%s[%.17g, %.17g, [", k ? ", " : ", \"sky\": [", p->from, p->to);
    for (size_t b = 0; b < scene->bands; b++)
      fprintf(file, "%s%.17g", b ? ", " : "", p->value[b]);
    fprintf(file, k + 1 == scene->pieces ? "]]]" : "]]");
  }
}

int adv_write(const adv_scene *scene, const char *path) {
  FILE *file = fopen(path, "w");
  if (!file) return 0;
  fprintf(file, "{\"type\": \"FeatureCollection\", \"hr2d\": {");
  write_values(file, "background", scene->background, scene->bands);
  write_day(file, scene);
  fprintf(file, "}, \"features\": [");
  for (size_t k = 0; k < scene->count; k++) write_patch(file, scene, k);
  fprintf(file, "\n]}\n");
  return !fclose(file);
}
