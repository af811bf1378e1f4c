/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard cases of refinement, in which textbook recursion never ends: corners to the last bit
   of a double, errors that no pair meets, more links than any memory holds. */
#include <float.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "support/hard.h"
#include "support/support.h"

/* No two elements can be halved more often than 2·1075 times before both are 0. */
enum { ENDLESS = 10000 };

/* ProjectKernel of the paper: r is the distance of midpoints, the estimate is max(A)/r, and
   the longer element is split. */
typedef struct recursion {
  double epsilon;
  uint64_t links;
  unsigned depth, limit; /* at the limit it is given up */
} recursion;

static int project(recursion *p, hr2d_segment i, hr2d_segment j, unsigned depth) {
  if (depth > p->depth) p->depth = depth;
  if (depth >= p->limit) return 0;
  const double ai = hypot(i.b.x - i.a.x, i.b.y - i.a.y);
  const double aj = hypot(j.b.x - j.a.x, j.b.y - j.a.y);
  const hr2d_point mi = {(i.a.x + i.b.x) / 2, (i.a.y + i.b.y) / 2};
  const hr2d_point mj = {(j.a.x + j.b.x) / 2, (j.a.y + j.b.y) / 2};
  if (fmax(ai, aj) / hypot(mi.x - mj.x, mi.y - mj.y) <= p->epsilon) {
    p->links++;
    return 1;
  }
  if (ai >= aj)
    return project(p, (hr2d_segment){i.a, mi}, j, depth + 1) &&
           project(p, (hr2d_segment){mi, i.b}, j, depth + 1);
  return project(p, i, (hr2d_segment){j.a, mj}, depth + 1) &&
         project(p, i, (hr2d_segment){mj, j.b}, depth + 1);
}

/* Unit patches.  Two of them touch at (at, at).  The third, at the origin, turns its back on
   them: a scene so far from the origin is only accepted with it. */
static void corner_at(double at, double patch[3][6]) {
  const double made[3][6] = {
      {at, at, at + 1, at, 1, .5}, {at, at + 1, at, at, 0, .5}, {0, 0, 0, 1, 0, 0}};
  memcpy(patch, made, sizeof made);
}

static size_t corner_patches(double at) {
  return at > 1e10 ? 3 : 2;
}

static test_links touching(double at) {
  double patch[3][6];
  corner_at(at, patch);
  return test_make_links(test_scene((const double(*)[6])patch, corner_patches(at)), NULL, NULL,
                         NULL, NULL);
}

static recursion textbook_corner(double at, double epsilon) {
  double p[3][6];
  corner_at(at, p);
  recursion made = {.epsilon = epsilon, .limit = ENDLESS};
  project(&made, (hr2d_segment){{p[0][0], p[0][1]}, {p[0][2], p[0][3]}},
          (hr2d_segment){{p[1][0], p[1][1]}, {p[1][2], p[1][3]}}, 0);
  return made;
}

/* Leaves are halves of halves: lengths exact, ends shared. */
static void check_elements(const test_links *t) {
  const hr2d_element *e = hr2d_hierarchy_elements(t->hierarchy);
  for (uint32_t k = 0; k < hr2d_hierarchy_count(t->hierarchy).elements; k++) {
    const double whole = e[e[k].patch].length;
    ck_assert_double_eq(e[k].length, ldexp(whole, -(int)hr2d_element_level(t->hierarchy, k)));
    ck_assert_double_gt(e[k].length, 0);
    ck_assert(e[k].a.x != e[k].b.x || e[k].a.y != e[k].b.y);
    if (!e[k].child) continue;
    const hr2d_element *left = &e[e[k].child], *right = left + 1;
    ck_assert(left->a.x == e[k].a.x && left->a.y == e[k].a.y);
    ck_assert(left->b.x == right->a.x && left->b.y == right->a.y);
    ck_assert(right->b.x == e[k].b.x && right->b.y == e[k].b.y);
  }
}

