/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Viridis as polynomials of degree 6 (Zucker's fit), within 0.015 of the published table. */
#include "output/palette.h"

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

colour palette_ember(double t) {
  t = clamp(t);
  return (colour){0.97 - 0.50 * t, 0.62 * (1 - t) * (1 - t) + 0.02, 0.28 * (1 - t) + 0.10 * t};
}
