/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A state on disk: a head of HEAD doubles, then B by position, as two vectors of PETSc. Neither
   depends on the number of ranks.  Links are not in it: they take as long to read as to make.
   Whole numbers of 64 bits are two doubles of 32 bits each. */
#include "hr2dp-impl.h"

enum { VERSION = 1 };

/* What the head holds, two doubles each but for the first two. */
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

static int holds(const double *head, int at, uint64_t value) {
  double expected[2];
  put(expected, 0, value);
  return head[at] == expected[0] && head[at + 1] == expected[1];
}

static uint64_t mix(uint64_t hash, const void *bytes, size_t size) {
  const unsigned char *byte = bytes;
  for (size_t k = 0; k < size; k++) hash = (hash ^ byte[k]) * 0x100000001b3;
  return hash;
}

/* The names of the oracle and the policy. */
static uint64_t method_of(const hr2dp *p) {
  const uint64_t hash = mix(0xcbf29ce484222325, p->oracle.name, strlen(p->oracle.name) + 1);
  return mix(hash, p->policy.name, strlen(p->policy.name));
}

/* A sum over entries of hashes of their places and bits, so that ranks can add theirs. */
static PetscErrorCode hash_entries(hr2dp *p, Vec b, uint64_t *hash) {
  PetscFunctionBegin;
  PetscInt from, to;
  const PetscScalar *value;
  *hash = 0;
  PetscCall(VecGetOwnershipRange(b, &from, &to));
  PetscCall(VecGetArrayRead(b, &value));
  for (PetscInt k = from; k < to; k++) {
    const uint64_t place = (uint64_t)k;
    *hash +=
        mix(mix(0xcbf29ce484222325, &place, sizeof place), &value[k - from], sizeof *value);
  }
  PetscCall(VecRestoreArrayRead(b, &value));
  PetscCall(hr2dpi_add_counts(p, hash, 1));
  PetscFunctionReturn(0);
}

/* All of the head is on rank 0. */
static PetscErrorCode make_head(const hr2dp *p, Vec *v) {
  PetscFunctionBegin;
  PetscCall(VecCreateMPI(p->comm, p->rank == 0 ? HEAD : 0, HEAD, v));
  PetscCall(PetscObjectSetName((PetscObject)*v, "hr2d_head"));
  PetscFunctionReturn(0);
}

static PetscErrorCode fill_head(hr2dp *p, Vec b, Vec v) {
  PetscFunctionBegin;
  PetscInt entries;
  uint64_t bits;
  PetscScalar *head;
  PetscCall(VecGetSize(b, &entries));
  PetscCall(hash_entries(p, b, &bits));
  PetscCall(VecGetArrayWrite(v, &head));
  if (p->rank == 0) {
    head[FORM] = VERSION;
    head[EPSILON] = hr2d_linkset_epsilon(p->links);
    put(head, SCENE, p->hash);
    put(head, METHOD, method_of(p));
    put(head, LINKS, p->counts.whole.links);
    put(head, ENTRIES, (uint64_t)entries);
    put(head, BITS, bits);
  }
  PetscCall(VecRestoreArrayWrite(v, &head));
  PetscFunctionReturn(0);
}

