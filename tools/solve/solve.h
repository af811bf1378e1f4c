/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result of `hr2d solve`, in three forms. */
#ifndef HR2D_TOOLS_SOLVE_SOLVE_H
#define HR2D_TOOLS_SOLVE_SOLVE_H

#include <jansson.h>

#include "run/run.h"

/* command.c: solves a committed scene, and reports.  With shares all of them call it, and the
   first one reports.  Returns the exit status of this process. */
int solve_scene(const options *o, const hr2d_scene *scene, size_t cuts, double start,
                const run_shares *shares);

/* table.c: the summary on standard output.  Returns 0 or the exit status, as the others do. */
int solve_print(const run *r, double total_seconds);

/* csv.c: a row for each leaf: patch,name,t0,t1,ax,ay,bx,by,B0,…,H0,…, with t0 and t1 fractions
   of the patch, and at an order p above 1
   B0c1,…,B0c(p-1),B1c1,…: B = Σ c_l P_l(2s − 1) at fraction s of the leaf, c_0 = B0.  Then come
   Q0,…, B − H times the length.  In a scene with temperatures or fluxes the last column is T,
   of the average H. */
int solve_write_csv(const run *r, const char *path);

/* vtk.c: a line for each leaf, with B, H and T of it and of its patch. */
int solve_write_vtk(const run *r, const char *path);

/* json.c: the result, or NULL if an allocation failed; and a file of it. */
json_t *solve_json(const run *r, double total_seconds);
int solve_write_json(const run *r, double total_seconds, const char *path);

#endif
