/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Discontinuity meshing (Lischinski, Tampieri, Greenberg 1992) in the plane: finds every line
   through two vertices on which light passes between them, and on beyond one of them.  A foot,
   where a wall ends on a patch, is an event, too: light of one side does not reach the other
   side. */
#include "mesh/events.h"

#include <math.h>

#include "base/alloc.h"
#include "base/share.h"
#include "geometry/vector.h"
#include "mesh/event-list.h"
#include "mesh/events-impl.h"
#include "scene/with-plane.h"

/* Of what light that passes an end beside the patch makes. */
#define LARGEST 1e100

typedef hr2di_event_candidate candidate;

typedef struct finder {
  const hr2d_scene *scene;
  hr2d_allocator alloc;
  hr2d_share *share; /* NULL, or one of several */
  hr2di_watch *watch;
  hr2di_event_beams beams;
  const candidate *from; /* the event that is looked from; NULL in generation 1 */
  unsigned generation;   /* of what is found now */
  candidate *origin;     /* events of the generation before */
  size_t origins, origin_capacity;
  hr2di_event_list list;
} finder;

/* The sine of the angle between a vector and a patch. */
static double sine_to(const hr2d_scene *scene, uint32_t patch, hr2d_point v) {
  const hr2d_segment s = scene->patch[patch].scaled;
  const hr2d_point u = hr2di_point_minus(s.b, s.a);
  return fabs(u.x * v.y - u.y * v.x) / scene->patch[patch].length / hypot(v.x, v.y);
}

/* While x moves, the line through u turns by cos θ dx/|xu|, and y moves by |uy|/cos θ_y of
   that. B(y) is seen in the part ½ cos²θ/|xu| of dH/dx. */
static double spread_to(const finder *f, hr2d_point x, uint32_t patch, hr2d_point u) {
  const hr2d_point y = f->beams.at, xy = hr2di_point_minus(y, x);
  const double xu = hypot(u.x - x.x, u.y - x.y), uy = hypot(y.x - u.x, y.y - u.y);
  const double cosine = sine_to(f->scene, patch, xy);
  const double seen = 0.5 * cosine * cosine / xu;
  if (!f->from) return seen;
  const double move = cosine * uy / (xu * sine_to(f->scene, f->from->event.patch, xy));
  return seen * pow(move, (double)f->generation - 1);
}

/* At a foot, which is looked past no vertex, H itself jumps. */
static hr2di_event event_at(const finder *f, uint32_t patch, double at, uint32_t via) {
  hr2di_event e = {.patch = patch, .at = at, .generation = f->generation, .spread = LARGEST};
  if (f->from) {
    e.origin = f->from->event.patch;
    e.origin_at = f->from->event.at;
  }
  e.past = hr2di_point_at(f->scene->patch[patch].scaled, at);
  if (via == HR2DI_NO_VERTEX) return e;
  const double spread = spread_to(f, e.past, patch, f->beams.in->at[via]);
  e.past = f->beams.in->at[via];
  if (spread < LARGEST) e.spread = spread;
  return e;
}

static hr2d_status add(finder *f, uint32_t patch, double at, uint32_t via) {
  if (!(at > 0 && at < 1) || !hr2di_scene_lit(f->scene, patch)) return HR2D_OK;
  const candidate c = {event_at(f, patch, at, via), via};
  return hr2di_event_list_add(&f->list, &c);
}

/* Generation 0: at a border of sunlight H jumps. */
static hr2d_status add_borders(finder *f) {
  const hr2di_sunlight *l = &f->scene->sunlight;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < l->borders && !status; k++) {
    status = hr2di_watch_work(f->watch, 1);
    if (!status) status = add(f, l->border[k].patch, l->border[k].at, HR2DI_NO_VERTEX);
  }
  return status;
}

static hr2d_status take(void *ctx, uint32_t patch, double at, uint32_t via) {
  return add(ctx, patch, at, via);
}

