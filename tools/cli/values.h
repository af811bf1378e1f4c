/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an option's argument means.  Each reader returns 0, or EXIT_USAGE after a complaint
   that names the option. */
#ifndef HR2D_TOOLS_CLI_VALUES_H
#define HR2D_TOOLS_CLI_VALUES_H

#include "cli/options.h"

int read_positive(const char *option, const char *text, double *value);
int read_range(const char *option, const char *text, uint64_t least, uint64_t most,
               uint64_t *value);
int read_unsigned(const char *option, const char *text, unsigned least, unsigned most,
                  unsigned *value);

/* PATCH:T and FROM:RATIO, split in place. */
int read_place(const char *option, char *text, place *p);
int read_multigrid(const char *option, char *text, double *from, double *ratio);

/* Names that the library knows. */
int read_oracle(const char *option, const char *text, const hr2d_oracle **oracle);
int read_variant(const char *option, const char *text, const hr2d_policy **policy);
int read_norm(const char *option, const char *text, hr2d_norm *norm);
int read_methods(const char *option, const char *text, const char **methods);
int read_against(const char *option, const char *text, against *quantity, size_t *count);
int read_effect(const char *option, const char *text, unsigned *effects);

/* A file name, for pictures with a suffix that says the format. */
int read_picture(const char *option, const char *text, const char **path);
int read_path(const char *option, const char *text, const char **path);

#endif
