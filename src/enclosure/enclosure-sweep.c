/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each sweep takes H of all leaves from the ranges of B, by the two formulas of enclosure.h,
   and narrows B by E + ρH.  The true B is inside before, and so it is after.

   Ranges at points are strips between two straight lines.  Of F and B between lines the
   covariance is that of the middle lines, which is exact, and a rest: |cov(f, g)| is at most
   the product of the standard deviations of f and g.

   A sum of n terms, none negative, in doubles is off by n roundings of itself; so are its
   terms, by a few.  The margin has the upper ends for both, which are the larger sums.

   What is not covered by factors sees the background, or a back, which is black.  */
#include "enclosure/enclosure-sweep.h"

#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"

/* Roundings of a term, beside one for each sum. */
enum { TERM = 16 };

/* A sweep that takes less of the sum of all ranges than this is the last one: 50 of them would
   take a factor of 1.6. */
#define SLOW 0.01

int hr2di_enclosing_has(const hr2di_enclosing *e, uint32_t element) {
  const hr2d_element *at = &e->hierarchy->element[element];
  return !at->child && at->patch < hr2di_scene_cell(e->scene);
}

static hr2di_range narrower(hr2di_range a, hr2di_range b) {
  return (hr2di_range){fmax(a.lower, b.lower), fmin(a.upper, b.upper)};
}

static void add(hr2di_range *sum, double lower, double upper) {
  sum->lower += lower;
  sum->upper += upper;
}

static double min_of(const hr2di_strip *s) {
  return fmax(0, fmin(s->at[0].lower, s->at[1].lower));
}

static double max_of(const hr2di_strip *s) {
  return fmax(s->at[0].upper, s->at[1].upper);
}

static hr2di_range mean_of(const hr2di_strip *s) {
  return (hr2di_range){0.5 * (s->at[0].lower + s->at[1].lower),
                       0.5 * (s->at[0].upper + s->at[1].upper)};
}

/* Half the height of a strip at its higher end. */
static double half_of(const hr2di_strip *s) {
  return 0.5 * fmax(s->at[0].upper - s->at[0].lower, s->at[1].upper - s->at[1].lower);
}

/* How much the middle of a strip rises. */
static double rise_of(const hr2di_strip *s) {
  return 0.5 * (s->at[1].lower + s->at[1].upper) - 0.5 * (s->at[0].lower + s->at[0].upper);
}

/* The standard deviation of a straight line is its rise by √12; that of what is left of a
   function is at most half the height of its strip. */
#define ROOT_12 3.4641016151377544

hr2di_covariance hr2di_covariance_of(const hr2di_strip *f, const hr2di_strip *b) {
  const double slope = rise_of(f), slant = rise_of(b), w = half_of(b);
  return (hr2di_covariance){slope * slant / 12, fabs(slope) / ROOT_12 * w +
                                                    half_of(f) * (fabs(slant) / ROOT_12 + w)};
}

/* Adds to both lines of a strip: of two lower lines that with the larger mean, likewise of two
   upper ones.  `off` is the covariance of G and B, or more. */
static void add_at_points(const hr2di_strip *f, const hr2di_lit_range *b, double off,
                          hr2di_strip *sum) {
  const hr2di_range mean = mean_of(f);
  const double lower = min_of(&b->point), upper = max_of(&b->point);
  const int low = mean.lower * b->mean.lower - off > mean.lower * lower;
  const int high = mean.upper * b->mean.upper + off < mean.upper * upper;
  for (int k = 0; k < 2; k++)
    add(&sum->at[k], f->at[k].lower * (low ? b->mean.lower : lower) - (low ? off : 0),
        f->at[k].upper * (high ? b->mean.upper : upper) + (high ? off : 0));
}

/* The mean factor from an element of this length, with what is known of it at points. */
static hr2di_range mean_factor(const hr2di_enclosed_link *l, int to, double length) {
  const hr2di_range mean = {l->area.lower / length, l->area.upper / length};
  return narrower(mean, mean_of(&l->factor[to]));
}

/* What the element `to` of a link gets from the other one, whose B has the range b. */
static void gather(const hr2di_enclosed_link *l, int to, const double *length,
                   const hr2di_lit_range *b, hr2di_lit_range *h) {
  const hr2di_range mean = mean_factor(l, to, length[to]);
  const hr2di_covariance c = hr2di_covariance_of(&l->factor[!to], &b->point);
  const double part = length[!to] / length[to];
  add(&h->mean,
      fmax(mean.lower * min_of(&b->point),
           mean.lower * b->mean.lower + part * (c.value - c.off)),
      fmin(mean.upper * max_of(&b->point),
           mean.upper * b->mean.upper + part * (c.value + c.off)));
  const double deviation = fabs(rise_of(&b->point)) / ROOT_12 + half_of(&b->point);
  const double off = deviation > 0 ? 0.5 * length[!to] * l->spread * deviation : 0;
  add_at_points(&l->factor[to], b, off, &h->point);
}

