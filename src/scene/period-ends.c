/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the ends of a period take of the view from the patches of the cell, exactly: beams from
   each patch, as far as they end on one of the ends. */
#include <math.h>

#include "base/alloc.h"
#include "beams/line-class-list.h"
#include "beams/walk.h"
#include "scene/scene-impl.h"

/* What is seen in a smaller part of all directions cannot be told from rounding. */
#define NONE 1e-15

typedef struct observer {
  const hr2d_scene *scene;
  hr2di_walk walk;
  size_t first;          /* the patches from this number on are ends */
  unsigned char *wanted; /* per side: whether it has an end */
  hr2d_segment from;     /* the part of a patch that looks, */
  hr2di_wall_side side;  /* and its side */
  hr2di_line_class_list seen, part;
  double area; /* of what the patch sees of the ends */
} observer;

/* A side may have ends and other patches. */
static hr2d_status take(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  observer *l = ctx;
  const hr2di_triangulation *t = &l->scene->plane.triangulation;
  const hr2di_side_parts *p = &l->scene->parts;
  const hr2di_parts of = p->of_side[j].parts;
  hr2di_line_class_list_cut(&l->seen, 0);
  hr2d_status status = hr2di_line_class_list_add(&l->seen, s, hr2di_wall_side_at(t, l->side),
                                                 hr2di_wall_side_at(t, j));
  for (uint32_t k = of.first; k < of.last && !status; k++) {
    if (p->part[k].patch == HR2DI_NOBODY || p->part[k].patch < l->first) continue;
    hr2di_line_class_list_cut(&l->part, 0);
    status = hr2di_watch_work(l->walk.watch, 4);
    if (!status)
      status = hr2di_line_class_list_restrict(&l->part, &l->seen, 0, 1, l->from, p->part[k].at,
                                              NULL);
    if (!status) l->area += hr2di_line_class_list_area(&l->part, 0, l->part.count);
  }
  return status;
}

static hr2d_status view_from(observer *l, size_t patch) {
  const hr2di_side_parts *p = &l->scene->parts;
  const hr2di_parts of = p->of_patch[patch];
  hr2d_status status = HR2D_OK;
  l->area = 0;
  for (uint32_t k = of.first; k < of.last && !status; k++) {
    if (p->part[k].side == HR2DI_HIDDEN) continue;
    l->side = p->part[k].side;
    l->from = p->part[k].at;
    status = hr2di_walk_from(&l->walk, l->side, &l->from);
  }
  return status;
}

static hr2d_status want_ends(observer *l) {
  const hr2d_scene *scene = l->scene;
  const hr2di_side_parts *p = &scene->parts;
  l->first = scene->patches - scene->symmetry.ends;
  l->wanted = hr2di_alloc_zero(&scene->alloc, scene->plane.triangulation.edges, 2);
  if (!l->wanted) return HR2D_ENOMEM;
  for (size_t k = l->first; k < scene->patches; k++)
    for (uint32_t m = p->of_patch[k].first; m < p->of_patch[k].last; m++)
      if (p->part[m].side != HR2DI_HIDDEN) l->wanted[p->part[m].side] = 1;
  l->walk.wanted = l->wanted;
  return HR2D_OK;
}

hr2d_status hr2di_scene_measure_ends(hr2d_scene *scene, hr2di_watch *watch) {
  hr2di_symmetry *s = &scene->symmetry;
  if (!s->motion || s->ends == 0) return HR2D_OK;
  hr2d_status status = hr2di_scene_need_plane(scene, watch);
  if (!status && !scene->parts.wanted)
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "too many patches cross within roundings for a period");
  observer l = {.scene = scene,
                .walk = {.in = &scene->plane.triangulation,
                         .take = take,
                         .ctx = &l,
                         .alloc = scene->alloc,
                         .watch = watch},
                .seen = {.alloc = scene->alloc},
                .part = {.alloc = scene->alloc}};
  if (!status) status = want_ends(&l);
  s->rest = 0;
  for (size_t k = 0; k < s->cell && !status; k++) {
    status = view_from(&l, k);
    if (!(l.area <= NONE * scene->patch[k].length))
      s->rest = fmax(s->rest, l.area / scene->patch[k].length);
  }
  hr2di_walk_clear(&l.walk);
  hr2di_line_class_list_clear(&l.seen);
  hr2di_line_class_list_clear(&l.part);
  hr2di_alloc_free(&scene->alloc, l.wanted);
  return status ? hr2di_scene_fail(scene, status, watch, "the ends of the period") : HR2D_OK;
}
