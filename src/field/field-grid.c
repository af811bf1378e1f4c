/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field on a grid.  It is cut into tiles, and each tile by itself into blocks: what a node
   receives does not depend on threads.

   Where all points of a block see the same ends of patches, M is analytic.  A block has 3 × 3
   nodes that are exact.  With M − I₁ = O(h²) for the interpolation of degree 1 through its
   corners, that of degree 2 through all nine has an error of O(h³): it is taken if the first is
   within the tolerance at the other five.  Else the block is divided in four. */
#include <hr2d/field.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "base/sized-struct.h"
#include "field/field-at.h"

/* Cells along a side of a tile, and nodes, with those of the next tile. */
enum { TILE = 16, SIDE = TILE + 1 };

/* What is kept of a node: whether it is exact (1) or interpolated (−1), these, and then mean,
 * flux and error. */
enum { KNOWN, PLACE, SIGNATURE, CLEARANCE, SKY, BACK, LIGHT };

/* The least range, as a part of the largest M. */
#define LEAST_RANGE 1e-6

typedef struct grid_call {
  hr2di_field_call f;
  hr2d_field_grid grid;
  size_t bands, each; /* doubles per node */
  size_t tiles[2];    /* along a row, and rows of them */
  double *first;      /* M at the first node of each tile */
  double *range;      /* of M per band, times the tolerance */
  double cell;        /* how far nodes are apart at most, scaled */
  atomic_uint_fast64_t exact, interpolated;
} grid_call;

/* One tile of a worker. */
typedef struct tile {
  grid_call *call;
  hr2di_field_worker *worker;
  double *node; /* SIDE × SIDE */
  size_t at[2]; /* its first node */
  uint64_t exact, interpolated;
} tile;

/* A block of nodes [at, at + size]² of a tile. */
typedef struct block {
  int at[2], size;
} block;

static double *node_of(const tile *t, int column, int row) {
  return t->node + (size_t)(row * SIDE + column) * t->call->each;
}

static double place_on(double low, double high, size_t k, size_t count) {
  if (count < 2) return low;
  const double t = (double)k / (double)(count - 1);
  return t < 0.5 ? low + t * (high - low) : high - (1 - t) * (high - low);
}

/* Nodes beyond the grid are points as well. */
static hr2d_point point_of(const grid_call *c, size_t column, size_t row) {
  const hr2d_field_grid *g = &c->grid;
  return (hr2d_point){place_on(g->low.x, g->high.x, column, g->columns),
                      place_on(g->low.y, g->high.y, row, g->rows)};
}

static hr2d_status look(tile *t, int column, int row) {
  const grid_call *c = t->call;
  double *node = node_of(t, column, row);
  hr2di_field_look_at seen;
  if (node[KNOWN] > 0) return HR2D_OK;
  const hr2d_point at = point_of(c, t->at[0] + (size_t)column, t->at[1] + (size_t)row);
  const hr2d_point x = hr2di_field_scaled(c->f.source.scene, at);
  const hr2d_status status = hr2di_field_look(t->worker, &c->f.source, x, &seen);
  node[KNOWN] = 1;
  node[PLACE] = seen.place;
  memcpy(&node[SIGNATURE], &seen.signature, sizeof(double));
  node[CLEARANCE] = seen.clearance;
  node[SKY] = seen.sky;
  node[BACK] = seen.back;
  memcpy(node + LIGHT, seen.mean, c->bands * sizeof *node);
  memcpy(node + LIGHT + c->bands, seen.flux, 2 * c->bands * sizeof *node);
  memcpy(node + LIGHT + 3 * c->bands, seen.error, c->bands * sizeof *node);
  t->exact++;
  return status;
}

/* Whether the nine nodes of a block see the same, and nothing that is nearer to one of them
   than the next node: beside an end of a leaf M varies as far as it is away. */
static int is_even(const tile *t, const block *b) {
  const double *first = node_of(t, b->at[0], b->at[1]);
  for (int k = 0; k < 9; k++) {
    const double *node =
        node_of(t, b->at[0] + k % 3 * b->size / 2, b->at[1] + k / 3 * b->size / 2);
    if (node[CLEARANCE] < t->call->cell * b->size / 2 || node[PLACE] == HR2D_PLACE_PATCH ||
        node[PLACE] != first[PLACE] ||
        memcmp(&node[SIGNATURE], &first[SIGNATURE], sizeof(double)) != 0)
      return 0;
  }
  return 1;
}

/* Item k of the nine nodes minus its interpolation through the corners, the largest. */
static double bend(const tile *t, const block *b, size_t k) {
  double v[3][3], most = 0;
  for (int j = 0; j < 9; j++)
    v[j / 3][j % 3] =
        node_of(t, b->at[0] + j % 3 * b->size / 2, b->at[1] + j / 3 * b->size / 2)[k];
  for (int j = 0; j < 9; j++) {
    const double x = j % 3 / 2.0, y = j / 3 / 2.0;
    const double plain =
        (1 - y) * ((1 - x) * v[0][0] + x * v[0][2]) + y * ((1 - x) * v[2][0] + x * v[2][2]);
    most = fmax(most, fabs(v[j / 3][j % 3] - plain));
  }
  return most;
}

