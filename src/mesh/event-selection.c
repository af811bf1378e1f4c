/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A kink in B and in its importance Z inside an element of length h is missed by p
   coefficients. They leave remainders (I − P)B and (I − P)Z, and the error is the sum of ∫
   (I−P)B (I−P)Z.  Of a jump J in the derivative of number g, at fraction x of the element, the
   remainder is about

     J a,   a = 0.3 h^g (4x(1−x))^(g/2 + ¼) p^(−g − ½)/2^(g−1)

   in the mean over the element: each integration divides by the wave number p/(h √(x(1−x))) of
   the highest polynomials.  The remainders of events add up in squares, and those of B from one
   event meet those of Z from another: the leaf has the share h √(Σ(J_B a)²) √(Σ(J_Z a)²).

   While x moves past a vertex u, the border of the view passes the end of a source in
   generation 1, and an event y of the generation before in a later one.  As

     dH/dx = ½ cos²θ/|xu| B(y),

   the jump in H is `spread` times that at y, of B itself or of its derivative: hr2di_event has
   it.

   The events that seem to matter by the bounds of their jumps are looked at. */
#include "mesh/event-selection.h"

#include <math.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/sort.h"
#include "geometry/vector.h"
#include "mesh/derivative-jumps.h"
#include "mesh/mesh-grading.h"
#include "scene/scene-impl.h"

/* Of jumps in terms of the largest B, and of shares: their squares and sums are finite. */
#define LARGEST 1e100

/* A leaf with events first ≤ k < last inside. */
typedef struct leaf {
  uint32_t element;
  double from, to; /* of the patch */
  size_t first, last;
  double sum;  /* its share */
  size_t best; /* event, to divide it at */
} leaf;

typedef struct cutter {
  hr2d_hierarchy *h;
  const hr2d_scene *scene;
  const hr2di_events *events;
  hr2di_derivative_jumps jumps;
  size_t bands;
  hr2di_watch *watch;
  double (*square)[2]; /* of the events in the leaf that is weighed: what they add to those of
                          both remainders */
  leaf *heap;          /* the one with the largest sum first */
  size_t count, capacity;
  double total;
} cutter;

/* a²; 0 for an event too near to an end of the leaf. */
static double remainder_of(const cutter *c, const leaf *l, const hr2di_event *e) {
  const double margin = 4 * hr2di_grading_shortest(&c->scene->patch[e->patch]);
  if (e->at <= l->from + margin || e->at >= l->to - margin) return 0;
  const double x = (e->at - l->from) / (l->to - l->from), round = 4 * x * (1 - x);
  const double p = c->h->order, h = c->h->element[l->element].length;
  const double step = 0.25 * h * h * round / (p * p);
  double a = 0.36 * sqrt(round) / p;
  for (unsigned g = 0; g < e->generation; g++) a *= step;
  return a;
}

/* What an event adds to the square of the remainder of B in a band, relative to the largest B;
   or of its importance, if `of` is `bands` more. */
static double square_of(const cutter *c, double remainder, size_t k, size_t of) {
  const double jump =
      fmin(fabs(c->jumps.jump[k * 2 * c->bands + of]) / c->jumps.max[of], LARGEST);
  return jump * jump * remainder;
}

/* The share of a leaf in one band; if it is larger than l->sum it becomes that, and l->best the
   event that makes the largest parts of both remainders. */
static void weigh_band(const cutter *c, leaf *l, size_t b) {
  const uint32_t patch = c->h->element[l->element].patch;
  const double unit =
      c->h->element[l->element].length * c->jumps.max[b] * c->jumps.max[c->bands + b];
  double sum[2] = {0, 0};
  for (size_t k = l->first; k < l->last; k++) {
    const double remainder = remainder_of(c, l, &c->events->event[k]);
    for (size_t m = 0; m < 2; m++)
      sum[m] += c->square[k][m] = square_of(c, remainder, k, b + m * c->bands);
  }
  const double rho = hr2di_scene_scattered(c->scene, patch, b);
  const double share = fmin(rho * unit * sqrt(sum[0]) * sqrt(sum[1]), LARGEST);
  if (!(share > l->sum)) return;
  l->sum = share;
  double max = 0;
  for (size_t k = l->first; k < l->last; k++) {
    const double part = c->square[k][0] / sum[0] + c->square[k][1] / sum[1];
    if (part > max) l->best = k;
    max = fmax(max, part);
  }
}

