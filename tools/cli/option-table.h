/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of the program, each once: the parser, the checks and --help read them here.  A
   new option is one entry in option-table.c, one member of `options`, and an entry in the
   manual page. */
#ifndef HR2D_TOOLS_CLI_OPTION_TABLE_H
#define HR2D_TOOLS_CLI_OPTION_TABLE_H

#include <stddef.h>

#include "cli/options.h"
#include "cli/values.h"

/* The groups of options in --help, in this order. */
typedef enum option_group {
  GROUP_QUESTION, /* what to solve for, to study, to compare */
  GROUP_METHOD,
  GROUP_WORK, /* limits, threads, the scene */
  GROUP_OUTPUT,
  GROUP_COUNT
} option_group;

/* Rules between options, one bit each. */
enum {
  NOT_WITH_TARGET = 1, /* nor with a time budget */
  ONLY_WITH_TARGET = 2,
  NOT_WITH_PREDICT = 4,
  NOT_WITH_EXPONENTS = 8,
  IS_OUTPUT = 16,     /* a file that the program writes; no other output goes there */
  NO_PROVENANCE = 32, /* no number of a result depends on it, as none does on outputs */
  NOT_WITH_ENCLOSURE = 64
};

/* The help of an option for some commands: one or more lines, or NULL if --help does not list
   it. */
typedef struct option_text {
  unsigned commands;
  const char *text;
} option_text;

typedef struct option_entry {
  const char *name;     /* without the dashes */
  const char *argument; /* as help calls it; NULL: there is none */
  option_group group;
  value_reader *read;
  size_t member; /* offset in `options` */
  value_range range;
  option_text help[6]; /* the option belongs to the commands in these */
  const char *needs;   /* the name of another option that must be given; NULL: none */
  unsigned rules;
} option_entry;

enum { MOST_OPTIONS = 96 };

/* The k-th option, or NULL behind the last. */
const option_entry *option_at(size_t k);

/* The help of an option for a command, or NULL if it does not belong to the command. */
const option_text *option_text_of(const option_entry *x, int command);

/* Which options were given, by their numbers in the table. */
typedef struct given_options {
  unsigned char is[MOST_OPTIONS];
} given_options;

/* options-check.c: refuses options that contradict each other, or lack another one.  Returns 0,
   or EXIT_USAGE after an error message. */
int options_check(const options *o, const given_options *given);

#endif
