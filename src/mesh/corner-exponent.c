/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exponent of a corner from the Mellin transform of its kernel.

   K̂ is a Legendre function (Gradshteyn and Ryzhik 3.252.10): with z = cos²(α/2), δ = 1−z,

     K̂(γ) = ½ sinα Γ(2+γ) Γ(1−γ) P_γ⁻¹(−cosα) = z Γ(2+γ) Γ(1−γ) F(−γ, 1+γ; 2; z),

   for γ from 0 to 1, with a pole at γ = 1.  F is a power series in z, or, since
   2 = −γ + 1+γ + 1, one in δ with ln δ (DLMF 15.8.10),

     K̂(γ) = z (1 − γ(1+γ) δ Σ_k (1−γ)_k (2+γ)_k / (k! (k+1)!) δ^k L_k),
     L_k = ln δ − ψ(k+1) − ψ(k+2) + ψ(1−γ+k) + ψ(2+γ+k).

   K̂ − 1 is of the size of δ.  It may be 1e-17, and so may 1/√(ρ1ρ2) − 1: both are computed
   without the 1.  The unknown is η = 1−γ, and a factor η removes the pole. */
#include "mesh/corner-exponent.h"

#include <gsl/gsl_math.h>
#include <gsl/gsl_sf_psi.h>
#include <math.h>

/* Terms fall at least like 2^-k. */
enum { TERMS = 60, STEPS = 100 };

typedef struct corner {
  double z, delta; /* cos²(α/2), sin²(α/2) */
  double missing;  /* 1/√(ρ1ρ2) − 1 */
} corner;

static double over_sine(double x) {
  return x > 0 ? x / sin(x) : 1;
}

/* η K̂ by the series in z. */
static double transform_at_wide(const corner *c, double eta) {
  const double gamma = 1 - eta;
  /* η Γ(2+γ) Γ(1−γ) = (1+γ) γ πη / sin πη, and sin πη = sin πγ. */
  const double gammas =
      (1 + gamma) * (eta < 0.5 ? gamma * over_sine(M_PI * eta) : eta * over_sine(M_PI * gamma));
  double term = 1, sum = 1;
  for (int k = 0; k < TERMS; k++) {
    term *= (k - gamma) * (k + 1 + gamma) / ((k + 2.0) * (k + 1.0)) * c->z;
    sum += term;
    if (fabs(term) < 0.25 * GSL_DBL_EPSILON * fabs(sum)) break;
  }
  return c->z * gammas * sum;
}

/* η (K̂ − 1) by the series in δ.  ψ(η) = ψ(1+η) − 1/η. */
static double excess_at_narrow(const corner *c, double eta) {
  const double gamma = 1 - eta;
  double psi = log(c->delta) + 2 * M_EULER - 1 + gsl_sf_psi(1 + eta) + gsl_sf_psi(3 - eta);
  double sum = eta * psi - 1;
  double factor = eta; /* η (1−γ)_k (2+γ)_k / (k! (k+1)!) δ^k */
  for (int k = 0; k < TERMS; k++) {
    /* L_k+1 − L_k; its term 1/(k+η) has a pole at k = 0, which is in psi already. */
    const double step = (k > 0 ? 1 / (k + eta) : 0) + 1 / (k + 2 + gamma);
    psi += step - 1 / (k + 1.0) - 1 / (k + 2.0);
    factor *= (k + eta) * (k + 2 + gamma) / ((k + 1.0) * (k + 2.0)) * c->delta;
    sum += factor * psi;
    if (fabs(factor * psi) < 0.25 * GSL_DBL_EPSILON * fabs(sum)) break;
  }
  return -c->delta * (eta + c->z * gamma * (1 + gamma) * sum);
}

/* η (K̂ − 1/√(ρ1ρ2)): negative at η = 1, and positive at η = 0. */
static double residual(const corner *c, double eta) {
  if (c->z > 0.5) return excess_at_narrow(c, eta) - eta * c->missing;
  return transform_at_wide(c, eta) - eta * (1 + c->missing);
}

/* Regula falsi; the value at an end that stays is halved (Illinois). */
static double find_root(const corner *c) {
  double low = 0, high = 1, at_low = residual(c, low), at_high = residual(c, high);
  if (!(at_high < 0)) return high;
  if (!(at_low > 0)) return low;
  int stayed = 0;
  for (int k = 0; k < STEPS && high - low > 1e-14; k++) {
    double eta = low + (high - low) * (at_low / (at_low - at_high));
    if (!(eta > low && eta < high) || k % 8 == 7) eta = 0.5 * (low + high);
    const double value = residual(c, eta);
    if (value == 0) return eta;
    if (value > 0) {
      low = eta, at_low = value;
      if (stayed > 0) at_high *= 0.5;
      stayed = 1;
    } else {
      high = eta, at_high = value;
      if (stayed < 0) at_low *= 0.5;
      stayed = -1;
    }
  }
  return 0.5 * (low + high);
}

double hr2di_corner_exponent(double angle, double rho1, double rho2) {
  const double sine = sin(0.5 * angle), cosine = cos(0.5 * angle);
  const double mean = sqrt(rho1) * sqrt(rho2);
  /* 1 − ρ1ρ2, without cancellation where both are close to 1. */
  const double lost = (1 - rho1) + rho1 * (1 - rho2);
  const corner c = {cosine * cosine, fmax(sine * sine, GSL_DBL_MIN),
                    lost / (mean * (1 + mean))};
  if (!(mean > 0 && c.missing < HUGE_VAL && cosine > 0)) return 1;
  return 1 - find_root(&c);
}
