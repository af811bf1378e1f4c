/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/field-stage.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TURN 6.28318530717958647692528676655900577L

static field_stage begin(hr2d_scene *scene) {
  field_stage s = {.t = test_make_links(scene, NULL, NULL, NULL, NULL)};
  const size_t n = hr2d_scene_patches(scene);
  s.at = malloc(n * sizeof *s.at);
  s.span = malloc((2 * n + 2) * sizeof *s.span);
  ck_assert(s.at && s.span);
  for (size_t k = 0; k < n; k++) {
    const hr2d_segment p = hr2d_scene_segment(scene, k);
    memcpy(s.at[k], (double[]){p.a.x, p.a.y, p.b.x, p.b.y}, sizeof *s.at);
  }
  s.all = (sweep_patches){n, (const double(*)[4])s.at};
  return s;
}

field_stage field_stage_flat(hr2d_scene *scene) {
  field_stage s = begin(scene);
  test_refine(&s.t, 1, HR2D_NO_SUBDIVISION);
  s.solution = test_solve(&s.t, 1);
  return s;
}

field_stage field_stage_of(hr2d_scene *scene, double epsilon, unsigned order) {
  field_stage s = begin(scene);
  ck_assert_int_eq(hr2d_hierarchy_set_order(s.t.hierarchy, order), HR2D_OK);
  test_refine(&s.t, epsilon, 6);
  s.solution = test_solve(&s.t, 1);
  return s;
}

void field_stage_clear(field_stage *s) {
  hr2d_solution_destroy(s->solution);
  test_free_links(&s->t);
  free(s->at);
  free(s->span);
}

field_sample field_sample_at(const hr2d_solution *solution, double x, double y) {
  const hr2d_scene *scene =
      hr2d_hierarchy_scene(hr2d_linkset_hierarchy(hr2d_solution_links(solution)));
  const size_t bands = hr2d_scene_bands(scene);
  double *mean = malloc(bands * sizeof *mean), *flux = malloc(2 * bands * sizeof *flux);
  ck_assert(mean && flux);
  field_sample f;
  const hr2d_point at = {x, y};
  const hr2d_field_values values = {.struct_size = sizeof values,
                                    .mean = mean,
                                    .flux = flux,
                                    .sky = &f.sky,
                                    .back = &f.back,
                                    .place = &f.place};
  ck_assert_int_eq(hr2d_field_at(solution, &at, 1, NULL, &values), HR2D_OK);
  f.mean = mean[0];
  f.flux[0] = flux[0];
  f.flux[1] = flux[1];
  free(mean);
  free(flux);
  return f;
}

field_sample field_sample_sweep(const field_stage *s, double x, double y) {
  const size_t count = open_sweep(&s->all, (spot){x, y}, s->span);
  const hr2d_scene *scene = s->t.scene;
  real sum[5] = {0}, front = 0;
  for (size_t k = 0; k < count; k++) {
    const sweep_span *p = &s->span[k];
    const real angle = p->high - p->low;
    real b = 0;
    if (p->seen == SWEEP_BACK) {
      sum[4] += angle;
    } else if (p->seen == SWEEP_SKY) {
      b = hr2d_scene_background(scene, 0);
      sum[3] += angle;
    } else {
      b = hr2d_solution_average(s->solution, p->seen, 0);
      front += angle;
    }
    sum[0] += b * angle;
    sum[1] += b / 2 * (sinl(p->high) - sinl(p->low));
    sum[2] += b / 2 * (cosl(p->low) - cosl(p->high));
  }
  const int dark = front == 0 && !(hr2d_scene_background(scene, 0) > 0 && sum[3] > 0);
  const double none = dark ? NAN : 0;
  return (field_sample){(double)(sum[0] / TURN) + none,
                        {(double)sum[1] + none, (double)sum[2] + none},
                        (double)(sum[3] / TURN),
                        (double)(sum[4] / TURN),
                        dark ? HR2D_PLACE_OUTSIDE : HR2D_PLACE_BETWEEN};
}

double field_sample_distance(const field_sample *one, const field_sample *other, double max) {
  if (isnan(one->mean) != isnan(other->mean)) return HUGE_VAL;
  const double shares = fmax(fabs(one->sky - other->sky), fabs(one->back - other->back));
  if (isnan(one->mean)) return shares;
  const double flux = hypot(one->flux[0] - other->flux[0], one->flux[1] - other->flux[1]);
  return fmax(shares, fmax(fabs(one->mean - other->mean), flux) / max);
}
