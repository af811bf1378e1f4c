/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What --help and --version print. */
#ifndef HR2D_TOOLS_HELP_H
#define HR2D_TOOLS_HELP_H

#include "cli/options.h"

/* The help of a command, or of the program for 0. */
void print_help(int command);

void print_version(void);

#endif
