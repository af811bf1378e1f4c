/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scene files, and patches by index or name. */
#include "cli/scene.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/numbers.h"
#include "cli/warnings.h"
#include "output/clock.h"
#include "output/complain.h"
#include "output/printable.h"
#include "output/progress.h"
#include "output/provenance.h"

/* What may be the reason why a scene is refused. */
static void warn_of_refused(const options *o, const hr2d_scene *scene, double deadline) {
  warnings w;
  if (!(o->command & (INFO | SOLVE))) return;
  warnings_find(o, scene, deadline, &w);
  warnings_release(&w);
}

static void tell_snapped(const options *o, const hr2d_snap_report *r) {
  complain(o->scene,
           "snapped: %zu ends joined, %zu feet moved, %zu slivers and %zu copies dropped, %zu "
           "cuts made",
           r->ends, r->feet, r->slivers, r->copies, r->cuts);
  if (r->farthest > 0)
    complain(o->scene, "snapped: farthest by %.3g, from (%.9g, %.9g) to (%.9g, %.9g)",
             r->farthest, r->from.x, r->from.y, r->to.x, r->to.y);
}

/* The file as bytes, which the caller frees, also if it fails; a pipe can be read once only. */
typedef struct file_bytes {
  char *at;
  size_t size;
  const char *trouble; /* "" but for HR2D_EIO */
} file_bytes;

static hr2d_status read_stream(FILE *stream, progress *p, file_bytes *to) {
  const hr2d_progress now = {.phase = "read"};
  for (size_t room = 0; !feof(stream);) {
    if (progress_show(p, &now)) return HR2D_STOPPED;
    if (to->size == room) {
      room = room ? 2 * room : 65536;
      char *more = room > to->size ? realloc(to->at, room) : NULL;
      if (!more) return HR2D_ENOMEM;
      to->at = more;
    }
    to->size += fread(to->at + to->size, 1, room - to->size, stream);
    if (ferror(stream)) {
      to->trouble = "cannot read";
      return HR2D_EIO;
    }
  }
  return HR2D_OK;
}

static hr2d_status read_file(const char *path, progress *p, file_bytes *to) {
  FILE *stream = fopen(path, "rb");
  to->trouble = "cannot open";
  if (!stream) return HR2D_EIO;
  to->trouble = "";
  setvbuf(stream, NULL, _IONBF, 0); /* a limit of time is asked for between blocks */
  const hr2d_status status = read_stream(stream, p, to);
  const int reason = errno;
  fclose(stream);
  errno = reason;
  return status;
}

/* The bytes are hashed before a parser sees them. */
static hr2d_status read_scene(hr2d_scene *scene, const options *o, progress *p) {
  file_bytes file = {0};
  hr2d_status status = read_file(o->scene, p, &file);
  if (status == HR2D_EIO) complain(o->scene, "%s: %s", file.trouble, strerror(errno));
  if (!status) {
    provenance_scene(strcmp(o->scene, OPTIONS_STDIN) ? o->scene : "-", file.at, file.size);
    status = hr2d_scene_parse(scene, file.at, file.size);
  }
  free(file.at);
  return status;
}

int scene_load(const options *o, unsigned force, hr2d_scene **scene, size_t *cuts) {
  const double deadline = o->time_budget > 0 ? clock_seconds() + o->time_budget : 0;
  progress p = {.deadline = deadline};
  *scene = NULL;
  *cuts = 0;
  hr2d_status status = hr2d_scene_create(NULL, scene);
  if (!status) hr2d_scene_set_progress(*scene, progress_show, &p);
  if (!status) status = read_scene(*scene, o, &p);
  /* Not before: a signal that only sets a flag would not end a read that waits for a pipe. */
  if (!status) {
    progress_start(&p, o->quiet);
    p.deadline = deadline;
  }
  hr2d_snap_report snapped = {0};
  if (!status && o->snap > 0) status = hr2d_scene_snap(*scene, o->snap, &snapped);
  if (!status && o->split_crossings) status = hr2d_scene_split_crossings(*scene, cuts);
  for (int e = 0; !status && e < HR2D_EFFECT_COUNT; e++)
    if (force >> e & 1) status = hr2d_scene_force(*scene, (hr2d_effect)e);
  if (!status) status = hr2d_scene_commit(*scene);
  if (*scene) hr2d_scene_set_progress(*scene, NULL, NULL);
  progress_clear(&p);
  progress_end();
  if (o->snap > 0 && !status && !o->quiet) tell_snapped(o, &snapped);
  if (!status) return 0;
  if (status != HR2D_STOPPED && status != HR2D_ENOMEM && *scene && hr2d_scene_patches(*scene))
    warn_of_refused(o, *scene, deadline);
  const int code =
      status == HR2D_EIO ? EXIT_FAILED
      : p.late           ? complain(o->scene, "the time does not suffice to %s the scene",
                          hr2d_scene_patches(*scene) ? "check" : "read")
               : complain_call(o->scene, *scene ? hr2d_scene_message(*scene) : "", status);
  hr2d_scene_destroy(*scene);
  *scene = NULL;
  return code;
}

void scene_print(const options *o, int width, size_t cuts) {
  printf("%-*s", width, "scene");
  printable_put(o->scene, stdout);
  puts("");
  if (o->split_crossings) printf("%-*s%zu cut\n", width, "crossings", cuts);
}

int scene_find_place(const hr2d_scene *scene, const char *option, const place *p,
                     size_t *patch) {
  uint64_t index = 0;
  if (p->patch[strspn(p->patch, "0123456789")] == '\0') {
    if (number_count(p->patch, hr2d_scene_patches(scene) - 1, &index))
      return complain_usage("--%s: the scene has no patch %s, only 0 to %zu", option, p->patch,
                            hr2d_scene_patches(scene) - 1);
    *patch = (size_t)index;
    return 0;
  }
  if (hr2d_scene_find(scene, p->patch, patch))
    return complain_usage("--%s: the scene has no patch called '%s'", option, p->patch);
  return 0;
}

const char *scene_file_name(const options *o) {
  const char *slash = strrchr(o->scene, '/');
  return slash ? slash + 1 : o->scene;
}

double scene_longest_patch(const hr2d_scene *scene) {
  double longest = 0;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    longest = fmax(longest, hr2d_scene_length(scene, k));
  return longest;
}

int scene_has_gas(const hr2d_scene *scene) {
  size_t band = 0;
  while (band < hr2d_scene_bands(scene) && !(hr2d_scene_absorption(scene, 0, band) > 0)) band++;
  return band < hr2d_scene_bands(scene);
}

int scene_complain(const options *o, const hr2d_scene *scene, hr2d_status status) {
  if (status == HR2D_EUNSUPPORTED && scene_has_gas(scene))
    return complain_call(o->scene,
                         "the scene has a gas, \"medium\", through which this version does not "
                         "compute what is asked for",
                         status);
  return complain_call(o->scene, "", status);
}
