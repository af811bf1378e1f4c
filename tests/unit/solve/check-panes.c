/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panes, which scatter what falls on one side to both: values from a dense equation that was
   written apart from the library, laws that hold to rounding, and scenes that are the same. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"
#include "support/tape.h"

/* Two rooms, [0,1]² and [1,2] × [0,1], and a pane between them: its front looks to the left. */
enum { FLOOR, TOP, LEFT, FLOOR_2, RIGHT, TOP_2, FRONT, BACK, WALLS };

static const hr2d_segment wall[WALLS] = {{{0, 0}, {1, 0}}, {{1, 1}, {0, 1}}, {{0, 1}, {0, 0}},
                                         {{1, 0}, {2, 0}}, {{2, 0}, {2, 1}}, {{2, 1}, {1, 1}},
                                         {{1, 0}, {1, 1}}, {{1, 1}, {1, 0}}};

typedef struct rooms {
  double emission[WALLS], reflectance[WALLS], transmittance;
} rooms;

static rooms grey(double rho) {
  rooms r = {.transmittance = 0};
  for (int k = 0; k < WALLS; k++) r.reflectance[k] = rho;
  return r;
}

static void add(hr2d_scene *scene, hr2d_segment at, double e, double rho, double tau) {
  hr2d_patch p = HR2D_PATCH_INIT;
  p.a = at.a;
  p.b = at.b;
  p.emission = &e;
  p.reflectance = &rho;
  p.transmittance = &tau;
  p.emission_bands = p.reflectance_bands = 1;
  p.transmittance_bands = tau > 0;
  ck_assert_msg(hr2d_scene_add(scene, &p, NULL) == HR2D_OK, "%s", hr2d_scene_message(scene));
}

static void add_rooms(hr2d_scene *scene, const rooms *r) {
  for (int k = 0; k < WALLS; k++)
    add(scene, wall[k], r->emission[k], r->reflectance[k], k < FRONT ? 0 : r->transmittance);
}

static hr2d_scene *make(const rooms *r) {
  hr2d_scene *scene = test_new_scene(NULL);
  add_rooms(scene, r);
  test_commit(scene);
  return scene;
}

static hr2d_solution *solve_to(hr2d_scene *scene, double error, hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  target.threads = 1;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
  ck_assert_msg(status == HR2D_OK, "%s: %s", hr2d_strerror(status), hr2d_scene_message(scene));
  return solution;
}

/* Heat of a wall of length 1. */
static double heat(const hr2d_solution *s, size_t patch) {
  return hr2d_solution_net_flux(s, patch, 0);
}

/* tests/data has no place for eight numbers: order 6, depth 4 of the prototype, which agrees
   with order 10, depth 7 to 1e-13. */
START_TEST(a_lamp_shines_through) {
  static const double heats[WALLS] = {
      -0.233139200813926, -0.233139200813926,  0.893845224551352, -0.0722088860411765,
      0.22844093259095,   -0.0722088860411765, -0.4275668229235,  -0.0840231605085973};
  rooms r = grey(.5);
  r.emission[LEFT] = 1;
  r.reflectance[FRONT] = r.reflectance[BACK] = .2;
  r.transmittance = .5; /* an eigenvalue of S is below 0 */
  hr2d_account account;
  hr2d_scene *scene = make(&r);
  hr2d_solution *s = solve_to(scene, 1e-10, &account);
  for (size_t k = 0; k < WALLS; k++) {
    const double other = k == RIGHT || k >= FRONT ? NAN : heats[k];
    if (!isnan(other)) ck_assert_double_eq_tol(heat(s, k), heats[k], 1e-10);
  }
  const hr2d_power p = hr2d_solution_power(s, 0);
  ck_assert_double_eq_tol(p.absorbed + p.escaped, p.emitted, 1e-13);
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}
END_TEST

