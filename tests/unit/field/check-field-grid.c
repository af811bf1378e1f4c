/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field on grids: exact, and interpolated within its tolerance at every node. */
#include <math.h>
#include <stdlib.h>

#include "support/field-stage.h"
#include "support/grid-plans.h"
#include "support/support.h"

/* A grid with all values of one band. */
typedef struct sheet {
  hr2d_field_grid grid;
  hr2d_field_counts counts;
  size_t nodes;
  double *mean, *flux, *sky, *back;
  unsigned char *place;
} sheet;

static sheet new_sheet(hr2d_field_grid grid) {
  sheet s = {.grid = grid, .nodes = grid.columns * grid.rows};
  s.mean = malloc(s.nodes * sizeof *s.mean);
  s.flux = malloc(2 * s.nodes * sizeof *s.flux);
  s.sky = malloc(s.nodes * sizeof *s.sky);
  s.back = malloc(s.nodes * sizeof *s.back);
  s.place = malloc(s.nodes);
  ck_assert(s.mean && s.flux && s.sky && s.back && s.place);
  return s;
}

static void free_sheet(sheet *s) {
  free(s->mean);
  free(s->flux);
  free(s->sky);
  free(s->back);
  free(s->place);
}

static hr2d_field_values values_of(sheet *s) {
  return (hr2d_field_values){.struct_size = sizeof(hr2d_field_values),
                             .mean = s->mean,
                             .flux = s->flux,
                             .sky = s->sky,
                             .back = s->back,
                             .place = s->place};
}

static sheet draw_sheet(const hr2d_solution *solution, hr2d_field_grid grid, unsigned threads) {
  sheet s = new_sheet(grid);
  const hr2d_field_values values = values_of(&s);
  hr2d_field_options o = HR2D_FIELD_OPTIONS_INIT;
  o.threads = threads;
  ck_assert_int_eq(hr2d_field_on_grid(solution, &grid, &o, &values, &s.counts), HR2D_OK);
  return s;
}

/* The nodes as points. */
static sheet by_points(const hr2d_solution *solution, hr2d_field_grid grid) {
  sheet s = new_sheet(grid);
  const hr2d_field_values values = values_of(&s);
  hr2d_point *at = malloc(s.nodes * sizeof *at);
  ck_assert_ptr_nonnull(at);
  for (size_t k = 0; k < s.nodes; k++) {
    const double u = (double)(k % grid.columns) / (double)(grid.columns - 1),
                 v = (double)(k / grid.columns) / (double)(grid.rows - 1);
    at[k].x = grid.low.x + u * (grid.high.x - grid.low.x);
    at[k].y = grid.low.y + v * (grid.high.y - grid.low.y);
  }
  ck_assert_int_eq(hr2d_field_at(solution, at, s.nodes, NULL, &values), HR2D_OK);
  free(at);
  return s;
}

typedef struct gap {
  double mean, flux, share;
  size_t places; /* that differ */
} gap;

static gap compare(const sheet *one, const sheet *other) {
  gap g = {0};
  for (size_t k = 0; k < one->nodes; k++) {
    g.places += one->place[k] != other->place[k];
    g.share = fmax(
        g.share, fmax(fabs(one->sky[k] - other->sky[k]), fabs(one->back[k] - other->back[k])));
    if (one->place[k] == HR2D_PLACE_OUTSIDE || other->place[k] == HR2D_PLACE_OUTSIDE) continue;
    g.mean = fmax(g.mean, fabs(one->mean[k] - other->mean[k]));
    for (size_t c = 2 * k; c < 2 * k + 2; c++)
      g.flux = fmax(g.flux, fabs(one->flux[c] - other->flux[c]));
  }
  return g;
}

/* Of M on each 16th node of each 16th row. */
static double range_of(const sheet *s) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (size_t row = 0; row < s->grid.rows; row += 16)
    for (size_t k = 0; k < s->grid.columns; k += 16) {
      low = fmin(low, s->mean[row * s->grid.columns + k]);
      high = fmax(high, s->mean[row * s->grid.columns + k]);
    }
  return fmax(high - low, 1e-6 * high);
}

