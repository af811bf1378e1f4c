/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In one band of a low order a call for each link would take longer than its products: the
   order is a constant to the compiler there.  Neighbours in the store mostly share their first
   element, whose sums stay in registers.  Sums are added in the order of hr2di_gather_both().
 */
#include "solve/gather-links.h"

#include "base/ordered-dot.h"
#include "base/wide.h"
#include "solve/gather-blocks.h"

/* Σ_m row_m from_m */
HR2DI_PART double row_sum(const double *row, const double *from, size_t order) {
  double s[4] = {0}, rest = 0;
  size_t m = 0;
  for (; m + 4 <= order; m += 4)
    for (size_t k = 0; k < 4; k++) s[k] += row[m + k] * from[m + k];
  for (; m < order; m++) rest += row[m] * from[m];
  return hr2di_dot_four(s[0], s[1], s[2], s[3]) + rest;
}

enum { LOW = 8 };

/* One link: `to_i` receives from up_j, and `to_j` from `up_i` unless that is not asked for. */
HR2DI_PART void add_link(const double *c, size_t stride, size_t order, const double *up_i,
                         const double *up_j, double *to_i, double *to_j, int both) {
  double from[LOW], sum[LOW];
  for (size_t m = 0; m < order; m++) from[m] = up_j[m];
  for (size_t m = 0; m < order && both; m++) sum[m] = to_j[m];
  for (size_t l = 0; l < order; l++) {
    const double *row = c + l * stride;
    to_i[l] += row_sum(row, from, order);
    for (size_t m = 0; m < order && both; m++) sum[m] += row[m] * up_i[l];
  }
  for (size_t m = 0; m < order && both; m++) to_j[m] = sum[m];
}

/* Runs of links with the same first element. */
HR2DI_PART void add_run(const hr2di_link_run *run, size_t order, const double *restrict up,
                        double *restrict down, int both) {
  const size_t square = run->stride * run->stride;
  for (size_t k = 0; k < run->count;) {
    const uint32_t first = run->link[k].pair.first;
    double up_i[LOW], to_i[LOW];
    for (size_t l = 0; l < order; l++) up_i[l] = up[first * order + l];
    for (size_t l = 0; l < order; l++) to_i[l] = down[first * order + l];
    for (; k < run->count && run->link[k].pair.first == first; k++) {
      const size_t second = run->link[k].pair.second;
      add_link(run->block + k * square, run->stride, order, up_i, up + second * order, to_i,
               down + second * order, both);
    }
    for (size_t l = 0; l < order; l++) down[first * order + l] = to_i[l];
  }
}

HR2DI_PART void low_loop(const hr2di_link_run *run, size_t order, const double *up,
                         double *down, int both) {
  switch (order) {
  case 2:
    add_run(run, 2, up, down, both);
    return;
  case 3:
    add_run(run, 3, up, down, both);
    return;
  case 4:
    add_run(run, 4, up, down, both);
    return;
  case 5:
    add_run(run, 5, up, down, both);
    return;
  case 6:
    add_run(run, 6, up, down, both);
    return;
  case 7:
    add_run(run, 7, up, down, both);
    return;
  default:
    add_run(run, LOW, up, down, both);
  }
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

/* Any order and number of bands. */
static void add_each(const hr2di_link_run *run, size_t order, size_t bands, const double *up,
                     double *down) {
  const size_t width = order * bands, stride = run->stride;
  for (size_t k = 0; k < run->count; k++) {
    const hr2d_pair pair = run->link[k].pair;
    const double *c = run->block + k * stride * stride;
    const size_t i = pair.first * width, j = pair.second * width;
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
