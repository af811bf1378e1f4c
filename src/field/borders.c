/* SPDX-License-Identifier: GPL-3.0-or-later */
/* M(x) is (1/2π) Σ B Δθ over what x sees, and analytic but where x is on one line with two ends
   of what it sees: with w, past v.  A step δ across this line turns the directions to v and to
   w by δ/|xv| and δ/|xw|, and what is between them changes by the jump of B at w.  So the slope
   of M jumps by (jump/2π) (1/|xv| − 1/|xw|), and that of Φ by π times as much.  All such lines
   begin behind a vertex v that a view from w shows as the end of something with something else
   behind.

   The ends w are the ends of walls, and of patches along them, and places where B jumps within
   a patch.  The walls around an end divide its view into sectors.  In the direction of v, a
   side of w shows the wall at the end of the sector if this is less than a half circle away,
   and else what is behind w as x sees it.  A wall itself is a line as well, seen along its
   edge. */
#include "field/borders.h"

#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "field/locate.h"
#include "geometry/vector.h"

/* What is not farther than the vertex by more than this part ends there. */
#define SAME 1e-9

/* How far from x what is seen beside w: as far as w, or as what ends at v or is behind w. */
typedef enum distance { AT_W, AT_V, BEHIND_W } distance;

/* What is seen somewhere: a patch's front at a fraction of it, or what else. */
typedef struct thing {
  uint32_t patch;
  double at;
  distance from_x;
} thing;

typedef struct search {
  hr2di_borders *to;
  const hr2di_light_source *of;
  const hr2di_border_scale *scale;
  hr2di_watch *watch;
  hr2di_visibility_polygon view;
  hr2di_polygon_arc *seen; /* of this sector, from right to left */
  size_t count, room;
  hr2d_point w;
} search;

static double value_of(const hr2di_light_source *of, thing what, size_t band) {
  if (what.patch == HR2DI_ROUND_SKY) return hr2di_light_sky(of, band);
  if (what.patch == HR2DI_ROUND_BACK) return 0;
  const uint32_t patch = hr2di_light_patch(of, what.patch);
  if (patch == HR2DI_NOBODY) return 0;
  const size_t k = hr2di_leaf_at(&of->leaves, patch, what.at), bands = of->solution->bands;
  const double from = of->leaves.leaf[k].from, to = hr2di_leaf_end(&of->leaves, patch, k);
  const double xi = fmin(fmax(2 * (what.at - from) / (to - from) - 1, -1), 1);
  return hr2di_basis_sum(
      &of->basis, xi,
      of->leaves.value + of->leaves.leaf[k].element * of->leaves.order * bands + band, bands);
}

static int has_light(const hr2di_light_source *of, thing what) {
  if (what.patch == HR2DI_ROUND_BACK) return 0;
  return what.patch != HR2DI_ROUND_SKY || of->lit_sky;
}

static int is_front(thing what) {
  return what.patch != HR2DI_ROUND_SKY && what.patch != HR2DI_ROUND_BACK;
}

/* Sky, backs and fronts. */
static int same_kind(thing one, thing other) {
  return is_front(one) ? is_front(other) : one.patch == other.patch;
}

/* B, or that behind gas: E + T(B − E) with 0 ≤ T ≤ 1, which is the same for both as long as
   they are as far. */
static double difference_of(const hr2di_light_source *of, thing one, thing other, size_t band) {
  const double a = value_of(of, one, band), b = value_of(of, other, band);
  double most = fabs(a - b);
  if (one.from_x == other.from_x) return most;
  for (size_t k = 0; k < of->scene->gases.count; k++) {
    if (!(hr2d_scene_absorption(of->scene, k, band) > 0)) continue;
    const double gas = *hr2di_solution_gas(of->solution, k, band);
    most = fmax(most, fmax(fabs(a - gas), fabs(b - gas)));
  }
  return most;
}

