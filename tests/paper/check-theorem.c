/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The statements of the paper, one by one: Theorem 1, equations (3), inequalities (4) and
   (5), the cost of the modified algorithm, footnote 3 and multigridding.  If a statement
   holds only under a condition, the test states the condition and shows a counterexample
   without it. */
#include <gsl/gsl_fit.h>
#include <gsl/gsl_multifit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

static const char *const four_scenes[] = {"par0.1", "par1", "orth0.1", "orth1"};

static const hr2d_policy *variant(int modified) {
  return modified ? hr2d_policy_modified() : hr2d_policy_original();
}

/* Two patches that face each other, of lengths l and m, at distance d. */
static hr2d_scene *facing(double l, double m, double d) {
  return test_scene((const double[][6]){{0, 0, l, 0, 1, .5}, {m, d, 0, d, 0, .5}}, 2);
}

/* The same around a corner; both patches keep the distance d from it. */
static hr2d_scene *corner(double l, double m, double d) {
  return test_scene((const double[][6]){{d, 0, l + d, 0, 1, .5}, {0, m + d, 0, d, 0, .5}}, 2);
}

/* Counts, and destroys the scene. */
static hr2d_refine_counts count(hr2d_scene *scene, const hr2d_oracle *oracle, int modified,
                                double epsilon) {
  test_links t = test_make_links(scene, oracle, NULL, variant(modified), NULL);
  const hr2d_refine_options options = test_epsilon(epsilon);
  hr2d_refine_counts counts;
  ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_OK);
  ck_assert_uint_eq(counts.limited_links, 0);
  test_free_links(&t);
  return counts;
}

static test_links refined(hr2d_scene *scene, const hr2d_oracle *oracle, int modified,
                          double epsilon) {
  test_links t = test_make_links(scene, oracle, NULL, variant(modified), NULL);
  const hr2d_refine_options options = test_epsilon(epsilon);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  return t;
}

/* What was found of a number, to be printed; nothing may have been. */
typedef struct range {
  double low, high;
} range;

static const range nothing = {HUGE_VAL, -HUGE_VAL};

static void note(double value, range *r) {
  r->low = fmin(r->low, value);
  r->high = fmax(r->high, value);
}

typedef struct text {
  char of[48];
} text;

static text describe(range r) {
  text t = {"none"};
  if (r.low <= r.high) snprintf(t.of, sizeof t.of, "from %.4g to %.4g", r.low, r.high);
  return t;
}

START_TEST(a_range_of_nothing_says_so) {
  range r = nothing;
  ck_assert_str_eq(describe(r).of, "none");
  note(2, &r);
  ck_assert_str_eq(describe(r).of, "from 2 to 2");
  note(-0.5, &r);
  ck_assert_str_eq(describe(r).of, "from -0.5 to 2");
}
END_TEST

/* --- Theorem 1 --- */

enum { OCTAVES = 6, MOST_PHASES = 8, MOST_ROWS = 11 * MOST_PHASES };

/* Results of fits to rows with ε = 2^-(octave + phase/phases).  N grows in steps, so that
   several dots share an N; dots of one phase do not. */
typedef struct growth {
  double min_slope, max_slope; /* of log L on log N, over the phases */
  double certainty;            /* c by its standard error in a + bN + cN², the least of them */
  double c, c_error;           /* in the polynomial through the dots of all phases */
  double trend;                /* see fit_law() */
  double span;                 /* largest L over smallest */
} growth;

/* Least squares of y on 1, x, x²: a coefficient and its standard error. */
static void fit_square(const double *x, const double *y, size_t n, double *q, double *error) {
  gsl_matrix *powers = gsl_matrix_alloc(n, 3), *covariance = gsl_matrix_alloc(3, 3);
  gsl_vector *coefficient = gsl_vector_alloc(3);
  gsl_multifit_linear_workspace *work = gsl_multifit_linear_alloc(n, 3);
  const gsl_vector_const_view values = gsl_vector_const_view_array(y, n);
  double squares;
  for (size_t k = 0; k < n; k++)
    for (size_t p = 0; p < 3; p++) gsl_matrix_set(powers, k, p, pow(x[k], (double)p));
  ck_assert_int_eq(
      gsl_multifit_linear(powers, &values.vector, coefficient, covariance, &squares, work), 0);
  *q = gsl_vector_get(coefficient, 2);
  *error = sqrt(gsl_matrix_get(covariance, 2, 2));
  gsl_multifit_linear_free(work);
  gsl_vector_free(coefficient);
  gsl_matrix_free(covariance);
  gsl_matrix_free(powers);
}

