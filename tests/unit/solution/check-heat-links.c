/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temperatures of patches of given flux in several bands, on links of one's own: beside
   Hottel's network, beside scenes in which the temperatures that were found are given, and
   beside hr2d_solve_to(). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"
#include "support/tape.h"

#define T HR2D_HEAT_TEMPERATURE
#define Q HR2D_HEAT_FLUX

enum { MOST = 8, BANDS = 3 };

typedef struct wall {
  double at[4];
  hr2d_heat given;
  double value, e[BANDS];
} wall;

/* A room with walls of given flux, of which one faces a screen. */
static const wall room[] = {
    {{0, 0, 4, 0}, T, 1500, {.3, .5, .9}},  {{4, 0, 4.5, 3}, Q, 0, {.9, .5, .2}},
    {{4.5, 3, 0, 3}, T, 500, {.1, .5, .7}}, {{0, 3, 0, 0}, Q, -2000, {.4, .8, .9}},
    {{2, 1, 2, 2}, Q, 300, {.7, .2, .4}},   {{2, 2, 2, 1}, Q, 0, {.6, .6, .1}}};
enum { ROOM = sizeof room / sizeof *room };

typedef struct answer {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  double kelvin[MOST], bound[MOST], heat[MOST];
  unsigned char state[MOST];
} answer;

static hr2d_scene *make(const wall *w, size_t count) {
  static const double wavelength[] = {3, 8};
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, wavelength, BANDS - 1), HR2D_OK);
  for (size_t k = 0; k < count; k++) {
    const hr2d_patch patch = test_patch(w[k].at[0], w[k].at[1], w[k].at[2], w[k].at[3]);
    hr2d_thermal t = HR2D_THERMAL_INIT;
    t.given = w[k].given;
    t.value = w[k].value;
    t.emissivity = w[k].e;
    t.emissivity_bands = BANDS;
    ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_OK);
  }
  test_commit(scene);
  return scene;
}

