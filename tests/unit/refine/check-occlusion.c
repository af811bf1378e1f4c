/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refinement and solve with occluders: every transport is counted once, with the exact
   exchange areas of the scene, and the radiosity agrees with the reference. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/neumaier-sum.h"
#include "support/room-plans.h"
#include "support/support.h"

enum { SIZE, SIZE2, BF, L1, L1_GRID, BOUNDS, ORACLES };

static const hr2d_oracle *oracle_of(int k) {
  static const char *const name[ORACLES] = {"size", "size2", "bf", "l1", "l1-grid", "bounds"};
  return hr2d_oracle_find(name[k]);
}

/* Rooms for every test: the classes of plans in turn.  Every other round is turned off the
   axes, and one room in three is opened: it loses a wall. */
typedef struct rooms {
  randoms r;
  plan plan;
  int open;
} rooms;

static void draw_room(rooms *s, int k, int size) {
  const plan_class *class = &plan_classes[k % plan_class_count];
  plan_free(&s->plan);
  class->draw(&s->r, size, &s->plan);
  const double angle = k / plan_class_count % 2 ? random_between(&s->r, 0, 6.3) : 0;
  plan_transform(&s->plan, (similarity){.u = cos(angle), .v = sin(angle)});
  s->open = k % 3 == 2;
  if (!s->open) return;
  s->plan.wall[0] = s->plan.wall[--s->plan.walls];
  s->plan.sides[0] = s->plan.sides[s->plan.walls];
}

static hr2d_scene *grey_room(rooms *s) {
  return test_painted_scene(&s->plan,
                            &(test_paint){.r = &s->r, .reflectance = .9, .emission = 1});
}

static int room_count(void) {
  const double scaled = test_multiplier() * 3 * plan_class_count;
  return scaled < plan_class_count ? plan_class_count : (int)scaled;
}

/* Calls `check` with many rooms. */
static void for_rooms(int size, void (*check)(rooms *s, const char *class, int k)) {
  rooms s = {.r = randoms_stream(test_seed(), size)};
  for (int k = 0; k < room_count(); k++) {
    draw_room(&s, k, size);
    check(&s, plan_classes[k % plan_class_count].name, k);
  }
  plan_free(&s.plan);
}

/* The largest relative error of the averages in the reference scene, which begins at row
   `row` of the table. */
static double average_error(const test_table *table, size_t row, int oracle, double epsilon,
                            int closure) {
  const char *name = test_cell(table, row, "scene");
  test_links t = test_make_links(test_named_scene(name), oracle_of(oracle), NULL, NULL, NULL);
  test_refine(&t, epsilon, HR2D_DEFAULT_MAX_LEVEL);
  hr2d_solution *solution = test_solve(&t, closure);
  const hr2d_power p = hr2d_solution_power(solution, 0);
  ck_assert_double_eq_tol(p.absorbed + p.escaped, p.emitted, 1e-13);
  if (closure) ck_assert_double_eq_tol(p.escaped, 0, 1e-13);
  const double worst = test_average_error(&t, solution, table, row);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  return worst;
}

/* The error falls like the square of the elements' lengths h: ε is as h for size, as h² for
   size2, and as h³ for l1, ∫∫ of a difference that is as h. */
START_TEST(averages_converge) {
  static const int oracle[] = {SIZE, SIZE2, L1};
  static const double first[] = {.25, .0625, .015625}, power[] = {1, 2, 3};
  const int steps = test_multiplier() < 0.1 ? 2 : 4;
  test_table table = test_read_table("radiosity_fine.csv");
  size_t row = 1;
  while (strncmp(test_cell(&table, row, "scene"), "occ", 3) != 0) row++;
  for (int k = 0; k < 6; k++) {
    const int o = k / 2, closure = k % 2;
    double epsilon = first[o], error[5] = {0};
    printf("%-6s closure %-4s", oracle_of(oracle[o])->name, closure ? "on" : "off");
    for (int step = 0; step <= steps; step++, epsilon /= pow(2, power[o])) {
      error[step] = average_error(&table, row, oracle[o], epsilon, closure);
      printf(" %.2e (%.3g)", error[step], epsilon);
      ck_assert(step == 0 || error[step] < error[step - 1]);
    }
    const double order = log2(error[steps - 2] / error[steps]) / 2;
    printf(" order %.2f in h\n", order);
    ck_assert_double_gt(order, steps == 4 ? 1.8 : 1.5);
    if (steps == 4) ck_assert_double_lt(error[steps], oracle[o] == L1 ? 1e-3 : 1e-4);
  }
  test_free_table(&table);
}
END_TEST

