/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of names in options. */
#ifndef HR2D_TESTS_ADVERSARY_LISTED_H
#define HR2D_TESTS_ADVERSARY_LISTED_H

#include <string.h>

/* Whether a name is in a list that is separated by commas; NULL lists all. */
static inline int adv_listed(const char *list, const char *name) {
  size_t length = strlen(name);
  for (const char *at = list; at; at = strchr(at, ',')) {
    at += *at == ',';
    if (!strncmp(at, name, length) && (!at[length] || at[length] == ',')) return 1;
  }
  return !list;
}

#endif
