/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of ProjectKernel on many pairs at once: propose them to the oracle, let the policy
   choose which elements to subdivide, halve these, make the child pairs; and the budgets. */
#include "refine/projector.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/alloc.h"
#include "geometry/predicates.h"
#include "oracle/built-in.h"
#include "refine/part-rows.h"
#include "refine/partition.h"

enum { UNWRITTEN = 255 /* no subdivision: marks entries that a callback did not write */ };

static hr2d_status fail(hr2di_projector *p, hr2d_status status, const char *what) {
  return hr2di_message_fail(&p->links->message, status, "%s", what);
}

hr2d_status hr2di_projector_fail(hr2di_projector *p, hr2d_status status, const char *what) {
  if (hr2di_watch_refused(p->watch))
    return hr2di_projector_check_callback(p, status, "callback", "progress");
  if (status && status == hr2di_watch_status(p->watch)) return status;
  return status ? hr2di_message_fail(&p->links->message, status, "out of memory%s", what)
                : HR2D_OK;
}

static uint64_t stack_bytes(const hr2di_projector *p) {
  const uint64_t pairs = p->facing.capacity + p->clipped.capacity + p->unoccluded[0].capacity +
                         p->unoccluded[1].capacity + p->occluded.stack.capacity;
  const uint64_t visibility = hr2di_line_class_list_bytes(&p->occluded.list) +
                              hr2di_line_class_list_bytes(&p->found) +
                              hr2di_line_class_list_bytes(&p->parts) +
                              (p->visibility ? hr2di_pair_visibility_bytes(p->visibility) : 0);
  return pairs * sizeof(hr2d_pair) + p->occluded.first_capacity * sizeof *p->occluded.first +
         visibility + p->brightness_capacity * sizeof *p->brightness;
}

hr2d_status hr2di_projector_fail_budget(hr2d_linkset *links, uint64_t budget, uint64_t made) {
  return hr2di_message_fail(&links->message, HR2D_EMAX_BYTES,
                            "more than %llu bytes are needed, after %llu links",
                            (unsigned long long)budget, (unsigned long long)made);
}

/* What is held of the budget. */
static uint64_t held_bytes(const hr2di_projector *p) {
  return p->bytes + (uint64_t)p->hierarchy->capacity * HR2DI_ELEMENT_BYTES + stack_bytes(p);
}

uint64_t hr2di_projector_left(const hr2di_projector *p) {
  const uint64_t budget = p->options.max_bytes, held = budget ? held_bytes(p) : 0;
  return budget == 0 ? UINT64_MAX : held < budget ? budget - held : 0;
}

hr2d_status hr2di_projector_check_budget(hr2di_projector *p, uint64_t more) {
  const uint64_t budget = p->options.max_bytes, held = budget ? held_bytes(p) : 0;
  if (budget == 0 || (held <= budget && more <= budget - held)) return HR2D_OK;
  return hr2di_projector_fail_budget(p->links, p->budget, p->counts.links);
}

static hr2d_status reserve(hr2di_projector *p, hr2di_stack *stack, size_t more) {
  const size_t needed = stack->count + more;
  if (needed <= stack->capacity) return HR2D_OK;
  const hr2d_status status = hr2di_projector_check_budget(p, 2 * needed * sizeof(hr2d_pair));
  if (status) return status;
  return hr2di_alloc_reserve(&p->links->alloc, &stack->pair, &stack->capacity, needed,
                             sizeof *stack->pair)
             ? fail(p, HR2D_ENOMEM, "out of memory for refused pairs")
             : HR2D_OK;
}

hr2d_status hr2di_projector_push(hr2di_projector *p, hr2di_stack *stack, hr2d_pair pair) {
  const hr2d_status status = reserve(p, stack, 1);
  if (!status) stack->pair[stack->count++] = pair;
  return status;
}

static hr2d_batch make_batch(const hr2di_projector *p, const hr2d_pair *pairs, size_t count) {
  return (hr2d_batch){.struct_size = sizeof(hr2d_batch),
                      .hierarchy = p->hierarchy,
                      .elements = p->hierarchy->element,
                      .pairs = pairs,
                      .count = count,
                      .unit = hr2d_scene_unit(p->hierarchy->scene),
                      .epsilon = p->options.epsilon,
                      .partial = p->partial,
                      .brightness = p->brightness};
}

hr2d_status hr2di_projector_check_callback(hr2di_projector *p, hr2d_status status,
                                           const char *kind, const char *name) {
  if (!status) return HR2D_OK;
  return hr2di_message_fail(&p->links->message, status, "%s \"%s\": %s", kind, name,
                            hr2d_strerror(status));
}

