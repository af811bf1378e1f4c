/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trees of a patch and of its images have the same elements. */
#ifndef HR2D_SRC_HIERARCHY_IMAGE_TREES_H
#define HR2D_SRC_HIERARCHY_IMAGE_TREES_H

#include "hierarchy/hierarchy-impl.h"

/* Divides what is divided on a patch or any of its images on all of them, with memory for at
   most `max` elements.  Returns HR2D_OK; or, with some elements more, HR2D_ENOMEM,
   HR2D_EMAX_ELEMENTS, HR2D_EMAX_BYTES or the status of the watch.  Without images nothing is
   done. */
hr2d_status hr2di_image_trees_unite(hr2d_hierarchy *hierarchy, size_t max, hr2di_watch *watch);

/* Sets of[e] to the element of which e is an image, itself if it is none.  Trees are united. */
hr2d_status hr2di_image_trees_map(const hr2d_hierarchy *hierarchy, uint32_t *of,
                                  hr2di_watch *watch);

/* Whether the image of a patch runs the other way. */
int hr2di_image_trees_turned(const hr2d_hierarchy *hierarchy, uint32_t element);

#endif
