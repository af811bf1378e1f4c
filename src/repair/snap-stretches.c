/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls that share a stretch within the tolerance are cut at each other's ends. */
#include "base/alloc.h"
#include "base/sort.h"
#include "repair/snap-impl.h"

static int is_near(const hr2di_snapper *s, uint32_t v, uint32_t wall) {
  const uint32_t a = s->of_end[2 * wall], b = s->of_end[2 * wall + 1];
  double t;
  if (v == a || v == b) return 1;
  const hr2d_point foot = hr2di_snap_project(s->v[v].start, s->v[a].start, s->v[b].start, &t);
  return t > 0 && t < 1 && hr2di_snap_distance(foot, s->v[v].start) <= s->tolerance;
}

/* Whether `wall` has to be cut at an end of patch `end` / 2. */
static hr2d_status examine_stretch(hr2di_snapper *s, uint32_t end, uint32_t wall) {
  const uint32_t v = s->of_end[end], x = s->of_end[end ^ 1];
  const uint32_t a = s->of_end[2 * wall], b = s->of_end[2 * wall + 1];
  double t;
  if (a == b || v == x || v == a || v == b || !is_near(s, v, wall)) return HR2D_OK;
  if (!is_near(s, x, wall) && !is_near(s, a, end / 2) && !is_near(s, b, end / 2))
    return HR2D_OK;
  if (hr2di_alloc_reserve(s->alloc, &s->bend, &s->bend_capacity, s->bends + 1, sizeof *s->bend))
    return HR2D_ENOMEM;
  hr2di_snap_project(s->v[v].start, s->v[a].start, s->v[b].start, &t);
  s->bend[s->bends++] = (hr2di_snap_bend){wall, v, t};
  return HR2D_OK;
}

hr2d_status hr2di_snap_look_at_stretches(void *ctx, size_t i, size_t j) {
  hr2di_snapper *s = ctx;
  hr2d_status status = HR2D_OK;
  for (uint32_t e = 0; e < 2 && !status; e++)
    status = examine_stretch(s, (uint32_t)(2 * i) + e, (uint32_t)j);
  for (uint32_t e = 0; e < 2 && !status; e++)
    status = examine_stretch(s, (uint32_t)(2 * j) + e, (uint32_t)i);
  return status;
}

static int by_wall(const void *left, const void *right) {
  const hr2di_snap_bend *l = left, *r = right;
  if (l->wall != r->wall) return l->wall < r->wall ? -1 : 1;
  if (l->along != r->along) return l->along < r->along ? -1 : 1;
  return (l->vertex > r->vertex) - (l->vertex < r->vertex);
}

/* Adds the pieces of a patch that is cut at bends [from, to), which has moved to its vertices.
 */
static hr2d_status make_pieces(hr2di_snapper *s, size_t patch, size_t from, size_t to,
                               hr2d_scene *pieces) {
  const hr2di_patch *whole = &s->scene->patch[patch];
  hr2d_point a = whole->scaled.a;
  size_t number = 0;
  for (size_t k = from; k <= to; k++) {
    const hr2d_point b = k < to ? s->v[s->bend[k].vertex].at : whole->scaled.b;
    if (hr2di_point_same(a, b)) continue; /* the same bend again, found from another patch */
    hr2di_patch *made = &pieces->patch[pieces->patches];
    const hr2d_status status =
        hr2di_patch_copy(s->alloc, whole, from < to ? ++number : 0, made);
    if (status) return status;
    made->scaled = (hr2d_segment){a, b};
    made->given =
        (hr2d_segment){hr2di_snap_unscaled(s->scene, a), hr2di_snap_unscaled(s->scene, b)};
    pieces->patches++;
    a = b;
  }
  if (number > 1) s->report.cuts += number - 1;
  return HR2D_OK;
}

void hr2di_snap_exchange(hr2d_scene *scene, hr2d_scene *other) {
  hr2di_patch *const patch = scene->patch;
  const size_t patches = scene->patches, capacity = scene->capacity;
  scene->patch = other->patch;
  scene->patches = other->patches;
  scene->capacity = other->capacity;
  other->patch = patch;
  other->patches = patches;
  other->capacity = capacity;
}

/* Takes the pieces in the place of all patches; those that are not cut are one piece. */
hr2d_status hr2di_snap_cut(hr2di_snapper *s) {
  hr2d_scene pieces = {.alloc = *s->alloc};
  hr2d_status status = hr2di_sort(s->bend, s->bends, sizeof *s->bend, by_wall, s->watch);
  if (status) return status;
  pieces.capacity = s->scene->patches + s->bends;
  pieces.patch = hr2di_alloc(s->alloc, pieces.capacity, sizeof *pieces.patch);
  if (!pieces.patch) return HR2D_ENOMEM;
  for (size_t k = 0, m = 0; k < s->scene->patches && !status; k++) {
    const size_t from = m;
    while (m < s->bends && s->bend[m].wall == k) m++;
    status = make_pieces(s, k, from, m, &pieces);
  }
  if (!status) hr2di_snap_exchange(s->scene, &pieces);
  hr2di_scene_truncate(&pieces, 0);
  hr2di_alloc_free(s->alloc, pieces.patch);
  return status;
}
