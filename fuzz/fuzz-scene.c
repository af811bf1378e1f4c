/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Takes any bytes as a scene file.  A refused text leaves the scene unchanged and gives a
   reason; an accepted one can be committed, split at crossings, refined and solved.  Memory
   stays in proportion to the file. */
#include <math.h>
#include <string.h>

#include "fuzz.h"

enum { MOST_COMMITTED = 1000, MOST_REFINED = 64, MOST_SOLVED = 32, MOST_BANDS = 8 };

/* Bytes of memory per byte of file, and those that do not depend on it: see
   doc/fuzzing.md. */
#define PER_BYTE 256
#define CONSTANT 32768

static const double before_background = 0.25;
static const hr2d_patch before = {.a = {-7, 1},
                                  .b = {-7, 5},
                                  .name = "before",
                                  .reflectance = &before_background,
                                  .reflectance_bands = 1};

static hr2d_scene *start(fuzz_memory *memory) {
  const hr2d_allocator hooks = fuzz_hooks(memory);
  hr2d_scene *scene = NULL;
  REQUIRE(hr2d_scene_create(&hooks, &scene) == HR2D_OK);
  REQUIRE(hr2d_scene_add(scene, &before, NULL) == HR2D_OK);
  REQUIRE(hr2d_scene_set_background(scene, &before_background, 1) == HR2D_OK);
  return scene;
}

static void check_unchanged(const hr2d_scene *scene) {
  const hr2d_segment s = hr2d_scene_segment(scene, 0);
  REQUIRE(hr2d_scene_patches(scene) == 1);
  REQUIRE(s.a.x == before.a.x && s.a.y == before.a.y && s.b.x == before.b.x &&
          s.b.y == before.b.y);
  REQUIRE(strcmp(hr2d_scene_name(scene, 0), before.name) == 0);
  REQUIRE(hr2d_scene_reflectance(scene, 0, 0) == before_background);
  REQUIRE(hr2d_scene_emission(scene, 0, 0) == 0);
  REQUIRE(hr2d_scene_background(scene, 0) == before_background);
}

static void check_refusal(const hr2d_scene *scene, hr2d_status status) {
  check_unchanged(scene);
  REQUIRE(status == HR2D_ENOMEM || status == HR2D_ESYNTAX || status == HR2D_ESCENE ||
          status == HR2D_EUNSUPPORTED);
  fuzz_check_message(hr2d_scene_message(scene));
}

static hr2d_status parse(const uint8_t *data, size_t size) {
  fuzz_memory memory = FUZZ_MEMORY_INIT, *jansson = fuzz_jansson_memory();
  jansson->peak = jansson->bytes = 0;
  hr2d_scene *scene = start(&memory);
  const hr2d_status status = hr2d_scene_parse(scene, (const char *)data, size);
  REQUIRE(memory.peak + jansson->peak <= CONSTANT + PER_BYTE * size);
  REQUIRE(jansson->live == 0);
  if (status) {
    check_refusal(scene, status);
    REQUIRE(status != HR2D_ENOMEM);
  }
  /* Nothing of the first reading is in the way of a second, but a scene has at most three
     mirrors. */
  const size_t patches = hr2d_scene_patches(scene), mirrors = hr2d_scene_mirrors(scene);
  const int again = 2 * mirrors <= 3;
  REQUIRE(hr2d_scene_parse(scene, (const char *)data, size) ==
          (again ? status : HR2D_EUNSUPPORTED));
  REQUIRE(hr2d_scene_patches(scene) == (again ? 2 * patches - 1 : patches));
  REQUIRE(hr2d_scene_mirrors(scene) == (again ? 2 * mirrors : mirrors));
  hr2d_scene_destroy(scene);
  REQUIRE(memory.live == 0);
  return status;
}

/* One allocation fails, or all from it on, of the library or of jansson. */
static void parse_without_memory(const uint8_t *data, size_t size) {
  const uint64_t hash = fuzz_hash_bytes(data, size);
  fuzz_memory memory = FUZZ_MEMORY_INIT, *jansson = fuzz_jansson_memory();
  hr2d_scene *scene = start(&memory);
  fuzz_memory *failing = hash & 1 ? &memory : jansson;
  failing->until_failure = (long)((hash >> 8) % (hash & 4 ? 10 : 100));
  failing->for_good = (hash & 2) != 0;
  const long failures = failing->failures;
  const hr2d_status status = hr2d_scene_parse(scene, (const char *)data, size);
  if (failing->failures > failures && status) REQUIRE(status == HR2D_ENOMEM);
  failing->until_failure = -1;
  if (status) check_refusal(scene, status);
  hr2d_scene_destroy(scene);
  REQUIRE(memory.live == 0 && jansson->live == 0);
}

