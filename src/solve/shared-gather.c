/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an element receives over a link is added up in bins, so that no bit depends on which
   share has which links.  G V is not negative, so that |C_lm| ≤ √((2l+1)(2m+1)) C_00, and the
   C_00 of the links of an element add up to its length A at most.  With

     s_j = Σ_m √(2m+1) |B_jm|

   the terms of coefficient l of an element add up to A √(2l+1) max s_j at most, where j are the
   elements that it is linked with.  So a dark element has all its digits, too.  Images that
   stand for others count more than once: see hr2di_symmetry_max(). */
#include "solve/shared-gather.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/bin.h"
#include "base/team.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "solve/block-part.h"
#include "solve/gather-blocks.h"

/* Of the bound of a block, and of roundings. */
#define SLACK 4

enum { MOST_PARTS = 16 };

struct hr2di_shared {
  size_t parts;                 /* of receivers, one for each thread */
  size_t begin[MOST_PARTS + 1]; /* where the elements of each part begin */
  hr2di_bin *bin;               /* elements × width */
  double *size;                 /* elements × bands: s of the element */
  double *max;  /* likewise: the largest s of those that it is linked with, then σ */
  double *term; /* per part two products with a block */
};

/* Work of one gather that is worth another thread, in coefficients of blocks. */
enum { WORTH = 200000 };

/* Cuts the elements into parts over which about the same number of links come in, so that
   threads need no copies of sums. */
static void cut_parts(hr2di_transport *t) {
  struct hr2di_shared *s = t->shared;
  const uint64_t links = t->links->store.count;
  const uint64_t work = links * t->order * t->width / WORTH;
  s->parts = hr2di_team_threads(t->threads);
  if (s->parts > MOST_PARTS) s->parts = MOST_PARTS;
  if (s->parts > work + 1) s->parts = (size_t)work + 1;
  if (t->order == 1) s->parts = 1;
  s->begin[s->parts] = t->elements;
  if (s->parts == 1) return;
  double *ends = t->down; /* not yet in use */
  for (size_t e = 0; e < t->elements; e++) ends[e] = 0;
  for (uint64_t k = 0; k < links; k++) {
    const hr2d_pair pair = hr2di_store_link(&t->links->store, k).pair;
    if (k % 4096 == 0 && hr2di_watch_work(t->watch, 64)) break;
    ends[pair.first]++;
    if (!t->links->directed) ends[pair.second]++;
  }
  double before = 0, all = 0;
  for (size_t e = 0; e < t->elements; e++) all += ends[e];
  size_t part = 1;
  for (size_t e = 0; e < t->elements && part < s->parts; before += ends[e++])
    while (part < s->parts && before * (double)s->parts >= (double)part * all)
      s->begin[part++] = e;
  while (part < s->parts) s->begin[part++] = t->elements;
}

hr2d_status hr2di_shared_gather_init(hr2di_transport *t) {
  struct hr2di_shared *s = t->shared = hr2di_alloc_zero(&t->alloc, 1, sizeof *s);
  if (!s) return HR2D_ENOMEM;
  cut_parts(t);
  const size_t bands = t->bands * sizeof(double);
  s->bin = hr2di_alloc(&t->alloc, t->elements, t->width * sizeof *s->bin);
  s->size = hr2di_alloc(&t->alloc, t->elements, bands);
  s->max = hr2di_alloc(&t->alloc, t->elements, bands);
  s->term = hr2di_alloc(&t->alloc, 2 * s->parts, t->width * sizeof *s->term);
  return s->bin && s->size && s->max && s->term ? HR2D_OK : HR2D_ENOMEM;
}

void hr2di_shared_gather_clear(hr2di_transport *t) {
  if (!t->shared) return;
  hr2di_alloc_free(&t->alloc, t->shared->bin);
  hr2di_alloc_free(&t->alloc, t->shared->size);
  hr2di_alloc_free(&t->alloc, t->shared->max);
  hr2di_alloc_free(&t->alloc, t->shared->term);
  hr2di_alloc_free(&t->alloc, t->shared);
  t->shared = NULL;
}

static void set_sizes(hr2di_transport *t) {
  double root[HR2D_MAX_ORDER];
  for (size_t l = 0; l < t->order; l++) root[l] = sqrt((double)(2 * l + 1));
  for (size_t e = 0; e < t->elements; e++) {
    if (e % 64 == 0 && hr2di_watch_work(t->watch, 64 * (1 + t->width / 16))) return;
    for (size_t b = 0; b < t->bands; b++) {
      double sum = 0;
      for (size_t l = 0; l < t->order; l++)
        sum += root[l] * fabs(t->up[e * t->width + l * t->bands + b]);
      t->shared->size[e * t->bands + b] = sum;
    }
  }
}

/* A gather under way. */
typedef struct pass {
  hr2di_transport *t;
  int distant;                 /* over links of distant pairs alone */
  int first, second;           /* which element of a link receives */
  hr2di_watch own[MOST_PARTS]; /* of parts that the calling thread does not do */
} pass;

static int takes(const pass *p, uint64_t link) {
  return !p->distant || p->t->order == 1 || p->t->blocks.distant[link];
}

static void raise_max(const hr2di_transport *t, uint32_t to, uint32_t from) {
  const double *size = t->shared->size + from * t->bands;
  double *max = t->shared->max + to * t->bands;
  for (size_t b = 0; b < t->bands; b++) max[b] = fmax(max[b], size[b]);
}

