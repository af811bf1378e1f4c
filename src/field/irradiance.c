/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The irradiance H(n) of a plane at a point: n·Φ(n) with Φ(n) = ∫ (B/2) ω dω over n·ω > 0.

   What is past the ends of a period is a series in 1/k of what the last images show.  A plane
   whose horizon passes through these images cuts the series.  If n is turned by τ from n₀
   across the period,

     H(n) = n·Φ(n₀) + ∫₀^τ sin(τ − s) b(s) ds,   2 b = the sum of B at both horizons,

   and Φ(n₀) has a series, as each image is above its plane or below.  So has H(n₁) for the
   smallest τ₁ at which the plane is clear of the images.  Between them b is taken for constant,
   which the difference at τ₁ gives: B of far images varies with 1/k.  As b is between 0 and the
   largest radiosity, so is the error. */
#include <math.h>
#include <string.h>

#include "field/field-at.h"
#include "field/past-ends.h"
#include "geometry/vector.h"
#include "scene/sky.h"

/* What is known of H(n), for all bands. */
typedef struct plane {
  const hr2di_light_source *of;
  const hr2d_field_values *to;
  hr2d_point normal; /* of length 1 */
  size_t first;      /* value of band 0 */
  int dark, knows;
} plane;

static void write(const plane *p, size_t band, double irradiance, double error) {
  const size_t k = p->first + band;
  if (p->to->irradiance) p->to->irradiance[k] = p->dark ? NAN : fmax(irradiance, 0);
  if (p->to->irradiance_error) p->to->irradiance_error[k] = p->dark || !p->knows ? NAN : error;
}

static double along(hr2d_point normal, const double *flux, size_t band) {
  return hr2di_point_dot(normal, (hr2d_point){flux[2 * band], flux[2 * band + 1]});
}

static hr2d_status look_once(hr2di_field_worker *w, const plane *p, hr2d_point x) {
  hr2di_field_above seen;
  const hr2d_status status = hr2di_field_look_above(w, p->of, x, p->normal, &seen);
  for (size_t b = 0; b < p->of->solution->bands; b++)
    write(p, b, along(p->normal, seen.flux, b), seen.error[b]);
  return status;
}

/* n₀ across a period with a direction, and n₁ turned from it by an angle towards n. */
static void set_normals(hr2d_point n, hr2d_point period, double angle, hr2d_point turned[2]) {
  const double side = hr2di_point_cross(period, n) < 0 ? -1 : 1,
               to = hr2di_point_dot(period, n) < 0 ? -1 : 1;
  turned[0] = (hr2d_point){-side * period.y, side * period.x};
  turned[1] = (hr2d_point){cos(angle) * turned[0].x + to * sin(angle) * period.x,
                           cos(angle) * turned[0].y + to * sin(angle) * period.y};
}

static hr2d_status look_twice(hr2di_field_worker *w, const plane *p, hr2d_point x,
                              hr2d_point period, double angle) {
  const size_t bands = p->of->solution->bands;
  double *flux = w->room + HR2DI_FIELD_LOOK * bands, *error = flux + 2 * bands;
  hr2d_point turned[2];
  hr2di_field_above seen;
  set_normals(p->normal, period, angle, turned);
  hr2d_status status = hr2di_field_look_above(w, p->of, x, turned[0], &seen);
  memcpy(flux, seen.flux, 2 * bands * sizeof *flux);
  memcpy(error, seen.error, bands * sizeof *error);
  if (!status) status = hr2di_field_look_above(w, p->of, x, turned[1], &seen);
  /* 1 − cos τ, without cancellation. */
  const double sine = hr2di_point_dot(period, p->normal), half = sin(angle / 2);
  const double is = sine * sine / (1 + sqrt(1 - sine * sine)), part = is / (2 * half * half);
  for (size_t b = 0; b < bands; b++) {
    const double more = part * (along(turned[1], seen.flux, b) - along(turned[1], flux, b));
    const double max = is * fmax(p->of->leaves.scale[b], hr2di_sky_max(p->of->scene, b));
    write(p, b, along(p->normal, flux, b) + more,
          (1 + part) * error[b] + part * seen.error[b] + fmax(more, max - fmax(more, 0)));
  }
  return status;
}

hr2d_status hr2di_field_irradiance(hr2di_field_worker *w, const hr2di_field_call *f,
                                   hr2d_point x, hr2d_place place, size_t k) {
  const hr2di_light_source *of = &f->source;
  if (!f->values.irradiance && !f->values.irradiance_error) return HR2D_OK;
  const plane p = {.of = of,
                   .to = &f->values,
                   .normal =
                       hr2di_point_unit(f->options.normal[f->options.normals > 1 ? k : 0]),
                   .first = k * of->solution->bands,
                   .dark = place == HR2D_PLACE_OUTSIDE,
                   .knows = of->patch_error || of->element_error};
  hr2di_far_view far;
  hr2di_far_view_init(&far, of->scene, hr2di_far_home(of->scene, x));
  if (far.quadrants == 0) return look_once(w, &p, x);
  const hr2d_point period = far.quadrant[0].out;
  const double angle = hr2di_far_angle(&far), sine = hr2di_point_dot(period, p.normal);
  return !far.far && sine != 0 && fabs(sine) < sin(angle) ? look_twice(w, &p, x, period, angle)
                                                          : look_once(w, &p, x);
}