/* c of a + bN + cN², with N and L scaled to at most 1. */
static double fit_polynomial(const double *n, const double *l, size_t count, size_t stride,
                             double *error) {
  double u[MOST_ROWS], v[MOST_ROWS], max = 0, c;
  for (size_t k = 0; k < count; k++) max = fmax(max, n[k * stride]);
  for (size_t k = 0; k < count; k++) {
    u[k] = n[k * stride] / max;
    v[k] = l[k * stride] / max / max;
  }
  fit_square(u, v, count, &c, error);
  return c;
}

/* The trend of the residuals is Student's t of a square of log N that is added to the
   straight line of logarithms: a law that bends leaves residuals that do.  It is measured
   by the scatter of the stacks; one phase alone has none, and would show every 1/N. */
static growth fit_law(const double *n, const double *l, size_t octaves, size_t phases) {
  const size_t rows = octaves * phases;
  double x[MOST_ROWS], y[MOST_ROWS], mean = 0, low = l[0], high = l[0], q, error;
  growth law = {.min_slope = HUGE_VAL, .max_slope = -HUGE_VAL, .certainty = HUGE_VAL};
  for (size_t k = 0; k < rows; k++) {
    x[k] = log(n[k]);
    y[k] = log(l[k]);
    mean += x[k] / (double)rows;
    low = fmin(low, l[k]);
    high = fmax(high, l[k]);
  }
  for (size_t k = 0; k < phases; k++) {
    double c0, slope, c00, c01, c11, squares;
    gsl_fit_linear(x + k, phases, y + k, phases, octaves, &c0, &slope, &c00, &c01, &c11,
                   &squares);
    law.min_slope = fmin(law.min_slope, slope);
    law.max_slope = fmax(law.max_slope, slope);
    q = fit_polynomial(n + k, l + k, octaves, phases, &error);
    law.certainty = fmin(law.certainty, q / error);
  }
  for (size_t k = 0; k < rows; k++) x[k] -= mean;
  fit_square(x, y, rows, &q, &error);
  law.trend = q / error;
  law.c = fit_polynomial(n, l, rows, 1, &law.c_error);
  law.span = high / low;
  return law;
}

/* What "grows quadratically" is taken to mean, over three decades of L at least.  A t
   of 22 with 6 dots and 3 coefficients comes by chance once in 10⁴ times. */
static int is_quadratic(const growth *law) {
  return law->min_slope >= 1.95 && law->max_slope <= 2.05 && law->certainty > 22 &&
         fabs(law->trend) < 3 && law->span >= 1000;
}

static void print_law(const char *what, const growth *law) {
  printf("%-26s slopes %.4f..%.4f, c by %.3g errors, of all dots %.3g ± %.1g, trend t = %.2f, "
         "L over %.0f\n",
         what, law->min_slope, law->max_slope, law->certainty, law->c, law->c_error, law->trend,
         law->span);
  fflush(stdout);
}

/* Fewer phases and a coarser end save work; the bounds stay the same. */
static size_t phases(void) {
  return test_multiplier() < 0.5 ? 4 : MOST_PHASES;
}

/* The largest L.  par0.1, the longest patches for their distance, settles last. */
static double fine_end(const char *scene, const hr2d_oracle *oracle) {
  if (oracle == hr2d_oracle_l1()) return 2e6;
  return fmax((strcmp(scene, "par0.1") == 0 ? 3e7 : 1e7) * test_multiplier(), 2e6);
}

typedef struct dots {
  double n[MOST_ROWS], l[MOST_ROWS];
} dots;

/* N and L of a scene down to a fine end that the multiplier sets. */
static void sweep(const char *scene, const hr2d_oracle *oracle, int modified, dots *out) {
  const size_t rows = OCTAVES * phases();
  double epsilon[MOST_ROWS] = {1};
  hr2d_study_row row[MOST_ROWS];
  test_links t =
      test_make_links(test_named_scene(scene), oracle, NULL, variant(modified), NULL);
  /* For the same step of L the square of max(A)/r needs the square of ε, and the L¹ error,
     which falls like A³, the cube. */
  const double p = oracle == hr2d_oracle_size2() ? 2 : oracle == hr2d_oracle_l1() ? 3 : 1;
  for (;; epsilon[0] /= pow(2, p)) {
    ck_assert_int_eq(hr2d_study_run(t.links, NULL, epsilon, 1, row, NULL), HR2D_OK);
    if (4. * (double)row[0].counts.links > fine_end(scene, oracle)) break;
  }
  for (size_t k = 1; k < rows; k++)
    epsilon[k] = epsilon[0] * pow(2, p * (double)k / (double)phases());
  ck_assert_int_eq(hr2d_study_run(t.links, NULL, epsilon, rows, row, NULL), HR2D_OK);
  for (size_t k = 0; k < rows; k++) {
    out->n[k] = (double)row[k].counts.elements;
    out->l[k] = (double)row[k].counts.links;
  }
  test_free_links(&t);
}

