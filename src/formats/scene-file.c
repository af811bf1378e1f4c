/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads scene files.  The format is recognised from the text itself; a failure leaves the scene
   as it was. */
#include "formats/scene-file.h"

#include <string.h>

#include "base/alloc.h"
#include "base/read-file.h"
#include "scene/scene-impl.h"

/* By its mark, or by the zero byte of each of the first two characters, which are ASCII in both
   formats. */
static int is_utf_16(const char *text, size_t size) {
  if (size >= 2 && (!memcmp(text, "\xFF\xFE", 2) || !memcmp(text, "\xFE\xFF", 2))) return 1;
  return size >= 4 && !text[0] == !text[2] && !text[1] == !text[3] && !text[0] != !text[1];
}

static hr2d_status add_text(hr2d_scene *scene, const char *text, size_t size,
                            hr2di_watch *watch) {
  if (is_utf_16(text, size))
    return hr2di_message_fail(hr2di_scene_message(scene), HR2D_ESYNTAX,
                              "line 1: the text is UTF-16 or UTF-32: save it as UTF-8");
  /* A byte order mark may be ignored (RFC 8259, section 8.1), and some editors write it. */
  if (size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) {
    text += 3;
    size -= 3;
  }
  const size_t before = hr2d_scene_patches(scene);
  const hr2d_status status =
      (hr2di_vs2_recognise(text, size) ? hr2di_vs2_read : hr2di_geojson_read)(scene, text, size,
                                                                              watch);
  if (status) hr2di_scene_truncate(scene, before);
  return status;
}

/* Leaves a message if the watch has stopped; returns the status. */
static hr2d_status finish(hr2d_scene *scene, hr2d_status status, const hr2di_watch *watch) {
  return watch->refused ? hr2di_scene_fail(scene, status, watch, "") : status;
}

/* Checks the arguments of both entry points before anything is read. */
static hr2d_status check_call(hr2d_scene *scene, int source_given) {
  if (!scene) return HR2D_EINVAL;
  hr2di_message *message = hr2di_scene_message(scene);
  if (!source_given)
    return hr2di_message_fail(message, HR2D_EINVAL, "there is nothing to read from");
  if (hr2di_scene_committed(scene))
    return hr2di_message_fail(message, HR2D_ESTATE,
                              "the scene is committed: nothing can be added");
  return HR2D_OK;
}

hr2d_status hr2d_scene_parse(hr2d_scene *scene, const char *text, size_t size) {
  if (!scene || (size && !text)) return HR2D_EINVAL;
  hr2d_status status = check_call(scene, text || !size);
  if (status) return status;
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "read");
  return finish(scene, add_text(scene, size ? text : "", size, &watch), &watch);
}

hr2d_status hr2d_scene_read(hr2d_scene *scene, const char *path) {
  hr2d_status status = check_call(scene, path != NULL);
  if (status) return status;
  const hr2d_allocator *alloc = hr2di_scene_allocator(scene);
  char *text;
  size_t size;
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "read");
  status = hr2di_file_read(alloc, path, &text, &size, hr2di_scene_message(scene), &watch);
  if (!status) status = add_text(scene, text, size, &watch);
  hr2di_alloc_free(alloc, text);
  return finish(scene, status, &watch);
}
