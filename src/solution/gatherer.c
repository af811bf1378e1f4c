/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A point of a patch sees parts of other patches, its visible intervals.  On the part of a leaf
   in a visible interval B_h is a polynomial; panels shrink towards the point, as those of near
   blocks do. The form factor of a visible interval is known to all digits.  The sum over panels
   may miss a part of it, because of roundings or because the point touches the patch.  That
   part is multiplied by B_h at the nearest point of the visible interval.

   Coordinates of points and of leaves are rounded.  Where B changes within a distance that is
   no more than many roundings, as beside the end of one of two plates that nearly touch, that
   would show: the vector from a point to a leaf is made from fractions of their patches, with
   twice the digits. */
#include "solution/gatherer.h"

#include <math.h>

#include "base/alloc.h"
#include "base/bickley.h"
#include "geometry/point-view-factor.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "hierarchy/hierarchy-impl.h"
#include "solution/panels.h"
#include "visibility/periodic-tail.h"

/* The error of a rule of n points is about ρ^−(2n − order); ρ = 3.19 on a panel that is just
   far enough.  At the largest order HR2DI_GATHER_POINTS points make 3.19^−32.  At lower orders,
   and on panels farther away, fewer points do.  One more point is taken: G is singular on the
   ellipse, so its coefficients are several times ρ^−k. */
static void set_rules(hr2di_gatherer *g) {
  const double near = HR2DI_NEAR_ELLIPSE, order = (double)g->solution->order;
  const double digits = 32 * log(near + sqrt(near * near - 1));
  for (size_t n = 1; n <= HR2DI_GATHER_POINTS; n++) {
    const double rate = 2 * (double)(n - 1) - order;
    g->rule[n - 1].points = 0;
    g->enough[n - 1] = rate > 0 ? cosh(digits / rate) : HUGE_VAL;
  }
  g->enough[HR2DI_GATHER_POINTS - 1] = 0;
}

static const hr2di_rule *rule_for(hr2di_gatherer *g, double ellipse) {
  size_t n = 1;
  while (g->enough[n - 1] > ellipse) n++;
  if (g->rule[n - 1].points == 0) hr2di_rule_init(&g->rule[n - 1], n);
  return &g->rule[n - 1];
}

/* A segment: the vector from x to its start, and that from its start to its end. */
typedef struct chord {
  hr2d_point from, along;
} chord;

/* At order 1 B is constant on a leaf: its part sends B times the form factor of a segment. */
static void add_constant(hr2di_gatherer *g, const chord *leaf, const double *coefficient,
                         hr2di_span part) {
  const double factor =
      hr2di_point_view_factor(g->normal, hr2di_block_along(leaf->from, leaf->along, part.from),
                              hr2di_block_along(leaf->from, leaf->along, part.to));
  g->factor += factor;
  for (size_t b = 0; b < g->solution->bands; b++) g->value[b] += factor * coefficient[b];
}

/* The depth of gas on a walk, in the bands of a scene. */
static double depth_of(const hr2d_scene *scene, hr2di_gas_walk walk) {
  double depth = 0;
  while (hr2di_gas_walk_next(&walk))
    depth += hr2di_scene_scaled_absorption(scene, walk.gas) * walk.piece;
  return depth;
}

/* Makes of g->place, which is B at a place that is seen, what of it arrives with what gases
   send on the way: T(x_n) B + Σ (D(x_k) − D(x_{k−1})) E_k. */
static void dim_group(hr2di_gatherer *g, size_t group, const hr2di_gas_walk *way) {
  const hr2d_scene *whole = g->solution->hierarchy->scene,
                   *scene = hr2di_band_group_scene(whole, group);
  const hr2d_section section = hr2di_scene_section(scene);
  const size_t bands = hr2di_band_group_size(whole, group);
  const double arrives = hr2di_passage_at(section, depth_of(scene, *way)).arrives;
  hr2di_gas_walk walk = *way;
  double depth = 0, before = 0;
  for (size_t m = 0; m < bands; m++) g->place[hr2di_band_group_at(whole, group, m)] *= arrives;
  while (hr2di_gas_walk_next(&walk)) {
    depth += hr2di_scene_scaled_absorption(scene, walk.gas) * walk.piece;
    const double absorbed = hr2di_passage_at(section, depth).absorbed;
    for (size_t m = 0; m < bands; m++) {
      const size_t b = hr2di_band_group_at(whole, group, m);
      g->place[b] += (absorbed - before) * *hr2di_solution_gas(g->solution, walk.gas, b);
    }
    before = absorbed;
  }
}

