/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One evaluation of a climb: a scene is solved as it is asked, and as finely as that takes to
   judge the answer. */
#ifndef HR2D_TESTS_ADVERSARY_MEASURE_H
#define HR2D_TESTS_ADVERSARY_MEASURE_H

#include "adversary/judge.h"

/* What climbs: |error|/bound of averages of B and of H, and of both at points; and
   |error|/estimate of averages of B. */
enum { ADV_CLIMB_B, ADV_CLIMB_H, ADV_CLIMB_POINT, ADV_CLIMB_ESTIMATE, ADV_OBJECTIVES };

/* Large, so the caller keeps it. */
typedef struct adv_measure {
  int exists; /* both solves have an answer */
  double ratio[ADV_OBJECTIVES];
  adv_outcome outcome;
  adv_answer asked, truth;
  adv_claims claimed, right;
} adv_measure;

/* Measures, and judges twice before it tells of a violation. */
void adv_take_measure(const adv_scene *scene, const adv_question *question,
                      const char *corruption, adv_measure *measure);

#endif
