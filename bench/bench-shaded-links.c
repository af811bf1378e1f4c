/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the cost of a link of a refinement for a growing number of occluders.  Fails where a
   bar is missed. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

#include "bars.h"
#include "base/clock.h"
#include "plans.h"
#include "timing.h"

enum { MOST_ROUNDS = 15 };

/* Root links first, then small elements. */
typedef struct refined {
  double roots, links;       /* seconds */
  double pairs;              /* of patches */
  uint64_t root_links, made; /* by the first step, by the second */
  uint64_t partial, blocked;
} refined;

static void refine(hr2d_scene *scene, double epsilon, refined *r) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *set = NULL;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  const double n = (double)hr2d_scene_patches(scene);
  if (hr2d_hierarchy_create(scene, &hierarchy) ||
      hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &set))
    bars_fail("no link set");
  double start = hr2di_clock_now();
  options.epsilon = 1e9;
  options.max_level = 12;
  if (hr2d_refine(set, &options)) bars_fail(hr2d_linkset_message(set));
  r->roots = hr2di_clock_now() - start;
  r->pairs = n * (n - 1) / 2;
  const hr2d_refine_counts roots = hr2d_linkset_counts(set);
  start = hr2di_clock_now();
  options.epsilon = epsilon;
  if (hr2d_refine(set, &options)) bars_fail(hr2d_linkset_message(set));
  r->links = hr2di_clock_now() - start;
  const hr2d_refine_counts all = hr2d_linkset_counts(set);
  r->root_links = roots.links;
  r->made = all.exchange_areas - roots.exchange_areas;
  r->partial = all.partial_links;
  r->blocked = all.blocked_pairs - roots.blocked_pairs;
  hr2d_linkset_destroy(set);
  hr2d_hierarchy_destroy(hierarchy);
}

static double per_link(const refined *r) {
  return 1e9 * r->links / (double)r->made;
}

/* The extra cost over the links of a convex room, per pair with an occluder in its shaft: a
   partial link or a blocked pair. */
static double per_shaded(const refined *r, double cost, double convex) {
  const double shaded = (double)(r->partial + r->blocked);
  return shaded > 0 ? (cost - convex) * (double)r->made / shaded : 0;
}

typedef struct link_cost {
  double link, shaded; /* ns */
} link_cost;

static link_cost measure_links(int n, double epsilon, double convex) {
  hr2d_scene *scene = plan_scene(plan_segments, n, 0);
  const int rounds = n < 100 ? 5 : n < 1000 ? 3 : 1;
  double roots[MOST_ROUNDS], links[MOST_ROUNDS];
  refined r = {0};
  for (int k = 0; k < rounds; k++) {
    refine(scene, epsilon, &r);
    roots[k] = 1e9 * r.roots / r.pairs;
    links[k] = per_link(&r);
  }
  hr2d_scene_destroy(scene);
  link_cost cost = {.link = median_of(links, rounds)};
  cost.shaded = per_shaded(&r, cost.link, convex);
  printf("%-8s%6d%10.0f%12llu%12llu%10llu%12llu%10.1f%8.2f%10.0f\n", "links", n,
         median_of(roots, rounds), (unsigned long long)r.root_links, (unsigned long long)r.made,
         (unsigned long long)r.partial, (unsigned long long)r.blocked, cost.link,
         convex > 0 ? cost.link / convex : 1, cost.shaded);
  return cost;
}

/* The convex room, with occlusion forced and not. */
static void measure_forced(double epsilon) {
  hr2d_scene *scene[2];
  double cost[2][MOST_ROUNDS];
  refined r = {0};
  for (int k = 0; k < 2; k++) scene[k] = plan_scene(plan_segments, 0, k);
  for (int k = 0; k < MOST_ROUNDS; k++)
    for (int m = 0; m < 2; m++) {
      refine(scene[m], epsilon, &r);
      cost[m][k] = per_link(&r);
    }
  for (int k = 0; k < 2; k++) hr2d_scene_destroy(scene[k]);
  const double without = median_of(cost[0], MOST_ROUNDS),
               with = median_of(cost[1], MOST_ROUNDS);
  printf("convex room, 1/epsilon %g: %.1f ns a link, %.1f with occlusion forced: %.3f times\n",
         1 / epsilon, without, with, with / without);
  bars_hold("forced occlusion", with / without, 1.1);
}

static void measure_refinements(int max, double epsilon) {
  printf("1/epsilon = %g\n%-8s%6s%10s%12s%12s%10s%12s%10s%8s%10s\n", 1 / epsilon, "", "n",
         "ns/root", "root links", "made", "partial", "blocked", "ns/link", "ratio",
         "ns/shaded");
  const double convex = measure_links(0, epsilon, 0).link;
  double last = 0;
  for (int n = 10; n <= max; n *= 10) {
    const link_cost cost = measure_links(n, epsilon, convex);
    if (last > 0)
      bars_hold("growth of the cost of a shaded pair", cost.shaded / last,
                log(n) / log(n / 10.));
    last = cost.shaded;
  }
}

int main(void) {
  measure_refinements(1000, 1. / 256);
  measure_forced(1. / 256);
  return bars_status();
}
