/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Effects: they are on if the scene calls for them; forced in other scenes they cost work
   and change no bit.  The background, against closed forms. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/room-plans.h"
#include "support/support.h"

enum { BANDS = 3, MOST = 16 };

/* A scene as numbers: ax ay bx by E ρ; E and ρ apply to every band. */
typedef struct sample {
  const char *name;
  double patch[MOST][6];
  size_t patches;
  hr2d_sides sides;
  double background;
  size_t bands;     /* 0 for a grey scene */
  unsigned calls;   /* 1 << effect for each that it calls for */
  const char *dark; /* not NULL: a part of it is dark */
} sample;

#define CALLS(effect) (1u << HR2D_EFFECT_##effect)

static const sample samples[] = {
    {.name = "square",
     .patch =
         {{0, 0, 1, 0, 1, .5}, {1, 0, 1, 1, 0, .25}, {1, 1, 0, 1, 0, .5}, {0, 1, 0, 0, 2, .9}},
     .patches = 4,
     .calls = CALLS(INTERREFLECTION) | CALLS(EMISSION) | CALLS(CORNER)},
    {.name = "round, turned",
     .patch = {{1, 0, .3, 1, .5, .3},
               {.3, 1, -.8, .6, 0, .7},
               {-.8, .6, -.8, -.6, 0, .9},
               {-.8, -.6, .3, -1, 1, 0},
               {.3, -1, 1, 0, 0, .1}},
     .patches = 5,
     .calls = CALLS(INTERREFLECTION) | CALLS(EMISSION) | CALLS(CORNER)},
    {.name = "plates",
     .patch = {{0, 0, 1, 0, 1, 0}, {1, 1, 0, 1, 0, 0}},
     .patches = 2,
     .calls = CALLS(EMISSION)},
    {.name = "no light",
     .patch = {{0, 0, 1, 0, 0, .5}, {1, 1, 0, 1, 0, .5}},
     .patches = 2,
     .calls = CALLS(INTERREFLECTION),
     .dark = "all"},
    {.name = "plates in three bands",
     .patch = {{0, 0, 1, 0, 1, .5}, {1, .5, 0, .5, .5, .75}},
     .patches = 2,
     .bands = BANDS,
     .calls = CALLS(EMISSION) | CALLS(INTERREFLECTION) | CALLS(BANDS)},
    {.name = "lone two-sided patch under the sky",
     .patch = {{0, 0, 1, .5, 0, .5}},
     .patches = 1,
     .sides = HR2D_SIDES_BOTH,
     .background = 1,
     .calls = CALLS(EMISSION) | CALLS(INTERREFLECTION) | CALLS(TWO_SIDED) | CALLS(BACKGROUND)},
    {.name = "wall below a horizon",
     .patch = {{0, 0, 1, 0, 1, .5}, {1.5, -.75, 2, 1, 0, .5}},
     .patches = 2,
     .calls = CALLS(EMISSION) | CALLS(INTERREFLECTION) | CALLS(FACING)},
    {.name = "shelf in a square",
     .patch = {{0, 0, 1, 0, 1, .5},
               {1, 0, 1, 1, 0, .5},
               {1, 1, 0, 1, 0, .5},
               {0, 1, 0, 0, 0, .5},
               {.3, .5, .7, .5, 0, .5},
               {.7, .5, .3, .5, 0, .5}},
     .patches = 6,
     .calls = CALLS(EMISSION) | CALLS(INTERREFLECTION) | CALLS(CORNER) | CALLS(OCCLUSION) |
              CALLS(TWO_SIDED) | CALLS(FACING)},
    {.name = "a dark and a lit room",
     .patch = {{2, 0, 3, 0, 0, .5},
               {3, 0, 3, 1, 0, .5},
               {3, 1, 2, 1, 0, .5},
               {2, 1, 2, 0, 0, .5},
               {0, 0, 1, 0, 1, .5},
               {1, 0, 1, 1, 0, .5},
               {1, 1, 0, 1, 0, .5},
               {0, 1, 0, 0, 0, .5}},
     .patches = 8,
     .calls = CALLS(EMISSION) | CALLS(INTERREFLECTION) | CALLS(CORNER) | CALLS(OCCLUSION),
     .dark = "patches 0 to 3"},
};

