/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The hash SHA-256, as sha256sum(1) prints it. */
#ifndef HR2D_TOOLS_OUTPUT_SHA256_H
#define HR2D_TOOLS_OUTPUT_SHA256_H

#include <stddef.h>

enum { SHA256_TEXT = 65 }; /* 64 hexadecimal digits and their end */

void sha256_text(const void *bytes, size_t size, char text[SHA256_TEXT]);

#endif
