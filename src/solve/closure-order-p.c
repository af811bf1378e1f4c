/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closure at an order p above 1.

   Near, touching and occluded pairs are linked exactly.  A link of a distant pair i, j drops
   the terms beyond degree p−1 on i; so its part of a leaf's row sum is off by some 3.3^−p of
   that part.  The exact part is the form factor F(x → j) of a point, which is smooth, and
   elementary because nothing is in the way.  On each leaf d = Π(Σ F(x → j) − K_distant 1)
   multiplies B, where Π projects onto degree p−1.  The matrix of that, (1/A)∫ d φ_l φ_m, is
   symmetric, so that the operator stays symmetric. */
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/bin.h"
#include "base/team.h"
#include "blocks/block.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/patch-defect.h"
#include "scene/scene-impl.h"
#include "solve/closure.h"

/* The rule for form factors has this many points more than the order: accurate to a relative
   3.3^−(2p+32) for elements at an ellipse of 1.8 or more. */
enum { MORE_POINTS = 16 };

typedef struct rows {
  const hr2di_transport *t;
  hr2di_basis basis;
  hr2di_rule rule;       /* for form factors */
  hr2di_rule product;    /* for d φ_l φ_m, of degree 3p − 3 */
  unsigned char *closed; /* per patch */
  hr2di_sum *defect;     /* per patch */
  uint32_t *number;      /* of each leaf among the leaves */
  double *scratch;       /* leaves × order: B = 1 */
  double *row;           /* its irradiance over distant links */
  double *all;           /* its irradiance over all links */
  double *exact;         /* leaves × order: Σ F(x → j) */
  hr2di_bin *bin;        /* the same of shares; NULL: there is but one */
  double scale;          /* σ of these */
  double phi[HR2DI_RULE_POINTS][HR2D_MAX_ORDER]; /* at the points of `rule` */
  double product_phi[HR2DI_RULE_POINTS][HR2D_MAX_ORDER];
} rows;

/* F(x → j) at fraction s of i, as in geometry/point-view-factor.h.  The cross product of the
   vectors C and D to the ends of j is A_j times the distance of x from the line of j, and
   |C| cos θ_C is the distance of the one end from the line of i: a rounding of these is one of
   F, also where F is small. */
static double point_factor(const hr2di_pair_frame *f, double s) {
  const hr2d_point c = hr2di_block_along(f->separation, f->along_i, -s);
  const hr2d_point d = {c.x + f->along_j.x, c.y + f->along_j.y};
  const double size_c = sqrt(c.x * c.x + c.y * c.y), size_d = sqrt(d.x * d.x + d.y * d.y);
  const double cosines = f->above_i[0] / size_c + f->above_i[1] / size_d;
  return f->length_j * hr2di_block_mix(f->above_j, s) * cosines /
         (2 * (size_c * size_d + (c.x * d.x + c.y * d.y)));
}

/* Adds the form factor of `source` to the leaves below `receiver`, by degree. */
static void add_exact(const rows *r, uint32_t receiver, uint32_t source, double weight,
                      hr2di_watch *watch) {
  const hr2d_hierarchy *h = r->t->hierarchy;
  const size_t order = r->t->order;
  const double start = hr2di_element_start(h, receiver), size = h->element[receiver].length;
  const double whole = h->element[h->element[receiver].patch].length;
  hr2di_pair_frame f;
  hr2di_pair_frame_init(&f, h, (hr2d_pair){receiver, source});
  uint32_t leaf = hr2di_hierarchy_first_leaf(h, receiver);
  do {
    if (hr2di_watch_work(watch, r->rule.points * (8 + order) / 16)) return;
    const double from = (hr2di_element_start(h, leaf) - start) * (whole / size);
    const double part = h->element[leaf].length / size;
    const size_t at = r->number[leaf] * order;
    double scratch[HR2D_MAX_ORDER] = {0}, *exact = r->bin ? scratch : r->exact + at;
    for (size_t q = 0; q < r->rule.points; q++) {
      const double s = from + part * (0.5 + 0.5 * r->rule.at[q]);
      const double factor = weight * r->rule.weight[q] * point_factor(&f, s);
      for (size_t l = 0; l < order; l++) exact[l] += factor * r->phi[q][l];
    }
    for (size_t l = 0; l < order && r->bin; l++)
      hr2di_bin_add(&r->bin[at + l], r->scale, exact[l]);
    leaf = hr2di_hierarchy_next_leaf(h, leaf, receiver);
  } while (leaf);
}

/* Links that are worth another thread, and the threads at most. */
enum { WORTH = 1000, MOST_PARTS = 16 };

