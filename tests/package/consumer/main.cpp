// SPDX-License-Identifier: GPL-3.0-or-later
// An outside program in C++: linkage, the initialiser macros, and one number.
#include <cmath>
#include <cstring>
#include <hr2d/hr2d.h>
#include <iostream>

int main() {
  const hr2d_segment floor = {{0, 0}, {1, 0}}, ceiling = {{1, 1}, {0, 1}};
  const double area = hr2d_exchange_area(&floor, &ceiling);
  hr2d_patch patch = HR2D_PATCH_INIT;
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  patch.b.x = 1;

  hr2d_scene *scene = nullptr;
  const bool ok = hr2d_scene_create(nullptr, &scene) == HR2D_OK &&
                  hr2d_scene_add(scene, &patch, nullptr) == HR2D_OK &&
                  hr2d_scene_patches(scene) == 1 && refine.struct_size == sizeof refine &&
                  solve.struct_size == sizeof solve &&
                  std::strcmp(hr2d_version(), HR2D_VERSION) == 0 &&
                  std::fabs(area - (std::sqrt(2.0) - 1)) < 1e-15;
  if (!ok) std::cerr << "exchange area " << area << ", not √2 − 1, or worse\n";
  hr2d_scene_destroy(scene);
  return ok ? 0 : 1;
}