enum { SAMPLES = sizeof samples / sizeof *samples };

static const char *effect_of(int e) {
  return hr2d_effect_name((hr2d_effect)e);
}

static hr2d_scene *scene_of(const sample *s, unsigned forced) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < s->patches; k++) {
    const double *p = s->patch[k];
    const size_t bands = s->bands ? s->bands : 1;
    double emission[BANDS], reflectance[BANDS];
    for (size_t b = 0; b < bands; b++) {
      emission[b] = p[4] / (double)(b + 1);
      reflectance[b] = p[5] / (double)(b + 1);
    }
    const hr2d_patch patch = {.a = {p[0], p[1]},
                              .b = {p[2], p[3]},
                              .emission = emission,
                              .emission_bands = bands,
                              .reflectance = reflectance,
                              .reflectance_bands = bands,
                              .sides = s->sides};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_set_background(scene, &s->background, 1), HR2D_OK);
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++)
    if (forced & (1u << e)) ck_assert_int_eq(hr2d_scene_force(scene, (hr2d_effect)e), HR2D_OK);
  ck_assert_msg(hr2d_scene_commit(scene) == HR2D_OK, "%s: %s", s->name,
                hr2d_scene_message(scene));
  return scene;
}

/* A refined set and its solution. */
typedef struct answer {
  test_links t;
  hr2d_solution *solution;
  hr2d_refine_counts counts;
  hr2d_solve_work work;
} answer;

static answer answer_of(const sample *s, unsigned forced, const hr2d_oracle *oracle,
                        int closure) {
  answer a = {.t = test_make_links(scene_of(s, forced), oracle, NULL, NULL, NULL)};
  test_refine(&a.t, .3, 8);
  test_refine(&a.t, .1, 8);
  a.solution = test_solve(&a.t, closure);
  a.counts = hr2d_linkset_counts(a.t.links);
  a.work = hr2d_solution_work(a.solution);
  return a;
}

static void free_answer(answer *a) {
  hr2d_solution_destroy(a->solution);
  test_free_links(&a->t);
}

/* B and H, as bits: H on the leaf that holds the middle of the element. */
static void check_element(const answer *a, const answer *b, uint32_t e, uint32_t f,
                          const char *what) {
  for (size_t band = 0; band < hr2d_scene_bands(a->t.scene); band++) {
    const double first = hr2d_solution_element(a->solution, e, band),
                 second = hr2d_solution_element(b->solution, f, band);
    ck_assert_msg(memcmp(&first, &second, sizeof first) == 0, "%s: B is %a and %a", what, first,
                  second);
  }
}

static void check_irradiance(const answer *a, const answer *b, size_t patch, const char *what) {
  for (size_t band = 0; band < hr2d_scene_bands(a->t.scene); band++)
    for (int k = 0; k <= 512; k++) {
      const double t = k / 512.,
                   first = hr2d_solution_irradiance_at(a->solution, patch, t, band),
                   second = hr2d_solution_irradiance_at(b->solution, patch, t, band);
      ck_assert_msg(memcmp(&first, &second, sizeof first) == 0, "%s: H is %a and %a", what,
                    first, second);
    }
}

/* No bit differs in elements, links in their order, B and H. */
static void check_same(const answer *a, const answer *b, const char *what) {
  const uint64_t n = hr2d_hierarchy_count(a->t.hierarchy).elements;
  ck_assert_msg(n == hr2d_hierarchy_count(b->t.hierarchy).elements, "%s: N", what);
  ck_assert_msg(memcmp(hr2d_hierarchy_elements(a->t.hierarchy),
                       hr2d_hierarchy_elements(b->t.hierarchy),
                       (size_t)n * sizeof(hr2d_element)) == 0,
                "%s: elements", what);
  const uint64_t links = hr2d_linkset_size(a->t.links);
  ck_assert_msg(links == hr2d_linkset_size(b->t.links), "%s: L", what);
  for (uint64_t k = 0; k < links; k++) {
    const hr2d_link l = hr2d_linkset_get(a->t.links, k), m = hr2d_linkset_get(b->t.links, k);
    ck_assert_msg(memcmp(&l, &m, sizeof l) == 0, "%s: link %llu", what, (unsigned long long)k);
  }
  for (uint32_t e = 0; e < n; e++) check_element(a, b, e, e, what);
  for (size_t k = 0; k < hr2d_scene_patches(a->t.scene); k++) check_irradiance(a, b, k, what);
}

