/* SPDX-License-Identifier: GPL-3.0-or-later */
/* About two points to a cell.  The strip of a segment a + t u has the points with
   0 < (p − a)·u < u·u.  In a row that is an interval of x.  What roundings may do is added to
   it on either side. */
#include "mesh/point-grid.h"

#include <math.h>

#include "base/alloc.h"

/* Of sums of a few products, relative to the largest of them, by far. */
#define ROUNDING 1e-12

enum { IN_CELL = 2, MOST_CELLS = 1 << 12 };

static uint32_t cells_across(double size, size_t count) {
  return size > 0 ? (uint32_t)fmin(1 + floor(sqrt((double)count / IN_CELL)), MOST_CELLS) : 1;
}

/* The cell of a coordinate; before the first it is the first, and behind the last the last. */
static uint32_t cell_at(double offset, double cell, uint32_t cells) {
  if (!(cell > 0)) return 0;
  const double k = floor(offset / cell);
  return k > 0 ? (uint32_t)fmin(k, cells - 1.0) : 0;
}

static size_t cell_of(const hr2di_point_grid *g, hr2d_point p) {
  return (size_t)cell_at(p.y - g->y0, g->cell[1], g->rows) * g->columns +
         cell_at(p.x - g->x0, g->cell[0], g->columns);
}

static void set_frame(hr2di_point_grid *g, const hr2d_point *point, size_t count) {
  double x1, y1;
  g->x0 = x1 = point[0].x;
  g->y0 = y1 = point[0].y;
  for (size_t k = 1; k < count; k++) {
    g->x0 = fmin(g->x0, point[k].x);
    x1 = fmax(x1, point[k].x);
    g->y0 = fmin(g->y0, point[k].y);
    y1 = fmax(y1, point[k].y);
  }
  g->columns = cells_across(x1 - g->x0, count);
  g->rows = cells_across(y1 - g->y0, count);
  g->cell[0] = (x1 - g->x0) / g->columns;
  g->cell[1] = (y1 - g->y0) / g->rows;
}

hr2d_status hr2di_point_grid_init(hr2di_point_grid *g, const hr2d_point *point, size_t count,
                                  const hr2d_allocator *alloc, hr2di_watch *watch) {
  *g = (hr2di_point_grid){0};
  set_frame(g, point, count);
  const size_t cells = (size_t)g->columns * g->rows;
  g->first = hr2di_alloc_zero(alloc, cells + 1, sizeof *g->first);
  g->number = hr2di_alloc(alloc, count, sizeof *g->number);
  if (!g->first || !g->number) return HR2D_ENOMEM;
  for (size_t k = 0; k < count && !hr2di_watch_work(watch, k % 64 == 0 ? 16 : 0); k++)
    g->first[cell_of(g, point[k]) + 1]++;
  if (hr2di_watch_status(watch)) return hr2di_watch_status(watch);
  for (size_t k = 0; k < cells; k++) g->first[k + 1] += g->first[k];
  for (size_t k = 0; k < count; k++) g->number[g->first[cell_of(g, point[k])]++] = (uint32_t)k;
  for (size_t k = cells; k > 0; k--) g->first[k] = g->first[k - 1];
  g->first[0] = 0;
  return hr2di_watch_work(watch, count / 2);
}

void hr2di_point_grid_clear(hr2di_point_grid *g, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, g->first);
  hr2di_alloc_free(alloc, g->number);
  *g = (hr2di_point_grid){0};
}

hr2di_grid_span hr2di_point_grid_strip(const hr2di_point_grid *g, uint32_t row,
                                       hr2d_segment s) {
  const hr2di_grid_span all = {0, g->columns}, none = {0, 0};
  const double ux = s.b.x - s.a.x, uy = s.b.y - s.a.y, square = ux * ux + uy * uy;
  const double below = (g->y0 + row * g->cell[1] - s.a.y) * uy,
               above = (g->y0 + (row + 1) * g->cell[1] - s.a.y) * uy;
  const double min = fmin(below, above), max = fmax(below, above);
  const double off = ROUNDING * (square + fmax(fabs(min), fabs(max)));
  if (ux == 0) return max >= -off && min <= square + off ? all : none;
  /* (x − a.x) ux is between −most and u·u − least. */
  const double p = (-max - off) / ux, q = (square - min + off) / ux;
  const double from = s.a.x - g->x0 + fmin(p, q), to = s.a.x - g->x0 + fmax(p, q);
  const double width = g->cell[0] * g->columns;
  if (!(from <= width * (1 + ROUNDING)) || !(to >= -width * ROUNDING)) return none;
  return (hr2di_grid_span){cell_at(from - width * ROUNDING, g->cell[0], g->columns),
                           cell_at(to + width * ROUNDING, g->cell[0], g->columns) + 1};
}
