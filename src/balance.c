/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "balance.h"

#include <math.h>

#include "alloc.h"
#include "components.h"
#include "hierarchy-impl.h"
#include "scene-impl.h"
#include "sum.h"

/* A component misses nothing if it misses less than this part of its rows, which are 1 on
   leaves of patches that rows.c takes as closed. */
#define CLOSED 1e-14

static const hr2d_element *leaf_of(const hr2di_transport *t, size_t leaf) {
  return &t->hierarchy->element[t->leaf[leaf]];
}

/* 1 − ρ; exact for ρ ≥ ½, and good to a rounding below. */
static double absorbance(const hr2di_transport *t, size_t leaf, size_t band) {
  return 1 - hr2d_scene_reflectance(t->hierarchy->scene, leaf_of(t, leaf)->patch, band);
}

/* Σ A and Σ A(1 − K1) of each component, at the number of its patch. */
static hr2d_status sum_rows(hr2di_transport *t, hr2di_components *c, hr2di_sum *length,
                            hr2di_sum *missing) {
  const size_t field = t->leaves * t->width;
  double *one = hr2di_calloc(&t->alloc, 2 * field, sizeof *one), *row = one + field;
  if (!one) return HR2D_ENOMEM;
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t b = 0; b < t->bands; b++) one[k * t->width + b] = 1;
  hr2di_gather(t, one, row);
  for (size_t k = 0; k < t->leaves; k++) {
    const size_t at = hr2di_component(c, leaf_of(t, k)->patch);
    const double area = leaf_of(t, k)->length;
    hr2di_add(&length[at], area);
    hr2di_add(&missing[at], area * (1 - row[k * t->width]));
  }
  hr2di_free(&t->alloc, one);
  return t->failed ? HR2D_ENOMEM : HR2D_OK;
}

/* Numbers the closed components. */
static void number(hr2di_balance *b, const hr2di_transport *t, hr2di_components *c,
                   const hr2di_sum *length, const hr2di_sum *missing, uint32_t *number_of) {
  for (size_t k = 0; k < t->leaves; k++) {
    const size_t at = hr2di_component(c, leaf_of(t, k)->patch);
    const int closed = fabs(hr2di_total(&missing[at])) <= CLOSED * hr2di_total(&length[at]);
    if (number_of[at] == 0) number_of[at] = closed ? (uint32_t)++b->count : HR2DI_OPEN;
    b->component[k] = number_of[at] == HR2DI_OPEN ? HR2DI_OPEN : number_of[at] - 1;
  }
}

static hr2d_status find_components(hr2di_balance *b, hr2di_transport *t) {
  const size_t patches = t->hierarchy->scene->patches;
  hr2di_components c = {.above = NULL};
  hr2d_status status = hr2di_components_make(&c, t->links);
  hr2di_sum *length = hr2di_calloc(&t->alloc, 2 * patches, sizeof *length);
  uint32_t *number_of = hr2di_calloc(&t->alloc, patches, sizeof *number_of);
  b->component = hr2di_alloc(&t->alloc, t->leaves, sizeof *b->component);
  if (!length || !number_of || !b->component) status = HR2D_ENOMEM;
  if (!status) status = sum_rows(t, &c, length, length + patches);
  if (!status) number(b, t, &c, length, length + patches, number_of);
  hr2di_free(&t->alloc, number_of);
  hr2di_free(&t->alloc, length);
  hr2di_components_clear(&c);
  return status;
}

/* Σ A·(1−ρ or 1)·field of each component and band, into b->sum. */
static void integrate(const hr2di_balance *b, const hr2di_transport *t, int absorbed,
                      const double *field) {
  for (size_t k = 0; k < b->count * t->bands; k++) b->sum[k] = (hr2di_sum){0, 0};
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t band = 0; band < t->bands && b->component[k] != HR2DI_OPEN; band++) {
      const double value = field ? field[k * t->width + band] : 1;
      const double part = absorbed ? absorbance(t, k, band) : 1;
      hr2di_add(&b->sum[b->component[k] * t->bands + band],
                leaf_of(t, k)->length * (part * value));
    }
}

hr2d_status hr2di_balance_make(hr2di_balance *b, hr2di_transport *t) {
  *b = (hr2di_balance){.alloc = t->alloc};
  const hr2d_status status = find_components(b, t);
  if (status || b->count == 0) return status;
  const size_t values = b->count * t->bands;
  b->absorbance = hr2di_calloc(&b->alloc, 2 * values, sizeof *b->absorbance);
  b->sum = hr2di_alloc(&b->alloc, values, sizeof *b->sum);
  if (!b->absorbance || !b->sum) return HR2D_ENOMEM;
  b->level = b->absorbance + values;
  integrate(b, t, 1, NULL);
  for (size_t k = 0; k < values; k++) b->absorbance[k] = hr2di_total(&b->sum[k]);
  return HR2D_OK;
}

void hr2di_balance_clear(hr2di_balance *b) {
  hr2di_free(&b->alloc, b->component);
  hr2di_free(&b->alloc, b->absorbance);
  hr2di_free(&b->alloc, b->sum);
}

void hr2di_balance_set(hr2di_balance *b, const hr2di_transport *t, const double *source) {
  if (b->count == 0) return;
  integrate(b, t, 0, source);
  for (size_t k = 0; k < b->count * t->bands; k++)
    b->level[k] = b->absorbance[k] > 0 ? hr2di_total(&b->sum[k]) / b->absorbance[k] : 0;
}

void hr2di_balance_correct(hr2di_balance *b, const hr2di_transport *t, const double *h) {
  integrate(b, t, 1, h);
  for (size_t k = 0; k < b->count * t->bands; k++)
    if (b->absorbance[k] > 0) b->level[k] -= hr2di_total(&b->sum[k]) / b->absorbance[k];
}

double hr2di_balance_at(const hr2di_balance *b, const hr2di_transport *t, size_t leaf,
                        size_t band) {
  return hr2di_balance_holds(b, leaf) ? b->level[b->component[leaf] * t->bands + band] : 0;
}

void hr2di_balance_add(const hr2di_balance *b, const hr2di_transport *t, double factor,
                       int absorbed, double *field) {
  for (size_t k = 0; k < t->leaves && b->count > 0; k++)
    for (size_t band = 0; band < t->bands; band++)
      field[k * t->width + band] +=
          factor * (absorbed ? absorbance(t, k, band) : 1) * hr2di_balance_at(b, t, k, band);
}
