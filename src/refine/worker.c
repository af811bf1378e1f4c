/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "refine/worker.h"

#include "base/alloc.h"
#include "base/team.h"
#include "refine/part-rows.h"

enum { MOST_WORKERS = 256 };

size_t hr2di_worker_count(const hr2d_linkset *links, unsigned threads) {
  const size_t count = hr2di_team_threads(threads);
  if (!(links->oracle.flags & HR2D_ORACLE_THREAD_SAFE) ||
      !(links->policy.flags & HR2D_POLICY_THREAD_SAFE))
    return 1;
  return count < MOST_WORKERS ? count : MOST_WORKERS;
}

hr2d_status hr2di_worker_hire(hr2di_worker *w, size_t k, const hr2d_linkset *links,
                              const hr2d_hierarchy *from, const hr2di_refine_how *how,
                              const hr2d_refine_options *options, hr2di_watch *watch,
                              const char *what) {
  w->links = *links;
  w->links.store = (hr2di_store){0};
  w->links.message.text[0] = '\0';
  if (options->max_bytes && hr2di_hierarchy_clone_bytes(from) > options->max_bytes)
    return w->status = HR2D_EMAX_BYTES;
  w->status = hr2di_hierarchy_clone(from, &w->clone);
  if (w->status)
    return hr2di_message_fail(&w->links.message, w->status, "out of memory for the %s", what);
  w->links.hierarchy = w->clone;
  w->clone->refining = 1;
  hr2di_watch_follow(&w->own, watch);
  w->status =
      hr2di_projector_create(&w->links, how, options, k == 0 ? watch : &w->own, &w->projector);
  return w->status;
}

hr2d_status hr2di_worker_status(const hr2di_worker *worker, size_t count, hr2d_linkset *links) {
  const hr2di_worker *reason = NULL;
  for (size_t k = 0; k < count; k++)
    if (worker[k].status && (!reason || !reason->links.message.text[0])) reason = &worker[k];
  if (!reason) return HR2D_OK;
  return hr2di_message_fail(&links->message, reason->status, "%s", reason->links.message.text);
}

void hr2di_worker_add_counts(const hr2di_worker *worker, hr2d_refine_counts *sum) {
  const hr2d_refine_counts *part = &worker->projector->counts;
  sum->limited_links += part->limited_links;
  sum->oracle_calls += part->oracle_calls;
  sum->facing_tests += part->facing_tests;
  sum->exchange_areas += part->exchange_areas;
  sum->partial_links += part->partial_links;
  sum->blocked_pairs += part->blocked_pairs;
  sum->dark_pairs += part->dark_pairs;
  sum->visibility_tests += hr2di_part_rows_tests(worker->projector);
}

void hr2di_worker_destroy(hr2di_worker *worker, size_t count, const hr2d_allocator *alloc) {
  for (size_t k = 0; k < count && worker; k++) {
    if (worker[k].projector) hr2di_projector_destroy(worker[k].projector);
    hr2d_hierarchy_destroy(worker[k].clone);
  }
  hr2di_alloc_free(alloc, worker);
}
