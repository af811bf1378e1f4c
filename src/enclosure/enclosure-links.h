/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Links of an enclosure: what two leaves exchange, as ranges. */
#ifndef HR2D_SRC_ENCLOSURE_ENCLOSURE_LINKS_H
#define HR2D_SRC_ENCLOSURE_ENCLOSURE_LINKS_H

#include "enclosure/enclosure-factors.h"
#include "links/linkset-impl.h"

/* Of elements first and second, or of those that these are images of.  Factors are F(x,j) over
   x on the element with this index, 0 for first, from its start to its end as a part of the
   patch that it is an image of; all in units of the elements' coordinates. */
typedef struct hr2di_enclosed_link {
  uint32_t of[2];
  hr2di_strip factor[2];
  hr2di_range area; /* of the exchange area */
  double spread;    /* of the kernel; infinite where it is not known */
} hr2di_enclosed_link;

/* The links of a set between leaves, all of it.  `original` as from hr2d_hierarchy_originals(),
   NULL without images. */
void hr2di_enclosed_links_make(const hr2d_linkset *links, const uint32_t *original,
                               uint64_t first, size_t count, hr2di_enclosed_link *out);

#endif
