/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The covariance of B on an element j and of the factors F(·,i), which is known to within
   `off`, makes the gap of the mean over the patch of i wider by A_j off/A_i.  The sum over all
   i is the share of j.  The leaves with the largest shares that make
   HR2DI_CHOICE_ENCLOSURE_MARKED of all of them together are halved (Dörfler's marking): then
   shares become even. */
#include "enclosure/enclosure-marks.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/sort.h"
#include "scene/scene-impl.h"

typedef struct share {
  double of_gap;
  uint32_t leaf;
} share;

static int by_size(const void *a, const void *b) {
  const share *s = a, *t = b;
  if (s->of_gap != t->of_gap) return s->of_gap < t->of_gap ? 1 : -1;
  return (s->leaf > t->leaf) - (s->leaf < t->leaf);
}

static double length_of_patch(const hr2di_enclosing *e, uint32_t leaf) {
  return e->hierarchy->element[e->hierarchy->element[leaf].patch].length;
}

/* What the ranges of one element leave open of the mean over the patch of the other one. */
static double part_of(const hr2di_enclosing *e, const hr2di_enclosed_link *l, int from,
                      const double *scale) {
  const hr2di_lit_range *b = &e->b[l->of[from] * e->bands];
  double upper = 0;
  for (size_t k = 0; k < e->bands; k++)
    if (scale[k] > 0)
      upper = fmax(upper, hr2di_covariance_of(&l->factor[from], &b[k].point).off / scale[k]);
  return upper * e->hierarchy->element[l->of[from]].length / length_of_patch(e, l->of[!from]);
}

static hr2d_status add_parts(const hr2di_enclosing *e, const double *scale, double *sum) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < e->count && !status; k++) {
    for (int from = 0; from < 2; from++)
      sum[e->link[k].of[from]] += part_of(e, &e->link[k], from, scale);
    status = hr2di_watch_work(e->watch, e->bands);
  }
  return status;
}

static size_t list_shares(const hr2di_enclosing *e, const double *sum, share *list) {
  const hr2d_hierarchy *h = e->hierarchy;
  size_t count = 0;
  for (uint32_t k = 0; k < e->elements; k++) {
    if (!hr2di_enclosing_has(e, k) || h->level[k] >= HR2D_DEFAULT_MAX_LEVEL ||
        !hr2di_element_divisible(h, k))
      continue;
    if (sum[k] > 0) list[count++] = (share){sum[k], k};
  }
  return count;
}

/* Links after a division: pairs of children, seen or not. */
static hr2d_status count_links(const hr2di_enclosing *e, const unsigned char *mark,
                               uint64_t *links) {
  hr2d_status status = HR2D_OK;
  *links = 0;
  for (size_t k = 0; k < e->count && !status; k++) {
    *links += (uint64_t)(1 + mark[e->link[k].of[0]]) * (1 + mark[e->link[k].of[1]]);
    if (k % 16 == 0) status = hr2di_watch_work(e->watch, 1);
  }
  return status;
}

static size_t count_largest(const share *list, size_t count) {
  double all = 0, sum = 0;
  size_t upper = 0;
  for (size_t k = 0; k < count; k++) all += list[k].of_gap;
  while (upper < count && sum < HR2DI_CHOICE_ENCLOSURE_MARKED * all)
    sum += list[upper++].of_gap;
  return upper;
}

/* Of those that are too many, half as many, until they are not; less than
   HR2DI_CHOICE_ENCLOSURE_LEAST of them are not worth a round. */
static hr2d_status choose(hr2di_enclosing *e, const share *list, size_t count,
                          uint64_t max_links, unsigned char *mark, size_t *marked) {
  hr2d_status status = HR2D_OK;
  const size_t wanted = count_largest(list, count);
  const double fewest = HR2DI_CHOICE_ENCLOSURE_LEAST * (double)wanted;
  for (*marked = wanted; *marked > 0 && (double)*marked > fewest && !status; *marked /= 2) {
    uint64_t links;
    memset(mark, 0, e->elements);
    for (size_t k = 0; k < *marked; k++) mark[list[k].leaf] = 1;
    status = count_links(e, mark, &links);
    if (links <= max_links) return status;
  }
  *marked = 0;
  return status;
}

hr2d_status hr2di_enclosing_mark(hr2di_enclosing *e, const double *scale, uint64_t max_links,
                                 unsigned char *mark, size_t *marked) {
  double *sum = hr2di_alloc_zero(&e->alloc, e->elements, sizeof *sum);
  share *list = hr2di_alloc(&e->alloc, e->elements, sizeof *list);
  hr2d_status status = sum && list ? HR2D_OK : HR2D_ENOMEM;
  size_t count = 0;
  if (!status) status = add_parts(e, scale, sum);
  if (!status) count = list_shares(e, sum, list);
  if (!status) status = hr2di_sort(list, count, sizeof *list, by_size, e->watch);
  if (!status) status = choose(e, list, count, max_links, mark, marked);
  hr2di_alloc_free(&e->alloc, sum);
  hr2di_alloc_free(&e->alloc, list);
  return status;
}
