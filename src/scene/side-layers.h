/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which of the walls that share an edge of the triangulation is in front of which. */
#ifndef HR2D_SRC_SCENE_SIDE_LAYERS_H
#define HR2D_SRC_SCENE_SIDE_LAYERS_H

#include "scene/side-parts.h"

/* Each edge has the parts of its own wall.  After this, an edge that triangles know has the
   parts of the outermost walls on its two sides; the parts between walls are hidden and have
   contacts.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_side_layers_settle(hr2di_side_parts *parts, const hr2d_scene *scene,
                                     const hr2di_triangulation *t, hr2di_watch *watch);

#endif
