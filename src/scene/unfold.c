/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The images of the patches, and the ends behind those of a period.

   An end is a line across all that the period sweeps, just behind the images up to K.  Images
   beyond these may reach over it, where the cell is wider than the period: the parts of them
   before the line are black ends, too.  So whatever a patch sees behind the images up to K, it
   sees past an end. */
#include <hr2d/symmetry.h>
#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "scene/scene-impl.h"

/* Images, with the patches themselves, at most. */
#define MOST_PATCHES 1000000

/* Parts of images that reach over an end, at most. */
#define MOST_ENDS 20000

/* A number for k from 0: 0, 1, −1, 2, −2, … */
static int period_of(size_t number) {
  return number % 2 ? (int)(number / 2 + 1) : -(int)(number / 2);
}

static size_t number_of(int periods) {
  return periods > 0 ? 2 * (size_t)periods - 1 : 2 * (size_t)-periods;
}

/* −1 if f turns the period round, else 1. */
static int sign_of(const hr2di_generators *by, unsigned mirrors) {
  int sign = 1;
  for (size_t m = 0; m < by->mirrors && by->periodic; m++) {
    const hr2d_point u = by->along[m], d = by->period;
    if (mirrors >> m & 1 && fabs(u.x * d.y - u.y * d.x) > fabs(u.x * d.x + u.y * d.y))
      sign = -sign;
  }
  return sign;
}

/* (T^k f)⁻¹ = T^(−k) f where f keeps the period, and T^k f where it turns it round. */
static hr2d_status set_motions(hr2d_scene *scene, unsigned copies) {
  hr2di_symmetry *s = &scene->symmetry;
  const size_t reflections = (size_t)1 << s->by.mirrors;
  const size_t steps = s->by.periodic ? 2 * (size_t)copies + 1 : 1;
  s->motions = reflections * steps;
  s->motion = hr2di_alloc(&scene->alloc, s->motions, sizeof *s->motion);
  if (!s->motion) return HR2D_ENOMEM;
  s->copies = copies;
  for (size_t k = 0; k < s->motions; k++) {
    const unsigned mirrors = (unsigned)(k % reflections);
    const int periods = period_of(k / reflections);
    const size_t back = number_of(-periods * sign_of(&s->by, mirrors));
    s->motion[k] = (hr2di_motion){.mirrors = mirrors,
                                  .periods = periods,
                                  .turned = mirrors == 1 || mirrors == 2,
                                  .inverse = (uint32_t)(back * reflections + mirrors),
                                  .weight = 1};
  }
  return HR2D_OK;
}

/* Images that lose this part of their length far from the origin are no images. */
#define SHRUNK 1e-3

static int is_kept(hr2d_segment image, hr2d_segment patch) {
  const double length = hypot(image.b.x - image.a.x, image.b.y - image.a.y);
  const double given = hypot(patch.b.x - patch.a.x, patch.b.y - patch.a.y);
  return fabs(length - given) <= SHRUNK * given;
}

/* The ends of the patches themselves, by x. */
typedef struct ends_of_cell {
  hr2d_point *at;
  size_t count;
  double touch;
} ends_of_cell;

static int by_x(const void *a, const void *b) {
  const hr2d_point *p = a, *q = b;
  if (p->x != q->x) return p->x < q->x ? -1 : 1;
  return (p->y > q->y) - (p->y < q->y);
}

static hr2d_status list_ends(const hr2d_scene *scene, ends_of_cell *ends, hr2di_watch *watch) {
  ends->count = 2 * scene->patches;
  ends->at = hr2di_alloc(&scene->alloc, ends->count, sizeof *ends->at);
  if (!ends->at) return HR2D_ENOMEM;
  for (size_t k = 0; k < scene->patches; k++) {
    ends->at[2 * k] = scene->patch[k].given.a;
    ends->at[2 * k + 1] = scene->patch[k].given.b;
  }
  return hr2di_sort(ends->at, ends->count, sizeof *ends->at, by_x, watch);
}

/* The end of a patch where an end of an image lies but for rounding: beside a step, however
   small, the end of that patch would be hidden. */
static hr2d_point settle(const ends_of_cell *ends, hr2d_point p) {
  size_t low = 0, high = ends->count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (ends->at[middle].x < p.x - ends->touch)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < ends->count && ends->at[low].x <= p.x + ends->touch; low++)
    if (fabs(ends->at[low].y - p.y) <= ends->touch) return ends->at[low];
  return p;
}

