/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs come as beams or clusters find them, and are sorted as a refinement of all pairs would
   take them: by counting, first by their second patch, then by their first. */
#include "clusters/root-pairs.h"

#include <stdatomic.h>
#include <string.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "scene/scene-impl.h"
#include "visibility/row-assembly.h"

/* What beams of one thread find. */
typedef struct found {
  hr2d_pair *pair;
  size_t count, capacity;
} found;

typedef struct collector {
  hr2di_roots *roots;
  const hr2d_allocator *alloc;
  found *found;        /* of each thread */
  size_t max;          /* pairs that beams may find */
  atomic_size_t total; /* that they found so far */
} collector;

static hr2d_status collect(void *ctx, const hr2d_pair *pairs, size_t count) {
  const collector *c = ctx;
  hr2di_roots *r = c->roots;
  if (hr2di_alloc_reserve(c->alloc, &r->pair, &r->capacity, r->count + count, sizeof *r->pair))
    return HR2D_ENOMEM;
  memcpy(r->pair + r->count, pairs, count * sizeof *pairs);
  r->count += count;
  return HR2D_OK;
}

static hr2d_status collect_row(void *ctx, size_t worker, const hr2di_row *row) {
  collector *c = ctx;
  found *of = &c->found[worker];
  if (atomic_fetch_add(&c->total, row->count) + row->count > c->max) return HR2D_STOPPED;
  if (hr2di_alloc_reserve(c->alloc, &of->pair, &of->capacity, of->count + row->count,
                          sizeof *of->pair))
    return HR2D_ENOMEM;
  for (size_t k = 0; k < row->count; k++) {
    const uint32_t p = row->patch, q = row->column[k] & ~HR2DI_PARTIAL;
    of->pair[of->count++] = p < q ? (hr2d_pair){p, q} : (hr2d_pair){q, p};
  }
  return HR2D_OK;
}

static int found_too_many(const collector *c) {
  return atomic_load(&c->total) > c->max;
}

/* Pairs between two declarations of work. */
enum { BATCH = 1024 };

/* Their order does not matter, as they will be sorted: equal pairs are equal in every bit. */
static hr2d_status unite(collector *c, size_t threads, hr2d_status status, hr2di_watch *watch) {
  for (size_t k = 0; k < threads; k++) {
    const found *of = &c->found[k];
    for (size_t from = 0; from < of->count && !status; from += BATCH) {
      status = hr2di_watch_work(watch, BATCH / 64);
      if (!status)
        status =
            collect(c, of->pair + from, of->count - from < BATCH ? of->count - from : BATCH);
    }
    hr2di_alloc_free(c->alloc, of->pair);
  }
  hr2di_alloc_free(c->alloc, c->found);
  return status;
}

/* Half rows have each pair once or twice. */
static hr2d_status find_by_beams(collector *c, const hr2d_scene *scene, unsigned threads,
                                 hr2di_watch *watch) {
  hr2di_row_assembly maker;
  hr2d_status status = hr2di_row_assembly_init(&maker, scene, threads, 0, watch);
  c->max = HR2DI_CHOICE_CLUSTERS_SEEN * scene->patches;
  c->found = hr2di_alloc_zero(c->alloc, maker.workers, sizeof *c->found);
  if (!status && !c->found) status = HR2D_ENOMEM;
  if (!status) status = hr2di_row_assembly_run(&maker, 0, maker.tasks, collect_row, c);
  const int stopped = status == HR2D_STOPPED && found_too_many(c);
  if (c->found) status = unite(c, maker.workers, status, watch);
  hr2di_row_assembly_clear(&maker);
  return stopped ? hr2di_watch_status(watch) : status;
}

static uint32_t key(const hr2d_pair *pair, int by_first) {
  return by_first ? pair->first : pair->second;
}

