/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the rounding of elements' coordinates may do to irradiance. */
#ifndef HR2D_SRC_ACCURACY_COORDINATE_ROUNDING_H
#define HR2D_SRC_ACCURACY_COORDINATE_ROUNDING_H

#include "solve/transport.h"

/* error += how much the irradiance of leaves may be off, leaves × bands; |B| of elements is at
   most `most`, elements × bands, and the background has radiosity `light` per band. HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_coordinates_add(const hr2di_transport *t, const double *most,
                                  const double *light, double *error);

#endif
