/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Row sums: the part of all directions in which a leaf sees patches, and the part in which it
   sees their backs. */
#ifndef HR2D_SRC_SOLVE_ROW_SUMS_H
#define HR2D_SRC_SOLVE_ROW_SUMS_H

#include "solve/transport.h"

typedef struct hr2di_row_sums {
  const hr2d_hierarchy *hierarchy;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  double *front;         /* per element, set for leaves: ∫ G V over all patches, at most 1 */
  double *back;          /* the same over the backs of patches that have a front only; NULL if
                            not asked for */
  unsigned char *closed; /* per patch: nonzero if its leaves see patches in every direction */
  uint64_t leaves;       /* the number of leaves whose sums were integrated */
} hr2di_row_sums;

/* Computes the exact sums of the leaves of all patches that light reaches.  They are 1 on a
   patch whose links leave no opening; on other patches they are integrated.  `backs`: also over
   backs.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch.  Call hr2di_row_sums_clear()
   in any case. */
hr2d_status hr2di_row_sums_init(hr2di_row_sums *rows, const hr2di_transport *transport,
                                int backs);
void hr2di_row_sums_clear(hr2di_row_sums *rows);

#endif
