/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sky in pieces: what it sends from which bearings beyond the background. */
#ifndef HR2D_SRC_SCENE_SKY_H
#define HR2D_SRC_SCENE_SKY_H

#include <hr2d/daylight.h>

#include "base/legendre.h"

enum { HR2DI_SKY_PIECES = 720 /* at most */, HR2DI_SKY_TERMS = 16 /* of a continuous sky */ };

/* The terms on a piece, and what integrals over arcs of it need. */
typedef struct hr2di_sky_terms {
  hr2di_basis basis;
  hr2di_rule rule;
} hr2di_sky_terms;

/* Bearings are those of hr2d_sky_piece, in degrees.  On each piece the sky is Σ value_l φ_l(ξ)
   with ξ from −1 where it begins to 1 where it ends.  A row of values is piece·terms + l; where
   there is one term, that is the radiosity of a piece. */
typedef struct hr2di_sky {
  hr2d_sky_piece *piece;  /* no two overlap */
  double *value;          /* rows × bands, row by row */
  unsigned char *goes_on; /* per piece: the sky goes on smoothly there from the piece before it,
                             which is the one on its left; NULL: nowhere */
  size_t pieces, terms, bands; /* bands may be 1 */
  hr2di_sky_terms of;          /* set by hr2di_scene_take_sky() */
} hr2di_sky;

static inline size_t hr2di_sky_rows(const hr2di_sky *sky) {
  return sky->pieces * sky->terms;
}

/* Whether pieces have more than a constant. */
static inline int hr2di_sky_is_continuous(const hr2di_sky *sky) {
  return sky->pieces > 0 && sky->terms > 1;
}

/* Whether a sky is valid.  HR2D_OK, or a status with a message of the scene. */
hr2d_status hr2di_scene_check_sky(hr2d_scene *scene, const hr2di_sky *sky);

/* The scene owns a valid sky from its hooks from now on. */
void hr2di_scene_take_sky(hr2d_scene *scene, const hr2di_sky *sky);

/* The scene gets a copy of a sky.  HR2D_OK, or a status with a message of the scene. */
hr2d_status hr2di_scene_copy_sky(hr2d_scene *scene, const hr2di_sky *sky);

void hr2di_sky_clear(hr2di_sky *sky, const hr2d_allocator *alloc);

/* What a row sends in a band more than the background. */
double hr2di_sky_beyond(const hr2d_scene *scene, size_t row, size_t band);

/* Bounds of the radiosity of the sky in a band, with the background: the largest and the least
   of constants. */
double hr2di_sky_max(const hr2d_scene *scene, size_t band);
double hr2di_sky_min(const hr2d_scene *scene, size_t band);

/* Whether end k of 2·pieces is an edge, at which the sky or a derivative of it may jump.  Of
   two pieces of a continuous sky that meet, it is that of the later one. */
int hr2di_sky_edge(const hr2d_scene *scene, size_t k, double *bearing);

/* The largest jump of the sky at a bearing over all bands, as a part of the largest radiosity
   of each, `max`. */
double hr2di_sky_jump(const hr2d_scene *scene, double bearing, const double *max);

/* The piece that has the light of a bearing; as many as there are pieces for the background. */
size_t hr2di_sky_piece_at(const hr2di_sky *sky, double bearing);

/* φ_l at a bearing of a piece. */
void hr2di_sky_terms_at(const hr2di_sky *sky, size_t piece, double bearing, double *phi);

/* A bearing in [0,360). */
double hr2di_sky_turned(double bearing);

/* The unit vector to a bearing, exact at multiples of 90 degrees. */
hr2d_point hr2di_sky_direction(double bearing);

/* A part of the front of a patch: sines of angles from its normal towards its end. */
typedef struct hr2di_sines {
  double low, high;
} hr2di_sines;

/* A piece as a patch sees it if nothing is in the way. */
typedef struct hr2di_sky_front {
  int parts; /* up to 2 */
  hr2di_sines part[2];
  double from[2];               /* the angle at which the piece begins for a part, radians */
  double size;                  /* of the piece, radians */
  double full[HR2DI_SKY_TERMS]; /* the factors of all parts together */
} hr2di_sky_front;

void hr2di_sky_front_of(const hr2d_scene *scene, size_t patch, size_t piece,
                        hr2di_sky_front *front);

/* Adds ½∫ φ_l cos φ dφ over what sines from `low` to `high` have in common with the parts of a
   piece. */
void hr2di_sky_add_factors(const hr2di_sky *sky, const hr2di_sky_front *front, double low,
                           double high, double *factor);

#endif
