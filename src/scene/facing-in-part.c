/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two patches i and j see each other in part iff the line of one of them, say i, crosses j,
   from one side to the other, and i has an end in front of j (or the same with i and j
   swapped).  All patches of a run have one line.  So each line of a run descends the tree of
   boxes around walls, to walls that it crosses.

   A line crosses one patch of a run at most.  The patches of the run with that line which have
   an end in front of this patch are its first ones or its last ones.  So two binary searches
   settle a line and a wall.

   The least number in all pairs is found first, and boxes without a lesser one are skipped.  So
   are boxes whose walls all end at one point of the line, as those of a star do: it crosses
   none of them. */
#include "scene/facing-in-part.h"

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "occlusion/wall-tree.h"
#include "scene/scene-impl.h"

/* Where all walls in a box end. */
typedef struct common_ends {
  hr2d_point at[2];
  int count;
} common_ends;

typedef struct finder {
  const hr2d_scene *scene;
  uint32_t *runs_of;   /* the runs of wall w are [runs_of[w], runs_of[w + 1]) */
  uint32_t *up, *down; /* per place in hr2di_runs::patch: the least patch of its run up to
                          there, and from there on */
  uint32_t *below;     /* per box: the least patch in it */
  common_ends *common; /* per box */
  uint32_t min;        /* of all pairs so far */
  hr2di_watch *watch;
} finder;

static hr2d_segment patch_at(const finder *f, uint32_t place) {
  return f->scene->patch[f->scene->runs.patch[place]].scaled;
}

static uint32_t lesser(uint32_t p, uint32_t q) {
  return p < q ? p : q;
}

static void index_runs(finder *f) {
  const hr2di_runs *runs = &f->scene->runs;
  for (uint32_t k = 0; k < runs->runs; k++) {
    const hr2di_run r = runs->run[k];
    f->runs_of[f->scene->walls.of_segment[runs->patch[r.first]] + 1] = k + 1;
    for (uint32_t m = r.first; m < r.last; m++)
      f->up[m] = m > r.first ? lesser(f->up[m - 1], runs->patch[m]) : runs->patch[m];
    for (uint32_t m = r.last; m-- > r.first;)
      f->down[m] = m + 1 < r.last ? lesser(f->down[m + 1], runs->patch[m]) : runs->patch[m];
  }
}

static uint32_t min_of_run(const finder *f, uint32_t run) {
  return f->down[f->scene->runs.run[run].first];
}

static common_ends ends_of_both(const common_ends *p, const common_ends *q) {
  common_ends both = {.count = 0};
  for (int k = 0; k < p->count; k++)
    for (int m = 0; m < q->count; m++)
      if (hr2di_point_same(p->at[k], q->at[m])) both.at[both.count++] = p->at[k];
  return both;
}

static void find_common_ends(finder *f) {
  const hr2di_walls *walls = &f->scene->walls;
  for (size_t k = 2 * walls->walls - 1; k-- > 0;) {
    const hr2di_box *box = &walls->box[k];
    if (box->wall == HR2DI_NO_WALL) {
      f->common[k] = ends_of_both(&f->common[box->below], &f->common[box->below + 1]);
    } else {
      const hr2d_segment at = walls->wall[box->wall].at;
      f->common[k] = (common_ends){{at.a, at.b}, 2};
    }
  }
}

static int passes_common_end(hr2d_segment line, const common_ends *common) {
  int passes = 0;
  for (int k = 0; k < common->count; k++)
    passes |= hr2di_orient_sign(line.a, line.b, common->at[k]) == 0;
  return passes;
}

/* Boxes have higher numbers than those that they are in. */
static void index_boxes(finder *f) {
  const hr2di_walls *walls = &f->scene->walls;
  for (size_t k = 2 * walls->walls - 1; k-- > 0;) {
    const hr2di_box *box = &walls->box[k];
    f->below[k] = UINT32_MAX;
    if (box->wall == HR2DI_NO_WALL)
      f->below[k] = lesser(f->below[box->below], f->below[box->below + 1]);
    else
      for (uint32_t r = f->runs_of[box->wall]; r < f->runs_of[box->wall + 1]; r++)
        f->below[k] = lesser(f->below[k], min_of_run(f, r));
  }
}

static hr2d_status begin(finder *f) {
  const hr2d_allocator *alloc = &f->scene->alloc;
  const size_t walls = f->scene->walls.walls, n = f->scene->patches;
  f->runs_of = hr2di_alloc_zero(alloc, walls + 1, sizeof *f->runs_of);
  f->up = hr2di_alloc(alloc, n, sizeof *f->up);
  f->down = hr2di_alloc(alloc, n, sizeof *f->down);
  f->below = hr2di_alloc(alloc, walls, 2 * sizeof *f->below);
  f->common = hr2di_alloc(alloc, walls, 2 * sizeof *f->common);
  if (!f->runs_of || !f->up || !f->down || !f->below || !f->common) return HR2D_ENOMEM;
  index_runs(f);
  index_boxes(f);
  find_common_ends(f);
  return hr2di_watch_work(f->watch, n / 4);
}

/* Whether a line has points of a box on both sides; exact. */
static int crosses_box(hr2d_segment line, const hr2di_box *box) {
  const int right = line.b.y > line.a.y, down = line.b.x < line.a.x;
  const hr2d_point max_left = {right ? box->x0 : box->x1, down ? box->y0 : box->y1},
                   max_right = {right ? box->x1 : box->x0, down ? box->y1 : box->y0};
  return hr2di_orient_sign(line.a, line.b, max_left) > 0 &&
         hr2di_orient_sign(line.a, line.b, max_right) < 0;
}

