/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows are cut into runs of patches that stand side by side, some for each rank, and the runs
   are dealt out: the one with most work first, to the rank that has least of what this run has.
   A pair belongs to its earlier patch, so that early rows have more links for each test of
   visibility than late ones: single ranges cannot be even in both, several can.  Long rows are
   cut first. */
#include "deal.h"

#include <stdlib.h>

#include "long-rows.h"

enum { RUNS_PER_RANK = 32 };

/* Rows, or a piece of a row. */
typedef struct run {
  size_t from, to;
  uint32_t piece, pieces; /* of a long row; else 0 and 1 */
  double part[2];         /* of all links, and of all tests */
} run;

typedef struct dealer {
  hr2dp *p;
  run *run;
  size_t runs;
  double *load; /* 2 per rank */
} dealer;

static double size_of(const run *r) {
  return fmax(r->part[0], r->part[1]);
}

static void cut_row(dealer *d, size_t row, uint32_t pieces, const double *part) {
  for (uint32_t k = 0; k < pieces; k++)
    d->run[d->runs++] = (run){row, row + 1, k, pieces, {part[0] / pieces, part[1] / pieces}};
}

/* A run ends where it has its part of the work of both kinds together. */
static void cut_runs(dealer *d, const double *part) {
  const size_t patches = d->p->patches;
  const double max = 1.0 / (RUNS_PER_RANK * d->p->ranks);
  run r = {.pieces = 1};
  for (size_t k = 0; k < patches; k++) {
    const uint32_t pieces = hr2dpi_long_rows_pieces(d->p, k);
    for (size_t kind = 0; kind < 2 && pieces == 1; kind++) r.part[kind] += part[2 * k + kind];
    r.to = pieces == 1 ? k + 1 : k;
    if (size_of(&r) < max && k + 1 < patches && pieces == 1) continue;
    if (r.to > r.from) d->run[d->runs++] = r;
    if (pieces > 1) cut_row(d, k, pieces, &part[2 * k]);
    r = (run){.from = k + 1, .pieces = 1};
  }
}

/* The largest comes first; of equal ones the earlier. */
static int by_size(const void *left, const void *right) {
  const run *l = left, *r = right;
  if (size_of(l) != size_of(r)) return size_of(l) > size_of(r) ? -1 : 1;
  if (l->from != r->from) return l->from > r->from ? 1 : -1;
  return (l->piece > r->piece) - (l->piece < r->piece);
}

static int min_loaded(const dealer *d, const run *r) {
  double min = HUGE_VAL;
  int found = 0;
  for (int rank = 0; rank < d->p->ranks; rank++) {
    const double *load = d->load + 2 * rank;
    const double then = fmax(load[0] + r->part[0], load[1] + r->part[1]);
    if (then < min) {
      min = then;
      found = rank;
    }
  }
  return found;
}

static void deal(dealer *d) {
  hr2dpi_units *units = &d->p->units;
  qsort(d->run, d->runs, sizeof *d->run, by_size);
  memset(units->rows, 0, d->p->patches);
  for (size_t k = 0; k < d->runs; k++) {
    const run *r = &d->run[k];
    const int rank = min_loaded(d, r);
    d->load[2 * rank] += r->part[0];
    d->load[2 * rank + 1] += r->part[1];
    for (size_t row = r->from; row < r->to; row++)
      units->owner[units->piece[row] + r->piece] = rank;
    if (rank == d->p->rank) memset(units->rows + r->from, 1, r->to - r->from);
  }
}

hr2d_status hr2dpi_deal_rows(hr2dp *p, double *weight) {
  dealer d = {.p = p};
  double all[2] = {0, 0};
  for (size_t k = 0; k < 2 * p->patches; k++) all[k % 2] += weight[k];
  for (size_t k = 0; k < 2 * p->patches; k++)
    if (all[k % 2] > 0) weight[k] /= all[k % 2];
  hr2d_status status = hr2dpi_long_rows_cut(p, weight);
  d.run = hr2dpi_alloc(p, p->patches + p->units.cuts, sizeof *d.run);
  d.load = hr2dpi_alloc_zero(p, 2 * (size_t)p->ranks, sizeof *d.load);
  if (!status && (!d.run || !d.load)) status = HR2D_ENOMEM;
  if (!status) {
    cut_runs(&d, weight);
    deal(&d);
  }
  hr2dpi_free(p, d.run);
  hr2dpi_free(p, d.load);
  return status;
}
