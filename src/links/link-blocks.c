/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each block has a place of its own in memory, so the result does not depend on threads. */
#include "links/link-blocks.h"

#include <float.h>
#include <math.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "base/alloc.h"
#include "blocks/block.h"
#include "links/linkset-impl.h"
#include "scene/scene-impl.h"

/* Blocks are made in rounds, and progress is reported between them. */
enum { CHUNK = 16, ROUND = 256 };

typedef struct maker {
  const hr2d_linkset *links;
  hr2di_link_blocks *blocks;
  hr2di_integrator *work; /* per thread */
  size_t threads;
} maker;

/* The relative error that rounded coordinates cause in the length of an element; a whole patch
   has its own coordinates. */
static double rounding_of(const hr2d_hierarchy *h, uint32_t element) {
  return element < h->scene->patches ? 0 : DBL_EPSILON / h->element[element].length;
}

/* The first coefficient of a block is the exchange area of its elements.  The link knows the
   area to all digits of their coordinates, whatever the rule of the block is worth.  The block
   of touching elements knows more digits, as it measures small elements as parts of their
   patches.  So it stands where both agree to the digits of the coordinates. */
static double first_coefficient(const hr2d_hierarchy *h, const hr2d_link *link, double block) {
  const double rounding =
      rounding_of(h, link->pair.first) + rounding_of(h, link->pair.second) + 4 * DBL_EPSILON;
  const double area = link->exchange_area;
  return fabs(block - area) > rounding * fmax(block, area) ? area : block;
}

static hr2d_status make_some(const maker *m, hr2di_integrator *work, uint64_t from,
                             uint64_t to) {
  const size_t square = m->blocks->order * m->blocks->order;
  for (uint64_t k = from; k < to; k++) {
    const hr2d_link *link = hr2di_store_at(&m->links->store, k);
    double *block = m->blocks->value + k * square;
    int distant;
    const hr2d_status status = hr2di_block(work, link->pair, block, &distant);
    if (status) return status;
    block[0] = first_coefficient(m->links->hierarchy, link, block[0]);
    m->blocks->distant[k] = (unsigned char)distant;
  }
  return HR2D_OK;
}

/* Chunk k of a round. */
static hr2d_status make_chunk(const maker *m, size_t worker, uint64_t from, uint64_t to,
                              long k) {
  const uint64_t first = from + (uint64_t)k * CHUNK;
  const uint64_t last = first + CHUNK < to ? first + CHUNK : to;
  return make_some(m, &m->work[worker], first, last);
}

/* One thread does not use OpenMP, whose runtime ends the program if it has no memory. */
static hr2d_status make_round(const maker *m, uint64_t from, uint64_t to) {
  const long chunks = (long)((to - from + CHUNK - 1) / CHUNK);
  hr2d_status worst = HR2D_OK;
#ifdef _OPENMP
  if (m->threads > 1) {
#pragma omp parallel for num_threads((int)m->threads) schedule(dynamic) reduction(max : worst)
    for (long k = 0; k < chunks; k++) {
      const hr2d_status status = make_chunk(m, (size_t)omp_get_thread_num(), from, to, k);
      if (status > worst) worst = status;
    }
    return worst;
  }
#endif
  for (long k = 0; k < chunks && !worst; k++) worst = make_chunk(m, 0, from, to, k);
  return worst;
}

static hr2d_status report(const hr2d_linkset *links, const hr2di_link_blocks_plan *plan,
                          uint64_t done) {
  if (!plan->progress) return HR2D_OK;
  const hr2d_progress progress = {.struct_size = sizeof progress,
                                  .phase = "coefficients",
                                  .elements = hr2d_hierarchy_count(links->hierarchy).elements,
                                  .links = links->store.count,
                                  .fraction = (double)done / (double)links->store.count};
  return plan->progress(plan->progress_ctx, &progress);
}

static hr2d_status make_all(const maker *m, const hr2di_link_blocks_plan *plan) {
  hr2d_status status = HR2D_OK;
  const uint64_t count = m->links->store.count;
  for (uint64_t from = 0; from < count && !status; from += ROUND) {
    const uint64_t to = from + ROUND < count ? from + ROUND : count;
    status = make_round(m, from, to);
    if (!status) status = report(m->links, plan, to);
  }
  return status;
}

/* Few links get few threads: their blocks are made before another thread wakes up. */
static size_t count_threads(unsigned asked, uint64_t links) {
#ifdef _OPENMP
  const size_t threads = asked ? asked : (size_t)omp_get_max_threads();
  const size_t max = (size_t)(1 + links / ROUND);
  return threads < max ? threads : max;
#else
  (void)asked;
  (void)links;
  return 1;
#endif
}

static hr2d_status run(hr2d_linkset *links, hr2di_link_blocks *made,
                       const hr2di_link_blocks_plan *plan) {
  const hr2d_allocator *alloc = &links->alloc;
  maker m = {.links = links,
             .blocks = made,
             .threads = count_threads(plan->threads, links->store.count)};
  m.work = hr2di_alloc_zero(alloc, m.threads, sizeof *m.work);
  if (!m.work) return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  size_t started = 0;
  while (started < m.threads && !status)
    status = hr2di_integrator_init(&m.work[started++], links->hierarchy, alloc, made->order);
  if (!status) status = make_all(&m, plan);
  while (started > 0) {
    made->kernels += m.work[--started].kernels;
    hr2di_integrator_clear(&m.work[started]);
  }
  hr2di_alloc_free(alloc, m.work);
  return status;
}

hr2d_status hr2di_link_blocks_init(hr2d_linkset *links, size_t order,
                                   const hr2di_link_blocks_plan *plan) {
  const uint64_t count = links->store.count;
  hr2di_link_blocks made = {.order = order, .links = count};
  hr2di_link_blocks_clear(&links->blocks, &links->alloc);
  if (count == 0) return HR2D_OK;
  if (count > SIZE_MAX / (order * order * sizeof *made.value)) return HR2D_ENOMEM;
  made.value = hr2di_alloc(&links->alloc, (size_t)count, order * order * sizeof *made.value);
  made.distant = hr2di_alloc(&links->alloc, (size_t)count, 1);
  hr2d_status status = made.value && made.distant ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = run(links, &made, plan);
  if (status)
    hr2di_link_blocks_clear(&made, &links->alloc);
  else
    links->blocks = made;
  return status;
}

void hr2di_link_blocks_clear(hr2di_link_blocks *blocks, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, blocks->value);
  hr2di_alloc_free(alloc, blocks->distant);
  *blocks = (hr2di_link_blocks){0};
}
