/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The links and elements of one thread, made by several.

   A row is a patch with all later ones.  The projector finishes a row before it begins the next
   one, so that rows depend on each other in the numbers of elements alone.  Each worker has a
   copy of the hierarchy as it was before the first row.  It refines a row on it, keeps the
   links and which elements were halved, in their order, and removes the new elements.  The
   calling thread then takes the rows in their order: it halves the elements that no row before
   has halved, and gives the links to the sink with the numbers that elements have now.  So
   order and numbers are those of one thread, for any number of threads.

   Rows are worked on in bands, so that links wait for their turn in little memory, which all
   bands share. */
#include "refine/rows.h"

#include "base/alloc.h"
#include "base/team.h"
#include "geometry/exchange-area.h"
#include "refine/rounds.h"
#include "refine/worker.h"
#include "scene/scene-impl.h"

enum { BAND = 128, FEW_PATCHES = 8 };

/* What a row led to, in the numbers of the worker's copy. */
typedef struct row {
  hr2d_pair *pair;
  double *area;
  size_t links, pair_capacity, area_capacity;
  uint32_t *parent; /* of each pair of new elements; then their left child in the hierarchy */
  size_t halvings, parent_capacity;
} row;

typedef struct rows {
  hr2di_projector *p;
  hr2di_worker *worker;
  size_t workers;
  row row[BAND];
  size_t first;    /* the patch of row[0] */
  size_t elements; /* of the hierarchy before the first row */
  unsigned levels;
  atomic_ullong links_found, rows_done;
} rows;

size_t hr2di_rows_threads(const hr2di_projector *p) {
  if (p->options.max_bytes || p->hierarchy->scene->patches < FEW_PATCHES) return 1;
  return hr2di_worker_count(p->links, p->options.threads);
}

/* Keeps links in the row under way. */
static hr2d_status keep(void *ctx, const hr2d_pair *pairs, const double *area, size_t count) {
  hr2di_worker *w = ctx;
  hr2di_projector *p = w->projector;
  row *r = w->task;
  const size_t needed = r->links + count;
  hr2d_status status = hr2di_projector_work(p, area ? 1 : count);
  if (!status && (hr2di_alloc_reserve(&p->links->alloc, &r->pair, &r->pair_capacity, needed,
                                      sizeof *r->pair) ||
                  hr2di_alloc_reserve(&p->links->alloc, &r->area, &r->area_capacity, needed,
                                      sizeof *r->area)))
    status = HR2D_ENOMEM;
  if (status) return hr2di_projector_fail(p, status, " for links");
  for (size_t k = 0; k < count; k++) r->pair[r->links + k] = pairs[k];
  for (size_t k = 0; k < count && area; k++) r->area[r->links + k] = area[k];
  if (!area) {
    p->counts.exchange_areas += count;
    hr2di_exchange_areas(p->hierarchy->element, pairs, count, r->area + r->links);
    hr2di_projector_weigh(p, pairs, count, r->area + r->links);
  }
  r->links = needed;
  return HR2D_OK;
}

/* Keeps which elements the row has halved, and removes them from the copy. */
static hr2d_status keep_halvings(const rows *all, hr2di_worker *w) {
  hr2d_hierarchy *h = w->clone;
  row *r = w->task;
  r->halvings = (h->elements - all->elements) / 2;
  if (hr2di_alloc_reserve(&h->alloc, &r->parent, &r->parent_capacity, r->halvings,
                          sizeof *r->parent))
    return hr2di_projector_fail(w->projector, HR2D_ENOMEM, " for elements");
  for (size_t k = 0; k < r->halvings; k++) r->parent[k] = h->parent[all->elements + 2 * k];
  hr2di_hierarchy_forget(h, all->elements, all->levels);
  return HR2D_OK;
}

static void do_row(void *ctx, size_t number, size_t task) {
  rows *all = ctx;
  hr2di_worker *w = &all->worker[number];
  hr2di_projector *p = w->projector;
  row *r = &all->row[task];
  if (w->status) return;
  w->task = r;
  r->links = r->halvings = 0;
  w->status = hr2di_projector_fail(p, hr2di_watch_status(p->watch), "");
  if (!w->status) w->status = hr2di_projector_row(p, all->first + task);
  if (!w->status) w->status = hr2di_rounds_run(p, SIZE_MAX);
  if (!w->status) w->status = keep_halvings(all, w);
  atomic_fetch_add(&all->links_found, r->links);
  atomic_fetch_add(&all->rows_done, 1);
  if (w->status) hr2di_watch_stop(all->p->watch, HR2D_STOPPED);
}

static void describe(void *of, hr2d_progress *report) {
  const rows *all = of;
  report->elements = all->p->hierarchy->elements;
  report->links = atomic_load(&all->links_found);
  const size_t wanted = all->p->options.row_to - all->p->options.row_from;
  report->fraction = wanted > 0 ? (double)atomic_load(&all->rows_done) / (double)wanted : 1;
}

