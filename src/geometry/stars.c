/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/stars.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/vector.h"

/* Two roundings for the angles themselves, which add to the bound of stars.h. */
#define NEAR 0x1p-46

/* One full turn. */
#define TURN 6.28318530717958647692

typedef struct spoke {
  hr2d_point at;
  uint32_t segment;
  uint32_t group; /* how many share the point */
} spoke;

typedef struct finder {
  hr2di_stars *stars;
  const hr2d_segment *first;
  size_t count, stride;
  spoke *spoke;
  hr2di_watch *watch;
} finder;

static const hr2d_segment *segment_at(const finder *f, size_t k) {
  return (const void *)((const char *)f->first + k * f->stride);
}

static int by_place(const void *left, const void *right) {
  const spoke *l = left, *r = right;
  const int order = hr2di_point_order(l->at, r->at);
  return order ? order : (l->segment > r->segment) - (l->segment < r->segment);
}

static int by_angle(const void *left, const void *right) {
  const hr2di_ray *l = left, *r = right;
  if (l->angle != r->angle) return l->angle < r->angle ? -1 : 1;
  return (l->segment > r->segment) - (l->segment < r->segment);
}

static hr2d_status sort_ends(finder *f) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < f->count && !status; k++) {
    const hr2d_segment *s = segment_at(f, k);
    if (k % 16 == 0) status = hr2di_watch_work(f->watch, 16);
    f->spoke[2 * k] = (spoke){s->a, (uint32_t)k, 1};
    f->spoke[2 * k + 1] = (spoke){s->b, (uint32_t)k, 1};
  }
  if (!status)
    status = hr2di_sort(f->spoke, 2 * f->count, sizeof *f->spoke, by_place, f->watch);
  return status;
}

/* *most becomes the size of the largest group. */
static hr2d_status count_groups(finder *f, uint32_t *max) {
  hr2d_status status = HR2D_OK;
  *max = 0;
  for (size_t k = 0, end; k < 2 * f->count && !status; k = end) {
    for (end = k; end < 2 * f->count && hr2di_point_same(f->spoke[end].at, f->spoke[k].at);)
      end++;
    for (size_t m = k; m < end; m++) f->spoke[m].group = (uint32_t)(end - k);
    if (end - k > *max) *max = (uint32_t)(end - k);
    status = hr2di_watch_work(f->watch, 1 + (end - k) / 8);
  }
  return status;
}

static hr2d_status reserve(finder *f) {
  hr2di_stars *s = f->stars;
  s->star = hr2di_alloc(s->alloc, f->count / HR2DI_STAR_LEAST * 2 + 1, sizeof *s->star);
  s->ray = hr2di_alloc(s->alloc, f->count, sizeof *s->ray);
  s->member = hr2di_alloc(s->alloc, f->count, sizeof *s->member);
  s->of = hr2di_alloc_zero(s->alloc, f->count, sizeof *s->of);
  s->place = hr2di_alloc(s->alloc, f->count, sizeof *s->place);
  return s->star && s->ray && s->member && s->of && s->place ? HR2D_OK : HR2D_ENOMEM;
}

/* `of` has the size of the larger group of each segment, then its star. */
static hr2d_status choose_groups(finder *f) {
  uint32_t *of = f->stars->of;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < 2 * f->count && !status; k++) {
    const spoke *s = &f->spoke[k];
    if (k % 16 == 0) status = hr2di_watch_work(f->watch, 4);
    if (s->group > of[s->segment]) of[s->segment] = s->group;
  }
  return status;
}

static void add_ray(finder *f, hr2di_star *star, const spoke *at) {
  hr2di_stars *s = f->stars;
  const hr2d_segment *p = segment_at(f, at->segment);
  const hr2d_point far = hr2di_point_same(p->a, at->at) ? p->b : p->a;
  const double dx = far.x - at->at.x, dy = far.y - at->at.y;
  s->member[star->last] = at->segment;
  s->ray[star->last++] = (hr2di_ray){atan2(dy, dx), at->segment};
  star->near = fmax(star->near, NEAR * fmax(1 / hypot(dx, dy), 0x1p+29));
}

/* The spokes [k, end) share a point.  Those become its star that chose this group, and not one
   before: their mark is above all sizes of groups then. */
