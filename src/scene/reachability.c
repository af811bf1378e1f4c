/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the patches that light can reach: from a source over a chain of patches, each of which
   sees the next.  No other patch needs a link.

   A flood over sides of wall edges: beams leave a side with lit patches whose light has not
   been sent yet, all of them in one walk.  The lines of a line class that leave a stretch of
   the side arrive on a stretch of another side, whose ends two binary searches find: all parts
   there are lit.  Parts that are lit already are skipped.

   Beams stay in one face of the plane, a set of triangles with free edges between them.  A side
   in a face without dark patches sends none. */
#include "base/alloc.h"
#include "base/union-find.h"
#include "scene/scene-impl.h"

#define NO_PART UINT32_MAX

typedef struct flood {
  hr2d_scene *scene;
  uint32_t *face;               /* per triangle: the least triangle in its face */
  uint32_t *darkness;           /* per triangle that is a face: dark parts in it */
  uint32_t *first_of, *next_of; /* parts of a patch: the first, and the next behind a part */
  uint32_t *pending;            /* patches whose light has not reached their parts */
  uint32_t *dark_from;  /* per part: union-find to the next dark part, or the number of parts */
  unsigned char *fresh; /* per part: lit, with light that has not been sent */
  unsigned char *wanted;  /* per side: it has dark parts */
  unsigned char *queued;  /* per side */
  hr2di_wall_side *queue; /* sides with fresh parts */
  size_t sides, waiting;
  uint64_t sent;       /* sides so far */
  size_t dark;         /* patches */
  hr2di_parts stretch; /* from which light is sent, of `side` */
  hr2di_wall_side side;
  hr2di_walk walk;
  hr2d_point *room;
  size_t points;
} flood;

static int emits(const hr2d_scene *scene, size_t patch) {
  for (size_t band = 0; band < scene->bands; band++)
    if (hr2d_scene_emission(scene, patch, band) != 0) return 1;
  return 0;
}

/* Whether no search is needed: every patch emits, light from the background or the gas may come
   to any patch, or the effect of emission is forced. */
static int all_lit(const hr2d_scene *scene) {
  if (scene->effect[HR2D_EFFECT_EMISSION].forced ||
      scene->effect[HR2D_EFFECT_BACKGROUND].called_for || hr2di_scene_gas_emits(scene) ||
      hr2di_scene_has_free_gas(scene))
    return 1;
  size_t k = 0;
  while (k < scene->patches && emits(scene, k)) k++;
  return k == scene->patches;
}

static uint32_t face_of(const flood *f, hr2di_wall_side side) {
  const hr2di_wall_edge *e = &f->scene->plane.triangulation.edge[side >> 1];
  return f->face[e->half_edge[side & 1] >> 2];
}

static hr2d_status find_faces(flood *f) {
  const hr2di_triangulation *t = &f->scene->plane.triangulation;
  hr2d_status status = HR2D_OK;
  for (uint32_t k = 0; k < t->triangles; k++) f->face[k] = k;
  for (uint32_t k = 0; k < t->triangles && !status; k++) {
    if (k % 16 == 0) status = hr2di_watch_work(f->walk.watch, 8);
    for (int e = 0; e < 3; e++)
      if (t->triangle[k].across[e] >= 0)
        hr2di_union_join(f->face, k, (uint32_t)t->triangle[k].across[e] >> 2);
  }
  for (uint32_t k = 0; k < t->triangles && !status; k++) {
    if (k % 16 == 0) status = hr2di_watch_work(f->walk.watch, 2);
    f->face[k] = hr2di_union_find(f->face, k);
  }
  return status;
}

