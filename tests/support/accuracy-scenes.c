/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/accuracy-scenes.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/scenes.h"

#define PI 3.14159265358979323846

static int is_clear(const plan *p, hr2d_segment s) {
  for (size_t k = 0; k < p->walls; k++) {
    const hr2d_segment w = p->wall[k];
    const int across = hr2d_orientation(w.a, w.b, s.a) * hr2d_orientation(w.a, w.b, s.b);
    const int along = hr2d_orientation(s.a, s.b, w.a) * hr2d_orientation(s.a, s.b, w.b);
    if (across <= 0 && along <= 0) return 0;
  }
  return 1;
}

/* Segments anywhere in a box, with one side or two, that do not meet. */
static void draw_open(randoms *r, int size, plan *p) {
  for (int k = 0; k < 4 * size && p->walls < (size_t)size + 2; k++) {
    const hr2d_point a = {random_between(r, -1, 1), random_between(r, -1, 1)};
    const double length = random_power(r, -1, 0.3), angle = random_between(r, 0, 2 * PI);
    const hr2d_point b = {a.x + length * cos(angle), a.y + length * sin(angle)};
    if (is_clear(p, (hr2d_segment){a, b}))
      plan_add(p, a, b, random_below(r, 3) ? HR2D_SIDES_FRONT : HR2D_SIDES_BOTH);
  }
}

/* Two patches at a corner, with an angle of 3° to 177°. */
static void draw_corner(randoms *r, int size, plan *p) {
  const double angle = random_between(r, 3, 177) * PI / 180, length = random_power(r, -1, 1);
  (void)size;
  plan_add(p, (hr2d_point){0, 0}, (hr2d_point){1, 0}, HR2D_SIDES_FRONT);
  plan_add(p, (hr2d_point){length * cos(angle), length * sin(angle)}, (hr2d_point){0, 0},
           HR2D_SIDES_FRONT);
}

/* Two patches that face each other, perhaps in part. */
static void draw_facing(randoms *r, int size, plan *p) {
  const double height = random_power(r, -1.3, 1), shift = random_between(r, -1, 1);
  const double turn = random_between(r, -.9, .9) * height;
  (void)size;
  plan_add(p, (hr2d_point){0, 0}, (hr2d_point){1, 0}, HR2D_SIDES_FRONT);
  plan_add(p, (hr2d_point){1 + shift, height + turn}, (hr2d_point){shift, height},
           HR2D_SIDES_FRONT);
}

/* A floor with walls that stand on it, at any angle to either side. */
static void draw_standing(randoms *r, int size, plan *p) {
  plan_add(p, (hr2d_point){0, 0}, (hr2d_point){8, 0}, HR2D_SIDES_FRONT);
  for (int k = 0; k <= size; k++) {
    const hr2d_point foot = {k, 0};
    const double angle = random_between(r, 10, 170) * PI / 180,
                 length = random_power(r, -.5, 1);
    const hr2d_point top = {k + length * cos(angle), length * sin(angle)};
    const hr2d_point above = {foot.x + 1e-9 * (top.x - foot.x), 1e-9 * top.y};
    plan rest = {p->wall + 1, p->sides + 1, p->walls - 1, 0, 0};
    if (is_clear(&rest, (hr2d_segment){above, top}))
      plan_add(p, foot, top, random_below(r, 3) ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT);
  }
}

static const plan_class own[] = {{"open", draw_open},
                                 {"corner", draw_corner},
                                 {"facing", draw_facing},
                                 {"standing", draw_standing}};
enum { OWN = sizeof own / sizeof *own };

/* Rooms of few walls, from the plans. */
static const char *const rooms[] = {
    "empty",  "star",   "short walls", "squares", "bricks", "grid", "triangles",
    "stairs", "nested", "partitions",  "chords",  "trees",  "comb", "fan"};
enum { ROOMS = sizeof rooms / sizeof *rooms, WALLS = 24 };

static plan_class class_of(randoms *r, int *open) {
  *open = random_below(r, 5) < 2;
  if (*open) return own[random_below(r, OWN)];
  /* Half of them are plain. */
  const int which = random_below(r, 2) ? random_below(r, 3) : random_below(r, ROOMS);
  for (int k = 0; k < plan_class_count; k++)
    if (strcmp(plan_classes[k].name, rooms[which]) == 0) return plan_classes[k];
  ck_abort_msg("no plan is called %s", rooms[which]);
  return own[0];
}

static void draw_shape(randoms *r, accuracy_scene *s) {
  do {
    plan_free(&s->plan);
    const plan_class class = class_of(r, &s->open);
    s->shape = class.name;
    class.draw(r, 1 + random_below(r, 4), &s->plan);
  } while (s->plan.walls < 2 || s->plan.walls > WALLS);
}

