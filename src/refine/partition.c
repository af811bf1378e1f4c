/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "refine/partition.h"

#include "base/wide.h"

#ifdef HR2D_AVX2
/* The words of the pairs of a set of four, in their order; then any. */
#define WORDS(a, b, c, d)                                                                      \
  { 2 * a, 2 * a + 1, 2 * b, 2 * b + 1, 2 * c, 2 * c + 1, 2 * d, 2 * d + 1 }

static const int words_of[16][8] = {
    WORDS(0, 1, 2, 3), WORDS(0, 1, 2, 3), WORDS(1, 0, 2, 3), WORDS(0, 1, 2, 3),
    WORDS(2, 0, 1, 3), WORDS(0, 2, 1, 3), WORDS(1, 2, 0, 3), WORDS(0, 1, 2, 3),
    WORDS(3, 0, 1, 2), WORDS(0, 3, 1, 2), WORDS(1, 3, 0, 2), WORDS(0, 1, 3, 2),
    WORDS(2, 3, 0, 1), WORDS(0, 2, 3, 1), WORDS(1, 2, 3, 0), WORDS(0, 1, 2, 3)};
static const unsigned char size_of[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

/* Pairs [0, count) of a multiple of sixteen.  Four pairs are written to each array although
   some belong to the other: there is room, as both have got no more than were read. */
HR2DI_AVX2 static size_t part_sixteens(const hr2d_pair *pairs, const unsigned char *flag,
                                       size_t count, hr2d_pair *yes, hr2d_pair *no) {
  size_t in_yes = 0;
  for (size_t k = 0; k < count; k += 16) {
    const __m128i flags = _mm_loadu_si128((const void *)(flag + k));
    const unsigned zero =
        (unsigned)_mm_movemask_epi8(_mm_cmpeq_epi8(flags, _mm_setzero_si128()));
    for (size_t m = 0; m < 16; m += 4) {
      const unsigned set = zero >> m & 15;
      const __m256i four = _mm256_loadu_si256((const void *)(pairs + k + m));
      const __m256i of_no = _mm256_loadu_si256((const void *)words_of[set]);
      const __m256i of_yes = _mm256_loadu_si256((const void *)words_of[15 - set]);
      _mm256_storeu_si256((void *)(yes + in_yes), _mm256_permutevar8x32_epi32(four, of_yes));
      _mm256_storeu_si256((void *)(no + (k + m - in_yes)),
                          _mm256_permutevar8x32_epi32(four, of_no));
      in_yes += size_of[15 - set];
    }
  }
  return in_yes;
}
#else
static size_t part_sixteens(const hr2d_pair *pairs, const unsigned char *flag, size_t count,
                            hr2d_pair *yes, hr2d_pair *no) {
  (void)pairs, (void)flag, (void)count, (void)yes, (void)no;
  return 0;
}
#endif

size_t hr2di_partition(const hr2d_pair *pairs, const unsigned char *flag, size_t count,
                       hr2d_pair *yes, hr2d_pair *no) {
  const size_t wide = hr2di_wide() ? count & ~(size_t)15 : 0;
  size_t in_yes = wide > 0 ? part_sixteens(pairs, flag, wide, yes, no) : 0;
  /* No branches, as they would be mispredicted: each pair is written to both arrays. */
  for (size_t k = wide; k < count; k++) {
    const hr2d_pair pair = pairs[k];
    yes[in_yes] = pair;
    no[k - in_yes] = pair;
    in_yes += flag[k] != 0;
  }
  return in_yes;
}