/* ρ′ = 1 − τ′ and τ′ = αα′/(α + α′): a sheet of emissivities .3 and .8 without net heat. */
START_TEST(a_shield_is_a_pane) {
  const double f = .3, b = .8;
  rooms r = grey(.4);
  r.emission[LEFT] = .6;
  r.transmittance = f * b / (f + b);
  r.reflectance[FRONT] = r.reflectance[BACK] = 1 - r.transmittance;
  hr2d_scene *scene = make(&r);
  hr2d_solution *s = solve_to(scene, 1e-11, NULL);
  ck_assert_double_eq_tol(heat(s, FRONT), -0.0741945565553964, 1e-11);
  ck_assert_double_eq_tol(heat(s, BACK), 0.0741945565553964, 1e-11);
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}
END_TEST

static rooms isothermal(double tau) {
  rooms r = grey(.5);
  for (int k = 0; k < WALLS; k++) r.reflectance[k] = .2 + .08 * k;
  r.reflectance[FRONT] = .3;
  r.reflectance[BACK] = .1;
  r.transmittance = tau;
  for (int k = 0; k < WALLS; k++)
    r.emission[k] = 1 - (r.reflectance[k] + (k < FRONT ? 0 : tau));
  return r;
}

/* On any mesh: of one epsilon, of other orders, with both kinds of S. */
START_TEST(one_temperature_stays) {
  static const double tau[] = {.1, .6};
  static const double epsilon[] = {.5, .05, .01};
  const rooms r = isothermal(tau[_i % 2]);
  test_links t = test_make_links(make(&r), NULL, NULL, NULL, NULL);
  if (_i / 2 > 0)
    ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, (unsigned)_i), HR2D_OK);
  test_refine(&t, epsilon[_i / 2], 10);
  hr2d_solution *s = test_solve(&t, 1);
  for (uint32_t e = 0; e < hr2d_hierarchy_count(t.hierarchy).elements; e++)
    ck_assert_double_eq_tol(hr2d_solution_element(s, e, 0), 1, 1e-13);
  for (size_t k = 0; k < WALLS; k++) {
    const double at[] = {0, .1, .77, 1};
    double b[4];
    ck_assert_int_eq(hr2d_solution_gather(s, k, at, 4, b), HR2D_OK);
    for (int m = 0; m < 4; m++) ck_assert_double_eq_tol(b[m], 1, 1e-12);
  }
  hr2d_solution_destroy(s);
  test_free_links(&t);
}
END_TEST

/* Walls whose places on both sides tell up from down: a lamp in the left corner below. */
static rooms askew(void) {
  rooms r = grey(.3);
  r.emission[FLOOR] = 1;
  r.reflectance[TOP] = .1;
  r.reflectance[RIGHT] = .8;
  r.reflectance[FRONT] = .25;
  r.reflectance[BACK] = .35;
  r.transmittance = .4;
  return r;
}

/* B = E + ρH + τH′ at points and in averages, with H′ at the same place.  At the place that is
   reached by the same parameter it is another one. */
START_TEST(a_place_has_both_sides) {
  const rooms r = askew();
  const double at[] = {.1, .35, .8}, turned[] = {.9, .65, .2};
  double b[3], h[3], other[3], wrong[3], flux[3];
  hr2d_scene *scene = make(&r);
  hr2d_solution *s = solve_to(scene, 1e-9, NULL);
  ck_assert_int_eq(hr2d_solution_gather(s, FRONT, at, 3, b), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_gather_net_flux(s, FRONT, at, 3, flux), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_gather_irradiance(s, FRONT, at, 3, h), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_gather_irradiance(s, BACK, turned, 3, other), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_gather_irradiance(s, BACK, at, 3, wrong), HR2D_OK);
  for (int k = 0; k < 3; k++) {
    ck_assert_double_eq_tol(b[k], .25 * h[k] + .4 * other[k], 1e-14);
    ck_assert_double_eq_tol(flux[k], b[k] - h[k], 1e-14);
    ck_assert_double_eq_tol(hr2d_solution_at(s, FRONT, at[k], 0), b[k], 1e-7);
    ck_assert_double_ge(fabs(.25 * h[k] + .4 * wrong[k] - b[k]), 1e-4);
  }
  ck_assert_double_eq_tol(hr2d_solution_average(s, BACK, 0),
                          .35 * hr2d_solution_irradiance(s, BACK, 0) +
                              .4 * hr2d_solution_irradiance(s, FRONT, 0),
                          1e-14);
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}
END_TEST

