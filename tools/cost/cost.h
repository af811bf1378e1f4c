/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d cost`: what accuracy costs by several methods. */
#ifndef HR2D_TOOLS_COST_COST_H
#define HR2D_TOOLS_COST_COST_H

#include <hr2d/hr2d.h>
#include <stddef.h>

#include "cli/options.h"
#include "output/progress.h"

/* As --methods has them, in the order in which they run. */
#define COST_METHOD_NAMES                                                                      \
  "size, size2, bf, l1, l1-grid, multigrid, order-2, order-4, order-8, order-16, auto, "       \
  "auto-solve, dense"

enum { COST_PREDICTIONS = 4 };

struct cost;

typedef struct cost_method {
  const char *name;
  const char *parameter; /* what falls from row to row */
  const hr2d_oracle *(*oracle)(void);
  unsigned order;
  double first, ratio; /* of ε; a first one of 0 is the length of the longest patch */
  /* Adds rows until they take too long. */
  hr2d_status (*run)(struct cost *c, const struct cost_method *m);
} cost_method;

typedef struct cost_row {
  const cost_method *method;
  double parameter;
  unsigned order;
  uint64_t elements, links, bytes;
  double seconds;
  double error; /* relative, the largest over patches and bands; of average B */
} cost_row;

typedef struct cost {
  const options *options;
  const hr2d_scene *scene;
  size_t cuts;
  int quiet;              /* no table */
  double *average;        /* patches × bands: what all are compared with */
  hr2d_account reference; /* how that was made */
  hr2d_prediction prediction[COST_PREDICTIONS];
  int predictions; /* how many of them there are */
  cost_row *rows;  /* method after method */
  size_t count, capacity;
  double share;      /* seconds that each method may take */
  char message[256]; /* why the last method ended early; "" if it did not */
  progress line;
  int incomplete;
} cost;

/* The target errors of `prediction`. */
double cost_prediction_target(int k);

/* cost-methods.c: the method whose name is the first `size` bytes of text, or NULL; and the
   k-th, or NULL behind the last. */
const cost_method *cost_method_find(const char *text, size_t size);
const cost_method *cost_method_at(size_t k);

/* Errors below this are those of the reference. */
double cost_floor(const cost *c);

/* The largest relative distance of averages from the reference; get(ctx, patch, band). */
double cost_error(const cost *c, double (*get)(const void *ctx, size_t patch, size_t band),
                  const void *ctx);

/* Appends a row; HR2D_OK or HR2D_ENOMEM. */
hr2d_status cost_add(cost *c, const cost_row *row);

/* How a method spends its share. */
typedef struct pace {
  double spent, last, growth;
} pace;

/* Before any run. */
pace pace_start(void);

/* After a run; repeats are only in `spent`. */
void pace_note(pace *p, double once, double spent);

/* Whether the next run is likely to fit. */
int pace_allows(const cost *c, const pace *p);

/* How often a run that took so long is repeated: the best of several is told. */
int pace_repeats(double seconds);

/* cost-refine.c, cost-auto.c, cost-dense.c: cost_method::run. */
hr2d_status cost_single(cost *c, const cost_method *m);
hr2d_status cost_progressive(cost *c, const cost_method *m);
hr2d_status cost_auto(cost *c, const cost_method *m);
hr2d_status cost_dense(cost *c, const cost_method *m);

/* cost-fit.c: what a method's rows have upwards in a chart. */
double cost_quantity(const cost_row *row, against quantity);

typedef struct cost_fit {
  double slope;   /* of its logarithm on log 1/error */
  double digit;   /* how much of it each digit takes */
  int is_digital; /* it grows like the digits, exponentially better than any slope */
} cost_fit;

/* The least-squares line through the finer half of a method's rows.  Returns 0, or -1 where
   they are too few. */
int cost_fit_rows(const cost *c, const cost_method *m, against quantity, cost_fit *fit);

/* cost-table.c */
void cost_print_head(const cost *c);
void cost_print_predictions(const cost *c);
void cost_print_rows(const cost *c, size_t first);
void cost_print_fits(const cost *c);

/* cost-files.c: return 0 or the exit status. */
int cost_write_csv(const cost *c);
int cost_write_json(const cost *c);

/* cost-chart.c: errors, falling, against what they take. */
int cost_draw(const cost *c);

#endif
