/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/block-stage.h"

#include <check.h>
#include <stdlib.h>

#include "blocks/block.h"

static void add_patch(hr2d_scene *scene, hr2d_segment s, const char *name) {
  const double half = 0.5;
  const hr2d_patch patch = {.a = s.a,
                            .b = s.b,
                            .name = name,
                            .emission = &half,
                            .emission_bands = 1,
                            .reflectance = &half,
                            .reflectance_bands = 1};
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
}

void block_stage_end(block_stage *s) {
  hr2d_hierarchy_destroy(s->hierarchy);
  hr2d_scene_destroy(s->scene);
  free(s->occluder);
}

int block_stage_set(block_stage *s, const occluded_pair *p) {
  *s = (block_stage){0};
  ck_assert_int_eq(hr2d_scene_create(NULL, &s->scene), HR2D_OK);
  add_patch(s->scene, p->i, "i");
  add_patch(s->scene, p->j, "j");
  for (size_t k = 0; k < p->count; k++) add_patch(s->scene, p->occluder[k], "w");
  if (hr2d_scene_split_crossings(s->scene, NULL) || hr2d_scene_commit(s->scene) ||
      hr2d_hierarchy_create(s->scene, &s->hierarchy)) {
    block_stage_end(s);
    return 0;
  }
  const size_t patches = hr2d_scene_patches(s->scene);
  s->occluder = malloc(patches * sizeof *s->occluder);
  while (*hr2d_scene_name(s->scene, s->pair.second) != 'j') s->pair.second++;
  for (size_t k = 0; k < patches; k++)
    if (k != s->pair.first && k != s->pair.second)
      s->occluder[s->count++] = hr2d_scene_segment(s->scene, k);
  s->i = hr2d_scene_segment(s->scene, s->pair.first);
  s->j = hr2d_scene_segment(s->scene, s->pair.second);
  return 1;
}

static int make(const block_stage *s, size_t order, int swapped, int fewer, double *block) {
  hr2di_integrator work;
  int distant;
  const hr2d_allocator *alloc = &s->hierarchy->alloc;
  const hr2d_pair swap = {s->pair.second, s->pair.first};
  ck_assert_int_eq(hr2di_integrator_init(&work, s->hierarchy, alloc, order, NULL, NULL),
                   HR2D_OK);
  if (fewer) ck_assert_int_eq(hr2di_integrator_points(&work, order + 2, 1), HR2D_OK);
  ck_assert_int_eq(hr2di_block(&work, swapped ? swap : s->pair, 0, block, &distant), HR2D_OK);
  for (size_t k = 0; k < order * order; k++) block[k] *= hr2d_scene_unit(s->scene);
  hr2di_integrator_clear(&work);
  return distant;
}

void block_stage_lines(const block_stage *s, size_t order, double *block) {
  hr2di_integrator work;
  hr2di_line_frame frame;
  hr2di_vertex end[4];
  for (size_t k = 0; k < order * order; k++) block[k] = 0;
  ck_assert_int_eq(
      hr2di_integrator_init(&work, s->hierarchy, &s->hierarchy->alloc, order, NULL, NULL),
      HR2D_OK);
  hr2di_line_frame_init(&frame, s->hierarchy, s->pair);
  if (hr2di_line_ends(&frame, end, end + 2))
    ck_assert_int_eq(hr2di_block_of_vertices(&work, &frame, end, 2, 2, block), HR2D_OK);
  hr2di_moments_end(&work.moments, block);
  for (size_t k = 0; k < order * order; k++) block[k] *= hr2d_scene_unit(s->scene);
  hr2di_integrator_clear(&work);
}

int block_stage_make(const block_stage *s, size_t order, int swapped, double *block) {
  return make(s, order, swapped, 0, block);
}

int block_stage_make_fewer(const block_stage *s, size_t order, double *block) {
  return make(s, order, 0, 1, block);
}
