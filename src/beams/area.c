/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The measure of a line class as a sum of positive terms.

   With a = left[0], b = right[0], c and d the last points of `right` and `left`, the strings
   are

     2AF = |ac| + |bd| − |left| − |right|.

   The tangents ac and bd meet at X, which splits this into one excess for each chain:
   (|aX| + |Xd| − |left|) + (|bX| + |Xc| − |right|).  The excess of a chain is peeled edge by
   edge: the line of edge e_k = P_k P_{k+1} meets the tangent bd at X_{k+1}, and

     |P_k X_k| + |X_k X_{k+1}| − |P_k X_{k+1}|

   is the excess of a triangle; what is left is the same problem for P_{k+1}, X_{k+1}.  At the
   last edge X_{k+1} = d.  Let v = d − b, let w be the direction from P_k to X_k, that is c − a
   and then e_{k−1}, and let h be the distance of P_k from bd times |v|.  Then

     |P_k X_k| = h|w|/(w×v),  |P_k X_{k+1}| = h|e|/(e×v),
     |X_k X_{k+1}| = h|v|(w×e)/((e×v)(w×v)),

   and half the excess is |P_k X_k||X_k X_{k+1}|(1 + cos X)/(the sum of the three), where
   cos X = −w·v/(|w||v|).  All determinants are positive, and exact up to their rounding.  The
   right chain is the mirror image.  Chains of two points each are the quadrilateral of
   hr2d_exchange_area(), and those of two and one its corner. */
#include <math.h>

#include "beams/line-class.h"
#include "geometry/determinant.h"
#include "geometry/exchange-area.h"
#include "geometry/vector.h"

typedef struct side {
  hr2di_vector along; /* v */
  double length;      /* |v| */
  int hand;           /* −1 in the mirror image */
} side;

/* 1 + cos of the angle at X; 0 if the product of the lengths underflows. */
static double one_plus_cos(const hr2di_vector *w, double length, const side *s, double det) {
  const double dot = hr2di_vector_dot(w, &s->along), product = length * s->length;
  if (!(product > 0)) return 0;
  if (dot <= 0) return 1 - dot / product;
  return det / product * (det / (product + dot));
}

/* Half the excess of the triangle P_k X_k X_{k+1}; 0 where rounded points leave none. */
static double triangle(const side *s, const hr2di_vector *w, const hr2di_vector *e, double h) {
  const double wv = s->hand * hr2di_det(w, &s->along), ev = s->hand * hr2di_det(e, &s->along);
  const double we = s->hand * hr2di_det(w, e);
  if (!(wv > 0) || !(ev > 0) || !(we > 0) || !(h > 0)) return 0;
  const double length = hr2di_vector_length(w);
  /* The three sides, times (w×v)(e×v)/h: a determinant may be so small that it has no inverse.
   */
  const double to_x = length * ev, between = s->length * we;
  const double sum = to_x + between + hr2di_vector_length(e) * wv;
  return sum > 0 ? h / wv * length * (between / sum) * one_plus_cos(w, length, s, wv) : 0;
}

/* The excess of a chain that turns towards the tangent from `from` to its last point; `w` is
   the other tangent, from its first. */
static double peel(const hr2d_point *p, size_t count, hr2di_vector w, hr2d_point from,
                   int hand) {
  const hr2d_point last = p[count - 1];
  side s = {.along = hr2di_vector_difference(last, from), .hand = hand};
  s.length = hr2di_vector_length(&s.along);
  double sum = 0;
  for (size_t k = 0; k + 1 < count; k++) {
    const hr2di_vector e = hr2di_vector_difference(p[k + 1], p[k]);
    const hr2di_vector rest = hr2di_vector_difference(last, p[k]);
    sum += triangle(&s, &w, &e, hand * hr2di_det(&rest, &s.along));
    w = e;
  }
  return sum;
}

double hr2di_line_class_area(const hr2di_line_class *s) {
  const hr2d_point a = s->left[0], b = s->right[0];
  const hr2d_point d = s->left[s->lefts - 1], c = s->right[s->rights - 1];
  if (s->lefts == 1 && s->rights == 1) {
    const hr2d_point ab = hr2di_point_minus(b, a);
    return sqrt(hr2di_point_dot(ab, ab));
  }
  if (s->lefts <= 2 && s->rights <= 2) {
    if (s->lefts == 1) return hr2di_corner_area(a, b, c);
    if (s->rights == 1) return hr2di_corner_area(b, d, a);
    return hr2d_exchange_area(&(hr2d_segment){a, b}, &(hr2d_segment){c, d});
  }
  return peel(s->left, s->lefts, hr2di_vector_difference(c, a), b, 1) +
         peel(s->right, s->rights, hr2di_vector_difference(d, b), a, -1);
}
