/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The blocks of all links of a set, for elements of an order above 1.

   A solve at the order of the hierarchy takes the leading part of each block many times, and
   the account of its error takes all of it a few times: the two parts are in arrays of their
   own. */
#ifndef HR2D_SRC_LINKS_LINK_BLOCKS_H
#define HR2D_SRC_LINKS_LINK_BLOCKS_H

#include <hr2d/linkset.h>
#include <hr2d/refine.h>

#include "base/watch.h"
#include "links/block-numbers.h"
#include "visibility/beam-cache.h"

typedef struct hr2di_link_blocks {
  size_t order;
  size_t lead;    /* so many coefficients are in the leading part; `order` if that is all */
  uint64_t links; /* so many links, the first ones, have blocks */
  int single;     /* numbers are floats, see block-numbers.h */
  void *value;    /* links × lead × lead numbers */
  void *rest; /* links × (order² − lead²) numbers, row by row what `value` lacks of a block */
  unsigned char *distant; /* per link: integrated by one rule, as accurate as the order needs */
  int has_gas;
  size_t lost_order; /* of these: */
  size_t gases;      /* with borders between them, else 0 */
  double *lost; /* with gas, per link 2 × lost_order numbers, hr2di_integrator::lost, and behind
                   them what each gas takes, hr2di_gas_cells::share; else NULL */
  uint64_t kernels; /* evaluations of G it took */
} hr2di_link_blocks;

/* The numbers of `lost` per link. */
size_t hr2di_link_blocks_lost(const hr2di_link_blocks *b);

/* The bytes of what gas takes, per link of a scene. */
size_t hr2di_link_blocks_gas_bytes(const hr2d_scene *scene, size_t order);

/* The bytes of all blocks. */
uint64_t hr2di_link_blocks_bytes(const hr2di_link_blocks *b);

/* The two parts of block k. */
static inline hr2di_stored_block hr2di_link_blocks_at(const hr2di_link_blocks *b, uint64_t k) {
  const hr2di_stored_block first = {b->value, b->rest, b->order, b->lead, b->single};
  return hr2di_block_behind(&first, k);
}

/* Moves the blocks of links [from, from + count) to those from `to` on. */
void hr2di_link_blocks_move(hr2di_link_blocks *b, uint64_t to, uint64_t from, size_t count);

/* The blocks that are wanted. */
typedef struct hr2di_blocks_wanted {
  size_t order;                 /* above that of the hierarchy: for an account of errors, too */
  int single;                   /* numbers are floats */
  hr2di_beam_cache *beam_cache; /* keeps what patches see; NULL: nothing is kept */
  unsigned threads;             /* as in options; no bit depends on their number */
} hr2di_blocks_wanted;

/* Whether all links of a set have such blocks. */
int hr2di_link_blocks_made(const hr2d_linkset *links, const hr2di_blocks_wanted *wanted);

/* Makes such blocks for all links of a set that have none.  The order of the hierarchy is their
   leading part.  Returns HR2D_OK, HR2D_ENOMEM, or the status of the watch.  On failure the set
   has no blocks. */
hr2d_status hr2di_link_blocks_init(hr2d_linkset *links, const hr2di_blocks_wanted *wanted,
                                   hr2di_watch *watch);

/* Keeps the leading part of all blocks alone. */
void hr2di_link_blocks_trim(hr2di_link_blocks *blocks, const hr2d_allocator *alloc);

void hr2di_link_blocks_clear(hr2di_link_blocks *blocks, const hr2d_allocator *alloc);

#endif
