// SPDX-License-Identifier: GPL-3.0-or-later
// An outside program in C++: linkage, the initialiser macros, options of zeros, and numbers.
#include <cmath>
#include <cstring>
#include <hr2d/hr2d.h>
#include <iostream>

// B at a point of a lit floor's ceiling, for options that are given or not.
static double solve(const hr2d_target *target) {
  const double one = 1, half = 0.5;
  hr2d_patch floor = HR2D_PATCH_INIT, ceiling = HR2D_PATCH_INIT;
  hr2d_scene *scene = nullptr;
  hr2d_solution *solution = nullptr;
  floor.b.x = ceiling.a.x = ceiling.a.y = ceiling.b.y = 1;
  floor.emission = &one;
  floor.emission_bands = 1;
  ceiling.reflectance = &half;
  ceiling.reflectance_bands = 1;
  const bool ok = !hr2d_scene_create(nullptr, &scene) &&
                  !hr2d_scene_add(scene, &floor, nullptr) &&
                  !hr2d_scene_add(scene, &ceiling, nullptr) && !hr2d_scene_commit(scene) &&
                  !hr2d_solve_to(scene, target, &solution, nullptr);
  const double value = ok ? hr2d_solution_at(solution, 1, 0.3, 0) : -1;
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return value;
}

// Zeros, the macro and the function give what no options give, bit for bit; another target does
// not.
static bool zeros_are_defaults() {
  const double none = solve(nullptr);
  const hr2d_target macro = HR2D_TARGET_INIT;
  hr2d_target zeros = hr2d_target(), filled, rough = HR2D_TARGET_INIT;
  zeros.struct_size = sizeof zeros;
  hr2d_target_init(&filled, sizeof filled);
  rough.error = 0.1;
  return none > 0.2 && solve(&macro) == none && solve(&zeros) == none &&
         solve(&filled) == none && solve(&rough) != none;
}

int main() {
  const hr2d_segment floor = {{0, 0}, {1, 0}}, ceiling = {{1, 1}, {0, 1}};
  const double area = hr2d_exchange_area(&floor, &ceiling);
  hr2d_patch patch = HR2D_PATCH_INIT;
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_matrix_options matrix = HR2D_MATRIX_OPTIONS_INIT;
  patch.b.x = 1;

  hr2d_scene *scene = nullptr;
  const bool ok = hr2d_scene_create(nullptr, &scene) == HR2D_OK &&
                  hr2d_scene_add(scene, &patch, nullptr) == HR2D_OK &&
                  hr2d_scene_patches(scene) == 1 && refine.struct_size == sizeof refine &&
                  options.struct_size == sizeof options && !options.closure &&
                  matrix.struct_size == sizeof matrix && zeros_are_defaults() &&
                  std::strcmp(hr2d_version(), HR2D_VERSION) == 0 &&
                  std::fabs(area - (std::sqrt(2.0) - 1)) < 1e-15;
  if (!ok)
    std::cerr << "exchange area " << area
              << ", not √2 − 1, or options of zeros are no defaults\n";
  hr2d_scene_destroy(scene);
  return ok ? 0 : 1;
}
