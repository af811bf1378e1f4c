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
  const double max = m->furnace ? 1 - reflectance : 1;
  const unsigned b = fuzz_byte(m->in);
  if (!m->furnace && b > 250) return ldexp(1, ((int)b - 253) * 300);
  return b & 1 ? max : b & 2 ? 0 : max * fuzz_unit(m->in);
}

/* Names as programs may give them: cut characters, Latin-1, surrogates, what a terminal obeys,
   and one that is far longer than a message. */
static const char *some_name(unsigned choice) {
  static const char *const odd[] = {"wall",         "\xC3",          "W\xE4nde \xA0\xA0\xA0",
                                    "\xED\xA0\x80", "\033[2J\r\n\t", "\xF0\x9F\x8F\xA0"};
  static char tall[4000];
  const size_t kinds = sizeof odd / sizeof *odd;
  if (choice % (kinds + 1) < kinds) return odd[choice % (kinds + 1)];
  for (size_t k = 0; k + 3 < sizeof tall; k += 3) memcpy(tall + k, "\xE2\x82\xAC", 3);
  return tall;
}

/* A name that is not UTF-8 is refused, and said so in UTF-8; the patch gets none then. */
static void check_name(hr2d_scene *scene, hr2d_patch *patch) {
  if (!patch->name || fuzz_is_utf8(patch->name)) return;
  REQUIRE(hr2d_scene_add(scene, patch, NULL) == HR2D_ESCENE);
  fuzz_check_message(hr2d_scene_message(scene));
  patch->name = NULL;
}

/* Ignores refusals: the scene goes on with the patches that the library accepts. */
static void add(maker *m, hr2d_scene *scene, hr2d_point a, hr2d_point b) {
  double rho[BANDS], e[BANDS];
  const unsigned how = fuzz_byte(m->in);
  for (size_t k = 0; k < m->bands; k++) {
    rho[k] = fuzz_unit(m->in);
    e[k] = emission(m, rho[k]);
  }
  hr2d_patch patch = {.a = a,
                      .b = b,
                      .name = how & 64 ? some_name(how >> 1 & 7) : NULL,
                      .emission = e,
                      .emission_bands = how & 8 && !m->furnace ? 1 : m->bands,
                      .reflectance = rho,
                      .reflectance_bands = m->bands,
                      .sides = how & 1 ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT};
  const size_t before = hr2d_scene_patches(scene);
  check_name(scene, &patch);
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

/* How far the patches reach along a direction. */
static void extent(const hr2d_scene *scene, hr2d_point d, double e[2]) {
  e[0] = HUGE_VAL;
  e[1] = -HUGE_VAL;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    const double a = d.x * s.a.x + d.y * s.a.y, b = d.x * s.b.x + d.y * s.b.y;
    e[0] = fmin(e[0], fmin(a, b));
    e[1] = fmax(e[1], fmax(a, b));
  }
}

/* Mostly an axis; others are not rounded alike. */
static hr2d_point some_direction(maker *m) {
  const unsigned b = fuzz_byte(m->in);
  const double angle = b & 3 ? 0 : fuzz_unit(m->in) * 3;
  const hr2d_point d = {cos(angle), sin(angle)};
  return b & 4 ? (hr2d_point){-d.y, d.x} : d;
}

/* Beside all patches: at the first one, some roundings or a distance from there, or across
   them, which commit refuses. */
static void add_mirror(maker *m, hr2d_scene *scene, hr2d_point normal) {
  double e[2];
  extent(scene, normal, e);
  const unsigned b = fuzz_byte(m->in);
  double at = e[b & 1];
  if (b & 2) at = nudged(at, (int)(b >> 5) - 4);
  if ((b & 28) == 4) at += (b & 1 ? 1 : -1) * fuzz_unit(m->in) * (e[1] - e[0]);
  if ((b & 28) == 8) at = e[0] + fuzz_unit(m->in) * (e[1] - e[0]);
  const double far = fuzz_unit(m->in) * (e[1] - e[0]);
  const hr2d_point p = {at * normal.x, at * normal.y};
  const hr2d_segment line = {{p.x - far * normal.y, p.y + far * normal.x},
                             {p.x + (e[1] - e[0]) * normal.y, p.y - (e[1] - e[0]) * normal.x}};
  if (getenv("FUZZ_VERBOSE"))
    fprintf(stderr, "mirror %a %a %a %a\n", line.a.x, line.a.y, line.b.x, line.b.y);
  if (hr2d_scene_add_mirror(scene, line)) fuzz_check_message(hr2d_scene_message(scene));
}

/* As long as the cell, about as long, longer, or so short that images overlap. */
static void set_period(maker *m, hr2d_scene *scene, hr2d_point along) {
  static const double parts[] = {1, 1, 1, 1.25, 2, 8, .5, .25};
  double e[2];
  extent(scene, along, e);
  const unsigned b = fuzz_byte(m->in);
  double size = (e[1] - e[0]) * parts[b & 7];
  if (b & 8) size = nudged(size, (int)(b >> 5) - 4);
  const hr2d_point period = {size * along.x, size * along.y};
  if (getenv("FUZZ_VERBOSE")) fprintf(stderr, "period %a %a\n", period.x, period.y);
  if (hr2d_scene_set_period(scene, period)) fuzz_check_message(hr2d_scene_message(scene));
}

static void add_symmetry(maker *m, hr2d_scene *scene) {
  const unsigned how = fuzz_byte(m->in);
  const hr2d_point along = some_direction(m), across = {-along.y, along.x};
  if (!hr2d_scene_patches(scene)) return;
  if (how & 1) add_mirror(m, scene, along);
  if (how & 2) add_mirror(m, scene, across);
  if ((how & 12) == 12) add_mirror(m, scene, how & 64 ? some_direction(m) : along);
  if (how & 16) set_period(m, scene, how & 32 ? across : along);
}

/* Suns that shine along lines of two points, and a sky of two pieces.  They follow from the
   bytes to come, and take none of them. */
static void add_daylight(const maker *m, hr2d_scene *scene) {
  static const double irradiance[] = {1, 0, 0x1p-1000, 0x1p300};
  const uint64_t hash = fuzz_hash_bytes(m->in->at, (size_t)(m->in->end - m->in->at));
  const hr2d_point p = m->point[(hash >> 8) % m->points],
                   q = m->point[(hash >> 16) % m->points];
  const hr2d_sun sun = {{q.x - p.x, q.y - p.y}, irradiance[hash >> 24 & 3]};
  const double from = (double)(hash >> 32 & 255) - 128, value[] = {1, 0.5};
  const hr2d_sky_piece sky[] = {{from, from + 90}, {from + 90, from + 91}};
  if (hash & 1 && hr2d_scene_set_sun(scene, &sun, 1))
    fuzz_check_message(hr2d_scene_message(scene));
  if (hash & 2 && hr2d_scene_set_sky(scene, sky, 2, value, 1))
    fuzz_check_message(hr2d_scene_message(scene));
}

void fuzz_fill_scene(fuzz_input *in, hr2d_scene *scene, size_t max) {
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
  for (unsigned k = fuzz_below(in, 12); k > 0 && hr2d_scene_patches(scene) + 8 < max; k--)
    add_chain(&m, scene);
  if (how & 32)
    add_symmetry(&m, scene);
  else if (how & 64 && m.points)
    add_daylight(&m, scene);
}
