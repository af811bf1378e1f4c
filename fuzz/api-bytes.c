/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene of a run as bytes: what is read back is written with the same bytes, and damage is
   found. */
#include <stdlib.h>
#include <string.h>

#include "api.h"

typedef struct bytes {
  uint8_t *byte;
  size_t size, room, at;
} bytes;

static hr2d_status record(void *ctx, const void *data, size_t size) {
  bytes *b = ctx;
  if (b->size + size > b->room) {
    const size_t room = 2 * (b->size + size);
    uint8_t *grown = realloc(b->byte, room);
    if (!grown) return HR2D_EIO;
    b->byte = grown;
    b->room = room;
  }
  memcpy(b->byte + b->size, data, size);
  b->size += size;
  return HR2D_OK;
}

static hr2d_status play(void *ctx, void *data, size_t size) {
  bytes *b = ctx;
  if (size > b->size - b->at) return HR2D_ESYNTAX;
  memcpy(data, b->byte + b->at, size);
  b->at += size;
  return HR2D_OK;
}

static void check_same(const bytes *one, const hr2d_scene *scene) {
  bytes again = {0};
  REQUIRE(hr2d_state_write_scene(scene, record, &again) == HR2D_OK);
  REQUIRE(again.size == one->size && memcmp(again.byte, one->byte, one->size) == 0);
  free(again.byte);
}

/* Into an empty scene, which is one after a failure. */
static hr2d_status read_back(api_run *r, bytes *b) {
  const hr2d_allocator hooks = fuzz_hooks(&r->memory);
  hr2d_scene *scene = NULL;
  b->at = 0;
  if (hr2d_scene_create(&hooks, &scene)) return HR2D_ENOMEM;
  const hr2d_status status = hr2d_state_read_scene(scene, play, b);
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
  bytes b = {0};
  REQUIRE(hr2d_state_write_scene(r->scene, record, &b) == HR2D_OK);
  const uint64_t hash = fuzz_hash_bytes(b.byte, b.size);
  r->failures = r->memory.failures;
  if (hash % 4 == 0) r->memory.until_failure = (long)(hash >> 8 & 63);
  const hr2d_status status = read_back(r, &b);
  REQUIRE(status == (api_memory_is_back(r) ? HR2D_ENOMEM : HR2D_OK));
  b.byte[(hash >> 16) % b.size] ^= (uint8_t)(1u << (hash >> 8 & 7));
  REQUIRE(read_back(r, &b) != HR2D_OK);
  free(b.byte);
}
