/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file clusters.h
 * @brief Far-field exchange between clusters of patches, for user-written solvers.
 *
 * @defgroup clusters Clusters
 * Far-field exchange between clusters of patches, for user-written solvers.
 *
 * @warning Unstable interface: for user-written solvers and distributions. It may change in
 * any release, see doc/compatibility.md.
 *
 * Where n patches see n others, as in a round room, there are n² exchange areas. Far from each
 * other, patches of one cluster have nearly the same ones, so that two clusters exchange their
 * light over a few points of each. hr2d_clusters_create() sorts the pairs of patches into
 * - pairs that surely do not see each other;
 * - pairs whose clusters are linked: hr2d_clusters_gather() sums their exchange;
 * - near pairs, which it hands over one by one.
 *
 * If hr2d_refine_options::claim keeps near pairs alone, a refinement has the links of these.
 * Then power = hr2d_clusters_gather() + Σ AF_ij B_j over the links. hr2d_solve_to() does so by
 * itself from 256 patches on; these functions are for user-written solvers and distributions.
 * @{
 */
#ifndef HR2D_CLUSTERS_H
#define HR2D_CLUSTERS_H

#include <hr2d/options.h>
#include <hr2d/oracle.h>
#include <hr2d/progress.h>
#include <hr2d/scene.h>
#include <hr2d/share.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The links between clusters of patches. */
typedef struct hr2d_clusters hr2d_clusters;

/** Options of the calls below; members that are 0 have their defaults. */
typedef struct hr2d_clusters_options {
  size_t struct_size;        /**< so that the options can grow */
  double accuracy;           /**< of links, when clusters are created: the error of the
                                  irradiance over all links of a patch is about this where B ≤
                                  1; 0 for #HR2D_DEFAULT_CLUSTER_ACCURACY */
  unsigned threads;          /**< of a gather: 0 for one, or #HR2D_ALL_THREADS; no bit depends
                                  on it */
  hr2d_share *share;         /**< of a gather: NULL, or each share does a part, and all get the
                                  sum; then all call it alike */
  hr2d_progress_fn progress; /**< optional; with the phase "refine" or "solve" */
  void *progress_ctx;        /**< given to `progress` */
} hr2d_clusters_options;

/** The default of hr2d_clusters_options::accuracy. */
#define HR2D_DEFAULT_CLUSTER_ACCURACY 1e-6

/** The defaults. */
#define HR2D_CLUSTERS_OPTIONS_INIT                                                             \
  { sizeof(hr2d_clusters_options), 0, 0, NULL, NULL, NULL }

/**
 * Does what #HR2D_CLUSTERS_OPTIONS_INIT does, for languages without macros: sets all bytes to
 * 0, and `struct_size`.
 * @param options  the struct
 * @param size     its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_clusters_options_init(hr2d_clusters_options *options, size_t size);

/**
 * Receives near pairs.
 * @param ctx    as given
 * @param pairs  patches, the first below the second; valid during the call only
 * @param count  1 to 256 of them
 * @return HR2D_OK to go on; anything else ends the call with this status
 */
typedef hr2d_status (*hr2d_near_pairs_fn)(void *ctx, const hr2d_pair *pairs, size_t count);

/**
 * Sorts the pairs of patches of a scene, and links clusters.
 * @param scene     committed, without mirrors and periods; must outlive the clusters
 * @param options   NULL for the defaults
 * @param near      called from the calling thread with each pair that may see each other and
 *                  that no link covers, once; the same pairs in the same order every time
 * @param ctx       given to `near`
 * @param clusters  receives them; free them with hr2d_clusters_destroy(). NULL on failure
 * @retval HR2D_OK           success
 * @retval HR2D_ENOMEM       an allocation failed
 * @retval HR2D_EINVAL       `struct_size` is too small, or the accuracy is not in [0, 1]
 * @retval HR2D_ESTATE       the scene is not committed
 * @retval HR2D_EUNSUPPORTED the scene has mirrors or a period
 * @retval other             the status of `near` or of the progress callback
 *
 * Two patches that a link covers see all of each other, but for roundings. Patches with walls
 * between them are near, or are known not to see each other. A near pair may still not see
 * each other.
 *
 * Several calls may run on one scene at once. Cost about O(n) in a round room: 0.8 s for
 * 100,000 patches and the default accuracy, 7.6 s for a million.
 */
HR2D_API hr2d_status hr2d_clusters_create(const hr2d_scene *scene,
                                          const hr2d_clusters_options *options,
                                          hr2d_near_pairs_fn near, void *ctx,
                                          hr2d_clusters **clusters);

/** Frees clusters; NULL is allowed. */
HR2D_API void hr2d_clusters_destroy(hr2d_clusters *clusters);

/**
 * The number of links between clusters, each for both directions.
 * @param clusters  from hr2d_clusters_create()
 * @return the number; constant cost
 */
HR2D_API uint64_t hr2d_clusters_links(const hr2d_clusters *clusters);

/**
 * The memory that clusters hold.
 * @param clusters  from hr2d_clusters_create()
 * @return bytes; constant cost
 */
HR2D_API uint64_t hr2d_clusters_bytes(const hr2d_clusters *clusters);

/**
 * Gathers over the links between clusters: the light that each patch receives from them.
 * @param clusters   from hr2d_clusters_create()
 * @param options    NULL for the defaults
 * @param order      1 to #HR2D_MAX_ORDER
 * @param bands      at least 1, whatever the scene has
 * @param radiosity  n × order × bands values: coefficient l of patch i in band b, (1/A)∫ B φ_l
 * dx with φ_l(ξ) = √(2l+1) P_l(ξ), ξ from −1 at its start to 1 at its end; at order 1 averages
 * of B
 * @param power      receives as many: ∫ H φ_l dx of the light over the links, in the unit of E
 *                   times scene lengths; divided by hr2d_scene_length() they are coefficients
 *                   of H. Undefined on failure
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  `struct_size` is too small, or order or bands are out of range
 * @retval other        the status of the progress callback, or of another share
 *
 * The operator is symmetric but for roundings, and has the same bits on any number of threads.
 * One call at a time on one object. Cost O(links); 0.3 s in a round room of 100,000 patches.
 * With fewer than some 2,000 patches a product with all exchange areas takes less.
 */
HR2D_API hr2d_status hr2d_clusters_gather(hr2d_clusters *clusters,
                                          const hr2d_clusters_options *options, size_t order,
                                          size_t bands, const double *radiosity, double *power);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
