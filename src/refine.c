/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refinement: what is projected, and where the links go: into the set, to a
   visitor, or nowhere but into a count. */
#include <hr2d/refine.h>
#include <math.h>

#include "alloc.h"
#include "exchange-area.h"
#include "options.h"
#include "project.h"
#include "scene-impl.h"
#include "solution-impl.h"

static hr2d_status check_options(hr2d_linkset *links, const hr2d_refine_options *options,
                                 int directed) {
  hr2di_message *message = &links->message;
  if (!(options->epsilon >= 0))
    return hr2di_fail(message, HR2D_EINVAL, "epsilon %g is not a number ≥ 0", options->epsilon);
  if (links->store.count > 0 && links->directed != directed)
    return hr2di_fail(message, HR2D_EINVAL,
                      "the links are %s, and a further refinement cannot change that",
                      links->directed ? "directed" : "not directed");
  if (options->brightness && options->brightness->hierarchy != links->hierarchy)
    return hr2di_fail(message, HR2D_EINVAL, "the brightness is from another hierarchy");
  const char *reason;
  if (hr2d_scene_effect(links->hierarchy->scene, HR2D_EFFECT_OCCLUSION, &reason))
    return hr2di_fail(message, HR2D_EUNSUPPORTED,
                      "occlusion is not supported by this version: %s", reason);
  return HR2D_OK;
}

/* B of each element relative to the brightest, or E where nothing is solved yet.
   Elements younger than the solution take their parent's. */
static hr2d_status set_brightness(hr2di_projector *p) {
  if (!(p->links->oracle.flags & HR2D_ORACLE_NEEDS_BRIGHTNESS)) return HR2D_OK;
  const hr2d_hierarchy *h = p->hierarchy;
  const hr2d_solution *solution = p->options.brightness;
  hr2d_status status = hr2di_afford(p, h->elements * sizeof *p->brightness);
  if (status) return status;
  if (hr2di_reserve(&h->alloc, &p->brightness, &p->brightness_capacity, h->elements,
                    sizeof *p->brightness))
    return hr2di_fail(&p->links->message, HR2D_ENOMEM, "out of memory for brightness");
  double most = 0;
  for (size_t e = 0; e < h->elements; e++) {
    const int root = h->parent[e] == e;
    const int solved = solution && e < solution->elements;
    double value = root || solved ? 0 : p->brightness[h->parent[e]];
    for (size_t band = 0; (root || solved) && band < h->scene->bands; band++)
      value = fmax(value, solved ? hr2d_solution_element(solution, (uint32_t)e, band)
                                 : hr2d_scene_emission(h->scene, e, band));
    p->brightness[e] = value;
    most = fmax(most, value);
  }
  for (size_t e = 0; e < h->elements && most > 0; e++) p->brightness[e] /= most;
  return HR2D_OK;
}

static hr2d_status start(hr2d_linkset *links, const hr2d_refine_options *options,
                         hr2di_projector **made) {
  hr2di_projector *p = hr2di_calloc(&links->alloc, 1, sizeof *p);
  if (!p) return hr2di_fail(&links->message, HR2D_ENOMEM, "out of memory for the refinement");
  *made = p;
  p->links = links;
  p->hierarchy = links->hierarchy;
  p->options = (hr2d_refine_options)HR2D_REFINE_OPTIONS_INIT;
  if (options) hr2di_copy_sized(&p->options, sizeof p->options, options);
  if (p->hierarchy->refining)
    return hr2di_fail(&links->message, HR2D_ESTATE, "the hierarchy is being refined already");
  const int directed = p->options.ordered || !(links->oracle.flags & HR2D_ORACLE_SYMMETRIC);
  const hr2d_status status = check_options(links, &p->options, directed);
  if (status) return status;
  p->directed = directed;
  p->check_levels = p->hierarchy->levels > p->options.max_level;
  p->bytes = sizeof *p + hr2di_store_bytes(&links->store);
  return set_brightness(p);
}

/* Ends a refinement; on failure the hierarchy gets its former size back. */
static hr2d_status finish(hr2d_linkset *links, hr2di_projector *p, hr2d_status status,
                          size_t elements) {
  if (p) {
    hr2di_free(&links->alloc, p->open.pair);
    hr2di_free(&links->alloc, p->guarded.pair);
    hr2di_free(&links->alloc, p->brightness);
    hr2di_free(&links->alloc, p);
  }
  if (status) hr2di_hierarchy_truncate(links->hierarchy, elements);
  return status;
}

