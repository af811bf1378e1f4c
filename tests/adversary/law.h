/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws that any solution obeys: copies agree, emissions superpose, exchange is reciprocal, a
   room in equilibrium has B = H = 1. */
#ifndef HR2D_TESTS_ADVERSARY_LAW_H
#define HR2D_TESTS_ADVERSARY_LAW_H

#include "adversary/judge.h"

/* What a law works with; the buffers are the caller's, for they are large. */
typedef struct adv_trial {
  const adv_scene *scene; /* the original */
  adv_question question;
  int fixed;              /* copies have the same target, not a finer one */
  const char *transforms; /* names to choose from, separated by commas; NULL: all */
  const char *corruption; /* see adv_corrupt(); NULL: none */
  adv_random random;
  adv_scene copy[2]; /* those that were solved besides the original */
  adv_answer answer[3];
  adv_claims claims[3];
  int copies;
  int looked;        /* closely, see look_closely() */
  char applied[160]; /* transformations, in their order */
  adv_outcome outcome;
} adv_trial;

typedef struct adv_law {
  const char *name;
  int weight; /* how often it is tried */
  int (*holds_for)(const adv_scene *scene);
  void (*test)(adv_trial *trial);
} adv_law;

/* Ends with a name of NULL. */
extern const adv_law adv_laws[];

/* Draws a law that applies. */
const adv_law *adv_draw_law(const adv_scene *scene, adv_random *r);

/* Tests a scene: the law, question and random numbers are set; the rest is overwritten. */
void adv_try(adv_trial *trial, const adv_law *law);
void adv_end_trial(adv_trial *trial);

/* Falsifies the last answer of a trial, or the bounds of all: a name of adv_corruptions, which
   ends with NULL. */
extern const char *const adv_corruptions[];
void adv_corrupt(const char *how, adv_answer *answer, int last);

#endif
