/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hanrahan's procedure at one ε: refine by the brightness found, solve, and again.  Its error
   has to fall with ε. */
#include <math.h>

#include "support/radiosity-scenes.h"
#include "support/support.h"

enum { ROUNDS = 6 };

/* Negative control: the form factor from the centres, which is 0 where a centre lies on the
   line of the other element. */
static hr2d_status estimate_from_centres(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_element *i = &batch->elements[batch->pairs[k].first];
    const hr2d_element *j = &batch->elements[batch->pairs[k].second];
    const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
    const double kernel = hr2d_kernel(&s, i->centre, &t, j->centre);
    error[k] = kernel * fmax(i->length, j->length) *
               (batch->brightness ? batch->brightness[batch->pairs[k].second] : 1) *
               (batch->partial && batch->partial[k] ? 2 : 1);
  }
  return HR2D_OK;
}

static const hr2d_oracle from_centres = {.struct_size = sizeof(hr2d_oracle),
                                         .name = "from centres",
                                         .flags = HR2D_ORACLE_NEEDS_BRIGHTNESS |
                                                  HR2D_ORACLE_THREAD_SAFE,
                                         .estimate = estimate_from_centres};

static double error_of(const hr2d_oracle *oracle, double epsilon) {
  static radiosity_scenes table;
  ck_assert_int_eq(radiosity_scenes_read(test_data_path("radiosity_fine.csv"), &table), 0);
  const radiosity_scene *room = radiosity_scenes_find(&table, "occ_square_walls0.5_occ0.5");
  ck_assert(room != NULL);
  test_links t = test_make_links(radiosity_scene_make(room, NULL), oracle, NULL, NULL, NULL);
  hr2d_refine_options options = test_epsilon(epsilon);
  hr2d_solution *solution = NULL;
  for (int round = 0; round < ROUNDS; round++) {
    options.brightness = solution;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    hr2d_solution_destroy(solution);
    ck_assert_int_eq(hr2d_solve(t.links, NULL, &solution), HR2D_OK);
  }
  const double error = radiosity_average_error(room, solution);
  printf("%s at %g: %llu links, error %.2g\n", oracle->name, epsilon,
         (unsigned long long)hr2d_linkset_size(t.links), error);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  return error;
}

START_TEST(brightness_converges) {
  ck_assert_double_le(error_of(hr2d_oracle_bf(), 0.0125), 7e-3);
  if (test_multiplier() >= 1) ck_assert_double_le(error_of(hr2d_oracle_bf(), 0.0031), 6e-4);
}
END_TEST

START_TEST(factors_from_centres_do_not) {
  ck_assert_double_ge(error_of(&from_centres, 0.05), 0.1);
  ck_assert_double_ge(error_of(&from_centres, 0.0125), 0.1);
}
END_TEST

TEST_SUITE("brightness") {
  ADD_TESTS("refinement by brightness", brightness_converges, factors_from_centres_do_not);
}
