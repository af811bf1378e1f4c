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

double hr2di_far_angle(const hr2di_far_view *v) {
  const hr2di_symmetry *all = &v->scene->symmetry;
  double most = 0;
  unsigned first =
      1; /* the first image that counts, of which patches may begin a period before */
  while (v->quadrants > 0 && first < all->copies && all->points.weight[first] == 0) first++;
  for (int k = 0; k < v->quadrants; k++) {
    const hr2di_quadrant *q = &v->quadrant[k];
    const double distance = q->line - (all->copies - first + 2) * q->period;
    most = fmax(most, atan2(fabs(q->border), fmax(distance, 0)));
  }
  return most;
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
                          const hr2di_polygon_arc *s, hr2di_far_fn show, void *ctx) {
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
                                 .second_half = 2 * k > all->copies,
                                 .bearing = hr2di_quadrant_bearing(q)};
    show_common(q, from, from + s->angle, part, range, show, ctx);
  }
}

void hr2di_far_sky(const hr2di_far_view *v, const hr2di_polygon_arc *s, hr2di_far_fn show,
                   void *ctx) {
  for (int k = 0; k < v->quadrants; k++)
    if (v->quadrant[k].border > 0) show_quadrant(v, &v->quadrant[k], s, show, ctx);
}

static int is_inside(hr2d_point right, hr2d_point left, hr2d_point d) {
  return hr2di_point_cross(right, d) > 0 && hr2di_point_cross(d, left) > 0;
}

int hr2di_far_changes(const hr2d_scene *scene, hr2d_point right, hr2d_point left) {
  for (size_t k = 0; k < 2 * scene->sky.pieces; k++) {
    double bearing;
    if (hr2di_sky_edge(scene, k, &bearing) &&
        !hr2di_symmetry_is_along(&scene->symmetry, bearing) &&
        is_inside(right, left, hr2di_sky_direction(bearing)))
      return 1;
  }
  return 0;
}

int hr2di_far_sees_suns(const hr2d_scene *scene, hr2d_point x) {
  hr2di_far_view v;
  hr2di_far_view_init(&v, scene, hr2di_far_home(scene, x));
  for (size_t k = 0; k < scene->sun_bands && v.quadrants > 0; k++)
    for (int m = 0; m < v.quadrants; m++) {
      const hr2di_quadrant *q = &v.quadrant[m];
      const hr2d_point light = scene->sun[k].direction;
      const double out = -hr2di_point_dot(light, q->out), up = -hr2di_point_dot(light, q->up);
      if (scene->sun[k].irradiance > 0 && out > 0 && up > 0 &&
          q->border * out > (q->line - q->period) * up)
        return 1;
    }
  return 0;
}

/* A ray across a strip: `off` is how far along the period a point is before the ray, and
   `ahead` how far across it is after its start. */
typedef struct ray {
  hr2d_point start, along, across;
  double slope; /* along for each step across */
} ray;

static double ahead(const ray *r, hr2d_point p) {
  return hr2di_point_dot(r->across, hr2di_point_minus(p, r->start));
}

static double off(const ray *r, hr2d_point p) {
  return hr2di_point_dot(r->along, hr2di_point_minus(p, r->start)) - r->slope * ahead(r, p);
}

/* What is nearer to the start, as a part of the height of a patch, is where it starts. */
#define STARTS 1e-12

/* Whether a patch that is repeated with a period is in the way: its part that is ahead has a
   multiple of the period between its ends. */
static int is_in_the_way(const ray *r, hr2d_segment s, double period) {
  double far[2] = {ahead(r, s.a), ahead(r, s.b)}, at[2] = {off(r, s.a), off(r, s.b)};
  const double min = STARTS * fmax(fabs(far[0]), fabs(far[1]));
  if (far[0] <= min && far[1] <= min) return 0;
  for (int k = 0; k < 2; k++)
    if (far[k] < min) at[k] += (at[1 - k] - at[k]) * (min - far[k]) / (far[1 - k] - far[k]);
  return floor(at[0] / period) != floor(at[1] / period);
}

int hr2di_far_sun_shines(const hr2d_scene *scene, hr2d_point x, size_t band) {
  const hr2di_symmetry *s = &scene->symmetry;
  const double unit = hr2d_scene_unit(scene), size = hypot(s->by.period.x, s->by.period.y);
  const hr2d_point light = hr2d_scene_sun(scene, band).direction,
                   along = {s->by.period.x / size, s->by.period.y / size};
  const double turn = hr2di_point_cross(along, light) < 0 ? 1 : -1;
  const ray r = {.start = {unit * x.x, unit * x.y},
                 .along = along,
                 .across = {-turn * along.y, turn * along.x},
                 .slope =
                     turn * hr2di_point_dot(along, light) / hr2di_point_cross(along, light)};
  for (size_t k = 0; k < s->cell << s->by.mirrors; k++)
    if (is_in_the_way(&r, scene->patch[k].given, size)) return 0;
  return 1;
}
