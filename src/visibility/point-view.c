/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view from a point of a patch: the bearings of all vertices, the arcs of the patches, and
   the parts of arcs that no nearer patch hides.

   The point x = a + t(b−a) need not be a double: vectors from it keep their rounding errors,
   measured from the nearer end of the patch. */
#include "visibility/point-view.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/orient-sign.h"
#include "geometry/predicates.h"
#include "scene/scene-impl.h"
#include "visibility/point-view-impl.h"

/* An end of a patch, or a patch by its two vertices: sorted, equal ones are neighbours. */
typedef struct tip {
  hr2d_point at;
  uint32_t index; /* 2·patch + end, or the patch */
} tip;

static int by_point(const void *left, const void *right) {
  const tip *l = left, *r = right;
  if (l->at.x != r->at.x) return l->at.x < r->at.x ? -1 : 1;
  if (l->at.y != r->at.y) return l->at.y < r->at.y ? -1 : 1;
  return (l->index > r->index) - (l->index < r->index);
}

/* Numbers the different ends of patches. */
static hr2d_status number_vertices(hr2di_viewer *w, tip *tips) {
  hr2d_status status = hr2di_watch_work(w->watch, w->patches / 4);
  for (uint32_t k = 0; k < w->patches; k++) {
    const hr2d_segment s = w->scene->patch[k].scaled;
    for (uint32_t e = 0; e < 2; e++) {
      tips[2 * k + e].at = e ? s.b : s.a;
      tips[2 * k + e].index = 2 * k + e;
    }
  }
  if (!status) status = hr2di_sort(tips, 2 * w->patches, sizeof *tips, by_point, w->watch);
  for (size_t k = 0; k < 2 * w->patches && !status; k++) {
    const hr2d_point at = tips[k].at;
    if (k == 0 || !hr2di_point_same(at, tips[k - 1].at))
      w->vertex[w->vertices++] = (hr2d_point){HR2DI_VIEW_SCALE * at.x, HR2DI_VIEW_SCALE * at.y};
    w->end[tips[k].index / 2][tips[k].index % 2] = (uint32_t)w->vertices - 1;
  }
  return status;
}

/* Patches with the same two vertices are back to back: commit allows no other ones. */
static hr2d_status find_twins(hr2di_viewer *w, tip *tips) {
  for (uint32_t k = 0; k < w->patches; k++) {
    const uint32_t a = w->end[k][0], b = w->end[k][1];
    tips[k].at = (hr2d_point){a < b ? a : b, a < b ? b : a};
    tips[k].index = k;
  }
  const hr2d_status status = hr2di_sort(tips, w->patches, sizeof *tips, by_point, w->watch);
  for (size_t k = 1; k < w->patches && !status; k++)
    if (hr2di_point_same(tips[k].at, tips[k - 1].at))
      w->twin[tips[k].index] = w->twin[tips[k - 1].index] = 1;
  return status;
}

/* Directions between the ends of n arcs, of which at most 2n are vertices in front and two
   horizons, leave room for 2n + 1 glimpses. */
static int reserve(hr2di_viewer *w) {
  const hr2d_allocator *alloc = &w->alloc;
  const size_t n = w->patches, ends = 2 * n;
  w->vertex = hr2di_alloc(alloc, ends, sizeof *w->vertex);
  w->end = hr2di_alloc(alloc, n, sizeof *w->end);
  w->twin = hr2di_alloc_zero(alloc, n, sizeof *w->twin);
  w->bearing = hr2di_alloc(alloc, ends, sizeof *w->bearing);
  w->arc = hr2di_alloc(alloc, n, sizeof *w->arc);
  w->direction[0] = hr2di_alloc(alloc, ends, sizeof **w->direction);
  w->direction[1] = hr2di_alloc(alloc, ends, sizeof **w->direction);
  w->rank = hr2di_alloc(alloc, ends, sizeof *w->rank);
  w->starting = hr2di_alloc(alloc, ends + 2, sizeof *w->starting);
  w->ending = hr2di_alloc(alloc, ends + 2, sizeof *w->ending);
  w->heap = hr2di_alloc(alloc, n, sizeof *w->heap);
  w->glimpse = hr2di_alloc(alloc, ends + 1, sizeof *w->glimpse);
  w->sorted = hr2di_alloc(alloc, ends + 1, sizeof *w->sorted);
  w->first = hr2di_alloc(alloc, n, sizeof *w->first);
  return w->vertex && w->end && w->twin && w->bearing && w->arc && w->direction[0] &&
         w->direction[1] && w->rank && w->starting && w->ending && w->heap && w->glimpse &&
         w->sorted && w->first;
}

