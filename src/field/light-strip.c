/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ∫ B dω and ∫ B ω dω along what a point sees.

   Between two directions u and v, unit vectors with angles θ_u < θ_v, a constant B gives
     B (θ_v − θ_u)   and   B (v.y − u.y, u.x − v.x).
   So does the value of B at the place of a leaf that is nearest to the point.  What differs
   from that is integrated by Gauss rules: with r(t) = p + t d along the leaf
     dω = p×d dt / |r|²,   ω = r/|r|.
   Such an integrand is analytic but at the two complex t where r² = 0, and 0 at the place that
   is nearest to them.  Panels shrink towards that place, until these t lie outside of the
   ellipse of HR2DI_NEAR_ELLIPSE, where n points leave an error of ρ^−(2n − p) times the
   variation of B.  What the smallest panel leaves is that variation on 2^-46 of the leaf. */
#include "field/light-strip.h"

#include <math.h>

#include "geometry/bernstein-ellipse.h"

/* The rule for a panel around which there is no singularity up to ellipse m. */
static const hr2di_rule *choose_rule(const hr2di_light_source *of, const hr2di_strip *s,
                                     double m) {
  const double digits = log(m + sqrt(m * m - 1));
  return hr2di_light_rule(
      of, ((double)of->leaves.order + log(s->varies / of->allowed) / digits) / 2 + 1);
}

void hr2di_strip_add_panel(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span panel,
                           const hr2di_rule *rule, int all) {
  const hr2di_light_source *of = sum->of;
  const size_t bands = of->solution->bands;
  const double size = panel.to - panel.from, cross = hr2di_point_cross(s->from, s->along);
  double xi[HR2DI_RULE_POINTS], weight[HR2DI_RULE_POINTS];
  hr2d_point ray[HR2DI_RULE_POINTS];
  for (size_t q = 0; q < rule->points; q++) {
    const double t = panel.from + size * (0.5 + 0.5 * rule->at[q]);
    const hr2d_point r = hr2di_block_along(s->from, s->along, t);
    const double square = hr2di_point_dot(r, r);
    xi[q] = 2 * t - 1;
    weight[q] = square > 0 ? size * rule->weight[q] * cross / square : 0;
    if (!sum->flux) continue;
    const double far = square > 0 ? 1 / sqrt(square) : 0;
    ray[q] = (hr2d_point){far * r.x, far * r.y};
  }
  for (size_t b = 0; b < bands; b++) {
    const double *c = s->coefficient + b;
    const double nearest = all ? 0 : hr2di_basis_sum(&of->basis, s->nearest, c, bands);
    double mean = 0, x = 0, y = 0;
    for (size_t q = 0; q < rule->points; q++) {
      const double part = weight[q] * (hr2di_basis_sum(&of->basis, xi[q], c, bands) - nearest);
      mean += part;
      if (!sum->flux) continue;
      x += part * ray[q].x;
      y += part * ray[q].y;
    }
    sum->mean[b] += mean;
    if (!sum->flux) continue;
    sum->flux[2 * b] += x;
    sum->flux[2 * b + 1] += y;
  }
}

/* What the variation of B adds. */
static void add_variation(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span part) {
  hr2di_panels panels = {.count = 1};
  panels.stack[0] = part;
  while (panels.count > 0) {
    const hr2di_span panel = panels.stack[--panels.count];
    const hr2d_segment around = {hr2di_block_along(s->from, s->along, panel.from),
                                 hr2di_block_along(s->from, s->along, panel.to)};
    const double m = hr2di_ellipse(around, (hr2d_point){0, 0});
    if (m < HR2DI_NEAR_ELLIPSE && hr2di_panel_halved(&panels, panel)) continue;
    if (hr2di_watch_work(sum->watch, 1 + sum->of->leaves.order * sum->of->solution->bands))
      return;
    hr2di_strip_add_panel(sum, s, panel, choose_rule(sum->of, s, fmax(m, HR2DI_NEAR_ELLIPSE)),
                          0);
  }
}

static void set_nearest(hr2di_strip *s, hr2di_span part) {
  const double t = -hr2di_point_dot(s->from, s->along) / hr2di_point_dot(s->along, s->along);
  s->nearest = 2 * fmin(fmax(t, part.from), part.to) - 1;
}

void hr2di_strip_add_near(hr2di_light_sum *sum, hr2di_strip *s, hr2di_span part,
                          hr2d_point right, hr2d_point left, double angle) {
  const hr2di_light_source *of = sum->of;
  const size_t bands = of->solution->bands;
  if (angle < 0) angle = hr2di_light_angle(right, left);
  const hr2d_point vector = sum->flux ? hr2di_light_vector(right, left) : (hr2d_point){0, 0};
  set_nearest(s, part);
  /* As a part of what a wide angle would add; an error that is allowed is one of the angle. */
  if (!of->far) s->varies *= fmin(fabs(angle), 1);
  for (size_t b = 0; b < bands; b++)
    hr2di_light_add_constant(sum, b,
                             hr2di_basis_sum(&of->basis, s->nearest, s->coefficient + b, bands),
                             angle, vector);
  if (s->varies > of->allowed && part.to > part.from) add_variation(sum, s, part);
}

const hr2di_rule *hr2di_strip_far_rule(const hr2di_light_source *of, uint32_t element,
                                       const hr2di_strip *s, hr2di_span part) {
  if (!of->far || !(part.to > part.from) || hr2di_scene_regions(of->scene)) return NULL;
  const hr2d_point from = hr2di_block_along(s->from, s->along, part.from),
                   to = hr2di_block_along(s->from, s->along, part.to),
                   all = hr2di_point_minus(to, from);
  const double m = (sqrt(hr2di_point_dot(from, from)) + sqrt(hr2di_point_dot(to, to))) /
                   sqrt(hr2di_point_dot(all, all));
  for (int n = 0; n < HR2DI_LIGHT_FAR; n++)
    if (m >= of->far[element].from[n]) return &of->rule[n];
  return NULL;
}
