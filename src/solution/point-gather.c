/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One more gather at single points: H' = ∫ G V B_h with G and V exact, and B' = E + ρH'.

   A point of a patch sees parts of other patches, its glimpses.  On the part of a leaf in a
   glimpse B_h is a polynomial; panels shrink towards the point, as those of near blocks do. The
   form factor of a glimpse is known to all digits.  Its share that no panel resolves, by
   rounding or since the point touches the patch, gets the B_h of the nearest point of the
   glimpse.

   Coordinates of points and of leaves are rounded.  Where B changes within a distance that is
   no more than many roundings, as beside the end of one of two plates that nearly touch, that
   would show: the vector from a point to a leaf is made from fractions of their patches, with
   twice the digits.

   A point that touches another patch has the limit from the inside of its own patch.  There the
   two patches p and q form a wedge, and see each other under k = ½(1 + cos α) of all directions
   whatever the distance from its edge.  With the irradiance r from everything else the limits
   of B solve
     b_p = E_p + ρ_p (k b_q + r_p),   b_q = E_q + ρ_q (k b_p + r_q). */
#include <math.h>

#include "base/alloc.h"
#include "blocks/line-vector.h"
#include "geometry/point-view-factor.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "solution/panels.h"
#include "solution/solution-impl.h"
#include "visibility/point-view.h"
#include "visibility/view-tail.h"

/* A rule of n points is accurate to ρ^−(2n − order), on a panel that is just far enough to
   3.19^−(2n − order).  At the largest order POINTS make 3.19^−32 of that; at lower ones, and on
   panels that are farther away, fewer points do.  One more is taken, as G is singular on the
   ellipse, so that its coefficients are some times ρ^−k. */
enum { POINTS = 32, STACK = 128 };

/* The limits at the edge of a wedge are found from points so far beside it.  Roundings of the
   coordinates of a foot do not matter there. */
#define BESIDE 0x1p-46

typedef struct gatherer {
  const hr2d_solution *solution;
  hr2di_viewer *viewer;
  hr2di_watch *watch;
  hr2di_basis basis;
  hr2di_rule rule[POINTS]; /* of 1, 2, … points; none yet where there are 0 */
  double enough[POINTS];   /* the least ellipse for which they are enough */
  hr2d_point x, normal;
  hr2d_point base;  /* the end of its patch that is nearer to x */
  hr2di_vector way; /* from there to x */
  double *value;    /* per band: H */
  double factor;    /* the form factor that panels have found of the glimpse under way */
  double *edge;     /* per band: the irradiance of the other patch of a wedge */
  double *far;      /* per band: the irradiance at the farther one of two points */
  double *one;      /* per band: that from one glimpse */
  int past;         /* the point sees what is past the ends of a period */
} gatherer;

/* A patch that touches the point, as one side of a wedge. */
typedef struct edge {
  size_t patch;
  double at, step; /* fraction of the patch where the edge is, and how exactly that is known */
  double inside;   /* 1 if that is ahead along the patch, −1 if behind */
} edge;

static void set_rules(gatherer *g) {
  const double near = HR2DI_NEAR_ELLIPSE, order = (double)g->solution->order;
  const double digits = 32 * log(near + sqrt(near * near - 1));
  for (size_t n = 1; n <= POINTS; n++) {
    const double rate = 2 * (double)(n - 1) - order;
    g->rule[n - 1].points = 0;
    g->enough[n - 1] = rate > 0 ? cosh(digits / rate) : HUGE_VAL;
  }
  g->enough[POINTS - 1] = 0;
}

static const hr2di_rule *rule_for(gatherer *g, double ellipse) {
  size_t n = 1;
  while (g->enough[n - 1] > ellipse) n++;
  if (g->rule[n - 1].points == 0) hr2di_rule_init(&g->rule[n - 1], n);
  return &g->rule[n - 1];
}

/* A segment: the vector from x to its start, and its own. */
typedef struct stretch {
  hr2d_point from, along;
} stretch;

/* At order 1 B is constant on a leaf: its part sends B times the form factor of a segment. */
static void add_constant(gatherer *g, const stretch *leaf, const double *coefficient,
                         hr2di_span part) {
  const double factor =
      hr2di_point_view_factor(g->normal, hr2di_block_along(leaf->from, leaf->along, part.from),
                              hr2di_block_along(leaf->from, leaf->along, part.to));
  g->factor += factor;
  for (size_t b = 0; b < g->solution->bands; b++) g->value[b] += factor * coefficient[b];
}