/* Stable; leaves in `start` where each key's pairs begin, and their number behind. */
static hr2d_status sort_by(const hr2d_pair *from, hr2d_pair *to, size_t count, size_t *start,
                           size_t keys, int by_first, hr2di_watch *watch) {
  hr2d_status status = hr2di_watch_work(watch, keys / 64);
  memset(start, 0, (keys + 1) * sizeof *start);
  for (size_t k = 0; k < count && !status; k++) {
    if (k % BATCH == 0) status = hr2di_watch_work(watch, BATCH / 32);
    start[key(&from[k], by_first) + 1]++;
  }
  for (size_t k = 0; k < keys; k++) start[k + 1] += start[k];
  for (size_t k = 0; k < count && !status; k++) {
    if (k % BATCH == 0) status = hr2di_watch_work(watch, BATCH / 16);
    to[start[key(&from[k], by_first)]++] = from[k];
  }
  for (size_t k = keys; k > 0; k--) start[k] = start[k - 1];
  start[0] = 0;
  return status;
}

/* Keeps one of equal pairs, and counts the rows anew. */
static hr2d_status drop_doubles(hr2di_roots *r, size_t patches, hr2di_watch *watch) {
  size_t kept = 0;
  hr2d_status status = HR2D_OK;
  for (size_t i = 0, k = 0; i < patches && !status; i++) {
    const size_t last = r->row[i + 1], first = kept;
    for (; k < last; k++)
      if (kept == first || r->pair[k].second != r->pair[kept - 1].second)
        r->pair[kept++] = r->pair[k];
    r->row[i] = first;
    status = hr2di_watch_work(watch, 1 + (last - first) / 64);
  }
  r->row[patches] = r->count = kept;
  return status;
}

static hr2d_status sort_pairs(hr2di_roots *r, size_t patches, const hr2d_allocator *alloc,
                              hr2di_watch *watch) {
  hr2d_pair *sorted = hr2di_alloc(alloc, r->count, sizeof *sorted);
  r->row = hr2di_alloc(alloc, patches + 1, sizeof *r->row);
  hr2d_status status = sorted && r->row ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = sort_by(r->pair, sorted, r->count, r->row, patches, 0, watch);
  if (!status) status = sort_by(sorted, r->pair, r->count, r->row, patches, 1, watch);
  if (!status) status = drop_doubles(r, patches, watch);
  hr2di_alloc_free(alloc, sorted);
  return status;
}

hr2d_status hr2di_roots_init(hr2di_roots *roots, const hr2d_scene *scene,
                             const hr2d_allocator *alloc, double accuracy, unsigned threads,
                             hr2di_watch *watch) {
  const int shaded = scene->effect[HR2D_EFFECT_OCCLUSION].on;
  collector c = {.roots = roots, .alloc = alloc};
  *roots = (hr2di_roots){.accuracy = accuracy};
  hr2d_status status = shaded ? find_by_beams(&c, scene, threads, watch) : HR2D_OK;
  const int too_many = found_too_many(&c);
  /* Links of clusters would join all images with each other. */
  if (scene->symmetry.motion && (!shaded || too_many)) return status;
  if (!status && (!shaded || too_many))
    status =
        hr2di_clusters_create(scene, alloc, accuracy, collect, &c, watch, &roots->clusters);
  return status ? status : sort_pairs(roots, scene->patches, alloc, watch);
}

hr2d_status hr2di_roots_copy(hr2di_roots *roots, const hr2di_roots *from, size_t patches,
                             const hr2d_allocator *alloc, hr2di_watch *watch) {
  *roots = (hr2di_roots){.accuracy = from->accuracy};
  if (!from->row) return HR2D_OK;
  roots->pair = hr2di_alloc(alloc, from->count, sizeof *roots->pair);
  roots->row = hr2di_alloc(alloc, patches + 1, sizeof *roots->row);
  if (!roots->pair || !roots->row) return HR2D_ENOMEM;
  roots->count = roots->capacity = from->count;
  memcpy(roots->pair, from->pair, from->count * sizeof *roots->pair);
  memcpy(roots->row, from->row, (patches + 1) * sizeof *roots->row);
  return hr2di_watch_work(watch, from->count / 256);
}

void hr2di_roots_clear(hr2di_roots *roots, const hr2d_allocator *alloc) {
  hr2di_clusters_destroy(roots->clusters);
  hr2di_alloc_free(alloc, roots->pair);
  hr2di_alloc_free(alloc, roots->row);
  *roots = (hr2di_roots){0};
}
