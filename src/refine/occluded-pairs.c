/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Occluded pairs: each carries the line classes between walls of which it sees a part.  A child
   pair takes its part from them, too, and not from its parent's: so no bit depends on the way
   to it.

   A pair that nothing bounds but its own elements is unoccluded, and no pair below it is tested
   again.  A pair without line classes is dropped. */
#include "refine/occluded-pairs.h"

#include "base/alloc.h"
#include "geometry/exchange-area.h"
#include "geometry/predicates.h"
#include "scene/scene-impl.h"

static hr2d_status fail(hr2di_projector *p, hr2d_status status) {
  if (status == HR2D_EMAX_BYTES)
    return hr2di_projector_fail_budget(p->links, p->budget, p->counts.links);
  return hr2di_projector_fail(p, status, " for what elements see");
}

/* Shares out what is left of the budget before lists may grow: a part for each of the five
   lists, and the rest for what is beside them. */
static void set_limits(hr2di_projector *p) {
  enum { PARTS = 8 };
  hr2di_line_class_list *const list[] = {&p->visibility->all, &p->visibility->turned, &p->found,
                                         &p->parts, &p->occluded.list};
  const uint64_t left = hr2di_projector_left(p);
  if (left == UINT64_MAX) return;
  for (size_t k = 0; k < sizeof list / sizeof *list; k++)
    list[k]->max_bytes = hr2di_line_class_list_bytes(list[k]) + left / PARTS + 1;
}

/* The patch with the lower number comes first, so that both directions get the same
   bits. */
static hr2di_patch_pair parts_of(const hr2d_hierarchy *h, hr2d_pair pair) {
  const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
  return (hr2di_patch_pair){{i->patch, j->patch}, {{i->a, i->b}, {j->a, j->b}}};
}

static int swapped(const hr2di_patch_pair *parts) {
  return parts->patch[0] > parts->patch[1];
}

static hr2di_facing facing_of(const hr2di_patch_pair *parts) {
  const int swap = swapped(parts);
  return hr2di_facing_of(&parts->part[swap], &parts->part[!swap]);
}

/* By the line classes from number `from` on. */
static hr2di_visibility_class classify(const hr2di_line_class_list *list, size_t from,
                                       const hr2di_patch_pair *parts) {
  const int swap = swapped(parts);
  return hr2di_line_classes_classify(list, from, parts->part[swap], parts->part[!swap]);
}

hr2d_status hr2di_occluded_trace(hr2di_projector *p, uint32_t from, uint32_t to) {
  set_limits(p);
  return fail(p, hr2di_pair_visibility_look(p->visibility, from, to));
}

hr2d_status hr2di_occluded_collect(hr2di_projector *p, hr2d_pair pair,
                                   hr2di_visibility_class *view) {
  const hr2di_patch_pair parts = parts_of(p->hierarchy, pair);
  *view = HR2DI_CLEAR;
  if (facing_of(&parts) == HR2DI_FACING_NONE) return HR2D_OK;
  hr2di_line_class_list_cut(&p->parts, 0);
  set_limits(p);
  const uint64_t before = hr2di_pair_visibility_tests(p->visibility);
  const hr2d_status status =
      hr2di_pair_visibility_between(p->visibility, &parts, &p->parts, &p->found);
  hr2di_projector_in_row(p, parts.patch[0], parts.patch[1], 0,
                         hr2di_pair_visibility_tests(p->visibility) - before);
  if (!status) *view = classify(&p->parts, 0, &parts);
  return fail(p, status);
}

/* Puts a pair on the stack with line classes [first, last) of a list. */
static hr2d_status push(hr2di_projector *p, hr2d_pair pair, const hr2di_line_class_list *list,
                        size_t first, size_t last) {
  hr2di_occluded_pairs *s = &p->occluded;
  const size_t pairs = s->stack.count + 1;
  hr2d_status status = hr2di_projector_check_budget(
      p, pairs > s->first_capacity ? 2 * pairs * sizeof *s->first : 0);
  if (!status) status = hr2di_projector_push(p, &s->stack, pair);
  if (status) return status;
  if (hr2di_alloc_reserve(&p->links->alloc, &s->first, &s->first_capacity, s->stack.count,
                          sizeof *s->first))
    return fail(p, HR2D_ENOMEM);
  s->first[s->stack.count - 1] = s->list.count;
  set_limits(p);
  return fail(p, hr2di_line_class_list_copy(&s->list, list, first, last));
}

