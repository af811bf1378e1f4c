/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard cases of scenes: at the ends of the range of doubles, far from the origin, of mixed
   scales.  The same scene must have the same answer if it is scaled, turned, moved, written in
   another order or solved by more threads.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#define _POSIX_C_SOURCE 200809L
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "independent/brute-visibility.h"
#include "support/hard.h"
#include "support/room-plans.h"
#include "support/support.h"

#define RHO 0.7
/* The first ROOMS classes of plans have no walls that end on others.  Those below ASYMMETRIC
   must keep the bound of a rounding; those below SMALL have so few patches that they are
   solved to a target, too. */
enum { ROOMS = 4, ASYMMETRIC = 3, SMALL = 1, MOST = 400 };

/* A room with a screen in it. */
static const double box[6][6] = {{0, 0, 1, 0, 1, .5},     {1, 0, 1, 1, 0, RHO},
                                 {1, 1, 0, 1, 0, RHO},    {0, 1, 0, 0, 0, .3},
                                 {.3, .5, .7, .5, 0, .5}, {.7, .5, .3, .5, 0, .5}};

static hr2d_status make(const double (*patch)[6], size_t count, hr2d_scene **scene) {
  hr2d_status status = hr2d_scene_create(NULL, scene);
  for (size_t k = 0; k < count && !status; k++) {
    const double *p = patch[k];
    const hr2d_segment at = {{p[0], p[1]}, {p[2], p[3]}};
    status = test_add_patch(*scene, at, p[4], p[5], HR2D_SIDES_FRONT);
  }
  return status ? status : hr2d_scene_commit(*scene);
}

static void place(double (*patch)[6], double scale, double x, double y) {
  for (int k = 0; k < 6; k++)
    for (int c = 0; c < 6; c++)
      patch[k][c] = c > 3 ? box[k][c] : scale * box[k][c] + (c % 2 ? y : x);
}

/* All that is known of a scene's answer. */
typedef struct answer {
  size_t patches;
  uint64_t elements, links;
  double shortest;       /* patch */
  double average[MOST];  /* of B, by hr2d_solve() */
  double accurate[MOST]; /* by hr2d_solve_to(), to 1e-10 */
  double bound;          /* of these */
  double *area, *element;
} answer;

/* Takes the scene. */
static answer solve(hr2d_scene *scene, unsigned threads, int accurate) {
  answer a = {.patches = hr2d_scene_patches(scene), .shortest = HUGE_VAL};
  ck_assert_uint_le(a.patches, MOST);
  a.area = malloc(a.patches * a.patches * sizeof *a.area);
  hr2d_matrix_options matrix = HR2D_MATRIX_OPTIONS_INIT;
  matrix.threads = threads;
  ck_assert_int_eq(hr2d_exchange_matrix(scene, &matrix, a.area, NULL), HR2D_OK);
  if (accurate) {
    hr2d_target target = HR2D_TARGET_INIT;
    target.error = 1e-10;
    target.threads = threads;
    hr2d_solution *solution;
    hr2d_account account;
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
    ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s", hr2d_strerror(status));
    ck_assert(status == HR2D_OK || account.reason[0] != '\0');
    a.bound = account.average.bound;
    for (size_t k = 0; k < a.patches; k++)
      a.accurate[k] = hr2d_solution_average(solution, k, 0);
    hr2d_solution_destroy(solution);
  }
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  test_refine(&t, .2, HR2D_DEFAULT_MAX_LEVEL);
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.threads = threads;
  hr2d_solution *solution;
  ck_assert_int_eq(hr2d_solve(t.links, &options, &solution), HR2D_OK);
  a.elements = hr2d_hierarchy_count(t.hierarchy).elements;
  a.links = hr2d_linkset_size(t.links);
  a.element = malloc(a.elements * sizeof *a.element);
  for (uint32_t e = 0; e < a.elements; e++) {
    a.element[e] = hr2d_solution_element(solution, e, 0);
  }
  for (size_t k = 0; k < a.patches; k++) {
    a.average[k] = hr2d_solution_average(solution, k, 0);
    a.shortest = fmin(a.shortest, hr2d_scene_length(scene, k));
  }
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  return a;
}

static void drop(answer *a) {
  free(a->area);
  free(a->element);
}

