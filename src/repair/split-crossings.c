/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts patches that cross into pieces that touch.  Patches that share a stretch within rounding
   are cut at its ends, too, so that other cuts do not bend them apart: patches back to back are
   then exactly back to back. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/crossings.h"
#include "geometry/cut-points.h"
#include "geometry/orient-sign.h"
#include "geometry/vector.h"
#include "scene/patch-light.h"
#include "scene/scene-impl.h"

/* Rounded points bend the pieces, so that a piece may go through others by a rounding more than
   before.  The next round cuts them there, at points that exist already.  Two or three rounds
   are enough, up to ten for bundles of patches a few roundings apart.  It is not proved that
   this always ends.  A patch has each wall once (see drop_loops()), so that pieces are no more
   than patches × walls in any round. */
#define MOST_ROUNDS 32

typedef struct piece {
  hr2d_segment s; /* scaled */
  size_t patch;
  int left_out;
} piece;

typedef struct splitter {
  hr2d_scene *scene;
  const hr2d_allocator *alloc;
  piece *piece; /* ordered by patch, then along its direction */
  size_t pieces, capacity;
  piece *cut_piece; /* the pieces of the next round */
  size_t cut_pieces, cut_capacity;
  hr2di_cut_wall *wall; /* the undirected segments of pieces, each once */
  size_t *wall_of;      /* per piece: its wall */
  size_t walls;
  hr2di_cuts cuts;
} splitter;

static hr2d_segment undirected(hr2d_segment s) {
  return hr2di_point_order(s.a, s.b) <= 0 ? s : (hr2d_segment){s.b, s.a};
}

static int is_same(hr2d_segment s, hr2d_segment t) {
  return hr2di_point_order(s.a, t.a) == 0 && hr2di_point_order(s.b, t.b) == 0;
}

static int side_of(const hr2d_segment *s) {
  return hr2di_point_order(s->a, s->b) < 0 ? HR2DI_FORWARD : HR2DI_BACKWARD;
}

typedef struct place {
  hr2d_segment s;
  size_t piece;
} place;

static int by_segment(const void *left, const void *right) {
  const place *l = left, *r = right;
  const int a = hr2di_point_order(l->s.a, r->s.a), b = hr2di_point_order(l->s.b, r->s.b);
  if (a || b) return a ? a : b;
  return (l->piece > r->piece) - (l->piece < r->piece);
}

/* Patches back to back are one wall, so that both are cut at the same points. */
static hr2d_status make_walls(splitter *p) {
  place *sorted = hr2di_alloc(p->alloc, p->pieces, sizeof *sorted);
  hr2di_alloc_free(p->alloc, p->wall);
  hr2di_alloc_free(p->alloc, p->wall_of);
  p->wall = hr2di_alloc(p->alloc, p->pieces, sizeof *p->wall);
  p->wall_of = hr2di_alloc(p->alloc, p->pieces, sizeof *p->wall_of);
  p->walls = 0;
  hr2d_status status = sorted && p->wall && p->wall_of ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = 0; k < p->pieces && !status; k++)
    sorted[k] = (place){undirected(p->piece[k].s), k};
  if (!status)
    status = hr2di_sort(sorted, p->pieces, sizeof *sorted, by_segment, p->cuts.watch);
  for (size_t k = 0; k < p->pieces && !status; k++) {
    const hr2d_segment s = sorted[k].s;
    if (k == 0 || !is_same(s, sorted[k - 1].s)) p->wall[p->walls++] = (hr2di_cut_wall){s, 0};
    p->wall[p->walls - 1].sides |= side_of(&p->piece[sorted[k].piece].s);
    p->wall_of[sorted[k].piece] = p->walls - 1;
  }
  hr2di_alloc_free(p->alloc, sorted);
  return status;
}

/* Cuts a rounding beside a wall bend the pieces of a patch to and fro.  Where they come back to
   a wall that the patch has already, the loop is left out: all from the first piece there to
   the last, which is kept if both run the same way.  Without this, pieces can double in each
   round, between the same few points (fuzz/corpus/api/loops). */
