/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field on a grid, which is cut into tiles. */
#include <hr2d/field.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sized-struct.h"
#include "field/field-tile.h"
#include "field/past-ends.h"

/* What every view may be off by, as a part of the tolerance. */
#define VIEW 0.125

/* So many nodes for each place where borders of light begin make it worth while to find them.
 */
enum { SOURCES = 4 };

/* For each tile, on the average; with more borders most tiles would be crowded.  So many are
   few for any grid. */
enum { BORDERS = 64, FEW_BORDERS = 65536 };

/* The least range, as a part of the largest M. */
#define LEAST_RANGE 1e-6

static size_t samples(size_t nodes) {
  return (nodes + HR2DI_TILE - 1) / HR2DI_TILE;
}

/* M at each 16th node of each 16th row. */
static hr2d_status do_first(void *ctx, hr2di_field_worker *w, size_t task) {
  hr2di_grid_call *c = ctx;
  const size_t along = samples(c->grid.columns);
  const hr2d_point at =
      hr2di_grid_point(c, task % along * HR2DI_TILE, task / along * HR2DI_TILE);
  hr2di_field_look_at seen;
  const hr2d_status status =
      hr2di_field_look(w, &c->f.source, hr2di_field_scaled(c->f.source.scene, at), &seen);
  memcpy(c->first + task * c->bands, seen.mean, c->bands * sizeof *c->first);
  atomic_fetch_add(&c->exact, 1);
  return status;
}

static void find_range(hr2di_grid_call *c) {
  const size_t count = samples(c->grid.columns) * samples(c->grid.rows);
  for (size_t b = 0; b < c->bands; b++) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t k = 0; k < count; k++) {
      low = fmin(low, c->first[k * c->bands + b]); /* which pass over NaN */
      high = fmax(high, c->first[k * c->bands + b]);
    }
    c->range[b] = high < low ? 0 : c->grid.tolerance * fmax(high - low, LEAST_RANGE * high);
    c->view[b] = VIEW * c->range[b];
  }
}

/* Borders and their map. */
static hr2d_status find_borders(hr2di_grid_call *c) {
  const hr2d_field_values *v = &c->f.values;
  const size_t tiles = c->map.tiles[0] * c->map.tiles[1],
               max = tiles < FEW_BORDERS / BORDERS ? FEW_BORDERS : BORDERS * tiles;
  const hr2di_border_scale scale = {c->range, v->sky || v->back ? c->grid.tolerance : HUGE_VAL};
  const hr2d_status status =
      hr2di_borders_find(&c->borders, &c->f.source, &scale, max, &c->f.watch);
  return status || c->borders.many
             ? status
             : hr2di_border_map_init(&c->map, &c->borders, &c->f.source.scene->alloc,
                                     &c->f.watch);
}

/* Whether a sun shines on nodes past the ends of a period, behind which borders of its light
   are not found: the corners are farthest from the patches. */
static int sees_far_suns(const hr2di_grid_call *c) {
  const hr2d_scene *scene = c->f.source.scene;
  for (int k = 0; k < 4; k++) {
    const hr2d_point corner = {k % 2 ? c->grid.high.x : c->grid.low.x,
                               k / 2 ? c->grid.high.y : c->grid.low.y};
    if (hr2di_far_sees_suns(scene, hr2di_field_scaled(scene, corner))) return 1;
  }
  return 0;
}

/* Gets ready for interpolation, unless there are so many ends that it would not pay. */
static hr2d_status prepare(hr2di_grid_call *c, uint64_t *steps) {
  hr2di_light_source *of = &c->f.source;
  hr2di_field_team *team = &c->f.team;
  team->run = do_first;
  hr2d_status status =
      hr2di_field_team_run(team, samples(c->grid.columns) * samples(c->grid.rows), steps);
  if (status) return status;
  find_range(c);
  status = hr2di_light_source_relax(of, c->view, &c->f.watch);
  if (!status) status = hr2di_leaves_group(&of->leaves, c->bands, c->view, &c->f.watch);
  c->coarse = !status && c->grid.columns > 4 && c->grid.rows > 4 && c->map.step.x != 0 &&
              c->map.step.y != 0 &&
              hr2di_borders_sources(of) <= c->grid.columns * c->grid.rows / SOURCES &&
              !sees_far_suns(c);
  return c->coarse ? find_borders(c) : status;
}

