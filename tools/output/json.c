/* SPDX-License-Identifier: GPL-3.0-or-later */
/* jansson refuses what is not finite or not UTF-8; here such values get a spelling. */
#include "output/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output/complain.h"
#include "output/output.h"

enum { MOST_ROWS = 60, END_ROWS = 20 };

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

json_t *json_effects(const hr2d_scene *scene) {
  json_t *effects = json_object();
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++)
    json_put(&effects, hr2d_effect_name((hr2d_effect)e),
             json_boolean(hr2d_scene_effect(scene, (hr2d_effect)e, NULL)));
  return effects;
}

static int write_chunk(const char *text, size_t size, void *stream) {
  return fwrite(text, 1, size, stream) == size ? 0 : -1;
}

int json_write(json_t *document, const char *path) {
  if (!document) return fail_memory();
  output out;
  int status = output_open(&out, path);
  if (!status) {
    const size_t flags = JSON_INDENT(2) | JSON_REAL_PRECISION(17);
    if (json_dump_callback(document, write_chunk, out.stream, flags) && !ferror(out.stream))
      status = fail_memory();
    if (!status) fputc('\n', out.stream);
    status = output_close(&out, status);
  }
  json_decref(document);
  return status;
}

void print_scene(const options *o, int width, size_t cuts) {
  printf("%-*s%s\n", width, "scene", o->scene);
  if (o->split_crossings) printf("%-*s%zu cut\n", width, "crossings", cuts);
}

void print_work(const effort *list, size_t count) {
  int column = 0;
  for (size_t k = 0; k < count; k++) {
    char text[64];
    if (!list[k].count) continue;
    const int width = snprintf(text, sizeof text, " %s %llu", list[k].what,
                               (unsigned long long)list[k].count);
    if (!column || column + 1 + width > 79)
      column = printf(column ? ",\n%-9s" : "%-9s", column ? "" : "work");
    else
      column += printf(",");
    column += printf("%s", text);
  }
  if (column) puts("");
}

int is_skipped(size_t k, size_t count) {
  const size_t skipped = count > MOST_ROWS ? count - 2 * END_ROWS : 0;
  if (!skipped || k < END_ROWS || k >= count - END_ROWS) return 0;
  if (k == END_ROWS)
    printf("  ...  %zu more patches; --json and --csv have all of them\n", skipped);
  return 1;
}

int columns(const char *text) {
  int n = 0;
  for (; *text; text++) n += ((unsigned char)*text & 0xC0) != 0x80;
  return n;
}

void print_padded(FILE *stream, const char *text, int width) {
  const int n = columns(text);
  fprintf(stream, "%s%*s", text, width > n ? width - n : 0, "");
}

int name_width(const hr2d_scene *scene) {
  int width = 4;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const int n = columns(hr2d_scene_name(scene, k));
    if (n > width) width = n;
  }
  return width;
}
