/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums of the light that a point gets. */
#ifndef HR2D_SRC_FIELD_LIGHT_SUM_H
#define HR2D_SRC_FIELD_LIGHT_SUM_H

#include <math.h>

#include "field/light-source.h"
#include "geometry/vector.h"

/* The sums of one point, over stretches so far. */
typedef struct hr2di_light_sum {
  const hr2di_light_source *of;
  hr2d_point x; /* where the view is from */
  hr2di_watch *watch;
  double *mean;            /* per band: ∫ B dω */
  double *flux;            /* per band, x and y: ∫ B ω dω; NULL: not wanted */
  double *error;           /* per band: ∫ of the error of the patch or the leaf */
  double front, back, sky; /* angles */
  double clearance;        /* the square of how near an end of a stretch or a jump of B is */
} hr2di_light_sum;

/* ∫ ω dω between two directions. */
static inline hr2d_point hr2di_light_vector(hr2d_point right, hr2d_point left) {
  const hr2d_point u = hr2di_point_unit(right), v = hr2di_point_unit(left);
  return (hr2d_point){v.y - u.y, u.x - v.x};
}

static inline double hr2di_light_angle(hr2d_point right, hr2d_point left) {
  return atan2(hr2di_point_cross(right, left), hr2di_point_dot(right, left));
}

/* Adds a constant light that takes an angle, and ∫ ω dω of it is `vector`. */
static inline void hr2di_light_add_constant(hr2di_light_sum *sum, size_t band, double value,
                                            double angle, hr2d_point vector) {
  sum->mean[band] += value * angle;
  if (!sum->flux) return;
  sum->flux[2 * band] += value * vector.x;
  sum->flux[2 * band + 1] += value * vector.y;
}

#endif
