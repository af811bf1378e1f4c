/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches that nearly touch.

   The distance of two patches that do not cross is that of an end of one from the other.  A
   sweep over boxes, each larger than its patch by the width of a narrow gap, finds all pairs
   with such an end.  An end is loose if no patch touches it but its own other side.  Where
   short patches lead from the end to the other patch, as around a corner that is rounded, there
   is no opening. */
#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/apart.h"
#include "geometry/crossings.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "lint/lint-impl.h"

/* Patches that close a gap are at most so many times as long as it is wide, and so many. */
enum { LONGEST_LINK = 4, MOST_LINKS = 16 };

/* A gap is at most this part of the shorter one of its patches. */
#define PART_OF_PATCH .05

/* Ends of two patches at an angle that nothing touches are a corner that was missed up to a gap
   so many times as wide: 2 cm in a room of 4 m.  Below this sine of the angle they may be
   panels or slats in a row, and above this part of the shorter one they may be meant. */
#define CORNER          5
#define CORNER_SINE     .5
#define CORNER_OF_PATCH .01

/* End 2·patch + e of a patch, near to another patch. */
typedef struct approach {
  hr2d_point at;
  double distance;
  uint32_t end, to;
  int along;  /* the other end of the patch is near, too */
  int wide;   /* it is a gap only if it is a corner */
  int silent; /* nobody is to be told, nor of others at this end */
} approach;

typedef struct place {
  hr2d_point at;
  uint32_t end;
} place;

typedef struct gaps {
  const hr2di_lint *lint;
  const hr2d_allocator *alloc;
  hr2d_segment *s, *box; /* scaled so that the largest coordinate is below 2 */
  double *reach;
  double narrow;
  int exponent;
  size_t count;
  place *sorted;          /* the ends by their places */
  unsigned char *touched; /* per end: another patch touches it */
  approach *approach;
  size_t approaches, capacity;
} gaps;

static hr2d_point end_at(const gaps *g, uint32_t end) {
  const hr2d_segment *s = &g->s[end / 2];
  return end % 2 ? s->b : s->a;
}

static double length(hr2d_segment s) {
  return hypot(s.b.x - s.a.x, s.b.y - s.a.y);
}

static int is_touch(const gaps *g, size_t i, size_t j, double d) {
  return d <= 2 * hr2di_crossings_rounding(&g->s[i], &g->s[j]);
}

static int by_place(const void *left, const void *right) {
  const place *l = left, *r = right;
  const int c = hr2di_point_order(l->at, r->at);
  return c ? c : (l->end > r->end) - (l->end < r->end);
}

/* By place, the nearest first; then by the numbers of the patches. */
static int by_nearness(const void *left, const void *right) {
  const approach *l = left, *r = right;
  const int c = hr2di_point_order(l->at, r->at);
  if (c) return c;
  if (l->distance != r->distance) return l->distance < r->distance ? -1 : 1;
  if (l->along != r->along) return l->along ? -1 : 1;
  if (l->end != r->end) return l->end < r->end ? -1 : 1;
  return (l->to > r->to) - (l->to < r->to);
}

static int by_patch(const void *left, const void *right) {
  const approach *l = left, *r = right;
  if (l->end != r->end) return l->end < r->end ? -1 : 1;
  return (l->to > r->to) - (l->to < r->to);
}

static int same_wall(hr2d_segment s, hr2d_segment t) {
  return (hr2di_point_same(s.a, t.a) && hr2di_point_same(s.b, t.b)) ||
         (hr2di_point_same(s.a, t.b) && hr2di_point_same(s.b, t.a));
}

/* Up to which distance ends of two patches may be a missed corner. */
static double corner_reach(const gaps *g, hr2d_segment s, hr2d_segment t) {
  const double sine = (s.b.x - s.a.x) * (t.b.y - t.a.y) - (s.b.y - s.a.y) * (t.b.x - t.a.x);
  const double l = length(s), m = length(t);
  if (fabs(sine) < CORNER_SINE * l * m) return 0;
  return fmin(CORNER * g->narrow, CORNER_OF_PATCH * fmin(l, m));
}

/* Whether each of two patches is behind the other, as the sides of a thin plate are, or the
   walls of two rooms: what is between them has no light. */
static int view_separately(hr2d_segment s, hr2d_segment t) {
  return hr2di_orient(s.a, s.b, t.a) <= 0 && hr2di_orient(s.a, s.b, t.b) <= 0 &&
         hr2di_orient(t.a, t.b, s.a) <= 0 && hr2di_orient(t.a, t.b, s.b) <= 0;
}

