/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Creates a projector, and proposes the pairs of patches that it begins with. */
#include <math.h>

#include "base/alloc.h"
#include "base/share.h"
#include "base/sized-struct.h"
#include "base/team.h"
#include "refine/occluded-pairs.h"
#include "refine/part-rows.h"
#include "refine/projector.h"
#include "refine/rounds.h"
#include "refine/trace-row.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"

static int directed_by(const hr2d_linkset *links, const hr2d_refine_options *options) {
  return options->ordered || !(links->oracle.flags & HR2D_ORACLE_SYMMETRIC);
}

/* From here on ε = 0, level 0 and the number of threads mean what they say. */
static void set_defaults(hr2d_refine_options *o) {
  if (o->epsilon == HR2D_EPSILON_ZERO)
    o->epsilon = 0;
  else if (o->epsilon == 0)
    o->epsilon = HR2D_DEFAULT_EPSILON;
  if (o->max_level == HR2D_NO_SUBDIVISION)
    o->max_level = 0;
  else if (!o->max_level)
    o->max_level = HR2D_DEFAULT_MAX_LEVEL;
  o->threads = (unsigned)hr2di_team_threads(o->threads);
}

/* Whether an oracle estimates what the kernel without gas changes. */
static int knows_no_gas(const hr2d_oracle *oracle) {
  return oracle->estimate == hr2d_oracle_l1()->estimate ||
         oracle->estimate == hr2d_oracle_l1_grid()->estimate ||
         oracle->estimate == hr2d_oracle_bounds()->estimate;
}

hr2d_status hr2di_projector_check_options(hr2d_linkset *links, const hr2d_refine_options *given,
                                          hr2d_refine_options *options) {
  hr2di_message *message = &links->message;
  *options = (hr2d_refine_options)HR2D_REFINE_OPTIONS_INIT;
  if (hr2di_sized_copy(options, sizeof *options, given))
    return hr2di_message_fail(message, HR2D_EINVAL, "struct_size is not set");
  set_defaults(options);
  if (links->hierarchy->refining)
    return hr2di_message_fail(message, HR2D_ESTATE, "the hierarchy is being refined already");
  if (hr2di_hierarchy_busy(links->hierarchy))
    return hr2di_message_fail(message, HR2D_ESTATE, "the hierarchy is being solved on");
  if (!(options->epsilon >= 0))
    return hr2di_message_fail(message, HR2D_EINVAL, "epsilon %g is not a number ≥ 0",
                              options->epsilon);
  if (links->store.count > 0 && links->directed != directed_by(links, options))
    return hr2di_message_fail(message, HR2D_EINVAL,
                              "the links are %s, and a further refinement cannot change that",
                              links->directed ? "directed" : "not directed");
  const size_t patches = hr2di_scene_cell(links->hierarchy->scene);
  if (!options->row_to) options->row_to = patches;
  if (options->row_from > options->row_to || options->row_to > patches)
    return hr2di_message_fail(message, HR2D_EINVAL, "rows %zu to %zu of %zu patches",
                              options->row_from, options->row_to, patches);
  if (hr2di_share_check(options->share))
    return hr2di_message_fail(message, HR2D_EINVAL,
                              "the share is not valid: its number is not below its count, or "
                              "its struct_size or combine is not set");
  if (links->share && links->share != options->share)
    return hr2di_message_fail(message, HR2D_EINVAL,
                              "the links are those of a share, and are refined further by it");
  if (options->share && hr2di_gas_refuses(links->hierarchy->scene, "shares do not go", message))
    return HR2D_EUNSUPPORTED;
  if (knows_no_gas(&links->oracle) &&
      hr2di_gas_refuses(links->hierarchy->scene,
                        "the oracles l1, l1-grid and bounds estimate no errors", message))
    return HR2D_EUNSUPPORTED;
  if (options->brightness && options->brightness->hierarchy != links->hierarchy)
    return hr2di_message_fail(message, HR2D_EINVAL, "the brightness is from another hierarchy");
  return HR2D_OK;
}

/* Sets the brightness of each element: its B, or its E if there is no solution, relative to the
   brightest element.  Elements younger than the solution get the brightness of their parent. */
static hr2d_status set_brightness(hr2di_projector *p) {
  if (!(p->links->oracle.flags & HR2D_ORACLE_NEEDS_BRIGHTNESS)) return HR2D_OK;
  const hr2d_hierarchy *h = p->hierarchy;
  const hr2d_solution *solution = p->options.brightness;
  hr2d_status status = hr2di_projector_check_budget(p, 2 * h->elements * sizeof *p->brightness);
  if (status) return status;
  if (hr2di_alloc_reserve(&h->alloc, &p->brightness, &p->brightness_capacity, h->elements,
                          sizeof *p->brightness))
    return hr2di_message_fail(&p->links->message, HR2D_ENOMEM, "out of memory for brightness");
  double max = 0;
  for (size_t e = 0; e < h->elements; e++) {
    status = hr2di_projector_work(p, 1 + h->scene->bands / 8);
    if (status) return hr2di_projector_fail(p, status, "");
    const int root = h->parent[e] == e;
    const int solved = solution && e < solution->elements;
    double value = root || solved ? 0 : p->brightness[h->parent[e]];
    for (size_t band = 0; (root || solved) && band < h->scene->bands; band++)
      value = fmax(value, solved ? hr2d_solution_element(solution, (uint32_t)e, band)
                                 : hr2d_scene_emission(h->scene, e, band));
    p->brightness[e] = value;
    max = fmax(max, value);
  }
  for (size_t e = 0; e < h->elements && max > 0; e++) p->brightness[e] /= max;
  return HR2D_OK;
}