static void check_theorem(const hr2d_oracle *oracle) {
  for (int k = 0; k < 8; k++) {
    dots d;
    char what[64];
    if (!test_meets((size_t)k / 2, (size_t)k % 2, 2)) continue;
    snprintf(what, sizeof what, "%s %s %s", four_scenes[k / 2], oracle->name,
             variant(k % 2)->name);
    sweep(four_scenes[k / 2], oracle, k % 2, &d);
    const growth law = fit_law(d.n, d.l, OCTAVES, phases());
    print_law(what, &law);
    ck_assert_msg(is_quadratic(&law), "%s", what);
  }
}

START_TEST(links_are_quadratic_in_elements) {
  check_theorem(hr2d_oracle_size());
}
END_TEST

/* Footnote 3. */
START_TEST(links_are_quadratic_for_the_squared_oracle) {
  check_theorem(hr2d_oracle_size2());
}
END_TEST

/* Hanrahan's refinement, weighted with the emitted brightness. */
START_TEST(links_are_quadratic_where_brightness_weighs) {
  check_theorem(hr2d_oracle_bf());
}
END_TEST

/* The paper's exact oracle, original variant (section 4).  Three scenes support a slope of
   2 ± 0.05 as well; in par0.1, which settles last, single phases are between 1.8 and 2. */
START_TEST(links_are_quadratic_for_the_exact_oracle) {
  for (int k = 0; k < 4; k++) {
    dots d;
    char what[64];
    if (!test_meets((size_t)k, 0, 2)) continue; /* the nearer patches */
    snprintf(what, sizeof what, "%s l1 original", four_scenes[k]);
    sweep(four_scenes[k], hr2d_oracle_l1(), 0, &d);
    const growth law = fit_law(d.n, d.l, OCTAVES, phases());
    print_law(what, &law);
    ck_assert_double_ge(law.min_slope, k == 0 ? 1.8 : 1.95);
    ck_assert_double_le(law.max_slope, 2.05);
    ck_assert_double_gt(law.certainty, 22);
    ck_assert_double_lt(fabs(law.trend), 3);
    ck_assert_double_ge(law.span, 1000);
  }
}
END_TEST

/* The other reading: ε is fixed and g grows.  What accepts Theorem 1 must refuse it. */
START_TEST(links_are_linear_for_a_fixed_epsilon) {
  enum { FIXED_OCTAVES = 13, FIXED_PHASES = 4 };
  const double epsilon = 0.25;
  double n[MOST_ROWS], l[MOST_ROWS];
  for (int modified = 0; modified < 2; modified++) {
    for (int k = 0; k < FIXED_OCTAVES * FIXED_PHASES; k++) {
      const double d = pow(2, -1 - (double)k / FIXED_PHASES);
      const hr2d_refine_counts c = count(facing(1, 1, d), NULL, modified, epsilon);
      n[k] = (double)c.elements;
      l[k] = (double)c.links;
      /* Θ(N) for 1/ε: the bounds derived at links_are_elements_over_epsilon. */
      ck_assert_double_lt(l[k] / n[k], 2 / epsilon + 1.5);
      if (modified) ck_assert_double_gt(l[k] / n[k], 1 / (32 * epsilon));
    }
    const size_t skip = 2 * FIXED_PHASES; /* g < 8: patches too short for their neighbours */
    const growth law = fit_law(n + skip, l + skip, FIXED_OCTAVES - 2, FIXED_PHASES);
    print_law(modified ? "fixed ε, modified" : "fixed ε, original", &law);
    ck_assert_double_ge(law.min_slope, 0.95);
    ck_assert_double_le(law.max_slope, 1.1);
    ck_assert_double_ge(law.span, 1000);
    ck_assert_double_lt(law.certainty, 22);
    ck_assert_double_lt(law.c, 4 * law.c_error);
    ck_assert(!is_quadratic(&law));
  }
}
END_TEST

