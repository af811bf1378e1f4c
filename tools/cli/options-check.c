/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options that contradict each other, or need another one. */
#include <string.h>

#include "cli/options.h"
#include "output/complain.h"

static int check_outputs(const options *o) {
  const char *outputs[] = {o->json, o->csv, o->draw, o->plot, o->state};
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < i; j++)
      if (outputs[i] && outputs[j] && !strcmp(outputs[i], outputs[j]))
        return usage_error("two outputs go to '%s'", outputs[i]);
  return 0;
}

/* A target or a budget leaves nothing to choose of how to solve. */
static int check_target(const options *o, uint64_t given) {
  static const struct {
    uint64_t bit;
    const char *name;
  } choice[] = {{GIVEN(ORACLE), "oracle"},
                {GIVEN(EPS), "eps"},
                {GIVEN(VARIANT), "variant"},
                {GIVEN(MULTIGRID), "multigrid"},
                {GIVEN(ORDER), "order"},
                {GIVEN(LEVEL), "max-level"},
                {GIVEN(NO_CLOSURE), "no-closure"},
                {GIVEN(NO_ERROR), "no-error"},
                {GIVEN(STATE), "state"}};
  const char *target = o->target_error > 0 ? "target-error" : "time-budget";
  for (size_t k = 0; is_targeted(o) && k < sizeof choice / sizeof *choice; k++)
    if (given & choice[k].bit)
      return usage_error("--%s and --%s exclude each other", target, choice[k].name);
  if (!is_targeted(o) && given & (GIVEN(NORM) | GIVEN(IMPORTANCE)))
    return usage_error("--%s needs --target-error or --time-budget",
                       given & GIVEN(NORM) ? "norm" : "importance");
  if (given & GIVEN(IMPORTANCE) && o->norm == HR2D_NORM_SUP)
    return usage_error("--importance is for averages and excludes --norm sup");
  if (o->error && o->no_error) return usage_error("--error and --no-error exclude each other");
  return 0;
}

static int check_links(const options *o) {
  if (o->links_of.patch && !o->draw) return usage_error("--links-of needs --draw");
  if (o->one_level && !o->links_of.patch) return usage_error("--link-level needs --links-of");
  if (o->link_parents && !o->link_level)
    return usage_error("--link-parents needs --link-level with at least 1");
  if (o->link_parents && o->policy != hr2d_policy_modified())
    return usage_error("--link-parents needs --variant modified");
  return 0;
}

static int check_cost(const options *o, uint64_t given) {
  static const struct {
    uint64_t bit;
    const char *name;
  } measured[] = {{GIVEN(CSV), "csv"},
                  {GIVEN(PLOT), "plot"},
                  {GIVEN(METHODS), "methods"},
                  {GIVEN(LEVEL), "max-level"},
                  {GIVEN(MAX_SECONDS), "max-seconds"}};
  for (size_t k = 0; o->predict && k < sizeof measured / sizeof *measured; k++)
    if (given & measured[k].bit)
      return usage_error("--predict and --%s exclude each other", measured[k].name);
  if (given & GIVEN(AGAINST) && !o->plot) return usage_error("--against needs --plot");
  return 0;
}

int options_check(const options *o, uint64_t given) {
  int status = check_outputs(o);
  if (!status) status = check_target(o, given);
  if (!status) status = check_links(o);
  if (!status) status = check_cost(o, given);
  if (status) return status;
  if (o->plot_log && !o->plot) return usage_error("--plot-log needs --plot");
  if (o->resume && (!o->csv || to_stdout(o->csv)))
    return usage_error("--resume needs --csv with a file");
  if (o->multigrid_ratio > 0 && o->multigrid_from <= o->epsilon)
    return usage_error("--multigrid: %g is not greater than --eps %g", o->multigrid_from,
                       o->epsilon);
  if (o->from > 0 && o->to >= o->from)
    return usage_error("--from %g is not greater than --to %g", o->from, o->to);
  return 0;
}
