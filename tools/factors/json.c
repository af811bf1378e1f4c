/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The factors that are not 0 as JSON, written row by row: a document of jansson would take ten
   times their memory. */
#include "output/json.h"

#include <stdio.h>

#include "factors/factors.h"
#include "output/output.h"
#include "output/provenance.h"

static int write_member(FILE *stream, const char *key, json_t *value) {
  fprintf(stream, ",\n  \"%s\": ", key);
  return json_write_value(stream, value);
}

static json_t *patch_entry(const factors *f, size_t k) {
  json_t *patch = json_object();
  json_put(&patch, "index", json_count(k));
  json_put(&patch, "name", json_text(f->name[k]));
  json_put(&patch, "length", json_number(f->length[k]));
  json_put(&patch, "row_sum", json_number(f->row_sum[k]));
  json_put(&patch, "missing", json_number(f->missing[k]));
  if (hr2d_scene_cut_off(f->scene) > 0) {
    json_put(&patch, "cut_off_estimate", json_number(f->off[0][k]));
    json_put(&patch, "cut_off_bound", json_number(f->off[1][k]));
  }
  return patch;
}

/* Row i: the patches that patch i sees, which rise, and their F_ij. */
static json_t *row(const factors *f, size_t i) {
  json_t *object = json_object(), *columns = json_array(), *values = json_array();
  for (uint64_t k = f->start[i]; k < f->start[i + 1]; k++) {
    json_push(&columns, json_count(f->column[k]));
    json_push(&values, json_number(f->area[k] / f->length[i]));
  }
  json_put(&object, "columns", columns);
  json_put(&object, "values", values);
  return object;
}

/* An array with an item per patch, each on its own line. */
static int write_list(FILE *stream, const char *key, const factors *f,
                      json_t *(*item)(const factors *, size_t)) {
  int status = 0;
  fprintf(stream, ",\n  \"%s\": [", key);
  for (size_t k = 0; !status && !ferror(stream) && k < f->count; k++) {
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
  if (!status) status = write_member(out.stream, "provenance", provenance_json());
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
