/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop of ProjectKernel: which refused pairs are next. */
#ifndef HR2D_SRC_REFINE_ROUNDS_H
#define HR2D_SRC_REFINE_ROUNDS_H

#include "refine/projector.h"

/* The number of pairs on the stacks. */
size_t hr2di_rounds_waiting(const hr2di_projector *p);

/* Subdivides until no refused pair is left, or until at least `enough` are. */
hr2d_status hr2di_rounds_run(hr2di_projector *p, size_t enough);

/* Reports progress; returns the status of the callback. */
hr2d_status hr2di_rounds_report(hr2di_projector *p);

#endif
