/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "refine/law-view.h"

#include <gsl/gsl_math.h>
#include <math.h>

#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* Fractions of a patch are known to 1e-15. */
#define END 1e-13

/* A direction that is this near to the line of a patch, as a sine, is along it. */
#define ALONG 1e-12

/* An edge that is nearer to x, in coordinates below 2, is the foot of a wall in a corner. */
#define FOOT 1e-6

enum { SAMPLES = 32 /* of a demand over a part that is seen */, SECTIONS = 24 };

/* A part of a patch that the point x sees, from y_0 to y_1. */
typedef struct part {
  const hr2di_law_view *view;
  hr2di_law_pair pair;
  hr2d_point x;
  double from, to;
} part;

static hr2di_law_demand demand_at(const part *s, double t) {
  return hr2di_law_demand_clear(s->view->rule, &s->pair, s->x, hr2di_point_at(s->pair.q, t));
}

/* ∫ dy/r² = (angle of the part)/(height of x over its line), which is |y_0 y_1|/(r_0 r_1) for
   small angles. */
static double inverse_square(const part *s) {
  const hr2d_point d0 = hr2di_point_minus(hr2di_point_at(s->pair.q, s->from), s->x);
  const hr2d_point d1 = hr2di_point_minus(hr2di_point_at(s->pair.q, s->to), s->x);
  const double r0 = hypot(d0.x, d0.y), r1 = hypot(d1.x, d1.y);
  const double cross = fabs(hr2di_point_cross(d0, d1)), dot = hr2di_point_dot(d0, d1);
  const double length = s->pair.length_q * (s->to - s->from);
  return cross > 1e-9 * r0 * r1 ? length * atan2(cross, dot) / cross : length / (r0 * r1);
}

/* The fraction of the patch of y, of those seen, that is nearest to x. */
static double nearest(const part *s) {
  const hr2d_point to_x = hr2di_point_minus(s->x, s->pair.q.a);
  const double t = hr2di_point_dot(to_x, s->pair.along_q) / s->pair.length_q;
  return fmin(fmax(t, s->from), s->to);
}

/* The demand at x by the point in direction θ, from the perpendicular on the line of y. */
static double demand_towards(const part *s, double theta) {
  const hr2d_point to_x = hr2di_point_minus(s->x, s->pair.q.a);
  const double foot = hr2di_point_dot(to_x, s->pair.along_q);
  const double h = hr2di_point_cross(s->pair.along_q, to_x);
  const double t = (foot + h * tan(theta)) / s->pair.length_q;
  return demand_at(s, fmin(fmax(t, s->from), s->to)).x;
}

static double direction_of(const part *s, double t) {
  const hr2d_point d = hr2di_point_minus(hr2di_point_at(s->pair.q, t), s->x);
  return atan2(hr2di_point_dot(d, s->pair.along_q), -hr2di_point_cross(s->pair.along_q, d));
}

/* The largest demand at x along the part, or `known` if that is larger.  Demands change over
   angles: the best of some directions, then golden sections, unless that is far from enough. */
static double largest(const part *s, double known) {
  if (!s->view->rule->l1) return fmax(known, demand_at(s, nearest(s)).x);
  const double first = direction_of(s, s->from), last = direction_of(s, s->to);
  const double step = (last - first) / SAMPLES, golden = 0.61803398874989485;
  double best = 0;
  int at = 0;
  for (int k = 0; k <= SAMPLES; k++) {
    const double d = demand_towards(s, first + k * step);
    if (d > best) at = k;
    best = fmax(best, d);
  }
  if (1.1 * best < known) return known;
  double low = first + fmax(at - 1, 0) * step, high = first + fmin(at + 1, SAMPLES) * step;
  for (int k = 0; k < SECTIONS; k++) {
    const double left = high - golden * (high - low), right = low + golden * (high - low);
    const double on_left = demand_towards(s, left), on_right = demand_towards(s, right);
    best = fmax(best, fmax(on_left, on_right));
    if (on_left > on_right)
      high = right;
    else
      low = left;
  }
  return fmax(known, best);
}

/* ∫ |dr/dx|/r² dy.  With y at s from the foot of x, which is h away, dr/dx = (c + e s)/r and
   r² = h² + s². */
static double inverse_square_slope(const part *s) {
  const hr2d_point to_x = hr2di_point_minus(s->x, s->pair.q.a);
  const double foot = hr2di_point_dot(to_x, s->pair.along_q);
  const double h = hr2di_point_cross(s->pair.along_q, to_x);
  const double e = hr2di_point_dot(s->pair.along_p, s->pair.along_q);
  const double c = h * hr2di_point_cross(s->pair.along_p, s->pair.along_q);
  const double from = s->from * s->pair.length_q - foot, to = s->to * s->pair.length_q - foot;
  const double zero = e != 0 ? fmin(fmax(-c / e, from), to) : from, end[] = {from, zero, to};
  double value[3];
  for (int k = 0; k < 3; k++) value[k] = (c * end[k] / (h * h) - e) / hypot(h, end[k]);
  return fabs(value[1] - value[0]) + fabs(value[2] - value[1]);
}

static hr2d_status density(void *ctx, double t, double *value) {
  const part *s = ctx;
  *value = hr2di_law_links(s->view->rule, &s->pair, demand_at(s, t));
  return hr2di_watch_work(s->view->watch, 1);
}