static void gather_link(hr2di_enclosing *e, const hr2di_enclosed_link *l) {
  const hr2d_element *element = e->hierarchy->element;
  const double length[2] = {element[l->of[0]].length, element[l->of[1]].length};
  const size_t first = l->of[0] * e->bands, second = l->of[1] * e->bands;
  for (size_t b = 0; b < e->bands; b++) {
    gather(l, 0, length, &e->b[second + b], &e->h[first + b]);
    gather(l, 1, length, &e->b[first + b], &e->h[second + b]);
  }
}

/* Sums with their roundings. */
static void finish(hr2di_lit_range *h, uint32_t terms) {
  const double margin =
      (terms + (double)TERM) * DBL_EPSILON * fmax(h->mean.upper, max_of(&h->point));
  for (int k = 0; k < 2; k++) add(&h->point.at[k], -margin, margin);
  add(&h->mean, -margin, margin);
  h->mean = narrower(h->mean, mean_of(&h->point));
  h->mean.lower = fmax(0, h->mean.lower);
}

static void add_background(const hr2di_enclosing *e, uint32_t leaf, size_t band,
                           hr2di_lit_range *h) {
  const double light = hr2d_scene_background(e->scene, band);
  const hr2di_lit_range *rest = &e->row[leaf];
  if (!(light > 0)) return;
  for (int k = 0; k < 2; k++)
    add(&h->point.at[k], rest->point.at[k].lower * light, rest->point.at[k].upper * light);
  add(&h->mean, rest->mean.lower * light, rest->mean.upper * light);
}

static hr2di_range reflected(hr2di_range h, double emission, double reflectance) {
  const double margin = 2 * DBL_EPSILON * (emission + reflectance * h.upper);
  return (hr2di_range){emission + reflectance * h.lower - margin,
                       emission + reflectance * h.upper + margin};
}

/* Of two lower lines that with the larger mean, likewise of two upper ones: a line through the
   better ends of both would not hold between them. */
static void choose_lines(hr2di_strip *known, hr2di_strip now) {
  const hr2di_range old_mean = mean_of(known), mean = mean_of(&now);
  for (int k = 0; k < 2 && mean.lower > old_mean.lower; k++)
    known->at[k].lower = now.at[k].lower;
  for (int k = 0; k < 2 && mean.upper < old_mean.upper; k++)
    known->at[k].upper = now.at[k].upper;
}

/* Returns what is not known of the leaf. */
static double take(hr2di_enclosing *e, uint32_t leaf, size_t band) {
  const size_t patch = e->hierarchy->element[leaf].patch, at = leaf * e->bands + band;
  const double emission = hr2d_scene_emission(e->scene, patch, band);
  const double reflectance = hr2d_scene_reflectance(e->scene, patch, band);
  hr2di_lit_range *h = &e->h[at], *b = &e->b[at];
  add_background(e, leaf, band, h);
  finish(h, e->terms[leaf]);
  const hr2di_strip seen = {{reflected(h->point.at[0], emission, reflectance),
                             reflected(h->point.at[1], emission, reflectance)}};
  choose_lines(&b->point, seen);
  b->mean = narrower(b->mean, reflected(h->mean, emission, reflectance));
  b->mean = narrower(b->mean, mean_of(&b->point));
  return e->hierarchy->element[leaf].length *
         (h->mean.upper - h->mean.lower + half_of(&b->point));
}

static hr2d_status sweep(hr2di_enclosing *e, double *width) {
  const size_t values = e->elements * e->bands;
  const hr2di_lit_range none = {{{{0, 0}, {0, 0}}}, {0, 0}};
  hr2d_status status = hr2di_watch_work(e->watch, values / 16);
  for (size_t k = 0; k < values; k++) e->h[k] = none;
  for (size_t k = 0; k < e->count && !status; k++) {
    gather_link(e, &e->link[k]);
    if (k % 16 == 0) status = hr2di_watch_work(e->watch, 10 * e->bands);
  }
  *width = 0;
  for (uint32_t k = 0; k < e->elements && !status; k++) {
    if (!hr2di_enclosing_has(e, k)) continue;
    for (size_t b = 0; b < e->bands; b++) *width += take(e, k, b);
    status = hr2di_watch_work(e->watch, e->bands);
  }
  e->sweeps++;
  return status;
}

hr2d_status hr2di_enclosing_sweep(hr2di_enclosing *e) {
  double before, width = INFINITY;
  hr2d_status status;
  do {
    before = width;
    status = sweep(e, &width);
  } while (!status && width > 0 && width < (1 - SLOW) * before);
  return status;
}

/* No B is above the largest E + ρ max(B, background). */
double hr2di_enclosing_max(const hr2d_scene *scene, size_t band) {
  double emission = 0, reflectance = 0;
  for (size_t k = 0; k < hr2di_scene_cell(scene); k++) {
    emission = fmax(emission, hr2d_scene_emission(scene, k, band));
    reflectance = fmax(reflectance, hr2d_scene_reflectance(scene, k, band));
  }
  const double upper = fmax(emission / (1 - reflectance),
                            emission + reflectance * hr2d_scene_background(scene, band));
  return upper * (1 + 4 * DBL_EPSILON);
}

