/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mirrors and periods as they are given, and what they generate. */
#include "scene/symmetry.h"

#include <hr2d/symmetry.h>
#include <math.h>

#include "geometry/crossings.h"
#include "geometry/orient-sign.h"
#include "scene/scene-impl.h"

static int is_finite(hr2d_point p) {
  return isfinite(p.x) && isfinite(p.y);
}

hr2d_status hr2d_scene_add_mirror(hr2d_scene *scene, hr2d_segment line) {
  if (!scene) return HR2D_EINVAL;
  hr2di_symmetry *s = &scene->symmetry;
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE,
                              "a committed scene takes no more mirrors");
  if (!is_finite(line.a) || !is_finite(line.b) ||
      (line.a.x == line.b.x && line.a.y == line.b.y))
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "mirror %zu: from (%g, %g) to (%g, %g) there is no line",
                              s->mirrors, line.a.x, line.a.y, line.b.x, line.b.y);
  if (s->mirrors == HR2DI_MIRRORS)
    return hr2di_message_fail(&scene->message, HR2D_EUNSUPPORTED,
                              "more than %d mirrors are not supported", HR2DI_MIRRORS);
  s->mirror[s->mirrors++] = line;
  return HR2D_OK;
}

hr2d_status hr2d_scene_set_period(hr2d_scene *scene, hr2d_point period) {
  if (!scene) return HR2D_EINVAL;
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE,
                              "a committed scene takes no period");
  if (!is_finite(period))
    return hr2di_message_fail(&scene->message, HR2D_ESCENE, "the period is not finite");
  scene->symmetry.period = period;
  return HR2D_OK;
}

size_t hr2d_scene_mirrors(const hr2d_scene *scene) {
  if (!scene) return 0;
  return scene->symmetry.mirrors;
}

hr2d_segment hr2d_scene_mirror(const hr2d_scene *scene, size_t mirror) {
  if (!scene || mirror >= scene->symmetry.mirrors)
    return (hr2d_segment){{NAN, NAN}, {NAN, NAN}};
  return scene->symmetry.mirror[mirror];
}

hr2d_point hr2d_scene_period(const hr2d_scene *scene) {
  if (!scene) return (hr2d_point){NAN, NAN};
  return scene->symmetry.period;
}

size_t hr2d_scene_images(const hr2d_scene *scene) {
  if (!scene) return 0;
  return scene->symmetry.motion ? scene->symmetry.motions : 1;
}

hr2d_segment hr2d_scene_image(const hr2d_scene *scene, size_t patch, size_t image) {
  if (!scene || patch >= hr2di_scene_cell(scene) || image >= hr2d_scene_images(scene))
    return (hr2d_segment){{NAN, NAN}, {NAN, NAN}};
  return hr2d_scene_segment(scene, image * scene->symmetry.cell + patch);
}

double hr2d_scene_cut_off(const hr2d_scene *scene) {
  if (!scene) return NAN;
  return scene->symmetry.motion ? scene->symmetry.rest : 0;
}

double hr2di_symmetry_weight(const hr2di_symmetry *s, size_t first, size_t second,
                             int directed) {
  if (!s->motion) return 1;
  const size_t images = s->motions * s->cell;
  if (first >= images || second >= images) return 0;
  if (directed && first >= s->cell) return 0;
  const size_t image = first < s->cell ? second : first,
               patch = first < s->cell ? first : second;
  if (patch >= s->cell) return 0;
  const size_t number = image / s->cell, other = image % s->cell;
  const hr2di_motion *g = &s->motion[number];
  if (number == 0 || directed) return g->weight;
  if (patch != other) return patch < other ? g->weight : 0;
  if (g->inverse == number) return 0.5 * g->weight;
  return g->inverse < number ? 0 : g->weight;
}

