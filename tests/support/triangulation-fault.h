/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a triangulation is whole. */
#ifndef HR2D_TESTS_SUPPORT_TRIANGULATION_FAULT_H
#define HR2D_TESTS_SUPPORT_TRIANGULATION_FAULT_H

#include "triangulation/triangulation.h"

/* Returns what is wrong, or NULL: all triangles are counterclockwise and fill the box; what is
   across an edge leads back and has the same ends; triangles know the edges of walls; the edges
   of a wall follow each other from end to end, and no vertex lies on the inside of one. `first`
   and `stride` are the walls it was made of; the path of each may be off its line and its ends
   by at most `off`. */
const char *triangulation_fault(const hr2di_triangulation *t, const hr2d_segment *first,
                                size_t stride, double off);

#endif
