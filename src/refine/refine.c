/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refinement with links: into the set, or to a visitor. */
#include <hr2d/refine.h>
#include <string.h>

#include "base/alloc.h"
#include "geometry/exchange-area.h"
#include "geometry/predicates.h"
#include "hierarchy/image-trees.h"
#include "hierarchy/pane-trees.h"
#include "refine/occluded-pairs.h"
#include "refine/part-rows.h"
#include "refine/projector.h"
#include "refine/rounds.h"
#include "refine/rows.h"
#include "refine/unite-shares.h"
#include "scene/scene-impl.h"

/* Elements of images, and those on the other sides of panes, are a part of the budgets. */
static hr2d_status unite_trees(hr2di_projector *p) {
  hr2d_hierarchy *h = p->hierarchy;
  const uint64_t upper = p->options.max_elements;
  const uint64_t room = hr2di_projector_left(p) / HR2DI_ELEMENT_BYTES;
  if (!h->scene->symmetry.motion && !h->scene->other_side) return HR2D_OK;
  const size_t max = room < SIZE_MAX - h->capacity ? h->capacity + (size_t)room : SIZE_MAX;
  hr2d_status status = hr2di_image_trees_unite(h, max, p->watch);
  if (!status) status = hr2di_pane_trees_unite(h, max, p->watch);
  if (status == HR2D_EMAX_BYTES)
    return hr2di_projector_fail_budget(p->links, p->budget, p->counts.links);
  if (status == HR2D_EUNSUPPORTED)
    return hr2di_message_fail(&p->links->message, status,
                              "the elements of both sides of a pane are divided at different "
                              "places: divide both alike, or neither");
  if (status) return hr2di_projector_fail(p, status, " for images");
  if (!upper || h->elements <= upper) return HR2D_OK;
  return hr2di_message_fail(
      &p->links->message, HR2D_EMAX_ELEMENTS,
      "more than %llu elements are needed with those of images and panes, for "
      "%llu links",
      (unsigned long long)upper, (unsigned long long)p->counts.links);
}

/* Runs a projector.  On failure the hierarchy gets its former size. */
static hr2d_status run(hr2di_projector *p, hr2di_sink sink, void *sink_ctx,
                       hr2d_status (*project)(hr2di_projector *)) {
  hr2di_watch_describe(p->watch, hr2di_rounds_describe, p);
  hr2d_hierarchy *h = p->hierarchy;
  const size_t elements = h->elements;
  p->sink = sink;
  p->sink_ctx = sink_ctx;
  h->refining = 1;
  hr2d_status status = project(p);
  hr2di_rounds_measure(p);
  if (!status) status = hr2di_projector_fail(p, hr2di_watch_ask(p->watch), "");
  if (!status) status = unite_trees(p);
  h->refining = 0;
  p->counts.visibility_tests += hr2di_part_rows_tests(p);
  p->other_tests += p->part.others;
  if (status) hr2di_hierarchy_truncate(h, elements);
  if (!status && p->rows) {
    memset(p->options.row_counts, 0, hr2di_projector_rows(p) * sizeof *p->rows);
    hr2di_projector_add_rows(p, p->options.row_counts);
  }
  return status;
}

typedef struct storing {
  hr2di_projector *projector;
  hr2di_store *store;
  double area[HR2DI_CANDIDATES];
} storing;

/* Whether the budget has what `count` more links may need.  Slabs become small as it ends. */
static hr2d_status afford_links(hr2di_projector *p, hr2di_store *store, size_t count) {
  if (!p->options.max_bytes) return HR2D_OK;
  store->max_slab = hr2di_projector_left(p) / 8 + 1;
  return hr2di_projector_check_budget(p, hr2di_store_growth(store, count));
}

