/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Products with one block, both ways and one way, in any number of bands: against sums in long
   double, the same bits for each band alone, and for vectors of two and of four.  Fields end
   where their memory does.  The file is part of this program, for what it picks by the
   processor. */
#include <stdlib.h>
#include <string.h>

#include "solve/gather-blocks.c"
#include "support/support.h"

static const size_t numbers_of_bands[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 64};
enum { MOST = 9 };

/* Two elements, whose fields have memory of their own. */
typedef struct fields {
  double block[MOST * MOST], *up[2], *down[2];
  size_t order, bands;
} fields;

static void draw(fields *f, size_t order, size_t bands, randoms *r) {
  *f = (fields){.order = order, .bands = bands};
  for (size_t k = 0; k < order * order; k++) f->block[k] = random_between(r, -1, 1);
  for (int i = 0; i < 2; i++) {
    f->up[i] = malloc(order * bands * sizeof(double));
    f->down[i] = malloc(order * bands * sizeof(double));
    ck_assert(f->up[i] && f->down[i]);
    for (size_t k = 0; k < order * bands; k++) {
      f->up[i][k] = random_between(r, -1, 1);
      f->down[i][k] = random_between(r, -1, 1);
    }
  }
}

static fields copy(const fields *f, size_t first, size_t bands) {
  fields to = *f;
  to.bands = bands;
  for (int i = 0; i < 2; i++) {
    to.up[i] = malloc(f->order * bands * sizeof(double));
    to.down[i] = malloc(f->order * bands * sizeof(double));
    ck_assert(to.up[i] && to.down[i]);
    for (size_t k = 0; k < f->order * bands; k++) {
      const size_t from = k / bands * f->bands + first + k % bands;
      to.up[i][k] = f->up[i][from];
      to.down[i][k] = f->down[i][from];
    }
  }
  return to;
}

static void clear(fields *f) {
  for (int i = 0; i < 2; i++) {
    free(f->up[i]);
    free(f->down[i]);
  }
}

static void gather(fields *f) {
  hr2di_gather_both(f->block, f->order, f->bands, f->up[0], f->up[1], f->down[0], f->down[1]);
}

static void expect_equal(const fields *a, const fields *b) {
  const size_t bytes = a->order * a->bands * sizeof(double);
  for (int i = 0; i < 2; i++) ck_assert_int_eq(memcmp(a->down[i], b->down[i], bytes), 0);
}

/* `f` is what `before` becomes. */
static void expect_sums(const fields *before, const fields *f) {
  for (size_t l = 0; l < f->order; l++)
    for (size_t b = 0; b < f->bands; b++) {
      long double row = before->down[0][l * f->bands + b],
                  column = before->down[1][l * f->bands + b];
      for (size_t m = 0; m < f->order; m++) {
        row += (long double)f->block[l * f->order + m] * f->up[1][m * f->bands + b];
        column += (long double)f->block[m * f->order + l] * f->up[0][m * f->bands + b];
      }
      ck_assert_double_eq_tol(f->down[0][l * f->bands + b], (double)row, 1e-14);
      ck_assert_double_eq_tol(f->down[1][l * f->bands + b], (double)column, 1e-14);
    }
}

static void expect_alone(const fields *before, const fields *f) {
  for (size_t b = 0; b < f->bands; b++) {
    fields alone = copy(before, b, 1), of_all = copy(f, b, 1);
    gather(&alone);
    expect_equal(&alone, &of_all);
    clear(&alone);
    clear(&of_all);
  }
}

static void check_ways(const fields *before, const fields *f) {
  fields one_way = copy(before, 0, before->bands), narrow = copy(before, 0, before->bands);
  hr2di_gather_block(f->block, f->order, f->bands, f->up[1], one_way.down[0]);
  hr2di_gather_transposed(f->block, f->order, f->bands, f->up[0], one_way.down[1]);
  expect_equal(&one_way, f);
  if (f->bands > 1)
    both_loop(&(group){f->block, f->order, f->bands, f->up[0], f->up[1], narrow.down[0],
                       narrow.down[1]});
  else
    one_loop(f->block, f->order, f->up[0], f->up[1], narrow.down[0], narrow.down[1]);
  expect_equal(&narrow, f);
  clear(&one_way);
  clear(&narrow);
}

START_TEST(bands_have_the_bits_of_each_alone) {
  randoms r = {test_seed()};
  for (size_t order = 1; order <= MOST; order++)
    for (size_t n = 0; n < sizeof numbers_of_bands / sizeof *numbers_of_bands; n++) {
      fields before;
      draw(&before, order, numbers_of_bands[n], &r);
      fields f = copy(&before, 0, before.bands);
      gather(&f);
      expect_sums(&before, &f);
      expect_alone(&before, &f);
      check_ways(&before, &f);
      clear(&before);
      clear(&f);
    }
}
END_TEST

TEST_SUITE("products with blocks") {
  ADD_TESTS("blocks", bands_have_the_bits_of_each_alone);
}
