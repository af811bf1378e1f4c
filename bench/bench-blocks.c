/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures what a block of two elements costs, by order and by what is between them.  The
   line classes of the two are known from the block before. */
#include <stdio.h>

#include "bars.h"
#include "blocks/block.h"
#include "support/pair-kinds.h"
#include "timing.h"

enum { PAIRS = 40, ROUNDS = 7, BLOCKS = 200 };

static const size_t orders[] = {2, 4, 5, 6, 8, 16};
enum { ORDERS = sizeof orders / sizeof *orders };

static void add(hr2d_scene *scene, hr2d_segment s) {
  const double half = 0.5;
  const hr2d_patch patch = {.a = s.a, .b = s.b, .reflectance = &half, .reflectance_bands = 1};
  if (hr2d_scene_add(scene, &patch, NULL)) bars_fail("no patch");
}

/* Patches 0 and 1 are the pair.  NULL if walls cross, or touch where they may not. */
static hr2d_scene *scene_of(const occluded_pair *p) {
  hr2d_scene *scene = NULL;
  if (hr2d_scene_create(NULL, &scene)) bars_fail("no scene");
  add(scene, p->i);
  add(scene, p->j);
  for (size_t k = 0; k < p->count; k++) add(scene, p->occluder[k]);
  if (!hr2d_scene_commit(scene)) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

typedef struct cost {
  double seconds, kernels; /* of a block */
} cost;

/* A link knows from its exchange area that nothing is in the way. */
static double clear_area(const hr2d_hierarchy *h) {
  const hr2d_element *i = &h->element[0], *j = &h->element[1];
  return hr2d_exchange_area(&(hr2d_segment){i->a, i->b}, &(hr2d_segment){j->a, j->b});
}

static cost measure(const hr2d_hierarchy *h, size_t order, double area) {
  hr2di_integrator work;
  double block[HR2D_MAX_ORDER * HR2D_MAX_ORDER], time[ROUNDS];
  int distant;
  if (hr2di_integrator_init(&work, h, &h->alloc, order, NULL, NULL)) bars_fail("no memory");
  for (int round = 0; round < ROUNDS; round++) {
    const double start = cpu_seconds();
    work.kernels = 0;
    for (int k = 0; k < BLOCKS; k++)
      if (hr2di_block(&work, (hr2d_pair){0, 1}, area, block, &distant)) bars_fail("no block");
    time[round] = (cpu_seconds() - start) / BLOCKS;
  }
  const cost c = {median_of(time, ROUNDS), (double)work.kernels / BLOCKS};
  hr2di_integrator_clear(&work);
  return c;
}

/* The mean over pairs of a kind. */
static void run(const pair_kind *kind, int stream) {
  randoms r = randoms_stream(1, stream);
  cost sum[ORDERS] = {{0, 0}};
  for (int pairs = 0; pairs < PAIRS;) {
    const occluded_pair p = kind->draw(&r);
    hr2d_scene *scene = scene_of(&p);
    hr2d_hierarchy *h = NULL;
    if (!scene) continue;
    if (hr2d_hierarchy_create(scene, &h)) bars_fail("no hierarchy");
    for (size_t n = 0; n < ORDERS; n++) {
      const cost c = measure(h, orders[n], p.count ? 0 : clear_area(h));
      sum[n].seconds += c.seconds / PAIRS;
      sum[n].kernels += c.kernels / PAIRS;
    }
    hr2d_hierarchy_destroy(h);
    hr2d_scene_destroy(scene);
    pairs++;
  }
  printf("%-26s", kind->name);
  for (size_t n = 0; n < ORDERS; n++)
    printf("%7.2f (%3.0f)", 1e6 * sum[n].seconds, sum[n].kernels);
  printf("\n");
}

int main(void) {
  printf("microseconds of a block, and in brackets its values of the kernel\n%-26s", "order");
  for (size_t n = 0; n < ORDERS; n++) printf("%7zu      ", orders[n]);
  printf("\n");
  for (size_t k = 0; k < pair_kind_count; k++) run(&pair_kinds[k], (int)k);
  return EXIT_SUCCESS;
}
