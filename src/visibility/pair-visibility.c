/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams from the walls of a patch find its line classes, which are listed by the sides where
   they end.  A pair takes those that end along its other patch, and leaves of them what lies
   between its parts. */
#include "visibility/pair-visibility.h"

#include <math.h>

#include "base/alloc.h"
#include "geometry/vector.h"

static hr2d_status keep(void *ctx, const hr2di_line_class *line_class, hr2di_wall_side from,
                        hr2di_wall_side side) {
  hr2di_pair_visibility *s = ctx;
  const hr2di_triangulation *t = s->tracer.walk.in;
  const size_t k = s->all.count;
  const hr2di_side *of = s->tracer.scene->parts.of_side;
  if (!line_class || of[side].wall == of[from].wall)
    return HR2D_OK; /* of a wall that roundings have bent */
  const hr2d_allocator *alloc = &s->all.alloc;
  if (k >= UINT32_MAX - 1 ||
      hr2di_alloc_reserve(alloc, &s->next, &s->next_capacity, k + 1, sizeof *s->next) ||
      hr2di_alloc_reserve(alloc, &s->side, &s->side_capacity, k + 1, sizeof *s->side))
    return HR2D_ENOMEM;
  const hr2d_status status = hr2di_line_class_list_add(
      &s->all, line_class, hr2di_wall_side_at(t, from), hr2di_wall_side_at(t, side));
  if (status) return status;
  s->next[k] = s->last[side];
  s->side[k] = side;
  s->last[side] = (uint32_t)k + 1;
  return HR2D_OK;
}

hr2d_status hr2di_pair_visibility_init(hr2di_pair_visibility *s, const hr2d_scene *scene,
                                       hr2di_beam_cache *beam_cache,
                                       const hr2d_allocator *alloc, hr2di_watch *watch) {
  const hr2di_triangulation *t = &scene->plane.triangulation;
  *s =
      (hr2di_pair_visibility){.tracer = hr2di_beam_tracer_make(scene, beam_cache, alloc, watch),
                              .all.alloc = *alloc,
                              .turned.alloc = *alloc};
  s->tracer.take = keep;
  s->tracer.ctx = s;
  s->last = hr2di_alloc_zero(alloc, t->edges, 2 * sizeof *s->last);
  return s->last ? HR2D_OK : HR2D_ENOMEM;
}

void hr2di_pair_visibility_clear(hr2di_pair_visibility *s) {
  const hr2d_allocator *alloc = &s->tracer.walk.alloc;
  hr2di_beam_tracer_clear(&s->tracer);
  hr2di_line_class_list_clear(&s->all);
  hr2di_line_class_list_clear(&s->turned);
  hr2di_alloc_free(alloc, s->next);
  hr2di_alloc_free(alloc, s->side);
  hr2di_alloc_free(alloc, s->last);
}

/* Looks for line classes of all patches, or at least of `later` ones. */
static hr2d_status view_from(hr2di_pair_visibility *s, uint32_t patch, int later) {
  if (s->looked == patch + 1 && (later || !s->later)) return HR2D_OK;
  hr2d_status status = hr2di_watch_work(s->tracer.walk.watch, 1 + s->all.count / 16);
  for (size_t k = 0; k < s->all.count; k++) s->last[s->side[k]] = 0;
  hr2di_line_class_list_cut(&s->all, 0);
  s->looked = s->taken = 0;
  if (!status) status = hr2di_beam_tracer_trace(&s->tracer, patch, later);
  if (status) return status;
  s->looked = patch + 1;
  s->later = later;
  return HR2D_OK;
}

/* Copies the line classes that end along a patch, turned round if that is the near one; links
   of the same two patches follow each other, and take the same ones. */
static hr2d_status take(hr2di_pair_visibility *s, uint32_t patch, int turn) {
  const hr2di_side_parts *p = &s->tracer.scene->parts;
  hr2d_status status = HR2D_OK;
  const hr2di_parts of = p->of_patch[patch];
  if (s->taken == patch + 1) return HR2D_OK;
  s->taken = 0;
  hr2di_line_class_list_cut(&s->turned, 0);
  for (uint32_t k = of.first; k < of.last; k++) {
    if (p->part[k].side == HR2DI_HIDDEN) continue;
    for (uint32_t m = s->last[p->part[k].side]; m > 0 && !status; m = s->next[m - 1]) {
      hr2di_line_class_list *to = &s->turned;
      status = hr2di_line_class_list_copy(to, &s->all, m - 1, m);
      if (!status && turn) hr2di_line_class_list_turn(to, to->count - 1);
      if (!status) status = hr2di_watch_work(s->tracer.walk.watch, 1);
    }
  }
  hr2di_line_class_list_sort(&s->turned);
  if (!status) s->taken = patch + 1;
  return status;
}

