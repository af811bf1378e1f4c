/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the suns of a scene light, for callers. */
#include <hr2d/daylight.h>
#include <math.h>

#include "scene/scene-impl.h"

double hr2d_scene_sunlight_over(const hr2d_scene *scene, size_t patch, double from, double to,
                                size_t band) {
  if (!hr2di_scene_has(scene, patch) || !hr2di_scene_has_band(scene, band)) return NAN;
  size_t count;
  const hr2di_lit_part *part = hr2di_sunlight_of(scene, patch, band, &count);
  double lit = 0;
  for (size_t k = 0; k < count; k++)
    lit += fmax(fmin(part[k].to, to) - fmax(part[k].from, from), 0);
  return lit > 0 ? fmin(lit / (to - from), 1) * hr2di_sunlight_full(scene, patch, band) : 0;
}

double hr2d_scene_sunlight(const hr2d_scene *scene, size_t patch, size_t band) {
  return hr2d_scene_sunlight_over(scene, patch, 0, 1, band);
}

double hr2d_scene_sunlight_cut_off(const hr2d_scene *scene, size_t band) {
  if (!scene || !hr2di_scene_has_band(scene, band)) return NAN;
  if (!scene->symmetry.low_suns) return 0;
  const size_t sun = scene->sun_bands == 1 ? 0 : band;
  return hr2di_symmetry_is_low(scene, sun) ? scene->sun[sun].irradiance : 0;
}

double hr2d_scene_sunlight_at(const hr2d_scene *scene, size_t patch, double t, size_t band) {
  if (!hr2di_scene_has(scene, patch) || !hr2di_scene_has_band(scene, band)) return NAN;
  return hr2di_sunlight_at(scene, patch, band, t) ? hr2di_sunlight_full(scene, patch, band) : 0;
}

size_t hr2d_scene_sunlit_parts(const hr2d_scene *scene, size_t patch, size_t band,
                               double (*part)[2], size_t room) {
  if (!hr2di_scene_has(scene, patch) || !hr2di_scene_has_band(scene, band)) return 0;
  size_t count;
  const hr2di_lit_part *lit = hr2di_sunlight_of(scene, patch, band, &count);
  for (size_t k = 0; k < count && k < room; k++) {
    part[k][0] = lit[k].from;
    part[k][1] = lit[k].to;
  }
  return count;
}
