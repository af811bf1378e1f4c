/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact transformations. */
#include "adversary/transform.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Coordinates are doubles, with bits to spare for the points at which B is compared. */
enum { BITS = 44 };

/* Bearings are degrees clockwise.  Where the angle is no double, edges are off by some
   roundings of 360 degrees; what comes from their sides differs by at most the largest value,
   and is reflected with at most the largest reflectance. */
static void turn_sky(adv_scene *scene, int a, int b) {
  double angle = atan2(b, a) * (180 / 3.14159265358979323846), off = 0;
  if (!a || !b) angle = a ? (a > 0 ? 0 : 180) : b > 0 ? 90 : -90;
  for (size_t k = 0; k < scene->pieces; k++) {
    scene->piece[k].from -= angle;
    scene->piece[k].to -= angle;
  }
  for (size_t band = 0; band < scene->bands && a && b; band++) {
    double max = 0, light = 0;
    for (size_t k = 0; k < scene->count; k++)
      max = fmax(max, adv_scattered(&scene->patch[k], band));
    for (size_t k = 0; k < scene->pieces; k++)
      light += scene->background[band] + 2 * scene->piece[k].value[band];
    off = fmax(off, 0x1p-48 * light / (1 - max));
  }
  scene->turned += off;
}

/* κ gets roundings; what arrives through gas, and what walls make of it, follows them. */
static void stretch_gas(adv_scene *scene, double factor) {
  double max = 0, light = 0;
  if (!adv_has_gas(scene) || factor == 1) return;
  for (size_t band = 0; band < scene->bands; band++) {
    light = fmax(light, fmax(1, scene->warm) * scene->hot[band]);
    for (size_t k = 0; k < scene->count; k++) {
      max = fmax(max, adv_scattered(&scene->patch[k], band));
      light = fmax(light, scene->patch[k].emission[band]);
    }
  }
  scene->turned += 0x1p-49 * light / (1 - max) / (1 - max);
  adv_scale_gas(scene, factor);
}

static void rotate_pair(int64_t *x, int64_t *y, int a, int b) {
  int64_t old = *x;
  *x = a * *x - b * *y;
  *y = b * old + a * *y;
}

/* (x + iy)(a + bi). */
static int multiply(adv_scene *scene, int a, int b) {
  int max = (a < 0 ? -a : a) + (b < 0 ? -b : b), bits = 0;
  while (max >> bits) bits++;
  if (adv_bits(scene) + bits > BITS) return 0;
  for (size_t k = 0; k < scene->count; k++)
    for (int end = 0; end < 2; end++)
      rotate_pair(&scene->patch[k].x[end], &scene->patch[k].y[end], a, b);
  for (size_t band = 0; band < scene->bands; band++)
    rotate_pair(&scene->sun[band].x, &scene->sun[band].y, a, b);
  for (size_t k = 0; k < scene->mirrors; k++)
    for (int end = 0; end < 2; end++)
      rotate_pair(&scene->mirror[k].x[end], &scene->mirror[k].y[end], a, b);
  for (size_t k = 0; k < scene->corners; k++)
    rotate_pair(&scene->border[k][0], &scene->border[k][1], a, b);
  rotate_pair(&scene->period[0], &scene->period[1], a, b);
  turn_sky(scene, a, b);
  stretch_gas(scene, hypot(a, b));
  return 1;
}

static int rotate(adv_scene *scene, adv_random *r) {
  int a = adv_int(r, 1, 12), b = adv_int(r, 1, 12);
  if (!multiply(scene, a, adv_chance(r, 0.5) ? b : -b)) return 0;
  adv_allow_images(scene);
  return 1;
}

static int turn(adv_scene *scene, adv_random *r) {
  int quarters = adv_int(r, 1, 3);
  return quarters == 2 ? multiply(scene, -1, 0) : multiply(scene, 0, quarters - 2);
}

static void swap(int64_t *pair) {
  int64_t first = pair[0];
  pair[0] = pair[1];
  pair[1] = first;
}

/* What was left is right: patches run the other way. */
static int mirror(adv_scene *scene, adv_random *r) {
  int axis = adv_int(r, 0, 1);
  for (size_t k = 0; k < scene->count; k++) {
    adv_patch *p = &scene->patch[k];
    for (int end = 0; end < 2; end++)
      axis ? (p->y[end] = -p->y[end]) : (p->x[end] = -p->x[end]);
    swap(p->x);
    swap(p->y);
    double from = p->from;
    p->from = p->to;
    p->to = from;
  }
  for (size_t k = 0; k < scene->mirrors; k++)
    for (int end = 0; end < 2; end++)
      axis ? (scene->mirror[k].y[end] = -scene->mirror[k].y[end])
           : (scene->mirror[k].x[end] = -scene->mirror[k].x[end]);
  scene->period[axis] = -scene->period[axis];
  for (size_t k = 0; k < scene->corners; k++) scene->border[k][axis] = -scene->border[k][axis];
  for (size_t band = 0; band < scene->bands; band++)
    axis ? (scene->sun[band].y = -scene->sun[band].y)
         : (scene->sun[band].x = -scene->sun[band].x);
  for (size_t k = 0; k < scene->pieces; k++) {
    adv_piece *p = &scene->piece[k];
    double from = p->from;
    p->from = (axis ? 180 : 0) - p->to;
    p->to = (axis ? 180 : 0) - from;
  }
  return 1;
}

