/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The object: what a rank has of a scene. */
#include <stdlib.h>

#include "constants.h"
#include "share.h"
#include "state-head.h"
#include "trees.h"
#include "units.h"

static void *plain_allocate(void *ctx, size_t bytes) {
  (void)ctx;
  return malloc(bytes);
}

static void *plain_reallocate(void *ctx, void *block, size_t bytes) {
  (void)ctx;
  return realloc(block, bytes);
}

static void plain_release(void *ctx, void *block) {
  (void)ctx;
  free(block);
}

static const hr2d_allocator plain = {plain_allocate, plain_reallocate, plain_release, NULL};

/* Takes over what the caller's struct has, and defaults for what it has not. */
static void read_options(hr2dp *p, const hr2dp_options *given) {
  hr2dp_options o = HR2DP_OPTIONS_INIT;
  if (given) memcpy(&o, given, given->struct_size < sizeof o ? given->struct_size : sizeof o);
  p->oracle = o.oracle ? *o.oracle : *hr2d_oracle_size();
  p->policy = o.policy ? *o.policy : *hr2d_policy_original();
  p->oracle.destroy = NULL;
  p->policy.destroy = NULL;
  p->oracle_ctx = o.oracle_ctx;
  p->policy_ctx = o.policy_ctx;
}

/* Every rank must have the scene of rank 0. */
static PetscErrorCode compare_scenes(hr2dp *p) {
  PetscFunctionBegin;
  PetscCall(hr2dpi_agree(p, hr2dpi_scene_hash(p->scene, &p->hash)));
  uint64_t ends[2] = {p->hash, ~p->hash};
  PetscCall(hr2dpi_max_counts(p, ends, 2));
  const hr2d_status status =
      ends[0] == ~ends[1]
          ? HR2D_OK
          : hr2dpi_fail(p, HR2D_EINVAL, "the scene is not the same on all ranks");
  PetscCall(hr2dpi_agree(p, status));
  PetscFunctionReturn(0);
}

static hr2d_status check_scene(hr2dp *p, const hr2dp_options *options) {
  if (options && options->struct_size >= offsetof(hr2dp_options, alloc) && options->order > 1)
    return hr2dpi_fail(p, HR2D_EUNSUPPORTED,
                       "order %u: this version has one constant per element", options->order);
  if (options && options->struct_size < offsetof(hr2dp_options, oracle_ctx))
    return hr2dpi_fail(p, HR2D_EINVAL, "struct_size is not set");
  if (hr2dpi_has_spectra(p->scene))
    return hr2dpi_fail(p, HR2D_EUNSUPPORTED,
                       "patches of given flux in several bands: hr2dp_share_create() is for "
                       "their temperatures");
  if (hr2dpi_has_daylight(p->scene))
    return hr2dpi_fail(p, HR2D_EUNSUPPORTED,
                       "a sun, or a sky in pieces: hr2dp_share_create() is for their light");
  if (hr2d_scene_effect(p->scene, HR2D_EFFECT_PANES, NULL))
    return hr2dpi_fail(p, HR2D_EUNSUPPORTED,
                       "panes: hr2dp_share_create() is for the light that passes them");
  /* Elements are numbered by PetscInt, patches counted by int. */
  if (p->patches > INT_MAX / 8)
    return hr2dpi_fail(p, HR2D_EUNSUPPORTED, "%zu patches are too many", p->patches);
  return HR2D_OK;
}

static PetscErrorCode create(hr2dp *p, MPI_Comm comm, const hr2dp_options *options) {
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &p->rank));
  PetscCallMPI(MPI_Comm_size(comm, &p->ranks));
  read_options(p, options);
  p->patches = hr2d_scene_patches(p->scene);
  p->images = hr2d_scene_images(p->scene);
  /* Images that stand for others count up to so often: tests/unit/scene/check-period-weights.c.
   */
  p->max = hr2d_scene_cut_off(p->scene) > 0 ? 2 * (double)p->images : 1;
  p->bands = hr2d_scene_bands(p->scene);
  PetscCall(hr2dpi_agree(p, check_scene(p, options)));
  PetscCall(compare_scenes(p));
  hr2d_status status = hr2dpi_units_init(p);
  if (!status) status = hr2dpi_share_init(p);
  PetscCall(hr2dpi_agree(p, status));
  PetscFunctionReturn(0);
}

static int knows_allocator(const hr2dp_options *options) {
  return options && options->struct_size >= sizeof *options && options->alloc;
}

