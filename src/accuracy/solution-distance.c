/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solutions are polynomials between the ends of the leaves of both, and the borders of
   sunlight.  Leaves of the better one end where radiosity jumps or bends, and shrink towards
   where it is steep: a difference that leaves of the other are too coarse to show is found
   there.  Of a polynomial of degree d the values at N + 1 extrema of the Chebyshev polynomial
   T_N, N > d, are no smaller than cos(πd/2N) times its largest value (Ehlich and Zeller 1964):
   3p of them for a degree below p miss no more than a seventh.

   The polynomials of the better solution converge slowly beside corners, and nothing states
   their error.  So at the worst points it is gathered, which also shows how far its polynomials
   are off. */
#include "accuracy/solution-distance.h"

#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "base/sort.h"
#include "estimate/importance.h"
#include "field/leaves.h"
#include "scene/scene-impl.h"
#include "scene/sunlight.h"
#include "solution/solution-impl.h"

const hr2di_reading hr2di_reading_b = {hr2d_solution_average, hr2d_solution_at,
                                       hr2di_solution_gather};
const hr2di_reading hr2di_reading_h = {hr2d_solution_irradiance, hr2d_solution_irradiance_at,
                                       hr2di_solution_gather_irradiance};

double hr2di_distance_of_averages(const hr2di_reading *reading, const hr2d_solution *solution,
                                  const hr2d_solution *reference, const hr2d_target *target) {
  const hr2d_scene *scene = solution->hierarchy->scene;
  const size_t patches = hr2di_scene_cell(scene);
  double worst = 0;
  for (size_t b = 0; b < scene->bands; b++) {
    double max = 0;
    for (size_t k = 0; k < patches; k++) max = fmax(max, reading->average(reference, k, b));
    for (size_t k = 0; k < patches; k++) {
      const double right = reading->average(reference, k, b);
      const double error = fabs(reading->average(solution, k, b) - right);
      if (error > 0 && hr2di_is_important(target, k))
        worst = fmax(worst, error / fmax(right, target->floor * max));
    }
  }
  return worst;
}

/* Nodes of a stretch, per coefficient; and how far inside of a stretch the first of them is, as
   a part of it: values there belong to its leaves alone. */
#define NODES 3
#define INSET 1e-9

/* The points where two solutions differ most, the worst one first. */
enum { WORST_POINTS = 64 };
typedef struct far_apart {
  size_t patch;
  double at, distance, right;
} far_apart;

typedef struct search {
  const hr2di_reading *reading;
  const hr2d_solution *solution, *reference;
  hr2di_watch *watch;
  hr2di_leaves leaves[2];
  double *border; /* of a patch, sorted */
  size_t borders, room;
  far_apart worst[WORST_POINTS];
  size_t count;
  double largest;
} search;

static void insert(search *s, far_apart point) {
  far_apart *worst = s->worst;
  size_t k = s->count < WORST_POINTS ? s->count++ : WORST_POINTS;
  if (k == WORST_POINTS && worst[--k].distance >= point.distance) return;
  for (; k > 0 && worst[k - 1].distance < point.distance; k--) worst[k] = worst[k - 1];
  worst[k] = point;
}

static int by_number(const void *left, const void *right) {
  const double a = *(const double *)left, b = *(const double *)right;
  return (a > b) - (a < b);
}

/* Sets the borders of the stretches of a patch. */
static hr2d_status set_borders(search *s, size_t patch) {
  const hr2d_scene *scene = s->reference->hierarchy->scene;
  size_t suns = 0;
  const hr2di_sun_border *sun = hr2di_sunlight_borders(scene, patch, &suns);
  const size_t *first[2] = {s->leaves[0].of_patch + patch, s->leaves[1].of_patch + patch};
  const size_t needs = first[0][1] - first[0][0] + first[1][1] - first[1][0] + suns + 1;
  const hr2d_allocator *alloc = &s->solution->alloc;
  if (hr2di_alloc_reserve(alloc, &s->border, &s->room, needs, sizeof *s->border))
    return HR2D_ENOMEM;
  s->borders = 0;
  for (int m = 0; m < 2; m++)
    for (size_t k = first[m][0]; k < first[m][1]; k++)
      s->border[s->borders++] = s->leaves[m].leaf[k].from;
  for (size_t k = 0; k < suns; k++) s->border[s->borders++] = sun[k].at;
  s->border[s->borders++] = 1;
  return hr2di_sort(s->border, s->borders, sizeof *s->border, by_number, s->watch);
}

