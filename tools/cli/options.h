/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line as one struct. */
#ifndef HR2D_TOOLS_CLI_OPTIONS_H
#define HR2D_TOOLS_CLI_OPTIONS_H

#include <hr2d/hr2d.h>
#include <stddef.h>
#include <stdint.h>

/* One bit each, so that an option can name the commands it belongs to. */
enum { INFO = 1, SOLVE = 2, STUDY = 4, FACTORS = 8, PAIR = 16, COST = 32 };

/* PATCH:T, a point at fraction t of the patch with this index or name. */
typedef struct place {
  const char *patch; /* NULL: not given */
  double t;
} place;

/* The quantity a chart of errors has upwards. */
typedef enum against { AGAINST_SECONDS, AGAINST_LINKS, AGAINST_BYTES, AGAINST_COUNT } against;

typedef struct options {
  int command;
  int help, version, quiet;
  int closure;       /* 0: the paper's algorithm as it stands */
  const char *scene; /* file name; NULL for `pair` */
  int split_crossings;
  unsigned force; /* bit 1 << e for each effect e */
  const hr2d_oracle *oracle;
  const hr2d_policy *policy;
  double epsilon;
  double multigrid_from, multigrid_ratio; /* 0: not given */
  unsigned order;
  double target_error, time_budget; /* 0: not given */
  hr2d_norm norm;
  place importance;    /* its t means nothing */
  int error, no_error; /* whether the error is to be measured at any price, or not at all */
  double max_seconds;  /* of `cost` */
  const char *methods; /* of `cost`, separated by commas; NULL: all */
  against against[AGAINST_COUNT]; /* upwards in each panel of a chart */
  size_t panels;
  int predict;
  double from, to; /* of a study; 0: not given */
  unsigned steps, max_level, threads;
  uint64_t max_links, max_elements;
  const char *state; /* file name; NULL: not given */
  place *at;         /* at_count of them, in the order given */
  size_t at_count;
  place links_of;
  int one_level; /* link_level was given */
  unsigned link_level;
  int link_parents, plot_log, resume;
  const char *json, *csv, *draw, *plot; /* file names; NULL: not wanted */
} options;

/* Reads the command line.  Returns 0, or the exit status after complaining.  The
   strings of argv are split in place and must outlive the options. */
int options_read(int argc, char **argv, options *o);

void options_release(options *o);

/* options-check.c: refuses what contradicts itself, as options_read(). */
int options_check(const options *o, uint64_t given);

/* The bit of `given` for an option's number. */
#define GIVEN(id) ((uint64_t)1 << ((id)-HELP))

/* Numbers of options, beyond those of characters. */
enum {
  HELP = 256,
  SHOW_VERSION,
  QUIET,
  ORACLE,
  EPS,
  VARIANT,
  MULTIGRID,
  STATE,
  ORDER,
  TARGET_ERROR,
  TIME_BUDGET,
  NORM,
  IMPORTANCE,
  MEASURE_ERROR,
  NO_ERROR,
  LEVEL,
  LINKS,
  ELEMENTS,
  THREADS,
  NO_CLOSURE,
  AT,
  JSON,
  CSV,
  DRAW,
  LINKS_OF,
  LINK_LEVEL,
  LINK_PARENTS,
  PLOT,
  PLOT_LOG,
  RESUME,
  FROM,
  TO,
  STEPS,
  METHODS,
  MAX_SECONDS,
  AGAINST,
  PREDICT,
  SPLIT_CROSSINGS,
  FORCE
};

/* Whether a target or a budget decides how to solve. */
int is_targeted(const options *o);

/* Whether an output goes to standard output. */
int to_stdout(const char *path);

#endif
