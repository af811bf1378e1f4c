/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses text into jansson's tree, so that a failed allocation leads to HR2D_ENOMEM alone.

   jansson's lexer collects each token in a buffer that doubles.  If the buffer cannot grow, the
   lexer drops a byte and reports nothing.  A dropped digit changes a number.  A dropped quote
   sends the lexer beyond the buffer.  A dropped byte behind a number, which the lexer puts
   back, ends the program by an assertion.  So jansson does not get the text itself but

       ["ooo…",TEXT]

   The string makes the buffer as large as the longest token of the text needs it.  The string
   is fed byte by byte, so that errno shows a failed growth before anything else is done. */
#include "formats/geojson-text.h"

#include <errno.h>
#include <string.h>

/* Facts about a text that the parser needs beforehand. */
typedef struct outline {
  const char *start; /* its first byte that is no space; a bracket, or the text is no scene */
  const char *end;   /* behind the bracket that closes the first one; NULL if there is none */
  size_t longest;    /* length of the longest token */
} outline;

static int is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/* The position behind the string that begins at `at`. */
static const char *skip_string(const char *at, const char *end) {
  for (at++; at < end && *at != '"'; at++)
    if (*at == '\\' && at + 1 < end) at++;
  return at < end ? at + 1 : end;
}

/* The position behind a number or a word; anything else here is not JSON. */
static const char *skip_word(const char *at, const char *end) {
  while (at < end && !is_space(*at) && !strchr("{}[]:,\"", *at)) at++;
  return at;
}

/* Tokens between two declarations of work. */
enum { BATCH = 64 };

/* Behind an error, where jansson stops, this may see more tokens, but never shorter ones. */
static outline survey(const char *text, size_t size, hr2di_watch *watch) {
  const char *const last = text + size;
  outline o = {.start = text};
  size_t depth = 0;
  while (o.start < last && is_space(*o.start)) o.start++;
  size_t tokens = 0;
  for (const char *at = o.start; at < last && !o.end;) {
    const char *const token = at;
    if (tokens++ % BATCH == 0 && hr2di_watch_work(watch, BATCH / 4)) return o;
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

/* The input of jansson. */
typedef struct source {
  const char *next, *end; /* of the text */
  size_t pad;             /* length of the string before the text */
  size_t fed;             /* bytes fed so far of those before the text */
  int close;              /* the bracket behind the text is not yet fed */
  int starved;            /* a byte may have been dropped */
  const char *text;
  hr2di_watch *watch;
} source;

/* The buffer has 2^k bytes, 16 at first, and grows for a byte at index 2^k − 1.  A string of
   2^k − 1 bytes and two quotes makes it grow to 2^(k+1) bytes.  It does not grow for the last
   quote: if that growth failed, the lexer would miss the end of the string, and no further byte
   would be fed at which errno is checked.  The buffer then holds a token of 2^(k+1) − 2 bytes
   and the byte behind it. */
static size_t pad_for(size_t longest) {
  size_t size = 16;
  while (2 * size - 2 < longest) size *= 2;
  return size - 1;
}

enum { AROUND = 4 }; /* bytes before the text that are not in the string: ["", */

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
  /* Half of the time of reading is spent here, the other half on the patches. */
  s->watch->report.fraction = 0.5 * (double)(s->next - s->text) / (double)(s->end - s->text);
  return hr2di_watch_work(s->watch, some / 4) ? (size_t)-1 : some;
}

/* Counts columns in characters, as jansson does. */
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
  /* jansson's own texts for these errors name a flag of its interface, or a byte. */
  const enum json_error_code code = json_error_code(error);
  const int nul = code == json_error_null_character || code == json_error_null_byte_in_key;
  return hr2di_message_fail(message, HR2D_ESYNTAX, "line %d, column %d: %s", error->line,
                            error->column - before,
                            nul ? "a string must not contain \\u0000" : error->text);
}

/* jansson drops a NUL byte behind a number or a word, and reads on: a damaged file would be
   another scene. */
static hr2d_status refuse_nul(hr2di_message *message, const char *text, size_t size,
                              hr2di_watch *watch) {
  enum { AT_ONCE = 1 << 16 };
  for (size_t k = 0, some; k < size; k += some) {
    some = size - k < AT_ONCE ? size - k : AT_ONCE;
    const char *nul = memchr(text + k, '\0', some);
    if (nul)
      return fail_at(message, text, nul,
                     "a NUL byte: the file is damaged, or is no text in UTF-8");
    const hr2d_status status = hr2di_watch_work(watch, some / 1024);
    if (status) return status;
  }
  return HR2D_OK;
}

/* Takes the tree of the text out of the array around it; the caller owns the reference. */
static json_t *unwrap(json_t *wrapped) {
  json_t *root = json_incref(json_array_get(wrapped, 1));
  json_decref(wrapped);
  return root;
}

hr2d_status hr2di_geojson_load(const char *text, size_t size, json_t **root,
                               hr2di_message *message, hr2di_watch *watch) {
  *root = NULL;
  const hr2d_status whole = refuse_nul(message, text, size, watch);
  if (whole) return whole;
  const outline o = survey(text, size, watch);
  const char *const last = text + size;
  if (watch->status) return watch->status;
  if (o.start == last || (*o.start != '{' && *o.start != '['))
    return fail_at(message, text, o.start,
                   o.start == last ? "there is no text" : "'[' or '{' expected");
  source s = {.next = text,
              .end = o.end ? o.end : last,
              .pad = pad_for(o.longest),
              .close = o.end != NULL,
              .text = text,
              .watch = watch};
  json_error_t error = {0};
  const int errno_before = errno;
  errno = 0;
  json_t *wrapped =
      json_load_callback(feed, &s, JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &error);
  const int starved = s.starved || errno == ENOMEM;
  errno = errno_before;
  *root = unwrap(wrapped);
  if (watch->status) {
    json_decref(*root);
    *root = NULL;
    return watch->status;
  }
  if (!*root && !starved && error.text[0] &&
      json_error_code(&error) != json_error_out_of_memory)
    return fail_error(message, &s, &error);
  /* Some allocations that fail leave no text in `error`. */
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
