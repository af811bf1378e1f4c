/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How many images a period needs, and how the last ones stand for those that are cut off.

   Lines that pass many periods run in a free strip, nearly along the period: of those that
   start in one cell about w²/(kD)³ D² end in the k-th from it, for a strip of width w.  Strings
   round the vertices of both cells have lengths that are analytic in 1/k, so that the exchange
   area of two patches, one of them moved k periods, is

     a₃/k³ + a₄/k⁴ + …    once k periods are longer than the cell is wide and high.

   Of J images, numbers n_j from K downwards, the sum of c_j f(n_j) is that of f(k) over all k >
   K for f = k⁻³, …, k^(−J−2).  What is left is of the order of 1/K^(J+2).  Without the last
   power the extrapolation is off by more: the difference tells what may be left.

   A point sees patches under angles a₂/k² + a₃/k³ + …: it has weights of its own.

   A vertex that hides images, or shows them, up to number m makes a kink: f has a part with
   (1/k − 1/m)² for k < m, as many lines pass it in all directions alike; seen from a point of a
   patch along the period one with 1/k² − 1/m², and from other points with 1/k − 1/m.  The last
   power shows little of that for some m.  An extrapolation from images ¾K, ⅝K, ½K and ⅜K shows
   it then: for no m is the sum off by more than HR2DI_TAIL_BOUND times the larger one of both
   differences (tests/unit/scene/check-period-weights.c).  Two images leave nothing for a second
   way: a tenth of the whole sum takes its place, which does as well.  Of one image a series
   that begins with the next power tells.  Many kinks, as where far images show through gaps of
   others, are taken to be no worse than the worst of one.

   The c_j have both signs.  As n_j are K, ¾K, ½K and ⅜K, Σ |c_j| f(n_j) is no more than ten
   times the sum that is wanted; of the last four images it would be a thousand times that. */
#include <math.h>
#include <stdlib.h>

#include "scene/scene-impl.h"

enum { MOST_TERMS = 4, MOST_COPIES = HR2DI_MOST_COPIES, ENOUGH = 16 };

/* Images in all, beyond which no more are made just to see farther. */
#define MANY_PATCHES 10000

/* Σ k^−p over k > K, by Euler and Maclaurin: the sum up to M − 1, then
   M^(1−p)/(p−1) + M^−p/2 + Σ B_2i/(2i)! p(p+1)…(p+2i−2) M^(−p−2i+1).  With M ≥ 16 the first
   term left out is below 1e-17 of the sum. */
static double rest_of(unsigned last, int p) {
  static const double bernoulli[] = {1. / 12, -1. / 720, 1. / 30240, -1. / 1209600,
                                     1. / 47900160};
  double sum = 0, m = last + 1.;
  for (; m < ENOUGH; m++) sum += pow(m, -p);
  sum += pow(m, 1 - p) / (p - 1) + 0.5 * pow(m, -p);
  double product = p;
  for (int i = 1; i <= 5; i++) {
    sum += bernoulli[i - 1] * product * pow(m, -p - 2 * i + 1);
    product *= (double)(p + 2 * i - 1) * (p + 2 * i);
  }
  return sum;
}

/* n_j, and K. */
typedef struct nodes {
  unsigned at[MOST_TERMS], last;
  int terms;
} nodes;

/* Of few images not all n_j are different. */
static int terms_for(unsigned copies) {
  return copies >= 8 ? 4 : copies >= 4 ? 3 : copies >= 2 ? 2 : 1;
}

static nodes nodes_of(unsigned copies) {
  return (nodes){
      {copies, copies * 6 / 8, copies / 2, copies * 3 / 8}, copies, terms_for(copies)};
}

/* Of terms up to ¾K, for K ≥ 4. */
static nodes part_of(unsigned copies) {
  const unsigned last = copies * 6 / 8;
  if (copies < 8) return (nodes){{last, last - 1, last - 2}, last, 3};
  return (nodes){{last, copies * 5 / 8, copies / 2, copies * 3 / 8}, last, 4};
}

/* Solves Σ_j c_j n_j^−p = Σ_{k>K} k^−p, scaled by K^p, for p = power, …, by elimination with
   pivots. */