static int scale(adv_scene *scene, adv_random *r) {
  const int levels = adv_int(r, -40, 40);
  scene->exponent += levels;
  adv_scale_gas(scene, ldexp(1, levels));
  return 1;
}

static int shift(adv_scene *scene, adv_random *r) {
  adv_extent e = adv_extent_of(scene);
  double size = fmax((double)(e.high[0] - e.low[0]), (double)(e.high[1] - e.low[1]));
  double far = size * ldexp(1, adv_int(r, 0, 18));
  int64_t by[2] = {llround(adv_real(r, -far, far)), llround(adv_real(r, -far, far))};
  if (adv_bits(scene) > BITS - 2 || far > 0x1p42) return 0;
  for (size_t k = 0; k < scene->count; k++)
    for (int end = 0; end < 2; end++) {
      scene->patch[k].x[end] += by[0];
      scene->patch[k].y[end] += by[1];
    }
  for (size_t k = 0; k < scene->mirrors; k++)
    for (int end = 0; end < 2; end++) {
      scene->mirror[k].x[end] += by[0];
      scene->mirror[k].y[end] += by[1];
    }
  for (size_t k = 0; k < scene->corners; k++)
    for (int axis = 0; axis < 2; axis++) scene->border[k][axis] += by[axis];
  adv_allow_images(scene);
  return 1;
}

/* Emissions times a power of two. */
static int brighten(adv_scene *scene, adv_random *r) {
  double gain = ldexp(1, adv_int(r, -60, 60));
  for (size_t band = 0; band < scene->bands; band++) {
    for (size_t k = 0; k < scene->count; k++) scene->patch[k].emission[band] *= gain;
    scene->background[band] *= gain;
    scene->hot[band] *= gain;
    scene->sun[band].irradiance *= gain;
    for (size_t k = 0; k < scene->pieces; k++) scene->piece[k].value[band] *= gain;
  }
  scene->turned *= gain;
  scene->gain *= gain;
  return 1;
}

static int finer_grid(adv_scene *scene, int levels) {
  if (adv_bits(scene) + levels > BITS) return 0;
  for (size_t k = 0; k < scene->count; k++)
    for (int end = 0; end < 2; end++) {
      scene->patch[k].x[end] *= (int64_t)1 << levels;
      scene->patch[k].y[end] *= (int64_t)1 << levels;
    }
  for (size_t k = 0; k < scene->mirrors; k++)
    for (int end = 0; end < 2; end++) {
      scene->mirror[k].x[end] *= (int64_t)1 << levels;
      scene->mirror[k].y[end] *= (int64_t)1 << levels;
    }
  for (int axis = 0; axis < 2; axis++) scene->period[axis] *= (int64_t)1 << levels;
  scene->exponent -= levels;
  return 1;
}

/* Cuts a patch at `parts` / 2^levels of its length. */
static int cut(adv_scene *scene, size_t patch, int64_t parts, int levels) {
  if (scene->count == ADV_PATCHES) return 0;
  adv_patch *p = &scene->patch[patch], *rest = &scene->patch[scene->count];
  int64_t odd = (p->x[1] - p->x[0]) | (p->y[1] - p->y[0]);
  if (odd & ((1 << levels) - 1) && !finer_grid(scene, levels)) return 0;
  scene->count++;
  int64_t x = p->x[0] + (p->x[1] - p->x[0]) / ((int64_t)1 << levels) * parts;
  int64_t y = p->y[0] + (p->y[1] - p->y[0]) / ((int64_t)1 << levels) * parts;
  double at = p->from + (p->to - p->from) * ldexp((double)parts, -levels);
  *rest = *p;
  p->x[1] = rest->x[0] = x;
  p->y[1] = rest->y[0] = y;
  p->to = rest->from = at;
  return 1;
}

/* Cuts at random places, or towards an end by halves; not panes, of which both sides would have
   to be cut. */
