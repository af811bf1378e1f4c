/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The law of N and L with its constants: means of counts over the phases of ε, against
   hr2d_study_law(), and constants against closed forms.  A law that is off by a link in a
   thousand, or whose ε is off by 2e-4, is refused where it is tested that closely. */
#include <math.h>
#include <string.h>

#include "support/support.h"

enum { PHASES = 64 };

#define LN2     0.69314718055994530942
#define CATALAN 0.91596559417721901505

static const hr2d_policy *variant(int modified) {
  return modified ? hr2d_policy_modified() : hr2d_policy_original();
}

static hr2d_study_constants law_of(test_links *t) {
  hr2d_study_constants law;
  ck_assert_msg(hr2d_study_law(t->links, NULL, &law) == HR2D_OK, "%s",
                hr2d_linkset_message(t->links));
  return law;
}

static double at(const hr2d_study_term *term, double epsilon) {
  double sum = 0;
  for (int k = 0; k < 3; k++) sum += term[k].factor * pow(epsilon, -term[k].power);
  return sum;
}

/* Means over the phases of what is counted, by what the law says. */
typedef struct ratios {
  double links, elements, first_links; /* the last one by the first term alone */
  double most_links;
} ratios;

/* Around the ε at which L is `links`.  `grid` is an ε at which all leaves of parallel patches
   are halved, so that phases are never next to it; 0 for others. */
static ratios measure(test_links *t, double links, double grid, double of_epsilon) {
  const hr2d_study_constants law = law_of(t);
  const double p = law.links[0].power, q = law.elements[0].power;
  double start = pow(law.links[0].factor / links, 1 / p);
  double said[3] = {0}, counted[2] = {0}, most = 0;
  if (grid > 0) start = grid * exp2(round(log2(start / grid)));
  for (int k = 0; k < PHASES; k++) {
    const double epsilon = start * pow(law.period, 0.5 - (k + 0.5) / PHASES);
    hr2d_study_row row;
    ck_assert_int_eq(hr2d_study_run(t->links, NULL, &epsilon, 1, &row, NULL), HR2D_OK);
    counted[0] += (double)row.counts.links * pow(epsilon, p);
    counted[1] += (double)row.counts.elements * pow(epsilon, q);
    said[0] += at(law.links, epsilon * of_epsilon) * pow(epsilon, p);
    said[1] += at(law.elements, epsilon * of_epsilon) * pow(epsilon, q);
    said[2] += law.links[0].factor;
    most = fmax(most, (double)row.counts.links);
  }
  return (ratios){counted[0] / said[0], counted[1] / said[1], counted[0] / said[2], most};
}

/* N converges like ε, and so do the last terms of L. */
static double bar(double at_million, double links) {
  return at_million * fmax(1, sqrt(1e6 / links));
}

static int holds(ratios r, double links, double elements) {
  return fabs(r.links - 1) < links && fabs(r.elements - 1) < elements;
}

static double million(void) {
  return 2e6 * fmax(fmin(test_multiplier(), 1), 0.025);
}

static const struct {
  const char *name;
  double grid; /* 1/d of parallel patches */
} four_scenes[] = {{"par0.1", 10}, {"par1", 1}, {"orth0.1", 0}, {"orth1", 0}};

static void check_four(const hr2d_oracle *oracle, double wanted, double links,
                       double elements) {
  const int square = oracle == hr2d_oracle_size2();
  for (int k = 0; k < 8; k++) {
    if (!test_meets((size_t)k / 2, (size_t)k % 2, 2)) continue;
    const double grid = four_scenes[k / 2].grid;
    test_links t = test_make_links(test_named_scene(four_scenes[k / 2].name), oracle, NULL,
                                   variant(k % 2), NULL);
    const ratios r = measure(&t, wanted, square ? grid * grid : grid, 1);
    printf("%-8s %-5s %-8s L %.2g: %.5f N %.5f\n", four_scenes[k / 2].name, oracle->name,
           variant(k % 2)->name, r.most_links, r.links, r.elements);
    ck_assert(holds(r, bar(links, wanted), bar(elements, wanted)));
    test_free_links(&t);
  }
}

