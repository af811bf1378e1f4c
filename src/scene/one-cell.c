/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches that were drawn some periods apart are brought together: patch P and T^n P make the
   same endless scene.  Images are taken up to number K, and what is behind them is extrapolated
   as a series in 1/k; both count from the patches to each other, and know nothing of n. Patches
   whose middles are within half a period of a common one stay where they are, which is so in
   any cell that was drawn as one. */
#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"

/* So much more than half a period is a rounding. */
#define HALF (.5 + 1e-9)

/* Along the period, in periods. */
static double along(hr2d_point d, hr2d_point p) {
  const double size = hypot(d.x, d.y);
  return p.x / size * (d.x / size) + p.y / size * (d.y / size);
}

static double middle_of(hr2d_point d, hr2d_segment s) {
  return .5 * along(d, s.a) + .5 * along(d, s.b);
}

/* A mirror across the period has the cell on one side; else it is about the middle of all. */
static double centre_of(const hr2d_scene *scene) {
  const hr2di_generators *by = &scene->symmetry.by;
  const hr2d_point d = by->period;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (size_t m = 0; m < by->mirrors; m++)
    if (fabs(by->along[m].x * d.x + by->along[m].y * d.y) < .5 * hypot(d.x, d.y))
      return along(d, by->at[m]);
  for (size_t k = 0; k < scene->patches; k++) {
    low = fmin(low, middle_of(d, scene->patch[k].given));
    high = fmax(high, middle_of(d, scene->patch[k].given));
  }
  return .5 * low + .5 * high;
}

/* p + n·d, with one rounding. */
static hr2d_point moved(hr2d_point p, double n, hr2d_point d) {
  return (hr2d_point){fma(n, d.x, p.x), fma(n, d.y, p.y)};
}

static hr2d_status keep_added(hr2d_scene *scene) {
  hr2di_symmetry *s = &scene->symmetry;
  s->added = hr2di_alloc(&scene->alloc, scene->patches, sizeof *s->added);
  for (size_t k = 0; k < scene->patches && s->added; k++) s->added[k] = scene->patch[k].given;
  return s->added ? HR2D_OK : HR2D_ENOMEM;
}

hr2d_status hr2di_scene_make_one_cell(hr2d_scene *scene, hr2di_watch *watch) {
  hr2di_symmetry *s = &scene->symmetry;
  if (!s->by.periodic) return HR2D_OK;
  const hr2d_point d = s->by.period;
  const double centre = centre_of(scene);
  hr2d_status status = hr2di_watch_work(watch, scene->patches / 4);
  for (size_t k = 0; k < scene->patches && !status; k++) {
    hr2d_segment *at = &scene->patch[k].given;
    const double off = middle_of(d, *at) - centre;
    if (fabs(off) <= HALF || !isfinite(off)) continue;
    if (!s->added) status = keep_added(scene);
    if (status) break;
    *at = (hr2d_segment){moved(at->a, -rint(off), d), moved(at->b, -rint(off), d)};
  }
  return status ? hr2di_scene_fail(scene, status, watch, "the cell") : HR2D_OK;
}