/* Parts of the patches, one for each thread, which goes through all links: so the form factors
   of a leaf are summed in the order of the links, and no bit depends on threads. */
typedef struct parts {
  const rows *r;
  size_t count;
  hr2di_watch own[MOST_PARTS]; /* for parts that the calling thread does not do */
} parts;

static int takes(const parts *p, size_t part, uint32_t element) {
  const rows *r = p->r;
  const size_t patch = r->t->hierarchy->element[element].patch;
  return patch % p->count == part && !r->closed[patch];
}

static void add_links(void *ctx, size_t worker, size_t part) {
  parts *p = ctx;
  const rows *r = p->r;
  const hr2d_linkset *links = r->t->links;
  hr2di_watch *watch = worker == 0 ? r->t->watch : &p->own[part];
  for (uint64_t k = 0; k < links->store.count; k++) {
    if (k % 64 == 0 && hr2di_watch_work(watch, 4)) return;
    if (!links->blocks.distant[k]) continue;
    const hr2d_pair pair = hr2di_store_link(&links->store, k).pair;
    const double weight = hr2di_linkset_weight(links, pair);
    if (takes(p, part, pair.first)) add_exact(r, pair.first, pair.second, weight, watch);
    if (!links->directed && takes(p, part, pair.second))
      add_exact(r, pair.second, pair.first, weight, watch);
  }
}

static void add_all_links(const rows *r) {
  const uint64_t max = 1 + r->t->links->store.count / WORTH;
  parts p = {.r = r, .count = hr2di_team_threads(r->t->threads)};
  if (p.count > MOST_PARTS) p.count = MOST_PARTS;
  if (p.count > max) p.count = (size_t)max;
  for (size_t k = 0; k < p.count; k++) hr2di_watch_follow(&p.own[k], r->t->watch);
  hr2di_team_run(p.count, p.count, add_links, &p, r->t->watch);
}

/* The form factors of a point add up to 1 at most, and |φ_l| is √(2l+1) at most. */
static hr2d_status add_shares(rows *r, hr2di_transport *t) {
  const size_t count = t->leaves * t->order;
  r->bin = hr2di_alloc_zero(&t->alloc, count, sizeof *r->bin);
  r->scale = hr2di_bin_scale(2 * hr2di_symmetry_max(&t->hierarchy->scene->symmetry) *
                             sqrt((double)(2 * t->order)));
  if (r->bin) add_all_links(r);
  hr2d_status status = r->bin ? hr2di_transport_status(t) : HR2D_ENOMEM;
  status = hr2di_share_combine(t->links->share, status, HR2D_COMBINE_SUM,
                               r->bin ? &r->bin->head : NULL, 2 * count);
  for (size_t k = 0; k < count && !status; k++) r->exact[k] = hr2di_bin_total(&r->bin[k]);
  hr2di_alloc_free(&t->alloc, r->bin);
  return status;
}

/* Marks the patches that see patches in every direction. */
static hr2d_status find_closed(rows *r) {
  const hr2d_status status = hr2di_defect_sum(r->t->links, r->defect, r->t->watch);
  hr2di_defect_closed(r->t->links, r->defect, r->closed);
  return status;
}

/* The same if links of clusters carry a part of the rows.  Their accuracy is known; openings up
   to ten times that count as none. */
static void find_closed_by_rows(rows *r, hr2di_transport *t) {
  const double none = 10 * t->roots->accuracy;
  for (size_t k = 0; k < t->leaves * t->order; k++)
    r->row[k] = r->all[k] + (t->gas ? t->gas[k] : 0); /* which has taken its part */
  hr2di_transport_pull(t, r->row);
  for (size_t k = 0; k < t->hierarchy->scene->patches; k++)
    r->closed[k] = fabs(1 - t->up[k * t->order]) <= none;
}

/* Row sums of links and form factors have a relative error of some roundings.  Where a
   coefficient of d is no more, closure would add that part of the leaf's own B to its H, and H
   may be much less; a leaf that has all its links itself has no d_0 but this.  Patches that see
   patches everywhere keep it: an isothermal room stays so. */
static void clear_noise(const rows *r, const double *row, double *missing) {
  const double noise = hr2di_closure_noise(r->t);
  for (size_t l = 0; l < r->t->order; l++)
    if (fabs(missing[l]) <= noise * row[0]) missing[l] = 0;
}

