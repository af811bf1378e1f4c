/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A warning with its text, given to the visitor. */
#include <stdarg.h>
#include <stdio.h>

#include "lint/lint-impl.h"

hr2d_status hr2di_lint_warn(const hr2di_lint *lint, hr2d_warning warning, const char *format,
                            ...) {
  hr2di_message whole, readable;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(whole.text, sizeof whole.text, format, arguments);
  va_end(arguments);
  hr2di_message_fail(&readable, HR2D_OK, "%s", whole.text);
  warning.struct_size = sizeof warning;
  warning.text = readable.text;
  return lint->warn(lint->ctx, &warning);
}
