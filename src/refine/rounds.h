/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop of ProjectKernel: which refused pairs are next. */
#ifndef HR2D_SRC_REFINE_ROUNDS_H
#define HR2D_SRC_REFINE_ROUNDS_H

#include "refine/projector.h"

/* The number of pairs on the stacks. */
size_t hr2di_rounds_waiting(const hr2di_projector *p);

/* Subdivides until no refused pair is left, or until at least `enough` are. */
hr2d_status hr2di_rounds_run(hr2di_projector *p, size_t enough);

/* Measures the part of the root pairs that is done: between two rounds, as during one some
   pairs are on no stack. */
void hr2di_rounds_measure(hr2di_projector *p);

/* Describes the progress of a projector, for its watch. */
void hr2di_rounds_describe(void *projector, hr2d_progress *report);

#endif
