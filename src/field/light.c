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
   variation of B.  What the smallest panel leaves is that variation on 2^-46 of the leaf.

   If an error is allowed, a rule takes a leaf that is far as a whole.  With the point at ξ₀ in
   the complex plane of the leaf's [−1,1], dω = Im dξ/(ξ − ξ₀), and a rule of n points is exact
   for (B(ξ) − B(ξ₀))/(ξ − ξ₀), a polynomial of degree below 2n.  What is left is that of
   B(ξ₀)/(ξ − ξ₀), which is 2 B(ξ₀) Q_n(ξ₀)/P_n(ξ₀) with the second Legendre function Q_n: about
   2π B(ξ₀) ρ^−(2n+1), and (2n + 1) times that, at most, as a part of the angle. With |P_l(ξ₀)|
   ≤ ρ^l this gives 4 (2n + 1) (c₀ ρ^−2n + Σ |c_l| √(2l+1) ρ^(p−1−2n)), in which 4 has a factor
   of 2 to spare.

   So does an element that is far take the place of all leaves below it, which may differ much
   more from its polynomial: what is left of B is orthogonal to polynomials of degree below p,
   and of dω/dξ counts what these leave.  Im 1/(ξ − ξ₀) is the harder to approximate, as a part
   of its integral, the nearer ξ₀ is to the line of the element, where it is
   y/(ξ − x)² with the integral 2y/(x² − 1).  Polynomials leave 4 ρ^−(p+1) of 1/(ξ − x) in the
   mean of |·|, so that they leave 4 (p + 1) ρ^−(p+1)/√(x² − 1) of its derivative: (p + 1) ρ^−p
   of the angle.  Twice that is taken, times the largest difference. */
#include "field/light.h"

#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "field/light-in-gas.h"
#include "geometry/bernstein-ellipse.h"
#include "geometry/vector.h"
#include "solution/panels.h"

static const unsigned char rule_points[HR2DI_LIGHT_RULES] = {2,  3,  4,  5,  6,  7,  8, 9,
                                                             10, 12, 14, 17, 21, 27, 36};

/* Variations below this part of the largest B are roundings. */
#define ROUNDING 0x1p-54

/* Of the allowed error, what takes the merging of leaves, and what the rules. */
#define MERGED 0.75
#define RULED  0.25

/* Of what the rules take, the part for leaves that an element stands for. */
#define ORTHOGONAL 0.5

hr2d_status hr2di_light_source_init(hr2di_light_source *of, const hr2d_solution *solution,
                                    hr2di_watch *watch) {
  *of = (hr2di_light_source){.solution = solution,
                             .allowed = ROUNDING,
                             .has_gas = hr2di_scene_has_gas(solution->hierarchy->scene)};
  hr2di_basis_init(&of->basis, solution->order);
  for (int k = 0; k < HR2DI_LIGHT_RULES; k++) hr2di_rule_init(&of->rule[k], rule_points[k]);
  return hr2di_leaves_init(&of->leaves, solution, NULL, watch);
}

void hr2di_light_source_clear(hr2di_light_source *of) {
  hr2di_alloc_free(&of->leaves.alloc, of->far);
  hr2di_alloc_free(&of->leaves.alloc, of->element_error);
  hr2di_leaves_clear(&of->leaves);
}

/* The size m of an ellipse with ρ^power = value. */
static double ellipse_of(double value, double power) {
  const double rho = value > 1 ? pow(value, 1 / power) : 1;
  return (rho + 1 / rho) / 2;
}

static hr2di_light_far far_of(const hr2di_light_source *of, uint32_t element) {
  const double order = (double)of->leaves.order, degree = order - 1;
  const double differs = of->leaves.difference[element] * (MERGED / (RULED * ORTHOGONAL));
  const double smooth = ellipse_of(2 * (order + 1) * differs, order);
  hr2di_light_far far;
  float level, varies;
  hr2di_leaves_measure(&of->leaves, of->solution->bands, element, &level, &varies);
  for (int k = 0; k < HR2DI_LIGHT_FAR; k++) {
    const double n = rule_points[k];
    const double max = 4 * (2 * n + 1) / (of->allowed * (1 - ORTHOGONAL));
    const double from = 2 * n > degree ? fmax(ellipse_of(2 * max * level, 2 * n),
                                              ellipse_of(2 * max * varies, 2 * n - degree))
                                       : HUGE_VAL;
    far.from[k] = (float)fmax(fmax(from, smooth), HR2DI_NEAR_ELLIPSE);
  }
  return far;
}

