/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "links/store.h"

#include <string.h>

#include "base/alloc.h"
#include "base/large-pages.h"

enum { SLOTS = 1024, MOST_ELEMENTS = HR2DI_CHUNK_BLOCKS * HR2DI_BLOCK_ELEMENTS };

/* The lists of elements of a chunk before it is known how much memory they need. */
typedef struct packer {
  uint32_t element[MOST_ELEMENTS];
  size_t elements, begin; /* all, and where the list of this block begins */
  unsigned char first[HR2DI_CHUNK_LINKS], second[HR2DI_CHUNK_LINKS];
  uint16_t slot[SLOTS]; /* by the last bits of an element: its place + 1, or that of another
                           one, and its own further on */
} packer;

/* The place of an element in the list of this block; HR2DI_BLOCK_ELEMENTS if there is none
   left. */
static inline size_t place_of(packer *p, uint32_t element) {
  const uint32_t *list = p->element + p->begin;
  size_t at = element % SLOTS;
  for (; p->slot[at]; at = (at + 1) % SLOTS)
    if (list[p->slot[at] - 1] == element) return p->slot[at] - 1u;
  const size_t place = p->elements - p->begin;
  if (place == HR2DI_BLOCK_ELEMENTS) return place;
  p->element[p->elements++] = element;
  p->slot[at] = (uint16_t)(place + 1);
  return place;
}

/* Whether the links [from, to) have few enough elements. */
static int pack_block(packer *p, const hr2d_link *link, size_t from, size_t to) {
  p->begin = p->elements;
  memset(p->slot, 0, sizeof p->slot);
  for (size_t k = from; k < to; k++) {
    const size_t i = place_of(p, link[k].pair.first), j = place_of(p, link[k].pair.second);
    if (i == HR2DI_BLOCK_ELEMENTS || j == HR2DI_BLOCK_ELEMENTS) return 0;
    p->first[k] = (unsigned char)i;
    p->second[k] = (unsigned char)j;
  }
  return 1;
}

/* A multiple of 8, so that areas of the next chunk are aligned. */
static size_t packed_bytes(size_t elements) {
  return sizeof(hr2di_packed) + (elements + elements % 2) * sizeof(uint32_t);
}

enum { PLAIN_BYTES = HR2DI_CHUNK_LINKS * sizeof(hr2d_link), MOST_SLAB = 16 };

/* The size of a new slab: for one chunk while there are few, then of large pages, about 3 %
   more than there is. */
static size_t slab_bytes(const hr2di_store *store, size_t bytes) {
  if (store->held < 2 * HR2DI_LARGE_PAGE) return bytes;
  const uint64_t pages = store->held / 32 / HR2DI_LARGE_PAGE;
  const size_t some = pages < 1 ? 1 : pages < MOST_SLAB ? (size_t)pages : MOST_SLAB;
  const size_t size = some * HR2DI_LARGE_PAGE;
  return store->max_slab && size > store->max_slab ? bytes : size;
}

/* Memory for a chunk, or NULL. */
static void *take(hr2di_store *store, const hr2d_allocator *alloc, size_t bytes) {
  if (bytes > store->size - store->used) {
    if (hr2di_alloc_reserve(alloc, &store->slab, &store->slab_capacity, store->slabs + 1,
                            sizeof *store->slab))
      return NULL;
    const size_t size = slab_bytes(store, bytes);
    void *slab = hr2di_alloc(alloc, size, 1);
    if (!slab) return NULL;
    store->slab[store->slabs++] = slab;
    store->size = size;
    store->used = 0;
    store->held += size;
  }
  void *taken = (char *)store->slab[store->slabs - 1] + store->used;
  store->used += bytes;
  return taken;
}

static hr2d_pair pair_at(const hr2di_packed *p, size_t k) {
  const uint32_t *element = p->element + p->begin[k / HR2DI_BLOCK_LINKS];
  return (hr2d_pair){element[p->first[k]], element[p->second[k]]};
}

static int is_next(hr2d_pair pair, hr2d_pair to, uint32_t first, uint32_t second) {
  return pair.first == to.first + first && pair.second == to.second + second;
}

