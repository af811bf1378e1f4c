/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes without light, and those in which light is not absorbed. */
#include "lint/lint-impl.h"

static int absorbs(const hr2d_scene *scene, size_t band) {
  size_t k = 0;
  while (k < hr2di_scene_cell(scene) && !(hr2di_scene_absorptance(scene, k, band) > 0)) k++;
  return k < hr2di_scene_cell(scene);
}

static hr2d_status warn_of_no_absorber(const hr2di_lint *lint) {
  const hr2d_scene *scene = lint->scene;
  size_t band = 0;
  if (hr2di_scene_has_gas(scene)) return HR2D_OK; /* it absorbs */
  while (band < scene->bands && absorbs(scene, band)) band++;
  if (band == scene->bands) return HR2D_OK;
  return hr2di_lint_warn(lint, (hr2d_warning){.code = HR2D_WARNING_NO_ABSORBER},
                         "every reflectance of band %zu is 1: a closed room has no solution; "
                         "give some patch a reflectance below 1, or a \"temperature\"",
                         band);
}

hr2d_status hr2di_lint_light(const hr2di_lint *lint, int *blind) {
  const hr2d_scene *scene = lint->scene;
  const int lit = scene->effect[HR2D_EFFECT_EMISSION].called_for;
  hr2d_status status = HR2D_OK;
  if (!lit)
    status = hr2di_lint_warn(
        lint, (hr2d_warning){.code = HR2D_WARNING_DARK_SCENE},
        "no patch emits, and there is neither a background nor a sun, so that B is 0 "
        "everywhere: write \"emission\" or \"temperature\", or a \"background\" or a \"sun\" "
        "in \"hr2d\"");
  if (!status) status = hr2di_lint_views(lint, blind);
  return status ? status : warn_of_no_absorber(lint);
}
