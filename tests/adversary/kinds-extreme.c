/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed rooms of extreme proportions, reflectances and places. */
#include <math.h>

#include "adversary/kinds.h"

/* A corner that is nearly straight, or nearly closed from outside. */
static void obtuse(adv_scene *scene, adv_random *r) {
  double x = adv_real(r, 0.5, 3.5), depth = ldexp(adv_real(r, 1, 2), -adv_int(r, 1, 12));
  const double corner[5][2] = {{0, 0}, {x, -depth}, {4, 0}, {4, 3}, {0, 3}};
  adv_ring(scene, corner, 5);
  scene->closed = 1;
  adv_paint(scene, r, 0.9);
}

/* Sharp corners and slender rooms. */
static void needle(adv_scene *scene, adv_random *r) {
  double thin = ldexp(adv_real(r, 1, 2), -adv_int(r, 1, 10));
  if (adv_chance(r, 0.5)) {
    const double corner[3][2] = {{0, 0}, {4, 0}, {adv_real(r, 0, 4), thin}};
    adv_ring(scene, corner, 3);
  } else {
    adv_box(scene, 0, 0, 2, thin);
  }
  scene->closed = 1;
  adv_paint(scene, r, 0.9);
}

/* Pieces down to 2^-20 beside a corner. */
static void short_patches(adv_scene *scene, adv_random *r) {
  scene->exponent = -24;
  double t = 0, h = adv_real(r, 0.1, 1), k = adv_real(r, 0.1, 1);
  int level = adv_int(r, 2, 20);
  for (int n = adv_int(r, 1, 3); n > 0 && level > 0; n--, level -= adv_int(r, 1, 8)) {
    double u = ldexp(1, -level);
    if (u > t) adv_wall(scene, t, 0, u, 0), t = u;
  }
  const double corner[4][2] = {{1, 0}, {1, h}, {0, k}, {0, 0}};
  adv_wall(scene, t, 0, 1, 0);
  for (int c = 0; c < 3; c++)
    adv_wall(scene, corner[c][0], corner[c][1], corner[c + 1][0], corner[c + 1][1]);
  scene->closed = 1;
  adv_paint(scene, r, 0.9);
}