/* Adds the light of a place to which a vector leads, times a weight; g->place is B there. */
static void add_place(hr2di_gatherer *g, hr2d_point to, double weight) {
  const hr2d_scene *scene = g->solution->hierarchy->scene;
  const hr2di_gas_walk way = hr2di_gas_walk_from(scene, g->x, to);
  for (size_t k = 0; k < hr2di_band_groups(scene); k++) dim_group(g, k, &way);
  for (size_t b = 0; b < g->solution->bands; b++) g->value[b] += weight * g->place[b];
}

/* The light of a panel through gas, with the kernel at the points of a rule. */
static void add_through_gas(hr2di_gatherer *g, const chord *leaf, const double *xi,
                            const double *kernel, size_t points, const double *coefficient) {
  const size_t bands = g->solution->bands;
  for (size_t q = 0; q < points; q++) {
    const hr2d_point r = hr2di_block_along(leaf->from, leaf->along, 0.5 + 0.5 * xi[q]);
    for (size_t b = 0; b < bands; b++)
      g->place[b] = hr2di_basis_sum(&g->basis, xi[q], coefficient + b, bands);
    add_place(g, r, kernel[q]);
  }
}

/* Sums of a panel come first, so that few roundings add up. */
static void add_panel(hr2di_gatherer *g, const chord *leaf, hr2di_span panel,
                      const hr2di_rule *rule, const double *coefficient) {
  const hr2d_point from = leaf->from, along = leaf->along;
  const double size = panel.to - panel.from;
  const size_t bands = g->solution->bands, points = rule->points;
  double xi[HR2DI_GATHER_POINTS], kernel[HR2DI_GATHER_POINTS], factor = 0;
  if (hr2di_watch_work(g->watch, points * (1 + g->solution->order * bands / 16))) return;
  for (size_t q = 0; q < points; q++) {
    const double t = panel.from + size * (0.5 + 0.5 * rule->at[q]);
    const hr2d_point r = hr2di_block_along(from, along, t);
    const double square = r.x * r.x + r.y * r.y;
    const double cos_x = g->normal.x * r.x + g->normal.y * r.y;
    const double turn = r.x * along.y - r.y * along.x;
    xi[q] = 2 * t - 1;
    kernel[q] = 0; /* of x in a corner, and a panel no larger than rounding */
    if (square > 0)
      kernel[q] = 0.5 * size * rule->weight[q] * cos_x * turn / (square * sqrt(square));
    factor += kernel[q];
  }
  g->factor += factor;
  if (g->has_gas) add_through_gas(g, leaf, xi, kernel, points, coefficient);
  for (size_t b = 0; b < bands && !g->has_gas; b++) {
    double sum = 0;
    for (size_t q = 0; q < points; q++)
      sum += kernel[q] * hr2di_basis_sum(&g->basis, xi[q], coefficient + b, bands);
    g->value[b] += sum;
  }
}

/* Adds the light that a part of a leaf sends, behind the same borders of gas. */
static void add_part(hr2di_gatherer *g, const chord *leaf, const double *coefficient,
                     hr2di_span part) {
  hr2di_panels panels = {.count = 1};
  panels.stack[0] = part;
  while (panels.count > 0) {
    const hr2di_span panel = panels.stack[--panels.count];
    double ellipse = hr2di_panel_ellipse(leaf->from, leaf->along, panel);
    if (g->has_gas) {
      const int deep = hr2di_panel_is_deep(g->x, leaf->from, leaf->along, panel,
                                           g->solution->hierarchy->scene);
      if (deep && hr2di_panel_halved(&panels, panel)) continue;
      ellipse = fmin(ellipse, HR2DI_GAS_ELLIPSE);
    }
    if (ellipse < HR2DI_NEAR_ELLIPSE && hr2di_panel_halved(&panels, panel)) continue;
    add_panel(g, leaf, panel, rule_for(g, ellipse), coefficient);
  }
}

/* Adds the light that a part of a leaf sends. */
static void add_leaf(hr2di_gatherer *g, const chord *leaf, const double *coefficient,
                     hr2di_span part) {
  const hr2d_scene *scene = g->solution->hierarchy->scene;
  if (!(part.to > part.from)) return;
  if (g->solution->order == 1 && !g->has_gas) {
    add_constant(g, leaf, coefficient, part);
    return;
  }
  for (double from = part.from; from < part.to;) {
    const double to = hr2di_panel_cut(g->x, leaf->from, leaf->along, from, part.to, scene);
    add_part(g, leaf, coefficient, (hr2di_span){from, to});
    from = to;
  }
}