static void weigh_leaf(const cutter *c, leaf *l) {
  l->sum = 0;
  for (size_t b = 0; b < c->bands; b++)
    if (c->jumps.max[b] > 0 && c->jumps.max[c->bands + b] > 0) weigh_band(c, l, b);
}

/* Adds a leaf to the heap, if any event is left in it. */
static hr2d_status push(cutter *c, leaf l) {
  weigh_leaf(c, &l);
  if (!(l.sum > 0)) return HR2D_OK;
  if (hr2di_alloc_reserve(&c->h->alloc, &c->heap, &c->capacity, c->count + 1, sizeof *c->heap))
    return HR2D_ENOMEM;
  size_t at = c->count++;
  for (; at > 0 && c->heap[(at - 1) / 2].sum < l.sum; at = (at - 1) / 2)
    c->heap[at] = c->heap[(at - 1) / 2];
  c->heap[at] = l;
  c->total += l.sum;
  return HR2D_OK;
}

static leaf pop(cutter *c) {
  const leaf top = c->heap[0], last = c->heap[--c->count];
  size_t at = 0;
  for (size_t child; (child = 2 * at + 1) < c->count; at = child) {
    if (child + 1 < c->count && c->heap[child + 1].sum > c->heap[child].sum) child++;
    if (c->heap[child].sum <= last.sum) break;
    c->heap[at] = c->heap[child];
  }
  if (c->count > 0) c->heap[at] = last;
  c->total -= top.sum;
  if (top.sum > c->total) { /* few digits of the others were left */
    c->total = 0;
    for (size_t k = 0; k < c->count; k++) c->total += c->heap[k].sum;
  }
  return top;
}

static hr2d_status push_all(cutter *c) {
  const hr2d_hierarchy *h = c->h;
  hr2d_status status = HR2D_OK;
  for (uint32_t k = 0; k < h->elements && !status; k++) {
    const hr2d_element *e = &h->element[k];
    status = hr2di_watch_work(c->watch, 1);
    if (e->child || status || e->patch >= hr2di_scene_cell(h->scene)) continue;
    leaf l = {.element = k, .from = hr2di_element_start(h, k)};
    l.to = l.from + e->length / h->scene->patch[e->patch].length;
    l.first = hr2di_derivative_jumps_find(c->events, e->patch, l.from);
    l.last = hr2di_derivative_jumps_find(c->events, e->patch, l.to);
    if (l.first < l.last && !status) status = push(c, l);
  }
  return status;
}

static int matters(const cutter *c, const leaf *l, size_t k) {
  return !c->jumps.known[k] &&
         c->square[k][0] >= HR2DI_CHOICE_EVENTS_TOGETHER * c->square[l->best][0];
}

/* Finds out about the best event of a leaf, and about those that seem to matter about as much.
   Bounds of B and of its importance are in proportion. */
static hr2d_status search_into(cutter *c, const leaf *l) {
  hr2d_status status = hr2di_derivative_jumps_know(&c->jumps, l->best);
  for (size_t k = l->first; k < l->last && !status; k++)
    if (matters(c, l, k)) status = hr2di_derivative_jumps_know(&c->jumps, k);
  return status;
}

static int larger_first(const void *x, const void *y) {
  const leaf *a = x, *b = y;
  if (a->sum != b->sum) return a->sum > b->sum ? -1 : 1;
  return a->element < b->element ? -1 : a->element > b->element;
}

/* Makes a heap of all leaves again, and weighs them. */
static hr2d_status push_again(cutter *c) {
  const size_t count = c->count;
  hr2d_status status = HR2D_OK;
  c->count = 0;
  c->total = 0;
  for (size_t k = 0; k < count && !status; k++) {
    const leaf l = c->heap[k];
    status = hr2di_watch_work(c->watch, 1 + (l.last - l.first) / 2);
    if (!status) status = push(c, l);
  }
  return status;
}

/* A leaf that has a sum above `allowed` together with all smaller ones will be looked into: so
   all of these are at once, by all threads.  *looks is the number of events looked at. */
