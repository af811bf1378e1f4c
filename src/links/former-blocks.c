/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A table with open addressing; a slot is as near behind its hash as others leave room. */
#include "links/former-blocks.h"

#include "base/alloc.h"
#include "links/linkset-impl.h"

/* Links between two declarations of work. */
enum { SOME = 1024 };

/* The finalizer of MurmurHash3. */
static uint64_t hash_of(hr2d_pair pair) {
  uint64_t x = (uint64_t)pair.first << 32 | pair.second;
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdU;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53U;
  return x ^ (x >> 33);
}

hr2d_status hr2di_former_blocks_init(hr2di_former_blocks *f, const hr2d_linkset *links,
                                     size_t order, const hr2d_allocator *alloc,
                                     hr2di_watch *watch) {
  *f = (hr2di_former_blocks){0};
  if (!links || links->blocks.order != order || links->blocks.links != links->store.count ||
      links->store.count == 0 || links->store.count >= UINT32_MAX / 2)
    return HR2D_OK;
  const uint64_t count = links->store.count;
  uint64_t slots = 2;
  while (slots < 2 * count) slots *= 2;
  f->mask = slots - 1;
  f->place = hr2di_alloc_zero(alloc, (size_t)slots, sizeof *f->place);
  if (!f->place) return HR2D_ENOMEM;
  f->links = links;
  hr2d_status status = HR2D_OK;
  for (uint64_t k = 0; k < count && !status; k++) {
    if (k % SOME == 0) status = hr2di_watch_work(watch, SOME / 4);
    uint64_t slot = hash_of(hr2di_store_at(&links->store, k)->pair) & f->mask;
    while (f->place[slot]) slot = (slot + 1) & f->mask;
    f->place[slot] = (uint32_t)k + 1;
  }
  return status;
}

void hr2di_former_blocks_clear(hr2di_former_blocks *f, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, f->place);
  *f = (hr2di_former_blocks){0};
}

const double *hr2di_former_block(const hr2di_former_blocks *f, hr2d_pair pair,
                                 unsigned char *distant) {
  if (!f->links) return NULL;
  for (uint64_t slot = hash_of(pair) & f->mask; f->place[slot]; slot = (slot + 1) & f->mask) {
    const uint32_t k = f->place[slot] - 1;
    const hr2d_pair found = hr2di_store_at(&f->links->store, k)->pair;
    if (found.first != pair.first || found.second != pair.second) continue;
    *distant = f->links->blocks.distant[k];
    return f->links->blocks.value + k * f->links->blocks.order * f->links->blocks.order;
  }
  return NULL;
}
