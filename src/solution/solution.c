/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The solution object: reading radiosity back. */
#include <math.h>

#include "base/alloc.h"
#include "base/legendre.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/frozen-temperatures.h"
#include "scene/panes.h"
#include "solution/solution-impl.h"

void hr2d_solution_destroy(hr2d_solution *solution) {
  if (!solution) return;
  const hr2d_allocator alloc = solution->alloc;
  hr2di_alloc_free(&alloc, solution->value);
  hr2di_alloc_free(&alloc, solution->irradiance);
  hr2di_alloc_free(&alloc, solution->power);
  hr2di_alloc_free(&alloc, solution->power_cut_off);
  hr2di_alloc_free(&alloc, solution->gas);
  hr2d_linkset_destroy(solution->own_links);
  hr2d_hierarchy_destroy(solution->own_hierarchy);
  hr2di_relit_destroy(solution->own_scene);
  if (solution->release) solution->release(solution->kept);
  hr2di_alloc_free(&alloc, solution);
}

static double average(const hr2d_solution *s, const double *value, size_t element,
                      size_t band) {
  return value[element * s->order * s->bands + band];
}

/* Light is never negative. In the dark, roundings of others' light may be, and polynomials
   beside a shadow: what is read is 0 there, and fields keep the balance of power. */
static double light(double value) {
  return fmax(value, 0);
}

const double *hr2d_solution_field(const hr2d_solution *solution) {
  if (!solution) return NULL;
  return solution->value;
}

size_t hr2d_solution_field_size(const hr2d_solution *solution) {
  if (!solution) return 0;
  return solution->elements * solution->order * solution->bands;
}

double hr2d_solution_element(const hr2d_solution *solution, uint32_t element, size_t band) {
  if (!solution || element >= solution->elements || band >= solution->bands) return NAN;
  return light(average(solution, solution->value, element, band));
}

double hr2d_solution_element_irradiance(const hr2d_solution *solution, uint32_t element,
                                        size_t band) {
  if (!solution || element >= solution->elements || band >= solution->bands) return NAN;
  return light(average(solution, solution->irradiance, element, band));
}

double hr2d_solution_average(const hr2d_solution *solution, size_t patch, size_t band) {
  if (!hr2di_solution_has(solution, patch, band)) return NAN;
  return light(average(solution, solution->value, patch, band));
}

/* The leaf of the solution at fraction *t of a patch; sets *t to the fraction of that leaf.  On
   a border of two leaves it is the one before it if `before` is set, else the one behind. */
static uint32_t leaf_at(const hr2d_solution *solution, size_t patch, double *t, int before) {
  const hr2d_element *element = solution->hierarchy->element;
  uint32_t at = (uint32_t)patch;
  while (element[at].child && element[at].child < solution->elements)
    at = hr2di_element_child_at(element, at, t, before);
  return at;
}

static double leaf_value(const hr2d_solution *s, const double *value, uint32_t leaf, double t,
                         size_t band) {
  hr2di_basis basis;
  if (s->order == 1) return average(s, value, leaf, band);
  hr2di_basis_init(&basis, s->order);
  return hr2di_basis_sum(&basis, 2 * t - 1, value + leaf * s->order * s->bands + band,
                         s->bands);
}

/* The value at fraction t of a patch.  On the border of two leaves: at order 1 the straight
   line between the values at their centres, at an order above 1 the mean of their values. */
static double value_at(const hr2d_solution *s, const double *value, size_t patch, double t,
                       size_t band) {
  double t_before = t, t_behind = t;
  const uint32_t before = leaf_at(s, patch, &t_before, 1);
  const uint32_t behind = leaf_at(s, patch, &t_behind, 0);
  const double here = leaf_value(s, value, before, t_before, band);
  if (before == behind) return here;
  const double there = leaf_value(s, value, behind, t_behind, band);
  if (s->order > 1) return 0.5 * (here + there);
  const hr2d_element *element = s->hierarchy->element;
  const double part =
      element[before].length / (element[before].length + element[behind].length);
  return here + part * (there - here);
}

/* The youngest ancestor that the solution has carries a polynomial.  Its values at the points
   of a rule give the coefficients on the leaf. */
static void restrict_to(const hr2d_solution *from, const hr2d_hierarchy *h, uint32_t leaf,
                        const hr2di_rule *rule, const hr2di_basis *to, double *field) {
  double start = 0, size = 1, phi[HR2D_MAX_ORDER];
  uint32_t e = leaf;
  while (e >= from->elements) {
    const uint32_t parent = h->parent[e];
    const double left = hr2di_element_left_part(h->element, parent);
    const int right = e != h->element[parent].child;
    const double part = right ? 1 - left : left;
    start = (right ? left : 0) + part * start;
    size *= part;
    e = parent;
  }
  for (size_t q = 0; q < rule->points; q++) {
    const double t = start + size * (0.5 + 0.5 * rule->at[q]);
    hr2di_basis_at(to, rule->at[q], phi);
    for (size_t b = 0; b < from->bands; b++) {
      const double value = rule->weight[q] * leaf_value(from, from->value, e, t, b);
      for (size_t l = 0; l < to->order; l++) field[l * from->bands + b] += value * phi[l];
    }
  }
}

