/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep: pull in own units, send the halo, pull above the cut, gather over own links, send
   the halo back, add up above the cut, push.

   All but the gather is done once for each element, from its children or its parent, so that no
   sum of it depends on the ranks; sums of the gather are kept in bins.  An element of length A
   receives at most A·max|up|, as its links have at most its row; times p->max, where images
   stand for others. */
#include "transport.h"

#include "share.h"

hr2d_status hr2dpi_transport_init(hr2dpi_transport *t, hr2dp *p) {
  const size_t elements = p->trees.elements;
  *t = (hr2dpi_transport){.p = p};
  t->up = hr2dpi_alloc_zero(p, elements, p->bands * sizeof *t->up);
  t->bin = hr2dpi_alloc_zero(p, elements, p->bands * sizeof *t->bin);
  t->scale = hr2dpi_alloc(p, elements, sizeof *t->scale);
  t->above = hr2dpi_alloc(p, p->trees.tops, p->bands * sizeof *t->above);
  if (!t->up || !t->bin || !t->scale || !t->above) return HR2D_ENOMEM;
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  for (uint32_t e = 0; e < elements; e++)
    t->scale[e] = hr2dpi_bin_scale(p->max * element[hr2dpi_original(p, e)].length);
  return HR2D_OK;
}

hr2d_status hr2dpi_transport_join(hr2dpi_transport *t, const uint32_t *component,
                                  size_t count) {
  t->component = component;
  t->components = count;
  t->size = hr2dpi_alloc(t->p, count, sizeof *t->size);
  t->sigma = hr2dpi_alloc(t->p, t->p->trees.elements, sizeof *t->sigma);
  return t->size && t->sigma ? HR2D_OK : HR2D_ENOMEM;
}

void hr2dpi_transport_clear(hr2dpi_transport *t) {
  const hr2dp *p = t->p;
  if (!p) return;
  hr2dpi_free(p, t->up);
  hr2dpi_free(p, t->bin);
  hr2dpi_free(p, t->scale);
  hr2dpi_free(p, t->sigma);
  hr2dpi_free(p, t->size);
  hr2dpi_free(p, t->above);
  if (t->send != t->receive) hr2dpi_free(p, t->send);
  hr2dpi_free(p, t->receive);
  hr2dpi_free(p, t->closure);
  hr2dpi_free(p, t->sky);
  hr2dpi_free(p, t->mean);
}

/* Pulls one element with children. */
static inline void pull_one(const hr2dpi_transport *t, const hr2d_element *element,
                            const double *spread, uint32_t e) {
  const uint32_t c = element[e].child;
  const size_t bands = t->p->bands;
  const double l = spread ? spread[c] : 1, r = spread ? spread[c + 1] : 1;
  const double *left = t->up + c * bands, *right = left + bands;
  for (size_t b = 0; b < bands; b++) t->up[e * bands + b] = 0.5 * (l * left[b] + r * right[b]);
}

/* Images have the radiosity of their patches. */
static void spread_images(const hr2dpi_transport *t) {
  const hr2dp *p = t->p;
  const size_t bytes = p->bands * sizeof *t->up;
  for (size_t e = p->patches; p->trees.original && e < p->trees.elements; e++)
    if (p->trees.original[e] != e)
      memcpy(t->up + e * p->bands, t->up + p->trees.original[e] * p->bands, bytes);
}

/* Patches receive what their images do. */
static void fold_images(const hr2dpi_transport *t) {
  const hr2dp *p = t->p;
  for (size_t e = p->patches; p->trees.original && e < p->trees.elements; e++) {
    const hr2dpi_bin *from = t->bin + e * p->bands;
    hr2dpi_bin *to = t->bin + p->trees.original[e] * p->bands;
    for (size_t b = 0; b < p->bands && to != from; b++) {
      to[b].head += from[b].head;
      to[b].tail += from[b].tail;
    }
  }
}

