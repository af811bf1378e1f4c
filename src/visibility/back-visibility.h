/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which patches may see backs: the black sides of walls that have a patch on the other side
   only. */
#ifndef HR2D_SRC_VISIBILITY_BACK_VISIBILITY_H
#define HR2D_SRC_VISIBILITY_BACK_VISIBILITY_H

#include <hr2d/scene.h>

#include "base/watch.h"

/* Makes *sees, per patch of a scene with a plane: 1 if the wall of the patch sees a back from
   the patch or from beside it, 0 if no point of the patch does.  *sees is NULL if there are no
   backs; it is from `alloc` and the caller's.  Threads as in options; no bit depends on them.
   HR2D_OK, HR2D_ENOMEM or the status of the watch.
   Cost: that of the triangles of the plane that beams from backs enter. */
hr2d_status hr2di_back_visibility(const hr2d_scene *scene, const hr2d_allocator *alloc,
                                  unsigned threads, unsigned char **sees, hr2di_watch *watch);

#endif
