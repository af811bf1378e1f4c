/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "field/light.h"

#include <math.h>

#include "base/pi.h"
#include "field/light-in-gas.h"

/* The vector from x to a fraction of a patch, from the end of the patch that is nearer. */
static hr2d_point to_place(hr2d_point x, hr2d_segment at, double fraction) {
  const hr2d_point along = hr2di_point_minus(at.b, at.a);
  return fraction <= 0.5 ? hr2di_block_along(hr2di_point_minus(at.a, x), along, fraction)
                         : hr2di_block_along(hr2di_point_minus(at.b, x), along, fraction - 1);
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
  const double angle = hr2di_light_angle(right, left);
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

static hr2di_strip strip_of(const hr2di_light_sum *sum, const seen_patch *p,
                            const seen_element *e) {
  const hr2di_light_source *of = sum->of;
  const double size = e->to - e->from;
  return (hr2di_strip){.from = to_place(sum->x, p->at, e->from),
                       .along = {size * p->whole.x, size * p->whole.y},
                       .coefficient = of->leaves.value +
                                      e->element * of->leaves.order * of->solution->bands};
}

static void add_far_part(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span part,
                         const hr2di_rule *rule) {
  if (sum->of->has_gas)
    hr2di_light_add_far_in_gas(sum, s, part, rule);
  else
    hr2di_strip_add_panel(sum, s, part, rule, 1);
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
      const hr2di_strip s = strip_of(sum, p, e);
      const hr2di_rule *rule = hr2di_strip_far_rule(of, e->element, &s, (hr2di_span){0, 1});
      if (rule) add_far_part(sum, &s, (hr2di_span){0, 1}, rule);
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
  const hr2di_strip s = strip_of(sum, p, e);
  const hr2d_point to = hr2di_block_along(s.from, s.along, 1);
  const double near = (sqrt(hr2di_point_dot(s.from, s.from)) + sqrt(hr2di_point_dot(to, to)) -
                       sqrt(hr2di_point_dot(s.along, s.along))) /
                      2;
  see_end(sum, (hr2d_point){near, 0});
}

/* A back sends nothing, but gas in front of it does. */
static void add_back(hr2di_light_sum *sum, const hr2di_polygon_arc *s) {
  const hr2di_strip back = {.from = s->right, .along = hr2di_point_minus(s->left, s->right)};
  sum->back += s->angle;
  if (sum->of->has_gas)
    hr2di_light_add_in_gas(sum, &back, (hr2di_span){0, 1}, s->angle,
                           hr2di_light_vector(s->right, s->left));
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
  hr2di_strip s = strip_of(sum, p, &e);
  s.varies = leaf->varies;
  const hr2di_rule *rule = hr2di_strip_far_rule(of, leaf->element, &s, part);
  if (rule)
    add_far_part(sum, &s, part, rule);
  else if (of->has_gas)
    hr2di_light_add_in_gas(sum, &s, part, hr2di_light_angle(right, left),
                           hr2di_light_vector(right, left));
  else
    hr2di_strip_add_near(sum, &s, part, right, left, angle);
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
  return hr2di_point_unit((hr2d_point){-sun.direction.x, -sun.direction.y});
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
  hr2di_light_add_constant(sum, band, 2 * sun.irradiance, 1, to_sun(sun));
}

static void add_suns(hr2di_light_sum *sum, const hr2di_polygon_arc *s) {
  for (size_t b = 0; b < sum->of->solution->bands; b++)
    if (hr2di_light_has_sun(sum->of, s->right, s->left, b)) hr2di_light_add_sun(sum, b);
}

/* The same, where the light is a polynomial of the bearing: at the nodes of a rule. */
static void add_varying_arc(hr2di_light_sum *sum, size_t piece, double from, double angle) {
  const hr2d_scene *scene = sum->of->scene;
  const hr2d_sky_piece *p = &scene->sky.piece[piece];
  const size_t terms = scene->sky.terms;
  const hr2di_sky_terms *of = &scene->sky.of;
  for (size_t q = 0; q < of->rule.points; q++) {
    const double at = from + 0.5 * angle * (1 + of->rule.at[q]),
                 part = of->rule.weight[q] * angle;
    const double off = remainder(90 - at * (180 / HR2DI_PI) - 0.5 * (p->from + p->to), 360);
    double phi[HR2DI_SKY_TERMS];
    hr2di_basis_at(&of->basis, 2 * off / (p->to - p->from), phi);
    for (size_t b = 0; b < sum->of->solution->bands; b++) {
      double value = 0;
      for (size_t l = 0; l < terms; l++)
        value += phi[l] * hr2di_sky_beyond(scene, piece * terms + l, b);
      hr2di_light_add_constant(sum, b, value, part,
                               (hr2d_point){part * cos(at), part * sin(at)});
    }
  }
}

/* Adds an arc of the sky from an angle on, counterclockwise from +x. */
static void add_arc(hr2di_light_sum *sum, size_t piece, double from, double angle) {
  const hr2d_scene *scene = sum->of->scene;
  if (hr2di_sky_is_continuous(&scene->sky)) {
    add_varying_arc(sum, piece, from, angle);
    return;
  }
  const hr2d_point right = {cos(from), sin(from)},
                   left = {cos(from + angle), sin(from + angle)};
  const hr2d_point vector = sum->flux ? hr2di_light_vector(right, left) : (hr2d_point){0, 0};
  for (size_t b = 0; b < sum->of->solution->bands; b++)
    hr2di_light_add_constant(sum, b, hr2di_sky_beyond(scene, piece, b), angle, vector);
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

double hr2di_light_sky(const hr2di_light_source *of, size_t band) {
  const size_t gas = hr2di_scene_gas_around(of->scene);
  return gas != HR2DI_NO_GAS && hr2d_scene_absorption(of->scene, gas, band) > 0
             ? *hr2di_solution_gas(of->solution, gas, band)
             : hr2d_scene_background(of->scene, band);
}

void hr2di_light_add_sky(hr2di_light_sum *sum, hr2d_point right, hr2d_point left, double angle,
                         double bearing, double factor) {
  const hr2d_point vector = sum->flux ? hr2di_light_vector(right, left) : (hr2d_point){0, 0};
  sum->sky += factor * angle;
  for (size_t b = 0; b < sum->of->solution->bands; b++)
    hr2di_light_add_constant(sum, b, factor * hr2d_scene_sky(sum->of->scene, bearing, b), angle,
                             vector);
}

void hr2di_light_add(hr2di_light_sum *sum, const hr2di_polygon_arc *s) {
  const hr2di_light_source *of = sum->of;
  const size_t bands = of->solution->bands;
  for (size_t b = 0; b < bands && of->gas_error; b++)
    sum->error[b] += s->angle * of->gas_error[b];
  if (s->patch != HR2DI_ROUND_SKY) {
    see_end(sum, s->right);
    see_end(sum, s->left);
  }
  if (s->patch == HR2DI_ROUND_BACK) {
    add_back(sum, s);
  } else if (s->patch == HR2DI_ROUND_SKY) {
    sum->sky += s->angle;
    const hr2d_point vector =
        sum->flux ? hr2di_light_vector(s->right, s->left) : (hr2d_point){0, 0};
    for (size_t b = 0; b < bands; b++)
      hr2di_light_add_constant(sum, b, hr2di_light_sky(of, b), s->angle, vector);
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