START_TEST(paper_scenes_follow_the_law) {
  check_four(hr2d_oracle_size(), million(), 1e-3, 3e-3);
}
END_TEST

START_TEST(the_square_follows_it_too) {
  check_four(hr2d_oracle_size2(), fmin(million(), 3e4), 1e-3, 3e-3);
}
END_TEST

START_TEST(the_exact_oracle_follows_the_law) {
  check_four(hr2d_oracle_l1(), fmin(million(), 1e5), 5e-3, 5e-3);
}
END_TEST

/* Two patches that see each other wholly, neither too near. */
static hr2d_scene *random_pair(randoms *r) {
  for (;;) {
    const double x = random_between(r, -.7, 1.7), y = random_between(r, .1, 1.2);
    const double turn = random_between(r, -1.3, 1.3), l = exp2(random_between(r, -1, 1)) / 2;
    const double u = -cos(turn) * l, v = sin(turn) * l;
    const double p[2][6] = {{0, 0, 1, 0, 1, .5}, {x - u, y - v, x + u, y + v, 0, .5}};
    const hr2d_point a = {p[1][0], p[1][1]}, b = {p[1][2], p[1][3]};
    const double nx = -(b.y - a.y) / (2 * l), ny = (b.x - a.x) / (2 * l);
    const double front = (0 - a.x) * nx - a.y * ny, behind = (1 - a.x) * nx - a.y * ny;
    if (fmin(a.y, b.y) > 0.05 && fmin(front, behind) > 0.02) return test_scene(p, 2);
  }
}

START_TEST(random_pairs_follow_the_law) {
  const int pairs = test_multiplier() < 1 ? 8 : 20;
  double worst[2] = {0};
  for (int k = 0; k < pairs; k++) {
    randoms r = randoms_stream(test_seed(), k);
    const hr2d_oracle *oracle = k % 4 == 3 ? hr2d_oracle_size2() : hr2d_oracle_size();
    test_links t = test_make_links(random_pair(&r), oracle, NULL, variant(k % 2), NULL);
    const ratios got = measure(&t, million(), 0, 1);
    worst[0] = fmax(worst[0], fabs(got.links - 1));
    worst[1] = fmax(worst[1], fabs(got.elements - 1));
    ck_assert_msg(holds(got, bar(1e-3, million()), bar(3e-3, million())),
                  "pair %d: L %.5f N %.5f", k, got.links, got.elements);
    test_free_links(&t);
  }
  printf("%d pairs: L off by at most %.1e, N by %.1e\n", pairs, worst[0], worst[1]);
}
END_TEST

/* In the orthogonal scenes leaves have all sizes, so that 64 phases are enough for 1.5e-4 in L.
 */
START_TEST(what_is_not_the_law_is_refused) {
  for (int modified = 0; modified < 2; modified++) {
    test_links t =
        test_make_links(test_named_scene("orth0.1"), NULL, NULL, variant(modified), NULL);
    ratios r = measure(&t, 1e5, 0, 1);
    printf("orth0.1 %s: L %.6f\n", variant(modified)->name, r.links);
    ck_assert_double_lt(fabs(r.links - 1), 1.5e-4);
    /* A link in a thousand is left out. */
    ck_assert_double_gt(fabs(r.links * 0.999 - 1), 1.5e-4);
    /* ε is too large by 2e-4. */
    r = measure(&t, 1e5, 0, 1 + 2e-4);
    ck_assert_double_gt(fabs(r.links - 1), 1.5e-4);
    test_free_links(&t);
  }
  /* The law of one variant is not that of the other, where lengths differ. */
  const double p[][6] = {{0, 0, 1.37, 0, 1, .5}, {1.1, .8, .1, .93, 0, .5}};
  test_links one = test_make_links(test_scene(p, 2), NULL, NULL, variant(0), NULL);
  test_links other = test_make_links(test_scene(p, 2), NULL, NULL, variant(1), NULL);
  ck_assert_double_gt(law_of(&other).links[0].factor / law_of(&one).links[0].factor, 1.4);
  test_free_links(&one);
  test_free_links(&other);
}
END_TEST