PetscErrorCode hr2dp_create(MPI_Comm comm, const hr2d_scene *scene,
                            const hr2dp_options *options, hr2dp **made) {
  PetscFunctionBegin;
  const hr2d_allocator alloc = knows_allocator(options) ? *options->alloc : plain;
  hr2dp *p = alloc.allocate(alloc.ctx, sizeof *p);
  int failed = !p;
  *made = NULL;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, comm));
  if (failed && p) alloc.release(alloc.ctx, p);
  PetscCheck(!failed, comm, PETSC_ERR_MEM, "out of memory");
  memset(p, 0, sizeof *p);
  p->alloc = alloc;
  p->scene = scene;
  PetscCallMPI(MPI_Comm_dup(comm, &p->comm));
  p->counts.struct_size = sizeof p->counts;
  PetscErrorCode error = create(p, p->comm, options);
  if (error) {
    (void)hr2dp_destroy(&p);
    PetscFunctionReturn(error);
  }
  *made = p;
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_destroy(hr2dp **given) {
  PetscFunctionBegin;
  hr2dp *p = *given;
  *given = NULL;
  if (!p) PetscFunctionReturn(0);
  const hr2d_allocator alloc = p->alloc;
  MPI_Comm comm = p->comm;
  const PetscErrorCode failed = hr2dpi_trees_clear(p);
  hr2dpi_share_clear(p);
  hr2dpi_units_clear(p);
  alloc.release(alloc.ctx, p);
  PetscCall(failed);
  PetscCallMPI(MPI_Comm_free(&comm));
  PetscFunctionReturn(0);
}

hr2d_status hr2dp_status(const hr2dp *p) {
  return p->status;
}

const char *hr2dp_message(const hr2dp *p) {
  return p->status ? p->message : "";
}

PetscErrorCode hr2dp_get_counts(const hr2dp *p, hr2dp_counts *counts) {
  PetscFunctionBegin;
  const size_t size = counts->struct_size;
  if (size < sizeof size) SETERRQ(PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ, "struct_size is not set");
  memcpy(counts, &p->counts, size < sizeof *counts ? size : sizeof *counts);
  counts->struct_size = size;
  PetscFunctionReturn(0);
}

static hr2d_status take_options(hr2dp *p, const hr2d_refine_options *given,
                                hr2d_refine_options *options) {
  const hr2d_refine_options defaults = HR2D_REFINE_OPTIONS_INIT;
  *options = defaults;
  if (given && given->struct_size < sizeof given->struct_size)
    return hr2dpi_fail(p, HR2D_EINVAL, "struct_size is not set");
  if (given)
    memcpy(options, given,
           given->struct_size < sizeof *options ? given->struct_size : sizeof *options);
  options->struct_size = sizeof *options;
  if (options->row_from || options->row_to || options->claim || options->row_counts ||
      options->rows)
    return hr2dpi_fail(p, HR2D_EINVAL, "rows and claims are chosen by hr2dp_refine() itself");
  if (options->brightness)
    return hr2dpi_fail(p, HR2D_EUNSUPPORTED, "brightness of a former solution");
  if (p->refined && p->oracle.flags & HR2D_ORACLE_NEEDS_BRIGHTNESS)
    return hr2dpi_fail(p, HR2D_EUNSUPPORTED,
                       "the oracle %s needs the brightness of a former "
                       "solution to refine further",
                       p->oracle.name);
  if (p->rank > 0) options->progress = NULL;
  return HR2D_OK;
}

/* After a failure ranks may have different links: all start again from none. */
static void start_again(hr2dp *p) {
  (void)hr2dpi_trees_clear(p);
  hr2dpi_share_clear(p);
  p->refined = p->units.placed = 0;
  p->counts = (hr2dp_counts){.struct_size = sizeof p->counts};
}

static PetscErrorCode refine(hr2dp *p, const hr2d_refine_options *options) {
  PetscFunctionBegin;
  PetscCall(hr2dpi_share_refine(p, options));
  PetscCall(hr2dpi_trees_unite(p));
  p->refined = 1;
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_refine(hr2dp *p, const hr2d_refine_options *given) {
  PetscFunctionBegin;
  hr2d_refine_options options;
  hr2dpi_begin(p);
  PetscCall(hr2dpi_agree(p, take_options(p, given, &options)));
  PetscErrorCode failed = hr2dpi_agree(p, p->links ? HR2D_OK : hr2dpi_share_init(p));
  if (!failed) failed = refine(p, &options);
  if (failed) start_again(p);
  PetscCall(failed);
  PetscFunctionReturn(0);
}
