/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sum that was just stored is not loaded again at once, so that a link after the other takes
   the time of that, not of its products.  In one band and both ways sums of squares of links
   stay in registers, see store.h. */
#include "solve/gather-areas.h"

#include <string.h>

#include "base/wide.h"

static void gather_each(const hr2d_link *link, size_t count, size_t bands, int directed,
                        const double *up, double *down) {
  for (size_t k = 0; k < count; k++) {
    const size_t i = link[k].pair.first * bands, j = link[k].pair.second * bands;
    const double area = link[k].exchange_area;
    for (size_t b = 0; b < bands; b++) down[i + b] += area * up[j + b];
    for (size_t b = 0; b < bands && !directed; b++) down[j + b] += area * up[i + b];
  }
}

static inline void gather_one(hr2d_pair p, double area, const double *up, double *down) {
  down[p.first] += area * up[p.second];
  down[p.second] += area * up[p.first];
}

/* Two elements side by side: what they send, and the sums of what they receive. */
typedef struct couple {
  double from[2], to[2];
} couple;

static inline couple load(uint32_t element, const double *up, const double *down) {
  const double *u = up + element, *d = down + element;
  return (couple){{u[0], u[1]}, {d[0], d[1]}};
}

static inline void store(const couple *c, uint32_t element, double *down) {
  memcpy(down + element, c->to, sizeof c->to);
}

/* The links (i,j), (i,j+1), (i+1,j), (i+1,j+1). */
static inline void add_square(double a, double b, double c, double d, couple *i, couple *j) {
  const double column[2][2] = {{a, c}, {b, d}}, row[2][2] = {{a, b}, {c, d}};
  for (int m = 0; m < 2; m++)
    i->to[m] = (i->to[m] + column[0][m] * j->from[0]) + column[1][m] * j->from[1];
  for (int m = 0; m < 2; m++)
    j->to[m] = (j->to[m] + row[0][m] * i->from[0]) + row[1][m] * i->from[1];
}

/* The areas of a square are `stride` numbers apart. */
static inline void add_areas(const double *area, size_t stride, couple *i, couple *j) {
  add_square(area[0], area[stride], area[2 * stride], area[3 * stride], i, j);
}

static inline void gather_square(hr2d_pair p, const double *area, size_t stride,
                                 const double *up, double *down) {
  couple i = load(p.first, up, down), j = load(p.second, up, down);
  add_areas(area, stride, &i, &j);
  store(&i, p.first, down);
  store(&j, p.second, down);
}

enum { AREA_STRIDE = sizeof(hr2d_link) / sizeof(double) };

/* The elements of a link in one number. */
static inline uint64_t ends_of(const hr2d_link *link) {
  return (uint64_t)link->pair.second << 32 | link->pair.first;
}

static inline int is_square(const hr2d_link *link) {
  const uint64_t ends = ends_of(link), j = (uint64_t)1 << 32, i = 1;
  return ((ends_of(link + 1) ^ (ends + j)) | (ends_of(link + 2) ^ (ends + i)) |
          (ends_of(link + 3) ^ (ends + i + j))) == 0;
}

static void gather_links(const hr2d_link *link, size_t count, const double *up, double *down) {
  for (size_t k = 0; k < count;) {
    const hr2d_link *at = link + k;
    if (k + HR2DI_SQUARE > count || !is_square(at)) {
      gather_one(at->pair, at->exchange_area, up, down);
      k++;
    } else {
      gather_square(at->pair, &at->exchange_area, AREA_STRIDE, up, down);
      k += HR2DI_SQUARE;
    }
  }
}

/* A large square, whose first and last square begin with p and q. */
typedef void (*gather_large_fn)(hr2d_pair p, hr2d_pair q, const double *area, const double *up,
                                double *down);

static inline void gather_large(hr2d_pair p, hr2d_pair q, const double *area, const double *up,
                                double *down) {
  couple i = load(p.first, up, down), j = load(p.second, up, down);
  couple k = load(q.first, up, down), l = load(q.second, up, down);
  add_areas(area, 1, &i, &j);
  add_areas(area + 4, 1, &i, &l);
  add_areas(area + 8, 1, &k, &j);
  add_areas(area + 12, 1, &k, &l);
  store(&i, p.first, down);
  store(&j, p.second, down);
  store(&k, q.first, down);
  store(&l, q.second, down);
}

