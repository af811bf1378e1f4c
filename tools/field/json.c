/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field as JSON, written point by point. */
#include "output/json.h"

#include <stdio.h>

#include "field/field.h"
#include "output/output.h"
#include "output/provenance.h"

static const char *const places[] = {[HR2D_PLACE_BETWEEN] = "between",
                                     [HR2D_PLACE_PATCH] = "patch",
                                     [HR2D_PLACE_OUTSIDE] = "outside"};

static json_t *point(const field *f, size_t k) {
  json_t *object = json_object();
  json_put(&object, "x", json_number(f->at[k].x));
  json_put(&object, "y", json_number(f->at[k].y));
  json_put(&object, "place", json_text(places[f->place[k]]));
  json_put(&object, "mean", json_numbers(f->mean + k * f->bands, f->bands));
  json_put(&object, "flux", json_numbers(f->flux + 2 * k * f->bands, 2 * f->bands));
  json_put(&object, "error", json_numbers(f->error + k * f->bands, f->bands));
  json_put(&object, "sky", json_number(f->sky[k]));
  if (f->irradiance) {
    json_put(&object, "irradiance", json_numbers(f->irradiance + k * f->bands, f->bands));
    json_put(&object, "irradiance_error",
             json_numbers(f->irradiance_error + k * f->bands, f->bands));
  }
  if (f->heat) json_put(&object, "temperature", json_number(field_temperature(f, k)));
  return object;
}

int field_write_json(const field *f, const char *path) {
  output out;
  int status = output_open(&out, path);
  if (status) return status;
  fputs("{\n  \"scene\": ", out.stream);
  status = json_write_value(out.stream, json_text(f->options->scene));
  fputs(",\n  \"provenance\": ", out.stream);
  if (!status) status = json_write_value(out.stream, provenance_json());
  fprintf(out.stream, ",\n  \"columns\": %zu,\n  \"rows\": %zu,\n%s  \"points\": [",
          f->grid.columns, f->grid.rows,
          f->options->pfm ? "  \"nodes\": \"pixel centres\",\n" : "");
  for (size_t k = 0; k < f->count && !status && !ferror(out.stream); k++) {
    fputs(k ? ",\n    " : "\n    ", out.stream);
    status = json_write_value(out.stream, point(f, k));
  }
  fputs("\n  ]\n}\n", out.stream);
  return output_close(&out, status);
}
