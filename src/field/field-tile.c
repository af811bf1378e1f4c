/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tile is cut into blocks by itself: what a node receives does not depend on threads.

   With a tolerance τ, every view may be off by an eighth of τ.  A block has 3 × 3 nodes with
   views, and is interpolated between them, linearly in x and in y, if
   - the jumps of the slope of M at all borders of light in the block cost at most KINK τ;
   - the nine miss the interpolation of degree 1 through the corners by at most BEND τ: where M
     is smooth, with a second derivative that changes little between nodes, what is between the
     nine is off by half of that in both directions together;
   - no end of what they see is nearer than the next of the nine;
   - one more view on each line through the middle, half way between two of the nine, is as it
     would be interpolated, to PROBE τ.  There the error of a function that turns from bending
     one way to the other is largest, which the nine do not show.
   Else the block is divided in four.  BEND/2 is far enough below 1 − KINK − 1/8. */
#include "field/field-tile.h"

#include <math.h>
#include <string.h>

#include "base/pi.h"

#define KINK  0.25
#define BEND  0.8
#define PROBE 0.4

/* Where a front goes out of sight, blocks whose nodes see fronts, or a sky with light, in less
   than this part of directions are divided: there may be a place that sees none. */
#define LEAST_LIT 0.25

static double place_on(double low, double high, size_t k, size_t count) {
  if (count < 2) return low;
  const double t = (double)k / (double)(count - 1);
  return t < 0.5 ? low + t * (high - low) : high - (1 - t) * (high - low);
}

hr2d_point hr2di_grid_point(const hr2di_grid_call *c, size_t column, size_t row) {
  const hr2d_field_grid *g = &c->grid;
  return (hr2d_point){place_on(g->low.x, g->high.x, column, g->columns),
                      place_on(g->low.y, g->high.y, row, g->rows)};
}

/* One tile of a worker.  Its own nodes are those of its block but the first column and row,
   with what is before the first tiles and after the last ones. */
typedef struct tile {
  hr2di_grid_call *call;
  hr2di_field_worker *worker;
  size_t number;
  double *probe; /* items of one node */
  double *node;  /* HR2DI_TILE_SIDE × HR2DI_TILE_SIDE, the block from (1, 1) on */
  size_t at[2];  /* the node before the block */
  int own_low[2], own_high[2], size[2]; /* counted from there; the last of the block */
  uint64_t exact, interpolated;
} tile;

/* A block of nodes of a tile. */
typedef struct block {
  int low[2], high[2];
} block;

