/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of exchange areas of scenes with images take memory, and declare work, as the pairs that
   see each other are: a matrix would take 16 times as much for 4 times the patches. */
#include <math.h>
#include <stdlib.h>

#include "base/watch.h"
#include "support/memory.h"
#include "support/random.h"
#include "support/support.h"

typedef struct cost {
  long long bytes;
  uint64_t work, entries;
} cost;

static hr2d_status note_work(void *ctx, const hr2d_progress *progress) {
  *(uint64_t *)ctx = hr2di_watch_of(progress)->total;
  return HR2D_OK;
}

/* Two-sided slats at the places of a grid, beside a mirror or in a period. */
static hr2d_scene *make(const hr2d_allocator *hooks, size_t across, int repeats) {
  randoms r = randoms_stream(test_seed(), repeats);
  const double half = .5, one = 1;
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(hooks, &scene), HR2D_OK);
  for (size_t k = 0; k < across * across; k++) {
    const double angle = 6.28 * random_unit(&r), x = 1 + (double)(k / across);
    const double y = 1 + (double)(k % across);
    hr2d_patch p = HR2D_PATCH_INIT;
    p.a = (hr2d_point){x - .45 * cos(angle), y - .45 * sin(angle)};
    p.b = (hr2d_point){x + .45 * cos(angle), y + .45 * sin(angle)};
    p.reflectance = &half;
    p.reflectance_bands = 1;
    p.sides = HR2D_SIDES_BOTH;
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_set_background(scene, &one, 1), HR2D_OK);
  ck_assert_int_eq(repeats ? hr2d_scene_set_period(scene, (hr2d_point){(double)across + 1, 0})
                           : hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 0}, {0, 1}}),
                   HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

static hr2d_status count_entries(void *ctx, const hr2d_exchange_row *row) {
  ((cost *)ctx)->entries += row->count;
  return HR2D_OK;
}

static cost cost_of(size_t across, int repeats, int visits) {
  test_meter meter = {0};
  const hr2d_allocator hooks = test_metered(&meter);
  hr2d_scene *scene = make(&hooks, across, repeats);
  cost c = {0};
  hr2d_exchange_rows *rows = NULL;
  hr2d_scene_set_progress(scene, note_work, &c.work);
  const long long before = meter.held;
  meter.peak = before;
  ck_assert_int_eq(visits ? hr2d_exchange_rows_visit(scene, NULL, count_entries, &c, NULL)
                          : hr2d_exchange_rows_create(scene, NULL, &rows, NULL),
                   HR2D_OK);
  c.bytes = meter.peak - before;
  if (rows) c.entries = hr2d_exchange_rows_entries(rows);
  hr2d_exchange_rows_destroy(rows);
  hr2d_scene_destroy(scene);
  return c;
}

START_TEST(rows_of_images_cost_what_is_there) {
  const int repeats = _i / 2, visits = _i % 2;
  const cost few = cost_of(20, repeats, visits), many = cost_of(40, repeats, visits);
  ck_assert_uint_gt(few.entries, 1000);
  const double growth = (double)many.entries / (double)few.entries;
  ck_assert(growth > 3 && growth < 6);
  /* Arrays grow by doubling. */
  ck_assert_msg((double)many.bytes < 2 * growth * (double)few.bytes, "%lld and %lld bytes",
                few.bytes, many.bytes);
  ck_assert_msg((double)many.work < 2 * growth * (double)few.work, "%llu and %llu of work",
                (unsigned long long)few.work, (unsigned long long)many.work);
  /* Less than a matrix of doubles takes. */
  ck_assert(many.bytes < 8ll * 3200 * 3200 / 3);
}
END_TEST

TEST_SUITE("image memory") {
  REPEAT_TESTS(4, "rows", rows_of_images_cost_what_is_there);
}