static double jump_between(const search *s, thing one, thing other) {
  double jump = same_kind(one, other) ? 0 : 1 / s->scale->share;
  for (size_t b = 0; b < s->of->solution->bands; b++) {
    const int sky = (one.patch == HR2DI_ROUND_SKY) != (other.patch == HR2DI_ROUND_SKY);
    const double spread =
        sky ? hr2di_sky_max(s->of->scene, b) - hr2di_sky_min(s->of->scene, b) : 0;
    const double difference = difference_of(s->of, one, other, b) + spread;
    if (difference > 0) jump = fmax(jump, difference / s->scale->band[b]);
  }
  return jump;
}

static hr2d_status take(void *ctx, const hr2di_polygon_arc *arc) {
  search *s = ctx;
  if (hr2di_alloc_reserve(&s->to->alloc, &s->seen, &s->room, s->count + 1, sizeof *s->seen))
    return HR2D_ENOMEM;
  s->seen[s->count++] = *arc;
  return HR2D_OK;
}

/* How far a ray from w gets, as a multiple of r, before it ends on what a stretch shows. */
static double reach_of(const search *s, hr2d_point r, const hr2di_polygon_arc *on) {
  const hr2di_triangulation *in = &s->of->scene->plane.triangulation;
  if (on->what == HR2DI_SKY) return HUGE_VAL;
  const hr2di_wall_edge *edge = &in->edge[(uint32_t)~on->what >> 1];
  const hr2d_point p = hr2di_point_minus(in->at[edge->from], s->view.x),
                   q = hr2di_point_minus(in->at[edge->to], s->view.x);
  if (hr2di_point_same(p, r) || hr2di_point_same(q, r)) return 1;
  const hr2d_point d = hr2di_point_minus(q, p);
  const double across = hr2di_point_cross(r, d);
  return across != 0 ? fmax(hr2di_point_cross(p, d) / across, 1) : 1;
}

/* What there is too much of ends the search like a stop. */
static hr2d_status put(hr2di_borders *to, hr2di_border border) {
  to->many = to->count >= to->max;
  if (to->many) return HR2D_STOPPED;
  if (hr2di_alloc_reserve(&to->alloc, &to->border, &to->room, to->count + 1,
                          sizeof *to->border))
    return HR2D_ENOMEM;
  to->border[to->count++] = border;
  return HR2D_OK;
}

/* The ray that goes on behind v, which is at r from w, as far as w is seen. */
static hr2d_status add(search *s, hr2d_point r, double reach, double jump, int lit) {
  const double length = hypot(r.x, r.y);
  if (!(reach > 1 + SAME) || !(jump > 0 || lit) || !(length > 0)) return HR2D_OK;
  return put(s->to, (hr2di_border){.from = {s->view.x.x + r.x, s->view.x.y + r.y},
                                   .along = {r.x / length, r.y / length},
                                   .reach = reach < HUGE_VAL ? (reach - 1) * length : HUGE_VAL,
                                   .behind = length,
                                   .jump = jump,
                                   .lit = lit});
}

/* What a sector shows in a direction; where on a patch, about. */
static thing seen_in(const search *s, hr2d_point direction) {
  for (size_t k = 0; k < s->count; k++) {
    const hr2di_polygon_arc *on = &s->seen[k];
    const double right = hr2di_point_cross(on->right, direction),
                 left = hr2di_point_cross(direction, on->left);
    if (right < 0 || left < 0 || !(on->angle > 0)) continue;
    const double part = atan2(right, hr2di_point_dot(on->right, direction)) / on->angle;
    return (thing){on->patch, on->from + fmin(part, 1) * (on->to - on->from), BEHIND_W};
  }
  return (thing){HR2DI_ROUND_BACK, 0, BEHIND_W};
}