static hr2d_field_grid around(const field_stage *s, size_t columns, size_t rows) {
  hr2d_field_grid g = HR2D_FIELD_GRID_INIT;
  g.low = g.high = (hr2d_point){s->at[0][0], s->at[0][1]};
  for (size_t k = 0; k < s->all.count; k++)
    for (int c = 0; c < 4; c += 2) {
      g.low.x = fmin(g.low.x, s->at[k][c]);
      g.low.y = fmin(g.low.y, s->at[k][c + 1]);
      g.high.x = fmax(g.high.x, s->at[k][c]);
      g.high.y = fmax(g.high.y, s->at[k][c + 1]);
    }
  g.columns = columns;
  g.rows = rows;
  return g;
}

static field_stage draw_stage(randoms *r, int kind) {
  plan p = {0};
  const test_paint paint = {
      .r = r, .emission = 1, .reflectance = 0.7, .background = kind % 3 == 1};
  if (kind < plan_class_count)
    plan_classes[kind].draw(r, 8, &p);
  else
    p = grid_plan(r, kind % 2);
  hr2d_scene *scene = test_painted_scene(&p, &paint);
  plan_free(&p);
  return kind % 2 ? field_stage_of(scene, 0.5, 1 + (unsigned)kind % 4)
                  : field_stage_of(scene, 0.25, 4);
}

/* Every node is within the tolerance, and most of them are interpolated on fine grids. */
START_TEST(tolerances_are_met) {
  randoms r = randoms_stream(test_seed(), _i);
  for (int turn = test_count(3); turn > 0; turn--) {
    field_stage s = draw_stage(&r, _i);
    hr2d_field_grid grid = around(&s, 60 + (size_t)random_below(&r, (int)test_some(200, 1)),
                                  40 + (size_t)random_below(&r, (int)test_some(100, 1)));
    const double lean = random_between(&r, 0, 0.01) * (grid.high.x - grid.low.x);
    grid.low.x += lean;
    grid.low.y += lean / 2;
    sheet exact = by_points(s.solution, grid);
    for (int t = 1; t < 4; t++) {
      grid.tolerance = pow(10, -t);
      sheet some = draw_sheet(s.solution, grid, 2);
      const gap g = compare(&some, &exact);
      const double allowed = grid.tolerance * range_of(&exact);
      if (getenv("HR2D_TEST_VERBOSE"))
        fprintf(stderr, "%2d %5.0e: %.2f %.2f %.2f of the tolerance, %.2f of nodes\n", _i,
                grid.tolerance, g.mean / allowed, g.flux / allowed / 3.1416,
                g.share / grid.tolerance,
                (double)some.counts.interpolated / (double)some.nodes);
      ck_assert_uint_eq(g.places, 0);
      ck_assert_double_le(g.mean, allowed);
      ck_assert_double_le(g.flux, 3.1416 * allowed);
      ck_assert_double_le(g.share, grid.tolerance);
      free_sheet(&some);
    }
    free_sheet(&exact);
    field_stage_clear(&s);
  }
}
END_TEST

/* A black room of two halves, and a lamp in the left half that shines through a slit: on the
   right the light is a strip that is much narrower than blocks are. */
static field_stage draw_slit(randoms *r) {
  const double y = random_between(r, 0.2, 0.8), wide = pow(10, random_between(r, -4, -2)),
               lamp = random_between(r, 0.1, 0.8), high = pow(10, random_between(r, -3, -1));
  return field_stage_flat(test_scene((const double[][6]){{0, 0, 1, 0, 0, 0},
                                                         {1, 0, 2, 0, 0, 0},
                                                         {2, 0, 2, 1, 0, 0},
                                                         {2, 1, 1, 1, 0, 0},
                                                         {1, 1, 0, 1, 0, 0},
                                                         {0, 1, 0, lamp + high, 0, 0},
                                                         {0, lamp + high, 0, lamp, 1, 0},
                                                         {0, lamp, 0, 0, 0, 0},
                                                         {1, 0, 1, y, 0, 0},
                                                         {1, y, 1, 0, 0, 0},
                                                         {1, y + wide, 1, 1, 0, 0},
                                                         {1, 1, 1, y + wide, 0, 0}},
                                     12));
}

