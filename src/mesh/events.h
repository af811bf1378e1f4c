/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Visibility events: points where radiosity along a patch is not smooth, because something
   comes into view or goes out of view.

   An event is a point where the line through two vertices meets the patch.  Seen from it, one
   vertex, the end of a source, is exactly behind the other, the end of something in the way;
   or both are the ends of one patch, and the line is its horizon.  The foot of a patch that
   ends on the front is an event, too.  Between two events of generation 1 the same things are
   seen in the same order.  On a pane the other side has an event at the same place.  There are
   no events on patches that no light reaches; events on
   patches that do not reflect have no successors. */
#ifndef HR2D_SRC_MESH_EVENTS_H
#define HR2D_SRC_MESH_EVENTS_H

#include <hr2d/scene.h>
#include <hr2d/share.h>
#include <stdint.h>

#include "base/watch.h"

typedef struct hr2di_event {
  uint32_t patch;
  double at;           /* fraction of the patch, inside (0,1) */
  unsigned generation; /* 0: a border of sunlight, where B itself jumps; 1: both vertices are of
                          the scene, or one of them is such a border; 2: an event of generation
                          1 takes the place of the source's end; … */
  uint32_t origin;     /* of generation 2 and later: the patch of that event, and its place */
  double origin_at;
  hr2d_point past; /* the vertex on the line that is nearest, in coordinates of
                      hr2di_patch::scaled; of a foot its own place */
  int passed;    /* it is one of the other side, which is its origin, of the same generation */
  double spread; /* where B has a jump at the end of the source, or a derivative of B at the
                    origin, that is so many times as large in the next derivative of H here */
} hr2di_event;

typedef struct hr2di_events {
  hr2d_allocator alloc;
  hr2di_event *event; /* sorted by patch, then by fraction; no two equal within rounding */
  size_t count, capacity;
  uint64_t steps; /* triangles that were entered to find them, by this share */
} hr2di_events;

/* Finds all events up to `generations`, which may be 0, of a committed scene, at most `max` of
   them.  There are none if the scene calls neither for occlusion nor for facing nor for a
   background; forced effects do not count.  Returns HR2D_OK, HR2D_ENOMEM, the status of the
   watch, or HR2D_EMAX_ELEMENTS if there are more than `max`.  Call hr2di_events_clear() in any
   case. It takes beams through the triangles of the plane from each end of a patch, and in
   later generations from each event: the cost is that of the triangles which they enter, 0.01
   to 0.1 µs each.  These are as many as the ends that are seen, and those passed on the way; a
   scene without the effect of occlusion gets its plane first, in O(n log n).  Of several shares
   each looks from its part of the ends and events; all get all of them, as one process does.
   Then the status of another share is one more, and failures are to be agreed on. */
hr2d_status hr2di_events_init(hr2di_events *events, const hr2d_scene *scene,
                              const hr2d_allocator *alloc, unsigned generations, size_t max,
                              hr2d_share *share, hr2di_watch *watch);
void hr2di_events_clear(hr2di_events *events);

#endif
