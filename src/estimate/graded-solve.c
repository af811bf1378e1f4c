/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a resolution to trees, links and a solution. */
#include "estimate/graded-solve.h"

#include "base/alloc.h"
#include "base/choices.h"
#include "base/clock.h"
#include "estimate/estimator.h"
#include "estimate/resolution.h"
#include "hierarchy/image-trees.h"
#include "hierarchy/pane-trees.h"
#include "links/linkset-impl.h"
#include "mesh/admissibility.h"
#include "mesh/refine-marked.h"
#include "mesh/reuse-links.h"
#include "mesh/row-partition.h"
#include "refine/refine-how.h"
#include "scene/regions.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/solve-how.h"

/* Finds the events of `generations` generations, or of as many as HR2DI_CHOICE_EVENTS has room
 * for. */
static hr2d_status find_events(hr2di_events *events, const hr2d_hierarchy *h,
                               unsigned generations, hr2d_share *share, hr2di_watch *watch) {
  for (;; generations--) {
    const hr2d_status status = hr2di_events_init(events, h->scene, &h->alloc, generations,
                                                 HR2DI_CHOICE_EVENTS, share, watch);
    if (status != HR2D_EMAX_ELEMENTS) return status;
    hr2di_events_clear(events);
    *events = (hr2di_events){0};
    if (generations == 0) return HR2D_OK;
  }
}

/* Elements of images get the kinks of the elements that they are images of; those of panes have
   none. */
static hr2d_status carry_kinks(hr2di_graded *a, size_t elements, hr2di_watch *watch) {
  const hr2d_hierarchy *h = a->hierarchy;
  const size_t bands = h->scene->bands;
  if (!a->unresolved_jump || (!h->scene->symmetry.motion && h->elements == elements))
    return HR2D_OK;
  double *bent = hr2di_alloc_zero(&h->alloc, h->elements, bands * sizeof *bent);
  uint32_t *of = hr2di_alloc(&h->alloc, h->elements, sizeof *of);
  hr2d_status status = bent && of ? hr2di_image_trees_map(h, of, watch) : HR2D_ENOMEM;
  for (size_t k = 0; k < h->elements && !status; k++)
    for (size_t b = 0; b < bands && of[k] < elements; b++)
      bent[k * bands + b] = a->unresolved_jump[of[k] * bands + b];
  hr2di_alloc_free(&h->alloc, of);
  hr2di_alloc_free(&h->alloc, status ? bent : a->unresolved_jump);
  if (!status) a->unresolved_jump = bent;
  return status;
}

/* Divides both sides of panes alike, and images as their patches are. */
static hr2d_status divide_images(hr2di_graded *a, hr2di_watch *watch) {
  const size_t elements = a->hierarchy->elements;
  hr2d_status status = hr2di_pane_trees_unite(a->hierarchy, SIZE_MAX, watch);
  if (!status) status = hr2di_image_trees_unite(a->hierarchy, SIZE_MAX, watch);
  return status ? status : carry_kinks(a, elements, watch);
}

/* Events on panes are not chosen: elements of both sides end at all of them. */
static hr2d_status find_on_panes(const hr2di_events *events, const hr2d_scene *scene,
                                 hr2di_events *on_panes) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < events->count && scene->other_side && !status; k++) {
    if (hr2di_scene_other_side(scene, events->event[k].patch) == events->event[k].patch)
      continue;
    if (hr2di_alloc_reserve(&on_panes->alloc, &on_panes->event, &on_panes->capacity,
                            on_panes->count + 1, sizeof *on_panes->event))
      status = HR2D_ENOMEM;
    else
      on_panes->event[on_panes->count++] = events->event[k];
  }
  return status;
}