/* Sums of a panel come first, so that few roundings add up. */
static void add_panel(gatherer *g, const stretch *leaf, hr2di_span panel,
                      const hr2di_rule *rule, const double *coefficient) {
  const hr2d_point from = leaf->from, along = leaf->along;
  const double size = panel.to - panel.from;
  const size_t bands = g->solution->bands, points = rule->points;
  double xi[POINTS], kernel[POINTS], factor = 0;
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
  for (size_t b = 0; b < bands; b++) {
    double sum = 0;
    for (size_t q = 0; q < points; q++)
      sum += kernel[q] * hr2di_basis_sum(&g->basis, xi[q], coefficient + b, bands);
    g->value[b] += sum;
  }
}

/* Adds the light that a part of a leaf sends. */
static void add_leaf(gatherer *g, const stretch *leaf, const double *coefficient,
                     hr2di_span part) {
  hr2di_panels panels = {.count = 1};
  if (!(part.to > part.from)) return;
  if (g->solution->order == 1) {
    add_constant(g, leaf, coefficient, part);
    return;
  }
  panels.stack[0] = part;
  while (panels.count > 0) {
    const hr2di_span panel = panels.stack[--panels.count];
    const double ellipse = hr2di_panel_ellipse(leaf->from, leaf->along, panel);
    if (ellipse < HR2DI_NEAR_ELLIPSE && hr2di_panel_halved(&panels, panel)) continue;
    add_panel(g, leaf, panel, rule_for(g, ellipse), coefficient);
  }
}

/* An element, and the part of its patch that it covers. */
typedef struct piece {
  uint32_t element;
  double from, to; /* fractions of the patch */
} piece;

/* The part of a patch that a leaf covers, as the point sees it. */
static stretch stretch_of(const gatherer *g, hr2d_segment patch, const piece *p) {
  const hr2di_vector whole = hr2di_vector_difference(patch.b, patch.a);
  const hr2di_vector apart = hr2di_vector_difference(patch.a, g->base);
  const hr2di_vector start = hr2di_vector_minus(&apart, &g->way);
  const hr2di_vector offset = hr2di_vector_times(&whole, p->from);
  const hr2di_vector from = hr2di_vector_plus(&start, &offset);
  const double size = p->to - p->from;
  return (stretch){{from.x, from.y}, {whole.x * size, whole.y * size}};
}

/* Adds the light of the leaves of a glimpse. */
static void add_leaves(gatherer *g, const hr2di_glimpse *seen) {
  const hr2d_solution *s = g->solution;
  const hr2d_element *element = s->hierarchy->element;
  const hr2d_segment patch = s->hierarchy->scene->patch[seen->patch].scaled;
  piece stack[STACK];
  size_t count = 0;
  stack[count++] = (piece){seen->patch, 0, 1};
  while (count > 0) {
    const piece p = stack[--count];
    if (hr2di_watch_work(g->watch, 1)) return;
    const double size = p.to - p.from;
    if (p.to <= seen->from || p.from >= seen->to) continue;
    const uint32_t child = element[p.element].child;
    if (child && child < s->elements && count < STACK - 2) {
      const double middle = p.from + hr2di_element_left_part(element, p.element) * size;
      stack[count++] = (piece){child + 1, middle, p.to};
      stack[count++] = (piece){child, p.from, middle};
      continue;
    }
    const hr2di_span part = {seen->from > p.from ? (seen->from - p.from) / size : 0,
                             seen->to < p.to ? (seen->to - p.from) / size : 1};
    const stretch leaf = stretch_of(g, patch, &p);
    add_leaf(g, &leaf, s->value + p.element * s->order * s->bands, part);
  }
}

/* Where a patch is nearest to the point, as a fraction of it within a range; *distance may be
   NULL. */
static double nearest(const gatherer *g, size_t patch, double from, double to,
                      double *distance) {
  const hr2di_patch *p = &g->solution->hierarchy->scene->patch[patch];
  const hr2d_point a = p->scaled.a, along = hr2di_point_minus(p->scaled.b, a);
  const double t = hr2di_point_dot(hr2di_point_minus(g->x, a), along) / p->length / p->length;
  const double at = fmin(fmax(t, from), to);
  const hr2d_point d = hr2di_point_minus(g->x, hr2di_block_along(a, along, at));
  if (distance) *distance = hypot(d.x, d.y);
  return at;
}

