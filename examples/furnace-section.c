/* Heat transfer across long furnaces.  You learn to turn temperatures and emissivities into
   emission and reflectance, to read net fluxes and the balance of power, and how far a
   textbook formula is off.

   A grey wall of known temperature has E = εσT⁴ and ρ = 1 − ε.  A well insulated wall sends
   back all the heat that it receives: E = 0, ρ = 1.

   The textbook's network of resistances assumes that the radiosity of each wall is uniform.
   hr2d_solve() makes the same assumption with one element per wall.  Refinement shows the
   error of this assumption. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

static const double sigma = 5.670374419e-8; /* W/(m² K⁴) */
static const double pi = 3.14159265358979324;

typedef struct surface {
  const char *name;
  double kelvin, emissivity; /* both 0 for a wall without net heat flux */
} surface;

static const surface roof = {"roof", 1500, 0.6};
static const surface load = {"load", 900, 0.8};
static const surface insulation = {"insulation", 0, 0};

typedef struct model {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
} model;

/* Reports a failure, if there was one, and destroys all objects of the model. */
static hr2d_status finish(model *m, hr2d_status status) {
  if (status)
    fprintf(stderr, "furnace-section: %s: %s%s\n", hr2d_strerror(status),
            m->scene ? hr2d_scene_message(m->scene) : "",
            m->links ? hr2d_linkset_message(m->links) : "");
  hr2d_solution_destroy(m->solution);
  hr2d_linkset_destroy(m->links);
  hr2d_hierarchy_destroy(m->hierarchy);
  hr2d_scene_destroy(m->scene);
  return status;
}

/* A wall from a to b; the furnace is on its left. */
static hr2d_status add(hr2d_scene *scene, const surface *s, hr2d_point a, hr2d_point b) {
  const double emission = s->emissivity * sigma * pow(s->kelvin, 4);
  const double reflectance = 1 - s->emissivity;
  hr2d_patch wall = HR2D_PATCH_INIT;
  wall.a = a;
  wall.b = b;
  wall.name = s->name;
  wall.emission = &emission;
  wall.emission_bands = 1;
  wall.reflectance = &reflectance;
  wall.reflectance_bands = 1;
  return hr2d_scene_add(scene, &wall, NULL);
}

/* The load below, the roof above it, insulation on both sides. */
static hr2d_status add_box(hr2d_scene *scene, double width, double height) {
  const hr2d_point corner[] = {{0, 0}, {width, 0}, {width, height}, {0, height}};
  const surface *const wall[] = {&load, &insulation, &roof, &insulation};
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < 4 && !status; k++)
    status = add(scene, wall[k], corner[k], corner[(k + 1) % 4]);
  return status;
}

static hr2d_point on_circle(double radius, int k, int n) {
  const double angle = 2 * pi * (k % n) / n;
  return (hr2d_point){radius * cos(angle), radius * sin(angle)};
}

/* A regular n-gon of load with its front outside, in an n-gon of roof with its front inside. */
static hr2d_status add_tubes(hr2d_scene *scene, double inner, double outer, int n) {
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < n && !status; k++)
    status = add(scene, &load, on_circle(inner, k + 1, n), on_circle(inner, k, n));
  for (int k = 0; k < n && !status; k++)
    status = add(scene, &roof, on_circle(outer, k, n), on_circle(outer, k + 1, n));
  return status;
}

/* Links of max(A)/r ≤ epsilon; with HR2D_NO_SUBDIVISION each wall stays one element. */
static hr2d_status solve(model *m, double epsilon, unsigned max_level) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  options.max_level = max_level;
  hr2d_status status = hr2d_scene_commit(m->scene);
  if (!status) status = hr2d_hierarchy_create(m->scene, &m->hierarchy);
  if (!status) status = hr2d_linkset_create(m->hierarchy, NULL, NULL, NULL, NULL, &m->links);
  if (!status) status = hr2d_refine(m->links, &options);
  return status ? status : hr2d_solve(m->links, NULL, &m->solution);
}

static hr2d_status solve_box(model *m, double width, double height, double epsilon,
                             unsigned max_level) {
  hr2d_status status = hr2d_scene_create(NULL, &m->scene);
  if (!status) status = add_box(m->scene, width, height);
  return status ? status : solve(m, epsilon, max_level);
}