/* Finds σ of all elements. */
static void set_scales(const pass *p) {
  hr2di_transport *t = p->t;
  const hr2di_store *store = &t->links->store;
  const size_t values = t->elements * t->bands;
  double *max = t->shared->max;
  memset(max, 0, values * sizeof *max);
  for (uint64_t k = 0; k < store->count; k++) {
    if (k % 64 == 0 && hr2di_watch_work(t->watch, 8 * (1 + t->bands / 4))) break;
    if (!takes(p, k)) continue;
    const hr2d_pair pair = hr2di_store_link(store, k).pair;
    if (p->first) raise_max(t, pair.first, pair.second);
    if (p->second) raise_max(t, pair.second, pair.first);
  }
  t->failed = hr2di_share_combine(t->links->share, hr2di_transport_status(t), HR2D_COMBINE_MOST,
                                  max, values);
  const double weight = hr2di_symmetry_max(&t->hierarchy->scene->symmetry);
  const double root = SLACK * weight * sqrt((double)(2 * t->order - 1));
  for (size_t k = 0; k < values; k++)
    max[k] = hr2di_bin_scale(root * t->hierarchy->element[k / t->bands].length * max[k]);
}

static void add(const hr2di_transport *t, uint32_t to, const double *term) {
  hr2di_bin *bin = t->shared->bin + to * t->width;
  const double *scale = t->shared->max + to * t->bands;
  for (size_t l = 0; l < t->order; l++, bin += t->bands, term += t->bands)
    for (size_t b = 0; b < t->bands; b++) hr2di_bin_add(&bin[b], scale[b], term[b]);
}

static void send_area(const hr2di_transport *t, double area, uint32_t to, uint32_t from) {
  hr2di_bin *bin = t->shared->bin + to * t->bands;
  const double *scale = t->shared->max + to * t->bands, *up = t->up + from * t->bands;
  for (size_t b = 0; b < t->bands; b++) hr2di_bin_add(&bin[b], scale[b], area * up[b]);
}

static void send_block(const hr2di_transport *t, uint64_t k, const hr2d_link *link, int first,
                       int second, double *term) {
  const hr2d_pair pair = link->pair;
  const size_t width = t->width;
  double room[HR2D_MAX_ORDER * HR2D_MAX_ORDER];
  if (!first && !second) return;
  const double *c = hr2di_block_part(t, link, k, room);
  const double *up_i = t->up + pair.first * width, *up_j = t->up + pair.second * width;
  if (!c) return;
  memset(term, 0, 2 * width * sizeof *term);
  if (first && second)
    hr2di_gather_both(c, t->order, t->bands, up_i, up_j, term, term + width);
  else if (first)
    hr2di_gather_block(c, t->order, t->bands, up_j, term);
  else if (second)
    hr2di_gather_transposed(c, t->order, t->bands, up_i, term + width);
  if (first) add(t, pair.first, term);
  if (second) add(t, pair.second, term + width);
}

/* What the elements of a part receive over own links. */
static void gather_part(void *ctx, size_t worker, size_t part) {
  pass *p = ctx;
  const hr2di_transport *t = p->t;
  const hr2di_store *store = &t->links->store;
  const size_t from = t->shared->begin[part], to = t->shared->begin[part + 1], width = t->width;
  hr2di_watch *watch = worker == 0 ? t->watch : &p->own[part];
  if (hr2di_watch_work(watch, (to - from) * width / 64)) return;
  memset(t->shared->bin + from * width, 0, (to - from) * width * sizeof *t->shared->bin);
  for (uint64_t k = 0; k < store->count; k++) {
    if (k % 64 == 0 && hr2di_watch_work(watch, 4 + t->order * width / 2)) return;
    if (!takes(p, k)) continue;
    const hr2d_link link = hr2di_store_link(store, k);
    const hr2d_pair pair = link.pair;
    const int first = p->first && pair.first >= from && pair.first < to;
    const int second = p->second && pair.second >= from && pair.second < to;
    if (t->order > 1) {
      send_block(t, k, &link, first, second, t->shared->term + 2 * part * width);
      continue;
    }
    const double area = hr2di_link_part(t, pair) * link.exchange_area;
    if (first) send_area(t, area, pair.first, pair.second);
    if (second) send_area(t, area, pair.second, pair.first);
  }
}

void hr2di_shared_gather(hr2di_transport *t, hr2di_transport_part part, int sends) {
  const int directed = t->links->directed;
  const size_t field = t->elements * t->width, parts = t->shared->parts;
  pass p = {.t = t,
            .distant = part == HR2DI_DISTANT_LINKS,
            .first = !directed || !sends,
            .second = !directed || sends};
  set_sizes(t);
  set_scales(&p);
  if (t->failed) return;
  for (size_t k = 0; k < parts; k++) hr2di_watch_follow(&p.own[k], t->watch);
  hr2di_team_run(hr2di_team_threads(t->threads), parts, gather_part, &p, t->watch);
  t->failed = hr2di_share_combine(t->links->share, hr2di_transport_status(t), HR2D_COMBINE_SUM,
                                  &t->shared->bin->head, 2 * field);
  for (size_t k = 0; k < field && !t->failed; k++)
    t->down[k] = hr2di_bin_total(&t->shared->bin[k]);
}
