/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A walk visits the same element of a patch and of all its images at once: a column has its
   number in each.  On an image that runs the other way the children change places. */
#include "hierarchy/image-trees.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"

typedef struct walk {
  hr2d_hierarchy *h;
  const hr2di_symmetry *s;
  uint32_t *column; /* a stack of columns */
  size_t columns, capacity;
  size_t max; /* elements that there may be memory for */
  hr2di_watch *watch;
} walk;

static hr2d_status reserve(walk *w, size_t columns) {
  return hr2di_alloc_reserve(&w->h->alloc, &w->column, &w->capacity, columns * w->s->motions,
                             sizeof *w->column)
             ? HR2D_ENOMEM
             : HR2D_OK;
}

static hr2d_point scaled(hr2d_point p, int exponent) {
  return (hr2d_point){ldexp(p.x, exponent), ldexp(p.y, exponent)};
}

/* Where image `to` has the point that image `from` has at p. */
static hr2d_point carry(const walk *w, size_t from, size_t to, hr2d_point p) {
  const hr2d_scene *scene = w->h->scene;
  const double touch = hr2di_symmetry_touch(scene);
  p = scaled(p, scene->exponent);
  p = hr2di_symmetry_move(&w->s->by, &w->s->motion[w->s->motion[from].inverse], p, touch);
  p = hr2di_symmetry_move(&w->s->by, &w->s->motion[to], p, touch);
  return scaled(p, -scene->exponent);
}

/* Divides the elements of a column as number `from` of it is. */
static hr2d_status divide(walk *w, const uint32_t *column, size_t from) {
  hr2d_hierarchy *h = w->h;
  const double left = hr2di_element_left_part(h->element, column[from]);
  const hr2d_point at = h->element[h->element[column[from]].child].b;
  for (size_t g = 0; g < w->s->motions; g++) {
    if (h->element[column[g]].child) continue;
    const int full = h->elements + 2 > h->capacity;
    const hr2d_status status =
        full && h->capacity > w->max / 2 ? HR2D_EMAX_BYTES : hr2di_hierarchy_reserve(h);
    if (status) return status;
    const int turned = w->s->motion[g].turned != w->s->motion[from].turned;
    if (left == 0.5)
      hr2di_element_halve(h, column[g]);
    else
      hr2di_element_divide(h, column[g], turned ? 1 - left : left, carry(w, from, g, at));
  }
  return HR2D_OK;
}

static void push_children(walk *w) {
  const size_t count = w->s->motions;
  uint32_t *top = w->column + (w->columns - 1) * count, *next = top + count;
  for (size_t g = 0; g < count; g++) {
    const uint32_t child = w->h->element[top[g]].child;
    const uint32_t turned = w->s->motion[g].turned != 0;
    top[g] = child + turned;
    next[g] = child + !turned;
  }
  w->columns++;
}

static hr2d_status unite_patch(walk *w, uint32_t patch) {
  const size_t count = w->s->motions;
  hr2d_status status = reserve(w, 2);
  for (size_t g = 0; g < count && !status; g++)
    w->column[g] = (uint32_t)(g * w->s->cell) + patch;
  w->columns = !status;
  while (w->columns > 0 && !status) {
    const uint32_t *top = w->column + (w->columns - 1) * count;
    size_t from = 0;
    while (from < count && !w->h->element[top[from]].child) from++;
    status = hr2di_watch_work(w->watch, 1 + count / 4);
    if (from == count) {
      w->columns--;
      continue;
    }
    if (!status) status = divide(w, top, from);
    if (!status) status = reserve(w, w->columns + 1);
    if (!status) push_children(w);
  }
  return status;
}

hr2d_status hr2di_image_trees_unite(hr2d_hierarchy *h, size_t max, hr2di_watch *watch) {
  walk w = {.h = h, .s = &h->scene->symmetry, .max = max, .watch = watch};
  hr2d_status status = HR2D_OK;
  for (uint32_t k = 0; w.s->motion && k < w.s->cell && !status; k++)
    status = unite_patch(&w, k);
  hr2di_alloc_free(&h->alloc, w.column);
  return status;
}

int hr2di_image_trees_turned(const hr2d_hierarchy *h, uint32_t element) {
  const hr2di_symmetry *s = &h->scene->symmetry;
  const size_t patch = h->element[element].patch;
  return s->motion && patch < s->motions * s->cell && s->motion[patch / s->cell].turned;
}

/* Parents come before their children. */
hr2d_status hr2di_image_trees_map(const hr2d_hierarchy *h, uint32_t *of, hr2di_watch *watch) {
  const hr2di_symmetry *s = &h->scene->symmetry;
  for (size_t k = 0; k < h->elements; k++)
    if (h->parent[k] == k) of[k] = (uint32_t)hr2di_symmetry_original(s, k);
  for (uint32_t k = 0; k < h->elements; k++) {
    if (k % 64 == 0 && hr2di_watch_work(watch, 8)) return hr2di_watch_status(watch);
    const uint32_t child = h->element[k].child;
    if (!child) continue;
    const uint32_t other = h->element[of[k]].child;
    const uint32_t turned = hr2di_image_trees_turned(h, k) != 0;
    of[child] = other + turned;
    of[child + 1] = other + !turned;
  }
  return HR2D_OK;
}

hr2d_status hr2d_hierarchy_originals(const hr2d_hierarchy *hierarchy, uint32_t *original) {
  if (!hierarchy || !original) return HR2D_EINVAL;
  hr2di_watch watch;
  hr2di_scene_watch(hierarchy->scene, &watch, NULL, NULL, "images");
  const hr2d_status status = hr2di_image_trees_map(hierarchy, original, &watch);
  return status ? status : hr2di_watch_ask(&watch);
}
