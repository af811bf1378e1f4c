/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The solution object: reading radiosity back. */
#include "alloc.h"
#include "hierarchy-impl.h"
#include "solution-impl.h"

void hr2d_solution_destroy(hr2d_solution *solution) {
  if (!solution) return;
  const hr2d_allocator alloc = solution->alloc;
  hr2di_free(&alloc, solution->value);
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

double hr2d_solution_at(const hr2d_solution *solution, size_t patch, double t, size_t band) {
  const uint32_t before = leaf_at(solution, patch, t, 1);
  const uint32_t behind = leaf_at(solution, patch, t, 0);
  return 0.5 * (hr2d_solution_element(solution, before, band) +
                hr2d_solution_element(solution, behind, band));
}

hr2d_power hr2d_solution_power(const hr2d_solution *solution, size_t band) {
  return solution->power[band];
}

uint64_t hr2d_solution_sweeps(const hr2d_solution *solution) {
  return solution->sweeps;
}

double hr2d_solution_residual(const hr2d_solution *solution) {
  return solution->residual;
}
