/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "blocks/gas-cells.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/bickley.h"
#include "blocks/line-vector.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* A knot no farther inside of a trapezoid, as a part of its gap, is on its side: the kink there
   is off by so much, and its effect by the square. */
#define ON_SIDE 0x1p-40

hr2d_status hr2di_gas_cells_init(hr2di_gas_cells *c, const hr2d_scene *scene,
                                 const hr2d_allocator *alloc, size_t order) {
  const hr2di_regions *r = hr2di_scene_regions(scene);
  const size_t pieces = r->borders + 1, gases = scene->gases.count;
  *c = (hr2di_gas_cells){.regions = r, .alloc = *alloc, .gases = gases, .order = order};
  c->absorption = hr2di_alloc(alloc, gases, sizeof *c->absorption);
  c->share = hr2di_alloc(alloc, hr2di_gas_cells_shares(gases, order), sizeof *c->share);
  c->along = hr2di_alloc(alloc, pieces, sizeof *c->along);
  c->side[0] = hr2di_alloc(alloc, pieces, 6 * sizeof *c->side[0]);
  if (hr2di_gas_path_init(&c->path, r, alloc)) return HR2D_ENOMEM;
  if (!c->absorption || !c->share || !c->along || !c->side[0]) return HR2D_ENOMEM;
  c->side[1] = c->side[0] + pieces;
  for (size_t v = 0; v < 2; v++) {
    c->depth[v] = c->side[0] + (2 + v) * pieces;
    c->range[v] = c->side[0] + (4 + v) * pieces;
  }
  for (size_t k = 0; k < gases; k++) c->absorption[k] = hr2di_scene_scaled_absorption(scene, k);
  return HR2D_OK;
}

void hr2di_gas_cells_clear(hr2di_gas_cells *c) {
  hr2di_alloc_free(&c->alloc, c->absorption);
  hr2di_alloc_free(&c->alloc, c->share);
  hr2di_alloc_free(&c->alloc, c->along);
  hr2di_alloc_free(&c->alloc, c->side[0]);
  hr2di_alloc_free(&c->alloc, c->knot);
  hr2di_alloc_free(&c->alloc, c->vertex);
  hr2di_alloc_free(&c->alloc, c->waiting);
  hr2di_alloc_free(&c->alloc, c->absorbed);
  hr2di_gas_path_clear(&c->path, &c->alloc);
}

static hr2d_status add_knot(hr2di_gas_cells *c, hr2d_point at) {
  if (hr2di_alloc_reserve(&c->alloc, &c->knot, &c->knot_capacity, c->knots + 1,
                          sizeof *c->knot))
    return HR2D_ENOMEM;
  c->knot[c->knots++] = at;
  return HR2D_OK;
}

/* Where a border meets an element it ends for its lines. */
static hr2d_status add_foot(hr2di_gas_cells *c, hr2d_segment border, hr2d_segment element) {
  const hr2d_point u = hr2di_point_minus(element.b, element.a),
                   v = hr2di_point_minus(border.b, border.a),
                   w = hr2di_point_minus(border.a, element.a);
  const double turn = hr2di_point_cross(u, v);
  const double s = hr2di_point_cross(w, v) / turn, t = hr2di_point_cross(w, u) / turn;
  if (turn == 0 || !(s > 0 && s < 1 && t >= 0 && t <= 1)) return HR2D_OK;
  return add_knot(c, hr2di_point_at(element, s));
}

static int is_in_box(hr2d_point at, const hr2d_point corner[4]) {
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (size_t k = 0; k < 4; k++) {
    low[0] = fmin(low[0], corner[k].x);
    low[1] = fmin(low[1], corner[k].y);
    high[0] = fmax(high[0], corner[k].x);
    high[1] = fmax(high[1], corner[k].y);
  }
  return at.x >= low[0] && at.x <= high[0] && at.y >= low[1] && at.y <= high[1];
}

static hr2d_status find_knots(hr2di_gas_cells *c, const hr2d_point corner[4]) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < c->regions->knots && !status; k++)
    if (is_in_box(c->regions->knot[k], corner)) status = add_knot(c, c->regions->knot[k]);
  return status;
}

