/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs of segments that cross or lie on one another, found by a sweep over x. */
#include "geometry/crossings.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/determinant.h"
#include "geometry/predicates.h"
#include "geometry/stars.h"

/* Above every rounding.  Times |u| it is also above the error of a plain determinant of
   coordinates below 2, which is 2^-50·|u||w| with |w| below 4. */
#define MARGIN 0x1p-46

/* Two segments lie on one another if they share, within a rounding, a stretch that is longer
   than this many roundings.  A shorter stretch is a touch at a flat angle. */
#define LONG_STRETCH 16

/* An end that is through the other segment by no more than a rounding crosses it all the same
   if the part beyond is longer than this many roundings, or than this part of the shorter
   segment.  Visibility takes such an end as the point where the segments meet, and is off by
   the length of the part beyond. */
#define LONG_TAIL 0x1p+20
#define LONG_PART 0x1p-20

static double largest(const hr2d_segment *s) {
  return fmax(fmax(fabs(s->a.x), fabs(s->a.y)), fmax(fabs(s->b.x), fabs(s->b.y)));
}

static double length(const hr2d_segment *s) {
  return hypot(s->b.x - s->a.x, s->b.y - s->a.y);
}

double hr2di_crossings_rounding(const hr2d_segment *i, const hr2d_segment *j) {
  const double shorter = fmin(length(i), length(j));
  const double scene = fmin(1, 0x1p+30 * shorter);
  return 4 * 0x1p-52 * fmax(fmax(largest(i), largest(j)), scene);
}

/* Both ends of t are on one side of the line of s, much farther from it than a rounding. */
static int clear_of(const hr2d_segment *s, const hr2d_segment *t) {
  const double ux = s->b.x - s->a.x, uy = s->b.y - s->a.y;
  const double a = ux * (t->a.y - s->a.y) - uy * (t->a.x - s->a.x);
  const double b = ux * (t->b.y - s->a.y) - uy * (t->b.x - s->a.x);
  const double margin = MARGIN * (fabs(ux) + fabs(uy));
  return (a > margin && b > margin) || (a < -margin && b < -margin);
}

/* An end of one segment, and where it is from the other's line. */
typedef struct end {
  hr2d_point at;
  hr2di_scaled side; /* twice the signed area; its sign is exact */
  double distance;
} end;

typedef struct pair {
  const hr2d_segment *i, *j;
  end ia, ib, ja, jb;
  double rounding;
} pair;

static end measure(hr2d_point p, const hr2d_segment *line) {
  const hr2di_vector u = hr2di_vector_difference_scaled(line->b, line->a);
  const hr2di_scaled side = hr2di_orient_scaled(line->a, line->b, p);
  end e = {.at = p, .side = hr2di_scaled_of(side.m, side.e)};
  e.distance =
      fabs(hr2di_scaled_value(hr2di_scaled_div(e.side, hr2di_vector_length_scaled(&u))));
  return e;
}

double hr2di_crossings_distance(hr2d_point p, const hr2d_segment *s) {
  return measure(p, s).distance;
}

static pair make_pair(const hr2d_segment *i, const hr2d_segment *j) {
  return (pair){.i = i,
                .j = j,
                .ia = measure(i->a, j),
                .ib = measure(i->b, j),
                .ja = measure(j->a, i),
                .jb = measure(j->b, i),
                .rounding = hr2di_crossings_rounding(i, j)};
}

static double along(hr2d_point p, int by_x) {
  return by_x ? p.x : p.y;
}

/* Returns the length of the stretch that the segments share when both are projected on the main
   axis of the longer one; negative if they share none.  *from and *to become the ends of the
   stretch; each of them is an end of one segment, measured against the other. */
