/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trees of elements, for refinement and solve. */
#ifndef HR2D_SRC_HIERARCHY_IMPL_H
#define HR2D_SRC_HIERARCHY_IMPL_H

#include <hr2d/hierarchy.h>

struct hr2d_hierarchy {
  hr2d_allocator alloc;
  const hr2d_scene *scene;
  hr2d_element *element;
  uint32_t *parent;
  uint16_t *level;
  size_t elements, capacity;
  unsigned levels; /* the deepest level */
  int refining;    /* a refinement is under way: callbacks may only read */
};

/* The size of one element in all arrays together. */
enum { HR2DI_ELEMENT_BYTES = sizeof(hr2d_element) + sizeof(uint32_t) + sizeof(uint16_t) };

/* Whether an element's midpoint is a point of its own, so that it can be halved. */
int hr2di_divisible(const hr2d_hierarchy *hierarchy, uint32_t element);

/* Makes room for two more elements; HR2D_OK, HR2D_ENOMEM or HR2D_EMAX_ELEMENTS
   where their numbers would not fit. */
hr2d_status hr2di_hierarchy_reserve(hr2d_hierarchy *hierarchy);

/* Halves a divisible leaf, with room reserved; returns the left child. */
uint32_t hr2di_halve(hr2d_hierarchy *hierarchy, uint32_t element);

/* A copy on the same scene; HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_hierarchy_clone(const hr2d_hierarchy *from, hr2d_hierarchy **clone);

/* Grows by every element that one of `count` clones has, numbered patch by patch, a
   parent's children before its right neighbour's.  HR2D_OK, or HR2D_ENOMEM or
   HR2D_EMAX_ELEMENTS with the hierarchy as it was. */
hr2d_status hr2di_hierarchy_unite(hr2d_hierarchy *hierarchy, hr2d_hierarchy *const *clone,
                                  size_t count);

/* Takes back all but the first `elements` elements. */
void hr2di_hierarchy_truncate(hr2d_hierarchy *hierarchy, size_t elements);

#endif
