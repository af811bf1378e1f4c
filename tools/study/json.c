/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows and fit of a study as JSON. */
#include "output/json.h"

#include "output/provenance.h"
#include "study/study.h"

static json_t *row_entry(const hr2d_study_row *row) {
  json_t *entry = json_object();
  json_put(&entry, "epsilon", json_number(row->epsilon));
  json_put(&entry, "elements", json_count(row->counts.elements));
  json_put(&entry, "leaves", json_count(row->counts.leaves));
  json_put(&entry, "links", json_count(row->counts.links));
  json_put(&entry, "oracle_calls", json_count(row->counts.oracle_calls));
  json_put(&entry, "seconds", json_number(row->seconds));
  return entry;
}

static json_t *fit_entry(const hr2d_study_fit *fit) {
  json_t *entry = json_object();
  json_put(&entry, "a", json_number(fit->a));
  json_put(&entry, "b", json_number(fit->b));
  json_put(&entry, "c", json_number(fit->c));
  json_put(&entry, "r2", json_number(fit->r2));
  json_put(&entry, "slope", json_number(fit->slope));
  return entry;
}

static json_t *terms_entry(const hr2d_study_term term[STUDY_TERMS]) {
  json_t *terms = json_array();
  for (int k = 0; k < STUDY_TERMS; k++) {
    if (term[k].factor == 0) continue;
    json_t *entry = json_object();
    json_put(&entry, "factor", json_number(term[k].factor));
    json_put(&entry, "power", json_number(term[k].power));
    json_put(&entry, "error", json_number(term[k].error));
    json_push(&terms, entry);
  }
  return terms;
}

static json_t *law_entry(const hr2d_study_constants *law) {
  json_t *entry = json_object();
  json_put(&entry, "period", json_number(law->period));
  json_put(&entry, "links", terms_entry(law->links));
  json_put(&entry, "elements", terms_entry(law->elements));
  return entry;
}

int study_write_json(const study *s) {
  const options *o = s->options;
  json_t *root = json_object(), *rows = json_array();
  for (size_t k = 0; k < s->count; k++) json_push(&rows, row_entry(&s->rows[k]));
  json_put(&root, "scene", json_text(o->scene));
  json_put(&root, "provenance", provenance_json());
  json_put(&root, "cuts", json_count(s->cuts));
  json_put(&root, "oracle", json_text(o->oracle->name));
  json_put(&root, "variant", json_text(o->policy->name));
  json_put(&root, "rows", rows);
  json_put(&root, "fit", s->fitted ? fit_entry(&s->fit) : json_null());
  if (s->lawful) json_put(&root, "law", law_entry(&s->law));
  json_put(&root, "status", json_text(s->complete ? "ok" : "incomplete"));
  return json_write(root, o->json);
}
