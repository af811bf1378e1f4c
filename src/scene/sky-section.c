/* SPDX-License-Identifier: GPL-3.0-or-later */
/* M(φ) = 2 ∫ L cos²β dβ: the light of a sky in space that comes to a long scene from a bearing.

   With δ from the bearing of the sun, cos χ = q cos δ cos β + sin β_s sin β = C cos(β − β₀),
   C² = 1 − q² sin²δ, so that sin²χ = q² sin²δ + C² sin²(β − β₀).  L has a tip at the sun, and
   one opposite of it: along β it is nearly one at β₀ or β₀ ± π, as sharp as κ = q|sin δ|/C.
   There β − β₀ = κ sinh t is smooth in t. */
#include <math.h>

#include "base/adaptive-gauss.h"
#include "base/pi.h"
#include "scene/sky-model.h"

#define DEGREE (HR2DI_PI / 180)

/* Of halves and wholes of panels, as a part of the tolerance: the sum is much more accurate. */
#define ACROSS 0.1

/* Nearer to the tip it is a kink at the end of both sides. */
#define SHARPEST 1e-9

/* Nodes of a panel. */
enum { NODES = 16 };

/* One side of β₀. */
typedef struct ray {
  const hr2d_sky *sky;
  double cosine;           /* of φ */
  double near, wide, sign; /* q|sin δ|, C, and whether it is the sun or its opposite */
  double middle, kappa, side;
} ray;

static double across(const void *ctx, double t) {
  const ray *r = ctx;
  const double off = r->kappa * sinh(t), beta = r->middle + r->side * off;
  const double cosine = fmax(cos(beta), 0);
  const double chi = atan2(hypot(r->near, r->wide * sin(off)), r->sign * r->wide * cos(off));
  return hr2di_sky_shape(r->sky, cosine * r->cosine, chi) * cosine * cosine * r->kappa *
         cosh(t);
}

/* M of gradation and indicatrix alone. */
static double shape_at(const hr2di_sky_section *s, double bearing) {
  const double turn = bearing - s->bearing, ahead = s->q * cos(turn);
  ray r = {.sky = &s->sky,
           .cosine = fmax(cos(bearing), 0),
           .near = s->q * fabs(sin(turn)),
           .wide = hypot(ahead, s->along),
           .sign = ahead < 0 ? -1 : 1};
  double sum = 0;
  r.middle = ahead != 0 ? atan(s->along / ahead) : copysign(HR2DI_PI / 2, s->along);
  r.kappa = s->sky.c != 0 ? fmin(fmax(r.near / r.wide, SHARPEST), 1) : 1;
  for (r.side = -1; r.side <= 1; r.side += 2) {
    const double end = asinh((HR2DI_PI / 2 - r.side * r.middle) / r.kappa);
    if (end > 0) sum += hr2di_adaptive_gauss(&s->rule, across, &r, 0, end, s->across);
  }
  return 2 * sum;
}

static double horizontal(const void *ctx, double bearing) {
  return 0.5 * shape_at(ctx, bearing) * cos(bearing);
}

/* Puts those between the horizons in order. */
static int keep(double *bearing, int count) {
  int kept = 0;
  for (int k = 0; k < count; k++) {
    const double at = remainder(bearing[k], 2 * HR2DI_PI);
    int place = kept;
    if (!(fabs(at) < HR2DI_PI / 2)) continue;
    for (; place > 0 && bearing[place - 1] > at; place--) bearing[place] = bearing[place - 1];
    bearing[place] = at;
    kept++;
  }
  return kept;
}

/* The sun, and its opposite. */
static int tips(const hr2di_sky_section *s, double *bearing) {
  if (s->sky.c == 0 || !(s->sky.irradiance > 0) || s->q == 0) return 0;
  bearing[0] = s->bearing;
  bearing[1] = s->bearing + HR2DI_PI;
  return 2;
}

int hr2di_sky_section_breaks(const hr2di_sky_section *s, double bearing[HR2DI_SKY_BREAKS]) {
  int count = tips(s, bearing);
  if (s->disc > 0 && s->sine < s->q)
    for (int side = -1; side <= 1; side += 2)
      bearing[count++] = s->bearing + side * asin(s->sine / s->q);
  if (s->band > 0)
    for (int side = -1; side <= 1; side += 2)
      bearing[count++] = side * (HR2DI_PI / 2 - s->height);
  return keep(bearing, count);
}

/* The irradiance of a horizontal surface by gradation and indicatrix. */
static double irradiance_of_shape(const hr2di_sky_section *s) {
  double at[4], sum = 0, from = -HR2DI_PI / 2;
  const int count = keep(at, tips(s, at));
  at[count] = HR2DI_PI / 2;
  for (int k = 0; k <= count; k++) {
    sum += hr2di_adaptive_gauss(&s->rule, horizontal, s, from, at[k], s->across);
    from = at[k];
  }
  return sum;
}

void hr2di_sky_section_init(hr2di_sky_section *s, const hr2d_sky *sky) {
  const double elevation = sky->sun_elevation * DEGREE,
               turn = fmod(sky->sun_azimuth - sky->section_azimuth, 360) * DEGREE;
  const double x = cos(elevation) * cos(turn), y = sin(elevation);
  *s = (hr2di_sky_section){.sky = *sky,
                           .q = hypot(x, y),
                           .bearing = atan2(x, y),
                           .along = cos(elevation) * sin(turn),
                           .across = ACROSS * hr2di_sky_tolerance(sky)};
  hr2di_rule_init(&s->rule, NODES);
  if (sky->disc_irradiance > 0) {
    s->sine = sin(sky->disc_radius * DEGREE);
    s->disc = sky->disc_irradiance / (HR2DI_PI * s->sine * s->sine);
  }
  if (sky->horizon_irradiance > 0) {
    s->height = sky->horizon_height * DEGREE;
    s->band = sky->horizon_irradiance / (s->height + sin(s->height) * cos(s->height));
  }
  if (sky->irradiance > 0) s->scale = sky->irradiance / irradiance_of_shape(s);
}

/* ∫ cos²β dβ from one angle to another, in [−π/2, π/2]. */
static double squares(double from, double to) {
  const double low = fmax(from, -HR2DI_PI / 2), high = fmin(to, HR2DI_PI / 2);
  return high > low ? 0.5 * (high - low) + 0.5 * sin(high - low) * cos(high + low) : 0;
}

/* The disc has the β for which C cos(β − β₀) is at least the cosine of its radius. */
static double disc_at(const hr2di_sky_section *s, double bearing) {
  const double turn = bearing - s->bearing, near = s->q * fabs(sin(turn));
  const double middle = atan2(s->along, s->q * cos(turn));
  if (!(near < s->sine)) return 0;
  const double half =
      atan2(sqrt((s->sine - near) * (s->sine + near)), sqrt((1 - s->sine) * (1 + s->sine)));
  return squares(middle - half, middle + half);
}

/* The band has the β for which cos β cos φ is at most the sine of its height. */
static double band_at(const hr2di_sky_section *s, double bearing) {
  const double sine = sin(s->height), cosine = cos(bearing);
  if (cosine <= sine) return HR2DI_PI / 2;
  return 2 * squares(acos(sine / cosine), HR2DI_PI / 2);
}

double hr2di_sky_section_at(const hr2di_sky_section *s, double bearing) {
  double sum = 0;
  if (s->scale > 0) sum += s->scale * shape_at(s, bearing);
  if (s->disc > 0) sum += 2 * s->disc * disc_at(s, bearing);
  if (s->band > 0) sum += 2 * s->band * band_at(s, bearing);
  return sum;
}
