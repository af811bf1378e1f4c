/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A function that is analytic except at points v is approximated on an element by polynomials
   of degree p−1 to within ρ^−p, ρ = m + √(m²−1), if no v lies within the ellipse m of the
   element (see geometry/bernstein-ellipse.h).  Radiosity is singular at the ends of patches in
   front. */
#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/team.h"
#include "geometry/bernstein-ellipse.h"
#include "mesh/grader.h"
#include "scene/scene-impl.h"
#include "solve/external-irradiance.h"

/* Elements are no shorter than this part of their patch, and than so many roundings of its
   coordinates: then their lengths are known to 0.1 %. */
#define SHORTEST  0x1p-44
#define ROUNDINGS 0x1p10

/* If the quarter next to a corner is cut off an element, the corner lies on the ellipse m = 5/3
   of the rest.  A cut at a quarter is as exact as one at a half. */
#define QUARTER 0.25
#define BEHIND  1.66

enum { STACK = 256 };

/* An element still to be divided, as a part of its patch. */
typedef struct part {
  uint32_t element;
  double from, to;
  size_t near; /* the first so many of grader::near may be near to it */
} part;

/* The first mark that is not before a place, or their number. */
static size_t first_mark(const hr2di_grader *g, double place) {
  size_t low = 0, high = g->marks;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (g->mark[middle].at < place)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* The mark inside an element that is nearest to its middle, or NULL. */
static const hr2di_grading_mark *mark_inside(const hr2di_grader *g, const part *e) {
  const double margin = 4 * g->shortest, middle = 0.5 * (e->from + e->to);
  const hr2di_grading_mark *best = NULL;
  const size_t behind = first_mark(g, middle);
  for (size_t k = behind > 0 ? behind - 1 : 0; k <= behind && k < g->marks; k++) {
    const double at = g->mark[k].at;
    if (at <= e->from + margin || at >= e->to - margin) continue;
    if (!best || fabs(at - middle) < fabs(best->at - middle)) best = &g->mark[k];
  }
  return best;
}

/* Sorts the points of an element, those nearer than HR2DI_GRADING_FAR first, and forgets the
   others; returns the least ellipse.  The ellipses of a part of the element lie within its own,
   so that no other point is nearer to the part than HR2DI_GRADING_FAR. */
static double sort_near(hr2di_grader *g, part *e) {
  const hr2d_element *element = &g->h->element[e->element];
  const hr2d_segment s = {element->a, element->b};
  hr2d_point *point = g->near.point;
  double min = HR2DI_GRADING_FAR;
  size_t near = 0;
  for (size_t k = 0; k < e->near; k++) {
    const hr2d_point p = point[k];
    const double ellipse = hr2di_ellipse(s, p);
    if (!(ellipse < HR2DI_GRADING_FAR)) continue;
    min = fmin(min, ellipse);
    point[k] = point[near];
    point[near++] = p;
  }
  e->near = near;
  return min;
}

/* Where an element is divided towards a mark, as a part of it; 0: nowhere. */
static double cut_towards(const hr2di_grader *g, const part *e,
                          const hr2di_grading_mark *mark) {
  const double size = e->to - e->from, margin = 4 * g->shortest;
  const double from = fabs(mark->at - e->from), to = fabs(mark->at - e->to);
  const int touches = from <= margin || to <= margin;
  /* An event may keep an element from touching a corner that it is near to. */
  const int near = mark->depth > 0 && from + to < fmin(g->distance, BEHIND) * size;
  const double min = 1.001 * ldexp(1, -(int)mark->depth);
  if (!(touches || near) || !(size > min)) return 0;
  if (!touches || 0.5 * size <= min || size > 1.001 * ldexp(1, -(int)mark->halves)) return 0.5;
  return from <= to ? QUARTER : 1 - QUARTER;
}

/* Where an element is divided, as a part of it; 0: nowhere. */
static double cut_of(const hr2di_grader *g, const part *e, double min) {
  const double size = e->to - e->from, margin = 4 * g->shortest;
  if (size < g->shortest || !hr2di_element_divisible(g->h, e->element)) return 0;
  const double reach = g->distance * size + margin;
  double cut = 0;
  for (size_t k = first_mark(g, e->from - reach);
       k < g->marks && g->mark[k].at <= e->to + reach && cut == 0; k++)
    cut = cut_towards(g, e, &g->mark[k]);
  return cut > 0 ? cut : min < g->distance ? 0.5 : 0;
}

static void divide_at(hr2di_grader *g, uint32_t element, double cut) {
  const hr2d_element *e = &g->h->element[element];
  const hr2d_point end = cut < 0.5 ? e->a : e->b;
  const hr2d_point at = {0.5 * (end.x + e->centre.x), 0.5 * (end.y + e->centre.y)};
  if (cut == 0.5)
    hr2di_element_halve(g->h, element);
  else
    hr2di_element_divide(g->h, element, cut, at);
}

/* Elements of the least length add nothing to errors of averages, however near an end is. */
static int matters(const hr2di_grader *g, const part *e) {
  return g->grading->norm == HR2D_NORM_SUP || e->to - e->from >= g->shortest;
}

static hr2d_status divide(hr2di_grader *g, part *e, int *divided) {
  hr2d_hierarchy *h = g->h;
  const hr2di_grading_mark *inside = mark_inside(g, e);
  const double min = sort_near(g, e);
  const double cut = inside ? 0 : cut_of(g, e, min);
  *divided = h->element[e->element].child || inside || cut > 0;
  if (!*divided && matters(g, e)) g->survey.ellipse = fmin(g->survey.ellipse, min);
  if (!*divided || h->element[e->element].child) return HR2D_OK;
  if (g->grading->max_elements && h->elements + 2 > g->grading->max_elements)
    return HR2D_EMAX_ELEMENTS;
  const hr2d_status status = hr2di_hierarchy_reserve(h);
  if (status) return status;
  if (inside)
    hr2di_element_divide(h, e->element, (inside->at - e->from) / (e->to - e->from),
                         inside->point);
  else
    divide_at(g, e->element, cut);
  return HR2D_OK;
}

double hr2di_grading_shortest(const hr2di_patch *p) {
  const hr2d_segment s = p->scaled;
  const double x = fmax(fabs(s.a.x), fabs(s.b.x)), y = fmax(fabs(s.a.y), fabs(s.b.y));
  return fmax(SHORTEST, ROUNDINGS * DBL_EPSILON * fmax(x, y) / p->length);
}

/* The target of a patch, and what depends on it. */
static void aim(hr2di_grader *g, uint32_t patch) {
  g->target = fmin(g->grading->target, 0.5);
  g->distance = g->grading->distance > 0 ? g->grading->distance : HR2DI_ELLIPSE_DISTANT;
  g->shortest = hr2di_grading_shortest(&g->h->scene->patch[patch]);
}

static hr2d_status look(hr2di_grader *g, uint32_t patch) {
  hr2d_status status = g->seen ? hr2di_visible_vertices_look(g->seen, patch) : HR2D_OK;
  if (!status) status = hr2di_grading_look_around(g, patch);
  if (!status) status = hr2di_grading_mark_gas(g, patch);
  return status ? status
                : hr2di_images_add(g->h->scene, patch, HR2DI_GRADING_FAR, g->seen, &g->near,
                                   g->grading->watch);
}

/* A pane is divided for both sides at once, as what falls on one leaves the other.  What stands
   on the other side is known already. */
static hr2d_status trace(hr2di_grader *g, uint32_t patch) {
  const uint32_t other = (uint32_t)hr2di_scene_other_side(g->h->scene, patch);
  aim(g, patch);
  g->near.count = g->marks = g->feet_count = 0;
  hr2d_status status = look(g, patch);
  const size_t marks = g->marks, feet = g->feet_count;
  if (!status && other != patch) status = look(g, other);
  hr2di_grading_turn_marks(g, marks);
  g->feet_count = feet;
  return status;
}

static hr2d_status divide_patch(hr2di_grader *g, uint32_t patch) {
  part stack[STACK];
  size_t count = 0;
  aim(g, patch);
  for (size_t k = 0; k < g->feet_count; k++) g->under[g->feet[k]] = patch + 1;
  hr2d_status status = hr2di_grading_set_marks(g, patch);
  if (status) return status;
  stack[count++] = (part){patch, 0, 1, g->near.count};
  while (count > 0 && !status) {
    part e = stack[--count];
    int divided = 0;
    status = hr2di_watch_work(g->grading->watch, 2 + e.near / 4);
    if (!status) status = divide(g, &e, &divided);
    if (status || !divided || count + 2 > STACK) continue;
    const uint32_t child = g->h->element[e.element].child;
    const double middle =
        e.from + hr2di_element_left_part(g->h->element, e.element) * (e.to - e.from);
    stack[count++] = (part){child + 1, middle, e.to, e.near};
    stack[count++] = (part){child, e.from, middle, e.near};
  }
  return status;
}

/* Patches that reflect nothing have B = E and are not divided: the average of H comes exactly
   from the links.  The exceptions are backs in front of a background, and pieces of the sky: a
   quadrature rule samples them, and kinks disturb it.  Then g->all is set. */
static hr2d_status find_backs(hr2di_grader *g) {
  const hr2d_scene *scene = g->h->scene;
  g->all = hr2di_external_has_pieces(scene);
  return hr2di_external_wants_sky(scene) && !g->all
             ? hr2di_side_parts_find_backs(scene, &g->all, g->grading->watch)
             : HR2D_OK;
}

/* A pane is divided on the side of the lower number, and so will be the other side. */
static int divides(const hr2di_grader *g, uint32_t patch) {
  const hr2d_scene *scene = g->h->scene;
  return hr2di_scene_lit(scene, patch) && patch <= hr2di_scene_other_side(scene, patch) &&
         (g->all || hr2di_grading_reflectance(scene, patch) > 0);
}

static void clear(hr2di_grader *g) {
  const hr2d_allocator *alloc = &g->h->alloc;
  hr2di_alloc_free(alloc, g->vertex);
  hr2di_alloc_free(alloc, g->under);
  hr2di_alloc_free(alloc, g->near.point);
  hr2di_alloc_free(alloc, g->mark);
}

/* Among many patches with walls between them some ends are as near to elements as they may be,
   and only corners tell scenes apart. */
static hr2d_status survey_corners(hr2di_grader *g, uint32_t patch) {
  aim(g, patch);
  g->near.count = g->marks = 0;
  const hr2d_status status = hr2di_grading_look_around(g, patch);
  return status ? status : hr2di_grading_set_marks(g, patch);
}

hr2d_status hr2di_grading_survey(const hr2d_scene *scene, const hr2di_grading *grading,
                                 hr2di_survey *survey) {
  hr2di_grader g = {.grading = grading, .survey = {1, HR2DI_ELLIPSE_DISTANT}, .target = 1};
  hr2d_status status = hr2d_hierarchy_create(scene, &g.h);
  if (!status) status = hr2di_grading_list_vertices(&g);
  for (int round = 0; round < 2; round++) /* the first one finds what stands on patches */
    for (uint32_t k = 0; k < scene->patches && !status; k++)
      if (divides(&g, k) || round == 0) status = survey_corners(&g, k);
  if (g.h) clear(&g);
  hr2d_hierarchy_destroy(g.h);
  *survey = g.survey;
  return status;
}

hr2d_status hr2di_grading_apply(hr2d_hierarchy *hierarchy, const hr2di_grading *grading,
                                hr2di_survey *survey) {
  const hr2d_scene *scene = hierarchy->scene;
  static const hr2di_grader_steps steps = {divides, trace, divide_patch};
  hr2di_grader g = {.steps = &steps,
                    .h = hierarchy,
                    .grading = grading,
                    .survey = {1, HR2DI_GRADING_FAR},
                    .target = 1};
  hr2di_visible_vertices seen = {0};
  hr2d_status status = hr2di_grading_list_vertices(&g);
  for (uint32_t k = 0; k < scene->patches && !status; k++) {
    status =
        hr2di_grading_look_around(&g, k); /* finds the patches that stand on it, into g.under */
    g.near.count = g.marks = 0;
  }
  if (!status) status = find_backs(&g);
  if (!status && scene->effect[HR2D_EFFECT_OCCLUSION].on) {
    g.seen = &seen;
    status = hr2di_visible_vertices_init(&seen, scene, grading->beam_cache, &hierarchy->alloc,
                                         grading->watch);
  }
  const size_t threads = hr2di_team_threads(grading->threads);
  if (!status && threads > 1 && scene->patches >= HR2DI_CHOICE_TEAM_PATCHES) {
    status = hr2di_grader_team(&g, threads);
  } else {
    for (uint32_t k = 0; k < hr2di_scene_cell(scene) && !status; k++) {
      if (!divides(&g, k)) continue;
      status = trace(&g, k);
      if (!status) status = divide_patch(&g, k);
    }
  }
  hr2di_visible_vertices_clear(&seen);
  clear(&g);
  *survey = g.survey;
  return status;
}
