/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gas that absorbs more in one band than in another: each band is as in a scene of its own; and
   weights, by which bands divide the emission of black bodies. */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "scene/scene-impl.h"
#include "support/support.h"

enum { BANDS = 4, PATCHES = 6, FRONTS = 7, CASES = 6 };

/* Light and gas of all bands. */
typedef struct spectrum {
  double kappa[BANDS], hot[BANDS], background[BANDS];
  double emission[PATCHES][BANDS], reflectance[PATCHES][BANDS], transmittance[BANDS];
  int grey; /* the first κ is that of all bands, and is given once */
} spectrum;

static spectrum draw_spectrum(int n) {
  randoms r = randoms_stream(test_seed(), n);
  spectrum s = {{0}, {0}, {0}, {{0}}, {{0}}, {0}, 0};
  for (size_t b = 0; b < BANDS; b++) {
    s.kappa[b] = b == 1 ? 0 : random_power(&r, -3, 1.5);
    s.hot[b] = random_unit(&r);
    s.transmittance[b] = 0.3 * random_unit(&r);
    for (size_t k = 0; k < PATCHES; k++) {
      s.emission[k][b] = random_below(&r, 2) ? random_unit(&r) : 0;
      s.reflectance[k][b] = 0.7 * random_unit(&r);
    }
  }
  s.kappa[3] = s.kappa[0]; /* they share blocks */
  if (n % 2) s.background[1] = random_unit(&r);
  return s;
}

/* A room, open for odd numbers, with an obstacle and a pane, in so many bands from one on. */
static hr2d_scene *draw(const spectrum *s, int n, size_t from, size_t bands) {
  const hr2d_segment at[PATCHES] = {{{0, 0}, {3, 0}},     {{3, 0}, {3, 2}},
                                    {{3, 2}, {0, 2}},     {{0, 2}, {0, 0.1}},
                                    {{1, 0.6}, {2, 0.8}}, {{0.4, 1.2}, {1.2, 1.7}}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = n % 2; k < PATCHES; k++) {
    hr2d_patch p = HR2D_PATCH_INIT;
    p.a = at[k].a;
    p.b = at[k].b;
    p.emission = s->emission[k] + from;
    p.reflectance = s->reflectance[k] + from;
    p.emission_bands = p.reflectance_bands = bands;
    p.sides = k >= 4 ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT;
    if (k == 5) {
      p.transmittance = s->transmittance + from;
      p.transmittance_bands = bands;
    }
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = s->kappa + from;
  gas.emission = s->hot + from;
  gas.absorption_bands = s->grey ? 1 : bands;
  gas.emission_bands = bands;
  gas.section = n % 3 ? HR2D_SECTION_LONG : HR2D_SECTION_FLAT;
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, s->background + from, bands), HR2D_OK);
  test_commit(scene);
  return scene;
}

static void expect_near(double is, double right, double scale, double error, const char *what) {
  ck_assert_msg(fabs(is - right) <= error * scale, "%s: %.17g, not %.17g", what, is, right);
}

/* One band of a solution is that of a scene which has nothing else. */
static void expect_band(const hr2d_solution *all, size_t band, const hr2d_solution *one,
                        size_t patches, double error) {
  double emission[2], heat[2], scale = 0;
  const double at[] = {0.1, 0.5, 0.9};
  const hr2d_point inside = {0.5, 0.7};
  for (size_t k = 0; k < patches; k++)
    scale = fmax(scale, hr2d_solution_irradiance(one, k, 0) + hr2d_solution_average(one, k, 0));
  for (size_t k = 0; k < patches; k++) {
    double field[3 * BANDS], alone[3];
    expect_near(hr2d_solution_average(all, k, band), hr2d_solution_average(one, k, 0), scale,
                error, "B");
    expect_near(hr2d_solution_irradiance(all, k, band), hr2d_solution_irradiance(one, k, 0),
                scale, error, "H");
    ck_assert_int_eq(hr2d_solution_gather_irradiance(all, k, at, 3, field), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(one, k, at, 3, alone), HR2D_OK);
    for (size_t m = 0; m < 3; m++)
      expect_near(field[m * BANDS + band], alone[m], scale, 30 * error, "H at a point");
  }
  ck_assert_int_eq(hr2d_solution_gas(all, 0, band, &emission[0], &heat[0]), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_gas(one, 0, 0, &emission[1], &heat[1]), HR2D_OK);
  expect_near(heat[0], heat[1], 9 * scale, error, "heat");
  const hr2d_power p = hr2d_solution_power(all, band), q = hr2d_solution_power(one, 0);
  expect_near(p.absorbed, q.absorbed, 9 * scale, error, "absorbed power");
  expect_near(p.received, q.received, 9 * scale, error, "received power");
  double mean[BANDS], alone;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  values.mean = mean;
  ck_assert_int_eq(hr2d_field_at(all, &inside, 1, NULL, &values), HR2D_OK);
  values.mean = &alone;
  ck_assert_int_eq(hr2d_field_at(one, &inside, 1, NULL, &values), HR2D_OK);
  expect_near(mean[band], alone, scale, 30 * error, "M");
}

