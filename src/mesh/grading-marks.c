/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where elements of a patch end, and which ends of other patches are near to it.

   Where an end touches the patch no element is far enough: there B ~ x^γ, and an element of
   relative size 2^−D adds an error below (2^−D/p²)^(1+2γ)/32 to averages, and of about
   (2^−D/p²)^γ to B itself. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/sort.h"
#include "geometry/bernstein-ellipse.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "mesh/corner-exponent.h"
#include "mesh/grader.h"
#include "scene/scene-impl.h"

/* An end stands on a patch if it is nearer to its line than this part of its length, and than
   what commit takes for a touch: else the two may see each other through the gap. */
#define ON_LINE 1e-13
/* Measured at 1° to 170° with ρ up to 0.999, where this leaves a factor of 10. */
#define SMALL 32

enum { DEEPEST = 40 };

/* From this order on rows of blocks of elements that end at a touch may exceed 1. */
enum { HIGH = 6 };

static int by_x(const void *a, const void *b) {
  const hr2di_grading_vertex *p = a, *q = b;
  if (p->at.x != q->at.x) return p->at.x < q->at.x ? -1 : 1;
  if (p->patch != q->patch) return p->patch < q->patch ? -1 : 1;
  if (p->last != q->last) return p->last - q->last;
  if (p->inside != q->inside) return p->inside - q->inside;
  return (p->at.y > q->at.y) - (p->at.y < q->at.y);
}

static int by_place(const void *a, const void *b) {
  const hr2di_grading_mark *p = a, *q = b;
  if (p->at != q->at) return p->at < q->at ? -1 : 1;
  return p->depth < q->depth ? 1 : p->depth > q->depth ? -1 : 0;
}

hr2d_status hr2di_grading_list_vertices(hr2di_grader *g) {
  const hr2d_scene *scene = g->h->scene;
  const hr2di_sunlight *sun = &scene->sunlight;
  g->vertex = hr2di_alloc(&g->h->alloc, 2 * (scene->patches + sun->borders), sizeof *g->vertex);
  g->under = hr2di_alloc_zero(&g->h->alloc, 2 * scene->patches, sizeof *g->under);
  if (!g->vertex || !g->under) return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  for (uint32_t k = 0; k < scene->patches && !status; k++) {
    const hr2d_segment s = scene->patch[k].scaled;
    if (k % 16 == 0) status = hr2di_watch_work(g->grading->watch, 16);
    g->vertex[g->vertices++] = (hr2di_grading_vertex){s.a, k, 0, 0};
    g->vertex[g->vertices++] = (hr2di_grading_vertex){s.b, k, 1, 0};
  }
  for (size_t k = 0; k < sun->borders; k++) {
    const hr2di_sun_border *b = &sun->border[k];
    const uint32_t other = (uint32_t)hr2di_scene_other_side(scene, b->patch);
    g->vertex[g->vertices++] = (hr2di_grading_vertex){b->point, b->patch, 0, 1};
    if (other != b->patch)
      g->vertex[g->vertices++] = (hr2di_grading_vertex){b->point, other, 0, 1};
  }
  return status
             ? status
             : hr2di_sort(g->vertex, g->vertices, sizeof *g->vertex, by_x, g->grading->watch);
}

double hr2di_grading_reflectance(const hr2d_scene *scene, uint32_t patch) {
  double max = 0;
  for (size_t b = 0; b < scene->bands; b++)
    max = fmax(max, hr2di_scene_scattered(scene, patch, b));
  return max;
}

/* Equal corners often follow each other, so the last exponent is kept. */
static double exponent_of(hr2di_grader *g, double angle, double rho) {
  if (g->last[0] != angle || g->last[1] != rho) {
    g->last[0] = angle;
    g->last[1] = rho;
    g->last[2] = hr2di_corner_exponent(angle, rho, rho);
  }
  return g->last[2];
}

/* How elements are graded where two patches meet at angle α and reflect light to and fro. A
   flat corner has a weak singularity: its strength is about the form factor between the
   patches, ½(1 + cos α). */
