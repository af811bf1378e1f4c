/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The store of links: what was added, in its order, in 16 bytes each, or in about 11 if asked.

   Links are kept in chunks of four blocks.  Neighbours in the store share their elements, so
   that a block has few: a packed one lists them once, and a link has two places in this list, a
   byte each, beside its exchange area.  It saves a third of the memory, and takes more time to
   store.  A chunk of a block with more than 256 elements, or that is not full, keeps links as
   they are.

   Nearly all links are four in a square: they join two elements, which are neighbours, with two
   others.  Squares are mostly four in a large one, which joins two such couples with two
   others. A packed chunk marks where they begin, as gathers keep sums of couples in registers.
 */
#ifndef HR2D_SRC_LINKS_STORE_H
#define HR2D_SRC_LINKS_STORE_H

#include <hr2d/linkset.h>
#include <hr2d/memory.h>

#include "base/watch.h"

enum {
  HR2DI_CHUNK_LINKS = 4096,
  HR2DI_BLOCK_LINKS = 1024,
  HR2DI_CHUNK_BLOCKS = HR2DI_CHUNK_LINKS / HR2DI_BLOCK_LINKS,
  HR2DI_BLOCK_ELEMENTS = 256, /* of a packed block, at most */
  HR2DI_SQUARE = 4,
  HR2DI_LARGE_SQUARE = 16,
  HR2DI_MARKS = HR2DI_CHUNK_LINKS / 64
};

typedef struct hr2di_packed {
  double area[HR2DI_CHUNK_LINKS];
  unsigned char first[HR2DI_CHUNK_LINKS],
      second[HR2DI_CHUNK_LINKS];                    /* in the list of a block */
  uint64_t square[HR2DI_MARKS], large[HR2DI_MARKS]; /* bit k: one begins at link k */
  uint32_t begin[HR2DI_CHUNK_BLOCKS];               /* of the lists, in `element` */
  uint32_t element[];
} hr2di_packed;

typedef struct hr2di_chunk {
  void *data;      /* an hr2di_packed, or an array of links */
  size_t elements; /* in the lists of all blocks; 0 of an array */
} hr2di_chunk;

/* Exchange areas are in units of the scene here, not in scene lengths. */
typedef struct hr2di_store {
  hr2di_chunk *chunk; /* the full ones */
  size_t full, capacity;
  hr2d_link *open; /* the links behind them, or NULL */
  uint64_t count;
  int packs;   /* full chunks are packed; set before links are added */
  void **slab; /* where data of chunks are, one behind the other */
  size_t slabs, slab_capacity;
  size_t size, used; /* bytes of the last slab */
  uint64_t held;     /* bytes of all */
  uint64_t max_slab; /* bytes of a new slab, if not for one chunk; 0: as it is best */
} hr2di_store;

/* Adds links.  Returns HR2D_OK, or HR2D_ENOMEM when only some of them are added. */
hr2d_status hr2di_store_add(hr2di_store *store, const hr2d_allocator *alloc,
                            const hr2d_pair *pair, const double *area, size_t count);

/* The bytes that hr2di_store_add() may allocate for up to HR2DI_CHUNK_LINKS links. */
uint64_t hr2di_store_growth(const hr2di_store *store, size_t count);

/* Gives the elements of all links other numbers.  HR2D_OK, or the status of the watch with some
   of them renamed. */
hr2d_status hr2di_store_rename(hr2di_store *store, const uint32_t *number, hr2di_watch *watch);

void hr2di_store_clear(hr2di_store *store, const hr2d_allocator *alloc);

uint64_t hr2di_store_bytes(const hr2di_store *store);

/* Returns links from number `first` on: up to *count, which becomes their number, at least 1.
   They may be in `room`, which is for HR2DI_READ_LINKS. */
enum { HR2DI_READ_LINKS = 256 };
const hr2d_link *hr2di_store_read(const hr2di_store *store, uint64_t first, size_t *count,
                                  hr2d_link *room);

static inline int hr2di_store_is_marked(const uint64_t *mark, size_t k) {
  return (int)(mark[k / 64] >> k % 64 & 1);
}

/* The number of chunks, of which the last may not be full. */
static inline size_t hr2di_store_chunks(const hr2di_store *store) {
  return store->full + (store->count > (uint64_t)store->full * HR2DI_CHUNK_LINKS);
}

/* The number of links in chunk k. */
static inline size_t hr2di_store_chunk_size(const hr2di_store *store, size_t k) {
  const uint64_t rest = store->count - (uint64_t)k * HR2DI_CHUNK_LINKS;
  return rest < HR2DI_CHUNK_LINKS ? (size_t)rest : HR2DI_CHUNK_LINKS;
}

/* Whether the data of a chunk are an hr2di_packed. */
static inline int hr2di_store_is_packed(const hr2di_store *store, size_t chunk) {
  return chunk < store->full && store->chunk[chunk].elements > 0;
}

static inline hr2d_link hr2di_store_link(const hr2di_store *store, uint64_t index) {
  const size_t k = (size_t)(index / HR2DI_CHUNK_LINKS), at = index % HR2DI_CHUNK_LINKS;
  if (k == store->full) return store->open[at];
  const hr2di_chunk *chunk = &store->chunk[k];
  if (!chunk->elements) return ((const hr2d_link *)chunk->data)[at];
  const hr2di_packed *p = chunk->data;
  const uint32_t *element = p->element + p->begin[at / HR2DI_BLOCK_LINKS];
  return (hr2d_link){{element[p->first[at]], element[p->second[at]]}, p->area[at]};
}

/* The address of a copy of a link, valid to the end of the block. */
#define hr2di_store_at(store, index) ((const hr2d_link[1]){hr2di_store_link((store), (index))})

#endif
