/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The file of --state: what a run in stages has reached, to go on from. */
#ifndef HR2D_TOOLS_RUN_STATE_H
#define HR2D_TOOLS_RUN_STATE_H

#include "run/run.h"

/* Takes up the state in the file of --state, if there is one.  Returns 0, or EXIT_FAILED after
   complaining. */
int state_load(run *r);

/* Writes what the run has reached into that file, if one is wanted; as state_load(). */
int state_save(run *r);

/* After a failure: says where what was reached is, if it is anywhere. */
void state_mention(const run *r);

#endif
