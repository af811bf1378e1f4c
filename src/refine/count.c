/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counting N and L without links, on several threads.

   Each worker grows a copy of the hierarchy of its own.  The first worker refines until
   there is work for all: refused pairs on its stacks, and patches not yet projected.  The
   links and elements that a pair leads to do not depend on which worker refines it or when,
   so the sums and the union of the trees are the same as with one thread. */
#include <hr2d/refine.h>
#include <stdatomic.h>
#include <string.h>

#include "base/alloc.h"
#include "base/team.h"
#include "hierarchy/image-trees.h"
#include "hierarchy/pane-trees.h"
#include "refine/occluded-pairs.h"
#include "refine/projector.h"
#include "refine/rounds.h"
#include "refine/worker.h"
#include "scene/scene-impl.h"

enum {
  ENOUGH = 2048, /* refused pairs to share out */
  SHARE = 8,     /* pairs to a task */
  STACKS = 4
};

typedef struct team {
  hr2d_linkset *links;
  hr2di_refine_how how;
  hr2d_refine_options options;
  size_t count;
  hr2di_worker *worker;
  hr2d_hierarchy **clone; /* of each worker */

  hr2di_stack stack[STACKS]; /* the pairs to share out */
  hr2di_occluded_pairs occluded;
  size_t next_patch; /* the first not yet projected */

  hr2di_watch *watch;        /* of the calling thread */
  atomic_ullong links_found; /* L of all workers but the first */
  atomic_ullong tasks_done;
} team;

static size_t shares(size_t pairs) {
  return (pairs + SHARE - 1) / SHARE;
}

static unsigned long long task_count(const team *t) {
  unsigned long long tasks = t->options.row_to - t->next_patch;
  for (int k = 0; k < STACKS; k++) tasks += shares(t->stack[k].count);
  return tasks + shares(t->occluded.stack.count);
}

/* Stack k of a projector; p->occluded is not among them. */
static hr2di_stack *stack_of(hr2di_projector *p, int k) {
  hr2di_stack *const stack[STACKS] = {&p->facing, &p->clipped, &p->unoccluded[0],
                                      &p->unoccluded[1]};
  return stack[k];
}

/* What the team has done, for the watch; with one worker hr2di_rounds_describe() knows more. */
static void describe(void *of, hr2d_progress *report) {
  const team *t = of;
  const hr2di_projector *p = t->worker[0].projector;
  const unsigned long long tasks = task_count(t), done = atomic_load(&t->tasks_done);
  report->elements = p->hierarchy->elements;
  report->links = atomic_load(&t->links_found) + p->counts.links;
  report->fraction = tasks && done < tasks ? (double)done / (double)tasks : tasks > 0;
}

/* The budget of bytes has an equal part for each worker and one for the union of their trees;
   0 if there is no budget. */
static uint64_t part_of_budget(const team *t) {
  const uint64_t budget = t->options.max_bytes, part = budget / (t->count + 1);
  return budget && !part ? 1 : part;
}

/* Worker k begins with a copy of `from` as it is now. */
static hr2d_status hire(team *t, size_t k, const hr2d_hierarchy *from) {
  hr2di_worker *w = &t->worker[k];
  hr2d_refine_options options = t->options;
  options.max_bytes = part_of_budget(t);
  const hr2d_status status =
      hr2di_worker_hire(w, k, t->links, from, &t->how, &options, t->watch, "count");
  t->clone[k] = w->clone;
  if (status == HR2D_EMAX_BYTES)
    return hr2di_projector_fail_budget(&w->links, t->options.max_bytes, 0);
  if (status) return status;
  w->projector->budget = t->options.max_bytes;
  if (k > 0) return HR2D_OK;
  if (t->count > 1)
    hr2di_watch_describe(t->watch, describe, t);
  else
    hr2di_watch_describe(t->watch, hr2di_rounds_describe, w->projector);
  return HR2D_OK;
}

/* Lets the first worker refine alone: until there are enough pairs for all, or to the end if
   there is no other worker. */
static hr2d_status begin(team *t) {
  hr2di_projector *p = t->worker[0].projector;
  hr2d_status status = HR2D_OK;
  t->next_patch = t->options.row_from;
  while (t->next_patch < t->options.row_to && !status && hr2di_rounds_waiting(p) < ENOUGH) {
    status = hr2di_projector_row(p, t->next_patch++);
    if (!status) status = hr2di_rounds_run(p, t->count > 1 ? ENOUGH : SIZE_MAX);
  }
  return status;
}

static hr2d_status take_share(hr2di_projector *p, hr2di_stack *to, const hr2di_stack *from,
                              size_t share) {
  hr2d_status status = HR2D_OK;
  for (size_t k = share * SHARE; k < from->count && k < (share + 1) * SHARE && !status; k++)
    status = hr2di_projector_push(p, to, from->pair[k]);
  return status;
}

