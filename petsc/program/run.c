/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refines in stages of falling ε, each from the last.  B is solved for at the end, and with
   --state after each stage, so that there is something to go on from. */
#include <math.h>
#include <stdlib.h>

#include "output/clock.h"
#include "output/complain.h"
#include "program.h"

static double stage_epsilon(const options *o, unsigned stage) {
  if (!(o->multigrid.ratio > 0)) return o->epsilon;
  const double epsilon = o->multigrid.from * pow(o->multigrid.ratio, stage);
  return epsilon > o->epsilon * (1 + 1e-12) ? epsilon : o->epsilon;
}

static hr2d_refine_options refine_options(const job *j, double epsilon, progress *p) {
  const options *o = j->options;
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  refine.epsilon = epsilon;
  refine.max_level = options_max_level(o);
  refine.max_links = o->max_links;
  refine.max_elements = o->max_elements;
  refine.threads = o->threads ? o->threads : 1;
  refine.progress = progress_show;
  refine.progress_ctx = p;
  return refine;
}

/* Goes on from the file, if there is one. */
static PetscErrorCode load_state(job *j, progress *p) {
  PetscFunctionBegin;
  const hr2d_refine_options refine = refine_options(j, j->options->epsilon, p);
  PetscViewer viewer;
  PetscCall(state_file_open(j->options->state, j->rank, &viewer));
  if (!viewer) PetscFunctionReturn(0);
  const double start = clock_seconds();
  const PetscErrorCode failed = hr2dp_load(j->p, &refine, viewer, &j->b, &j->resumed);
  j->refine_seconds += clock_seconds() - start;
  PetscCall(PetscViewerDestroy(&viewer));
  PetscCall(failed);
  PetscFunctionReturn(0);
}

static PetscErrorCode save_state(job *j) {
  PetscFunctionBegin;
  const char *path = j->options->state;
  PetscViewer viewer;
  if (!path) PetscFunctionReturn(0);
  PetscCall(state_file_write(path, j->rank, 0, &viewer));
  PetscCall(hr2dp_save(j->p, j->b, viewer));
  PetscCall(state_file_finish(path, j->rank, &viewer));
  PetscFunctionReturn(0);
}

static PetscErrorCode refine(job *j, double epsilon, progress *p) {
  PetscFunctionBegin;
  const hr2d_refine_options how = refine_options(j, epsilon, p);
  const double start = clock_seconds();
  PetscCall(hr2dp_refine(j->p, &how));
  j->refine_seconds += clock_seconds() - start;
  PetscCall(VecDestroy(&j->b));
  PetscCall(hr2dp_vector(j->p, &j->b));
  PetscFunctionReturn(0);
}

static PetscErrorCode solve(job *j, progress *p) {
  PetscFunctionBegin;
  hr2d_solve_options how = HR2D_SOLVE_OPTIONS_INIT;
  const hr2dp_report before = j->report;
  const double start = clock_seconds();
  if (j->options->no_closure) how.closure = HR2D_CLOSURE_OFF;
  how.progress = progress_show;
  how.progress_ctx = p;
  PetscCall(VecDestroy(&j->h));
  PetscCall(hr2dp_vector(j->p, &j->h));
  PetscCall(hr2dp_solve(j->p, &how, j->b, j->h, &j->report));
  j->report.sweeps += before.sweeps;
  j->report.iterations += before.iterations;
  j->report.row_sums += before.row_sums;
  j->solve_seconds += clock_seconds() - start;
  PetscCall(save_state(j));
  PetscFunctionReturn(0);
}

static PetscErrorCode run_stages(job *j, progress *p) {
  PetscFunctionBegin;
  const options *o = j->options;
  hr2dp_options how = HR2DP_OPTIONS_INIT;
  how.oracle = o->oracle;
  how.policy = o->policy;
  PetscCall(hr2dp_create(PETSC_COMM_WORLD, j->scene, &how, &j->p));
  PetscCall(load_state(j, p));
  p->steps = 1;
  while (stage_epsilon(o, p->steps - 1) > o->epsilon) p->steps++;
  for (p->step = 0; p->step < p->steps; p->step++) {
    const double epsilon = stage_epsilon(o, p->step);
    const int last = p->step + 1 == p->steps, resumed = j->resumed > 0;
    if (resumed && !last && epsilon >= j->resumed) continue;
    if (!resumed || epsilon != j->resumed) PetscCall(refine(j, epsilon, p));
    if (last || o->state) PetscCall(solve(j, p));
  }
  PetscFunctionReturn(0);
}

int job_run(job *j) {
  progress p = {0};
  const size_t bands = hr2d_scene_bands(j->scene);
  j->report.power = calloc(bands, sizeof *j->report.power);
  if (j->rank == 0) progress_start(&p, j->options->quiet);
  const PetscErrorCode failed = run_stages(j, &p);
  if (j->rank == 0) {
    progress_clear(&p);
    progress_end();
  }
  if (!failed) return 0;
  const int status = job_complain(j, failed);
  free(j->report.power);
  return job_agree(status);
}