START_TEST(bands_are_scenes_of_their_own) {
  double differs = 0;
  for (int n = 0; n < test_count(4 * CASES); n++) {
    const spectrum s = draw_spectrum(n);
    hr2d_account account, of_one;
    hr2d_scene *scene = draw(&s, n, 0, BANDS);
    const size_t patches = hr2d_scene_patches(scene);
    hr2d_solution *all = test_solve_to(scene, 1e-9, 1, &account);
    for (size_t b = 0; b < BANDS; b++) {
      hr2d_scene *alone = draw(&s, n, b, 1);
      hr2d_solution *one = test_solve_to(alone, 1e-9, 1, &of_one);
      expect_band(all, b, one, patches, 2e-9);
      differs = fmax(differs, fabs(hr2d_solution_average(all, 0, (b + 1) % BANDS) -
                                   hr2d_solution_average(one, 0, 0)));
      hr2d_solution_destroy(one);
      hr2d_scene_destroy(alone);
    }
    hr2d_solution_destroy(all);
    hr2d_scene_destroy(scene);
  }
  ck_assert_double_gt(differs, 1e-3); /* negative control */
}
END_TEST

static void expect_same_bits(const hr2d_solution *a, const hr2d_solution *b) {
  ck_assert_uint_eq(hr2d_solution_field_size(a), hr2d_solution_field_size(b));
  ck_assert(!memcmp(hr2d_solution_field(a), hr2d_solution_field(b),
                    hr2d_solution_field_size(a) * sizeof(double)));
}

START_TEST(threads_and_equal_bands_change_no_bit) {
  spectrum s = draw_spectrum(0), even = s;
  hr2d_account account;
  hr2d_scene *scene = draw(&s, 0, 0, BANDS);
  hr2d_solution *one = test_solve_to(scene, 1e-8, 1, &account),
                *four = test_solve_to(scene, 1e-8, 4, &account);
  expect_same_bits(one, four);
  hr2d_solution_destroy(one);
  hr2d_solution_destroy(four);
  hr2d_scene_destroy(scene);
  /* κ in each band, or once. */
  for (size_t b = 0; b < BANDS; b++) even.kappa[b] = 0.5;
  scene = draw(&even, 0, 0, BANDS);
  one = test_solve_to(scene, 1e-8, 1, &account);
  even.grey = 1;
  hr2d_scene *other = draw(&even, 0, 0, BANDS);
  four = test_solve_to(other, 1e-8, 1, &account);
  expect_same_bits(one, four);
  hr2d_solution_destroy(one);
  hr2d_solution_destroy(four);
  hr2d_scene_destroy(scene);
  hr2d_scene_destroy(other);
}
END_TEST

/* By how much a band of a grid is off, as a part of its range. */
static double grid_error(const double *exact, const double *near, size_t nodes, size_t band) {
  double least = HUGE_VAL, most = 0, off = 0;
  for (size_t k = band; k < nodes * BANDS; k += BANDS) {
    ck_assert_int_eq(isnan(exact[k]), isnan(near[k]));
    if (isnan(exact[k])) continue;
    least = fmin(least, exact[k]);
    most = fmax(most, exact[k]);
    off = fmax(off, fabs(exact[k] - near[k]));
  }
  return off / (most - least + 1e-12 * most);
}

/* Nodes are interpolated between borders of light, which gas makes where all walls are as
   bright, too; order 1 has many leaves that are taken as a whole. */
