/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each block has a place of its own in memory, so the result does not depend on threads. */
#include "links/link-blocks.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/team.h"
#include "blocks/block.h"
#include "links/linkset-impl.h"
#include "scene/scene-impl.h"

/* The links of a task; and those that are worth another thread. */
enum { CHUNK = 16, WORTH = 256 };

/* The work space of a thread. */
typedef struct worker {
  hr2di_integrator work;
  hr2di_watch own; /* but the calling thread has another */
  hr2d_status status;
} worker;

typedef struct maker {
  const hr2d_linkset *links;
  hr2di_link_blocks *blocks;
  uint64_t known; /* blocks, of the first links */
  worker *worker;
  size_t threads;
  hr2di_watch *watch; /* of the calling thread */
  atomic_ullong done; /* links */
  atomic_int failed;
} maker;

/* The account of the error takes all of a block and the solve a part: both would be off by what
   the rule of distant pairs is, and nothing would show it.  With so many points more than the
   order that is 3.3^−2MORE of the error of the order. */
enum { MORE = 8 };

/* In terms of the scene.  Products of vectors along shorter elements underflow in blocks, and
   not in exchange areas of links. */
#define TINY 0x1p-400

static int is_tiny(const hr2d_hierarchy *h, hr2d_pair pair) {
  return h->element[pair.first].length < TINY || h->element[pair.second].length < TINY;
}

/* G V is not negative, so that |C_lm| ≤ √((2l+1)(2m+1)) C_00.  A block beyond that comes from
   elements that the rules cannot tell apart in doubles, as a distance of 1e-17 of a length: it
   keeps the exchange area of the link alone. */
static void check_bound(double area, double *block, size_t order) {
  int holds = isfinite(block[0]);
  for (size_t l = 0; l < order; l++)
    for (size_t m = 0; m < order; m++) {
      const double most = 1.5 * block[0] * sqrt((double)((2 * l + 1) * (2 * m + 1)));
      holds &= fabs(block[l * order + m]) <= most;
    }
  if (holds) return;
  block[0] = area;
  for (size_t k = 1; k < order * order; k++) block[k] = 0;
}

/* The weight of a pair is a factor of its exchange area. */
static void round_block(const double *block, size_t square, float *to) {
  to[0] = 1;
  for (size_t n = 1; n < square; n++) to[n] = block[0] > 0 ? (float)(block[n] / block[0]) : 0;
}

static hr2d_status make_one(const maker *m, hr2di_integrator *work, uint64_t k) {
  const hr2d_link *link = hr2di_store_at(&m->links->store, k);
  const size_t order = m->blocks->order, square = order * order;
  const int single = m->blocks->single;
  double room[HR2D_MAX_ORDER * HR2D_MAX_ORDER];
  double *block = single ? room : hr2di_link_blocks_at(m->blocks, k);
  int distant;
  const double weight = hr2di_linkset_weight(m->links, link->pair);
  const double area = link->exchange_area / weight;
  const hr2d_status status = hr2di_block(work, link->pair, area, block, &distant);
  if (status) return status;
  if (is_tiny(m->links->hierarchy, link->pair)) block[0] = area;
  check_bound(area, block, order);
  if (single)
    round_block(block, square, hr2di_link_blocks_at(m->blocks, k));
  else
    for (size_t n = 0; n < square && weight != 1; n++) block[n] *= weight;
  m->blocks->distant[k] = (unsigned char)distant;
  return HR2D_OK;
}

static hr2d_status make_some(const maker *m, hr2di_integrator *work, uint64_t from,
                             uint64_t to) {
  hr2d_status status = HR2D_OK;
  for (uint64_t k = from; k < to && !status; k++) status = make_one(m, work, k);
  return status;
}

static void make_chunk(void *ctx, size_t number, size_t chunk) {
  maker *m = ctx;
  worker *w = &m->worker[number];
  const uint64_t count = m->links->store.count;
  const uint64_t first = m->known + (uint64_t)chunk * CHUNK;
  if (atomic_load(&m->failed)) return;
  w->status = make_some(m, &w->work, first, first + CHUNK < count ? first + CHUNK : count);
  atomic_fetch_add(&m->done, CHUNK);
  if (w->status) atomic_store(&m->failed, 1);
}

static void describe(void *of, hr2d_progress *told) {
  const maker *m = of;
  const double part =
      (double)atomic_load(&m->done) / (double)(m->links->store.count - m->known);
  told->fraction = part < 1 ? part : 1;
}

