/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels shrink towards the point, as without gas, and until they are no deeper than
   HR2DI_GAS_DEEP. Their sum of angles may miss a part of the angle, which is known, by
   roundings: that part has the light of the nearest place. */
#include "field/light-in-gas.h"

#include <math.h>

#include "geometry/bernstein-ellipse.h"
#include "geometry/vector.h"

/* From a place at some distance. */
typedef struct passages {
  hr2di_passage mean, flux;
} passages;

static passages passages_over(const hr2di_light_sum *sum, size_t group, double distance) {
  const hr2d_section section = hr2di_scene_section(sum->of->scene);
  const double depth = hr2di_band_group_absorption(sum->of->scene, group) * distance;
  passages over = {.mean = hr2di_passage_of_mean(section, depth)};
  if (sum->flux) over.flux = hr2di_passage_at(section, depth);
  return over;
}

static const hr2di_rule *choose_rule(const hr2di_light_source *of, double ellipse) {
  const double m = fmin(fmax(ellipse, HR2DI_NEAR_ELLIPSE), HR2DI_GAS_ELLIPSE);
  const double digits = -log(of->allowed) / log(m + sqrt(m * m - 1));
  const double points = ((double)of->leaves.order + digits) / 2 + 1;
  return hr2di_light_rule(of, points);
}

/* Adds a band of the light of a place that takes an angle and ∫ω dω of it. */
static void add_band(hr2di_light_sum *sum, const passages *pass, size_t b, double value,
                     double angle, hr2d_point vector) {
  const double gas = sum->of->solution->gas[2 * b];
  sum->mean[b] += angle * (pass->mean.arrives * value + pass->mean.absorbed * gas);
  if (!sum->flux) return;
  const double flux = pass->flux.arrives * value + pass->flux.absorbed * gas;
  sum->flux[2 * b] += vector.x * flux;
  sum->flux[2 * b + 1] += vector.y * flux;
}

static void add_place(hr2di_light_sum *sum, const hr2di_strip *s, double t, double angle,
                      hr2d_point vector) {
  const hr2di_light_source *of = sum->of;
  const size_t bands = of->solution->bands;
  const hr2d_point r = hr2di_block_along(s->from, s->along, t);
  for (size_t g = 0; g < hr2di_band_groups(of->scene); g++) {
    const passages pass = passages_over(sum, g, sqrt(hr2di_point_dot(r, r)));
    for (size_t k = 0; k < hr2di_band_group_size(of->scene, g); k++) {
      const size_t b = hr2di_band_group_at(of->scene, g, k);
      const double value =
          s->coefficient ? hr2di_basis_sum(&of->basis, 2 * t - 1, s->coefficient + b, bands)
                         : 0;
      add_band(sum, &pass, b, value, angle, vector);
    }
  }
}

/* Adds a panel, and what it takes of the angle. */
static void add_panel(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span panel,
                      const hr2di_rule *rule, double *angle, hr2d_point *vector) {
  const double size = panel.to - panel.from, cross = hr2di_point_cross(s->from, s->along);
  for (size_t q = 0; q < rule->points; q++) {
    const double t = panel.from + size * (0.5 + 0.5 * rule->at[q]);
    const hr2d_point r = hr2di_block_along(s->from, s->along, t);
    const double square = hr2di_point_dot(r, r);
    if (!(square > 0)) continue;
    const double weight = size * rule->weight[q] * cross / square, far = weight / sqrt(square);
    const hr2d_point ray = {far * r.x, far * r.y};
    *angle += weight;
    *vector = (hr2d_point){vector->x + ray.x, vector->y + ray.y};
    add_place(sum, s, t, weight, ray);
  }
}

void hr2di_light_add_far_in_gas(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span part,
                                const hr2di_rule *rule) {
  double angle = 0;
  hr2d_point vector = {0, 0};
  add_panel(sum, s, part, rule, &angle, &vector);
}

void hr2di_light_add_in_gas(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span part,
                            double angle, hr2d_point vector) {
  const hr2di_light_source *of = sum->of;
  hr2di_panels panels = {.count = part.to > part.from};
  double found = 0;
  hr2d_point by = {0, 0};
  panels.stack[0] = part;
  while (panels.count > 0) {
    const hr2di_span panel = panels.stack[--panels.count];
    const double m = hr2di_panel_ellipse(s->from, s->along, panel);
    if ((m < HR2DI_NEAR_ELLIPSE || hr2di_panel_is_deep(s->from, s->along, panel, of->scene)) &&
        hr2di_panel_halved(&panels, panel))
      continue;
    if (hr2di_watch_work(sum->watch, 8 + 2 * of->solution->order * of->solution->bands)) return;
    add_panel(sum, s, panel, choose_rule(of, m), &found, &by);
  }
  const double size = hr2di_point_dot(s->along, s->along);
  const double nearest = size > 0 ? -hr2di_point_dot(s->from, s->along) / size : 0;
  add_place(sum, s, fmin(fmax(nearest, part.from), part.to), angle - found,
            (hr2d_point){vector.x - by.x, vector.y - by.y});
}
