/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rank tells the owner of a unit how its own tree of the unit looks: a byte for each element,
   parents before children and left before right, says whether it is divided and whether this
   rank needs it.  The owner divides its tree alike, and answers with its numbers of the
   elements that are needed.  No path is ever named, so that no depth is too deep. */
#include <limits.h>

#include "trees-impl.h"
#include "units.h"

enum { DIVIDED = 1, NEEDED = 2 };

/* Bytes for all ranks, one rank after the other. */
typedef struct parcel {
  unsigned char *bytes;
  int *count, *start; /* per rank */
  size_t size;
} parcel;

typedef struct shapes {
  hr2dp *p;
  const hr2dpi_places *at;
  uint32_t *stack;
  size_t depth;
  parcel out, in;         /* shapes */
  parcel wanted, answers; /* numbers of elements, 4 bytes each: of owners, and received */
  PetscInt *mine;         /* needed elements of this rank, in the order of the shapes */
  size_t needed;
} shapes;

/* Puts a shape into `bytes`, or only counts its bytes and what it needs. */
static size_t describe(shapes *s, uint32_t base, unsigned char *bytes) {
  const hr2d_element *element = hr2d_hierarchy_elements(s->p->hierarchy);
  size_t size = 0;
  s->depth = 0;
  s->stack[s->depth++] = base;
  while (s->depth > 0) {
    const uint32_t e = s->stack[--s->depth], child = element[e].child;
    const int needed = s->at->touched[e] || (e == base && s->p->units.cut > 0);
    if (bytes) {
      bytes[size] = (unsigned char)((child ? DIVIDED : 0) | (needed ? NEEDED : 0));
      if (needed) s->mine[s->needed] = (PetscInt)e;
    }
    size++;
    s->needed += needed;
    if (!child) continue;
    s->stack[s->depth++] = child + 1;
    s->stack[s->depth++] = child;
  }
  return size;
}

static int is_empty(const shapes *s, uint32_t base) {
  return s->p->units.cut == 0 && !s->at->touched[base] &&
         !hr2d_hierarchy_elements(s->p->hierarchy)[base].child;
}

/* Shapes of all units of other ranks; a shape follows the number of its unit. */
static hr2d_status describe_all(shapes *s, int write) {
  const hr2dp *p = s->p;
  size_t size = 0;
  s->needed = 0;
  for (int r = 0; r < p->ranks; r++) {
    const size_t before = size;
    for (uint64_t u = p->units.leaves.from[r]; u < p->units.leaves.from[r + 1]; u++) {
      const uint32_t unit = (uint32_t)u, base = s->at->base[u];
      if (r == p->rank || base == HR2DPI_NONE || is_empty(s, base)) continue;
      if (write) memcpy(s->out.bytes + size, &unit, sizeof unit);
      size += sizeof unit;
      size += describe(s, base, write ? s->out.bytes + size : NULL);
    }
    if (size > INT_MAX) return HR2D_EMAX_BYTES;
    s->out.start[r] = (int)before;
    s->out.count[r] = (int)(size - before);
  }
  s->out.size = size;
  return HR2D_OK;
}

static hr2d_status reserve(shapes *s) {
  parcel *const all[] = {&s->out, &s->in, &s->wanted, &s->answers};
  const hr2dp *p = s->p;
  for (int k = 0; k < 4; k++) {
    all[k]->count = hr2dpi_alloc_zero(p, 2 * (size_t)p->ranks, sizeof *all[k]->count);
    if (!all[k]->count) return HR2D_ENOMEM;
    all[k]->start = all[k]->count + p->ranks;
  }
  s->stack = hr2dpi_alloc(p, hr2d_hierarchy_count(p->hierarchy).levels + 2, sizeof *s->stack);
  return s->stack ? HR2D_OK : HR2D_ENOMEM;
}

static hr2d_status write_shapes(shapes *s) {
  hr2d_status status = reserve(s);
  if (!status) status = describe_all(s, 0);
  if (status) return status;
  s->out.bytes = hr2dpi_alloc(s->p, s->out.size, 1);
  s->mine = hr2dpi_alloc(s->p, s->needed, sizeof *s->mine);
  return s->out.bytes && s->mine ? describe_all(s, 1) : HR2D_ENOMEM;
}

/* Room for what the counts say. */
static hr2d_status make_room(const hr2dp *p, parcel *of) {
  of->size = 0;
  for (int r = 0; r < p->ranks; r++) {
    if (of->size > INT_MAX) return HR2D_EMAX_BYTES;
    of->start[r] = (int)of->size;
    of->size += (size_t)of->count[r];
  }
  of->bytes = hr2dpi_alloc(p, of->size, 1);
  return of->bytes ? HR2D_OK : HR2D_ENOMEM;
}

static PetscErrorCode send(shapes *s, parcel *out, parcel *in) {
  hr2dp *p = s->p;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Alltoall(out->count, 1, MPI_INT, in->count, 1, MPI_INT, p->comm));
  PetscCall(hr2dpi_agree(p, make_room(p, in)));
  PetscCallMPI(MPI_Alltoallv(out->bytes, out->count, out->start, MPI_BYTE, in->bytes, in->count,
                             in->start, MPI_BYTE, p->comm));
  PetscFunctionReturn(0);
}