static hr2d_status drop_loops(splitter *p) {
  size_t *latest = hr2di_alloc_zero(p->alloc, p->walls, sizeof *latest), kept = 0;
  size_t *next = hr2di_alloc(p->alloc, p->pieces, sizeof *next);
  hr2d_status status = latest && next ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = p->pieces; k-- > 0 && !status;) {
    const size_t wall = p->wall_of[k], last = latest[wall]; /* 1 + the last piece there; 0 */
    const int again = last > 0 && p->piece[last - 1].patch == p->piece[k].patch;
    if (!again) latest[wall] = k + 1;
    next[k] = !again ? k : is_same(p->piece[k].s, p->piece[last - 1].s) ? last - 1 : last;
    status = hr2di_watch_work(p->cuts.watch, 1);
  }
  for (size_t k = 0; k < p->pieces && !status;) {
    if (next[k] == k)
      p->piece[kept++] = p->piece[k++];
    else
      k = next[k];
  }
  if (!status) p->pieces = kept;
  hr2di_alloc_free(p->alloc, latest);
  hr2di_alloc_free(p->alloc, next);
  return status;
}

static hr2d_status push(splitter *p, hr2d_point a, hr2d_point b, size_t patch) {
  if (hr2di_alloc_reserve(p->alloc, &p->cut_piece, &p->cut_capacity, p->cut_pieces + 1,
                          sizeof *p->cut_piece))
    return HR2D_ENOMEM;
  p->cut_piece[p->cut_pieces++] = (piece){{a, b}, patch, 0};
  return HR2D_OK;
}

static hr2d_status cut_one(splitter *p, size_t k) {
  const piece whole = p->piece[k];
  const hr2di_cut_range own = p->cuts.of[p->wall_of[k]];
  const int forward = side_of(&whole.s) == HR2DI_FORWARD;
  hr2d_point from = whole.s.a;
  for (size_t m = 0; m < own.end - own.first; m++) {
    const hr2d_point at = p->cuts.cut[forward ? own.first + m : own.end - 1 - m].at;
    if (push(p, from, at, whole.patch)) return HR2D_ENOMEM;
    from = at;
  }
  return push(p, from, whole.s.b, whole.patch);
}

/* Takes the pieces that were cut for the next round. */
static void exchange_pieces(splitter *p) {
  piece *const pieces = p->piece;
  const size_t capacity = p->capacity;
  p->piece = p->cut_piece;
  p->pieces = p->cut_pieces;
  p->capacity = p->cut_capacity;
  p->cut_piece = pieces;
  p->cut_capacity = capacity;
}

static hr2d_status cut_all(splitter *p) {
  p->cut_pieces = 0;
  for (size_t k = 0; k < p->pieces; k++) {
    const hr2d_status status = hr2di_watch_work(p->cuts.watch, 1);
    if (status) return status;
    if (cut_one(p, k)) return HR2D_ENOMEM;
  }
  exchange_pieces(p);
  return HR2D_OK;
}

static int is_whole(const splitter *p, size_t k) {
  const size_t patch = p->piece[k].patch;
  return (k == 0 || p->piece[k - 1].patch != patch) &&
         (k + 1 == p->pieces || p->piece[k + 1].patch != patch);
}

static int by_x(const void *left, const void *right) {
  return hr2di_point_order(*(const hr2d_point *)left, *(const hr2d_point *)right);
}

/* Makes a list of the ends of all patches, by x. */
static hr2d_status sort_ends(const splitter *p, hr2d_point **made) {
  const hr2d_scene *scene = p->scene;
  hr2d_point *end = *made = hr2di_alloc(p->alloc, scene->patches, 2 * sizeof *end);
  if (!end) return HR2D_ENOMEM;
  for (size_t k = 0; k < scene->patches; k++) {
    end[2 * k] = scene->patch[k].scaled.a;
    end[2 * k + 1] = scene->patch[k].scaled.b;
  }
  return hr2di_sort(end, 2 * scene->patches, sizeof *end, by_x, p->cuts.watch);
}

