/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support/room-plans.h"

double test_multiplier(void) {
  const char *set = getenv("HR2D_TEST_MULTIPLIER");
  return set ? strtod(set, NULL) : 1;
}

unsigned long test_seed(void) {
  const char *set = getenv("HR2D_TEST_SEED");
  return set ? strtoul(set, NULL, 0) : 20240229;
}

double test_random(unsigned long *state) {
  uint64_t z = *state += (unsigned long)0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

hr2d_scene *test_scene(const double (*patch)[6], size_t count) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < count; k++) {
    const double *p = patch[k];
    const hr2d_patch added = {.a = {p[0], p[1]},
                              .b = {p[2], p[3]},
                              .emission = &p[4],
                              .emission_bands = 1,
                              .reflectance = &p[5],
                              .reflectance_bands = 1};
    ck_assert_msg(hr2d_scene_add(scene, &added, NULL) == HR2D_OK, "%s",
                  hr2d_scene_message(scene));
  }
  ck_assert_msg(hr2d_scene_commit(scene) == HR2D_OK, "%s", hr2d_scene_message(scene));
  return scene;
}

hr2d_scene *test_named_scene(const char *name) {
  double d, rho;
  if (sscanf(name, "par_d%lf_rho%lf", &d, &rho) == 2)
    return test_scene((const double[][6]){{0, 0, 1, 0, 1, rho}, {1, d, 0, d, 0, rho}}, 2);
  if (sscanf(name, "par%lf", &d) == 1)
    return test_scene((const double[][6]){{0, 0, 1, 0, 1, .5}, {1, d, 0, d, 0, .5}}, 2);
  if (sscanf(name, "orth_touch_rho%lf", &rho) == 1)
    return test_scene((const double[][6]){{0, 0, 1, 0, 1, rho}, {0, 1, 0, 0, 0, rho}}, 2);
  if (sscanf(name, "orth%lf", &d) == 1)
    return test_scene((const double[][6]){{d, 0, 1 + d, 0, 1, .5}, {0, 1 + d, 0, d, 0, .5}}, 2);
  double inner;
  if (sscanf(name, "occ_square_walls%lf_occ%lf", &rho, &inner) == 2)
    return test_scene((const double[][6]){{0, 0, 1, 0, 1, rho},
                                          {1, 0, 1, 1, 0, rho},
                                          {1, 1, 0, 1, 0, rho},
                                          {0, 1, 0, 0, 0, rho},
                                          {.3, .5, .7, .5, 0, inner},
                                          {.7, .5, .3, .5, 0, inner}},
                      6);
  if (sscanf(name, "square_rho%lf", &rho) == 1)
    return test_scene((const double[][6]){{0, 0, 1, 0, 1, rho},
                                          {1, 0, 1, 1, 0, rho},
                                          {1, 1, 0, 1, 0, rho},
                                          {0, 1, 0, 0, 0, rho}},
                      4);
  if (sscanf(name, "square_furnace_rho%lf", &rho) == 1) {
    const double e = 1 - rho;
    return test_scene((const double[][6]){{0, 0, 1, 0, e, rho},
                                          {1, 0, 1, 1, e, rho},
                                          {1, 1, 0, 1, e, rho},
                                          {0, 1, 0, 0, e, rho}},
                      4);
  }
  ck_abort_msg("no scene is called %s", name);
  return NULL;
}

static hr2d_status add_painted(hr2d_scene *scene, hr2d_segment at, hr2d_sides sides,
                               const test_paint *paint) {
  const double rho = paint->reflectance * (paint->r ? random_unit(paint->r) : 1);
  const double e = paint->emission * (paint->r ? random_unit(paint->r) : 1);
  const double emission = paint->isothermal ? 1 - rho : e;
  const hr2d_patch patch = {.a = at.a,
                            .b = at.b,
                            .emission = &emission,
                            .emission_bands = 1,
                            .reflectance = &rho,
                            .reflectance_bands = 1,
                            .sides = sides};
  return hr2d_scene_add(scene, &patch, NULL);
}

