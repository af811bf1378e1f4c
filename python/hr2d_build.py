# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the extension module hr2d._hr2d from the headers of the installed library.

cffi reads the headers as the preprocessor leaves them, and the C compiler checks each type and
function again.  So nothing is declared twice.  Environment: PKG_CONFIG, PKG_CONFIG_PATH, CC.
"""
import os
import re
import shlex
import subprocess

from cffi import FFI

# Loops that would be slow in Python, and a progress callback that seldom asks Python.
HELPERS = r"""
typedef double (*hr2dpy_scene_getter)(const hr2d_scene *, size_t patch, size_t band);
typedef double (*hr2dpy_getter)(const hr2d_solution *, size_t patch, size_t band);
typedef double (*hr2dpy_enclosure_getter)(const hr2d_enclosure *, size_t patch, size_t band);
typedef double (*hr2dpy_point_getter)(const hr2d_solution *, size_t patch, double t,
                                      size_t band);
hr2d_status hr2dpy_poll(void *ctx, const hr2d_progress *progress);
void hr2dpy_segments(const hr2d_scene *scene, double *end, double *length);
void hr2dpy_scene_values(hr2dpy_scene_getter get, const hr2d_scene *scene, double *value);
void hr2dpy_sunlight(const hr2d_scene *scene, size_t patch, const double *t, size_t count,
                     double *value);
void hr2dpy_sky(const hr2d_scene *scene, const double *bearing, size_t count, double *value);
void hr2dpy_values(hr2dpy_getter get, const hr2d_solution *solution, size_t patches,
                   size_t bands, double *value);
void hr2dpy_ends(hr2dpy_enclosure_getter get, const hr2d_enclosure *enclosure, size_t patches,
                 size_t bands, double *value);
void hr2dpy_point_values(hr2dpy_point_getter get, const hr2d_solution *solution, size_t patch,
                         const double *t, size_t count, size_t bands, double *value);
void hr2dpy_element_values(const hr2d_solution *solution, size_t elements, size_t bands,
                           double *value);
"""

# Python keeps these; errors of theirs are kept by hr2d/_calls.py.
CALLBACKS = """
hr2d_status hr2dpy_progress(void *, const hr2d_progress *);
hr2d_status hr2dpy_warn(void *, const hr2d_warning *);
hr2d_status hr2dpy_row(void *, const hr2d_field_row *);
hr2d_status hr2dpy_write(void *, const void *, size_t);
hr2d_status hr2dpy_read(void *, void *, size_t);
hr2d_status hr2dpy_estimate(void *, const hr2d_batch *, double *);
hr2d_status hr2dpy_acceptable(void *, const hr2d_batch *, const double *, unsigned char *);
hr2d_status hr2dpy_recursion_limit(void *, const hr2d_batch *, unsigned char *);
hr2d_status hr2dpy_preferred_subdivision(void *, const hr2d_batch *, unsigned char *);
"""

SOURCE = r"""
#include <hr2d/hr2d.h>
#include <time.h>

static hr2d_status hr2dpy_progress(void *ctx, const hr2d_progress *progress);

HELPERS

/* The library asks every millisecond.  Python may have to wait for its lock, up to 5 ms, so it
   is asked 20 times a second. */
hr2d_status hr2dpy_poll(void *ctx, const hr2d_progress *progress) {
  static _Thread_local double due;
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  const double seconds = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
  if (seconds < due) return HR2D_OK;
  due = seconds + 0.05;
  return hr2dpy_progress(ctx, progress);
}

void hr2dpy_segments(const hr2d_scene *scene, double *end, double *length) {
  const size_t patches = hr2d_scene_patches(scene);
  for (size_t k = 0; k < patches; k++, end += 4) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    end[0] = s.a.x, end[1] = s.a.y, end[2] = s.b.x, end[3] = s.b.y;
    length[k] = hr2d_scene_length(scene, k);
  }
}