/* Divides the elements. */
static hr2d_status grade(hr2di_graded *a, const hr2di_resolution *fineness,
                         const hr2d_target *target) {
  hr2d_hierarchy *h = a->hierarchy;
  hr2di_events events = {.alloc = h->alloc}, on_panes = {.alloc = h->alloc};
  hr2di_watch watch;
  hr2di_scene_watch(h->scene, &watch, target->progress, target->progress_ctx, "refine");
  hr2d_status status = find_events(&events, h, fineness->generations, target->share, &watch);
  const int chosen = fineness->kinks > 0 && fineness->lights && events.count > 0;
  const hr2di_grading grading = {.target = fineness->target,
                                 .beam_cache = fineness->beam_cache,
                                 .norm = fineness->norm,
                                 .order = fineness->order,
                                 .corner_levels = fineness->corner_levels,
                                 .no_corner_grading = fineness->no_corner_grading,
                                 .distance = fineness->distance,
                                 .events = chosen ? &on_panes : &events,
                                 .max_elements = target->max_elements,
                                 .watch = &watch,
                                 .threads = target->threads};
  if (!status && chosen) status = find_on_panes(&events, h->scene, &on_panes);
  if (!status) status = hr2di_grading_apply(h, &grading, &a->survey);
  if (!status) status = hr2di_pane_trees_unite(h, SIZE_MAX, &watch);
  if (!status && chosen)
    status =
        hr2di_events_select(h, &events, fineness->lights, fineness->kinks, target->max_elements,
                            target->threads, &watch, &a->unresolved_jump);
  a->jump_bands = h->scene->bands;
  if (!status) status = divide_images(a, &watch);
  a->events = events.count;
  hr2di_events_clear(&events);
  hr2di_events_clear(&on_panes);
  return status;
}

/* The pairs that a refinement begins with.  Without clusters they depend on the scene alone. */
static hr2d_status find_roots(hr2d_linkset *links, const hr2di_graded *coarse,
                              const hr2di_resolution *fineness, const hr2d_target *target) {
  const hr2d_scene *scene = links->hierarchy->scene;
  hr2di_watch watch;
  if (scene->patches < HR2DI_CHOICE_CLUSTERS_PATCHES || hr2di_scene_regions(scene))
    return HR2D_OK;
  hr2di_scene_watch(scene, &watch, target->progress, target->progress_ctx, "refine");
  return coarse && !coarse->links->roots.clusters
             ? hr2di_roots_copy(&links->roots, &coarse->links->roots, scene->patches,
                                &links->alloc, &watch)
             : hr2di_roots_init(&links->roots, scene, &links->alloc, fineness->cluster_accuracy,
                                target->threads, &watch);
}

/* Makes the links.  Takes over those of unchanged elements from `coarse`, unless it is NULL.
 */
static hr2d_status link_elements(hr2di_graded *a, const hr2di_graded *coarse,
                                 const hr2di_resolution *fineness, const hr2d_target *target) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 0.5; /* the oracle says 0 or 1 */
  options.max_level = UINT32_MAX;
  options.threads = target->threads;
  options.max_links = target->max_links;
  options.max_bytes = target->max_bytes;
  options.progress = target->progress;
  options.progress_ctx = target->progress_ctx;
  options.share = target->share;
  hr2d_status status =
      hr2d_linkset_create(a->hierarchy, hr2di_admissibility_oracle(), a->hierarchy,
                          hr2di_admissibility_fixed_leaves(), NULL, &a->links);
  if (status) return status;
  status = find_roots(a->links, coarse, fineness, target);
  if (!status && options.share && !a->pieces.rows)
    status = hr2di_row_partition(&a->pieces, a->links, fineness->beam_cache, &options);
  options.rows = a->pieces.rows;
  const hr2di_refine_how how = {.pieces = options.share ? &a->pieces : NULL,
                                .beam_cache = fineness->beam_cache};
  if (!status)
    status = coarse ? hr2di_reuse_links(a->links, coarse->links, &how, &options)
                    : hr2di_refine(a->links, &how, &options);
  return status;
}

uint64_t hr2di_graded_block_bytes(const hr2di_resolution *fineness, int no_error) {
  const uint64_t order = fineness->order, finer = hr2di_resolution_finer(fineness).order;
  const uint64_t part = hr2di_estimator_part_order(finer);
  const uint64_t account = finer * finer + (part < order ? part * part : 0);
  return (no_error ? order * order : account) * hr2di_number_size(fineness->single) + 1;
}

/* Fields of leaves that are held at once by a solve, and by a solve and its account: in rooms
   of up to 256 bands 12.9 and 18.9 were measured; an outside and a period that is cut off add
   one each. */
