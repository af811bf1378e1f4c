/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line as one struct.  Its members are set by the options in option-table.c. */
#ifndef HR2D_TOOLS_CLI_OPTIONS_H
#define HR2D_TOOLS_CLI_OPTIONS_H

#include <hr2d/hr2d.h>
#include <limits.h>
#include <stddef.h>
#include <stdint.h>

/* One bit each, so that an option can name the commands that it belongs to. */
enum {
  INFO = 1,
  SOLVE = 2,
  STUDY = 4,
  FACTORS = 8,
  PAIR = 16,
  COST = 32,
  FIELD = 64,
  SCHEMA = 128
};

/* PATCH:T, a point at fraction t of the patch with this index or name.  PATCH alone has no t.
 */
typedef struct place {
  const char *patch; /* NULL: not given */
  double t;
} place;

typedef struct place_list {
  place *items; /* in the order given */
  size_t count;
} place_list;

/* WxH, nodes of a grid. */
typedef struct grid_size {
  unsigned columns, rows; /* 0: not given */
} grid_size;

/* X0,Y0,X1,Y1. */
typedef struct grid_box {
  double side[4];
  int given;
} grid_box;

/* X,Y. */
typedef struct vector {
  double x, y; /* both 0: not given */
} vector;

/* FROM:RATIO, a geometric sequence that falls. */
typedef struct sequence {
  double from, ratio; /* 0: not given */
} sequence;

/* The quantity on the vertical axis of a chart of errors. */
typedef enum against { AGAINST_SECONDS, AGAINST_LINKS, AGAINST_BYTES, AGAINST_COUNT } against;

/* One panel of the chart for each. */
typedef struct against_list {
  against items[AGAINST_COUNT];
  size_t count;
} against_list;

/* The methods that `cost` compares, in the order in which they run. */
typedef enum method {
  METHOD_SIZE,
  METHOD_SIZE2,
  METHOD_BF,
  METHOD_L1,
  METHOD_L1_GRID,
  METHOD_BOUNDS,
  METHOD_MULTIGRID,
  METHOD_ORDER_2,
  METHOD_ORDER_4,
  METHOD_ORDER_8,
  METHOD_ORDER_16,
  METHOD_AUTO,
  METHOD_AUTO_SOLVE,
  METHOD_FACTORS,
  METHOD_COUNT
} method;

/* What a picture shows of the light between the patches. */
typedef enum light {
  QUANTITY_MEAN,
  QUANTITY_FLUX,
  QUANTITY_SKY,
  QUANTITY_TEMPERATURE,
  QUANTITY_COUNT
} light;

/* The bands that a picture shows; a number from 0 on is one band. */
enum { BAND_DEFAULT = -3, BAND_RGB = -2, BAND_ALL = -1 };

/* As link_level: --link-level is not given. */
#define NO_LEVEL UINT_MAX

/* The file of a SCENE that is -. */
#define OPTIONS_STDIN "/dev/stdin"

typedef struct options {
  int command;
  int help, version, quiet;
  int no_closure;
  const char *scene;  /* file name; NULL for `pair` and `schema` */
  const char *schema; /* a name; NULL: list them */
  int split_crossings, strict;
  double snap;    /* a tolerance; 0: not given */
  unsigned force; /* bit 1 << e for each effect e */
  const hr2d_oracle *oracle;
  const hr2d_policy *policy;
  double epsilon;
  sequence multigrid;
  unsigned order;
  double target_error, time_budget; /* 0: not given */
  hr2d_norm norm;
  place_list importance; /* without t */
  double floor;          /* 0: not given */
  double enclose;        /* a gap; 0: not given */
  int enclosure;         /* one radiosity for each patch */
  int error, no_error;   /* measure the error of any scene, of none */
  double most_seconds;   /* of `cost` */
  unsigned methods;      /* of `cost`, bit 1 << m for each method m */
  against_list against;
  int predict, exponents;
  double from, to; /* of a study; 0: not given */
  unsigned steps, max_level;
  unsigned threads;                 /* 0: all processors */
  uint64_t max_links, max_elements; /* 0: no limit */
  const char *state;                /* file name; NULL: not given */
  place_list at;
  grid_size grid; /* of `field` */
  grid_box box;
  const char *points; /* file name, or - for standard input */
  vector normal;      /* of planes at the points */
  double tolerance;   /* of a grid; 0: every node is exact */
  light quantity;     /* of a picture */
  int band;           /* a number, or one of BAND_... */
  unsigned contours;  /* 0: none */
  double exposure;    /* 0: chosen */
  int no_fill, arrows, log_scale, linear_scale;
  place links_of;
  unsigned link_level;
  place_list beams_of;
  int link_parents, plot_log, resume, law, csv_comment, group;
  const char *json, *csv, *mtx, *elmer, *moose, *vtk, *pfm, *draw, *tiles, *plot, *watch,
      *factors; /* file names; NULL: not given */
} options;

/* Reads the command line.  Returns 0, or the exit status after an error message.  The strings
   of argv are split in place and must outlive the options. */
int options_read(int argc, char **argv, options *o);

void options_release(options *o);

/* Checks before the work starts that the outputs can be written.  Returns 0 or EXIT_FAILED. */
int options_check_outputs(const options *o);

/* Whether a command prints its table on standard output. */
int options_want_table(const options *o);

/* The options of the program are numbers; in those of the library 0 is the default. */
static inline unsigned options_threads(const options *o) {
  return o->threads ? o->threads : HR2D_ALL_THREADS;
}

static inline unsigned options_max_level(const options *o) {
  return o->max_level ? o->max_level : HR2D_NO_SUBDIVISION;
}

/* Whether a target or a budget decides how to solve. */
static inline int options_targeted(const options *o) {
  return o->target_error > 0 || o->time_budget > 0;
}

/* Whether what is printed or written has values that are gathered at points. */
static inline int options_want_points(const options *o) {
  return o->command == FIELD || o->norm == HR2D_NORM_SUP || o->at.count > 0 || o->csv;
}

#endif
