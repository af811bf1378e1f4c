/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Graded trees: elements are as large as radiosity is smooth on them. */
#ifndef HR2D_SRC_MESH_MESH_GRADING_H
#define HR2D_SRC_MESH_MESH_GRADING_H

#include <hr2d/accuracy.h>

#include "hierarchy/hierarchy-impl.h"
#include "mesh/events.h"
#include "scene/scene-impl.h"
#include "visibility/beam-cache.h"

typedef struct hr2di_grading {
  double target;                /* the relative error that corners are graded for */
  hr2d_norm norm;               /* of that error */
  unsigned order;               /* of the elements */
  unsigned corner_levels;       /* levels at corners beyond what the target asks for */
  int no_corner_grading;        /* at corners there are these levels alone */
  double distance;              /* the ellipse at which ends may be; 0: HR2DI_ELLIPSE_DISTANT */
  const hr2di_events *events;   /* where elements end; NULL for none */
  uint64_t max_elements;        /* 0 for no limit */
  hr2di_beam_cache *beam_cache; /* keeps what patches see; NULL: nothing is kept */
  hr2di_watch *watch;           /* NULL: nobody watches */
  unsigned threads;             /* as in options */
} hr2di_grading;

/* The number of generations of events that an error of averages needs, from measurements.  The
   kinks of radiosity change averages by some 1e-4 if elements end at no events, and by 1e-9 if
   they end at those of one generation. */
unsigned hr2di_grading_generations(double error);

/* Facts found while grading. */
typedef struct hr2di_survey {
  double exponent; /* the least γ of a corner, B ~ x^γ; 1 if none reflects light to and fro */
  double ellipse;  /* the least m of a leaf for ends in front of it; at most 3 */
} hr2di_survey;

/* Divides elements, also of trees that are graded already:
   - at visibility events, and where the end of a patch stands on another patch;
   - towards corners, geometrically;
   - until every end in front of an element is at an ellipse of `distance` or more.
   Patches that reflect nothing have B = E and stay whole.  Panes are divided on one side, for
   both; hr2di_pane_trees_unite() does the rest.  Returns HR2D_OK; or, with a part of
   the divisions done, HR2D_ENOMEM, HR2D_EMAX_ELEMENTS or the status of the watch. */
hr2d_status hr2di_grading_apply(hr2d_hierarchy *hierarchy, const hr2di_grading *grading,
                                hr2di_survey *survey);

/* Sets what grading would find of the corners of a scene, and the ellipse to the least that it
   leaves: elements are not divided, and nobody looks what is in front of them.  HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_grading_survey(const hr2d_scene *scene, const hr2di_grading *grading,
                                 hr2di_survey *survey);

/* The part of a patch that is too short to be divided, because of roundings of coordinates. */
double hr2di_grading_shortest(const hr2di_patch *patch);

#endif
