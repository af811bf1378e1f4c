/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "visibility/any-visible.h"

#include "scene/scene-impl.h"
#include "visibility/point-view-impl.h"

typedef struct search {
  unsigned what;
  int sees;
} search;

static hr2d_status notice(void *ctx, const hr2di_visible_arc *s,
                          const hr2di_visible_interval *g) {
  search *l = ctx;
  (void)g;
  if (s->patch == HR2DI_SEEN_SKY)
    l->sees = (l->what & HR2DI_ANY_SKY) != 0;
  else if (s->patch != HR2DI_SEEN_NOBODY)
    l->sees = (l->what & HR2DI_ANY_FRONTS) != 0;
  return l->sees ? HR2D_STOPPED : HR2D_OK;
}

hr2d_status hr2di_any_visible(hr2di_point_viewer *viewer, size_t patch, unsigned what,
                              int *sees) {
  static const double at[] = {.5, .25, .75, 0x1p-10, 1 - 0x1p-10, .125, .375, .625, .875};
  search l = {.what = what};
  hr2di_view_from seen;
  hr2d_status status = HR2D_OK;
  viewer->show = notice;
  /* cppcheck-suppress autoVariables ; until the end of this function */
  viewer->ctx = &l;
  for (size_t k = 0; k < sizeof at / sizeof *at && !l.sees && !status; k++)
    status = hr2di_view_at(viewer, patch, at[k], &seen);
  viewer->show = NULL;
  viewer->ctx = NULL;
  *sees = l.sees;
  return l.sees ? HR2D_OK : status;
}

/* Stretches of one back come one after the other, and are as many as its wall has edges: the
   longest is as good as their sum, to name it. */
typedef struct backs {
  const hr2d_scene *scene;
  double all, max;
  uint32_t patch;
} backs;

/* The patch on the other side of a side of a wall. */
static uint32_t behind(const hr2d_scene *scene, hr2di_wall_side side) {
  const hr2di_parts parts = scene->parts.of_side[side ^ 1].parts;
  uint32_t k = parts.first;
  while (k < parts.last && scene->parts.part[k].patch == HR2DI_NOBODY) k++;
  return k < parts.last ? scene->parts.part[k].patch : HR2DI_NOBODY;
}

static hr2d_status notice_back(void *ctx, const hr2di_visible_arc *s,
                               const hr2di_visible_interval *g) {
  backs *b = ctx;
  if (s->patch != HR2DI_SEEN_NOBODY || s->side == HR2DI_HIDDEN) return HR2D_OK;
  const uint32_t patch = behind(b->scene, s->side);
  if (patch == HR2DI_NOBODY) return HR2D_OK;
  b->all += g->sine;
  if (g->sine > b->max) {
    b->max = g->sine;
    b->patch = patch;
  }
  return HR2D_OK;
}

hr2d_status hr2di_sees_back(hr2di_point_viewer *viewer, size_t patch, double min,
                            uint32_t *back) {
  backs b = {.scene = viewer->scene, .patch = HR2DI_NOBODY};
  hr2di_view_from seen;
  viewer->show = notice_back;
  /* cppcheck-suppress autoVariables ; until the end of this function */
  viewer->ctx = &b;
  const hr2d_status status = hr2di_view_at(viewer, patch, .5, &seen);
  viewer->show = NULL;
  viewer->ctx = NULL;
  *back = b.all >= min ? b.patch : HR2DI_NOBODY;
  return status;
}
