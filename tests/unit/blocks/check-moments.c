/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums over directions: against Gauss rules in σ, and the same bits for vectors of two and of
   four, and for a half batch and one that is filled up.  The file is part of this program, for
   what it picks by the processor. */
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_legendre.h>

#include "blocks/moments.c"
#include "support/support.h"

enum { MOST_ORDER = 12, SQUARE = MOST_ORDER * MOST_ORDER, MOST_HALVES = 6, ROUNDS = 4 };

/* Lines that meet both elements within [-1,1], or cover one of them. */
static void draw(hr2di_directions *d, hr2di_cover cover, size_t count, randoms *r) {
  for (d->count = 0; d->count < count; d->count++) {
    d->weight[d->count] = random_between(r, 0, 1);
    for (size_t side = 0; side < 2; side++) {
      const int covered = cover != HR2DI_COVERS_NEITHER && cover != (hr2di_cover)side;
      const double half = covered ? 1 : random_unit(r);
      d->half[side][d->count] = half;
      d->centre[side][d->count] = covered ? 0 : random_between(r, half - 1, 1 - half);
    }
  }
}

static double phi(size_t l, double x) {
  return sqrt(2. * (double)l + 1) * gsl_sf_legendre_Pl((int)l, fmax(-1, fmin(x, 1)));
}

static void add_plainly(const hr2di_directions *d, size_t order, double *block) {
  gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(order + 1);
  for (size_t q = 0; q < d->count; q++)
    for (size_t n = 0; n < order + 1; n++) {
      double at, weight;
      gsl_integration_glfixed_point(-1, 1, n, &at, &weight, rule);
      const double on_i = d->centre[0][q] + d->half[0][q] * at;
      const double on_j = d->centre[1][q] - d->half[1][q] * at;
      for (size_t l = 0; l < order; l++)
        for (size_t m = 0; m < order; m++)
          block[l * order + m] += 0.5 * weight * d->weight[q] * phi(l, on_i) * phi(m, on_j);
    }
  gsl_integration_glfixed_table_free(rule);
}

/* Fills the last batch up with directions that weigh nothing; returns how many there are. */
static size_t fill_up(hr2di_directions *d) {
  size_t count = d->count;
  for (; count % LANES > 0; count++) {
    d->weight[count] = 0;
    for (size_t side = 0; side < 2; side++) d->centre[side][count] = d->half[side][count] = 0;
  }
  return count;
}

static void check(hr2di_moments *w, hr2di_cover cover, size_t count, randoms *r) {
  double plain[SQUARE] = {0}, narrow[SQUARE] = {0}, wide[SQUARE] = {0}, filled[SQUARE] = {0};
  hr2di_directions *d = &w->waiting[cover];
  draw(d, cover, count, r);
  add_plainly(d, w->order, plain);
  add_batches_2(w, cover, count, narrow);
  memcpy(wide, narrow, sizeof wide);
#ifdef HR2D_AVX2
  if (hr2di_wide()) {
    memset(wide, 0, sizeof wide);
    add_batches_4(w, cover, count, wide);
  }
#endif
  add_batches_2(w, cover, fill_up(d), filled);
  ck_assert_int_eq(memcmp(narrow, wide, sizeof wide), 0);
  ck_assert_int_eq(memcmp(narrow, filled, sizeof filled), 0);
  for (size_t k = 0; k < w->order * w->order; k++)
    ck_assert_double_eq_tol(narrow[k], plain[k], 1e-12);
  add_batches_2(w, cover, HALF, narrow);
  ck_assert(fabs(narrow[0] - plain[0]) > 1e-3);
}

START_TEST(sums_are_those_of_plain_loops) {
  randoms r = {test_seed()};
  const hr2d_allocator alloc = hr2di_alloc_default();
  for (size_t order = 1; order <= MOST_ORDER; order++) {
    hr2di_moments w;
    ck_assert_int_eq(hr2di_moments_init(&w, order, &alloc), HR2D_OK);
    for (int cover = HR2DI_COVERS_J; cover <= HR2DI_COVERS_NEITHER; cover++)
      for (int round = 0; round < ROUNDS; round++)
        check(&w, (hr2di_cover)cover, HALF * (1 + random_below(&r, MOST_HALVES)), &r);
    hr2di_moments_clear(&w, &alloc);
  }
}
END_TEST

TEST_SUITE("moments of lines") {
  ADD_TESTS("moments", sums_are_those_of_plain_loops);
}
