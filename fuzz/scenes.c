/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes scenes from bytes.  Random coordinates would hardly ever touch, align or meet within
   a rounding.  So most points repeat coordinates of an earlier point, sometimes slightly
   moved. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

enum { POINTS = 64, BANDS = 3 };

typedef struct maker {
  fuzz_input *in;
  hr2d_point point[POINTS]; /* those used before */
  size_t points;
  int exponent; /* of the scale */
  double offset;
  int furnace; /* E = 1 − ρ at most */
  size_t bands;
} maker;

static double nudged(double x, int ulps) {
  for (; ulps > 0; ulps--) x = nextafter(x, HUGE_VAL);
  for (; ulps < 0; ulps++) x = nextafter(x, -HUGE_VAL);
  return x;
}

static double fresh(maker *m) {
  const unsigned b = fuzz_byte(m->in);
  const double grid = ((int)(b & 15) - 8) / 8.0;
  switch (b >> 6) {
  case 0:
  case 1:
    return m->offset + ldexp(grid, m->exponent);
  case 2:
    return m->offset + ldexp(grid + fuzz_unit(m->in) / 16, m->exponent);
  default:
    return b & 32 ? fuzz_finite(m->in) : ldexp(grid, -(int)fuzz_below(m->in, 60));
  }
}

static hr2d_point earlier(maker *m) {
  return m->point[fuzz_byte(m->in) % m->points];
}

static hr2d_point on_line(maker *m) {
  const hr2d_point p = earlier(m), q = earlier(m);
  const double t = fuzz_unit(m->in);
  return (hr2d_point){p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
}

static hr2d_point next_point(maker *m) {
  hr2d_point p = {0, 0};
  const unsigned kind = m->points ? fuzz_below(m->in, 8) : 0;
  if (kind < 3) {
    p.x = fresh(m);
    p.y = fresh(m);
  } else if (kind < 6) {
    p = kind == 5 ? on_line(m) : earlier(m);
    if (kind == 4) {
      p.x = nudged(p.x, (int)fuzz_below(m->in, 9) - 4);
      p.y = nudged(p.y, (int)fuzz_below(m->in, 9) - 4);
    }
  } else {
    p = (hr2d_point){earlier(m).x, kind == 6 ? fresh(m) : earlier(m).y};
  }
  m->point[m->points++ % POINTS] = p;
  if (m->points > POINTS) m->points = POINTS;
  return p;
}

static double emission(maker *m, double reflectance) {
  const double most = m->furnace ? 1 - reflectance : 1;
  const unsigned b = fuzz_byte(m->in);
  if (!m->furnace && b > 250) return ldexp(1, ((int)b - 253) * 300);
  return b & 1 ? most : b & 2 ? 0 : most * fuzz_unit(m->in);
}

/* Ignores refusals: the scene goes on with the patches that the library accepts. */
static void add(maker *m, hr2d_scene *scene, hr2d_point a, hr2d_point b) {
  double rho[BANDS], e[BANDS];
  const unsigned how = fuzz_byte(m->in);
  for (size_t k = 0; k < m->bands; k++) {
    rho[k] = fuzz_unit(m->in);
    e[k] = emission(m, rho[k]);
  }
  const hr2d_patch patch = {.a = a,
                            .b = b,
                            .name = how & 64 ? "wall" : NULL,
                            .emission = e,
                            .emission_bands = how & 8 && !m->furnace ? 1 : m->bands,
                            .reflectance = rho,
                            .reflectance_bands = m->bands,
                            .sides = how & 1 ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT};
  const size_t before = hr2d_scene_patches(scene);
  if (getenv("FUZZ_VERBOSE"))
    fprintf(stderr, "%zu: %a %a %a %a sides %d rho %.17g E %.17g\n", before, a.x, a.y, b.x, b.y,
            patch.sides, rho[0], e[0]);
  if (hr2d_scene_add(scene, &patch, NULL)) {
    fuzz_check_message(hr2d_scene_message(scene));
    REQUIRE(hr2d_scene_patches(scene) == before);
  }
}

/* A closed room, so that light has somewhere to go. */
static void add_room(maker *m, hr2d_scene *scene) {
  static const double corner[][2] = {{-1, -1}, {1, -1}, {1, .5}, {0, 1}, {-1, .5}};
  const unsigned corners = 3 + fuzz_below(m->in, 3);
  hr2d_point at[5];
  for (unsigned k = 0; k < corners; k++) {
    at[k] = (hr2d_point){m->offset + ldexp(corner[k][0], m->exponent),
                         m->offset + ldexp(corner[k][1], m->exponent)};
    m->point[m->points++] = at[k];
  }
  for (unsigned k = 0; k < corners; k++) add(m, scene, at[k], at[(k + 1) % corners]);
}

static void add_chain(maker *m, hr2d_scene *scene) {
  const unsigned links = 1 + fuzz_below(m->in, 4);
  hr2d_point a = next_point(m);
  for (unsigned k = 0; k < links; k++) {
    const hr2d_point b = next_point(m);
    add(m, scene, a, b);
    a = b;
  }
}

static void add_background(maker *m, hr2d_scene *scene) {
  double background[BANDS];
  for (size_t k = 0; k < m->bands; k++) background[k] = fuzz_unit(m->in);
  const hr2d_status status = hr2d_scene_set_background(scene, background, m->bands);
  REQUIRE(status == HR2D_OK || status == HR2D_ENOMEM);
}

void fuzz_fill_scene(fuzz_input *in, hr2d_scene *scene, size_t most) {
  static const int exponents[] = {0, 0, 0, 0, 20, -20, 100, -100, 340, -340, 500, -500};
  static const double offsets[] = {0, 0, 0, 0, 0, 1, 1e8, 1e15};
  const unsigned how = fuzz_byte(in);
  maker m = {.in = in,
             .exponent = exponents[fuzz_below(in, sizeof exponents / sizeof *exponents)],
             .furnace = how & 1,
             .bands = how & 16 ? 1 + fuzz_below(in, BANDS) : 1};
  m.offset = ldexp(offsets[fuzz_below(in, sizeof offsets / sizeof *offsets)], m.exponent);
  if (how & 2) add_background(&m, scene);
  if (how & 4) add_room(&m, scene);
  for (unsigned k = fuzz_below(in, 12); k > 0 && hr2d_scene_patches(scene) + 8 < most; k--)
    add_chain(&m, scene);
}