START_TEST(scenes_say_what_they_call_for_and_why) {
  for (int k = 0; k < SAMPLES; k++)
    for (int e = 0; e < HR2D_EFFECT_COUNT; e++) {
      const sample *s = &samples[k];
      hr2d_scene *plain = scene_of(s, 0), *forced = scene_of(s, 1u << e);
      const int called = (s->calls >> e) & 1;
      const char *why, *why_forced;
      ck_assert_msg(hr2d_scene_effect(plain, (hr2d_effect)e, &why) == called, "%s: %s: %s",
                    s->name, effect_of(e), why);
      /* The background has no patch to name. */
      const int names = called && e != HR2D_EFFECT_BANDS && e != HR2D_EFFECT_BACKGROUND &&
                        !(e == HR2D_EFFECT_EMISSION && s->background > 0);
      ck_assert_msg(!names || strstr(why, "patch "), "%s: %s: %s", s->name, effect_of(e), why);
      ck_assert_str_ne(why, "");
      ck_assert_int_eq(hr2d_scene_effect(forced, (hr2d_effect)e, &why_forced), 1);
      if (called)
        ck_assert_str_eq(why, why_forced);
      else
        ck_assert_ptr_nonnull(strstr(why_forced, "forced, though"));
      hr2d_scene_destroy(plain);
      hr2d_scene_destroy(forced);
    }
  hr2d_scene *scene = scene_of(&samples[0], 0);
  ck_assert_int_eq(hr2d_scene_force(scene, HR2D_EFFECT_FACING), HR2D_ESTATE);
  hr2d_scene_destroy(scene);
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_force(scene, HR2D_EFFECT_COUNT), HR2D_EINVAL);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The work that an effect is known by. */
static uint64_t work_of(const answer *a, int effect) {
  switch (effect) {
  case HR2D_EFFECT_OCCLUSION:
    return a->counts.visibility_tests;
  case HR2D_EFFECT_INTERREFLECTION:
    return a->work.iterations;
  case HR2D_EFFECT_FACING:
    return a->counts.facing_tests;
  default:
    return a->work.background_rows;
  }
}

START_TEST(work_is_done_where_it_is_called_for) {
  static const int counted[] = {HR2D_EFFECT_OCCLUSION, HR2D_EFFECT_INTERREFLECTION,
                                HR2D_EFFECT_FACING, HR2D_EFFECT_BACKGROUND};
  for (int k = 0; k < SAMPLES; k++) {
    const sample *s = &samples[k];
    answer a = answer_of(s, 0, NULL, 1);
    for (int c = 0; c < 4; c++) {
      const int e = counted[c], called = (s->calls >> e) & 1;
      /* What reflects no light needs no iteration. */
      const int works = called && !(e == HR2D_EFFECT_INTERREFLECTION && s->dark &&
                                    strcmp(s->dark, "all") == 0);
      ck_assert_msg((work_of(&a, e) > 0) == works, "%s: %s: %llu", s->name, effect_of(e),
                    (unsigned long long)work_of(&a, e));
    }
    ck_assert_msg((a.counts.dark_pairs > 0) == (s->dark != NULL), "%s", s->name);
    free_answer(&a);
  }
}
END_TEST

