/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How to ask for a number of digits.  You learn to set a target error, to read averages and
   values at points, and to check the error that was reached.

   The scene is a square room with a lit floor, the target is nine digits. */
#include <hr2d/hr2d.h>
#include <stdio.h>

static hr2d_status make_room(hr2d_scene **scene) {
  const hr2d_point corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const double dark = 0, lamp = 1, white = 0.9;
  hr2d_status status = hr2d_scene_create(NULL, scene);
  for (int k = 0; k < 4 && !status; k++) {
    hr2d_patch wall = HR2D_PATCH_INIT;
    wall.a = corner[k];
    wall.b = corner[(k + 1) % 4];
    wall.emission = k == 0 ? &lamp : &dark;
    wall.emission_bands = 1;
    wall.reflectance = &white;
    wall.reflectance_bands = 1;
    status = hr2d_scene_add(*scene, &wall, NULL);
  }
  return status ? status : hr2d_scene_commit(*scene);
}

int main(void) {
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_account account;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-9;
  hr2d_status status = make_room(&scene);
  if (!status) status = hr2d_solve_to(scene, &target, &solution, &account);
  if (status) {
    fprintf(stderr, "%s\n", hr2d_strerror(status));
    hr2d_scene_destroy(scene);
    return 1;
  }
  for (size_t k = 0; k < 4; k++)
    printf("wall %zu: B = %.9g\n", k, hr2d_solution_average(solution, k, 0));
  const double t[] = {0.25, 0.5};
  double b[2];
  if (!hr2d_solution_gather(solution, 0, t, 2, b))
    printf("on the lamp: %.9g at a quarter, %.9g half way\n", b[0], b[1]);
  printf("the error is %s\n", account.average.estimate <= target.error
                                  ? "below what was asked for"
                                  : "not what was asked for");
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return 0;
}