static hr2d_status set_rows(hr2di_projector *p) {
  const size_t rows = hr2di_projector_rows(p);
  if (!p->options.row_counts) return HR2D_OK;
  p->bytes += rows * sizeof *p->rows;
  const hr2d_status status = hr2di_projector_check_budget(p, 0);
  if (status) return status;
  p->rows = hr2di_alloc_zero(&p->links->alloc, rows, sizeof *p->rows);
  return p->rows ? HR2D_OK
                 : hr2di_message_fail(&p->links->message, HR2D_ENOMEM,
                                      "out of memory for the counts of rows");
}

void hr2di_projector_add_rows(const hr2di_projector *p, hr2d_row_counts *sum) {
  for (size_t k = 0; p->rows && k < hr2di_projector_rows(p); k++) {
    sum[k].links += p->rows[k].links;
    sum[k].visibility_tests += p->rows[k].visibility_tests;
  }
}

static int has_row(const hr2di_projector *p, size_t patch) {
  if (p->options.rows) return p->options.rows[patch];
  return hr2di_share_has_row(p->options.share, patch, hr2di_scene_cell(p->hierarchy->scene));
}

/* The pairs of the rows that are wanted. */
static double count_roots(const hr2di_projector *p) {
  const double n = (double)p->hierarchy->scene->patches;
  const double from = (double)p->options.row_from, to = (double)p->options.row_to;
  const hr2di_roots *known = &p->links->roots;
  if (p->options.rows || p->options.share) {
    double pairs = 0;
    for (size_t k = p->options.row_from; k < p->options.row_to; k++)
      if (has_row(p, k))
        pairs += known->row    ? (double)(known->row[k + 1] - known->row[k])
                 : p->directed ? n - 1
                               : n - 1 - (double)k;
    return pairs;
  }
  if (known->row)
    return (double)(known->row[p->options.row_to] - known->row[p->options.row_from]);
  return (to - from) * (p->directed ? n - 1 : n - (from + to + 1) / 2);
}

static hr2d_status set_sights(hr2di_projector *p) {
  const hr2d_scene *scene = p->hierarchy->scene;
  p->test_all =
      !scene->effect[HR2D_EFFECT_FACING].called_for && scene->effect[HR2D_EFFECT_FACING].forced;
  if (!scene->effect[HR2D_EFFECT_OCCLUSION].on) return HR2D_OK;
  p->bytes += sizeof *p->visibility +
              2 * scene->plane.triangulation.edges * sizeof *p->visibility->last;
  const hr2d_status status = hr2di_projector_check_budget(p, 0);
  if (status) return status;
  p->visibility = hr2di_alloc_zero(&p->links->alloc, 1, sizeof *p->visibility);
  if (!p->visibility || hr2di_pair_visibility_init(p->visibility, scene, p->how.beam_cache,
                                                   &p->links->alloc, p->watch))
    return hr2di_message_fail(&p->links->message, HR2D_ENOMEM,
                              "out of memory for the refinement");
  return HR2D_OK;
}

hr2d_status hr2di_projector_create(hr2d_linkset *links, const hr2di_refine_how *how,
                                   const hr2d_refine_options *options, hr2di_watch *watch,
                                   hr2di_projector **made) {
  const uint64_t held = sizeof(hr2di_projector) + hr2di_store_bytes(&links->store) +
                        (uint64_t)links->hierarchy->capacity * HR2DI_ELEMENT_BYTES;
  if (options->max_bytes && held > options->max_bytes)
    return hr2di_projector_fail_budget(links, options->max_bytes, 0);
  hr2di_projector *p = hr2di_alloc_zero(&links->alloc, 1, sizeof *p);
  if (!p)
    return hr2di_message_fail(&links->message, HR2D_ENOMEM, "out of memory for the refinement");
  p->links = links;
  p->hierarchy = links->hierarchy;
  p->options = *options;
  p->how = *how;
  p->watch = watch;
  p->budget = options->max_bytes;
  p->occluded.list.alloc = p->found.alloc = p->parts.alloc = links->alloc;
  p->directed = directed_by(links, options);
  p->weighs = p->hierarchy->scene->symmetry.motion != NULL;
  p->check_levels = p->hierarchy->levels > options->max_level;
  p->bytes = sizeof *p + hr2di_store_bytes(&links->store);
  p->roots = count_roots(p);
  hr2d_status status = set_brightness(p);
  if (!status) status = set_rows(p);
  if (!status) status = set_sights(p);
  if (status)
    hr2di_projector_destroy(p);
  else
    *made = p;
  return status;
}