START_TEST(corners_to_the_last_bit) {
  static const double places[] = {0, 1, 1e3, 1e8, 1e15};
  for (size_t k = 0; k < 5; k++)
    for (double epsilon = 1; epsilon > .2; epsilon /= 2) {
      test_links t = touching(places[k]);
      const hr2d_refine_options options = test_options(epsilon, UINT32_MAX);
      ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
      const hr2d_refine_counts c = hr2d_linkset_counts(t.links);
      check_elements(&t);
      ck_assert_int_eq(hr2d_linkset_validate(t.links), HR2D_OK);
      /* Only pairs at the corner itself are never accepted: pairs of elements that end on
         it, and, for a small ε, pairs of their neighbours. */
      ck_assert_uint_ge(c.limited_links, 1);
      if (places[k] < 1e15)
        ck_assert_uint_le(c.limited_links, (uint64_t)(4 / (epsilon * epsilon)));
      /* From 1 down to a bit of the coordinates: 2⁻⁵² of 1, 2⁻¹⁰⁷⁴ at 0. */
      const int bit = places[k] > 0 ? ilogb(places[k]) - 52 : -1074;
      ck_assert_int_ge((int)c.levels, -bit - 1);
      ck_assert_int_le((int)c.levels, -bit);
      double sum = 0;
      for (uint64_t l = 0; l < hr2d_linkset_size(t.links); l++)
        sum += hr2d_linkset_get(t.links, l).exchange_area;
      ck_assert_double_eq_tol(sum, 1 - sqrt(.5), 1e-13);
      if (epsilon == 1 && k != 2 && k != 4) {
        const recursion book = textbook_corner(places[k], epsilon);
        ck_assert_uint_ge(book.depth, ENDLESS);
        hard_case("refinement", hard_format("corner at %g, ε = 1, no limit", places[k]).text,
                  hard_format("recursion goes on at depth %u, without end", book.depth),
                  hard_format("%u levels, %llu links, of which limited %llu", c.levels,
                              (unsigned long long)c.links,
                              (unsigned long long)c.limited_links));
      }
      test_free_links(&t);
    }
  /* Positive control: where patches do not touch, the recursion ends as the library does. */
  recursion book = {.epsilon = 1. / 64, .limit = 1000};
  ck_assert_int_eq(
      project(&book, (hr2d_segment){{0, 0}, {1, 0}}, (hr2d_segment){{1, .1}, {0, .1}}, 0), 1);
  ck_assert_uint_eq(book.links, 246082);
}
END_TEST

