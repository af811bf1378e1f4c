/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a part of a segment sees: one point put in at one end of one chain.

   The end a is moved to x.  Lines that leave x on their right start between a and x and are
   dropped.  With A the left chain and B the right one:

   - x on or left of the line that leans most to the right, A[0] → B[last]: no line starts
     before x, and nothing changes.
   - x on or right of the line that leans most to the left, B[0] → A[last]: nothing is left.
   - Otherwise x becomes the first point of A, and what no tangent from x can touch is dropped
     at the start of A and at the end of B.

   The other three ends are mirror images: with the chains exchanged and all signs negated, and
   with the chains read from j to i.

   x is a rounded point of the line of i, and a tangent may be that line.  Then its sign says
   nothing, and would cost a whole view; four rules avoid these signs.  If A begins with a,
   x replaces it untested: a lies on the left of x on i.  If B begins with b, or A is the point
   a alone, i.e. the horizon of i, some line is left untested.  If B begins with b, its second
   point stays untested: x and b are on i, and this point is in front of i. */
#include <math.h>

#include "beams/line-class.h"
#include "geometry/orient-sign.h"

/* A chain as it is read: from i to j, or from j to i. */
typedef struct strip {
  const hr2d_point *first;
  ptrdiff_t step;
  size_t count;
} strip;

static strip strip_of(const hr2d_point *p, size_t count, int from_j) {
  return (strip){from_j ? p + (count - 1) : p, from_j ? -1 : 1, count};
}

static hr2d_point at(const strip *s, size_t k) {
  return s->first[(ptrdiff_t)k * s->step];
}

/* Where the chains begin and end, for the end that is moved. */
typedef struct view {
  int from_j, hand;                          /* hand is −1 in a mirror */
  unsigned near, far, other_near, other_far; /* of A, then of B */
} view;

static view view_of(hr2di_line_class_end end) {
  enum {
    A = HR2DI_LINE_CLASS_A,
    B = HR2DI_LINE_CLASS_B,
    C = HR2DI_LINE_CLASS_C,
    D = HR2DI_LINE_CLASS_D
  };
  switch (end) {
  case HR2DI_LINE_CLASS_A:
    return (view){0, 1, A, D, B, C};
  case HR2DI_LINE_CLASS_B:
    return (view){0, -1, B, C, A, D};
  case HR2DI_LINE_CLASS_C:
    return (view){1, 1, C, B, D, A};
  default:
    return (view){1, -1, D, A, C, B};
  }
}

/* Writes what is left of a strip, behind the point *x if there is one, in the order of the
   line class; returns where it begins. */
static hr2d_point *write(const strip *s, size_t first, size_t last, const hr2d_point *x,
                         int from_j, hr2d_point **room) {
  hr2d_point *start = *room;
  const size_t kept = last - first, count = kept + (x != NULL);
  for (size_t k = 0; k < kept; k++) {
    const size_t place = k + (x != NULL);
    start[from_j ? count - 1 - place : place] = at(s, first + k);
  }
  if (x) start[from_j ? count - 1 : 0] = *x;
  *room += count;
  return start;
}

/* Whether some line starts behind x. */
static int has_lines(const hr2di_line_class *s, const view *v, const strip *chain,
                     const strip *other, hr2d_point x) {
  const int horizon = chain->count == 1 && s->ends & v->near;
  if (s->ends & v->other_near || horizon) return 1;
  return v->hand * hr2di_orient_sign(at(other, 0), at(chain, chain->count - 1), x) > 0;
}

/* Roundings of coordinates, which are at most 2, and of a sign. */
#define ROUNDING 0x1p-50
#define SIGN     0x1p-46

/* Whether the two tangents lead in opposite directions within roundings.  Then all points are
   on one line, that of i or of j, and the moved end has cut off all lines but by roundings. */
static int turns_back(const hr2di_line_class *s) {
  const hr2d_point l = s->left[0], r = s->right[s->rights - 1];
  const hr2d_point m = s->right[0], n = s->left[s->lefts - 1];
  const double ux = r.x - l.x, uy = r.y - l.y, vx = n.x - m.x, vy = n.y - m.y;
  if (!(ux * vx + uy * vy < 0)) return 0;
  const double size = fabs(ux * vy) + fabs(uy * vx);
  const double noise = ROUNDING * (fabs(ux) + fabs(uy) + fabs(vx) + fabs(vy)) + SIGN * size;
  return ux * vy - uy * vx <= noise;
}

int hr2di_line_class_restrict(const hr2di_line_class *s, hr2di_line_class_end end, hr2d_point x,
                              hr2d_point *room, hr2di_line_class *child) {
  const view v = view_of(end);
  const int on_left = end == HR2DI_LINE_CLASS_A || end == HR2DI_LINE_CLASS_D;
  const strip left = strip_of(s->left, s->lefts, v.from_j);
  const strip right = strip_of(s->right, s->rights, v.from_j);
  const strip *chain = on_left ? &left : &right, *other = on_left ? &right : &left;
  const int begins = (s->ends & v.near) != 0;
  if (!begins &&
      v.hand * hr2di_orient_sign(at(chain, 0), at(other, other->count - 1), x) >= 0) {
    *child = *s;
    return 1;
  }
  if (!has_lines(s, &v, chain, other, x)) return 0;
  /* A point that is a and d stays as d, unless B begins with b: the line from b to it is that
     of i, and x is on it, too. */
  const int corner = begins && chain->count == 1 && s->ends & v.far;
  const int stays = corner && !(s->ends & v.other_near);
  size_t first = begins && !stays, last = other->count;
  while (first + 1 < chain->count &&
         v.hand * hr2di_orient_sign(x, at(chain, first), at(chain, first + 1)) <= 0)
    first++;
  const size_t min = s->ends & v.other_near && other->count > 1 ? 2 : 1;
  while (last > min &&
         v.hand * hr2di_orient_sign(x, at(other, last - 1), at(other, last - 2)) >= 0)
    last--;
  const size_t count = chain->count - first + 1;
  const hr2d_point *moved = write(chain, first, chain->count, &x, v.from_j, &room);
  const hr2d_point *rest = write(other, 0, last, NULL, v.from_j, &room);
  unsigned ends = s->ends | v.near;
  if (last < other->count) ends &= ~v.other_far;
  if (corner && !stays) ends &= ~v.far;
  *child = on_left ? (hr2di_line_class){moved, rest, count, last, ends}
                   : (hr2di_line_class){rest, moved, last, count, ends};
  return !turns_back(child);
}

void hr2di_line_class_turn(const hr2di_line_class *s, hr2d_point *room,
                           hr2di_line_class *turned) {
  const strip left = strip_of(s->left, s->lefts, 1), right = strip_of(s->right, s->rights, 1);
  *turned = (hr2di_line_class){.lefts = s->rights, .rights = s->lefts};
  turned->left = write(&right, 0, s->rights, NULL, 0, &room);
  turned->right = write(&left, 0, s->lefts, NULL, 0, &room);
  turned->ends = (s->ends << 2 | s->ends >> 2) & 15;
}
