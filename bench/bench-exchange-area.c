/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures nanoseconds per exchange area: one by one, in batches, and by the crossed strings of
   textbooks, which keep their digits only for large and near pairs.

   Usage: bench_exchange_area [ROUNDS]; the median of interleaved rounds. */
#include <hr2d/geometry.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "geometry/exchange-area.h"
#include "timing.h"

enum { ELEMENTS = 256, PAIRS = 16384, METHODS = 3, MAX_ROUNDS = 101 };

static hr2d_element elements[ELEMENTS];
static hr2d_pair pairs[PAIRS];
static double area[PAIRS];

static uint64_t state = 20250101;

static double uniform(void) {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return (double)(state >> 11) * 0x1p-53;
}

static double length(hr2d_point a, hr2d_point b) {
  const double x = a.x - b.x, y = a.y - b.y;
  return sqrt(x * x + y * y);
}

static double strings(const hr2d_segment *i, const hr2d_segment *j) {
  return 0.5 * ((length(i->a, j->a) + length(i->b, j->b)) -
                (length(i->a, j->b) + length(i->b, j->a)));
}

static hr2d_segment segment(uint32_t k) {
  return (hr2d_segment){elements[k].a, elements[k].b};
}

static void by_strings(void) {
  for (size_t k = 0; k < PAIRS; k++) {
    const hr2d_segment i = segment(pairs[k].first), j = segment(pairs[k].second);
    area[k] = strings(&i, &j);
  }
}

static void one_by_one(void) {
  for (size_t k = 0; k < PAIRS; k++) {
    const hr2d_segment i = segment(pairs[k].first), j = segment(pairs[k].second);
    area[k] = hr2d_exchange_area(&i, &j);
  }
}

static void batched(void) {
  hr2di_exchange_areas(elements, pairs, PAIRS, area);
}

/* Segments of length 0.1 to 0.5 anywhere in the unit square. */
static void anywhere(void) {
  for (size_t k = 0; k < ELEMENTS; k++) {
    const double x = uniform(), y = uniform(), angle = 6.283185307179586 * uniform();
    const double size = 0.1 + 0.4 * uniform();
    elements[k].a = (hr2d_point){x, y};
    elements[k].b = (hr2d_point){x + size * cos(angle), y + size * sin(angle)};
  }
}

/* The elements of two sides of a room, of one size. */
static void two_sides(hr2d_segment first, hr2d_segment second) {
  const double n = ELEMENTS / 2;
  for (uint32_t k = 0; k < ELEMENTS; k++) {
    const hr2d_segment side = k < ELEMENTS / 2 ? first : second;
    const double s = (k % (ELEMENTS / 2)) / n, t = s + 1 / n;
    elements[k].a = (hr2d_point){side.a.x + s * (side.b.x - side.a.x),
                                 side.a.y + s * (side.b.y - side.a.y)};
    elements[k].b = (hr2d_point){side.a.x + t * (side.b.x - side.a.x),
                                 side.a.y + t * (side.b.y - side.a.y)};
  }
}

/* Pairs i from the first half and j from the second; only those that face each
   other fully if asked. */
static void draw_pairs(int facing) {
  for (size_t k = 0; k < PAIRS;) {
    const uint32_t first = (uint32_t)(uniform() * (ELEMENTS / 2.0));
    const uint32_t second = ELEMENTS / 2 + (uint32_t)(uniform() * (ELEMENTS / 2.0));
    const hr2d_segment i = segment(first), j = segment(second);
    if (facing && (hr2d_orientation(i.a, i.b, j.a) < 0 || hr2d_orientation(i.a, i.b, j.b) < 0 ||
                   hr2d_orientation(j.a, j.b, i.a) < 0 || hr2d_orientation(j.a, j.b, i.b) < 0))
      continue;
    pairs[k++] = (hr2d_pair){first, second};
  }
}

static void measure(const char *what, int rounds) {
  static void (*const run[METHODS])(void) = {by_strings, one_by_one, batched};
  enum { REPEAT = 8 };
  double ns[METHODS][MAX_ROUNDS];
  for (int round = -1; round < rounds; round++)
    for (int m = 0; m < METHODS; m++) {
      const double start = cpu_seconds();
      for (int k = 0; k < REPEAT; k++) run[m]();
      if (round >= 0) ns[m][round] = 1e9 * (cpu_seconds() - start) / (REPEAT * (double)PAIRS);
    }
  double median[METHODS];
  for (int m = 0; m < METHODS; m++) median[m] = median_of(ns[m], rounds);
  printf("%-22s %8.1f %8.1f %8.1f %10.2f %8.2f\n", what, median[0], median[1], median[2],
         median[1] / median[0], median[2] / median[0]);
}

int main(int argc, char **argv) {
  int rounds = argc > 1 ? atoi(argv[1]) : 21;
  if (rounds < 1 || rounds > MAX_ROUNDS) {
    fprintf(stderr, "usage: %s [ROUNDS from 1 to %d]\n", argv[0], MAX_ROUNDS);
    return 2;
  }
  printf("%-22s %8s %8s %8s %10s %8s\n", "ns per pair", "strings", "single", "batch",
         "single/str", "batch/str");
  anywhere();
  draw_pairs(1);
  measure("random, facing", rounds);
  draw_pairs(0);
  measure("random, any", rounds);
  const hr2d_segment floor = {{0, 0}, {1, 0}}, wall = {{1, 0}, {1, 1}},
                     near = {{1, 0.1}, {0, 0.1}}, tilted = {{0.9, 0.8}, {0.1, 0.7}};
  two_sides(floor, tilted);
  draw_pairs(1);
  measure("opposite elements", rounds);
  two_sides(floor, near);
  draw_pairs(1);
  measure("elements of a slit", rounds);
  two_sides(floor, wall);
  draw_pairs(1);
  measure("elements of a corner", rounds);
  return 0;
}
