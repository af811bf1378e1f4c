/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Defaults and checks of targets. */
#include "accuracy/target.h"

#include <stdint.h>
#include <string.h>

#include "base/alloc.h"
#include "base/share.h"
#include "base/sized-struct.h"
#include "base/sort.h"
#include "base/team.h"
#include "scene/scene-impl.h"

static hr2d_status check(const hr2d_scene *scene, const hr2d_target *t) {
  if (!(t->error >= 0) && t->error != HR2D_SMALLEST_ERROR) return HR2D_EINVAL;
  if (!(t->seconds >= 0)) return HR2D_EINVAL;
  if (!(t->floor >= 0 && t->floor <= 1)) return HR2D_EINVAL;
  if (hr2di_share_check(t->share)) return HR2D_EINVAL;
  if (!t->important && t->important_count > 0) return HR2D_EINVAL;
  for (size_t k = 0; k < t->important_count; k++)
    if (t->important[k] >= hr2di_scene_cell(scene)) return HR2D_EINVAL;
  if (hr2di_scene_has_gas(scene) && t->share) return HR2D_EUNSUPPORTED;
  return t->norm == HR2D_NORM_AVERAGE || t->norm == HR2D_NORM_SUP ? HR2D_OK : HR2D_EINVAL;
}

static int by_index(const void *a, const void *b) {
  const size_t i = *(const size_t *)a, j = *(const size_t *)b;
  return (i > j) - (i < j);
}

/* Replaces the important patches by a copy: sorted, each once. */
static hr2d_status sort_patches(hr2d_target *t, const hr2d_scene *scene) {
  const size_t count = t->important_count;
  const size_t *given = t->important;
  t->important = NULL;
  t->important_count = 0;
  if (!count) return HR2D_OK;
  size_t *copy = hr2di_alloc(&scene->alloc, count, sizeof *copy);
  if (!copy) return HR2D_ENOMEM;
  memcpy(copy, given, count * sizeof *copy);
  hr2di_sort(copy, count, sizeof *copy, by_index, NULL);
  for (size_t k = 0; k < count; k++)
    if (!k || copy[k] != copy[k - 1]) copy[t->important_count++] = copy[k];
  t->important = copy;
  return HR2D_OK;
}

hr2d_status hr2di_target_init(hr2d_target *used, const hr2d_scene *scene,
                              const hr2d_target *given, double default_error) {
  *used = (hr2d_target)HR2D_TARGET_INIT;
  hr2d_status status = hr2di_sized_copy(used, sizeof *used, given);
  if (!status) status = check(scene, used);
  if (status) {
    used->important = NULL;                                 /* the caller's */
    if (hr2di_share_check(used->share)) used->share = NULL; /* nobody to agree with */
    return status;
  }
  if (!(used->error > 0)) used->error = used->error < 0 ? 0 : default_error;
  if (!(used->floor > 0)) used->floor = HR2D_FLOOR;
  if (used->norm == HR2D_NORM_SUP) used->points = 1;
  used->threads = (unsigned)hr2di_team_threads(used->threads);
  hr2di_scene_choose_progress(scene, &used->progress, &used->progress_ctx);
  return sort_patches(used, scene);
}

void hr2di_target_clear(hr2d_target *used, const hr2d_allocator *alloc) {
  /* Ours, and not const; the type of the member is that of the caller's patches. */
  hr2di_alloc_free(alloc, (void *)(uintptr_t)used->important);
  used->important = NULL;
}