/* A table between two walls, with a lamp beside it. */
static hr2d_scene *screened(int both) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_sides side = HR2D_SIDES_FRONT;
  test_add_patch(scene, (hr2d_segment){{0, 0}, {1, 0}}, 1, .5, side);
  test_add_patch(scene, (hr2d_segment){{1.1, .8}, {.1, .8}}, 1, .5, side);
  test_add_patch(scene, (hr2d_segment){{.35, .4}, {.75, .45}}, 1, .5, HR2D_SIDES_BOTH);
  if (both) test_add_patch(scene, (hr2d_segment){{-.4, .7}, {-.4, .3}}, 1, .5, side);
  test_commit(scene);
  return scene;
}

START_TEST(occluded_scenes_follow_the_law) {
  for (int k = 0; k < 4; k++) {
    const double wanted = fmax(2e7 * pow(fmin(test_multiplier(), 1), 2), 5e4);
    test_links t = test_make_links(screened(k / 2), NULL, NULL, variant(k % 2), NULL);
    const ratios r = measure(&t, wanted, 0, 1);
    printf("screened, %s: L %.2g: %.5f (%.5f) N %.5f\n", variant(k % 2)->name, r.most_links,
           r.links, r.first_links, r.elements);
    ck_assert(holds(r, 2e-3, bar(3e-3, wanted)));
    /* The edges of shadows matter here. */
    if (wanted < 3e5) ck_assert_double_gt(r.first_links - 1, 4e-3);
    test_free_links(&t);
  }
}
END_TEST

/* The least distance of the ends of each of two segments from the other one; 0 if they cross.
 */
static double clearance(hr2d_segment s, hr2d_segment t) {
  const hr2d_point end[] = {s.a, s.b, t.a, t.b};
  double least = HUGE_VAL;
  if (hr2d_orientation(s.a, s.b, t.a) != hr2d_orientation(s.a, s.b, t.b) &&
      hr2d_orientation(t.a, t.b, s.a) != hr2d_orientation(t.a, t.b, s.b))
    return 0;
  for (int k = 0; k < 4; k++) {
    const hr2d_segment of = k < 2 ? t : s;
    const double ux = of.b.x - of.a.x, uy = of.b.y - of.a.y;
    const double px = end[k].x - of.a.x, py = end[k].y - of.a.y;
    const double along = fmax(0, fmin(1, (px * ux + py * uy) / (ux * ux + uy * uy)));
    least = fmin(least, hypot(px - along * ux, py - along * uy));
  }
  return least;
}

/* Seven patches of one or two sides in a square, which hide each other and do not touch. */
static hr2d_scene *random_screens(randoms *r) {
  enum { SCREENS = 7 };
  hr2d_segment s[SCREENS];
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < SCREENS;) {
    const double x = random_between(r, 0, 2), y = random_between(r, 0, 2);
    const double l = random_between(r, .3, 1.1), turn = random_between(r, 0, 6.3);
    double least = HUGE_VAL;
    s[k] = (hr2d_segment){{x, y}, {x + l * cos(turn), y + l * sin(turn)}};
    for (int j = 0; j < k; j++) least = fmin(least, clearance(s[j], s[k]));
    k += least > 0.15;
  }
  for (int k = 0; k < SCREENS; k++)
    test_add_patch(scene, s[k], 1, .5, random_below(r, 2) ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT);
  test_commit(scene);
  return scene;
}

START_TEST(random_screens_follow_the_law) {
  const int scenes = test_multiplier() < 1 ? 4 : 20;
  double worst[3] = {0};
  for (int k = 0; k < scenes; k++) {
    randoms r = randoms_stream(test_seed(), 100 + k);
    test_links t = test_make_links(random_screens(&r), NULL, NULL, variant(k % 2), NULL);
    const ratios got = measure(&t, million(), 0, 1);
    worst[0] = fmax(worst[0], fabs(got.links - 1));
    worst[1] = fmax(worst[1], fabs(got.elements - 1));
    worst[2] = fmax(worst[2], fabs(got.first_links - 1));
    ck_assert_msg(holds(got, bar(2e-3, million()), bar(3e-3, million())),
                  "scene %d: L %.5f N %.5f", k, got.links, got.elements);
    test_free_links(&t);
  }
  printf("%d scenes of screens: L off by at most %.1e (%.1e), N by %.1e\n", scenes, worst[0],
         worst[2], worst[1]);
  ck_assert_double_gt(worst[2], bar(2e-3, million())); /* without edges */
}
END_TEST

