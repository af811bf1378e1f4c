/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums are in the order of elements. */
#include "solve/image-map.h"

#include "base/alloc.h"
#include "hierarchy/image-trees.h"
#include "scene/scene-impl.h"

hr2d_status hr2di_image_map_init(hr2di_image_map *image_map, const hr2d_hierarchy *h,
                                 const hr2d_allocator *alloc, hr2di_watch *watch) {
  *image_map = (hr2di_image_map){.hierarchy = h};
  if (!h->scene->symmetry.motion) return HR2D_OK;
  image_map->of = hr2di_alloc(alloc, h->elements, sizeof *image_map->of);
  image_map->number = hr2di_alloc_zero(alloc, h->elements, sizeof *image_map->number);
  image_map->odd = hr2di_alloc(alloc, h->elements, sizeof *image_map->odd);
  if (!image_map->of || !image_map->number || !image_map->odd) return HR2D_ENOMEM;
  uint32_t leaves = 0;
  for (uint32_t k = 0; k < h->elements; k++) {
    image_map->odd[k] = (unsigned char)hr2di_image_trees_turned(h, k);
    if (!h->element[k].child) image_map->number[k] = leaves++;
  }
  return hr2di_image_trees_map(h, image_map->of, watch);
}

void hr2di_image_map_clear(hr2di_image_map *image_map, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, image_map->of);
  hr2di_alloc_free(alloc, image_map->number);
  hr2di_alloc_free(alloc, image_map->odd);
  *image_map = (hr2di_image_map){0};
}

/* to = from, or to += from, with odd coefficients turned if `odd` is set. */
static void take(double *to, const double *from, size_t order, size_t bands, int odd, int add) {
  for (size_t l = 0; l < order; l++)
    for (size_t b = 0; b < bands; b++) {
      const size_t k = l * bands + b;
      const double value = odd && l % 2 ? -from[k] : from[k];
      to[k] = add ? to[k] + value : value;
    }
}

void hr2di_image_map_spread(const hr2di_image_map *t, size_t order, size_t bands,
                            double *field) {
  const size_t width = order * bands;
  for (size_t e = 0; t->of && e < t->hierarchy->elements; e++)
    if (t->of[e] != e)
      take(field + e * width, field + t->of[e] * width, order, bands, t->odd[e], 0);
}

void hr2di_image_map_fold(const hr2di_image_map *t, size_t order, size_t bands, double *field) {
  const size_t width = order * bands;
  for (size_t e = 0; t->of && e < t->hierarchy->elements; e++)
    if (t->of[e] != e)
      take(field + t->of[e] * width, field + e * width, order, bands, t->odd[e], 1);
  hr2di_image_map_spread(t, order, bands, field);
}

void hr2di_image_map_spread_leaves(const hr2di_image_map *t, size_t order, size_t bands,
                                   double *field) {
  const size_t width = order * bands;
  const hr2d_element *element = t->of ? t->hierarchy->element : NULL;
  for (size_t e = 0; t->of && e < t->hierarchy->elements; e++)
    if (!element[e].child && t->of[e] != e)
      take(field + t->number[e] * width, field + t->number[t->of[e]] * width, order, bands,
           t->odd[e], 0);
}

void hr2di_image_map_fold_leaves(const hr2di_image_map *t, size_t order, size_t bands,
                                 double *field) {
  const size_t width = order * bands;
  const hr2d_element *element = t->of ? t->hierarchy->element : NULL;
  for (size_t e = 0; t->of && e < t->hierarchy->elements; e++)
    if (!element[e].child && t->of[e] != e)
      take(field + t->number[t->of[e]] * width, field + t->number[e] * width, order, bands,
           t->odd[e], 1);
  hr2di_image_map_spread_leaves(t, order, bands, field);
}
