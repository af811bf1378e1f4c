/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "triangulation/merge-vertices.h"

#include <math.h>

#include "base/alloc.h"

/* Cells are so many tolerances wide: most points have all of their reach in one cell. */
#define WIDTH 64.0

hr2d_status hr2di_merge_vertices_init(hr2di_merge_vertices *a, const hr2d_allocator *alloc,
                                      size_t max, double tolerance) {
  size_t heads = 16;
  while (heads < max) heads *= 2;
  a->mask = heads - 1;
  a->tolerance = tolerance;
  a->cell = WIDTH * fmax(tolerance, 0x1p-900);
  a->head = hr2di_alloc_zero(alloc, heads, sizeof *a->head);
  a->next = hr2di_alloc(alloc, max, sizeof *a->next);
  a->reach = hr2di_alloc(alloc, max, sizeof *a->reach);
  return a->head && a->next && a->reach ? HR2D_OK : HR2D_ENOMEM;
}

void hr2di_merge_vertices_clear(hr2di_merge_vertices *a, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, a->head);
  hr2di_alloc_free(alloc, a->next);
  hr2di_alloc_free(alloc, a->reach);
}

static uint32_t *head_of(hr2di_merge_vertices *a, double column, double row) {
  const uint64_t x = (uint64_t)(int64_t)column, y = (uint64_t)(int64_t)row;
  uint64_t bits = x * UINT64_C(0x9e3779b97f4a7c15) ^ y * UINT64_C(0xc2b2ae3d27d4eb4f);
  bits = (bits ^ bits >> 32) * UINT64_C(0xd6e8feb86659fd93);
  return &a->head[(bits ^ bits >> 29) & a->mask];
}

/* Looks in one list for the nearest point; *nearest is its distance. */
static hr2d_status search(hr2di_merge_vertices *a, uint32_t head, hr2d_point p, double reach,
                          double *nearest) {
  for (uint32_t k = head; k != 0; k = a->next[k - 1]) {
    if (hr2di_watch_work(a->watch, 1)) return hr2di_watch_status(a->watch);
    const hr2d_point q = a->at[k - 1];
    if (fabs(q.x - p.x) > reach || fabs(q.y - p.y) > reach) continue;
    const double distance = hypot(q.x - p.x, q.y - p.y);
    if (distance > fmin(reach, a->reach[k - 1]) || distance >= *nearest) continue;
    *nearest = distance;
    a->found = k - 1;
  }
  return HR2D_OK;
}

hr2d_status hr2di_merge_vertices_add(hr2di_merge_vertices *a, hr2d_point p, double reach) {
  const double left = floor((p.x - reach) / a->cell), right = floor((p.x + reach) / a->cell),
               low = floor((p.y - reach) / a->cell), high = floor((p.y + reach) / a->cell);
  double nearest = INFINITY;
  for (double x = left; x <= right; x++)
    for (double y = low; y <= high; y++)
      if (search(a, *head_of(a, x, y), p, reach, &nearest)) return hr2di_watch_status(a->watch);
  if (nearest < INFINITY) {
    a->reach[a->found] = fmin(a->reach[a->found], reach);
    return HR2D_OK;
  }
  uint32_t *head = head_of(a, floor(p.x / a->cell), floor(p.y / a->cell));
  a->found = (uint32_t)a->count;
  a->at[a->count] = p;
  a->reach[a->count] = reach;
  a->next[a->count++] = *head;
  *head = (uint32_t)a->count;
  return HR2D_OK;
}
