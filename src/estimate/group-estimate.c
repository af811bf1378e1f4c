/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "estimate/group-estimate.h"

#include <math.h>

#include "base/alloc.h"
#include "solution/band-solution.h"

static void take_larger(hr2d_error *to, hr2d_error of) {
  to->estimate = fmax(to->estimate, of.estimate);
  to->bound = fmax(to->bound, of.bound);
}

static void take_errors(hr2di_error_pair *to, const hr2di_error_pair *of) {
  take_larger(&to->average, of->average);
  take_larger(&to->sup, of->sup);
  take_larger(&to->irradiance, of->irradiance);
  take_larger(&to->irradiance_sup, of->irradiance_sup);
  if (of->cut_off[0] > to->cut_off[0]) {
    to->cut_off_patch = of->cut_off_patch;
    to->cut_off_part = of->cut_off_part;
  }
  for (int k = 0; k < 2; k++) {
    to->cut_off[k] = fmax(to->cut_off[k], of->cut_off[k]);
    to->rounding[k] = fmax(to->rounding[k], of->rounding[k]);
  }
}

/* Takes over what a group asks to be divided. */
static void take_depth(hr2di_graded *answer, unsigned char *depth) {
  if (!answer->depth) {
    answer->depth = depth;
    return;
  }
  for (size_t k = 0; k < answer->hierarchy->elements && depth; k++)
    if (depth[k] > answer->depth[k]) answer->depth[k] = depth[k];
  hr2di_alloc_free(&answer->hierarchy->alloc, depth);
}

/* The jumps of the bands of a group. */
static hr2d_status take_jumps(hr2di_graded *part, const hr2di_graded *answer, size_t group) {
  const hr2d_scene *scene = answer->hierarchy->scene;
  const size_t elements = answer->hierarchy->elements;
  part->jump_bands = hr2di_band_group_size(scene, group);
  part->unresolved_jump = NULL;
  if (!answer->unresolved_jump) return HR2D_OK;
  part->unresolved_jump = hr2di_alloc(&answer->hierarchy->alloc, elements,
                                      part->jump_bands * sizeof *part->unresolved_jump);
  if (!part->unresolved_jump) return HR2D_ENOMEM;
  hr2di_band_field_take(scene, group, elements, answer->unresolved_jump, part->unresolved_jump);
  return HR2D_OK;
}

static hr2d_status estimate(hr2di_graded *answer, size_t group,
                            const hr2di_resolution *fineness, const hr2d_target *target,
                            hr2di_error_pair *errors, hr2di_message *message) {
  hr2di_linkset_part set;
  hr2di_graded part = *answer;
  hr2di_linkset_part_begin(&set, answer->links, group);
  part.hierarchy = &set.hierarchy;
  part.links = &set.links;
  part.solution = NULL;
  part.depth = NULL;
  part.unbounded = 0;
  hr2d_status status = take_jumps(&part, answer, group);
  if (!status)
    status = hr2di_band_solution_take(answer->solution, &set.links, group, &part.solution);
  if (status == HR2D_ENOMEM) hr2di_message_fail(message, status, "%s", hr2d_strerror(status));
  if (!status) status = hr2di_error_estimate(&part, fineness, target, errors, message);
  hr2d_solution_destroy(part.solution);
  hr2di_alloc_free(&answer->hierarchy->alloc, part.unresolved_jump);
  hr2di_linkset_part_end(&set);
  answer->unbounded |= part.unbounded;
  take_depth(answer, part.depth);
  return status;
}

hr2d_status hr2di_group_estimates(hr2di_graded *answer, const hr2di_resolution *fineness,
                                  const hr2d_target *target, hr2di_error_pair *errors,
                                  hr2di_message *message) {
  hr2d_status status = HR2D_OK;
  if (answer->links->groups == 1)
    return hr2di_error_estimate(answer, fineness, target, errors, message);
  *errors = (hr2di_error_pair){0};
  answer->unbounded = 0;
  for (size_t g = 0; g < answer->links->groups && !status; g++) {
    hr2di_error_pair of_group;
    status = estimate(answer, g, fineness, target, &of_group, message);
    if (!status) take_errors(errors, &of_group);
  }
  return status;
}
