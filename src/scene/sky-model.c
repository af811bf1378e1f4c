/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The CIE standard general sky (ISO 15469:2004, table 1), the all-weather model (Perez, Seals,
   Michalsky, Solar Energy 50, 1993, table 1, with the erratum in 51, p. 423), and what is valid
   of a sky. */
#include "scene/sky-model.h"

#include <math.h>

#include "base/pi.h"
#include "base/sized-struct.h"

#define DEGREE (HR2DI_PI / 180)

/* a, b, c, d, e */
static const double cie[15][5] = {
    {4, -0.7, 0, -1, 0},        {4, -0.7, 2, -1.5, 0.15},  {1.1, -0.8, 0, -1, 0},
    {1.1, -0.8, 2, -1.5, 0.15}, {0, -1, 0, -1, 0},         {0, -1, 2, -1.5, 0.15},
    {0, -1, 5, -2.5, 0.3},      {0, -1, 10, -3, 0.45},     {-1, -0.55, 2, -1.5, 0.15},
    {-1, -0.55, 5, -2.5, 0.3},  {-1, -0.55, 10, -3, 0.45}, {-1, -0.32, 10, -3, 0.45},
    {-1, -0.32, 16, -3, 0.3},   {-1, -0.15, 16, -3, 0.3},  {-1, -0.15, 24, -2.8, 0.15}};

/* Of each clearness: x_1 to x_4 for a, b, c, d and e. */
static const double perez[8][5][4] = {{{1.3525, -0.2576, -0.2690, -1.4366},
                                       {-0.7670, 0.0007, 1.2734, -0.1233},
                                       {2.8000, 0.6004, 1.2375, 1.0000},
                                       {1.8734, 0.6297, 0.9738, 0.2809},
                                       {0.0356, -0.1246, -0.5718, 0.9938}},
                                      {{-1.2219, -0.7730, 1.4148, 1.1016},
                                       {-0.2054, 0.0367, -3.9128, 0.9156},
                                       {6.9750, 0.1774, 6.4477, -0.1239},
                                       {-1.5798, -0.5081, -1.7812, 0.1080},
                                       {0.2624, 0.0672, -0.2190, -0.4285}},
                                      {{-1.1000, -0.2515, 0.8952, 0.0156},
                                       {0.2782, -0.1812, -4.5000, 1.1766},
                                       {24.7219, -13.0812, -37.7000, 34.8438},
                                       {-5.0000, 1.5218, 3.9229, -2.6204},
                                       {-0.0156, 0.1597, 0.4199, -0.5562}},
                                      {{-0.5484, -0.6654, -0.2672, 0.7117},
                                       {0.7234, -0.6219, -5.6812, 2.6297},
                                       {33.3389, -18.3000, -62.2500, 52.0781},
                                       {-3.5000, 0.0016, 1.1477, 0.1062},
                                       {0.4659, -0.3296, -0.0876, -0.0329}},
                                      {{-0.6000, -0.3566, -2.5000, 2.3250},
                                       {0.2937, 0.0496, -5.6812, 1.8415},
                                       {21.0000, -4.7656, -21.5906, 7.2492},
                                       {-3.5000, -0.1554, 1.4062, 0.3988},
                                       {0.0032, 0.0766, -0.0656, -0.1294}},
                                      {{-1.0156, -0.3670, 1.0078, 1.4051},
                                       {0.2875, -0.5328, -3.8500, 3.3750},
                                       {14.0000, -0.9999, -7.1406, 7.5469},
                                       {-3.4000, -0.1078, -1.0750, 1.5702},
                                       {-0.0672, 0.4016, 0.3017, -0.4844}},
                                      {{-1.0000, 0.0211, 0.5025, -0.5119},
                                       {-0.3000, 0.1922, 0.7023, -1.6317},
                                       {19.0000, -5.0000, 1.2438, -1.9094},
                                       {-4.0000, 0.0250, 0.3844, 0.2656},
                                       {1.0468, -0.3788, -2.4517, 1.4656}},
                                      {{-1.0500, 0.0289, 0.4260, 0.3590},
                                       {-0.3250, 0.1156, 0.7781, 0.0025},
                                       {31.0625, -14.5000, -46.1148, 55.3750},
                                       {-7.2312, 0.4050, 13.3500, 0.6234},
                                       {1.5000, -0.6426, 1.8564, 0.5636}}};

static const double clearness_from[8] = {1, 1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};

hr2d_status hr2di_sky_copy(hr2d_sky *to, const hr2d_sky *from) {
  *to = (hr2d_sky)HR2D_SKY_INIT;
  return hr2di_sized_copy(to, sizeof *to, from);
}

/* Writes back what fits into the caller's struct. */
static void give(hr2d_sky *to, const hr2d_sky *sky) {
  const size_t size = to->struct_size;
  memcpy(to, sky, size < sizeof *sky ? size : sizeof *sky);
  to->struct_size = size;
}

hr2d_status hr2d_sky_cie(int type, hr2d_sky *sky) {
  hr2d_sky all;
  if (!sky || type < 1 || type > 16 || hr2di_sky_copy(&all, sky)) return HR2D_EINVAL;
  const double *x = cie[type < 16 ? type - 1 : 4];
  all.a = x[0];
  all.b = x[1];
  all.c = x[2];
  all.d = x[3];
  all.e = x[4];
  all.g = type < 16 ? 0 : 2;
  give(sky, &all);
  return HR2D_OK;
}

