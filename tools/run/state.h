/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The file of --state: the last stage of a run in stages, from which another run can go on. */
#ifndef HR2D_TOOLS_RUN_STATE_H
#define HR2D_TOOLS_RUN_STATE_H

#include "run/run.h"

/* Reads the state in the file of --state, if there is one.  Returns 0 or EXIT_FAILED. */
int state_load(run *r);

/* Writes the last stage of the run to the file of --state, if that is given.  Returns 0 or
   EXIT_FAILED. */
int state_save(run *r);

/* After a failure: prints which file has the last stage, if any has it. */
void state_mention(const run *r);

#endif
