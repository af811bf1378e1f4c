/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The radiance of a sky in a direction.  χ is from the chord of two unit vectors, which is
   exact near the sun. */
#include <math.h>

#include "base/pi.h"
#include "scene/sky-model.h"

#define DEGREE (HR2DI_PI / 180)

double hr2d_sky_radiance(const hr2d_sky *sky, double elevation, double azimuth) {
  hr2d_sky all;
  hr2di_sky_section s;
  if (!sky || hr2di_sky_copy(&all, sky) || hr2di_sky_problem(&all) ||
      !(elevation >= 0 && elevation <= 90) || !isfinite(azimuth))
    return NAN;
  hr2di_sky_section_init(&s, &all);
  const double sine[] = {sin(elevation * DEGREE), sin(all.sun_elevation * DEGREE)},
               cosine[] = {cos(elevation * DEGREE), cos(all.sun_elevation * DEGREE)};
  const double turn = (azimuth - all.sun_azimuth) * DEGREE;
  const double dx = cosine[0] * cos(turn) - cosine[1], dy = cosine[0] * sin(turn),
               dz = sine[0] - sine[1];
  const double chi = 2 * asin(fmin(sqrt(dx * dx + dy * dy + dz * dz) / 2, 1));
  double sum = all.irradiance > 0 ? s.scale * hr2di_sky_shape(&all, sine[0], chi) : 0;
  if (all.disc_irradiance > 0 && chi <= all.disc_radius * DEGREE) sum += s.disc;
  if (all.horizon_irradiance > 0 && elevation <= all.horizon_height) sum += s.band;
  return sum;
}
