/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An end v of a patch q at a distance h from a patch p makes a layer in B on both: on p beside
   the foot of v, on q beside v itself, through its image in p.  Both are as wide as h. Elements
   are divided until they resolve them, but become no shorter than some roundings of their
   coordinates.  Below that coefficients show nothing: polynomials of any order miss the layer
   on an element that is much longer.

   There the residual r = B' − B_h is gathered, at distances of h times 0 to 16 from the foot
   and from the end.  Light goes to and fro in the gap.  It leaves a layer to its sides: the
   layer on one patch is seen from the middle of that on the other under REACH of all directions
   or less. So the errors b of B_h are at most

     b_p ≤ (r_p + REACH ρ_p r_q)/(1 − REACH² ρ_p ρ_q),

   and b_q likewise.  A point in the gap may see hardly anything else, so that its H is off by
   them.

   The view from a point is that from its rounded coordinates.  They move it by δ/h of the gap,
   and H by that part of the change of B, in resolved gaps, too, and where nothing reflects. */
#include "estimate/gap-residuals.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/sort.h"
#include "estimate/points-gather.h"
#include "geometry/apart.h"
#include "geometry/bernstein-ellipse.h"
#include "geometry/predicates.h"
#include "scene/panes.h"
#include "solution/solution-impl.h"

/* Of points in the middle of two layers of 8h. */
#define REACH 0.97

/* A point, the leaf that it sees, and the ends of that: coordinates are at most 1. */
#define ROUNDED (4 * DBL_EPSILON)

/* Where residuals are gathered, in units of h. */
static const double place[] = {0, 1, 4, 16, -1, -4, -16};
enum { PLACES = sizeof place / sizeof *place };

/* An end of a patch beside another patch. */
typedef struct gap {
  uint32_t over;    /* the patch p */
  uint32_t end;     /* of q: 2·patch for its start, 2·patch + 1 for its last point */
  uint32_t leaf[2]; /* of p and of q */
  double distance;
  double at;     /* its foot, as a fraction of p */
  double bright; /* the largest B_h of the leaves, in units of its band */
} gap;

typedef struct gaps {
  gap *gap;
  size_t count, capacity;
} gaps;

/* Whether grading could not divide a leaf, whatever is in front of it. */
static int is_shortest(const hr2d_hierarchy *h, uint32_t leaf) {
  const hr2d_element *e = &h->element[leaf];
  const hr2di_patch *p = &h->scene->patch[e->patch];
  return e->length < 1.001 * hr2di_grading_shortest(p) * p->length ||
         !hr2di_element_divisible(h, leaf);
}

/* The mirror image of a point in the line of a patch. */
static hr2d_point image_in(const hr2di_patch *p, hr2d_point v) {
  const hr2d_point u = hr2di_point_minus(p->scaled.b, p->scaled.a);
  const double off = hr2di_orient(p->scaled.a, p->scaled.b, v) / p->length / p->length;
  return (hr2d_point){v.x + 2 * off * u.y, v.y - 2 * off * u.x};
}

static int is_near(const hr2d_element *e, hr2d_point v) {
  return hr2di_ellipse((hr2d_segment){e->a, e->b}, v) < HR2DI_ELLIPSE_DISTANT;
}

/* The largest B_h on the two leaves of a gap. */
static double brightness(const hr2di_estimator *e, const gap *g, size_t band) {
  const size_t bands = e->eq.transport.bands;
  return fmax(e->max[g->leaf[0] * bands + band], e->max[g->leaf[1] * bands + band]);
}

/* The gap between leaf i and an end v of the patch of leaf j. */
static gap gap_between(const hr2di_estimator *e, uint32_t i, uint32_t j, int last,
                       hr2d_point v) {
  const hr2d_hierarchy *h = e->eq.transport.hierarchy;
  const hr2di_patch *p = &h->scene->patch[h->element[i].patch];
  const hr2d_point u = hr2di_point_minus(p->scaled.b, p->scaled.a);
  gap g = {.over = h->element[i].patch,
           .end = 2 * h->element[j].patch + (uint32_t)last,
           .leaf = {i, j}};
  g.at = hr2di_point_dot(hr2di_point_minus(v, p->scaled.a), u) / p->length / p->length;
  g.distance = hr2di_apart_from_point(p->scaled, v);
  for (size_t b = 0; b < e->eq.transport.bands; b++)
    g.bright = fmax(g.bright, brightness(e, &g, b));
  return g;
}

