/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls of the API fuzzer: solve, with and without a target, and read the solutions. */
#include <math.h>

#include "api.h"

static hr2d_solve_options solve_options(api_run *r, const api_slot *s) {
  hr2d_solve_options o = HR2D_SOLVE_OPTIONS_INIT;
  const unsigned b = fuzz_byte(r->in);
  o.closure = b & 1 ? HR2D_CLOSURE_ON : HR2D_CLOSURE_OFF;
  if (b & 2) o.tolerance = ldexp(1, -(int)fuzz_below(r->in, 50));
  o.max_iterations = b & 4 ? fuzz_byte(r->in) : 300;
  if (b & 8) o.start = s->solution;
  return o;
}

void api_solve(api_run *r, api_slot *s) {
  hr2d_solve_options options = solve_options(r, s);
  if (options.tolerance > 0 && options.tolerance < 1e-15) options.tolerance = 1e-15;
  const unsigned wanted = fuzz_byte(r->in);
  hr2d_hierarchy *hierarchy = api_hierarchy(r, s);
  /* Blocks of touching patches take panels without number where one is 2^500 times the other.
   */
  const unsigned order = wanted < 192 || !fuzz_is_even(r->scene) ? 1 : 1 + wanted % 5;
  REQUIRE(hr2d_hierarchy_set_order(hierarchy, order) == HR2D_OK);
  hr2d_solution *solution = NULL;
  api_memory_runs_out(r);
  const hr2d_status status = hr2d_solve(s->links, &options, &solution);
  const int out = api_memory_is_back(r);
  if (status) {
    REQUIRE(!solution);
    REQUIRE_SAYING((status == HR2D_ENOMEM && out) || status == HR2D_ENO_SOLUTION ||
                       status == HR2D_ENOT_CONVERGED || status == HR2D_ERANGE ||
                       (status == HR2D_ESTATE && hr2d_linkset_size(s->links) == 0),
                   hr2d_strerror(status));
    fuzz_check_message(hr2d_linkset_message(s->links));
    return;
  }
  if (options.tolerance <= 1e-12)
    fuzz_check_solution(solution, order, options.closure == HR2D_CLOSURE_ON);
  hr2d_solution_destroy(s->solution);
  s->solution = solution;
  s->order = order;
  s->closure = options.closure == HR2D_CLOSURE_ON;
}

void api_read(api_run *r, api_slot *s) {
  if (!s->solution) return;
  const size_t patch = fuzz_byte(r->in) % hr2d_scene_patches(r->scene);
  const size_t bands = hr2d_scene_bands(r->scene);
  double t[4], value[4 * 8];
  REQUIRE(bands <= 8);
  for (int k = 0; k < 4; k++) {
    t[k] = fuzz_unit(r->in);
    for (size_t b = 0; b < bands; b++) {
      const double at = hr2d_solution_at(s->solution, patch, t[k], b);
      const double h = hr2d_solution_irradiance_at(s->solution, patch, t[k], b);
      REQUIRE(isfinite(at) && isfinite(h));
    }
    const uint32_t leaf = hr2d_hierarchy_leaf(api_hierarchy(r, s), patch, t[k]);
    REQUIRE(hr2d_hierarchy_elements(api_hierarchy(r, s))[leaf].patch == patch);
    REQUIRE(!hr2d_hierarchy_elements(api_hierarchy(r, s))[leaf].child);
  }
  api_memory_runs_out(r);
  const hr2d_status status = hr2d_solution_gather(s->solution, patch, t, 4, value);
  if (api_memory_is_back(r) && status == HR2D_ENOMEM) return;
  REQUIRE(status == HR2D_OK);
  for (size_t k = 0; k < 4 * bands; k++) REQUIRE(isfinite(value[k]));
}

static hr2d_target small_target(api_run *r, size_t important[2]) {
  hr2d_target target = HR2D_TARGET_INIT;
  const unsigned b = fuzz_byte(r->in);
  target.error = ldexp(1, -(int)(b & 15) - 1);
  target.norm = b & 16 ? HR2D_NORM_SUP : HR2D_NORM_AVERAGE;
  target.points = b & 1;
  if (b & 32) {
    important[0] = important[1] = fuzz_byte(r->in) % hr2d_scene_patches(r->scene);
    if (important[0] & 1) important[1]--;
    target.important = important;
    target.important_count = 2;
  }
  target.max_elements = 300;
  target.max_links = b & 64 ? 1 + fuzz_byte(r->in) : 600;
  if (b & 128) target.max_bytes = 1u << (10 + fuzz_below(r->in, 12));
  target.seconds = 0.1;
  return target;
}

static void check_error(const hr2d_error *e) {
  REQUIRE(!isnan(e->estimate) && e->estimate >= 0);
  REQUIRE(!isnan(e->bound) && e->bound >= 0);
}

void api_target(api_run *r, api_slot *s) {
  size_t important[2];
  const hr2d_target target = small_target(r, important);
  hr2d_solution *solution = NULL;
  hr2d_account account;
  (void)s;
  if (!fuzz_is_even(r->scene)) return; /* the same */
  api_memory_runs_out(r);
  const hr2d_status status = hr2d_solve_to(r->scene, &target, &solution, &account);
  const int out = api_memory_is_back(r);
  REQUIRE_SAYING(status == HR2D_OK || status == HR2D_EACCURACY || status == HR2D_ENO_SOLUTION ||
                     status == HR2D_ENOT_CONVERGED || status == HR2D_ERANGE ||
                     (status == HR2D_ENOMEM && out),
                 hr2d_strerror(status));
  REQUIRE(solution ? !status || status == HR2D_EACCURACY : status != HR2D_OK);
  if (solution) {
    check_error(&account.average);
    if (target.points || target.norm == HR2D_NORM_SUP)
      check_error(&account.sup);
    else
      REQUIRE(isnan(account.sup.estimate) && isnan(account.irradiance_sup.bound));
    if (status == HR2D_OK) REQUIRE(!*account.reason);
    if (status == HR2D_EACCURACY) REQUIRE(*account.reason);
    for (size_t k = 0; k < hr2d_scene_patches(r->scene); k++)
      REQUIRE(isfinite(hr2d_solution_average(solution, k, 0)));
  }
  hr2d_solution_destroy(solution);
}
