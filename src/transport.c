/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pull, gather over links, push. */
#include "transport.h"

#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "alloc.h"
#include "hierarchy-impl.h"
#include "scene-impl.h"

/* A slice needs its own copy of `down`, so there are few, and each has many links. */
enum { MOST_SLICES = 16, SLICE_BLOCKS = 64 };

static size_t count_slices(const hr2d_linkset *links) {
  const size_t slices = 1 + links->store.blocks / SLICE_BLOCKS;
  return slices < MOST_SLICES ? slices : MOST_SLICES;
}

hr2d_status hr2di_transport_init(hr2di_transport *t, const hr2d_linkset *links,
                                 unsigned threads) {
  const hr2d_hierarchy *h = links->hierarchy;
  *t = (hr2di_transport){.links = links,
                         .hierarchy = h,
                         .alloc = links->alloc,
                         .bands = h->scene->bands,
                         .elements = h->elements,
                         .slices = count_slices(links),
                         .threads = threads};
  const size_t field = t->bands * sizeof(double);
  t->leaf = hr2di_alloc(&t->alloc, (size_t)hr2d_hierarchy_count(h).leaves, sizeof *t->leaf);
  t->up = hr2di_alloc(&t->alloc, t->elements, field);
  t->down = hr2di_alloc(&t->alloc, t->elements * t->slices, field);
  if (!t->leaf || !t->up || !t->down) return HR2D_ENOMEM;
  for (size_t e = 0; e < t->elements; e++)
    if (!h->element[e].child) t->leaf[t->leaves++] = (uint32_t)e;
  return HR2D_OK;
}

void hr2di_transport_clear(hr2di_transport *t) {
  hr2di_free(&t->alloc, t->leaf);
  hr2di_free(&t->alloc, t->up);
  hr2di_free(&t->alloc, t->down);
  hr2di_free(&t->alloc, t->closure);
  hr2di_free(&t->alloc, t->sky);
}

/* Children come after their parents, so that one falling loop meets them first. */
void hr2di_pull(hr2di_transport *t, const double *leaf_field) {
  const size_t bands = t->bands;
  const hr2d_element *element = t->hierarchy->element;
  for (size_t k = 0; k < t->leaves; k++)
    memcpy(t->up + t->leaf[k] * bands, leaf_field + k * bands, bands * sizeof(double));
  for (size_t e = t->elements; e-- > 0;) {
    if (!element[e].child) continue;
    const double *left = t->up + element[e].child * bands, *right = left + bands;
    for (size_t b = 0; b < bands; b++) t->up[e * bands + b] = 0.5 * (left[b] + right[b]);
  }
}

/* Power received over the links of one block, both ways unless directed. */
static void gather_block(const hr2d_link *link, size_t count, size_t bands, int plain,
                         int directed, const double *up, double *down) {
  if (plain && !directed) {
    for (size_t k = 0; k < count; k++) {
      const hr2d_pair p = link[k].pair;
      const double area = link[k].exchange_area;
      down[p.first] += area * up[p.second];
      down[p.second] += area * up[p.first];
    }
    return;
  }
  for (size_t k = 0; k < count; k++) {
    const size_t i = link[k].pair.first * bands, j = link[k].pair.second * bands;
    const double area = link[k].exchange_area;
    for (size_t b = 0; b < bands; b++) down[i + b] += area * up[j + b];
    for (size_t b = 0; b < bands && !directed; b++) down[j + b] += area * up[i + b];
  }
}

static void gather_slice(hr2di_transport *t, size_t slice) {
  const hr2di_store *store = &t->links->store;
  const size_t from = slice * store->blocks / t->slices;
  const size_t to = (slice + 1) * store->blocks / t->slices;
  double *down = t->down + slice * t->elements * t->bands;
  memset(down, 0, t->elements * t->bands * sizeof *down);
  const int plain = !t->hierarchy->scene->effect[HR2D_EFFECT_BANDS].on;
  for (size_t k = from; k < to; k++)
    gather_block(store->block[k], hr2di_store_block_size(store, k), t->bands, plain,
                 t->links->directed, t->up, down);
}

/* Sums the slices in their order, so that the threads leave no trace. */
static void sum_slices(hr2di_transport *t) {
  const size_t field = t->elements * t->bands;
  for (size_t s = 1; s < t->slices; s++) {
    const double *part = t->down + s * field;
    for (size_t k = 0; k < field; k++) t->down[k] += part[k];
  }
}

/* Power to irradiance, and every element's to its children. */
static void push(hr2di_transport *t, double *irradiance) {
  const size_t bands = t->bands;
  const hr2d_element *element = t->hierarchy->element;
  for (size_t e = 0; e < t->elements; e++) {
    const uint32_t parent = t->hierarchy->parent[e];
    for (size_t b = 0; b < bands; b++) {
      t->down[e * bands + b] /= element[e].length;
      if (parent != e) t->down[e * bands + b] += t->down[parent * bands + b];
    }
  }
  for (size_t k = 0; k < t->leaves; k++)
    memcpy(irradiance + k * bands, t->down + t->leaf[k] * bands, bands * sizeof(double));
}

void hr2di_gather(hr2di_transport *t, const double *radiosity, double *irradiance) {
  hr2di_pull(t, radiosity);
#ifdef _OPENMP
  const int threads = t->threads ? (int)t->threads : omp_get_max_threads();
#pragma omp parallel for num_threads(threads) schedule(dynamic) if (t->slices > 1)
#endif
  for (size_t slice = 0; slice < t->slices; slice++) gather_slice(t, slice);
  sum_slices(t);
  push(t, irradiance);
  for (size_t k = 0; k < t->leaves && t->closure; k++)
    for (size_t b = 0; b < t->bands; b++)
      irradiance[k * t->bands + b] += t->closure[k] * radiosity[k * t->bands + b];
  t->sweeps++;
}

void hr2di_add_background(const hr2di_transport *t, double *irradiance) {
  const hr2d_scene *scene = t->hierarchy->scene;
  for (size_t k = 0; k < t->leaves && t->sky; k++)
    for (size_t b = 0; b < t->bands; b++)
      irradiance[k * t->bands + b] += t->sky[k] * hr2d_scene_background(scene, b);
}
