/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A warning with its text, given to the visitor; and the places that it tells. */
#include <stdarg.h>
#include <stdio.h>

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

/* feature 2 ("hall"), feature 5 and 12 more */
hr2di_lint_places hr2di_lint_places_of(const char *const *name, size_t names, size_t count) {
  hr2di_lint_places p = {{0}};
  size_t length = 0;
  const size_t rest = count - names;
  for (size_t k = 0; k < names; k++)
    length += (size_t)snprintf(p.text + length, sizeof p.text - length, "%s%s",
                               !k ? "" : (k + 1 < names || rest ? ", " : " and "), name[k]);
  if (rest) snprintf(p.text + length, sizeof p.text - length, " and %zu more", rest);
  return p;
}

void hr2di_lint_add(hr2di_lint_patches *places, size_t patch) {
  if (places->count < HR2DI_LINT_PLACES) places->patch[places->count] = patch;
  places->count++;
}

hr2di_lint_places hr2di_lint_labels(const hr2d_scene *scene, const hr2di_lint_patches *places) {
  hr2di_label label[HR2DI_LINT_PLACES];
  const char *name[HR2DI_LINT_PLACES];
  size_t k = 0;
  for (; k < places->count && k < HR2DI_LINT_PLACES; k++) {
    label[k] = hr2di_patch_label(scene, places->patch[k]);
    name[k] = label[k].text;
  }
  return hr2di_lint_places_of(name, k, places->count);
}
