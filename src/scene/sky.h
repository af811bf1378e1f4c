/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sky in pieces: what it sends from which bearings beyond the background. */
#ifndef HR2D_SRC_SCENE_SKY_H
#define HR2D_SRC_SCENE_SKY_H

#include <hr2d/daylight.h>

enum { HR2DI_SKY_PIECES = 720 /* at most */ };

/* Bearings are those of hr2d_sky_piece, in degrees. */
typedef struct hr2di_sky {
  hr2d_sky_piece *piece; /* no two overlap */
  double *value;         /* pieces × bands, piece by piece */
  size_t pieces, bands;  /* bands may be 1 */
} hr2di_sky;

/* Whether a sky is valid.  HR2D_OK, or a status with a message of the scene. */
hr2d_status hr2di_scene_check_sky(hr2d_scene *scene, const hr2d_sky_piece *piece, size_t pieces,
                                  const double *value, size_t bands);

/* The scene owns a valid sky from its hooks from now on. */
void hr2di_scene_take_sky(hr2d_scene *scene, const hr2di_sky *sky);

void hr2di_sky_clear(hr2di_sky *sky, const hr2d_allocator *alloc);

/* What a piece sends in a band more than the background. */
double hr2di_sky_beyond(const hr2d_scene *scene, size_t piece, size_t band);

/* The largest radiosity of the sky in a band, with the background, and the least. */
double hr2di_sky_max(const hr2d_scene *scene, size_t band);
double hr2di_sky_min(const hr2d_scene *scene, size_t band);

/* The largest jump of the sky at a bearing over all bands, as a part of the largest radiosity
   of each, `max`. */
double hr2di_sky_jump(const hr2d_scene *scene, double bearing, const double *max);

/* Whether a piece has the light of a bearing. */
int hr2di_sky_has(const hr2d_scene *scene, size_t piece, double bearing);

/* A bearing in [0,360). */
double hr2di_sky_turned(double bearing);

/* The unit vector to a bearing, exact at multiples of 90 degrees. */
hr2d_point hr2di_sky_direction(double bearing);

/* A part of the front of a patch: sines of angles from its normal towards its end. */
typedef struct hr2di_sines {
  double low, high;
} hr2di_sines;

/* The parts of a patch's front in which a piece is; returns how many, up to 2. */
int hr2di_sky_front(const hr2d_scene *scene, size_t patch, size_t piece, hr2di_sines part[2]);

/* ½ of the length that [low, high] has in common with the parts of a piece. */
double hr2di_sky_factor(const hr2di_sines part[2], int parts, double low, double high);

#endif
