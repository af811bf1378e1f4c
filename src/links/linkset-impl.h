/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The store of links, and the link set around it. */
#ifndef HR2D_SRC_LINKS_LINKSET_IMPL_H
#define HR2D_SRC_LINKS_LINKSET_IMPL_H

#include <hr2d/linkset.h>

#include "base/message.h"
#include "clusters/root-pairs.h"
#include "links/link-blocks.h"

/* Links are kept in chunks, so that a growing store never copies them. */
enum { HR2DI_CHUNK_LINKS = 4096 };

/* Exchange areas are in units of the scene here, not in scene lengths. */
typedef struct hr2di_store {
  hr2d_link **chunk;
  size_t chunks, capacity;
  uint64_t count;
} hr2di_store;

struct hr2d_linkset {
  hr2d_allocator alloc;
  hr2d_hierarchy *hierarchy;
  hr2d_oracle oracle;
  void *oracle_ctx;
  hr2d_policy policy;
  void *policy_ctx;
  hr2di_message message;
  hr2di_store store;
  hr2di_link_blocks blocks; /* of links that were solved at an order above 1 */
  hr2di_roots roots;        /* where a refinement begins; empty: at all pairs of patches */
  int directed;
  int solving;    /* a solve is under way, and may make blocks */
  double epsilon; /* of the last refinement; infinite before */
  hr2d_refine_counts counts;
};

/* Adds links.  Returns HR2D_OK, or HR2D_ENOMEM when only some of them are added. */
hr2d_status hr2di_store_add(hr2di_store *store, const hr2d_allocator *alloc,
                            const hr2d_pair *pair, const double *area, size_t count);

void hr2di_store_clear(hr2di_store *store, const hr2d_allocator *alloc);

uint64_t hr2di_store_bytes(const hr2di_store *store);

static inline const hr2d_link *hr2di_store_at(const hr2di_store *store, uint64_t index) {
  return &store->chunk[index / HR2DI_CHUNK_LINKS][index % HR2DI_CHUNK_LINKS];
}

/* The number of links in chunk k. */
static inline size_t hr2di_store_chunk_size(const hr2di_store *store, size_t k) {
  const uint64_t rest = store->count - (uint64_t)k * HR2DI_CHUNK_LINKS;
  return rest < HR2DI_CHUNK_LINKS ? (size_t)rest : HR2DI_CHUNK_LINKS;
}

#endif