/* Proposes the pairs of patches gathered so far. */
static hr2d_status project_some(hr2di_projector *p, const hr2d_pair *pairs, size_t *count) {
  p->roots_done += (double)*count;
  const hr2d_status status = hr2di_project_roots(p, pairs, *count);
  *count = 0;
  return status;
}

/* Projects all pairs of patches: each once, or in both orders where links are
   directed. */
static hr2d_status project_all(hr2di_projector *p) {
  const size_t n = p->hierarchy->scene->patches;
  p->roots = (double)n * (double)(n - 1) / (p->directed ? 1 : 2);
  hr2d_pair pairs[HR2DI_CANDIDATES];
  size_t count = 0;
  hr2d_status status = HR2D_OK;
  for (size_t i = 0; i < n; i++)
    for (size_t j = p->directed ? 0 : i + 1; j < n && !status; j++) {
      if (i == j) continue;
      pairs[count++] = (hr2d_pair){(uint32_t)i, (uint32_t)j};
      if (count == HR2DI_CANDIDATES) status = project_some(p, pairs, &count);
    }
  return status ? status : project_some(p, pairs, &count);
}

typedef struct storing {
  hr2di_projector *projector;
  hr2di_store *store;
  double area[HR2DI_CANDIDATES];
} storing;

/* The blocks that `count` more links will need are paid for before. */
static hr2d_status afford_links(hr2di_projector *p, const hr2di_store *store, size_t count) {
  const uint64_t room = (uint64_t)store->blocks * HR2DI_BLOCK_LINKS - store->count;
  if (count <= room) return HR2D_OK;
  const uint64_t block = HR2DI_BLOCK_LINKS * sizeof(hr2d_link);
  const hr2d_status status = hr2di_afford(p, block);
  if (!status) p->bytes += block;
  return status;
}

static hr2d_status add_links(storing *s, const hr2d_pair *pairs, const double *area,
                             size_t count) {
  hr2d_linkset *links = s->projector->links;
  hr2d_status status = afford_links(s->projector, s->store, count);
  if (status) return status;
  status = hr2di_store_add(s->store, &links->alloc, pairs, area, count);
  return status ? hr2di_fail(&links->message, status, "out of memory after %llu links",
                             (unsigned long long)s->store->count)
                : HR2D_OK;
}

static hr2d_status store_links(void *ctx, const hr2d_pair *pairs, size_t count) {
  storing *s = ctx;
  s->projector->counts.exchange_areas += count;
  hr2di_exchange_areas(s->projector->hierarchy->element, pairs, count, s->area);
  return add_links(s, pairs, s->area, count);
}

/* Proposes the links of a set again: acceptable ones are kept with their exchange
   areas, the others refused.  What a horizon cuts is found anew below them. */
static hr2d_status project_links(hr2di_projector *p, storing *s, const hr2di_store *old) {
  hr2di_stack *refused =
      p->hierarchy->scene->effect[HR2D_EFFECT_FACING].on ? &p->guarded : &p->open;
  hr2d_pair pairs[HR2DI_BATCH];
  double area[HR2DI_BATCH];
  hr2d_status status = HR2D_OK;
  p->roots = (double)old->count;
  for (uint64_t first = 0; first < old->count && !status; first += HR2DI_BATCH) {
    const uint64_t rest = old->count - first;
    const size_t count = rest < HR2DI_BATCH ? (size_t)rest : HR2DI_BATCH;
    for (size_t k = 0; k < count; k++) pairs[k] = hr2di_store_at(old, first + k)->pair;
    status = hr2di_judge(p, pairs, count);
    size_t kept = 0;
    for (size_t k = 0; k < count && !status; k++) {
      if (!p->flag[k]) {
        status = hr2di_refuse(p, refused, pairs[k]);
        continue;
      }
      area[kept] = hr2di_store_at(old, first + k)->exchange_area;
      pairs[kept++] = pairs[k];
    }
    if (!status) status = hr2di_count_links(p, kept);
    if (!status) status = add_links(s, pairs, area, kept);
    p->roots_done += (double)count;
    if (!status) status = hr2di_drain(p);
  }
  return status;
}