static hr2d_status reserve(flood *f) {
  const hr2d_allocator *alloc = &f->scene->alloc;
  const hr2di_triangulation *t = &f->scene->plane.triangulation;
  const size_t parts = f->scene->parts.parts, patches = f->scene->patches;
  f->sides = 2 * t->edges;
  f->face = hr2di_alloc(alloc, t->triangles, sizeof *f->face);
  f->darkness = hr2di_alloc_zero(alloc, t->triangles, sizeof *f->darkness);
  f->first_of = hr2di_alloc(alloc, patches, sizeof *f->first_of);
  f->next_of = hr2di_alloc(alloc, parts, sizeof *f->next_of);
  f->pending = hr2di_alloc(alloc, patches, sizeof *f->pending);
  f->dark_from = hr2di_alloc(alloc, parts + 1, sizeof *f->dark_from);
  f->fresh = hr2di_alloc_zero(alloc, parts, 1);
  f->wanted = hr2di_alloc_zero(alloc, f->sides, 1);
  f->queued = hr2di_alloc_zero(alloc, f->sides, 1);
  f->queue = hr2di_alloc(alloc, f->sides, sizeof *f->queue);
  return f->face && f->darkness && f->first_of && f->next_of && f->pending && f->dark_from &&
                 f->fresh && f->wanted && f->queued && f->queue
             ? HR2D_OK
             : HR2D_ENOMEM;
}

static void enqueue(flood *f, hr2di_wall_side side) {
  if (f->queued[side]) return;
  f->queued[side] = 1;
  f->queue[f->waiting++] = side;
}

/* Sources are lit, the others dark. */
static hr2d_status begin(flood *f) {
  const hr2di_side_parts *p = &f->scene->parts;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < f->scene->patches; k++) {
    f->scene->dark[k] = !emits(f->scene, k);
    f->dark += f->scene->dark[k];
    f->first_of[k] = NO_PART;
  }
  f->dark_from[p->parts] = (uint32_t)p->parts;
  for (uint32_t k = (uint32_t)p->parts; k-- > 0 && !status;) {
    const uint32_t patch = p->part[k].patch;
    const hr2di_wall_side side = p->part[k].side;
    if (k % 16 == 0) status = hr2di_watch_work(f->walk.watch, 4);
    f->dark_from[k] = k + 1;
    if (patch == HR2DI_NOBODY) continue;
    f->next_of[k] = f->first_of[patch];
    f->first_of[patch] = k;
    if (side == HR2DI_HIDDEN) continue;
    if (f->scene->dark[patch]) {
      f->dark_from[k] = k;
      f->wanted[side] = 1;
      f->darkness[face_of(f, side)]++;
    } else {
      f->fresh[k] = 1;
      enqueue(f, side);
    }
  }
  return status;
}

/* A part of a lit patch, which was dark. */
static void light_part(flood *f, uint32_t k) {
  const hr2di_wall_side side = f->scene->parts.part[k].side;
  const hr2di_parts all = f->scene->parts.of_side[side].parts;
  f->dark_from[k] = k + 1;
  f->fresh[k] = 1;
  f->darkness[face_of(f, side)]--;
  f->wanted[side] = hr2di_union_find(f->dark_from, all.first) < all.last;
  enqueue(f, side);
}

/* The patches in contact with a hidden part of a lit patch become pending. */
static size_t light_contacts(flood *f, uint32_t part, size_t pending) {
  const hr2di_side_parts *p = &f->scene->parts;
  for (size_t k = hr2di_side_parts_contact(p, part);
       k < p->contacts && p->contact[k].part == part; k++) {
    const uint32_t patch = p->part[p->contact[k].other].patch;
    if (!f->scene->dark[patch]) continue;
    f->scene->dark[patch] = 0;
    f->pending[pending++] = patch;
  }
  return pending;
}

/* So does the other side of a lit pane. */
static size_t light_other_side(flood *f, uint32_t patch, size_t pending) {
  const size_t other = hr2di_scene_other_side(f->scene, patch);
  if (!f->scene->dark[other]) return pending;
  f->scene->dark[other] = 0;
  f->pending[pending] = (uint32_t)other;
  return pending + 1;
}

static void light_pending(flood *f, size_t pending) {
  while (pending > 0) {
    const uint32_t patch = f->pending[--pending];
    f->dark--;
    pending = light_other_side(f, patch, pending);
    for (uint32_t k = f->first_of[patch]; k != NO_PART; k = f->next_of[k])
      if (f->scene->parts.part[k].side == HR2DI_HIDDEN)
        pending = light_contacts(f, k, pending);
      else
        light_part(f, k);
  }
}