static void check_power(rooms *s, const char *class, int k) {
  test_links t = test_make_links(grey_room(s), NULL, NULL, NULL, NULL);
  test_refine(&t, .5, 6);
  for (int closure = 0; closure < 2; closure++) {
    hr2d_solution *solution = test_solve(&t, closure);
    const hr2d_power p = hr2d_solution_power(solution, 0);
    ck_assert_double_gt(p.emitted, 0);
    ck_assert_msg(fabs(p.absorbed + p.escaped - p.emitted) <= 1e-13 * p.emitted,
                  "%s, room %d: %g + %g of %g", class, k, p.absorbed, p.escaped, p.emitted);
    if (closure && !s->open)
      ck_assert_msg(fabs(p.escaped) <= 1e-13 * p.emitted, "%s, room %d: %g escapes", class, k,
                    p.escaped);
    hr2d_solution_destroy(solution);
  }
  test_free_links(&t);
}

START_TEST(power_is_balanced) {
  for_rooms(12, check_power);
}
END_TEST

/* E = 1 − ρ everywhere: B = 1 on every element. */
static void check_furnace(rooms *s, const char *class, int k) {
  if (s->open) return;
  const test_paint paint = {.r = &s->r, .reflectance = .9, .isothermal = 1};
  test_links t = test_make_links(test_painted_scene(&s->plan, &paint), NULL, NULL, NULL, NULL);
  test_refine(&t, k % 2 ? .25 : 1, 6);
  hr2d_solution *solution = test_solve(&t, 1);
  for (uint32_t e = 0; e < hr2d_hierarchy_count(t.hierarchy).elements; e++) {
    const double b = hr2d_solution_element(solution, e, 0);
    ck_assert_msg(fabs(b - 1) <= 1e-13, "%s, room %d: B = 1 + %g on element %u", class, k,
                  b - 1, (unsigned)e);
  }
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}

START_TEST(furnace_is_exact) {
  for_rooms(12, check_furnace);
}
END_TEST

/* The exchange areas of the links between two patches add up to that of the patches.  Hidden
   patches have no links, except where rounding puts one patch in front of another on the
   same line. */
static void check_transport(const test_links *t, const char *what) {
  const hr2d_element *element = hr2d_hierarchy_elements(t->hierarchy);
  const size_t n = hr2d_scene_patches(t->scene);
  const int directed = hr2d_linkset_directed(t->links);
  hr2di_sum *sum = calloc(n * n, sizeof *sum);
  size_t *links = calloc(n * n, sizeof *links);
  double *area = malloc(n * n * sizeof *area);
  ck_assert_int_eq(hr2d_exchange_matrix(t->scene, NULL, area, NULL), HR2D_OK);
  for (uint64_t k = 0; k < hr2d_linkset_size(t->links); k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k);
    const size_t i = element[link.pair.first].patch, j = element[link.pair.second].patch;
    hr2di_sum_add(&sum[i * n + j], link.exchange_area);
    links[i * n + j]++;
    if (!directed) hr2di_sum_add(&sum[j * n + i], link.exchange_area);
    if (!directed) links[j * n + i]++;
  }
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      const size_t at = i * n + j;
      const double off = hr2di_sum_total(&sum[at]) - area[at];
      ck_assert_msg(fabs(off) <= 1e-13 * hr2d_scene_length(t->scene, i),
                    "%s: patches %zu and %zu exchange %g, their links %g more", what, i, j,
                    area[at], off);
      const int negligible =
          fmax(area[at], hr2di_sum_total(&sum[at])) <= 1e-25 * hr2d_scene_length(t->scene, i);
      ck_assert_msg(!links[at] == !(area[at] > 0) || negligible,
                    "%s: patches %zu and %zu: %zu links for %g", what, i, j, links[at],
                    area[at]);
    }
  free(area);
  free(links);
  free(sum);
}