/* One reflectance for all walls, one for each, or none for some and the most for others. */
static void draw_light(randoms *r, accuracy_scene *s, double max) {
  const int mood = random_below(r, 4), dim = random_below(r, 4);
  s->bands = random_below(r, 3) ? 1 : 1 + (size_t)random_below(r, ACCURACY_BANDS);
  for (size_t b = 0; b < s->bands; b++) {
    const double common = random_below(r, 2) ? max : max * random_unit(r);
    for (size_t k = 0; k < s->plan.walls; k++) {
      const double each = mood == 0 ? common : max * random_unit(r);
      const int kind = mood == 2 ? random_below(r, 3) : 2;
      s->reflectance[k][b] = kind == 0 ? 0 : kind == 1 && k > 0 ? max : each;
      s->emission[k][b] = dim && random_below(r, 3) ? 0 : random_unit(r);
    }
    s->emission[0][b] = random_between(r, .1, 1);
    s->background[b] = 0;
  }
  if (random_below(r, 3) > 0) return;
  for (size_t b = 0; b < s->bands; b++) s->background[b] = random_unit(r);
}

accuracy_scene accuracy_draw(uint64_t seed, int k, double max) {
  accuracy_scene s = {.bands = 1};
  randoms r = randoms_stream(seed, k);
  draw_shape(&r, &s);
  s.emission = calloc(s.plan.walls, sizeof *s.emission);
  s.reflectance = calloc(s.plan.walls, sizeof *s.reflectance);
  ck_assert(s.emission != NULL && s.reflectance != NULL);
  draw_light(&r, &s, max);
  return s;
}

void accuracy_free(accuracy_scene *s) {
  plan_free(&s->plan);
  free(s->emission);
  free(s->reflectance);
}

void accuracy_set_isothermal(accuracy_scene *s) {
  for (size_t k = 0; k < s->plan.walls; k++) {
    if (s->open) s->plan.sides[k] = HR2D_SIDES_BOTH;
    for (size_t b = 0; b < s->bands; b++) s->emission[k][b] = 1 - s->reflectance[k][b];
  }
  for (size_t b = 0; b < s->bands; b++) s->background[b] = 1;
}

void accuracy_set_uniform(accuracy_scene *s) {
  for (size_t k = 0; k < s->plan.walls; k++) {
    for (size_t b = 1; b < s->bands; b++)
      s->reflectance[k][0] = fmax(s->reflectance[k][0], s->reflectance[k][b]);
    s->emission[k][0] = 1;
  }
  s->background[0] = 0;
  s->bands = 1;
}

hr2d_scene *accuracy_make(const accuracy_scene *s) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < s->plan.walls; k++) {
    const hr2d_patch patch = {.a = s->plan.wall[k].a,
                              .b = s->plan.wall[k].b,
                              .emission = s->emission[k],
                              .emission_bands = s->bands,
                              .reflectance = s->reflectance[k],
                              .reflectance_bands = s->bands,
                              .sides = s->plan.sides[k]};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_set_background(scene, s->background, s->bands), HR2D_OK);
  ck_assert_msg(hr2d_scene_commit(scene) == HR2D_OK, "%s: %s", s->shape,
                hr2d_scene_message(scene));
  return scene;
}

static void print_bands(FILE *out, const char *name, const double *value, size_t bands) {
  fprintf(out, "\"%s\": [", name);
  for (size_t b = 0; b < bands; b++) fprintf(out, "%s%.17g", b ? ", " : "", value[b]);
  fprintf(out, "]");
}

void accuracy_print(FILE *out, const accuracy_scene *s) {
  fprintf(out, "{\"type\": \"FeatureCollection\", \"hr2d\": {");
  print_bands(out, "background", s->background, s->bands);
  fprintf(out, "}, \"features\": [");
  for (size_t k = 0; k < s->plan.walls; k++) {
    const hr2d_segment w = s->plan.wall[k];
    fprintf(out, "%s\n{\"type\": \"Feature\", \"properties\": {\"sides\": \"%s\", ",
            k ? "," : "", s->plan.sides[k] == HR2D_SIDES_BOTH ? "both" : "front");
    print_bands(out, "emission", s->emission[k], s->bands);
    fprintf(out, ", ");
    print_bands(out, "reflectance", s->reflectance[k], s->bands);
    fprintf(out,
            "}, \"geometry\": {\"type\": \"LineString\", \"coordinates\": [[%.17g, %.17g], "
            "[%.17g, %.17g]]}}",
            w.a.x, w.a.y, w.b.x, w.b.y);
  }
  fprintf(out, "]}\n");
}

hr2d_scene *accuracy_enfilade(int count, double last) {
  const double light = 1, rho = .5;
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < count; k++) {
    const double door = .25 + .1 * (k % 3);
    const hr2d_segment wall[] = {{{k, 0}, {k + 1, 0}},
                                 {{k + 1, 1}, {k, 1}},
                                 {{k, k ? 0 : 1}, {k, k ? door : 0}},
                                 {{k, door + .1}, {k, 1}}};
    for (int w = 0; w < (k ? 4 : 3); w++) {
      const hr2d_patch patch = {.a = wall[w].a,
                                .b = wall[w].b,
                                .emission = &light,
                                .emission_bands = k == 0 && w == 1,
                                .reflectance = &rho,
                                .reflectance_bands = 1,
                                .sides = w < 2 || k == 0 ? HR2D_SIDES_FRONT : HR2D_SIDES_BOTH};
      ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
    }
  }
  const hr2d_patch end = {
      .a = {count, 0}, .b = {count, 1}, .reflectance = &last, .reflectance_bands = 1};
  ck_assert_int_eq(hr2d_scene_add(scene, &end, NULL), HR2D_OK);
  test_commit(scene);
  return scene;
}