static hr2d_status take_occluded(hr2di_projector *p, const hr2di_occluded_pairs *from,
                                 size_t share) {
  hr2d_status status = HR2D_OK;
  for (size_t k = share * SHARE; k < from->stack.count && k < (share + 1) * SHARE && !status;
       k++)
    status = hr2di_occluded_share(p, from, k);
  return status;
}

/* Gives a worker the pairs of a task: a share of a stack, or a patch not yet projected. */
static hr2d_status take(team *t, hr2di_projector *p, size_t task) {
  for (int k = 0; k < STACKS; k++) {
    const size_t some = shares(t->stack[k].count);
    if (task < some) return take_share(p, stack_of(p, k), &t->stack[k], task);
    task -= some;
  }
  const size_t occluded = shares(t->occluded.stack.count);
  if (task < occluded) return take_occluded(p, &t->occluded, task);
  return hr2di_projector_row(p, t->next_patch + (task - occluded));
}

static void do_task(void *ctx, size_t number, size_t task) {
  team *t = ctx;
  hr2di_worker *w = &t->worker[number];
  hr2di_projector *p = w->projector;
  const uint64_t before = p->counts.links;
  if (w->status) return;
  w->status = hr2di_projector_fail(p, hr2di_watch_status(p->watch), "");
  if (!w->status) w->status = take(t, p, task);
  if (!w->status) w->status = hr2di_rounds_run(p, SIZE_MAX);
  if (number > 0) atomic_fetch_add(&t->links_found, p->counts.links - before);
  atomic_fetch_add(&t->tasks_done, 1);
  if (w->status) hr2di_watch_stop(t->watch, HR2D_STOPPED);
}

/* The calling thread asks before, because it may get no task. */
static void work(team *t) {
  hr2di_worker *first = &t->worker[0];
  first->status = hr2di_projector_fail(first->projector, hr2di_watch_ask(t->watch), "");
  if (first->status) return;
  hr2di_team_run(t->count, (size_t)task_count(t), do_task, t, t->watch);
}

static uint64_t shared_bytes(const team *t) {
  uint64_t pairs = t->occluded.stack.capacity;
  for (int k = 0; k < STACKS; k++) pairs += t->stack[k].capacity;
  return pairs * sizeof(hr2d_pair) + t->occluded.first_capacity * sizeof *t->occluded.first +
         hr2di_line_class_list_bytes(&t->occluded.list);
}

/* Shares the pairs on the first worker's stacks among all.  The first worker's budget keeps
   paying for their memory. */
static void share_out(team *t) {
  hr2di_projector *p = t->worker[0].projector;
  for (int k = 0; k < STACKS; k++) {
    t->stack[k] = *stack_of(p, k);
    *stack_of(p, k) = (hr2di_stack){0};
  }
  t->occluded = p->occluded;
  p->occluded = (hr2di_occluded_pairs){.list.alloc = t->occluded.list.alloc};
  p->bytes += shared_bytes(t);
  hr2d_status status = HR2D_OK;
  for (size_t k = 1; k < t->count && !status; k++) status = hire(t, k, t->clone[0]);
  if (!status) work(t);
}

/* The number of elements that the budget leaves for the union of the trees. */
static size_t union_room(const team *t, size_t hired) {
  if (!t->options.max_bytes) return SIZE_MAX;
  const uint64_t rest = t->options.max_bytes - hired * part_of_budget(t);
  return (size_t)(rest / HR2DI_ELEMENT_BYTES);
}

/* The trees of all workers, and of images, become those of the hierarchy. */
static hr2d_status unite(team *t, size_t hired, uint64_t links) {
  hr2d_hierarchy *h = t->links->hierarchy;
  hr2di_message *message = &t->links->message;
  const size_t elements = h->elements, room = union_room(t, hired);
  const uint64_t max = t->options.max_elements;
  hr2d_status status = hr2di_hierarchy_unite(h, t->clone, hired, room, t->watch);
  if (!status) status = hr2di_image_trees_unite(h, room, t->watch);
  if (!status) status = hr2di_pane_trees_unite(h, room, t->watch);
  if (!status && (!max || h->elements <= max)) return HR2D_OK;
  hr2di_hierarchy_truncate(h, elements);
  if (status == HR2D_EMAX_BYTES)
    return hr2di_projector_fail_budget(t->links, t->options.max_bytes, links);
  if (hr2di_watch_refused(t->watch))
    return hr2di_message_fail(message, status, "callback \"progress\": %s",
                              hr2d_strerror(status));
  if (status) return hr2di_message_fail(message, status, "no room for the elements");
  return hr2di_message_fail(message, HR2D_EMAX_ELEMENTS,
                            "more than %llu elements are needed, for %llu links",
                            (unsigned long long)max, (unsigned long long)links);
}