/* A temperature is none, or a number; so is light at points, and what the sky gives. */
static void look(const hr2d_solution *solution) {
  const hr2d_scene *scene =
      hr2d_hierarchy_scene(hr2d_linkset_hierarchy(hr2d_solution_links(solution)));
  const size_t n = hr2d_scene_patches(scene), bands = hr2d_scene_bands(scene);
  const hr2d_segment first = hr2d_scene_segment(scene, 0);
  const hr2d_point at[] = {first.a, {first.a.x / 2 + first.b.x / 2, first.a.y}};
  double kelvin[MOST_SOLVED], mean[2 * MOST_BANDS];
  unsigned char place[2];
  hr2d_temperatures t = {.struct_size = sizeof t, .kelvin = kelvin};
  hr2d_field_values values = {.struct_size = sizeof values, .mean = mean, .place = place};
  const hr2d_status status = hr2d_solution_temperatures(solution, NULL, NULL, &t);
  for (size_t k = 0; !status && k < n; k++) REQUIRE(isnan(kelvin[k]) || kelvin[k] >= 0);
  for (size_t k = 0; k < n; k++)
    for (size_t b = 0; b < bands; b++) REQUIRE(hr2d_scene_sunlight(scene, k, b) >= 0);
  if (bands > MOST_BANDS) return;
  REQUIRE(hr2d_field_at(solution, at, 2, NULL, &values) == HR2D_OK);
  for (size_t k = 0; k < 2 * bands; k++)
    REQUIRE((place[k / bands] == HR2D_PLACE_OUTSIDE) == (isnan(mean[k]) != 0));
}

static void solve(hr2d_linkset *links) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *solution = NULL;
  options.max_iterations = 300;
  const hr2d_status status = hr2d_solve(links, &options, &solution);
  if (!status) {
    fuzz_check_solution(solution, 1, 1);
    look(solution);
  } else {
    REQUIRE(!solution);
    REQUIRE(status == HR2D_ENO_SOLUTION || status == HR2D_ENOT_CONVERGED ||
            status == HR2D_ERANGE);
    fuzz_check_message(hr2d_linkset_message(links));
  }
  hr2d_solution_destroy(solution);
}

static void refine(const hr2d_scene *scene) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 0.5;
  options.max_level = 6;
  options.max_elements = 4000;
  options.max_links = 4000;
  REQUIRE(hr2d_hierarchy_create(scene, &hierarchy) == HR2D_OK);
  REQUIRE(hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links) == HR2D_OK);
  hr2d_status status = hr2d_refine(links, &options);
  if (status) {
    REQUIRE(status == HR2D_EMAX_LINKS || status == HR2D_EMAX_ELEMENTS);
    REQUIRE(hr2d_linkset_size(links) == 0);
    fuzz_check_message(hr2d_linkset_message(links));
  } else {
    fuzz_check_links(links);
    if (hr2d_scene_patches(scene) * hr2d_scene_images(scene) <= MOST_SOLVED) solve(links);
  }
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
}

static hr2d_status check_warning(void *ctx, const hr2d_warning *warning) {
  (void)ctx;
  fuzz_check_message(warning->text);
  REQUIRE(hr2d_warning_name(warning->code));
  return HR2D_OK;
}

static void check_info(const hr2d_scene *scene) {
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) {
    const char *reason = NULL;
    const int on = hr2d_scene_effect(scene, (hr2d_effect)e, &reason);
    REQUIRE((on == 0 || on == 1) && hr2d_effect_name((hr2d_effect)e));
    fuzz_check_message(reason);
  }
  const double unit = hr2d_scene_unit(scene);
  REQUIRE(isfinite(unit) && unit > 0);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const double length = hr2d_scene_length(scene, k);
    size_t found;
    REQUIRE(isfinite(length) && length > 0);
    REQUIRE(fuzz_is_utf8(hr2d_scene_name(scene, k)));
    REQUIRE(hr2d_scene_find(scene, hr2d_scene_name(scene, k), &found) == HR2D_OK);
    REQUIRE(found <= k);
  }
  REQUIRE(hr2d_scene_lint(scene, check_warning, NULL, NULL) == HR2D_OK);
}

static hr2d_status nothing(hr2d_scene *scene) {
  (void)scene;
  return HR2D_OK;
}

static hr2d_status split(hr2d_scene *scene) {
  return hr2d_scene_split_crossings(scene, NULL);
}

/* Coordinates of most files are between 0 and 10. */
static hr2d_status snap(hr2d_scene *scene) {
  return hr2d_scene_snap(scene, 0.01, NULL);
}

/* Without the patch of check_unchanged(), which might be in the way. */
static void use(const uint8_t *data, size_t size, hr2d_status (*repair)(hr2d_scene *)) {
  fuzz_memory memory = FUZZ_MEMORY_INIT;
  const hr2d_allocator hooks = fuzz_hooks(&memory);
  hr2d_scene *scene = NULL;
  hr2d_status status = hr2d_scene_create(&hooks, &scene);
  if (!status) status = hr2d_scene_parse(scene, (const char *)data, size);
  REQUIRE(status == HR2D_OK);
  status = repair(scene);
  if (!status && hr2d_scene_patches(scene) <= MOST_COMMITTED) {
    status = hr2d_scene_commit(scene);
    if (!status) check_info(scene);
    if (!status && hr2d_scene_patches(scene) * hr2d_scene_images(scene) <= MOST_REFINED)
      refine(scene);
  }
  if (status) {
    REQUIRE(status == HR2D_ESCENE || status == HR2D_ERANGE || status == HR2D_EUNSUPPORTED);
    fuzz_check_message(hr2d_scene_message(scene));
  }
  hr2d_scene_destroy(scene);
  REQUIRE(memory.live == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  const hr2d_status status = parse(data, size);
  parse_without_memory(data, size);
  if (!status) {
    use(data, size, nothing);
    use(data, size, split);
    use(data, size, snap);
  }
  return 0;
}