/* A horizon: the line of the first patch crosses the second, and nothing is in the way. */
START_TEST(horizons_follow_the_law) {
  const double p[][6] = {{0, 0, 1, 0, 1, .5}, {1.4, -.4, 1.5, .73, 1, .5}};
  for (int k = 0; k < 4; k++) {
    test_links t = test_make_links(test_scene(p, 2), k / 2 ? hr2d_oracle_l1() : NULL, NULL,
                                   variant(k % 2), NULL);
    const ratios r = measure(&t, 1e5, 0, 1);
    printf("horizon, %s: L %.5f N %.5f\n", variant(k % 2)->name, r.links, r.elements);
    ck_assert(holds(r, 3e-3, 1e-2));
    test_free_links(&t);
  }
}
END_TEST

/* With `l1` elements at the edges of shadows are of length ε^½, elsewhere of ε^⅓. */
START_TEST(shadows_change_the_power_of_the_exact_oracle) {
  for (int modified = 0; modified < 2; modified++) {
    test_links t =
        test_make_links(screened(0), hr2d_oracle_l1(), NULL, variant(modified), NULL);
    const hr2d_study_constants law = law_of(&t);
    ck_assert_double_eq_tol(law.links[0].power / law.elements[0].power, 4. / 3, 1e-15);
    ck_assert_double_eq(law.elements[1].power, 1. / 3);
    ck_assert_double_eq(law.elements[2].factor, -4);
    const ratios r = measure(&t, 3e4, 0, 1);
    printf("screened, l1 %s: L %.5f (%.5f) N %.5f\n", variant(modified)->name, r.links,
           r.first_links, r.elements);
    ck_assert(holds(r, 2e-2, 5e-2));
    ck_assert(!(fabs(r.first_links - 1) < 2e-2));
    test_free_links(&t);
  }
}
END_TEST

/* Ti₂(x) = ∫ atan(x)/x dx. */
static double arctangent_integral(double x) {
  double sum = 0, power = x;
  for (int k = 0; k < 60; k++, power *= -x * x) sum += power / ((2. * k + 1) * (2. * k + 1));
  return sum;
}

static void expect(hr2d_study_term term, double value) {
  ck_assert_double_eq_tol(term.factor, value, 1e-9 * fabs(value));
  ck_assert_double_lt(fabs(term.factor - value), 10 * term.error + 1e-13 * fabs(value));
}

START_TEST(constants_have_closed_forms) {
  for (int k = 0; k < 4; k++) {
    const double d = k % 2 ? 1 : 0.1, g = 1 / d, q = (1 + d) / d;
    const char *const name[] = {"par0.1", "par1", "orth0.1", "orth1"};
    test_links t = test_make_links(test_named_scene(name[k]), NULL, NULL, variant(1), NULL);
    const hr2d_study_constants law = law_of(&t);
    const double parallel = 2 * (g * atan(g) - 0.5 * log(1 + g * g));
    const double orthogonal = 2 * arctangent_integral(1 / q) + acos(0) * log(q) - 2 * CATALAN;
    expect(law.links[0], 1.5 / LN2 * (k < 2 ? parallel : orthogonal));
    expect(law.elements[0], 4 / LN2 * (k < 2 ? g : asinh(q) - asinh(1)));
    ck_assert_double_eq(law.links[0].power, 2);
    ck_assert_double_eq(law.elements[0].power, 1);
    ck_assert_double_eq(law.elements[1].factor, -2);
    ck_assert_double_eq(law.period, 2);
    ck_assert(law.links[1].factor == 0 && law.links[2].factor == 0);
    test_free_links(&t);
  }
}
END_TEST