/* What the set holds now, and what all its refinements took. */
static void sum_counts(hr2d_linkset *links, const hr2di_projector *p) {
  const hr2d_hierarchy_counts h = hr2d_hierarchy_count(p->hierarchy);
  hr2d_refine_counts *counts = &links->counts;
  counts->elements = h.elements;
  counts->leaves = h.leaves;
  counts->levels = h.levels;
  counts->links = p->counts.links;
  counts->limited_links = p->counts.limited_links;
  counts->oracle_calls += p->counts.oracle_calls;
  counts->visibility_tests += p->counts.visibility_tests;
  counts->exchange_areas += p->counts.exchange_areas;
}

hr2d_status hr2d_refine(hr2d_linkset *links, const hr2d_refine_options *options) {
  const size_t elements = links->hierarchy->elements;
  hr2di_projector *p = NULL;
  hr2di_store made = {0};
  hr2d_status status = start(links, options, &p);
  if (status) return finish(links, p, status, elements);
  storing *s = hr2di_calloc(&links->alloc, 1, sizeof *s);
  if (!s)
    return finish(links, p, hr2di_fail(&links->message, HR2D_ENOMEM, "out of memory"),
                  elements);
  s->projector = p;
  s->store = &made;
  p->sink = store_links;
  p->sink_ctx = s;
  p->hierarchy->refining = 1;
  status = links->store.count > 0 ? project_links(p, s, &links->store) : project_all(p);
  p->hierarchy->refining = 0;
  hr2di_free(&links->alloc, s);
  if (status) {
    hr2di_store_clear(&made, &links->alloc);
  } else {
    hr2di_store_clear(&links->store, &links->alloc);
    links->store = made;
    links->directed = p->directed;
    sum_counts(links, p);
  }
  return finish(links, p, status, elements);
}

typedef struct visiting {
  hr2di_projector *projector;
  hr2d_visitor visit;
  void *visit_ctx;
  double area[HR2DI_CANDIDATES];
  hr2d_link link[HR2DI_CANDIDATES];
} visiting;

static hr2d_status visit_links(void *ctx, const hr2d_pair *pairs, size_t count) {
  visiting *v = ctx;
  const hr2d_hierarchy *h = v->projector->hierarchy;
  v->projector->counts.exchange_areas += count;
  hr2di_exchange_areas(h->element, pairs, count, v->area);
  const double unit = hr2d_scene_unit(h->scene);
  for (size_t k = 0; k < count; k++) v->link[k] = (hr2d_link){pairs[k], v->area[k] * unit};
  const hr2d_status status = v->visit(v->visit_ctx, v->link, count);
  return status ? hr2di_fail(&v->projector->links->message, status, "visitor: %s",
                             hr2d_strerror(status))
                : HR2D_OK;
}

/* Refines without storing: links go to the sink, if there is one. */
static hr2d_status pass(hr2d_linkset *links, const hr2d_refine_options *options,
                        visiting *visitor, hr2d_refine_counts *counts) {
  const size_t elements = links->hierarchy->elements;
  hr2di_projector *p = NULL;
  if (links->store.count > 0)
    return hr2di_fail(&links->message, HR2D_ESTATE, "the set has links already");
  hr2d_status status = start(links, options, &p);
  if (status) return finish(links, p, status, elements);
  if (visitor) {
    visitor->projector = p;
    p->sink = visit_links;
    p->sink_ctx = visitor;
  }
  p->hierarchy->refining = 1;
  status = project_all(p);
  p->hierarchy->refining = 0;
  if (!status) {
    const hr2d_hierarchy_counts h = hr2d_hierarchy_count(p->hierarchy);
    *counts = p->counts;
    counts->elements = h.elements;
    counts->leaves = h.leaves;
    counts->levels = h.levels;
  }
  return finish(links, p, status, elements);
}

hr2d_status hr2d_refine_count(hr2d_linkset *links, const hr2d_refine_options *options,
                              hr2d_refine_counts *counts) {
  return pass(links, options, NULL, counts);
}

hr2d_status hr2d_refine_visit(hr2d_linkset *links, const hr2d_refine_options *options,
                              hr2d_visitor visit, void *visit_ctx, hr2d_refine_counts *counts) {
  visiting *visitor = hr2di_calloc(&links->alloc, 1, sizeof *visitor);
  if (!visitor) return hr2di_fail(&links->message, HR2D_ENOMEM, "out of memory");
  visitor->visit = visit;
  visitor->visit_ctx = visit_ctx;
  const hr2d_status status = pass(links, options, visitor, counts);
  hr2di_free(&links->alloc, visitor);
  return status;
}
