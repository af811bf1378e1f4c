/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Copies of a hierarchy that grow independently, and the union of their elements. */
#include <string.h>

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

/* Stands for an element that a clone does not have. */
#define ABSENT UINT32_MAX

uint64_t hr2di_hierarchy_clone_bytes(const hr2d_hierarchy *from) {
  return (uint64_t)hr2di_hierarchy_first_capacity(from->elements) * HR2DI_ELEMENT_BYTES;
}

hr2d_status hr2di_hierarchy_clone(const hr2d_hierarchy *from, hr2d_hierarchy **clone) {
  hr2d_hierarchy *made = hr2di_alloc_zero(&from->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  *made = *from;
  made->readers = 0;
  made->capacity = hr2di_hierarchy_first_capacity(from->elements);
  made->element = hr2di_alloc(&from->alloc, made->capacity, sizeof *made->element);
  made->parent = hr2di_alloc(&from->alloc, made->capacity, sizeof *made->parent);
  made->level = hr2di_alloc(&from->alloc, made->capacity, sizeof *made->level);
  if (!made->element || !made->parent || !made->level) {
    hr2d_hierarchy_destroy(made);
    return HR2D_ENOMEM;
  }
  memcpy(made->element, from->element, from->elements * sizeof *made->element);
  memcpy(made->parent, from->parent, from->elements * sizeof *made->parent);
  memcpy(made->level, from->level, from->elements * sizeof *made->level);
  *clone = made;
  return HR2D_OK;
}

/* The walk visits the same element in the hierarchy and in all clones at once: a
   column has its number in each. */
typedef struct walk {
  uint32_t *column;
  size_t width, columns;
  size_t max; /* elements that room may be made for */
  hr2di_watch *watch;
} walk;

/* Pushes the columns of the children, the right one first. */
static void push_children(walk *w, const uint32_t *parent, const hr2d_hierarchy *h,
                          hr2d_hierarchy *const *clone) {
  uint32_t *right = w->column + w->columns * w->width, *left = right + w->width;
  right[0] = h->element[parent[0]].child + 1;
  left[0] = right[0] - 1;
  for (size_t k = 1; k < w->width; k++) {
    const uint32_t child = parent[k] == ABSENT ? 0 : clone[k - 1]->element[parent[k]].child;
    right[k] = child ? child + 1 : ABSENT;
    left[k] = child ? child : ABSENT;
  }
  w->columns += 2;
}

static int some_clone_halved(const uint32_t *column, size_t width,
                             hr2d_hierarchy *const *clone) {
  for (size_t k = 1; k < width; k++)
    if (column[k] != ABSENT && clone[k - 1]->element[column[k]].child) return 1;
  return 0;
}

static hr2d_status unite_patch(hr2d_hierarchy *h, hr2d_hierarchy *const *clone, walk *w,
                               uint32_t patch, uint32_t *top) {
  for (size_t k = 0; k < w->width; k++) w->column[k] = patch;
  w->columns = 1;
  while (w->columns > 0) {
    const hr2d_status asked = hr2di_watch_work(w->watch, 1 + w->width / 4);
    if (asked) return asked;
    w->columns--;
    memcpy(top, w->column + w->columns * w->width, w->width * sizeof *top);
    if (!some_clone_halved(top, w->width, clone)) continue;
    if (!h->element[top[0]].child) {
      const int full = h->elements + 2 > h->capacity;
      const hr2d_status status =
          full && h->capacity > w->max / 2 ? HR2D_EMAX_BYTES : hr2di_hierarchy_reserve(h);
      if (status) return status;
      hr2di_element_halve(h, top[0]);
    }
    push_children(w, top, h, clone);
  }
  return HR2D_OK;
}

hr2d_status hr2di_hierarchy_unite(hr2d_hierarchy *h, hr2d_hierarchy *const *clone, size_t count,
                                  size_t max, hr2di_watch *watch) {
  unsigned levels = h->levels;
  for (size_t k = 0; k < count; k++)
    levels = clone[k]->levels > levels ? clone[k]->levels : levels;
  walk w = {.width = count + 1, .max = max, .watch = watch};
  /* Each level leaves at most one sibling on the stack, and the last level two. */
  w.column = hr2di_alloc(&h->alloc, (size_t)levels + 3, w.width * sizeof *w.column);
  uint32_t *top = hr2di_alloc(&h->alloc, w.width, sizeof *top);
  const size_t elements = h->elements;
  hr2d_status status = w.column && top ? HR2D_OK : HR2D_ENOMEM;
  for (size_t patch = 0; patch < h->scene->patches && !status; patch++)
    status = unite_patch(h, clone, &w, (uint32_t)patch, top);
  if (status) hr2di_hierarchy_truncate(h, elements);
  hr2di_alloc_free(&h->alloc, w.column);
  hr2di_alloc_free(&h->alloc, top);
  return status;
}