/* In a corner the limit is that of the wedges on both sides: a coarse solve has it far better
   than its elements do. */
START_TEST(corners_have_limits_of_both_sides) {
  const rooms r = askew();
  const double ends[] = {0, 1};
  double b[2][2], elements[2];
  for (int fine = 0; fine < 2; fine++) {
    hr2d_scene *scene = make(&r);
    hr2d_solution *s = solve_to(scene, fine ? 1e-9 : 1e-2, NULL);
    ck_assert_int_eq(hr2d_solution_gather(s, FRONT, ends, 2, b[fine]), HR2D_OK);
    for (int k = 0; k < 2 && !fine; k++) elements[k] = hr2d_solution_at(s, FRONT, ends[k], 0);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  for (int k = 0; k < 2; k++) {
    printf("end %d: elements off by %.1e, the limit by %.1e\n", k, elements[k] / b[1][k] - 1,
           b[0][k] / b[1][k] - 1);
    ck_assert_double_le(fabs(b[0][k] / b[1][k] - 1), 1e-3);
    ck_assert_double_le(fabs(b[0][k] - b[1][k]), .01 * fabs(elements[k] - b[1][k]));
  }
}
END_TEST

/* E = 1 − ρ of one wall, and what another absorbs, may change places. */
START_TEST(exchange_is_the_same_both_ways) {
  rooms r = askew();
  double absorbed[2];
  for (int turn = 0; turn < 2; turn++) {
    const int from = turn ? RIGHT : FLOOR, to = turn ? FLOOR : RIGHT;
    for (int k = 0; k < WALLS; k++) r.emission[k] = k == from ? 1 - r.reflectance[k] : 0;
    hr2d_scene *scene = make(&r);
    hr2d_solution *s = solve_to(scene, 1e-11, NULL);
    absorbed[turn] = -heat(s, (size_t)to);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  ck_assert_double_eq_tol(absorbed[0], absorbed[1], 1e-12);
  ck_assert_double_ge(absorbed[0], .01);
}
END_TEST

/* The scene turned by half a turn, and the pane drawn from its other end. */
START_TEST(front_and_back_may_change_places) {
  const rooms r = askew();
  hr2d_scene *one = make(&r), *other = test_new_scene(NULL);
  for (int k = 0; k < WALLS; k++) {
    const int from = k == FRONT ? BACK : k == BACK ? FRONT : k;
    const hr2d_segment w = wall[from];
    add(other, (hr2d_segment){{-w.a.x, -w.a.y}, {-w.b.x, -w.b.y}}, r.emission[from],
        r.reflectance[from], from < FRONT ? 0 : r.transmittance);
  }
  test_commit(other);
  ck_assert_uint_eq(hr2d_scene_other_side(other, FRONT), BACK);
  hr2d_solution *s = solve_to(one, 1e-10, NULL), *t = solve_to(other, 1e-10, NULL);
  for (size_t k = 0; k < WALLS; k++) {
    const size_t at = k == FRONT ? BACK : k == BACK ? FRONT : k;
    ck_assert_double_eq_tol(hr2d_solution_average(s, at, 0), hr2d_solution_average(t, k, 0),
                            1e-10);
  }
  hr2d_solution_destroy(s);
  hr2d_solution_destroy(t);
  hr2d_scene_destroy(one);
  hr2d_scene_destroy(other);
}
END_TEST

/* The sum of two lamps is the sum of their light. */
START_TEST(light_adds_up) {
  rooms r = askew();
  double sum[WALLS] = {0}, all[WALLS];
  for (int turn = 0; turn < 3; turn++) {
    for (int k = 0; k < WALLS; k++) r.emission[k] = 0;
    if (turn != 1) r.emission[TOP] = 1;
    if (turn != 0) r.emission[BACK] = 3;
    hr2d_scene *scene = make(&r);
    hr2d_solution *s = solve_to(scene, 1e-11, NULL);
    for (size_t k = 0; k < WALLS; k++) {
      all[k] = hr2d_solution_average(s, k, 0);
      if (turn < 2) sum[k] += all[k];
    }
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  for (int k = 0; k < WALLS; k++) ck_assert_double_eq_tol(sum[k], all[k], 1e-10);
}
END_TEST

/* Two pieces of a pane, also where split_crossings makes them, are the pane. */
START_TEST(pieces_are_the_pane) {
  const rooms r = askew();
  hr2d_account account[2];
  hr2d_scene *whole = make(&r), *parts = test_new_scene(NULL);
  for (int k = 0; k < FRONT; k++) add(parts, wall[k], r.emission[k], r.reflectance[k], 0);
  const hr2d_point cut = {1, .37};
  add(parts, (hr2d_segment){{1, 0}, cut}, 0, r.reflectance[FRONT], .4);
  add(parts, (hr2d_segment){cut, {1, 1}}, 0, r.reflectance[FRONT], .4);
  add(parts, (hr2d_segment){{1, 1}, cut}, 0, r.reflectance[BACK], .4);
  add(parts, (hr2d_segment){cut, {1, 0}}, 0, r.reflectance[BACK], .4);
  test_commit(parts);
  hr2d_solution *s = solve_to(whole, 1e-9, &account[0]),
                *t = solve_to(parts, 1e-9, &account[1]);
  for (size_t k = 0; k < FRONT; k++) {
    const double b = hr2d_solution_average(s, k, 0);
    ck_assert_double_eq_tol(hr2d_solution_average(t, k, 0), b,
                            b * (account[0].average.bound + account[1].average.bound));
  }
  hr2d_solution_destroy(s);
  hr2d_solution_destroy(t);
  hr2d_scene_destroy(whole);
  hr2d_scene_destroy(parts);
}
END_TEST

START_TEST(split_panes_keep_their_sides) {
  const rooms r = askew();
  hr2d_scene *scene = test_new_scene(NULL);
  size_t cuts = 0;
  add_rooms(scene, &r);
  add(scene, (hr2d_segment){{.7, .2}, {1.6, .9}}, 0, .5, 0);
  ck_assert_int_eq(hr2d_scene_split_crossings(scene, &cuts), HR2D_OK);
  ck_assert_uint_gt(cuts, 0);
  test_commit(scene);
  size_t sides = 0;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const size_t other = hr2d_scene_other_side(scene, k);
    sides += other != k;
    ck_assert_uint_eq(hr2d_scene_other_side(scene, other), k);
  }
  ck_assert_uint_eq(sides, 4);
  hr2d_scene_destroy(scene);
}
END_TEST

/* τ = 1 scatters all that passes, which an opening does not. */
START_TEST(a_clear_scatterer_is_no_opening) {
  rooms r = grey(.3);
  r.emission[LEFT] = 1;
  r.reflectance[FRONT] = r.reflectance[BACK] = 0;
  r.transmittance = 1;
  hr2d_scene *scattered = make(&r), *open = test_new_scene(NULL);
  for (int k = 0; k < FRONT; k++) add(open, wall[k], r.emission[k], r.reflectance[k], 0);
  test_commit(open);
  hr2d_solution *s = solve_to(scattered, 1e-10, NULL), *t = solve_to(open, 1e-10, NULL);
  const hr2d_power p = hr2d_solution_power(s, 0);
  ck_assert_double_eq_tol(p.absorbed, p.emitted, 1e-13);
  /* Nothing is kept: what falls on one side leaves the other. */
  ck_assert_double_eq_tol(hr2d_solution_average(s, BACK, 0),
                          hr2d_solution_irradiance(s, FRONT, 0), 1e-14);
  ck_assert_double_ge(
      fabs(hr2d_solution_irradiance(s, RIGHT, 0) / hr2d_solution_irradiance(t, RIGHT, 0) - 1),
      .02);
  hr2d_solution_destroy(s);
  hr2d_solution_destroy(t);
  hr2d_scene_destroy(scattered);
  hr2d_scene_destroy(open);
}
END_TEST

/* Both trees have the same elements, also for the algorithm of the paper. */
START_TEST(both_sides_are_divided_alike) {
  rooms r = askew();
  hr2d_scene *scene = test_new_scene(NULL);
  add_rooms(scene, &r);
  add(scene, (hr2d_segment){{.9, .3}, {.8, .4}}, 0, .5, 0); /* near to the front alone */
  test_commit(scene);
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  test_refine(&t, .05, 12);
  size_t leaves[2] = {0, 0};
  const hr2d_element *e = hr2d_hierarchy_elements(t.hierarchy);
  for (uint32_t k = 0; k < hr2d_hierarchy_count(t.hierarchy).elements; k++) {
    if (e[k].child || e[k].patch < FRONT || e[k].patch > BACK) continue;
    leaves[e[k].patch - FRONT]++;
    const double at = 1 - (e[k].centre.y - e[FRONT].a.y) / (e[FRONT].b.y - e[FRONT].a.y);
    const uint32_t other = hr2d_hierarchy_leaf(t.hierarchy, (size_t)(FRONT + BACK) - e[k].patch,
                                               e[k].patch == FRONT ? at : 1 - at);
    ck_assert(e[other].a.y == e[k].b.y && e[other].b.y == e[k].a.y);
  }
  ck_assert_uint_eq(leaves[0], leaves[1]);
  ck_assert_uint_gt(leaves[0], 8);
  test_free_links(&t);
}
END_TEST

/* What a caller divides otherwise is refused, and united where that can be. */
START_TEST(sides_that_differ_are_refused) {
  const rooms r = askew();
  test_links t = test_make_links(make(&r), NULL, NULL, NULL, NULL);
  test_refine(&t, 2, 0);
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *s = NULL;
  ck_assert_int_eq(hr2d_hierarchy_divide(t.hierarchy, FRONT, .3, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(t.links, &options, &s), HR2D_ESTATE);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "both sides of a pane"));
  test_refine(&t, 2, 0); /* divides the back at .7 */
  ck_assert_int_eq(hr2d_solve(t.links, &options, &s), HR2D_OK);
  hr2d_solution_destroy(s);
  test_free_links(&t);
  t = test_make_links(make(&r), NULL, NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_hierarchy_divide(t.hierarchy, FRONT, .3, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_divide(t.hierarchy, BACK, .4, NULL), HR2D_OK);
  hr2d_refine_options coarse = test_options(2, 0);
  ck_assert_int_eq(hr2d_refine(t.links, &coarse), HR2D_EUNSUPPORTED);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "both sides of a pane"));
  test_free_links(&t);
}
END_TEST

