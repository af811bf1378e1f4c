/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rank makes the links whose first element is in, or above, its units, or of its rows.  Each
   pair belongs to the rank of the first unit below its first element.  Pairs above the cut,
   some hundred, are asked about by all ranks that have units below; what is counted twice
   because of that is counted once more, alone, and taken off. */
#include "share.h"

#include "deal.h"
#include "long-rows.h"
#include "units.h"

/* Pairs whose first element is above the cut. */
struct hr2dpi_top {
  hr2d_hierarchy *hierarchy[2];
  hr2d_linkset *links[2]; /* above units of this rank; on rank 0, above all units */
};

static hr2d_status make_set(hr2dp *p, hr2d_hierarchy **hierarchy, hr2d_linkset **links) {
  hr2d_status status = hr2d_hierarchy_create(p->scene, hierarchy);
  if (!status)
    status = hr2d_linkset_create(*hierarchy, &p->oracle, p->oracle_ctx, &p->policy,
                                 p->policy_ctx, links);
  return status;
}

void hr2dpi_share_clear(hr2dp *p) {
  hr2d_linkset_destroy(p->links);
  hr2d_hierarchy_destroy(p->hierarchy);
  for (int k = 0; k < 2 && p->top; k++) {
    hr2d_linkset_destroy(p->top->links[k]);
    hr2d_hierarchy_destroy(p->top->hierarchy[k]);
  }
  hr2dpi_free(p, p->top);
  hr2dpi_free(p, p->repeated);
  p->top = NULL;
  p->links = NULL;
  p->hierarchy = NULL;
  p->repeated = NULL;
  p->repeats = 0;
}

hr2d_status hr2dpi_share_init(hr2dp *p) {
  hr2dpi_share_clear(p);
  hr2d_status status = make_set(p, &p->hierarchy, &p->links);
  if (!status) p->roots = (size_t)hr2d_hierarchy_count(p->hierarchy).elements;
  if (status || p->units.cut == 0) return status;
  p->top = hr2dpi_alloc_zero(p, 1, sizeof *p->top);
  if (!p->top) return HR2D_ENOMEM;
  status = make_set(p, &p->top->hierarchy[0], &p->top->links[0]);
  if (!status && p->rank == 0) status = make_set(p, &p->top->hierarchy[1], &p->top->links[1]);
  return status;
}

/* The work of units and rows is counted at COARSER·ε, and with at most FEW links for each rank
   at ε, as so few predict the work badly. */
enum { COARSER = 4, FEW = 4096 };

typedef struct weigher {
  const hr2dp *p;
  const hr2d_hierarchy *hierarchy;
  double *weight;
} weigher;

static hr2d_status weigh_links(void *ctx, const hr2d_link *links, size_t count) {
  const weigher *w = ctx;
  const hr2d_element *element = hr2d_hierarchy_elements(w->hierarchy);
  uint64_t units;
  for (size_t k = 0; k < count; k++)
    w->weight[hr2dpi_unit_of(w->p, element, links[k].pair.first, &units)]++;
  return HR2D_OK;
}

/* With a cut, of units; a link above it counts on its first unit. */
static hr2d_status weigh_units(hr2dp *p, hr2d_refine_options *options, hr2d_linkset *links,
                               double *weight) {
  weigher w = {p, hr2d_linkset_hierarchy(links), weight};
  hr2dpi_claim claim = {p, p->units.links.from[p->rank], p->units.links.from[p->rank + 1], 0};
  hr2d_refine_counts counts;
  options->claim = hr2dpi_claim_pairs;
  options->claim_ctx = &claim;
  return hr2d_refine_visit(links, options, weigh_links, &w, &counts);
}

/* An equal part of the rows, until it is known what they take. */
static void set_equal_rows(hr2dp *p) {
  const uint64_t from = p->units.links.from[p->rank], to = p->units.links.from[p->rank + 1];
  for (uint64_t k = 0; k < p->patches; k++) p->units.rows[k] = k >= from && k < to;
  p->units.cuts = 0;
  memset(p->long_rows, 0, sizeof p->long_rows);
}

/* Sets the links and tests of own rows. */
static hr2d_status weigh_rows(hr2dp *p, hr2d_refine_options *options, hr2d_linkset *links,
                              double *weight) {
  hr2d_row_counts *row = hr2dpi_alloc_zero(p, p->patches, sizeof *row);
  hr2d_refine_counts counts;
  if (!row) return HR2D_ENOMEM;
  options->row_counts = row;
  options->rows = p->units.rows;
  const hr2d_status status = hr2d_refine_count(links, options, &counts);
  for (size_t k = 0; k < p->patches && !status; k++) {
    weight[2 * k] = (double)row[k].links;
    weight[2 * k + 1] = (double)row[k].visibility_tests;
  }
  hr2dpi_free(p, row);
  return status;
}

