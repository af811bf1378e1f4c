/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The commands; each returns the exit status. */
#ifndef HR2D_TOOLS_CLI_COMMANDS_H
#define HR2D_TOOLS_CLI_COMMANDS_H

#include "cli/options.h"

int info_command(const options *o);
int solve_command(const options *o);
int study_command(const options *o);
int cost_command(const options *o);
int factors_command(const options *o);
int pair_command(const options *o);

#endif
