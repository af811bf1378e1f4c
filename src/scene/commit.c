/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Commit: checks and analyses a scene once; from then on the scene is only read. */
#include "base/alloc.h"
#include "scene/band-groups.h"
#include "scene/regions.h"
#include "scene/scene-impl.h"

/* Light from outside may have one value for all bands, too. */
static hr2d_status check_outside(hr2d_scene *scene, const char *what, size_t bands) {
  if (bands <= 1 || bands == scene->bands) return HR2D_OK;
  if (scene->bands > 1)
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "the %s has %zu bands where the patches have %zu", what, bands,
                              scene->bands);
  scene->bands = bands;
  return HR2D_OK;
}

static hr2d_status check_all_outside(hr2d_scene *scene, hr2di_watch *watch) {
  (void)watch;
  hr2d_status status = check_outside(scene, "background", scene->background_bands);
  if (!status) status = check_outside(scene, "sky", scene->sky.pieces ? scene->sky.bands : 0);
  if (!status) status = check_outside(scene, "gas", hr2di_scene_gas_bands(scene));
  return status ? status : check_outside(scene, "sun", scene->sun_bands);
}

hr2d_status hr2di_scene_make_walls(hr2d_scene *scene, hr2di_watch *watch) {
  hr2d_segment *segment = hr2di_alloc(&scene->alloc, scene->patches, sizeof *segment);
  hr2d_status status = segment ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = 0; k < scene->patches && segment; k++) segment[k] = scene->patch[k].scaled;
  if (!status)
    status = hr2di_walls_init(&scene->walls, &scene->alloc, segment, scene->patches, watch);
  if (!status) status = hr2di_runs_init(&scene->runs, scene, watch);
  hr2di_alloc_free(&scene->alloc, segment);
  return status ? hr2di_scene_fail(scene, status, watch, "the walls") : HR2D_OK;
}

static hr2di_label label_of_wall(const hr2d_scene *scene, uint32_t wall) {
  size_t patch = 0;
  while (scene->walls.of_segment[patch] != wall) patch++;
  return hr2di_patch_label(scene, patch);
}

/* The plane shows what is in the way, and what backs hide of the background.  Else it would
   mostly lie idle after commit: row sums of open scenes make their own. */
static hr2d_status keep_plane(hr2d_scene *scene, hr2di_watch *watch) {
  const uint32_t *wall = scene->unclear.wall;
  if (!scene->effect[HR2D_EFFECT_OCCLUSION].on && !scene->effect[HR2D_EFFECT_BACKGROUND].on) {
    hr2di_scene_clear_plane(scene);
    return HR2D_OK;
  }
  const hr2d_status status = hr2di_scene_need_plane(scene, watch);
  if (status) return hr2di_scene_fail(scene, status, watch, "the plane");
  if (scene->parts.wanted) return HR2D_OK;
  return hr2di_message_fail(
      &scene->message, HR2D_ESCENE, "%s and %s cross within roundings, as too many others do",
      label_of_wall(scene, wall[0]).text, label_of_wall(scene, wall[1]).text);
}

static hr2d_status find_sunlight(hr2d_scene *scene, hr2di_watch *watch) {
  if (!hr2di_scene_has_sun(scene) && !scene->sky.pieces) return HR2D_OK;
  if (!scene->parts.wanted) return HR2D_OK; /* a sky without light */
  const hr2d_status status = hr2di_sunlight_init(&scene->sunlight, scene, watch);
  return status ? hr2di_scene_fail(scene, status, watch, "the light of the sun") : HR2D_OK;
}

static hr2d_status forget_weights(hr2d_scene *scene, hr2di_watch *watch) {
  (void)watch;
  if (scene->symmetry.motion && scene->symmetry.rest == 0)
    hr2di_symmetry_forget_weights(&scene->symmetry);
  return HR2D_OK;
}

