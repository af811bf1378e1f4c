/* SPDX-License-Identifier: GPL-3.0-or-later */
/* B and H in scenes with absorbers and shadows, averages and at points, against an independent
   method: near ends, near the edges of shadows, and everywhere else. */
#include <math.h>
#include <stdlib.h>

#include "independent/sweep-nystrom.h"
#include "support/shadow-scenes.h"
#include "support/support.h"

/* How well the other method knows B and H on the mesh `fine`, relative to the largest: where
   anything reflects, and where H is a sum of sines. See two_meshes_agree. */
#define KNOWN      4e-12
#define KNOWN_SUMS 1e-14

static const swept_mesh fine = {14, 1e-12};

/* Points of a scene. */
static size_t many(void) {
  return test_some(1000, 1);
}

/* The scene for the other method. */
typedef struct twin {
  swept_scene scene;
  double (*at)[4];
  swept_light *light;
} twin;

static twin make_twin(const hr2d_scene *scene) {
  const size_t n = hr2d_scene_patches(scene), bands = hr2d_scene_bands(scene);
  twin w = {.at = calloc(n, sizeof *w.at), .light = calloc(n, sizeof *w.light)};
  ck_assert(w.at != NULL && w.light != NULL && bands <= SWEPT_BANDS);
  w.scene = (swept_scene){.patches = {n, (const double(*)[4])w.at}, .light = w.light};
  w.scene.bands = bands;
  for (size_t p = 0; p < n; p++) {
    const hr2d_segment s = hr2d_scene_segment(scene, p);
    w.at[p][0] = s.a.x, w.at[p][1] = s.a.y, w.at[p][2] = s.b.x, w.at[p][3] = s.b.y;
    for (size_t b = 0; b < bands; b++) {
      w.light[p].emission[b] = hr2d_scene_emission(scene, p, b);
      w.light[p].reflectance[b] = hr2d_scene_reflectance(scene, p, b);
    }
  }
  for (size_t b = 0; b < bands; b++) w.scene.background[b] = hr2d_scene_background(scene, b);
  return w;
}

static void free_twin(twin *w) {
  free(w->at);
  free(w->light);
}

/* Points, the averages of all patches, and the largest of each. */
typedef struct truth {
  size_t patches, bands, points;
  double known;
  double (*average)[2][SWEPT_BANDS]; /* of B and H, per patch */
  size_t *patch;                     /* of each point */
  double *t;
  double (*value)[2][SWEPT_BANDS];
  double max_average[2][SWEPT_BANDS], max[2][SWEPT_BANDS];
} truth;

static void put(const twin *w, size_t patch, const double *irradiance,
                double value[2][SWEPT_BANDS], double max[2][SWEPT_BANDS]) {
  for (size_t b = 0; b < w->scene.bands; b++) {
    value[0][b] = w->light[patch].emission[b] + w->light[patch].reflectance[b] * irradiance[b];
    value[1][b] = irradiance[b];
    for (int h = 0; h < 2; h++) max[h][b] = fmax(max[h][b], value[h][b]);
  }
}

/* Half of the points anywhere, a quarter near ends and a quarter near edges of shadows or feet
   of walls, all at least 1e-9 from ends. */
static double draw_place(randoms *r, const real *event, size_t events) {
  const int where = random_below(r, 4);
  const double apart = random_power(r, -9, -1) * (random_below(r, 2) ? 1 : -1);
  double t = random_unit(r);
  if (where == 0) t = apart > 0 ? apart : 1 + apart;
  if (where == 1) t = (double)event[random_below(r, (int)events)] + apart;
  return fmin(fmax(t, 1e-9), 1 - 1e-9);
}

static truth find_truth(const twin *w, const swept_solution *s, randoms r, size_t points) {
  const size_t n = w->scene.patches.count;
  truth x = {.patches = n, .bands = w->scene.bands, .points = points};
  x.known = swept_nodes(s) > 0 ? KNOWN : KNOWN_SUMS;
  x.average = calloc(n, sizeof *x.average);
  x.patch = calloc(points, sizeof *x.patch);
  x.t = calloc(points, sizeof *x.t);
  x.value = calloc(points, sizeof *x.value);
  ck_assert(x.average && x.patch && x.t && x.value);
  double h[SWEPT_BANDS];
  for (size_t p = 0; p < n; p++) {
    swept_average(s, p, h);
    put(w, p, h, x.average[p], x.max_average);
  }
  for (size_t p = 0, k = 0; p < n; p++) {
    size_t events;
    real *event = sweep_events(&w->scene.patches, p, &events);
    for (; k < (p + 1) * points / n; k++) {
      x.patch[k] = p;
      x.t[k] = draw_place(&r, event, events);
      swept_at(s, p, x.t[k], h);
      put(w, p, h, x.value[k], x.max);
    }
    free(event);
  }
  return x;
}

