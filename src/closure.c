/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A coarse link spreads its exchange evenly over all leaves below it, so that the
   row sum K·1 of a leaf is off although that of the patch is exact.  Adding d(x)·B(x)
   on each leaf, with d = σ − K·1 and σ the leaf's exact row sum, makes rows exact.

   It keeps the operator symmetric, as d is on the diagonal, and makes it positive:
     Σ A B (I − K − D) B = Σ A (1−σ) B² + ½ Σ AF_ij (B_i − B_j)² ≥ 0,
   so that the discrete equation has one solution wherever ρ < 1, for every ε.  Its
   matrix I − ρ(K + D) is an M-matrix with row sums 1 − ρσ, and so B ≥ 0. */
#include "closure.h"

#include <math.h>

#include "alloc.h"
#include "exchange-area.h"
#include "hierarchy-impl.h"
#include "predicates.h"
#include "scene-impl.h"
#include "sum.h"

/* A patch that misses less than this part of its row sees other patches wherever
   it looks, and then so does each of its leaves: σ = 1.  The sum over its links is
   compensated and each exchange area good to 4e-15. */
#define CLOSED 1e-14

enum { BATCH = 256 };

/* A − Σ AF of each patch. */
static void sum_rows(const hr2di_transport *t, hr2di_sum *rest) {
  const hr2d_element *element = t->hierarchy->element;
  const hr2di_store *store = &t->links->store;
  for (size_t k = 0; k < t->hierarchy->scene->patches; k++)
    rest[k] = (hr2di_sum){element[k].length, 0};
  for (size_t block = 0; block < store->blocks; block++)
    for (size_t k = 0; k < hr2di_store_block_size(store, block); k++) {
      const hr2d_link *link = &store->block[block][k];
      hr2di_add(&rest[element[link->pair.first].patch], -link->exchange_area);
      if (!t->links->directed)
        hr2di_add(&rest[element[link->pair.second].patch], -link->exchange_area);
    }
}

/* The patches that a patch sees, whole or in part, into `seen`; their number.  The
   leaves of the others must not be asked: rounding puts leaves of coplanar patches
   a little before each other. */
static size_t find_seen(const hr2d_scene *scene, size_t patch, uint32_t *seen) {
  size_t count = 0;
  for (size_t k = 0; k < scene->patches; k++)
    if (hr2di_face(&scene->patch[patch].scaled, &scene->patch[k].scaled) != HR2DI_FACING_NONE)
      seen[count++] = (uint32_t)k;
  return count;
}

/* σ of a leaf: its exchange with the patches it may see, over its length. */
static double row_sum(const hr2d_element *element, uint32_t leaf, const uint32_t *seen,
                      size_t count) {
  hr2d_pair pair[BATCH];
  double area[BATCH];
  hr2di_sum sum = {0, 0};
  for (size_t first = 0; first < count; first += BATCH) {
    const size_t some = count - first < BATCH ? count - first : BATCH;
    for (size_t k = 0; k < some; k++) pair[k] = (hr2d_pair){leaf, seen[first + k]};
    hr2di_exchange_areas(element, pair, some, area);
    for (size_t k = 0; k < some; k++) hr2di_add(&sum, area[k]);
  }
  return hr2di_total(&sum) / element[leaf].length;
}

/* σ of every leaf.  The leaves of a patch follow each other as its tree is walked. */
static void row_sums(const hr2di_transport *t, const hr2di_sum *rest, uint32_t *seen,
                     double *sigma) {
  const hr2d_hierarchy *h = t->hierarchy;
  const hr2d_element *element = h->element;
  for (size_t patch = 0; patch < h->scene->patches; patch++) {
    const int closed = fabs(hr2di_total(&rest[patch])) <= CLOSED * element[patch].length;
    const size_t count = closed ? 0 : find_seen(h->scene, patch, seen);
    for (uint32_t e = (uint32_t)patch;;) {
      while (element[e].child) e = element[e].child;
      sigma[e] = closed ? 1 : row_sum(element, e, seen, count);
      while (e != patch && e == element[h->parent[e]].child + 1) e = h->parent[e];
      if (e == patch) break;
      e++; /* a left child: on to its sibling */
    }
  }
}

hr2d_status hr2di_close(hr2di_transport *t) {
  const size_t n = t->hierarchy->scene->patches, field = t->leaves * t->bands;
  double *closure = hr2di_alloc(&t->alloc, t->leaves, sizeof *closure);
  double *one = hr2di_alloc(&t->alloc, field, sizeof *one);
  double *row = hr2di_alloc(&t->alloc, field, sizeof *row);
  double *sigma = hr2di_alloc(&t->alloc, t->elements, sizeof *sigma);
  hr2di_sum *rest = hr2di_alloc(&t->alloc, n, sizeof *rest);
  uint32_t *seen = hr2di_alloc(&t->alloc, n, sizeof *seen);
  const int room = closure && one && row && sigma && rest && seen;
  if (room) {
    for (size_t k = 0; k < field; k++) one[k] = 1;
    hr2di_gather(t, one, row);
    sum_rows(t, rest);
    row_sums(t, rest, seen, sigma);
    for (size_t k = 0; k < t->leaves; k++) closure[k] = sigma[t->leaf[k]] - row[k * t->bands];
    t->closure = closure;
  } else {
    hr2di_free(&t->alloc, closure);
  }
  hr2di_free(&t->alloc, one);
  hr2di_free(&t->alloc, row);
  hr2di_free(&t->alloc, sigma);
  hr2di_free(&t->alloc, rest);
  hr2di_free(&t->alloc, seen);
  return room ? HR2D_OK : HR2D_ENOMEM;
}
