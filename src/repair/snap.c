/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Repairs drawings whose walls nearly meet.

   Ends become vertices: each end in the order of patches joins the nearest vertex within the
   tolerance, or founds one.  So vertices are farther apart than the tolerance, and no end moves
   farther than that.  A vertex within the tolerance of a wall stands on it from then on: it is
   projected to the wall again and again, as the ends of that wall may stand on others, too,
   until nothing moves.  What has lost its length is dropped, and so is the later of two copies.
   Crossings that are left are cut.

   Where a wall that ends at the vertex shares a stretch with the other, within the tolerance,
   the other is cut at the vertex instead, and bends: then the pieces share both ends, and no
   rounding is between them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/crossings.h"
#include "geometry/vector.h"
#include "repair/snap-impl.h"
#include "scene/patch-light.h"

#define NONE UINT32_MAX

/* Walls that stand on each other in circles bring their feet nearer by a factor in each round.
 */
enum { MOST_ROUNDS = 64 };

static hr2d_point end_of(const hr2d_scene *scene, size_t end) {
  const hr2d_segment *s = &scene->patch[end / 2].scaled;
  return end % 2 ? s->b : s->a;
}

static uint32_t *cell_at(const hr2di_snapper *s, double column, double row) {
  uint64_t bits[2];
  const double place[2] = {column + 0., row + 0.}; /* no −0 */
  memcpy(bits, place, sizeof bits);
  uint64_t h = bits[0] * 0x9E3779B97F4A7C15u ^ (bits[1] + 0x7F4A7C15u) * 0xC2B2AE3D27D4EB4Fu;
  h ^= h >> 29;
  return &s->cell[(h * 0xBF58476D1CE4E5B9u >> 20) & (s->cells - 1)];
}

/* The nearest vertex within the tolerance, or NONE. */
static uint32_t find_vertex(const hr2di_snapper *s, hr2d_point p) {
  const double column = floor(p.x / s->tolerance), row = floor(p.y / s->tolerance);
  double min = s->tolerance;
  uint32_t nearest = NONE;
  for (int k = 0; k < 9; k++)
    for (uint32_t m = *cell_at(s, column + k % 3 - 1, row + k / 3 - 1); m != NONE;
         m = s->v[m].next) {
      const double d = hr2di_snap_distance(p, s->v[m].start);
      if (d < min || (d == min && m < nearest)) {
        min = d;
        nearest = m;
      }
    }
  return nearest;
}

static uint32_t add_vertex(hr2di_snapper *s, hr2d_point p) {
  uint32_t *cell = cell_at(s, floor(p.x / s->tolerance), floor(p.y / s->tolerance));
  s->v[s->vertices] = (hr2di_snap_vertex){.start = p, .at = p, .next = *cell, .wall = NONE};
  return *cell = s->vertices++;
}

static hr2d_status join_ends(hr2di_snapper *s) {
  const size_t ends = 2 * s->scene->patches;
  for (size_t k = 0; k < ends; k++) {
    const hr2d_point p = end_of(s->scene, k);
    const hr2d_status status = hr2di_watch_work(s->watch, 8);
    if (status) return status;
    uint32_t v = find_vertex(s, p);
    if (v == NONE)
      v = add_vertex(s, p);
    else
      s->report.ends += !hr2di_point_same(s->v[v].start, p);
    s->of_end[k] = v;
  }
  return HR2D_OK;
}

static void examine_foot(hr2di_snapper *s, uint32_t v, uint32_t wall) {
  const uint32_t a = s->of_end[2 * wall], b = s->of_end[2 * wall + 1];
  double t;
  if (a == b || a == v || b == v) return;
  const hr2d_point foot = hr2di_snap_project(s->v[v].start, s->v[a].start, s->v[b].start, &t);
  const double d = hr2di_snap_distance(foot, s->v[v].start);
  if (!(t > 0 && t < 1 && d <= s->tolerance)) return;
  if (s->v[v].wall != NONE &&
      (d > s->v[v].distance || (d == s->v[v].distance && wall > s->v[v].wall)))
    return;
  s->v[v].wall = wall;
  s->v[v].distance = d;
}

static hr2d_status examine_pair(void *ctx, size_t i, size_t j) {
  hr2di_snapper *s = ctx;
  for (size_t e = 0; e < 2; e++) {
    examine_foot(s, s->of_end[2 * i + e], (uint32_t)j);
    examine_foot(s, s->of_end[2 * j + e], (uint32_t)i);
  }
  return HR2D_OK;
}

static hr2d_status sweep(hr2di_snapper *s, hr2d_status (*visit)(void *, size_t, size_t)) {
  const double r = s->tolerance;
  for (size_t k = 0; k < s->scene->patches; k++) {
    const hr2d_point a = s->v[s->of_end[2 * k]].start, b = s->v[s->of_end[2 * k + 1]].start;
    s->box[k] = (hr2d_segment){{fmin(a.x, b.x) - r, fmin(a.y, b.y) - r},
                               {fmax(a.x, b.x) + r, fmax(a.y, b.y) + r}};
  }
  return hr2di_crossings_sweep(s->alloc, s->box, s->scene->patches, sizeof *s->box, visit, s,
                               s->watch);
}

