/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loops compiled twice: for every processor, and for those that have vectors of four doubles.

   The processor is asked at each call, which costs a load and a test.  That needs no resolver
   of the linker, as ifunc does, which static programs, sanitizers and some C libraries lack.
   Both versions round each operation once, in the same order: AVX2 does not fuse products. */
#ifndef HR2D_SRC_BASE_WIDE_H
#define HR2D_SRC_BASE_WIDE_H

/* Four numbers side by side, at any address. */
typedef double hr2di_four __attribute__((vector_size(32), aligned(8), may_alias));

/* For the parts of such a loop: a call would not be compiled for wide vectors. */
#ifdef __GNUC__
#define HR2DI_PART static inline __attribute__((always_inline))
#else
#define HR2DI_PART static inline
#endif

#ifdef HR2D_AVX2
#include <immintrin.h>

#define HR2DI_AVX2 __attribute__((target("avx2")))
static inline int hr2di_wide(void) {
  return __builtin_cpu_supports("avx2");
}

/* Defines NAME, a static function that does what the HR2DI_PART NAME_loop does. */
#define HR2DI_WIDE(name, parameters, arguments)                                                \
  HR2DI_AVX2 static void name##_avx2 parameters {                                              \
    name##_loop arguments;                                                                     \
  }                                                                                            \
  static void name parameters {                                                                \
    if (hr2di_wide())                                                                          \
      name##_avx2 arguments;                                                                   \
    else                                                                                       \
      name##_loop arguments;                                                                   \
  }
#else
static inline int hr2di_wide(void) {
  return 0;
}

#define HR2DI_WIDE(name, parameters, arguments)                                                \
  static void name parameters {                                                                \
    name##_loop arguments;                                                                     \
  }
#endif

#endif
