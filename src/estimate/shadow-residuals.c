/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A point sees an element j, with something in the way, up to a place y.  The error b = B − B_h
   there is orthogonal to polynomials, so that the whole of j would hardly send any of it, but
   the visible part sends

     ∫ G b = G(y) β(y) − ∫ β dG,   β = ∫ b from an end of j,

   and β is 0 at both ends.  G is smooth, so that the last term is smaller.  While the point
   moves, y moves over j, and H is off by up to G|β|, to and fro as often as b has zeros.  That
   may happen on a small part of the receiving element, which polynomials on it do not resolve.

   With b = Σ c_l √(2l+1) P_l on an element of length A, |P_{l+1} − P_{l−1}| ≤ 2√(2/(πl)) gives

     |β| ≤ A Σ |c_l| √(2/(πl(2l+1))),   l ≥ 1;

   l = 0 is an error of averages.  G is at most 1/2d at a distance d, and h_i h_j/2d³ for points
   no higher than h above the other's line.  The errors of several elements have signs of their
   own: squares add up. */
#include "estimate/shadow-residuals.h"

#include <math.h>

#include "base/alloc.h"
#include "base/bin.h"
#include "base/pi.h"
#include "base/team.h"
#include "geometry/apart.h"
#include "geometry/predicates.h"
#include "scene/scene-impl.h"

/* An exchange area below this part of that of a clear pair is that of a pair with something in
   the way, and no rounding. */
#define SHADED (1 - 1e-12)

/* |β| of leaves. */
static void integrate_error(const hr2di_estimator *e, double *beta) {
  const hr2di_transport *t = &e->eq.transport;
  for (size_t k = 0; k < t->leaves && !hr2di_watch_work(t->watch, 1 + t->width / 16); k++)
    for (size_t b = 0; b < t->bands; b++) {
      double sum = 0;
      for (size_t l = 1; l < t->order; l++)
        sum += fabs(e->error[k * t->width + l * t->bands + b]) *
               sqrt(2 / (HR2DI_PI * (double)(l * (2 * l + 1))));
      beta[t->leaf[k] * t->bands + b] = sum * t->hierarchy->element[t->leaf[k]].length;
    }
}

/* How far the higher end of j is above the line of i. */
static double height_above(const hr2d_element *i, const hr2d_element *j) {
  return fmax(hr2di_orient(i->a, i->b, j->a), hr2di_orient(i->a, i->b, j->b)) / i->length;
}

/* G at most; infinite where the elements touch. */
static double largest_kernel(const hr2d_element *i, const hr2d_element *j) {
  const double d = hr2di_apart((hr2d_segment){i->a, i->b}, (hr2d_segment){j->a, j->b});
  const double cosines = fmin(1, height_above(i, j) / d * (height_above(j, i) / d));
  return d > 0 ? cosines / (2 * d) : HUGE_VAL;
}

static int is_shaded(const hr2d_link *link, const hr2d_element *i, const hr2d_element *j,
                     double weight) {
  const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
  return fabs(link->exchange_area) < fabs(weight) * SHADED * hr2d_exchange_area(&s, &t);
}

/* Per element and band. */
typedef struct squares {
  double *sum;
  hr2di_bin *bin; /* of shares; NULL: there is but one */
  double scale;   /* σ of these */
} squares;

/* What j may send to a point of i; no more than all of its error from all directions. */
static void add(const hr2di_estimator *e, uint32_t i, uint32_t j, double kernel,
                const double *beta, squares *s) {
  const size_t bands = e->eq.transport.bands;
  i = hr2di_image_map_of(&e->eq.transport.image_map, i);
  for (size_t b = 0; b < bands; b++) {
    const double h = fmin(kernel * beta[j * bands + b], e->max[j * bands + b]);
    if (s->bin)
      hr2di_bin_add(&s->bin[i * bands + b], s->scale, h * h);
    else
      s->sum[i * bands + b] += h * h;
  }
}

/* Links of a task, and of the tasks whose results are kept until they are added. */
enum { TASK = 512, BAND = 64 * TASK };

typedef struct band {
  const hr2di_transport *t;
  uint64_t first;
  size_t count;
  double *kernel; /* per link: G at most, or NONE */
} band;

#define NONE (-HUGE_VAL)