/* Adds a glimpse: the light that panels resolve, and the rest from its nearest point.  So
   roundings of the panels count only where B_h differs from that point's. */
static void add_one(gatherer *g, const hr2di_glimpse *seen) {
  g->factor = 0;
  add_leaves(g, seen);
  const double rest = seen->sine - g->factor;
  const double at = nearest(g, seen->patch, seen->from, seen->to, NULL);
  for (size_t b = 0; b < g->solution->bands; b++)
    g->value[b] += rest * hr2d_solution_at(g->solution, seen->patch, at, b);
}

/* Sets g->one to the light of a glimpse. */
static void set_one(gatherer *g, const hr2di_glimpse *seen) {
  double *value = g->value;
  g->value = g->one;
  for (size_t b = 0; b < g->solution->bands; b++) g->one[b] = 0;
  add_one(g, seen);
  g->value = value;
}

/* Images of a period may stand for those that are cut off as well. */
static void add_glimpse(gatherer *g, const hr2di_glimpse *seen) {
  const double weight = hr2di_view_tail_weight(g->solution->hierarchy->scene, seen->patch);
  if (weight == 1 || !g->past) {
    add_one(g, seen);
    return;
  }
  set_one(g, seen);
  for (size_t b = 0; b < g->solution->bands; b++) g->value[b] += weight * g->one[b];
}

/* Sets the point at fraction t of a patch, measured from the nearer end, so that it is on the
   patch at both. */
static void set_point(gatherer *g, const hr2di_patch *p, double t) {
  const hr2d_segment s = p->scaled;
  const hr2d_point along = hr2di_point_minus(s.b, s.a);
  const hr2di_vector whole = hr2di_vector_difference(s.b, s.a);
  const double way = t <= 0.5 ? t : t - 1;
  g->base = t <= 0.5 ? s.a : s.b;
  g->way = hr2di_vector_times(&whole, way);
  g->x = hr2di_block_along(g->base, along, way);
  g->normal = (hr2d_point){-along.y / p->length, along.x / p->length};
}

/* Whether a glimpse is that of a patch at the edge of a wedge. */
static int is_at_edge(const hr2di_glimpse *seen, const edge *q) {
  return q && seen->patch == q->patch && seen->from <= q->at + q->step &&
         seen->to >= q->at - q->step;
}

/* Adds what the pieces of the sky send beyond the background. */
static void add_sky(gatherer *g, size_t patch, const hr2di_view_from *seen) {
  const hr2d_scene *scene = g->solution->hierarchy->scene;
  for (size_t k = 0; k < scene->sky.pieces; k++) {
    hr2di_sines part[2];
    const int parts = hr2di_sky_front(scene, patch, k, part);
    double factor = 0;
    for (size_t m = 0; m < seen->arcs; m++)
      factor += hr2di_sky_factor(part, parts, seen->arc[m][0], seen->arc[m][1]);
    for (size_t b = 0; b < g->solution->bands && factor > 0; b++)
      g->value[b] += factor * hr2di_sky_beyond(scene, k, b);
  }
}

/* Adds the sky past the ends of a period, by what shows of it at some bearings. */
static void add_far_sky(const gatherer *g, const double *factor, const double *bearing,
                        double *value) {
  const hr2d_scene *scene = g->solution->hierarchy->scene;
  if (!g->past || !scene->effect[HR2D_EFFECT_BACKGROUND].on) return;
  for (int k = 0; k < HR2DI_SKIES; k++)
    for (size_t b = 0; b < g->solution->bands; b++)
      value[b] += factor[k] * hr2d_scene_sky(scene, bearing[k], b);
}

