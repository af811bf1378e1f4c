/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rank 0 reads the file; the others get the committed scene, bit for bit. */
#include "cli/scene.h"

#include <stdlib.h>
#include <string.h>

#include "cli/warnings.h"
#include "output/complain.h"
#include "program.h"

typedef struct text {
  char *bytes;
  size_t size, room, next;
} text;

static hr2d_status append(void *ctx, const void *bytes, size_t size) {
  text *t = ctx;
  if (t->size + size > t->room) {
    const size_t room = 2 * (t->size + size);
    char *larger = realloc(t->bytes, room);
    if (!larger) return HR2D_ENOMEM;
    t->bytes = larger;
    t->room = room;
  }
  memcpy(t->bytes + t->size, bytes, size);
  t->size += size;
  return HR2D_OK;
}

static hr2d_status take(void *ctx, void *bytes, size_t size) {
  text *t = ctx;
  if (size > t->size - t->next) return HR2D_ESYNTAX;
  memcpy(bytes, t->bytes + t->next, size);
  t->next += size;
  return HR2D_OK;
}

static int read_scene(job *j, text *t) {
  warnings w = {0};
  int status = scene_load(j->options, j->options->force, &j->scene, &j->cuts);
  if (status) return status;
  status = warnings_find(j->options, j->scene, 0, &w);
  warnings_release(&w);
  if (!status && hr2d_state_write_scene(j->scene, append, t)) status = complain_memory();
  return status;
}

/* In pieces, as MPI counts in int. */
static void broadcast(text *t) {
  const size_t piece = 1 << 30;
  for (size_t at = 0; at < t->size; at += piece) {
    const size_t some = t->size - at < piece ? t->size - at : piece;
    MPI_Bcast(t->bytes + at, (int)some, MPI_BYTE, 0, PETSC_COMM_WORLD);
  }
}

/* Ranks that cannot get the scene say so together. */
static int receive(job *j, text *t) {
  uint64_t size = t->size;
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, PETSC_COMM_WORLD);
  if (j->rank > 0) t->bytes = malloc((size_t)size);
  t->size = (size_t)size;
  int failed = !t->bytes;
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  if (!failed) {
    broadcast(t);
    if (j->rank > 0)
      failed = hr2d_scene_create(NULL, &j->scene) || hr2d_state_read_scene(j->scene, take, t);
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  }
  return failed ? (j->rank == 0 ? complain_memory() : EXIT_FAILED) : 0;
}

int job_load_scene(job *j) {
  text t = {0};
  int status = job_agree(j->rank == 0 ? read_scene(j, &t) : 0);
  if (!status) status = receive(j, &t);
  free(t.bytes);
  return status;
}
