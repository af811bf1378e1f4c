/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exchange area of two segments as a sum of positive terms.

   Crossed strings, 2AF = |ac| + |bd| − |ad| − |bc|, lose every digit of a small AF.
   Let i = ab and j = cd face each other and

     A = orient(abc), B = orient(abd), C = orient(cda), D = orient(cdb),
     K = A + C = B + D, p = |ac|, q = |bd|, E = (c−a)·(d−b).

   The diagonals ac and bd meet at X with |Xa| = pB/K, |Xc| = pD/K, |Xb| = qA/K,
   |Xd| = qC/K, so 2AF is the sum of the excesses |Xa| + |Xd| − |ad| and
   |Xb| + |Xc| − |bc| of two triangles.  Half an excess at a corner x is

     G_x(y,z) = (|xy||xz| + (y−x)·(z−x)) / (|xy| + |xz| + |yz|),

   and the angle at X is the same for both: cos = −E/(pq), hence

     AF = (pq − E)/K · T,  T = BC/(pB + qC + K|ad|) + AD/(qA + pD + K|bc|),

   where pq − E = K²/(pq + E) is used for E ≥ 0.  No term is negative, so all the
   error comes from the determinants.  Swapping i and j swaps A with C, B with D
   and the two terms, which changes no bit. */
#include "geometry/exchange-area.h"

#include <math.h>
#include <stddef.h>

#include "base/wide.h"
#include "geometry/determinant.h"
#include "geometry/exchange-area-scaled.h"
#include "geometry/vector.h"

typedef struct determinants {
  double abc, abd, cda, cdb;
} determinants;

/* K/(pq+E) or (pq−E)/K, which are equal, whichever does not cancel; times T over a common
   denominator. */
HR2DI_PART double facing_area(determinants o, double p, double q, double e, double ad,
                              double bc) {
  const double k = o.abc + o.cda;
  const double at_ad = (p * o.abd + q * o.cda) + k * ad;
  const double at_bc = (q * o.abc + p * o.cdb) + k * bc;
  const double terms = (o.abd * o.cda) * at_bc + (o.abc * o.cdb) * at_ad;
  const double numerator = e >= 0 ? k : p * q - e, denominator = e >= 0 ? p * q + e : k;
  return numerator * terms / ((at_ad * at_bc) * denominator);
}

/* A plain determinant and the sum of the sizes of its products.  Its rounding error is at most
   3·2^-53 of `size`, plus 2^-53 of itself. */
typedef struct plain {
  double det, size;
} plain;

HR2DI_PART plain cross(double ux, double uy, double vx, double vy) {
  return (plain){ux * vy - uy * vx, fabs(ux * vy) + fabs(uy * vx)};
}

HR2DI_PART int keeps_digits(plain x) {
  return 4 * x.det >= x.size + 0x1p-100;
}

HR2DI_PART int surely_negative(plain x) {
  return x.det <= -0x1p-50 * x.size - 0x1p-900;
}

/* Returns AF of a well-conditioned facing pair with coordinate differences below 2^50, so that
   no product here leaves 2^±900; 0 if one segment is clearly behind the other; −1 for every
   other pair.  Has no branches, so that the compiler can do several pairs at once. */
HR2DI_PART double plain_area(hr2d_point a, hr2d_point b, hr2d_point c, hr2d_point d) {
  const double ux = b.x - a.x, uy = b.y - a.y, vx = d.x - c.x, vy = d.y - c.y;
  const double wx = c.x - a.x, wy = c.y - a.y, zx = d.x - b.x, zy = d.y - b.y;
  const double sx = d.x - a.x, sy = d.y - a.y, tx = c.x - b.x, ty = c.y - b.y;
  const plain abc = cross(ux, uy, wx, wy), abd = cross(ux, uy, zx, zy);
  const plain cda = cross(wx, wy, vx, vy), cdb = cross(zx, zy, vx, vy);
  const double ww = wx * wx + wy * wy, zz = zx * zx + zy * zy;
  const double ss = sx * sx + sy * sy, tt = tx * tx + ty * ty;
  const int in_range = (ww + zz) + (ss + tt) <= 0x1p+100;
  const int good =
      keeps_digits(abc) & keeps_digits(abd) & keeps_digits(cda) & keeps_digits(cdb) & in_range;
  const int none = ((surely_negative(abc) & surely_negative(abd)) |
                    (surely_negative(cda) & surely_negative(cdb))) &
                   in_range;
  const double area = facing_area((determinants){abc.det, abd.det, cda.det, cdb.det}, sqrt(ww),
                                  sqrt(zz), wx * zx + wy * zy, sqrt(ss), sqrt(tt));
  return good ? area : none ? 0 : -1;
}

/* The rounded differences of the end points, which are good enough for lengths. */
typedef struct quadrilateral {
  hr2d_point ab, cd, ac, bd, ad, bc;
} quadrilateral;

