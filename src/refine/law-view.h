/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The integrands of the law of N and L at a point of a patch, from its exact view. */
#ifndef HR2D_SRC_REFINE_LAW_VIEW_H
#define HR2D_SRC_REFINE_LAW_VIEW_H

#include "refine/law-demand.h"
#include "refine/law-quadrature.h"
#include "visibility/point-view.h"

/* What is integrated over all patches, in coordinates of the scene's unit. */
enum {
  HR2DI_LAW_LINKS,         /* ε^(−2·power) */
  HR2DI_LAW_EDGE_LINKS,    /* ε^(−edge_power) */
  HR2DI_LAW_CLEAR_LINKS,   /* ε^(−power) */
  HR2DI_LAW_EDGE_ELEMENTS, /* ε^(−edge_power) */
  HR2DI_LAW_ELEMENTS       /* ε^(−power) */
};

typedef struct hr2di_law_view {
  const hr2di_law_rule *rule;
  const hr2d_scene *scene;
  hr2di_point_viewer *viewer;
  hr2di_watch *watch;
  size_t patch;
} hr2di_law_view;

/* Integrals along what a point sees, which `l1` needs, are good to this. */
#define HR2DI_LAW_TOLERANCE_L1 1e-6

/* A hr2di_law_fn on [0, 1]; ctx is a hr2di_law_view, u a coordinate along its patch. */
hr2d_status hr2di_law_view_at(void *ctx, double u, double *value);

#endif
