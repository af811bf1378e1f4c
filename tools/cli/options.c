/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Words of the command line to options. */
#include "cli/options.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "cli/values.h"
#include "output/complain.h"

enum { MAX_LEVEL = 1000, MAX_THREADS = 1024, MAX_STEPS = 10000 };

static const struct option names[] = {{"help", no_argument, NULL, HELP},
                                      {"version", no_argument, NULL, SHOW_VERSION},
                                      {"quiet", no_argument, NULL, QUIET},
                                      {"oracle", required_argument, NULL, ORACLE},
                                      {"eps", required_argument, NULL, EPS},
                                      {"variant", required_argument, NULL, VARIANT},
                                      {"multigrid", required_argument, NULL, MULTIGRID},
                                      {"state", required_argument, NULL, STATE},
                                      {"order", required_argument, NULL, ORDER},
                                      {"target-error", required_argument, NULL, TARGET_ERROR},
                                      {"time-budget", required_argument, NULL, TIME_BUDGET},
                                      {"norm", required_argument, NULL, NORM},
                                      {"importance", required_argument, NULL, IMPORTANCE},
                                      {"error", no_argument, NULL, MEASURE_ERROR},
                                      {"no-error", no_argument, NULL, NO_ERROR},
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
                                      {"methods", required_argument, NULL, METHODS},
                                      {"max-seconds", required_argument, NULL, MAX_SECONDS},
                                      {"against", required_argument, NULL, AGAINST},
                                      {"predict", no_argument, NULL, PREDICT},
                                      {"split-crossings", no_argument, NULL, SPLIT_CROSSINGS},
                                      {"force", required_argument, NULL, FORCE},
                                      {NULL, 0, NULL, 0}};

/* The commands an option belongs to. */
static int belongs(int id) {
  switch (id) {
  case HELP:
  case SHOW_VERSION:
    return INFO | SOLVE | STUDY | COST | FACTORS | PAIR;
  case ORACLE:
    return SOLVE | STUDY | PAIR;
  case QUIET:
  case JSON:
  case SPLIT_CROSSINGS:
  case FORCE:
    return INFO | SOLVE | STUDY | COST | FACTORS;
  case CSV:
  case THREADS:
    return SOLVE | STUDY | COST | FACTORS;
  case LEVEL:
    return SOLVE | STUDY | COST;
  case NO_CLOSURE:
    return SOLVE | COST;
  case VARIANT:
  case LINKS:
  case ELEMENTS:
    return SOLVE | STUDY;
  case PLOT:
    return STUDY | COST;
  case PLOT_LOG:
  case RESUME:
  case FROM:
  case TO:
  case STEPS:
    return STUDY;
  case METHODS:
  case MAX_SECONDS:
  case AGAINST:
  case PREDICT:
    return COST;
  default:
    return SOLVE;
  }
}

static int set_flag(int id, options *o) {
  switch (id) {
  case HELP:
    o->help = 1;
    return 0;
  case SHOW_VERSION:
    o->version = 1;
    return 0;
  case QUIET:
    o->quiet = 1;
    return 0;
  case SPLIT_CROSSINGS:
    o->split_crossings = 1;
    return 0;
  case NO_CLOSURE:
    o->closure = 0;
    return 0;
  case MEASURE_ERROR:
    o->error = 1;
    return 0;
  case NO_ERROR:
    o->no_error = 1;
    return 0;
  case LINK_PARENTS:
    o->link_parents = 1;
    return 0;
  case PLOT_LOG:
    o->plot_log = 1;
    return 0;
  case RESUME:
    o->resume = 1;
    return 0;
  case PREDICT:
    o->predict = 1;
    return 0;
  default:
    return EXIT_USAGE;
  }
}

