/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colour scale: its range, linear or logarithmic, or the exposure of true colour. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>

#include "output/complain.h"
#include "run/leaves.h"

/* If the middle of all values lies this low on a linear scale, most of it would be dark. */
#define TOO_LOW 0.2

/* The points that are looked from to choose the scale, along the longer side. */
#define SAMPLES 48

/* The parts of the samples that may lie outside of the scale. */
#define DARKEST   0.005
#define BRIGHTEST 0.995
#define WHITE     0.97

/* B averaged over all patches. */
static double overall(const picture *p) {
  double sum = 0, length = 0;
  for (size_t k = 0; k < hr2d_scene_patches(p->run->scene); k++) {
    const double own = hr2d_scene_length(p->run->scene, k);
    sum += own * shade_number(p, shade_of_element(p, (uint32_t)k));
    length += own;
  }
  return sum / length;
}

static void widen(picture *p, shade s) {
  p->lo = fmin(p->lo, shade_number(p, s));
  p->hi = fmax(p->hi, shade_number(p, s));
}

/* A polynomial may have its extremes anywhere. */
static int widen_by_leaf(void *ctx, const piece *e) {
  picture *p = ctx;
  const unsigned order = p->run->account.order;
  const uint32_t patch = hr2d_hierarchy_elements(p->run->hierarchy)[e->element].patch;
  if (order == 1) widen(p, shade_of_element(p, e->element));
  for (unsigned k = 0; order > 1 && k <= 4 * order; k++)
    widen(p, shade_of_point(p, patch, leaves_at(e, k / (4. * order))));
  return 0;
}

/* The values of the light at some points, in ascending order. */
typedef struct sample {
  double *value;
  size_t count;
} sample;

static double part_of(const sample *s, double part) {
  return s->count ? s->value[(size_t)(part * (double)(s->count - 1))] : NAN;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* In true colour the brightest of the three counts. */
static double sampled(const picture *p, shade s) {
  return p->rgb ? fmax(s.v[0], fmax(s.v[1], s.v[2])) : s.v[0];
}

static int take_sample(picture *p, sample *s) {
  raster r;
  const double longer = fmax(p->frame.x1 - p->frame.x0, p->frame.y1 - p->frame.y0);
  int status = raster_make(p, longer / SAMPLES, 0, &r);
  if (status) return status;
  p->work = r.work;
  s->value = malloc(r.columns * r.rows * sizeof *s->value);
  for (size_t k = 0; s->value && k < r.columns * r.rows; k++)
    if (isfinite(r.at[k].v[0])) s->value[s->count++] = sampled(p, r.at[k]);
  if (s->value)
    qsort(s->value, s->count, sizeof *s->value, ascending);
  else
    status = complain_memory();
  free(r.at);
  return status;
}

/* On a linear scale the brightest places, beside lamps, have the colour of its end. */
static void choose_linear(picture *p, const sample *s) {
  const double max = fmax(p->hi, part_of(s, 1)), bright = part_of(s, BRIGHTEST);
  p->lo = fmin(p->lo, part_of(s, 0));
  if (p->quantity == QUANTITY_SKY) {
    p->lo = 0;
    p->hi = max > 0.5 ? 1 : max;
    return;
  }
  if (p->quantity != QUANTITY_TEMPERATURE && p->lo < 0.5 * bright) p->lo = 0;
  p->hi = bright > p->lo && max - p->lo > 2 * (bright - p->lo) ? bright : max;
  p->beyond = p->hi < max;
}

/* Black patches have the colour of the lower end. */
static void choose_logarithmic(picture *p, const sample *s) {
  const double dark = part_of(s, DARKEST), min = p->lo > 0 ? p->lo : INFINITY;
  p->hi = fmax(p->hi, part_of(s, 1));
  p->lo = fmin(min, dark > 0 ? dark : INFINITY);
  if (!(p->lo < p->hi)) p->lo = 1e-3 * p->hi;
  p->lo = fmax(p->lo, 1e-12 * p->hi);
  p->logarithmic = 1;
}

static void choose_filled(picture *p, const sample *s) {
  const options *o = p->run->options;
  if (p->rgb) {
    const double white = part_of(s, WHITE);
    p->exposure = white > 0 ? 1 / white : 1;
    p->beyond = part_of(s, 1) * p->exposure > 1 + 1e-6;
    return;
  }
  const double hi = fmax(p->hi, part_of(s, 1)), middle = part_of(s, 0.5);
  const int dark = middle > 0 && middle < TOO_LOW * part_of(s, BRIGHTEST);
  const int scalable = p->quantity == QUANTITY_MEAN || p->quantity == QUANTITY_FLUX;
  if (hi > 0 && (o->log_scale || (!o->linear_scale && dark && scalable)))
    choose_logarithmic(p, s);
  else
    choose_linear(p, s);
}

static void choose_plain(picture *p) {
  const options *o = p->run->options;
  const int low = p->hi > 3 * p->lo && (overall(p) - p->lo) / (p->hi - p->lo) < TOO_LOW;
  p->logarithmic = p->lo > 0 && p->hi > p->lo && !o->linear_scale && (low || o->log_scale);
  p->exposure = p->hi > 0 ? 1 / p->hi : 1;
}

/* A range that is no point. */
static void open_range(picture *p) {
  if (!(p->lo <= p->hi)) p->lo = p->hi = 0; /* nothing is shown */
  if (p->hi - p->lo > 1e-9 * fabs(p->hi)) return;
  const double margin = p->hi > 0 ? 0.5 * p->hi : 1;
  p->lo = fmax(0, p->lo - margin);
  p->hi += margin;
  p->logarithmic = 0;
}

int scale_choose(picture *p) {
  int status = 0;
  sample s = {NULL, 0};
  p->lo = INFINITY;
  p->hi = -INFINITY;
  p->exposure = 1;
  for (size_t k = 0; p->coloured && !status && k < hr2d_scene_patches(p->run->scene); k++)
    status = leaves_walk(p->run->hierarchy, k, 0, widen_by_leaf, p);
  if ((p->filled || p->run->options->contours) && !status) status = take_sample(p, &s);
  if (!(part_of(&s, 1) > 0)) p->filled = 0; /* without light the scene stays white */
  if (p->filled && !status)
    choose_filled(p, &s);
  else if (!status)
    choose_plain(p);
  if (p->run->options->exposure > 0) p->exposure = p->run->options->exposure;
  open_range(p);
  free(s.value);
  return status;
}

double scale_position(const picture *p, double value) {
  if (p->logarithmic) return value > p->lo ? log(value / p->lo) / log(p->hi / p->lo) : 0;
  return (value - p->lo) / (p->hi - p->lo);
}

colour scale_colour_at(const picture *p, double position) {
  return p->filled ? palette_inferno(position) : palette_viridis(position);
}

colour scale_colour(const picture *p, shade s) {
  if (!p->rgb) return scale_colour_at(p, scale_position(p, s.v[0]));
  return (colour){palette_srgb(p->exposure * s.v[0]), palette_srgb(p->exposure * s.v[1]),
                  palette_srgb(p->exposure * s.v[2])};
}
#endif
