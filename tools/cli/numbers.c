/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strtod() and strtoull(), but leading blanks, signs of counts and text behind a number are
   refused. */
#include "cli/numbers.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>

int number_real(const char *text, double *value) {
  if (*text == '\0' || isspace((unsigned char)*text)) return -1;
  char *end = NULL;
  double x = strtod(text, &end);
  if (*end != '\0' || !isfinite(x)) return -1;
  *value = x;
  return 0;
}

int number_count(const char *text, uint64_t limit, uint64_t *value) {
  if (!isdigit((unsigned char)*text)) return -1;
  char *end = NULL;
  errno = 0;
  unsigned long long n = strtoull(text, &end, 10);
  if (*end != '\0' || errno || n > limit) return -1;
  *value = n;
  return 0;
}
