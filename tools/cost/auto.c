/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hr2d_solve_to() for falling targets.  The time of `auto` includes the account of the error,
   that of `auto-solve` does not. */
#include <math.h>

#include "cost/cost.h"
#include "cost/pace.h"
#include "output/clock.h"

enum { DECADES = 13 };

static double average(const void *ctx, size_t patch, size_t band) {
  return hr2d_solution_average(ctx, patch, band);
}

static double spent(const cost_method *m, const hr2d_account *a) {
  if (m->id == METHOD_AUTO) return a->seconds;
  return a->refine_seconds + a->coefficients_seconds + a->solve_seconds;
}

static hr2d_status solve_to(cost *c, const cost_method *m, double error, cost_row *row) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  hr2d_account a;
  target.error = error;
  target.threads = options_threads(c->options);
  target.progress = progress_show;
  target.progress_ctx = &c->line;
  const hr2d_status status = hr2d_solve_to(c->scene, &target, &solution, &a);
  if (status && status != HR2D_EACCURACY) return status;
  *row = (cost_row){m,       error,   a.order,      a.elements,
                    a.links, a.bytes, spent(m, &a), cost_error(c, average, solution)};
  hr2d_solution_destroy(solution);
  return HR2D_OK;
}

static hr2d_status time_row(cost *c, const cost_method *m, double target, cost_row *row) {
  double best = INFINITY;
  for (int run = 0, runs = 1; run < runs; run++) {
    const double start = clock_seconds();
    const hr2d_status status = solve_to(c, m, target, row);
    if (cost_keeps(c, status, run)) break;
    if (status) return status;
    if (!run) runs = pace_repeats(clock_seconds() - start);
    best = fmin(best, row->seconds);
  }
  row->seconds = best;
  return HR2D_OK;
}

hr2d_status cost_auto(cost *c, const cost_method *m) {
  pace p = pace_start(c->share);
  for (int digits = 1; digits <= DECADES && pace_allows(&p); digits++) {
    cost_row row;
    const double start = clock_seconds();
    hr2d_status status = time_row(c, m, pow(10, -digits), &row);
    if (!status) status = cost_add(c, &row);
    if (status) return status;
    pace_note(&p, row.seconds, clock_seconds() - start);
  }
  return HR2D_OK;
}