static void free_truth(truth *x) {
  free(x->average);
  free(x->patch);
  free(x->t);
  free(x->value);
}

/* The errors of a solution as hr2d_account has them, without what the truth is not known to. */
typedef struct found {
  double average[2], sup[2]; /* of B and H */
  size_t worst[2];           /* points */
} found;

static double beyond(const truth *x, double is, double right, double max) {
  return fmax(fabs(is - right) - x->known * max, 0);
}

static void compare_averages(const truth *x, const hr2d_solution *s, found *f) {
  for (size_t p = 0; p < x->patches; p++)
    for (size_t b = 0; b < x->bands; b++) {
      const double is[] = {hr2d_solution_average(s, p, b), hr2d_solution_irradiance(s, p, b)};
      for (int h = 0; h < 2; h++) {
        const double right = x->average[p][h][b], max = x->max_average[h][b];
        const double off = beyond(x, is[h], right, max);
        ck_assert_double_ge(is[h], 0);
        if (off > 0) f->average[h] = fmax(f->average[h], off / fmax(right, HR2D_FLOOR * max));
      }
    }
}

static void compare_points(const truth *x, const hr2d_solution *s, found *f) {
  for (size_t k = 0; k < x->points; k++) {
    double is[2][SWEPT_BANDS];
    const double *t = &x->t[k];
    ck_assert_int_eq(hr2d_solution_gather(s, x->patch[k], t, 1, is[0]), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(s, x->patch[k], t, 1, is[1]), HR2D_OK);
    for (int h = 0; h < 2; h++)
      for (size_t b = 0; b < x->bands; b++) {
        const double max = x->max[h][b];
        const double off = beyond(x, is[h][b], x->value[k][h][b], max);
        ck_assert_double_ge(is[h][b], 0);
        if (!(off > f->sup[h] * max)) continue;
        f->sup[h] = off / max;
        f->worst[h] = k;
      }
  }
}

static found compare(const truth *x, const hr2d_solution *solution) {
  found f = {{0, 0}, {0, 0}, {0, 0}};
  compare_averages(x, solution, &f);
  compare_points(x, solution, &f);
  return f;
}

/* A target that the method cannot reach has bounds, too. */
static hr2d_solution *solve(const hr2d_scene *scene, hr2d_norm norm, double error,
                            hr2d_account *a) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  target.error = error;
  target.norm = norm;
  target.points = 1;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, a);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%g: status %d", error,
                (int)status);
  ck_assert_ptr_nonnull(solution);
  return solution;
}

static void check_error(const char *what, const char *name, double target, hr2d_error e,
                        double error) {
  ck_assert_msg(e.estimate <= e.bound && isfinite(e.bound), "%s, %g, %s: %g, at most %g", name,
                target, what, e.estimate, e.bound);
  ck_assert_msg(error <= e.bound, "%s, %g: %s off by %g, estimate %g, bound %g", name, target,
                what, error, e.estimate, e.bound);
}

static void check_points(const char *what, const char *name, double target, hr2d_error e,
                         const truth *x, const found *f, int h) {
  char text[80];
  snprintf(text, sizeof text, "%s at %zu:%.17g", what, x->patch[f->worst[h]],
           x->t[f->worst[h]]);
  check_error(text, name, target, e, f->sup[h]);
}

static void check_target(const char *name, const hr2d_scene *scene, const truth *x,
                         hr2d_norm norm, double error) {
  hr2d_account a;
  hr2d_solution *solution = solve(scene, norm, error, &a);
  const found f = compare(x, solution);
  check_error("B", name, error, a.average, f.average[0]);
  check_error("H", name, error, a.irradiance, f.average[1]);
  check_points("B", name, error, a.sup, x, &f, 0);
  check_points("H", name, error, a.irradiance_sup, x, &f, 1);
  hr2d_solution_destroy(solution);
}

