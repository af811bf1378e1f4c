/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The texts of --help and --version. */
#ifndef HR2D_TOOLS_CLI_HELP_H
#define HR2D_TOOLS_CLI_HELP_H

/* Prints the help of a command, or that of the program for 0. */
void help_print(int command);

void help_print_version(void);

#endif
