/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss rules over the directions of a trapezoid.

   With e = (1−λ) e0 + λ κ e1 for any κ > 0, and the mean M_lm over the offsets of φ_l φ_m,
     C_lm = ∫₀¹ ½ κ (e0 × e1) (gap/|e|³) M_lm dλ.
   Offsets are never near anything: what is singular in λ are the directions along i and j,
   where places that turn with e have poles, and the two complex zeros of |e|².  κ moves them.
   If the nearest is on the ellipse ρ₀ around [0,1], a rule of n points errs by about
     ρ^−2n (ρ_i ρ_j)^(p−1)   for any ρ < ρ₀,
   where ρ_i is the ellipse around i on which places on i lie for λ on the ellipse ρ. */
#include <math.h>

#include "blocks/block.h"
#include "blocks/gas-cells.h"
#include "geometry/vector.h"

/* For the constant that the bound leaves out, which few points have no room for. */
#define MARGIN 0.3

/* Directions below this part of all lines are dropped with all that they could change. */
#define NEGLIGIBLE 0x1p-56

/* The cosine of an angle between e0 and e1 beyond which e is far from both in between, so that
   ellipses are narrow whatever κ is. */
#define WIDE -0.3

enum { STACK = 128, MOST_POINTS = HR2DI_RULE_POINTS };

/* fmin() and fmax() would be calls. */
static inline double lesser(double x, double y) {
  return x < y ? x : y;
}

static inline double greater(double x, double y) {
  return x > y ? x : y;
}

/* ln x for x ≥ 1, to 1e-3; x beyond 2^1000 counts as that. */
static double logarithm(double x) {
  int exponent;
  const double m = frexp(lesser(x, 0x1p+1000), &exponent), t = (m - 0.75) / (m + 0.75);
  return 0.69314718055994531 * exponent - 0.28768207245178090 + t * (2 + t * t * (2. / 3));
}

/* ρ of the ellipse with major half axis m ≥ 1. */
static double ellipse(double m) {
  m = lesser(greater(m, 1), 1e8);
  return m + sqrt(m * m - 1);
}

/* What the choice of a rule knows of a trapezoid, for |e0| = |e1| = 1. */
typedef struct outline {
  double across[2][2]; /* per element and end; 1 where nothing depends on e */
  double cosine;
  double ratio;                 /* |e0|/|e1| */
  const hr2di_gas_cells *cells; /* with borders that the lines cross; or NULL: */
  hr2d_point e[2];              /* directions of length 1 */
} outline;

static int is_mixed(const hr2di_integrator *w) {
  return w->cells && w->cells->is_mixed;
}

static hr2d_point unit_of(const hr2di_vector *e, double length) {
  return (hr2d_point){e->x / length, e->y / length};
}

static outline outline_of(const hr2di_integrator *w, const hr2di_trapezoid *t) {
  const double length = hr2di_vector_length(&t->e[0]), other = hr2di_vector_length(&t->e[1]);
  outline o = {.cosine = hr2di_vector_dot(&t->e[0], &t->e[1]) / (length * other),
               .ratio = length / other};
  for (size_t k = 0; k < 2; k++) {
    const hr2di_meeting *m = &t->on[k];
    o.across[k][0] = m->fixed == 3 ? 1 : m->across[0];
    o.across[k][1] = m->fixed == 3 ? 1 : m->across[1] * o.ratio;
  }
  if (is_mixed(w)) {
    o.cells = w->cells;
    o.e[0] = unit_of(&t->e[0], length);
    o.e[1] = unit_of(&t->e[1], other);
  }
  return o;
}

static double limited_ratio(double x, double y) {
  return x < 1e8 * y ? x / y : 1e8;
}

/* The major half axis through the zero of a linear function with these ends. */
static double through_zero(double f, double g) {
  return limited_ratio(f + g, fabs(f - g));
}

/* The smallest ellipse through the direction of a border, along which depths have a pole. */
static double nearest_border(const outline *o, double kappa) {
  double least = HUGE_VAL;
  for (size_t k = 0; k + 1 < o->cells->path.pieces; k++) {
    const hr2d_point w = o->cells->along[k];
    const double across[] = {fabs(hr2di_point_cross(o->e[0], w)),
                             kappa * fabs(hr2di_point_cross(o->e[1], w))};
    least = lesser(least, through_zero(across[0], across[1]));
  }
  return least;
}

