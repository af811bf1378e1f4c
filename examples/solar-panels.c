/* The irradiance on the front and on the back of solar panels.  You learn to set a sky as
   background, to use two-sided patches, and to read the irradiance along a patch.

   Rows of tilted black panels stand over ground, in cross-section, under a sky of radiosity 1.
   The results are for a panel of the inner row.  First the ground is black, so that the
   irradiance of a point is its view factor of the sky.  Then the ground has albedo 0.2.

   On a panel of direction u (up the slope), light from the directions between the unit vectors
   d and e gives the irradiance |(d − e)·u|/2.  The front sees the sky from u to the top edge of
   the row before it, the back from u to the top edge of the row behind it.  Below these edges
   is the ground, if it reaches far enough. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

enum { ROWS = 2 }; /* on each side of the inner row */

static const double pi = 3.14159265358979324;
static const double tilt = 30, length = 2, clearance = 0.5, pitch = 4; /* degrees; m */
static const double ground_end = 1000;

typedef struct model {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  size_t panel; /* the front of the inner panel; its back is the next patch */
} model;

/* Reports a failure, if there was one, and destroys all objects of the model. */
static hr2d_status finish(model *m, hr2d_status status) {
  if (status)
    fprintf(stderr, "solar-panels: %s: %s%s\n", hr2d_strerror(status),
            m->scene ? hr2d_scene_message(m->scene) : "",
            m->links ? hr2d_linkset_message(m->links) : "");
  hr2d_solution_destroy(m->solution);
  hr2d_linkset_destroy(m->links);
  hr2d_hierarchy_destroy(m->hierarchy);
  hr2d_scene_destroy(m->scene);
  return status;
}

static hr2d_point along_slope(double distance) {
  return (hr2d_point){distance * cos(tilt * pi / 180), distance * sin(tilt * pi / 180)};
}

/* The point at fraction t of the panel of a row; row 0 is the inner row. */
static hr2d_point on_panel(int row, double t) {
  const hr2d_point up = along_slope(t * length);
  return (hr2d_point){row * pitch + up.x, clearance + up.y};
}

/* Rows −side … side; the fronts look up and to the left. */
static hr2d_status make_scene(model *m, int side, double albedo) {
  const double sky = 1;
  hr2d_patch ground = HR2D_PATCH_INIT;
  ground.a = (hr2d_point){-ground_end, 0};
  ground.b = (hr2d_point){ground_end, 0};
  ground.name = "ground";
  ground.reflectance = &albedo;
  ground.reflectance_bands = 1;
  hr2d_status status = hr2d_scene_create(NULL, &m->scene);
  if (!status) status = hr2d_scene_set_background(m->scene, &sky, 1);
  if (!status) status = hr2d_scene_add(m->scene, &ground, NULL);
  for (int row = -side; row <= side && !status; row++) {
    hr2d_patch panel = HR2D_PATCH_INIT;
    panel.a = on_panel(row, 0);
    panel.b = on_panel(row, 1);
    panel.sides = HR2D_SIDES_BOTH;
    size_t index;
    status = hr2d_scene_add(m->scene, &panel, &index);
    if (row == 0) m->panel = index;
  }
  return status ? status : hr2d_scene_commit(m->scene);
}

static hr2d_status solve(model *m, int side, double albedo, double epsilon) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  hr2d_status status = make_scene(m, side, albedo);
  if (!status) status = hr2d_hierarchy_create(m->scene, &m->hierarchy);
  if (!status) status = hr2d_linkset_create(m->hierarchy, NULL, NULL, NULL, NULL, &m->links);
  if (!status) status = hr2d_refine(m->links, &options);
  return status ? status : hr2d_solve(m->links, NULL, &m->solution);
}

/* The cosine of the angle between the slope and the direction from p to q. */
static double up_slope(hr2d_point p, hr2d_point q) {
  const hr2d_point u = along_slope(1), d = {q.x - p.x, q.y - p.y};
  return (d.x * u.x + d.y * u.y) / hypot(d.x, d.y);
}

/* The skyline before or behind a panel: the top of the next row, or the end of the ground. */
static hr2d_point skyline(int side, int direction) {
  return side ? on_panel(direction, 1) : (hr2d_point){direction * ground_end, 0};
}

static double front_view(int side, double t) {
  return (1 - up_slope(on_panel(0, t), skyline(side, -1))) / 2;
}

static double back_view(int side, double t) {
  return (1 - up_slope(on_panel(0, t), skyline(side, 1))) / 2;
}

static double front_at(const model *m, double t) {
  return hr2d_solution_irradiance_at(m->solution, m->panel, t, 0);
}

/* The back is a separate patch and runs down the slope. */
static double back_at(const model *m, double t) {
  return hr2d_solution_irradiance_at(m->solution, m->panel + 1, 1 - t, 0);
}

static hr2d_status show_black(int side) {
  model m = {0};
  const hr2d_status status = solve(&m, side, 0, 1. / 128);
  if (!status) {
    printf("Black ground, %d row%s\n   t   front  formula  back  formula\n", 2 * side + 1,
           side ? "s" : "");
    for (int k = 1; k < 8; k++) {
      const double t = k / 8.;
      printf("%5.3f  %.4f %.4f  %.4f %.4f\n", t, front_at(&m, t), front_view(side, t),
             back_at(&m, t), back_view(side, t));
    }
  }
  return finish(&m, status);
}

/* For comparison it also prints a panel that stands alone, high over ground under open sky. */
static hr2d_status show_albedo(double albedo) {
  model m = {0};
  const hr2d_status status = solve(&m, ROWS, albedo, 1. / 128);
  if (!status) {
    const double down = (1 - cos(tilt * pi / 180)) / 2; /* the ground's part of its view */
    const double front = hr2d_solution_irradiance(m.solution, m.panel, 0);
    const double back = hr2d_solution_irradiance(m.solution, m.panel + 1, 0);
    printf("Albedo %.1f, %d rows\n   t   front   back\n", albedo, 2 * ROWS + 1);
    for (int k = 1; k < 8; k++)
      printf("%5.3f  %.4f  %.4f\n", k / 8., front_at(&m, k / 8.), back_at(&m, k / 8.));
    printf(" mean %.4f  %.4f\n alone %.4f  %.4f\n", front, back, 1 - down + albedo * down,
           down + albedo * (1 - down));
    const hr2d_power power = hr2d_solution_power(m.solution, 0);
    printf("received %.2f, absorbed %.2f, escaped %.2f\n", power.received, power.absorbed,
           power.escaped);
  }
  return finish(&m, status);
}

int main(void) {
  hr2d_status status = show_black(0);
  if (!status) status = show_black(ROWS);
  if (!status) status = show_albedo(0.2);
  return status != HR2D_OK;
}
