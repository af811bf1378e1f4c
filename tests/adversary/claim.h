/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an answer claims: values of the original's patches, each with the error that the library
   states for it. */
#ifndef HR2D_TESTS_ADVERSARY_CLAIM_H
#define HR2D_TESTS_ADVERSARY_CLAIM_H

#include "adversary/answer.h"

typedef struct adv_claim {
  double value;
  double error; /* |value − truth| is no larger */
} adv_claim;

typedef struct adv_claims {
  size_t count, bands; /* of the original */
  int exist;           /* there is a solution */
  adv_claim average[ADV_QUANTITIES][ADV_PATCHES][ADV_BANDS];
  adv_claim point[ADV_QUANTITIES][ADV_PATCHES][ADV_POINTS][ADV_BANDS];
} adv_claims;

/* The claims of an answer in terms of the original. */
void adv_claims_of(const adv_answer *answer, const adv_scene *original, adv_claims *claims);

/* The absolute errors stated for a patch of the answer's own scene. */
double adv_average_error(const adv_answer *answer, int quantity, size_t patch, size_t band);
double adv_point_error(const adv_answer *answer, int quantity, size_t patch, size_t band);

#endif