/* The smallest ellipse through a singularity. */
static double nearest(const outline *o, double kappa) {
  const double square = (1 - kappa) * (1 - kappa) + 2 * kappa * (1 - o->cosine);
  const double at_i = through_zero(o->across[0][0], kappa * o->across[0][1]);
  const double at_j = through_zero(o->across[1][0], kappa * o->across[1][1]);
  const double all = lesser(lesser(at_i, at_j), limited_ratio(1 + kappa, sqrt(square)));
  return o->cells ? lesser(all, nearest_border(o, kappa)) : all;
}

/* Chooses κ so that the nearest singularity is as far away as can be. */
static double choose_kappa(const outline *o, double *max) {
  enum { ENOUGH = 3 };
  *max = nearest(o, 1);
  if (*max >= ENOUGH) return 1;
  const double by_i = o->across[0][0] / o->across[0][1];
  const double by_j = o->across[1][0] / o->across[1][1];
  const double candidate[] = {by_i, by_j, sqrt(by_i * by_j)};
  double kappa = 1;
  for (int k = 0; k < 3; k++) {
    if (!(candidate[k] > 0x1p-20 && candidate[k] < 0x1p+20)) continue;
    const double m = nearest(o, candidate[k]);
    if (m <= *max) continue;
    *max = m;
    kappa = candidate[k];
  }
  return kappa;
}

/* The major half axis, around an element, of the place start/across at λ = ½ + x + iy; the ends
   of `across` and `start` are scaled by κ. */
static double place_at(const double across[2], const double start[2], double x, double y) {
  const double a = across[0] * (0.5 - x) + across[1] * (0.5 + x), b = across[1] - across[0];
  const double s = start[0] * (0.5 - x) + start[1] * (0.5 + x), t = start[1] - start[0];
  if (y == 0) return (fabs(s) + fabs(a - s)) / fabs(a);
  const double u = b * y, v = t * y;
  return (sqrt(s * s + v * v) + sqrt((a - s) * (a - s) + (u - v) * (u - v))) /
         sqrt(a * a + u * u);
}

/* The ellipse around an element on which its places lie for λ on the ellipse ρ. */
static double reach(const hr2di_meeting *m, const double gap[2], double scale, double rho) {
  const double major = 0.25 * (rho + 1 / rho), minor = 0.25 * (rho - 1 / rho);
  const double across[2] = {m->across[0], scale * m->across[1]};
  double max = 1;
  for (int k = 0; k < 2; k++) {
    const double start[2] = {m->start[0] + k * gap[0], scale * (m->start[1] + k * gap[1])};
    if (m->fixed & (1u << k)) continue;
    max = greater(place_at(across, start, major, 0), max);
    max = greater(place_at(across, start, -major, 0), max);
    max = greater(place_at(across, start, 0, minor), max);
  }
  return ellipse(max);
}

/* ln (ρ_i ρ_j)^(p−1) on the ellipse ρ. */
static double growth(const hr2di_trapezoid *t, size_t order, double scale, double rho) {
  double grows = 1;
  for (size_t k = 0; k < 2; k++)
    if (t->on[k].fixed != 3) grows *= reach(&t->on[k], t->gap, scale, rho);
  return (double)(order - 1) * logarithm(grows);
}

/* A rule for a trapezoid. */
typedef struct choice {
  double kappa, points;
} choice;

/* Tries the ellipses ρ₀^¾ and ρ₀^½; the latter only if it may be better. */
static choice choose(const hr2di_trapezoid *t, const outline *o, size_t order, double digits) {
  double m;
  const double scale = choose_kappa(o, &m) * o->ratio, rho = ellipse(m);
  const double root = sqrt(rho),
               more = order > 1 ? growth(t, order, scale, root * sqrt(root)) : 0;
  double points = (digits + more) / 1.5;
  if (2 * more > digits) points = lesser(points, digits + growth(t, order, scale, root));
  return (choice){scale, greater(points / logarithm(rho) + MARGIN, 1)};
}

/* Half the measure of the lines, at most: |e|² is no less than in the middle. */
static double bound_area(const hr2di_trapezoid *t, const outline *o) {
  const double square = hr2di_vector_dot(&t->e[0], &t->e[0]), m = 0.5 + 0.5 * o->cosine;
  return 0.5 * t->turn * greater(t->gap[0], t->gap[1] * o->ratio) * o->ratio /
         (square * sqrt(square) * m * sqrt(m));
}

static const hr2di_rule *rule_of(hr2di_integrator *w, double points) {
  size_t n = (size_t)ceil(points);
  if (n > 12) n += n & 1;
  if (n > 24) n += n & 2;
  return hr2di_integrator_rule(w, n);
}

