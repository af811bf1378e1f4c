/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fault-calls.h"

hr2d_status fault_mix_stage(const fault_stage *s, uint64_t *sum, hr2d_status status) {
  if (!status) *sum = fault_mix_count(*sum, fault_stage_sum(s));
  return status;
}

hr2d_status fault_count(fault_stage *s, uint64_t *sum, const hr2d_refine_options *options) {
  hr2d_refine_counts counts;
  const hr2d_status status = hr2d_refine_count(s->links, options, &counts);
  if (!status) *sum = fault_mix_count(*sum, fault_counts_sum(&counts));
  return fault_mix_stage(s, sum, status);
}

hr2d_status fault_study(fault_stage *s, uint64_t *sum, const hr2d_refine_options *options,
                        const double *epsilon, size_t count) {
  hr2d_study_row row[8];
  size_t done = 99;
  ck_assert_uint_le(count, sizeof row / sizeof *row);
  const hr2d_status status = hr2d_study_run(s->links, options, epsilon, count, row, &done);
  ck_assert(status ? done < count : done == count);
  for (size_t k = 0; !status && k < count; k++)
    *sum = fault_mix_count(*sum, fault_counts_sum(&row[k].counts));
  return fault_mix_stage(s, sum, status);
}

hr2d_status fault_solve(fault_stage *s, uint64_t *sum, const hr2d_solve_options *options) {
  hr2d_solution_destroy(s->result);
  s->result = NULL;
  const hr2d_status status = hr2d_solve(s->links, options, &s->result);
  if (!status) *sum = fault_mix_count(*sum, fault_solution_sum(s->result));
  return status;
}

hr2d_status fault_matrix(fault_stage *s, uint64_t *sum, const hr2d_matrix_options *options) {
  double area[64];
  const size_t n = hr2d_scene_patches(s->scene);
  ck_assert_uint_le(n * n, sizeof area / sizeof *area);
  const hr2d_status status = hr2d_exchange_matrix(s->scene, options, area, NULL);
  if (!status) *sum = fault_mix(*sum, area, n * n * sizeof *area);
  return status;
}
