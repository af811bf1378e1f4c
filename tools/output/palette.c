/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Viridis and inferno as polynomials of degree 6 (Zucker's fits), within 0.015 of the published
   tables. */
#include "output/palette.h"

#include <math.h>

static double clamp(double t) {
  return t > 0 ? (t < 1 ? t : 1) : 0;
}

static double polynomial(const double c[7], double t) {
  double value = c[6];
  for (int k = 5; k >= 0; k--) value = value * t + c[k];
  return clamp(value);
}

colour palette_viridis(double t) {
  static const double red[] = {0.2777273272234177, 0.1050930431085774, -0.3308618287255563,
                               -4.634230498983486, 6.228269936347081,  4.776384997670288,
                               -5.435455855934631};
  static const double green[] = {0.005407344544966578, 1.404613529898575, 0.214847559468213,
                                 -5.799100973351585,   14.17993336680509, -13.74514537774601,
                                 4.645852612178535};
  static const double blue[] = {0.3340998053353061, 1.384590162594685, 0.09509516302823659,
                                -19.33244095627987, 56.69055260068105, -65.35303263337234,
                                26.3124352495832};
  t = clamp(t);
  return (colour){polynomial(red, t), polynomial(green, t), polynomial(blue, t)};
}

colour palette_inferno(double t) {
  static const double red[] = {0.0002189403691192265, 0.1065134194856116, 11.60249308247187,
                               -41.70399613139459,    77.162935699427,    -71.31942824499214,
                               25.13112622477341};
  static const double green[] = {0.001651004631001012, 0.5639564367884091, -3.972853965665698,
                                 17.43639888205313,    -33.40235894210092, 32.62606426397723,
                                 -12.24266895238567};
  static const double blue[] = {-0.01948089843709184, 3.932712388889277,  -15.9423941062914,
                                44.35414519872813,    -81.80730925738993, 73.20951985803202,
                                -23.07032500287172};
  t = clamp(t);
  return (colour){polynomial(red, t), polynomial(green, t), polynomial(blue, t)};
}

/* IEC 61966-2-1. */
double palette_srgb(double linear) {
  const double x = clamp(linear);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

colour palette_ember(double t) {
  t = clamp(t);
  return (colour){0.97 - 0.50 * t, 0.62 * (1 - t) * (1 - t) + 0.02, 0.28 * (1 - t) + 0.10 * t};
}