/* Sets `up` of own elements, of the halo and above the cut, and of images. */
static PetscErrorCode pull(hr2dpi_transport *t, const double *spread, const double *field) {
  PetscFunctionBegin;
  const hr2dpi_trees *trees = &t->p->trees;
  const hr2d_element *element = hr2d_hierarchy_elements(t->p->hierarchy);
  const size_t bands = t->p->bands;
  for (size_t k = 0; k < trees->leaves; k++)
    memcpy(t->up + trees->leaf[k] * bands, field + k * bands, bands * sizeof *t->up);
  for (size_t k = trees->owned; k-- > 0;)
    if (element[trees->own[k]].child) pull_one(t, element, spread, trees->own[k]);
  PetscCall(PetscSFBcastBegin(trees->halo, trees->unit[0], t->up, t->up, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(trees->halo, trees->unit[0], t->up, t->up, MPI_REPLACE));
  for (size_t k = trees->tops; k-- > 0;) pull_one(t, element, spread, trees->top[k]);
  spread_images(t);
  PetscFunctionReturn(0);
}

static void find_largest(hr2dpi_transport *t, const uint32_t *list, size_t count) {
  const hr2d_element *element = hr2d_hierarchy_elements(t->p->hierarchy);
  const size_t bands = t->p->bands;
  for (size_t k = 0; k < count; k++) {
    double *size = &t->size[t->component[element[list[k]].patch]];
    for (size_t b = 0; b < bands; b++) *size = fmax(*size, fabs(t->up[list[k] * bands + b]));
  }
}

/* Sets σ of all elements.  A component has its own bound, so that a dark one has all digits: a
   power of two above every |up|, twice as large as need be for the roundings of areas. */
static PetscErrorCode set_sigma(hr2dpi_transport *t) {
  PetscFunctionBegin;
  const hr2dpi_trees *trees = &t->p->trees;
  const hr2d_element *element = hr2d_hierarchy_elements(t->p->hierarchy);
  for (size_t c = 0; c < t->components; c++) t->size[c] = 0;
  find_largest(t, trees->own, trees->owned);
  find_largest(t, trees->top, trees->tops);
  PetscCall(hr2dpi_max_doubles(t->p, t->size, (int)t->components));
  for (size_t c = 0; c < t->components; c++) {
    int exponent;
    (void)frexp(t->size[c], &exponent);
    t->size[c] = t->size[c] > 0 ? ldexp(1, exponent + 1) : 1;
  }
  for (uint32_t e = 0; e < trees->elements; e++) {
    const uint32_t patch = element[hr2dpi_original(t->p, e)].patch;
    const double size = patch < t->p->patches ? t->size[t->component[patch]] : 0;
    t->sigma[e] = fmax(t->scale[e] * size, HR2DPI_LEAST_SCALE);
  }
  PetscFunctionReturn(0);
}

enum { BATCH = 256 };

/* Adds what `to` receives from `from`. */
static inline void add(hr2dpi_transport *t, uint32_t to, uint32_t from, double area) {
  const size_t bands = t->p->bands;
  const double scale = t->sigma[to];
  for (size_t b = 0; b < bands; b++)
    hr2dpi_bin_add(&t->bin[to * bands + b], scale, area * t->up[from * bands + b]);
}

static void add_links(hr2dpi_transport *t, const hr2d_link *link, size_t count, int sends) {
  const hr2dp *p = t->p;
  const double unit = 1 / hr2d_scene_unit(p->scene); /* a power of two */
  for (size_t k = 0; k < count; k++) {
    const hr2d_pair pair = link[k].pair;
    const double area = link[k].exchange_area * unit;
    if (!p->directed || !sends) add(t, pair.first, pair.second, area);
    if (!p->directed || sends) add(t, pair.second, pair.first, area);
  }
}

/* The same for one band and both ways.  The compiler keeps bins of one link in registers; terms
   may be added in any order. */
static void add_both_ways(hr2dpi_transport *t, const hr2d_link *link, size_t count) {
  const double unit = 1 / hr2d_scene_unit(t->p->scene);
  const double *restrict up = t->up, *restrict sigma = t->sigma;
  hr2dpi_bin *restrict bin = t->bin;
  for (size_t k = 0; k < count; k++) {
    const uint32_t i = link[k].pair.first, j = link[k].pair.second;
    const double area = link[k].exchange_area * unit;
    hr2dpi_bin to_i = bin[i], to_j = bin[j];
    hr2dpi_bin_add(&to_i, sigma[i], area * up[j]);
    hr2dpi_bin_add(&to_j, sigma[j], area * up[i]);
    bin[i] = to_i;
    bin[j] = to_j;
  }
}

/* Gathers over own links; with `sends`, the other way over directed links. */
static void gather_links(hr2dpi_transport *t, int sends) {
  const hr2dp *p = t->p;
  hr2d_link link[BATCH];
  uint64_t next = 0;
  size_t count;
  memset(t->bin, 0, p->trees.elements * p->bands * sizeof *t->bin);
  while ((count = hr2dpi_share_read(p, &next, link, BATCH)) > 0)
    if (p->bands == 1 && !p->directed)
      add_both_ways(t, link, count);
    else
      add_links(t, link, count, sends);
}

/* Adds up bins of elements above the cut. */
static PetscErrorCode add_top(hr2dpi_transport *t) {
  PetscFunctionBegin;
  const hr2dp *p = t->p;
  const size_t bands = p->bands, count = p->trees.tops;
  for (size_t k = 0; k < count; k++)
    memcpy(t->above + k * bands, t->bin + p->trees.top[k] * bands, bands * sizeof *t->above);
  if (count > 0)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, t->above, (int)(2 * count * bands), MPI_DOUBLE,
                               MPI_SUM, p->comm));
  for (size_t k = 0; k < count; k++)
    memcpy(t->bin + p->trees.top[k] * bands, t->above + k * bands, bands * sizeof *t->above);
  PetscFunctionReturn(0);
}

static void divide(hr2dpi_transport *t, const uint32_t *list, size_t count) {
  const hr2d_element *element = hr2d_hierarchy_elements(t->p->hierarchy);
  const size_t bands = t->p->bands;
  for (size_t k = 0; k < count; k++) {
    const size_t e = list[k];
    for (size_t b = 0; b < bands; b++)
      t->up[e * bands + b] = hr2dpi_bin_total(t->bin[e * bands + b]) / element[e].length;
  }
}