/* A room with every oracle and both policies. */
static void check_links(rooms *s, const char *class, int k) {
  const int oracle = k % 7 == 6 ? L1_GRID : k % 7 == 5 ? BOUNDS : k % 4;
  const double epsilon = (const double[]){.5, .2, .1, .05, .05}[oracle];
  char what[80];
  snprintf(what, sizeof what, "%s, room %d, oracle %s", class, k, oracle_of(oracle)->name);
  test_links t = test_make_links(grey_room(s), oracle_of(oracle), NULL,
                                 k / 2 % 2 ? hr2d_policy_modified() : NULL, NULL);
  hr2d_refine_options options = test_options(epsilon, 6);
  options.ordered = k % 5 == 4;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  const hr2d_refine_counts counts = hr2d_linkset_counts(t.links);
  ck_assert_uint_le(counts.partial_links, counts.links);
  ck_assert_uint_le(counts.limited_links, counts.links);
  ck_assert_msg(hr2d_linkset_validate(t.links) == HR2D_OK, "%s: %s", what,
                hr2d_linkset_message(t.links));
  check_transport(&t, what);
  test_free_links(&t);
}

START_TEST(links_are_valid_and_exchange_what_patches_do) {
  for_rooms(12, check_links);
}
END_TEST

/* Walls that end on others up to rounding, exactly where an element ends, too. */
static const hr2d_segment branches[] = {{{-0x1.0ed45f1292178p+9, -0x1.b2817fee9cb73p+9},
                                         {0x1.475a41b8153f6p+8, -0x1.60aaef8097676p+10}},
                                        {{0x1.475a41b8153f6p+8, -0x1.60aaef8097676p+10},
                                         {0x1.b2817fee9cb73p+9, -0x1.0ed45f1292178p+9}},
                                        {{-0x1.ac9cf8da1ddeep+6, -0x1.1cf5d7bbf2e17p+10},
                                         {-0x1.65e6a3e42bcp+2, -0x1.e873677b28609p+9}},
                                        {{-0x1.470d553327164p+6, -0x1.12c6cebc5b353p+10},
                                         {0x1.791c548dd62bp+5, -0x1.14025fefea4ccp+10}}},
                          teeth[] = {{{0x1.4eb338e9ed3e8p+3, -0x1.e5d24c22e9da4p+0},
                                      {0x1.5e760d7b6087ap+2, 0x1.171257cd6ab6bp+2}},
                                     {{0x1.ae3226917f04fp+2, 0x1.65e13a2fc2d6bp+1},
                                      {0x1.7c214936ba5f4p+2, 0x1.16252119a4597p+1}},
                                     {{0x1.de689684b6f01p+0, -0x1.2c6530209be1fp+1},
                                      {0x1.71ee786704f85p+2, 0x1.891d3537f2434p-1}},
                                     {{0x1.3ef0645879f56p+1, -0x1.9086ead6252d4p+1},
                                      {0x1.67bba7974f915p+2, -0x1.465a19f6acdf8p-1}}},
                          stub[] = {{{-0x1.e2400b9fa5e7fp+7, 0x1.f19a596b8d889p+9},
                                     {-0x1.35152e29bb814p+10, 0x1.790a5683a40e9p+9}},
                                    {{-0x1.8748fe317a77cp+9, 0x1.65ed632a5aa6ep+9},
                                     {-0x1.9076d5346916dp+9, 0x1.adc957c91a33ep+9}},
                                    {{-0x1.886eb911d84bbp+9, 0x1.6ee8e1be3298ap+9},
                                     {-0x1.8b0d7e48b9c39p+9, 0x1.757a35f5b7132p+9}}};

START_TEST(elements_may_end_where_walls_do) {
  const hr2d_segment *const wall[] = {branches, teeth, stub};
  const size_t walls[] = {4, 4, 3};
  for (int k = 0; k < 3; k++) {
    plan p = {.walls = 0};
    for (size_t w = 0; w < walls[k]; w++)
      plan_add(&p, wall[k][w].a, wall[k][w].b, HR2D_SIDES_FRONT);
    for (unsigned level = 0; level <= 6; level++) {
      test_links t = test_make_links(test_painted_scene(&p, &(test_paint){.emission = 1}), NULL,
                                     NULL, NULL, NULL);
      test_refine(&t, .2, level);
      check_transport(&t, (const char *const[]){"branches", "teeth", "stub"}[k]);
      test_free_links(&t);
    }
    plan_free(&p);
  }
}
END_TEST

/* A room of 128 patches and a wall across it, made for another program: nothing emits. */
static hr2d_scene *occ128(void) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_read(scene, test_scene_path("occ128.vs2")), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_force(scene, HR2D_EFFECT_EMISSION), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

