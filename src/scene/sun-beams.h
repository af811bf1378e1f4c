/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parallel light through the plane of a scene: which part of which patch it meets first. */
#ifndef HR2D_SRC_SCENE_SUN_BEAMS_H
#define HR2D_SRC_SCENE_SUN_BEAMS_H

#include <hr2d/scene.h>

#include "beams/triangular-expansion.h"

/* Takes a part of a patch's front that is lit, fractions of the patch, from < to.  HR2D_OK, or
   a status that ends the walk. */
typedef hr2d_status (*hr2di_lit_fn)(void *ctx, uint32_t patch, double from, double to);

/* Work space, kept from walk to walk; what is not set is 0. */
typedef struct hr2di_sun_beams {
  const hr2d_scene *scene; /* with a plane */
  hr2d_allocator alloc;
  hr2di_watch *watch;
  hr2di_lit_fn take;
  void *ctx;
  hr2d_point direction;               /* of the light, its larger component in [1,2) */
  hr2di_triangular_expansion between; /* two lines through vertices */
} hr2di_sun_beams;

/* Walks all light of direction `direction`, which is finite and not 0, into the scene.  Parts
   come in an order that is undefined; they may touch, where a vertex lies on a border of the
   light, and overlap by roundings only.  HR2D_OK, HR2D_ENOMEM, the status of the watch or of
   `take`.

   Cost: that of the triangles of the plane that are entered, once for each beam. */
hr2d_status hr2di_sun_beams_walk(hr2di_sun_beams *b, hr2d_point direction);

/* Ends the use of the work space. */
void hr2di_sun_beams_clear(hr2di_sun_beams *b);

/* The part of the light across its direction that falls on the front of a segment per length:
   −way·normal for a unit vector `direction`; below 0 for light on its back. */
double hr2di_sun_cosine(hr2d_point direction, hr2d_segment s);

#endif