/* Whether links from k on join i with j and j + 1, then i + 1 with both. */
static int is_square(const hr2di_packed *p, size_t k) {
  const hr2d_pair from = pair_at(p, k);
  return is_next(pair_at(p, k + 1), from, 0, 1) && is_next(pair_at(p, k + 2), from, 1, 0) &&
         is_next(pair_at(p, k + 3), from, 1, 1);
}

/* Whether couples that begin with these elements have none in common.  Those that are linked
   never have. */
static int are_apart(uint32_t a, uint32_t b) {
  return a - b + 1 > 2;
}

/* Whether squares from link k on join a couple with two others, then another with the same. */
static int is_large_square(const hr2di_packed *p, size_t k) {
  hr2d_pair from[4];
  for (size_t n = 0; n < 4; n++, k += HR2DI_SQUARE) {
    if (!hr2di_store_is_marked(p->square, k)) return 0;
    from[n] = pair_at(p, k);
  }
  return from[1].first == from[0].first && from[3].first == from[2].first &&
         from[2].second == from[0].second && from[3].second == from[1].second &&
         are_apart(from[0].first, from[3].first) && are_apart(from[0].second, from[3].second);
}

static void set_marks(const hr2di_packed *p, uint64_t *mark, size_t size,
                      int (*is_one)(const hr2di_packed *, size_t)) {
  memset(mark, 0, HR2DI_MARKS * sizeof *mark);
  for (size_t from = 0; from < HR2DI_CHUNK_LINKS; from += HR2DI_BLOCK_LINKS)
    for (size_t k = from; k + size <= from + HR2DI_BLOCK_LINKS;) {
      const int one = is_one(p, k);
      mark[k / 64] |= (uint64_t)one << k % 64;
      k += one ? size : 1;
    }
}

/* Marks squares, none of which goes on in the next block. */
static void mark_squares(hr2di_packed *p) {
  set_marks(p, p->square, HR2DI_SQUARE, is_square);
  set_marks(p, p->large, HR2DI_LARGE_SQUARE, is_large_square);
}

static void write_packed(const packer *p, const hr2d_link *link, hr2di_packed *data) {
  for (size_t k = 0; k < HR2DI_CHUNK_LINKS; k++) data->area[k] = link[k].exchange_area;
  memcpy(data->first, p->first, sizeof data->first);
  memcpy(data->second, p->second, sizeof data->second);
  memcpy(data->element, p->element, p->elements * sizeof *data->element);
}

/* Packs the open links, if they have few enough elements. */
static hr2d_status close_packed(hr2di_store *store, const hr2d_allocator *alloc) {
  packer p;
  uint32_t begin[HR2DI_CHUNK_BLOCKS];
  int packed = 1;
  p.elements = 0;
  for (size_t b = 0; b < HR2DI_CHUNK_BLOCKS && packed; b++) {
    packed = pack_block(&p, store->open, b * HR2DI_BLOCK_LINKS, (b + 1) * HR2DI_BLOCK_LINKS);
    begin[b] = (uint32_t)p.begin;
  }
  void *data = take(store, alloc, packed ? packed_bytes(p.elements) : (size_t)PLAIN_BYTES);
  if (!data) return HR2D_ENOMEM;
  if (packed) {
    write_packed(&p, store->open, data);
    memcpy(((hr2di_packed *)data)->begin, begin, sizeof begin);
    mark_squares(data);
  } else {
    memcpy(data, store->open, PLAIN_BYTES);
  }
  store->chunk[store->full++] = (hr2di_chunk){data, packed ? p.elements : 0};
  return HR2D_OK;
}

/* Makes the open links a chunk. */
static hr2d_status close_chunk(hr2di_store *store, const hr2d_allocator *alloc) {
  if (hr2di_alloc_reserve(alloc, &store->chunk, &store->capacity, store->full + 1,
                          sizeof *store->chunk))
    return HR2D_ENOMEM;
  if (store->packs) return close_packed(store, alloc);
  store->chunk[store->full++] = (hr2di_chunk){store->open, 0};
  store->open = NULL;
  return HR2D_OK;
}