/* With few cases, the target is the one whose turn it is. */
static void check_scene(const char *name, const hr2d_scene *scene, size_t turn, randoms r) {
  static const double target[] = {1e-3, 1e-6, 1e-9};
  static const hr2d_norm norm[] = {HR2D_NORM_AVERAGE, HR2D_NORM_SUP};
  twin w = make_twin(scene);
  swept_solution *s = swept_solve(&w.scene, fine);
  truth x = find_truth(&w, s, r, many());
  for (size_t q = 0; q < 6; q++)
    if (test_meets(turn, q, 6)) check_target(name, scene, &x, norm[q % 2], target[q / 2]);
  free_truth(&x);
  swept_destroy(s);
  free_twin(&w);
}

START_TEST(bounds_hold_in_random_scenes) {
  const int scenes = (int)fmax(30 * test_multiplier(), SHADOW_KINDS);
  for (int k = 0; k < scenes; k++) {
    char name[40];
    hr2d_scene *scene = shadow_scene_draw(test_seed(), k);
    snprintf(name, sizeof name, "%s %d", shadow_scene_kind(k), k);
    check_scene(name, scene, (size_t)k, randoms_stream(test_seed() + 1, k));
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(bounds_hold_behind_panels) {
  hr2d_scene *scene = test_shipped_scene("solar-panels.geojson");
  check_scene("solar-panels", scene, 0, randoms_stream(test_seed() + 2, 0));
  hr2d_scene_destroy(scene);
}
END_TEST

/* A black room with a lamp above a table: where H is a difference of two sines, and where it
   is 0. */
enum { FLOOR, EAST, CEILING_EAST, LAMP, CEILING_WEST, WEST, TABLE, UNDER_TABLE, BLACK_PATCHES };

static hr2d_scene *black_room(double table) {
  const double at[][4] = {{0, 0, 4, 0},   {4, 0, 4, 3}, {4, 3, 2.5, 3},   {2.5, 3, 1.5, 3},
                          {1.5, 3, 0, 3}, {0, 3, 0, 0}, {1, 1, table, 1}, {table, 1, 1, 1}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t p = 0; p < BLACK_PATCHES; p++) {
    const hr2d_segment s = {{at[p][0], at[p][1]}, {at[p][2], at[p][3]}};
    ck_assert_int_eq(test_add_patch(scene, s, p == LAMP, 0, HR2D_SIDES_FRONT), HR2D_OK);
  }
  test_commit(scene);
  return scene;
}

static double sine(double along, double height) {
  return along / hypot(along, height);
}

START_TEST(a_lamp_is_seen_past_a_table) {
  hr2d_scene *scene = black_room(2);
  twin w = make_twin(scene);
  swept_solution *s = swept_solve(&w.scene, fine);
  double h;
  swept_at(s, FLOOR, 0.35L, &h); /* x = 1.4 looks past the table at x = 3.2 and −0.2 */
  ck_assert_double_eq(h, 0);
  swept_at(s, FLOOR, 0.1L, &h); /* x = 0.4: past (1, 1) at x = 2.2 */
  ck_assert_double_eq_tol(h, 0.5 * (sine(1.8, 3) - sine(1.1, 3)), 1e-16);
  swept_at(s, FLOOR, 0.75L, &h); /* x = 3: past (2, 1) at x = 0 */
  ck_assert_double_eq_tol(h, 0.5 * (sine(-0.5, 3) - sine(-1.5, 3)), 1e-16);
  swept_at(s, UNDER_TABLE, 0.5L, &h);
  ck_assert_double_eq(h, 0);
  /* Hottel's strings from the lamp to the top of the table. */
  swept_average(s, TABLE, &h);
  ck_assert_double_eq_tol(h, 0.5 * (hypot(1.5, 2) - hypot(0.5, 2)), 1e-13);
  swept_destroy(s);
  free_twin(&w);
  check_scene("lamp and table", scene, 1, randoms_stream(test_seed() + 3, 0));
  hr2d_scene_destroy(scene);
}
END_TEST

/* In a closed room with E = 1 − ρ all is 1, behind a table and at the foot of a wall too. */
START_TEST(a_furnace_is_known) {
  static const double at[][4] = {{0, 0, 4, 0},     {4, 0, 4, 3},    {4, 3, 0, 3},
                                 {0, 3, 0, 0},     {1, 1, 2, 1},    {2, 1, 1, 1.0},
                                 {3, 0, 3, 1.125}, {3, 1.125, 3, 0}};
  enum { COUNT = sizeof at / sizeof *at };
  swept_light light[COUNT];
  for (int p = 0; p < COUNT; p++) light[p] = (swept_light){{0.125 * p}, {1 - 0.125 * p}};
  const swept_scene scene = {{COUNT, at}, light, 1, {0}};
  light[0] = (swept_light){{0.5}, {0.5}};
  swept_solution *s = swept_solve(&scene, fine);
  for (size_t p = 0; p < COUNT; p++) {
    double h;
    for (int k = 1; k < 10; k++) {
      swept_at(s, p, 0.1L * k + 1e-9L, &h);
      ck_assert_double_eq_tol(h, 1, KNOWN);
    }
    swept_average(s, p, &h);
    ck_assert_double_eq_tol(h, 1, KNOWN);
  }
  swept_destroy(s);
}
END_TEST

START_TEST(two_meshes_agree) {
  const int scenes = (int)fmax(30 * test_multiplier(), (double)test_some(8, 1));
  for (int k = 0; k < scenes; k++) {
    hr2d_scene *scene = shadow_scene_draw(test_seed(), k);
    const randoms r = randoms_stream(test_seed() + 1, k);
    twin w = make_twin(scene);
    swept_solution *one = swept_solve(&w.scene, fine);
    swept_solution *other = swept_solve(&w.scene, (swept_mesh){16, 1e-13});
    truth x = find_truth(&w, one, r, many() / 4), y = find_truth(&w, other, r, many() / 4);
    for (size_t q = 0; q < x.points; q++)
      for (size_t b = 0; b < x.bands; b++)
        ck_assert_double_le(fabs(x.value[q][1][b] - y.value[q][1][b]), x.known * y.max[1][b]);
    for (size_t p = 0; p < x.patches; p++)
      for (size_t b = 0; b < x.bands; b++)
        ck_assert_double_le(fabs(x.average[p][1][b] - y.average[p][1][b]),
                            x.known * y.max_average[1][b]);
    free_truth(&x);
    free_truth(&y);
    swept_destroy(one);
    swept_destroy(other);
    free_twin(&w);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Whether any of the errors of a solution is above its bound. */
static int is_violated(const hr2d_scene *scene, const truth *x, double error) {
  hr2d_account a;
  hr2d_solution *solution = solve(scene, HR2D_NORM_AVERAGE, error, &a);
  const found f = compare(x, solution);
  hr2d_solution_destroy(solution);
  return f.average[0] > a.average.bound || f.average[1] > a.irradiance.bound ||
         f.sup[0] > a.sup.bound || f.sup[1] > a.irradiance_sup.bound;
}

/* No bound can stand against the scene with a longer table, or with a brighter lamp. The table
   changes averages of H by .73 of its extra length, which is 11 times the target; the bound is
   about the target, so that no point has to lie where the edge of the shadow moves. */
START_TEST(a_wrong_scene_is_noticed) {
  hr2d_scene *scene = black_room(2), *wrong = black_room(2 + 0x1p-26);
  for (int kind = 0; kind < 3; kind++) {
    twin w = make_twin(kind == 1 ? wrong : scene);
    if (kind == 2) w.light[LAMP].emission[0] *= 1 + 1e-10;
    swept_solution *s = swept_solve(&w.scene, fine);
    truth x = find_truth(&w, s, randoms_stream(test_seed(), 0), many());
    ck_assert_int_eq(is_violated(scene, &x, 1e-9), kind > 0);
    free_truth(&x);
    swept_destroy(s);
    free_twin(&w);
  }
  hr2d_scene_destroy(wrong);
  hr2d_scene_destroy(scene);
}
END_TEST

/* One wrong value among all is enough. */
START_TEST(a_wrong_value_is_noticed) {
  hr2d_scene *scene = shadow_scene_draw(test_seed(), 5);
  twin w = make_twin(scene);
  swept_solution *s = swept_solve(&w.scene, fine);
  truth x = find_truth(&w, s, randoms_stream(test_seed(), 0), 100);
  ck_assert_int_eq(is_violated(scene, &x, 1e-9), 0);
  x.average[2][1][0] *= 1 + 1e-6;
  ck_assert_int_eq(is_violated(scene, &x, 1e-9), 1);
  x.average[2][1][0] /= 1 + 1e-6;
  x.value[50][1][0] += 1e-3 * x.max[1][0];
  ck_assert_int_eq(is_violated(scene, &x, 1e-9), 1);
  free_truth(&x);
  swept_destroy(s);
  free_twin(&w);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("irradiance at points") {
  ADD_TESTS("other method", a_lamp_is_seen_past_a_table, a_furnace_is_known, two_meshes_agree);
  ADD_TESTS("scenes", bounds_hold_in_random_scenes, bounds_hold_behind_panels,
            a_wrong_scene_is_noticed, a_wrong_value_is_noticed);
}
