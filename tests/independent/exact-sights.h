/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which patches see each other, by all cells of the arrangement of lines through two of their
   ends: without a triangulation, a search, an area or a rounding. */
#ifndef HR2D_TESTS_INDEPENDENT_EXACT_SIGHTS_H
#define HR2D_TESTS_INDEPENDENT_EXACT_SIGHTS_H

#include <hr2d/geometry.h>
#include <stddef.h>

/* sees[i·n + j] becomes 1 if lines of a positive measure lead from the front of patch i to that
   of patch j, else 0.  Patches are black from behind.  They do not cross, and no two lie on one
   another but with opposite fronts and the same ends.  Coordinates are integers below 2^8. */
void exact_sights(const hr2d_segment *patch, size_t n, unsigned char *sees);

#endif
