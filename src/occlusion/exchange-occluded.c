/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exchange area of two segments with occluders between them. */
#include <hr2d/visibility.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sized-struct.h"
#include "base/watch.h"
#include "geometry/predicates.h"
#include "occlusion/area-past-hulls.h"

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
  double max = 0;
  for (size_t k = 0; k < count; k++) {
    if (!is_finite(segment[k])) return HR2D_EINVAL;
    max = fmax(max, largest(segment[k]));
  }
  *exponent = max > 0 ? ilogb(max) : 0;
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

/* The screens of the occluders.  Each may hide all; then there is no need for others. */
static hr2d_status find_screens(const hr2di_opening *o, const hr2d_segment *occluder,
                                size_t count, hr2di_clipped_occluder *screen, size_t *clipped,
                                int *blocked, hr2di_watch *watch) {
  *clipped = 0;
  *blocked = 0;
  for (size_t k = 0; k < count && !*blocked; k++) {
    hr2di_clipped_occluder *s = &screen[*clipped];
    if (hr2di_watch_work(watch, 1)) return hr2di_watch_status(watch);
    *clipped += (size_t)hr2di_clipped_occluder_of(s, o, occluder[k]);
    *blocked = s->joins == (HR2DI_JOINS_RIGHT | HR2DI_JOINS_LEFT);
  }
  return HR2D_OK;
}

/* The same past screens, at least one. */
static hr2d_status pass(const hr2di_opening *o, hr2di_clipped_occluder *screen, size_t count,
                        const hr2d_allocator *alloc, hr2di_watch *watch, double *area) {
  hr2di_occluder_hulls hulls;
  double past = 0;
  int all = 0;
  hr2d_status status = hr2di_occluder_hulls_init(&hulls, alloc, o, screen, count, watch);
  if (!status && !hulls.blocked) status = hr2di_past_clumps(o, &hulls, &past, &all);
  hr2di_occluder_hulls_clear(&hulls);
  if (!all) *area = fmin(past, *area);
  return status;
}

/* The exchange area of two segments past others; coordinates are below 2. */
static hr2d_status integrate(const hr2d_segment *segment, size_t count,
                             const hr2d_allocator *alloc, hr2di_watch *watch, double *area) {
  hr2di_opening opening;
  size_t clipped;
  int blocked;
  *area = hr2d_exchange_area(&segment[0], &segment[1]);
  const hr2di_facing facing = hr2di_facing_of(&segment[0], &segment[1]);
  if (!hr2di_opening_init(&opening, facing, segment[0], segment[1])) return HR2D_OK;
  hr2di_clipped_occluder *screen = hr2di_alloc(alloc, count, sizeof *screen);
  if (!screen) return HR2D_ENOMEM;
  hr2d_status status =
      find_screens(&opening, segment + 2, count - 2, screen, &clipped, &blocked, watch);
  if (blocked)
    *area = 0;
  else if (!status && clipped > 0)
    status = pass(&opening, screen, clipped, alloc, watch, area);
  hr2di_alloc_free(alloc, screen);
  return status;
}

/* The same with occluders, for segments i, j, occluders in this order. */
static hr2d_status integrate_scaled(hr2d_segment *segment, size_t count,
                                    const hr2d_allocator *alloc, hr2di_watch *watch,
                                    double *area) {
  int exponent;
  double scaled;
  hr2d_status status = hr2di_watch_work(watch, count / 4);
  if (!status) status = normalise(segment, count, &exponent);
  if (!status) status = integrate(segment, count, alloc, watch, &scaled);
  if (!status) *area = ldexp(scaled, exponent);
  return status;
}

hr2d_status hr2d_exchange_area_past(const hr2d_segment *i, const hr2d_segment *j,
                                    const hr2d_segment *occluder, size_t count,
                                    const hr2d_past_options *given, double *area) {
  if (!i || !j || (count && !occluder) || !area) return HR2D_EINVAL;
  hr2d_past_options options = {.struct_size = sizeof options};
  if (hr2di_sized_copy(&options, sizeof options, given)) return HR2D_EINVAL;
  if (options.alloc && !hr2di_alloc_has_hooks(options.alloc)) return HR2D_EINVAL;
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
