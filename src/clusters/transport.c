/* SPDX-License-Identifier: GPL-3.0-or-later */
/* K over cluster links: patches to points, points to points of the clusters around, across
   the links, and back the same way.

   Interpolation at Chebyshev points is f ≈ Σ_n c_n T_n, c_n = (1 or 2)/q Σ_k T_n(t_k) f(t_k).
   Applied to what is sent, strengths s at places t become moments Σ s T_n(t), and these
   strengths at the points; applied to what is received it is its transpose, so that the
   whole is symmetric.

   Of several shares each has some of the clusters: their patches, and all that they receive. So
   each number is made by one share, in one order, which is not that of both ways at once. */
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/legendre.h"
#include "base/ordered-dot.h"
#include "base/wide.h"
#include "clusters/clusters-impl.h"
#include "scene/scene-impl.h"

enum { MOST_POINTS = HR2DI_EXPANSION_POINTS * HR2DI_EXPANSION_POINTS };

/* Of each cluster 2·bands planes, each with a value per point: x components, then y. */
typedef struct gather {
  const hr2di_clusters *c;
  size_t order, bands, planes;
  hr2d_share *share; /* NULL: there is but one */
  double *sent, *received;
  hr2di_watch *watch;
  double *vector; /* one value per plane */
  hr2di_basis basis;
  hr2di_rule *rule; /* for each number of points; 0 points: not made yet */
} gather;

static double *planes_of(const gather *g, double *field, const hr2di_linked *c) {
  return field + c->first * g->planes;
}

/* T_n at a place along both directions. */
typedef struct place {
  double t[2][HR2DI_EXPANSION_POINTS];
} place;

static void place_in(const hr2di_expansion *f, hr2d_point p, place *at) {
  const double along[] = {f->u.x * p.x + f->u.y * p.y, f->u.x * p.y - f->u.y * p.x};
  const unsigned count = f->count[0] > f->count[1] ? f->count[0] : f->count[1];
  double t[2];
  for (int k = 0; k < 2; k++) {
    t[k] = f->half[k] > 0 ? (along[k] - f->at[k]) / f->half[k] : 0;
    at->t[k][0] = 1;
    at->t[k][1] = t[k];
  }
  /* Each value waits for the one before: both directions at a time take no longer than one. */
  for (unsigned n = 2; n < count; n++) {
    at->t[0][n] = 2 * t[0] * at->t[0][n - 1] - at->t[0][n - 2];
    at->t[1][n] = 2 * t[1] * at->t[1][n - 1] - at->t[1][n - 2];
  }
}

/* Adds g->vector, sent from a place, to the moments of a cluster. */
static void send(const gather *g, const hr2di_linked *c, hr2d_point p) {
  const hr2di_expansion *f = &c->far;
  place at;
  place_in(f, p, &at);
  double *moment = planes_of(g, g->sent, c);
  for (size_t k = 0; k < g->planes; k++)
    for (unsigned m = 0; m < f->count[1]; m++) {
      const double s = g->vector[k] * at.t[1][m];
      for (unsigned n = 0; n < f->count[0]; n++) *moment++ += s * at.t[0][n];
    }
}

/* Sets g->vector to what is received at a place. */
static void receive(const gather *g, const hr2di_linked *c, hr2d_point p) {
  const hr2di_expansion *f = &c->far;
  place at;
  place_in(f, p, &at);
  const double *coefficient = planes_of(g, g->received, c);
  for (size_t k = 0; k < g->planes; k++) {
    double sum = 0;
    for (unsigned m = 0; m < f->count[1]; m++) {
      double row = 0;
      for (unsigned n = 0; n < f->count[0]; n++) row += *coefficient++ * at.t[0][n];
      sum += row * at.t[1][m];
    }
    g->vector[k] = sum;
  }
}

/* out_a = Σ_b matrix(a,b) in_b along one direction of a plane, where the matrix is
   (1 or 2)/q T, or its transpose. */
static void turn(const hr2di_clusters *c, const hr2di_expansion *f, int along, int transposed,
                 const double *in, double *out) {
  const unsigned count = f->count[along], others = f->count[1 - along];
  const size_t step = along ? f->count[0] : 1, next = along ? 1 : f->count[0];
  const double *t = hr2di_clusters_cosines(c, count);
  for (unsigned o = 0; o < others; o++, in += next, out += next)
    for (unsigned a = 0; a < count; a++) {
      double sum = 0;
      for (unsigned b = 0; b < count; b++) {
        const unsigned n = transposed ? b : a, k = transposed ? a : b;
        sum += (n > 0 ? 2 : 1) * t[n * count + k] * in[b * step];
      }
      out[a * step] = sum / count;
    }
}