/* An element, and the part of its patch that it covers. */
typedef struct piece {
  uint32_t element;
  double from, to; /* fractions of the patch */
} piece;

enum { STACK = 128 };

/* The part of a patch that a leaf covers, as the point sees it. */
static chord chord_of(const hr2di_gatherer *g, hr2d_segment patch, const piece *p) {
  const hr2di_vector whole = hr2di_vector_difference(patch.b, patch.a);
  const hr2di_vector difference = hr2di_vector_difference(patch.a, g->base);
  const hr2di_vector start = hr2di_vector_minus(&difference, &g->offset);
  const hr2di_vector offset = hr2di_vector_times(&whole, p->from);
  const hr2di_vector from = hr2di_vector_plus(&start, &offset);
  const double size = p->to - p->from;
  return (chord){{from.x, from.y}, {whole.x * size, whole.y * size}};
}

/* Fractions of a patch have roundings of some 1e-15.  Beside a foot of another wall, where B
   jumps from leaf to leaf, the end of a visible interval may so reach the leaf behind the foot.
 */
#define ROUNDED 0x1p-49

/* A visible interval without what may be rounding at its ends: leaves that are outside are not
 * seen. */
static hr2di_span inside_of(const hr2di_visible_interval *seen) {
  const double end = fmin(ROUNDED, 0.25 * (seen->to - seen->from));
  return (hr2di_span){seen->from + end, seen->to - end};
}

/* Adds the light of the leaves of a visible interval. */
static void add_leaves(hr2di_gatherer *g, const hr2di_visible_interval *seen) {
  const hr2d_solution *s = g->solution;
  const hr2d_element *element = s->hierarchy->element;
  const hr2d_segment patch = s->hierarchy->scene->patch[seen->patch].scaled;
  const hr2di_span inside = inside_of(seen);
  piece stack[STACK];
  size_t count = 0;
  stack[count++] = (piece){seen->patch, 0, 1};
  while (count > 0) {
    const piece p = stack[--count];
    if (hr2di_watch_work(g->watch, 1)) return;
    const double size = p.to - p.from;
    if (p.to <= inside.from || p.from >= inside.to) continue;
    const uint32_t child = element[p.element].child;
    if (child && child < s->elements && count < STACK - 2) {
      const double middle = p.from + hr2di_element_left_part(element, p.element) * size;
      stack[count++] = (piece){child + 1, middle, p.to};
      stack[count++] = (piece){child, p.from, middle};
      continue;
    }
    const hr2di_span part = {seen->from > p.from ? (seen->from - p.from) / size : 0,
                             seen->to < p.to ? (seen->to - p.from) / size : 1};
    const chord leaf = chord_of(g, patch, &p);
    add_leaf(g, &leaf, s->value + p.element * s->order * s->bands, part);
  }
}

double hr2di_gatherer_nearest(const hr2di_gatherer *g, size_t patch, double from, double to,
                              double *distance) {
  const hr2di_patch *p = &hr2di_solution_scene(g->solution)->patch[patch];
  const hr2d_point a = p->scaled.a, along = hr2di_point_minus(p->scaled.b, a);
  const double t = hr2di_point_dot(hr2di_point_minus(g->x, a), along) / p->length / p->length;
  const double at = fmin(fmax(t, from), to);
  const hr2d_point d = hr2di_point_minus(g->x, hr2di_block_along(a, along, at));
  if (distance) *distance = hypot(d.x, d.y);
  return at;
}

/* Adds a visible interval: the light that panels resolve, and the rest from its nearest point.
   So roundings of the panels count only where B_h differs from that point's. */
static void add_one(hr2di_gatherer *g, const hr2di_visible_interval *seen) {
  g->factor = 0;
  add_leaves(g, seen);
  const double rest = seen->sine - g->factor;
  const hr2di_span inside = inside_of(seen);
  const double at = hr2di_gatherer_nearest(g, seen->patch, inside.from, inside.to, NULL);
  const hr2d_segment patch = hr2di_solution_scene(g->solution)->patch[seen->patch].scaled;
  const hr2d_point nearest = hr2di_point_minus(hr2di_point_at(patch, at), g->x);
  for (size_t b = 0; b < g->solution->bands; b++)
    g->place[b] = hr2d_solution_at(g->solution, seen->patch, at, b);
  if (g->has_gas) {
    add_place(g, nearest, rest);
    return;
  }
  for (size_t b = 0; b < g->solution->bands; b++) g->value[b] += rest * g->place[b];
}

