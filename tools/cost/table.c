/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of `hr2d cost`, method after method. */
#include <stdio.h>

#include "cli/scene.h"
#include "cost/cost.h"

/* A time with its unit and two digits. */
static const char *say(double seconds, char *text, size_t size) {
  if (seconds < 1e-3)
    snprintf(text, size, "%.2g ms", 1e3 * seconds);
  else if (seconds < 1)
    snprintf(text, size, "%.0f ms", 1e3 * seconds);
  else
    snprintf(text, size, "%.2g s", seconds);
  return text;
}

static void print_prediction_table(const cost *c) {
  printf("\n%7s %6s %10s %12s %13s %10s  %s\n", "target", "order", "N", "L", "bytes", "seconds",
         "range");
  for (int k = 0; k < c->predictions; k++) {
    const hr2d_prediction *p = &c->prediction[k];
    printf("%7.0e %6u %10llu %12llu %13llu %10.4f  %.2g to %.2g\n", cost_prediction_target(k),
           p->order, (unsigned long long)p->elements, (unsigned long long)p->links,
           (unsigned long long)p->bytes, p->seconds, p->least_seconds, p->most_seconds);
  }
}

static void print_predictions(const cost *c) {
  char text[32];
  printf("predicted  ");
  for (int k = 0; k < c->predictions; k++)
    printf("%s%.0e: about %s", k ? ", " : "", cost_prediction_target(k),
           say(c->prediction[k].seconds, text, sizeof text));
  puts("");
}

void cost_print_head(const cost *c) {
  const hr2d_account *a = &c->reference;
  scene_print(c->options, 11, c->cuts);
  if (!c->options->exponents) print_predictions(c);
  if (c->options->predict) {
    print_prediction_table(c);
    return;
  }
  printf("reference  error at most %.1e: p = %u, N = %llu, L = %llu, %.3f seconds\n",
         a->average.bound, a->order, (unsigned long long)a->elements,
         (unsigned long long)a->links, a->seconds);
  if (c->options->exponents)
    printf("\n%-8s %-10s %5s %-8s %6s %17s  %s\n", "oracle", "variant", "order", "closure",
           "most L", "links", "interval of 95 %");
  else
    printf("\n%-10s %10s %10s %12s %13s %11s %10s\n", "method", "parameter", "N", "L", "bytes",
           "seconds", "error");
  fflush(stdout);
}

/* An error below that of the reference is printed as "less than" that. */
static void print_row(const cost *c, const cost_row *row) {
  const int below = row->error < cost_floor(c);
  printf("%-10s %10.3g %10llu %12llu %13llu %11.6f %s%9.1e\n", cost_method_name(row->method),
         row->parameter, (unsigned long long)row->elements, (unsigned long long)row->links,
         (unsigned long long)row->bytes, row->seconds, below ? "<" : " ",
         below ? cost_floor(c) : row->error);
}

void cost_print_rows(const cost *c, size_t first) {
  for (size_t k = first; k < c->count; k++) print_row(c, &c->rows[k]);
  if (*c->message && c->count == first) printf("%-10s %s\n", "", "no rows");
  fflush(stdout);
}

/* With the slope s the next digit costs 10^s times as much as the last one. */
static void print_fit(const cost *c, const cost_method *m) {
  cost_fit time, links;
  char text[32];
  if (cost_fit_rows(c, m, AGAINST_SECONDS, &time) || cost_fit_rows(c, m, AGAINST_LINKS, &links))
    return;
  if (time.is_digital)
    printf("%-10s %s and %.3g links for each digit\n", cost_method_name(m),
           say(time.digit, text, sizeof text), links.digit);
  else
    printf("%-10s seconds ~ error^-%.2f ± %.2f, links ~ error^-%.2f ± %.2f\n",
           cost_method_name(m), time.slope, time.range, links.slope, links.range);
}

/* What a variant of the algorithm has in the place of rows. */
void cost_print_exponent(const cost *c, const cost_method *m) {
  cost_fit links;
  printf("%-8s %-10s %5u %-8s", cost_method_name(m), cost_method_variant(m), m->order,
         cost_method_closure(c, m));
  if (cost_fit_rows(c, m, AGAINST_LINKS, &links))
    puts("  less than a decade of errors");
  else
    printf(" %6llu  ~ error^-%.3f  %.3f to %.3f\n",
           (unsigned long long)c->rows[c->count - 1].links, links.slope,
           links.slope - links.range, links.slope + links.range);
  fflush(stdout);
}

void cost_print_fits(const cost *c) {
  puts("");
  for (size_t k = 0; k < c->method_count; k++) print_fit(c, &c->methods[k]);
}
