/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the calls of the page and those of the package have in common. */
#ifndef HR2D_PLAYGROUND_GLUE_H
#define HR2D_PLAYGROUND_GLUE_H

#include <hr2d/hr2d.h>

/* Visible to JavaScript; the linker begins with these. */
#define PAGE(name) __attribute__((export_name(#name))) name

/* JavaScript: whether to go on.  Receives the phase and the part of it that is done. */
__attribute__((import_module("env"), import_name("go_on"))) extern int go_on(const char *phase,
                                                                             double fraction);

/* A solve as the program makes it; hierarchy and links are NULL if they belong to the solution.
 */
typedef struct glue_solve {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  hr2d_account account;
} glue_solve;

/* package.c: gives away the solve that is kept; its document stays until package_end(). */
glue_solve glue_take(void);

/* The mean radiosity at the nodes of a grid, nodes × bands, and the place of each node. */
hr2d_status glue_field(const hr2d_solution *solution, hr2d_point low, hr2d_point high,
                       size_t columns, size_t rows, double tolerance, double *mean,
                       unsigned char *place);

#endif
