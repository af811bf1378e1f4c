/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pull, gather over links, push. */
#include "solve/transport.h"

#include <stdint.h>
#include <string.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/team.h"
#include "hierarchy/hierarchy-impl.h"
#include "hierarchy/pane-trees.h"
#include "scene/scene-impl.h"
#include "solve/block-part.h"
#include "solve/gas-light.h"
#include "solve/gather-areas.h"
#include "solve/gather-blocks.h"
#include "solve/gather-links.h"
#include "solve/leading-blocks.h"
#include "solve/shared-gather.h"

/* A slice needs its own copy of `down`, so there are few slices, with many links each. */
enum { MOST_SLICES = 16, SLICE_BLOCKS = 64, MOST_BLOCK_SLICES = 8 };

/* Products of a slice with blocks for each number of its copy, which is cleared and added, and
   all of them at least: less is not worth a thread. */
enum { SLICE_PRODUCTS = 8 };

/* Depends on the links alone, as the order of sums does. */
size_t hr2di_transport_slices(const hr2d_linkset *links, size_t order) {
  const size_t elements = links->hierarchy->elements;
  const uint64_t products = 2 * links->store.count * order; /* per coefficient and band */
  if (links->share) return 1;
  uint64_t slices = 1 + hr2di_store_chunks(&links->store) / SLICE_BLOCKS, max = MOST_SLICES;
  if (order > 1) {
    slices = products / (SLICE_PRODUCTS * (uint64_t)elements);
    max = 1 + products * order / HR2DI_CHOICE_TEAM_PRODUCTS;
    if (max > MOST_BLOCK_SLICES) max = MOST_BLOCK_SLICES;
  }
  return slices < 1 ? 1 : (size_t)(slices < max ? slices : max);
}

/* Elements on both sides of a pane are alike, and so are its leaves. */
static hr2d_status find_other_leaves(hr2di_transport *t) {
  const hr2d_hierarchy *h = t->hierarchy;
  if (!h->scene->other_side) return HR2D_OK;
  uint32_t *other = hr2di_alloc(&t->alloc, 2 * t->elements, sizeof *other);
  t->other_leaf = hr2di_alloc(&t->alloc, t->leaves, sizeof *t->other_leaf);
  hr2d_status status = HR2D_ENOMEM;
  if (other && t->other_leaf) status = hr2di_pane_trees_map(h, other, &t->alloc, t->watch);
  for (size_t k = 0; k < t->leaves && !status; k++)
    other[t->elements + t->leaf[k]] = (uint32_t)k;
  for (size_t k = 0; k < t->leaves && !status; k++)
    t->other_leaf[k] = other[t->elements + other[t->leaf[k]]];
  hr2di_alloc_free(&t->alloc, other);
  return status;
}

hr2d_status hr2di_transport_init(hr2di_transport *t, const hr2d_linkset *links, size_t order,
                                 unsigned threads, hr2di_watch *watch) {
  const hr2d_hierarchy *h = links->hierarchy;
  if (order == 0) order = h->order;
  *t = (hr2di_transport){.links = links,
                         .roots = &links->roots,
                         .hierarchy = h,
                         .scene = h->scene,
                         .alloc = links->alloc,
                         .order = order,
                         .bands = h->scene->bands,
                         .width = order * h->scene->bands,
                         .by_blocks = order > 1 || hr2di_scene_has_gas(h->scene),
                         .elements = h->elements,
                         .slices = hr2di_transport_slices(links, order),
                         .threads = threads,
                         .watch = watch};
  /* The width of a field may overflow a size_t of 32 bits.  No field is larger than those
     below. */
  if (t->bands > PTRDIFF_MAX / sizeof(double) / t->order) return HR2D_ENOMEM;
  const size_t field = t->width * sizeof(double);
  const hr2d_status status =
      hr2di_push_pull_init(&t->trees, h, &t->alloc, t->order, t->bands, watch);
  if (status) return status;
  t->leaf = hr2di_alloc(&t->alloc, (size_t)hr2d_hierarchy_count(h).leaves, sizeof *t->leaf);
  t->up = hr2di_alloc(&t->alloc, t->elements, field);
  t->down = hr2di_alloc(&t->alloc, t->elements * t->slices, field);
  if (!t->leaf || !t->up || !t->down) return HR2D_ENOMEM;
  for (size_t e = 0; e < t->elements; e++)
    if (!h->element[e].child) t->leaf[t->leaves++] = (uint32_t)e;
  if (links->share && hr2di_shared_gather_init(t)) return HR2D_ENOMEM;
  const hr2d_status sides = find_other_leaves(t);
  if (sides) return sides;
  const hr2d_status mapped = hr2di_image_map_init(&t->image_map, h, &t->alloc, watch);
  return mapped ? mapped : hr2di_transport_lead(t, &links->blocks);
}

