/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the library answers: the status, the account, averages, points, the power. */
#ifndef HR2D_TESTS_ADVERSARY_ANSWER_H
#define HR2D_TESTS_ADVERSARY_ANSWER_H

#include "adversary/scene.h"

/* Quantities that are compared. */
enum { ADV_B, ADV_H, ADV_QUANTITIES };

/* On each patch of the original B and H are compared at both ends, near both, and at three
   points between. */
enum { ADV_POINTS = 7, ADV_ENDS = 2 };

typedef struct adv_points {
  double t[ADV_PATCHES][ADV_POINTS];
} adv_points;

/* Multiples of 2^-levels, with as many levels as leave the points doubles on a grid of `bits`
   bits.  Then neither the points of the original nor those of its copy are rounded. */
adv_points adv_choose_points(adv_random *r, int bits);

/* The account has errors of H, and the target a floor.  Before it had, H is judged by the
   errors of B, divided by the reflectance. */
#ifdef HR2D_FLOOR
#define ADV_ACCOUNT_OF_H 1
#else
#define ADV_ACCOUNT_OF_H 0
#endif

enum { ADV_IMPORTANT = 2 };

typedef struct adv_question {
  double error, seconds; /* of hr2d_target */
  hr2d_norm norm;
  double floor; /* averages below this part of the brightest count as equally dark */
  size_t important[ADV_IMPORTANT], important_count; /* patches that are told; none: all count */
  double stop; /* seconds of the processor's time after which a solve is stopped; 0: there is
                  a budget, and it is stopped after four times that */
} adv_question;

/* Whether the target, and the stated errors of averages, hold for a patch. */
int adv_is_asked(const adv_question *question, size_t patch);

typedef struct adv_answer {
  const adv_scene *scene;
  hr2d_scene *built;
  hr2d_solution *solution;
  adv_question question;
  hr2d_status status; /* of commit or of the solve */
  hr2d_account account;
  double seconds; /* as the adversary's own clock has it */
  double average[ADV_QUANTITIES][ADV_PATCHES][ADV_BANDS]; /* of patches of this scene */
  double point[ADV_QUANTITIES][ADV_PATCHES][ADV_POINTS][ADV_BANDS]; /* of the original's */
  double brightest[ADV_QUANTITIES][ADV_BANDS];                      /* over all averages */
  double sup[ADV_QUANTITIES][ADV_BANDS]; /* over all points and averages that were read */
  hr2d_power power[ADV_BANDS];
  double power_cut_off[ADV_BANDS];
  int pointless;  /* there is a point without values, as symmetry.h says */
  double cut_off; /* hr2d_scene_cut_off() */
} adv_answer;

/* Solves a scene and reads all values; `points` are those of the original.  A solve that goes
   on for four times its budget is stopped.  To be cleared whatever happens. */
void adv_ask(const adv_scene *scene, adv_question question, const adv_points *points,
             adv_answer *answer);
void adv_forget(adv_answer *answer);

/* Reads 119 points on each patch more, for the largest values of each band. */
void adv_look_closely(adv_answer *answer);

#endif
