/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Takes bytes as a forged state or scene: all of it may be wrong but the hash, which the
   harness adds.  What is refused leaves its objects empty, and a reason.  What is accepted is
   written again with the same bytes, and whatever is done with it next ends with a status, for
   a forged state may have wrong values, but no others. */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "state/byte-stream.h"
#include "state/state-impl.h"

/* Bytes of memory per byte that is read, and those that do not depend on it.  A division, of 4
   bytes, makes two elements, and an array of them exists twice where it grows. */
#define PER_BYTE 512
#define CONSTANT 65536

#define FILE_OF(head, features)                                                                \
  "{\"type\":\"FeatureCollection\",\"hr2d\":{" head "},\"features\":[" features "]}"
#define WALL(properties, line)                                                                 \
  "{\"type\":\"Feature\",\"properties\":{" properties                                          \
  "},\"geometry\":{\"type\":\"LineString\",\"coordinates\":" line "}}"

/* The scenes of the states: two bands and a wall in a room; a row of them without end, with a
   mirror; given temperatures and fluxes; sun and sky. */
static const char *const stages[] = {
    FILE_OF("", WALL("\"emission\":[1,2],\"reflectance\":0.5",
                     "[[0,0],[2,0],[2,2],[0,2],[0,0]]") "," WALL("\"sides\":\"both\"",
                                                                 "[[1,0.5],[1.25,1]]")),
    FILE_OF("\"period\":[6,0],\"background\":1",
            WALL("\"reflectance\":0.5", "[[0.5,1],[0.5,0],[2,0],[2,1]]") "," WALL(
                "\"sides\":\"mirror\"", "[[0,0],[0,1]]")),
    FILE_OF("\"wavelengths\":[3]",
            WALL("\"flux\":0,\"emissivity\":[0.5,0.75]",
                 "[[0,0],[1,0],[1,1]]") "," WALL("\"temperature\":900", "[[1,1],[0,0]]")),
    FILE_OF("\"sun\":{\"bearing\":30,\"irradiance\":800},\"sky\":[[-90,90,200]]",
            WALL("\"reflectance\":0.5", "[[0,2],[0,0],[2,0],[2,2]]")),
};
enum { STAGES = sizeof stages / sizeof *stages, SCENE_HASHES_AT = HR2DI_STATE_TITLE_BYTES };

/* What is written has to be what was read. */
static hr2d_status compare(void *ctx, const void *data, size_t size) {
  fuzz_stream *b = ctx;
  REQUIRE(size <= b->size - b->at && memcmp(b->byte + b->at, data, size) == 0);
  b->at += size;
  return HR2D_OK;
}

static void put_word(uint8_t *byte, uint64_t word) {
  for (int k = 0; k < 8; k++) byte[k] = (uint8_t)(word >> 8 * k);
}

/* A copy of the input with its hash. */
static fuzz_stream forge(const uint8_t *data, size_t size) {
  fuzz_stream b = {.byte = malloc(size + 8), .size = size + 8};
  REQUIRE(b.byte);
  if (size) memcpy(b.byte, data, size);
  return b;
}

static void sign(fuzz_stream *b, uint64_t wrong) {
  const size_t size = b->size - 8;
  put_word(b->byte + size, hr2di_hash_bytes(HR2DI_HASH_INIT, b->byte, size) ^ wrong);
}

/* Memory fails for some inputs. */
static void choose_failure(fuzz_memory *memory, const fuzz_stream *b) {
  const uint64_t hash = fuzz_hash_bytes(b->byte, b->size);
  memory->peak = memory->bytes;
  if (hash % 4 == 0) memory->until_failure = (long)(hash >> 8 & 63);
}

static void check_status(const fuzz_memory *memory, hr2d_status status, const char *message) {
  REQUIRE(status != HR2D_ENOMEM || memory->failures);
  if (!status) return;
  REQUIRE(status == HR2D_ESYNTAX || status == HR2D_ENOMEM || status == HR2D_EINVAL ||
          status == HR2D_ESCENE || status == HR2D_ERANGE || status == HR2D_EUNSUPPORTED);
  fuzz_check_message(message);
}

static void read_points(const hr2d_solution *solution, const hr2d_scene *scene) {
  const double t[2] = {0, 0.75};
  const hr2d_point at = {0.5, 0.5};
  for (size_t patch = 0; patch < hr2d_scene_patches(scene); patch++) {
    double value[4];
    hr2d_solution_average(solution, patch, 0);
    hr2d_solution_at(solution, patch, 0.25, 0);
    hr2d_solution_irradiance(solution, patch, 0);
    hr2d_solution_net_flux(solution, patch, 0);
    hr2d_solution_gather(solution, patch, t, 2, value);
    hr2d_solution_gather_net_flux(solution, patch, t, 2, value);
    hr2d_solution_gather_temperature(solution, patch, t, 2, value);
  }
  hr2d_error error;
  hr2d_solution_error(solution, NULL, &error, NULL);
  double mean[8];
  unsigned char place;
  hr2d_field_values values = {.struct_size = sizeof values, .mean = mean, .place = &place};
  hr2d_field_at(solution, &at, 1, NULL, &values);
}

