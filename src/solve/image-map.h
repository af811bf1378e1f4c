/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elements of images have the light of the elements that they are images of.

   A link joins an element e of the cell and one of a patch or an image gf.  It adds what e
   sends to gf, which by symmetry g⁻¹e sends to f.  So the power that f receives is the sum over
   all its images.  On an image that runs the other way odd coefficients change their sign. */
#ifndef HR2D_SRC_SOLVE_IMAGE_MAP_H
#define HR2D_SRC_SOLVE_IMAGE_MAP_H

#include "hierarchy/hierarchy-impl.h"

typedef struct hr2di_image_map {
  const hr2d_hierarchy *hierarchy;
  uint32_t *of;       /* per element: that of which it is an image; NULL: there are no images */
  uint32_t *number;   /* per element that is a leaf: which one, in the order of elements */
  unsigned char *odd; /* per element: it runs the other way */
} hr2di_image_map;

/* HR2D_OK, HR2D_ENOMEM or the status of the watch.  To be cleared in any case. */
hr2d_status hr2di_image_map_init(hr2di_image_map *image_map, const hr2d_hierarchy *hierarchy,
                                 const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_image_map_clear(hr2di_image_map *image_map, const hr2d_allocator *alloc);

static inline uint32_t hr2di_image_map_of(const hr2di_image_map *image_map, uint32_t element) {
  return image_map->of ? image_map->of[element] : element;
}

/* Fields have order × bands values for each element. */

/* Copies the values of elements to their images. */
void hr2di_image_map_spread(const hr2di_image_map *image_map, size_t order, size_t bands,
                            double *field);

/* Sets elements, and their images, to the sum of a field over them all. */
void hr2di_image_map_fold(const hr2di_image_map *image_map, size_t order, size_t bands,
                          double *field);

/* The same for fields on leaves. */
void hr2di_image_map_spread_leaves(const hr2di_image_map *image_map, size_t order, size_t bands,
                                   double *field);
void hr2di_image_map_fold_leaves(const hr2di_image_map *image_map, size_t order, size_t bands,
                                 double *field);

#endif