/* Whether one of two leaves is too long for the layer that an end v of the second one makes. */
static int is_unresolved(const hr2d_hierarchy *h, const gap *g, uint32_t i, uint32_t j,
                         hr2d_point v) {
  const hr2d_element *element = h->element;
  if (is_shortest(h, i) && is_near(&element[i], v)) return 1;
  return g->at > 0 && g->at < 1 && is_shortest(h, j) &&
         is_near(&element[j], image_in(&h->scene->patch[g->over], v));
}

static int reflects(const hr2d_scene *scene, uint32_t patch) {
  for (size_t b = 0; b < scene->bands; b++)
    if (hr2di_pane_scattered(scene, patch, b) > 0) return 1;
  return 0;
}

/* What rounded coordinates may do to H beside a gap. */
static double rounding_at(const hr2di_estimator *e, const gap *g, size_t band) {
  return ROUNDED / g->distance * brightness(e, g, band);
}

static void add_rounding(const hr2di_estimator *e, const gap *g) {
  const hr2d_scene *scene = e->eq.transport.hierarchy->scene;
  for (size_t b = 0; b < e->eq.transport.bands; b++) {
    const double rounding = rounding_at(e, g, b);
    const double rho = fmax(hr2di_pane_scattered(scene, g->over, b),
                            hr2di_pane_scattered(scene, g->end / 2, b));
    e->stray[0][b] = fmax(e->stray[0][b], rho * rounding);
    e->stray[1][b] = fmax(e->stray[1][b], rounding);
  }
}

/* Lists the gaps between leaf i and the ends of the patch of leaf j. */
static hr2d_status find(const hr2di_estimator *e, uint32_t i, uint32_t j, gaps *all) {
  const hr2d_hierarchy *h = e->eq.transport.hierarchy;
  const hr2d_element *element = h->element;
  const hr2d_segment q = h->scene->patch[element[j].patch].scaled;
  for (int last = 0; last < 2; last++) {
    const hr2d_point v = last ? q.b : q.a;
    if (!hr2di_point_same(v, last ? element[j].b : element[j].a)) continue;
    const gap g = gap_between(e, i, j, last, v);
    if (g.distance <= HR2DI_TOUCH) continue;
    add_rounding(e, &g);
    if (!reflects(h->scene, g.over) || !is_unresolved(h, &g, i, j, v)) continue;
    if (hr2di_alloc_reserve(&e->eq.transport.alloc, &all->gap, &all->capacity, all->count + 1,
                            sizeof *all->gap))
      return HR2D_ENOMEM;
    all->gap[all->count++] = g;
  }
  return HR2D_OK;
}

static int by_place(const void *left, const void *right) {
  const gap *l = left, *r = right;
  if (l->over != r->over) return l->over < r->over ? -1 : 1;
  if (l->end != r->end) return l->end < r->end ? -1 : 1;
  if (l->bright != r->bright) return l->bright > r->bright ? -1 : 1;
  if (l->leaf[0] != r->leaf[0]) return l->leaf[0] < r->leaf[0] ? -1 : 1;
  return (l->leaf[1] > r->leaf[1]) - (l->leaf[1] < r->leaf[1]);
}

static int by_brightness(const void *left, const void *right) {
  const gap *l = left, *r = right;
  if (l->bright != r->bright) return l->bright > r->bright ? -1 : 1;
  return by_place(left, right);
}

