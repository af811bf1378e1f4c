/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/leading-blocks.h"

#include <string.h>

#include "base/alloc.h"
#include "base/team.h"

/* Blocks of a task. */
enum { TASK = 1024 };

typedef struct copy {
  char *to;
  const char *from;
  size_t number;
  uint64_t count;
  size_t all, order;
  hr2di_watch *watch; /* of the calling thread */
} copy;

static void copy_some(void *ctx, size_t worker, size_t task) {
  const copy *c = ctx;
  const size_t order = c->order, row = order * c->number;
  const uint64_t first = (uint64_t)task * TASK;
  const uint64_t last = c->count - first > TASK ? first + TASK : c->count;
  if (worker == 0 && hr2di_watch_work(c->watch, TASK / 4 + TASK * order * order / 32)) return;
  for (size_t k = (size_t)first; k < last; k++)
    for (size_t l = 0; l < order; l++)
      memcpy(c->to + (k * order + l) * row, c->from + (k * c->all + l) * c->all * c->number,
             row);
}

hr2d_status hr2di_leading_blocks(void **to, const void *from, size_t number, uint64_t count,
                                 size_t all, size_t order, const hr2d_allocator *alloc,
                                 unsigned threads, hr2di_watch *watch) {
  const size_t row = order * number;
  *to = count > SIZE_MAX / order / row ? NULL : hr2di_alloc(alloc, (size_t)count, order * row);
  if (!*to) return HR2D_ENOMEM;
  copy c = {*to, from, number, count, all, order, watch};
  hr2di_team_run(hr2di_team_threads(threads), (size_t)((count + TASK - 1) / TASK), copy_some,
                 &c, watch);
  return hr2di_watch_status(watch);
}
