/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file hierarchy.h
 * @brief The binary trees of elements that refinement grows on the patches.
 *
 * @defgroup hierarchy Hierarchy of elements
 * The binary trees of elements that refinement grows on the patches.
 *
 * Element k is the root of patch k. Children are made in adjacent pairs, only when a refinement
 * needs them, and always after their parent. A loop over rising indices therefore meets parents
 * before children.
 * @{
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

/** The value that calls return in place of an element, or of its level, if there is none. */
#define HR2D_NO_ELEMENT ((uint32_t)-1)

/** One binary tree per patch; opaque. */
typedef struct hr2d_hierarchy hr2d_hierarchy;

/**
 * A node of the tree of a patch.
 *
 * Coordinates and length are in units of hr2d_scene_unit(), so that callbacks need not expect
 * overflow. An element fills one cache line. Its layout does not change within a version number
 * of the shared library.
 *
 * Refinement halves elements, and each midpoint is rounded once. On level k, coordinates
 * therefore differ from exact halving by at most k roundings of the largest coordinate of the
 * patch, 2^-53 each. In patches far from the origin this can be as much as the element; the
 * rounded centre can then lie off the line of the element. An element whose midpoint is one of
 * its ends is not halved. Lengths have the error of the patch length, 3 roundings, and no other
 * error above 2^-1000.
 *
 * hr2d_solve_to() also divides elements at points that are not the midpoint.
 */
typedef struct hr2d_element {
  /** start, shared bit for bit with the neighbour */
  hr2d_point a, b;   /**< end, shared bit for bit with the neighbour */
  hr2d_point centre; /**< midpoint of a and b */
  double length;     /**< the patch length, halved once per level, exactly */
  uint32_t child;    /**< the left child; the right child is child + 1; 0 for a leaf */
  uint32_t patch;    /**< the patch of the element */
} hr2d_element;

/** The sizes of a hierarchy. */
typedef struct hr2d_hierarchy_counts {
  uint64_t elements; /**< N: all nodes of all trees, roots included */
  uint64_t leaves;   /**< nodes without children */
  unsigned levels;   /**< the deepest level; a root is on level 0 */
} hr2d_hierarchy_counts;

/**
 * Makes a hierarchy that consists of n roots.
 * @param scene      committed; must outlive the hierarchy
 * @param hierarchy  receives the hierarchy; the caller destroys it
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_ESTATE  the scene is not committed
 *
 * Hierarchies of one scene may be made and used from different threads. Cost O(n).
 */
HR2D_API hr2d_status hr2d_hierarchy_create(const hr2d_scene *scene, hr2d_hierarchy **hierarchy);

/** The highest order of an element. */
#define HR2D_MAX_ORDER 32

/**
 * Sets the order p: each element carries p Legendre coefficients of radiosity.
 *
 * Each link then transports p × p coefficients. Order 1, the initial order, is the paper's
 * algorithm with one constant per element. Refinement does not depend on the order. A high
 * order suits elements as large as B is smooth and links as large as G is smooth, for example
 * max(A)/r ≤ 1/2. Existing solutions keep their order.
 *
 * @param hierarchy  a hierarchy
 * @param order      1 to #HR2D_MAX_ORDER
 * @retval HR2D_OK      success
 * @retval HR2D_EINVAL  `order` is out of range
 * @retval HR2D_ESTATE  called back from a refinement or a solve on this hierarchy
 */
HR2D_API hr2d_status hr2d_hierarchy_set_order(hr2d_hierarchy *hierarchy, unsigned order);

/**
 * The order p: the number of coefficients that each element carries.
 * @param hierarchy  a hierarchy
 * @return 1 to #HR2D_MAX_ORDER
 */
HR2D_API unsigned hr2d_hierarchy_order(const hr2d_hierarchy *hierarchy);

/**
 * Destroys a hierarchy. Destroy all link sets on it first.
 * @param hierarchy  may be NULL
 */
HR2D_API void hr2d_hierarchy_destroy(hr2d_hierarchy *hierarchy);

/**
 * The scene of a hierarchy.
 * @param hierarchy  a hierarchy
 * @return the scene given to hr2d_hierarchy_create()
 */
HR2D_API const hr2d_scene *hr2d_hierarchy_scene(const hr2d_hierarchy *hierarchy);

/**
 * The number of elements, the number of leaves and the depth.
 * @param hierarchy  a hierarchy
 * @return the sizes; constant cost
 */
HR2D_API hr2d_hierarchy_counts hr2d_hierarchy_count(const hr2d_hierarchy *hierarchy);

/**
 * All elements.
 * @param hierarchy  a hierarchy
 * @return an array indexed by element number, owned by the hierarchy; valid until the hierarchy
 *         is refined or destroyed
 */
HR2D_API const hr2d_element *hr2d_hierarchy_elements(const hr2d_hierarchy *hierarchy);

/**
 * For each element, the element of which it is an image, in a scene with mirrors or a period
 * (symmetry.h). After a refinement patches and images are divided alike. A program that
 * divides elements itself may divide patches further than their images, but not the other way
 * round. Cost: O(elements).
 * @param hierarchy  a hierarchy
 * @param original   receives for each element the number of the element of a patch that it is
 *                   the image of; its own number, if it is none
 * @retval HR2D_OK  success
 * @retval other    the status of hr2d_scene_set_progress()
 */
HR2D_API hr2d_status hr2d_hierarchy_originals(const hr2d_hierarchy *hierarchy,
                                              uint32_t *original);

/**
 * The level of an element.
 * @param hierarchy  a hierarchy
 * @param element    the number of an element
 * @return the level; a root is on level 0
 */
HR2D_API unsigned hr2d_element_level(const hr2d_hierarchy *hierarchy, uint32_t element);

/**
 * The parent of an element.
 * @param hierarchy  a hierarchy
 * @param element    the number of an element
 * @return the number of the parent; a root is its own parent
 */
HR2D_API uint32_t hr2d_element_parent(const hr2d_hierarchy *hierarchy, uint32_t element);

/**
 * Finds the leaf that contains a point of a patch. Cost: one step per level.
 * @param hierarchy  a hierarchy
 * @param patch      the index of a patch
 * @param t          fraction of the patch in [0,1], counted from its start
 * @return the number of the leaf; for the border of two leaves, the leaf behind the border
 */
HR2D_API uint32_t hr2d_hierarchy_leaf(const hr2d_hierarchy *hierarchy, size_t patch, double t);

/**
 * Divides a leaf, for trees that do not come from a refinement: those of another program, or
 * of another process that shares the work.
 * @param hierarchy  a hierarchy
 * @param element    a leaf
 * @param t          where, as a fraction of the element from its start, in (0, 1)
 * @param child      receives the left child, the right one is the next; may be NULL
 * @retval HR2D_OK             success
 * @retval HR2D_ENOMEM         an allocation failed
 * @retval HR2D_EINVAL         this is not a leaf; or no double lies there between its ends; or
 * it is on level 65,535
 * @retval HR2D_ESTATE         called back from a refinement or a solve on this hierarchy
 * @retval HR2D_EMAX_ELEMENTS  there would be more than 2³² − 2 elements
 *
 * Constant cost. With t = ½ it makes the children that a refinement makes. Only one thread at a
 * time may change a hierarchy.
 */
HR2D_API hr2d_status hr2d_hierarchy_divide(hr2d_hierarchy *hierarchy, uint32_t element,
                                           double t, uint32_t *child);

/**
 * Pull (paper, section 2): gives each element with children the values that follow from its
 * children, by the two-scale relation. For user-written solvers on the links of a set.
 *
 * A field has `order` × `bands` values per element: value l of band b of element k is at
 * field[(k·order + l)·bands + b], and is the coefficient of φ_l = √(2l+1) P_l(2t−1), with t
 * from 0 to 1 along the element and hr2d_hierarchy_order() coefficients. Coefficient 0 is the
 * mean.
 *
 * @param hierarchy  a hierarchy
 * @param bands      at least 1
 * @param field      the values of leaves are read, all others are set
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  `bands` is 0
 * @retval other        the status of hr2d_scene_set_progress(); the field has no meaning then
 *
 * Thread-safe as long as nothing changes the hierarchy. Cost O(N·p²·bands).
 */
HR2D_API hr2d_status hr2d_hierarchy_pull(const hr2d_hierarchy *hierarchy, size_t bands,
                                         double *field);

/**
 * Push (paper, section 2): adds to each element the field of its ancestors, in terms of its
 * own φ_l. It is the transpose of the pull in the scalar product Σ A x y over elements.
 * @param hierarchy  a hierarchy
 * @param bands      at least 1
 * @param field      as for hr2d_hierarchy_pull(); all values are read, and those of elements
 *                   that are not roots are changed
 * @return as hr2d_hierarchy_pull()
 */
HR2D_API hr2d_status hr2d_hierarchy_push(const hr2d_hierarchy *hierarchy, size_t bands,
                                         double *field);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