HR2DI_PART void gather_block(const hr2di_packed *p, size_t from, const double *up, double *down,
                             gather_large_fn large) {
  const uint32_t *element = p->element + p->begin[from / HR2DI_BLOCK_LINKS];
  for (size_t k = from; k < from + HR2DI_BLOCK_LINKS;) {
    const hr2d_pair at = {element[p->first[k]], element[p->second[k]]};
    const double *area = p->area + k;
    if (hr2di_store_is_marked(p->large, k)) {
      const size_t last = k + HR2DI_LARGE_SQUARE - HR2DI_SQUARE;
      large(at, (hr2d_pair){element[p->first[last]], element[p->second[last]]}, area, up, down);
      k += HR2DI_LARGE_SQUARE;
    } else if (hr2di_store_is_marked(p->square, k)) {
      gather_square(at, area, 1, up, down);
      k += HR2DI_SQUARE;
    } else {
      gather_one(at, *area, up, down);
      k++;
    }
  }
}

#ifdef HR2D_AVX2
HR2DI_AVX2 static inline __m256d join(const double *low, const double *high) {
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(low)), _mm_loadu_pd(high), 1);
}

HR2DI_AVX2 static inline void split(__m256d all, double *low, double *high) {
  _mm_storeu_pd(low, _mm256_castpd256_pd128(all));
  _mm_storeu_pd(high, _mm256_extractf128_pd(all, 1));
}

HR2DI_AVX2 static inline __m256d add(__m256d sum, __m256d area, const double *from) {
  return _mm256_add_pd(sum, _mm256_mul_pd(area, _mm256_broadcast_sd(from)));
}

/* The areas are rows of a 4×4 matrix, for two couples, and its columns for the two others. */
HR2DI_AVX2 static inline void gather_large_wide(hr2d_pair p, hr2d_pair q, const double *area,
                                                const double *up, double *down) {
  const double *i = up + p.first, *k = up + q.first, *j = up + p.second, *l = up + q.second;
  const __m256d a = join(area, area + 4), b = join(area + 2, area + 6),
                c = join(area + 8, area + 12), d = join(area + 10, area + 14);
  const __m256d ab = _mm256_unpacklo_pd(a, b), ab_next = _mm256_unpackhi_pd(a, b),
                cd = _mm256_unpacklo_pd(c, d), cd_next = _mm256_unpackhi_pd(c, d);
  __m256d to = join(down + p.first, down + q.first);
  to = add(to, _mm256_permute2f128_pd(ab, cd, 0x20), j);
  to = add(to, _mm256_permute2f128_pd(ab_next, cd_next, 0x20), j + 1);
  to = add(to, _mm256_permute2f128_pd(ab, cd, 0x31), l);
  to = add(to, _mm256_permute2f128_pd(ab_next, cd_next, 0x31), l + 1);
  split(to, down + p.first, down + q.first);
  to = join(down + p.second, down + q.second);
  to = add(add(add(add(to, a, i), b, i + 1), c, k), d, k + 1);
  split(to, down + p.second, down + q.second);
}

HR2DI_AVX2 static void gather_packed_avx2(const hr2di_packed *p, const double *up,
                                          double *down) {
  for (size_t k = 0; k < HR2DI_CHUNK_LINKS; k += HR2DI_BLOCK_LINKS)
    gather_block(p, k, up, down, gather_large_wide);
}
#else
#define gather_packed_avx2(p, up, down)
#endif

static void gather_packed(const hr2di_packed *p, const double *up, double *down) {
  if (hr2di_wide()) {
    gather_packed_avx2(p, up, down);
    return;
  }
  for (size_t k = 0; k < HR2DI_CHUNK_LINKS; k += HR2DI_BLOCK_LINKS)
    gather_block(p, k, up, down, gather_large);
}

void hr2di_gather_areas(const hr2di_store *store, size_t chunk, size_t bands, int directed,
                        const double *up, double *down) {
  const int simple = bands == 1 && !directed;
  const size_t count = hr2di_store_chunk_size(store, chunk);
  hr2d_link room[HR2DI_READ_LINKS];
  if (simple && hr2di_store_is_packed(store, chunk)) {
    gather_packed(store->chunk[chunk].data, up, down);
    return;
  }
  for (size_t from = 0, some; from < count; from += some) {
    some = count - from;
    const hr2d_link *link =
        hr2di_store_read(store, (uint64_t)chunk * HR2DI_CHUNK_LINKS + from, &some, room);
    if (simple)
      gather_links(link, some, up, down);
    else
      gather_each(link, some, bands, directed, up, down);
  }
}
