/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/energy-balance.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/components.h"
#include "links/patch-defect.h"
#include "scene/scene-impl.h"
#include "solve/gas-light.h"
#include "solve/scattering.h"

/* A component is closed if its row sums miss at most HR2DI_DEFECT_CLOSED of 1; they are 1 on
   leaves of closed patches.  A component is balanced if they miss at most this part. */
#define LITTLE (1. / 64)

static const hr2d_element *leaf_of(const hr2di_transport *t, size_t leaf) {
  return &t->hierarchy->element[t->leaf[leaf]];
}

/* ρ, and on panes ρ + τ: what leaves of H = 1. */
static double rho_of(const hr2di_transport *t, size_t leaf, size_t band) {
  return hr2di_scene_scattered(t->scene, leaf_of(t, leaf)->patch, band);
}

static double absorptance_of(const hr2di_transport *t, size_t leaf, size_t band) {
  return hr2di_scene_absorptance(t->scene, leaf_of(t, leaf)->patch, band);
}

/* Gas of given heat joins patches; nobody asks which. */
static size_t component_of(const hr2di_transport *t, hr2di_components *c, size_t leaf) {
  return t->gas_return ? 0 : hr2di_component(c, leaf_of(t, leaf)->patch);
}

/* 1 − K1, in one band; with gas that is m, which is known better. */
static hr2d_status set_missing(hr2di_balance *b, hr2di_transport *t) {
  const size_t field = t->leaves * t->order, bands = t->bands;
  if (t->gas) {
    const double *lost = hr2di_gas_light_lost(t);
    for (size_t k = 0; k < field; k++) b->missing[k] = lost ? lost[k] : 0;
    return HR2D_OK;
  }
  double *unit = hr2di_alloc_zero(&t->alloc, 2 * field, sizeof *unit);
  if (!unit) return HR2D_ENOMEM;
  double *const row = unit + field;
  for (size_t k = 0; k < t->leaves; k++) unit[k * t->order] = 1;
  hr2di_transport_set_bands(t, 1);
  if (t->rows) {
    memcpy(row, t->rows, field * sizeof *row);
    hr2di_transport_close(t, unit, row);
  } else {
    hr2di_transport_apply(t, unit, row);
  }
  hr2di_transport_set_bands(t, bands);
  for (size_t k = 0; k < field && !t->failed; k++) b->missing[k] = unit[k] - row[k];
  hr2di_alloc_free(&t->alloc, unit);
  return t->failed;
}

/* Sums of a component, kept at its first patch while components are numbered. */
typedef struct tally {
  hr2di_sum length, missing;
  uint32_t number; /* from 1; 0: not numbered yet */
} tally;

/* Numbers the balanced components; clears m on leaves of closed components and of others. */
static hr2d_status number(hr2di_balance *b, const hr2di_transport *t, hr2di_components *c,
                          tally *of) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < t->leaves && !status; k++) {
    tally *mine = &of[component_of(t, c, k)];
    const double length = hr2di_sum_total(&mine->length),
                 missing = hr2di_sum_total(&mine->missing);
    status = hr2di_watch_work(t->watch, 1);
    if (mine->number == 0)
      mine->number = missing <= LITTLE * length ? (uint32_t)++b->count : HR2DI_OPEN;
    b->component[k] = mine->number == HR2DI_OPEN ? HR2DI_OPEN : mine->number - 1;
    const double closed = t->gas ? 0 : HR2DI_DEFECT_CLOSED * length;
    if (hr2di_balance_holds(b, k) && missing > closed) continue;
    for (size_t l = 0; l < t->order; l++) b->missing[k * t->order + l] = 0;
  }
  return status;
}