static hr2d_status find_ahead(cutter *c, double allowed, size_t *looks) {
  size_t many = 0;
  hr2d_status status = hr2di_sort(c->heap, c->count, sizeof *c->heap, larger_first, c->watch);
  for (double rest = c->total; many < c->count && rest > allowed && !status; many++) {
    const leaf *l = &c->heap[many];
    status = hr2di_watch_work(c->watch, 1 + (l->last - l->first) / 16);
    rest -= l->sum;
    if (c->jumps.known[l->best]) continue;
    hr2di_derivative_jumps_want(&c->jumps, l->best);
    for (size_t k = l->first; k < l->last; k++)
      if (matters(c, l, k)) hr2di_derivative_jumps_want(&c->jumps, k);
  }
  *looks = c->jumps.count;
  if (!status) status = hr2di_derivative_jumps_look(&c->jumps);
  return status ? status : push_again(c);
}

/* Divides the leaf with the largest share at its best event; or finds out about that. */
static hr2d_status cut(cutter *c) {
  const leaf l = pop(c);
  if (!c->jumps.known[l.best]) {
    const hr2d_status status = search_into(c, &l);
    return status ? status : push(c, l);
  }
  const hr2di_event *e = &c->events->event[l.best];
  const hr2d_point at = hr2di_point_at(c->scene->patch[e->patch].scaled, e->at);
  hr2d_status status = hr2di_hierarchy_reserve(c->h);
  if (status) return status;
  const uint32_t child =
      hr2di_element_divide(c->h, l.element, (e->at - l.from) / (l.to - l.from), at);
  status = push(c, (leaf){child, l.from, e->at, l.first, l.best, 0, 0});
  return status ? status : push(c, (leaf){child + 1, e->at, l.to, l.best + 1, l.last, 0, 0});
}

static hr2d_status run(cutter *c, double allowed, uint64_t max_elements) {
  hr2d_status status = push_all(c);
  size_t looks = c->events->count;
  while (c->total > allowed && looks >= HR2DI_CHOICE_TEAM_EVENTS && !status)
    status = find_ahead(c, allowed, &looks);
  while (c->count > 0 && c->total > allowed && !status) {
    if (max_elements && c->h->elements + 2 > max_elements) return HR2D_EMAX_ELEMENTS;
    status = hr2di_watch_work(c->watch, 4 + (c->heap[0].last - c->heap[0].first));
    if (!status) status = cut(c);
  }
  return status;
}

/* Squares of remainders of several events add up. */
static void add_remainder(const cutter *c, const leaf *l, size_t k, double *unresolved_jump) {
  const hr2di_event *e = &c->events->event[k];
  const double a = sqrt(remainder_of(c, l, e));
  for (size_t b = 0; b < c->bands; b++) {
    const double rho = hr2di_scene_scattered(c->scene, e->patch, b);
    double *of = &unresolved_jump[l->element * c->bands + b];
    if (c->jumps.max[b] > 0)
      *of = hypot(*of, rho * c->jumps.jump[k * 2 * c->bands + b] / c->jumps.max[b] * a);
  }
}

static hr2d_status measure(const cutter *c, double **unresolved_jump) {
  *unresolved_jump =
      hr2di_alloc_zero(&c->h->alloc, c->h->elements, c->bands * sizeof **unresolved_jump);
  if (!*unresolved_jump) return HR2D_ENOMEM;
  for (size_t k = 0; k < c->count && !hr2di_watch_work(c->watch, 1); k++)
    for (size_t m = c->heap[k].first; m < c->heap[k].last; m++)
      add_remainder(c, &c->heap[k], m, *unresolved_jump);
  return hr2di_watch_status(c->watch);
}

hr2d_status hr2di_events_select(hr2d_hierarchy *hierarchy, const hr2di_events *events,
                                const hr2di_primal_dual *lights, double allowed,
                                uint64_t max_elements, unsigned threads, hr2di_watch *watch,
                                double **unresolved_jump) {
  const hr2d_allocator *alloc = &hierarchy->alloc;
  cutter c = {.h = hierarchy,
              .scene = hierarchy->scene,
              .events = events,
              .bands = hierarchy->scene->bands,
              .watch = watch};
  *unresolved_jump = NULL;
  if (events->count == 0) return HR2D_OK;
  c.square = hr2di_alloc(alloc, events->count, sizeof *c.square);
  hr2d_status status =
      hr2di_derivative_jumps_init(&c.jumps, c.scene, events, lights, threads, alloc, watch);
  if (!status && !c.square) status = HR2D_ENOMEM;
  if (!status) status = run(&c, allowed, max_elements);
  if (!status) status = measure(&c, unresolved_jump);
  hr2di_derivative_jumps_clear(&c.jumps);
  hr2di_alloc_free(alloc, c.square);
  hr2di_alloc_free(alloc, c.heap);
  return status;
}
