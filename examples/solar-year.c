/* A year of rows of solar panels, hour by hour, in one solve.  You learn to give each band a
   sun of its own, to turn a sun in space into one of the section, and to read what comes
   straight from it.

   Three rows of bifacial panels run from east to west at a latitude of 50 degrees, over ground
   of albedo 0.2.  The section looks to the west: +x is north, and fronts look up and to the
   south. Each of 8,760 hours is a band, with a clear sky: all bands share elements, links, and
   views.

   Beside it stand a formula for the shaded part of a row behind another one (Passias and
   Källbäck 1984), and hours that are solved alone to 1e-6. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { HOURS = 8760, ROWS = 3, PATCHES = 1 + 2 * ROWS };

static const double pi = 3.14159265358979324;
static const double tilt = 30, width = 2, clearance = 0.5, pitch = 4, latitude = 50;

typedef struct hours {
  hr2d_sun *sun;
  double *sky;
  size_t count;
} hours;

static double degrees(double x) {
  return x * pi / 180;
}

/* Where the sun stands, south, west and up, from its declination and hour angle.  What lies
   along the rows does not shine in the section. */
static void set_hour(hours *all, size_t at, size_t hour) {
  const double day = (double)(hour / 24) + 1, turn = degrees(15 * ((double)(hour % 24) - 11.5));
  const double d = degrees(23.45) * sin(2 * pi * (day + 284) / 365), phi = degrees(latitude);
  const double up = sin(phi) * sin(d) + cos(phi) * cos(d) * cos(turn);
  const double south = sin(phi) * cos(d) * cos(turn) - cos(phi) * sin(d);
  const double beam = up > 0.02 ? 1100 * exp(-0.2 / up) : 0;
  all->sun[at] = (hr2d_sun){{south, -up}, beam * hypot(south, up)};
  all->sky[at] = up > 0.02 ? 120 * up : 0;
}

static hr2d_point on_row(int row, double distance) {
  return (hr2d_point){row * pitch + distance * cos(degrees(tilt)),
                      clearance + distance * sin(degrees(tilt))};
}

static hr2d_status make_scene(const hours *of, hr2d_scene **scene) {
  const double albedo = 0.2, glass = 0.05;
  hr2d_patch ground = HR2D_PATCH_INIT, panel = HR2D_PATCH_INIT;
  ground.a = (hr2d_point){-30, 0};
  ground.b = (hr2d_point){40, 0};
  ground.reflectance = &albedo;
  panel.reflectance = &glass;
  ground.reflectance_bands = panel.reflectance_bands = 1;
  panel.sides = HR2D_SIDES_BOTH;
  hr2d_status status = hr2d_scene_create(NULL, scene);
  if (!status) status = hr2d_scene_add(*scene, &ground, NULL);
  for (int row = 0; row < ROWS && !status; row++) {
    panel.a = on_row(row, 0);
    panel.b = on_row(row, width);
    status = hr2d_scene_add(*scene, &panel, NULL);
  }
  if (!status) status = hr2d_scene_set_sun(*scene, of->sun, of->count);
  if (!status) status = hr2d_scene_set_background(*scene, of->sky, of->count);
  return status ? status : hr2d_scene_commit(*scene);
}

/* The part of a row that the row before it shades, if that is south of it. */
static double shaded_part(const hr2d_sun *sun) {
  const double tangent = -sun->direction.y / sun->direction.x;
  if (!(sun->direction.x > 0)) return 0;
  const double part =
      1 - pitch * tangent / (width * (cos(degrees(tilt)) * tangent + sin(degrees(tilt))));
  return fmax(part, 0);
}

/* The largest difference of the middle row's sunlight from the formula, in W/m². */
static double compare_shades(const hr2d_scene *scene, const hours *year) {
  double worst = 0;
  for (size_t h = 0; h < HOURS; h++) {
    const double first = hr2d_scene_sunlight(scene, 1, h);
    const double formula = first * (1 - shaded_part(&year->sun[h]));
    worst = fmax(worst, fabs(hr2d_scene_sunlight(scene, 3, h) - formula));
  }
  return worst;
}

/* The largest difference of H on panels from that of an hour alone, as a part of the largest.
 */
static hr2d_status compare_hours(const hr2d_solution *year, double *worst) {
  hr2d_status status = HR2D_OK;
  for (size_t h = 8; h < HOURS && !status; h += 397) {
    hr2d_sun sun;
    double sky;
    hours one = {&sun, &sky, 1};
    hr2d_scene *scene = NULL;
    hr2d_solution *alone = NULL;
    hr2d_target target = HR2D_TARGET_INIT;
    target.error = 1e-6;
    set_hour(&one, 0, h);
    if (!(sun.irradiance > 0)) continue;
    status = make_scene(&one, &scene);
    if (!status) status = hr2d_solve_to(scene, &target, &alone, NULL);
    for (size_t k = 1; k < PATCHES && !status; k++) {
      const double exact = hr2d_solution_irradiance(alone, k, 0);
      *worst =
          fmax(*worst, fabs(hr2d_solution_irradiance(year, k, h) - exact) / sun.irradiance);
    }
    hr2d_solution_destroy(alone);
    hr2d_scene_destroy(scene);
  }
  return status;
}

static void print_year(const hr2d_scene *scene, const hr2d_solution *solution) {
  printf("kWh/m2 in a year    all  of the sun\n");
  for (size_t k = 1; k < PATCHES; k++) {
    double all = 0, sun = 0;
    for (size_t h = 0; h < HOURS; h++) {
      all += hr2d_solution_irradiance(solution, k, h) / 1000;
      sun += hr2d_scene_sunlight(scene, k, h) / 1000;
    }
    printf("row %zu, %-5s  %10.0f  %10.0f\n", (k + 1) / 2, k % 2 ? "front" : "back", all, sun);
  }
}

int main(void) {
  hours year = {malloc(HOURS * sizeof *year.sun), malloc(HOURS * sizeof *year.sky), HOURS};
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_account account;
  hr2d_target target = HR2D_TARGET_INIT;
  double worst = 0;
  hr2d_status status = year.sun && year.sky ? HR2D_OK : HR2D_ENOMEM;
  for (size_t h = 0; h < HOURS && !status; h++) set_hour(&year, h, h);
  if (!status) status = make_scene(&year, &scene);
  target.error = 1e-3;
  target.no_error = 1; /* the hours below show it */
  if (!status) status = hr2d_solve_to(scene, &target, &solution, &account);
  if (!status) print_year(scene, solution);
  if (!status)
    printf("off the shading formula: below 1e-9 W/m2: %s\n",
           compare_shades(scene, &year) < 1e-9 ? "yes" : "no");
  if (!status) status = compare_hours(solution, &worst);
  if (!status)
    printf("off hours solved alone: below 0.001 of the beam: %s\n",
           worst < 1e-3 ? "yes" : "no");
  if (status) fprintf(stderr, "solar-year: %s\n", hr2d_strerror(status));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  free(year.sun);
  free(year.sky);
  return status != HR2D_OK;
}