/* Grows the stack where another rank has gone deeper. */
static hr2d_status push(shapes *s, size_t *room, uint32_t child) {
  if (s->depth + 2 > *room) {
    uint32_t *larger =
        s->p->alloc.reallocate(s->p->alloc.ctx, s->stack, 2 * (*room + 2) * sizeof *larger);
    if (!larger) return HR2D_ENOMEM;
    s->stack = larger;
    *room = 2 * (*room + 2);
  }
  s->stack[s->depth++] = child + 1;
  s->stack[s->depth++] = child;
  return HR2D_OK;
}

/* Divides a unit as a shape says, and puts down the elements that are needed. */
static hr2d_status follow(shapes *s, size_t *room, const unsigned char **shape, uint32_t base) {
  hr2d_hierarchy *h = s->p->hierarchy;
  hr2d_status status = HR2D_OK;
  s->depth = 0;
  s->stack[s->depth++] = base;
  while (s->depth > 0 && !status) {
    const uint32_t e = s->stack[--s->depth];
    const unsigned char byte = *(*shape)++;
    if (byte & NEEDED) {
      memcpy(s->wanted.bytes + s->wanted.size, &e, sizeof e);
      s->wanted.size += sizeof e;
    }
    if (!(byte & DIVIDED)) continue;
    uint32_t child = hr2d_hierarchy_elements(h)[e].child;
    if (!child) status = hr2d_hierarchy_divide(h, e, 0.5, &child);
    if (!status) status = push(s, room, child);
  }
  return status;
}

static hr2d_status follow_all(shapes *s) {
  const hr2dp *p = s->p;
  size_t room = hr2d_hierarchy_count(p->hierarchy).levels + 2;
  hr2d_status status = HR2D_OK;
  s->wanted.bytes = hr2dpi_alloc(p, s->in.size, sizeof(uint32_t));
  if (!s->wanted.bytes) return HR2D_ENOMEM;
  for (int r = 0; r < p->ranks && !status; r++) {
    const unsigned char *shape = s->in.bytes + s->in.start[r];
    const unsigned char *const end = shape + s->in.count[r];
    const size_t before = s->wanted.size;
    while (shape < end && !status) {
      uint32_t unit;
      memcpy(&unit, shape, sizeof unit);
      shape += sizeof unit;
      status = follow(s, &room, &shape, s->at->base[unit]);
    }
    if (s->wanted.size > INT_MAX) status = HR2D_EMAX_BYTES;
    s->wanted.start[r] = (int)before;
    s->wanted.count[r] = (int)(s->wanted.size - before);
  }
  return status;
}

/* The answers come in the order of the shapes.  Returns how many there are. */
static size_t read_answers(const shapes *s, PetscSFNode *remote) {
  size_t count = 0;
  for (int r = 0; r < s->p->ranks; r++)
    for (int at = 0; at < s->answers.count[r]; at += (int)sizeof(uint32_t)) {
      uint32_t element;
      memcpy(&element, s->answers.bytes + s->answers.start[r] + at, sizeof element);
      remote[count++] = (PetscSFNode){r, (PetscInt)element};
    }
  return count;
}

static PetscErrorCode set_halo(shapes *s, PetscSFNode *remote) {
  PetscFunctionBegin;
  hr2dp *p = s->p;
  const PetscInt elements = (PetscInt)hr2d_hierarchy_count(p->hierarchy).elements;
  p->trees.halos = read_answers(s, remote);
  PetscCall(PetscSFCreate(p->comm, &p->trees.halo));
  PetscCall(PetscSFSetGraph(p->trees.halo, elements, (PetscInt)p->trees.halos, s->mine,
                            PETSC_COPY_VALUES, remote, PETSC_COPY_VALUES));
  PetscCall(PetscSFSetUp(p->trees.halo));
  PetscFunctionReturn(0);
}

static PetscErrorCode make_halo(shapes *s) {
  PetscFunctionBegin;
  PetscSFNode *remote = hr2dpi_alloc(s->p, s->needed, sizeof *remote);
  PetscErrorCode failed = hr2dpi_agree(s->p, remote ? HR2D_OK : HR2D_ENOMEM);
  if (!failed) failed = set_halo(s, remote);
  hr2dpi_free(s->p, remote);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

static PetscErrorCode exchange(shapes *s) {
  PetscFunctionBegin;
  PetscCall(hr2dpi_agree(s->p, write_shapes(s)));
  PetscCall(send(s, &s->out, &s->in));
  PetscCall(hr2dpi_agree(s->p, follow_all(s)));
  PetscCall(send(s, &s->wanted, &s->answers));
  PetscCall(make_halo(s));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_shapes_exchange(hr2dp *p, const hr2dpi_places *at) {
  PetscFunctionBegin;
  shapes s = {.p = p, .at = at};
  parcel *const all[] = {&s.out, &s.in, &s.wanted, &s.answers};
  const PetscErrorCode failed = exchange(&s);
  for (int k = 0; k < 4; k++) {
    hr2dpi_free(p, all[k]->bytes);
    hr2dpi_free(p, all[k]->count);
  }
  hr2dpi_free(p, s.stack);
  hr2dpi_free(p, s.mine);
  PetscCall(failed);
  PetscFunctionReturn(0);
}
