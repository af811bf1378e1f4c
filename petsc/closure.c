/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closure of hr2d_solve() at order 1.  An element c gets the light of links at its
   ancestors with the factor w_c = T_c / mean T over c and its sibling, T_c = σ_c − D_c: σ_c is
   the mean of the exact row sums of c's leaves, and D_c what links at c and below it make of
   them.  Means above the cut need those of units, which the halo brings. */
#include "closure.h"

/* Differences of T below this part of σ may be roundings. */
#define NOISE HR2DPI_CLOSED

/* A mean of the closure above this part of 1 is no rounding. */
#define ROUNDING HR2DPI_CLOSED

static int reflects(const hr2dp *p) {
  for (size_t k = 0; k < p->patches; k++)
    for (size_t b = 0; b < p->bands; b++)
      if (hr2d_scene_reflectance(p->scene, k, b) > 0) return 1;
  return 0;
}

static uint32_t patch_of(const hr2dp *p, size_t leaf) {
  return hr2d_hierarchy_elements(p->hierarchy)[p->trees.leaf[leaf]].patch;
}

/* Sums of the leaves of open patches of this rank, if it has any. */
static hr2d_status integrate(hr2dpi_transport *t, const hr2dpi_exchange *x, double *front,
                             double *back) {
  const hr2dp *p = t->p;
  size_t from = p->patches, to = 0;
  for (size_t k = 0; k < p->trees.leaves; k++) {
    const size_t patch = patch_of(p, k);
    if (x->closed[patch]) continue;
    if (patch < from) from = patch;
    if (patch >= to) to = patch + 1;
    t->row_sums += x->linked[patch];
  }
  return from < to ? hr2d_leaf_sums(p->hierarchy, from, to, front, back) : HR2D_OK;
}

/* Of closed patches they are 1.  A patch without links sees none that light reaches. */
static hr2d_status set_sums(hr2dpi_transport *t, const hr2dpi_exchange *x, int background,
                            double *front, double *back) {
  const hr2dp *p = t->p;
  const hr2d_status status = integrate(t, x, front, background ? back : NULL);
  if (status) return status;
  if (background) {
    t->sky = hr2dpi_alloc(p, p->trees.leaves, sizeof *t->sky);
    if (!t->sky) return HR2D_ENOMEM;
  }
  for (size_t k = 0; k < p->trees.leaves; k++) {
    const uint32_t leaf = p->trees.leaf[k], patch = patch_of(p, k);
    if (x->closed[patch]) front[leaf] = 1;
    if (background) t->sky[k] = x->closed[patch] ? 0 : fmax(0, 1 - front[leaf] - back[leaf]);
    if (!x->linked[patch]) front[leaf] = 0;
  }
  return HR2D_OK;
}

static void add_below(const hr2d_element *element, uint32_t e, double *below) {
  const uint32_t c = element[e].child;
  if (c) below[e] += below[c + 1] + 0.5 * (below[c] - below[c + 1]);
}

