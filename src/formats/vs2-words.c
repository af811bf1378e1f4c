/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splits the text of a .vs2 file into lines, words and numbers.  Words point into the text and
   are copied only as fields, so that memory beside the text is needed for the longest field
   alone. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/alloc.h"
#include "formats/vs2-impl.h"

int hr2di_vs2_line(hr2di_vs2_span *text, hr2di_vs2_span *line) {
  const char *end = text->at;
  if (end == text->end) return 0;
  while (end < text->end && *end != '\n' && *end != '\r') end++;
  *line = (hr2di_vs2_span){text->at, end};
  if (end < text->end && *end++ == '\r' && end < text->end && *end == '\n') end++;
  text->at = end;
  return 1;
}

static int separates(char c) {
  return c == ' ' || c == '\t' || c == ',';
}

int hr2di_vs2_word(hr2di_vs2_span *line, hr2di_vs2_span *word) {
  while (line->at < line->end && separates(*line->at)) line->at++;
  if (line->at == line->end || *line->at == '!') return 0;
  word->at = line->at;
  while (line->at < line->end && !separates(*line->at)) line->at++;
  word->end = line->at;
  return 1;
}

hr2d_status hr2di_vs2_field(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what) {
  hr2di_vs2_span word;
  if (!hr2di_vs2_word(line, &word))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "line %zu: %s is missing",
                              reader->line, what);
  const size_t size = (size_t)(word.end - word.at);
  if (memchr(word.at, '\0', size))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "line %zu: %s contains a zero byte", reader->line, what);
  if (hr2di_alloc_reserve(reader->alloc, &reader->word, &reader->word_capacity, size + 1, 1))
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "line %zu: out of memory",
                              reader->line);
  memcpy(reader->word, word.at, size);
  reader->word[size] = '\0';
  return HR2D_OK;
}

hr2d_status hr2di_vs2_number(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what,
                             double *value) {
  hr2d_status status = hr2di_vs2_field(reader, line, what);
  if (status) return status;
  char *word = reader->word, *end;
  *value = hr2di_c_locale_strtod(reader->numbers, word, &end);
  /* strtod() also accepts words and hexadecimal digits, which the format does not have. */
  if (end == word || *end || word[strspn(word, "0123456789+-.eE")])
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "line %zu: %s must be a number, not %s", reader->line, what,
                              hr2di_vs2_quote(reader).text);
  if (!isfinite(*value))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "line %zu: %s is beyond a double: %s", reader->line, what,
                              hr2di_vs2_quote(reader).text);
  return HR2D_OK;
}

hr2d_status hr2di_vs2_integer(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what,
                              long long *value) {
  hr2d_status status = hr2di_vs2_field(reader, line, what);
  if (status) return status;
  const char *digits = reader->word + (*reader->word == '-' || *reader->word == '+');
  if (!*digits || digits[strspn(digits, "0123456789")])
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "line %zu: %s must be an integer, not %s", reader->line, what,
                              hr2di_vs2_quote(reader).text);
  *value = strtoll(reader->word, NULL, 10);
  return HR2D_OK;
}

hr2d_status hr2di_vs2_name(hr2di_vs2 *reader, hr2di_vs2_span *line) {
  hr2d_status status = hr2di_vs2_field(reader, line, "name");
  if (status || hr2di_message_is_utf8(reader->word)) return status;
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                            "line %zu: name must be UTF-8, not %s", reader->line,
                            hr2di_vs2_quote(reader).text);
}

/* Messages are UTF-8, even if the file is not. */
hr2di_message_quoted hr2di_vs2_quote(hr2di_vs2 *reader) {
  if (!hr2di_message_is_utf8(reader->word))
    for (char *c = reader->word; *c; c++)
      if ((unsigned char)*c >= 0x80) *c = '?';
  return hr2di_message_quote(reader->word);
}