START_TEST(patches_of_few_doubles) {
  /* Both ways from 2 to 2,049 doubles long, at an offset where these are all there are. */
  for (int bits = 1; bits <= 11; bits++) {
    const double size = ldexp(1, bits), x = 0x1p53;
    const double patch[][6] = {
        {x, 0, x + size, 0, 1, .5}, {x + size, 4096, x, 4096, 0, .5}, {0, 0, 0, 1, 0, 0}};
    test_links t = test_make_links(test_scene(patch, 3), NULL, NULL, NULL, NULL);
    hr2d_refine_options options = test_options(1e-6, UINT32_MAX);
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    const hr2d_refine_counts c = hr2d_linkset_counts(t.links);
    check_elements(&t);
    ck_assert_uint_eq(c.levels, (unsigned)bits - 1);
    ck_assert_uint_gt(c.limited_links, 0);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(errors_equal_to_epsilon) {
  /* Parallel unit patches at distances of a power of two: max(A)/r is exactly 1/d. */
  for (int e = -6; e <= 6; e++) {
    const double d = ldexp(1, e);
    const double patch[][6] = {{0, 0, 1, 0, 1, .5}, {1, d, 0, d, 0, .5}};
    const double epsilon[] = {1 / d, nextafter(1 / d, 0), nextafter(1 / d, 2 / d)};
    for (int k = 0; k < 3; k++) {
      test_links t = test_make_links(test_scene(patch, 2), NULL, NULL, NULL, NULL);
      test_refine(&t, epsilon[k], 24);
      if (k == 1)
        ck_assert_uint_gt(hr2d_linkset_size(t.links), 1);
      else
        ck_assert_uint_eq(hr2d_linkset_size(t.links), 1);
      test_free_links(&t);
    }
  }
}
END_TEST

START_TEST(epsilon_at_its_ends) {
  static const struct {
    double epsilon;
    hr2d_status status;
  } cases[] = {{0, HR2D_EMAX_LINKS},    {5e-324, HR2D_EMAX_LINKS}, {DBL_MIN, HR2D_EMAX_LINKS},
               {DBL_MAX, HR2D_OK},      {HUGE_VAL, HR2D_OK},       {NAN, HR2D_EINVAL},
               {-0.0, HR2D_EMAX_LINKS}, {-5e-324, HR2D_EINVAL}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
    for (int count = 0; count < 2; count++) {
      test_links t = touching(0);
      hr2d_refine_options options = test_options(cases[k].epsilon, UINT32_MAX);
      options.max_links = 20000;
      hr2d_refine_counts counts;
      const hr2d_status status = count ? hr2d_refine_count(t.links, &options, &counts)
                                       : hr2d_refine(t.links, &options);
      ck_assert_msg(status == cases[k].status, "epsilon %g: status %d", cases[k].epsilon,
                    status);
      if (status == HR2D_EMAX_LINKS)
        ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "20000 links"));
      if (!status && !count) ck_assert_uint_eq(hr2d_linkset_size(t.links), 1);
      ck_assert_uint_eq(hr2d_linkset_size(t.links), !status && !count);
      ck_assert_uint_eq(hr2d_hierarchy_count(t.hierarchy).elements, 2);
      test_free_links(&t);
    }
}
END_TEST

/* A square room with its walls in an order. */
static test_links square_in_order(const int *order, const hr2d_policy *policy) {
  static const double wall[4][6] = {
      {0, 0, 1, 0, 1, .5}, {1, 0, 1, 1, 0, .5}, {1, 1, 0, 1, 0, .5}, {0, 1, 0, 0, 0, .5}};
  double patch[4][6];
  for (int k = 0; k < 4; k++) memcpy(patch[k], wall[order[k]], sizeof patch[k]);
  return test_make_links(test_scene((const double(*)[6])patch, 4), NULL, NULL, policy, NULL);
}

START_TEST(ties_do_not_depend_on_the_order) {
  /* All lengths are equal, so that every other choice is a tie. */
  static const int orders[][4] = {{0, 1, 2, 3}, {3, 2, 1, 0}, {2, 0, 3, 1}, {1, 3, 0, 2}};
  const hr2d_policy *const policies[] = {hr2d_policy_original(), hr2d_policy_modified()};
  for (int p = 0; p < 2; p++)
    for (double epsilon = 1; epsilon > .1; epsilon *= .7) {
      uint64_t links = 0, elements = 0;
      for (int k = 0; k < 4; k++) {
        test_links t = square_in_order(orders[k], policies[p]);
        test_refine(&t, epsilon, 10);
        const hr2d_refine_counts c = hr2d_linkset_counts(t.links);
        if (k == 0) links = c.links, elements = c.elements;
        ck_assert_uint_eq(c.links, links);
        ck_assert_uint_eq(c.elements, elements);
        test_free_links(&t);
      }
    }
}
END_TEST

/* A furnished room, or two parallel patches at a distance of 0.1. */
static test_links metered_links(test_meter *m, int shaded, const hr2d_oracle *oracle) {
  static const double patch[][6] = {{0, 0, 1, 0, 1, .5},
                                    {1, .1, 0, .1, 0, .5},
                                    {.3, .04, .5, .04, 0, .5},
                                    {.5, .041, .3, .041, 0, .5},
                                    {.7, .03, .75, .06, 0, .5}};
  const hr2d_allocator hooks = test_metered(m);
  return test_make_links(test_scene_hooked(patch, shaded ? 5 : 2, &hooks), oracle, NULL, NULL,
                         NULL);
}

static hr2d_status nothing(void *ctx, const hr2d_link *links, size_t count) {
  *(uint64_t *)ctx += links[0].exchange_area >= 0 ? count : 0;
  return HR2D_OK;
}

/* Refines, counts or streams: how = 0, 1, 2. */
static hr2d_status run(const test_links *t, const hr2d_refine_options *options, int how,
                       hr2d_refine_counts *counts) {
  uint64_t seen = 0;
  const hr2d_status status = how == 0 ? hr2d_refine(t->links, options)
                             : how == 1
                                 ? hr2d_refine_count(t->links, options, counts)
                                 : hr2d_refine_visit(t->links, options, nothing, &seen, counts);
  if (how == 0) *counts = hr2d_linkset_counts(t->links);
  return status;
}

/* All that is held besides the scene, the roots and the sets, is within the budget at every
   moment, and after a failure it is gone. */
static void check_bytes(int shaded, const hr2d_oracle *oracle, int how, unsigned threads,
                        uint64_t budget, int *refused) {
  test_meter m = {0, 0};
  test_links t = metered_links(&m, shaded, oracle);
  const long long before = atomic_load(&m.held);
  atomic_store(&m.peak, before);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 1. / 128;
  options.max_level = 16;
  options.max_bytes = budget;
  options.threads = threads;
  options.packed = oracle == hr2d_oracle_bf();
  hr2d_refine_counts counts;
  const hr2d_status status = run(&t, &options, how, &counts);
  const long long max = atomic_load(&m.peak) - before;
  ck_assert_msg(max <= (long long)budget + (shaded ? 1024 : 0),
                "%d, %s, how %d, threads %u: %lld of %llu bytes", shaded, oracle->name, how,
                threads, max, (unsigned long long)budget);
  ck_assert(status == HR2D_OK || status == HR2D_EMAX_BYTES);
  if (status) {
    char figure[40];
    snprintf(figure, sizeof figure, "more than %llu bytes", (unsigned long long)budget);
    ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), figure));
    ck_assert_uint_eq(hr2d_hierarchy_count(t.hierarchy).elements, hr2d_scene_patches(t.scene));
    ck_assert_uint_eq(hr2d_linkset_size(t.links), 0);
    ck_assert_int_le(atomic_load(&m.held) - before, 4096);
    ++*refused;
  }
  test_free_links(&t);
  ck_assert_int_eq(atomic_load(&m.held), 0);
}

