/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether points of a patch see a front at all. */
#ifndef HR2D_SRC_VISIBILITY_SEES_ANYTHING_H
#define HR2D_SRC_VISIBILITY_SEES_ANYTHING_H

#include <hr2d/scene.h>

#include "visibility/point-view.h"

/* Looks from nine points of a patch, until one of them sees a front, or with `sky` the sky.  Of
   a viewer of a scene with a plane and the effect of occlusion.  HR2D_OK, HR2D_ENOMEM or the
   status of the watch.  Cost: the way of the first ray that is looked along, in most scenes. */
hr2d_status hr2di_sees_anything(hr2di_viewer *viewer, size_t patch, int sky, int *sees);

#endif
