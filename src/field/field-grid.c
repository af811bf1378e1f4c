/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field on a grid.  It is cut into tiles, and each tile by itself into blocks: what a node
   receives does not depend on threads.

   With a tolerance τ, every view may be off by VIEW τ.  A block has 3 × 3 nodes with views, and
   is interpolated between them, linearly in x and in y, if
   - the jumps of the slope of M at all borders of light in the block cost at most KINK τ;
   - the nine miss the interpolation of degree 1 through the corners by at most BEND τ: where M
     is smooth, with a second derivative that changes little between nodes, what is between the
     nine is off by half of that in both directions together;
   - no end of what they see is nearer than the next of the nine;
   - one more view on each line through the middle, half way between two of the nine, is as it
     would be interpolated, to PROBE τ.  There the error of a function that turns from bending
     one way to the other is largest, which the nine do not show.
   Else the block is divided in four.  BEND/2 is far enough below 1 − KINK − VIEW. */
#include <hr2d/field.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "base/sized-struct.h"
#include "field/border-map.h"
#include "field/field-at.h"
#include "field/past-ends.h"

#define VIEW  0.125
#define KINK  0.25
#define BEND  0.8
#define PROBE 0.4

/* Nodes along a side of the largest block, with one before it and one after it. */
enum { TILE = HR2DI_TILE, SIDE = TILE + 3 };

/* What is kept of a node: whether it has a view (1) or is interpolated (−1), these, and then
 * mean, flux and error. */
enum { KNOWN, PLACE, CLEARANCE, SKY, BACK, CUT_OFF, LIGHT };

/* So many nodes for each place where borders of light begin make it worth while to find them.
 */
enum { SOURCES = 4 };

/* For each tile, on the average; with more borders most tiles would be crowded.  So many are
   few for any grid. */
enum { BORDERS = 64, FEW_BORDERS = 65536 };

/* The least range, as a part of the largest M. */
#define LEAST_RANGE 1e-6

/* Where a front goes out of sight, blocks whose nodes see fronts, or a sky with light, in less
   than this part of directions are divided: there may be a place that sees none. */
#define LEAST_LIT 0.25

typedef struct grid_call {
  hr2di_field_call f;
  hr2d_field_grid grid;
  size_t bands, each; /* doubles per node */
  size_t items;       /* of these, up to which any is wanted */
  double *first;      /* M at the first node of each tile */
  double *range;      /* of M per band, times the tolerance */
  double *view;       /* what of that views may take */
  int coarse;         /* whether nodes may be interpolated */
  hr2di_borders borders;
  hr2di_border_map map; /* with the tiles */
  atomic_uint_fast64_t exact, interpolated;
} grid_call;

/* One tile of a worker.  Its own nodes are those of its block but the first column and row,
   with what is before the first tiles and after the last ones. */
typedef struct tile {
  grid_call *call;
  hr2di_field_worker *worker;
  size_t number;
  double *probe;                        /* items of one node */
  double *node;                         /* SIDE × SIDE, the block from (1, 1) on */
  size_t at[2];                         /* the node before the block */
  int own_low[2], own_high[2], size[2]; /* counted from there; the last of the block */
  uint64_t exact, interpolated;
} tile;

/* A block of nodes of a tile. */
typedef struct block {
  int low[2], high[2];
} block;

static double *node_of(const tile *t, int column, int row) {
  return t->node + (size_t)(row * SIDE + column) * t->call->each;
}

static int middle(const block *b, int k) {
  return b->low[k] + (b->high[k] - b->low[k]) / 2;
}

/* The k-th of its nine nodes. */
static double *support(const tile *t, const block *b, int k) {
  const int column[] = {b->low[0], middle(b, 0), b->high[0]},
            row[] = {b->low[1], middle(b, 1), b->high[1]};
  return node_of(t, column[k % 3], row[k / 3]);
}

