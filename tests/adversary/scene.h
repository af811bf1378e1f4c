/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene as the adversary keeps it: coordinates are integers times a power of two.  Rotations
   by Gaussian integers, splits and shifts are then exact, and the library gets the very scene
   that the transformation means.  A patch knows the part of the original of which it is made.
 */
#ifndef HR2D_TESTS_ADVERSARY_SCENE_H
#define HR2D_TESTS_ADVERSARY_SCENE_H

#include <hr2d/hr2d.h>
#include <stddef.h>
#include <stdint.h>

#include "adversary/random.h"

#define ADV_BANDS   4
#define ADV_CORNERS 5
#define ADV_PATCHES 160
#define ADV_PIECES  12
#define ADV_MIRRORS 3

typedef struct adv_patch {
  int64_t x[2], y[2]; /* start and end, in steps of 2^exponent; the front is on the left */
  double emission[ADV_BANDS], reflectance[ADV_BANDS];
  double transmittance[ADV_BANDS]; /* of a pane, whose other side has the same */
  int source;      /* the patch of the original of which this is a part; -1: none */
  double from, to; /* the fractions of the original at which the ends are */
} adv_patch;

/* A sun: the direction of its light, in integers, so that rotations are exact. */
typedef struct adv_sun {
  int64_t x, y;
  double irradiance;
} adv_sun;

/* A piece of the sky: bearings in degrees. */
typedef struct adv_piece {
  double from, to, value[ADV_BANDS];
} adv_piece;

/* A mirror, by two points of its line. */
typedef struct adv_line {
  int64_t x[2], y[2];
} adv_line;

typedef struct adv_scene {
  adv_patch patch[ADV_PATCHES];
  size_t count, bands;
  int exponent;
  adv_line mirror[ADV_MIRRORS];
  size_t mirrors;
  int64_t period[2]; /* 0, 0: none */
  int unfolded;      /* some patches are images of others */
  int closed; /* nothing leaves it and nothing comes in: what is outside of its box is hidden */
  int pierced; /* ends pass through other patches by a rounding */
  double background[ADV_BANDS];
  adv_sun sun[ADV_BANDS];
  adv_piece piece[ADV_PIECES];
  size_t pieces;
  double kappa[ADV_BANDS], hot[ADV_BANDS]; /* of a gas: κ per length, and E_g */
  int flat, heated;                        /* its section; its heat is given, as hot[0] */
  int64_t border[ADV_CORNERS][2]; /* a polygon within which these are so many times as large: */
  size_t corners;                 /* 0: there is none */
  double dark, warm;              /* κ, and E_g */
  double turned; /* B may be off by this: bearings were turned by an angle that is no double */
  double gain;   /* B is this times B of the original */
} adv_scene;

/* An empty scene with one band, on a grid of 2^exponent. */
void adv_clear(adv_scene *scene, int exponent);

/* A wall with a front on the left, ends rounded to the grid; no more than ADV_PATCHES. */
void adv_wall(adv_scene *scene, double ax, double ay, double bx, double by);

/* The same with two fronts. */
void adv_screen(adv_scene *scene, double ax, double ay, double bx, double by);

/* A ring; counter-clockwise its fronts look inside. */
void adv_ring(adv_scene *scene, const double (*corner)[2], size_t count);

/* A room from (x0,y0) to (x1,y1); with x1 < x0 it is an obstacle, whose fronts look outside. */
void adv_box(adv_scene *scene, double x0, double y0, double x1, double y1);

/* Whether a wall with these ends, rounded, would touch no patch that is there. */
int adv_free(const adv_scene *scene, double ax, double ay, double bx, double by);

/* Draws emissions and reflectances up to `max`; at least one patch emits in each band. */
void adv_paint(adv_scene *scene, adv_random *r, double max);

/* Sets the reflectance of a patch in all bands. */
void adv_reflect(adv_patch *patch, double reflectance);

/* Makes a pane of patch `front` and the one behind it, after adv_paint(): no more is scattered
   than `max`. */
void adv_pane(adv_scene *scene, adv_random *r, size_t front, double max);

/* Whether a patch is a side of a pane in some band; what it scatters in one, ρ + τ. */
int adv_is_pane(const adv_scene *scene, size_t patch);
double adv_scattered(const adv_patch *patch, size_t band);

/* A mirror, by two points. */
void adv_mirror(adv_scene *scene, double ax, double ay, double bx, double by);

/* Whether there are mirrors or a period. */
int adv_is_symmetric(const adv_scene *scene);

/* The least and largest coordinates, in steps. */
typedef struct adv_extent {
  int64_t low[2], high[2];
} adv_extent;
adv_extent adv_extent_of(const adv_scene *scene);

/* Bits of the largest coordinate. */
int adv_bits(const adv_scene *scene);

/* The length of a patch, to 2 roundings. */
double adv_length(const adv_scene *scene, size_t patch);

/* Whether light comes from outside in some band, besides the background. */
int adv_has_sun(const adv_scene *scene);
int adv_has_sky(const adv_scene *scene);

/* Gas in all bands with κ from `low` to `high`, in some bands of several perhaps none; hot or
   cold, or of given heat. */
void adv_fill_gas(adv_scene *scene, adv_random *r, double low, double high, int heated);
int adv_has_gas(const adv_scene *scene);

/* Gives a part of the gas a border of its own, any polygon with corners in a box (x0, y0, x1,
   y1). */
void adv_part_gas(adv_scene *scene, adv_random *r, const double box[4]);

/* The same gas in a scene that is `factor` times as large. */
void adv_scale_gas(adv_scene *scene, double factor);

/* The most that comes from outside, as a radiosity or an irradiance. */
double adv_outside(const adv_scene *scene, size_t band);

/* Makes each patch the whole of its own source. */
void adv_call_original(adv_scene *scene);

/* Commits it as a scene of the library. */
hr2d_status adv_build(const adv_scene *scene, hr2d_scene **built);

/* Writes it as GeoJSON; 0 if the file cannot be written. */
int adv_write(const adv_scene *scene, const char *path);

#endif
