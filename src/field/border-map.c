/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "field/border-map.h"

#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"

/* Borders of a tile that are kept. */
enum { CROWD = 256 };

/* A ray in nodes, with lengths along it as they are in the plane. */
typedef struct ray {
  double from[2], along[2], low, high; /* from `low` to `high` along it */
} ray;

static ray ray_of(const hr2di_border_map *m, const hr2di_border *b) {
  return (ray){.from = {(b->from.x - m->low.x) / m->step.x, (b->from.y - m->low.y) / m->step.y},
               .along = {b->along.x / m->step.x, b->along.y / m->step.y},
               .high = b->reach};
}

/* Clips a ray to low ≤ coordinate k ≤ high.  Returns whether something is left. */
static int clip(ray *r, int k, double low, double high) {
  const double one = (low - r->from[k]) / r->along[k],
               other = (high - r->from[k]) / r->along[k];
  if (r->along[k] == 0) return low <= r->from[k] && r->from[k] <= high;
  r->low = fmax(r->low, fmin(one, other));
  r->high = fmin(r->high, fmax(one, other));
  return r->low <= r->high;
}

static size_t tile_at(const hr2di_border_map *m, int k, double node) {
  const double tile = floor((node - 1) / HR2DI_TILE);
  return tile > 0 ? (size_t)fmin(tile, (double)(m->tiles[k] - 1)) : 0;
}

static double place(const ray *r, int k, double t) {
  return r->from[k] + t * r->along[k];
}

/* Counts a border in first[tile + 1], or puts it into the lists, from first[tile] on. */
static void cross_tile(hr2di_border_map *m, size_t tile, uint32_t border) {
  if (!m->list)
    m->first[tile + 1]++;
  else if (!m->crowded[tile])
    m->list[m->first[tile]++] = border;
}

/* The tiles of a row that a ray crosses. */
static void cross_row(hr2di_border_map *m, ray r, size_t row, uint32_t border) {
  const double low = 1 + (double)(HR2DI_TILE * row);
  if (!clip(&r, 1, low - m->margin[1], low + HR2DI_TILE + m->margin[1])) return;
  const double one = place(&r, 0, r.low), other = place(&r, 0, r.high);
  const size_t last = tile_at(m, 0, fmax(one, other) + m->margin[0]);
  for (size_t k = tile_at(m, 0, fmin(one, other) - m->margin[0]); k <= last; k++)
    cross_tile(m, row * m->tiles[0] + k, border);
}

static hr2d_status cross_tiles(hr2di_border_map *m, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (size_t n = 0; n < m->borders->count && !status; n++) {
    ray r = ray_of(m, &m->borders->border[n]);
    status = hr2di_watch_work(watch, 4);
    if (!clip(&r, 0, 1 - m->margin[0], 1 + (double)(HR2DI_TILE * m->tiles[0]) + m->margin[0]) ||
        !clip(&r, 1, 1 - m->margin[1], 1 + (double)(HR2DI_TILE * m->tiles[1]) + m->margin[1]))
      continue;
    const double one = place(&r, 1, r.low), other = place(&r, 1, r.high);
    const size_t last = tile_at(m, 1, fmax(one, other) + m->margin[1]);
    for (size_t row = tile_at(m, 1, fmin(one, other) - m->margin[1]); row <= last && !status;
         row++) {
      cross_row(m, r, row, (uint32_t)n);
      status = hr2di_watch_work(watch, 2);
    }
  }
  return status;
}

hr2d_status hr2di_border_map_init(hr2di_border_map *m, const hr2di_borders *borders,
                                  const hr2d_allocator *alloc, hr2di_watch *watch) {
  const size_t tiles = m->tiles[0] * m->tiles[1];
  m->alloc = *alloc;
  m->borders = borders;
  /* What roundings move, and some of a cell. */
  m->margin[0] = 1e-6 + 0x1p-40 / fabs(m->step.x);
  m->margin[1] = 1e-6 + 0x1p-40 / fabs(m->step.y);
  m->first = hr2di_alloc_zero(alloc, tiles + 1, sizeof *m->first);
  m->crowded = hr2di_alloc_zero(alloc, tiles, 1);
  if (!m->first || !m->crowded) return HR2D_ENOMEM;
  hr2d_status status = cross_tiles(m, watch);
  for (size_t k = 0; k < tiles; k++) {
    m->crowded[k] = m->first[k + 1] > CROWD;
    m->first[k + 1] = m->first[k] + (m->crowded[k] ? 0 : m->first[k + 1]);
  }
  m->list = hr2di_alloc(alloc, m->first[tiles] + 1, sizeof *m->list);
  if (!m->list) return HR2D_ENOMEM;
  if (!status) status = cross_tiles(m, watch);
  /* Every start has become that of the next tile. */
  for (size_t k = tiles; k > 0; k--) m->first[k] = m->first[k - 1];
  m->first[0] = 0;
  return status;
}

void hr2di_border_map_clear(hr2di_border_map *m) {
  hr2di_alloc_free(&m->alloc, m->crowded);
  hr2di_alloc_free(&m->alloc, m->first);
  hr2di_alloc_free(&m->alloc, m->list);
}

/* The slope jumps by s across a line.  Linear interpolation over a length h across misses at
   most s h/4, and along a side of a cell it meets n h of it, with n the normal of the line. */
static double error_of(const hr2di_border_map *m, const hr2di_border *b, double near,
                       const double cell[2]) {
  const double slope = b->jump / (2 * HR2DI_PI) * b->behind / (near * (near + b->behind));
  return slope / 4 *
         (fabs(b->along.y * m->step.x) * cell[0] + fabs(b->along.x * m->step.y) * cell[1]);
}

double hr2di_border_map_error(const hr2di_border_map *m, size_t tile, const hr2di_map_block *b,
                              int *lit) {
  double sum = 0;
  *lit = 0;
  for (size_t n = m->first[tile]; n < m->first[tile + 1]; n++) {
    const hr2di_border *border = &m->borders->border[m->list[n]];
    ray r = ray_of(m, border);
    if (!clip(&r, 0, b->low[0] - m->margin[0], b->high[0] + m->margin[0]) ||
        !clip(&r, 1, b->low[1] - m->margin[1], b->high[1] + m->margin[1]))
      continue;
    *lit |= border->lit;
    sum += border->jump < HUGE_VAL ? error_of(m, border, r.low, b->cell) : HUGE_VAL;
    if (!(sum < HUGE_VAL)) return HUGE_VAL;
  }
  return sum;
}
