/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Words of the command line to options; what contradicts itself is refused. */
#include "options.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "complain.h"
#include "numbers.h"
#include "suffix.h"

enum { MAX_LEVEL = 1000, MAX_THREADS = 1024, MAX_STEPS = 10000 };

enum {
  HELP = 256,
  VERSION,
  QUIET,
  ORACLE,
  EPS,
  VARIANT,
  MULTIGRID,
  LEVEL,
  LINKS,
  ELEMENTS,
  THREADS,
  NO_CLOSURE,
  AT,
  JSON,
  CSV,
  DRAW,
  LINKS_OF,
  LINK_LEVEL,
  LINK_PARENTS,
  PLOT,
  PLOT_LOG,
  RESUME,
  FROM,
  TO,
  STEPS
};

static const struct option names[] = {{"help", no_argument, NULL, HELP},
                                      {"version", no_argument, NULL, VERSION},
                                      {"quiet", no_argument, NULL, QUIET},
                                      {"oracle", required_argument, NULL, ORACLE},
                                      {"eps", required_argument, NULL, EPS},
                                      {"variant", required_argument, NULL, VARIANT},
                                      {"multigrid", required_argument, NULL, MULTIGRID},
                                      {"max-level", required_argument, NULL, LEVEL},
                                      {"max-links", required_argument, NULL, LINKS},
                                      {"max-elements", required_argument, NULL, ELEMENTS},
                                      {"threads", required_argument, NULL, THREADS},
                                      {"no-closure", no_argument, NULL, NO_CLOSURE},
                                      {"at", required_argument, NULL, AT},
                                      {"json", required_argument, NULL, JSON},
                                      {"csv", required_argument, NULL, CSV},
                                      {"draw", required_argument, NULL, DRAW},
                                      {"links-of", required_argument, NULL, LINKS_OF},
                                      {"link-level", required_argument, NULL, LINK_LEVEL},
                                      {"link-parents", no_argument, NULL, LINK_PARENTS},
                                      {"plot", required_argument, NULL, PLOT},
                                      {"plot-log", no_argument, NULL, PLOT_LOG},
                                      {"resume", no_argument, NULL, RESUME},
                                      {"from", required_argument, NULL, FROM},
                                      {"to", required_argument, NULL, TO},
                                      {"steps", required_argument, NULL, STEPS},
                                      {NULL, 0, NULL, 0}};

/* The commands an option belongs to. */
static int belongs(int id) {
  switch (id) {
  case HELP:
  case VERSION:
    return INFO | SOLVE | STUDY | PAIR;
  case ORACLE:
    return SOLVE | STUDY | PAIR;
  case QUIET:
  case JSON:
    return INFO | SOLVE | STUDY;
  case VARIANT:
  case LEVEL:
  case LINKS:
  case ELEMENTS:
  case THREADS:
  case CSV:
    return SOLVE | STUDY;
  case PLOT:
  case PLOT_LOG:
  case RESUME:
  case FROM:
  case TO:
  case STEPS:
    return STUDY;
  default:
    return SOLVE;
  }
}

static int read_positive(const char *option, const char *text, double *value) {
  if (read_real(text, value) || *value <= 0)
    return usage_error("--%s: '%s' is not a number greater than 0", option, text);
  return 0;
}

static int read_range(const char *option, const char *text, uint64_t least, uint64_t most,
                      uint64_t *value) {
  if (read_count(text, most, value) || *value < least)
    return usage_error("--%s: '%s' is not a whole number from %llu to %llu", option, text,
                       (unsigned long long)least, (unsigned long long)most);
  return 0;
}

static int read_unsigned(const char *option, const char *text, unsigned least, unsigned most,
                         unsigned *value) {
  uint64_t n = 0;
  if (read_range(option, text, least, most, &n)) return EXIT_USAGE;
  *value = (unsigned)n;
  return 0;
}