/* The front on a side of a wall at one of its ends. */
static thing face_at(const search *s, int32_t across, hr2d_point at, distance from_x) {
  const hr2d_scene *scene = s->of->scene;
  const uint32_t patch = hr2di_patch_beside(scene, (hr2di_wall_side)~across, at);
  if (patch == HR2DI_NOBODY) return (thing){HR2DI_ROUND_BACK, 0, from_x};
  const hr2d_segment on = scene->patch[patch].scaled;
  const hr2d_point d = hr2di_point_minus(on.b, on.a), e = hr2di_point_minus(at, on.a);
  const double t = hr2di_point_dot(d, e) / hr2di_point_dot(d, d);
  return (thing){patch, fmin(fmax(t, 0), 1), from_x};
}

/* Between two walls that meet at w. */
typedef struct sector {
  double angle;
  hr2d_point end[2]; /* the other ends of the walls on the right and on the left, from w */
  thing near[2];     /* their faces at w, */
  thing far[2];      /* and there */
} sector;

/* What a side of w shows to a point behind v. */
static thing beside(const search *s, const sector *in, int left, double angle, hr2d_point v) {
  if (angle <= HR2DI_PI * (1 + SAME)) return in->near[left];
  return seen_in(s, (hr2d_point){-v.x, -v.y});
}

/* v: from w; angle: from the right end of the sector. */
static hr2d_status add_past(search *s, const sector *in, hr2d_point v, double angle,
                            double reach) {
  const thing right = beside(s, in, 0, angle, v), left = beside(s, in, 1, in->angle - angle, v);
  return add(s, v, reach, jump_between(s, right, left),
             has_light(s->of, right) != has_light(s->of, left));
}

/* Along the wall on one end of the sector. */
static hr2d_status add_along(search *s, const sector *in, int left) {
  const hr2d_point v = in->end[left];
  const thing other = beside(s, in, !left, in->angle, v);
  const double reach = reach_of(s, v, &s->seen[left ? s->count - 1 : 0]);
  const double jump =
      fmax(jump_between(s, in->near[left], other), jump_between(s, in->far[left], other));
  return add(s, v, reach, jump, has_light(s->of, in->near[left]) != has_light(s->of, other));
}

/* Half-edges of the triangulation along the walls on the right and on the left of a sector. */
static hr2d_status add_sector(search *s, int32_t first, int32_t last) {
  const hr2di_triangulation *in = &s->of->scene->plane.triangulation;
  const hr2di_triangle *right = &in->triangle[first >> 2], *left = &in->triangle[last >> 2];
  const hr2d_point r = in->at[right->corner[hr2di_corner_after(first & 3)]],
                   l = in->at[left->corner[last & 3]];
  const int32_t face[2] = {right->across[first & 3], left->across[last & 3]};
  sector all = {.end = {hr2di_point_minus(r, s->w), hr2di_point_minus(l, s->w)},
                .near = {face_at(s, face[0], s->w, AT_W), face_at(s, face[1], s->w, AT_W)},
                .far = {face_at(s, face[0], r, AT_V), face_at(s, face[1], l, AT_V)}};
  for (size_t k = 0; k < s->count; k++) all.angle += s->seen[k].angle;
  hr2d_status status = add_along(s, &all, 0);
  double angle = 0;
  for (size_t k = 0; k + 1 < s->count && !status; k++) {
    const hr2d_point v = s->seen[k].left;
    angle += s->seen[k].angle;
    const double reach = fmax(reach_of(s, v, &s->seen[k]), reach_of(s, v, &s->seen[k + 1]));
    if (reach > 1 + SAME) status = add_past(s, &all, v, angle, reach);
    if (!status) status = hr2di_watch_work(s->watch, 4);
  }
  return status ? status : add_along(s, &all, 1);
}

/* All sectors around the vertex that half-edge h leaves along a wall. */
static hr2d_status view_from_end(search *s, int32_t h) {
  const hr2di_triangulation *in = &s->of->scene->plane.triangulation;
  const int32_t start = h;
  hr2d_status status = HR2D_OK;
  s->w = in->at[in->triangle[h >> 2].corner[h & 3]];
  do {
    int32_t last = h;
    s->count = 0;
    status = hr2di_beams_between(&s->view, h, &last);
    if (!status && s->count > 0) status = add_sector(s, h, last);
    if (status) return status;
    const uint32_t side = (uint32_t)~in->triangle[last >> 2].across[last & 3];
    h = in->edge[side >> 1].half_edge[1 - (side & 1)];
  } while (h != start);
  return status;
}

