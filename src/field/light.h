/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light that a point gets from what it sees. */
#ifndef HR2D_SRC_FIELD_LIGHT_H
#define HR2D_SRC_FIELD_LIGHT_H

#include "field/light-sum.h"
#include "field/visibility-polygon.h"

/* Adds a stretch of the view from x. */
void hr2di_light_add(hr2di_light_sum *sum, const hr2di_polygon_arc *s);

/* Whether the sun of a band is seen in a direction from the right one on and before the left
   one; adds its light. */
int hr2di_light_has_sun(const hr2di_light_source *of, hr2d_point right, hr2d_point left,
                        size_t band);
void hr2di_light_add_sun(hr2di_light_sum *sum, size_t band);

/* B of the background, or of gas in front of it, which goes on for ever where nothing stands.
 */
double hr2di_light_sky(const hr2di_light_source *of, size_t band);

/* Adds `factor` times the light of the sky at a bearing between two directions. */
void hr2di_light_add_sky(hr2di_light_sum *sum, hr2d_point right, hr2d_point left, double angle,
                         double bearing, double factor);

#endif
