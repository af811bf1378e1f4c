/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the harnesses: bytes read as choices and numbers, memory that is counted and
   runs out, and invariants of every result. */
#ifndef HR2D_FUZZ_FUZZ_H
#define HR2D_FUZZ_FUZZ_H

#include <hr2d/hr2d.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The harness itself, as libFuzzer calls it. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Ends the run where an invariant does not hold; NDEBUG does not switch it off. */
#define REQUIRE(condition)                                                                     \
  do {                                                                                         \
    if (!(condition)) fuzz_fail(__FILE__, __LINE__, #condition, "");                           \
  } while (0)

/* The same with a text that says more. */
#define REQUIRE_SAYING(condition, text)                                                        \
  do {                                                                                         \
    if (!(condition)) fuzz_fail(__FILE__, __LINE__, #condition, text);                         \
  } while (0)

_Noreturn void fuzz_fail(const char *file, int line, const char *condition, const char *text);

/* Bytes that are written, from malloc(), and read from `at` on, as callbacks of state.h. */
typedef struct fuzz_stream {
  uint8_t *byte;
  size_t size, room, at;
} fuzz_stream;

hr2d_status fuzz_record(void *stream, const void *data, size_t size);
hr2d_status fuzz_play(void *stream, void *data, size_t size);

/* Bytes that are still to be read; behind their end there are zeros for ever. */
typedef struct fuzz_input {
  const uint8_t *at, *end;
} fuzz_input;

unsigned fuzz_byte(fuzz_input *in);
unsigned fuzz_below(fuzz_input *in, unsigned n); /* n ≤ 256 */
uint64_t fuzz_word(fuzz_input *in);
double fuzz_raw(fuzz_input *in);    /* any double, by its bits */
double fuzz_finite(fuzz_input *in); /* the same; 0 in place of infinity and NaN */
double fuzz_unit(fuzz_input *in);   /* [0,1], its ends among the likely values */

static inline int fuzz_same_bits(double x, double y) {
  return memcmp(&x, &y, sizeof x) == 0;
}

/* A mixing function, for decisions that depend on nothing else than their arguments. */
uint64_t fuzz_hash(uint64_t x);
uint64_t fuzz_hash_bytes(const uint8_t *data, size_t size);

/* Memory that is counted, and fails on demand: the hooks' ctx. */
typedef struct fuzz_memory {
  long until_failure; /* allocations that still succeed; negative: no failure */
  int for_good;       /* once it has failed it fails until it is mended */
  long failures;
  long live;          /* blocks not yet released */
  size_t bytes, peak; /* in use, overhead of malloc not included */
} fuzz_memory;

#define FUZZ_MEMORY_INIT                                                                       \
  { -1, 0, 0, 0, 0, 0 }

hr2d_allocator fuzz_hooks(fuzz_memory *memory);

/* The memory of jansson.  Its hooks are global: they are installed once, before anything
   else. */
fuzz_memory *fuzz_jansson_memory(void);

/* A user's oracle and policy whose answers are drawn from the geometry of a pair, so that
   they are the same whenever it is asked again.  `seed` is the ctx. */
typedef struct fuzz_callbacks {
  uint64_t seed;
  int evil;      /* NaN, negative, infinite, failures and nonsense among the answers */
  int destroyed; /* how often destroy was called */
} fuzz_callbacks;

extern const hr2d_oracle fuzz_oracle_symmetric, fuzz_oracle_directed;
extern const hr2d_policy fuzz_policy_free;

/* Adds patches whose coordinates are ulps apart, collinear, touching, crossing, on every
   scale.  At most `max`. */
void fuzz_fill_scene(fuzz_input *in, hr2d_scene *scene, size_t max);

/* Checks the matrix of a committed scene: exchange areas are finite, not negative and
   symmetric bit by bit, and no row exceeds the length of its patch. */
void fuzz_check_matrix(const hr2d_scene *scene, hr2d_status status, const double *area);

/* Checks a refined set: coverage, trees, links. */
void fuzz_check_links(hr2d_linkset *links);

/* Checks a hierarchy; refused calls must not have changed it. */
void fuzz_check_hierarchy(const hr2d_hierarchy *hierarchy);

/* Checks a solution: it is finite, not negative at order 1, its power is balanced, and no
   patch is brighter than the walls of a furnace. */
void fuzz_check_solution(const hr2d_solution *solution, unsigned order, int closure);

/* Whether patches have lengths within 1e4 of each other. */
int fuzz_is_even(const hr2d_scene *scene);

/* Whether a text is UTF-8, whatever characters it has. */
int fuzz_is_utf8(const char *text);

/* A message that was left by a failure: there is one, and it is UTF-8. */
void fuzz_check_message(const char *message);

#endif