void hr2di_gas_cells_forget(hr2di_gas_cells *c) {
  memset(c->share, 0, hr2di_gas_cells_shares(c->gases, c->order) * sizeof *c->share);
  c->is_mixed = 0;
  c->gas = HR2DI_NO_GAS;
}

hr2d_status hr2di_gas_cells_begin(hr2di_gas_cells *c, hr2d_segment i, hr2d_segment j,
                                  hr2di_watch *watch) {
  const hr2d_point corner[] = {i.a, i.b, j.a, j.b};
  hr2d_status status = hr2di_watch_work(watch, 1 + c->regions->borders);
  c->knots = 0;
  for (size_t k = 0; k < c->regions->borders && !status; k++) {
    const hr2d_segment border = c->regions->border[k].at;
    if (!hr2di_border_meets_hull(border, corner)) continue;
    c->is_mixed = 1;
    status = add_foot(c, border, i);
    if (!status) status = add_foot(c, border, j);
  }
  if (status) return status;
  if (c->is_mixed) return find_knots(c, corner);
  const hr2d_point middle = {0.25 * (i.a.x + i.b.x) + 0.25 * (j.a.x + j.b.x),
                             0.25 * (i.a.y + i.b.y) + 0.25 * (j.a.y + j.b.y)};
  c->gas = hr2di_regions_at(c->regions, middle);
  return HR2D_OK;
}

hr2d_status hr2di_gas_cells_frame(hr2di_gas_cells *c, const hr2di_line_frame *f) {
  c->frame = f;
  if (hr2di_alloc_reserve(&c->alloc, &c->vertex, &c->vertex_capacity, c->knots,
                          sizeof *c->vertex))
    return HR2D_ENOMEM;
  for (size_t k = 0; k < c->knots; k++)
    c->vertex[k] = (hr2di_vertex){.at = hr2di_vector_difference(c->knot[k], f->origin)};
  return HR2D_OK;
}

static double *share_of(hr2di_gas_cells *c, size_t side, size_t gas) {
  return c->share + (side * c->gases + gas) * c->order;
}

void hr2di_gas_cells_take(hr2di_gas_cells *c, double lost[2][HR2D_MAX_ORDER]) {
  for (size_t side = 0; side < 2 && !c->is_mixed && c->gas != HR2DI_NO_GAS; side++)
    memcpy(share_of(c, side, c->gas), lost[side], c->order * sizeof *c->share);
}

void hr2di_gas_cells_swap(hr2di_gas_cells *c) {
  const size_t count = c->gases * c->order;
  for (size_t k = 0; k < count; k++) {
    const double kept = c->share[k];
    c->share[k] = c->share[count + k];
    c->share[count + k] = kept;
  }
}

/* A knot as a trapezoid has it: its offset from low, at both ends. */
static void set_offsets(const hr2di_trapezoid *t, const hr2di_vertex *z, double offset[2]) {
  const hr2di_vector from = hr2di_vector_minus(&z->at, &t->bound[0]->at);
  for (size_t k = 0; k < 2; k++) offset[k] = hr2di_vector_cross(&from, &t->e[k]);
}

/* Where the line through a knot is at the ends of a trapezoid. */
typedef struct place {
  int low, high;    /* at both ends not inside of low, or of high */
  int below, above; /* at some end outside of it */
} place;

static place place_of(const hr2di_trapezoid *t, const double offset[2]) {
  const double on = ON_SIDE * fmax(t->gap[0], t->gap[1]);
  place p = {1, 1, 0, 0};
  for (size_t k = 0; k < 2; k++) {
    p.low &= offset[k] <= on;
    p.high &= offset[k] >= t->gap[k] - on;
    p.below |= offset[k] < -on;
    p.above |= offset[k] > t->gap[k] + on;
  }
  return p;
}

/* The part of the way at which a line that is below or above comes in. */
static double entry_of(const hr2di_trapezoid *t, const double offset[2], int below) {
  const double at[] = {below ? offset[0] : offset[0] - t->gap[0],
                       below ? offset[1] : offset[1] - t->gap[1]};
  return fmin(fmax(at[0] / (at[0] - at[1]), 0x1p-45), 1 - 0x1p-45);
}

