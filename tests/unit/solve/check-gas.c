/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms full of gas: published and independent values, equilibrium, balances, limits, and what
   a scene without gas does not notice.

   Reference values are of two programs that share nothing with the library: a dense Galerkin
   method over lines (order 10, corners graded to 1e-7) and a Nyström method over positions,
   which agree to 3e-13 or better; two are integrals in binary128. */
#include <math.h>
#include <string.h>

#include "base/legendre.h"
#include "support/support.h"

enum { WALLS = 6 };

/* A room by its corners, fronts inside. */
typedef struct room {
  size_t walls;
  hr2d_point corner[WALLS];
  double emission[WALLS], reflectance[WALLS];
  double kappa, gas; /* κ and E_g */
  hr2d_section section;
  int free; /* `gas` is the heat of the gas in the place of E_g */
} room;

#define SQUARE                                                                                 \
  4, {                                                                                         \
    {0, 0}, {1, 0}, {1, 1}, {                                                                  \
      0, 1                                                                                     \
    }                                                                                          \
  }
#define ELL                                                                                    \
  6, {                                                                                         \
    {0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {                                                  \
      0, 2                                                                                     \
    }                                                                                          \
  }

static void add_walls(hr2d_scene *scene, const room *r) {
  for (size_t k = 0; k < r->walls; k++)
    ck_assert_int_eq(test_add_patch(scene,
                                    (hr2d_segment){r->corner[k], r->corner[(k + 1) % r->walls]},
                                    r->emission[k], r->reflectance[k], HR2D_SIDES_FRONT),
                     HR2D_OK);
}

static hr2d_gas gas_of(const room *r) {
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = &r->kappa;
  gas.emission = &r->gas;
  gas.absorption_bands = gas.emission_bands = 1;
  gas.section = r->section;
  if (!r->free) return gas;
  gas.emission_bands = 0;
  gas.given = HR2D_HEAT_FLUX;
  gas.value = r->gas;
  return gas;
}

static hr2d_scene *draw(const room *r) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_gas gas = gas_of(r);
  add_walls(scene, r);
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* The heat that leaves a wall. */
static double heat_of(const hr2d_solution *s, const hr2d_scene *scene, size_t wall) {
  return hr2d_solution_net_flux(s, wall, 0) * hr2d_scene_length(scene, wall);
}

static double gas_emission(const hr2d_solution *s) {
  double emission;
  ck_assert_int_eq(hr2d_solution_gas(s, 0, 0, &emission, NULL), HR2D_OK);
  return emission;
}

static double gas_heat(const hr2d_solution *s) {
  double heat;
  ck_assert_int_eq(hr2d_solution_gas(s, 0, 0, NULL, &heat), HR2D_OK);
  return heat;
}

/* Rooms, the heat that leaves each wall, and that of the gas. */
static const struct known {
  const char *name;
  room room;
  double wall[WALLS], gas;
} known[] = {
    {"black, kappa 0.1",
     {SQUARE, {0}, {0}, 0.1, 1, HR2D_SECTION_LONG, 0},
     {-0.0932393659614304323, -0.0932393659614304323, -0.0932393659614304323,
      -0.0932393659614304323},
     4 * 0.0932393659614304323},
    {"black, kappa 1",
     {SQUARE, {0}, {0}, 1, 1, HR2D_SECTION_LONG, 0},
     {-0.570707619801953, -0.570707619801953, -0.570707619801953, -0.570707619801953},
     4 * 0.570707619801953},
    {"black, kappa 10",
     {SQUARE, {0}, {0}, 10, 1, HR2D_SECTION_LONG, 0},
     {-0.957553514470964324, -0.957553514470964324, -0.957553514470964324,
      -0.957553514470964324},
     4 * 0.957553514470964324},
    {"black, flat world",
     {SQUARE, {0}, {0}, 1, 1, HR2D_SECTION_FLAT, 0},
     {-0.512022299880412, -0.512022299880412, -0.512022299880412, -0.512022299880412},
     4 * 0.512022299880412},
    {"grey, cold",
     {SQUARE, {0}, {.5, .5, .5, .5}, 1, 1, HR2D_SECTION_LONG, 0},
     {-0.3622774630782, -0.3622774630782, -0.3622774630782, -0.3622774630782},
     1.4491098523128},
    {"floor of .8, cold gas",
     {SQUARE, {.8}, {.2, .5, .8, .5}, 1, 0, HR2D_SECTION_LONG, 0},
     {0.76536540548751, -0.074179499771803, -0.02223909341329, -0.074179499771803},
     -0.59476731253061},
    {"L, black",
     {ELL, {0}, {0}, 1, 1, HR2D_SECTION_LONG, 0},
     {-1.42628777506050, -0.64426900279886, -0.66658913013706, -0.66658913013706,
      -0.64426900279886, -1.42628777506050},
     5.4742918159928},
    {"oven",
     {4, {{0, 0}, {3, 0}, {3, 1}, {0, 1}}, {.16}, {.2, 1, 1, 1}, .25, 1, HR2D_SECTION_LONG, 0},
     {-1.207821110425, 0, 0, 0},
     1.207821110425}};

/* Rooms whose gas gets no heat, and E_g. */
static const struct known adiabatic[] = {
    {"left 1, right 0, else white",
     {SQUARE, {0, 0, 0, 1}, {1, 0, 1, 0}, 1, 0, HR2D_SECTION_LONG, 1},
     {0, -0.5356749890498, 0, 0.5356749890498},
     0.5},
    {"grey",
     {SQUARE, {0, 0, 0, .6}, {.5, .3, .5, .4}, .5, 0, HR2D_SECTION_LONG, 1},
     {-0.14245286164517, -0.20601040201602, -0.14245286164517, 0.49091612530637},
     0.26136291642156},
    {"L",
     {ELL, {0, .7}, {.4, .3, 1, 1, .5, .2}, .5, 0, HR2D_SECTION_LONG, 1},
     {-0.27088495399957, 0.57768344328803, 0, 0, -0.055094084234804, -0.25170440505365},
     0.16957696729213}};

START_TEST(gas_without_heat_finds_its_temperature) {
  double worst = 0;
  for (size_t n = 0; n < sizeof adiabatic / sizeof *adiabatic; n++) {
    const struct known *k = &adiabatic[n];
    hr2d_account account;
    hr2d_scene *scene = draw(&k->room);
    hr2d_solution *s = test_solve_to(scene, 1e-12, 1, &account);
    for (size_t w = 0; w < k->room.walls; w++)
      worst = fmax(worst, fabs(heat_of(s, scene, w) - k->wall[w]));
    worst = fmax(worst, fabs(gas_emission(s) - k->gas));
    ck_assert(gas_heat(s) == 0);
    ck_assert_msg(worst < 1e-12, "%s: off by %.2e", k->name, worst);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  printf("heat and E_g are off by at most %.1e\n", worst);
}
END_TEST

/* The E_g that is found, given, makes the same walls and the heat that was given. */
START_TEST(given_heat_and_given_temperature_agree) {
  for (int n = 0; n < 12; n++) {
    randoms draws = randoms_stream(test_seed() + 2, n);
    room r = {
        ELL, {.5}, {0}, random_power(&draws, -9, 2), random_unit(&draws), (hr2d_section)(n % 2),
        1};
    for (size_t w = 0; w < r.walls; w++) r.reflectance[w] = n % 3 ? random_unit(&draws) : w > 0;
    hr2d_account account;
    hr2d_scene *scene = draw(&r);
    hr2d_solution *s = test_solve_to(scene, 1e-9, 1, &account);
    room given = r;
    given.free = 0;
    given.gas = gas_emission(s);
    hr2d_scene *other = draw(&given);
    hr2d_solution *t = test_solve_to(other, 1e-9, 1, &account);
    ck_assert_double_eq_tol(gas_heat(t) / r.gas, 1, 1e-7);
    ck_assert(gas_heat(s) == r.gas);
    const hr2d_power p = hr2d_solution_power(s, 0);
    ck_assert_double_eq_tol(p.received, r.gas, 1e-13);
    ck_assert(p.escaped == 0);
    ck_assert_double_eq_tol(p.absorbed, p.emitted + p.received, 1e-12);
    for (size_t w = 0; w < r.walls; w++)
      ck_assert_double_eq_tol(hr2d_solution_irradiance(t, w, 0),
                              hr2d_solution_irradiance(s, w, 0), 1e-6);
    hr2d_solution_destroy(s);
    hr2d_solution_destroy(t);
    hr2d_scene_destroy(scene);
    hr2d_scene_destroy(other);
  }
}
END_TEST

/* Without a solution, and with heat in an open scene. */
static void expect_failure(const room *r, hr2d_status status, const char *phrase) {
  hr2d_account account;
  hr2d_solution *solution = NULL;
  hr2d_scene *scene = draw(r);
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, &account), status);
  ck_assert_msg(strstr(account.reason, phrase) != NULL, "%s", account.reason);
  hr2d_scene_destroy(scene);
}