static int is_flat(const tile *t, const block *b) {
  const grid_call *c = t->call;
  const double most = c->grid.tolerance;
  if (bend(t, b, SKY) > most || bend(t, b, BACK) > most) return 0;
  if (node_of(t, b->at[0], b->at[1])[PLACE] == HR2D_PLACE_OUTSIDE) return 1;
  for (size_t k = 0; k < c->bands; k++) {
    const size_t flux = LIGHT + c->bands + 2 * k;
    if (bend(t, b, LIGHT + k) > c->range[k] || bend(t, b, flux) > HR2DI_PI * c->range[k] ||
        bend(t, b, flux + 1) > HR2DI_PI * c->range[k])
      return 0;
  }
  return 1;
}

/* Weights of the values at 0, ½ and 1 for degree 2. */
static void weights(double t, double w[3]) {
  w[0] = (2 * t - 1) * (t - 1);
  w[1] = 4 * t * (1 - t);
  w[2] = t * (2 * t - 1);
}

static void interpolate(tile *t, const block *b, int column, int row) {
  double *node = node_of(t, b->at[0] + column, b->at[1] + row), x[3], y[3];
  if (node[KNOWN] != 0) return;
  weights((double)column / b->size, x);
  weights((double)row / b->size, y);
  for (size_t k = SKY; k < t->call->each; k++) node[k] = 0;
  for (int j = 0; j < 9; j++) {
    const double *from =
        node_of(t, b->at[0] + j % 3 * b->size / 2, b->at[1] + j / 3 * b->size / 2);
    for (size_t k = SKY; k < t->call->each; k++) node[k] += x[j % 3] * y[j / 3] * from[k];
  }
  node[PLACE] = node_of(t, b->at[0], b->at[1])[PLACE];
  node[SKY] = fmin(fmax(node[SKY], 0), 1);
  node[BACK] = fmin(fmax(node[BACK], 0), 1);
  node[KNOWN] = -1;
}

/* The nodes of a block, by interpolation or in four blocks. */
static hr2d_status fill(tile *t, const block *whole) {
  block stack[16];
  int count = 0;
  hr2d_status status = HR2D_OK;
  stack[count++] = *whole;
  while (count > 0 && !status) {
    const block b = stack[--count];
    if (t->at[0] + (size_t)b.at[0] >= t->call->grid.columns ||
        t->at[1] + (size_t)b.at[1] >= t->call->grid.rows)
      continue;
    for (int j = 0; j < 9 && !status; j++)
      status = look(t, b.at[0] + j % 3 * b.size / 2, b.at[1] + j / 3 * b.size / 2);
    if (status || b.size == 2) continue;
    if (is_even(t, &b) && is_flat(t, &b)) {
      for (int k = 0; k < (b.size + 1) * (b.size + 1); k++)
        interpolate(t, &b, k % (b.size + 1), k / (b.size + 1));
      continue;
    }
    for (int j = 0; j < 4; j++)
      stack[count++] =
          (block){{b.at[0] + j % 2 * b.size / 2, b.at[1] + j / 2 * b.size / 2}, b.size / 2};
  }
  return status;
}

static size_t least(size_t a, size_t b) {
  return a < b ? a : b;
}

/* The nodes of a tile that are its own. */
static void keep(tile *t) {
  const grid_call *c = t->call;
  const size_t columns = least(c->grid.columns - t->at[0], TILE),
               rows = least(c->grid.rows - t->at[1], TILE);
  for (size_t k = 0; k < columns * rows; k++) {
    const size_t column = k % columns, row = k / columns;
    const double *node = node_of(t, (int)column, (int)row);
    const hr2di_field_look_at seen = {.mean = node + LIGHT,
                                      .flux = node + LIGHT + c->bands,
                                      .error = node + LIGHT + 3 * c->bands,
                                      .sky = node[SKY],
                                      .back = node[BACK],
                                      .place = (hr2d_place)node[PLACE]};
    hr2di_field_keep(&c->f.values, (t->at[1] + row) * c->grid.columns + t->at[0] + column,
                     c->bands, &seen);
    t->interpolated += node[KNOWN] < 0;
  }
}

static tile tile_of(grid_call *c, hr2di_field_worker *w, size_t task) {
  tile t = {.call = c, .worker = w, .node = w->room + 4 * c->bands};
  t.at[0] = task % c->tiles[0] * TILE;
  t.at[1] = task / c->tiles[0] * TILE;
  for (size_t k = 0; k < SIDE * SIDE; k++) t.node[k * c->each + KNOWN] = 0;
  return t;
}

