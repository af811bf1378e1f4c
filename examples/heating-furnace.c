/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A load that heats up in a furnace, in 1,000 steps.  You learn to solve for other temperatures
   on the same geometry with what was found out for the first ones.

   The walls of a square duct, 1 m wide, keep 1200 K; the load, its floor, begins at 300 K and
   takes 40 kJ/(m² K).  Each step of 2 s takes the heat at its beginning (explicit Euler).  Two
   surfaces of which one sees the other alone exchange

     q = σ(T₁⁴ − T₂⁴)/(1/ε₂ + (A₂/A₁)(1/ε₁ − 1)),  A₂/A₁ = 1/3,

   if each has one radiosity, so that the time to 900 K can be compared with an integral. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

enum { WALLS = 4, STEPS = 1000 };

static const double emissivity[WALLS] = {.8, .9, .9, .9}, hot = 1200, capacity = 4e4, step = 2;

static hr2d_status make_scene(hr2d_scene **scene) {
  const hr2d_point corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  hr2d_status status = hr2d_scene_create(NULL, scene);
  for (size_t k = 0; k < WALLS && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    hr2d_thermal thermal = HR2D_THERMAL_INIT;
    patch.a = corner[k];
    patch.b = corner[(k + 1) % WALLS];
    thermal.given = HR2D_HEAT_TEMPERATURE;
    thermal.value = k ? hot : 300;
    thermal.emissivity = &emissivity[k];
    thermal.emissivity_bands = 1;
    status = hr2d_scene_add_thermal(*scene, &patch, &thermal, NULL);
  }
  return status ? status : hr2d_scene_commit(*scene);
}

/* The seconds in which a body of one radiosity goes from 300 K to `kelvin`. */
static double by_network(double kelvin) {
  enum { PARTS = 100000 };
  const double resistance = 1 / emissivity[0] + (1 / emissivity[1] - 1) / 3;
  double seconds = 0;
  for (int k = 0; k < PARTS; k++) {
    const double t = 300 + (kelvin - 300) * (k + .5) / PARTS;
    seconds += capacity * resistance / (hr2d_black_body(hot) - hr2d_black_body(t));
  }
  return seconds * (kelvin - 300) / PARTS;
}

/* The first step at which the load has 900 K; its gain is H − B. */
static hr2d_status heat_up(hr2d_operator *op, double *seconds) {
  double kelvin[WALLS] = {300, hot, hot, hot};
  hr2d_light light = HR2D_LIGHT_INIT;
  hr2d_status status = HR2D_OK;
  light.temperature.value = kelvin;
  light.no_error = 1;
  *seconds = NAN;
  for (int k = 0; k < STEPS && !status; k++) {
    hr2d_solution *solution = NULL;
    status = hr2d_operator_solve(op, &light, NULL, &solution, NULL);
    if (!status) kelvin[0] -= step * hr2d_solution_net_flux(solution, 0, 0) / capacity;
    if (isnan(*seconds) && kelvin[0] >= 900) *seconds = step * (k + 1);
    hr2d_solution_destroy(solution);
  }
  if (!status) printf("after %d steps the load has %.1f K\n", STEPS, kelvin[0]);
  return status;
}

int main(void) {
  hr2d_scene *scene = NULL;
  hr2d_operator *op = NULL;
  hr2d_target target = HR2D_TARGET_INIT;
  double seconds;
  target.error = 1e-6;
  hr2d_status status = make_scene(&scene);
  if (!status) status = hr2d_operator_create(scene, &target, &op, NULL);
  if (!status) status = heat_up(op, &seconds);
  if (!status)
    printf("900 K after %.0f s; one radiosity for each: %.0f s\n", seconds, by_network(900));
  if (status) fprintf(stderr, "%s\n", op ? hr2d_operator_message(op) : hr2d_strerror(status));
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
  return status;
}
