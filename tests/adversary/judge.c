/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Verdicts. */
#include "adversary/judge.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define ROUNDING 0x1p-53

const char *const adv_check_name[ADV_CHECKS] = {
    "average B", "end B",    "point B",           "average H", "end H",  "point H",
    "power",     "negative", "estimate or bound", "status",    "no more"};

void adv_note(adv_outcome *outcome, adv_check check, double ratio, const char *format, ...) {
  if (isnan(ratio)) ratio = INFINITY;
  if (ratio <= outcome->worst[check]) return;
  outcome->worst[check] = ratio;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(outcome->text[check], sizeof outcome->text[check], format, arguments);
  va_end(arguments);
}

unsigned adv_violations(const adv_outcome *outcome) {
  unsigned count = 0;
  for (int check = 0; check < ADV_CHECKS; check++) count += outcome->worst[check] > 1;
  return count;
}

/* deviation / allowed, where 0 / 0 is 0. */
static double share(double deviation, double allowed) {
  return deviation == 0 ? 0 : isinf(allowed) && isfinite(deviation) ? 0 : deviation / allowed;
}

static void error_is_sound(const adv_answer *a, adv_outcome *outcome, hr2d_error e,
                           const char *name) {
  int sound = e.estimate >= 0 && e.estimate <= e.bound &&
              (isfinite(e.bound) || a->status == HR2D_EACCURACY);
  double ratio = sound ? 0 : e.estimate > e.bound ? e.estimate / e.bound : INFINITY;
  adv_note(outcome, ADV_BOUND, ratio, "%s: estimate %g, bound %g, %s", name, e.estimate,
           e.bound, hr2d_strerror(a->status));
}

/* A valid scene has an answer.  One that a budget stopped is none, which is no fault. */
static void status_is_true(const adv_answer *a, adv_outcome *outcome) {
  double estimate =
      a->question.norm == HR2D_NORM_SUP ? a->account.sup.estimate : a->account.average.estimate;
  int solved = a->status == HR2D_OK || a->status == HR2D_EACCURACY;
  if (!solved && a->status != HR2D_STOPPED)
    adv_note(outcome, ADV_STATUS, INFINITY, "refused: %s; %s", hr2d_strerror(a->status),
             a->built ? hr2d_scene_message(a->built) : "");
  if (!solved) return;
  if (a->status == HR2D_OK)
    adv_note(outcome, ADV_STATUS, share(estimate, a->question.error), "OK for %g, estimate %g",
             a->question.error, estimate);
  if ((a->status == HR2D_OK) != !*a->account.reason)
    adv_note(outcome, ADV_STATUS, INFINITY, "%s, reason \"%s\"", hr2d_strerror(a->status),
             a->account.reason);
}

static void nothing_is_negative(const adv_answer *a, adv_outcome *outcome) {
  static const char name[ADV_QUANTITIES] = {'B', 'H'};
  for (int q = 0; q < ADV_QUANTITIES; q++)
    for (size_t k = 0; k < a->scene->count; k++)
      for (size_t band = 0; band < a->scene->bands; band++) {
        if (!(a->average[q][k][band] >= 0))
          adv_note(outcome, ADV_NEGATIVE, INFINITY, "%c of patch %zu, band %zu: %g", name[q], k,
                   band, a->average[q][k][band]);
        for (int j = 0; j < ADV_POINTS; j++)
          if (!(a->point[q][k][j][band] >= 0))
            adv_note(outcome, ADV_NEGATIVE, INFINITY,
                     "%c at a point of original %zu, band %zu: %g", name[q], k, band,
                     a->point[q][k][j][band]);
      }
}

/* With the true B and H, emitted + received − absorbed − escaped is 0.  Averages that are off
   by their stated errors add ∫(1−ρ)|δH| and at most ∫|δB|.  Row sums, from which what escapes
   and what comes in are computed, are within 1e-13 of the length and 64 units in the last place
   of the largest coordinate, or 2^-28 of it where ends pass through patches (visibility.h).
   Pieces of the sky are integrated with the error of H.  Where images of a period are cut off,
   what they make of received and escaped power is told. */
