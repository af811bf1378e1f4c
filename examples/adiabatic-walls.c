/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls whose temperature is not known.  You learn to give temperatures, net heat fluxes and
   emissivities instead of emission and reflectance, and to read the temperatures that follow.

   A muffle between a heater and a cooler load, both black plates; the other walls are
   insulated, of any emissivity.
   - Turning the room by 180° exchanges the plates, so that side walls have the mean of T⁴ on
     average.  The part F of the heat, by crossed strings, goes straight to the load.  If B were
     the same all along the insulated walls, these would send half of what they get back, and
     the heater would give A·(F + (1 − F)/2)·σ(T₁⁴ − T₂⁴).  They are hotter near the heater,
   send more of it back, and the heater gives less.
   - With the load replaced by an insulated wall there is one temperature everywhere.
   - A heat flux can be given in place of the heater's temperature.  It is the same all along
     the heater then, and the temperature is not; but the one of its average is nearly 1200 K.
 */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

enum { WALLS = 4, HEATER = 0, LOAD = 2 };

typedef struct muffle {
  hr2d_heat given[WALLS];
  double value[WALLS];
} muffle;

/* 2 m × 1 m; the heater on the left, the load on the right. */
static hr2d_status make_scene(const muffle *m, hr2d_scene **scene) {
  static const hr2d_point corner[] = {{0, 1}, {0, 0}, {2, 0}, {2, 1}};
  static const char *const name[] = {"heater", "floor", "load", "ceiling"};
  static const double emissivity[] = {1, .4, 1, .7};
  hr2d_status status = hr2d_scene_create(NULL, scene);
  for (size_t k = 0; k < WALLS && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    hr2d_thermal thermal = HR2D_THERMAL_INIT;
    patch.a = corner[k];
    patch.b = corner[(k + 1) % WALLS];
    patch.name = name[k];
    thermal.given = m->given[k];
    thermal.value = m->value[k];
    thermal.emissivity = &emissivity[k];
    thermal.emissivity_bands = 1;
    status = hr2d_scene_add_thermal(*scene, &patch, &thermal, NULL);
  }
  return status ? status : hr2d_scene_commit(*scene);
}

static hr2d_status print_walls(const hr2d_scene *scene, const hr2d_solution *solution,
                               const hr2d_account *account, double *heater) {
  double kelvin[WALLS], bound[WALLS], heat[WALLS];
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  to.kelvin = kelvin;
  to.bound = bound;
  to.heat = heat;
  const hr2d_status status = hr2d_solution_temperatures(solution, NULL, account, &to);
  for (size_t k = 0; k < WALLS && !status; k++)
    printf("  %-8s %10.4f K %12.3f W/m%s\n", hr2d_scene_name(scene, k), kelvin[k],
           fabs(heat[k]) < 1e-6 ? 0 : heat[k], bound[k] < 1e-4 ? "" : "  not accurate");
  if (!status) *heater = heat[HEATER];
  return status;
}

static hr2d_status solve(const char *title, const muffle *m, double *heater) {
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_account account;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-9;
  hr2d_status status = make_scene(m, &scene);
  if (!status) status = hr2d_solve_to(scene, &target, &solution, &account);
  if (!status) {
    printf("%s\n", title);
    status = print_walls(scene, solution, &account, heater);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return status;
}

int main(void) {
  const hr2d_heat T = HR2D_HEAT_TEMPERATURE, Q = HR2D_HEAT_FLUX;
  muffle m = {{T, Q, T, Q}, {1200, 0, 600, 0}};
  const double hot = hr2d_black_body(1200), cold = hr2d_black_body(600);
  const double strings = sqrt(5) - 2; /* (2 diagonals − 2 lengths)/2 over a height of 1 */
  double heat = 0;
  hr2d_status status = solve("between two temperatures", &m, &heat);
  if (!status)
    printf("mean of T^4 %.4f K; heat below %.3f W/m, and %.3f straight\n",
           pow((hot + cold) / 2 / HR2D_STEFAN_BOLTZMANN, .25), (1 + strings) / 2 * (hot - cold),
           strings * (hot - cold));
  m.given[LOAD] = HR2D_HEAT_FLUX;
  m.value[LOAD] = 0;
  double none = 0;
  if (!status) status = solve("all but the heater insulated", &m, &none);
  m = (muffle){{Q, Q, T, Q}, {heat, 0, 600, 0}};
  if (!status) status = solve("the heater by its heat flux", &m, &heat);
  return status;
}
