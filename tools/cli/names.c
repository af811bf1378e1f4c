/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/names.h"

const char *const name_of_method[METHOD_COUNT] = {[METHOD_SIZE] = "size",
                                                  [METHOD_SIZE2] = "size2",
                                                  [METHOD_BF] = "bf",
                                                  [METHOD_L1] = "l1",
                                                  [METHOD_L1_GRID] = "l1-grid",
                                                  [METHOD_BOUNDS] = "bounds",
                                                  [METHOD_MULTIGRID] = "multigrid",
                                                  [METHOD_ORDER_2] = "order-2",
                                                  [METHOD_ORDER_4] = "order-4",
                                                  [METHOD_ORDER_8] = "order-8",
                                                  [METHOD_ORDER_16] = "order-16",
                                                  [METHOD_AUTO] = "auto",
                                                  [METHOD_AUTO_SOLVE] = "auto-solve",
                                                  [METHOD_FACTORS] = "factors"};

const char *const name_of_against[AGAINST_COUNT] = {
    [AGAINST_SECONDS] = "seconds", [AGAINST_LINKS] = "links", [AGAINST_BYTES] = "bytes"};
