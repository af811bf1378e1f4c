/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temperatures like degrees Celsius, wavelengths like metres or nanometres, and suns that light
   nothing. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "geometry/vector.h"
#include "lint/lint-impl.h"

/* Engineers have few scenes that are colder than LOW kelvin throughout, and weather has none
   above; SMALL is for those without units. */
#define LOW   150
#define SMALL 5

/* The part of a black body beside a border between bands below which it does not part them. */
#define NOTHING 1e-4

typedef struct range {
  double low, high;
} range;

static hr2d_status find_range(const hr2di_lint *lint, range *kelvin) {
  hr2d_status status = HR2D_OK;
  *kelvin = (range){HUGE_VAL, -HUGE_VAL};
  for (size_t k = 0; k < lint->scene->patches && !status; k++) {
    double value;
    status = hr2di_watch_work(lint->watch, 1);
    if (hr2d_scene_heat(lint->scene, k, &value) != HR2D_HEAT_TEMPERATURE) continue;
    kelvin->low = fmin(kelvin->low, value);
    kelvin->high = fmax(kelvin->high, value);
  }
  return status;
}

static hr2d_status warn_of_celsius(const hr2di_lint *lint, range kelvin) {
  if (!(kelvin.high >= SMALL && kelvin.high < LOW)) return HR2D_OK;
  return hr2di_lint_warn(lint, (hr2d_warning){.code = HR2D_WARNING_UNITS},
                         "temperatures from %.9g to %.9g look like degrees Celsius: write "
                         "kelvin, which are degrees Celsius + 273.15",
                         kelvin.low, kelvin.high);
}

/* Metres are so short that not even a double is left below; beyond nanometres that were meant
   there is nothing that even the coldest patch emits. */
static hr2d_status warn_of_wavelengths(const hr2di_lint *lint, range kelvin) {
  const hr2d_scene *scene = lint->scene;
  if (!scene->spectrum.wavelengths || !(kelvin.low > 0 && kelvin.high < DBL_MAX))
    return HR2D_OK;
  const double first = scene->spectrum.wavelength[0],
               last = scene->spectrum.wavelength[scene->spectrum.wavelengths - 1];
  const int metres = hr2d_black_body_part(kelvin.high, 0, last) == 0;
  const int nanometres = hr2d_black_body_part(kelvin.low, first, HUGE_VAL) < NOTHING;
  if (!metres && !nanometres) return HR2D_OK;
  return hr2di_lint_warn(
      lint, (hr2d_warning){.code = HR2D_WARNING_UNITS},
      "wavelengths from %.9g to %.9g look like %s, as no patch emits %s them: "
      "write micrometres",
      first, last, metres ? "metres" : "nanometres", metres ? "below" : "above");
}

/* The heat of a heater leaves both sides of it. */
static int has_flux(const hr2d_scene *scene, size_t patch) {
  const hr2di_light *light = scene->patch[patch].light;
  return light->heat == HR2D_HEAT_FLUX && light->power == 0;
}

/* A patch and its own back, which follows it. */
static int is_two_sided(const hr2d_scene *scene, size_t patch) {
  const hr2d_segment s = scene->patch[patch].given, t = scene->patch[patch + 1].given;
  return hr2di_point_same(s.a, t.b) && hr2di_point_same(s.b, t.a);
}

static hr2d_status warn_of_shields(const hr2di_lint *lint) {
  const hr2d_scene *scene = lint->scene;
  size_t shields = 0, first = 0;
  char more[40] = "";
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k + 1 < hr2di_scene_cell(scene) && !status; k++) {
    status = hr2di_watch_work(lint->watch, 1);
    if (!has_flux(scene, k) || !has_flux(scene, k + 1) || !is_two_sided(scene, k)) continue;
    if (!shields++) first = k;
    k++;
  }
  if (status || !shields) return status;
  if (shields > 1) snprintf(more, sizeof more, " and %zu more", shields - 1);
  return hr2di_lint_warn(
      lint, (hr2d_warning){.code = HR2D_WARNING_SHIELD, .patches = 1, .patch = {first}},
      "%s%s: each side has the flux that is given, so that no heat goes through, and the sides "
      "have two temperatures: a thin sheet, such as a radiation shield, has one; write "
      "\"shield\": true in the place of the flux",
      hr2di_patch_label(scene, first).text, more);
}

hr2d_status hr2di_lint_heat(const hr2di_lint *lint) {
  range kelvin;
  hr2d_status status = find_range(lint, &kelvin);
  if (!status) status = warn_of_celsius(lint, kelvin);
  if (!status) status = warn_of_wavelengths(lint, kelvin);
  return status ? status : warn_of_shields(lint);
}

/* Suns of a period whose light meets images that are cut off before it meets nothing more. */
static hr2d_status warn_of_low_suns(const hr2di_lint *lint) {
  const hr2d_scene *scene = lint->scene;
  const hr2di_symmetry *s = &scene->symmetry;
  char more[40] = "";
  if (!s->low_suns) return HR2D_OK;
  if (s->low_suns > 1) snprintf(more, sizeof more, " and %zu more", s->low_suns - 1);
  return hr2di_lint_warn(
      lint, (hr2d_warning){.code = HR2D_WARNING_LOW_SUN},
      "sun %zu%s is so low that it shines past more than %u images of the period: what is in "
      "its light beyond them is not known, and counts as shadow. Fronts may lack up to %.3g of "
      "it, and errors do not contain that; give this sun no irradiance, or a bearing farther "
      "from the period",
      s->low_sun, more, s->copies, scene->sun[s->low_sun].irradiance);
}

static hr2d_status warn_of_wrong_sun(const hr2di_lint *lint) {
  /* Of many suns some are below the horizon. */
  const hr2d_scene *scene = lint->scene;
  size_t band = 0;
  while (band < scene->sun_bands && !(scene->sun[band].irradiance > 0)) band++;
  if (band == scene->sun_bands || scene->sunlight.parts > 0) return HR2D_OK;
  const hr2d_point d = scene->sun[band].direction;
  return hr2di_lint_warn(lint, (hr2d_warning){.code = HR2D_WARNING_NO_SUNLIGHT},
                         "the sun lights the front of no patch: its light travels in direction "
                         "(%.9g, %.9g), \"direction\"; a \"bearing\" is where it stands, "
                         "clockwise from +y",
                         d.x, d.y);
}

hr2d_status hr2di_lint_suns(const hr2di_lint *lint, int blind) {
  const hr2d_status status = blind ? HR2D_OK : warn_of_wrong_sun(lint);
  return status ? status : warn_of_low_suns(lint);
}
