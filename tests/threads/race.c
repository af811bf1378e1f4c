/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A race that ThreadSanitizer must find; with -DRACE=0, the negative control, there is none. */
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

#ifndef RACE
#define RACE 1
#endif

static atomic_long summed;
static long raced;

static void *add(void *arg) {
  (void)arg;
  for (long k = 0; k < 16; k++) {
    atomic_fetch_add(&summed, k);
    if (RACE) raced += k;
  }
  return NULL;
}

int main(void) {
  pthread_t thread[4];
  for (int k = 0; k < 4; k++)
    if (pthread_create(&thread[k], NULL, add, NULL)) return 2;
  for (int k = 0; k < 4; k++) pthread_join(thread[k], NULL);
  printf("%ld %ld\n", atomic_load(&summed), raced);
  return atomic_load(&summed) != 480;
}