double hr2di_symmetry_check(const hr2di_symmetry *s, size_t first, size_t second, int check) {
  const size_t image = first < s->cell ? second : first;
  const hr2di_motion *g = &s->motion[image / s->cell];
  return (check == HR2DI_CHECK_ALL ? g->weight - 1 : g->check[check]) / g->weight;
}

double hr2di_symmetry_max(const hr2di_symmetry *s) {
  double upper = 1;
  for (size_t k = 0; s->motion && k < s->motions; k++) {
    const hr2di_motion *g = &s->motion[k];
    upper = fmax(upper, fabs(g->weight));
    for (int c = 0; c < HR2DI_TAIL_CHECKS; c++) upper = fmax(upper, fabs(g->check[c]));
  }
  return upper;
}

/* Directions whose sine or cosine is no more are parallel or perpendicular. */
#define ALONG 1e-12

typedef enum angle { PARALLEL, ACROSS, OBLIQUE } angle;

static angle angle_of(hr2d_point u, hr2d_point v) {
  const double sizes = hypot(u.x, u.y) * hypot(v.x, v.y);
  if (fabs(u.x * v.y - u.y * v.x) <= ALONG * sizes) return PARALLEL;
  return fabs(u.x * v.x + u.y * v.y) <= ALONG * sizes ? ACROSS : OBLIQUE;
}

static hr2d_point direction(hr2d_segment s) {
  return (hr2d_point){s.b.x - s.a.x, s.b.y - s.a.y};
}

/* The distance of a point to the left of a line with a unit direction. */
static double left_of(hr2d_point at, hr2d_point along, hr2d_point p) {
  return along.x * (p.y - at.y) - along.y * (p.x - at.x);
}

double hr2di_symmetry_touch(const hr2d_scene *scene) {
  double max = 0;
  const size_t cell = hr2di_symmetry_cell(&scene->symmetry, scene->patches);
  for (size_t k = 0; k < cell; k++) {
    const hr2d_segment s = scene->patch[k].given;
    max = fmax(max, fmax(fmax(fabs(s.a.x), fabs(s.a.y)), fmax(fabs(s.b.x), fabs(s.b.y))));
  }
  return 0x1p-49 * max;
}

/* The ends are K periods away. */
double hr2di_symmetry_sliver(const hr2d_scene *scene) {
  const hr2di_symmetry *s = &scene->symmetry;
  if (s->ends == 0) return 0;
  return hr2di_symmetry_touch(scene) / (s->copies * hypot(s->by.period.x, s->by.period.y));
}

/* A point of a mirror.  From one that is much farther from the patches than these are large,
   the distance of a patch would have few digits: then it is the foot of a patch, by an exact
   determinant. */
#define FAR 4

static hr2d_point point_near(const hr2d_scene *scene, hr2d_segment line) {
  const hr2d_point p = scene->patch[0].given.a;
  const double size = hr2di_symmetry_touch(scene) * 0x1p+49;
  if (hypot(line.a.x - p.x, line.a.y - p.y) <= FAR * size) return line.a;
  const hr2d_point d = direction(line);
  const double far = hypot(d.x, d.y),
               off = hr2di_crossings_distance(p, &line) * hr2di_orient_sign(line.a, line.b, p);
  return (hr2d_point){p.x + off * (d.y / far), p.y - off * (d.x / far)};
}

static void add_generator(hr2di_generators *by, hr2d_point at, hr2d_point along) {
  by->at[by->mirrors] = at;
  by->along[by->mirrors++] = along;
}

static hr2d_status set_period(hr2d_scene *scene, hr2d_point period) {
  hr2di_generators *by = &scene->symmetry.by;
  if (by->periodic)
    return hr2di_message_fail(
        &scene->message, HR2D_EUNSUPPORTED,
        "mirrors and period repeat the scene in two directions, or in two "
        "ways: parallel mirrors make a period, and need no other");
  by->periodic = 1;
  by->period = period;
  return HR2D_OK;
}