static int split(adv_scene *scene, adv_random *r) {
  int done = 0;
  size_t patches = scene->count;
  for (int n = adv_int(r, 1, 4); n > 0; n--) {
    size_t k = (size_t)adv_int(r, 0, (int)patches - 1);
    int levels = adv_int(r, 1, 4), graded = adv_chance(r, 0.3);
    if (adv_is_pane(scene, k)) continue;
    done |= cut(scene, k, graded ? 1 : adv_int(r, 1, (1 << levels) - 1), levels);
  }
  return done;
}

/* Every patch in halves. */
static int halve(adv_scene *scene, adv_random *r) {
  size_t patches = scene->count;
  (void)r;
  if (patches > 24) return 0;
  for (size_t k = 0; k < patches; k++)
    if (!cut(scene, k, 1, 1)) return k > 0;
  return 1;
}

static int reorder(adv_scene *scene, adv_random *r) {
  for (int k = (int)scene->count - 1; k > 0; k--) {
    int other = adv_int(r, 0, k);
    adv_patch one = scene->patch[k];
    scene->patch[k] = scene->patch[other];
    scene->patch[other] = one;
  }
  return 1;
}

/* Room for a few patches more, and for their coordinates; what is outside of the box of a scene
   with images may be within one of theirs. */
static int has_room(const adv_scene *scene, int bits) {
  if (scene->heated) return 0;  /* what is added takes of its heat */
  if (scene->corners) return 0; /* gases with borders ask for a closed scene */
  return !adv_is_symmetric(scene) && scene->count + 6 <= ADV_PATCHES &&
         adv_bits(scene) + bits <= BITS;
}

/* Gas is light from outside, and refuses backs that are seen. */
static int dark_sky(const adv_scene *scene) {
  if (adv_has_gas(scene)) return 0;
  for (size_t band = 0; band < scene->bands; band++)
    if (scene->background[band] > 0) return 0;
  return !adv_has_sun(scene) && !adv_has_sky(scene);
}

static adv_patch *add(adv_scene *scene, double reflectance, int64_t ax, int64_t ay, int64_t bx,
                      int64_t by) {
  adv_patch p = {.x = {ax, bx}, .y = {ay, by}, .source = -1, .to = 1};
  for (size_t band = 0; band < scene->bands; band++) p.reflectance[band] = reflectance;
  scene->patch[scene->count] = p;
  return &scene->patch[scene->count++];
}

static int64_t reach(adv_extent e) {
  int64_t w = e.high[0] - e.low[0], h = e.high[1] - e.low[1];
  return w > h ? w : h;
}

/* Short absorbing patches outside of the box of the scene: they take light that is lost in any
   case, and are in nobody's way. */
static int dust(adv_scene *scene, adv_random *r) {
  adv_extent e = adv_extent_of(scene);
  int64_t size = reach(e);
  if (!dark_sky(scene) || !has_room(scene, 12) || size < 4096) return 0;
  for (int n = adv_int(r, 1, 3); n > 0; n--) {
    int64_t away = size << adv_int(r, 0, 8), length = 1 + (size >> adv_int(r, 6, 12));
    int64_t x = e.high[0] + away * n, y = e.low[1] + llround((double)away * adv_real(r, -1, 1));
    add(scene, 0, x, y, x + adv_int(r, 0, 1) * length, y + length);
  }
  return 1;
}

/* A wall behind all walls of one side.  In a closed room nobody sees it, else it absorbs. */
static int hide(adv_scene *scene, adv_random *r) {
  adv_extent e = adv_extent_of(scene);
  int64_t away = 1 + (reach(e) >> adv_int(r, 0, 16));
  double rho = scene->closed ? 0.5 : 0;
  if (!dark_sky(scene) || !has_room(scene, 2)) return 0;
  if (adv_chance(r, 0.5)) {
    int64_t x = adv_chance(r, 0.5) ? e.low[0] - away : e.high[0] + away;
    add(scene, rho, x, e.low[1], x, e.high[1]);
    add(scene, rho, x, e.high[1], x, e.low[1]);
  } else {
    int64_t y = adv_chance(r, 0.5) ? e.low[1] - away : e.high[1] + away;
    add(scene, rho, e.low[0], y, e.high[0], y);
    add(scene, rho, e.high[0], y, e.low[0], y);
  }
  return 1;
}

/* A lit closed triangle outside of a closed room. */
static int neighbour(adv_scene *scene, adv_random *r) {
  adv_extent e = adv_extent_of(scene);
  int64_t size = reach(e) >> adv_int(r, 0, 4), x = e.high[0] + size, y = e.high[1] + size;
  if (!scene->closed || size < 16 || !has_room(scene, 3)) return 0;
  add(scene, 0.5, x, y, x + size, y);
  add(scene, 0.5, x + size, y, x, y + size);
  adv_patch *lamp = add(scene, 0.5, x, y + size, x, y);
  for (size_t band = 0; band < scene->bands; band++) lamp->emission[band] = 0.5 * scene->gain;
  return 1;
}

