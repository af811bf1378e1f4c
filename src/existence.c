/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Light that neither is absorbed nor escapes has nowhere to go: in a component of
   patches linked to each other, closed and with ρ = 1 throughout, ∫(E + ρH − B) = 0
   forces ∫E = 0. */
#include "existence.h"

#include "alloc.h"
#include "hierarchy-impl.h"
#include "scene-impl.h"

/* A component is taken as closed if less than this part of its light escapes:
   below it, an opening cannot be told from rounding. */
#define CLOSED 1e-13

typedef struct components {
  size_t *above;  /* union-find over patches */
  double *escape; /* per patch, then per component: A − Σ AF, summed up */
  double *length;
} components;

static size_t find(size_t *above, size_t k) {
  while (above[k] != k) {
    above[k] = above[above[k]];
    k = above[k];
  }
  return k;
}

static void join_links(const hr2d_linkset *links, components *c) {
  const hr2d_element *element = links->hierarchy->element;
  const hr2di_store *store = &links->store;
  for (size_t block = 0; block < store->blocks; block++)
    for (size_t k = 0; k < hr2di_store_block_size(store, block); k++) {
      const hr2d_link link = store->block[block][k];
      const size_t i = element[link.pair.first].patch, j = element[link.pair.second].patch;
      c->escape[i] -= link.exchange_area;
      if (!links->directed) c->escape[j] -= link.exchange_area;
      c->above[find(c->above, i)] = find(c->above, j);
    }
}

static void sum_up(const hr2d_scene *scene, components *c) {
  for (size_t k = 0; k < scene->patches; k++) {
    const size_t root = find(c->above, k);
    if (root == k) continue;
    c->escape[root] += c->escape[k];
    c->length[root] += c->length[k];
  }
}

/* Judges one band: a component is in doubt if it is closed and nothing absorbs. */
static hr2d_status check_band(hr2d_linkset *links, components *c, size_t band,
                              unsigned char *absorbs) {
  const hr2d_scene *scene = links->hierarchy->scene;
  for (size_t k = 0; k < scene->patches; k++) absorbs[k] = 0;
  for (size_t k = 0; k < scene->patches; k++)
    if (hr2d_scene_reflectance(scene, k, band) < 1) absorbs[find(c->above, k)] = 1;
  for (size_t k = 0; k < scene->patches; k++) {
    const size_t root = find(c->above, k);
    if (absorbs[root] || c->escape[root] > CLOSED * c->length[root] ||
        !(hr2d_scene_emission(scene, k, band) > 0))
      continue;
    return hr2di_fail(&links->message, HR2D_ENO_SOLUTION,
                      "no solution in band %zu: %s emits into a closed part of the scene "
                      "where every reflectance is 1, so that light has nowhere to go",
                      band, hr2di_patch_label(scene, k).text);
  }
  return HR2D_OK;
}

static int some_patch_absorbs_nothing(const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->patches; k++)
    for (size_t band = 0; band < scene->bands; band++)
      if (hr2d_scene_reflectance(scene, k, band) == 1) return 1;
  return 0;
}

hr2d_status hr2di_check_existence(hr2d_linkset *links) {
  const hr2d_scene *scene = links->hierarchy->scene;
  if (!some_patch_absorbs_nothing(scene)) return HR2D_OK;
  const hr2d_allocator *alloc = &links->alloc;
  const size_t n = scene->patches;
  components c = {.above = hr2di_alloc(alloc, n, sizeof *c.above),
                  .escape = hr2di_alloc(alloc, n, sizeof *c.escape),
                  .length = hr2di_alloc(alloc, n, sizeof *c.length)};
  unsigned char *absorbs = hr2di_alloc(alloc, n, 1);
  hr2d_status status = HR2D_OK;
  if (!c.above || !c.escape || !c.length || !absorbs) {
    status = hr2di_fail(&links->message, HR2D_ENOMEM, "out of memory for the solve");
  } else {
    for (size_t k = 0; k < n; k++) {
      c.above[k] = k;
      c.escape[k] = c.length[k] = scene->patch[k].length;
    }
    join_links(links, &c);
    sum_up(scene, &c);
    for (size_t band = 0; band < scene->bands && !status; band++)
      status = check_band(links, &c, band, absorbs);
  }
  hr2di_free(alloc, c.above);
  hr2di_free(alloc, c.escape);
  hr2di_free(alloc, c.length);
  hr2di_free(alloc, absorbs);
  return status;
}
