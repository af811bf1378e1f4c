/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sums of moments.c over batches of directions, in vectors of HR2DI_WIDTH doubles, which is
   2 or 4.  moments.c includes this once for each width: compilers make poor code of vectors
   that are wider than those of the processor.  Each sum has four partial sums, so that no bit
   depends on the width, nor on what fills the last batch.  `wide` is the number of vectors in a
   batch, a constant to the compiler. */
#define PASTE_NAMES(name, width) name##_##width
#define WITH_WIDTH(name, width)  PASTE_NAMES(name, width)
#define NAME(name)               WITH_WIDTH(name, HR2DI_WIDTH)
#define VECTOR                   NAME(vector)
#define PARTS                    (4 / HR2DI_WIDTH)
#define VECTORS                  (LANES / HR2DI_WIDTH)

typedef double VECTOR __attribute__((vector_size(8 * HR2DI_WIDTH), aligned(8), may_alias));

/* The rows r_lk of one element for all k ≤ l < order, a vector of lanes after the other; 0
   behind an even row, as rows are multiplied in twos. */
HR2DI_PART void NAME(expand)(const hr2di_moments *w, size_t p, const hr2di_directions *d,
                             size_t from, size_t wide, size_t side) {
  const VECTOR *centre = (const VECTOR *)(d->centre[side] + from);
  const VECTOR *half = (const VECTOR *)(d->half[side] + from);
  VECTOR *row = (VECTOR *)w->row[side];
  const size_t stride = even(p) * wide;
  for (size_t x = 0; x < wide; x++, row++) {
    const VECTOR c = centre[x], square = half[x] * half[x];
    row[0] = c * 0 + 1;
    row[wide] = c * 0;
    for (size_t l = 1; l < p; l++) {
      const VECTOR *last = row + (l - 1) * stride, *before = l > 1 ? last - stride : last;
      VECTOR *next = row + l * stride;
      const double down = w->square[l - 1];
      VECTOR left = c * 0, here = last[0];
      for (size_t k = 0; k + 1 < l; k++) {
        const VECTOR right = last[(k + 1) * wide];
        next[k * wide] =
            (c * here - down * before[k * wide]) + (left + w->square[k + 1] * square * right);
        left = here;
        here = right;
      }
      next[(l - 1) * wide] = c * here + left;
      next[l * wide] = row[0];
      if (l % 2 == 0) next[(l + 1) * wide] = c * 0;
    }
  }
}

/* r_lk of i *= weight ν_k (−hh')^k */
HR2DI_PART void NAME(weigh)(const hr2di_moments *w, size_t p, const hr2di_directions *d,
                            size_t from, size_t wide) {
  const VECTOR *weight = (const VECTOR *)(d->weight + from);
  const VECTOR *half = (const VECTOR *)(d->half[0] + from);
  const VECTOR *other = (const VECTOR *)(d->half[1] + from);
  VECTOR *row = (VECTOR *)w->row[0];
  const size_t stride = even(p) * wide;
  for (size_t x = 0; x < wide; x++, row++) {
    const VECTOR product = -(half[x] * other[x]);
    VECTOR power = weight[x];
    for (size_t k = 0; k < p; k++) {
      const VECTOR factor = w->norm[k] * power;
      for (size_t l = k; l < p; l++) row[l * stride + k * wide] *= factor;
      power *= product;
    }
  }
}

/* The sum of four partial sums. */
HR2DI_PART double NAME(total)(const VECTOR sum[PARTS]) {
  const double *s = (const double *)sum;
  return hr2di_dot_four(s[0], s[1], s[2], s[3]);
}

/* Σ_x a[x] b[x] for two rows a and two rows b. */
HR2DI_PART void NAME(multiply)(const VECTOR *a, const VECTOR *b, size_t stride, size_t count,
                               double sum[2][2]) {
  VECTOR s[2][2][PARTS] = {0};
  for (size_t x = 0; x < count; x += PARTS)
    for (size_t r = 0; r < 2; r++)
      for (size_t c = 0; c < 2; c++)
        for (size_t part = 0; part < PARTS; part++)
          s[r][c][part] += a[r * stride + x + part] * b[c * stride + x + part];
  for (size_t r = 0; r < 2; r++)
    for (size_t c = 0; c < 2; c++) sum[r][c] = NAME(total)(s[r][c]);
}