static int read_number(int id, const char *text, options *o) {
  switch (id) {
  case EPS:
    return read_positive("eps", text, &o->epsilon);
  case FROM:
    return read_positive("from", text, &o->from);
  case TO:
    return read_positive("to", text, &o->to);
  case TARGET_ERROR:
    return read_positive("target-error", text, &o->target_error);
  case TIME_BUDGET:
    return read_positive("time-budget", text, &o->time_budget);
  case MAX_SECONDS:
    return read_positive("max-seconds", text, &o->max_seconds);
  case ORDER:
    return read_unsigned("order", text, 1, HR2D_MAX_ORDER, &o->order);
  case STEPS:
    return read_unsigned("steps", text, 2, MAX_STEPS, &o->steps);
  case LEVEL:
    return read_unsigned("max-level", text, 0, MAX_LEVEL, &o->max_level);
  case THREADS:
    return read_unsigned("threads", text, 0, MAX_THREADS, &o->threads);
  case LINK_LEVEL:
    o->one_level = 1;
    return read_unsigned("link-level", text, 0, MAX_LEVEL, &o->link_level);
  case LINKS:
    return read_range("max-links", text, 1, UINT64_MAX, &o->max_links);
  case ELEMENTS:
    return read_range("max-elements", text, 1, UINT64_MAX, &o->max_elements);
  default:
    return set_flag(id, o);
  }
}

static int read_option(int id, char *text, options *o) {
  switch (id) {
  case ORACLE:
    return read_oracle("oracle", text, &o->oracle);
  case VARIANT:
    return read_variant("variant", text, &o->policy);
  case MULTIGRID:
    return read_multigrid("multigrid", text, &o->multigrid_from, &o->multigrid_ratio);
  case NORM:
    return read_norm("norm", text, &o->norm);
  case IMPORTANCE:
    o->importance = (place){text, 0};
    return *text ? 0 : usage_error("--importance: the name is empty");
  case METHODS:
    return read_methods("methods", text, &o->methods);
  case AGAINST:
    return read_against("against", text, o->against, &o->panels);
  case FORCE:
    return read_effect("force", text, &o->force);
  case AT:
    return read_place("at", text, &o->at[o->at_count++]);
  case LINKS_OF:
    return read_place("links-of", text, &o->links_of);
  case STATE:
    return to_stdout(text) ? usage_error("--state wants a file that can be read back")
                           : read_path("state", text, &o->state);
  case JSON:
    return read_path("json", text, &o->json);
  case CSV:
    return read_path("csv", text, &o->csv);
  case DRAW:
    return read_picture("draw", text, &o->draw);
  case PLOT:
    return read_picture("plot", text, &o->plot);
  default:
    return read_number(id, text, o);
  }
}

int to_stdout(const char *path) {
  return path && !strcmp(path, "-");
}

int is_targeted(const options *o) {
  return o->target_error > 0 || o->time_budget > 0;
}

static int read_command(const char *word, int *command) {
  static const struct {
    const char *name;
    int bit;
  } commands[] = {{"info", INFO}, {"solve", SOLVE},     {"study", STUDY},
                  {"cost", COST}, {"factors", FACTORS}, {"pair", PAIR}};
  for (size_t k = 0; k < sizeof commands / sizeof *commands; k++)
    if (!strcmp(word, commands[k].name)) {
      *command = commands[k].bit;
      return 0;
    }
  return usage_error("unknown command '%s'", word);
}

static int read_options(int argc, char **argv, options *o, uint64_t *given) {
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
    *given |= GIVEN(id);
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
                 .order = 1,
                 .against = {AGAINST_SECONDS},
                 .panels = 1,
                 .max_seconds = 10,
                 .closure = 1,
                 .steps = 13};
  uint64_t given = 0;
  int status = read_bare(argc, argv, o);
  if (status || o->help || o->version) return status;
  o->at = calloc((size_t)argc, sizeof *o->at);
  if (!o->at) return fail_memory();
  status = read_options(argc - 1, argv + 1, o, &given);
  if (status || o->help || o->version) return status;
  status = read_arguments(argc - 1, argv + 1, o);
  if (o->command == COST && !(given & GIVEN(THREADS))) o->threads = 1;
  return status ? status : options_check(o, given);
}

void options_release(options *o) {
  free(o->at);
  o->at = NULL;
}
