/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file field.h
 * @brief The light at points of the plane between the patches.
 *
 * @defgroup field Field: the light between the patches
 * The light at points of the plane between the patches.
 *
 * From a point x the radiosity B(x,ω) is seen in direction ω: that of the patch whose front is
 * there, the background where nothing is, and 0 at the back of a patch that has only a front.
 *
 * | quantity | what it is                 | unit      |
 * |----------|----------------------------|-----------|
 * | mean     | M = (1/2π) ∫ B dω          | that of E |
 * | flux     | Φ = ∫ (B/2) ω dω, a vector | that of E |
 * | sky      | the part with nothing      | 1         |
 * | back     | the part with black backs  | 1         |
 *
 * Where the light of a sun arrives (daylight.h), its irradiance I in direction d adds I/π to M
 * and −I d/|d| to Φ; the border of that light counts for one of its sides.
 *
 * The last two are parts of all directions. In a furnace with B = 1, M is 1 and Φ is 0.
 *
 * H(n) = ∫ (B/2) n·ω dω over n·ω > 0 is the irradiance of a small plane at x with normal n, as
 * of a sensor or a panel that hides no light: hr2d_field_values::irradiance. A sun adds
 * I max(0, −n·d/|d|). n·Φ = H(n) − H(−n). If E is in W/m², σT⁴ = M gives the mean radiant
 * temperature T.
 *
 * **Exactness.** Visibility is exact, and so are the integrals over the B_h of a solution, as
 * hr2d_solution_at() has it. The error of M is some 1e-15 of the largest B. At distance d from
 * an end of a leaf, in units of hr2d_scene_unit(), 1e-16/d times the jump of B_h there is
 * added. Φ and H(n) have π times as much. The error of B_h comes on top. If |B_h − B| ≤ e_j on
 * patch j, and x sees j in the part s_j of all directions, then
 *
 *     |δM| ≤ Σ s_j e_j,   |δΦ| ≤ π Σ s_j e_j   and   |δH(n)| ≤ π Σ s_j(n) e_j
 *
 * with the part s_j(n) that is above the plane, which hr2d_field_values::error receives if
 * hr2d_field_options::patch_error has the e_j. With one e for all patches this is at most e
 * times the part of all directions in which fronts are. With hr2d_field_options::account the e
 * are found for each leaf instead: twice the difference of B_h from B' at some points of the
 * leaf (hr2d_solution_gather()), plus the account's bound of the error of B'. That B' is no
 * farther from B_h between these points is tested, not proved.
 *
 * In a scene with a period, light from beyond the images is extrapolated: see symmetry.h.
 *
 * **Places.** Every point is in one of three kinds of places, #hr2d_place.
 * - A point on a patch, or nearer to one than 2^-48 of hr2d_scene_unit(), has the limit from
 *   its front: half of its directions see the patch itself. The back of a patch with two sides
 *   is a front as well; of the two sides the one with the lower index counts. Where patches
 *   meet, they divide the directions into sectors. The limit is then along the line that
 *   halves one of these sectors: the widest between two fronts if there is any, of equal ones
 *   that beside the patch with the lowest index, and with the lowest one on its other side. On
 * the inside of a wall the limit is taken at 2^-44 of the unit.
 * - A point that sees no front, and no background with light or sun, is outside: within an
 *   obstacle, or behind the walls of a closed room. All its values but `sky` and `back` are
 *   NaN.
 * - All other points are between the patches.
 * @{
 */
#ifndef HR2D_FIELD_H
#define HR2D_FIELD_H

#include <hr2d/accuracy.h>
#include <hr2d/geometry.h>
#include <hr2d/options.h>
#include <hr2d/progress.h>
#include <hr2d/scene.h>
#include <hr2d/solve.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Where a point is; see above. */
typedef enum hr2d_place {
  HR2D_PLACE_BETWEEN = 0, /**< between the patches */
  HR2D_PLACE_PATCH,       /**< on a patch: values are limits from its front */
  HR2D_PLACE_OUTSIDE      /**< where no light can be: values are NaN */
} hr2d_place;

/** Options of the calls for the field. Start from #HR2D_FIELD_OPTIONS_INIT. */
typedef struct hr2d_field_options {
  size_t struct_size;        /**< so that the options can grow */
  unsigned threads;          /**< 0 for one, or #HR2D_ALL_THREADS; no bit depends on it */
  hr2d_progress_fn progress; /**< optional; with the phase "field", from the calling thread */
  void *progress_ctx;        /**< given to `progress` */
  const double *patch_error; /**< bounds of |B_h − B|, patches × bands, patch by patch, in the
                                  unit of E; only read; NULL: none are known */
  const hr2d_account *account; /**< that of hr2d_solve_to() or hr2d_solution_account() of the
                                    solution, with hr2d_target::points:
                                    hr2d_field_values::error, if it is wanted and without
                                    `patch_error`, is then measured, in the time of p + 3
                                    gathers for each leaf. Only read; NULL: none */
  const hr2d_point *normal;    /**< normals of planes of any tilt, of any length but 0, for
                                    hr2d_field_values::irradiance; only read */
  size_t normals; /**< how many: 0 or 1, one for all points; or one for each point */
} hr2d_field_options;

/** The defaults: one thread, no callback, no errors, no planes. */
#define HR2D_FIELD_OPTIONS_INIT                                                                \
  { sizeof(hr2d_field_options), 0, NULL, NULL, NULL, NULL, NULL, 0 }

/**
 * Does what #HR2D_FIELD_OPTIONS_INIT does, for languages without macros: sets all bytes to 0,
 * and `struct_size`.
 * @param options  the struct
 * @param size     its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_field_options_init(hr2d_field_options *options, size_t size);

/** The values of a field, point by point. Start from #HR2D_FIELD_VALUES_INIT. */
typedef struct hr2d_field_values {
  size_t struct_size; /**< so that the struct can grow */
  double *mean;       /**< receives M, points × bands; NULL: not wanted, as all below */
  double *flux;       /**< receives Φ, points × bands × 2, x before y */
  double *error; /**< receives the bound of |δM|, points × bands; |δΦ| is at most π times
                      that. NaN without hr2d_field_options::patch_error or an account
                      with a finite bound at points. A grid's tolerance comes on top */
  double *sky;   /**< receives the part of all directions with nothing, points */
  double *back;  /**< receives the part of all directions with backs, points */
  unsigned char *place; /**< receives an #hr2d_place each, points */
  double *cut_off;      /**< receives the part of all directions past the ends of a period,
                             points; 0 without one. symmetry.h has its accuracy */
  double *irradiance;   /**< receives H(n) with hr2d_field_options::normal, points × bands, at
                             the cost of a second view from each point */
  double
      *irradiance_error; /**< receives the bound of |δH(n)|, points × bands; NaN as `error` */
} hr2d_field_values;

/** Nothing is wanted. */
#define HR2D_FIELD_VALUES_INIT                                                                 \
  { sizeof(hr2d_field_values), NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL }

/**
 * The field at points.
 * @param solution  a solution
 * @param at        `count` points in scene coordinates
 * @param count     number of points
 * @param options   NULL for the defaults
 * @param values    what is wanted; the arrays are undefined on failure
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a coordinate is not finite, irradiances are wanted without normals, a
 *                      normal is 0, or a `struct_size` is too small
 * @retval HR2D_ESCENE  the scene has no effect of occlusion, and so many patches cross each
 *                      other within roundings that the plane between them is unknown
 * @retval other        the status of the progress callback
 *
 * Several threads may ask one solution at once. With several threads in the options the hooks
 * of the scene are called from all of them. Cost: for a call O(leaves), and O(n log n) to
 * triangulate the plane if the scene does not call for occlusion; for a point some 20 ns for
 * each triangle of the plane that its view passes, and 0.1 µs to 1 µs for each leaf that it
 * sees. Points in an order in which neighbours follow each other are found faster.
 */
HR2D_API hr2d_status hr2d_field_at(const hr2d_solution *solution, const hr2d_point *at,
                                   size_t count, const hr2d_field_options *options,
                                   const hr2d_field_values *values);

/** A grid of points: nodes. Start from #HR2D_FIELD_GRID_INIT. */
typedef struct hr2d_field_grid {
  size_t struct_size; /**< so that the struct can grow */
  hr2d_point low;     /**< the first node of the first row */
  hr2d_point high;    /**< the last node of the last row; may be anywhere from `low` */
  size_t columns;     /**< nodes in a row, at least 1; of one alone `low` counts */
  size_t rows;        /**< number of rows, at least 1; likewise */
  double tolerance; /**< the error of M that interpolation may add, as a part of the range of M
                         in each band; at least 0; 0: nothing is interpolated */
} hr2d_field_grid;

/** A grid of 1 × 1 nodes at the origin, exact. */
#define HR2D_FIELD_GRID_INIT                                                                   \
  { sizeof(hr2d_field_grid), {0, 0}, {0, 0}, 1, 1, 0 }

/** The work of a call for a grid. */
typedef struct hr2d_field_counts {
  uint64_t exact;        /**< views from nodes, some of them twice */
  uint64_t interpolated; /**< nodes that were interpolated */
  uint64_t triangles;    /**< triangles of the plane that views passed */
} hr2d_field_counts;

/**
 * The field at the nodes of a grid, row by row: value k is that of node k % columns of row
 * k / columns.
 * @param solution  a solution
 * @param grid      the grid
 * @param options   NULL for the defaults
 * @param values    what is wanted; the arrays are undefined on failure
 * @param counts    receives the work; may be NULL
 * @retval HR2D_EINVAL  a coordinate is not finite, there is no row or column or there are too
 *                      many, the tolerance is not in [0,1], irradiances are wanted with a
 *                      tolerance or without normals, or a `struct_size` is too small
 * @return otherwise as hr2d_field_at()
 *
 * The range of M is its largest value minus its least one on each 16th node of each 16th row,
 * but at least 1e-6 of the largest. With a tolerance:
 * - Views may be off by an eighth of it: B_h is merged into fewer leaves that differ from it by
 *   no more, and M is a mean of B.
 * - Blocks of up to 16 × 16 nodes are interpolated linearly between 3 × 3 views. First all
 *   borders of light are found, the lines across which the slope of M jumps, each with a bound
 *   of its jump. The tolerance bounds the error that the borders in a block cause, so that
 *   none is missed between views. Between borders M is smooth, and the views themselves, with
 *   two more between them, show how much it bends. Other blocks are divided.
 *
 * Tests find the tolerance kept at all nodes of random scenes
 * (tests/unit/field/check-field-grid.c). Flux is held to π times the tolerance, shares to the
 * tolerance itself, both if they are wanted. Places are exact.
 *
 * Without a tolerance every node equals hr2d_field_at(). If the scene has more ends of patches
 * than a quarter of the nodes, nothing is interpolated: every node equals hr2d_field_at() up
 * to the eighth of the tolerance that views may be off. Cost: a view from each end of a patch,
 * and then from some nodes: in a room with 30 patches, on 1000 × 700 nodes within 1e-3, from
 * about every 7th. Memory beside the values: 2.9 KB times (6 + 4·bands) for each thread, 8
 * bytes times bands for 256 nodes, 56 bytes for each border (each end begins one for every end
 * that it sees), but at most 65,536 or 64 for each tile of 16 × 16 nodes, and 4 bytes for each
 * of up to 256 borders that cross a tile. Where there are more, all nodes have views.
 */
HR2D_API hr2d_status hr2d_field_on_grid(const hr2d_solution *solution,
                                        const hr2d_field_grid *grid,
                                        const hr2d_field_options *options,
                                        const hr2d_field_values *values,
                                        hr2d_field_counts *counts);

/** The view factors from a point to each patch, for hr2d_field_rows_visit(). */
typedef struct hr2d_field_row {
  size_t struct_size;    /**< its size as the library knows it */
  size_t point;          /**< which of the points it is */
  hr2d_place place;      /**< where the point is */
  size_t count;          /**< how many patches it sees */
  const uint32_t *patch; /**< these patches, in ascending order */
  const double *share;   /**< the part of all directions in which each of them is seen; with
                              `sky` and `back` they sum to 1 */
  const double *factor;  /**< the form factor to each of them from a line with the normal, which
                              may be 0: ½ ∫ n·ω dω over n·ω > 0; NULL without normals */
  double sky;            /**< the part of all directions with nothing */
  double back;           /**< the part of all directions with black backs */
  double sky_factor;     /**< the form factor to nothing; 0 without normals */
  double back_factor;    /**< the form factor to backs; with all others they sum to 1 */
} hr2d_field_row;

/**
 * Takes a row. Its arrays are valid until the function returns.
 * @param ctx  as given to hr2d_field_rows_visit()
 * @param row  the row
 * @return HR2D_OK, or a status that ends the call
 */
typedef hr2d_status (*hr2d_field_row_fn)(void *ctx, const hr2d_field_row *row);

/**
 * The view factors of points: Σ share·B is M, and Σ factor·B is H(n), for any B that is
 * constant on each patch.
 * @param scene    committed
 * @param at       `count` points in scene coordinates
 * @param normal   a vector for each point, of any length but 0; NULL: no form factors
 * @param count    number of points
 * @param options  NULL for the defaults; `patch_error` is not used
 * @param visit    called once for each point, in their order, in the calling thread
 * @param ctx      given to `visit`
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a coordinate is not finite, a normal is 0, or `struct_size` is too small
 * @retval HR2D_ESCENE  as hr2d_field_at()
 * @retval HR2D_ESTATE  the scene is not committed
 * @retval other        the status of the visitor or of the progress callback
 *
 * Errors are some roundings of 1. Several calls may run on one scene at once. At most 1024 rows
 * are in memory at once. Cost as hr2d_field_at(), without the leaves.
 */
HR2D_API hr2d_status hr2d_field_rows_visit(const hr2d_scene *scene, const hr2d_point *at,
                                           const hr2d_point *normal, size_t count,
                                           const hr2d_field_options *options,
                                           hr2d_field_row_fn visit, void *ctx);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