/* From a place along a wall where what is seen of it jumps, in front of it. */
static hr2d_status view_from_place(search *s, hr2d_segment wall, double at, double jump,
                                   int lit) {
  const hr2d_point d = hr2di_point_minus(wall.b, wall.a);
  const double off = HR2DI_FIELD_BESIDE / hypot(d.x, d.y);
  const hr2d_point x = {wall.a.x + at * d.x - off * d.y, wall.a.y + at * d.y + off * d.x};
  int touches;
  s->count = 0;
  hr2d_status status = hr2di_beams_all_round(&s->view, x, &touches);
  for (size_t k = 0; k < s->count && !status; k++) {
    const hr2di_polygon_arc *right = &s->seen[k], *left = &s->seen[(k + 1) % s->count];
    const hr2d_point v = right->left;
    status = add(s, v, fmax(reach_of(s, v, right), reach_of(s, v, left)), jump, lit);
    if (!status) status = hr2di_watch_work(s->watch, 4);
  }
  return status;
}

/* Where two parts of a side meet. */
static hr2d_status view_from_parts(search *s, hr2di_parts parts) {
  const hr2di_side_part *part = s->of->scene->parts.part;
  hr2d_status status = HR2D_OK;
  for (uint32_t k = parts.first; k + 1 < parts.last && !status; k++) {
    thing what[2];
    for (uint32_t n = 0; n < 2; n++) {
      const uint32_t patch = part[k + n].patch;
      what[n] = (thing){HR2DI_ROUND_BACK, 0, AT_W};
      if (patch == HR2DI_NOBODY) continue;
      const hr2d_segment on = s->of->scene->patch[patch].scaled;
      const hr2d_point d = hr2di_point_minus(on.b, on.a),
                       e = hr2di_point_minus(part[k].at.b, on.a);
      what[n] =
          (thing){patch, fmin(fmax(hr2di_point_dot(d, e) / hr2di_point_dot(d, d), 0), 1), AT_W};
    }
    status = view_from_place(s, part[k].at, 1, jump_between(s, what[0], what[1]),
                             has_light(s->of, what[0]) != has_light(s->of, what[1]));
  }
  return status;
}

/* Where B jumps within a patch. */
static hr2d_status view_from_jumps(search *s, size_t patch) {
  const hr2di_leaves *l = &s->of->leaves;
  const uint32_t on = hr2di_light_patch(s->of, (uint32_t)patch);
  hr2d_status status = HR2D_OK;
  if (on == HR2DI_NOBODY) return HR2D_OK;
  for (size_t k = l->of_patch[on] + 1; k < l->of_patch[on + 1] && !status; k++) {
    if (l->group[k] == l->group[k - 1]) continue;
    const thing after = {(uint32_t)patch, l->leaf[k].from, AT_W},
                before = {(uint32_t)patch, nextafter(l->leaf[k].from, 0), AT_W};
    status = view_from_place(s, s->of->scene->patch[patch].scaled, l->leaf[k].from,
                             jump_between(s, before, after), 0);
  }
  return status;
}

static hr2d_status add_wall(search *s, const hr2di_wall_edge *edge) {
  const hr2di_triangulation *in = &s->of->scene->plane.triangulation;
  const hr2d_point d = hr2di_point_minus(in->at[edge->to], in->at[edge->from]);
  const double length = hypot(d.x, d.y);
  if (!(length > 0)) return HR2D_OK;
  return put(s->to, (hr2di_border){.from = in->at[edge->from],
                                   .along = {d.x / length, d.y / length},
                                   .reach = length,
                                   .jump = HUGE_VAL,
                                   .lit = 1});
}

/* M itself jumps where the light of a sun goes by an end of a wall, as far as it may go, and
   its slope where an edge of a piece of the sky comes into sight. */
