/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An enclosure that left something out would be wrong without a word. */
#include "enclosure/enclosure-refused.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "enclosure/enclosure-sweep.h"
#include "scene/frozen-temperatures.h"

/* Products of three numbers and a thousand sums of them neither over- nor underflow. */
#define LARGEST 0x1p900
#define LEAST   0x1p-900

static const char *scene_reason(const hr2d_scene *scene) {
  if (hr2di_scene_has_sun(scene))
    return "suns are not enclosed: replace them by patches that emit, or rely on the estimate";
  if (scene->sky.pieces > 0)
    return "a sky in pieces is not enclosed: use an even background, or rely on the estimate";
  if (scene->effect[HR2D_EFFECT_PANES].called_for)
    return "panes are not enclosed: make them opaque, or rely on the estimate";
  if (hr2di_symmetry_cuts(&scene->symmetry))
    return "a period in which patches see for ever is not enclosed: draw some cells without a "
           "period, or rely on the estimate";
  return NULL;
}

static const char *patch_reason(const hr2d_scene *scene, size_t patch, size_t band) {
  if (hr2di_scene_has_flux(scene, patch))
    return "has a given heat flux, which is not enclosed: give its temperature";
  if (hr2d_scene_emission(scene, patch, band) < 0) return "has a negative emission";
  if (!(hr2d_scene_reflectance(scene, patch, band) < 1))
    return "absorbs nothing, so that nothing bounds its light: give it a reflectance below 1";
  return NULL;
}

static int is_out_of_range(const hr2d_scene *scene, size_t band) {
  const double upper = hr2di_enclosing_max(scene, band);
  return upper > 0 && !(upper >= LEAST && upper <= LARGEST);
}

hr2d_status hr2di_enclosure_refused(const hr2d_scene *scene, char *reason, size_t room) {
  const char *why = scene_reason(scene);
  if (why) snprintf(reason, room, "%s", why);
  for (size_t k = 0; k < hr2di_scene_cell(scene) && !why; k++)
    for (size_t b = 0; b < scene->bands && !why; b++) {
      why = patch_reason(scene, k, b);
      if (why) snprintf(reason, room, "%s %s", hr2di_patch_label(scene, k).text, why);
    }
  for (size_t b = 0; b < scene->bands && !why; b++)
    if (is_out_of_range(scene, b)) {
      why = "range";
      snprintf(reason, room,
               "the radiosity of band %zu may be up to %.0e, beyond what is enclosed: choose "
               "another unit",
               b, hr2di_enclosing_max(scene, b));
    }
  return why ? HR2D_EUNSUPPORTED : HR2D_OK;
}
