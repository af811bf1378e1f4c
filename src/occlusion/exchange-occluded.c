/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exchange area of two segments with occluders between them. */
#include <hr2d/visibility.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sized-struct.h"
#include "geometry/predicates.h"
#include "occlusion/pair-visibility.h"

static double largest(hr2d_segment s) {
  return fmax(fmax(fabs(s.a.x), fabs(s.a.y)), fmax(fabs(s.b.x), fabs(s.b.y)));
}

static int is_finite(hr2d_segment s) {
  return isfinite(s.a.x) && isfinite(s.a.y) && isfinite(s.b.x) && isfinite(s.b.y);
}

/* Divides by 2^exponent; 0 if that loses a digit. */
static int scale(double *value, int exponent) {
  const double given = *value;
  *value = ldexp(given, -exponent);
  return ldexp(*value, exponent) == given;
}

static int scale_segment(hr2d_segment *s, int exponent) {
  return scale(&s->a.x, exponent) & scale(&s->a.y, exponent) & scale(&s->b.x, exponent) &
         scale(&s->b.y, exponent);
}

/* i, j and the occluders in units of 2^*exponent, so that the largest coordinate lies in
   [1,2). */
static hr2d_status normalise(hr2d_segment *segment, size_t count, int *exponent) {
  double most = 0;
  for (size_t k = 0; k < count; k++) {
    if (!is_finite(segment[k])) return HR2D_EINVAL;
    most = fmax(most, largest(segment[k]));
  }
  *exponent = most > 0 ? ilogb(most) : 0;
  int exact = 1;
  for (size_t k = 0; k < count; k++) exact &= scale_segment(&segment[k], *exponent);
  return exact ? HR2D_OK : HR2D_ERANGE;
}

/* Which of two segments comes first, so that swapping them changes no bit. */
static int comes_first(const hr2d_segment *i, const hr2d_segment *j) {
  if (i->a.x != j->a.x) return i->a.x < j->a.x;
  if (i->a.y != j->a.y) return i->a.y < j->a.y;
  if (i->b.x != j->b.x) return i->b.x < j->b.x;
  return i->b.y <= j->b.y;
}

static hr2d_status integrate(hr2di_visibility *sight, hr2d_segment i, hr2d_segment j,
                             double *area) {
  hr2di_shaft shaft;
  hr2di_wall_list list = {0};
  hr2di_visibility_class view;
  int open;
  *area = 0;
  if (!hr2di_shaft_init(&shaft, hr2di_facing_of(&i, &j), i, j, i, j)) {
    *area = hr2d_exchange_area(&i, &j);
    return HR2D_OK;
  }
  hr2d_status status = hr2di_visibility_collect(sight, &shaft, &list, &view);
  if (!status && view == HR2DI_CLEAR) *area = hr2d_exchange_area(&i, &j);
  if (!status && view == HR2DI_PARTIAL)
    status = hr2di_visibility_area(sight, &shaft, list.wall, list.count, area, &open);
  hr2di_alloc_free(&sight->alloc, list.wall);
  return status;
}

/* The same with occluders, for segments i, j, occluders in this order. */
static hr2d_status integrate_scaled(hr2d_segment *segment, size_t count,
                                    const hr2d_allocator *alloc, hr2di_watch *watch,
                                    double *area) {
  int exponent;
  hr2d_status status = hr2di_watch_work(watch, count / 4);
  if (!status) status = normalise(segment, count, &exponent);
  if (status) return status;
  hr2di_walls walls;
  hr2di_visibility sight;
  double scaled = 0;
  status = hr2di_walls_init(&walls, alloc, segment + 2, count - 2, watch);
  hr2di_visibility_init(&sight, &walls, alloc, watch);
  if (!status) status = integrate(&sight, segment[0], segment[1], &scaled);
  /* Roundings of far coordinates may exceed all there is of a small pair. */
  scaled = fmin(scaled, hr2d_exchange_area(&segment[0], &segment[1]));
  if (!status) *area = ldexp(scaled, exponent);
  hr2di_visibility_clear(&sight);
  hr2di_walls_clear(&walls);
  return status;
}

hr2d_status hr2d_exchange_area_past(const hr2d_segment *i, const hr2d_segment *j,
                                    const hr2d_segment *occluder, size_t count,
                                    const hr2d_past_options *given, double *area) {
  hr2d_past_options options = {.struct_size = sizeof options};
  if (given) hr2di_sized_copy(&options, sizeof options, given);
  const hr2d_allocator used = options.alloc ? *options.alloc : hr2di_alloc_default();
  if (count == 0) {
    if (!is_finite(*i) || !is_finite(*j)) return HR2D_EINVAL;
    *area = hr2d_exchange_area(i, j);
    return HR2D_OK;
  }
  if (count > SIZE_MAX - 2) return HR2D_ENOMEM;
  hr2d_segment *segment = hr2di_alloc(&used, count + 2, sizeof *segment);
  if (!segment) return HR2D_ENOMEM;
  const int in_order = comes_first(i, j);
  segment[0] = in_order ? *i : *j;
  segment[1] = in_order ? *j : *i;
  memcpy(segment + 2, occluder, count * sizeof *segment);
  hr2di_watch watch;
  hr2di_watch_init(&watch, options.progress, options.progress_ctx, "factors");
  const hr2d_status status = integrate_scaled(segment, count + 2, &used, &watch, area);
  hr2di_alloc_free(&used, segment);
  return status;
}

hr2d_status hr2d_exchange_area_occluded(const hr2d_segment *i, const hr2d_segment *j,
                                        const hr2d_segment *occluder, size_t count,
                                        const hr2d_allocator *alloc, double *area) {
  const hr2d_past_options options = {.struct_size = sizeof options, .alloc = alloc};
  return hr2d_exchange_area_past(i, j, occluder, count, &options, area);
}