static hr2d_status add_ray(search *s, hr2d_point end, hr2d_point d) {
  const double length = hypot(d.x, d.y);
  return put(s->to, (hr2di_border){.from = end,
                                   .along = {d.x / length, d.y / length},
                                   .reach = HUGE_VAL,
                                   .jump = HUGE_VAL,
                                   .lit = 1});
}

static hr2d_status add_edge(search *s, hr2d_point end, double bearing) {
  const hr2d_point e = hr2di_sky_direction(bearing);
  return add_ray(s, end, (hr2d_point){-e.x, -e.y});
}

static hr2d_status add_suns(search *s, hr2d_point end) {
  const hr2d_scene *scene = s->of->scene;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < scene->sun_bands && !status; k++)
    if (scene->sun[k].irradiance > 0) status = add_ray(s, end, scene->sun[k].direction);
  for (size_t k = 0; k < 2 * scene->sky.pieces && !status; k++) {
    double bearing;
    if (hr2di_sky_edge(scene, k, &bearing)) status = add_edge(s, end, bearing);
  }
  return status;
}

/* One half-edge along a wall from each end of walls, or -1. */
static int32_t *first_walls(const hr2di_triangulation *in, const hr2d_allocator *alloc) {
  int32_t *first = hr2di_alloc(alloc, in->vertices, sizeof *first);
  for (size_t k = 0; k < in->vertices && first; k++) first[k] = -1;
  for (size_t t = 0; t < in->triangles && first; t++)
    for (int k = 0; k < 3; k++)
      if (in->triangle[t].across[k] < 0 && in->triangle[t].across[k] != HR2DI_SKY)
        first[in->triangle[t].corner[k]] = 4 * (int32_t)t + k;
  return first;
}

static hr2d_status find(search *s, const int32_t *first) {
  const hr2d_scene *scene = s->of->scene;
  const hr2di_triangulation *in = &scene->plane.triangulation;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < in->edges && !status; k++) status = add_wall(s, &in->edge[k]);
  for (size_t k = 0; k < in->vertices && !status; k++)
    if (first[k] >= 0) status = view_from_end(s, first[k]);
  for (size_t k = 0; k < in->vertices && !status; k++)
    if (first[k] >= 0) status = add_suns(s, in->at[k]);
  for (size_t k = 0; k < 2 * in->edges && !status; k++)
    if (scene->parts.wanted[k]) status = view_from_parts(s, scene->parts.of_side[k].parts);
  for (size_t k = 0; k < scene->patches && !status; k++) status = view_from_jumps(s, k);
  return status;
}

size_t hr2di_borders_sources(const hr2di_light_source *of) {
  const hr2di_leaves *l = &of->leaves;
  return of->scene->plane.triangulation.vertices + of->scene->patches +
         (l->leaves ? l->group[l->leaves - 1] : 0);
}

hr2d_status hr2di_borders_find(hr2di_borders *b, const hr2di_light_source *of,
                               const hr2di_border_scale *scale, size_t max,
                               hr2di_watch *watch) {
  const hr2d_allocator alloc = of->scene->alloc;
  *b = (hr2di_borders){.alloc = alloc, .max = max};
  search s = {.to = b, .of = of, .scale = scale, .watch = watch};
  s.view = (hr2di_visibility_polygon){
      .scene = of->scene, .alloc = alloc, .watch = watch, .take = take, .ctx = &s};
  int32_t *first = first_walls(&of->scene->plane.triangulation, &alloc);
  hr2d_status status = first ? find(&s, first) : HR2D_ENOMEM;
  if (b->many) status = HR2D_OK;
  hr2di_alloc_free(&alloc, first);
  hr2di_alloc_free(&alloc, s.seen);
  hr2di_visibility_polygon_clear(&s.view);
  return status;
}

void hr2di_borders_clear(hr2di_borders *b) {
  hr2di_alloc_free(&b->alloc, b->border);
}