/* Laws that are nearly N² are refused too, each by one of the criteria at least. */
START_TEST(other_laws_are_refused) {
  dots d;
  double l[MOST_ROWS];
  const size_t rows = OCTAVES * phases(), middle = rows / 2;
  for (int k = 0; k < 4; k++) {
    sweep(four_scenes[k], hr2d_oracle_size(), 1, &d);
    for (size_t m = 0; m < rows; m++) /* as much linear as quadratic in the middle */
      l[m] = d.l[m] + d.n[m] * d.l[middle] / d.n[middle];
    growth law = fit_law(d.n, l, OCTAVES, phases());
    ck_assert(!is_quadratic(&law));
    for (size_t m = 0; m < rows; m++) l[m] = pow(d.l[m], 0.95);
    law = fit_law(d.n, l, OCTAVES, phases());
    ck_assert(!is_quadratic(&law));
    for (size_t m = 0; m < rows; m++) l[m] = d.l[m] * log(d.n[m]);
    law = fit_law(d.n, l, OCTAVES, phases());
    ck_assert(!is_quadratic(&law));
    for (size_t m = 0; m < rows; m++) l[m] = d.n[m];
    law = fit_law(d.n, l, OCTAVES, phases());
    ck_assert(!is_quadratic(&law));
  }
}
END_TEST

/* --- Equations (3), for the modified algorithm on two facing patches --- */

/* ½dε < A_leaf ≤ dε where the patches themselves are refused, g > ε, so that
   N = 2(2 N_leaf − 1), N_leaf = l/A_leaf gives 4g/ε − 2 ≤ N < 8g/ε − 2. */
START_TEST(elements_are_g_over_epsilon) {
  unsigned long state = test_seed();
  range tried = nothing, found = nothing;
  for (int k = 0; k < (int)test_rounds(400, 20); k++) {
    const double g = pow(2, 10 * test_random(&state)), d = pow(10, 6 * test_random(&state) - 3);
    const double epsilon = g * pow(2, -11 * test_random(&state));
    if (g / epsilon / epsilon > 1e5) continue; /* of links, some ten times as many */
    test_links t = test_make_links(facing(g * d, g * d, d), NULL, NULL, variant(1), NULL);
    const hr2d_refine_options options = test_epsilon(epsilon);
    hr2d_refine_counts c;
    ck_assert_int_eq(hr2d_refine_count(t.links, &options, &c), HR2D_OK);
    const double n = (double)c.elements, leaves = (double)c.leaves / 2;
    ck_assert_uint_eq(c.elements, 2 * (c.leaves - 1));
    ck_assert_double_eq(leaves, exp2(ceil(log2(g / epsilon))));
    ck_assert(n >= 4 * g / epsilon - 2 && n < 8 * g / epsilon - 2);
    const hr2d_element *element = hr2d_hierarchy_elements(t.hierarchy);
    const double limit = d / hr2d_scene_unit(t.scene) * epsilon;
    for (uint64_t e = 0; e < c.elements; e++)
      if (!element[e].child)
        ck_assert(0.5 * limit < element[e].length && element[e].length <= limit);
    note(n * epsilon / g, &found);
    note(g / epsilon, &tried);
    test_free_links(&t);
  }
  printf("g/ε %s: N ε/g %s\n", describe(tried).of, describe(found).of);
  ck_assert_double_gt(tried.high / tried.low, test_multiplier() < 0.5 ? 100 : 1000);
  /* Where ε ≥ g nothing is refused, and N stays 2. */
  ck_assert_uint_eq(count(facing(1, 1, 4), NULL, 1, 0.25).elements, 2);
  ck_assert_uint_eq(count(facing(1, 1, 4), NULL, 1, 0.249).elements, 6);
}
END_TEST

/* L ε/N: by (5) an element has at most 4/ε + 3 neighbours, and half the elements are
   on one patch: L ≤ N(2/ε + 3/2).  Below, for g ≥ 1: cut both patches into K pieces, K
   the power of 2 in (g/2, g]; links between facing pieces, of length l' in [d,2d), have
   A² ≤ ε²r² ≤ ε²(d² + l'²) and cover l'² each: L ≥ K/(2ε²) ≥ g/(4ε²) > N/(32ε). */
START_TEST(links_are_elements_over_epsilon) {
  range found = nothing;
  int pairs = 0;
  for (double g = 1; g <= 1024; g *= 1.7)
    for (double epsilon = 0.99; epsilon > 1. / 1024; epsilon *= 0.83) {
      if (g / epsilon / epsilon > fmax(2e5 * test_multiplier(), 1e4)) continue;
      const hr2d_refine_counts c = count(facing(g, g, 1), NULL, 1, epsilon);
      const double ratio = (double)c.links * epsilon / (double)c.elements;
      ck_assert(ratio > 1. / 32 && ratio <= 2 + 1.5 * epsilon);
      note(ratio, &found);
      pairs++;
    }
  printf("%d pairs of g and ε: L ε/N %s\n", pairs, describe(found).of);
  ck_assert_int_gt(pairs, 100);
  /* Patches far apart, g ≪ 1: all leaves see each other at one distance, L = N_leaf²,
     so that L ε/N falls like g.  The second equation needs a g bounded from below. */
  const hr2d_refine_counts c = count(facing(1, 1, 64), NULL, 1, 1. / 64 / 16);
  ck_assert_uint_eq(c.links, 16 * 16);
  ck_assert_double_lt((double)c.links / 64 / 16 / (double)c.elements, 1. / 32);
}
END_TEST

