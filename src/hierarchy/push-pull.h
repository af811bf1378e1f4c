/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Push and pull: take fields of Legendre coefficients, order × bands per element, down and up
   the trees by the two-scale relation. */
#ifndef HR2D_SRC_HIERARCHY_PUSH_PULL_H
#define HR2D_SRC_HIERARCHY_PUSH_PULL_H

#include "base/watch.h"
#include "hierarchy/hierarchy-impl.h"

typedef struct hr2di_push_pull {
  const hr2d_hierarchy *hierarchy;
  hr2d_allocator alloc;
  hr2di_watch *watch; /* once it has stopped, fields have no meaning */
  size_t elements;    /* of the hierarchy when this was made */
  size_t order, bands;
  double *relation;  /* pairs of order × order matrices, for the left child and the right
                        one; pair 0 is for halves */
  uint32_t *pair_of; /* per element; NULL if all children are halves */
} hr2di_push_pull;

/* Returns HR2D_OK, HR2D_ENOMEM or the status of the watch; in any case the caller calls
   hr2di_push_pull_clear(). */
hr2d_status hr2di_push_pull_init(hr2di_push_pull *p, const hr2d_hierarchy *hierarchy,
                                 const hr2d_allocator *alloc, size_t order, size_t bands,
                                 hr2di_watch *watch);
void hr2di_push_pull_clear(hr2di_push_pull *p);

/* Pull: makes the values of every element with children from its children, leaves first.  At
   order 1 `spread` may give a factor per element, which a value takes on the way from the
   element to its parent or back; NULL: 1. */
void hr2di_push_pull_up(const hr2di_push_pull *p, const double *spread, double *field);

/* Push: adds to every element the values of all its ancestors.  This is the transpose of the
   pull in the scalar product Σ A x y. */
void hr2di_push_pull_down(const hr2di_push_pull *p, const double *spread, double *field);

/* Of an element with children, for the left child and then the right one: order × order
   numbers each, φ_l(element) = Σ_k relation[l·order + k] φ_k(child). */
const double *hr2di_push_pull_relation(const hr2di_push_pull *p, uint32_t element);

#endif
