/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Distances are those of Damerau and Levenshtein between adjacent letters: how many insertions,
   deletions, substitutions and exchanges of neighbours make one word of the other. */
#include "cli/suggest.h"

#include <string.h>

enum { LONGEST = 31 };

static size_t smaller(size_t a, size_t b) {
  return a < b ? a : b;
}

/* d[i][j] is the distance of the first i letters of a from the first j of b. */
static size_t distance(const char *a, size_t m, const char *b, size_t n) {
  size_t d[LONGEST + 1][LONGEST + 1];
  for (size_t i = 0; i <= m; i++) {
    for (size_t j = 0; j <= n; j++) {
      if (!i || !j) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = smaller(smaller(d[i - 1][j], d[i][j - 1]) + 1,
                        d[i - 1][j - 1] + (a[i - 1] != b[j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = smaller(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[m][n];
}

suggestion suggest_for(const char *typed, size_t length) {
  return (suggestion){typed, length, NULL, 0};
}

void suggest_offer(suggestion *s, const char *word) {
  const size_t length = strlen(word);
  if (s->length > LONGEST || length > LONGEST || !s->length) return;
  const size_t common = smaller(length, s->length);
  const int begins = !strncmp(word, s->typed, common) && (length >= s->length || length >= 3);
  const size_t off = begins ? 0 : distance(s->typed, s->length, word, length);
  if (off > 1 && off > length / 3) return;
  if (s->best && off >= s->distance) return;
  s->best = word;
  s->distance = off;
}
