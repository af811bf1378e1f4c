/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Coordinates of walls are multiples of 1/64. Where walls meet or stand on others, along an
   axis, they do so without a rounding. */
#include "support/shadow-scenes.h"

#include <math.h>

#include "support/support.h"

#define PI 3.14159265358979323846

typedef struct material {
  double emission[2], reflectance[2];
} material;

typedef struct draft {
  hr2d_scene *scene;
  randoms r;
  size_t bands;
} draft;

static const material black = {{0, 0}, {0, 0}};

static double on_grid(draft *d, double low, double high) {
  return round(64 * random_between(&d->r, low, high)) / 64;
}

/* A grey that reflects up to a part of the light, or nothing at all. */
static material grey(draft *d, double max) {
  material m = black;
  for (int b = 0; b < 2; b++)
    m.reflectance[b] = random_unit(&d->r) < 0.15 ? 0 : random_between(&d->r, 0.1, max);
  return m;
}

static material lamp(draft *d) {
  return (material){{random_between(&d->r, 0.2, 2), random_between(&d->r, 0, 1)}, {0, 0}};
}

static void add(draft *d, double ax, double ay, double bx, double by, material m,
                hr2d_sides sides) {
  const hr2d_patch patch = {.a = {ax, ay},
                            .b = {bx, by},
                            .emission = m.emission,
                            .emission_bands = d->bands,
                            .reflectance = m.reflectance,
                            .reflectance_bands = d->bands,
                            .sides = sides};
  ck_assert_msg(hr2d_scene_add(d->scene, &patch, NULL) == HR2D_OK, "%s",
                hr2d_scene_message(d->scene));
}

/* A room with a lamp in its ceiling. */
static void add_room(draft *d, double w, double h, material floor, material walls,
                     material ceiling) {
  const double from = on_grid(d, 0.1 * w, 0.5 * w), to = on_grid(d, 0.6 * w, 0.9 * w);
  add(d, 0, 0, w, 0, floor, HR2D_SIDES_FRONT);
  add(d, w, 0, w, h, walls, HR2D_SIDES_FRONT);
  add(d, w, h, to, h, ceiling, HR2D_SIDES_FRONT);
  add(d, to, h, from, h, lamp(d), HR2D_SIDES_FRONT);
  add(d, from, h, 0, h, ceiling, HR2D_SIDES_FRONT);
  add(d, 0, h, 0, 0, walls, HR2D_SIDES_FRONT);
}

static void add_table(draft *d, double w, double h, material top) {
  const double y = on_grid(d, 0.2 * h, 0.5 * h), x = on_grid(d, 0.1 * w, 0.4 * w);
  add(d, x, y, x + on_grid(d, 0.1 * w, 0.45 * w), y, top, HR2D_SIDES_BOTH);
}

/* A slanted screen in the air, away from walls and tables. */
static void add_screen(draft *d, double w, double h, material m, hr2d_sides sides) {
  const double angle = random_between(&d->r, 0, 2 * PI);
  const double half = random_between(&d->r, 0.02, 0.15) * fmin(w, h);
  const double x = random_between(&d->r, 0.3, 0.7) * w;
  const double y = random_between(&d->r, 0.7, 0.8) * h;
  add(d, x - half * cos(angle), y - half * sin(angle), x + half * cos(angle),
      y + half * sin(angle), m, sides);
}

static void black_table(draft *d) {
  const double w = on_grid(d, 2, 6), h = on_grid(d, 2, 4);
  add_room(d, w, h, black, black, black);
  add_table(d, w, h, black);
}

static void solar_panels(draft *d) {
  const double background[2] = {1, 0.5}, half = on_grid(d, 20, 1000);
  const int rows = 2 + random_below(&d->r, 4);
  const double pitch = random_between(&d->r, 2.5, 5), tilt = random_between(&d->r, 0.2, 1.2);
  const double low = random_between(&d->r, 0.1, 1), length = random_between(&d->r, 1, 2);
  material ground = black;
  for (int b = 0; b < 2; b++) ground.reflectance[b] = random_between(&d->r, 0.1, 0.6);
  add(d, -half, 0, half, 0, ground, HR2D_SIDES_FRONT);
  for (int k = 0; k < rows; k++) {
    const double x = pitch * (k - 0.5 * rows);
    add(d, x, low, x + length * cos(tilt), low + length * sin(tilt), black, HR2D_SIDES_BOTH);
  }
  ck_assert_int_eq(hr2d_scene_set_background(d->scene, background, d->bands), HR2D_OK);
}

