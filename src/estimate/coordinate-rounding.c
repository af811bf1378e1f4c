/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks take the places of elements from fractions of their patches, with more digits than
   coordinates.  What halves and quarters alone have made is in its place.  Other fractions are
   rounded: δ is how far an element is off its place, or its coordinates are, up to a rounding.
   Far from the origin that is much in terms of small elements.  Let d be the distance of a pair
   of elements, of lengths A_i and A_j, or the shorter length if that is more.

   G ≤ 1/2r, and a shift of either point by δ changes G by no more than 2δ/r². Where r ≥ d,
   ∫1/r² over a line is at most π/d, so that the exchange area changes by

     ΔAF ≤ 2(δ_i + δ_j) min(A_i A_j/d², 4 min(A_i, A_j)/d),

   and no AF is more than the shorter length.  Coordinates count for all elements where they
   decide: which walls are in the way, and where elements touch.  Elements of patches with a
   common end are measured from there, to all digits.

   With δ = ΔAF/A_i the irradiance of i from j is off by δB_j, but rows of K, closure and the
   background add up to 1, so that what one of them has more another one has less:
   - on a patch whose row sum closure makes 1, by δ(B_j − B_i);
   - on one that sees a background of radiosity L, by δ(B_j − L).
   H as it is told has the mean of H in the place of that of B, closure-mean.c: on a closed
   patch it is off by δ(B_j − a), a = H̄ + B_i − B̄ = (1−ρ)H̄ + ρH_i.
   None of these is negative, so that a difference is at most the larger of two. */
#include "estimate/coordinate-rounding.h"

#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "estimate/shared-sums.h"
#include "geometry/apart.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

/* How far a point is off its place at fraction `at` of a patch, from its nearer end. */
static double distance_off(const hr2di_patch *p, double at, hr2d_point is) {
  const hr2d_segment s = p->scaled;
  const hr2d_point from = at <= 0.5 ? s.a : s.b;
  const hr2d_point along = hr2di_point_minus(s.b, s.a), off = hr2di_point_minus(is, from);
  const double t = at <= 0.5 ? at : at - 1;
  const double seen = hypot(fma(-t, along.x, off.x), fma(-t, along.y, off.y));
  return seen + 0.5 * DBL_EPSILON * fabs(t) * p->length;
}

static double offset_of(const hr2d_hierarchy *h, uint32_t element) {
  const hr2d_element *e = &h->element[element];
  const hr2di_patch *p = &h->scene->patch[e->patch];
  const double from = hr2di_element_start(h, element), to = from + e->length / p->length;
  return fmax(distance_off(p, from, e->a), distance_off(p, fmin(to, 1), e->b));
}

static double distance_of(const hr2d_element *i, const hr2d_element *j) {
  return fmax(hr2di_apart((hr2d_segment){i->a, i->b}, (hr2d_segment){j->a, j->b}),
              fmin(i->length, j->length));
}

/* Whether blocks measure elements of these patches from their common end. */
static int have_corner(const hr2d_scene *scene, uint32_t i, uint32_t j) {
  const hr2d_segment p = scene->patch[i].scaled, q = scene->patch[j].scaled;
  return hr2di_point_same(p.b, q.a) || hr2di_point_same(p.a, q.b);
}

/* How far elements are off. */
typedef struct offsets {
  double *offset;       /* δ by coordinates */
  unsigned char *exact; /* halves and quarters alone have made it */
} offsets;

/* ΔAF; `decide` where coordinates count for all elements. */
static double exchange_off(hr2d_pair pair, const hr2d_element *element, const offsets *is,
                           int decide) {
  const hr2d_element *i = &element[pair.first], *j = &element[pair.second];
  const double off = (decide || !is->exact[pair.first] ? is->offset[pair.first] : 0) +
                     (decide || !is->exact[pair.second] ? is->offset[pair.second] : 0);
  if (!(off > 0)) return 0;
  const double distance = distance_of(i, j), shorter = fmin(i->length, j->length);
  const double area = fmin(i->length * (j->length / distance), 4 * shorter) / distance;
  return fmin(2 * off * area, shorter);
}

typedef struct gather {
  const hr2di_levels *levels;
  const double *own[2];    /* what stands for B_i, elements × bands */
  unsigned char *has_sky;  /* elements: a leaf below sees the background */
  double *error[2];        /* elements × bands */
  hr2di_shared_sums *sums; /* of both */
} gather;

static void find_sky(const hr2di_transport *t, unsigned char *has_sky) {
  const hr2d_element *e = t->hierarchy->element;
  for (size_t k = 0; k < t->leaves * t->order && t->sky; k++)
    if (t->sky[k] != 0) has_sky[t->leaf[k / t->order]] = 1;
  for (size_t k = t->elements; k-- > 0;)
    if (e[k].child) has_sky[k] = has_sky[e[k].child] | has_sky[e[k].child + 1];
}

/* What the second of a pair does to the irradiance of the first. */
static void add_pair(const hr2di_transport *t, double off, const gather *g, uint32_t i,
                     uint32_t j) {
  const hr2d_element *e = &t->hierarchy->element[i];
  const int closed = t->closed && t->closed[e->patch];
  for (size_t b = 0; b < t->bands; b++) {
    const double light = g->has_sky[i] ? g->levels->light[b] : 0;
    const double other = fmax(g->levels->max[j * t->bands + b], light);
    for (int report = 0; report < 2; report++) {
      const double own = closed ? g->own[report][i * t->bands + b] : 0;
      hr2di_shared_sums_add(g->sums, ((size_t)report * t->elements + i) * t->bands + b,
                            off / e->length * fmax(other, own));
    }
  }
}

