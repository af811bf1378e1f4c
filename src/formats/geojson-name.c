/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a name, which strangers have as a string, a number, a truth value, an object of
   languages or an array. */
#include <float.h>
#include <jansson.h>
#include <string.h>

#include "base/alloc.h"
#include "formats/geojson-impl.h"

static int is_plain(const json_t *json) {
  return json_is_number(json) || json_is_boolean(json);
}

static int has_text(const json_t *json) {
  return is_plain(json) || json_string_length(json) > 0;
}

/* IMDF has names in several languages.  Messages are English, so that its name goes first. */
static const json_t *one_of(const json_t *object) {
  json_t *names = (json_t *)(uintptr_t)object; /* iterators change nothing */
  const json_t *english = json_object_get(names, "en");
  if (has_text(english)) return english;
  void *at = json_object_iter(names);
  while (at && !has_text(json_object_iter_value(at))) at = json_object_iter_next(names, at);
  return at ? json_object_iter_value(at) : NULL;
}

/* All numbers are real ones here, and jansson writes 7 as 7.0.  Strings stay as they are. */
static void drop_decimal_zeros(char *text) {
  char *to = text;
  int in_string = 0;
  for (const char *at = text; *at;) {
    in_string ^= *at == '"';
    if (!in_string && !strncmp(at, ".0", 2) && (!at[2] || strchr(",]}", at[2]))) at += 2;
    if (in_string && *at == '\\') *to++ = *at++;
    if (*at) *to++ = *at++;
  }
  *to = '\0';
}

/* As JSON, with as many digits as any decimal number keeps in a double; jansson asks no locale,
   but for memory, even for a number. */
static hr2d_status write_name(hr2di_geojson *reader, const json_t *name, const char **text) {
  const size_t flags = JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(DBL_DIG);
  const size_t size = json_dumpb(name, NULL, 0, flags);
  if (!size ||
      hr2di_alloc_reserve(reader->alloc, &reader->written, &reader->written_capacity, size + 1,
                          1) ||
      json_dumpb(name, reader->written, size, flags) != size)
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "out of memory for a name");
  reader->written[size] = '\0';
  drop_decimal_zeros(reader->written);
  *text = reader->written;
  return HR2D_OK;
}

hr2d_status hr2di_geojson_name(hr2di_geojson *reader, const json_t *name, const char **text) {
  *text = NULL;
  if (json_is_object(name)) name = one_of(name);
  if (json_is_string(name)) *text = json_string_value(name);
  if (!is_plain(name) && json_array_size(name) == 0) return HR2D_OK;
  const hr2d_status status = write_name(reader, name, text);
  /* A long array is a list of something, and no reason to refuse a file. */
  if (!status && strlen(*text) > HR2DI_MOST_NAME) *text = NULL;
  return status;
}
