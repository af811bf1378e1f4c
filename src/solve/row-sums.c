/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Row sums of leaves.

   If a patch sees patches in every direction, so do its leaves: their sums are 1.  Other
   patches send beams.  A line class that ends at a front is a part of the sums over patches,
   one that ends at a back of those over backs: a leaf takes the lines that start on it. Patches
   side by side that a line class ends on are seen as one.

   A tree is walked down as far as something bounds the view but its elements; where nothing
   does, the lines from a leaf are all lines to the segment where the line class ends. */
#include "solve/row-sums.h"

#include <hr2d/transport.h>

#include "base/alloc.h"
#include "beams/line-class-list.h"
#include "geometry/exchange-area.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/patch-defect.h"
#include "scene/with-plane.h"
#include "solve/row-tails.h"

/* Elements that wait, one per level. */
enum { DEPTH = 1100 };

/* The row of one patch. */
typedef struct walker {
  const hr2d_hierarchy *h;
  const hr2d_scene *scene; /* with a plane, unless nobody knows how walls cross */
  hr2di_with_plane with;   /* `scene` once beams are sent */
  hr2di_watch *watch;
  hr2di_walk walk;
  unsigned char *kind;        /* per side, as hr2di_side_kind() */
  uint32_t patch;             /* that looks */
  hr2di_wall_side from;       /* where its beams start */
  hr2di_line_class_list seen; /* the line class that a beam has found */
  hr2di_line_class_list part; /* what an element has of it */
  hr2di_sum *front, *back;    /* per element, set for leaves; `back` is NULL if not asked for */
  uint32_t stack[DEPTH];
} walker;

/* Adds the exchange areas of all leaves below an element with a segment, with nothing in the
   way. */
static hr2d_status add_clear(walker *w, uint32_t top, hr2d_segment far, hr2di_sum *sum) {
  const hr2d_element *element = w->h->element;
  hr2d_status status = HR2D_OK;
  uint32_t leaf = hr2di_hierarchy_first_leaf(w->h, top);
  do {
    status = hr2di_watch_work(w->watch, 1);
    const hr2d_segment s = {element[leaf].a, element[leaf].b};
    hr2di_sum_add(&sum[leaf], hr2d_exchange_area(&s, &far));
    leaf = hr2di_hierarchy_next_leaf(w->h, leaf, top);
  } while (leaf && !status);
  return status;
}

/* Adds the length that each leaf shares with a stretch of the patch, times a factor. */
static hr2d_status add_length(walker *w, hr2d_segment arc, hr2di_sum *sum, double factor) {
  const hr2d_segment line = w->scene->patch[w->patch].scaled;
  const double start = hr2di_point_along(line, arc.a);
  const double end = hr2di_point_along(line, arc.b);
  hr2d_status status = HR2D_OK;
  size_t count = 0;
  if (sum) w->stack[count++] = w->patch;
  while (count > 0 && !status) {
    const uint32_t k = w->stack[--count];
    const hr2d_element *e = &w->h->element[k];
    const double from = hr2di_point_along(line, e->a), to = hr2di_point_along(line, e->b);
    const double shared = fmin(to, end) - fmax(from, start);
    status = hr2di_watch_work(w->watch, 1);
    if (!(shared > 0)) continue;
    if (!e->child) {
      hr2di_sum_add(&sum[k], factor * (shared / (to - from) * e->length));
      continue;
    }
    w->stack[count++] = e->child + 1;
    w->stack[count++] = e->child;
  }
  return status;
}

static int is_all_of(const hr2d_element *e, hr2d_segment s) {
  return hr2di_point_same(s.a, e->a) && hr2di_point_same(s.b, e->b);
}

/* Adds to the leaves what they have of the line class that was seen, as far as it ends on
 * `far`. */
static hr2d_status add_sight(walker *w, hr2d_segment far, hr2di_sum *sum) {
  hr2d_status status = HR2D_OK;
  size_t count = 0;
  w->stack[count++] = w->patch;
  while (count > 0 && !status) {
    const uint32_t k = w->stack[--count];
    const hr2d_element *e = &w->h->element[k];
    hr2di_line_class_list_cut(&w->part, 0);
    status = hr2di_watch_work(w->watch, 1 + w->seen.points / 8);
    if (!status)
      status = hr2di_line_class_list_restrict(&w->part, &w->seen, 0, 1,
                                              (hr2d_segment){e->a, e->b}, far, NULL);
    if (status || w->part.count == 0) continue;
    const hr2di_line_class s = hr2di_line_class_list_at(&w->part, 0);
    if (hr2di_line_class_clear(&s) && is_all_of(e, w->part.line_class[0].near)) {
      status = add_clear(w, k, w->part.line_class[0].far, sum);
    } else if (!e->child) {
      hr2di_sum_add(&sum[k], hr2di_line_class_area(&s));
    } else {
      w->stack[count++] = e->child + 1;
      w->stack[count++] = e->child;
    }
  }
  return status;
}