START_TEST(gas_cannot_have_any_heat) {
  room r = {SQUARE, {.5}, {1, 1, 1, 1}, 1, 0, HR2D_SECTION_LONG, 1};
  expect_failure(&r, HR2D_ENO_SOLUTION, "nothing tells how hot it is");
  r.emission[0] = 0;
  r.gas = 1;
  expect_failure(&r, HR2D_ENO_SOLUTION, "nothing tells how hot it is");
  r.emission[0] = .5;
  r.reflectance[0] = .5;
  r.gas = -9;
  expect_failure(&r, HR2D_ENO_SOLUTION, "colder than 0 K");
  room open = {3, {{0, 0}, {1, 0}, {1, 1}}, {1}, {0}, 1, 0, HR2D_SECTION_LONG, 1};
  open.corner[2] = (hr2d_point){1, 1};
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_gas gas = gas_of(&open);
  for (size_t k = 0; k < 2; k++)
    ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){open.corner[k], open.corner[k + 1]},
                                    1, .5, HR2D_SIDES_FRONT),
                     HR2D_OK);
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
  test_commit(scene);
  hr2d_account account;
  hr2d_solution *solution = NULL;
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, &account), HR2D_EUNSUPPORTED);
  ck_assert_ptr_nonnull(strstr(account.reason, "the scene is open"));
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(rooms_of_independent_programs) {
  double worst = 0;
  for (size_t n = 0; n < sizeof known / sizeof *known; n++) {
    const struct known *k = &known[n];
    hr2d_account account;
    hr2d_scene *scene = draw(&k->room);
    hr2d_solution *s = test_solve_to(scene, 1e-12, 1, &account);
    for (size_t w = 0; w < k->room.walls; w++)
      worst = fmax(worst, fabs(heat_of(s, scene, w) - k->wall[w]));
    worst = fmax(worst, fabs(gas_heat(s) - k->gas));
    ck_assert_msg(worst < 1e-12, "%s: off by %.2e", k->name, worst);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  printf("heat is off by at most %.1e\n", worst);
}
END_TEST

/* Thick gas changes B beside corners over a depth of 1, and not elsewhere: elements follow. */
START_TEST(thick_gas_reaches_its_targets) {
  double worst = 0;
  for (double kappa = 20; kappa < 1e5; kappa *= 5)
    for (int hot = 0; hot < 2; hot++) {
      const room r = {
          ELL, {.3, 0, 1, 0, 0, .1}, {.5, .5, .9, 0, .8, .2}, kappa, hot, HR2D_SECTION_LONG, 0};
      hr2d_account account;
      hr2d_scene *scene = draw(&r);
      hr2d_solution *fine = test_solve_to(scene, 1e-10, 1, &account);
      hr2d_solution *s = test_solve_to(scene, 1e-4, 1, &account);
      double largest = 0;
      for (size_t w = 0; w < r.walls; w++)
        largest = fmax(largest, hr2d_solution_average(s, w, 0));
      for (size_t w = 0; w < r.walls; w++) {
        const double b = hr2d_solution_average(fine, w, 0);
        const double off = fabs(hr2d_solution_average(s, w, 0) - b);
        worst = fmax(worst, off / fmax(b, 1e-6 * largest) / account.average.bound);
      }
      hr2d_solution_destroy(s);
      hr2d_solution_destroy(fine);
      hr2d_scene_destroy(scene);
    }
  printf("B is off by at most %.2f of the bound\n", worst);
  ck_assert_double_lt(worst, 1);
}
END_TEST

/* What the account says is what the error is, at every target. */
START_TEST(bounds_hold_at_every_target) {
  for (size_t n = 4; n < sizeof known / sizeof *known; n++)
    for (double error = 1e-2; error > 1e-11; error *= 1e-3) {
      const struct known *k = &known[n];
      hr2d_account account;
      hr2d_scene *scene = draw(&k->room);
      hr2d_solution *s = test_solve_to(scene, error, 1, &account);
      double worst = 0, largest = 0;
      for (size_t w = 0; w < k->room.walls; w++)
        largest = fmax(largest, hr2d_solution_irradiance(s, w, 0));
      for (size_t w = 0; w < k->room.walls; w++) {
        const double loss = 1 - k->room.reflectance[w];
        if (!(loss > 0)) continue;
        const double exact =
            (k->room.emission[w] - k->wall[w] / hr2d_scene_length(scene, w)) / loss;
        const double h = hr2d_solution_irradiance(s, w, 0);
        worst = fmax(worst, (fabs(h - exact) - 1e-13) / fmax(h, 1e-6 * largest));
      }
      ck_assert_msg(worst <= account.irradiance.bound, "%s to %g: %g for a bound of %g",
                    k->name, error, worst, account.irradiance.bound);
      ck_assert_double_le(account.average.estimate, error);
      hr2d_solution_destroy(s);
      hr2d_scene_destroy(scene);
    }
}
END_TEST

/* Solves on the links of an oracle. */
static hr2d_solution *solve_by(test_links *t, const room *r, unsigned order, double epsilon) {
  *t = test_make_links(draw(r), hr2d_oracle_size(), NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t->hierarchy, order), HR2D_OK);
  test_refine(t, epsilon, 12);
  return test_solve(t, HR2D_CLOSURE_ON);
}