/* The links of x with the part. */
static hr2d_status links(part *s, double *sum) {
  if (!s->view->rule->l1) {
    const double t = nearest(s), r = hypot(hr2di_point_at(s->pair.q, t).x - s->x.x,
                                           hr2di_point_at(s->pair.q, t).y - s->x.y);
    *sum =
        hr2di_law_links(s->view->rule, &s->pair, demand_at(s, t)) * r * r * inverse_square(s);
    return HR2D_OK;
  }
  const hr2di_law_integral integral = {.at = density,
                                       .ctx = s,
                                       .parts = 1,
                                       .pieces = 1,
                                       .most = 100,
                                       .tolerance = HR2DI_LAW_TOLERANCE_L1};
  double error = 0;
  *sum = 0;
  const hr2d_status status = hr2di_law_integrate(&integral, s->from, s->to, sum, &error);
  *sum *= s->pair.length_q;
  return status;
}

/* Where the part ends at y = q(t), inside of its patch. */
static void add_edge(const part *s, double t, double *value, double *edge_demand) {
  const hr2di_law_rule *rule = s->view->rule;
  const hr2d_point y = hr2di_point_at(s->pair.q, t), d = hr2di_point_minus(y, s->x);
  const hr2di_law_demand clear = hr2di_law_demand_clear(rule, &s->pair, s->x, y);
  const double r = hypot(d.x, d.y);
  if (r < FOOT) return;
  if (fabs(hr2di_point_cross(s->pair.along_p, d)) < ALONG * r) {
    value[HR2DI_LAW_CLEAR_LINKS] += hr2di_law_horizon_links(clear);
    return;
  }
  const hr2di_law_demand edge = hr2di_law_demand_edge(rule, &s->pair, s->x, y);
  const hr2di_law_edge links = hr2di_law_edge_links(rule, &s->pair, edge, clear);
  value[HR2DI_LAW_EDGE_LINKS] += links.edge;
  value[HR2DI_LAW_CLEAR_LINKS] += links.clear;
  *edge_demand = fmax(*edge_demand, edge.x);
}

/* Whether the view of a patch ends between two intervals. */
static int ends(const hr2di_visible_interval *left, const hr2di_visible_interval *right) {
  return left->patch != right->patch || right->from - left->to > END;
}

/* Intervals are sorted by patch, and along each patch. */
static hr2d_status add_interval(part *s, const hr2di_view_from *seen, size_t k, double *value,
                                double *clear, double *edge) {
  const hr2di_visible_interval *i = &seen->interval[k];
  double sum;
  const hr2d_status status = links(s, &sum);
  value[HR2DI_LAW_LINKS] += 0.5 * sum; /* the other patch has the other half */
  if (hr2di_law_halves_links(s->view->rule, &s->pair) != 0)
    value[HR2DI_LAW_CLEAR_LINKS] +=
        hr2di_law_halves_links(s->view->rule, &s->pair) * inverse_square_slope(s);
  *clear = largest(s, *clear);
  if (i->from > END && (k == 0 || ends(i - 1, i))) add_edge(s, i->from, value, edge);
  if (i->to < 1 - END && (k + 1 == seen->count || ends(i, i + 1)))
    add_edge(s, i->to, value, edge);
  return status;
}

/* Near a corner of two patches the demand of `l1` grows like t^(−2/3).  In u, with
   t = u³ (10 − 15 u + 6 u²), that is smooth. */
hr2d_status hr2di_law_view_at(void *ctx, double u, double *value) {
  const hr2di_law_view *view = ctx;
  const double t = u * u * u * (10 - u * (15 - 6 * u));
  const double length = view->scene->patch[view->patch].length * 30 * u * u * (1 - u) * (1 - u);
  double clear = 0, edge = 0;
  hr2di_view_from seen;
  hr2d_status status = hr2di_view_at(view->viewer, view->patch, t, &seen);
  for (size_t k = 0; k < HR2DI_LAW_PARTS; k++) value[k] = 0;
  for (size_t k = 0; !status && k < seen.count; k++) {
    const hr2di_visible_interval *i = &seen.interval[k];
    if (i->patch == view->patch || !hr2di_scene_lit(view->scene, i->patch)) continue;
    part s = {.view = view,
              .pair = hr2di_law_pair_of(view->rule, view->scene, view->patch, i->patch),
              .x = hr2di_point_at(view->scene->patch[view->patch].scaled, t),
              .from = i->from,
              .to = i->to};
    status = hr2di_watch_work(view->watch, view->rule->l1 ? 60 : 4);
    if (!status) status = add_interval(&s, &seen, k, value, &clear, &edge);
  }
  /* A leaf satisfies all demands; the larger power of 1/ε wins. */
  if (view->rule->edge_power > view->rule->power && edge > 0) clear = 0;
  if (view->rule->edge_power == view->rule->power) clear = fmax(clear, edge), edge = 0;
  value[HR2DI_LAW_ELEMENTS] = 2 / M_LN2 * clear;
  value[HR2DI_LAW_EDGE_ELEMENTS] = 2 / M_LN2 * edge;
  for (size_t k = 0; k < HR2DI_LAW_PARTS; k++) value[k] *= length;
  return status;
}
