/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state of an hr2dp. */
#include "hr2dp-impl.h"
#include "state-head.h"

PetscErrorCode hr2dp_save(hr2dp *p, Vec b, PetscViewer viewer) {
  PetscFunctionBegin;
  hr2dpi_begin(p);
  PetscCheck(p->refined, p->comm, PETSC_ERR_ARG_WRONGSTATE, "there was no refinement");
  hr2dpi_head head = {.epsilon = hr2d_linkset_epsilon(p->links),
                      .scene = p->hash,
                      .method = hr2dpi_method_hash(&p->oracle, &p->policy, 1),
                      .links = p->counts.whole.links};
  PetscCall(hr2dpi_head_write(&head, b, viewer));
  PetscFunctionReturn(0);
}

static PetscErrorCode read_head(hr2dp *p, PetscViewer viewer, hr2dpi_head *head) {
  PetscFunctionBegin;
  hr2d_status status;
  PetscCall(hr2dpi_head_read(viewer, head, &status));
  if (status) hr2dpi_fail(p, status, "this is not a state, or it is damaged");
  const char *differs =
      hr2dpi_head_differs(head, p->hash, hr2dpi_method_hash(&p->oracle, &p->policy, 1));
  if (!status && differs) status = hr2dpi_fail(p, HR2D_EINVAL, "%s", differs);
  PetscCall(hr2dpi_agree(p, status));
  PetscFunctionReturn(0);
}

static hr2d_status check_size(hr2dp *p, const hr2dpi_head *head, PetscInt entries) {
  if (head->links != p->counts.whole.links || head->entries != (uint64_t)entries)
    return hr2dpi_fail(p, HR2D_EINVAL, "the state was refined with other options");
  return HR2D_OK;
}

static PetscErrorCode read_field(hr2dp *p, PetscViewer viewer, const hr2dpi_head *head, Vec b) {
  PetscFunctionBegin;
  PetscInt entries;
  hr2d_status status;
  PetscCall(VecGetSize(b, &entries));
  PetscCall(hr2dpi_agree(p, check_size(p, head, entries)));
  PetscCall(hr2dpi_head_read_field(viewer, head, b, &status));
  if (status) hr2dpi_fail(p, status, "the state is damaged");
  PetscCall(hr2dpi_agree(p, status));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_load(hr2dp *p, const hr2d_refine_options *given, PetscViewer viewer,
                          Vec *b, double *epsilon) {
  PetscFunctionBegin;
  hr2dpi_head head;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2dpi_begin(p);
  PetscCheck(!p->refined, p->comm, PETSC_ERR_ARG_WRONGSTATE, "there are links already");
  PetscCall(read_head(p, viewer, &head));
  if (given)
    memcpy(&options, given,
           given->struct_size < sizeof options ? given->struct_size : sizeof options);
  options.epsilon = head.epsilon > 0 ? head.epsilon : HR2D_EPSILON_ZERO;
  if (epsilon) *epsilon = head.epsilon;
  PetscCall(hr2dp_refine(p, &options));
  PetscCall(hr2dp_vector(p, b));
  const PetscErrorCode failed = read_field(p, viewer, &head, *b);
  if (failed) PetscCall(VecDestroy(b));
  PetscCall(failed);
  PetscFunctionReturn(0);
}
