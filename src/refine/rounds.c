/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ProjectKernel without recursion: rounds of pairs between two stacks.

   A round takes up to HR2DI_BATCH refused pairs from the top of a stack, lets the
   policy choose which elements to subdivide, and proposes the child pairs to the oracle
   at once.  Accepted pairs go to the sink, refused pairs back to the stack.  So the
   order is depth first and the stacks stay short: each level above the current one
   leaves at most a batch behind.

   If the elements of a pair face each other fully, so do those of all its descendants.  A
   pair cut by a horizon is clipped: its descendants are tested, and join the others once
   they face each other fully. */
#include "refine/rounds.h"

#include "refine/occluded-pairs.h"

enum {
  TICKS = 64 /* rounds between two measurements of progress, which cost as much as one */
};

/* One round: subdivides the topmost refused pairs, or links them if a limit holds. */
static hr2d_status play(hr2di_projector *p, hr2di_stack *stack) {
  size_t count = stack->count < HR2DI_BATCH ? stack->count : HR2DI_BATCH, limited = 0;
  hr2d_pair *pairs = stack->pair + stack->count - count;
  hr2d_status status = hr2di_projector_choose_split(p, pairs, count);
  if (status) return status;
  stack->count -= count;
  const int limits = p->check_levels || p->links->policy.recursion_limit;
  size_t candidates = limits ? 0 : hr2di_projector_children(p, pairs, count);
  if (candidates == 0) {
    status = hr2di_projector_prepare(p, pairs, &count, &limited);
    p->counts.limited_links += limited;
    if (!status) status = hr2di_projector_accept(p, NULL, limited);
    if (status) return status;
    candidates = hr2di_projector_children(p, pairs, count);
  }
  status = hr2di_projector_claim(p, p->candidate, &candidates);
  if (status) return status;
  if (stack == &p->facing)
    return hr2di_projector_propose(p, p->candidate, candidates, &p->facing);
  p->counts.facing_tests += candidates;
  return hr2di_projector_propose_clipped(p, p->candidate, candidates);
}

size_t hr2di_rounds_waiting(const hr2di_projector *p) {
  return p->facing.count + p->clipped.count + p->occluded.stack.count + p->unoccluded[0].count +
         p->unoccluded[1].count;
}

/* Proposes the topmost child pairs that no longer have walls in the way. */
static hr2d_status propose_unoccluded(hr2di_projector *p) {
  hr2di_stack *unoccluded = &p->unoccluded[p->unoccluded[0].count == 0];
  const size_t count = unoccluded->count < HR2DI_BATCH ? unoccluded->count : HR2DI_BATCH;
  unoccluded->count -= count;
  return hr2di_projector_propose(p, unoccluded->pair + unoccluded->count, count,
                                 unoccluded == &p->unoccluded[0] ? &p->facing : &p->clipped);
}

/* Full batches first; then occluded pairs, until these have made a batch of unoccluded ones. */
static hr2d_status play_next(hr2di_projector *p) {
  if (p->facing.count >= HR2DI_BATCH) return play(p, &p->facing);
  if (p->clipped.count >= HR2DI_BATCH) return play(p, &p->clipped);
  const size_t unoccluded = p->unoccluded[0].count + p->unoccluded[1].count;
  if (p->occluded.stack.count > 0 && unoccluded < HR2DI_BATCH) return hr2di_occluded_round(p);
  if (unoccluded > 0) return propose_unoccluded(p);
  return play(p, p->facing.count > 0 ? &p->facing : &p->clipped);
}

hr2d_status hr2di_rounds_run(hr2di_projector *p, size_t enough) {
  hr2d_status status = HR2D_OK;
  for (;;) {
    const size_t left = hr2di_rounds_waiting(p);
    if (status || left == 0 || left >= enough) return status;
    status = play_next(p);
    if (++p->ticks % TICKS == 0) hr2di_rounds_measure(p);
  }
}

/* The sum, over the pairs on a stack, of the part that each is of its root pair. */
static double unfinished(const hr2di_projector *p, const hr2di_stack *stack) {
  const hr2d_element *e = p->hierarchy->element;
  double sum = 0;
  for (size_t k = 0; k < stack->count; k++) {
    const hr2d_element *i = &e[stack->pair[k].first], *j = &e[stack->pair[k].second];
    sum += i->length / e[i->patch].length * (j->length / e[j->patch].length);
  }
  return sum;
}

void hr2di_rounds_measure(hr2di_projector *p) {
  if (!p->watch->ask) return; /* nobody is told */
  const double done = p->roots_done - unfinished(p, &p->facing) - unfinished(p, &p->clipped) -
                      unfinished(p, &p->unoccluded[0]) - unfinished(p, &p->unoccluded[1]) -
                      unfinished(p, &p->occluded.stack);
  p->fraction = done > 0 && p->roots > 0 ? done / p->roots : 0;
}

void hr2di_rounds_describe(void *projector, hr2d_progress *report) {
  const hr2di_projector *p = projector;
  report->elements = p->hierarchy->elements;
  report->links = p->counts.links;
  report->fraction = p->fraction;
}