/* A copy with the name of the state, since HDF5 asks for one and `b` is the caller's. */
static PetscErrorCode write_field(hr2dp *p, Vec b, PetscViewer viewer) {
  PetscFunctionBegin;
  Vec copy;
  PetscCall(hr2dp_vector(p, &copy));
  PetscCall(VecCopy(b, copy));
  PetscCall(PetscObjectSetName((PetscObject)copy, "hr2d_radiosity"));
  PetscCall(VecView(copy, viewer));
  PetscCall(VecDestroy(&copy));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_save(hr2dp *p, Vec b, PetscViewer viewer) {
  PetscFunctionBegin;
  Vec head;
  hr2dpi_begin(p);
  PetscCheck(p->refined, p->comm, PETSC_ERR_ARG_WRONGSTATE, "there was no refinement");
  PetscCall(make_head(p, &head));
  PetscCall(fill_head(p, b, head));
  PetscCall(VecView(head, viewer));
  PetscCall(VecDestroy(&head));
  PetscCall(write_field(p, b, viewer));
  PetscFunctionReturn(0);
}

static PetscErrorCode read_head(hr2dp *p, PetscViewer viewer, double *head) {
  PetscFunctionBegin;
  Vec v;
  const PetscScalar *value;
  PetscCall(make_head(p, &v));
  PetscCall(VecLoad(v, viewer));
  PetscCall(VecGetArrayRead(v, &value));
  if (p->rank == 0) memcpy(head, value, HEAD * sizeof *head);
  PetscCall(VecRestoreArrayRead(v, &value));
  PetscCall(VecDestroy(&v));
  PetscCallMPI(MPI_Bcast(head, HEAD, MPI_DOUBLE, 0, p->comm));
  PetscFunctionReturn(0);
}

static hr2d_status check_head(hr2dp *p, const double *head) {
  if (head[FORM] != VERSION)
    return hr2dpi_fail(p, HR2D_ESYNTAX, "this is not a state of hr2dp_save()");
  if (!holds(head, SCENE, p->hash))
    return hr2dpi_fail(p, HR2D_EINVAL, "the state is of another scene");
  if (!holds(head, METHOD, method_of(p)))
    return hr2dpi_fail(p, HR2D_EINVAL, "the state is of another oracle or policy");
  if (!isfinite(head[EPSILON]) || head[EPSILON] < 0)
    return hr2dpi_fail(p, HR2D_ESYNTAX, "the state is damaged");
  return HR2D_OK;
}

static hr2d_status check_size(hr2dp *p, const double *head, uint64_t entries) {
  if (!holds(head, LINKS, p->counts.whole.links) || !holds(head, ENTRIES, entries))
    return hr2dpi_fail(p, HR2D_EINVAL, "the state was refined with other options");
  return HR2D_OK;
}

static PetscErrorCode read_field(hr2dp *p, PetscViewer viewer, const double *head, Vec b) {
  PetscFunctionBegin;
  uint64_t bits;
  PetscInt entries;
  PetscCall(VecGetSize(b, &entries));
  PetscCall(hr2dpi_agree(p, check_size(p, head, (uint64_t)entries)));
  PetscCall(PetscObjectSetName((PetscObject)b, "hr2d_radiosity"));
  PetscCall(VecLoad(b, viewer));
  PetscCall(hash_entries(p, b, &bits));
  const hr2d_status status =
      holds(head, BITS, bits) ? HR2D_OK : hr2dpi_fail(p, HR2D_ESYNTAX, "the state is damaged");
  PetscCall(hr2dpi_agree(p, status));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_load(hr2dp *p, const hr2d_refine_options *given, PetscViewer viewer,
                          Vec *b, double *epsilon) {
  PetscFunctionBegin;
  double head[HEAD];
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2dpi_begin(p);
  PetscCheck(!p->refined, p->comm, PETSC_ERR_ARG_WRONGSTATE, "there are links already");
  PetscCall(read_head(p, viewer, head));
  PetscCall(hr2dpi_agree(p, check_head(p, head)));
  if (given)
    memcpy(&options, given,
           given->struct_size < sizeof options ? given->struct_size : sizeof options);
  options.epsilon = head[EPSILON] > 0 ? head[EPSILON] : HR2D_EPSILON_ZERO;
  if (epsilon) *epsilon = head[EPSILON];
  PetscCall(hr2dp_refine(p, &options));
  PetscCall(hr2dp_vector(p, b));
  const PetscErrorCode failed = read_field(p, viewer, head, *b);
  if (failed) PetscCall(VecDestroy(b));
  PetscCall(failed);
  PetscFunctionReturn(0);
}
