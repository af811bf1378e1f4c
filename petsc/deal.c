/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows are cut into runs of patches that stand side by side, some for each rank, and the runs
   are dealt out: the one with most work first, to the rank that has least of what this run has.
   A pair belongs to its earlier patch, so that early rows have more links for each test of
   visibility than late ones: single ranges cannot be even in both, several can. */
#include "deal.h"

#include <stdlib.h>

enum { RUNS_PER_RANK = 32 };

typedef struct run {
  size_t from, to;
  double part[2]; /* of all links, and of all tests */
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

/* A run ends where it has its part of the work of both kinds together. */
static void cut_runs(dealer *d, const double *weight, const double all[2]) {
  const size_t patches = d->p->patches;
  const double most = 1.0 / (RUNS_PER_RANK * d->p->ranks);
  run r = {0};
  for (size_t k = 0; k < patches; k++) {
    for (int kind = 0; kind < 2; kind++)
      if (all[kind] > 0) r.part[kind] += weight[2 * k + (size_t)kind] / all[kind];
    r.to = k + 1;
    if (size_of(&r) < most && k + 1 < patches) continue;
    d->run[d->runs++] = r;
    r = (run){.from = k + 1};
  }
}

/* The largest comes first; of equal ones the earlier. */
static int by_size(const void *left, const void *right) {
  const run *l = left, *r = right;
  if (size_of(l) != size_of(r)) return size_of(l) > size_of(r) ? -1 : 1;
  return (l->from > r->from) - (l->from < r->from);
}

static int least_loaded(const dealer *d, const run *r) {
  double least = HUGE_VAL;
  int found = 0;
  for (int rank = 0; rank < d->p->ranks; rank++) {
    const double *load = d->load + 2 * rank;
    const double then = fmax(load[0] + r->part[0], load[1] + r->part[1]);
    if (then < least) {
      least = then;
      found = rank;
    }
  }
  return found;
}

static void deal(dealer *d) {
  qsort(d->run, d->runs, sizeof *d->run, by_size);
  memset(d->p->units.rows, 0, d->p->patches);
  for (size_t k = 0; k < d->runs; k++) {
    const run *r = &d->run[k];
    const int rank = least_loaded(d, r);
    d->load[2 * rank] += r->part[0];
    d->load[2 * rank + 1] += r->part[1];
    if (rank == d->p->rank) memset(d->p->units.rows + r->from, 1, r->to - r->from);
  }
}

hr2d_status hr2dpi_deal_rows(hr2dp *p, const double *weight) {
  dealer d = {.p = p};
  double all[2] = {0, 0};
  for (size_t k = 0; k < 2 * p->patches; k++) all[k % 2] += weight[k];
  d.run = hr2dpi_alloc(p, p->patches, sizeof *d.run);
  d.load = hr2dpi_alloc_zero(p, 2 * (size_t)p->ranks, sizeof *d.load);
  const hr2d_status status = d.run && d.load ? HR2D_OK : HR2D_ENOMEM;
  if (!status) {
    cut_runs(&d, weight, all);
    deal(&d);
  }
  hr2dpi_free(p, d.run);
  hr2dpi_free(p, d.load);
  return status;
}
