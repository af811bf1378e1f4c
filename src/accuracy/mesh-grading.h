/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trees whose elements are as large as radiosity is smooth on them. */
#ifndef HR2D_SRC_ACCURACY_MESH_GRADING_H
#define HR2D_SRC_ACCURACY_MESH_GRADING_H

#include <hr2d/accuracy.h>

#include "hierarchy/hierarchy-impl.h"
#include "visibility/events.h"

typedef struct hr2di_grading {
  double target;              /* the relative error that corners are graded for */
  hr2d_norm norm;             /* of that error */
  unsigned order;             /* of the elements */
  unsigned corner_levels;     /* levels at corners beyond what the target asks for */
  unsigned halvings;          /* of every element besides */
  const double *weight;       /* see graded.h; NULL: 1 */
  const hr2di_events *events; /* where elements end; NULL for none */
  uint64_t max_elements;      /* 0 for no limit */
} hr2di_grading;

/* The generations of events that an error of averages asks for, from measurements: where no
   event is an element's end, radiosity's kinks do some 1e-4 to averages, beyond one generation
   1e-9. */
unsigned hr2di_grading_generations(double error);

/* What was found on the way. */
typedef struct hr2di_survey {
  double exponent; /* the least γ of a corner, B ~ x^γ; 1 where light goes to and fro in none */
  double ellipse; /* the least m of an element that no end touches; at most 3 */
} hr2di_survey;

/* Divides elements, also of trees that have grown before: at visibility events and where the
   end of a patch stands on another; towards corners, geometrically; and until no end of a patch
   is nearer to an element in front of it than an ellipse of HR2DI_ELLIPSE_DISTANT.  Patches
   that reflect nothing have B = E and stay whole.  HR2D_OK, HR2D_ENOMEM or HR2D_EMAX_ELEMENTS,
   with part of the divisions done. */
hr2d_status hr2di_grading_apply(hr2d_hierarchy *hierarchy, const hr2di_grading *grading,
                                hr2di_survey *survey);

#endif
