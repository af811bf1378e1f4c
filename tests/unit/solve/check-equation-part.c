/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of an equation with the first coefficients is PKP: on fields that have no others,
   and of what it makes. */
#include <math.h>

#include "estimate/graded-solve.h"
#include "solve/reduced-equation.h"
#include "support/support.h"

enum { ORDER = 6, FEW = 3, CORNER = 1 };

/* Elements and links of a scene at order ORDER, and their equation. */
static void begin(const char *name, hr2d_scene **scene, hr2di_graded *graded,
                  hr2di_equation *eq) {
  const hr2di_resolution fineness = {.order = ORDER, .target = 1e-4, .generations = 1};
  const hr2d_target target = HR2D_TARGET_INIT;
  const hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2di_message message;
  *scene = test_named_scene(name);
  ck_assert_int_eq(hr2di_graded_refine(graded, *scene, &fineness, &target, &message), HR2D_OK);
  ck_assert_int_eq(hr2di_equation_init(eq, graded->links, graded->links->hierarchy->scene,
                                       &(hr2di_equation_how){0}, &options),
                   HR2D_OK);
  eq->background = 0;
}

static void end(hr2d_scene *scene, hr2di_graded *graded, hr2di_equation *eq) {
  hr2di_equation_clear(eq);
  hr2di_graded_clear(graded);
  hr2d_scene_destroy(scene);
}

static const char *const names[] = {"square_rho0.9", "orth_touch_rho0.7",
                                    "occ_square_walls0.5_occ0.5"};

/* How far PK of the whole is from what the part makes, of a field whose coefficients from
   `count` on are 0. */
static double difference(hr2di_equation *eq, hr2di_equation *part, size_t count, randoms *r) {
  const size_t width = eq->transport.width, low = part->transport.width;
  double worst = 0, max = 0;
  for (size_t k = 0; k < eq->field; k++)
    eq->radiosity[k] = k % width < count ? random_between(r, -1, 1) : 0;
  hr2di_equation_part_take(part, eq, eq->radiosity, part->radiosity);
  hr2di_equation_gather(eq, eq->radiosity);
  hr2di_equation_gather(part, part->radiosity);
  for (size_t k = 0; k < part->field; k++) {
    const double h = eq->irradiance[k / low * width + k % low];
    worst = fmax(worst, fabs(h - part->irradiance[k]));
    max = fmax(max, fabs(h));
  }
  return worst / max;
}

START_TEST(it_is_nearly_the_operator_between_projections) {
  hr2d_scene *scene;
  hr2di_graded graded;
  hr2di_equation eq, part;
  randoms r = {test_seed() + (uint64_t)_i};
  begin(names[_i], &scene, &graded, &eq);
  ck_assert_int_eq(hr2di_equation_part(&part, &eq, FEW), HR2D_OK);
  ck_assert_double_le(difference(&eq, &part, FEW, &r), _i == CORNER ? 1e-14 : 1e-3);
  /* Negative control: other coefficients count. */
  ck_assert_double_gt(difference(&eq, &part, ORDER, &r), 1e-2);
  hr2di_equation_part_clear(&part);
  end(scene, &graded, &eq);
}
END_TEST

/* All coefficients are a part, too; fewer make a solution that is nearly as good. */
START_TEST(it_is_solved_as_the_whole) {
  hr2d_scene *scene;
  hr2di_graded graded;
  hr2di_equation eq, part;
  begin(names[_i], &scene, &graded, &eq);
  const size_t width = eq.transport.width;
  for (size_t order = ORDER; order >= FEW; order -= FEW) {
    ck_assert_int_eq(hr2di_equation_part(&part, &eq, order), HR2D_OK);
    hr2di_equation_part_take(&part, &eq, eq.source, part.source);
    ck_assert_int_eq(hr2di_equation_solve(&part), HR2D_OK);
    for (size_t k = 0; k < eq.field; k++) eq.y[k] = 0;
    ck_assert_int_eq(hr2di_equation_solve(&eq), HR2D_OK);
    double worst = 0;
    for (size_t k = 0; k < part.transport.leaves; k++)
      worst = fmax(
          worst, fabs(eq.radiosity[k * width] / part.radiosity[k * part.transport.width] - 1));
    ck_assert_double_le(worst, order == ORDER ? 1e-12 : 1e-3);
    if (order < ORDER) ck_assert_double_gt(worst, 1e-12);
    hr2di_equation_part_clear(&part);
  }
  end(scene, &graded, &eq);
}
END_TEST

TEST_SUITE("equation part") {
  REPEAT_TESTS(3, "part", it_is_nearly_the_operator_between_projections,
               it_is_solved_as_the_whole);
}