/* Errors fall with ε, towards the answer of a target. */
START_TEST(the_paper_converges) {
  const rooms r = askew();
  hr2d_scene *scene = make(&r);
  hr2d_solution *exact = solve_to(scene, 1e-8, NULL);
  double off[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    test_links t = test_make_links(make(&r), NULL, NULL, NULL, NULL);
    test_refine(&t, k ? .02 : .3, 12);
    hr2d_solution *s = test_solve(&t, 1);
    for (size_t m = 0; m < WALLS; m++)
      off[k] =
          fmax(off[k],
               fabs(hr2d_solution_average(s, m, 0) / hr2d_solution_average(exact, m, 0) - 1));
    hr2d_solution_destroy(s);
    test_free_links(&t);
  }
  ck_assert_double_le(off[1], 1e-4);
  ck_assert_double_le(off[1], .1 * off[0]);
  hr2d_solution_destroy(exact);
  hr2d_scene_destroy(scene);
}
END_TEST

static void refuse(const hr2d_segment *at, const double *rho, const double *tau, size_t count,
                   const char *phrase) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < count; k++) add(scene, at[k], 0, rho[k], tau[k]);
  add(scene, (hr2d_segment){{0, 2}, {0, 0}}, 1, 0, 0);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  test_expect_message(scene, phrase);
  hr2d_scene_destroy(scene);
}