hr2d_status hr2di_store_add(hr2di_store *store, const hr2d_allocator *alloc,
                            const hr2d_pair *pair, const double *area, size_t count) {
  while (count > 0) {
    if (!store->open)
      store->open =
          store->packs ? hr2di_alloc(alloc, 1, PLAIN_BYTES) : take(store, alloc, PLAIN_BYTES);
    if (!store->open) return HR2D_ENOMEM;
    const size_t at = (size_t)(store->count - (uint64_t)store->full * HR2DI_CHUNK_LINKS);
    const size_t room = HR2DI_CHUNK_LINKS - at, some = count < room ? count : room;
    for (size_t k = 0; k < some; k++) store->open[at + k] = (hr2d_link){pair[k], area[k]};
    if (some == room && close_chunk(store, alloc)) return HR2D_ENOMEM;
    store->count += some;
    pair += some;
    area += some;
    count -= some;
  }
  return HR2D_OK;
}

/* What hr2di_alloc_reserve() adds for one item more. */
static uint64_t list_growth(size_t used, size_t capacity, size_t size) {
  return used < capacity ? 0 : (capacity ? capacity : 8) * (uint64_t)size;
}

/* At most one chunk is closed, and one is opened. */
uint64_t hr2di_store_growth(const hr2di_store *store, size_t count) {
  uint64_t bytes = store->packs && !store->open ? PLAIN_BYTES : 0;
  bytes += list_growth(store->full, store->capacity, sizeof *store->chunk);
  const uint64_t at = store->count - (uint64_t)store->full * HR2DI_CHUNK_LINKS;
  const int takes = store->packs ? at + count >= HR2DI_CHUNK_LINKS
                                 : !store->open || at + count > HR2DI_CHUNK_LINKS;
  if (!takes || store->size - store->used >= PLAIN_BYTES) return bytes;
  return bytes + slab_bytes(store, PLAIN_BYTES) +
         list_growth(store->slabs, store->slab_capacity, sizeof *store->slab);
}

static void rename_links(hr2d_link *link, size_t count, const uint32_t *number) {
  for (size_t k = 0; k < count; k++)
    link[k].pair = (hr2d_pair){number[link[k].pair.first], number[link[k].pair.second]};
}

hr2d_status hr2di_store_rename(hr2di_store *store, const uint32_t *number, hr2di_watch *watch) {
  for (size_t k = 0; k < store->full; k++) {
    const hr2d_status status = hr2di_watch_work(watch, HR2DI_CHUNK_LINKS / 64);
    if (status) return status;
    const hr2di_chunk *chunk = &store->chunk[k];
    hr2di_packed *p = chunk->data;
    for (size_t m = 0; m < chunk->elements; m++) p->element[m] = number[p->element[m]];
    if (chunk->elements)
      mark_squares(p);
    else
      rename_links(chunk->data, HR2DI_CHUNK_LINKS, number);
  }
  if (store->open)
    rename_links(store->open,
                 (size_t)(store->count - (uint64_t)store->full * HR2DI_CHUNK_LINKS), number);
  return HR2D_OK;
}

void hr2di_store_clear(hr2di_store *store, const hr2d_allocator *alloc) {
  while (store->slabs > 0) hr2di_alloc_free(alloc, store->slab[--store->slabs]);
  hr2di_alloc_free(alloc, store->slab);
  hr2di_alloc_free(alloc, store->chunk);
  if (store->packs) hr2di_alloc_free(alloc, store->open);
  *store = (hr2di_store){0};
}

uint64_t hr2di_store_bytes(const hr2di_store *store) {
  return store->held + (store->packs && store->open ? PLAIN_BYTES : 0) +
         (uint64_t)store->capacity * sizeof *store->chunk +
         (uint64_t)store->slab_capacity * sizeof *store->slab;
}

const hr2d_link *hr2di_store_read(const hr2di_store *store, uint64_t first, size_t *count,
                                  hr2d_link *room) {
  const size_t k = (size_t)(first / HR2DI_CHUNK_LINKS), at = first % HR2DI_CHUNK_LINKS;
  const size_t rest = hr2di_store_chunk_size(store, k) - at;
  if (*count > rest) *count = rest;
  if (k == store->full) return store->open + at;
  const hr2di_chunk *chunk = &store->chunk[k];
  if (!chunk->elements) return (const hr2d_link *)chunk->data + at;
  if (*count > HR2DI_READ_LINKS) *count = HR2DI_READ_LINKS;
  for (size_t m = 0; m < *count; m++) room[m] = hr2di_store_link(store, first + m);
  return room;
}
