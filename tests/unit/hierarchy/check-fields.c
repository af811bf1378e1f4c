/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trees that are divided by hand, and push and pull of fields on them: against polynomials,
   which have their own coefficients on every element, and against a gather of the library. */
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/random.h"
#include "support/support.h"

enum { MOST_ORDER = 6, BANDS = 2, MOST = 400 };

static hr2d_hierarchy *on_two_patches(hr2d_scene **made) {
  hr2d_scene *scene = NULL;
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_patch patch = HR2D_PATCH_INIT;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  patch.b.x = 3;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  patch.a = (hr2d_point){2, 1};
  patch.b = (hr2d_point){0.5, 1.5};
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  test_commit(scene);
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &hierarchy), HR2D_OK);
  *made = scene;
  return hierarchy;
}

static void destroy(hr2d_hierarchy *h, hr2d_scene *scene) {
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}

/* Divides leaves anywhere, some of them at the midpoint. */
static void grow(randoms *r, hr2d_hierarchy *h, int divisions, double *start, double *end) {
  for (int k = 0; k < 2; k++) start[k] = 0, end[k] = 1;
  while (divisions > 0) {
    const uint64_t count = hr2d_hierarchy_count(h).elements;
    const uint32_t leaf = (uint32_t)random_below(r, (int)count);
    const double t = random_below(r, 3) ? random_between(r, 0.1, 0.9) : 0.5;
    uint32_t child = 0;
    if (hr2d_hierarchy_elements(h)[leaf].child) continue;
    ck_assert_int_eq(hr2d_hierarchy_divide(h, leaf, t, &child), HR2D_OK);
    ck_assert_uint_eq(child, count);
    const double at = start[leaf] + t * (end[leaf] - start[leaf]);
    start[child] = start[leaf], end[child] = start[child + 1] = at, end[child + 1] = end[leaf];
    divisions--;
  }
}

/* A polynomial of degree below MOST_ORDER along a patch. */
static double polynomial(const double *c, int order, double t) {
  double sum = 0;
  for (int k = order - 1; k >= 0; k--) sum = sum * t + c[k];
  return sum;
}

/* Its coefficient of φ_l on [start, end], by the midpoint rule of many points and a
   Richardson step: no rule of the library. */
static double coefficient(const double *c, int order, int l, double start, double end) {
  double sum[2] = {0};
  for (int fine = 0; fine < 2; fine++) {
    const int points = 4000 << fine;
    for (int k = 0; k < points; k++) {
      const double x = (k + 0.5) / points;
      sum[fine] +=
          polynomial(c, order, start + x * (end - start)) * gsl_sf_legendre_Pl(l, 2 * x - 1);
    }
    sum[fine] *= sqrt(2 * l + 1) / points;
  }
  return (4 * sum[1] - sum[0]) / 3;
}

/* Pulled from leaves, and pushed from roots, a polynomial has its own coefficients. */
START_TEST(polynomials_stay_themselves) {
  randoms r = randoms_stream(test_seed(), 1 + (unsigned)_i);
  const int order = 1 + _i;
  static double start[MOST], end[MOST], field[2][MOST * MOST_ORDER * BANDS],
      exact[MOST * MOST_ORDER * BANDS];
  double c[2][BANDS][MOST_ORDER], worst = 0;
  hr2d_scene *scene;
  hr2d_hierarchy *h = on_two_patches(&scene);
  ck_assert_int_eq(hr2d_hierarchy_set_order(h, (unsigned)order), HR2D_OK);
  grow(&r, h, 15, start, end);
  const hr2d_element *e = hr2d_hierarchy_elements(h);
  const size_t count = (size_t)hr2d_hierarchy_count(h).elements;
  for (int p = 0; p < 2; p++)
    for (int b = 0; b < BANDS; b++)
      for (int k = 0; k < order; k++) c[p][b][k] = random_between(&r, -1, 1);
  for (size_t k = 0; k < count; k++)
    for (int l = 0; l < order; l++)
      for (int b = 0; b < BANDS; b++) {
        const size_t at = (k * (size_t)order + (size_t)l) * BANDS + (size_t)b;
        exact[at] = coefficient(c[e[k].patch][b], order, l, start[k], end[k]);
        field[0][at] = e[k].child ? NAN : exact[at];
        field[1][at] = k < 2 ? exact[at] : 0;
      }
  ck_assert_int_eq(hr2d_hierarchy_pull(h, BANDS, field[0]), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_push(h, BANDS, field[1]), HR2D_OK);
  for (size_t k = 0; k < count * (size_t)order * BANDS; k++)
    for (int way = 0; way < 2; way++) worst = fmax(worst, fabs(field[way][k] - exact[k]));
  printf("order %d: off by %.1e\n", order, worst);
  ck_assert_double_le(worst, 1e-11);
  /* Negative control: a value that is changed on a leaf changes its root. */
  const double root = field[0][0];
  field[0][(count - 1) * (size_t)order * BANDS] += 1e-3;
  const size_t of = e[count - 1].patch * (size_t)order * BANDS;
  const double before = of ? field[0][of] : root;
  ck_assert_int_eq(hr2d_hierarchy_pull(h, BANDS, field[0]), HR2D_OK);
  ck_assert_double_gt(fabs(field[0][of] - before), 1e-9);
  destroy(h, scene);
}
END_TEST