START_TEST(bytes_stay_within_their_budget) {
  const hr2d_oracle *const oracles[] = {hr2d_oracle_size(), hr2d_oracle_bf()};
  int refused = 0, runs = 0;
  const double step = test_multiplier() < 1 ? 7 : 1.9;
  for (double budget = 1; budget < 1e8 * fmin(1, test_multiplier() + .01); budget *= step)
    for (int shaded = 0; shaded < 2; shaded++)
      for (int o = 0; o < 2; o++)
        for (int how = 0; how < 3; how++)
          for (unsigned threads = 1; threads <= 4; threads += how == 1 ? 3 : 9, runs++)
            check_bytes(shaded, oracles[o], how, threads, (uint64_t)budget, &refused);
  printf("%d of %d refused\n", refused, runs);
  ck_assert_int_gt(refused, runs / 2);
  ck_assert_int_lt(refused, runs);
}
END_TEST

START_TEST(a_budget_remembers_nothing) {
  /* The memory that a failed call held does not count against the budget of the next call. */
  test_meter m = {0, 0};
  test_links t = metered_links(&m, 0, hr2d_oracle_size());
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2d_refine_counts counts;
  for (int how = 1; how >= 0; how--) {
    options.epsilon = 1. / 512;
    options.max_bytes = 10000000;
    options.max_links = 500000;
    ck_assert_int_eq(run(&t, &options, how, &counts), HR2D_EMAX_LINKS);
    options.epsilon = 1;
    options.max_bytes = 300000;
    ck_assert_int_eq(run(&t, &options, how, &counts), HR2D_OK);
    ck_assert_uint_gt(counts.links, 10);
  }
  test_free_links(&t);
}
END_TEST