static void solve(const nodes *n, int power, double *c) {
  double row[MOST_TERMS][MOST_TERMS + 1];
  const int terms = n->terms;
  for (int r = 0; r < terms; r++) {
    for (int j = 0; j < terms; j++) row[r][j] = pow(n->last / (double)n->at[j], r + power);
    row[r][terms] = rest_of(n->last, r + power) * pow(n->last, r + power);
  }
  for (int k = 0; k < terms; k++) {
    int best = k;
    for (int r = k + 1; r < terms; r++)
      if (fabs(row[r][k]) > fabs(row[best][k])) best = r;
    for (int j = k; j <= terms; j++) {
      const double kept = row[k][j];
      row[k][j] = row[best][j];
      row[best][j] = kept;
    }
    for (int r = k + 1; r < terms; r++) {
      const double factor = row[r][k] / row[k][k];
      for (int j = k; j <= terms; j++) row[r][j] -= factor * row[k][j];
    }
  }
  for (int k = terms; k-- > 0;) {
    c[k] = row[k][terms];
    for (int j = k + 1; j < terms; j++) c[k] -= row[k][j] * c[j];
    c[k] /= row[k][k];
  }
}

/* The weights by which terms up to the last node stand for those beyond K: those in between are
   known. */
static void set(unsigned copies, nodes n, int power, double *weight) {
  double c[MOST_TERMS];
  if (n.last == 0 || n.terms == 0) return;
  solve(&n, power, c);
  for (int j = 0; j < n.terms; j++) weight[n.at[j]] += c[j];
  for (unsigned k = n.last + 1; k <= copies; k++) weight[k] -= 1;
}

/* What a second way leaves of the sum from two images. */
#define OF_TWO 0.1

/* Sums by other ways. */
static void set_checks(hr2di_tail *t, unsigned copies, int power) {
  double *const last = t->check[HR2DI_CHECK_LAST], *const part = t->check[HR2DI_CHECK_PART];
  nodes fewer = nodes_of(copies);
  fewer.terms--;
  if (copies > 1)
    set(copies, fewer, power, last);
  else
    set(copies, nodes_of(copies), power + 1, last);
  if (copies >= 4) set(copies, part_of(copies), power, part);
  for (unsigned k = 0; k <= copies && copies < 4; k++)
    part[k] = copies > 1 ? (1 - OF_TWO) * t->weight[k] : last[k];
}

void hr2di_tail_set(hr2di_tail *t, unsigned copies, int power) {
  *t = (hr2di_tail){{0}, {{0}}, {0}};
  set(copies, nodes_of(copies), power, t->weight);
  set_checks(t, copies, power);
  set(copies, nodes_of(copies / 2), power, t->half);
  for (int c = 0; c < HR2DI_TAIL_CHECKS; c++)
    for (unsigned k = 0; k <= copies; k++) t->check[c][k] = t->weight[k] - t->check[c][k];
}

void hr2di_symmetry_set_weights(hr2di_symmetry *s) {
  if (!s->by.periodic) return;
  hr2di_tail_set(&s->patches, s->copies, HR2DI_TAIL_OF_PATCHES);
  hr2di_tail_set(&s->points, s->copies, HR2DI_TAIL_OF_POINTS);
  for (size_t k = 0; k < s->motions; k++) {
    const int periods = abs(s->motion[k].periods);
    s->motion[k].weight += s->patches.weight[periods];
    for (int c = 0; c < HR2DI_TAIL_CHECKS; c++)
      s->motion[k].check[c] = s->patches.check[c][periods];
  }
}

void hr2di_symmetry_forget_weights(hr2di_symmetry *s) {
  for (size_t k = 0; k < s->motions; k++) {
    s->motion[k].weight = 1;
    for (int c = 0; c < HR2DI_TAIL_CHECKS; c++) s->motion[k].check[c] = 0;
  }
}

/* The extent of the patches, and of their images in a mirror along it, across a direction. */
static double across(const hr2d_scene *scene, hr2d_point period) {
  const hr2di_generators *by = &scene->symmetry.by;
  const double size = hypot(period.x, period.y);
  const hr2d_point d = {period.x / size, period.y / size};
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (size_t k = 0; k < hr2di_scene_cell(scene); k++) {
    const hr2d_segment s = scene->patch[k].given;
    const double a = d.x * s.a.y - d.y * s.a.x, b = d.x * s.b.y - d.y * s.b.x;
    low = fmin(low, fmin(a, b));
    high = fmax(high, fmax(a, b));
  }
  for (size_t m = 0; m < by->mirrors; m++) {
    const hr2d_point u = by->along[m];
    if (fabs(d.x * u.x + d.y * u.y) < 0.5) continue;
    const double at = d.x * by->at[m].y - d.y * by->at[m].x;
    const double reach = fmax(fabs(high - at), fabs(low - at));
    high = at + reach;
    low = at - reach;
  }
  return high - low;
}

