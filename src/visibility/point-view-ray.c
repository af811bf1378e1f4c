/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rays from a point x = a + t(b−a) of a patch.

   The point need not be a double: vectors from it keep their rounding errors, measured from the
   nearer end of the patch. */
#include <math.h>

#include "geometry/orient-sign.h"
#include "visibility/point-view-impl.h"

/* t times one component of b − a, with its rounding error. */
static double part(double t, double head, double tail, double *error) {
  const double product = t * head;
  *error = hr2di_tail_of_product(t, head, product) + t * tail;
  return product;
}

static hr2d_point scale(hr2d_point p) {
  return (hr2d_point){HR2DI_VIEW_SCALE * p.x, HR2DI_VIEW_SCALE * p.y};
}

void hr2di_viewpoint_init(hr2di_viewpoint *e, hr2d_segment patch, size_t number, double t) {
  *e = (hr2di_viewpoint){.patch = number, .t = t, .a = scale(patch.a), .b = scale(patch.b)};
  e->base = t <= .5 ? e->a : e->b;
  const double from_base = t <= .5 ? t : t - 1;
  const hr2di_vector ab = hr2di_vector_difference(e->b, e->a);
  e->x.x = part(from_base, ab.x, ab.tx, &e->x.tx);
  e->x.y = part(from_base, ab.y, ab.ty, &e->x.ty);
  /* Not so short that squares of its length underflow. */
  const int k = 400 - ilogb(fmax(fabs(ab.x), fabs(ab.y)));
  e->axis = (hr2di_vector){ldexp(ab.x, k), ldexp(ab.y, k), ldexp(ab.tx, k), ldexp(ab.ty, k), 0};
  e->length = hr2di_vector_length(&e->axis);
}

/* One component of (place − base) − (x − base). */
static double minus(double p, double p_tail, double q, double q_tail, double *tail) {
  const double plain = p - q;
  const double rest = hr2di_tail_of_difference(p, q, plain) + (p_tail - q_tail);
  const double head = plain + rest;
  *tail = hr2di_tail_of_difference(plain, -rest, head);
  return head;
}

void hr2di_ray_aim(const hr2di_viewpoint *e, hr2d_point place, uint32_t vertex,
                   hr2di_ray *ray) {
  ray->at = scale(place);
  ray->vertex = vertex;
  ray->horizon = 0;
  const hr2di_vector d = hr2di_vector_difference(ray->at, e->base);
  ray->to.x = minus(d.x, d.tx, e->x.x, e->x.tx, &ray->to.tx);
  ray->to.y = minus(d.y, d.ty, e->x.y, e->x.ty, &ray->to.ty);
  ray->to.e = 0;
}

void hr2di_ray_measure(const hr2di_viewpoint *e, hr2di_ray *ray) {
  const hr2di_vector d = hr2di_vector_difference(ray->at, e->base);
  ray->height = hr2di_det(&e->axis, &d) / e->length;
  ray->distance = ray->sine = ray->cosine = 0;
  if (!(ray->height > 0)) return;
  ray->distance = hr2di_vector_length(&ray->to);
  if (!(ray->distance > 0)) {
    ray->height = 0;
    return;
  }
  ray->sine = hr2di_vector_dot(&ray->to, &e->axis) / e->length / ray->distance;
  ray->cosine = ray->height / ray->distance;
}

hr2di_ray hr2di_ray_horizon(int hand, uint32_t vertex) {
  return (hr2di_ray){.sine = hand, .vertex = vertex, .horizon = hand};
}

/* Heads are right to 2^-53, and so are products and the difference. */
static int turn(const hr2di_vector *u, const hr2di_vector *v) {
  const double p = u->x * v->y, q = u->y * v->x, det = p - q;
  const double doubt = 0x1p-50 * (fabs(p) + fabs(q));
  if (det > doubt) return 1;
  if (det < -doubt) return -1;
  return hr2di_sign_of(hr2di_det(u, v));
}

int hr2di_ray_turn(const hr2di_viewpoint *e, const hr2di_ray *from, const hr2di_ray *to) {
  if (!from->horizon) return turn(&from->to, &to->to);
  const hr2di_vector d = hr2di_vector_difference(to->at, e->base);
  return from->horizon * turn(&e->axis, &d);
}

/* (u−x)×(v−x).  Vectors are good to 2^-104 of their lengths: of a small angle the shorter one
   and v−u say more. */
static double cross(const hr2di_ray *u, const hr2di_ray *v) {
  const double det = hr2di_det(&u->to, &v->to);
  if (fabs(det) >= 0x1p-40 * u->distance * v->distance) return det;
  const hr2di_vector uv = hr2di_vector_difference(v->at, u->at);
  return hr2di_det(u->distance < v->distance ? &u->to : &v->to, &uv);
}

/* ½(1 − s) with s the sine towards the horizon. */
static double to_horizon(double s, double cosine) {
  return s > 0 ? cosine * cosine / (2 * (1 + s)) : (1 - s) / 2;
}

/* ½(sin u − sin v) = cos((u+v)/2) sin((u−v)/2).  With unit vectors the first factor is the
   height of their sum over its length, the second half of the sine of the angle between them
   over the cosine of half of it; where that angle is wide nothing cancels. */
double hr2di_ray_half_sine(const hr2di_ray *u, const hr2di_ray *v) {
  if (u->horizon && v->horizon) return u->horizon > v->horizon;
  if (u->horizon) return u->horizon > 0 ? to_horizon(v->sine, v->cosine) : 0;
  if (v->horizon) return v->horizon < 0 ? to_horizon(-u->sine, u->cosine) : 0;
  const double cosine = u->sine * v->sine + u->cosine * v->cosine;
  if (cosine <= 0) return (u->sine - v->sine) / 2;
  const double sine = cross(u, v) / u->distance / v->distance;
  return (u->cosine + v->cosine) * sine / (2 * (1 + cosine));
}

double hr2di_ray_fraction(const hr2di_ray *ray, const hr2di_ray *a, const hr2di_ray *b) {
  double at_a = a->height, at_b = b->height;
  if (!ray->horizon) {
    at_a = hr2di_det(&ray->to, &a->to);
    at_b = hr2di_det(&ray->to, &b->to);
  }
  /* What has the wrong sign is but a rounding. */
  if (at_a == 0 || at_b == 0 || (at_a > 0) == (at_b > 0)) return fabs(at_a) > fabs(at_b);
  return at_a / (at_a - at_b);
}