static hr2d_status do_first(void *ctx, hr2di_field_worker *w, size_t task) {
  grid_call *c = ctx;
  tile t = tile_of(c, w, task);
  const hr2d_status status = look(&t, 0, 0);
  memcpy(c->first + task * c->bands, t.node + LIGHT, c->bands * sizeof *c->first);
  return status;
}

/* Blocks may reach over the last nodes of the grid. */
static hr2d_status do_tile(void *ctx, hr2di_field_worker *w, size_t task) {
  grid_call *c = ctx;
  tile t = tile_of(c, w, task);
  const size_t columns = least(c->grid.columns - t.at[0], TILE),
               rows = least(c->grid.rows - t.at[1], TILE);
  const block all = {{0, 0}, TILE};
  hr2d_status status = HR2D_OK;
  if (c->grid.tolerance > 0 && columns > 1 && rows > 1) status = fill(&t, &all);
  for (size_t k = 0; k < columns * rows && !status; k++)
    if (node_of(&t, (int)(k % columns), (int)(k / columns))[KNOWN] == 0)
      status = look(&t, (int)(k % columns), (int)(k / columns));
  if (!status) keep(&t);
  atomic_fetch_add(&c->exact, t.exact);
  atomic_fetch_add(&c->interpolated, t.interpolated);
  return status;
}

/* Where a border of light passes over a jump of B_h, the slope of M jumps.  Within a block the
   border turns by less than 1 in most cases, so that M misses by less than the jump over 2π. */
static hr2d_status find_range(grid_call *c) {
  for (size_t b = 0; b < c->bands; b++) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t k = 0; k < c->tiles[0] * c->tiles[1]; k++) {
      low = fmin(low, c->first[k * c->bands + b]); /* which pass over NaN */
      high = fmax(high, c->first[k * c->bands + b]);
    }
    c->range[b] = high < low ? 0 : c->grid.tolerance * fmax(high - low, LEAST_RANGE * high);
  }
  return hr2di_leaves_group(&c->f.source.leaves, c->f.source.solution, c->range, &c->f.watch);
}

static hr2d_status run(grid_call *c, uint64_t *steps) {
  const hr2d_allocator *alloc = &c->f.source.scene->alloc;
  const size_t tiles = c->tiles[0] * c->tiles[1];
  hr2di_field_team *team = &c->f.team;
  hr2d_status status = HR2D_OK;
  team->ctx = c;
  team->needs = 4 * c->bands + SIDE * SIDE * c->each;
  c->first = hr2di_alloc(alloc, tiles, c->bands * sizeof *c->first);
  c->range = hr2di_alloc(alloc, c->bands, sizeof *c->range);
  if (!c->first || !c->range) status = HR2D_ENOMEM;
  team->run = do_first;
  if (!status && c->grid.tolerance > 0) status = hr2di_field_team_run(team, tiles, steps);
  if (!status && c->grid.tolerance > 0) status = find_range(c);
  team->run = do_tile;
  if (!status) status = hr2di_field_team_run(team, tiles, steps);
  hr2di_alloc_free(alloc, c->first);
  hr2di_alloc_free(alloc, c->range);
  return status ? status : hr2di_watch_ask(&c->f.watch);
}

static double cell_of(const hr2d_field_grid *g, const hr2d_scene *scene) {
  const double x = g->columns > 1 ? (g->high.x - g->low.x) / (double)(g->columns - 1) : 0,
               y = g->rows > 1 ? (g->high.y - g->low.y) / (double)(g->rows - 1) : 0;
  return ldexp(hypot(x, y), -scene->exponent);
}

static int is_valid(const hr2d_field_grid *g) {
  const hr2d_point end[2] = {g->low, g->high};
  return hr2di_field_finite(end, 2) && g->columns > 0 && g->rows > 0 &&
         g->columns <= SIZE_MAX / 1024 / g->rows && g->tolerance >= 0 && g->tolerance <= 1;
}

hr2d_status hr2d_field_on_grid(const hr2d_solution *solution, const hr2d_field_grid *grid,
                               const hr2d_field_options *options,
                               const hr2d_field_values *values, hr2d_field_counts *counts) {
  grid_call c = {.grid = HR2D_FIELD_GRID_INIT, .bands = solution->bands};
  uint64_t steps = 0;
  hr2d_status status = hr2di_sized_copy(&c.grid, sizeof c.grid, grid);
  if (status || !is_valid(&c.grid)) return HR2D_EINVAL;
  c.each = LIGHT + 4 * c.bands;
  c.cell = cell_of(&c.grid, solution->hierarchy->scene);
  c.tiles[0] = (c.grid.columns + TILE - 1) / TILE;
  c.tiles[1] = (c.grid.rows + TILE - 1) / TILE;
  status = hr2di_field_open(&c.f, solution, options, values);
  if (!status) status = run(&c, &steps);
  hr2di_field_close(&c.f);
  if (!status && counts)
    *counts = (hr2d_field_counts){atomic_load(&c.exact), atomic_load(&c.interpolated), steps};
  return status;
}
