/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Long patches have long rows: their rows are cut into slots by the other patches before
   anything is counted.  Then slots are counted, each by some share.  The row with most work
   comes first, to the share that has least of what the row has; the share takes slots until it
   has its part, so that few shares look round from the same patch.  A slot that still has more
   than a 16th of the links that a share should have is cut into pieces. */
#include "mesh/row-partition.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/share.h"
#include "base/sort.h"
#include "refine/refine-how.h"

/* Slots and pieces are no larger than this part of what a share should have. */
#define PART (1. / 16)

/* No share should have more than so many times the mean; see deal(). */
#define EVEN 1.1
#define MORE 1.05
enum { ATTEMPTS = 60 };

/* Links and visibility tests: numbers, or parts of all that there are. */
typedef struct work {
  double links, tests;
} work;

typedef struct weighed {
  double size;
  size_t row;
} weighed;

/* The longest first; of equal ones the first. */
static int by_size(const void *left, const void *right) {
  const weighed *l = left, *r = right;
  if (l->size != r->size) return l->size > r->size ? -1 : 1;
  return (l->row > r->row) - (l->row < r->row);
}

typedef struct dealer {
  const hr2d_share *share;
  const hr2d_linkset *links;
  const hr2d_allocator *alloc;
  hr2di_row_pieces *pieces;
  hr2di_beam_cache *beam_cache;
  size_t rows, slots;
  work *work; /* per slot */
  work all;
  work *load;   /* per share, parts of all */
  unsigned now; /* the share that takes the row under way */
  hr2di_watch *watch;
} dealer;

/* The pairs of patches in a row. */
static double pairs_of(const dealer *d, size_t row) {
  const hr2di_roots *known = &d->links->roots;
  return known->row ? (double)(known->row[row + 1] - known->row[row])
                    : (double)(d->links->hierarchy->scene->patches - row - 1);
}

/* Cuts the rows of patches that have a large part of all lengths. */
static hr2d_status cut_rows(dealer *d) {
  const hr2d_element *element = d->links->hierarchy->element;
  uint32_t *slot = hr2di_alloc(d->alloc, d->rows + 1, sizeof *slot);
  double all = 0;
  d->pieces->slot = slot;
  if (!slot) return HR2D_ENOMEM;
  slot[0] = 0;
  for (size_t k = 0; k < d->rows; k++) all += element[k].length;
  for (size_t k = 0; k < d->rows; k++) {
    const double wanted = ceil(element[k].length * d->share->count / (PART * all));
    const double count = fmin(wanted, pairs_of(d, k));
    slot[k + 1] = slot[k] + (count > 1 ? (uint32_t)count + 1 : 1);
  }
  d->slots = slot[d->rows];
  return HR2D_OK;
}

/* Who counts: rows as without a target, and slots of cut rows one after the other. */
static hr2d_status share_count(dealer *d) {
  hr2di_row_pieces *p = d->pieces;
  p->own = hr2di_alloc_zero(d->alloc, d->slots, 1);
  p->rows = hr2di_alloc_zero(d->alloc, d->rows, 1);
  if (!p->own || !p->rows) return HR2D_ENOMEM;
  for (size_t k = 0; k < d->rows; k++) {
    const int whole = hr2di_row_slots(p, k) == 1;
    for (uint32_t s = p->slot[k]; s < p->slot[k + 1]; s++) {
      p->own[s] = (unsigned char)(whole ? hr2di_share_has_row(d->share, k, d->rows)
                                        : s % d->share->count == d->share->number);
      p->rows[k] |= p->own[s];
    }
  }
  return HR2D_OK;
}

/* Counts what this share has to count. */
static hr2d_status count_own(dealer *d, hr2d_linkset *links,
                             const hr2d_refine_options *options) {
  hr2d_refine_counts counts;
  hr2d_row_counts *slot = hr2di_alloc_zero(d->alloc, d->slots, sizeof *slot);
  hr2d_refine_options counting = *options;
  if (!slot) return HR2D_ENOMEM;
  counting.row_counts = slot;
  counting.rows = d->pieces->rows;
  const hr2di_refine_how how = {.pieces = d->pieces, .beam_cache = d->beam_cache};
  const hr2d_status status = hr2di_refine_count(links, &how, &counting, &counts);
  for (size_t k = 0; k < d->slots && !status; k++)
    d->work[k] = (work){(double)slot[k].links, (double)slot[k].visibility_tests};
  hr2di_alloc_free(d->alloc, slot);
  return status;
}