static hr2d_status add_image(hr2d_scene *scene, const hr2di_motion *g, size_t patch,
                             const ends_of_cell *ends) {
  const hr2di_generators *by = &scene->symmetry.by;
  hr2di_patch image;
  if (hr2di_patch_copy(&scene->alloc, &scene->patch[patch], 0, &image)) return HR2D_ENOMEM;
  const hr2d_point a = settle(ends, hr2di_symmetry_move(by, g, image.given.a, ends->touch)),
                   b = settle(ends, hr2di_symmetry_move(by, g, image.given.b, ends->touch));
  image.given = g->turned ? (hr2d_segment){b, a} : (hr2d_segment){a, b};
  scene->patch[scene->patches++] = image;
  if (is_kept(image.given, scene->patch[patch].given)) return HR2D_OK;
  return hr2di_message_fail(&scene->message, HR2D_ERANGE,
                            "%s is too small to have an image so far away",
                            hr2di_patch_label(scene, patch).text);
}

hr2d_status hr2di_scene_unfold(hr2d_scene *scene, unsigned copies, hr2di_watch *watch) {
  hr2di_symmetry *s = &scene->symmetry;
  const size_t cell = scene->patches;
  s->cell = cell;
  hr2d_status status = hr2di_scene_make_one_cell(scene, watch);
  if (status) return status;
  ends_of_cell ends = {.touch = hr2di_symmetry_touch(scene)};
  status = set_motions(scene, copies);
  if (!status && s->motions > MOST_PATCHES / cell)
    return hr2di_message_fail(&scene->message, HR2D_ERANGE,
                              "%zu images of %zu patches are too many", s->motions, cell);
  if (!status) status = list_ends(scene, &ends, watch);
  if (!status && hr2di_alloc_reserve(&scene->alloc, &scene->patch, &scene->capacity,
                                     s->motions * cell, sizeof *scene->patch))
    status = HR2D_ENOMEM;
  for (size_t g = 1; g < s->motions && !status; g++)
    for (size_t k = 0; k < cell && !status; k++) {
      status = add_image(scene, &s->motion[g], k, &ends);
      if (!status) status = hr2di_watch_work(watch, 4);
    }
  hr2di_alloc_free(&scene->alloc, ends.at);
  if (status == HR2D_ERANGE) return status;
  if (status) return hr2di_scene_fail(scene, status, watch, "the images");
  hr2di_symmetry_set_weights(s);
  return s->by.periodic ? hr2di_scene_add_ends(scene, watch) : HR2D_OK;
}

/* The extent of some patches along a direction. */
typedef struct extent {
  double low, high;
} extent;

static double along(hr2d_point n, hr2d_point p) {
  return n.x * p.x + n.y * p.y;
}

/* Of the patches and their reflections. */
static extent extent_along(const hr2d_scene *scene, hr2d_point n) {
  const hr2di_symmetry *s = &scene->symmetry;
  extent e = {HUGE_VAL, -HUGE_VAL};
  for (size_t k = 0; k < s->cell << s->by.mirrors; k++) {
    const hr2d_segment at = scene->patch[k].given;
    e.low = fmin(e.low, fmin(along(n, at.a), along(n, at.b)));
    e.high = fmax(e.high, fmax(along(n, at.a), along(n, at.b)));
  }
  return e;
}

/* One of the two ends. */
typedef struct end {
  hr2d_point out; /* away from the patches, of length 1 */
  hr2d_point up;  /* along the line, with `out` on its right */
  double off;     /* of the line, along `out` */
  extent across;  /* what the period sweeps, along `up` */
  double step;    /* the period along `out`, above 0 */
  int sign;       /* of the period along `out` */
  double touch;
} end;

static hr2d_status add_end(hr2d_scene *scene, hr2d_point from, hr2d_point to) {
  hr2d_patch made = HR2D_PATCH_INIT;
  made.a = from;
  made.b = to;
  made.name = "the end of the period";
  scene->symmetry.ends++;
  return hr2di_scene_add(scene, &made, NULL, NULL);
}

/* A stretch of a line that walls cover. */
static int by_low(const void *a, const void *b) {
  const extent *p = a, *q = b;
  return (p->low > q->low) - (p->low < q->low);
}

/* The stretches of the line that patches cover. */
static size_t find_covered(const hr2d_scene *scene, const end *e, extent *covered) {
  const size_t patches = scene->symmetry.motions * scene->symmetry.cell;
  size_t count = 0;
  for (size_t k = 0; k < patches; k++) {
    const hr2d_segment s = scene->patch[k].given;
    if (fabs(along(e->out, s.a) - e->off) > e->touch ||
        fabs(along(e->out, s.b) - e->off) > e->touch)
      continue;
    const double a = along(e->up, s.a), b = along(e->up, s.b);
    covered[count++] = (extent){fmin(a, b), fmax(a, b)};
  }
  if (count > 0) qsort(covered, count, sizeof *covered, by_low);
  return count;
}

