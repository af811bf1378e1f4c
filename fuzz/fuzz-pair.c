/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two segments with occluders, from lines as `hr2d pair` reads them and from the bits of
   doubles.  Their exchange area must not depend on the order of the segments, on the unit of
   length or on the direction of the axes. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "pair/line.h"

/* Signs are exact for coordinates whose exponents differ by less than 900. */
enum { MOST_OCCLUDERS = 6, MOST_SCALES = 900, PLAIN = 40 };

/* The relative error of one exchange area, as geometry.h states it, and of a sum of two. */
#define AREA_BOUND 4e-15
#define SUM_BOUND  1.2e-14

typedef struct pair {
  hr2d_segment i, j;
} pair;

static double length(hr2d_segment s) {
  return hypot(s.b.x - s.a.x, s.b.y - s.a.y);
}

/* The least and largest exponents of coordinates but zeros. */
static void exponents(const double *x, size_t count, int *min, int *max) {
  *min = 2000;
  *max = -2000;
  for (size_t k = 0; k < count; k++) {
    int e;
    if (x[k] == 0) continue;
    frexp(x[k], &e);
    if (e < *min) *min = e;
    if (e > *max) *max = e;
  }
}

static pair scaled(const pair *p, int exponent) {
  pair q = *p;
  double *x = &q.i.a.x;
  for (int k = 0; k < 8; k++) x[k] = ldexp(x[k], exponent);
  return q;
}

static hr2d_point turned_point(hr2d_point p) {
  return (hr2d_point){-p.y, p.x};
}

static hr2d_segment turned(hr2d_segment s) {
  return (hr2d_segment){turned_point(s.a), turned_point(s.b)};
}

/* In a mirror left is right: a segment keeps its front if its ends change places. */
static hr2d_segment mirrored(hr2d_segment s) {
  return (hr2d_segment){{s.b.y, s.b.x}, {s.a.y, s.a.x}};
}

static double area_of(pair p) {
  return hr2d_exchange_area(&p.i, &p.j);
}

static void check_scaling(const pair *p, double area, int exponent) {
  int min, max;
  exponents(&p->i.a.x, 8, &min, &max);
  if (min - 53 + exponent < -1000 || max + exponent > 1000) return;
  const pair q = scaled(p, exponent);
  const double expected = ldexp(area, exponent), other = area_of(q);
  if (fmin(area, ldexp(other, -exponent)) < DBL_MIN || fmin(expected, other) < DBL_MIN) {
    REQUIRE(fmin(area, expected) < 4 * DBL_MIN);
    return;
  }
  /* Of very large and very small ones other formulas take care, with roundings of their own. */
  REQUIRE(fabs(other - expected) <= 2 * AREA_BOUND * expected);
}

/* The middle, if it is a double. */
static int halve(double a, double b, double *middle) {
  const double sum = a + b, back = sum - a;
  const double lost = (a - (sum - back)) + (b - back);
  *middle = sum / 2;
  return lost == 0 && isfinite(sum) && *middle * 2 == sum;
}

static void check_halves(const pair *p, double area) {
  hr2d_point m;
  if (!halve(p->j.a.x, p->j.b.x, &m.x) || !halve(p->j.a.y, p->j.b.y, &m.y)) return;
  const double one = area_of((pair){p->i, {p->j.a, m}});
  const double other = area_of((pair){p->i, {m, p->j.b}});
  if ((one != 0 && one < DBL_MIN) || (other != 0 && other < DBL_MIN)) return;
  if (area < DBL_MIN) {
    REQUIRE(one + other < 4 * DBL_MIN);
    return;
  }
  REQUIRE(fabs(one + other - area) <= SUM_BOUND * area);
}

