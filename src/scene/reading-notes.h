/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What readers of scene files saw and did not use, kept for hr2d_scene_lint().  A note counts
   how often it was made, so that the notes on a file take no more room than this struct. */
#ifndef HR2D_SRC_SCENE_READING_NOTES_H
#define HR2D_SRC_SCENE_READING_NOTES_H

#include <hr2d/lint.h>
#include <stddef.h>

enum { HR2DI_MOST_NOTES = 16, HR2DI_NOTE_PLACES = 3 };

typedef struct hr2di_note {
  hr2d_warning_code code;
  char key[32];                       /* as the file spells it */
  char place[HR2DI_NOTE_PLACES][112]; /* of the first ones */
  const char *advice;                 /* a static string */
  size_t count, places; /* a place counts once, however often a note is made there */
} hr2di_note;

typedef struct hr2di_notes {
  hr2di_note note[HR2DI_MOST_NOTES];
  size_t count, dropped; /* notes that there was no room for */
} hr2di_notes;

/* Notes that are more than there is room for are counted only. */
void hr2di_notes_add(hr2di_notes *notes, hr2d_warning_code code, const char *key,
                     const char *place, const char *advice);

#endif
