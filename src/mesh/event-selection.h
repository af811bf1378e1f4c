/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which visibility events matter: elements are divided at those that make most of the error. */
#ifndef HR2D_SRC_MESH_EVENT_SELECTION_H
#define HR2D_SRC_MESH_EVENT_SELECTION_H

#include "hierarchy/hierarchy-impl.h"
#include "mesh/events.h"

/* A coarse solution of the equation and of its adjoint, elements × bands: the radiosity B, and
   the importance, that is the effect of emission on an element on all averages that count; see
   importance.h. */
typedef struct hr2di_primal_dual {
  hr2d_hierarchy *trees; /* the elements */
  double *radiosity, *importance;
  double contrast; /* the least average of B or of H that counts, relative to the largest */
  int any_light;   /* elements are to do for all light with such a largest B */
} hr2di_primal_dual;

/* Divides leaves at events, first at those that cause the largest part of the error, until the
   events left inside elements cause no more than `allowed`.  `unresolved_jump` receives, for
   elements × bands, the mean size of the part of B that these events cause and that the
   polynomials of the leaf cannot represent, relative to the largest B; 0 for other elements.
   The allocator of the hierarchy makes this array; it is NULL without events.  The scene must
   have no background. HR2D_OK; or, with a part of the divisions done, HR2D_ENOMEM,
   HR2D_EMAX_ELEMENTS or the status of the watch. */
hr2d_status hr2di_events_select(hr2d_hierarchy *hierarchy, const hr2di_events *events,
                                const hr2di_primal_dual *lights, double allowed,
                                uint64_t max_elements, unsigned threads, hr2di_watch *watch,
                                double **unresolved_jump);

#endif
