/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Areas of a patch add up to p->max times its length at most, so that bins add them up
   exactly.  Components of ranks are joined until no rank knows of a link between two of them.
 */
#include "exchange.h"

#include "share.h"

enum { BATCH = 256 };

static uint32_t find(uint32_t *parent, uint32_t k) {
  while (parent[k] != k) k = parent[k] = parent[parent[k]];
  return k;
}

/* The lower number is the component's. */
static int join(uint32_t *parent, uint32_t i, uint32_t j) {
  i = find(parent, i);
  j = find(parent, j);
  if (i == j) return 0;
  if (i < j)
    parent[j] = i;
  else
    parent[i] = j;
  return 1;
}

static void add_area(hr2dpi_exchange *x, const hr2dp *p, hr2dpi_bin *bin, uint32_t patch,
                     double area) {
  hr2dpi_bin_add(&bin[patch], hr2dpi_bin_scale(2 * p->max * x->length[patch]), area);
  x->linked[patch] = 1;
}

static void read_links(hr2dpi_exchange *x, const hr2dp *p, hr2dpi_bin *bin) {
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  const double unit = 1 / hr2d_scene_unit(p->scene);
  hr2d_link link[BATCH];
  uint64_t next = 0;
  size_t count;
  while ((count = hr2dpi_share_read(p, &next, link, BATCH)) > 0)
    for (size_t k = 0; k < count; k++) {
      const uint32_t i = element[hr2dpi_original(p, link[k].pair.first)].patch;
      const uint32_t j = element[hr2dpi_original(p, link[k].pair.second)].patch;
      add_area(x, p, bin, i, link[k].exchange_area * unit);
      if (p->directed)
        x->linked[j] = 1;
      else
        add_area(x, p, bin, j, link[k].exchange_area * unit);
      join(x->component, i, j);
    }
}

static hr2d_status reserve(hr2dpi_exchange *x, const hr2dp *p, hr2dpi_bin **bin,
                           uint32_t **other) {
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  x->length = hr2dpi_alloc(p, p->patches, sizeof *x->length);
  x->defect = hr2dpi_alloc(p, p->patches, sizeof *x->defect);
  x->component = hr2dpi_alloc(p, p->patches, sizeof *x->component);
  x->number = hr2dpi_alloc(p, p->patches, sizeof *x->number);
  x->closed = hr2dpi_alloc(p, p->patches, 1);
  x->linked = hr2dpi_alloc_zero(p, p->patches, 1);
  *bin = hr2dpi_alloc_zero(p, p->patches, sizeof **bin);
  *other = hr2dpi_alloc(p, p->patches, sizeof **other);
  if (!x->length || !x->defect || !x->component || !x->number || !x->closed || !x->linked ||
      !*bin || !*other)
    return HR2D_ENOMEM;
  for (uint32_t k = 0; k < p->patches; k++) {
    x->length[k] = element[k].length;
    x->component[k] = k;
  }
  return HR2D_OK;
}

static PetscErrorCode join_ranks(hr2dpi_exchange *x, hr2dp *p, uint32_t *other) {
  PetscFunctionBegin;
  const int patches = (int)p->patches;
  int joined = p->ranks > 1;
  for (uint32_t k = 0; k < p->patches; k++) x->component[k] = find(x->component, k);
  while (joined) {
    joined = 0;
    PetscCallMPI(MPI_Allreduce(x->component, other, patches, MPI_UINT32_T, MPI_MIN, p->comm));
    for (uint32_t k = 0; k < p->patches; k++) joined |= join(x->component, k, other[k]);
    for (uint32_t k = 0; k < p->patches; k++) x->component[k] = find(x->component, k);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &joined, 1, MPI_INT, MPI_MAX, p->comm));
  }
  PetscFunctionReturn(0);
}

/* The number of a component is lower than those of components with later first patches. */
static void number_components(hr2dpi_exchange *x, const hr2dp *p) {
  for (size_t k = 0; k < p->patches; k++)
    x->number[k] = x->component[k] == k ? (uint32_t)x->count++ : x->number[x->component[k]];
}

