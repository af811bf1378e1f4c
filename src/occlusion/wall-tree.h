/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A binary tree of boxes over walls. */
#ifndef HR2D_SRC_OCCLUSION_WALL_TREE_H
#define HR2D_SRC_OCCLUSION_WALL_TREE_H

#include "occlusion/walls.h"

/* A walk with a stack leaves one box behind per level.  The number of walls is halved at
   least every third level, see wall-tree.c. */
enum { HR2DI_BOX_DEPTH = 100 };

/* Fills walls->box, which has room; HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_wall_tree_init(hr2di_walls *walls, hr2di_watch *watch);

#endif
