/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ends of an element are doubles, and off their places on the patch by δ, up to a rounding
   of the coordinates; far from the origin that is much in terms of small elements. Let d be the
   distance of a pair of elements, of lengths A_i and A_j, or the shorter length if that is
   more.

   G ≤ 1/2r, and a shift of either point by δ changes G by no more than 2δ/r². Where r ≥ d,
   ∫1/r² over a line is at most π/d, so that the exchange area changes by

     ΔAF ≤ 2(δ_i + δ_j) min(A_i A_j/d², 4 min(A_i, A_j)/d).

   Where a block has the exchange area of the coordinates, its elements are longer or shorter,
   too, by δ/A of their lengths: that adds (δ_i/A_i + δ_j/A_j) AF. No AF is more than the
   shorter length. Elements of patches with a common end are measured from there, to all digits.

   With δ = ΔAF/A_i the irradiance of i from j is off by δB_j, but rows of K, closure and the
   background add up to 1, so that what one of them has more another one has less:
   - on a patch whose row sum closure makes 1, by δ(B_j − B_i);
   - on one that sees a background of radiosity L, by δ(B_j − L);
   - by δ(B_i − L) more, where closure corrects a distant pair whose block has another exchange
     area than the frame from which both form factors are integrated.
   None of these is negative, so that a difference is at most the larger of two. */
#include "accuracy/coordinate-rounding.h"

#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "geometry/vector.h"
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

static double distance_from(const hr2d_element *e, hr2d_point v) {
  const hr2d_point u = hr2di_point_minus(e->b, e->a), w = hr2di_point_minus(v, e->a);
  const double square = hr2di_point_dot(u, u);
  const double t = square > 0 ? fmin(fmax(hr2di_point_dot(u, w) / square, 0), 1) : 0;
  return hypot(w.x - t * u.x, w.y - t * u.y);
}

/* Elements of a link do not cross, so that an end is nearest. */
static double distance_of(const hr2d_element *i, const hr2d_element *j) {
  const double ends = fmin(fmin(distance_from(i, j->a), distance_from(i, j->b)),
                           fmin(distance_from(j, i->a), distance_from(j, i->b)));
  return fmax(ends, fmin(i->length, j->length));
}

/* Whether blocks measure elements of these patches from their common end. */
static int have_corner(const hr2d_scene *scene, uint32_t i, uint32_t j) {
  const hr2d_segment p = scene->patch[i].scaled, q = scene->patch[j].scaled;
  return hr2di_point_same(p.b, q.a) || hr2di_point_same(p.a, q.b);
}

/* ΔAF; `plain` where the block has the exchange area of the coordinates. */
static double exchange_off(const hr2d_link *link, const hr2d_element *element,
                           const double *offset, int plain) {
  const hr2d_element *i = &element[link->pair.first], *j = &element[link->pair.second];
  const double off_i = offset[link->pair.first], off_j = offset[link->pair.second];
  const double distance = distance_of(i, j), shorter = fmin(i->length, j->length);
  const double area = fmin(i->length * (j->length / distance), 4 * shorter) / distance;
  const double longer = off_i / i->length + off_j / j->length;
  return fmin(2 * (off_i + off_j) * area + (plain ? longer * link->exchange_area : 0), shorter);
}

typedef struct levels {
  const double *most;     /* |B| of elements, elements × bands */
  const double *light;    /* L, per band */
  unsigned char *has_sky; /* elements: a leaf below sees the background */
} levels;

static void find_sky(const hr2di_transport *t, unsigned char *has_sky) {
  const hr2d_element *e = t->hierarchy->element;
  for (size_t k = 0; k < t->leaves * t->order && t->sky; k++)
    if (t->sky[k] != 0) has_sky[t->leaf[k / t->order]] = 1;
  for (size_t k = t->elements; k-- > 0;)
    if (e[k].child) has_sky[k] = has_sky[e[k].child] | has_sky[e[k].child + 1];
}

