/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls of the API fuzzer: refine, count and visit.  The three must agree, and each must
   leave its objects in a valid state. */
#include <math.h>
#include <string.h>

#include "api.h"

hr2d_hierarchy *api_hierarchy(api_run *r, const api_slot *s) {
  return r->hierarchy[(s - r->slot) / 2];
}

void api_memory_runs_out(api_run *r) {
  const unsigned b = fuzz_byte(r->in);
  r->failures = r->memory.failures;
  if (b % 4) return;
  r->memory.until_failure = b & 64 ? (long)fuzz_byte(r->in) : b >> 3;
  r->memory.for_good = b >> 7;
}

int api_memory_is_back(api_run *r) {
  r->memory.until_failure = -1;
  r->memory.for_good = 0;
  return r->memory.failures > r->failures;
}

hr2d_refine_options api_refine_options(api_run *r, const api_slot *s) {
  static const double epsilons[] = {0.5, 1, 0.2, 2, 0.1, HR2D_EPSILON_ZERO, 0x1p-1074, 1e300};
  hr2d_refine_options o = HR2D_REFINE_OPTIONS_INIT;
  const unsigned b = fuzz_byte(r->in);
  o.epsilon = epsilons[b & 7];
  o.max_level = (b >> 3) % 6 + (o.epsilon >= 0.5 ? 3 : 0);
  if (!o.max_level) o.max_level = HR2D_NO_SUBDIVISION;
  o.ordered = s->ordered;
  o.max_elements = 1500;
  o.max_links = 3000;
  if (b & 64) o.max_bytes = 1u << (10 + fuzz_below(r->in, 12));
  if (b & 128) o.max_links = 1 + fuzz_byte(r->in);
  o.brightness = s->solution;
  return o;
}

static int is_budget(hr2d_status status) {
  return status == HR2D_EMAX_LINKS || status == HR2D_EMAX_ELEMENTS || status == HR2D_EMAX_BYTES;
}

/* Asserts that a refinement may return this status.  HR2D_ENOMEM is allowed if memory ran
   out, and the statuses of callbacks if these misbehave on purpose. */
static void check_status(const api_slot *s, hr2d_status status, int out_of_memory) {
  const int evil = s->owners > 0 && s->callbacks.evil;
  REQUIRE_SAYING(
      !status || is_budget(status) || (status == HR2D_ENOMEM && out_of_memory) ||
          (evil && (status == HR2D_ECALLBACK || status == HR2D_STOPPED || status == HR2D_EIO)),
      hr2d_strerror(status));
}

static uint64_t digest(const hr2d_linkset *links) {
  uint64_t hash = 0;
  for (uint64_t k = 0; k < hr2d_linkset_size(links); k++) {
    const hr2d_link link = hr2d_linkset_get(links, k);
    hash = fuzz_hash(hash ^ fuzz_hash_bytes((const uint8_t *)&link, sizeof link));
  }
  return hash;
}

void api_refine(api_run *r, api_slot *s) {
  const hr2d_refine_options options = api_refine_options(r, s);
  const hr2d_hierarchy_counts before = hr2d_hierarchy_count(api_hierarchy(r, s));
  const uint64_t links = hr2d_linkset_size(s->links), hash = digest(s->links);
  api_memory_runs_out(r);
  const hr2d_status status = hr2d_refine(s->links, &options);
  check_status(s, status, api_memory_is_back(r));
  if (!status) {
    fuzz_check_links(s->links);
    REQUIRE(hr2d_linkset_size(s->links) <= options.max_links);
    REQUIRE(hr2d_hierarchy_count(api_hierarchy(r, s)).elements <= options.max_elements ||
            hr2d_hierarchy_count(api_hierarchy(r, s)).elements == before.elements);
    return;
  }
  const hr2d_hierarchy_counts after = hr2d_hierarchy_count(api_hierarchy(r, s));
  REQUIRE(before.elements == after.elements && before.leaves == after.leaves);
  REQUIRE(hr2d_linkset_size(s->links) == links && digest(s->links) == hash);
  fuzz_check_hierarchy(api_hierarchy(r, s));
  fuzz_check_message(hr2d_linkset_message(s->links));
}