/* The lines between low and a knot, and between it and high. */
static void slice(const hr2di_gas_cells *c, const hr2di_trapezoid *t, const hr2di_vertex *z,
                  const double offset[2], hr2di_trapezoid part[2]) {
  hr2di_trapezoid *low = &part[0], *high = &part[1];
  *low = *high = *t;
  for (size_t k = 0; k < 2; k++) {
    low->gap[k] = fmin(fmax(offset[k], 0), t->gap[k]);
    high->gap[k] = t->gap[k] - low->gap[k];
    high->on[0].start[k] = t->on[0].start[k] + low->gap[k];
    low->on[1].start[k] = t->on[1].start[k] + high->gap[k];
  }
  low->on[0].fixed &= 1;
  low->on[1].fixed &= 2;
  high->on[0].fixed &= 2;
  high->on[1].fixed &= 1;
  low->bound[1] = high->bound[0] = z;
  hr2di_line_above(c->frame, z, low->above[1]);
  memcpy(high->above[0], low->above[1], sizeof high->above[0]);
}

/* Divides at the first knot inside.  Returns 0 if there is none, else the parts to go on with.
 */
static size_t divide(const hr2di_gas_cells *c, hr2di_undivided *whole,
                     hr2di_trapezoid part[2]) {
  const hr2di_trapezoid *t = &whole->t;
  for (; whole->next < c->knots; whole->next++) {
    const hr2di_vertex *z = &c->vertex[whole->next];
    double offset[2];
    set_offsets(t, z, offset);
    const place p = place_of(t, offset);
    if (p.low || p.high) continue;
    if (p.below || p.above) {
      const double at = entry_of(t, offset, p.below);
      hr2di_trapezoid_divide(t, (const double[]){1 - at, at}, part);
      return 2;
    }
    slice(c, t, z, offset, part);
    whole->next++;
    return 2;
  }
  return 0;
}

/* Where the middle line of a cell meets an element. */
static hr2d_point foot_of(const hr2di_line_frame *f, const hr2di_trapezoid *t, size_t side) {
  const hr2di_meeting *m = &t->on[side];
  const double across = m->across[0] + m->across[1];
  const double start = m->start[0] + m->start[1] + 0.5 * (t->gap[0] + t->gap[1]);
  const double at = m->fixed == 3 ? 0.5 * (m->place[0] + m->place[1]) : start / across;
  const hr2di_vector *from = side ? &f->c : &f->a, *along = side ? &f->v : &f->u;
  return (hr2d_point){f->origin.x + (from->x + at * along->x),
                      f->origin.y + (from->y + at * along->y)};
}

/* Finds the borders that the lines of a cell cross. */
static hr2d_status set_path(hr2di_gas_cells *c, const hr2di_trapezoid *t) {
  const hr2di_line_frame *f = c->frame;
  hr2di_gas_path_trace(&c->path, c->regions, foot_of(f, t, 0), foot_of(f, t, 1));
  for (size_t k = 0; k + 1 < c->path.pieces; k++) {
    const hr2d_segment at = c->regions->border[c->path.crossing[k].border].at;
    const hr2di_vector first = hr2di_vector_difference(at.a, f->origin),
                       along = hr2di_vector_difference(at.b, at.a);
    c->along[k] = (hr2d_point){along.x, along.y};
    for (size_t v = 0; v < 2; v++) {
      const hr2di_vector from = hr2di_vector_minus(&first, &t->bound[v]->at);
      c->side[v][k] = hr2di_vector_cross(&from, &along);
    }
  }
  const size_t ends = c->path.pieces + 1;
  return hr2di_alloc_reserve(&c->alloc, &c->absorbed, &c->absorbed_capacity, ends * ends,
                             sizeof *c->absorbed)
             ? HR2D_ENOMEM
             : HR2D_OK;
}