/* Turns form factors of own links into D. */
static PetscErrorCode sum_below(hr2dpi_transport *t, double *below) {
  PetscFunctionBegin;
  const hr2dpi_trees *trees = &t->p->trees;
  const hr2d_element *element = hr2d_hierarchy_elements(t->p->hierarchy);
  for (size_t k = trees->owned; k-- > 0;) add_below(element, trees->own[k], below);
  PetscCall(PetscSFBcastBegin(trees->halo, MPI_DOUBLE, below, below, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(trees->halo, MPI_DOUBLE, below, below, MPI_REPLACE));
  for (size_t k = trees->tops; k-- > 0;) add_below(element, trees->top[k], below);
  PetscFunctionReturn(0);
}

static void set_factors(const hr2dpi_transport *t, const uint32_t *list, size_t count,
                        const double *below, const double *sum, double *w) {
  const hr2d_element *element = hr2d_hierarchy_elements(t->p->hierarchy);
  for (size_t k = 0; k < count; k++) {
    const uint32_t c = element[list[k]].child;
    if (!c) continue;
    const double left = fmax(sum[c] - below[c], 0), right = fmax(sum[c + 1] - below[c + 1], 0);
    if (fabs(left - right) <= NOISE * sum[list[k]]) continue;
    const double mean = right + 0.5 * (left - right);
    w[c] = left / mean;
    w[c + 1] = right / mean;
  }
}

static PetscErrorCode make_factors(hr2dpi_transport *t, int sends, double *sum, double **made) {
  PetscFunctionBegin;
  hr2dp *p = t->p;
  const size_t elements = p->trees.elements;
  double *below = hr2dpi_alloc(p, elements, sizeof *below);
  *made = hr2dpi_alloc(p, elements, sizeof **made);
  PetscErrorCode failed = hr2dpi_agree(p, below && *made ? HR2D_OK : HR2D_ENOMEM);
  if (!failed) failed = hr2dpi_transport_link_rows(t, sends, below);
  if (!failed) failed = sum_below(t, below);
  for (size_t e = 0; e < elements && !failed; e++) (*made)[e] = 1;
  if (!failed) {
    set_factors(t, p->trees.own, p->trees.owned, below, sum, *made);
    set_factors(t, p->trees.top, p->trees.tops, below, sum, *made);
  }
  hr2dpi_free(p, below);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

/* K1 on own leaves, of the first band. */
static PetscErrorCode find_rows(hr2dpi_transport *t, double *row) {
  PetscFunctionBegin;
  hr2dp *p = t->p;
  const size_t leaves = p->trees.leaves, field = leaves * p->bands;
  double *one = hr2dpi_alloc(p, 2 * field, sizeof *one);
  PetscErrorCode failed = hr2dpi_agree(p, one ? HR2D_OK : HR2D_ENOMEM);
  for (size_t k = 0; k < field && !failed; k++) one[k] = 1;
  if (!failed) failed = hr2dpi_transport_apply(t, one, one + field);
  for (size_t k = 0; k < leaves && !failed; k++) row[k] = one[field + k * p->bands];
  hr2dpi_free(p, one);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

/* Adds the rounding rest of σ − K1 on the diagonal; `front` becomes its mean. */
static PetscErrorCode set_rest(hr2dpi_transport *t, double *front) {
  PetscFunctionBegin;
  hr2dp *p = t->p;
  double *closure = hr2dpi_alloc(p, p->trees.leaves, sizeof *closure);
  t->mean = hr2dpi_alloc_zero(p, p->patches, sizeof *t->mean);
  PetscErrorCode failed = hr2dpi_agree(p, closure && t->mean ? HR2D_OK : HR2D_ENOMEM);
  if (!failed) failed = find_rows(t, closure);
  for (size_t k = 0; k < p->trees.leaves && !failed; k++) {
    const uint32_t leaf = p->trees.leaf[k];
    front[leaf] = closure[k] = front[leaf] - closure[k];
  }
  t->closure = closure;
  PetscCall(failed);
  PetscCall(hr2dpi_transport_means(t, front));
  for (size_t k = 0; k < p->patches; k++)
    t->mean[k] = hr2dpi_transport_has_root(t, k) ? front[k] : 0;
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, t->mean, (int)p->patches, MPI_DOUBLE, MPI_SUM, p->comm));
  PetscFunctionReturn(0);
}

/* `sum` is σ on leaves, and receives its means.  Both sets of factors are made before either is
   used. */
static PetscErrorCode close_rows(hr2dpi_transport *t, double *front, double *sum) {
  PetscFunctionBegin;
  double *receive = NULL, *send = NULL;
  memcpy(sum, front, t->p->trees.elements * sizeof *sum);
  PetscCall(hr2dpi_transport_means(t, sum));
  PetscErrorCode failed = make_factors(t, 0, sum, &receive);
  send = receive;
  if (!failed && t->p->directed) failed = make_factors(t, 1, sum, &send);
  t->receive = receive;
  t->send = send;
  PetscCall(failed);
  PetscCall(set_rest(t, front));
  PetscFunctionReturn(0);
}

static PetscErrorCode set_by(hr2dpi_transport *t, const hr2dpi_exchange *x, int closure,
                             int background, double *front) {
  PetscFunctionBegin;
  double *const other = front ? front + t->p->trees.elements : NULL;
  PetscCall(hr2dpi_agree(t->p, front ? set_sums(t, x, background, front, other) : HR2D_ENOMEM));
  if (closure) PetscCall(close_rows(t, front, other));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_closure_set(hr2dpi_transport *t, const hr2dpi_exchange *x, int closure) {
  PetscFunctionBegin;
  hr2dp *p = t->p;
  const int background = hr2d_scene_effect(p->scene, HR2D_EFFECT_BACKGROUND, NULL);
  closure = closure && reflects(p);
  if (!closure && !background) PetscFunctionReturn(0);
  double *front = hr2dpi_alloc_zero(p, 2 * p->trees.elements, sizeof *front);
  const PetscErrorCode failed = set_by(t, x, closure, background, front);
  hr2dpi_free(p, front);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

void hr2dpi_closure_move_mean(const hr2dpi_transport *t, const double *radiosity,
                              double *irradiance) {
  const hr2dp *p = t->p;
  for (size_t k = 0; k < p->trees.leaves * p->bands && t->mean; k++) {
    const double mean = t->mean[patch_of(p, k / p->bands)];
    if (fabs(mean) <= ROUNDING) irradiance[k] -= mean * (radiosity[k] - irradiance[k]);
  }
}
