/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L /* pthread_barrier_t */
#endif
#include "support/shares.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct call {
  hr2d_status status;
  hr2d_combine how;
  double *value, *result;
  size_t count;
} call;

typedef struct team {
  unsigned count;
  shares_work work;
  void *ctx;
  pthread_barrier_t barrier;
  call call[SHARES_MOST];
} team;

typedef struct member {
  team *team;
  hr2d_share share;
} member;

static void check(int holds, const char *what) {
  if (holds) return;
  fprintf(stderr, "shares: %s\n", what);
  abort();
}

/* The sum from this member's values on, around the team. */
static double combine_one(const team *t, unsigned number, size_t k) {
  double value = t->call[number].value[k];
  for (unsigned m = 1; m < t->count; m++) {
    const call *other = &t->call[(number + m) % t->count];
    value =
        other->how == HR2D_COMBINE_SUM ? value + other->value[k] : fmax(value, other->value[k]);
  }
  return value;
}

static hr2d_status combine_all(team *t, unsigned number) {
  call *own = &t->call[number];
  for (unsigned m = 0; m < t->count; m++)
    if (t->call[m].status) return t->call[m].status;
  for (unsigned m = 0; m < t->count; m++)
    check(t->call[m].how == own->how && t->call[m].count == own->count, "calls do not match");
  for (size_t k = 0; k < own->count; k++) own->result[k] = combine_one(t, number, k);
  return HR2D_OK;
}

static hr2d_status combine(void *ctx, hr2d_status status, hr2d_combine how, double *value,
                           size_t count) {
  member *m = ctx;
  team *t = m->team;
  call *own = &t->call[m->share.number];
  *own = (call){status, how, value, malloc((count + 1) * sizeof(double)), count};
  check(own->result != NULL, "no memory");
  pthread_barrier_wait(&t->barrier);
  const hr2d_status found = combine_all(t, m->share.number);
  pthread_barrier_wait(&t->barrier);
  if (!found) {
    check(!count || !memcmp(own->result, t->call[0].result, count * sizeof(double)),
          "a sum depends on the order of its terms");
    if (count) memcpy(value, own->result, count * sizeof *value);
  }
  pthread_barrier_wait(&t->barrier);
  free(own->result);
  return found;
}

static void *run(void *ctx) {
  member *m = ctx;
  m->team->work(&m->share, m->team->ctx);
  return NULL;
}

void shares_run(unsigned count, shares_work work, void *ctx) {
  team t = {.count = count, .work = work, .ctx = ctx};
  member m[SHARES_MOST];
  pthread_t thread[SHARES_MOST];
  check(count >= 1 && count <= SHARES_MOST, "too many");
  pthread_barrier_init(&t.barrier, NULL, count);
  for (unsigned k = 0; k < count; k++) {
    m[k] = (member){&t, {sizeof(hr2d_share), k, count, combine, &m[k], HR2D_OK}};
    check(!pthread_create(&thread[k], NULL, run, &m[k]), "no thread");
  }
  for (unsigned k = 0; k < count; k++) pthread_join(thread[k], NULL);
  pthread_barrier_destroy(&t.barrier);
}