/* A line class that ends where patches and stretches without patches take turns. */
static hr2d_status add_stretches(walker *w, hr2di_parts along) {
  const hr2di_side_part *part = w->scene->parts.part;
  hr2d_status status = HR2D_OK;
  for (uint32_t first = along.first, last; first < along.last && !status; first = last) {
    const int nobody = part[first].patch == HR2DI_NOBODY;
    for (last = first + 1; last < along.last && (part[last].patch == HR2DI_NOBODY) == nobody;)
      last++;
    hr2di_sum *sum = nobody ? w->back : w->front;
    status = hr2di_watch_work(w->watch, 1 + (last - first) / 8);
    if (!status && sum)
      status = add_sight(w, (hr2d_segment){part[first].at.a, part[last - 1].at.b}, sum);
  }
  return status;
}

static hr2d_status take(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  walker *w = ctx;
  const hr2di_side *of_side = w->scene->parts.of_side;
  const hr2di_triangulation *t = &w->scene->plane.triangulation;
  const hr2d_segment far = hr2di_wall_side_at(t, j);
  if (of_side[j].wall == of_side[w->from].wall)
    return HR2D_OK; /* of a wall that roundings have bent */
  hr2di_line_class_list_cut(&w->seen, 0);
  const hr2d_status status =
      hr2di_line_class_list_add(&w->seen, s, hr2di_wall_side_at(t, w->from), far);
  if (status) return status;
  if (w->kind[j] == HR2DI_HAS_FRONT) return add_sight(w, far, w->front);
  if (w->kind[j] == HR2DI_HAS_BACK) return add_sight(w, far, w->back);
  return add_stretches(w, of_side[j].parts);
}

/* Parts between walls within roundings see what they are in contact with, and backs.  So does a
   patch that is but dust. */
static hr2d_status add_hidden(walker *w) {
  const hr2di_side_parts *p = &w->scene->parts;
  const hr2di_parts of = p->of_patch[w->patch];
  const hr2d_segment line = w->scene->patch[w->patch].scaled;
  hr2d_status status =
      of.first == of.last ? add_length(w, line, w->back, 1) : hr2di_watch_work(w->watch, 1);
  for (uint32_t k = of.first; k < of.last && !status; k++)
    if (p->part[k].side == HR2DI_HIDDEN) status = add_length(w, p->part[k].at, w->back, 1);
  for (size_t k = hr2di_side_parts_contact(p, of.first);
       k < p->contacts && p->contact[k].part < of.last && !status; k++) {
    const hr2d_segment mine = p->part[p->contact[k].part].at,
                       other = p->part[p->contact[k].other].at;
    const hr2d_segment shared = {
        hr2di_point_along(line, mine.a) > hr2di_point_along(line, other.b) ? mine.a : other.b,
        hr2di_point_along(line, mine.b) < hr2di_point_along(line, other.a) ? mine.b : other.a};
    status = add_length(w, shared, w->front, 1);
    if (!status) status = add_length(w, shared, w->back, -1);
  }
  return status;
}

/* Where there is no plane, nothing is in the way. */
static hr2d_status examine_all(walker *w) {
  const hr2d_scene *scene = w->scene;
  const hr2d_segment s = scene->patch[w->patch].scaled;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < scene->patches && !status; k++) {
    status = hr2di_watch_work(w->watch, 1);
    if (!status && (hr2di_scene_lit(scene, k) || !hr2di_scene_lit(scene, w->patch)) &&
        hr2di_facing_of(&s, &scene->patch[k].scaled) != HR2DI_FACING_NONE)
      status = add_clear(w, w->patch, scene->patch[k].scaled, w->front);
  }
  return status;
}

