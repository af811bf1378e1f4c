/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a method spends its share of the time. */
#ifndef HR2D_TOOLS_COST_PACE_H
#define HR2D_TOOLS_COST_PACE_H

typedef struct pace {
  double share;  /* seconds that the method may take */
  double spent;  /* by all runs and repeats */
  double last;   /* seconds of the last run */
  double growth; /* from the run before it to the last one, 2 to 16 */
} pace;

/* Before any run. */
pace pace_start(double share);

/* After a run of `once` seconds, `spent` with its repeats. */
void pace_note(pace *p, double once, double spent);

/* Whether the next run is likely to fit. */
int pace_allows(const pace *p);

/* How often a run that took so long is repeated: the shortest of several times is reported. */
int pace_repeats(double seconds);

#endif
