/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file hr2d.h
 * @brief libhr2d: the radiosity equation in the plane by hierarchical radiosity.
 *
 * After Garmann & Müller, "On the Computational Complexity of Hierarchical
 * Radiosity".  The objects, in the order in which they are made:
 *
 *   hr2d_scene      patches with emission and reflectance    scene.h
 *   hr2d_hierarchy  a binary tree of elements per patch      hierarchy.h
 *   hr2d_linkset    accepted pairs, chosen by an oracle and  linkset.h, refine.h
 *                   a policy (oracle.h, policy.h)
 *   hr2d_solution   radiosity on every element               solve.h
 *
 * Objects are destroyed in the opposite order.  Who wants digits rather than links asks
 * hr2d_solve_to(), which makes the lot (accuracy.h).  What a long solve has reached
 * is kept by hr2d_state_write() (state.h).  Beside them are exchange areas of
 * segments (geometry.h), those with occluders and of all patches (visibility.h), and the
 * study of L against N (study.h).
 *
 * @include tour.c
 */
#ifndef HR2D_H
#define HR2D_H

#include <hr2d/accuracy.h>
#include <hr2d/geometry.h>
#include <hr2d/hierarchy.h>
#include <hr2d/linkset.h>
#include <hr2d/memory.h>
#include <hr2d/oracle.h>
#include <hr2d/policy.h>
#include <hr2d/refine.h>
#include <hr2d/scene.h>
#include <hr2d/solve.h>
#include <hr2d/state.h>
#include <hr2d/status.h>
#include <hr2d/study.h>
#include <hr2d/version.h>
#include <hr2d/visibility.h>

#endif
