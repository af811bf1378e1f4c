/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trees of both sides of a pane have the same elements: what falls on one side leaves the
   other, with its kinks. */
#ifndef HR2D_SRC_HIERARCHY_PANE_TREES_H
#define HR2D_SRC_HIERARCHY_PANE_TREES_H

#include "hierarchy/hierarchy-impl.h"

/* Divides what is divided on one side of a pane on the other side, too, with memory for at most
   `max` elements.  Returns HR2D_OK; or, with some elements more, HR2D_ENOMEM,
   HR2D_EMAX_ELEMENTS, HR2D_EMAX_BYTES, the status of the watch, or HR2D_EUNSUPPORTED if a
   caller has divided the sides at different places.  Without panes nothing is done. */
hr2d_status hr2di_pane_trees_unite(hr2d_hierarchy *hierarchy, size_t max, hr2di_watch *watch);

/* Sets other[e] to the element on the other side of a pane, and to e itself elsewhere.
   HR2D_OK, HR2D_ENOMEM, the status of the watch, or HR2D_ESTATE if trees are not united. */
hr2d_status hr2di_pane_trees_map(const hr2d_hierarchy *hierarchy, uint32_t *other,
                                 const hr2d_allocator *alloc, hr2di_watch *watch);

#endif
