/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "balance.h"

/* A component is balanced if its row sums miss at most this part. */
#define LITTLE (1. / 64)

static const hr2d_element *leaf_of(const hr2dpi_balance *b, size_t leaf) {
  return &hr2d_hierarchy_elements(b->t->p->hierarchy)[b->t->p->trees.leaf[leaf]];
}

static double rho_of(const hr2dpi_balance *b, size_t leaf, size_t band) {
  return hr2d_scene_reflectance(b->t->p->scene, leaf_of(b, leaf)->patch, band);
}

/* Sets m = 1 − K1 on own leaves. */
static PetscErrorCode set_missing(hr2dpi_balance *b, hr2dpi_transport *t, double *one) {
  PetscFunctionBegin;
  const size_t leaves = t->p->trees.leaves, bands = t->p->bands;
  for (size_t k = 0; k < leaves * bands; k++) one[k] = 1;
  PetscCall(hr2dpi_transport_apply(t, one, one + leaves * bands));
  for (size_t k = 0; k < leaves; k++) b->missing[k] = 1 - one[(leaves + k) * bands];
  PetscFunctionReturn(0);
}

/* Adds up lengths and what is missing of each component: sum[2c] and sum[2c + 1]. */
static void tally(const hr2dpi_balance *b, const uint32_t *number, hr2dpi_sum *sum) {
  for (size_t k = 0; k < b->t->p->trees.leaves; k++) {
    const hr2d_element *e = leaf_of(b, k);
    hr2dpi_sum *mine = &sum[2 * (size_t)number[e->patch]];
    hr2dpi_sum_add(&mine[0], e->length);
    hr2dpi_sum_add(&mine[1], e->length * b->missing[k]);
  }
}

/* Keeps the balanced components; m is 0 in closed ones and in others. */
static void choose(hr2dpi_balance *b, size_t all, const uint32_t *number, const hr2dpi_sum *sum,
                   uint32_t *kept, unsigned char *closed) {
  for (size_t c = 0; c < all; c++) {
    const double length = hr2dpi_sum_total(&sum[2 * c]);
    const double missing = hr2dpi_sum_total(&sum[2 * c + 1]);
    kept[c] = missing <= LITTLE * length ? (uint32_t)b->count++ : HR2DPI_OPEN;
    closed[c] = (unsigned char)!(missing > HR2DPI_CLOSED * length);
  }
  for (size_t k = 0; k < b->t->p->trees.leaves; k++) {
    const uint32_t c = number[leaf_of(b, k)->patch];
    b->component[k] = kept[c];
    if (kept[c] == HR2DPI_OPEN || closed[c]) b->missing[k] = 0;
  }
}