enum { SOLVE_FIELDS = 15, ACCOUNT_FIELDS = 21 };

/* A double, as bands times coefficients may overflow an integer. */
static double field_bytes(const hr2di_graded *a, const hr2di_resolution *fineness,
                          int no_error) {
  const hr2d_hierarchy_counts counts = hr2d_hierarchy_count(a->hierarchy);
  const unsigned order = no_error ? fineness->order : hr2di_resolution_finer(fineness).order;
  const double gathers = 1.0 + (double)hr2di_transport_slices(a->links, order);
  /* An account has a second operator, for the part of its equation. */
  const double fields = (no_error ? 1 : 2) * gathers * (double)counts.elements +
                        (no_error ? SOLVE_FIELDS : ACCOUNT_FIELDS) * (double)counts.leaves;
  return fields * order * (double)a->hierarchy->scene->bands * sizeof(double);
}

static hr2d_status check_bytes(const hr2di_graded *a, const hr2di_resolution *fineness,
                               const hr2d_target *target) {
  const uint64_t max = target->max_bytes;
  if (!max) return HR2D_OK;
  const double held = (double)hr2di_graded_bytes(a);
  const unsigned order =
      target->no_error ? fineness->order : hr2di_resolution_finer(fineness).order;
  const size_t lost = hr2di_link_blocks_gas_bytes(a->hierarchy->scene, order);
  const double blocks = (double)hr2d_linkset_size(a->links) * (double)a->links->groups *
                        (double)(hr2di_graded_block_bytes(fineness, target->no_error) + lost);
  const double fields = field_bytes(a, fineness, target->no_error);
  if (held + blocks + fields <= (double)max) return HR2D_OK;
  return hr2di_message_fail(&a->links->message, HR2D_EMAX_BYTES,
                            "of %llu bytes %.3g are needed for elements and links, %.3g for "
                            "blocks, %.3g for fields of %zu bands",
                            (unsigned long long)max, held, blocks, fields,
                            a->hierarchy->scene->bands);
}

/* The patches alone may be too many; grading checks the limit only when it divides. */
static hr2d_status check_elements(const hr2di_graded *a, const hr2d_target *target) {
  const uint64_t max = target->max_elements;
  return max && a->hierarchy->elements > max ? HR2D_EMAX_ELEMENTS : HR2D_OK;
}

static hr2d_status explain(const hr2di_graded *a, hr2d_status status, hr2di_message *message) {
  if (!status) return status;
  const char *own = a->links ? hr2d_linkset_message(a->links) : "";
  return hr2di_message_fail(message, status, "%s", own[0] ? own : hr2d_strerror(status));
}

hr2d_status hr2di_graded_refine(hr2di_graded *a, const hr2d_scene *scene,
                                const hr2di_resolution *fineness, const hr2d_target *target,
                                hr2di_message *message) {
  const double start = hr2di_clock_now();
  *a = (hr2di_graded){0};
  hr2d_status status = hr2d_hierarchy_create(scene, &a->hierarchy);
  if (!status) a->hierarchy->order = fineness->order;
  if (!status) status = grade(a, fineness, target);
  if (!status) status = check_elements(a, target);
  if (!status) status = link_elements(a, NULL, fineness, target);
  if (!status) status = check_bytes(a, fineness, target);
  a->refine_seconds = hr2di_clock_now() - start;
  return explain(a, hr2di_share_agree(target->share, status), message);
}

static hr2d_status find_uneven(const hr2di_graded *a, hr2d_share *share, int *uneven) {
  const double own = (double)a->links->store.count;
  double max = own, all = own;
  hr2d_status status = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_MOST, &max, 1);
  if (!status) status = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_SUM, &all, 1);
  *uneven = share && max * share->count > HR2DI_CHOICE_UNEVEN * all;
  return status;
}

/* At the same order a share keeps its rows, and links keep their blocks.  But if a few shares
   then have too many of the links, rows are dealt out anew and all links are made again. */
