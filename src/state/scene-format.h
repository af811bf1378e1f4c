/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The format of a committed scene, for its writer and its reader:

   - a line that names it;
   - the number of patches, the bytes of all that is between here and the hash, the bits of the
     effects that are forced, the bands of the background and the number of wavelengths, as
     words; with daylight or symmetry, for which the line is another one, the numbers of suns,
     of pieces of the sky and of bands of these as well; with symmetry, for which the line is a
     third one, the number of mirrors; with panes all of these, and a fourth line; with a
     continuous sky all of these and its terms, and a fifth line;
   - the background, the wavelengths, the suns, and the pieces with their values, in a
   continuous sky also whether they go on from the one before; with symmetry the period and the
   mirrors;
   - per patch: whether it has the light of the one before, as a half word; if not, what heat is
     given, the bands of E, ρ and ε, with panes of τ, as words, the heat and their values; the
     ends; the length
     of the name, as a half word, and the name;
   - the hash of the scene in memory, and that of all bytes.

   What commit finds is not written: it follows from the rest, with the same bits. */
#ifndef HR2D_SRC_STATE_SCENE_FORMAT_H
#define HR2D_SRC_STATE_SCENE_FORMAT_H

#define HR2DI_SCENE_TITLE          "libhr2d scene 1\n"
#define HR2DI_SCENE_DAY_TITLE      "libhr2d scene 2\n"
#define HR2DI_SCENE_SYMMETRY_TITLE "libhr2d scene 3\n"
#define HR2DI_SCENE_PANES_TITLE    "libhr2d scene 4\n"
#define HR2DI_SCENE_SKY_TITLE      "libhr2d scene 5\n"

enum {
  HR2DI_SCENE_TITLE_BYTES = sizeof HR2DI_SCENE_TITLE - 1,
  HR2DI_SCENE_HEAD_WORDS = 5,
  HR2DI_SCENE_DAY_WORDS = 3,
  HR2DI_SCENE_SYMMETRY_WORDS = 1,
  HR2DI_SCENE_SKY_WORDS = 1,
  HR2DI_SCENE_SUN_DOUBLES = 3,
  HR2DI_SCENE_PERIOD_DOUBLES = 2,
  HR2DI_SCENE_MIRROR_DOUBLES = 4
};

#endif
