/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes scenes from numbers, from the names in the reference tables, and from plans. */
#ifndef HR2D_TESTS_SUPPORT_SCENES_H
#define HR2D_TESTS_SUPPORT_SCENES_H

#include <hr2d/hr2d.h>

/* An empty scene; `hooks` may be NULL. */
hr2d_scene *test_new_scene(const hr2d_allocator *hooks);

/* A committed scene of examples/scenes. */
hr2d_scene *test_shipped_scene(const char *file);

/* Commits, and says why if that fails. */
void test_commit(hr2d_scene *scene);

/* Asserts that the message of a scene contains the phrase. */
void test_expect_message(const hr2d_scene *scene, const char *phrase);

/* A black patch with one side, ax ay bx by; the scene of several, not committed. */
hr2d_patch test_patch(double ax, double ay, double bx, double by);
void test_add_black(hr2d_scene *scene, const double at[4]);
hr2d_scene *test_open_scene(const double (*at)[4], size_t count);

/* Adds a grey patch. */
hr2d_status test_add_patch(hr2d_scene *scene, hr2d_segment at, double emission,
                           double reflectance, hr2d_sides sides);

/* A committed scene of patches of three bands each. */
hr2d_scene *test_coloured_scene(const hr2d_segment *at, const double (*emission)[3],
                                const double (*reflectance)[3], size_t count);

/* A committed scene of patches that are given as ax ay bx by E ρ each. */
hr2d_scene *test_scene(const double (*patch)[6], size_t count);
hr2d_scene *test_scene_hooked(const double (*patch)[6], size_t count,
                              const hr2d_allocator *hooks);

/* A committed scene that a reference table names; radiosity_scene_name() lists the names. */
hr2d_scene *test_named_scene(const char *name);

struct plan;    /* of room-plans.h */
struct randoms; /* of random.h */

/* The materials of the patches of a plan. */
typedef struct test_paint {
  struct randoms *r;  /* draws ρ and E; NULL: each takes its maximum */
  double reflectance; /* maximum */
  double emission;    /* maximum */
  int isothermal;     /* E = 1 − ρ instead */
  double background;
  unsigned forced; /* 1 << effect for each effect that is forced */
} test_paint;

/* A committed scene of a plan; its crossings, if it has any, are cut. */
hr2d_scene *test_painted_scene(const struct plan *room, const test_paint *paint);

#endif