/* More than 10⁹ links wait behind each budget. */
START_TEST(budgets_end_what_is_endless) {
  const uint64_t part = test_multiplier() < 1 ? 20 : 1;
  const uint64_t links = 1000000 / part, elements = 4000 / part, bytes = 8000000 / part;
  static const hr2d_status expected[] = {HR2D_EMAX_LINKS, HR2D_EMAX_ELEMENTS, HR2D_EMAX_BYTES};
  char phrase[3][40];
  snprintf(phrase[0], sizeof *phrase, "%llu links", (unsigned long long)links);
  snprintf(phrase[1], sizeof *phrase, "%llu elements", (unsigned long long)elements);
  snprintf(phrase[2], sizeof *phrase, "%llu bytes", (unsigned long long)bytes);
  for (int kind = 0; kind < 3; kind++)
    for (int how = 0; how < 3; how++)
      for (unsigned threads = 1; threads <= 4; threads += how == 1 ? 3 : 9) {
        test_meter m = {0, 0};
        test_links t = metered_links(&m, 0, hr2d_oracle_size());
        hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
        options.epsilon =
            kind == 1 ? 1e-4 : HR2D_EPSILON_ZERO; /* about 10¹⁰ links, or no end */
        options.max_level = kind == 1 ? 24 : UINT32_MAX;
        options.threads = threads;
        if (kind == 0) options.max_links = links;
        if (kind == 1) options.max_elements = elements, options.max_bytes = 64000000;
        if (kind == 2) options.max_bytes = bytes;
        hr2d_refine_counts counts;
        const hr2d_status status = run(&t, &options, how, &counts);
        ck_assert(status == expected[kind] || (kind == 1 && status == HR2D_EMAX_BYTES));
        if (status == expected[kind])
          ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), phrase[kind]));
        ck_assert_uint_eq(hr2d_hierarchy_count(t.hierarchy).elements, 2);
        ck_assert_uint_eq(hr2d_linkset_size(t.links), 0);
        /* It can be used as if nothing had been. */
        test_refine(&t, 1, 24);
        ck_assert_uint_gt(hr2d_linkset_size(t.links), 10);
        test_free_links(&t);
      }
  recursion book = {.epsilon = 0, .limit = ENDLESS};
  project(&book, (hr2d_segment){{0, 0}, {1, 0}}, (hr2d_segment){{1, .1}, {0, .1}}, 0);
  ck_assert_uint_ge(book.depth, ENDLESS);
  hard_case("refinement", "ε = 0 with budgets",
            hard_format("recursion goes on at depth %u, without a link", book.depth),
            hard_format("HR2D_EMAX_LINKS, _ELEMENTS or _BYTES, nothing changed"));
}
END_TEST

