/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which visibility events matter: elements are divided at those that make most of the error. */
#ifndef HR2D_SRC_MESH_EVENT_SELECTION_H
#define HR2D_SRC_MESH_EVENT_SELECTION_H

#include "hierarchy/hierarchy-impl.h"
#include "mesh/events.h"

/* The light of patches, patches × bands: B, and that of the adjoint equation, which is what a
   light on the patch does to all errors together; see importance.h. */
typedef struct hr2di_primal_dual {
  double *radiosity, *importance;
  double contrast; /* the least average of B or of H that counts, relative to the largest */
} hr2di_primal_dual;

/* Divides leaves at events, those that make the largest part of the error first, until the
   events inside elements make no more than `allowed`.  `unresolved_jump` receives, for elements
   × bands, what the events that are left inside a leaf make of B beyond its polynomials, in the
   mean; 0 for other elements.  The scene has no background.  It is from the hooks of the
   hierarchy, and NULL without events. HR2D_OK; or, with a part of the divisions done,
   HR2D_ENOMEM, HR2D_EMAX_ELEMENTS or the status of the watch. */
hr2d_status hr2di_events_select(hr2d_hierarchy *hierarchy, const hr2di_events *events,
                                const hr2di_primal_dual *lights, double allowed,
                                uint64_t max_elements, unsigned threads, hr2di_watch *watch,
                                double **unresolved_jump);

#endif
