/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory that runs out, and memory that is counted. */
#ifndef HR2D_TESTS_SUPPORT_MEMORY_H
#define HR2D_TESTS_SUPPORT_MEMORY_H

#include <hr2d/memory.h>
#include <stdatomic.h>
#include <stddef.h>

/* Memory that runs out: the ctx of its hooks. */
typedef struct test_memory {
  atomic_long until_failure; /* allocations that still succeed; negative: all do */
  int for_good;              /* all allocations after the first failure fail, too */
  atomic_long failures;
  atomic_long live; /* blocks not yet released */
} test_memory;

hr2d_allocator test_hooks(test_memory *memory);

/* Counts an allocation; returns whether it must fail. */
int test_runs_out(test_memory *memory);

/* Memory whose bytes are counted: the ctx of its hooks.  The size of a block is stored in front
   of it. */
typedef struct test_meter {
  atomic_llong held, peak; /* bytes now, and at most so far */
} test_meter;

hr2d_allocator test_metered(test_meter *meter);

#endif
