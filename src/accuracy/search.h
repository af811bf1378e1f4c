/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A search for elements that reach a target: attempts, of which the best is kept, and the time
   and the budget that they have.  All shares of a search have the same statuses. */
#ifndef HR2D_SRC_ACCURACY_SEARCH_H
#define HR2D_SRC_ACCURACY_SEARCH_H

#include "accuracy/strategy.h"
#include "estimate/group-estimate.h"

/* The best graded solve so far, and the time and work of all. */
typedef struct hr2di_search {
  const hr2d_scene *scene;
  hr2d_target target;          /* the caller's, whose progress callback looks at the clock */
  hr2d_target given;           /* the caller's; its error is 0 for the smallest */
  double start, deadline;      /* deadline 0: none */
  int keeps_operator;          /* the best one is to solve for other light, too */
  int out_of_time;             /* a call was ended because the time was up */
  hr2d_status progress_status; /* of the caller's progress callback */
  hr2di_survey survey;
  hr2di_graded best;
  hr2di_resolution fineness;   /* of the best */
  hr2di_primal_dual lights;    /* where there are events */
  hr2di_beam_cache beam_cache; /* of patches, if they are kept */
  hr2d_account account;        /* of the best, with all times */
  hr2d_error error;            /* of the best, the larger one of B and H */
  double cut_off;              /* what of it images may make that are cut off, */
  size_t cut_off_patch;        /* most of the average of this patch, */
  double cut_off_part;         /* where it is this part of the largest value */
  double rounding;             /* the part of its bound that is rounding */
  hr2di_message message;
} hr2di_search;

/* Begins a search, whose account takes times from now on.  The search must stay where it is,
   and is to be cleared, also on failure. */
hr2d_status hr2di_search_init(hr2di_search *s, const hr2d_scene *scene,
                              const hr2d_target *target);
void hr2di_search_clear(hr2di_search *s);

/* Where looks of patches are kept; NULL if they are not. */
hr2di_beam_cache *hr2di_search_beam_cache(hr2di_search *s);

/* Seconds that are left; HUGE_VAL without a deadline. */
double hr2di_search_left(const hr2di_search *s);

/* The status of all shares.  They know then, too, whether it was the clock or a callback that
   ended a call. */
hr2d_status hr2di_search_agree(hr2di_search *s, hr2d_status status);

/* The estimate of the best one in the norm of the target, and whether that reaches an error. */
double hr2di_search_error(const hr2di_search *s);
int hr2di_search_reached(const hr2di_search *s, double error);

/* Whether what is left of the error is rounding. */
int hr2di_search_is_rounding(const hr2di_search *s);

/* Whether what is left is mostly that of images that are cut off: then elements do not matter.
 */
int hr2di_search_is_cut_off(const hr2di_search *s, double error);

/* One constant per patch, of unknown error, to have an answer whatever happens.  If the time
   does not suffice for all factors of whole patches, nothing better is tried. */
hr2d_status hr2di_search_fallback(hr2di_search *s);

/* Solves once, estimates the error, and keeps the graded solve if it is the best so far.  With
   `dividing` the elements are those of the best, divided, and it is also kept if its error is a
   little larger. */
hr2d_status hr2di_search_attempt(hr2di_search *s, const hr2di_resolution *fineness,
                                 int dividing);

/* Bounds the error of the best one, if that was too large for anybody to ask. */
hr2d_status hr2di_search_bound(hr2di_search *s);

#endif