/* Collective parts are only entered together. */
static PetscErrorCode find_by(hr2dpi_balance *b, hr2dpi_transport *t, const hr2dpi_exchange *x,
                              double *one) {
  PetscFunctionBegin;
  hr2dp *p = t->p;
  PetscCall(set_missing(b, t, one));
  hr2dpi_sum *sum = hr2dpi_alloc_zero(p, 2 * x->count, sizeof *sum);
  uint32_t *kept = hr2dpi_alloc(p, x->count, sizeof *kept);
  unsigned char *closed = hr2dpi_alloc(p, x->count, 1);
  PetscErrorCode failed = hr2dpi_agree(p, sum && kept && closed ? HR2D_OK : HR2D_ENOMEM);
  if (!failed) {
    tally(b, x->number, sum);
    failed = hr2dpi_sum_all(p, sum, 2 * x->count);
  }
  if (!failed) choose(b, x->count, x->number, sum, kept, closed);
  hr2dpi_free(p, sum);
  hr2dpi_free(p, kept);
  hr2dpi_free(p, closed);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

static PetscErrorCode find(hr2dpi_balance *b, hr2dpi_transport *t, const hr2dpi_exchange *x) {
  PetscFunctionBegin;
  hr2dp *p = t->p;
  double *one = hr2dpi_alloc(p, 2 * p->trees.leaves, p->bands * sizeof *one);
  b->component = hr2dpi_alloc(p, p->trees.leaves, sizeof *b->component);
  b->missing = hr2dpi_alloc(p, p->trees.leaves, sizeof *b->missing);
  const int room = one && b->component && b->missing;
  PetscErrorCode failed = hr2dpi_agree(p, room ? HR2D_OK : HR2D_ENOMEM);
  if (!failed) failed = find_by(b, t, x, one);
  hr2dpi_free(p, one);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

static hr2dpi_sum *sum_of(const hr2dpi_balance *b, size_t leaf, size_t band) {
  return &b->sum[b->component[leaf] * b->t->p->bands + band];
}

static void clear_sums(hr2dpi_balance *b) {
  memset(b->sum, 0, b->count * b->t->p->bands * sizeof *b->sum);
}

/* Adds up a term of each own leaf in a component, over all ranks. */
typedef double term(const hr2dpi_balance *b, size_t leaf, size_t band, const double *source,
                    const double *other);

static PetscErrorCode add_up(hr2dpi_balance *b, term *of, const double *source,
                             const double *other) {
  PetscFunctionBegin;
  hr2dp *p = b->t->p;
  clear_sums(b);
  for (size_t k = 0; k < p->trees.leaves; k++)
    for (size_t band = 0; band < p->bands && hr2dpi_balance_holds(b, k); band++)
      hr2dpi_sum_add(sum_of(b, k, band), leaf_of(b, k)->length * of(b, k, band, source, other));
  PetscCall(hr2dpi_sum_all(p, b->sum, b->count * p->bands));
  PetscFunctionReturn(0);
}

static double missing_of(const hr2dpi_balance *b, size_t leaf, size_t band,
                         const double *source, const double *other) {
  (void)band;
  (void)source;
  (void)other;
  return b->missing[leaf];
}

static double absorbed_of(const hr2dpi_balance *b, size_t leaf, size_t band,
                          const double *source, const double *other) {
  (void)source;
  (void)other;
  return 1 - rho_of(b, leaf, band);
}

static double absorbed_escape_of(const hr2dpi_balance *b, size_t leaf, size_t band,
                                 const double *source, const double *other) {
  (void)source;
  (void)other;
  return b->missing[leaf] * (1 - rho_of(b, leaf, band));
}

/* Sets ∫m, ∫(1−ρ) + ∫m, and this less ∫(1−ρ)m. */
static PetscErrorCode set_losses(hr2dpi_balance *b) {
  PetscFunctionBegin;
  const size_t bands = b->t->p->bands, values = b->count * bands;
  PetscCall(add_up(b, missing_of, NULL, NULL));
  for (size_t k = 0; k < values; k++) b->escape[k / bands] = hr2dpi_sum_total(&b->sum[k]);
  PetscCall(add_up(b, absorbed_of, NULL, NULL));
  for (size_t k = 0; k < values; k++)
    b->loss[k] = hr2dpi_sum_total(&b->sum[k]) + b->escape[k / bands];
  PetscCall(add_up(b, absorbed_escape_of, NULL, NULL));
  for (size_t k = 0; k < values; k++)
    b->response[k] = b->loss[k] - hr2dpi_sum_total(&b->sum[k]);
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_balance_init(hr2dpi_balance *b, hr2dpi_transport *t,
                                   const hr2dpi_exchange *x) {
  PetscFunctionBegin;
  hr2dp *p = t->p;
  *b = (hr2dpi_balance){.t = t};
  PetscCall(find(b, t, x));
  if (b->count == 0) PetscFunctionReturn(0);
  const size_t values = b->count * p->bands;
  b->escape = hr2dpi_alloc_zero(p, b->count + 3 * values, sizeof *b->escape);
  b->sum = hr2dpi_alloc(p, values, sizeof *b->sum);
  PetscCall(hr2dpi_agree(p, b->escape && b->sum ? HR2D_OK : HR2D_ENOMEM));
  b->loss = b->escape + b->count;
  b->level = b->loss + values;
  b->response = b->level + values;
  PetscCall(set_losses(b));
  PetscFunctionReturn(0);
}

void hr2dpi_balance_clear(hr2dpi_balance *b) {
  if (!b->t) return;
  const hr2dp *p = b->t->p;
  hr2dpi_free(p, b->component);
  hr2dpi_free(p, b->missing);
  hr2dpi_free(p, b->escape);
  hr2dpi_free(p, b->sum);
}

static double incoming_of(const hr2dpi_balance *b, size_t leaf, size_t band,
                          const double *source, const double *background) {
  const double light = background && b->t->sky ? b->t->sky[leaf] * background[band] : 0;
  return source[leaf * b->t->p->bands + band] + light;
}

PetscErrorCode hr2dpi_balance_set(hr2dpi_balance *b, const double *source,
                                  const double *background) {
  PetscFunctionBegin;
  if (b->count == 0) PetscFunctionReturn(0);
  PetscCall(add_up(b, incoming_of, source, background));
  for (size_t k = 0; k < b->count * b->t->p->bands; k++)
    b->level[k] = b->loss[k] > 0 ? hr2dpi_sum_total(&b->sum[k]) / b->loss[k] : 0;
  PetscFunctionReturn(0);
}

/* Adding a to h adds ρa to z, and ∫(1−ρ)a + ∫mρa to the balance. */
static double off_of(const hr2dpi_balance *b, size_t leaf, size_t band, const double *source,
                     const double *h) {
  const size_t at = leaf * b->t->p->bands + band;
  const double rho = rho_of(b, leaf, band);
  const double z = source[at] - (1 - rho) * hr2dpi_balance_at(b, leaf, band) + rho * h[at];
  return (1 - rho) * h[at] + b->missing[leaf] * z;
}

PetscErrorCode hr2dpi_balance_correct(hr2dpi_balance *b, const double *source,
                                      const double *h) {
  PetscFunctionBegin;
  PetscCall(add_up(b, off_of, source, h));
  for (size_t k = 0; k < b->count * b->t->p->bands; k++)
    if (b->response[k] > 0) b->level[k] -= hr2dpi_sum_total(&b->sum[k]) / b->response[k];
  PetscFunctionReturn(0);
}
