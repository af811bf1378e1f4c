/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The solution object: reading radiosity back. */
#include "alloc.h"
#include "hierarchy-impl.h"
#include "solution-impl.h"

void hr2d_solution_destroy(hr2d_solution *solution) {
  if (!solution) return;
  const hr2d_allocator alloc = solution->alloc;
  hr2di_free(&alloc, solution->value);
  hr2di_free(&alloc, solution->irradiance);
  hr2di_free(&alloc, solution->power);
  hr2di_free(&alloc, solution);
}

double hr2d_solution_element(const hr2d_solution *solution, uint32_t element, size_t band) {
  return solution->value[element * solution->bands + band];
}

double hr2d_solution_average(const hr2d_solution *solution, size_t patch, size_t band) {
  return solution->value[patch * solution->bands + band];
}

/* The leaf of the solution at t; on a border the one before it or behind it. */
static uint32_t leaf_at(const hr2d_solution *solution, size_t patch, double t, int before) {
  const hr2d_element *element = solution->hierarchy->element;
  uint32_t at = (uint32_t)patch;
  while (element[at].child && element[at].child < solution->elements) {
    t *= 2; /* exact, as is the subtraction */
    const int right = before ? t > 1 : t >= 1;
    at = element[at].child + (uint32_t)right;
    t -= right;
  }
  return at;
}

/* On a border the straight line between the values at the leaves' centres. */
static double value_at(const hr2d_solution *solution, const double *value, size_t patch,
                       double t, size_t band) {
  const uint32_t before = leaf_at(solution, patch, t, 1);
  const uint32_t behind = leaf_at(solution, patch, t, 0);
  const double here = value[before * solution->bands + band];
  if (before == behind) return here;
  const hr2d_element *element = solution->hierarchy->element;
  const double part =
      element[before].length / (element[before].length + element[behind].length);
  return here + part * (value[behind * solution->bands + band] - here);
}

double hr2d_solution_at(const hr2d_solution *solution, size_t patch, double t, size_t band) {
  return value_at(solution, solution->value, patch, t, band);
}

double hr2d_solution_irradiance(const hr2d_solution *solution, size_t patch, size_t band) {
  return solution->irradiance[patch * solution->bands + band];
}

double hr2d_solution_irradiance_at(const hr2d_solution *solution, size_t patch, double t,
                                   size_t band) {
  return value_at(solution, solution->irradiance, patch, t, band);
}

double hr2d_solution_net_flux(const hr2d_solution *solution, size_t patch, size_t band) {
  return hr2d_solution_average(solution, patch, band) -
         hr2d_solution_irradiance(solution, patch, band);
}

hr2d_power hr2d_solution_power(const hr2d_solution *solution, size_t band) {
  return solution->power[band];
}

hr2d_solve_work hr2d_solution_work(const hr2d_solution *solution) {
  return solution->work;
}

double hr2d_solution_residual(const hr2d_solution *solution) {
  return solution->residual;
}