static hr2di_grading_mark grade_corner(hr2di_grader *g, double cosine, double sine,
                                       double rho) {
  const double p = g->grading->order, strength = fmin(1, 2 * rho * (1 + cosine));
  const double gamma = exponent_of(g, atan2(sine, cosine), rho);
  const int sup = g->grading->norm == HR2D_NORM_SUP;
  const double slope = sup ? fmax(gamma, 0.05) : 1 + 2 * gamma;
  const double digits = log2(strength / (sup ? 1 : SMALL) / g->target) / slope;
  hr2di_grading_mark m = {.depth = g->grading->corner_levels,
                          .halves = sup ? 2 * DEEPEST
                                        : (unsigned)ceil(HR2DI_CHOICE_QUARTERS / slope)};
  if (!(strength > g->target)) return m;
  g->survey.exponent = fmin(g->survey.exponent, gamma);
  if (g->grading->no_corner_grading) return m;
  m.depth += (unsigned)fmin(fmax(ceil(digits - 2 * log2(p) + 1.5), 2), DEEPEST);
  return m;
}

/* Both of two gradings in one. */
static void deepen(hr2di_grading_mark *mark, const hr2di_grading_mark *by) {
  mark->depth = by->depth > mark->depth ? by->depth : mark->depth;
  mark->halves = by->halves > mark->halves ? by->halves : mark->halves;
}

/* The corner of a shorter patch is as fine on this one as on that, whose average counts as
   much. */
static unsigned levels_to(const hr2d_scene *scene, uint32_t patch, uint32_t other) {
  const double ratio = scene->patch[patch].length / scene->patch[other].length;
  return ratio > 1 ? (unsigned)fmin(ceil(log2(ratio)), DEEPEST) : 0;
}

/* Through gas H of a patch that stands at a corner has x ln x times the other's B − E_g and
   twice κ/π, also if the other one reflects nothing; it is as strong as its elements are deep.
 */
hr2di_grading_mark hr2di_grading_in_gas(const hr2di_grader *g, double cosine, double rho,
                                        double depth) {
  enum { SLOPE = 3 }; /* 1 + 2γ of γ = 1 */
  const double p = g->grading->order, strength = rho * (1 + cosine) * fmin(depth, 1);
  const double digits = log2(strength / SMALL / g->target) / SLOPE;
  hr2di_grading_mark m = {.depth = g->grading->corner_levels,
                          .halves = (unsigned)ceil(HR2DI_CHOICE_QUARTERS / SLOPE)};
  if (!(strength > g->target) || g->grading->no_corner_grading) return m;
  m.depth += (unsigned)fmin(fmax(ceil(digits - 2 * log2(p) + 1.5), 2), DEEPEST);
  return m;
}

/* Levels from a patch to elements of the depth 1: B changes by e^−κx beside a corner. */
static unsigned levels_in_gas(double depth) {
  return depth > 1 ? (unsigned)fmin(ceil(log2(depth)), DEEPEST) : 0;
}

/* The deepest grading that a patch standing on this one asks for: it may lie on either side of
   its foot, or on both. */
static hr2di_grading_mark grade_at(hr2di_grader *g, uint32_t patch,
                                   const hr2di_grading_vertex *v, double at) {
  const hr2d_scene *scene = g->h->scene;
  const hr2d_segment s = scene->patch[patch].scaled, other = scene->patch[v->patch].scaled;
  const double rho = sqrt(hr2di_grading_reflectance(scene, patch) *
                          hr2di_grading_reflectance(scene, v->patch));
  const double scale = scene->patch[patch].length * scene->patch[v->patch].length;
  const hr2d_point far = v->last ? other.a : other.b;
  const hr2d_point u = {(s.b.x - s.a.x), (s.b.y - s.a.y)};
  const hr2d_point w = {far.x - v->at.x, far.y - v->at.y};
  const double along = (u.x * w.x + u.y * w.y) / scale, up = (u.x * w.y - u.y * w.x) / scale;
  const double own = hr2di_grading_reflectance(scene, patch);
  const double depth = hr2di_scene_has_gas(scene)
                           ? hr2di_scene_scaled_range(scene).most * scene->patch[patch].length
                           : 0;
  hr2di_grading_mark m = {.depth = 0};
  /* Its front looks along u if it leads downwards. */
  const int seen = up > 0 && (v->last ? at < 1 : at > 0);
  const double cosine = v->last ? along : -along;
  if (seen && rho > 0) m = grade_corner(g, cosine, up, rho);
  if (seen && own > 0 && depth > 0) {
    const hr2di_grading_mark in_gas = hr2di_grading_in_gas(g, cosine, own, depth);
    deepen(&m, &in_gas);
  }
  unsigned levels = m.depth > 0 ? levels_to(scene, patch, v->patch) : 0;
  if (seen && own > 0) levels = levels > levels_in_gas(depth) ? levels : levels_in_gas(depth);
  m.depth += levels;
  m.halves += levels;
  return m;
}