static PetscErrorCode add_ranks(hr2dpi_exchange *x, hr2dp *p, hr2dpi_bin *bin) {
  PetscFunctionBegin;
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, bin, (int)(2 * p->patches), MPI_DOUBLE, MPI_SUM, p->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, x->linked, (int)p->patches, MPI_UNSIGNED_CHAR,
                             MPI_MAX, p->comm));
  for (size_t k = 0; k < p->patches; k++) {
    x->defect[k] = (x->length[k] - bin[k].head) - bin[k].tail;
    x->closed[k] = fabs(x->defect[k]) <= HR2DPI_CLOSED * x->length[k];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode find_by(hr2dpi_exchange *x, hr2dp *p, hr2d_status status, hr2dpi_bin *bin,
                              uint32_t *other) {
  PetscFunctionBegin;
  PetscCall(hr2dpi_agree(p, status));
  read_links(x, p, bin);
  PetscCall(add_ranks(x, p, bin));
  PetscCall(join_ranks(x, p, other));
  number_components(x, p);
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_exchange_find(hr2dpi_exchange *x, hr2dp *p) {
  PetscFunctionBegin;
  hr2dpi_bin *bin = NULL;
  uint32_t *other = NULL;
  *x = (hr2dpi_exchange){0};
  const hr2d_status status = reserve(x, p, &bin, &other);
  const PetscErrorCode failed = find_by(x, p, status, bin, other);
  hr2dpi_free(p, bin);
  hr2dpi_free(p, other);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

void hr2dpi_exchange_clear(hr2dpi_exchange *x, const hr2dp *p) {
  hr2dpi_free(p, x->length);
  hr2dpi_free(p, x->defect);
  hr2dpi_free(p, x->component);
  hr2dpi_free(p, x->number);
  hr2dpi_free(p, x->closed);
  hr2dpi_free(p, x->linked);
}

static hr2d_status refuse(hr2dp *p, size_t patch, size_t band) {
  const char *name = hr2d_scene_name(p->scene, patch);
  return hr2dpi_fail(p, HR2D_ENO_SOLUTION,
                     "no solution in band %zu: patch %zu%s%.99s%s emits into a closed part of "
                     "the scene where every reflectance is 1, or where no temperature is given",
                     band, patch, name[0] ? " (\"" : "", name, name[0] ? "\")" : "");
}

/* As in the library's existence.c; sums go in the order of patches. */
static hr2d_status check_band(const hr2dpi_exchange *x, hr2dp *p, size_t band, double *sum,
                              double *loss) {
  const hr2d_scene *scene = p->scene;
  memset(sum, 0, p->patches * sizeof *sum);
  memset(loss, 0, p->patches * sizeof *loss);
  for (size_t k = 0; k < p->patches; k++) {
    const uint32_t c = x->component[k];
    sum[c] += HR2DPI_NO_ESCAPE * x->length[k] - x->defect[k];
    loss[c] += hr2d_scene_reflectance(scene, k, band) < 1;
  }
  for (size_t k = 0; k < p->patches; k++) {
    const uint32_t c = x->component[k];
    const int gets = hr2d_scene_emission(scene, k, band) > 0 ||
                     hr2d_scene_heat(scene, k, NULL) == HR2D_HEAT_FLUX;
    if (gets && loss[c] == 0 && sum[c] >= 0) return refuse(p, k, band);
  }
  return HR2D_OK;
}

hr2d_status hr2dpi_exchange_check(const hr2dpi_exchange *x, hr2dp *p) {
  double *sum = hr2dpi_alloc(p, 2 * p->patches, sizeof *sum);
  hr2d_status status = sum ? HR2D_OK : HR2D_ENOMEM;
  for (size_t band = 0; band < p->bands && !status; band++)
    status = check_band(x, p, band, sum, sum + p->patches);
  hr2dpi_free(p, sum);
  return status;
}
