/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sides run against each other: the left child on one is the right child on the other. */
#include "hierarchy/pane-trees.h"

#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"

/* Two elements at one place, on either side. */
typedef struct pair {
  uint32_t front, back;
} pair;

/* Visits the elements of a pane from their roots on. */
typedef struct walk {
  const hr2d_hierarchy *h;
  hr2d_allocator alloc;
  pair *stack;
  size_t count, capacity;
} walk;

static hr2d_status push_children(walk *w, pair of) {
  const hr2d_element *element = w->h->element;
  if (hr2di_alloc_reserve(&w->alloc, &w->stack, &w->capacity, w->count + 2, sizeof *w->stack))
    return HR2D_ENOMEM;
  const uint32_t front = element[of.front].child, back = element[of.back].child;
  w->stack[w->count++] = (pair){front, back + 1};
  w->stack[w->count++] = (pair){front + 1, back};
  return HR2D_OK;
}

static hr2d_status begin(walk *w, size_t patch) {
  if (hr2di_alloc_reserve(&w->alloc, &w->stack, &w->capacity, 1, sizeof *w->stack))
    return HR2D_ENOMEM;
  w->stack[0] = (pair){(uint32_t)patch, (uint32_t)hr2di_scene_other_side(w->h->scene, patch)};
  w->count = 1;
  return HR2D_OK;
}

/* Divides an element as the one on the other side is. */
static hr2d_status divide_as(hr2d_hierarchy *h, uint32_t element, uint32_t as, size_t max) {
  const double part = hr2di_element_right_part(h->element, as);
  const hr2d_point at = h->element[h->element[as].child].b;
  const int full = h->elements + 2 > h->capacity;
  const hr2d_status status =
      full && h->capacity > max / 2 ? HR2D_EMAX_BYTES : hr2di_hierarchy_reserve(h);
  if (status) return status;
  if (part == 0.5)
    hr2di_element_halve(h, element);
  else
    hr2di_element_divide(h, element, part, at);
  return HR2D_OK;
}

/* Whether the children of both meet at one place, within roundings of it. */
static int are_alike(const hr2d_hierarchy *h, pair p) {
  const hr2d_point u = h->element[h->element[p.front].child].b,
                   v = h->element[h->element[p.back].child].b;
  return fabs(u.x - v.x) <= 0x1p-48 && fabs(u.y - v.y) <= 0x1p-48;
}

static hr2d_status unite(walk *w, hr2d_hierarchy *h, size_t max, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  while (w->count > 0 && !status) {
    const pair p = w->stack[--w->count];
    const uint32_t front = h->element[p.front].child, back = h->element[p.back].child;
    status = hr2di_watch_work(watch, 1);
    if (status || (!front && !back)) continue;
    if (!front) status = divide_as(h, p.front, p.back, max);
    if (!back) status = divide_as(h, p.back, p.front, max);
    if (!status && front && back && !are_alike(h, p)) status = HR2D_EUNSUPPORTED;
    if (!status) status = push_children(w, p);
  }
  return status;
}

/* Each pane once, from the side of the lower number. */
static int begins_pane(const hr2d_scene *scene, size_t patch) {
  return patch < hr2di_scene_other_side(scene, patch);
}

hr2d_status hr2di_pane_trees_unite(hr2d_hierarchy *h, size_t max, hr2di_watch *watch) {
  walk w = {.h = h, .alloc = h->alloc};
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; h->scene->other_side && k < h->scene->patches && !status; k++) {
    if (!begins_pane(h->scene, k)) continue;
    status = begin(&w, k);
    if (!status) status = unite(&w, h, max, watch);
  }
  hr2di_alloc_free(&h->alloc, w.stack);
  return status;
}

static hr2d_status map(walk *w, uint32_t *other, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  while (w->count > 0 && !status) {
    const pair p = w->stack[--w->count];
    const int front = w->h->element[p.front].child != 0,
              back = w->h->element[p.back].child != 0;
    status = hr2di_watch_work(watch, 1);
    other[p.front] = p.back;
    other[p.back] = p.front;
    if (!status && (front != back || (front && !are_alike(w->h, p)))) status = HR2D_ESTATE;
    if (!status && front) status = push_children(w, p);
  }
  return status;
}

hr2d_status hr2di_pane_trees_map(const hr2d_hierarchy *h, uint32_t *other,
                                 const hr2d_allocator *alloc, hr2di_watch *watch) {
  walk w = {.h = h, .alloc = *alloc};
  hr2d_status status = hr2di_watch_work(watch, h->elements / 16);
  for (size_t k = 0; k < h->elements; k++) other[k] = (uint32_t)k;
  for (size_t k = 0; h->scene->other_side && k < h->scene->patches && !status; k++) {
    if (!begins_pane(h->scene, k)) continue;
    status = begin(&w, k);
    if (!status) status = map(&w, other, watch);
  }
  hr2di_alloc_free(alloc, w.stack);
  return status;
}