static answer link_up(const wall *w, size_t count, double epsilon, unsigned order) {
  answer a = {.scene = make(w, count)};
  hr2d_refine_options how = HR2D_REFINE_OPTIONS_INIT;
  how.epsilon = epsilon;
  ck_assert_int_eq(hr2d_hierarchy_create(a.scene, &a.hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_set_order(a.hierarchy, order), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(a.hierarchy, NULL, NULL, NULL, NULL, &a.links), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(a.links, &how), HR2D_OK);
  return a;
}

static void read(answer *a) {
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  to.kelvin = a->kelvin;
  to.bound = a->bound;
  to.heat = a->heat;
  to.state = a->state;
  ck_assert_int_eq(hr2d_solution_temperatures(a->solution, NULL, NULL, &to), HR2D_OK);
}

static void solve(answer *a, const hr2d_solve_options *options) {
  const hr2d_status status = hr2d_solve(a->links, options, &a->solution);
  ck_assert_msg(!status, "%s", hr2d_linkset_message(a->links));
  read(a);
}

static void end(answer *a) {
  hr2d_solution_destroy(a->solution);
  hr2d_linkset_destroy(a->links);
  hr2d_hierarchy_destroy(a->hierarchy);
  hr2d_scene_destroy(a->scene);
}

static void close_to(double value, double expected, double error) {
  ck_assert_msg(fabs(value - expected) <= error, "%.17g is not %.17g", value, expected);
}

/* B of black walls of one temperature is constant, so that links of whole walls are exact. */
START_TEST(black_walls_are_a_network) {
  const double a12 = 1, a13 = 3, a23 = 2; /* (4 + 3 − 5)/2, … */
  const wall w[] = {{{0, 0, 4, 0}, T, 1500, {1, 1, 1}},
                    {{0, 3, 0, 0}, T, 600, {1, 1, 1}},
                    {{4, 0, 0, 3}, Q, 0, {1, 1, 1}}};
  const double hot = hr2d_black_body(1500), cold = hr2d_black_body(600);
  const double heat = (hot - cold) * (a12 + 1 / (1 / a13 + 1 / a23));
  answer a = link_up(w, 3, .5, 1);
  solve(&a, NULL);
  close_to(a.heat[0], heat, 1e-12 * heat);
  close_to(a.heat[1], -heat, 1e-12 * heat);
  close_to(hr2d_black_body(a.kelvin[2]), (a13 * hot + a23 * cold) / (a13 + a23), 1e-12 * hot);
  ck_assert_int_eq(a.state[2], HR2D_TEMPERATURE_FOUND);
  ck_assert(isnan(a.bound[2]));
  end(&a);
}
END_TEST

/* On the same links, a scene with these temperatures has the same light, and the heat of each
   patch is the one that was given. */
START_TEST(temperatures_found_may_be_given) {
  for (unsigned order = 1; order <= 3; order++) {
    wall w[ROOM];
    answer a = link_up(room, ROOM, .3, order);
    solve(&a, NULL);
    for (size_t k = 0; k < ROOM; k++) {
      w[k] = room[k];
      w[k].given = T;
      w[k].value = a.kelvin[k];
    }
    answer b = link_up(w, ROOM, .3, order);
    solve(&b, NULL);
    ck_assert_uint_eq(hr2d_hierarchy_count(a.hierarchy).elements,
                      hr2d_hierarchy_count(b.hierarchy).elements);
    for (size_t k = 0; k < ROOM; k++) {
      const double size = hr2d_black_body(1500) * hr2d_scene_length(a.scene, k);
      close_to(a.heat[k], b.heat[k], 1e-11 * size);
      if (room[k].given == Q) ck_assert_int_eq(a.state[k], HR2D_TEMPERATURE_FOUND);
      for (size_t m = 0; m < BANDS; m++) {
        double t = .3, at, again;
        const double net = hr2d_solution_net_flux(b.solution, k, m);
        close_to(hr2d_solution_net_flux(a.solution, k, m), net, 1e-11 * size);
        close_to(hr2d_solution_average(a.solution, k, m),
                 hr2d_solution_average(b.solution, k, m), 1e-11 * size);
        double value[BANDS], other[BANDS];
        ck_assert_int_eq(hr2d_solution_gather(a.solution, k, &t, 1, value), HR2D_OK);
        ck_assert_int_eq(hr2d_solution_gather(b.solution, k, &t, 1, other), HR2D_OK);
        close_to(value[m], other[m], 1e-11 * size);
        ck_assert_int_eq(hr2d_solution_gather_temperature(a.solution, k, &t, 1, &at), HR2D_OK);
        ck_assert_int_eq(hr2d_solution_gather_temperature(b.solution, k, &t, 1, &again),
                         HR2D_OK);
        ck_assert_double_eq(at, again);
      }
    }
    /* A control: another temperature has another heat. */
    ck_assert_double_gt(fabs(a.heat[3]), 1e-6 * hr2d_black_body(1500));
    end(&a);
    end(&b);
  }
}
END_TEST

/* With finer links temperatures come to those of hr2d_solve_to(). */
START_TEST(finer_links_come_to_the_target) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-9;
  answer exact = {.scene = make(room, ROOM)};
  ck_assert_int_eq(hr2d_solve_to(exact.scene, &target, &exact.solution, NULL), HR2D_OK);
  read(&exact);
  double before = HUGE_VAL;
  for (double epsilon = .4; epsilon > .02; epsilon /= 4) {
    answer a = link_up(room, ROOM, epsilon, 1);
    double worst = 0;
    solve(&a, NULL);
    for (size_t k = 0; k < ROOM; k++) worst = fmax(worst, fabs(a.kelvin[k] - exact.kelvin[k]));
    ck_assert_double_lt(worst, .5 * before);
    before = worst;
    end(&a);
  }
  ck_assert_double_lt(before, 1);
  end(&exact);
}
END_TEST

START_TEST(threads_and_starts_do_not_matter) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  answer a = link_up(room, ROOM, test_multiplier() < .1 ? .2 : .1, 2);
  solve(&a, NULL);
  const double kelvin = a.kelvin[4], heat = a.heat[0];
  const uint64_t gathers = hr2d_solution_work(a.solution).gathers;
  hr2d_solution *first = a.solution;
  options.threads = 2;
  solve(&a, &options);
  ck_assert_double_eq(a.kelvin[4], kelvin);
  ck_assert_double_eq(a.heat[0], heat);
  hr2d_solution_destroy(a.solution);
  options.start = first;
  solve(&a, &options);
  close_to(a.kelvin[4], kelvin, 1e-10 * kelvin);
  ck_assert_uint_lt(hr2d_solution_work(a.solution).gathers, gathers / 2);
  hr2d_solution_destroy(first);
  end(&a);
}
END_TEST

