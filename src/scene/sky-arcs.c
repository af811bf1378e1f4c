/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With φ from the normal n of a patch towards its end, a point gets ½∫ L cos φ dφ from an arc
   of the sky.  Bearings turn clockwise, as the end is from n: the bearing of a direction is φ
   and that of n.

   Of a constant L that is ½ L Δ sin φ.  Of a polynomial it is this times the mean of L with the
   weight cos φ, by a Gauss rule: L cos φ of degree 15 on an arc of up to π is exact to 1e-16
   with 17 nodes, and the sines of the arc keep all their digits where it is narrow. */
#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "scene/scene-impl.h"
#include "scene/sky.h"

void hr2di_sky_clear(hr2di_sky *sky, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, sky->piece);
  hr2di_alloc_free(alloc, sky->value);
  hr2di_alloc_free(alloc, sky->goes_on);
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

void hr2di_scene_take_sky(hr2d_scene *scene, const hr2di_sky *sky) {
  hr2di_sky_clear(&scene->sky, &scene->alloc);
  scene->sky = *sky;
  hr2di_basis_init(&scene->sky.of.basis, sky->terms);
  if (sky->terms > 1) hr2di_rule_init(&scene->sky.of.rule, HR2DI_SKY_TERMS / 2 + 10);
}

void hr2di_sky_terms_at(const hr2di_sky *sky, size_t piece, double bearing, double *phi) {
  const hr2d_sky_piece arc = sky->piece[piece];
  const double part = hr2di_sky_turned(bearing - arc.from) / (arc.to - arc.from);
  hr2di_basis_at(&sky->of.basis, 2 * part - 1, phi);
}

/* sin φ of a bearing in front of a patch whose normal has the bearing `normal`. */
static double sine_of(hr2d_segment s, double length, double bearing) {
  const hr2d_point e = hr2di_sky_direction(bearing);
  return fmin(fmax((e.x * (s.b.x - s.a.x) + e.y * (s.b.y - s.a.y)) / length, -1), 1);
}

/* Adds the factors of the angles between two sines that are in part k. */
static void add_part(const hr2di_sky_front *front, const hr2di_sky_terms *terms, int k,
                     double low, double high, double *factor) {
  const double half = 0.5 * (asin(high) - asin(low)), middle = asin(low) + half;
  double phi[HR2DI_SKY_TERMS], sum[HR2DI_SKY_TERMS] = {0}, all = 0;
  for (size_t q = 0; q < terms->rule.points; q++) {
    const double angle = middle + half * terms->rule.at[q],
                 weight = terms->rule.weight[q] * cos(angle);
    all += weight;
    hr2di_basis_at(&terms->basis, 2 * (angle - front->from[k]) / front->size - 1, phi);
    for (size_t l = 0; l < terms->basis.order; l++) sum[l] += weight * phi[l];
  }
  for (size_t l = 0; l < terms->basis.order && all > 0; l++)
    factor[l] += 0.5 * (high - low) * sum[l] / all;
}

static void add_factors(const hr2di_sky_front *front, const hr2di_sky_terms *terms, double low,
                        double high, double *factor) {
  double sum = 0;
  for (int k = 0; k < front->parts; k++) {
    const double from = fmax(front->part[k].low, low), to = fmin(front->part[k].high, high);
    sum += fmax(to - from, 0);
    if (to > from && terms->basis.order > 1) add_part(front, terms, k, from, to, factor);
  }
  if (terms->basis.order == 1) factor[0] += 0.5 * sum;
}

void hr2di_sky_add_factors(const hr2di_sky *sky, const hr2di_sky_front *front, double low,
                           double high, double *factor) {
  int inside = 1;
  for (int k = 0; k < front->parts; k++)
    inside &= low <= front->part[k].low && front->part[k].high <= high;
  if (!inside)
    add_factors(front, &sky->of, low, high, factor);
  else
    for (size_t l = 0; l < sky->terms && front->parts > 0; l++) factor[l] += front->full[l];
}

void hr2di_sky_front_of(const hr2d_scene *scene, size_t patch, size_t piece,
                        hr2di_sky_front *front) {
  const hr2di_patch *p = &scene->patch[patch];
  const hr2d_segment s = p->scaled;
  const hr2d_sky_piece arc = scene->sky.piece[piece];
  const double normal = atan2(-(s.b.y - s.a.y), s.b.x - s.a.x) * (180 / HR2DI_PI);
  const double first = hr2di_sky_turned(arc.from - normal + 90) - 90; /* in [−90, 270) */
  const double last = first + (arc.to - arc.from);
  *front = (hr2di_sky_front){.size = (arc.to - arc.from) * (HR2DI_PI / 180)};
  for (double turn = 0; turn <= 360; turn += 360) {
    const double low = first - turn, high = last - turn;
    if (low >= 90 || high <= -90) continue;
    front->from[front->parts] = low * (HR2DI_PI / 180);
    front->part[front->parts++] =
        (hr2di_sines){low <= -90 ? -1 : sine_of(s, p->length, arc.from),
                      high >= 90 ? 1 : sine_of(s, p->length, arc.to)};
  }
  add_factors(front, &scene->sky.of, -1, 1, front->full);
}
