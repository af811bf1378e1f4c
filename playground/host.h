/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of the program ask of a machine, where there is none: messages are kept, and
   there are no files. */
#ifndef HR2D_PLAYGROUND_HOST_H
#define HR2D_PLAYGROUND_HOST_H

#include <hr2d/status.h>

/* From now on there is no message. */
void host_forget(void);

/* The first message since then, or "", and the status that it goes with. */
const char *host_message(void);
hr2d_status host_status(void);

#endif