static int reflects(const hr2d_scene *scene, size_t patch) {
  for (size_t band = 0; band < scene->bands; band++)
    if (hr2di_scene_scattered(scene, patch, band) > 0) return 1;
  return 0;
}

/* Where patches of one side meet there is something to see on that side only. */
static hr2d_status view_from_joints(finder *f, hr2di_wall_side side) {
  const hr2di_side_part *part = f->scene->parts.part;
  const hr2di_parts of = f->scene->parts.of_side[side].parts;
  hr2d_status status = HR2D_OK;
  for (uint32_t k = of.first; k + 1 < of.last && !status; k++)
    status = hr2di_event_beams_from_part(&f->beams, part[k].at.b, &part[k], HR2DI_NO_VERTEX);
  return status;
}

/* Looks from one of so many origins. */
typedef hr2d_status trace_fn(finder *f, size_t origin);

/* Looks from all origins; each share from a run of them. */
static hr2d_status trace_from_all(finder *f, size_t origins, trace_fn *trace) {
  const hr2d_share *share = f->share;
  const size_t before = f->list.count;
  hr2d_status status = HR2D_OK;
  int again = 1;
  if (share) {
    const size_t from = hr2di_share_part(origins, share->number, share->count);
    const size_t to = hr2di_share_part(origins, share->number + 1, share->count);
    f->list.in_part = 1;
    for (size_t k = from; k < to && !status; k++) status = trace(f, k);
    if (!status) status = hr2di_watch_status(f->watch);
    status = hr2di_event_list_collect(&f->list, f->share, status, before, &again);
  }
  for (size_t k = 0; k < origins && again && !status; k++) status = trace(f, k);
  return status;
}

static hr2d_status view_from_side(finder *f, hr2di_wall_side s) {
  const hr2di_triangulation *t = &f->scene->plane.triangulation;
  const int32_t h = t->edge[s >> 1].half_edge[s & 1];
  const hr2d_status status = hr2di_watch_work(f->watch, 1);
  if (status || t->triangle[h >> 2].across[h & 3] != ~(int32_t)s) return status;
  const hr2d_status looked = hr2di_event_beams_from_vertex(&f->beams, s);
  return looked ? looked : view_from_joints(f, s);
}

/* Generation 1: all lines through ends of patches, from sides and then along walls. */
static hr2d_status view_from_end(finder *f, size_t k) {
  const size_t sides = 2 * f->scene->plane.triangulation.edges;
  if (k < sides) return view_from_side(f, (hr2di_wall_side)k);
  const size_t end = k - sides;
  return hr2di_event_beams_along_wall(&f->beams, (uint32_t)(end / 2), (int)(end % 2));
}

static hr2d_status view_from_ends(finder *f) {
  f->generation = 1;
  return trace_from_all(
      f, 2 * f->scene->plane.triangulation.edges + 2 * (size_t)f->scene->walls.walls,
      view_from_end);
}

/* The part of a patch at a point of its line. */
static const hr2di_side_part *part_at(const hr2d_scene *scene, uint32_t patch, hr2d_point p) {
  const hr2d_segment s = scene->patch[patch].scaled;
  const hr2di_parts of = scene->parts.of_patch[patch];
  const double at = hr2di_point_along(s, p);
  uint32_t low = of.first, high = of.last;
  while (high - low > 1) {
    const uint32_t middle = low + (high - low) / 2;
    if (hr2di_point_along(s, scene->parts.part[middle].at.a) <= at)
      low = middle;
    else
      high = middle;
  }
  return &scene->parts.part[low];
}

/* The events of a generation, where they show: B = E on a patch that does not reflect.  A foot
   is a vertex, and the first generation has looked from there. */
