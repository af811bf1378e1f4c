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

/* The fraction of the patch at a fraction of the piece.  For the ends of the piece it is
   slightly inside, where a value belongs to this element only. */
static inline double leaves_at(const piece *p, double at) {
  return p->t0 + (1e-9 + (1 - 2e-9) * at) * (p->t1 - p->t0);
}

/* Is called for each piece; a value other than 0 ends the walk. */
typedef int (*piece_fn)(void *ctx, const piece *p);

/* Walks over the leaves of a patch.  Elements no longer than `finest` count as leaves; `finest`
   is in element units, 0 for none.  Returns 0, EXIT_FAILED, or the value of visit that ended
   the walk. */
int leaves_walk(const hr2d_hierarchy *hierarchy, size_t patch, double finest, piece_fn visit,
                void *ctx);

#endif
