/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams are joined where they touch.  Roundings of the plane may leave gaps and slivers that
   are not there: what is shorter than ALIKE of its patch, and narrower across the light than
   what commit takes for a touch, counts for nothing.

   Suns of the same borders, or nearly so, share them. */
#include "scene/sunlight.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"
#include "scene/sun-beams.h"

#define ALIKE 0x1p-44

/* Borders of several suns that are so near on a patch are one, which moves the light by no more
   of its length. */
#define SAME 1e-14

/* Where all suns together light more parts of patches than these for each patch, elements do
   not end at their borders, and likewise kinks of the sky. */
enum { MOST_PARTS = 16, MOST_KINKS = 16 };

typedef struct finder {
  hr2di_sunlight *light;
  const hr2d_scene *scene;
  hr2d_point direction;
} finder;

static hr2d_status take(void *ctx, uint32_t patch, double from, double to) {
  const finder *f = ctx;
  hr2di_sunlight *l = f->light;
  if (hr2di_alloc_reserve(&f->scene->alloc, &l->part, &l->capacity, l->parts + 1,
                          sizeof *l->part))
    return HR2D_ENOMEM;
  l->part[l->parts++] = (hr2di_lit_part){patch, from, to};
  return HR2D_OK;
}

static int by_place(const void *left, const void *right) {
  const hr2di_lit_part *l = left, *r = right;
  if (l->patch != r->patch) return l->patch < r->patch ? -1 : 1;
  if (l->from != r->from) return l->from < r->from ? -1 : 1;
  return (l->to > r->to) - (l->to < r->to);
}

/* The longest part of a patch that is a rounding. */
static double rounding_on(const finder *f, uint32_t patch) {
  const hr2di_patch *p = &f->scene->patch[patch];
  const double across = p->length * hr2di_sun_cosine(f->direction, p->scaled);
  return fmin(ALIKE, 4 * HR2DI_TOUCH / across);
}

/* Joins the parts from `first` on, and drops slivers. */
static hr2d_status settle(const finder *f, size_t first, hr2di_watch *watch) {
  hr2di_sunlight *l = f->light;
  size_t kept = first;
  if (first == l->parts) return HR2D_OK;
  hr2d_status status =
      hr2di_sort(l->part + first, l->parts - first, sizeof *l->part, by_place, watch);
  for (size_t k = first; k < l->parts && !status;) {
    hr2di_lit_part all = l->part[k];
    const double rounding = rounding_on(f, all.patch);
    for (k++;
         k < l->parts && l->part[k].patch == all.patch && l->part[k].from <= all.to + rounding;
         k++)
      all.to = fmax(all.to, l->part[k].to);
    if (all.from <= rounding) all.from = 0;
    if (all.to >= 1 - rounding) all.to = 1;
    if (all.to - all.from > rounding) l->part[kept++] = all;
    status = hr2di_watch_work(watch, 2);
  }
  l->parts = kept;
  return status;
}

/* A list of borders. */
typedef struct border_list {
  hr2di_sun_border **item;
  size_t *count, *room;
} border_list;

static hr2d_status add_border(border_list to, const hr2d_scene *scene, uint32_t patch,
                              double at) {
  if (!(at > 0 && at < 1)) return HR2D_OK;
  if (hr2di_alloc_reserve(&scene->alloc, to.item, to.room, *to.count + 1, sizeof **to.item))
    return HR2D_ENOMEM;
  (*to.item)[(*to.count)++] =
      (hr2di_sun_border){patch, at, hr2di_point_at(scene->patch[patch].scaled, at)};
  return HR2D_OK;
}

static int by_border(const void *left, const void *right) {
  const hr2di_sun_border *l = left, *r = right;
  if (l->patch != r->patch) return l->patch < r->patch ? -1 : 1;
  return (l->at > r->at) - (l->at < r->at);
}

/* The ends of the parts from `first` on. */
static hr2d_status add_borders(border_list to, const hr2di_sunlight *l, size_t first,
                               const hr2d_scene *scene, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (size_t k = first; k < l->parts && !status; k++) {
    const hr2di_lit_part *p = &l->part[k];
    status = hr2di_watch_work(watch, 1);
    if (!status) status = add_border(to, scene, p->patch, p->from);
    if (!status) status = add_border(to, scene, p->patch, p->to);
  }
  return status;
}

/* Sorts; of those that are the same, one is left. */
static hr2d_status unite(border_list list, hr2di_watch *watch) {
  hr2di_sun_border *border = *list.item;
  size_t kept = 0;
  const hr2d_status status = hr2di_sort(border, *list.count, sizeof *border, by_border, watch);
  for (size_t k = 0; k < *list.count; k++)
    if (kept == 0 || border[k].patch != border[kept - 1].patch ||
        border[k].at - border[kept - 1].at > SAME)
      border[kept++] = border[k];
  *list.count = kept;
  return status;
}

