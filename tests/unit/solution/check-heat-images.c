/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches of given flux in several bands with mirrors and a period: beside the whole scene, and
   beside the closed form of endless plates. */
#include <hr2d/symmetry.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"
#include "support/tape.h"

#define T HR2D_HEAT_TEMPERATURE
#define Q HR2D_HEAT_FLUX

enum { BANDS = 3, MOST = 16 };

static const double wavelength[BANDS - 1] = {3, 8};

typedef struct wall {
  double at[4];
  hr2d_heat given;
  double value;
  double e[BANDS];
} wall;

static void add(hr2d_scene *scene, const wall *w) {
  const hr2d_patch patch = test_patch(w->at[0], w->at[1], w->at[2], w->at[3]);
  hr2d_thermal t = HR2D_THERMAL_INIT;
  t.given = w->given;
  t.value = w->value;
  t.emissivity = w->e;
  t.emissivity_bands = BANDS;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_OK);
}

/* Right of x = 0; the whole room has the images on the left besides, in the same order. */
static hr2d_scene *make_room(const wall *w, size_t count, int whole) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, wavelength, BANDS - 1), HR2D_OK);
  for (size_t k = 0; k < count; k++) add(scene, &w[k]);
  for (size_t k = 0; k < count && whole; k++) {
    wall image = w[k];
    for (int c = 0; c < 4; c++)
      image.at[c] = c % 2 ? w[k].at[(c + 2) % 4] : -w[k].at[(c + 2) % 4];
    add(scene, &image);
  }
  if (!whole)
    ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 0}, {0, 1}}), HR2D_OK);
  test_commit(scene);
  return scene;
}

typedef struct found {
  double kelvin[MOST], bound[MOST], heat[MOST];
} found;

static void read(const hr2d_solution *solution, const hr2d_target *how,
                 const hr2d_account *account, found *f) {
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  to.kelvin = f->kelvin;
  to.bound = f->bound;
  to.heat = f->heat;
  ck_assert_int_eq(hr2d_solution_temperatures(solution, how, account, &to), HR2D_OK);
}

static void find(hr2d_scene *scene, double target, found *f) {
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  hr2d_account account;
  how.error = target;
  const hr2d_status status = hr2d_solve_to(scene, &how, &solution, &account);
  ck_assert_msg(!status, "%s: %s", hr2d_strerror(status), account.reason);
  read(solution, &how, &account, f);
  hr2d_solution_destroy(solution);
}

static const wall room[] = {{{0, 0, 2, 0}, T, 500, {.8, .5, .9}},
                            {{2, 0, 1.5, 2}, Q, -150, {.3, .7, .6}},
                            {{1.5, 2, 0, 2}, T, 350, {.9, .9, .4}},
                            {{.5, 1, 1.1, 1.1}, Q, 40, {.5, .2, .6}},
                            {{1.1, 1.1, .5, 1}, Q, 0, {.7, .9, .8}}};
enum { WALLS = sizeof room / sizeof *room };

START_TEST(half_a_room_has_the_temperatures_of_the_whole) {
  hr2d_scene *half = make_room(room, WALLS, 0), *whole = make_room(room, WALLS, 1);
  found h, w;
  find(half, 1e-6, &h);
  find(whole, 1e-6, &w);
  for (size_t k = 0; k < 2 * WALLS; k++) {
    const size_t of = k % WALLS;
    const double off = fabs(h.kelvin[of] - w.kelvin[k]);
    ck_assert_double_lt(h.bound[of], .05);
    ck_assert_msg(off <= h.bound[of] + w.bound[k], "%zu: %.12g and %.12g", k, h.kelvin[of],
                  w.kelvin[k]);
    ck_assert_double_eq_tol(h.heat[of], w.heat[k], 1e-3);
  }
  ck_assert_double_gt(h.kelvin[4], h.kelvin[3] + 1);
  hr2d_scene_destroy(half);
  hr2d_scene_destroy(whole);
}
END_TEST

