/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What fronts see: no light, nothing, no sky although there is one, or the black back of a
   patch. */
#include <stdio.h>

#include "base/alloc.h"
#include "lint/lint-impl.h"
#include "scene/with-plane.h"
#include "visibility/any-visible.h"
#include "visibility/back-visibility.h"

/* The part of what the middle of a front sees from which on a back is told.  Through a gap that
   another warning tells, less is seen. */
#define LEAST_BACK .01

/* The patch whose back is seen, per patch of the cell. */
typedef struct backs {
  uint32_t *viewer; /* the first patch that sees it, or HR2DI_NOBODY */
  uint32_t *viewers;
} backs;

typedef struct views {
  const hr2di_lint *lint;
  const hr2d_scene *in; /* with a plane */
  hr2di_point_viewer *viewer;
  int sky, lit;
  backs back;
  hr2di_lint_patches nothing; /* they see nothing */
  hr2di_lint_patches backs;   /* their backs are seen */
  int blind;                  /* no front sees the sky, although there is one */
} views;

static int emits(const hr2d_scene *scene, size_t patch) {
  for (size_t band = 0; band < scene->bands; band++)
    if (hr2d_scene_emission(scene, patch, band) != 0) return 1;
  return 0;
}

static int is_reversed(const hr2d_scene *scene, size_t patch, size_t other) {
  const hr2d_segment s = hr2d_scene_segment(scene, patch), o = hr2d_scene_segment(scene, other);
  return s.a.x == o.b.x && s.a.y == o.b.y && s.b.x == o.a.x && s.b.y == o.a.y;
}

/* Another patch has the other side of its wall, as where two houses that are seen from outside
   have a wall in common, or a cupboard stands at a wall: its front is inside of the other house
   or of the wall, and nothing is wrong.  With `longer` a patch between the same ends does not
   count: it may be the same wall, drawn twice. */
static int has_other_side(const views *v, size_t patch, int longer) {
  const hr2di_side_parts *p = &v->in->parts;
  if (!p->wanted) return 0;
  const hr2di_parts of = p->of_patch[patch];
  for (uint32_t k = of.first; k < of.last; k++) {
    const hr2di_wall_side side = p->part[k].side;
    if (p->part[k].patch != patch || side == HR2DI_HIDDEN) continue;
    const hr2di_parts other = p->of_side[side ^ 1].parts;
    for (uint32_t m = other.first; m < other.last; m++)
      if (p->part[m].patch != HR2DI_NOBODY &&
          !(longer && is_reversed(v->in, patch, p->part[m].patch)))
        return 1;
  }
  return 0;
}

/* Whether a patch has light that a back may take: inside of solid things there is none. Without
   any, backs are asked for all. */
static hr2d_status find_light(const views *v, size_t patch, int *has) {
  *has = !v->lit || emits(v->in, patch) || (!v->sky && hr2di_scene_lit(v->lint->scene, patch));
  return *has || !v->sky ? HR2D_OK : hr2di_any_visible(v->viewer, patch, HR2DI_ANY_SKY, has);
}

static hr2d_status find_backs(views *v) {
  const hr2d_scene *scene = v->lint->scene;
  const size_t cell = hr2di_scene_cell(scene);
  unsigned char *sees = NULL;
  hr2d_status status = hr2di_back_visibility(v->in, &scene->alloc, 1, &sees, v->lint->watch);
  if (status || !sees) return status;
  v->back.viewer = hr2di_alloc(&scene->alloc, cell, sizeof *v->back.viewer);
  v->back.viewers = hr2di_alloc_zero(&scene->alloc, cell, sizeof *v->back.viewers);
  if (!v->back.viewer || !v->back.viewers) status = HR2D_ENOMEM;
  for (size_t k = 0; k < cell && !status; k++) {
    uint32_t back = HR2DI_NOBODY;
    int has = 0;
    status = hr2di_watch_work(v->lint->watch, 1);
    if (!status && sees[k]) status = find_light(v, k, &has);
    if (!status && has) status = hr2di_sees_back(v->viewer, k, LEAST_BACK, &back);
    if (status || back == HR2DI_NOBODY || hr2di_symmetry_is_end(&scene->symmetry, back))
      continue;
    const size_t of = hr2di_scene_original(scene, back);
    if (!v->back.viewers[of]++) v->back.viewer[of] = (uint32_t)k;
  }
  hr2di_alloc_free(&scene->alloc, sees);
  return status;
}

static int is_back_seen(const views *v, size_t patch) {
  return v->back.viewers && v->back.viewers[patch];
}

static hr2d_warning warning_of(hr2d_warning_code code, const hr2di_lint_patches *report) {
  return (hr2d_warning){.code = code,
                        .patches = report->count < 2 ? report->count : 2,
                        .patch = {report->patch[0], report->patch[1]}};
}

static hr2d_status warn_of_dark(const views *v) {
  const hr2d_scene *scene = v->lint->scene;
  hr2di_lint_patches dark = {0};
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < hr2di_scene_cell(scene) && scene->dark && v->lit && !status; k++) {
    status = hr2di_watch_work(v->lint->watch, 1);
    if (scene->dark[k] && !has_other_side(v, k, 1)) hr2di_lint_add(&dark, k);
  }
  if (status || !dark.count) return status;
  return hr2di_lint_warn(
      v->lint, warning_of(HR2D_WARNING_UNLIT, &dark),
      "no light reaches the front of %s: if it should see the light, " HR2DI_LINT_TURN,
      hr2di_lint_labels(scene, &dark).text);
}

