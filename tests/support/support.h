/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The headers that nearly every test program uses. */
#ifndef HR2D_TESTS_SUPPORT_SUPPORT_H
#define HR2D_TESTS_SUPPORT_SUPPORT_H

#include <check.h>
#include <hr2d/hr2d.h>
#include <stdio.h>

#include "support/links.h"
#include "support/memory.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/settings.h"
#include "support/suite.h"
#include "support/tables.h"

#endif
