/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One more gather at single points: B' = E + ρ ∫ G V B_h, with G and V exact.

   A point of a patch sees parts of other patches.  On each leaf of such a part B_h is a
   polynomial, and panels shrink towards the point as they do in near blocks. */
#include "blocks/panels.h"
#include "geometry/point-view-factor.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "visibility/point-view.h"

/* On a panel that is far enough a rule is accurate to 3.19^−(2·POINTS − order). */
enum { POINTS = 32, STACK = 128 };

typedef struct gatherer {
  const hr2d_solution *solution;
  hr2di_basis basis;
  hr2di_rule rule;
  hr2d_point x, normal;
  double *value; /* per band: H */
} gatherer;

/* At order 1 B is constant on a leaf: its part sends B times the form factor of a segment. */
static void add_constant(gatherer *g, const hr2d_element *e, const double *coefficient,
                         hr2di_span part) {
  const hr2d_point along = {e->b.x - e->a.x, e->b.y - e->a.y};
  const hr2d_point from = {e->a.x - g->x.x, e->a.y - g->x.y};
  const double factor =
      hr2di_point_view_factor(g->normal, hr2di_block_along(from, along, part.from),
                              hr2di_block_along(from, along, part.to));
  for (size_t b = 0; b < g->solution->bands; b++) g->value[b] += factor * coefficient[b];
}

static void add_panel(gatherer *g, hr2d_point from, hr2d_point along, hr2di_span panel,
                      const double *coefficient) {
  const double size = panel.to - panel.from;
  const size_t bands = g->solution->bands;
  for (size_t q = 0; q < g->rule.points; q++) {
    const double t = panel.from + size * (0.5 + 0.5 * g->rule.at[q]);
    const hr2d_point r = hr2di_block_along(from, along, t);
    const double square = r.x * r.x + r.y * r.y;
    if (!(square > 0)) continue; /* x is a corner, and the panel no larger than rounding */
    const double cos_x = g->normal.x * r.x + g->normal.y * r.y;
    const double turn = r.x * along.y - r.y * along.x;
    const double kernel =
        0.5 * size * g->rule.weight[q] * cos_x * turn / (square * sqrt(square));
    for (size_t b = 0; b < bands; b++)
      g->value[b] += kernel * hr2di_basis_sum(&g->basis, 2 * t - 1, coefficient + b, bands);
  }
}

/* Adds the light that a part of a leaf sends. */
static void add_leaf(gatherer *g, uint32_t leaf, hr2di_span part) {
  const hr2d_solution *s = g->solution;
  const hr2d_element *e = &s->hierarchy->element[leaf];
  const double *coefficient = s->value + leaf * s->order * s->bands;
  const hr2d_point along = {e->b.x - e->a.x, e->b.y - e->a.y};
  const hr2d_point from = {e->a.x - g->x.x, e->a.y - g->x.y};
  hr2di_panels panels = {.count = 1};
  if (!(part.to > part.from)) return;
  if (s->order == 1) {
    add_constant(g, e, coefficient, part);
    return;
  }
  panels.stack[0] = part;
  while (panels.count > 0) {
    const hr2di_span panel = panels.stack[--panels.count];
    if (hr2di_panel_near(from, along, panel) && hr2di_panel_halved(&panels, panel)) continue;
    add_panel(g, from, along, panel, coefficient);
  }
}

/* An element, and the part of its patch that it covers. */
typedef struct piece {
  uint32_t element;
  double from, to; /* fractions of the patch */
} piece;

/* Adds the light of the part of a patch that the point sees. */
static void add_glimpse(gatherer *g, const hr2di_glimpse *seen) {
  const hr2d_element *element = g->solution->hierarchy->element;
  piece stack[STACK];
  size_t count = 0;
  stack[count++] = (piece){seen->patch, 0, 1};
  while (count > 0) {
    const piece p = stack[--count];
    const double size = p.to - p.from;
    if (p.to <= seen->from || p.from >= seen->to) continue;
    const uint32_t child = element[p.element].child;
    if (child && child < g->solution->elements && count < STACK - 2) {
      const double middle = p.from + hr2di_element_left_part(element, p.element) * size;
      stack[count++] = (piece){child + 1, middle, p.to};
      stack[count++] = (piece){child, p.from, middle};
      continue;
    }
    const hr2di_span part = {seen->from > p.from ? (seen->from - p.from) / size : 0,
                             seen->to < p.to ? (seen->to - p.from) / size : 1};
    add_leaf(g, p.element, part);
  }
}

static hr2d_status gather_at(gatherer *g, hr2di_viewer *viewer, size_t patch, double t) {
  const hr2d_scene *scene = g->solution->hierarchy->scene;
  const hr2di_patch *p = &scene->patch[patch];
  const hr2d_segment s = p->scaled;
  const size_t bands = g->solution->bands;
  hr2di_view_from seen;
  if (hr2di_view_at(viewer, patch, t, &seen)) return HR2D_ENOMEM;
  /* Measured from the nearer end, so that the point is on the patch at both. */
  g->x = t <= 0.5 ? (hr2d_point){s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)}
                  : (hr2d_point){s.b.x - (1 - t) * (s.b.x - s.a.x),
                                 s.b.y - (1 - t) * (s.b.y - s.a.y)};
  g->normal = (hr2d_point){-(s.b.y - s.a.y) / p->length, (s.b.x - s.a.x) / p->length};
  const int background = scene->effect[HR2D_EFFECT_BACKGROUND].on;
  for (size_t b = 0; b < bands; b++)
    g->value[b] = background ? seen.sky * hr2d_scene_background(scene, b) : 0;
  for (size_t k = 0; k < seen.count; k++) add_glimpse(g, &seen.glimpse[k]);
  for (size_t b = 0; b < bands; b++)
    g->value[b] = hr2d_scene_emission(scene, patch, b) +
                  hr2d_scene_reflectance(scene, patch, b) * g->value[b];
  return HR2D_OK;
}

hr2d_status hr2d_solution_gather(const hr2d_solution *solution, size_t patch, const double *t,
                                 size_t count, double *value) {
  hr2di_viewer *viewer = NULL;
  gatherer g = {.solution = solution};
  hr2d_status status =
      hr2di_viewer_create(solution->hierarchy->scene, &solution->alloc, &viewer);
  hr2di_basis_init(&g.basis, solution->order);
  hr2di_rule_init(&g.rule, POINTS);
  for (size_t k = 0; k < count && !status; k++) {
    g.value = value + k * solution->bands;
    status = gather_at(&g, viewer, patch, t[k]);
  }
  hr2di_viewer_destroy(viewer);
  return status;
}
