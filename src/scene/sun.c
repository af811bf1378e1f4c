/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The suns of a scene. */
#include <hr2d/daylight.h>
#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"

hr2d_status hr2di_scene_check_sun(hr2d_scene *scene, const hr2d_sun *sun, size_t number) {
  const hr2d_point d = sun->direction;
  if (!(sun->irradiance >= 0) || !isfinite(sun->irradiance))
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "sun %zu: irradiance %g is not a number of 0 or more", number,
                              sun->irradiance);
  if (!(sun->irradiance > 0)) return HR2D_OK;
  if (!isfinite(d.x) || !isfinite(d.y) || (d.x == 0 && d.y == 0))
    return hr2di_message_fail(&scene->message, HR2D_ESCENE, "sun %zu: (%g, %g) is no direction",
                              number, d.x, d.y);
  return HR2D_OK;
}

void hr2di_scene_take_sun(hr2d_scene *scene, hr2d_sun *sun, size_t bands) {
  hr2di_alloc_free(&scene->alloc, scene->sun);
  scene->sun = sun;
  scene->sun_bands = bands;
}

hr2d_status hr2d_scene_set_sun(hr2d_scene *scene, const hr2d_sun *sun, size_t bands) {
  if (!scene) return HR2D_EINVAL;
  hr2d_status status = HR2D_OK;
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE, "a committed scene takes no sun");
  if (bands && !sun)
    return hr2di_message_fail(&scene->message, HR2D_EINVAL,
                              "sun: a number of bands but no suns");
  for (size_t k = 0; k < bands && !status; k++)
    status = hr2di_scene_check_sun(scene, &sun[k], k);
  if (status) return status;
  hr2d_sun *copy = hr2di_alloc(&scene->alloc, bands, sizeof *copy);
  if (!copy)
    return hr2di_message_fail(&scene->message, HR2D_ENOMEM, "out of memory for the sun");
  for (size_t k = 0; k < bands; k++) copy[k] = sun[k];
  hr2di_scene_take_sun(scene, copy, bands);
  return HR2D_OK;
}

hr2d_sun hr2d_scene_sun(const hr2d_scene *scene, size_t band) {
  if (!hr2di_scene_has_band(scene, band)) return (hr2d_sun){{NAN, NAN}, NAN};
  if (scene->sun_bands == 0) return (hr2d_sun){{0, 0}, 0};
  return scene->sun[scene->sun_bands == 1 ? 0 : band];
}
