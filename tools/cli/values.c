/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the word of an option to its value. */
#include "cli/values.h"

#include <stdio.h>
#include <string.h>

#include "cli/numbers.h"
#include "cost/cost.h"
#include "output/complain.h"
#include "output/suffix.h"

int read_positive(const char *option, const char *text, double *value) {
  if (read_real(text, value) || *value <= 0)
    return usage_error("--%s: '%s' is not a number greater than 0", option, text);
  return 0;
}

int read_range(const char *option, const char *text, uint64_t least, uint64_t most,
               uint64_t *value) {
  if (read_count(text, most, value) || *value < least)
    return usage_error("--%s: '%s' is not a whole number from %llu to %llu", option, text,
                       (unsigned long long)least, (unsigned long long)most);
  return 0;
}

int read_unsigned(const char *option, const char *text, unsigned least, unsigned most,
                  unsigned *value) {
  uint64_t n = 0;
  if (read_range(option, text, least, most, &n)) return EXIT_USAGE;
  *value = (unsigned)n;
  return 0;
}

/* The last colon separates, because names may contain others. */
int read_place(const char *option, char *text, place *p) {
  char *colon = strrchr(text, ':');
  if (!colon || colon == text) return usage_error("--%s: '%s' is not PATCH:T", option, text);
  if (read_real(colon + 1, &p->t) || p->t < 0 || p->t > 1)
    return usage_error("--%s: '%s' does not end in a number from 0 to 1", option, text);
  *colon = '\0';
  p->patch = text;
  return 0;
}

int read_multigrid(const char *option, char *text, double *from, double *ratio) {
  char *colon = strchr(text, ':');
  if (!colon) return usage_error("--%s: '%s' is not FROM:RATIO", option, text);
  *colon = '\0';
  if (read_positive(option, text, from)) return EXIT_USAGE;
  if (read_real(colon + 1, ratio) || *ratio < 0.01 || *ratio > 0.99)
    return usage_error("--%s: the ratio '%s' is not a number from 0.01 to 0.99", option,
                       colon + 1);
  return 0;
}

int read_oracle(const char *option, const char *text, const hr2d_oracle **oracle) {
  static const char *const known[] = {"size", "size2", "bf", "l1", "l1-grid"};
  char list[64] = "";
  *oracle = hr2d_oracle_find(text);
  if (*oracle) return 0;
  for (size_t k = 0, used = 0; k < sizeof known / sizeof *known; k++)
    if (hr2d_oracle_find(known[k]))
      used +=
          (size_t)snprintf(list + used, sizeof list - used, "%s%s", k ? ", " : "", known[k]);
  return usage_error("--%s: '%s' is none of %s", option, text, list);
}

int read_variant(const char *option, const char *text, const hr2d_policy **policy) {
  *policy = hr2d_policy_find(text);
  return *policy ? 0 : usage_error("--%s: '%s' is neither original nor modified", option, text);
}

int read_norm(const char *option, const char *text, hr2d_norm *norm) {
  const int average = !strcmp(text, "average");
  if (!average && strcmp(text, "sup"))
    return usage_error("--%s: '%s' is neither average nor sup", option, text);
  *norm = average ? HR2D_NORM_AVERAGE : HR2D_NORM_SUP;
  return 0;
}

/* Some of the quantities, each once, separated by commas. */
int read_against(const char *option, const char *text, against *quantity, size_t *count) {
  static const char *const known[AGAINST_COUNT] = {"seconds", "links", "bytes"};
  unsigned seen = 0;
  *count = 0;
  for (const char *word = text;; word++) {
    const size_t size = strcspn(word, ",");
    unsigned k = 0;
    while (k < AGAINST_COUNT && (strlen(known[k]) != size || strncmp(word, known[k], size)))
      k++;
    if (k == AGAINST_COUNT || seen >> k & 1)
      return usage_error("--%s: '%s' does not list some of seconds, links, bytes", option,
                         text);
    seen |= 1U << k;
    quantity[(*count)++] = (against)k;
    word += size;
    if (!*word) return 0;
  }
}

/* Each word of a list that commas separate has to be a method. */
int read_methods(const char *option, const char *text, const char **methods) {
  *methods = text;
  for (const char *word = text;;) {
    const size_t size = strcspn(word, ",");
    if (!cost_method_find(word, size))
      return usage_error("--%s: '%.*s' is none of %s", option, (int)size, word,
                         COST_METHOD_NAMES);
    if (!word[size]) return 0;
    word += size + 1;
  }
}

int read_effect(const char *option, const char *text, unsigned *effects) {
  char list[512] = "";
  for (int e = 0, used = 0; e < HR2D_EFFECT_COUNT; e++) {
    const char *name = hr2d_effect_name((hr2d_effect)e);
    if (!strcmp(text, name)) {
      *effects |= 1U << e;
      return 0;
    }
    used += snprintf(list + used, sizeof list - (size_t)used, "%s%s", e ? ", " : "", name);
  }
  return usage_error("--%s: '%s' is none of %s", option, text, list);
}

int read_picture(const char *option, const char *text, const char **path) {
  *path = text;
  if (suffix_of(text) == SUFFIX_OTHER)
    return usage_error("--%s: '%s' does not end in .svg, .png or .pdf", option, text);
  return 0;
}

int read_path(const char *option, const char *text, const char **path) {
  *path = text;
  return *text ? 0 : usage_error("--%s: the file name is empty", option);
}
