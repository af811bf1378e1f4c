/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "output/metadata.h"

#include <stdlib.h>
#include <string.h>

#include "output/complain.h"
#include "output/png.h"
#include "output/provenance.h"

void metadata_put_xml(FILE *stream, const char *text) {
  for (; *text; text++) switch (*text) {
    case '<':
      fputs("&lt;", stream);
      break;
    case '&':
      fputs("&amp;", stream);
      break;
    default:
      fputc(*text, stream);
    }
}

static size_t after(const char *bytes, size_t size, size_t from, const char *word) {
  const size_t length = strlen(word);
  for (; from + length <= size; from++)
    if (!memcmp(bytes + from, word, length)) return from + length;
  return 0;
}

/* Behind IHDR, or behind the opening tag of the first element; 0: nowhere. */
static size_t place_of(suffix format, const char *bytes, size_t size) {
  const size_t header = PNG_SIGNATURE + PNG_AROUND + PNG_IHDR;
  if (format == SUFFIX_PNG) return size > header ? header : 0;
  const size_t tag = format == SUFFIX_SVG ? after(bytes, size, 0, "<svg") : 0;
  return tag ? after(bytes, size, tag, ">") : 0;
}

int metadata_write(FILE *stream, suffix format, const char *bytes, size_t size) {
  const size_t place = place_of(format, bytes, size);
  char *text = provenance_text();
  if (!text) return complain_memory();
  fwrite(bytes, 1, place, stream);
  if (place && format == SUFFIX_PNG) png_write_comment(stream, text);
  if (place && format == SUFFIX_SVG) {
    fputs("\n<metadata>", stream);
    metadata_put_xml(stream, text);
    fputs("</metadata>", stream);
  }
  fwrite(bytes + place, 1, size - place, stream);
  free(text);
  return 0;
}
