/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a point of a patch sees past the ends of a period: form factors, from what it sees of
   the last images. */
#ifndef HR2D_SRC_VISIBILITY_PERIODIC_TAIL_H
#define HR2D_SRC_VISIBILITY_PERIODIC_TAIL_H

#include "scene/symmetry.h"
#include "visibility/point-view.h"

enum { HR2DI_SKIES = 4 /* at both ends, below and above */ };

typedef struct hr2di_periodic_tail {
  double ends;                                  /* of all that is there: exact */
  double back;                                  /* of backs */
  double sky[HR2DI_SKIES];                      /* of the sky, at */
  double bearing[HR2DI_SKIES];                  /* this bearing, */
  double check[HR2DI_TAIL_CHECKS][HR2DI_SKIES]; /* and what checks of its series leave of it */
} hr2di_periodic_tail;

/* Of the view `seen` from fraction t of a patch.  All is 0 where nothing is cut off. */
void hr2di_periodic_tail_of(const hr2d_scene *scene, size_t patch, double t,
                            const hr2di_view_from *seen, hr2di_periodic_tail *tail);

/* How often a visible interval of a patch counts: 1, or more where it stands for others; and
   what checks of its series leave of that, NULL for nothing. */
double hr2di_periodic_tail_weight(const hr2d_scene *scene, size_t patch);
const double *hr2di_periodic_tail_checks(const hr2d_scene *scene, size_t patch);

#endif