/* Places on an element: the centre of the lines is at base + middle/across, in [-1,1], and half
   their width is width + gap/across.  So what is fixed is rounded only once. */
typedef struct spread {
  double base, width, middle[2], gap[2];
} spread;

static spread spread_of(const hr2di_meeting *m, const double gap[2]) {
  const double low = m->place[0], high = m->place[1];
  switch (m->fixed) {
  case 3:
    return (spread){(low - 0.5) + (high - 0.5), high - low, {0, 0}, {0, 0}};
  case 1:
    return (spread){2 * low - 1, 0, {gap[0], gap[1]}, {gap[0], gap[1]}};
  case 2:
    return (spread){2 * high - 1, 0, {-gap[0], -gap[1]}, {gap[0], gap[1]}};
  default:
    break;
  }
  const double *start = m->start, *across = m->across;
  const double middle[] = {2 * start[0] + gap[0] - across[0],
                           2 * start[1] + gap[1] - across[1]};
  return (spread){0, 0, {middle[0], middle[1]}, {gap[0], gap[1]}};
}

/* Sets the places for directions f e[0] + g e[1]. */
static void set_places(const hr2di_meeting *m, const double gap[2], size_t count,
                       const double *restrict f, const double *restrict g,
                       double *restrict centre, double *restrict half) {
  const spread s = spread_of(m, gap);
  for (size_t q = 0; q < count; q++) {
    const double by = 1 / (f[q] * m->across[0] + g[q] * m->across[1]);
    centre[q] = s.base + (f[q] * s.middle[0] + g[q] * s.middle[1]) * by;
    half[q] = s.width + (f[q] * s.gap[0] + g[q] * s.gap[1]) * by;
  }
}

static int covers(const hr2di_meeting *m) {
  return m->fixed == 3 && m->place[0] == 0 && m->place[1] == 1;
}

/* As add_directions(), through gas. */
static void add_gas(hr2di_integrator *w, const hr2di_trapezoid *t, choice chosen,
                    double *block) {
  const hr2di_rule *rule = rule_of(w, chosen.points);
  const double k = chosen.kappa, turn = 0.5 * k * t->turn;
  for (size_t q = 0; q < rule->points; q++) {
    const double f = 0.5 - 0.5 * rule->at[q], g = k * (0.5 + 0.5 * rule->at[q]);
    const double x = f * t->e[0].x + g * t->e[1].x, y = f * t->e[0].y + g * t->e[1].y;
    const double square = x * x + y * y, length = sqrt(square);
    const double gap = f * t->gap[0] + g * t->gap[1];
    hr2di_gas_lines lines = {.weight = turn * rule->weight[q] * gap / (square * length)};
    for (size_t side = 0; side < 2; side++)
      set_places(&t->on[side], t->gap, 1, &f, &g, &lines.centre[side], &lines.half[side]);
    if (is_mixed(w)) {
      for (size_t vertex = 0; vertex < 2; vertex++)
        hr2di_gas_cells_depths(w->cells, t, vertex, f, g, length);
      hr2di_gas_cells_add(w, &lines, block);
      continue;
    }
    for (size_t vertex = 0; vertex < 2; vertex++)
      lines.depth[vertex] = hr2di_gas_depth(w, t, vertex, f, g, length);
    hr2di_gas_add(w, &lines, block);
  }
}

static void add_directions(hr2di_integrator *w, const hr2di_trapezoid *t, choice chosen,
                           double *block) {
  const hr2di_rule *rule = rule_of(w, chosen.points);
  const size_t n = rule->points;
  const double k = chosen.kappa, turn = 0.5 * k * t->turn;
  const hr2di_cover cover = covers(&t->on[0])   ? HR2DI_COVERS_I
                            : covers(&t->on[1]) ? HR2DI_COVERS_J
                                                : HR2DI_COVERS_NEITHER;
  double f[MOST_POINTS], g[MOST_POINTS];
  hr2di_directions *d = hr2di_moments_room(&w->moments, cover, block);
  double *restrict weight = d->weight + d->count;
  for (size_t q = 0; q < n; q++) {
    f[q] = 0.5 - 0.5 * rule->at[q];
    g[q] = k * (0.5 + 0.5 * rule->at[q]);
  }
  for (size_t q = 0; q < n; q++) {
    const double x = f[q] * t->e[0].x + g[q] * t->e[1].x;
    const double y = f[q] * t->e[0].y + g[q] * t->e[1].y;
    const double square = x * x + y * y, gap = f[q] * t->gap[0] + g[q] * t->gap[1];
    weight[q] = turn * rule->weight[q] * gap / (square * sqrt(square));
  }
  for (int side = 0; side < 2; side++)
    if (cover == HR2DI_COVERS_NEITHER || cover == (hr2di_cover)side)
      set_places(&t->on[side], t->gap, n, f, g, d->centre[side] + d->count,
                 d->half[side] + d->count);
  d->count += n;
  w->kernels += n;
}

