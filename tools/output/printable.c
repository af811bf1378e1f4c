/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "output/printable.h"

#include <string.h>

/* The Unicode Standard, table 3-7: the bytes of each length, without overlong forms, surrogates
   and what is beyond U+10FFFF.  0 for no character. */
static size_t decode(const unsigned char *s, unsigned long *code) {
  static const unsigned long min[] = {0, 0, 0x80, 0x800, 0x10000};
  const size_t length = *s < 0x80 ? 1 : *s < 0xC2 ? 0 : *s < 0xE0 ? 2 : *s < 0xF0 ? 3 : 4;
  if (!length || *s > 0xF4) return 0;
  *code = length == 1 ? *s : *s & (0xFFu >> (length + 1));
  for (size_t k = 1; k < length; k++) {
    if ((s[k] & 0xC0) != 0x80) return 0;
    *code = *code << 6 | (s[k] & 0x3Fu);
  }
  if (*code < min[length] || *code > 0x10FFFF) return 0;
  return *code >= 0xD800 && *code < 0xE000 ? 0 : length;
}

size_t printable_length(const char *text) {
  unsigned long c = 0;
  const size_t length = decode((const unsigned char *)text, &c);
  const int control = c < 0x20 || (c >= 0x7F && c < 0xA0);
  const int turns = (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
  return control || turns || (c & 0xFFFE) == 0xFFFE ? 0 : length;
}

void printable_copy(char *to, size_t room, const char *text) {
  while (*text) {
    const size_t length = printable_length(text), size = length ? length : 1;
    if (size >= room) break;
    if (length)
      memcpy(to, text, size);
    else
      *to = '?';
    to += size;
    text += size;
    room -= size;
  }
  *to = '\0';
}

void printable_put(const char *text, FILE *stream) {
  for (size_t length; *text; text += length ? length : 1) {
    length = printable_length(text);
    fwrite(length ? text : "?", 1, length ? length : 1, stream);
  }
}