/* The same bits after a pause; a state of another spectrum is another one. */
START_TEST(a_state_keeps_temperatures) {
  answer a = link_up(room, ROOM, .3, 2);
  solve(&a, NULL);
  tape t = {.until_failure = -1};
  ck_assert_int_eq(hr2d_state_write(a.solution, tape_record, &t), HR2D_OK);
  wall other[ROOM];
  memcpy(other, room, sizeof room);
  for (int damage = 0; damage < 3; damage++) {
    answer b = {.scene = make(damage == 1 ? other : room, ROOM)};
    other[1].e[2] = .3;
    ck_assert_int_eq(hr2d_hierarchy_create(b.scene, &b.hierarchy), HR2D_OK);
    ck_assert_int_eq(hr2d_hierarchy_set_order(b.hierarchy, 2), HR2D_OK);
    ck_assert_int_eq(hr2d_linkset_create(b.hierarchy, NULL, NULL, NULL, NULL, &b.links),
                     HR2D_OK);
    t.at = 0;
    if (damage == 2) t.byte[t.size - 9] ^= 0x80; /* the sign of the last temperature */
    const hr2d_status status = hr2d_state_read(b.links, tape_play, &t, &b.solution);
    ck_assert_int_eq(status, damage == 0 ? HR2D_OK : damage == 1 ? HR2D_EINVAL : HR2D_ESYNTAX);
    if (damage == 0) {
      read(&b);
      for (size_t k = 0; k < ROOM; k++) {
        ck_assert_double_eq(b.kelvin[k], a.kelvin[k]);
        ck_assert_double_eq(b.heat[k], a.heat[k]);
        ck_assert_double_eq(hr2d_solution_net_flux(b.solution, k, 1),
                            hr2d_solution_net_flux(a.solution, k, 1));
      }
    }
    end(&b);
  }
  free(t.byte);
  end(&a);
}
END_TEST

/* What has no answer, and what does not know of temperatures. */
START_TEST(refusals_have_their_reasons) {
  wall w[3] = {{{0, 0, 4, 0}, Q, 100, {.3, .5, .9}},
               {{4, 0, 0, 3}, Q, 0, {.9, .5, .2}},
               {{0, 3, 0, 0}, Q, -100, {.4, .8, .9}}};
  answer a = link_up(w, 3, .5, 1);
  ck_assert_int_eq(hr2d_solve(a.links, NULL, &a.solution), HR2D_ENO_SOLUTION);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(a.links), "cannot tell how hot"));
  end(&a);
  w[0] = (wall){{0, 0, 4, 0}, T, 300, {.3, .5, .9}};
  w[2].value = -1000;
  a = link_up(w, 3, .5, 1);
  ck_assert_int_eq(hr2d_solve(a.links, NULL, &a.solution), HR2D_ENO_SOLUTION);
  ck_assert_ptr_nonnull(
      strstr(hr2d_linkset_message(a.links), "patch 2 cannot lose so much heat"));
  end(&a);
  w[2].value = -1;
  a = link_up(w, 3, .5, 1);
  solve(&a, NULL);
  double *field = calloc(hr2d_hierarchy_count(a.hierarchy).elements * BANDS, sizeof *field);
  hr2d_solution *adopted;
  ck_assert_int_eq(hr2d_solution_adopt(a.links, NULL, field, &adopted), HR2D_EUNSUPPORTED);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(a.links), "from outside"));
  free(field);
  end(&a);
}
END_TEST

/* A band in which the patch of given temperature emits nothing is no hindrance. */
START_TEST(heat_may_change_its_band) {
  const wall w[3] = {{{0, 0, 4, 0}, T, 900, {0, .5, .9}},
                     {{4, 0, 0, 3}, Q, 0, {.9, .5, .2}},
                     {{0, 3, 0, 0}, Q, 0, {.4, .8, .9}}};
  answer a = link_up(w, 3, .1, 1);
  solve(&a, NULL);
  for (int k = 0; k < 3; k++) close_to(a.kelvin[k], 900, 1e-9 * 900);
  end(&a);
}
END_TEST

static hr2d_status count_or_stop(void *ctx, const hr2d_progress *progress) {
  int *left = ctx;
  (void)progress;
  return (*left)-- > 0 ? HR2D_OK : HR2D_STOPPED;
}

START_TEST(callbacks_end_the_solve) {
  answer a = link_up(room, ROOM, test_multiplier() < .1 ? .1 : .05, 1);
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_status status = HR2D_STOPPED;
  int asked = 0;
  options.progress = count_or_stop;
  const int steps = (int)test_some(8, 2);
  for (int max = 0; status == HR2D_STOPPED && max < 100000; max += 1 + max / steps) {
    int left = max;
    options.progress_ctx = &left;
    status = hr2d_solve(a.links, &options, &a.solution);
    ck_assert((a.solution == NULL) == (status != HR2D_OK));
    asked += status == HR2D_STOPPED;
  }
  ck_assert_int_eq(status, HR2D_OK);
  ck_assert_int_gt(asked, 10);
  end(&a);
}
END_TEST

TEST_SUITE("heat-links") {
  ADD_TESTS("heat-links", black_walls_are_a_network, temperatures_found_may_be_given,
            finer_links_come_to_the_target, threads_and_starts_do_not_matter,
            a_state_keeps_temperatures, refusals_have_their_reasons, heat_may_change_its_band,
            callbacks_end_the_solve);
}