static double place_on(double low, double high, size_t k, size_t count) {
  if (count < 2) return low;
  const double t = (double)k / (double)(count - 1);
  return t < 0.5 ? low + t * (high - low) : high - (1 - t) * (high - low);
}

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
  node[CLEARANCE] = seen.clearance;
  node[SKY] = seen.sky;
  node[BACK] = seen.back;
  node[CUT_OFF] = seen.cut_off;
  memcpy(node + LIGHT, seen.mean, c->bands * sizeof *node);
  memcpy(node + LIGHT + c->bands, seen.flux, 2 * c->bands * sizeof *node);
  memcpy(node + LIGHT + 3 * c->bands, seen.error, c->bands * sizeof *node);
  t->exact++;
  return status;
}

/* The longer of the two parts of a block. */
static double longer_part(const block *b, int k) {
  return b->high[k] - middle(b, k);
}

/* Whether M is smooth in a block but for borders of light, and these are faint. */
static int is_even(const tile *t, const block *b) {
  const grid_call *c = t->call;
  const double *first = support(t, b, 0);
  const double near =
      hypot(longer_part(b, 0) * c->map.step.x, longer_part(b, 1) * c->map.step.y);
  const int dark = first[PLACE] == HR2D_PLACE_OUTSIDE;
  hr2di_map_block on = {.cell = {longer_part(b, 0), longer_part(b, 1)}};
  double least_lit = 1;
  int lit;
  for (int k = 0; k < 9; k++) {
    const double *node = support(t, b, k);
    least_lit = fmin(least_lit, 1 - node[BACK] - (c->f.source.lit_sky ? 0 : node[SKY]));
    if (node[CLEARANCE] < near || node[PLACE] == HR2D_PLACE_PATCH ||
        node[PLACE] != first[PLACE])
      return 0;
  }
  for (int k = 0; k < 2; k++) {
    on.low[k] = (double)(t->at[k] + (size_t)b->low[k]);
    on.high[k] = (double)(t->at[k] + (size_t)b->high[k]);
  }
  if (!(hr2di_border_map_error(&c->map, t->number, &on, &lit) <= KINK)) return 0;
  return !lit || (!dark && least_lit > LEAST_LIT);
}

/* Where the j-th of three nodes is along a block. */
static double part_of(const block *b, int k, int j) {
  return j == 1 ? (double)(middle(b, k) - b->low[k]) / (b->high[k] - b->low[k]) : j / 2.0;
}

/* Item k of the nine nodes minus its interpolation through the corners, the largest. */
static double bend(const tile *t, const block *b, size_t k) {
  double v[3][3], most = 0;
  for (int j = 0; j < 9; j++) v[j / 3][j % 3] = support(t, b, j)[k];
  for (int j = 0; j < 9; j++) {
    const double x = part_of(b, 0, j % 3), y = part_of(b, 1, j / 3);
    const double plain =
        (1 - y) * ((1 - x) * v[0][0] + x * v[0][2]) + y * ((1 - x) * v[2][0] + x * v[2][2]);
    most = fmax(most, fabs(v[j / 3][j % 3] - plain));
  }
  return most;
}

/* What item k may be off by; HUGE_VAL if it is not wanted. */
static double limit_of(const grid_call *c, size_t k) {
  const hr2d_field_values *v = &c->f.values;
  if (k == SKY) return v->sky ? c->grid.tolerance : HUGE_VAL;
  if (k == BACK) return v->back ? c->grid.tolerance : HUGE_VAL;
  if (k == CUT_OFF) return v->cut_off ? c->grid.tolerance : HUGE_VAL;
  if (k < LIGHT + c->bands) return c->range[k - LIGHT];
  if (!v->flux || k >= LIGHT + 3 * c->bands) return HUGE_VAL;
  return HR2DI_PI * c->range[(k - LIGHT - c->bands) / 2];
}

/* The items that have numbers where a block is. */
static size_t items_of(const tile *t, const block *b) {
  return support(t, b, 0)[PLACE] == HR2D_PLACE_OUTSIDE ? LIGHT : t->call->items;
}

static int is_flat(const tile *t, const block *b) {
  for (size_t k = SKY; k < items_of(t, b); k++) {
    const double limit = limit_of(t->call, k);
    if (limit < HUGE_VAL && bend(t, b, k) > BEND * limit) return 0;
  }
  return 1;
}