/* The exchange area of a pair that is hidden or clipped in part is known to this part of the
   shorter length (tests/unit/occlusion/check-visibility.c). */
#define AREA_ROUNDING 1e-14

static int touch(const hr2d_element *i, const hr2d_element *j) {
  return hr2di_point_same(i->b, j->a) || hr2di_point_same(i->a, j->b);
}

static double link_off(const hr2di_transport *t, uint64_t link, const offsets *places) {
  const hr2d_scene *scene = t->hierarchy->scene;
  const int hides =
      scene->effect[HR2D_EFFECT_OCCLUSION].on || scene->effect[HR2D_EFFECT_FACING].on;
  const int distant = t->order > 1 && t->links->blocks.distant[link];
  const hr2d_pair pair = hr2di_store_at(&t->links->store, link)->pair;
  const hr2d_element *e = t->hierarchy->element;
  const hr2d_element *i = &e[pair.first], *j = &e[pair.second];
  double off = 0;
  if (t->order == 1 || !have_corner(scene, i->patch, j->patch))
    off = exchange_off(pair, e, places, t->order == 1 || (!distant && (hides || touch(i, j))));
  return hides && !distant ? off + AREA_ROUNDING * fmin(i->length, j->length) : off;
}

static void add_links(const hr2di_transport *t, const offsets *places, const gather *g) {
  for (uint64_t k = 0; k < t->links->store.count && !hr2di_watch_work(t->watch, 1); k++) {
    const hr2d_pair pair = hr2di_store_at(&t->links->store, k)->pair;
    const double off = link_off(t, k, places) * fabs(hr2di_linkset_weight(t->links, pair));
    const uint32_t i = hr2di_image_map_of(&t->image_map, pair.first),
                   j = hr2di_image_map_of(&t->image_map, pair.second);
    add_pair(t, off, g, i, j);
    if (!t->links->directed) add_pair(t, off, g, j, i);
  }
}

/* Of shares, links are looked at twice. */
static hr2d_status add_all_links(const hr2di_transport *t, const offsets *places,
                                 const gather *g) {
  hr2d_status status;
  int again;
  do {
    add_links(t, places, g);
    status = hr2di_shared_sums_end(g->sums, hr2di_transport_status(t), &again);
  } while (again);
  return status;
}

/* What an element gets, its children get. */
static void lower(const hr2di_transport *t, double *error) {
  const hr2d_element *e = t->hierarchy->element;
  for (size_t k = 0; k < t->elements; k++)
    for (size_t m = 0; m < 2 * t->bands && e[k].child; m++)
      error[e[k].child * t->bands + m] += error[k * t->bands + m % t->bands];
}

static void find_places(const hr2d_hierarchy *h, offsets *is, hr2di_watch *watch) {
  for (uint32_t k = 0; k < h->elements && !hr2di_watch_work(watch, 1); k++) {
    const uint32_t parent = h->parent[k];
    is->offset[k] = offset_of(h, k);
    const double part = parent == k ? 0.5 : hr2di_element_left_part(h->element, parent);
    is->exact[k] = parent == k || (is->exact[parent] && 4 * part == rint(4 * part));
  }
}

static void add_leaves(const hr2di_transport *t, const double *all, double *error) {
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t b = 0; b < t->bands; b++)
      error[k * t->bands + b] += all[t->leaf[k] * t->bands + b];
}

hr2d_status hr2di_coordinates_add(const hr2di_transport *t, const hr2di_levels *levels,
                                  double *const error[2]) {
  const size_t values = t->elements * t->bands;
  offsets places = {hr2di_alloc(&t->alloc, t->elements, sizeof *places.offset),
                    hr2di_alloc_zero(&t->alloc, t->elements, 1)};
  double *all = hr2di_alloc_zero(&t->alloc, values, 2 * sizeof *all);
  hr2di_shared_sums sums;
  hr2d_status status =
      hr2di_shared_sums_init(&sums, t->links->share, &t->alloc, all, 2 * values);
  const gather g = {levels,
                    {levels->max, levels->own},
                    hr2di_alloc_zero(&t->alloc, t->elements, 1),
                    {all, all ? all + values : NULL},
                    &sums};
  if (!places.offset || !places.exact || !all || !g.has_sky) status = HR2D_ENOMEM;
  if (!status) {
    find_sky(t, g.has_sky);
    find_places(t->hierarchy, &places, t->watch);
    status = add_all_links(t, &places, &g);
  }
  for (int report = 0; report < 2 && !status; report++) {
    lower(t, g.error[report]);
    add_leaves(t, g.error[report], error[report]);
  }
  hr2di_shared_sums_clear(&sums);
  hr2di_alloc_free(&t->alloc, places.offset);
  hr2di_alloc_free(&t->alloc, places.exact);
  hr2di_alloc_free(&t->alloc, all);
  hr2di_alloc_free(&t->alloc, g.has_sky);
  return status ? status : hr2di_watch_status(t->watch);
}
