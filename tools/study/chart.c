/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The script for the chart of a study. */
#include <math.h>
#include <stdio.h>

#include "cli/scene.h"
#include "output/gnuplot.h"
#include "study/study.h"

enum { LAW_POINTS = 200 };

static void write_title(FILE *script, const options *o) {
  char title[512];
  snprintf(title, sizeof title, "%s: oracle %s, variant %s", scene_file_name(o),
           o->oracle->name, o->policy->name);
  gnuplot_title(script, title);
}

/* An axis counts thousands or millions, so that its numbers are short. */
typedef struct axis {
  const char *quantity, *unit;
  double divisor;
} axis;

static axis choose_axis(const char *quantity, double max, int logarithmic) {
  if (logarithmic || max < 1e5) return (axis){quantity, "", 1};
  if (max < 1e6) return (axis){quantity, " (thousands)", 1e3};
  if (max < 1e9) return (axis){quantity, " (millions)", 1e6};
  return (axis){quantity, " (billions)", 1e9};
}

/* A number in gnuplot's enhanced text. */
static const char *enhanced(double x, char *text, size_t size) {
  const double magnitude = fabs(x);
  const int exponent = magnitude > 0 ? (int)floor(log10(magnitude)) : 0;
  if (exponent >= -3 && exponent < 4)
    snprintf(text, size, "%.4g", magnitude);
  else
    snprintf(text, size, "%.3f·10^{%d}", magnitude * pow(10, -exponent), exponent);
  return text;
}

static void write_curve(FILE *script, const char *key) {
  fputs("plot f(x) with lines linewidth 2 linecolor rgb '#21918c' title ", script);
  gnuplot_quote(script, key);
  fputs(", ", script);
}

static void write_quadratic(FILE *script, const hr2d_study_fit *fit, const axis *n,
                            const axis *l) {
  char key[192], a[32], b[32], c[32];
  snprintf(key, sizeof key, "L = %s%s %s %s N %s %s N^2,  R^2 = %.6f", fit->a < 0 ? "−" : "",
           enhanced(fit->a, a, sizeof a), fit->b < 0 ? "−" : "+", enhanced(fit->b, b, sizeof b),
           fit->c < 0 ? "−" : "+", enhanced(fit->c, c, sizeof c), fit->r2);
  fprintf(script, "f(x) = (%.17g + x*%g*(%.17g + x*%g*(%.17g)))/%g\n", fit->a, n->divisor,
          fit->b, n->divisor, fit->c, l->divisor);
  write_curve(script, key);
}

/* The least-squares line through (log N, log L) goes through their means. */
static void write_power(FILE *script, const study *s) {
  char key[64];
  double x = 0, y = 0;
  for (size_t k = 0; k < s->count; k++) {
    x += log((double)s->rows[k].counts.elements) / (double)s->count;
    y += log((double)s->rows[k].counts.links) / (double)s->count;
  }
  const double slope = s->fit.slope;
  fprintf(script, "f(x) = exp(%.17g + %.17g*log(x))\n", y - slope * x, slope);
  snprintf(key, sizeof key, "L ∝ N^{%.3f}", slope);
  write_curve(script, key);
}

static void write_axes(FILE *script, const axis *n, const axis *l, double max,
                       int logarithmic) {
  fprintf(script, "set xlabel '%s N%s'\nset ylabel '%s L%s'\n", n->quantity, n->unit,
          l->quantity, l->unit);
  if (logarithmic)
    fputs("set logscale xy\nset format '10^{%T}'\nset mxtics 10\nset mytics 10\n"
          "set offsets graph 0.03, graph 0.03, graph 0.03, graph 0.03\n"
          "set autoscale fix\n",
          script);
  else
    fprintf(script, "set xrange [0:%.17g]\nset yrange [0:*]\nset format '%%.7g'\n",
            1.04 * max / n->divisor);
  fputs("set key top left reverse Left spacing 1.3\n"
        "set border 3 linecolor rgb '#404040'\nset tics nomirror\n"
        "set grid linecolor rgb '#c8c8c8'\nset samples 500\n",
        script);
}

/* N and L of the law between the largest and the smallest ε, as a table. */
static void write_law(FILE *script, const study *s) {
  const double from = s->rows[0].epsilon, to = s->rows[s->count - 1].epsilon;
  fputs("$law << END\n", script);
  for (int k = 0; k <= LAW_POINTS; k++) {
    const double epsilon = from * pow(to / from, (double)k / LAW_POINTS);
    const double n = study_law_at(s->law.elements, epsilon);
    const double l = study_law_at(s->law.links, epsilon);
    if (n > 0 && l > 0) fprintf(script, "%.17g %.17g\n", n, l);
  }
  fputs("END\n", script);
}

static void write_script(FILE *script, const void *ctx) {
  const study *s = ctx;
  const options *o = s->options;
  double max_n = 0, max_l = 0;
  fputs("set encoding utf8\n$rows << END\n", script);
  for (size_t k = 0; k < s->count; k++) {
    const hr2d_refine_counts *c = &s->rows[k].counts;
    max_n = fmax(max_n, (double)c->elements);
    max_l = fmax(max_l, (double)c->links);
    fprintf(script, "%.17g %.17g\n", (double)c->elements, (double)c->links);
  }
  const axis n = choose_axis("elements", max_n, o->plot_log);
  const axis l = choose_axis("links", max_l, o->plot_log);
  fputs("END\n", script);
  if (s->lawful) write_law(script, s);
  gnuplot_terminal(script, o->plot, 800, 560);
  write_title(script, o);
  write_axes(script, &n, &l, max_n, o->plot_log);
  if (!s->fitted)
    fputs("plot ", script);
  else if (o->plot_log)
    write_power(script, s);
  else
    write_quadratic(script, &s->fit, &n, &l);
  fprintf(script,
          "$rows using ($1/%g):($2/%g) with points pointtype 7 pointsize %g"
          " linecolor rgb '#440154' title '%zu values of ε'",
          n.divisor, l.divisor, s->count > 60 ? 0.6 : 1.1, s->count);
  if (s->lawful)
    fprintf(script,
            ", $law using ($1/%g):($2/%g) with lines linewidth 2 dashtype 2"
            " linecolor rgb '#d95f02' title 'law of the means of N and L'",
            n.divisor, l.divisor);
  putc('\n', script);
}

int study_draw(const study *s) {
  return gnuplot_draw(s->options->plot, write_script, s);
}
