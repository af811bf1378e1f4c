/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A published furnace with an insulated wall.  You learn to compare a network of resistances
   with the heat that it stands for.

   Incropera and DeWitt, Fundamentals of Heat and Mass Transfer, have a paint baking oven as an
   example: a long duct whose section is a triangle with sides of 1 m.  A heater has 1200 K and
   ε = 0.8, the painted panels 500 K and ε = 0.4, and the third wall is insulated, with ε = 0.8.
   Their network of resistances has one radiosity for each wall:

     q = σ(T₁⁴ − T₂⁴)/(R₁ + R + R₂),  1/R = F₁₂ + 1/(1/F₁₃ + 1/F₂₃),  Rₖ = (1 − εₖ)/εₖ,

   all Fₖₗ = ½, and gives 37 kW/m and 1102 K for the insulated wall. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

enum { WALLS = 3 };

static const double emissivity[WALLS] = {.8, .4, .8};

/* J₁ = σT₁⁴ − qR₁ and J₂ = σT₂⁴ + qR₂; the insulated wall has their mean. */
static void print_network(double hot, double cold) {
  const double r1 = (1 - emissivity[0]) / emissivity[0];
  const double r2 = (1 - emissivity[1]) / emissivity[1];
  const double q = (hot - cold) / (r1 + 4. / 3 + r2);
  const double mean = (hot - q * r1 + cold + q * r2) / 2;
  printf("network         %.3f kW/m, insulated wall %.2f K\n", q / 1e3,
         pow(mean / HR2D_STEFAN_BOLTZMANN, .25));
}

/* With a wavelength there are two bands, and the insulated wall has one temperature. */
static hr2d_status make_scene(int conducting, hr2d_scene **scene) {
  const hr2d_point corner[] = {{0, 0}, {1, 0}, {.5, sqrt(.75)}};
  const double given[WALLS] = {1200, 500, 0}, micrometres = 4;
  hr2d_status status = hr2d_scene_create(NULL, scene);
  if (!status && conducting) status = hr2d_scene_set_wavelengths(*scene, &micrometres, 1);
  for (size_t k = 0; k < WALLS && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    hr2d_thermal thermal = HR2D_THERMAL_INIT;
    patch.a = corner[k];
    patch.b = corner[(k + 1) % WALLS];
    thermal.given = k < 2 ? HR2D_HEAT_TEMPERATURE : HR2D_HEAT_FLUX;
    thermal.value = given[k];
    thermal.emissivity = &emissivity[k];
    thermal.emissivity_bands = 1;
    status = hr2d_scene_add_thermal(*scene, &patch, &thermal, NULL);
  }
  return status ? status : hr2d_scene_commit(*scene);
}

static hr2d_status solve(const char *title, int conducting) {
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_account account;
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  const double t[] = {.1, .9};
  double heat[WALLS], kelvin[WALLS], bound[WALLS], at[2];
  target.error = 1e-8;
  to.heat = heat;
  to.kelvin = kelvin;
  to.bound = bound;
  hr2d_status status = make_scene(conducting, &scene);
  if (!status) status = hr2d_solve_to(scene, &target, &solution, &account);
  if (!status) status = hr2d_solution_temperatures(solution, &target, &account, &to);
  if (!status) status = hr2d_solution_gather_temperature(solution, 2, t, 2, at);
  if (!status)
    printf("%-14s  %.3f kW/m, insulated wall %.2f K, from %.1f to %.1f K%s\n", title,
           heat[0] / 1e3, kelvin[2], at[1], at[0], bound[2] < 1e-4 ? "" : ", not accurate");
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return status;
}

int main(void) {
  print_network(hr2d_black_body(1200), hr2d_black_body(500));
  hr2d_status status = solve("conducting", 1);
  if (!status) status = solve("insulating", 0);
  return status;
}