/* Every bit, with exchange areas in units of 2^exponent. */
static void same_bits(const answer *a, const answer *b, int exponent) {
  ck_assert_uint_eq(a->elements, b->elements);
  ck_assert_uint_eq(a->links, b->links);
  int other = 0;
  for (uint64_t e = 0; e < a->elements; e++) other += a->element[e] != b->element[e];
  for (size_t k = 0; k < a->patches * a->patches; k++)
    other += b->area[k] != ldexp(a->area[k], exponent);
  for (size_t k = 0; k < a->patches; k++) other += a->accurate[k] != b->accurate[k];
  ck_assert_int_eq(other, 0);
}

static double largest_change(const double *a, const double *b, size_t count) {
  double change = 0, max = 0;
  for (size_t k = 0; k < count; k++) {
    change = fmax(change, fabs(a[k] - b[k]));
    max = fmax(max, fabs(a[k]));
  }
  return max > 0 ? change / max : change;
}

/* G from cosines and r³. */
static double plain_kernel(double scale) {
  const double dx = .25 * scale, dy = scale, r = sqrt(dx * dx + dy * dy);
  return dy * dy / (2 * r * r * r) * scale;
}

START_TEST(ends_of_the_range) {
  static const double scales[] = {1e150, 1e-150, 1e300, 1e-300, 1e307, DBL_MIN};
  const double scale = scales[_i], kernel = plain_kernel(scale);
  double patch[6][6];
  hr2d_scene *one, *other;
  place(patch, scale, 0, 0);
  ck_assert_int_eq(make(box, 6, &one), HR2D_OK);
  ck_assert_int_eq(make((const double(*)[6])patch, 6, &other), HR2D_OK);
  answer a = solve(one, 1, 1), b = solve(other, 1, 1);
  const double change = largest_change(a.average, b.average, 6);
  const double accurate = largest_change(a.accurate, b.accurate, 6);
  printf("at %g: B changes by %.2e, by %.2e to 1e-10; plain G is off by %g\n", scale, change,
         accurate, fabs(kernel / plain_kernel(1) - 1));
  ck_assert(!(fabs(kernel / plain_kernel(1) - 1) < .01));
  /* The screen in the middle leaves ties, which the rounding of 1e150 may break; powers of two
     do not. */
  const int same = a.elements == b.elements && a.links == b.links;
  ck_assert_double_le(change, same ? 1e-14 : 1e-4);
  ck_assert_double_le(accurate, a.bound + b.bound);
  char name[40];
  snprintf(name, sizeof name, "a room at %.3g", scale);
  hard_case("scenes", name, hard_format("G %.2g where %.2g is right", kernel, plain_kernel(1)),
            hard_format("B to %.0e", accurate));
  drop(&a);
  drop(&b);
}
END_TEST

/* x₁y₂ − x₂y₁ + …, as areas of polygons are computed. */
static double shoelace(hr2d_point a, hr2d_point b, hr2d_point c) {
  return (a.x * b.y - b.x * a.y) + (b.x * c.y - c.x * b.y) + (c.x * a.y - a.x * c.y);
}

/* Rounding the coordinates changes the room; the library must solve the rounded room
   exactly. */
START_TEST(far_from_the_origin) {
  static const double offsets[] = {1e8, 1e10, 1e12, 1e13, 1e15};
  const double offset = offsets[_i];
  double patch[6][6];
  hr2d_scene *scene;
  place(patch, 1, offset, -offset / 2);
  const hr2d_status status = make((const double(*)[6])patch, 6, &scene);
  char name[40];
  snprintf(name, sizeof name, "a room at offset %.0e", offset);
  const hr2d_point a = {patch[4][0], patch[4][1]}, b = {patch[4][2], patch[4][3]};
  const hr2d_point c = {patch[1][2], patch[1][3]};
  const double textbook = fabs(shoelace(a, b, c) / .2 - 1);
  ck_assert_double_gt(textbook, .1);
  if (offset > 2e12) {
    ck_assert_int_eq(status, HR2D_ERANGE);
    ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), "far from the origin"));
    hard_case("scenes", name, hard_format("polygon areas off by %.0e", textbook),
              hard_format("HR2D_ERANGE"));
    hr2d_scene_destroy(scene);
    return;
  }
  ck_assert_int_eq(status, HR2D_OK);
  double area[36], worst = 0;
  hr2d_segment at[6];
  for (size_t k = 0; k < 6; k++) at[k] = hr2d_scene_segment(scene, k);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
  for (int k = 0; k < 36; k++)
    worst = fmax(worst, fabs(area[k] - brute_strings(&at[k / 6], &at[k % 6], at, 6)));
  /* Feet and corners are known to an ulp of their coordinates. */
  const double bound = 1e-15 + 4 * DBL_EPSILON * offset;
  printf("offset %g: areas to %.2e of %.2e\n", offset, worst, bound);
  ck_assert_double_le(worst, bound);
  hard_case("scenes", name, hard_format("polygon areas off by %.0e", textbook),
            hard_format("areas off by %.0e", worst));
  hr2d_scene_destroy(scene);
}
END_TEST