/* Walls, gas and everything of one temperature; some walls are white. */
START_TEST(equilibrium_is_exact_on_any_elements) {
  static const unsigned orders[] = {1, 2, 3, 5, 9};
  double worst = 0, control = 0;
  for (int n = 0; n < 40; n++) {
    randoms draws = randoms_stream(test_seed(), n);
    room r = {ELL, {0}, {0}, random_power(&draws, -12, 6), 2, (hr2d_section)(n % 2), 0};
    if (n % 3 == 1) { /* no heat goes to gas of the temperature of the walls */
      r.free = 1;
      r.gas = 0;
    }
    for (size_t w = 0; w < r.walls; w++) {
      r.reflectance[w] = n % 4 == 0 && w > 0 ? 1 : random_unit(&draws);
      r.emission[w] = 2 * (1 - r.reflectance[w]);
    }
    test_links t;
    hr2d_solution *s =
        solve_by(&t, &r, orders[n % 5], n % 5 == 0 ? 0.5 : random_between(&draws, 0.5, 3));
    for (size_t w = 0; w < r.walls; w++) {
      worst = fmax(worst, fabs(hr2d_solution_average(s, w, 0) / 2 - 1));
      worst = fmax(worst, fabs(hr2d_solution_irradiance(s, w, 0) / 2 - 1));
    }
    ck_assert_double_lt(fabs(gas_heat(s)), 1e-13);
    ck_assert_double_eq_tol(gas_emission(s), 2, 2e-13);
    hr2d_solution_destroy(s);
    test_free_links(&t);
    /* a coarse target ends iterations early */
    hr2d_account account;
    hr2d_scene *scene = draw(&r);
    s = test_solve_to(scene, 1e-3, 1, &account);
    for (size_t w = 0; w < r.walls; w++)
      worst = fmax(worst, fabs(hr2d_solution_irradiance(s, w, 0) / 2 - 1));
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
    /* negative control: gas of another temperature is seen, if it is not too thin */
    if (r.kappa < 1e-3) continue;
    r.free = 0;
    r.gas = 2.2;
    s = solve_by(&t, &r, orders[n % 5], 1);
    control = fmax(control, fabs(hr2d_solution_irradiance(s, 0, 0) / 2 - 1));
    hr2d_solution_destroy(s);
    test_free_links(&t);
  }
  printf("B and H are off by at most %.1e; otherwise by %.1e\n", worst, control);
  ck_assert_double_lt(worst, 1e-13);
  ck_assert_double_gt(control, 1e-2);
}
END_TEST