START_TEST(panes_that_cannot_be_are_refused) {
  const hr2d_segment sides[] = {{{1, 0}, {1, 1}}, {{1, 1}, {1, 0}}};
  const hr2d_segment shorter[] = {{{1, 0}, {1, 1}}, {{1, .9}, {1, 0}}};
  refuse(sides, (const double[]){.5, .5}, (const double[]){.4, .5}, 2, "both ways alike");
  refuse(sides, (const double[]){.5, .7}, (const double[]){.4, .4}, 2, "together above 1");
  refuse(sides, (const double[]){.5, .5}, (const double[]){.4, 0}, 2, "\"sides\": \"both\"");
  refuse(sides, (const double[]){.5}, (const double[]){.4}, 1, "\"sides\": \"both\"");
  refuse(shorter, (const double[]){.5, .5}, (const double[]){.4, .4}, 2, "the same ends");
  /* And those that just can. */
  rooms r = grey(.5);
  r.reflectance[FRONT] = r.reflectance[BACK] = .7;
  r.transmittance = .3;
  hr2d_scene_destroy(make(&r));
}
END_TEST

/* A component is both sides of its panes: a white room with a white pane loses its light if the
   room behind it does. */
START_TEST(light_has_somewhere_to_go) {
  for (int lost = 0; lost < 2; lost++) {
    rooms r = grey(1);
    r.emission[LEFT] = 1;
    r.reflectance[FRONT] = r.reflectance[BACK] = .4;
    r.transmittance = .6;
    if (lost) r.reflectance[RIGHT] = .9;
    hr2d_scene *scene = make(&r);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *s = NULL;
    target.error = 1e-6;
    const hr2d_status status = hr2d_solve_to(scene, &target, &s, NULL);
    ck_assert_int_eq(status, lost ? HR2D_OK : HR2D_ENO_SOLUTION);
    if (lost) ck_assert_double_eq_tol(-heat(s, RIGHT), 1, 1e-12);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A scene without panes pays nothing: with the effect forced no bit and no count changes. */
START_TEST(forced_panes_change_no_bit) {
  double b[2][8];
  hr2d_account account[2];
  for (int forced = 0; forced < 2; forced++) {
    hr2d_scene *scene = test_new_scene(NULL);
    rooms r = askew();
    r.transmittance = 0;
    add_rooms(scene, &r);
    add(scene, (hr2d_segment){{.3, .3}, {.6, .5}}, 0, .5, 0);
    if (forced) ck_assert_int_eq(hr2d_scene_force(scene, HR2D_EFFECT_PANES), HR2D_OK);
    test_commit(scene);
    ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_PANES, NULL), forced);
    hr2d_solution *s = solve_to(scene, 1e-6, &account[forced]);
    for (size_t k = 0; k < 8; k++) b[forced][k] = hr2d_solution_average(s, k, 0);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  ck_assert_mem_eq(b[0], b[1], sizeof b[0]);
  ck_assert_uint_eq(account[0].links, account[1].links);
  ck_assert_uint_eq(account[0].elements, account[1].elements);
  ck_assert(account[0].average.estimate == account[1].average.estimate);
  ck_assert(account[0].average.bound == account[1].average.bound);
}
END_TEST

/* The right half of a room with a pane across it, and the whole. */
START_TEST(images_have_panes) {
  double b[2][4];
  for (int whole = 0; whole < 2; whole++) {
    hr2d_scene *scene = test_new_scene(NULL);
    add(scene, (hr2d_segment){{whole ? -1 : 0, 0}, {1, 0}}, 1, .2, 0);
    add(scene, (hr2d_segment){{1, 2}, {whole ? -1 : 0, 2}}, 0, .4, 0);
    add(scene, (hr2d_segment){{1, 0}, {1, 2}}, .1, .3, 0);
    add(scene, (hr2d_segment){{.2, .7}, {.9, 1.1}}, 0, .3, .5);
    add(scene, (hr2d_segment){{.9, 1.1}, {.2, .7}}, 0, .2, .5);
    if (whole) {
      add(scene, (hr2d_segment){{-1, 2}, {-1, 0}}, .1, .3, 0);
      add(scene, (hr2d_segment){{-.9, 1.1}, {-.2, .7}}, 0, .3, .5);
      add(scene, (hr2d_segment){{-.2, .7}, {-.9, 1.1}}, 0, .2, .5);
    } else {
      ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 0}, {0, 1}}), HR2D_OK);
    }
    test_commit(scene);
    hr2d_solution *s = solve_to(scene, 1e-8, NULL);
    for (size_t k = 0; k < 4; k++) b[whole][k] = hr2d_solution_average(s, k + 1, 0);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  for (int k = 0; k < 4; k++) ck_assert_double_eq_tol(b[0][k], b[1][k], 2e-8 * b[1][k]);
}
END_TEST

