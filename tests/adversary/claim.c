/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From relative bounds to absolute errors. */
#include "adversary/claim.h"

#include <math.h>
#include <string.h>

#define ROUNDING 0x1p-53

/* An error of b relative to the true value is one of b/(1−b) relative to the computed value.
   A bound of 1 and more, or none, claims nothing. */
static double relative(hr2d_error error) {
  return error.bound < 1 ? error.bound / (1 - error.bound) : INFINITY;
}

/* 0 · ∞ = 0 for a band without light: nothing is claimed with an infinite bound. */
static double times(double relative_error, double scale) {
  return isinf(relative_error) ? INFINITY : relative_error * scale;
}

static double of_average(const adv_answer *a, hr2d_error error, int q, size_t patch,
                         size_t band) {
  if (!adv_is_asked(&a->question, patch)) return INFINITY;
  return times(relative(error), fmax(fabs(a->average[q][patch][band]),
                                     a->question.floor * a->brightest[q][band]));
}

#if !ADV_ACCOUNT_OF_H
/* The smallest reflectance of the band that is not 0; 1 if all are. */
static double min_reflectance(const adv_scene *scene, size_t band) {
  double min = 1;
  for (size_t k = 0; k < scene->count; k++) {
    double rho = scene->patch[k].reflectance[band];
    if (rho > 0 && rho < min) min = rho;
  }
  return min;
}
#endif

double adv_average_error(const adv_answer *a, int quantity, size_t patch, size_t band) {
  if (quantity == ADV_B) return of_average(a, a->account.average, ADV_B, patch, band);
#if ADV_ACCOUNT_OF_H
  return of_average(a, a->account.irradiance, ADV_H, patch, band);
#else
  double rho = a->scene->patch[patch].reflectance[band];
  if (rho > 0) return of_average(a, a->account.average, ADV_B, patch, band) / rho;
  return adv_point_error(a, ADV_H, patch, band);
#endif
}

double adv_point_error(const adv_answer *a, int quantity, size_t patch, size_t band) {
  if (!adv_is_asked(&a->question, patch)) return INFINITY;
  if (quantity == ADV_B) return times(relative(a->account.sup), a->sup[ADV_B][band]);
#if ADV_ACCOUNT_OF_H
  return times(relative(a->account.irradiance_sup), a->sup[ADV_H][band]);
#else
  double rho = a->scene->patch[patch].reflectance[band];
  return times(relative(a->account.sup), a->sup[ADV_B][band]) /
         (rho > 0 ? rho : min_reflectance(a->scene, band));
#endif
}

/* The average of a patch in parts is Σ of part · average.  Parts are dyadic; the n products and
   sums have n roundings, and the error with the error added has another. */
static void add_average(const adv_answer *a, adv_claims *claims, int q, size_t k, size_t band) {
  const adv_patch *p = &a->scene->patch[k];
  adv_claim *claim = &claims->average[q][p->source][band];
  double part = fabs(p->to - p->from) / a->scene->gain, value = part * a->average[q][k][band];
  claim->value += value;
  claim->error += part * adv_average_error(a, q, k, band) + 2 * ROUNDING * fabs(claim->value);
}

void adv_claims_of(const adv_answer *a, const adv_scene *original, adv_claims *claims) {
  memset(claims, 0, sizeof *claims);
  claims->count = original->count;
  claims->bands = original->bands;
  const double turned = a->scene->turned / a->scene->gain;
  claims->exist = a->solution != NULL;
  for (size_t k = 0; claims->exist && k < a->scene->count; k++) {
    int source = a->scene->patch[k].source;
    for (int q = 0; source >= 0 && q < ADV_QUANTITIES; q++)
      for (size_t band = 0; band < original->bands; band++) {
        add_average(a, claims, q, k, band);
        claims->average[q][source][band].error += turned;
        for (int j = 0; j < ADV_POINTS; j++) {
          adv_claim *claim = &claims->point[q][source][j][band];
          claim->value = a->point[q][source][j][band] / a->scene->gain;
          claim->error = a->pointless
                             ? INFINITY
                             : adv_point_error(a, q, k, band) / a->scene->gain + turned;
        }
      }
  }
}
