/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/short-rooms.h"

#include <math.h>

#include "support/support.h"

#define SHORTEST 0x1p-20
#define PI       3.14159265358979323846

typedef struct outline {
  size_t count;
  double at[SHORT_ROOM_PATCHES][2];
} outline;

/* 2^-1 to 2^-20, most of them short. */
static double draw_length(unsigned long *state) {
  const int exponent = -(int)(20 * test_random(state));
  return ldexp(0.5 + 0.5 * test_random(state), exponent);
}

static double length_of(const outline *o, size_t k) {
  const double *a = o->at[k], *b = o->at[(k + 1) % o->count];
  return hypot(b[0] - a[0], b[1] - a[1]);
}

static void insert(outline *o, size_t behind, double x, double y) {
  if (o->count >= SHORT_ROOM_PATCHES) return;
  for (size_t k = o->count; k > behind + 1; k--)
    for (int c = 0; c < 2; c++) o->at[k][c] = o->at[k - 1][c];
  o->at[behind + 1][0] = x;
  o->at[behind + 1][1] = y;
  o->count++;
}

/* A point of side k, `part` of it from its start. */
static void point_on(const outline *o, size_t k, double part, double *at) {
  const double *a = o->at[k], *b = o->at[(k + 1) % o->count];
  for (int c = 0; c < 2; c++)
    at[c] = part < 0.5 ? a[c] + part * (b[c] - a[c]) : b[c] + (1 - part) * (a[c] - b[c]);
}

/* Divides a side near one of its ends. */
static void add_strip(outline *o, unsigned long *state) {
  const size_t k = (size_t)(test_random(state) * (double)o->count);
  const double part = 0.5 * draw_length(state);
  double at[2];
  if (part * length_of(o, k) < SHORTEST) return;
  point_on(o, k, test_random(state) < .5 ? part : 1 - part, at);
  insert(o, k, at[0], at[1]);
}

/* Cuts a corner off, unless what is left would be too short. */
static void cut_corner(outline *o, unsigned long *state) {
  const size_t k = (size_t)(test_random(state) * (double)o->count);
  const size_t before = (k + o->count - 1) % o->count;
  const double size = 0.4 * draw_length(state) * fmin(length_of(o, before), length_of(o, k));
  const double skew = 0.3 + 0.7 * test_random(state);
  double first[2], second[2];
  if (o->count >= SHORT_ROOM_PATCHES || skew * size < SHORTEST) return;
  point_on(o, before, 1 - size / length_of(o, before), first);
  point_on(o, k, skew * size / length_of(o, k), second);
  for (int c = 0; c < 2; c++) o->at[k][c] = first[c];
  insert(o, k, second[0], second[1]);
}

static outline draw_polygon(unsigned long *state) {
  outline o = {.count = 3 + (size_t)(3 * test_random(state))};
  const double turn = test_random(state), flat = 0.3 + 0.7 * test_random(state);
  for (size_t k = 0; k < o.count; k++) {
    const double angle =
        2 * PI * (turn + ((double)k + 0.4 * test_random(state)) / (double)o.count);
    o.at[k][0] = cos(angle);
    o.at[k][1] = flat * sin(angle);
  }
  return o;
}

static outline draw_rectangle(unsigned long *state) {
  const double height = 0.2 + 1.3 * test_random(state);
  return (outline){4, {{0, 0}, {1, 0}, {1, height}, {0, height}}};
}

short_room short_room_draw(unsigned long seed, int k) {
  unsigned long state = seed + 7919UL * (unsigned long)k;
  outline o = k % 3 == 0 ? draw_rectangle(&state) : draw_polygon(&state);
  const int features = 1 + (int)(3 * test_random(&state));
  for (int f = 0; f < features; f++) {
    if (k % 3 == 0 || test_random(&state) < 0.3)
      add_strip(&o, &state);
    else
      cut_corner(&o, &state);
  }
  short_room room = {.patches = o.count};
  const double max = test_random(&state) < 0.2 ? 0.99 : 0.9;
  size_t lamp = (size_t)(test_random(&state) * (double)o.count);
  for (size_t p = 0; p < o.count; p++) {
    const double *a = o.at[p], *b = o.at[(p + 1) % o.count];
    const int lit = p == lamp || test_random(&state) < 0.3;
    const double patch[6] = {a[0],
                             a[1],
                             b[0],
                             b[1],
                             lit ? test_random(&state) + 0.01 : 0,
                             test_random(&state) < 0.1 ? 0 : max * test_random(&state)};
    for (int c = 0; c < 6; c++) room.patch[p][c] = patch[c];
  }
  return room;
}
