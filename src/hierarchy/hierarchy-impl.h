/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trees of elements, for refinement and solve. */
#ifndef HR2D_SRC_HIERARCHY_HIERARCHY_IMPL_H
#define HR2D_SRC_HIERARCHY_HIERARCHY_IMPL_H

#include <hr2d/hierarchy.h>
#include <stdatomic.h>

struct hr2d_hierarchy {
  hr2d_allocator alloc;
  const hr2d_scene *scene;
  hr2d_element *element;
  uint32_t *parent;
  uint16_t *level;
  size_t elements, capacity;
  unsigned levels;    /* the deepest level */
  unsigned order;     /* coefficients per element */
  int refining;       /* a refinement is under way: callbacks may only read */
  atomic_int readers; /* solves that are under way: callbacks may not refine */
};

/* Whether a call that has called back, or another thread, stands on the hierarchy as it is. */
static inline int hr2di_hierarchy_busy(const hr2d_hierarchy *hierarchy) {
  return hierarchy->refining || atomic_load(&hierarchy->readers) > 0;
}

/* The size of one element in all arrays together. */
enum { HR2DI_ELEMENT_BYTES = sizeof(hr2d_element) + sizeof(uint32_t) + sizeof(uint16_t) };

/* The room made for so many elements that are to become more. */
static inline size_t hr2di_hierarchy_first_capacity(size_t elements) {
  return elements + elements / 2 + 16;
}

/* Whether an element's midpoint is a point of its own, so that it can be halved. */
int hr2di_element_divisible(const hr2d_hierarchy *hierarchy, uint32_t element);

/* Makes room for two more elements; HR2D_OK, HR2D_ENOMEM or HR2D_EMAX_ELEMENTS
   where their numbers would not fit. */
hr2d_status hr2di_hierarchy_reserve(hr2d_hierarchy *hierarchy);

/* Halves a divisible leaf, with room reserved; returns the left child. */
uint32_t hr2di_element_halve(hr2d_hierarchy *hierarchy, uint32_t element);

/* Divides a leaf at a point inside, `part` of its length from its start, with room reserved;
   returns the left child. */
uint32_t hr2di_element_divide(hr2d_hierarchy *hierarchy, uint32_t element, double part,
                              hr2d_point at);

/* How much of an element its left child is; ½ where it was halved. */
static inline double hr2di_element_left_part(const hr2d_element *element, uint32_t at) {
  const double left = element[element[at].child].length;
  const double right = element[element[at].child + 1].length;
  return left == right ? 0.5 : left / (left + right);
}

/* The child that holds fraction *t of an element, and the fraction that this is of the
   child, exact for halves.  On the border it is the child before, or the one behind. */
static inline uint32_t hr2di_element_child_at(const hr2d_element *element, uint32_t at,
                                              double *t, int before) {
  const double left = hr2di_element_left_part(element, at);
  const int right = before ? *t > left : *t >= left;
  *t = right ? (*t - left) / (1 - left) : *t / left;
  return element[at].child + (uint32_t)right;
}

/* Where an element begins, a fraction of its patch, exact for halves of halves. */
double hr2di_element_start(const hr2d_hierarchy *hierarchy, uint32_t element);

/* The leaves below an element, as the tree is walked: the first, and the one behind a leaf, or
   0 behind the last. */
uint32_t hr2di_hierarchy_first_leaf(const hr2d_hierarchy *hierarchy, uint32_t top);
uint32_t hr2di_hierarchy_next_leaf(const hr2d_hierarchy *hierarchy, uint32_t leaf,
                                   uint32_t top);

/* A copy on the same scene; HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_hierarchy_clone(const hr2d_hierarchy *from, hr2d_hierarchy **clone);

/* The bytes of a clone. */
uint64_t hr2di_hierarchy_clone_bytes(const hr2d_hierarchy *from);

/* Grows by every element that one of `count` clones has, numbered patch by patch, a
   parent's children before its right neighbour's.  HR2D_OK, or HR2D_ENOMEM or
   HR2D_EMAX_ELEMENTS, or HR2D_EMAX_BYTES for more room than for `max` elements, with the
   hierarchy as it was. */
hr2d_status hr2di_hierarchy_unite(hr2d_hierarchy *hierarchy, hr2d_hierarchy *const *clone,
                                  size_t count, size_t max);

/* Takes back all but the first `elements` elements, and their room. */
void hr2di_hierarchy_truncate(hr2d_hierarchy *hierarchy, size_t elements);

#endif