static inline double length(hr2d_point v) {
  return sqrt(v.x * v.x + v.y * v.y);
}

/* G_x(y,z) for vectors to y and z with determinant det; for an obtuse angle the
   numerator is det²/(|xy||xz| − dot). */
static double corner_area(double length_y, double length_z, double dot, double det,
                          double opposite) {
  const double product = length_y * length_z, sum = (length_y + length_z) + opposite;
  return dot >= 0 ? (product + dot) / sum : (det / sum) * (det / (product - dot));
}

/* G_X(y,z) where i and j cross at X.  The parts of i and j in front of the other
   are |u|·on_i/m and |v|·on_j/m with m = |u×v| and on_i, on_j the determinants of
   y with j and of z with i; 1 + cos at X is 1 − u·v/(|u||v|), or
   m²/(|u||v|(|u||v| + u·v)).  Symmetric in i and j, bit for bit. */
static double crossing_area(double length_i, double length_j, double dot, double on_i,
                            double on_j, double m, double opposite) {
  const double part_i = length_i * (on_i / m), part_j = length_j * (on_j / m);
  const double sum = (part_i + part_j) + opposite, product = length_i * length_j;
  if (dot > 0) return on_i * on_j / (sum * (product + dot));
  const double less = part_i < part_j ? part_i : part_j;
  const double more = part_i < part_j ? part_j : part_i;
  return less * (more / sum) * ((product - dot) / product);
}

/* If j dips behind i at d', the points d', a, b lie on one line in this order, so that
   |bd'| − |ad'| = |ab|, and the strings reduce to the excess of the triangle abc at a; likewise
   for the other ends.  If j crosses i itself, both are cut at X.  No other two determinants of
   a visible pair are negative, since A + C = B + D. */
static double clipped_area(const quadrilateral *s, determinants o) {
  const double u = length(s->ab), v = length(s->cd), uv = hr2di_point_dot(s->ab, s->cd);
  if (o.abd < 0 && o.cda < 0)
    return crossing_area(u, v, uv, o.cdb, o.abc, o.abc - o.abd, length(s->bc));
  if (o.abc < 0 && o.cdb < 0)
    return crossing_area(u, v, uv, o.cda, o.abd, o.cda - o.cdb, length(s->ad));
  if (o.abd < 0)
    return corner_area(u, length(s->ac), hr2di_point_dot(s->ab, s->ac), o.abc, length(s->bc));
  if (o.abc < 0)
    return corner_area(u, length(s->bd), -hr2di_point_dot(s->ab, s->bd), o.abd, length(s->ad));
  if (o.cda < 0)
    return corner_area(v, length(s->bd), hr2di_point_dot(s->bd, s->cd), o.cdb, length(s->bc));
  return corner_area(v, length(s->ac), -hr2di_point_dot(s->ac, s->cd), o.cda, length(s->ad));
}

/* AF from determinants that have all their digits. */
static double area_of(const quadrilateral *s, determinants o) {
  if ((o.abc <= 0 && o.abd <= 0) || (o.cda <= 0 && o.cdb <= 0)) return 0;
  if (o.abc < 0 || o.abd < 0 || o.cda < 0 || o.cdb < 0) return clipped_area(s, o);
  const double p = length(s->ac), q = length(s->bd), e = hr2di_point_dot(s->ac, s->bd),
               k = o.abc + o.cda;
  const double at_ad = (p * o.abd + q * o.cda) + k * length(s->ad);
  const double at_bc = (q * o.abc + p * o.cdb) + k * length(s->bc);
  /* At a common corner a = d or b = c the term and its denominator vanish. */
  const double t =
      (at_ad > 0 ? o.abd * o.cda / at_ad : 0) + (at_bc > 0 ? o.abc * o.cdb / at_bc : 0);
  return e >= 0 ? k / (p * q + e) * t : (p * q - e) / k * t;
}

/* The determinants with corrections of first order; abc is NaN if these are not enough.  For
   plain coordinates.  Has no branches. */
HR2DI_PART determinants corrected(hr2d_point a, hr2d_point b, hr2d_point c, hr2d_point d) {
  const hr2di_vector ab = hr2di_vector_difference(b, a), cd = hr2di_vector_difference(d, c);
  const hr2di_vector ac = hr2di_vector_difference(c, a), bd = hr2di_vector_difference(d, b);
  int sure = 1;
  determinants o;
  o.abc = hr2di_det_corrected(&ab, &ac, &sure);
  o.abd = hr2di_det_corrected(&ab, &bd, &sure);
  o.cda = -hr2di_det_corrected(&cd, &ac, &sure);
  o.cdb = -hr2di_det_corrected(&cd, &bd, &sure);
  o.abc = sure ? o.abc : NAN;
  return o;
}

