/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The script for the chart of costs: a curve for each method, with its name and slope at the
   end. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/scene.h"
#include "cost/cost.h"
#include "output/complain.h"
#include "output/gnuplot.h"

enum { MOST_CURVES = 16, MOST_ROWS = 1024, WIDTH = 900, HEIGHT = 640 };

/* Parts of the width: kept for names at most, of a character; of the height: of a line; and the
   gap between a curve and its name. */
#define LABELS    0.27
#define CHARACTER 0.0095
#define LINE      0.034
#define GAP       0.012

typedef struct curve {
  const cost_method *method;
  hr2d_point end;   /* in [0,1], from the lower left */
  hr2d_point label; /* the left end of its name, likewise */
  char text[64];
} curve;

typedef struct chart {
  const cost *cost;
  against quantity;
  const cost_row *rows[MOST_ROWS]; /* those that are drawn, method after method */
  size_t row_count;
  double worst, best, min, max; /* decades of error and of the quantity */
  double last;                  /* decade of error where the place kept for names begins */
  curve curves[MOST_CURVES];
  size_t count;
} chart;

/* The paper's oracles, orders from light to dark, the automatic methods, the baseline. */
static const char *const colours[METHOD_COUNT] = {
    [METHOD_SIZE] = "#d95f02",       [METHOD_SIZE2] = "#f0a850",
    [METHOD_BF] = "#a6761d",         [METHOD_L1] = "#e7298a",
    [METHOD_L1_GRID] = "#f4a6cf",    [METHOD_BOUNDS] = "#54278f",
    [METHOD_MULTIGRID] = "#8c2d04",  [METHOD_ORDER_2] = "#a6cee3",
    [METHOD_ORDER_4] = "#6baed6",    [METHOD_ORDER_8] = "#3182bd",
    [METHOD_ORDER_16] = "#08519c",   [METHOD_AUTO] = "#006d2c",
    [METHOD_AUTO_SOLVE] = "#66c2a4", [METHOD_FACTORS] = "#737373"};

/* An error below that of the reference is drawn as that of the reference. */
static double decade_of_error(const chart *d, const cost_row *row) {
  return log10(fmax(row->error, cost_floor(d->cost)));
}

static double decade_of_cost(const chart *d, const cost_row *row) {
  return log10(cost_quantity(row, d->quantity));
}

/* A target is sometimes reached by more digits, or later, than a stricter one. */
static int is_beaten(const chart *d, const cost_row *row) {
  const cost *c = d->cost;
  for (size_t k = 0; k < c->count; k++) {
    const cost_row *other = &c->rows[k];
    const double error = decade_of_error(d, other) - decade_of_error(d, row);
    const double price = decade_of_cost(d, other) - decade_of_cost(d, row);
    if (other->method == row->method && error <= 0 && price <= 0 &&
        (error < 0 || price < 0 || other < row))
      return 1;
  }
  return 0;
}

/* Keeps the rows of its method in the order of falling errors. */
static void insert_row(chart *d, const cost_row *row) {
  size_t k = d->row_count++;
  for (; k && d->rows[k - 1]->method == row->method &&
         decade_of_error(d, d->rows[k - 1]) < decade_of_error(d, row);
       k--)
    d->rows[k] = d->rows[k - 1];
  d->rows[k] = row;
}

/* All rows, but of an automatic method the best for each error: its curve never goes back. */
static void choose_rows(chart *d) {
  for (size_t k = 0; k < d->cost->count && d->row_count < MOST_ROWS; k++) {
    const cost_row *row = &d->cost->rows[k];
    const method m = row->method->id;
    if (m != METHOD_AUTO && m != METHOD_AUTO_SOLVE)
      d->rows[d->row_count++] = row;
    else if (!is_beaten(d, row))
      insert_row(d, row);
  }
}

static void measure(chart *d) {
  d->worst = d->max = -INFINITY;
  d->best = d->min = INFINITY;
  for (size_t k = 0; k < d->row_count; k++) {
    const cost_row *row = d->rows[k];
    d->worst = fmax(d->worst, decade_of_error(d, row));
    d->best = fmin(d->best, decade_of_error(d, row));
    d->max = fmax(d->max, decade_of_cost(d, row));
    d->min = fmin(d->min, decade_of_cost(d, row));
  }
  d->worst = fmin(1, d->worst) + 0.2;
  d->last = d->best -= 0.2;
  d->max += 0.5;
  d->min -= 0.3;
}

