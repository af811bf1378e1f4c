/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Links as large as the kernel is smooth, on elements as large as radiosity is smooth. */
#include "mesh/admissibility.h"

#include <math.h>

#include "base/bickley.h"
#include "geometry/bernstein-ellipse.h"
#include "geometry/predicates.h"
#include "hierarchy/hierarchy-impl.h"
#include "oracle/built-in.h"
#include "scene/regions.h"

/* On an element with children radiosity is not smooth: of the product of its rough part and the
   kernel's, which a link drops, only the kernel's is small, and so it must be smaller: at 6 the
   links' part of the error is below that of the elements, for some percent more of them. */
#define ROUGH 6.0

/* Through gas e^−κr changes on an element with children by this exponent at most: then it is as
   smooth as on the ellipse ROUGH.  Elements as far from each other as HR2DI_GAS_DARK exchange
   nothing. */
#define ROUGH_DEPTH 0.5

static double depth_between(const hr2d_element *i, const hr2d_element *j, double absorption) {
  const double centres = hypot(i->centre.x - j->centre.x, i->centre.y - j->centre.y);
  return absorption * (centres - 0.5 * (i->length + j->length));
}

/* Whether a border of gas is between elements, behind which T has kinks. */
static int is_parted(const hr2d_element *i, const hr2d_element *j, const hr2d_scene *scene) {
  const hr2di_regions *r = hr2di_scene_regions(scene);
  const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
  return r && (i->child || j->child) && hr2di_regions_part(r, s, t);
}

/* Whether gas lets elements be linked. */
static int is_clear(const hr2d_element *i, const hr2d_element *j, hr2di_gas_range absorption) {
  const double rough =
      fmax(i->child ? i->length : 0, j->child ? j->length : 0) * absorption.most;
  return rough <= ROUGH_DEPTH || depth_between(i, j, absorption.least) > HR2DI_GAS_DARK;
}

/* The ellipse that an element needs. */
static double distance_for(const hr2d_element *e) {
  return e->child ? ROUGH : HR2DI_ELLIPSE_DISTANT;
}

static int is_separate(const hr2d_element *i, const hr2d_element *j, int partial) {
  const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
  return !partial && hr2di_ellipse_min(s, t) >= distance_for(i) &&
         hr2di_ellipse_min(t, s) >= distance_for(j) &&
         hr2di_facing_of(&s, &t) == HR2DI_FACING_FULL;
}

static hr2d_status estimate(void *ctx, const hr2d_batch *batch, double *error) {
  const hr2d_scene *scene = ctx ? ((const hr2d_hierarchy *)ctx)->scene : NULL;
  const int has_gas = scene && hr2di_scene_has_gas(scene);
  const hr2di_gas_range none = {0, 0},
                        absorption = has_gas ? hr2di_scene_scaled_range(scene) : none;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_pair pair = batch->pairs[k];
    const hr2d_element *i = &batch->elements[pair.first], *j = &batch->elements[pair.second];
    const int partial = batch->partial && batch->partial[k];
    error[k] = !is_separate(i, j, partial) ||
               (has_gas && (!is_clear(i, j, absorption) || is_parted(i, j, scene)));
  }
  return HR2D_OK;
}

static const hr2d_oracle separation = {HR2DI_BUILT_IN("separation", HR2D_ORACLE_SYMMETRIC),
                                       .estimate = estimate};

const hr2d_oracle *hr2di_admissibility_oracle(void) {
  return &separation;
}

static hr2d_status both_leaves(void *ctx, const hr2d_batch *batch, unsigned char *limited) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++)
    limited[k] = !batch->elements[batch->pairs[k].first].child &&
                 !batch->elements[batch->pairs[k].second].child;
  return HR2D_OK;
}

/* Splits the longer one of the elements that have children. */
static hr2d_status split_parent(void *ctx, const hr2d_batch *batch, unsigned char *split) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_element *i = &batch->elements[batch->pairs[k].first];
    const hr2d_element *j = &batch->elements[batch->pairs[k].second];
    const int second = !i->child || (j->child && j->length > i->length);
    split[k] = second ? HR2D_SPLIT_SECOND : HR2D_SPLIT_FIRST;
  }
  return HR2D_OK;
}

static const hr2d_policy graded = {
    .struct_size = sizeof(hr2d_policy),
    .name = "graded",
    .flags = HR2D_POLICY_THREAD_SAFE,
    .recursion_limit = both_leaves,
    .preferred_subdivision = split_parent,
};

const hr2d_policy *hr2di_admissibility_fixed_leaves(void) {
  return &graded;
}