/* Between which of the three a node lies, and how far. */
typedef struct between {
  int low, high; /* as numbers from the lowest node of the block on */
  double part;
} between;

static between between_of(const block *b, int k, int node) {
  const int m = middle(b, k), low = node < m ? b->low[k] : m, high = node < m ? m : b->high[k];
  return (between){low, high, high > low ? (double)(node - low) / (high - low) : 0};
}

/* Items of a node by interpolation. */
static void interpolate_to(const tile *t, const block *b, int column, int row, double *to) {
  const between x = between_of(b, 0, column), y = between_of(b, 1, row);
  const double *ll = node_of(t, x.low, y.low), *hl = node_of(t, x.high, y.low),
               *lh = node_of(t, x.low, y.high), *hh = node_of(t, x.high, y.high);
  for (size_t k = SKY; k < t->call->items; k++)
    to[k] = (1 - y.part) * ((1 - x.part) * ll[k] + x.part * hl[k]) +
            y.part * ((1 - x.part) * lh[k] + x.part * hh[k]);
}

static void interpolate(tile *t, const block *b, int column, int row) {
  double *node = node_of(t, column, row);
  if (node[KNOWN] != 0) return;
  interpolate_to(t, b, column, row, node);
  node[PLACE] = support(t, b, 0)[PLACE];
  node[KNOWN] = -1;
}

/* Looks from a node between two of the nine: *fits says whether it is as it would be
   interpolated. */
static hr2d_status probe_at(tile *t, const block *b, int column, int row, int *fits) {
  double *to = t->probe;
  const hr2d_status status = look(t, column, row);
  const double *node = node_of(t, column, row);
  interpolate_to(t, b, column, row, to);
  *fits = node[PLACE] == support(t, b, 0)[PLACE];
  for (size_t k = SKY; k < items_of(t, b) && *fits; k++) {
    const double limit = limit_of(t->call, k);
    *fits = !(limit < HUGE_VAL) || fabs(node[k] - to[k]) <= PROBE * limit;
  }
  return status;
}

/* Along both lines through the middle. */
static hr2d_status probe(tile *t, const block *b, int *fits) {
  const int x = middle(b, 0), y = middle(b, 1);
  hr2d_status status = probe_at(t, b, x + (b->high[0] - x) / 2, y, fits);
  if (!status && *fits) status = probe_at(t, b, x, y + (b->high[1] - y) / 2, fits);
  return status;
}

static int is_done(const block *b) {
  return b->high[0] - b->low[0] <= 2 && b->high[1] - b->low[1] <= 2;
}

/* The parts of a block along one side: one if it is short. */
static int split(const block *b, int k, int part[2][2]) {
  const int m = b->high[k] - b->low[k] > 2 ? middle(b, k) : b->high[k];
  part[0][0] = b->low[k];
  part[0][1] = part[1][0] = m;
  part[1][1] = b->high[k];
  return m < b->high[k] ? 2 : 1;
}

/* The nodes of a block, by interpolation or in four blocks. */
static hr2d_status fill(tile *t, const block *whole) {
  block stack[32];
  int count = 0;
  hr2d_status status = HR2D_OK;
  stack[count++] = *whole;
  while (count > 0 && !status) {
    const block b = stack[--count];
    for (int j = 0; j < 9 && !status; j++) {
      const int column[] = {b.low[0], middle(&b, 0), b.high[0]},
                row[] = {b.low[1], middle(&b, 1), b.high[1]};
      status = look(t, column[j % 3], row[j / 3]);
    }
    if (status || is_done(&b)) continue;
    int fits = is_even(t, &b) && is_flat(t, &b);
    if (fits) status = probe(t, &b, &fits);
    if (fits) {
      for (int row = b.low[1]; row <= b.high[1]; row++)
        for (int column = b.low[0]; column <= b.high[0]; column++)
          interpolate(t, &b, column, row);
      continue;
    }
    int x[2][2], y[2][2];
    const int columns = split(&b, 0, x), rows = split(&b, 1, y);
    for (int j = 0; j < columns * rows; j++)
      stack[count++] = (block){{x[j % columns][0], y[j / columns][0]},
                               {x[j % columns][1], y[j / columns][1]}};
  }
  return status;
}