/* Turns `up` from radiosity into the irradiance over the links of each own element, and of
   those above the cut. */
static PetscErrorCode gather(hr2dpi_transport *t, int sends) {
  PetscFunctionBegin;
  hr2dpi_trees *trees = &t->p->trees;
  PetscCall(set_sigma(t));
  gather_links(t, sends);
  fold_images(t);
  PetscCall(PetscSFReduceBegin(trees->halo, trees->unit[1], t->bin, t->bin, MPI_SUM));
  PetscCall(PetscSFReduceEnd(trees->halo, trees->unit[1], t->bin, t->bin, MPI_SUM));
  PetscCall(add_top(t));
  divide(t, trees->own, trees->owned);
  divide(t, trees->top, trees->tops);
  t->sweeps++;
  PetscFunctionReturn(0);
}

/* Adds to both children what their parent has. */
static void push_one(hr2dpi_transport *t, const hr2d_element *element, uint32_t e) {
  const uint32_t c = element[e].child;
  const size_t bands = t->p->bands;
  const double *from = t->up + e * bands;
  for (uint32_t side = c; c && side < c + 2; side++) {
    const double part = t->receive ? t->receive[side] : 1;
    for (size_t b = 0; b < bands; b++) t->up[side * bands + b] += part * from[b];
  }
}

static void push(hr2dpi_transport *t, double *field) {
  const hr2dpi_trees *trees = &t->p->trees;
  const hr2d_element *element = hr2d_hierarchy_elements(t->p->hierarchy);
  const size_t bands = t->p->bands;
  for (size_t k = 0; k < trees->tops; k++) push_one(t, element, trees->top[k]);
  for (size_t k = 0; k < trees->owned; k++) push_one(t, element, trees->own[k]);
  for (size_t k = 0; k < trees->leaves; k++)
    memcpy(field + k * bands, t->up + trees->leaf[k] * bands, bands * sizeof *field);
}

PetscErrorCode hr2dpi_transport_apply(hr2dpi_transport *t, const double *radiosity,
                                      double *irradiance) {
  PetscFunctionBegin;
  const size_t bands = t->p->bands, field = t->p->trees.leaves * bands;
  PetscCall(pull(t, t->send, radiosity));
  PetscCall(gather(t, 0));
  push(t, irradiance);
  for (size_t k = 0; k < field && t->closure; k++)
    irradiance[k] += t->closure[k / bands] * radiosity[k];
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_transport_link_rows(hr2dpi_transport *t, int sends, double *factor) {
  PetscFunctionBegin;
  const size_t bands = t->p->bands;
  for (size_t k = 0; k < t->p->trees.elements * bands; k++) t->up[k] = 1;
  PetscCall(gather(t, sends));
  for (size_t e = 0; e < t->p->trees.elements; e++) factor[e] = t->up[e * bands];
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_transport_average(hr2dpi_transport *t, const double *field) {
  PetscFunctionBegin;
  PetscCall(pull(t, NULL, field));
  PetscFunctionReturn(0);
}

int hr2dpi_transport_has_root(const hr2dpi_transport *t, size_t patch) {
  const hr2dp *p = t->p;
  const uint64_t unit = (uint64_t)patch << p->units.cut;
  return unit >= p->units.leaves.from[p->rank] && unit < p->units.leaves.from[p->rank + 1];
}

PetscErrorCode hr2dpi_transport_patch_averages(hr2dpi_transport *t, const double *field,
                                               double *average) {
  PetscFunctionBegin;
  hr2dp *p = t->p;
  PetscCall(hr2dpi_transport_average(t, field));
  for (size_t k = 0; k < p->patches * p->bands; k++)
    average[k] = hr2dpi_transport_has_root(t, k / p->bands) ? t->up[k] : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, average, (int)(p->patches * p->bands), MPI_DOUBLE,
                             MPI_SUM, p->comm));
  PetscFunctionReturn(0);
}

static inline void mean_of(const hr2d_element *element, uint32_t e, double *value) {
  const uint32_t c = element[e].child;
  if (c) value[e] = value[c + 1] + 0.5 * (value[c] - value[c + 1]);
}

PetscErrorCode hr2dpi_transport_means(hr2dpi_transport *t, double *value) {
  PetscFunctionBegin;
  const hr2dpi_trees *trees = &t->p->trees;
  const hr2d_element *element = hr2d_hierarchy_elements(t->p->hierarchy);
  for (size_t k = trees->owned; k-- > 0;) mean_of(element, trees->own[k], value);
  PetscCall(PetscSFBcastBegin(trees->halo, MPI_DOUBLE, value, value, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(trees->halo, MPI_DOUBLE, value, value, MPI_REPLACE));
  for (size_t k = trees->tops; k-- > 0;) mean_of(element, trees->top[k], value);
  PetscFunctionReturn(0);
}