/* --- Inequalities (4) and (5), and the region of neighbours --- */

/* How many neighbours an element has to the left, to the right, and right opposite. */
typedef struct region {
  uint64_t left, right, opposite;
} region;

/* The extremes found below this ε are printed: how loose the bounds are. */
#define NARROW 0.1

typedef struct extremes {
  range r;     /* r ε/A */
  range delta; /* (r − r_parent)/A */
  range side;  /* D ε/A on one side of an element above the leaves */
  range all;   /* and on both sides */
  range leaf;  /* of a leaf */
} extremes;

static double distance(const hr2d_element *i, const hr2d_element *j) {
  return hypot(i->centre.x - j->centre.x, i->centre.y - j->centre.y);
}

/* One link; 2⁻⁵⁰ covers the rounding of r. */
static void check_link(const hr2d_hierarchy *h, hr2d_pair pair, double epsilon, extremes *x) {
  const hr2d_element *element = hr2d_hierarchy_elements(h);
  const hr2d_element *i = &element[pair.first], *j = &element[pair.second];
  const double a = i->length, r = distance(i, j), slack = 1 + 0x1p-50;
  ck_assert_double_eq(a, j->length);
  ck_assert_double_le(a / epsilon, r * slack); /* (4) */
  if (epsilon < NARROW) note(r * epsilon / a, &x->r);
  if (hr2d_element_level(h, pair.first) == 0) return;
  const double parent = distance(&element[hr2d_element_parent(h, pair.first)],
                                 &element[hr2d_element_parent(h, pair.second)]);
  ck_assert_double_lt(parent, 2 * a / epsilon * slack);
  ck_assert_double_le(fabs(r - parent), a * slack);      /* δ in [−1,1] */
  ck_assert_double_lt(r, (2 / epsilon + 1) * a * slack); /* (5) */
  if (epsilon < NARROW) note((r - parent) / a, &x->delta);
}

static void add_neighbour(region *to, const hr2d_element *element,
                          const hr2d_element *neighbour) {
  const double offset = neighbour->centre.x - element->centre.x;
  to->left += offset < 0;
  to->right += offset > 0;
  to->opposite += offset == 0;
}

/* Regions of neighbours.  All neighbours have one length A, so that D/A is their number.
   The bounds of the paper hold for one side of an element with r_min ≥ d, except for one
   more neighbour: at r_min a neighbour is cut off, but links have whole neighbours only. */
static void check_regions(const test_links *t, const region *regions, double epsilon,
                          extremes *x) {
  const hr2d_element *element = hr2d_hierarchy_elements(t->hierarchy);
  for (uint64_t e = 0; e < hr2d_hierarchy_count(t->hierarchy).elements; e++) {
    const double a = element[e].length, reach = (2 / epsilon + 2) * a;
    const double left = (double)regions[e].left, right = (double)regions[e].right;
    const double all = left + right + (double)regions[e].opposite;
    ck_assert_double_le(all, 4 / epsilon + 3);
    ck_assert_uint_eq(regions[e].opposite, !element[e].child);
    if (element[e].centre.x < reach ||
        element[e].centre.x > element[element[e].patch].length - reach)
      continue; /* cut off by an end of the patch */
    if (element[e].child) {
      ck_assert_double_gt(fmin(left, right), 1 / epsilon - 2);
      ck_assert_double_le(fmax(left, right), 3 / epsilon + 1);
    }
    if (epsilon >= NARROW) continue;
    note(all * epsilon, element[e].child ? &x->all : &x->leaf);
    if (!element[e].child) continue;
    note(left * epsilon, &x->side);
    note(right * epsilon, &x->side);
  }
}