/* The end of a patch, beside another patch. */
static hr2d_status examine_end(gaps *g, uint32_t end, size_t j) {
  const size_t i = end / 2;
  const hr2d_point p = end_at(g, end), q = end_at(g, end ^ 1);
  const double d = hr2di_apart_from_point(g->s[j], p), max = fmin(g->reach[i], g->reach[j]);
  if (is_touch(g, i, j, d)) {
    g->touched[end] = 1;
    return HR2D_OK;
  }
  if (d > fmax(max, corner_reach(g, g->s[i], g->s[j]))) return HR2D_OK;
  const double other = hr2di_apart_from_point(g->s[j], q);
  if (is_touch(g, i, j, other)) return HR2D_OK; /* a wedge: they meet there */
  const int along = other <= max;
  if (hr2di_alloc_reserve(g->alloc, &g->approach, &g->capacity, g->approaches + 1,
                          sizeof *g->approach))
    return HR2D_ENOMEM;
  g->approach[g->approaches++] = (approach){
      p, d, end, (uint32_t)j, along, d > max, along && view_separately(g->s[i], g->s[j])};
  return HR2D_OK;
}

static hr2d_status examine_pair(void *ctx, size_t i, size_t j) {
  gaps *g = ctx;
  hr2d_status status = HR2D_OK;
  if (same_wall(g->s[i], g->s[j])) return HR2D_OK;
  for (uint32_t e = 0; e < 2 && !status; e++) status = examine_end(g, (uint32_t)(2 * i) + e, j);
  for (uint32_t e = 0; e < 2 && !status; e++) status = examine_end(g, (uint32_t)(2 * j) + e, i);
  return status;
}

static hr2d_status reserve(gaps *g) {
  const size_t n = g->count;
  g->s = hr2di_alloc(g->alloc, n, sizeof *g->s);
  g->box = hr2di_alloc(g->alloc, n, sizeof *g->box);
  g->reach = hr2di_alloc(g->alloc, n, sizeof *g->reach);
  g->sorted = hr2di_alloc(g->alloc, n, 2 * sizeof *g->sorted);
  g->touched = hr2di_alloc_zero(g->alloc, n, 2);
  return g->s && g->box && g->reach && g->sorted && g->touched ? HR2D_OK : HR2D_ENOMEM;
}

static hr2d_status scale(gaps *g) {
  const hr2di_patch *patch = g->lint->scene->patch;
  hr2d_status status = HR2D_OK;
  double max = 0;
  for (size_t k = 0; k < g->count && !status; k++) {
    const hr2d_segment s = patch[k].given;
    status = hr2di_watch_work(g->lint->watch, 1);
    max = fmax(max, fmax(fmax(fabs(s.a.x), fabs(s.a.y)), fmax(fabs(s.b.x), fabs(s.b.y))));
  }
  g->exponent = ilogb(max);
  for (size_t k = 0; k < g->count && !status; k++) {
    const hr2d_segment s = patch[k].given;
    status = hr2di_watch_work(g->lint->watch, 1);
    g->s[k] = (hr2d_segment){{ldexp(s.a.x, -g->exponent), ldexp(s.a.y, -g->exponent)},
                             {ldexp(s.b.x, -g->exponent), ldexp(s.b.y, -g->exponent)}};
  }
  return status;
}

static double extent(const gaps *g) {
  hr2d_point low = g->s[0].a, high = low;
  for (size_t k = 0; k < g->count; k++) {
    const hr2d_segment s = g->s[k];
    low = (hr2d_point){fmin(low.x, fmin(s.a.x, s.b.x)), fmin(low.y, fmin(s.a.y, s.b.y))};
    high = (hr2d_point){fmax(high.x, fmax(s.a.x, s.b.x)), fmax(high.y, fmax(s.a.y, s.b.y))};
  }
  return fmax(high.x - low.x, high.y - low.y);
}

/* Two patches of a star make a wedge, and touch at its point as their neighbours do. */
static hr2d_status sweep(gaps *g) {
  hr2di_stars stars;
  hr2d_status status =
      hr2di_stars_init(&stars, g->alloc, g->s, g->count, sizeof *g->s, g->lint->watch);
  if (!status)
    status = hr2di_crossings_find(g->alloc, g->box, g->count, sizeof *g->box, &stars,
                                  examine_pair, g, g->lint->watch);
  hr2di_stars_clear(&stars);
  return status;
}