/* Lengths k to 1: `modified` has k times the links; `original` (2^δ + 2^(1−δ))/3 times. */
START_TEST(lengths_enter_as_derived) {
  for (double k = 1; k < 20; k *= 1.31) {
    const double p[][6] = {{0, 0, k, 0, 1, .5}, {1, 1, 0, 1, 1, .5}};
    test_links t[2];
    hr2d_study_constants law[2];
    for (int m = 0; m < 2; m++) {
      t[m] = test_make_links(test_scene(p, 2), NULL, NULL, variant(m), NULL);
      law[m] = law_of(&t[m]);
      test_free_links(&t[m]);
    }
    const double delta = log2(k) - floor(log2(k));
    ck_assert_double_eq_tol(law[0].links[0].factor / law[1].links[0].factor * k,
                            (exp2(delta) + exp2(1 - delta)) / 3, 1e-9);
  }
}
END_TEST

/* A patch that sees nothing stays whole: it is one element. */
START_TEST(patches_without_a_view_are_one_element) {
  const double p[][6] = {{0, 0, 1, 0, 1, .5},
                         {1, 1, 0, 1, 1, .5},
                         {1, -1, 0, -1, 1, .5},
                         {3, 0, 2, 0, 1, .5},
                         {5, 0, 4, 0, 1, .5}};
  for (int k = 0; k < 4; k++) {
    const int blind = k / 2;
    test_links t = test_make_links(test_scene(p + 2 * blind, blind ? 3 : 5),
                                   k % 2 ? hr2d_oracle_l1() : NULL, NULL, NULL, NULL);
    const hr2d_study_constants law = law_of(&t);
    ck_assert_double_eq(law.elements[1].factor, blind ? 3 : 3 - 2);
    ck_assert_double_eq(law.elements[1].power, 0);
    const double epsilon = 0.01;
    hr2d_study_row row;
    ck_assert_int_eq(hr2d_study_run(t.links, NULL, &epsilon, 1, &row, NULL), HR2D_OK);
    if (blind) ck_assert_double_eq(at(law.elements, epsilon), (double)row.counts.elements);
    if (blind) ck_assert_double_eq(at(law.links, epsilon), (double)row.counts.links);
    test_free_links(&t);
  }
}
END_TEST

/* Scenes of other units: `size` has no length, ε of `l1` is one. */
START_TEST(units_do_not_matter) {
  const double s = 300;
  const double p[][6] = {{0, 0, 1, 0, 1, .5}, {1, .3, .2, .5, 1, .5}};
  const double q[][6] = {{0, 0, s, 0, 1, .5}, {s, .3 * s, .2 * s, .5 * s, 1, .5}};
  for (int l1 = 0; l1 < 2; l1++) {
    const hr2d_oracle *oracle = l1 ? hr2d_oracle_l1() : hr2d_oracle_size();
    test_links one = test_make_links(test_scene(p, 2), oracle, NULL, variant(0), NULL);
    test_links other = test_make_links(test_scene(q, 2), oracle, NULL, variant(0), NULL);
    const hr2d_study_constants a = law_of(&one), b = law_of(&other);
    for (int k = 0; k < 2; k++) {
      const hr2d_study_term *x = k ? a.elements : a.links, *y = k ? b.elements : b.links;
      const double power = l1 ? x->power : 0;
      ck_assert_double_eq_tol(y->factor / x->factor / pow(s, power), 1, 1e-5);
    }
    test_free_links(&one);
    test_free_links(&other);
  }
}
END_TEST

static void refuse(hr2d_scene *scene, const hr2d_oracle *oracle, int ordered,
                   const char *phrase) {
  hr2d_study_constants law = {.period = 77};
  test_links t = test_make_links(scene, oracle, NULL, NULL, NULL);
  const hr2d_refine_options options = {.struct_size = sizeof options, .ordered = ordered};
  ck_assert_int_eq(hr2d_study_law(t.links, &options, &law), HR2D_EUNSUPPORTED);
  ck_assert_msg(strstr(hr2d_linkset_message(t.links), phrase), "%s",
                hr2d_linkset_message(t.links));
  ck_assert_double_eq(law.period, 77);
  test_free_links(&t);
}

