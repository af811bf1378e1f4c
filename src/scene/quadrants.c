/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sky past the ends of a period.  Rays to it leave the strip of the patches by its upper or
   lower border, so that each belongs to a period by where it does. */
#include <math.h>

#include "base/pi.h"
#include "scene/scene-impl.h"

/* Degrees from the line along the period, on whose two sides the sky may differ. */
#define BESIDE 1e-7

hr2di_quadrant hr2di_symmetry_quadrant(const hr2di_symmetry *s, hr2d_point x, int end,
                                       int above) {
  const hr2d_point d = s->by.period;
  const double size = hypot(d.x, d.y);
  const hr2d_point along = {d.x / size, d.y / size}, across = {-along.y, along.x};
  const int out = end ? 1 : -1, up = above ? 1 : -1;
  const double at = across.x * x.x + across.y * x.y;
  return (hr2di_quadrant){.out = {out * along.x, out * along.y},
                          .up = {up * across.x, up * across.y},
                          .line = s->line[end] - out * (along.x * x.x + along.y * x.y),
                          .border = above ? s->high - at : at - s->low,
                          .period = size};
}

void hr2di_quadrant_of(const hr2di_symmetry *s, const hr2di_quadrant *q, unsigned k,
                       double distance[2]) {
  distance[0] = k == 0 ? q->line : fmax(q->line - (s->copies - k + 1.) * q->period, 0);
  distance[1] = k == 0 ? HUGE_VAL : fmax(q->line - (double)(s->copies - k) * q->period, 0);
}

double hr2di_quadrant_bearing(const hr2di_quadrant *q) {
  const double turn = q->out.x * q->up.y - q->out.y * q->up.x > 0 ? -1 : 1;
  return 90 - atan2(q->out.y, q->out.x) * (180 / HR2DI_PI) + turn * BESIDE;
}

int hr2di_symmetry_is_along(const hr2di_symmetry *s, double bearing) {
  const hr2d_point e = hr2di_sky_direction(bearing), d = s->by.period;
  return fabs(e.x * d.y - e.y * d.x) <= BESIDE * (HR2DI_PI / 180) / 2 * hypot(d.x, d.y);
}

/* Patches see an end at a distance of K periods at least, under the height of the strip. */
int hr2di_sky_changes_past_ends(const hr2d_scene *scene, double *bearing) {
  const hr2di_symmetry *s = &scene->symmetry;
  const hr2d_point d = s->by.period;
  const double size = hypot(d.x, d.y);
  const double slope = (s->high - s->low) / (s->copies * size);
  for (size_t k = 0; k < 2 * scene->sky.pieces; k++) {
    if (!hr2di_sky_edge(scene, k, bearing)) continue;
    const hr2d_point e = hr2di_sky_direction(*bearing);
    if (!hr2di_symmetry_is_along(s, *bearing) &&
        fabs(e.x * d.y - e.y * d.x) < slope * fabs(e.x * d.x + e.y * d.y))
      return 1;
  }
  return 0;
}

/* Places between the horizon and the slope under which patches see an end. */
enum { PLACES = 9 };

/* What a continuous sky may change of H there, as a part of its largest radiosity: both ends
   take up to the slope of a form factor. */
#define CHANGE 1e-11

int hr2di_sky_varies_past_ends(const hr2d_scene *scene) {
  const hr2di_symmetry *s = &scene->symmetry;
  const hr2d_point d = s->by.period;
  const double slope = (s->high - s->low) / (s->copies * hypot(d.x, d.y)),
               most = atan(slope) * (180 / HR2DI_PI),
               along = 90 - atan2(d.y, d.x) * (180 / HR2DI_PI);
  if (!hr2di_sky_is_continuous(&scene->sky)) return 0;
  for (size_t b = 0; b < scene->bands; b++)
    for (int quadrant = 0; quadrant < 4; quadrant++) {
      const double line = along + 180 * (quadrant / 2), side = quadrant % 2 ? 1 : -1;
      const double horizon = hr2d_scene_sky(scene, line + side * BESIDE, b);
      for (int k = 1; k <= PLACES; k++) {
        const double here = hr2d_scene_sky(scene, line + side * most * k / PLACES, b);
        if (!(slope * fabs(here - horizon) <= CHANGE * hr2di_sky_max(scene, b))) return 1;
      }
    }
  return 0;
}

hr2d_point hr2di_symmetry_home(const hr2di_symmetry *s, hr2d_point x) {
  const hr2d_point d = s->by.period;
  const double size = hypot(d.x, d.y);
  const double along = d.x / size * x.x + d.y / size * x.y,
               middle = (s->line[1] - s->line[0]) / 2;
  const double periods = round((along - middle) / size);
  return (hr2d_point){x.x - periods * d.x, x.y - periods * d.y};
}