/* What a point sees past the ends of a period, see hr2di_solution_gather_past(). */
static hr2d_status look_past(gatherer *g, size_t patch, double t, double *past, double *ends) {
  const hr2d_scene *scene = g->solution->hierarchy->scene;
  const size_t bands = g->solution->bands;
  hr2di_view_from seen;
  hr2di_view_tail tail;
  const hr2d_status status = hr2di_view_at(g->viewer, patch, t, &seen);
  for (size_t k = 0; k < HR2DI_GATHER_PAST * bands; k++) past[k] = 0;
  *ends = 0;
  if (status) return status;
  hr2di_view_tail_of(scene, patch, t, &seen, &tail);
  *ends = tail.ends;
  g->past = tail.ends > 0;
  set_point(g, &scene->patch[patch], t);
  for (size_t m = 0; m < seen.count && g->past; m++) {
    const double *check = hr2di_view_tail_checks(scene, seen.glimpse[m].patch);
    const double more = hr2di_view_tail_weight(scene, seen.glimpse[m].patch) - 1;
    if (!check) continue;
    set_one(g, &seen.glimpse[m]);
    for (size_t b = 0; b < bands; b++) {
      for (int c = 0; c < HR2DI_TAIL_CHECKS; c++)
        past[(size_t)c * bands + b] += check[c] * g->one[b];
      past[HR2DI_TAIL_CHECKS * bands + b] += more * g->one[b];
    }
  }
  for (int c = 0; c < HR2DI_TAIL_CHECKS; c++)
    add_far_sky(g, tail.check[c], tail.bearing, past + (size_t)c * bands);
  add_far_sky(g, tail.sky, tail.bearing, past + HR2DI_TAIL_CHECKS * bands);
  return hr2di_watch_work(g->watch, 1 + seen.count / 16);
}

/* Sets the irradiance from everything but the patch that makes a wedge, which may be NULL.
 *wedge is the form factor of that patch, and *others that of everything else. */
static hr2d_status look(gatherer *g, size_t patch, double t, const edge *without,
                        double *irradiance, double *wedge, double *others) {
  const hr2d_scene *scene = g->solution->hierarchy->scene;
  const int background = scene->effect[HR2D_EFFECT_BACKGROUND].on;
  hr2di_view_from seen;
  const hr2d_status status = hr2di_view_at(g->viewer, patch, t, &seen);
  if (status) return status;
  hr2di_view_tail tail;
  hr2di_view_tail_of(scene, patch, t, &seen, &tail);
  g->past = tail.ends > 0;
  set_point(g, &scene->patch[patch], t);
  g->value = irradiance;
  *wedge = 0;
  *others = seen.sky + seen.back;
  for (size_t b = 0; b < g->solution->bands; b++)
    g->value[b] = background ? seen.sky * hr2d_scene_background(scene, b) +
                                   hr2d_scene_sunlight_at(scene, patch, t, b)
                             : 0;
  add_sky(g, patch, &seen);
  add_far_sky(g, tail.sky, tail.bearing, g->value);
  for (size_t k = 0; k < seen.count; k++) {
    const int at_edge = is_at_edge(&seen.glimpse[k], without);
    *(at_edge ? wedge : others) += seen.glimpse[k].sine;
    if (!at_edge) add_glimpse(g, &seen.glimpse[k]);
  }
  /* Light is never negative; polynomials may be beside a shadow. */
  for (size_t b = 0; b < g->solution->bands; b++) g->value[b] = fmax(g->value[b], 0);
  return hr2di_watch_work(g->watch, seen.count / 16);
}

/* The point of a patch at the edge of a wedge, with the inside of the patch on the given side
   if both are. */
static edge edge_of(const gatherer *g, size_t patch, double at, double side) {
  const double step = BESIDE / g->solution->hierarchy->scene->patch[patch].length;
  const double inside = at <= step ? 1 : at >= 1 - step ? -1 : side;
  return (edge){patch, at, 8 * step, inside};
}

/* The unit vector along a patch, from the edge to the point beside it. */
static hr2d_point direction_of(const gatherer *g, const edge *e) {
  const hr2di_patch *p = &g->solution->hierarchy->scene->patch[e->patch];
  const hr2d_point along = hr2di_point_minus(p->scaled.b, p->scaled.a);
  return (hr2d_point){e->inside * along.x / p->length, e->inside * along.y / p->length};
}

/* A place so many steps beside an edge. */
static double beside(const gatherer *g, const edge *e, double steps) {
  const double step = steps * BESIDE / g->solution->hierarchy->scene->patch[e->patch].length;
  return fmin(fmax(e->at + e->inside * step, 0), 1);
}

/* The form factor of an edge is k = ½(1 + cos α) = ¼|u + w|², and that of everything else
   1 − k = ¼|u − w|².  A view from beside the edge has neither exactly: irradiances from
   everything else are scaled by the right one. */