/* The number in the hierarchy of an element of the copy. */
static inline uint32_t number_of(const rows *all, const row *r, uint32_t element) {
  if (element < all->elements) return element;
  const size_t past = element - all->elements;
  return r->parent[past / 2] + (uint32_t)(past % 2);
}

/* Halves what the row has halved and no row before. */
static hr2d_status take_halvings(rows *all, row *r) {
  hr2d_status status = hr2di_projector_work(all->p, 1 + r->halvings / 16);
  if (status) return hr2di_projector_fail(all->p, status, "");
  for (size_t k = 0; k < r->halvings; k++) {
    const uint32_t parent = number_of(all, r, r->parent[k]);
    if (!all->p->hierarchy->element[parent].child)
      status = hr2di_projector_halve(all->p, parent);
    if (status) return status;
    r->parent[k] = all->p->hierarchy->element[parent].child;
  }
  return HR2D_OK;
}

static hr2d_status take_links(rows *all, row *r) {
  hr2di_projector *p = all->p;
  hr2d_status status = HR2D_OK;
  for (size_t from = 0; from < r->links && !status; from += HR2DI_CANDIDATES) {
    const size_t rest = r->links - from;
    const size_t some = rest < HR2DI_CANDIDATES ? rest : HR2DI_CANDIDATES;
    status = hr2di_projector_fail(p, hr2di_projector_work(p, some / 16), "");
    for (size_t k = from; k < from + some && r->halvings > 0; k++)
      r->pair[k] = (hr2d_pair){number_of(all, r, r->pair[k].first),
                               number_of(all, r, r->pair[k].second)};
    if (!status) status = hr2di_projector_count_links(p, some);
    if (!status) status = p->sink(p->sink_ctx, r->pair + from, r->area + from, some);
  }
  return status;
}

static hr2d_status do_band(rows *all, size_t count) {
  hr2di_projector *p = all->p;
  hr2di_team_run(all->workers, count, do_row, all, p->watch);
  hr2d_status status = hr2di_worker_status(all->worker, all->workers, p->links);
  for (size_t k = 0; k < count && !status; k++) {
    status = take_halvings(all, &all->row[k]);
    if (!status) status = take_links(all, &all->row[k]);
  }
  return status;
}

static hr2d_status hire(rows *all, size_t k) {
  hr2di_worker *w = &all->worker[k];
  const hr2di_projector *p = all->p;
  if (hr2di_worker_hire(w, k, p->links, p->hierarchy, &p->how, &p->options, p->watch,
                        "refinement"))
    return w->status;
  w->projector->sink = keep;
  w->projector->sink_ctx = w;
  return HR2D_OK;
}

static void clear(rows *all) {
  const hr2d_allocator *alloc = &all->p->links->alloc;
  for (size_t k = 0; k < BAND; k++) {
    hr2di_alloc_free(alloc, all->row[k].pair);
    hr2di_alloc_free(alloc, all->row[k].area);
    hr2di_alloc_free(alloc, all->row[k].parent);
  }
  hr2di_worker_destroy(all->worker, all->workers, alloc);
  hr2di_alloc_free(alloc, all);
}

static hr2d_status project(rows *all) {
  const size_t last = all->p->options.row_to;
  for (size_t k = 0; k < all->workers; k++)
    if (hire(all, k)) return hr2di_worker_status(all->worker, all->workers, all->p->links);
  hr2d_status status = HR2D_OK;
  for (; all->first < last && !status; all->first += BAND)
    status = do_band(all, last - all->first < BAND ? last - all->first : BAND);
  for (size_t k = 0; k < all->workers; k++) {
    const hr2di_worker *w = &all->worker[k];
    hr2di_worker_add_counts(w, &all->p->counts);
    all->p->other_tests += w->projector->part.others;
    hr2di_projector_add_rows(w->projector, all->p->rows);
  }
  all->p->roots_done = all->p->roots; /* to be told at the end */
  return status;
}

hr2d_status hr2di_rows_project(hr2di_projector *p) {
  const hr2d_allocator *alloc = &p->links->alloc;
  const size_t workers = hr2di_rows_threads(p);
  rows *all = hr2di_alloc_zero(alloc, 1, sizeof *all);
  hr2di_worker *w = hr2di_alloc_zero(alloc, workers, sizeof *w);
  if (!all || !w) {
    hr2di_alloc_free(alloc, all);
    hr2di_alloc_free(alloc, w);
    return hr2di_message_fail(&p->links->message, HR2D_ENOMEM,
                              "out of memory for the refinement");
  }
  all->p = p;
  all->worker = w;
  all->workers = workers;
  all->first = p->options.row_from;
  all->elements = p->hierarchy->elements;
  all->levels = p->hierarchy->levels;
  hr2di_watch_describe(p->watch, describe, all);
  const hr2d_status status = project(all);
  hr2di_watch_describe(p->watch, hr2di_rounds_describe, p);
  clear(all);
  return status;
}
