/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Families of small scenes. */
#include "adversary/families.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Directions of suns are integers of this size: steps of about a second of arc. */
#define SUN 1e5

/* Reads one gene after the other. */
typedef const double *genes;

static double real(genes *g, double low, double high) {
  return low + (high - low) * *(*g)++;
}

static double logarithmic(genes *g, double low, double high) {
  return low * pow(high / low, *(*g)++);
}

static int chance(genes *g, double probability) {
  return *(*g)++ < probability;
}

/* A tenth of all patches are black. */
static double reflectance(genes *g) {
  return fmax(0, real(g, -0.1, 0.95));
}

/* Three of four patches emit nothing. */
static double emission(genes *g) {
  return fmax(0, real(g, -3, 1));
}

/* Paints the patches from `first` on in the same colour. */
static void paint(adv_scene *s, size_t first, double emitted, double reflected) {
  for (size_t k = first; k < s->count; k++) {
    s->patch[k].emission[0] = emitted;
    s->patch[k].reflectance[0] = reflected;
  }
}

/* A screen with two fronts, if it touches nothing. */
static void screen(adv_scene *s, genes *g, const double box[4], double shortest,
                   double longest) {
  const size_t first = s->count;
  const double x = real(g, box[0], box[2]), y = real(g, box[1], box[3]);
  const double angle = real(g, 0, PI), length = logarithmic(g, shortest, longest);
  const double dx = length / 2 * cos(angle), dy = length / 2 * sin(angle);
  const double rho = reflectance(g);
  if (adv_free(s, x - dx, y - dy, x + dx, y + dy))
    adv_screen(s, x - dx, y - dy, x + dx, y + dy);
  paint(s, first, 0, rho);
}

/* Walls that emit what is told, or what a gene says. */
static void wall(adv_scene *s, genes *g, double ax, double ay, double bx, double by,
                 double emitted) {
  const size_t first = s->count;
  adv_wall(s, ax, ay, bx, by);
  paint(s, first, emitted, reflectance(g));
}

static void lamp(adv_scene *s, genes *g, double ax, double ay, double bx, double by) {
  const double emitted = emission(g);
  wall(s, g, ax, ay, bx, by, emitted);
}

/* A free box, turned to the axes. */
static void furniture(adv_scene *s, genes *g, double x1, double y1) {
  const size_t first = s->count;
  const double x = real(g, 0, x1), y = real(g, 0, y1);
  const double w = logarithmic(g, 0.01, 1), h = logarithmic(g, 0.01, 1);
  const double rho = reflectance(g);
  if (adv_free(s, x, y, x + w, y) && adv_free(s, x + w, y, x + w, y + h) &&
      adv_free(s, x + w, y + h, x, y + h) && adv_free(s, x, y + h, x, y))
    adv_box(s, x + w, y, x, y + h);
  paint(s, first, 0, rho);
}

/* A simple quadrangle, convex or not, in which one wall at least is a lamp, with a screen or a
   piece of furniture. */