START_TEST(grids_are_within_their_tolerance) {
  enum { WIDE = 64, HIGH = 47, NODES = WIDE * HIGH };
  static double exact[NODES * BANDS], near[NODES * BANDS];
  double worst = 0;
  uint64_t interpolated = 0;
  for (int n = 0; n < test_count(2 * CASES); n++) {
    spectrum s = draw_spectrum(n);
    for (size_t k = 0; k < PATCHES * BANDS; k++) {
      const size_t p = k / BANDS, b = k % BANDS;
      s.reflectance[p][b] *= n % 4 < 3 ? 0.3 : 0; /* few links may reflect too much */
      if (n % 4 == 3) s.emission[p][b] = 1;
    }
    test_links links = test_make_links(draw(&s, n, 0, BANDS), NULL, NULL, NULL, NULL);
    ck_assert_int_eq(hr2d_hierarchy_set_order(links.hierarchy, n % 3 ? 1 : 4), HR2D_OK);
    test_refine(&links, 0.1, 24);
    hr2d_solution *solution = test_solve(&links, 0);
    hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
    hr2d_field_counts counts;
    hr2d_field_grid grid = {sizeof grid, {-0.1, -0.2}, {3.1, 2.1}, WIDE, HIGH, 0};
    values.mean = exact;
    ck_assert_int_eq(hr2d_field_on_grid(solution, &grid, NULL, &values, NULL), HR2D_OK);
    for (grid.tolerance = 1e-2; grid.tolerance > 1e-4; grid.tolerance /= 4) {
      values.mean = near;
      ck_assert_int_eq(hr2d_field_on_grid(solution, &grid, NULL, &values, &counts), HR2D_OK);
      interpolated += counts.interpolated;
      for (size_t b = 0; b < BANDS; b++) {
        const double part = grid_error(exact, near, NODES, b) / grid.tolerance;
        ck_assert_msg(part <= 1, "case %d, band %zu: %g of %g", n, b, part, grid.tolerance);
        worst = fmax(worst, part);
      }
    }
    hr2d_solution_destroy(solution);
    test_free_links(&links);
  }
  printf("nodes are off by at most %.2f of the tolerance, %" PRIu64 " of them interpolated\n",
         worst, interpolated);
  ck_assert_double_gt(worst, 0.2); /* negative control: it was made use of */
  ck_assert_uint_gt(interpolated, 0);
}
END_TEST

/* Bands that share an absorption have numbers of their own inside: messages do not say these.
 */
START_TEST(messages_have_the_numbers_of_bands) {
  const hr2d_point corner[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  double kappa[2] = {0.5, 0};
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_gas gas = HR2D_GAS_INIT;
  hr2d_solution *solution = NULL;
  gas.absorption = kappa;
  gas.absorption_bands = 2;
  for (size_t k = 0; k < 4; k++) {
    const hr2d_segment at = {corner[k], corner[(k + 1) % 4]};
    ck_assert_int_eq(test_add_patch(scene, at, 1, 1, HR2D_SIDES_FRONT), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
  test_commit(scene);
  test_links links = test_make_links(scene, NULL, NULL, NULL, NULL);
  test_refine(&links, 0.5, 24);
  ck_assert_int_eq(hr2d_solve(links.links, NULL, &solution), HR2D_ENO_SOLUTION);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(links.links), "in band 1:"));
  test_free_links(&links);
}
END_TEST

/* By links alone, a solve that begins with another, and one that adopts a field. */
START_TEST(links_serve_all_bands) {
  const spectrum s = draw_spectrum(0);
  hr2d_scene *scene = draw(&s, 0, 0, BANDS);
  hr2d_hierarchy *h;
  hr2d_linkset *links;
  hr2d_solution *first, *again, *adopted;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(h, NULL, NULL, NULL, NULL, &links), HR2D_OK);
  const hr2d_refine_options options = test_epsilon(0.1);
  ck_assert_int_eq(hr2d_refine(links, &options), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(links, NULL, &first), HR2D_OK);
  hr2d_solve_options start = HR2D_SOLVE_OPTIONS_INIT;
  start.start = first;
  ck_assert_int_eq(hr2d_solve(links, &start, &again), HR2D_OK);
  ck_assert_uint_eq(hr2d_solution_work(again).iterations, 0);
  expect_same_bits(first, again);
  ck_assert_int_eq(hr2d_solution_adopt(links, NULL, hr2d_solution_field(first), &adopted),
                   HR2D_OK);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    for (size_t b = 0; b < BANDS; b++)
      ck_assert_double_eq_tol(hr2d_solution_irradiance(adopted, k, b),
                              hr2d_solution_irradiance(first, k, b), 1e-11);
  hr2d_solution_destroy(first);
  hr2d_solution_destroy(again);
  hr2d_solution_destroy(adopted);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Polynomials of Smith, Shen and Friedman (1982) for equal pressures of CO2 and H2O. */
enum { GREYS = 3, TERMS = 4 };
static const double smith[GREYS * TERMS] = {5.150e-1,  -2.303e-4, 0.9779e-7, -1.494e-11,
                                            0.7749e-1, 3.399e-4,  -2.297e-7, 3.770e-11,
                                            1.907e-1,  -1.824e-4, 0.5608e-7, -0.5122e-11};

/* A black or grey square of one temperature in gas of another. */
static hr2d_scene *draw_furnace(double wall, double emissivity, double gas_kelvin) {
  static const hr2d_point corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const double kappa[GREYS + 1] = {0, 0.1, 1, 10};
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_set_weights(scene, smith, GREYS, TERMS), HR2D_OK);
  for (size_t k = 0; k < 4; k++) {
    hr2d_patch p = HR2D_PATCH_INIT;
    hr2d_thermal t = HR2D_THERMAL_INIT;
    p.a = corner[k];
    p.b = corner[(k + 1) % 4];
    t.given = HR2D_HEAT_TEMPERATURE;
    t.value = wall;
    t.emissivity = &emissivity;
    t.emissivity_bands = 1;
    ck_assert_int_eq(hr2d_scene_add_thermal(scene, &p, &t, NULL), HR2D_OK);
  }
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = kappa;
  gas.absorption_bands = GREYS + 1;
  gas.given = HR2D_HEAT_TEMPERATURE;
  gas.value = gas_kelvin;
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
  return scene;
}