static hr2d_status prepare(gaps *g) {
  if (g->count >= UINT32_MAX / 2) return HR2D_ENOMEM;
  hr2d_status status = reserve(g);
  if (!status) status = scale(g);
  if (!status) status = hr2di_watch_work(g->lint->watch, g->count / 4);
  if (status) return status;
  g->narrow = g->lint->gap * extent(g);
  for (size_t k = 0; k < g->count && !status; k++) {
    const hr2d_segment s = g->s[k];
    status = hr2di_watch_work(g->lint->watch, 4);
    g->reach[k] = fmin(g->narrow, PART_OF_PATCH * length(s));
    const double r = fmax(g->reach[k], fmin(CORNER * g->narrow, CORNER_OF_PATCH * length(s)));
    g->box[k] = (hr2d_segment){{fmin(s.a.x, s.b.x) - r, fmin(s.a.y, s.b.y) - r},
                               {fmax(s.a.x, s.b.x) + r, fmax(s.a.y, s.b.y) + r}};
    for (uint32_t e = 0; e < 2; e++)
      g->sorted[2 * k + e] = (place){e ? s.b : s.a, (uint32_t)(2 * k) + e};
  }
  if (!status)
    status = hr2di_sort(g->sorted, 2 * g->count, sizeof *g->sorted, by_place, g->lint->watch);
  return status ? status : sweep(g);
}

/* The first end in the order of places that is at p. */
static size_t first_at(const gaps *g, hr2d_point p) {
  size_t low = 0, high = 2 * g->count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (hr2di_point_order(g->sorted[middle].at, p) < 0)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Whether short patches lead from an end to the patch that it is near to. */
static int is_closed(const gaps *g, const approach *a) {
  hr2d_point reached[MOST_LINKS] = {a->at};
  size_t points = 1;
  for (size_t k = 0; k < points; k++)
    for (size_t m = first_at(g, reached[k]);
         m < 2 * g->count && !hr2di_point_order(g->sorted[m].at, reached[k]); m++) {
      const uint32_t end = g->sorted[m].end;
      const hr2d_point far = end_at(g, end ^ 1);
      if (hr2di_watch_work(g->lint->watch, 1)) return 0;
      if (end / 2 == a->to || length(g->s[end / 2]) > LONGEST_LINK * a->distance) continue;
      if (is_touch(g, end / 2, a->to, hr2di_apart_from_point(g->s[a->to], far))) return 1;
      size_t known = 0;
      while (known < points && hr2di_point_order(reached[known], far)) known++;
      if (known == points && points < MOST_LINKS) reached[points++] = far;
    }
  return 0;
}

static int is_end_of(hr2d_segment s, hr2d_point p) {
  return hr2di_point_same(s.a, p) || hr2di_point_same(s.b, p);
}

/* Widths of one gap, but for roundings of coordinates that are far larger. */
static int is_same(double d, double e) {
  return fabs(d - e) <= 1e-6 * e;
}

/* Whether no patch touches this end and the one that it is near to, which is as near as any
   point of its patch. */
static int is_corner(const gaps *g, const approach *a) {
  const hr2d_segment t = g->s[a->to];
  const double to_a = hypot(t.a.x - a->at.x, t.a.y - a->at.y),
               to_b = hypot(t.b.x - a->at.x, t.b.y - a->at.y);
  const uint32_t near = 2 * a->to + (to_b < to_a);
  return !g->touched[a->end] && !g->touched[near] && is_same(fmin(to_a, to_b), a->distance);
}

/* Keeps of each place its nearest approach, and of two ends that are near each other the first;
   of two patches along each other the first. */
static hr2d_status choose(gaps *g) {
  hr2d_status status =
      hr2di_sort(g->approach, g->approaches, sizeof *g->approach, by_nearness, g->lint->watch);
  size_t kept = 0;
  for (size_t k = 0; k < g->approaches && !status; k++) {
    const approach a = g->approach[k];
    status = hr2di_watch_work(g->lint->watch, 8);
    if (kept && hr2di_point_same(g->approach[kept - 1].at, a.at)) continue;
    if (!is_closed(g, &a) && (!a.wide || is_corner(g, &a))) g->approach[kept++] = a;
  }
  g->approaches = kept;
  return status ? status
                : hr2di_sort(g->approach, kept, sizeof *g->approach, by_patch, g->lint->watch);
}

/* Whether the other side of the same gap was shown before. */
static int is_shown(const gaps *g, size_t k) {
  const approach *a = &g->approach[k];
  for (size_t m = k; m-- > 0 && g->approach[m].end / 2 == a->end / 2;)
    if (a->along && g->approach[m].along && g->approach[m].to == a->to) return 1;
  if (a->to >= a->end / 2) return 0;
  size_t low = 0, high = k;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (g->approach[middle].end < 2 * a->to)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < k && g->approach[low].end / 2 == a->to; low++)
    if (g->approach[low].to == a->end / 2 &&
        (a->along || (is_same(g->approach[low].distance, a->distance) &&
                      is_end_of(g->s[a->to], g->approach[low].at))))
      return 1;
  return 0;
}