void hr2dpy_scene_values(hr2dpy_scene_getter get, const hr2d_scene *scene, double *value) {
  const size_t patches = hr2d_scene_patches(scene), bands = hr2d_scene_bands(scene);
  for (size_t k = 0; k < patches; k++)
    for (size_t band = 0; band < bands; band++) *value++ = get(scene, k, band);
}

void hr2dpy_sunlight(const hr2d_scene *scene, size_t patch, const double *t, size_t count,
                     double *value) {
  const size_t bands = hr2d_scene_bands(scene);
  for (size_t k = 0; k < count; k++)
    for (size_t band = 0; band < bands; band++)
      *value++ = hr2d_scene_sunlight_at(scene, patch, t[k], band);
}

void hr2dpy_sky(const hr2d_scene *scene, const double *bearing, size_t count, double *value) {
  const size_t bands = hr2d_scene_bands(scene);
  for (size_t k = 0; k < count; k++)
    for (size_t band = 0; band < bands; band++)
      *value++ = hr2d_scene_sky(scene, bearing[k], band);
}

void hr2dpy_values(hr2dpy_getter get, const hr2d_solution *solution, size_t patches,
                   size_t bands, double *value) {
  for (size_t k = 0; k < patches; k++)
    for (size_t band = 0; band < bands; band++) *value++ = get(solution, k, band);
}

void hr2dpy_ends(hr2dpy_enclosure_getter get, const hr2d_enclosure *enclosure, size_t patches,
                 size_t bands, double *value) {
  for (size_t k = 0; k < patches; k++)
    for (size_t band = 0; band < bands; band++) *value++ = get(enclosure, k, band);
}

void hr2dpy_point_values(hr2dpy_point_getter get, const hr2d_solution *solution, size_t patch,
                         const double *t, size_t count, size_t bands, double *value) {
  for (size_t k = 0; k < count; k++)
    for (size_t band = 0; band < bands; band++) *value++ = get(solution, patch, t[k], band);
}

void hr2dpy_element_values(const hr2d_solution *solution, size_t elements, size_t bands,
                           double *value) {
  for (size_t k = 0; k < elements; k++)
    for (size_t band = 0; band < bands; band++)
      *value++ = hr2d_solution_element(solution, (uint32_t)k, band);
}
""".replace("HELPERS", HELPERS)


def pkg_config(*what):
    """What pkg-config says of the library, as words."""
    command = shlex.split(os.environ.get("PKG_CONFIG", "pkg-config"))
    try:
        text = subprocess.run([*command, *what, "hr2d"], check=True, text=True,
                              stdout=subprocess.PIPE).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        raise SystemExit("pkg-config does not find hr2d: install libhr2d, or set "
                         f"PKG_CONFIG_PATH to the folder of hr2d.pc ({error})") from None
    return shlex.split(text)


def declarations(cflags):
    """The text of the public headers after the preprocessor, without what they include."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    text = subprocess.run([*compiler, *cflags, "-E", "-x", "c", "-"], check=True, text=True,
                          input="#include <hr2d/hr2d.h>\n", stdout=subprocess.PIPE).stdout
    kept, ours = [], False
    for line in text.splitlines():
        marker = re.match(r'# \d+ "(.*)"', line)
        if marker:
            ours = os.path.basename(os.path.dirname(marker[1])) == "hr2d"
        elif ours:
            kept.append(line)
    return "\n".join(kept)


def split(words, prefix):
    """The words that begin with a prefix, without it, and all other words."""
    taken = [word[len(prefix):] for word in words if word.startswith(prefix)]
    return taken, [word for word in words if not word.startswith(prefix)]


ffi = FFI()
_cflags, _libs = pkg_config("--cflags"), pkg_config("--libs")
_include, _other_cflags = split(_cflags, "-I")
_folders, _other_libs = split(_libs, "-L")
ffi.cdef(declarations(_cflags) + HELPERS + f'extern "Python" {{ {CALLBACKS} }}')
# Python looks for one function, which says itself that it is to be seen.
ffi.set_source("hr2d._hr2d", SOURCE, include_dirs=_include,
               extra_compile_args=["-fvisibility=hidden", *_other_cflags], library_dirs=_folders,
               extra_link_args=_other_libs)
