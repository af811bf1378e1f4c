/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/pair-kinds.h"

#include <gsl/gsl_math.h>
#include <math.h>

static hr2d_point polar(double length, double angle) {
  return (hr2d_point){length * cos(angle), length * sin(angle)};
}

/* Numbers are drawn one by one, so that the order does not depend on the compiler. */

/* i from 0 to 1, and j of a size between two limits beside it at a distance. */
static occluded_pair beside(randoms *r, const double size[2], double gap, double tilt) {
  const double middle = random_between(r, -0.3, 1.3);
  const hr2d_point half = polar(0.5 * random_between(r, size[0], size[1]), M_PI + tilt);
  const double lift = gap + fabs(half.y);
  return (occluded_pair){
      .i = {{0, 0}, {1, 0}},
      .j = {{middle - half.x, lift - half.y}, {middle + half.x, lift + half.y}}};
}

static const double small[] = {0.3, 1}, any_size[] = {0.3, 2};

static occluded_pair draw_far(randoms *r) {
  const double gap = random_between(r, 3, 5);
  return beside(r, small, gap, random_between(r, -0.5, 0.5));
}

static occluded_pair draw_near(randoms *r) {
  const double gap = random_between(r, 0.3, 1.5), tilt = random_between(r, -0.5, 0.5);
  return beside(r, any_size, gap, tilt);
}

static occluded_pair draw_nearer(randoms *r) {
  const double gap = random_power(r, -1.5, -0.5), tilt = random_between(r, -0.3, 0.3);
  return beside(r, any_size, gap, tilt);
}

static occluded_pair draw_slit(randoms *r) {
  const double gap = random_power(r, -4, -2), tilt = random_between(r, -1e-4, 1e-4);
  return beside(r, any_size, gap, tilt);
}

static occluded_pair touching(randoms *r, double angle) {
  const double ratio = random_power(r, -1, 1);
  if (random_below(r, 2))
    return (occluded_pair){.i = {{0, 0}, {1, 0}}, .j = {polar(ratio, angle), {0, 0}}};
  return (occluded_pair){.i = {{-1, 0}, {0, 0}}, .j = {{0, 0}, polar(ratio, M_PI - angle)}};
}

static occluded_pair draw_touching(randoms *r) {
  const double angle = random_between(r, 10, 179) * M_PI / 180;
  return touching(r, angle);
}

static occluded_pair draw_wedge(randoms *r) {
  const double angle = random_power(r, -1, 1) * M_PI / 180;
  return touching(r, angle);
}

/* Side by side, each hardly in front of the other. */
static occluded_pair draw_coplanar(randoms *r) {
  const double from = 1 + random_power(r, -2, 0), length = random_power(r, -1, 0.5);
  const double low = random_power(r, -5, -2), rise = random_power(r, -5, -2);
  return (occluded_pair){.i = {{0, 0}, {1, 0}},
                         .j = {{from, low}, {from + length, low + rise}}};
}

static occluded_pair draw_clipped(randoms *r) {
  const double x = random_between(r, 1.05, 2), low = -random_power(r, -2, 0);
  const double high = random_power(r, -2, 0), lean = random_between(r, -0.5, 1);
  return (occluded_pair){.i = {{0, 0}, {1, 0}},
                         .j = {{x, low}, {x + lean * (high - low), high}}};
}

static hr2d_segment small_wall(randoms *r) {
  const double x = random_between(r, 0, 1), y = random_between(r, 0.2, 0.8);
  const double length = random_between(r, 0.02, 0.12), angle = random_between(r, 0, M_PI);
  const hr2d_point half = polar(length, angle);
  return (hr2d_segment){{x - half.x, y - half.y}, {x + half.x, y + half.y}};
}

/* Two that face each other with small walls between them. */
static occluded_pair draw_shaded(randoms *r) {
  const double from = random_between(r, -0.5, 0.3), to = 1 + random_between(r, -0.5, 0.5);
  occluded_pair p = {.i = {{0, 0}, {1, 0}}, .j = {{to, 1}, {from, 1}}};
  for (size_t walls = 1 + (size_t)random_below(r, 4); walls > 0; walls--)
    p.occluder[p.count++] = small_wall(r);
  return p;
}

static hr2d_point on_grid(randoms *r, int columns, int rows) {
  const int x = random_below(r, columns + 1), y = random_below(r, rows + 1);
  return (hr2d_point){x / 8.0, y / 8.0};
}

/* Points of a coarse grid, so that many are collinear and many walls touch. */
static occluded_pair draw_grid(randoms *r) {
  const hr2d_point c = on_grid(r, 6, 1), d = on_grid(r, 3, 2);
  occluded_pair p = {.i = {{0, 0}, {1, 0}}, .j = {{0.5 + c.x, 1}, {d.x, 0.875 + d.y}}};
  for (size_t walls = 1 + (size_t)random_below(r, 4); walls > 0; walls--) {
    const hr2d_point a = on_grid(r, 8, 5), b = on_grid(r, 8, 6);
    const double top = a.x == b.x && a.y == b.y ? 1 : 0.125 + b.y;
    p.occluder[p.count++] = (hr2d_segment){{a.x, 0.125 + a.y}, {b.x, top}};
  }
  return p;
}

const pair_kind pair_kinds[] = {
    {"far", draw_far, 16},
    {"near", draw_near, 16},
    {"nearer", draw_nearer, 24},
    {"slits", draw_slit, 48},
    {"touching", draw_touching, 16},
    {"in a wedge", draw_wedge, 32},
    {"coplanar but for a little", draw_coplanar, 32},
    {"behind a horizon", draw_clipped, 32},
    {"shaded", draw_shaded, 16},
    {"on a grid", draw_grid, 24},
};

const size_t pair_kind_count = sizeof pair_kinds / sizeof *pair_kinds;
