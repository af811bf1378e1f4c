/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An element belongs to a unit by its start: elements share their ends bit for bit, and
   midpoints lie between ends, so that starts compare exactly along the longer side of a patch.
 */
#include "units.h"

/* Units per rank, and the deepest cut.  With walls in the way a cut patch would be looked from
   by several ranks. */
enum { UNITS_PER_RANK = 64, DEEPEST_CUT = 16 };

static unsigned wanted_cut(const hr2dp *p) {
  unsigned cut = 0;
  if (p->ranks == 1 || hr2d_scene_effect(p->scene, HR2D_EFFECT_OCCLUSION, NULL)) return 0;
  while (cut < DEEPEST_CUT && p->patches << cut < (uint64_t)UNITS_PER_RANK * p->ranks) cut++;
  return cut;
}

/* Divides all patches down to a level, but no images.  HR2D_EINVAL: some patch has no double in
   between. */
static hr2d_status divide_all(const hr2dp *p, unsigned cut, hr2d_hierarchy *grid) {
  const size_t roots = (size_t)hr2d_hierarchy_count(grid).elements;
  size_t from = 0, to = p->patches;
  for (unsigned level = 0; level < cut; level++) {
    for (size_t e = from; e < to; e++) {
      const hr2d_status status = hr2d_hierarchy_divide(grid, (uint32_t)e, 0.5, NULL);
      if (status) return status;
    }
    from = level > 0 ? to : roots;
    to = from + (p->patches << (level + 1));
  }
  return HR2D_OK;
}

static double coordinate(unsigned char along, hr2d_point a) {
  const double x = along & 1 ? a.y : a.x;
  return along & 2 ? -x : x;
}

static unsigned char direction(const hr2d_element *e) {
  const double dx = e->b.x - e->a.x, dy = e->b.y - e->a.y;
  const int y = fabs(dy) > fabs(dx);
  return (unsigned char)(y | ((y ? dy : dx) < 0 ? 2 : 0));
}

static void set_starts(hr2dp *p, const hr2d_hierarchy *grid) {
  const hr2d_element *e = hr2d_hierarchy_elements(grid);
  const size_t elements = (size_t)hr2d_hierarchy_count(grid).elements;
  const size_t first = elements - (size_t)p->units.count; /* of the last level */
  for (size_t k = 0; k < p->patches; k++) p->units.along[k] = direction(&e[k]);
  for (size_t u = 0; u < p->units.count; u++)
    p->units.start[u] = coordinate(p->units.along[e[first + u].patch], e[first + u].a);
}

/* Levels of `grid` follow each other, each in the order of patches and positions. */
static hr2d_status place_starts(hr2dp *p) {
  hr2d_hierarchy *grid = NULL;
  hr2d_status status = hr2d_hierarchy_create(p->scene, &grid);
  if (!status) status = divide_all(p, p->units.cut, grid);
  if (status == HR2D_EINVAL) {
    p->units.cut = 0;
    p->units.count = p->patches;
    status = HR2D_OK;
  } else if (!status) {
    p->units.start = hr2dpi_alloc(p, p->units.count, sizeof *p->units.start);
    p->units.along = hr2dpi_alloc(p, p->patches, 1);
    status = p->units.start && p->units.along ? HR2D_OK : HR2D_ENOMEM;
    if (!status) set_starts(p, grid);
  }
  hr2d_hierarchy_destroy(grid);
  return status;
}

hr2d_status hr2dpi_units_init(hr2dp *p) {
  hr2dpi_units *units = &p->units;
  const size_t ends = (size_t)p->ranks + 1;
  units->cut = wanted_cut(p);
  units->count = (uint64_t)p->patches << units->cut;
  units->links.from = hr2dpi_alloc_zero(p, ends, sizeof *units->links.from);
  units->leaves.from = hr2dpi_alloc_zero(p, ends, sizeof *units->leaves.from);
  if (!units->links.from || !units->leaves.from) return HR2D_ENOMEM;
  const hr2d_status status = units->cut > 0 ? place_starts(p) : HR2D_OK;
  units->rows = hr2dpi_alloc_zero(p, p->patches, 1);
  units->piece = hr2dpi_alloc_zero(p, p->patches + 1, sizeof *units->piece);
  if (!units->rows || !units->piece) return HR2D_ENOMEM;
  for (size_t r = 0; r < ends; r++)
    units->links.from[r] = units->leaves.from[r] = units->count * r / (uint64_t)p->ranks;
  return status;
}

void hr2dpi_units_clear(hr2dp *p) {
  hr2dpi_free(p, p->units.links.from);
  hr2dpi_free(p, p->units.leaves.from);
  hr2dpi_free(p, p->units.start);
  hr2dpi_free(p, p->units.along);
  hr2dpi_free(p, p->units.rows);
  hr2dpi_free(p, p->units.piece);
  hr2dpi_free(p, p->units.owner);
}

void hr2dpi_ranges_cut(const hr2dp *p, const double *weight, hr2dpi_ranges *ranges) {
  double all = 0, sum = 0;
  int rank = 1;
  for (uint64_t u = 0; u < p->units.count; u++) all += weight[u];
  for (uint64_t u = 0; u < p->units.count; u++) {
    /* A unit belongs to the rank in whose part its middle lies. */
    while (rank < p->ranks && sum + weight[u] / 2 >= all * rank / p->ranks)
      ranges->from[rank++] = u;
    sum += weight[u];
  }
  while (rank < p->ranks) ranges->from[rank++] = p->units.count;
  ranges->from[0] = 0;
  ranges->from[p->ranks] = p->units.count;
}

int hr2dpi_ranges_owner(const hr2dp *p, const hr2dpi_ranges *ranges, uint64_t unit) {
  int low = 0, high = p->ranks;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    if (ranges->from[middle] <= unit)
      low = middle;
    else
      high = middle;
  }
  return low;
}

uint64_t hr2dpi_unit_of(const hr2dp *p, const hr2d_element *elements, uint32_t element,
                        uint64_t *count) {
  const hr2d_element *e = &elements[element];
  const hr2dpi_units *units = &p->units;
  uint64_t low = (uint64_t)e->patch << units->cut;
  *count = 1;
  if (units->cut == 0) return low;
  const int level = ilogb(elements[e->patch].length / e->length);
  const double start = coordinate(units->along[e->patch], e->a);
  if (level < (int)units->cut) *count = (uint64_t)1 << (units->cut - (unsigned)level);
  for (uint64_t step = (uint64_t)1 << (units->cut - 1); step > 0; step /= 2)
    if (units->start[low + step] <= start) low += step;
  return low;
}

hr2d_status hr2dpi_claim_pairs(void *ctx, const hr2d_batch *batch, unsigned char *claimed) {
  const hr2dpi_claim *claim = ctx;
  for (size_t k = 0; k < batch->count; k++) {
    uint64_t count;
    const uint64_t first =
        hr2dpi_unit_of(claim->p, batch->elements, batch->pairs[k].first, &count);
    claimed[k] = claim->from < claim->to && first < claim->to && first + count > claim->from &&
                 (count > 1 || !claim->above);
  }
  return HR2D_OK;
}
