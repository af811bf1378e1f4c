/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Above the cut every rank has the same elements: a flag for each that could be there says
   which are divided.  Below it owners are told; then elements and leaves are counted once. */
#include "trees.h"

#include "share.h"
#include "trees-impl.h"
#include "units.h"

hr2d_status hr2dpi_places_find(hr2dp *p, hr2dpi_places *at) {
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  const unsigned cut = p->units.cut;
  at->elements = (size_t)hr2d_hierarchy_count(p->hierarchy).elements;
  hr2dpi_free(p, at->first);
  hr2dpi_free(p, at->level);
  at->first = hr2dpi_alloc(p, at->elements, sizeof *at->first);
  at->level = hr2dpi_alloc(p, at->elements, 1);
  if (!at->first || !at->level) return HR2D_ENOMEM;
  for (uint32_t k = 0; k < p->roots; k++) {
    at->first[k] = k < p->patches ? k << cut : HR2DPI_NONE;
    at->level[k] = (unsigned char)(k < p->patches ? 0 : cut + 1);
  }
  for (size_t e = 0; e < at->elements; e++) {
    const uint32_t c = element[e].child, level = at->level[e];
    if (!c) continue;
    at->first[c] = at->first[c + 1] = at->first[e];
    if (level < cut) at->first[c + 1] += (uint32_t)1 << (cut - level - 1);
    at->level[c] = at->level[c + 1] = (unsigned char)(level < cut ? level + 1 : cut + 1);
  }
  return HR2D_OK;
}

static void clear_places(const hr2dp *p, hr2dpi_places *at) {
  hr2dpi_free(p, at->first);
  hr2dpi_free(p, at->level);
  hr2dpi_free(p, at->touched);
  hr2dpi_free(p, at->base);
}

/* Of the elements that there are now. */
static hr2d_status map_images(hr2dp *p) {
  hr2dpi_free(p, p->trees.original);
  p->trees.original = NULL;
  if (p->images == 1) return HR2D_OK;
  const size_t elements = (size_t)hr2d_hierarchy_count(p->hierarchy).elements;
  p->trees.original = hr2dpi_alloc(p, elements, sizeof *p->trees.original);
  return p->trees.original ? hr2d_hierarchy_originals(p->hierarchy, p->trees.original)
                           : HR2D_ENOMEM;
}

static void touch(const hr2dp *p, hr2dpi_places *at, uint32_t e) {
  at->touched[e] = at->touched[hr2dpi_original(p, e)] = 1;
}

static hr2d_status mark_touched(hr2dp *p, hr2dpi_places *at) {
  hr2d_link link[256];
  uint64_t next = 0;
  size_t count;
  at->touched = hr2dpi_alloc_zero(p, at->elements, 1);
  if (!at->touched) return HR2D_ENOMEM;
  while ((count = hr2dpi_share_read(p, &next, link, 256)) > 0)
    for (size_t k = 0; k < count; k++) {
      touch(p, at, link[k].pair.first);
      touch(p, at, link[k].pair.second);
    }
  return HR2D_OK;
}

/* The flags of a patch are in the order of a heap, and begin with number 1. */
static uint64_t flags_of_patch(const hr2dp *p) {
  return ((uint64_t)1 << p->units.cut) - 1;
}

static void set_flags(const hr2dp *p, const hr2dpi_places *at, unsigned char *flag) {
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  const unsigned cut = p->units.cut;
  for (uint32_t e = 0; e < at->elements; e++) {
    if (!hr2dpi_is_top(p, at, element, e)) continue;
    const uint64_t patch = element[e].patch;
    const uint64_t offset = (at->first[e] - (patch << cut)) >> (cut - at->level[e]);
    flag[patch * flags_of_patch(p) + ((uint64_t)1 << at->level[e]) + offset - 1] = 1;
  }
}