/* The last colon separates, because names may contain others. */
static int read_place(const char *option, char *text, place *p) {
  char *colon = strrchr(text, ':');
  if (!colon || colon == text) return usage_error("--%s: '%s' is not PATCH:T", option, text);
  if (read_real(colon + 1, &p->t) || p->t < 0 || p->t > 1)
    return usage_error("--%s: '%s' does not end in a number from 0 to 1", option, text);
  *colon = '\0';
  p->patch = text;
  return 0;
}

static int read_multigrid(char *text, options *o) {
  char *colon = strchr(text, ':');
  if (!colon) return usage_error("--multigrid: '%s' is not FROM:RATIO", text);
  *colon = '\0';
  if (read_positive("multigrid", text, &o->multigrid_from)) return EXIT_USAGE;
  if (read_real(colon + 1, &o->multigrid_ratio) || o->multigrid_ratio < 0.01 ||
      o->multigrid_ratio > 0.99)
    return usage_error("--multigrid: the ratio '%s' is not a number from 0.01 to 0.99",
                       colon + 1);
  return 0;
}

/* Names those oracles that the library has. */
static int read_oracle(const char *text, options *o) {
  static const char *const known[] = {"size", "size2", "bf", "l1", "l1-grid"};
  char list[64] = "";
  o->oracle = hr2d_oracle_find(text);
  if (o->oracle) return 0;
  for (size_t k = 0, used = 0; k < sizeof known / sizeof *known; k++)
    if (hr2d_oracle_find(known[k]))
      used +=
          (size_t)snprintf(list + used, sizeof list - used, "%s%s", k ? ", " : "", known[k]);
  return usage_error("--oracle: '%s' is none of %s", text, list);
}

static int read_variant(const char *text, options *o) {
  o->policy = hr2d_policy_find(text);
  return o->policy ? 0 : usage_error("--variant: '%s' is neither original nor modified", text);
}

static int read_picture(const char *option, const char *text, const char **path) {
  *path = text;
  if (suffix_of(text) == SUFFIX_OTHER)
    return usage_error("--%s: '%s' does not end in .svg, .png or .pdf", option, text);
  return 0;
}

static int read_path(const char *option, const char *text, const char **path) {
  *path = text;
  return *text ? 0 : usage_error("--%s: the file name is empty", option);
}

static int read_option(int id, char *text, options *o) {
  switch (id) {
  case HELP:
    o->help = 1;
    return 0;
  case VERSION:
    o->version = 1;
    return 0;
  case QUIET:
    o->quiet = 1;
    return 0;
  case ORACLE:
    return read_oracle(text, o);
  case VARIANT:
    return read_variant(text, o);
  case MULTIGRID:
    return read_multigrid(text, o);
  case EPS:
    return read_positive("eps", text, &o->epsilon);
  case FROM:
    return read_positive("from", text, &o->from);
  case TO:
    return read_positive("to", text, &o->to);
  case STEPS:
    return read_unsigned("steps", text, 2, MAX_STEPS, &o->steps);
  case LEVEL:
    return read_unsigned("max-level", text, 0, MAX_LEVEL, &o->max_level);
  case THREADS:
    return read_unsigned("threads", text, 0, MAX_THREADS, &o->threads);
  case NO_CLOSURE:
    o->closure = 0;
    return 0;
  case LINKS:
    return read_range("max-links", text, 1, UINT64_MAX, &o->max_links);
  case ELEMENTS:
    return read_range("max-elements", text, 1, UINT64_MAX, &o->max_elements);
  case AT:
    return read_place("at", text, &o->at[o->at_count++]);
  case LINKS_OF:
    return read_place("links-of", text, &o->links_of);
  case LINK_LEVEL:
    o->one_level = 1;
    return read_unsigned("link-level", text, 0, MAX_LEVEL, &o->link_level);
  case LINK_PARENTS:
    o->link_parents = 1;
    return 0;
  case PLOT_LOG:
    o->plot_log = 1;
    return 0;
  case RESUME:
    o->resume = 1;
    return 0;
  case JSON:
    return read_path("json", text, &o->json);
  case CSV:
    return read_path("csv", text, &o->csv);
  case DRAW:
    return read_picture("draw", text, &o->draw);
  case PLOT:
    return read_picture("plot", text, &o->plot);
  default:
    return EXIT_USAGE;
  }
}

