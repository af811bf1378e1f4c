/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file hierarchy.h
 * @brief The binary trees of elements that refinement grows on the patches.
 *
 * The root of patch k is element k.  Children are made in adjacent pairs, only
 * when a refinement asks for them, and always after their parent, so that a loop
 * over rising indices meets parents before children.
 */
#ifndef HR2D_HIERARCHY_H
#define HR2D_HIERARCHY_H

#include <hr2d/geometry.h>
#include <hr2d/scene.h>
#include <hr2d/status.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** One binary tree per patch; opaque. */
typedef struct hr2d_hierarchy hr2d_hierarchy;

/**
 * A node of a patch's tree.  Coordinates and length are in units of
 * hr2d_scene_unit(), so that no callback needs to fear overflow.  One cache
 * line; the layout does not change within a library version number.
 *
 * Refinement halves: each midpoint is rounded once, and so on level k coordinates are off those
 * of exact halving by at most k roundings, of 2^-53, of the patch's largest coordinate.  Where
 * that is as much as the element, as in patches far from the origin, the centre, which is
 * rounded, may lie off its line; an element whose midpoint is one of its ends is not halved.
 * Lengths carry the error of the patch's, 3 roundings, and no other above 2^-1000.
 */
typedef struct hr2d_element {
  hr2d_point a, b;   /**< end points, shared bit for bit with the neighbours */
  hr2d_point centre; /**< midpoint of a and b */
  double length;     /**< the patch's length halved once per level, exactly */
  uint32_t child;    /**< the left child, the right one is child + 1; 0 for a leaf */
  uint32_t patch;    /**< the patch it belongs to */
} hr2d_element;

/** The sizes of a hierarchy. */
typedef struct hr2d_hierarchy_counts {
  uint64_t elements; /**< N: all nodes of all trees, roots included */
  uint64_t leaves;   /**< nodes without children */
  unsigned levels;   /**< the deepest level; a root is on level 0 */
} hr2d_hierarchy_counts;

/**
 * Makes a hierarchy of n roots and nothing else.
 *
 * @param scene      committed; must outlive the hierarchy
 * @param hierarchy  receives the hierarchy; the caller destroys it
 * @return HR2D_OK, HR2D_ENOMEM, or HR2D_ESTATE if the scene is not committed
 * Hierarchies of one scene may be made and used from different threads.  Cost O(n).
 */
HR2D_API hr2d_status hr2d_hierarchy_create(const hr2d_scene *scene, hr2d_hierarchy **hierarchy);

/** The highest order of an element. */
#define HR2D_MAX_ORDER 32

/**
 * Lets each element carry `order` Legendre coefficients of radiosity in place of one
 * constant; a link then transports order × order of them.  Order 1, as at first, is the
 * paper's algorithm.  Refinement does not depend on it: elements as large as B is smooth
 * and links as large as G is smooth are what a high order wants, as max(A)/r ≤ 1/2.
 * Solutions made before keep the order they were made with.
 *
 * @param order  1 to #HR2D_MAX_ORDER
 * @return HR2D_OK, HR2D_EINVAL, or HR2D_ESTATE from a callback of a refinement or a solve
 */
HR2D_API hr2d_status hr2d_hierarchy_set_order(hr2d_hierarchy *hierarchy, unsigned order);

/** How many coefficients each element carries. */
HR2D_API unsigned hr2d_hierarchy_order(const hr2d_hierarchy *hierarchy);

/** Destroys a hierarchy; NULL is allowed.  Link sets on it must be gone. */
HR2D_API void hr2d_hierarchy_destroy(hr2d_hierarchy *hierarchy);

/** The scene a hierarchy stands on. */
HR2D_API const hr2d_scene *hr2d_hierarchy_scene(const hr2d_hierarchy *hierarchy);

/** N, leaves and depth.  Constant cost. */
HR2D_API hr2d_hierarchy_counts hr2d_hierarchy_count(const hr2d_hierarchy *hierarchy);

/**
 * All elements, indexed by element number.
 * Valid until the hierarchy is refined or destroyed.
 */
HR2D_API const hr2d_element *hr2d_hierarchy_elements(const hr2d_hierarchy *hierarchy);

/** The level of an element; a root is on level 0. */
HR2D_API unsigned hr2d_element_level(const hr2d_hierarchy *hierarchy, uint32_t element);

/** The parent of an element; a root is its own. */
HR2D_API uint32_t hr2d_element_parent(const hr2d_hierarchy *hierarchy, uint32_t element);

/**
 * The leaf that holds the point at fraction t of a patch, counted from its start.
 * A point on the border of two leaves belongs to the one behind it.
 * @param t  in [0,1]
 * Cost: one step per level.
 */
HR2D_API uint32_t hr2d_hierarchy_leaf(const hr2d_hierarchy *hierarchy, size_t patch, double t);

#ifdef __cplusplus
}
#endif
#endif