/* Every effect, and all at once, where it is called for and where not. */
START_TEST(forcing_changes_no_bit) {
  const sample *s = &samples[_i];
  for (int closure = 0; closure < 2; closure++)
    for (int oracle = 0; oracle < 2; oracle++) {
      const hr2d_oracle *by = oracle ? hr2d_oracle_bf() : hr2d_oracle_size();
      answer plain = answer_of(s, 0, by, closure);
      const unsigned all = (1u << HR2D_EFFECT_COUNT) - 1 - (s->dark ? CALLS(EMISSION) : 0);
      for (int e = 0; e <= HR2D_EFFECT_COUNT; e++) {
        const unsigned forced = e < HR2D_EFFECT_COUNT ? 1u << e : all;
        char what[128];
        if ((forced & CALLS(EMISSION)) && s->dark) continue;
        snprintf(what, sizeof what, "%s, %s forced, closure %d, oracle %s", s->name,
                 e < HR2D_EFFECT_COUNT ? effect_of(e) : "all", closure, by->name);
        answer a = answer_of(s, forced, by, closure);
        check_same(&plain, &a, what);
        /* Negative control: it really was on; bf may accept patches as they are. */
        if (e == HR2D_EFFECT_OCCLUSION || (e == HR2D_EFFECT_FACING && !oracle))
          ck_assert_msg(work_of(&a, e) > 0 || a.counts.oracle_calls == 0, "%s", what);
        if (e == HR2D_EFFECT_BACKGROUND && !(s->calls & CALLS(CORNER)))
          ck_assert_msg(a.work.background_rows > 0 || s->dark, "%s", what);
        free_answer(&a);
      }
      free_answer(&plain);
    }
}
END_TEST

/* A dark room gets links for nothing, and the lit one keeps every bit. */
static void check_dark_room(double epsilon) {
  answer a[2];
  for (unsigned k = 0; k < 2; k++) {
    a[k] = (answer){.t = test_make_links(scene_of(&samples[SAMPLES - 1], k * CALLS(EMISSION)),
                                         NULL, NULL, NULL, NULL)};
    test_refine(&a[k].t, epsilon, 12);
    a[k].solution = test_solve(&a[k].t, 1);
  }
  const hr2d_element *e = hr2d_hierarchy_elements(a[0].t.hierarchy),
                     *f = hr2d_hierarchy_elements(a[1].t.hierarchy);
  const uint64_t links[] = {hr2d_linkset_size(a[0].t.links), hr2d_linkset_size(a[1].t.links)};
  printf("epsilon %g: %llu links, with the dark room %llu\n", epsilon,
         (unsigned long long)links[0], (unsigned long long)links[1]);
  ck_assert_uint_eq(2 * links[0], links[1]);
  for (uint64_t k = 0; k < links[0]; k++)
    ck_assert_uint_ge(e[hr2d_linkset_get(a[0].t.links, k).pair.first].patch, 4);
  for (size_t patch = 0; patch < 8; patch++) {
    ck_assert_double_eq(patch < 4 ? 0 : 1,
                        hr2d_solution_average(a[1].solution, patch, 0) > 0 ? 1 : 0);
    check_irradiance(&a[0], &a[1], patch, "dark room");
  }
  /* Elements have other numbers: both trees are walked together. */
  uint32_t stack[64][2], count = 0;
  for (uint32_t k = 4; k < 8; k++) stack[count][0] = stack[count][1] = k, count++;
  while (count > 0) {
    const uint32_t i = stack[--count][0], j = stack[count][1];
    check_element(&a[0], &a[1], i, j, "lit room");
    ck_assert_int_eq(!e[i].child, !f[j].child);
    for (uint32_t k = 0; k < 2 && e[i].child; k++)
      stack[count][0] = e[i].child + k, stack[count][1] = f[j].child + k, count++;
  }
  for (int k = 0; k < 2; k++) free_answer(&a[k]);
}

START_TEST(dark_rooms_do_not_disturb) {
  check_dark_room(.1);
  check_dark_room(1. / 32);
}
END_TEST

/* Nothing emits: no link, no oracle call, B = E = 0. */
START_TEST(no_light_no_links) {
  answer a = answer_of(&samples[3], 0, NULL, 1);
  ck_assert_uint_eq(a.counts.links + a.counts.oracle_calls, 0);
  ck_assert_uint_eq(a.counts.dark_pairs, 2); /* of two refinements */
  for (size_t k = 0; k < 2; k++) {
    ck_assert_double_eq(hr2d_solution_average(a.solution, k, 0), 0);
    ck_assert_double_eq(hr2d_solution_irradiance(a.solution, k, 0), 0);
  }
  free_answer(&a);
}
END_TEST