/* A short piece at the foot of a partition. */
static void foot(adv_scene *scene, adv_random *r) {
  scene->exponent = -24;
  double piece = ldexp(adv_real(r, 1, 2), -adv_int(r, 3, 18));
  const double corner[6][2] = {{0, 0}, {2, 0}, {2 + piece, 0}, {4, 0}, {4, 3}, {0, 3}};
  adv_ring(scene, corner, 6);
  adv_screen(scene, 2, 0, 2, adv_real(r, 0.2, 2.5));
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* A board of a centimetre or less along a wall. */
static void skirting(adv_scene *scene, adv_random *r) {
  double d = ldexp(adv_real(r, 1, 2), -adv_int(r, 4, 12)), h = adv_real(r, 0.02, 0.2);
  const double corner[6][2] = {{0, 0}, {4 - d, 0}, {4 - d, h}, {4, h}, {4, 3}, {0, 3}};
  adv_ring(scene, corner, 6);
  scene->closed = 1;
  adv_paint(scene, r, 0.9);
}

/* Ends that should meet and miss each other by 1e-9: light leaks into a dark room. */
static void leak(adv_scene *scene, adv_random *r) {
  scene->exponent = -33;
  double gap = ldexp(1, -adv_int(r, 24, 32)), x = adv_real(r, 1, 3);
  adv_box(scene, 0, 0, 4, 3);
  adv_screen(scene, x, adv_chance(r, 0.5) ? gap : 0, x, 3 - gap);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
  for (size_t k = 0; k < scene->count; k++) scene->patch[k].emission[0] = k == 3;
}

/* Walls whose corners are off by 1e-9. */
static void jitter(adv_scene *scene, adv_random *r) {
  scene->exponent = -36;
  double corner[12][2];
  for (int k = 0; k < 12; k++) {
    static const double place[12][2] = {{0, 0}, {1, 0}, {3, 0}, {4, 0}, {4, 2}, {4, 2.5},
                                        {4, 3}, {2, 3}, {1, 3}, {0, 3}, {0, 2}, {0, 1}};
    for (int axis = 0; axis < 2; axis++)
      corner[k][axis] = place[k][axis] + adv_real(r, -1e-9, 1e-9);
  }
  adv_ring(scene, (const double(*)[2])corner, 12);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* Far from the origin. */
static void offset(adv_scene *scene, adv_random *r) {
  double x = ldexp(adv_int(r, -64, 64), adv_int(r, 4, 14));
  double y = ldexp(adv_int(r, -64, 64), adv_int(r, 4, 14));
  double w = adv_real(r, 2, 5), h = adv_real(r, 2, 4);
  adv_box(scene, x, y, x + w, y + h);
  adv_screens(scene, r, adv_int(r, 0, 2), (const double[4]){x, y, x + w, y + h}, 0.2, 1.5);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* Reflectances of 1 − 2^-k. */
static void white(adv_scene *scene, adv_random *r) {
  adv_convex(scene, r, adv_int(r, 3, 6), 2, 0);
  adv_paint(scene, r, 0.9);
  for (size_t k = 0; k < scene->count; k++)
    if (adv_chance(r, 0.8)) adv_reflect(&scene->patch[k], 1 - ldexp(1, -adv_int(r, 3, 20)));
}

/* Two rooms with a slit between them. */
static void slit(adv_scene *scene, adv_random *r) {
  double w, h;
  adv_room(scene, r, &w, &h);
  double x = w * adv_real(r, 0.3, 0.7), y = h * adv_real(r, 0.1, 0.8);
  double wide = ldexp(adv_real(r, 1, 2), -adv_int(r, 4, 12));
  adv_screen(scene, x, 0, x, y);
  adv_screen(scene, x, y + wide, x, h);
  adv_paint(scene, r, 0.8);
}

/* Two plates face to face, down to 2^-44 of each other; some of them meet at one end. */
static void crack(adv_scene *scene, adv_random *r) {
  scene->exponent = -44;
  const double near = adv_real(r, 0.5, 1.5), far = adv_real(r, 2.5, 3.5);
  const double gap = ldexp(adv_real(r, 1, 2), -adv_int(r, 8, 44));
  const int meet = adv_chance(r, 0.3), level = adv_chance(r, 0.5);
  const double start = meet ? near : near + adv_real(r, -0.4, 0.4);
  const double end = adv_chance(r, 0.3) ? far : far + adv_real(r, -0.4, 0.4);
  adv_box(scene, 0, 0, 4, 3);
  adv_screen(scene, near, 1.5, far, 1.5);
  adv_screen(scene, start, meet ? 1.5 : 1.5 + gap, end,
             level && !meet ? 1.5 + gap : 1.5 + 2 * gap);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* A wall that misses a floor, perhaps at a tiny angle, down to 2^-44; a joint of the floor is
   beside its foot. */
static void miss(adv_scene *scene, adv_random *r) {
  scene->exponent = -44;
  const double x = adv_real(r, 1.5, 2.5), far = x + adv_real(r, -1, 1);
  const double gap = ldexp(adv_real(r, 1, 2), -adv_int(r, 8, 44));
  const double joint = x + ldexp(adv_chance(r, 0.5) ? 1 : -1, -adv_int(r, 2, 44));
  const double rise = adv_chance(r, 0.5) ? ldexp(1, -adv_int(r, 0, 44)) : adv_real(r, 0.5, 2);
  const double corner[5][2] = {{0, 0}, {joint, 0}, {4, 0}, {4, 3}, {0, 3}};
  adv_ring(scene, corner, 5);
  adv_screen(scene, x, gap, far, gap + rise);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* A few steps of 2^-40 to 2^-16. */
static double off_line(adv_random *r) {
  return adv_chance(r, 0.3) ? 0 : ldexp(adv_int(r, -4, 4), -adv_int(r, 16, 40));
}

/* Walls with doors in them.  The parts of a wall are nearly in one line, so that the line
   through the two sides of a door passes the feet of both parts at a tiny distance. */
static void doors(adv_scene *scene, adv_random *r) {
  scene->exponent = -40;
  const double x = adv_real(r, 1.5, 2.5), y = adv_real(r, 1, 2);
  adv_box(scene, 0, 0, 4, 3);
  adv_screen(scene, 0, y + off_line(r), adv_real(r, 0.4, 1.3), y);
  adv_screen(scene, adv_real(r, 2.7, 3.6), y + off_line(r), 4, y + off_line(r));
  if (adv_chance(r, 0.6)) {
    adv_screen(scene, x + off_line(r), 0, x, adv_real(r, 0.2, y - 0.1));
    adv_screen(scene, x + off_line(r), adv_real(r, y + 0.1, 2.8), x + off_line(r), 3);
  }
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

/* A wall in pieces, from one corner to the next. */
static void wall_in_pieces(adv_scene *scene, const double *a, const double *b, int pieces) {
  for (int k = 0; k < pieces; k++) {
    const double t = (double)k / pieces, u = (double)(k + 1) / pieces;
    adv_wall(scene, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
             a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]));
  }
}

/* A partition whose ends are on oblique walls but for the rounding of their coordinates: each
   one is before its wall, on it or past it.  The room is dark behind it, or both sides are lit.
 */
static void pierced(adv_scene *scene, adv_random *r) {
  scene->exponent = -adv_int(r, 36, 46);
  const double corner[5][2] = {
      {0, 0}, {4, adv_real(r, -0.5, 0.5)}, {4, 3 + adv_real(r, -0.5, 0.5)}, {0, 3}, {0, 0}};
  const int pieces = adv_chance(r, 0.4) ? adv_int(r, 16, 24) : adv_int(r, 1, 4);
  for (int side = 0; side < 4; side++)
    wall_in_pieces(scene, corner[side], corner[side + 1], pieces);
  double end[2][2];
  for (int k = 0; k < 2; k++) {
    const adv_patch *wall = &scene->patch[2 * k * pieces + adv_int(r, 0, pieces - 1)];
    const double t = adv_real(r, 0.1, 0.9);
    end[k][0] = ldexp((1 - t) * (double)wall->x[0] + t * (double)wall->x[1], scene->exponent);
    end[k][1] = ldexp((1 - t) * (double)wall->y[0] + t * (double)wall->y[1], scene->exponent);
  }
  adv_screen(scene, end[0][0], end[0][1], end[1][0], end[1][1]);
  scene->closed = scene->pierced = 1;
  adv_paint(scene, r, 0.8);
  if (adv_chance(r, 0.5)) return;
  for (size_t k = 0; k < scene->count; k++)
    scene->patch[k].emission[0] = k / (size_t)pieces == 3;
}

/* A small room inside of the wall of a large one: lengths of 2^-10 beside 4. */
static void niche(adv_scene *scene, adv_random *r) {
  scene->exponent = -24;
  double x = adv_real(r, 0.5, 3.5), d = ldexp(adv_real(r, 1, 2), -adv_int(r, 2, 10));
  double depth = d * adv_real(r, 0.2, 4);
  const double corner[8][2] = {{0, 0},     {x, 0}, {x, -depth}, {x + d, -depth},
                               {x + d, 0}, {4, 0}, {4, 3},      {0, 3}};
  adv_ring(scene, corner, 8);
  scene->closed = 1;
  adv_paint(scene, r, 0.8);
}

const adv_kind adv_extreme[] = {
    {"obtuse", obtuse, "a corner that is nearly straight"},
    {"needle", needle, "sharp corners and slender rooms"},
    {"short", short_patches, "lengths down to 2^-20 beside a corner"},
    {"foot", foot, "a short piece at the foot of a partition"},
    {"skirting", skirting, "a thin board along a wall"},
    {"leak", leak, "gaps of 1e-9 into a dark room"},
    {"jitter", jitter, "corners that are off by 1e-9"},
    {"offset", offset, "up to 1e6 from the origin"},
    {"white", white, "reflectances of 1 - 2^-k"},
    {"slit", slit, "two rooms with a slit between them"},
    {"niche", niche, "a niche down to 2^-10"},
    {"crack", crack, "plates down to 2^-44 of each other"},
    {"miss", miss, "a wall that misses a floor by down to 2^-44"},
    {"doors", doors, "walls with doors, nearly in one line"},
    {"pierced", pierced, "a partition that ends on oblique walls, but for a rounding"},
    {NULL, NULL, NULL}};