static hr2di_lit_range even(double upper) {
  const hr2di_range all = {0, upper};
  return (hr2di_lit_range){{{all, all}}, all};
}

/* The part of a strip on one half of its element. */
static hr2di_lit_range half(const hr2di_strip *s, int right) {
  const hr2di_range mean = mean_of(s);
  const double margin = DBL_EPSILON * max_of(s);
  hr2di_lit_range r = {.point = *s};
  r.point.at[!right] = (hr2di_range){mean.lower - margin, mean.upper + margin};
  r.mean = mean_of(&r.point);
  r.mean = (hr2di_range){fmax(0, r.mean.lower - margin), r.mean.upper + margin};
  return r;
}

/* What was known before, and of new elements what was known of their parents.  What is no patch
   and no image, behind the last images of a period, is black. */
static void inherit(const hr2di_enclosing *e, hr2di_lit_range *now) {
  const hr2d_hierarchy *h = e->hierarchy;
  for (size_t b = 0; b < e->bands && !e->elements; b++) {
    const hr2di_lit_range all = even(hr2di_enclosing_max(e->scene, b));
    for (size_t k = 0; k < e->scene->patches; k++)
      now[k * e->bands + b] = k < hr2di_scene_cell(e->scene) ? all : even(0);
  }
  const size_t known = e->elements ? e->elements : e->scene->patches;
  for (size_t k = 0; k < e->elements * e->bands; k++) now[k] = e->b[k];
  for (size_t k = known; k < h->elements; k++)
    for (size_t b = 0; b < e->bands; b++)
      now[k * e->bands + b] =
          half(&now[h->parent[k] * e->bands + b].point, k != h->element[h->parent[k]].child);
}

static void count_terms(hr2di_enclosing *e, const hr2di_enclosed_link *l) {
  for (int k = 0; k < 2; k++) {
    const double length = e->hierarchy->element[l->of[k]].length;
    const hr2di_range mean = mean_factor(l, k, length);
    hr2di_lit_range *row = &e->row[l->of[k]];
    for (int at = 0; at < 2; at++)
      add(&row->point.at[at], l->factor[k].at[at].lower, l->factor[k].at[at].upper);
    add(&row->mean, mean.lower, mean.upper);
    e->terms[l->of[k]]++;
  }
}

static hr2di_range rest_of(hr2di_range row, double margin) {
  return (hr2di_range){1 - row.upper - margin, 1 - row.lower + margin};
}

/* What is left of 1; from 0 where it may be a back, or a patch that has no links because no
   light reaches it. */
static void take_rest(const hr2di_enclosing *e, uint32_t leaf) {
  const size_t patch = e->hierarchy->element[leaf].patch;
  const double margin = (e->terms[leaf] + (double)TERM) * DBL_EPSILON;
  hr2di_lit_range *row = &e->row[leaf];
  row->mean = rest_of(row->mean, margin);
  for (int k = 0; k < 2; k++) row->point.at[k] = rest_of(row->point.at[k], margin);
  if (e->scene->dark || (e->sees_backs && e->sees_backs[patch]) ||
      !(mean_of(&row->point).lower > 0))
    row->point.at[0].lower = row->point.at[1].lower = 0;
  if (e->scene->dark || (e->sees_backs && e->sees_backs[patch])) row->mean.lower = 0;
  if (!hr2di_scene_lit(e->scene, patch)) *row = even(0);
}

static hr2d_status make_rows(hr2di_enclosing *e) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < e->count && !status; k++) {
    count_terms(e, &e->link[k]);
    status = hr2di_watch_work(e->watch, 1);
  }
  for (uint32_t k = 0; k < e->elements && !status; k++)
    if (hr2di_enclosing_has(e, k)) take_rest(e, k);
  return status;
}

hr2d_status hr2di_enclosing_begin(hr2di_enclosing *e) {
  const size_t elements = e->hierarchy->elements, values = elements * e->bands;
  hr2di_lit_range *b = hr2di_alloc(&e->alloc, elements, e->bands * sizeof *b);
  hr2di_lit_range *h = hr2di_alloc(&e->alloc, elements, e->bands * sizeof *h);
  hr2di_lit_range *row = hr2di_alloc_zero(&e->alloc, elements, sizeof *row);
  uint32_t *terms = hr2di_alloc_zero(&e->alloc, elements, sizeof *terms);
  const int failed = !b || !h || !row || !terms;
  if (!failed) inherit(e, b);
  hr2di_enclosing_forget(e);
  e->b = b;
  e->h = h;
  e->row = row;
  e->terms = terms;
  e->elements = elements;
  if (failed) return HR2D_ENOMEM;
  const hr2d_status status = hr2di_watch_work(e->watch, values / 8);
  return status ? status : make_rows(e);
}

void hr2di_enclosing_forget(hr2di_enclosing *e) {
  hr2di_alloc_free(&e->alloc, e->b);
  hr2di_alloc_free(&e->alloc, e->h);
  hr2di_alloc_free(&e->alloc, e->row);
  hr2di_alloc_free(&e->alloc, e->terms);
}
