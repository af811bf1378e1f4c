/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels shrink towards the point, as without gas, and until they are no deeper than
   HR2DI_GAS_DEEP. Their sum of angles may miss a part of the angle, which is known, by
   roundings: that part has the light of the nearest place. */
#include "field/light-in-gas.h"

#include <math.h>

#include "geometry/bernstein-ellipse.h"
#include "geometry/vector.h"

static const hr2di_rule *choose_rule(const hr2di_light_source *of, double ellipse) {
  const double m = fmin(fmax(ellipse, HR2DI_NEAR_ELLIPSE), HR2DI_GAS_ELLIPSE);
  const double digits = -log(of->allowed) / log(m + sqrt(m * m - 1));
  const double points = ((double)of->leaves.order + digits) / 2 + 1;
  return hr2di_light_rule(of, points);
}

/* The parts of light that arrive, or that gas has absorbed. */
typedef struct parts {
  double mean, flux;
} parts;

static void add_light(hr2di_light_sum *sum, size_t b, parts part, double value, double angle,
                      hr2d_point vector) {
  sum->mean[b] += angle * (part.mean * value);
  if (!sum->flux) return;
  sum->flux[2 * b] += vector.x * (part.flux * value);
  sum->flux[2 * b + 1] += vector.y * (part.flux * value);
}

static parts absorbed_at(const hr2di_light_sum *sum, hr2d_section section, double depth) {
  parts p = {hr2di_passage_of_mean(section, depth).absorbed, 0};
  if (sum->flux) p.flux = hr2di_passage_at(section, depth).absorbed;
  return p;
}

static parts arriving_at(const hr2di_light_sum *sum, hr2d_section section, double depth) {
  parts p = {hr2di_passage_of_mean(section, depth).arrives, 0};
  if (sum->flux) p.flux = hr2di_passage_at(section, depth).arrives;
  return p;
}

static double value_at(const hr2di_light_sum *sum, const hr2di_strip *s, double t, size_t b) {
  const hr2di_light_source *of = sum->of;
  if (!s->coefficient) return 0;
  return hr2di_basis_sum(&of->basis, 2 * t - 1, s->coefficient + b, of->solution->bands);
}

/* Adds what a place that takes an angle, and ∫ω dω of it, sends in the bands of a group, and
   what gases send on the way: gas k D(x_k) − D(x_{k−1}) of its E. */
static void add_group(hr2di_light_sum *sum, size_t g, const hr2di_strip *s, double t,
                      double angle, hr2d_point vector) {
  const hr2di_light_source *of = sum->of;
  const hr2d_scene *scene = hr2di_band_group_scene(of->scene, g);
  const hr2d_section section = hr2di_scene_section(scene);
  const size_t bands = hr2di_band_group_size(of->scene, g);
  hr2di_gas_walk walk =
      hr2di_gas_walk_from(of->scene, sum->x, hr2di_block_along(s->from, s->along, t));
  parts before = {0, 0};
  double depth = 0;
  while (hr2di_gas_walk_next(&walk)) {
    depth += hr2di_scene_scaled_absorption(scene, walk.gas) * walk.piece;
    const parts absorbed = absorbed_at(sum, section, depth);
    const parts taken = {absorbed.mean - before.mean, absorbed.flux - before.flux};
    for (size_t k = 0; k < bands; k++) {
      const size_t b = hr2di_band_group_at(of->scene, g, k);
      add_light(sum, b, taken, *hr2di_solution_gas(of->solution, walk.gas, b), angle, vector);
    }
    before = absorbed;
  }
  const parts arrives = arriving_at(sum, section, depth);
  for (size_t k = 0; k < bands; k++) {
    const size_t b = hr2di_band_group_at(of->scene, g, k);
    add_light(sum, b, arrives, value_at(sum, s, t, b), angle, vector);
  }
}

static void add_place(hr2di_light_sum *sum, const hr2di_strip *s, double t, double angle,
                      hr2d_point vector) {
  for (size_t g = 0; g < hr2di_band_groups(sum->of->scene); g++)
    add_group(sum, g, s, t, angle, vector);
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

/* Adds panels of a part behind the same borders of gas. */
static void add_part(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span part, double *found,
                     hr2d_point *by) {
  const hr2di_light_source *of = sum->of;
  hr2di_panels panels = {.count = 1};
  panels.stack[0] = part;
  while (panels.count > 0) {
    const hr2di_span panel = panels.stack[--panels.count];
    const double m = hr2di_panel_ellipse(s->from, s->along, panel);
    if ((m < HR2DI_NEAR_ELLIPSE ||
         hr2di_panel_is_deep(sum->x, s->from, s->along, panel, of->scene)) &&
        hr2di_panel_halved(&panels, panel))
      continue;
    if (hr2di_watch_work(sum->watch, 8 + 2 * of->solution->order * of->solution->bands)) return;
    add_panel(sum, s, panel, choose_rule(of, m), found, by);
  }
}

void hr2di_light_add_in_gas(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span part,
                            double angle, hr2d_point vector) {
  double found = 0;
  hr2d_point by = {0, 0};
  for (double from = part.from; from < part.to;) {
    const double to = hr2di_panel_cut(sum->x, s->from, s->along, from, part.to, sum->of->scene);
    add_part(sum, s, (hr2di_span){from, to}, &found, &by);
    from = to;
  }
  const double size = hr2di_point_dot(s->along, s->along);
  const double nearest = size > 0 ? -hr2di_point_dot(s->from, s->along) / size : 0;
  add_place(sum, s, fmin(fmax(nearest, part.from), part.to), angle - found,
            (hr2d_point){vector.x - by.x, vector.y - by.y});
}
