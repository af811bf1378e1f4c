/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Among thousands of patches a few leaves are divided, and a hundredth of the links change. */
#include "accuracy/divided-links.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

/* Links between two declarations of work. */
enum { SOME = HR2DI_READ_LINKS };

typedef struct division {
  hr2d_linkset *links, *coarse;
  unsigned char *divided; /* per patch */
  hr2di_store kept;
  hr2di_watch watch;
  uint64_t limited, partial; /* of the links of `coarse` that are not kept */
} division;

static int changes(const division *d, hr2d_pair pair) {
  const hr2d_element *element = d->coarse->hierarchy->element;
  return d->divided[element[pair.first].patch] || d->divided[element[pair.second].patch];
}

/* Refines pairs of patches alone of which one has been divided. */
static hr2d_status claim(void *ctx, const hr2d_batch *batch, unsigned char *claimed) {
  const division *d = ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_pair pair = batch->pairs[k];
    claimed[k] = d->divided[batch->elements[pair.first].patch] ||
                 d->divided[batch->elements[pair.second].patch];
  }
  return HR2D_OK;
}

/* Counts a link that is not kept.  Links of clear pairs have the exchange area of their
   elements, bit for bit. */
static hr2d_status leave(division *d, const hr2d_link *link) {
  hr2d_linkset *coarse = d->coarse;
  const hr2d_element *element = coarse->hierarchy->element;
  const hr2d_element *i = &element[link->pair.first], *j = &element[link->pair.second];
  const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
  const unsigned char partial = hr2d_exchange_area(&s, &t) != link->exchange_area;
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
  hr2di_link_blocks *b = &d->coarse->blocks;
  const size_t square = b->order * b->order;
  const uint64_t to = d->kept.count;
  if (b->links == 0 || from == to) return;
  memmove(b->value + to * square, b->value + from * square, count * square * sizeof *b->value);
  memmove(b->distant + to, b->distant + from, count);
}

/* Keeps some links, one behind the other, from number `first` on. */
static hr2d_status keep(division *d, const hr2d_link *link, uint64_t first, size_t count) {
  hr2d_pair pair[SOME];
  double area[SOME];
  for (size_t k = 0; k < count; k++) {
    pair[k] = link[k].pair;
    area[k] = link[k].exchange_area;
  }
  move_blocks(d, first, count);
  return hr2di_store_add(&d->kept, &d->links->alloc, pair, area, count);
}

static hr2d_status sort_some(division *d, const hr2d_link *link, uint64_t first, size_t count) {
  hr2d_status status = hr2di_watch_work(&d->watch, SOME / 8);
  for (size_t k = 0, last; k < count && !status; k = last) {
    const int changed = changes(d, link[k].pair);
    for (last = k + 1; last < count && changes(d, link[last].pair) == changed;) last++;
    if (!changed) status = keep(d, link + k, first + k, last - k);
    for (size_t m = k; m < last && changed && !status; m++) status = leave(d, &link[m]);
  }
  return status;
}

static hr2d_status sort_links(division *d) {
  const hr2di_store *from = &d->coarse->store;
  hr2d_link room[HR2DI_READ_LINKS];
  hr2d_status status = HR2D_OK;
  for (uint64_t first = 0; first < from->count && !status;) {
    size_t count = SOME;
    const hr2d_link *link = hr2di_store_read(from, first, &count, room);
    status = sort_some(d, link, first, count);
    first += count;
  }
  return status;
}

/* The blocks of the links that are kept become those of the new set. */
static void take_blocks(division *d) {
  hr2di_link_blocks *b = &d->coarse->blocks;
  if (b->links == 0) return;
  d->links->blocks = *b;
  d->links->blocks.links = d->kept.count;
  d->links->blocks.kernels = 0;
  *b = (hr2di_link_blocks){0};
}

/* What is left of a budget; 1 if nothing is, as 0 means that there is none. */
static uint64_t left(uint64_t budget, uint64_t used) {
  return budget == 0 ? 0 : budget > used ? budget - used : 1;
}

/* Refines the other pairs, and puts their links behind those that are kept. */
static hr2d_status refine_others(division *d, const hr2d_refine_options *given) {
  hr2d_linkset *links = d->links;
  const hr2di_link_blocks blocks = links->blocks;
  hr2d_refine_options options = *given;
  options.claim = claim;
  options.claim_ctx = d;
  options.max_links = left(given->max_links, d->kept.count);
  options.max_bytes = left(given->max_bytes, hr2di_store_bytes(&d->kept));
  links->blocks = (hr2di_link_blocks){0};
  hr2d_status status = hr2d_refine(links, &options);
  links->blocks = blocks;
  hr2d_link room[HR2DI_READ_LINKS];
  for (uint64_t first = 0; first < links->store.count && !status;) {
    size_t count = SOME;
    const hr2d_link *link = hr2di_store_read(&links->store, first, &count, room);
    hr2d_pair pair[SOME];
    double area[SOME];
    for (size_t k = 0; k < count; k++) {
      pair[k] = link[k].pair;
      area[k] = link[k].exchange_area;
    }
    status = hr2di_store_add(&d->kept, &links->alloc, pair, area, count);
    first += count;
  }
  return status;
}

/* The links there are, and the work of both refinements. */
static void add_counts(const division *d) {
  hr2d_refine_counts *counts = &d->links->counts;
  const hr2d_refine_counts *before = &d->coarse->counts;
  counts->links = d->links->store.count;
  counts->limited_links += before->limited_links - d->limited;
  counts->partial_links += before->partial_links - d->partial;
  counts->oracle_calls += before->oracle_calls;
  counts->facing_tests += before->facing_tests;
  counts->visibility_tests += before->visibility_tests;
  counts->exchange_areas += before->exchange_areas;
  counts->blocked_pairs += before->blocked_pairs;
  counts->dark_pairs = before->dark_pairs;
}

static hr2d_status run(division *d, const unsigned char *depth,
                       const hr2d_refine_options *options) {
  const hr2d_hierarchy *h = d->coarse->hierarchy;
  for (size_t k = 0; k < h->elements; k++)
    if (depth[k]) d->divided[h->element[k].patch] = 1;
  hr2d_status status = sort_links(d);
  if (status) {
    hr2di_link_blocks_clear(&d->coarse->blocks, &d->coarse->alloc);
    return status;
  }
  take_blocks(d);
  return refine_others(d, options);
}

hr2d_status hr2di_divided_links(hr2d_linkset *links, hr2d_linkset *coarse,
                                const unsigned char *depth,
                                const hr2d_refine_options *options) {
  const hr2d_scene *scene = coarse->hierarchy->scene;
  division d = {.links = links, .coarse = coarse};
  hr2di_scene_watch(scene, &d.watch, options->progress, options->progress_ctx, "refine");
  d.divided = hr2di_alloc_zero(&links->alloc, scene->patches, 1);
  const hr2d_status status = d.divided ? run(&d, depth, options) : HR2D_ENOMEM;
  hr2di_alloc_free(&links->alloc, d.divided);
  if (status) {
    hr2di_store_clear(&d.kept, &links->alloc);
    return status;
  }
  hr2di_store_clear(&links->store, &links->alloc);
  links->store = d.kept;
  add_counts(&d);
  return HR2D_OK;
}