static hr2d_status add_links(storing *s, const hr2d_pair *pairs, const double *area,
                             size_t count) {
  hr2d_linkset *links = s->projector->links;
  hr2d_status status = afford_links(s->projector, s->store, count);
  if (status) return status;
  s->projector->bytes -= hr2di_store_bytes(s->store);
  status = hr2di_store_add(s->store, &links->alloc, pairs, area, count);
  s->projector->bytes += hr2di_store_bytes(s->store);
  return status ? hr2di_message_fail(&links->message, status, "out of memory after %llu links",
                                     (unsigned long long)s->store->count)
                : HR2D_OK;
}

static hr2d_status store_links(void *ctx, const hr2d_pair *pairs, const double *area,
                               size_t count) {
  storing *s = ctx;
  if (area) return add_links(s, pairs, area, count);
  s->projector->counts.exchange_areas += count;
  const hr2d_status status = hr2di_projector_work(s->projector, count);
  if (status) return hr2di_projector_fail(s->projector, status, "");
  hr2di_exchange_areas(s->projector->hierarchy->element, pairs, count, s->area);
  hr2di_projector_weigh(s->projector, pairs, count, s->area);
  return add_links(s, pairs, s->area, count);
}

/* Whether the elements of a pair, or ancestors of these, face each other fully.  Then so do all
   pairs below, whatever rounding does to their elements, and they are not tested again. */
static int faces_fully(const hr2d_hierarchy *h, hr2d_pair pair, hr2di_watch *watch) {
  for (uint32_t i = pair.first, above_i;; i = above_i) {
    above_i = h->parent[i];
    for (uint32_t j = pair.second, above_j;; j = above_j) {
      above_j = h->parent[j];
      const hr2d_element *e = &h->element[i], *f = &h->element[j];
      if (hr2di_watch_work(watch, 1)) return 0;
      if (hr2di_facing_of(&(hr2d_segment){e->a, e->b}, &(hr2d_segment){f->a, f->b}) ==
          HR2DI_FACING_FULL)
        return 1;
      if (above_j == j) break;
    }
    if (above_i == i) return 0;
  }
}

/* Sets partial[k] for links with walls in the way, and p->partial if there are any. */
static hr2d_status visit_again(hr2di_projector *p, const hr2d_pair *pairs, size_t count,
                               unsigned char *partial) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status; k++) {
    hr2di_visibility_class view;
    hr2di_line_class_list_cut(&p->found, 0);
    status = hr2di_occluded_collect(p, pairs[k], &view);
    partial[k] = view != HR2DI_CLEAR;
    if (partial[k]) p->partial = partial;
  }
  return status;
}

static hr2d_status refuse_link(hr2di_projector *p, hr2d_pair pair, int partial) {
  if (partial) return hr2di_occluded_push(p, pair);
  const int clipped = p->hierarchy->scene->effect[HR2D_EFFECT_FACING].on;
  const int open = !p->test_all && (!clipped || faces_fully(p->hierarchy, pair, p->watch));
  return hr2di_projector_push(p, open ? &p->facing : &p->clipped, pair);
}

/* Proposes the links of a set again: acceptable ones are kept with their exchange
   areas, the others refused. */
static hr2d_status project_links(hr2di_projector *p) {
  storing *s = p->sink_ctx;
  const hr2di_store *old = &p->links->store;
  hr2d_pair pairs[HR2DI_BATCH];
  unsigned char partial[HR2DI_BATCH] = {0};
  double area[HR2DI_BATCH];
  hr2d_status status = HR2D_OK;
  p->roots = (double)old->count;
  for (uint64_t first = 0; first < old->count && !status; first += HR2DI_BATCH) {
    const uint64_t rest = old->count - first;
    const size_t count = rest < HR2DI_BATCH ? (size_t)rest : HR2DI_BATCH;
    for (size_t k = 0; k < count; k++) pairs[k] = hr2di_store_at(old, first + k)->pair;
    if (p->visibility) status = visit_again(p, pairs, count, partial);
    if (!status) status = hr2di_projector_estimate(p, pairs, count);
    p->partial = NULL;
    size_t kept = 0;
    for (size_t k = 0; k < count && !status; k++) {
      if (!p->flag[k]) {
        status = refuse_link(p, pairs[k], partial[k]);
        continue;
      }
      p->counts.partial_links += partial[k];
      hr2di_projector_in_row(p, p->hierarchy->element[pairs[k].first].patch,
                             p->hierarchy->element[pairs[k].second].patch, 1, 0);
      area[kept] = hr2di_store_at(old, first + k)->exchange_area;
      pairs[kept++] = pairs[k];
    }
    if (!status) status = hr2di_projector_count_links(p, kept);
    if (!status) status = add_links(s, pairs, area, kept);
    p->roots_done += (double)count;
    if (!status) status = hr2di_rounds_run(p, SIZE_MAX);
  }
  return status;
}