static hr2d_status make_all(maker *m) {
  const uint64_t chunks = (m->links->store.count - m->known + CHUNK - 1) / CHUNK;
  hr2d_status status = HR2D_OK;
  hr2di_watch_phase(m->watch, "coefficients");
  hr2di_watch_describe(m->watch, describe, m);
  hr2di_team_run(m->threads, (size_t)chunks, make_chunk, m, m->watch);
  for (size_t k = 0; k < m->threads && !status; k++) status = m->worker[k].status;
  if (!status) status = hr2di_watch_ask(m->watch);
  hr2di_watch_describe(m->watch, NULL, NULL);
  return status;
}

/* Few links get few threads: their blocks are made before another thread wakes up. */
static size_t count_threads(unsigned asked, uint64_t links) {
  const size_t threads = hr2di_team_threads(asked), max = (size_t)(1 + links / WORTH);
  return threads < max ? threads : max;
}

/* Makes the blocks behind the `known` ones. */
static hr2d_status run(hr2d_linkset *links, hr2di_link_blocks *made, uint64_t known,
                       unsigned threads, hr2di_watch *watch) {
  const hr2d_allocator *alloc = &links->alloc;
  maker m = {.links = links,
             .blocks = made,
             .known = known,
             .threads = count_threads(threads, links->store.count - known),
             .watch = watch};
  m.worker = hr2di_alloc_zero(alloc, m.threads, sizeof *m.worker);
  if (!m.worker) return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  size_t started = 0;
  while (started < m.threads && !status) {
    worker *w = &m.worker[started];
    hr2di_watch_follow(&w->own, watch);
    status = hr2di_integrator_init(&w->work, links->hierarchy, alloc, made->order,
                                   started == 0 ? watch : &w->own);
    if (!status && made->order == links->block_order)
      status = hr2di_integrator_points(&w->work, made->order + MORE, 1);
    started++;
  }
  if (!status) status = make_all(&m);
  while (started > 0) {
    made->kernels += m.worker[--started].work.kernels;
    hr2di_integrator_clear(&m.worker[started].work);
  }
  hr2di_alloc_free(alloc, m.worker);
  return status;
}

/* Gives the arrays room for so many links. */
static hr2d_status resize(hr2di_link_blocks *b, uint64_t links, const hr2d_allocator *alloc) {
  const size_t size = hr2di_link_blocks_stride(b);
  if (links > SIZE_MAX / size) return HR2D_ENOMEM;
  void *value = hr2di_alloc_resize(alloc, b->value, (size_t)links, size);
  if (value) b->value = value;
  unsigned char *distant = hr2di_alloc_resize(alloc, b->distant, (size_t)links, 1);
  if (distant) b->distant = distant;
  b->links = links;
  return value && distant ? HR2D_OK : HR2D_ENOMEM;
}

/* Whether what there is of blocks can be gone on with. */
static int are_alike(const hr2d_linkset *links, size_t order) {
  return links->blocks.order == order && links->blocks.single == links->single;
}

int hr2di_link_blocks_made(const hr2d_linkset *links, size_t order) {
  return are_alike(links, order) && links->blocks.links == links->store.count;
}

hr2d_status hr2di_link_blocks_init(hr2d_linkset *links, size_t order, unsigned threads,
                                   hr2di_watch *watch) {
  const uint64_t count = links->store.count;
  hr2di_link_blocks *known = &links->blocks;
  if (!are_alike(links, order) || known->links >= count)
    hr2di_link_blocks_clear(known, &links->alloc);
  hr2di_link_blocks made = *known;
  made.order = order;
  made.single = links->single;
  made.kernels = 0;
  *known = (hr2di_link_blocks){0};
  if (count == 0) return HR2D_OK;
  const uint64_t first = made.links;
  hr2d_status status = resize(&made, count, &links->alloc);
  if (!status) status = run(links, &made, first, threads, watch);
  if (status)
    hr2di_link_blocks_clear(&made, &links->alloc);
  else
    links->blocks = made;
  return status;
}

hr2d_status hr2di_link_blocks_trim(hr2di_link_blocks *b, size_t order,
                                   const hr2d_allocator *alloc) {
  if (order >= b->order || b->links == 0) return HR2D_OK;
  const size_t number = hr2di_number_size(b->single), row = order * number;
  char *to = b->value;
  for (uint64_t k = 0; k < b->links; k++) {
    const char *from = hr2di_link_blocks_at(b, k);
    for (size_t l = 0; l < order; l++, to += row, from += b->order * number)
      memmove(to, from, row);
  }
  b->order = order;
  void *value =
      hr2di_alloc_resize(alloc, b->value, (size_t)b->links, hr2di_link_blocks_stride(b));
  if (!value) return HR2D_ENOMEM;
  b->value = value;
  return HR2D_OK;
}

void hr2di_link_blocks_clear(hr2di_link_blocks *blocks, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, blocks->value);
  hr2di_alloc_free(alloc, blocks->distant);
  *blocks = (hr2di_link_blocks){0};
}
