/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene of a run as bytes: what is read back is written with the same bytes, and damage is
   found. */
#include <stdlib.h>
#include <string.h>

#include "api.h"

static void check_same(const fuzz_stream *one, const hr2d_scene *scene) {
  fuzz_stream again = {0};
  REQUIRE(hr2d_state_write_scene(scene, fuzz_record, &again) == HR2D_OK);
  REQUIRE(again.size == one->size && memcmp(again.byte, one->byte, one->size) == 0);
  free(again.byte);
}

/* Into an empty scene, which is one after a failure. */
static hr2d_status read_back(api_run *r, fuzz_stream *b) {
  const hr2d_allocator hooks = fuzz_hooks(&r->memory);
  hr2d_scene *scene = NULL;
  b->at = 0;
  if (hr2d_scene_create(&hooks, &scene)) return HR2D_ENOMEM;
  const hr2d_status status = hr2d_state_read_scene(scene, fuzz_play, b);
  if (status) {
    REQUIRE(hr2d_scene_patches(scene) == 0 && hr2d_scene_mirrors(scene) == 0);
    fuzz_check_message(hr2d_scene_message(scene));
  } else {
    check_same(b, scene);
  }
  hr2d_scene_destroy(scene);
  return status;
}

void api_bytes(api_run *r) {
  fuzz_stream b = {0};
  REQUIRE(hr2d_state_write_scene(r->scene, fuzz_record, &b) == HR2D_OK);
  const uint64_t hash = fuzz_hash_bytes(b.byte, b.size);
  r->failures = r->memory.failures;
  if (hash % 4 == 0) r->memory.until_failure = (long)(hash >> 8 & 63);
  const hr2d_status status = read_back(r, &b);
  REQUIRE(status == (api_memory_is_back(r) ? HR2D_ENOMEM : HR2D_OK));
  b.byte[(hash >> 16) % b.size] ^= (uint8_t)(1u << (hash >> 8 & 7));
  REQUIRE(read_back(r, &b) != HR2D_OK);
  free(b.byte);
}
