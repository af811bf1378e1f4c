/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The link set: a store of links, and the oracle and policy that choose them. */
#include <math.h>
#include <stddef.h>

#include "base/alloc.h"
#include "base/sized-struct.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/linkset-impl.h"
#include "scene/band-groups.h"
#include "scene/scene-impl.h"

/* Whether a table of the caller's size has a member. */
#define HAS(table, type, member)                                                               \
  ((table)->struct_size >= offsetof(type, member) + sizeof(table)->member)

hr2d_status hr2d_linkset_create(hr2d_hierarchy *hierarchy, const hr2d_oracle *oracle,
                                void *oracle_ctx, const hr2d_policy *policy, void *policy_ctx,
                                hr2d_linkset **links) {
  if (!hierarchy || !links) return HR2D_EINVAL;
  if (!oracle) oracle = hr2d_oracle_size();
  if (!policy) policy = hr2d_policy_original();
  if (!HAS(oracle, hr2d_oracle, estimate) || !oracle->name || !oracle->estimate)
    return HR2D_EINVAL;
  if (!HAS(policy, hr2d_policy, flags) || !policy->name) return HR2D_EINVAL;
  hr2d_linkset *made = hr2di_alloc_zero(&hierarchy->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  made->alloc = hierarchy->alloc;
  made->hierarchy = hierarchy;
  made->epsilon = HUGE_VAL;
  hr2di_sized_copy(&made->oracle, sizeof made->oracle, oracle);
  hr2di_sized_copy(&made->policy, sizeof made->policy, policy);
  made->oracle_ctx = oracle_ctx;
  made->policy_ctx = policy_ctx;
  if (!made->policy.preferred_subdivision)
    made->policy.preferred_subdivision = hr2d_policy_original()->preferred_subdivision;
  made->groups = hr2di_band_groups(hierarchy->scene);
  if (made->groups > 1) {
    made->more = hr2di_alloc_zero(&made->alloc, made->groups - 1, sizeof *made->more);
    if (!made->more) {
      hr2di_alloc_free(&hierarchy->alloc, made);
      return HR2D_ENOMEM;
    }
  }
  *links = made;
  return HR2D_OK;
}

void hr2di_linkset_trim_blocks(hr2d_linkset *links) {
  for (size_t g = 0; g < links->groups; g++)
    hr2di_link_blocks_trim(hr2di_linkset_blocks(links, g), &links->alloc);
}

void hr2di_linkset_clear_blocks(hr2d_linkset *links) {
  for (size_t g = 0; g < links->groups; g++)
    hr2di_link_blocks_clear(hr2di_linkset_blocks(links, g), &links->alloc);
}

void hr2di_linkset_part_begin(hr2di_linkset_part *part, hr2d_linkset *whole, size_t group) {
  part->whole = whole;
  part->group = group;
  part->hierarchy = *whole->hierarchy;
  part->hierarchy.scene = whole->hierarchy->scene->group[group];
  part->hierarchy.refining = 0;
  atomic_init(&part->hierarchy.readers, 0);
  part->links = *whole;
  part->links.hierarchy = &part->hierarchy;
  part->links.blocks = *hr2di_linkset_blocks(whole, group);
  part->links.more = NULL;
  part->links.groups = 1;
  part->links.solving = 0;
}

void hr2di_linkset_part_end(hr2di_linkset_part *part) {
  hr2d_linkset *whole = part->whole;
  *hr2di_linkset_blocks(whole, part->group) = part->links.blocks;
  whole->sees_backs = part->links.sees_backs;
  whole->message = part->links.message;
}

void hr2d_linkset_destroy(hr2d_linkset *links) {
  if (!links) return;
  if (links->oracle.destroy) links->oracle.destroy(links->oracle_ctx);
  if (links->policy.destroy) links->policy.destroy(links->policy_ctx);
  const hr2d_allocator alloc = links->alloc;
  hr2di_store_clear(&links->store, &alloc);
  hr2di_linkset_clear_blocks(links);
  hr2di_alloc_free(&alloc, links->more);
  hr2di_roots_clear(&links->roots, &alloc);
  hr2di_alloc_free(&alloc, links->sees_backs);
  hr2di_alloc_free(&alloc, links);
}

const hr2d_hierarchy *hr2d_linkset_hierarchy(const hr2d_linkset *links) {
  if (!links) return NULL;
  return links->hierarchy;
}

const hr2d_oracle *hr2d_linkset_oracle(const hr2d_linkset *links) {
  if (!links) return NULL;
  return &links->oracle;
}

const hr2d_policy *hr2d_linkset_policy(const hr2d_linkset *links) {
  if (!links) return NULL;
  return &links->policy;
}

const char *hr2d_linkset_message(const hr2d_linkset *links) {
  if (!links) return "";
  return links->message.text;
}

uint64_t hr2d_linkset_size(const hr2d_linkset *links) {
  if (!links) return 0;
  return links->store.count;
}

hr2d_link hr2d_linkset_get(const hr2d_linkset *links, uint64_t index) {
  if (!links || index >= links->store.count)
    return (hr2d_link){{HR2D_NO_ELEMENT, HR2D_NO_ELEMENT}, NAN};
  hr2d_link link = hr2di_store_link(&links->store, index);
  link.exchange_area *= hr2d_scene_unit(links->hierarchy->scene);
  return link;
}

size_t hr2d_linkset_read(const hr2d_linkset *links, uint64_t first, size_t count,
                         hr2d_link *link) {
  if (!links || !link) return 0;
  const double unit = hr2d_scene_unit(links->hierarchy->scene);
  const hr2di_store *store = &links->store;
  hr2d_link room[HR2DI_READ_LINKS];
  const uint64_t rest = first < store->count ? store->count - first : 0;
  if (count > rest) count = (size_t)rest;
  for (size_t at = 0, some; at < count; at += some) {
    some = count - at;
    const hr2d_link *from = hr2di_store_read(store, first + at, &some, room);
    for (size_t k = 0; k < some; k++)
      link[at + k] = (hr2d_link){from[k].pair, from[k].exchange_area * unit};
  }
  return count;
}

int hr2d_linkset_directed(const hr2d_linkset *links) {
  if (!links) return 0;
  return links->directed;
}

double hr2d_linkset_epsilon(const hr2d_linkset *links) {
  if (!links) return NAN;
  return links->epsilon;
}

hr2d_refine_counts hr2d_linkset_counts(const hr2d_linkset *links) {
  if (!links) return (hr2d_refine_counts){0};
  return links->counts;
}

uint64_t hr2d_linkset_own_tests(const hr2d_linkset *links) {
  if (!links) return 0;
  return links->own_tests;
}

uint64_t hr2d_linkset_bytes(const hr2d_linkset *links) {
  if (!links) return 0;
  const hr2di_roots *r = &links->roots;
  uint64_t blocks = hr2di_link_blocks_bytes(&links->blocks);
  for (size_t g = 1; g < links->groups; g++)
    blocks += hr2di_link_blocks_bytes(&links->more[g - 1]);
  return hr2di_store_bytes(&links->store) +
         (r->clusters ? hr2di_clusters_bytes(r->clusters) : 0) + r->capacity * sizeof *r->pair +
         blocks;
}