START_TEST(occ128_is_valid) {
  for (int oracle = SIZE; oracle <= L1; oracle++) {
    test_links t = test_make_links(occ128(), oracle_of(oracle), NULL, NULL, NULL);
    test_refine(&t, oracle == L1 ? .01 : .5, 3);
    ck_assert_uint_gt(hr2d_linkset_counts(t.links).partial_links, 0);
    ck_assert_uint_gt(hr2d_linkset_counts(t.links).blocked_pairs, 0);
    ck_assert_msg(hr2d_linkset_validate(t.links) == HR2D_OK, "%s",
                  hr2d_linkset_message(t.links));
    check_transport(&t, "occ128");
    test_free_links(&t);
  }
}
END_TEST

static void check_streams(rooms *s, const char *class, int k) {
  const int oracle = k % 3;
  const randoms kept = s->r;
  test_links t[2];
  for (int m = 0; m < 2; m++) {
    s->r = kept;
    t[m] = test_make_links(grey_room(s), oracle_of(oracle), NULL, NULL, NULL);
  }
  const hr2d_refine_options options = test_options(.3, 6);
  hr2d_refine_counts streamed;
  test_collected c = {0};
  (void)class;
  ck_assert_int_eq(hr2d_refine(t[0].links, &options), HR2D_OK);
  ck_assert_int_eq(hr2d_refine_visit(t[1].links, &options, test_collect, &c, &streamed),
                   HR2D_OK);
  test_expect_collected(&t[0], &c);
  const hr2d_refine_counts stored = hr2d_linkset_counts(t[0].links);
  test_same_counts(&streamed, &stored);
  free(c.link);
  for (int m = 0; m < 2; m++) test_free_links(&t[m]);
}

START_TEST(stored_and_streamed_agree) {
  for_rooms(12, check_streams);
}
END_TEST

/* Counting integrates nothing and may stop at the first light that passes: only the tests
   of walls may be fewer than where links are made. */
static void check_threads(rooms *s, const char *class, int k) {
  static const unsigned threads[] = {1, 2, 5};
  const int oracle = k % 3;
  const randoms kept = s->r;
  const hr2d_refine_options once = test_options(.25, 6);
  (void)class;
  test_links stored = test_make_links(grey_room(s), oracle_of(oracle), NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_refine(stored.links, &once), HR2D_OK);
  hr2d_refine_counts counts[3];
  for (int m = 0; m < 3; m++) {
    hr2d_refine_options options = once;
    options.threads = threads[m];
    s->r = kept;
    test_links t = test_make_links(grey_room(s), oracle_of(oracle), NULL, NULL, NULL);
    ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts[m]), HR2D_OK);
    test_same_counts(&counts[0], &counts[m]);
    test_free_links(&t);
  }
  hr2d_refine_counts measure = hr2d_linkset_counts(stored.links);
  measure.exchange_areas = 0;
  measure.visibility_tests = counts[0].visibility_tests;
  test_same_counts(&counts[0], &measure);
  test_free_links(&stored);
}

START_TEST(threads_count_the_same) {
  for_rooms(24, check_threads);
}
END_TEST

static void check_multigrid(rooms *s, const char *class, int k) {
  const randoms kept = s->r;
  const int oracle = k % 2;
  (void)class;
  test_links once = test_make_links(grey_room(s), oracle_of(oracle), NULL, NULL, NULL);
  s->r = kept;
  test_links grid = test_make_links(grey_room(s), oracle_of(oracle), NULL, NULL, NULL);
  for (double epsilon = 2; epsilon >= .25; epsilon /= 2) test_refine(&grid, epsilon, 6);
  test_refine(&once, .25, 6);
  test_same_links(&once, &grid);
  const hr2d_refine_counts first = hr2d_linkset_counts(once.links),
                           last = hr2d_linkset_counts(grid.links);
  ck_assert_uint_eq(first.elements, last.elements);
  ck_assert_int_eq(hr2d_linkset_validate(grid.links), HR2D_OK);
  test_free_links(&once);
  test_free_links(&grid);
}

START_TEST(multigrid_ends_where_one_step_does) {
  for_rooms(12, check_multigrid);
}
END_TEST