static void light_up(flood *f, uint32_t patch) {
  f->scene->dark[patch] = 0;
  f->pending[0] = patch;
  light_pending(f, 1);
}

/* Light from hidden parts of sources, and through those that are panes. */
static hr2d_status begin_contacts(flood *f) {
  const hr2di_side_parts *p = &f->scene->parts;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < f->scene->patches && f->scene->other_side && !status; k++) {
    status = hr2di_watch_work(f->walk.watch, 1);
    if (emits(f->scene, k)) light_pending(f, light_other_side(f, (uint32_t)k, 0));
  }
  for (size_t k = 0; k < p->contacts && !status; k++) {
    status = hr2di_watch_work(f->walk.watch, 1);
    if (emits(f->scene, p->part[p->contact[k].part].patch))
      light_pending(f, light_contacts(f, p->contact[k].part, 0));
  }
  return status;
}

/* Which of the parts along the far side some line of a line class meets. */
static hr2di_parts met(const flood *f, const hr2di_line_class *s, hr2di_parts all) {
  const hr2di_side_part *part = f->scene->parts.part;
  hr2di_line_class child;
  hr2di_parts found = all;
  for (uint32_t high = all.last - 1; found.first < high;) {
    const uint32_t middle = found.first + (high - found.first) / 2;
    if (hr2di_line_class_restrict(s, HR2DI_LINE_CLASS_D, part[middle].at.b, f->room, &child))
      high = middle;
    else
      found.first = middle + 1;
  }
  for (uint32_t low = found.first + 1; low < found.last;) {
    const uint32_t middle = low + (found.last - low) / 2;
    if (hr2di_line_class_restrict(s, HR2DI_LINE_CLASS_C, part[middle].at.a, f->room, &child))
      low = middle + 1;
    else
      found.last = middle;
  }
  return found;
}

/* Leaves the lines from the stretch that is sent from, with points in *room; 0 if there are
   none. */
static int trim(const flood *f, hr2di_line_class *s, hr2d_point **room) {
  const hr2di_side_part *part = f->scene->parts.part;
  const hr2di_parts all = f->scene->parts.of_side[f->side].parts, own = f->stretch;
  hr2di_line_class child;
  if (own.first > all.first) {
    if (!hr2di_line_class_restrict(s, HR2DI_LINE_CLASS_A, part[own.first].at.a, *room, &child))
      return 0;
    *s = child;
    *room += child.lefts + child.rights;
  }
  if (own.last < all.last) {
    if (!hr2di_line_class_restrict(s, HR2DI_LINE_CLASS_B, part[own.last - 1].at.b, *room,
                                   &child))
      return 0;
    *s = child;
    *room += child.lefts + child.rights;
  }
  return 1;
}

/* Lights the dark parts that a line class ends on.  Each restriction has room for one point
 * more. */
static hr2d_status take(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  flood *f = ctx;
  const hr2di_parts all = f->scene->parts.of_side[j].parts;
  hr2di_line_class own = *s;
  if (hr2di_alloc_reserve(&f->scene->alloc, &f->room, &f->points,
                          3 * (s->lefts + s->rights + 3), sizeof *f->room))
    return HR2D_ENOMEM;
  if (!f->wanted[j]) return HR2D_OK;
  hr2d_point *const start = f->room, *free = start;
  if (!trim(f, &own, &free)) return HR2D_OK;
  f->room = free;
  const hr2di_parts lit = met(f, &own, all);
  f->room = start;
  hr2d_status status = hr2di_watch_work(f->walk.watch, 4 + (own.lefts + own.rights) / 4);
  for (uint32_t k = lit.first; !status; k++) {
    k = hr2di_union_find(f->dark_from, k);
    if (k >= lit.last) break;
    light_up(f, f->scene->parts.part[k].patch);
    status = hr2di_watch_work(f->walk.watch, 1);
  }
  return status;
}

