/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A whole run of `hr2d solve`, from links to radiosity, with what it took. */
#ifndef HR2D_TOOLS_RUN_H
#define HR2D_TOOLS_RUN_H

#include <hr2d/hr2d.h>
#include <stdint.h>

#include "options.h"

typedef struct run {
  const options *options;
  const hr2d_scene *scene;
  size_t cuts;          /* of --split-crossings */
  const size_t *places; /* the patches of --at, then that of --links-of */
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  hr2d_solve_work work;  /* over all stages of multigridding */
  double refine_seconds; /* includes the exchange areas */
  double solve_seconds;
} run;

/* Refines and solves a run that has its options, scene and places.  Returns 0 or the exit
   status after complaining; either way the run is to be released. */
int run_solve(run *r);

void run_release(run *r);

/* The limits of refinement that the options ask for. */
hr2d_refine_options refine_options(const options *o);

/* B averaged over an element and over the bands. */
double run_mean(const run *r, uint32_t element);

/* The leaves, one row each: patch,name,t0,t1,ax,ay,bx,by,B0,…,H0,… */
int write_leaves(const run *r, const char *path);

/* What the power balance of a band misses, relative to the power that comes in. */
double power_error(const hr2d_power *p);

/* The summary on standard output. */
void print_run(const run *r, double total_seconds);

/* The result as JSON. */
int write_run(const run *r, double total_seconds, const char *path);

/* Peak memory of the process. */
uint64_t peak_bytes(void);

#endif
