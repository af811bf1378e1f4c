/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The jumps of H at visibility events, from B and from its importance.

   Before an event is looked at there are bounds: B itself jumps by no more than its largest
   value.  Where x passes the line of a thin wall, both of its sides come into view, and the
   jump may be twice as large.  A look gives the jump: a second difference of what a point sees
   close beside the vertex, with the B of the element that the line past the vertex meets: on
   a long patch that may be many times the B of the patch.  The rest of the view is smooth
   there.  Where the light may be any, the bounds stay. */
#ifndef HR2D_SRC_MESH_DERIVATIVE_JUMPS_H
#define HR2D_SRC_MESH_DERIVATIVE_JUMPS_H

#include "mesh/event-selection.h"
#include "visibility/point-view.h"

typedef struct hr2di_jump_worker hr2di_jump_worker;

typedef struct hr2di_derivative_jumps {
  const hr2d_scene *scene;
  const hr2di_events *events;
  const hr2di_primal_dual *lights;
  const hr2d_allocator *alloc;
  size_t bands;
  hr2di_watch *watch;
  double *max;          /* 2·bands: the largest B, and the largest importance */
  double *jump;         /* events × 2·bands: of H from B, and from the importance, or more */
  unsigned char *known; /* per event: nothing is left to find out */
  size_t *wanted;       /* events to look at */
  size_t count;         /* of these */
  hr2di_jump_worker *observer; /* one for each thread */
  size_t observers;
} hr2di_derivative_jumps;

/* Sets bounds.  HR2D_OK, HR2D_ENOMEM or the status of the watch; to be cleared in any case. */
hr2d_status hr2di_derivative_jumps_init(hr2di_derivative_jumps *jumps, const hr2d_scene *scene,
                                        const hr2di_events *events,
                                        const hr2di_primal_dual *lights, unsigned threads,
                                        const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_derivative_jumps_clear(hr2di_derivative_jumps *jumps);

/* Replaces the bounds of an event by its jumps. */
hr2d_status hr2di_derivative_jumps_know(hr2di_derivative_jumps *jumps, size_t event);

/* The same for many events with all threads: those that were asked for are looked at when
   hr2di_derivative_jumps_look() is called.  Then hr2di_derivative_jumps_know() has nothing left
   to look at.
 */
void hr2di_derivative_jumps_want(hr2di_derivative_jumps *jumps, size_t event);
hr2d_status hr2di_derivative_jumps_look(hr2di_derivative_jumps *jumps);

/* The first event that is not before a place. */
size_t hr2di_derivative_jumps_find(const hr2di_events *events, uint32_t patch, double at);

#endif
