/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of two elements with a common end, by Duffy's transformation.

   At distances σ on i and τ on j from the corner of angle α the kernel is
     k(σ,τ) = ½ σ τ sin²α / (σ² + τ² − 2στ cosα)^{3/2},
   homogeneous of degree −1.  The pair is cut along σ/A_i = τ/A_j.  On the one side σ = A_i u
   and τ = A_j uv, so that with λ = A_j/A_i
     ∫∫ k φ_l φ_m = A_j ∫₀¹ k(1, λv) ∫₀¹ φ_l(u) φ_m(uv) du dv,
   where the integral over u is one of a polynomial of degree 2p − 2, and the only singularities
   in v are at e^{±iα}/λ.  On the other side i and j change places.

   As α → 0 all light stays at its distance from the corner: from σ on i the part
   (1 + cosα)/2 → 1 arrives around τ = σ on j, within some α σ, and
     ∫∫ k φ_l φ_m → ∫ φ_l(σ) φ_m(σ) dσ   over the shorter element. */
#include <math.h>
#include <string.h>

#include "blocks/panels.h"

/* sin α below which the limit stands; its error is of this order. */
#define CLOSED 1e-13

typedef struct corner {
  double sine, versed; /* sin α, 1 − cos α */
  double cosine;
} corner;

static double kernel(const corner *c, double tau) {
  const double apart = 1 - tau, square = apart * apart + 2 * tau * c->versed;
  return 0.5 * tau * c->sine * c->sine / (square * sqrt(square));
}

/* row_k += ∫ over a panel of v of k(1, λv) φ(place of u_k v), for all points u_k. */
static void add_panel(hr2di_integrator *w, const corner *c, double lambda, hr2di_span panel,
                      int at_end, double *row) {
  const size_t p = w->order;
  double phi[HR2D_MAX_ORDER];
  if (hr2di_watch_work(w->watch, 1 + w->near.points * p * p / 16)) return;
  for (size_t q = 0; q < w->near.points; q++) {
    const double part = 0.5 + 0.5 * w->near.at[q];
    const double v = panel.from + part * (panel.to - panel.from);
    const double g = (panel.to - panel.from) * w->near.weight[q] * kernel(c, lambda * v);
    for (size_t k = 0; k < p; k++) {
      const double from = (1 + w->exact.at[k]) * v; /* twice the fraction from the corner */
      hr2di_basis_at(&w->basis, at_end ? 1 - from : from - 1, phi);
      for (size_t m = 0; m < p; m++) row[k * p + m] += g * phi[m];
    }
  }
  w->kernels += w->near.points;
}

/* The integrals over v of one side: row_km = ∫₀¹ k(1, λv) φ_m(u_k v) dv, φ_m on the inner
   element.  The corner is at the end of the inner element, or at its start. */
static void add_side(hr2di_integrator *w, const corner *c, double lambda, int inner_at_end,
                     double *row) {
  hr2di_span stack[128];
  size_t count = 0;
  const hr2d_point pole = {c->cosine / lambda, c->sine / lambda};
  memset(row, 0, w->order * w->order * sizeof *row);
  stack[count++] = (hr2di_span){0, 1};
  while (count > 0) {
    const hr2di_span s = stack[--count];
    const double middle = 0.5 * (s.from + s.to);
    if (count > 100 || !(middle > s.from && middle < s.to) ||
        hr2di_ellipse((hr2d_segment){{s.from, 0}, {s.to, 0}}, pole) >= HR2DI_NEAR_ELLIPSE) {
      add_panel(w, c, lambda, s, inner_at_end, row);
      continue;
    }
    stack[count++] = (hr2di_span){s.from, middle};
    stack[count++] = (hr2di_span){middle, s.to};
  }
}

/* The limit as α → 0.  The corner is at the end of i and the start of j, or the other way
 * round. */
static void add_closed(hr2di_integrator *w, const hr2di_pair_frame *f, int at_end,
                       double *block) {
  const size_t p = w->order;
  const double least = fmin(f->length_i, f->length_j);
  double phi_i[HR2D_MAX_ORDER], phi_j[HR2D_MAX_ORDER];
  for (size_t k = 0; k < p; k++) {
    const double from = (1 + w->exact.at[k]) * least; /* twice the distance from the corner */
    const double on_i = from / f->length_i - 1, on_j = from / f->length_j - 1;
    hr2di_basis_at(&w->basis, at_end ? -on_i : on_i, phi_i);
    hr2di_basis_at(&w->basis, at_end ? on_j : -on_j, phi_j);
    for (size_t l = 0; l < p; l++)
      for (size_t m = 0; m < p; m++)
        block[l * p + m] += least * w->exact.weight[k] * phi_i[l] * phi_j[m];
  }
}

void hr2di_block_touching(hr2di_integrator *w, const hr2di_pair_frame *f, int at_end,
                          double *block) {
  const size_t p = w->order;
  /* Scaled by powers of 2, so that no product underflows; no digit changes. */
  const int e_i = -ilogb(f->length_i), e_j = -ilogb(f->length_j);
  const hr2d_point u = {ldexp(f->along_i.x, e_i), ldexp(f->along_i.y, e_i)};
  const hr2d_point v = {ldexp(f->along_j.x, e_j), ldexp(f->along_j.y, e_j)};
  const double scale = ldexp(f->length_i, e_i) * ldexp(f->length_j, e_j);
  corner c = {.sine = fabs(u.x * v.y - u.y * v.x) / scale,
              .cosine = -(u.x * v.x + u.y * v.y) / scale};
  c.versed = c.cosine > 0 ? c.sine * c.sine / (1 + c.cosine) : 1 - c.cosine;
  if (c.cosine > 0 && c.sine < CLOSED) {
    add_closed(w, f, at_end, block);
    return;
  }
  double *row = w->work;
  add_side(w, &c, f->length_j / f->length_i, !at_end, row);
  for (size_t k = 0; k < p; k++) {
    const double *phi = w->phi_exact + (at_end ? p - 1 - k : k) * p;
    for (size_t l = 0; l < p; l++)
      for (size_t m = 0; m < p; m++)
        block[l * p + m] += f->length_j * w->exact.weight[k] * phi[l] * row[k * p + m];
  }
  add_side(w, &c, f->length_i / f->length_j, at_end, row);
  for (size_t k = 0; k < p; k++) {
    const double *phi = w->phi_exact + (at_end ? k : p - 1 - k) * p;
    for (size_t l = 0; l < p; l++)
      for (size_t m = 0; m < p; m++)
        block[l * p + m] += f->length_i * w->exact.weight[k] * phi[m] * row[k * p + l];
  }
}
