/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The word that was probably meant. */
#ifndef HR2D_TOOLS_CLI_SUGGEST_H
#define HR2D_TOOLS_CLI_SUGGEST_H

#include <stddef.h>

/* The best of the words that were offered so far. */
typedef struct suggestion {
  const char *typed;
  size_t length;    /* of what was typed */
  const char *best; /* NULL: none is near */
  size_t distance;  /* of the best */
} suggestion;

suggestion suggest_for(const char *typed, size_t length);

/* Takes `word` if it is nearer than those before it: one of it and of what was typed begins
   like the other, or they are a mistake apart, or mistakes in a third of its letters. */
void suggest_offer(suggestion *s, const char *word);

#endif