/* Past the ends of a period the sky is that of the horizon. */
static hr2d_status check_far_sky(hr2d_scene *scene) {
  double bearing;
  if (!hr2di_symmetry_cuts(&scene->symmetry)) return HR2D_OK;
  if (hr2di_sky_varies_past_ends(scene))
    return hr2di_message_fail(
        &scene->message, HR2D_EUNSUPPORTED,
        "the continuous sky varies past the images of the period that are "
        "taken: draw several cells without a period, or a sky in pieces");
  if (!hr2di_sky_changes_past_ends(scene, &bearing)) return HR2D_OK;
  return hr2di_message_fail(&scene->message, HR2D_EUNSUPPORTED,
                            "a piece of the sky ends at a bearing of %g degrees, which is past "
                            "the images that are taken: draw several cells and a longer period",
                            bearing);
}

static hr2d_status make_groups(hr2d_scene *scene, hr2di_watch *watch) {
  const hr2d_status status = hr2di_band_groups_make(scene, watch);
  if (!status || status == HR2D_EUNSUPPORTED) return status;
  return hr2di_scene_fail(scene, status, watch, "bands through gas");
}

static hr2d_status make_regions(hr2d_scene *scene, hr2di_watch *watch) {
  const hr2d_status status = hr2di_regions_make(scene, watch);
  if (!status || status == HR2D_EUNSUPPORTED) return status;
  return hr2di_scene_fail(scene, status, watch, "the borders of gases");
}

/* With K = `copies` in a period.  Returns HR2D_OK, or a status with nothing made. */
static hr2d_status commit(hr2d_scene *scene, unsigned copies, hr2di_watch *watch) {
  hr2d_status (*const part[])(hr2d_scene *, hr2di_watch *) = {hr2di_scene_check_bands,
                                                              check_all_outside,
                                                              hr2di_scene_check_thermal,
                                                              hr2di_scene_scale,
                                                              hr2di_scene_check_gas,
                                                              make_regions,
                                                              hr2di_scene_check_overlaps,
                                                              hr2di_scene_match_panes,
                                                              hr2di_scene_make_walls,
                                                              hr2di_scene_analyse_effects,
                                                              hr2di_scene_find_light,
                                                              hr2di_scene_measure_ends,
                                                              forget_weights,
                                                              keep_plane,
                                                              find_sunlight,
                                                              make_groups};
  const size_t parts = sizeof part / sizeof *part;
  hr2d_status status = HR2D_OK;
  if (hr2di_symmetry_wanted(&scene->symmetry))
    status = hr2di_scene_unfold(scene, copies, watch);
  for (size_t k = 0; k < parts && !status; k++) {
    watch->report.fraction = (double)k / (double)parts;
    status = part[k](scene, watch);
  }
  if (status) hr2di_scene_clear_commit(scene);
  return status;
}

/* Takes more images of a period until the patches see none that are cut off. */
static hr2d_status commit_images(hr2d_scene *scene, hr2di_watch *watch) {
  unsigned copies = 0, max = 0;
  hr2d_status status = hr2di_symmetry_find(scene, watch);
  if (!status) hr2di_symmetry_copies(scene, &copies, &max);
  if (status) return status;
  for (;; copies *= 2) {
    status = commit(scene, copies, watch);
    if (status || !hr2di_symmetry_cuts(&scene->symmetry) || copies >= max) break;
    hr2di_scene_clear_commit(scene);
  }
  if (!status) status = check_far_sky(scene);
  if (!status) status = hr2di_scene_check_far_gas(scene);
  if (status) hr2di_scene_clear_commit(scene);
  return status;
}

hr2d_status hr2d_scene_commit(hr2d_scene *scene) {
  if (!scene) return HR2D_EINVAL;
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE, "the scene is committed already");
  if (scene->patches == 0)
    return hr2di_message_fail(&scene->message, HR2D_ESCENE, "the scene has no patches");
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "commit");
  const hr2d_status status = hr2di_symmetry_wanted(&scene->symmetry)
                                 ? commit_images(scene, &watch)
                                 : commit(scene, 0, &watch);
  scene->committed = !status;
  return status;
}