static hr2d_status weigh(hr2dp *p, const hr2d_refine_options *given, double coarser,
                         double *weight) {
  hr2d_refine_options options = *given;
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  options.max_elements = options.max_links = options.max_bytes = 0;
  options.epsilon = coarser * (given->epsilon > 0 ? given->epsilon : HR2D_DEFAULT_EPSILON);
  hr2d_status status = make_set(p, &hierarchy, &links);
  if (!status)
    status = p->units.cut > 0 ? weigh_units(p, &options, links, weight)
                              : weigh_rows(p, &options, links, weight);
  if (status && links && hr2d_linkset_message(links)[0])
    hr2dpi_fail(p, status, "%s", hr2d_linkset_message(links));
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  return status;
}

/* Whether there are few links.  Units have one weight, rows have two. */
static int are_few(const hr2dp *p, const double *weight, size_t weights) {
  const size_t step = p->units.cut > 0 ? 1 : 2;
  double links = 0;
  for (size_t k = 0; k < weights; k += step) links += weight[k];
  return links < (double)FEW * p->ranks;
}

static PetscErrorCode weigh_all(hr2dp *p, const hr2d_refine_options *options, double *weight,
                                size_t weights) {
  PetscFunctionBegin;
  for (double coarser = COARSER; coarser >= 1; coarser /= COARSER) {
    memset(weight, 0, weights * sizeof *weight);
    PetscCall(hr2dpi_agree(p, weigh(p, options, coarser, weight)));
    PetscCallMPI(
        MPI_Allreduce(MPI_IN_PLACE, weight, (int)weights, MPI_DOUBLE, MPI_SUM, p->comm));
    if (!are_few(p, weight, weights)) break;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode share_out_by(hr2dp *p, const hr2d_refine_options *options, double *weight,
                                   size_t weights) {
  PetscFunctionBegin;
  PetscCall(hr2dpi_agree(p, weight ? HR2D_OK : HR2D_ENOMEM));
  PetscCall(weigh_all(p, options, weight, weights));
  if (p->units.cut > 0) {
    hr2dpi_ranges_cut(p, weight, &p->units.links);
    PetscFunctionReturn(0);
  }
  PetscCall(hr2dpi_agree(p, hr2dpi_deal_rows(p, weight)));
  PetscCall(hr2dpi_agree(p, hr2dpi_long_rows_count(p, options)));
  PetscFunctionReturn(0);
}

/* ε = 0 has no coarser pass: shares are equal then. */
static PetscErrorCode share_out(hr2dp *p, const hr2d_refine_options *options) {
  PetscFunctionBegin;
  const uint64_t weights = p->units.cut > 0 ? p->units.count : 2 * p->units.count;
  set_equal_rows(p);
  if (p->ranks == 1 || options->epsilon < 0 || weights > INT_MAX) PetscFunctionReturn(0);
  double *weight = hr2dpi_alloc(p, weights, sizeof *weight);
  const PetscErrorCode failed = share_out_by(p, options, weight, (size_t)weights);
  hr2dpi_free(p, weight);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

/* Refines links of pairs above the cut. */
static hr2d_status refine_above(hr2dp *p, hr2d_refine_options options) {
  hr2d_status status = HR2D_OK;
  options.max_elements = options.max_links = options.max_bytes = 0;
  options.progress = NULL;
  for (int k = 0; k < 2 && p->top && !status; k++) {
    hr2dpi_claim claim = {p, p->units.links.from[p->rank], p->units.links.from[p->rank + 1], 1};
    if (k == 1) claim.from = 0, claim.to = p->units.count;
    options.claim = hr2dpi_claim_pairs;
    options.claim_ctx = &claim;
    if (p->top->links[k]) status = hr2d_refine(p->top->links[k], &options);
  }
  return status;
}

/* Finds the links of which another rank has the same: those above the cut that begin in a unit
   of another rank. */
static hr2d_status find_repeated(hr2dp *p) {
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  const uint64_t links = hr2d_linkset_size(p->links);
  const uint64_t max = p->top ? hr2d_linkset_size(p->top->links[0]) : 0;
  hr2dpi_free(p, p->repeated);
  p->repeats = 0;
  p->repeated = hr2dpi_alloc(p, max, sizeof *p->repeated);
  if (!p->repeated) return HR2D_ENOMEM;
  for (uint64_t k = 0; k < links && max > 0; k++) {
    uint64_t count;
    const uint64_t first =
        hr2dpi_unit_of(p, element, hr2d_linkset_get(p->links, k).pair.first, &count);
    if (count > 1 && first < p->units.links.from[p->rank] && p->repeats < max)
      p->repeated[p->repeats++] = k;
  }
  return HR2D_OK;
}

static hr2d_status refine(hr2dp *p, const hr2d_refine_options *given) {
  hr2d_refine_options options = *given;
  hr2dpi_claim claim = {p, p->units.links.from[p->rank], p->units.links.from[p->rank + 1], 0};
  if (p->units.cut > 0) {
    options.claim = hr2dpi_claim_pairs;
    options.claim_ctx = &claim;
  } else {
    options.rows = p->units.rows;
    if (p->units.cuts > 0) options.claim = hr2dpi_long_rows_claim;
    options.claim_ctx = p;
  }
  hr2d_status status = hr2d_refine(p->links, &options);
  if (status) return hr2dpi_fail(p, status, "%s", hr2d_linkset_message(p->links));
  status = refine_above(p, options);
  return status ? status : find_repeated(p);
}

/* The counts that add up over ranks, and back. */
enum { SUMS = 9 };

static void list_counts(const hr2d_refine_counts *c, uint64_t *list) {
  const uint64_t in_order[SUMS] = {c->links,         c->limited_links,    c->oracle_calls,
                                   c->facing_tests,  c->visibility_tests, c->exchange_areas,
                                   c->partial_links, c->blocked_pairs,    c->dark_pairs};
  memcpy(list, in_order, sizeof in_order);
}

static void read_counts(const uint64_t *list, hr2d_refine_counts *c) {
  c->links = list[0];
  c->limited_links = list[1];
  c->oracle_calls = list[2];
  c->facing_tests = list[3];
  c->visibility_tests = list[4];
  c->exchange_areas = list[5];
  c->partial_links = list[6];
  c->blocked_pairs = list[7];
  c->dark_pairs = list[8];
}

/* The work that several ranks have done alike: that of this rank, and that of one process. */
static void list_repeated(const hr2dp *p, uint64_t list[2 * SUMS]) {
  for (int k = 0; k < 2; k++) {
    hr2d_refine_counts of = p->long_rows[k];
    if (p->top && p->top->links[k]) of = hr2d_linkset_counts(p->top->links[k]);
    list_counts(&of, list + k * SUMS);
  }
}

/* Adds up what ranks have made: all less what several have done alike, and this once. */
static PetscErrorCode count(hr2dp *p) {
  uint64_t own[SUMS], alike[2 * SUMS], max[2];
  hr2dp_counts *c = &p->counts;
  PetscFunctionBegin;
  const hr2d_refine_counts made = hr2d_linkset_counts(p->links);
  list_counts(&made, own);
  list_repeated(p, alike);
  c->own_links = own[0] - p->repeats;
  c->own_tests = own[4];
  max[0] = c->own_links;
  max[1] = c->own_tests;
  uint64_t all[3 * SUMS + 1];
  memcpy(all, own, sizeof own);
  memcpy(all + SUMS, alike, sizeof alike);
  all[3 * SUMS] = c->own_links;
  PetscCall(hr2dpi_add_counts(p, all, 3 * SUMS + 1));
  PetscCall(hr2dpi_max_counts(p, max, 2));
  for (int k = 0; k < SUMS; k++) all[k] += all[2 * SUMS + k] - all[SUMS + k];
  read_counts(all, &c->whole);
  c->repeated_calls = all[SUMS + 2] - all[2 * SUMS + 2];
  c->max_links = max[0];
  c->max_tests = max[1];
  PetscCheck(all[3 * SUMS] == c->whole.links, p->comm, PETSC_ERR_PLIB,
             "ranks have %llu links together and count %llu", (unsigned long long)all[3 * SUMS],
             (unsigned long long)c->whole.links);
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_share_refine(hr2dp *p, const hr2d_refine_options *options) {
  PetscFunctionBegin;
  if (!p->units.placed) PetscCall(share_out(p, options));
  PetscCall(hr2dpi_agree(p, refine(p, options)));
  p->directed = hr2d_linkset_directed(p->links);
  PetscCall(count(p));
  PetscFunctionReturn(0);
}

/* Repeated links are few: they are taken out of what was read. */
static size_t drop_repeated(const hr2dp *p, uint64_t first, hr2d_link *link, size_t count) {
  size_t kept = 0, skip = 0;
  while (skip < p->repeats && p->repeated[skip] < first) skip++;
  if (skip == p->repeats || p->repeated[skip] >= first + count) return count;
  for (size_t k = 0; k < count; k++)
    if (skip < p->repeats && p->repeated[skip] == first + k)
      skip++;
    else
      link[kept++] = link[k];
  return kept;
}

size_t hr2dpi_share_read(const hr2dp *p, uint64_t *next, hr2d_link *link, size_t room) {
  size_t kept = 0;
  while (kept == 0 && *next < hr2d_linkset_size(p->links)) {
    const size_t count = hr2d_linkset_read(p->links, *next, room, link);
    kept = drop_repeated(p, *next, link, count);
    *next += count;
  }
  return kept;
}