/* Whether something moved by more than a rounding. */
static int place_feet(hr2di_snapper *s) {
  double max = 0;
  for (uint32_t k = 0; k < s->vertices; k++) {
    hr2di_snap_vertex *v = &s->v[k];
    double t;
    if (v->wall == NONE) continue;
    const hr2di_snap_vertex *a = &s->v[s->of_end[2 * v->wall]],
                            *b = &s->v[s->of_end[2 * v->wall + 1]];
    const hr2d_point foot = hr2di_snap_project(v->start, a->at, b->at, &t);
    if (!(t > 0 && t < 1)) continue;
    max = fmax(max, hr2di_snap_distance(foot, v->at));
    v->at = foot;
  }
  return max > 0x1p-52;
}

static hr2d_status stand(hr2di_snapper *s) {
  hr2d_status status = sweep(s, examine_pair);
  for (int round = 0; round < MOST_ROUNDS && !status; round++) {
    status = hr2di_watch_work(s->watch, s->vertices / 4 + 1);
    if (!place_feet(s)) break;
  }
  for (uint32_t k = 0; k < s->vertices; k++)
    s->report.feet += !hr2di_point_same(s->v[k].at, s->v[k].start);
  return status;
}

static void move_end(hr2di_snapper *s, size_t end) {
  hr2di_patch *patch = &s->scene->patch[end / 2];
  hr2d_point *given = end % 2 ? &patch->given.b : &patch->given.a;
  const hr2d_point to = hr2di_snap_unscaled(s->scene, s->v[s->of_end[end]].at);
  const double d = hr2di_snap_distance(*given, to);
  if (d > s->report.farthest) {
    s->report.farthest = d;
    s->report.from = *given;
    s->report.to = to;
  }
  *given = to;
  *(end % 2 ? &patch->scaled.b : &patch->scaled.a) = s->v[s->of_end[end]].at;
}

static void remove_patches(hr2d_scene *scene, const unsigned char *drop) {
  size_t kept = 0;
  for (size_t k = 0; k < scene->patches; k++) {
    if (!drop[k]) {
      scene->patch[kept++] = scene->patch[k];
      continue;
    }
    hr2di_alloc_free(&scene->alloc, scene->patch[k].name);
    hr2di_light_release(&scene->alloc, scene->patch[k].light);
  }
  scene->patches = kept;
}

typedef struct oriented {
  hr2d_segment s;
  size_t patch;
} oriented;

static int by_ends(const void *left, const void *right) {
  const oriented *l = left, *r = right;
  const int a = hr2di_point_order(l->s.a, r->s.a), b = hr2di_point_order(l->s.b, r->s.b);
  if (a || b) return a ? a : b;
  return (l->patch > r->patch) - (l->patch < r->patch);
}

/* Marks patches without a length, and later copies of others. */
static hr2d_status mark(hr2di_snapper *s, oriented *sorted, unsigned char *drop) {
  hr2d_scene *scene = s->scene;
  for (size_t k = 0; k < scene->patches; k++) {
    sorted[k] = (oriented){scene->patch[k].given, k};
    drop[k] = (unsigned char)hr2di_point_same(scene->patch[k].given.a, scene->patch[k].given.b);
    s->report.slivers += drop[k];
  }
  const hr2d_status status =
      hr2di_sort(sorted, scene->patches, sizeof *sorted, by_ends, s->watch);
  for (size_t k = 1; k < scene->patches && !status; k++) {
    const size_t patch = sorted[k].patch;
    if (drop[patch] || !hr2di_point_same(sorted[k].s.a, sorted[k - 1].s.a) ||
        !hr2di_point_same(sorted[k].s.b, sorted[k - 1].s.b))
      continue;
    drop[patch] = 1;
    s->report.copies++;
  }
  return status;
}

static hr2d_status drop_what_is_too_much(hr2di_snapper *s) {
  const size_t n = s->scene->patches;
  oriented *sorted = hr2di_alloc(s->alloc, n, sizeof *sorted);
  unsigned char *drop = hr2di_alloc(s->alloc, n, 1);
  hr2d_status status = sorted && drop ? mark(s, sorted, drop) : HR2D_ENOMEM;
  if (!status) remove_patches(s->scene, drop);
  hr2di_alloc_free(s->alloc, sorted);
  hr2di_alloc_free(s->alloc, drop);
  return status;
}

static void release(hr2di_snapper *s) {
  hr2di_alloc_free(s->alloc, s->v);
  hr2di_alloc_free(s->alloc, s->of_end);
  hr2di_alloc_free(s->alloc, s->cell);
  hr2di_alloc_free(s->alloc, s->box);
  s->v = NULL;
  s->of_end = s->cell = NULL;
  s->box = NULL;
}