static void check_inequalities(double l, double d, double epsilon, extremes *x) {
  test_links t = refined(facing(l, l, d), NULL, 1, epsilon);
  ck_assert_int_eq(hr2d_linkset_validate(t.links), HR2D_OK);
  const hr2d_element *element = hr2d_hierarchy_elements(t.hierarchy);
  const hr2d_hierarchy_counts n = hr2d_hierarchy_count(t.hierarchy);
  region *regions = calloc((size_t)n.elements, sizeof *regions);
  uint64_t facing_leaves = 0;
  for (uint64_t k = 0; k < hr2d_linkset_size(t.links); k++) {
    const hr2d_pair pair = hr2d_linkset_get(t.links, k).pair;
    const hr2d_element *i = &element[pair.first], *j = &element[pair.second];
    check_link(t.hierarchy, pair, epsilon, x);
    add_neighbour(&regions[pair.first], i, j);
    add_neighbour(&regions[pair.second], j, i);
    if (i->centre.x != j->centre.x) continue;
    ck_assert(!i->child && !j->child);
    facing_leaves++;
  }
  /* Every leaf is linked with its directly facing counterpart. */
  ck_assert_uint_eq(facing_leaves, n.leaves / 2);
  check_regions(&t, regions, epsilon, x);
  free(regions);
  test_free_links(&t);
}

START_TEST(every_link_obeys_the_inequalities) {
  extremes x = {nothing, nothing, nothing, nothing, nothing};
  const double g[] = {10, 1, 3, 8, 64};
  const double finest = test_multiplier() < 0.5 ? 0.1 : 0.02;
  for (size_t k = 0; k < sizeof g / sizeof *g; k++)
    for (double epsilon = 1; epsilon > (g[k] > 10 ? 4 : 1) * finest; epsilon *= 0.77)
      check_inequalities(1, 1 / g[k], epsilon, &x);
  printf("for ε < %g: r ε/A %s, δ %s\n", NARROW, describe(x.r).of, describe(x.delta).of);
  printf("D ε/A on one side %s, on both %s, of leaves %s\n", describe(x.side).of,
         describe(x.all).of, describe(x.leaf).of);
}
END_TEST

/* r_max − r_min ≤ D ≤ r_max + r_min supposes that r_min = A/ε is attained.  For leaves it is
   at most d: their neighbours lie wherever 2A/r_parent > ε, |x| < √(4A²/ε² − d²) at both
   sides.  That is D = 2A for A just above ½dε, and 2√3·d > 3A/ε for A = dε. */
START_TEST(regions_of_leaves_break_the_bounds) {
  const double epsilon = 1. / 32;
  for (int wide = 0; wide < 2; wide++) {
    test_links t = refined(facing(8, 8, 1), NULL, 1, wide ? epsilon : epsilon * (1 - 1e-9));
    const hr2d_element *element = hr2d_hierarchy_elements(t.hierarchy);
    const uint32_t leaf = hr2d_hierarchy_leaf(t.hierarchy, 0, 0.5);
    uint64_t neighbours = 0;
    for (uint64_t k = 0; k < hr2d_linkset_size(t.links); k++)
      neighbours += hr2d_linkset_get(t.links, k).pair.first == leaf;
    ck_assert_double_eq(element[leaf].length * 8, wide ? epsilon : epsilon / 2);
    if (wide)
      ck_assert_double_gt((double)neighbours, 3 / epsilon + 1);
    else
      ck_assert_uint_eq(neighbours, 2);
    printf("a leaf of %.2f dε has %llu neighbours, D between %g and %g by the paper\n",
           wide ? 1. : .5, (unsigned long long)neighbours, 1 / epsilon - 1, 3 / epsilon + 1);
    test_free_links(&t);
  }
}
END_TEST

/* --- The cost of the modified algorithm --- */

typedef struct cost {
  double links, elements; /* modified over original */
} cost;

typedef hr2d_scene *(*maker)(double l, double m, double d);

static cost cost_of(maker make, double l, double m, double d, double epsilon) {
  const hr2d_refine_counts original = count(make(l, m, d), NULL, 0, epsilon),
                           modified = count(make(l, m, d), NULL, 1, epsilon);
  return (cost){(double)modified.links / (double)original.links,
                (double)modified.elements / (double)original.elements};
}

/* "Not more than twice the number of links", "elements differ by a constant factor less
   than two": so it is for patches of equal length and ε ≤ 2.  The original then takes
   turns, and what it links on an uneven level, A with A/2 and r ≥ A/ε, has two halves
   A/2 with r' ≥ r − A/4 and A/(2r') ≤ ε/(2 − ε/2) ≤ ε, both linked by the modified one.
   So both refuse the same pairs of equal elements, their trees of the first patch are
   the same, with n nodes each, and of the second patch the original has at least the
   nodes that the modified one subdivides: where that tree has n nodes as well, by
   symmetry, the elements differ by at most 2n/(n + (n−1)/2) = 4/(3 − 1/n), n = 3, 7, … */