/* Thin gas loses 4κV E_g, or πκV E_g, with V the area of the room.  Rows of what arrives and of
   what is absorbed close even with wrong chords: this does not. */
START_TEST(thin_gas_emits_by_its_volume) {
  for (int flat = 0; flat < 2; flat++)
    for (double kappa = 1e-4; kappa > 1e-13; kappa *= 1e-2) {
      const double emitted = (flat ? 3.14159265358979323846 : 4) * kappa * 3;
      const room r = {ELL, {0}, {0}, kappa, 1, (hr2d_section)flat, 0};
      hr2d_account account;
      hr2d_scene *scene = draw(&r);
      hr2d_solution *s = test_solve_to(scene, 1e-12, 1, &account);
      const double off = gas_heat(s) / emitted - 1;
      /* chords are shorter than 3, and so are the means of them that gas makes of itself */
      ck_assert_double_lt(fabs(off), 2 * kappa + 1e-14);
      if (kappa > 1e-5) ck_assert_double_gt(fabs(off), 0.1 * kappa);
      /* the walls get it, with as many digits */
      double arrives = 0;
      for (size_t w = 0; w < r.walls; w++) arrives -= heat_of(s, scene, w);
      ck_assert_double_eq_tol(arrives / gas_heat(s), 1, 1e-13);
      hr2d_solution_destroy(s);
      hr2d_scene_destroy(scene);
    }
}
END_TEST

