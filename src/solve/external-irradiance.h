/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The irradiance of leaves by light from outside of the scene. */
#ifndef HR2D_SRC_SOLVE_EXTERNAL_IRRADIANCE_H
#define HR2D_SRC_SOLVE_EXTERNAL_IRRADIANCE_H

#include "solve/transport.h"

/* Whether leaves need the form factor of the background: it has light, or the effect is forced.
 */
int hr2di_external_wants_sky(const hr2d_scene *scene);

/* Whether the sky has pieces, and the scene light from outside. */
int hr2di_external_has_pieces(const hr2d_scene *scene);

/* Sets `field`, leaves × order × bands, to the irradiance from the background, with `light` per
   band, from the suns, and from the pieces of the sky as far as these differ from the
   background; all are divided by 2^exponent of the band.  HR2D_OK, HR2D_ENOMEM or the status of
   the watch. */
hr2d_status hr2di_external_set(const hr2di_transport *t, const double *light,
                               const int *exponent, double *field);

#endif