static hr2d_point on_line(const end *e, double up) {
  return (hr2d_point){e->off * e->out.x + up * e->up.x, e->off * e->out.y + up * e->up.y};
}

/* The line, less what patches cover of it; its front looks back. */
static hr2d_status add_line(hr2d_scene *scene, const end *e, extent *covered) {
  const size_t count = find_covered(scene, e, covered);
  hr2d_status status = HR2D_OK;
  double from = e->across.low;
  for (size_t k = 0; k <= count && !status; k++) {
    const double to = k < count ? fmin(covered[k].low, e->across.high) : e->across.high;
    if (to - from > e->touch) status = add_end(scene, on_line(e, from), on_line(e, to));
    if (k < count) from = fmax(from, covered[k].high);
  }
  return status;
}

/* Where a segment is cut that is `from` before the line at a and `to` at b.  Both sides of a
   patch ask from the same end, and get the same bits. */
static hr2d_point crossing(hr2d_point a, hr2d_point b, double from, double to) {
  const double part = from / (from - to);
  return (hr2d_point){a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
}

/* The part of a patch, moved by `periods`, that is before the line. */
static hr2d_status add_before(hr2d_scene *scene, const end *e, size_t patch, int periods) {
  const hr2d_point d = scene->symmetry.by.period;
  const hr2d_segment at = scene->patch[patch].given;
  hr2d_point a = {at.a.x + periods * d.x, at.a.y + periods * d.y},
             b = {at.b.x + periods * d.x, at.b.y + periods * d.y};
  const double from = e->off - along(e->out, a), to = e->off - along(e->out, b);
  if (from <= e->touch && to <= e->touch) return HR2D_OK;
  const hr2d_point cut = from < to ? crossing(a, b, from, to) : crossing(b, a, to, from);
  if (to < -e->touch) b = cut;
  if (from < -e->touch) a = cut;
  return add_end(scene, a, b);
}

/* What images behind the last ones have before the line. */
static hr2d_status add_images_before(hr2d_scene *scene, const end *e, double low,
                                     hr2di_watch *watch) {
  const hr2di_symmetry *s = &scene->symmetry;
  const size_t patches = s->cell << s->by.mirrors;
  hr2d_status status = HR2D_OK;
  for (int k = (int)s->copies + 1; low + k * e->step < e->off - e->touch && !status; k++)
    for (size_t p = 0; p < patches && !status; p++) {
      status = hr2di_watch_work(watch, 2);
      if (!status) status = add_before(scene, e, p, e->sign * k);
      if (!status && s->ends > MOST_ENDS)
        return hr2di_message_fail(&scene->message, HR2D_ERANGE,
                                  "the patches reach over too many periods");
    }
  return status;
}

hr2d_status hr2di_scene_add_ends(hr2d_scene *scene, hr2di_watch *watch) {
  hr2di_symmetry *s = &scene->symmetry;
  const hr2d_point d = s->by.period;
  const double size = hypot(d.x, d.y), far = (s->copies + 1) * size;
  const extent strip = extent_along(scene, (hr2d_point){-d.y / size, d.x / size});
  s->low = strip.low;
  s->high = strip.high;
  extent *covered = hr2di_alloc(&scene->alloc, scene->patches, sizeof *covered);
  hr2d_status status = covered ? HR2D_OK : HR2D_ENOMEM;
  for (int sign = 1; sign >= -1 && !status; sign -= 2) {
    const hr2d_point out = {sign * d.x / size, sign * d.y / size};
    const extent cell = extent_along(scene, out);
    end e = {.out = out,
             .up = {-out.y, out.x},
             .off = cell.high + s->copies * size,
             .step = size,
             .sign = sign,
             .touch = 4 * hr2di_symmetry_touch(scene) + 0x1p-49 * far};
    e.off += 0.5 * fmax(size - (cell.high - cell.low), 0);
    e.across = extent_along(scene, e.up);
    s->line[sign > 0] = e.off;
    status = add_line(scene, &e, covered);
    if (!status) status = add_images_before(scene, &e, cell.low, watch);
  }
  hr2di_alloc_free(&scene->alloc, covered);
  return status == HR2D_ENOMEM || status == hr2di_watch_status(watch)
             ? status ? hr2di_scene_fail(scene, status, watch, "the ends of the period")
                      : HR2D_OK
             : status;
}
