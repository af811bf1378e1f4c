/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A coarse link that spreads its exchange evenly over the leaves below makes the row sum K·1 of
   a leaf wrong, although the row sum of the patch is exact.  Let an element c with parent p get
   the light of the links at its ancestors with the factor

     w_c = T_c / mean of T over the children of p,   T_c = σ_c − D_c.

   σ_c is the mean of the exact row sums of c's leaves.  D_c is the mean over c of what the
   links at c and below it contribute to them: F_c, the form factors of c's own links, and the
   mean of D over c's children.  As each link has its exact exchange, T_c is exactly what comes
   from above. A pull with the same factors is the transpose of the push.  Then
   - rows are exact: by induction ΣT is what arrives, so that a leaf gets T + F = σ;
   - K stays symmetric and ≥ 0.  So I − ρK is an M-matrix with row sums 1 − ρσ, the discrete
     equation has one solution wherever ρ < 1, for every ε, and B ≥ 0;
   - the mean of w is 1: the exchange of every two patches stays exact.  So averages lose no
     digit that they have without closure because B is constant on each patch that sends light
     (d·B on the diagonal makes rows exact, too, but adds ∫dB to averages).

   Gas divides the light of a link into what arrives and what it absorbs: F and D have both, and
   w spreads both.

   Directed links have factors for the push by the links over which an element receives, and
   others for the pull by the links over which it sends. */
#include "solve/closure.h"

#include <math.h>

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/patch-defect.h"

/* Differences of T below this part of σ may be roundings: light is spread evenly. */
#define NOISE HR2DI_DEFECT_CLOSED

/* Sets `below` to D, and `sum` to the mean of σ, of every element. */
static void sum_rows(hr2di_transport *t, const hr2di_row_sums *rows, const double *absorbed,
                     int sends, double *below, double *sum) {
  const hr2d_element *element = t->hierarchy->element;
  hr2di_transport_link_rows(t, sends, below);
  for (size_t k = t->elements; k-- > 0;) {
    const uint32_t c = element[k].child;
    if (absorbed) below[k] += absorbed[k];
    sum[k] = rows->front[k];
    if (!c) continue;
    const double part = hr2di_element_left_part(element, (uint32_t)k);
    below[k] += below[c + 1] + part * (below[c] - below[c + 1]);
    sum[k] = sum[c + 1] + part * (sum[c] - sum[c + 1]);
  }
}

/* Sets w of every element. */
static void set_factors(hr2di_transport *t, const double *below, const double *sum, double *w) {
  const hr2d_element *element = t->hierarchy->element;
  for (size_t k = 0; k < t->elements; k++) w[k] = 1;
  for (size_t k = 0; k < t->elements; k++) {
    const uint32_t c = element[k].child;
    if (!c) continue;
    const double part = hr2di_element_left_part(element, (uint32_t)k);
    const double left = fmax(sum[c] - below[c], 0), right = fmax(sum[c + 1] - below[c + 1], 0);
    if (fabs(left - right) <= NOISE * sum[k]) continue;
    const double mean = right + part * (left - right);
    w[c] = left / mean;
    w[c + 1] = right / mean;
  }
}

static hr2d_status make_factors(hr2di_transport *t, const hr2di_row_sums *rows,
                                const double *absorbed, int sends, double **made) {
  double *below = hr2di_alloc(&t->alloc, t->elements, 2 * sizeof *below);
  *made = hr2di_alloc(&t->alloc, t->elements, sizeof **made);
  if (below && *made) {
    sum_rows(t, rows, absorbed, sends, below, below + t->elements);
    set_factors(t, below, below + t->elements, *made);
  }
  hr2di_alloc_free(&t->alloc, below);
  return !below || !*made ? HR2D_ENOMEM : t->failed;
}

/* What roundings leave of σ − K·1 is added on the diagonal. */
static hr2d_status set_rest(hr2di_transport *t, const hr2di_row_sums *rows) {
  double *closure = hr2di_alloc(&t->alloc, t->leaves, sizeof *closure);
  double *unit = hr2di_alloc(&t->alloc, t->leaves, sizeof *unit);
  double *row = hr2di_alloc(&t->alloc, t->leaves, sizeof *row);
  const int room = closure && unit && row;
  if (room) {
    for (size_t k = 0; k < t->leaves; k++) unit[k] = 1;
    hr2di_transport_apply(t, unit, row);
    for (size_t k = 0; k < t->leaves && !t->failed; k++)
      closure[k] = rows->front[t->leaf[k]] - row[k];
    t->closure = closure;
  } else {
    hr2di_alloc_free(&t->alloc, closure);
  }
  hr2di_alloc_free(&t->alloc, unit);
  hr2di_alloc_free(&t->alloc, row);
  return room ? t->failed : HR2D_ENOMEM;
}

/* Both sets of factors are made before either is used. */
hr2d_status hr2di_closure_set(hr2di_transport *t, const hr2di_row_sums *rows,
                              const double *absorbed) {
  double *receive, *send;
  hr2d_status status = make_factors(t, rows, absorbed, 0, &receive);
  send = receive;
  if (!status && t->links->directed) status = make_factors(t, rows, absorbed, 1, &send);
  t->receive = receive;
  t->send = send;
  return status ? status : set_rest(t, rows);
}