/* The first of `count` ends whose x is not below `x`. */
static size_t first_end(const hr2d_point *end, size_t count, double x) {
  size_t low = 0, high = count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (end[middle].x < x)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Pushes a piece.  If it bends so far that ends of patches change their side of it, the first
   of these ends by place becomes a cut.  Each cut leaves fewer ends between those of a piece,
   so that cutting comes to an end. */
static hr2d_status push_straight(splitter *p, size_t k, const hr2d_point *end, int *bent) {
  const piece part = p->piece[k];
  const hr2d_segment s = part.s, whole = p->scene->patch[part.patch].scaled;
  const size_t ends = 2 * p->scene->patches;
  const double far = fmax(s.a.x, s.b.x);
  hr2d_status status = HR2D_OK;
  for (size_t m = first_end(end, ends, fmin(s.a.x, s.b.x));
       m < ends && end[m].x <= far && !is_whole(p, k); m++) {
    status = hr2di_watch_work(p->cuts.watch, 1);
    if (status) return status;
    if (!hr2di_point_between(whole, s, end[m]) ||
        hr2di_orient_sign(s.a, s.b, end[m]) == hr2di_orient_sign(whole.a, whole.b, end[m]))
      continue;
    *bent = 1;
    status = push(p, s.a, end[m], part.patch);
    return status ? status : push(p, end[m], s.b, part.patch);
  }
  return push(p, s.a, s.b, part.patch);
}

/* A piece that a rounded crossing bends may come to lie on the other side of an end that
   touches its patch within roundings.  Such an end becomes a cut: it lies on the wall then. */
static hr2d_status cut_at_ends(splitter *p, int *bent) {
  hr2d_point *end;
  hr2d_status status = sort_ends(p, &end);
  *bent = 0;
  p->cut_pieces = 0;
  for (size_t k = 0; k < p->pieces && !status; k++) status = push_straight(p, k, end, bent);
  hr2di_alloc_free(p->alloc, end);
  if (!status) exchange_pieces(p);
  return status;
}

static hr2d_status cut_until_free(splitter *p) {
  hr2d_scene *scene = p->scene;
  for (int round = 0;; round++) {
    hr2d_status status = make_walls(p);
    const size_t pieces = p->pieces;
    if (!status && round > 0) status = drop_loops(p);
    if (!status && p->pieces < pieces) status = make_walls(p);
    if (!status) status = hr2di_cuts_init(&p->cuts, p->wall, p->walls);
    int bent = 0;
    if (!status && p->cuts.count == 0 && p->pieces > scene->patches && round < MOST_ROUNDS)
      status = cut_at_ends(p, &bent);
    if (status || (p->cuts.count == 0 && !bent)) return status;
    if (round == MOST_ROUNDS) break;
    if (!bent) status = cut_all(p);
    if (status) return status;
  }
  size_t k = 0;
  while (p->cuts.of[p->wall_of[k]].first == p->cuts.of[p->wall_of[k]].end) k++;
  return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                            "%s is crossed within roundings still, after %d rounds of cutting",
                            hr2di_patch_label(scene, p->piece[k].patch).text, MOST_ROUNDS);
}

static int is_short(const splitter *p, const piece *part) {
  const hr2d_segment *s = &part->s, *whole = &p->scene->patch[part->patch].scaled;
  /* Far from the origin roundings are large, so it must also be short beside the patch. */
  const double max = fmin(HR2DI_SHORT_STRETCH * hr2di_crossings_rounding(whole, whole),
                          hypot(whole->b.x - whole->a.x, whole->b.y - whole->a.y) * 0x1p-20);
  return hypot(s->b.x - s->a.x, s->b.y - s->a.y) <= max;
}

/* Two patches that pass the same two points within roundings share the stretch between these
   points.  If the stretch is short, one of the two pieces is left out. */
static hr2d_status leave_copies_out(splitter *p) {
  char *seen = hr2di_alloc_zero(p->alloc, p->walls, 1);
  if (!seen) return HR2D_ENOMEM;
  for (size_t k = 0; k < p->pieces; k++) {
    const int side = side_of(&p->piece[k].s);
    char *w = &seen[p->wall_of[k]];
    p->piece[k].left_out = (*w & side) && is_short(p, &p->piece[k]) && !is_whole(p, k);
    *w = (char)(*w | side);
  }
  hr2di_alloc_free(p->alloc, seen);
  return HR2D_OK;
}

static hr2d_status make_piece(splitter *p, const hr2di_patch *whole, const piece *part,
                              size_t number, hr2di_patch *made) {
  const int e = p->scene->exponent;
  const hr2d_status status = hr2di_patch_copy(p->alloc, whole, number, made);
  made->given.a = (hr2d_point){ldexp(part->s.a.x, e), ldexp(part->s.a.y, e)};
  made->given.b = (hr2d_point){ldexp(part->s.b.x, e), ldexp(part->s.b.y, e)};
  return status;
}

static void free_patch(const hr2d_allocator *alloc, const hr2di_patch *patch) {
  hr2di_alloc_free(alloc, patch->name);
  hr2di_light_release(alloc, patch->light);
}

