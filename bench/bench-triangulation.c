/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures what a triangulation of walls costs per vertex, and how that grows.

   Usage: bench_triangulation [WALLS].  Scenes of 1/100, 1/10 and all of WALLS.  Fails if a
   vertex of the largest scene costs more than the bar times what it costs in the smallest one.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "base/clock.h"
#include "support/random.h"
#include "timing.h"
#include "triangulation/triangulation.h"

#define TURN 6.28318530717958648
#define BAR  8.0 /* caches account for half of it; a quadratic cost would be 100 */

typedef void (*draw_fn)(randoms *r, hr2d_segment *wall, size_t count);

/* Turned squares, each in a cell of a grid. */
static void draw_squares(randoms *r, hr2d_segment *wall, size_t count) {
  const size_t side = (size_t)ceil(sqrt((double)(count / 4)));
  for (size_t k = 0; k + 4 <= count; k += 4) {
    const double turn = random_between(r, 0, TURN), size = random_between(r, 0.1, 0.45);
    const double x = (double)(k / 4 % side), y = (double)(k / 4 / side);
    hr2d_point p[4];
    for (int m = 0; m < 4; m++)
      p[m] = (hr2d_point){(x + size * cos(turn + m * TURN / 4)) / (double)side,
                          (y + size * sin(turn + m * TURN / 4)) / (double)side};
    for (int m = 0; m < 4; m++) wall[k + (size_t)m] = (hr2d_segment){p[m], p[(m + 1) % 4]};
  }
}

/* As squares, but in no order. */
static void draw_mixed(randoms *r, hr2d_segment *wall, size_t count) {
  draw_squares(r, wall, count);
  for (size_t k = count; k > 1; k--) {
    const size_t other = (size_t)(random_bits(r) % k);
    const hr2d_segment kept = wall[k - 1];
    wall[k - 1] = wall[other];
    wall[other] = kept;
  }
}

/* A round room: all vertices on one circle. */
static void draw_round(randoms *r, hr2d_segment *wall, size_t count) {
  (void)r;
  const double step = TURN / (double)count;
  for (size_t k = 0; k < count; k++) {
    const double u = step * (double)k, v = step * (double)((k + 1) % count);
    wall[k] = (hr2d_segment){{cos(u), sin(u)}, {cos(v), sin(v)}};
  }
}

/* Spokes from one point. */
static void draw_star(randoms *r, hr2d_segment *wall, size_t count) {
  for (size_t k = 0; k < count; k++) {
    const double u = TURN * (double)k / (double)count, length = random_between(r, 0.5, 1);
    wall[k] = (hr2d_segment){{0, 0}, {length * cos(u), length * sin(u)}};
  }
}

/* Short walls above and below a long one, which crosses many edges at once. */
static void draw_slit(randoms *r, hr2d_segment *wall, size_t count) {
  const double n = (double)count;
  wall[0] = (hr2d_segment){{-1, 0}, {1, 0}};
  for (size_t k = 1; k < count; k++) {
    const double x = 2 * (double)k / n - 1, y = random_between(r, 0.1, 1) * (k % 2 ? 1 : -1);
    wall[k] = (hr2d_segment){{x, y * 0.1}, {x + random_between(r, -0.4, 0.4) / n, y * 0.09}};
  }
}

static int measure(const char *name, draw_fn draw, size_t max) {
  double cost[3] = {0};
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_segment *wall = malloc(max * sizeof *wall);
  int failed = wall == NULL;
  for (int size = 0; size < 3 && !failed; size++) {
    const size_t count = (size == 0 ? max / 100 : size == 1 ? max / 10 : max) / 4 * 4;
    randoms r = randoms_stream(1, size);
    draw(&r, wall, count);
    double seconds[3];
    for (int k = 0; k < 3 && !failed; k++) {
      hr2di_triangulation t;
      hr2di_conflict conflict;
      const double start = hr2di_clock_now();
      failed = hr2di_triangulation_init(&t, &alloc, wall, count, sizeof *wall, HR2DI_UNITS,
                                        &conflict, NULL);
      seconds[k] = hr2di_clock_now() - start;
      cost[size] = (double)(t.vertices ? t.vertices : 1);
      hr2di_triangulation_clear(&t);
      if (failed)
        printf("%-8s status %d: %u %u\n", name, failed, conflict.wall[0], conflict.wall[1]);
    }
    if (failed) break;
    const double median = median_of(seconds, 3), vertices = cost[size];
    cost[size] = 1e6 * median / vertices;
    printf("%-8s %8zu walls %8.0f vertices %8.3f s %7.3f us/vertex\n", name, count, vertices,
           median, cost[size]);
    fflush(stdout);
  }
  free(wall);
  return failed || cost[2] > BAR * cost[0];
}

int main(int argc, char **argv) {
  const size_t max = argc > 1 ? (size_t)atol(argv[1]) : 1000000;
  int missed = 0;
  missed += measure("squares", draw_squares, max);
  missed += measure("mixed", draw_mixed, max);
  missed += measure("round", draw_round, max);
  missed += measure("star", draw_star, max);
  missed += measure("slit", draw_slit, max);
  return missed ? EXIT_FAILURE : EXIT_SUCCESS;
}