/* Links an accepted pair, which sees parts [first, last) of p->parts. */
static hr2d_status link_pair(hr2di_projector *p, hr2d_pair pair, size_t first, size_t last) {
  const hr2d_status status = hr2di_projector_work(p, 1 + (last - first));
  if (status) return fail(p, status);
  double area = p->sink ? hr2di_line_class_list_area(&p->parts, first, last) : 0;
  hr2di_projector_weigh(p, &pair, 1, &area);
  p->counts.partial_links++;
  p->counts.exchange_areas += p->sink != NULL;
  p->accepted[0] = pair;
  return hr2di_projector_accept(p, &area, 1);
}

/* A pair to be proposed, with its line classes in p->found, and what it sees of them in
 * p->parts. */
typedef struct candidate {
  hr2d_pair pair;
  size_t first, last, first_part, last_part;
} candidate;

enum { CHILD_PAIRS = 4 };

static hr2d_status propose(hr2di_projector *p, const candidate *c, size_t count) {
  static const unsigned char partial[CHILD_PAIRS] = {1, 1, 1, 1};
  hr2d_pair pairs[CHILD_PAIRS] = {{0}};
  unsigned char accepted[CHILD_PAIRS] = {0};
  if (count == 0) return HR2D_OK;
  for (size_t k = 0; k < count; k++) pairs[k] = c[k].pair;
  p->partial = partial;
  hr2d_status status = hr2di_projector_estimate(p, pairs, count);
  p->partial = NULL;
  for (size_t k = 0; k < count && !status; k++) accepted[k] = p->flag[k];
  for (size_t k = 0; k < count && !status; k++)
    status = accepted[k] ? link_pair(p, c[k].pair, c[k].first_part, c[k].last_part)
                         : push(p, c[k].pair, &p->found, c[k].first, c[k].last);
  return status;
}

/* Puts a clear pair on a stack of unoccluded pairs, drops a blocked pair, and adds a partly
   visible one to the candidates. */
static hr2d_status sort_out(hr2di_projector *p, const candidate *seen,
                            hr2di_visibility_class view, hr2di_facing facing, candidate *c,
                            size_t *count) {
  p->counts.blocked_pairs += view == HR2DI_BLOCKED;
  if (view == HR2DI_CLEAR)
    return hr2di_projector_push(p, &p->unoccluded[facing == HR2DI_FACING_PART || p->test_all],
                                seen->pair);
  if (view == HR2DI_PARTIAL) c[(*count)++] = *seen;
  return HR2D_OK;
}

hr2d_status hr2di_occluded_propose_roots(hr2di_projector *p, const hr2d_pair *pairs,
                                         size_t count) {
  if (!p->visibility) return hr2di_projector_propose_clipped(p, pairs, count);
  hr2d_pair clear[HR2DI_CANDIDATES];
  size_t kept = 0;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status; k++) {
    const hr2d_element *i = &p->hierarchy->element[pairs[k].first];
    const hr2d_element *j = &p->hierarchy->element[pairs[k].second];
    if (hr2di_facing_of(&(hr2d_segment){i->a, i->b}, &(hr2d_segment){j->a, j->b}) ==
        HR2DI_FACING_NONE)
      continue;
    status = fail(p, hr2di_projector_work(p, 1));
    if (status) break;
    hr2di_visibility_class view;
    hr2di_line_class_list_cut(&p->found, 0);
    status = hr2di_occluded_collect(p, pairs[k], &view);
    const candidate c = {pairs[k], 0, p->found.count, 0, p->parts.count};
    p->counts.blocked_pairs += view == HR2DI_BLOCKED;
    if (view == HR2DI_CLEAR) clear[kept++] = pairs[k];
    if (view == HR2DI_PARTIAL && !status) status = propose(p, &c, 1);
  }
  return status ? status : hr2di_projector_propose_clipped(p, clear, kept);
}

hr2d_status hr2di_occluded_push(hr2di_projector *p, hr2d_pair pair) {
  hr2di_visibility_class view;
  hr2di_line_class_list_cut(&p->found, 0);
  const hr2d_status status = hr2di_occluded_collect(p, pair, &view);
  return status ? status : push(p, pair, &p->found, 0, p->found.count);
}