static void power_is_balanced(const adv_answer *a, adv_outcome *outcome, size_t band) {
  const adv_scene *s = a->scene;
  double coordinate = ldexp(1, adv_bits(s) + s->exponent);
  const int shut = s->closed && !adv_has_gas(s); /* light escapes into gas */
  double emitted = 0, errors = 0, rows = 0, gained = 0;
  for (size_t k = 0; k < s->count; k++) {
    double length = adv_length(s, k), rho = s->patch[k].reflectance[band];
    double level = fmax(a->brightest[ADV_B][band], adv_outside(s, band));
    emitted += length * s->patch[k].emission[band];
    errors += length * ((1 - rho) * adv_average_error(a, ADV_H, k, band) +
                        (shut ? 0 : adv_average_error(a, ADV_B, k, band)));
    if (s->pieces) gained += length * adv_average_error(a, ADV_H, k, band);
    rows += level * (1e-13 * length + (s->pierced ? 0x1p-28 : 128 * ROUNDING) * coordinate);
  }
  const double off = a->power_cut_off[band];
  hr2d_power p = a->power[band];
  double size = p.emitted + p.received + fabs(p.absorbed) + fabs(p.escaped);
  double rounding = 8 * ROUNDING * (double)s->count * size;
  double balance = p.emitted + p.received - p.absorbed - p.escaped;
  adv_note(outcome, ADV_POWER, share(fabs(p.emitted - emitted), rounding),
           "emitted %.17g, in truth %.17g", p.emitted, emitted);
  adv_note(outcome, ADV_POWER, share(fabs(balance), errors + rows + rounding + 2 * off),
           "%g + %g - %g - %g = %g, allowed %g", p.emitted, p.received, p.absorbed, p.escaped,
           balance, errors + rows + rounding + 2 * off);
  rows += off;
  if (!(p.escaped >= -rows && p.received >= -rows - gained && p.absorbed >= 0))
    adv_note(outcome, ADV_POWER, INFINITY, "absorbed %g, received %g, escaped %g", p.absorbed,
             p.received, p.escaped);
  if (shut && !(p.escaped <= rows && p.received <= rows))
    adv_note(outcome, ADV_POWER, share(fmax(p.escaped, p.received), rows),
             "closed, but received %g, escaped %g", p.received, p.escaped);
}

void adv_judge_alone(const adv_answer *a, adv_outcome *outcome) {
  outcome->answers++;
  outcome->unreached += a->status == HR2D_EACCURACY;
  outcome->none += !a->solution;
  outcome->longest = fmax(outcome->longest, a->seconds);
  status_is_true(a, outcome);
  if (!a->solution) return;
  error_is_sound(a, outcome, a->account.average, "average B");
  error_is_sound(a, outcome, a->account.sup, "sup B");
#if ADV_ACCOUNT_OF_H
  error_is_sound(a, outcome, a->account.irradiance, "average H");
  error_is_sound(a, outcome, a->account.irradiance_sup, "sup H");
#endif
  nothing_is_negative(a, outcome);
  for (size_t band = 0; band < a->scene->bands; band++) power_is_balanced(a, outcome, band);
}

/* The difference of the two values has one rounding of each. */
void adv_judge_pair(adv_outcome *outcome, adv_check check, adv_claim one, adv_claim two,
                    const char *what) {
  double rounding = ROUNDING * (fabs(one.value) + fabs(two.value));
  double allowed = one.error + two.error + rounding, apart = fabs(one.value - two.value);
  outcome->compared++;
  outcome->vacuous += isinf(allowed);
  adv_note(outcome, check, share(apart, allowed), "%s: %.17g +- %.2g and %.17g +- %.2g", what,
           one.value, one.error, two.value, two.error);
}

static void judge_patch(const adv_claims *one, const adv_claims *two, size_t k, size_t band,
                        adv_outcome *outcome) {
  for (int q = 0; q < ADV_QUANTITIES; q++) {
    char what[60];
    snprintf(what, sizeof what, "patch %zu, band %zu", k, band);
    adv_judge_pair(outcome, q ? ADV_AVERAGE_H : ADV_AVERAGE_B, one->average[q][k][band],
                   two->average[q][k][band], what);
    for (int j = 0; j < ADV_POINTS; j++) {
      static const char *const place[ADV_POINTS] = {
          "start", "end", "near start", "near end", "inside 1", "inside 2", "inside 3"};
      snprintf(what, sizeof what, "patch %zu, band %zu, %s", k, band, place[j]);
      adv_check check = j < ADV_ENDS ? ADV_END_B : ADV_POINT_B;
      if (q) check = check + ADV_AVERAGE_H - ADV_AVERAGE_B;
      adv_judge_pair(outcome, check, one->point[q][k][j][band], two->point[q][k][j][band],
                     what);
    }
  }
}

void adv_judge_claims(const adv_claims *one, const adv_claims *two, adv_outcome *outcome) {
  if (!one->exist || !two->exist) return;
  size_t bands = one->bands < two->bands ? one->bands : two->bands;
  for (size_t k = 0; k < one->count; k++)
    for (size_t band = 0; band < bands; band++) judge_patch(one, two, k, band, outcome);
}

/* A budget of time gives no such disproof: the finer solve may have been lucky. */
void adv_judge_end(const adv_answer *coarse, const adv_answer *fine, adv_outcome *outcome) {
  int gave_up = coarse->status == HR2D_EACCURACY && !strstr(coarse->account.reason, "the time");
  int disproved = gave_up && fine->status == HR2D_OK &&
                  fine->question.error <= coarse->question.error &&
                  fine->question.norm == coarse->question.norm;
  if (disproved)
    adv_note(outcome, ADV_NO_MORE, INFINITY, "%g: \"%s\"; %g is reached",
             coarse->question.error, coarse->account.reason, fine->question.error);
}
