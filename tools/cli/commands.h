/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The commands and their help. */
#ifndef HR2D_TOOLS_CLI_COMMANDS_H
#define HR2D_TOOLS_CLI_COMMANDS_H

#include <stddef.h>

#include "cli/options.h"

typedef struct command_entry {
  const char *name;
  int command;       /* its bit */
  const char *input; /* in the help of the program */
  const char *usage; /* in its own help, all words after its name */
  const char *summary;
  const char *description;
  const char *method_heading; /* of its GROUP_METHOD in --help; NULL: none */
  const char *examples;       /* lines as they are typed */
} command_entry;

/* The k-th command, or NULL behind the last. */
const command_entry *command_at(size_t k);

/* Each returns the exit status. */
int info_command(const options *o);
int solve_command(const options *o);
int study_command(const options *o);
int cost_command(const options *o);
int factors_command(const options *o);
int field_command(const options *o);
int pair_command(const options *o);
int schema_command(const options *o);

#endif
