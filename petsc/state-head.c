/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole numbers of 64 bits are two doubles of 32 bits each. */
#include "state-head.h"

#include <math.h>
#include <string.h>

enum { VERSION = 1 };

/* The contents of the head, two doubles each but for the first two. */
enum {
  FORM,
  EPSILON,
  SCENE,
  METHOD = SCENE + 2,
  LINKS = METHOD + 2,
  ENTRIES = LINKS + 2,
  BITS = ENTRIES + 2,
  HEAD = BITS + 2
};

static void put(double *head, int at, uint64_t value) {
  head[at] = (double)(value >> 32);
  head[at + 1] = (double)(value & 0xffffffff);
}

/* 0 of numbers that put() does not make. */
static uint64_t get(const double *head, int at) {
  const double high = head[at], low = head[at + 1], end = 0x1p32;
  return high >= 0 && high < end && low >= 0 && low < end ? (uint64_t)high << 32 | (uint64_t)low
                                                          : 0;
}

static const uint64_t START = 0xcbf29ce484222325;

/* FNV-1a */
static uint64_t mix(uint64_t hash, const void *bytes, size_t size) {
  const unsigned char *byte = bytes;
  for (size_t k = 0; k < size; k++) hash = (hash ^ byte[k]) * 0x100000001b3;
  return hash;
}

static hr2d_status add_to_hash(void *ctx, const void *bytes, size_t size) {
  uint64_t *hash = ctx;
  *hash = mix(*hash, bytes, size);
  return HR2D_OK;
}

hr2d_status hr2dpi_scene_hash(const hr2d_scene *scene, uint64_t *hash) {
  *hash = START;
  return hr2d_state_write_scene(scene, add_to_hash, hash);
}

uint64_t hr2dpi_method_hash(const hr2d_oracle *oracle, const hr2d_policy *policy,
                            unsigned order) {
  const uint64_t named = mix(START, oracle->name, strlen(oracle->name) + 1);
  const uint64_t hash = mix(named, policy->name, strlen(policy->name));
  return order > 1 ? mix(hash, &order, sizeof order) : hash;
}

/* A sum over entries of hashes of their places and bits, so that ranks can add theirs. */
static PetscErrorCode hash_entries(Vec b, uint64_t *hash) {
  PetscFunctionBegin;
  PetscInt from, to;
  const PetscScalar *value;
  *hash = 0;
  PetscCall(VecGetOwnershipRange(b, &from, &to));
  PetscCall(VecGetArrayRead(b, &value));
  for (PetscInt k = from; k < to; k++) {
    const uint64_t place = (uint64_t)k;
    *hash += mix(mix(START, &place, sizeof place), &value[k - from], sizeof *value);
  }
  PetscCall(VecRestoreArrayRead(b, &value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, hash, 1, MPI_UINT64_T, MPI_SUM,
                             PetscObjectComm((PetscObject)b)));
  PetscFunctionReturn(0);
}

/* All of the head is on rank 0. */
static PetscErrorCode make_vector(PetscViewer viewer, int *rank, Vec *v) {
  PetscFunctionBegin;
  const MPI_Comm comm = PetscObjectComm((PetscObject)viewer);
  PetscCallMPI(MPI_Comm_rank(comm, rank));
  PetscCall(VecCreateMPI(comm, *rank == 0 ? HEAD : 0, HEAD, v));
  PetscCall(PetscObjectSetName((PetscObject)*v, "hr2d_head"));
  PetscFunctionReturn(0);
}

/* A copy with the name of the state, since HDF5 asks for one and `b` is the caller's. */
static PetscErrorCode write_field(Vec b, PetscViewer viewer) {
  PetscFunctionBegin;
  Vec copy;
  PetscCall(VecDuplicate(b, &copy));
  PetscCall(VecCopy(b, copy));
  PetscCall(PetscObjectSetName((PetscObject)copy, "hr2d_radiosity"));
  PetscCall(VecView(copy, viewer));
  PetscCall(VecDestroy(&copy));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_head_write(hr2dpi_head *h, Vec b, PetscViewer viewer) {
  PetscFunctionBegin;
  Vec v;
  int rank;
  PetscInt entries;
  PetscScalar *head;
  PetscCall(VecGetSize(b, &entries));
  h->entries = (uint64_t)entries;
  PetscCall(hash_entries(b, &h->bits));
  PetscCall(make_vector(viewer, &rank, &v));
  PetscCall(VecGetArrayWrite(v, &head));
  if (rank == 0) {
    head[FORM] = VERSION;
    head[EPSILON] = h->epsilon;
    put(head, SCENE, h->scene);
    put(head, METHOD, h->method);
    put(head, LINKS, h->links);
    put(head, ENTRIES, h->entries);
    put(head, BITS, h->bits);
  }
  PetscCall(VecRestoreArrayWrite(v, &head));
  PetscCall(VecView(v, viewer));
  PetscCall(VecDestroy(&v));
  PetscCall(write_field(b, viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_head_read(PetscViewer viewer, hr2dpi_head *h, hr2d_status *status) {
  PetscFunctionBegin;
  Vec v;
  int rank;
  double head[HEAD] = {0};
  const PetscScalar *value;
  PetscCall(make_vector(viewer, &rank, &v));
  PetscCall(VecLoad(v, viewer));
  PetscCall(VecGetArrayRead(v, &value));
  if (rank == 0) memcpy(head, value, sizeof head);
  PetscCall(VecRestoreArrayRead(v, &value));
  PetscCall(VecDestroy(&v));
  PetscCallMPI(MPI_Bcast(head, HEAD, MPI_DOUBLE, 0, PetscObjectComm((PetscObject)viewer)));
  *h = (hr2dpi_head){head[EPSILON],    get(head, SCENE),   get(head, METHOD),
                     get(head, LINKS), get(head, ENTRIES), get(head, BITS)};
  const int whole = head[FORM] == VERSION && isfinite(head[EPSILON]) && head[EPSILON] >= 0;
  *status = whole ? HR2D_OK : HR2D_ESYNTAX;
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_head_read_field(PetscViewer viewer, const hr2dpi_head *head, Vec b,
                                      hr2d_status *status) {
  PetscFunctionBegin;
  uint64_t bits;
  PetscCall(PetscObjectSetName((PetscObject)b, "hr2d_radiosity"));
  PetscCall(VecLoad(b, viewer));
  PetscCall(hash_entries(b, &bits));
  *status = bits == head->bits ? HR2D_OK : HR2D_ESYNTAX;
  PetscFunctionReturn(0);
}