/* Legendre coefficients are nested: on leaves that the solution has, they are copied. */
hr2d_status hr2di_solution_restrict(const hr2d_solution *from, const hr2d_hierarchy *hierarchy,
                                    const uint32_t *leaf, size_t count, size_t order,
                                    double *field, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  const size_t bands = from->bands, width = order * bands, known = from->order * bands;
  hr2di_rule rule;
  hr2di_basis basis;
  hr2di_rule_init(&rule, order > from->order ? order : from->order);
  hr2di_basis_init(&basis, order);
  for (size_t k = 0; k < count && !status; k++) {
    const int copied = leaf[k] < from->elements;
    status = hr2di_watch_work(watch, 1 + width / 32 + (copied ? 0 : 5 * rule.points * bands));
    double *to = field + k * width;
    for (size_t m = 0; m < width; m++)
      to[m] = leaf[k] < from->elements && m < known ? from->value[leaf[k] * known + m] : 0;
    if (!copied) restrict_to(from, hierarchy, leaf[k], &rule, &basis, to);
  }
  return status;
}

double hr2d_solution_at(const hr2d_solution *solution, size_t patch, double t, size_t band) {
  if (!hr2di_solution_has(solution, patch, band)) return NAN;
  return light(value_at(solution, solution->value, patch, t, band));
}

double hr2d_solution_irradiance(const hr2d_solution *solution, size_t patch, size_t band) {
  if (!hr2di_solution_has(solution, patch, band)) return NAN;
  return light(average(solution, solution->irradiance, patch, band));
}

double hr2d_solution_irradiance_at(const hr2d_solution *solution, size_t patch, double t,
                                   size_t band) {
  if (!hr2di_solution_has(solution, patch, band)) return NAN;
  return light(value_at(solution, solution->irradiance, patch, t, band));
}

double hr2d_solution_net_flux(const hr2d_solution *solution, size_t patch, size_t band) {
  if (!hr2di_solution_has(solution, patch, band)) return NAN;
  /* B − H = E − (1−ρ)H, without the loss of the digits that B and H have in common. */
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  const double own = hr2d_scene_emission(scene, patch, band) -
                     (1 - hr2d_scene_reflectance(scene, patch, band)) *
                         hr2d_solution_irradiance(solution, patch, band);
  if (!hr2di_pane_is(scene, patch)) return own;
  return own +
         hr2d_scene_transmittance(scene, patch, band) *
             hr2d_solution_irradiance(solution, hr2di_scene_other_side(scene, patch), band);
}

double hr2d_solution_net_power(const hr2d_solution *solution, size_t patch, size_t band) {
  if (!hr2di_solution_has(solution, patch, band)) return NAN;
  return hr2d_scene_length(hr2di_solution_scene(solution), patch) *
         hr2d_solution_net_flux(solution, patch, band);
}

double hr2d_solution_power_cut_off(const hr2d_solution *solution, size_t band) {
  if (!solution || band >= solution->bands) return NAN;
  if (solution->power_cut_off) return solution->power_cut_off[band];
  return hr2di_symmetry_cuts(&solution->hierarchy->scene->symmetry) ? HUGE_VAL : 0;
}

hr2d_power hr2d_solution_power(const hr2d_solution *solution, size_t band) {
  if (!solution || band >= solution->bands) return (hr2d_power){NAN, NAN, NAN, NAN};
  return solution->power[band];
}

double hr2di_solution_hottest(const hr2d_solution *s, size_t band) {
  double most = 0;
  for (size_t k = 0; k < s->hierarchy->scene->gases.count && s->gas; k++)
    most = fmax(most, fabs(*hr2di_solution_gas(s, k, band)));
  return most;
}

hr2d_status hr2d_solution_gas(const hr2d_solution *solution, size_t gas, size_t band,
                              double *emission, double *heat) {
  if (!solution || band >= solution->bands) return HR2D_EINVAL;
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  if (gas >= hr2d_scene_gases(scene)) return HR2D_EINVAL;
  const double *of = solution->gas ? hr2di_solution_gas(solution, gas, band) : NULL;
  if (emission) *emission = of ? of[0] : 0;
  if (heat) *heat = of ? of[1] : 0;
  return HR2D_OK;
}

hr2d_solve_work hr2d_solution_work(const hr2d_solution *solution) {
  if (!solution) return (hr2d_solve_work){0};
  return solution->work;
}

const hr2d_linkset *hr2d_solution_links(const hr2d_solution *solution) {
  if (!solution) return NULL;
  return solution->links;
}

double hr2d_solution_residual(const hr2d_solution *solution) {
  if (!solution) return NAN;
  return solution->residual;
}
