/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/warnings.h"

#include <math.h>
#include <stdio.h>

#include "output/complain.h"
#include "output/progress.h"

/* Lines for each code; the rest is counted. */
enum { MOST_LINES = 5 };

typedef struct finder {
  const options *o;
  const hr2d_scene *scene;
  warnings *w;
  int loud;
  double narrowest[HR2D_WARNING_COUNT], widest[HR2D_WARNING_COUNT]; /* of gaps, by code */
} finder;

static json_t *entry(const hr2d_scene *scene, const hr2d_warning *x) {
  json_t *object = json_object(), *patches = json_array();
  for (size_t k = 0; k < x->patches; k++) json_push(&patches, json_patch(scene, x->patch[k]));
  json_put(&object, "code", json_text(hr2d_warning_name(x->code)));
  json_put(&object, "patches", patches);
  json_put(&object, "at",
           x->gap > 0 ? json_numbers((double[]){x->at.x, x->at.y}, 2) : json_null());
  json_put(&object, "gap", x->gap > 0 ? json_number(x->gap) : json_null());
  json_put(&object, "text", json_text(x->text));
  return object;
}

static hr2d_status take(void *ctx, const hr2d_warning *x) {
  finder *f = ctx;
  if (x->gap > 0 && !(f->narrowest[x->code] <= x->gap && f->widest[x->code] > 0))
    f->narrowest[x->code] = x->gap;
  f->widest[x->code] = fmax(f->widest[x->code], x->gap);
  json_push(&f->w->list, entry(f->scene, x));
  if (f->w->count[x->code]++ < MOST_LINES && f->loud)
    complain(f->o->scene, "warning: %s", x->text);
  return HR2D_OK;
}

/* Gaps have their range: who chooses a tolerance for all has to know it. */
static void tell_rest(const finder *f, hr2d_warning_code code) {
  char range[64] = "";
  if (f->widest[code] > 0)
    snprintf(range, sizeof range, ", in all from %.2g to %.2g wide", f->narrowest[code],
             f->widest[code]);
  complain(f->o->scene, "warning: %zu more of \"%s\"%s; --json has them all",
           f->w->count[code] - MOST_LINES, hr2d_warning_name(code), range);
}

static size_t count_rest(const finder *f) {
  size_t count = 0;
  for (int code = 0; code < HR2D_WARNING_COUNT; code++) {
    const size_t of_code = f->w->count[code];
    count += of_code;
    if (of_code > MOST_LINES && f->loud) tell_rest(f, (hr2d_warning_code)code);
  }
  return count;
}

/* JSON has it in the place of the warnings that are missing. */
static int tell_late(const finder *f) {
  static const char text[] = "the time does not suffice to look for all warnings";
  json_t *object = json_object();
  json_put(&object, "code", json_text("unfinished"));
  json_put(&object, "patches", json_array());
  json_put(&object, "at", json_null());
  json_put(&object, "gap", json_null());
  json_put(&object, "text", json_text(text));
  json_push(&f->w->list, object);
  if (f->loud) complain(f->o->scene, "%s: hr2d info shows them", text);
  return f->o->strict ? EXIT_FAILED : EXIT_DONE;
}

int warnings_find(const options *o, const hr2d_scene *scene, double deadline, warnings *w) {
  progress p;
  *w = (warnings){.list = json_array()};
  finder f = {.o = o, .scene = scene, .w = w, .loud = !o->quiet || o->strict};
  hr2d_lint_options lint = HR2D_LINT_OPTIONS_INIT;
  progress_start(&p, 1);
  p.deadline = deadline;
  lint.progress = progress_show;
  lint.progress_ctx = &p;
  const hr2d_status status = hr2d_scene_lint(scene, take, &f, &lint);
  progress_clear(&p);
  progress_end();
  const int is_late = status == HR2D_STOPPED && p.late;
  if (status && !is_late) return complain_call(o->scene, "", status);
  const size_t count = count_rest(&f);
  const int late = is_late ? tell_late(&f) : EXIT_DONE;
  if (!count || !o->strict) return late;
  return complain(o->scene, "%zu warning%s with --strict", count, count == 1 ? "" : "s");
}

void warnings_release(warnings *w) {
  json_decref(w->list);
  w->list = NULL;
}
