/* Sky view factors of streets, walls and roofs.  You learn two ways to compute them: as the
   irradiance under a sky of radiosity 1, and from the sums of the matrix of view factors.

   All patches are black, so that the irradiance of a point is its sky view factor.  The sky
   view factor of a patch is also 1 − Σ F, the rest of its row of view factors.

   A street section is one line from left to right.  Its front is on the left of this line,
   which is the outside.  Let d and e be the unit vectors from a point to the highest points of
   the section on its left and on its right.  On a patch of direction u the point sees the sky
   between them: (e − d)·u/2. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

enum { MOST = 32 };

/* In metres. */
typedef struct section {
  size_t points;
  hr2d_point point[MOST];
} section;

typedef struct model {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  double unseen[MOST]; /* per patch: 1 − Σ F */
} model;

/* Reports a failure, if there was one, and destroys all objects of the model. */
static hr2d_status finish(model *m, hr2d_status status) {
  if (status)
    fprintf(stderr, "street-canyon: %s: %s%s\n", hr2d_strerror(status),
            m->scene ? hr2d_scene_message(m->scene) : "",
            m->links ? hr2d_linkset_message(m->links) : "");
  hr2d_solution_destroy(m->solution);
  hr2d_linkset_destroy(m->links);
  hr2d_hierarchy_destroy(m->hierarchy);
  hr2d_scene_destroy(m->scene);
  return status;
}

static hr2d_status make_scene(model *m, const section *s) {
  const double sky = 1;
  hr2d_status status = hr2d_scene_create(NULL, &m->scene);
  if (!status) status = hr2d_scene_set_background(m->scene, &sky, 1);
  for (size_t k = 0; k + 1 < s->points && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = s->point[k];
    patch.b = s->point[k + 1];
    status = hr2d_scene_add(m->scene, &patch, NULL);
  }
  return status ? status : hr2d_scene_commit(m->scene);
}

static hr2d_status sum_rows(model *m) {
  const size_t n = hr2d_scene_patches(m->scene);
  double area[MOST * MOST];
  const hr2d_status status = hr2d_exchange_matrix(m->scene, NULL, area, NULL);
  for (size_t i = 0; i < n && !status; i++) {
    m->unseen[i] = 1;
    for (size_t j = 0; j < n; j++)
      m->unseen[i] -= area[i * n + j] / hr2d_scene_length(m->scene, i);
  }
  return status;
}

static hr2d_status solve(model *m, const section *s, double epsilon) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  hr2d_status status = make_scene(m, s);
  if (!status) status = sum_rows(m);
  if (!status) status = hr2d_hierarchy_create(m->scene, &m->hierarchy);
  if (!status) status = hr2d_linkset_create(m->hierarchy, NULL, NULL, NULL, NULL, &m->links);
  if (!status) status = hr2d_refine(m->links, &options);
  return status ? status : hr2d_solve(m->links, NULL, &m->solution);
}

static hr2d_point towards(hr2d_point p, hr2d_point q) {
  const double distance = hypot(q.x - p.x, q.y - p.y);
  return (hr2d_point){(q.x - p.x) / distance, (q.y - p.y) / distance};
}

static double cross(hr2d_point d, hr2d_point e) {
  return d.x * e.y - d.y * e.x;
}

/* The closed form at fraction t of patch k. */
static double sky_view(const section *s, size_t k, double t) {
  const hr2d_point a = s->point[k], b = s->point[k + 1], u = towards(a, b);
  const hr2d_point p = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
  hr2d_point left = towards(p, a), right = u;
  for (size_t j = 0; j < k; j++) {
    const hr2d_point d = towards(p, s->point[j]);
    if (cross(d, left) > 0) left = d;
  }
  for (size_t j = k + 2; j < s->points; j++) {
    const hr2d_point e = towards(p, s->point[j]);
    if (cross(right, e) > 0) right = e;
  }
  return ((right.x - left.x) * u.x + (right.y - left.y) * u.y) / 2;
}

/* Walls of height h on both sides of a street 1 wide, by crossed strings. */
static double street_average(double h) {
  return hypot(1, h) - h;
}

static double wall_average(double h) {
  return (1 + h - hypot(1, h)) / (2 * h);
}

static hr2d_status show_canyons(void) {
  printf("A street 1 wide between walls of height H\n%5s  %-13s  %-13s  %s\n", "H",
         "wall  formula", "street", "mid-street");
  hr2d_status status = HR2D_OK;
  for (double h = 0.25; h <= 4 && !status; h *= 2) {
    const section canyon = {4, {{0, h}, {0, 0}, {1, 0}, {1, h}}};
    model m = {0};
    status = solve(&m, &canyon, 1. / 128);
    if (!status)
      printf("%5.2f  %.4f %.4f  %.4f %.4f  %.4f %.4f\n", h, m.unseen[0], wall_average(h),
             m.unseen[1], street_average(h), hr2d_solution_irradiance_at(m.solution, 1, 0.5, 0),
             sky_view(&canyon, 1, 0.5));
    status = finish(&m, status);
  }
  return status;
}

/* A tower on a podium, a street, a house, a yard and a block.  The street sees the upper floors
   of the block over the house. */
static hr2d_status show_quarter(void) {
  static const section quarter = {12,
                                  {{0, 30},
                                   {12, 30},
                                   {12, 9},
                                   {24, 9},
                                   {24, 0},
                                   {40, 0},
                                   {40, 12},
                                   {52, 12},
                                   {52, 0},
                                   {60, 0},
                                   {60, 36},
                                   {75, 36}}};
  static const char *const name[] = {
      "tower's roof", "tower",      "podium's roof", "podium", "street",      "house front",
      "house's roof", "house back", "yard",          "block",  "block's roof"};
  model m = {0};
  const hr2d_status status = solve(&m, &quarter, 1. / 128);
  if (!status)
    printf("\nA street with towers behind its houses\n%-13s %6s %6s %16s %14s %14s\n", "",
           "1-sum", "mean", "1/4  formula", "1/2", "3/4");
  for (size_t k = 0; k + 1 < quarter.points && !status; k++) {
    printf("%-13s %6.4f %6.4f ", name[k], m.unseen[k],
           hr2d_solution_irradiance(m.solution, k, 0));
    for (double t = 0.25; t < 1; t += 0.25)
      printf("  %.4f %.4f", hr2d_solution_irradiance_at(m.solution, k, t, 0),
             sky_view(&quarter, k, t));
    printf("\n");
  }
  return finish(&m, status);
}

int main(void) {
  hr2d_status status = show_canyons();
  if (!status) status = show_quarter();
  return status != HR2D_OK;
}