hr2d_status hr2di_light_source_relax(hr2di_light_source *of, const double *max,
                                     hr2di_watch *watch) {
  const size_t bands = of->solution->bands;
  const hr2d_allocator alloc = of->leaves.alloc;
  double *merged = hr2di_alloc(&alloc, bands, sizeof *merged);
  if (!merged) return HR2D_ENOMEM;
  double min = 1;
  for (size_t b = 0; b < bands; b++) {
    merged[b] = MERGED * max[b];
    if (of->leaves.scale[b] > 0) min = fmin(min, max[b] / of->leaves.scale[b]);
  }
  hr2di_leaves_clear(&of->leaves);
  hr2d_status status = hr2di_leaves_init(&of->leaves, of->solution, merged, watch);
  hr2di_alloc_free(&alloc, merged);
  of->allowed = fmax(RULED * min, ROUNDING);
  if (status) return status;
  const size_t elements = of->solution->elements;
  hr2di_basis_init(&of->basis, of->leaves.order);
  of->far = hr2di_alloc(&alloc, elements, sizeof *of->far);
  if (!of->far) return HR2D_ENOMEM;
  for (size_t k = 0; k < elements && !status; k++) {
    of->far[k] = far_of(of, (uint32_t)k);
    status = hr2di_watch_work(watch, 10);
  }
  return status;
}

static hr2d_point unit(hr2d_point v) {
  const double length = sqrt(hr2di_point_dot(v, v));
  return length > 0 ? (hr2d_point){v.x / length, v.y / length} : v;
}

/* ∫ ω dω between two directions. */
static hr2d_point between(hr2d_point right, hr2d_point left) {
  const hr2d_point u = unit(right), v = unit(left);
  return (hr2d_point){v.y - u.y, u.x - v.x};
}

static double angle_between(hr2d_point right, hr2d_point left) {
  return atan2(hr2di_point_cross(right, left), hr2di_point_dot(right, left));
}

static void add_constant(hr2di_light_sum *sum, size_t band, double value, double angle,
                         hr2d_point vector) {
  sum->mean[band] += value * angle;
  if (!sum->flux) return;
  sum->flux[2 * band] += value * vector.x;
  sum->flux[2 * band + 1] += value * vector.y;
}

/* A part of a leaf: the vector from the point to its start, its own, and B on it. */
typedef struct strip {
  hr2d_point from, along;
  double varies;
  double nearest; /* where B is taken for constant, in [−1,1] of the leaf */
  const double *coefficient;
} strip;

/* The rule for a panel around which there is no singularity up to ellipse m. */
static const hr2di_rule *choose_rule(const hr2di_light_source *of, const strip *s, double m) {
  const double digits = log(m + sqrt(m * m - 1));
  const double points =
      ((double)of->leaves.order + log(s->varies / of->allowed) / digits) / 2 + 1;
  int k = 0;
  while (k + 1 < HR2DI_LIGHT_RULES && rule_points[k] < points) k++;
  return &of->rule[k];
}

/* What B on a panel is more than at the nearest place; or all of B. */
static void add_panel(hr2di_light_sum *sum, const strip *s, hr2di_span panel,
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
static void add_variation(hr2di_light_sum *sum, const strip *s, hr2di_span part) {
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
    add_panel(sum, s, panel, choose_rule(sum->of, s, fmax(m, HR2DI_NEAR_ELLIPSE)), 0);
  }
}

/* The vector from x to a fraction of a patch, from the end of the patch that is nearer. */
static hr2d_point to_place(hr2d_point x, hr2d_segment at, double fraction) {
  const hr2d_point along = hr2di_point_minus(at.b, at.a);
  return fraction <= 0.5 ? hr2di_block_along(hr2di_point_minus(at.a, x), along, fraction)
                         : hr2di_block_along(hr2di_point_minus(at.b, x), along, fraction - 1);
}

static void set_nearest(strip *s, hr2di_span part) {
  const double t = -hr2di_point_dot(s->from, s->along) / hr2di_point_dot(s->along, s->along);
  s->nearest = 2 * fmin(fmax(t, part.from), part.to) - 1;
}

/* A leaf between two directions, of which it has the part from `part.from` to `part.to`.
   angle: between them, or below 0 if it is not known. */
