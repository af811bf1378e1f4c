/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hr2d-mpi solve SCENE, under mpirun or a scheduler. */
#include <gsl/gsl_errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "draw/draw.h"
#include "output/clock.h"
#include "output/complain.h"
#include "output/output.h"
#include "program.h"

static const char help[] =
    "Usage: mpirun -n RANKS hr2d-mpi solve SCENE [options]\n"
    "Refines, solves and reports radiosity and irradiance of every patch, as hr2d solve\n"
    "does, with the links shared out over ranks.  No digit depends on their number.\n"
    "\n"
    "Method:\n"
    "  --target-error E, --time-budget S, --norm NAME, --importance PATCH, --floor F\n"
    "                    the best elements for an error, with its account\n"
    "  --enclose GAP     averages from below and above, GAP apart at most, by rank 0 alone\n"
    "  --enclosure       one radiosity for each patch, as enclosure codes have\n"
    "  --order P         coefficients of each element (1), with --eps\n"
    "  --oracle NAME     size (default), size2, bf, l1, l1-grid or bounds\n"
    "  --eps E           accept links whose estimated error is <= E (0.1)\n"
    "  --variant NAME    original (default) or modified: what a refusal splits\n"
    "  --multigrid FROM:R  refine for FROM, FROM*R, ... --eps, each from the last\n"
    "  --max-level K     elements on level K are not subdivided (24)\n"
    "  --no-closure      leave rows of the kernel as coarse links make them\n"
    "  --state FILE      keep B in FILE after each stage, or go on from there\n"
    "\n"
    "Work and scene:\n"
    "  --max-links M     give up beyond M links of one rank\n"
    "  --max-elements M  give up beyond M elements on one rank\n"
    "  --threads T       threads of each rank while it refines (1)\n"
    "  --split-crossings, --snap TOL, --strict, --force EFFECT  as of hr2d solve\n"
    "\n"
    "Output:\n"
    "  --json FILE|-     the result as JSON; - is standard output\n"
    "  --csv FILE|-, --csv-comment, --vtk FILE, --at PATCH:T, --draw FILE, --error,\n"
    "  --no-error        as of hr2d solve\n"
    "  --box X0,Y0,X1,Y1, --no-fill, --contours N, --arrows, --log, --links-of PATCH:T,\n"
    "  --link-level K, --link-parents, --beams-of PATCH:T\n"
    "                    what the picture shows, as of hr2d solve\n"
    "  --tiles FILE      links as tiles of patch x patch, as .svg, .png or .pdf\n"
    "  --watch FILE      a film (.png) of links, tiles and light as E falls\n"
    "  --quiet           no table, no progress\n"
    "  --help, --version\n";

int job_agree(int status) {
  MPI_Bcast(&status, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  return status;
}

int job_complain(const job *j, PetscErrorCode code) {
  const char *general = NULL;
  char *specific = NULL;
  const hr2d_status status = j->p ? hr2dp_status(j->p) : HR2D_OK;
  if (j->rank > 0) return status == HR2D_STOPPED ? EXIT_INTERRUPTED : EXIT_FAILED;
  if (status) return complain_call(j->options->scene, hr2dp_message(j->p), status);
  PetscErrorMessage(code, &general, &specific);
  return complain(j->options->scene, "%s", specific && *specific ? specific : general);
}

static int check_options(const options *o) {
  if (o->command != SOLVE) return complain_usage("the only command is solve");
  const int status = draw_check(o->draw ? o->draw : o->tiles ? o->tiles : o->watch);
  return status ? status : options_check_outputs(o);
}

/* Rank 0 reads the command line first, and is the only one to find something wrong. */
static int read_options(job *j, int argc, char **argv, options *o) {
  int status = 0;
  if (j->rank == 0) {
    status = options_read(argc, argv, o);
    if (!status && !o->help && !o->version) status = check_options(o);
  }
  status = job_agree(status);
  if (!status && j->rank > 0) status = options_read(argc, argv, o);
  if (!status && o->threads == 0) o->threads = 1;
  return status;
}

static int solve(job *j) {
  int status = job_load_scene(j);
  if (!status && job_is_whole(j->options, j->scene)) {
    status = job_solve_whole(j);
  } else if (!status) {
    status = job_run(j);
    if (!status) status = job_report(j);
  }
  VecDestroy(&j->b);
  VecDestroy(&j->h);
  hr2dp_destroy(&j->p);
  hr2d_scene_destroy(j->scene);
  return status;
}

static int run_job(job *j, int argc, char **argv) {
  options o = {0};
  int status = read_options(j, argc, argv, &o);
  j->options = &o;
  if (!status && o.help) {
    if (j->rank == 0) fputs(help, stdout);
  } else if (!status && o.version) {
    if (j->rank == 0) printf("hr2d-mpi %s\n", hr2d_version());
  } else if (!status) {
    status = solve(j);
  }
  options_release(&o);
  return status;
}

int main(int argc, char **argv) {
  job j = {.start = clock_seconds(), .report = HR2DP_REPORT_INIT};
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  gsl_set_error_handler_off();
  if (PetscInitializeNoArguments()) return EXIT_FAILED;
  MPI_Comm_rank(PETSC_COMM_WORLD, &j.rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &j.ranks);
  if (j.rank > 0) complain_silently();
  PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  int status = run_job(&j, argc, argv);
  status = output_finish(status);
  PetscPopErrorHandler();
  if (PetscFinalize() && !status) status = EXIT_FAILED;
  return status;
}