hr2d_status hr2di_viewer_create(const hr2d_scene *scene, const hr2d_allocator *alloc,
                                hr2di_watch *watch, hr2di_viewer **viewer) {
  *viewer = NULL;
  if (scene->patches > UINT32_MAX / 4) return HR2D_ENOMEM;
  hr2di_viewer *w = hr2di_alloc_zero(alloc, 1, sizeof *w);
  if (!w) return HR2D_ENOMEM;
  w->alloc = *alloc;
  w->watch = watch;
  w->scene = scene;
  w->patches = scene->patches;
  tip *tips = hr2di_alloc(alloc, 2 * w->patches, sizeof *tips);
  hr2d_status status = tips && reserve(w) ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = number_vertices(w, tips);
  if (!status) status = find_twins(w, tips);
  hr2di_alloc_free(alloc, tips);
  if (status)
    hr2di_viewer_destroy(w);
  else
    *viewer = w;
  return status;
}

void hr2di_viewer_destroy(hr2di_viewer *viewer) {
  if (!viewer) return;
  const hr2d_allocator alloc = viewer->alloc;
  void *const block[] = {viewer->vertex,  viewer->end,          viewer->twin,
                         viewer->bearing, viewer->arc,          viewer->direction[0],
                         viewer->rank,    viewer->direction[1], viewer->starting,
                         viewer->ending,  viewer->heap,         viewer->glimpse,
                         viewer->sorted,  viewer->first};
  for (size_t k = 0; k < sizeof block / sizeof *block; k++) hr2di_alloc_free(&alloc, block[k]);
  hr2di_alloc_free(&alloc, viewer);
}

/* t times one component of b − a, with its rounding error. */
static double part(double t, double head, double tail, double *error) {
  const double product = t * head;
  *error = hr2di_tail_of_product(t, head, product) + t * tail;
  return product;
}

/* One component of (vertex − base) − (x − base). */
static double minus(double p, double p_tail, double q, double q_tail, double *tail) {
  const double plain = p - q;
  const double rest = hr2di_tail_of_difference(p, q, plain) + (p_tail - q_tail);
  const double head = plain + rest;
  *tail = hr2di_tail_of_difference(plain, -rest, head);
  return head;
}

static void find_direction(hr2di_bearing *b, const hr2di_vector *axis, double length) {
  b->distance = hr2di_vector_length(&b->to);
  if (!(b->distance > 0)) {
    b->height = 0;
    return;
  }
  const double along = hr2di_vector_dot(&b->to, axis) / length, height = b->height;
  b->sine = along / b->distance;
  b->cosine = height / b->distance;
  b->key = fabs(along) <= height ? -along / height : height / along + (along > 0 ? -2 : 2);
}

/* The bearings of all vertices from fraction t of a patch. */
static void take_bearings(hr2di_viewer *w, size_t patch, double t) {
  const hr2d_point a = w->vertex[w->end[patch][0]], b = w->vertex[w->end[patch][1]];
  const hr2d_point base = t <= .5 ? a : b;
  const double from_base = t <= .5 ? t : t - 1;
  const hr2di_vector ab = hr2di_vector_difference(b, a);
  /* Not so short that squares of its length underflow. */
  const int e = 400 - ilogb(fmax(fabs(ab.x), fabs(ab.y)));
  const hr2di_vector axis = {ldexp(ab.x, e), ldexp(ab.y, e), ldexp(ab.tx, e), ldexp(ab.ty, e),
                             0};
  const double length = hr2di_vector_length(&axis);
  hr2di_vector x = {.e = 0};
  x.x = part(from_base, ab.x, ab.tx, &x.tx);
  x.y = part(from_base, ab.y, ab.ty, &x.ty);
  for (size_t v = 0; v < w->vertices; v++) {
    if (v % 16 == 0 && hr2di_watch_work(w->watch, 16)) return;
    hr2di_bearing *bearing = &w->bearing[v];
    const hr2di_vector d = hr2di_vector_difference(w->vertex[v], base);
    bearing->height = hr2di_det(&axis, &d) / length;
    bearing->to.x = minus(d.x, d.tx, x.x, x.tx, &bearing->to.tx);
    bearing->to.y = minus(d.y, d.ty, x.y, x.ty, &bearing->to.ty);
    bearing->to.e = 0;
    if (bearing->height > 0) find_direction(bearing, &axis, length);
  }
  w->patch = patch;
  w->t = t;
}

static double extent(const hr2di_vector *v) {
  return fmax(fabs(v->x), fabs(v->y));
}

/* (q−p)×(x−p), which is linear in t, by its sign; where that is 0 and the patch touches the
   point, the sign towards the middle of the point's own patch. */