/* Sets g->current to the light of a visible interval. */
static void set_one(hr2di_gatherer *g, const hr2di_visible_interval *seen) {
  double *value = g->value;
  g->value = g->current;
  for (size_t b = 0; b < g->solution->bands; b++) g->current[b] = 0;
  add_one(g, seen);
  g->value = value;
}

/* Images of a period may stand for those that are cut off as well. */
static void add_interval(hr2di_gatherer *g, const hr2di_visible_interval *seen) {
  const double weight =
      hr2di_periodic_tail_weight(hr2di_solution_scene(g->solution), seen->patch);
  if (weight == 1 || !g->past) {
    add_one(g, seen);
    return;
  }
  set_one(g, seen);
  for (size_t b = 0; b < g->solution->bands; b++) g->value[b] += weight * g->current[b];
}

/* It is measured from the nearer end, so that it is on the patch at both. */
void hr2di_gatherer_set_point(hr2di_gatherer *g, const hr2di_patch *p, double t) {
  const hr2d_segment s = p->scaled;
  const hr2d_point along = hr2di_point_minus(s.b, s.a);
  const hr2di_vector whole = hr2di_vector_difference(s.b, s.a);
  const double offset = t <= 0.5 ? t : t - 1;
  g->base = t <= 0.5 ? s.a : s.b;
  g->offset = hr2di_vector_times(&whole, offset);
  g->x = hr2di_block_along(g->base, along, offset);
  g->normal = (hr2d_point){-along.y / p->length, along.x / p->length};
}

/* Whether a visible interval is that of a patch at the edge of a wedge. */
static int is_at_edge(const hr2di_visible_interval *seen, const hr2di_edge *q) {
  return q && seen->patch == q->patch && seen->from <= q->at + q->step &&
         seen->to >= q->at - q->step;
}

/* Adds what the pieces of the sky send beyond the background. */
static void add_sky(hr2di_gatherer *g, size_t patch, const hr2di_view_from *seen) {
  const hr2d_scene *scene = hr2di_solution_scene(g->solution);
  const size_t terms = scene->sky.terms;
  for (size_t k = 0; k < scene->sky.pieces; k++) {
    hr2di_sky_front front;
    double factor[HR2DI_SKY_TERMS] = {0};
    hr2di_sky_front_of(scene, patch, k, &front);
    for (size_t m = 0; m < seen->arcs; m++)
      hr2di_sky_add_factors(&scene->sky, &front, seen->arc[m][0], seen->arc[m][1], factor);
    for (size_t l = 0; l < terms && factor[0] > 0; l++)
      for (size_t b = 0; b < g->solution->bands; b++)
        g->value[b] += factor[l] * hr2di_sky_beyond(scene, k * terms + l, b);
  }
}

/* Adds the sky past the ends of a period, by what shows of it at some bearings. */
static void add_far_sky(const hr2di_gatherer *g, const double *factor, const double *bearing,
                        double *value) {
  const hr2d_scene *scene = hr2di_solution_scene(g->solution);
  if (!g->past || !scene->effect[HR2D_EFFECT_BACKGROUND].on) return;
  for (int k = 0; k < HR2DI_SKIES; k++)
    for (size_t b = 0; b < g->solution->bands; b++)
      value[b] += factor[k] * hr2d_scene_sky(scene, bearing[k], b);
}

hr2d_status hr2di_gatherer_look_past(hr2di_gatherer *g, size_t patch, double t, double *past,
                                     double *ends) {
  const hr2d_scene *scene = hr2di_solution_scene(g->solution);
  const size_t bands = g->solution->bands;
  hr2di_view_from seen;
  hr2di_periodic_tail tail;
  const hr2d_status status = hr2di_view_at(g->viewer, patch, t, &seen);
  for (size_t k = 0; k < HR2DI_GATHER_PAST * bands; k++) past[k] = 0;
  *ends = 0;
  if (status) return status;
  hr2di_periodic_tail_of(scene, patch, t, &seen, &tail);
  *ends = tail.ends;
  g->past = tail.ends > 0;
  hr2di_gatherer_set_point(g, &scene->patch[patch], t);
  for (size_t m = 0; m < seen.count && g->past; m++) {
    const double *check = hr2di_periodic_tail_checks(scene, seen.interval[m].patch);
    const double more = hr2di_periodic_tail_weight(scene, seen.interval[m].patch) - 1;
    if (!check) continue;
    set_one(g, &seen.interval[m]);
    for (size_t b = 0; b < bands; b++) {
      for (int c = 0; c < HR2DI_TAIL_CHECKS; c++)
        past[(size_t)c * bands + b] += check[c] * g->current[b];
      past[HR2DI_TAIL_CHECKS * bands + b] += more * g->current[b];
    }
  }
  for (int c = 0; c < HR2DI_TAIL_CHECKS; c++)
    add_far_sky(g, tail.check[c], tail.bearing, past + (size_t)c * bands);
  add_far_sky(g, tail.sky, tail.bearing, past + HR2DI_TAIL_CHECKS * bands);
  return hr2di_watch_work(g->watch, 1 + seen.count / 16);
}

