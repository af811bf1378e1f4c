/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program hr2d-mpi: all ranks run it, and rank 0 reads, writes and speaks. */
#ifndef HR2D_PETSC_PROGRAM_H
#define HR2D_PETSC_PROGRAM_H

#include <hr2d-petsc.h>

#include "cli/options.h"
#include "output/progress.h"
#include "run/run.h"

typedef struct job {
  const options *options;
  int rank, ranks;
  hr2d_scene *scene;
  size_t cuts; /* of --split-crossings */
  hr2dp *p;
  Vec b, h;
  hr2dp_report report; /* of the last stage, but counters over all stages */
  double resumed;      /* ε of the state that the run started from; 0: none */
  double start, refine_seconds, solve_seconds;
} job;

/* scene.c: rank 0 reads the scene, the others get it.  Returns 0 or the exit status, the same
   on all ranks. */
int job_load_scene(job *j);

/* run.c: refines and solves.  Returns 0 or the exit status. */
int job_run(job *j);

/* whole.c: whether the links of a stage or round follow from the brightness of the former
 * one's. */
int job_follows_brightness(const options *o);

/* Whether the options or the scene ask for what needs all elements on every rank; and solves
   and reports so.  Returns 0 or the exit status, the same on all ranks. */
int job_is_whole(const options *o, const hr2d_scene *scene);
int job_solve_whole(job *j);

/* stages.c: state_load() and state_save() of shares, see run_shares. */
int stages_load(run *r);
int stages_save(run *r);

/* state-file.c, collective: opens the file to read; *viewer is NULL if there is none. */
PetscErrorCode state_file_open(const char *path, int rank, PetscViewer *viewer);

/* Opens a file beside it, to write; what the old one has is in it if the new stage adds to
   that. Closes it and puts it in the place of the old one. */
PetscErrorCode state_file_write(const char *path, int rank, int adds, PetscViewer *viewer);
PetscErrorCode state_file_finish(const char *path, int rank, PetscViewer *viewer);

/* Whether something follows what was read. */
PetscErrorCode state_file_has_more(PetscViewer viewer, int rank, int *more);

/* report.c: the table and --json, by rank 0.  Returns 0 or the exit status, the same on all
   ranks. */
int job_report(job *j);

/* Gives all ranks the status of rank 0. */
int job_agree(int status);

/* A call of the library failed: rank 0 says why.  Returns the exit status. */
int job_complain(const job *j, PetscErrorCode code);

#endif