static double find_stretch(const pair *p, end *from, end *to) {
  const hr2d_segment *longer = length(p->i) >= length(p->j) ? p->i : p->j;
  const int by_x = fabs(longer->b.x - longer->a.x) >= fabs(longer->b.y - longer->a.y);
  const int i_up = along(p->i->b, by_x) > along(p->i->a, by_x),
            j_up = along(p->j->b, by_x) > along(p->j->a, by_x);
  const end *i_low = i_up ? &p->ia : &p->ib, *i_high = i_up ? &p->ib : &p->ia;
  const end *j_low = j_up ? &p->ja : &p->jb, *j_high = j_up ? &p->jb : &p->ja;
  *from = along(j_low->at, by_x) >= along(i_low->at, by_x) ? *j_low : *i_low;
  *to = along(j_high->at, by_x) <= along(i_high->at, by_x) ? *j_high : *i_high;
  return along(to->at, by_x) - along(from->at, by_x);
}

/* Whether the segments lie on one another.  Two with opposite fronts that touch exactly, or
   back against back, are back to back: neither hides anything that the other should see.  If
   they touch front against front, each would see nothing but the other. */
static int lie_together(const pair *p, hr2di_meeting *m) {
  end from, to;
  const double stretch = find_stretch(p, &from, &to);
  const int collinear = p->ja.side.m == 0 && p->jb.side.m == 0;
  const double min = collinear ? fmin(p->rounding, fmin(length(p->i), length(p->j)) / 2)
                               : LONG_STRETCH * p->rounding;
  /* Visibility takes points so near as lying on the line of a wall, or of its run. */
  const double near = 2 * p->rounding;
  if (stretch <= min || from.distance >= near || to.distance >= near) return 0;
  const hr2d_segment *i = p->i, *j = p->j;
  const double dot = (i->b.x - i->a.x) * ((j->b.x - j->a.x) / length(j)) +
                     (i->b.y - i->a.y) * ((j->b.y - j->a.y) / length(j));
  const int in_front = from.side.m > 0 || to.side.m > 0;
  *m = (hr2di_meeting){.kind = dot > 0    ? HR2DI_MEET_LIE
                               : in_front ? HR2DI_MEET_FACE
                                          : HR2DI_MEET_FREE,
                       .together = 1,
                       .collinear = collinear,
                       .from = from.at,
                       .to = to.at};
  return 1;
}

static double clamp(double x, double u, double v) {
  return fmin(fmax(x, fmin(u, v)), fmax(u, v));
}

static hr2d_point into_box(hr2d_point p, const hr2d_segment *s) {
  return (hr2d_point){clamp(p.x, s->a.x, s->b.x), clamp(p.y, s->a.y, s->b.y)};
}

/* The ends of i are on different sides of j, so that no digit is lost in the fraction.
   Clamping to the boxes keeps the crossing exactly on a horizontal or vertical segment. */
static hr2d_point crossing(const pair *p) {
  const hr2di_scaled a = {fabs(p->ia.side.m), p->ia.side.e},
                     b = {fabs(p->ib.side.m), p->ib.side.e};
  const hr2di_scaled whole = hr2di_scaled_add(a, b);
  const int from_a = hr2di_scaled_sub(a, b).m <= 0;
  const double t = hr2di_scaled_value(hr2di_scaled_div(from_a ? a : b, whole));
  const hr2d_point near = from_a ? p->i->a : p->i->b, far = from_a ? p->i->b : p->i->a;
  const hr2d_point x = {near.x + t * (far.x - near.x), near.y + t * (far.y - near.y)};
  return into_box(into_box(x, p->i), p->j);
}

/* Whether the end `near` of s was meant to lie on the other segment: it is through by no more
   than a rounding, and the part beyond, which is long at a flat angle, is not too long. */
static int pokes(const pair *p, const hr2d_segment *s, const end *near, const end *far) {
  const double through = length(s) * (near->distance / (near->distance + far->distance));
  const double part = LONG_PART * fmin(length(p->i), length(p->j));
  return near->distance <= p->rounding &&
         through <= fmax(LONG_STRETCH * p->rounding, fmin(LONG_TAIL * p->rounding, part));
}