/* The next stretch of fresh parts from number `first` on; empty if there is none. */
static hr2di_parts next_stretch(flood *f, uint32_t first, uint32_t last) {
  while (first < last && !f->fresh[first]) first++;
  hr2di_parts stretch = {first, first};
  while (stretch.last < last && f->fresh[stretch.last]) f->fresh[stretch.last++] = 0;
  return stretch;
}

/* Sends the fresh light of a side. */
static hr2d_status send(flood *f, hr2di_wall_side side) {
  const hr2di_side_part *part = f->scene->parts.part;
  const hr2di_parts all = f->scene->parts.of_side[side].parts;
  const uint32_t face = face_of(f, side);
  hr2d_status status = hr2di_watch_work(f->walk.watch, 1 + (all.last - all.first) / 16);
  f->side = side;
  for (uint32_t k = all.first; k < all.last && f->darkness[face] > 0 && !status;
       k = f->stretch.last) {
    f->stretch = next_stretch(f, k, all.last);
    if (f->stretch.first == f->stretch.last) break;
    const hr2d_segment at = {part[f->stretch.first].at.a, part[f->stretch.last - 1].at.b};
    const int whole = f->stretch.first == all.first && f->stretch.last == all.last;
    status = hr2di_walk_from(&f->walk, side, whole ? NULL : &at);
  }
  return status;
}

/* Takes a side out of the queue: every eighth from anywhere, as sides that were lit one after
   the other see much the same; else the last one, which is near to the one before. */
static hr2di_wall_side dequeue(flood *f) {
  const uint64_t golden = UINT64_C(0x9e3779b97f4a7c15);
  const size_t last = --f->waiting;
  size_t pick = last;
  if (f->sent++ % 8 == 0) pick = (size_t)((f->sent * golden >> 32) * (last + 1) >> 32);
  const hr2di_wall_side side = f->queue[pick];
  f->queue[pick] = f->queue[last];
  f->queued[side] = 0;
  return side;
}

static hr2d_status spread(flood *f) {
  hr2d_status status = HR2D_OK;
  while (f->waiting > 0 && f->dark > 0 && !status) status = send(f, dequeue(f));
  return status;
}

static void clear(flood *f) {
  const hr2d_allocator *alloc = &f->scene->alloc;
  void *const block[] = {f->face,      f->darkness, f->first_of, f->next_of,
                         f->dark_from, f->fresh,    f->wanted,   f->queued,
                         f->queue,     f->room,     f->pending};
  for (size_t k = 0; k < sizeof block / sizeof *block; k++) hr2di_alloc_free(alloc, block[k]);
  hr2di_walk_clear(&f->walk);
}

static hr2d_status find_dark(hr2d_scene *scene, hr2di_watch *watch) {
  flood f = {.scene = scene};
  scene->dark = hr2di_alloc_zero(&scene->alloc, scene->patches, 1);
  hr2d_status status = scene->dark ? reserve(&f) : HR2D_ENOMEM;
  f.walk = (hr2di_walk){.in = &scene->plane.triangulation,
                        .wanted = f.wanted,
                        .take = take,
                        .ctx = &f,
                        .alloc = scene->alloc,
                        .watch = watch};
  if (!status) status = find_faces(&f);
  if (!status) status = begin(&f);
  if (!status) status = begin_contacts(&f);
  if (!status) status = spread(&f);
  clear(&f);
  if (status || f.dark == 0) {
    hr2di_alloc_free(&scene->alloc, scene->dark);
    scene->dark = NULL;
  }
  return status;
}

/* Where nobody knows how walls cross, no patch counts as dark. */
hr2d_status hr2di_scene_find_light(hr2d_scene *scene, hr2di_watch *watch) {
  if (all_lit(scene)) return HR2D_OK;
  /* Light may come from farther than the images that are there. */
  if (scene->symmetry.motion && scene->symmetry.by.periodic) return HR2D_OK;
  hr2d_status status = hr2di_scene_need_plane(scene, watch);
  if (!status && scene->parts.wanted) status = find_dark(scene, watch);
  return status ? hr2di_scene_fail(scene, status, watch, "the analysis") : HR2D_OK;
}
