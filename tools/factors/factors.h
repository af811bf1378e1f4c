/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view factors of a scene, F_ij = AF_ij / A_i. */
#ifndef HR2D_TOOLS_FACTORS_FACTORS_H
#define HR2D_TOOLS_FACTORS_FACTORS_H

#include <hr2d/hr2d.h>
#include <stdio.h>

#include "cli/options.h"

typedef struct factors {
  const options *options;
  const hr2d_scene *scene;
  hr2d_exchange_rows *rows; /* of patches */

  /* Rows and columns of the matrix: patches, or with --group features. */
  size_t count;
  const char **name;
  size_t owns_names; /* so many of them have to be freed */
  double *length;    /* A_i */
  const uint64_t *start;
  const uint32_t *column;
  const double *area;
  struct {
    uint64_t *start;
    uint32_t *column;
    double *area;
  } own; /* with --group */

  double *row_sum; /* Σ F_ij */
  double *missing; /* 1 − Σ F_ij, without the rounding errors of the row sum */
  double *row;     /* one row of F_ij, with its zeros */
  double *off[2];  /* what images that are cut off may make of Σ F_ij, and that at most */
  hr2d_matrix_counts counts;
  size_t cuts;    /* of --split-crossings */
  double seconds; /* for all exchange areas */
} factors;

/* group.c: makes rows of features of those of patches.  Returns 0 or EXIT_FAILED. */
int factors_group(factors *f);

/* row.c: returns row i of F_ij with its zeros, which lasts until the next call. */
const double *factors_row(const factors *f, size_t i);

/* row.c: writes a line "i j F_ij" for each entry of row i that is not 0; both count from 1. */
void factors_print_entries(const factors *f, size_t i, FILE *stream);

/* How many pairs see nothing of each other. */
uint64_t factors_unseen(const factors *f);

/* csv.c: a line of names, then a row of F_ij for each patch. */
int factors_write_csv(const factors *f);

/* mtx.c: the entries that are not 0 in the coordinate format of Matrix Market. */
int factors_write_mtx(const factors *f);

/* elmer.c: the entries that are not 0 as ViewFactors.dat of Elmer. */
int factors_write_elmer(const factors *f);

/* moose.c: a block of an input file of MOOSE.  Boundaries have names of their own. */
int factors_write_moose(const factors *f);

/* json.c */
int factors_write_json(const factors *f, const char *path);

#endif
