/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study under way: the ε to count for, the counts, the fit. */
#ifndef HR2D_TOOLS_STUDY_STUDY_H
#define HR2D_TOOLS_STUDY_STUDY_H

#include <hr2d/hr2d.h>
#include <stddef.h>

#include "cli/options.h"
#include "output/progress.h"

typedef struct study {
  const options *options;
  size_t cuts;          /* of --split-crossings */
  hr2d_study_row *rows; /* ε falls; N is 0 in rows that are not counted yet */
  size_t count;
  size_t known; /* rows that --resume found */
  hr2d_study_fit fit;
  int fitted;
  hr2d_study_constants law; /* of --law */
  int lawful;               /* it is there */
  int quiet;                /* no table */
  int complete;             /* nothing ended the sweep early */
} study;

/* plan.c: the rows of the CSV with --resume, and those that are still to be counted.  Returns
   0, or the exit status after an error message; in both cases the rows have to be freed. */
int study_plan(study *s, const hr2d_scene *scene);

/* Keeps the rows that are counted. */
void study_drop_uncounted(study *s);

/* csv.c: the rows that are counted, written as a whole.  Returns 0 or EXIT_FAILED. */
int study_write_csv(const study *s);

/* Reads the rows of such a CSV into memory that the caller frees; a file that does not exist
   has no rows.  Returns 0 or EXIT_FAILED. */
int study_read_csv(const char *path, hr2d_study_row **rows, size_t *count);

/* Whether the CSV can be replaced again and again; a pipe or a device cannot. */
int study_can_rewrite_csv(const study *s);

/* json.c; returns 0 or EXIT_FAILED. */
int study_write_json(const study *s);

/* chart.c: dots of L against N, with the fitted curve if there is one.  On logarithmic axes the
   curve is the power law of the fitted slope.  Returns 0 or EXIT_FAILED. */
int study_draw(const study *s);

/* sweep.c: the progress line of a sweep, and the interrupt key. */
typedef struct sweep {
  progress line;
  int wanted;
  double epsilon;
  size_t step, steps;
} sweep;

void sweep_start(sweep *w, const study *s);

/* Before the count of row `step`; returns HR2D_STOPPED after an interrupt. */
hr2d_status sweep_next(sweep *w, const study *s, size_t step);

/* A progress callback of the library; ctx is a sweep. */
hr2d_status sweep_show(void *ctx, const hr2d_progress *now);

/* law.c: finds the law if --law asks for it.  Returns 0, or the exit status after an error
   message; then there is nothing to report. */
int study_find_law(study *s, hr2d_linkset *links, sweep *w);
void study_print_law(const study *s);

/* N or L by its terms. */
enum { STUDY_TERMS = 3 };
double study_law_at(const hr2d_study_term term[STUDY_TERMS], double epsilon);

#endif