/* A form factor up to this cannot be told from rounding. */
#define NONE 1e-14

static int is_dark(const hr2d_solution *s, size_t band) {
  for (size_t k = band; k < s->elements * s->order * s->bands; k += s->bands)
    if (s->value[k] != 0) return 0;
  return 1;
}

/* The light of the background.  If all patches are dark, no patch that reflects sees it.  A
   form factor to it that is only rounding then counts as 0: it would be all the light there is.
 */
static double light_of_sky(const hr2di_gatherer *g, double factor, size_t band) {
  if (factor <= NONE && is_dark(g->solution, band)) return 0;
  return factor * hr2d_scene_background(hr2di_solution_scene(g->solution), band);
}

hr2d_status hr2di_gatherer_look(hr2di_gatherer *g, size_t patch, double t,
                                const hr2di_edge *without, double *irradiance, double *wedge,
                                double *others) {
  const hr2d_scene *scene = hr2di_solution_scene(g->solution);
  const int background = scene->effect[HR2D_EFFECT_BACKGROUND].on;
  hr2di_view_from seen;
  const hr2d_status status = hr2di_view_at(g->viewer, patch, t, &seen);
  if (status) return status;
  hr2di_periodic_tail tail;
  hr2di_periodic_tail_of(scene, patch, t, &seen, &tail);
  g->past = tail.ends > 0;
  hr2di_gatherer_set_point(g, &scene->patch[patch], t);
  g->value = irradiance;
  *wedge = 0;
  *others = seen.sky + seen.back;
  for (size_t b = 0; b < g->solution->bands; b++)
    g->value[b] =
        background ? light_of_sky(g, seen.sky, b) + hr2d_scene_sunlight_at(scene, patch, t, b)
                   : 0;
  /* Only one gas goes with an open scene. */
  for (size_t b = 0; b < g->solution->bands && g->has_gas; b++)
    if (hr2d_scene_absorption(scene, 0, b) > 0)
      g->value[b] += seen.sky * *hr2di_solution_gas(g->solution, 0, b);
  add_sky(g, patch, &seen);
  add_far_sky(g, tail.sky, tail.bearing, g->value);
  for (size_t k = 0; k < seen.count; k++) {
    const int at_edge = is_at_edge(&seen.interval[k], without);
    *(at_edge ? wedge : others) += seen.interval[k].sine;
    if (!at_edge) add_interval(g, &seen.interval[k]);
  }
  /* Light is never negative; polynomials may be beside a shadow. */
  for (size_t b = 0; b < g->solution->bands; b++) g->value[b] = fmax(g->value[b], 0);
  return hr2di_watch_work(g->watch, seen.count / 16);
}

hr2d_status hr2di_gatherer_init(hr2di_gatherer *g, const hr2d_solution *solution,
                                hr2di_watch *watch) {
  *g = (hr2di_gatherer){.solution = solution, .watch = watch};
  g->edge = hr2di_alloc(&solution->alloc, solution->bands,
                        (4 + HR2DI_SURFACE_ARRAYS) * sizeof *g->edge);
  if (!g->edge) return HR2D_ENOMEM;
  g->far = g->edge + solution->bands;
  g->current = g->far + solution->bands;
  g->place = g->current + solution->bands;
  g->surface = g->place + solution->bands;
  g->has_gas = hr2di_scene_has_gas(solution->hierarchy->scene);
  hr2di_basis_init(&g->basis, solution->order);
  set_rules(g);
  return hr2di_point_viewer_create(hr2di_solution_scene(solution), &solution->alloc, watch,
                                   &g->viewer);
}

void hr2di_gatherer_clear(hr2di_gatherer *g) {
  hr2di_point_viewer_destroy(g->viewer);
  hr2di_alloc_free(&g->solution->alloc, g->edge);
}
