/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the patches that light can reach: from a source over a chain of patches, each of which
   sees the next.  No other patch needs a link. */
#include "base/alloc.h"
#include "occlusion/pair-visibility.h"
#include "scene/near-pairs.h"
#include "scene/scene-impl.h"

/* A search that starts from the sources. */
typedef struct search {
  hr2d_scene *scene;
  hr2di_visibility visibility;
  uint32_t *reached; /* lit patches: sources, then others in the order of the search */
  size_t count;
  uint32_t *left; /* patches that may still be dark */
  size_t lefts;
} search;

static int emits(const hr2d_scene *scene, size_t patch) {
  for (size_t band = 0; band < scene->bands; band++)
    if (hr2d_scene_emission(scene, patch, band) > 0) return 1;
  return 0;
}

/* *seen becomes 1 if i and j see each other, else 0.  Without `exactly` it may be 0 though they
   do. */
static hr2d_status sees(search *s, size_t i, size_t j, int exactly, int *seen) {
  const hr2d_segment p = s->scene->patch[i].scaled, q = s->scene->patch[j].scaled;
  hr2di_shaft shaft;
  hr2d_status status = hr2di_watch_work(s->visibility.watch, 1);
  if (status) return status;
  const hr2di_facing facing = hr2di_facing_of(&p, &q);
  *seen = facing != HR2DI_FACING_NONE;
  if (!s->scene->effect[HR2D_EFFECT_OCCLUSION].on ||
      !hr2di_shaft_init(&shaft, facing, p, q, p, q))
    return HR2D_OK;
  if (!exactly) return hr2di_visibility_quick(&s->visibility, &shaft, seen);
  hr2di_wall_list found = {0};
  hr2di_visibility_class view;
  status = hr2di_visibility_collect(&s->visibility, &shaft, &found, &view);
  if (!status && view == HR2DI_BLOCKED) *seen = 0;
  if (!status && view == HR2DI_PARTIAL)
    status = hr2di_visibility_any(&s->visibility, &shaft, found.wall, found.count, seen);
  hr2di_alloc_free(&s->scene->alloc, found.wall);
  return status;
}

/* Lights patch k if reached[from] sees it. */
static hr2d_status light_up(search *s, size_t from, size_t k, int exactly) {
  unsigned char *dark = s->scene->dark;
  int seen = 0;
  const hr2d_status status = dark[k] ? sees(s, s->reached[from], k, exactly, &seen) : HR2D_OK;
  if (status || !seen) return status;
  dark[k] = 0;
  s->reached[s->count++] = (uint32_t)k;
  return HR2D_OK;
}

/* Lights all dark patches that see reached[from]. */
static hr2d_status spread_from(search *s, size_t from, int exactly) {
  const unsigned char *dark = s->scene->dark;
  size_t kept = 0;
  hr2d_status status = hr2di_watch_work(s->visibility.watch, s->lefts / 64);
  for (size_t k = 0; k < s->lefts && !status; k++) {
    status = light_up(s, from, s->left[k], exactly);
    if (dark[s->left[k]]) s->left[kept++] = s->left[k];
  }
  if (!status) s->lefts = kept;
  return status;
}

/* Lights all dark patches that surely see reached[from] or a patch reached after it. */
static hr2d_status spread_surely(search *s, size_t from) {
  hr2d_status status = HR2D_OK;
  for (size_t k = from; k < s->count && s->count < s->scene->patches && !status; k++)
    status = spread_from(s, k, 0);
  return status;
}

/* Lights what sees a lit patch next to it. */
static hr2d_status spread_near(search *s) {
  hr2di_near_pairs near;
  hr2d_status status = hr2di_near_pairs_init(&near, s->scene, s->visibility.watch);
  for (size_t k = 0; k < s->count && !status; k++) {
    const uint32_t i = s->reached[k];
    for (uint32_t m = near.first[i]; m < near.first[i + 1] && !status; m++)
      status = light_up(s, k, near.other[m], 1);
  }
  hr2di_alloc_free(&s->scene->alloc, near.first);
  hr2di_alloc_free(&s->scene->alloc, near.other);
  return status;
}

/* Most patches see a lit patch next to them, or some lit patch with little in the way.  The
   others are tested exactly against each lit patch. */
static hr2d_status spread(search *s) {
  hr2d_status status = spread_near(s);
  if (!status) status = spread_surely(s, 0);
  for (size_t k = 0; k < s->count && s->count < s->scene->patches && !status; k++) {
    const size_t before = s->count;
    status = spread_from(s, k, 1);
    if (!status) status = spread_surely(s, before);
  }
  return status;
}

/* Whether no search is needed: every patch emits, light from the background may come to any
   patch, or the effect of emission is forced. */
static int all_lit(const hr2d_scene *scene) {
  if (scene->effect[HR2D_EFFECT_EMISSION].forced ||
      scene->effect[HR2D_EFFECT_BACKGROUND].called_for)
    return 1;
  size_t k = 0;
  while (k < scene->patches && emits(scene, k)) k++;
  return k == scene->patches;
}

/* Sources are lit, the others dark. */
static hr2d_status begin(search *s) {
  const size_t n = s->scene->patches;
  s->reached = hr2di_alloc(&s->scene->alloc, n, sizeof *s->reached);
  s->left = hr2di_alloc(&s->scene->alloc, n, sizeof *s->left);
  s->scene->dark = hr2di_alloc_zero(&s->scene->alloc, n, 1);
  if (!s->reached || !s->left || !s->scene->dark) return HR2D_ENOMEM;
  for (size_t k = 0; k < n; k++) {
    s->scene->dark[k] = !emits(s->scene, k);
    if (s->scene->dark[k])
      s->left[s->lefts++] = (uint32_t)k;
    else
      s->reached[s->count++] = (uint32_t)k;
  }
  return hr2di_watch_work(s->visibility.watch, n / 8);
}

hr2d_status hr2di_scene_find_light(hr2d_scene *scene, hr2di_watch *watch) {
  if (all_lit(scene)) return HR2D_OK;
  search s = {.scene = scene};
  hr2di_visibility_init(&s.visibility, &scene->walls, &scene->alloc, watch);
  hr2d_status status = begin(&s);
  if (!status) status = spread(&s);
  const int none_dark = s.count == scene->patches;
  hr2di_visibility_clear(&s.visibility);
  hr2di_alloc_free(&scene->alloc, s.reached);
  hr2di_alloc_free(&scene->alloc, s.left);
  if (status || none_dark) {
    hr2di_alloc_free(&scene->alloc, scene->dark);
    scene->dark = NULL;
  }
  return status ? hr2di_scene_fail(scene, status, watch, "the analysis") : HR2D_OK;
}