static hr2d_status find_origins(finder *f, unsigned generation) {
  hr2d_status status = HR2D_OK;
  f->origins = 0;
  for (size_t k = 0; k < f->list.count && !status; k++) {
    const candidate c = f->list.found[k];
    status = hr2di_watch_work(f->watch, 1 + f->scene->bands / 32);
    if (status || c.event.generation != generation ||
        (c.via == HR2DI_NO_VERTEX && !c.event.passed) || !reflects(f->scene, c.event.patch))
      continue;
    if (hr2di_alloc_reserve(&f->alloc, &f->origin, &f->origin_capacity, f->origins + 1,
                            sizeof *f->origin))
      return HR2D_ENOMEM;
    f->origin[f->origins++] = c;
  }
  return status;
}

static hr2d_status view_from_event(finder *f, size_t k) {
  const candidate c = f->origin[k];
  const hr2d_point at = hr2di_point_at(f->scene->patch[c.event.patch].scaled, c.event.at);
  f->from = &f->origin[k];
  const hr2di_side_part *part = part_at(f->scene, c.event.patch, at);
  return part->patch == c.event.patch && part->side != HR2DI_HIDDEN
             ? hr2di_event_beams_from_part(&f->beams, at, part, c.via)
             : HR2D_OK;
}

/* A later generation: all lines through events of the one before and ends of walls. */
static hr2d_status view_from_events(finder *f, unsigned generation) {
  const hr2d_status status = find_origins(f, generation - 1);
  f->generation = generation;
  return status ? status : trace_from_all(f, f->origins, view_from_event);
}

static hr2d_status view_from_border(finder *f, uint32_t patch, hr2d_point at) {
  if (!reflects(f->scene, patch)) return HR2D_OK;
  const hr2di_side_part *part = part_at(f->scene, patch, at);
  return part->patch == patch && part->side != HR2DI_HIDDEN
             ? hr2di_event_beams_from_part(&f->beams, at, part, HR2DI_NO_VERTEX)
             : HR2D_OK;
}

/* B jumps at a border of sunlight as it does at the end of a patch. */
static hr2d_status view_from_borders(finder *f) {
  const hr2di_sunlight *l = &f->scene->sunlight;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < l->borders && !status; k++) {
    const hr2di_sun_border *b = &l->border[k];
    const uint32_t other = (uint32_t)hr2di_scene_other_side(f->scene, b->patch);
    status = hr2di_watch_work(f->watch, 1 + f->scene->bands / 32);
    if (!status) status = view_from_border(f, b->patch, b->point);
    if (!status && other != b->patch) status = view_from_border(f, other, b->point);
  }
  return status;
}

/* What makes a kink in H on one side of a pane makes one in B on the other. */
static hr2d_status pass_through_panes(finder *f, unsigned generation) {
  const size_t count = f->list.count;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && f->scene->other_side && !status; k++) {
    hr2di_event e = f->list.found[k].event;
    const uint32_t other = (uint32_t)hr2di_scene_other_side(f->scene, e.patch);
    status = hr2di_watch_work(f->watch, 1);
    if (status || e.generation != generation || other == e.patch || e.passed) continue;
    e.origin = e.patch;
    e.origin_at = e.at;
    e.patch = other;
    e.at = 1 - e.at;
    e.passed = 1;
    status = hr2di_event_list_add(&f->list, &(candidate){e, HR2DI_NO_VERTEX});
  }
  return status || f->list.count == count ? status : hr2di_event_list_settle(&f->list);
}

/* H of the sky has a kink where the edge of a piece comes into sight.  Elements end there at
   any target, as at borders of sunlight: points of a rule may all miss a shadow between them.
 */
static hr2d_status add_kinks(finder *f) {
  const hr2di_sunlight *l = &f->scene->sunlight;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < l->kinks && !status; k++) {
    status = hr2di_watch_work(f->watch, 1);
    if (!status) status = add(f, l->kink[k].patch, l->kink[k].at, HR2DI_NO_VERTEX);
  }
  return status;
}