static hr2d_status reserve(hr2di_snapper *s) {
  const size_t n = s->scene->patches;
  release(s);
  if (n >= NONE / 4) return HR2D_ENOMEM;
  for (s->cells = 16; s->cells < 4 * n;) s->cells *= 2;
  s->vertices = 0;
  s->bends = 0;
  s->v = hr2di_alloc(s->alloc, n, 2 * sizeof *s->v);
  s->of_end = hr2di_alloc(s->alloc, n, 2 * sizeof *s->of_end);
  s->cell = hr2di_alloc(s->alloc, s->cells, sizeof *s->cell);
  s->box = hr2di_alloc(s->alloc, n, sizeof *s->box);
  if (!s->v || !s->of_end || !s->cell || !s->box) return HR2D_ENOMEM;
  memset(s->cell, 0xFF, s->cells * sizeof *s->cell);
  return HR2D_OK;
}

/* Pieces that bend may come near to other vertices, a few times at most. */
enum { MOST_CUTS = 16 };

static hr2d_status join(hr2di_snapper *s) {
  hr2d_status status = reserve(s);
  if (!status) status = join_ends(s);
  for (size_t k = 0; k < 2 * s->scene->patches && !status; k++) move_end(s, k);
  return status;
}

/* Joins ends, and drops copies at once: all pairs of them would be looked at. */
static hr2d_status join_and_drop(hr2di_snapper *s) {
  const size_t before = s->scene->patches;
  hr2d_status status = join(s);
  if (!status) status = drop_what_is_too_much(s);
  return status || s->scene->patches == before ? status : join(s);
}

/* Joins ends, and cuts walls where they share a stretch with others, until none is left. */
static hr2d_status join_and_cut(hr2di_snapper *s) {
  hr2d_status status = HR2D_OK;
  for (int round = 0; round < MOST_CUTS && !status; round++) {
    status = join_and_drop(s);
    if (!status) status = sweep(s, hr2di_snap_look_at_stretches);
    if (status || !s->bends) return status;
    status = hr2di_snap_cut(s);
  }
  return status
             ? status
             : hr2di_message_fail(&s->scene->message, HR2D_ESCENE,
                                  "patches share stretches within the tolerance still, after "
                                  "%d rounds of cutting",
                                  MOST_CUTS);
}

static hr2d_status snap(hr2di_snapper *s, double tolerance) {
  hr2d_scene *scene = s->scene;
  size_t crossings = 0;
  hr2d_status status = hr2di_scene_scale(scene, s->watch);
  if (status) return status;
  s->tolerance = fmax(ldexp(tolerance, -scene->exponent), 0x1p-50);
  status = join_and_cut(s);
  if (!status) status = stand(s);
  for (size_t k = 0; k < 2 * scene->patches && !status; k++) move_end(s, k);
  if (!status) status = drop_what_is_too_much(s);
  if (!status && !scene->patches)
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "no patch is longer than the tolerance of %g", tolerance);
  if (!status) status = hr2d_scene_split_crossings(scene, &crossings);
  s->report.cuts += crossings;
  return status ? status : drop_what_is_too_much(s);
}

/* The patches of `copy` become those of the scene, with names of their own. */
static hr2d_status copy_patches(hr2d_scene *copy, const hr2d_scene *scene) {
  copy->patch = hr2di_alloc(&scene->alloc, scene->patches, sizeof *copy->patch);
  if (!copy->patch) return HR2D_ENOMEM;
  copy->capacity = scene->patches;
  for (; copy->patches < scene->patches; copy->patches++)
    if (hr2di_patch_copy(&scene->alloc, &scene->patch[copy->patches], 0,
                         &copy->patch[copy->patches]))
      return HR2D_ENOMEM;
  return HR2D_OK;
}

hr2d_status hr2d_scene_snap(hr2d_scene *scene, double tolerance, hr2d_snap_report *report) {
  if (!scene) return HR2D_EINVAL;
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE,
                              "a committed scene cannot be snapped");
  if (!(tolerance > 0 && isfinite(tolerance)))
    return hr2di_message_fail(&scene->message, HR2D_EINVAL,
                              "the tolerance must be greater than 0, not %g", tolerance);
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "snap");
  hr2d_scene copy = {
      .alloc = scene->alloc, .progress = scene->progress, .progress_ctx = scene->progress_ctx};
  hr2di_snapper s = {.scene = &copy, .alloc = &scene->alloc, .watch = &watch};
  hr2d_status status = scene->patches ? copy_patches(&copy, scene) : HR2D_OK;
  if (!status && scene->patches) status = snap(&s, tolerance);
  if (!status) hr2di_snap_exchange(scene, &copy);
  if (!status && report) *report = s.report;
  hr2di_scene_truncate(&copy, 0);
  hr2di_alloc_free(s.alloc, copy.patch);
  hr2di_alloc_free(s.alloc, s.bend);
  release(&s);
  if (status == HR2D_ENOMEM || watch.status)
    return hr2di_scene_fail(scene, status, &watch, "the snap");
  if (status) hr2di_message_fail(&scene->message, status, "%s", copy.message.text);
  return status;
}