/* Divides one patch above the cut, and notes its bases; `node` is work space for its heap. */
static hr2d_status divide_patch(hr2dp *p, hr2dpi_places *at, const unsigned char *flag,
                                uint32_t patch, uint32_t *node) {
  const uint64_t inner = flags_of_patch(p);
  hr2d_status status = HR2D_OK;
  node[1] = patch;
  for (uint64_t h = 1; h <= 2 * inner + 1; h++) {
    if (node[h] == HR2DPI_NONE) continue;
    if (h > inner || !flag[h - 1]) {
      unsigned level = 0;
      while (h >> (level + 1)) level++;
      const uint64_t offset = h - ((uint64_t)1 << level);
      at->base[((uint64_t)patch << p->units.cut) + (offset << (p->units.cut - level))] =
          node[h];
      continue;
    }
    p->trees.top[p->trees.tops++] = node[h];
    uint32_t child = hr2d_hierarchy_elements(p->hierarchy)[node[h]].child;
    if (!child) status = hr2d_hierarchy_divide(p->hierarchy, node[h], 0.5, &child);
    if (status) return status;
    node[2 * h] = child;
    node[2 * h + 1] = child + 1;
  }
  return status;
}

static hr2d_status divide_top(hr2dp *p, hr2dpi_places *at, const unsigned char *flag) {
  const uint64_t inner = flags_of_patch(p), nodes = 2 * inner + 2;
  uint32_t *node = hr2dpi_alloc(p, nodes, sizeof *node);
  at->base = hr2dpi_alloc(p, p->units.count, sizeof *at->base);
  p->trees.top = hr2dpi_alloc(p, p->patches * inner, sizeof *p->trees.top);
  hr2d_status status = node && at->base && p->trees.top ? HR2D_OK : HR2D_ENOMEM;
  for (uint64_t u = 0; u < p->units.count && !status; u++) at->base[u] = HR2DPI_NONE;
  for (uint32_t k = 0; k < p->patches && !status; k++) {
    for (uint64_t h = 0; h < nodes; h++) node[h] = HR2DPI_NONE;
    status = divide_patch(p, at, flag + k * inner, k, node);
  }
  hr2dpi_free(p, node);
  return status;
}

static PetscErrorCode unite_top_by(hr2dp *p, hr2dpi_places *at, unsigned char *flag) {
  PetscFunctionBegin;
  const hr2d_status status = flag ? hr2dpi_places_find(p, at) : HR2D_ENOMEM;
  PetscCall(hr2dpi_agree(p, status));
  set_flags(p, at, flag);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, flag, (int)(p->patches * flags_of_patch(p)),
                             MPI_UNSIGNED_CHAR, MPI_MAX, p->comm));
  PetscCall(hr2dpi_agree(p, divide_top(p, at, flag)));
  PetscFunctionReturn(0);
}

