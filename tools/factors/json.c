/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrix as JSON, written row by row: a document of jansson would take ten times the memory
   of the matrix. */
#include "output/json.h"

#include <stdio.h>

#include "factors/factors.h"
#include "output/output.h"

static int write_member(FILE *stream, const char *key, json_t *value) {
  fprintf(stream, ",\n  \"%s\": ", key);
  return json_write_value(stream, value);
}

static json_t *patch_entry(const factors *f, size_t k) {
  json_t *patch = json_patch(f->scene, k);
  json_put(&patch, "row_sum", json_number(f->row_sum[k]));
  json_put(&patch, "missing", json_number(f->missing[k]));
  if (hr2d_scene_cut_off(f->scene) > 0) {
    json_put(&patch, "cut_off_estimate", json_number(f->off[0][k]));
    json_put(&patch, "cut_off_bound", json_number(f->off[1][k]));
  }
  return patch;
}

static json_t *row(const factors *f, size_t k) {
  return json_numbers(factors_row(f, k), f->patches);
}

/* An array with an item per patch, each on its own line. */
static int write_list(FILE *stream, const char *key, const factors *f,
                      json_t *(*item)(const factors *, size_t)) {
  int status = 0;
  fprintf(stream, ",\n  \"%s\": [", key);
  for (size_t k = 0; !status && !ferror(stream) && k < f->patches; k++) {
    fputs(k ? ",\n    " : "\n    ", stream);
    status = json_write_value(stream, item(f, k));
  }
  fputs("\n  ]", stream);
  return status;
}

static json_t *work(const factors *f) {
  json_t *object = json_object();
  json_put(&object, "exchange_areas", json_count(f->counts.exchange_areas));
  json_put(&object, "partial_pairs", json_count(f->counts.partial_pairs));
  json_put(&object, "unseen_pairs", json_count(factors_unseen(f)));
  json_put(&object, "visibility_tests", json_count(f->counts.visibility_tests));
  return object;
}

int factors_write_json(const factors *f, const char *path) {
  output out;
  int status = output_open(&out, path);
  if (status) return status;
  fputs("{\n  \"scene\": ", out.stream);
  status = json_write_value(out.stream, json_text(f->options->scene));
  if (!status) status = write_member(out.stream, "cuts", json_count(f->cuts));
  if (!status) status = write_list(out.stream, "patches", f, patch_entry);
  if (!status) status = write_list(out.stream, "factors", f, row);
  if (!status) status = write_member(out.stream, "effects", json_effects(f->scene));
  if (!status) status = write_member(out.stream, "work", work(f));
  if (!status) status = write_member(out.stream, "seconds", json_number(f->seconds));
  if (!status) status = write_member(out.stream, "status", json_text("ok"));
  fputs("\n}\n", out.stream);
  return output_close(&out, status);
}
