/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses how a block is integrated. */
#include "blocks/block.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "blocks/gas-cells.h"
#include "geometry/bernstein-ellipse.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

hr2d_status hr2di_integrator_init(hr2di_integrator *w, const hr2d_hierarchy *hierarchy,
                                  const hr2d_allocator *alloc, size_t order,
                                  hr2di_beam_cache *beam_cache, hr2di_watch *watch) {
  const hr2d_scene *scene = hierarchy->scene;
  *w = (hr2di_integrator){.hierarchy = hierarchy,
                          .alloc = *alloc,
                          .order = order,
                          .digits = HR2DI_DOUBLE_DIGITS,
                          .watch = watch,
                          .seen.alloc = *alloc};
  hr2di_basis_init(&w->basis, order);
  w->has_gas = hr2di_scene_has_gas(scene);
  if (w->has_gas) {
    w->absorption = hr2di_scene_scaled_range(scene).most;
    w->section = hr2di_scene_section(scene);
  }
  if (hr2di_scene_regions(scene)) {
    w->cells = hr2di_alloc_zero(alloc, 1, sizeof *w->cells);
    if (!w->cells || hr2di_gas_cells_init(w->cells, scene, alloc, order)) return HR2D_ENOMEM;
  }
  w->rule = hr2di_alloc(alloc, HR2DI_RULE_POINTS, sizeof *w->rule);
  hr2d_status status = hr2di_integrator_points(w, order + 2, 0);
  if (!status) status = hr2di_moments_init(&w->moments, order, alloc);
  int room = w->rule && !status;
  if (room && scene->effect[HR2D_EFFECT_OCCLUSION].on) {
    w->visibility = hr2di_alloc_zero(alloc, 1, sizeof *w->visibility);
    room = w->visibility &&
           !hr2di_pair_visibility_init(w->visibility, scene, beam_cache, alloc, watch);
  }
  return room ? HR2D_OK : HR2D_ENOMEM;
}

