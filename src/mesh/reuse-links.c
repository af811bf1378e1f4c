/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a refinement decides about a pair depends on its elements alone, and on whether they
   have children.  So only pairs with an element that was divided, that is new, or that is above
   one of these are refined again.  Other links stay, and so do those that come out again as
   they were. */
#include "mesh/reuse-links.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/share.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

/* Links between two declarations of work. */
enum { BATCH = HR2DI_READ_LINKS };

typedef struct division {
  hr2d_linkset *links, *coarse;
  unsigned char
      *divided;    /* per element: it was divided, it is new, or it is above one that is */
  uint32_t *place; /* 1 + the number of a link of `links`, by the hash of its pair; 0: none */
  uint64_t mask;
  unsigned char *again; /* per link of `links`: it is one of `coarse` */
  hr2di_store kept;
  hr2di_watch watch;
  uint64_t limited, partial; /* of the links of `coarse` on divided elements */
} division;

static int changes(const division *d, hr2d_pair pair) {
  return d->divided[pair.first] || d->divided[pair.second];
}

/* No element is made by this refinement: all of its threads have the same numbers. */
static hr2d_status claim(void *ctx, const hr2d_batch *batch, unsigned char *claimed) {
  const division *d = ctx;
  for (size_t k = 0; k < batch->count; k++)
    claimed[k] = (unsigned char)changes(d, batch->pairs[k]);
  return HR2D_OK;
}

/* Sets which elements are divided; children have higher numbers than parents. */
static hr2d_status find_divided(division *d) {
  const hr2d_hierarchy *before = d->coarse->hierarchy, *h = d->links->hierarchy;
  for (size_t k = h->elements; k-- > 0;) {
    if (k % BATCH == 0 && hr2di_watch_work(&d->watch, BATCH / 32)) break;
    d->divided[k] |=
        k >= before->elements || (!before->element[k].child && h->element[k].child);
    if (d->divided[k]) d->divided[h->parent[k]] = 1;
  }
  return hr2di_watch_status(&d->watch);
}

/* Counts a link of a divided element.  Links of clear pairs have the exchange area of their
   elements, bit for bit. */
static hr2d_status count(division *d, const hr2d_link *link) {
  hr2d_linkset *coarse = d->coarse;
  const hr2d_element *element = coarse->hierarchy->element;
  const hr2d_element *i = &element[link->pair.first], *j = &element[link->pair.second];
  const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
  const double weight = hr2di_linkset_weight(coarse, link->pair);
  const unsigned char partial = hr2d_exchange_area(&s, &t) != link->exchange_area / weight;
  const hr2d_batch batch = {.struct_size = sizeof batch,
                            .hierarchy = coarse->hierarchy,
                            .elements = element,
                            .pairs = &link->pair,
                            .count = 1,
                            .unit = hr2d_scene_unit(coarse->hierarchy->scene),
                            .epsilon = coarse->epsilon,
                            .partial = partial ? &partial : NULL};
  double error = 0;
  const hr2d_status status = d->links->oracle.estimate(d->links->oracle_ctx, &batch, &error);
  d->partial += partial;
  d->limited += error > coarse->epsilon;
  return status;
}

/* Moves the blocks of links [from, from + count) behind those that are kept so far. */
static void move_blocks(division *d, uint64_t from, size_t count) {
  for (size_t g = 0; g < d->coarse->groups; g++) {
    hr2di_link_blocks *b = hr2di_linkset_blocks(d->coarse, g);
    if (b->links > 0) hr2di_link_blocks_move(b, d->kept.count, from, count);
  }
}

/* Keeps some links, one behind the other, from number `first` on. */
static hr2d_status keep(division *d, const hr2d_link *link, uint64_t first, size_t count) {
  hr2d_pair pair[BATCH];
  double area[BATCH];
  for (size_t k = 0; k < count; k++) {
    pair[k] = link[k].pair;
    area[k] = link[k].exchange_area;
  }
  move_blocks(d, first, count);
  return hr2di_store_add(&d->kept, &d->links->alloc, pair, area, count);
}

/* The finalizer of MurmurHash3. */
static uint64_t hash_of(hr2d_pair pair) {
  uint64_t x = (uint64_t)pair.first << 32 | pair.second;
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdU;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53U;
  return x ^ (x >> 33);
}

/* A table with open addressing; a slot is as near behind its hash as others leave room.  Of
   more links than its numbers can tell it has none. */
static hr2d_status make_table(division *d) {
  const hr2d_linkset *links = d->links;
  const uint64_t all = links->store.count, count = all < UINT32_MAX ? all : 0;
  uint64_t slots = 2;
  while (slots < 2 * count) slots *= 2;
  d->mask = slots - 1;
  d->place = hr2di_alloc_zero(&links->alloc, (size_t)slots, sizeof *d->place);
  d->again = hr2di_alloc_zero(&links->alloc, (size_t)all, 1);
  hr2d_status status = d->place && d->again ? HR2D_OK : HR2D_ENOMEM;
  for (uint64_t k = 0; k < count && !status; k++) {
    if (k % BATCH == 0) status = hr2di_watch_work(&d->watch, BATCH / 4);
    uint64_t slot = hash_of(hr2di_store_link(&links->store, k).pair) & d->mask;
    while (d->place[slot]) slot = (slot + 1) & d->mask;
    d->place[slot] = (uint32_t)k + 1;
  }
  return status;
}

/* Whether a link has come out again. */
static int is_again(division *d, hr2d_pair pair) {
  for (uint64_t slot = hash_of(pair) & d->mask; d->place[slot]; slot = (slot + 1) & d->mask) {
    const uint32_t k = d->place[slot] - 1;
    const hr2d_pair found = hr2di_store_link(&d->links->store, k).pair;
    if (found.first != pair.first || found.second != pair.second) continue;
    d->again[k] = 1;
    return 1;
  }
  return 0;
}