/* Several leaves see the same end: the brightest stays. */
static hr2d_status sort(gaps *all, hr2di_watch *watch) {
  size_t kept = 0;
  const hr2d_status status =
      hr2di_sort(all->gap, all->count, sizeof *all->gap, by_place, watch);
  if (status) return status;
  for (size_t k = 0; k < all->count; k++)
    if (k == 0 || all->gap[k].over != all->gap[k - 1].over ||
        all->gap[k].end != all->gap[k - 1].end)
      all->gap[kept++] = all->gap[k];
  all->count = kept;
  return hr2di_sort(all->gap, kept, sizeof *all->gap, by_brightness, watch);
}

/* The numbers of a gap. */
enum { NUMBERS = 7 };

static gap read_gap(const double *number) {
  return (gap){.over = (uint32_t)number[0],
               .end = (uint32_t)number[1],
               .leaf = {(uint32_t)number[2], (uint32_t)number[3]},
               .distance = number[4],
               .at = number[5],
               .bright = number[6]};
}

/* The gaps of all shares; sorting puts them in order. */
static hr2d_status collect(hr2di_estimator *e, gaps *all, hr2d_status status) {
  const hr2di_transport *t = &e->eq.transport;
  double *record = hr2di_alloc(&t->alloc, all->count, NUMBERS * sizeof *record);
  size_t count = all->count;
  if (!status) status = record ? hr2di_transport_status(t) : HR2D_ENOMEM;
  for (size_t k = 0; k < count && !status; k++) {
    const gap *g = &all->gap[k];
    const double number[NUMBERS] = {g->over,     g->end, g->leaf[0], g->leaf[1],
                                    g->distance, g->at,  g->bright};
    memcpy(record + k * NUMBERS, number, sizeof number);
  }
  for (int h = 0; h < 2; h++)
    status =
        hr2di_share_combine(t->links->share, status, HR2D_COMBINE_MOST, e->stray[h], t->bands);
  status = hr2di_share_collect(t->links->share, status, &t->alloc, &record, &count, NUMBERS);
  if (!status &&
      hr2di_alloc_reserve(&t->alloc, &all->gap, &all->capacity, count, sizeof *all->gap))
    status = HR2D_ENOMEM;
  all->count = status ? 0 : count;
  for (size_t k = 0; k < all->count; k++) all->gap[k] = read_gap(record + k * NUMBERS);
  hr2di_alloc_free(&t->alloc, record);
  return status;
}

static hr2d_status find_all(hr2di_estimator *e, gaps *all) {
  const hr2di_transport *t = &e->eq.transport;
  const hr2d_element *element = t->hierarchy->element;
  hr2d_status status = HR2D_OK;
  hr2di_estimator_set_max(e, e->kept);
  for (uint64_t k = 0; k < t->links->store.count && !status; k++) {
    if (t->order > 1 && t->links->blocks.distant[k]) continue;
    const hr2d_pair pair = hr2di_store_at(&t->links->store, k)->pair;
    if (element[pair.first].child || element[pair.second].child) continue;
    status = hr2di_watch_work(t->watch, 1);
    if (!status) status = find(e, pair.first, pair.second, all);
    if (!status) status = find(e, pair.second, pair.first, all);
  }
  if (t->links->share) status = collect(e, all, status);
  return status ? status : sort(all, t->watch);
}

/* The places beside one side of a gap; the number of them. */
static size_t list_places(const hr2di_estimator *e, const gap *g, int other, hr2di_place *to) {
  const hr2di_image_map *image_map = &e->eq.transport.image_map;
  const uint32_t beside = other ? g->end / 2 : g->over;
  const double from = other ? g->end % 2 : fmin(fmax(g->at, 0), 1);
  const double step = g->distance / e->eq.transport.hierarchy->scene->patch[beside].length;
  const int turned = image_map->of && image_map->odd[beside];
  size_t count = 0;
  for (size_t k = 0; k < PLACES; k++) {
    const double along = from + place[k] * step, at = turned ? 1 - along : along;
    if (at >= 0 && at <= 1) /* not where the patch is dust */
      to[count++] = (hr2di_place){hr2di_image_map_of(image_map, beside), at};
  }
  return count;
}