hr2d_status hr2di_projector_claim(hr2di_projector *p, hr2d_pair *pairs, size_t *count) {
  if (!p->options.claim || *count == 0) return HR2D_OK;
  const hr2d_batch batch = make_batch(p, pairs, *count);
  memset(p->flag, 1, *count);
  const hr2d_status status = p->options.claim(p->options.claim_ctx, &batch, p->flag);
  size_t kept = 0;
  for (size_t k = 0; k < *count; k++) {
    pairs[kept] = pairs[k];
    kept += p->flag[k] != 0;
  }
  *count = kept;
  return hr2di_projector_check_callback(p, status, "callback", "claim");
}

static hr2d_status compare(hr2di_projector *p, const hr2d_batch *batch) {
  const hr2d_linkset *links = p->links;
  for (size_t k = 0; k < batch->count; k++)
    if (!(p->error[k] >= 0))
      return hr2di_message_fail(
          &p->links->message, HR2D_ECALLBACK,
          "oracle \"%s\": an estimate of %g, for elements %u and %u", links->oracle.name,
          p->error[k], (unsigned)batch->pairs[k].first, (unsigned)batch->pairs[k].second);
  if (links->policy.acceptable)
    return hr2di_projector_check_callback(
        p, links->policy.acceptable(links->policy_ctx, batch, p->error, p->flag), "policy",
        links->policy.name);
  for (size_t k = 0; k < batch->count; k++) p->flag[k] = p->error[k] <= p->options.epsilon;
  return HR2D_OK;
}

/* Asks the oracle about the pairs of a batch from number `first` on. */
static hr2d_status ask(hr2di_projector *p, const hr2d_batch *all, size_t first, size_t count,
                       int shortcut) {
  const hr2d_linkset *links = p->links;
  hr2d_batch some = *all;
  some.pairs += first;
  some.count = count;
  if (some.partial) some.partial += first;
  const hr2d_status status =
      shortcut ? links->oracle.accept(links->oracle_ctx, &some, some.epsilon, p->flag + first)
               : links->oracle.estimate(links->oracle_ctx, &some, p->error + first);
  return hr2di_projector_check_callback(p, status, "oracle", links->oracle.name);
}

/* An oracle that integrates is asked about a part of a long batch at a time. */
static hr2d_status ask_all(hr2di_projector *p, const hr2d_batch *all, int shortcut) {
  const hr2d_oracle *oracle = &p->links->oracle;
  if (all->count == 0 || !hr2di_oracle_work(oracle, all, 0)) {
    const hr2d_status status = hr2di_projector_work(p, 1 + all->count);
    return status ? hr2di_projector_fail(p, status, "") : ask(p, all, 0, all->count, shortcut);
  }
  hr2d_status status = HR2D_OK;
  for (size_t first = 0, last = 0; first < all->count && !status; first = last) {
    uint64_t work = 0;
    while (last < all->count && work < HR2DI_WATCH_SPAN / 4)
      work += hr2di_oracle_work(oracle, all, last++);
    status = hr2di_projector_work(p, work);
    status = status ? hr2di_projector_fail(p, status, "")
                    : ask(p, all, first, last - first, shortcut);
  }
  return status;
}

hr2d_status hr2di_projector_estimate(hr2di_projector *p, const hr2d_pair *pairs, size_t count) {
  const hr2d_linkset *links = p->links;
  const hr2d_batch batch = make_batch(p, pairs, count);
  p->counts.oracle_calls += count;
  const int shortcut = links->oracle.accept && !links->policy.acceptable;
  memset(p->flag, 0, count);
  for (size_t k = 0; k < count && !shortcut; k++) p->error[k] = NAN;
  const hr2d_status status = ask_all(p, &batch, shortcut);
  return status || shortcut ? status : compare(p, &batch);
}

hr2d_status hr2di_projector_count_links(hr2di_projector *p, size_t more) {
  const uint64_t budget = p->options.max_links;
  p->counts.links += more;
  if (budget == 0 || p->counts.links <= budget) return HR2D_OK;
  return hr2di_message_fail(&p->links->message, HR2D_EMAX_LINKS,
                            "more than %llu links are needed", (unsigned long long)budget);
}

hr2d_status hr2di_projector_accept(hr2di_projector *p, const double *area, size_t count) {
  count = hr2di_part_rows_keep(p, &area, count);
  if (count == 0) return HR2D_OK;
  const hr2d_status status = hr2di_projector_count_links(p, count);
  for (size_t k = 0; k < count && p->rows; k++)
    hr2di_projector_in_row(p, p->hierarchy->element[p->accepted[k].first].patch,
                           p->hierarchy->element[p->accepted[k].second].patch, 1, 0);
  return status || !p->sink ? status : p->sink(p->sink_ctx, p->accepted, area, count);
}