/* Takes one more mirror: it makes a period with a parallel one, or is a generator. */
static hr2d_status take_mirror(hr2d_scene *scene, size_t number) {
  hr2di_symmetry *s = &scene->symmetry;
  hr2di_generators *by = &s->by;
  const hr2d_segment line = s->mirror[number];
  const hr2d_point d = direction(line);
  const double size = hypot(d.x, d.y);
  const hr2d_point at = point_near(scene, line);
  hr2d_point along = {d.x / size, d.y / size};
  for (size_t k = 0; k < by->mirrors; k++) {
    const hr2d_point u = by->along[k];
    const angle a = angle_of(u, d);
    if (a == OBLIQUE)
      return hr2di_message_fail(
          &scene->message, HR2D_ESCENE,
          "mirror %zu is neither parallel nor perpendicular to another one", number);
    const double off = left_of(by->at[k], u, at);
    if (a == PARALLEL && fabs(off) <= hr2di_symmetry_touch(scene))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE, "mirror %zu is on another one",
                                number);
    if (a == PARALLEL) return set_period(scene, (hr2d_point){-2 * off * u.y, 2 * off * u.x});
    along = (hr2d_point){-u.y, u.x};
  }
  add_generator(by, at, along);
  return HR2D_OK;
}

/* A mirror, and what of the patches is farthest on its left and on its right. */
typedef struct sides {
  hr2d_point at, along;
  double far[2];
  size_t max[2];
} sides;

static sides sides_of(const hr2d_scene *scene, hr2d_segment line, double touch) {
  const hr2d_point d = direction(line);
  const double size = hypot(d.x, d.y);
  sides s = {point_near(scene, line), {d.x / size, d.y / size}, {touch, touch}, {0, 0}};
  for (size_t k = 0; k < scene->patches; k++) {
    const hr2d_segment at = scene->patch[k].given;
    const double off[2] = {left_of(s.at, s.along, at.a), left_of(s.at, s.along, at.b)};
    for (int m = 0; m < 4; m++) {
      const double far = m % 2 ? -off[m / 2] : off[m / 2];
      if (far > s.far[m % 2]) s.max[m % 2] = k;
      s.far[m % 2] = fmax(s.far[m % 2], far);
    }
  }
  return s;
}

static hr2d_status fail_sides(hr2d_scene *scene, const sides *s, size_t number) {
  if (s->max[0] == s->max[1])
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "%s is on both sides of mirror %zu, %.3g on one: everything must "
                              "be on one side of a mirror",
                              hr2di_patch_label(scene, s->max[0]).text, number,
                              fmin(s->far[0], s->far[1]));
  return hr2di_message_fail(
      &scene->message, HR2D_ESCENE,
      "mirror %zu has %s on its left and %s on its right: everything must be on one side of a "
      "mirror, because what is behind it is the image",
      number, hr2di_patch_label(scene, s->max[0]).text,
      hr2di_patch_label(scene, s->max[1]).text);
}

/* Patches on both sides of a mirror are refused, and those on it that look away. */
static hr2d_status check_sides(hr2d_scene *scene, size_t number) {
  const double touch = hr2di_symmetry_touch(scene);
  const sides s = sides_of(scene, scene->symmetry.mirror[number], touch);
  if (s.far[0] > touch && s.far[1] > touch) return fail_sides(scene, &s, number);
  const double side = s.far[0] > touch ? 1 : -1;
  for (size_t k = 0; k < scene->patches; k++) {
    const hr2d_segment at = scene->patch[k].given;
    const hr2d_point u = direction(at);
    if (fabs(left_of(s.at, s.along, at.a)) > touch ||
        fabs(left_of(s.at, s.along, at.b)) > touch)
      continue;
    if (side * (u.x * s.along.x + u.y * s.along.y) < 0)
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "%s lies on mirror %zu and faces away from the scene",
                                hr2di_patch_label(scene, k).text, number);
  }
  return HR2D_OK;
}