static void check_area(const pair *p, int exponent) {
  int min, max;
  exponents(&p->i.a.x, 8, &min, &max);
  const double area = area_of(*p), shorter = fmin(length(p->i), length(p->j));
  REQUIRE(fuzz_same_bits(area, area_of((pair){p->j, p->i})));
  REQUIRE(isfinite(area) && area >= 0);
  REQUIRE(area <= shorter * (1 + 1e-14) + DBL_TRUE_MIN);
  const double by_quarter = area_of((pair){turned(p->i), turned(p->j)});
  if (-PLAIN < min && max < PLAIN) REQUIRE(fuzz_same_bits(area, by_quarter));
  if (max - min >= MOST_SCALES) return;
  REQUIRE(fabs(by_quarter - area) <= 2 * AREA_BOUND * fmax(area, DBL_MIN) + 4 * DBL_TRUE_MIN);
  const double other = area_of((pair){mirrored(p->i), mirrored(p->j)});
  REQUIRE(fabs(other - area) <= 2 * AREA_BOUND * fmax(area, DBL_MIN) + 4 * DBL_TRUE_MIN);
  check_scaling(p, area, exponent);
  check_halves(p, area);
}

static void check_kernel(const pair *p) {
  const hr2d_point x[] = {p->i.a, p->i.b}, y[] = {p->j.a, p->j.b};
  for (int k = 0; k < 4; k++) {
    const double g = hr2d_kernel(&p->i, x[k & 1], &p->j, y[k >> 1]);
    REQUIRE(g >= 0);
    REQUIRE(fuzz_same_bits(g, hr2d_kernel(&p->j, y[k >> 1], &p->i, x[k & 1])));
  }
}

static void check_orientation(hr2d_point a, hr2d_point b, hr2d_point c) {
  const int side = hr2d_orientation(a, b, c);
  REQUIRE(side >= -1 && side <= 1);
  REQUIRE(hr2d_orientation(b, c, a) == side && hr2d_orientation(c, a, b) == side);
  REQUIRE(hr2d_orientation(b, a, c) == -side && hr2d_orientation(a, c, b) == -side);
  REQUIRE(hr2d_orientation(turned_point(a), turned_point(b), turned_point(c)) == side);
}

/* Occluders reduce the exchange area or leave it as it is; without occluders it is the
   unoccluded one, bit by bit. */
static void check_occluded(const pair *p, const hr2d_segment *other, size_t count) {
  fuzz_memory memory = FUZZ_MEMORY_INIT;
  const hr2d_allocator hooks = fuzz_hooks(&memory);
  const double all = area_of(*p);
  double one = -1, swapped = -1, fewer = -1;
  const hr2d_status status =
      hr2d_exchange_area_occluded(&p->i, &p->j, other, count, &hooks, &one);
  REQUIRE(hr2d_exchange_area_occluded(&p->j, &p->i, other, count, &hooks, &swapped) == status);
  REQUIRE(memory.live == 0);
  if (status) {
    REQUIRE(status == HR2D_ERANGE && count > 0);
    return;
  }
  REQUIRE(fuzz_same_bits(one, swapped));
  /* Coordinates are divided by the largest, and exchange areas may be denormal then. */
  int min, max;
  exponents(&p->i.a.x, 8, &min, &max);
  for (size_t k = 0; k < count; k++) {
    int low, high;
    exponents(&other[k].a.x, 4, &low, &high);
    if (high > max) max = high;
  }
  const double denormal = ldexp(4 * DBL_TRUE_MIN, max > 0 ? max : 0);
  if (!(isfinite(one) && one >= 0 && one <= all * (1 + 1e-12) + denormal)) {
    char text[100];
    snprintf(text, sizeof text, "%.17g of %.17g", one, all);
    fuzz_fail(__FILE__, __LINE__, "0 <= AF <= AF without occluders", text);
  }
  REQUIRE(hr2d_exchange_area_occluded(&p->i, &p->j, NULL, 0, &hooks, &fewer) == HR2D_OK);
  REQUIRE(fuzz_same_bits(fewer, all));
}

/* Where lengths and their squares exist. */
static int is_moderate(const double *x, size_t count) {
  int min, max;
  for (size_t k = 0; k < count; k++)
    if (!isfinite(x[k])) return 0;
  exponents(x, count, &min, &max);
  return max < 1000;
}

/* Whether the scales of the pair and of the occluders are so close that scaling both does
   not make the pair vanish. */
static int is_like(const pair *p, const hr2d_segment *other, size_t count) {
  int min, max, others_min, others_max;
  exponents(&p->i.a.x, 8, &min, &max);
  exponents(&other->a.x, 4 * count, &others_min, &others_max);
  return fmax(max, others_max) - fmin(min, others_min) < MOST_SCALES;
}