static hr2d_status view_around(walker *w) {
  const hr2di_side_parts *p = &w->scene->parts;
  if (!p->wanted) return examine_all(w);
  const hr2di_parts of = p->of_patch[w->patch];
  hr2d_status status = add_hidden(w);
  for (uint32_t k = of.first; k < of.last && !status; k++) {
    w->from = p->part[k].side;
    if (w->from != HR2DI_HIDDEN) status = hr2di_walk_from(&w->walk, w->from, &p->part[k].at);
  }
  return status;
}

/* Sets the row sums of the leaves of a patch: 1 if it is closed, else the sums over length.
   Returns how many there are. */
static uint64_t finish(const walker *w, uint32_t patch, int closed, double *front,
                       double *back) {
  uint64_t leaves = 0;
  uint32_t leaf = hr2di_hierarchy_first_leaf(w->h, patch);
  do {
    const double length = w->h->element[leaf].length;
    leaves++;
    if (hr2di_watch_work(w->watch, 1)) break;
    if (front) front[leaf] = closed ? 1 : hr2di_sum_total(&w->front[leaf]) / length;
    if (back) back[leaf] = hr2di_sum_total(&w->back[leaf]) / length;
    leaf = hr2di_hierarchy_next_leaf(w->h, leaf, patch);
  } while (leaf);
  return leaves;
}

/* Commit keeps no plane where nothing is in the way and no background is before backs. */
static hr2d_status need_plane(walker *w, const hr2d_allocator *alloc) {
  if (w->scene == &w->with.scene) return HR2D_OK;
  const hr2d_status status = hr2di_with_plane_init(&w->with, w->scene, alloc, w->watch);
  w->scene = &w->with.scene;
  return status;
}

/* Beams end at backs only if these are asked for. */
static hr2d_status prepare(walker *w, const hr2d_allocator *alloc) {
  hr2d_status status = need_plane(w, alloc);
  const hr2di_side_parts *p = &w->scene->parts;
  const hr2di_triangulation *t = &w->scene->plane.triangulation;
  if (status || !p->wanted) return status;
  w->kind = hr2di_alloc(alloc, t->edges, 2 * sizeof *w->kind);
  if (!w->kind) return HR2D_ENOMEM;
  w->walk = (hr2di_walk){.in = t,
                         .wanted = w->back ? w->kind : p->wanted,
                         .take = take,
                         .ctx = w,
                         .alloc = *alloc,
                         .watch = w->watch};
  for (hr2di_wall_side s = 0; s < 2 * t->edges && !status; s++) {
    const hr2di_parts of = p->of_side[s].parts;
    status = hr2di_watch_work(w->watch, 1 + (of.last - of.first) / 8);
    w->kind[s] = (unsigned char)hr2di_side_kind(p, s);
  }
  return status;
}

/* What is past the ends of a period counts as fronts so far, whatever it is. */
static hr2d_status move_tails(const walker *w, double *front, double *back) {
  if (!hr2di_symmetry_cuts(&w->scene->symmetry) || !w->scene->parts.wanted) return HR2D_OK;
  return hr2di_row_tails_move(w->h, w->scene, w->patch, front, back, w->watch);
}

static hr2d_status make_rows(hr2di_row_sums *rows, const hr2d_linkset *links, walker *w,
                             hr2di_sum *defect) {
  hr2d_status status = hr2di_defect_sum(links, defect, w->watch);
  if (status) return status;
  hr2di_defect_closed(links, defect, rows->closed);
  for (uint32_t k = 0; k < hr2di_scene_cell(w->scene) && !status; k++) {
    if (!hr2di_scene_lit(w->scene, k)) continue;
    if (!hr2di_share_has_row(links->share, k, hr2di_scene_cell(w->scene))) continue;
    const int open = !rows->closed[k];
    w->patch = k;
    if (open && !w->kind) status = prepare(w, &rows->alloc);
    if (open && !status) status = view_around(w);
    const uint64_t leaves = finish(w, k, !open, rows->front, rows->back);
    rows->leaves += open ? leaves : 0;
    if (open && !status) status = move_tails(w, rows->front, rows->back);
    if (!status) status = hr2di_watch_work(w->watch, 1);
  }
  return status;
}

/* Each share has the sums of its rows. */
static hr2d_status combine_rows(hr2di_row_sums *rows, hr2d_share *share, size_t elements,
                                hr2d_status status) {
  double leaves = (double)rows->leaves;
  status = hr2di_share_combine(share, status, HR2D_COMBINE_SUM, &leaves, 1);
  if (!status)
    status = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_SUM, rows->front, elements);
  if (!status && rows->back)
    status = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_SUM, rows->back, elements);
  rows->leaves = (uint64_t)leaves;
  return status;
}

