/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How small an oracle wants elements to be around two points that see each other, as ε → 0.

   A pair of small elements of lengths A and B at x and y has an error that is homogeneous in A
   and B.  ProjectKernel halves A and B until it is at most ε.  `original` halves the longer
   one, so that A/B takes two values in turn, ρ and ρ/2, with 1 ≤ ρ ≤ 2; `modified` halves both
   and keeps ρ, the ratio of the patches.  Let k(ρ) = (error of A = ρ, B = 1)^(1/n) where the
   error is of degree n in lengths.  A is halved while the pair of ratio ρ is refused, B while
   the other one is, so that

       A = u ε^(1/n)/a,  a = k(ρ)/ρ,       B = v ε^(1/n)/b,  b = k(ρ/2), or k(ρ) for `modified`,

   where u and v in (½, 1] depend on the phase of ε.  a and b are the demands at x and at y. */
#ifndef HR2D_SRC_REFINE_LAW_DEMAND_H
#define HR2D_SRC_REFINE_LAW_DEMAND_H

#include <hr2d/linkset.h>
#include <hr2d/scene.h>

/* An oracle and a variant that have a law. */
typedef struct hr2di_law_rule {
  int l1;       /* otherwise max(A, B)/r */
  int modified; /* otherwise original */
  double power; /* 1/n, of ε in the demand of points that see each other */
  /* The same where something bounds the view: oracles raise their estimate. */
  double edge_power;
} hr2di_law_rule;

/* Returns 0, or -1: there is no law of them. */
int hr2di_law_rule_find(const hr2d_oracle *oracle, const hr2d_policy *policy,
                        hr2di_law_rule *rule);

/* Two patches, in coordinates of the scene's unit. */
typedef struct hr2di_law_pair {
  hr2d_segment p, q;
  hr2d_point along_p, along_q; /* unit vectors */
  double length_p, length_q;
  double ratio; /* ρ */
} hr2di_law_pair;

/* The patch of x, that of y. */
hr2di_law_pair hr2di_law_pair_of(const hr2di_law_rule *rule, const hr2d_scene *scene, size_t p,
                                 size_t q);

typedef struct hr2di_law_demand {
  double x, y; /* a and b above */
} hr2di_law_demand;

/* Where x and y see each other.  Per distance 1/r for an oracle that knows nothing but r. */
hr2di_law_demand hr2di_law_demand_clear(const hr2di_law_rule *rule, const hr2di_law_pair *pair,
                                        hr2d_point x, hr2d_point y);

/* Where an edge of a shadow bounds the view at x and y. */
hr2di_law_demand hr2di_law_demand_edge(const hr2di_law_rule *rule, const hr2di_law_pair *pair,
                                       hr2d_point x, hr2d_point y);

/* Links per dx dy and ε^(−2·power), averaged over the phases: E 1/(A B). */
double hr2di_law_links(const hr2di_law_rule *rule, const hr2di_law_pair *pair,
                       hr2di_law_demand demand);

/* What equal lengths add to the links of `original` with max(A, B)/r, by |dr/dx|/r² dx dy and
   ε^(−power), where x is on the first patch; otherwise 0.  Of a refused pair with A = B only A
   is halved.  One of its two halves may be so much farther away that it is accepted, and is one
   link for two.  That is so where r changes across the threshold over a distance of A/4: the
   measure of these pairs is ∫ |dr/dx| A/4 over the line r = A/ε, and each level A has one. */
double hr2di_law_halves_links(const hr2di_law_rule *rule, const hr2di_law_pair *pair);

/* What the edge of a shadow adds to the links per dx along the patch of x: `edge` times
   ε^(−edge_power) and `clear` times ε^(−power).  The edge crosses the grid of pairs on its way
   through the rectangle of x and y.  Pairs on it are halved until they satisfy the demand
   there. Of the halves of such a pair those that see nothing are dropped, those that see all
   are linked. Counted over all levels that is a geometric series; less what the integral of V
   has of it. */
typedef struct hr2di_law_edge {
  double edge, clear;
} hr2di_law_edge;

hr2di_law_edge hr2di_law_edge_links(const hr2di_law_rule *rule, const hr2di_law_pair *pair,
                                    hr2di_law_demand edge, hr2di_law_demand clear);

/* The same for the line of a patch, across which nothing is seen: pairs on it are linked as
   they are, and are half visible in the mean. */
double hr2di_law_horizon_links(hr2di_law_demand clear);

#endif
