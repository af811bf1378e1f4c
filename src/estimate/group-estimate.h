/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors of groups of bands, see scene/band-groups.h. */
#ifndef HR2D_SRC_ESTIMATE_GROUP_ESTIMATE_H
#define HR2D_SRC_ESTIMATE_GROUP_ESTIMATE_H

#include "estimate/error-estimate.h"

/* hr2di_error_estimate() for all groups of the links: the largest errors, and divisions as
   often as one group asks for them. */
hr2d_status hr2di_group_estimates(hr2di_graded *answer, const hr2di_resolution *fineness,
                                  const hr2d_target *target, hr2di_error_pair *errors,
                                  hr2di_message *message);

#endif
