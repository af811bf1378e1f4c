/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A pair of segments in the coordinates of the L¹ error, with the notation of l1.c. */
#ifndef HR2D_SRC_ORACLE_L1_FRAME_H
#define HR2D_SRC_ORACLE_L1_FRAME_H

#include <hr2d/geometry.h>

/* One of the segments as seen from the other's centre. */
typedef struct hr2di_l1_side {
  double cosine, tangent; /* at the centre; cosθ(δ) = cosine (cos δ − tangent sin δ) */
  double along;     /* scalar product of its direction and the direction from y_c to x_c */
  double slope;     /* relative change, along it, of its distance from the other's line */
  double low, high; /* the part in front of the other segment */
} hr2di_l1_side;

/* The direction from which τ is measured. */
typedef struct hr2di_l1_origin {
  double sine, cosine;               /* of the direction's δ */
  double a, b;                       /* α and β */
  double above_a, above_b;           /* 1+α and 1+β, without cancellation */
  double derivative_a, derivative_b; /* with respect to δ */
} hr2di_l1_origin;

typedef struct hr2di_l1_frame {
  double distance; /* ρ */
  double length_x, length_y;
  double per_length, per_range; /* factors that keep small integrands from underflow */
  hr2di_l1_side x, y;
  hr2di_l1_origin origin;
} hr2di_l1_frame;

/* The direction δ at τ: sin δ, α, β, 1+α and 1+β; dδ = weight dτ. */
typedef struct hr2di_l1_direction {
  double weight, sine, a, b, above_a, above_b;
} hr2di_l1_direction;

/* A linear combination f of sin δ and cos δ has, at an angle ε from the origin, the value
   f cos ε + f' sin ε = f + sin ε (f' − τ f). */
static inline hr2di_l1_direction hr2di_l1_direction_at(const hr2di_l1_frame *f, double tau) {
  const hr2di_l1_origin *o = &f->origin;
  const double weight = 2 / (1 + tau * tau), sine = tau * weight;
  const double more_a = sine * (o->derivative_a - tau * o->above_a);
  const double more_b = sine * (o->derivative_b - tau * o->above_b);
  return (hr2di_l1_direction){.weight = weight,
                              .sine = o->sine + sine * (o->cosine - tau * o->sine),
                              .a = o->a + more_a,
                              .b = o->b + more_b,
                              .above_a = o->above_a + more_a,
                              .above_b = o->above_b + more_b};
}

/* (1+p)²(1+q) − 1 */
static inline double hr2di_l1_cubic(double p, double q) {
  return p * (2 + p) + q * (1 + p) * (1 + p);
}

/* Whether j is the shorter segment and so can be y: its ends then bound t for most directions,
   while bounds that come from s cancel.  For segments of the same extent any order will do that
   does not depend on the order of the arguments. */
int hr2di_l1_in_order(const hr2d_segment *i, const hr2d_segment *j);

/* Makes the frame with the line of the centres as origin.  Returns 1; or 0 if Gc is 0 or the
   centres coincide, and then only the distance is set. */
int hr2di_l1_frame_init(const hr2d_segment *i, const hr2d_segment *j, hr2di_l1_frame *f);

/* Moves the origin to the line from y at t to x at s, or to an angle. */
void hr2di_l1_turn_to_line(hr2di_l1_frame *f, double s, double t);
void hr2di_l1_turn_to_angle(hr2di_l1_frame *f, double delta);

/* τ of the line from y at t to x at s. */
double hr2di_l1_tau(const hr2di_l1_frame *f, double s, double t);

enum { HR2DI_L1_BREAKS = 16 }; /* at most 2 ends, 2 corners, 8 roots on the edges */

/* Writes the ends of the range of τ and, between them, the places where the integrand is not
   smooth, in rising order.  Returns their number, at most HR2DI_L1_BREAKS. */
int hr2di_l1_breaks(const hr2di_l1_frame *f, double *at);

#endif
