/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refine and solve for falling ε: from scratch for each, or each from the last one. */
#include <math.h>
#include <stdio.h>

#include "cli/scene.h"
#include "cost/cost.h"
#include "cost/pace.h"
#include "output/clock.h"

enum { MOST_STEPS = 64, ELEMENT_BYTES = sizeof(hr2d_element) + 6 };

typedef struct trial {
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
} trial;

static void end(trial *t) {
  hr2d_solution_destroy(t->solution);
  hr2d_linkset_destroy(t->links);
  hr2d_hierarchy_destroy(t->hierarchy);
  *t = (trial){NULL, NULL, NULL};
}

static hr2d_status begin(const cost *c, const cost_method *m, trial *t) {
  *t = (trial){NULL, NULL, NULL};
  hr2d_status status = hr2d_hierarchy_create(c->scene, &t->hierarchy);
  if (!status) status = hr2d_hierarchy_set_order(t->hierarchy, m->order);
  if (!status)
    status = hr2d_linkset_create(t->hierarchy, m->oracle(), NULL,
                                 m->policy ? m->policy() : NULL, NULL, &t->links);
  return status;
}

/* Starts from the links and the solution of the trial. */
static hr2d_status solve(cost *c, const cost_method *m, trial *t, double epsilon) {
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *next = NULL;
  refine.epsilon = epsilon;
  refine.max_level = options_max_level(c->options);
  refine.max_bytes = COST_MOST_BYTES;
  refine.brightness = solve.start = t->solution;
  refine.threads = solve.threads = options_threads(c->options);
  if (c->options->no_closure || m->is_open) solve.closure = HR2D_CLOSURE_OFF;
  refine.progress = solve.progress = progress_show;
  refine.progress_ctx = solve.progress_ctx = &c->line;
  hr2d_status status = hr2d_refine(t->links, &refine);
  if (!status) status = hr2d_solve(t->links, &solve, &next);
  if (status) {
    snprintf(c->message, sizeof c->message, "%s", hr2d_linkset_message(t->links));
    return status;
  }
  hr2d_solution_destroy(t->solution);
  t->solution = next;
  return HR2D_OK;
}

static double average(const void *ctx, size_t patch, size_t band) {
  return hr2d_solution_average(ctx, patch, band);
}

static cost_row make_row(const cost *c, const cost_method *m, const trial *t, double epsilon,
                         double time) {
  const hr2d_refine_counts n = hr2d_linkset_counts(t->links);
  return (cost_row){m,        epsilon,
                    m->order, n.elements,
                    n.links,  ELEMENT_BYTES * n.elements + hr2d_linkset_bytes(t->links),
                    time,     cost_error(c, average, t->solution)};
}

static double first_epsilon(const cost *c, const cost_method *m) {
  return m->first > 0 ? m->first : scene_longest_patch(c->scene);
}

/* The limit of memory ends a method without an error, like the limit of time. */
static hr2d_status forgive(cost *c, hr2d_status status) {
  if (status != HR2D_EMAX_BYTES) return status;
  *c->message = '\0';
  return HR2D_OK;
}

static int repeats(const cost_method *m, double seconds) {
  return m->most_links ? 1 : pace_repeats(seconds);
}

/* Whether the next row would mean nothing, or has too many links. */
static int is_last(const cost *c, const cost_row *row) {
  const uint64_t most = row->method->most_links;
  return row->error < cost_floor(c) || (most && row->links > most);
}

/* The shortest of several runs, if one is too short to be timed. */
static hr2d_status time_single(cost *c, const cost_method *m, double epsilon, cost_row *row) {
  double best = INFINITY;
  for (int run = 0, runs = 1; run < runs; run++) {
    trial t;
    const double start = clock_seconds();
    hr2d_status status = begin(c, m, &t);
    if (!status) status = solve(c, m, &t, epsilon);
    const double time = clock_seconds() - start;
    if (!run) runs = repeats(m, time);
    if (!status) best = fmin(best, time);
    if (!status) *row = make_row(c, m, &t, epsilon, best);
    end(&t);
    if (cost_keeps(c, status, run)) break;
    if (status) return status;
  }
  return HR2D_OK;
}

static int repeats_last(const cost *c, const cost_row *row) {
  const cost_row *last = c->count ? &c->rows[c->count - 1] : NULL;
  return last && last->method == row->method && last->elements == row->elements &&
         last->links == row->links;
}

hr2d_status cost_single(cost *c, const cost_method *m) {
  double epsilon = first_epsilon(c, m);
  pace p = pace_start(c->share);
  for (int step = 0; step < MOST_STEPS && pace_allows(&p); step++, epsilon *= m->ratio) {
    cost_row row;
    const double start = clock_seconds();
    hr2d_status status = time_single(c, m, epsilon, &row);
    if (status) return forgive(c, status);
    pace_note(&p, row.seconds, clock_seconds() - start);
    if (!repeats_last(c, &row)) status = cost_add(c, &row);
    if (status) return status;
    if (is_last(c, &row)) break;
  }
  return HR2D_OK;
}

/* Adds a row, or keeps the shortest time of one that is there. */
static hr2d_status note_row(cost *c, size_t at, const cost_row *row) {
  if (at == c->count) return cost_add(c, row);
  c->rows[at].seconds = fmin(c->rows[at].seconds, row->seconds);
  return HR2D_OK;
}

/* One pass over falling ε; the time of a row is the sum up to it.  The first pass goes on as
   long as time allows.  The others repeat the rows that are too short to be timed once. */
static hr2d_status pass(cost *c, const cost_method *m, size_t first, pace *p) {
  const int timing = c->count > first;
  const size_t last = c->count;
  double epsilon = first_epsilon(c, m), start = clock_seconds(), total = 0;
  trial t;
  hr2d_status status = begin(c, m, &t);
  for (size_t at = first; !status && at < first + MOST_STEPS; at++, epsilon *= m->ratio) {
    if (timing ? at == last || pace_repeats(c->rows[at].seconds) == 1 : !pace_allows(p)) break;
    status = solve(c, m, &t, epsilon);
    if (status) break;
    const double once = clock_seconds() - start;
    total += once;
    const cost_row row = make_row(c, m, &t, epsilon, total);
    status = note_row(c, at, &row);
    if (!timing) pace_note(p, once, once);
    if (!timing && is_last(c, &row)) break;
    start = clock_seconds();
  }
  end(&t);
  return forgive(c, status);
}

/* Of rows with the same elements and links only the first stays. */
static void drop_repeats(cost *c, size_t first) {
  const size_t count = c->count;
  c->count = first;
  for (size_t k = first; k < count; k++)
    if (!repeats_last(c, &c->rows[k])) c->rows[c->count++] = c->rows[k];
}

hr2d_status cost_progressive(cost *c, const cost_method *m) {
  const size_t first = c->count;
  pace p = pace_start(c->share);
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < repeats(m, 0) && !status; k++) status = pass(c, m, first, &p);
  drop_repeats(c, first);
  return status;
}
