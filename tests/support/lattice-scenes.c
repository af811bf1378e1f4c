/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/lattice-scenes.h"

#include <math.h>
#include <string.h>

#include "support/support.h"

int lattice_side(long long ax, long long ay, long long bx, long long by, long long x,
                 long long y) {
  const long long det = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
  return (det > 0) - (det < 0);
}

long long lattice_random(unsigned long *state, long long below) {
  return (long long)(test_random(state) * (double)below);
}

void lattice_draw(unsigned long *state, lattice *p, size_t count, long long size,
                  long long reach) {
  for (size_t k = 0; k < count; k++) {
    do {
      p[k].ax = lattice_random(state, size);
      p[k].ay = lattice_random(state, size);
      p[k].bx = p[k].ax + lattice_random(state, 2 * reach + 1) - reach;
      p[k].by = p[k].ay + lattice_random(state, 2 * reach + 1) - reach;
    } while (p[k].ax == p[k].bx && p[k].ay == p[k].by);
  }
}

hr2d_scene *lattice_scene(const lattice *p, size_t count, int exponent) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < count; k++)
    test_add_black(scene, (const double[]){ldexp((double)p[k].ax, exponent),
                                           ldexp((double)p[k].ay, exponent),
                                           ldexp((double)p[k].bx, exponent),
                                           ldexp((double)p[k].by, exponent)});
  return scene;
}

void lattice_named_pair(const char *message, size_t *i, size_t *j) {
  ck_assert_int_eq(sscanf(message, "patch %zu", i), 1);
  const char *next = strstr(message + 1, "patch ");
  ck_assert_ptr_nonnull(next);
  ck_assert_int_eq(sscanf(next, "patch %zu", j), 1);
}
