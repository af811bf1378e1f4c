/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Angles are from the direction to the end, φ = 0, towards the border of the strip. */
#include "field/past-ends.h"

#include <math.h>

#include "base/pi.h"
#include "geometry/vector.h"

/* From above the patches or below, as a part of the length of the images: there the error of
   the series is some 1e-3 of what is past the ends. */
#define FARTHEST 0.25

void hr2di_far_view_init(hr2di_far_view *v, const hr2d_scene *scene, hr2d_point x) {
  const double unit = hr2d_scene_unit(scene);
  *v = (hr2di_far_view){.scene = scene};
  if (!scene->symmetry.motion || !scene->symmetry.by.periodic) return;
  v->quadrants = 4;
  for (int k = 0; k < 4; k++) {
    hr2di_quadrant *q = &v->quadrant[k];
    *q = hr2di_symmetry_quadrant(&scene->symmetry, (hr2d_point){unit * x.x, unit * x.y}, k % 2,
                                 k / 2);
    v->far |= -q->border > FARTHEST * scene->symmetry.copies * q->period;
  }
}

hr2d_point hr2di_far_home(const hr2d_scene *scene, hr2d_point x) {
  const double unit = hr2d_scene_unit(scene);
  if (!scene->symmetry.motion || !scene->symmetry.by.periodic) return x;
  const hr2d_point home =
      hr2di_symmetry_home(&scene->symmetry, (hr2d_point){unit * x.x, unit * x.y});
  return (hr2d_point){home.x / unit, home.y / unit};
}

/* Shows what a stretch has in common with a range of φ; its own one begins at `from` and is not
   turned to [−π, π]. */
static void show_common(const hr2di_quadrant *q, double from, double to, hr2di_far_part part,
                        const double range[2], hr2di_far_fn show, void *ctx) {
  const int left_turn = hr2di_point_cross(q->out, q->up) > 0;
  for (int turn = -1; turn <= 1; turn++) {
    const double low = fmax(from + turn * 2 * HR2DI_PI, range[0]),
                 high = fmin(to + turn * 2 * HR2DI_PI, range[1]);
    if (!(high > low)) continue;
    hr2d_point at[2];
    for (int k = 0; k < 2; k++) {
      const double c = cos(k ? high : low), s = sin(k ? high : low);
      at[k] = (hr2d_point){c * q->out.x + s * q->up.x, c * q->out.y + s * q->up.y};
    }
    part.right = at[left_turn ? 0 : 1];
    part.left = at[left_turn ? 1 : 0];
    part.angle = high - low;
    show(ctx, &part);
  }
}

static void show_quadrant(const hr2di_far_view *v, const hr2di_quadrant *q,
                          const hr2di_round_stretch *s, hr2di_far_fn show, void *ctx) {
  const hr2di_symmetry *all = &v->scene->symmetry;
  const hr2di_tail *t = &all->points;
  const int left_turn = hr2di_point_cross(q->out, q->up) > 0;
  const hr2d_point first = left_turn ? s->right : s->left;
  const double from = atan2(hr2di_point_dot(first, q->up), hr2di_point_dot(first, q->out));
  for (unsigned k = 0; k <= all->copies; k++) {
    double distance[2];
    if (k > 0 && t->weight[k] == 0 && t->half[k] == 0) continue;
    hr2di_quadrant_of(all, q, k, distance);
    const double range[2] = {atan2(q->border, distance[1]), atan2(q->border, distance[0])};
    const hr2di_far_part part = {.past = k == 0,
                                 .weight = t->weight[k],
                                 .check = {t->check[0][k], t->check[1][k]},
                                 .half = t->half[k],
                                 .late = 2 * k > all->copies,
                                 .bearing = hr2di_quadrant_bearing(q)};
    show_common(q, from, from + s->angle, part, range, show, ctx);
  }
}

void hr2di_far_sky(const hr2di_far_view *v, const hr2di_round_stretch *s, hr2di_far_fn show,
                   void *ctx) {
  for (int k = 0; k < v->quadrants; k++)
    if (v->quadrant[k].border > 0) show_quadrant(v, &v->quadrant[k], s, show, ctx);
}

static int is_inside(hr2d_point right, hr2d_point left, hr2d_point d) {
  return hr2di_point_cross(right, d) > 0 && hr2di_point_cross(d, left) > 0;
}

int hr2di_far_changes(const hr2d_scene *scene, hr2d_point right, hr2d_point left) {
  for (size_t k = 0; k < scene->sun_bands; k++)
    if (scene->sun[k].irradiance > 0 &&
        is_inside(right, left,
                  (hr2d_point){-scene->sun[k].direction.x, -scene->sun[k].direction.y}))
      return 1;
  for (size_t k = 0; k < 2 * scene->sky.pieces; k++) {
    const hr2d_sky_piece *p = &scene->sky.piece[k / 2];
    const double bearing = k % 2 ? p->to : p->from;
    if (!hr2di_symmetry_is_along(&scene->symmetry, bearing) &&
        is_inside(right, left, hr2di_sky_direction(bearing)))
      return 1;
  }
  return 0;
}
