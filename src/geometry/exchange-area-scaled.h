/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas of segments whose coordinates are very large, very small or of
   very different scales. */
#ifndef HR2D_SRC_GEOMETRY_EXCHANGE_AREA_SCALED_H
#define HR2D_SRC_GEOMETRY_EXCHANGE_AREA_SCALED_H

#include <hr2d/geometry.h>

/* The same formulas as in exchange-area.c, for any finite coordinates. */
double hr2di_exchange_area_scaled(const hr2d_segment *i, const hr2d_segment *j);

#endif