static void add(work *to, work more) {
  to->links += more.links;
  to->tests += more.tests;
}

static work part_of(const dealer *d, work w) {
  return (work){d->all.links > 0 ? w.links / d->all.links : 0,
                d->all.tests > 0 ? w.tests / d->all.tests : 0};
}

static double size_of(work w) {
  return fmax(w.links, w.tests);
}

static double size_with(work load, work more) {
  add(&load, more);
  return size_of(load);
}

/* Cuts slots that have too many links. */
static hr2d_status cut_slots(dealer *d) {
  hr2di_row_pieces *p = d->pieces;
  const double max = fmax(1, PART * d->all.links / d->share->count);
  p->first = hr2di_alloc(d->alloc, d->slots + 1, sizeof *p->first);
  if (!p->first) return HR2D_ENOMEM;
  p->first[0] = 0;
  for (size_t k = 0; k < d->slots; k++)
    p->first[k + 1] = p->first[k] + (uint32_t)fmax(1, ceil(d->work[k].links / max));
  p->mine = hr2di_alloc_zero(d->alloc, p->first[d->slots], 1);
  return p->mine ? HR2D_OK : HR2D_ENOMEM;
}

static unsigned min_loaded(const dealer *d, work more) {
  unsigned min = 0;
  for (unsigned s = 1; s < d->share->count; s++)
    if (size_with(d->load[s], more) < size_with(d->load[min], more)) min = s;
  return min;
}

/* The links of piece k of a slot. */
static double links_of(double links, uint32_t pieces, uint32_t k) {
  return pieces == 1 ? links : floor((links - k - 1) / pieces) + 1;
}

/* Deals out a slot.  What all with a piece of it do, or with a slot of its row, counts for
   each; `tracing` is that for the row. */
static void deal_slot(dealer *d, size_t row, size_t slot, work tracing) {
  hr2di_row_pieces *p = d->pieces;
  const uint32_t count = hr2di_slot_pieces(p, slot);
  const work all = d->work[slot];
  for (uint32_t k = 0, new_to = 1; k < count; k++) {
    work more = {links_of(all.links, count, k), new_to ? all.tests : 0};
    more = part_of(d, more);
    if (d->now == d->share->count || size_with(d->load[d->now], more) > 1. / d->share->count) {
      more = part_of(d, (work){links_of(all.links, count, k), all.tests + tracing.tests});
      d->now = min_loaded(d, more);
    }
    add(&d->load[d->now], more);
    new_to = 0;
    if (d->now != d->share->number) continue;
    p->mine[p->first[slot] + k] = p->own[slot] = p->rows[row] = 1;
  }
}

/* Starts from nothing. */
static void take_back(dealer *d) {
  const hr2di_row_pieces *p = d->pieces;
  memset(p->own, 0, d->slots);
  memset(p->mine, 0, p->first[d->slots]);
  memset(p->rows, 0, d->rows);
  memset(d->load, 0, d->share->count * sizeof *d->load);
}

static void deal_row(dealer *d, size_t row) {
  const hr2di_row_pieces *p = d->pieces;
  const uint32_t slots = hr2di_row_slots(p, row);
  const work tracing = slots > 1 ? d->work[hr2di_row_trace_slot(p, row)] : (work){0, 0};
  d->now = d->share->count;
  for (uint32_t k = 0; k < slots; k++) deal_slot(d, row, p->slot[row] + k, tracing);
}

/* Rows between two declarations of work. */
enum { BATCH = 64 };

static hr2d_status deal_rows(dealer *d, const weighed *order) {
  const uint64_t units = BATCH * (1 + d->share->count / 8);
  take_back(d);
  for (size_t k = 0; k < d->rows; k++) {
    if (k % BATCH == 0 && hr2di_watch_work(d->watch, units)) break;
    deal_row(d, order[k].row);
  }
  return hr2di_watch_status(d->watch);
}

