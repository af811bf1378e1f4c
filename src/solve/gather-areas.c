/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sum that was just stored is not loaded again at once, so that a link after the other takes
   the time of that, not of its products.  In one band and both ways nearly all links are four
   in a square: they join two elements, which are neighbours, with two others.  Their sums stay
   in registers.  Packed squares are mostly four in a large one, which joins two couples with
   two others: that pays for the search of their elements. */
#include "solve/gather-areas.h"

#include <string.h>

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

enum { SQUARE = 4, LARGE = 16, AREA_STRIDE = sizeof(hr2d_link) / sizeof(double) };

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
    if (k + SQUARE > count || !is_square(at)) {
      gather_one(at->pair, at->exchange_area, up, down);
      k++;
    } else {
      gather_square(at->pair, &at->exchange_area, AREA_STRIDE, up, down);
      k += SQUARE;
    }
  }
}

/* The links of a packed block: places of their elements in its list. */
typedef struct block {
  const uint32_t *element;
  const unsigned char *first, *second;
  const double *area;
} block;

static inline hr2d_pair pair_of(const block *b, size_t k) {
  return (hr2d_pair){b->element[b->first[k]], b->element[b->second[k]]};
}

/* Four places in one number. */
static inline uint32_t four(const unsigned char *place) {
  uint32_t all;
  memcpy(&all, place, sizeof all);
  return all;
}

/* Whether places of first elements are i, i, k, k and those of second ones j, l, j, l. */
static inline int has_places_of_square(uint32_t first, uint32_t second) {
  const uint32_t odd = 0xff00ff, swapped = (first & odd) << 8 | (first >> 8 & odd);
  return ((first ^ swapped) | (second ^ (second << 16 | second >> 16))) == 0;
}

/* Whether the four links from number k on are a square. */
static inline int is_packed_square(const block *b, size_t k) {
  const hr2d_pair p = pair_of(b, k), q = pair_of(b, k + 3);
  return has_places_of_square(four(b->first + k), four(b->second + k)) &&
         q.first == p.first + 1 && q.second == p.second + 1;
}

/* Whether couples that begin with these elements have none in common.  Those that are linked
   never have. */
static inline int are_apart(uint32_t a, uint32_t b) {
  return a - b + 1 > 2;
}

/* The same for a large square, whose first square is one: squares in a row have the same places
   of first elements, those in a column of second ones. */
static inline int is_packed_large(const block *b, size_t k) {
  const unsigned char *i = b->first + k, *j = b->second + k;
  const uint32_t rows =
      (four(i) ^ four(i + SQUARE)) | (four(i + 2 * SQUARE) ^ four(i + 3 * SQUARE));
  const uint32_t columns =
      (four(j) ^ four(j + 2 * SQUARE)) | (four(j + SQUARE) ^ four(j + 3 * SQUARE));
  const hr2d_pair p = pair_of(b, k), q = pair_of(b, k + 3 * SQUARE);
  return (rows | columns) == 0 && is_packed_square(b, k + 3 * SQUARE) &&
         are_apart(p.first, q.first) && are_apart(p.second, q.second);
}

/* Squares join p.first with p.second and with q.second, then q.first with both. */
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

static void gather_block(const block *b, const double *up, double *down) {
  for (size_t k = 0; k < HR2DI_BLOCK_LINKS;) {
    if (k + SQUARE > HR2DI_BLOCK_LINKS || !is_packed_square(b, k)) {
      gather_one(pair_of(b, k), b->area[k], up, down);
      k++;
    } else if (k + LARGE > HR2DI_BLOCK_LINKS || !is_packed_large(b, k)) {
      gather_square(pair_of(b, k), b->area + k, 1, up, down);
      k += SQUARE;
    } else {
      gather_large(pair_of(b, k), pair_of(b, k + 3 * SQUARE), b->area + k, up, down);
      k += LARGE;
    }
  }
}

static void gather_packed(const hr2di_packed *p, const double *up, double *down) {
  for (size_t b = 0; b < HR2DI_CHUNK_BLOCKS; b++) {
    const size_t from = b * HR2DI_BLOCK_LINKS;
    gather_block(&(block){.element = p->element + p->begin[b],
                          .first = p->first + from,
                          .second = p->second + from,
                          .area = p->area + from},
                 up, down);
  }
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
