/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls of the API fuzzer: exchange areas of a scene and around occluders, and studies. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api.h"

void api_matrix(api_run *r, api_slot *s) {
  const size_t n = hr2d_scene_patches(r->scene);
  double *area = malloc(n * n * sizeof *area);
  hr2d_matrix_counts counts;
  (void)s;
  if (!area) return;
  api_memory_runs_out(r);
  const hr2d_status status = hr2d_exchange_matrix(r->scene, NULL, area, &counts);
  if (!api_memory_is_back(r)) REQUIRE(status == HR2D_OK);
  fuzz_check_matrix(r->scene, status, area);
  free(area);
}

/* Two patches and some of the others in their way. */
void api_occluded(api_run *r, api_slot *s) {
  hr2d_segment other[8];
  const size_t n = hr2d_scene_patches(r->scene);
  const hr2d_segment i = hr2d_scene_segment(r->scene, fuzz_byte(r->in) % n);
  const hr2d_segment j = hr2d_scene_segment(r->scene, fuzz_byte(r->in) % n);
  const unsigned count = fuzz_below(r->in, 8);
  const hr2d_allocator hooks = fuzz_hooks(&r->memory);
  double one = 0, swapped = 0;
  (void)s;
  for (unsigned k = 0; k < count; k++)
    other[k] = hr2d_scene_segment(r->scene, fuzz_byte(r->in) % n);
  api_memory_runs_out(r);
  hr2d_status status = hr2d_exchange_area_occluded(&i, &j, other, count, &hooks, &one);
  if (api_memory_is_back(r) && status == HR2D_ENOMEM) return;
  REQUIRE(status == HR2D_OK || status == HR2D_ERANGE);
  REQUIRE(hr2d_exchange_area_occluded(&j, &i, other, count, &hooks, &swapped) == status);
  if (status) return;
  const double all = hr2d_exchange_area(&i, &j);
  REQUIRE(isfinite(one) && one >= 0 && fuzz_same_bits(one, swapped));
  REQUIRE(one <= all * (1 + 1e-12));
  if (!count) REQUIRE(fuzz_same_bits(one, all));
}

void api_study(api_run *r, api_slot *s) {
  const double epsilon[] = {1, 0.5, 0.25};
  hr2d_study_row rows[3];
  hr2d_study_fit fit;
  size_t done = 99;
  hr2d_refine_options options = api_refine_options(r, s);
  const uint64_t links = hr2d_linkset_size(s->links);
  options.brightness = NULL;
  api_memory_runs_out(r);
  const hr2d_status status = hr2d_study_run(s->links, &options, epsilon, 3, rows, &done);
  const int out = api_memory_is_back(r);
  REQUIRE(done <= 3 && (status != HR2D_OK || done == 3));
  REQUIRE(status != HR2D_ENOMEM || out);
  REQUIRE(hr2d_linkset_size(s->links) == links);
  if (links > 0) REQUIRE(status == HR2D_ESTATE);
  for (size_t k = 0; k < done; k++) REQUIRE(rows[k].epsilon == epsilon[k]);
  if (done < 3) return;
  const hr2d_status fitted = hr2d_study_fit_rows(rows, 3, &fit);
  REQUIRE(fitted == HR2D_OK || fitted == HR2D_EINVAL);
  if (!fitted) REQUIRE(isfinite(fit.a) && isfinite(fit.b) && isfinite(fit.c));
}

const api_call api_calls[] = {api_refine,  api_solve,  api_refine,   api_solve, api_read,
                              api_compare, api_matrix, api_occluded, api_study, api_misuse,
                              api_refine,  api_solve,  api_target};
const unsigned api_call_count = sizeof api_calls / sizeof *api_calls;