hr2d_status hr2di_transport_lead(hr2di_transport *t, const hr2di_link_blocks *blocks) {
  t->blocks = *blocks;
  if (!blocks->value || !t->by_blocks || t->order == blocks->order)
    return hr2di_watch_work(t->watch, t->elements / 16);
  t->blocks.rest = NULL;
  t->blocks.order = t->blocks.lead = t->order;
  if (t->order == blocks->lead) return hr2di_watch_work(t->watch, t->elements / 16);
  const hr2d_status status = hr2di_leading_blocks(
      &t->leading, blocks->value, hr2di_number_size(blocks->single), blocks->links,
      blocks->lead, t->order, &t->alloc, t->threads, t->watch);
  t->blocks.value = t->leading;
  return status;
}

void hr2di_transport_clear(hr2di_transport *t) {
  hr2di_shared_gather_clear(t);
  hr2di_push_pull_clear(&t->trees);
  hr2di_image_map_clear(&t->image_map, &t->alloc);
  hr2di_cluster_room_clear(&t->room);
  hr2di_alloc_free(&t->alloc, t->leading);
  hr2di_alloc_free(&t->alloc, t->leaf);
  hr2di_alloc_free(&t->alloc, t->other_leaf);
  hr2di_alloc_free(&t->alloc, t->up);
  hr2di_alloc_free(&t->alloc, t->down);
  if (t->send != t->receive) hr2di_alloc_free(&t->alloc, t->send);
  hr2di_alloc_free(&t->alloc, t->receive);
  hr2di_alloc_free(&t->alloc, t->closure);
  hr2di_alloc_free(&t->alloc, t->mean);
  hr2di_alloc_free(&t->alloc, t->closed);
  hr2di_alloc_free(&t->alloc, t->rows);
  hr2di_alloc_free(&t->alloc, t->sky);
  hr2di_alloc_free(&t->alloc, t->gas);
  hr2di_alloc_free(&t->alloc, t->gas_of);
  hr2di_alloc_free(&t->alloc, t->gas_exchange);
  hr2di_alloc_free(&t->alloc, t->gas_return);
  hr2di_alloc_free(&t->alloc, t->gas_kept);
}

/* Keeps what stopped the watch; whether anything has failed.  Other shares are told at once, as
   callers may go on for a while. */
static int has_failed(hr2di_transport *t) {
  t->failed = hr2di_transport_status(t);
  if (t->failed) t->failed = hr2di_share_agree(t->links->share, t->failed);
  return t->failed != HR2D_OK;
}

/* Leaves or elements between two declarations of work. */
enum { BATCH = 1024 };

static inline int declare(hr2di_transport *t, size_t number) {
  return number % BATCH == 0 && hr2di_watch_work(t->watch, BATCH / 32 + BATCH * t->width / 64);
}

static void pull(hr2di_transport *t, const double *spread, const double *leaf_field) {
  for (size_t k = 0; k < t->leaves && !declare(t, k); k++)
    memcpy(t->up + t->leaf[k] * t->width, leaf_field + k * t->width, t->width * sizeof(double));
  if (!has_failed(t)) hr2di_push_pull_up(&t->trees, spread, t->up);
  hr2di_image_map_spread(&t->image_map, t->order, t->bands, t->up);
  has_failed(t);
}

void hr2di_transport_pull(hr2di_transport *t, const double *leaf_field) {
  pull(t, NULL, leaf_field);
}

/* The links of a run one by one: of distant pairs alone, or parts of links. */
static void gather_each(const hr2di_transport *t, hr2di_transport_part part, hr2di_link_run run,
                        uint64_t first, double *down) {
  const unsigned char *distant = t->blocks.distant + first;
  const size_t count = run.count;
  double room[HR2D_MAX_ORDER * HR2D_MAX_ORDER];
  run.count = 1;
  run.block = (hr2di_stored_block){.order = t->order, .lead = t->order};
  for (size_t k = 0; k < count; k++, run.link++) {
    if (part == HR2DI_DISTANT_LINKS && !distant[k]) continue;
    run.block.value = hr2di_block_part(t, run.link, first + k, room);
    if (run.block.value) hr2di_gather_links(&run, t->order, t->bands, t->up, down);
  }
}