/* q = Σ ε_b (f_b(T₁)σT₁⁴ − f_b(T₂)σT₂⁴) with 1/ε = 1/ε₁ + 1/ε₂ − 1 in each band. */
static double flux_between(const wall *w, double hot, double cold) {
  const double edge[] = {0, wavelength[0], wavelength[1], HUGE_VAL};
  double q = 0;
  for (int b = 0; b < BANDS; b++)
    q += (hr2d_black_body_part(hot, edge[b], edge[b + 1]) * hr2d_black_body(hot) -
          hr2d_black_body_part(cold, edge[b], edge[b + 1]) * hr2d_black_body(cold)) /
         (1 / w[0].e[b] + 1 / w[1].e[b] - 1);
  return q;
}

/* By a period, and between two mirrors. */
START_TEST(endless_plates_have_their_closed_form) {
  const wall plates[] = {{{0, 0, 1, 0}, Q, flux_between(room, 640, 300), {.8, .5, .9}},
                         {{1, .5, 0, .5}, T, 300, {.3, .7, .6}}};
  hr2d_scene *scene = test_new_scene(NULL);
  found f;
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, wavelength, BANDS - 1), HR2D_OK);
  for (int k = 0; k < 2; k++) add(scene, &plates[k]);
  if (_i == 0) ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
  for (int k = 0; k < 2 && _i == 1; k++)
    ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{k, 0}, {k, 1}}), HR2D_OK);
  test_commit(scene);
  find(scene, 1e-6, &f);
  ck_assert_double_eq_tol(f.kelvin[0], 640, f.bound[0]);
  ck_assert_double_lt(f.bound[0], .1);
  ck_assert_double_eq_tol(f.heat[1], -plates[0].value, 1e-3);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The temperatures of links go through a state. */
START_TEST(states_keep_temperatures) {
  hr2d_scene *half = make_room(room, WALLS, 0);
  const hr2d_refine_options options = test_options(0.3, 8);
  hr2d_solution *solution = NULL, *again = NULL;
  found f[2];
  tape t = {.until_failure = -1};
  test_links one = test_make_links(half, NULL, NULL, NULL, NULL);
  test_links other = test_make_links(make_room(room, WALLS, 0), NULL, NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_refine(one.links, &options), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(one.links, NULL, &solution), HR2D_OK);
  ck_assert_int_eq(hr2d_state_write(solution, tape_record, &t), HR2D_OK);
  ck_assert_int_eq(hr2d_state_read(other.links, tape_play, &t, &again), HR2D_OK);
  ck_assert_uint_eq(t.at, t.size);
  read(solution, NULL, NULL, &f[0]);
  read(again, NULL, NULL, &f[1]);
  ck_assert_int_eq(memcmp(f[0].kelvin, f[1].kelvin, WALLS * sizeof *f[0].kelvin), 0);
  ck_assert_double_gt(f[0].kelvin[1], 300);
  ck_assert_double_eq_tol(hr2d_solution_net_flux(solution, 3, 0) +
                              hr2d_solution_net_flux(solution, 3, 1) +
                              hr2d_solution_net_flux(solution, 3, 2),
                          room[3].value, 1e-8);
  hr2d_solution_destroy(solution);
  hr2d_solution_destroy(again);
  test_free_links(&one);
  test_free_links(&other);
  free(t.byte);
}
END_TEST

/* Patches of given flux are important to those that are asked for; images are none. */
START_TEST(targets_know_what_is_important) {
  hr2d_scene *half = make_room(room, WALLS, 0);
  const size_t first = 0;
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  hr2d_account account;
  how.error = 1e-5;
  how.important = &first;
  how.important_count = 1;
  ck_assert_int_eq(hr2d_solve_to(half, &how, &solution, &account), HR2D_OK);
  ck_assert_double_le(account.average.estimate, 1e-5);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(half);
}
END_TEST

TEST_SUITE("heat-images") {
  REPEAT_TESTS(2, "plates", endless_plates_have_their_closed_form);
  ADD_TESTS("all", half_a_room_has_the_temperatures_of_the_whole, states_keep_temperatures,
            targets_know_what_is_important);
}
