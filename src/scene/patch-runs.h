/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs: the patches along one side of a wall, in the order of their common direction. */
#ifndef HR2D_SRC_SCENE_PATCH_RUNS_H
#define HR2D_SRC_SCENE_PATCH_RUNS_H

#include <hr2d/scene.h>
#include <stddef.h>
#include <stdint.h>

#include "base/watch.h"

typedef struct hr2di_run {
  uint32_t first, last; /* items [first, last) of hr2di_runs::patch */
} hr2di_run;

typedef struct hr2di_runs {
  hr2d_allocator alloc;
  uint32_t *patch;
  hr2di_run *run;
  size_t runs;
} hr2di_runs;

/* Makes the runs of a committed scene.  Returns HR2D_OK, HR2D_ENOMEM or the status of the
   watch; in any case the caller calls hr2di_runs_clear(). */
hr2d_status hr2di_runs_init(hr2di_runs *runs, const hr2d_scene *scene, hr2di_watch *watch);
void hr2di_runs_clear(hr2di_runs *runs);

#endif