START_TEST(modified_costs_less_than_twice) {
  const double distance[] = {0.001, 0.01, 0.1, 1, 10};
  cost worst = {0, 0}, fine = {0, 0};
  int sweeps = 0;
  for (int k = 0; k < 10; k++) {
    const double d = distance[k / 2];
    const maker make = k % 2 ? corner : facing;
    for (double epsilon = 2; epsilon > 1. / 256;
         epsilon *= test_multiplier() < 0.5 ? 0.8 : 0.985) {
      if (make == facing && 1 / (d * epsilon * epsilon) > 2e4) break;
      const cost c = cost_of(make, 1, 1, d, epsilon);
      ck_assert_msg(c.links >= 1 && c.links <= 2 && c.elements >= 1 && c.elements <= 1.5,
                    "distance %g, ε %g: %g and %g", d, epsilon, c.links, c.elements);
      worst = (cost){fmax(worst.links, c.links), fmax(worst.elements, c.elements)};
      if (epsilon < 0.125)
        fine = (cost){fmax(fine.links, c.links), fmax(fine.elements, c.elements)};
      sweeps++;
    }
  }
  printf("%d sweeps: L by up to %.4f, N by up to %.4f; for ε < 1/8 %.4f and %.4f\n", sweeps,
         worst.links, worst.elements, fine.links, fine.elements);
  /* Both are reached: facing unit patches at distance 1, ε just below 1. */
  const cost c = cost_of(facing, 1, 1, 1, 0.997);
  ck_assert_double_eq(c.links, 2);
  ck_assert_double_eq(c.elements, 1.5);
}
END_TEST

/* The paper states it for every ε.  At ε ≥ 4 it has no bound: halves of which one faces
   the middle of the other are at least A/4 away, max(A)/r ≤ 4 whatever their distance
   d, and the original stops at once, while the modified one goes on to A ≤ dε. */
START_TEST(modified_costs_more_for_a_large_epsilon) {
  for (double d = 0.1, min = 5; d >= 0.001; d /= 10, min *= 8) {
    const hr2d_refine_counts original = count(facing(1, 1, d), NULL, 0, 4);
    ck_assert_uint_eq(original.links, 2);
    ck_assert_uint_eq(original.elements, 4);
    const cost c = cost_of(facing, 1, 1, d, 4);
    printf("ε = 4, distance %g: L by %g, N by %g\n", d, c.links, c.elements);
    ck_assert_double_ge(c.links, min);
    ck_assert_double_gt(c.elements, 2);
  }
}
END_TEST

/* The statement fails for unequal lengths, too, even for small ε: the modified algorithm
   splits short elements together with long ones, and L grows by about the ratio of the
   lengths. */
START_TEST(modified_costs_more_for_unequal_lengths) {
  for (int k = 0; k < 6; k++) {
    const double ratio = exp2(k / 2 + 2);
    const maker make = k % 2 ? corner : facing;
    const cost c = cost_of(make, ratio, 1, 0.1, 1. / 64);
    printf("lengths %g to 1, %s: L by %.3f, N by %.3f\n", ratio,
           make == corner ? "corner" : "facing", c.links, c.elements);
    ck_assert_double_gt(c.links, 2);
    ck_assert_double_eq_tol(c.links, ratio, 0.1 * ratio);
    ck_assert_double_gt(c.elements, 2);
  }
}
END_TEST

/* --- Other oracles, multigridding, and the account of transports --- */

/* Footnote 3: (max(A)/r)² ≤ ε² where max(A)/r ≤ ε, so that nothing changes but ε. */
START_TEST(squares_change_nothing) {
  for (int k = 0; k < 8; k++)
    for (double epsilon = 4; epsilon > (test_multiplier() < 0.1 ? 0.05 : 0.005);
         epsilon *= 0.835) {
      const char *scene = four_scenes[k / 2];
      const hr2d_refine_counts plain = count(test_named_scene(scene), hr2d_oracle_size(), k % 2,
                                             epsilon),
                               squared = count(test_named_scene(scene), hr2d_oracle_size2(),
                                               k % 2, epsilon * epsilon);
      ck_assert_uint_eq(plain.elements, squared.elements);
      ck_assert_uint_eq(plain.links, squared.links);
      ck_assert_uint_eq(plain.limited_links, squared.limited_links);
      ck_assert_uint_eq(plain.oracle_calls, squared.oracle_calls);
      ck_assert_uint_eq(plain.levels, squared.levels);
      /* Against the same ε there is a difference. */
      if (epsilon < 0.1)
        ck_assert_uint_ne(
            plain.links,
            count(test_named_scene(scene), hr2d_oracle_size2(), k % 2, epsilon).links);
    }
}
END_TEST