/* The largest |B' − B_h| at places, in units of the equation. */
static double worst_of(const hr2di_estimator *e, const hr2di_place *at, size_t count,
                       const double *value, size_t band) {
  double worst = 0;
  for (size_t k = 0; k < count; k++) {
    const double off = value[k * e->eq.transport.bands + band] -
                       hr2d_solution_at(e->coarse, at[k].patch, at[k].at, band);
    worst = fmax(worst, fabs(ldexp(off, -e->eq.exponent[band])));
  }
  return worst;
}

/* H at a point of a patch is off by `error`, and by `rounding`. */
static void add(hr2di_estimator *e, size_t patch, size_t band, double error, double rounding) {
  const double rho = hr2di_pane_scattered(e->eq.transport.hierarchy->scene, patch, band);
  hr2di_estimator_off(e, e->narrow, patch, band, error);
  /* Elements cannot be shorter because of roundings. */
  e->stray[1][band] = fmax(e->stray[1][band], error + rounding);
  e->stray[0][band] = fmax(e->stray[0][band], rho * (error + rounding));
}

/* The places of the brightest gaps. */
typedef struct places {
  hr2di_place at[2 * HR2DI_CHOICE_GAPS * PLACES];
  size_t count[2 * HR2DI_CHOICE_GAPS]; /* per side of a gap */
  size_t all;
} places;

static void add_gap(hr2di_estimator *e, const gap *g, const hr2di_place *at,
                    const size_t *count, const double *value) {
  const hr2d_scene *scene = e->eq.transport.hierarchy->scene;
  const size_t bands = e->eq.transport.bands, q = g->end / 2;
  for (size_t b = 0; b < bands; b++) {
    const double of_p = worst_of(e, at, count[0], value, b);
    const double of_q = worst_of(e, at + count[0], count[1], value + count[0] * bands, b);
    const double rho_p = hr2di_pane_scattered(scene, g->over, b);
    const double rho_q = hr2di_pane_scattered(scene, q, b);
    const double more = 1 / (1 - REACH * REACH * rho_p * rho_q);
    const double rounding = rounding_at(e, g, b);
    add(e, q, b, more * (of_p + REACH * rho_p * of_q), rounding);
    add(e, g->over, b, more * (of_q + REACH * rho_q * of_p), rounding);
  }
}

static hr2d_status gather(hr2di_estimator *e, const gap *list, size_t some) {
  const hr2di_transport *t = &e->eq.transport;
  places p = {.all = 0};
  for (size_t k = 0; k < 2 * some; k++) {
    p.count[k] = list_places(e, &list[k / 2], k % 2, p.at + p.all);
    p.all += p.count[k];
  }
  double *value = hr2di_alloc(&t->alloc, p.all, t->bands * sizeof *value);
  if (!value) return HR2D_ENOMEM;
  const hr2d_status status =
      hr2di_points_gather(e->coarse, p.at, p.all, t->threads, value, t->watch);
  for (size_t k = 0, from = 0; k < some && !status; k++) {
    add_gap(e, &list[k], p.at + from, &p.count[2 * k], value + from * t->bands);
    from += p.count[2 * k] + p.count[2 * k + 1];
  }
  hr2di_alloc_free(&t->alloc, value);
  return status;
}

/* Nothing is known of a gap where nothing is gathered. */
static void add_unknown(hr2di_estimator *e, const gap *g) {
  for (size_t b = 0; b < e->eq.transport.bands; b++)
    for (int side = 0; side < 2; side++)
      add(e, side ? g->over : g->end / 2, b, brightness(e, g, b), 0);
}

hr2d_status hr2di_gap_residuals(hr2di_estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t max = t->hierarchy->scene->patches > HR2DI_CHOICE_CONTACTS_PATCHES
                         ? HR2DI_CHOICE_GAPS_LARGE
                         : HR2DI_CHOICE_GAPS;
  gaps all = {0};
  hr2d_status status = find_all(e, &all);
  if (!status && all.count > 0) status = gather(e, all.gap, all.count < max ? all.count : max);
  if (all.count > max && !status) add_unknown(e, &all.gap[max]);
  hr2di_alloc_free(&t->alloc, all.gap);
  return status ? status : hr2di_watch_status(t->watch);
}