/* The same with blocks, for `count` links from number `first` on. */
static void gather_orders(const hr2di_transport *t, hr2di_transport_part part, uint64_t first,
                          size_t count, double *down) {
  hr2d_link room[HR2DI_READ_LINKS];
  for (size_t done = 0, some; done < count; done += some) {
    const uint64_t at = first + done;
    some = count - done;
    const hr2d_link *link = hr2di_store_read(&t->links->store, at, &some, room);
    const hr2di_link_run run = {.link = link,
                                .block = hr2di_link_blocks_at(&t->blocks, at),
                                .count = some,
                                .directed = t->links->directed};
    if (part == HR2DI_DISTANT_LINKS || t->check)
      gather_each(t, part, run, at, down);
    else
      hr2di_gather_links(&run, t->order, t->bands, t->up, down);
  }
}

/* What a check leaves of the links of some chunks, at order 1. */
static void check_areas(const hr2di_transport *t, size_t from, size_t to, double *down,
                        hr2di_watch *watch) {
  const hr2di_store *store = &t->links->store;
  const uint64_t last = to * HR2DI_CHUNK_LINKS;
  for (uint64_t k = from * HR2DI_CHUNK_LINKS; k < last && k < store->count; k++) {
    const hr2d_link *link = hr2di_store_at(store, k);
    const double area = hr2di_link_part(t, link->pair) * link->exchange_area;
    if (hr2di_watch_work(watch, 1)) return;
    for (size_t b = 0; b < t->bands && area != 0; b++) {
      down[link->pair.first * t->bands + b] += area * t->up[link->pair.second * t->bands + b];
      if (t->links->directed) continue;
      down[link->pair.second * t->bands + b] += area * t->up[link->pair.first * t->bands + b];
    }
  }
}

/* Over the links of a slice at order 1: whole chunks. */
static void gather_areas(const hr2di_transport *t, size_t slice, double *down,
                         hr2di_watch *watch) {
  const size_t chunks = hr2di_store_chunks(&t->links->store);
  const size_t from = slice * chunks / t->slices, to = (slice + 1) * chunks / t->slices;
  const uint64_t units = HR2DI_CHUNK_LINKS / 32 * (1 + t->width / 8);
  if (t->check) {
    check_areas(t, from, to, down, watch);
    return;
  }
  for (size_t k = from; k < to && !hr2di_watch_work(watch, units); k++)
    hr2di_gather_areas(&t->links->store, k, t->bands, t->links->directed, t->up, down);
}

/* Above order 1. */
static void gather_blocks(const hr2di_transport *t, hr2di_transport_part part, size_t slice,
                          double *down, hr2di_watch *watch) {
  const uint64_t links = t->links->store.count, max = HR2DI_READ_LINKS;
  const uint64_t from = slice * links / t->slices, to = (slice + 1) * links / t->slices;
  const uint64_t units = max / 32 * (1 + t->order * t->width / 8);
  for (uint64_t k = from; k < to && !hr2di_watch_work(watch, units); k += max)
    gather_orders(t, part, k, (size_t)(to - k < max ? to - k : max), down);
}

static void gather_slice(const hr2di_transport *t, hr2di_transport_part part, size_t slice,
                         hr2di_watch *watch) {
  const size_t field = t->elements * t->width;
  double *down = t->down + slice * field;
  if (hr2di_watch_work(watch, field / 128)) return;
  memset(down, 0, field * sizeof *down);
  if (t->by_blocks)
    gather_blocks(t, part, slice, down, watch);
  else
    gather_areas(t, slice, down, watch);
}

/* Roots are the first elements, so their part of a field is a field of the patches. */
static void gather_clusters(hr2di_transport *t) {
  const hr2di_cluster_gather how = {.order = t->order,
                                    .bands = t->bands,
                                    .gas = hr2di_cluster_gas_of(t->hierarchy->scene, 0),
                                    .share = t->links->share,
                                    .threads = t->threads,
                                    .room = &t->room,
                                    .watch = t->watch};
  t->failed = hr2di_clusters_gather(t->roots->clusters, &how, t->up, t->down);
}

/* Divides power by length to get irradiance. */
static void divide(hr2di_transport *t) {
  const size_t width = t->width;
  const hr2d_element *element = t->hierarchy->element;
  for (size_t e = 0; e < t->elements && !declare(t, e); e++)
    for (size_t k = 0; k < width; k++) t->down[e * width + k] /= element[e].length;
}

void hr2di_transport_lower(hr2di_transport *t, double *irradiance) {
  const size_t width = t->width;
  if (!has_failed(t)) hr2di_push_pull_down(&t->trees, t->receive, t->down);
  for (size_t k = 0; k < t->leaves && !declare(t, k); k++)
    memcpy(irradiance + k * width, t->down + t->leaf[k] * width, width * sizeof(double));
}

