/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the integrand of l1.c is not smooth: at the corners of the rectangle of s and
   t, and where the curve G = Gc crosses its edges. */
#include <math.h>

#include "oracle/l1-frame.h"

enum { STEPS = 60 };

#define ROOT 1e-8 /* relative to the range; the error of the integral is its cube */

/* An edge of the rectangle of s and t.  On it G = Gc where (1+p)²(1+q) = 1 + level; p belongs
   to the side that varies and q to the other.  On an edge of fixed t they are α and β. */
typedef struct edge {
  const hr2di_l1_frame *f;
  int fixed_x;
  double level;
} edge;

static double edge_excess(const edge *e, double tau, double *slope) {
  const hr2di_l1_direction d = hr2di_l1_direction_at(e->f, tau);
  const double p = e->fixed_x ? d.b : d.a, q = e->fixed_x ? d.a : d.b;
  const double tp = e->fixed_x ? e->f->y.tangent : e->f->x.tangent;
  const double tq = e->fixed_x ? e->f->x.tangent : e->f->y.tangent;
  const hr2di_l1_origin *o = &e->f->origin;
  const double cosine = o->cosine - tau * d.weight * (o->sine + tau * o->cosine);
  const double dp = -(d.sine + tp * cosine), dq = -(d.sine + tq * cosine);
  *slope = d.weight * (1 + p) * (2 * dp * (1 + q) + dq * (1 + p));
  return hr2di_l1_cubic(p, q) - e->level;
}

/* ln cosθ is concave, and so (1+p)²(1+q) has one maximum, where
   2 tan(δ+θp) + tan(δ+θq) = 0, that is sin(2δ + θp + θq) = sin(θq − θp)/3. */
static double edge_peak(const edge *e) {
  const double x = atan(e->f->x.tangent), y = atan(e->f->y.tangent);
  const double turn = asin(sin(e->fixed_x ? x - y : y - x) / 3);
  return tan(0.25 * (turn - x - y) - 0.5 * atan2(e->f->origin.sine, e->f->origin.cosine));
}

/* The root between two values of different sign, by Newton's method in a bracket. */
static double edge_root(const edge *e, double low, double high, double at_low, double at_high) {
  const double tolerance = ROOT * (high - low);
  double tau = low + (high - low) * (at_low / (at_low - at_high)), slope;
  for (int k = 0; k < STEPS; k++) {
    const double value = edge_excess(e, tau, &slope);
    if ((value > 0) == (at_low > 0))
      low = tau;
    else
      high = tau;
    const double next = tau - value / slope;
    const int inside = next > low && next < high;
    if (inside && fabs(next - tau) < tolerance) return next;
    tau = inside ? next : 0.5 * (low + high);
    if (high - low < tolerance) break;
  }
  return tau;
}

static int add_root(const edge *e, double low, double high, double at_low, double at_high,
                    double *root) {
  if (!(low < high) || (at_low > 0) == (at_high > 0)) return 0;
  *root = edge_root(e, low, high, at_low, at_high);
  return 1;
}

/* Writes the roots on an edge, at most two; returns how many. */
static int edge_roots(const edge *e, double low, double high, double *root) {
  double up, down, flat;
  const double at_low = edge_excess(e, low, &up), at_high = edge_excess(e, high, &down);
  if (!(up > 0 && down < 0)) return add_root(e, low, high, at_low, at_high, root);
  if (at_low > 0 && at_high > 0) return 0;
  const double peak = edge_peak(e), at_peak = edge_excess(e, peak, &flat);
  const int found = add_root(e, low, peak, at_low, at_peak, root);
  return found + add_root(e, peak, high, at_peak, at_high, root + found);
}

/* The first and the last τ are at opposite corners, as δ rises with s and with t. */
int hr2di_l1_breaks(const hr2di_l1_frame *f, double *at) {
  const hr2di_l1_side *x = &f->x, *y = &f->y;
  const double low = hr2di_l1_tau(f, x->low, y->low), high = hr2di_l1_tau(f, x->high, y->high);
  const double lh = hr2di_l1_tau(f, x->low, y->high), hl = hr2di_l1_tau(f, x->high, y->low);
  const edge edges[4] = {{f, 0, y->slope * y->low},
                         {f, 0, y->slope * y->high},
                         {f, 1, x->slope * x->low},
                         {f, 1, x->slope * x->high}};
  double found[HR2DI_L1_BREAKS] = {lh, hl};
  int n = 2, count = 1;
  n += edge_roots(&edges[0], low, hl, found + n);
  n += edge_roots(&edges[1], lh, high, found + n);
  n += edge_roots(&edges[2], low, lh, found + n);
  n += edge_roots(&edges[3], hl, high, found + n);
  at[0] = low;
  for (int k = 0; k < n; k++) {
    if (!(found[k] > low && found[k] < high)) continue;
    int place = count++;
    for (; at[place - 1] > found[k]; place--) at[place] = at[place - 1];
    at[place] = found[k];
  }
  at[count++] = high;
  return count;
}