static int cross(const pair *p, hr2di_meeting *m) {
  if (p->ia.side.m * p->ib.side.m >= 0 || p->ja.side.m * p->jb.side.m >= 0) return 0;
  if (pokes(p, p->i, &p->ia, &p->ib) || pokes(p, p->i, &p->ib, &p->ia) ||
      pokes(p, p->j, &p->ja, &p->jb) || pokes(p, p->j, &p->jb, &p->ja))
    return 0;
  const hr2d_point x = crossing(p);
  *m = (hr2di_meeting){.kind = HR2DI_MEET_CROSS,
                       .from = x,
                       .to = x,
                       .sine = (p->ia.distance + p->ib.distance) / length(p->i)};
  return 1;
}

hr2di_meeting hr2di_crossings_meet(const hr2d_segment *i, const hr2d_segment *j) {
  hr2di_meeting m = {.kind = HR2DI_MEET_FREE};
  if (clear_of(i, j) || clear_of(j, i)) return m;
  const pair p = make_pair(i, j);
  if (!lie_together(&p, &m)) cross(&p, &m);
  return m;
}

typedef struct span {
  double from, to, low, high; /* in x and y; those of two boxes that meet overlap */
  size_t segment;
  uint32_t first_row, last_row;
} span;

/* The sweep looks only at spans of the same row of the plane, for which `item` has the numbers
   of the spans that reach into each row, in their order. */
typedef struct sweep {
  const hr2d_allocator *alloc;
  span *spans;
  size_t count;
  size_t rows;
  size_t *start; /* rows + 1: the items of row r are [start[r], start[r + 1]) */
  size_t *next;  /* the first item in each row that the sweep has not reached */
  uint32_t *item;
  uint32_t *found; /* what meets one span */
  size_t finds;
  uint32_t here;            /* the span that is looked at */
  const hr2di_stars *stars; /* NULL: all pairs are visited */
  uint32_t *rank;           /* per segment: its span; with stars */
  uint32_t *past;           /* per item: the next one that is of another star; with stars */
  hr2di_watch *watch;
} sweep;

static uint32_t star_of(const sweep *s, uint32_t k) {
  return s->stars->of[s->spans[k].segment];
}

static int by_start(const void *left, const void *right) {
  const span *l = left, *r = right;
  if (l->from != r->from) return l->from < r->from ? -1 : 1;
  return (l->segment > r->segment) - (l->segment < r->segment);
}

static int by_number(const void *left, const void *right) {
  const uint32_t l = *(const uint32_t *)left, r = *(const uint32_t *)right;
  return (l > r) - (l < r);
}

static hr2d_status make_spans(sweep *s, const hr2d_segment *first, size_t stride) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < s->count && !status; k++) {
    if (k % 16 == 0) status = hr2di_watch_work(s->watch, 16);
    const hr2d_segment *at = (const void *)((const char *)first + k * stride);
    s->spans[k] = (span){.from = fmin(at->a.x, at->b.x),
                         .to = fmax(at->a.x, at->b.x) + MARGIN,
                         .low = fmin(at->a.y, at->b.y),
                         .high = fmax(at->a.y, at->b.y) + MARGIN,
                         .segment = k};
  }
  return status ? status : hr2di_sort(s->spans, s->count, sizeof *s->spans, by_start, s->watch);
}

/* Chooses as many rows as there are spans in one, about, but so few that spans reach into four
   rows at most on average; *items is the number of items. */
static hr2d_status choose_rows(sweep *s, size_t *items) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (size_t k = 0; k < s->count; k++) {
    low = fmin(low, s->spans[k].low);
    high = fmax(high, s->spans[k].high);
  }
  for (s->rows = (size_t)sqrt((double)s->count) + 1;; s->rows = (s->rows + 1) / 2) {
    const double scale = (double)s->rows / (high - low);
    const hr2d_status status = hr2di_watch_work(s->watch, s->count / 4);
    if (status) return status;
    *items = 0;
    for (size_t k = 0; k < s->count; k++) {
      span *p = &s->spans[k];
      p->first_row = (uint32_t)fmin((p->low - low) * scale, (double)(s->rows - 1));
      p->last_row = (uint32_t)fmin((p->high - low) * scale, (double)(s->rows - 1));
      *items += p->last_row - p->first_row + 1;
    }
    if (s->rows == 1 || *items <= 4 * s->count) return HR2D_OK;
  }
}

