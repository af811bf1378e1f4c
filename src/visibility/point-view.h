/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a point of a patch sees: which part of which patch in which direction. */
#ifndef HR2D_SRC_VISIBILITY_POINT_VIEW_H
#define HR2D_SRC_VISIBILITY_POINT_VIEW_H

#include <hr2d/scene.h>
#include <stdint.h>

/* A part of a patch's front, all of it seen from the point with nothing in between. */
typedef struct hr2di_glimpse {
  uint32_t patch;
  double from, to; /* of the patch, fractions of its length from its start, from < to */
  double sine;     /* ½ |sin θ_from − sin θ_to|, θ measured from the normal at the point:
                      the form factor from the point to the part; > 0 */
} hr2di_glimpse;

/* Work space of one thread, and what was seen last. */
typedef struct hr2di_viewer hr2di_viewer;

/* For a committed scene; HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_viewer_create(const hr2d_scene *scene, const hr2d_allocator *alloc,
                                hr2di_viewer **viewer);
void hr2di_viewer_destroy(hr2di_viewer *viewer);

typedef struct hr2di_view_from {
  const hr2di_glimpse *glimpse; /* patch by patch, those of one from its start to its end; of
                                   the viewer, until its next call */
  size_t count;
  double front; /* Σ glimpse.sine: the row sum at the point, at most 1 */
  double back;  /* the same for backs of patches that have a front only, which are black
                   and opaque */
  double sky;   /* 1 − front − back: where the background is seen, at least 0 */
} hr2di_view_from;

/* What fraction t in [0,1] of patch `patch` sees; HR2D_OK or HR2D_ENOMEM.

   Where a patch touches the point it has no angle, or any: then the view is what points next
   to it see, towards the middle of `patch`.  Such a patch covers the directions from its own
   to the line of `patch`, and its part is all of it that is not behind, though rays in these
   directions end where they began.

   An angle that takes less of a patch than a rounding has a part as short as fractions can
   tell, and the right sine.  Fractions are good to 1e-15, sines to relative 1e-14 and
   2^-104; patches under an angle of less than 2^-100 may be missed.
   O(n) where no patch can be in the way of another, else O(n log n). */
hr2d_status hr2di_view_at(hr2di_viewer *viewer, size_t patch, double t, hr2di_view_from *seen);

#endif