/* Those of the half with the strip where there is more light than this. */
static size_t lit_nodes(const sheet *s, double min) {
  size_t count = 0;
  for (size_t k = 0; k < s->nodes; k++)
    count += k % s->grid.columns > s->grid.columns / 2 && s->mean[k] > min;
  return count;
}

/* No strip of light is missed between views. */
START_TEST(strips_behind_slits) {
  randoms r = randoms_stream(test_seed(), 500);
  size_t lit = 0, interpolated = 0;
  for (int turn = test_count(40); turn > 0; turn--) {
    field_stage s = draw_slit(&r);
    hr2d_field_grid grid = around(&s, 203, 99);
    sheet exact = by_points(s.solution, grid);
    grid.tolerance = 1e-4;
    sheet some = draw_sheet(s.solution, grid, 1);
    const gap g = compare(&some, &exact);
    const double allowed = grid.tolerance * range_of(&exact);
    ck_assert_uint_eq(g.places, 0);
    ck_assert_double_le(g.mean, allowed);
    lit += lit_nodes(&exact, 3 * allowed);
    interpolated += some.counts.interpolated;
    free_sheet(&exact);
    free_sheet(&some);
    field_stage_clear(&s);
  }
  /* Negative controls: there are such strips, and nodes that were interpolated. */
  ck_assert_uint_gt(lit, 0);
  ck_assert_uint_gt(interpolated, 0);
}
END_TEST

/* The paper's constants on thousands of leaves: elements take their place, whose views are off
   by no more than an eighth of the tolerance.  Of so few columns none is interpolated. */
START_TEST(staircases) {
  randoms r = randoms_stream(test_seed(), 100 + _i);
  plan p = {0};
  plan_classes[_i].draw(&r, 8, &p);
  const test_paint paint = {.r = &r, .emission = 1, .reflectance = 0.7};
  field_stage s = field_stage_of(test_painted_scene(&p, &paint), 0.1, 1);
  plan_free(&p);
  for (int k = 0; k < 3; k++) {
    hr2d_field_grid grid = around(&s, 4, 65);
    grid.tolerance = (const double[]){.1, 1e-2, 1e-3}[k];
    sheet is = draw_sheet(s.solution, grid, 1), right = by_points(s.solution, grid);
    const gap g = compare(&is, &right);
    const double range = range_of(&right), max = grid.tolerance / 8 * range;
    ck_assert_uint_eq(g.places, 0);
    ck_assert_uint_eq(is.counts.interpolated, 0);
    if (!(range > 0)) continue; /* sampled outside */
    ck_assert_msg(g.mean <= max && g.flux <= 3.15 * max, "%g: off by %g, flux by %g of %g",
                  grid.tolerance, g.mean, g.flux, max);
    if (getenv("HR2D_TEST_VERBOSE"))
      fprintf(stderr, "%d %g: %.2g of what is allowed\n", _i, grid.tolerance, g.mean / max);
    if (grid.tolerance > 1e-2) ck_assert_double_gt(g.mean, 0); /* they are not the leaves */
    free_sheet(&is);
    free_sheet(&right);
  }
  field_stage_clear(&s);
}
END_TEST

