/* SPDX-License-Identifier: GPL-3.0-or-later */
/* RFC 4180: a field with a separator in it stands in quotes, and its own quotes are doubled. */
#include "output/csv.h"

#include <string.h>

#include "output/provenance.h"

int csv_begin(FILE *stream, int comment) {
  return comment ? provenance_print(stream, "# ", "\n") : 0;
}

void csv_text(FILE *stream, const char *text) {
  /* An empty field is quoted: alone on its line it would look like an empty line. */
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