/* A solved scene of patches under a background; ρ and E as in test_scene(). */
static answer under_sky(const double (*patch)[6], size_t patches, hr2d_sides sides,
                        unsigned level) {
  sample s = {.name = "sky", .patches = patches, .sides = sides, .background = 1};
  memcpy(s.patch, patch, patches * sizeof *patch);
  answer a = {.t = test_make_links(scene_of(&s, 0), NULL, NULL, NULL, NULL)};
  test_refine(&a.t, .1, level);
  a.solution = test_solve(&a.t, 1);
  a.work = hr2d_solution_work(a.solution);
  return a;
}

static double irradiance(const answer *a, size_t patch) {
  return hr2d_solution_irradiance(a->solution, patch, 0);
}

START_TEST(a_lone_patch_receives_all_of_the_sky) {
  for (int sides = 0; sides < 2; sides++) {
    answer a = under_sky((const double[][6]){{.1, .2, .7, 1.1, 0, .5}}, 1,
                         sides ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT, 8);
    for (size_t k = 0; k < hr2d_scene_patches(a.t.scene); k++) {
      ck_assert_double_eq(irradiance(&a, k), 1);
      ck_assert_double_eq_tol(hr2d_solution_average(a.solution, k, 0), .5, 1e-15);
    }
    free_answer(&a);
  }
}
END_TEST

static double distance(const double p[2], const double q[2]) {
  return hypot(p[0] - q[0], p[1] - q[1]);
}

/* F of two segments with a, b, c, d counter-clockwise: crossed less uncrossed strings. */
static double strings(const double i[4], const double j[4]) {
  return (distance(i, j) + distance(i + 2, j + 2) - distance(i, j + 2) - distance(i + 2, j)) /
         2 / distance(i, i + 2);
}

/* Black plates: each loses the part of the sky that the other one covers. */
START_TEST(plates_hide_the_sky_from_each_other) {
  for (double d = .125; d <= 8; d *= 2) {
    const double plate[][6] = {{0, 0, 1, 0, 0, 0}, {1, d, 0, d, 0, 0}};
    answer a = under_sky(plate, 2, HR2D_SIDES_FRONT, 12);
    for (size_t k = 0; k < 2; k++)
      ck_assert_double_eq_tol(irradiance(&a, k), 1 - strings(plate[0], plate[1]), 1e-14);
    const hr2d_power p = hr2d_solution_power(a.solution, 0);
    ck_assert_double_eq_tol(p.received, 2 * (1 - strings(plate[0], plate[1])), 1e-14);
    ck_assert_double_eq_tol(p.absorbed, p.received, 1e-14);
    free_answer(&a);
  }
}
END_TEST

/* Panels in a row look the same way: the back of each hides the sky from the one behind
   it, and is black. */
START_TEST(backs_hide_the_sky) {
  const double panel[][6] = {{0, 0, 1, 0, 0, .5}, {.25, 1, 1.5, 1, 0, .5}, {3, 0, 4, 0, 0, .5}};
  const double back[] = {1.5, 1, .25, 1};
  answer a = under_sky(panel, 3, HR2D_SIDES_FRONT, 8);
  ck_assert_double_eq_tol(irradiance(&a, 0), 1 - strings(panel[0], back), 1e-14);
  ck_assert_double_eq(irradiance(&a, 1), 1);
  ck_assert_double_eq_tol(irradiance(&a, 2), 1 - strings(panel[2], back), 1e-14);
  free_answer(&a);
}
END_TEST

/* A panel with two sides, given as two patches.  They may stand apart in the list and need
   not cover each other; each direction counts once. */
