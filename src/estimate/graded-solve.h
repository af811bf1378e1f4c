/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A graded solve: elements as large as radiosity is smooth, links as large as the kernel is
   smooth. */
#ifndef HR2D_SRC_ESTIMATE_GRADED_SOLVE_H
#define HR2D_SRC_ESTIMATE_GRADED_SOLVE_H

#include <hr2d/accuracy.h>

#include "base/message.h"
#include "estimate/resolution.h"
#include "links/row-pieces.h"
#include "mesh/event-selection.h"
#include "mesh/mesh-grading.h"

typedef struct hr2di_graded {
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  const hr2d_solution *start; /* of the elements that were divided; NULL: none */
  hr2d_solution *solution;    /* NULL until solved */
  hr2di_survey survey;
  double *
      unresolved_jump; /* see hr2di_events_select(); NULL: no event is left inside an element */
  size_t jump_bands;   /* of these */
  unsigned char *depth; /* per element: how often a leaf is to be halved so that the aim is
                           reached; NULL: unknown */
  int unbounded;        /* the error is too large, and has got no bound */
  double clustered; /* the part of the error of averages that links of clusters make, if that
                       is too large; 0: unknown */
  hr2di_row_pieces pieces; /* of rows of links, of shares */
  uint64_t events;
  uint64_t kernels;
  double refine_seconds, coefficients_seconds, solve_seconds;
} hr2di_graded;

/* Makes trees and links.  Returns HR2D_OK, or a status with a reason in `message`.  Call
   hr2di_graded_clear() in either case. */
hr2d_status hr2di_graded_refine(hr2di_graded *answer, const hr2d_scene *scene,
                                const hr2di_resolution *fineness, const hr2d_target *target,
                                hr2di_message *message);

/* The same, with the elements of `coarse` divided as its `depth` says; takes blocks of its
   links away from it. */
hr2d_status hr2di_graded_divide(hr2di_graded *answer, const hr2di_graded *coarse,
                                const hr2di_resolution *fineness, const hr2d_target *target,
                                hr2di_message *message);

/* Solves on them, with blocks for an account of the error unless the target wants none; returns
   likewise. */
hr2d_status hr2di_graded_solve(hr2di_graded *answer, const hr2di_resolution *fineness,
                               const hr2d_target *target, hr2di_message *message);

void hr2di_graded_clear(hr2di_graded *answer);

/* Bytes that the block of a link takes at most: that of the finer operator, if the error is to
   be measured, and what the account copies of it for the part of its equation. */
uint64_t hr2di_graded_block_bytes(const hr2di_resolution *fineness, int no_error);

/* Bytes of the elements, links and blocks. */
uint64_t hr2di_graded_bytes(const hr2di_graded *answer);

/* Bytes of B and H of its solution. */
uint64_t hr2di_graded_solution_bytes(const hr2di_graded *answer);

#endif
