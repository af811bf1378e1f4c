/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Integrals by a Gauss rule over panels that are halved until halves agree with the whole. */
#ifndef HR2D_SRC_BASE_ADAPTIVE_GAUSS_H
#define HR2D_SRC_BASE_ADAPTIVE_GAUSS_H

#include "base/legendre.h"

typedef double (*hr2di_integrand)(const void *ctx, double x);

/* ∫ f dx from `from` to `to`.  A panel is taken as its two halves where these differ from it by
   no more than `tolerance` times the first estimate of ∫ |f| dx.  Where f is smooth the halves
   are off by much less.  Panels end after HR2DI_ADAPTIVE_DEPTH halvings: what is left then is
   2^-40 of the range. */
enum { HR2DI_ADAPTIVE_DEPTH = 40 };
double hr2di_adaptive_gauss(const hr2di_rule *rule, hr2di_integrand f, const void *ctx,
                            double from, double to, double tolerance);

#endif