static hr2d_warning_code code_of(const gaps *g, const approach *a) {
  if (a->along) return HR2D_WARNING_NEAR_COPY;
  return g->touched[a->end] ? HR2D_WARNING_NARROW_GAP : HR2D_WARNING_LOOSE_END;
}

/* Of images the patches themselves are told; the ends of a period are nobody's. */
static int is_told(const hr2d_scene *scene, const approach *a) {
  const hr2di_symmetry *s = &scene->symmetry;
  return a->end / 2 < hr2di_scene_cell(scene) && (!s->motion || a->to < s->motions * s->cell);
}

/* Whether the patch goes past an end of the other one, rather than ending short of it: a wall
   that is sunk below the floor. */
static int is_past(const gaps *g, const approach *a) {
  const size_t i = a->end / 2, j = a->to;
  return is_touch(g, i, j, hr2di_apart_from_point(g->s[i], g->s[j].a)) ||
         is_touch(g, i, j, hr2di_apart_from_point(g->s[i], g->s[j].b));
}

static hr2d_status show(const gaps *g, const approach *a) {
  const hr2d_scene *scene = g->lint->scene;
  const size_t i = a->end / 2, j = a->to;
  const hr2di_label first = hr2di_patch_label(scene, i), second = hr2di_patch_label(scene, j);
  const hr2d_segment given = scene->patch[i].given;
  const hr2d_point at = a->end % 2 ? given.b : given.a;
  const double width = ldexp(a->distance, g->exponent);
  const double enough = 1.5 * width; /* as a tolerance */
  const hr2d_warning w = {.code = code_of(g, a),
                          .patches = 2,
                          .patch = {i, hr2di_scene_original(scene, j)},
                          .at = at,
                          .gap = width};
  if (w.code == HR2D_WARNING_NEAR_COPY)
    return hr2di_lint_warn(g->lint, w,
                           "%s lies along %s, only %.3g beside it at (%.9g, %.9g): if they are "
                           "one wall, give them the same ends, or remove one",
                           first.text, second.text, width, at.x, at.y);
  if (w.code == HR2D_WARNING_LOOSE_END && is_past(g, a))
    return hr2di_lint_warn(
        g->lint, w,
        "%s goes past an end of %s and ends at (%.9g, %.9g), %.3g behind it: "
        "if it should end there, move the end, or use hr2d_scene_snap() or "
        "--snap %.2g",
        first.text, second.text, at.x, at.y, width, enough);
  if (w.code == HR2D_WARNING_LOOSE_END)
    return hr2di_lint_warn(
        g->lint, w,
        "%s ends at (%.9g, %.9g), %.3g short of %s, and light passes there: "
        "if they should meet, move the end, or use hr2d_scene_snap() or --snap %.2g",
        first.text, at.x, at.y, width, second.text, enough);
  return hr2di_lint_warn(
      g->lint, w,
      "between %s and %s there is an opening of only %.3g at (%.9g, %.9g): "
      "if they should meet, give them the same point, or use hr2d_scene_snap() or --snap %.2g",
      first.text, second.text, width, at.x, at.y, enough);
}

/* A text takes some microseconds. */
enum { TEXT = 50 };

static hr2d_status show_all(const gaps *g, hr2d_warning_code code) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < g->approaches && !status; k++) {
    const approach *a = &g->approach[k];
    status = hr2di_watch_work(g->lint->watch, 1);
    if (status || code_of(g, a) != code || a->silent || is_shown(g, k) ||
        !is_told(g->lint->scene, a))
      continue;
    status = hr2di_watch_work(g->lint->watch, TEXT);
    if (!status) status = show(g, a);
  }
  return status;
}

hr2d_status hr2di_lint_gaps(const hr2di_lint *lint) {
  static const hr2d_warning_code order[] = {HR2D_WARNING_LOOSE_END, HR2D_WARNING_NARROW_GAP,
                                            HR2D_WARNING_NEAR_COPY};
  gaps g = {.lint = lint, .alloc = &lint->scene->alloc, .count = lint->scene->patches};
  hr2d_status status = prepare(&g);
  if (!status) status = choose(&g);
  for (size_t c = 0; c < 3 && !status; c++) status = show_all(&g, order[c]);
  hr2di_alloc_free(g.alloc, g.s);
  hr2di_alloc_free(g.alloc, g.box);
  hr2di_alloc_free(g.alloc, g.reach);
  hr2di_alloc_free(g.alloc, g.sorted);
  hr2di_alloc_free(g.alloc, g.touched);
  hr2di_alloc_free(g.alloc, g.approach);
  return status;
}
