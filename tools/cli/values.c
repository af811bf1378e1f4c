/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One reader for each kind of value. */
#include "cli/values.h"

#include <stdio.h>
#include <string.h>

#include "cli/names.h"
#include "cli/numbers.h"
#include "output/complain.h"
#include "output/output.h"
#include "output/suffix.h"

int value_flag(const char *option, char *text, value_range range, void *value) {
  (void)option, (void)text, (void)range;
  *(int *)value = 1;
  return 0;
}

int value_positive(const char *option, char *text, value_range range, void *value) {
  double *x = value;
  (void)range;
  if (number_real(text, x) || *x <= 0)
    return complain_usage("--%s: '%s' is not a number greater than 0", option, text);
  return 0;
}

int value_count(const char *option, char *text, value_range range, void *value) {
  uint64_t *n = value;
  if (number_count(text, range.max, n) || *n < range.min)
    return complain_usage("--%s: '%s' is not a whole number from %llu to %llu", option, text,
                          (unsigned long long)range.min, (unsigned long long)range.max);
  return 0;
}

int value_unsigned(const char *option, char *text, value_range range, void *value) {
  uint64_t n = 0;
  if (value_count(option, text, range, &n)) return EXIT_USAGE;
  *(unsigned *)value = (unsigned)n;
  return 0;
}

int value_path(const char *option, char *text, value_range range, void *value) {
  (void)range;
  *(const char **)value = text;
  return *text ? 0 : complain_usage("--%s: the file name is empty", option);
}

int value_file(const char *option, char *text, value_range range, void *value) {
  if (output_is_stdout(text))
    return complain_usage("--%s wants a file that can be read back", option);
  return value_path(option, text, range, value);
}

int value_picture(const char *option, char *text, value_range range, void *value) {
  (void)range;
  *(const char **)value = text;
  if (suffix_of(text) == SUFFIX_OTHER)
    return complain_usage("--%s: '%s' does not end in .svg, .png or .pdf", option, text);
  return 0;
}

int value_film(const char *option, char *text, value_range range, void *value) {
  (void)range;
  *(const char **)value = text;
  if (suffix_of(text) != SUFFIX_PNG)
    return complain_usage("--%s: '%s' does not end in .png", option, text);
  return 0;
}

int value_part(const char *option, char *text, value_range range, void *value) {
  double *x = value;
  (void)range;
  if (number_real(text, x) || *x <= 0 || *x > 1)
    return complain_usage("--%s: '%s' is not a number greater than 0 and at most 1", option,
                          text);
  return 0;
}

int value_patches(const char *option, char *text, value_range range, void *value) {
  place_list *list = value;
  (void)range;
  list->items[list->count++] = (place){text, 0};
  return *text ? 0 : complain_usage("--%s: the name is empty", option);
}

int value_grid(const char *option, char *text, value_range range, void *value) {
  grid_size *size = value;
  char *rows = strchr(text, 'x');
  uint64_t w = 0, h = 0;
  if (rows) *rows++ = '\0';
  if (!rows || number_count(text, range.max, &w) || number_count(rows, range.max, &h) || !w ||
      !h)
    return complain_usage("--%s: not WxH with whole numbers from 1 to %llu", option,
                          (unsigned long long)range.max);
  *size = (grid_size){(unsigned)w, (unsigned)h};
  return 0;
}

/* So many numbers with commas in between; returns whether there are. */
static int read_list(char *text, int count, double *to) {
  for (int k = 0; k < count; k++) {
    char *end = text ? strchr(text, ',') : NULL;
    if (end) *end++ = '\0';
    if (!text || (k + 1 < count) != (end != NULL) || number_real(text, &to[k])) return 0;
    text = end;
  }
  return 1;
}

int value_box(const char *option, char *text, value_range range, void *value) {
  grid_box *to = value;
  (void)range;
  if (!read_list(text, 4, to->side))
    return complain_usage("--%s: not four numbers X0,Y0,X1,Y1", option);
  to->given = 1;
  return 0;
}

int value_vector(const char *option, char *text, value_range range, void *value) {
  double at[2];
  (void)range;
  if (!read_list(text, 2, at) || (at[0] == 0 && at[1] == 0))
    return complain_usage("--%s: not two numbers X,Y that are not both 0", option);
  *(vector *)value = (vector){at[0], at[1]};
  return 0;
}

/* The last colon separates, because names may contain others. */
int value_place(const char *option, char *text, value_range range, void *value) {
  place *p = value;
  char *colon = strrchr(text, ':');
  (void)range;
  if (!colon || colon == text) return complain_usage("--%s: '%s' is not PATCH:T", option, text);
  if (number_real(colon + 1, &p->t) || p->t < 0 || p->t > 1)
    return complain_usage("--%s: '%s' does not end in a number from 0 to 1", option, text);
  *colon = '\0';
  p->patch = text;
  return 0;
}

int value_places(const char *option, char *text, value_range range, void *value) {
  place_list *list = value;
  return value_place(option, text, range, &list->items[list->count++]);
}

