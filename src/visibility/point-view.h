/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view from a point of a patch: which part of which patch it sees in which direction. */
#ifndef HR2D_SRC_VISIBILITY_POINT_VIEW_H
#define HR2D_SRC_VISIBILITY_POINT_VIEW_H

#include <hr2d/scene.h>
#include <stdint.h>

#include "base/watch.h"

/* A part of a patch's front, all of it seen from the point with nothing in between. */
typedef struct hr2di_visible_interval {
  uint32_t patch;
  double from, to; /* of the patch, fractions of its length from its start, from < to */
  double sine;     /* ½ |sin θ_from − sin θ_to|, θ measured from the normal at the point:
                      the form factor from the point to the part; > 0 */
} hr2di_visible_interval;

/* Work space of one thread, and the last view. */
typedef struct hr2di_point_viewer hr2di_point_viewer;

/* For a committed scene.  HR2D_OK or HR2D_ENOMEM.  Costs nothing: what viewers share is the
   scene's. */
hr2d_status hr2di_point_viewer_create(const hr2d_scene *scene, const hr2d_allocator *alloc,
                                      hr2di_watch *watch, hr2di_point_viewer **viewer);
void hr2di_point_viewer_destroy(hr2di_point_viewer *viewer);

typedef struct hr2di_view_from {
  const hr2di_visible_interval *interval; /* by patch, and along each patch from its start to
                                   its end; owned by the viewer, valid until its next call */
  size_t count;
  double front; /* Σ visible interval.sine: the row sum at the point, at most 1 */
  double back;  /* the same for backs of patches that have a front only, which are black
                   and opaque */
  double sky;   /* 1 − front − back, at least 0: the form factor of the background */
  const double (*arc)[2]; /* of the sky, where that has pieces or a period is cut off: sines
                             from low to high; the viewer's, as the visible intervals */
  size_t arcs;
} hr2di_view_from;

/* The view from fraction t in [0,1] of patch `patch`.  Returns HR2D_OK, HR2D_ENOMEM or the
   status of the watch.

   The angle of a patch that touches the point is undefined.  Then the view is that of the
   points next to it, towards the middle of `patch`.  A patch that touches the point covers the
   directions from its own direction to the line of `patch`.  Its part is all of it that is not
   behind, although rays in these directions have no length.

   If an angle covers less of a patch than a rounding, its part is as short as fractions can
   express, and its sine is right.  Fractions are accurate to 1e-15, sines to relative 1e-14
   and 2^-104; patches under an angle of less than 2^-100 may be missed.  Where something can be
   in the way, the walls are where the plane of the scene has them, and what is a rounding of
   coordinates behind another patch sees nothing but backs.
   Cost: if no patch can be in the way of another O(n), or O(n log n) where backs are in front;
   else that of the triangles of the plane that the view passes. */
hr2d_status hr2di_view_at(hr2di_point_viewer *viewer, size_t patch, double t,
                          hr2di_view_from *seen);

/* The part of that view between the rays through two places, border[0] on the right of
   border[1], in coordinates of hr2di_patch::scaled; `sky` has all the rest.  It enters the
   triangles between the rays only, and may leave fractions of patches unset.  It is the whole
   view where a place is not in front of the patch, or where nothing can be in the way. */
hr2d_status hr2di_view_between(hr2di_point_viewer *viewer, size_t patch, double t,
                               const hr2d_point border[2], hr2di_view_from *seen);

#endif
