/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d info`: the patches of a scene and the effects that it calls for. */
#include <math.h>
#include <stdio.h>

#include "cli/commands.h"
#include "cli/scene.h"
#include "cli/warnings.h"
#include "output/json.h"
#include "output/provenance.h"

typedef struct summary {
  double length;                      /* of all patches */
  double low[2], high[2];             /* corners of the bounding box */
  double reflectance[2], emission[2]; /* smallest and largest */
} summary;

static void widen(double range[2], double x) {
  range[0] = fmin(range[0], x);
  range[1] = fmax(range[1], x);
}

static void enclose(summary *s, hr2d_point p) {
  s->low[0] = fmin(s->low[0], p.x);
  s->low[1] = fmin(s->low[1], p.y);
  s->high[0] = fmax(s->high[0], p.x);
  s->high[1] = fmax(s->high[1], p.y);
}

static summary summarise(const hr2d_scene *scene) {
  summary s = {0,
               {INFINITY, INFINITY},
               {-INFINITY, -INFINITY},
               {INFINITY, -INFINITY},
               {INFINITY, -INFINITY}};
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const hr2d_segment segment = hr2d_scene_segment(scene, k);
    s.length += hr2d_scene_length(scene, k);
    enclose(&s, segment.a);
    enclose(&s, segment.b);
    for (size_t b = 0; b < hr2d_scene_bands(scene); b++) {
      widen(s.reflectance, hr2d_scene_reflectance(scene, k, b));
      widen(s.emission, hr2d_scene_emission(scene, k, b));
    }
  }
  return s;
}

static void print_range(const char *title, const double range[2]) {
  if (range[0] < range[1])
    printf("%-14s%.6g to %.6g\n", title, range[0], range[1]);
  else
    printf("%-14s%.6g\n", title, range[0]);
}

static void print_background(const hr2d_scene *scene) {
  double max = 0;
  for (size_t b = 0; b < hr2d_scene_bands(scene); b++)
    max = fmax(max, hr2d_scene_background(scene, b));
  if (!(max > 0)) return;
  printf("background   ");
  for (size_t b = 0; b < hr2d_scene_bands(scene); b++)
    printf(" %.6g", hr2d_scene_background(scene, b));
  puts("");
}

/* κ of all bands. */
static void print_one_gas(const hr2d_scene *scene, size_t gas) {
  double least = HUGE_VAL, most = 0;
  for (size_t b = 0; b < hr2d_scene_bands(scene); b++) {
    least = fmin(least, hr2d_scene_absorption(scene, gas, b));
    most = fmax(most, hr2d_scene_absorption(scene, gas, b));
  }
  char title[32] = "gas";
  if (hr2d_scene_gases(scene) > 1) snprintf(title, sizeof title, "gas %zu", gas);
  if (least < most)
    printf("%-13s absorbs %.6g to %.6g per length\n", title, least, most);
  else
    printf("%-13s absorbs %.6g per length\n", title, most);
}

static void print_gas(const hr2d_scene *scene) {
  for (size_t k = 0; k < hr2d_scene_gases(scene); k++) print_one_gas(scene, k);
}

static void print_symmetry(const hr2d_scene *scene) {
  const hr2d_point d = hr2d_scene_period(scene);
  for (size_t k = 0; k < hr2d_scene_mirrors(scene); k++) {
    const hr2d_segment s = hr2d_scene_mirror(scene, k);
    printf("mirror        (%.6g, %.6g) to (%.6g, %.6g)\n", s.a.x, s.a.y, s.b.x, s.b.y);
  }
  if (d.x != 0 || d.y != 0) printf("period        (%.6g, %.6g)\n", d.x, d.y);
  if (hr2d_scene_images(scene) == 1) return;
  printf("images        %zu of each patch", hr2d_scene_images(scene));
  if (hr2d_scene_cut_off(scene) > 0)
    printf(", and a part of up to %.2g of all directions beyond", hr2d_scene_cut_off(scene));
  puts("");
}

static void print_summary(const hr2d_scene *scene, const summary *s) {
  printf("patches       %zu\n", hr2d_scene_patches(scene));
  printf("total length  %.6g\n", s->length);
  printf("bands         %zu\n", hr2d_scene_bands(scene));
  printf("bounding box  (%.6g, %.6g) to (%.6g, %.6g)\n", s->low[0], s->low[1], s->high[0],
         s->high[1]);
  print_range("reflectance", s->reflectance);
  print_range("emission", s->emission);
  print_background(scene);
  print_gas(scene);
  print_symmetry(scene);
  printf("effects\n");
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) {
    const char *why = "";
    const int on = hr2d_scene_effect(scene, (hr2d_effect)e, &why);
    printf("  %-16s %-3s  %s\n", hr2d_effect_name((hr2d_effect)e), on ? "on" : "off", why);
  }
}

static json_t *bands(const hr2d_scene *scene, size_t patch,
                     double (*get)(const hr2d_scene *, size_t, size_t)) {
  json_t *array = json_array();
  for (size_t b = 0; b < hr2d_scene_bands(scene); b++)
    json_push(&array, json_number(get(scene, patch, b)));
  return array;
}

static json_t *patch_entry(const hr2d_scene *scene, size_t k) {
  const hr2d_segment s = hr2d_scene_segment(scene, k);
  json_t *patch = json_patch(scene, k);
  json_put(&patch, "a", json_numbers((double[]){s.a.x, s.a.y}, 2));
  json_put(&patch, "b", json_numbers((double[]){s.b.x, s.b.y}, 2));
  json_put(&patch, "emission", bands(scene, k, hr2d_scene_emission));
  json_put(&patch, "reflectance", bands(scene, k, hr2d_scene_reflectance));
  if (hr2d_scene_other_side(scene, k) != k)
    json_put(&patch, "transmittance", bands(scene, k, hr2d_scene_transmittance));
  return patch;
}

/* Nothing is said of a scene without mirrors and period. */
static void put_symmetry(json_t **root, const hr2d_scene *scene) {
  const hr2d_point d = hr2d_scene_period(scene);
  json_t *mirrors = json_array();
  for (size_t k = 0; k < hr2d_scene_mirrors(scene); k++) {
    const hr2d_segment s = hr2d_scene_mirror(scene, k);
    json_push(&mirrors, json_numbers((double[]){s.a.x, s.a.y, s.b.x, s.b.y}, 4));
  }
  if (hr2d_scene_images(scene) == 1) {
    json_decref(mirrors);
    return;
  }
  json_put(root, "mirrors", mirrors);
  if (d.x != 0 || d.y != 0) json_put(root, "period", json_numbers((double[]){d.x, d.y}, 2));
  json_put(root, "images", json_count(hr2d_scene_images(scene)));
  json_put(root, "cut_off", json_number(hr2d_scene_cut_off(scene)));
}

static json_t *document(const options *o, const hr2d_scene *scene, size_t cuts,
                        const summary *s, const warnings *w) {
  json_t *patches = json_array(), *background = json_array(), *reasons = json_object(),
         *root = json_object();
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    json_push(&patches, patch_entry(scene, k));
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) {
    const char *why = "";
    hr2d_scene_effect(scene, (hr2d_effect)e, &why);
    json_put(&reasons, hr2d_effect_name((hr2d_effect)e), json_text(why));
  }
  json_put(&root, "scene", json_text(o->scene));
  json_put(&root, "provenance", provenance_json());
  json_put(&root, "cuts", json_count(cuts));
  json_put(&root, "patches", patches);
  json_put(&root, "length", json_number(s->length));
  json_put(&root, "bands", json_count(hr2d_scene_bands(scene)));
  json_put(&root, "bounding_box",
           json_numbers((double[]){s->low[0], s->low[1], s->high[0], s->high[1]}, 4));
  json_put(&root, "reflectance", json_numbers(s->reflectance, 2));
  json_put(&root, "emission", json_numbers(s->emission, 2));
  for (size_t b = 0; b < hr2d_scene_bands(scene); b++)
    json_push(&background, json_number(hr2d_scene_background(scene, b)));
  json_put(&root, "background", background);
  put_symmetry(&root, scene);
  json_put(&root, "effects", json_effects(scene));
  json_put(&root, "reasons", reasons);
  json_put(&root, "warnings", json_incref(w->list));
  json_put(&root, "status", json_text("ok"));
  return root;
}

int info_command(const options *o) {
  hr2d_scene *scene = NULL;
  size_t cuts = 0;
  int status = scene_load(o, o->force, &scene, &cuts);
  if (status) return status;
  const summary s = summarise(scene);
  warnings w;
  status = warnings_find(o, scene, 0, &w);
  if (options_want_table(o)) {
    scene_print(o, 14, cuts);
    print_summary(scene, &s);
  }
  if (o->json) {
    const int writing = json_write(document(o, scene, cuts, &s, &w), o->json);
    if (!status) status = writing;
  }
  warnings_release(&w);
  hr2d_scene_destroy(scene);
  return status;
}