static determinants exact(const hr2d_segment *i, const hr2d_segment *j) {
  const hr2di_vector ab = hr2di_vector_difference(i->b, i->a),
                     cd = hr2di_vector_difference(j->b, j->a);
  const hr2di_vector ac = hr2di_vector_difference(j->a, i->a),
                     bd = hr2di_vector_difference(j->b, i->b);
  return (determinants){hr2di_det(&ab, &ac), hr2di_det(&ab, &bd), -hr2di_det(&cd, &ac),
                        -hr2di_det(&cd, &bd)};
}

static inline int is_plain(const hr2d_segment *i, const hr2d_segment *j) {
  return hr2di_point_plain(i->a) & hr2di_point_plain(i->b) & hr2di_point_plain(j->a) &
         hr2di_point_plain(j->b);
}

/* For plain coordinates. */
static double careful_area(const hr2d_segment *i, const hr2d_segment *j, determinants o) {
  const quadrilateral s = {hr2di_point_minus(i->b, i->a), hr2di_point_minus(j->b, j->a),
                           hr2di_point_minus(j->a, i->a), hr2di_point_minus(j->b, i->b),
                           hr2di_point_minus(j->b, i->a), hr2di_point_minus(j->a, i->b)};
  return area_of(&s, isnan(o.abc) ? exact(i, j) : o);
}

static hr2d_point rounded(const hr2di_vector *v) {
  return (hr2d_point){v->x, v->y};
}

double hr2di_exchange_area_of_vectors(const hr2di_between *v) {
  const determinants o = {hr2di_det(&v->ab, &v->ac), hr2di_det(&v->ab, &v->bd),
                          -hr2di_det(&v->cd, &v->ac), -hr2di_det(&v->cd, &v->bd)};
  const quadrilateral s = {rounded(&v->ab), rounded(&v->cd), rounded(&v->ac),
                           rounded(&v->bd), rounded(&v->ad), rounded(&v->bc)};
  return area_of(&s, o);
}

double hr2d_exchange_area(const hr2d_segment *i, const hr2d_segment *j) {
  if (!i || !j) return NAN;
  const double area = plain_area(i->a, i->b, j->a, j->b);
  if (area >= 0) return area;
  if (!is_plain(i, j)) return hr2di_exchange_area_scaled(i, j);
  return careful_area(i, j, corrected(i->a, i->b, j->a, j->b));
}

double hr2di_corner_area(hr2d_point x, hr2d_point y, hr2d_point z) {
  const hr2d_segment i = {x, y}, j = {z, x};
  if (!is_plain(&i, &j)) return hr2di_exchange_area_scaled(&i, &j);
  const hr2d_point xy = hr2di_point_minus(y, x), xz = hr2di_point_minus(z, x);
  const double dot = hr2di_point_dot(xy, xz);
  double det = 0;
  if (dot < 0) {
    const hr2di_vector u = hr2di_vector_difference(y, x), v = hr2di_vector_difference(z, x);
    det = hr2di_det(&u, &v);
  }
  return corner_area(length(xy), length(xz), dot, det, length(hr2di_point_minus(z, y)));
}

/* Pairs per block: the data of a block stay in the first-level cache. */
enum { BLOCK = 128 };

/* The end points of a block of pairs, as arrays for the compiler to vectorise. */
typedef struct block {
  double ax[BLOCK], ay[BLOCK], bx[BLOCK], by[BLOCK];
  double cx[BLOCK], cy[BLOCK], dx[BLOCK], dy[BLOCK];
} block;

static inline void put(block *p, size_t k, hr2d_segment i, hr2d_segment j) {
  p->ax[k] = i.a.x, p->ay[k] = i.a.y, p->bx[k] = i.b.x, p->by[k] = i.b.y;
  p->cx[k] = j.a.x, p->cy[k] = j.a.y, p->dx[k] = j.b.x, p->dy[k] = j.b.y;
}

HR2DI_PART hr2d_segment first(const block *p, size_t k) {
  return (hr2d_segment){{p->ax[k], p->ay[k]}, {p->bx[k], p->by[k]}};
}

HR2DI_PART hr2d_segment second(const block *p, size_t k) {
  return (hr2d_segment){{p->cx[k], p->cy[k]}, {p->dx[k], p->dy[k]}};
}

/* Takes the pairs that plain_area() did not decide.  Those with plain coordinates move to the
   front: returns how many, with their old positions in `place`.  The others are done here. */
static size_t collect(block *p, size_t n, double *area, size_t *place) {
  size_t left = 0;
  for (size_t k = 0; k < n; k++) {
    if (area[k] >= 0) continue;
    const hr2d_segment i = first(p, k), j = second(p, k);
    if (is_plain(&i, &j)) {
      put(p, left, i, j);
      place[left++] = k;
    } else
      area[k] = hr2di_exchange_area_scaled(&i, &j);
  }
  return left;
}

