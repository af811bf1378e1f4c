/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The link set: a store of links, and what chose and uses them. */
#ifndef HR2D_SRC_LINKS_LINKSET_IMPL_H
#define HR2D_SRC_LINKS_LINKSET_IMPL_H

#include <hr2d/linkset.h>

#include "base/message.h"
#include "base/share.h"
#include "clusters/root-pairs.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/link-blocks.h"
#include "links/store.h"
#include "scene/scene-impl.h"

struct hr2d_linkset {
  hr2d_allocator alloc;
  hr2d_hierarchy *hierarchy;
  hr2d_oracle oracle;
  void *oracle_ctx;
  hr2d_policy policy;
  void *policy_ctx;
  hr2di_message message;
  hr2di_store store;
  hr2di_link_blocks blocks; /* of links that were solved at an order above 1, or through gas; */
  hr2di_link_blocks *more;  /* those of the groups of bands behind the first, see */
  size_t groups;            /* scene/band-groups.h: so many with the first */
  hr2d_share *share;        /* of a solve that these are the links of; NULL: all of it */
  hr2di_roots roots;        /* where a refinement begins; empty: at all pairs of patches */
  unsigned char *sees_backs; /* per patch, see hr2di_back_visibility(); NULL: nobody has looked,
                                or there are no backs to see */
  int directed;
  int solving;    /* a solve is under way, and may make blocks */
  double epsilon; /* of the last refinement; infinite before */
  hr2d_refine_counts counts;
  uint64_t own_tests; /* of visibility, by this share, also those that another one counts */
};

/* The part of its exchange area with which a pair of elements is linked, see
   hr2di_symmetry_weight(); 1 without images. */
static inline double hr2di_linkset_weight(const hr2d_linkset *links, hr2d_pair pair) {
  const hr2di_symmetry *s = &links->hierarchy->scene->symmetry;
  const hr2d_element *e = links->hierarchy->element;
  if (!s->motion) return 1;
  return hr2di_symmetry_weight(s, e[pair.first].patch, e[pair.second].patch, links->directed);
}

/* The blocks of a group of bands. */
static inline hr2di_link_blocks *hr2di_linkset_blocks(hr2d_linkset *links, size_t group) {
  return group ? &links->more[group - 1] : &links->blocks;
}

/* Those of all groups: keeps the leading part of each alone; keeps nothing. */
void hr2di_linkset_trim_blocks(hr2d_linkset *links);
void hr2di_linkset_clear_blocks(hr2d_linkset *links);

/* A set for one group of bands, as hr2di_solve() takes it: links, elements and all else are
   those of a set, which changes nothing in the meantime; the scene and the blocks are those of
   the group.  hr2di_linkset_part_end() gives back what was made. */
typedef struct hr2di_linkset_part {
  hr2d_linkset links;
  hr2d_hierarchy hierarchy;
  hr2d_linkset *whole;
  size_t group;
} hr2di_linkset_part;

void hr2di_linkset_part_begin(hr2di_linkset_part *part, hr2d_linkset *whole, size_t group);
void hr2di_linkset_part_end(hr2di_linkset_part *part);

#endif