static void add_near(hr2di_light_sum *sum, strip *s, hr2di_span part, hr2d_point right,
                     hr2d_point left, double angle) {
  const hr2di_light_source *of = sum->of;
  const size_t bands = of->solution->bands;
  if (angle < 0) angle = angle_between(right, left);
  const hr2d_point vector = sum->flux ? between(right, left) : (hr2d_point){0, 0};
  set_nearest(s, part);
  /* As a part of what a wide angle would add; an error that is allowed is one of the angle. */
  if (!of->far) s->varies *= fmin(fabs(angle), 1);
  for (size_t b = 0; b < bands; b++)
    add_constant(sum, b, hr2di_basis_sum(&of->basis, s->nearest, s->coefficient + b, bands),
                 angle, vector);
  if (s->varies > of->allowed && part.to > part.from) add_variation(sum, s, part);
}

/* The first rule that may take a part of an element as a whole, seen from x; NULL if it is
   near, or a point that x touches. */
static const hr2di_rule *far_rule(const hr2di_light_source *of, uint32_t element,
                                  const strip *s, hr2di_span part) {
  if (!of->far || !(part.to > part.from)) return NULL;
  const hr2d_point from = hr2di_block_along(s->from, s->along, part.from),
                   to = hr2di_block_along(s->from, s->along, part.to),
                   all = hr2di_point_minus(to, from);
  const double m = (sqrt(hr2di_point_dot(from, from)) + sqrt(hr2di_point_dot(to, to))) /
                   sqrt(hr2di_point_dot(all, all));
  for (int n = 0; n < HR2DI_LIGHT_FAR; n++)
    if (m >= of->far[element].from[n]) return &of->rule[n];
  return NULL;
}

static void see_end(hr2di_light_sum *sum, hr2d_point at) {
  sum->clearance = fmin(sum->clearance, hr2di_point_dot(at, at));
}

/* Images have the largest error of their patch. */
static void add_error(hr2di_light_sum *sum, uint32_t patch, uint32_t element, hr2d_point right,
                      hr2d_point left) {
  const hr2di_light_source *of = sum->of;
  const size_t bands = of->solution->bands, cell = hr2di_scene_cell(of->scene);
  if (!of->element_error) return;
  const double angle = angle_between(right, left);
  const double *error = of->element_error + (patch < cell ? element : patch % cell) * bands;
  for (size_t b = 0; b < bands; b++) sum->error[b] += angle * error[b];
}

/* A patch that is seen from `x`. */
typedef struct seen_patch {
  hr2d_segment at;
  hr2d_point whole; /* from end to end */
  uint32_t patch;   /* which has the leaves */
} seen_patch;

/* An element of it from one fraction to another. */
typedef struct seen_element {
  uint32_t element;
  double from, to;
} seen_element;

static strip strip_of(const hr2di_light_sum *sum, const seen_patch *p, const seen_element *e) {
  const hr2di_light_source *of = sum->of;
  const double size = e->to - e->from;
  return (strip){.from = to_place(sum->x, p->at, e->from),
                 .along = {size * p->whole.x, size * p->whole.y},
                 .coefficient =
                     of->leaves.value + e->element * of->leaves.order * of->solution->bands};
}

/* The largest element that begins with a leaf, ends before `to`, and is far; adds it.  Returns
   whether there is one: it is not the leaf itself. */
static int add_far(hr2di_light_sum *sum, const seen_patch *p, size_t leaf, double to,
                   seen_element *e) {
  const hr2di_light_source *of = sum->of;
  const hr2d_element *tree = of->solution->hierarchy->element;
  const hr2di_leaf *first = &of->leaves.leaf[leaf];
  *e = (seen_element){p->patch, 0, 1};
  while (e->element != first->element) {
    if (e->from == first->from && e->to <= to) {
      const strip s = strip_of(sum, p, e);
      const hr2di_rule *rule = far_rule(of, e->element, &s, (hr2di_span){0, 1});
      if (rule) add_panel(sum, &s, (hr2di_span){0, 1}, rule, 1);
      if (rule) return 1;
    }
    const double middle =
        e->from + hr2di_element_left_part(tree, e->element) * (e->to - e->from);
    const int right = first->from >= middle;
    *e = right ? (seen_element){tree[e->element].child + 1, middle, e->to}
               : (seen_element){tree[e->element].child, e->from, middle};
  }
  return 0;
}

