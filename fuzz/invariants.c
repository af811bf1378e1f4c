/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The invariants of every scene, link set and solution. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

/* Of sums over rows; a single exchange area is better by far. */
#define ROW_BOUND 1e-12

/* The solver stops at a residual that is small beside all light there is. */
#define DARK 1e-12

/* Above this reflectance a solution that is not balanced loses digits. */
#define NEARLY_WHITE 0.999

static int is_continuation(unsigned char byte) {
  return (byte & 0xC0) == 0x80;
}

/* Table 3-7 of Unicode: no longer forms than needed, no surrogates, nothing above U+10FFFF. */
int fuzz_is_utf8(const char *text) {
  for (const unsigned char *s = (const unsigned char *)text; *s;) {
    const unsigned first = *s++;
    const int more = first < 0x80    ? 0
                     : first > 0xF4  ? -1
                     : first >= 0xF0 ? 3
                     : first >= 0xE0 ? 2
                     : first >= 0xC2 ? 1
                                     : -1;
    if (more < 0 || (first == 0xE0 && *s < 0xA0) || (first == 0xED && *s > 0x9F) ||
        (first == 0xF0 && *s < 0x90) || (first == 0xF4 && *s > 0x8F))
      return 0;
    for (int k = 0; k < more; k++)
      if (!is_continuation(*s++)) return 0;
  }
  return 1;
}

void fuzz_check_message(const char *message) {
  REQUIRE(message && *message);
  REQUIRE_SAYING(fuzz_is_utf8(message), message);
  for (const unsigned char *s = (const unsigned char *)message; *s; s++)
    REQUIRE_SAYING(*s >= 0x20 || *s == '\t', message);
}

/* Patches, then their images. */
static size_t count_all(const hr2d_scene *scene) {
  return hr2d_scene_patches(scene) * hr2d_scene_images(scene);
}

static hr2d_segment any_segment(const hr2d_scene *scene, size_t k) {
  const size_t n = hr2d_scene_patches(scene);
  return k < n ? hr2d_scene_segment(scene, k) : hr2d_scene_image(scene, k % n, k / n);
}

/* By how much a coordinate may be off where it is rounded, as midpoints of elements are. */
static double grain(const hr2d_scene *scene) {
  double largest = 0;
  for (size_t k = 0; k < count_all(scene); k++) {
    const hr2d_segment s = any_segment(scene, k);
    largest =
        fmax(largest, fmax(fmax(fabs(s.a.x), fabs(s.a.y)), fmax(fabs(s.b.x), fabs(s.b.y))));
  }
  return fmax(largest * 0x1p-53, 0x1p-1074);
}

static double distance(hr2d_point p, hr2d_segment s) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y, length = hypot(dx, dy);
  return fabs(dx / length * (p.y - s.a.y) - dy / length * (p.x - s.a.x));
}

/* Two patches with no more than some roundings between them.  Commit refuses those within
   four; from there to twice that a wall between may count as part of one of them. */
static int has_sliver(const hr2d_scene *scene) {
  const size_t n = hr2d_scene_patches(scene), all = count_all(scene);
  const double near = 32 * grain(scene);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < all; j++) {
      const hr2d_segment s = any_segment(scene, i), t = any_segment(scene, j);
      const int on_line = !hr2d_orientation(s.a, s.b, t.a) && !hr2d_orientation(s.a, s.b, t.b);
      if (i != j && !on_line && distance(t.a, s) <= near && distance(t.b, s) <= near) return 1;
    }
  return 0;
}

/* An end that is off by δ changes an exchange area by δ at most, and so the sum of `terms` of
   them by as much for each of their four ends. */
static void check_row(const hr2d_scene *scene, size_t patch, double sum, double terms) {
  const double length = hr2d_scene_length(scene, patch);
  const double max = length * (1 + ROW_BOUND) + 4 * terms * grain(scene);
  if (sum <= max || has_sliver(scene)) return;
  char text[100];
  snprintf(text, sizeof text, "patch %zu: %.17g above %.17g", patch, sum, length);
  fuzz_fail(__FILE__, __LINE__, "sum of row <= length", text);
}

void fuzz_check_matrix(const hr2d_scene *scene, hr2d_status status, const double *area) {
  const size_t n = hr2d_scene_patches(scene);
  const int cut = hr2d_scene_cut_off(scene) > 0; /* known to what is extrapolated */
  if (status) {
    REQUIRE(status == HR2D_ENOMEM);
    return;
  }
  for (size_t i = 0; i < n; i++) {
    double sum = 0;
    for (size_t j = 0; j < n; j++) {
      const double one = area[i * n + j], other = area[j * n + i];
      REQUIRE(isfinite(one) && (cut || one >= 0));
      REQUIRE(memcmp(&one, &other, sizeof one) == 0);
      sum += one;
    }
    REQUIRE(area[i * n + i] == 0 || hr2d_scene_images(scene) > 1);
    if (!cut) check_row(scene, i, sum, 2 * (double)count_all(scene));
  }
}

