/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state of a solution that is whole on every rank: each writes and reads a part of its
   leaves. */
#include <stdlib.h>
#include <string.h>

#include "state-head.h"

/* The leaves of a hierarchy by position. */
typedef struct leaves {
  uint32_t *at;
  uint32_t *stack;
  size_t count;
} leaves;

static void clear_leaves(leaves *l) {
  free(l->at);
  free(l->stack);
}

/* Roots come first in a hierarchy, and are their own parents. */
static int list_leaves(const hr2d_hierarchy *h, leaves *l) {
  const hr2d_hierarchy_counts n = hr2d_hierarchy_count(h);
  const hr2d_element *element = hr2d_hierarchy_elements(h);
  *l = (leaves){malloc((size_t)n.leaves * sizeof *l->at),
                malloc((n.levels + 2) * sizeof *l->stack), 0};
  if (!l->at || !l->stack) return 0;
  for (uint32_t root = 0; root < n.elements && hr2d_element_parent(h, root) == root; root++) {
    size_t depth = 0;
    l->stack[depth++] = root;
    while (depth > 0) {
      const uint32_t e = l->stack[--depth];
      if (!element[e].child) {
        l->at[l->count++] = e;
        continue;
      }
      l->stack[depth++] = element[e].child + 1;
      l->stack[depth++] = element[e].child;
    }
  }
  return 1;
}

/* All ranks learn whether one of them lacks memory. */
static PetscErrorCode agree(MPI_Comm comm, int has) {
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &has, 1, MPI_INT, MPI_MIN, comm));
  PetscCheck(has, comm, PETSC_ERR_MEM, "out of memory");
  PetscFunctionReturn(0);
}

/* The coefficients of a leaf stand side by side. */
static size_t width_of(const hr2d_hierarchy *h) {
  return hr2d_hierarchy_order(h) * hr2d_scene_bands(hr2d_hierarchy_scene(h));
}

static PetscErrorCode make_field(MPI_Comm comm, size_t entries, Vec *b) {
  PetscFunctionBegin;
  PetscCheck(entries <= (size_t)PETSC_MAX_INT, comm, PETSC_ERR_ARG_SIZ,
             "%zu coefficients are too many", entries);
  PetscCall(VecCreateMPI(comm, PETSC_DECIDE, (PetscInt)entries, b));
  PetscFunctionReturn(0);
}

/* The head that a state of these links would have, but for B. */
static PetscErrorCode expect_head(MPI_Comm comm, const hr2d_linkset *links, hr2dpi_head *head) {
  PetscFunctionBegin;
  const hr2d_hierarchy *h = hr2d_linkset_hierarchy(links);
  *head = (hr2dpi_head){.epsilon = hr2d_linkset_epsilon(links),
                        .method = hr2dpi_method_hash(hr2d_linkset_oracle(links),
                                                     hr2d_linkset_policy(links),
                                                     hr2d_hierarchy_order(h)),
                        .links = hr2d_linkset_counts(links).links,
                        .entries = width_of(h) * hr2d_hierarchy_count(h).leaves};
  const hr2d_status status = hr2dpi_scene_hash(hr2d_hierarchy_scene(h), &head->scene);
  PetscCheck(!status, comm, PETSC_ERR_LIB, "the scene: %s", hr2d_strerror(status));
  PetscFunctionReturn(0);
}

