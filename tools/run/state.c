/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library makes the bytes of a state; here they go to a file and come from it. */
#include "run/state.h"

#include <errno.h>
#include <string.h>

#include "cli/scene.h"
#include "output/complain.h"
#include "output/output.h"

static hr2d_status write_bytes(void *ctx, const void *bytes, size_t size) {
  return fwrite(bytes, 1, size, ctx) == size ? HR2D_OK : HR2D_EIO;
}

static hr2d_status read_bytes(void *ctx, void *bytes, size_t size) {
  if (fread(bytes, 1, size, ctx) == size) return HR2D_OK;
  return ferror(ctx) ? HR2D_EIO : HR2D_ESYNTAX;
}

static int load_stream(run *r, FILE *stream) {
  const char *path = r->options->state;
  errno = 0;
  const hr2d_status status = hr2d_state_read(r->own_links, read_bytes, stream, &r->solution);
  if (status == HR2D_EIO) return complain(path, "cannot be read: %s", strerror(errno));
  if (status) return complain_call(path, hr2d_linkset_message(r->own_links), status);
  if (getc(stream) != EOF) return complain(path, "something follows the state");
  const double epsilon = hr2d_linkset_epsilon(r->own_links);
  if (epsilon < r->options->epsilon)
    return complain(path, "is the state of epsilon %g, which is finer than --eps %g", epsilon,
                    r->options->epsilon);
  r->resumed = r->kept = epsilon;
  return 0;
}

int state_load(run *r) {
  const char *path = r->options->state;
  if (!path) return 0;
  if (r->shares) return r->shares->load(r);
  FILE *stream = fopen(path, "rb");
  if (!stream)
    return errno == ENOENT ? 0 : complain(path, "cannot be read: %s", strerror(errno));
  const int status = load_stream(r, stream);
  fclose(stream);
  return status;
}

int state_save(run *r) {
  output out;
  if (!r->options->state) return 0;
  if (r->shares) return r->shares->save(r);
  int status = output_open(&out, r->options->state);
  if (status) return status;
  const hr2d_status written = hr2d_state_write(r->solution, write_bytes, out.stream);
  if (written == HR2D_EUNSUPPORTED && scene_has_gas(r->scene))
    status = scene_complain(r->options, r->scene, written);
  else if (written == HR2D_EUNSUPPORTED)
    status =
        complain(r->options->state,
                 "a state cannot keep emissivities of patches of given flux that depend on "
                 "temperature, in several bands");
  else if (written && written != HR2D_EIO)
    status = complain(r->options->state, "%s", hr2d_strerror(written));
  status = output_close(&out, status);
  if (!status) r->kept = hr2d_linkset_epsilon(r->own_links);
  return status;
}

void state_mention(const run *r) {
  if (r->kept > 0)
    complain(r->options->state, "has the state of epsilon %g, to go on from", r->kept);
}
