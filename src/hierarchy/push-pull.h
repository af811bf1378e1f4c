/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Push and pull: fields of Legendre coefficients, order × bands per element, down and up the
   trees by the two-scale relation. */
#ifndef HR2D_SRC_HIERARCHY_PUSH_PULL_H
#define HR2D_SRC_HIERARCHY_PUSH_PULL_H

#include "hierarchy/hierarchy-impl.h"

typedef struct hr2di_push_pull {
  const hr2d_hierarchy *hierarchy;
  hr2d_allocator alloc;
  size_t elements; /* of the hierarchy when this was made */
  size_t order, bands;
  double *relation;  /* pairs of order × order, for the left child and the right; pair 0 is
                        that of halves */
  uint32_t *pair_of; /* per element; NULL where all children are halves */
} hr2di_push_pull;

/* HR2D_OK or HR2D_ENOMEM; to be cleared in either case. */
hr2d_status hr2di_push_pull_init(hr2di_push_pull *p, const hr2d_hierarchy *hierarchy,
                                 const hr2d_allocator *alloc, size_t order, size_t bands);
void hr2di_push_pull_clear(hr2di_push_pull *p);

/* Elements with children get what these have together, from values on the leaves. */
void hr2di_push_pull_up(const hr2di_push_pull *p, double *field);

/* Adds to every element what those above it have. */
void hr2di_push_pull_down(const hr2di_push_pull *p, double *field);

#endif