/* What the second of a pair does to the irradiance of the first; `corrected` where closure has
   another form factor of the pair. */
static void add_pair(const hr2di_transport *t, double off, int corrected, const levels *is,
                     uint32_t i, uint32_t j, double *error) {
  const hr2d_element *e = &t->hierarchy->element[i];
  const int closed = t->closed && t->closed[e->patch];
  for (size_t b = 0; b < t->bands; b++) {
    const double light = is->has_sky[i] ? is->light[b] : 0;
    const double other = fmax(is->most[j * t->bands + b], light);
    const double own = fmax(t->closure ? is->most[i * t->bands + b] : 0, light);
    const double sum = closed ? fmax(other, own) : other + (corrected ? own : 0);
    error[i * t->bands + b] += off / e->length * sum;
  }
}

/* The exchange area of a pair that is hidden or clipped in part is known to this part of the
   shorter length (tests/unit/occlusion/check-visibility.c). */
#define HIDDEN 1e-14

static void add_links(const hr2di_transport *t, const double *offset, const levels *is,
                      double *error) {
  const hr2d_hierarchy *h = t->hierarchy;
  const hr2di_link_blocks *blocks = &t->links->blocks;
  const int hides =
      h->scene->effect[HR2D_EFFECT_OCCLUSION].on || h->scene->effect[HR2D_EFFECT_FACING].on;
  for (uint64_t k = 0; k < t->links->store.count && !hr2di_watch_work(t->watch, 1); k++) {
    const hr2d_link *link = hr2di_store_at(&t->links->store, k);
    const uint32_t i = link->pair.first, j = link->pair.second;
    const int plain =
        t->order == 1 || blocks->value[k * t->order * t->order] == link->exchange_area;
    const int corner =
        !plain && have_corner(h->scene, h->element[i].patch, h->element[j].patch);
    double off = offset[i] + offset[j] > 0 && !corner
                     ? exchange_off(link, h->element, offset, plain)
                     : 0;
    const int distant = t->order > 1 && blocks->distant[k];
    if (hides && !distant) off += HIDDEN * fmin(h->element[i].length, h->element[j].length);
    add_pair(t, off, distant && plain, is, i, j, error);
    if (!t->links->directed) add_pair(t, off, distant && plain, is, j, i, error);
  }
}

/* What an element gets, its children get. */
static void lower(const hr2di_transport *t, double *error) {
  const hr2d_element *e = t->hierarchy->element;
  for (size_t k = 0; k < t->elements; k++)
    for (size_t m = 0; m < 2 * t->bands && e[k].child; m++)
      error[e[k].child * t->bands + m] += error[k * t->bands + m % t->bands];
}

hr2d_status hr2di_coordinates_add(const hr2di_transport *t, const double *most,
                                  const double *light, double *error) {
  double *offset = hr2di_alloc(&t->alloc, t->elements, sizeof *offset);
  double *all = hr2di_alloc_zero(&t->alloc, t->elements, t->bands * sizeof *all);
  levels is = {most, light, hr2di_alloc_zero(&t->alloc, t->elements, 1)};
  const int room = offset && all && is.has_sky;
  if (room) {
    find_sky(t, is.has_sky);
    for (uint32_t k = 0; k < t->elements && !hr2di_watch_work(t->watch, 1); k++)
      offset[k] = offset_of(t->hierarchy, k);
    add_links(t, offset, &is, all);
    lower(t, all);
    for (size_t k = 0; k < t->leaves; k++)
      for (size_t b = 0; b < t->bands; b++)
        error[k * t->bands + b] += all[t->leaf[k] * t->bands + b];
  }
  hr2di_alloc_free(&t->alloc, offset);
  hr2di_alloc_free(&t->alloc, all);
  hr2di_alloc_free(&t->alloc, is.has_sky);
  return room ? hr2di_watch_status(t->watch) : HR2D_ENOMEM;
}