START_TEST(what_has_no_law_is_refused) {
  const double corner[][6] = {{0, 0, 1, 0, 1, .5}, {1, 0, 1, .8, 1, .5}};
  const double foot[][6] = {{0, 0, 1, .3, 1, .5}, {.4, .12, .3, .8, 1, .5}};
  const double outside[][6] = {{0, 0, 1, 0, 1, .5}, {1, 0, 1, -.8, 1, .5}, {1, 1, 0, 1, 1, .5}};
  refuse(test_named_scene("par1"), hr2d_oracle_bf(), 0, "\"bf\"");
  refuse(test_named_scene("par1"), hr2d_oracle_l1_grid(), 0, "\"l1-grid\"");
  refuse(test_named_scene("par1"), NULL, 1, "ordered");
  refuse(test_scene(corner, 2), NULL, 0, "patch 0 and patch 1 touch");
  refuse(test_scene(foot, 2), hr2d_oracle_size2(), 0, "patch 0 and patch 1 touch");
  /* In a corner `l1` has a law, and in a corner whose patches do not see each other all have.
   */
  test_links t = test_make_links(test_scene(corner, 2), hr2d_oracle_l1(), NULL, NULL, NULL);
  const ratios r = measure(&t, 3e4, 0, 1);
  printf("corner, l1: L %.5f N %.5f\n", r.links, r.elements);
  ck_assert(holds(r, 5e-3, 2e-2));
  test_free_links(&t);
  t = test_make_links(test_scene(outside, 3), NULL, NULL, NULL, NULL);
  law_of(&t);
  test_free_links(&t);
}
END_TEST

/* The order of the blocks of links is not asked for by the oracle: the links are the same. */
START_TEST(the_order_does_not_enter) {
  hr2d_study_constants law[2];
  size_t links[2];
  for (unsigned k = 0; k < 2; k++) {
    test_links t = test_make_links(test_named_scene("orth0.1"), NULL, NULL, NULL, NULL);
    ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, k ? 4 : 1), HR2D_OK);
    law[k] = law_of(&t);
    test_refine(&t, 0.05, 24);
    links[k] = hr2d_linkset_size(t.links);
    test_free_links(&t);
  }
  ck_assert_mem_eq(&law[0], &law[1], sizeof law[0]);
  ck_assert_uint_eq(links[0], links[1]);
}
END_TEST

static hr2d_status stop(void *ctx, const hr2d_progress *progress) {
  ck_assert_str_eq(progress->phase, "law");
  ck_assert(progress->fraction >= 0 && progress->fraction <= 1);
  ++*(int *)ctx;
  return HR2D_STOPPED;
}

START_TEST(it_can_be_stopped) {
  int calls = 0;
  test_links t = test_make_links(screened(1), hr2d_oracle_l1(), NULL, NULL, NULL);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.progress = stop;
  options.progress_ctx = &calls;
  hr2d_study_constants law = {.period = 77};
  ck_assert_int_eq(hr2d_study_law(t.links, &options, &law), HR2D_STOPPED);
  ck_assert_int_eq(calls, 1);
  ck_assert_double_eq(law.period, 77);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("law") {
  ADD_TESTS("counts", paper_scenes_follow_the_law, the_square_follows_it_too,
            the_exact_oracle_follows_the_law, random_pairs_follow_the_law,
            what_is_not_the_law_is_refused);
  ADD_TESTS("views", occluded_scenes_follow_the_law, random_screens_follow_the_law,
            horizons_follow_the_law, shadows_change_the_power_of_the_exact_oracle);
  ADD_TESTS("constants", constants_have_closed_forms, lengths_enter_as_derived,
            patches_without_a_view_are_one_element, units_do_not_matter,
            the_order_does_not_enter);
  ADD_TESTS("refusals", what_has_no_law_is_refused, it_can_be_stopped);
}
