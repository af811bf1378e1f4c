/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which leaves of an enclosure are halved. */
#ifndef HR2D_SRC_ENCLOSURE_ENCLOSURE_MARKS_H
#define HR2D_SRC_ENCLOSURE_ENCLOSURE_MARKS_H

#include "enclosure/enclosure-sweep.h"

/* Sets mark, one per element, to 1 for the leaves of patches that make most of the gap, as many
   as leave at most `max_links` links; *marked receives their number.  `scale` is, per band,
   what errors are relative to; 0: the band does not count.  HR2D_OK, HR2D_ENOMEM or the status
   of the watch. */
hr2d_status hr2di_enclosing_mark(hr2di_enclosing *e, const double *scale, uint64_t max_links,
                                 unsigned char *mark, size_t *marked);

#endif