START_TEST(counts_are_those_of_a_refinement) {
  /* With limits of every kind that do not fail, and at any number of threads. */
  static const unsigned levels[] = {3, 9, 24, UINT32_MAX};
  for (int k = 0; k < 4; k++)
    for (int shaded = 0; shaded < 2; shaded++) {
      test_meter m = {0, 0};
      test_links t = metered_links(&m, shaded, hr2d_oracle_size());
      hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
      options.epsilon = .05;
      options.max_level = levels[k];
      ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
      const hr2d_refine_counts stored = hr2d_linkset_counts(t.links);
      for (unsigned threads = 1; threads <= 5; threads += 2) {
        test_links u = metered_links(&m, shaded, hr2d_oracle_size());
        hr2d_refine_counts counted;
        options.threads = threads;
        for (int over = 0; over < 2; over++) {
          options.max_links = stored.links - (uint64_t)over;
          options.max_elements = stored.elements;
          ck_assert_int_eq(hr2d_refine_count(u.links, &options, &counted),
                           over ? HR2D_EMAX_LINKS : HR2D_OK);
          if (over) continue;
          ck_assert_uint_eq(counted.links, stored.links);
          ck_assert_uint_eq(counted.elements, stored.elements);
          ck_assert_uint_eq(counted.limited_links, stored.limited_links);
          ck_assert_uint_eq(counted.levels, stored.levels);
          test_free_links(&u);
          u = metered_links(&m, shaded, hr2d_oracle_size());
        }
        options.max_links = 0;
        options.max_elements = stored.elements - 1;
        ck_assert_int_eq(hr2d_refine_count(u.links, &options, &counted), HR2D_EMAX_ELEMENTS);
        options.max_elements = 0;
        test_free_links(&u);
      }
      test_free_links(&t);
    }
}
END_TEST

/* A room, and a wall so much longer that the room is smaller than the wall's roundings. */
typedef struct beside_wall {
  hr2d_segment wall;
  double room;
} beside_wall;

static beside_wall draw_beside_wall(randoms *r) {
  const int k = 60 + random_below(r, 440);
  const double room = ldexp(1, -k);
  const hr2d_point p = {-ldexp(1, -random_below(r, 60)),
                        ldexp(1 + random_unit(r), -random_below(r, k))};
  const hr2d_point q = {ldexp(1, -random_below(r, 12)),
                        random_below(r, 2) ? -room : ldexp(1, -random_below(r, k))};
  return (beside_wall){random_below(r, 2) ? (hr2d_segment){p, q} : (hr2d_segment){q, p}, room};
}

/* Refused are walls that cut the room. */
static int make_beside_wall(const beside_wall *b, test_links *t) {
  const double s = b->room;
  const hr2d_point corner[] = {{-s, -s}, {s, -s}, {s, s / 2}, {0, s}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < 4; k++)
    test_add_patch(scene, (hr2d_segment){corner[k], corner[(k + 1) % 4]}, 1, .5,
                   HR2D_SIDES_FRONT);
  test_add_patch(scene, b->wall, 1, .5, HR2D_SIDES_FRONT);
  const int made = hr2d_scene_commit(scene) == HR2D_OK;
  if (made)
    *t = test_make_links(scene, NULL, NULL, NULL, NULL);
  else
    hr2d_scene_destroy(scene);
  return made;
}

START_TEST(counts_survive_roundings_of_long_walls) {
  randoms r = randoms_stream(test_seed(), 1);
  const int scenes = test_count(1000);
  int made = 0;
  uint64_t links = 0;
  for (int k = 0; k < scenes; k++) {
    const beside_wall b = draw_beside_wall(&r);
    test_links t, u;
    if (!make_beside_wall(&b, &t)) continue;
    ck_assert(make_beside_wall(&b, &u));
    const hr2d_refine_options options = test_options(.5, 6);
    hr2d_refine_counts counted;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    ck_assert_int_eq(hr2d_refine_count(u.links, &options, &counted), HR2D_OK);
    const hr2d_refine_counts stored = hr2d_linkset_counts(t.links);
    ck_assert_msg(counted.links == stored.links &&
                      counted.partial_links == stored.partial_links,
                  "%llu links, and %llu counted: room %a, wall %a %a %a %a",
                  (unsigned long long)stored.links, (unsigned long long)counted.links, b.room,
                  b.wall.a.x, b.wall.a.y, b.wall.b.x, b.wall.b.y);
    ck_assert_uint_eq(counted.blocked_pairs, stored.blocked_pairs);
    links += stored.links;
    made++;
    test_free_links(&t);
    test_free_links(&u);
  }
  ck_assert_int_gt(made, scenes / 2);
  ck_assert_uint_gt(links, (uint64_t)made);
}
END_TEST