static double kernel_of(const hr2di_transport *t, uint64_t k) {
  if (t->order > 1 && t->links->blocks.distant[k]) return NONE;
  const hr2d_link *link = hr2di_store_at(&t->links->store, k);
  const hr2d_element *i = &t->hierarchy->element[link->pair.first];
  const hr2d_element *j = &t->hierarchy->element[link->pair.second];
  const int shaded = is_shaded(link, i, j, hr2di_linkset_weight(t->links, link->pair));
  return shaded ? largest_kernel(i, j) : NONE;
}

static void find_kernels(void *ctx, size_t worker, size_t task) {
  band *b = ctx;
  const size_t from = task * TASK, to = b->count - from > TASK ? from + TASK : b->count;
  if (worker == 0 && hr2di_watch_work(b->t->watch, TASK)) return;
  for (size_t k = from; k < to; k++) b->kernel[k] = kernel_of(b->t, b->first + k);
}

static void add_band(const hr2di_estimator *e, const band *b, const double *beta, squares *s) {
  for (size_t k = 0; k < b->count; k++) {
    if (b->kernel[k] == NONE) continue;
    const hr2d_pair pair = hr2di_store_at(&b->t->links->store, b->first + k)->pair;
    add(e, pair.first, pair.second, b->kernel[k], beta, s);
    add(e, pair.second, pair.first, b->kernel[k], beta, s);
  }
}

/* Threads share what takes time; sums are in the order of the links. */
static hr2d_status add_links(hr2di_estimator *e, const double *beta, squares *s) {
  const hr2di_transport *t = &e->eq.transport;
  const uint64_t links = t->links->store.count;
  const size_t threads = hr2di_team_threads(t->threads);
  band b = {.t = t, .kernel = hr2di_alloc(&t->alloc, BAND, sizeof *b.kernel)};
  hr2d_status status = b.kernel ? HR2D_OK : HR2D_ENOMEM;
  for (; b.first < links && !status; b.first += BAND) {
    b.count = links - b.first < BAND ? (size_t)(links - b.first) : BAND;
    hr2di_team_run(threads, (b.count + TASK - 1) / TASK, find_kernels, &b, t->watch);
    status = hr2di_watch_work(t->watch, b.count * t->bands / 16);
    if (!status) add_band(e, &b, beta, s);
  }
  hr2di_alloc_free(&t->alloc, b.kernel);
  return status;
}

/* No square is larger than that of the largest error, and no element has more terms than there
   are links: that is enough for those that are near the largest. */
static hr2d_status add_shares(hr2di_estimator *e, const double *beta, squares *s) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t count = t->elements * t->bands;
  double max = 0;
  for (size_t k = 0; k < count; k++) max = fmax(max, e->max[k]);
  const double ends = t->image_map.of ? 2 : 1; /* both may count for the same patch */
  s->scale = hr2di_bin_scale(max * max * ends * (double)t->links->counts.links);
  s->bin = hr2di_alloc_zero(&t->alloc, count, sizeof *s->bin);
  hr2d_status status = s->bin ? add_links(e, beta, s) : HR2D_ENOMEM;
  if (!status) status = hr2di_transport_status(t);
  status = hr2di_share_combine(t->links->share, status, HR2D_COMBINE_SUM,
                               s->bin ? &s->bin->head : NULL, 2 * count);
  for (size_t k = 0; k < count && !status; k++) s->sum[k] = hr2di_bin_total(&s->bin[k]);
  hr2di_alloc_free(&t->alloc, s->bin);
  return status;
}

hr2d_status hr2di_shadow_residuals(hr2di_estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  const hr2d_scene *scene = t->hierarchy->scene;
  const size_t count = t->elements * t->bands;
  if (!scene->effect[HR2D_EFFECT_OCCLUSION].on) return HR2D_OK;
  double *beta = hr2di_alloc_zero(&t->alloc, 2 * count, sizeof *beta);
  if (!beta) return HR2D_ENOMEM;
  double *square = beta + count;
  integrate_error(e, beta);
  hr2di_estimator_set_max(e, e->error);
  squares s = {.sum = square};
  hr2d_status status = HR2D_OK;
  if (t->links->share)
    status = add_shares(e, beta, &s);
  else
    status = add_links(e, beta, &s);
  for (size_t k = 0; k < count && !status; k++) {
    const uint32_t patch = t->hierarchy->element[k / t->bands].patch;
    hr2di_estimator_off(e, e->point, patch, k % t->bands, sqrt(square[k]));
  }
  hr2di_alloc_free(&t->alloc, beta);
  return status ? status : hr2di_watch_status(t->watch);
}
