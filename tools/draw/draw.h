/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of a solved scene. */
#ifndef HR2D_TOOLS_DRAW_DRAW_H
#define HR2D_TOOLS_DRAW_DRAW_H

#include "run/run.h"

/* Whether this program can draw: it may be built without cairo.  Returns 0, or EXIT_FAILED
   after an error message. */
int draw_check(const char *path);

/* Draws the scene coloured by B, and if they are given the links of --links-of and the beams of
   --beams-of.  Returns 0 or the exit status. */
int draw_run(const run *r, const char *path);

#endif
