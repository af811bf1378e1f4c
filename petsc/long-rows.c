/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A long row is cut by the other patches of its pairs.  Patches that are near the long one have
   most of its links, and patches of one figure stand side by side: so each piece gets patches
   from everywhere.  Fractions of multiples of the golden section are as even as can be on any
   run of numbers, and on each second or fourth of them, too.

   The coarse count finds less of long rows than there is.  So there are about as many pieces as
   ranks: where each has one, what is not found is the same on all. */
#include "long-rows.h"

/* A row that takes more than this part of what a rank should have is long; pieces are no
   smaller than half of that. */
#define LONG 0.25

/* 2³² times the golden section. */
#define GOLDEN 2654435769U

static double size_of(const double *part, size_t row) {
  return fmax(part[2 * row], part[2 * row + 1]);
}

static uint32_t pieces_of(const hr2dp *p, double size, double all) {
  const double of_rank = size * p->ranks;
  if (!(of_rank > LONG)) return 1;
  const double pieces = fmin(round(p->ranks * (size / all)), ceil(2 * of_rank / LONG));
  return (uint32_t)fmin(fmax(pieces, 1), p->ranks);
}

hr2d_status hr2dpi_long_rows_cut(hr2dp *p, const double *part) {
  hr2dpi_units *units = &p->units;
  double all = 0;
  for (size_t k = 0; k < p->patches; k++)
    if (size_of(part, k) * p->ranks > LONG) all += size_of(part, k);
  for (size_t k = 0; k < p->patches; k++)
    units->piece[k + 1] = units->piece[k] + pieces_of(p, size_of(part, k), all);
  units->cuts = units->piece[p->patches] - p->patches;
  hr2dpi_free(p, units->owner);
  units->owner = hr2dpi_alloc_zero(p, units->piece[p->patches], sizeof *units->owner);
  return units->owner ? HR2D_OK : HR2D_ENOMEM;
}

hr2d_status hr2dpi_long_rows_claim(void *ctx, const hr2d_batch *batch, unsigned char *claimed) {
  const hr2dp *p = ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const uint32_t row = batch->elements[batch->pairs[k].first].patch;
    const uint32_t other = batch->elements[batch->pairs[k].second].patch;
    const uint64_t place = (uint32_t)(other * GOLDEN);
    const uint64_t piece = (place * hr2dpi_long_rows_pieces(p, row)) >> 32;
    claimed[k] = p->units.owner[p->units.piece[row] + piece] == p->rank;
  }
  return HR2D_OK;
}

static hr2d_status count(hr2dp *p, hr2d_refine_options *options, hr2d_refine_counts *counts) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2d_status status = hr2d_hierarchy_create(p->scene, &hierarchy);
  if (!status)
    status = hr2d_linkset_create(hierarchy, &p->oracle, p->oracle_ctx, &p->policy,
                                 p->policy_ctx, &links);
  if (!status) status = hr2d_refine_count(links, options, counts);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  return status;
}

hr2d_status hr2dpi_long_rows_count(hr2dp *p, const hr2d_refine_options *refine) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  if (p->units.cuts == 0) return HR2D_OK;
  unsigned char *rows = hr2dpi_alloc(p, p->patches, 1);
  if (!rows) return HR2D_ENOMEM;
  for (size_t k = 0; k < p->patches; k++) rows[k] = hr2dpi_long_rows_pieces(p, k) > 1;
  options.max_level = HR2D_NO_SUBDIVISION;
  options.ordered = refine->ordered;
  options.rows = rows;
  hr2d_status status = p->rank == 0 ? count(p, &options, &p->long_rows[1]) : HR2D_OK;
  for (size_t k = 0; k < p->patches; k++) rows[k] &= p->units.rows[k];
  options.claim = hr2dpi_long_rows_claim;
  options.claim_ctx = p;
  if (!status) status = count(p, &options, &p->long_rows[0]);
  hr2dpi_free(p, rows);
  return status;
}
