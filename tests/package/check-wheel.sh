#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The wheel of `make wheel`, installed by pip without a network into a virtual environment, needs no
# library but those of the system, shows none of its own, has its licences, passes the package's tests
# and does what the tutorial shows.  Skipped where Python, its packages or a shared library is missing;
# where CI is set, missing packages are a failure.
set -eu
. "$HR2D_SRCDIR/tests/package/python.sh"
find_python
if ! command -v readelf >/dev/null; then
  echo "there is no readelf: not tested" >&2
  [ -z "${CI-}" ] || exit 1
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
fail() {
  echo "$*" >&2
  status=1
}

# faults FILE: libraries that not every system has, symbols that other libraries could see or replace,
# and code that the loader would have to change.
faults() {
  readelf -dW "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/needs \1/p; s/.*(\(TEXTREL\|RPATH\|RUNPATH\)).*/has \1/p' |
    grep -Ev '^needs (libc|libm|libpthread|libgomp|ld-linux[^.]*)\.so\.[0-9]+$'
  readelf -W --dyn-syms "$1" | awk '$7 ~ /^[0-9A]/ && $8 !~ /^PyInit_/ { print "exports " $8 }
    $7 == "UND" && $8 ~ /^(hr2d|gsl|cblas|json)/ { print "leaves open " $8 }'
}

# Compiled by the compiler that Python itself was made with.
unset CC CXX PYTHONPATH LD_LIBRARY_PATH
export PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg MPLCONFIGDIR="$work"
MAKEFLAGS='' make -s -C "$HR2D_BUILDDIR" wheel PYTHON="$python"
set -- "$HR2D_BUILDDIR"/wheel/*.whl
wheel=$1
case ${wheel##*/} in
  *-cp39-abi3-linux_*.whl) ;;
  *) fail "a name that claims something else: ${wheel##*/}" ;;
esac

# With the system's numpy and cffi; hr2d is in the environment alone.
"$python" -m venv --without-pip --system-site-packages "$work/venv"
python=$work/venv/bin/python
pip_install "$wheel"
folder=$(find "$work/venv" -type d -path '*-packages/hr2d')
faults "$folder"/_hr2d.*.so >"$work/found" || true
[ ! -s "$work/found" ] || fail "the extension $(cat "$work/found")"
faults "$libraries/libhr2d.so" >"$work/found" || true
for fault in 'needs libgsl\.' 'exports hr2d_version' 'leaves open json_'; do
  grep -q "^$fault" "$work/found" || fail "not seen in the shared library: $fault"
done
information=$(find "$work/venv" -type d -name 'hr2d-*.dist-info')
grep -qx 'License: GPL-3.0-or-later' "$information/METADATA" || fail "the wheel does not say its licence"
cmp "$HR2D_SRCDIR/COPYING" "$(find "$information" -name COPYING)" || fail "the wheel lacks COPYING"
for library in GSL jansson; do
  grep -q "^$library" "$(find "$information" -name NOTICE)" || fail "the wheel lacks the notice of $library"
done

"$work/venv/bin/hr2d-convert" --help >/dev/null || fail "the wheel lacks its command"
[ -e "$work/venv/share/man/man1/hr2d-convert.1" ] || fail "the wheel lacks a manual page"
test_package "$work/tested"
. "$HR2D_SRCDIR/tests/docs/pages.sh"
make_reader "$work/bin"
unset LD_LIBRARY_PATH PKG_CONFIG_PATH
make_python "$work/bin"
run_page "$HR2D_SRCDIR/doc/tutorial/python.md" "$work/page" || fail "the tutorial shows something else"
exit $status