hr2d_status hr2di_occluded_share(hr2di_projector *p, const hr2di_occluded_pairs *from,
                                 size_t k) {
  const size_t last = k + 1 < from->stack.count ? from->first[k + 1] : from->list.count;
  return push(p, from->stack.pair[k], &from->list, from->first[k], last);
}

/* Leaves to a child pair what it sees of its parent's line classes, from number `from` on,
   behind what p->found and p->parts have. */
static hr2d_status restrict_to(hr2di_projector *p, hr2d_pair child, size_t from,
                               hr2di_facing *facing, hr2di_visibility_class *view) {
  const hr2di_patch_pair parts = parts_of(p->hierarchy, child);
  const int swap = swapped(&parts);
  const hr2di_line_class_list *list = &p->occluded.list;
  *view = HR2DI_BLOCKED;
  *facing = facing_of(&parts);
  if (*facing == HR2DI_FACING_NONE) return HR2D_OK;
  const size_t first = p->parts.count;
  set_limits(p);
  hr2d_status status = hr2di_line_class_list_restrict(
      &p->parts, list, from, list->count, parts.part[swap], parts.part[!swap], &p->found);
  p->visibility->restricted += list->count - from;
  hr2di_projector_in_row(p, parts.patch[0], parts.patch[1], 0, list->count - from);
  if (!status) status = hr2di_projector_work(p, 1 + (list->count - from) / 2);
  if (!status) *view = classify(&p->parts, first, &parts);
  return fail(p, status);
}

/* Links a pair that no limit lets be divided, with its line classes from number `from` on. */
static hr2d_status link_limited(hr2di_projector *p, hr2d_pair pair, size_t from) {
  const hr2di_patch_pair parts = parts_of(p->hierarchy, pair);
  const hr2di_line_class_list *list = &p->occluded.list;
  const int swap = swapped(&parts);
  hr2d_status status = HR2D_OK;
  set_limits(p);
  if (p->sink)
    status = hr2di_line_class_list_restrict(&p->parts, list, from, list->count,
                                            parts.part[swap], parts.part[!swap], NULL);
  if (status) return fail(p, status);
  p->counts.limited_links++;
  return link_pair(p, pair, 0, p->parts.count);
}

hr2d_status hr2di_occluded_round(hr2di_projector *p) {
  hr2di_occluded_pairs *s = &p->occluded;
  const hr2d_pair pair = s->stack.pair[--s->stack.count];
  const size_t from = s->first[s->stack.count];
  candidate c[CHILD_PAIRS];
  size_t candidates, count = 0;
  int limited;
  hr2d_status status = hr2di_projector_subdivide(p, pair, &candidates, &limited);
  hr2di_line_class_list_cut(&p->parts, 0);
  hr2di_line_class_list_cut(&p->found, 0);
  if (!status && limited) status = link_limited(p, pair, from);
  for (size_t k = 0; k < candidates && !status; k++) {
    hr2di_facing facing;
    hr2di_visibility_class view;
    candidate seen = {
        .pair = p->candidate[k], .first = p->found.count, .first_part = p->parts.count};
    status = restrict_to(p, seen.pair, from, &facing, &view);
    seen.last = p->found.count;
    seen.last_part = p->parts.count;
    if (!status && facing != HR2DI_FACING_NONE)
      status = sort_out(p, &seen, view, facing, c, &count);
  }
  hr2di_line_class_list_cut(&s->list, from);
  return status ? status : propose(p, c, count);
}

hr2d_status hr2di_occluded_area(hr2di_pair_visibility *visibility,
                                const hr2d_hierarchy *hierarchy, hr2d_pair pair, double *area,
                                hr2di_visibility_class *view) {
  const hr2di_patch_pair parts = parts_of(hierarchy, pair);
  hr2di_line_class_list found = {.alloc = hierarchy->alloc};
  *area = 0;
  *view = HR2DI_CLEAR;
  if (facing_of(&parts) == HR2DI_FACING_NONE) return HR2D_OK;
  const hr2d_status status = hr2di_pair_visibility_between(visibility, &parts, &found, NULL);
  if (!status) *view = classify(&found, 0, &parts);
  if (!status && *view == HR2DI_CLEAR) hr2di_exchange_areas(hierarchy->element, &pair, 1, area);
  if (!status && *view == HR2DI_PARTIAL)
    *area = hr2di_line_class_list_area(&found, 0, found.count);
  hr2di_line_class_list_clear(&found);
  return status;
}