static PetscErrorCode save(const hr2d_solution *solution, const leaves *l, PetscViewer viewer) {
  PetscFunctionBegin;
  const MPI_Comm comm = PetscObjectComm((PetscObject)viewer);
  const hr2d_linkset *links = hr2d_solution_links(solution);
  const size_t width = width_of(hr2d_linkset_hierarchy(links));
  const double *field = hr2d_solution_field(solution);
  hr2dpi_head head;
  Vec b;
  PetscInt from, to;
  PetscScalar *value;
  PetscCall(expect_head(comm, links, &head));
  PetscCall(make_field(comm, l->count * width, &b));
  PetscCall(VecGetOwnershipRange(b, &from, &to));
  PetscCall(VecGetArrayWrite(b, &value));
  for (size_t k = (size_t)from; k < (size_t)to; k++)
    value[k - (size_t)from] = field[l->at[k / width] * width + k % width];
  PetscCall(VecRestoreArrayWrite(b, &value));
  const PetscErrorCode failed = hr2dpi_head_write(&head, b, viewer);
  PetscCall(VecDestroy(&b));
  PetscCall(failed);
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_save_solution(const hr2d_solution *solution, PetscViewer viewer) {
  PetscFunctionBegin;
  leaves l;
  const int has = list_leaves(hr2d_linkset_hierarchy(hr2d_solution_links(solution)), &l);
  PetscErrorCode failed = agree(PetscObjectComm((PetscObject)viewer), has);
  if (!failed) failed = save(solution, &l, viewer);
  clear_leaves(&l);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

/* All of B to every rank: its leaves in a field of all elements. */
static PetscErrorCode spread(Vec b, const leaves *l, size_t width, double *field) {
  PetscFunctionBegin;
  VecScatter scatter;
  Vec whole;
  const PetscScalar *value;
  PetscCall(VecScatterCreateToAll(b, &scatter, &whole));
  PetscCall(VecScatterBegin(scatter, b, whole, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, b, whole, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArrayRead(whole, &value));
  for (size_t k = 0; k < l->count * width; k++)
    field[l->at[k / width] * width + k % width] = value[k];
  PetscCall(VecRestoreArrayRead(whole, &value));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&whole));
  PetscFunctionReturn(0);
}

static PetscErrorCode read_field(const hr2dpi_head *head, PetscViewer viewer, const leaves *l,
                                 size_t width, double *field) {
  PetscFunctionBegin;
  const MPI_Comm comm = PetscObjectComm((PetscObject)viewer);
  hr2d_status status = HR2D_OK;
  Vec b;
  PetscCall(make_field(comm, l->count * width, &b));
  PetscErrorCode failed = hr2dpi_head_read_field(viewer, head, b, &status);
  if (!failed && !status) failed = spread(b, l, width, field);
  PetscCall(VecDestroy(&b));
  PetscCall(failed);
  PetscCheck(!status, comm, PETSC_ERR_FILE_UNEXPECTED, "the state is damaged");
  PetscFunctionReturn(0);
}

static PetscErrorCode adopt(hr2d_linkset *links, const hr2d_solve_options *options,
                            const hr2dpi_head *head, PetscViewer viewer,
                            hr2d_solution **solution) {
  PetscFunctionBegin;
  const MPI_Comm comm = PetscObjectComm((PetscObject)viewer);
  const hr2d_hierarchy *h = hr2d_linkset_hierarchy(links);
  const size_t width = width_of(h);
  leaves l;
  const int has = list_leaves(h, &l);
  double *field = malloc((size_t)hr2d_hierarchy_count(h).elements * width * sizeof *field);
  PetscErrorCode failed = agree(comm, has && field);
  if (!failed) failed = read_field(head, viewer, &l, width, field);
  const hr2d_status status =
      failed ? HR2D_OK : hr2d_solution_adopt(links, options, field, solution);
  clear_leaves(&l);
  free(field);
  PetscCall(failed);
  PetscCheck(!status, comm, PETSC_ERR_LIB, "%s", hr2d_linkset_message(links));
  PetscFunctionReturn(0);
}

static PetscErrorCode refine(hr2d_linkset *links, const hr2d_refine_options *given,
                             const hr2dpi_head *head, MPI_Comm comm) {
  PetscFunctionBegin;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2dpi_head made;
  memcpy(&options, given,
         given->struct_size < sizeof options ? given->struct_size : sizeof options);
  options.struct_size = sizeof options;
  options.epsilon = head->epsilon > 0 ? head->epsilon : HR2D_EPSILON_ZERO;
  const hr2d_status status = hr2d_refine(links, &options);
  PetscCheck(!status, comm, PETSC_ERR_LIB, "%s", hr2d_linkset_message(links));
  PetscCall(expect_head(comm, links, &made));
  PetscCheck(made.links == head->links && made.entries == head->entries, comm,
             PETSC_ERR_ARG_INCOMP, "the state was refined with other options");
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_load_solution(hr2d_linkset *links, const hr2d_refine_options *refinement,
                                   const hr2d_solve_options *options, PetscViewer viewer,
                                   hr2d_solution **solution) {
  PetscFunctionBegin;
  const MPI_Comm comm = PetscObjectComm((PetscObject)viewer);
  hr2dpi_head head, expected;
  hr2d_status status;
  *solution = NULL;
  PetscCall(hr2dpi_head_read(viewer, &head, &status));
  PetscCheck(!status, comm, PETSC_ERR_FILE_UNEXPECTED, "this is not a state, or it is damaged");
  PetscCall(expect_head(comm, links, &expected));
  const char *differs = hr2dpi_head_differs(&head, expected.scene, expected.method);
  PetscCheck(!differs, comm, PETSC_ERR_ARG_INCOMP, "%s", differs);
  PetscCall(refine(links, refinement, &head, comm));
  PetscCall(adopt(links, options, &head, viewer, solution));
  PetscFunctionReturn(0);
}
