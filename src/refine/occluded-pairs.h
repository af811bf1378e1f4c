/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of ProjectKernel that sees walls: pairs with something in the way. */
#ifndef HR2D_SRC_REFINE_OCCLUDED_PAIRS_H
#define HR2D_SRC_REFINE_OCCLUDED_PAIRS_H

#include "refine/projector.h"

/* Proposes up to HR2DI_CANDIDATES pairs of patches. */
hr2d_status hr2di_occluded_propose_roots(hr2di_projector *p, const hr2d_pair *pairs,
                                         size_t count);

/* Looks for walls in the way of a pair of elements, of all in the scene. */
hr2d_status hr2di_occluded_collect(hr2di_projector *p, hr2d_pair pair,
                                   hr2di_visibility_class *view);

/* Takes a refused pair that has walls in the way. */
hr2d_status hr2di_occluded_push(hr2di_projector *p, hr2d_pair pair);

/* Takes pair number k of another's, with its walls. */
hr2d_status hr2di_occluded_share(hr2di_projector *p, const hr2di_occluded_pairs *from,
                                 size_t k);

/* Subdivides the topmost pair in the shade, or links it where a limit holds. */
hr2d_status hr2di_occluded_round(hr2di_projector *p);

/* The exchange area of a pair with walls in the way, in units of the scene, its walls
   found anew; *view is HR2DI_BLOCKED where nothing passes.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_occluded_area(hr2di_visibility *visibility, const hr2d_hierarchy *hierarchy,
                                hr2d_pair pair, double *area, hr2di_visibility_class *view);

#endif