/* From an empty set and from links that are there already. */
START_TEST(budgets_are_kept) {
  test_links ideal =
      test_make_links(test_named_scene("occ_square_walls0.5_occ0.5"), NULL, NULL, NULL, NULL);
  test_refine(&ideal, .05, 6);
  const hr2d_refine_counts all = hr2d_linkset_counts(ideal.links);
  test_links t =
      test_make_links(test_named_scene("occ_square_walls0.5_occ0.5"), NULL, NULL, NULL, NULL);
  for (int again = 0; again < 2; again++) {
    for (int tenth = 0; tenth < 10; tenth++) {
      hr2d_refine_options options = test_options(.05, 6);
      options.max_links = all.links * (unsigned)tenth / 10 + (tenth ? 0 : 1);
      test_refuse(&t, &options, HR2D_EMAX_LINKS, "");
      options.max_links = 0;
      options.max_elements = all.elements * (unsigned)tenth / 10 + (tenth ? 0 : 1);
      if (options.max_elements > hr2d_hierarchy_count(t.hierarchy).elements)
        test_refuse(&t, &options, HR2D_EMAX_ELEMENTS, "");
      options.max_elements = 0;
      options.max_bytes = 16 * all.links * (unsigned)tenth / 10 + (tenth ? 0 : 1);
      test_refuse(&t, &options, HR2D_EMAX_BYTES, "");
    }
    test_refine(&t, .5, 6);
  }
  hr2d_refine_options exact = test_options(.05, 6);
  exact.max_links = all.links;
  exact.max_elements = all.elements;
  ck_assert_int_eq(hr2d_refine(t.links, &exact), HR2D_OK);
  test_same_links(&t, &ideal);
  test_free_links(&t);
  test_free_links(&ideal);
}
END_TEST

/* A whole story: each step may fail for lack of memory and is then tried again. */
typedef struct story {
  test_memory memory;
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links, *counted;
  hr2d_solution *solution;
  hr2d_refine_counts counts;
} story;

