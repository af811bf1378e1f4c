/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The leaves of a solution along each patch, for calls that meet them often. */
#ifndef HR2D_SRC_FIELD_LEAVES_H
#define HR2D_SRC_FIELD_LEAVES_H

#include "hierarchy/hierarchy-impl.h"
#include "solution/solution-impl.h"

/* The least order of merged leaves. */
enum { HR2DI_LEAVES_ORDER = 5 };

typedef struct hr2di_leaf {
  double from;      /* the fraction of the patch where it begins */
  uint32_t element; /* which may have children that are younger than the solution */
  float level;      /* the average of B, and how far B is from it, at most, as parts of the */
  float varies;     /* largest coefficient of the band; the largest over bands */
} hr2di_leaf;

typedef struct hr2di_leaves {
  hr2d_allocator alloc;
  size_t order;        /* of the polynomials below */
  const double *value; /* element by element: those of the solution, or: */
  double *raised;     /* B on every element, as near as polynomials of a higher order are; NULL:
                         not made */
  double *difference; /* per element: how much B differs from its polynomial, at most, as a part
                         of what is allowed; NULL: nothing is */
  hr2di_leaf *leaf;   /* patch by patch, and along each patch */
  size_t leaves, room;
  uint32_t *group; /* of each leaf; neighbours in one group differ by little where they meet; or
                      NULL */
  size_t *of_patch; /* the leaves of patch k are [of_patch[k], of_patch[k + 1]) */
  double *scale;    /* per band: the largest coefficient */
} hr2di_leaves;

/* With `max` leaves are merged: an element takes their place from which B differs by at most
   max[b] in band b.  Its polynomial has HR2DI_LEAVES_ORDER coefficients at least, so that it
   stands for many leaves of a lower order.  NULL: all are kept.  HR2D_OK, HR2D_ENOMEM or the
   status of the watch; to be ended by hr2di_leaves_clear() in any case. */
hr2d_status hr2di_leaves_init(hr2di_leaves *l, const hr2d_solution *solution, const double *max,
                              hr2di_watch *watch);
void hr2di_leaves_clear(hr2di_leaves *l);

/* Makes groups: B jumps by at most `max` of a band between leaves of one group.  HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_leaves_group(hr2di_leaves *l, size_t bands, const double *max,
                               hr2di_watch *watch);

/* The average of B on an element, and how far its polynomial is from that, at most: as parts of
   the largest coefficient of the band, the largest over bands. */
void hr2di_leaves_measure(const hr2di_leaves *l, size_t bands, uint32_t element, float *level,
                          float *varies);

/* The end of a leaf as a fraction of its patch. */
static inline double hr2di_leaf_end(const hr2di_leaves *l, size_t patch, size_t leaf) {
  return leaf + 1 < l->of_patch[patch + 1] ? l->leaf[leaf + 1].from : 1;
}

/* The leaf of a patch with a fraction of it. */
size_t hr2di_leaf_at(const hr2di_leaves *l, size_t patch, double at);

#endif