/* The fraction of s at which p, on it but for rounding, lies. */
static double fraction_of(hr2d_segment s, hr2d_point p) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  return ((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / (dx * dx + dy * dy);
}

/* Where a patch goes on from one side to the next and another wall stands between. */
static hr2d_status add_feet(finder *f) {
  const hr2di_triangulation *t = &f->scene->plane.triangulation;
  const hr2di_side_parts *parts = &f->scene->parts;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k + 1 < parts->parts && !status; k++) {
    const hr2di_side_part *p = &parts->part[k];
    status = hr2di_watch_work(f->watch, 1);
    if (status || p->patch == HR2DI_NOBODY || p[1].patch != p->patch || p->side == p[1].side ||
        p->side == HR2DI_HIDDEN || p[1].side == HR2DI_HIDDEN)
      continue;
    const int32_t h = hr2di_event_beams_turn(&f->beams, p->side);
    const hr2di_triangle *last = &t->triangle[h >> 2];
    if (last->across[h & 3] == ~(int32_t)p[1].side) continue;
    const hr2d_segment s = f->scene->patch[p->patch].scaled;
    status = add(f, p->patch, fraction_of(s, t->at[last->corner[h & 3]]), HR2DI_NO_VERTEX);
  }
  return status;
}

static hr2d_status find(finder *f, unsigned generations) {
  hr2d_status status = hr2di_event_beams_init(&f->beams, f->scene, &f->alloc, f->watch);
  f->beams.take = take;
  f->beams.ctx = f;
  if (!status) status = add_borders(f);
  if (!status && generations > 0) status = view_from_ends(f);
  if (!status && generations > 0) status = view_from_borders(f);
  if (!status) status = add_kinks(f);
  if (!status && generations > 0) status = add_feet(f);
  if (!status) status = hr2di_event_list_settle(&f->list);
  for (unsigned g = 0; g < 2 && !status; g++) status = pass_through_panes(f, g);
  for (unsigned g = 2; g <= generations && !status; g++) {
    status = view_from_events(f, g);
    if (!status && f->origins == 0) break;
    if (!status) status = hr2di_event_list_settle(&f->list);
    if (!status) status = pass_through_panes(f, g);
  }
  /* A walk that the watch has stopped ends nowhere. */
  return status ? status : hr2di_watch_status(f->watch);
}

hr2d_status hr2di_events_init(hr2di_events *events, const hr2d_scene *scene,
                              const hr2d_allocator *alloc, unsigned generations, size_t max,
                              hr2d_share *share, hr2di_watch *watch) {
  *events = (hr2di_events){.alloc = *alloc};
  if ((generations == 0 && scene->sunlight.borders + scene->sunlight.kinks == 0) ||
      !(scene->effect[HR2D_EFFECT_OCCLUSION].called_for ||
        scene->effect[HR2D_EFFECT_FACING].called_for ||
        scene->effect[HR2D_EFFECT_BACKGROUND].called_for))
    return HR2D_OK;
  hr2di_with_plane w;
  finder f = {.scene = &w.scene,
              .alloc = *alloc,
              .share = share && share->count > 1 ? share : NULL,
              .watch = watch,
              .list = {.alloc = *alloc, .watch = watch, .max = max}};
  hr2d_status status = hr2di_with_plane_init(&w, scene, alloc, watch);
  if (!status && w.scene.parts.wanted) status = find(&f, generations);
  events->steps = f.beams.between.steps + f.beams.turns;
  if (!status && hr2di_alloc_reserve(alloc, &events->event, &events->capacity, f.list.count,
                                     sizeof *events->event))
    status = HR2D_ENOMEM;
  for (size_t k = 0; k < f.list.count && !status; k++)
    events->event[events->count++] = f.list.found[k].event;
  hr2di_event_beams_clear(&f.beams);
  hr2di_alloc_free(alloc, f.origin);
  hr2di_alloc_free(alloc, f.list.found);
  hr2di_with_plane_clear(&w);
  return status;
}

void hr2di_events_clear(hr2di_events *events) {
  hr2di_alloc_free(&events->alloc, events->event);
  *events = (hr2di_events){.alloc = events->alloc};
}
