/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "output/provenance.h"

#include <hr2d/version.h>
#include <stdlib.h>
#include <string.h>

#include "output/complain.h"
#include "output/json.h"
#include "output/printable.h"
#include "output/sha256.h"

static struct {
  const char *command;
  json_t *options; /* words */
  json_t *scene;   /* a file name */
  char sha256[SHA256_TEXT];
} record;

void provenance_begin(const char *command) {
  provenance_release();
  record.command = command;
  record.options = json_array();
}

void provenance_option(const char *name, const char *text) {
  char word[64];
  snprintf(word, sizeof word, "--%s", name);
  json_push(&record.options, json_text(word));
  if (text) json_push(&record.options, json_text(text));
}

void provenance_scene(const char *path, const void *bytes, size_t size) {
  const char *slash = strrchr(path, '/');
  json_decref(record.scene);
  record.scene = json_text(slash ? slash + 1 : path);
  sha256_text(bytes, size, record.sha256);
}

void provenance_release(void) {
  json_decref(record.options);
  json_decref(record.scene);
  memset(&record, 0, sizeof record);
}

json_t *provenance_json(void) {
  json_t *object = json_object();
  json_put(&object, "program", json_text(PROGRAM_NAME));
  json_put(&object, "version", json_text(hr2d_version()));
  json_put(&object, "command", json_text(record.command));
  json_put(&object, "options", json_incref(record.options));
  json_put(&object, "sha256", json_text(record.sha256));
  return object;
}

/* As a shell reads it back, but for control characters. */
static void put_word(const char *word, FILE *stream) {
  static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                              "0123456789%+,-./:=@_";
  if (*word && !word[strspn(word, plain)]) {
    fputs(word, stream);
    return;
  }
  fputc('\'', stream);
  for (size_t length; *word; word += length ? length : 1) {
    length = printable_length(word);
    if (*word == '\'')
      fputs("'\\''", stream);
    else
      fwrite(length ? word : "?", 1, length ? length : 1, stream);
  }
  fputc('\'', stream);
}

char *provenance_text(void) {
  char *text = NULL;
  size_t size = 0;
  FILE *stream = record.options && record.scene ? open_memstream(&text, &size) : NULL;
  if (!stream) return NULL;
  fprintf(stream, PROGRAM_NAME " %s: " PROGRAM_NAME " %s ", hr2d_version(), record.command);
  put_word(json_string_value(record.scene), stream);
  for (size_t k = 0; k < json_array_size(record.options); k++) {
    fputc(' ', stream);
    put_word(json_string_value(json_array_get(record.options, k)), stream);
  }
  fprintf(stream, "; SHA-256 of the scene: %s", record.sha256);
  if (!(ferror(stream) | fclose(stream))) return text;
  free(text);
  return NULL;
}

int provenance_print(FILE *stream, const char *before, const char *after) {
  char *text = provenance_text();
  if (!text) return complain_memory();
  fprintf(stream, "%s%s%s", before, text, after);
  free(text);
  return 0;
}