/* Policies of no good will: never accept, and split as if nothing could end. */
static hr2d_status accept_nothing(void *ctx, const hr2d_batch *batch, const double *error,
                                  unsigned char *accepted) {
  (void)ctx;
  (void)error;
  memset(accepted, 0, batch->count);
  return HR2D_OK;
}

static hr2d_status split_as_told(void *ctx, const hr2d_batch *batch, unsigned char *split) {
  memset(split, *(const int *)ctx, batch->count);
  return HR2D_OK;
}

START_TEST(policies_that_never_accept) {
  static const hr2d_policy never = {.struct_size = sizeof never,
                                    .name = "never",
                                    .acceptable = accept_nothing,
                                    .preferred_subdivision = split_as_told};
  int splits[] = {HR2D_SPLIT_FIRST, HR2D_SPLIT_SECOND, HR2D_SPLIT_BOTH};
  for (int k = 0; k < 3; k++) {
    /* 8 doubles to a patch end it soon: 8 × 1, 1 × 8 or 8 × 8 links. */
    double patch[3][6];
    corner_at(0x1p52, patch);
    patch[0][2] = patch[1][1] = 0x1p52 + 8;
    test_links t = test_make_links(test_scene((const double(*)[6])patch, 3), NULL, NULL, &never,
                                   &splits[k]);
    const hr2d_refine_options options = test_options(HUGE_VAL, UINT32_MAX);
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    const hr2d_refine_counts c = hr2d_linkset_counts(t.links);
    ck_assert_uint_eq(c.links, k == 2 ? 64 : 8);
    ck_assert_uint_eq(c.limited_links, c.links);
    check_elements(&t);
    test_free_links(&t);
    /* At a corner on the origin splitting one for ever makes a chain of 1075 levels at the
       corner, and 2²⁴ and more leaves elsewhere: a budget it is. */
    t = touching(0);
    hr2d_linkset *endless;
    ck_assert_int_eq(hr2d_linkset_create(t.hierarchy, NULL, NULL, &never, &splits[k], &endless),
                     HR2D_OK);
    hr2d_refine_options budget = test_options(HUGE_VAL, UINT32_MAX);
    budget.max_elements = 10000;
    ck_assert_int_eq(hr2d_refine(endless, &budget), HR2D_EMAX_ELEMENTS);
    hr2d_linkset_destroy(endless);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(many_patches) {
  /* A polygon of many walls; none needs to be divided: n²/2 pairs. */
  const size_t n = test_multiplier() < .1 ? 300 : 4000;
  double(*patch)[6] = calloc(n, sizeof *patch);
  ck_assert_ptr_nonnull(patch);
  for (size_t k = 0; k < n; k++) {
    const double from = 6.283185307179586 * (double)k / (double)n;
    const double to = 6.283185307179586 * (double)((k + 1) % n) / (double)n;
    const double wall[6] = {cos(from), sin(from), cos(to), sin(to), 1, .5};
    memcpy(patch[k], wall, sizeof wall);
  }
  test_links t =
      test_make_links(test_scene((const double(*)[6])patch, n), NULL, NULL, NULL, NULL);
  free(patch);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = HUGE_VAL;
  hr2d_refine_counts counts;
  ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_OK);
  ck_assert_uint_eq(counts.links, n * (n - 1) / 2);
  options.max_links = counts.links - 1;
  ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_EMAX_LINKS);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("hard cases of refinement") {
  ADD_TESTS("depth", corners_to_the_last_bit, patches_of_few_doubles,
            policies_that_never_accept);
  ADD_TESTS("epsilon", errors_equal_to_epsilon, epsilon_at_its_ends,
            ties_do_not_depend_on_the_order);
  ADD_TESTS("budgets", bytes_stay_within_their_budget, a_budget_remembers_nothing,
            budgets_end_what_is_endless, counts_are_those_of_a_refinement,
            counts_survive_roundings_of_long_walls, many_patches);
}
