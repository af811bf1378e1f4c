/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The caller's target, checked and complete. */
#ifndef HR2D_SRC_ACCURACY_TARGET_H
#define HR2D_SRC_ACCURACY_TARGET_H

#include <hr2d/accuracy.h>

/* Makes `used` from `given`, or from defaults if that is NULL.  A member that is 0 gets its
   default, `error` the given one, and `progress` the callback of the scene.  From then on an
   `error` of 0 means the smallest possible, `important` is a copy: sorted, each patch once,
   `threads` is their number, and `points` tells whether errors at points are measured.
   Returns HR2D_OK, HR2D_EINVAL or HR2D_ENOMEM; call hr2di_target_clear() in any case. */
hr2d_status hr2di_target_init(hr2d_target *used, const hr2d_scene *scene,
                              const hr2d_target *given, double default_error);
void hr2di_target_clear(hr2d_target *used, const hr2d_allocator *alloc);

#endif