hr2d_scene *test_painted_scene(const struct plan *room, const test_paint *paint) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < room->walls; k++)
    ck_assert_int_eq(add_painted(scene, room->wall[k], room->sides[k], paint), HR2D_OK);
  if (room->crossing) ck_assert_int_eq(hr2d_scene_split_crossings(scene, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &paint->background, 1), HR2D_OK);
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++)
    if (paint->forced & (1u << e))
      ck_assert_int_eq(hr2d_scene_force(scene, (hr2d_effect)e), HR2D_OK);
  ck_assert_msg(hr2d_scene_commit(scene) == HR2D_OK, "%s", hr2d_scene_message(scene));
  return scene;
}

static char *read_reference(const char *file) {
  const char *folder = getenv("HR2D_TEST_DATA");
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder ? folder : "tests/data/reference", file);
  FILE *in = fopen(path, "rb");
  ck_assert_msg(in != NULL, "cannot open %s", path);
  fseek(in, 0, SEEK_END);
  const long size = ftell(in);
  rewind(in);
  char *text = calloc((size_t)size + 1, 1);
  ck_assert_uint_eq(fread(text, 1, (size_t)size, in), (size_t)size);
  fclose(in);
  return text;
}

static char **split_line(char *line) {
  size_t cells = 1;
  for (const char *c = line; *c; c++) cells += *c == ',';
  char **cell = calloc(cells + 1, sizeof *cell);
  for (size_t k = 0; k < cells; k++) {
    cell[k] = line;
    line += strcspn(line, ",");
    if (*line) *line++ = '\0';
  }
  return cell;
}

test_table test_read_table(const char *file) {
  test_table table = {.text = read_reference(file)};
  size_t lines = 1;
  for (const char *c = table.text; *c; c++) lines += *c == '\n';
  table.cell = calloc(lines, sizeof *table.cell);
  for (char *line = strtok(table.text, "\r\n"); line; line = strtok(NULL, "\r\n"))
    table.cell[table.rows++] = split_line(line);
  ck_assert_msg(table.rows > 1, "%s has no rows", file);
  return table;
}

void test_free_table(test_table *table) {
  for (size_t k = 0; k < table->rows; k++) free(table->cell[k]);
  free(table->cell);
  free(table->text);
}

const char *test_cell(const test_table *table, size_t row, const char *column) {
  for (size_t k = 0; table->cell[0][k]; k++)
    if (strcmp(table->cell[0][k], column) == 0) return table->cell[row][k];
  ck_abort_msg("no column is called %s", column);
  return NULL;
}

double test_number(const test_table *table, size_t row, const char *column) {
  return strtod(test_cell(table, row, column), NULL);
}

test_links test_make_links(hr2d_scene *scene, const hr2d_oracle *oracle, void *oracle_ctx,
                           const hr2d_policy *policy, void *policy_ctx) {
  test_links t = {.scene = scene};
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &t.hierarchy), HR2D_OK);
  ck_assert_int_eq(
      hr2d_linkset_create(t.hierarchy, oracle, oracle_ctx, policy, policy_ctx, &t.links),
      HR2D_OK);
  return t;
}

void test_free_links(test_links *t) {
  hr2d_linkset_destroy(t->links);
  hr2d_hierarchy_destroy(t->hierarchy);
  hr2d_scene_destroy(t->scene);
}

void test_refine(test_links *t, double epsilon, unsigned max_level) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  options.max_level = max_level;
  ck_assert_msg(hr2d_refine(t->links, &options) == HR2D_OK, "%s",
                hr2d_linkset_message(t->links));
}

hr2d_solution *test_solve(const test_links *t, int closure) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *solution = NULL;
  options.closure = closure;
  ck_assert_msg(hr2d_solve(t->links, &options, &solution) == HR2D_OK, "%s",
                hr2d_linkset_message(t->links));
  return solution;
}