/* Sums of rows beyond the order, which is rounded up to even, are left alone. */
HR2DI_PART void NAME(add_product)(const hr2di_moments *w, size_t p, size_t wide,
                                  double *block) {
  const size_t stride = even(p) * wide;
  const VECTOR *row_i = (const VECTOR *)w->row[0], *row_j = (const VECTOR *)w->row[1];
  for (size_t l = 0; l < p; l += 2)
    for (size_t m = 0; m < p; m += 2) {
      double sum[2][2];
      const size_t terms = l < m ? l + 2 : m + 2;
      NAME(multiply)(row_i + l * stride, row_j + m * stride, stride, terms * wide, sum);
      for (size_t r = l; r < p && r < l + 2; r++)
        for (size_t c = m; c < p && c < m + 2; c++)
          block[r * p + c] += w->scale[r] * w->scale[c] * sum[r - l][c - m];
    }
}

HR2DI_PART void NAME(add_batch)(const hr2di_moments *w, size_t p, const hr2di_directions *d,
                                size_t from, size_t wide, double *block) {
  NAME(expand)(w, p, d, from, wide, 0);
  NAME(expand)(w, p, d, from, wide, 1);
  NAME(weigh)(w, p, d, from, wide);
  NAME(add_product)(w, p, wide, block);
}

/* The same for lines that cover the other element than `side`. */
HR2DI_PART void NAME(add_covering)(const hr2di_moments *w, size_t p, const hr2di_directions *d,
                                   size_t from, size_t wide, size_t side, double *block) {
  const size_t stride = even(p) * wide;
  const VECTOR *weight = (const VECTOR *)(d->weight + from);
  const VECTOR *half = (const VECTOR *)(d->half[side] + from);
  const VECTOR *row = (const VECTOR *)w->row[side];
  VECTOR factor[VECTORS], sum[PARTS];
  NAME(expand)(w, p, d, from, wide, side);
  for (size_t x = 0; x < wide; x++) factor[x] = weight[x];
  for (size_t k = 0; k < p; k++) {
    for (size_t m = k; m < p; m++) {
      const VECTOR *at = row + m * stride + k * wide;
      for (size_t part = 0; part < PARTS; part++) {
        sum[part] = factor[part] * at[part];
        for (size_t x = part + PARTS; x < wide; x += PARTS) sum[part] += factor[x] * at[x];
      }
      block[side ? k * p + m : m * p + k] +=
          w->norm[k] * w->scale[k] * w->scale[m] * NAME(total)(sum);
    }
    for (size_t x = 0; x < wide; x++) factor[x] *= -half[x];
  }
}

HR2DI_PART void NAME(add_some)(const hr2di_moments *w, size_t p, hr2di_cover cover, size_t from,
                               size_t wide, double *block) {
  const hr2di_directions *d = &w->waiting[cover];
  if (cover == HR2DI_COVERS_NEITHER)
    NAME(add_batch)(w, p, d, from, wide, block);
  else
    NAME(add_covering)(w, p, d, from, wide, cover, block);
}

HR2DI_PART void NAME(add_all)(const hr2di_moments *w, size_t p, hr2di_cover cover, size_t count,
                              double *block) {
  size_t from = 0;
  for (; from + LANES <= count; from += LANES)
    NAME(add_some)(w, p, cover, from, VECTORS, block);
  if (from < count) NAME(add_some)(w, p, cover, from, PARTS, block);
}

/* Adds the first `count` directions that wait: full batches, and half of one at the end. Orders
   that are common are constants to the compiler, in wide vectors. */
#if HR2DI_WIDTH == 4
HR2DI_AVX2
#endif
static void NAME(add_batches)(const hr2di_moments *w, hr2di_cover cover, size_t count,
                              double *block) {
  switch (HR2DI_WIDTH == 4 ? w->order : 0) {
  case 4:
    NAME(add_all)(w, 4, cover, count, block);
    return;
  case 5:
    NAME(add_all)(w, 5, cover, count, block);
    return;
  case 6:
    NAME(add_all)(w, 6, cover, count, block);
    return;
  case 7:
    NAME(add_all)(w, 7, cover, count, block);
    return;
  case 8:
    NAME(add_all)(w, 8, cover, count, block);
    return;
  default:
    NAME(add_all)(w, w->order, cover, count, block);
  }
}

#undef PASTE_NAMES
#undef WITH_WIDTH
#undef NAME
#undef VECTOR
#undef VECTORS
#undef PARTS
#undef HR2DI_WIDTH
