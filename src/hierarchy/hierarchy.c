/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Binary trees of elements on the patches, all in one array. */
#include <string.h>

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

/* Element numbers have 32 bits; doubling stops at this capacity. */
#define MOST_ELEMENTS ((size_t)UINT32_MAX - 1)

/* Coordinates lie in [-2,2), so that the sum does not overflow. */
static hr2d_point midpoint(hr2d_point a, hr2d_point b) {
  return (hr2d_point){0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
}

static hr2d_element make_element(hr2d_point a, hr2d_point b, double length, uint32_t patch) {
  return (hr2d_element){a, b, midpoint(a, b), length, 0, patch};
}

/* Reallocates one array to `capacity` items.  Returns 0 or -1. */
static int grow(const hr2d_allocator *alloc, void *array, size_t capacity, size_t size) {
  void *block;
  memcpy(&block, array, sizeof block);
  if (capacity > SIZE_MAX / size) return -1;
  block = alloc->reallocate(alloc->ctx, block, capacity * size);
  if (!block) return -1;
  memcpy(array, &block, sizeof block);
  return 0;
}

static hr2d_status set_capacity(hr2d_hierarchy *h, size_t capacity) {
  if (grow(&h->alloc, &h->element, capacity, sizeof *h->element) ||
      grow(&h->alloc, &h->parent, capacity, sizeof *h->parent) ||
      grow(&h->alloc, &h->level, capacity, sizeof *h->level))
    return HR2D_ENOMEM;
  h->capacity = capacity;
  return HR2D_OK;
}

hr2d_status hr2d_hierarchy_create(const hr2d_scene *scene, hr2d_hierarchy **hierarchy) {
  if (!scene || !hierarchy) return HR2D_EINVAL;
  if (!scene->committed) return HR2D_ESTATE;
  hr2d_hierarchy *made = hr2di_alloc_zero(&scene->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  made->alloc = scene->alloc;
  made->scene = scene;
  made->order = 1;
  const size_t n = scene->patches;
  if (n > MOST_ELEMENTS / 2 || set_capacity(made, hr2di_hierarchy_first_capacity(n))) {
    hr2d_hierarchy_destroy(made);
    return HR2D_ENOMEM;
  }
  for (size_t k = 0; k < n; k++) {
    const hr2di_patch *p = &scene->patch[k];
    made->element[k] = make_element(p->scaled.a, p->scaled.b, p->length, (uint32_t)k);
    made->parent[k] = (uint32_t)k;
    made->level[k] = 0;
  }
  made->elements = n;
  *hierarchy = made;
  return HR2D_OK;
}

void hr2d_hierarchy_destroy(hr2d_hierarchy *hierarchy) {
  if (!hierarchy) return;
  const hr2d_allocator alloc = hierarchy->alloc;
  hr2di_alloc_free(&alloc, hierarchy->element);
  hr2di_alloc_free(&alloc, hierarchy->parent);
  hr2di_alloc_free(&alloc, hierarchy->level);
  hr2di_alloc_free(&alloc, hierarchy);
}

int hr2di_element_divisible(const hr2d_hierarchy *hierarchy, uint32_t element) {
  const hr2d_element *e = &hierarchy->element[element];
  const hr2d_point m = e->centre;
  return 0.5 * e->length > 0 && (m.x != e->a.x || m.y != e->a.y) &&
         (m.x != e->b.x || m.y != e->b.y);
}

hr2d_status hr2di_hierarchy_reserve(hr2d_hierarchy *h) {
  if (h->elements + 2 <= h->capacity) return HR2D_OK;
  if (h->elements + 2 > MOST_ELEMENTS) return HR2D_EMAX_ELEMENTS;
  return set_capacity(h, h->capacity > MOST_ELEMENTS / 2 ? MOST_ELEMENTS : 2 * h->capacity);
}

uint32_t hr2di_element_halve(hr2d_hierarchy *h, uint32_t element) {
  return hr2di_element_divide(h, element, 0.5, h->element[element].centre);
}

uint32_t hr2di_element_divide(hr2d_hierarchy *h, uint32_t element, double part, hr2d_point at) {
  const hr2d_element e = h->element[element];
  const uint32_t left = (uint32_t)h->elements, right = left + 1;
  h->element[left] = make_element(e.a, at, part * e.length, e.patch);
  h->element[right] = make_element(at, e.b, (1 - part) * e.length, e.patch);
  h->parent[left] = h->parent[right] = element;
  const uint16_t level = (uint16_t)(h->level[element] + 1);
  h->level[left] = h->level[right] = level;
  if (level > h->levels) h->levels = level;
  h->element[element].child = left;
  h->elements += 2;
  return left;
}

/* An array that cannot be reallocated stays larger than `capacity`, which does no harm. */
static void shrink(hr2d_hierarchy *h, size_t capacity) {
  if (capacity >= h->capacity) return;
  h->capacity = capacity;
  grow(&h->alloc, &h->element, capacity, sizeof *h->element);
  grow(&h->alloc, &h->parent, capacity, sizeof *h->parent);
  grow(&h->alloc, &h->level, capacity, sizeof *h->level);
}

void hr2di_hierarchy_forget(hr2d_hierarchy *h, size_t elements, unsigned levels) {
  while (h->elements > elements) {
    h->elements -= 2;
    h->element[h->parent[h->elements]].child = 0;
  }
  h->levels = levels;
}

void hr2di_hierarchy_truncate(hr2d_hierarchy *h, size_t elements) {
  hr2di_hierarchy_forget(h, elements, 0);
  for (size_t k = 0; k < elements; k++)
    if (h->level[k] > h->levels) h->levels = h->level[k];
  shrink(h, hr2di_hierarchy_first_capacity(elements));
}

const hr2d_scene *hr2d_hierarchy_scene(const hr2d_hierarchy *hierarchy) {
  if (!hierarchy) return NULL;
  return hierarchy->scene;
}

hr2d_hierarchy_counts hr2d_hierarchy_count(const hr2d_hierarchy *hierarchy) {
  if (!hierarchy) return (hr2d_hierarchy_counts){0};
  /* Halving replaces one leaf by two. */
  const uint64_t n = hierarchy->elements, roots = hierarchy->scene->patches;
  return (hr2d_hierarchy_counts){n, (n + roots) / 2, hierarchy->levels};
}

const hr2d_element *hr2d_hierarchy_elements(const hr2d_hierarchy *hierarchy) {
  if (!hierarchy) return NULL;
  return hierarchy->element;
}

unsigned hr2d_element_level(const hr2d_hierarchy *hierarchy, uint32_t element) {
  if (!hierarchy || element >= hierarchy->elements) return HR2D_NO_ELEMENT;
  return hierarchy->level[element];
}

uint32_t hr2d_element_parent(const hr2d_hierarchy *hierarchy, uint32_t element) {
  if (!hierarchy || element >= hierarchy->elements) return HR2D_NO_ELEMENT;
  return hierarchy->parent[element];
}

uint32_t hr2d_hierarchy_leaf(const hr2d_hierarchy *hierarchy, size_t patch, double t) {
  if (!hierarchy || patch >= hierarchy->scene->patches) return HR2D_NO_ELEMENT;
  uint32_t element = (uint32_t)patch;
  while (hierarchy->element[element].child)
    element = hr2di_element_child_at(hierarchy->element, element, &t, 0);
  return element;
}

double hr2di_element_start(const hr2d_hierarchy *h, uint32_t element) {
  double start = 0;
  for (uint32_t parent = h->parent[element]; parent != element; parent = h->parent[element]) {
    const double left = hr2di_element_left_part(h->element, parent);
    start = element == h->element[parent].child ? left * start : left + (1 - left) * start;
    element = parent;
  }
  return start;
}

uint32_t hr2di_hierarchy_first_leaf(const hr2d_hierarchy *h, uint32_t top) {
  while (h->element[top].child) top = h->element[top].child;
  return top;
}

uint32_t hr2di_hierarchy_next_leaf(const hr2d_hierarchy *h, uint32_t leaf, uint32_t top) {
  while (leaf != top && leaf == h->element[h->parent[leaf]].child + 1) leaf = h->parent[leaf];
  return leaf == top ? 0 : hr2di_hierarchy_first_leaf(h, leaf + 1);
}

hr2d_status hr2d_hierarchy_set_order(hr2d_hierarchy *hierarchy, unsigned order) {
  if (!hierarchy) return HR2D_EINVAL;
  if (hr2di_hierarchy_busy(hierarchy)) return HR2D_ESTATE;
  if (order < 1 || order > HR2D_MAX_ORDER) return HR2D_EINVAL;
  hierarchy->order = order;
  return HR2D_OK;
}

unsigned hr2d_hierarchy_order(const hr2d_hierarchy *hierarchy) {
  if (!hierarchy) return 0;
  return hierarchy->order;
}
