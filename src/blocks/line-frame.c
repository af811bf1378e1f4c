/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the ends of elements are, to twice the digits of doubles. */
#include "blocks/line-vector.h"
#include "blocks/lines.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* Ends that are nearer to each other than this part of both elements are one. */
#define NEAR 0x1p-48

/* The part of a patch behind an element, to its own digits; exact if all divisions were
   halvings, and 0 if there is none. */
static double rest_behind(const hr2d_hierarchy *h, uint32_t element) {
  double rest = 0;
  for (uint32_t parent = h->parent[element]; parent != element; parent = h->parent[element]) {
    const double right = hr2di_element_right_part(h->element, parent);
    rest = element == h->element[parent].child
               ? right + hr2di_element_left_part(h->element, parent) * rest
               : right * rest;
    element = parent;
  }
  return rest;
}

static hr2di_vector whole_patch(const hr2di_patch *p) {
  return hr2di_vector_difference(p->scaled.b, p->scaled.a);
}

/* The end of i is `rest` of its patch before the corner, and the start of j as much behind it;
   or, if not `at_end`, the other way round. */
static void measure_from(hr2di_line_frame *f, int at_end, hr2di_vector before,
                         hr2di_vector behind) {
  if (at_end) {
    f->b = before;
    f->c = behind;
    f->a = hr2di_vector_minus(&f->b, &f->u);
    f->d = hr2di_vector_plus(&f->c, &f->v);
  } else {
    f->a = behind;
    f->d = before;
    f->b = hr2di_vector_plus(&f->a, &f->u);
    f->c = hr2di_vector_minus(&f->d, &f->v);
  }
}

/* The ends of an element, of the vector `size`, from the nearer end of its patch, which has the
   vector `along`; returns that end.  The last element of a patch ends where the patch does. */
static hr2d_point measure_along(const hr2d_hierarchy *h, uint32_t element,
                                const hr2di_vector *along, const hr2di_vector *size,
                                hr2di_vector *start, hr2di_vector *end) {
  const hr2d_segment patch = h->scene->patch[h->element[element].patch].scaled;
  const double from = hr2di_element_start(h, element);
  if (from <= 0.5) {
    *start = hr2di_vector_times(along, from);
    *end = rest_behind(h, element) > 0 ? hr2di_vector_plus(start, size) : *along;
    return patch.a;
  }
  *end = hr2di_vector_times(along, -rest_behind(h, element));
  *start = hr2di_vector_minus(end, size);
  return patch.b;
}

static void measure_apart(hr2di_line_frame *f, const hr2d_hierarchy *h, hr2d_pair pair,
                          const hr2di_vector *along_p, const hr2di_vector *along_q) {
  f->origin = measure_along(h, pair.first, along_p, &f->u, &f->a, &f->b);
  const hr2d_point other = measure_along(h, pair.second, along_q, &f->v, &f->c, &f->d);
  const hr2di_vector difference = hr2di_vector_difference(other, f->origin);
  f->c = hr2di_vector_plus(&f->c, &difference);
  f->d = hr2di_vector_plus(&f->d, &difference);
}

void hr2di_line_frame_init(hr2di_line_frame *f, const hr2d_hierarchy *h, hr2d_pair pair) {
  const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
  const hr2di_patch *p = &h->scene->patch[i->patch], *q = &h->scene->patch[j->patch];
  const hr2di_vector along_p = whole_patch(p), along_q = whole_patch(q), zero = {0};
  *f = (hr2di_line_frame){.i = {i->a, i->b}, .j = {j->a, j->b}};
  f->u = hr2di_vector_times(&along_p, i->length / p->length);
  f->v = hr2di_vector_times(&along_q, j->length / q->length);
  if (hr2di_point_same(p->scaled.b, q->scaled.a)) {
    f->origin = p->scaled.b;
    measure_from(f, 1, hr2di_vector_times(&along_p, -rest_behind(h, pair.first)),
                 hr2di_vector_times(&along_q, hr2di_element_start(h, pair.second)));
  } else if (hr2di_point_same(p->scaled.a, q->scaled.b)) {
    f->origin = p->scaled.a;
    measure_from(f, 0, hr2di_vector_times(&along_q, -rest_behind(h, pair.second)),
                 hr2di_vector_times(&along_p, hr2di_element_start(h, pair.first)));
  } else if (hr2di_point_same(i->b, j->a)) {
    f->origin = i->b;
    measure_from(f, 1, zero, zero);
  } else if (hr2di_point_same(i->a, j->b)) {
    f->origin = i->a;
    measure_from(f, 0, zero, zero);
  } else {
    measure_apart(f, h, pair, &along_p, &along_q);
  }
}

