/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An oracle and a policy of the user; the geometry of a pair determines their answers. */
#include <math.h>
#include <string.h>

#include "fuzz.h"

static uint64_t hash_element(const hr2d_element *e) {
  uint64_t word[2];
  memcpy(word, &e->centre, sizeof word);
  return fuzz_hash(fuzz_hash(word[0] ^ e->patch) ^ word[1]);
}

static uint64_t hash_pair(const fuzz_callbacks *c, const hr2d_batch *batch, size_t k,
                          int symmetric) {
  const hr2d_element *i = &batch->elements[batch->pairs[k].first],
                     *j = &batch->elements[batch->pairs[k].second];
  const uint64_t one = hash_element(i), other = hash_element(j);
  REQUIRE(i->patch != j->patch);
  return fuzz_hash(c->seed ^ (symmetric ? one + other : fuzz_hash(one) + other));
}

static double error_of(const fuzz_callbacks *c, uint64_t hash) {
  const double error = (double)(hash >> 11) * 0x1p-53;
  if (!c->evil) return error;
  switch (hash & 255) {
  case 0:
    return NAN;
  case 1:
    return -1;
  case 2:
    return HUGE_VAL;
  case 3:
    return 0x1p-1074;
  default:
    return error;
  }
}

static hr2d_status estimate(const fuzz_callbacks *c, const hr2d_batch *batch, double *error,
                            int symmetric) {
  REQUIRE(batch->struct_size == sizeof *batch && batch->count > 0);
  for (size_t k = 0; k < batch->count; k++) {
    const uint64_t hash = hash_pair(c, batch, k, symmetric);
    error[k] = error_of(c, hash);
    if (c->evil && (hash & 511) == 300) return HR2D_STOPPED;
    if (c->evil && (hash & 511) == 301) return HR2D_EIO;
  }
  return HR2D_OK;
}

static hr2d_status estimate_symmetric(void *ctx, const hr2d_batch *batch, double *error) {
  return estimate(ctx, batch, error, 1);
}

static hr2d_status estimate_directed(void *ctx, const hr2d_batch *batch, double *error) {
  REQUIRE(batch->brightness);
  for (size_t k = 0; k < batch->count; k++)
    REQUIRE(batch->brightness[batch->pairs[k].second] >= 0);
  return estimate(ctx, batch, error, 0);
}

static void destroy(void *ctx) {
  ((fuzz_callbacks *)ctx)->destroyed++;
}

const hr2d_oracle fuzz_oracle_symmetric = {.struct_size = sizeof(hr2d_oracle),
                                           .name = "drawn",
                                           .flags =
                                               HR2D_ORACLE_SYMMETRIC | HR2D_ORACLE_THREAD_SAFE,
                                           .estimate = estimate_symmetric,
                                           .destroy = destroy};

const hr2d_oracle fuzz_oracle_directed = {.struct_size = sizeof(hr2d_oracle),
                                          .name = "drawn for a direction",
                                          .flags = HR2D_ORACLE_NEEDS_BRIGHTNESS,
                                          .estimate = estimate_directed,
                                          .destroy = destroy};

static hr2d_status limit(void *ctx, const hr2d_batch *batch, unsigned char *limited) {
  for (size_t k = 0; k < batch->count; k++)
    limited[k] = (hash_pair(ctx, batch, k, 1) >> 20) % 16 == 0;
  return HR2D_OK;
}

static hr2d_status split(void *ctx, const hr2d_batch *batch, unsigned char *split) {
  const fuzz_callbacks *c = ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const uint64_t hash = hash_pair(c, batch, k, 0) >> 30;
    split[k] = c->evil && hash % 512 == 0 ? 7 : (unsigned char)(hash % 3);
  }
  return HR2D_OK;
}

const hr2d_policy fuzz_policy_free = {.struct_size = sizeof(hr2d_policy),
                                      .name = "drawn",
                                      .flags = HR2D_POLICY_THREAD_SAFE,
                                      .recursion_limit = limit,
                                      .preferred_subdivision = split,
                                      .destroy = destroy};
