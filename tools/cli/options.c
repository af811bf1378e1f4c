/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parser: words of the command line to members of `options`. */
#include "cli/options.h"

#include <float.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/option-table.h"
#include "cli/suggest.h"
#include "output/complain.h"
#include "output/provenance.h"

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

/* No option begins like `word`, or only a longer one, or several. */
static int refuse_option(const char *word, const options *o) {
  const option_entry *x;
  const size_t dashes = strspn(word, "-");
  suggestion s = suggest_for(word + dashes, strcspn(word + dashes, "="));
  for (size_t k = 0; (x = option_at(k)); k++)
    if (option_text_of(x, o->command)) suggest_offer(&s, x->name);
  return s.best ? complain_usage("unknown option '%s' (did you mean --%s?)", word, s.best)
                : complain_usage("unknown option '%s'", word);
}

/* The option is one of other commands. */
static int refuse_command(const option_entry *x, const char *command) {
  const command_entry *c;
  char others[80] = "";
  for (size_t k = 0; (c = command_at(k)); k++)
    if (option_text_of(x, c->command))
      snprintf(others + strlen(others), sizeof others - strlen(others), "%s%s",
               *others ? ", " : "", c->name);
  return complain_usage("'%s' has no option --%s (of %s)", command, x->name, others);
}

/* Whether the word is the whole name: getopt_long() takes its beginning, too. */
static int is_whole(const char *word, const option_entry *x) {
  const size_t length = strlen(x->name);
  return !strncmp(word + 2, x->name, length) && (!word[2 + length] || word[2 + length] == '=');
}

static int read_option(const option_entry *x, const char *word, const char *command,
                       options *o) {
  if (!is_whole(word, x)) return refuse_option(word, o);
  if (!option_text_of(x, o->command)) return refuse_command(x, command);
  if (!(x->rules & (IS_OUTPUT | NO_PROVENANCE))) provenance_option(x->name, optarg);
  return x->read(x->name, optarg, x->range, (char *)o + x->member);
}

static int read_options(int argc, char **argv, options *o, given_options *given) {
  struct option names[MOST_OPTIONS + 1];
  list_names(names);
  opterr = 0;
  for (int id; (id = getopt_long(argc, argv, ":h", names, NULL)) != -1;) {
    const char *word = argv[optind - 1];
    if (id == 'h') {
      o->help = 1;
      continue;
    }
    if (id == ':') return complain_usage("'%s' lacks its argument", word);
    if (id == '?' && optopt >= FIRST) return complain_usage("'%s' takes no argument", word);
    if (id == '?' && optopt) return complain_usage("unknown option '-%c'", optopt);
    if (id == '?') return refuse_option(word, o);
    if (optarg == word) word = argv[optind - 2];
    if (read_option(option_at((size_t)(id - FIRST)), word, argv[0], o)) return EXIT_USAGE;
    given->is[id - FIRST] = 1;
  }
  return 0;
}

static int read_arguments(int argc, char **argv, options *o) {
  if (o->command == SCHEMA && optind < argc) o->schema = argv[optind++];
  const int wanted = o->command & (PAIR | SCHEMA) ? 0 : 1;
  if (argc - optind < wanted) return complain_usage("'%s' needs a SCENE file", argv[0]);
  if (argc - optind > wanted)
    return complain_usage("'%s' is one argument too many", argv[optind + wanted]);
  if (wanted) o->scene = strcmp(argv[optind], "-") ? argv[optind] : OPTIONS_STDIN;
  return 0;
}

static int read_command(const char *word, options *o) {
  const command_entry *c;
  suggestion s = suggest_for(word, strlen(word));
  for (size_t k = 0; (c = command_at(k)); k++) {
    if (!strcmp(word, c->name)) {
      o->command = c->command;
      complain_about(c->name);
      provenance_begin(c->name);
      return 0;
    }
    suggest_offer(&s, c->name);
  }
  suggest_offer(&s, "help");
  return s.best ? complain_usage("unknown command '%s' (did you mean %s?)", word, s.best)
                : complain_usage("unknown command '%s'", word);
}

/* help, with or without a command, of which help is one, and options before any command; getopt
   sees only the words after one. */
static int read_bare(int argc, char **argv, options *o) {
  if (argc < 2) return complain_usage("no command given");
  const char *word = argv[1];
  const int asks = !strcmp(word, "help");
  if (word[0] != '-' && !asks) return read_command(word, o);
  o->help = asks || !strcmp(word, "--help") || !strcmp(word, "-h");
  o->version = !strcmp(word, "--version");
  if (!o->help && !o->version) return complain_usage("expected a command before '%s'", word);
  if (argc > 2 + asks) return complain_usage("'%s' is one argument too many", argv[2 + asks]);
  return argc > 2 && strcmp(argv[2], "help") ? read_command(argv[2], o) : 0;
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

/* Every pair of patches is a link. */
static void set_enclosure(options *o) {
  o->epsilon = DBL_MAX;
  o->max_level = 0;
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
  if (!status) status = options_check(o, &given);
  if (o->enclosure) set_enclosure(o);
  return status;
}

void options_release(options *o) {
  free(o->at.items);
  free(o->importance.items);
  free(o->beams_of.items);
  provenance_release();
  o->at = o->importance = o->beams_of = (place_list){NULL, 0};
}
