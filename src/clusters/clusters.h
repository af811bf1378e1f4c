/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clusters of patches: what many patches exchange with many others, at the cost of few. */
#ifndef HR2D_SRC_CLUSTERS_CLUSTERS_H
#define HR2D_SRC_CLUSTERS_CLUSTERS_H

#include <hr2d/gas.h>
#include <hr2d/oracle.h>
#include <hr2d/scene.h>

#include "base/share.h"
#include "base/watch.h"

typedef struct hr2di_clusters hr2di_clusters;

/* Called with up to 256 pairs of patches that may see each other and that no cluster link
   covers, first below second, each once. */
typedef hr2d_status (*hr2di_near_fn)(void *ctx, const hr2d_pair *pairs, size_t count);

/* Sorts all pairs of patches of a committed scene into three: those that surely cannot see
   each other, those that clusters exchange for them, and the rest, which go to `near`.  All
   of a pair that has a link is seen, but for rounding.  `accuracy` is the accuracy asked of
   cluster links, as 1e-6: of the irradiance that comes over them where B ≤ 1; 0 for none of
   them.  The scene must outlive the clusters.  HR2D_OK, HR2D_ENOMEM, or the status of
   `near` or of the watch. */
hr2d_status hr2di_clusters_create(const hr2d_scene *scene, const hr2d_allocator *alloc,
                                  double accuracy, hr2di_near_fn near, void *ctx,
                                  hr2di_watch *watch, hr2di_clusters **clusters);
/* The same links, more accurate: what they exchange differs by what those of `of` lack. HR2D_OK
   or HR2D_ENOMEM. */
hr2d_status hr2di_clusters_finer(const hr2di_clusters *of, double accuracy,
                                 hr2di_clusters **clusters);
void hr2di_clusters_destroy(hr2di_clusters *clusters);

/* The number of cluster links, each for both directions. */
uint64_t hr2di_clusters_links(const hr2di_clusters *clusters);
uint64_t hr2di_clusters_bytes(const hr2di_clusters *clusters);

/* Memory of gathers, which takes as long to get from the system as a gather.  Starts as zeroes;
   for one gather at a time. */
typedef struct hr2di_cluster_room {
  hr2d_allocator alloc;
  double *value;
  size_t values;
} hr2di_cluster_room;

void hr2di_cluster_room_clear(hr2di_cluster_room *room);

/* What gas leaves of the kernel, T, or what it takes, 1 − T: see base/bickley.h. */
typedef struct hr2di_cluster_gas {
  hr2d_section section;
  double absorption; /* per scaled length; 0: nothing is in the way */
  int absorbed;      /* 1 − T, which without gas is 0 */
} hr2di_cluster_gas;

/* That of a scene, in the one κ that all its bands have. */
hr2di_cluster_gas hr2di_cluster_gas_of(const hr2d_scene *scene, int absorbed);

typedef struct hr2di_cluster_gather {
  size_t order, bands;
  hr2di_cluster_gas gas;
  hr2d_share *share;        /* NULL: there is but one */
  unsigned threads;         /* as in options */
  hr2di_cluster_room *room; /* for this and the next gather; NULL: this one has its own */
  hr2di_watch *watch;
} hr2di_cluster_gather;

/* power += K radiosity over the cluster links.  Both are patches × order × bands, with an
   order of 1 to HR2D_MAX_ORDER: coefficient l of a patch is that of φ_l(ξ) = √(2l+1) P_l(ξ),
   ξ from −1 at its start to 1 at its end; radiosity_k = (1/A)∫ B φ_k, power_k = ∫∫ G B φ_k
   dy dx in scaled lengths, with the part of G that gas leaves or takes. Within the ellipse of
   an expansion |T| ≤ 1, as Re r ≥ 0 there: gas needs no more points.  Self-adjoint but for
   rounding.  The same bits every time, on any number of threads. Of several shares all call it;
   each does a part, and all get the sum.  HR2D_OK, HR2D_ENOMEM or the status of the watch or of
   another share. */
hr2d_status hr2di_clusters_gather(hr2di_clusters *clusters, const hr2di_cluster_gather *how,
                                  const double *radiosity, double *power);

#endif
