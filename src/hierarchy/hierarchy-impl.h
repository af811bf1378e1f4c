/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trees of elements, for refinement and solve. */
#ifndef HR2D_SRC_HIERARCHY_HIERARCHY_IMPL_H
#define HR2D_SRC_HIERARCHY_HIERARCHY_IMPL_H

#include <hr2d/hierarchy.h>
#include <stdatomic.h>

#include "base/watch.h"
#include "scene/scene-impl.h"

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

/* Whether the hierarchy must not change, because a refinement or a solve on it is under way:
   the call comes from its callback, or from another thread. */
static inline int hr2di_hierarchy_busy(const hr2d_hierarchy *hierarchy) {
  return hierarchy->refining || atomic_load(&hierarchy->readers) > 0;
}

/* The size of one element in all arrays together. */
enum { HR2DI_ELEMENT_BYTES = sizeof(hr2d_element) + sizeof(uint32_t) + sizeof(uint16_t) };

/* The capacity for a hierarchy of this many elements that is going to grow. */
static inline size_t hr2di_hierarchy_first_capacity(size_t elements) {
  return elements + elements / 2 + 16;
}

/* Whether an element's midpoint is a point of its own, so that it can be halved. */
int hr2di_element_divisible(const hr2d_hierarchy *hierarchy, uint32_t element);

/* Makes room for two more elements.  Returns HR2D_OK, HR2D_ENOMEM, or HR2D_EMAX_ELEMENTS if
   their numbers would be too large for 32 bits. */
hr2d_status hr2di_hierarchy_reserve(hr2d_hierarchy *hierarchy);

/* Halves a divisible leaf; room must be reserved.  Returns the left child. */
uint32_t hr2di_element_halve(hr2d_hierarchy *hierarchy, uint32_t element);

/* Divides a leaf at the point `at` inside it, which is `part` of its length from its start;
   room must be reserved.  Returns the left child. */
uint32_t hr2di_element_divide(hr2d_hierarchy *hierarchy, uint32_t element, double part,
                              hr2d_point at);

/* left / (left + right), exact for halves and quarters. */
static inline double hr2di_part_of(double left, double right) {
  if (left == right) return 0.5;
  return right == 3 * left ? 0.25 : left == 3 * right ? 0.75 : left / (left + right);
}

/* The length of an element's left child as a fraction of the element. */
static inline double hr2di_element_left_part(const hr2d_element *element, uint32_t at) {
  const hr2d_element *child = element + element[at].child;
  return hr2di_part_of(child[0].length, child[1].length);
}

/* That of the right child, with its own digits where it is much shorter. */
static inline double hr2di_element_right_part(const hr2d_element *element, uint32_t at) {
  const hr2d_element *child = element + element[at].child;
  return hr2di_part_of(child[1].length, child[0].length);
}

/* Returns the child that holds the point at fraction *t of an element; *t becomes the fraction
   of this child, exact for halves and quarters.  A point on the border of the children belongs
   to the left one if `before` is set, else to the right one. */
static inline uint32_t hr2di_element_child_at(const hr2d_element *element, uint32_t at,
                                              double *t, int before) {
  const double left = hr2di_element_left_part(element, at);
  const int right = before ? *t > left : *t >= left;
  *t = right ? (*t - left) / (1 - left) : *t / left;
  return element[at].child + (uint32_t)right;
}

/* The start of an element as a fraction of its patch; exact if all divisions were into halves
   or quarters. */
double hr2di_element_start(const hr2d_hierarchy *hierarchy, uint32_t element);

/* Walks the leaves below the element `top` in their order on the patch: the first leaf, and the
   leaf after `leaf`, or 0 if that was the last. */
uint32_t hr2di_hierarchy_first_leaf(const hr2d_hierarchy *hierarchy, uint32_t top);
uint32_t hr2di_hierarchy_next_leaf(const hr2d_hierarchy *hierarchy, uint32_t leaf,
                                   uint32_t top);

/* Makes a copy on the same scene.  Returns HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_hierarchy_clone(const hr2d_hierarchy *from, hr2d_hierarchy **clone);

/* The bytes that the arrays of a clone take. */
uint64_t hr2di_hierarchy_clone_bytes(const hr2d_hierarchy *from);

/* Adds every element that at least one of `count` clones has.  New elements are numbered patch
   by patch, the children of a parent before the children of its right neighbour.  Returns
   HR2D_OK; or, with the hierarchy unchanged, HR2D_ENOMEM, HR2D_EMAX_ELEMENTS, the status of the
   watch, or HR2D_EMAX_BYTES if room for more than `max` elements is needed. */
hr2d_status hr2di_hierarchy_unite(hr2d_hierarchy *hierarchy, hr2d_hierarchy *const *clone,
                                  size_t count, size_t max, hr2di_watch *watch);

/* Removes all elements but the first `elements`, and frees their room. */
void hr2di_hierarchy_truncate(hr2d_hierarchy *hierarchy, size_t elements);

/* Removes them and keeps the room; the deepest of the others is on level `levels`.  Cost: that
   of the elements that are removed. */
void hr2di_hierarchy_forget(hr2d_hierarchy *hierarchy, size_t elements, unsigned levels);

#endif