hr2d_status hr2di_gas_cells_divide(hr2di_integrator *w, const hr2di_trapezoid *whole,
                                   hr2di_add_cell add, double area, double *block) {
  hr2di_gas_cells *c = w->cells;
  size_t count = 1;
  hr2d_status status = HR2D_OK;
  if (hr2di_alloc_reserve(&c->alloc, &c->waiting, &c->waiting_capacity, 1, sizeof *c->waiting))
    return HR2D_ENOMEM;
  c->waiting[0] = (hr2di_undivided){*whole, 0};
  while (count > 0 && !status) {
    hr2di_undivided u = c->waiting[--count];
    hr2di_trapezoid part[2];
    const size_t parts = divide(c, &u, part);
    status = hr2di_watch_work(w->watch, 1 + c->knots / 8 + c->regions->borders / 8);
    if (!status && parts == 0) {
      status = set_path(c, &u.t);
      if (!status) status = add(w, &u.t, area, block);
    }
    if (hr2di_alloc_reserve(&c->alloc, &c->waiting, &c->waiting_capacity, count + parts,
                            sizeof *c->waiting))
      status = HR2D_ENOMEM;
    for (size_t k = 0; k < parts && !status; k++)
      if (part[k].gap[0] > 0 || part[k].gap[1] > 0)
        c->waiting[count++] = (hr2di_undivided){part[k], u.next};
  }
  return status;
}

static double absorption_of(const hr2di_gas_cells *c, size_t piece) {
  const size_t gas = c->path.gas[piece];
  return gas == HR2DI_NO_GAS ? 0 : c->absorption[gas];
}

/* Sets x_1 … x_n.  Along the line through z in the direction e a border is at
   (g − z) × w/(e × w) of e. */
void hr2di_gas_cells_depths(hr2di_gas_cells *c, const hr2di_trapezoid *t, size_t vertex,
                            double f, double g, double length) {
  double *depth = c->depth[vertex];
  const double x = f * t->e[0].x + g * t->e[1].x, y = f * t->e[0].y + g * t->e[1].y;
  double foot[2] = {0, 0}, sum = 0;
  for (size_t side = 0; side < 2; side++) {
    const double above = t->above[vertex][side];
    const double across = f * t->on[side].across[0] + g * t->on[side].across[1];
    if (above != 0) foot[side] = above / across; /* a knot may be behind an element */
  }
  double from = -foot[0];
  for (size_t k = 0; k < c->path.pieces; k++) {
    double to = foot[1];
    if (k + 1 < c->path.pieces) {
      const double across = x * c->along[k].y - y * c->along[k].x;
      to = across != 0 ? c->side[vertex][k] / across : from;
      to = fmin(fmax(to, from), foot[1]);
    }
    sum += absorption_of(c, k) * (length * (to - from));
    depth[k] = sum;
    from = to;
  }
}

/* As one gas, with the ranges of the depths of all pieces. */
double hr2di_gas_cells_points(hr2di_gas_cells *c, const hr2di_trapezoid *t) {
  static const double part[] = {0.02, 0.25, 0.5, 0.75, 0.98};
  enum { LOOKS = 5, MOST_POINTS = 32 };
  const size_t n = c->path.pieces;
  double all = 0;
  for (size_t vertex = 0; vertex < 2; vertex++) {
    double range = 0;
    for (size_t look = 0; look < LOOKS; look++) {
      const double f = 1 - part[look], g = part[look];
      const double x = f * t->e[0].x + g * t->e[1].x, y = f * t->e[0].y + g * t->e[1].y;
      const double *depth = c->depth[vertex];
      hr2di_gas_cells_depths(c, t, vertex, f, g, sqrt(x * x + y * y));
      for (size_t k = 0; k < n; k++) {
        const double piece = depth[k] - (k ? depth[k - 1] : 0);
        c->range[0][k] = look ? fmin(c->range[0][k], piece) : piece;
        c->range[1][k] = look ? fmax(c->range[1][k], piece) : piece;
      }
    }
    for (size_t k = 0; k < n; k++)
      if (c->range[0][k] < HR2DI_GAS_DARK) range += c->range[1][k] - c->range[0][k];
    all = fmax(all, range);
  }
  return all > MOST_POINTS ? HUGE_VAL : sqrt(all);
}