/* Without a tolerance all nodes are exact; in an empty room few are needed with one. */
START_TEST(exact_and_coarse) {
  field_stage s = field_stage_of(test_scene((const double[][6]){{0, 0, 2, 0, 1, .5},
                                                                {2, 0, 2, 1, 0, .5},
                                                                {2, 1, 0, 1, 0, .5},
                                                                {0, 1, 0, 0, 0, .5}},
                                            4),
                                 0.25, 4);
  hr2d_field_grid grid = around(&s, 201, 101);
  sheet exact = draw_sheet(s.solution, grid, 1), points = by_points(s.solution, grid);
  const gap g = compare(&exact, &points);
  ck_assert_uint_eq(g.places, 0);
  ck_assert_double_le(g.mean, 1e-14);
  ck_assert_uint_eq(exact.counts.exact, 201 * 101);
  ck_assert_uint_eq(exact.counts.interpolated, 0);
  ck_assert_uint_gt(exact.counts.triangles, 0);
  grid.tolerance = 1e-3;
  sheet coarse = draw_sheet(s.solution, grid, 1), again = draw_sheet(s.solution, grid, 3);
  ck_assert_uint_gt(coarse.counts.interpolated, 201 * 101 / 2);
  ck_assert_mem_eq(coarse.mean, again.mean, coarse.nodes * sizeof *coarse.mean);
  ck_assert_mem_eq(coarse.flux, again.flux, 2 * coarse.nodes * sizeof *coarse.flux);
  /* Negative control: something was interpolated. */
  ck_assert_double_gt(compare(&coarse, &points).mean, 1e-9);
  free_sheet(&exact);
  free_sheet(&points);
  free_sheet(&coarse);
  free_sheet(&again);
  field_stage_clear(&s);
}
END_TEST

static hr2d_status stop(void *ctx, const hr2d_progress *p) {
  (void)ctx;
  ck_assert_str_eq(p->phase, "field");
  return HR2D_STOPPED;
}

START_TEST(statuses_of_grids) {
  field_stage s = field_stage_of(
      test_scene((const double[][6]){{0, 0, 2, 0, 1, 0}, {2, 1, 0, 1, 1, 0}}, 2), 0.25, 1);
  hr2d_field_grid grid = HR2D_FIELD_GRID_INIT;
  sheet one = new_sheet((hr2d_field_grid){.columns = 100, .rows = 100});
  const hr2d_field_values values = values_of(&one);
  hr2d_field_options o = HR2D_FIELD_OPTIONS_INIT;
  grid.low = (hr2d_point){1, 0.5};
  grid.high.x = 30;
  ck_assert_int_eq(hr2d_field_on_grid(s.solution, &grid, NULL, &values, NULL), HR2D_OK);
  ck_assert_double_eq_tol(one.mean[0], (1 - 2 * atan(0.5) / acos(-1)), 1e-14);
  grid.columns = grid.rows = 100;
  o.progress = stop;
  ck_assert_int_eq(hr2d_field_on_grid(s.solution, &grid, &o, &values, NULL), HR2D_STOPPED);
  const hr2d_field_grid wrong[] = {{sizeof grid, {0, 0}, {1, 1}, 0, 5, 0},
                                   {sizeof grid, {0, 0}, {1, 1}, 5, 0, 0},
                                   {sizeof grid, {NAN, 0}, {1, 1}, 5, 5, 0},
                                   {sizeof grid, {0, 0}, {1, HUGE_VAL}, 5, 5, 0},
                                   {sizeof grid, {0, 0}, {1, 1}, 5, 5, -1},
                                   {sizeof grid, {0, 0}, {1, 1}, 5, 5, NAN},
                                   {sizeof grid, {0, 0}, {1, 1}, SIZE_MAX / 2, 5, 0},
                                   {1, {0, 0}, {1, 1}, 5, 5, 0}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
    ck_assert_int_eq(hr2d_field_on_grid(s.solution, &wrong[k], NULL, &values, NULL),
                     HR2D_EINVAL);
  free_sheet(&one);
  field_stage_clear(&s);
}
END_TEST

TEST_SUITE("field grid") {
  ADD_TESTS("field grid", exact_and_coarse, strips_behind_slits, statuses_of_grids);
  REPEAT_TESTS(plan_class_count + 4, "field grid", tolerances_are_met);
  REPEAT_TESTS(plan_class_count, "field grid", staircases);
}
