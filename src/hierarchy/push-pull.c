/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two-scale relation along whole trees.  Children have higher numbers than their parents: a
   loop over falling numbers meets children first, a loop over rising numbers parents. */
#include "hierarchy/push-pull.h"

#include "base/alloc.h"
#include "base/legendre.h"
#include "base/ordered-dot.h"

static int is_halved(const hr2d_element *element, uint32_t at) {
  return hr2di_element_left_part(element, at) == 0.5;
}

static void make_pair(const hr2di_push_pull *p, size_t pair, double left) {
  const size_t square = p->order * p->order;
  double *relation = p->relation + 2 * pair * square;
  hr2di_legendre_two_scale(-1, 2 * left - 1, p->order, relation);
  hr2di_legendre_two_scale(2 * left - 1, 1, p->order, relation + square);
}

hr2d_status hr2di_push_pull_init(hr2di_push_pull *p, const hr2d_hierarchy *hierarchy,
                                 const hr2d_allocator *alloc, size_t order, size_t bands,
                                 hr2di_watch *watch) {
  const hr2d_element *element = hierarchy->element;
  *p = (hr2di_push_pull){.hierarchy = hierarchy,
                         .alloc = *alloc,
                         .watch = watch,
                         .elements = hierarchy->elements,
                         .order = order,
                         .bands = bands};
  size_t odd = 0;
  for (uint32_t e = 0; e < p->elements; e++) odd += element[e].child && !is_halved(element, e);
  p->relation = hr2di_alloc(alloc, 1 + odd, 2 * order * order * sizeof *p->relation);
  hr2d_status status = hr2di_watch_work(watch, p->elements / 8);
  if (!p->relation) return HR2D_ENOMEM;
  make_pair(p, 0, 0.5);
  if (odd == 0) return status;
  p->pair_of = hr2di_alloc_zero(alloc, p->elements, sizeof *p->pair_of);
  if (!p->pair_of) return HR2D_ENOMEM;
  uint32_t pairs = 1;
  for (uint32_t e = 0; e < p->elements && !status; e++) {
    if (!element[e].child || is_halved(element, e)) continue;
    status = hr2di_watch_work(watch, 8 + 2 * order * order);
    make_pair(p, pairs, hr2di_element_left_part(element, e));
    p->pair_of[e] = pairs++;
  }
  return status;
}

void hr2di_push_pull_clear(hr2di_push_pull *p) {
  hr2di_alloc_free(&p->alloc, p->relation);
  hr2di_alloc_free(&p->alloc, p->pair_of);
}

const double *hr2di_push_pull_relation(const hr2di_push_pull *p, uint32_t element) {
  const size_t pair = p->pair_of ? p->pair_of[element] : 0;
  return p->relation + 2 * pair * p->order * p->order;
}

enum { BATCH = 16 };

/* Declares the work of the next elements, before every one whose number is a multiple of BATCH.
 */
static inline hr2d_status declare(const hr2di_push_pull *p, uint32_t element) {
  if (element % BATCH != 0) return HR2D_OK;
  return hr2di_watch_work(p->watch, BATCH / 4 + BATCH * p->order * p->order * p->bands / 64);
}

/* parent_l += part Σ_k relation_lk child_k.  A constant stride lets the compiler vectorise. */
static inline void add_up_bands(const double *relation, size_t order, size_t bands, double part,
                                const double *child, double *parent) {
  for (size_t l = 0; l < order; l++) {
    size_t b = 0;
    for (; b + 4 <= bands; b += 4) {
      hr2di_four sum;
      hr2di_dot_fours(relation + l * order, child + b, bands, l + 1, &sum);
      *(hr2di_four *)(parent + l * bands + b) += part * sum;
    }
    for (; b < bands; b++)
      parent[l * bands + b] +=
          part * hr2di_dot_strided(relation + l * order, child + b, bands, l + 1);
  }
}

static void add_up(const hr2di_push_pull *p, const double *relation, double part,
                   const double *child, double *parent) {
  if (p->bands == 1)
    add_up_bands(relation, p->order, 1, part, child, parent);
  else
    add_up_bands(relation, p->order, p->bands, part, child, parent);
}

/* The values of an element of order 1 from its children. */
static void add_up_constants(size_t bands, double part, const double *spread,
                             const double *left, const double *right, double *here) {
  const double l = spread ? spread[0] : 1, r = spread ? spread[1] : 1;
  for (size_t b = 0; b < bands; b++) {
    const double x = l * left[b], y = r * right[b];
    here[b] = part == 0.5 ? 0.5 * (x + y) : y + part * (x - y);
  }
}

void hr2di_push_pull_up(const hr2di_push_pull *p, const double *spread, double *field) {
  const size_t bands = p->bands, width = p->order * bands;
  const hr2d_element *element = p->hierarchy->element;
  for (uint32_t e = (uint32_t)p->elements; e-- > 0;) {
    if (declare(p, e)) return;
    if (!element[e].child) continue;
    const double *left = field + element[e].child * width, *right = left + width;
    double *here = field + e * width;
    const double part = hr2di_element_left_part(element, e);
    if (width == bands) {
      add_up_constants(bands, part, spread ? spread + element[e].child : NULL, left, right,
                       here);
      continue;
    }
    const double *relation = hr2di_push_pull_relation(p, e);
    for (size_t k = 0; k < width; k++) here[k] = 0;
    add_up(p, relation, part, left, here);
    add_up(p, relation + p->order * p->order, 1 - part, right, here);
  }
}

/* child_k += Σ_l relation_lk parent_l */
static inline void add_down_bands(const double *relation, size_t order, size_t bands,
                                  const double *restrict parent, double *restrict child) {
  for (size_t l = 0; l < order; l++)
    for (size_t k = 0; k <= l; k++)
      for (size_t b = 0; b < bands; b++)
        child[k * bands + b] += relation[l * order + k] * parent[l * bands + b];
}

static void add_down(const hr2di_push_pull *p, const double *relation, const double *parent,
                     double *child) {
  if (p->bands == 1)
    add_down_bands(relation, p->order, 1, parent, child);
  else
    add_down_bands(relation, p->order, p->bands, parent, child);
}

void hr2di_push_pull_down(const hr2di_push_pull *p, const double *spread, double *field) {
  const size_t bands = p->bands, width = p->order * bands, square = p->order * p->order;
  const hr2d_element *element = p->hierarchy->element;
  for (uint32_t e = 0; e < p->elements; e++) {
    const uint32_t parent = p->hierarchy->parent[e];
    if (declare(p, e)) return;
    if (parent == e) continue;
    double *here = field + e * width;
    const double *from = field + parent * width;
    if (width == bands) {
      const double part = spread ? spread[e] : 1;
      for (size_t b = 0; b < bands; b++) here[b] += part * from[b];
      continue;
    }
    const int right = e == element[parent].child + 1;
    add_down(p, hr2di_push_pull_relation(p, parent) + (right ? square : 0), from, here);
  }
}