hr2d_status hr2di_projector_propose(hr2di_projector *p, const hr2d_pair *pairs, size_t count,
                                    hr2di_stack *refused) {
  if (count == 0) return HR2D_OK;
  hr2d_status status = reserve(p, refused, count);
  if (!status) status = hr2di_projector_estimate(p, pairs, count);
  if (status) return status;
  const size_t accepted =
      hr2di_partition(pairs, p->flag, count, p->accepted, refused->pair + refused->count);
  refused->count += count - accepted;
  return hr2di_projector_accept(p, NULL, accepted);
}

hr2d_status hr2di_projector_propose_clipped(hr2di_projector *p, const hr2d_pair *pairs,
                                            size_t count) {
  const hr2d_element *element = p->hierarchy->element;
  size_t full = 0, part = 0;
  const hr2d_status asked = hr2di_projector_work(p, count);
  if (asked) return hr2di_projector_fail(p, asked, "");
  for (size_t k = 0; k < count; k++) {
    const hr2d_element *i = &element[pairs[k].first], *j = &element[pairs[k].second];
    const hr2di_facing facing =
        hr2di_facing_of(&(hr2d_segment){i->a, i->b}, &(hr2d_segment){j->a, j->b});
    if (facing == HR2DI_FACING_NONE) continue;
    if (facing == HR2DI_FACING_PART || p->test_all)
      p->sorted[1][part++] = pairs[k];
    else
      p->sorted[0][full++] = pairs[k];
  }
  const hr2d_status status = hr2di_projector_propose(p, p->sorted[0], full, &p->facing);
  return status ? status : hr2di_projector_propose(p, p->sorted[1], part, &p->clipped);
}

hr2d_status hr2di_projector_halve(hr2di_projector *p, uint32_t element) {
  hr2d_hierarchy *h = p->hierarchy;
  if (p->options.max_elements && h->elements + 2 > p->options.max_elements)
    return hr2di_message_fail(&p->links->message, HR2D_EMAX_ELEMENTS,
                              "more than %llu elements are needed, after %llu links",
                              (unsigned long long)p->options.max_elements,
                              (unsigned long long)p->counts.links);
  hr2d_status status = HR2D_OK;
  if (h->elements + 2 > h->capacity)
    status = hr2di_projector_check_budget(p, (uint64_t)h->capacity * HR2DI_ELEMENT_BYTES);
  if (!status && p->brightness && h->elements + 2 > p->brightness_capacity)
    status = hr2di_projector_check_budget(p, 2 * (h->elements + 2) * sizeof *p->brightness);
  if (status) return status;
  status = hr2di_hierarchy_reserve(h);
  if (!status && p->brightness &&
      hr2di_alloc_reserve(&h->alloc, &p->brightness, &p->brightness_capacity, h->elements + 2,
                          sizeof *p->brightness))
    status = HR2D_ENOMEM;
  if (status) return fail(p, status, "no room for another element");
  const uint32_t child = hr2di_element_halve(h, element);
  if (p->brightness) p->brightness[child] = p->brightness[child + 1] = p->brightness[element];
  return HR2D_OK;
}

hr2d_status hr2di_projector_choose_split(hr2di_projector *p, const hr2d_pair *pairs,
                                         size_t count) {
  const hr2d_linkset *links = p->links;
  const hr2d_policy *policy = &links->policy;
  const hr2d_batch batch = make_batch(p, pairs, count);
  memset(p->split, UNWRITTEN, count);
  memset(p->flag, 0, count);
  hr2d_status status = policy->preferred_subdivision(links->policy_ctx, &batch, p->split);
  if (!status && policy->recursion_limit)
    status = policy->recursion_limit(links->policy_ctx, &batch, p->flag);
  if (status) return hr2di_projector_check_callback(p, status, "policy", policy->name);
  /* Entries behind `count` are from earlier batches and were checked then; a loop over all
     HR2DI_BATCH is faster. */
  unsigned char max = 0;
  for (size_t k = 0; k < HR2DI_BATCH; k++) max = p->split[k] > max ? p->split[k] : max;
  if (max > HR2D_SPLIT_BOTH)
    return hr2di_message_fail(&p->links->message, HR2D_ECALLBACK,
                              "policy \"%s\": a subdivision of %u has no meaning", policy->name,
                              (unsigned)max);
  return HR2D_OK;
}

static int splits_first(unsigned split) {
  return split != HR2D_SPLIT_SECOND;
}