static hr2d_status find_components(hr2di_balance *b, hr2di_transport *t) {
  hr2di_components c = {.alloc = t->alloc};
  hr2d_status status = hr2di_components_init(&c, t->links, t->watch);
  if (!status) hr2di_components_join_panes(&c, t->scene, SIZE_MAX);
  tally *of = hr2di_alloc_zero(&t->alloc, t->hierarchy->scene->patches, sizeof *of);
  b->component = hr2di_alloc(&t->alloc, t->leaves, sizeof *b->component);
  b->missing = hr2di_alloc(&t->alloc, t->leaves * t->order, sizeof *b->missing);
  if (!of || !b->component || !b->missing) status = HR2D_ENOMEM;
  if (!status) status = set_missing(b, t);
  for (size_t k = 0; k < t->leaves && !status; k++) {
    tally *mine = &of[component_of(t, &c, k)];
    const double area = leaf_of(t, k)->length;
    status = hr2di_watch_work(t->watch, 1);
    hr2di_sum_add(&mine->length, area);
    hr2di_sum_add(&mine->missing, area * b->missing[k * t->order]);
  }
  if (!status) status = number(b, t, &c, of);
  hr2di_alloc_free(&t->alloc, of);
  hr2di_components_clear(&c);
  return status;
}

static hr2di_sum *sum_of(const hr2di_balance *b, const hr2di_transport *t, size_t leaf,
                         size_t band) {
  return &b->sum[b->component[leaf] * t->bands + band];
}

static void clear_sums(const hr2di_balance *b, const hr2di_transport *t) {
  for (size_t k = 0; k < b->count * t->bands; k++) b->sum[k] = (hr2di_sum){0, 0};
}

/* Sets ∫m, ∫(1−ρ) + ∫m, and this less ∫(1−ρ)m. */
void hr2di_balance_set_losses(hr2di_balance *b, const hr2di_transport *t) {
  for (size_t k = 0; k < 2 * b->count + 3 * b->count * t->bands; k++) b->length[k] = 0;
  clear_sums(b, t);
  for (size_t k = 0; k < t->leaves; k++) {
    if (!hr2di_balance_holds(b, k)) continue;
    const double area = leaf_of(t, k)->length, escape = area * b->missing[k * t->order];
    b->length[b->component[k]] += area;
    b->escape[b->component[k]] += escape;
    for (size_t band = 0; band < t->bands; band++) {
      hr2di_sum_add(sum_of(b, t, k, band), area * absorptance_of(t, k, band));
      b->response[b->component[k] * t->bands + band] -= escape * absorptance_of(t, k, band);
      hr2di_sum_add(sum_of(b, t, k, band), escape);
    }
  }
  for (size_t k = 0; k < b->count * t->bands; k++) {
    b->loss[k] = hr2di_sum_total(&b->sum[k]);
    b->response[k] += b->loss[k];
  }
}

hr2d_status hr2di_balance_init(hr2di_balance *b, hr2di_transport *t) {
  *b = (hr2di_balance){.alloc = t->alloc};
  const hr2d_status status = find_components(b, t);
  if (status || b->count == 0) return status;
  const size_t values = b->count * t->bands;
  b->length = hr2di_alloc(&b->alloc, 2 * b->count + 3 * values, sizeof *b->length);
  b->sum = hr2di_alloc(&b->alloc, values, sizeof *b->sum);
  b->sends = hr2di_alloc(&b->alloc, values, sizeof *b->sends);
  if (!b->length || !b->sum || !b->sends) return HR2D_ENOMEM;
  b->escape = b->length + b->count;
  b->loss = b->escape + b->count;
  b->level = b->loss + values;
  b->response = b->level + values;
  hr2di_balance_set_losses(b, t);
  return HR2D_OK;
}

void hr2di_balance_clear(hr2di_balance *b) {
  hr2di_alloc_free(&b->alloc, b->component);
  hr2di_alloc_free(&b->alloc, b->missing);
  hr2di_alloc_free(&b->alloc, b->length);
  hr2di_alloc_free(&b->alloc, b->sum);
  hr2di_alloc_free(&b->alloc, b->sends);
}

/* Whether a leaf has a source, or reflects something that comes in. */
static int is_sending(const hr2di_transport *t, const double *source, const double *outside,
                      size_t leaf, size_t band) {
  const size_t first = leaf * t->width + band;
  const int reflects = outside && rho_of(t, leaf, band) > 0;
  for (size_t at = first; at < (leaf + 1) * t->width; at += t->bands)
    if (source[at] != 0 || (reflects && outside[at] != 0)) return 1;
  return 0;
}

