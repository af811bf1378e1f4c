# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# For the scripts that test the Python package: sourced, with HR2D_SRCDIR and HR2D_BUILDDIR in the
# environment.
: "${HR2D_SRCDIR:?names the source directory}" "${HR2D_BUILDDIR:?names the build directory}"
libraries=$HR2D_BUILDDIR/.libs
# setuptools comes first: it refuses to follow distutils, which numpy imports.
modules='setuptools, wheel, pip, cffi, numpy, scipy, matplotlib, pytest'

# find_python: $python is the path of the first interpreter that has all modules; another python3 may
# come first in PATH.  Ends the test where there is none, or no shared library that it can load: one with a sanitizer,
# or of another architecture.
find_python() {
  if [ ! -e "$libraries/libhr2d.so" ]; then
    echo "no shared library: the Python package is not tested" >&2
    exit 77
  fi
  for python in ${PYTHON-} python3 /usr/bin/python3 ''; do
    [ -n "$python" ] || break
    ! "$python" -c "import $modules" 2>/dev/null || break
  done
  if [ -z "$python" ]; then
    echo "no python3 with $modules: not tested" >&2
    [ -z "${CI-}" ] || exit 1
    exit 77
  fi
  python=$(command -v "$python")
  if ! "$python" -c "import ctypes; ctypes.CDLL('$libraries/libhr2d.so')"; then
    echo "$python cannot load the library: not tested" >&2
    exit 77
  fi
}

# pip_install ARGUMENT...: without a network
pip_install() {
  "$python" -m pip install --quiet --no-index --no-cache-dir --disable-pip-version-check \
    --root-user-action=ignore "$@"
}

# test_package FOLDER: the package's own tests pass in a folder, which is made.
test_package() {
  mkdir -p "$1"
  cp -r "$HR2D_SRCDIR/python/tests" "$HR2D_SRCDIR/python/README.md" "$1"
  (cd "$1/.." && "$python" -m pytest -q -p no:cacheprovider "$1/tests")
}

# make_python FOLDER: python3 is $python for a reader who has the folder in PATH.
make_python() {
  printf '#!/bin/sh\nexec %s "$@"\n' "$python" >"$1/python3"
  chmod +x "$1/python3"
}