/* White walls and one that is black: all heat of thin gas ends there, after many reflections.
 */
START_TEST(thin_gas_between_white_walls_keeps_its_digits) {
  for (double kappa = 1e-3; kappa > 1e-13; kappa *= 1e-3) {
    const room r = {SQUARE, {0}, {0, 1, 1, 1}, kappa, 1, HR2D_SECTION_LONG, 0};
    hr2d_account account;
    hr2d_scene *scene = draw(&r);
    hr2d_solution *s = test_solve_to(scene, 1e-9, 1, &account);
    ck_assert_double_eq_tol(-heat_of(s, scene, 0) / gas_heat(s), 1, 1e-12);
    ck_assert_double_eq_tol(gas_heat(s) / (4 * kappa), 1, 10 * kappa + 1e-9);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(powers_balance) {
  double worst = 0;
  for (int n = 0; n < 30; n++) {
    randoms draws = randoms_stream(test_seed() + 1, n);
    room r = {
        ELL, {0}, {0}, random_power(&draws, -9, 4), random_unit(&draws), (hr2d_section)(n % 2),
        0};
    for (size_t w = 0; w < r.walls; w++) {
      r.reflectance[w] = random_below(&draws, 4) ? random_unit(&draws) : 1;
      r.emission[w] = random_below(&draws, 2) ? random_unit(&draws) : 0;
    }
    test_links t;
    hr2d_solution *s = solve_by(&t, &r, 1 + (unsigned)n % 6, 1);
    const hr2d_power p = hr2d_solution_power(s, 0);
    const double in = p.emitted + p.received;
    worst = fmax(worst, fabs(p.absorbed + p.escaped - in) / in);
    ck_assert_double_eq_tol(gas_heat(s), p.received - p.escaped, 1e-13 * in);
    hr2d_solution_destroy(s);
    test_free_links(&t);
  }
  printf("powers are off by at most %.1e\n", worst);
  ck_assert_double_lt(worst, 1e-13);
}
END_TEST

/* κ → ∞: walls see the gas beside them. */
START_TEST(thick_gas_is_a_black_body) {
  const room r = {ELL, {.3, 0, 0, 0, 0, .1}, {.1, .5, .9, 0, 1, .2}, 1e9, 2, HR2D_SECTION_LONG,
                  0};
  hr2d_account account;
  hr2d_scene *scene = draw(&r);
  hr2d_solution *s = test_solve_to(scene, 1e-10, 1, &account);
  for (size_t w = 0; w < r.walls; w++) {
    ck_assert_double_eq_tol(hr2d_solution_irradiance(s, w, 0), 2, 1e-8);
  }
  ck_assert_double_gt(fabs(hr2d_solution_irradiance(s, 0, 0) - 2), 1e-12); /* corners */
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Two black plates in an ocean of gas: H of one is 1 where the other is as hot as the gas, and
   otherwise less by the exchange area. */
START_TEST(open_scenes_end_in_gas) {
  const double lengths[] = {1, 0.1};
  for (size_t n = 0; n < 2; n++) {
    const double kappa = 1 / lengths[n];
    const double patch[2][6] = {{0, 0, 1, 0, 0, 0}, {1, 0.5, 0, 0.5, 0, 0}};
    hr2d_scene *scene = test_new_scene(NULL);
    hr2d_gas gas = HR2D_GAS_INIT;
    const double one = 1;
    for (size_t k = 0; k < 2; k++)
      ck_assert_int_eq(
          test_add_patch(scene,
                         (hr2d_segment){{patch[k][0], patch[k][1]}, {patch[k][2], patch[k][3]}},
                         k == 0, 0, HR2D_SIDES_FRONT),
          HR2D_OK);
    gas.absorption = &kappa;
    gas.emission = &one;
    gas.absorption_bands = gas.emission_bands = 1;
    ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
    test_commit(scene);
    hr2d_account account;
    hr2d_solution *s = test_solve_to(scene, 1e-12, 1, &account);
    /* the upper plate sees B = 1 and gas; the lower one misses what the upper does not send */
    ck_assert_double_eq_tol(hr2d_solution_irradiance(s, 1, 0), 1, 1e-13);
    const double missed = 1 - hr2d_solution_irradiance(s, 0, 0);
    hr2d_hierarchy *h;
    hr2d_link link = {.pair = {0, 1}};
    double area;
    ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
    link.exchange_area = 1;
    ck_assert_int_eq(hr2d_blocks(h, &link, 1, &area), HR2D_OK);
    ck_assert_double_eq_tol(missed, area, 1e-13);
    ck_assert_double_gt(area, 1e-4);
    hr2d_hierarchy_destroy(h);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* H at points has the averages that lines have, and everything of one temperature has no other.
 */
START_TEST(points_see_through_gas) {
  double worst = 0, control = 0;
  for (int n = 0; n < 12; n++) {
    randoms draws = randoms_stream(test_seed() + 4, n);
    const int isothermal = n % 3 == 0, black = n % 3 == 1;
    room r = {ELL, {0}, {0}, random_power(&draws, -8, n % 2 ? 1 : 3), 2, (hr2d_section)(n % 2),
              0};
    for (size_t w = 0; w < r.walls; w++) {
      r.reflectance[w] = black ? 0 : random_unit(&draws);
      r.emission[w] = isothermal ? 2 * (1 - r.reflectance[w]) : random_unit(&draws);
    }
    hr2d_account account;
    hr2d_scene *scene = draw(&r);
    hr2d_solution *s = test_solve_to(scene, 1e-10, 1, &account);
    for (size_t w = 0; w < r.walls; w++) {
      enum { PANELS = 12, POINTS = 16 };
      double sum = 0;
      hr2di_rule rule;
      hr2di_rule_init(&rule, POINTS);
      for (int end = 0; end < 2; end++)
        for (int k = 0; k < PANELS; k++) { /* graded to both ends */
          const double high = ldexp(0.5, -2 * k), low = k + 1 < PANELS ? high / 4 : 0;
          for (size_t q = 0; q < POINTS; q++) {
            const double at = low + (high - low) * (0.5 + 0.5 * rule.at[q]);
            const double t = end ? 1 - at : at;
            double h;
            ck_assert_int_eq(hr2d_solution_gather_irradiance(s, w, &t, 1, &h), HR2D_OK);
            sum += (high - low) * rule.weight[q] * h;
            if (isothermal) ck_assert_double_eq_tol(h, 2, 1e-10);
          }
        }
      const double h = hr2d_solution_irradiance(s, w, 0);
      /* the views of the L change at one point of some walls */
      worst = fmax(worst, fabs(sum / h - 1) / (w == 0 || w == 5 ? 1e-4 : 1e-8));
      control = fmax(control, fabs(hr2d_solution_irradiance_at(s, w, 0.01, 0) / h - 1));
    }
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
  printf("averages of points are off by at most %.2g of what is allowed\n", worst);
  ck_assert_double_lt(worst, 1);
  ck_assert_double_gt(control, 1e-2);
}
END_TEST

/* The heat of the gas is 4κ(E_g − M) at each point of it, or πκ(E_g − M); by a rule over a
   square, a quarter of it graded to its corner. */
static double heat_by_field(const hr2d_solution *s, double kappa, double factor) {
  enum { PANELS = 4, POINTS = 8 };
  double sum = 0;
  hr2di_rule rule;
  hr2di_rule_init(&rule, POINTS);
  const double gas = gas_emission(s);
  for (int k = 0; k < PANELS * PANELS * 4; k++) {
    const int i = k % PANELS, j = k / PANELS % PANELS, corner = k / (PANELS * PANELS);
    const double x1 = ldexp(0.5, -2 * i), x0 = i + 1 < PANELS ? x1 / 4 : 0;
    const double y1 = ldexp(0.5, -2 * j), y0 = j + 1 < PANELS ? y1 / 4 : 0;
    for (size_t q = 0; q < POINTS * POINTS; q++) {
      const double x = x0 + (x1 - x0) * (0.5 + 0.5 * rule.at[q % POINTS]);
      const double y = y0 + (y1 - y0) * (0.5 + 0.5 * rule.at[q / POINTS]);
      const hr2d_point at = {corner % 2 ? 1 - x : x, corner / 2 ? 1 - y : y};
      double mean;
      hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
      values.mean = &mean;
      ck_assert_int_eq(hr2d_field_at(s, &at, 1, NULL, &values), HR2D_OK);
      sum += (x1 - x0) * (y1 - y0) * rule.weight[q % POINTS] * rule.weight[q / POINTS] *
             (gas - mean);
    }
  }
  return factor * kappa * sum;
}

START_TEST(the_field_has_the_heat_of_the_gas) {
  for (int n = 0; n < 6; n++) {
    const int flat = n % 2, free = n == 4;
    const room r = {SQUARE,
                    {.3, 1, 0, 0},
                    {.1, .5, .9, 0},
                    n < 2   ? 1e-6
                    : n < 4 ? 1
                            : 3,
                    free ? 0 : 0.7,
                    (hr2d_section)flat,
                    free};
    hr2d_account account;
    hr2d_scene *scene = draw(&r);
    hr2d_solution *s = test_solve_to(scene, 1e-9, 1, &account);
    const double factor = flat ? 3.14159265358979323846 : 4;
    const double by_field = heat_by_field(s, r.kappa, factor);
    ck_assert_double_eq_tol(by_field / r.kappa, gas_heat(s) / r.kappa, 3e-6);
    /* negative control: the other section */
    if (!free)
      ck_assert_double_gt(fabs(by_field * (4 - 0.8 * !flat) / factor - gas_heat(s)) / r.kappa,
                          1e-3);
    /* beside a wall the flux into it is H − B */
    const double middle = 0.5;
    const hr2d_point at = {0.5, 0};
    double flux[2], h, b;
    hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
    values.flux = flux;
    ck_assert_int_eq(hr2d_field_at(s, &at, 1, NULL, &values), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(s, 0, &middle, 1, &h), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather(s, 0, &middle, 1, &b), HR2D_OK);
    ck_assert_double_eq_tol(fabs(flux[1]), fabs(h - b), 1e-5);
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Half a room at a mirror is the room. */
START_TEST(mirrors_stand_in_gas) {
  for (int n = 0; n < 12; n++) {
    randoms draws = randoms_stream(test_seed() + 3, n);
    const double top = 0.5 + random_unit(&draws), tip = 0.5 + random_unit(&draws);
    room r = {6,
              {{0, 0}, {1, 0}, {1, top}, {0, tip}, {-1, top}, {-1, 0}},
              {0},
              {0},
              random_power(&draws, -6, 2),
              random_unit(&draws),
              (hr2d_section)(n % 2),
              n % 3 == 0};
    static const size_t image[] = {5, 4, 3};
    for (size_t w = 0; w < 3; w++) {
      r.emission[w] = r.emission[image[w]] = w == 1 || n % 2 ? random_unit(&draws) : 0;
      r.reflectance[w] = r.reflectance[image[w]] = random_unit(&draws);
    }
    /* the floor is two patches: (0,0) to (1,0), and (−1,0) to (0,0) */
    hr2d_account account;
    hr2d_scene *whole = draw(&r), *half = test_new_scene(NULL);
    hr2d_gas gas = gas_of(&r);
    if (r.free) gas.value = r.gas / 2;
    for (size_t w = 0; w < 3; w++)
      ck_assert_int_eq(test_add_patch(half, (hr2d_segment){r.corner[w], r.corner[w + 1]},
                                      r.emission[w], r.reflectance[w], HR2D_SIDES_FRONT),
                       HR2D_OK);
    ck_assert_int_eq(hr2d_scene_add_gas(half, &gas, NULL), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_add_mirror(half, (hr2d_segment){{0, 0}, {0, 1}}), HR2D_OK);
    test_commit(half);
    hr2d_solution *s = test_solve_to(whole, 1e-9, 1, &account),
                  *t = test_solve_to(half, 1e-9, 1, &account);
    for (size_t w = 0; w < 3; w++)
      ck_assert_double_eq_tol(
          hr2d_solution_irradiance(t, w, 0) / hr2d_solution_irradiance(s, w, 0), 1, 1e-8);
    ck_assert_double_eq_tol(2 * gas_heat(t), gas_heat(s), 1e-8);
    ck_assert_double_eq_tol(gas_emission(t), gas_emission(s), 1e-8);
    const hr2d_power p = hr2d_solution_power(t, 0);
    ck_assert_double_eq_tol(p.absorbed + p.escaped, p.emitted + p.received, 1e-13);
    hr2d_solution_destroy(s);
    hr2d_solution_destroy(t);
    hr2d_scene_destroy(whole);
    hr2d_scene_destroy(half);
  }
}
END_TEST

/* Every bit and every counter. */
static void expect_same(const room *r, const hr2d_gas *gas, int forces) {
  hr2d_account account[2];
  hr2d_solution *s[2];
  hr2d_scene *scene[2];
  for (int k = 0; k < 2; k++) {
    scene[k] = test_new_scene(NULL);
    add_walls(scene[k], r);
    if (k && gas) ck_assert_int_eq(hr2d_scene_add_gas(scene[k], gas, NULL), HR2D_OK);
    if (k && forces) ck_assert_int_eq(hr2d_scene_force(scene[k], HR2D_EFFECT_MEDIUM), HR2D_OK);
    test_commit(scene[k]);
    s[k] = test_solve_to(scene[k], 1e-9, 1, &account[k]);
  }
  ck_assert_uint_eq(hr2d_solution_field_size(s[0]), hr2d_solution_field_size(s[1]));
  ck_assert(!memcmp(hr2d_solution_field(s[0]), hr2d_solution_field(s[1]),
                    hr2d_solution_field_size(s[0]) * sizeof(double)));
  ck_assert_uint_eq(account[0].kernels, account[1].kernels);
  ck_assert_uint_eq(account[0].links, account[1].links);
  ck_assert_uint_eq(account[0].elements, account[1].elements);
  ck_assert(account[0].average.bound == account[1].average.bound);
  const hr2d_solve_work w = hr2d_solution_work(s[0]), v = hr2d_solution_work(s[1]);
  ck_assert_uint_eq(w.gathers, v.gathers);
  ck_assert_uint_eq(w.row_sums, v.row_sums);
  for (int k = 0; k < 2; k++) {
    hr2d_solution_destroy(s[k]);
    hr2d_scene_destroy(scene[k]);
  }
}

START_TEST(no_gas_changes_no_bit) {
  const room r = {ELL, {1, 0, 0, 0, 0, 0}, {.2, .5, .8, .3, .9, .4}, 0, 3, HR2D_SECTION_LONG,
                  0};
  hr2d_gas gas = gas_of(&r);
  expect_same(&r, &gas, 0);
  expect_same(&r, &gas, 1);
  expect_same(&r, NULL, 1);
  /* negative control: a little gas changes some */
  room thin = r;
  thin.kappa = 1e-6;
  hr2d_account account;
  hr2d_scene *scene = draw(&thin), *clear = draw(&r);
  hr2d_solution *s = test_solve_to(scene, 1e-9, 1, &account),
                *t = test_solve_to(clear, 1e-9, 1, &account);
  ck_assert(hr2d_solution_average(s, 2, 0) != hr2d_solution_average(t, 2, 0));
  hr2d_solution_destroy(s);
  hr2d_solution_destroy(t);
  hr2d_scene_destroy(scene);
  hr2d_scene_destroy(clear);
}
END_TEST

START_TEST(threads_change_no_bit) {
  const room *r = &known[6].room;
  room grey = *r;
  for (size_t w = 0; w < grey.walls; w++) grey.reflectance[w] = 0.5;
  hr2d_account account;
  hr2d_scene *scene = draw(&grey);
  hr2d_solution *one = test_solve_to(scene, 1e-10, 1, &account);
  hr2d_solution *four = test_solve_to(scene, 1e-10, 4, &account);
  ck_assert_uint_eq(hr2d_solution_field_size(one), hr2d_solution_field_size(four));
  ck_assert(!memcmp(hr2d_solution_field(one), hr2d_solution_field(four),
                    hr2d_solution_field_size(one) * sizeof(double)));
  ck_assert(gas_heat(one) == gas_heat(four));
  hr2d_solution_destroy(one);
  hr2d_solution_destroy(four);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("gas") {
  ADD_TESTS("values", rooms_of_independent_programs, bounds_hold_at_every_target,
            thick_gas_reaches_its_targets, open_scenes_end_in_gas);
  ADD_TESTS("heat", gas_without_heat_finds_its_temperature,
            given_heat_and_given_temperature_agree, gas_cannot_have_any_heat);
  ADD_TESTS("balance", equilibrium_is_exact_on_any_elements, powers_balance);
  ADD_TESTS("limits", thin_gas_emits_by_its_volume,
            thin_gas_between_white_walls_keeps_its_digits, thick_gas_is_a_black_body);
  ADD_TESTS("points", points_see_through_gas, the_field_has_the_heat_of_the_gas);
  ADD_TESTS("images", mirrors_stand_in_gas);
  ADD_TESTS("bits", no_gas_changes_no_bit, threads_change_no_bit);
}
