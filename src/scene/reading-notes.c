/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/reading-notes.h"

#include <string.h>

#include "base/message.h"

void hr2di_notes_add(hr2di_notes *notes, hr2d_warning_code code, const char *key,
                     const char *place, const char *advice) {
  hr2di_note *note = notes->note, *const end = note + notes->count;
  char cut[sizeof note->key];
  hr2di_message_copy(cut, sizeof cut, key);
  while (note < end && (note->code != code || strcmp(note->key, cut) != 0)) note++;
  if (note == end) {
    if (notes->count == HR2DI_MOST_NOTES) {
      notes->dropped++;
      return;
    }
    notes->count++;
    *note = (hr2di_note){.code = code, .advice = advice};
    memcpy(note->key, cut, sizeof cut);
  }
  note->count++;
  if (note->places < HR2DI_NOTE_PLACES &&
      (note->places == 0 || strcmp(note->place[note->places - 1], place) != 0))
    hr2di_message_copy(note->place[note->places++], sizeof *note->place, place);
}
