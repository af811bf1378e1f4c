/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Climbs: a (1+1) evolution over the genes of a family and the target.  What grows is an error,
   divided by what is stated for it. */
#ifndef HR2D_TESTS_ADVERSARY_CLIMB_H
#define HR2D_TESTS_ADVERSARY_CLIMB_H

typedef struct adv_climbing {
  unsigned long seed;        /* of the first climb of each family; each next has the next */
  unsigned long evaluations; /* of each family */
  double seconds;            /* for all families; 0: no limit */
  double stop;               /* seconds of the processor's time that a solve may take */
  double error;              /* the target; 0: it is drawn and evolves */
  double allow;              /* errors may be so many times what is stated */
  int norm;                  /* −1: drawn */
  const char *families;      /* separated by commas; NULL: all */
  const char *corruption;    /* see adv_corrupt() */
  const char *folder;        /* where scenes with violations are written; NULL: nowhere */
} adv_climbing;

/* Climbs and prints a table; returns whether an error was above what is allowed. */
int adv_climb(const adv_climbing *settings);

#endif
