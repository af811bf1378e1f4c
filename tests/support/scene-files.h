/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the suites of the two readers: parses texts, checks the scene, and damages
   texts. */
#ifndef HR2D_TESTS_SUPPORT_SCENE_FILES_H
#define HR2D_TESTS_SUPPORT_SCENE_FILES_H

#include "support/support.h"

/* Parses a copy in a block of exactly that size, so that a sanitizer sees a read beyond it. */
hr2d_status file_parse_bytes(hr2d_scene *scene, const char *text, size_t size);
hr2d_status file_parse(hr2d_scene *scene, const char *text);

/* The scene of a text that must be accepted. */
hr2d_scene *file_parsed(const char *text);

void file_expect_segment(const hr2d_scene *scene, size_t patch, double ax, double ay, double bx,
                         double by);
void file_expect_name(const hr2d_scene *scene, size_t patch, const char *name);

/* Sums over all patches: the vectors from a to b, which add up to 0 in a closed room, and the
   area to their left. */
typedef struct file_outline {
  double x, y, area;
} file_outline;
file_outline file_outline_of(const hr2d_scene *scene);

/* A scene with one patch, and whether a refused text has left it alone. */
hr2d_scene *file_occupied_scene(void);
void file_expect_unchanged(const hr2d_scene *scene);

/* Asserts that a file or a text was refused with this status and with a message that begins
   with the phrase, and that file_occupied_scene() is unchanged. */
void file_expect_refused(const hr2d_scene *scene, const char *name, hr2d_status got,
                         hr2d_status status, const char *phrase);

/* Parses any bytes: either they are refused with a message that begins with `phrase`, and
   nothing changes, or the scene is valid.  Whether they were accepted. */
int file_read_or_refused(const char *text, size_t size, const char *phrase);

/* Overwrites one to four bytes of a good text, half of them with spice, and parses it as above;
   20000 times at a multiplier of 1.  Some of the texts must be accepted, and some refused. */
void file_expect_damage(const char *good, size_t size, const char *spice, size_t spices,
                        const char *phrase);
#define FILE_EXPECT_DAMAGE(good, spice, phrase)                                                \
  file_expect_damage((good), sizeof(good) - 1, (spice), sizeof(spice) - 1, (phrase))

/* Asserts that a patch between any two points keeps every bit of them, 20000 times at a
   multiplier of 1.  write() makes text k from the four coordinates, which it may change. */
void file_expect_bits(void (*write)(char *text, size_t size, int k, double c[4]));

/* Makes a temporary file and returns it open; its path replaces the XXXXXX of `path`. */
FILE *file_temporary(char *path);

/* Reads a scene of `patches` patches with each allocation failing, once and for good: the scene
   stays empty and says why, and reading succeeds when there is memory again.  Returns the
   number of allocations. */
long file_starve(hr2d_status (*read)(hr2d_scene *scene), size_t patches);

#endif