void fuzz_check_hierarchy(const hr2d_hierarchy *hierarchy) {
  const hr2d_hierarchy_counts counts = hr2d_hierarchy_count(hierarchy);
  const hr2d_scene *scene = hr2d_hierarchy_scene(hierarchy);
  const hr2d_element *e = hr2d_hierarchy_elements(hierarchy);
  size_t roots = count_all(scene);
  /* The ends of a period are behind the images. */
  while (hr2d_scene_images(scene) > 1 && roots < counts.elements &&
         hr2d_element_level(hierarchy, (uint32_t)roots) == 0)
    roots++;
  uint64_t split = 0;
  unsigned levels = 0;
  for (uint32_t k = 0; k < counts.elements; k++) {
    const unsigned level = hr2d_element_level(hierarchy, k);
    if (level > levels) levels = level;
    REQUIRE((level == 0) == (k < roots) && (level > 0 || e[k].patch == k));
    if (!e[k].child) continue;
    split++;
    REQUIRE(e[k].child > k && e[k].child + 1 < counts.elements);
    const hr2d_element *left = &e[e[k].child], *right = left + 1;
    REQUIRE(hr2d_element_parent(hierarchy, e[k].child) == k);
    REQUIRE(hr2d_element_parent(hierarchy, e[k].child + 1) == k);
    REQUIRE(memcmp(&left->b, &right->a, sizeof left->b) == 0);
    REQUIRE(memcmp(&left->a, &e[k].a, sizeof left->a) == 0);
    REQUIRE(memcmp(&right->b, &e[k].b, sizeof right->b) == 0);
    REQUIRE(left->length == e[k].length / 2 && right->length == left->length);
    REQUIRE(left->patch == e[k].patch && right->patch == e[k].patch);
  }
  REQUIRE(counts.elements == roots + 2 * split);
  REQUIRE(counts.leaves == counts.elements - split);
  REQUIRE(counts.levels == levels);
}

static double shortest_leaf(const hr2d_hierarchy *hierarchy) {
  const hr2d_element *e = hr2d_hierarchy_elements(hierarchy);
  double shortest = HUGE_VAL;
  for (uint64_t k = 0; k < hr2d_hierarchy_count(hierarchy).elements; k++)
    shortest = fmin(shortest, e[k].length);
  return shortest * hr2d_scene_unit(hr2d_hierarchy_scene(hierarchy));
}

static void check_link(const hr2d_scene *scene, const hr2d_element *e, const hr2d_link *link,
                       double off) {
  const double unit = hr2d_scene_unit(scene);
  const double shorter = fmin(e[link->pair.first].length, e[link->pair.second].length) * unit;
  REQUIRE(isfinite(link->exchange_area) && link->exchange_area >= 0);
  REQUIRE(link->exchange_area <= shorter * (1 + ROW_BOUND) + 4 * off);
  REQUIRE(e[link->pair.first].patch != e[link->pair.second].patch);
}

void fuzz_check_links(hr2d_linkset *links) {
  const hr2d_hierarchy *hierarchy = hr2d_linkset_hierarchy(links);
  const hr2d_scene *scene = hr2d_hierarchy_scene(hierarchy);
  const hr2d_element *e = hr2d_hierarchy_elements(hierarchy);
  const size_t n = hr2d_scene_patches(scene);
  const int directed = hr2d_linkset_directed(links);
  if (hr2d_scene_images(scene) > 1) { /* images have elements, and links that are weighted */
    if (shortest_leaf(hierarchy) < 128 * grain(scene) || has_sliver(scene)) return;
    const hr2d_status status = hr2d_linkset_validate(links);
    REQUIRE_SAYING(status == HR2D_OK || status == HR2D_ENOMEM, hr2d_linkset_message(links));
    return;
  }
  double *row = calloc(n + 1, sizeof *row);
  if (!row) return;
  fuzz_check_hierarchy(hierarchy);
  const double off = grain(scene);
  for (uint64_t k = 0; k < hr2d_linkset_size(links); k++) {
    const hr2d_link link = hr2d_linkset_get(links, k);
    check_link(scene, e, &link, off);
    row[e[link.pair.first].patch] += link.exchange_area;
    if (!directed) row[e[link.pair.second].patch] += link.exchange_area;
  }
  for (size_t k = 0; k < n; k++) check_row(scene, k, row[k], (double)hr2d_linkset_size(links));
  free(row);
  /* What lies within four roundings of a line counts as on it, which elements of a few
     roundings make of their neighbours. */
  if (shortest_leaf(hierarchy) < 128 * off || has_sliver(scene)) return;
  const hr2d_status status = hr2d_linkset_validate(links);
  REQUIRE_SAYING(status == HR2D_OK || status == HR2D_ENOMEM, hr2d_linkset_message(links));
}

