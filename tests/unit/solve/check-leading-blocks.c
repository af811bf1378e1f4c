/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Leading rows and columns of blocks, on one thread and on several. */
#include <stdlib.h>

#include "base/alloc.h"
#include "solve/leading-blocks.h"
#include "support/support.h"

enum { BLOCKS = 20000, ALL = 5, THREADS = 3 };

/* Each number tells where it is. */
static double number_at(size_t block, size_t row, size_t column) {
  return (double)(block * 100 + row * 10 + column);
}

static double *make_blocks(void) {
  double *all = malloc(sizeof *all * BLOCKS * ALL * ALL), *next = all;
  ck_assert_ptr_nonnull(all);
  for (size_t k = 0; k < BLOCKS; k++)
    for (size_t l = 0; l < ALL; l++)
      for (size_t m = 0; m < ALL; m++) *next++ = number_at(k, l, m);
  return all;
}

START_TEST(leading_numbers_are_taken) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  double *all = make_blocks();
  for (size_t order = 1; order <= ALL; order++)
    for (unsigned threads = 1; threads <= THREADS; threads++) {
      void *leading = NULL;
      ck_assert_int_eq(hr2di_leading_blocks(&leading, all, sizeof *all, BLOCKS, ALL, order,
                                            &alloc, threads, NULL),
                       HR2D_OK);
      const double *next = leading;
      for (size_t k = 0; k < BLOCKS; k++)
        for (size_t l = 0; l < order; l++)
          for (size_t m = 0; m < order; m++) ck_assert(*next++ == number_at(k, l, m));
      hr2di_alloc_free(&alloc, leading);
    }
  free(all);
}
END_TEST

static hr2d_status refuse(void *ctx, const hr2d_progress *progress) {
  (void)ctx;
  (void)progress;
  return HR2D_STOPPED;
}

START_TEST(a_callback_stops_it) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  double *all = make_blocks();
  void *leading = NULL;
  hr2di_watch watch;
  hr2di_watch_init(&watch, refuse, NULL, "solve");
  ck_assert_int_eq(
      hr2di_leading_blocks(&leading, all, sizeof *all, BLOCKS, ALL, 4, &alloc, 1, &watch),
      HR2D_STOPPED);
  hr2di_alloc_free(&alloc, leading);
  free(all);
}
END_TEST

START_TEST(more_than_memory_has_no_room) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  const double one = 1;
  void *leading = NULL;
  ck_assert_int_eq(
      hr2di_leading_blocks(&leading, &one, sizeof one, UINT64_MAX / 8, 3, 2, &alloc, 1, NULL),
      HR2D_ENOMEM);
  ck_assert_ptr_null(leading);
}
END_TEST

TEST_SUITE("leading blocks") {
  ADD_TESTS("leading blocks", leading_numbers_are_taken, a_callback_stops_it,
            more_than_memory_has_no_room);
}