/* Sun on a slanted screen: its edge of light is one on both sides.  The bound covers what a
   finer solve differs by. */
START_TEST(the_sun_shines_through) {
  const hr2d_sun sun = {{.3, -1}, 100};
  hr2d_scene *scene = test_new_scene(NULL);
  add(scene, (hr2d_segment){{0, 0}, {4, 0}}, 0, .3, 0);
  add(scene, (hr2d_segment){{4, 0}, {4, 2}}, 0, .5, 0);
  add(scene, (hr2d_segment){{0, 2}, {0, 0}}, 0, .5, 0);
  add(scene, (hr2d_segment){{0, 2}, {4, 2.5}}, 0, .3, .4);
  add(scene, (hr2d_segment){{4, 2.5}, {0, 2}}, 0, .3, .4);
  add(scene, (hr2d_segment){{4, 2.5}, {4, 2}}, 0, .5, 0);
  add(scene, (hr2d_segment){{1, 3}, {2, 3.2}}, 0, .3, 0);
  add(scene, (hr2d_segment){{2, 3.2}, {1, 3}}, 0, .3, 0);
  ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  test_commit(scene);
  hr2d_account account[2];
  hr2d_solution *s = solve_to(scene, 1e-3, &account[0]),
                *t = solve_to(scene, 1e-6, &account[1]);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const double b = hr2d_solution_average(t, k, 0);
    ck_assert_double_eq_tol(hr2d_solution_average(s, k, 0), b,
                            1e-12 + b * (account[0].average.bound + account[1].average.bound));
  }
  ck_assert_double_ge(hr2d_solution_irradiance(t, 0, 0), 10);
  hr2d_solution_destroy(s);
  hr2d_solution_destroy(t);
  hr2d_scene_destroy(scene);
}
END_TEST