START_TEST(sides_hide_the_sky_once) {
  const double neighbours[][6] = {
      {.25, 1, 1.5, 1, 0, 0}, {1.5, 1, .25, 1, 0, 0}, {0, 0, 1, 0, 0, 0}};
  const double strangers[][6] = {
      {.25, 1, 1.5, 1, 0, 0}, {0, 0, 1, 0, 0, 0}, {1.5, 1, .25, 1, 0, 0}};
  const double pieces[][6] = {
      {.25, 1, 1.5, 1, 0, 0}, {1.5, 1, 1, 1, 0, 0}, {1, 1, .25, 1, 0, 0}, {0, 0, 1, 0, 0, 0}};
  const double half[][6] = {{.25, 1, 1.5, 1, 0, 0}, {1, 1, .25, 1, 0, 0}, {0, 0, 1, 0, 0, 0}};
  const double(*const scene[])[6] = {neighbours, strangers, pieces, half};
  const size_t count[] = {3, 3, 4, 3}, floor[] = {2, 1, 3, 2};
  const double back[] = {1.5, 1, .25, 1};
  for (int k = 0; k < 4; k++) {
    answer a = under_sky(scene[k], count[k], HR2D_SIDES_FRONT, 8);
    ck_assert_msg(fabs(irradiance(&a, floor[k]) - (1 - strings(scene[k][floor[k]], back))) <=
                      1e-14,
                  "scene %d: %.17g", k, irradiance(&a, floor[k]));
    free_answer(&a);
  }
}
END_TEST

START_TEST(closed_rooms_receive_nothing) {
  const double room[][6] = {
      {0, 0, 1, 0, 0, .5}, {1, 0, 1, 1, 0, 1}, {1, 1, 0, 1, 0, .5}, {0, 1, 0, 0, 0, .9}};
  answer a = under_sky(room, 4, HR2D_SIDES_FRONT, 8);
  for (size_t k = 0; k < 4; k++) {
    ck_assert_double_eq(irradiance(&a, k), 0);
    ck_assert_double_eq(hr2d_solution_average(a.solution, k, 0), 0);
  }
  ck_assert_uint_eq(a.work.background_rows, 0);
  free_answer(&a);
}
END_TEST

/* Two grey plates that are not subdivided: H = F ρ H + 1 − F. */
START_TEST(light_goes_to_and_fro) {
  for (double rho = 0; rho <= 1; rho += .25) {
    const double plate[][6] = {{0, 0, 1, 0, 0, rho}, {1, .25, 0, .25, 0, rho}};
    const double f = strings(plate[0], plate[1]);
    answer a = under_sky(plate, 2, HR2D_SIDES_FRONT, 0);
    for (size_t k = 0; k < 2; k++)
      ck_assert_double_eq_tol(irradiance(&a, k), (1 - f) / (1 - f * rho), 1e-14);
    free_answer(&a);
  }
}
END_TEST

/* If everything is as bright as the background, nothing can be seen: B = 1, with any
   obstacles and any openings. */
START_TEST(nothing_shows_in_an_isothermal_enclosure) {
  randoms r = randoms_stream(test_seed(), 77);
  const int rooms = test_multiplier() < 1 ? plan_class_count : 3 * plan_class_count;
  for (int k = 0; k < rooms; k++) {
    plan p = {.walls = 0};
    plan_classes[k % plan_class_count].draw(&r, 12, &p);
    const double angle = k / plan_class_count % 2 ? random_between(&r, 0, 6.3) : 0;
    plan_transform(&p, (similarity){.u = cos(angle), .v = sin(angle)});
    for (size_t w = p.walls; w-- > 0;) p.sides[w] = HR2D_SIDES_BOTH;
    for (int gone = 0; gone < 1 + k % 3 && p.walls > 2; gone++) {
      p.walls--;
      p.wall[gone] = p.wall[p.walls];
    }
    const test_paint paint = {.r = &r, .reflectance = .9, .isothermal = 1, .background = 1};
    test_links t = test_make_links(test_painted_scene(&p, &paint), NULL, NULL, NULL, NULL);
    test_refine(&t, .5, 6);
    hr2d_solution *solution = test_solve(&t, 1);
    for (uint32_t e = 0; e < hr2d_hierarchy_count(t.hierarchy).elements; e++) {
      const double b = hr2d_solution_element(solution, e, 0);
      ck_assert_msg(fabs(b - 1) <= 1e-13, "%s, room %d: B = 1 + %g on element %u",
                    plan_classes[k % plan_class_count].name, k, b - 1, (unsigned)e);
    }
    const hr2d_power power = hr2d_solution_power(solution, 0);
    const double in = power.emitted + power.received;
    ck_assert_double_gt(power.received, 0);
    ck_assert_double_eq_tol(power.absorbed + power.escaped, in, 1e-13 * in);
    ck_assert_uint_gt(hr2d_solution_work(solution).background_rows, 0);
    hr2d_solution_destroy(solution);
    test_free_links(&t);
    plan_free(&p);
  }
}
END_TEST

