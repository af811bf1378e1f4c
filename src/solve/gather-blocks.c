/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A row of the block is read once for a group of up to four bands, which lie side by side in a
   vector; of one band four coefficients do.  Sums are those of hr2di_dot_four(), whatever the
   number of bands.  What is constant to the compiler makes a loop of its own. */
#include "solve/gather-blocks.h"

#include <hr2d/hierarchy.h>

#include "base/ordered-dot.h"
#include "base/wide.h"
#include "solve/gather-one-way.h"

/* Bands of a group: they fill a vector. */
enum { GROUP = 4 };

/* Both ways in one band. */
HR2DI_PART void one_loop(const double *restrict c, size_t order, const double *restrict up_i,
                         const double *restrict up_j, double *restrict down_i,
                         double *restrict down_j) {
  for (size_t l = 0; l < order; l++, c += order) {
    hr2di_four s = {0};
    double rest = 0;
    size_t m = 0;
    for (; m + 4 <= order; m += 4) {
      const hr2di_four entry = *(const hr2di_four *)(c + m);
      s += entry * *(const hr2di_four *)(up_j + m);
      *(hr2di_four *)(down_j + m) += entry * up_i[l];
    }
    for (; m < order; m++) {
      rest += c[m] * up_j[m];
      down_j[m] += c[m] * up_i[l];
    }
    down_i[l] += hr2di_dot_four(s[0], s[1], s[2], s[3]) + rest;
  }
}

/* A block, and fields of so many bands from those of a group on. */
typedef struct group {
  const double *c;
  size_t order, bands;
  const double *up_i, *up_j;
  double *down_i, *down_j;
} group;

/* Compilers make a vector from single numbers in memory, which is slower. */
HR2DI_PART void load(const double *from, size_t width, hr2di_four *to) {
  typedef double pair __attribute__((vector_size(16), aligned(8), may_alias));
  const pair low = width == 1 ? (pair){*from, 0} : *(const pair *)from;
  if (width == GROUP)
    *to = *(const hr2di_four *)from;
  else if (width == 3)
    *to = __builtin_shufflevector(low, (pair){from[2], 0}, 0, 1, 2, 3);
  else
    *to = __builtin_shufflevector(low, (pair){0}, 0, 1, 2, 3);
}

HR2DI_PART void store(const hr2di_four *from, size_t width, double *to) {
  if (width == GROUP) *(hr2di_four *)to = *from;
  for (size_t b = 0; b < width && width < GROUP; b++) to[b] = (*from)[b];
}

/* Who receives: the first element of a pair by rows, the second one by columns, or both. */
enum { ROWS = 1, COLUMNS = 2, BOTH = 3 };

/* Two rows or one of the block, from number l on. */
HR2DI_PART void add_rows(const group *g, size_t l, size_t rows, size_t width, int ways,
                         hr2di_four *restrict sum) {
  const size_t order = g->order, bands = g->bands;
  const double *c = g->c + l * order;
  hr2di_four here[2] = {{0}}, s[2][4] = {{{0}}}, rest[2] = {{0}}, there = {0};
  size_t m = 0;
  for (size_t r = 0; r < rows && ways & COLUMNS; r++)
    load(g->up_i + (l + r) * bands, width, &here[r]);
  for (; m + 4 <= order; m += 4)
    for (size_t q = 0; q < 4; q++) {
      if (ways & ROWS) load(g->up_j + (m + q) * bands, width, &there);
      for (size_t r = 0; r < rows; r++) {
        if (ways & ROWS) s[r][q] += c[r * order + m + q] * there;
        if (ways & COLUMNS) sum[m + q] += c[r * order + m + q] * here[r];
      }
    }
  for (; m < order; m++) {
    if (ways & ROWS) load(g->up_j + m * bands, width, &there);
    for (size_t r = 0; r < rows; r++) {
      if (ways & ROWS) rest[r] += c[r * order + m] * there;
      if (ways & COLUMNS) sum[m] += c[r * order + m] * here[r];
    }
  }
  for (size_t r = 0; r < rows && ways & ROWS; r++) {
    double *to = g->down_i + (l + r) * bands;
    hr2di_four all;
    load(to, width, &all);
    all += ((s[r][0] + s[r][2]) + (s[r][1] + s[r][3])) + rest[r];
    store(&all, width, to);
  }
}

HR2DI_PART void add_group(const group *g, size_t width, int ways) {
  hr2di_four sum[HR2D_MAX_ORDER];
  size_t l = 0;
  for (size_t m = 0; m < g->order && ways & COLUMNS; m++)
    load(g->down_j + m * g->bands, width, &sum[m]);
  for (; l + 2 <= g->order; l += 2) add_rows(g, l, 2, width, ways, sum);
  if (l < g->order) add_rows(g, l, 1, width, ways, sum);
  for (size_t m = 0; m < g->order && ways & COLUMNS; m++)
    store(&sum[m], width, g->down_j + m * g->bands);
}

HR2DI_PART void add_groups(group g, int ways) {
  for (size_t left = g.bands, width; left > 0; left -= width) {
    width = left < GROUP ? left : GROUP;
    if (width == 1)
      add_group(&g, 1, ways);
    else if (width == 2)
      add_group(&g, 2, ways);
    else if (width == 3)
      add_group(&g, 3, ways);
    else
      add_group(&g, GROUP, ways);
    if (ways & ROWS) {
      g.up_j += width;
      g.down_i += width;
    }
    if (ways & COLUMNS) {
      g.up_i += width;
      g.down_j += width;
    }
  }
}

/* One group, side by side with those of the next coefficient. */
HR2DI_PART void add_few(group g, size_t bands) {
  g.bands = bands;
  add_group(&g, bands, BOTH);
}

HR2DI_PART void rows_loop(const group *g) {
  add_groups(*g, ROWS);
}
HR2DI_WIDE(rows, (const group *g), (g))

HR2DI_PART void columns_loop(const group *g) {
  add_groups(*g, COLUMNS);
}
HR2DI_WIDE(columns, (const group *g), (g))

HR2DI_PART void both_loop(const group *g) {
  if (g->bands == 2)
    add_few(*g, 2);
  else if (g->bands == 3)
    add_few(*g, 3);
  else if (g->bands == GROUP)
    add_few(*g, GROUP);
  else
    add_groups(*g, BOTH);
}
HR2DI_WIDE(both, (const group *g), (g))

HR2DI_WIDE(one,
           (const double *c, size_t order, const double *up_i, const double *up_j,
            double *down_i, double *down_j),
           (c, order, up_i, up_j, down_i, down_j))

void hr2di_gather_block(const double *c, size_t order, size_t bands, const double *from,
                        double *to) {
  if (bands == 1)
    hr2di_gather_rows(c, order, from, to);
  else
    rows(&(group){.c = c, .order = order, .bands = bands, .up_j = from, .down_i = to});
}

void hr2di_gather_transposed(const double *c, size_t order, size_t bands, const double *from,
                             double *to) {
  if (bands == 1)
    hr2di_gather_columns(c, order, from, to);
  else
    columns(&(group){.c = c, .order = order, .bands = bands, .up_i = from, .down_j = to});
}

void hr2di_gather_both(const double *c, size_t order, size_t bands, const double *up_i,
                       const double *up_j, double *down_i, double *down_j) {
  if (bands == 1)
    one(c, order, up_i, up_j, down_i, down_j);
  else
    both(&(group){c, order, bands, up_i, up_j, down_i, down_j});
}