#define STEP(s, call)                                                                          \
  do {                                                                                         \
    const long failures = (s)->memory.failures;                                                \
    hr2d_status status = (call);                                                               \
    if (status == HR2D_ENOMEM && (s)->memory.failures > failures) {                            \
      (s)->memory.until_failure = -1;                                                          \
      (s)->memory.for_good = 0;                                                                \
      status = (call);                                                                         \
    }                                                                                          \
    ck_assert_msg(status == HR2D_OK, "%s: %s", #call, hr2d_strerror(status));                  \
  } while (0)

static void tell(story *s, const plan *p) {
  const hr2d_allocator hooks = test_hooks(&s->memory);
  const double one = 1;
  hr2d_refine_options options = test_options(.4, 6);
  STEP(s, hr2d_scene_create(&hooks, &s->scene));
  for (size_t k = 0; k < p->walls; k++)
    STEP(s, test_add_patch(s->scene, p->wall[k], 0, .5, p->sides[k]));
  STEP(s, hr2d_scene_set_background(s->scene, &one, 1));
  STEP(s, hr2d_scene_commit(s->scene));
  STEP(s, hr2d_hierarchy_create(s->scene, &s->hierarchy));
  STEP(s, hr2d_linkset_create(s->hierarchy, NULL, NULL, NULL, NULL, &s->links));
  STEP(s, hr2d_linkset_create(s->hierarchy, NULL, NULL, NULL, NULL, &s->counted));
  STEP(s, hr2d_refine_count(s->counted, &options, &s->counts));
  options.epsilon = 1;
  STEP(s, hr2d_refine(s->links, &options));
  options.epsilon = .4;
  STEP(s, hr2d_refine(s->links, &options));
  STEP(s, hr2d_linkset_validate(s->links));
  STEP(s, hr2d_solve(s->links, NULL, &s->solution));
}

static void end(story *s) {
  hr2d_solution_destroy(s->solution);
  hr2d_linkset_destroy(s->counted);
  hr2d_linkset_destroy(s->links);
  hr2d_hierarchy_destroy(s->hierarchy);
  hr2d_scene_destroy(s->scene);
  ck_assert_int_eq(s->memory.live, 0);
}

/* An open room in which more islands stand than are summed over at once. */
static void fail_everywhere(int for_good) {
  plan p = {.walls = 0};
  plan_add(&p, (hr2d_point){0, 0}, (hr2d_point){6, 0}, HR2D_SIDES_FRONT);
  plan_add(&p, (hr2d_point){6, 0}, (hr2d_point){6, 6}, HR2D_SIDES_FRONT);
  plan_add(&p, (hr2d_point){0, 6}, (hr2d_point){0, 0}, HR2D_SIDES_FRONT);
  for (int k = 0; k < 12; k++)
    plan_add(&p, (hr2d_point){.4 * k + .5, .3 + .1 * (k % 3)},
             (hr2d_point){.4 * k + .6, .35 + .1 * (k % 3)}, HR2D_SIDES_BOTH);
  story ideal = {.memory = {.until_failure = -1}};
  tell(&ideal, &p);
  ck_assert_uint_gt(hr2d_linkset_counts(ideal.links).partial_links, 0);
  ck_assert_uint_gt(hr2d_solution_work(ideal.solution).background_rows, 0);
  const long step = test_multiplier() < 0.1 ? 31 : test_multiplier() < 1 ? 7 : 1;
  long k = 0;
  for (int failed = 1; failed; k += step) {
    story s = {.memory = {.until_failure = k, .for_good = for_good}};
    tell(&s, &p);
    failed = s.memory.failures > 0;
    test_same_counts(&s.counts, &ideal.counts);
    for (uint32_t e = 0; e < hr2d_hierarchy_count(s.hierarchy).elements; e++)
      ck_assert_double_eq(hr2d_solution_element(s.solution, e, 0),
                          hr2d_solution_element(ideal.solution, e, 0));
    end(&s);
  }
  printf("%s: one of %ld among %ld allocations failed\n", for_good ? "for good" : "once", step,
         k - step);
  ck_assert_int_gt(k, 100);
  end(&ideal);
  plan_free(&p);
}

START_TEST(allocations_fail_one_by_one) {
  fail_everywhere(0);
  fail_everywhere(1);
}
END_TEST

/* The pairs that the library reports to an oracle of the user. */
typedef struct witness {
  uint64_t partial, clear;
} witness;

static hr2d_status look(void *ctx, const hr2d_batch *batch, double *error) {
  witness *w = ctx;
  const hr2d_scene *scene = hr2d_hierarchy_scene(batch->hierarchy);
  const size_t n = hr2d_scene_patches(scene);
  hr2d_segment *wall = malloc(n * sizeof *wall);
  uint64_t partial = 0;
  for (size_t k = 0; k < n; k++) wall[k] = hr2d_scene_segment(scene, k);
  ck_assert_double_eq(batch->unit, 1); /* so that elements are in scene lengths */
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_element *e = &batch->elements[batch->pairs[k].first],
                       *f = &batch->elements[batch->pairs[k].second];
    const hr2d_segment i = {e->a, e->b}, j = {f->a, f->b};
    double area;
    ck_assert_int_eq(hr2d_exchange_area_occluded(&i, &j, wall, n, NULL, &area), HR2D_OK);
    const int told = batch->partial && batch->partial[k];
    if (batch->partial) ck_assert_uint_le(batch->partial[k], 1);
    if (area != hr2d_exchange_area(&i, &j)) ck_assert(told);
    partial += (unsigned)told;
    error[k] = fmax(e->length, f->length);
  }
  /* NULL rather than zeros. */
  ck_assert(!batch->partial || partial > 0);
  w->partial += partial;
  w->clear += batch->count - partial;
  free(wall);
  return HR2D_OK;
}

static const hr2d_oracle looking = {.struct_size = sizeof(hr2d_oracle),
                                    .name = "looking",
                                    .flags = HR2D_ORACLE_SYMMETRIC,
                                    .estimate = look};

START_TEST(oracles_are_told_what_is_in_the_way) {
  static const double shelf[][6] = {{0, 0, 1, 0, 1, .5},          {1, 0, 1, 1, 0, .5},
                                    {1, 1, 0, 1, 0, .5},          {0, 1, 0, 0, 0, .5},
                                    {.25, .5, .5, .625, 0, .5},   {.5, .625, .25, .5, 0, .5},
                                    {.5, .625, 1, .375, 0, .5},   {1, .375, .5, .625, 0, .5},
                                    {.125, .25, .25, .25, 0, .5}, {.25, .25, .125, .25, 0, .5}};
  for (int walls = 4; walls <= 10; walls += 6) {
    witness w = {0};
    test_links t = test_make_links(test_scene(shelf, (size_t)walls), &looking, &w, NULL, NULL);
    for (double epsilon = .5; epsilon >= .0625; epsilon /= 2) test_refine(&t, epsilon, 6);
    test_refine(&t, .0625, 6);
    ck_assert_uint_gt(w.clear, 0);
    ck_assert(walls == 4 ? w.partial == 0 : w.partial > 0);
    test_free_links(&t);
  }
}
END_TEST

