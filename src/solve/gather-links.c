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

enum { LOW = 6 };

/* One link: `to_i` receives from up_j, and `to_j` from `up_i`, if they are asked for. */
HR2DI_PART void add_link(const double *c, size_t stride, size_t order, const double *up_i,
                         const double *up_j, double *to_i, double *to_j, int receives_i,
                         int receives_j) {
  double from[LOW], sum[LOW];
  for (size_t m = 0; m < order; m++) from[m] = up_j[m];
  for (size_t m = 0; m < order && receives_j; m++) sum[m] = to_j[m];
  for (size_t l = 0; l < order; l++) {
    const double *row = c + l * stride;
    if (receives_i) to_i[l] += row_sum(row, from, order);
    for (size_t m = 0; m < order && receives_j; m++) sum[m] += row[m] * up_i[l];
  }
  for (size_t m = 0; m < order && receives_j; m++) to_j[m] = sum[m];
}

/* Runs of links with the same first element. */
HR2DI_PART void add_run(const hr2di_link_run *run, size_t order, const double *restrict up,
                        double *restrict down, int whole) {
  const size_t square = run->stride * run->stride;
  for (size_t k = 0; k < run->count;) {
    const uint32_t first = run->link[k].pair.first;
    const int here = whole || (first >= run->from && first < run->to);
    double up_i[LOW], to_i[LOW] = {0};
    for (size_t l = 0; l < order; l++) up_i[l] = up[first * order + l];
    for (size_t l = 0; l < order && here; l++) to_i[l] = down[first * order + l];
    for (; k < run->count && run->link[k].pair.first == first; k++) {
      const size_t second = run->link[k].pair.second;
      const int there = whole || (!run->directed && second >= run->from && second < run->to);
      if (!here && !there) continue;
      add_link(run->block + k * square, run->stride, order, up_i, up + second * order, to_i,
               down + second * order, here, there);
    }
    for (size_t l = 0; l < order && here; l++) down[first * order + l] = to_i[l];
  }
}

HR2DI_PART void low_loop(const hr2di_link_run *run, size_t order, const double *up,
                         double *down, int whole) {
  switch (order) {
  case 2:
    add_run(run, 2, up, down, whole);
    return;
  case 3:
    add_run(run, 3, up, down, whole);
    return;
  case 4:
    add_run(run, 4, up, down, whole);
    return;
  case 5:
    add_run(run, 5, up, down, whole);
    return;
  default:
    add_run(run, LOW, up, down, whole);
  }
}

HR2DI_PART void whole_loop(const hr2di_link_run *run, size_t order, const double *up,
                           double *down) {
  low_loop(run, order, up, down, 1);
}
HR2DI_WIDE(whole, (const hr2di_link_run *run, size_t order, const double *up, double *down),
           (run, order, up, down))

HR2DI_PART void part_loop(const hr2di_link_run *run, size_t order, const double *up,
                          double *down) {
  low_loop(run, order, up, down, 0);
}
HR2DI_WIDE(part, (const hr2di_link_run *run, size_t order, const double *up, double *down),
           (run, order, up, down))

/* Any order and number of bands. */
static void add_each(const hr2di_link_run *run, size_t order, size_t bands, const double *up,
                     double *down) {
  const size_t width = order * bands, stride = run->stride;
  for (size_t k = 0; k < run->count; k++) {
    const hr2d_pair pair = run->link[k].pair;
    const double *c = run->block + k * stride * stride;
    const size_t i = pair.first * width, j = pair.second * width;
    const int to_i = run->all || (pair.first >= run->from && pair.first < run->to);
    const int to_j =
        run->all || (!run->directed && pair.second >= run->from && pair.second < run->to);
    if (to_i && to_j)
      hr2di_gather_both(c, stride, order, bands, up + i, up + j, down + i, down + j);
    else if (to_i)
      hr2di_gather_block(c, stride, order, bands, up + j, down + i);
    else if (to_j)
      hr2di_gather_transposed(c, stride, order, bands, up + i, down + j);
  }
}

void hr2di_gather_links(const hr2di_link_run *run, size_t order, size_t bands, const double *up,
                        double *down) {
  if (bands > 1 || order > LOW)
    add_each(run, order, bands, up, down);
  else if (run->all)
    whole(run, order, up, down);
  else
    part(run, order, up, down);
}