/* No light of its own in the second room, and none that comes in but through the pane. */
START_TEST(light_reaches_what_is_behind) {
  rooms r = askew();
  r.reflectance[FRONT] = r.reflectance[BACK] = 0;
  hr2d_scene *scene = make(&r);
  hr2d_solution *s = solve_to(scene, 1e-4, NULL);
  for (size_t k = 0; k < WALLS; k++) ck_assert_double_gt(hr2d_solution_irradiance(s, k, 0), 0);
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(a_scene_as_bytes_keeps_panes) {
  const rooms r = askew();
  hr2d_scene *scene = make(&r), *copy = test_new_scene(NULL);
  tape t = {.until_failure = -1};
  ck_assert_int_eq(hr2d_state_write_scene(scene, tape_record, &t), HR2D_OK);
  ck_assert_int_eq(hr2d_state_read_scene(copy, tape_play, &t), HR2D_OK);
  for (size_t k = 0; k < WALLS; k++) {
    ck_assert(hr2d_scene_transmittance(copy, k, 0) == hr2d_scene_transmittance(scene, k, 0));
    ck_assert_uint_eq(hr2d_scene_other_side(copy, k), hr2d_scene_other_side(scene, k));
  }
  free(t.byte);
  hr2d_scene_destroy(scene);
  hr2d_scene_destroy(copy);
}
END_TEST

/* The kept operator has panes: other reflectances are those of another scene, and derivatives
   are differences. */
START_TEST(operators_have_panes) {
  rooms r = askew();
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_operator *op = NULL;
  hr2d_solution *s[3] = {NULL};
  target.error = 1e-9;
  hr2d_scene *scene = make(&r);
  ck_assert_int_eq(hr2d_operator_create(scene, &target, &op, NULL), HR2D_OK);
  double rho[2][WALLS], average[3];
  const double step = 1e-5;
  for (int k = 0; k < 2; k++) {
    memcpy(rho[k], r.reflectance, sizeof rho[k]);
    rho[k][FRONT] += k ? step : -step;
    hr2d_light light = HR2D_LIGHT_INIT;
    light.reflectance.value = rho[k];
    ck_assert_msg(hr2d_operator_solve(op, &light, NULL, &s[k], NULL) == HR2D_OK, "%s",
                  hr2d_operator_message(op));
    average[k] = hr2d_solution_average(s[k], RIGHT, 0);
    rooms same = r;
    same.reflectance[FRONT] = rho[k][FRONT];
    hr2d_scene *direct = make(&same);
    hr2d_solution *d = solve_to(direct, 1e-9, NULL);
    ck_assert_double_eq_tol(hr2d_solution_average(d, RIGHT, 0), average[k], 2e-9);
    hr2d_solution_destroy(d);
    hr2d_scene_destroy(direct);
  }
  hr2d_light light = HR2D_LIGHT_INIT;
  ck_assert_int_eq(hr2d_operator_solve(op, &light, NULL, &s[2], NULL), HR2D_OK);
  double by_rho[WALLS], v[WALLS] = {0};
  v[RIGHT] = 1;
  hr2d_gradient gradient = HR2D_GRADIENT_INIT;
  gradient.reflectance = by_rho;
  const hr2d_values weight = {.value = v};
  ck_assert_msg(hr2d_operator_gradient(op, s[2], &weight, NULL, &gradient) == HR2D_OK, "%s",
                hr2d_operator_message(op));
  ck_assert_double_eq_tol(by_rho[FRONT], (average[1] - average[0]) / (2 * step), 1e-6);
  for (int k = 0; k < 3; k++) hr2d_solution_destroy(s[k]);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("panes") {
  ADD_TESTS("values", a_lamp_shines_through, a_shield_is_a_pane, a_place_has_both_sides,
            corners_have_limits_of_both_sides, a_clear_scatterer_is_no_opening,
            the_paper_converges);
  REPEAT_TESTS(6, "one temperature", one_temperature_stays);
  ADD_TESTS("laws", exchange_is_the_same_both_ways, front_and_back_may_change_places,
            light_adds_up, pieces_are_the_pane, split_panes_keep_their_sides,
            both_sides_are_divided_alike, sides_that_differ_are_refused,
            forced_panes_change_no_bit);
  ADD_TESTS("scenes", panes_that_cannot_be_are_refused, light_has_somewhere_to_go,
            images_have_panes, the_sun_shines_through, light_reaches_what_is_behind,
            a_scene_as_bytes_keeps_panes, operators_have_panes);
}