static void clear(walker *w, const hr2d_allocator *alloc) {
  hr2di_with_plane_clear(&w->with);
  hr2di_walk_clear(&w->walk);
  hr2di_line_class_list_clear(&w->seen);
  hr2di_line_class_list_clear(&w->part);
  hr2di_alloc_free(alloc, w->kind);
  hr2di_alloc_free(alloc, w->front);
  hr2di_alloc_free(alloc, w->back);
  hr2di_alloc_free(alloc, w);
}

/* HR2D_OK or HR2D_ENOMEM; to be ended by clear() unless *made is NULL. */
static hr2d_status make_walker(const hr2d_hierarchy *h, const hr2d_allocator *alloc,
                               hr2di_watch *watch, size_t elements, int backs, walker **made) {
  walker *w = *made = hr2di_alloc_zero(alloc, 1, sizeof *w);
  if (!w) return HR2D_ENOMEM;
  w->h = h;
  w->scene = h->scene;
  w->watch = watch;
  w->walk.alloc = w->seen.alloc = w->part.alloc = *alloc;
  w->front = hr2di_alloc_zero(alloc, elements, sizeof *w->front);
  w->back = backs ? hr2di_alloc_zero(alloc, elements, sizeof *w->back) : NULL;
  return w->front && (w->back || !backs) ? HR2D_OK : HR2D_ENOMEM;
}

hr2d_status hr2di_row_sums_init(hr2di_row_sums *rows, const hr2di_transport *t, int backs) {
  const hr2d_allocator *alloc = &t->alloc;
  const size_t patches = t->hierarchy->scene->patches;
  *rows = (hr2di_row_sums){.hierarchy = t->hierarchy, .alloc = *alloc, .watch = t->watch};
  rows->front = hr2di_alloc_zero(alloc, t->elements, sizeof *rows->front);
  rows->back = backs ? hr2di_alloc_zero(alloc, t->elements, sizeof *rows->back) : NULL;
  rows->closed = hr2di_alloc_zero(alloc, patches, 1);
  hr2di_sum *defect = hr2di_alloc(alloc, patches, sizeof *defect);
  walker *w;
  hr2d_status status = make_walker(t->hierarchy, alloc, t->watch, t->elements, backs, &w);
  if (!rows->front || !rows->closed || !defect || (backs && !rows->back)) status = HR2D_ENOMEM;
  if (!status) status = make_rows(rows, t->links, w, defect);
  if (t->links->share) status = combine_rows(rows, t->links->share, t->elements, status);
  if (!status) hr2di_image_map_spread(&t->image_map, 1, 1, rows->front);
  if (!status && backs) hr2di_image_map_spread(&t->image_map, 1, 1, rows->back);
  if (w) clear(w, alloc);
  hr2di_alloc_free(alloc, defect);
  return status;
}

void hr2di_row_sums_clear(hr2di_row_sums *rows) {
  hr2di_alloc_free(&rows->alloc, rows->front);
  hr2di_alloc_free(&rows->alloc, rows->back);
  hr2di_alloc_free(&rows->alloc, rows->closed);
}

hr2d_status hr2d_leaf_sums(const hr2d_hierarchy *hierarchy, size_t row_from, size_t row_to,
                           double *front, double *back) {
  if (!hierarchy) return HR2D_EINVAL;
  const hr2d_allocator *alloc = &hierarchy->alloc;
  const size_t patches = hr2di_scene_cell(hierarchy->scene);
  hr2di_watch watch;
  walker *w;
  if (row_to == 0) row_to = patches;
  if (row_from > row_to || row_to > patches) return HR2D_EINVAL;
  if (hr2di_scene_has_gas(hierarchy->scene)) return HR2D_EUNSUPPORTED;
  hr2di_scene_watch(hierarchy->scene, &watch, NULL, NULL, "row sums");
  hr2d_status status =
      make_walker(hierarchy, alloc, &watch, hierarchy->elements, back != NULL, &w);
  if (!status) status = prepare(w, alloc);
  for (size_t k = row_from; k < row_to && !status; k++) {
    w->patch = (uint32_t)k;
    status = view_around(w);
    finish(w, w->patch, 0, front, back);
    if (!status) status = move_tails(w, front, back);
    if (!status) status = hr2di_watch_work(&watch, 1);
  }
  if (w) clear(w, alloc);
  return status ? status : hr2di_watch_ask(&watch);
}
