/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solutions from outside: what a solve found is found again in its values, and values that are
   known have an irradiance that is known. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solution/solution-impl.h"
#include "support/support.h"

static const char *const names[] = {"par0.1", "square_rho0.9", "occ_square_walls0.5_occ0.5",
                                    "orth0.1"};
enum { NAMES = sizeof names / sizeof *names };

static test_links make(const char *name, unsigned order) {
  test_links t = test_make_links(test_named_scene(name), NULL, NULL, NULL, NULL);
  const hr2d_refine_options options = test_options(0.3, 5);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, order), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  return t;
}

static size_t fields_of(const test_links *t) {
  return (size_t)hr2d_hierarchy_count(t->hierarchy).elements *
         hr2d_hierarchy_order(t->hierarchy) * hr2d_scene_bands(t->scene);
}

static void near(double value, double expected, double size) {
  ck_assert_double_le(fabs(value - expected), 1e-13 * fmax(fabs(expected), size));
}

START_TEST(a_solution_is_found_again) {
  const char *name = names[_i % NAMES];
  test_links t = make(name, _i < NAMES ? 1 : 4);
  hr2d_solution *one = NULL, *other = NULL;
  ck_assert_int_eq(hr2d_solve(t.links, NULL, &one), HR2D_OK);
  const size_t count = fields_of(&t);
  ck_assert_uint_eq(hr2d_solution_field_size(one), count);
  double *field = malloc(count * sizeof *field);
  const size_t width = count / (size_t)hr2d_hierarchy_count(t.hierarchy).elements;
  for (size_t k = 0; k < count; k++) /* what inner elements have is not read */
    field[k] = hr2d_hierarchy_elements(t.hierarchy)[k / width].child
                   ? NAN
                   : hr2d_solution_field(one)[k];
  ck_assert_int_eq(hr2d_solution_adopt(t.links, NULL, field, &other), HR2D_OK);
  for (size_t k = 0; k < count; k++) {
    ck_assert(other->value[k] == one->value[k]);
    near(other->irradiance[k], one->irradiance[k], 1);
  }
  for (size_t k = 0; k < hr2d_scene_patches(t.scene); k++)
    ck_assert(hr2d_solution_average(one, k, 0) == hr2d_solution_average(other, k, 0));
  const hr2d_power p = hr2d_solution_power(one, 0), q = hr2d_solution_power(other, 0);
  near(q.emitted, p.emitted, 1);
  near(q.absorbed, p.absorbed, 1);
  near(q.escaped, p.escaped, 1);
  ck_assert_double_le(hr2d_solution_residual(other), 1e-12);
  /* Negative control: another B is not a solution. */
  hr2d_solution_destroy(other);
  for (size_t k = 0; k < count; k++) field[k] *= 1.5;
  ck_assert_int_eq(hr2d_solution_adopt(t.links, NULL, field, &other), HR2D_OK);
  ck_assert_double_gt(hr2d_solution_residual(other), 0.01);
  free(field);
  hr2d_solution_destroy(one);
  hr2d_solution_destroy(other);
  test_free_links(&t);
}
END_TEST

/* Where B is 1 on all walls of a closed room, so is H, whatever the walls emit and reflect. */
START_TEST(a_room_of_one_radiosity) {
  test_links t = make("square_rho0.9", _i ? 3 : 1);
  hr2d_solution *s = NULL;
  const size_t count = fields_of(&t), width = _i ? 3 : 1;
  double *field = calloc(count, sizeof *field);
  for (size_t k = 0; k < count; k += width) field[k] = 1;
  ck_assert_int_eq(hr2d_solution_adopt(t.links, NULL, field, &s), HR2D_OK);
  for (size_t k = 0; k < hr2d_scene_patches(t.scene); k++)
    near(hr2d_solution_irradiance(s, k, 0), 1, 1);
  double gathered;
  const double middle = 0.5;
  ck_assert_int_eq(hr2d_solution_gather_irradiance(s, 1, &middle, 1, &gathered), HR2D_OK);
  near(gathered, 1, 1);
  hr2d_solution_destroy(s);
  field[count - width] = NAN;
  ck_assert_int_eq(hr2d_solution_adopt(t.links, NULL, field, &s), HR2D_EINVAL);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "not finite"));
  free(field);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("adopt") {
  REPEAT_TESTS(2 * NAMES, "solutions", a_solution_is_found_again);
  REPEAT_TESTS(2, "rooms", a_room_of_one_radiosity);
}
