/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A warning with its text, given to the visitor. */
#include <stdarg.h>

#include "lint/lint-impl.h"

hr2d_status hr2di_lint_warn(const hr2di_lint *lint, hr2d_warning warning, const char *format,
                            ...) {
  hr2di_message message;
  va_list arguments;
  va_start(arguments, format);
  hr2di_message_write(&message, format, arguments);
  va_end(arguments);
  warning.struct_size = sizeof warning;
  warning.text = message.text;
  return lint->warn(lint->ctx, &warning);
}
