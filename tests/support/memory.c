/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/memory.h"

#include <stdlib.h>
#include <string.h>

int test_runs_out(test_memory *m) {
  /* The hooks may be called from several threads: each gets a number of its own. */
  long left = m->until_failure;
  while (left > 0 && !atomic_compare_exchange_weak(&m->until_failure, &left, left - 1))
    ;
  if (left > 0) return 0;
  while (left == 0 && !m->for_good &&
         !atomic_compare_exchange_weak(&m->until_failure, &left, -1))
    ;
  if (left != 0) return 0;
  m->failures++;
  return 1;
}

static void *memory_allocate(void *ctx, size_t bytes) {
  test_memory *m = ctx;
  if (test_runs_out(m)) return NULL;
  m->live++;
  return malloc(bytes ? bytes : 1);
}

static void *memory_reallocate(void *ctx, void *block, size_t bytes) {
  test_memory *m = ctx;
  if (test_runs_out(m)) return NULL;
  if (!block) m->live++;
  return realloc(block, bytes ? bytes : 1);
}

static void memory_release(void *ctx, void *block) {
  if (block) ((test_memory *)ctx)->live--;
  free(block);
}

hr2d_allocator test_hooks(test_memory *memory) {
  return (hr2d_allocator){memory_allocate, memory_reallocate, memory_release, memory};
}

enum { HEADER = 16 }; /* keeps the alignment of malloc() */

static size_t size_of(const void *block) {
  size_t bytes = 0;
  if (block) memcpy(&bytes, (const char *)block - HEADER, sizeof bytes);
  return bytes;
}

static void count(test_meter *m, long long bytes) {
  const long long held = atomic_fetch_add(&m->held, bytes) + bytes;
  long long peak = m->peak;
  while (held > peak && !atomic_compare_exchange_weak(&m->peak, &peak, held))
    ;
}

static void *meter_reallocate(void *ctx, void *block, size_t bytes) {
  const size_t before = size_of(block);
  char *made = realloc(block ? (char *)block - HEADER : NULL, bytes + HEADER);
  if (!made) return NULL;
  memcpy(made, &bytes, sizeof bytes);
  count(ctx, (long long)bytes - (long long)before);
  return made + HEADER;
}

static void *meter_allocate(void *ctx, size_t bytes) {
  return meter_reallocate(ctx, NULL, bytes);
}

static void meter_release(void *ctx, void *block) {
  if (!block) return;
  count(ctx, -(long long)size_of(block));
  free((char *)block - HEADER);
}

hr2d_allocator test_metered(test_meter *meter) {
  return (hr2d_allocator){meter_allocate, meter_reallocate, meter_release, meter};
}
