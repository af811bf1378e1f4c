/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parser: words of the command line to members of `options`. */
#include "cli/options.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/option-table.h"
#include "output/complain.h"

/* For getopt_long() an option is the number FIRST + k, beyond those of characters. */
enum { FIRST = 256 };

static void list_names(struct option names[MOST_OPTIONS + 1]) {
  const option_entry *x;
  size_t k = 0;
  for (; (x = option_at(k)); k++)
    names[k] = (struct option){x->name, x->argument ? required_argument : no_argument, NULL,
                               FIRST + (int)k};
  names[k] = (struct option){NULL, 0, NULL, 0};
}

static int read_option(const option_entry *x, const char *command, options *o) {
  if (!option_text_of(x, o->command))
    return complain_usage("'%s' has no option --%s", command, x->name);
  return x->read(x->name, optarg, x->range, (char *)o + x->member);
}

static int read_options(int argc, char **argv, options *o, given_options *given) {
  struct option names[MOST_OPTIONS + 1];
  list_names(names);
  opterr = 0;
  for (int id; (id = getopt_long(argc, argv, ":", names, NULL)) != -1;) {
    const char *word = argv[optind - 1];
    if (id == ':') return complain_usage("'%s' lacks its argument", word);
    if (id == '?' && optopt >= FIRST) return complain_usage("'%s' takes no argument", word);
    if (id == '?' && optopt) return complain_usage("unknown option '-%c'", optopt);
    if (id == '?') return complain_usage("unknown option '%s'", word);
    if (read_option(option_at((size_t)(id - FIRST)), argv[0], o)) return EXIT_USAGE;
    given->is[id - FIRST] = 1;
  }
  return 0;
}

static int read_arguments(int argc, char **argv, options *o) {
  const int wanted = o->command == PAIR ? 0 : 1;
  if (argc - optind < wanted) return complain_usage("'%s' needs a SCENE file", argv[0]);
  if (argc - optind > wanted)
    return complain_usage("'%s' is one argument too many", argv[optind + wanted]);
  if (wanted) o->scene = argv[optind];
  return 0;
}

static int read_command(const char *word, options *o) {
  const command_entry *c;
  for (size_t k = 0; (c = command_at(k)); k++)
    if (!strcmp(word, c->name)) {
      o->command = c->command;
      return 0;
    }
  return complain_usage("unknown command '%s'", word);
}

/* --help and --version before any command; getopt sees only the words after one. */
static int read_bare(int argc, char **argv, options *o) {
  if (argc < 2) return complain_usage("no command given");
  if (argv[1][0] != '-') return read_command(argv[1], o);
  o->help = !strcmp(argv[1], "--help");
  o->version = !strcmp(argv[1], "--version");
  if (!o->help && !o->version) return complain_usage("expected a command before '%s'", argv[1]);
  return argc > 2 ? complain_usage("'%s' is one argument too many", argv[2]) : 0;
}

static options make_defaults(void) {
  return (options){.oracle = hr2d_oracle_size(),
                   .policy = hr2d_policy_original(),
                   .epsilon = HR2D_DEFAULT_EPSILON,
                   .max_level = HR2D_DEFAULT_MAX_LEVEL,
                   .order = 1,
                   .steps = 13,
                   .most_seconds = 10,
                   .methods = (1U << METHOD_COUNT) - 1,
                   .against = {{AGAINST_SECONDS}, 1},
                   .link_level = NO_LEVEL,
                   .band = BAND_DEFAULT};
}

int options_read(int argc, char **argv, options *o) {
  given_options given = {{0}};
  *o = make_defaults();
  int status = read_bare(argc, argv, o);
  if (status || o->help || o->version) return status;
  if (o->command == COST) o->threads = 1; /* its own default */
  o->at.items = calloc((size_t)argc, sizeof *o->at.items);
  o->importance.items = calloc((size_t)argc, sizeof *o->importance.items);
  o->beams_of.items = calloc((size_t)argc, sizeof *o->beams_of.items);
  if (!o->at.items || !o->importance.items || !o->beams_of.items) return complain_memory();
  status = read_options(argc - 1, argv + 1, o, &given);
  if (status || o->help || o->version) return status;
  status = read_arguments(argc - 1, argv + 1, o);
  return status ? status : options_check(o, &given);
}

void options_release(options *o) {
  free(o->at.items);
  free(o->importance.items);
  free(o->beams_of.items);
  o->at = o->importance = o->beams_of = (place_list){NULL, 0};
}