static hr2d_status find_borders(hr2di_sunlight *l, const hr2d_scene *scene,
                                hr2di_watch *watch) {
  const border_list to = {&l->border, &l->borders, &l->border_room};
  if (l->parts / MOST_PARTS > scene->patches) return HR2D_OK;
  const hr2d_status status = add_borders(to, l, 0, scene, watch);
  return status ? status : unite(to, watch);
}

/* The light of a sun at the edge would have its borders where the edge comes into sight. */
static hr2d_status view_from_edge(finder *f, hr2di_sun_beams *beams, double bearing) {
  hr2di_sunlight *l = f->light;
  const size_t first = l->parts;
  const hr2d_point e = hr2di_sky_direction(bearing);
  f->direction = (hr2d_point){-e.x, -e.y};
  hr2d_status status = hr2di_sun_beams_walk(beams, f->direction);
  if (!status) status = settle(f, first, beams->watch);
  if (!status)
    status = add_borders((border_list){&l->kink, &l->kinks, &l->kink_room}, l, first, f->scene,
                         beams->watch);
  l->parts = first;
  return status;
}

/* An edge of a piece of the sky. */
typedef struct sky_edge {
  double bearing, jump;
} sky_edge;

static int by_jump(const void *left, const void *right) {
  const sky_edge *l = left, *r = right;
  if (l->jump != r->jump) return l->jump > r->jump ? -1 : 1;
  return (l->bearing > r->bearing) - (l->bearing < r->bearing);
}

/* The edges at which the sky jumps, or a derivative of a continuous one, those with the largest
 * jumps first. */
static hr2d_status list_edges(const hr2d_scene *scene, sky_edge *edge, size_t *count,
                              double *max, hr2di_watch *watch) {
  const hr2di_sky *sky = &scene->sky;
  hr2d_status status = HR2D_OK;
  for (size_t b = 0; b < scene->bands && !status; b++) {
    max[b] = hr2di_sky_max(scene, b);
    status = hr2di_watch_work(watch, 1 + sky->pieces / 16);
  }
  for (size_t k = 0; k < 2 * sky->pieces && !status; k++) {
    sky_edge *e = &edge[*count];
    if (hr2di_sky_edge(scene, k, &e->bearing)) {
      e->jump = hr2di_sky_jump(scene, e->bearing, max);
      *count += e->jump > 0 || hr2di_sky_is_continuous(sky);
    }
    status = hr2di_watch_work(watch, 2 + (sky->pieces + scene->bands) / 8);
  }
  return status ? status : hr2di_sort(edge, *count, sizeof *edge, by_jump, watch);
}

/* Of more edges than elements may end at, those with the smallest jumps are left out. */
static hr2d_status view_from_edges(finder *f, hr2di_sun_beams *beams, const sky_edge *edge,
                                   size_t count) {
  hr2di_sunlight *l = f->light;
  const border_list to = {&l->kink, &l->kinks, &l->kink_room};
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status; k++) {
    const size_t before = l->kinks;
    status = view_from_edge(f, beams, edge[k].bearing);
    if (!status && l->kinks / MOST_KINKS <= f->scene->patches) continue;
    l->kinks = before;
    break;
  }
  return status ? status : unite(to, beams->watch);
}

static hr2d_status find_kinks(finder *f, hr2di_sun_beams *beams) {
  const hr2d_scene *scene = f->scene;
  const size_t edges = 2 * scene->sky.pieces;
  size_t count = 0;
  if (!edges) return HR2D_OK;
  sky_edge *edge = hr2di_alloc(&scene->alloc, edges, sizeof *edge);
  double *max = hr2di_alloc(&scene->alloc, scene->bands, sizeof *max);
  hr2d_status status = edge && max ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = list_edges(scene, edge, &count, max, beams->watch);
  if (!status) status = view_from_edges(f, beams, edge, count);
  hr2di_alloc_free(&scene->alloc, edge);
  hr2di_alloc_free(&scene->alloc, max);
  return status;
}

hr2d_status hr2di_sunlight_init(hr2di_sunlight *light, const hr2d_scene *scene,
                                hr2di_watch *watch) {
  *light = (hr2di_sunlight){.suns = scene->sun_bands};
  light->of_sun = hr2di_alloc(&scene->alloc, light->suns + 1, sizeof *light->of_sun);
  if (!light->of_sun) return HR2D_ENOMEM;
  finder f = {.light = light, .scene = scene};
  hr2di_sun_beams beams = {
      .scene = scene, .alloc = scene->alloc, .watch = watch, .take = take, .ctx = &f};
  hr2d_status status = HR2D_OK;
  light->of_sun[0] = 0;
  for (size_t k = 0; k < light->suns && !status; k++) {
    const hr2d_sun *sun = &scene->sun[k];
    f.direction = sun->direction;
    if (sun->irradiance > 0) status = hr2di_sun_beams_walk(&beams, sun->direction);
    if (!status) status = settle(&f, light->of_sun[k], watch);
    light->of_sun[k + 1] = light->parts;
  }
  if (!status) status = find_borders(light, scene, watch);
  if (!status) status = find_kinks(&f, &beams);
  hr2di_sun_beams_clear(&beams);
  return status;
}