/* Jumps of B within a far element are no nearer than it is. */
static void see_within(hr2di_light_sum *sum, const seen_patch *p, const seen_element *e) {
  const strip s = strip_of(sum, p, e);
  const hr2d_point to = hr2di_block_along(s.from, s.along, 1);
  const double near = (sqrt(hr2di_point_dot(s.from, s.from)) + sqrt(hr2di_point_dot(to, to)) -
                       sqrt(hr2di_point_dot(s.along, s.along))) /
                      2;
  see_end(sum, (hr2d_point){near, 0});
}

static void add_in_gas(hr2di_light_sum *sum, const strip *s, hr2di_span part, hr2d_point right,
                       hr2d_point left) {
  const hr2di_gas_strip through = {s->from, s->along, part, s->coefficient};
  hr2di_light_add_in_gas(sum, &through, angle_between(right, left), between(right, left));
}

/* A back sends nothing, but gas in front of it does. */
static void add_back(hr2di_light_sum *sum, const hr2di_polygon_arc *s) {
  const hr2di_gas_strip back = {s->right, hr2di_point_minus(s->left, s->right), {0, 1}, NULL};
  sum->back += s->angle;
  if (sum->of->has_gas)
    hr2di_light_add_in_gas(sum, &back, s->angle, between(s->right, s->left));
}

/* A leaf, or the part of it between two fractions of the patch. */
static void add_leaf(hr2di_light_sum *sum, const seen_patch *p, size_t k, hr2di_span seen,
                     hr2d_point right, hr2d_point left, double angle) {
  const hr2di_light_source *of = sum->of;
  const hr2di_leaf *leaf = &of->leaves.leaf[k];
  const seen_element e = {leaf->element, leaf->from, hr2di_leaf_end(&of->leaves, p->patch, k)};
  const double size = e.to - e.from;
  const hr2di_span part = {fmax((seen.from - e.from) / size, 0),
                           fmin((seen.to - e.from) / size, 1)};
  strip s = strip_of(sum, p, &e);
  s.varies = leaf->varies;
  const hr2di_rule *rule = far_rule(of, leaf->element, &s, part);
  if (of->has_gas)
    add_in_gas(sum, &s, part, right, left);
  else if (rule)
    add_panel(sum, &s, part, rule, 1);
  else
    add_near(sum, &s, part, right, left, angle);
}

/* The leaves of a stretch, from its right to its left, or elements in their place.  Where two
   of them meet is rounded; they share the direction, so that all of the angle is divided among
   them. */
static void add_front(hr2di_light_sum *sum, const hr2di_polygon_arc *seen) {
  const hr2di_light_source *of = sum->of;
  const hr2d_segment at = of->scene->patch[seen->patch].scaled;
  const seen_patch p = {at, hr2di_point_minus(at.b, at.a), hr2di_light_patch(of, seen->patch)};
  hr2d_point right = seen->right;
  if (p.patch == HR2DI_NOBODY) return;
  size_t k = hr2di_leaf_at(&of->leaves, p.patch, seen->from);
  for (int last = 0; !last; k++) {
    const size_t begin = k;
    seen_element e = {of->leaves.leaf[k].element, 0, hr2di_leaf_end(&of->leaves, p.patch, k)};
    const int far =
        of->far && of->leaves.leaf[k].from >= seen->from && add_far(sum, &p, k, seen->to, &e);
    last = !(e.to < seen->to);
    const hr2d_point left = last ? seen->left : to_place(sum->x, at, e.to);
    if (far)
      k = last ? k : hr2di_leaf_at(&of->leaves, p.patch, e.to) - 1;
    else
      add_leaf(sum, &p, k, (hr2di_span){seen->from, seen->to}, right, left,
               last && hr2di_point_same(right, seen->right) ? seen->angle : -1);
    add_error(sum, p.patch, e.element, right, left);
    if (hr2di_watch_work(sum->watch, 1)) return;
    if (far && of->leaves.group && of->leaves.group[begin] != of->leaves.group[k])
      see_within(sum, &p, &e);
    if (!last && of->leaves.group && of->leaves.group[k] != of->leaves.group[k + 1])
      see_end(sum, left);
    right = left;
  }
}

static hr2d_point to_sun(hr2d_sun sun) {
  return unit((hr2d_point){-sun.direction.x, -sun.direction.y});
}