/* Frees the pieces among the first `count` patches made, but not the whole patches. */
static void free_pieces(const splitter *p, const hr2di_patch *made, size_t count) {
  for (size_t k = 0, m = 0; m < count; k++) {
    if (p->piece[k].left_out) continue;
    if (!is_whole(p, k)) free_patch(p->alloc, &made[m]);
    m++;
  }
}

/* Fills `made` with the whole patches as they are and with the pieces of the others. */
static hr2d_status make_patches(splitter *p, hr2di_patch *made, size_t *count) {
  size_t number = 0;
  *count = 0;
  for (size_t k = 0; k < p->pieces; k++) {
    const piece *part = &p->piece[k];
    const hr2di_patch *whole = &p->scene->patch[part->patch];
    if (k > 0 && p->piece[k - 1].patch != part->patch) number = 0;
    if (part->left_out) continue;
    hr2d_status status = hr2di_watch_work(p->cuts.watch, 2);
    if (!status && is_whole(p, k))
      made[*count] = *whole;
    else if (!status)
      status = make_piece(p, whole, part, ++number, &made[*count]);
    if (status) {
      free_pieces(p, made, *count);
      return status;
    }
    ++*count;
  }
  return HR2D_OK;
}

static hr2d_status replace_patches(splitter *p) {
  hr2d_scene *scene = p->scene;
  size_t count;
  hr2di_patch *made = hr2di_alloc(p->alloc, p->pieces, sizeof *made);
  hr2d_status status = made ? leave_copies_out(p) : HR2D_ENOMEM;
  if (!status) status = make_patches(p, made, &count);
  if (status) {
    hr2di_alloc_free(p->alloc, made);
    return status;
  }
  for (size_t k = 0; k < p->pieces; k++)
    if (!is_whole(p, k) && (k == 0 || p->piece[k - 1].patch != p->piece[k].patch))
      free_patch(p->alloc, &scene->patch[p->piece[k].patch]);
  hr2di_alloc_free(p->alloc, scene->patch);
  scene->patch = made;
  scene->patches = count;
  scene->capacity = p->pieces;
  return HR2D_OK;
}

static int by_place(const void *left, const void *right) {
  return hr2di_point_order(*(const hr2d_point *)left, *(const hr2d_point *)right);
}

static hr2d_status count_places(hr2di_cuts *cuts, size_t *count) {
  *count = 0;
  const hr2d_status status =
      hr2di_sort(cuts->place, cuts->places, sizeof *cuts->place, by_place, cuts->watch);
  for (size_t k = 0; k < cuts->places && !status; k++)
    *count += k == 0 || by_place(&cuts->place[k], &cuts->place[k - 1]) != 0;
  return status;
}

static hr2d_status split(splitter *p, size_t *count) {
  hr2d_scene *scene = p->scene;
  hr2d_status status = hr2di_scene_scale(scene, p->cuts.watch);
  if (status) return status;
  p->cuts.exponent = scene->exponent;
  if (hr2di_alloc_reserve(p->alloc, &p->piece, &p->capacity, scene->patches, sizeof *p->piece))
    return HR2D_ENOMEM;
  for (; p->pieces < scene->patches; p->pieces++)
    p->piece[p->pieces] = (piece){scene->patch[p->pieces].scaled, p->pieces, 0};
  status = cut_until_free(p);
  if (!status) status = count_places(&p->cuts, count);
  if (status || p->pieces == scene->patches) return status;
  return replace_patches(p);
}

hr2d_status hr2d_scene_split_crossings(hr2d_scene *scene, size_t *cuts) {
  if (!scene) return HR2D_EINVAL;
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE, "a committed scene cannot be cut");
  hr2di_watch watch;
  size_t count = 0;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "split");
  splitter p = {.scene = scene,
                .alloc = &scene->alloc,
                .cuts = {.alloc = &scene->alloc, .watch = &watch}};
  hr2d_status status = scene->patches > 0 ? split(&p, &count) : HR2D_OK;
  scene->exponent = 0;
  if (!status && cuts) *cuts = count;
  hr2di_alloc_free(p.alloc, p.piece);
  hr2di_alloc_free(p.alloc, p.cut_piece);
  hr2di_alloc_free(p.alloc, p.wall);
  hr2di_alloc_free(p.alloc, p.wall_of);
  hr2di_cuts_clear(&p.cuts);
  if (status == HR2D_ENOMEM || watch.status)
    hr2di_scene_fail(scene, status, &watch, "the crossings");
  return status;
}