/* The nodes of a tile that are its own. */
static void keep(tile *t) {
  const grid_call *c = t->call;
  for (int row = t->own_low[1]; row <= t->own_high[1]; row++)
    for (int column = t->own_low[0]; column <= t->own_high[0]; column++) {
      const double *node = node_of(t, column, row);
      const hr2di_field_look_at seen = {.mean = node + LIGHT,
                                        .flux = node + LIGHT + c->bands,
                                        .error = node + LIGHT + 3 * c->bands,
                                        .sky = node[SKY],
                                        .back = node[BACK],
                                        .cut_off = node[CUT_OFF],
                                        .place = (hr2d_place)node[PLACE]};
      hr2di_field_keep(&c->f.values,
                       (t->at[1] + (size_t)row) * c->grid.columns + t->at[0] + (size_t)column,
                       c->bands, &seen);
      t->interpolated += node[KNOWN] < 0;
    }
}

static size_t samples(size_t nodes) {
  return (nodes + TILE - 1) / TILE;
}

/* Along a side with so many nodes; tile `number` of so many. */
static void set_side(tile *t, int k, size_t number, size_t tiles, size_t nodes) {
  const size_t left = nodes - number * TILE; /* nodes from the one before the block on */
  const int last = number + 1 == tiles;
  t->at[k] = number * TILE;
  t->own_low[k] = number == 0 ? 0 : 2;
  t->own_high[k] = last ? (int)left - 1 : TILE + 1;
  t->size[k] = last ? (int)left - 2 : TILE + 1;
}

static tile tile_of(grid_call *c, hr2di_field_worker *w, size_t task) {
  tile t = {
      .call = c, .worker = w, .number = task, .probe = w->room + HR2DI_FIELD_ROOM * c->bands};
  t.node = t.probe + c->each;
  set_side(&t, 0, task % c->map.tiles[0], c->map.tiles[0], c->grid.columns);
  set_side(&t, 1, task / c->map.tiles[0], c->map.tiles[1], c->grid.rows);
  for (size_t k = 0; k < SIDE * SIDE; k++) t.node[k * c->each + KNOWN] = 0;
  return t;
}

/* M at each 16th node of each 16th row. */
static hr2d_status do_first(void *ctx, hr2di_field_worker *w, size_t task) {
  grid_call *c = ctx;
  const size_t along = samples(c->grid.columns);
  const hr2d_point at = point_of(c, task % along * TILE, task / along * TILE);
  hr2di_field_look_at seen;
  const hr2d_status status =
      hr2di_field_look(w, &c->f.source, hr2di_field_scaled(c->f.source.scene, at), &seen);
  memcpy(c->first + task * c->bands, seen.mean, c->bands * sizeof *c->first);
  atomic_fetch_add(&c->exact, 1);
  return status;
}

static hr2d_status do_tile(void *ctx, hr2di_field_worker *w, size_t task) {
  grid_call *c = ctx;
  tile t = tile_of(c, w, task);
  const block all = {{1, 1}, {t.size[0], t.size[1]}};
  hr2d_status status = HR2D_OK;
  if (c->coarse && !c->borders.many && !c->map.crowded[task]) status = fill(&t, &all);
  for (int row = t.own_low[1]; row <= t.own_high[1] && !status; row++)
    for (int column = t.own_low[0]; column <= t.own_high[0] && !status; column++)
      if (node_of(&t, column, row)[KNOWN] == 0) status = look(&t, column, row);
  if (!status) keep(&t);
  atomic_fetch_add(&c->exact, t.exact);
  atomic_fetch_add(&c->interpolated, t.interpolated);
  return status;
}