enum { ROW = 5 };

static int by_bits(const void *left, const void *right) {
  return memcmp(left, right, ROW * sizeof(double));
}

double *test_sorted_links(const test_links *t, size_t *count) {
  const hr2d_element *e = hr2d_hierarchy_elements(t->hierarchy);
  const size_t links = (size_t)hr2d_linkset_size(t->links);
  double *row = malloc((links + 1) * ROW * sizeof *row);
  ck_assert_ptr_nonnull(row);
  *count = 0;
  for (size_t k = 0; k < links; k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k);
    const double length = hr2d_scene_unit(t->scene) * e[link.pair.first].length;
    if (link.exchange_area <= 1e-25 * length) continue;
    const double all[ROW] = {e[link.pair.first].centre.x, e[link.pair.first].centre.y,
                             e[link.pair.second].centre.x, e[link.pair.second].centre.y,
                             link.exchange_area};
    memcpy(row + ROW * (*count)++, all, sizeof all);
  }
  qsort(row, *count, ROW * sizeof *row, by_bits);
  return row;
}

void test_same_links(const test_links *one, const test_links *other) {
  size_t n, m;
  double *first = test_sorted_links(one, &n), *second = test_sorted_links(other, &m);
  ck_assert_uint_eq(n, m);
  ck_assert_mem_eq(first, second, n * ROW * sizeof *first);
  free(first);
  free(second);
}

static int runs_out(test_memory *m) {
  /* The hooks may be called from several threads: each gets a number of its own. */
  long left = m->until_failure;
  while (left > 0 && !atomic_compare_exchange_weak(&m->until_failure, &left, left - 1))
    ;
  if (left > 0) return 0;
  while (left == 0 && !m->for_good &&
         !atomic_compare_exchange_weak(&m->until_failure, &left, -1))
    ;
  if (left != 0) return 0;
  m->failures++;
  return 1;
}

static void *memory_allocate(void *ctx, size_t bytes) {
  test_memory *m = ctx;
  if (runs_out(m)) return NULL;
  m->live++;
  return malloc(bytes ? bytes : 1);
}

static void *memory_reallocate(void *ctx, void *block, size_t bytes) {
  test_memory *m = ctx;
  if (runs_out(m)) return NULL;
  if (!block) m->live++;
  return realloc(block, bytes ? bytes : 1);
}

static void memory_release(void *ctx, void *block) {
  if (block) ((test_memory *)ctx)->live--;
  free(block);
}

hr2d_allocator test_hooks(test_memory *memory) {
  return (hr2d_allocator){memory_allocate, memory_reallocate, memory_release, memory};
}

void test_same_counts(const hr2d_refine_counts *one, const hr2d_refine_counts *other) {
  ck_assert_uint_eq(one->elements, other->elements);
  ck_assert_uint_eq(one->leaves, other->leaves);
  ck_assert_uint_eq(one->links, other->links);
  ck_assert_uint_eq(one->limited_links, other->limited_links);
  ck_assert_uint_eq(one->oracle_calls, other->oracle_calls);
  ck_assert_uint_eq(one->facing_tests, other->facing_tests);
  ck_assert_uint_eq(one->visibility_tests, other->visibility_tests);
  ck_assert_uint_eq(one->partial_links, other->partial_links);
  ck_assert_uint_eq(one->blocked_pairs, other->blocked_pairs);
  ck_assert_uint_eq(one->dark_pairs, other->dark_pairs);
  ck_assert_uint_eq(one->exchange_areas, other->exchange_areas);
  ck_assert_uint_eq(one->levels, other->levels);
}

int test_has_long_double(void) {
  volatile long double sum = 1;
  sum += 0x1p-60L;
  return sum > 1;
}

int test_run(Suite *suite) {
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_NORMAL);
  const int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
