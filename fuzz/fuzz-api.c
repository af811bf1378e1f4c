/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Takes bytes as a sequence of calls on a scene, on hierarchies and link sets, and on
   solutions, in any order that the headers allow and in some that they forbid.  Any
   allocation may fail. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api.h"

enum { MOST_CALLS = 16, MOST_PATCHES = 40, MOST_IMAGES = 400 };

/* Calls before commit and after that must be refused. */
static void check_order_before(hr2d_scene *scene) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_solution *solution = NULL;
  double area = 0;
  REQUIRE(hr2d_hierarchy_create(scene, &hierarchy) == HR2D_ESTATE && !hierarchy);
  REQUIRE(hr2d_exchange_matrix(scene, NULL, &area, NULL) == HR2D_ESTATE);
  REQUIRE(hr2d_solve_to(scene, NULL, &solution, NULL) == HR2D_ESTATE && !solution);
  REQUIRE(hr2d_scene_force(scene, HR2D_EFFECT_COUNT) == HR2D_EINVAL);
  REQUIRE(hr2d_scene_parse(scene, NULL, 1) == HR2D_EINVAL);
}

static void check_order_after(hr2d_scene *scene) {
  const hr2d_patch patch = {.b = {1, 1}};
  const size_t patches = hr2d_scene_patches(scene);
  REQUIRE(hr2d_scene_add(scene, &patch, NULL) == HR2D_ESTATE);
  REQUIRE(hr2d_scene_parse(scene, "{}", 2) == HR2D_ESTATE);
  REQUIRE(hr2d_scene_set_background(scene, NULL, 0) == HR2D_ESTATE);
  REQUIRE(hr2d_scene_force(scene, HR2D_EFFECT_OCCLUSION) == HR2D_ESTATE);
  REQUIRE(hr2d_scene_split_crossings(scene, NULL) == HR2D_ESTATE);
  REQUIRE(hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 0}, {1, 1}}) == HR2D_ESTATE);
  REQUIRE(hr2d_scene_set_period(scene, (hr2d_point){1, 1}) == HR2D_ESTATE);
  REQUIRE(hr2d_scene_commit(scene) == HR2D_ESTATE);
  REQUIRE(hr2d_scene_patches(scene) == patches);
  fuzz_check_message(hr2d_scene_message(scene));
}

static hr2d_status commit(api_run *r) {
  hr2d_status status = hr2d_scene_commit(r->scene);
  if (status == HR2D_ESCENE || status == HR2D_EINVAL || status == HR2D_EUNSUPPORTED) {
    fuzz_check_message(hr2d_scene_message(r->scene));
    check_order_before(r->scene);
    status = hr2d_scene_split_crossings(r->scene, NULL);
    if (!status) status = hr2d_scene_commit(r->scene);
  }
  return status;
}

/* Memory returns when it has been out once, and the call is tried again. */
static int make_scene(api_run *r) {
  const hr2d_allocator hooks = fuzz_hooks(&r->memory);
  api_memory_runs_out(r);
  while (hr2d_scene_create(&hooks, &r->scene) == HR2D_ENOMEM) api_memory_is_back(r);
  fuzz_fill_scene(r->in, r->scene, MOST_PATCHES);
  api_memory_is_back(r);
  check_order_before(r->scene);
  const unsigned forced = fuzz_byte(r->in);
  if (forced & 1)
    for (unsigned e = 0; e < HR2D_EFFECT_COUNT; e++)
      if (forced & (2u << e % 7)) hr2d_scene_force(r->scene, (hr2d_effect)e);
  api_memory_runs_out(r);
  hr2d_status status = commit(r);
  if (api_memory_is_back(r) && status == HR2D_ENOMEM) status = commit(r);
  if (!status) {
    check_order_after(r->scene);
    return 1;
  }
  REQUIRE(status == HR2D_ESCENE || status == HR2D_ERANGE || status == HR2D_EUNSUPPORTED);
  fuzz_check_message(hr2d_scene_message(r->scene));
  return 0;
}

static void make_links(api_run *r, unsigned slot) {
  static const char *const oracles[] = {"size", "size2", "bf", "l1", "l1-grid", "bounds"};
  api_slot *s = &r->slot[slot];
  hr2d_hierarchy **hierarchy = &r->hierarchy[slot / 2];
  const unsigned o = fuzz_below(r->in, 8), p = fuzz_below(r->in, 4);
  if (!*hierarchy) REQUIRE(hr2d_hierarchy_create(r->scene, hierarchy) == HR2D_OK);
  s->callbacks = (fuzz_callbacks){fuzz_byte(r->in), fuzz_below(r->in, 4) == 0, 0};
  s->oracle = o < 6   ? hr2d_oracle_find(oracles[o])
              : o < 7 ? &fuzz_oracle_symmetric
                      : &fuzz_oracle_directed;
  s->policy = p == 0   ? hr2d_policy_original()
              : p == 1 ? hr2d_policy_modified()
              : p == 2 ? &fuzz_policy_free
                       : NULL;
  s->owners = (o >= 6) + (p == 2);
  s->ordered = fuzz_below(r->in, 4) == 0;
  const hr2d_status status =
      hr2d_linkset_create(*hierarchy, s->oracle, o >= 6 ? &s->callbacks : NULL, s->policy,
                          p == 2 ? &s->callbacks : NULL, &s->links);
  REQUIRE(status == HR2D_OK && s->links);
  REQUIRE(hr2d_linkset_size(s->links) == 0 && !*hr2d_linkset_message(s->links));
}

static void end(api_run *r) {
  for (int k = 0; k < API_SLOTS; k++) {
    api_slot *s = &r->slot[k];
    hr2d_solution_destroy(s->solution);
    s->solution = NULL;
  }
  for (int k = 0; k < API_SLOTS; k++) {
    hr2d_linkset_destroy(r->slot[k].links);
    REQUIRE(r->slot[k].callbacks.destroyed == r->slot[k].owners);
  }
  for (int k = 0; k < API_SLOTS / 2; k++) hr2d_hierarchy_destroy(r->hierarchy[k]);
  hr2d_scene_destroy(r->scene);
  REQUIRE(r->memory.live == 0);
  REQUIRE(r->memory.bytes == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_input in = {data, data + size};
  api_run run = {.in = &in, .memory = FUZZ_MEMORY_INIT};
  const int made = make_scene(&run);
  if (made) api_bytes(&run);
  if (made && hr2d_scene_images(run.scene) * hr2d_scene_patches(run.scene) <= MOST_IMAGES)
    for (int k = 0; k < MOST_CALLS && in.at < in.end; k++) {
      const unsigned call = fuzz_byte(&in), slot = fuzz_below(&in, API_SLOTS);
      if (!run.slot[slot].links) make_links(&run, slot);
      api_calls[call % api_call_count](&run, &run.slot[slot]);
    }
  end(&run);
  return 0;
}
