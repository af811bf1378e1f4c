/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Row sums of leaves.

   If a patch sees patches in every direction, so do its leaves: their sums are 1.  Other leaves
   sum their exchange areas with every patch that their patch sees, or, if the scene calls for
   occlusion, with every element that the leaf or an ancestor of it is linked with.  A tree is
   walked down only as far as walls are in the way of its elements. */
#include "solve/row-sums.h"

#include "base/alloc.h"
#include "geometry/predicates.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/patch-defect.h"
#include "occlusion/pair-visibility.h"
#include "scene/back-faces.h"
#include "scene/scene-impl.h"

/* Elements wait on a stack with their walls, one per level. */
enum { DEPTH = 1100 };

typedef struct waiting {
  uint32_t element;
  size_t first, count; /* of its walls */
} waiting;

/* The row of one patch. */
typedef struct walker {
  const hr2d_hierarchy *h;
  hr2di_watch *watch;
  hr2di_backs backs;            /* empty if not asked for */
  hr2d_segment line;            /* of the patch */
  hr2d_segment source;          /* its leaves look at this: a patch, a back or an element */
  hr2d_segment source_line;     /* the patch of which `source` is a part */
  hr2di_visibility *visibility; /* NULL if nothing can be in the way */
  hr2di_wall_list list;
  waiting stack[DEPTH];
  hr2di_sum *sum; /* per element, set for leaves */
} walker;

/* Adds the exchange areas of the source with all leaves below an element, with nothing in the
   way. */
static void add_clear(walker *w, uint32_t top) {
  const hr2d_element *element = w->h->element;
  uint32_t leaf = hr2di_hierarchy_first_leaf(w->h, top);
  do {
    if (hr2di_watch_work(w->watch, 1)) return;
    const hr2d_segment s = {element[leaf].a, element[leaf].b};
    hr2di_sum_add(&w->sum[leaf], hr2d_exchange_area(&s, &w->source));
    leaf = hr2di_hierarchy_next_leaf(w->h, leaf, top);
  } while (leaf);
}

/* Looks from an element at the source.  If the view is clear, adds the exchange areas of all
   leaves below.  If walls are in the way, adds the exchange area of a leaf, and puts an element
   with children on the stack.  `parent` is NULL where a walk begins. */
static hr2d_status look(walker *w, uint32_t element, const waiting *parent, size_t *count) {
  const hr2d_element *e = &w->h->element[element];
  const hr2d_segment s = {e->a, e->b};
  hr2di_shaft shaft;
  hr2di_visibility_class view = HR2DI_CLEAR;
  const size_t first = w->list.count;
  const hr2di_facing facing = hr2di_facing_of(&s, &w->source);
  hr2d_status status = hr2di_watch_work(w->watch, 1);
  if (status || facing == HR2DI_FACING_NONE) return status;
  const int shaded =
      w->visibility && hr2di_shaft_init(&shaft, facing, s, w->source, w->line, w->source_line);
  if (shaded && parent)
    status = hr2di_visibility_shrink(w->visibility, &shaft, &w->list, parent->first,
                                     parent->count, &w->list, &view);
  else if (shaded)
    status = hr2di_visibility_collect(w->visibility, &shaft, &w->list, &view);
  if (status) return status;
  if (view == HR2DI_CLEAR) add_clear(w, element);
  if (view != HR2DI_PARTIAL) return hr2di_watch_status(w->watch);
  if (e->child) {
    w->stack[(*count)++] = (waiting){element, first, w->list.count - first};
    return HR2D_OK;
  }
  double area;
  int open;
  status = hr2di_visibility_area(w->visibility, &shaft, hr2di_wall_list_from(&w->list, first),
                                 w->list.count - first, &area, &open);
  if (!status) hr2di_sum_add(&w->sum[element], area);
  w->list.count = first;
  return status;
}

/* Adds the exchange areas of the source with the leaves of a patch, or of an element. */
static hr2d_status walk(walker *w, uint32_t patch) {
  size_t count = 0;
  w->list.count = 0;
  hr2d_status status = look(w, patch, NULL, &count);
  while (count > 0 && !status) {
    const waiting top = w->stack[--count];
    const uint32_t child = w->h->element[top.element].child;
    w->list.count = top.first + top.count;
    for (uint32_t k = 0; k < 2 && !status; k++) status = look(w, child + k, &top, &count);
  }
  return status;
}

/* Adds the exchange areas of the leaves of a patch with all patches, and with all backs if
   asked for. */
static hr2d_status walk_row(walker *w, uint32_t patch, hr2di_sum *front, hr2di_sum *back) {
  const hr2d_scene *scene = w->h->scene;
  hr2d_status status = HR2D_OK;
  w->line = scene->patch[patch].scaled;
  w->sum = front;
  for (size_t k = 0; k < scene->patches && !status && front; k++) {
    if (k == patch || !hr2di_scene_lit(scene, k)) continue;
    w->source = w->source_line = scene->patch[k].scaled;
    status = walk(w, patch);
  }
  w->sum = back;
  for (size_t k = 0; k < w->backs.count && !status; k++) {
    const hr2d_segment s = scene->patch[w->backs.back[k].patch].scaled;
    w->source = w->backs.back[k].at;
    w->source_line = (hr2d_segment){s.b, s.a};
    status = walk(w, patch);
  }
  return status;
}

/* Adds the exchange areas of the leaves of an element with another one that it is linked with.
   If walls change no bit of the link's exchange area, they count as none for the leaves. */