static size_t nodes_of(const search *s) {
  return NODES *
         (s->solution->order > s->reference->order ? s->solution->order : s->reference->order);
}

static hr2d_status compare_stretch(search *s, size_t patch, size_t band, double from,
                                   double to) {
  const size_t nodes = nodes_of(s);
  const double middle = 0.5 * (from + to), half = (0.5 - INSET) * (to - from);
  for (size_t k = 0; k <= nodes; k++) {
    const double t = middle - half * cos(HR2DI_PI * (double)k / (double)nodes);
    const double right = s->reading->at(s->reference, patch, t, band);
    const double is = s->reading->at(s->solution, patch, t, band);
    s->largest = fmax(s->largest, right);
    insert(s, (far_apart){patch, t, fabs(is - right), right});
  }
  return hr2di_watch_work(s->watch, 4 * nodes);
}

/* Finds where the polynomials of the solutions differ most, in one band. */
static hr2d_status find_worst(search *s, size_t band) {
  const size_t patches = hr2di_scene_cell(s->solution->hierarchy->scene);
  hr2d_status status = HR2D_OK;
  s->count = 0;
  s->largest = 0;
  for (size_t k = 0; k < patches && !status; k++) {
    status = set_borders(s, k);
    for (size_t m = 0; m + 1 < s->borders && !status; m++)
      if (s->border[m + 1] > s->border[m])
        status = compare_stretch(s, k, band, s->border[m], s->border[m + 1]);
  }
  return status;
}

/* Gathers at the worst points. */
static hr2d_status measure(search *s, size_t band, double *value, hr2d_error *distance) {
  const double d = (double)(nodes_of(s) / NODES) - 1;
  const double missed = 1 / cos(HR2DI_PI * d / (2 * (double)nodes_of(s)));
  double error = 0, off = 0;
  hr2d_status status = find_worst(s, band);
  for (size_t k = 0; k < s->count && !status; k++) {
    const far_apart *w = &s->worst[k];
    status = s->reading->gather(s->reference, w->patch, &w->at, 1, value, s->watch);
    if (status) break;
    const double right = value[band];
    s->largest = fmax(s->largest, right);
    off = fmax(off, fabs(w->right - right));
    error = fmax(error, fabs(s->reading->at(s->solution, w->patch, w->at, band) - right));
  }
  if (status || s->count == 0) return status;
  const double upper = fmax(error, missed * s->worst[0].distance + off);
  if (error > 0) distance->estimate = fmax(distance->estimate, error / s->largest);
  if (upper > 0) distance->bound = fmax(distance->bound, upper / s->largest);
  return HR2D_OK;
}

hr2d_status hr2di_distance_at_points(const hr2di_reading *reading,
                                     const hr2d_solution *solution,
                                     const hr2d_solution *reference, hr2di_watch *watch,
                                     hr2d_error *distance) {
  search s = {.reading = reading, .solution = solution, .reference = reference, .watch = watch};
  const hr2d_solution *const of[] = {solution, reference};
  double *value = hr2di_alloc(&solution->alloc, solution->bands, sizeof *value);
  hr2d_status status = value ? HR2D_OK : HR2D_ENOMEM;
  *distance = (hr2d_error){0, 0};
  for (int m = 0; m < 2; m++)
    if (!status) status = hr2di_leaves_init(&s.leaves[m], of[m], NULL, watch);
  for (size_t b = 0; b < solution->bands && !status; b++)
    status = measure(&s, b, value, distance);
  for (int m = 0; m < 2; m++)
    if (s.leaves[m].of_patch || s.leaves[m].scale) hr2di_leaves_clear(&s.leaves[m]);
  hr2di_alloc_free(&solution->alloc, s.border);
  hr2di_alloc_free(&solution->alloc, value);
  return status;
}