static hr2d_status look_beside(gatherer *g, const edge *p, const edge *q, double steps,
                               double right, double *irradiance, int *sees) {
  double wedge, others;
  const hr2d_status status =
      look(g, p->patch, beside(g, p, steps), q, irradiance, &wedge, &others);
  *sees = !status && wedge > 0;
  for (size_t b = 0; b < g->solution->bands && !status; b++)
    irradiance[b] *= others > 0 ? right / others : 0;
  return status;
}

/* The irradiance from everything but the other patch at the edge of a wedge: 2H(x) − H(2x),
   which differs from the limit by O(x²). */
static hr2d_status look_at_edge(gatherer *g, const edge *p, const edge *q, double right,
                                double *irradiance, int *sees) {
  hr2d_status status = look_beside(g, p, q, 2, right, g->far, sees);
  if (!status && *sees) status = look_beside(g, p, q, 1, right, irradiance, sees);
  for (size_t b = 0; b < g->solution->bands && !status && *sees; b++)
    irradiance[b] = fmax(2 * irradiance[b] - g->far[b], 0);
  return status;
}

/* The irradiance at the edge of the wedge that two patches make; *closed is 0 if they do not
   see each other beside it. */
static hr2d_status close_wedge(gatherer *g, const edge *p, const edge *q, double *irradiance,
                               int *closed) {
  const hr2d_scene *scene = hr2di_solution_scene(g->solution);
  const hr2d_point u = direction_of(g, p), w = direction_of(g, q);
  const hr2d_point sum = {u.x + w.x, u.y + w.y}, apart = hr2di_point_minus(u, w);
  const double k = 0.25 * hr2di_point_dot(sum, sum),
               rest = 0.25 * hr2di_point_dot(apart, apart);
  hr2d_status status = look_at_edge(g, p, q, rest, irradiance, closed);
  if (!status && *closed) status = look_at_edge(g, q, p, rest, g->edge, closed);
  if (status || !*closed) return status;
  for (size_t b = 0; b < g->solution->bands; b++) {
    const double rho_p = hr2d_scene_reflectance(scene, p->patch, b);
    const double rho_q = hr2d_scene_reflectance(scene, q->patch, b);
    const double alone_p = hr2d_scene_emission(scene, p->patch, b) + rho_p * irradiance[b];
    const double alone_q = hr2d_scene_emission(scene, q->patch, b) + rho_q * g->edge[b];
    irradiance[b] += k * (alone_q + rho_q * k * alone_p) / (1 - rho_p * rho_q * k * k);
  }
  return HR2D_OK;
}

/* Where a patch has an edge in common with that at p, and shows its front beside it. */
static int makes_wedge(const gatherer *g, size_t patch, edge *q) {
  const hr2d_segment s = g->solution->hierarchy->scene->patch[patch].scaled;
  const double rises = hr2di_point_dot(hr2di_point_minus(s.b, s.a), g->normal);
  double distance;
  const double at = nearest(g, patch, 0, 1, &distance);
  if (distance > HR2DI_TOUCH) return 0;
  *q = edge_of(g, patch, at, rises > 0 ? 1 : -1);
  return q->inside * rises > 0;
}

/* The first patch from *k on that makes a wedge with the point's own one; its number is left in
 *k, or that of patches if there is none.  It is seen from where limits are found. */
static hr2d_status next_wedge(gatherer *g, const edge *p, size_t *k, edge *q) {
  const hr2d_scene *scene = g->solution->hierarchy->scene;
  hr2di_view_from seen;
  const hr2d_status status = hr2di_view_at(g->viewer, p->patch, beside(g, p, 2), &seen);
  if (status) return status;
  set_point(g, &scene->patch[p->patch], p->at);
  for (size_t m = 0; m < seen.count; m++) {
    const size_t patch = seen.glimpse[m].patch;
    if (patch < *k || (m > 0 && patch == seen.glimpse[m - 1].patch)) continue;
    if (!makes_wedge(g, patch, q)) continue;
    *k = patch;
    return hr2di_watch_work(g->watch, seen.count / 8);
  }
  *k = scene->patches;
  return hr2di_watch_work(g->watch, seen.count / 8);
}

/* Looks for a patch that makes a wedge with the point's own one, and closes it. */
static hr2d_status find_wedge(gatherer *g, size_t patch, double t, double *irradiance,
                              int *closed) {
  const hr2d_scene *scene = g->solution->hierarchy->scene;
  const edge p = edge_of(g, patch, t, t <= 0.5 ? 1 : -1);
  edge q;
  hr2d_status status = HR2D_OK;
  *closed = 0;
  for (size_t k = 0; k < scene->patches && !*closed && !status; k++) {
    status = next_wedge(g, &p, &k, &q);
    if (!status && k < scene->patches) status = close_wedge(g, &p, &q, irradiance, closed);
  }
  return status;
}