static double weight_of(size_t grey, double kelvin) {
  const double *c = smith + grey * TERMS;
  return c[0] + kelvin * (c[1] + kelvin * (c[2] + kelvin * c[3]));
}

/* Between black walls each grey gas gives G (a(T) σT⁴ − a(T_w) σT_w⁴), with G of the square:
   gas_areas.csv has it. */
START_TEST(weights_are_those_of_grey_gases) {
  const double taken[GREYS] = {4 * 0.0932393659614304323, 4 * 0.570707619801953,
                               4 * 0.957553514470964324};
  const double hot = 1500, cold = 700;
  hr2d_account account;
  hr2d_scene *scene = draw_furnace(cold, 1, hot);
  test_commit(scene);
  ck_assert_uint_eq(hr2d_scene_bands(scene), GREYS + 1);
  hr2d_solution *s = test_solve_to(scene, 1e-10, 1, &account);
  double emission, heat, all = 0;
  for (size_t g = 0; g < GREYS; g++) {
    ck_assert_int_eq(hr2d_solution_gas(s, 0, g + 1, &emission, &heat), HR2D_OK);
    const double own = weight_of(g, hot) * hr2d_black_body(hot);
    const double right = taken[g] * (own - weight_of(g, cold) * hr2d_black_body(cold));
    expect_near(emission, own, own, 1e-14, "E_g");
    expect_near(heat, right, right, 1e-9, "heat");
    all += heat;
  }
  ck_assert_int_eq(hr2d_solution_gas(s, 0, 0, &emission, &heat), HR2D_OK);
  ck_assert(heat == 0 && emission > 0);
  /* Walls take what the gas gives, over all bands. */
  double of_walls[4];
  hr2d_temperatures told = HR2D_TEMPERATURES_INIT;
  told.heat = of_walls;
  ck_assert_int_eq(hr2d_solution_temperatures(s, NULL, &account, &told), HR2D_OK);
  expect_near(-of_walls[0] - of_walls[1] - of_walls[2] - of_walls[3], all, all, 1e-9, "walls");
  hr2d_solution_destroy(s);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Where all has one temperature there is no heat, whatever the weights are. */
START_TEST(one_temperature_is_equilibrium) {
  hr2d_account account;
  for (int grey = 0; grey < 2; grey++) {
    hr2d_scene *scene = draw_furnace(1100, grey ? 0.3 : 1, 1100);
    test_commit(scene);
    hr2d_solution *s = test_solve_to(scene, 1e-9, 1, &account);
    double parts = 0;
    for (size_t b = 0; b <= GREYS; b++) {
      const double part = b ? weight_of(b - 1, 1100)
                            : 1 - weight_of(0, 1100) - weight_of(1, 1100) - weight_of(2, 1100);
      for (size_t k = 0; k < 4; k++)
        expect_near(hr2d_solution_average(s, k, b), part * hr2d_black_body(1100),
                    part * hr2d_black_body(1100), 1e-13, "B");
      parts += hr2d_solution_average(s, 0, b);
    }
    expect_near(parts, hr2d_black_body(1100), parts, 1e-13, "all bands");
    hr2d_solution_destroy(s);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* The derivative of aσT⁴ by σT⁴, against central differences. */
START_TEST(weights_rise_with_temperature) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_set_weights(scene, smith, GREYS, TERMS), HR2D_OK);
  for (double kelvin = 600; kelvin < 2400; kelvin += 100) {
    const double low = kelvin * (1 - 1e-5), high = kelvin * (1 + 1e-5);
    double parts = 0, rises = 0;
    for (size_t b = 0; b <= GREYS; b++) {
      const double rise = (hr2di_scene_band_part(scene, high, b) * hr2d_black_body(high) -
                           hr2di_scene_band_part(scene, low, b) * hr2d_black_body(low)) /
                          (hr2d_black_body(high) - hr2d_black_body(low));
      ck_assert_double_eq_tol(hr2di_scene_band_rise(scene, kelvin, b), rise, 1e-9);
      parts += hr2di_scene_band_part(scene, kelvin, b);
      rises += hr2di_scene_band_rise(scene, kelvin, b);
    }
    ck_assert_double_eq_tol(parts, 1, 1e-15);
    ck_assert_double_eq_tol(rises, 1, 1e-15);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

static void expect_weights(hr2d_scene *scene, const double *weight, size_t count, size_t terms,
                           hr2d_status status, const char *phrase) {
  ck_assert_int_eq(hr2d_scene_set_weights(scene, weight, count, terms), status);
  if (status) test_expect_message(scene, phrase);
}

START_TEST(wrong_weights_are_refused) {
  const double nothing[] = {0.2, NAN}, one = 1;
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_set_weights(NULL, smith, 1, 1), HR2D_EINVAL);
  expect_weights(scene, NULL, 1, 1, HR2D_EINVAL, "no values");
  expect_weights(scene, smith, 1, 0, HR2D_EINVAL, "no values");
  expect_weights(scene, nothing, 1, 2, HR2D_ESCENE, "number 2 of band 1 is not finite");
  expect_weights(scene, smith, HR2D_MAX_WAVELENGTHS + 1, 1, HR2D_ESCENE, "too many");
  expect_weights(scene, smith, GREYS, TERMS, HR2D_OK, "");
  hr2d_patch p = HR2D_PATCH_INIT;
  hr2d_thermal t = HR2D_THERMAL_INIT;
  p.b = (hr2d_point){1, 0};
  t.given = HR2D_HEAT_TEMPERATURE;
  t.value = 5000;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &p, &t, NULL), HR2D_ESCENE);
  test_expect_message(scene, "at 5000 K the weight of band");
  t.given = HR2D_HEAT_FLUX;
  t.value = 0;
  t.emissivity = &one;
  t.emissivity_bands = 1;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &p, &t, NULL), HR2D_EUNSUPPORTED);
  test_expect_message(scene, "which need a temperature that is given");
  t.given = HR2D_HEAT_TEMPERATURE;
  t.value = 900;
  ck_assert_int_eq(hr2d_scene_add_thermal(scene, &p, &t, NULL), HR2D_OK);
  expect_weights(scene, smith, GREYS, TERMS, HR2D_ESTATE, "has temperatures");
  test_commit(scene);
  expect_weights(scene, smith, GREYS, TERMS, HR2D_ESTATE, "is committed");
  hr2d_scene_destroy(scene);
  scene = draw_furnace(900, 1, 5000);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  test_expect_message(scene, "gas: at 5000 K the weight of band");
  hr2d_scene_destroy(scene);
}
END_TEST