static void turn_planes(const gather *g, double *field, const hr2di_linked *c, int transposed) {
  double between[MOST_POINTS];
  const size_t points = hr2di_expansion_points(&c->far);
  double *plane = planes_of(g, field, c);
  for (size_t k = 0; k < g->planes; k++, plane += points) {
    turn(g->c, &c->far, 0, transposed, plane, between);
    turn(g->c, &c->far, 1, transposed, between, plane);
  }
}

static const hr2di_rule *rule_of(const gather *g, size_t points) {
  hr2di_rule *rule = &g->rule[points];
  if (rule->points == 0) hr2di_rule_init(rule, points);
  return rule;
}

static hr2d_point point_of(hr2d_segment s, double xi) {
  const double t = 0.5 * (1 + xi);
  return (hr2d_point){s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
}

/* B n ds at the Gauss points of a patch; n ds = (−dy, dx)·weight. */
static void send_patch(const gather *g, size_t patch, const double *radiosity) {
  const hr2di_linked *c = &g->c->linked[g->c->home[patch]];
  const hr2di_patch *p = &g->c->scene->patch[patch];
  const hr2d_segment s = p->scaled;
  const hr2di_rule *rule =
      rule_of(g, hr2di_expansion_gauss(&c->far, p->length, g->order, g->c->accuracy));
  for (size_t k = 0; k < rule->points; k++) {
    for (size_t band = 0; band < g->bands; band++) {
      const double b =
          rule->weight[k] * hr2di_basis_sum(&g->basis, rule->at[k], radiosity + band, g->bands);
      g->vector[band] = b * (s.a.y - s.b.y);
      g->vector[g->bands + band] = b * (s.b.x - s.a.x);
    }
    send(g, c, point_of(s, rule->at[k]));
  }
}

static void receive_patch(const gather *g, size_t patch, double *power) {
  const hr2di_linked *c = &g->c->linked[g->c->home[patch]];
  const hr2di_patch *p = &g->c->scene->patch[patch];
  const hr2d_segment s = p->scaled;
  const hr2di_rule *rule =
      rule_of(g, hr2di_expansion_gauss(&c->far, p->length, g->order, g->c->accuracy));
  double phi[HR2D_MAX_ORDER];
  for (size_t k = 0; k < rule->points; k++) {
    receive(g, c, point_of(s, rule->at[k]));
    hr2di_basis_at(&g->basis, rule->at[k], phi);
    for (size_t band = 0; band < g->bands; band++) {
      const double h = rule->weight[k] * (g->vector[band] * (s.a.y - s.b.y) +
                                          g->vector[g->bands + band] * (s.b.x - s.a.x));
      for (size_t l = 0; l < g->order; l++) power[l * g->bands + band] += h * phi[l];
    }
  }
}

/* From the points of a cluster to the one above it, as if they were patches. */
static void send_up(const gather *g, const hr2di_linked *c) {
  const hr2di_linked *parent = &g->c->linked[c->parent];
  const size_t points = hr2di_expansion_points(&c->far);
  const double *plane = planes_of(g, g->sent, c);
  for (size_t k = 0; k < points; k++) {
    for (size_t m = 0; m < g->planes; m++) g->vector[m] = plane[m * points + k];
    send(g, parent, g->c->point[c->first + k]);
  }
}

static void receive_down(const gather *g, const hr2di_linked *c) {
  const hr2di_linked *parent = &g->c->linked[c->parent];
  const size_t points = hr2di_expansion_points(&c->far);
  double *plane = planes_of(g, g->received, c);
  for (size_t k = 0; k < points; k++) {
    receive(g, parent, g->c->point[c->first + k]);
    for (size_t m = 0; m < g->planes; m++) plane[m * points + k] += g->vector[m];
  }
}

/* T between a point and all points of a cluster: xx, xy, yy. */
typedef struct row {
  double xx[MOST_POINTS], xy[MOST_POINTS], yy[MOST_POINTS];
} row;

HR2DI_PART void fill_row_loop(row *restrict t, hr2d_point x, const hr2d_point *restrict y,
                              size_t count) {
  for (size_t k = 0; k < count; k++) {
    const double dx = y[k].x - x.x, dy = y[k].y - x.y;
    const double square = dx * dx + dy * dy, s = -0.5 / (square * sqrt(square));
    t->xx[k] = s * dx * dx;
    t->xy[k] = s * dx * dy;
    t->yy[k] = s * dy * dy;
  }
}
HR2DI_WIDE(fill_row,
           (row *restrict t, hr2d_point x, const hr2d_point *restrict y, size_t count),
           (t, x, y, count))

/* One band of a row, both ways.  Sums are four side by side. */
HR2DI_PART void exchange_row_loop(const row *restrict t, size_t count, const double sent[2],
                                  const double *restrict sent_x, const double *restrict sent_y,
                                  double received[2], double *restrict received_x,
                                  double *restrict received_y) {
  double x[4] = {0}, y[4] = {0};
  size_t k = 0;
  for (; k + 4 <= count; k += 4)
    for (size_t l = 0; l < 4; l++) {
      received_x[k + l] += t->xx[k + l] * sent[0] + t->xy[k + l] * sent[1];
      received_y[k + l] += t->xy[k + l] * sent[0] + t->yy[k + l] * sent[1];
      x[l] += t->xx[k + l] * sent_x[k + l] + t->xy[k + l] * sent_y[k + l];
      y[l] += t->xy[k + l] * sent_x[k + l] + t->yy[k + l] * sent_y[k + l];
    }
  for (; k < count; k++) {
    received_x[k] += t->xx[k] * sent[0] + t->xy[k] * sent[1];
    received_y[k] += t->xy[k] * sent[0] + t->yy[k] * sent[1];
    x[0] += t->xx[k] * sent_x[k] + t->xy[k] * sent_y[k];
    y[0] += t->xy[k] * sent_x[k] + t->yy[k] * sent_y[k];
  }
  received[0] += hr2di_dot_four(x[0], x[1], x[2], x[3]);
  received[1] += hr2di_dot_four(y[0], y[1], y[2], y[3]);
}
HR2DI_WIDE(exchange_row,
           (const row *restrict t, size_t count, const double sent[2],
            const double *restrict sent_x, const double *restrict sent_y, double received[2],
            double *restrict received_x, double *restrict received_y),
           (t, count, sent, sent_x, sent_y, received, received_x, received_y))

static void exchange(const gather *g, const hr2di_linked *i, const hr2di_linked *j) {
  const size_t m = hr2di_expansion_points(&i->far), n = hr2di_expansion_points(&j->far);
  double *sent_i = planes_of(g, g->sent, i), *sent_j = planes_of(g, g->sent, j);
  double *received_i = planes_of(g, g->received, i), *received_j = planes_of(g, g->received, j);
  row t;
  for (size_t k = 0; k < m; k++) {
    if (hr2di_watch_work(g->watch, 1 + n * (1 + g->bands) / 16)) return;
    fill_row(&t, g->c->point[i->first + k], g->c->point + j->first, n);
    for (size_t band = 0; band < g->bands; band++) {
      const size_t x = band, y = g->bands + band;
      const double sent[] = {sent_i[x * m + k], sent_i[y * m + k]};
      double received[2] = {0, 0};
      exchange_row(&t, n, sent, sent_j + x * n, sent_j + y * n, received, received_j + x * n,
                   received_j + y * n);
      received_i[x * m + k] += received[0];
      received_i[y * m + k] += received[1];
    }
  }
}

static int is_own(const gather *g, uint32_t cluster) {
  return hr2di_share_has_row(g->share, cluster, g->c->linked_count);
}

/* Whether this share speaks for a patch that has a cluster. */
static int has_patch(const gather *g, size_t patch) {
  const uint32_t home = g->c->home[patch];
  return home != HR2DI_NO_CLUSTER && is_own(g, home);
}

/* What the first of two clusters receives. */
static void receive_one_way(const gather *g, const hr2di_linked *i, const hr2di_linked *j) {
  const size_t m = hr2di_expansion_points(&i->far), n = hr2di_expansion_points(&j->far);
  const double *sent = planes_of(g, g->sent, j);
  double *received = planes_of(g, g->received, i);
  row t;
  for (size_t k = 0; k < m; k++) {
    if (hr2di_watch_work(g->watch, 1 + n * (1 + g->bands) / 32)) return;
    fill_row(&t, g->c->point[i->first + k], g->c->point + j->first, n);
    for (size_t band = 0; band < g->bands; band++) {
      const double *sent_x = sent + band * n, *sent_y = sent + (g->bands + band) * n;
      double x = 0, y = 0;
      for (size_t q = 0; q < n; q++) {
        x += t.xx[q] * sent_x[q] + t.xy[q] * sent_y[q];
        y += t.xy[q] * sent_x[q] + t.yy[q] * sent_y[q];
      }
      received[band * m + k] += x;
      received[(g->bands + band) * m + k] += y;
    }
  }
}

static void exchange_own(const gather *g, const hr2di_cluster_link *link) {
  const hr2di_linked *i = &g->c->linked[link->first], *j = &g->c->linked[link->second];
  if (!g->share) {
    exchange(g, i, j);
    return;
  }
  if (is_own(g, link->first)) receive_one_way(g, i, j);
  if (is_own(g, link->second)) receive_one_way(g, j, i);
}

/* The points of a cluster, and what they cost on the way up or down. */
static hr2d_status declare(const gather *g, const hr2di_linked *c) {
  const size_t points = hr2di_expansion_points(&c->far);
  return hr2di_watch_work(g->watch, 1 + points * points * g->planes / 64);
}

static hr2d_status declare_patch(const gather *g, size_t patch) {
  const size_t points = hr2di_expansion_points(&g->c->linked[g->c->home[patch]].far);
  return hr2di_watch_work(g->watch, 4 + g->order * points * g->planes / 16);
}

/* Puts the points of all shares together. */
static hr2d_status combine(const gather *g, hr2d_status status, double *field) {
  return hr2di_share_combine(g->share, status, HR2D_COMBINE_SUM, field,
                             g->c->points * g->planes);
}

static hr2d_status run(const gather *g, const double *radiosity, double *power) {
  const hr2di_clusters *c = g->c;
  const size_t stride = g->order * g->bands, patches = c->scene->patches;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < patches && !status; k++) {
    if (!has_patch(g, k)) continue;
    status = declare_patch(g, k);
    send_patch(g, k, radiosity + k * stride);
  }
  status = combine(g, status, g->sent);
  for (size_t k = c->linked_count; k-- > 0 && !status;) {
    status = declare(g, &c->linked[k]);
    turn_planes(g, g->sent, &c->linked[k], 1);
    if (c->linked[k].parent != HR2DI_NO_CLUSTER) send_up(g, &c->linked[k]);
  }
  for (size_t k = 0; k < c->links && !hr2di_watch_status(g->watch); k++)
    exchange_own(g, &c->link[k]);
  if (!status) status = combine(g, hr2di_watch_status(g->watch), g->received);
  for (size_t k = 0; k < c->linked_count && !status; k++) {
    status = declare(g, &c->linked[k]);
    if (c->linked[k].parent != HR2DI_NO_CLUSTER) receive_down(g, &c->linked[k]);
    turn_planes(g, g->received, &c->linked[k], 0);
  }
  for (size_t k = 0; k < patches && !status; k++) {
    if (!has_patch(g, k)) continue;
    status = declare_patch(g, k);
    receive_patch(g, k, power + k * stride);
  }
  return status;
}