int to_stdout(const char *path) {
  return path && !strcmp(path, "-");
}

static int check(options *o) {
  const char *outputs[] = {o->json, o->csv, o->draw, o->plot};
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < i; j++)
      if (outputs[i] && outputs[j] && !strcmp(outputs[i], outputs[j]))
        return usage_error("two outputs go to '%s'", outputs[i]);
  if (o->links_of.patch && !o->draw) return usage_error("--links-of needs --draw");
  if (o->one_level && !o->links_of.patch) return usage_error("--link-level needs --links-of");
  if (o->link_parents && !o->link_level)
    return usage_error("--link-parents needs --link-level with at least 1");
  if (o->link_parents && o->policy != hr2d_policy_modified())
    return usage_error("--link-parents needs --variant modified");
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

static int read_command(const char *word, int *command) {
  static const struct {
    const char *name;
    int bit;
  } commands[] = {{"info", INFO}, {"solve", SOLVE}, {"study", STUDY}, {"pair", PAIR}};
  for (size_t k = 0; k < sizeof commands / sizeof *commands; k++)
    if (!strcmp(word, commands[k].name)) {
      *command = commands[k].bit;
      return 0;
    }
  return usage_error("unknown command '%s'", word);
}

static int read_options(int argc, char **argv, options *o) {
  opterr = 0;
  for (int id; (id = getopt_long(argc, argv, ":", names, NULL)) != -1;) {
    const char *word = argv[optind - 1];
    if (id == ':') return usage_error("'%s' lacks its argument", word);
    if (id == '?' && optopt >= HELP) return usage_error("'%s' takes no argument", word);
    if (id == '?' && optopt) return usage_error("unknown option '-%c'", optopt);
    if (id == '?') return usage_error("unknown option '%s'", word);
    if (!(belongs(id) & o->command)) {
      const struct option *option = names;
      while (option->val != id) option++;
      return usage_error("'%s' has no option --%s", argv[0], option->name);
    }
    if (read_option(id, optarg, o)) return EXIT_USAGE;
  }
  return 0;
}

static int read_arguments(int argc, char **argv, options *o) {
  const int wanted = o->command == PAIR ? 0 : 1;
  if (argc - optind < wanted) return usage_error("'%s' needs a SCENE file", argv[0]);
  if (argc - optind > wanted)
    return usage_error("'%s' is one argument too many", argv[optind + wanted]);
  if (wanted) o->scene = argv[optind];
  return 0;
}

/* --help and --version before any command; getopt sees only what follows one. */
static int read_bare(int argc, char **argv, options *o) {
  if (argc < 2) return usage_error("no command given");
  if (argv[1][0] != '-') return read_command(argv[1], &o->command);
  o->help = !strcmp(argv[1], "--help");
  o->version = !strcmp(argv[1], "--version");
  if (!o->help && !o->version) return usage_error("expected a command before '%s'", argv[1]);
  return argc > 2 ? usage_error("'%s' is one argument too many", argv[2]) : 0;
}

int options_read(int argc, char **argv, options *o) {
  const hr2d_refine_options defaults = HR2D_REFINE_OPTIONS_INIT;
  *o = (options){.oracle = hr2d_oracle_size(),
                 .policy = hr2d_policy_original(),
                 .epsilon = defaults.epsilon,
                 .max_level = defaults.max_level,
                 .closure = 1,
                 .steps = 13};
  int status = read_bare(argc, argv, o);
  if (status || o->help || o->version) return status;
  o->at = calloc((size_t)argc, sizeof *o->at);
  if (!o->at) return fail_memory();
  status = read_options(argc - 1, argv + 1, o);
  if (status || o->help || o->version) return status;
  status = read_arguments(argc - 1, argv + 1, o);
  return status ? status : check(o);
}

void options_release(options *o) {
  free(o->at);
  o->at = NULL;
}