static hr2d_status add_star(finder *f, unsigned char *taken, size_t k, size_t end) {
  hr2di_stars *s = f->stars;
  hr2d_status status = HR2D_OK;
  const uint32_t first = s->count ? s->star[s->count - 1].last : 0;
  hr2di_star star = {first, first, 0};
  for (size_t m = k; m < end && !status; m++) {
    const uint32_t segment = f->spoke[m].segment;
    status = hr2di_watch_work(f->watch, 2);
    if (taken[segment] || s->of[segment] != f->spoke[m].group) continue;
    taken[segment] = 1;
    add_ray(f, &star, &f->spoke[m]);
  }
  if (star.last > star.first) s->star[s->count++] = star;
  return status;
}

static hr2d_status add_stars(finder *f) {
  unsigned char *taken = hr2di_alloc_zero(f->stars->alloc, f->count, 1);
  if (!taken) return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < 2 * f->count && !status; k += f->spoke[k].group) {
    status = hr2di_watch_work(f->watch, 1);
    if (!status && f->spoke[k].group >= HR2DI_STAR_LEAST)
      status = add_star(f, taken, k, k + f->spoke[k].group);
  }
  hr2di_alloc_free(f->stars->alloc, taken);
  return status;
}

/* Sorts the rays of each star, and tells segments where they are. */
static hr2d_status sort_rays(finder *f) {
  hr2di_stars *s = f->stars;
  hr2d_status status = hr2di_watch_work(f->watch, f->count / 8);
  for (size_t k = 0; k < f->count; k++) s->of[k] = HR2DI_NO_STAR;
  for (uint32_t n = 0; n < s->count && !status; n++) {
    const hr2di_star *star = &s->star[n];
    status = hr2di_sort(&s->ray[star->first], star->last - star->first, sizeof *s->ray,
                        by_angle, f->watch);
    for (uint32_t m = star->first; m < star->last && !status; m++) {
      if (m % 16 == 0) status = hr2di_watch_work(f->watch, 4);
      s->of[s->ray[m].segment] = n;
      s->place[s->ray[m].segment] = m;
    }
  }
  return status;
}

hr2d_status hr2di_stars_init(hr2di_stars *stars, const hr2d_allocator *alloc,
                             const hr2d_segment *first, size_t count, size_t stride,
                             hr2di_watch *watch) {
  *stars = (hr2di_stars){.alloc = alloc};
  finder f = {stars, first, count, stride, NULL, watch};
  if (count < HR2DI_STAR_LEAST) return HR2D_OK;
  if (count > UINT32_MAX / 4) return HR2D_ENOMEM;
  f.spoke = hr2di_alloc(alloc, count, 2 * sizeof *f.spoke);
  uint32_t max = 0;
  hr2d_status status = f.spoke ? sort_ends(&f) : HR2D_ENOMEM;
  if (!status) status = count_groups(&f, &max);
  if (!status && max >= HR2DI_STAR_LEAST) {
    status = reserve(&f);
    if (!status) status = choose_groups(&f);
    if (!status) status = add_stars(&f);
    if (!status) status = sort_rays(&f);
  }
  hr2di_alloc_free(alloc, f.spoke);
  return status;
}

void hr2di_stars_clear(hr2di_stars *stars) {
  if (!stars->alloc) return;
  hr2di_alloc_free(stars->alloc, stars->star);
  hr2di_alloc_free(stars->alloc, stars->ray);
  hr2di_alloc_free(stars->alloc, stars->member);
  hr2di_alloc_free(stars->alloc, stars->of);
  hr2di_alloc_free(stars->alloc, stars->place);
  *stars = (hr2di_stars){0};
}

void hr2di_stars_neighbours(const hr2di_stars *stars, uint32_t segment,
                            void (*take)(void *ctx, uint32_t other), void *ctx) {
  const hr2di_star *star = &stars->star[stars->of[segment]];
  const uint32_t place = stars->place[segment];
  const double own = stars->ray[place].angle;
  for (int step = -1; step <= 1; step += 2)
    for (uint32_t k = place;;) {
      const int wraps = step > 0 ? k + 1 == star->last : k == star->first;
      k = wraps ? (step > 0 ? star->first : star->last - 1) : (uint32_t)((int64_t)k + step);
      const double angle = fabs(stars->ray[k].angle - own);
      if (k == place) break;
      take(ctx, stars->ray[k].segment);
      if (fmin(angle, TURN - angle) > star->near) break;
    }
}
