/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines through gas: the depth of the chords of a trapezoid, and moments over the lines of one
   direction.

   In a direction e the chord through a vertex z is
     |e| (u × (z − a) / (u × e) + v × (z − c) / (e × v)),
   two terms that are not negative: nothing cancels, and there are no poles but those that
   places have.  Between two vertices it is linear in the offset. */
#ifndef HR2D_SRC_BLOCKS_GAS_LINES_H
#define HR2D_SRC_BLOCKS_GAS_LINES_H

#include "blocks/block.h"

/* The lines of one direction, from the vertex low at σ = −1 to high at σ = 1. */
typedef struct hr2di_gas_lines {
  double weight;             /* half their measure */
  double centre[2], half[2]; /* they meet i at centre + σ half and j at centre − σ half */
  double depth[2];           /* κ times the chords through low and high */
} hr2di_gas_lines;

/* κ times the chord through a vertex, 0 or 1, along e = f e[0] + g e[1], of length |e|. */
double hr2di_gas_depth(const hr2di_integrator *work, const hr2di_trapezoid *t, size_t vertex,
                       double f, double g, double length);

/* How many points more than without gas a rule over the directions of a trapezoid takes;
   HUGE_VAL if it should be divided. */
double hr2di_gas_points(const hr2di_integrator *work, const hr2di_trapezoid *t);

/* Points beyond the order that a rule over offsets takes on which depths go from one to
   another. */
size_t hr2di_gas_points_beyond(const hr2di_integrator *work, double least, double most);

/* Adds what arrives to a block, and what is absorbed to work->lost. */
void hr2di_gas_add(hr2di_integrator *work, const hr2di_gas_lines *lines, double *block);

#endif
