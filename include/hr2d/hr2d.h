/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file hr2d.h
 * @brief libhr2d: the radiosity equation in the plane by hierarchical radiosity.
 *
 * "The paper" is R. Garmann and H. Müller, "On the Computational Complexity of Hierarchical
 * Radiosity". The objects, in the order in which they are made:
 *
 * | object         | contents                              | header      |
 * |----------------|---------------------------------------|-------------|
 * | hr2d_scene     | patches with emission and reflectance | scene.h     |
 * | hr2d_hierarchy | a binary tree of elements per patch   | hierarchy.h |
 * | hr2d_linkset   | pairs of elements that exchange light | linkset.h   |
 * | hr2d_solution  | radiosity on every element            | solve.h     |
 *
 * hr2d_refine() fills the link set (refine.h). An oracle (oracle.h) and a policy (policy.h)
 * decide which pairs are linked. Each object must outlive the objects that are made from it:
 * destroy them in the opposite order.
 *
 * Most programs need the calls of these headers only:
 * - scene.h: patches, from a file or one by one; an even background.
 * - accuracy.h: hr2d_solve_to() makes hierarchy, links and solution for a target error.
 * - solve.h: hr2d_solution_average() and the other results.
 * - field.h: hr2d_field_at() computes the light at points between the patches.
 *
 * The algorithm of the paper, step by step:
 * - hierarchy.h, oracle.h, policy.h, linkset.h, refine.h: ProjectKernel.
 * - study.h: hr2d_study_run() measures L against N, hr2d_study_law() predicts them.
 *
 * More kinds of scenes:
 * - thermal.h: hr2d_scene_add_thermal() adds patches of given temperature or heat flux.
 * - daylight.h: hr2d_scene_set_sun() lights the scene by a sun.
 * - sky.h: hr2d_scene_set_continuous_sky() lights the scene by a sky of CIE or Perez.
 * - symmetry.h: hr2d_scene_add_mirror() and hr2d_scene_set_period() repeat the scene.
 *
 * More light:
 * - operator.h: hr2d_operator_solve() solves for other light on the same geometry, with what
 *   was found out for the first one; responses and gradients.
 *
 * More questions:
 * - enclosure.h: hr2d_enclose() gives lower and upper ends of averages that hold for certain.
 * - visibility.h: exchange areas with occluders, of two segments and of all patches, and the
 *   view from a point.
 * - geometry.h: hr2d_exchange_area() computes the exchange of two segments in free view.
 * - lint.h: hr2d_scene_lint() warns about valid properties of a scene that may not be meant.
 * - state.h: hr2d_state_write() saves a stage of a long solve.
 *
 * Of use with all of them: status.h, options.h, memory.h, progress.h, version.h.
 *
 * Unstable interface, for user-written solvers and distributions; it may change in any release
 * (doc/compatibility.md):
 * - transport.h: rows, blocks and row sums of the transport operator.
 * - clusters.h: far-field exchange between clusters of patches.
 * - share.h: several processes that share a solve; claims on pairs.
 *
 * A whole program:
 *
 * @code{.c}
 * #include <hr2d/hr2d.h>
 * #include <stdio.h>
 *
 * int main(void) {
 *   hr2d_scene *scene = NULL;
 *   hr2d_hierarchy *hierarchy = NULL;
 *   hr2d_linkset *links = NULL;
 *   hr2d_solution *solution = NULL;
 *   hr2d_status status = hr2d_scene_create(NULL, &scene);
 *   if (!status) status = hr2d_scene_read(scene, "room.geojson");
 *   if (!status) status = hr2d_scene_commit(scene);
 *   if (!status) status = hr2d_hierarchy_create(scene, &hierarchy);
 *   if (!status) status = hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links);
 *   if (!status) status = hr2d_refine(links, NULL);
 *   if (!status) status = hr2d_solve(links, NULL, &solution);
 *   if (!status) printf("patch 0: B = %.4f\n", hr2d_solution_average(solution, 0, 0));
 *   hr2d_solution_destroy(solution);
 *   hr2d_linkset_destroy(links);
 *   hr2d_hierarchy_destroy(hierarchy);
 *   hr2d_scene_destroy(scene);
 *   return status;
 * }
 * @endcode
 *
 * examples/tour.c makes its patches itself:
 *
 * @include tour.c
 *
 * Conventions:
 * - Errors: a call that can fail returns HR2D_OK or the kind of its error, and then its objects
 *   are unchanged (status.h). Memory comes from hooks (memory.h).
 * - Units: coordinates and lengths are in scene lengths. Emission E, radiosity B and irradiance
 *   H are power per scene length, called the unit of E. Reflectance is dimensionless.
 * - Letters in costs: n patches, N elements, L links, p the order. A getter without a stated
 *   cost takes constant time.
 * - Pointers must not be NULL, and indices must be in range, unless the comment says otherwise.
 * - Structs of options and tables of functions begin with `struct_size`. It tells the library
 *   which members the caller knows, so that the struct can grow. Start from the macro …_INIT.
 *   In options 0 and NULL mean the default (options.h).
 * - Stops: every long call asks a callback whether to go on (progress.h).
 * - Threads: different objects may be used from different threads. Only one thread at a time
 *   may change an object; several threads may read an object that no thread changes.
 */
#ifndef HR2D_H
#define HR2D_H

#include <hr2d/accuracy.h>
#include <hr2d/daylight.h>
#include <hr2d/enclosure.h>
#include <hr2d/field.h>
#include <hr2d/gas.h>
#include <hr2d/geometry.h>
#include <hr2d/hierarchy.h>
#include <hr2d/linkset.h>
#include <hr2d/lint.h>
#include <hr2d/memory.h>
#include <hr2d/operator.h>
#include <hr2d/options.h>
#include <hr2d/oracle.h>
#include <hr2d/policy.h>
#include <hr2d/progress.h>
#include <hr2d/refine.h>
#include <hr2d/scene.h>
#include <hr2d/sky.h>
#include <hr2d/solve.h>
#include <hr2d/state.h>
#include <hr2d/status.h>
#include <hr2d/study.h>
#include <hr2d/symmetry.h>
#include <hr2d/thermal.h>
#include <hr2d/version.h>
#include <hr2d/visibility.h>

/* Unstable interface. */
#include <hr2d/clusters.h>
#include <hr2d/share.h>
#include <hr2d/transport.h>

#endif
