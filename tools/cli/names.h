/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The names of the methods of `hr2d cost`, and of the quantities in its chart. */
#ifndef HR2D_TOOLS_CLI_NAMES_H
#define HR2D_TOOLS_CLI_NAMES_H

#include "cli/options.h"

extern const char *const name_of_method[METHOD_COUNT];
extern const char *const name_of_against[AGAINST_COUNT];

#endif
