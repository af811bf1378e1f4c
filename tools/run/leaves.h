/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elements of one patch from its start to its end. */
#ifndef HR2D_TOOLS_RUN_LEAVES_H
#define HR2D_TOOLS_RUN_LEAVES_H

#include <hr2d/hr2d.h>

/* An element and the fractions of its patch between which it lies. */
typedef struct piece {
  uint32_t element;
  unsigned level;
  double t0, t1;
} piece;

/* The fraction of the patch at a fraction of the piece.  Its ends stay inside, where a value
   belongs to this element alone. */
static inline double inside(const piece *p, double at) {
  return p->t0 + (1e-9 + (1 - 2e-9) * at) * (p->t1 - p->t0);
}

/* Is called for each piece; anything but 0 ends the walk. */
typedef int (*piece_fn)(void *ctx, const piece *p);

/* Walks over the leaves of a patch, taking elements no longer than `finest` (in element
   units; 0 for none) as if they were leaves.  Returns 0, EXIT_FAILED, or what visit did. */
int walk_leaves(const hr2d_hierarchy *hierarchy, size_t patch, double finest, piece_fn visit,
                void *ctx);

#endif