static int side_close(const hr2di_viewer *w, uint32_t p, uint32_t q) {
  const hr2di_vector *to_p = &w->bearing[p].to, *to_q = &w->bearing[q].to;
  const hr2d_point at_p = w->vertex[p], at_q = w->vertex[q];
  const uint32_t *end = w->end[w->patch];
  const double at_a = hr2di_orient(at_p, at_q, w->vertex[end[0]]);
  const double at_b = hr2di_orient(at_p, at_q, w->vertex[end[1]]);
  const int side = hr2di_sign_of(at_a * (1 - w->t) + at_b * w->t);
  if (side || (extent(to_p) > 0 && extent(to_q) > 0 && hr2di_vector_dot(to_p, to_q) > 0))
    return side;
  return hr2di_sign_of(w->t <= .5 ? at_b - at_a : at_a - at_b);
}

/* Which side of a patch the point sees: 1 the front, -1 the back, 0 neither. */
static int side_seen(const hr2di_viewer *w, uint32_t p, uint32_t q) {
  const hr2di_vector *to_p = &w->bearing[p].to, *to_q = &w->bearing[q].to;
  const double det = hr2di_det(to_p, to_q);
  if (fabs(det) > 0x1p-100 * extent(to_p) * extent(to_q)) return hr2di_sign_of(det);
  return side_close(w, p, q);
}

/* Finds the arcs of all patches in front; whether one of them may hide another. */
static int find_arcs(hr2di_viewer *w) {
  int backs = 0;
  w->arcs = 0;
  for (size_t k = 0; k < w->patches; k++) {
    if (k % 16 == 0 && hr2di_watch_work(w->watch, 8)) return 0;
    const uint32_t p = w->end[k][0], q = w->end[k][1];
    const int p_above = w->bearing[p].height > 0, q_above = w->bearing[q].height > 0;
    if (!p_above && !q_above) continue;
    const int side = side_seen(w, p, q);
    if (side == 0 || (side < 0 && w->twin[k])) continue;
    const uint32_t first = p_above ? p : HR2DI_HORIZON, second = q_above ? q : HR2DI_HORIZON;
    w->arc[w->arcs++] = (hr2di_arc){.patch = (uint32_t)k,
                                    .right = side > 0 ? first : second,
                                    .left = side > 0 ? second : first,
                                    .front = side > 0};
    backs |= side < 0;
  }
  return backs || w->scene->effect[HR2D_EFFECT_OCCLUSION].on;
}

/* By patches, keeping the order of those of one patch. */
static void sort_glimpses(hr2di_viewer *w) {
  for (size_t k = 0; k < w->patches; k++) w->first[k] = 0;
  for (size_t k = 0; k < w->glimpses; k++) w->first[w->glimpse[k].patch]++;
  size_t before = 0;
  for (size_t k = 0; k < w->patches; k++) {
    const size_t count = w->first[k];
    w->first[k] = before;
    before += count;
  }
  for (size_t k = 0; k < w->glimpses; k++)
    w->sorted[w->first[w->glimpse[k].patch]++] = w->glimpse[k];
  hr2di_glimpse *sorted = w->sorted;
  w->sorted = w->glimpse;
  w->glimpse = sorted;
}

hr2d_status hr2di_view_at(hr2di_viewer *viewer, size_t patch, double t, hr2di_view_from *seen) {
  hr2di_viewer *w = viewer;
  w->glimpses = 0;
  w->back = (hr2di_sum){0, 0};
  take_bearings(w, patch, t);
  const int hidden = hr2di_watch_status(w->watch) ? 0 : find_arcs(w);
  hr2d_status status = hr2di_watch_status(w->watch);
  if (!status && hidden) status = hr2di_view_sweep(w);
  if (!status) status = hr2di_watch_work(w->watch, w->patches / 4);
  if (status) return status;
  if (hidden) {
    sort_glimpses(w);
  } else {
    for (size_t k = 0; k < w->arcs; k++)
      hr2di_view_note(w, &w->arc[k], w->arc[k].right, w->arc[k].left);
  }
  hr2di_sum front = {0, 0};
  for (size_t k = 0; k < w->glimpses; k++) hr2di_sum_add(&front, w->glimpse[k].sine);
  *seen = (hr2di_view_from){.glimpse = w->glimpse,
                            .count = w->glimpses,
                            .front = fmin(hr2di_sum_total(&front), 1),
                            .back = fmin(hr2di_sum_total(&w->back), 1)};
  seen->sky = fmax(1 - seen->front - seen->back, 0);
  return HR2D_OK;
}