/* Where no wall is brighter than a furnace's, which is 1 everywhere, none gets brighter:
   E ≤ 1 − ρ, and light of at most 1 from outside. */
static int is_furnace(const hr2d_scene *scene, size_t band) {
  int furnace = hr2d_scene_background(scene, band) <= 1 && hr2d_scene_sky_pieces(scene) == 0 &&
                !(hr2d_scene_sun(scene, band).irradiance > 0);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    furnace &=
        hr2d_scene_emission(scene, k, band) <= 1 - hr2d_scene_reflectance(scene, k, band);
  return furnace;
}

static double brightest(const hr2d_scene *scene, size_t band) {
  double max = 0;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    max = fmax(max, hr2d_scene_reflectance(scene, k, band));
  return max;
}

/* The solver stops by the norm ∫B².  It hardly counts a very long patch, whose light is
   thinly spread, but the power of such a patch is as large as that of others. */
int fuzz_is_even(const hr2d_scene *scene) {
  double min = HUGE_VAL, max = 0;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const double length = hr2d_scene_length(scene, k);
    min = fmin(min, length);
    max = fmax(max, length);
  }
  return max < 1e4 * min;
}

/* Whether a negative flux takes heat away: then what comes in may be less than what is absorbed
   by any factor. */
static int loses_heat(const hr2d_scene *scene, size_t band) {
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    if (hr2d_scene_emission(scene, k, band) < 0) return 1;
  return 0;
}

/* `balanced`: with closure and with links for both directions, for which solve.h gives the
   strongest promise. */
static void check_power(const hr2d_solution *solution, size_t band, unsigned order,
                        int balanced) {
  const hr2d_power p = hr2d_solution_power(solution, band);
  const double in = p.emitted + p.received;
  /* Above order 1 a quadrature rule gives the form factor of the background. */
  const double min = order > 1 ? -1e-3 * p.emitted : 0;
  REQUIRE(p.emitted >= 0 && p.received >= min);
  if (!balanced || !(in > 1e-280 && in < 1e300) ||
      fabs(in - p.absorbed - p.escaped) <= 1e-9 * in)
    return;
  char text[160];
  snprintf(text, sizeof text, "emitted %.17g + received %.17g, absorbed %.17g + escaped %.17g",
           p.emitted, p.received, p.absorbed, p.escaped);
  fuzz_fail(__FILE__, __LINE__, "power is balanced", text);
}

static double brightest_average(const hr2d_solution *solution, size_t n, size_t band) {
  double max = 0;
  for (size_t k = 0; k < n; k++) max = fmax(max, hr2d_solution_average(solution, k, band));
  return max;
}

void fuzz_check_solution(const hr2d_solution *solution, unsigned order, int closure) {
  const hr2d_hierarchy *hierarchy = hr2d_linkset_hierarchy(hr2d_solution_links(solution));
  const hr2d_scene *scene = hr2d_hierarchy_scene(hierarchy);
  const size_t n = hr2d_scene_patches(scene), bands = hr2d_scene_bands(scene);
  REQUIRE(hr2d_solution_residual(solution) >= 0);
  if (hr2d_scene_cut_off(scene) > 0) return; /* known to what is extrapolated */
  for (size_t band = 0; band < bands; band++) {
    const int furnace = order == 1 && closure && is_furnace(scene, band);
    const double slack = 1e-9 + (1e-13 + 16 * grain(scene) / shortest_leaf(hierarchy)) /
                                    (1 - brightest(scene, band));
    const double brightness = brightest_average(solution, n, band);
    for (size_t k = 0; k < n; k++) {
      const double average = hr2d_solution_average(solution, k, band);
      const double incident = hr2d_solution_irradiance(solution, k, band);
      REQUIRE(isfinite(average) && isfinite(incident));
      REQUIRE(isfinite(hr2d_solution_net_flux(solution, k, band)));
      if (order == 1 && !(average >= -DARK * brightness)) {
        char text[100];
        snprintf(text, sizeof text, "patch %zu: %.17g", k, average);
        fuzz_fail(__FILE__, __LINE__, "B >= 0", text);
      }
      if (furnace) REQUIRE(average <= 1 + slack);
      for (int q = 0; q <= 4; q++)
        REQUIRE(isfinite(hr2d_solution_at(solution, k, q / 4.0, band)));
    }
    if (loses_heat(scene, band)) continue;
    check_power(solution, band, order,
                fuzz_is_even(scene) &&
                    ((closure && !hr2d_linkset_directed(hr2d_solution_links(solution))) ||
                     brightest(scene, band) < NEARLY_WHITE));
  }
}