static int splits_second(unsigned split) {
  return split != HR2D_SPLIT_FIRST;
}

/* Whether the limits allow an element to be subdivided. */
static int may_split(const hr2di_projector *p, uint32_t element) {
  const hr2d_hierarchy *h = p->hierarchy;
  return h->level[element] < p->options.max_level &&
         (h->element[element].child || hr2di_element_divisible(h, element));
}

hr2d_status hr2di_projector_prepare(hr2di_projector *p, hr2d_pair *pairs, size_t *count,
                                    size_t *limited) {
  const int own_limit = p->links->policy.recursion_limit != NULL;
  size_t kept = 0;
  for (size_t k = 0; k < *count; k++) {
    const hr2d_pair pair = pairs[k];
    const unsigned split = p->split[k];
    if ((own_limit && p->flag[k]) || (splits_first(split) && !may_split(p, pair.first)) ||
        (splits_second(split) && !may_split(p, pair.second))) {
      p->accepted[(*limited)++] = pair;
      continue;
    }
    hr2d_status status = HR2D_OK;
    if (splits_first(split) && !p->hierarchy->element[pair.first].child)
      status = hr2di_projector_halve(p, pair.first);
    if (!status && splits_second(split) && !p->hierarchy->element[pair.second].child)
      status = hr2di_projector_halve(p, pair.second);
    if (status) return status;
    pairs[kept] = pair;
    p->split[kept++] = p->split[k];
  }
  *count = kept;
  return HR2D_OK;
}

_Static_assert(HR2D_SPLIT_FIRST == 0 && HR2D_SPLIT_SECOND == 1 &&
                   offsetof(hr2d_pair, second) == sizeof(uint32_t),
               "a split is the place of an element in its pair");

/* The two child pairs of a pair of which one element is split.  The pair is a word with the
   first element in the low half, so that no branch is needed, which would be mispredicted.
   Returns the element's left child, 0 if it has no children yet. */
static inline uint32_t split_one(const hr2d_element *element, const hr2d_pair *pair,
                                 unsigned split, hr2d_pair out[2]) {
  static const uint64_t kept[] = {(uint64_t)UINT32_MAX << 32, UINT32_MAX};
  static const uint64_t one[] = {1, (uint64_t)1 << 32};
  uint32_t parent;
  memcpy(&parent, (const char *)pair + split * sizeof parent, sizeof parent);
  const uint32_t child = element[parent].child;
  const uint64_t both = (uint64_t)pair->second << 32 | pair->first;
  const uint64_t left = (both & kept[split]) | child * one[split], right = left + one[split];
  out[0] = (hr2d_pair){(uint32_t)left, (uint32_t)(left >> 32)};
  out[1] = (hr2d_pair){(uint32_t)right, (uint32_t)(right >> 32)};
  return child;
}

static inline uint32_t less(uint32_t i, uint32_t j) {
  return i < j ? i : j;
}

size_t hr2di_projector_children(hr2di_projector *p, const hr2d_pair *pairs, size_t count) {
  const hr2d_element *element = p->hierarchy->element;
  hr2d_pair *out = p->candidate;
  uint32_t min = UINT32_MAX;
  for (size_t k = 0; k < count; k++) {
    const unsigned split = p->split[k];
    if (split == HR2D_SPLIT_BOTH) {
      hr2d_pair half[2];
      min = less(min, split_one(element, &pairs[k], HR2D_SPLIT_FIRST, half));
      min = less(min, split_one(element, &half[0], HR2D_SPLIT_SECOND, out));
      min = less(min, split_one(element, &half[1], HR2D_SPLIT_SECOND, out + 2));
      out += 4;
    } else {
      min = less(min, split_one(element, &pairs[k], split, out));
      out += 2;
    }
  }
  return min ? (size_t)(out - p->candidate) : 0;
}

hr2d_status hr2di_projector_subdivide(hr2di_projector *p, hr2d_pair pair, size_t *candidates,
                                      int *limited) {
  size_t count = 1, held = 0;
  hr2d_status status = hr2di_projector_choose_split(p, &pair, 1);
  if (!status) status = hr2di_projector_prepare(p, &pair, &count, &held);
  *limited = held > 0;
  *candidates = status || held ? 0 : hr2di_projector_children(p, &pair, 1);
  return status ? status : hr2di_projector_claim(p, p->candidate, candidates);
}

void hr2di_projector_count_elements(const hr2d_hierarchy *hierarchy,
                                    hr2d_refine_counts *counts) {
  const hr2d_hierarchy_counts h = hr2d_hierarchy_count(hierarchy);
  counts->elements = h.elements;
  counts->leaves = h.leaves;
  counts->levels = h.levels;
}
