/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/accuracy-tally.h"

#include <math.h>

#include "support/support.h"

hr2d_solution *accuracy_solve(const hr2d_scene *scene, double error, hr2d_norm norm,
                              hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  target.norm = norm;
  target.points = 1;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s: %s", hr2d_strerror(status),
                account->reason);
  ck_assert_int_eq(status == HR2D_EACCURACY, account->reason[0] != '\0');
  ck_assert_ptr_nonnull(solution);
  return solution;
}

void accuracy_check_account(const hr2d_account *a, const hr2d_solution *solution) {
  const hr2d_linkset *links = hr2d_solution_links(solution);
  const hr2d_hierarchy *hierarchy = hr2d_linkset_hierarchy(links);
  const hr2d_hierarchy_counts counts = hr2d_hierarchy_count(hierarchy);
  ck_assert_uint_eq(a->order, hr2d_hierarchy_order(hierarchy));
  ck_assert_uint_eq(a->elements, counts.elements);
  ck_assert_uint_eq(a->leaves, counts.leaves);
  ck_assert_uint_eq(a->links, hr2d_linkset_size(links));
  ck_assert_uint_ge(a->solves, 1);
  ck_assert(a->kernels > 0 || a->links == 0);
  ck_assert_uint_ge(a->bytes, a->links * a->order * a->order * sizeof(double));
  const double parts[] = {a->refine_seconds, a->coefficients_seconds, a->solve_seconds,
                          a->error_seconds};
  double sum = 0;
  for (int k = 0; k < 4; k++) {
    ck_assert_double_ge(parts[k], 0);
    sum += parts[k];
  }
  ck_assert_double_le(sum, a->seconds * 1.001);
  const hr2d_error errors[] = {a->average, a->sup};
  for (int k = 0; k < 2; k++) {
    ck_assert_double_ge(errors[k].estimate, 0);
    ck_assert_double_le(errors[k].estimate, errors[k].bound * (1 + 1e-6) + 1e-15);
  }
}

int accuracy_is_bounded(hr2d_error e, double error, double known, double rounding) {
  return error <= e.bound + known + rounding;
}

double accuracy_min_estimate(const hr2d_scene *scene, double target) {
  const int changes = hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL) ||
                      hr2d_scene_effect(scene, HR2D_EFFECT_FACING, NULL) ||
                      hr2d_scene_effect(scene, HR2D_EFFECT_BACKGROUND, NULL);
  return changes ? 0.1 * target : 0;
}

void accuracy_compare(accuracy_tally *t, hr2d_error e, double error, double known,
                      double rounding, double min) {
  if (!(error > rounding) || !(error > 10 * known)) return;
  t->compared++;
  t->close += e.estimate >= 0.5 * error && e.estimate <= 2 * fmax(error, min);
}

int accuracy_is_fair(const accuracy_tally *t) {
  return t->close >= 0.95 * t->compared;
}

radiosity_scenes accuracy_reference(void) {
  radiosity_scenes all;
  ck_assert_int_eq(radiosity_scenes_read(test_data_path("radiosity_fine.csv"), &all), 0);
  return all;
}
