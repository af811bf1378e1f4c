/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refines and solves once, or for falling ε in stages, each of which starts from the last.
   Where links follow from light, a run without stages is made of rounds at its only ε. */
#include "run/run.h"

#include <math.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "output/clock.h"
#include "output/complain.h"
#include "run/state.h"

enum { MOST_ROUNDS = 20 };

hr2d_refine_options run_refine_options(const options *o) {
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  refine.epsilon = o->epsilon;
  refine.max_level = options_max_level(o);
  refine.max_links = o->max_links;
  refine.max_elements = o->max_elements;
  return refine;
}

/* The ε of a stage, FROM·RATIO^stage; the last one is --eps itself. */
static double stage_epsilon(const options *o, unsigned stage) {
  if (!(o->multigrid.ratio > 0)) return o->epsilon;
  const double epsilon = o->multigrid.from * pow(o->multigrid.ratio, stage);
  return epsilon > o->epsilon * (1 + 1e-12) ? epsilon : o->epsilon;
}

static unsigned count_stages(const options *o) {
  unsigned stages = 1;
  while (stage_epsilon(o, stages - 1) > o->epsilon) stages++;
  return stages;
}

/* The first stage that is finer than the state in the file.  The last stage is always made
   again, because the other options may have changed. */
static unsigned first_stage(const run *r, unsigned stages) {
  unsigned stage = 0;
  while (r->resumed > 0 && stage + 1 < stages && stage_epsilon(r->options, stage) >= r->resumed)
    stage++;
  return stage;
}

static hr2d_status refine_stage(run *r, double epsilon, progress *p) {
  hr2d_refine_options refine = run_refine_options(r->options);
  refine.epsilon = epsilon;
  refine.threads = options_threads(r->options);
  refine.brightness = r->solution;
  refine.share = r->share;
  refine.progress = progress_show;
  refine.progress_ctx = p;
  const double start = clock_seconds();
  const hr2d_status status = hr2d_refine(r->own_links, &refine);
  r->account.refine_seconds += clock_seconds() - start;
  return status;
}

static void add_work(run *r, hr2d_solve_work stage) {
  hr2d_solve_work *sum = &r->work;
  sum->gathers += stage.gathers;
  sum->iterations += stage.iterations;
  sum->row_sums += stage.row_sums;
  sum->background_rows += stage.background_rows;
  sum->kernels += stage.kernels;
}

static hr2d_status solve_stage(run *r, progress *p) {
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  solve.threads = options_threads(r->options);
  if (r->options->no_closure) solve.closure = HR2D_CLOSURE_OFF;
  solve.start = r->solution;
  solve.progress = progress_show;
  solve.progress_ctx = p;
  hr2d_solution *next = NULL;
  const double start = clock_seconds();
  p->coefficients = start;
  const hr2d_status status = hr2d_solve(r->own_links, &solve, &next);
  r->account.coefficients_seconds += p->coefficients - start;
  r->account.solve_seconds += clock_seconds() - p->coefficients;
  if (status) return status;
  hr2d_solution_destroy(r->solution);
  r->solution = next;
  add_work(r, hr2d_solution_work(next));
  return HR2D_OK;
}

/* Whether the light of the last round may ask for more links: they and the elements are still
   increasing, since what was accepted in the dark is refined when light is found there. */
static int wants_round(const run *r, const hr2d_refine_counts *before) {
  const hr2d_refine_counts now = hr2d_linkset_counts(r->links);
  return r->options->oracle->flags & HR2D_ORACLE_NEEDS_BRIGHTNESS &&
         !(r->options->multigrid.ratio > 0) && r->rounds < MOST_ROUNDS &&
         (now.elements != before->elements || now.links != before->links);
}

/* Refines, solves and saves for one ε, once or in rounds. */
static int run_stage(run *r, double epsilon, progress *p) {
  hr2d_refine_counts before;
  hr2d_status status;
  int code = 0;
  r->rounds = 0;
  do {
    before = hr2d_linkset_counts(r->links);
    status = refine_stage(r, epsilon, p);
    if (!status) status = solve_stage(r, p);
    if (!status) code = state_save(r);
    r->rounds++;
  } while (!status && !code && wants_round(r, &before));
  if (status) {
    progress_clear(p);
    code = complain_call(r->options->scene, hr2d_linkset_message(r->links), status);
    state_mention(r);
  }
  return code;
}

static int run_stages(run *r, progress *p) {
  const options *o = r->options;
  hr2d_status status = hr2d_hierarchy_create(r->scene, &r->own_hierarchy);
  if (!status) status = hr2d_hierarchy_set_order(r->own_hierarchy, o->order);
  if (!status)
    status =
        hr2d_linkset_create(r->own_hierarchy, o->oracle, NULL, o->policy, NULL, &r->own_links);
  if (status) return complain_call(o->scene, "", status);
  r->hierarchy = r->own_hierarchy;
  r->links = r->own_links;
  r->account.order = o->order;
  int code = state_load(r);
  p->steps = count_stages(o);
  p->step = first_stage(r, p->steps);
  for (; !code && p->step < p->steps; p->step++)
    code = run_stage(r, stage_epsilon(o, p->step), p);
  p->steps = 0;
  r->account.links = hr2d_linkset_counts(r->links).links;
  progress_clear(p);
  return code;
}

int run_solve(run *r) {
  progress p;
  progress_start(&p, r->options->quiet);
  if (options_targeted(r->options)) return run_target(r, &p);
  const int status = run_stages(r, &p);
  return status ? status : run_error(r, &p);
}

void run_release(run *r) {
  free(r->point_links.items);
  hr2d_enclosure_destroy(r->enclosure);
  hr2d_solution_destroy(r->solution);
  hr2d_linkset_destroy(r->own_links);
  hr2d_hierarchy_destroy(r->own_hierarchy);
  *r = (run){0};
}

int run_compare_shares(run *r) {
  double max[] = {(double)hr2d_linkset_size(r->links), (double)run_peak_bytes(),
                  (double)hr2d_linkset_own_tests(r->links)};
  if (!r->share) return 0;
  if (r->share->combine(r->share->ctx, HR2D_OK, HR2D_COMBINE_MOST, max, 3))
    return complain(r->options->scene, "a share has failed");
  r->max_links = (uint64_t)max[0];
  r->max_bytes = (uint64_t)max[1];
  r->max_tests = (uint64_t)max[2];
  return 0;
}

int run_agree(const run *r, int status) {
  double max = status;
  if (!r->share) return status;
  const hr2d_status failed =
      r->share->combine(r->share->ctx, HR2D_OK, HR2D_COMBINE_MOST, &max, 1);
  return failed ? EXIT_FAILED : (int)max;
}

double run_power_error(const hr2d_power *p) {
  /* Negative fluxes may leave less of what comes in than is absorbed. */
  const double in = p->emitted + p->received, max = fmax(in, p->absorbed);
  return max > 0 ? fabs(in - p->absorbed - p->escaped) / max : 0;
}

uint64_t run_peak_bytes(void) {
  struct rusage usage;
  return getrusage(RUSAGE_SELF, &usage) ? 0 : 1024 * (uint64_t)usage.ru_maxrss;
}