static int is_even(const dealer *d) {
  for (unsigned s = 0; s < d->share->count; s++)
    if (size_of(d->load[s]) > EVEN / d->share->count) return 0;
  return 1;
}

static hr2d_status sort_rows(const dealer *d, weighed *order) {
  for (size_t k = 0; k < d->rows; k++) {
    work w = {0, 0};
    for (uint32_t s = d->pieces->slot[k]; s < d->pieces->slot[k + 1]; s++) add(&w, d->work[s]);
    order[k] = (weighed){size_of(part_of(d, w)), k};
  }
  return hr2di_sort(order, d->rows, sizeof *order, by_size, d->watch);
}

/* Tests that several shares make alike are more than there are: so tests count less and less,
   until all shares have as much as the others. */
static hr2d_status deal(dealer *d) {
  weighed *order = hr2di_alloc(d->alloc, d->rows, sizeof *order);
  d->load = hr2di_alloc_zero(d->alloc, d->share->count, sizeof *d->load);
  hr2d_status status = order && d->load ? cut_slots(d) : HR2D_ENOMEM;
  if (!status) status = sort_rows(d, order);
  if (!status) status = deal_rows(d, order);
  for (int k = 0; k < ATTEMPTS && !status && !is_even(d); k++) {
    d->all.tests *= MORE;
    status = deal_rows(d, order);
  }
  hr2di_alloc_free(d->alloc, order);
  hr2di_alloc_free(d->alloc, d->load);
  return status;
}

hr2d_status hr2di_row_partition(hr2di_row_pieces *pieces, hr2d_linkset *links,
                                hr2di_beam_cache *beam_cache,
                                const hr2d_refine_options *options) {
  hr2di_watch watch;
  dealer d = {.share = options->share,
              .links = links,
              .alloc = &links->alloc,
              .pieces = pieces,
              .beam_cache = beam_cache,
              .rows = hr2di_scene_cell(links->hierarchy->scene),
              .watch = &watch};
  hr2di_scene_watch(links->hierarchy->scene, &watch, options->progress, options->progress_ctx,
                    "refine");
  hr2d_status status = cut_rows(&d);
  if (!status) status = share_count(&d);
  if (!status) d.work = hr2di_alloc_zero(d.alloc, d.slots, sizeof *d.work);
  if (!status && !d.work) status = HR2D_ENOMEM;
  if (!status) status = count_own(&d, links, options);
  status = hr2di_share_combine(options->share, status, HR2D_COMBINE_SUM,
                               d.work ? &d.work->links : NULL, 2 * d.slots);
  for (size_t k = 0; k < d.slots && !status; k++) add(&d.all, d.work[k]);
  if (!status) status = deal(&d);
  hr2di_alloc_free(d.alloc, d.work);
  return status;
}

hr2d_status hr2di_row_pieces_copy(hr2di_row_pieces *to, const hr2di_row_pieces *from,
                                  size_t rows, const hr2d_allocator *alloc) {
  const size_t slots = from->slot[rows], pieces = from->first[slots];
  to->slot = hr2di_alloc(alloc, rows + 1, sizeof *to->slot);
  to->first = hr2di_alloc(alloc, slots + 1, sizeof *to->first);
  to->own = hr2di_alloc(alloc, slots, 1);
  to->mine = hr2di_alloc(alloc, pieces, 1);
  to->rows = hr2di_alloc(alloc, rows, 1);
  if (!to->slot || !to->first || !to->own || !to->mine || !to->rows) return HR2D_ENOMEM;
  memcpy(to->slot, from->slot, (rows + 1) * sizeof *to->slot);
  memcpy(to->first, from->first, (slots + 1) * sizeof *to->first);
  memcpy(to->own, from->own, slots);
  memcpy(to->mine, from->mine, pieces);
  memcpy(to->rows, from->rows, rows);
  return HR2D_OK;
}

void hr2di_row_pieces_clear(hr2di_row_pieces *pieces, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, pieces->slot);
  hr2di_alloc_free(alloc, pieces->first);
  hr2di_alloc_free(alloc, pieces->own);
  hr2di_alloc_free(alloc, pieces->mine);
  hr2di_alloc_free(alloc, pieces->rows);
  *pieces = (hr2di_row_pieces){0};
}