static hr2d_status gather_at(gatherer *g, size_t patch, double t, double *irradiance) {
  double wedge, others;
  int closed;
  const double step = HR2DI_TOUCH / g->solution->hierarchy->scene->patch[patch].length;
  const double at = t <= step ? 0 : t >= 1 - step ? 1 : t;
  const hr2d_status status = find_wedge(g, patch, at, irradiance, &closed);
  return status || closed ? status : look(g, patch, t, NULL, irradiance, &wedge, &others);
}

static hr2d_status begin(gatherer *g, const hr2d_solution *solution, hr2di_watch *watch) {
  *g = (gatherer){.solution = solution, .watch = watch};
  g->edge = hr2di_alloc(&solution->alloc, solution->bands, 3 * sizeof *g->edge);
  if (!g->edge) return HR2D_ENOMEM;
  g->far = g->edge + solution->bands;
  g->one = g->far + solution->bands;
  hr2di_basis_init(&g->basis, solution->order);
  set_rules(g);
  return hr2di_viewer_create(solution->hierarchy->scene, &solution->alloc, watch, &g->viewer);
}

static void end(gatherer *g) {
  hr2di_viewer_destroy(g->viewer);
  hr2di_alloc_free(&g->solution->alloc, g->edge);
}

static hr2d_status gather_irradiance(const hr2d_solution *solution, size_t patch,
                                     const double *t, size_t count, double *value,
                                     hr2di_watch *watch) {
  gatherer g;
  hr2d_status status = begin(&g, solution, watch);
  for (size_t k = 0; k < count && !status; k++) {
    if (watch) watch->told.fraction = (double)k / (double)count;
    status = gather_at(&g, patch, t[k], value + k * solution->bands);
  }
  end(&g);
  return status;
}

hr2d_status hr2di_solution_gather_past(const hr2d_solution *solution, size_t patch,
                                       const double *t, size_t count, double *past,
                                       double *ends, hr2di_watch *watch) {
  gatherer g;
  hr2d_status status = begin(&g, solution, watch);
  for (size_t k = 0; k < count && !status; k++)
    status =
        look_past(&g, patch, t[k], past + k * HR2DI_GATHER_PAST * solution->bands, ends + k);
  end(&g);
  return status;
}

hr2d_status hr2di_solution_gather(const hr2d_solution *solution, size_t patch, const double *t,
                                  size_t count, double *value, hr2di_watch *watch) {
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  const hr2d_status status = gather_irradiance(solution, patch, t, count, value, watch);
  for (size_t k = 0; k < count * solution->bands && !status; k++) {
    const size_t band = k % solution->bands;
    value[k] = hr2d_scene_emission(scene, patch, band) +
               hr2d_scene_reflectance(scene, patch, band) * value[k];
  }
  return status;
}

/* The callback of the scene is asked between the points. */
static void watch_gather(const hr2d_solution *solution, hr2di_watch *watch) {
  hr2di_scene_watch(solution->hierarchy->scene, watch, NULL, NULL, "gather");
}

hr2d_status hr2d_solution_gather(const hr2d_solution *solution, size_t patch, const double *t,
                                 size_t count, double *value) {
  hr2di_watch watch;
  watch_gather(solution, &watch);
  return hr2di_solution_gather(solution, patch, t, count, value, &watch);
}

hr2d_status hr2d_solution_gather_irradiance(const hr2d_solution *solution, size_t patch,
                                            const double *t, size_t count, double *value) {
  hr2di_watch watch;
  watch_gather(solution, &watch);
  return gather_irradiance(solution, patch, t, count, value, &watch);
}

hr2d_status hr2d_solution_gather_net_flux(const hr2d_solution *solution, size_t patch,
                                          const double *t, size_t count, double *value) {
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  const hr2d_status status = hr2d_solution_gather_irradiance(solution, patch, t, count, value);
  for (size_t k = 0; k < count * solution->bands && !status; k++) {
    const size_t band = k % solution->bands;
    value[k] = hr2d_scene_emission(scene, patch, band) +
               (hr2d_scene_reflectance(scene, patch, band) - 1) * value[k];
  }
  return status;
}
