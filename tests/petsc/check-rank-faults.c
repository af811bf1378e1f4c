/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each allocation of libhr2d and of libhr2d-petsc on one rank fails in turn, once: all ranks
   return, with the same code; the call that failed succeeds when it is made again; B is what it
   is without failures; and nothing is left allocated.  That no rank waits for ever is the
   script's part, by its time limit. */
#include <hr2d-petsc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "petsc/petsc-scenes.h"

/* Memory that runs out once. */
typedef struct memory {
  long until_failure; /* negative: never */
  long failures, live;
} memory;

static int runs_out(memory *m) {
  if (m->until_failure < 0 || m->until_failure-- > 0) return 0;
  m->failures++;
  return 1;
}

static void *allocate(void *ctx, size_t bytes) {
  memory *m = ctx;
  void *block = runs_out(m) ? NULL : malloc(bytes);
  m->live += block != NULL;
  return block;
}

static void *reallocate(void *ctx, void *block, size_t bytes) {
  memory *m = ctx;
  void *larger = runs_out(m) ? NULL : realloc(block, bytes);
  m->live += larger && !block;
  return larger;
}

static void release(void *ctx, void *block) {
  memory *m = ctx;
  m->live -= block != NULL;
  free(block);
}

static int wrong;

static void expect(int holds, const char *what, const petsc_case *c, long at) {
  if (holds) return;
  fprintf(stderr, "%s, allocation %ld: %s\n", c->name, at, what);
  wrong = 1;
}

/* All ranks have to see a failure, or none. */
static int agreed(PetscErrorCode code) {
  int ends[2] = {code, -code};
  MPI_Allreduce(MPI_IN_PLACE, ends, 2, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  return ends[0] == -ends[1];
}

typedef struct stage {
  const petsc_case *c;
  const hr2d_scene *scene;
  hr2dp_options options;
  hr2dp *p;
  Vec b;
  double *average;
} stage;

enum { CREATE, REFINE, REFINE_FURTHER, SOLVE, AVERAGES, STEPS };

static PetscErrorCode refine(stage *s, double epsilon) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  return hr2dp_refine(s->p, &options);
}

static PetscErrorCode make_step(stage *s, int step) {
  switch (step) {
  case CREATE:
    return hr2dp_create(PETSC_COMM_WORLD, s->scene, &s->options, &s->p);
  case REFINE:
    return refine(s, 1);
  case REFINE_FURTHER:
    return refine(s, 0.5);
  case SOLVE:
    VecDestroy(&s->b);
    if (hr2dp_vector(s->p, &s->b)) return PETSC_ERR_PLIB;
    return hr2dp_solve(s->p, NULL, s->b, NULL, NULL);
  default:
    return hr2dp_averages(s->p, s->b, s->average);
  }
}

/* A failed refinement drops all links: the first one is made again. */
static PetscErrorCode make_again(stage *s, int step) {
  if (step == REFINE_FURTHER) {
    const PetscErrorCode code = refine(s, 1);
    if (code) return code;
  }
  return make_step(s, step);
}

/* All steps, of which one fails at an allocation on one rank.  Returns whether one did. */
static int play(const petsc_case *c, int victim, long at, double *average, size_t values) {
  int rank;
  memory m = {-1, 0, 0};
  const hr2d_allocator hooks = {allocate, reallocate, release, &m};
  stage s = {.c = c, .options = HR2DP_OPTIONS_INIT};
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  hr2d_scene *scene = petsc_case_scene(c, &hooks);
  s.scene = scene;
  s.options.alloc = &hooks;
  s.average = calloc(values, sizeof *s.average);
  if (!scene || !s.average) abort();
  if (rank == victim) m.until_failure = at;
  for (int step = 0; step < STEPS; step++) {
    PetscErrorCode code = make_step(&s, step);
    expect(agreed(code), "not all ranks see the failure", c, at);
    if (!code) continue;
    if (s.p) expect(hr2dp_status(s.p) == HR2D_ENOMEM, "the status is not HR2D_ENOMEM", c, at);
    expect(rank != victim || m.failures == 1, "a failure without a failed allocation", c, at);
    code = make_again(&s, step);
    expect(!code, "the call that failed does not succeed a second time", c, at);
    if (code) break;
  }
  if (at < 0)
    memcpy(average, s.average, values * sizeof *average);
  else
    expect(!memcmp(average, s.average, values * sizeof *average), "another B", c, at);
  VecDestroy(&s.b);
  hr2dp_destroy(&s.p);
  hr2d_scene_destroy(scene);
  expect(m.live == 0, "something is left allocated", c, at);
  free(s.average);
  int any = m.failures > 0;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  return any;
}

static size_t count_values(const petsc_case *c) {
  hr2d_scene *scene = petsc_case_scene(c, NULL);
  const size_t values = hr2d_scene_patches(scene) * hr2d_scene_bands(scene);
  hr2d_scene_destroy(scene);
  return values;
}

int main(int argc, char **argv) {
  static const char *const names[] = {"plates", "blocks"};
  int ranks, rank;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    const petsc_case *c = petsc_case_named(names[k]);
    const size_t values = count_values(c);
    double *average = calloc(values, sizeof *average);
    long at = 0;
    play(c, 0, -1, average, values);
    for (int victim = 0; victim < ranks; victim++)
      for (at = 0; play(c, victim, at, average, values); at++) continue;
    if (rank == 0) printf("%s: %ld allocations failed on each rank\n", c->name, at);
    free(average);
  }
  MPI_Allreduce(MPI_IN_PLACE, &wrong, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  PetscFinalize();
  return wrong;
}
