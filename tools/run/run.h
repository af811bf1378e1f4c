/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A whole run of `hr2d solve`, from links to radiosity, with what it took. */
#ifndef HR2D_TOOLS_RUN_RUN_H
#define HR2D_TOOLS_RUN_RUN_H

#include <hr2d/hr2d.h>
#include <stdint.h>

#include "cli/options.h"
#include "output/progress.h"

typedef struct run {
  const options *options;
  const hr2d_scene *scene;
  size_t cuts;          /* of --split-crossings */
  double start;         /* seconds() when the command began */
  const size_t *places; /* the patches of --at, then those of --links-of and --importance */
  const hr2d_hierarchy *hierarchy;
  const hr2d_linkset *links;
  hr2d_solution *solution;
  hr2d_hierarchy *own_hierarchy; /* NULL where the solution owns what it stands on */
  hr2d_linkset *own_links;
  hr2d_solve_work work; /* over all stages of multigridding */
  hr2d_account
      account;    /* of what it has: order, L, errors, which are NaN if not known, seconds */
  double resumed; /* epsilon of the state gone on from; 0: none */
  double kept;    /* epsilon of the state in the file of --state; 0: none */
  int inaccurate; /* there is a solution, but not what was asked for */
} run;

/* Refines and solves a run that has its options, scene, places and start.  Returns 0 or the
   exit status after complaining; either way the run is to be released.  With `inaccurate` the
   solution is there to be reported all the same. */
int run_solve(run *r);

void run_release(run *r);

/* run-target.c: solves to the target error, or as well as the budget allows, as run_solve(). */
int run_target(run *r, progress *p);

/* The error of a solution that had no target, if it is wanted. */
int run_error(run *r, progress *p);

/* The limits of refinement that the options ask for. */
hr2d_refine_options refine_options(const options *o);

/* B averaged over an element and over the bands. */
double run_mean(const run *r, uint32_t element);

/* B at a point of a patch, averaged over the bands. */
double run_mean_at(const run *r, size_t patch, double t);

/* B and H at the point of --at number k, in all bands.  Returns 0 or the exit status. */
int run_place(const run *r, size_t k, double *radiosity, double *irradiance);

/* The leaves, one row each: patch,name,t0,t1,ax,ay,bx,by,B0,…,H0,…, and at an order p above 1
   B0c1,…,B0c(p-1),B1c1,…: B = Σ c_l P_l(2s − 1) at fraction s of the leaf, c_0 = B0. */
int write_leaves(const run *r, const char *path);

/* What the power balance of a band misses, relative to the power that comes in. */
double power_error(const hr2d_power *p);

/* The summary on standard output. */
int print_run(const run *r, double total_seconds);

/* The result as JSON. */
int write_run(const run *r, double total_seconds, const char *path);

/* Peak memory of the process. */
uint64_t peak_bytes(void);

#endif