static double *node_of(const tile *t, int column, int row) {
  return t->node + (size_t)(row * HR2DI_TILE_SIDE + column) * t->call->each;
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

/* Node (column,row) of the grid. */
static hr2d_point place_of(const tile *t, int column, int row) {
  const hr2di_grid_call *c = t->call;
  return hr2di_field_scaled(c->f.source.scene, hr2di_grid_point(c, t->at[0] + (size_t)column,
                                                                t->at[1] + (size_t)row));
}

static hr2d_status evaluate(tile *t, int column, int row) {
  const hr2di_grid_call *c = t->call;
  double *node = node_of(t, column, row);
  hr2di_field_look_at seen;
  if (node[HR2DI_NODE_KNOWN] > 0) return HR2D_OK;
  const hr2d_status status =
      hr2di_field_look(t->worker, &c->f.source, place_of(t, column, row), &seen);
  node[HR2DI_NODE_KNOWN] = 1;
  node[HR2DI_NODE_PLACE] = seen.place;
  node[HR2DI_NODE_CLEARANCE] = seen.clearance;
  node[HR2DI_NODE_SKY] = seen.sky;
  node[HR2DI_NODE_BACK] = seen.back;
  node[HR2DI_NODE_CUT_OFF] = seen.cut_off;
  memcpy(node + HR2DI_NODE_LIGHT, seen.mean, c->bands * sizeof *node);
  memcpy(node + HR2DI_NODE_LIGHT + c->bands, seen.flux, 2 * c->bands * sizeof *node);
  memcpy(node + HR2DI_NODE_LIGHT + 3 * c->bands, seen.error, c->bands * sizeof *node);
  t->exact++;
  return status;
}

/* The longer of the two parts of a block. */
static double longer_part(const block *b, int k) {
  return b->high[k] - middle(b, k);
}

/* Whether M is smooth in a block but for borders of light, and these are faint. */
static int is_even(const tile *t, const block *b) {
  const hr2di_grid_call *c = t->call;
  const double *first = support(t, b, 0);
  const double near =
      hypot(longer_part(b, 0) * c->map.step.x, longer_part(b, 1) * c->map.step.y);
  const int dark = first[HR2DI_NODE_PLACE] == HR2D_PLACE_OUTSIDE;
  hr2di_map_block on = {.cell = {longer_part(b, 0), longer_part(b, 1)}};
  double min_lit = 1;
  int lit;
  for (int k = 0; k < 9; k++) {
    const double *node = support(t, b, k);
    min_lit = fmin(min_lit, 1 - node[HR2DI_NODE_BACK] -
                                (c->f.source.lit_sky ? 0 : node[HR2DI_NODE_SKY]));
    if (node[HR2DI_NODE_CLEARANCE] < near || node[HR2DI_NODE_PLACE] == HR2D_PLACE_PATCH ||
        node[HR2DI_NODE_PLACE] != first[HR2DI_NODE_PLACE])
      return 0;
  }
  for (int k = 0; k < 2; k++) {
    on.low[k] = (double)(t->at[k] + (size_t)b->low[k]);
    on.high[k] = (double)(t->at[k] + (size_t)b->high[k]);
  }
  if (!(hr2di_border_map_error(&c->map, t->number, &on, &lit) <= KINK)) return 0;
  return !lit || (!dark && min_lit > LEAST_LIT);
}

/* Where the j-th of three nodes is along a block. */
static double part_of(const block *b, int k, int j) {
  return j == 1 ? (double)(middle(b, k) - b->low[k]) / (b->high[k] - b->low[k]) : j / 2.0;
}

/* Item k of the nine nodes minus its interpolation through the corners, the largest. */
static double bend(const tile *t, const block *b, size_t k) {
  double v[3][3], max = 0;
  for (int j = 0; j < 9; j++) v[j / 3][j % 3] = support(t, b, j)[k];
  for (int j = 0; j < 9; j++) {
    const double x = part_of(b, 0, j % 3), y = part_of(b, 1, j / 3);
    const double plain =
        (1 - y) * ((1 - x) * v[0][0] + x * v[0][2]) + y * ((1 - x) * v[2][0] + x * v[2][2]);
    max = fmax(max, fabs(v[j / 3][j % 3] - plain));
  }
  return max;
}

/* What item k may be off by; HUGE_VAL if it is not wanted. */
static double limit_of(const hr2di_grid_call *c, size_t k) {
  const hr2d_field_values *v = &c->f.values;
  if (k == HR2DI_NODE_SKY) return v->sky ? c->grid.tolerance : HUGE_VAL;
  if (k == HR2DI_NODE_BACK) return v->back ? c->grid.tolerance : HUGE_VAL;
  if (k == HR2DI_NODE_CUT_OFF) return v->cut_off ? c->grid.tolerance : HUGE_VAL;
  if (k < HR2DI_NODE_LIGHT + c->bands) return c->range[k - HR2DI_NODE_LIGHT];
  if (!v->flux || k >= HR2DI_NODE_LIGHT + 3 * c->bands) return HUGE_VAL;
  return HR2DI_PI * c->range[(k - HR2DI_NODE_LIGHT - c->bands) / 2];
}

/* The items that have numbers where a block is. */
static size_t items_of(const tile *t, const block *b) {
  return support(t, b, 0)[HR2DI_NODE_PLACE] == HR2D_PLACE_OUTSIDE ? HR2DI_NODE_LIGHT
                                                                  : t->call->items;
}

static int is_flat(const tile *t, const block *b) {
  for (size_t k = HR2DI_NODE_SKY; k < items_of(t, b); k++) {
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
  for (size_t k = HR2DI_NODE_SKY; k < t->call->items; k++)
    to[k] = (1 - y.part) * ((1 - x.part) * ll[k] + x.part * hl[k]) +
            y.part * ((1 - x.part) * lh[k] + x.part * hh[k]);
}

static void interpolate(tile *t, const block *b, int column, int row) {
  double *node = node_of(t, column, row);
  if (node[HR2DI_NODE_KNOWN] != 0) return;
  interpolate_to(t, b, column, row, node);
  node[HR2DI_NODE_PLACE] = support(t, b, 0)[HR2DI_NODE_PLACE];
  node[HR2DI_NODE_KNOWN] = -1;
}

/* Looks from a node between two of the nine: *fits says whether it is as it would be
   interpolated. */
static hr2d_status probe_at(tile *t, const block *b, int column, int row, int *fits) {
  double *to = t->probe;
  const hr2d_status status = evaluate(t, column, row);
  const double *node = node_of(t, column, row);
  interpolate_to(t, b, column, row, to);
  *fits = node[HR2DI_NODE_PLACE] == support(t, b, 0)[HR2DI_NODE_PLACE];
  for (size_t k = HR2DI_NODE_SKY; k < items_of(t, b) && *fits; k++) {
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
      status = evaluate(t, column[j % 3], row[j / 3]);
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
static hr2d_status keep(tile *t) {
  const hr2di_grid_call *c = t->call;
  hr2d_status status = HR2D_OK;
  for (int row = t->own_low[1]; row <= t->own_high[1] && !status; row++)
    for (int column = t->own_low[0]; column <= t->own_high[0] && !status; column++) {
      const size_t k = (t->at[1] + (size_t)row) * c->grid.columns + t->at[0] + (size_t)column;
      const double *node = node_of(t, column, row);
      const hr2di_field_look_at seen = {.mean = node + HR2DI_NODE_LIGHT,
                                        .flux = node + HR2DI_NODE_LIGHT + c->bands,
                                        .error = node + HR2DI_NODE_LIGHT + 3 * c->bands,
                                        .sky = node[HR2DI_NODE_SKY],
                                        .back = node[HR2DI_NODE_BACK],
                                        .cut_off = node[HR2DI_NODE_CUT_OFF],
                                        .place = (hr2d_place)node[HR2DI_NODE_PLACE]};
      hr2di_field_keep(&c->f.values, k, c->bands, &seen);
      status =
          hr2di_field_irradiance(t->worker, &c->f, place_of(t, column, row), seen.place, k);
      t->interpolated += node[HR2DI_NODE_KNOWN] < 0;
    }
  return status;
}

/* Along a side with so many nodes; tile `number` of so many. */
static void set_side(tile *t, int k, size_t number, size_t tiles, size_t nodes) {
  const size_t left = nodes - number * HR2DI_TILE; /* nodes from the one before the block on */
  const int last = number + 1 == tiles;
  t->at[k] = number * HR2DI_TILE;
  t->own_low[k] = number == 0 ? 0 : 2;
  t->own_high[k] = last ? (int)left - 1 : HR2DI_TILE + 1;
  t->size[k] = last ? (int)left - 2 : HR2DI_TILE + 1;
}

static tile tile_of(hr2di_grid_call *c, hr2di_field_worker *w, size_t task) {
  tile t = {
      .call = c, .worker = w, .number = task, .probe = w->room + HR2DI_FIELD_ROOM * c->bands};
  t.node = t.probe + c->each;
  set_side(&t, 0, task % c->map.tiles[0], c->map.tiles[0], c->grid.columns);
  set_side(&t, 1, task / c->map.tiles[0], c->map.tiles[1], c->grid.rows);
  for (size_t k = 0; k < HR2DI_TILE_SIDE * HR2DI_TILE_SIDE; k++)
    t.node[k * c->each + HR2DI_NODE_KNOWN] = 0;
  return t;
}

hr2d_status hr2di_grid_tile(void *ctx, hr2di_field_worker *w, size_t task) {
  hr2di_grid_call *c = ctx;
  tile t = tile_of(c, w, task);
  const block all = {{1, 1}, {t.size[0], t.size[1]}};
  hr2d_status status = HR2D_OK;
  if (c->coarse && !c->borders.many && !c->map.crowded[task]) status = fill(&t, &all);
  for (int row = t.own_low[1]; row <= t.own_high[1] && !status; row++)
    for (int column = t.own_low[0]; column <= t.own_high[0] && !status; column++)
      if (node_of(&t, column, row)[HR2DI_NODE_KNOWN] == 0) status = evaluate(&t, column, row);
  if (!status) status = keep(&t);
  atomic_fetch_add(&c->exact, t.exact);
  atomic_fetch_add(&c->interpolated, t.interpolated);
  return status;
}
