/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refinement with what no public option says. */
#ifndef HR2D_SRC_REFINE_REFINE_HOW_H
#define HR2D_SRC_REFINE_REFINE_HOW_H

#include <hr2d/refine.h>

#include "links/row-pieces.h"
#include "visibility/beam-cache.h"

/* All 0: as hr2d_refine() does it. */
typedef struct hr2di_refine_how {
  const hr2di_row_pieces *pieces; /* which links are kept; NULL: all of the rows */
  hr2di_beam_cache *beam_cache; /* keeps what patches see; NULL: each that looks walks beams */
} hr2di_refine_how;

/* hr2d_refine() and hr2d_refine_count(). */
hr2d_status hr2di_refine(hr2d_linkset *links, const hr2di_refine_how *how,
                         const hr2d_refine_options *options);
hr2d_status hr2di_refine_count(hr2d_linkset *links, const hr2di_refine_how *how,
                               const hr2d_refine_options *options, hr2d_refine_counts *counts);

#endif
