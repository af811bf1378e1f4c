/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interpolation at Chebyshev points is f ≈ Σ_n c_n T_n, c_n = (1 or 2)/q Σ_k T_n(t_k) f(t_k).
   Applied to what is sent, strengths s at places t become moments Σ s T_n(t), and these
   strengths at the points; applied to what is received it is its transpose. */
#include "clusters/interpolation.h"

/* T_n at a place along both directions. */
typedef struct place {
  double t[2][HR2DI_EXPANSION_POINTS];
} place;

static void place_in(const hr2di_expansion *f, hr2d_point p, place *at) {
  const double along[] = {f->u.x * p.x + f->u.y * p.y, f->u.x * p.y - f->u.y * p.x};
  const unsigned count = f->count[0] > f->count[1] ? f->count[0] : f->count[1];
  double t[2];
  for (int k = 0; k < 2; k++) {
    t[k] = f->half[k] > 0 ? (along[k] - f->at[k]) / f->half[k] : 0;
    at->t[k][0] = 1;
    at->t[k][1] = t[k];
  }
  /* Each value waits for the one before: both directions at a time take no longer than one. */
  for (unsigned n = 2; n < count; n++) {
    at->t[0][n] = 2 * t[0] * at->t[0][n - 1] - at->t[0][n - 2];
    at->t[1][n] = 2 * t[1] * at->t[1][n - 1] - at->t[1][n - 2];
  }
}

void hr2di_interpolation_send(const hr2di_expansion *f, hr2d_point p, size_t planes,
                              const double *strength, double *moment) {
  place at;
  place_in(f, p, &at);
  for (size_t k = 0; k < planes; k++)
    for (unsigned m = 0; m < f->count[1]; m++) {
      const double s = strength[k] * at.t[1][m];
      for (unsigned n = 0; n < f->count[0]; n++) *moment++ += s * at.t[0][n];
    }
}

void hr2di_interpolation_receive(const hr2di_expansion *f, hr2d_point p, size_t planes,
                                 const double *coefficient, double *value) {
  place at;
  place_in(f, p, &at);
  for (size_t k = 0; k < planes; k++) {
    double sum = 0;
    for (unsigned m = 0; m < f->count[1]; m++) {
      double row = 0;
      for (unsigned n = 0; n < f->count[0]; n++) row += *coefficient++ * at.t[0][n];
      sum += row * at.t[1][m];
    }
    value[k] = sum;
  }
}

/* out_a = Σ_b matrix(a,b) in_b along one direction of a plane, where the matrix is
   (1 or 2)/q T, or its transpose. */
static void turn(const hr2di_clusters *c, const hr2di_expansion *f, int along, int transposed,
                 const double *in, double *out) {
  const unsigned count = f->count[along], others = f->count[1 - along];
  const size_t step = along ? f->count[0] : 1, next = along ? 1 : f->count[0];
  const double *t = hr2di_clusters_cosines(c, count);
  for (unsigned o = 0; o < others; o++, in += next, out += next)
    for (unsigned a = 0; a < count; a++) {
      double sum = 0;
      for (unsigned b = 0; b < count; b++) {
        const unsigned n = transposed ? b : a, k = transposed ? a : b;
        sum += (n > 0 ? 2 : 1) * t[n * count + k] * in[b * step];
      }
      out[a * step] = sum / count;
    }
}

void hr2di_interpolation_turn(const hr2di_clusters *c, const hr2di_expansion *f, size_t planes,
                              int transposed, double *plane) {
  double between[HR2DI_CLUSTER_POINTS];
  const size_t points = hr2di_expansion_points(f);
  for (size_t k = 0; k < planes; k++, plane += points) {
    turn(c, f, 0, transposed, plane, between);
    turn(c, f, 1, transposed, between, plane);
  }
}
