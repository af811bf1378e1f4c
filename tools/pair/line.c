/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A line of `hr2d pair`: eight numbers. */
#include "pair/line.h"

#include <math.h>
#include <string.h>

#include "cli/numbers.h"

static const char blanks[] = " \t\r\n\v\f";

int pair_is_empty(const char *line) {
  line += strspn(line, blanks);
  return *line == '\0' || *line == '#';
}

int pair_read(char *line, pair_line *numbers) {
  char *rest = NULL;
  numbers->found = 0;
  numbers->word = NULL;
  for (char *word = strtok_r(line, blanks, &rest); word; word = strtok_r(NULL, blanks, &rest)) {
    double value = 0;
    if (number_real(word, &value)) {
      numbers->word = word;
      return -1;
    }
    if (numbers->found < 8) numbers->x[numbers->found] = value;
    numbers->found++;
  }
  return numbers->found == 8 ? 0 : -1;
}

int pair_grow(double x[8]) {
  double largest = 0;
  int exponent = 0;
  for (int k = 0; k < 8; k++) largest = fmax(largest, fabs(x[k]));
  frexp(largest, &exponent);
  if (exponent > -500) return 0;
  for (int k = 0; k < 8; k++) x[k] = ldexp(x[k], -exponent);
  return exponent;
}
