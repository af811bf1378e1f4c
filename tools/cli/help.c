/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A screen of help per command, from the tables of commands and options; the manual page has
   more. */
#include "cli/help.h"

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/option-table.h"

/* Where the second column begins. */
enum { COLUMN = 24 };

static void print_general(void) {
  const command_entry *c;
  fputs("Usage: hr2d COMMAND [options]\n"
        "Hierarchical radiosity in the plane.\n"
        "\n",
        stdout);
  for (size_t k = 0; (c = command_at(k)); k++) {
    const int width = printf("  hr2d %-5s %s", c->name, c->input);
    printf("%*s%s\n", COLUMN - width, "", c->summary);
  }
  fputs("\n"
        "SCENE is a GeoJSON file or a .vs2 file of the program View2D; - is standard\n"
        "input.  'hr2d help COMMAND' lists the options of a command, 'hr2d --version'\n"
        "prints the version, 'man hr2d' says more.\n"
        "\n"
        "Exit status: 0; 1 for bad input or a failed solve; 2 for bad usage;\n"
        "130 when interrupted.\n",
        stdout);
}

static void print_option(const option_entry *x, const char *text) {
  int width =
      printf("  --%s%s%s", x->name, x->argument ? " " : "", x->argument ? x->argument : "");
  for (; *text; width = 0) {
    const int size = (int)strcspn(text, "\n");
    printf("%*s%.*s\n", COLUMN - width, "", size, text);
    text += size + (text[size] == '\n');
  }
}

static void print_group(const command_entry *c, option_group group) {
  const option_entry *x;
  int lines = 0;
  for (size_t k = 0; (x = option_at(k)); k++) {
    const option_text *help = option_text_of(x, c->command);
    if (x->group != group || !help || !help->text) continue;
    if (!lines++)
      fputs(group == GROUP_METHOD && c->method_heading ? c->method_heading : "\n", stdout);
    print_option(x, help->text);
  }
}

void help_print(int command) {
  const command_entry *c;
  size_t k = 0;
  while ((c = command_at(k)) && c->command != command) k++;
  if (!c) {
    print_general();
    return;
  }
  printf("Usage: hr2d %s %s\n%s", c->name, c->usage, c->description);
  for (int group = 0; group < GROUP_COUNT; group++) print_group(c, (option_group)group);
  const int single = strchr(c->examples, '\n')[1] == '\0';
  printf("For example:%s%s", single ? "" : "\n", c->examples);
}

void help_print_version(void) {
#ifdef PACKAGE_VERSION
  const char *program = PACKAGE_VERSION;
#else
  const char *program = HR2D_VERSION;
#endif
  printf("hr2d %s (library %s)\n"
         "License GPL-3.0-or-later; there is no warranty, to the extent permitted by law.\n",
         program, hr2d_version());
}