/* A worker is not hired if the first one finished before. */
static hr2d_refine_counts sum_counts(const team *t) {
  hr2d_refine_counts sum = {0};
  for (size_t k = 0; k < t->count; k++) {
    const hr2di_worker *w = &t->worker[k];
    if (!w->projector) continue;
    hr2di_worker_add_counts(w, &sum);
    sum.links += w->projector->counts.links;
  }
  return sum;
}

static hr2d_status sum_up(team *t, hr2d_refine_counts *counts) {
  hr2d_linkset *links = t->links;
  const hr2d_refine_counts sum = sum_counts(t);
  if (t->options.max_links && sum.links > t->options.max_links)
    return hr2di_message_fail(&links->message, HR2D_EMAX_LINKS,
                              "more than %llu links are needed",
                              (unsigned long long)t->options.max_links);
  const size_t hired = t->count > 1 && t->clone[1] ? t->count : 1;
  const hr2d_status status = unite(t, hired, sum.links);
  if (status) return status;
  *counts = sum;
  if (t->options.row_counts)
    memset(t->options.row_counts, 0,
           hr2di_projector_rows(t->worker[0].projector) * sizeof(hr2d_row_counts));
  for (size_t k = 0; k < hired; k++)
    hr2di_projector_add_rows(t->worker[k].projector, t->options.row_counts);
  hr2di_projector_count_elements(links->hierarchy, counts);
  return HR2D_OK;
}

static int finished(const team *t) {
  const hr2di_projector *p = t->worker[0].projector;
  return hr2di_rounds_waiting(p) == 0 && t->next_patch == t->options.row_to;
}

static hr2d_status count_as_team(team *t, hr2d_refine_counts *counts) {
  hr2di_worker *first = &t->worker[0];
  t->links->hierarchy->refining = 1;
  hire(t, 0, t->links->hierarchy);
  if (!first->status) first->status = begin(t);
  if (!first->status && t->count > 1 && !finished(t)) share_out(t);
  if (!first->status) hr2di_rounds_measure(first->projector);
  if (t->count > 1) hr2di_watch_describe(t->watch, NULL, NULL);
  if (t->count > 1) t->watch->report.fraction = 1;
  if (!first->status)
    first->status = hr2di_projector_fail(first->projector, hr2di_watch_ask(t->watch), "");
  t->links->hierarchy->refining = 0;
  const hr2d_status status = hr2di_worker_status(t->worker, t->count, t->links);
  return status ? status : sum_up(t, counts);
}

hr2d_status hr2di_refine_count(hr2d_linkset *links, const hr2di_refine_how *how,
                               const hr2d_refine_options *options, hr2d_refine_counts *counts) {
  hr2di_watch watch;
  team t = {.links = links, .how = *how, .watch = &watch};
  if (links->store.count > 0)
    return hr2di_message_fail(&links->message, HR2D_ESTATE, "the set has links already");
  hr2d_status status = hr2di_projector_check_options(links, options, &t.options);
  if (status) return status;
  hr2di_scene_watch(links->hierarchy->scene, &watch, t.options.progress, t.options.progress_ctx,
                    "refine");
  t.count = hr2di_worker_count(links, t.options.threads);
  if (t.options.max_bytes &&
      t.count * (sizeof *t.worker + sizeof *t.clone) > t.options.max_bytes)
    return hr2di_projector_fail_budget(links, t.options.max_bytes, 0);
  t.worker = hr2di_alloc_zero(&links->alloc, t.count, sizeof *t.worker);
  t.clone = hr2di_alloc_zero(&links->alloc, t.count, sizeof *t.clone);
  if (t.worker && t.clone)
    status = count_as_team(&t, counts);
  else
    status = hr2di_message_fail(&links->message, HR2D_ENOMEM, "out of memory for the count");
  for (int k = 0; k < STACKS; k++) hr2di_alloc_free(&links->alloc, t.stack[k].pair);
  hr2di_alloc_free(&links->alloc, t.occluded.stack.pair);
  hr2di_alloc_free(&links->alloc, t.occluded.first);
  hr2di_line_class_list_clear(&t.occluded.list);
  hr2di_worker_destroy(t.worker, t.count, &links->alloc);
  hr2di_alloc_free(&links->alloc, t.clone);
  return status;
}

hr2d_status hr2d_refine_count(hr2d_linkset *links, const hr2d_refine_options *options,
                              hr2d_refine_counts *counts) {
  if (!links || !counts) return HR2D_EINVAL;
  return hr2di_refine_count(links, &(hr2di_refine_how){0}, options, counts);
}
