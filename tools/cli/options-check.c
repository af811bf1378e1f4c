/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options that contradict each other, or need another one. */
#include <string.h>

#include "cli/option-table.h"
#include "output/complain.h"
#include "output/output.h"

/* The name of the first option that was given and has this rule, or NULL. */
static const char *first_given(const given_options *given, unsigned rule) {
  const option_entry *x;
  for (size_t k = 0; (x = option_at(k)); k++)
    if (given->is[k] && x->rules & rule) return x->name;
  return NULL;
}

static int is_given(const given_options *given, const char *name) {
  const option_entry *x;
  for (size_t k = 0; (x = option_at(k)); k++)
    if (!strcmp(x->name, name)) return given->is[k];
  return 0;
}

/* The file of an output; NULL: it is not given, or the option is no output. */
static const char *output_of(const options *o, const option_entry *x) {
  const void *member = (const char *)o + x->member;
  return x->rules & IS_OUTPUT ? *(const char *const *)member : NULL;
}

/* An output that replaces an input would be found out when it is too late. */
static int check_inputs(const options *o, const char *file, const char *name) {
  const char *const input[] = {o->scene, o->points};
  for (size_t k = 0; k < sizeof input / sizeof *input; k++)
    if (input[k] && !output_is_stdout(file) && output_is_same(file, input[k]))
      return complain_usage("--%s %s would replace the input '%s'", name, file, input[k]);
  return 0;
}

static int check_outputs(const options *o) {
  const option_entry *x, *y;
  int status = 0;
  for (size_t i = 0; (x = option_at(i)) && !status; i++) {
    const char *file = output_of(o, x);
    if (file) status = check_inputs(o, file, x->name);
    for (size_t j = 0; j < i && file && !status; j++) {
      y = option_at(j);
      const char *other = output_of(o, y);
      if (other && output_is_same(file, other))
        status = complain_usage("two outputs go to '%s'", file);
    }
  }
  return status;
}

/* A target or a budget leaves no choice of the method. */
static int check_target(const options *o, const given_options *given) {
  const char *chosen = first_given(given, NOT_WITH_TARGET);
  const char *detail = first_given(given, ONLY_WITH_TARGET);
  if (options_targeted(o) && chosen)
    return complain_usage("--%s and --%s exclude each other",
                          o->target_error > 0 ? "target-error" : "time-budget", chosen);
  const char *own = o->enclosure ? first_given(given, NOT_WITH_ENCLOSURE) : NULL;
  if (own) return complain_usage("--enclosure and --%s exclude each other", own);
  if (!options_targeted(o) && detail)
    return complain_usage("--%s needs --target-error or --time-budget", detail);
  if (o->importance.count && o->norm == HR2D_NORM_SUP)
    return complain_usage("--importance is for averages and excludes --norm sup");
  if (o->error && o->no_error)
    return complain_usage("--error and --no-error exclude each other");
  return 0;
}

/* Questions of `cost` that take the place of its comparison. */
static int check_cost(const options *o, const given_options *given) {
  const char *with_predict = o->predict ? first_given(given, NOT_WITH_PREDICT) : NULL;
  const char *with_exponents = o->exponents ? first_given(given, NOT_WITH_EXPONENTS) : NULL;
  if (with_predict)
    return complain_usage("--predict and --%s exclude each other", with_predict);
  if (with_exponents)
    return complain_usage("--exponents and --%s exclude each other", with_exponents);
  return 0;
}

static int check_needs(const given_options *given) {
  const option_entry *x;
  for (size_t k = 0; (x = option_at(k)); k++)
    if (given->is[k] && x->needs && !is_given(given, x->needs))
      return complain_usage("--%s needs --%s", x->name, x->needs);
  return 0;
}

static int check_parents(const options *o) {
  if (!o->link_parents) return 0;
  if (o->link_level == NO_LEVEL || !o->link_level)
    return complain_usage("--link-parents needs --link-level with at least 1");
  if (o->policy != hr2d_policy_modified())
    return complain_usage("--link-parents needs --variant modified");
  return 0;
}

/* What a picture cannot show at once. */
static int check_picture(const options *o) {
  if (o->command == SOLVE && o->box.given && !o->draw)
    return complain_usage("--box needs --draw");
  if (o->log_scale && o->linear_scale)
    return complain_usage("--log and --linear exclude each other");
  if (o->no_fill && o->quantity != QUANTITY_MEAN)
    return complain_usage("--no-fill and --quantity exclude each other");
  if (o->quantity != QUANTITY_MEAN && (o->band == BAND_RGB || o->exposure > 0))
    return complain_usage("true colour is for --quantity mean");
  if ((o->band == BAND_RGB || o->exposure > 0) && (o->log_scale || o->linear_scale))
    return complain_usage("true colour excludes --log and --linear");
  if (o->exposure > 0 && o->band != BAND_RGB && o->band != BAND_DEFAULT)
    return complain_usage("--exposure is for true colour and excludes --band");
  if (o->quantity == QUANTITY_SKY && o->band >= 0)
    return complain_usage("the sky has no --band");
  return 0;
}

int options_check(const options *o, const given_options *given) {
  int status = check_outputs(o);
  if (!status) status = check_target(o, given);
  if (!status) status = check_cost(o, given);
  if (!status) status = check_needs(given);
  if (!status) status = check_parents(o);
  if (!status) status = check_picture(o);
  if (status) return status;
  if (o->resume && (!o->csv || output_is_stdout(o->csv)))
    return complain_usage("--resume needs --csv with a file");
  if (o->group && o->elmer)
    return complain_usage(
        "--group and --elmer exclude each other: Elmer's surfaces are patches");
  if (o->multigrid.ratio > 0 && o->multigrid.from <= o->epsilon)
    return complain_usage("--multigrid: %g is not greater than --eps %g", o->multigrid.from,
                          o->epsilon);
  if (o->points && output_is_stdout(o->points) && output_is_same(OPTIONS_STDIN, o->scene))
    return complain_usage("SCENE and --points cannot both be standard input");
  if (o->points && (o->grid.columns || o->box.given || o->vtk || o->pfm || o->tolerance > 0))
    return complain_usage("--points excludes --grid, --box, --tolerance, --vtk and --pfm");
  if ((o->normal.x != 0 || o->normal.y != 0) && o->tolerance > 0)
    return complain_usage("--normal and --tolerance exclude each other");
  if (o->from > 0 && o->to >= o->from)
    return complain_usage("--from %g is not greater than --to %g", o->from, o->to);
  return 0;
}

int options_check_outputs(const options *o) {
  int status = output_check(o->json);
  if (!status) status = output_check(o->csv);
  if (!status) status = output_check(o->factors);
  if (!status) status = output_check(o->mtx);
  if (!status) status = output_check(o->elmer);
  if (!status) status = output_check(o->moose);
  if (!status) status = output_check(o->vtk);
  if (!status) status = output_check(o->pfm);
  if (!status) status = output_check(o->state);
  if (!status) status = output_check(o->draw);
  if (!status) status = output_check(o->tiles);
  if (!status) status = output_check(o->watch);
  return status ? status : output_check(o->plot);
}

int options_want_table(const options *o) {
  return !o->quiet && !output_is_stdout(o->json) && !output_is_stdout(o->csv) &&
         !output_is_stdout(o->factors) && !output_is_stdout(o->mtx) &&
         !output_is_stdout(o->elmer) && !output_is_stdout(o->moose) &&
         !output_is_stdout(o->vtk) && !output_is_stdout(o->pfm);
}
