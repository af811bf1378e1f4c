/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The finer operator, a solution, and the fields from which the error of the solution is made.
   All are in the unit of the equation. */
#ifndef HR2D_SRC_ESTIMATE_ESTIMATOR_H
#define HR2D_SRC_ESTIMATE_ESTIMATOR_H

#include "base/legendre.h"
#include "estimate/corner-residuals.h"
#include "estimate/graded-solve.h"
#include "solve/reduced-equation.h"

/* What roundings may be, relative to the largest value. */
#define HR2DI_ESTIMATOR_ROUNDING (16 * DBL_EPSILON)

typedef struct hr2di_estimator {
  hr2di_equation eq;
  hr2di_equation part; /* `eq` at a lower order, for light that has been reflected */
  int whole;           /* `part` does not suffice: solve `eq` itself */
  const hr2d_solution *coarse;
  const hr2d_target *target;
  const double *unresolved_jump; /* see hr2di_graded */
  size_t jump_bands;             /* of these; there may be several lights of as many bands */
  double exponent;               /* γ, the least of the corners */
  double margin;                 /* of bounds over estimates */
  double blind; /* the aim, where events inside elements may hide errors; else 0 */
  hr2di_contacts contacts;
  hr2di_basis basis;
  hr2di_rule rule;
  double *space;
  size_t room;              /* numbers there */
  double level_uncertainty; /* of the levels of components, see energy-balance.h */
  size_t values;            /* patches × bands */
  double *kept;             /* the field of B_h */
  double *rest;             /* of B_h less the level of closed components */
  double *error;            /* B − B_h */
  double *residual;         /* r */
  double *tail;             /* what a check of the extrapolation over a period leaves of H; NULL
                               without one, as the next ones */
  double *past[2];     /* patches × bands: what may be missing of averages of B and H, with all
                          reflections, */
  double *past_max[2]; /* and that at most */
  double *far[2];      /* per band: the same of B and H at points, */
  double *far_max[2];  /* and that at most */
  double *average[2];  /* patches × bands: errors of averages, of B and of H */
  double *rounding[2]; /* likewise what roundings may be */
  double *max;         /* elements × bands: |field| at most */
  double *own;        /* likewise: stands for the own |B| of the element in the rounding of H */
  double *off[2];     /* leaves × bands: rounding error of H, as used in B and as reported */
  double *level;      /* likewise: |c| of balanced components that are not closed, else 0 */
  double *floor;      /* 2 × bands, of B and of H: no average counts as less */
  double *safe;       /* likewise: the worst error of an average without signs, */
  double *scatter;    /* and the size that it has with random ones */
  double *weight;     /* leaves × bands: from B − B_h on a leaf to its relative error */
  double *largest[2]; /* per band: B and H at a point */
  double *point[2];   /* per band: errors at points of important patches, of B and of H */
  double *narrow[2];  /* per band: errors at points beside gaps that nothing resolves */
  double *stray[2];   /* per band: what roundings may be at points */
  int *exponent_of;   /* per band: what a solve is scaled by */
} hr2di_estimator;

/* The order of the part of an equation.  Coefficients that it lacks hardly matter to light that
   is reflected twice: the part takes that on.  With two of seven what is left does not shrink
   where rooms are joined by doors, with three it does. */
static inline size_t hr2di_estimator_part_order(size_t order) {
  const size_t min = order < 6 ? 2 : 3;
  return order / 3 > min ? order / 3 : min;
}

/* Makes an estimator with the finer operator on the trees and links of an answer.  The roots of
   `how` and the target must outlive it.  Returns HR2D_OK, or a status with a message in the
   links.  The estimator must not be moved; call hr2di_estimator_clear() in any case. */
hr2d_status hr2di_estimator_init(hr2di_estimator *e, const hr2di_graded *answer,
                                 const hr2di_equation_how *how, const hr2d_target *target);
void hr2di_estimator_clear(hr2di_estimator *e);

/* Turns it to a solution on these trees and links, for the light that the scene has now.
   HR2D_OK, or HR2D_ENOMEM, or the status of the watch. */
hr2d_status hr2di_estimator_take(hr2di_estimator *e, const hr2d_solution *solution);

/* What roundings of K may be, relative to the largest irradiance: with those of blocks. */
double hr2di_estimator_rounding(const hr2di_estimator *e);

/* Whether the watch has stopped, or a gather has failed: fields have no meaning then. */
int hr2di_estimator_stopped(const hr2di_estimator *e);

/* The largest |value| of a field on a leaf, in a band. */
double hr2di_estimator_max(const hr2di_estimator *e, const double *field, size_t leaf,
                           size_t band);

/* Sets e->max to the largest |field| on each element. */
void hr2di_estimator_set_max(hr2di_estimator *e, const double *field);

/* Lifts values of leaves, in an array of elements × bands, to all elements as the largest. */
void hr2di_estimator_lift(const hr2di_estimator *e, double *max);

/* ρ of the patch of a leaf, of a pane the most of ρ + τ on either side. */
double hr2di_estimator_rho(const hr2di_estimator *e, size_t leaf, size_t band);

/* Notes in `point` that H at a point of a patch is off by `error`, and B by ρ times that.  Does
   nothing if the patch is not important. */
void hr2di_estimator_off(hr2di_estimator *e, double *const point[2], size_t patch, size_t band,
                         double error);

/* Coefficient m of a leaf in the field that is everywhere as bright as the brightest sky: 0
   unless m is the constant coefficient of a band. */
double hr2di_estimator_sky(const hr2di_estimator *e, size_t m);

/* Averages of a field over the patches. */
void hr2di_estimator_averages(hr2di_estimator *e, const double *field, double *average);

/* What a solve of the estimator is for: errors, of which the largest counts relative to what it
   is an error of, or the importance of residuals for an average, whose sum counts. */
typedef enum hr2di_estimator_aim { HR2DI_AIM_ERRORS, HR2DI_AIM_IMPORTANCE } hr2di_estimator_aim;

/* Solves for the source of the equation; changes its y.  If e->whole is set, this solves e->eq.
   Otherwise it solves e->part alone: the coefficients that the part lacks are those of the
   source in the radiosity, and 0 in the irradiance.  Returns HR2D_OK or the status of the
   solve. */
hr2d_status hr2di_estimator_solve(hr2di_estimator *e, double tolerance);

/* The same, to the relative accuracy `part` on dark patches as well: the norm of a plain solve
   is dominated by the largest values. */
hr2d_status hr2di_estimator_solve_part(hr2di_estimator *e, double part,
                                       hr2di_estimator_aim aim);

/* An average of the solution: of B, or of H. */
double hr2di_estimator_value(const hr2di_estimator *e, int irradiance, size_t patch,
                             size_t band);

/* The largest one. */
double hr2di_estimator_largest(const hr2di_estimator *e, int irradiance, size_t band);

/* The value that the error of an average is relative to: the average, but no less than the
   floor. */
double hr2di_estimator_min(const hr2di_estimator *e, int irradiance, size_t patch, size_t band);

#endif