/* Adds up what patches of all shares receive before it is added to `power`. */
static hr2d_status run_shared(const gather *g, const double *radiosity, double *power) {
  const hr2d_allocator *alloc = &g->c->alloc;
  const size_t values = g->c->scene->patches * g->order * g->bands;
  double *sum = hr2di_alloc_zero(alloc, values, sizeof *sum);
  hr2d_status status = sum ? run(g, radiosity, sum) : HR2D_ENOMEM;
  status = hr2di_share_combine(g->share, status, HR2D_COMBINE_SUM, sum, values);
  for (size_t k = 0; k < values && !status; k++) power[k] += sum[k];
  hr2di_alloc_free(alloc, sum);
  return status;
}

hr2d_status hr2di_clusters_gather(hr2di_clusters *clusters, size_t order, size_t bands,
                                  const double *radiosity, double *power, hr2d_share *share,
                                  hr2di_watch *watch) {
  if (clusters->links == 0) return HR2D_OK;
  const hr2d_allocator *alloc = &clusters->alloc;
  gather g = {.c = clusters,
              .order = order,
              .bands = bands,
              .planes = 2 * bands,
              .share = share,
              .watch = watch};
  g.sent = hr2di_alloc_zero(alloc, clusters->points, g.planes * sizeof *g.sent);
  g.received = hr2di_alloc_zero(alloc, clusters->points, g.planes * sizeof *g.received);
  g.vector = hr2di_alloc(alloc, g.planes, sizeof *g.vector);
  g.rule = hr2di_alloc_zero(alloc, HR2DI_RULE_POINTS + 1, sizeof *g.rule);
  hr2d_status status = g.sent && g.received && g.vector && g.rule ? HR2D_OK : HR2D_ENOMEM;
  hr2di_basis_init(&g.basis, order);
  if (share && status) status = hr2di_share_agree(share, status);
  if (!status) status = (share ? run_shared : run)(&g, radiosity, power);
  hr2di_alloc_free(alloc, g.sent);
  hr2di_alloc_free(alloc, g.received);
  hr2di_alloc_free(alloc, g.vector);
  hr2di_alloc_free(alloc, g.rule);
  return status;
}
