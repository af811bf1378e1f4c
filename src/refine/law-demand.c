/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "refine/law-demand.h"

#include <gsl/gsl_math.h>
#include <math.h>

#include "geometry/vector.h"
#include "scene/scene-impl.h"

int hr2di_law_rule_find(const hr2d_oracle *oracle, const hr2d_policy *policy,
                        hr2di_law_rule *rule) {
  const int l1 = oracle->estimate == hr2d_oracle_l1()->estimate;
  const int size = oracle->estimate == hr2d_oracle_size()->estimate;
  const int size2 = oracle->estimate == hr2d_oracle_size2()->estimate;
  const int modified =
      policy->preferred_subdivision == hr2d_policy_modified()->preferred_subdivision;
  const int original =
      policy->preferred_subdivision == hr2d_policy_original()->preferred_subdivision;
  if (!(l1 || size || size2) || !(modified || original) || policy->acceptable ||
      policy->recursion_limit)
    return -1;
  *rule = (hr2di_law_rule){.l1 = l1, .modified = modified};
  rule->power = l1 ? 1. / 3 : size2 ? 0.5 : 1;
  rule->edge_power = size ? 1 : 0.5;
  return 0;
}

/* The larger of two equal elements is the first one of the pair: ρ = 1 from its side, 2 from
   the other. */
static double alternating_ratio(double length_p, double length_q, int first) {
  int exponent;
  const double ratio = 2 * frexp(length_p / length_q, &exponent);
  return ratio == 1 && !first ? 2 : ratio;
}

hr2di_law_pair hr2di_law_pair_of(const hr2di_law_rule *rule, const hr2d_scene *scene, size_t p,
                                 size_t q) {
  const hr2di_patch *i = &scene->patch[p], *j = &scene->patch[q];
  hr2di_law_pair pair = {
      .p = i->scaled, .q = j->scaled, .length_p = i->length, .length_q = j->length};
  pair.along_p = hr2di_point_minus(i->scaled.b, i->scaled.a);
  pair.along_q = hr2di_point_minus(j->scaled.b, j->scaled.a);
  pair.along_p = (hr2d_point){pair.along_p.x / i->length, pair.along_p.y / i->length};
  pair.along_q = (hr2d_point){pair.along_q.x / j->length, pair.along_q.y / j->length};
  pair.ratio =
      rule->modified ? i->length / j->length : alternating_ratio(i->length, j->length, p < q);
  return pair;
}

/* G and its absolute derivatives along both patches. */
typedef struct kernel {
  double r, g, along_p, along_q;
} kernel;

static kernel kernel_at(const hr2di_law_pair *pair, hr2d_point x, hr2d_point y) {
  const hr2d_point d = hr2di_point_minus(y, x);
  const double r = hypot(d.x, d.y), r3 = 2 * r * r * r;
  const double over_p = fmax(hr2di_point_cross(pair->along_p, d), 0);
  const double over_q = fmax(-hr2di_point_cross(pair->along_q, d), 0);
  const double turn = hr2di_point_cross(pair->along_p, pair->along_q);
  const double g = over_p * over_q / r3, g_r2 = 3 * g / (r * r);
  return (kernel){
      .r = r,
      .g = g,
      .along_p = fabs(g_r2 * hr2di_point_dot(d, pair->along_p) - over_p * turn / r3),
      .along_q = fabs(over_q * turn / r3 - g_r2 * hr2di_point_dot(d, pair->along_q))};
}

/* ∫∫ |s + t| over |s| ≤ u/2 and |t| ≤ v/2, by u v. */
static double mean_change(double u, double v) {
  const double most = fmax(u, v), least = fmin(u, v);
  return most > 0 ? most / 4 + least * least / (12 * most) : 0;
}

static double root_clear(const hr2di_law_rule *rule, const kernel *k, double ratio) {
  return rule->l1 ? cbrt(ratio * mean_change(k->along_p * ratio, k->along_q))
                  : fmax(ratio, 1) / k->r;
}

/* `size` doubles its estimate; `l1` adds the exchange area, which is much larger. */
static double root_edge(const hr2di_law_rule *rule, const kernel *k, double ratio) {
  return rule->l1 ? sqrt(ratio * k->g) : 2 * fmax(ratio, 1) / k->r;
}

static hr2di_law_demand demand(const hr2di_law_rule *rule, const hr2di_law_pair *pair,
                               const kernel *k,
                               double (*root)(const hr2di_law_rule *, const kernel *, double)) {
  const double both = root(rule, k, pair->ratio);
  return (hr2di_law_demand){both / pair->ratio,
                            rule->modified ? both : root(rule, k, pair->ratio / 2)};
}

hr2di_law_demand hr2di_law_demand_clear(const hr2di_law_rule *rule, const hr2di_law_pair *pair,
                                        hr2d_point x, hr2d_point y) {
  const kernel k = kernel_at(pair, x, y);
  return demand(rule, pair, &k, root_clear);
}

hr2di_law_demand hr2di_law_demand_edge(const hr2di_law_rule *rule, const hr2di_law_pair *pair,
                                       hr2d_point x, hr2d_point y) {
  const kernel k = kernel_at(pair, x, y);
  return demand(rule, pair, &k, root_edge);
}

double hr2di_law_links(const hr2di_law_rule *rule, const hr2di_law_pair *pair,
                       hr2di_law_demand d) {
  if (rule->modified) return 1.5 / M_LN2 * d.x * d.y;
  return 0.5 / M_LN2 * (pair->ratio * d.x * d.x + 2 / pair->ratio * d.y * d.y);
}

double hr2di_law_halves_links(const hr2di_law_rule *rule, const hr2di_law_pair *pair) {
  return rule->l1 || rule->modified || pair->ratio != 1 ? 0 : -0.25 / M_LN2;
}

hr2di_law_edge hr2di_law_edge_links(const hr2di_law_rule *rule, const hr2di_law_pair *pair,
                                    hr2di_law_demand edge, hr2di_law_demand clear) {
  if (rule->modified) return (hr2di_law_edge){2 / M_LN2 * edge.x, -1.5 / M_LN2 * clear.x};
  return (hr2di_law_edge){(edge.x + edge.y / pair->ratio) / M_LN2,
                          -(0.5 * clear.x + clear.y / pair->ratio) / M_LN2};
}

double hr2di_law_horizon_links(hr2di_law_demand clear) {
  return 0.5 / M_LN2 * clear.x;
}