void hr2di_projector_destroy(hr2di_projector *p) {
  const hr2d_allocator *alloc = &p->links->alloc;
  hr2di_alloc_free(alloc, p->facing.pair);
  hr2di_alloc_free(alloc, p->clipped.pair);
  for (int k = 0; k < 2; k++) hr2di_alloc_free(alloc, p->unoccluded[k].pair);
  hr2di_alloc_free(alloc, p->occluded.stack.pair);
  hr2di_alloc_free(alloc, p->occluded.first);
  hr2di_line_class_list_clear(&p->occluded.list);
  hr2di_line_class_list_clear(&p->found);
  hr2di_line_class_list_clear(&p->parts);
  if (p->visibility) hr2di_pair_visibility_clear(p->visibility);
  hr2di_alloc_free(alloc, p->visibility);
  hr2di_alloc_free(alloc, p->brightness);
  hr2di_alloc_free(alloc, p->rows);
  hr2di_alloc_free(alloc, p);
}

/* Pairs of patches collected for the next proposal. */
typedef struct proposals {
  hr2d_pair pair[HR2DI_CANDIDATES];
  size_t count;
} proposals;

static hr2d_status propose_roots(hr2di_projector *p, proposals *roots) {
  size_t count = roots->count;
  roots->count = 0;
  const hr2d_status status = hr2di_projector_claim(p, roots->pair, &count);
  return status ? status : hr2di_occluded_propose_roots(p, roots->pair, count);
}

static hr2d_status add_root(hr2di_projector *p, proposals *roots, size_t patch, size_t k) {
  const hr2d_scene *scene = p->hierarchy->scene;
  p->roots_done++;
  if (hr2di_symmetry_weight(&scene->symmetry, patch, k, p->directed) == 0) return HR2D_OK;
  if (!hr2di_scene_lit(scene, patch) || !hr2di_scene_lit(scene, k)) {
    p->counts.dark_pairs++;
    return HR2D_OK;
  }
  roots->pair[roots->count++] = (hr2d_pair){(uint32_t)patch, (uint32_t)k};
  return roots->count < HR2DI_CANDIDATES ? HR2D_OK : propose_roots(p, roots);
}

/* The pairs of a slot, or of all whole slots. */
static hr2d_status propose_slot(hr2di_projector *p, size_t patch, uint32_t slot) {
  const size_t n = p->hierarchy->scene->patches;
  const hr2di_roots *known = &p->links->roots;
  const size_t from = known->row ? known->row[patch] : p->directed ? 0 : patch + 1;
  const size_t to = known->row ? known->row[patch + 1] : n;
  hr2d_status status = hr2di_projector_fail(p, hr2di_projector_work(p, 1 + n / 16), "");
  proposals roots;
  roots.count = 0;
  for (size_t k = from; k < to && !status; k++) {
    const size_t other = known->row ? known->pair[k].second : k;
    if (other != patch && hr2di_part_rows_want(p, patch, other, slot))
      status = add_root(p, &roots, patch, other);
  }
  return status ? status : propose_roots(p, &roots);
}

/* Slots with several pieces are refined one after the other: the order of their links does not
   depend on other slots. */
static hr2d_status project_pieces(hr2di_projector *p, size_t patch) {
  const hr2di_row_pieces *pieces = p->how.pieces;
  hr2d_status status = hr2di_trace_row(p, patch);
  for (uint32_t k = 0; k < hr2di_row_slots(pieces, patch) && !status; k++) {
    const uint32_t slot = pieces->slot[patch] + k;
    if (!pieces->own[slot] || hr2di_slot_pieces(pieces, slot) == 1) continue;
    hr2di_part_rows_begin(p, slot);
    status = propose_slot(p, patch, slot);
    if (!status) status = hr2di_rounds_run(p, SIZE_MAX);
    hr2di_part_rows_end(p);
  }
  return status;
}

hr2d_status hr2di_projector_row(hr2di_projector *p, size_t patch) {
  if (!has_row(p, patch)) return hr2di_projector_fail(p, hr2di_projector_work(p, 1), "");
  const hr2d_status status = p->how.pieces ? project_pieces(p, patch) : HR2D_OK;
  return status ? status : propose_slot(p, patch, HR2DI_WHOLE_SLOTS);
}

hr2d_status hr2di_projector_all(hr2di_projector *p) {
  hr2d_status status = HR2D_OK;
  for (size_t patch = p->options.row_from; patch < p->options.row_to && !status; patch++) {
    status = hr2di_projector_row(p, patch);
    if (!status) status = hr2di_rounds_run(p, SIZE_MAX);
    hr2di_rounds_measure(p);
  }
  return status;
}
