/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A graded solve: elements as large as radiosity is smooth, links as large as the kernel is
   smooth. */
#ifndef HR2D_SRC_ACCURACY_GRADED_SOLVE_H
#define HR2D_SRC_ACCURACY_GRADED_SOLVE_H

#include <hr2d/accuracy.h>

#include "accuracy/kinks.h"
#include "accuracy/mesh-grading.h"
#include "base/message.h"
#include "links/row-pieces.h"

/* How fine a graded solve is. */
typedef struct hr2di_resolution {
  double aim; /* the error */
  unsigned order;
  double target;           /* relative error that corners are graded for */
  double cluster_accuracy; /* relative accuracy of links between clusters of patches */
  double tolerance;        /* of the solve; 0: the least */
  double relative;         /* what the solve may leave everywhere, as a part of the light there;
                              0: the tolerance alone counts */
  double floor;            /* no light counts as less, relative to the brightest */
  hr2d_norm norm;
  unsigned corner_levels; /* levels at corners beyond what the target asks for */
  int flat;             /* elements are not graded for the target, but for these levels alone */
  double distance;      /* the ellipse at which ends in front of elements may be */
  int hidden;           /* the scene has visibility events */
  int crowded;          /* it has very many */
  unsigned generations; /* elements end at events of so many generations */
  int shares;           /* errors that are too large name the elements that make them, where
                           no events have been chosen */
  int hasty;            /* errors that do so need no bound, and none at points */
  double kinks;         /* the shares of error that events inside elements may make; 0:
                           elements end at all events */
  int single;           /* floats suffice for blocks */
  unsigned raises;      /* how often it was made finer */
  const hr2di_lights *lights; /* of patches, to tell which events matter */
  hr2di_looks *looks;         /* what patches see, for all attempts; NULL: nothing is kept */
} hr2di_resolution;

typedef struct hr2di_graded {
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  const hr2d_solution *start; /* of the elements that were divided; NULL: none */
  hr2d_solution *solution;    /* NULL until solved */
  hr2di_looks *looks;         /* keeps what patches see; NULL: nothing is kept */
  hr2di_survey survey;
  double *bent;         /* see hr2di_kinks_cut(); NULL: no event is left inside an element */
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