START_TEST(multigridding_ends_where_one_step_does) {
  const double finest = test_multiplier() < 0.1 ? 1. / 16 : 1. / 64;
  for (int k = 0; k < 8; k++) {
    const char *scene = four_scenes[k / 2];
    test_links t = test_make_links(test_named_scene(scene), NULL, NULL, variant(k % 2), NULL);
    for (double epsilon = 1; epsilon >= finest; epsilon /= 2) {
      const hr2d_refine_options options = test_epsilon(epsilon);
      ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
      const hr2d_refine_counts steps = hr2d_linkset_counts(t.links),
                               once = count(test_named_scene(scene), NULL, k % 2, epsilon);
      ck_assert_uint_eq(steps.elements, once.elements);
      ck_assert_uint_eq(steps.links, once.links);
      ck_assert_int_eq(hr2d_linkset_validate(t.links), HR2D_OK);
    }
    test_free_links(&t);
  }
}
END_TEST

/* Hanrahan's procedure: refine, solve, refine by the brightness found, and so on. */
START_TEST(multigridding_by_brightness_is_quadratic) {
  enum { STEPS = 7 };
  for (int k = 0; k < 8; k++) {
    if (!test_meets((size_t)k / 2, (size_t)k % 2, 2)) continue;
    test_links t = test_make_links(test_named_scene(four_scenes[k / 2]), hr2d_oracle_bf(), NULL,
                                   variant(k % 2), NULL);
    hr2d_refine_options options = test_epsilon(k / 2 == 3 ? 0.03125 : 0.125);
    hr2d_solution *solution = NULL;
    double x[STEPS], y[STEPS], c0, slope, c00, c01, c11, squares;
    for (int step = 0; step < STEPS; step++, options.epsilon /= 2) {
      options.brightness = solution;
      ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
      ck_assert_int_eq(hr2d_linkset_validate(t.links), HR2D_OK);
      hr2d_solution_destroy(solution);
      hr2d_solve_options coarse = HR2D_SOLVE_OPTIONS_INIT;
      coarse.tolerance = 1e-6;
      ck_assert_int_eq(hr2d_solve(t.links, &coarse, &solution), HR2D_OK);
      x[step] = log((double)hr2d_linkset_counts(t.links).elements);
      y[step] = log((double)hr2d_linkset_counts(t.links).links);
    }
    const int last = 4; /* halvings of ε: the fine end */
    gsl_fit_linear(x + STEPS - last, 1, y + STEPS - last, 1, last, &c0, &slope, &c00, &c01,
                   &c11, &squares);
    printf("%s %s: slope %.4f at N = %.0f, L = %.0f\n", four_scenes[k / 2],
           variant(k % 2)->name, slope, exp(x[STEPS - 1]), exp(y[STEPS - 1]));
    ck_assert_double_eq_tol(slope, 2, 0.05);
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(every_transport_is_accounted_for_once) {
  const hr2d_oracle *const oracle[] = {hr2d_oracle_size(), hr2d_oracle_size2(),
                                       hr2d_oracle_bf()};
  const double finest = test_multiplier() < 0.1 ? 0.1 : 0.01;
  uint64_t links = 0;
  for (int k = 0; k < 3 * 8; k++)
    for (double epsilon = 4; epsilon > finest; epsilon *= 0.61) {
      test_links t = refined(test_named_scene(four_scenes[k % 4]), oracle[k / 8], k / 4 % 2,
                             k / 8 == 1 ? epsilon * epsilon : epsilon);
      ck_assert_msg(hr2d_linkset_validate(t.links) == HR2D_OK, "%s",
                    hr2d_linkset_message(t.links));
      links += hr2d_linkset_size(t.links);
      test_free_links(&t);
    }
  printf("%llu links\n", (unsigned long long)links);
}
END_TEST

TEST_SUITE("theorem") {
  ADD_TESTS(
      "Theorem 1", links_are_quadratic_in_elements, links_are_quadratic_for_the_squared_oracle,
      links_are_quadratic_where_brightness_weighs, links_are_quadratic_for_the_exact_oracle,
      links_are_linear_for_a_fixed_epsilon, other_laws_are_refused);
  ADD_TESTS("equations and inequalities", elements_are_g_over_epsilon,
            links_are_elements_over_epsilon, every_link_obeys_the_inequalities,
            regions_of_leaves_break_the_bounds);
  ADD_TESTS("the modified algorithm", modified_costs_less_than_twice,
            modified_costs_more_for_a_large_epsilon, modified_costs_more_for_unequal_lengths);
  ADD_TESTS("what is printed", a_range_of_nothing_says_so);
  ADD_TESTS("oracles and multigridding", squares_change_nothing,
            multigridding_ends_where_one_step_does, multigridding_by_brightness_is_quadratic,
            every_transport_is_accounted_for_once);
}
