/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Radiation through a cavity of a window frame.  You learn what the formulas of two standards
   leave out, and how to give a wall one temperature.

   Both take a rectangular cavity, of width b and depth d along the heat flow, as two plates and
   insulated walls between them.  By crossed strings f = √(1 + (d/b)²) − d/b goes from plate to
   plate; what meets a wall comes back from it half and half, which makes F = (1 + f)/2.

   - EN ISO 10077-2, unventilated cavities: h = 4σT_m³ E F with E = 1/(1/ε₁ + 1/ε₂ − 1).
     With ε = 0.9 and 283 K it is C₄(1 + √(1 + (d/b)²) − d/b), C₄ = 2.11 W/(m² K).
   - EN ISO 6946, annex D, small or divided airspaces:
     h = 4σT_m³/(1/ε₁ + 1/ε₂ − 2 + 1/F).  The resistances of plates and of the space between
     them are in series there; a product of E and F counts them otherwise.

   In the place of 4T_m³, (T₁ + T₂)(T₁² + T₂²) is printed here, which is exact.

   - With black plates, and black walls of one temperature each, both are exact.  In scenes of
     several bands an insulated wall has one temperature: two bands are enough, with any
     wavelength between them.
   - A wall that does not conduct is warmer beside the warm plate, and sends more back to it.
     Less heat passes, and the more so the deeper the cavity is.
   - Plates that reflect do not have the same radiosity everywhere, as the formulas have it. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

#define WARM 293.15
#define COLD 273.15

static double view(double depth) {
  return (1 + sqrt(1 + depth * depth) - depth) / 2;
}

static double of_black_plates(void) {
  return HR2D_STEFAN_BOLTZMANN * (WARM + COLD) * (WARM * WARM + COLD * COLD);
}

static double iso_10077(double depth, double emissivity) {
  return of_black_plates() / (2 / emissivity - 1) * view(depth);
}

static double iso_6946(double depth, double emissivity) {
  return of_black_plates() / (2 / emissivity - 2 + 1 / view(depth));
}

/* The width is 1; the warm plate is on the left. */
static hr2d_status make_scene(double depth, const double *emissivity, int conducting,
                              hr2d_scene **scene) {
  const hr2d_point corner[] = {{0, 1}, {0, 0}, {depth, 0}, {depth, 1}};
  const double micrometres = 10;
  hr2d_status status = hr2d_scene_create(NULL, scene);
  if (!status && conducting) status = hr2d_scene_set_wavelengths(*scene, &micrometres, 1);
  for (size_t k = 0; k < 4 && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    hr2d_thermal thermal = HR2D_THERMAL_INIT;
    patch.a = corner[k];
    patch.b = corner[(k + 1) % 4];
    thermal.given = k % 2 ? HR2D_HEAT_FLUX : HR2D_HEAT_TEMPERATURE;
    thermal.value = k == 0 ? WARM : k == 2 ? COLD : 0;
    thermal.emissivity = &emissivity[k % 2];
    thermal.emissivity_bands = 1;
    status = hr2d_scene_add_thermal(*scene, &patch, &thermal, NULL);
  }
  return status ? status : hr2d_scene_commit(*scene);
}

/* h, the heat of the warm plate over the difference of the temperatures. */
static hr2d_status solve(double depth, const double *emissivity, int conducting, double *h) {
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  double heat[4] = {0};
  target.error = 1e-9;
  to.heat = heat;
  hr2d_status status = make_scene(depth, emissivity, conducting, &scene);
  if (!status) status = hr2d_solve_to(scene, &target, &solution, NULL);
  if (!status) status = hr2d_solution_temperatures(solution, NULL, NULL, &to);
  *h = heat[0] / (WARM - COLD);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return status;
}

static hr2d_status print_table(const char *title, const double *emissivity) {
  static const double depth[] = {0.2, 0.5, 1, 2, 5};
  hr2d_status status = HR2D_OK;
  printf("%s\n  d/b  10077-2     6946  conducting  insulating walls, W/(m2 K)\n", title);
  for (size_t k = 0; k < sizeof depth / sizeof *depth && !status; k++) {
    double one, many;
    status = solve(depth[k], emissivity, 1, &one);
    if (!status) status = solve(depth[k], emissivity, 0, &many);
    if (!status)
      printf("  %3.1f  %.5f  %.5f     %.5f  %.5f\n", depth[k],
             iso_10077(depth[k], emissivity[0]), iso_6946(depth[k], emissivity[0]), one, many);
  }
  return status;
}

int main(void) {
  const double black[] = {1, 1}, frame[] = {.9, .9};
  hr2d_status status = print_table("black plates and walls", black);
  if (!status) status = print_table("emissivity 0.9 everywhere", frame);
  return status;
}