/* A wall that stands on the floor between a black side of the room and a lit one. */
static void standing_wall(draft *d) {
  const double w = on_grid(d, 3, 5), h = on_grid(d, 2, 3), x = on_grid(d, 0.3 * w, 0.7 * w);
  add_room(d, w, h, grey(d, 0.8), black, black);
  add(d, x, 0, x, on_grid(d, 0.2 * h, 0.6 * h), random_unit(&d->r) < 0.5 ? black : grey(d, 0.5),
      HR2D_SIDES_BOTH);
}

static void black_screens(draft *d) {
  const double w = on_grid(d, 2, 6), h = on_grid(d, 2, 4);
  add_room(d, w, h, black, lamp(d), black);
  add_table(d, w, h, black);
  add_screen(d, w, h, lamp(d), HR2D_SIDES_BOTH);
}

static void bright_floor(draft *d) {
  const double w = on_grid(d, 2, 6), h = on_grid(d, 2, 4);
  add_room(d, w, h, grey(d, 0.9), black, black);
  add_table(d, w, h, black);
  add_screen(d, w, h, black, HR2D_SIDES_BOTH);
}

/* Floor and ceiling face each other between black walls. */
static void two_mirrors(draft *d) {
  const double w = on_grid(d, 2, 6), h = on_grid(d, 1, 3);
  add_room(d, w, h, grey(d, 0.9), black, grey(d, 0.8));
  add_table(d, w, h, random_unit(&d->r) < 0.5 ? black : grey(d, 0.5));
}

/* A street between houses of which only the fronts are given. */
static void street(draft *d) {
  const double background[2] = {1, 0.25}, w = on_grid(d, 1, 4);
  const double left = on_grid(d, 1, 4), right = on_grid(d, 1, 4);
  add(d, 0, 0, w, 0, grey(d, 0.5), HR2D_SIDES_FRONT);
  add(d, w, 0, w, right, black, HR2D_SIDES_FRONT);
  add(d, w, right, w + 2, right, grey(d, 0.5), HR2D_SIDES_FRONT);
  add(d, -2, left, 0, left, black, HR2D_SIDES_FRONT);
  add(d, 0, left, 0, 0, random_unit(&d->r) < 0.5 ? black : grey(d, 0.5), HR2D_SIDES_FRONT);
  add(d, 0.25 * w, 0.75, 0.625 * w, 0.875, black, HR2D_SIDES_BOTH);
  ck_assert_int_eq(hr2d_scene_set_background(d->scene, background, d->bands), HR2D_OK);
}

/* A screen whose back is nothing but black. */
static void one_sided(draft *d) {
  const double w = on_grid(d, 2, 5), h = on_grid(d, 2, 4);
  add_room(d, w, h, grey(d, 0.7), black, black);
  add_screen(d, w, h, grey(d, 0.7), HR2D_SIDES_FRONT);
  add_table(d, w, h, lamp(d));
}

/* Two rooms with a door; the lamp is in one of them. */
static void door(draft *d) {
  const double w = on_grid(d, 2, 4), h = on_grid(d, 2, 3), x = on_grid(d, 1.2 * w, 1.6 * w);
  const material floor = grey(d, 0.8);
  add(d, 0, 0, 2 * w, 0, floor, HR2D_SIDES_FRONT);
  add(d, 2 * w, 0, 2 * w, h, grey(d, 0.5), HR2D_SIDES_FRONT);
  add(d, 2 * w, h, 0, h, black, HR2D_SIDES_FRONT);
  add(d, 0, h, 0, 0, lamp(d), HR2D_SIDES_FRONT);
  add(d, x, h, x, on_grid(d, 0.4 * h, 0.7 * h), black, HR2D_SIDES_BOTH);
  add_table(d, w, h, black);
}

/* All walls reflect a little, and in two bands. */
static void furnished(draft *d) {
  const double w = on_grid(d, 2, 5), h = on_grid(d, 2, 4);
  add_room(d, w, h, grey(d, 0.8), grey(d, 0.6), black);
  add_table(d, w, h, black);
}

/* Panels just above ground that reflects much. */
static void low_panels(draft *d) {
  const double background[2] = {1, 0.5}, low = random_power(&d->r, -3, -1);
  material ground = black;
  for (int b = 0; b < 2; b++) ground.reflectance[b] = random_between(&d->r, 0.5, 0.8);
  add(d, -8, 0, 8, 0, ground, HR2D_SIDES_FRONT);
  for (int k = 0; k < 3; k++)
    add(d, 3 * k - 4, low, 3 * k - 2.5, low + random_between(&d->r, 0.3, 1),
        k == 1 ? grey(d, 0.5) : black, HR2D_SIDES_BOTH);
  ck_assert_int_eq(hr2d_scene_set_background(d->scene, background, d->bands), HR2D_OK);
}

