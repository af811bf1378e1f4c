/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the rows of exchange areas of a scene, on a team of threads.

   A task is a block of patches along one side of a wall: beams from there find the line
   classes, which are shared among the block's patches.  Rows have scaled areas and no zeros,
   with their columns in order, and do not depend on threads.

   A whole row has all patches that its patch sees.  A half row has only the line classes that
   are taken from its patch and not from the other end: the exchange area of i and j is the sum
   of their entries in the half rows of i and of j, of which one is mostly missing. */
#ifndef HR2D_SRC_VISIBILITY_ROW_ASSEMBLY_H
#define HR2D_SRC_VISIBILITY_ROW_ASSEMBLY_H

#include "base/team.h"
#include "scene/side-parts.h"
#include "visibility/sparse-accumulator.h"

/* A row; columns of pairs that something bounds but the patches are marked by HR2DI_PARTIAL. */
typedef struct hr2di_row {
  uint32_t patch;
  const uint32_t *column;
  const double *area;
  size_t count;
} hr2di_row;

/* Takes a row on thread `worker`; what the row points to is lost when it returns. */
typedef hr2d_status (*hr2di_row_fn)(void *ctx, size_t worker, const hr2di_row *row);

typedef struct hr2di_row_task {
  uint32_t first, last; /* rows, as places in hr2di_runs::patch */
  hr2di_parts parts;
} hr2di_row_task;

typedef struct hr2di_row_worker hr2di_row_worker;

typedef struct hr2di_row_assembly {
  const hr2d_scene *scene;
  hr2di_watch *watch;
  int whole;            /* rows */
  int beams;            /* something can be in the way */
  hr2di_row_task *task; /* along a Hilbert curve */
  size_t tasks;
  hr2di_row_worker *worker;
  size_t workers;
  hr2di_row_fn take;
  void *ctx;
  size_t offset; /* of the tasks of a run of the team */
  atomic_size_t done;
  atomic_int stop;
} hr2di_row_assembly;

/* Prepares the tasks of a committed scene, for so many threads.  HR2D_OK, HR2D_ENOMEM or the
   status of the watch; to be ended by hr2di_row_assembly_clear() in any case. */
hr2d_status hr2di_row_assembly_init(hr2di_row_assembly *m, const hr2d_scene *scene,
                                    unsigned threads, int whole, hr2di_watch *watch);
void hr2di_row_assembly_clear(hr2di_row_assembly *m);

/* Makes the rows of tasks [first, last), each once.  Returns HR2D_OK or the status of one that
   failed. */
hr2d_status hr2di_row_assembly_run(hr2di_row_assembly *m, size_t first, size_t last,
                                   hr2di_row_fn take, void *ctx);

/* The part of the tasks that is done. */
double hr2di_row_assembly_fraction(const hr2di_row_assembly *m);

/* Triangles that beams have passed so far. */
uint64_t hr2di_row_assembly_steps(const hr2di_row_assembly *m);

#endif