static hr2d_status run(hr2di_grid_call *c, uint64_t *steps) {
  const hr2d_allocator *alloc = &c->f.source.scene->alloc;
  const size_t count = samples(c->grid.columns) * samples(c->grid.rows);
  hr2di_field_team *team = &c->f.team;
  hr2d_status status = HR2D_OK;
  team->ctx = c;
  team->needs = HR2DI_FIELD_ROOM * c->bands + (1 + HR2DI_TILE_SIDE * HR2DI_TILE_SIDE) * c->each;
  c->first = hr2di_alloc(alloc, count, c->bands * sizeof *c->first);
  c->range = hr2di_alloc(alloc, c->bands, sizeof *c->range);
  c->view = hr2di_alloc(alloc, c->bands, sizeof *c->view);
  if (!c->first || !c->range || !c->view) status = HR2D_ENOMEM;
  if (!status && c->grid.tolerance > 0) status = prepare(c, steps);
  team->run = hr2di_grid_tile;
  if (!status) status = hr2di_field_team_run(team, c->map.tiles[0] * c->map.tiles[1], steps);
  hr2di_alloc_free(alloc, c->first);
  hr2di_alloc_free(alloc, c->range);
  hr2di_alloc_free(alloc, c->view);
  if (c->coarse) {
    hr2di_border_map_clear(&c->map);
    hr2di_borders_clear(&c->borders);
  }
  return status ? status : hr2di_watch_ask(&c->f.watch);
}

/* Tiles and the distance of nodes, along one side.  The first and the last node are beside the
   blocks: in many pictures they lie along walls. */
static size_t tiles_along(size_t nodes) {
  return nodes > 3 ? (nodes - 3 + HR2DI_TILE - 1) / HR2DI_TILE : 1;
}

static double step_of(double low, double high, size_t nodes) {
  return nodes > 1 ? high / (double)(nodes - 1) - low / (double)(nodes - 1) : 0;
}

static void set_map(hr2di_grid_call *c, const hr2d_scene *scene) {
  const hr2d_field_grid *g = &c->grid;
  const hr2d_point low = hr2di_field_scaled(scene, g->low),
                   high = hr2di_field_scaled(scene, g->high);
  c->map.low = low;
  c->map.step =
      (hr2d_point){step_of(low.x, high.x, g->columns), step_of(low.y, high.y, g->rows)};
  c->map.tiles[0] = tiles_along(g->columns);
  c->map.tiles[1] = tiles_along(g->rows);
}

static int is_valid(const hr2d_field_grid *g) {
  const hr2d_point end[2] = {g->low, g->high};
  return hr2di_field_finite(end, 2) && g->columns > 0 && g->rows > 0 &&
         g->columns <= SIZE_MAX / 1024 / g->rows && g->tolerance >= 0 && g->tolerance <= 1;
}

hr2d_status hr2d_field_on_grid(const hr2d_solution *solution, const hr2d_field_grid *grid,
                               const hr2d_field_options *options,
                               const hr2d_field_values *values, hr2d_field_counts *counts) {
  if (!solution) return HR2D_EINVAL;
  hr2di_grid_call c = {.grid = HR2D_FIELD_GRID_INIT, .bands = solution->bands};
  uint64_t steps = 0;
  hr2d_status status = hr2di_sized_copy(&c.grid, sizeof c.grid, grid);
  if (status || !is_valid(&c.grid)) return HR2D_EINVAL;
  c.each = HR2DI_NODE_LIGHT + 4 * c.bands;
  status = hr2di_field_open(&c.f, solution, c.grid.columns * c.grid.rows, options, values);
  /* Borders of the light above a plane are not those of the light all round. */
  if (!status && c.grid.tolerance > 0 && (c.f.values.irradiance || c.f.values.irradiance_error))
    status = HR2D_EINVAL;
  set_map(&c, &c.f.scene.scene);
  c.items = c.f.values.flux || c.f.values.error ? c.each : HR2DI_NODE_LIGHT + c.bands;
  if (!status) status = run(&c, &steps);
  hr2di_field_close(&c.f);
  if (!status && counts)
    *counts = (hr2d_field_counts){atomic_load(&c.exact), atomic_load(&c.interpolated), steps};
  return status;
}