/* Whether parts of two patches lie face to face within roundings. */
static int in_contact(const hr2di_side_parts *p, uint32_t i, uint32_t j) {
  for (size_t k = hr2di_side_parts_contact(p, p->of_patch[i].first);
       k < p->contacts && p->contact[k].part < p->of_patch[i].last; k++)
    if (p->part[p->contact[k].other].patch == j) return 1;
  return 0;
}

/* Patches in contact see each other as if nothing else were there. */
static hr2d_status add_contact(hr2di_line_class_list *list, hr2d_segment near,
                               hr2d_segment far) {
  const hr2d_point left[] = {near.a, far.b}, right[] = {near.b, far.a};
  const hr2di_line_class all = {left, right, 2, 2,
                                HR2DI_LINE_CLASS_A | HR2DI_LINE_CLASS_B | HR2DI_LINE_CLASS_C |
                                    HR2DI_LINE_CLASS_D};
  return hr2di_line_class_list_add(list, &all, near, far);
}

hr2d_status hr2di_pair_visibility_look(hr2di_pair_visibility *s, uint32_t from, uint32_t to) {
  return in_contact(&s->tracer.scene->parts, from, to) ? HR2D_OK
                                                       : view_from(s, from, from < to);
}

hr2d_status hr2di_pair_visibility_between(hr2di_pair_visibility *s,
                                          const hr2di_patch_pair *pair,
                                          hr2di_line_class_list *list,
                                          hr2di_line_class_list *whole) {
  const int turn = pair->patch[0] > pair->patch[1];
  if (in_contact(&s->tracer.scene->parts, pair->patch[0], pair->patch[1]))
    return add_contact(list, pair->part[turn], pair->part[!turn]);
  hr2d_status status = view_from(s, pair->patch[0], !turn);
  if (status || s->all.count == 0) return status;
  status = take(s, pair->patch[1], turn);
  if (!status) status = hr2di_watch_work(s->tracer.walk.watch, s->turned.count);
  if (status || s->turned.count == 0) return status;
  s->restricted += s->turned.count;
  return hr2di_line_class_list_restrict(list, &s->turned, 0, s->turned.count, pair->part[turn],
                                        pair->part[!turn], whole);
}

static double length_along(hr2d_segment part, hr2d_segment whole) {
  return hr2di_point_along(whole, part.b) - hr2di_point_along(whole, part.a);
}

/* Ends of parts are moved onto vertices by at most 4 units in the last place. */
#define MOVED 0x1p-49

/* A clear line class has all lines between its parts of the two segments.  Walls may cut the
   segments in several parts.  What they leave out is roundings of the ends of parts, and never
   what lies beyond the foot of a wall: elements below this pair are not looked at again. */
hr2di_visibility_class hr2di_line_classes_classify(const hr2di_line_class_list *list,
                                                   size_t first, hr2d_segment near,
                                                   hr2d_segment far) {
  const double of_near = length_along(near, near), of_far = length_along(far, far);
  const double moved = 2 * MOVED * (double)(list->count - first);
  double whole = 0;
  if (first == list->count) return HR2DI_BLOCKED;
  for (size_t k = first; k < list->count; k++) {
    const hr2di_line_class s = hr2di_line_class_list_at(list, k);
    if (!hr2di_line_class_clear(&s)) return HR2DI_PARTIAL;
    whole += length_along(list->line_class[k].near, near) / of_near *
             (length_along(list->line_class[k].far, far) / of_far);
  }
  return 1 - whole < fmin(moved / of_near + moved / of_far, 0x1p-16) ? HR2DI_CLEAR
                                                                     : HR2DI_PARTIAL;
}

uint64_t hr2di_pair_visibility_tests(const hr2di_pair_visibility *s) {
  return s->tracer.steps + s->restricted;
}

uint64_t hr2di_pair_visibility_bytes(const hr2di_pair_visibility *s) {
  return hr2di_walk_bytes(&s->tracer.walk) + hr2di_line_class_list_bytes(&s->all) +
         hr2di_line_class_list_bytes(&s->turned) + s->next_capacity * sizeof *s->next +
         s->side_capacity * sizeof *s->side;
}
