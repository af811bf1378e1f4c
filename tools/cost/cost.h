/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d cost`: the price of accuracy with several methods. */
#ifndef HR2D_TOOLS_COST_COST_H
#define HR2D_TOOLS_COST_COST_H

#include <hr2d/hr2d.h>
#include <stddef.h>

#include "cli/names.h"
#include "cli/options.h"
#include "output/progress.h"

enum { COST_PREDICTIONS = 4, COST_MOST_METHODS = 64 };

/* The limit of memory of one row. */
#define COST_MOST_BYTES ((uint64_t)2 << 30)

struct cost;

typedef struct cost_method {
  method id;
  const char *parameter; /* it falls from row to row */
  const hr2d_oracle *(*oracle)(void);
  unsigned order;
  double first, ratio; /* of ε; a first one of 0 is the length of the longest patch */
  /* Adds rows until they take too long. */
  hr2d_status (*run)(struct cost *c, const struct cost_method *m);
  const hr2d_policy *(*policy)(void); /* NULL: the original variant */
  int is_open;                        /* without the closure */
  uint64_t most_links; /* these end the rows, whose time does not matter; 0: time ends them */
} cost_method;

typedef struct cost_row {
  const cost_method *method;
  double parameter;
  unsigned order;
  uint64_t elements, links, bytes;
  double seconds;
  double error; /* of average B, relative, the largest over patches and bands */
} cost_row;

typedef struct cost {
  const options *options;
  const hr2d_scene *scene;
  size_t cuts;
  int quiet;              /* no table */
  double *average;        /* patches × bands: average B of the reference */
  hr2d_account reference; /* the account of the reference */
  hr2d_prediction prediction[COST_PREDICTIONS];
  int predictions;                        /* how many of them there are */
  cost_method methods[COST_MOST_METHODS]; /* those that run, in this order */
  size_t method_count;
  cost_row *rows; /* method after method */
  size_t count, capacity;
  double share;      /* seconds that each method may take */
  char message[256]; /* why the last method ended early; "" if it did not */
  progress line;     /* its deadline ends a method */
  int incomplete;
} cost;

/* Whether a row that has been timed is kept although a repeat of it was cut off. */
static inline int cost_keeps(const cost *c, hr2d_status status, int repeat) {
  return status == HR2D_STOPPED && c->line.late && repeat > 0;
}

/* reference.c: the solution that all methods are compared with, and predictions of what it
   takes to reach a target error.  Each returns 0 or the exit status. */
int cost_make_reference(cost *c);
int cost_predict(cost *c);

/* The target errors of `prediction`. */
double cost_prediction_target(int k);

/* methods.c: the methods that the options ask for. */
void cost_choose_methods(cost *c);

static inline const char *cost_method_name(const cost_method *m) {
  return name_of_method[m->id];
}

/* The variant and the closure of a method with links of an oracle, otherwise "". */
const char *cost_method_variant(const cost_method *m);
const char *cost_method_closure(const cost *c, const cost_method *m);

/* rows.c: the error of the reference; smaller errors of the methods mean nothing. */
double cost_floor(const cost *c);

/* The largest relative distance of averages from the reference; get(ctx, patch, band). */
double cost_error(const cost *c, double (*get)(const void *ctx, size_t patch, size_t band),
                  const void *ctx);

/* Appends a row; HR2D_OK or HR2D_ENOMEM. */
hr2d_status cost_add(cost *c, const cost_row *row);

/* The quantity of a row on the vertical axis of a chart. */
double cost_quantity(const cost_row *row, against quantity);

/* refine.c, auto.c, factors.c: cost_method::run. */
hr2d_status cost_single(cost *c, const cost_method *m);
hr2d_status cost_progressive(cost *c, const cost_method *m);
hr2d_status cost_auto(cost *c, const cost_method *m);
hr2d_status cost_factors(cost *c, const cost_method *m);

typedef struct cost_fit {
  double slope;   /* of the logarithm of the quantity on log 1/error */
  double range;   /* half of its interval of 95 % by Student's t */
  double digit;   /* how much of the quantity each digit takes */
  int is_digital; /* the quantity grows like the digits: exponentially better than any slope */
} cost_fit;

/* fit.c: the least-squares line through the finer half of a method's rows.  Returns 0, or -1 if
   there are too few rows. */
int cost_fit_rows(const cost *c, const cost_method *m, against quantity, cost_fit *fit);

/* table.c */
void cost_print_head(const cost *c);
void cost_print_rows(const cost *c, size_t first);
void cost_print_fits(const cost *c);
void cost_print_exponent(const cost *c, const cost_method *m);

/* files.c: both return 0 or the exit status. */
int cost_write_csv(const cost *c);
int cost_write_json(const cost *c);

/* chart.c: the chart of errors, falling, against seconds, links or bytes.  Returns 0 or the
   exit status. */
int cost_draw(const cost *c);

#endif
