/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory that is counted and fails on demand.  The size of a block is stored in front of it. */
#include <errno.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

typedef union header {
  size_t bytes;
  max_align_t align;
} header;

static int runs_out(fuzz_memory *m) {
  if (m->until_failure < 0) return 0;
  if (m->until_failure > 0) {
    m->until_failure--;
    return 0;
  }
  if (!m->for_good) m->until_failure = -1;
  m->failures++;
  return 1;
}

static void count(fuzz_memory *m, size_t more, size_t less) {
  m->bytes += more;
  if (m->bytes > m->peak) m->peak = m->bytes;
  m->bytes -= less;
}

/* A failure sets errno, as malloc() does: the reader of GeoJSON learns from errno that
   jansson's lexer ran out of memory. */
static void *get(void *ctx, size_t bytes) {
  fuzz_memory *m = ctx;
  if (bytes > SIZE_MAX - sizeof(header) || runs_out(m)) {
    errno = ENOMEM;
    return NULL;
  }
  header *h = malloc(sizeof *h + bytes);
  if (!h) return NULL;
  h->bytes = bytes;
  m->live++;
  count(m, bytes, 0);
  /* A recognisable pattern, to show reads of memory that was never written. */
  return memset(h + 1, 0xA5, bytes);
}

static void put(void *ctx, void *block) {
  fuzz_memory *m = ctx;
  if (!block) return;
  header *h = (header *)block - 1;
  m->live--;
  count(m, 0, h->bytes);
  free(h);
}

/* Always moves the block, so that a stale pointer into the old one is found.  Both blocks
   exist for a moment, as in the worst realloc(). */
static void *change(void *ctx, void *block, size_t bytes) {
  void *moved = get(ctx, bytes);
  if (!moved || !block) return moved;
  const size_t before = ((header *)block - 1)->bytes;
  memcpy(moved, block, before < bytes ? before : bytes);
  put(ctx, block);
  return moved;
}

hr2d_allocator fuzz_hooks(fuzz_memory *memory) {
  return (hr2d_allocator){get, change, put, memory};
}

static fuzz_memory jansson = FUZZ_MEMORY_INIT;

static void *jansson_get(size_t bytes) {
  return get(&jansson, bytes);
}

static void jansson_put(void *block) {
  put(&jansson, block);
}

fuzz_memory *fuzz_jansson_memory(void) {
  static int installed;
  if (!installed) json_set_alloc_funcs(jansson_get, jansson_put);
  installed = 1;
  return &jansson;
}