hr2d_status hr2di_grading_add_mark(hr2di_grader *g, double at, hr2d_point point,
                                   hr2di_grading_mark mark) {
  if (hr2di_alloc_reserve(&g->h->alloc, &g->mark, &g->mark_capacity, g->marks + 1,
                          sizeof *g->mark))
    return HR2D_ENOMEM;
  mark.at = at;
  mark.point = point;
  g->mark[g->marks++] = mark;
  return HR2D_OK;
}

/* Whether a patch with an end that stands on another patch is in front of that patch. */
static int rises(const hr2d_scene *scene, uint32_t patch, const hr2di_grading_vertex *v) {
  const hr2d_segment s = scene->patch[patch].scaled, other = scene->patch[v->patch].scaled;
  return hr2di_orient(s.a, s.b, v->last ? other.a : other.b) > 0;
}

/* Adds a vertex to the marks if it is on the patch, to the near points if it is in front. */
hr2d_status hr2di_grading_add_near(hr2di_grader *g, hr2d_segment patch, hr2d_point v) {
  if (hr2di_ellipse(patch, v) >= HR2DI_GRADING_FAR) return HR2D_OK;
  if (hr2di_alloc_reserve(&g->h->alloc, &g->near.point, &g->near.capacity, g->near.count + 1,
                          sizeof *g->near.point))
    return HR2D_ENOMEM;
  g->near.point[g->near.count++] = v;
  return HR2D_OK;
}

/* The end of a patch stands on this patch. */
static hr2d_status add_under(hr2di_grader *g, uint32_t end, uint32_t patch) {
  if (!g->waits) {
    g->under[end] = patch + 1;
    return HR2D_OK;
  }
  if (hr2di_alloc_reserve(&g->h->alloc, &g->feet, &g->feet_capacity, g->feet_count + 1,
                          sizeof *g->feet))
    return HR2D_ENOMEM;
  g->feet[g->feet_count++] = end;
  return HR2D_OK;
}

/* A wall may end before a patch or behind it by what commit takes for a touch.  Where the patch
   sees no gap there is none, and B jumps.  Elements end there and do not shrink towards it: the
   corner is known to that touch alone, and short ones of the wall are behind the patch. */
static hr2d_status place_touching(hr2di_grader *g, uint32_t patch,
                                  const hr2di_grading_vertex *v, double above, double at) {
  const hr2di_patch *p = &g->h->scene->patch[patch];
  if (fabs(above) > HR2DI_TOUCH / p->length || at < ON_LINE || at > 1 - ON_LINE) return HR2D_OK;
  if (g->grading->order >= HIGH || !rises(g->h->scene, patch, v)) return HR2D_OK;
  return hr2di_grading_add_mark(g, at, hr2di_point_at(p->scaled, at),
                                (hr2di_grading_mark){.depth = 0});
}

/* Sorts a vertex into the marks if it is on the patch, into the near ones if it is in front, or
   on the line of the patch with its own patch in front. */
static hr2d_status place(hr2di_grader *g, uint32_t patch, uint32_t number) {
  const hr2di_patch *p = &g->h->scene->patch[patch];
  const hr2di_grading_vertex *v = &g->vertex[number];
  const hr2d_segment s = p->scaled;
  if (v->patch == patch) return HR2D_OK;
  const double square = p->length * p->length;
  if (square < DBL_MIN) return HR2D_OK; /* dust: its parts cannot be told apart */
  const double above = hr2di_orient(s.a, s.b, v->at) / square;
  const double ux = s.b.x - s.a.x, uy = s.b.y - s.a.y;
  const double at = ((v->at.x - s.a.x) * ux + (v->at.y - s.a.y) * uy) / square;
  const double min = fmin(ON_LINE, HR2DI_TOUCH / p->length);
  if (v->inside) return above > min ? hr2di_grading_add_near(g, s, v->at) : HR2D_OK;
  const int sees =
      above > min && (!g->seen || hr2di_visible_vertices_has(g->seen, v->patch, v->last));
  if (sees) return hr2di_grading_add_near(g, s, v->at);
  if (fabs(above) > min) return place_touching(g, patch, v, above, at);
  if (at < -ON_LINE || at > 1 + ON_LINE)
    return rises(g->h->scene, patch, v) ? hr2di_grading_add_near(g, s, v->at) : HR2D_OK;
  const hr2di_grading_mark mark = grade_at(g, patch, v, at);
  if (at < ON_LINE) return hr2di_grading_add_mark(g, 0, s.a, mark);
  if (at > 1 - ON_LINE) return hr2di_grading_add_mark(g, 1, s.b, mark);
  const hr2d_status status = rises(g->h->scene, patch, v)
                                 ? add_under(g, 2 * v->patch + (uint32_t)v->last, patch)
                                 : HR2D_OK;
  return status ? status : hr2di_grading_add_mark(g, at, v->at, mark);
}

