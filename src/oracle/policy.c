/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's two ways to subdivide: original and modified. */
#include <hr2d/policy.h>
#include <string.h>

static hr2d_status split_longer(void *ctx, const hr2d_batch *batch, unsigned char *split) {
  (void)ctx;
  const hr2d_element *element = batch->elements;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_pair pair = batch->pairs[k];
    const int second = element[pair.first].length < element[pair.second].length;
    split[k] = (unsigned char)(second ? HR2D_SPLIT_SECOND : HR2D_SPLIT_FIRST);
  }
  return HR2D_OK;
}

static hr2d_status split_both(void *ctx, const hr2d_batch *batch, unsigned char *split) {
  (void)ctx;
  memset(split, HR2D_SPLIT_BOTH, batch->count);
  return HR2D_OK;
}

static const hr2d_policy policy_original = {
    .struct_size = sizeof(hr2d_policy),
    .name = "original",
    .flags = HR2D_POLICY_THREAD_SAFE,
    .preferred_subdivision = split_longer,
};

static const hr2d_policy policy_modified = {
    .struct_size = sizeof(hr2d_policy),
    .name = "modified",
    .flags = HR2D_POLICY_THREAD_SAFE,
    .preferred_subdivision = split_both,
};

const hr2d_policy *hr2d_policy_original(void) {
  return &policy_original;
}

const hr2d_policy *hr2d_policy_modified(void) {
  return &policy_modified;
}

const hr2d_policy *hr2d_policy_find(const char *name) {
  if (!name) return NULL;
  const hr2d_policy *const known[] = {&policy_original, &policy_modified};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    if (strcmp(known[k]->name, name) == 0) return known[k];
  return NULL;
}
