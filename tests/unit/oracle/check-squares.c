/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Oracles decide about a long batch, which is done with the processor's widest vectors, as
   about each of its pairs alone, and as their estimates do.  HR2D_TEST_SEED and
   HR2D_TEST_MULTIPLIER change the pairs. */
#include <math.h>
#include <string.h>

#include "base/wide.h"
#include "oracle/squares.h"
#include "support/support.h"

enum { ELEMENTS = 64, PAIRS = 1027 };

typedef struct sample {
  hr2d_element element[ELEMENTS];
  hr2d_pair pair[PAIRS];
  double epsilon;
  hr2d_batch batch;
} sample;

/* The two words behind a length are bits of a number that is none, or that is subnormal. */
static uint32_t any_word(randoms *r) {
  static const uint32_t word[] = {0, 1, 0x7ff00000u, 0xfff80001u, UINT32_MAX};
  return word[random_below(r, sizeof word / sizeof *word)];
}

/* With ε that some pairs of a lattice meet to the last digit, and others are near to. */
static void draw(sample *s, randoms *r) {
  const double unit = random_below(r, 4) ? 1 : random_power(r, -160, 0);
  for (int k = 0; k < ELEMENTS; k++) {
    hr2d_element *e = &s->element[k];
    memset(e, 0, sizeof *e);
    e->centre.x = unit * random_below(r, 16) / 16;
    e->centre.y = unit * random_nudge(r, random_below(r, 16) / 16., 1);
    e->length = unit / (1 << random_below(r, 5));
    e->child = any_word(r);
    e->patch = any_word(r);
  }
  for (int k = 0; k < PAIRS; k++)
    s->pair[k] =
        (hr2d_pair){(uint32_t)random_below(r, ELEMENTS), (uint32_t)random_below(r, ELEMENTS)};
  static const double epsilon[] = {0, 1e-200, 1. / 16, 0.25, 0.5, 1, 1.4142135623730951, 1e30};
  s->epsilon = random_nudge(r, epsilon[random_below(r, 8)], 1);
  s->batch = (hr2d_batch){.struct_size = sizeof s->batch,
                          .elements = s->element,
                          .pairs = s->pair,
                          .count = PAIRS,
                          .unit = 1,
                          .epsilon = s->epsilon};
}

static hr2d_batch only(const hr2d_batch *all, size_t k) {
  hr2d_batch one = *all;
  one.pairs += k;
  one.count = 1;
  return one;
}

START_TEST(a_batch_is_decided_as_its_pairs) {
  const hr2d_oracle *oracle = _i ? hr2d_oracle_size2() : hr2d_oracle_size();
  randoms r = randoms_stream(test_seed(), 40 + _i);
  static sample s;
  int met[2] = {0};
  for (int round = test_count(200); round > 0; round--) {
    unsigned char all[PAIRS];
    draw(&s, &r);
    ck_assert_int_eq(oracle->accept(NULL, &s.batch, s.epsilon, all), HR2D_OK);
    for (size_t k = 0; k < PAIRS; k++) {
      const hr2d_batch one = only(&s.batch, k);
      unsigned char accepted;
      double error;
      ck_assert_int_eq(oracle->accept(NULL, &one, s.epsilon, &accepted), HR2D_OK);
      ck_assert_int_eq(oracle->estimate(NULL, &one, &error), HR2D_OK);
      ck_assert_int_eq(all[k], accepted);
      ck_assert_int_eq(all[k], error <= s.epsilon);
      met[accepted]++;
    }
  }
  printf("%s, vectors of four %s: %d pairs accepted, %d refused\n", oracle->name,
         hr2di_wide() ? "on" : "off", met[1], met[0]);
  ck_assert_int_gt(met[0], 100);
  ck_assert_int_gt(met[1], 100);
}
END_TEST

START_TEST(margins_have_the_same_bits) {
  randoms r = randoms_stream(test_seed(), 42);
  static sample s;
  for (int round = test_count(200); round > 0; round--) {
    unsigned char accepted[PAIRS];
    double min = 1;
    draw(&s, &r);
    for (size_t k = 0; k < PAIRS; k++) {
      const hr2d_batch one = only(&s.batch, k);
      min = fmin(min, hr2di_squares_accept(&one, s.epsilon * s.epsilon, accepted));
    }
    ck_assert(hr2di_squares_accept(&s.batch, s.epsilon * s.epsilon, accepted) == min);
  }
}
END_TEST

/* Negative control: products that are fused give other margins. */
START_TEST(fused_products_have_other_bits) {
  randoms r = randoms_stream(test_seed(), 43);
  static sample s;
  int other = 0;
  draw(&s, &r);
  s.epsilon = 0.3; /* not a power of two, by which no product is rounded */
  for (size_t k = 0; k < PAIRS; k++) {
    const hr2d_element *i = &s.element[s.pair[k].first], *j = &s.element[s.pair[k].second];
    const double e2 = s.epsilon * s.epsilon, dx = j->centre.x - i->centre.x;
    const double dy = j->centre.y - i->centre.y, a = fmax(i->length, j->length);
    double a2;
    other += fma(-e2, fma(dx, dx, dy * dy), a * a) != hr2di_squares_excess(i, j, e2, &a2);
  }
  printf("%d fused differences have other bits\n", other);
  ck_assert_int_gt(other, 10);
}
END_TEST

TEST_SUITE("squares") {
  REPEAT_TESTS(2, "decisions", a_batch_is_decided_as_its_pairs);
  ADD_TESTS("bits", margins_have_the_same_bits, fused_products_have_other_bits);
}
