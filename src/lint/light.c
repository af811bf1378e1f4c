/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fronts that no light reaches, that see nothing, and scenes in which light is not absorbed. */
#include "lint/lint-impl.h"
#include "scene/with-plane.h"
#include "visibility/sees-anything.h"

static int emits(const hr2d_scene *scene, size_t patch) {
  for (size_t band = 0; band < scene->bands; band++)
    if (hr2d_scene_emission(scene, patch, band) != 0) return 1;
  return 0;
}

static hr2d_warning about(hr2d_warning_code code, size_t patch) {
  return (hr2d_warning){.code = code, .patches = 1, .patch = {patch}};
}

#define TURN "the front is on the left from a to b: swap the ends, or for a polygon \"faces\""

static hr2d_status warn_of_dark(const hr2di_lint *lint) {
  const hr2d_scene *scene = lint->scene;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < hr2di_scene_cell(scene) && scene->dark && !status; k++) {
    status = hr2di_watch_work(lint->watch, 1);
    if (!status && scene->dark[k])
      status =
          hr2di_lint_warn(lint, about(HR2D_WARNING_UNLIT, k),
                          "no light reaches the front of %s: if it should see the light, " TURN,
                          hr2di_patch_label(scene, k).text);
  }
  return status;
}

static hr2d_status look_from(const hr2di_lint *lint, const hr2d_scene *in, int sky) {
  const hr2d_scene *scene = lint->scene;
  hr2di_viewer *viewer = NULL;
  hr2d_status status = hr2di_viewer_create(in, &scene->alloc, lint->watch, &viewer);
  for (size_t k = 0; k < hr2di_scene_cell(scene) && !status; k++) {
    int sees = 1;
    status = hr2di_watch_work(lint->watch, 1);
    if (!status && (sky || emits(scene, k)))
      status = hr2di_sees_anything(viewer, k, sky, &sees);
    if (!status && !sees)
      status = hr2di_lint_warn(lint, about(HR2D_WARNING_SEES_NOTHING, k),
                               "the front of %s sees no patch%s: if it should, " TURN,
                               hr2di_patch_label(scene, k).text, sky ? " and no sky" : "");
  }
  hr2di_viewer_destroy(viewer);
  return status;
}

/* Where it is unclear how patches cross, there is no plane to look through, and no warning. */
static hr2d_status warn_of_views(const hr2di_lint *lint) {
  const int sky = lint->scene->effect[HR2D_EFFECT_BACKGROUND].called_for;
  hr2di_with_plane w;
  hr2d_status status = hr2di_with_plane_init(&w, lint->scene, &lint->scene->alloc, lint->watch);
  w.scene.effect[HR2D_EFFECT_OCCLUSION].on = 1;
  if (!status && w.scene.parts.wanted) status = look_from(lint, &w.scene, sky);
  hr2di_with_plane_clear(&w);
  return status;
}

static int absorbs(const hr2d_scene *scene, size_t band) {
  size_t k = 0;
  while (k < hr2di_scene_cell(scene) && hr2d_scene_reflectance(scene, k, band) == 1) k++;
  return k < hr2di_scene_cell(scene);
}

static hr2d_status warn_of_no_absorber(const hr2di_lint *lint) {
  const hr2d_scene *scene = lint->scene;
  size_t band = 0;
  while (band < scene->bands && absorbs(scene, band)) band++;
  if (band == scene->bands) return HR2D_OK;
  return hr2di_lint_warn(lint, (hr2d_warning){.code = HR2D_WARNING_NO_ABSORBER},
                         "every reflectance of band %zu is 1: a closed room has no solution; "
                         "give some patch a reflectance below 1, or a \"temperature\"",
                         band);
}

hr2d_status hr2di_lint_light(const hr2di_lint *lint) {
  const hr2d_scene *scene = lint->scene;
  const int lit = scene->effect[HR2D_EFFECT_EMISSION].called_for;
  hr2d_status status = HR2D_OK;
  if (!lit)
    status = hr2di_lint_warn(
        lint, (hr2d_warning){.code = HR2D_WARNING_DARK_SCENE},
        "no patch emits, and there is neither a background nor a sun, so that B is 0 "
        "everywhere: write \"emission\" or \"temperature\", or a \"background\" or a \"sun\" "
        "in \"hr2d\"");
  if (!status && lit) status = warn_of_dark(lint);
  if (!status && lit) status = warn_of_views(lint);
  return status ? status : warn_of_no_absorber(lint);
}