static void room(adv_scene *s, genes g) {
  static const double at[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  double corner[4][2];
  const double width = real(&g, 0.5, 4);
  for (int k = 0; k < 4; k++) {
    corner[k][0] = width * (at[k][0] + real(&g, -0.4, 0.4));
    corner[k][1] = at[k][1] + real(&g, -0.4, 0.4);
  }
  for (int k = 0; k < 4; k++) {
    const double *a = corner[k], *b = corner[(k + 1) % 4];
    if (k)
      lamp(s, &g, a[0], a[1], b[0], b[1]);
    else
      wall(s, &g, a[0], a[1], b[0], b[1], 1);
  }
  if (chance(&g, 0.5))
    screen(s, &g, (const double[4]){0, 0, width, 1}, 1e-3, 1);
  else
    furniture(s, &g, width, 1);
}

/* Plates over a ground, under an even sky. */
static void panels(adv_scene *s, genes g) {
  const int count = 1 + (int)fmin(2, real(&g, 0, 3));
  const double half = real(&g, 1, 6);
  wall(s, &g, -half, 0, half, 0, 0);
  for (int k = 0; k < count; k++)
    screen(s, &g, (const double[4]){-half, 0.02, half, 2.5}, 0.03, 2);
  s->background[0] = 1;
}

/* A screen with a slit across a room, from floor to ceiling. */
static void slit_at(adv_scene *s, genes *g, double x) {
  const double low = real(g, 0.05, 0.9), width = logarithmic(g, 1e-4, 0.3);
  const size_t first = s->count;
  adv_screen(s, x, 0, x, low);
  paint(s, first, 0, reflectance(g));
  const size_t second = s->count;
  if (low + width < 1) adv_screen(s, x, low + width, x, 1);
  paint(s, second, 0, reflectance(g));
}

/* A row of one to three rooms, with a slit from each to the next. */
static void slits(adv_scene *s, genes g) {
  const int count = 1 + chance(&g, 0.5);
  const double width = real(&g, 0.5, 3);
  wall(s, &g, 0, 0, width, 0, 0);
  lamp(s, &g, width, 0, width, 1);
  wall(s, &g, width, 1, 0, 1, 0);
  wall(s, &g, 0, 1, 0, 0, 1);
  const double part = real(&g, 0.1, 0.5);
  slit_at(s, &g, part * width);
  if (count > 1) slit_at(s, &g, (1 - real(&g, 0.1, 0.45)) * width);
}

/* A short lamp, and screens about it, perhaps over a floor and in daylight. */
static void screens(adv_scene *s, genes g) {
  const double half = real(&g, 0.3, 3);
  wall(s, &g, -half, 0, half, 0, 0);
  if (!chance(&g, 0.7)) s->count = 0;
  const double x = real(&g, -half, half), y = logarithmic(&g, 0.003, 1);
  const double angle = real(&g, 0, 2 * PI), length = logarithmic(&g, 0.01, 1);
  const double bx = x + length * cos(angle), by = y + length * sin(angle);
  const size_t first = s->count;
  if (adv_free(s, x, y, bx, by)) adv_wall(s, x, y, bx, by);
  paint(s, first, 1, reflectance(&g));
  if (chance(&g, 0.4)) s->background[0] = 1;
  for (int k = 0; k < 3; k++) screen(s, &g, (const double[4]){-half, 0.01, half, 2}, 0.03, 2);
}

/* Forgets the patches from `first` on that are not in a box, for the sake of images. */
static void stay_within(adv_scene *s, size_t first, const double box[4]) {
  size_t count = first;
  for (size_t k = first; k < s->count; k++) {
    int inside = 1;
    for (int end = 0; end < 2; end++) {
      const double x = ldexp((double)s->patch[k].x[end], s->exponent),
                   y = ldexp((double)s->patch[k].y[end], s->exponent);
      inside &= x > box[0] && x < box[2] && y > box[1] && y < box[3];
    }
    if (inside) s->patch[count++] = s->patch[k];
  }
  s->count = count;
}

/* A ground and plates beside a mirror, or between two, in daylight. */
static void mirrors(adv_scene *s, genes g) {
  const int count = 1 + chance(&g, 0.5);
  const double width = real(&g, 0.5, 4);
  wall(s, &g, 0, 0, width, 0, 0);
  adv_mirror(s, 0, 0, 0, 1);
  if (chance(&g, 0.5)) adv_mirror(s, width, 0, width, 1);
  for (int k = 0; k < count; k++)
    screen(s, &g, (const double[4]){0, 0.02, width, 2}, 0.03, 1.5);
  stay_within(s, 1, (const double[4]){0, 0, width, 100});
  s->background[0] = 1;
}

/* Rows of panels over an endless ground, or plates of which one has a lamp.  All is within a
   period of the ground: the farther images are, the more of them a solve takes. */
static void periods(adv_scene *s, genes g) {
  const int indoors = chance(&g, 0.4);
  const double part = real(&g, 0.05, 0.95), height = logarithmic(&g, 0.1, 1);
  s->period[0] = (int64_t)ldexp(1, -s->exponent);
  wall(s, &g, 0, 0, part, 0, indoors);
  wall(s, &g, part, 0, 1, 0, 0);
  if (indoors) {
    wall(s, &g, 1, height, 0, height, 0);
    screen(s, &g, (const double[4]){0.1, 0.05 * height, 0.9, 0.95 * height}, 0.02, 0.6);
  } else {
    screen(s, &g, (const double[4]){0.1, 0.05, 0.9, 0.8}, 0.03, 0.9);
    s->background[0] = 1;
  }
  stay_within(s, indoors ? 3 : 2, (const double[4]){-1, 0, 2, indoors ? height : 100});
}

/* A roof with a slit, low or high above the ground. */
static void roof(adv_scene *s, genes *g) {
  const double x = real(g, -1, 1), y = logarithmic(g, 0.1, 20);
  const double width = logarithmic(g, 1e-3, 1), reach = logarithmic(g, 1, 30);
  const double rho = reflectance(g);
  const size_t first = s->count;
  adv_screen(s, x - reach, y, x, y);
  adv_screen(s, x + width, y, x + width + reach, y);
  paint(s, first, 0, rho);
}

/* A sun, or a piece of the sky, over a ground and plates. */
static void day(adv_scene *s, genes g) {
  const int sun = chance(&g, 0.5);
  const double angle = real(&g, 2, 178), width = logarithmic(&g, 0.1, 120);
  const double half = real(&g, 0.5, 6);
  if (sun)
    s->sun[0] = (adv_sun){llround(-SUN * cos(angle * PI / 180)),
                          llround(-SUN * sin(angle * PI / 180)), 1};
  else
    s->piece[s->pieces++] = (adv_piece){angle - 90 - width / 2, angle - 90 + width / 2, {1}};
  wall(s, &g, -half, 0, half, 0, 0);
  s->background[0] = fmax(0, real(&g, -0.5, 0.5));
  if (chance(&g, 0.3)) {
    roof(s, &g);
    return;
  }
  const int count = 1 + chance(&g, 0.6);
  for (int k = 0; k < count; k++)
    screen(s, &g, (const double[4]){-half, 0.02, half, 2.5}, 0.03, 2);
}

/* Two rooms, a partition with a door between them, and a screen or a table. */
static void doors(adv_scene *s, genes g) {
  const double width = real(&g, 0.8, 4), x = width * real(&g, 0.1, 0.9);
  const double low = real(&g, 0.02, 0.98), open = logarithmic(&g, 1e-5, 1);
  lamp(s, &g, 0, 0, x, 0);
  wall(s, &g, x, 0, width, 0, 0);
  lamp(s, &g, width, 0, width, 1);
  wall(s, &g, width, 1, x, 1, 0);
  wall(s, &g, x, 1, 0, 1, 0);
  wall(s, &g, 0, 1, 0, 0, 1);
  const size_t first = s->count;
  adv_screen(s, x, 0, x, low);
  if (low + open < 1) adv_screen(s, x, low + open, x, 1);
  paint(s, first, 0, reflectance(&g));
  screen(s, &g, (const double[4]){0.02, 0.02, width - 0.02, 0.98}, 0.01, 0.9);
}

const adv_family adv_families[] = {
    {"rooms", "a quadrangle with a screen or a piece of furniture", 22, room},
    {"panels", "one to three plates over a ground, under an even sky", 18, panels},
    {"slits", "a room with one or two screens across it, and a slit in each", 17, slits},
    {"screens", "a lamp and screens, perhaps over a floor and in daylight", 29, screens},
    {"mirrors", "plates over a ground beside a mirror, or between two", 14, mirrors},
    {"periods", "endless rows of panels, or endless plates", 11, periods},
    {"day", "plates, or a roof with a slit, under a sun or a piece of the sky", 18, day},
    {"doors", "two rooms, a door, and a screen", 18, doors},
    {NULL, NULL, 0, NULL}};

/* Scenes are some units wide, and their coordinates have as many bits as points on their
   patches leave. */
enum { GRID = -28 };

void adv_express(const adv_family *family, const double *gene, adv_scene *scene) {
  adv_clear(scene, GRID);
  family->build(scene, gene);
  adv_call_original(scene);
}
