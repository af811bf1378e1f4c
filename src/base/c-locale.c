/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include "base/c-locale.h"

#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
int hr2di_c_locale_create(hr2di_c_locale *locale) {
  *locale = 0;
  return 0;
}

void hr2di_c_locale_destroy(hr2di_c_locale locale) {
  (void)locale;
}

/* Windows has no locale of POSIX; the decimal sign of each of its locales is one byte. */
double hr2di_c_locale_strtod(hr2di_c_locale locale, char *text, char **end) {
  char *point = strchr(text, '.');
  (void)locale;
  if (point) *point = *localeconv()->decimal_point;
  const double value = strtod(text, end);
  if (point) *point = '.';
  return value;
}
#else
int hr2di_c_locale_create(hr2di_c_locale *locale) {
  *locale = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
  return *locale ? 0 : -1;
}

void hr2di_c_locale_destroy(hr2di_c_locale locale) {
  freelocale(locale);
}

double hr2di_c_locale_strtod(hr2di_c_locale locale, char *text, char **end) {
  const locale_t former = uselocale(locale);
  const double value = strtod(text, end);
  uselocale(former);
  return value;
}
#endif