/* Σ A (pull x) y over roots is Σ A x (push y) over leaves. */
START_TEST(they_are_transposes) {
  randoms r = randoms_stream(test_seed(), 20);
  static double start[MOST], end[MOST], x[MOST * MOST_ORDER], y[MOST * MOST_ORDER];
  hr2d_scene *scene;
  hr2d_hierarchy *h = on_two_patches(&scene);
  ck_assert_int_eq(hr2d_hierarchy_set_order(h, MOST_ORDER), HR2D_OK);
  grow(&r, h, 60, start, end);
  const hr2d_element *e = hr2d_hierarchy_elements(h);
  const size_t count = (size_t)hr2d_hierarchy_count(h).elements;
  for (size_t k = 0; k < count * MOST_ORDER; k++) {
    x[k] = e[k / MOST_ORDER].child ? 0 : random_between(&r, -1, 1);
    y[k] = k < 2 * MOST_ORDER ? random_between(&r, -1, 1) : 0;
  }
  double leaves = 0, roots = 0;
  ck_assert_int_eq(hr2d_hierarchy_push(h, 1, y), HR2D_OK);
  for (size_t k = 0; k < count * MOST_ORDER; k++)
    if (!e[k / MOST_ORDER].child) leaves += e[k / MOST_ORDER].length * x[k] * y[k];
  ck_assert_int_eq(hr2d_hierarchy_pull(h, 1, x), HR2D_OK);
  for (size_t k = 0; k < 2 * MOST_ORDER; k++) roots += e[k / MOST_ORDER].length * x[k] * y[k];
  ck_assert_double_gt(fabs(roots), 1e-6);
  ck_assert_double_le(fabs(roots - leaves), 1e-13);
  destroy(h, scene);
}
END_TEST

/* H of a field by hand: pull, links, push. */
static void gather(const test_links *t, size_t order, double *up, double *down) {
  const hr2d_element *e = hr2d_hierarchy_elements(t->hierarchy);
  const double unit = hr2d_scene_unit(t->scene);
  double block[MOST_ORDER * MOST_ORDER];
  ck_assert_int_eq(hr2d_hierarchy_pull(t->hierarchy, 1, up), HR2D_OK);
  for (uint64_t k = 0; k < hr2d_linkset_size(t->links); k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k);
    const uint32_t i = link.pair.first, j = link.pair.second;
    ck_assert_int_eq(hr2d_blocks(t->hierarchy, &link, 1, block), HR2D_OK);
    for (size_t l = 0; l < order; l++)
      for (size_t m = 0; m < order; m++) {
        const double c = block[l * order + m] / unit;
        down[i * order + l] += c / e[i].length * up[j * order + m];
        down[j * order + m] += c / e[j].length * up[i * order + l];
      }
  }
  ck_assert_int_eq(hr2d_hierarchy_push(t->hierarchy, 1, down), HR2D_OK);
}

/* The coefficients of B on a leaf, from its values at points. */
static void leaf_coefficients(const hr2d_solution *s, const hr2d_hierarchy *h, uint32_t leaf,
                              size_t order, double *c) {
  enum { POINTS = 400 };
  const hr2d_element *e = &hr2d_hierarchy_elements(h)[leaf],
                     *patch = &hr2d_hierarchy_elements(h)[e->patch];
  const double dx = patch->b.x - patch->a.x, dy = patch->b.y - patch->a.y;
  const double square = dx * dx + dy * dy;
  const double from = ((e->a.x - patch->a.x) * dx + (e->a.y - patch->a.y) * dy) / square,
               to = ((e->b.x - patch->a.x) * dx + (e->b.y - patch->a.y) * dy) / square;
  if (order == 1) {
    c[0] = hr2d_solution_element(s, leaf, 0);
    return;
  }
  memset(c, 0, order * sizeof *c);
  for (int fine = 0; fine < 2; fine++)
    for (int k = 0; k < POINTS << fine; k++) {
      const double x = (k + 0.5) / (POINTS << fine), share = (fine ? 4. : -1.) / 3;
      const double b = hr2d_solution_at(s, e->patch, from + x * (to - from), 0);
      for (size_t l = 0; l < order; l++)
        c[l] += share * b * sqrt(2. * (double)l + 1) * gsl_sf_legendre_Pl((int)l, 2 * x - 1) /
                (POINTS << fine);
    }
}