void hr2di_integrator_clear(hr2di_integrator *w) {
  hr2di_alloc_free(&w->alloc, w->phi);
  hr2di_alloc_free(&w->alloc, w->rule);
  hr2di_moments_clear(&w->moments, &w->alloc);
  if (w->visibility) hr2di_pair_visibility_clear(w->visibility);
  hr2di_alloc_free(&w->alloc, w->visibility);
  hr2di_line_class_list_clear(&w->seen);
  hr2di_alloc_free(&w->alloc, w->vertex);
  hr2di_alloc_free(&w->alloc, w->trapezoid);
  if (w->cells) hr2di_gas_cells_clear(w->cells);
  hr2di_alloc_free(&w->alloc, w->cells);
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

/* Where nothing is in the way. */
static hr2d_status add_clear(hr2di_integrator *w, const hr2di_line_frame *f, double *block) {
  hr2di_vertex end[4];
  if (!hr2di_line_ends(f, end, end + 2)) return HR2D_OK;
  return hr2di_block_of_vertices(w, f, end, 2, 2, block);
}

/* On which of the lines of two patches a point of a chain lies. */
static hr2di_incident_point incident(const hr2di_pair_lines *lines, hr2d_point at,
                                     unsigned known) {
  if (!(known & HR2DI_ON_I) && hr2di_axis_front(&lines->i, at) == 0) known |= HR2DI_ON_I;
  if (!(known & HR2DI_ON_J) && hr2di_axis_front(&lines->j, at) == 0) known |= HR2DI_ON_J;
  return (hr2di_incident_point){at, known};
}

/* One chain, whose first and last points may be ends of i and of j. */
static void add_chain(hr2di_vertex *vertex, const hr2di_line_frame *f,
                      const hr2di_pair_lines *lines, const hr2d_point *point, size_t count,
                      unsigned first, unsigned last) {
  for (size_t k = 0; k < count; k++) {
    const unsigned known =
        (k == 0 && first ? HR2DI_ON_I : 0) | (k + 1 == count && last ? HR2DI_ON_J : 0);
    vertex[k] = hr2di_line_vertex(f, incident(lines, point[k], known));
  }
}

static hr2d_status add_sight(hr2di_integrator *w, const hr2di_line_frame *f,
                             const hr2di_pair_lines *lines, const hr2di_line_class *s,
                             double *block) {
  if (hr2di_alloc_reserve(&w->alloc, &w->vertex, &w->vertex_capacity, s->rights + s->lefts,
                          sizeof *w->vertex))
    return HR2D_ENOMEM;
  add_chain(w->vertex, f, lines, s->right, s->rights, s->ends & HR2DI_LINE_CLASS_B,
            s->ends & HR2DI_LINE_CLASS_C);
  add_chain(w->vertex + s->rights, f, lines, s->left, s->lefts, s->ends & HR2DI_LINE_CLASS_A,
            s->ends & HR2DI_LINE_CLASS_D);
  return hr2di_block_of_vertices(w, f, w->vertex, s->rights, s->lefts, block);
}

static hr2d_status set_frame(hr2di_integrator *w, const hr2d_hierarchy *h, hr2d_pair pair,
                             hr2di_line_frame *f) {
  hr2di_line_frame_init(f, h, pair);
  f->has_gas = w->absorption > 0;
  return w->cells && w->cells->is_mixed ? hr2di_gas_cells_frame(w->cells, f) : HR2D_OK;
}

/* Where something bounds the view but the elements. */
static hr2d_status add_shaded(hr2di_integrator *w, hr2d_pair pair, double *block) {
  const hr2d_hierarchy *h = w->hierarchy;
  const hr2di_patch *patch = h->scene->patch;
  const hr2di_pair_lines lines = {hr2di_axis_of(patch[h->element[pair.first].patch].scaled),
                                  hr2di_axis_of(patch[h->element[pair.second].patch].scaled)};
  hr2di_line_frame f;
  hr2d_status status = HR2D_OK;
  status = set_frame(w, h, pair, &f);
  for (size_t k = 0; k < w->seen.count && !status; k++) {
    const hr2di_line_class s = hr2di_line_class_list_at(&w->seen, k);
    status = add_sight(w, &f, &lines, &s, block);
  }
  return status;
}

/* Takes what the elements see of each other into w->seen, with the first one's patch looking.
   Elements within roundings of each other may have lost the lines that their ancestors had:
   what was clear to these is not looked at. */
static hr2d_status find_lines(hr2di_integrator *w, hr2d_pair pair, double area,
                              hr2di_visibility_class *view) {
  const hr2d_element *i = &w->hierarchy->element[pair.first];
  const hr2d_element *j = &w->hierarchy->element[pair.second];
  const hr2di_patch_pair parts = {{i->patch, j->patch}, {{i->a, i->b}, {j->a, j->b}}};
  const int swap = i->patch > j->patch;
  *view = HR2DI_CLEAR;
  if (!w->visibility || hr2d_exchange_area(&parts.part[0], &parts.part[1]) == area)
    return HR2D_OK;
  hr2di_line_class_list_cut(&w->seen, 0);
  const hr2d_status status =
      hr2di_pair_visibility_between(w->visibility, &parts, &w->seen, NULL);
  if (!status)
    *view = hr2di_line_classes_classify(&w->seen, 0, parts.part[swap], parts.part[!swap]);
  return status;
}

/* At order 1 a block is the exchange area, which is to have all digits. */
static int can_be_distant(const hr2di_integrator *w, const hr2d_element *i,
                          const hr2d_element *j) {
  if (w->cells && w->cells->is_mixed) return 0;
  return w->order > 1 && w->absorption * fmax(i->length, j->length) <= HR2DI_CHOICE_GAS_DEPTH;
}

/* Finds the gas between two elements, or that there are several. */
static hr2d_status find_gas(hr2di_integrator *w, hr2d_segment i, hr2d_segment j) {
  const hr2d_status status = hr2di_gas_cells_begin(w->cells, i, j, w->watch);
  w->absorption = w->cells->is_mixed
                      ? hr2di_scene_scaled_range(w->hierarchy->scene).most
                      : hr2di_scene_scaled_absorption(w->hierarchy->scene, w->cells->gas);
  return status;
}

/* hr2di_block() for a pair in order; `given` is the same pair as it was asked for. */
static hr2d_status integrate(hr2di_integrator *w, hr2d_pair pair, hr2d_pair given, double area,
                             double *block, int *distant) {
  const hr2d_hierarchy *h = w->hierarchy;
  const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
  const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
  const hr2d_segment p = h->scene->patch[i->patch].scaled, q = h->scene->patch[j->patch].scaled;
  const int corner = hr2di_point_same(p.b, q.a) || hr2di_point_same(p.a, q.b);
  const hr2di_facing facing = corner ? hr2di_facing_of(&p, &q) : hr2di_facing_of(&s, &t);
  hr2di_visibility_class view;
  *distant = 0;
  hr2d_status status = hr2di_watch_work(w->watch, 2);
  if (status || facing == HR2DI_FACING_NONE) return status;
  status = find_lines(w, given, area, &view);
  if (status || view == HR2DI_BLOCKED) return status;
  if (w->cells) status = find_gas(w, s, t);
  if (status) return status;
  if (view == HR2DI_PARTIAL) return add_shaded(w, pair, block);
  const int whole = facing == HR2DI_FACING_FULL;
  const double m[] = {whole ? hr2di_ellipse_min(s, t) : 0, whole ? hr2di_ellipse_min(t, s) : 0};
  *distant = m[0] >= HR2DI_ELLIPSE_DISTANT && m[1] >= HR2DI_ELLIPSE_DISTANT &&
             (w->absorption == 0 || can_be_distant(w, i, j));
  if (*distant) {
    hr2di_pair_frame f;
    hr2di_pair_frame_init(&f, h, pair);
    hr2di_block_distant(w, &f, m, block);
    return hr2di_watch_status(w->watch);
  }
  hr2di_line_frame f;
  status = set_frame(w, h, pair, &f);
  return status ? status : add_clear(w, &f, block);
}

static void transpose(double *block, size_t order) {
  for (size_t l = 0; l < order; l++)
    for (size_t m = 0; m < l; m++) {
      const double kept = block[l * order + m];
      block[l * order + m] = block[m * order + l];
      block[m * order + l] = kept;
    }
}

static void swap_lost(hr2di_integrator *w) {
  for (size_t l = 0; l < w->order; l++) {
    const double kept = w->lost[0][l];
    w->lost[0][l] = w->lost[1][l];
    w->lost[1][l] = kept;
  }
  if (w->cells) hr2di_gas_cells_swap(w->cells);
}

hr2d_status hr2di_block(hr2di_integrator *w, hr2d_pair pair, double area, double *block,
                        int *distant) {
  const hr2d_element *element = w->hierarchy->element;
  const hr2d_pair swap = {pair.second, pair.first};
  const int in_order = element[pair.first].patch <= element[pair.second].patch;
  memset(block, 0, w->order * w->order * sizeof *block);
  if (w->has_gas) memset(w->lost, 0, sizeof w->lost);
  if (w->cells) hr2di_gas_cells_forget(w->cells);
  hr2di_moments_begin(&w->moments);
  const hr2d_status status = integrate(w, in_order ? pair : swap, pair, area, block, distant);
  if (status) return status;
  hr2di_moments_end(&w->moments, block);
  if (!in_order) transpose(block, w->order);
  if (w->cells) hr2di_gas_cells_take(w->cells, w->lost);
  if (!in_order && w->has_gas) swap_lost(w);
  return hr2di_watch_status(w->watch);
}