static hr2d_status make_rows(sweep *s) {
  size_t items;
  hr2d_status status = choose_rows(s, &items);
  if (status) return status;
  s->start = hr2di_alloc_zero(s->alloc, s->rows + 1, sizeof *s->start);
  s->next = hr2di_alloc(s->alloc, s->rows, sizeof *s->next);
  s->item = hr2di_alloc(s->alloc, items, sizeof *s->item);
  if (!s->start || !s->next || !s->item) return HR2D_ENOMEM;
  status = hr2di_watch_work(s->watch, items / 4);
  for (size_t k = 0; k < s->count; k++)
    for (uint32_t r = s->spans[k].first_row; r <= s->spans[k].last_row; r++) s->start[r + 1]++;
  for (size_t r = 0; r < s->rows; r++) {
    s->start[r + 1] += s->start[r];
    s->next[r] = s->start[r];
  }
  for (size_t k = 0; k < s->count; k++)
    for (uint32_t r = s->spans[k].first_row; r <= s->spans[k].last_row; r++)
      s->item[s->next[r]++] = (uint32_t)k;
  for (size_t r = 0; r < s->rows; r++) s->next[r] = s->start[r];
  return status;
}

/* Prepares to pass over pairs of one star. */
static hr2d_status search_stars(sweep *s) {
  if (!s->stars || !s->stars->of) {
    s->stars = NULL;
    return HR2D_OK;
  }
  const size_t items = s->start[s->rows];
  s->rank = hr2di_alloc(s->alloc, s->count, sizeof *s->rank);
  s->past = hr2di_alloc(s->alloc, items, sizeof *s->past);
  if (!s->rank || !s->past) return HR2D_ENOMEM;
  for (size_t k = 0; k < s->count; k++) s->rank[s->spans[k].segment] = (uint32_t)k;
  for (size_t r = 0; r < s->rows; r++)
    for (size_t m = s->start[r + 1]; m-- > s->start[r];) {
      const uint32_t star = star_of(s, s->item[m]);
      const int goes_on = star != HR2DI_NO_STAR && m + 1 < s->start[r + 1] &&
                          star_of(s, s->item[m + 1]) == star;
      s->past[m] = goes_on ? s->past[m + 1] : (uint32_t)m + 1;
    }
  return hr2di_watch_work(s->watch, items / 4);
}

/* The item behind m that is looked at: m, or the next of another star than that of p. */
static size_t pass_star(const sweep *s, const span *p, size_t m) {
  if (!s->stars) return m;
  const uint32_t star = s->stars->of[p->segment];
  return star != HR2DI_NO_STAR && star_of(s, s->item[m]) == star ? s->past[m] : m;
}

static void take_neighbour(void *ctx, uint32_t segment) {
  sweep *s = ctx;
  if (s->rank[segment] > s->here) s->found[s->finds++] = s->rank[segment];
}

static hr2d_status sort_found(sweep *s) {
  const hr2d_status status =
      hr2di_sort(s->found, s->finds, sizeof *s->found, by_number, s->watch);
  size_t kept = 0;
  for (size_t m = 0; m < s->finds; m++)
    if (m == 0 || s->found[m] != s->found[m - 1]) s->found[kept++] = s->found[m];
  s->finds = kept;
  return status;
}

/* Finds the spans behind k that meet it, in their order.  Two that meet in more than one row
   are found in the first of them. */
