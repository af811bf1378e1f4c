/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file oracle.h
 * @brief Oracles estimate the error across a link (paper, section 2).
 *
 * An oracle is a constant table and a context of its own.  The built-in ones are
 * ordinary instances of the same table.  Oracles answer for batches of pairs, so
 * that the price of a call is shared.
 *
 * Exchange areas are exact whatever is in the way, but where a pair sees each other only
 * in part a link spreads over its elements what falls on parts of them.  An oracle learns
 * of that from hr2d_batch::partial, and the built-in ones do not accept such a pair as if
 * it were clear: `size` and `bf` count it twice and `size2`, the square, four times, so
 * that elements are half as long there.  `l1` and `l1-grid` add the most that an occluder
 * can change, the unoccluded exchange area.
 *
 * Estimates are functions of what stands in the elements: ends, centres and lengths, each taken
 * as exact.  Bounds of their errors are relative, for coordinates below 2 and, those that are
 * not 0, within 2^800 of each other; of a value below DBL_MIN, relative to that, and a step of
 * the subnormal numbers.  Decisions are those of the estimates, bit for bit.  The tests hold
 * the bounds against MPFR, also where hill climbing finds the worst
 * (tests/bounds/check-bounds-oracles.c, tests/bounds/check-bounds-l1.c).
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

/** Two elements between which a link is proposed. */
typedef struct hr2d_pair {
  uint32_t first;  /**< the receiver where links are directed */
  uint32_t second; /**< the source where links are directed */
} hr2d_pair;

/**
 * A batch of pairs, as callbacks get it.  It can gain members; nothing in it
 * may be kept beyond the call.
 */
typedef struct hr2d_batch {
  size_t struct_size;              /**< sizeof (hr2d_batch) of the library */
  const hr2d_hierarchy *hierarchy; /**< may be read, not refined */
  const hr2d_element *elements;    /**< indexed by the numbers in `pairs` */
  const hr2d_pair *pairs;          /**< `count` pairs */
  size_t count;                    /**< at least 1 */
  double unit;                     /**< scene lengths per unit of the elements' coordinates */
  double epsilon;                  /**< the ε of this refinement */
  const unsigned char *partial;    /**< for each pair 1 where an occluder reaches into the
                                        pair's shaft, so that the elements may see each other
                                        only in part; NULL where that is so for none of them */
  const double *brightness;        /**< average B of each element relative to the brightest,
                                        the largest over the bands; NULL unless the oracle
                                        has HR2D_ORACLE_NEEDS_BRIGHTNESS */
} hr2d_batch;

/** What the library may assume of an oracle. */
enum {
  HR2D_ORACLE_SYMMETRIC = 1,       /**< (i,j) and (j,i) get the same estimate: each
                                        unordered pair of patches is projected once */
  HR2D_ORACLE_THREAD_SAFE = 2,     /**< may be called from several threads at once */
  HR2D_ORACLE_NEEDS_BRIGHTNESS = 4 /**< reads hr2d_batch::brightness */
};

/** An oracle: set struct_size to sizeof (hr2d_oracle), and what is not used to NULL. */
typedef struct hr2d_oracle {
  size_t struct_size; /**< so that the table can grow */
  const char *name;   /**< required; for messages */
  unsigned flags;     /**< HR2D_ORACLE_… */

  /**
   * Required.  Writes the estimated error of each pair, ≥ 0.  NaN, and nothing written,
   * is an error of the callback (HR2D_ECALLBACK), infinity refuses for every ε.
   * Returns HR2D_OK, HR2D_STOPPED to end the refinement, or any other status.
   */
  hr2d_status (*estimate)(void *ctx, const hr2d_batch *batch, double *error);

  /**
   * Optional, for speed.  Writes 1 where the estimate is ≤ epsilon, else 0 or nothing: the
   * same decision as from `estimate`, which bounds may reach more cheaply.
   * Used where the policy does not bring its own `acceptable`.
   */
  hr2d_status (*accept)(void *ctx, const hr2d_batch *batch, double epsilon,
                        unsigned char *accepted);

  /** Optional.  Called once when the owner of ctx, a link set, is destroyed. */
  void (*destroy)(void *ctx);
} hr2d_oracle;

/**
 * max(A_x, A_y)/r, the oracle of the paper's analysis (section 3.1); r is the
 * distance of the centres.  Dimensionless, symmetric.  The relative error is at most 5·2^-53;
 * infinity where the centres coincide.
 */
HR2D_API const hr2d_oracle *hr2d_oracle_size(void);

/**
 * (max(A_x, A_y)/r)², the stronger bound of the paper's footnote 3.  The relative error is at
 * most 10·2^-53; infinity where the centres coincide.
 */
HR2D_API const hr2d_oracle *hr2d_oracle_size2(void);

/**
 * Hanrahan's form factor × brightness: G(x_c,y_c)·max(A_x,A_y)·B_y, with B
 * relative to the brightest element and the cosines of G by absolute value.
 * Dimensionless, directed: (i,j) asks for light from j to i.  0 where B_y is 0, else infinity
 * where the centres coincide.  The relative error is at most 24·2^-53, at grazing angles, too.
 */
HR2D_API const hr2d_oracle *hr2d_oracle_bf(void);

/**
 * The exact L¹ error of the geometry term (section 4),
 *   ∫_{A_x} ∫_{A_y} |G(x_c,y_c) − G(x,y)| dy dx,
 * a length, with G = 0 where one point lies behind the other element.  Symmetric.
 * The relative error is at most 1e-10, and G(x_c,y_c) is that of the unrounded midpoints of
 * the ends; where a cosine there is below 1e-140, the value is AF + G(x_c,y_c) A_x A_y, which
 * is above the error.  Decisions are those of the value, mostly from bounds.  Infinite where
 * the centres coincide.
 */
HR2D_API const hr2d_oracle *hr2d_oracle_l1(void);

/**
 * The same on the paper's 1024×1024 grid: G is sampled at 1024 midpoints of each patch,
 * and a pair's error is the sum over its samples.  An element of one cell or less has its
 * centre as sample, so that patches of one length are never subdivided below level 10.
 * A length, symmetric.  In plain doubles, as the paper's: of each sampled G the error is at
 * most 2^-48·D/r², with r the distance of its points and D the extent of the pair, so that
 * nearly coplanar pairs keep no relative accuracy.
 */
HR2D_API const hr2d_oracle *hr2d_oracle_l1_grid(void);

/**
 * A built-in oracle by name: "size", "size2", "bf", "l1", "l1-grid".
 * @return NULL if there is none of that name
 */
HR2D_API const hr2d_oracle *hr2d_oracle_find(const char *name);

#ifdef __cplusplus
}
#endif
#endif
