/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the rounding of elements' coordinates may do to irradiance. */
#ifndef HR2D_SRC_ESTIMATE_COORDINATE_ROUNDING_H
#define HR2D_SRC_ESTIMATE_COORDINATE_ROUNDING_H

#include "solve/transport.h"

/* What is known of B. */
typedef struct hr2di_levels {
  const double *max;   /* |B| of elements at most, elements × bands */
  const double *own;   /* likewise what is left of it in H as it is told, see closure-mean.c */
  const double *light; /* radiosity of the background, per band */
} hr2di_levels;

/* error[0] += how much the irradiance of leaves may be off, leaves × bands; error[1] likewise
   for H as it is told.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_coordinates_add(const hr2di_transport *t, const hr2di_levels *levels,
                                  double *const error[2]);

#endif