int hr2di_light_has_sun(const hr2di_light_source *of, hr2d_point right, hr2d_point left,
                        size_t band) {
  const hr2d_sun sun = hr2d_scene_sun(of->scene, band);
  if (!(sun.irradiance > 0)) return 0;
  const hr2d_point to = to_sun(sun);
  const double after = hr2di_point_cross(right, to), before = hr2di_point_cross(to, left);
  const int behind = hr2di_point_dot(right, to) < 0 && after == 0;
  return after >= 0 && before > 0 && !behind;
}

/* Parallel light of irradiance I is B = 2I δ(ω + d). */
void hr2di_light_add_sun(hr2di_light_sum *sum, size_t band) {
  const hr2d_sun sun = hr2d_scene_sun(sum->of->scene, band);
  add_constant(sum, band, 2 * sun.irradiance, 1, to_sun(sun));
}

static void add_suns(hr2di_light_sum *sum, const hr2di_polygon_arc *s) {
  for (size_t b = 0; b < sum->of->solution->bands; b++)
    if (hr2di_light_has_sun(sum->of, s->right, s->left, b)) hr2di_light_add_sun(sum, b);
}

/* Adds an arc of the sky from an angle on, counterclockwise from +x. */
static void add_arc(hr2di_light_sum *sum, size_t piece, double from, double angle) {
  const hr2d_scene *scene = sum->of->scene;
  const hr2d_point right = {cos(from), sin(from)},
                   left = {cos(from + angle), sin(from + angle)};
  const hr2d_point vector = sum->flux ? between(right, left) : (hr2d_point){0, 0};
  for (size_t b = 0; b < sum->of->solution->bands; b++)
    add_constant(sum, b, hr2di_sky_beyond(scene, piece, b), angle, vector);
}

/* What the pieces of the sky send beyond the background. */
static void add_pieces(hr2di_light_sum *sum, const hr2di_polygon_arc *s) {
  const hr2di_sky *sky = &sum->of->scene->sky;
  const double begin = atan2(s->right.y, s->right.x), end = begin + s->angle;
  for (size_t k = 0; k < sky->pieces; k++) {
    const double size = (sky->piece[k].to - sky->piece[k].from) * (HR2DI_PI / 180);
    const double first = (90 - sky->piece[k].to) * (HR2DI_PI / 180);
    const double turns = floor((begin - first) / (2 * HR2DI_PI));
    for (int turn = 0; turn < 3; turn++) {
      const double from = first + (turns + turn) * 2 * HR2DI_PI;
      const double low = fmax(from, begin), high = fmin(from + size, end);
      if (high > low) add_arc(sum, k, low, high - low);
    }
  }
}

void hr2di_light_add_sky(hr2di_light_sum *sum, hr2d_point right, hr2d_point left, double angle,
                         double bearing, double factor) {
  const hr2d_point vector = sum->flux ? between(right, left) : (hr2d_point){0, 0};
  sum->sky += factor * angle;
  for (size_t b = 0; b < sum->of->solution->bands; b++)
    add_constant(sum, b, factor * hr2d_scene_sky(sum->of->scene, bearing, b), angle, vector);
}

void hr2di_light_add(hr2di_light_sum *sum, const hr2di_polygon_arc *s) {
  const hr2di_light_source *of = sum->of;
  const size_t bands = of->solution->bands;
  if (s->patch != HR2DI_ROUND_SKY) {
    see_end(sum, s->right);
    see_end(sum, s->left);
  }
  if (s->patch == HR2DI_ROUND_BACK) {
    add_back(sum, s);
  } else if (s->patch == HR2DI_ROUND_SKY) {
    sum->sky += s->angle;
    const hr2d_point vector = sum->flux ? between(s->right, s->left) : (hr2d_point){0, 0};
    for (size_t b = 0; b < bands; b++)
      add_constant(sum, b,
                   of->has_gas ? of->solution->gas[2 * b] : hr2d_scene_background(of->scene, b),
                   s->angle, vector);
    add_pieces(sum, s);
    add_suns(sum, s);
  } else {
    sum->front += s->angle;
    const size_t patch = hr2di_scene_original(of->scene, s->patch);
    const int has_error = of->patch_error && patch < hr2di_scene_cell(of->scene);
    for (size_t b = 0; b < bands && has_error; b++)
      sum->error[b] += s->angle * of->patch_error[patch * bands + b];
    add_front(sum, s);
  }
}