/* Heat into the load in kW/m²: the potential σT⁴ drops over the resistances 1/ε − 1 of both
   surfaces and the resistance between them, each times the area of the load. */
static double network(double load_to_roof, double between) {
  const double drop = sigma * (pow(roof.kelvin, 4) - pow(load.kelvin, 4)) / 1000;
  return drop / (1 / load.emissivity - 1 + between + load_to_roof * (1 / roof.emissivity - 1));
}

/* Between the plates there are two paths in parallel: the view factor F, by crossed strings,
   and the path over the insulation, two resistances 1/(1 − F) in series. */
static double box_network(double width, double height) {
  const double direct = (hypot(width, height) - height) / width;
  return network(1, 1 / (direct + (1 - direct) / 2));
}

/* W in kW, rounded to two decimals, without −0. */
static double kilo(double watts) {
  return round(watts / 10) / 100 + 0.;
}

/* Heat into patch 0, the load, in kW/m². */
static double gain(const model *m) {
  return -hr2d_solution_net_flux(m->solution, 0, 0) / 1000;
}

static hr2d_status show_walls(void) {
  model m = {0};
  const hr2d_status status = solve_box(&m, 3, 1, 1. / 64, HR2D_DEFAULT_MAX_LEVEL);
  if (!status) {
    printf("A furnace 3 m wide, 1 m high\n%-12s %8s %8s %9s\n", "", "B kW/m2", "H kW/m2",
           "net kW/m");
    for (size_t k = 0; k < hr2d_scene_patches(m.scene); k++)
      printf("%-12s %8.2f %8.2f %9.2f\n", hr2d_scene_name(m.scene, k),
             kilo(hr2d_solution_average(m.solution, k, 0)),
             kilo(hr2d_solution_irradiance(m.solution, k, 0)),
             kilo(hr2d_solution_net_flux(m.solution, k, 0) * hr2d_scene_length(m.scene, k)));
    const hr2d_power power = hr2d_solution_power(m.solution, 0);
    printf("emitted %.2f kW/m, absorbed %.2f kW/m; insulation at %.0f K\n", kilo(power.emitted),
           kilo(power.absorbed), pow(hr2d_solution_average(m.solution, 1, 0) / sigma, 0.25));
  }
  return finish(&m, status);
}

static hr2d_status show_row(double width, double epsilon, unsigned max_level) {
  model m = {0};
  const hr2d_status status = solve_box(&m, width, 1, epsilon, max_level);
  if (!status)
    printf("%7g %8g %9llu %9.3f %9.3f %9.3f\n", width,
           max_level == HR2D_NO_SUBDIVISION ? HUGE_VAL : epsilon,
           (unsigned long long)hr2d_linkset_size(m.links), gain(&m), box_network(width, 1),
           network(1, 1));
  return finish(&m, status);
}

static hr2d_status show_boxes(void) {
  printf("\nHeat into the load, kW/m2\n%7s %8s %9s %9s %9s %9s\n", "width", "epsilon", "links",
         "hr2d", "network", "infinite");
  hr2d_status status = show_row(3, 1, HR2D_NO_SUBDIVISION);
  for (int k = 1; k <= 64 && !status; k *= 4)
    status = show_row(3, 1. / k, HR2D_DEFAULT_MAX_LEVEL);
  for (int width = 10; width <= 1000 && !status; width *= 10)
    status = show_row(width, 1. / 8, HR2D_DEFAULT_MAX_LEVEL);
  return status;
}

static hr2d_status show_tubes(void) {
  const double inner = 0.5, outer = 1;
  printf("\nHeat into the inner one of two tubes of n sides, kW/m2\n%7s %9s %9s\n", "n", "hr2d",
         "circles");
  hr2d_status status = HR2D_OK;
  for (int n = 4; n <= 32 && !status; n *= 2) {
    model m = {0};
    status = hr2d_scene_create(NULL, &m.scene);
    if (!status) status = add_tubes(m.scene, inner, outer, n);
    if (!status) status = solve(&m, 1. / 16, HR2D_DEFAULT_MAX_LEVEL);
    if (!status) printf("%7d %9.3f %9.3f\n", n, gain(&m), network(inner / outer, 1));
    status = finish(&m, status);
  }
  return status;
}

int main(void) {
  hr2d_status status = show_walls();
  if (!status) status = show_boxes();
  if (!status) status = show_tubes();
  return status != HR2D_OK;
}
