/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line as one struct. */
#ifndef HR2D_TOOLS_OPTIONS_H
#define HR2D_TOOLS_OPTIONS_H

#include <hr2d/hr2d.h>
#include <stddef.h>
#include <stdint.h>

/* One bit each, so that an option can name the commands it belongs to. */
enum { INFO = 1, SOLVE = 2, STUDY = 4, FACTORS = 8, PAIR = 16 };

/* PATCH:T, a point at fraction t of the patch with this index or name. */
typedef struct place {
  const char *patch; /* NULL: not given */
  double t;
} place;

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
  double from, to;                        /* of a study; 0: not given */
  unsigned steps, max_level, threads;
  uint64_t max_links, max_elements;
  place *at; /* at_count of them, in the order given */
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

/* Whether an output goes to standard output. */
int to_stdout(const char *path);

#endif