/* A plate of 1e-9 in a room of 2e9: its row sums to 1, and its B equals that of a point. */
START_TEST(mixed_scales) {
  const double s = 1e9, d = 1e-9;
  const double patch[][6] = {{-s, -s, s, -s, 1, .5}, {s, -s, s, s, 0, RHO},
                             {s, s, -s, s, 0, RHO},  {-s, s, -s, -s, 0, .3},
                             {0, 0, d, 0, 0, .5},    {d, 0, 0, 0, 0, .5}};
  hr2d_scene *scene;
  ck_assert_int_eq(make(patch, 6, &scene), HR2D_OK);
  double area[36], textbook = 0;
  long double sum = 0;
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
  const hr2d_segment plate = hr2d_scene_segment(scene, 5);
  for (size_t k = 0; k < 6; k++) {
    const hr2d_segment w = hr2d_scene_segment(scene, k);
    sum += area[5 * 6 + k] / (long double)d;
    if (k == 0)
      textbook = (hypot(plate.a.x - w.a.x, plate.a.y - w.a.y) +
                  hypot(plate.b.x - w.b.x, plate.b.y - w.b.y) -
                  hypot(plate.a.x - w.b.x, plate.a.y - w.b.y) -
                  hypot(plate.b.x - w.a.x, plate.b.y - w.a.y)) /
                 2;
  }
  /* From the centre the floor, which fills 90°, has F = sin 45°. */
  const double floor = area[5 * 6] / d;
  ck_assert_double_eq_tol((double)sum, 1, 1e-13);
  ck_assert_double_eq_tol(floor, sqrt(.5), 1e-13);
  ck_assert_double_gt(fabs(textbook / d - sqrt(.5)), .01);
  answer a = solve(scene, 1, 1);
  const double change = largest_change(a.average, a.accurate, 4);
  printf("mixed: strings %g, plate %.17g and %.17g\n", textbook / d, a.accurate[4],
         a.accurate[5]);
  ck_assert_double_le(a.bound, 1e-8);
  ck_assert_double_le(change, .01);
  hard_case("scenes", "a plate of 1e-9 in a room of 2e9",
            hard_format("F %.2g by strings", textbook / d),
            hard_format("F off by %.0e, B bound %.0e", fabs(floor / sqrt(.5) - 1), a.bound));
  drop(&a);
  /* Scales beyond what one unit holds. */
  const double apart[][6] = {{0, 0, 1e300, 0, 1, .5}, {0, 1e-200, 1e-200, 0, 0, .5}};
  ck_assert_int_eq(make(apart, 2, &scene), HR2D_ERANGE);
  hr2d_scene_destroy(scene);
  hard_case("scenes", "1e-200 beside 1e300", hard_format("0"), hard_format("HR2D_ERANGE"));
}
END_TEST