/* The estimate of each oracle for a partial pair: size counts twice; l1 adds the exchange
   area, which the occluder may hide; for bounds the least kernel is 0 and the largest ½. */
START_TEST(partial_pairs_count_for_more) {
  test_links t = test_make_links(test_named_scene("par1"), NULL, NULL, NULL, NULL);
  const hr2d_segment i = hr2d_scene_segment(t.scene, 0), j = hr2d_scene_segment(t.scene, 1);
  const double area = hr2d_exchange_area(&i, &j);
  const hr2d_pair both = {0, 1};
  const unsigned char yes = 1;
  hr2d_batch batch = {.struct_size = sizeof batch,
                      .hierarchy = t.hierarchy,
                      .elements = hr2d_hierarchy_elements(t.hierarchy),
                      .pairs = &both,
                      .count = 1,
                      .unit = hr2d_scene_unit(t.scene)};
  for (int k = 0; k < ORACLES; k++) {
    double clear, shaded;
    batch.partial = NULL;
    ck_assert_int_eq(oracle_of(k)->estimate(NULL, &batch, &clear), HR2D_OK);
    batch.partial = &yes;
    ck_assert_int_eq(oracle_of(k)->estimate(NULL, &batch, &shaded), HR2D_OK);
    const double expected =
        (const double[]){2 * clear, 4 * clear, 2 * clear, clear + area, clear + area, 0.5}[k];
    ck_assert_double_eq_tol(shaded, expected, (k == BOUNDS ? 1e-10 : 1e-15) * expected);
    for (int side = -1; side <= 1 && oracle_of(k)->accept; side++) {
      unsigned char accepted;
      const double epsilon = shaded * (1 + side * 1e-12);
      ck_assert_int_eq(oracle_of(k)->accept(NULL, &batch, epsilon, &accepted), HR2D_OK);
      ck_assert_int_eq(accepted, side >= 0);
    }
  }
  test_free_links(&t);
}
END_TEST

/* A fence; that it is tight is found only when the pairs behind it would be linked. */
START_TEST(what_is_hidden_has_no_link) {
  enum { PALES = 40 };
  plan fence = {.walls = 0};
  const test_paint paint = {.reflectance = .5, .emission = 1};
  plan_add(&fence, (hr2d_point){0, 0}, (hr2d_point){PALES, 0}, HR2D_SIDES_FRONT);
  plan_add(&fence, (hr2d_point){PALES, 9}, (hr2d_point){0, 9}, HR2D_SIDES_FRONT);
  for (int k = -PALES; k < 2 * PALES; k++)
    plan_add(&fence, (hr2d_point){k, 4 + (k & 1)}, (hr2d_point){k + 1, 5 - (k & 1)},
             HR2D_SIDES_BOTH);
  for (unsigned level = 0; level < 5; level++) {
    test_links t = test_make_links(test_painted_scene(&fence, &paint), NULL, NULL, NULL, NULL);
    test_refine(&t, .01, level);
    const hr2d_element *e = hr2d_hierarchy_elements(t.hierarchy);
    for (uint64_t k = 0; k < hr2d_linkset_size(t.links); k++) {
      const hr2d_pair p = hr2d_linkset_get(t.links, k).pair;
      ck_assert(e[p.first].patch != 0 || e[p.second].patch != 1);
    }
    const hr2d_refine_counts counts = hr2d_linkset_counts(t.links);
    ck_assert_uint_gt(counts.blocked_pairs, 0);
    ck_assert_uint_le(counts.limited_links, counts.links);
    ck_assert_int_eq(hr2d_linkset_validate(t.links), HR2D_OK);
    test_free_links(&t);
  }
  plan_free(&fence);
}
END_TEST

TEST_SUITE("occlusion") {
  ADD_TESTS("light", averages_converge, power_is_balanced, furnace_is_exact);
  ADD_TESTS("links", links_are_valid_and_exchange_what_patches_do,
            elements_may_end_where_walls_do, occ128_is_valid, what_is_hidden_has_no_link,
            stored_and_streamed_agree, threads_count_the_same,
            multigrid_ends_where_one_step_does);
  ADD_TESTS("callers", oracles_are_told_what_is_in_the_way, partial_pairs_count_for_more,
            budgets_are_kept, allocations_fail_one_by_one);
}