static hr2d_status check_period(hr2d_scene *scene) {
  const hr2di_generators *by = &scene->symmetry.by;
  for (size_t k = 0; k < by->mirrors && by->periodic; k++)
    if (angle_of(by->along[k], by->period) == OBLIQUE)
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "a mirror is neither parallel nor perpendicular to the period");
  return HR2D_OK;
}

/* What a continuous sky may be off, as its polynomials are other ones on the image. */
#define SKY_OFF 1e-10

/* Whether the sky has the same light in a direction and its image. */
static int sky_matches(const hr2d_scene *scene, hr2d_point along, double bearing) {
  const double axis = 90 - atan2(along.y, along.x) * (180 / 3.14159265358979323846);
  for (size_t b = 0; b < scene->sky.bands; b++) {
    const double here = hr2d_scene_sky(scene, bearing, b);
    const double off = fabs(here - hr2d_scene_sky(scene, 2 * axis - bearing, b));
    const double may =
        hr2di_sky_is_continuous(&scene->sky) ? SKY_OFF * hr2di_sky_max(scene, b) : 0;
    if (!(off <= may)) return 0;
  }
  return 1;
}

/* Light from outside must be symmetric, too. */
static hr2d_status check_outside(hr2d_scene *scene, hr2d_point along, size_t number) {
  const hr2d_point normal = {-along.y, along.x};
  for (size_t k = 0; k < scene->sun_bands; k++) {
    const hr2d_point d = scene->sun[k].direction;
    if (scene->sun[k].irradiance > 0 &&
        !(fabs(d.x * normal.x + d.y * normal.y) <= ALONG * hypot(d.x, d.y)))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "sun %zu shines across mirror %zu: only a sun whose light runs "
                                "along it is symmetric",
                                k, number);
  }
  for (size_t k = 0; k < scene->sky.pieces; k++) {
    const double from = scene->sky.piece[k].from, size = scene->sky.piece[k].to - from;
    for (int m = 0; m < 2; m++)
      if (!sky_matches(scene, along, from + (m ? 1 - 1e-7 : 1e-7) * size))
        return hr2di_message_fail(
            &scene->message, HR2D_ESCENE,
            "piece %zu of the sky has no image in mirror %zu: the sky must "
            "be symmetric",
            k, number);
  }
  return HR2D_OK;
}

hr2d_status hr2di_symmetry_find(hr2d_scene *scene, hr2di_watch *watch) {
  hr2di_symmetry *s = &scene->symmetry;
  s->by = (hr2di_generators){0};
  hr2d_status status = HR2D_OK;
  if (s->period.x != 0 || s->period.y != 0) status = set_period(scene, s->period);
  for (size_t k = 0; k < s->mirrors && !status; k++) {
    status = hr2di_watch_work(watch, 1 + scene->patches / 4);
    if (status) return hr2di_scene_fail(scene, status, watch, "the mirrors");
    status = check_sides(scene, k);
    if (!status) status = take_mirror(scene, k);
  }
  if (!status) status = check_period(scene);
  for (size_t k = 0; k < s->by.mirrors && !status; k++)
    status = check_outside(scene, s->by.along[k], k);
  return status;
}

/* At a mirror through `at`. */
static hr2d_point reflect(hr2d_point at, hr2d_point u, hr2d_point p, double touch) {
  const double off = left_of(at, u, p);
  if (fabs(off) <= touch) return p;
  return (hr2d_point){p.x + 2 * off * u.y, p.y - 2 * off * u.x};
}

hr2d_point hr2di_symmetry_move(const hr2di_generators *by, const hr2di_motion *g, hr2d_point p,
                               double touch) {
  for (size_t m = 0; m < by->mirrors; m++)
    if (g->mirrors >> m & 1) p = reflect(by->at[m], by->along[m], p, touch);
  return (hr2d_point){p.x + g->periods * by->period.x, p.y + g->periods * by->period.y};
}
