/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "refine/trace-row.h"

#include "geometry/predicates.h"
#include "refine/occluded-pairs.h"
#include "scene/scene-impl.h"

/* Whether a pair of patches is tested for visibility. */
static hr2d_status ask_tested(hr2di_projector *p, size_t row, size_t other, size_t *tested) {
  const hr2d_scene *scene = p->hierarchy->scene;
  const hr2d_element *i = &p->hierarchy->element[row], *j = &p->hierarchy->element[other];
  hr2d_pair pair = {(uint32_t)row, (uint32_t)other};
  *tested = hr2di_symmetry_weight(&scene->symmetry, row, other, p->directed) != 0 &&
            hr2di_scene_lit(scene, row) && hr2di_scene_lit(scene, other) &&
            hr2di_facing_of(&(hr2d_segment){i->a, i->b}, &(hr2d_segment){j->a, j->b}) !=
                HR2DI_FACING_NONE;
  const hr2d_status status = hr2di_projector_fail(p, hr2di_projector_work(p, 1), "");
  return status ? status : hr2di_projector_claim(p, &pair, tested);
}

static hr2d_status search_for(hr2di_projector *p, size_t row, size_t other) {
  size_t tested;
  const hr2d_status status = ask_tested(p, row, other, &tested);
  return status || !tested ? status : hr2di_occluded_trace(p, (uint32_t)row, (uint32_t)other);
}

hr2d_status hr2di_trace_row(hr2di_projector *p, size_t row) {
  const hr2di_row_pieces *pieces = p->how.pieces;
  const hr2di_roots *known = &p->links->roots;
  if (!p->visibility || hr2di_row_slots(pieces, row) == 1) return HR2D_OK;
  const int counts = hr2di_slot_counts(pieces, pieces->slot[row]);
  const size_t from = known->row ? known->row[row] : p->directed ? 0 : row + 1;
  const size_t to = known->row ? known->row[row + 1] : p->hierarchy->scene->patches;
  const uint64_t before = hr2di_pair_visibility_tests(p->visibility);
  hr2d_status status = HR2D_OK;
  for (size_t k = from; k < to && !status && p->visibility->looked != row + 1; k++) {
    const size_t other = known->row ? known->pair[k].second : k;
    if (other == row || (!counts && !pieces->own[hr2di_row_slot(pieces, row, other)])) continue;
    status = search_for(p, row, other);
  }
  const uint64_t tests = hr2di_pair_visibility_tests(p->visibility) - before;
  if (counts && p->rows) p->rows[hr2di_row_trace_slot(pieces, row)].visibility_tests += tests;
  if (!counts) p->part.others += tests;
  return status;
}
