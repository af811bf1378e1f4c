/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d field`: solves as `hr2d solve` does, and looks from points between the patches. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/scene.h"
#include "draw/draw.h"
#include "field/field.h"
#include "output/clock.h"
#include "output/complain.h"
#include "output/progress.h"

#define PI 3.14159265358979323846

/* Nodes along the longer side of the box if --grid is not given. */
enum { NODES = 64 };

static void set_box(field *f) {
  const options *o = f->options;
  hr2d_field_grid *g = &f->grid;
  g->low = (hr2d_point){HUGE_VAL, HUGE_VAL};
  g->high = (hr2d_point){-HUGE_VAL, -HUGE_VAL};
  for (size_t k = 0; k < hr2d_scene_patches(f->scene); k++) {
    const hr2d_segment s = hr2d_scene_segment(f->scene, k);
    g->low.x = fmin(g->low.x, fmin(s.a.x, s.b.x));
    g->low.y = fmin(g->low.y, fmin(s.a.y, s.b.y));
    g->high.x = fmax(g->high.x, fmax(s.a.x, s.b.x));
    g->high.y = fmax(g->high.y, fmax(s.a.y, s.b.y));
  }
  if (!o->box.given) return;
  g->low = (hr2d_point){o->box.side[0], o->box.side[1]};
  g->high = (hr2d_point){o->box.side[2], o->box.side[3]};
}

static size_t nodes_along(double side, double longer) {
  return longer > 0 ? 1 + (size_t)ceil((NODES - 1) * (side / longer)) : 1;
}

static int set_grid(field *f) {
  hr2d_field_grid *g = &f->grid;
  *g = (hr2d_field_grid)HR2D_FIELD_GRID_INIT;
  set_box(f);
  g->tolerance = f->options->tolerance;
  const double width = fabs(g->high.x - g->low.x), height = fabs(g->high.y - g->low.y),
               longer = fmax(width, height);
  g->columns = f->options->grid.columns ? f->options->grid.columns : nodes_along(width, longer);
  g->rows = f->options->grid.rows ? f->options->grid.rows : nodes_along(height, longer);
  if (f->options->pfm) field_to_pixel_centres(g);
  f->count = g->columns * g->rows;
  f->at = malloc(f->count * sizeof *f->at);
  for (size_t k = 0; k < f->count && f->at; k++) {
    const size_t column = k % g->columns, row = k / g->columns;
    const double x = g->columns > 1 ? (double)column / (double)(g->columns - 1) : 0,
                 y = g->rows > 1 ? (double)row / (double)(g->rows - 1) : 0;
    f->at[k].x = x < 1 ? g->low.x + x * (g->high.x - g->low.x) : g->high.x;
    f->at[k].y = y < 1 ? g->low.y + y * (g->high.y - g->low.y) : g->high.y;
  }
  return f->at ? 0 : complain_memory();
}

/* Room for irradiances if there are normals: of the points, or the one of --normal. */
static int set_normals(field *f, hr2d_field_options *how, hr2d_point *one) {
  *one = (hr2d_point){f->options->normal.x, f->options->normal.y};
  if (!f->normal && one->x == 0 && one->y == 0) return 0;
  how->normal = f->normal ? f->normal : one;
  how->normals = f->normal ? f->count : 1;
  f->irradiance = malloc((f->count * f->bands + 1) * sizeof *f->irradiance);
  f->irradiance_error = malloc((f->count * f->bands + 1) * sizeof *f->irradiance_error);
  return f->irradiance && f->irradiance_error ? 0 : complain_memory();
}

/* Every point is exact, those of a grid as well if it has no tolerance. */
static int look(field *f, const run *r) {
  progress p;
  progress_start(&p, f->options->quiet);
  hr2d_point one;
  hr2d_field_options how = {.struct_size = sizeof how,
                            .threads = options_threads(f->options),
                            .progress = progress_show,
                            .progress_ctx = &p,
                            .account = &r->account};
  const size_t values = f->count * f->bands;
  f->mean = malloc((values + 1) * sizeof *f->mean);
  f->flux = malloc((2 * values + 1) * sizeof *f->flux);
  f->error = malloc((values + 1) * sizeof *f->error);
  f->sky = malloc((f->count + 1) * sizeof *f->sky);
  f->place = malloc(f->count + 1);
  if (!f->mean || !f->flux || !f->error || !f->sky || !f->place) return complain_memory();
  if (set_normals(f, &how, &one)) return EXIT_FAILED;
  const hr2d_field_values to = {.struct_size = sizeof to,
                                .mean = f->mean,
                                .flux = f->flux,
                                .error = f->error,
                                .sky = f->sky,
                                .place = f->place,
                                .irradiance = f->irradiance,
                                .irradiance_error = f->irradiance_error};
  const hr2d_status status =
      f->grid.tolerance > 0 ? hr2d_field_on_grid(r->solution, &f->grid, &how, &to, &f->counts)
                            : hr2d_field_at(r->solution, f->at, f->count, &how, &to);
  progress_clear(&p);
  progress_end();
  return status ? scene_complain(f->options, r->scene, status) : 0;
}

static void print_temperatures(const field *f) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (size_t k = 0; k < f->count; k++) {
    low = fmin(low, field_temperature(f, k)); /* which pass over NaN */
    high = fmax(high, field_temperature(f, k));
  }
  if (high >= low) printf("mean radiant temperature %.9g to %.9g K\n", low, high);
}

static void print_error(double error) {
  if (isnan(error))
    puts("          errors not measured");
  else
    printf("          error of the mean at most %.1e, of the flux %.1e\n", error, PI * error);
}

/* Of a band. */
static void print_irradiance(const field *f, size_t band) {
  double low = HUGE_VAL, high = -HUGE_VAL, error = NAN;
  for (size_t k = band; k < f->count * f->bands && f->irradiance; k += f->bands) {
    low = fmin(low, f->irradiance[k]);
    high = fmax(high, f->irradiance[k]);
    error = fmax(error, f->irradiance_error[k]);
  }
  if (high < low) return;
  printf("          irradiance %.9g to %.9g", low, high);
  if (isnan(error))
    putchar('\n');
  else
    printf(", error at most %.1e\n", error);
}

static void print_field(const field *f, double seconds) {
  size_t of_place[3] = {0};
  for (size_t k = 0; k < f->count; k++) of_place[f->place[k]]++;
  scene_print(f->options, 10, f->cuts);
  printf("points    %zu: %zu between the patches, %zu on patches, %zu outside\n", f->count,
         of_place[HR2D_PLACE_BETWEEN], of_place[HR2D_PLACE_PATCH],
         of_place[HR2D_PLACE_OUTSIDE]);
  if (f->grid.tolerance > 0)
    printf("grid      %llu of %zu nodes interpolated\n",
           (unsigned long long)f->counts.interpolated, f->count);
  for (size_t b = 0; b < f->bands; b++) {
    double low = HUGE_VAL, high = -HUGE_VAL, flux = 0, error = NAN;
    for (size_t k = b; k < f->count * f->bands; k += f->bands) {
      error = fmax(error, f->error[k]);
      low = fmin(low, f->mean[k]); /* which pass over NaN */
      high = fmax(high, f->mean[k]);
      flux = fmax(flux, hypot(f->flux[2 * k], f->flux[2 * k + 1]));
    }
    if (high >= low)
      printf("band %-4zu mean %.9g to %.9g, |flux| to %.9g\n", b, low, high, flux);
    if (high >= low) print_error(error);
    print_irradiance(f, b);
  }
  if (f->heat) print_temperatures(f);
  printf("seconds   total %.3f\n", seconds);
}

static int report(const field *f, const run *r, double start) {
  const options *o = f->options;
  int status = 0;
  if (options_want_table(o)) print_field(f, clock_seconds() - start);
  if (o->csv) status = field_write_csv(f, o->csv);
  if (o->factors && !status) status = field_write_factors(f, o->factors);
  if (o->json && !status) status = field_write_json(f, o->json);
  if (o->vtk && !status) status = field_write_vtk(f, o->vtk);
  if (o->pfm && !status) status = field_write_pfm(f, o->pfm);
  if (o->draw && !status) status = draw_run(r, o->draw);
  return status;
}

static int solve_and_look(field *f, double start) {
  options how = *f->options;
  how.no_error = !options_targeted(&how);
  run r = {.options = &how, .scene = f->scene, .cuts = f->cuts, .start = start};
  int status = run_solve(&r);
  if (!status || r.inaccurate) {
    int looking = look(f, &r);
    if (!looking) looking = report(f, &r, start);
    status = complain_join(status, looking);
  }
  run_release(&r);
  return status;
}

int field_command(const options *o) {
  const double start = clock_seconds();
  hr2d_scene *scene = NULL;
  field f = {.options = o};
  int status = o->draw ? draw_check(o->draw) : 0;
  if (!status) status = options_check_outputs(o);
  if (!status) status = scene_load(o, o->force, &scene, &f.cuts);
  if (status) return status;
  f.scene = scene;
  f.bands = hr2d_scene_bands(scene);
  f.heat = run_heat_exists(scene);
  status = draw_check_scene(o, scene);
  if (!status) status = field_check_pfm(&f);
  if (!status) status = o->points ? field_read_points(&f, o->points) : set_grid(&f);
  if (!status && f.normal && (o->normal.x != 0 || o->normal.y != 0))
    status = complain_usage("--normal is for points that have no normals of their own");
  if (!status) status = solve_and_look(&f, start);
  free(f.at);
  free(f.normal);
  free(f.irradiance);
  free(f.irradiance_error);
  free(f.mean);
  free(f.flux);
  free(f.error);
  free(f.sky);
  free(f.place);
  hr2d_scene_destroy(scene);
  return status;
}