static void set_sends(hr2di_balance *b, const hr2di_transport *t, const double *source,
                      const double *outside) {
  memset(b->sends, 0, b->count * t->bands);
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t band = 0; band < t->bands && hr2di_balance_holds(b, k); band++) {
      unsigned char *sends = &b->sends[b->component[k] * t->bands + band];
      if (!*sends) *sends = (unsigned char)is_sending(t, source, outside, k, band);
    }
}

void hr2di_balance_set(hr2di_balance *b, const hr2di_transport *t, const double *source,
                       const double *outside) {
  clear_sums(b, t);
  set_sends(b, t, source, outside);
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t band = 0; band < t->bands && hr2di_balance_holds(b, k); band++) {
      const double area = leaf_of(t, k)->length;
      hr2di_sum_add(sum_of(b, t, k, band), area * source[k * t->width + band]);
      if (outside) hr2di_sum_add(sum_of(b, t, k, band), area * outside[k * t->width + band]);
    }
  for (size_t k = 0; k < b->count * t->bands; k++)
    b->level[k] = b->loss[k] > 0 && b->sends[k] ? hr2di_sum_total(&b->sum[k]) / b->loss[k] : 0;
}

/* Adding a to h adds ρa to z, and ∫(1−ρ)a + ∫mρa to the balance. */
void hr2di_balance_correct(hr2di_balance *b, const hr2di_transport *t, const double *source,
                           const double *h) {
  clear_sums(b, t);
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t band = 0; band < t->bands && hr2di_balance_holds(b, k); band++) {
      const double area = leaf_of(t, k)->length, absorptance = absorptance_of(t, k, band);
      const size_t at = k * t->width + band;
      double off = absorptance * h[at];
      for (size_t l = 0; l < t->order; l++) {
        const double constant = l == 0 ? absorptance * hr2di_balance_at(b, t, k, band) : 0;
        const double z =
            source[at + l * t->bands] - constant + hr2di_scattered_at(t, k, l, band, h);
        off += b->missing[k * t->order + l] * z;
      }
      hr2di_sum_add(sum_of(b, t, k, band), area * off);
    }
  for (size_t k = 0; k < b->count * t->bands; k++)
    if (b->response[k] > 0 && b->sends[k])
      b->level[k] -= hr2di_sum_total(&b->sum[k]) / b->response[k];
}

double hr2di_balance_at(const hr2di_balance *b, const hr2di_transport *t, size_t leaf,
                        size_t band) {
  return hr2di_balance_holds(b, leaf) ? b->level[b->component[leaf] * t->bands + band] : 0;
}

void hr2di_balance_add(const hr2di_balance *b, const hr2di_transport *t, double *field) {
  for (size_t k = 0; k < t->leaves && b->count > 0; k++)
    for (size_t band = 0; band < t->bands; band++)
      field[k * t->width + band] += hr2di_balance_at(b, t, k, band);
}

void hr2di_balance_absorb(const hr2di_balance *b, const hr2di_transport *t, double *field) {
  for (size_t k = 0; k < t->leaves && b->count > 0; k++)
    for (size_t band = 0; band < t->bands; band++)
      field[k * t->width + band] -=
          absorptance_of(t, k, band) * hr2di_balance_at(b, t, k, band);
}

void hr2di_balance_release(const hr2di_balance *b, const hr2di_transport *t, double *field) {
  for (size_t k = 0; k < t->leaves && b->count > 0; k++)
    for (size_t m = 0; m < t->width; m++)
      field[k * t->width + m] -=
          b->missing[k * t->order + m / t->bands] * hr2di_balance_at(b, t, k, m % t->bands);
}

double hr2di_balance_doubt(const hr2di_balance *b, const hr2di_transport *t) {
  const size_t bands = t->bands;
  const double rounding = t->blocks.single ? HR2DI_SINGLE_ROUNDING : DBL_EPSILON;
  double max = 0;
  if (hr2di_gas_light_lost(t)) return rounding;
  for (size_t k = 0; k < b->count * bands; k++)
    if (b->escape[k / bands] > 0 && b->level[k] != 0)
      max = fmax(max, rounding * b->length[k / bands] / b->loss[k]);
  return max;
}
