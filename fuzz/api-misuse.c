/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls of the API fuzzer with wrong arguments: numbers, sizes of structs, tables of functions
   with gaps, and shares that are none.  What the later ones are follows from the bytes to come,
   and takes none of them. */
#include <math.h>
#include <string.h>

#include "api.h"

static hr2d_status never(void *ctx, const hr2d_link *links, size_t count) {
  (void)ctx, (void)links, (void)count;
  return HR2D_OK;
}

static void misuse_numbers(api_run *r, api_slot *s) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2d_refine_counts counts;
  hr2d_solve_options how = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *solution = NULL;
  const uint64_t links = hr2d_linkset_size(s->links);
  options.epsilon = fuzz_below(r->in, 2) ? NAN : -1;
  REQUIRE(hr2d_refine(s->links, &options) == HR2D_EINVAL);
  REQUIRE(hr2d_refine_count(s->links, &options, &counts) != HR2D_OK);
  options.epsilon = 1;
  if (links > 0) {
    REQUIRE(hr2d_refine_count(s->links, &options, &counts) == HR2D_ESTATE);
    REQUIRE(hr2d_refine_visit(s->links, &options, never, NULL, &counts) == HR2D_ESTATE);
    fuzz_check_message(hr2d_linkset_message(s->links));
  }
  REQUIRE(hr2d_hierarchy_set_order(api_hierarchy(r, s), 0) == HR2D_EINVAL);
  REQUIRE(hr2d_hierarchy_set_order(api_hierarchy(r, s), HR2D_MAX_ORDER + 1) == HR2D_EINVAL);
  how.tolerance = fuzz_below(r->in, 2) ? NAN : -1;
  const hr2d_status status = hr2d_solve(s->links, &how, &solution);
  REQUIRE((status == HR2D_EINVAL || status == HR2D_ESTATE) && !solution);
}

/* Nothing behind the size that a struct says it has is read, and no size below its own. */
static void misuse_sizes(api_run *r, api_slot *s, uint64_t hash) {
  const size_t size = hash % sizeof(size_t);
  hr2d_solution *solution = NULL;
  double area[1];
  REQUIRE(hr2d_refine(s->links, &(hr2d_refine_options){.struct_size = size}) == HR2D_EINVAL);
  REQUIRE(hr2d_solve(s->links, &(hr2d_solve_options){.struct_size = size}, &solution) ==
          HR2D_EINVAL);
  REQUIRE(hr2d_solve_to(r->scene, &(hr2d_target){.struct_size = size}, &solution, NULL) ==
          HR2D_EINVAL);
  REQUIRE(hr2d_exchange_matrix(r->scene, &(hr2d_matrix_options){.struct_size = size}, area,
                               NULL) == HR2D_EINVAL);
  REQUIRE(hr2d_scene_lint(r->scene, NULL, NULL, &(hr2d_lint_options){.struct_size = size}) ==
          HR2D_EINVAL);
  REQUIRE(!solution);
}

/* A context of a table that is refused stays that of the caller. */
static void misuse_tables(api_run *r, api_slot *s, uint64_t hash) {
  hr2d_hierarchy *h = api_hierarchy(r, s);
  fuzz_callbacks callbacks = {0};
  hr2d_linkset *links = NULL;
  hr2d_oracle oracle = fuzz_oracle_symmetric;
  hr2d_policy policy = fuzz_policy_free;
  if (hash & 1) oracle.struct_size = hash >> 8 & 7;
  if (hash & 2) oracle.name = NULL;
  if (hash & 4) oracle.estimate = NULL;
  if (hash & 8) policy.struct_size = hash >> 11 & 7;
  if (hash & 16 || !(hash & 31)) policy.name = NULL;
  REQUIRE(hr2d_linkset_create(h, &oracle, &callbacks, &policy, &callbacks, &links) ==
          HR2D_EINVAL);
  REQUIRE(!links && callbacks.destroyed == 0);
}

static hr2d_status combine(void *ctx, hr2d_status status, hr2d_combine how, double *value,
                           size_t count) {
  (void)ctx, (void)how, (void)value, (void)count;
  return status;
}

static void misuse_share(api_run *r, api_slot *s, uint64_t hash) {
  const unsigned count = (unsigned)(hash >> 8 & 3), above = (unsigned)(hash >> 10 & 1023);
  hr2d_share share = {
      .struct_size = sizeof share, .number = count + above, .count = count, .combine = combine};
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  refine.share = target.share = &share;
  if (hash & 1) share.number = (unsigned)-1;
  if (hash & 2) share.combine = NULL;
  if (hash & 4) share.struct_size = hash >> 20 & 7;
  if (hash & 8) share.count = 0;
  REQUIRE(hr2d_refine(s->links, &refine) == HR2D_EINVAL);
  REQUIRE(hr2d_solve_to(r->scene, &target, &solution, NULL) == HR2D_EINVAL && !solution);
  REQUIRE(share.failed == HR2D_OK);
}

void api_misuse(api_run *r, api_slot *s) {
  const uint64_t links = hr2d_linkset_size(s->links);
  misuse_numbers(r, s);
  const uint64_t hash = fuzz_hash_bytes(r->in->at, (size_t)(r->in->end - r->in->at));
  misuse_sizes(r, s, hash);
  misuse_tables(r, s, hash);
  misuse_share(r, s, hash);
  REQUIRE(hr2d_linkset_size(s->links) == links);
}