/* The weights that divide where the rates at which u × e and e × v grow have the same sum on
   either side; |e0| = |e1|. */
static void choose_middle(const outline *o, double m[2]) {
  const double min = 0x1p-60;
  const double *i = o->across[0], *j = o->across[1];
  const double by_i = (i[1] + min * i[0]) / (i[0] + min * i[1]);
  const double by_j = (j[1] + min * j[0]) / (j[0] + min * j[1]);
  const double more = greater(by_i, by_j), less = lesser(by_i, by_j);
  const double rate = less >= 1 ? more : more <= 1 ? less : by_i * by_j;
  const double weight = 1 / sqrt(rate);
  m[0] = 1 / (1 + weight);
  m[1] = o->ratio * weight / (1 + weight);
}

static void halve(const hr2di_trapezoid *t, const outline *o, hr2di_trapezoid part[2]) {
  double m[2];
  choose_middle(o, m);
  hr2di_trapezoid_divide(t, m, part);
}

/* Divides a trapezoid in two if that takes fewer points.  Returns 0 if not. */
static int divide(const hr2di_integrator *w, const hr2di_trapezoid *t, const outline *o,
                  double digits, double points, hr2di_trapezoid part[2]) {
  const size_t order = w->order;
  if (points <= 14 + (double)order) return 0;
  halve(t, o, part);
  if (points > MOST_POINTS) return 1;
  for (size_t k = 0; k < 2; k++) {
    const outline half = outline_of(w, &part[k]);
    points -= choose(&part[k], &half, order, digits).points;
  }
  return points > 0;
}

/* Adds a trapezoid to within e^−w->digits of `area`. */
static hr2d_status add_trapezoid(hr2di_integrator *w, const hr2di_trapezoid *whole, double area,
                                 double *block) {
  const size_t p = w->order;
  hr2di_trapezoid stack[STACK];
  size_t count = 1;
  stack[0] = *whole;
  while (count > 0) {
    const hr2di_trapezoid t = stack[--count];
    const outline o = outline_of(w, &t);
    const int room = count + 2 <= STACK;
    if (o.cosine < WIDE && room) {
      hr2di_trapezoid_divide(&t, (const double[]){0.5, 0.5 * o.ratio}, &stack[count]);
      count += 2;
      continue;
    }
    const double part = bound_area(&t, &o) / area;
    if (!(part > NEGLIGIBLE)) continue;
    const double digits = w->digits - (part < 1 ? logarithm(1 / part) : 0);
    choice chosen = choose(&t, &o, p, digits);
    if (room && divide(w, &t, &o, digits, chosen.points, &stack[count])) {
      count += 2;
      continue;
    }
    const double more = is_mixed(w)         ? hr2di_gas_cells_points(w->cells, &t)
                        : w->absorption > 0 ? hr2di_gas_points(w, &t)
                                            : 0;
    if (more > MOST_POINTS && room) {
      halve(&t, &o, &stack[count]);
      count += 2;
      continue;
    }
    chosen.points = lesser(chosen.points + more, MOST_POINTS);
    const uint64_t lines = (uint64_t)chosen.points * (w->absorption > 0 ? 4 * p : 1);
    const hr2d_status status = hr2di_watch_work(w->watch, 2 + lines * (16 + 2 * p * p) / 160);
    if (status) return status;
    if (w->absorption > 0)
      add_gas(w, &t, chosen, block);
    else
      add_directions(w, &t, chosen, block);
  }
  return HR2D_OK;
}

hr2d_status hr2di_block_add_lines(hr2di_integrator *w, const hr2di_trapezoid *t, size_t count,
                                  double *block) {
  double area = block[0];
  for (size_t k = 0; k < count; k++) area += t[k].area;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status && area > 0; k++)
    if (t[k].gap[0] > 0 || t[k].gap[1] > 0)
      status = is_mixed(w) ? hr2di_gas_cells_divide(w, &t[k], add_trapezoid, area, block)
                           : add_trapezoid(w, &t[k], area, block);
  return status;
}
