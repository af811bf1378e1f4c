/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orientations of points whose coordinates lie too far apart for exact differences. */
#ifndef HR2D_SRC_GEOMETRY_ORIENT_EXACT_H
#define HR2D_SRC_GEOMETRY_ORIENT_EXACT_H

#include <hr2d/geometry.h>

#include "base/scaled-double.h"

/* (b−a)×(c−a) for any finite points.  The sign is exact, and the relative error is below
   1.001·2^-53. */
hr2di_scaled hr2di_orient_exact(hr2d_point a, hr2d_point b, hr2d_point c);

#endif
