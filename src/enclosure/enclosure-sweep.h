/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranges of B and H on leaves, and the sweep that narrows them. */
#ifndef HR2D_SRC_ENCLOSURE_ENCLOSURE_SWEEP_H
#define HR2D_SRC_ENCLOSURE_ENCLOSURE_SWEEP_H

#include "enclosure/enclosure-links.h"

/* Of a leaf and a band: of the values at its points, and of their mean. */
typedef struct hr2di_lit_range {
  hr2di_strip point;
  hr2di_range mean;
} hr2di_lit_range;

typedef struct hr2di_enclosing {
  const hr2d_scene *scene;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  size_t bands;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  uint32_t *original;        /* per element; NULL without images */
  unsigned char *sees_backs; /* per patch; NULL: none does */
  hr2di_enclosed_link *link;
  size_t count, room;   /* of links */
  size_t elements;      /* that the arrays below have */
  hr2di_lit_range *b;   /* elements × bands: of leaves of patches, no images */
  hr2di_lit_range *h;   /* the same, of the irradiance */
  hr2di_lit_range *row; /* per element: the sum of its factors, then the rest up to 1 */
  uint32_t *terms;      /* links per element */
  uint64_t sweeps;
} hr2di_enclosing;

/* Whether this element has ranges of its own. */
int hr2di_enclosing_has(const hr2di_enclosing *e, uint32_t element);

/* What no B of a band is above, without links. */
double hr2di_enclosing_max(const hr2d_scene *scene, size_t band);

/* Makes the ranges of all leaves from those of their ancestors, and at first from what is known
   without links.  After a refinement; `b` of the elements from before is kept.  HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_enclosing_begin(hr2di_enclosing *e);

/* What ∫j F(y,i) B(y) dy, by the length of j, differs from the product of the means: a number,
   and how far it may be off. */
typedef struct hr2di_covariance {
  double value, off;
} hr2di_covariance;

hr2di_covariance hr2di_covariance_of(const hr2di_strip *f, const hr2di_strip *b);

/* Frees the ranges. */
void hr2di_enclosing_forget(hr2di_enclosing *e);

/* Sweeps until the ranges get no narrower.  HR2D_OK or the status of the watch. */
hr2d_status hr2di_enclosing_sweep(hr2di_enclosing *e);

#endif
