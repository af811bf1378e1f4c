/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bars.h"

#include <stdio.h>
#include <stdlib.h>

static int missed;

void bars_hold(const char *what, double value, double max) {
  if (value <= max) return;
  printf("missed: %s is %.3g, at most %.3g is allowed\n", what, value, max);
  missed++;
}

int bars_status(void) {
  return missed ? EXIT_FAILURE : EXIT_SUCCESS;
}

_Noreturn void bars_fail(const char *what) {
  fprintf(stderr, "bench: %s\n", what);
  exit(EXIT_FAILURE);
}