static hr2d_status find_behind(sweep *s, uint32_t k) {
  const span *p = &s->spans[k];
  hr2d_status status = hr2di_watch_work(s->watch, 1);
  s->finds = 0;
  s->here = k;
  for (uint32_t r = p->first_row; r <= p->last_row && !status; r++) {
    const size_t after = ++s->next[r], last = s->start[r + 1];
    for (size_t m = after; m < last && !status; m++) {
      m = pass_star(s, p, m);
      if (m == last || s->spans[s->item[m]].from > p->to) break;
      const span *q = &s->spans[s->item[m]];
      if (m % 16 == 0) status = hr2di_watch_work(s->watch, 1);
      if (r != (p->first_row > q->first_row ? p->first_row : q->first_row)) continue;
      if (p->low <= q->high && q->low <= p->high) s->found[s->finds++] = s->item[m];
    }
  }
  const int in_star = s->stars && s->stars->of[p->segment] != HR2DI_NO_STAR;
  if (in_star) hr2di_stars_neighbours(s->stars, (uint32_t)p->segment, take_neighbour, s);
  if (status || (p->first_row == p->last_row && !in_star)) return status;
  return sort_found(s);
}

static hr2d_status visit_found(const sweep *s,
                               hr2d_status (*visit)(void *ctx, size_t i, size_t j), void *ctx) {
  hr2d_status status = HR2D_OK;
  for (size_t m = 0; m < s->finds && !status; m++) {
    const size_t i = s->spans[s->here].segment, j = s->spans[s->found[m]].segment;
    status = hr2di_watch_work(s->watch, 2);
    if (!status) status = i < j ? visit(ctx, i, j) : visit(ctx, j, i);
  }
  return status;
}

static hr2d_status sweep_over(sweep *s, const hr2d_segment *first, size_t stride,
                              hr2d_status (*visit)(void *ctx, size_t i, size_t j), void *ctx) {
  if (s->count > UINT32_MAX / 8) return HR2D_ENOMEM;
  s->spans = hr2di_alloc(s->alloc, s->count, sizeof *s->spans);
  /* Neighbours in a star may be found twice. */
  s->found = hr2di_alloc(s->alloc, s->count, (s->stars ? 3 : 1) * sizeof *s->found);
  hr2d_status status = s->spans && s->found ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = make_spans(s, first, stride);
  if (!status) status = make_rows(s);
  if (!status) status = search_stars(s);
  for (size_t k = 0; k < s->count && !status; k++) {
    status = find_behind(s, (uint32_t)k);
    if (!status) status = visit_found(s, visit, ctx);
  }
  hr2di_alloc_free(s->alloc, s->spans);
  hr2di_alloc_free(s->alloc, s->found);
  hr2di_alloc_free(s->alloc, s->start);
  hr2di_alloc_free(s->alloc, s->next);
  hr2di_alloc_free(s->alloc, s->item);
  hr2di_alloc_free(s->alloc, s->rank);
  hr2di_alloc_free(s->alloc, s->past);
  return status;
}

hr2d_status hr2di_crossings_sweep(const hr2d_allocator *alloc, const hr2d_segment *first,
                                  size_t count, size_t stride,
                                  hr2d_status (*visit)(void *ctx, size_t i, size_t j),
                                  void *ctx, hr2di_watch *watch) {
  sweep s = {.alloc = alloc, .count = count, .watch = watch};
  return sweep_over(&s, first, stride, visit, ctx);
}

hr2d_status hr2di_crossings_find(const hr2d_allocator *alloc, const hr2d_segment *first,
                                 size_t count, size_t stride, const hr2di_stars *stars,
                                 hr2d_status (*visit)(void *ctx, size_t i, size_t j), void *ctx,
                                 hr2di_watch *watch) {
  hr2di_stars own = {0};
  sweep s = {.alloc = alloc, .count = count, .stars = stars ? stars : &own, .watch = watch};
  hr2d_status status =
      stars ? HR2D_OK : hr2di_stars_init(&own, alloc, first, count, stride, watch);
  if (!status) status = sweep_over(&s, first, stride, visit, ctx);
  if (!stars) hr2di_stars_clear(&own);
  return status;
}
