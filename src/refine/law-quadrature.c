/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The functions are expensive together and cheap alone: the rule is applied to each of them,
   but they are evaluated once at each node, which GSL visits in the same order every time. */
#include "refine/law-quadrature.h"

#include <gsl/gsl_integration.h>
#include <math.h>

enum {
  NODES = 15,
  DEPTH = 48 /* of bisection: a jump is then between neighbouring doubles */
};

/* A function whose integral is less than this part of the largest one is that small by
   roundings, or does not matter. */
#define NEGLIGIBLE 1e-4

typedef struct nodes {
  const hr2di_law_integral *integral;
  hr2d_status status;
  size_t part, next;
  double value[NODES][HR2DI_LAW_PARTS];
} nodes;

typedef struct interval {
  double low, high;
  double value[HR2DI_LAW_PARTS], error[HR2DI_LAW_PARTS];
} interval;

static double at_node(double t, void *params) {
  nodes *n = params;
  double *value = n->value[n->next++];
  if (n->part == 0 && !n->status) n->status = n->integral->at(n->integral->ctx, t, value);
  return n->status ? 0 : value[n->part];
}

static interval measure(nodes *n, double low, double high) {
  interval s = {.low = low, .high = high};
  gsl_function function = {at_node, n};
  for (n->part = 0; n->part < n->integral->parts; n->part++) {
    double absolute, deviation;
    n->next = 0;
    gsl_integration_qk15(&function, low, high, &s.value[n->part], &s.error[n->part], &absolute,
                         &deviation);
  }
  return s;
}

static int enough(const hr2di_law_integral *integral, const interval *s, const double *scale) {
  for (size_t k = 0; k < integral->parts; k++)
    if (s->error[k] > integral->tolerance * scale[k]) return 0;
  return 1;
}

/* The integrals of all functions by the first intervals. */
static void set_scale(const hr2di_law_integral *integral, const interval *first,
                      double *scale) {
  double largest = 0;
  for (size_t k = 0; k < integral->parts; k++) {
    scale[k] = 0;
    for (size_t j = 0; j < integral->pieces; j++) scale[k] += fabs(first[j].value[k]);
    largest = fmax(largest, scale[k]);
  }
  for (size_t k = 0; k < integral->parts; k++) scale[k] = fmax(scale[k], NEGLIGIBLE * largest);
}

/* Bisects until each interval is good to the tolerance. */
static void refine(nodes *n, interval whole, const double *scale, size_t *left, double *sum,
                   double *error) {
  interval stack[DEPTH + 1];
  size_t count = 1;
  stack[0] = whole;
  while (count > 0 && !n->status) {
    const interval s = stack[--count];
    const double middle = s.low + 0.5 * (s.high - s.low);
    const int last = count == DEPTH - 1 || *left == 0 || !(s.low < middle && middle < s.high);
    if (last || enough(n->integral, &s, scale)) {
      for (size_t k = 0; k < n->integral->parts; k++) {
        sum[k] += s.value[k];
        error[k] += s.error[k];
      }
      continue;
    }
    --*left;
    stack[count++] = measure(n, middle, s.high);
    stack[count++] = measure(n, s.low, middle);
  }
}

hr2d_status hr2di_law_integrate(const hr2di_law_integral *integral, double low, double high,
                                double *sum, double *error) {
  nodes n = {.integral = integral};
  interval first[HR2DI_LAW_PIECES];
  double scale[HR2DI_LAW_PARTS];
  size_t left = integral->most;
  const double step = (high - low) / (double)integral->pieces;
  for (size_t j = 0; j < integral->pieces; j++)
    first[j] = measure(&n, low + (double)j * step, low + (double)(j + 1) * step);
  set_scale(integral, first, scale);
  for (size_t j = 0; j < integral->pieces && !n.status; j++)
    refine(&n, first[j], scale, &left, sum, error);
  return n.status;
}
