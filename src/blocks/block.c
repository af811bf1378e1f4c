/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses how a block is integrated. */
#include "blocks/block.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "geometry/bernstein-ellipse.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

static double *table(const hr2di_integrator *w, const hr2di_rule *rule) {
  hr2di_basis basis;
  hr2di_basis_init(&basis, w->order);
  double *phi = hr2di_alloc(&w->alloc, rule->points * w->order, sizeof *phi);
  for (size_t q = 0; phi && q < rule->points; q++)
    hr2di_basis_at(&basis, rule->at[q], phi + q * w->order);
  return phi;
}

hr2d_status hr2di_integrator_init(hr2di_integrator *w, const hr2d_hierarchy *hierarchy,
                                  const hr2d_allocator *alloc, size_t order,
                                  hr2di_watch *watch) {
  const hr2d_scene *scene = hierarchy->scene;
  *w = (hr2di_integrator){
      .hierarchy = hierarchy, .alloc = *alloc, .order = order, .watch = watch};
  hr2di_rule_init(&w->far, order + 2);
  w->phi_far = table(w, &w->far);
  w->rule = hr2di_alloc(alloc, HR2DI_RULE_POINTS, sizeof *w->rule);
  const hr2d_status status = hr2di_moments_init(&w->moments, order, alloc);
  int room = w->phi_far && w->rule && !status;
  if (room && scene->effect[HR2D_EFFECT_OCCLUSION].on) {
    w->visibility = hr2di_alloc(alloc, 1, sizeof *w->visibility);
    if (w->visibility) hr2di_visibility_init(w->visibility, &scene->walls, alloc, watch);
    room = w->visibility != NULL;
  }
  return room ? HR2D_OK : HR2D_ENOMEM;
}

void hr2di_integrator_clear(hr2di_integrator *w) {
  hr2di_alloc_free(&w->alloc, w->phi_far);
  hr2di_alloc_free(&w->alloc, w->rule);
  hr2di_moments_clear(&w->moments, &w->alloc);
  if (w->visibility) hr2di_visibility_clear(w->visibility);
  hr2di_alloc_free(&w->alloc, w->visibility);
  hr2di_alloc_free(&w->alloc, w->found.wall);
  hr2di_alloc_free(&w->alloc, w->vertex);
  hr2di_alloc_free(&w->alloc, w->trapezoid);
}

hr2d_status hr2di_block_of_vertices(hr2di_integrator *w, const hr2di_line_frame *f,
                                    const hr2di_vertex *vertex, size_t rights, size_t lefts,
                                    double *block) {
  if (hr2di_alloc_reserve(&w->alloc, &w->trapezoid, &w->trapezoid_capacity, rights + lefts,
                          sizeof *w->trapezoid))
    return HR2D_ENOMEM;
  const hr2d_status status = hr2di_watch_work(w->watch, 2 * (rights + lefts));
  if (status) return status;
  const size_t count =
      hr2di_line_trapezoids(f, vertex, rights, vertex + rights, lefts, w->trapezoid);
  return hr2di_block_add_lines(w, w->trapezoid, count, block);
}

hr2d_status hr2di_block_of_chains(hr2di_integrator *w, const hr2di_line_frame *f,
                                  const hr2di_incident_point *right, size_t rights,
                                  const hr2di_incident_point *left, size_t lefts,
                                  double *block) {
  if (hr2di_alloc_reserve(&w->alloc, &w->vertex, &w->vertex_capacity, rights + lefts,
                          sizeof *w->vertex))
    return HR2D_ENOMEM;
  for (size_t k = 0; k < rights; k++) w->vertex[k] = hr2di_line_vertex(f, right[k]);
  for (size_t k = 0; k < lefts; k++) w->vertex[rights + k] = hr2di_line_vertex(f, left[k]);
  return hr2di_block_of_vertices(w, f, w->vertex, rights, lefts, block);
}

/* Where nothing is in the way. */
static hr2d_status add_clear(hr2di_integrator *w, const hr2di_line_frame *f, double *block) {
  hr2di_vertex end[4];
  if (!hr2di_line_ends(f, end, end + 2)) return HR2D_OK;
  return hr2di_block_of_vertices(w, f, end, 2, 2, block);
}

typedef struct shaded {
  hr2di_integrator *work;
  hr2di_line_frame frame;
  double *block;
} shaded;

