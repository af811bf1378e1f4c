/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light at a grid of points of the page. */
#include "cli/scene.h"
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>

#include "output/complain.h"

/* What the library gives for all nodes. */
typedef struct look {
  size_t bands;
  double *mean, *flux, *sky;
  unsigned char *place;
  hr2d_field_counts counts;
} look;

static double mean_of(const void *ctx, size_t node, size_t band) {
  const look *l = ctx;
  return l->mean[node * l->bands + band];
}

static double flux_x(const void *ctx, size_t node, size_t band) {
  const look *l = ctx;
  return l->flux[2 * (node * l->bands + band)];
}

static double flux_y(const void *ctx, size_t node, size_t band) {
  const look *l = ctx;
  return l->flux[2 * (node * l->bands + band) + 1];
}

static shade shade_of_node(const picture *p, const look *l, size_t node) {
  if (l->place[node] == HR2D_PLACE_OUTSIDE) return (shade){{NAN, NAN, NAN}};
  if (p->quantity == QUANTITY_SKY) return (shade){{l->sky[node], 0, 0}};
  if (p->quantity == QUANTITY_FLUX)
    return (shade){
        {hypot(shade_of(p, flux_x, l, node).v[0], shade_of(p, flux_y, l, node).v[0]), 0, 0}};
  return shade_of(p, mean_of, l, node);
}

static hr2d_field_grid grid_of(const picture *p, const raster *r, double tolerance) {
  hr2d_field_grid grid = HR2D_FIELD_GRID_INIT;
  grid.low = layout_scene_point(p, r->x, r->y);
  grid.high = layout_scene_point(p, r->x + (double)(r->columns - 1) * r->step,
                                 r->y + (double)(r->rows - 1) * r->step);
  grid.columns = r->columns;
  grid.rows = r->rows;
  grid.tolerance = tolerance;
  return grid;
}

static int look_at(const picture *p, const hr2d_field_grid *grid, look *l) {
  progress shown;
  progress_start(&shown, p->run->options->quiet);
  const hr2d_field_options how = {.struct_size = sizeof how,
                                  .threads = options_threads(p->run->options),
                                  .progress = progress_show,
                                  .progress_ctx = &shown};
  const hr2d_field_values to = {.struct_size = sizeof to,
                                .mean = l->mean,
                                .flux = l->flux,
                                .sky = l->sky,
                                .place = l->place};
  const hr2d_status status = hr2d_field_on_grid(p->run->solution, grid, &how, &to, &l->counts);
  progress_clear(&shown);
  progress_end();
  return status ? scene_complain(p->run->options, p->run->scene, status) : EXIT_DONE;
}

static int fill_raster(const picture *p, double tolerance, raster *r, look *l) {
  const size_t nodes = r->columns * r->rows, values = nodes * l->bands;
  const int flux = p->quantity == QUANTITY_FLUX, sky = p->quantity == QUANTITY_SKY;
  const hr2d_field_grid grid = grid_of(p, r, tolerance);
  l->mean = malloc(values * sizeof *l->mean);
  l->flux = flux ? malloc(2 * values * sizeof *l->flux) : NULL;
  l->sky = sky ? malloc(nodes * sizeof *l->sky) : NULL;
  l->place = malloc(nodes);
  r->at = malloc(nodes * sizeof *r->at);
  if (!l->mean || (flux && !l->flux) || (sky && !l->sky) || !l->place || !r->at)
    return complain_memory();
  const int status = look_at(p, &grid, l);
  for (size_t k = 0; k < nodes && !status; k++) r->at[k] = shade_of_node(p, l, k);
  return status;
}

int raster_make(const picture *p, double step, double tolerance, raster *to) {
  look l = {.bands = hr2d_scene_bands(p->run->scene)};
  raster r = {.x = p->frame.x0 + 0.5 * step, .y = p->frame.y0 + 0.5 * step, .step = step};
  r.columns = (size_t)fmax(1, floor((p->frame.x1 - p->frame.x0) / step));
  r.rows = (size_t)fmax(1, floor((p->frame.y1 - p->frame.y0) / step));
  const int status = fill_raster(p, tolerance, &r, &l);
  r.work = (double)l.counts.triangles / (double)(r.columns * r.rows);
  free(l.mean);
  free(l.flux);
  free(l.sky);
  free(l.place);
  if (status) {
    free(r.at);
    r.at = NULL;
  }
  *to = r;
  return status;
}
#endif