/* Where the point nearest to `at` is on the line from `from` along `along`. */
static double place(const hr2di_vector *at, const hr2di_vector *from,
                    const hr2di_vector *along) {
  const double scale = hr2di_vector_scale(along); /* so that no product underflows */
  const hr2di_vector difference = hr2di_vector_minus(at, from);
  const hr2di_vector away = hr2di_vector_scaled(&difference, scale);
  const hr2di_vector whole = hr2di_vector_scaled(along, scale);
  return hr2di_vector_dot(&away, &whole) / hr2di_vector_dot(&whole, &whole);
}

hr2di_vertex hr2di_line_vertex(const hr2di_line_frame *f, hr2di_incident_point p) {
  const int on_i = p.on & HR2DI_ON_I, on_j = p.on & HR2DI_ON_J;
  const int a = on_i && hr2di_point_same(p.at, f->i.a);
  const int b = on_i && hr2di_point_same(p.at, f->i.b);
  const int c = on_j && hr2di_point_same(p.at, f->j.a);
  const int d = on_j && hr2di_point_same(p.at, f->j.b);
  hr2di_vertex z = {.on = p.on};
  z.at = a ? f->a : b ? f->b : c ? f->c : d ? f->d : hr2di_vector_difference(p.at, f->origin);
  if (on_i) z.s = a || b ? b : place(&z.at, &f->a, &f->u);
  if (on_j) z.t = c || d ? d : place(&z.at, &f->c, &f->v);
  return z;
}

/* Moves the end of an element that is behind the other's line to that line.  `height` has the
   heights of this end and of the opposite one. */
static hr2di_vertex clipped(const hr2di_line_frame *f, unsigned own, double at,
                            const double height[2]) {
  hr2di_vertex z = {.on = own};
  const double here = height[at > 0], there = height[at == 0];
  const hr2di_vector *from = own == HR2DI_ON_I ? &f->a : &f->c;
  const hr2di_vector *along = own == HR2DI_ON_I ? &f->u : &f->v;
  if (here < 0) at = height[0] / (height[0] - height[1]);
  if (here <= 0 && there > 0) z.on = HR2DI_ON_BOTH;
  const hr2di_vector offset = hr2di_vector_times(along, at);
  z.at = hr2di_vector_plus(from, &offset);
  const unsigned other = z.on & ~own;
  z.s = own == HR2DI_ON_I ? at : other ? place(&z.at, &f->a, &f->u) : 0;
  z.t = own == HR2DI_ON_J ? at : other ? place(&z.at, &f->c, &f->v) : 0;
  return z;
}

static double size_of(const hr2di_vector *p) {
  return fmax(fabs(p->x), fabs(p->y));
}

/* Ends of i and of j within roundings are one, as where i stands on j: the direction from one
   to the other would be noise. */
static void join(const hr2di_line_frame *f, hr2di_vertex *on_i, hr2di_vertex *on_j) {
  const hr2di_vector offset = hr2di_vector_minus(&on_j->at, &on_i->at);
  if (size_of(&offset) > NEAR * fmin(size_of(&f->u), size_of(&f->v))) return;
  on_i->t = on_j->t;
  on_j->s = on_i->s;
  on_j->at = on_i->at;
  on_i->on = on_j->on = HR2DI_ON_BOTH;
}

int hr2di_line_ends(const hr2di_line_frame *f, hr2di_vertex right[2], hr2di_vertex left[2]) {
  const hr2di_vector to_c = hr2di_vector_minus(&f->c, &f->a);
  const hr2di_vector to_d = hr2di_vector_minus(&f->d, &f->a);
  const hr2di_vector to_b = hr2di_vector_minus(&f->b, &f->c);
  const hr2di_vector u = hr2di_vector_scaled(&f->u, hr2di_vector_scale(&f->u));
  const hr2di_vector v = hr2di_vector_scaled(&f->v, hr2di_vector_scale(&f->v));
  /* v × (a − c) = (c − a) × v */
  const double above_i[] = {hr2di_vector_cross(&u, &to_c), hr2di_vector_cross(&u, &to_d)};
  const double above_j[] = {hr2di_vector_cross(&to_c, &v), hr2di_vector_cross(&v, &to_b)};
  if (!(above_i[0] > 0 || above_i[1] > 0) || !(above_j[0] > 0 || above_j[1] > 0)) return 0;
  left[0] = clipped(f, HR2DI_ON_I, 0, above_j);
  right[0] = clipped(f, HR2DI_ON_I, 1, above_j);
  right[1] = clipped(f, HR2DI_ON_J, 0, above_i);
  left[1] = clipped(f, HR2DI_ON_J, 1, above_i);
  join(f, &right[0], &right[1]);
  join(f, &left[0], &left[1]);
  return 1;
}
