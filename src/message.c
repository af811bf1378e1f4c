/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sentence an object keeps about its last failure. */
#include "message.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* How many bytes a UTF-8 character has, by its first byte. */
static size_t utf8_length(unsigned char first) {
  if (first >= 0xF0) return 4;
  if (first >= 0xE0) return 3;
  return first >= 0xC0 ? 2 : 1;
}

/* Removes the last character of text[0,length) if not all of its bytes are there. */
static void trim_partial(char *text, size_t length) {
  size_t start = length;
  while (start > 0 && length - start < 4) {
    const unsigned char byte = (unsigned char)text[--start];
    if ((byte & 0xC0) == 0x80) continue;
    if (start + utf8_length(byte) > length) text[start] = '\0';
    return;
  }
}

hr2d_status hr2di_fail(hr2di_message *message, hr2d_status status, const char *format, ...) {
  /* Written aside first: an argument may be the old message itself. */
  char text[sizeof message->text];
  va_list arguments;
  va_start(arguments, format);
  const int length = vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (length < 0)
    text[0] = '\0';
  else if ((size_t)length >= sizeof text)
    trim_partial(text, sizeof text - 1);
  memcpy(message->text, text, sizeof text);
  return status;
}

hr2di_quote hr2di_quote_name(const char *name) {
  hr2di_quote quote;
  const size_t most = 60, length = strlen(name);
  size_t cut = length < most ? length : most;
  while (cut < length && ((unsigned char)name[cut] & 0xC0) == 0x80) cut--;
  char *at = quote.text;
  *at++ = '"';
  for (size_t k = 0; k < cut; k++) {
    const unsigned char c = (unsigned char)name[k];
    *at++ = c < 0x20 || c == 0x7F ? '?' : name[k];
  }
  strcpy(at, cut < length ? "...\"" : "\"");
  return quote;
}
