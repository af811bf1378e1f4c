/* Sky view factors in a town without end.  You learn how a period repeats a scene, and what of
   the sky a street has between rows of houses that go on for ever.

   One street is drawn, with the block on its right: two houses and a yard.  All is black under
   a sky of radiosity 1, so that the irradiance is the sky view factor.  A point of the floor
   sees the sky between the roofs on both sides. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

#define STREET 12.0 /* metres */
#define ROOF   10.0
#define YARD   8.0

/* From left to right: the street, a house of height h, a yard, and another house; the next
   street begins where the last wall ends. */
static hr2d_status make_town(hr2d_scene *scene, double h) {
  const double x[] = {0, STREET, STREET + ROOF, STREET + ROOF + YARD, STREET + 2 * ROOF + YARD};
  const hr2d_point line[] = {{x[0], 0}, {x[1], 0}, {x[1], h}, {x[2], h}, {x[2], 0},
                             {x[3], 0}, {x[3], h}, {x[4], h}, {x[4], 0}};
  const double sky = 1;
  hr2d_status status = hr2d_scene_set_background(scene, &sky, 1);
  for (size_t k = 0; k + 1 < sizeof line / sizeof *line && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = line[k];
    patch.b = line[k + 1];
    status = hr2d_scene_add(scene, &patch, NULL);
  }
  if (!status) status = hr2d_scene_set_period(scene, (hr2d_point){x[4], 0});
  return status ? status : hr2d_scene_commit(scene);
}

/* Crossed strings between the tops of the walls, and at the middle. */
static double street_average(double h) {
  return (hypot(STREET, h) - h) / STREET;
}

static double wall_average(double h) {
  return (STREET + h - hypot(STREET, h)) / (2 * h);
}

static double street_middle(double h) {
  return STREET / 2 / hypot(STREET / 2, h);
}

static hr2d_status show(double h) {
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_target target = HR2D_TARGET_INIT;
  const double middle = 0.5;
  double at_middle = 0;
  target.error = 1e-9;
  hr2d_status status = hr2d_scene_create(NULL, &scene);
  if (!status) status = make_town(scene, h);
  if (!status) status = hr2d_solve_to(scene, &target, &solution, NULL);
  if (!status) status = hr2d_solution_gather_irradiance(solution, 0, &middle, 1, &at_middle);
  if (!status)
    printf("%5.1f  %.6f %.6f  %.6f %.6f  %.6f %.6f  %.6f\n", h,
           hr2d_solution_irradiance(solution, 0, 0), street_average(h), at_middle,
           street_middle(h), hr2d_solution_irradiance(solution, 1, 0), wall_average(h),
           hr2d_solution_irradiance(solution, 2, 0));
  if (status)
    fprintf(stderr, "streets: %s: %s\n", hr2d_strerror(status), hr2d_scene_message(scene));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return status;
}

int main(void) {
  hr2d_status status = HR2D_OK;
  printf("A town of streets %g m wide between houses of height H\n", STREET);
  printf("%5s  %-17s  %-17s  %-17s  %s\n", "H", "street    formula", "middle    formula",
         "wall      formula", "roof");
  for (double h = 3; h <= 48 && !status; h *= 2) status = show(h);
  return status != HR2D_OK;
}