/* A gather under way. */
typedef struct slices {
  hr2di_transport *t;
  hr2di_transport_part part;
  hr2di_watch own[MOST_SLICES]; /* for slices that the calling thread does not gather */
} slices;

static void gather_one(void *ctx, size_t worker, size_t slice) {
  slices *s = ctx;
  gather_slice(s->t, s->part, slice, worker == 0 ? s->t->watch : &s->own[slice]);
}

/* Numbers of a field that one task adds up over all slices. */
enum { TASK = 8192 };

/* Sums the slices in their order, so that the result does not depend on threads. */
static void sum_some(void *ctx, size_t worker, size_t task) {
  const slices *s = ctx;
  const hr2di_transport *t = s->t;
  const size_t field = t->elements * t->width;
  const size_t first = task * TASK;
  const size_t last = field - first > TASK ? first + TASK : field;
  for (size_t from = first, to; from < last; from = to) {
    to = last - from > BATCH ? from + BATCH : last;
    if (worker == 0 && hr2di_watch_work(t->watch, t->slices * BATCH / 64)) return;
    for (size_t k = 1; k < t->slices; k++)
      for (size_t m = from; m < to; m++) t->down[m] += t->down[k * field + m];
  }
}

static void gather_slices(hr2di_transport *t, hr2di_transport_part part) {
  slices s = {.t = t, .part = part};
  const size_t threads = hr2di_team_threads(t->threads);
  for (size_t k = 0; k < t->slices; k++) hr2di_watch_follow(&s.own[k], t->watch);
  hr2di_team_run(threads, t->slices, gather_one, &s, t->watch);
  const size_t tasks = t->slices > 1 ? (t->elements * t->width - 1) / TASK + 1 : 0;
  hr2di_team_run(threads, tasks, sum_some, &s, t->watch);
}

/* Sets t->down to the irradiance of elements over links and clusters, from t->up. */
static void gather(hr2di_transport *t, hr2di_transport_part part) {
  t->sweeps++;
  if (t->shared)
    hr2di_shared_gather(t, part, 0);
  else
    gather_slices(t, part);
  if (has_failed(t)) return;
  if (t->roots->clusters && part == HR2DI_ALL_LINKS) gather_clusters(t);
  hr2di_image_map_fold(&t->image_map, t->order, t->bands, t->down);
  if (!has_failed(t)) divide(t);
}

void hr2di_transport_apply_part(hr2di_transport *t, hr2di_transport_part part,
                                const double *radiosity, double *irradiance) {
  pull(t, t->send, radiosity);
  if (t->failed) return;
  gather(t, part);
  if (!has_failed(t)) hr2di_transport_lower(t, irradiance);
  has_failed(t);
}

void hr2di_transport_check(hr2di_transport *t, int check, const double *radiosity,
                           double *irradiance) {
  t->check = 1 + check;
  hr2di_transport_apply_part(t, HR2DI_ALL_LINKS, radiosity, irradiance);
  t->check = 0;
}

void hr2di_transport_link_rows(hr2di_transport *t, int sends, double *factor) {
  const hr2di_store *store = &t->links->store;
  for (size_t k = 0; k < t->elements * t->width; k++) t->up[k] = 1;
  if (!sends || !t->links->directed) {
    gather(t, HR2DI_ALL_LINKS);
  } else if (t->shared) {
    hr2di_shared_gather(t, HR2DI_ALL_LINKS, 1);
    hr2di_image_map_fold(&t->image_map, t->order, t->bands, t->down);
    divide(t);
  } else {
    memset(t->down, 0, t->elements * t->width * sizeof *t->down);
    for (uint64_t k = 0; k < store->count && !declare(t, k); k++) {
      const hr2d_link *link = hr2di_store_at(store, k);
      t->down[link->pair.second * t->width] += link->exchange_area;
    }
    hr2di_image_map_fold(&t->image_map, t->order, t->bands, t->down);
    divide(t);
  }
  for (size_t k = 0; k < t->elements; k++) factor[k] = t->down[k * t->width];
}

void hr2di_transport_close(const hr2di_transport *t, const double *radiosity,
                           double *irradiance) {
  const size_t square = t->order * t->order;
  for (size_t k = 0; k < t->leaves && t->closure && !t->failed; k++)
    hr2di_gather_block(t->closure + k * square, t->order, t->bands, radiosity + k * t->width,
                       irradiance + k * t->width);
}

void hr2di_transport_apply(hr2di_transport *t, const double *radiosity, double *irradiance) {
  hr2di_transport_apply_part(t, HR2DI_ALL_LINKS, radiosity, irradiance);
  hr2di_transport_close(t, radiosity, irradiance);
  if (t->gas_return) hr2di_gas_light_return(t, radiosity, irradiance);
}
