/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bound that visibility.h states for exchange areas around occluders, on random and on
   hill-climbed ones, against crossed strings between events that are decided exactly.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the inputs. */
#include <math.h>
#include <stdio.h>

#include "independent/brute-visibility.h"
#include "support/hill-climb.h"
#include "support/support.h"
#include "support/visibility-cases.h"

/* Of the extent of all that is given. */
#define BOUND 0x1p-46

enum { OCCLUDERS = 3, POINTS = 2 * (OCCLUDERS + 2), NUMBERS = 2 * POINTS };

static void draw_pair_among(const void *ctx, randoms *r, double *x) {
  occluded_pair p;
  do draw_occluded(ctx, r, &p);
  while (p.count == 0);
  for (int k = 0; k < OCCLUDERS + 2; k++) {
    const hr2d_segment s = k == 0 ? p.i : k == 1 ? p.j : p.occluder[(size_t)(k - 2) % p.count];
    const double at[4] = {s.a.x, s.a.y, s.b.x, s.b.y};
    for (int m = 0; m < 4; m++) x[4 * k + m] = at[m];
  }
}

/* Whether a point counts as lying on the line of a segment, but does not. */
static int is_doubtful(hr2d_segment s, hr2d_point p, double max) {
  const double x = s.b.x - s.a.x, y = s.b.y - s.a.y;
  const double off = fabs(x * (p.y - s.a.y) - y * (p.x - s.a.x)) / hypot(x, y);
  return off < 0x1p-48 * max && hr2d_orientation(s.a, s.b, p) != 0;
}

/* Relative to the extent of all. */
static double occluded_error(const void *ctx, const double *x) {
  (void)ctx;
  hr2d_segment s[OCCLUDERS + 2];
  double max = 0, area, back;
  for (int k = 0; k < NUMBERS; k++) {
    if (fabs(x[k]) > 8) return -1;
    for (int m = k % 2; m < k; m += 2) max = fmax(max, fabs(x[k] - x[m]));
  }
  for (int k = 0; k < OCCLUDERS + 2; k++) {
    const double *at = x + 4 * k;
    s[k] = (hr2d_segment){{at[0], at[1]}, {at[2], at[3]}};
    if (hypot(at[2] - at[0], at[3] - at[1]) < 1e-3) return -1;
  }
  for (int k = 0; k < OCCLUDERS + 2; k++)
    for (int m = 0; m < OCCLUDERS + 2; m++)
      if (is_doubtful(s[m], s[k].a, max) || is_doubtful(s[m], s[k].b, max)) return -1;
  if (hr2d_exchange_area_occluded(&s[0], &s[1], s + 2, OCCLUDERS, NULL, &area)) return -1;
  ck_assert_int_eq(hr2d_exchange_area_occluded(&s[1], &s[0], s + 2, OCCLUDERS, NULL, &back), 0);
  if (area != back || !(area >= 0)) return INFINITY;
  return fabs(area - brute_strings(&s[0], &s[1], s + 2, OCCLUDERS)) / max;
}

START_TEST(occluded_areas_hold_their_bound) {
  const occluded_class *class = &occluded_classes[_i];
  char name[80];
  snprintf(name, sizeof name, "occluded, %s", class->name);
  const hill h = {name, NUMBERS, POINTS, draw_pair_among, occluded_error, class};
  const summit top = hill_climb(&h, (hill_effort){600, 5, 400}, 960 + _i);
  if (top.tried == 0 && test_multiplier() >= 1) ck_assert_str_eq(class->name, "slits");
  if (top.tried > 0)
    hill_assert(&h, &top, BOUND); /* slits are narrower than the bound allows */
}
END_TEST

TEST_SUITE("bounds of visibility") {
  REPEAT_TESTS(occluded_class_count, "visibility", occluded_areas_hold_their_bound);
}