/* Backs that are seen, all of them at once: whose, of what, and what to do. */
static hr2d_status warn_of_backs(const views *v) {
  const hr2d_scene *scene = v->lint->scene;
  const size_t count = v->backs.count, patch = v->backs.patch[0];
  char more[40] = "";
  if (!count) return HR2D_OK;
  const size_t viewers = v->back.viewers[patch], first = v->back.viewer[patch];
  if (count > 1) snprintf(more, sizeof more, ", and others");
  if (count == 1 && viewers > 1) snprintf(more, sizeof more, " and of %zu more", viewers - 1);
  return hr2di_lint_warn(
      v->lint,
      (hr2d_warning){.code = HR2D_WARNING_SEES_BACK, .patches = 2, .patch = {patch, first}},
      "the back%s of %s stand%s in front of %s%s: backs are black and take all light, which is "
      "lost; write \"sides\": \"both\", %sor draw a patch of its own on that side",
      count > 1 ? "s" : "", hr2di_lint_labels(scene, &v->backs).text, count > 1 ? "" : "s",
      hr2di_patch_label(scene, first).text, more,
      scene->patch[patch].looks_in
          ? "or \"faces\": \"out\" for a polygon that is seen from outside, "
          : "");
}

static hr2d_status warn_of_nothing(const views *v) {
  if (!v->nothing.count) return HR2D_OK;
  return hr2di_lint_warn(
      v->lint, warning_of(HR2D_WARNING_SEES_NOTHING, &v->nothing),
      "no patch%s is seen from the front of %s: if one should be, " HR2DI_LINT_TURN,
      v->sky ? " and no sky" : "", hr2di_lint_labels(v->lint->scene, &v->nothing).text);
}

/* Of patches without light the other warnings tell, unless nothing has light. */
static hr2d_status view_from(views *v, size_t patch) {
  const hr2d_scene *scene = v->lint->scene;
  int sees = 1;
  hr2d_status status = hr2di_watch_work(v->lint->watch, 1);
  const int asked = v->sky || emits(scene, patch) || (!v->lit && is_back_seen(v, patch));
  if (!status && asked && !(v->sky && has_other_side(v, patch, 0)))
    status = hr2di_any_visible(v->viewer, patch,
                               HR2DI_ANY_FRONTS | (v->sky ? HR2DI_ANY_SKY : 0), &sees);
  if (!status && !sees) {
    hr2di_lint_add(&v->nothing, patch);
    return HR2D_OK;
  }
  const int dark = v->lit && scene->dark && scene->dark[patch];
  /* A patch whose front sees nothing is told once, not for its back, too. */
  if (!status && v->lit && is_back_seen(v, patch) && !dark) hr2di_lint_add(&v->backs, patch);
  return status;
}

static hr2d_status warn_of_no_sky(views *v) {
  const size_t cell = hr2di_scene_cell(v->lint->scene);
  hr2d_status status = HR2D_OK;
  int sees = !v->sky;
  for (size_t k = 0; k < cell && !sees && !status; k++) {
    status = hr2di_watch_work(v->lint->watch, 1);
    if (!status) status = hr2di_any_visible(v->viewer, k, HR2DI_ANY_SKY, &sees);
  }
  if (status || sees) return status;
  v->blind = 1;
  return hr2di_lint_warn(
      v->lint, (hr2d_warning){.code = HR2D_WARNING_NO_SKY},
      "no front sees the surroundings, so that their light, the "
      "\"background\", \"sky\" or \"sun\", changes nothing: polygons have their fronts "
      "inside; write \"faces\": \"out\" for what is seen from outside");
}

static hr2d_status examine(views *v) {
  hr2d_status status = find_backs(v);
  for (size_t k = 0; k < hr2di_scene_cell(v->lint->scene) && !status; k++)
    status = view_from(v, k);
  if (!status) status = warn_of_backs(v);
  if (!status) status = warn_of_nothing(v);
  return status ? status : warn_of_no_sky(v);
}

/* Where it is unclear how patches cross, there is no plane to look through, and no warning but
   of patches without light. */
hr2d_status hr2di_lint_views(const hr2di_lint *lint, int *blind) {
  const hr2d_scene *scene = lint->scene;
  views v = {.lint = lint,
             .sky = scene->effect[HR2D_EFFECT_BACKGROUND].called_for,
             .lit = scene->effect[HR2D_EFFECT_EMISSION].called_for};
  hr2di_with_plane w;
  hr2d_status status = hr2di_with_plane_init(&w, scene, &scene->alloc, lint->watch);
  w.scene.effect[HR2D_EFFECT_OCCLUSION].on = 1;
  v.in = &w.scene;
  if (!status) status = warn_of_dark(&v);
  if (!status && w.scene.parts.wanted) {
    status = hr2di_point_viewer_create(&w.scene, &scene->alloc, lint->watch, &v.viewer);
    if (!status) status = examine(&v);
    *blind = v.blind;
  }
  hr2di_point_viewer_destroy(v.viewer);
  hr2di_alloc_free(&scene->alloc, v.back.viewer);
  hr2di_alloc_free(&scene->alloc, v.back.viewers);
  hr2di_with_plane_clear(&w);
  return status;
}