/* Sets the counts: elements and links as the set has them now, and the work of all its
   refinements. */
static void sum_counts(hr2d_linkset *links, const hr2di_projector *p) {
  hr2d_refine_counts *counts = &links->counts;
  hr2di_projector_count_elements(p->hierarchy, counts);
  counts->links = p->counts.links;
  counts->limited_links = p->counts.limited_links;
  counts->oracle_calls += p->counts.oracle_calls;
  counts->facing_tests += p->counts.facing_tests;
  counts->visibility_tests += p->counts.visibility_tests;
  counts->exchange_areas += p->counts.exchange_areas;
  counts->partial_links = p->counts.partial_links;
  counts->blocked_pairs += p->counts.blocked_pairs;
  counts->dark_pairs += p->counts.dark_pairs;
}

/* A share that has found no links in its rows begins again with none. */
static int has_links(const hr2d_linkset *links) {
  return links->store.count > 0 || (links->share && links->counts.elements > 0);
}

/* What all shares have made together: elements, and counts. */
static hr2d_status unite(hr2di_projector *p, size_t elements, hr2di_store *made,
                         hr2d_status status) {
  hr2d_hierarchy *h = p->hierarchy;
  hr2d_share *share = p->options.share;
  const uint64_t upper = p->options.max_elements;
  h->refining = 1;
  status = hr2di_unite_shares(h, share, elements, made, p->watch, status);
  h->refining = 0;
  if (!status && upper && h->elements > upper)
    status =
        hr2di_message_fail(&p->links->message, HR2D_EMAX_ELEMENTS,
                           "more than %llu elements are needed", (unsigned long long)upper);
  status = hr2di_unite_counts(&p->counts, share, status);
  if (status && h->elements > elements) hr2di_hierarchy_truncate(h, elements);
  if (status && !p->links->message.text[0])
    hr2di_message_fail(&p->links->message, status, "another share: %s", hr2d_strerror(status));
  return status;
}

static hr2d_status refine(hr2d_linkset *links, const hr2di_refine_how *how,
                          const hr2d_refine_options *options) {
  const hr2d_refine_options used = *options;
  const size_t elements = links->hierarchy->elements;
  hr2di_projector *p = NULL;
  hr2di_watch watch;
  hr2di_store made = {.packs = used.packed != 0};
  hr2di_scene_watch(links->hierarchy->scene, &watch, used.progress, used.progress_ctx,
                    "refine");
  hr2d_status status = hr2di_projector_create(links, how, &used, &watch, &p);
  if (status) return status;
  p->bytes += sizeof(storing);
  status = hr2di_projector_check_budget(p, 0);
  storing *s = status ? NULL : hr2di_alloc_zero(&links->alloc, 1, sizeof *s);
  if (s) {
    s->projector = p;
    s->store = &made;
    status = run(p, store_links, s,
                 has_links(links)            ? project_links
                 : hr2di_rows_threads(p) > 1 ? hr2di_rows_project
                                             : hr2di_projector_all);
  } else if (!status) {
    status =
        hr2di_message_fail(&links->message, HR2D_ENOMEM, "out of memory for the refinement");
  }
  const uint64_t own_tests = p->counts.visibility_tests + p->other_tests;
  if (used.share) status = unite(p, elements, &made, status);
  if (status) {
    hr2di_store_clear(&made, &links->alloc);
  } else {
    hr2di_store_clear(&links->store, &links->alloc);
    hr2di_linkset_clear_blocks(links);
    links->store = made;
    links->directed = p->directed;
    links->epsilon = used.epsilon;
    links->share = used.share;
    sum_counts(links, p);
    links->own_tests += own_tests;
  }
  hr2di_alloc_free(&links->alloc, s);
  hr2di_projector_destroy(p);
  return status;
}