static PetscErrorCode unite_top(hr2dp *p, hr2dpi_places *at) {
  PetscFunctionBegin;
  unsigned char *flag = hr2dpi_alloc_zero(p, p->patches * flags_of_patch(p), 1);
  const PetscErrorCode failed = unite_top_by(p, at, flag);
  hr2dpi_free(p, flag);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

/* Leaves of a unit that some rank has; all ranks together have a few more. */
static void weigh_units(const hr2dp *p, const hr2dpi_places *at, double *weight) {
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  for (uint32_t e = 0; e < at->elements; e++)
    if (!element[e].child && at->first[e] != HR2DPI_NONE) weight[at->first[e]]++;
}

static PetscErrorCode share_out(hr2dp *p, const hr2dpi_places *at) {
  PetscFunctionBegin;
  if (p->units.placed || p->ranks == 1 || p->units.count > INT_MAX) PetscFunctionReturn(0);
  double *weight = hr2dpi_alloc_zero(p, p->units.count, sizeof *weight);
  PetscErrorCode failed = hr2dpi_agree(p, weight ? HR2D_OK : HR2D_ENOMEM);
  if (!failed) {
    weigh_units(p, at, weight);
    failed = hr2dpi_max_doubles(p, weight, (int)p->units.count);
  }
  if (!failed) hr2dpi_ranges_cut(p, weight, &p->units.leaves);
  hr2dpi_free(p, weight);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

static int is_own(const hr2dp *p, const hr2dpi_places *at, uint32_t e) {
  const uint64_t *from = p->units.leaves.from;
  return at->first[e] >= from[p->rank] && at->first[e] < from[p->rank + 1];
}

/* Lists own leaves by position. */
static void list_leaves(hr2dp *p, const hr2dpi_places *at, uint32_t *stack) {
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  const uint64_t *from = p->units.leaves.from;
  hr2dpi_trees *t = &p->trees;
  for (uint64_t u = from[p->rank]; u < from[p->rank + 1]; u++) {
    size_t depth = 0;
    if (at->base[u] != HR2DPI_NONE) stack[depth++] = at->base[u];
    while (depth > 0) {
      const uint32_t e = stack[--depth];
      if (!element[e].child) {
        t->leaf[t->leaves++] = e;
        continue;
      }
      stack[depth++] = element[e].child + 1;
      stack[depth++] = element[e].child;
    }
  }
}

static hr2d_status list_own(hr2dp *p, hr2dpi_places *at) {
  hr2d_status status = hr2dpi_places_find(p, at);
  if (!status) status = map_images(p);
  if (status) return status;
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  const hr2d_hierarchy_counts n = hr2d_hierarchy_count(p->hierarchy);
  hr2dpi_trees *t = &p->trees;
  uint32_t *stack = hr2dpi_alloc(p, n.levels + 2, sizeof *stack);
  t->elements = at->elements;
  t->own = hr2dpi_alloc(p, at->elements, sizeof *t->own);
  t->leaf = hr2dpi_alloc(p, (size_t)n.leaves, sizeof *t->leaf);
  if (stack && t->own && t->leaf) {
    for (uint32_t e = 0; e < at->elements; e++)
      if (is_own(p, at, e) && !hr2dpi_is_top(p, at, element, e)) t->own[t->owned++] = e;
    list_leaves(p, at, stack);
  } else {
    status = HR2D_ENOMEM;
  }
  hr2dpi_free(p, stack);
  return status;
}

/* N, leaves and levels of the union, with those of images; roots count with their units, and
   ends of a period are leaves. */
static PetscErrorCode count(hr2dp *p) {
  PetscFunctionBegin;
  hr2dpi_trees *t = &p->trees;
  hr2dp_counts *c = &p->counts;
  c->own_elements = t->owned;
  c->own_leaves = t->leaves;
  c->touched_elements = t->elements;
  c->halo_elements = t->halos;
  uint64_t sum[2] = {t->owned, t->leaves};
  uint64_t max[2] = {t->owned, hr2d_hierarchy_count(p->hierarchy).levels};
  PetscCall(hr2dpi_add_counts(p, sum, 2));
  PetscCall(hr2dpi_max_counts(p, max, 2));
  const uint64_t ends = p->roots - p->patches * p->images;
  c->whole.elements = (sum[0] + t->tops) * p->images + ends;
  c->whole.leaves = sum[1] * p->images + ends;
  c->whole.levels = (unsigned)max[1];
  c->max_elements = max[0];
  PetscFunctionReturn(0);
}

static PetscErrorCode make_types(hr2dp *p) {
  PetscFunctionBegin;
  const int width = (int)p->bands;
  for (int k = 0; k < 2; k++) {
    PetscCallMPI(MPI_Type_contiguous((k + 1) * width, MPI_DOUBLE, &p->trees.unit[k]));
    PetscCallMPI(MPI_Type_commit(&p->trees.unit[k]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode unite(hr2dp *p, hr2dpi_places *at) {
  PetscFunctionBegin;
  PetscCall(unite_top(p, at));
  hr2d_status status = hr2dpi_places_find(p, at);
  if (!status) status = map_images(p);
  if (!status) status = mark_touched(p, at);
  PetscCall(hr2dpi_agree(p, status));
  PetscCall(share_out(p, at));
  PetscCall(hr2dpi_shapes_exchange(p, at));
  PetscCall(hr2dpi_agree(p, list_own(p, at)));
  PetscCall(count(p));
  PetscCall(make_types(p));
  p->units.placed = 1;
  p->trees.ready = 1;
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_trees_unite(hr2dp *p) {
  PetscFunctionBegin;
  hr2dpi_places at = {0};
  PetscCall(hr2dpi_trees_clear(p));
  const PetscErrorCode failed = unite(p, &at);
  clear_places(p, &at);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_trees_clear(hr2dp *p) {
  PetscFunctionBegin;
  hr2dpi_trees *t = &p->trees;
  hr2dpi_free(p, t->own);
  hr2dpi_free(p, t->top);
  hr2dpi_free(p, t->leaf);
  hr2dpi_free(p, t->original);
  PetscCall(PetscSFDestroy(&t->halo));
  for (int k = 0; k < 2 && t->ready; k++) PetscCallMPI(MPI_Type_free(&t->unit[k]));
  *t = (hr2dpi_trees){0};
  PetscFunctionReturn(0);
}
