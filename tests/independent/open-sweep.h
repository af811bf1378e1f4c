/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a point between patches sees all round, by brute force: as the sweep from a point of a
   patch, but with angles from −π to π of the first axis, and with a ray for each span. */
#ifndef HR2D_TESTS_INDEPENDENT_OPEN_SWEEP_H
#define HR2D_TESTS_INDEPENDENT_OPEN_SWEEP_H

#include "independent/point-sweep.h"

/* All directions, in rising order; `span` has room for 2·count + 2.  Returns how many there
   are.  The point touches no patch. */
size_t open_sweep(const sweep_patches *p, spot x, sweep_span *span);

/* Where a ray from x meets the line of a patch, as a fraction of the patch. */
real open_sweep_place(const sweep_patches *p, size_t patch, spot x, real angle);

/* How near x is to a patch. */
real open_sweep_clearance(const sweep_patches *p, spot x);

#endif
