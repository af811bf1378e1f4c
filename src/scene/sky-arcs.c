/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With φ from the normal n of a patch towards its end, a point gets ½∫ L cos φ dφ = ½ L Δ sin φ
   from an arc of the sky of radiosity L.  Bearings turn clockwise, as the end is from n: the
   bearing of a direction is φ and that of n. */
#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "scene/scene-impl.h"
#include "scene/sky.h"

void hr2di_sky_clear(hr2di_sky *sky, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, sky->piece);
  hr2di_alloc_free(alloc, sky->value);
  *sky = (hr2di_sky){0};
}

double hr2di_sky_turned(double bearing) {
  const double turn = fmod(bearing, 360);
  const double whole = turn < 0 ? turn + 360 : turn;
  return whole < 360 ? whole : 0;
}

hr2d_point hr2di_sky_direction(double bearing) {
  static const hr2d_point main_ones[4] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
  const double whole = hr2di_sky_turned(bearing);
  if (fmod(whole, 90) == 0) return main_ones[(int)(whole / 90) % 4];
  const double angle = whole * (HR2DI_PI / 180);
  return (hr2d_point){sin(angle), cos(angle)};
}

/* sin φ of a bearing in front of a patch whose normal has the bearing `normal`. */
static double sine_of(hr2d_segment s, double length, double bearing) {
  const hr2d_point e = hr2di_sky_direction(bearing);
  return fmin(fmax((e.x * (s.b.x - s.a.x) + e.y * (s.b.y - s.a.y)) / length, -1), 1);
}

int hr2di_sky_front(const hr2d_scene *scene, size_t patch, size_t piece, hr2di_sines part[2]) {
  const hr2di_patch *p = &scene->patch[patch];
  const hr2d_segment s = p->scaled;
  const hr2d_sky_piece arc = scene->sky.piece[piece];
  const double normal = atan2(-(s.b.y - s.a.y), s.b.x - s.a.x) * (180 / HR2DI_PI);
  const double first = hr2di_sky_turned(arc.from - normal + 90) - 90; /* in [−90, 270) */
  const double last = first + (arc.to - arc.from);
  int parts = 0;
  for (double turn = 0; turn <= 360; turn += 360) {
    const double low = first - turn, high = last - turn;
    if (low >= 90 || high <= -90) continue;
    part[parts++] = (hr2di_sines){low <= -90 ? -1 : sine_of(s, p->length, arc.from),
                                  high >= 90 ? 1 : sine_of(s, p->length, arc.to)};
  }
  return parts;
}

double hr2di_sky_factor(const hr2di_sines part[2], int parts, double low, double high) {
  double sum = 0;
  for (int k = 0; k < parts; k++)
    sum += fmax(fmin(part[k].high, high) - fmax(part[k].low, low), 0);
  return 0.5 * sum;
}