/* Prints the segments as numbers, to reproduce a finding. */
static void tell(const pair *p, const hr2d_segment *other, size_t count, int exponent) {
  const hr2d_segment *s[] = {&p->i, &p->j};
  for (size_t k = 0; k < 2 + count; k++) {
    const hr2d_segment *at = k < 2 ? s[k] : &other[k - 2];
    fprintf(stderr, "%a %a  %a %a\n", at->a.x, at->a.y, at->b.x, at->b.y);
  }
  fprintf(stderr, "area %.17g, to be scaled by 2^%d\n", area_of(*p), exponent);
}

static void check_pair(const pair *p, const hr2d_segment *other, size_t count, int exponent) {
  if (getenv("FUZZ_VERBOSE")) tell(p, other, count, exponent);
  if (!is_moderate(&p->i.a.x, 8) || !(length(p->i) > 0) || !(length(p->j) > 0)) return;
  check_area(p, exponent);
  check_kernel(p);
  int min, max;
  exponents(&p->i.a.x, 8, &min, &max);
  if (max - min < MOST_SCALES) {
    check_orientation(p->i.a, p->i.b, p->j.a);
    check_orientation(p->i.a, p->i.b, p->j.b);
  }
  if (count > 0 && is_moderate(&other->a.x, 4 * count) && is_like(p, other, count))
    check_occluded(p, other, count);
}

/* All of the text, line by line, as the program does. */
static void check_text(const uint8_t *data, size_t size) {
  char *text = malloc(size + 1);
  if (!text) return;
  memcpy(text, data, size);
  text[size] = '\0';
  int left = 8;
  for (char *line = text, *next; line < text + size && left > 0; line = next) {
    pair_line numbers;
    char *end = memchr(line, '\n', (size_t)(text + size - line));
    next = end ? end + 1 : text + size;
    if (end) *end = '\0';
    if (pair_is_empty(line)) continue;
    if (pair_read(line, &numbers)) {
      REQUIRE(numbers.word || numbers.found != 8);
      continue;
    }
    for (int k = 0; k < 8; k++) REQUIRE(isfinite(numbers.x[k]));
    const int exponent = pair_grow(numbers.x);
    pair p;
    memcpy(&p, numbers.x, sizeof p);
    check_pair(&p, NULL, 0, exponent + 3);
    left--;
  }
  free(text);
}

/* A point is as often new as it is an earlier point, taken as it is or moved by an ulp. */
static hr2d_point next_point(fuzz_input *in, hr2d_point *known, size_t *count) {
  const unsigned how = fuzz_byte(in);
  hr2d_point p;
  if (*count && how >= 128) {
    p = known[(how >> 2) % *count];
    if (how & 1) p.x = nextafter(p.x, how & 2 ? HUGE_VAL : -HUGE_VAL);
    if (how & 64) p.y = (known[fuzz_byte(in) % *count].y + p.y) / 2;
  } else if (how & 64) {
    p.x = ldexp((int)fuzz_byte(in) - 128, (int)(how & 31) - 16);
    p.y = ldexp((int)fuzz_byte(in) - 128, (int)(how & 31) - 16);
  } else {
    p.x = fuzz_finite(in);
    p.y = fuzz_finite(in);
  }
  known[(*count)++] = p;
  return p;
}

static void check_bits(const uint8_t *data, size_t size) {
  fuzz_input in = {data, data + size};
  hr2d_point known[4 + 2 * MOST_OCCLUDERS];
  hr2d_segment s[2 + MOST_OCCLUDERS];
  size_t points = 0, segments = 0;
  const int exponent = (int)fuzz_byte(&in) * 8 - 1024;
  while (segments < 2 || (segments < 2 + MOST_OCCLUDERS && in.at < in.end)) {
    const hr2d_point a = next_point(&in, known, &points);
    s[segments++] = (hr2d_segment){a, next_point(&in, known, &points)};
  }
  const pair p = {s[0], s[1]};
  check_pair(&p, s + 2, segments - 2, exponent);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  check_text(data, size);
  check_bits(data, size);
  return 0;
}