/* Screens in the air without a room, each in a cell of its own. */
static void free_screens(draft *d) {
  const double background[2] = {random_unit(&d->r), 1};
  for (int k = 0; k < 6; k++) {
    const double angle = random_between(&d->r, 0, PI), half = random_between(&d->r, 0.1, 0.49);
    const double x = k % 3, y = k / 3;
    material m = random_unit(&d->r) < 0.4 ? black : grey(d, 0.9);
    if (k == 1) m.emission[0] = 1;
    add(d, x - half * cos(angle), y - half * sin(angle), x + half * cos(angle),
        y + half * sin(angle), m,
        random_unit(&d->r) < 0.8 ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT);
  }
  ck_assert_int_eq(hr2d_scene_set_background(d->scene, background, d->bands), HR2D_OK);
}

/* A box in a room, of which only the outside is given. */
static void box(draft *d) {
  const double w = on_grid(d, 3, 5), h = on_grid(d, 2, 4);
  const double x = on_grid(d, 0.2 * w, 0.5 * w), y = on_grid(d, 0.2 * h, 0.4 * h);
  const double size = on_grid(d, 0.1, 0.9);
  const material side = grey(d, 0.6);
  add_room(d, w, h, grey(d, 0.7), black, grey(d, 0.5));
  add(d, x, y, x, y + size, side, HR2D_SIDES_FRONT);
  add(d, x, y + size, x + size, y + size, black, HR2D_SIDES_FRONT);
  add(d, x + size, y + size, x + size, y, side, HR2D_SIDES_FRONT);
  add(d, x + size, y, x, y, grey(d, 0.6), HR2D_SIDES_FRONT);
}

/* A room around a corner; both of its lamps are walls. */
static void around_a_corner(draft *d) {
  const double w = on_grid(d, 3, 5), h = on_grid(d, 3, 4);
  const double x = on_grid(d, 1, 2), y = on_grid(d, 1, 2);
  add(d, 0, 0, w, 0, grey(d, 0.7), HR2D_SIDES_FRONT);
  add(d, w, 0, w, y, lamp(d), HR2D_SIDES_FRONT);
  add(d, w, y, x, y, random_unit(&d->r) < 0.5 ? black : grey(d, 0.6), HR2D_SIDES_FRONT);
  add(d, x, y, x, h, black, HR2D_SIDES_FRONT);
  add(d, x, h, 0, h, lamp(d), HR2D_SIDES_FRONT);
  add(d, 0, h, 0, 0, black, HR2D_SIDES_FRONT);
}

/* A screen that reflects hangs over a skirting, a short patch beside a corner. */
static void skirting(draft *d) {
  const double w = on_grid(d, 2, 4), h = on_grid(d, 2, 3),
               low = ldexp(1, -random_below(&d->r, 8));
  add(d, 0, 0, w, 0, grey(d, 0.6), HR2D_SIDES_FRONT);
  add(d, w, 0, w, low, random_unit(&d->r) < 0.5 ? black : lamp(d), HR2D_SIDES_FRONT);
  add(d, w, low, w, h, black, HR2D_SIDES_FRONT);
  add(d, w, h, 0, h, lamp(d), HR2D_SIDES_FRONT);
  add(d, 0, h, 0, 0, black, HR2D_SIDES_FRONT);
  add_screen(d, w, h, grey(d, 0.6), HR2D_SIDES_BOTH);
}

static const struct {
  const char *name;
  void (*draw)(draft *d);
} kind[SHADOW_KINDS] = {
    {"black table", black_table},
    {"solar panels", solar_panels},
    {"standing wall", standing_wall},
    {"black screens", black_screens},
    {"bright floor", bright_floor},
    {"two mirrors", two_mirrors},
    {"street", street},
    {"one-sided screen", one_sided},
    {"door", door},
    {"low panels", low_panels},
    {"free screens", free_screens},
    {"box", box},
    {"around a corner", around_a_corner},
    {"skirting", skirting},
    {"furnished", furnished},
};

hr2d_scene *shadow_scene_draw(unsigned long seed, int k) {
  draft d = {test_new_scene(NULL), randoms_stream(seed, k), 1 + (size_t)(k / 2 % 2)};
  kind[k % SHADOW_KINDS].draw(&d);
  test_commit(d.scene);
  return d.scene;
}

const char *shadow_scene_kind(int k) {
  return kind[k % SHADOW_KINDS].name;
}
