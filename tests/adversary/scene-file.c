/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes as GeoJSON files. */
#include <math.h>
#include <stdio.h>

#include "adversary/scene.h"

static void write_values(FILE *file, const char *name, const double *value, size_t count) {
  fprintf(file, "\"%s\": [", name);
  for (size_t k = 0; k < count; k++) fprintf(file, "%s%.17g", k ? ", " : "", value[k]);
  fprintf(file, "]");
}

static void write_line(FILE *file, const adv_scene *scene, const int64_t *x, const int64_t *y) {
  fprintf(file, "\"geometry\": {\"type\": \"LineString\", \"coordinates\": [");
  for (int end = 0; end < 2; end++)
    fprintf(file, "%s[%.17g, %.17g]", end ? ", " : "", ldexp((double)x[end], scene->exponent),
            ldexp((double)y[end], scene->exponent));
  fprintf(file, "]}}");
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
  if (adv_is_pane(scene, k)) {
    fprintf(file, ", ");
    write_values(file, "transmittance", p->transmittance, scene->bands);
  }
  fprintf(file, "}, ");
  write_line(file, scene, p->x, p->y);
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

static void write_mirror(FILE *file, const adv_scene *scene, size_t k) {
  fprintf(file, ",\n{\"type\": \"Feature\", \"properties\": {\"sides\": \"mirror\"}, ");
  write_line(file, scene, scene->mirror[k].x, scene->mirror[k].y);
}

static void write_period(FILE *file, const adv_scene *scene) {
  if (scene->period[0] || scene->period[1])
    fprintf(file, ", \"period\": [%.17g, %.17g]",
            ldexp((double)scene->period[0], scene->exponent),
            ldexp((double)scene->period[1], scene->exponent));
}

static void write_gas(FILE *file, const adv_scene *scene) {
  if (!adv_has_gas(scene)) return;
  fprintf(file, ", \"medium\": {\"section\": \"%s\", ", scene->flat ? "flat" : "long");
  write_values(file, "absorption", scene->kappa, scene->bands);
  fprintf(file, ", ");
  if (scene->heated)
    fprintf(file, "\"flux\": %.17g", scene->hot[0]);
  else
    write_values(file, "emission", scene->hot, scene->bands);
  fprintf(file, "}");
}

static void write_border(FILE *file, const adv_scene *scene) {
  double kappa[ADV_BANDS], hot[ADV_BANDS];
  for (size_t b = 0; b < scene->bands; b++) {
    kappa[b] = scene->dark * scene->kappa[b];
    hot[b] = scene->warm * scene->hot[b];
  }
  fprintf(file, ",\n{\"type\": \"Feature\", \"properties\": {\"medium\": {");
  write_values(file, "absorption", kappa, scene->bands);
  fprintf(file, ", ");
  write_values(file, "emission", hot, scene->bands);
  fprintf(file, "}}, \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [[");
  for (size_t k = 0; k <= scene->corners; k++) {
    const int64_t *at = scene->border[k % scene->corners];
    fprintf(file, "%s[%.17g, %.17g]", k ? ", " : "", ldexp((double)at[0], scene->exponent),
            ldexp((double)at[1], scene->exponent));
  }
  fprintf(file, "]]}}");
}

int adv_write(const adv_scene *scene, const char *path) {
  FILE *file = fopen(path, "w");
  if (!file) return 0;
  fprintf(file, "{\"type\": \"FeatureCollection\", \"hr2d\": {");
  write_values(file, "background", scene->background, scene->bands);
  write_day(file, scene);
  write_period(file, scene);
  write_gas(file, scene);
  fprintf(file, "}, \"features\": [");
  for (size_t k = 0; k < scene->count; k++) write_patch(file, scene, k);
  for (size_t k = 0; k < scene->mirrors; k++) write_mirror(file, scene, k);
  if (scene->corners) write_border(file, scene);
  fprintf(file, "\n]}\n");
  return !fclose(file);
}
