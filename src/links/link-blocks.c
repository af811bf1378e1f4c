/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each block has a place of its own in memory, so the result does not depend on threads. */
#include "links/link-blocks.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/team.h"
#include "blocks/block.h"
#include "blocks/gas-cells.h"
#include "links/linkset-impl.h"
#include "scene/scene-impl.h"

enum { CHUNK = 16 /* the links of a task */ };

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

/* G V is not negative, so that |C_lm| ≤ φ_l(1) φ_m(1) C_00.  A block beyond that comes from
   elements that the rules cannot tell apart in doubles, as a distance of 1e-17 of a length: it
   keeps the exchange area of the link alone; through gas that of the block, unless this is no
   number at all. */
static void check_bound(const hr2di_basis *basis, double area, int has_gas, double *block) {
  const size_t order = basis->order;
  double end[HR2D_MAX_ORDER];
  int holds = isfinite(block[0]);
  hr2di_basis_at(basis, 1, end);
  for (size_t l = 0; l < order; l++)
    for (size_t m = 0; m < order; m++)
      holds &= fabs(block[l * order + m]) <= 1.5 * block[0] * end[l] * end[m];
  if (holds) return;
  if (!has_gas || !(block[0] >= 0 && block[0] <= area)) block[0] = area;
  for (size_t k = 1; k < order * order; k++) block[k] = 0;
}

/* Floats are parts of C_00; the weight of a pair is a factor of its exchange area. */
static void put_floats(float *to, const double *from, size_t count, double area) {
  for (size_t k = 0; k < count; k++) to[k] = area > 0 ? (float)(from[k] / area) : 0;
}

static void put_doubles(double *to, const double *from, size_t count, double weight) {
  for (size_t k = 0; k < count; k++) to[k] = from[k] * weight;
}

/* Puts some numbers to place `at`, and returns the place behind them. */
static size_t put(void *to, size_t at, const double *from, size_t count, double unit,
                  int single) {
  if (single)
    put_floats((float *)to + at, from, count, unit);
  else
    put_doubles((double *)to + at, from, count, unit);
  return at + count;
}

/* The bytes of both parts of a block. */
static size_t leading_bytes(const hr2di_link_blocks *b) {
  return b->lead * b->lead * hr2di_number_size(b->single);
}
static size_t rest_bytes(const hr2di_link_blocks *b) {
  return b->order * b->order * hr2di_number_size(b->single) - leading_bytes(b);
}

static size_t count_lost(size_t gases, size_t order) {
  return 2 * order + (gases ? hr2di_gas_cells_shares(gases, order) : 0);
}

/* The gases of a scene with borders, else 0. */
static size_t gases_of(const hr2d_scene *scene) {
  return hr2di_scene_regions(scene) ? scene->gases.count : 0;
}

size_t hr2di_link_blocks_lost(const hr2di_link_blocks *b) {
  return count_lost(b->gases, b->lost_order);
}

size_t hr2di_link_blocks_gas_bytes(const hr2d_scene *scene, size_t order) {
  if (!hr2di_scene_has_gas(scene)) return 0;
  return count_lost(gases_of(scene), order) * sizeof(double);
}

static size_t lost_bytes(const hr2di_link_blocks *b) {
  return b->has_gas ? hr2di_link_blocks_lost(b) * sizeof *b->lost : 0;
}

/* Writes block k to its two parts. */
static void part_block(const double *block, double weight, hr2di_link_blocks *b, uint64_t k) {
  void *value = (char *)b->value + k * leading_bytes(b);
  void *rest = b->rest ? (char *)b->rest + k * rest_bytes(b) : NULL;
  const double unit = b->single ? block[0] : weight;
  size_t leading = 0, others = 0;
  for (size_t l = 0; l < b->order; l++) {
    const double *row = block + l * b->order;
    const size_t head = l < b->lead ? b->lead : 0;
    leading = put(value, leading, row, head, unit, b->single);
    if (head < b->order)
      others = put(rest, others, row + head, b->order - head, unit, b->single);
  }
  if (b->single) *(float *)value = 1;
}

