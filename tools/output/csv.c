/* SPDX-License-Identifier: GPL-3.0-or-later */
/* RFC 4180: quotes around what has a separator in it, and quotes doubled. */
#include "output/csv.h"

#include <string.h>

void csv_text(FILE *stream, const char *text) {
  /* Quoted, an empty field that is alone on its line is not taken for an empty line. */
  if (*text && !text[strcspn(text, ",\"\r\n")]) {
    fputs(text, stream);
    return;
  }
  fputc('"', stream);
  for (; *text; text++) {
    if (*text == '"') fputc('"', stream);
    fputc(*text, stream);
  }
  fputc('"', stream);
}
