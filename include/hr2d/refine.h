/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file refine.h
 * @brief ProjectKernel (paper, section 2): from pairs of patches to links.
 *
 * @defgroup refine Refinement
 * ProjectKernel (paper, section 2): from pairs of patches to links.
 *
 * Each pair of patches that see each other is proposed to the oracle. A pair is linked if its
 * error is acceptable or a limit holds. Otherwise the policy chooses the element to subdivide,
 * and the new pairs are proposed. The order is depth first, the result is the same in every
 * run, and there is no recursion on the C stack.
 *
 * A pair gets no link if its elements do not see each other, if occluders hide them from each
 * other, or if no light can reach them (unless HR2D_EFFECT_EMISSION is forced). If they see
 * each other in part, the link has the visible part of their exchange area.
 *
 * Refinement terminates on any input, even with ε = 0, and with any policy: subdivision stops
 * at `max_level`, or when the midpoint of an element is not a double between its ends. This is
 * 53 levels below the size of its coordinates, or 1075 levels at a corner on the origin. The
 * number of pairs of such elements can be enormous; a budget or a callback ends the refinement
 * earlier. Elements are numbered with 32 bits; more than 2³² − 2 give HR2D_EMAX_ELEMENTS.
 * @{
 */
#ifndef HR2D_REFINE_H
#define HR2D_REFINE_H

#include <hr2d/linkset.h>
#include <hr2d/options.h>
#include <hr2d/progress.h>
#include <hr2d/share.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct hr2d_solution;

/** The default of hr2d_refine_options::epsilon. */
#define HR2D_DEFAULT_EPSILON 0.1

/** As hr2d_refine_options::epsilon: ε = 0. Only a link without any error is accepted. */
#define HR2D_EPSILON_ZERO (-1e300)

/** As hr2d_refine_options::max_level: patches are not subdivided, as if the level were 0. */
#define HR2D_NO_SUBDIVISION ((unsigned)-2)

/**
 * Options of a refinement. Start from #HR2D_REFINE_OPTIONS_INIT. The members from `row_from` on
 * are unstable interface, for user-written distributions: see share.h.
 */
typedef struct hr2d_refine_options {
  size_t struct_size; /**< so that the options can grow */
  double epsilon;     /**< ε > 0, in the unit of the oracle, or #HR2D_EPSILON_ZERO; 0 stands
                           for #HR2D_DEFAULT_EPSILON */
  unsigned max_level; /**< elements on this level are not subdivided; or #HR2D_NO_SUBDIVISION;
                           0 stands for #HR2D_DEFAULT_MAX_LEVEL */
  int ordered;        /**< 1: project every ordered pair of patches, as the paper words it;
                           each link then carries one direction */
  uint64_t max_elements; /**< budget for N; 0 for none */
  uint64_t max_links;    /**< budget for L; 0 for none */
  uint64_t max_bytes;    /**< budget for elements, links and work space; 0 for none. The work
                              space takes about 60 KiB at least. Never exceeded, except by the
                              second copy that realloc may hold while it moves an array, and
                              by a few words per occluding wall */
  unsigned threads; /**< for hr2d_refine_count(), and for hr2d_refine() of an empty set without
                         `max_bytes`: 0 for one, or #HR2D_ALL_THREADS; no link, element or
                         count depends on it. hr2d_refine() shares out patches. An oracle or a
                         policy that is not flagged thread-safe is called from one thread only;
                         a thread-safe one must decide by `a`, `b`, `centre` and `length` of
                         elements alone, or divide none */
  const struct hr2d_solution *brightness; /**< for an oracle that needs brightness: a solution
                                               on the same hierarchy, whose B is the weight;
                                               NULL: emission alone */
  hr2d_progress_fn progress;              /**< optional */
  void *progress_ctx;                     /**< given to `progress` */
  int packed; /**< 1: hr2d_refine() keeps links in about 11 bytes each in the place of 16, where
                   neighbours share elements, as they do if N is far below L. No digit changes.
                   Links are made more slowly. Solves use them faster at order 1, in one band
                   and with links for both directions; otherwise more slowly */
  size_t row_from; /**< a row has the pairs of a patch with all later ones, or with all others
                        if links are directed. An empty set is filled with rows
                        [`row_from`, `row_to`) alone, and its links carry their part of the
                        light. Parts of all rows add up to the whole: links, and all counts
                        but those of elements */
  size_t row_to;   /**< 0: the number of patches */
  hr2d_claim_fn claim; /**< chooses pairs, NULL for all. With `threads` several call it at
                            once, and it must decide by `a`, `b`, `centre`, `length` and
                            `patch` of elements alone */
  void *claim_ctx;     /**< given to `claim` */
  hr2d_row_counts *row_counts; /**< receives one per patch, or NULL: the work of each row, so
                                    that rows can be shared out evenly */
  const unsigned char *rows;   /**< one per patch: 0 leaves out its row; NULL: all rows of
                                    [`row_from`, `row_to`). So the rows of a share need not
                                    follow each other */
  hr2d_share *share; /**< NULL, or one of several shares, see share.h: hr2d_refine() makes the
                          links of its rows, and divides elements as all shares together do. The
                          set keeps it, for its solves. With `rows` these are the rows of the
                          share: together shares must have each row once. hr2d_refine_count()
                        and hr2d_refine_visit() count and visit the rows of the share */
} hr2d_refine_options;

/**
 * The default of hr2d_refine_options::max_level.
 *
 * Elements of touching patches never satisfy max(A)/r ≤ ε if ε < √2, so that a limit must end
 * this recursion. A pair at a corner that is still refused at level 24 carries at most 2⁻²⁴ of
 * the exchange of a patch, and this is integrated exactly.
 * hr2d_refine_counts::limited_links counts the links that exist because of a limit.
 */
#define HR2D_DEFAULT_MAX_LEVEL 24

/** The defaults: ε = 0.1, level 24, unordered, no budgets, one thread, no callback. */
#define HR2D_REFINE_OPTIONS_INIT                                                               \
  {                                                                                            \
    sizeof(hr2d_refine_options), 0, 0, 0, 0, 0, 0, 0, NULL, NULL, NULL, 0, 0, 0, NULL, NULL,   \
        NULL, NULL, NULL                                                                       \
  }

/**
 * Does what #HR2D_REFINE_OPTIONS_INIT does, for languages without macros: sets all bytes to 0,
 * and `struct_size`.
 * @param options  the struct
 * @param size     its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_refine_options_init(hr2d_refine_options *options, size_t size);

/**
 * Fills a link set, or refines it further.
 *
 * An empty set is filled by projecting all root pairs. A set with links is refined from these
 * links (multigridding): a link that is still acceptable stays, any other is subdivided. A
 * sequence of falling ε therefore ends with the same links as its last ε alone.
 *
 * @param links    the link set; on failure it and its hierarchy are unchanged
 * @param options  NULL for the defaults
 * @retval HR2D_OK             success
 * @retval HR2D_ENOMEM         an allocation failed
 * @retval HR2D_EINVAL         ε is NaN, or negative and not #HR2D_EPSILON_ZERO; `struct_size`
 *                             is too small; `ordered` differs from the last refinement;
 *                             `brightness` is a solution on another hierarchy; or there are
 *                             no such rows
 * @retval HR2D_ESTATE         called back from a call that works on the hierarchy
 * @retval HR2D_ECALLBACK      an estimate is NaN or negative, or a subdivision is not a
 *                             HR2D_SPLIT_…
 * @retval HR2D_EMAX_ELEMENTS  the budget `max_elements` is exhausted
 * @retval HR2D_EMAX_LINKS     the budget `max_links` is exhausted
 * @retval HR2D_EMAX_BYTES     the budget `max_bytes` is exhausted
 * @retval other               the status of a callback
 *
 * Only one thread at a time may refine a hierarchy. Cost O(n² + L). If the scene calls for
 * occlusion, the beams of each patch cost time in proportion to the patches it sees, and each
 * pair whose view something bounds costs a cut of its line classes, some 0.5 µs. Memory: 70
 * bytes per element and 16 per link, or 11 (hr2d_refine_options::packed); while a set with
 * links is refined further, old and new links are held. Each of several threads has a copy of
 * the elements, and the links of up to 128 patches are held twice.
 */
HR2D_API hr2d_status hr2d_refine(hr2d_linkset *links, const hr2d_refine_options *options);

/**
 * Counts the elements and links that hr2d_refine() would make from an empty set.
 *
 * Links are neither stored nor integrated. Several threads can work
 * (hr2d_refine_options::threads). The hierarchy gets the same elements, but numbered patch by
 * patch.
 *
 * @param links    an empty set; it stays empty. On failure its hierarchy is unchanged
 * @param options  NULL for the defaults
 * @param counts   receives N, L and the rest; `exchange_areas` is 0
 * @retval HR2D_ESTATE  the set has links
 * @retval other        as hr2d_refine()
 *
 * Memory O(N) per thread. Each thread has its part of `max_bytes`: with more threads this
 * budget, but no other, can be exhausted earlier.
 */
HR2D_API hr2d_status hr2d_refine_count(hr2d_linkset *links, const hr2d_refine_options *options,
                                       hr2d_refine_counts *counts);

/**
 * Receives links in batches as they are made, in the order in which hr2d_refine() would store
 * them.
 * @param ctx    the `visit_ctx` of hr2d_refine_visit()
 * @param links  `count` links, valid during the call only
 * @param count  the number of links
 * @return HR2D_OK to continue; any other value ends the refinement with this status
 */
typedef hr2d_status (*hr2d_visitor)(void *ctx, const hr2d_link *links, size_t count);

/**
 * Gives the links to a visitor instead of storing them; otherwise like hr2d_refine_count(), but
 * on one thread.
 * @param links      an empty set; it stays empty
 * @param options    NULL for the defaults
 * @param visit      receives the links
 * @param visit_ctx  given to `visit`
 * @param counts     receives N, L and the rest
 * @return as hr2d_refine_count(), or the status of `visit`
 */
HR2D_API hr2d_status hr2d_refine_visit(hr2d_linkset *links, const hr2d_refine_options *options,
                                       hr2d_visitor visit, void *visit_ctx,
                                       hr2d_refine_counts *counts);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