int value_sequence(const char *option, char *text, value_range range, void *value) {
  sequence *s = value;
  char *colon = strchr(text, ':');
  if (!colon) return complain_usage("--%s: '%s' is not FROM:RATIO", option, text);
  *colon = '\0';
  if (value_positive(option, text, range, &s->from)) return EXIT_USAGE;
  if (number_real(colon + 1, &s->ratio) || s->ratio < 0.01 || s->ratio > 0.99)
    return complain_usage("--%s: the ratio '%s' is not a number from 0.01 to 0.99", option,
                          colon + 1);
  return 0;
}

/* Appends a name to a list of them. */
static void add_name(char *list, size_t size, const char *name) {
  const size_t used = strlen(list);
  snprintf(list + used, size - used, "%s%s", used ? ", " : "", name);
}

int value_oracle(const char *option, char *text, value_range range, void *value) {
  static const char *const known[] = {"size", "size2", "bf", "l1", "l1-grid", "bounds"};
  const hr2d_oracle **oracle = value;
  char list[64] = "";
  (void)range;
  *oracle = hr2d_oracle_find(text);
  if (*oracle) return 0;
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    if (hr2d_oracle_find(known[k])) add_name(list, sizeof list, known[k]);
  return complain_usage("--%s: '%s' is none of %s", option, text, list);
}

int value_policy(const char *option, char *text, value_range range, void *value) {
  const hr2d_policy **policy = value;
  (void)range;
  *policy = hr2d_policy_find(text);
  return *policy ? 0
                 : complain_usage("--%s: '%s' is neither original nor modified", option, text);
}

int value_norm(const char *option, char *text, value_range range, void *value) {
  const int average = !strcmp(text, "average");
  (void)range;
  if (!average && strcmp(text, "sup"))
    return complain_usage("--%s: '%s' is neither average nor sup", option, text);
  *(hr2d_norm *)value = average ? HR2D_NORM_AVERAGE : HR2D_NORM_SUP;
  return 0;
}

int value_effect(const char *option, char *text, value_range range, void *value) {
  char list[512] = "";
  (void)range;
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) {
    const char *name = hr2d_effect_name((hr2d_effect)e);
    if (!strcmp(text, name)) {
      *(unsigned *)value |= 1U << e;
      return 0;
    }
    add_name(list, sizeof list, name);
  }
  return complain_usage("--%s: '%s' is none of %s", option, text, list);
}

/* Which name the first `size` bytes of a word are; `count` if none. */
static size_t find_name(const char *const *names, size_t count, const char *word, size_t size) {
  size_t k = 0;
  while (k < count && (strlen(names[k]) != size || strncmp(word, names[k], size))) k++;
  return k;
}

int value_methods(const char *option, char *text, value_range range, void *value) {
  unsigned *methods = value;
  (void)range;
  *methods = 0;
  for (const char *word = text;; word++) {
    const size_t size = strcspn(word, ",");
    const size_t m = find_name(name_of_method, METHOD_COUNT, word, size);
    if (m == METHOD_COUNT) {
      char list[160] = "";
      for (size_t k = 0; k < METHOD_COUNT; k++) add_name(list, sizeof list, name_of_method[k]);
      return complain_usage("--%s: '%.*s' is none of %s", option, (int)size, word, list);
    }
    *methods |= 1U << m;
    word += size;
    if (!*word) return 0;
  }
}

int value_light(const char *option, char *text, value_range range, void *value) {
  static const char *const known[] = {"mean", "flux", "sky", "temperature"};
  const size_t k = find_name(known, QUANTITY_COUNT, text, strlen(text));
  (void)range;
  *(light *)value = (light)k;
  return k < QUANTITY_COUNT ? 0
                            : complain_usage("--%s: '%s' is none of mean, flux, sky, "
                                             "temperature",
                                             option, text);
}

int value_band(const char *option, char *text, value_range range, void *value) {
  const int all = !strcmp(text, "all"), rgb = !strcmp(text, "rgb");
  uint64_t k = 0;
  (void)range;
  if (!all && !rgb && (number_count(text, INT_MAX, &k)))
    return complain_usage("--%s: '%s' is neither a number nor all nor rgb", option, text);
  *(int *)value = all ? BAND_ALL : rgb ? BAND_RGB : (int)k;
  return 0;
}

/* Each quantity once. */
int value_against(const char *option, char *text, value_range range, void *value) {
  against_list *list = value;
  unsigned seen = 0;
  (void)range;
  list->count = 0;
  for (const char *word = text;; word++) {
    const size_t size = strcspn(word, ",");
    const size_t k = find_name(name_of_against, AGAINST_COUNT, word, size);
    if (k == AGAINST_COUNT || seen >> k & 1)
      return complain_usage("--%s: '%s' does not list some of seconds, links, bytes", option,
                            text);
    seen |= 1U << k;
    list->items[list->count++] = (against)k;
    word += size;
    if (!*word) return 0;
  }
}