/* 257 bands, each of which absorbs otherwise. */
START_TEST(absorptions_are_limited) {
  enum { MANY = 257 };
  double kappa[MANY];
  for (size_t b = 0; b < MANY; b++) kappa[b] = 0.01 * (double)b;
  for (size_t bands = MANY - 1; bands <= MANY; bands++) {
    hr2d_scene *scene = test_new_scene(NULL);
    hr2d_gas gas = HR2D_GAS_INIT;
    gas.absorption = kappa;
    gas.absorption_bands = bands;
    ck_assert_int_eq(
        test_add_patch(scene, (hr2d_segment){{0, 0}, {1, 0}}, 1, 0.5, HR2D_SIDES_FRONT),
        HR2D_OK);
    ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_commit(scene), bands == MANY ? HR2D_EUNSUPPORTED : HR2D_OK);
    if (bands == MANY) test_expect_message(scene, "more than 256 bands differ");
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("gas bands") {
  ADD_TESTS("bands", bands_are_scenes_of_their_own, threads_and_equal_bands_change_no_bit,
            grids_are_within_their_tolerance, messages_have_the_numbers_of_bands,
            links_serve_all_bands, absorptions_are_limited);
  ADD_TESTS("weights", weights_are_those_of_grey_gases, one_temperature_is_equilibrium,
            weights_rise_with_temperature, wrong_weights_are_refused);
}
