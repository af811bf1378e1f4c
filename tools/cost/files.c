/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Costs as CSV and as JSON. */
#include <stdio.h>

#include "cost/cost.h"
#include "output/csv.h"
#include "output/json.h"
#include "output/output.h"
#include "output/provenance.h"

int cost_write_csv(const cost *c) {
  output out;
  int status = output_open(&out, c->options->csv);
  if (status) return status;
  status = csv_begin(out.stream, c->options->csv_comment);
  fputs("method,parameter,order,elements,links,bytes,seconds,error,variant,closure\n",
        out.stream);
  for (size_t k = 0; k < c->count; k++) {
    const cost_row *row = &c->rows[k];
    fprintf(out.stream, "%s,%.17g,%u,%llu,%llu,%llu,%.17g,%.17g,%s,%s\n",
            cost_method_name(row->method), row->parameter, row->order,
            (unsigned long long)row->elements, (unsigned long long)row->links,
            (unsigned long long)row->bytes, row->seconds, row->error,
            cost_method_variant(row->method), cost_method_closure(c, row->method));
  }
  return output_close(&out, status);
}

static json_t *prediction_entry(const cost *c, int k) {
  const hr2d_prediction *p = &c->prediction[k];
  json_t *entry = json_object();
  json_put(&entry, "target", json_number(cost_prediction_target(k)));
  json_put(&entry, "order", json_count(p->order));
  json_put(&entry, "elements", json_count(p->elements));
  json_put(&entry, "leaves", json_count(p->leaves));
  json_put(&entry, "links", json_count(p->links));
  json_put(&entry, "bytes", json_count(p->bytes));
  json_put(&entry, "seconds", json_number(p->seconds));
  json_put(&entry, "least_seconds", json_number(p->least_seconds));
  json_put(&entry, "most_seconds", json_number(p->most_seconds));
  return entry;
}

static json_t *reference_entry(const hr2d_account *a) {
  json_t *entry = json_object();
  json_put(&entry, "estimate", json_number(a->average.estimate));
  json_put(&entry, "bound", json_number(a->average.bound));
  json_put(&entry, "order", json_count(a->order));
  json_put(&entry, "elements", json_count(a->elements));
  json_put(&entry, "links", json_count(a->links));
  json_put(&entry, "seconds", json_number(a->seconds));
  return entry;
}

/* null, if the method has no links of an oracle. */
static void put_variant(json_t **entry, const cost *c, const cost_method *m) {
  json_put(entry, "method", json_text(cost_method_name(m)));
  json_put(entry, "variant", m->oracle ? json_text(cost_method_variant(m)) : json_null());
  json_put(entry, "closure", m->oracle ? json_text(cost_method_closure(c, m)) : json_null());
}

static json_t *row_entry(const cost *c, const cost_row *row) {
  json_t *entry = json_object();
  put_variant(&entry, c, row->method);
  json_put(&entry, row->method->parameter, json_number(row->parameter));
  json_put(&entry, "order", json_count(row->order));
  json_put(&entry, "elements", json_count(row->elements));
  json_put(&entry, "links", json_count(row->links));
  json_put(&entry, "bytes", json_count(row->bytes));
  json_put(&entry, "seconds", json_number(row->seconds));
  json_put(&entry, "error", json_number(row->error));
  return entry;
}

/* The exponents of 1/error, or the cost of each digit. */
static json_t *fit_entry(const cost *c, const cost_method *m) {
  cost_fit time, links;
  if (cost_fit_rows(c, m, AGAINST_SECONDS, &time) || cost_fit_rows(c, m, AGAINST_LINKS, &links))
    return json_null();
  json_t *entry = json_object();
  put_variant(&entry, c, m);
  json_put(&entry, "order", m->oracle ? json_count(m->order) : json_null());
  json_put(&entry, time.is_digital ? "seconds_per_digit" : "seconds_slope",
           json_number(time.is_digital ? time.digit : time.slope));
  json_put(&entry, time.is_digital ? "links_per_digit" : "links_slope",
           json_number(time.is_digital ? links.digit : links.slope));
  if (!time.is_digital) json_put(&entry, "seconds_range", json_number(time.range));
  if (!time.is_digital) json_put(&entry, "links_range", json_number(links.range));
  return entry;
}

static json_t *fits(const cost *c) {
  json_t *list = json_array();
  for (size_t k = 0; k < c->method_count; k++) {
    json_t *entry = fit_entry(c, &c->methods[k]);
    if (json_is_null(entry))
      json_decref(entry);
    else
      json_push(&list, entry);
  }
  return list;
}

int cost_write_json(const cost *c) {
  json_t *root = json_object(), *predictions = json_array(), *rows = json_array();
  for (int k = 0; k < c->predictions; k++) json_push(&predictions, prediction_entry(c, k));
  for (size_t k = 0; k < c->count; k++) json_push(&rows, row_entry(c, &c->rows[k]));
  json_put(&root, "scene", json_text(c->options->scene));
  json_put(&root, "provenance", provenance_json());
  json_put(&root, "cuts", json_count(c->cuts));
  json_put(&root, "threads", json_count(c->options->threads));
  json_put(&root, "predictions", predictions);
  json_put(&root, "reference",
           c->options->predict ? json_null() : reference_entry(&c->reference));
  json_put(&root, "rows", rows);
  json_put(&root, "fits", fits(c));
  json_put(&root, "status", json_text(c->incomplete ? "incomplete" : "ok"));
  return json_write(root, c->options->json);
}
