/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Images that stand for those of a period that are cut off: series are right, and where a
   vertex hides images from some number on, the sum is off by no more than the checks show. */
#include <math.h>

#include "scene/symmetry.h"
#include "support/support.h"

/* Terms: of exchange areas, of views from patches along the period and across, and of angles at
   points, for vertices with x = 1/m; and the power of the series. */
typedef struct kink {
  double (*term)(double k, double x);
  int power;
} kink;

static double positive(double x) {
  return x > 0 ? x : 0;
}

static double of_patches(double k, double x) {
  return positive(1 / k - x) * positive(1 / k - x);
}

static double along(double k, double x) {
  return positive(1 / (k * k) - x * x);
}

static double across(double k, double x) {
  return positive(1 / k - x);
}

static const kink kinks[] = {{of_patches, HR2DI_TAIL_OF_PATCHES},
                             {along, HR2DI_TAIL_OF_PATCHES},
                             {across, HR2DI_TAIL_OF_PATCHES},
                             {across, HR2DI_TAIL_OF_POINTS}};
enum { KINKS = sizeof kinks / sizeof *kinks };

static double sum(const double *weight, unsigned copies, const kink *f, double x) {
  double all = 0;
  for (unsigned k = 1; k <= copies; k++) all += weight[k] * f->term(k, x);
  return all;
}

/* What the extrapolation is off by, over the larger one of `checks` checks. */
static double ratio(const hr2di_tail *t, unsigned copies, const kink *f, double x, int checks) {
  double max = 0, off = sum(t->weight, copies, f, x);
  for (int c = 0; c < checks; c++) max = fmax(max, fabs(sum(t->check[c], copies, f, x)));
  for (double k = copies + 1; k * x < 1; k++) off -= f->term(k, x);
  return max > 0 ? fabs(off) / max : 0;
}

static double worst(unsigned copies, const kink *f, int checks) {
  hr2di_tail t;
  double max = 0;
  hr2di_tail_set(&t, copies, f->power);
  for (int k = 5; k < 330; k++)
    max = fmax(max, ratio(&t, copies, f, k / 100. / copies, checks));
  return max;
}

START_TEST(kinks_are_no_worse_than_the_bound) {
  for (unsigned copies = 1; copies <= HR2DI_MOST_COPIES; copies *= 2)
    for (int k = 0; k < KINKS; k++) {
      const double max = worst(copies, &kinks[k], HR2DI_TAIL_CHECKS);
      ck_assert_msg(max <= HR2DI_TAIL_BOUND, "%u images, kink %d: %g", copies, k, max);
    }
  ck_assert_double_gt(worst(32, &kinks[3], HR2DI_TAIL_CHECKS), 0.8 * HR2DI_TAIL_BOUND);
}
END_TEST

/* The last power alone does not show all of them. */
START_TEST(one_check_does_not_do) {
  for (int k = 0; k < KINKS; k++)
    ck_assert_double_gt(worst(32, &kinks[k], 1), 3 * HR2DI_TAIL_BOUND);
}
END_TEST

/* Σ k⁻⁴ over k > K, by the sum over all k. */
START_TEST(series_are_summed) {
  for (unsigned copies = 2; copies <= HR2DI_MOST_COPIES; copies *= 2) {
    hr2di_tail t;
    double rest = pow(3.14159265358979323846, 4) / 90, is = 0, last = 0, part = 0, half = 0;
    hr2di_tail_set(&t, copies, HR2DI_TAIL_OF_PATCHES);
    for (unsigned k = 1; k <= copies; k++) {
      const double f = pow(k, -4);
      rest -= f;
      is += t.weight[k] * f;
      last += t.check[HR2DI_CHECK_LAST][k] * f;
      part += t.check[HR2DI_CHECK_PART][k] * f;
      half += t.half[k] * f;
    }
    ck_assert_double_eq_tol(is, rest, 1e-14);
    if (copies < 4) continue;
    ck_assert_double_eq_tol(half, copies < 4 ? half : rest, 1e-14);
    ck_assert_double_eq_tol(last, 0, 1e-14);
    ck_assert_double_eq_tol(part, 0, 1e-14);
  }
}
END_TEST

/* The exchange area of two unit plates, a distance apart, one of them moved by k. */
static double plates(double k, double apart) {
  return (hypot(k + 1, apart) - 2 * hypot(k, apart) + hypot(k - 1, apart)) / 2;
}

/* One or two images tell about as much as they are off, and not all that is extrapolated. */
START_TEST(few_images_tell_what_they_are_off) {
  for (unsigned copies = 1; copies <= 2; copies++)
    for (double apart = .5; apart < 1.5; apart *= 2) {
      hr2di_tail t;
      const kink f = {plates, HR2DI_TAIL_OF_PATCHES};
      const double rest = (1 - hypot(copies + 1, apart) + hypot(copies, apart)) / 2;
      hr2di_tail_set(&t, copies, f.power);
      const double is = sum(t.weight, copies, &f, apart), off = fabs(is - rest);
      const double told = fmax(fabs(sum(t.check[HR2DI_CHECK_LAST], copies, &f, apart)),
                               fabs(sum(t.check[HR2DI_CHECK_PART], copies, &f, apart)));
      ck_assert_msg(off <= 2 * told && told <= (copies > 1 ? .3 : .75) * fmax(is, rest),
                    "%u, %g: %g, told %g of %g", copies, apart, off, told, rest);
    }
}
END_TEST

/* Sums of shares have room for the largest weight, those of ranks for this many times the
   images. */
enum { RANKS = 2 };

START_TEST(weights_have_a_bound) {
  for (unsigned copies = 1; copies <= HR2DI_MOST_COPIES; copies *= 2) {
    hr2di_motion motion[2 * HR2DI_MOST_COPIES + 1] = {{0}};
    hr2di_symmetry s = {.motion = motion, .motions = 2 * copies + 1, .copies = copies};
    double max = 1;
    s.by.periodic = 1;
    for (size_t k = 0; k < s.motions; k++) {
      motion[k].periods = (int)k - (int)copies;
      motion[k].weight = 1;
    }
    ck_assert_double_eq(hr2di_symmetry_max(&s), 1);
    hr2di_symmetry_set_weights(&s);
    for (size_t k = 0; k < s.motions; k++) {
      max = fmax(max, fabs(motion[k].weight));
      for (int c = 0; c < HR2DI_TAIL_CHECKS; c++) max = fmax(max, fabs(motion[k].check[c]));
    }
    ck_assert_double_eq(hr2di_symmetry_max(&s), max);
    ck_assert_double_gt(max, 1);
    ck_assert_double_le(max, RANKS * (double)s.motions);
    printf("%u copies: weights up to %g\n", copies, max);
  }
}
END_TEST

TEST_SUITE("period weights") {
  ADD_TESTS("bound", weights_have_a_bound);
  ADD_TESTS("kinks", kinks_are_no_worse_than_the_bound, one_check_does_not_do);
  ADD_TESTS("series", series_are_summed, few_images_tell_what_they_are_off);
}