/* The last place in a run whose patch has its start on the side `sign` of a line, as the first
   one has. */
static uint32_t last_before(const finder *f, hr2di_run r, hr2d_segment line, int sign) {
  uint32_t low = r.first, high = r.last;
  while (high - low > 1) {
    const uint32_t middle = low + (high - low) / 2;
    if (hr2di_orient_sign(line.a, line.b, patch_at(f, middle).a) == sign)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* The place of the patch of a run that a line crosses, or the end of the run. */
static uint32_t crossed(const finder *f, hr2di_run r, hr2d_segment line) {
  const int sign = hr2di_orient_sign(line.a, line.b, patch_at(f, r.first).a);
  if (sign == 0) return r.last;
  const uint32_t place = last_before(f, r, line, sign);
  return hr2di_orient_sign(line.a, line.b, patch_at(f, place).b) == -sign ? place : r.last;
}

/* The least patch of a run with an end in front of j, or UINT32_MAX. */
static uint32_t min_in_front(const finder *f, hr2di_run r, hr2d_segment j) {
  if (hr2di_orient_sign(j.a, j.b, patch_at(f, r.first).a) > 0)
    return f->up[last_before(f, r, j, 1)];
  if (hr2di_orient_sign(j.a, j.b, patch_at(f, r.last - 1).b) <= 0) return UINT32_MAX;
  uint32_t low = r.first, high = r.last - 1;
  while (low < high) {
    const uint32_t middle = low + (high - low) / 2;
    if (hr2di_orient_sign(j.a, j.b, patch_at(f, middle).b) > 0)
      high = middle;
    else
      low = middle + 1;
  }
  return f->down[low];
}

static void examine_wall(finder *f, hr2di_run r, hr2d_segment line, uint32_t wall) {
  const hr2di_runs *runs = &f->scene->runs;
  const hr2d_segment w = f->scene->walls.wall[wall].at;
  if (hr2di_orient_sign(line.a, line.b, w.a) * hr2di_orient_sign(line.a, line.b, w.b) >= 0)
    return;
  for (uint32_t k = f->runs_of[wall]; k < f->runs_of[wall + 1]; k++) {
    const uint32_t place = crossed(f, runs->run[k], line);
    if (place == runs->run[k].last) continue;
    const uint32_t i = min_in_front(f, r, patch_at(f, place));
    if (i != UINT32_MAX) f->min = lesser(f->min, lesser(i, runs->patch[place]));
  }
}

/* Looks for lesser numbers in pairs of the patches of one run with others. */
static hr2d_status trace_ray(finder *f, uint32_t run) {
  const hr2di_walls *walls = &f->scene->walls;
  const hr2di_run r = f->scene->runs.run[run];
  const hr2d_segment line = patch_at(f, r.first);
  const uint32_t own = min_of_run(f, run);
  uint32_t stack[HR2DI_BOX_DEPTH], count = 0;
  hr2d_status status = HR2D_OK;
  stack[count++] = 0;
  while (count > 0 && !status) {
    const uint32_t k = stack[--count];
    const hr2di_box *box = &walls->box[k];
    status = hr2di_watch_work(f->watch, 1);
    if ((own >= f->min && f->below[k] >= f->min) || !crosses_box(line, box) ||
        passes_common_end(line, &f->common[k]))
      continue;
    if (box->wall != HR2DI_NO_WALL) {
      examine_wall(f, r, line, box->wall);
    } else {
      stack[count++] = box->below + 1;
      stack[count++] = box->below;
    }
  }
  return status;
}

/* No patch crosses the line of one on the hull. */
static hr2d_status find_min(finder *f, const hr2di_hull *hull) {
  hr2d_status status = begin(f);
  for (uint32_t k = 0; k < f->scene->runs.runs && f->min > 0 && !status; k++) {
    status = hr2di_watch_work(f->watch, 4);
    if (!status && hr2di_hull_sides(hull, patch_at(f, f->scene->runs.run[k].first)) == 3)
      status = trace_ray(f, k);
  }
  return status;
}

hr2d_status hr2di_facing_in_part_find(const hr2d_scene *scene, const hr2di_hull *hull,
                                      hr2di_first_pair *found, hr2di_watch *watch) {
  finder f = {.scene = scene, .min = UINT32_MAX, .watch = watch};
  *found = (hr2di_first_pair){0};
  hr2d_status status = find_min(&f, hull);
  const size_t n = scene->patches, i = f.min < n ? f.min : n; /* so that i + 1 is not 0 */
  for (size_t j = i + 1; j < n && !found->exists && !status; j++) {
    if (j % 16 == 0) status = hr2di_watch_work(watch, 8);
    if (hr2di_facing_of(&scene->patch[i].scaled, &scene->patch[j].scaled) == HR2DI_FACING_PART)
      *found = (hr2di_first_pair){1, i, j};
  }
  hr2di_alloc_free(&scene->alloc, f.runs_of);
  hr2di_alloc_free(&scene->alloc, f.up);
  hr2di_alloc_free(&scene->alloc, f.down);
  hr2di_alloc_free(&scene->alloc, f.below);
  hr2di_alloc_free(&scene->alloc, f.common);
  return status;
}