/* Places the vertices that may be near a patch: those in a window of x, and of y. */
hr2d_status hr2di_grading_look_around(hr2di_grader *g, uint32_t patch) {
  const hr2di_patch *p = &g->h->scene->patch[patch];
  const double middle = 0.5 * (p->scaled.a.x + p->scaled.b.x);
  const double height = 0.5 * (p->scaled.a.y + p->scaled.b.y);
  const double reach = HR2DI_GRADING_FAR * p->length;
  size_t low = 0, high = g->vertices;
  while (low < high) {
    const size_t at = low + (high - low) / 2;
    if (g->vertex[at].at.x < middle - reach)
      low = at + 1;
    else
      high = at;
  }
  hr2d_status status = HR2D_OK;
  for (; low < g->vertices && g->vertex[low].at.x <= middle + reach && !status; low++) {
    status = hr2di_watch_work(g->grading->watch, 1);
    if (!status && fabs(g->vertex[low].at.y - height) <= reach)
      status = place(g, patch, (uint32_t)low);
  }
  return status;
}

/* Adds a mark where an end of the patch stands on another one, which has no end there. */
static hr2d_status add_foot(hr2di_grader *g, uint32_t patch, int last) {
  const hr2d_segment s = g->h->scene->patch[patch].scaled;
  const hr2di_grading_vertex foot = {last ? s.b : s.a, patch, last, 0};
  const uint32_t under = g->under[2 * patch + (uint32_t)last];
  return under ? hr2di_grading_add_mark(g, last, foot.at, grade_at(g, under - 1, &foot, 0.5))
               : HR2D_OK;
}

unsigned hr2di_grading_generations(double error) {
  return error >= 3e-3 ? 0 : error >= 1e-8 ? 1 : 2;
}

static hr2d_status add_events(hr2di_grader *g, uint32_t patch) {
  const hr2di_events *events = g->grading->events;
  const hr2d_segment s = g->h->scene->patch[patch].scaled;
  size_t low = 0, high = events ? events->count : 0;
  while (low < high) {
    const size_t at = low + (high - low) / 2;
    if (events->event[at].patch < patch)
      low = at + 1;
    else
      high = at;
  }
  hr2d_status status = HR2D_OK;
  for (; events && low < events->count && events->event[low].patch == patch && !status; low++) {
    const double at = events->event[low].at;
    status =
        hr2di_grading_add_mark(g, at, hr2di_point_at(s, at), (hr2di_grading_mark){.depth = 0});
  }
  return status;
}

/* Sorts the marks; of equal ones keeps one, with the deepest grading. */
static void sort_marks(hr2di_grader *g) {
  size_t kept = 0;
  if (g->marks > 0) qsort(g->mark, g->marks, sizeof *g->mark, by_place);
  for (size_t k = 0; k < g->marks; k++) {
    if (kept > 0 && g->mark[k].at - g->mark[kept - 1].at < 16 * g->shortest) {
      deepen(&g->mark[kept - 1], &g->mark[k]);
      continue;
    }
    g->mark[kept++] = g->mark[k];
  }
  g->marks = kept;
}

void hr2di_grading_turn_marks(hr2di_grader *g, size_t first) {
  for (size_t k = first; k < g->marks; k++) g->mark[k].at = 1 - g->mark[k].at;
}

static hr2d_status add_own_marks(hr2di_grader *g, uint32_t patch) {
  hr2d_status status = HR2D_OK;
  for (int last = 0; last < 2 && !status; last++) status = add_foot(g, patch, last);
  return status ? status : add_events(g, patch);
}

hr2d_status hr2di_grading_set_marks(hr2di_grader *g, uint32_t patch) {
  const uint32_t other = (uint32_t)hr2di_scene_other_side(g->h->scene, patch);
  hr2d_status status = add_own_marks(g, patch);
  const size_t first = g->marks;
  if (!status && other != patch) status = add_own_marks(g, other);
  hr2di_grading_turn_marks(g, first);
  if (!status) sort_marks(g);
  return status;
}