/* The same of what gas takes: coefficients are those of light that is not negative. */
static void check_lost(const hr2di_basis *basis, double area, double *lost) {
  double end[HR2D_MAX_ORDER];
  int holds = 1;
  hr2di_basis_at(basis, 1, end);
  if (!(lost[0] >= 0 && lost[0] <= 2 * area)) lost[0] = 0;
  for (size_t l = 1; l < basis->order; l++) holds &= fabs(lost[l]) <= 1.5 * lost[0] * end[l];
  for (size_t l = 1; l < basis->order && !holds; l++) lost[l] = 0;
}

static void put_lost(hr2di_integrator *work, double area, double weight, double *lost) {
  for (size_t side = 0; side < 2; side++) {
    check_lost(&work->basis, area, work->lost[side]);
    put_doubles(lost + side * work->order, work->lost[side], work->order, weight);
  }
  if (work->cells)
    put_doubles(lost + 2 * work->order, work->cells->share,
                hr2di_gas_cells_shares(work->cells->gases, work->order), weight);
}

static hr2d_status make_one(const maker *m, hr2di_integrator *work, uint64_t k) {
  const hr2d_link *link = hr2di_store_at(&m->links->store, k);
  double block[HR2D_MAX_ORDER * HR2D_MAX_ORDER];
  int distant;
  const double weight = hr2di_linkset_weight(m->links, link->pair);
  const double area = link->exchange_area / weight;
  const hr2d_status status = hr2di_block(work, link->pair, area, block, &distant);
  if (status) return status;
  const int has_gas = work->has_gas;
  if (is_tiny(m->links->hierarchy, link->pair) && !has_gas) block[0] = area;
  check_bound(&work->basis, area, has_gas, block);
  part_block(block, weight, m->blocks, k);
  m->blocks->distant[k] = (unsigned char)distant;
  if (has_gas)
    put_lost(work, area, weight, m->blocks->lost + k * hr2di_link_blocks_lost(m->blocks));
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

static void describe(void *of, hr2d_progress *report) {
  const maker *m = of;
  const double part =
      (double)atomic_load(&m->done) / (double)(m->links->store.count - m->known);
  report->fraction = part < 1 ? part : 1;
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
  const size_t threads = hr2di_team_threads(asked),
               max = (size_t)(1 + links / HR2DI_CHOICE_TEAM_LINKS);
  return threads < max ? threads : max;
}

/* Makes the blocks behind the `known` ones. */
static hr2d_status run(hr2d_linkset *links, hr2di_link_blocks *made, uint64_t known,
                       const hr2di_blocks_wanted *wanted, hr2di_watch *watch) {
  const hr2d_allocator *alloc = &links->alloc;
  maker m = {.links = links,
             .blocks = made,
             .known = known,
             .threads = count_threads(wanted->threads, links->store.count - known),
             .watch = watch};
  m.worker = hr2di_alloc_zero(alloc, m.threads, sizeof *m.worker);
  if (!m.worker) return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  size_t started = 0;
  while (started < m.threads && !status) {
    worker *w = &m.worker[started];
    hr2di_watch_follow(&w->own, watch);
    status = hr2di_integrator_init(&w->work, links->hierarchy, alloc, made->order,
                                   wanted->beam_cache, started == 0 ? watch : &w->own);
    if (made->single) w->work.digits = HR2DI_SINGLE_DIGITS;
    if (!status && made->order > links->hierarchy->order)
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

uint64_t hr2di_link_blocks_bytes(const hr2di_link_blocks *b) {
  return b->links * (leading_bytes(b) + rest_bytes(b) + lost_bytes(b) + sizeof *b->distant);
}

/* Gives an array room for so many links; on failure it stays as it is. */
static int resize_one(void **array, uint64_t links, size_t size, const hr2d_allocator *alloc) {
  void *resized = NULL;
  if (links <= SIZE_MAX / size)
    resized = hr2di_alloc_resize(alloc, *array, (size_t)links, size);
  if (resized) *array = resized;
  return resized != NULL;
}

static hr2d_status resize(hr2di_link_blocks *b, uint64_t links, const hr2d_allocator *alloc) {
  const size_t rest = rest_bytes(b);
  const size_t lost = lost_bytes(b);
  void *distant = b->distant, *absorbed = b->lost;
  b->links = links;
  int has_room = resize_one(&b->value, links, leading_bytes(b), alloc);
  if (has_room && rest > 0) has_room = resize_one(&b->rest, links, rest, alloc);
  if (has_room) has_room = resize_one(&distant, links, sizeof *b->distant, alloc);
  if (has_room && lost > 0) has_room = resize_one(&absorbed, links, lost, alloc);
  b->distant = distant;
  b->lost = absorbed;
  return has_room ? HR2D_OK : HR2D_ENOMEM;
}

/* Blocks of a set have the order of its hierarchy as their leading part.  At order 1 exchange
   areas are enough. */
static size_t lead_of(const hr2d_linkset *links, size_t order) {
  const size_t own = links->hierarchy->order;
  return own > 1 && own < order ? own : order;
}

/* Whether what there is of blocks can be gone on with.  All of a block serves with any leading
   part. */
static int are_alike(const hr2d_linkset *links, const hr2di_blocks_wanted *wanted) {
  const hr2di_link_blocks *b = &links->blocks;
  const size_t order = wanted->order, lead = lead_of(links, order);
  return b->order == order && b->single == wanted->single && (b->lead == lead || lead == order);
}

int hr2di_link_blocks_made(const hr2d_linkset *links, const hr2di_blocks_wanted *wanted) {
  return are_alike(links, wanted) && links->blocks.links == links->store.count;
}

hr2d_status hr2di_link_blocks_init(hr2d_linkset *links, const hr2di_blocks_wanted *wanted,
                                   hr2di_watch *watch) {
  const uint64_t count = links->store.count;
  hr2di_link_blocks *known = &links->blocks;
  if (!are_alike(links, wanted) || known->links >= count)
    hr2di_link_blocks_clear(known, &links->alloc);
  hr2di_link_blocks made = *known;
  if (made.links == 0) made.lead = lead_of(links, wanted->order);
  made.order = wanted->order;
  if (made.links == 0) made.lost_order = wanted->order;
  made.has_gas = hr2di_scene_has_gas(links->hierarchy->scene);
  made.gases = gases_of(links->hierarchy->scene);
  made.single = wanted->single;
  made.kernels = 0;
  *known = (hr2di_link_blocks){0};
  if (count == 0) return HR2D_OK;
  const uint64_t first = made.links;
  hr2d_status status = resize(&made, count, &links->alloc);
  if (!status) status = run(links, &made, first, wanted, watch);
  if (status)
    hr2di_link_blocks_clear(&made, &links->alloc);
  else
    links->blocks = made;
  return status;
}

static void move(void *array, size_t size, uint64_t to, uint64_t from, size_t count) {
  memmove((char *)array + to * size, (char *)array + from * size, count * size);
}

void hr2di_link_blocks_move(hr2di_link_blocks *b, uint64_t to, uint64_t from, size_t count) {
  if (from == to) return;
  move(b->value, leading_bytes(b), to, from, count);
  if (b->rest) move(b->rest, rest_bytes(b), to, from, count);
  if (b->lost) move(b->lost, lost_bytes(b), to, from, count);
  move(b->distant, sizeof *b->distant, to, from, count);
}

void hr2di_link_blocks_trim(hr2di_link_blocks *b, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, b->rest);
  b->rest = NULL;
  b->order = b->lead;
}

void hr2di_link_blocks_clear(hr2di_link_blocks *blocks, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, blocks->value);
  hr2di_alloc_free(alloc, blocks->rest);
  hr2di_alloc_free(alloc, blocks->distant);
  hr2di_alloc_free(alloc, blocks->lost);
  *blocks = (hr2di_link_blocks){0};
}
