/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A state on disk: a head of doubles, then B by position, as two vectors of PETSc. Neither
   depends on the number of ranks.  Links are not in it: they take as long to read as to make.
 */
#ifndef HR2D_PETSC_STATE_HEAD_H
#define HR2D_PETSC_STATE_HEAD_H

#include <hr2d-petsc.h>

typedef struct hr2dpi_head {
  double epsilon;
  uint64_t scene, method; /* hashes of what the state is of */
  uint64_t links, entries;
  uint64_t bits; /* a hash of the entries */
} hr2dpi_head;

/* A hash of all that a committed scene is made of.  HR2D_OK or the status of
   hr2d_state_write_scene(). */
hr2d_status hr2dpi_scene_hash(const hr2d_scene *scene, uint64_t *hash);

/* A hash of the names of an oracle and a policy, and of an order above 1. */
uint64_t hr2dpi_method_hash(const hr2d_oracle *oracle, const hr2d_policy *policy,
                            unsigned order);

/* Collective, as all below: writes the head and B; sets what the head says of B. */
PetscErrorCode hr2dpi_head_write(hr2dpi_head *head, Vec b, PetscViewer viewer);

/* Reads the head.  Returns HR2D_OK in *status, or HR2D_ESYNTAX if it is none. */
PetscErrorCode hr2dpi_head_read(PetscViewer viewer, hr2dpi_head *head, hr2d_status *status);

/* Reads B into a vector of the size in the head.  *status: HR2D_ESYNTAX if it is damaged. */
PetscErrorCode hr2dpi_head_read_field(PetscViewer viewer, const hr2dpi_head *head, Vec b,
                                      hr2d_status *status);

/* Why a state cannot be read for this scene and method, or NULL. */
static inline const char *hr2dpi_head_differs(const hr2dpi_head *head, uint64_t scene,
                                              uint64_t method) {
  if (head->scene != scene) return "the state is of another scene";
  return head->method != method ? "the state is of another oracle, policy or order" : NULL;
}

#endif