static hr2d_status sort_some(division *d, const hr2d_link *link, uint64_t first,
                             size_t number) {
  hr2d_status status = hr2di_watch_work(&d->watch, BATCH);
  unsigned char stays[BATCH];
  for (size_t k = 0; k < number && !status; k++) {
    const int changed = changes(d, link[k].pair);
    if (changed) status = count(d, &link[k]);
    stays[k] = !changed || is_again(d, link[k].pair);
  }
  for (size_t k = 0, last; k < number && !status; k = last) {
    for (last = k + 1; last < number && stays[last] == stays[k];) last++;
    if (stays[k]) status = keep(d, link + k, first + k, last - k);
  }
  return status;
}

static hr2d_status sort_links(division *d) {
  const hr2di_store *from = &d->coarse->store;
  hr2d_link room[HR2DI_READ_LINKS];
  hr2d_status status = HR2D_OK;
  for (uint64_t first = 0; first < from->count && !status;) {
    size_t count = BATCH;
    const hr2d_link *link = hr2di_store_read(from, first, &count, room);
    status = sort_some(d, link, first, count);
    first += count;
  }
  return status;
}

/* The blocks of the links that are kept become those of the new set. */
static void take_blocks(division *d) {
  for (size_t g = 0; g < d->coarse->groups; g++) {
    hr2di_link_blocks *b = hr2di_linkset_blocks(d->coarse, g),
                      *to = hr2di_linkset_blocks(d->links, g);
    if (b->links == 0) continue;
    *to = *b;
    to->links = d->kept.count;
    to->kernels = 0;
    *b = (hr2di_link_blocks){0};
  }
}

/* What is left of a budget; 1 if nothing is, as 0 means that there is none. */
static uint64_t left(uint64_t budget, uint64_t used) {
  return budget == 0 ? 0 : budget > used ? budget - used : 1;
}

/* The links that surely stay. */
static uint64_t count_others(const division *d) {
  const hr2di_store *from = &d->coarse->store;
  uint64_t others = 0;
  for (uint64_t k = 0; k < from->count; k++)
    others += !changes(d, hr2di_store_link(from, k).pair);
  return others;
}

static hr2d_status refine_divided(division *d, const hr2di_refine_how *how,
                                  const hr2d_refine_options *given) {
  const uint64_t others = count_others(d);
  hr2d_refine_options options = *given;
  options.claim = claim;
  options.claim_ctx = d;
  options.max_links = left(given->max_links, others);
  options.max_bytes = left(given->max_bytes, others * sizeof(hr2d_link));
  return hr2di_refine(d->links, how, &options);
}

/* Puts the links that are new behind those that stay. */
static hr2d_status add_new(division *d) {
  const hr2d_linkset *links = d->links;
  hr2d_status status = HR2D_OK;
  for (uint64_t k = 0; k < links->store.count && !status; k++) {
    if (k % BATCH == 0) status = hr2di_watch_work(&d->watch, BATCH / 16);
    const hr2d_link link = hr2di_store_link(&links->store, k);
    if (!d->again[k] && !status)
      status = hr2di_store_add(&d->kept, &links->alloc, &link.pair, &link.exchange_area, 1);
  }
  return status;
}

/* The links that all shares have, and the work of both refinements. */
static hr2d_status add_counts(const division *d, hr2d_share *share) {
  hr2d_refine_counts *counts = &d->links->counts;
  const hr2d_refine_counts *before = &d->coarse->counts;
  double own[] = {(double)d->kept.count, (double)d->limited, (double)d->partial};
  const hr2d_status status = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_SUM, own, 3);
  if (status) return status;
  counts->links = (uint64_t)own[0];
  counts->limited_links += before->limited_links - (uint64_t)own[1];
  counts->partial_links += before->partial_links - (uint64_t)own[2];
  counts->oracle_calls += before->oracle_calls;
  counts->facing_tests += before->facing_tests;
  counts->visibility_tests += before->visibility_tests;
  d->links->own_tests += d->coarse->own_tests;
  counts->exchange_areas += before->exchange_areas;
  counts->blocked_pairs += before->blocked_pairs;
  counts->dark_pairs = before->dark_pairs;
  return HR2D_OK;
}

static hr2d_status run(division *d, const hr2di_refine_how *how,
                       const hr2d_refine_options *options) {
  hr2d_status status = find_divided(d);
  if (!status) status = refine_divided(d, how, options);
  if (!status) status = make_table(d);
  if (status) return status;
  status = sort_links(d);
  take_blocks(d);
  return status ? status : add_new(d);
}

hr2d_status hr2di_reuse_links(hr2d_linkset *links, hr2d_linkset *coarse,
                              const hr2di_refine_how *how, const hr2d_refine_options *options) {
  const hr2d_scene *scene = coarse->hierarchy->scene;
  division d = {.links = links, .coarse = coarse};
  hr2di_scene_watch(scene, &d.watch, options->progress, options->progress_ctx, "refine");
  d.divided = hr2di_alloc_zero(&links->alloc, links->hierarchy->elements, 1);
  hr2d_status status = hr2di_share_agree(options->share, d.divided ? HR2D_OK : HR2D_ENOMEM);
  if (!status) status = run(&d, how, options);
  if (!status) status = add_counts(&d, options->share);
  hr2di_alloc_free(&links->alloc, d.divided);
  hr2di_alloc_free(&links->alloc, d.place);
  hr2di_alloc_free(&links->alloc, d.again);
  if (status) {
    hr2di_store_clear(&d.kept, &links->alloc);
    return status;
  }
  hr2di_store_clear(&links->store, &links->alloc);
  links->store = d.kept;
  return HR2D_OK;
}
