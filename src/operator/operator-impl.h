/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kept operator: trees and links of a scene with a light that changes, the equation on
   them, and the finer one of its account. */
#ifndef HR2D_SRC_OPERATOR_OPERATOR_IMPL_H
#define HR2D_SRC_OPERATOR_OPERATOR_IMPL_H

#include <hr2d/operator.h>

#include "estimate/error-estimate.h"
#include "links/linkset-impl.h"
#include "scene/relit-scene.h"

/* What solutions need of an operator; the last user frees it. */
typedef struct hr2di_kept_trees {
  hr2d_allocator alloc;
  atomic_size_t users;
  hr2d_scene *relit; /* with the light of the solve that is under way */
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
} hr2di_kept_trees;

struct hr2d_operator {
  hr2d_allocator alloc;
  const hr2d_scene *scene; /* the caller's */
  hr2di_kept_trees *kept;
  hr2di_graded graded; /* of which `kept` owns the trees and links; without a solution */
  hr2di_resolution fineness;
  hr2d_target target;
  hr2di_stopping_test enough; /* for solves; derivatives go to the tolerance */
  size_t count;               /* lights in the relit scene, and in both equations */
  hr2di_equation eq;
  hr2di_finer finer;
  int is_made;   /* the equation is to be cleared, */
  int has_finer; /* and so is the other one */
  hr2d_account
      base; /* order, elements and links; why the scene's own light misses the target */
  int busy; /* a call is under way: one that comes from its callback is refused */
  hr2di_message message;
};

/* Writes a light over the relit scene, after it has got as many lights.  HR2D_OK, HR2D_ENOMEM,
   or HR2D_EINVAL with a message. */
hr2d_status hr2di_operator_relight(hr2d_operator *op, const hr2d_light *light);

/* Makes the relit scene and the equations for so many lights; the light is that of the scene
   then. HR2D_OK, HR2D_ENOMEM or the status of the callback. */
hr2d_status hr2di_operator_resize(hr2d_operator *op, size_t count);

/* Makes the equation for the lights of the relit scene.  As hr2di_equation_init(). */
hr2d_status hr2di_operator_make_equation(hr2d_operator *op);
void hr2di_operator_clear_equations(hr2d_operator *op);

/* Gives an equation a watch that has seen nothing: one whose last solve was stopped can be used
   again. */
void hr2di_operator_watch(const hr2d_operator *op, hr2di_equation *eq);

/* Gives the equation the light of the relit scene, with a watch that has seen nothing.  As
   hr2di_equation_set_light(). */
hr2d_status hr2di_operator_begin(hr2d_operator *op);

/* The checked copy of the caller's struct; `given` may be NULL.  HR2D_OK or HR2D_EINVAL. */
hr2d_status hr2di_operator_light_of(hr2d_operator *op, const hr2d_light *given,
                                    hr2d_light *light);

/* Begins a call, which hr2di_operator_end() ends; HR2D_OK, or HR2D_ESTATE within another one.
 */
hr2d_status hr2di_operator_enter(hr2d_operator *op);

/* Returns a status, which gets a message if it has none yet. */
hr2d_status hr2di_operator_end(hr2d_operator *op, hr2d_status status);

/* A value of an array whose packed shape is … × n × bands. */
static inline double hr2di_values_at(const hr2d_values *v, size_t n, size_t bands, size_t light,
                                     size_t k, size_t band) {
  const int packed = v->stride[0] == 0 && v->stride[1] == 0 && v->stride[2] == 0;
  const ptrdiff_t at = packed ? (ptrdiff_t)((light * n + k) * bands + band)
                              : (ptrdiff_t)light * v->stride[0] + (ptrdiff_t)k * v->stride[1] +
                                    (ptrdiff_t)band * v->stride[2];
  return v->value[at];
}

#endif