static void find_range(grid_call *c) {
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
static hr2d_status find_borders(grid_call *c) {
  const hr2d_field_values *v = &c->f.values;
  const size_t tiles = c->map.tiles[0] * c->map.tiles[1],
               most = tiles < FEW_BORDERS / BORDERS ? FEW_BORDERS : BORDERS * tiles;
  const hr2di_border_scale scale = {c->range, v->sky || v->back ? c->grid.tolerance : HUGE_VAL};
  const hr2d_status status =
      hr2di_borders_find(&c->borders, &c->f.source, &scale, most, &c->f.watch);
  return status || c->borders.many
             ? status
             : hr2di_border_map_init(&c->map, &c->borders, &c->f.source.scene->alloc,
                                     &c->f.watch);
}

/* Whether a sun shines on nodes past the ends of a period, behind which borders of its light
   are not found: the corners are farthest from the patches. */
static int sees_far_suns(const grid_call *c) {
  const hr2d_scene *scene = c->f.source.scene;
  for (int k = 0; k < 4; k++) {
    const hr2d_point corner = {k % 2 ? c->grid.high.x : c->grid.low.x,
                               k / 2 ? c->grid.high.y : c->grid.low.y};
    if (hr2di_far_sees_suns(scene, hr2di_field_scaled(scene, corner))) return 1;
  }
  return 0;
}

/* Gets ready for interpolation, unless there are so many ends that it would not pay. */
static hr2d_status prepare(grid_call *c, uint64_t *steps) {
  hr2di_light_source *of = &c->f.source;
  hr2di_field_team *team = &c->f.team;
  team->run = do_first;
  hr2d_status status =
      hr2di_field_team_run(team, samples(c->grid.columns) * samples(c->grid.rows), steps);
  if (status) return status;
  find_range(c);
  status = hr2di_light_source_relax(of, c->view, &c->f.watch);
  if (!status) status = hr2di_leaves_group(&of->leaves, of->solution, c->view, &c->f.watch);
  c->coarse = !status && c->grid.columns > 4 && c->grid.rows > 4 && c->map.step.x != 0 &&
              c->map.step.y != 0 &&
              hr2di_borders_sources(of) <= c->grid.columns * c->grid.rows / SOURCES &&
              !sees_far_suns(c);
  return c->coarse ? find_borders(c) : status;
}

static hr2d_status run(grid_call *c, uint64_t *steps) {
  const hr2d_allocator *alloc = &c->f.source.scene->alloc;
  const size_t count = samples(c->grid.columns) * samples(c->grid.rows);
  hr2di_field_team *team = &c->f.team;
  hr2d_status status = HR2D_OK;
  team->ctx = c;
  team->needs = HR2DI_FIELD_ROOM * c->bands + (1 + SIDE * SIDE) * c->each;
  c->first = hr2di_alloc(alloc, count, c->bands * sizeof *c->first);
  c->range = hr2di_alloc(alloc, c->bands, sizeof *c->range);
  c->view = hr2di_alloc(alloc, c->bands, sizeof *c->view);
  if (!c->first || !c->range || !c->view) status = HR2D_ENOMEM;
  if (!status && c->grid.tolerance > 0) status = prepare(c, steps);
  team->run = do_tile;
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
  return nodes > 3 ? (nodes - 3 + TILE - 1) / TILE : 1;
}

static double step_of(double low, double high, size_t nodes) {
  return nodes > 1 ? high / (double)(nodes - 1) - low / (double)(nodes - 1) : 0;
}

static void set_map(grid_call *c, const hr2d_scene *scene) {
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
  grid_call c = {.grid = HR2D_FIELD_GRID_INIT, .bands = solution->bands};
  uint64_t steps = 0;
  hr2d_status status = hr2di_sized_copy(&c.grid, sizeof c.grid, grid);
  if (status || !is_valid(&c.grid)) return HR2D_EINVAL;
  c.each = LIGHT + 4 * c.bands;
  status = hr2di_field_open(&c.f, solution, options, values);
  set_map(&c, &c.f.scene.scene);
  c.items = c.f.values.flux || c.f.values.error ? c.each : LIGHT + c.bands;
  if (!status) status = run(&c, &steps);
  hr2di_field_close(&c.f);
  if (!status && counts)
    *counts = (hr2d_field_counts){atomic_load(&c.exact), atomic_load(&c.interpolated), steps};
  return status;
}
