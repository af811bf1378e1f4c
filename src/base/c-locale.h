/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers whose decimal sign is a point, whatever the locale of the program. */
#ifndef HR2D_SRC_BASE_C_LOCALE_H
#define HR2D_SRC_BASE_C_LOCALE_H

#include <locale.h>

#ifdef _WIN32
typedef int hr2di_c_locale;
#else
typedef locale_t hr2di_c_locale;
#endif

/* Returns 0, or -1 if there is no memory for it. */
int hr2di_c_locale_create(hr2di_c_locale *locale);
void hr2di_c_locale_destroy(hr2di_c_locale locale);

/* strtod() of a text without a comma.  It is the locale of this thread alone, and only
   meanwhile: other code may print.  The text is as before afterwards. */
double hr2di_c_locale_strtod(hr2di_c_locale locale, char *text, char **end);

#endif
