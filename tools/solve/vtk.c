/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The leaves of a run as lines of VTK (.vtp), each with what it has and what its patch has. */
#include "output/vtk.h"

#include <math.h>
#include <stdlib.h>

#include "output/complain.h"
#include "output/output.h"
#include "run/leaves.h"
#include "solve/solve.h"

/* A leaf, and the fraction of its patch in its middle. */
typedef struct leaf {
  uint32_t element;
  double middle;
} leaf;

typedef struct leaves {
  const run *run;
  run_heat heat;
  leaf *at;
  size_t count, room;
  size_t band; /* of the array that is written */
} leaves;

static int add_leaf(void *ctx, const piece *p) {
  leaves *l = ctx;
  if (l->count == l->room) {
    const size_t room = l->room ? 2 * l->room : 1024;
    leaf *larger = realloc(l->at, room * sizeof *larger);
    if (!larger) return complain_memory();
    l->at = larger;
    l->room = room;
  }
  l->at[l->count++] = (leaf){p->element, p->t0 + 0.5 * (p->t1 - p->t0)};
  return 0;
}

static const hr2d_element *element_of(const leaves *l, size_t k) {
  return &hr2d_hierarchy_elements(l->run->hierarchy)[l->at[k].element];
}

/* Two points for each line. */
static double coordinate(const void *ctx, size_t k) {
  const leaves *l = ctx;
  const hr2d_element *e = element_of(l, k / 6);
  const hr2d_point at = k / 3 % 2 ? e->b : e->a;
  const double unit = hr2d_scene_unit(l->run->scene);
  return k % 3 == 0 ? at.x * unit : k % 3 == 1 ? at.y * unit : 0;
}

static double point_number(const void *ctx, size_t k) {
  (void)ctx;
  return (double)k;
}

static double line_end(const void *ctx, size_t k) {
  (void)ctx;
  return 2 * (double)(k + 1);
}

static double patch_of(const void *ctx, size_t k) {
  return element_of(ctx, k)->patch;
}

static double radiosity(const void *ctx, size_t k) {
  const leaves *l = ctx;
  return hr2d_solution_element(l->run->solution, l->at[k].element, l->band);
}

static double irradiance(const void *ctx, size_t k) {
  const leaves *l = ctx;
  return hr2d_solution_element_irradiance(l->run->solution, l->at[k].element, l->band);
}

static double patch_radiosity(const void *ctx, size_t k) {
  const leaves *l = ctx;
  return hr2d_solution_average(l->run->solution, element_of(l, k)->patch, l->band);
}

static double patch_irradiance(const void *ctx, size_t k) {
  const leaves *l = ctx;
  return hr2d_solution_irradiance(l->run->solution, element_of(l, k)->patch, l->band);
}

static double temperature(const void *ctx, size_t k) {
  const leaves *l = ctx;
  return run_heat_at(l->run, element_of(l, k)->patch, l->at[k].middle,
                     hr2d_solution_element_irradiance(l->run->solution, l->at[k].element, 0));
}

static double patch_temperature(const void *ctx, size_t k) {
  const leaves *l = ctx;
  return l->heat.of.kelvin[element_of(l, k)->patch];
}

static void write_bands(leaves *l, FILE *stream, const char *prefix, vtk_item *item) {
  for (l->band = 0; l->band < hr2d_scene_bands(l->run->scene); l->band++) {
    char name[32];
    snprintf(name, sizeof name, "%s%zu", prefix, l->band);
    vtk_array(stream, name, VTK_DOUBLE, l->count, 1, item, l);
  }
}

static int write_file(leaves *l, FILE *stream) {
  const size_t n = l->count;
  vtk_begin(stream, "PolyData");
  fputs("<PolyData>\n", stream);
  const int status = vtk_provenance(stream);
  fprintf(stream,
          "<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"0\" NumberOfLines=\"%zu\" "
          "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<Points>\n",
          2 * n, n);
  vtk_array(stream, "points", VTK_DOUBLE, 2 * n, 3, coordinate, l);
  fputs("</Points>\n<Lines>\n", stream);
  vtk_array(stream, "connectivity", VTK_INTEGER, 2 * n, 1, point_number, l);
  vtk_array(stream, "offsets", VTK_INTEGER, n, 1, line_end, l);
  fputs("</Lines>\n<CellData>\n", stream);
  vtk_array(stream, "patch", VTK_INTEGER, n, 1, patch_of, l);
  write_bands(l, stream, "B", radiosity);
  write_bands(l, stream, "H", irradiance);
  if (l->heat.exists) vtk_array(stream, "T", VTK_DOUBLE, n, 1, temperature, l);
  write_bands(l, stream, "patch_B", patch_radiosity);
  write_bands(l, stream, "patch_H", patch_irradiance);
  if (l->heat.exists) vtk_array(stream, "patch_T", VTK_DOUBLE, n, 1, patch_temperature, l);
  fputs("</CellData>\n", stream);
  vtk_end(stream, "PolyData");
  return status;
}

int solve_write_vtk(const run *r, const char *path) {
  leaves l = {.run = r};
  output out;
  int status = output_open(&out, path);
  if (status) return status;
  status = run_heat_find(r, &l.heat);
  for (size_t k = 0; !status && k < hr2d_scene_patches(r->scene); k++)
    status = leaves_walk(r->hierarchy, k, 0, add_leaf, &l);
  if (!status) status = write_file(&l, out.stream);
  run_heat_release(&l.heat);
  free(l.at);
  return output_close(&out, status);
}