/* *all tells whether every pair was decided. */
HR2DI_PART void plain_areas_loop(const block *p, size_t n, double *area, int *all) {
  int undecided = 0;
  for (size_t k = 0; k < n; k++) {
    const hr2d_segment i = first(p, k), j = second(p, k);
    area[k] = plain_area(i.a, i.b, j.a, j.b);
  }
  for (size_t k = 0; k < n; k++) undecided |= area[k] < 0;
  *all = !undecided;
}
HR2DI_WIDE(plain_areas, (const block *p, size_t n, double *area, int *all), (p, n, area, all))

HR2DI_PART void all_corrected_loop(const block *p, size_t n, determinants *o) {
  for (size_t k = 0; k < n; k++) {
    const hr2d_segment i = first(p, k), j = second(p, k);
    o[k] = corrected(i.a, i.b, j.a, j.b);
  }
}
HR2DI_WIDE(all_corrected, (const block *p, size_t n, determinants *o), (p, n, o))

static void block_areas(block *p, size_t n, double *area) {
  int all;
  plain_areas(p, n, area, &all);
  if (all) return;
  size_t place[BLOCK];
  determinants o[BLOCK];
  const size_t left = collect(p, n, area, place);
  all_corrected(p, left, o);
  for (size_t k = 0; k < left; k++) {
    const hr2d_segment i = first(p, k), j = second(p, k);
    area[place[k]] = careful_area(&i, &j, o[k]);
  }
}

void hr2di_exchange_areas_between(const hr2d_segment (*pairs)[2], size_t count, double *area) {
  block p;
  for (size_t start = 0; start < count; start += BLOCK) {
    const size_t n = count - start < BLOCK ? count - start : BLOCK;
    for (size_t k = 0; k < n; k++) put(&p, k, pairs[start + k][0], pairs[start + k][1]);
    block_areas(&p, n, area + start);
  }
}

#ifdef HR2D_AVX2
_Static_assert(offsetof(hr2d_element, b) == offsetof(hr2d_element, a) + 16,
               "the ends of an element are one vector");

/* The ends of four elements, each end and coordinate as one vector. */
HR2DI_AVX2 static inline void put_four(const double *const end[4], double *ax, double *ay,
                                       double *bx, double *by) {
  const __m256d e0 = _mm256_loadu_pd(end[0]), e1 = _mm256_loadu_pd(end[1]);
  const __m256d e2 = _mm256_loadu_pd(end[2]), e3 = _mm256_loadu_pd(end[3]);
  const __m256d x01 = _mm256_unpacklo_pd(e0, e1), y01 = _mm256_unpackhi_pd(e0, e1);
  const __m256d x23 = _mm256_unpacklo_pd(e2, e3), y23 = _mm256_unpackhi_pd(e2, e3);
  _mm256_storeu_pd(ax, _mm256_permute2f128_pd(x01, x23, 0x20));
  _mm256_storeu_pd(ay, _mm256_permute2f128_pd(y01, y23, 0x20));
  _mm256_storeu_pd(bx, _mm256_permute2f128_pd(x01, x23, 0x31));
  _mm256_storeu_pd(by, _mm256_permute2f128_pd(y01, y23, 0x31));
}

HR2DI_AVX2 static void put_fours(block *p, const hr2d_element *element, const hr2d_pair *pair,
                                 size_t n) {
  for (size_t k = 0; k < n; k += 4) {
    const double *i[4], *j[4];
    for (size_t m = 0; m < 4; m++) {
      i[m] = &element[pair[k + m].first].a.x;
      j[m] = &element[pair[k + m].second].a.x;
    }
    put_four(i, p->ax + k, p->ay + k, p->bx + k, p->by + k);
    put_four(j, p->cx + k, p->cy + k, p->dx + k, p->dy + k);
  }
}
#else
static void put_fours(block *p, const hr2d_element *element, const hr2d_pair *pair, size_t n) {
  (void)p, (void)element, (void)pair, (void)n;
}
#endif

void hr2di_exchange_areas(const hr2d_element *elements, const hr2d_pair *pairs, size_t count,
                          double *area) {
  block p;
  for (size_t start = 0; start < count; start += BLOCK) {
    const size_t n = count - start < BLOCK ? count - start : BLOCK;
    const size_t fours = hr2di_wide() ? n & ~(size_t)3 : 0;
    put_fours(&p, elements, pairs + start, fours);
    for (size_t k = fours; k < n; k++) {
      const hr2d_element *i = &elements[pairs[start + k].first];
      const hr2d_element *j = &elements[pairs[start + k].second];
      put(&p, k, (hr2d_segment){i->a, i->b}, (hr2d_segment){j->a, j->b});
    }
    block_areas(&p, n, area + start);
  }
}
