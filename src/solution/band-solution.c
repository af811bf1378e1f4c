/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solution/band-solution.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"

void hr2di_band_field_take(const hr2d_scene *scene, size_t group, size_t items,
                           const double *field, double *of_group) {
  const size_t bands = hr2di_band_group_size(scene, group);
  for (size_t k = 0; k < items; k++)
    for (size_t b = 0; b < bands; b++)
      of_group[k * bands + b] = field[k * scene->bands + hr2di_band_group_at(scene, group, b)];
}

void hr2di_band_field_give(const hr2d_scene *scene, size_t group, size_t items,
                           const double *of_group, double *field) {
  const size_t bands = hr2di_band_group_size(scene, group);
  for (size_t k = 0; k < items; k++)
    for (size_t b = 0; b < bands; b++)
      field[k * scene->bands + hr2di_band_group_at(scene, group, b)] = of_group[k * bands + b];
}

/* One without values, but with room for them. */
static hr2d_solution *reserve(const hr2d_linkset *links, const hr2d_solution *like,
                              int has_gas) {
  const hr2d_allocator *alloc = &links->alloc;
  hr2d_solution *made = hr2di_alloc_zero(alloc, 1, sizeof *made);
  if (!made) return NULL;
  const size_t bands = links->hierarchy->scene->bands, items = like->elements * like->order;
  made->alloc = *alloc;
  made->links = links;
  made->hierarchy = links->hierarchy;
  made->elements = like->elements;
  made->order = like->order;
  made->bands = bands;
  made->value = hr2di_alloc(alloc, items, bands * sizeof *made->value);
  made->irradiance = hr2di_alloc(alloc, items, bands * sizeof *made->irradiance);
  made->power = hr2di_alloc(alloc, bands, sizeof *made->power);
  const size_t gases = links->hierarchy->scene->gases.count;
  if (has_gas) made->gas = hr2di_alloc_zero(alloc, gases * bands, 2 * sizeof *made->gas);
  if (made->value && made->irradiance && made->power && (!has_gas || made->gas)) return made;
  hr2d_solution_destroy(made);
  return NULL;
}

hr2d_status hr2di_band_solution_take(const hr2d_solution *whole, const hr2d_linkset *links,
                                     size_t group, hr2d_solution **made) {
  *made = NULL;
  if (!whole) return HR2D_OK;
  const hr2d_scene *scene = whole->hierarchy->scene;
  hr2d_solution *s = reserve(links, whole, hr2di_scene_has_gas(links->hierarchy->scene));
  if (!s) return HR2D_ENOMEM;
  const size_t items = whole->elements * whole->order;
  hr2di_band_field_take(scene, group, items, whole->value, s->value);
  hr2di_band_field_take(scene, group, items, whole->irradiance, s->irradiance);
  for (size_t k = 0; k < s->bands; k++) {
    const size_t b = hr2di_band_group_at(scene, group, k);
    s->power[k] = whole->power[b];
    for (size_t g = 0; g < scene->gases.count && s->gas; g++)
      memcpy(hr2di_solution_gas(s, g, k), hr2di_solution_gas(whole, g, b), 2 * sizeof *s->gas);
  }
  s->residual = whole->residual;
  *made = s;
  return HR2D_OK;
}

static void add_work(hr2d_solve_work *to, const hr2d_solve_work *of) {
  to->gathers += of->gathers;
  to->iterations += of->iterations;
  to->row_sums += of->row_sums;
  to->background_rows += of->background_rows;
  to->kernels += of->kernels;
  to->coefficients_seconds += of->coefficients_seconds;
}

static void give(hr2d_solution *to, size_t group, const hr2d_solution *part) {
  const hr2d_scene *scene = to->hierarchy->scene;
  const size_t items = to->elements * to->order;
  hr2di_band_field_give(scene, group, items, part->value, to->value);
  hr2di_band_field_give(scene, group, items, part->irradiance, to->irradiance);
  for (size_t k = 0; k < part->bands; k++) {
    const size_t b = hr2di_band_group_at(scene, group, k);
    to->power[b] = part->power[k];
    for (size_t g = 0; g < scene->gases.count; g++) {
      const double clear[] = {hr2di_scene_gas_emission(scene, g, b), 0};
      memcpy(hr2di_solution_gas(to, g, b), part->gas ? hr2di_solution_gas(part, g, k) : clear,
             sizeof clear);
    }
  }
  add_work(&to->work, &part->work);
  to->residual = fmax(to->residual, part->residual);
}

hr2d_status hr2di_band_solution_join(hr2d_linkset *links, hr2d_solution *const *of_group,
                                     hr2d_solution **made) {
  *made = reserve(links, of_group[0], 1);
  if (!*made) return HR2D_ENOMEM;
  for (size_t g = 0; g < links->groups; g++) give(*made, g, of_group[g]);
  return HR2D_OK;
}
