/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of ProjectKernel for occluded pairs: those with walls in the way. */
#ifndef HR2D_SRC_REFINE_OCCLUDED_PAIRS_H
#define HR2D_SRC_REFINE_OCCLUDED_PAIRS_H

#include "refine/projector.h"

/* Proposes up to HR2DI_CANDIDATES pairs of patches, occluded or not. */
hr2d_status hr2di_occluded_propose_roots(hr2di_projector *p, const hr2d_pair *pairs,
                                         size_t count);

/* Looks round from a patch, as the first pair of patches in its row that needs it does. Returns
   HR2D_OK, or the status that stops the refinement. */
hr2d_status hr2di_occluded_trace(hr2di_projector *p, uint32_t from, uint32_t to);

/* Appends to p->found what a pair of elements sees of each other. */
hr2d_status hr2di_occluded_collect(hr2di_projector *p, hr2d_pair pair,
                                   hr2di_visibility_class *view);

/* Puts a refused pair that has walls in the way on the stack. */
hr2d_status hr2di_occluded_push(hr2di_projector *p, hr2d_pair pair);

/* Puts pair number k of another stack on this one, with its line classes. */
hr2d_status hr2di_occluded_share(hr2di_projector *p, const hr2di_occluded_pairs *from,
                                 size_t k);

/* Subdivides the topmost occluded pair, or links it if a limit holds. */
hr2d_status hr2di_occluded_round(hr2di_projector *p);

/* The exchange area of a pair, in units of the scene, past all walls of the scene; 0 and
   HR2DI_BLOCKED in *view if nothing passes.  Returns HR2D_OK, HR2D_ENOMEM or the status of the
   watch. */
hr2d_status hr2di_occluded_area(hr2di_pair_visibility *visibility,
                                const hr2d_hierarchy *hierarchy, hr2d_pair pair, double *area,
                                hr2di_visibility_class *view);

#endif
