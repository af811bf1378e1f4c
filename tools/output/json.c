/* SPDX-License-Identifier: GPL-3.0-or-later */
/* jansson refuses numbers that are not finite and text that is not UTF-8; here they get a
   spelling. */
#include "output/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output/complain.h"
#include "output/output.h"

json_t *json_number(double x) {
  return isfinite(x) ? json_real(x) : json_null();
}

json_t *json_count(uint64_t n) {
  return json_integer((json_int_t)n);
}

/* Bytes of the UTF-8 character at text, or 0; jansson itself is the judge. */
static size_t character(const char *text) {
  for (size_t n = 1; n <= 4 && text[n - 1]; n++) {
    json_t *one = json_stringn(text, n);
    json_decref(one);
    if (one) return n;
  }
  return 0;
}

json_t *json_text(const char *text) {
  static const char replacement[] = "\xEF\xBF\xBD";
  json_t *string = json_string(text);
  if (string) return string;
  char *copy = malloc(3 * strlen(text) + 1), *end = copy;
  if (!copy) return NULL;
  while (*text) {
    const size_t n = character(text);
    memcpy(end, n ? text : replacement, n ? n : 3);
    end += n ? n : 3;
    text += n ? n : 1;
  }
  *end = '\0';
  string = json_string(copy);
  free(copy);
  return string;
}

static void settle(json_t **container, int failed) {
  if (failed) {
    json_decref(*container);
    *container = NULL;
  }
}

void json_put(json_t **object, const char *key, json_t *value) {
  settle(object, json_object_set_new(*object, key, value));
}

void json_push(json_t **array, json_t *value) {
  settle(array, json_array_append_new(*array, value));
}

json_t *json_numbers(const double *x, size_t count) {
  json_t *array = json_array();
  for (size_t k = 0; k < count; k++) json_push(&array, json_number(x[k]));
  return array;
}

json_t *json_effects(const hr2d_scene *scene) {
  json_t *effects = json_object();
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++)
    json_put(&effects, hr2d_effect_name((hr2d_effect)e),
             json_boolean(hr2d_scene_effect(scene, (hr2d_effect)e, NULL)));
  return effects;
}

json_t *json_patch(const hr2d_scene *scene, size_t k) {
  json_t *patch = json_object();
  json_put(&patch, "index", json_count(k));
  json_put(&patch, "name", json_text(hr2d_scene_name(scene, k)));
  json_put(&patch, "length", json_number(hr2d_scene_length(scene, k)));
  return patch;
}

static int write_chunk(const char *text, size_t size, void *stream) {
  return fwrite(text, 1, size, stream) == size ? 0 : -1;
}

int json_write_value(FILE *stream, json_t *value) {
  if (!value) return complain_memory();
  const size_t flags = JSON_ENCODE_ANY | JSON_REAL_PRECISION(17);
  const int bad = json_dumpf(value, stream, flags) && !ferror(stream);
  json_decref(value);
  return bad ? complain_memory() : 0;
}

int json_write(json_t *document, const char *path) {
  if (!document) return complain_memory();
  output out;
  int status = output_open(&out, path);
  if (!status) {
    const size_t flags = JSON_INDENT(2) | JSON_REAL_PRECISION(17);
    if (json_dump_callback(document, write_chunk, out.stream, flags) && !ferror(out.stream))
      status = complain_memory();
    if (!status) fputc('\n', out.stream);
    status = output_close(&out, status);
  }
  json_decref(document);
  return status;
}
