/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs come as clusters are walked, and are sorted as a refinement without clusters would
   take them: by counting, first by their second patch, then by their first. */
#include "clusters/root-pairs.h"

#include <string.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"

typedef struct collector {
  hr2di_roots *roots;
  const hr2d_allocator *alloc;
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

/* Pairs between two declarations of work. */
enum { SOME = 1024 };

static uint32_t key(const hr2d_pair *pair, int by_first) {
  return by_first ? pair->first : pair->second;
}

/* Stable; leaves in `start` where each key's pairs begin, and their number behind. */
static hr2d_status sort_by(const hr2d_pair *from, hr2d_pair *to, size_t count, size_t *start,
                           size_t keys, int by_first, hr2di_watch *watch) {
  hr2d_status status = hr2di_watch_work(watch, keys / 64);
  memset(start, 0, (keys + 1) * sizeof *start);
  for (size_t k = 0; k < count && !status; k++) {
    if (k % SOME == 0) status = hr2di_watch_work(watch, SOME / 32);
    start[key(&from[k], by_first) + 1]++;
  }
  for (size_t k = 0; k < keys; k++) start[k + 1] += start[k];
  for (size_t k = 0; k < count && !status; k++) {
    if (k % SOME == 0) status = hr2di_watch_work(watch, SOME / 16);
    to[start[key(&from[k], by_first)]++] = from[k];
  }
  for (size_t k = keys; k > 0; k--) start[k] = start[k - 1];
  start[0] = 0;
  return status;
}

static hr2d_status sort_pairs(hr2di_roots *r, size_t patches, const hr2d_allocator *alloc,
                              hr2di_watch *watch) {
  hr2d_pair *sorted = hr2di_alloc(alloc, r->count, sizeof *sorted);
  r->row = hr2di_alloc(alloc, patches + 1, sizeof *r->row);
  hr2d_status status = sorted && r->row ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = sort_by(r->pair, sorted, r->count, r->row, patches, 0, watch);
  if (!status) status = sort_by(sorted, r->pair, r->count, r->row, patches, 1, watch);
  hr2di_alloc_free(alloc, sorted);
  return status;
}

hr2d_status hr2di_roots_init(hr2di_roots *roots, const hr2d_scene *scene,
                             const hr2d_allocator *alloc, double accuracy, hr2di_watch *watch) {
  collector c = {roots, alloc};
  *roots = (hr2di_roots){.accuracy = accuracy};
  hr2d_status status =
      hr2di_clusters_create(scene, alloc, accuracy, collect, &c, watch, &roots->clusters);
  if (!status) status = sort_pairs(roots, scene->patches, alloc, watch);
  return status;
}

void hr2di_roots_clear(hr2di_roots *roots, const hr2d_allocator *alloc) {
  hr2di_clusters_destroy(roots->clusters);
  hr2di_alloc_free(alloc, roots->pair);
  hr2di_alloc_free(alloc, roots->row);
  *roots = (hr2di_roots){0};
}