/* With B = E + ρ H a fixed point of the solve of the same links, without closure. */
START_TEST(a_solver_of_ones_own) {
  static const char *const scene[] = {"square_rho0.9", "occ_square_walls0.5_occ0.5"};
  const size_t order = _i < 2 ? 1 : 3;
  test_links t = test_make_links(test_named_scene(scene[_i % 2]), NULL, NULL, NULL, NULL);
  const hr2d_refine_options options = test_options(0.3, 5);
  hr2d_solve_options how = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *solution = NULL;
  how.closure = HR2D_CLOSURE_OFF;
  how.tolerance = 1e-14;
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, (unsigned)order), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(t.links, &how, &solution), HR2D_OK);
  const hr2d_element *e = hr2d_hierarchy_elements(t.hierarchy);
  const size_t count = (size_t)hr2d_hierarchy_count(t.hierarchy).elements;
  double *up = calloc(count * order, sizeof *up), *down = calloc(count * order, sizeof *down);
  double worst = 0, largest = 0;
  for (uint32_t k = 0; k < count; k++)
    if (!e[k].child) leaf_coefficients(solution, t.hierarchy, k, order, up + k * order);
  gather(&t, order, up, down);
  for (size_t k = 0; k < count * order; k++) {
    const size_t p = e[k / order].patch;
    const double emitted = k % order ? 0 : hr2d_scene_emission(t.scene, p, 0);
    const double b = emitted + hr2d_scene_reflectance(t.scene, p, 0) * down[k];
    if (e[k / order].child) continue;
    worst = fmax(worst, fabs(b - up[k]));
    largest = fmax(largest, fabs(down[k]));
  }
  printf("%s, order %zu: off by %.1e of %.2g\n", scene[_i % 2], order, worst, largest);
  ck_assert_double_le(worst, order == 1 ? 1e-12 : 1e-9);
  ck_assert_double_gt(largest, 0.1);
  free(up);
  free(down);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}
END_TEST

START_TEST(divisions_are_refused) {
  hr2d_scene *scene;
  hr2d_hierarchy *h = on_two_patches(&scene);
  double field[2] = {0};
  const uint64_t before = hr2d_hierarchy_count(h).elements;
  const double nowhere[] = {0, 1, -0.5, 1.5, NAN, 1e-320};
  for (size_t k = 0; k < sizeof nowhere / sizeof *nowhere; k++)
    ck_assert_int_eq(hr2d_hierarchy_divide(h, 1, nowhere[k], NULL), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_hierarchy_divide(h, 2, 0.5, NULL), HR2D_EINVAL);
  ck_assert_uint_eq(hr2d_hierarchy_count(h).elements, before);
  ck_assert_int_eq(hr2d_hierarchy_divide(h, 1, 0.5, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_divide(h, 1, 0.5, NULL), HR2D_EINVAL); /* no leaf now */
  ck_assert_int_eq(hr2d_hierarchy_pull(h, 0, field), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_blocks(h, &(hr2d_link){{0, 99}, 1}, 1, field), HR2D_EINVAL);
  destroy(h, scene);
}
END_TEST

/* Half a patch is the half that a refinement makes. */
START_TEST(halves_are_those_of_a_refinement) {
  test_links t = test_make_links(test_named_scene("square_rho0.9"), NULL, NULL, NULL, NULL);
  const hr2d_refine_options options = test_options(0.5, 3);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  hr2d_hierarchy *copy = NULL;
  ck_assert_int_eq(hr2d_hierarchy_create(t.scene, &copy), HR2D_OK);
  const size_t count = (size_t)hr2d_hierarchy_count(t.hierarchy).elements;
  const hr2d_element *e = hr2d_hierarchy_elements(t.hierarchy);
  for (uint32_t k = (uint32_t)hr2d_scene_patches(t.scene); k < count; k += 2)
    ck_assert_int_eq(
        hr2d_hierarchy_divide(copy, hr2d_element_parent(t.hierarchy, k), 0.5, NULL), HR2D_OK);
  ck_assert_uint_gt(count, 8);
  ck_assert_int_eq(memcmp(e, hr2d_hierarchy_elements(copy), count * sizeof *e), 0);
  hr2d_hierarchy_destroy(copy);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("fields") {
  REPEAT_TESTS(MOST_ORDER, "orders", polynomials_stay_themselves);
  REPEAT_TESTS(4, "solvers", a_solver_of_ones_own);
  ADD_TESTS("all", they_are_transposes, divisions_are_refused,
            halves_are_those_of_a_refinement);
}
