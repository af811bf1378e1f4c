/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes and ways to refine them, for tests over ranks. */
#ifndef HR2D_TESTS_PETSC_SCENES_H
#define HR2D_TESTS_PETSC_SCENES_H

#include <hr2d/hr2d.h>

typedef struct petsc_case {
  const char *name;
  hr2d_status (*add)(hr2d_scene *scene);
  const hr2d_oracle *(*oracle)(void); /* NULL: size */
  const hr2d_policy *(*policy)(void); /* NULL: original */
  double epsilon;
  double from; /* of multigridding, halved down to epsilon; 0: none */
  unsigned max_level;
  int ordered;
  hr2d_closure closure;
} petsc_case;

/* The k-th case, or NULL behind the last. */
const petsc_case *petsc_case_at(size_t k);

/* The case of that name, or NULL. */
const petsc_case *petsc_case_named(const char *name);

/* Its committed scene, or NULL; hooks as of hr2d_scene_create(). */
hr2d_scene *petsc_case_scene(const petsc_case *c, const hr2d_allocator *hooks);

#endif