static hr2d_status walk_link(walker *w, uint32_t receiver, uint32_t source, double area) {
  const hr2d_element *e = &w->h->element[receiver], *f = &w->h->element[source];
  const hr2d_segment s = {e->a, e->b};
  w->source = (hr2d_segment){f->a, f->b};
  w->source_line = w->h->scene->patch[f->patch].scaled;
  w->line = w->h->scene->patch[e->patch].scaled;
  if (hr2d_exchange_area(&s, &w->source) != area) return walk(w, receiver);
  add_clear(w, receiver);
  return hr2di_watch_work(w->watch, 1);
}

static hr2d_status walk_links(walker *w, const hr2di_transport *t,
                              const unsigned char *closed) {
  const hr2d_element *element = w->h->element;
  const hr2di_store *store = &t->links->store;
  hr2d_status status = HR2D_OK;
  for (uint64_t k = 0; k < store->count && !status; k++) {
    const hr2d_link link = *hr2di_store_at(store, k);
    const uint32_t i = link.pair.first, j = link.pair.second;
    if (k % 64 == 0) status = hr2di_watch_work(w->watch, 8);
    if (!status && !closed[element[i].patch]) status = walk_link(w, i, j, link.exchange_area);
    if (!status && !t->links->directed && !closed[element[j].patch])
      status = walk_link(w, j, i, link.exchange_area);
  }
  return status;
}

/* Sets the row sums of the leaves of a patch: 1 if it is closed, else the sums over length. */
static void finish(hr2di_row_sums *rows, uint32_t patch, const hr2di_sum *front,
                   const hr2di_sum *back) {
  const hr2d_hierarchy *h = rows->hierarchy;
  uint32_t leaf = hr2di_hierarchy_first_leaf(h, patch);
  do {
    const double length = h->element[leaf].length;
    rows->leaves += !rows->closed[patch];
    if (hr2di_watch_work(rows->watch, 1)) return;
    rows->front[leaf] = rows->closed[patch] ? 1 : hr2di_sum_total(&front[leaf]) / length;
    if (rows->back) rows->back[leaf] = hr2di_sum_total(&back[leaf]) / length;
    leaf = hr2di_hierarchy_next_leaf(h, leaf, patch);
  } while (leaf);
}

static hr2d_status walk_rows(hr2di_row_sums *rows, const hr2di_transport *t, walker *w,
                             const hr2di_sum *defect, hr2di_sum *front, hr2di_sum *back) {
  const hr2d_scene *scene = w->h->scene;
  const int by_links = scene->effect[HR2D_EFFECT_OCCLUSION].called_for;
  hr2d_status status = HR2D_OK;
  hr2di_defect_closed(t->links, defect, rows->closed);
  w->sum = front;
  if (by_links) status = walk_links(w, t, rows->closed);
  for (uint32_t k = 0; k < scene->patches && !status; k++) {
    if (!hr2di_scene_lit(scene, k)) continue;
    if (!rows->closed[k]) status = walk_row(w, k, by_links ? NULL : front, back);
    finish(rows, k, front, back);
    if (!status) status = hr2di_watch_work(w->watch, 1);
  }
  return status;
}

hr2d_status hr2di_row_sums_init(hr2di_row_sums *rows, const hr2di_transport *t, int backs) {
  const hr2d_scene *scene = t->hierarchy->scene;
  *rows = (hr2di_row_sums){.hierarchy = t->hierarchy, .alloc = t->alloc, .watch = t->watch};
  rows->front = hr2di_alloc_zero(&t->alloc, t->elements, sizeof *rows->front);
  rows->back = backs ? hr2di_alloc_zero(&t->alloc, t->elements, sizeof *rows->back) : NULL;
  rows->closed = hr2di_alloc_zero(&t->alloc, scene->patches, 1);
  hr2di_sum *defect = hr2di_alloc(&t->alloc, scene->patches, sizeof *defect);
  hr2di_sum *front = hr2di_alloc_zero(&t->alloc, t->elements, sizeof *front);
  hr2di_sum *back = backs ? hr2di_alloc_zero(&t->alloc, t->elements, sizeof *back) : NULL;
  walker *w = hr2di_alloc_zero(&t->alloc, 1, sizeof *w);
  hr2d_status status = HR2D_ENOMEM;
  if (rows->front && rows->closed && defect && front && w && (!backs || (rows->back && back))) {
    hr2di_visibility visibility;
    hr2di_visibility_init(&visibility, &scene->walls, &t->alloc, t->watch);
    w->h = t->hierarchy;
    w->watch = t->watch;
    w->visibility = scene->effect[HR2D_EFFECT_OCCLUSION].on || backs ? &visibility : NULL;
    status = hr2di_defect_sum(t->links, defect, t->watch);
    if (!status && backs) status = hr2di_backs_init(scene, &w->backs, t->watch);
    if (!status) status = walk_rows(rows, t, w, defect, front, back);
    hr2di_visibility_clear(&visibility);
    hr2di_alloc_free(&t->alloc, w->list.wall);
    hr2di_alloc_free(&t->alloc, w->backs.back);
  }
  hr2di_alloc_free(&t->alloc, w);
  hr2di_alloc_free(&t->alloc, defect);
  hr2di_alloc_free(&t->alloc, front);
  hr2di_alloc_free(&t->alloc, back);
  return status;
}

void hr2di_row_sums_clear(hr2di_row_sums *rows) {
  hr2di_alloc_free(&rows->alloc, rows->front);
  hr2di_alloc_free(&rows->alloc, rows->back);
  hr2di_alloc_free(&rows->alloc, rows->closed);
}