static hr2d_status add_class(void *ctx, const hr2di_shaft *shaft, const hr2di_chain *right,
                             const hr2di_chain *left, int *open) {
  const shaded *s = ctx;
  hr2di_corridor c;
  if (!right) {
    const hr2di_incident_point side[2][2] = {{shaft->b, shaft->c}, {shaft->a, shaft->d}};
    *open = 1;
    return hr2di_block_of_chains(s->work, &s->frame, side[0], 2, side[1], 2, s->block);
  }
  *open = hr2di_corridor_find(&shaft->frame, right, left, &c);
  if (!*open) return HR2D_OK;
  return hr2di_block_of_chains(s->work, &s->frame, right->point + c.right_first,
                               c.right_last - c.right_first + 1, left->point + c.left_first,
                               c.left_last - c.left_first + 1, s->block);
}

static hr2d_status add_shaded(hr2di_integrator *w, hr2d_pair pair, const hr2di_shaft *shaft,
                              double *block) {
  shaded s = {.work = w, .block = block};
  const hr2di_class_visitor visitor = {add_class, &s};
  int open;
  hr2di_line_frame_init(&s.frame, w->hierarchy, pair);
  return hr2di_visibility_visit(w->visibility, shaft, w->found.wall, w->found.count, &visitor,
                                &open);
}

/* Collects the walls in the way into w->found. */
static hr2d_status look(hr2di_integrator *w, hr2d_pair pair, hr2di_facing facing,
                        hr2di_shaft *shaft, hr2di_visibility_class *view) {
  const hr2d_hierarchy *h = w->hierarchy;
  const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
  *view = HR2DI_CLEAR;
  w->found.count = 0;
  const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
  if (!w->visibility || !hr2di_shaft_init(shaft, facing, s, t, h->scene->patch[i->patch].scaled,
                                          h->scene->patch[j->patch].scaled))
    return HR2D_OK;
  return hr2di_visibility_collect(w->visibility, shaft, &w->found, view);
}

/* hr2di_block() for a pair in order. */
static hr2d_status integrate(hr2di_integrator *w, hr2d_pair pair, double *block, int *distant) {
  const hr2d_hierarchy *h = w->hierarchy;
  const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
  const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
  const hr2d_segment p = h->scene->patch[i->patch].scaled, q = h->scene->patch[j->patch].scaled;
  const int corner = hr2di_point_same(p.b, q.a) || hr2di_point_same(p.a, q.b);
  const hr2di_facing facing = corner ? hr2di_facing_of(&p, &q) : hr2di_facing_of(&s, &t);
  hr2di_shaft shaft;
  hr2di_visibility_class view;
  *distant = 0;
  hr2d_status status = hr2di_watch_work(w->watch, 2);
  if (status || facing == HR2DI_FACING_NONE) return status;
  status = look(w, pair, facing, &shaft, &view);
  if (status || view == HR2DI_BLOCKED) return status;
  if (view == HR2DI_PARTIAL) return add_shaded(w, pair, &shaft, block);
  *distant = facing == HR2DI_FACING_FULL &&
             hr2di_ellipse_least(s, t) >= HR2DI_ELLIPSE_DISTANT &&
             hr2di_ellipse_least(t, s) >= HR2DI_ELLIPSE_DISTANT;
  if (*distant) {
    hr2di_pair_frame f;
    hr2di_pair_frame_init(&f, h, pair);
    hr2di_block_distant(w, &f, block);
    return hr2di_watch_status(w->watch);
  }
  hr2di_line_frame f;
  hr2di_line_frame_init(&f, h, pair);
  return add_clear(w, &f, block);
}

static void transpose(double *block, size_t order) {
  for (size_t l = 0; l < order; l++)
    for (size_t m = 0; m < l; m++) {
      const double kept = block[l * order + m];
      block[l * order + m] = block[m * order + l];
      block[m * order + l] = kept;
    }
}

hr2d_status hr2di_block(hr2di_integrator *w, hr2d_pair pair, double *block, int *distant) {
  const hr2d_element *element = w->hierarchy->element;
  const hr2d_pair swap = {pair.second, pair.first};
  const int in_order = element[pair.first].patch <= element[pair.second].patch;
  memset(block, 0, w->order * w->order * sizeof *block);
  hr2di_moments_begin(&w->moments);
  const hr2d_status status = integrate(w, in_order ? pair : swap, block, distant);
  if (status) return status;
  hr2di_moments_end(&w->moments, block);
  if (!in_order) transpose(block, w->order);
  return hr2di_watch_status(w->watch);
}
