/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file refine.h
 * @brief ProjectKernel (paper, section 2): from root pairs to links.
 *
 * Each pair of patches that see each other is proposed to the oracle.  A pair is
 * linked if its error is acceptable or a limit holds; otherwise the policy says
 * which element to subdivide and the new pairs are proposed.  The order is depth
 * first, the result the same for every run, and nothing recurs on the C stack.
 * It ends on any input.  With an ε that no pair meets, be it 0, and with any policy, elements
 * end at `max_level` or where their midpoint is no longer a double between their ends: 53
 * levels below the size of their coordinates, 1075 at a corner on the origin.  Pairs of such
 * elements may be more than anyone can wait for, unless a budget ends it, or a callback.
 * Elements are numbered with 32 bits; beyond 2³² − 2 it is HR2D_EMAX_ELEMENTS.
 *
 * A pair that cannot see each other is dropped; so is one that occluders hide, and what
 * no light can reach (HR2D_EFFECT_EMISSION, which can be forced).  A pair that sees each
 * other in part is linked with what is left of its exchange area.
 */
#ifndef HR2D_REFINE_H
#define HR2D_REFINE_H

#include <hr2d/linkset.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct hr2d_solution;

/** How far a long call has come. */
typedef struct hr2d_progress {
  size_t struct_size; /**< sizeof (hr2d_progress) of the library */
  const char *phase;  /**< "refine", "coefficients", "solve" or "factors" */
  uint64_t elements;  /**< N so far */
  uint64_t links;     /**< L so far */
  double fraction;    /**< of the root pairs done, or of the digits gained; in [0,1] */
  double residual;    /**< relative residual while solving, else 0 */
} hr2d_progress;

/**
 * Called every few thousand links and at every iteration.
 *
 * Like every callback it may call the library on other objects, and read those that the call
 * works on.  What would change them, a refinement or another order of a hierarchy, a solve of
 * links that are refined or solved on, returns HR2D_ESTATE there.  It must not destroy them,
 * nor leave by longjmp() or an exception.
 *
 * @return HR2D_OK to go on; anything else ends the call with that status, be it in the
 *         enumeration or not, and leaves its objects as they were
 */
typedef hr2d_status (*hr2d_progress_fn)(void *ctx, const hr2d_progress *progress);

/** Where a refinement stops.  Start from #HR2D_REFINE_OPTIONS_INIT. */
typedef struct hr2d_refine_options {
  size_t struct_size;    /**< so that the options can grow */
  double epsilon;        /**< ε ≥ 0, in the oracle's unit */
  unsigned max_level;    /**< elements on this level are not subdivided; see below */
  int ordered;           /**< 1: project every ordered pair of patches, as the paper's wording
                              has it; each link then carries one direction */
  uint64_t max_elements; /**< budget for N; 0 for none */
  uint64_t max_links;    /**< budget for L; 0 for none */
  uint64_t max_bytes;    /**< budget for elements, links and work space, these of about 60 KiB
                              at least; 0 for none.  Kept at every moment, but for what realloc
                              holds twice while it moves an array, and a few words per wall
                              that is looked past */
  unsigned threads;      /**< for hr2d_refine_count(): 0 for all; the counts do not depend
                              on it.  An oracle or a policy that is not flagged thread-safe
                              is asked from one thread only */
  const struct hr2d_solution *brightness; /**< for an oracle that needs brightness: the B to
                                               weight with; NULL: emission alone */
  hr2d_progress_fn progress;              /**< optional */
  void *progress_ctx;                     /**< given to `progress` */
} hr2d_refine_options;

/**
 * The default of `max_level`.  Elements of touching patches never satisfy
 * max(A)/r ≤ ε for ε < √2, so a limit must end that recursion.  A pair at a
 * corner that is still refused at level 24 carries at most 2⁻²⁴ of a patch's
 * exchange, exactly integrated.  hr2d_refine_counts::limited_links says how many
 * links exist because of a limit.
 */
#define HR2D_DEFAULT_MAX_LEVEL 24

/** ε = 0.1, the default limit, no budgets, one thread, no callback. */
#define HR2D_REFINE_OPTIONS_INIT                                                               \
  { sizeof(hr2d_refine_options), 0.1, HR2D_DEFAULT_MAX_LEVEL, 0, 0, 0, 0, 1, NULL, NULL, NULL }

/**
 * Fills a link set, or refines it further.
 *
 * An empty set is filled by projecting all root pairs.  A set that has links is
 * refined from these (multigridding): a link stays where it is still acceptable
 * and is subdivided elsewhere, so that falling ε give in the end what the last ε
 * alone would give.
 *
 * @param links    on failure it and its hierarchy are as before
 * @param options  NULL for the defaults
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_EINVAL (ε negative or NaN; `ordered` changed
 *         between refinements), HR2D_EMAX_ELEMENTS, HR2D_EMAX_LINKS, HR2D_EMAX_BYTES,
 *         HR2D_ECALLBACK for an estimate that is NaN or negative or a subdivision
 *         without meaning, HR2D_ESTATE from a callback of a call that works on the
 *         hierarchy, or the status of a callback
 *
 * One hierarchy is refined by one thread at a time.  Cost O(n² + L), and where the scene
 * calls for occlusion a test per wall in the shaft of each pair that has any; memory 64
 * bytes per element and 16 per link, twice that for the links while a set that
 * has links is refined further.
 */
HR2D_API hr2d_status hr2d_refine(hr2d_linkset *links, const hr2d_refine_options *options);

/**
 * Counts what hr2d_refine() would make of an empty set, without storing or
 * integrating a link, and on several threads if wanted.  The hierarchy grows by the
 * elements it would grow by, numbered patch by patch.
 *
 * @param links   an empty set; it stays empty
 * @param counts  receives N, L and the rest
 * @return as hr2d_refine(), and HR2D_ESTATE if the set has links
 * Memory O(N) per thread, of which each has its part of `max_bytes`, so that only this budget
 * may be spent sooner on more threads.  Progress is told from the calling thread.
 */
HR2D_API hr2d_status hr2d_refine_count(hr2d_linkset *links, const hr2d_refine_options *options,
                                       hr2d_refine_counts *counts);

/**
 * Gets links as they are made, in batches, in the order hr2d_refine() would store
 * them.
 * @param links  valid during the call only
 * @return HR2D_OK to go on; anything else ends the refinement with that status
 */
typedef hr2d_status (*hr2d_visitor)(void *ctx, const hr2d_link *links, size_t count);

/**
 * Streams the links to a visitor instead of storing them; otherwise as
 * hr2d_refine_count().
 */
HR2D_API hr2d_status hr2d_refine_visit(hr2d_linkset *links, const hr2d_refine_options *options,
                                       hr2d_visitor visit, void *visit_ctx,
                                       hr2d_refine_counts *counts);

#ifdef __cplusplus
}
#endif
#endif
