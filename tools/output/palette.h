/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours for numbers in [0,1]. */
#ifndef HR2D_TOOLS_OUTPUT_PALETTE_H
#define HR2D_TOOLS_OUTPUT_PALETTE_H

typedef struct colour {
  double r, g, b;
} colour;

/* The perceptually uniform scale viridis, dark to light. */
colour viridis(double t);

/* Orange to dark red, which viridis lacks; for lines on white. */
colour ember(double t);

#endif