/* The next stage of a solve, as of a program that resumes. */
static void resume(hr2d_linkset *links, const hr2d_solution *start) {
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *solution = NULL;
  refine.epsilon = 0.25;
  refine.max_level = 5;
  refine.max_elements = refine.max_links = 2000;
  if (hr2d_linkset_validate(links)) fuzz_check_message(hr2d_linkset_message(links));
  if (hr2d_refine(links, &refine)) fuzz_check_message(hr2d_linkset_message(links));
  solve.start = start;
  solve.max_iterations = 30;
  if (hr2d_solve(links, &solve, &solution)) fuzz_check_message(hr2d_linkset_message(links));
  hr2d_solution_destroy(solution);
}

/* On failure the set and its hierarchy are empty; an accepted one is written as it was read. */
static hr2d_status read_state(hr2d_linkset *links, const hr2d_hierarchy *h, fuzz_stream *b,
                              fuzz_memory *memory) {
  const hr2d_scene *scene = hr2d_hierarchy_scene(h);
  const uint64_t roots = hr2d_hierarchy_count(h).elements;
  hr2d_solution *solution = NULL;
  b->at = 0;
  choose_failure(memory, b);
  const size_t before = memory->bytes;
  const hr2d_status status = hr2d_state_read(links, fuzz_play, b, &solution);
  memory->until_failure = -1;
  REQUIRE(memory->peak - before <= CONSTANT + PER_BYTE * b->size);
  check_status(memory, status, hr2d_linkset_message(links));
  if (status) {
    REQUIRE(!solution && hr2d_linkset_size(links) == 0);
    REQUIRE(hr2d_hierarchy_count(h).elements == roots);
    return status;
  }
  const size_t size = b->at;
  b->at = 0;
  REQUIRE(hr2d_state_write(solution, compare, b) == HR2D_OK && b->at == size);
  read_points(solution, scene);
  resume(links, solution);
  hr2d_solution_destroy(solution);
  return status;
}

/* With the hash wrong by a bit it is refused as well. */
static void state(const hr2d_scene *scene, fuzz_stream *b, fuzz_memory *memory,
                  uint64_t wrong) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2di_watch watch;
  hr2di_watch_init(&watch, NULL, NULL, NULL);
  REQUIRE(hr2d_hierarchy_create(scene, &hierarchy) == HR2D_OK);
  REQUIRE(hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links) == HR2D_OK);
  if (b->size >= SCENE_HASHES_AT + 24) {
    put_word(b->byte + SCENE_HASHES_AT, hr2di_state_scene(scene, &watch));
    put_word(b->byte + SCENE_HASHES_AT + 8, hr2di_state_method(links));
  }
  sign(b, wrong);
  const hr2d_status status = read_state(links, hierarchy, b, memory);
  REQUIRE(!wrong || status);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
}

static hr2d_status read_scene(hr2d_scene *scene, fuzz_stream *b, fuzz_memory *memory) {
  b->at = 0;
  choose_failure(memory, b);
  const hr2d_status status = hr2d_state_read_scene(scene, fuzz_play, b);
  memory->until_failure = -1;
  if (!status) return status;
  check_status(memory, status, hr2d_scene_message(scene));
  REQUIRE(hr2d_scene_patches(scene) == 0 && hr2d_scene_mirrors(scene) == 0);
  return status;
}

/* The hash of the scene in memory is among the bytes, and mostly wrong; all else is done before
   it is looked at.  What is accepted may say things that need not be said; what is written of
   it is read again, and written with the same bytes. */
static void scene_bytes(fuzz_stream *b, fuzz_memory *memory) {
  const hr2d_allocator hooks = fuzz_hooks(memory);
  hr2d_scene *scene = NULL, *again = NULL;
  fuzz_stream written = {0};
  REQUIRE(hr2d_scene_create(&hooks, &scene) == HR2D_OK);
  REQUIRE(hr2d_scene_create(&hooks, &again) == HR2D_OK);
  sign(b, 0);
  if (!read_scene(scene, b, memory)) {
    REQUIRE(hr2d_state_write_scene(scene, fuzz_record, &written) == HR2D_OK);
    REQUIRE(hr2d_state_read_scene(again, fuzz_play, &written) == HR2D_OK);
    REQUIRE(written.at == written.size);
    written.at = 0;
    REQUIRE(hr2d_state_write_scene(again, compare, &written) == HR2D_OK);
  }
  free(written.byte);
  hr2d_scene_destroy(again);
  hr2d_scene_destroy(scene);
}

static hr2d_scene *stage(const hr2d_allocator *hooks, unsigned k) {
  hr2d_scene *scene = NULL;
  hr2d_status status = hr2d_scene_create(hooks, &scene);
  if (!status) status = hr2d_scene_parse(scene, stages[k], strlen(stages[k]));
  if (!status) status = hr2d_scene_commit(scene);
  REQUIRE_SAYING(status == HR2D_OK, scene ? hr2d_scene_message(scene) : "");
  return scene;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  if (size == 0) return 0;
  const unsigned kind = data[0] % (STAGES + 1);
  fuzz_memory memory = FUZZ_MEMORY_INIT;
  const hr2d_allocator hooks = fuzz_hooks(&memory);
  fuzz_stream b = forge(data + 1, size - 1);
  if (kind == STAGES) {
    scene_bytes(&b, &memory);
  } else {
    hr2d_scene *scene = stage(&hooks, kind);
    state(scene, &b, &memory, 0);
    state(scene, &b, &memory, UINT64_C(1) << data[0] % 64);
    hr2d_scene_destroy(scene);
  }
  free(b.byte);
  REQUIRE(memory.live == 0);
  return 0;
}
