/* What architects ask of points between walls.  You learn to read the light of a solution at
   any point, and view factors of points without a solution.

   Three cross-sections of black walls, each beside its closed form:
   - the mean radiant temperature T between two warm walls, σT⁴ = M: each wall has the part
     2 atan(½ length / ½ distance)/2π of all directions;
   - the daylight factor on a desk, its form factor to the sky through a window: half of the
     difference of the cosines of the elevations of sill and lintel;
   - the sky view factor of a point in the middle of a street: the cosine of the elevation of
     the roofs. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

static const double sigma = 5.670374419e-8; /* W/(m² K⁴) */
static const double pi = 3.14159265358979324;

typedef struct wall {
  double ax, ay, bx, by, emission;
} wall;

static hr2d_status make_scene(const wall *w, size_t count, double background,
                              hr2d_scene **scene) {
  hr2d_status status = hr2d_scene_create(NULL, scene);
  for (size_t k = 0; k < count && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = (hr2d_point){w[k].ax, w[k].ay};
    patch.b = (hr2d_point){w[k].bx, w[k].by};
    patch.emission = &w[k].emission;
    patch.emission_bands = 1;
    status = hr2d_scene_add(*scene, &patch, NULL);
  }
  if (!status) status = hr2d_scene_set_background(*scene, &background, 1);
  return status ? status : hr2d_scene_commit(*scene);
}

static double emission(double kelvin) {
  return sigma * pow(kelvin, 4);
}

/* Half way between walls of 3 m that are 4 m apart; all else has 290 K. */
static hr2d_status mean_radiant_temperature(void) {
  const wall walls[] = {{0, 3, 0, 0, emission(300)}, {4, 0, 4, 3, emission(320)}};
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  double mean = 0;
  const hr2d_point person = {2, 1.5};
  const hr2d_field_values values = {.struct_size = sizeof values, .mean = &mean};
  hr2d_status status = make_scene(walls, 2, emission(290), &scene);
  if (!status) status = hr2d_solve_to(scene, NULL, &solution, NULL);
  if (!status) status = hr2d_field_at(solution, &person, 1, NULL, &values);
  const double part = 2 * atan(1.5 / 2) / (2 * pi);
  const double known = part * (emission(300) + emission(320)) + (1 - 2 * part) * emission(290);
  if (!status)
    printf("mean radiant temperature  %.6f K, closed form %.6f K\n", pow(mean / sigma, .25),
           pow(known / sigma, .25));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return status;
}

/* Keeps what a row has of the sky. */
typedef struct view {
  double share, factor;
} view;

static hr2d_status keep_sky(void *ctx, const hr2d_field_row *row) {
  view *v = ctx;
  v->share = row->sky;
  v->factor = row->sky_factor;
  return HR2D_OK;
}

static hr2d_status look_up(const wall *walls, size_t count, hr2d_point at, view *sky) {
  hr2d_scene *scene = NULL;
  const hr2d_point up = {0, 1};
  hr2d_status status = make_scene(walls, count, 1, &scene);
  if (!status) status = hr2d_field_rows_visit(scene, &at, &up, 1, NULL, keep_sky, sky);
  hr2d_scene_destroy(scene);
  return status;
}

/* A desk 2.5 m behind a window from 1 m to 2.5 m above the floor. */
static hr2d_status daylight_factor(void) {
  const wall room[] = {
      {0, 0, 4, 0, 0}, {4, 0, 4, 1, 0}, {4, 2.5, 4, 3, 0}, {4, 3, 0, 3, 0}, {0, 3, 0, 0, 0}};
  view sky = {0, 0};
  const hr2d_status status = look_up(room, 5, (hr2d_point){1.5, 0.75}, &sky);
  const double known = (2.5 / hypot(2.5, 0.25) - 2.5 / hypot(2.5, 1.75)) / 2;
  if (!status)
    printf("daylight factor           %.6f %%, closed form %.6f %%\n", 100 * sky.factor,
           100 * known);
  return status;
}

/* A street of 10 m between houses of 15 m. */
static hr2d_status sky_view_factor(void) {
  const wall street[] = {{-5, 0, 5, 0, 0}, {5, 0, 5, 15, 0}, {-5, 15, -5, 0, 0}};
  view sky = {0, 0};
  const hr2d_status status = look_up(street, 3, (hr2d_point){0, 0}, &sky);
  const double known = 5 / hypot(5, 15);
  if (!status) printf("sky view factor           %.6f, closed form %.6f\n", sky.factor, known);
  return status;
}

int main(void) {
  hr2d_status status = mean_radiant_temperature();
  if (!status) status = daylight_factor();
  if (!status) status = sky_view_factor();
  if (status) fprintf(stderr, "room-climate: %s\n", hr2d_strerror(status));
  return status != HR2D_OK;
}
