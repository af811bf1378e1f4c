/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What counts of a link while a check of the extrapolation is gathered. */
#ifndef HR2D_SRC_SOLVE_BLOCK_PART_H
#define HR2D_SRC_SOLVE_BLOCK_PART_H

#include "solve/transport.h"

/* The part of a link that counts: 1, or what t->check leaves of it. */
double hr2di_link_part(const hr2di_transport *t, hr2d_pair pair);

/* Block k, that of `link`, as it counts: where it is stored, or in `room` if it is of floats,
   is stored in two parts, or t->check leaves a part of it; NULL for nothing. */
const double *hr2di_block_part(const hr2di_transport *t, const hr2d_link *link, uint64_t k,
                               double *room);

#endif
