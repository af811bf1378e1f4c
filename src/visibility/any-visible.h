/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether points of a patch see a front or the sky at all, and which back. */
#ifndef HR2D_SRC_VISIBILITY_ANY_VISIBLE_H
#define HR2D_SRC_VISIBILITY_ANY_VISIBLE_H

#include <hr2d/scene.h>

#include "scene/side-parts.h"
#include "visibility/point-view.h"

/* What is looked for: fronts of patches, and the sky. */
enum { HR2DI_ANY_FRONTS = 1, HR2DI_ANY_SKY = 2 };

/* Looks from nine points of a patch, until one of them sees some of `what`.  Of a viewer of a
   scene with a plane and the effect of occlusion.  HR2D_OK, HR2D_ENOMEM or the status of the
   watch.  Cost: the way of the first ray that is looked along, in most scenes. */
hr2d_status hr2di_any_visible(hr2di_point_viewer *viewer, size_t patch, unsigned what,
                              int *sees);

/* The patch whose back is seen from the middle of another one, if backs are `min` of what is
   seen there or more: the one that is most of it.  Else HR2DI_NOBODY. */
hr2d_status hr2di_sees_back(hr2di_point_viewer *viewer, size_t patch, double min,
                            uint32_t *back);

#endif
