/* SPDX-License-Identifier: GPL-3.0-or-later */
/* .svg, .png or .pdf, in lower or upper case, after at least one character. */
#include "output/suffix.h"

#include <string.h>
#include <strings.h>

suffix suffix_of(const char *path) {
  const size_t n = strlen(path);
  if (n < 5 || path[n - 5] == '/') return SUFFIX_OTHER;
  const char *end = path + n - 4;
  if (!strcasecmp(end, ".svg")) return SUFFIX_SVG;
  if (!strcasecmp(end, ".png")) return SUFFIX_PNG;
  if (!strcasecmp(end, ".pdf")) return SUFFIX_PDF;
  return SUFFIX_OTHER;
}
