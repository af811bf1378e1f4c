/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "oracle/squares.h"

#include <stddef.h>
#include <string.h>

#include "base/wide.h"

static double smaller(double p, double q) {
  return p < q ? p : q;
}

#ifdef HR2D_AVX2
/* Four pairs at a time, each operation as in hr2di_squares_excess().  An element's centre and
   length are one vector: its fourth part is no number and is cleared. */
_Static_assert(offsetof(hr2d_element, length) == offsetof(hr2d_element, centre) + 16 &&
                   sizeof(hr2d_element) >= offsetof(hr2d_element, centre) + 32,
               "centre, length and one word more are side by side");

HR2DI_AVX2 static inline __m256d centre_and_length(const hr2d_element *e) {
  const __m256d numbers = _mm256_castsi256_pd(_mm256_set_epi64x(0, -1, -1, -1));
  return _mm256_and_pd(_mm256_loadu_pd(&e->centre.x), numbers);
}

/* dx², dy², A², 0 */
HR2DI_AVX2 static inline __m256d squares_of(const hr2d_element *element, hr2d_pair pair) {
  const __m256d i = centre_and_length(&element[pair.first]);
  const __m256d j = centre_and_length(&element[pair.second]);
  const __m256d v = _mm256_blend_pd(_mm256_sub_pd(j, i), _mm256_max_pd(i, j), 12);
  return _mm256_mul_pd(v, v);
}

HR2DI_AVX2 static double accept_fours(const hr2d_batch *batch, size_t count, double epsilon2,
                                      unsigned char *accepted) {
  const hr2d_element *e = batch->elements;
  const __m256d sign = _mm256_set1_pd(-0.0), ulps = _mm256_set1_pd(16 * DBL_EPSILON);
  __m256d margin = _mm256_set1_pd(1);
  for (size_t k = 0; k < count; k += 4) {
    const hr2d_pair *pair = batch->pairs + k;
    const __m256d s0 = squares_of(e, pair[0]), s1 = squares_of(e, pair[1]);
    const __m256d s2 = squares_of(e, pair[2]), s3 = squares_of(e, pair[3]);
    const __m256d low = _mm256_unpacklo_pd(s0, s1), high = _mm256_unpacklo_pd(s2, s3);
    const __m256d a2 = _mm256_permute2f128_pd(low, high, 0x31);
    const __m256d r2 =
        _mm256_permute2f128_pd(_mm256_add_pd(low, _mm256_unpackhi_pd(s0, s1)),
                               _mm256_add_pd(high, _mm256_unpackhi_pd(s2, s3)), 0x20);
    const __m256d excess = _mm256_sub_pd(a2, _mm256_mul_pd(_mm256_set1_pd(epsilon2), r2));
    margin = _mm256_min_pd(
        _mm256_sub_pd(_mm256_andnot_pd(sign, excess), _mm256_mul_pd(ulps, a2)), margin);
    const unsigned yes =
        (unsigned)_mm256_movemask_pd(_mm256_cmp_pd(excess, _mm256_setzero_pd(), _CMP_LE_OQ));
    const uint32_t bytes = yes * 0x204081u & 0x1010101u; /* bit b to byte b */
    memcpy(accepted + k, &bytes, sizeof bytes);
  }
  double part[4];
  _mm256_storeu_pd(part, margin);
  return smaller(smaller(part[0], part[1]), smaller(part[2], part[3]));
}
#else
static double accept_fours(const hr2d_batch *batch, size_t count, double epsilon2,
                           unsigned char *accepted) {
  (void)batch, (void)count, (void)epsilon2, (void)accepted;
  return 1;
}
#endif

double hr2di_squares_accept(const hr2d_batch *batch, double epsilon2, unsigned char *accepted) {
  const size_t fours = hr2di_wide() ? batch->count & ~(size_t)3 : 0;
  double margin = fours > 0 ? accept_fours(batch, fours, epsilon2, accepted) : 1;
  for (size_t k = fours; k < batch->count; k++) {
    const hr2d_pair pair = batch->pairs[k];
    double a2;
    const double excess = hr2di_squares_excess(&batch->elements[pair.first],
                                               &batch->elements[pair.second], epsilon2, &a2);
    accepted[k] = excess <= 0;
    margin = smaller(margin, hr2di_squares_margin(excess, a2));
  }
  return margin;
}
