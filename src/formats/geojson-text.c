/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From text to jansson's tree, so that a failed allocation is nothing worse than that.

   jansson's lexer collects a token in a buffer that doubles, and drops a byte in silence when
   it cannot.  A dropped digit changes a number; a dropped quote sends the lexer beyond the
   buffer; and a dropped byte behind a number, which is put back, ends the program by an
   assertion.  So the text is not given as it is but as

       ["ooo…",TEXT]

   with a string that makes the buffer as large as the longest token of the text will need it.
   That is fed byte by byte, so that errno tells of a growth that failed before anything else
   is done. */
#include "formats/geojson-text.h"

#include <errno.h>
#include <string.h>

/* What is to be known of a text before it is parsed. */
typedef struct outline {
  const char *start; /* its first bracket, or another byte, which no scene begins with */
  const char *end;   /* behind the bracket that closes the first one; NULL if there is none */
  size_t longest;    /* token */
} outline;

static int is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/* Behind the string that begins at `at`. */
static const char *skip_string(const char *at, const char *end) {
  for (at++; at < end && *at != '"'; at++)
    if (*at == '\\' && at + 1 < end) at++;
  return at < end ? at + 1 : end;
}

/* Behind a number or a word; whatever else is no part of JSON. */
static const char *skip_word(const char *at, const char *end) {
  while (at < end && !is_space(*at) && !strchr("{}[]:,\"", *at)) at++;
  return at;
}

/* Where jansson stops at an error there may be more tokens here, but none is shorter. */
static outline survey(const char *text, size_t size) {
  const char *const last = text + size;
  outline o = {.start = text};
  size_t depth = 0;
  while (o.start < last && is_space(*o.start)) o.start++;
  for (const char *at = o.start; at < last && !o.end;) {
    const char *const token = at;
    if (*at == '"')
      at = skip_string(at, last);
    else if (*at && strchr("{[", *at))
      depth++;
    else if (*at && strchr("}]", *at))
      o.end = --depth ? NULL : at + 1;
    else
      at = skip_word(at, last);
    if (at == token) at++;
    if ((size_t)(at - token) > o.longest) o.longest = (size_t)(at - token);
  }
  return o;
}

/* What jansson reads. */
typedef struct source {
  const char *next, *end; /* of the text */
  size_t pad;             /* length of the string before it */
  size_t fed;             /* bytes of what stands before the text */
  int close;              /* the bracket behind the text is still to be fed */
  int starved;            /* a byte may have been dropped */
} source;

/* The buffer has 2^k bytes, 16 at first, and grows for a byte at the index 2^k − 1.  With
   2^k − 1 bytes and two quotes it ends up at 2^(k+1), not growing for the last quote: there
   would be no byte behind it in which errno is looked at, and the lexer has no end of string.
   That holds a token of 2^(k+1) − 2 bytes and the one behind it. */
static size_t pad_for(size_t longest) {
  size_t size = 16;
  while (2 * size - 2 < longest) size *= 2;
  return size - 1;
}

enum { AROUND = 4 }; /* bytes before the text that are not of the string itself */

static char byte_before(const source *s, size_t k) {
  if (k == 0) return '[';
  if (k == s->pad + 3) return ',';
  return k == 1 || k == s->pad + 2 ? '"' : 'o';
}

static size_t feed(void *buffer, size_t size, void *data) {
  source *s = data;
  const size_t rest = (size_t)(s->end - s->next), some = rest < size ? rest : size;
  s->starved |= errno == ENOMEM;
  if (s->starved || size == 0) return 0;
  if (s->fed < s->pad + AROUND) {
    *(char *)buffer = byte_before(s, s->fed++);
    return 1;
  }
  if (rest == 0 && s->close) {
    s->close = 0;
    *(char *)buffer = ']';
    return 1;
  }
  if (some) memcpy(buffer, s->next, some);
  s->next += some;
  return some;
}

/* In characters, as jansson counts them. */
static hr2d_status fail_at(hr2di_message *message, const char *text, const char *at,
                           const char *what) {
  unsigned long line = 1, column = 1;
  for (; text < at; text++) {
    const int continues = ((unsigned char)*text & 0xC0) == 0x80;
    column = *text == '\n' ? 1 : column + !continues;
    line += *text == '\n';
  }
  return hr2di_message_fail(message, HR2D_ESYNTAX, "line %lu, column %lu: %s", line, column,
                            what);
}

static hr2d_status fail_error(hr2di_message *message, const source *s,
                              const json_error_t *error) {
  const int before = error->line == 1 ? (int)s->pad + AROUND : 0;
  /* jansson's own text names a flag of its interface. */
  const int nul = json_error_code(error) == json_error_null_character;
  return hr2di_message_fail(message, HR2D_ESYNTAX, "line %d, column %d: %s", error->line,
                            error->column - before,
                            nul ? "a string must not contain \\u0000" : error->text);
}

/* The text within the array that holds it, as a reference of its own. */
static json_t *unwrap(json_t *wrapped) {
  json_t *root = json_incref(json_array_get(wrapped, 1));
  json_decref(wrapped);
  return root;
}

hr2d_status hr2di_geojson_load(const char *text, size_t size, json_t **root,
                               hr2di_message *message) {
  const outline o = survey(text, size);
  const char *const last = text + size;
  *root = NULL;
  if (o.start == last || (*o.start != '{' && *o.start != '['))
    return fail_at(message, text, o.start, "'[' or '{' expected");
  source s = {.next = text,
              .end = o.end ? o.end : last,
              .pad = pad_for(o.longest),
              .close = o.end != NULL};
  json_error_t error = {0};
  const int errno_before = errno;
  errno = 0;
  json_t *wrapped =
      json_load_callback(feed, &s, JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &error);
  const int starved = s.starved || errno == ENOMEM;
  errno = errno_before;
  *root = unwrap(wrapped);
  if (!*root && !starved && error.text[0] &&
      json_error_code(&error) != json_error_out_of_memory)
    return fail_error(message, &s, &error);
  /* There is no text either for some of the allocations that can fail. */
  if (!*root || starved) {
    json_decref(*root);
    *root = NULL;
    return hr2di_message_fail(message, HR2D_ENOMEM, "out of memory while parsing");
  }
  const char *behind = s.end;
  while (behind < last && is_space(*behind)) behind++;
  if (behind == last) return HR2D_OK;
  json_decref(*root);
  *root = NULL;
  return fail_at(message, text, behind, "end of file expected");
}
