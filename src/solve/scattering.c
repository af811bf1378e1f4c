/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/scattering.h"

#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"

hr2d_status hr2di_scattering_init(hr2di_scattering *s, const hr2di_transport *t) {
  *s = (hr2di_scattering){0};
  for (size_t k = 0; k < t->leaves && t->other_leaf; k++) s->pairs += k < t->other_leaf[k];
  if (s->pairs == 0) return HR2D_OK;
  s->pair = hr2di_alloc(&t->alloc, s->pairs, sizeof *s->pair);
  s->matrix =
      hr2di_alloc(&t->alloc, s->pairs * HR2DI_SCATTERING_PARTS, t->bands * sizeof *s->matrix);
  if (!s->pair || !s->matrix) return HR2D_ENOMEM;
  for (size_t k = 0, at = 0; k < t->leaves; k++)
    if (k < t->other_leaf[k]) s->pair[at++] = (hr2di_leaf_pair){(uint32_t)k, t->other_leaf[k]};
  return HR2D_OK;
}

void hr2di_scattering_clear(hr2di_scattering *s, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, s->pair);
  hr2di_alloc_free(alloc, s->matrix);
  *s = (hr2di_scattering){0};
}

/* Eigenvalues below this part of the larger one are roundings. */
#define ROUNDING (8 * DBL_EPSILON)

/* f(λ) for the eigenvalues of S, of which `largest` is the larger one. */
static double part_of(hr2di_scattering_part part, double value, double largest) {
  const double root = fabs(value) > ROUNDING * largest ? sqrt(fabs(value)) : 0;
  switch (part) {
  case HR2DI_SCATTERING_ROOT:
    return root;
  case HR2DI_SCATTERING_SIGNED_ROOT:
    return value < 0 ? -root : root;
  case HR2DI_SCATTERING_INVERSE_ROOT:
    return root > 0 ? 1 / root : 0;
  default:
    return value;
  }
}

/* f(S) = ½(f₁ + f₂) + ½(f₁ − f₂) (S − λ)/r, with the mean λ of the eigenvalues and half their
   difference r. */
static hr2di_pane_matrix function_of(hr2di_pane_matrix s, hr2di_scattering_part part) {
  const double mean = 0.5 * (s.a + s.d), half = 0.5 * (s.a - s.d), r = hypot(half, s.c);
  const double high = part_of(part, mean + r, mean + r),
               low = part_of(part, mean - r, mean + r);
  if (part == HR2DI_SCATTERING || !(r > 0)) /* a pane that lets nothing through, in this band */
    return part == HR2DI_SCATTERING ? s : (hr2di_pane_matrix){high, 0, high};
  const double sum = 0.5 * (high + low), rest = 0.5 * (high - low);
  return (hr2di_pane_matrix){sum + rest * (half / r), rest * (s.c / r),
                             sum - rest * (half / r)};
}

static int is_indefinite(hr2di_pane_matrix s) {
  const double mean = 0.5 * (s.a + s.d), r = hypot(0.5 * (s.a - s.d), s.c);
  return mean - r < -ROUNDING * (mean + r);
}

hr2d_status hr2di_scattering_set(hr2di_scattering *s, const hr2di_transport *t) {
  s->indefinite = 0;
  for (size_t k = 0; k < s->pairs; k++) {
    const size_t patch = t->hierarchy->element[t->leaf[s->pair[k].front]].patch;
    const hr2d_status status = hr2di_watch_work(t->watch, 1 + t->bands);
    if (status) return status;
    for (size_t b = 0; b < t->bands; b++) {
      const hr2di_pane_matrix of = hr2di_pane_scattering(t->scene, patch, b);
      for (int p = 0; p < HR2DI_SCATTERING_PARTS; p++)
        s->matrix[(k * HR2DI_SCATTERING_PARTS + (size_t)p) * t->bands + b] =
            function_of(of, (hr2di_scattering_part)p);
      s->indefinite |= is_indefinite(of);
    }
  }
  return HR2D_OK;
}

static const hr2di_pane_matrix *matrices_of(const hr2di_scattering *s, size_t pair,
                                            hr2di_scattering_part part, size_t bands) {
  return s->matrix + (pair * HR2DI_SCATTERING_PARTS + (size_t)part) * bands;
}

void hr2di_scattering_apply(const hr2di_scattering *s, hr2di_scattering_part part, size_t order,
                            size_t bands, double *field) {
  for (size_t k = 0; k < s->pairs; k++) {
    const hr2di_pane_matrix *of = matrices_of(s, k, part, bands);
    double *front = field + s->pair[k].front * order * bands,
           *back = field + s->pair[k].back * order * bands;
    for (size_t m = 0; m < order * bands; m++) {
      const hr2di_pane_matrix *f = &of[m % bands];
      const double c = m / bands % 2 ? -f->c : f->c, u = front[m], v = back[m];
      front[m] = f->a * u + c * v;
      back[m] = c * u + f->d * v;
    }
  }
}

double hr2di_scattered_at(const hr2di_transport *t, size_t leaf, size_t l, size_t band,
                          const double *irradiance) {
  const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch, at = l * t->bands + band;
  const double own =
      hr2d_scene_reflectance(t->scene, patch, band) * irradiance[leaf * t->width + at];
  const size_t other = t->other_leaf ? t->other_leaf[leaf] : leaf;
  if (other == leaf) return own;
  const double passed =
      hr2d_scene_transmittance(t->scene, patch, band) * irradiance[other * t->width + at];
  return l % 2 ? own - passed : own + passed;
}
