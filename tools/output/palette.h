/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours for numbers in [0,1]. */
#ifndef HR2D_TOOLS_OUTPUT_PALETTE_H
#define HR2D_TOOLS_OUTPUT_PALETTE_H

typedef struct colour {
  double r, g, b;
} colour;

/* The perceptually uniform scale viridis, dark to light. */
colour palette_viridis(double t);

/* The perceptually uniform scale inferno, black over red to pale yellow, as of what glows. */
colour palette_inferno(double t);

/* A part of linear light as a part of an sRGB channel. */
double palette_srgb(double linear);

/* Orange to dark red, for lines on white: viridis has no such colours. */
colour palette_ember(double t);

#endif