hr2d_status hr2di_refine(hr2d_linkset *links, const hr2di_refine_how *how,
                         const hr2d_refine_options *given) {
  hr2d_refine_options options;
  const hr2d_status status = hr2di_projector_check_options(links, given, &options);
  if (status) return status;
  hr2di_share_begin(options.share);
  if (options.share) links->message.text[0] = 0;
  return hr2di_share_agree(options.share, refine(links, how, &options));
}

hr2d_status hr2d_refine(hr2d_linkset *links, const hr2d_refine_options *options) {
  return links ? hr2di_refine(links, &(hr2di_refine_how){0}, options) : HR2D_EINVAL;
}

typedef struct visiting {
  hr2di_projector *projector;
  hr2d_visitor visit;
  void *visit_ctx;
  double area[HR2DI_CANDIDATES];
  hr2d_link link[HR2DI_CANDIDATES];
} visiting;

static hr2d_status visit_links(void *ctx, const hr2d_pair *pairs, const double *area,
                               size_t count) {
  visiting *v = ctx;
  const hr2d_hierarchy *h = v->projector->hierarchy;
  if (!area) {
    v->projector->counts.exchange_areas += count;
    const hr2d_status status = hr2di_projector_work(v->projector, count);
    if (status) return hr2di_projector_fail(v->projector, status, "");
    hr2di_exchange_areas(h->element, pairs, count, v->area);
    hr2di_projector_weigh(v->projector, pairs, count, v->area);
    area = v->area;
  }
  const double unit = hr2d_scene_unit(h->scene);
  for (size_t k = 0; k < count; k++) v->link[k] = (hr2d_link){pairs[k], area[k] * unit};
  const hr2d_status status = v->visit(v->visit_ctx, v->link, count);
  return status ? hr2di_message_fail(&v->projector->links->message, status, "visitor: %s",
                                     hr2d_strerror(status))
                : HR2D_OK;
}

hr2d_status hr2d_refine_visit(hr2d_linkset *links, const hr2d_refine_options *options,
                              hr2d_visitor visit, void *visit_ctx, hr2d_refine_counts *counts) {
  if (!links || !visit || !counts) return HR2D_EINVAL;
  hr2d_refine_options used;
  hr2di_projector *p = NULL;
  if (links->store.count > 0)
    return hr2di_message_fail(&links->message, HR2D_ESTATE, "the set has links already");
  hr2di_watch watch;
  hr2d_status status = hr2di_projector_check_options(links, options, &used);
  hr2di_scene_watch(links->hierarchy->scene, &watch, used.progress, used.progress_ctx,
                    "refine");
  if (!status)
    status = hr2di_projector_create(links, &(hr2di_refine_how){0}, &used, &watch, &p);
  if (status) return status;
  p->bytes += sizeof(visiting);
  status = hr2di_projector_check_budget(p, 0);
  visiting *v = status ? NULL : hr2di_alloc_zero(&links->alloc, 1, sizeof *v);
  if (v) {
    v->projector = p;
    v->visit = visit;
    v->visit_ctx = visit_ctx;
    status = run(p, visit_links, v, hr2di_projector_all);
  } else if (!status) {
    status =
        hr2di_message_fail(&links->message, HR2D_ENOMEM, "out of memory for the refinement");
  }
  if (!status) {
    *counts = p->counts;
    hr2di_projector_count_elements(p->hierarchy, counts);
  }
  hr2di_alloc_free(&links->alloc, v);
  hr2di_projector_destroy(p);
  return status;
}
