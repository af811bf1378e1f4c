/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The version of the linked library, which may differ from the version of the header. */
#include <hr2d/version.h>

const char *hr2d_version(void) {
  return HR2D_VERSION;
}
