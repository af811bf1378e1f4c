// SPDX-License-Identifier: GPL-3.0-or-later
/* How to use the library from C++.  You learn to let std::unique_ptr destroy the objects, in
   the right order and also if something fails, and to turn a status into an exception.

   A lamp below the ceiling of a room lights it around a screen. */
#include <cstdio>
#include <hr2d/hr2d.h>
#include <memory>
#include <stdexcept>

namespace {

struct destroy {
  void operator()(hr2d_scene *scene) const {
    hr2d_scene_destroy(scene);
  }
  void operator()(hr2d_solution *solution) const {
    hr2d_solution_destroy(solution);
  }
};
using scene_ptr = std::unique_ptr<hr2d_scene, destroy>;
using solution_ptr = std::unique_ptr<hr2d_solution, destroy>;

void check(hr2d_status status, const char *message) {
  if (status) throw std::runtime_error(*message ? message : hr2d_strerror(status));
}

scene_ptr make_scene() {
  hr2d_scene *scene = nullptr;
  check(hr2d_scene_create(nullptr, &scene), "");
  return scene_ptr(scene);
}

void add(hr2d_scene *scene, const char *name, hr2d_point a, hr2d_point b, double emission,
         double reflectance, hr2d_sides sides) {
  hr2d_patch patch = HR2D_PATCH_INIT;
  patch.a = a;
  patch.b = b;
  patch.name = name;
  patch.emission = &emission;
  patch.reflectance = &reflectance;
  patch.emission_bands = patch.reflectance_bands = 1;
  patch.sides = sides;
  check(hr2d_scene_add(scene, &patch, nullptr), hr2d_scene_message(scene));
}

scene_ptr make_room() {
  scene_ptr room = make_scene();
  add(room.get(), "floor", {0, 0}, {4, 0}, 0, 0.3, HR2D_SIDES_FRONT);
  add(room.get(), "east", {4, 0}, {4, 3}, 0, 0.7, HR2D_SIDES_FRONT);
  add(room.get(), "lamp", {4, 3}, {3, 3}, 1, 0.7, HR2D_SIDES_FRONT);
  add(room.get(), "ceiling", {3, 3}, {0, 3}, 0, 0.7, HR2D_SIDES_FRONT);
  add(room.get(), "west", {0, 3}, {0, 0}, 0, 0.7, HR2D_SIDES_FRONT);
  add(room.get(), "screen", {2, 0}, {2, 2}, 0, 0.5, HR2D_SIDES_BOTH);
  check(hr2d_scene_commit(room.get()), hr2d_scene_message(room.get()));
  return room;
}

/* A solution must be destroyed before its scene: it is declared after it. */
solution_ptr solve(const hr2d_scene *scene, double error) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = error;
  hr2d_solution *solution = nullptr;
  hr2d_account account;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
  solution_ptr owner(solution);
  check(status, account.reason);
  return owner;
}

} // namespace

int main() {
  try {
    const scene_ptr room = make_room();
    const solution_ptr solution = solve(room.get(), 1e-8);
    for (size_t k = 0; k < hr2d_scene_patches(room.get()); k++)
      std::printf("%-14s B = %.6f\n", hr2d_scene_name(room.get(), k),
                  hr2d_solution_average(solution.get(), k, 0));

    scene_ptr wrong = make_scene();
    add(wrong.get(), "mirror", {0, 0}, {1, 0}, 0, 1.5, HR2D_SIDES_FRONT);
  } catch (const std::exception &error) {
    std::printf("error: %s\n", error.what());
  }
}
