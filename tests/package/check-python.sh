#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The Python package, installed by pip without a network against the library that was just built,
# passes its own tests, and does what the pages with Python show.  pip says what it lacks to build it, and
# Python what to do where the library is not found.  Skipped where Python, its packages or a shared library
# is missing; where CI is set, missing packages are a failure.
set -eu
. "$HR2D_SRCDIR/tests/package/python.sh"
find_python

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$HR2D_SRCDIR/python" "$work/python"
chmod -R u+w "$work/python"

# An environment without anything: what is missing has a name.
"$python" -m venv --without-pip "$work/empty"
if "$python" -m pip --python "$work/empty/bin/python" install --no-index --no-build-isolation \
  --disable-pip-version-check "$work/python" >"$work/said" 2>&1 ||
  ! grep -q 'apt install python3-setuptools python3-cffi python3-wheel' "$work/said"; then
  echo "pip does not say what is missing:" && cat "$work/said"
  exit 1
fi

# Compiled by the compiler that Python itself was made with.
unset CC CXX
PKG_CONFIG_PATH="$HR2D_BUILDDIR${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}" \
  pip_install --no-build-isolation --prefix "$work/prefix" "$work/python"

folder=$(find "$work/prefix" -type d -name hr2d -path '*-packages/hr2d')
export PYTHONPATH="${folder%/hr2d}" PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg MPLCONFIGDIR="$work"

# Unless the library is installed, too, the loader does not find it; then the error says what to do.
if ! "$python" -c 'import hr2d' 2>"$work/said" && ! grep -q 'ldconfig.*LD_LIBRARY_PATH' "$work/said"; then
  echo "the error does not say what to do:" && cat "$work/said"
  exit 1
fi
export LD_LIBRARY_PATH="$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
test_package "$work/tested"

. "$HR2D_SRCDIR/tests/docs/pages.sh"
make_reader "$work/bin"
make_python "$work/bin"
all_pages >"$work/pages"
pages=0
while read -r page; do
  needs_python "$HR2D_SRCDIR/$page" || continue
  # Modules for files of other programs are not in $modules.
  if grep -q '^\$ python3 .*\.svg' "$HR2D_SRCDIR/$page" && [ -z "${CI-}" ] &&
    ! "$python" -c 'import svgelements' 2>/dev/null; then
    echo "not run: $page, for want of svgelements"
    continue
  fi
  run_page "$HR2D_SRCDIR/$page" "$work/page" || exit 1
  pages=$((pages + 1))
done <"$work/pages"
echo "$pages pages"
[ "$pages" -gt 0 ]
