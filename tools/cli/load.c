/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scene files, and patches by index or name. */
#include "cli/load.h"

#include <stdint.h>
#include <string.h>

#include "cli/numbers.h"
#include "output/complain.h"

int fail_call(const char *path, const char *message, hr2d_status status) {
  if (status == HR2D_STOPPED) {
    fail(path, "interrupted");
    return EXIT_INTERRUPTED;
  }
  return fail(path, "%s", *message ? message : hr2d_strerror(status));
}

int load_scene(const options *o, unsigned force, hr2d_scene **scene, size_t *cuts) {
  *scene = NULL;
  *cuts = 0;
  hr2d_status status = hr2d_scene_create(NULL, scene);
  if (!status) status = hr2d_scene_read(*scene, o->scene);
  if (!status && o->split_crossings) status = hr2d_scene_split_crossings(*scene, cuts);
  for (int e = 0; !status && e < HR2D_EFFECT_COUNT; e++)
    if (force >> e & 1) status = hr2d_scene_force(*scene, (hr2d_effect)e);
  if (!status) status = hr2d_scene_commit(*scene);
  if (!status) return 0;
  const int code = fail_call(o->scene, *scene ? hr2d_scene_message(*scene) : "", status);
  hr2d_scene_destroy(*scene);
  *scene = NULL;
  return code;
}

int find_place(const hr2d_scene *scene, const char *option, const place *p, size_t *patch) {
  uint64_t index = 0;
  if (p->patch[strspn(p->patch, "0123456789")] == '\0') {
    if (read_count(p->patch, hr2d_scene_patches(scene) - 1, &index))
      return usage_error("--%s: the scene has no patch %s, only 0 to %zu", option, p->patch,
                         hr2d_scene_patches(scene) - 1);
    *patch = (size_t)index;
    return 0;
  }
  if (hr2d_scene_find(scene, p->patch, patch))
    return usage_error("--%s: the scene has no patch called '%s'", option, p->patch);
  return 0;
}