/* The program says the same. */
START_TEST(the_program_says_so) {
  static const struct {
    double scale, offset;
    int fails;
  } file[] = {{1e150, 0, 0}, {1e-300, 0, 0}, {1, 1e8, 0}, {1, 1e14, 1}};
  const char *program = getenv("HR2D_PROGRAM");
  if (!program) return;
  char path[] = "hard-scenes-XXXXXX", command[4400];
  const int handle = mkstemp(path);
  ck_assert_int_ge(handle, 0);
  FILE *out = fdopen(handle, "w");
  ck_assert_ptr_nonnull(out);
  const double s = file[_i].scale, x = file[_i].offset;
  fprintf(out,
          "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":"
          "{\"emission\":1,\"reflectance\":0.5},\"geometry\":{\"type\":\"Polygon\","
          "\"coordinates\":[[[%.17g,%.17g],[%.17g,%.17g],[%.17g,%.17g],[%.17g,%.17g],"
          "[%.17g,%.17g]]]}},{\"type\":\"Feature\",\"properties\":{\"emission\":1,"
          "\"reflectance\":0.5,\"sides\":\"both\"},\"geometry\":{\"type\":\"LineString\","
          "\"coordinates\":[[%.17g,%.17g],[%.17g,%.17g]]}}]}\n",
          x, x, x + s, x, x + s, x + s, x, x + s, x, x, x + s / 4, x + s / 4, x + s / 2,
          x + s * 3 / 4);
  ck_assert_int_eq(fclose(out), 0);
  snprintf(command, sizeof command, "'%s' solve '%s' --json - 2>&1", program, path);
  FILE *in = popen(command, "r");
  ck_assert_ptr_nonnull(in);
  /* B = E/(1 − ρ) = 2 everywhere. */
  static char said[65536];
  const size_t size = fread(said, 1, sizeof said - 1, in);
  said[size] = '\0';
  int right = 0;
  for (const char *at = said; (at = strstr(at, "\"average\"")) != NULL; at++) {
    const char *open = strchr(at, '[');
    right += open && fabs(strtod(open + 1, NULL) - 2) < 1e-6;
  }
  const int ended = pclose(in);
  remove(path);
  printf("%g at %g: %d averages are 2\n", s, x, right);
  ck_assert_int_eq(ended != 0, file[_i].fails);
  ck_assert(file[_i].fails ? strstr(said, "far from the origin") != NULL : right == 6);
}
END_TEST

typedef struct rooms {
  randoms r;
  plan plan;
} rooms;

static void draw_room(rooms *s, int class) {
  s->plan = (plan){.walls = 0};
  plan_classes[class].draw(&s->r, 1 + random_below(&s->r, 12), &s->plan);
}

/* Materials that depend on the wall's number `as` and not on where it is in the plan. */
static hr2d_scene *painted(const plan *p, const size_t *as, const int *reversed) {
  hr2d_scene *scene;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < p->walls; k++) {
    const size_t m = as ? as[k] : k;
    const double e = m % 3 == 0, rho = RHO * (double)(m % 5) / 4;
    const int back = reversed && reversed[m];
    const hr2d_patch patch = {.a = back ? p->wall[m].b : p->wall[m].a,
                              .b = back ? p->wall[m].a : p->wall[m].b,
                              .emission = &e,
                              .emission_bands = 1,
                              .reflectance = &rho,
                              .reflectance_bands = 1,
                              .sides = p->sides[m]};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  test_commit(scene);
  return scene;
}

/* Every power of two that leaves coordinates and exchange areas normal doubles. */
START_TEST(powers_of_two_change_no_bit) {
  rooms s = {.r = randoms_stream(test_seed(), 7000 + _i)};
  for (int k = test_count(6); k > 0; k--) {
    draw_room(&s, _i);
    answer one = solve(painted(&s.plan, NULL, NULL), 1, k == 1 && _i < SMALL);
    double min = HUGE_VAL;
    for (size_t m = 0; m < one.patches * one.patches; m++)
      if (one.area[m] > 0) min = fmin(min, one.area[m]);
    for (size_t m = 0; m < s.plan.walls; m++) {
      const hr2d_segment w = s.plan.wall[m];
      const double c[] = {w.a.x, w.a.y, w.b.x, w.b.y};
      for (int n = 0; n < 4; n++)
        if (c[n] != 0) min = fmin(min, fabs(c[n]));
    }
    const int low = -1021 - ilogb(min), range = 1022 - low;
    const int exponents[] = {low, 1022 - 1, low + random_below(&s.r, range)};
    for (int e = 0; e < 3; e++) {
      plan scaled = {.walls = 0};
      for (size_t m = 0; m < s.plan.walls; m++) {
        const hr2d_segment w = s.plan.wall[m];
        plan_add(&scaled, (hr2d_point){ldexp(w.a.x, exponents[e]), ldexp(w.a.y, exponents[e])},
                 (hr2d_point){ldexp(w.b.x, exponents[e]), ldexp(w.b.y, exponents[e])},
                 s.plan.sides[m]);
      }
      answer other = solve(painted(&scaled, NULL, NULL), 1, k == 1 && _i < SMALL);
      same_bits(&one, &other, exponents[e]);
      drop(&other);
      plan_free(&scaled);
    }
    drop(&one);
    plan_free(&s.plan);
  }
}
END_TEST