static hr2d_status link_divided(hr2di_graded *a, const hr2di_graded *coarse,
                                const hr2di_resolution *fineness, const hr2d_target *target) {
  const hr2d_allocator *alloc = &a->hierarchy->alloc;
  hr2d_status status = HR2D_OK;
  int uneven = 0;
  if (fineness->order != coarse->hierarchy->order)
    return link_elements(a, NULL, fineness, target);
  if (coarse->pieces.rows)
    status = hr2di_row_pieces_copy(&a->pieces, &coarse->pieces,
                                   hr2di_scene_cell(a->hierarchy->scene), alloc);
  if (!status) status = link_elements(a, coarse, fineness, target);
  if (!status) status = find_uneven(a, target->share, &uneven);
  if (status || !uneven) return status;
  const hr2d_refine_counts counts = a->links->counts;
  hr2di_row_pieces_clear(&a->pieces, alloc);
  hr2d_linkset_destroy(a->links);
  a->links = NULL;
  status = link_elements(a, NULL, fineness, target);
  if (!status) a->links->counts = counts; /* no count depends on the number of shares */
  return status;
}

hr2d_status hr2di_graded_divide(hr2di_graded *a, const hr2di_graded *coarse,
                                const hr2di_resolution *fineness, const hr2d_target *target,
                                hr2di_message *message) {
  const double start = hr2di_clock_now();
  hr2di_watch watch;
  *a = (hr2di_graded){.survey = coarse->survey, .events = coarse->events};
  hr2di_scene_watch(coarse->hierarchy->scene, &watch, target->progress, target->progress_ctx,
                    "refine");
  hr2d_status status = hr2di_refine_marked(coarse->hierarchy, coarse->depth,
                                           target->max_elements, &watch, &a->hierarchy);
  if (!status) a->hierarchy->order = fineness->order;
  if (!status) status = divide_images(a, &watch);
  if (!status) status = link_divided(a, coarse, fineness, target);
  if (!status) status = check_bytes(a, fineness, target);
  if (!status && fineness->order == coarse->hierarchy->order) a->start = coarse->solution;
  a->refine_seconds = hr2di_clock_now() - start;
  return explain(a, hr2di_share_agree(target->share, status), message);
}

hr2d_status hr2di_graded_solve(hr2di_graded *a, const hr2di_resolution *fineness,
                               const hr2d_target *target, hr2di_message *message) {
  const double start = hr2di_clock_now();
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.tolerance = fineness->tolerance;
  options.threads = target->threads;
  options.progress = target->progress;
  options.progress_ctx = target->progress_ctx;
  const hr2di_equation_how how = {
      .block_order = target->no_error ? 0 : hr2di_resolution_finer(fineness).order,
      .single = fineness->single,
      .beam_cache = fineness->beam_cache,
      .enough = {.part = fineness->relative, .floor = fineness->floor},
      .start = a->start};
  const hr2d_status status = hr2di_solve(a->links, &how, &options, &a->solution);
  a->start = NULL;
  if (status) return explain(a, status, message);
  const hr2d_solve_work work = hr2d_solution_work(a->solution);
  a->kernels = work.kernels;
  a->coefficients_seconds = work.coefficients_seconds;
  a->solve_seconds = hr2di_clock_now() - start - work.coefficients_seconds;
  return HR2D_OK;
}

void hr2di_graded_clear(hr2di_graded *a) {
  if (a->hierarchy) hr2di_alloc_free(&a->hierarchy->alloc, a->unresolved_jump);
  if (a->hierarchy) hr2di_alloc_free(&a->hierarchy->alloc, a->depth);
  if (a->hierarchy) hr2di_row_pieces_clear(&a->pieces, &a->hierarchy->alloc);
  hr2d_solution_destroy(a->solution);
  hr2d_linkset_destroy(a->links);
  hr2d_hierarchy_destroy(a->hierarchy);
  *a = (hr2di_graded){0};
}

uint64_t hr2di_graded_bytes(const hr2di_graded *a) {
  return (uint64_t)a->hierarchy->capacity * HR2DI_ELEMENT_BYTES + hr2d_linkset_bytes(a->links);
}

uint64_t hr2di_graded_solution_bytes(const hr2di_graded *a) {
  const hr2d_solution *s = a->solution;
  return s ? 2 * (uint64_t)s->elements * s->order * s->bands * sizeof(double) : 0;
}