/* A second hierarchy and link set, made in the same way as those of a slot. */
typedef struct twin {
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  fuzz_callbacks callbacks;
  int owners;
} twin;

static twin make_twin(api_run *r, const api_slot *s) {
  twin t = {.callbacks = s->callbacks};
  t.callbacks.destroyed = 0;
  t.owners = s->owners;
  REQUIRE(hr2d_hierarchy_create(r->scene, &t.hierarchy) == HR2D_OK);
  return t;
}

/* In two steps, for the contexts must not move between them. */
static void join_twin(twin *t, const api_slot *s) {
  REQUIRE(hr2d_linkset_create(
              t->hierarchy, s->oracle, s->oracle->destroy ? &t->callbacks : NULL, s->policy,
              s->policy && s->policy->destroy ? &t->callbacks : NULL, &t->links) == HR2D_OK);
}

static void end_twin(twin *t) {
  hr2d_linkset_destroy(t->links);
  REQUIRE(t->callbacks.destroyed == t->owners);
  hr2d_hierarchy_destroy(t->hierarchy);
}

typedef struct visited {
  uint64_t hash, count, stop_at;
} visited;

static hr2d_status visit(void *ctx, const hr2d_link *links, size_t count) {
  visited *v = ctx;
  for (size_t k = 0; k < count; k++) {
    hr2d_link link;
    memcpy(&link, &links[k], sizeof link);
    v->hash = fuzz_hash(v->hash ^ fuzz_hash_bytes((const uint8_t *)&link, sizeof link));
  }
  v->count += count;
  return v->stop_at && v->count >= v->stop_at ? HR2D_STOPPED : HR2D_OK;
}

static void check_same(const hr2d_refine_counts *one, const hr2d_refine_counts *other) {
  REQUIRE(one->elements == other->elements);
  REQUIRE(one->leaves == other->leaves);
  REQUIRE(one->links == other->links);
  REQUIRE(one->limited_links == other->limited_links);
  REQUIRE(one->oracle_calls == other->oracle_calls);
  REQUIRE(one->partial_links == other->partial_links);
  REQUIRE(one->blocked_pairs == other->blocked_pairs);
  REQUIRE(one->dark_pairs == other->dark_pairs);
  REQUIRE(one->levels == other->levels);
}

void api_compare(api_run *r, api_slot *s) {
  hr2d_refine_options options = api_refine_options(r, s);
  twin stored = make_twin(r, s), counted = make_twin(r, s), seen = make_twin(r, s);
  hr2d_refine_counts counts, of_visit;
  visited v = {0, 0, 0};
  options.max_bytes = 0; /* work space and links are in it, which the three differ in */
  options.brightness = NULL;
  join_twin(&stored, s);
  join_twin(&counted, s);
  join_twin(&seen, s);
  const hr2d_status status = hr2d_refine(stored.links, &options);
  check_status(s, status, 0);
  REQUIRE(hr2d_refine_count(counted.links, &options, &counts) == status);
  REQUIRE(hr2d_refine_visit(seen.links, &options, visit, &v, &of_visit) == status);
  if (!status) {
    const hr2d_refine_counts made = hr2d_linkset_counts(stored.links);
    fuzz_check_links(stored.links);
    check_same(&made, &counts);
    check_same(&made, &of_visit);
    REQUIRE(v.count == made.links && made.links == hr2d_linkset_size(stored.links));
    REQUIRE(v.hash == digest(stored.links));
    REQUIRE(made.elements == hr2d_hierarchy_count(stored.hierarchy).elements);
  }
  fuzz_check_hierarchy(counted.hierarchy);
  fuzz_check_hierarchy(seen.hierarchy);
  REQUIRE(hr2d_linkset_size(counted.links) == 0 && hr2d_linkset_size(seen.links) == 0);
  end_twin(&stored);
  end_twin(&counted);
  end_twin(&seen);
}