/* Each band of the background gives the same as a grey scene. */
START_TEST(backgrounds_have_bands) {
  const double sky[BANDS] = {1, 0, .25}, rho = .5;
  double average[BANDS + 1][BANDS];
  for (size_t k = 0; k <= BANDS; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    for (int w = 0; w < 2; w++) {
      const hr2d_patch patch = {.a = {w ? .5 : 0, w ? 1 : 0},
                                .b = {w ? .5 : 1, w ? .25 : 0},
                                .reflectance = &rho,
                                .reflectance_bands = 1,
                                .sides = HR2D_SIDES_BOTH};
      ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
    }
    ck_assert_int_eq(
        hr2d_scene_set_background(scene, k < BANDS ? &sky[k] : sky, k < BANDS ? 1 : BANDS),
        HR2D_OK);
    ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
    ck_assert_uint_eq(hr2d_scene_bands(scene), k < BANDS ? 1 : BANDS);
    test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
    test_refine(&t, .1, 8);
    hr2d_solution *solution = test_solve(&t, 1);
    for (size_t band = 0; band < hr2d_scene_bands(scene); band++) {
      average[k][band] = hr2d_solution_average(solution, 0, band);
      const hr2d_power p = hr2d_solution_power(solution, band);
      ck_assert_double_eq_tol(p.emitted + p.received, p.absorbed + p.escaped, 1e-13);
    }
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
  for (size_t band = 0; band < BANDS; band++)
    ck_assert_double_eq_tol(average[BANDS][band], average[band][0], 1e-14);
  ck_assert_double_eq(average[BANDS][1], 0);
}
END_TEST

START_TEST(backgrounds_without_meaning_are_refused) {
  const double wrong[] = {-1e-300, NAN, INFINITY, -INFINITY}, right[] = {0, 1, 2};
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < 4; k++) {
    const double values[] = {1, wrong[k]};
    ck_assert_int_eq(hr2d_scene_set_background(scene, values, 2), HR2D_ESCENE);
    ck_assert_str_ne(hr2d_scene_message(scene), "");
  }
  ck_assert_int_eq(hr2d_scene_set_background(scene, NULL, 1), HR2D_EINVAL);
  const hr2d_patch patch = {.a = {0, 0}, .b = {1, 0}, .emission = right, .emission_bands = 2};
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, right, 3), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), "the background has 3 bands"));
  /* It can be set right, and then no more. */
  ck_assert_int_eq(hr2d_scene_set_background(scene, right + 1, 2), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_double_eq(hr2d_scene_background(scene, 1), 2);
  ck_assert_int_eq(hr2d_scene_set_background(scene, right, 1), HR2D_ESTATE);
  ck_assert_double_eq(hr2d_scene_background(scene, 0), 1);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("effects") {
  ADD_TESTS("effects", scenes_say_what_they_call_for_and_why,
            work_is_done_where_it_is_called_for);
  REPEAT_TESTS(SAMPLES, "effects", forcing_changes_no_bit);
  ADD_TESTS("effects", dark_rooms_do_not_disturb, no_light_no_links);
  ADD_TESTS("background", a_lone_patch_receives_all_of_the_sky,
            plates_hide_the_sky_from_each_other, backs_hide_the_sky, sides_hide_the_sky_once,
            closed_rooms_receive_nothing, light_goes_to_and_fro,
            nothing_shows_in_an_isothermal_enclosure, backgrounds_have_bands,
            backgrounds_without_meaning_are_refused);
}
