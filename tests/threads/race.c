/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A race that ThreadSanitizer must find; with -DRACE=0, the negative control, there is none.
   The threads sleep, so that each gets a part of the small loop. */
#include <stdio.h>
#include <time.h>

#ifndef RACE
#define RACE 1
#endif

int main(void) {
  long raced = 0, summed = 0;
#pragma omp parallel for num_threads(4) schedule(dynamic) reduction(+ : summed)
  for (long k = 0; k < 16; k++) {
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    summed += k;
    if (RACE) raced += k;
  }
  printf("%ld %ld\n", summed, raced);
  return summed != 120;
}
