/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line on the terminal for what takes longer than a second, and the interrupt key. */
#ifndef HR2D_TOOLS_OUTPUT_PROGRESS_H
#define HR2D_TOOLS_OUTPUT_PROGRESS_H

#include <hr2d/hr2d.h>

typedef struct progress {
  int wanted;           /* stderr is a terminal and nobody asked for quiet */
  double start, last;   /* seconds() at the beginning and at the last line */
  int width;            /* of the line that stands on the terminal */
  unsigned step, steps; /* of a sequence; steps ≤ 1 is not shown */
  double coefficients;  /* seconds() when the library last told of this phase */
} progress;

/* Wall time in seconds from a fixed moment. */
double seconds(void);

/* From here on the first interrupt makes progress_show() return HR2D_STOPPED; a second
   one ends the program on the spot, without leaving a half-written file. */
void progress_start(progress *p, int quiet);

/* From here on, as results are written, the first interrupt does so. */
void progress_end(void);

/* A progress callback of the library; ctx is a progress. */
hr2d_status progress_show(void *ctx, const hr2d_progress *now);

/* Wipes the line, so that other output can follow. */
void progress_clear(progress *p);

#endif
