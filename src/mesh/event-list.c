/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which of some that are alike is kept depends on the order in which they come: so a list of
   several shares is filled in the order of one process. */
#include "mesh/event-list.h"

#include "base/alloc.h"
#include "base/share.h"
#include "base/sort.h"

/* Events so near to one another or to an end, as fractions of the patch, are one. */
#define ALIKE 1e-12

static int by_place(const void *left, const void *right) {
  const hr2di_event_candidate *l = left, *r = right;
  if (l->event.patch != r->event.patch) return l->event.patch < r->event.patch ? -1 : 1;
  if (l->event.at != r->event.at) return l->event.at < r->event.at ? -1 : 1;
  if (l->event.generation != r->event.generation)
    return l->event.generation < r->event.generation ? -1 : 1;
  return (l->via > r->via) - (l->via < r->via);
}

hr2d_status hr2di_event_list_settle(hr2di_event_list *l) {
  size_t kept = 0;
  hr2d_status status = hr2di_sort(l->found, l->count, sizeof *l->found, by_place, l->watch);
  if (!status) status = hr2di_watch_work(l->watch, l->count / 16);
  if (status) return status;
  for (size_t k = 0; k < l->count; k++) {
    const hr2di_event_candidate c = l->found[k];
    hr2di_event_candidate *last = kept > 0 ? &l->found[kept - 1] : NULL;
    if (!last || last->event.patch != c.event.patch || c.event.at - last->event.at >= ALIKE)
      l->found[kept++] = c;
    else if (c.event.generation < last->event.generation ||
             (c.event.generation == last->event.generation &&
              c.event.spread > last->event.spread))
      *last = c;
  }
  l->count = kept;
  return kept > l->max ? HR2D_EMAX_ELEMENTS : HR2D_OK;
}

hr2d_status hr2di_event_list_add(hr2di_event_list *l, const hr2di_event_candidate *c) {
  if (!(c->event.at >= ALIKE && 1 - c->event.at >= ALIKE)) return HR2D_OK;
  /* Half of them are more than there may be: some must be alike. */
  if (l->count / 2 > l->max) {
    if (l->in_part) return HR2D_EMAX_ELEMENTS;
    const hr2d_status status = hr2di_event_list_settle(l);
    if (status) return status;
  }
  if (hr2di_alloc_reserve(&l->alloc, &l->found, &l->capacity, l->count + 1, sizeof *l->found))
    return HR2D_ENOMEM;
  l->found[l->count++] = *c;
  return HR2D_OK;
}

enum { WIDTH = 10 };

static void write(const hr2di_event_candidate *c, double *record) {
  const hr2di_event e = c->event;
  const double value[WIDTH] = {e.patch,  e.at,     e.generation, e.origin, e.origin_at,
                               e.past.x, e.past.y, e.spread,     c->via,   e.passed};
  for (int k = 0; k < WIDTH; k++) record[k] = value[k];
}

static hr2di_event_candidate read(const double *record) {
  return (hr2di_event_candidate){{.patch = (uint32_t)record[0],
                                  .at = record[1],
                                  .generation = (unsigned)record[2],
                                  .origin = (uint32_t)record[3],
                                  .origin_at = record[4],
                                  .past = {record[5], record[6]},
                                  .passed = (int)record[9],
                                  .spread = record[7]},
                                 (uint32_t)record[8]};
}

static hr2d_status read_all(hr2di_event_list *l, const double *record, size_t count) {
  hr2d_status status = hr2di_watch_work(l->watch, count / 16);
  for (size_t k = 0; k < count && !status; k++) {
    const hr2di_event_candidate c = read(record + k * WIDTH);
    status = hr2di_event_list_add(l, &c);
  }
  return status;
}

hr2d_status hr2di_event_list_collect(hr2di_event_list *l, hr2d_share *share, hr2d_status status,
                                     size_t from, int *again) {
  double many = status == HR2D_EMAX_ELEMENTS;
  size_t count = l->count - from;
  l->count = from;
  l->in_part = 0;
  status = hr2di_share_combine(share, many > 0 ? HR2D_OK : status, HR2D_COMBINE_MOST, &many, 1);
  *again = many > 0 && !status;
  if (status || *again) return status;
  double *record = hr2di_alloc(&l->alloc, count, WIDTH * sizeof *record);
  for (size_t k = 0; k < count && record; k++) write(&l->found[from + k], record + k * WIDTH);
  status = record ? hr2di_watch_work(l->watch, count / 16) : HR2D_ENOMEM;
  status = hr2di_share_collect(share, status, &l->alloc, &record, &count, WIDTH);
  if (!status) status = read_all(l, record, count);
  hr2di_alloc_free(&l->alloc, record);
  return status;
}
