/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Accepted and refused pairs keep their order, and nothing is written behind `count` pairs. */
#include <string.h>

#include "refine/partition.h"
#include "support/support.h"

enum { MOST = 1024, BEHIND = 16 };

/* A flag is set with the probability of one in eight, a half, or seven in eight; any number but
   0 sets it. */
static void draw(unsigned char *flag, size_t count, randoms *r) {
  static const int few[] = {1, 4, 7};
  const int set = few[random_below(r, 3)];
  for (size_t k = 0; k < count; k++)
    flag[k] = (unsigned char)(random_below(r, 8) < set ? 1 + random_below(r, 255) : 0);
}

static int same(const hr2d_pair *p, uint32_t number) {
  return p->first == number && p->second == ~number;
}

START_TEST(order_is_kept) {
  randoms r = randoms_stream(test_seed(), 50);
  int max_of_yes = 0;
  for (int round = test_count(20000); round > 0; round--) {
    const size_t count = (size_t)random_below(&r, random_below(&r, 4) ? 70 : MOST + 1);
    hr2d_pair pair[MOST], yes[MOST + BEHIND], no[MOST + BEHIND];
    unsigned char flag[MOST];
    for (uint32_t k = 0; k < count; k++) pair[k] = (hr2d_pair){k, ~k};
    draw(flag, count, &r);
    memset(yes, 0x5a, sizeof yes);
    memset(no, 0x5a, sizeof no);
    const size_t in_yes = hr2di_partition(pair, flag, count, yes, no);
    size_t found = 0;
    for (uint32_t k = 0; k < count; k++)
      ck_assert(flag[k] ? same(&yes[found++], k) : same(&no[k - found], k));
    ck_assert_uint_eq(in_yes, found);
    for (size_t k = count; k < count + BEHIND; k++)
      ck_assert(yes[k].first == 0x5a5a5a5a && no[k].second == 0x5a5a5a5a);
    max_of_yes += 2 * in_yes > count;
  }
  printf("most pairs accepted in %d batches\n", max_of_yes);
  ck_assert_int_gt(max_of_yes, 0);
}
END_TEST

TEST_SUITE("partition") {
  ADD_TESTS("partition", order_is_kept);
}
