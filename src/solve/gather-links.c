/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In one band of a low order a call for each link would take longer than its products: the
   order is a constant to the compiler there.  Neighbours in the store mostly share their first
   element, whose sums stay in registers.  Sums are added in the order of hr2di_gather_both().
   Vectors are written down: compilers make some of the columns of small blocks. */
#include "solve/gather-links.h"

#include "base/ordered-dot.h"
#include "base/wide.h"
#include "links/block-numbers.h"
#include "solve/gather-blocks.h"

enum { LOW = 8, FOURS = LOW / 4 };

/* Four numbers side by side, at any address. */
typedef double four __attribute__((vector_size(32), aligned(8), may_alias));

/* A block as it is stored, see block-numbers.h. */
typedef struct stored {
  const void *number;
  size_t stride;
  double area;
  int single;
} stored;

HR2DI_PART void load_four(const stored *c, size_t k, four *to) {
  if (c->single) {
    const float *from = (const float *)c->number + k;
    *to = (four){(double)from[0], (double)from[1], (double)from[2], (double)from[3]} * c->area;
  } else {
    *to = *(const four *)((const double *)c->number + k);
  }
}

/* One link: `to_i` receives from up_j, and `to_j` from `up_i` unless that is not asked for. */
HR2DI_PART void add_link(const stored *c, size_t order, const double *up_i, const double *up_j,
                         double *to_i, double *to_j, int both) {
  const size_t fours = order / 4, rest = order % 4;
  four from[FOURS], sum[FOURS];
  double from_rest[3], sum_rest[3];
  for (size_t q = 0; q < fours; q++) from[q] = *(const four *)(up_j + 4 * q);
  for (size_t m = 0; m < rest; m++) from_rest[m] = up_j[4 * fours + m];
  for (size_t q = 0; q < fours && both; q++) sum[q] = *(const four *)(to_j + 4 * q);
  for (size_t m = 0; m < rest && both; m++) sum_rest[m] = to_j[4 * fours + m];
  for (size_t l = 0; l < order; l++) {
    const size_t row = l * c->stride;
    four s = {0};
    double t = 0;
    for (size_t q = 0; q < fours; q++) {
      four entry;
      load_four(c, row + 4 * q, &entry);
      s += entry * from[q];
      if (both) sum[q] += entry * up_i[l];
    }
    for (size_t m = 0; m < rest; m++) {
      const double entry = hr2di_number_at(c->number, row + 4 * fours + m, c->single, c->area);
      t += entry * from_rest[m];
      if (both) sum_rest[m] += entry * up_i[l];
    }
    to_i[l] += hr2di_dot_four(s[0], s[1], s[2], s[3]) + t;
  }
  for (size_t q = 0; q < fours && both; q++) *(four *)(to_j + 4 * q) = sum[q];
  for (size_t m = 0; m < rest && both; m++) to_j[4 * fours + m] = sum_rest[m];
}

/* Runs of links with the same first element. */
HR2DI_PART void add_run(const hr2di_link_run *run, int single, size_t order,
                        const double *restrict up, double *restrict down, int both) {
  const size_t bytes = run->stride * run->stride * hr2di_number_size(single);
  for (size_t k = 0; k < run->count;) {
    const uint32_t first = run->link[k].pair.first;
    double up_i[LOW], to_i[LOW];
    for (size_t l = 0; l < order; l++) up_i[l] = up[first * order + l];
    for (size_t l = 0; l < order; l++) to_i[l] = down[first * order + l];
    for (; k < run->count && run->link[k].pair.first == first; k++) {
      const size_t second = run->link[k].pair.second;
      const stored c = {(const char *)run->block + k * bytes, run->stride,
                        run->link[k].exchange_area, single};
      add_link(&c, order, up_i, up + second * order, to_i, down + second * order, both);
    }
    for (size_t l = 0; l < order; l++) down[first * order + l] = to_i[l];
  }
}

HR2DI_PART void add_order(const hr2di_link_run *run, int single, size_t order, const double *up,
                          double *down, int both) {
  switch (order) {
  case 2:
    add_run(run, single, 2, up, down, both);
    return;
  case 3:
    add_run(run, single, 3, up, down, both);
    return;
  case 4:
    add_run(run, single, 4, up, down, both);
    return;
  case 5:
    add_run(run, single, 5, up, down, both);
    return;
  case 6:
    add_run(run, single, 6, up, down, both);
    return;
  case 7:
    add_run(run, single, 7, up, down, both);
    return;
  default:
    add_run(run, single, LOW, up, down, both);
  }
}

HR2DI_PART void low_loop(const hr2di_link_run *run, size_t order, const double *up,
                         double *down, int both) {
  if (run->single)
    add_order(run, 1, order, up, down, both);
  else
    add_order(run, 0, order, up, down, both);
}

HR2DI_PART void both_ways_loop(const hr2di_link_run *run, size_t order, const double *up,
                               double *down) {
  low_loop(run, order, up, down, 1);
}
HR2DI_WIDE(both_ways, (const hr2di_link_run *run, size_t order, const double *up, double *down),
           (run, order, up, down))

HR2DI_PART void one_way_loop(const hr2di_link_run *run, size_t order, const double *up,
                             double *down) {
  low_loop(run, order, up, down, 0);
}
HR2DI_WIDE(one_way, (const hr2di_link_run *run, size_t order, const double *up, double *down),
           (run, order, up, down))

HR2DI_PART void widen_loop(const void *block, size_t square, double area, double *to) {
  for (size_t k = 0; k < square; k++) to[k] = hr2di_number_at(block, k, 1, area);
}
HR2DI_WIDE(widen, (const void *block, size_t square, double area, double *to),
           (block, square, area, to))

/* Any order and number of bands. */
static void add_each(const hr2di_link_run *run, size_t order, size_t bands, const double *up,
                     double *down) {
  const size_t width = order * bands, stride = run->stride, square = stride * stride;
  const size_t bytes = square * hr2di_number_size(run->single);
  double room[HR2D_MAX_ORDER * HR2D_MAX_ORDER];
  for (size_t k = 0; k < run->count; k++) {
    const hr2d_pair pair = run->link[k].pair;
    const void *block = (const char *)run->block + k * bytes;
    const double *c = run->single ? room : block;
    const size_t i = pair.first * width, j = pair.second * width;
    if (run->single) widen(block, square, run->link[k].exchange_area, room);
    if (run->directed)
      hr2di_gather_block(c, stride, order, bands, up + j, down + i);
    else
      hr2di_gather_both(c, stride, order, bands, up + i, up + j, down + i, down + j);
  }
}

void hr2di_gather_links(const hr2di_link_run *run, size_t order, size_t bands, const double *up,
                        double *down) {
  if (bands > 1 || order > LOW)
    add_each(run, order, bands, up, down);
  else if (run->directed)
    one_way(run, order, up, down);
  else
    both_ways(run, order, up, down);
}
