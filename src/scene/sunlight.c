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
   not end at their borders. */
enum { MOST_PARTS = 16, MOST_KINKS = 16 };

typedef struct finder {
  hr2di_sunlight *light;
  const hr2d_scene *scene;
  hr2d_point way;
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
  const double across = p->length * hr2di_sun_cosine(f->way, p->scaled);
  return fmin(ALIKE, 4 * HR2DI_TOUCH / across);
}

/* Joins the parts from `first` on, and drops slivers. */
static hr2d_status settle(const finder *f, size_t first, hr2di_watch *watch) {
  hr2di_sunlight *l = f->light;
  size_t kept = first;
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
static hr2d_status look_from_edge(finder *f, hr2di_sun_beams *beams, double bearing) {
  hr2di_sunlight *l = f->light;
  const size_t first = l->parts;
  const hr2d_point e = hr2di_sky_direction(bearing);
  f->way = (hr2d_point){-e.x, -e.y};
  hr2d_status status = hr2di_sun_beams_walk(beams, f->way);
  if (!status) status = settle(f, first, beams->watch);
  if (!status)
    status = add_borders((border_list){&l->kink, &l->kinks, &l->kink_room}, l, first, f->scene,
                         beams->watch);
  l->parts = first;
  return status;
}

static hr2d_status find_kinks(finder *f, hr2di_sun_beams *beams) {
  const hr2di_sky *sky = &f->scene->sky;
  hr2di_sunlight *l = f->light;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < sky->pieces && !status; k++) {
    status = look_from_edge(f, beams, sky->piece[k].from);
    if (!status) status = look_from_edge(f, beams, sky->piece[k].to);
  }
  if (!status) status = unite((border_list){&l->kink, &l->kinks, &l->kink_room}, beams->watch);
  if (l->kinks / MOST_KINKS > f->scene->patches) l->kinks = 0;
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
    f.way = sun->direction;
    if (sun->irradiance > 0) status = hr2di_sun_beams_walk(&beams, sun->direction);
    if (!status) status = settle(&f, light->of_sun[k], watch);
    light->of_sun[k + 1] = light->parts;
  }
  if (!status) status = find_borders(light, scene, watch);
  if (!status) status = find_kinks(&f, &beams);
  hr2di_sun_beams_clear(&beams);
  return status;
}

void hr2di_sunlight_clear(hr2di_sunlight *light, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, light->part);
  hr2di_alloc_free(alloc, light->of_sun);
  hr2di_alloc_free(alloc, light->border);
  hr2di_alloc_free(alloc, light->kink);
  *light = (hr2di_sunlight){0};
}

const hr2di_lit_part *hr2di_sunlight_of(const hr2d_scene *scene, size_t patch, size_t band,
                                        size_t *count) {
  const hr2di_sunlight *l = &scene->sunlight;
  *count = 0;
  if (l->suns == 0) return NULL;
  const size_t sun = l->suns == 1 ? 0 : band, end = l->of_sun[sun + 1];
  size_t low = l->of_sun[sun], high = end;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (l->part[middle].patch < patch)
      low = middle + 1;
    else
      high = middle;
  }
  while (low + *count < end && l->part[low + *count].patch == patch) ++*count;
  return l->part + low;
}

const hr2di_sun_border *hr2di_sunlight_borders(const hr2d_scene *scene, size_t patch,
                                               size_t *count) {
  const hr2di_sunlight *l = &scene->sunlight;
  size_t low = 0, high = l->borders;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (l->border[middle].patch < patch)
      low = middle + 1;
    else
      high = middle;
  }
  for (*count = 0; low + *count < l->borders && l->border[low + *count].patch == patch;)
    ++*count;
  return *count > 0 ? l->border + low : NULL;
}

double hr2di_sunlight_full(const hr2d_scene *scene, size_t patch, size_t band) {
  const hr2d_sun sun = hr2d_scene_sun(scene, band);
  if (!(sun.irradiance > 0)) return 0;
  return sun.irradiance * fmax(hr2di_sun_cosine(sun.direction, scene->patch[patch].scaled), 0);
}

int hr2di_sunlight_at(const hr2d_scene *scene, size_t patch, size_t band, double t) {
  size_t count;
  const hr2di_lit_part *part = hr2di_sunlight_of(scene, patch, band, &count);
  size_t k = 0;
  while (k + 1 < count && t >= part[k].to) k++;
  return k < count && t >= part[k].from && t <= part[k].to;
}