static void describe(const chart *d, curve *v) {
  cost_fit fit;
  const int size = (int)sizeof v->text;
  if (cost_fit_rows(d->cost, v->method, d->quantity, &fit))
    snprintf(v->text, size, "%s", cost_method_name(v->method));
  else if (!fit.is_digital)
    snprintf(v->text, size, "%s  %.2f", cost_method_name(v->method), fit.slope);
  else if (d->quantity == AGAINST_SECONDS)
    snprintf(v->text, size, "%s  %.2g ms/digit", cost_method_name(v->method), 1e3 * fit.digit);
  else
    snprintf(v->text, size, "%s  %.3g/digit", cost_method_name(v->method), fit.digit);
}

static hr2d_point on_chart(const chart *d, const cost_row *row) {
  return (hr2d_point){(d->worst - decade_of_error(d, row)) / (d->worst - d->best),
                      (decade_of_cost(d, row) - d->min) / (d->max - d->min)};
}

static void find_curves(chart *d) {
  for (size_t k = 0; k < d->row_count; k++) {
    const cost_row *row = d->rows[k];
    const int begins = !k || row->method != d->rows[k - 1]->method;
    if (begins && d->count == MOST_CURVES) return;
    curve *v = &d->curves[begins ? d->count++ : d->count - 1];
    if (begins) v->method = row->method;
    v->end = on_chart(d, row);
  }
  for (size_t k = 0; k < d->count; k++) describe(d, &d->curves[k]);
}

static double width_of(const curve *v) {
  return CHARACTER * (double)strlen(v->text);
}

/* Keeps as much of the right side as the names take at the ends of their curves: an end at x
   moves to (1 − kept) x. */
static void keep_place(chart *d) {
  double kept = 0;
  for (size_t k = 0; k < d->count; k++) {
    const curve *v = &d->curves[k];
    if (v->end.x > 0) kept = fmax(kept, 1 - (1 - 2 * GAP - width_of(v)) / v->end.x);
  }
  kept = fmin(LABELS, kept);
  d->best = d->worst - (d->worst - d->best) / (1 - kept);
  for (size_t k = 0; k < d->count; k++) d->curves[k].end.x *= 1 - kept;
}

/* Whether the line from a to b passes through the name at `label`. */
static int crosses(const curve *v, hr2d_point label, hr2d_point a, hr2d_point b) {
  for (int k = 0; k <= 40; k++) {
    const double x = a.x + k * (b.x - a.x) / 40, y = a.y + k * (b.y - a.y) / 40;
    if (x > label.x && x < label.x + width_of(v) && fabs(y - label.y) < 0.5 * LINE) return 1;
  }
  return 0;
}

static int is_clear_of_curves(const chart *d, const curve *v, hr2d_point label) {
  const cost_row *const *rows = d->rows;
  for (size_t k = 1; k < d->row_count; k++)
    if (rows[k]->method == rows[k - 1]->method &&
        crosses(v, label, on_chart(d, rows[k - 1]), on_chart(d, rows[k])))
      return 0;
  return 1;
}

/* Whether name k at `label` is inside the chart and free of the names before it. */
static int is_clear_of_names(const chart *d, size_t k, hr2d_point label) {
  const double right = label.x + width_of(&d->curves[k]);
  for (size_t j = 0; j < k; j++) {
    const curve *w = &d->curves[j];
    if (fabs(label.y - w->label.y) < LINE && label.x < w->label.x + width_of(w) &&
        w->label.x < right)
      return 0;
  }
  return label.x > 0 && right < 1 && label.y > 0.5 * LINE && label.y < 1 - 0.5 * LINE;
}

/* The nearest place beside the end of a curve, right or left, that is free of the names before
   it, and if possible also of all curves. */
static void place_label(chart *d, size_t k) {
  curve *v = &d->curves[k];
  v->label = (hr2d_point){v->end.x + GAP, v->end.y};
  for (int clear = 1; clear >= 0; clear--)
    for (int step = 0; step < 120; step++) {
      const double off = 0.25 * LINE * (step / 4);
      const hr2d_point at = {step % 2 ? v->end.x - GAP - width_of(v) : v->end.x + GAP,
                             step / 2 % 2 ? v->end.y - off : v->end.y + off};
      if (!is_clear_of_names(d, k, at) || (clear && !is_clear_of_curves(d, v, at))) continue;
      v->label = at;
      return;
    }
}