/* closure_lm = (1/A)∫ d φ_l φ_m for d = Σ missing_k φ_k; symmetric. */
static void multiply(const rows *r, const double *missing, double *closure) {
  const size_t order = r->t->order;
  memset(closure, 0, order * order * sizeof *closure);
  for (size_t q = 0; q < r->product.points; q++) {
    const double *phi = r->product_phi[q];
    double d = 0;
    for (size_t k = 0; k < order; k++) d += missing[k] * phi[k];
    for (size_t l = 0; l < order; l++) {
      const double row = r->product.weight[q] * d * phi[l];
      for (size_t m = 0; m < order; m++) closure[l * order + m] += row * phi[m];
    }
  }
}

static void close_rows(rows *r, hr2di_transport *t, double *closure) {
  for (size_t q = 0; q < r->rule.points; q++)
    hr2di_basis_at(&r->basis, r->rule.at[q], r->phi[q]);
  for (size_t q = 0; q < r->product.points; q++)
    hr2di_basis_at(&r->basis, r->product.at[q], r->product_phi[q]);
  for (size_t k = 0; k < t->leaves; k++) {
    r->number[t->leaf[k]] = (uint32_t)k;
    r->scratch[k * t->order] = 1;
  }
  hr2di_transport_apply_part(t, HR2DI_ALL_LINKS, r->scratch, r->all);
  if (t->failed) return;
  const hr2di_clusters *clusters = t->roots->clusters;
  if (clusters && hr2di_clusters_links(clusters) > 0)
    find_closed_by_rows(r, t);
  else
    t->failed = find_closed(r);
  if (t->failed) return;
  t->all_closed = !memchr(r->closed, 0, t->hierarchy->scene->patches);
  if (!t->all_closed) hr2di_transport_apply_part(t, HR2DI_DISTANT_LINKS, r->scratch, r->row);
  if (t->failed) return;
  if (t->gas)
    memcpy(r->exact, r->row, t->leaves * t->order * sizeof *r->exact); /* no part of it */
  else if (t->links->share)
    t->failed = add_shares(r, t);
  else
    add_all_links(r);
  hr2di_image_map_fold_leaves(&t->image_map, t->order, 1, r->exact);
  for (size_t k = 0; k < t->leaves; k++) {
    t->failed = hr2di_watch_work(t->watch, 1 + r->product.points * t->order * t->order / 32);
    if (t->failed) return;
    const int closed = r->closed[t->hierarchy->element[t->leaf[k]].patch];
    const double *row = (closed ? r->all : r->row) + k * t->order;
    double *missing = r->exact + k * t->order;
    for (size_t l = 0; l < t->order && closed; l++)
      missing[l] = (l == 0) - (t->gas ? t->gas[k * t->order + l] : 0);
    for (size_t l = 0; l < t->order; l++) missing[l] -= row[l];
    if (!closed) clear_noise(r, row, missing);
    multiply(r, missing, closure + k * t->order * t->order);
  }
}

hr2d_status hr2di_closure_set_order_p(hr2di_transport *t) {
  const hr2d_allocator *alloc = &t->alloc;
  rows r = {.t = t};
  hr2di_basis_init(&r.basis, t->order);
  hr2di_rule_init(&r.rule, t->order + MORE_POINTS);
  hr2di_rule_init(&r.product, (3 * t->order) / 2);
  r.number = hr2di_alloc(alloc, t->elements, sizeof *r.number);
  r.scratch = hr2di_alloc_zero(alloc, t->leaves * t->order, sizeof *r.scratch);
  r.row = hr2di_alloc(alloc, t->leaves * t->order, sizeof *r.row);
  r.all = hr2di_alloc(alloc, t->leaves * t->order, sizeof *r.all);
  r.closed = hr2di_alloc(alloc, t->hierarchy->scene->patches, 1);
  r.defect = hr2di_alloc(alloc, t->hierarchy->scene->patches, sizeof *r.defect);
  r.exact = hr2di_alloc_zero(alloc, t->leaves * t->order, sizeof *r.exact);
  double *closure = hr2di_alloc(alloc, t->leaves, t->order * t->order * sizeof *closure);
  const int room =
      r.number && r.scratch && r.row && r.all && r.closed && r.defect && r.exact && closure;
  if (room) {
    close_rows(&r, t, closure);
    t->closure = closure;
    t->closed = r.closed;
    t->rows = r.all;
    r.closed = NULL;
    r.all = NULL;
  } else {
    hr2di_alloc_free(alloc, closure);
  }
  hr2di_alloc_free(alloc, r.number);
  hr2di_alloc_free(alloc, r.scratch);
  hr2di_alloc_free(alloc, r.row);
  hr2di_alloc_free(alloc, r.all);
  hr2di_alloc_free(alloc, r.closed);
  hr2di_alloc_free(alloc, r.defect);
  hr2di_alloc_free(alloc, r.exact);
  return room ? t->failed : HR2D_ENOMEM;
}