/* How far light runs along d, in periods, while it comes down through `height`:
   height·|s·d|/|s×d|. */
static double run_of(hr2d_point s, hr2d_point d, double height) {
  const double size = hypot(d.x, d.y);
  const double along = fabs(s.x * d.x + s.y * d.y), up = fabs(s.x * d.y - s.y * d.x);
  return height == 0 ? 0 : height * along / up / size;
}

/* Whether a mirror along the period adds images above or below. */
static int is_mirrored(const hr2di_generators *by) {
  for (size_t m = 0; m < by->mirrors; m++)
    if (fabs(by->period.x * by->along[m].x + by->period.y * by->along[m].y) >
        fabs(by->period.x * by->along[m].y - by->period.y * by->along[m].x))
      return 1;
  return 0;
}

/* How much of the extent across the period is above all that a patch and its images close to
   light of direction s.  If the patch is as wide across the light as its next image is apart,
   they leave nothing open: what comes from above them does not pass, and what starts so far
   below the highest point that the next image is in its way meets that one. */
static double open_height(const hr2d_scene *scene, hr2d_point s, double height) {
  const hr2d_point d = scene->symmetry.by.period;
  const double across = s.x * d.y - s.y * d.x, spacing = fabs(across);
  const double size = copysign(hypot(d.x, d.y), across); /* light comes from where v is high */
  double top = -HUGE_VAL, closed = -HUGE_VAL;
  if (!(spacing > 0) || is_mirrored(&scene->symmetry.by)) return height;
  for (size_t k = 0; k < hr2di_scene_cell(scene); k++) {
    const hr2d_point a = scene->patch[k].given.a, b = scene->patch[k].given.b;
    const double v = (d.x * a.y - d.y * a.x) / size, w = (d.x * b.y - d.y * b.x) / size;
    const double wide = fabs(s.x * (b.y - a.y) - s.y * (b.x - a.x));
    top = fmax(top, fmax(v, w));
    if (wide >= spacing) closed = fmax(closed, fmax(v, w) - fabs(v - w) * spacing / wide);
  }
  return fmin(height, top - closed);
}

/* Copies beyond which no patch is in the light of a sun that could meet another one; more than
   MOST_COPIES if there are too many of them. */
static double copies_for(const hr2d_scene *scene, size_t sun, double height) {
  const hr2d_point s = scene->sun[sun].direction, d = scene->symmetry.by.period;
  if (!(scene->sun[sun].irradiance > 0)) return 1;
  const double run = run_of(s, d, height);
  if (run < MOST_COPIES - 1) return run + 1;
  /* The image that is in the way may be the second one, where a patch is as long as a period.
   */
  return run_of(s, d, open_height(scene, s, height)) + 3;
}

void hr2di_symmetry_copies(hr2d_scene *scene, unsigned *min, unsigned *max) {
  hr2di_symmetry *symmetry = &scene->symmetry;
  const hr2d_point d = symmetry->by.period;
  *min = *max = symmetry->by.periodic;
  symmetry->low_suns = symmetry->low_sun = 0;
  if (!*min) return;
  const double period = hypot(d.x, d.y), height = across(scene, d);
  const double patches = ldexp((double)scene->patches, (int)symmetry->by.mirrors);
  while (*max < ENOUGH * fmax(height / period, 1) && *max < MOST_COPIES &&
         (4 * *max + 1) * patches <= MANY_PATCHES)
    *max *= 2;
  for (size_t k = 0; k < scene->sun_bands; k++) {
    const double copies = copies_for(scene, k, height);
    if (copies <= MOST_COPIES)
      while (*min < copies) *min *= 2;
    else if (!symmetry->low_suns++)
      symmetry->low_sun = k;
  }
  if (*max < *min) *max = *min;
}

int hr2di_symmetry_is_low(const hr2d_scene *scene, size_t sun) {
  const hr2di_symmetry *s = &scene->symmetry;
  return s->low_suns > 0 && copies_for(scene, sun, across(scene, s->by.period)) > MOST_COPIES;
}
