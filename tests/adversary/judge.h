/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Verdicts: an answer by itself, and two sets of claims against each other. */
#ifndef HR2D_TESTS_ADVERSARY_JUDGE_H
#define HR2D_TESTS_ADVERSARY_JUDGE_H

#include "adversary/claim.h"

typedef enum adv_check {
  ADV_AVERAGE_B, /* the checks of H follow those of B */
  ADV_END_B,
  ADV_POINT_B,
  ADV_AVERAGE_H,
  ADV_END_H,
  ADV_POINT_H,
  ADV_POWER,    /* emitted + received = absorbed + escaped */
  ADV_NEGATIVE, /* B ≥ 0, H ≥ 0 */
  ADV_BOUND,    /* 0 ≤ estimate ≤ bound < ∞, or a status that says so */
  ADV_STATUS,   /* OK only below the target; a reason if and only if not */
  ADV_NO_MORE,  /* "no more digits" and a finer target that is reached */
  ADV_CHECKS
} adv_check;

extern const char *const adv_check_name[ADV_CHECKS];

typedef struct adv_outcome {
  double worst[ADV_CHECKS]; /* deviation / what is allowed; above 1 it is a violation */
  char text[ADV_CHECKS][240];
  unsigned answers;           /* solves */
  unsigned unreached;         /* of these, with HR2D_EACCURACY */
  unsigned none;              /* of these, without a solution; or stopped */
  unsigned compared, vacuous; /* values, and those for which nothing was claimed */
  double longest;             /* seconds of a solve, by the clock */
} adv_outcome;

/* Notes a deviation. */
#ifdef __GNUC__
__attribute__((format(printf, 4, 5)))
#endif
void adv_note(adv_outcome *outcome, adv_check check, double ratio, const char *format, ...);

/* The number of checks that are violated. */
unsigned adv_violations(const adv_outcome *outcome);

/* Whether an answer agrees with itself. */
void adv_judge_alone(const adv_answer *answer, adv_outcome *outcome);

/* Whether two values can have errors as small as claimed. */
void adv_judge_pair(adv_outcome *outcome, adv_check check, adv_claim one, adv_claim two,
                    const char *what);

/* Whether two sets of claims are of the same truth. */
void adv_judge_claims(const adv_claims *one, const adv_claims *two, adv_outcome *outcome);

/* Whether a coarse answer that says that nothing more can be had is disproved by a finer one.
 */
void adv_judge_end(const adv_answer *coarse, const adv_answer *fine, adv_outcome *outcome);

#endif
