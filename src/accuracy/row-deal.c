/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row with most links comes first, to the share that has least.  A row that has more than a
   16th of what a share should have is cut into pieces; a share takes pieces of a row until it
   has its part, so that few shares refine the same row. */
#include "accuracy/row-deal.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/share.h"
#include "base/sort.h"

/* Pieces are no larger than this part of what a share should have. */
#define PIECE (1. / 16)

typedef struct weighed {
  double links;
  size_t row;
} weighed;

/* The longest first; of equal ones the first. */
static int by_links(const void *left, const void *right) {
  const weighed *l = left, *r = right;
  if (l->links != r->links) return l->links > r->links ? -1 : 1;
  return (l->row > r->row) - (l->row < r->row);
}

typedef struct dealer {
  const hr2d_share *share;
  hr2di_row_pieces *pieces;
  size_t rows;
  double *load; /* per share */
  double mean;
} dealer;

static unsigned least_loaded(const dealer *d) {
  unsigned least = 0;
  for (unsigned s = 1; s < d->share->count; s++)
    if (d->load[s] < d->load[least]) least = s;
  return least;
}

/* The links of piece k. */
static double links_of(double links, size_t pieces, size_t k) {
  return pieces == 1 ? links : floor((links - (double)k - 1) / (double)pieces) + 1;
}

static void deal_row(dealer *d, const weighed *row) {
  const size_t count = hr2di_row_pieces_of(d->pieces, row->row);
  unsigned char *mine = d->pieces->mine + d->pieces->first[row->row];
  for (size_t k = 0; k < count;) {
    const unsigned to = least_loaded(d);
    if (to == d->share->number) d->pieces->rows[row->row] = 1;
    do {
      mine[k] = to == d->share->number;
      d->load[to] += links_of(row->links, count, k++);
    } while (k < count && d->load[to] + links_of(row->links, count, k) <= d->mean);
  }
}

static void cut_rows(dealer *d, const double *links) {
  double all = 0;
  for (size_t k = 0; k < d->rows; k++) all += links[k];
  d->mean = all / d->share->count;
  d->pieces->first[0] = 0;
  for (size_t k = 0; k < d->rows; k++) {
    const double wanted = links[k] > PIECE * d->mean ? ceil(links[k] / (PIECE * d->mean)) : 1;
    d->pieces->first[k + 1] = d->pieces->first[k] + (size_t)fmax(1, fmin(wanted, links[k]));
  }
}

static hr2d_status deal(dealer *d, const hr2d_allocator *alloc, const double *links) {
  hr2di_row_pieces *p = d->pieces;
  weighed *order = hr2di_alloc(alloc, d->rows, sizeof *order);
  d->load = hr2di_alloc_zero(alloc, d->share->count, sizeof *d->load);
  p->first = hr2di_alloc(alloc, d->rows + 1, sizeof *p->first);
  p->rows = hr2di_alloc_zero(alloc, d->rows, 1);
  hr2d_status status = order && d->load && p->first && p->rows ? HR2D_OK : HR2D_ENOMEM;
  if (!status) {
    cut_rows(d, links);
    p->mine = hr2di_alloc(alloc, p->first[d->rows], 1);
    status = p->mine ? HR2D_OK : HR2D_ENOMEM;
  }
  for (size_t k = 0; k < d->rows && !status; k++) order[k] = (weighed){links[k], k};
  if (!status) status = hr2di_sort(order, d->rows, sizeof *order, by_links, NULL);
  for (size_t k = 0; k < d->rows && !status; k++) deal_row(d, &order[k]);
  hr2di_alloc_free(alloc, order);
  hr2di_alloc_free(alloc, d->load);
  return status;
}

hr2d_status hr2di_row_deal(hr2di_row_pieces *pieces, hr2d_linkset *links,
                           const hr2d_refine_options *options) {
  const hr2d_allocator *alloc = &links->alloc;
  const size_t rows = hr2di_scene_cell(links->hierarchy->scene);
  hr2d_refine_counts counts;
  hr2d_row_counts *row = hr2di_alloc_zero(alloc, rows, sizeof *row);
  double *number = hr2di_alloc_zero(alloc, rows, sizeof *number);
  hr2d_status status = row && number ? HR2D_OK : HR2D_ENOMEM;
  hr2d_refine_options counting = *options;
  counting.row_counts = row;
  if (!status) status = hr2d_refine_count(links, &counting, &counts);
  for (size_t k = 0; k < rows && !status; k++) number[k] = (double)row[k].links;
  status = hr2di_share_combine(options->share, status, HR2D_COMBINE_SUM, number, rows);
  dealer d = {.share = options->share, .pieces = pieces, .rows = rows};
  if (!status) status = deal(&d, alloc, number);
  hr2di_alloc_free(alloc, row);
  hr2di_alloc_free(alloc, number);
  return status;
}

hr2d_status hr2di_row_pieces_copy(hr2di_row_pieces *to, const hr2di_row_pieces *from,
                                  size_t rows, const hr2d_allocator *alloc) {
  const size_t pieces = from->first[rows];
  to->first = hr2di_alloc(alloc, rows + 1, sizeof *to->first);
  to->mine = hr2di_alloc(alloc, pieces, 1);
  to->rows = hr2di_alloc(alloc, rows, 1);
  if (!to->first || !to->mine || !to->rows) return HR2D_ENOMEM;
  memcpy(to->first, from->first, (rows + 1) * sizeof *to->first);
  memcpy(to->mine, from->mine, pieces);
  memcpy(to->rows, from->rows, rows);
  return HR2D_OK;
}

void hr2di_row_pieces_clear(hr2di_row_pieces *pieces, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, pieces->first);
  hr2di_alloc_free(alloc, pieces->mine);
  hr2di_alloc_free(alloc, pieces->rows);
  *pieces = (hr2di_row_pieces){0};
}
