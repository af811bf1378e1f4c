/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file transport.h
 * @brief Entries, blocks and row sums of the transport operator, for user-written solvers.
 *
 * @defgroup transport Transport
 * Entries, blocks and row sums of the transport operator, for user-written solvers.
 *
 * @warning Unstable interface: for user-written solvers and distributions. It may change in
 * any release, see doc/compatibility.md.
 *
 * The operator K of B = E + ρKB comes in three forms: as the exchange areas of patches
 * (hr2d_exchange_rows_create()), as links, whose blocks hr2d_blocks() gives at an order above
 * 1, and over clusters of patches (clusters.h). hr2d_leaf_sums() has its exact row sums.
 * hr2d_solution_adopt() makes a solution of the B that a user-written solver finds.
 * @{
 */
#ifndef HR2D_TRANSPORT_H
#define HR2D_TRANSPORT_H

#include <hr2d/hierarchy.h>
#include <hr2d/linkset.h>
#include <hr2d/scene.h>
#include <hr2d/solve.h>
#include <hr2d/status.h>
#include <hr2d/visibility.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The exchange areas that are not 0, as compressed rows; opaque. */
typedef struct hr2d_exchange_rows hr2d_exchange_rows;

/**
 * The exchange areas of all pairs of patches that see each other.
 * @param scene    committed; need not outlive the rows
 * @param options  NULL for the defaults
 * @param rows     receives the rows; the caller destroys them with
 *                 hr2d_exchange_rows_destroy(); unchanged on failure
 * @param counts   receives the work; may be NULL
 * @return as hr2d_exchange_matrix()
 *
 * The entries are those of hr2d_exchange_matrix(), bit for bit, without zeros. They take 12
 * bytes each, and 18 while the call runs. Cost as there, but without the matrix: it grows with
 * the pairs that see each other. The hooks of the scene provide the memory.
 */
HR2D_API hr2d_status hr2d_exchange_rows_create(const hr2d_scene *scene,
                                               const hr2d_matrix_options *options,
                                               hr2d_exchange_rows **rows,
                                               hr2d_matrix_counts *counts);

/** Frees the rows, and the arrays that the functions below returned; NULL is allowed. */
HR2D_API void hr2d_exchange_rows_destroy(hr2d_exchange_rows *rows);

/** The number of entries: twice the number of pairs that see each other. */
HR2D_API uint64_t hr2d_exchange_rows_entries(const hr2d_exchange_rows *rows);

/**
 * Where the rows start: the entries of row i are [start[i], start[i + 1]).
 * @return n + 1 items, which belong to the rows
 */
HR2D_API const uint64_t *hr2d_exchange_rows_start(const hr2d_exchange_rows *rows);

/**
 * The columns of the entries: the patches that patch i sees, in ascending order.
 * @return an item per entry; belongs to the rows
 */
HR2D_API const uint32_t *hr2d_exchange_rows_column(const hr2d_exchange_rows *rows);

/**
 * The exchange areas of the entries in scene lengths, all above 0.
 * @return an item per entry; belongs to the rows
 */
HR2D_API const double *hr2d_exchange_rows_area(const hr2d_exchange_rows *rows);

/** A row, for hr2d_exchange_rows_visit(). */
typedef struct hr2d_exchange_row {
  size_t struct_size;     /**< its size as the library knows it */
  size_t patch;           /**< i */
  size_t count;           /**< how many patches it sees */
  const uint32_t *column; /**< these patches, in ascending order */
  const double *area;     /**< their exchange areas with i in scene lengths, all above 0 */
} hr2d_exchange_row;

/**
 * Takes a row. Its arrays are valid until the function returns.
 * @param ctx  as given to hr2d_exchange_rows_visit()
 * @param row  the row
 * @return HR2D_OK, or a status that ends the call
 */
typedef hr2d_status (*hr2d_exchange_row_fn)(void *ctx, const hr2d_exchange_row *row);

/**
 * Shows all rows to a visitor, one after the other, and keeps none.
 * @param scene    committed
 * @param options  NULL for the defaults
 * @param visit    called once for each patch, in the calling thread. The order is that of walls
 *                 in the plane, and the same for each number of threads
 * @param ctx      given to `visit`
 * @param counts   receives the work; may be NULL
 * @retval other   the status of the visitor; otherwise as hr2d_exchange_matrix()
 *
 * The rows have the entries of hr2d_exchange_rows_create(), which may differ by roundings where
 * ends of patches are rounded points of a wall. At most some 1100 rows per thread are in memory
 * at once. Each pair is found from both of its ends, so that the call takes up to twice the
 * time of hr2d_exchange_rows_create().
 */
HR2D_API hr2d_status hr2d_exchange_rows_visit(const hr2d_scene *scene,
                                              const hr2d_matrix_options *options,
                                              hr2d_exchange_row_fn visit, void *ctx,
                                              hr2d_matrix_counts *counts);

/**
 * The row sums of the leaves of a hierarchy: the sum of the view factors from each leaf to all
 * patches, and the sum of those to all backs of patches. The rest up to 1 is the background:
 * the sky view factor of the leaf.
 * @param hierarchy  a hierarchy
 * @param row_from   the first patch whose leaves are asked about
 * @param row_to     the one after the last; 0: all patches from `row_from` on
 * @param front      one per element, or NULL: receives Σ A_ij F_ij / A_i over patches, set for
 *                   leaves of these patches
 * @param back       the same over backs, or NULL, which is cheaper
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  there are no such rows
 * @retval other        the status of hr2d_scene_set_progress()
 *
 * Exact up to roundings, with any occluders, and without links. Patches that no light reaches
 * count like all others. Thread-safe as long as nothing changes the hierarchy. Cost: the beams
 * of these patches, and the parts of them that leaves have. Memory: 16 bytes per element and
 * sum.
 */
HR2D_API hr2d_status hr2d_leaf_sums(const hr2d_hierarchy *hierarchy, size_t row_from,
                                    size_t row_to, double *front, double *back);

/**
 * The Galerkin blocks of links: C_lm = ∫∫ G V φ_l(x) φ_m(y) dy dx, a length, with the φ of
 * hr2d_hierarchy_pull(). A link adds Σ_m C_lm B_m / A to H_l of its first element, and Σ_l
 * C_lm B_l / A' to H_m of its second one if it carries both directions.
 * @param hierarchy  of the links; its order p is that of the blocks
 * @param link       `count` links, as from hr2d_linkset_get() or hr2d_refine_visit(), of
 * elements of different patches
 * @param count      the number of links
 * @param block      receives p × p numbers per link, row l for the first element
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  there is no such element
 * @retval other        the status of hr2d_scene_set_progress()
 *
 * Exact but for roundings, also past occluders; where elements are far from each other, as
 * exact as the order needs. C_00 of such a pair may differ from the exchange area in its last
 * digits. Thread-safe as long as nothing changes the hierarchy. Cost: O(p²) and more per link,
 * some 0.1 µs to 10 µs; pass many links in one call.
 */
HR2D_API hr2d_status hr2d_blocks(const hr2d_hierarchy *hierarchy, const hr2d_link *link,
                                 size_t count, double *block);

/**
 * Makes a solution of given values: those of a user-written solver, of another process, or of
 * one moment of a transient. Averages, points, powers, fields and pictures then work on them.
 * @param links     filled by hr2d_refine(); must outlive the solution
 * @param options   NULL for the defaults; `tolerance`, `max_iterations` and `start` do not
 * matter
 * @param field     B as for hr2d_hierarchy_pull(): the values of leaves are read, at the order
 * of the hierarchy and for all bands of the scene; they need not solve the equation
 * @param solution  receives the solution, with the irradiance of B; the caller destroys it
 * @retval HR2D_EINVAL  as hr2d_solve(), or a value is not finite
 * @retval HR2D_EUNSUPPORTED  the scene has several bands and patches of given flux (thermal.h):
 *                      `field` does not have their temperatures
 * @retval other        as hr2d_solve(), but for HR2D_ENO_SOLUTION and HR2D_ENOT_CONVERGED
 *
 * hr2d_solution_residual() gives the residual of this B in the equation. Cost: one gather.
 */
HR2D_API hr2d_status hr2d_solution_adopt(hr2d_linkset *links, const hr2d_solve_options *options,
                                         const double *field, hr2d_solution **solution);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
