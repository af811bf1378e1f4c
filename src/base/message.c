/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sentence an object keeps about its last failure. */
#include "base/message.h"

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

static int within(unsigned char byte, int min, int max) {
  return byte >= min && byte <= max;
}

/* The Unicode Standard, table 3-7. */
size_t hr2di_message_utf8(const unsigned char *s) {
  if (s[0] < 0x80) return 1;
  if (within(s[0], 0xC2, 0xDF)) return within(s[1], 0x80, 0xBF) ? 2 : 0;
  const int three = within(s[0], 0xE0, 0xEF);
  if (!three && !within(s[0], 0xF0, 0xF4)) return 0;
  /* No overlong forms, no surrogates, nothing beyond U+10FFFF. */
  const int min = s[0] == 0xE0 ? 0xA0 : s[0] == 0xF0 ? 0x90 : 0x80;
  const int max = s[0] == 0xED ? 0x9F : s[0] == 0xF4 ? 0x8F : 0xBF;
  if (!within(s[1], min, max) || !within(s[2], 0x80, 0xBF)) return 0;
  if (three) return 3;
  return within(s[3], 0x80, 0xBF) ? 4 : 0;
}

int hr2di_message_is_utf8(const char *text) {
  const unsigned char *s = (const unsigned char *)text;
  size_t length = 1;
  for (; *s && length; s += length) length = hr2di_message_utf8(s);
  return length != 0;
}

/* C0 and C1, the control characters of ASCII and of Latin-1, and those that turn the direction
   of a text, U+202A to U+202E and U+2066 to U+2069. */
static int is_control(const unsigned char *c) {
  if (*c < 0x20 || *c == 0x7F || (c[0] == 0xC2 && c[1] < 0xA0)) return 1;
  if (c[0] != 0xE2) return 0;
  return (c[1] == 0x80 && within(c[2], 0xAA, 0xAE)) ||
         (c[1] == 0x81 && within(c[2], 0xA6, 0xA9));
}

/* Replaces broken UTF-8 and control characters by '?': texts quoted from files may be cut
   within a character, and a terminal would obey control characters. */
static void make_readable(char *text) {
  unsigned char *c = (unsigned char *)text;
  while (*c) {
    const size_t length = hr2di_message_utf8(c);
    const int bad = length == 0 || is_control(c);
    if (bad) memset(c, '?', length ? length : 1);
    c += length ? length : 1;
  }
}

void hr2di_message_copy(char *to, size_t room, const char *text) {
  const size_t length = strlen(text), cut = length < room ? length : room - 1;
  memcpy(to, text, cut);
  to[cut] = '\0';
  if (cut < length) trim_partial(to, cut);
}

void hr2di_message_write(hr2di_message *message, const char *format, va_list arguments) {
  /* Written aside first: an argument may be the old message itself. */
  char text[sizeof message->text];
  const int length = vsnprintf(text, sizeof text, format, arguments);
  if (length < 0)
    text[0] = '\0';
  else if ((size_t)length >= sizeof text)
    trim_partial(text, sizeof text - 1);
  make_readable(text);
  memcpy(message->text, text, sizeof text);
}

hr2d_status hr2di_message_fail(hr2di_message *message, hr2d_status status, const char *format,
                               ...) {
  va_list arguments;
  va_start(arguments, format);
  hr2di_message_write(message, format, arguments);
  va_end(arguments);
  return status;
}

hr2di_message_quoted hr2di_message_quote(const char *name) {
  hr2di_message_quoted quote;
  /* A name of up to 60 bytes is quoted whole. */
  char cut[61];
  hr2di_message_copy(cut, sizeof cut, name);
  snprintf(quote.text, sizeof quote.text, "\"%s%s\"", cut,
           strlen(name) < sizeof cut ? "" : "...");
  make_readable(quote.text);
  return quote;
}
