/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The progress line on the terminal, for work that takes longer than a second, and the
   interrupt key. */
#ifndef HR2D_TOOLS_OUTPUT_PROGRESS_H
#define HR2D_TOOLS_OUTPUT_PROGRESS_H

#include <hr2d/hr2d.h>

typedef struct progress {
  int wanted;           /* stderr is a terminal, and --quiet is not given */
  double start, last;   /* clock_seconds() at the beginning and at the last line */
  int width;            /* of the line that stands on the terminal */
  unsigned step, steps; /* of a sequence; steps ≤ 1 is not shown */
  double coefficients;  /* clock_seconds() when the library last reported this phase */
  double deadline;      /* clock_seconds() when progress_show() ends the call; 0: never */
  int late;             /* it did, and no interrupt */
} progress;

/* From now on the first interrupt makes progress_show() return HR2D_STOPPED.  A second one ends
   the program at once, without leaving a half-written file. */
void progress_start(progress *p, int quiet);

/* From now on, while results are written, the first interrupt ends the program at once. */
void progress_end(void);

/* A progress callback of the library; ctx is a progress. */
hr2d_status progress_show(void *ctx, const hr2d_progress *now);

/* Whether a new line is due.  If so, its time is kept as that of the last line. */
int progress_due(progress *p);

/* Puts a line in the place of the last one. */
void progress_line(progress *p, const char *line);

/* Wipes the line, so that other output can follow. */
void progress_clear(progress *p);

#endif
