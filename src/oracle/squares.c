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
   length are one vector, whose last part is no number and meets no product. */
_Static_assert(offsetof(hr2d_element, length) == offsetof(hr2d_element, centre) + 16 &&
                   sizeof(hr2d_element) >= offsetof(hr2d_element, centre) + 32,
               "centre, length and one word more are side by side");

/* Two pairs: x and y of the vectors between their centres, and the longer elements. */
typedef struct two_pairs {
  __m256d x, y; /* in the lower half */
  __m256d a;    /* in the upper half */
} two_pairs;

HR2DI_AVX2 static inline two_pairs take_two(const hr2d_element *element,
                                            const hr2d_pair *pair) {
  const __m256d i0 = _mm256_loadu_pd(&element[pair[0].first].centre.x);
  const __m256d j0 = _mm256_loadu_pd(&element[pair[0].second].centre.x);
  const __m256d i1 = _mm256_loadu_pd(&element[pair[1].first].centre.x);
  const __m256d j1 = _mm256_loadu_pd(&element[pair[1].second].centre.x);
  const __m256d d0 = _mm256_sub_pd(j0, i0), d1 = _mm256_sub_pd(j1, i1);
  return (two_pairs){_mm256_unpacklo_pd(d0, d1), _mm256_unpackhi_pd(d0, d1),
                     _mm256_unpacklo_pd(_mm256_max_pd(i0, j0), _mm256_max_pd(i1, j1))};
}

HR2DI_AVX2 static double accept_fours(const hr2d_batch *batch, size_t count, double epsilon2,
                                      unsigned char *accepted) {
  const __m256d sign = _mm256_set1_pd(-0.0), ulps = _mm256_set1_pd(16 * DBL_EPSILON);
  __m256d margin = _mm256_set1_pd(1);
  for (size_t k = 0; k < count; k += 4) {
    const two_pairs p = take_two(batch->elements, batch->pairs + k);
    const two_pairs q = take_two(batch->elements, batch->pairs + k + 2);
    const __m256d a = _mm256_permute2f128_pd(p.a, q.a, 0x31), a2 = _mm256_mul_pd(a, a);
    const __m256d x = _mm256_permute2f128_pd(p.x, q.x, 0x20);
    const __m256d y = _mm256_permute2f128_pd(p.y, q.y, 0x20);
    const __m256d r2 = _mm256_add_pd(_mm256_mul_pd(x, x), _mm256_mul_pd(y, y));
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
