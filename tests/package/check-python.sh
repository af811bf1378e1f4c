#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The Python package, installed by pip without a network against the library that was just built,
# passes its own tests, and does what the pages with Python show.  Skipped where Python, its packages or a shared library is missing; where
# CI is set, missing packages are a failure.
set -eu
# setuptools comes first: it refuses to follow distutils, which numpy imports.
modules='setuptools, wheel, pip, cffi, numpy, scipy, matplotlib, pytest'

# The first interpreter that has all modules; another python3 may come first in PATH.
find_python() {
  for python in ${PYTHON-} python3 /usr/bin/python3; do
    ! "$python" -c "import $modules" 2>/dev/null || return 0
  done
  echo "no python3 with $modules: not tested" >&2
  [ -z "${CI-}" ] || exit 1
  exit 77
}

libraries=$HR2D_BUILDDIR/.libs
if [ ! -e "$libraries/libhr2d.so" ]; then
  echo "no shared library: the Python package is not tested" >&2
  exit 77
fi
find_python
# A library with a sanitizer, or of another architecture, cannot be loaded.
export LD_LIBRARY_PATH="$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
if ! "$python" -c "import ctypes; ctypes.CDLL('libhr2d.so')"; then
  echo "$python cannot load the library: not tested" >&2
  exit 77
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$HR2D_SRCDIR/python" "$work/python"
chmod -R u+w "$work/python"
# Compiled by the compiler that Python itself was made with.
unset CC CXX
PKG_CONFIG_PATH="$HR2D_BUILDDIR${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}" \
  "$python" -m pip install --quiet --no-build-isolation --no-index --no-cache-dir \
  --disable-pip-version-check --root-user-action=ignore --prefix "$work/prefix" "$work/python"

folder=$(find "$work/prefix" -type d -name hr2d -path '*-packages/hr2d')
export PYTHONPATH="${folder%/hr2d}" PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg MPLCONFIGDIR="$work"
cd "$work"
"$python" -m pytest -q -p no:cacheprovider python/tests

. "$HR2D_SRCDIR/tests/docs/pages.sh"
make_reader "$work/bin"
printf '#!/bin/sh\nexec %s "$@"\n' "$python" >"$work/bin/python3"
chmod +x "$work/bin/python3"
all_pages >"$work/pages"
pages=0
while read -r page; do
  needs_python "$HR2D_SRCDIR/$page" || continue
  run_page "$HR2D_SRCDIR/$page" "$work/page" || exit 1
  pages=$((pages + 1))
done <"$work/pages"
echo "$pages pages"
[ "$pages" -gt 0 ]
