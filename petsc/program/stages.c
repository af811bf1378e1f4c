/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stages of solutions that are whole on every rank.  The file has the last of them; where the
   links of one follow from the brightness of the former, it has all, to make them again. */
#include "output/complain.h"
#include "program.h"

/* Loads the next stage of the file. */
static PetscErrorCode load_stage(run *r, PetscViewer viewer) {
  PetscFunctionBegin;
  hr2d_refine_options refine = run_refine_options(r->options);
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *next;
  refine.threads = solve.threads = options_threads(r->options);
  refine.brightness = r->solution;
  refine.share = r->share;
  if (r->options->no_closure) solve.closure = HR2D_CLOSURE_OFF;
  PetscCall(hr2dp_load_solution(r->own_links, &refine, &solve, viewer, &next));
  hr2d_solution_destroy(r->solution);
  r->solution = next;
  PetscFunctionReturn(0);
}

static PetscErrorCode load_all(run *r, PetscViewer viewer, int *more) {
  PetscFunctionBegin;
  const int rank = (int)r->share->number;
  *more = 1;
  PetscCall(load_stage(r, viewer));
  PetscCall(state_file_has_more(viewer, rank, more));
  while (*more && job_follows_brightness(r->options)) {
    PetscCall(load_stage(r, viewer));
    PetscCall(state_file_has_more(viewer, rank, more));
  }
  PetscFunctionReturn(0);
}

/* Of PETSc or of this library: its sentence, said by rank 0. */
static int complain_code(const run *r, PetscErrorCode code) {
  const char *general = NULL;
  char *specific = NULL;
  PetscErrorMessage(code, &general, &specific);
  return complain(r->options->state, "%s", specific && *specific ? specific : general);
}

int stages_load(run *r) {
  const options *o = r->options;
  PetscViewer viewer;
  int more = 0;
  PetscErrorCode failed = state_file_open(o->state, (int)r->share->number, &viewer);
  if (!failed && !viewer) return 0;
  if (!failed) failed = load_all(r, viewer, &more);
  (void)PetscViewerDestroy(&viewer);
  if (failed) return complain_code(r, failed);
  if (more) return complain(o->state, "something follows the state");
  const double epsilon = hr2d_linkset_epsilon(r->own_links);
  if (epsilon < o->epsilon)
    return complain(o->state, "is the state of epsilon %g, which is finer than --eps %g",
                    epsilon, o->epsilon);
  r->resumed = r->kept = epsilon;
  return 0;
}

static PetscErrorCode save(run *r) {
  PetscFunctionBegin;
  const char *path = r->options->state;
  const int rank = (int)r->share->number;
  PetscViewer viewer;
  PetscCall(
      state_file_write(path, rank, r->kept > 0 && job_follows_brightness(r->options), &viewer));
  const PetscErrorCode failed = hr2dp_save_solution(r->solution, viewer);
  if (failed) PetscCall(PetscViewerDestroy(&viewer));
  PetscCall(failed);
  PetscCall(state_file_finish(path, rank, &viewer));
  PetscFunctionReturn(0);
}

int stages_save(run *r) {
  const PetscErrorCode failed = save(r);
  if (failed) return complain_code(r, failed);
  r->kept = hr2d_linkset_epsilon(r->own_links);
  return 0;
}