/* x_1 + x_2 Z + Δ (x_3 + x_4 Z) but for c and d of the first clearness. */
static void coefficients(const double (*x)[4], int first, double zenith, double delta,
                         double *value) {
  for (int k = 0; k < 5; k++)
    value[k] = x[k][0] + x[k][1] * zenith + delta * (x[k][2] + x[k][3] * zenith);
  if (!first) return;
  value[2] = exp(pow(delta * (x[2][0] + x[2][1] * zenith), x[2][2])) - x[2][3];
  value[3] = x[3][2] + delta * x[3][3] - exp(delta * (x[3][0] + x[3][1] * zenith));
}

/* 1 + c exp(dχ) + e cos² χ = k (1 + c/k (exp(dχ) − exp(dπ/2)) + e/k cos² χ) with
   k = 1 + c exp(dπ/2). */
hr2d_status hr2d_sky_perez(double clearness, double brightness, hr2d_sky *sky) {
  hr2d_sky all;
  double x[5];
  int bin = 7;
  if (!sky || !(clearness >= 1) || !(brightness >= 0) || !isfinite(clearness) ||
      !isfinite(brightness) || hr2di_sky_copy(&all, sky) ||
      !(all.sun_elevation >= 0 && all.sun_elevation <= 90))
    return HR2D_EINVAL;
  while (clearness < clearness_from[bin]) bin--;
  coefficients(perez[bin], bin == 0, (90 - all.sun_elevation) * DEGREE, brightness, x);
  const double k = 1 + x[2] * exp(x[3] * HR2DI_PI / 2);
  if (!(k > 0)) return HR2D_ESCENE;
  all.a = x[0];
  all.b = x[1];
  all.g = 0;
  all.c = x[2] / k;
  all.d = x[3];
  all.e = x[4] / k;
  if (hr2di_sky_problem(&all)) return HR2D_ESCENE;
  give(sky, &all);
  return HR2D_OK;
}

double hr2d_sky_clearness(double diffuse, double direct, double extraterrestrial,
                          double sun_elevation, double *brightness) {
  const int valid = diffuse > 0 && direct >= 0 && extraterrestrial > 0 && sun_elevation >= 0 &&
                    sun_elevation <= 90 && isfinite(diffuse) && isfinite(direct);
  const double zenith = (90 - sun_elevation) * DEGREE, cube = 1.041 * zenith * zenith * zenith,
               mass = 1 / (cos(zenith) + 0.15 * pow(3.885 + sun_elevation, -1.253));
  if (brightness) *brightness = valid ? mass * diffuse / extraterrestrial : NAN;
  return valid ? 1 + direct / diffuse / (1 + cube) : NAN;
}

double hr2di_sky_tolerance(const hr2d_sky *sky) {
  return sky->tolerance > 0 ? sky->tolerance : HR2DI_SKY_TOLERANCE;
}

double hr2di_sky_shape(const hr2d_sky *sky, double cos_zenith, double chi) {
  const double cosine = cos(chi);
  double gradation = 1 + sky->g * cos_zenith, indicatrix = 1 + sky->e * cosine * cosine;
  if (sky->a != 0) {
    const double none = sky->b < 0 ? 0 : 1;
    gradation += sky->a * (cos_zenith > 0 ? exp(sky->b / cos_zenith) : none);
  }
  if (sky->c != 0) indicatrix += sky->c * (exp(sky->d * chi) - exp(sky->d * (HR2DI_PI / 2)));
  return gradation * indicatrix;
}

enum { STEPS = 512 };

static int is_negative(double value) {
  return !(value >= 0 && isfinite(value));
}

/* Without g it is monotonic from the horizon to the zenith. */
static int is_gradation_negative(const hr2d_sky *sky) {
  hr2d_sky alone = *sky;
  alone.c = alone.e = 0;
  for (int k = 0; k <= STEPS; k++)
    if (is_negative(hr2di_sky_shape(&alone, (double)k / STEPS, 0))) return 1;
  return 0;
}

/* The sky is up to π − γ_s from the sun. */
static int is_indicatrix_negative(const hr2d_sky *sky) {
  hr2d_sky alone = *sky;
  const double end = (180 - sky->sun_elevation) * DEGREE;
  alone.a = alone.g = 0;
  for (int k = 0; k <= STEPS; k++)
    if (is_negative(hr2di_sky_shape(&alone, 1, end * k / STEPS))) return 1;
  return 0;
}

static int is_number(double x, double from, double to) {
  return x >= from && x <= to && isfinite(x);
}

const char *hr2di_sky_problem(const hr2d_sky *sky) {
  const double parts[] = {sky->irradiance, sky->disc_irradiance, sky->horizon_irradiance};
  for (int k = 0; k < 3; k++)
    if (!is_number(parts[k], 0, HUGE_VAL)) return "an irradiance is no number of 0 or more";
  if (!is_number(sky->sun_elevation, 0, 90)) return "the elevation of the sun is not in [0,90]";
  if (!isfinite(sky->sun_azimuth) || !isfinite(sky->section_azimuth))
    return "an azimuth is not finite";
  if (sky->disc_irradiance > 0 && !(sky->disc_radius > 0 && sky->disc_radius <= 90))
    return "the radius of the disc is not in (0,90]";
  if (sky->horizon_irradiance > 0 && !(sky->horizon_height > 0 && sky->horizon_height <= 90))
    return "the height of the band at the horizon is not in (0,90]";
  if (sky->tolerance != 0 && !is_number(sky->tolerance, HR2DI_SKY_TOLERANCE, 0.01))
    return "the tolerance is not in [1e-12,0.01]";
  if (sky->a != 0 && sky->b > 0) return "b is above 0: the horizon is bright without bounds";
  if (is_gradation_negative(sky)) return "the gradation is negative somewhere, or not finite";
  if (is_indicatrix_negative(sky)) return "the indicatrix is negative somewhere, or not finite";
  return NULL;
}
