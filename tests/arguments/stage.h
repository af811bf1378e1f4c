/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Good arguments for any public function. */
#ifndef HR2D_TESTS_ARGUMENTS_STAGE_H
#define HR2D_TESTS_ARGUMENTS_STAGE_H

#include <hr2d/hr2d.h>

#include "support/tape.h"

enum { STAGE_NUMBERS = 4096, STAGE_CUTS = 2 };

typedef struct stage {
  hr2d_scene *scene;    /* committed: a room of two bands and a wall in it */
  hr2d_scene *drawn;    /* that, not committed */
  hr2d_scene *empty;    /* without patches */
  hr2d_scene *mirrored; /* committed, with a mirror */
  hr2d_scene *pair;     /* committed: two patches that do not touch */
  hr2d_hierarchy *pair_hierarchy;
  hr2d_linkset *pair_links;
  hr2d_hierarchy *hierarchy, *free_hierarchy; /* refined, or not */
  hr2d_linkset *links, *free_links;
  hr2d_solution *solution;
  hr2d_solution *other; /* of another hierarchy */
  hr2d_hierarchy *other_hierarchy;
  hr2d_linkset *other_links;
  hr2d_clusters *clusters;
  hr2d_exchange_rows *rows;
  hr2d_enclosure *enclosure;
  hr2d_operator *op;
  hr2d_solution *op_solution;
  hr2d_scene *made_scene; /* what calls make */
  hr2d_hierarchy *made_hierarchy;
  hr2d_linkset *made_links;
  hr2d_solution *made_solution;
  hr2d_clusters *made_clusters;
  hr2d_exchange_rows *made_rows;
  hr2d_enclosure *made_enclosure;
  hr2d_operator *made_op;
  double number[STAGE_NUMBERS], half[STAGE_NUMBERS], field[STAGE_NUMBERS], part[4][2];
  uint32_t index[STAGE_NUMBERS];
  unsigned char byte[STAGE_NUMBERS];
  size_t size;
  hr2d_link link[8];
  hr2d_point point[2];
  hr2d_segment segment[3];
  hr2d_sun sun;
  hr2d_sky_piece piece;
  hr2d_study_row row[4];
  hr2d_row_counts row_counts[STAGE_NUMBERS];
  const char *text, *file;
  const char *path;
  char broken[128]; /* a name of continuation bytes */
  hr2d_allocator no_hooks;
  void *cut[STAGE_CUTS];
  int cuts;
  tape state, scene_state;
  hr2d_allocator good_allocator;
  hr2d_oracle good_oracle;
  hr2d_policy good_policy;
  hr2d_patch good_patch;
  hr2d_thermal good_thermal;
  hr2d_sky good_sky;
  hr2d_gas good_gas;
  hr2d_share good_share;
  hr2d_target good_target;
  hr2d_light good_light;
  hr2d_values good_values;
  hr2d_gradient good_gradient;
  hr2d_account good_account;
  hr2d_prediction good_prediction;
  hr2d_enclose_options good_enclose_options;
  hr2d_enclosure_account good_enclosure_account;
  hr2d_error good_error;
  hr2d_refine_options good_refine_options;
  hr2d_solve_options good_solve_options;
  hr2d_matrix_options good_matrix_options;
  hr2d_clusters_options good_clusters_options;
  hr2d_field_options good_field_options;
  hr2d_lint_options good_lint_options;
  hr2d_past_options good_past_options;
  hr2d_field_values good_field_values;
  hr2d_field_grid good_field_grid;
  hr2d_temperatures good_temperatures;
  hr2d_refine_counts good_refine_counts;
  hr2d_matrix_counts good_matrix_counts;
  hr2d_field_counts good_field_counts;
  hr2d_snap_report good_snap_report;
  hr2d_study_fit good_study_fit;
  hr2d_study_constants good_study_constants;
} stage;

stage *stage_make(void);
void stage_end(stage *s);

/* After a call that changed no object of the stage: what it made is gone, and all arguments are
   good again.  Objects take much longer to make than most calls. */
void stage_renew(stage *s);

/* The first bytes of a struct with `struct_size`, which says so, in a block of so many bytes,
   and no less than that member has. */
void *cut(stage *s, const void *whole, size_t size);

/* Callbacks that do nothing, and those that read a state and a scene of the stage `ctx`. */
hr2d_status on_near_pairs_fn(void *ctx, const hr2d_pair *pairs, size_t count);
hr2d_status on_field_row_fn(void *ctx, const hr2d_field_row *row);
hr2d_status on_warning_fn(void *ctx, const hr2d_warning *warning);
hr2d_status on_visitor(void *ctx, const hr2d_link *links, size_t count);
hr2d_status on_write_fn(void *ctx, const void *bytes, size_t size);
hr2d_status on_exchange_row_fn(void *ctx, const hr2d_exchange_row *row);
hr2d_status on_beam_fn(void *ctx, const hr2d_beam *beam);
hr2d_status on_progress_fn(void *ctx, const hr2d_progress *progress);
hr2d_status read_state(void *ctx, void *bytes, size_t size);
hr2d_status read_scene(void *ctx, void *bytes, size_t size);

#endif