/* By how much B may change with coordinates that are off by δ: each of the four strings of an
   exchange area by 2δ at most, the row of a patch of length A against n patches by 8nδ/A, and
   B by that over 1 − ρ, relative to its largest.  Unless a decision of the oracle falls the
   other way, which N and L tell, and which changes it by what ε leaves. */
static double allowed(const answer *a, double rounding) {
  return 8 * (double)a->patches * rounding / a->shortest / (1 - RHO);
}

typedef struct moves {
  int same, count;
  double worst, accurate, area; /* as a part of the allowed error */
} moves;

static void compare(moves *m, const answer *a, const answer *b, double rounding) {
  m->count++;
  if (b->area)
    for (size_t k = 0; k < a->patches * a->patches; k++)
      m->area = fmax(m->area, fabs(a->area[k] - b->area[k]) / (8 * rounding));
  if (a->elements == b->elements && a->links == b->links) {
    m->same++;
    m->worst = fmax(m->worst,
                    largest_change(a->average, b->average, a->patches) / allowed(a, rounding));
  }
  if (a->bound > 0) {
    double change = 0;
    for (size_t k = 0; k < a->patches; k++)
      change = fmax(change,
                    fabs(a->accurate[k] - b->accurate[k]) / fmax(fabs(a->accurate[k]), 1e-6));
    m->accurate = fmax(m->accurate, change / (a->bound + b->bound + allowed(a, rounding)));
  }
}

START_TEST(turns_and_moves_change_little) {
  static const char *const names[] = {"a quarter turn", "a turn", "a move", "a move by 1e6"};
  for (int kind = 0; kind < 4; kind++) {
    rooms s = {.r = randoms_stream(test_seed(), 7100 + 10 * _i + kind)};
    moves m = {0};
    for (int k = test_count(6); k > 0; k--) {
      draw_room(&s, _i);
      const int accurate = k == 1 && kind == 1 && _i <= SMALL;
      answer one = solve(painted(&s.plan, NULL, NULL), 1, accurate);
      const double angle = random_between(&s.r, 0, 6.28), far = kind == 3 ? 1e6 : 1;
      const similarity by = kind == 0   ? (similarity){0, 1, 0, 0}
                            : kind == 1 ? (similarity){cos(angle), sin(angle), 0, 0}
                                        : (similarity){1, 0, far * random_unit(&s.r), far};
      plan_transform(&s.plan, by);
      answer other = solve(painted(&s.plan, NULL, NULL), 1, accurate);
      compare(&m, &one, &other, kind == 0 ? DBL_EPSILON : 4 * DBL_EPSILON * (1 + far));
      drop(&one);
      drop(&other);
      plan_free(&s.plan);
    }
    printf("%-16s %-14s: areas by %.2g of the bound; %d of %d with as many links, B by %.2g, "
           "%.2g\n",
           plan_classes[_i].name, names[kind], m.area, m.same, m.count, m.worst, m.accurate);
    ck_assert_double_le(m.area, 1);
    ck_assert(m.worst <= 1 || _i >= ASYMMETRIC);
    ck_assert_double_le(m.accurate, 1);
  }
}
END_TEST

