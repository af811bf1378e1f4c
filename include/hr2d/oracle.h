/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file oracle.h
 * @brief Oracles estimate the error of a link (paper, section 2).
 *
 * @defgroup oracle Oracles
 * Oracles estimate the error of a link (paper, section 2).
 *
 * An oracle is a constant table of functions with its own context. The built-in oracles are
 * ordinary instances of the same table. An oracle answers for a batch of pairs, so that the
 * pairs share the price of the call.
 *
 * Exchange areas are exact with any occluders. But if two elements see each other only in part,
 * their link spreads over whole elements the light that falls on parts of them. An oracle finds
 * these pairs in hr2d_batch::partial. The built-in oracles increase the estimate of such a
 * pair:
 * - `size` and `bf` double it, and `size2`, the square, multiplies it by four, so that elements
 *   are half as long there.
 * - `l1` and `l1-grid` add the unoccluded exchange area. An occluder cannot change more.
 * - `bounds` takes 0 for the least kernel.
 *
 * Estimates are functions of the ends, centres and lengths that the elements hold, each taken
 * as exact. Error bounds are relative. They hold if coordinates are below 2 and if the
 * coordinates that are not 0 are within a factor of 2^800 of each other. A value below DBL_MIN
 * has an error relative to DBL_MIN, plus one step of the subnormal numbers. Decisions follow
 * the estimates, bit for bit. The tests check the bounds against MPFR, also where hill climbing
 * finds the worst case (tests/bounds/check-bounds-oracles.c, tests/bounds/check-bounds-l1.c).
 * @{
 */
#ifndef HR2D_ORACLE_H
#define HR2D_ORACLE_H

#include <hr2d/hierarchy.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Two elements for which a link is proposed. */
typedef struct hr2d_pair {
  uint32_t first;  /**< the receiver, if links are directed */
  uint32_t second; /**< the source, if links are directed */
} hr2d_pair;

/**
 * A batch of pairs, as a callback receives it. It can gain members. Nothing in it is valid
 * after the call.
 */
typedef struct hr2d_batch {
  size_t struct_size;              /**< sizeof (hr2d_batch) of the library */
  const hr2d_hierarchy *hierarchy; /**< may be read, not refined */
  const hr2d_element *elements;    /**< indexed by the numbers in `pairs` */
  const hr2d_pair *pairs;          /**< `count` pairs */
  size_t count;                    /**< at least 1 */
  double unit;                     /**< scene lengths per unit of the elements' coordinates */
  double epsilon;                  /**< the ε of this refinement */
  const unsigned char *partial;    /**< per pair: 1 if something bounds the view between the
                                        elements but their own ends, so that they may see each
                                        other only in part, otherwise 0; NULL if there is no such
                                        pair */
  const double *brightness;        /**< per element: average B relative to the brightest one,
                                        the largest over the bands; NULL unless the oracle has
                                        HR2D_ORACLE_NEEDS_BRIGHTNESS */
} hr2d_batch;

/** Properties of an oracle on which the library relies. */
enum {
  HR2D_ORACLE_SYMMETRIC = 1,       /**< (i,j) and (j,i) get the same estimate: each
                                        unordered pair of patches is projected once */
  HR2D_ORACLE_THREAD_SAFE = 2,     /**< may be called from several threads at once */
  HR2D_ORACLE_NEEDS_BRIGHTNESS = 4 /**< reads hr2d_batch::brightness */
};

/** An oracle. Set struct_size to sizeof (hr2d_oracle), and unused members to NULL. */
typedef struct hr2d_oracle {
  size_t struct_size; /**< so that the table can grow */
  const char *name;   /**< required; for messages */
  unsigned flags;     /**< HR2D_ORACLE_… */

  /**
   * Required. Writes the estimated error of each pair, ≥ 0. Infinity refuses the pair for every
   * ε. If a value is NaN, negative or not written, the refinement fails with HR2D_ECALLBACK.
   * Returns HR2D_OK, HR2D_STOPPED to end the refinement, or any other status.
   */
  hr2d_status (*estimate)(void *ctx, const hr2d_batch *batch, double *error);

  /**
   * Optional, for speed. Writes 1 if the estimate is ≤ epsilon, otherwise 0 or nothing. The
   * decision must be the same as from `estimate`; bounds may reach it at a lower cost. Used if
   * the policy has no `acceptable`. Returns a status like `estimate`.
   */
  hr2d_status (*accept)(void *ctx, const hr2d_batch *batch, double epsilon,
                        unsigned char *accepted);

  /** Optional. Called once when the owner of ctx, a link set, is destroyed. */
  void (*destroy)(void *ctx);
} hr2d_oracle;

/**
 * The oracle `size` of the paper's analysis (section 3.1): max(A_x, A_y)/r.
 *
 * r is the distance of the centres. Dimensionless, symmetric. The relative error is at most
 * 5·2^-53. The value is infinite if the centres coincide.
 *
 * @return a static table
 */
HR2D_API const hr2d_oracle *hr2d_oracle_size(void);

/**
 * The oracle `size2`: (max(A_x, A_y)/r)², the stronger bound of the paper's footnote 3.
 *
 * Dimensionless, symmetric. The relative error is at most 10·2^-53. The value is infinite if
 * the centres coincide.
 *
 * @return a static table
 */
HR2D_API const hr2d_oracle *hr2d_oracle_size2(void);

/**
 * The oracle `bf`, Hanrahan's form factor × brightness: max(F_xy, F_yx)·B_y.
 *
 * F_xy = AF/A_x and F_yx = AF/A_y, with AF of hr2d_exchange_area(): factors from the centres
 * are 0 where a centre lies on the line of the other element, although there is light. B_y is
 * relative to the brightest element. Dimensionless, directed: (i,j) asks for the light from j
 * to i. The value is 0 if B_y or AF is 0. The relative error is at most 39·2^-53; an AF below
 * DBL_MIN has an error relative to DBL_MIN.
 *
 * @return a static table
 */
HR2D_API const hr2d_oracle *hr2d_oracle_bf(void);

/**
 * The oracle `l1`: the exact L¹ error of the geometry term (section 4).
 *
 *     ∫_{A_x} ∫_{A_y} |G(x_c,y_c) − G(x,y)| dy dx
 *
 * G = 0 if one point lies behind the other element. A length, in scene lengths; symmetric. The
 * relative error is at most 1e-10. G(x_c,y_c) is taken at the unrounded midpoints of the ends.
 * If a cosine there is below 1e-140, the value is AF + G(x_c,y_c) A_x A_y, which is above the
 * error. Decisions are those of the value, but mostly come from bounds. It is infinite if the
 * elements see each other and their centres coincide.
 *
 * @return a static table
 */
HR2D_API const hr2d_oracle *hr2d_oracle_l1(void);

/**
 * The oracle `l1-grid`: the error of `l1` on the paper's 1024×1024 grid.
 *
 * G is sampled at 1024 midpoints of each patch, and the error of a pair is the sum over its
 * samples. An element of one cell or less has one sample, its centre: patches of equal length
 * are never subdivided below level 10. A length, in scene lengths; symmetric.
 *
 * The sums are in plain doubles, as in the paper. The error of each sampled G is at most
 * 2^-48·D/r², with r the distance of its points and D the extent of the pair: nearly coplanar
 * pairs keep no relative accuracy.
 *
 * @return a static table
 */
HR2D_API const hr2d_oracle *hr2d_oracle_l1_grid(void);

/**
 * The oracle `bounds` of Lischinski, Smits and Greenberg (1994): a bound of the error of `l1`.
 *
 *     (max G − min G)·A_x·A_y, but at most AF + G(x_c,y_c)·A_x·A_y
 *
 * The largest and the least kernel over the pair are exact; G = 0 if one point lies behind the
 * other element. The first form also bounds the error of every other constant between them, as
 * their mean. A length, in scene lengths; symmetric. The value is above the error also with its
 * roundings, by at most 2·10^-11 of max G·A_x·A_y. It is infinite if the elements see each
 * other and their centres coincide.
 *
 * @return a static table
 */
HR2D_API const hr2d_oracle *hr2d_oracle_bounds(void);

/**
 * Finds a built-in oracle by its name.
 * @param name  "size", "size2", "bf", "l1", "l1-grid" or "bounds"
 * @return a static table, or NULL if no oracle has this name
 */
HR2D_API const hr2d_oracle *hr2d_oracle_find(const char *name);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
