/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The resolution of a graded solve. */
#ifndef HR2D_SRC_ESTIMATE_RESOLUTION_H
#define HR2D_SRC_ESTIMATE_RESOLUTION_H

#include <hr2d/accuracy.h>

#include "mesh/event-selection.h"
#include "visibility/beam-cache.h"

/* How fine a graded solve is. */
typedef struct hr2di_resolution {
  double aim; /* the error */
  unsigned order;
  double target;           /* relative error that corners are graded for */
  double cluster_accuracy; /* relative accuracy of links between clusters of patches */
  double tolerance;        /* of the solve; 0: the least */
  double relative; /* local residual that the solve may leave, relative to the light there;
                      0: the tolerance alone counts */
  double floor;    /* no light counts as less, relative to the brightest */
  hr2d_norm norm;
  unsigned corner_levels; /* levels at corners beyond what the target asks for */
  int no_corner_grading;  /* elements are not graded for the target, but for these levels alone
                           */
  double distance;        /* the least ellipse m of an element at which ends may be in front */
  int has_events;         /* the scene has visibility events */
  int many_patches;       /* it has very many */
  unsigned generations;   /* elements end at events of so many generations */
  int a_posteriori; /* if the error is too large, find the elements that cause it, unless events
                       were selected for very many patches */
  int skip_bound;   /* then measure neither a bound nor the errors at points */
  double kinks;     /* the error that events left inside elements may cause; 0:
                       elements end at all events */
  int single;       /* floats suffice for blocks */
  unsigned raises;  /* how often it was made finer */
  const hr2di_primal_dual *lights; /* of patches, to tell which events matter */
  hr2di_beam_cache *beam_cache; /* what patches see, for all attempts; NULL: nothing is kept */
} hr2di_resolution;

/* The resolution of the finer operator with which a graded solve is compared: it has so many
   coefficients more. */
enum { HR2DI_FINER_ORDERS = 2 };
hr2di_resolution hr2di_resolution_finer(const hr2di_resolution *fineness);

/* No relative accuracy of links of clusters is better. */
#define HR2DI_FINEST_CLUSTERS 1e-14

#endif