/* Patches in another order, and two-sided ones the other way round. */
START_TEST(order_and_direction_change_little) {
  rooms s = {.r = randoms_stream(test_seed(), 7200 + _i)};
  moves m = {0};
  for (int k = test_count(6); k > 0; k--) {
    draw_room(&s, _i);
    size_t as[MOST], first[MOST], next = 0;
    int reversed[MOST];
    for (size_t w = 0; w < s.plan.walls; w++) {
      as[w] = w;
      reversed[w] = s.plan.sides[w] == HR2D_SIDES_BOTH && random_below(&s.r, 2);
    }
    for (size_t w = s.plan.walls; w > 1; w--) {
      const size_t other = (size_t)random_below(&s.r, (int)w), swap = as[w - 1];
      as[w - 1] = as[other];
      as[other] = swap;
    }
    const int accurate = k == 1 && _i < SMALL;
    answer one = solve(painted(&s.plan, NULL, NULL), 1, accurate);
    answer two = solve(painted(&s.plan, as, reversed), 1, accurate);
    /* Back into the first order. */
    answer sorted = two;
    sorted.area = NULL;
    for (size_t w = 0; w < s.plan.walls; w++) {
      first[w] = next;
      next += s.plan.sides[w] == HR2D_SIDES_BOTH ? 2 : 1;
    }
    next = 0;
    for (size_t w = 0; w < s.plan.walls; w++) {
      const size_t sides = s.plan.sides[as[w]] == HR2D_SIDES_BOTH ? 2 : 1;
      for (size_t side = 0; side < sides; side++, next++) {
        const size_t to = first[as[w]] + (reversed[as[w]] ? 1 - side : side);
        sorted.average[to] = two.average[next];
        sorted.accurate[to] = two.accurate[next];
      }
    }
    compare(&m, &one, &sorted, DBL_EPSILON);
    drop(&one);
    drop(&two);
    plan_free(&s.plan);
  }
  printf("%-16s in another order: %d of %d with the same links; B by %.2g of the bound, %.2g\n",
         plan_classes[_i].name, m.same, m.count, m.worst, m.accurate);
  ck_assert(m.worst <= 1 || _i >= ASYMMETRIC);
  ck_assert_double_le(m.accurate, 1);
}
END_TEST

START_TEST(threads_change_no_bit) {
  rooms s = {.r = randoms_stream(test_seed(), 7300 + _i)};
  static const unsigned threads[] = {2, 3, 7};
  draw_room(&s, _i);
  answer one = solve(painted(&s.plan, NULL, NULL), 1, _i < SMALL);
  for (int k = 0; k < (test_multiplier() < .1 ? 1 : 3); k++) {
    answer other = solve(painted(&s.plan, NULL, NULL), threads[k], _i < SMALL);
    same_bits(&one, &other, 0);
    drop(&other);
  }
  drop(&one);
  plan_free(&s.plan);
}
END_TEST

/* Each band in each place. */
START_TEST(bands_are_solved_alike) {
  double first[3][6];
  for (int turn = 0; turn < 3; turn++) {
    hr2d_scene *scene;
    ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
    for (int k = 0; k < 6; k++) {
      double e[3], rho[3];
      for (int b = 0; b < 3; b++) {
        e[(b + turn) % 3] = (b + 1) * box[k][4];
        rho[(b + turn) % 3] = box[k][5] * (b + 1) / 3;
      }
      const hr2d_patch patch = {{box[k][0], box[k][1]},
                                {box[k][2], box[k][3]},
                                NULL,
                                e,
                                3,
                                rho,
                                3,
                                HR2D_SIDES_FRONT,
                                NULL,
                                0};
      ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
    }
    ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
    test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
    test_refine(&t, .1, HR2D_DEFAULT_MAX_LEVEL);
    hr2d_solution *solution = test_solve(&t, 1);
    for (int k = 0; k < 6; k++)
      for (int b = 0; b < 3; b++) {
        const double value = hr2d_solution_average(solution, (size_t)k, (size_t)(b + turn) % 3);
        if (turn == 0) first[b][k] = value;
        ck_assert_double_eq_tol(value, first[b][k], 1e-14 * first[b][k]);
      }
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
}
END_TEST

TEST_SUITE("hard scenes") {
  REPEAT_TESTS(6, "scales", ends_of_the_range);
  REPEAT_TESTS(5, "scales", far_from_the_origin);
  ADD_TESTS("scales", mixed_scales);
  REPEAT_TESTS(4, "scales", the_program_says_so);
  REPEAT_TESTS(ROOMS, "invariances", powers_of_two_change_no_bit, turns_and_moves_change_little,
               order_and_direction_change_little, threads_change_no_bit);
  ADD_TESTS("invariances", bands_are_solved_alike);
}
