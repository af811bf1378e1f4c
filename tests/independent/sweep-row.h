/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For sweep-nystrom.c: H at a point as a sum over the nodes of panels. */
#ifndef HR2D_TESTS_INDEPENDENT_SWEEP_ROW_H
#define HR2D_TESTS_INDEPENDENT_SWEEP_ROW_H

#include "independent/sweep-nystrom.h"

enum { MOST_POINTS = 16 };

/* Gauss and Legendre. */
typedef struct rule {
  size_t count;
  double at[MOST_POINTS], weight[MOST_POINTS]; /* in −1 … 1 */
  double scale[MOST_POINTS];                   /* barycentric */
} rule;

typedef struct panel {
  size_t patch, node; /* its first node */
  real from, to;
} panel;

typedef struct node {
  size_t patch;
  spot place, normal;
  double weight; /* length */
} node;

typedef struct mesh {
  panel *panel;
  node *node;
  double *radiosity; /* nodes × bands */
  size_t panels, nodes, capacity;
  size_t *first; /* panel of each patch, and one more */
} mesh;

/* What H is made of. */
typedef struct sweep_field {
  const swept_scene *scene;
  rule rule, near; /* of panels, and of directions */
  mesh mesh;
  sweep_span *span; /* work space */
} sweep_field;

rule sweep_rule(size_t points);

/* The values at z of the polynomials that are 1 at one node and 0 at the others. */
void sweep_interpolate(const rule *r, double z, double *value);

/* Whether a patch reflects in any band, and so has panels. */
int sweep_reflects(const swept_scene *scene, size_t patch);

/* The weights of B at all nodes in H at a place, and what arrives from elsewhere. */
void sweep_row(const sweep_field *s, size_t patch, real t, double *row, double *rest);

#endif
