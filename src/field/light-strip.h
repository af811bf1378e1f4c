/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light that a point gets from a part of a leaf. */
#ifndef HR2D_SRC_FIELD_LIGHT_STRIP_H
#define HR2D_SRC_FIELD_LIGHT_STRIP_H

#include "field/light-sum.h"
#include "solution/panels.h"

/* A leaf, or a back: the vector from the point to its start, its own, and B on it, or NULL if
   that is 0. */
typedef struct hr2di_strip {
  hr2d_point from, along;
  double varies;
  double nearest; /* where B is taken for constant, in [−1,1] of the leaf */
  const double *coefficient;
} hr2di_strip;

/* Adds a panel with a rule: what B is there more than at the nearest place; or all of B. */
void hr2di_strip_add_panel(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span panel,
                           const hr2di_rule *rule, int all);

/* Adds the part of a leaf between two directions.  angle: between them, or below 0 if it is not
   known. */
void hr2di_strip_add_near(hr2di_light_sum *sum, hr2di_strip *s, hr2di_span part,
                          hr2d_point right, hr2d_point left, double angle);

/* The first rule that may take a part of an element as a whole, seen from x; NULL if it is
   near, or a point that x touches. */
const hr2di_rule *hr2di_strip_far_rule(const hr2di_light_source *of, uint32_t element,
                                       const hr2di_strip *s, hr2di_span part);

#endif