/* Another band: dark, or one with other materials.  What was added stays dark: hidden walls are
   hidden, but what they emit would escape. */
static int band(adv_scene *scene, adv_random *r) {
  size_t added = scene->bands;
  if (added == ADV_BANDS || scene->unfolded || scene->heated) return 0;
  int dark = adv_chance(r, 0.5);
  for (size_t k = 0; k < scene->count; k++) {
    int lit = adv_int(r, 0, 8);
    scene->patch[k].emission[added] = dark || scene->patch[k].source < 0 ? 0 : lit / 8.0;
    scene->patch[k].reflectance[added] = adv_int(r, 0, 7) / 8.0;
  }
  if (adv_has_gas(scene)) {
    scene->kappa[added] = scene->kappa[0] * adv_int(r, 0, 2);
    scene->hot[added] = adv_int(r, 0, 8) / 8.0;
  }
  if (adv_has_sun(scene) && !dark && !adv_is_symmetric(scene))
    scene->sun[added] = (adv_sun){adv_int(r, -9, 9), -adv_int(r, 1, 9), adv_int(r, 0, 8) / 8.0};
  scene->bands++;
  return 1;
}

/* Cuts a piece of the sky in two. */
static int piece(adv_scene *scene, adv_random *r) {
  if (!scene->pieces || scene->pieces == ADV_PIECES) return 0;
  adv_piece *p = &scene->piece[adv_int(r, 0, (int)scene->pieces - 1)];
  adv_piece *rest = &scene->piece[scene->pieces];
  double at = p->from + (p->to - p->from) * adv_real(r, 0.01, 0.99);
  if (!(at > p->from && at < p->to)) return 0;
  scene->pieces++;
  *rest = *p;
  p->to = rest->from = at;
  return 1;
}

static int by_bearing(const void *one, const void *other) {
  const adv_piece *a = one, *b = other;
  return (a->from > b->from) - (a->from < b->from);
}

/* What is left of the sky becomes pieces, and there is no background.  A bright one that nobody
   sees would leave its roundings, which no answer claims. */
static int fill(adv_scene *scene, adv_random *r) {
  (void)r;
  size_t pieces = scene->pieces;
  if (!pieces || 2 * pieces > ADV_PIECES) return 0;
  qsort(scene->piece, pieces, sizeof scene->piece[0], by_bearing);
  for (size_t k = 0; k < pieces; k++) {
    adv_piece rest = {.from = scene->piece[k].to};
    rest.to = k + 1 < pieces ? scene->piece[k + 1].from : scene->piece[0].from + 360;
    memcpy(rest.value, scene->background, sizeof rest.value);
    if (rest.to > rest.from) scene->piece[scene->pieces++] = rest;
  }
  for (size_t b = 0; b < scene->bands; b++) scene->background[b] = 0;
  return 1;
}

/* No sun and no sky outside of a closed room. */
static int shade(adv_scene *scene, adv_random *r) {
  (void)r;
  if (!scene->closed) return 0;
  for (size_t b = 0; b < scene->bands; b++) scene->sun[b].irradiance = 0;
  scene->pieces = 0;
  return 1;
}

const adv_transform adv_transforms[] = {{"rotate", rotate, ADV_ANY},
                                        {"turn", turn, ADV_ANY},
                                        {"mirror", mirror, ADV_ANY},
                                        {"scale", scale, ADV_ANY},
                                        {"shift", shift, ADV_ANY},
                                        {"brighten", brighten, ADV_ANY},
                                        {"split", split, ADV_ANY},
                                        {"halve", halve, ADV_ANY},
                                        {"reorder", reorder, ADV_ANY},
                                        {"dust", dust, ADV_ANY},
                                        {"hide", hide, ADV_ANY},
                                        {"neighbour", neighbour, ADV_ANY},
                                        {"band", band, ADV_ANY},
                                        {"piece", piece, ADV_DAY},
                                        {"fill", fill, ADV_DAY},
                                        {"shade", shade, ADV_DAY},
                                        {"unfold", adv_unfold, ADV_SYMMETRY},
                                        {"cells", adv_cells, ADV_SYMMETRY},
                                        {"negate", adv_negate, ADV_SYMMETRY},
                                        {"redraw", adv_redraw, ADV_SYMMETRY},
                                        {"wander", adv_wander, ADV_SYMMETRY},
                                        {"flip", adv_flip, ADV_SYMMETRY},
                                        {"fold", adv_fold, ADV_SYMMETRY},
                                        {NULL, NULL, ADV_ANY}};
