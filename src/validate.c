/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Commit's checks of the patches against each other, and their common scale. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "alloc.h"
#include "scene-impl.h"

hr2d_status hr2di_check_bands(hr2d_scene *scene) {
  size_t bands = 1, setter = 0;
  for (size_t k = 0; k < scene->patches; k++) {
    const hr2di_patch *p = &scene->patch[k];
    const size_t count[] = {p->emission_bands, p->reflectance_bands};
    for (int c = 0; c < 2; c++) {
      if (count[c] <= 1) continue;
      if (bands > 1 && count[c] != bands)
        return hr2di_fail(
            &scene->message, HR2D_ESCENE, "%s has %zu bands of %s where %s has %zu bands",
            hr2di_patch_label(scene, k).text, count[c], c ? "reflectance" : "emission",
            hr2di_patch_label(scene, setter).text, bands);
      if (bands == 1) setter = k;
      bands = count[c];
    }
  }
  scene->bands = bands;
  return HR2D_OK;
}

/* Divides by 2^exponent; 0 if that loses a digit. */
static int scale_point(hr2d_point given, int exponent, hr2d_point *scaled) {
  scaled->x = ldexp(given.x, -exponent);
  scaled->y = ldexp(given.y, -exponent);
  return ldexp(scaled->x, exponent) == given.x && ldexp(scaled->y, exponent) == given.y;
}

static double largest_coordinate(const hr2d_scene *scene) {
  double most = 0;
  for (size_t k = 0; k < scene->patches; k++) {
    const hr2d_segment s = scene->patch[k].given;
    most = fmax(most, fmax(fmax(fabs(s.a.x), fabs(s.a.y)), fmax(fabs(s.b.x), fabs(s.b.y))));
  }
  return most;
}

/* Scaling by a power of two is exact unless a coordinate becomes subnormal. */
hr2d_status hr2di_scale(hr2d_scene *scene) {
  scene->exponent = ilogb(largest_coordinate(scene));
  for (size_t k = 0; k < scene->patches; k++) {
    hr2di_patch *p = &scene->patch[k];
    if (!scale_point(p->given.a, scene->exponent, &p->scaled.a) ||
        !scale_point(p->given.b, scene->exponent, &p->scaled.b))
      return hr2di_fail(&scene->message, HR2D_ERANGE,
                        "%s: its coordinates are too small beside the largest of the scene, "
                        "about %g",
                        hr2di_patch_label(scene, k).text, ldexp(1, scene->exponent));
    p->length = hypot(p->scaled.b.x - p->scaled.a.x, p->scaled.b.y - p->scaled.a.y);
    if (!isfinite(ldexp(p->length, scene->exponent)))
      return hr2di_fail(&scene->message, HR2D_ERANGE, "%s: its length is beyond a double",
                        hr2di_patch_label(scene, k).text);
  }
  return HR2D_OK;
}

/* The segments meet in one point that is inside both. */
static int cross(const hr2d_segment *i, const hr2d_segment *j) {
  return hr2d_orientation(i->a, i->b, j->a) * hr2d_orientation(i->a, i->b, j->b) < 0 &&
         hr2d_orientation(j->a, j->b, i->a) * hr2d_orientation(j->a, j->b, i->b) < 0;
}

/* The segments lie on one line, point the same way and share more than a point.
   Opposite ones stand back to back, which is no harm. */
static int overlap(const hr2d_segment *i, const hr2d_segment *j) {
  if (hr2d_orientation(i->a, i->b, j->a) != 0 || hr2d_orientation(i->a, i->b, j->b) != 0)
    return 0;
  const int by_x = fabs(i->b.x - i->a.x) >= fabs(i->b.y - i->a.y);
  double ia = by_x ? i->a.x : i->a.y, ib = by_x ? i->b.x : i->b.y;
  double ja = by_x ? j->a.x : j->a.y, jb = by_x ? j->b.x : j->b.y;
  if ((ib > ia) != (jb > ja)) return 0;
  return fmax(fmin(ia, ib), fmin(ja, jb)) < fmin(fmax(ia, ib), fmax(ja, jb));
}

static int boxes_meet_in_y(const hr2d_segment *i, const hr2d_segment *j) {
  return fmin(i->a.y, i->b.y) <= fmax(j->a.y, j->b.y) &&
         fmin(j->a.y, j->b.y) <= fmax(i->a.y, i->b.y);
}

typedef struct span {
  double from, to; /* in x */
  size_t patch;
} span;

static int by_start(const void *left, const void *right) {
  const span *l = left, *r = right;
  if (l->from != r->from) return l->from < r->from ? -1 : 1;
  return (l->patch > r->patch) - (l->patch < r->patch);
}

static hr2d_status check_pair(hr2d_scene *scene, size_t i, size_t j) {
  const hr2d_segment *s = &scene->patch[i].scaled, *t = &scene->patch[j].scaled;
  if (!boxes_meet_in_y(s, t)) return HR2D_OK;
  const char *what = cross(s, t) ? "cross" : overlap(s, t) ? "overlap" : NULL;
  if (!what) return HR2D_OK;
  if (i > j) return check_pair(scene, j, i);
  return hr2di_fail(&scene->message, HR2D_ESCENE, "%s and %s %s",
                    hr2di_patch_label(scene, i).text, hr2di_patch_label(scene, j).text, what);
}

/* Only patches whose spans in x meet are compared. */
hr2d_status hr2di_check_overlaps(hr2d_scene *scene) {
  const size_t n = scene->patches;
  span *spans = hr2di_alloc(&scene->alloc, n, sizeof *spans);
  if (!spans) return hr2di_fail(&scene->message, HR2D_ENOMEM, "out of memory for the checks");
  for (size_t k = 0; k < n; k++) {
    const hr2d_segment s = scene->patch[k].scaled;
    spans[k] = (span){fmin(s.a.x, s.b.x), fmax(s.a.x, s.b.x), k};
  }
  qsort(spans, n, sizeof *spans, by_start);
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < n && !status; k++)
    for (size_t m = k + 1; m < n && spans[m].from <= spans[k].to && !status; m++)
      status = check_pair(scene, spans[k].patch, spans[m].patch);
  hr2di_free(&scene->alloc, spans);
  return status;
}