/* At every decade, or at every second one if there are many. */
static void write_tics(FILE *script, const chart *d) {
  const int step = d->worst - d->last > 7 ? 2 : 1;
  const char *separator = "set xtics (";
  for (int e = step * (int)floor(d->worst / step); e >= d->last; e -= step) {
    fprintf(script, "%s'10^{%d}' 1e%d", separator, e, e);
    separator = ", ";
  }
  fputs(")\nset format y '10^{%T}'\nset mytics 10\nset tics nomirror\n", script);
}

static void write_axes(FILE *script, const chart *d) {
  static const char *const name[] = {"seconds", "links L", "bytes"};
  fprintf(script,
          "set logscale xy\nset xrange [%.17g:%.17g]\nset yrange [%.17g:%.17g]\n"
          "set xlabel \"relative error of average B\\n{/*0.8 a number s beside a curve: %s ∝ "
          "error^{−s}}\"\nset ylabel '%s'\n",
          pow(10, d->worst), pow(10, d->best), pow(10, d->min), pow(10, d->max),
          name_of_against[d->quantity], name[d->quantity]);
  write_tics(script, d);
  fputs("set border 3 linecolor rgb '#404040'\nset grid linecolor rgb '#dcdcdc'\nunset key\n",
        script);
}

static void write_title(FILE *script, const chart *d) {
  char title[512];
  snprintf(title, sizeof title, "%s: %s against error", scene_file_name(d->cost->options),
           name_of_against[d->quantity]);
  gnuplot_title(script, title);
}

static void write_labels(FILE *script, const chart *d) {
  for (size_t k = 0; k < d->count; k++) {
    const curve *v = &d->curves[k];
    fputs("set label ", script);
    gnuplot_quote(script, v->text);
    fprintf(script,
            " at graph %.4f, graph %.4f left noenhanced textcolor rgb '%s' font ',12'\n",
            v->label.x, v->label.y, colours[v->method->id]);
  }
}

/* The data blocks of a panel.  gnuplot needs all of them before the first plot. */
static void write_data(FILE *script, const chart *d, size_t panel) {
  size_t k = 0;
  for (size_t j = 0; j < d->count; j++) {
    fprintf(script, "$curve%zu_%zu << END\n", panel, j);
    for (; k < d->row_count && d->rows[k]->method == d->curves[j].method; k++)
      fprintf(script, "%.17g %.17g\n", pow(10, decade_of_error(d, d->rows[k])),
              cost_quantity(d->rows[k], d->quantity));
    fputs("END\n", script);
  }
}

static void write_curves(FILE *script, const chart *d, size_t panel) {
  for (size_t j = 0; j < d->count; j++) {
    const method m = d->curves[j].method->id;
    fprintf(script,
            "%s$curve%zu_%zu using 1:2 with linespoints pointtype %d pointsize 0.6 "
            "linewidth %g linecolor rgb '%s'",
            j ? ", " : "plot ", panel, j, m == METHOD_FACTORS ? 5 : 7,
            m == METHOD_AUTO || m == METHOD_AUTO_SOLVE ? 2.2 : 1.2, colours[m]);
  }
  fputs("\n", script);
}

static void make_panel(chart *d, const cost *c, against quantity) {
  *d = (chart){.cost = c, .quantity = quantity};
  choose_rows(d);
  measure(d);
  find_curves(d);
  keep_place(d);
  for (size_t k = 0; k < d->count; k++) place_label(d, k);
}

static void write_script(FILE *script, const void *ctx) {
  const cost *c = ctx;
  const options *o = c->options;
  chart d[AGAINST_COUNT];
  fputs("set encoding utf8\n", script);
  gnuplot_terminal(script, o->plot, WIDTH, HEIGHT * (int)o->against.count);
  for (size_t k = 0; k < o->against.count; k++) {
    make_panel(&d[k], c, o->against.items[k]);
    write_data(script, &d[k], k);
  }
  fprintf(script, "set multiplot layout %zu,1\n", o->against.count);
  for (size_t k = 0; k < o->against.count; k++) {
    fputs("unset label\n", script);
    write_title(script, &d[k]);
    write_axes(script, &d[k]);
    write_labels(script, &d[k]);
    write_curves(script, &d[k], k);
  }
}

int cost_draw(const cost *c) {
  return c->count ? gnuplot_draw(c->options->plot, write_script, c)
                  : complain(c->options->plot, "there is nothing to plot");
}
